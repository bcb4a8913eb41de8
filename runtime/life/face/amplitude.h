/* amplitude.h: mouth shapes from loudness alone, ten times a second, as early games did it.
 *
 *   noh_amplitude_init     start in the caller's memory
 *   noh_amplitude_hear     add samples, in chunks of any size, with any number of channels
 *   noh_amplitude_end      end the sound: the last partial window counts, and the mouth closes
 *   noh_amplitude_next     get finished windows
 *   noh_amplitude_between  interpolate the shapes between two windows
 *
 * The mean of |sample| over a tenth of a second, relative to 0.3 of the recent peak level, selects one of three shapes
 * and its weight (Granberg, "Character Animation with Direct3D", 2009, ch. 10, with its errors corrected: a partial
 * window is divided by its own length, there is no division by silence, windows do not drift, and the peak level is a
 * percentile of peaks, which one click does not change). ear.h recognises shapes; this needs one addition per sample.
 *
 * Threads: one thread at a time. */
#ifndef NOH_FACE_AMPLITUDE_H
#define NOH_FACE_AMPLITUDE_H

#include "life/face/recipe.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NOH_AMPLITUDE_RATE = 10,       /* windows per second */
    NOH_AMPLITUDE_LATENCY_MS = 100 /* a window is complete at its end */
};

typedef struct noh_amplitude_frame {
    uint32_t index;    /* window: starts at index / 10 s */
    uint32_t mean;     /* of |sample|: 0..32768 */
    noh_viseme viseme; /* NOH_VISEME_SIL: weight is 0 */
    float weight;      /* 0.3..1 */
} noh_amplitude_frame;

/* Private: only its size is of use. */
typedef struct noh_amplitude {
    uint32_t rate, channels, channel; /* channel: of the next sample */
    uint32_t index, filled;           /* windows done; samples in the present window */
    uint32_t peak, loud;              /* of the present window; a percentile of recent peaks, 1/16 */
    uint32_t ended;                   /* 1: no more samples; 2: the closing window was returned too */
    uint64_t sum, frames;             /* |samples| of the present window; samples per channel since the start */
} noh_amplitude;

/* Start.
 * errors  ARG a sample rate outside 1000..192000 Hz; channels not 1..64 */
noh_result noh_amplitude_init(noh_amplitude *a, uint32_t sample_rate, uint32_t channels, noh_error *error);

/* Start a new sound and keep the peak level: for a speaker's next line, or to run a recording twice. */
void noh_amplitude_restart(noh_amplitude *a);

/* Add samples. count is the number of samples, channels interleaved.
 * returns  the number of samples taken; if less than `count`, a window is ready: call noh_amplitude_next first */
size_t noh_amplitude_hear(noh_amplitude *a, const int16_t *samples, size_t count);
void noh_amplitude_end(noh_amplitude *a);

/* Get the next window. After noh_amplitude_end the last window closes the mouth.
 * returns  1 if *frame was filled, else 0 */
int noh_amplitude_next(noh_amplitude *a, noh_amplitude_frame *frame);

/* Get the shape and weight for a mean of |samples| at a peak level of `loud` (0: silence). */
noh_viseme noh_amplitude_shape(uint32_t mean, uint32_t loud, float *weight);

/* Interpolate the weights of shapes at `part` (clamped to 0..1) of the way between two windows:
 * visemes[NOH_VISEME_COUNT]. */
void noh_amplitude_between(const noh_amplitude_frame *from, const noh_amplitude_frame *to, float part, float *visemes);

#ifdef __cplusplus
}
#endif

#endif
