/* flock.c: rules of a flock. */
#include "core/base/assert_internal.h"
#include "stage/crowd/flock_internal.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"

#include "stage/crowd/crowd_internal.h"

static float length_of(const float v[2])
{
    return noh_sqrt(v[0] * v[0] + v[1] * v[1]);
}

static void add(float s, const float v[2], float out[2])
{
    out[0] += s * v[0];
    out[1] += s * v[1];
}

void noh_flock_repel(const float to[2], float force[2])
{
    const float distance = length_of(to);
    if (!(distance > 1e-6f) || distance >= NOH_FLOCK_RANGE) return;
    add(-NOH_FLOCK_REPULSION * (1.0f - distance * (1.0f / NOH_FLOCK_RANGE)) / distance, to, force);
}

void noh_flock_avoid(const float to[2], float radius, float force[2])
{
    const float distance = length_of(to), range = 3.0f * radius;
    if (!(distance > 1e-6f) || distance >= range) return;
    add(-NOH_FLOCK_AVOIDANCE * (1.0f - distance / range) / distance, to, force);
}

void noh_crowd_direction_of(uint32_t id, uint32_t other, float direction[2])
{
    const uint32_t low = id < other ? id : other, high = id < other ? other : id;
    uint32_t h = low * 0x9e3779b1u ^ (high * 0x85ebca6bu + 0x7f4a7c15u);
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    noh_sin_cos_turn(h ^ h >> 13, &direction[1], &direction[0]);
    if (id < other) return;
    direction[0] = -direction[0];
    direction[1] = -direction[1];
}

int noh_flock_apart(const float to[2], float size, uint32_t id, uint32_t other, float move[2])
{
    const float distance = length_of(to);
    if (distance >= size) return 0;
    if (distance > 1e-6f) {
        add(-0.5f * (size - distance) / distance, to, move);
    } else {
        float direction[2];
        noh_crowd_direction_of(id, other, direction);
        add(0.5f * (size - distance), direction, move);
    }
    return 1;
}

void noh_flock_join(const float velocity[2], const float *to, const float *velocities, uint32_t count, float force[2])
{
    if (!count) return;
    for (uint32_t i = 0; i < count; i++) {
        add(1.0f / (float)count, to + 2u * i, force);
        add(1.0f / (float)count, velocities + 2u * i, force);
    }
    add(-1.0f, velocity, force);
}

void noh_flock_turn(float velocity[2], const float wish[2], float speed, float acceleration, float seconds)
{
    const float size = length_of(wish), less = size > speed ? speed / size : 1.0f, most = acceleration * seconds;
    const float change[2] = { wish[0] * less - velocity[0], wish[1] * less - velocity[1] };
    const float by = length_of(change);
    NOH_ASSERT(speed >= 0.0f && acceleration >= 0.0f && seconds >= 0.0f);
    add(by > most ? most / by : 1.0f, change, velocity);
}
