/* Shared by the measurements of LOD errors: measure_internal.h. */
#include "motion/anim/root_motion_internal.h"
#include "motion/anim/time_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "motion/anim/clip_set_internal.h"
#include "core/base/math_internal.h"
#include "stage/character/measure_internal.h"
#include "stage/character/time_lod_internal.h"

const char *noh_probe_fault(const noh_time_probe *p, uint32_t clip)
{
    if (!p->set || !p->skeleton || p->skeleton->joint_count != p->set->joint_count)
        return "probe: set or skeleton is NULL, or their joint counts differ";
    if (clip >= p->set->clip_count) return "clip must be below the set's clip_count";
    return noh_clip_set_excess(p->set);
}

void noh_probe_travel(const noh_time_probe *p, uint32_t clip, noh_transform *pose, float *floats, float travel[3])
{
    const noh_clip_entry *m = &p->set->clips[clip];
    for (int i = 0; i < 3; i++) {
        travel[i] = 0.0f;
    }
    if (p->travels && m->loop == NOH_LOOP_REPEAT && p->set->joint_count) {
        noh_root_sample_rest(p->set, clip, 0, 1, pose, floats);
        for (int i = 0; i < 3; i++) {
            travel[i] = -pose[0].translation[i];
        }
        noh_root_sample_rest(p->set, clip, m->duration_ticks, 1, pose, floats);
        for (int i = 0; i < 3; i++) {
            travel[i] += pose[0].translation[i];
        }
    }
}

void noh_probe_sample(const noh_time_probe *p, uint32_t clip, int64_t tick, const float *travel, noh_transform *pose,
                      float *model, float *floats)
{
    const noh_clip_entry *m = &p->set->clips[clip];
    const int64_t position = noh_position_of(tick);
    const int64_t in_clip = noh_time_clip(position, m->duration_ticks, (noh_loop)m->loop);
    const float passes = (float)noh_time_legs(position, m->duration_ticks, (noh_loop)m->loop);
    noh_root_sample_rest(p->set, clip, (uint32_t)(in_clip >> 16), p->set->joint_count, pose, floats);
    noh_local_to_model(p->skeleton, pose, p->set->joint_count, model);
    for (size_t i = 0; travel && passes > 0.0f && i < 3u * (size_t)p->set->joint_count; i++) {
        model[4u * i + 3u] += passes * travel[i % 3u];
    }
}

/* An upper bound on the largest singular value of a 3 x 3 matrix, too high by a factor of at most 3^(1/8): the Schatten
 * 8-norm. With singular values s, (A'A)^2 has eigenvalues s^4, and the square of its Frobenius norm is the sum of s^8;
 * the eighth root of that is at least the largest s. This takes three square roots and no iteration. */
static float norm_bound(const float a[9])
{
    float g[9], square[9], sum = 0.0f;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            g[3 * r + c] = a[r] * a[c] + a[3 + r] * a[3 + c] + a[6 + r] * a[6 + c];
        }
    }
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            square[3 * r + c] = g[3 * r] * g[c] + g[3 * r + 1] * g[3 + c] + g[3 * r + 2] * g[6 + c];
        }
    }
    for (int i = 0; i < 9; i++) {
        sum += square[i] * square[i];
    }
    return noh_sqrt(noh_sqrt(noh_sqrt(sum)));
}

float noh_probe_off(const float difference[12], float radius, float least)
{
    float linear[9], shift[3], square = 0.0f, length;
    for (int i = 0; i < 12; i++) {
        *(i % 4 < 3 ? &linear[i / 4 * 3 + i % 4] : &shift[i / 4]) = difference[i];
    }
    for (int i = 0; i < 9; i++) {
        square += linear[i] * linear[i];
    }
    length = noh_sqrt(noh_dot3(shift, shift));
    radius = radius > 0.0f ? radius : 0.0f;
    /* The Frobenius norm is never below the largest singular value, and cheap: it is enough for most joints. */
    if (length + radius * noh_sqrt(square) > least) {
        const float off = length + radius * norm_bound(linear);
        least = off > least ? off : least;
    }
    return least;
}
