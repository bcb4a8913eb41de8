/* ping_pong.h: weights as functions of time: a ramp, and a ping-pong.
 *
 * Times are 64-bit ticks of the caller's own counter: nothing wraps and nothing drifts.
 *
 * Threads: pure functions; any thread. */
#ifndef NOH_ANIM_PING_PONG_H
#define NOH_ANIM_PING_PONG_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* 0 up to tick 0, rising to 1 at `duration`, then 1. A duration of 0 or less is over at once. */
float noh_ramp(int64_t ticks, int64_t duration);

/* 0 at tick 0, 1 at `half`, 0 at twice that, and so on, before tick 0 too. A half of 0 or less gives 0. */
float noh_ping_pong(int64_t ticks, int64_t half);

#ifdef __cplusplus
}
#endif

#endif
