/* pick.h: ray intersection with a mesh as it is drawn, morphed and posed.
 *
 * The mesh is not copied. Each joint's box is moved as in bounds.h; a triangle is tested only if the ray hits the boxes
 * of the joints near its corners, and only then are its corners morphed and skinned. Rigid meshes work too. Both sides
 * of a triangle count.
 *
 * The ray passes through invisible surfaces: where a material with an alpha cutoff has alpha below it, and where a
 * blended material's alpha, times the tint's, rounds to 0 of 255. Any visible blended surface is hit. Alpha is the
 * texture of the mesh's pack at its first mip level, filtered bilinearly, times the alpha of material and vertex
 * colour. An actor's texture set is ignored, and at a distance, where coarser mip levels are drawn, an edge may be off
 * by a pixel.
 *
 * source  Moller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997; picking for decals: Granberg,
 *         Character Animation with Direct3D, 2009, chapters 3 and 14 (which clones the mesh and excludes rigid ones)
 *
 * Threads: no state; any thread, each with its own scratch. */
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
    const noh_dual_quaternion *dual_quaternions; /* [skin's joint_count] if the mesh is drawn with them; else NULL */
    /* NULL: corners near the ray are morphed one by one with `weights`: slower, but needs no memory */
    const noh_morph_layers *layers;
    const float *weights; /* [target_count] the weights of the layers; NULL: no morph targets */
    const uint8_t *tint;  /* [4] the tint it is drawn with; only alpha is used; NULL: white */
} noh_pick_surface;

typedef struct noh_pick_hit {
    float distance;             /* in lengths of the ray's direction: 0..distance_max */
    uint32_t submesh, triangle; /* triangle: its first index / 3 */
    float barycentric[3];       /* weights of its corners; their sum is 1 */
    float point[3];             /* as drawn */
    float bind_point[3];        /* the same point in the bind pose, for a decal that stays on the skin */
    /* index into the skin's joints: the joint with the largest weight at the point; NOH_NONE for a rigid mesh */
    uint32_t joint;
} noh_pick_hit;

/* Exact size of the scratch for noh_pick in bytes: two boxes per joint; 0 for a rigid mesh. */
size_t noh_pick_scratch_size(const noh_mesh *mesh);

/* Find the nearest hit at origin + distance * direction, with distance 0..distance_max.
 * memory  scratch[noh_pick_scratch_size], aligned to NOH_MEMORY_ALIGN, NULL if that is 0; holds nothing between calls
 * errors  NOT_FOUND nothing is hit; ARG matrices NULL, a direction of length 0, or scratch NULL or misaligned; MEMORY
 *         scratch too small (need: the bytes). *hit is then unchanged */
noh_result noh_pick(const noh_pick_surface *surface, const float origin[3], const float direction[3],
                    float distance_max, void *scratch, size_t scratch_bytes, noh_pick_hit *hit, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
