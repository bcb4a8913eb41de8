/* wrinkle_uv.h: the texture coordinates of a wrinkled surface within 0..1, so that its textures end at their edges. */
#ifndef NOH_CONVERT_WRINKLE_WRINKLE_UV_H
#define NOH_CONVERT_WRINKLE_WRINKLE_UV_H

#include "wrinkle_strain.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bring each connected part of a mesh with triangles of the field from another tile, such as u from 1 to 2, to the tile
 * 0..1, where the material's textures repeat. A texture that repeats mixes its opposite edges at 0 and 1; on an axis on
 * which all of the surface is within 0..1 then, textures of wrinkles are clamped (field->clamped).
 * mesh  the field's mesh
 * Returns 0, or 1: out of memory. */
int wrinkle_uv_settle(const model *m, model_mesh *mesh, wrinkle_field *field);

#ifdef __cplusplus
}
#endif
#endif
