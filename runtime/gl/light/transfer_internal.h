/* transfer_internal.h: how targets change occlusion, with the same arithmetic on CPU and GPU. Threads: no state.
 *
 * The terms are (delta * ratio) * (position_scale * weight). Accumulators also multiply positions by the last product,
 * so occlusion needs no weight of its own. */
#ifndef NOH_LIGHT_TRANSFER_INTERNAL_H
#define NOH_LIGHT_TRANSFER_INTERNAL_H

#include "noh/format.h"
#include "noh/pack.h"

/* A target's occlusion scale divided by its position scale; 0 for targets that move nothing, or next to nothing. */
static inline float noh_transfer_ratio(const noh_mesh *mesh, uint32_t target)
{
    const noh_transfer_header *h = mesh->transfer;
    const float *scales = h ? (const float *)(const void *)((const uint8_t *)h + h->scales_offset) : NULL;
    const float scale = mesh->targets[target].position_scale;
    const float ratio = scales && scale > 0.0f ? scales[target] / scale : 0.0f;
    return ratio < 1e30f ? ratio : 0.0f;
}

/* The stored difference at a delta texel; 0 if the target does not move the vertex, which is then not in lists by
 * vertex. */
static inline int32_t noh_transfer_delta(const noh_mesh *mesh, uint32_t texel)
{
    const noh_transfer_header *h = mesh->transfer;
    const int8_t *deltas = h ? (const int8_t *)h + h->deltas_offset : NULL;
    const uint32_t *words = mesh->texels + 3u * (size_t)texel;
    return deltas && (words[0] | words[1] | words[2]) ? deltas[texel] : 0;
}

#endif
