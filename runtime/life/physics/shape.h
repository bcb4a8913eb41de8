/* shape.h: boxes, and ray tests against boxes and capsules.
 *
 *   noh_aabb_contains, noh_aabb_overlap  axis-aligned boxes
 *   noh_obb_contains, noh_obb_overlap    oriented boxes
 *   noh_obb_closest                      the nearest point of a box
 *   noh_ray_aabb, noh_ray_obb, noh_ray_capsule
 *   noh_segments_closest                 the nearest points of two segments
 *
 * Touching counts as overlapping. Boxes may be flat, segments points.
 * source   Ericson: Real-Time Collision Detection, 2005, sections 4.4.1 (separating axes), 5.1.9 (segments), 5.3.3
 *          (slabs); Granberg, Character Animation with Direct3D, 2009, chapter 6, with its degenerate cases added
 * Threads: no state; any thread. */
#ifndef NOH_SIM_SHAPE_H
#define NOH_SIM_SHAPE_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_aabb {
    float min[3], max[3];
} noh_aabb;

typedef struct noh_obb {
    float centre[3], half[3]; /* half: half the sides, 0.. */
    float rotation[4];
} noh_obb;

typedef struct noh_ray {
    float from[3], direction[3]; /* of any length but 0: distances are in multiples of it */
    float distance_max;          /* 0.. */
} noh_ray;

int noh_aabb_contains(const noh_aabb *box, const float point[3]);
int noh_aabb_overlap(const noh_aabb *a, const noh_aabb *b);
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

/* Intersect a ray with a capsule; a ball if `from` and `to` are equal. */
float noh_ray_capsule(const noh_ray *ray, const float from[3], const float to[3], float radius);

/* Find the nearest points of two segments.
 * ranges   any segments, including points
 * shapes   along[2]: 0..1 along a and along b */
void noh_segments_closest(const float a_from[3], const float a_to[3], const float b_from[3], const float b_to[3],
                          float along[2]);

#ifdef __cplusplus
}
#endif

#endif
