/* level_fixture.h: packs with LOD levels, made from packs without. Triangles whose corners fall into one cell of a grid
 * are left out, and cells are twice as large from level to level. Plain C, so that the cross tests have it too. */
#ifndef NOH_TESTS_SUPPORT_LEVEL_FIXTURE_H
#define NOH_TESTS_SUPPORT_LEVEL_FIXTURE_H

#include "support.h"
#include "noh/pack.h"

typedef struct fixture_levels {
    uint8_t *bytes;
    noh_pack pack;
    uint32_t **orders; /* [mesh_count][vertex_count]: each vertex's number in the original pack */
} fixture_levels;

/* Every mesh of `from` with `level_count` levels, in a pack that noh_pack_open accepts. cell: the edge of level 1's
 * cells, model units. In the coarsest level the first target has no rectangles. */
void fixture_levels_open(fixture_levels *f, const noh_pack *from, uint32_t level_count, float cell);
void fixture_levels_close(fixture_levels *f);

#endif
