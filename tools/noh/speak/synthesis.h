/* synthesis.h: text spoken by eSpeak NG: its sound, its phones and its words, each with the sample at which it begins.
 * Text in [[ ]] is phones in eSpeak NG's own spelling.
 *
 * The library is looked for when it is needed (libespeak-ng.so.1), so that noh is built, and runs, without it. */
#ifndef NOH_NOH_SPEAK_SYNTHESIS_H
#define NOH_NOH_SPEAK_SYNTHESIS_H

#include <stddef.h>
#include <stdint.h>

typedef struct spoken_phone {
    uint32_t sample;
    char name[9]; /* International Phonetic Alphabet, UTF-8; "": a pause */
} spoken_phone;

typedef struct spoken_word {
    uint32_t sample;
    uint32_t first, length; /* characters of the text, not bytes */
} spoken_word;

typedef struct synthesis {
    uint32_t sample_rate;
    int16_t *samples; /* one channel */
    spoken_phone *phones;
    spoken_word *words;
    size_t sample_count, phone_count, word_count;
    size_t sample_room, phone_room, word_room;
    int failed; /* out of memory */
} synthesis;

/* Prints an error and returns an exit code; 0 on success. voice: a language as `espeak-ng --voices` lists them, with
 * one of its variants where it has a "+", such as "de+f2". */
int synthesis_make(const char *text, const char *voice, synthesis *out);
/* When all has been said: once a process. */
void synthesis_end(void);
void synthesis_free(synthesis *s);

#endif
