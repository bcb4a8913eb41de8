/* pack_mesh.h (private to the pack writer): the bytes of one mesh chunk. */
#ifndef NOH_CONVERT_PACK_PACK_MESH_H
#define NOH_CONVERT_PACK_PACK_MESH_H

#include "convert/base/byte_buffer.h"
#include "convert/lod/lod_levels.h"
#include "convert/model/model_extra.h"
#include "convert/morph/morph_encode.h"

/* Results of a mesh in addition to its chunk. */
typedef struct mesh_extra {
    uint32_t index;         /* the n-th mesh chunk */
    byte_buffer influences; /* the chunk of its influence list; empty: none. To be freed */
} mesh_extra;

typedef struct mesh_input {
    const model_mesh *mesh;
    const mesh_levels *levels;
    const morph_encoding *encoding; /* made with the levels' ranks */
    const uint8_t *submesh_blends;  /* [submesh_count] 1 if the material blends */
    float world_scale;              /* model_mesh_scale */
    uint32_t skin;                  /* the n-th skin chunk, or NOH_NONE */
    uint32_t skin_joint_count;
    const extra_plan *extras;
} mesh_input;

/* Append a mesh chunk: the full mesh and its levels. Returns 0, or 1 and a filled error if the mesh cannot be split
 * into palettes, or has no room for its extra attributes. */
int pack_mesh(const mesh_input *from, string_table *strings, byte_buffer *out, mesh_extra *extra, model_error *error);

#endif
