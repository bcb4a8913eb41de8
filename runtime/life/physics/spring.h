/* spring.h: a chain of joints that swings: hair, sleeves, skirts, tails.
 *
 *   noh_spring_size, noh_spring_init   a chain at rest
 *   noh_spring_reset                   at rest again, after what carries it has leapt
 *   noh_spring_step                    time moves on, for any number of chains
 *   noh_spring_rotations               the local rotations of their joints
 *   noh_spring_ends                    where its joints end
 *   noh_spring_check                   a spring that comes from outside
 *
 * Each joint's end is a point with inertia, pulled towards its rest direction, at a fixed distance from the joint. The
 * motion is that of the reference of VRMC_springBone 1.0 at 60 Hz, whatever the frame rate: the chain advances in steps
 * of 1/60 s, for which what carries it and its colliders are interpolated, and what is shown lies between the last two
 * steps. The reference itself settles in 0.37 to 1.33 s as frames change from 15 to 240 Hz, because its drag counts
 * frames.
 *
 * Chains are stepped side by side, one in each lane of the processor's vectors, so several in one call take less time
 * than one by one; the bits are the same.
 *
 * A spring is one block without pointers: a copy of it goes on as it would, on every processor with the same bits.
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
    float bone[3];    /* from the joint to the next one, or to the chain's end, in the joint's space; longer than 0 */
    float rest[4];    /* local rotation at rest */
    float stiffness;  /* metres per second by which the rest direction pulls, 0..; VRM's, usually 0..4 */
    float drag;       /* share of its speed that it loses in a step, 0..1 */
    float radius;     /* of its end, against colliders */
    float gravity[3]; /* metres per second by which gravity pulls, world */
} noh_spring_joint;

/* What springs of one kind have in common. */
typedef struct noh_spring_desc {
    const noh_spring_joint *joints; /* [joint_count] from the first to the last */
    uint32_t joint_count;           /* 1..NOH_SPRING_JOINTS_MAX */
    uint32_t collider_count;        /* 0..NOH_SPRING_COLLIDERS_MAX */
    float
        restitution; /* 0..1: the share of its speed towards a collider with which an end leaves it; 0: none, as VRM */
} noh_spring_desc;

/* Where the first joint is, and how what carries it is turned: world space. */
typedef struct noh_spring_carrier {
    float position[3];
    float rotation[4];
} noh_spring_carrier;

/* A capsule in world space that ends of joints stay out of; `from` and `to` may be equal, for a sphere. */
typedef struct noh_spring_collider {
    float from[3], to[3];
    float radius;
} noh_spring_collider;

typedef struct noh_spring noh_spring;

/* A chain, and what a call does with it. */
typedef struct noh_spring_move {
    noh_spring *spring;
    const noh_spring_desc *desc;
    const noh_spring_carrier *carrier;    /* at the end of the call's time; in between it is interpolated */
    const noh_spring_collider *colliders; /* [desc->collider_count], the same; NULL without any */
    float *rotations;                     /* [desc->joint_count][4]: what noh_spring_rotations writes */
} noh_spring_move;

/* Floats of memory that chains of so many colliders at most are stepped with. */
#define NOH_SPRING_SCRATCH_FLOATS(colliders) (72u * (size_t)(colliders) + 8u)

/* The exact bytes of a spring: 104, 28 a joint and 28 a collider, rounded up to 16. 0 for an impossible desc. */
size_t noh_spring_size(const noh_spring_desc *desc);

/* What noh_spring_init would say of a desc.
 * errors  ARG, LIMIT: as there */
noh_result noh_spring_check_desc(const noh_spring_desc *desc, noh_error *error);

/* A chain at rest.
 * errors  ARG memory is NULL or misaligned, a bone has no length, or a number is out of its range (where: the joint);
 *         LIMIT too many joints or colliders; MEMORY it is too small */
noh_result noh_spring_init(void *memory, size_t bytes, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                           noh_spring **spring, noh_error *error);

/* At rest where it is carried now: after a leap, or it would be torn along. */
void noh_spring_reset(noh_spring *spring, const noh_spring_desc *desc, const noh_spring_carrier *carrier);

/* Time moves on, in any pieces: frames may be as seldom as one in a second (NOH_SPRING_STEPS_MAX). Of a longer time the
 * last second is run, from rest at the place where it is carried then.
 * moves    [count], no spring twice; `rotations` is not used
 * scratch  [NOH_SPRING_SCRATCH_FLOATS] of the most colliders that one of them has; NULL if none has any; undefined
 *          before and after
 * returns  ticks that were dropped, 0 up to a second: the most of any */
uint32_t noh_spring_step(const noh_spring_move *moves, uint32_t count, uint32_t ticks, float *scratch);

/* The local rotations to be put into a pose in place of those at rest. `carrier` and `colliders` are not used.
 * moves  [count], their `rotations` not overlapping */
void noh_spring_rotations(const noh_spring_move *moves, uint32_t count);

/* shapes  ends[joint_count][3], world space, as of the last step's carrier */
void noh_spring_ends(const noh_spring *spring, const noh_spring_desc *desc, float *ends);

/* What is wrong with a spring of this desc whose bytes come from outside, a constant text; NULL: it can go on.
 * shapes  spring: noh_spring_size bytes, aligned to 16 */
const char *noh_spring_check(const noh_spring *spring, const noh_spring_desc *desc);

#ifdef __cplusplus
}
#endif

#endif
