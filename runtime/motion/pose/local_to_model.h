/* local_to_model.h: from a pose to matrices.
 *
 * A matrix has 3 rows of 4, stored by row: position = rows * (x, y, z, 1), the layout of noh_node.world and of palettes
 * in uniform buffers or textures; 48 bytes per joint. Column vectors: model = parent's model * local.
 *
 * source  C. Granberg, "Character Animation with Direct3D", Charles River Media 2009, chapter 3
 *
 * Threads: pure functions of their arguments; any thread. */
#ifndef NOH_POSE_LOCAL_TO_MODEL_H
#define NOH_POSE_LOCAL_TO_MODEL_H

#include "motion/pose/skeleton.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Compute translation * rotation * scale of one joint. */
void noh_transform_matrix(const noh_transform *t, float matrix[12]);

/* Multiply: out = a * b; out may be a or b. */
void noh_matrix_multiply(const float a[12], const float b[12], float out[12]);

/* Compute model-space matrices in one pass over the joints.
 * shapes  pose[joint_count], model[joint_count][12]
 * ranges  joint_count at most the skeleton's; a LOD level uses the first joints only */
void noh_local_to_model(const noh_skeleton *skeleton, const noh_transform *pose, uint32_t joint_count, float *model);

/* Compute skinning matrices: model * inverse bind.
 * shapes  model[joint_count][12], palette[joint_count][12]; palette may be model */
void noh_model_to_palette(const noh_skeleton *skeleton, const float *model, uint32_t joint_count, float *palette);

#ifdef __cplusplus
}
#endif

#endif
