/* How much interpolation is off: time_lod.h, noh_time_lod_measure. */
#include "base/arena.h"
#include "character/measure_internal.h"

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
    float travel[3];
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

/* The most that a point is off in a pose that is a mix of two, all floats at their worst; `least` where it is not more. */
static float pose_off(const noh_time_probe *p, const work *w, float part, float least)
{
    float worst, enough, floats = 0.0f;
    for (uint32_t i = 0; p->float_reach_m && i < p->set->float_count; i++) {
        float from = w->from.floats[i], off = (from + (w->to.floats[i] - from) * part - w->right.floats[i]) * p->float_reach_m[i];
        floats += off < 0.0f ? -off : off;
    }
    worst = enough = least > floats ? least - floats : 0.0f;
    for (size_t j = 0; j < p->set->joint_count; j++) {
        const float *from = w->from.model + 12u * j, *to = w->to.model + 12u * j, *right = w->right.model + 12u * j;
        float difference[12];
        for (int i = 0; p->joint_reach_m[j] >= 0.0f && i < 12; i++) {
            difference[i] = from[i] + (to[i] - from[i]) * part - right[i];
        }
        worst = p->joint_reach_m[j] >= 0.0f ? noh_probe_off(difference, p->joint_reach_m[j], worst) : worst;
    }
    /* Nothing found, nothing added: sums of what was taken away and put back would creep up. */
    return (worst > enough || floats > least) && worst + floats > least ? worst + floats : least;
}

static float worst_within(const noh_time_probe *p, uint32_t motion, int64_t start, uint32_t period, work *w, float worst)
{
    noh_probe_sample(p, motion, start, w->travel, w->pose, w->from.model, w->from.floats);
    noh_probe_sample(p, motion, start + (int64_t)period, w->travel, w->pose, w->to.model, w->to.floats);
    for (uint32_t at = PLACE_TICKS; at < period; at += PLACE_TICKS) {
        noh_probe_sample(p, motion, start + (int64_t)at, w->travel, w->pose, w->right.model, w->right.floats);
        worst = pose_off(p, w, (float)at / (float)period, worst);
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
        worst = worst_within(p, motion, start, period, w, worst);
    }
    return worst;
}

noh_result noh_time_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t motion, float *error_m, noh_error *error)
{
    const char *what = noh_probe_fault(probe, motion);
    noh_result result;
    noh_arena arena = noh_arena_over(memory, bytes);
    work w;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, motion, 0);
    }
    result = noh_probe_check_memory(memory, bytes, noh_time_lod_measure_size(probe), error);
    if (result) {
        return result;
    }
    carve(&arena, probe->set, &w);
    noh_probe_travel(probe, motion, w.pose, w.from.floats, w.travel);
    for (int r = 0; r < NOH_RATE_COUNT; r++) {
        uint32_t period = noh_rate_period((noh_rate)r);
        error_m[r] = period ? measure(probe, motion, period, &w) : 0.0f;
    }
    return NOH_OK;
}
