/* shape.h: boxes, and rays against them and against balls.
 *
 *   noh_aabb_holds, noh_aabb_meet        axis-aligned boxes
 *   noh_obb_holds, noh_obb_meet          oriented boxes
 *   noh_obb_closest                      the point of a box nearest to another
 *   noh_ray_aabb, noh_ray_obb, noh_ray_capsule
 *   noh_segments_closest                 where two segments are nearest to each other
 *
 * Touching counts as meeting. Boxes may be flat, segments points.
 * source   Ericson: Real-Time Collision Detection, 2005, sections 4.4.1 (separating axes), 5.1.9 (segments), 5.3.3
 *          (slabs); Granberg, Character Animation with Direct3D, 2009, chapter 6, with its limits cases added
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
    float centre[3], half[3]; /* half: half of its sides, 0.. */
    float rotation[4];
} noh_obb;

typedef struct noh_ray {
    float from[3], direction[3]; /* of any length but 0: distances are in its lengths */
    float distance_max;          /* 0.. */
} noh_ray;

int noh_aabb_holds(const noh_aabb *box, const float point[3]);
int noh_aabb_meet(const noh_aabb *a, const noh_aabb *b);
int noh_obb_holds(const noh_obb *box, const float point[3]);

/* 15 axes: the sides of each, and the products of edges, with a margin of 1e-6 of the sides where edges are parallel
 * and have none. Boxes that miss each other by less than that may be said to meet. */
int noh_obb_meet(const noh_obb *a, const noh_obb *b);

/* The point itself where the box holds it. */
void noh_obb_closest(const noh_obb *box, const float point[3], float closest[3]);

/* returns  the distance at which the ray enters, 0 where it begins inside; below 0: it misses */
float noh_ray_aabb(const noh_ray *ray, const noh_aabb *box);
float noh_ray_obb(const noh_ray *ray, const noh_obb *box);

/* A capsule; a ball where `from` and `to` are equal. */
float noh_ray_capsule(const noh_ray *ray, const float from[3], const float to[3], float radius);

/* ranges   any segments, points too
 * shapes   along[2]: 0..1 along a and along b */
void noh_segments_closest(const float a_from[3], const float a_to[3], const float b_from[3], const float b_to[3],
                          float along[2]);

#ifdef __cplusplus
}
#endif

#endif
