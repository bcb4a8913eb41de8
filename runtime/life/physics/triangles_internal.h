/* triangles_internal.h (private to physics/): a tree of boxes over triangles, and the walk through it. Threads: read-only
 * after init; any thread. */
#ifndef NOH_PHYSICS_TRIANGLES_INTERNAL_H
#define NOH_PHYSICS_TRIANGLES_INTERNAL_H

#include "noh/body.h"
#include "noh/low_life.h"
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The first child of a node follows it. */
typedef struct noh_triangle_node {
    float min[3];
    uint32_t at; /* of a leaf: its first triangle in `order`; else the second child */
    float max[3];
    uint32_t count; /* triangles of a leaf; else 0 */
} noh_triangle_node;

typedef struct noh_triangles {
    const float *positions;  /* [position_count][3] */
    const uint32_t *indices; /* [triangle_count][3] */
    noh_triangle_node *nodes;
    uint32_t *order; /* [triangle_count] */
    uint32_t count;
} noh_triangles;

/* A walk through the leaves whose boxes a query meets, in an order that depends on the tree alone. */
#define NOH_TRIANGLE_DEPTH 32u
typedef struct noh_triangle_walk {
    uint32_t stack[NOH_TRIANGLE_DEPTH], count;
} noh_triangle_walk;

/* Get a corner relative to an origin nearby. */
static inline void noh_triangle_corner(const noh_triangles *t, uint32_t triangle, uint32_t corner,
                                       const float origin[3], float out[3])
{
    const float *at = t->positions + 3u * (size_t)t->indices[3u * (size_t)triangle + corner];
    for (int k = 0; k < 3; k++) out[k] = at[k] - origin[k];
}

/* Get a node's box relative to an origin, a little larger, for what subtraction rounds. */
static inline noh_aabb noh_triangle_box(const noh_triangle_node *n, const float origin[3])
{
    noh_aabb box;
    for (int k = 0; k < 3; k++) {
        const float size = (origin[k] < 0.0f ? -origin[k] : origin[k]) + 1.0f;
        box.min[k] = n->min[k] - origin[k] - 1e-6f * size;
        box.max[k] = n->max[k] - origin[k] + 1e-6f * size;
    }
    return box;
}

/* noh_world_physics.touches of triangles. */
void noh_triangles_touch(const noh_triangles *triangles, const noh_world_body *bodies, uint32_t count,
                         noh_touches *touches);

#ifdef __cplusplus
}
#endif

#endif
