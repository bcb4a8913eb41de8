/* decal_grow.h: a mark as triangles of its own: those of the mesh that it lies on.
 *
 *   noh_decal_grow   the triangles of a mark, from the one that was hit outwards
 *   noh_decal_again  which triangle it grows from at another level
 *   noh_decal_uv     where in its square a place of the bind pose lies
 *
 * noh_gl.h looks marks up by each pixel: whatever lies within a mark's sphere at rest and faces as it
 * does has it, also a fold that only touches there. A patch has what hangs together with the triangle that was hit
 * alone; noh_gl.h draws it. A corner is a vertex of the mesh itself, so that joints and targets carry it
 * with no copy, and coordinates follow from where the vertex rests. Triangles are whole ones: what lies outside of 0..1
 * is to be discarded. A patch holds for one level: grow it again when the level changes, from the triangle of
 * noh_decal_again, or from NOH_NONE.
 *
 * A triangle belongs to a mark if it comes as near as the square's corners to its centre: not if a corner does, or a
 * mark within one large triangle has none. Triangles hang together by an edge whose ends are the same places.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 14
 * Threads: no state. Errors: none; a hostile mesh that a pack has opened is safe. */
#ifndef NOH_ACTORS_DECAL_GROW_H
#define NOH_ACTORS_DECAL_GROW_H

#include "noh/marks.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_decal_patch {
    uint32_t *triangles; /* [room] yours; [count] are the mark's: the first is the one it grew from. Corners are indices
                          * 3 t to 3 t + 2 of the mesh */
    uint32_t room, count;
    uint32_t left_out; /* that come near, and had no room: a mark without room for all is smaller */
    uint32_t lone;     /* that come near, but do not hang together with these */
} noh_decal_patch;

/* mesh      at the level that shows (noh_mesh_at_lod)
 * triangle  of that level, that was hit; NOH_NONE: the one nearest to the centre that faces as the mark does
 * out       triangles and room are set; whatever comes near needs room while it grows. count 0: there is none near */
void noh_decal_grow(const noh_decal *decal, const noh_mesh *mesh, uint32_t triangle, noh_decal_patch *out);

/* The triangle to grow from at another level: of those that have a corner of the patch before, the nearest to the
 * centre that faces as the mark does. So a mark stays on its own fold, even where levels bring another one nearer.
 * before       at the level of mesh_before
 * mesh_before  of the same mesh as `mesh`: vertices keep their numbers
 * returns      NOH_NONE: there is none: the levels have no corner there in common */
uint32_t noh_decal_again(const noh_decal *decal, const noh_decal_patch *before, const noh_mesh *mesh_before,
                         const noh_mesh *mesh);

/* 0..1 within the square; v is down, as tiles of a picture have it. */
void noh_decal_uv(const noh_decal *decal, const float bind_position[3], float uv[2]);

#ifdef __cplusplus
}
#endif

#endif
