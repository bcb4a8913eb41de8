/* clip_sample_internal.h (private to clip/): a pose between two cached frames. */
#ifndef NOH_CLIP_CLIP_SAMPLE_INTERNAL_H
#define NOH_CLIP_CLIP_SAMPLE_INTERNAL_H

#include "motion/clip/clip_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

/* Blend frames a and b of the cache, which may be the same one.
 * shapes  out[joints], floats[float_count of the clip] (NULL: not wanted)
 * ranges  fraction 0..1, from a to b */
void noh_clip_blend_frames(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t joints,
                           noh_transform *out, float *floats);

#endif
