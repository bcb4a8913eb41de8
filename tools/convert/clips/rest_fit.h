/* rest_fit.h: a clip of one body played by another: each joint turns from its own rest pose as its counterpart does
 * from the other's, in the world's axes, and the topmost moves by the share of its height. Both rest in the same pose,
 * as VRM's bodies do in a T (VRMC_vrm_animation 1.0, "how to transform"). */
#ifndef NOH_CONVERT_CLIPS_REST_FIT_H
#define NOH_CONVERT_CLIPS_REST_FIT_H

#include "convert/clips/raw_clip.h"

/* Fill the frames of `out`, which has the joints of `to`, in the unit of `from`.
 * counterpart  [to->joint_count] joint of `from`, or MODEL_NONE: it keeps its rest pose
 * Returns 1 when out of memory. */
int rest_fit_clip(const raw_skeleton *from, const raw_skeleton *to, const uint32_t *counterpart, const raw_clip *clip,
                  raw_clip *out);

#endif
