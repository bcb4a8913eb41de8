/* world.h: what bodies collide with: planes, capsules, boxes and a height field. Nothing of it moves by itself.
 *
 *   noh_world_check       whether bodies can collide with it
 *   noh_field_height      a height field's height and normal at a place
 *   noh_field_ray         where a ray meets it
 *
 * A world is the caller's: arrays that stay while it is used. Up is +Y.
 * source   Amanatides, Woo: A fast voxel traversal algorithm, 1987 (the ray's walk through cells)
 * Threads: read only; any number of threads. */
#ifndef NOH_SIM_WORLD_H
#define NOH_SIM_WORLD_H

#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "life/physics/shape.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PUSH_OUT_SPEED 1.0f /* metres per second, at which what overlaps comes apart */

/* Solid below: points with normal . x < distance are inside. */
typedef struct noh_plane {
    float normal[3]; /* unit */
    float distance;
} noh_plane;

/* A sphere where `from` and `to` are equal. */
typedef struct noh_capsule {
    float from[3], to[3];
    float radius;
} noh_capsule;

/* A grid of heights, bilinear between them: solid below, and nothing outside of it. */
typedef struct noh_field {
    const uint16_t *heights; /* [depth][width], rows along +X, one after the other along +Z */
    uint32_t width, depth;   /* 2..65536 */
    float origin[3];         /* of heights[0][0] at 0 */
    float spacing;           /* between heights */
    float scale;             /* y of one unit of a height */
} noh_field;

typedef struct noh_world {
    const noh_plane *planes;
    const noh_capsule *capsules;
    const noh_obb *boxes;
    uint32_t plane_count, capsule_count, box_count; /* each 0..NOH_OBSTACLES_MAX */
    const noh_field *field;                         /* NULL: none */
    float friction;                                 /* 0.. of everything */
    float restitution; /* 0..1: the share of its speed towards an obstacle with which a body leaves it; 0: no bounce */
} noh_world;

/* errors  ARG a normal or rotation is not unit, a number is out of its range, a field has no area (where: which);
 *         LIMIT more than NOH_OBSTACLES_MAX of a kind */
noh_result noh_world_check(const noh_world *world, noh_error *error);

/* shapes   normal[3] unit, or NULL
 * returns  0 where the field has nothing, outside of its grid: nothing is written */
int noh_field_height(const noh_field *field, float x, float z, float *height, float normal[3]);

/* returns  the distance, in the ray's lengths, at which it first comes to the field from above; below 0: it does not */
float noh_field_ray(const noh_field *field, const noh_ray *ray);

#ifdef __cplusplus
}
#endif

#endif
