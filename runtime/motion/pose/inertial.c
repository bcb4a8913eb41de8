#include "motion/pose/inertial_internal.h"

#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "noh/clip.h"
#include "noh/low_core.h"

/* The quintic x(t) with x(0) = x0, x'(0) = v0, x''(0) = a0 and x = x' = x'' = 0 at t1. The initial acceleration a0
 * makes the jerk vanish at t1, clamped to 0 or more so that the offset does not first accelerate outwards. If v0 is so
 * fast that the curve would cross zero before the duration, t1 is reduced to -5 x0 / v0. (Bollo 2018.) */
float noh_inertia_decay(float x0, float v0, float t, float duration)
{
    float t1 = duration, a0, c3, c4, c5, t1_2, x;
    if (!(x0 > 0.0f) || !(t < duration)) {
        return 0.0f;
    }
    if (t <= 0.0f) {
        return x0;
    }
    if (v0 < 0.0f && -5.0f * x0 / v0 < t1) {
        t1 = -5.0f * x0 / v0;
    }
    if (t >= t1) {
        return 0.0f;
    }
    t1_2 = t1 * t1;
    a0 = (-8.0f * v0 * t1 - 20.0f * x0) / t1_2;
    a0 = a0 > 0.0f ? a0 : 0.0f;
    c5 = -(a0 * t1_2 + 6.0f * v0 * t1 + 12.0f * x0) / (2.0f * t1_2 * t1_2 * t1);
    c4 = (3.0f * a0 * t1_2 + 16.0f * v0 * t1 + 30.0f * x0) / (2.0f * t1_2 * t1_2);
    c3 = -(3.0f * a0 * t1_2 + 12.0f * v0 * t1 + 20.0f * x0) / (2.0f * t1_2 * t1);
    x = x0 + t * (v0 + t * (0.5f * a0 + t * (c3 + t * (c4 + t * c5))));
    return x < 0.0f ? 0.0f : x > x0 ? x0 : x; /* rounding only */
}

/* The speed of an offset along itself, clamped to 0 or less: a growing offset stops immediately instead of
 * overshooting. */
static float speed_along(const float offset[3], const float before[3], float delta_s)
{
    float length = noh_sqrt(noh_dot3(offset, offset));
    float speed = length > 1e-12f ? (length - noh_dot3(before, offset) / length) / delta_s : 0.0f;
    return speed < 0.0f ? speed : 0.0f;
}

static void difference(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = a[i] - b[i];
    }
}

/* The rotation that takes b to a. */
static void rotation_between(const noh_transform *a, const noh_transform *b, float out[3])
{
    float inverse[4], q[4];
    noh_quat_conjugate(b->rotation, inverse);
    noh_quat_mul(a->rotation, inverse, q);
    noh_quat_to_rotation(q, out);
}

void noh_inertia_begin(uint32_t joint_count, const noh_transform *source, const noh_transform *source_before,
                       const noh_transform *target, const noh_transform *target_before, float delta_s,
                       noh_inertia_joint *out)
{
    NOH_ASSERT(delta_s > 0.0f && (!joint_count || (source && source_before && target && target_before && out)));
    for (uint32_t i = 0; i < joint_count; i++) {
        float before[3];
        rotation_between(&source[i], &target[i], out[i].rotation);
        rotation_between(&source_before[i], &target_before[i], before);
        out[i].rotation_speed = speed_along(out[i].rotation, before, delta_s);
        difference(source[i].translation, target[i].translation, out[i].translation);
        difference(source_before[i].translation, target_before[i].translation, before);
        out[i].translation_speed = speed_along(out[i].translation, before, delta_s);
        difference(source[i].scale, target[i].scale, out[i].scale);
        difference(source_before[i].scale, target_before[i].scale, before);
        out[i].scale_speed = speed_along(out[i].scale, before, delta_s);
    }
}

void noh_inertia_begin_floats(uint32_t count, const float *source, const float *source_before, const float *target,
                              const float *target_before, float delta_s, noh_inertia_float *out)
{
    NOH_ASSERT(delta_s > 0.0f && (!count || (source && source_before && target && target_before && out)));
    for (uint32_t i = 0; i < count; i++) {
        float offset = source[i] - target[i], before = source_before[i] - target_before[i];
        float speed = (offset < 0.0f ? before - offset : offset - before) / delta_s;
        out[i].offset = offset;
        out[i].speed = speed < 0.0f ? speed : 0.0f;
    }
}

/* The remaining share of a vector: 0..1. */
static float share_left(const float offset[3], float speed, float elapsed_s, float duration_s)
{
    float length = noh_sqrt(noh_dot3(offset, offset));
    return length > 1e-12f ? noh_inertia_decay(length, speed, elapsed_s, duration_s) / length : 0.0f;
}

static void turn_by_share(const float rotation[3], float share, float q[4])
{
    float left[3], turn[4];
    for (int i = 0; i < 3; i++) {
        left[i] = rotation[i] * share;
    }
    noh_quat_from_rotation(left, turn);
    noh_quat_mul(turn, q, q);
}

void noh_inertia_apply(uint32_t joint_count, const noh_inertia_joint *joints, float elapsed_s, float duration_s,
                       noh_transform *pose)
{
    NOH_ASSERT(!joint_count || (joints && pose));
    for (uint32_t j = 0; j < joint_count; j++) {
        const noh_inertia_joint *o = &joints[j];
        float turn = share_left(o->rotation, o->rotation_speed, elapsed_s, duration_s);
        float move = share_left(o->translation, o->translation_speed, elapsed_s, duration_s);
        float grow = share_left(o->scale, o->scale_speed, elapsed_s, duration_s);
        if (turn > 0.0f) {
            turn_by_share(o->rotation, turn, pose[j].rotation);
        }
        for (int i = 0; i < 3; i++) {
            pose[j].translation[i] += o->translation[i] * move;
            pose[j].scale[i] += o->scale[i] * grow;
        }
    }
}

void noh_inertia_apply_floats(uint32_t count, const noh_inertia_float *offsets, float elapsed_s, float duration_s,
                              float *floats)
{
    NOH_ASSERT(!count || (offsets && floats));
    for (uint32_t i = 0; i < count; i++) {
        float size = offsets[i].offset < 0.0f ? -offsets[i].offset : offsets[i].offset;
        float left = noh_inertia_decay(size, offsets[i].speed, elapsed_s, duration_s);
        floats[i] += offsets[i].offset < 0.0f ? -left : left;
    }
}
