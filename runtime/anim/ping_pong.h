/* ping_pong.h: weights that run by time: to the end and stay, or to and fro (rows D1, D4).
 *
 * Times are 64-bit ticks of the caller's own counter: nothing wraps, nothing drifts, and no
 * phase is there twice. */
#ifndef NOH_ANIM_PING_PONG_H
#define NOH_ANIM_PING_PONG_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* From 0 at tick 0 to 1 at `duration`, and 1 from there; 0 before. A duration of 0 or less is over at once. */
float noh_time_ramp(int64_t ticks, int64_t duration);

/* From 0 at tick 0 to 1 at `half`, back to 0 at twice that, and so on; times before 0 too. half 0 or less gives 0. */
float noh_time_ping_pong(int64_t ticks, int64_t half);

#ifdef __cplusplus
}
#endif

#endif
