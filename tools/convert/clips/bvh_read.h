/* bvh_read.h: .bvh, the exchange format of motion capture.
 *
 * Channels may stand in any order on any joint; rotations are composed in the order of
 * the file, the first outermost. Position channels replace the offset on their axes.
 * One frame per line, as many as announced (one more is a warning). End sites become
 * raw_joint.end, not joints: they cannot move, so they need no tracks. Frames are in the file's own unit. */
#ifndef NOH_CONVERT_CLIPS_BVH_READ_H
#define NOH_CONVERT_CLIPS_BVH_READ_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bvh_options {
    double unit_cm; /* centimetres per unit of the file; 0: 1 */
    int end_joints; /* keep end sites as leaf joints named "<parent>_end" */
} bvh_options;

/* One skeleton, one clip named after the file. options may be NULL. Returns 0 and *out,
 * to be freed with raw_set_free, or 1 and *error, whose `where` is a line number. */
int bvh_read(const char *path, const bvh_options *options, raw_set **out, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
