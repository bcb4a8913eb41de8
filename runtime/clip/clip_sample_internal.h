/* clip_sample.h (private to anim/): a pose between two cached frames. */
#ifndef NOH_CLIP_CLIP_SAMPLE_INTERNAL_H
#define NOH_CLIP_CLIP_SAMPLE_INTERNAL_H

#include "clip/clip_internal.h"

/* out[joints], floats[float_count] or NULL; a and b are frames of the cache (may be the same). */
void noh_clip_blend_frames(const noh_clip *clip, const uint8_t *a, const uint8_t *b, float fraction, uint32_t joints,
                           noh_transform *out, float *floats);

#endif
