/* mesh_layout.h (private to the pack writer): which vertex goes where, and which palette draws it.
 *
 * Vertices lie by LOD level, the coarsest first, and within a level in the morph encoder's order. Where a
 * skinned mesh needs more joints than its palette holds, its triangles are shared out among several palettes
 * (palette_deal.h); a vertex that several palettes need is doubled, and its copies share one accumulation texel. */
#ifndef NOH_CONVERT_PACK_MESH_LAYOUT_H
#define NOH_CONVERT_PACK_MESH_LAYOUT_H

#include "convert/lod/lod_levels.h"
#include "convert/morph/morph_encode.h"
#include "noh/base.h"
#include "noh/format.h"

/* One LOD level: how many of the first vertices, and its ranges of indices and submeshes. */
typedef struct level_layout {
    uint32_t vertex_count;
    uint32_t first_index, index_count;
    uint32_t first_submesh, submesh_count;
} level_layout;

typedef struct mesh_layout {
    uint32_t vertex_count, index_count, submesh_count, palette_count, palette_joint_count; /* of all levels */
    uint32_t level_count;
    level_layout levels[NOH_LOD_LEVELS_MAX];
    int texel_references;   /* vertex n does not use texel n for all n: NOH_MESH_TEXELS */
    uint32_t *source;       /* [vertex_count] the model's vertex */
    uint32_t *texel;        /* [vertex_count] as in the pack's texel reference */
    uint32_t *palette;      /* [vertex_count] */
    uint32_t *indices;      /* [index_count] each submesh's triangles in an order good for vertex caches and overdraw */
    noh_submesh *submeshes; /* [submesh_count] first_index counted from the level's first */
    noh_palette *palettes;  /* [palette_count] 0 for a rigid mesh */
    uint16_t *palette_joints; /* [palette_joint_count] places in the skin's joints, ascending in each palette */
} mesh_layout;

/* submesh_blends[the mesh's submesh_count]: 1 if the order of triangles must be kept. 0, or 1 and a filled error; free
 * in both cases. */
int mesh_layout_make(const model_mesh *mesh, const mesh_levels *levels, const morph_encoding *e,
                     const uint8_t *submesh_blends, mesh_layout *out, model_error *error);
void mesh_layout_free(mesh_layout *layout);

#endif
