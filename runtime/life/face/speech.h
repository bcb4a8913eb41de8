/* speech.h: mouth shapes of speech, out of phones and the times at which they begin.
 *
 *   noh_speech_visemes     the weights of the fifteen shapes at a tick
 *   noh_viseme_of_phone    the shape of a phone: ARPABET, or the International Phonetic Alphabet in UTF-8
 *
 * A mouth is under way to the next sound before the last one has ended, and lips are rounded long before the vowel that
 * wants it. So each phone dominates a stretch of time around its middle, rising and falling at rates of its class, and
 * shapes are shared out by dominance (Cohen and Massaro, "Modeling coarticulation in synthetic visual speech", 1993).
 * Lips that must be shut come last, after everything that is smooth: p, b and m for 34 ms at least, which is one frame
 * at 30 Hz, whatever stands beside them, and the lip on the teeth of f and v in what time p, b and m leave.
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

/* What is said: phones one after another, the last one up to `end`. Silence before the first and after the last. */
typedef struct noh_speech {
    const noh_phone *phones; /* [phone_count] by rising start */
    uint32_t phone_count;
    uint32_t end; /* tick */
} noh_speech;

/* errors  ARG no phones, or too many; DATA starts that do not rise, the end before the last start, no such viseme
 *         (where: the phone) */
noh_result noh_speech_check(const noh_speech *speech, noh_error *error);

/* The weights at a tick: visemes[NOH_VISEME_COUNT], each 0..1 and 1 together. Speech must have been checked.
 * ranges  any tick: silence outside of what is said */
void noh_speech_visemes(const noh_speech *speech, int64_t tick, float *visemes);

/* The shape of one phone; of two where it moves, such as "ai": *second, and NOH_VISEME_COUNT where it does not.
 * returns  NOH_VISEME_COUNT: no phone that is known */
noh_viseme noh_viseme_of_phone(const char *phone, noh_viseme *second);

#ifdef __cplusplus
}
#endif

#endif
