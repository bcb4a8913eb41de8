/* clock_internal.h (private to anim/ and character/): sums and differences of clocks that saturate at the ends of
 * int64. At 48,000 ticks per second a clock takes six million years to get there, but a forged or damaged snapshot may
 * start there. */
#ifndef NOH_ANIM_CLOCK_INTERNAL_H
#define NOH_ANIM_CLOCK_INTERNAL_H

#include <stdint.h>

static inline int64_t noh_clock_add(int64_t clock, int64_t ticks)
{
    if (ticks > 0) {
        return clock > INT64_MAX - ticks ? INT64_MAX : clock + ticks;
    }
    return clock < INT64_MIN - ticks ? INT64_MIN : clock + ticks;
}

/* Ticks from `start` to `clock`; below 0 if the start lies ahead. */
static inline int64_t noh_clock_since(int64_t clock, int64_t start)
{
    if (start < 0) {
        return clock > INT64_MAX + start ? INT64_MAX : clock - start;
    }
    return clock < INT64_MIN + start ? INT64_MIN : clock - start;
}

#endif
