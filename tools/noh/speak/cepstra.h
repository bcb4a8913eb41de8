/* cepstra.h: features of speech, a hundred times a second: mel-frequency cepstra and their slopes.
 *
 * Source: Davis and Mermelstein, "Comparison of parametric representations for monosyllabic word recognition in
 * continuously spoken sentences", 1980. Windows of 25 ms; frame t covers the ten milliseconds from t / 100 s. */
#ifndef NOH_NOH_SPEAK_CEPSTRA_H
#define NOH_NOH_SPEAK_CEPSTRA_H

#include "sound.h"

#define FEATURE_RATE 100u
#define FEATURE_SOUND_RATE 16000u
#define FEATURE_CEPSTRA 13u
#define FEATURE_COUNT (2u * FEATURE_CEPSTRA)

typedef struct features {
    float *values; /* [frames * FEATURE_COUNT] cepstra, then their slopes */
    float *level;  /* [frames] dB */
    size_t frames;
} features;

/* `in` at FEATURE_SOUND_RATE; nothing above top_hz counts. Prints an error and returns an exit code; 0 on success. */
int features_make(const sound *in, float top_hz, features *out);
/* Each value by its mean and deviation over the frames where used[frame], or all of them without. */
void features_normalise(features *f, const unsigned char *used);
/* The level, in dB, below which `part` (0..1) of the frames are. */
float features_level(const features *f, float part);
void features_free(features *f);

#endif
