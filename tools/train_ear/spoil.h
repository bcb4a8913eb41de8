/* spoil.h: an utterance as a microphone might hear it: another throat, another room, another line, noise. */
#ifndef NOH_TRAIN_EAR_SPOIL_H
#define NOH_TRAIN_EAR_SPOIL_H

#include "voices.h"

/* The sound at EAR_RATE, 16 bits. hard: 0: only louder or quieter, with little noise; 1: all that can go wrong.
 * warp: times are shorter by it, and all tones higher. Returns the samples; *count is how many. */
const int16_t *spoil(const utterance *said, double warp, int hard, int *count);

#endif
