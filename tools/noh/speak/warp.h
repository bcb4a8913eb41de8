/* warp.h: the cheapest way through the states of a text along the frames of a recording. */
#ifndef NOH_NOH_SPEAK_WARP_H
#define NOH_NOH_SPEAK_WARP_H

#include "reference.h"

/* at[frame]: the state of each frame, never falling. pause_cost[frame]: of a frame in a pause. A long recording is
 * warped in coarse steps first, and then within a band around them: memory grows with its length, not its square.
 * Prints an error and returns an exit code; 0 on success. */
int warp_make(const reference *r, const features *f, const float *pause_cost, uint32_t *at);

float warp_distance(const float *a, const float *b);

#endif
