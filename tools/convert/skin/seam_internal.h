/* seam_internal.h: what measuring a seam and mending it share. */
#ifndef NOH_CONVERT_SKIN_SEAM_INTERNAL_H
#define NOH_CONVERT_SKIN_SEAM_INTERNAL_H

#include "seam.h"
#include "seam_pair.h"

/* The joints that move a vertex, by node, so that skins can be compared. */
typedef struct node_weight {
    uint32_t node;
    double weight;
} node_weight;

/* Returns how many. */
uint32_t node_weights_of(const model *m, const border *b, uint32_t vertex, node_weight out[MODEL_INFLUENCES_MAX]);

/* At rest, in the world: the matrix of a vertex, and its unit normal in a target's pose (delta NULL: without). */
void seam_matrix(const model *m, const border *b, uint32_t vertex, double out[16]);
void seam_normal(const model *m, const border *b, uint32_t vertex, const float *delta, double out[3]);

/* A delta of a vertex, in the world. */
void seam_delta(const model *m, const border *b, uint32_t vertex, const float *delta, double out[3]);

/* Make both sides of a seam equal in everything. The weld covers both sides' meshes. 1 when out of memory. */
int seam_mend(model *m, const seam_pair *seam, uint32_t *const weld[2]);

#endif
