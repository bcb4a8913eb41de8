/* source_pose.h: a skeleton's poses by a source's curves, in double precision.
 *
 * Poses are local: [joint_count][10] of rotation, translation, scale; or matrices in object space: [joint_count][12],
 * three columns and the translation. */
#ifndef NOH_CONVERT_CLIPS_SOURCE_POSE_H
#define NOH_CONVERT_CLIPS_SOURCE_POSE_H

#include "convert/clips/raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SOURCE_LOCAL 10u

/* The bind pose. */
void source_rest(const raw_skeleton *skeleton, double *locals);

/* What a channel moves of a joint, set to its value at a time; snap_s as channel_sample has it. */
void source_channel(const model_channel *channel, uint32_t joint, double time_s, double snap_s, double *locals);

/* The joint that each channel of a clip moves, or MODEL_NONE: out[channel_count]. */
void source_joints(const raw_skeleton *skeleton, const model_clip *clip, uint32_t *out);

/* A clip at a time: by its source's curves, or, where it has none, by its frames as they are played. Joints that
 * nothing moves keep what they have. joints: of the source's channels. */
void source_locals(const raw_clip *clip, const uint32_t *joints, double time_s, double *locals);

/* Between two poses as frames are played: lerp, rotations normalised. */
void source_blend(uint32_t joint_count, const double *a, const double *b, double at, double *out);

void source_object(const raw_skeleton *skeleton, const double *locals, double *pose);

#ifdef __cplusplus
}
#endif
#endif
