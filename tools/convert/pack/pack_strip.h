/* pack_strip.h: a pack without the finest levels of its meshes, made from the finished pack. */
#ifndef NOH_CONVERT_PACK_PACK_STRIP_H
#define NOH_CONVERT_PACK_PACK_STRIP_H

#include "convert/base/byte_buffer.h"
#include "convert/base/error.h"
#include "noh/pack.h"

/* Which levels stay, as given on the command line. */
typedef struct strip_levels {
    const char *const *items; /* [count] "K" for all meshes, "MESH=K" for one; the last that is for a mesh counts */
    uint32_t count;
} strip_levels;

/* Parse one item: K from 0 to NOH_LOD_LEVELS_MAX - 1. *name_bytes: of the mesh's name, 0 for all. Returns 1 if it is
 * neither. */
int strip_level_parse(const char *item, size_t *name_bytes, uint32_t *level);

/* The finest level that each mesh keeps: first[mesh_count]. A mesh with fewer levels keeps its coarsest, one that lacks
 * that level already all that it has. 0, or 1 and a filled error: an item that does not parse, or names no mesh. */
int strip_levels_of(const strip_levels *levels, const noh_pack *pack, uint32_t *first, model_error *error);

/* Cut every mesh's levels below first[mesh_count]; the rest of the pack stays as it is. Of the vertices, rectangles and
 * delta texels that levels share, the finest level that stays keeps its own. 0, or 1 and a filled error. */
int pack_strip(const noh_pack *pack, const uint32_t *first, byte_buffer *out, model_error *error);

#endif
