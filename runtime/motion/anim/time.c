#include "motion/anim/time_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#define POSITION_TICKS_MAX (INT64_MAX / 65536)
#define SMALL ((int64_t)1 << 30)

int64_t noh_ticks_from_seconds(double seconds)
{
    double ticks = seconds * (double)NOH_TICKS_PER_SECOND;
    if (!(seconds >= -1e9 && seconds <= 1e9)) {
        return 0;
    }
    return (int64_t)(ticks < 0.0 ? ticks - 0.5 : ticks + 0.5);
}

uint32_t noh_frame_clock_advance(noh_frame_clock *clock, double seconds)
{
    const double step = !(seconds > 0.0) ? 0.0 : seconds < NOH_FRAME_SECONDS_MAX ? seconds : NOH_FRAME_SECONDS_MAX;
    const double ticks = clock->left_ticks + step * (double)NOH_TICKS_PER_SECOND;
    const uint32_t whole = (uint32_t)(ticks + 0.5); /* to the nearest, like noh_ticks_from_seconds */
    clock->left_ticks = ticks - (double)whole;
    return whole;
}

int64_t noh_position_of(int64_t ticks)
{
    ticks = ticks > POSITION_TICKS_MAX ? POSITION_TICKS_MAX : ticks < -POSITION_TICKS_MAX ? -POSITION_TICKS_MAX : ticks;
    return ticks * 65536;
}

/* position + speed * ticks, saturated to 64 bits. */
static int64_t advance_saturated(int64_t position, int64_t speed, int64_t ticks)
{
    const int back = (speed < 0) != (ticks < 0);
    /* unsigned magnitudes: -INT64_MIN does not fit in int64_t */
    const uint64_t s = speed < 0 ? (uint64_t)0 - (uint64_t)speed : (uint64_t)speed;
    const uint64_t t = ticks < 0 ? (uint64_t)0 - (uint64_t)ticks : (uint64_t)ticks;
    uint64_t left; /* to the end of the range in the direction of play */
    if (s == 0u || t == 0u) {
        return position;
    }
    left = back ? (uint64_t)position - (uint64_t)INT64_MIN : (uint64_t)INT64_MAX - (uint64_t)position;
    if (s > left / t) {
        return back ? INT64_MIN : INT64_MAX;
    }
    /* the result is in range, so arithmetic modulo 2^64 gives it exactly */
    return (int64_t)(back ? (uint64_t)position - s * t : (uint64_t)position + s * t);
}

static int is_small(int64_t x)
{
    return x < SMALL && x > -SMALL;
}

int64_t noh_time_advance(int64_t position, int64_t speed, int64_t ticks, uint32_t duration_ticks, noh_loop loop)
{
    const int64_t end = noh_position_of(duration_ticks);
    /* two factors below 2^30 move by less than 2^60, which cannot overflow from within 2^62 */
    const int safe = is_small(speed) && is_small(ticks) && position < 4 * NOH_POSITION_MAX &&
                     position > -4 * NOH_POSITION_MAX;
    int64_t to = safe ? position + speed * ticks : advance_saturated(position, speed, ticks);
    if (loop == NOH_LOOP_ONCE || end == 0) {
        to = to < 0 ? 0 : to > end ? end : to;
    }
    return to;
}

/* Repeating and ping-pong clips differ only in folding: both count durations. */
int64_t noh_time_legs(int64_t position, uint32_t duration_ticks, noh_loop loop)
{
    return loop == NOH_LOOP_ONCE || duration_ticks == 0 ? 0 : noh_floor_div(position, noh_position_of(duration_ticks));
}

int64_t noh_time_clip(int64_t position, uint32_t duration_ticks, noh_loop loop)
{
    const int64_t duration = noh_position_of(duration_ticks);
    int64_t leg, rest;
    if (loop == NOH_LOOP_ONCE || duration == 0) {
        return position < 0 ? 0 : position > duration ? duration : position;
    }
    /* the remainder first: leg * duration may be below INT64_MIN */
    leg = position / duration;
    rest = position % duration;
    if (rest < 0) {
        rest += duration;
        leg--;
    }
    return loop == NOH_LOOP_PING_PONG && (leg & 1) ? duration - rest : rest;
}

/* Two durations are one cycle of a ping-pong clip and two passes of a repeating one: multiples of them change no folded
 * position, direction or key. */
int64_t noh_time_rebase(int64_t position, uint32_t duration_ticks, noh_loop loop)
{
    int64_t cycle = 2 * noh_position_of(duration_ticks);
    if (loop == NOH_LOOP_ONCE || cycle == 0 || (position <= NOH_POSITION_MAX && position >= -NOH_POSITION_MAX)) {
        return 0;
    }
    return position / cycle * cycle;
}
