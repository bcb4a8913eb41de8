/* terrain_lod_internal.h: the private part of body.h. */
#ifndef NOH_SIM_TERRAIN_LOD_INTERNAL_H
#define NOH_SIM_TERRAIN_LOD_INTERNAL_H

#include <stddef.h>

#include "noh/base.h"
#include "noh/body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Exact size in bytes: 30 per block, the first three arrays rounded up to 16. */
size_t noh_terrain_lod_size(const noh_field *field);

/* Compute all errors; reads each height once per level. All blocks start at level 0 and visible.
 * memory   [bytes] at least noh_terrain_lod_size, aligned to NOH_MEMORY_ALIGN; kept in use by *out
 * errors   ARG memory NULL or misaligned, or the field has fewer than 2 x 2 heights; MEMORY too small */
noh_result noh_terrain_lod_init(void *memory, size_t bytes, const noh_field *field, noh_terrain_lod *out,
                                noh_error *error);

/* Choose visible blocks and their levels: the coarsest with an error of at most `pixels`.
 * shapes  view_projection[16] column-major, clip space of GL; eye[3]
 * height_px  height of the picture */
void noh_terrain_lod_choose(noh_terrain_lod *lod, const float view_projection[16], const float eye[3],
                            uint32_t height_px, float pixels);

/* How to draw a block: side * side cells, `step` heights apart. */
typedef struct noh_terrain_piece {
    uint32_t column, row; /* of its first height */
    uint32_t side, step;
    uint32_t edges[4]; /* at -x, +x, -z, +z: use only every n-th of its own vertices along that edge, 1..side */
} noh_terrain_piece;

noh_terrain_piece noh_terrain_lod_block(const noh_terrain_lod *lod, uint32_t block);

#ifdef __cplusplus
}
#endif

#endif
