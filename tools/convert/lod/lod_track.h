/* lod_track.h (private to lod_track.c and lod_measure.c): samples of the full surface, attached to the
 * triangles in their place.
 *
 * A sample is a point that was removed, or (vertex_count + t) the centroid of the mesh's triangle t. */
#ifndef NOH_CONVERT_LOD_LOD_TRACK_H
#define NOH_CONVERT_LOD_LOD_TRACK_H

#include "lod_internal.h"

/* A fan in one pose; filled when first needed. */
typedef struct lod_pose_view {
    uint32_t stamp;
    float *samples;   /* [3][capacity]: x, y, z */
    float *triangles; /* [capacity][9] */
} lod_pose_view;

#define LOD_REVERSE_SAMPLES 6u                              /* of a new triangle, compared with the full mesh */
#define LOD_REVERSE_MAX (LOD_REVERSE_SAMPLES * LOD_FAN_MAX) /* a multiple of LOD_LANES */

/* Where a sample was nearest in one pose: in any other it is at most as far from there as from this place. */
typedef struct lod_match {
    uint32_t triangle;
    float weight[3];
} lod_match;

struct lod_track {
    lod_surface *surface;
    uint32_t *first, *next;           /* [triangle_count], [vertex_count + triangle_count]: the samples at a triangle */
    const lod_fan *fan;               /* the open fan */
    uint32_t capacity, count, padded; /* its samples; the last one repeats up to `padded` */
    uint32_t *sample;                 /* [capacity]; the fan's own point is the last one */
    uint32_t triangle_count;          /* centroids among the samples */
    uint32_t *triangle;               /* [capacity] the mesh's triangle of each centroid */
    float *squared, *nearest, *worst; /* [capacity] */
    uint32_t *owner;                  /* [capacity] */
    lod_match *match;                 /* [capacity] of the samples on a move's new triangles */
    lod_match back[LOD_REVERSE_MAX];  /* of the new triangles' samples on the mesh's */
    uint64_t *shows;                  /* [words] poses in which one of its samples is a rim that opens or closes */
    uint64_t *set;                    /* [words] poses in which the fan or its samples move */
    uint32_t *pose;                   /* [pose_count] those poses as a list; the one that decided last comes first */
    uint32_t pose_count, stamp;
    uint64_t work;        /* distances measured so far */
    lod_pose_view *views; /* [poses.count] */
    float *block;         /* of all views */
};

/* The open fan in a pose. */
const lod_pose_view *lod_track_view(lod_track *t, uint32_t pose);

void lod_track_fill(float *values, uint32_t count); /* with FLT_MAX */

#endif
