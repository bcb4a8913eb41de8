/* posteriors.h: a recording as the ear's network reads it: probabilities of mouth shapes, a hundred times a second. */
#ifndef NOH_NOH_SPEAK_POSTERIORS_H
#define NOH_NOH_SPEAK_POSTERIORS_H

#include "noh/face.h"
#include "sound.h"

#define POSTERIOR_RATE 100u
#define POSTERIOR_OFFSET 0.0075 /* s: frame n is of the hundredth that begins at n / POSTERIOR_RATE and this */
#define POSTERIOR_OCTAVE 256

typedef struct posteriors {
    int32_t (*cost)[NOH_VISEME_COUNT]; /* [frames] improbability of shapes, 1/POSTERIOR_OCTAVE of a halving */
    const int16_t *prior;              /* [NOH_VISEME_COUNT] the same without any sound */
    size_t frames;
    int32_t loudest; /* 1/256 octave of power, of a window of 400 samples of 16 bits */
} posteriors;

/* Heard twice: the second time the ear knows the voice and the room. Prints an error and returns an exit code; 0 on
 * success. */
int posteriors_make(const sound *recording, posteriors *out);
void posteriors_free(posteriors *p);

#endif
