/* joint_lod_internal.h: the error of posing fewer joints.
 *
 * A joint level poses a prefix of a skeleton's joints; the other joints keep their bind pose relative to their parents.
 * The converter measures every clip and stores the errors (noh_pack_clip.joint_errors). Measure at load time for a
 * skeleton made by hand, or for a clip on a mesh that was not in its build.
 *
 * Threads: as low_stage.h. */
#ifndef NOH_CHARACTER_JOINT_LOD_INTERNAL_H
#define NOH_CHARACTER_JOINT_LOD_INTERNAL_H

#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/low_stage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of working memory for measuring; 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX. */
size_t noh_joint_lod_measure_size(const noh_time_probe *probe);

/* Measure the largest error of a clip, from its first tick to its last, at each joint level: every 400 ticks, for any
 * point within a joint's radius, in object space. Floats are not included. The result is the largest error found, not a
 * proof for all ticks (see noh_time_lod_measure).
 * shapes  counts[level_count]: joints posed, decreasing, all roots in each; error_m[level_count], never decreasing
 * units   model units, taken as metres
 * errors  ARG probe, clip, counts, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the
 *         exact bytes) */
noh_result noh_joint_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t clip,
                                 const uint32_t *counts, uint32_t level_count, float *error_m, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
