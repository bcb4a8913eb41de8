/* clip_codec_internal.h: the private part of low_motion.h. */
#ifndef NOH_CLIP_CLIP_CODEC_INTERNAL_H
#define NOH_CLIP_CLIP_CODEC_INTERNAL_H

#include "noh/clip.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

noh_clip_group noh_clip_group_at(const noh_clip *clip, uint32_t index);

/* Get the frame at or before a time, and the fraction 0 <= f < 1 to the next. At the tick nearest to a frame the result
 * is that frame and 0. Times are clamped to the first and last frame. Exact: computed in integers. */
uint32_t noh_clip_frame_at(const noh_clip *clip, int64_t ticks, float *fraction);

#ifdef __cplusplus
}
#endif

#endif
