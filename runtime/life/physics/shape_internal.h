/* shape_internal.h: tests of shapes that ragdolls, feet and worlds share. */
#ifndef NOH_PHYSICS_SHAPE_INTERNAL_H
#define NOH_PHYSICS_SHAPE_INTERNAL_H

#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

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
