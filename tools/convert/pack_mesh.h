/* pack_mesh.h (private to the pack writer): the bytes of one mesh chunk. */
#ifndef NOH_CONVERT_PACK_MESH_H
#define NOH_CONVERT_PACK_MESH_H

#include "byte_buffer.h"
#include "morph_encode.h"

/* Append a mesh chunk. world_scale: model_mesh_scale; submesh_blends[submesh_count]: 1 where the material blends. */
void pack_mesh(const model_mesh *mesh, const morph_encoding *e, const uint8_t *submesh_blends, float world_scale,
               string_table *strings, byte_buffer *out);

#endif
