/* stage_patch.h: the marks of decal.h drawn as triangles that were grown (decal_grow.h).
 *
 *   noh_stage_patches_create   room for the triangles of one ring; _size, _delete, _restore, NOH_STAGE_PATCHES_BYTES
 *   noh_stage_patches_draw     in place of noh_stage_decals_draw
 *
 * A mark is on what hangs together with the triangle that was hit, not on a fold that only touches it at rest. Only the
 * triangles that have marks are drawn again, all of a mesh in one draw, out of the mesh's own vertices: so joints,
 * targets and the stage's other ways to move them carry every corner, to the bit. Pixels are looked up as by
 * stage_decal.h, whose programs draw them, among the marks that have grown over their triangle.
 *
 * Marks grow when they are first drawn at a level: the triangles of that level are gone through once for each mark.
 * Two levels are kept, so that nothing grows again while one fades into the other. All marks of a ring share room for
 * triangles; one that finds too little is smaller.
 *
 * Two triangles that touch by one vertex alone, both near a mark, cannot be told apart by it.
 * Threads: the context's own thread. */
#ifndef NOH_STAGE_GL_STAGE_PATCH_H
#define NOH_STAGE_GL_STAGE_PATCH_H

#include "stage/actors/decal_grow.h"
#include "gl/stage/stage_decal.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PATCH_WIDTH 256u /* texels, of the table of corners */
#define NOH_PATCH_ROWS(capacity, triangles) \
    (((capacity) + 1u + (triangles) + NOH_PATCH_WIDTH - 1u) / NOH_PATCH_WIDTH) /* of a level */

/* On the GPU: indices and a table of corners, of two levels. Neither may be 0. */
#define NOH_STAGE_PATCHES_BYTES(capacity, triangles) \
    (24u * (uint64_t)(triangles) + 8u * NOH_PATCH_WIDTH * NOH_PATCH_ROWS(capacity, triangles))

typedef struct noh_stage_patch noh_stage_patch;

/* A level's triangles, of all meshes. */
typedef struct noh_stage_patch_level {
    uint32_t level;           /* of the actor; NOH_NONE: nothing has grown */
    noh_stage_patch *patches; /* [capacity] by their place in the ring */
    uint32_t *pool;           /* [triangle_room] of patches; `used` of them */
    uint32_t *numbers;        /* [triangle_room] of the meshes, as they are in the buffer */
    uint32_t used;
    uint8_t marks[NOH_DECALS_MAX];   /* [mark_count] that are in the buffer, in order, mesh by mesh */
    uint32_t counts[NOH_DECALS_MAX]; /* [mark_count] of a mesh's numbers, where its marks begin; else 0 */
    uint32_t mark_count;
} noh_stage_patch_level;

typedef struct noh_stage_patches {
    noh_gl_drawable drawable; /* indices [2][triangle_room][3], and a GL_R32UI texture: for each level where the corners
                               * of each decal begin, then all corners, in rising order for each decal */
    noh_stage_decals *decals;
    uint32_t capacity, triangle_room;
    uint32_t kind; /* of the stage, that has grown; NOH_NONE: none */
    uint32_t last; /* of levels[], that was drawn last */
    noh_stage_patch_level levels[2];
    uint32_t *sorted;  /* [triangle_room] while corners are sent */
    uint32_t grown;    /* decals grown so far */
    uint32_t left_out; /* triangles of them that had no room */
} noh_stage_patches;

/* The exact bytes of memory, as noh_stage_patches_create has its numbers. */
size_t noh_stage_patches_size(uint32_t capacity, uint32_t triangles);

/* decals     whose programs draw them; they must stay
 * capacity   of the rings that are drawn, at most; 0: NOH_DECALS_MAX
 * triangles  of all marks together, at one level, up to 2^20; 0: NOH_DECAL_TRIANGLES for each
 * memory     [bytes] at least noh_stage_patches_size, aligned to NOH_MEMORY_ALIGN; it stays with the patches
 * errors     ARG, MEMORY as any init; MEMORY, GL as noh_gl_buffer_create: nothing is left behind */
noh_result noh_stage_patches_create(noh_stage_decals *decals, uint32_t capacity, uint32_t triangles, void *memory,
                                    size_t bytes, noh_stage_patches *out, noh_error *error);
void noh_stage_patches_delete(noh_stage_patches *patches);

/* Make their GL objects again in a new context (gl_lost.h), after those of their decals.
 * errors  as noh_stage_patches_create: they then have no GL objects */
noh_result noh_stage_patches_restore(noh_stage_patches *patches, noh_error *error);

/* As noh_stage_decals_draw. Rings take turns at the cost of growing all their marks again: give each its own.
 * ring    of that actor; its capacity at most that of the patches */
noh_result noh_stage_patches_draw(noh_stage_patches *patches, uint32_t view, noh_actor actor, const noh_decals *ring,
                                  noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
