/* seam_pair.h: which borders are the two sides of a seam, and which of their points belong together. */
#ifndef NOH_CONVERT_SKIN_SEAM_PAIR_H
#define NOH_CONVERT_SKIN_SEAM_PAIR_H

#include "seam_border.h"

typedef struct seam_pair {
    const border *side[2]; /* of a mesh each, the lower one first */
    uint32_t *mate[2];     /* [point_count of that side] the point of the other; MODEL_NONE: it has none */
} seam_pair;

typedef struct seam_list {
    uint32_t count;
    seam_pair *all;
    int gave_up; /* 1: there are more borders, or longer ones, than are compared */
} seam_list;

/* 1 when out of memory; free in any case. The borders must outlive the list. */
int seams_find(const border_list *borders, seam_list *out);
void seams_free(seam_list *list);

/* Whether the surface is bent at a point and its mate by more than 60 degrees, or a hard edge ends there: normals
 * differ on purpose. */
int seam_is_crease(const border_point *a, const border_point *b);

/* The edge of a border that is nearest to a point, and where on it: 0 at `from`, 1 at `to`. Returns the distance,
 * squared. */
double border_nearest(const border *b, const double point[3], uint32_t *edge, double *along);

#endif
