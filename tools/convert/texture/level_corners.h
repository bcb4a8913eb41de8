/* level_corners.h: the triangles that read textures, on each level of a mesh. */
#ifndef NOH_CONVERT_TEXTURE_LEVEL_CORNERS_H
#define NOH_CONVERT_TEXTURE_LEVEL_CORNERS_H

#include "convert/lod/lod_levels.h"
#include "convert/model/model.h"

/* The triangles of a submesh on a level. */
typedef struct level_corners {
    const uint32_t *vertices;
    uint32_t count;
} level_corners;

/* of: a mesh's, or NULL: the full mesh alone. Returns the number of its levels, at least 1. */
uint32_t level_count_of(const mesh_levels *of);
level_corners level_corners_of(const model_mesh *mesh, const mesh_levels *of, uint32_t level, uint32_t submesh);

#endif
