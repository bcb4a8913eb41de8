/* ik_look.c: a direction that turns towards a target within a cone. */
#include "base/assert.h"
#include "base/trig.h"
#include "sim/ik.h"
#include "sim/vector_internal.h"

static const float up[3] = { 0.0f, 1.0f, 0.0f };

void noh_ik_look_init(noh_ik_look *look, const float ahead[3])
{
    memcpy(look->direction, ahead, sizeof look->direction);
    look->follows = 0;
}

/* Radians between two directions: by sine and cosine, which keeps its digits near 0 and near pi. */
static float angle_between(const float a[3], const float b[3])
{
    float normal[3];
    noh_cross3(a, b, normal);
    return noh_atan2(noh_length3(normal), noh_dot3(a, b));
}

/* Turn direction a towards b, by at most `most` radians. */
static void turn_towards(const float a[3], const float b[3], float most, float out[3])
{
    float axis[3], rotation[3] = { 0.0f, 0.0f, 0.0f }, q[4];
    if (angle_between(a, b) <= most) {
        memcpy(out, b, 3 * sizeof *out);
    } else {
        noh_cross3(a, b, axis);
        noh_perpendicular3(a, noh_dot3(axis, axis) > 1e-12f ? axis : up, axis);
        noh_madd3(rotation, most, axis, rotation);
        noh_quat_from_rotation(rotation, q);
        noh_quat_rotate(q, a, out);
    }
    noh_normalize3(out, a);
}

/* Where to look: at the target within the cone, ahead where it was let go of. */
static void wanted_of(noh_ik_look *look, float angle_max, float release_max, const float ahead[3], const float *target,
                      float wanted[3])
{
    float direction[3] = { 0.0f, 0.0f, 0.0f }, angle;
    if (target) memcpy(direction, target, sizeof direction);
    if (!(noh_dot3(direction, direction) > 1e-24f)) {
        look->follows = 0;
        memcpy(wanted, ahead, sizeof direction);
        return;
    }
    noh_normalize3(direction, ahead);
    angle = angle_between(ahead, direction);
    look->follows = angle <= (look->follows ? release_max : angle_max);
    if (look->follows) {
        turn_towards(ahead, direction, angle_max, wanted);
    } else {
        memcpy(wanted, ahead, sizeof direction);
    }
}

void noh_ik_look_step(noh_ik_look *look, const noh_ik_look_desc *desc, const float ahead[3], const float *target,
                      float seconds, float rotation[4])
{
    const float angle_max = desc->angle_max > 0.0f ? desc->angle_max : NOH_PI / 3.0f;
    const float release_max = desc->release_max > 0.0f ? desc->release_max : angle_max + NOH_PI / 9.0f;
    const float speed_max = desc->speed_max > 0.0f ? desc->speed_max : 4.0f;
    float wanted[3], next[3];
    NOH_ASSERT(look && ahead && rotation && seconds >= 0.0f && angle_max <= 1.0001f * NOH_PI);
    NOH_ASSERT(release_max >= angle_max);
    wanted_of(look, angle_max, release_max, ahead, target, wanted);
    turn_towards(look->direction, wanted, speed_max * seconds, next);
    turn_towards(ahead, next, angle_max, look->direction); /* what is ahead may have moved */
    noh_quat_between(ahead, look->direction, up, rotation);
}

void noh_ik_share(const float rotation[4], float share, float out[4])
{
    float by[3];
    noh_quat_to_rotation(rotation, by);
    for (int i = 0; i < 3; i++) by[i] *= share;
    noh_quat_from_rotation(by, out);
}
