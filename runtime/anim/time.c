#include "anim/time.h"

int64_t noh_ticks_from_seconds(double seconds)
{
    double ticks = seconds * (double)NOH_TICKS_PER_SECOND;
    if (!(seconds >= -1e9 && seconds <= 1e9)) {
        return 0;
    }
    return (int64_t)(ticks < 0.0 ? ticks - 0.5 : ticks + 0.5);
}

int64_t noh_position_of(int64_t ticks)
{
    return ticks * 65536;
}

int64_t noh_time_advance(int64_t position, int64_t rate, int64_t ticks, uint32_t duration_ticks, noh_loop loop)
{
    int64_t end = noh_position_of(duration_ticks), to = position + rate * ticks;
    if (loop == NOH_LOOP_ONCE || end == 0) {
        to = to < 0 ? 0 : to > end ? end : to;
    }
    return to;
}

int64_t noh_time_legs(int64_t position, uint32_t duration_ticks, noh_loop loop)
{
    return loop == NOH_LOOP_ONCE || duration_ticks == 0 ? 0 : noh_floor_div(position, noh_position_of(duration_ticks));
}

int64_t noh_time_clip(int64_t position, uint32_t duration_ticks, noh_loop loop)
{
    int64_t duration = noh_position_of(duration_ticks), leg, rest;
    if (loop == NOH_LOOP_ONCE || duration == 0) {
        return position < 0 ? 0 : position > duration ? duration : position;
    }
    leg = noh_floor_div(position, duration);
    rest = position - leg * duration;
    return loop == NOH_LOOP_PING_PONG && (leg & 1) ? duration - rest : rest;
}

int64_t noh_time_rebase(int64_t position, uint32_t duration_ticks, noh_loop loop)
{
    int64_t cycle = 2 * noh_position_of(duration_ticks);
    if (loop == NOH_LOOP_ONCE || cycle == 0 || (position <= NOH_POSITION_MAX && position >= -NOH_POSITION_MAX)) {
        return 0;
    }
    return position / cycle * cycle;
}
