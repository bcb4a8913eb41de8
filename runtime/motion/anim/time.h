/* time.h: integer time that does not drift.
 *
 * A tick is 1/48,000 s: one audio sample. A position counts 1/65,536 ticks from the start of a clip's first leg and
 * never wraps: at 2.5 durations a repeating clip is half through its third pass, a ping-pong clip half through its
 * third leg. So play is one addition per step, exact for any partition of an interval, and pose, events and root motion
 * are closed functions of the position.
 *
 *   noh_ticks_from_seconds   seconds to ticks
 *   noh_frame_clock_advance  ticks of a frame, without drift
 *   noh_time_advance         position after a number of ticks
 *   noh_time_clip            position inside the clip, folded by the loop mode
 *   noh_time_legs            number of durations passed
 *   noh_time_rebase          an equivalent position of small magnitude
 *
 * All functions accept every argument; results that would overflow are clamped to their range.
 *
 * Threads: pure functions of their arguments; any thread. */
#ifndef NOH_ANIM_TIME_H
#define NOH_ANIM_TIME_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_TICKS_PER_SECOND 48000u
#define NOH_SPEED_ONE 65536 /* speeds are 16.16 fixed point: clip ticks per tick */
#define NOH_SPEED_MAX (256 * 65536)
#define NOH_DURATION_MAX 0x7fffffffu        /* ticks: 12.4 hours */
#define NOH_POSITION_MAX ((int64_t)1 << 60) /* 11 years at speed one; larger positions are rebased: noh_time_rebase */

typedef enum noh_loop {
    NOH_LOOP_OF_CLIP = 0, /* in descs only: the clip's own mode */
    NOH_LOOP_ONCE,        /* holds its first and last tick */
    NOH_LOOP_REPEAT,
    NOH_LOOP_PING_PONG /* forwards and back: two legs make one cycle */
} noh_loop;

/* Convert seconds to the nearest tick.
 * ranges  |seconds| <= 1e9, else 0 */
int64_t noh_ticks_from_seconds(double seconds);

/* The remainder when a frame's seconds are rounded to whole ticks; initialise to {0}. At 144 Hz a frame is 333.3 ticks
 * long: rounding each frame alone would lose a third of a tick per frame, one second in 17 minutes. */
typedef struct noh_frame_clock {
    double left_ticks; /* -0.5 to 0.5 */
} noh_frame_clock;

#define NOH_FRAME_SECONDS_MAX 3600.0

/* Convert a frame's seconds to ticks, for noh_stage_step and similar calls. Summed over frames, the ticks are the
 * nearest to the sum of the seconds. Long pauses, such as in a debugger, are not caught up.
 * ranges  seconds 0..NOH_FRAME_SECONDS_MAX, clamped; negative values and NaN count as 0 */
uint32_t noh_frame_clock_advance(noh_frame_clock *clock, double seconds);

/* Convert whole ticks to a position.
 * ranges  |ticks| < 2^47 (93 years), clamped */
int64_t noh_position_of(int64_t ticks);

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
