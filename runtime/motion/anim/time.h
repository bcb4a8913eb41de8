/* time.h: time as integers, so that nothing drifts.
 *
 * A tick is 1/48,000 s: one audio sample. A position counts 1/65,536 ticks from the start of a clip's first leg and is
 * never wrapped: a repeating clip at position 2.5 durations is half through its third pass, a ping-pong clip half
 * through its third leg. Play is then one addition per step, exact for any partition of an interval, and every function
 * of a position (pose, events, root motion) is a function of the whole history of passes, in closed form.
 *
 *   noh_ticks_from_seconds   ticks of a time in seconds
 *   noh_frame_clock_advance  ticks of a frame, without drift
 *   noh_time_advance         where play is after a number of ticks
 *   noh_time_clip            the position inside the clip, folded by the loop mode
 *   noh_time_legs            how many durations have been passed
 *   noh_time_rebase          an equal position of small magnitude
 *
 * All are defined for every argument: a result that would overflow is held at the end of its range.
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
#define NOH_POSITION_MAX ((int64_t)1 << 60) /* 11 years at speed one; play past it is rebased: noh_time_rebase */

typedef enum noh_loop {
    NOH_LOOP_OF_CLIP = 0, /* in descs only: what the clip says */
    NOH_LOOP_ONCE,        /* holds its first and last tick */
    NOH_LOOP_REPEAT,
    NOH_LOOP_PING_PONG /* forwards and back: two legs make one cycle */
} noh_loop;

/* Ticks nearest to a time in seconds.
 * ranges  |seconds| <= 1e9, else 0 */
int64_t noh_ticks_from_seconds(double seconds);

/* What is left over when the seconds of a frame become whole ticks. {0} at first. A frame at 144 Hz is 333.3 ticks
 * long: rounded for itself, each would lose a third of one, a second in 17 minutes. */
typedef struct noh_frame_clock {
    double left_ticks; /* -0.5 to 0.5 */
} noh_frame_clock;

#define NOH_FRAME_SECONDS_MAX 3600.0

/* The ticks of a frame, for noh_stage_step and its like: summed over frames they are the ticks nearest to the sum of
 * the seconds. Time that stood still in a debugger is not made up for.
 * ranges  seconds 0 to NOH_FRAME_SECONDS_MAX; negative ones and NaN count as 0, more is held there */
uint32_t noh_frame_clock_advance(noh_frame_clock *clock, double seconds);

/* The position of a number of whole ticks.
 * ranges  |ticks| < 2^47, 93 years; more is held there */
int64_t noh_position_of(int64_t ticks);

/* Where play is `ticks` later at a playback speed.
 * units   speed: 16.16 fixed point
 * ranges  any; the result is held in 0..duration for ONCE, else at INT64_MIN and INT64_MAX */
int64_t noh_time_advance(int64_t position, int64_t speed, int64_t ticks, uint32_t duration_ticks, noh_loop loop);

/* The position in the clip, 0..duration << 16. When a pass is complete a repeating clip is at 0, not at its duration.
 */
int64_t noh_time_clip(int64_t position, uint32_t duration_ticks, noh_loop loop);

/* Whole durations up to the position, rounded down; 0 for ONCE and for a duration of 0. */
int64_t noh_time_legs(int64_t position, uint32_t duration_ticks, noh_loop loop);

/* What to subtract from a position to make it small without changing anything that follows from it: a whole number of
 * double durations. 0 for positions within NOH_POSITION_MAX. */
int64_t noh_time_rebase(int64_t position, uint32_t duration_ticks, noh_loop loop);

/* Quotient rounded down, and up. b > 0. */
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
