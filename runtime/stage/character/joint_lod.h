/* joint_lod.h: the error of posing fewer joints.
 *
 * A joint level poses a prefix of a skeleton's joints; each of the others keeps its bind pose relative to its parent,
 * and its vertices move with it. The converter measures every clip in this way and stores the errors
 * (noh_pack_clip.joint_errors); measure at load time for a skeleton made by hand, or for a clip on a mesh that the
 * converter did not see.
 *
 * Threads: as time_lod.h. */
#ifndef NOH_CHARACTER_JOINT_LOD_H
#define NOH_CHARACTER_JOINT_LOD_H

#include "stage/character/time_lod.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of the working memory that measuring takes; 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX. */
size_t noh_joint_lod_measure_size(const noh_time_probe *probe);

/* Measure the largest error of a clip, from its first tick to its last, at each joint level: every 400 ticks, for any
 * point within a joint's radius, in object space. Floats do not count. The result is the largest error found, not a
 * proof for all ticks (see noh_time_lod_measure).
 * shapes  counts[level_count]: joints posed, falling, each prefix with all joints that have no parent;
 *         error_m[level_count], never falling
 * units   model units, taken as metres
 * errors  ARG probe, clip, counts, or memory NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small; need: the exact
 * bytes */
noh_result noh_joint_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t clip,
                                 const uint32_t *counts, uint32_t level_count, float *error_m, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
