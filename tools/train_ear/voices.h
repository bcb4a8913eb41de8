/* voices.h: sentences said by synthesisers, with the times of their phones.
 *
 * eSpeak NG makes sound by formants; flite has statistics of real voices; Festival's voices are cut out of recordings,
 * in six languages. All of them say when each phone begins. */
#ifndef NOH_TRAIN_EAR_VOICES_H
#define NOH_TRAIN_EAR_VOICES_H

#include <stdint.h>

enum { VOICE_SAMPLES_MAX = 1 << 21, VOICE_PHONES_MAX = 4096 };
enum { VOICE_ESPEAK = 0, VOICE_FLITE = 20, VOICE_FESTIVAL = 40 }; /* the first voice of each */

typedef struct voice_phone {
    double start;      /* s */
    int first, second; /* shapes; -1: not known, or none */
} voice_phone;

typedef struct utterance {
    int voice; /* speakers are told apart by it */
    double rate;
    float *samples; /* [VOICE_SAMPLES_MAX], of 16 bits */
    int count;
    voice_phone *phones; /* [VOICE_PHONES_MAX] */
    int phone_count;
} utterance;

/* Says all of `sentences` (lines of LANGUAGE WORDS), each by several voices, and hands each of them to `take`.
 * `phones`: the file of the shapes of phones. `hash`: of all that was read. Ends the program where a voice is missing.
 */
void voices_say(const char *sentences, const char *phones, void (*take)(const utterance *said), uint64_t *hash);

/* From `low` to `high`, the same numbers in every run after the same seed. */
void voices_seed(uint64_t seed);
double voices_random(double low, double high);
void voices_die(const char *what, const char *which);

#endif
