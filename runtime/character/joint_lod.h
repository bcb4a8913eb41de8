/* joint_lod.h: what posing fewer joints costs (row C16.4).
 *
 * A joint level poses the first joints of a skeleton; each of the others goes where its parent goes, in
 * the bind pose's place relative to it, and so does what hangs on it. The converter measures each clip so and
 * stores the errors (noh_pack_motion.joint_errors); a program that made its skeleton itself, or that puts a
 * clip on a mesh that the converter did not see, measures when it loads. */
#ifndef NOH_CHARACTER_JOINT_LOD_H
#define NOH_CHARACTER_JOINT_LOD_H

#include "character/time_lod.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of the working memory that measuring takes. */
size_t noh_joint_lod_measure_size(const noh_time_probe *probe);

/* Measure what a motion, from its first tick to its last, is off at most in each level: every 400 ticks, for any
 * point within a joint's reach of it, in object space. Floats do not count.
 * shapes  counts[level_count] joints, the first ones, falling, each with all joints that have no parent;
 *         error_m[level_count], not falling: no level is said to be better than a finer one
 * units   model units, as metres
 * memory  16-byte aligned
 * errors  ARG probe, motion, counts, memory; MEMORY need: the bytes
 * A largest value found, as noh_time_lod_measure has it */
noh_result noh_joint_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t motion, const uint32_t *counts,
                                 uint32_t level_count, float *error_m, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
