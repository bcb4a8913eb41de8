/* The error of interpolation between updates: low_stage.h, noh_time_lod_measure. */
#include "motion/anim/clip_set_internal.h"
#include "core/base/assert_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"
#include "stage/character/measure_internal.h"

size_t noh_time_lod_measure_size(const noh_time_probe *probe)
{
    noh_arena arena = noh_arena_measure();
    noh_rate_work w;
    NOH_ASSERT(probe && probe->set);
    if (noh_clip_set_excess(probe->set)) {
        return 0;
    }
    noh_rate_carve(&arena, probe->set, &w);
    return arena.used;
}

/* The largest error of any point within its joint's radius, plus the floats' error, or `least` if that is larger. The
 * floats' error is the same for all joints, so a joint matters only if it exceeds `least` without them. */
static float pose_off(void *user, const noh_time_probe *p, const noh_rate_work *w, float part, float least)
{
    const float floats = noh_rate_floats_off(p, w, part);
    float worst, enough;
    (void)user;
    worst = enough = least > floats ? least - floats : 0.0f;
    for (size_t j = 0; j < p->set->joint_count; j++) {
        const float *from = w->from.model + 12u * j, *to = w->to.model + 12u * j, *right = w->right.model + 12u * j;
        float difference[12];
        for (int i = 0; p->joint_radius_m[j] >= 0.0f && i < 12; i++) {
            difference[i] = from[i] + (to[i] - from[i]) * part - right[i];
        }
        worst = p->joint_radius_m[j] >= 0.0f ? noh_probe_off(difference, p->joint_radius_m[j], worst) : worst;
    }
    /* If nothing worse was found, `least` is returned unchanged: subtracting and adding the floats' error would let it
     * grow by rounding. */
    return (worst > enough || floats > least) && worst + floats > least ? worst + floats : least;
}

noh_result noh_time_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t clip, float *error_m,
                                noh_error *error)
{
    NOH_ASSERT(probe && error_m);
    const char *what = probe->joint_radius_m ? noh_probe_fault(probe, clip) : "probe: joint_radius_m is NULL";
    noh_result result;
    noh_arena arena;
    noh_rate_work w;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, clip, 0);
    }
    result = noh_arena_open(&arena, memory, bytes, noh_time_lod_measure_size(probe), error);
    if (result) {
        return result;
    }
    noh_rate_carve(&arena, probe->set, &w);
    noh_rate_measure(probe, clip, pose_off, NULL, &w, error_m);
    return NOH_OK;
}
