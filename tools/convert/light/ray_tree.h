/* ray_tree.h: the first hit of a ray among triangles, or whether there is any. */
#ifndef NOH_CONVERT_LIGHT_RAY_TREE_H
#define NOH_CONVERT_LIGHT_RAY_TREE_H

#include "convert/base/triangle_tree.h"

#define RAY_LANES 8u /* boxes, or triangles, that one step of a ray tests at once */

typedef struct ray_node {
    float low[3][RAY_LANES], high[3][RAY_LANES];
    uint32_t box[RAY_LANES];  /* the nodes of `boxes` */
    uint32_t next[RAY_LANES]; /* of an inner box its ray node, of a leaf its block */
    uint32_t count, leaves;   /* boxes; a bit for each that is a leaf */
} ray_node;

typedef struct ray_block {
    float corner[3][RAY_LANES], first[3][RAY_LANES], second[3][RAY_LANES]; /* the edges from the corner */
    uint32_t triangle[RAY_LANES];                                          /* the caller's number */
} ray_block;

typedef struct ray_tree {
    triangle_tree boxes;
    ray_node *nodes;
    ray_block *blocks;
    uint32_t *live; /* [node_count] a bit for each box that ray_tree_hit looks into */
    uint32_t node_count, block_count;
} ray_tree;

/* Build over triangles [count][9]. Returns 1 when out of memory; ray_tree_free either way. */
int ray_tree_make(const float *triangles, uint32_t count, ray_tree *out);
void ray_tree_free(ray_tree *t);

/* Fit to the same triangles in another pose, in linear time. */
void ray_tree_fit(ray_tree *t, const float *triangles);

/* Until the next call, ray_tree_hit leaves out what lies behind a plane: its rays start on the plane and lead to the
 * front. After ray_tree_make and ray_tree_fit it leaves out nothing. */
void ray_tree_front(const ray_tree *t, const float origin[3], const float normal[3]);

/* Whether a triangle, seen from either side, lies farther than `least` along the ray.
 * source  Moeller, Trumbore: Fast, minimum storage ray-triangle intersection, 1997
 * last    what a ray much like this one left there, 0 at first: the block that is tested first, if any */
int ray_tree_hit(const ray_tree *t, const float origin[3], const float direction[3], float least, uint32_t *last);

/* The first hit of a ray; of triangles at the same distance, the one with the lowest number. */
typedef struct ray_meeting {
    uint32_t triangle; /* the caller's number */
    float u, v;        /* the point is (1 - u - v) a + u b + v c */
} ray_meeting;

/* Returns 0 if the ray meets nothing. */
int ray_tree_nearest(const ray_tree *t, const float origin[3], const float direction[3], float least,
                     ray_meeting *meeting);

#endif
