#include "character/time_lod_points.h"

#include "anim/local_to_model.h"
#include "anim/root_motion.h"
#include "base/arena.h"
#include "base/math.h"

/* Frames of clips of 24, 30, 60 and 120 Hz lie on these, and with them the corners of what is interpolated. */
#define START_TICKS 400u
#define PLACE_TICKS 200u

typedef struct sampled {
    float *model;
    float *floats;
} sampled;

typedef struct work {
    const noh_time_probe *probe;
    const noh_time_points *points;
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

size_t noh_time_points_size(const noh_time_probe *probe)
{
    noh_arena arena = noh_arena_measure();
    work w;
    carve(&arena, probe->set, &w);
    return arena.used;
}

static void sample(const work *w, uint32_t motion, int64_t tick, sampled *out)
{
    const noh_anim_set *set = w->probe->set;
    const noh_motion *m = &set->motions[motion];
    int64_t clip = noh_time_clip(noh_position_of(tick), m->duration_ticks, (noh_loop)m->loop);
    noh_root_sample_rest(set, motion, (uint32_t)(clip >> 16), set->joint_count, w->pose, out->floats);
    noh_local_to_model(w->probe->skeleton, w->pose, set->joint_count, out->model);
}

/* How far a point is off where the joints' matrices are a mix of two. */
static float point_off(const work *w, const noh_time_hold *holds, float part)
{
    float way[3] = { 0.0f, 0.0f, 0.0f };
    for (uint32_t i = 0; i < w->points->holds_per_point; i++) {
        const noh_time_hold *h = &holds[i];
        for (size_t r = 0; r < 3 && h->weight > 0.0f; r++) {
            const size_t row = 12u * (size_t)h->joint + 4u * r;
            float off[4];
            for (size_t k = 0; k < 4; k++) {
                const float from = w->from.model[row + k];
                off[k] = from + (w->to.model[row + k] - from) * part - w->right.model[row + k];
            }
            way[r] += h->weight * (off[0] * h->place[0] + off[1] * h->place[1] + off[2] * h->place[2] + off[3]);
        }
    }
    return noh_sqrt(noh_dot3(way, way));
}

static float pose_off(const work *w, float part)
{
    const noh_time_probe *p = w->probe;
    float worst = 0.0f, floats = 0.0f;
    for (size_t i = 0; i < w->points->point_count; i++) {
        float off = point_off(w, w->points->holds + i * w->points->holds_per_point, part);
        worst = off > worst ? off : worst;
    }
    for (uint32_t i = 0; p->float_reach_m && i < p->set->float_count; i++) {
        float from = w->from.floats[i], off = (from + (w->to.floats[i] - from) * part - w->right.floats[i]) * p->float_reach_m[i];
        floats += off < 0.0f ? -off : off;
    }
    return worst + floats;
}

static float worst_within(work *w, uint32_t motion, int64_t start, uint32_t period)
{
    float worst = 0.0f;
    sample(w, motion, start, &w->from);
    sample(w, motion, start + (int64_t)period, &w->to);
    for (uint32_t at = PLACE_TICKS; at < period; at += PLACE_TICKS) {
        float off;
        sample(w, motion, start + (int64_t)at, &w->right);
        off = pose_off(w, (float)at / (float)period);
        worst = off > worst ? off : worst;
    }
    return worst;
}

/* From the first tick of the motion to where it begins to repeat itself, or stands. */
static float measure(work *w, uint32_t motion, uint32_t period)
{
    const noh_motion *m = &w->probe->set->motions[motion];
    int64_t end = (int64_t)m->duration_ticks * (m->loop == NOH_LOOP_PING_PONG ? 2 : 1);
    float worst = 0.0f;
    for (int64_t start = 0; start < end; start += START_TICKS) {
        float off = worst_within(w, motion, start, period);
        worst = off > worst ? off : worst;
    }
    return worst;
}

static const char *bad_argument(const noh_time_probe *p, const noh_time_points *points, uint32_t motion, size_t *where)
{
    *where = 0;
    if (!p->set || !p->skeleton || p->skeleton->joint_count != p->set->joint_count) return "probe";
    if (!points->holds || !points->point_count || !points->holds_per_point) return "points";
    for (size_t i = 0; i < (size_t)points->point_count * points->holds_per_point; i++) {
        *where = i;
        if (points->holds[i].weight > 0.0f && points->holds[i].joint >= p->set->joint_count) return "points: no such joint";
    }
    *where = motion;
    return motion < p->set->motion_count ? NULL : "motion";
}

noh_result noh_time_points_measure(void *memory, size_t bytes, const noh_time_probe *probe, const noh_time_points *points, uint32_t motion,
                                   float *error_m, noh_error *error)
{
    size_t where, need;
    const char *what = bad_argument(probe, points, motion, &where);
    noh_arena arena = noh_arena_over(memory, bytes);
    work w;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, where, 0);
    }
    need = noh_time_points_size(probe);
    if (!memory || ((uintptr_t)memory & 15u) != 0) {
        return noh_fail(error, NOH_ERR_ARG, "memory for measuring is NULL or not 16-byte aligned", 0, need);
    }
    if (bytes < need) {
        return noh_fail(error, NOH_ERR_MEMORY, "memory for measuring is too small", bytes, need);
    }
    w.probe = probe;
    w.points = points;
    carve(&arena, probe->set, &w);
    for (int r = 0; r < NOH_RATE_COUNT; r++) {
        uint32_t period = noh_rate_period((noh_rate)r);
        error_m[r] = period ? measure(&w, motion, period) : 0.0f;
    }
    return NOH_OK;
}
