/* pick.h: a ray against a mesh as it is drawn, morphed and posed.
 *
 * Nothing is cloned. Each joint's box is moved as in bounds.h; a triangle is tested only where the ray meets the boxes
 * of the joints near its corners, and only then are its three corners morphed and skinned. Rigid meshes can be picked
 * too; both sides of a triangle count.
 *
 * A ray goes through what does not show: where a material cuts by alpha and the alpha is below its cutoff, and where it
 * blends and the alpha, with the tint's, rounds to 0 of 255. What blends and shows at all is hit. The alpha is that of
 * the mesh pack's texture at its first mip level, filtered between four texels, times the material's and the vertex
 * colour's: an actor's texture set does not count, and from afar, where coarser mip levels are drawn, an edge may be
 * off by a pixel.
 *
 * source  Moller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997; picking for decals: Granberg,
 *         Character Animation with Direct3D, 2009, chapters 3 and 14 (which clones the mesh and leaves rigid ones out)
 *
 * Threads: no state; any thread, each with scratch of its own. */
#ifndef NOH_DEFORM_PICK_H
#define NOH_DEFORM_PICK_H

#include "deform/skin/dual_quaternion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A mesh as it is drawn. */
typedef struct noh_pick_surface {
    const noh_mesh *mesh;
    const float *world;    /* [12] of a rigid mesh; NULL: mesh space */
    const float *matrices; /* [skin's joint_count][12]; required for a skinned mesh, unused for a rigid one */
    const noh_dual_quaternion *dual_quaternions; /* [skin's joint_count], where they draw the mesh; else NULL */
    /* NULL: corners are morphed one by one as `weights` say, where the ray comes near: slower, and without memory */
    const noh_morph_layers *layers;
    const float *weights; /* [target_count], those that the layers were accumulated with; NULL: no morph targets */
    const uint8_t *tint;  /* [4] that it is drawn with, of which alpha counts; NULL: white */
} noh_pick_surface;

typedef struct noh_pick_hit {
    float distance;             /* in lengths of the ray's direction: 0..distance_max */
    uint32_t submesh, triangle; /* triangle: its first index / 3 */
    float barycentric[3];       /* of its corners; their sum is 1 */
    float point[3];             /* as drawn */
    float bind_point[3];        /* the same place in the bind pose: for a decal that stays on the skin */
    /* an index into the skin's joints: the one with the largest weight at the point; NOH_NONE for a rigid mesh */
    uint32_t joint;
} noh_pick_hit;

/* Exact bytes of scratch for noh_pick: two boxes per joint; 0 for a rigid mesh. */
size_t noh_pick_scratch_size(const noh_mesh *mesh);

/* The nearest hit of origin + distance * direction with distance from 0 up to distance_max.
 * memory  scratch[noh_pick_scratch_size], aligned to NOH_MEMORY_ALIGN, NULL where that is 0; nothing is kept in it
 * errors  NOT_FOUND nothing is hit; ARG matrices are missing, the direction has no length, or scratch is NULL or
 *         misaligned; MEMORY scratch is too small; need: the exact bytes. *hit is then untouched */
noh_result noh_pick(const noh_pick_surface *surface, const float origin[3], const float direction[3],
                    float distance_max, void *scratch, size_t scratch_bytes, noh_pick_hit *hit, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
