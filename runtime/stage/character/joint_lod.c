#include "core/base/assert_internal.h"
#include "stage/character/joint_lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"

#include <string.h>

#include "motion/anim/clip_set_internal.h"
#include "stage/character/measure_internal.h"
#include "stage/character/time_lod_internal.h"

#define STEP_TICKS 400u /* multiples of this contain the frames at 24, 30, 60 and 120 Hz */

typedef struct work {
    noh_transform *pose;
    float *model; /* [joint_count][12] with all joints posed */
    float *kept;  /* the same with the joints of one level posed */
    float *floats;
} work;

static void carve(noh_arena *arena, const noh_clip_set *set, work *w)
{
    w->pose = (noh_transform *)noh_arena_carve(arena, set->joint_count * sizeof(noh_transform), 4);
    w->model = (float *)noh_arena_carve(arena, 12u * sizeof(float) * (size_t)set->joint_count, 4);
    w->kept = (float *)noh_arena_carve(arena, 12u * sizeof(float) * (size_t)set->joint_count, 4);
    w->floats = (float *)noh_arena_carve(arena, set->float_count * sizeof(float), 4);
}

size_t noh_joint_lod_measure_size(const noh_time_probe *probe)
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

/* The largest error of a point with the first `count` joints posed, or `worst` if that is larger. Joints are stored
 * parents first, so the first joints have the same pose as with all joints. One pass over the skipped joints builds
 * their matrices: the parent's matrix times the bind pose. Only the vertices of skipped joints can have errors. */
static float level_off(const noh_time_probe *p, work *w, uint32_t count, float worst)
{
    const noh_skeleton *s = p->skeleton;
    memcpy(w->kept, w->model, 12u * sizeof(float) * (size_t)count);
    for (uint32_t j = count; j < s->joint_count; j++) {
        float local[12], difference[12], *to = w->kept + 12u * (size_t)j;
        noh_transform_matrix(&s->bind_pose[j], local);
        noh_matrix_multiply(w->kept + 12u * (size_t)s->parents[j], local, to);
        for (int i = 0; i < 12; i++) {
            difference[i] = to[i] - w->model[12u * (size_t)j + (size_t)i];
        }
        worst = p->joint_radius_m[j] >= 0.0f ? noh_probe_off(difference, p->joint_radius_m[j], worst) : worst;
    }
    return worst;
}

static int bad_counts(const noh_skeleton *s, const uint32_t *counts, uint32_t level_count)
{
    uint32_t roots = 0, least = s->joint_count;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        roots = s->parents[j] == NOH_JOINT_ROOT ? j + 1u : roots;
    }
    for (uint32_t i = 0; i < level_count; i++) {
        if (counts[i] > least || counts[i] < roots) return 1;
        least = counts[i];
    }
    return 0;
}

noh_result noh_joint_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t clip,
                                 const uint32_t *counts, uint32_t level_count, float *error_m, noh_error *error)
{
    NOH_ASSERT(probe && counts && error_m);
    const char *what = probe->joint_radius_m ? noh_probe_fault(probe, clip) : "probe: joint_radius_m is NULL";
    noh_arena arena;
    uint32_t duration;
    work w;
    noh_result result;
    if (what || bad_counts(probe->skeleton, counts, level_count)) {
        return noh_fail(error, NOH_ERR_ARG, what ? what : "counts must decrease, and each must include all root joints",
                        clip, 0);
    }
    result = noh_arena_open(&arena, memory, bytes, noh_joint_lod_measure_size(probe), error);
    if (result) {
        return result;
    }
    carve(&arena, probe->set, &w);
    memset(error_m, 0, level_count * sizeof *error_m);
    duration = probe->set->clips[clip].duration_ticks;
    for (int64_t tick = 0; tick < (int64_t)duration + (int64_t)STEP_TICKS; tick += STEP_TICKS) {
        noh_probe_sample(probe, clip, tick < (int64_t)duration ? tick : (int64_t)duration, NULL, w.pose, w.model,
                         w.floats);
        for (uint32_t i = 0; i < level_count; i++) {
            error_m[i] = level_off(probe, &w, counts[i], error_m[i]);
        }
    }
    /* A coarser level may have a smaller error by chance; errors of a LOD table must not decrease. */
    for (uint32_t i = 1; i < level_count; i++) {
        error_m[i] = error_m[i] > error_m[i - 1] ? error_m[i] : error_m[i - 1];
    }
    return NOH_OK;
}
