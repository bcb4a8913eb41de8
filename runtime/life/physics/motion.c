/* motion.c: integrators and a distance constraint. */
#include "noh/body.h"
#include "noh/low_life.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"

uint32_t noh_steps_take(noh_steps *steps, uint32_t ticks, uint32_t step_ticks, uint32_t limit)
{
    NOH_ASSERT(step_ticks && limit);
    const uint64_t time = (uint64_t)steps->left + ticks;
    const uint64_t count = time / step_ticks;
    uint64_t dropped;
    steps->left = (uint32_t)(time % step_ticks);
    if (count <= limit) {
        return (uint32_t)count;
    }
    dropped = (count - limit) * step_ticks + steps->dropped;
    steps->dropped = dropped > UINT32_MAX ? UINT32_MAX : (uint32_t)dropped;
    return limit;
}

void noh_point_move(float position[3], float velocity[3], const float acceleration[3], float seconds)
{
    noh_madd3(velocity, seconds, acceleration, velocity);
    noh_madd3(position, seconds, velocity, position);
}

void noh_verlet_move(float position[3], float before[3], const float acceleration[3], float seconds,
                     float seconds_before, float keep)
{
    NOH_ASSERT(seconds > 0.0f && seconds_before > 0.0f);
    const float ratio = keep * (seconds / seconds_before), square = seconds * (seconds + seconds_before) * 0.5f;
    for (int i = 0; i < 3; i++) {
        const float now = position[i];
        position[i] = now + (now - before[i]) * ratio + acceleration[i] * square;
        before[i] = now;
    }
}

float noh_distance_keep(float a[3], float inverse_mass_a, float b[3], float inverse_mass_b, float distance,
                        float compliance, float seconds, float *lambda)
{
    const float weight = inverse_mass_a + inverse_mass_b, soft = compliance / (seconds * seconds);
    float apart[3], size, off, more;
    noh_sub3(b, a, apart);
    size = noh_length3(apart);
    off = size - distance;
    if (!(size >= 1e-6f) || !(weight > 0.0f)) {
        return off;
    }
    more = (off - soft * (lambda ? *lambda : 0.0f)) / (weight + soft);
    if (lambda) *lambda += more;
    noh_madd3(a, inverse_mass_a * more / size, apart, a);
    noh_madd3(b, -inverse_mass_b * more / size, apart, b);
    return off;
}
