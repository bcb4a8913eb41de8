/* mesh_layout.h (private to the pack writer): which vertex goes where, and which palette draws it.
 *
 * Vertices lie in the morph encoder's order. Where a skinned mesh needs more joints than
 * its palette holds, its triangles are dealt out to several palettes (greedy by triangle,
 * row C3.6); a vertex that several palettes need is doubled behind all others and shares
 * the first one's morph texel. */
#ifndef NOH_CONVERT_MESH_LAYOUT_H
#define NOH_CONVERT_MESH_LAYOUT_H

#include "morph_encode.h"
#include "pack/format.h"

typedef struct mesh_layout {
    uint32_t vertex_count, index_count, submesh_count, palette_count, palette_joint_count;
    uint32_t *source;         /* [vertex_count] the model's vertex */
    uint32_t *texel;          /* [vertex_count] the vertex whose morph texel it shares */
    uint32_t *palette;        /* [vertex_count] */
    uint32_t *indices;        /* [index_count] each submesh's triangles in an order good for vertex caches */
    noh_submesh *submeshes;   /* [submesh_count] */
    noh_palette *palettes;    /* [palette_count] 0 for a rigid mesh */
    uint16_t *palette_joints; /* [palette_joint_count] places in the skin's joints, ascending in each palette */
} mesh_layout;

/* submesh_blends[the mesh's submesh_count]: 1 where the order of triangles is to be kept. 0, or 1 and a filled
 * error; free in both cases. */
int mesh_layout_make(const model_mesh *mesh, const morph_encoding *e, const uint8_t *submesh_blends, mesh_layout *out,
                     model_error *error);
void mesh_layout_free(mesh_layout *layout);

#endif
