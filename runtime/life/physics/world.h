/* world.h: static obstacles for bodies: planes, capsules, boxes and a height field.
 *
 *   noh_world_check       check a world
 *   noh_field_height      height and normal of a height field at a place
 *   noh_field_ray         intersect a ray with a height field
 *
 * The caller owns the world's arrays and keeps them while it is used. Up is +Y.
 * source   Amanatides, Woo: A fast voxel traversal algorithm, 1987 (the ray's walk through cells)
 * Threads: read-only; any number of threads. */
#ifndef NOH_SIM_WORLD_H
#define NOH_SIM_WORLD_H

#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "life/physics/shape.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PUSH_OUT_SPEED 1.0f /* metres per second at which overlaps separate */

/* Solid below: points with normal . x < distance are inside. */
typedef struct noh_plane {
    float normal[3]; /* unit */
    float distance;
} noh_plane;

/* A sphere if `from` and `to` are equal. */
typedef struct noh_capsule {
    float from[3], to[3];
    float radius;
} noh_capsule;

/* A grid of heights with bilinear interpolation: solid below, nothing outside. */
typedef struct noh_field {
    const uint16_t *heights; /* [depth][width], rows along +X, consecutive rows along +Z */
    uint32_t width, depth;   /* 2..65536 */
    float origin[3];         /* of heights[0][0] at height 0 */
    float spacing;           /* between heights */
    float scale;             /* y per unit of height */
} noh_field;

typedef struct noh_world {
    const noh_plane *planes;
    const noh_capsule *capsules;
    const noh_obb *boxes;
    uint32_t plane_count, capsule_count, box_count; /* each 0..NOH_OBSTACLES_MAX */
    const noh_field *field;                         /* NULL: none */
    float friction;                                 /* 0.., of everything */
    float restitution; /* 0..1: share of its velocity towards an obstacle that a body rebounds with; 0: no bounce */
} noh_world;

/* Check a world.
 * errors  ARG a normal or rotation is not unit, a number is out of its range, a field has no area (where: the index);
 *         LIMIT more than NOH_OBSTACLES_MAX of one kind */
noh_result noh_world_check(const noh_world *world, noh_error *error);

/* Get the height and normal of a field at a place.
 * shapes   normal[3] unit, or NULL
 * returns  0 outside the grid; nothing is written then */
int noh_field_height(const noh_field *field, float x, float z, float *height, float normal[3]);

/* Intersect a ray with a field, from above.
 * returns  the distance, in lengths of the ray's direction; below 0: no hit */
float noh_field_ray(const noh_field *field, const noh_ray *ray);

#ifdef __cplusplus
}
#endif

#endif
