/* time_internal.h: the private part of low_motion.h. */
#ifndef NOH_ANIM_TIME_INTERNAL_H
#define NOH_ANIM_TIME_INTERNAL_H

#include <stdint.h>

#include "noh/clip.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the position `ticks` later at a playback speed.
 * units   speed: 16.16 fixed point
 * ranges  any; the result is clamped to 0..duration for ONCE, else to INT64_MIN..INT64_MAX */
int64_t noh_time_advance(int64_t position, int64_t speed, int64_t ticks, uint32_t duration_ticks, noh_loop loop);

/* Get the position in the clip, 0..duration << 16. At the end of a pass a repeating clip is at 0, not at its
 * duration. */
int64_t noh_time_clip(int64_t position, uint32_t duration_ticks, noh_loop loop);

/* Get the whole durations up to the position, rounded down; 0 for ONCE and for a duration of 0. */
int64_t noh_time_legs(int64_t position, uint32_t duration_ticks, noh_loop loop);

/* Get the amount to subtract from a position to keep it small: a whole number of double durations, so that pose, events
 * and root motion do not change. 0 for positions within NOH_POSITION_MAX. */
int64_t noh_time_rebase(int64_t position, uint32_t duration_ticks, noh_loop loop);

/* Divide and round down, or up. b > 0. */
static inline int64_t noh_floor_div(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

static inline int64_t noh_ceil_div(int64_t a, int64_t b)
{
    return a / b + (a % b > 0);
}

#ifdef __cplusplus
}
#endif

#endif
