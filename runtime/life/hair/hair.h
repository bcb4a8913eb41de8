/* hair.h: hair that moves: a few control hairs, between which the hair that is seen lies.
 *
 *   noh_hair_size, noh_hair_init   control hairs at rest
 *   noh_hair_reset                 at rest again, after the head has leapt
 *   noh_hair_step                  time moves on
 *   noh_hair_points                where they are
 *   noh_hair_check                 hair that comes from outside
 *   noh_hair_curve                 a point between the points of a control hair
 *
 * All is in the head's space, in metres: the rest, the spheres that stand for the head, and what comes out. So hair
 * turns with the head however far it turns; what the head does is felt as inertia. Each hair follows its root: every
 * point keeps its distance from the one before, turned away from spheres round that one before and not pushed off it,
 * so lengths and spheres hold at the same time. Steps are of 1/60 s whatever the frame rate, with the head's place
 * interpolated, and what is shown lies between the last two of them.
 *
 * Hairs are stepped side by side, one in each lane of the processor's vectors; the bits are the same at every width.
 *
 * Hair is one block without pointers: a copy of it goes on as it would, on every processor with the same bits.
 * source   Mueller, Kim, Chentanez: Fast Simulation of Inextensible Hair and Fur, 2012 (follow the leader, and what of
 *          its corrections goes into speeds); Granberg, Character Animation with Direct3D, 2009, chapter 15, corrected:
 *          its springs have their rest in the world, lose no energy, and keep no length
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
    float radius; /* with half a hair's strip on top, 0.. */
} noh_hair_sphere;

/* What hair of one kind has in common. */
typedef struct noh_hair_desc {
    const float *rest;    /* [hair_count][point_count][3], from the root to the tip; no two points at one place */
    uint32_t hair_count;  /* 1..NOH_HAIRS_MAX */
    uint32_t point_count; /* of each, 2..NOH_HAIR_POINTS_MAX */
    const noh_hair_sphere *spheres; /* [sphere_count]; one in which a root lies is for that hair as small as that */
    uint32_t sphere_count;          /* 0..NOH_HAIR_SPHERES_MAX */
    uint32_t seed;                  /* of gusts */
    float pull;        /* share of the way to rest by which a point is pulled in a step, 0..1; usually 0.02 */
    float pull_at_tip; /* the same at the tip; in between along a line */
    float damping;     /* of speed, per second, 0..; usually 2 to 4 */
    float gravity;     /* metres per second squared that are not yet in `rest`, 0.. */
} noh_hair_desc;

/* Where the head is, and the air that it moves through: world space. */
typedef struct noh_hair_carrier {
    float position[3];
    float rotation[4];
    float wind[3]; /* metres per second squared that it gives to hair, at its mean; gusts go from none to twice that */
} noh_hair_carrier;

typedef struct noh_hair noh_hair;

/* The exact bytes of hair: 112, and 40 a point, rounded up to 16. 0 for an impossible desc. */
size_t noh_hair_size(const noh_hair_desc *desc);

/* At rest.
 * errors  ARG memory is NULL or misaligned, two points of a hair are at one place, or a number is out of its range
 *         (where: the point, of all hairs); LIMIT a count; MEMORY it is too small */
noh_result noh_hair_init(void *memory, size_t bytes, const noh_hair_desc *desc, const noh_hair_carrier *carrier,
                         noh_hair **hair, noh_error *error);

/* At rest where the head is now: after a leap. Gusts go on. */
void noh_hair_reset(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier);

/* Time moves on, in any pieces; in one call by NOH_HAIR_STEPS_MAX steps, one second.
 * carrier  at the end of this time; in between it is interpolated
 * returns  ticks that were dropped, 0 up to a second */
uint32_t noh_hair_step(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, uint32_t ticks);

/* shapes  points[hair_count][point_count][3], head space; lengths are those at rest, and spheres are kept out of */
void noh_hair_points(const noh_hair *hair, const noh_hair_desc *desc, float *points);

/* What is wrong with hair of this desc whose bytes come from outside, a constant text; NULL: it can go on.
 * shapes  hair: noh_hair_size bytes, aligned to 16 */
const char *noh_hair_check(const noh_hair *hair, const noh_hair_desc *desc);

/* A point of the Catmull-Rom curve through the points of a hair, as strips are made: its tangents are half of what lies
 * between the neighbours. With all of it, as in the source, it overshoots.
 * shapes  points[count][3]
 * ranges  count 2..; t 0 the root, 1 the tip */
void noh_hair_curve(const float *points, uint32_t count, float t, float out[3]);

#ifdef __cplusplus
}
#endif

#endif
