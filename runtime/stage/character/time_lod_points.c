#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"

#include "motion/anim/clip_set_internal.h"
#include "core/base/math_internal.h"
#include "stage/character/measure_internal.h"

typedef struct work {
    const noh_time_lod_points *points;
    float *off;   /* [joint_count][12] the error of each joint's matrix: shown minus true */
    float *reach; /* [joint_count] the distance of the farthest point held by a joint, times `weight` */
    float weight; /* largest sum of a point's weights */
    noh_rate_work rates;
} work;

static void carve(noh_arena *arena, const noh_clip_set *set, work *w)
{
    noh_rate_carve(arena, set, &w->rates);
    w->off = (float *)noh_arena_carve(arena, 12u * sizeof(float) * (size_t)set->joint_count, 4);
    w->reach = (float *)noh_arena_carve(arena, sizeof(float) * (size_t)set->joint_count, 4);
}

size_t noh_time_lod_points_size(const noh_time_probe *probe)
{
    noh_arena arena = noh_arena_measure();
    work w;
    NOH_ASSERT(probe && probe->set);
    if (noh_clip_set_excess(probe->set)) {
        return 0;
    }
    carve(&arena, probe->set, &w);
    return arena.used;
}

/* A point's error, squared. Skinning is linear in the matrices, so the error of the skinned point is found by skinning
 * it with the errors of its joints' matrices. */
static float point_off(const noh_time_hold *holds, uint32_t count, const float *off)
{
    float error[3] = { 0.0f, 0.0f, 0.0f };
    for (uint32_t i = 0; i < count; i++) {
        const noh_time_hold *h = &holds[i];
        for (size_t r = 0; r < 3 && h->weight > 0.0f; r++) {
            const float *row = off + 12u * (size_t)h->joint + 4u * r;
            error[r] += h->weight * (row[0] * h->place[0] + row[1] * h->place[1] + row[2] * h->place[2] + row[3]);
        }
    }
    return noh_dot3(error, error);
}

/* A bound for all points: for each joint, the displacement of its farthest point by the joint's error, from the
 * Frobenius norm. A joint costs as much as a point, and for most poses, in which a clip moves little or evenly, the
 * bound is enough. */
static float most_off(const work *w, uint32_t joint_count)
{
    float most = 0.0f;
    for (size_t j = 0; j < joint_count; j++) {
        const float *off = w->off + 12u * j;
        float linear = 0.0f, shift = 0.0f, bound;
        for (size_t r = 0; r < 12; r += 4) {
            linear += noh_dot3(off + r, off + r);
            shift += off[r + 3u] * off[r + 3u];
        }
        if (w->reach[j] < 0.0f) continue;
        bound = noh_sqrt(linear) * w->reach[j] + noh_sqrt(shift) * w->weight;
        most = bound > most ? bound : most;
    }
    return most * 1.001f; /* above the rounding error */
}

static float pose_off(void *user, const noh_time_probe *p, const noh_rate_work *w, float part, float least)
{
    const work *own = (const work *)user;
    const noh_time_lod_points *points = own->points;
    float worst = 0.0f, floats_off;
    for (size_t i = 0; i < 12u * (size_t)p->set->joint_count; i++) {
        const float from = w->from.model[i];
        own->off[i] = from + (w->to.model[i] - from) * part - w->right.model[i];
    }
    floats_off = noh_rate_floats_off(p, w, part);
    if (most_off(own, p->set->joint_count) + floats_off < least) return least;
    for (size_t i = 0; i < points->point_count; i++) {
        const float off = point_off(points->holds + i * points->holds_per_point, points->holds_per_point, own->off);
        worst = off > worst ? off : worst;
    }
    worst = noh_sqrt(worst) + floats_off;
    return worst > least ? worst : least;
}

static void measure_reach(const noh_time_lod_points *points, uint32_t joint_count, work *w)
{
    w->weight = 0.0f;
    for (uint32_t j = 0; j < joint_count; j++) w->reach[j] = -1.0f;
    for (size_t i = 0; i < points->point_count; i++) {
        const noh_time_hold *holds = points->holds + i * points->holds_per_point;
        float sum = 0.0f;
        for (uint32_t k = 0; k < points->holds_per_point; k++) {
            const float away = noh_sqrt(noh_dot3(holds[k].place, holds[k].place));
            if (!(holds[k].weight > 0.0f)) continue;
            sum += holds[k].weight;
            if (!(away <= w->reach[holds[k].joint])) w->reach[holds[k].joint] = away;
        }
        w->weight = sum > w->weight ? sum : w->weight;
    }
    for (uint32_t j = 0; j < joint_count; j++) w->reach[j] *= w->weight;
}

static const char *bad_argument(const noh_time_probe *p, const noh_time_lod_points *points, uint32_t clip,
                                size_t *where)
{
    const char *what = noh_probe_fault(p, clip);
    *where = clip;
    if (what) return what;
    *where = 0;
    if (!points->holds || !points->point_count || !points->holds_per_point)
        return "points: holds is NULL, or a count is 0";
    for (size_t i = 0; i < (size_t)points->point_count * points->holds_per_point; i++) {
        *where = i;
        if (points->holds[i].weight > 0.0f && points->holds[i].joint >= p->set->joint_count)
            return "points: a joint is not in the skeleton";
    }
    return NULL;
}

noh_result noh_time_lod_points_measure(void *memory, size_t bytes, const noh_time_probe *probe,
                                       const noh_time_lod_points *points, uint32_t clip, float *error_m,
                                       noh_error *error)
{
    size_t where;
    const char *what = bad_argument(probe, points, clip, &where);
    noh_arena arena;
    noh_result result;
    work w;
    NOH_ASSERT(probe && points && error_m);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, where, 0);
    }
    result = noh_arena_open(&arena, memory, bytes, noh_time_lod_points_size(probe), error);
    if (result) {
        return result;
    }
    carve(&arena, probe->set, &w);
    w.points = points;
    measure_reach(points, probe->set->joint_count, &w);
    noh_rate_measure(probe, clip, pose_off, &w, &w.rates, error_m);
    return NOH_OK;
}
