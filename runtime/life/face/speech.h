/* speech.h: mouth shapes of speech from timed phones.
 *
 *   noh_speech_visemes     the weights of the fifteen shapes at a tick
 *   noh_viseme_of_phone    the shape of a phone: ARPABET, or the International Phonetic Alphabet in UTF-8
 *
 * A mouth moves to the next sound before the last one has ended, and lips round long before the vowel that needs it. So
 * each phone dominates a stretch of time around its middle, rising and falling at the rates of its class, and shapes
 * are weighted by dominance (Cohen and Massaro, "Modeling coarticulation in synthetic visual speech", 1993). Closed
 * lips are applied last, after all smoothing: p, b and m for at least 34 ms, one frame at 30 Hz, whatever their
 * neighbours; then the lip on the teeth of f and v, in the time that p, b and m leave.
 *
 * Threads: no state; any thread. */
#ifndef NOH_FACE_SPEECH_H
#define NOH_FACE_SPEECH_H

#include "life/face/recipe.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_phone {
    uint32_t start;  /* tick */
    uint32_t viseme; /* noh_viseme */
} noh_phone;

/* An utterance: consecutive phones, the last one until `end`. Silent before the first and after the last. */
typedef struct noh_speech {
    const noh_phone *phones; /* [phone_count] by increasing start */
    uint32_t phone_count;
    uint32_t end; /* tick */
} noh_speech;

/* Check an utterance.
 * errors  ARG no phones, or too many; DATA starts that do not increase, an end before the last start, an unknown viseme
 *         (where: the phone) */
noh_result noh_speech_check(const noh_speech *speech, noh_error *error);

/* Compute the weights at a tick: visemes[NOH_VISEME_COUNT], each 0..1, sum 1. Requires a checked utterance.
 * ranges  any tick; silent outside the utterance */
void noh_speech_visemes(const noh_speech *speech, int64_t tick, float *visemes);

/* Get the shape of a phone. *second is the second shape of a diphthong such as "ai", else NOH_VISEME_COUNT.
 * returns  NOH_VISEME_COUNT for an unknown phone */
noh_viseme noh_viseme_of_phone(const char *phone, noh_viseme *second);

#ifdef __cplusplus
}
#endif

#endif
