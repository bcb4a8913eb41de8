/* terrain_lod.h: a height field in square blocks, each at the coarsest level that a picture allows.
 *
 *   noh_terrain_lod_size, noh_terrain_lod_init   how far each level of each block is off
 *   noh_terrain_lod_choose                       a level for each block, by its error in pixels
 *   noh_terrain_lod_block                        what is drawn of a block
 *
 * A block has NOH_TERRAIN_BLOCK cells to a side; level k leaves out all heights but every 2^k-th. Along an edge to a
 * coarser block the finer one takes that one's heights alone, so that there is no crack between any two levels.
 * Cells are split from the corner of the next row to that of the next column.
 * source   de Boer: Fast Terrain Rendering Using Geometrical MipMapping, 2000 (levels by the error of blocks)
 * Threads: pure functions of their arguments; a block of memory belongs to one thread at a time. */
#ifndef NOH_SIM_TERRAIN_LOD_H
#define NOH_SIM_TERRAIN_LOD_H

#include <stddef.h>

#include "core/base/result.h"
#include "life/physics/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_TERRAIN_BLOCK 32u
#define NOH_TERRAIN_LEVELS 6u /* the last has one cell to a block */

typedef struct noh_terrain_lod {
    noh_field field;       /* a view: its heights lie where they lay */
    uint32_t width, depth; /* blocks along x and z; the last ones may reach over the field's end */
    float *errors;         /* [width * depth][NOH_TERRAIN_LEVELS] in the field's unit: no height is farther off */
    uint16_t *bounds;      /* [width * depth][2] lowest and highest */
    uint8_t *levels;       /* [width * depth] as chosen */
    uint8_t *seen;         /* [width * depth] 0: not in the picture */
} noh_terrain_lod;

/* The exact bytes: 30 for each block, the first three arrays rounded up to 16. */
size_t noh_terrain_lod_size(const noh_field *field);

/* Looks at each height once for each level. All blocks are at level 0, and seen.
 * memory   [bytes] at least noh_terrain_lod_size, aligned to NOH_MEMORY_ALIGN; it stays with the levels
 * errors   ARG memory is NULL or misaligned, or the field has fewer than 2 x 2 heights; MEMORY it is too small */
noh_result noh_terrain_lod_init(void *memory, size_t bytes, const noh_field *field, noh_terrain_lod *out,
                                noh_error *error);

/* What is seen, and how finely: the coarsest level whose error is at most `pixels`.
 * shapes   view_projection[16] column-major, clip space of GL; eye[3]
 * height_px  lines of the picture */
void noh_terrain_lod_choose(noh_terrain_lod *lod, const float view_projection[16], const float eye[3],
                            uint32_t height_px, float pixels);

/* What is drawn of a block: side * side cells, `step` heights apart. */
typedef struct noh_terrain_piece {
    uint32_t column, row; /* of its first height */
    uint32_t side, step;
    uint32_t edges[4]; /* at -x, +x, -z, +z: of its own vertices there only every so-many-th is used, 1..side */
} noh_terrain_piece;

noh_terrain_piece noh_terrain_lod_block(const noh_terrain_lod *lod, uint32_t block);

#ifdef __cplusplus
}
#endif

#endif
