/* vertex_copy.h: copies of vertices, after a mesh's own. */
#ifndef NOH_CONVERT_MODEL_VERTEX_COPY_H
#define NOH_CONVERT_MODEL_VERTEX_COPY_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Append a copy of each vertex of a list, with all that a vertex has; no triangle uses them yet. sources [count]. The
 * mesh must own its arrays. 0, or 1 when out of memory: the mesh is as it was. */
int model_copy_vertices(model_mesh *mesh, const uint32_t *sources, uint32_t count);

#ifdef __cplusplus
}
#endif
#endif
