/* lod_fit_pose.h (private to lod_fit*.c): one pose of a level that is fitted to the full mesh. */
#ifndef NOH_CONVERT_LOD_LOD_FIT_POSE_H
#define NOH_CONVERT_LOD_LOD_FIT_POSE_H

#include "lod_internal.h"
#include "lod_tree.h"

#define FIT_GRID 4u /* steps along the edge of a coarse triangle */
#define FIT_BACK ((FIT_GRID + 1u) * (FIT_GRID + 2u) / 2u)

/* Where a sample of one surface was nearest on the other when it was last measured. */
typedef struct fit_match {
    uint32_t triangle;
    float place[3]; /* weights of its corners */
    float bound;    /* in this pose, the sample is no farther from the surface */
} fit_match;

/* One submesh. A sample is a vertex, or (vertex_count + t) the centroid of the submesh's triangle t. */
typedef struct fit_part {
    const uint32_t *full, *coarse; /* corners */
    uint32_t full_count, coarse_count;
    lod_tree full_tree, coarse_tree;
    uint32_t sample_count;
    uint32_t *sample; /* [sample_count] */
    fit_match *match; /* [sample_count] on the coarse surface */
    fit_match *back;  /* [coarse_count][FIT_BACK] of each sample of a coarse triangle, on the full one */
} fit_part;

/* The distance between a sample and the place of the other surface that is nearest to it, along a unit vector, as the
 * coarse surface's corners change it. */
typedef struct fit_row {
    uint32_t slot[3]; /* of the corners; LOD_NONE: it does not move */
    float weight[3], direction[3], distance;
    double stiffness;
} fit_row;

typedef struct fitter {
    const model_mesh *mesh;
    uint32_t vertex_count;    /* the full mesh's */
    const uint32_t *point_of; /* [vertex_count] */
    uint32_t part_count;
    fit_part *parts;
    uint32_t used_count, *used;   /* the level's vertices */
    uint32_t point_count, *point; /* its points that may move */
    float reach; /* no point goes farther from where it starts, along each axis; 0: the first pose sets it */
    /* the pose */
    const float *full; /* [vertex_count][3] the full mesh */
    float *start;      /* [vertex_count][3] the level with the full mesh's vertices; other vertices are not read */
    float *at;         /* [vertex_count][3] the level; likewise */
    uint8_t *moves;    /* [vertex_count] whether the pose moves a vertex of the full mesh; rest: all */
    uint32_t *seen;    /* [vertex_count] by point: the list in which its place was compared with the full mesh */
    uint32_t list;     /* counts them */
    uint32_t *slot;    /* [vertex_count] by point: its place among the unknowns, or LOD_NONE */
    uint32_t slot_count, *slot_point;
    fit_row *rows;
    uint32_t row_count;
    float least;      /* distances below it are not listed */
    float drift;      /* how far the last step moved any point */
    double *unknowns; /* [4][3 point_count] scratch of the solver */
    float *best;      /* [3 point_count] */
} fitter;

/* Move the level's points in the pose that full, start, at and moves describe, from where at has them. Of several
 * rounds the best one stays; a single round's step stays. */
void fit_pose(fitter *f, uint32_t rounds);

/* One step of least squares: unknowns[0 .. 3 slot_count) is how far each slot moves. lod_fit_solve.c */
void fit_solve(fitter *f);

#endif
