#include "noh/clip.h"

float noh_ramp(int64_t ticks, int64_t duration)
{
    if (ticks < 0 || (ticks == 0 && duration > 0)) {
        return 0.0f;
    }
    return ticks >= duration ? 1.0f : (float)ticks / (float)duration;
}

/* The remainder is taken in integers, so the phase is exact however long the counter has run. */
float noh_ping_pong(int64_t ticks, int64_t half)
{
    int64_t phase;
    if (half <= 0 || half > INT64_MAX / 2) {
        return 0.0f;
    }
    phase = ticks % (2 * half);
    phase = phase < 0 ? phase + 2 * half : phase;
    return (float)(phase <= half ? phase : 2 * half - phase) / (float)half;
}
