/* mesh_internal.h: the private part of low_core.h. */
#ifndef NOH_MESH_MESH_INTERNAL_H
#define NOH_MESH_MESH_INTERNAL_H

#include "noh/low_core.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decode a vertex's normal and tangent without normalising; their lengths are 0.57 to 1. Without tangents the tangent
 * is 0. */
void noh_mesh_directions(const noh_mesh *mesh, uint32_t index, float normal[3], float tangent[3]);

#ifdef __cplusplus
}
#endif

#endif
