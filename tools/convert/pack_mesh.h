/* pack_mesh.h (private to the pack writer): the bytes of one mesh chunk. */
#ifndef NOH_CONVERT_PACK_MESH_H
#define NOH_CONVERT_PACK_MESH_H

#include "pack/format.h"
#include "pack_write.h"

/* The string table being built: one copy of each name. */
typedef struct string_table {
    byte_buffer bytes;
} string_table;

/* The offset of a name, added if it is new; cut to the format's limit at a character's end. */
uint32_t string_offset(string_table *strings, const char *name);

/* Append a mesh chunk. world_scale: model_mesh_scale; submesh_blends[submesh_count]: 1 where the material blends. */
void pack_mesh(const model_mesh *mesh, const morph_encoding *e, const uint8_t *submesh_blends, float world_scale, string_table *strings, byte_buffer *out);

#endif
