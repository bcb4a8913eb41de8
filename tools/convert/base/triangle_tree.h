/* triangle_tree.h: a tree of boxes about triangles, for rays and for nearest points. */
#ifndef NOH_CONVERT_BASE_TRIANGLE_TREE_H
#define NOH_CONVERT_BASE_TRIANGLE_TREE_H

#include <stdint.h>

typedef struct triangle_node {
    float low[3], high[3];
    /* leaf: triangles in `order`; else count is 0 and first is the left child, the right one follows it */
    uint32_t first, count;
} triangle_node;

/* Halved at the median of the axis on which the centres spread most. */
typedef struct triangle_tree {
    uint32_t triangle_count, node_count;
    triangle_node *nodes; /* parents before children; none without triangles */
    uint32_t *order;      /* [triangle_count] */
} triangle_tree;

#define TRIANGLE_TREE_STACK 64u /* nodes that a walk has still to visit: halving, 2^32 triangles need 33 */

/* Build over triangles [count][9], at most leaf_most of them (1 or more) in a leaf, and fit the boxes. The same
 * triangles give the same tree everywhere. Returns 1 when out of memory; triangle_tree_free either way. */
int triangle_tree_make(const float *triangles, uint32_t count, uint32_t leaf_most, triangle_tree *out);
void triangle_tree_free(triangle_tree *t);

/* Fit the boxes to the same triangles in another pose, in linear time. */
void triangle_tree_fit(triangle_tree *t, const float *triangles);

#endif
