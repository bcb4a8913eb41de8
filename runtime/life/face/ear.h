/* ear.h: live sound to mouth shapes: weights of the fifteen visemes, a hundred times a second.
 *
 *   noh_ear_init     start in the caller's memory; no pointers, so memcpy clones it
 *   noh_ear_hear     add samples, in chunks of any size
 *   noh_ear_next     get finished frames
 *   noh_ear_restart  start the next line of the same speaker
 *
 * Windows of 25 ms every 10 ms become thirteen mel-frequency cepstral coefficients (Davis and Mermelstein, 1980), minus
 * their running mean, and loudness relative to recent loudness. A network with one hidden layer, trained on synthetic
 * speech by tools/train_ear, reads shapes from six of twelve such frames. Lips change after enough evidence, and close
 * immediately. All arithmetic is in integers: the same bits on every processor, whatever the size of the chunks.
 *
 * A frame is ready NOH_EAR_LATENCY_MS after its middle: a program that plays the sound itself can delay it by the same
 * time.
 *
 * Threads: an ear belongs to one thread at a time. */
#ifndef NOH_FACE_EAR_H
#define NOH_FACE_EAR_H

#include "life/face/recipe.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NOH_EAR_MIN_RATE = 8000, /* Hz */
    NOH_EAR_MAX_RATE = 48000,
    NOH_EAR_FRAME_RATE = 100, /* Hz */
    NOH_EAR_LATENCY_MS = 40,  /* sound needed after the middle of a frame */
    NOH_EAR_BYTES = 2048
};

/* Private: only its size is of use. */
typedef struct noh_ear {
    uint64_t state[NOH_EAR_BYTES / 8];
} noh_ear;

typedef struct noh_ear_frame {
    uint32_t index;                  /* 0, 1, ...; its middle is at 10 * index + 12.5 ms */
    noh_viseme shape;                /* the visible shape */
    float visemes[NOH_VISEME_COUNT]; /* 0..1, sum 1: as from noh_speech_visemes */
    float open, round, closed;       /* 0..1: the jaw from shape and loudness, lips forward, lips closed */
} noh_ear_frame;

/* Start.
 * errors  ARG a sample rate outside NOH_EAR_MIN_RATE..NOH_EAR_MAX_RATE */
noh_result noh_ear_init(noh_ear *ear, uint32_t sample_rate, noh_error *error);

/* Start a new sound with frame 0. Keeps the adaptation to speaker and room. */
void noh_ear_restart(noh_ear *ear);

/* Add samples of one channel until a frame is ready.
 * returns  the number of samples taken; if less than `count`, a frame is ready: call noh_ear_next first */
size_t noh_ear_hear(noh_ear *ear, const int16_t *samples, size_t count);

/* Get the next frame.
 * returns  1 if *frame was filled; 0: add more samples */
int noh_ear_next(noh_ear *ear, noh_ear_frame *frame);

#ifdef __cplusplus
}
#endif

#endif
