/* hair.h: moving hair: a few control hairs; the visible hair is interpolated between them.
 *
 *   noh_hair_size, noh_hair_init   control hairs at rest
 *   noh_hair_reset                 back to rest, after the head was teleported
 *   noh_hair_step                  advance time
 *   noh_hair_points                positions of the points
 *   noh_hair_check                 check hair from outside
 *   noh_hair_curve                 a point between the points of a control hair
 *
 * Everything is in the head's space, in metres: rest positions, the spheres that represent the head, and results. So
 * hair turns with the head through any angle; motion of the head acts as inertia. Each hair follows its root: every
 * point keeps its distance from the previous one, and spheres rotate it about the previous point instead of pushing it
 * off, so lengths and spheres hold at the same time. Steps are 1/60 s at any frame rate, with the head's transform
 * interpolated; the result is interpolated between the last two steps.
 *
 * Hairs are stepped in parallel, one per SIMD lane; the bits are the same at every width.
 *
 * Hair is one block without pointers: a copy continues identically, with the same bits on every processor.
 * source   Mueller, Kim, Chentanez: Fast Simulation of Inextensible Hair and Fur, 2012 (follow the leader, and the
 *          share of its corrections that goes into velocities); Granberg, Character Animation with Direct3D, 2009,
 *          chapter 15, corrected: its springs rest in world space, lose no energy, and keep no length
 * Threads: hair belongs to one thread at a time; a desc may be shared. */
#ifndef NOH_SIM_HAIR_H
#define NOH_SIM_HAIR_H

#include <stddef.h>
#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_HAIR_STEP_TICKS 800u /* 1/60 s */

typedef struct noh_hair_sphere {
    float centre[3];
    float radius; /* including half the width of a hair strip, 0.. */
} noh_hair_sphere;

/* Data shared by hair of one kind. */
typedef struct noh_hair_desc {
    /* [hair_count][point_count][3], from the root to the tip; no two points of a hair are equal */
    const float *rest;
    uint32_t hair_count;  /* 1..NOH_HAIRS_MAX */
    uint32_t point_count; /* per hair, 2..NOH_HAIR_POINTS_MAX */
    /* [sphere_count]; for a hair with its root inside a sphere, the sphere shrinks to that root */
    const noh_hair_sphere *spheres;
    uint32_t sphere_count; /* 0..NOH_HAIR_SPHERES_MAX */
    uint32_t seed;         /* for gusts */
    float pull;            /* share of the distance to rest that a point moves per step, 0..1; usually 0.02 */
    float pull_at_tip;     /* pull at the tip; linear in between */
    float damping;         /* of velocity, per second, 0..; usually 2 to 4 */
    float gravity;         /* metres per second squared not yet included in `rest`, 0.. */
} noh_hair_desc;

/* The head's transform and the wind: world space. */
typedef struct noh_hair_carrier {
    float position[3];
    float rotation[4];
    /* mean acceleration of hair by wind, metres per second squared; gusts vary from zero to twice the mean */
    float wind[3];
} noh_hair_carrier;

typedef struct noh_hair noh_hair;

/* Exact size of hair in bytes: 112, and 40 per point, rounded up to 16. 0 if the desc is invalid. */
size_t noh_hair_size(const noh_hair_desc *desc);

/* Make hair at rest.
 * errors  ARG memory NULL or misaligned, equal points in a hair, or a number out of its range (where: the point,
 *         counted over all hairs); LIMIT a count; MEMORY too small */
noh_result noh_hair_init(void *memory, size_t bytes, const noh_hair_desc *desc, const noh_hair_carrier *carrier,
                         noh_hair **hair, noh_error *error);

/* Put hair at rest at the head's present place, after a teleport. Gusts continue. */
void noh_hair_reset(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier);

/* Advance time, in pieces of any length; at most NOH_HAIR_STEPS_MAX steps, one second, per call.
 * carrier  at the end of this time; interpolated in between
 * returns  ticks dropped, 0 up to a second */
uint32_t noh_hair_step(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, uint32_t ticks);

/* Compute the points, with rest lengths and outside the spheres.
 * shapes  points[hair_count][point_count][3], head space */
void noh_hair_points(const noh_hair *hair, const noh_hair_desc *desc, float *points);

/* Check hair of this desc whose bytes come from outside.
 * shapes   hair: noh_hair_size bytes, aligned to 16
 * returns  NULL if it may be used, else a constant message */
const char *noh_hair_check(const noh_hair *hair, const noh_hair_desc *desc);

/* Compute a point of the Catmull-Rom curve through the points of a hair, as used for strips. Tangents are half the
 * difference of the neighbours; with the full difference, as in the source, the curve overshoots.
 * shapes  points[count][3]
 * ranges  count 2..; t 0 the root, 1 the tip */
void noh_hair_curve(const float *points, uint32_t count, float t, float out[3]);

#ifdef __cplusplus
}
#endif

#endif
