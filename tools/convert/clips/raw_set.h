/* raw_set.h: allocates, frees and inspects raw clips (raw_clip.h).
 *
 *   raw_set_new, raw_set_free       a set on the heap
 *   raw_set_clear                   frees the contents of a set, not the set itself
 *   raw_skeleton_alloc              joints, all with an identity bind pose
 *   raw_clip_alloc, raw_clip_clear  frames
 *   raw_clip_add_event              keeps the events in time order
 *   raw_skeleton_hash               binds the clips of one pack to the skeleton of another
 *   raw_pose_object                 a pose in object space, double precision */
#ifndef NOH_CONVERT_CLIPS_RAW_SET_H
#define NOH_CONVERT_CLIPS_RAW_SET_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RAW_JOINTS_MAX 4096u
#define RAW_FRAMES_MAX (1u << 20)             /* 2.4 hours at 120 Hz */
#define RAW_BYTES_MAX (UINT64_C(1) << 28)     /* of one file's frames; pack_clips.c encodes 160 MiB of joints at most */
#define RAW_EVENTS_MAX 65536u                 /* in one clip */
#define RAW_JOINT_BYTES (10u * sizeof(float)) /* of one joint in one frame */

/* All return NULL, or 1, when out of memory. */
raw_set *raw_set_new(uint32_t joint_count, uint32_t clip_count);
void raw_set_free(raw_set *set);
void raw_set_clear(raw_set *set);
int raw_skeleton_alloc(raw_skeleton *skeleton, uint32_t joint_count);
/* Take another skeleton's joints and bind pose, in the unit that it has. */
int raw_skeleton_take(raw_skeleton *skeleton, const raw_skeleton *from);
/* Frames of zeros, to be filled; the clip's other fields are untouched. */
int raw_clip_alloc(raw_clip *clip, uint32_t frame_count, uint32_t joint_count);
int raw_floats_alloc(raw_floats *floats, uint32_t frame_count, uint32_t width);
void raw_floats_clear(raw_floats *floats);
void raw_clip_clear(raw_clip *clip);

/* Add a copy, after all events of the same time. The caller keeps the count within RAW_EVENTS_MAX. */
int raw_clip_add_event(raw_clip *clip, const raw_event *event);

double raw_clip_duration_s(const raw_clip *clip);

/* FNV-1a, 32 bits, over the joint count and each joint's name and parent: skeletons
 * of the same joints in the same order agree, whatever their bind poses. */
uint32_t raw_skeleton_hash(const raw_skeleton *skeleton);

/* Object space matrices, in the skeleton's unit, of a frame or (clip NULL) of the bind pose.
 * out  [joint_count][12]: three columns and the translation */
void raw_pose_object(const raw_skeleton *skeleton, const raw_clip *clip, uint32_t frame, double *out);

/* The object space matrix of a joint, whose parent (MODEL_NONE: none) comes before it, from its local one. */
void raw_pose_below(uint32_t parent, const double *local, size_t joint, double *pose);

/* The radius of each joint: the largest distance, in centimetres and in the bind pose, to one of the joints and ends
 * below it, which an error of its rotation would move. out [joint_count]. *size_cm: the largest of them. Returns 1 when
 * out of memory. */
int raw_skeleton_radius(const raw_skeleton *skeleton, double *out, double *size_cm);

#ifdef __cplusplus
}
#endif
#endif
