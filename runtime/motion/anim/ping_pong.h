/* ping_pong.h: weights as functions of time: a ramp and a ping-pong.
 *
 * Times are 64-bit ticks of the caller's own counter, so nothing wraps or drifts.
 *
 * Threads: pure functions; any thread. */
#ifndef NOH_ANIM_PING_PONG_H
#define NOH_ANIM_PING_PONG_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Ramp from 0 at tick 0 to 1 at `duration`, clamped. A duration of 0 or less steps to 1 at tick 0. */
float noh_ramp(int64_t ticks, int64_t duration);

/* Triangle wave: 0 at tick 0, 1 at `half`, 0 at 2 * `half`, and so on, also before tick 0. Returns 0 if `half` is 0 or
 * less. */
float noh_ping_pong(int64_t ticks, int64_t half);

#ifdef __cplusplus
}
#endif

#endif
