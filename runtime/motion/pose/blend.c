#include "core/base/assert_internal.h"
#include "motion/pose/blend_internal.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#include <string.h>

static float masked(const uint8_t *mask, uint32_t i, float weight)
{
    return mask ? weight * ((float)mask[i] / 255.0f) : weight;
}

void noh_blend_begin(noh_blend *blend)
{
    NOH_ASSERT(blend && (!blend->joint_count || (blend->sum && blend->weights)));
    NOH_ASSERT(!blend->float_count || (blend->float_sum && blend->float_weights));
    blend->covers = 0;
    memset(blend->sum, 0, blend->joint_count * sizeof *blend->sum);
    memset(blend->weights, 0, blend->joint_count * sizeof *blend->weights);
    if (blend->float_count) {
        memset(blend->float_sum, 0, blend->float_count * sizeof *blend->float_sum);
        memset(blend->float_weights, 0, blend->float_count * sizeof *blend->float_weights);
    }
}

/* Coverage needs two facts per joint: whether the pose below has any weight there, and the unmasked weight of the poses
 * above. One array holds both: where the pose below has no weight, the total starts so far below zero that no sum of
 * weights can raise it above (NOH_TRACKS_MAX times NOH_WEIGHT_MAX is 6.4e7). */
#define NOTHING_BELOW (-1e30f)

static void begin_totals(const noh_blend *blend, const float *below, uint32_t count, float *totals)
{
    for (uint32_t i = 0; i < count; i++) {
        totals[i] = below[i] > 0.0f || blend->full > 0.0f ? 0.0f : NOTHING_BELOW;
    }
}

void noh_blend_begin_over(noh_blend *blend)
{
    NOH_ASSERT(blend && (!blend->joint_count || blend->totals) && (!blend->float_count || blend->float_totals));
    begin_totals(blend, blend->weights, blend->joint_count, blend->totals);
    begin_totals(blend, blend->float_weights, blend->float_count, blend->float_totals);
    noh_blend_begin(blend);
    blend->covers = 1;
}

/* Adding unit quaternions and normalising the sum is normalised linear interpolation for any number of poses. Each is
 * added with the sign that makes its dot product with the sum so far at least 0, so the length of the sum never
 * decreases. */
static void add_joint(noh_transform *sum, const noh_transform *joint, float weight)
{
    float turn = noh_quat_dot(sum->rotation, joint->rotation) < 0.0f ? -weight : weight;
    for (int i = 0; i < 4; i++) {
        sum->rotation[i] += turn * joint->rotation[i];
    }
    for (int i = 0; i < 3; i++) {
        sum->translation[i] += weight * joint->translation[i];
        sum->scale[i] += weight * joint->scale[i];
    }
}

/* A pose's weight counts in the totals of the joints and floats that it animates and its mask includes. */
static void add_totals(const uint8_t *mask, uint32_t count, float weight, float *totals)
{
    for (uint32_t i = 0; i < count; i++) {
        totals[i] += !mask || mask[i] ? weight : 0.0f;
    }
}

void noh_blend_add(noh_blend *blend, const noh_transform *pose, const float *floats, float weight, noh_mask_view mask)
{
    NOH_ASSERT(blend && weight > 0.0f);
    add_totals(mask.joints, pose && blend->covers ? blend->joint_count : 0, weight, blend->totals);
    add_totals(mask.floats, floats && blend->covers ? blend->float_count : 0, weight, blend->float_totals);
    for (uint32_t i = 0; pose && i < blend->joint_count; i++) {
        float w = masked(mask.joints, i, weight);
        if (w > 0.0f) {
            add_joint(&blend->sum[i], &pose[i], w);
            blend->weights[i] += w;
        }
    }
    for (uint32_t i = 0; floats && i < blend->float_count; i++) {
        float w = masked(mask.floats, i, weight);
        blend->float_sum[i] += w * floats[i];
        blend->float_weights[i] += w;
    }
}

static void divide_joint(const noh_transform *sum, float weight, noh_transform *out)
{
    noh_transform t = *sum;
    noh_quat_normalize(t.rotation);
    for (int i = 0; i < 3; i++) {
        t.translation[i] /= weight;
        t.scale[i] /= weight;
    }
    *out = t;
}

void noh_blend_finish(const noh_blend *blend, const noh_transform *bind_pose, const float *defaults,
                      noh_transform *pose, float *floats)
{
    NOH_ASSERT(blend && (!blend->joint_count || (bind_pose && pose)) && (!blend->float_count || floats));
    for (uint32_t i = 0; i < blend->joint_count; i++) {
        if (blend->weights[i] > 0.0f) {
            divide_joint(&blend->sum[i], blend->weights[i], &pose[i]);
        } else {
            pose[i] = bind_pose[i];
        }
    }
    for (uint32_t i = 0; i < blend->float_count; i++) {
        const float rest = defaults ? defaults[i] : 0.0f, weight = blend->float_weights[i];
        floats[i] = weight > 0.0f ? blend->float_sum[i] / weight : rest;
        if (weight > 0.0f && weight < blend->full) {
            floats[i] = rest * (1.0f - weight) + blend->float_sum[i];
        }
    }
}

