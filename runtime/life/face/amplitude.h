/* amplitude.h: mouth shapes out of loudness alone, ten times a second: how games did it before they listened.
 *
 *   noh_amplitude_init     in the caller's memory
 *   noh_amplitude_hear     samples in, in chunks of any size, of any number of channels
 *   noh_amplitude_end      there are no more: what is left of a window counts, and the mouth closes
 *   noh_amplitude_next     windows out, while there are any
 *   noh_amplitude_between  the shapes at any time, out of two windows
 *
 * The mean of |sample| over a tenth of a second, against 0.3 of what is loud of late, picks one of three shapes and how
 * far it is made (Granberg, "Character Animation with Direct3D", 2009, ch. 10, with its errors corrected: a window that
 * is cut short is divided by what it holds, silence is not divided by, windows do not drift, and what is loud is a
 * percentile of peaks, which one click does not move). ear.h tells shapes apart; this costs an addition a sample.
 *
 * Threads: one thread at a time. */
#ifndef NOH_FACE_AMPLITUDE_H
#define NOH_FACE_AMPLITUDE_H

#include "life/face/recipe.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NOH_AMPLITUDE_RATE = 10,       /* windows a second */
    NOH_AMPLITUDE_LATENCY_MS = 100 /* a window is known at its end */
};

typedef struct noh_amplitude_frame {
    uint32_t index;    /* window: from index / 10 s on */
    uint32_t mean;     /* of |sample|: 0..32768 */
    noh_viseme viseme; /* NOH_VISEME_SIL, and then weight is 0 */
    float weight;      /* 0.3..1 */
} noh_amplitude_frame;

/* Private: only its size is of use. */
typedef struct noh_amplitude {
    uint32_t rate, channels, channel; /* channel: of the next sample */
    uint32_t index, filled;           /* windows done; samples of this one */
    uint32_t peak, loud;              /* of this window; a percentile of those of late, 1/16 */
    uint32_t ended;                   /* 1: no more samples, 2: and the closing window is out */
    uint64_t sum, frames;             /* |samples| of this window; samples of one channel since the beginning */
} noh_amplitude;

/* errors  ARG a sample rate outside of 1000..192000 Hz; no channel, or more than 64 */
noh_result noh_amplitude_init(noh_amplitude *a, uint32_t sample_rate, uint32_t channels, noh_error *error);

/* The sound begins anew; what counts as loud is kept: for the next line of a speaker, or to hear a recording twice. */
void noh_amplitude_restart(noh_amplitude *a);

/* count: of samples, channels interleaved.
 * returns  how many it took: fewer mean that a window is ready, to be fetched by noh_amplitude_next first */
size_t noh_amplitude_hear(noh_amplitude *a, const int16_t *samples, size_t count);
void noh_amplitude_end(noh_amplitude *a);

/* returns  1: *frame is the next window. After noh_amplitude_end the last one shuts the mouth. */
int noh_amplitude_next(noh_amplitude *a, noh_amplitude_frame *frame);

/* The rule by itself: the shape of a mean of |samples| where peaks reach `loud` (0: silence). */
noh_viseme noh_amplitude_shape(uint32_t mean, uint32_t loud, float *weight);

/* The weights of shapes, at `part` (held in 0..1) of the way from one window to the next: visemes[NOH_VISEME_COUNT]. */
void noh_amplitude_between(const noh_amplitude_frame *from, const noh_amplitude_frame *to, float part, float *visemes);

#ifdef __cplusplus
}
#endif

#endif
