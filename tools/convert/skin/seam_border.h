/* seam_border.h: the open borders of skinned meshes, as they lie at rest in the world.
 *
 * A border is a connected chain of edges, each with a triangle on one side only. Its points are points of the surface:
 * vertices that a file splits for their UVs or normals are one point (weld_vertices). */
#ifndef NOH_CONVERT_SKIN_SEAM_BORDER_H
#define NOH_CONVERT_SKIN_SEAM_BORDER_H

#include "convert/model/model.h"

typedef struct border_point {
    uint32_t vertex;    /* the first of those that are this point */
    double position[3]; /* world */
    uint32_t is_hard;   /* 1: its vertices have normals of their own, more than 60 degrees apart */
    double inward[3];   /* the mean of its edges', not unit */
} border_point;

typedef struct border_edge {
    uint32_t from, to; /* points */
    uint32_t is_hard;  /* 1: its vertices have normals of their own, more than 60 degrees apart */
    double inward[3];  /* unit, at right angles to the edge, into its triangle; zero where that has no area */
} border_edge;

typedef struct border {
    uint32_t mesh, node; /* the first node that draws the mesh with a skin */
    uint32_t point_count, edge_count;
    border_point *points;
    border_edge *edges;
    double low[3], high[3], size; /* its box, and the diagonal of that */
} border;

typedef struct border_list {
    uint32_t count, mesh_count;
    border *all;
    uint32_t **weld; /* [mesh_count] of skinned meshes, as weld_vertices gives it; else NULL */
} border_list;

/* The borders, of three points or more, of all meshes that a node draws with a skin. 1 when out of memory; free in any
 * case. */
int borders_find(const model *m, border_list *out);
void borders_free(border_list *list);

/* The matrix from a mesh's space to the world that a skin's joints give at rest, by these influences. */
void skin_rest_matrix(const model *m, const model_skin *skin, const uint16_t *joints, const float *weights,
                      double out[16]);

#endif
