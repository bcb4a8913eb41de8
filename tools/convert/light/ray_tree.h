/* ray_tree.h: the first hit of a ray among triangles, or whether there is any. */
#ifndef NOH_CONVERT_LIGHT_RAY_TREE_H
#define NOH_CONVERT_LIGHT_RAY_TREE_H

#include "convert/base/triangle_tree.h"

typedef struct ray_tree {
    triangle_tree boxes;
    float *triangles; /* [triangle_count][9] corners, in leaf order */
} ray_tree;

/* Build over triangles [count][9]. The same triangles give the same tree everywhere. Returns 1 when out of memory;
 * ray_tree_free either way. */
int ray_tree_make(const float *triangles, uint32_t count, ray_tree *out);
void ray_tree_free(ray_tree *t);

/* Whether a triangle, seen from either side, lies farther than `least` along the ray.
 * source  Moeller, Trumbore: Fast, minimum storage ray-triangle intersection, 1997 */
int ray_tree_hit(const ray_tree *t, const float origin[3], const float direction[3], float least);

/* The first hit of a ray. */
typedef struct ray_meeting {
    uint32_t triangle; /* the caller's number */
    float u, v;        /* the point is (1 - u - v) a + u b + v c */
} ray_meeting;

/* Returns 0 if the ray meets nothing. */
int ray_tree_nearest(const ray_tree *t, const float origin[3], const float direction[3], float least,
                     ray_meeting *meeting);

#endif
