/* ear_internal.h (private to face/): features of sound, and the network trained to read shapes from them. */
#ifndef NOH_FACE_EAR_INTERNAL_H
#define NOH_FACE_EAR_INTERNAL_H

#include "noh/face.h"

enum {
    EAR_RATE = 16000,
    EAR_WINDOW = 400,
    EAR_HOP = 160,
    EAR_SKIP = 120, /* samples before the first window: a frame's own window lies 7.5 ms behind the frame */
    EAR_FFT = 512,
    EAR_MELS = 24,
    EAR_CEPSTRA = 13,
    EAR_FEATURES = EAR_CEPSTRA + 2, /* and the loudness above the quietest and the loudest recent levels */
    EAR_AFTER = 2,                  /* frames that the first layer reads on each side of its own */
    EAR_NEAR = 2 * EAR_AFTER + 1,
    EAR_INPUTS = EAR_NEAR * EAR_FEATURES,
    EAR_FIRST = 64, /* outputs of the first layer */
    EAR_BEFORE = 9, /* frames that the second layer uses before its own, and how many of all it reads */
    EAR_TAPS = 4,
    EAR_SECOND = 40
};

typedef struct ear_tables {
    int16_t window[EAR_WINDOW / 2]; /* Hamming, 1/32768 */
    int16_t sine[EAR_FFT / 4 + 1];  /* a quarter wave, 1/32767 */
    uint8_t mel[EAR_FFT / 2 + 1];   /* the lower of the two filters of a bin; 255: none */
    uint8_t share[EAR_FFT / 2 + 1]; /* share of the upper one, 1/256 */
    int16_t mean[EAR_CEPSTRA];      /* of speech, 1/256 octave */
    uint16_t scale[EAR_FEATURES];   /* 1/4096: scales a standard deviation to 32 */
    int8_t first[EAR_FIRST][EAR_INPUTS];
    int32_t first_bias[EAR_FIRST];
    int32_t first_scale[EAR_FIRST]; /* 1/65536: scales the first layer's outputs to bytes */
    int8_t second[EAR_SECOND][EAR_TAPS * EAR_FIRST];
    int32_t second_bias[EAR_SECOND];
    int8_t output[NOH_VISEME_COUNT][EAR_SECOND];
    int32_t output_bias[NOH_VISEME_COUNT];
    int16_t prior[NOH_VISEME_COUNT]; /* 1/256 octave: log2 of one over the share of a shape in the training's frames */
    int32_t unit;                    /* scale of the outputs: this many units are an octave of probability */
} ear_tables;

extern const ear_tables noh_ear_tables;

/* Adaptation to a speaker and a room: the running mean of cepstra over frames that are loud enough to be speech, and
 * the percentiles of loudness. */
typedef struct ear_voice {
    int32_t mean[EAR_CEPSTRA]; /* 1/65536 octave */
    int32_t peak;              /* of the first cepstral coefficient, 1/256 */
    int32_t count;
    int32_t low, high; /* of loudness, 1/256 octave */
} ear_voice;

/* The cepstra of one window, and its loudness; all in 1/256 of an octave of power. */
void noh_ear_cepstra(const ear_tables *t, const int16_t *samples, int16_t before, int32_t *cepstra, int32_t *loudness);
/* log2 in 1/256, within 1/128. */
int32_t noh_ear_log2(uint64_t value);

void noh_ear_voice_init(const ear_tables *t, ear_voice *v);
/* Get a frame: cepstra minus their mean, and loudness relative to recent loudness. 1/256 octave */
void noh_ear_measure(ear_voice *v, const int32_t *cepstra, int32_t loudness, int32_t *features);
void noh_ear_scale(const ear_tables *t, const int32_t *features, int8_t *scaled);

/* The first layer's outputs for the middle one of EAR_NEAR frames: first[EAR_FIRST]. */
void noh_ear_see(const ear_tables *t, const int8_t (*near)[EAR_FEATURES], int8_t *first);
/* Get the index of the n-th frame that the second layer reads. */
uint32_t noh_ear_tap(uint32_t n);
/* Compute the probabilities of shapes, 1/32768, from the first layer's outputs for EAR_BEFORE + 1 frames. */
void noh_ear_read(const ear_tables *t, const int8_t (*past)[EAR_FIRST], int32_t *weights);

#endif
