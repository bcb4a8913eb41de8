/* ear_internal.h: what an ear holds, and the numbers that it was taught. */
#ifndef NOH_FACE_EAR_INTERNAL_H
#define NOH_FACE_EAR_INTERNAL_H

#include "face/ear.h"

enum {
    EAR_RATE = 16000,
    EAR_WINDOW = 400,
    EAR_HOP = 160,
    EAR_FFT = 512,
    EAR_MELS = 24,
    EAR_COEFFICIENTS = 13,
    EAR_BEFORE = 6, /* frames that the closure detector sees before its own, and after */
    EAR_AFTER = 2,
    EAR_SEEN = EAR_BEFORE + 1 + EAR_AFTER,
    EAR_SMOOTHED = 6 /* frames whose weights are averaged */
};

typedef struct ear_tables {
    int16_t window[EAR_WINDOW / 2];                     /* Hamming, 1/32768 */
    int16_t sine[EAR_FFT / 4 + 1];                      /* a quarter wave, 1/32767 */
    uint8_t mel[EAR_FFT / 2 + 1];                       /* the lower of the two filters that a bin is in; 255: none */
    uint8_t share[EAR_FFT / 2 + 1];                     /* of the upper one, 1/256 */
    int16_t cosine[EAR_COEFFICIENTS][EAR_MELS];         /* 1/16384 */
    int16_t mean[EAR_COEFFICIENTS];                     /* of speech, 1/256 */
    int16_t weight[NOH_VISEME_COUNT][EAR_COEFFICIENTS]; /* 1/2048 */
    int32_t bias[NOH_VISEME_COUNT];                     /* 1/2^19 */
    int16_t shut_weight[EAR_SEEN][EAR_COEFFICIENTS];    /* 1/2048 */
    int32_t shut_bias;                                  /* 1/2^19 */
} ear_tables;

extern const ear_tables noh_ear_tables;

/* The coefficients of one window, and its loudness; all in 1/256 of an octave of power. */
void noh_ear_mfcc(const ear_tables *t, const int16_t *samples, int16_t before, int32_t *coefficients,
                  int32_t *loudness);

/* The running mean of coefficients, over frames that are loud enough to be speech. */
typedef struct ear_mean {
    int32_t mean[EAR_COEFFICIENTS]; /* 1/65536 */
    int32_t peak;                   /* of coefficient 0, 1/256 */
    int32_t count;
} ear_mean;

void noh_ear_mean_init(const ear_tables *t, ear_mean *m);
void noh_ear_mean_take(ear_mean *m, int32_t *coefficients); /* in: as they are; out: less the mean */

int64_t noh_ear_shut_score(const ear_tables *t, const int16_t (*seen)[EAR_COEFFICIENTS]);

#endif
