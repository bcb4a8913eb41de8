/* lod_tree.h (private to lod_*.c): the nearest triangle of a surface that changes its pose. */
#ifndef NOH_CONVERT_LOD_LOD_TREE_H
#define NOH_CONVERT_LOD_LOD_TREE_H

#include "convert/base/triangle_tree.h"

typedef struct lod_tree {
    triangle_tree boxes;      /* split in the pose of lod_tree_make, refitted by the last lod_tree_pose */
    const uint32_t *indices;  /* the caller's, [triangle_count][3] */
    float *triangles;         /* [triangle_count][9] in the pose of the last lod_tree_pose */
    uint32_t *block_of;       /* [nodes] of each leaf */
    struct lod_block *blocks; /* one a leaf, likewise */
    uint32_t block_count;
    uint64_t spare_leaves; /* that searches have left to measure */
} lod_tree;

/* Build the tree over triangles in one pose, position [vertices][3]. Returns 1 when out of memory. */
int lod_tree_make(const uint32_t *indices, uint32_t triangle_count, const float *position, lod_tree *out);
void lod_tree_free(lod_tree *t);

/* Refit the tree to another pose. */
void lod_tree_pose(lod_tree *t, const float *position);

/* The squared distance to one of the triangles. */
float lod_tree_distance(const lod_tree *t, const float *point, uint32_t triangle);

/* The squared distance to the surface. *nearest: a guess on entry (any triangle), the nearest on return. Once a
 * triangle is no farther than `enough` (squared), that one is as good as the nearest. Where boxes cannot tell triangles
 * apart, the search ends early: the distance is then the least of those measured, never too small. */
float lod_tree_nearest(lod_tree *t, const float *point, float enough, uint32_t *nearest);

#endif
