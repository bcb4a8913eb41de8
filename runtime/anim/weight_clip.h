/* weight_clip.h: sampling of morph-weight animations, raw keys as in glTF 2.0. */
#ifndef NOH_ANIM_WEIGHT_CLIP_H
#define NOH_ANIM_WEIGHT_CLIP_H

#include "pack/pack.h"

typedef struct noh_weight_clip {
    const noh_pack *pack;
    const char *name;
    const noh_weight_clip_header *header;
    const noh_weight_channel *channels; /* [channel_count] */
    const uint8_t *bytes;             /* of the chunk: key offsets count from here */
} noh_weight_clip;

/* The n-th clip. NOT_FOUND past clip_count. */
noh_result noh_pack_weight_clip(const noh_pack *pack, uint32_t index, noh_weight_clip *clip);

/* The weights of one channel at a time.
 * shapes  weights[channel->width]
 * ranges  time_s finite; before the first and after the last key their values hold
 * memory  none
 * source  glTF 2.0, appendix C: STEP, LINEAR, CUBICSPLINE */
void noh_weight_clip_sample(const noh_weight_clip *clip, uint32_t channel, float time_s, float *weights);

#endif