static void mix_joint(const noh_transform *a, const noh_transform *b, float t, noh_transform *out)
{
    noh_quat_nlerp(a->rotation, b->rotation, t, out->rotation);
    for (int i = 0; i < 3; i++) {
        out->translation[i] = a->translation[i] * (1.0f - t) + b->translation[i] * t;
        out->scale[i] = a->scale[i] * (1.0f - t) + b->scale[i] * t;
    }
}

/* How much a sum covers the pose below at one joint: `amount` times the mean mask, which is the masked over the
 * unmasked weight; fully if the pose below has no weight. */
static float cover_of(const noh_blend *blend, float amount, float weight, float total)
{
    float part = weight / (total < blend->full ? blend->full : total);
    return total > 0.0f ? amount * (part < 1.0f ? part : 1.0f) : 1.0f;
}

void noh_blend_cover(const noh_blend *blend, float amount, noh_transform *pose, float *floats)
{
    NOH_ASSERT(blend && blend->covers && amount >= 0.0f && amount <= 1.0f);
    NOH_ASSERT((!blend->joint_count || pose) && (!blend->float_count || floats));
    for (uint32_t i = 0; i < blend->joint_count; i++) {
        if (blend->weights[i] > 0.0f) {
            noh_transform over;
            divide_joint(&blend->sum[i], blend->weights[i], &over);
            mix_joint(&pose[i], &over, cover_of(blend, amount, blend->weights[i], blend->totals[i]), &pose[i]);
        }
    }
    for (uint32_t i = 0; i < blend->float_count; i++) {
        if (blend->float_weights[i] > 0.0f) {
            float t = cover_of(blend, amount, blend->float_weights[i], blend->float_totals[i]);
            floats[i] = floats[i] * (1.0f - t) + blend->float_sum[i] / blend->float_weights[i] * t;
        }
    }
}

void noh_pose_mix(uint32_t joint_count, const noh_transform *a, const noh_transform *b, float t, const uint8_t *mask,
                  noh_transform *out)
{
    NOH_ASSERT(!joint_count || (a && b && out));
    for (uint32_t i = 0; i < joint_count; i++) {
        mix_joint(&a[i], &b[i], masked(mask, i, t), &out[i]);
    }
}

void noh_floats_mix(uint32_t count, const float *a, const float *b, float t, const uint8_t *mask, float *out)
{
    NOH_ASSERT(!count || (a && b && out));
    for (uint32_t i = 0; i < count; i++) {
        float w = masked(mask, i, t);
        out[i] = a[i] * (1.0f - w) + b[i] * w;
    }
}

/* Differences are taken on the right, in the joint's own axes: reference * difference = pose. Added to another pose by
 * noh_pose_add, they turn the joint about the same axes of its own, however that pose has turned it. */
void noh_pose_difference(uint32_t joint_count, const noh_transform *reference, const noh_transform *pose,
                         noh_transform *out)
{
    NOH_ASSERT(!joint_count || (reference && pose && out));
    NOH_ASSERT(!joint_count || reference != out);
    for (uint32_t j = 0; j < joint_count; j++) {
        float inverse[4];
        noh_quat_conjugate(reference[j].rotation, inverse);
        noh_quat_mul(inverse, pose[j].rotation, out[j].rotation);
        for (int i = 0; i < 3; i++) {
            float scale = reference[j].scale[i];
            out[j].translation[i] = pose[j].translation[i] - reference[j].translation[i];
            out[j].scale[i] = scale != 0.0f ? pose[j].scale[i] / scale : 1.0f;
        }
    }
}

void noh_pose_add(uint32_t joint_count, const noh_transform *difference, float weight, const uint8_t *mask,
                  noh_transform *pose)
{
    static const float identity[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    NOH_ASSERT(!joint_count || (difference && pose));
    for (uint32_t j = 0; j < joint_count; j++) {
        float w = masked(mask, j, weight), turn[4];
        noh_quat_nlerp(identity, difference[j].rotation, w, turn);
        noh_quat_mul(pose[j].rotation, turn, pose[j].rotation);
        for (int i = 0; i < 3; i++) {
            pose[j].translation[i] += w * difference[j].translation[i];
            pose[j].scale[i] *= 1.0f + w * (difference[j].scale[i] - 1.0f);
        }
    }
}

void noh_floats_add(uint32_t count, const float *difference, float weight, const uint8_t *mask, float *floats)
{
    NOH_ASSERT(!count || (difference && floats));
    for (uint32_t i = 0; i < count; i++) {
        floats[i] += masked(mask, i, weight) * difference[i];
    }
}
