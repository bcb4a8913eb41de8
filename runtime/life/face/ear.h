/* ear.h: sound to mouth shapes, live: the weights of the fifteen visemes, a hundred times a second.
 *
 *   noh_ear_init     in the caller's memory: no allocation, and memcpy clones it
 *   noh_ear_hear     samples in, in chunks of any size
 *   noh_ear_next     frames out, while there are any
 *   noh_ear_restart  the next line of the same speaker
 *
 * Windows of 25 ms every 10 ms become thirteen mel-frequency cepstral coefficients (Davis and Mermelstein, 1980), less
 * their running mean, and loudness against that of late. A network of one hidden layer, taught on synthetic speech by
 * tools/train_ear, reads shapes from six of twelve such frames; lips change when enough has been heard for it, and shut
 * at once. All of it is integers: the same bits on every processor, and whatever the size of the chunks.
 *
 * A frame is known NOH_EAR_LATENCY_MS after its middle: a program that plays the sound itself can hold it
 * back by as much.
 *
 * Threads: an ear is used by one thread at a time. */
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
    NOH_EAR_LATENCY_MS = 40,  /* what is heard behind the middle of a frame before it is told */
    NOH_EAR_BYTES = 2048
};

/* Private: only its size is of use. */
typedef struct noh_ear {
    uint64_t state[NOH_EAR_BYTES / 8];
} noh_ear;

typedef struct noh_ear_frame {
    uint32_t index;                  /* 0, 1, ...; its middle is at 10 * index + 12.5 ms */
    noh_viseme shape;                /* the one that shows */
    float visemes[NOH_VISEME_COUNT]; /* 0..1, 1 together: as noh_speech_visemes has them */
    float open, round, closed;       /* 0..1: the jaw by shape and loudness, lips forward, lips shut */
} noh_ear_frame;

/* errors  ARG a sample rate outside of NOH_EAR_MIN_RATE..NOH_EAR_MAX_RATE */
noh_result noh_ear_init(noh_ear *ear, uint32_t sample_rate, noh_error *error);

/* The sound begins anew, with frame 0; what the ear has learnt of the speaker and the room is kept. */
void noh_ear_restart(noh_ear *ear);

/* Takes samples of one channel until a frame is ready.
 * returns  how many it took: fewer than `count` means that noh_ear_next has a frame, to be fetched first */
size_t noh_ear_hear(noh_ear *ear, const int16_t *samples, size_t count);

/* returns  1: *frame is the next one; 0: more samples are wanted */
int noh_ear_next(noh_ear *ear, noh_ear_frame *frame);

#ifdef __cplusplus
}
#endif

#endif
