/* How much interpolation is off: time_lod.h, noh_time_lod_measure. */
#include "anim/local_to_model.h"
#include "anim/root_motion.h"
#include "base/arena.h"
#include "base/math.h"
#include "character/time_lod.h"

/* Frames of clips of 24, 30, 60 and 120 Hz lie on these, and with them the corners of what is interpolated
 * between frames, where errors are largest. */
#define START_TICKS 400u /* from one interval that is looked at to the next */
#define PLACE_TICKS 200u /* from one place within it to the next */

/* A pose's matrices and floats. */
typedef struct sampled {
    float *model;
    float *floats;
} sampled;

typedef struct work {
    noh_transform *pose;
    sampled from, to, right;
} work;

static void carve_one(noh_arena *arena, const noh_anim_set *set, sampled *s)
{
    s->model = (float *)noh_arena_carve(arena, 12u * sizeof(float) * (size_t)set->joint_count, 4);
    s->floats = (float *)noh_arena_carve(arena, set->float_count * sizeof(float), 4);
}

static void carve(noh_arena *arena, const noh_anim_set *set, work *w)
{
    w->pose = (noh_transform *)noh_arena_carve(arena, set->joint_count * sizeof(noh_transform), 4);
    carve_one(arena, set, &w->from);
    carve_one(arena, set, &w->to);
    carve_one(arena, set, &w->right);
}

size_t noh_time_lod_measure_size(const noh_time_probe *probe)
{
    noh_arena arena = noh_arena_measure();
    work w;
    carve(&arena, probe->set, &w);
    return arena.used;
}

static void sample(const noh_time_probe *p, uint32_t motion, int64_t tick, noh_transform *pose, sampled *out)
{
    const noh_motion *m = &p->set->motions[motion];
    int64_t clip = noh_time_clip(noh_position_of(tick), m->duration_ticks, (noh_loop)m->loop);
    noh_root_sample_rest(p->set, motion, (uint32_t)(clip >> 16), p->set->joint_count, pose, out->floats);
    noh_local_to_model(p->skeleton, pose, p->set->joint_count, out->model);
}

/* Above the largest singular value of a 3 x 3 matrix, by at most 3^(1/8): its Schatten 8-norm, the eighth
 * root of the squared Frobenius norm of (A' A)^2. */
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

/* The most that a point within reach of a joint is off where the joint's matrix is a mix of two: the joint's
 * own way, and the turn. */
static float joint_off(const float *from, const float *to, float part, const float *right, float reach)
{
    float turn[9], way[3];
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 4; c++) {
            int i = 4 * r + c;
            float off = from[i] + (to[i] - from[i]) * part - right[i];
            *(c < 3 ? &turn[3 * r + c] : &way[r]) = off;
        }
    }
    return noh_sqrt(noh_dot3(way, way)) + (reach > 0.0f ? reach * norm_bound(turn) : 0.0f);
}

static float pose_off(const noh_time_probe *p, const work *w, float part)
{
    float worst = 0.0f, floats = 0.0f;
    for (size_t j = 0; j < p->set->joint_count; j++) {
        if (p->joint_reach_m[j] >= 0.0f) {
            float off = joint_off(w->from.model + 12u * j, w->to.model + 12u * j, part, w->right.model + 12u * j, p->joint_reach_m[j]);
            worst = off > worst ? off : worst;
        }
    }
    for (uint32_t i = 0; p->float_reach_m && i < p->set->float_count; i++) {
        float from = w->from.floats[i], off = (from + (w->to.floats[i] - from) * part - w->right.floats[i]) * p->float_reach_m[i];
        floats += off < 0.0f ? -off : off;
    }
    return worst + floats;
}

static float worst_within(const noh_time_probe *p, uint32_t motion, int64_t start, uint32_t period, work *w)
{
    float worst = 0.0f;
    sample(p, motion, start, w->pose, &w->from);
    sample(p, motion, start + (int64_t)period, w->pose, &w->to);
    for (uint32_t at = PLACE_TICKS; at < period; at += PLACE_TICKS) {
        float off;
        sample(p, motion, start + (int64_t)at, w->pose, &w->right);
        off = pose_off(p, w, (float)at / (float)period);
        worst = off > worst ? off : worst;
    }
    return worst;
}

/* From the first tick of the motion to where it begins to repeat itself, or stands. */
static float measure(const noh_time_probe *p, uint32_t motion, uint32_t period, work *w)
{
    const noh_motion *m = &p->set->motions[motion];
    int64_t end = (int64_t)m->duration_ticks * (m->loop == NOH_LOOP_PING_PONG ? 2 : 1);
    float worst = 0.0f;
    for (int64_t start = 0; start < end; start += START_TICKS) {
        float off = worst_within(p, motion, start, period, w);
        worst = off > worst ? off : worst;
    }
    return worst;
}

static const char *bad_probe(const noh_time_probe *p, uint32_t motion)
{
    if (!p->set || !p->skeleton || !p->joint_reach_m || p->skeleton->joint_count != p->set->joint_count) return "probe";
    if (motion >= p->set->motion_count) return "motion";
    return NULL;
}

noh_result noh_time_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t motion, float *error_m, noh_error *error)
{
    const char *what = bad_probe(probe, motion);
    noh_arena arena = noh_arena_over(memory, bytes);
    work w;
    size_t need;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, motion, 0);
    }
    need = noh_time_lod_measure_size(probe);
    if (!memory || ((uintptr_t)memory & 15u) != 0) {
        return noh_fail(error, NOH_ERR_ARG, "memory for measuring is NULL or not 16-byte aligned", 0, need);
    }
    if (bytes < need) {
        return noh_fail(error, NOH_ERR_MEMORY, "memory for measuring is too small", bytes, need);
    }
    carve(&arena, probe->set, &w);
    for (int r = 0; r < NOH_RATE_COUNT; r++) {
        uint32_t period = noh_rate_period((noh_rate)r);
        error_m[r] = period ? measure(probe, motion, period, &w) : 0.0f;
    }
    return NOH_OK;
}
