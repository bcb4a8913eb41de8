/* pack_internal.h: the private part of pack.h. */
#ifndef NOH_PACK_PACK_INTERNAL_H
#define NOH_PACK_PACK_INTERNAL_H

#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The width and height of a block, texels. */
uint32_t noh_texture_block_side(uint32_t format);

/* The bytes of a mip level; format is NOH_TEXTURE_RGBA8 or another of format.h. */
uint32_t noh_texture_bytes(uint32_t format, uint32_t width, uint32_t height);

/* Check the chunk of the n-th graph: counts, arrays, names, nodes. noh_pack_open checks only its checksum;
 * noh_pack_graph_at (graph.h) calls this function.
 * ranges  index below the pack's count of graphs
 * errors  DATA the chunk is damaged (where: the byte in the pack) */
noh_result noh_pack_check_graph(const noh_pack *pack, uint32_t index, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
