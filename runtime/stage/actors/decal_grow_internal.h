/* decal_grow_internal.h: the triangles of a mesh that a decal covers.
 *
 *   noh_decal_grow   find the triangles of a decal, from the one that was hit outwards
 *   noh_decal_again  find the triangle to grow from at another LOD level
 *   noh_decal_uv     texture coordinates of a place in the bind pose
 *
 * noh_gl.h projects decals: a fold that only touches the decal in the bind pose shows it, too. A patch has only
 * the triangles connected to the one that was hit; noh_gl.h draws it. Its corners are vertices of the mesh
 * itself, so joints and targets carry them without a copy, and texture coordinates follow from their places in the
 * bind pose. Triangles are not clipped: discard coordinates outside 0..1. A patch is valid for one LOD level: grow it
 * again when the level changes, from the triangle of noh_decal_again or from NOH_NONE.
 *
 * A triangle belongs to a decal if any of its points, not only a corner, is as near to the centre as the corners of the
 * square: a decal within one large triangle has that triangle. Triangles are connected by an edge whose ends have the
 * same places.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 14
 * Threads: no state. Errors: none; any mesh of an opened pack is safe. */
#ifndef NOH_ACTORS_DECAL_GROW_INTERNAL_H
#define NOH_ACTORS_DECAL_GROW_INTERNAL_H

#include "noh/marks.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_decal_patch {
    uint32_t *triangles; /* [room], the first [count] belong to the decal; it grew from the first one. Triangle t has
                          * the indices 3 t to 3 t + 2 of the mesh */
    uint32_t room, count;
    uint32_t left_out; /* near triangles without room: the decal is smaller */
    uint32_t lone;     /* near triangles that are not connected */
} noh_decal_patch;

/* mesh      at the LOD level that shows (noh_mesh_at_lod)
 * triangle  of that level, that was hit; NOH_NONE: the one nearest to the centre that faces as the decal does
 * out       set triangles and room; all near triangles need room while it grows. count 0: none is near */
void noh_decal_grow(const noh_decal *decal, const noh_mesh *mesh, uint32_t triangle, noh_decal_patch *out);

/* Find the triangle to grow from at another LOD level: among triangles with a corner of the previous patch, the nearest
 * to the centre that faces as the decal does. This keeps a decal on its own fold.
 * before       the patch at the level of mesh_before
 * mesh_before  the same mesh as `mesh` at another level: vertices keep their numbers
 * returns      NOH_NONE: the levels have no such corner in common */
uint32_t noh_decal_again(const noh_decal *decal, const noh_decal_patch *before, const noh_mesh *mesh_before,
                         const noh_mesh *mesh);

/* uv is 0..1 within the square; v points down. */
void noh_decal_uv(const noh_decal *decal, const float bind_position[3], float uv[2]);

#ifdef __cplusplus
}
#endif

#endif
