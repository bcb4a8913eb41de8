/* pick.h: a ray against a mesh as it is drawn (rows C3.3, C14.2).
 *
 * Nothing is cloned: each joint's box is moved as bounds.h does, a triangle is looked at only
 * where the ray meets the boxes of the joints near its corners, and only then are its three
 * corners morphed and skinned. The smiling, walking figure is hit where it shows. Rigid
 * meshes are picked too; both sides of a triangle count. */
#ifndef NOH_DEFORM_PICK_H
#define NOH_DEFORM_PICK_H

#include "deform/dual_quaternion.h"

/* What is drawn. Exactly one of matrices and dual_quaternions for a skinned mesh, as it is drawn; none for a rigid one. */
typedef struct noh_pick_surface {
    const noh_mesh *mesh;
    const float *world;    /* [12] of a rigid mesh; NULL: mesh space */
    const float *matrices; /* [skin's joint_count][12]; of every skinned mesh */
    const noh_dual_quaternion *dual_quaternions; /* [skin's joint_count]: the mesh is drawn by these; else NULL */
    const noh_morph_layers *layers; /* NULL: no morphs */
    const float *weights;  /* [target_count] what the layers were accumulated with; NULL without layers */
} noh_pick_surface;

typedef struct noh_pick_hit {
    float distance;        /* in lengths of the ray's direction */
    uint32_t submesh, triangle; /* triangle: its first index / 3 */
    float barycentric[3];  /* of its corners, they sum to 1 */
    float point[3];        /* where it is drawn */
    float bind_point[3];   /* the same place of the rest pose: a wound stays where it was struck */
    uint32_t joint;        /* the joint that moves it most, a place in the skin's joints; NOH_NONE in a rigid mesh */
} noh_pick_hit;

/* Bytes of scratch that noh_pick wants: two boxes per joint; 0 for a rigid mesh. */
size_t noh_pick_scratch_size(const noh_mesh *mesh);

/* The nearest hit of origin + distance * direction with distance from 0 up to distance_max.
 * memory  scratch[noh_pick_scratch_size], 4-byte aligned; nothing is kept in it
 * errors  NOT_FOUND nothing is hit: *hit is untouched; MEMORY with the bytes needed; ARG matrices are missing, or a
 *         direction without length */
noh_result noh_pick(const noh_pick_surface *surface, const float origin[3], const float direction[3], float distance_max, void *scratch,
                    size_t scratch_bytes, noh_pick_hit *hit, noh_error *error);

#endif
