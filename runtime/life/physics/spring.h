/* spring.h: a swinging chain of joints: hair, sleeves, skirts, tails.
 *
 *   noh_spring_size, noh_spring_init   a chain at rest
 *   noh_spring_reset                   back to rest, after its carrier was teleported
 *   noh_spring_step                    advance time, for any number of chains
 *   noh_spring_rotations               local rotations of the joints
 *   noh_spring_ends                    ends of the joints
 *   noh_spring_check                   check a spring from outside
 *
 * Each joint's end is a point with inertia, pulled towards its rest direction, at a fixed distance from the joint. The
 * motion is that of the reference implementation of VRMC_springBone 1.0 at 60 Hz, at any frame rate: the chain advances
 * in steps of 1/60 s, with carrier and colliders interpolated, and the result is interpolated between the last two
 * steps. The reference itself settles in 0.37 to 1.33 s as frame rates change from 15 to 240 Hz, because its drag is
 * per frame.
 *
 * Chains are stepped in parallel, one per SIMD lane, so several in one call take less time than one by one; the bits
 * are the same.
 *
 * A spring is one block without pointers: a copy continues identically, with the same bits on every processor.
 * source   VRM Consortium: VRMC_springBone-1.0, "Spring Bone Algorithm"; Jakobsen: Advanced Character Physics, GDC 2001
 *          (Verlet integration with fixed lengths)
 * Threads: a spring belongs to one thread at a time; a desc may be shared. */
#ifndef NOH_SIM_SPRING_H
#define NOH_SIM_SPRING_H

#include <stddef.h>
#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_SPRING_STEP_TICKS 800u /* 1/60 s */

typedef struct noh_spring_joint {
    float bone[3];    /* from the joint to the next one, or to the chain's end, in the joint's space; length above 0 */
    float rest[4];    /* local rotation at rest */
    float stiffness;  /* metres per second of pull towards the rest direction, 0..; as in VRM, usually 0..4 */
    float drag;       /* share of its velocity lost per step, 0..1 */
    float radius;     /* of its end, for collisions */
    float gravity[3]; /* metres per second of pull by gravity, world */
} noh_spring_joint;

/* Data shared by springs of one kind. */
typedef struct noh_spring_desc {
    const noh_spring_joint *joints; /* [joint_count] from the first to the last */
    uint32_t joint_count;           /* 1..NOH_SPRING_JOINTS_MAX */
    uint32_t collider_count;        /* 0..NOH_SPRING_COLLIDERS_MAX */
    float restitution; /* 0..1: share of its velocity towards a collider that an end rebounds with; 0 as in VRM */
} noh_spring_desc;

/* The position of the first joint and the rotation of its carrier: world space. */
typedef struct noh_spring_carrier {
    float position[3];
    float rotation[4];
} noh_spring_carrier;

/* A capsule in world space that joint ends stay out of; a sphere if `from` and `to` are equal. */
typedef struct noh_spring_collider {
    float from[3], to[3];
    float radius;
} noh_spring_collider;

typedef struct noh_spring noh_spring;

/* A chain with the data of one call. */
typedef struct noh_spring_move {
    noh_spring *spring;
    const noh_spring_desc *desc;
    const noh_spring_carrier *carrier;    /* at the end of the call's time; interpolated in between */
    const noh_spring_collider *colliders; /* [desc->collider_count], likewise; NULL if there are none */
    float *rotations;                     /* [desc->joint_count][4]: output of noh_spring_rotations */
} noh_spring_move;

/* Floats of scratch to step chains with at most this many colliders. */
#define NOH_SPRING_SCRATCH_FLOATS(colliders) (72u * (size_t)(colliders) + 8u)

/* Exact size of a spring in bytes: 104, 28 per joint and 28 per collider, rounded up to 16. 0 if the desc is
 * invalid. */
size_t noh_spring_size(const noh_spring_desc *desc);

/* Check a desc.
 * errors  ARG, LIMIT: as noh_spring_init */
noh_result noh_spring_check_desc(const noh_spring_desc *desc, noh_error *error);

/* Make a chain at rest.
 * errors  ARG memory NULL or misaligned, a bone of length 0, or a number out of its range (where: the joint); LIMIT too
 *         many joints or colliders; MEMORY too small */
noh_result noh_spring_init(void *memory, size_t bytes, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                           noh_spring **spring, noh_error *error);

/* Put a chain at rest at its carrier, after a teleport. */
void noh_spring_reset(noh_spring *spring, const noh_spring_desc *desc, const noh_spring_carrier *carrier);

/* Advance time, in pieces of any length; frames may take up to one second (NOH_SPRING_STEPS_MAX). Of a longer time only
 * the last second is simulated, from rest at the carrier's new place.
 * moves    [count], no spring twice; `rotations` is unused
 * scratch  [NOH_SPRING_SCRATCH_FLOATS] of the largest collider count; NULL if there are none; contents undefined before
 *          and after
 * returns  ticks dropped, 0 up to a second: the most of any chain */
uint32_t noh_spring_step(const noh_spring_move *moves, uint32_t count, uint32_t ticks, float *scratch);

/* Get the local rotations that replace the rest rotations in a pose. `carrier` and `colliders` are unused.
 * moves  [count], their `rotations` must not overlap */
void noh_spring_rotations(const noh_spring_move *moves, uint32_t count);

/* Get the ends of the joints.
 * shapes  ends[joint_count][3], world space, at the last step's carrier */
void noh_spring_ends(const noh_spring *spring, const noh_spring_desc *desc, float *ends);

/* Check a spring of this desc whose bytes come from outside.
 * shapes   spring: noh_spring_size bytes, aligned to 16
 * returns  NULL if it may be used, else a constant message */
const char *noh_spring_check(const noh_spring *spring, const noh_spring_desc *desc);

#ifdef __cplusplus
}
#endif

#endif
