/* shape_internal.h: tests of shapes that ragdolls, feet and worlds share. Touching counts as overlapping; boxes may be
 * flat.
 *
 * source   Ericson: Real-Time Collision Detection, 2005, sections 4.4.1 (separating axes), 5.1.9 (segments), 5.3.3
 *          (slabs); Granberg, Character Animation with Direct3D, 2009, chapter 6, with its degenerate cases added */
#ifndef NOH_PHYSICS_SHAPE_INTERNAL_H
#define NOH_PHYSICS_SHAPE_INTERNAL_H

#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_aabb {
    float min[3], max[3];
} noh_aabb;

int noh_aabb_contains(const noh_aabb *box, const float point[3]);
int noh_obb_contains(const noh_obb *box, const float point[3]);

/* Test whether two oriented boxes overlap, on 15 axes: the sides of each, and the products of edges, with a margin of
 * 1e-6 of the sides where edges are parallel and their product vanishes. Boxes closer than that margin may count as
 * overlapping. */
int noh_obb_overlap(const noh_obb *a, const noh_obb *b);

/* Get the point of a box nearest to a point: the point itself if it is inside. */
void noh_obb_closest(const noh_obb *box, const float point[3], float closest[3]);

/* Intersect a ray with a box.
 * returns  the distance at which the ray enters, 0 if it begins inside; below 0: no hit */
float noh_ray_aabb(const noh_ray *ray, const noh_aabb *box);
float noh_ray_obb(const noh_ray *ray, const noh_obb *box);

/* Find the nearest points of two segments.
 * ranges   any segments, including points
 * shapes   along[2]: 0..1 along a and along b */
void noh_segments_closest(const float a_from[3], const float a_to[3], const float b_from[3], const float b_to[3],
                          float along[2]);

#ifdef __cplusplus
}
#endif

#endif
