/* rcl.h: .rcl, raw clips without loss.
 *
 * Little-endian, 32-bit floats, distances in centimetres:
 *   char[4] "RCL1"; u32 joints; u32 frames; f32 rate_hz; u32 length; char name[length]
 *   per joint: i32 parent (-1: a root; parents first); u32 flags (1 rotation, 2 translation,
 *     4 scale animated); u32 length; char name[length]; f32 bind[10]; f32 first[10],
 *     both qx qy qz qw tx ty tz sx sy sz, local to the parent
 *   per frame, per joint: the animated ones of q[4], t[3], s[3]; the others equal first[] */
#ifndef NOH_CONVERT_CLIPS_RCL_H
#define NOH_CONVERT_CLIPS_RCL_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One skeleton, one clip. Returns 0 and *out, to be freed with raw_set_free, or 1 and
 * *error, whose `where` is a byte offset. */
int rcl_read(const char *path, raw_set **out, model_error *error);

/* Joints only: the format has no floats and no events. A clip read from .rcl is written back to the same bytes; other
 * units are converted to centimetres. On failure an existing file is untouched. */
int rcl_write(const char *path, const raw_skeleton *skeleton, const raw_clip *clip, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
