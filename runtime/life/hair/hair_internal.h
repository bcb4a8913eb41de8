/* hair_internal.h (private to hair/): the layout of hair, and its step. Threads: as low_life.h. */
#ifndef NOH_SIM_HAIR_INTERNAL_H
#define NOH_SIM_HAIR_INTERNAL_H

#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_hair noh_hair;

/* ======== hair ========
 * Moving hair: a few control hairs; the visible hair is interpolated between them.
 *
 *   noh_hair_size, noh_hair_init   control hairs at rest
 *   noh_hair_reset                 back to rest, after the head was teleported
 *   noh_hair_step                  advance time
 *   noh_hair_points                positions of the points
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

/* The head's transform and the wind: world space. */
typedef struct noh_hair_carrier {
    float position[3];
    float rotation[4];
    /* mean acceleration of hair by wind, metres per second squared; gusts vary from zero to twice the mean */
    float wind[3];
} noh_hair_carrier;

/* Whether hair can follow it: numbers in range, and a unit rotation. */
int noh_hair_carries(const noh_hair_carrier *carrier);

/* Exact size of hair in bytes: 112, and 40 per point, rounded up to 16. 0 if the desc is invalid. */
size_t noh_hair_size(const noh_hair_desc *desc);

/* Make hair at rest.
 * errors  ARG memory NULL or misaligned, equal points in a hair, or a number out of its range (where: the point,
 *         counted over all hairs), also of the carrier; LIMIT a count; MEMORY too small */
noh_result noh_hair_init(void *memory, size_t bytes, const noh_hair_desc *desc, const noh_hair_carrier *carrier,
                         noh_hair **hair, noh_error *error);

/* Put hair at rest at the head's present place, after a teleport. Gusts continue. A carrier out of range: the last one
 * stays. */
void noh_hair_reset(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier);

/* Advance time, in pieces of any length; at most NOH_HAIR_STEPS_MAX steps, one second, per call.
 * carrier  at the end of this time; interpolated in between. Out of range: the last one stays
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

#define NOH_HAIR_STEP_SECONDS ((float)NOH_HAIR_STEP_TICKS / 48000.0f)

/* All in the head's space at the step. */
typedef struct noh_hair_point {
    float now[3], before[3]; /* in the last two steps */
    float velocity[3];       /* in the world, along the head's axes */
    float length;            /* from the previous point; 0 for a root */
} noh_hair_point;

/* Followed by noh_hair_point[hair_count][point_count]. */
struct noh_hair {
    uint32_t hair_count, point_count;
    uint32_t left;            /* ticks since the last step */
    uint32_t steps;           /* in total, for gusts */
    noh_hair_carrier last;    /* of the last call */
    noh_hair_carrier stepped; /* of the last step */
    uint32_t reserved[4];
};
NOH_STATIC_ASSERT(sizeof(noh_hair) == 112, hair);
NOH_STATIC_ASSERT(sizeof(noh_hair_point) == 40, hair_point);

/* The head's motion in a step: the transform from its space in the last step to its space in this one, and
 * accelerations. */
typedef struct noh_hair_motion {
    float turn[3][3], moved[3]; /* columns */
    float gravity[3], wind[3];  /* head space */
    float keep;                 /* share of a velocity that is kept */
} noh_hair_motion;

static inline noh_hair_point *noh_hair_points_of(noh_hair *h)
{
    return (noh_hair_point *)(void *)(h + 1);
}

static inline const noh_hair_point *noh_hair_const_points_of(const noh_hair *h)
{
    return (const noh_hair_point *)(const void *)(h + 1);
}

/* Move the origin of its world by `by`, metres: the head's position becomes p - by. */
void noh_hair_shift(noh_hair *hair, const float by[3]);

/* Interpolate the carrier at a fraction `t` of a call's time, and compute the motion of a step to there. */
void noh_hair_carry(const noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, float t,
                    noh_hair_carrier *at, noh_hair_motion *motion);

/* noh_hair_step and noh_hair_points, for as many hairs at a time as the processor has lanes. hair_lanes.c can be
 * compiled again under other names, for other instructions. */
#if !defined(NOH_HAIR_STEP)
#define NOH_HAIR_STEP noh_hair_step
#define NOH_HAIR_POINTS noh_hair_points
#else
uint32_t NOH_HAIR_STEP(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, uint32_t ticks);
void NOH_HAIR_POINTS(const noh_hair *hair, const noh_hair_desc *desc, float *points);
#endif

#endif
