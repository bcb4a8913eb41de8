/* ragdoll.h: bodies that fall: a set of dolls of one rig.
 *
 *   noh_ragdolls_size, noh_ragdolls_init   a set, all of it asleep where the rig was made
 *   noh_ragdoll_place                      a doll in a pose, with its velocities
 *   noh_ragdoll_follow                     what holds it: parts that go where they are told, joints with strength
 *   noh_ragdoll_push                       an impulse at a point
 *   noh_ragdolls_step                      time moves on
 *   noh_ragdoll_bodies                     where its bodies are
 *   noh_ragdolls_shift                     the space that they are in moves
 *   noh_ragdoll_measure                    how far it is from what its joints and the world allow
 *
 * Bodies are capsules along their z axis. A rig (ragdoll_rig.h makes one of a character) says how they hang together;
 * its rest is what angles and limits count from, so that a doll placed at rest has nothing to correct.
 *
 * Extended position based dynamics in small steps. Dolls have the same bodies and joints, so each lane of the
 * processor's vectors computes one doll: nothing is gathered, and the bits do not depend on how many there are, nor on
 * the processor. A set is one block without pointers: a copy of it goes on as it would.
 * Far from the origin: each doll is simulated about an origin of its own that goes along with it, and the world is seen
 * from there, so it falls at 100 km as it does at 0. What comes in and goes out are floats of the caller's space, which
 * have steps of 8 mm at 100 km and of 1 mm at 16 km: noh_ragdolls_shift brings that space nearer.
 *
 * Overlaps: what is inside the world or another body of the doll when a step begins comes out at NOH_PUSH_OUT_SPEED and
 * keeps none of that speed; out of obstacles that hold the axes of bodies, by the side on which the first body is.
 * Joints that a doll is placed with past their limits turn back at 2 rad/s.
 *
 * source   Mueller, Macklin, Chentanez, Jeschke, Kim: Detailed Rigid Body Simulation with Extended Position Based
 *          Dynamics, 2020; Macklin et al.: Small Steps in Physics Simulation, 2019
 * Threads: a set belongs to one thread at a time. */
#ifndef NOH_SIM_RAGDOLL_H
#define NOH_SIM_RAGDOLL_H

#include <stddef.h>
#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "life/physics/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_RAGDOLL_STEP_TICKS 800u /* 1/60 s, of desc.substeps each */

/* ---- rigs ---- */

/* A capsule: z is its axis, its centre the centre of mass. */
typedef struct noh_ragdoll_body {
    uint32_t parent;                     /* a lower index; NOH_NONE for the first body, and for no other */
    uint32_t joint;                      /* of a skeleton: the one that it moves. Not used here */
    float half;                          /* of the axis between the centres of its round ends, metres, 0.. */
    float radius;                        /* above 0 */
    float mass;                          /* above 0, kilograms */
    float inertia_across, inertia_along; /* about its centre, at right angles to z and about z; kg m^2, above 0 */
    float position[3], rotation[4];      /* at rest */
} noh_ragdoll_body;

#define NOH_RAGDOLL_HINGE 1u  /* turns about z of its frame only: twist is its angle, there is no swing */
#define NOH_RAGDOLL_SLIDES 2u /* moves by linear_min..linear_max; else it is a point */
#define NOH_RAGDOLL_LOOSE 4u  /* no limits of swing and twist: a point to point joint */

/* What joins a body to its parent. One record for a point to point joint, a hinge, a twist cone and six degrees of
 * freedom. Angles count from rest. */
typedef struct noh_ragdoll_joint {
    uint32_t flags;
    float anchor[3]; /* at rest, in the space of the bodies' positions */
    float frame[4];  /* at rest: z along the child's bone or the hinge, x and y the two axes of swing */
    float swing_min[2], swing_max[2];   /* radians about x and y: an ellipse about their middle; -pi..0, 0..pi */
    float twist_min, twist_max;         /* radians, -pi..0 and 0..pi */
    float linear_min[3], linear_max[3]; /* metres along the frame's axes, with SLIDES; 0 and 0: locked */
    float friction;                     /* N m, 0.. */
} noh_ragdoll_joint;

typedef struct noh_ragdoll_rig {
    uint32_t body_count; /* 1..NOH_RAGDOLL_BODIES_MAX */
    uint32_t pair_count; /* 0..NOH_RAGDOLL_PAIRS_MAX */
    noh_ragdoll_body bodies[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_joint joints[NOH_RAGDOLL_BODIES_MAX]; /* [i] joins bodies[i] to its parent; [0] is not used */
    uint8_t pairs[NOH_RAGDOLL_PAIRS_MAX][2];          /* bodies that collide with each other */
} noh_ragdoll_rig;

/* Masses nearer to each other, so that heavy bodies do not tear light joints: child over parent within 0.8..1.2, the
 * sum kept; a parent's inertia up to twice its own, where its children have more.
 * source  Strunk: Stop my constraints from blowing up, as Jolt has it */
void noh_ragdoll_stabilize(noh_ragdoll_rig *rig);

/* errors  ARG a number is out of its range (where: the body); LIMIT more bodies or pairs than the limit */
noh_result noh_ragdoll_rig_check(const noh_ragdoll_rig *rig, noh_error *error);

/* ---- sets ---- */

typedef struct noh_ragdolls_desc {
    const noh_ragdoll_rig *rig; /* copied */
    uint32_t count;             /* dolls, 1..NOH_RAGDOLLS_MAX */
    uint32_t substeps;          /* 5..NOH_RAGDOLL_SUBSTEPS_MAX, of 1/60 s; default (0) 10 */
} noh_ragdolls_desc;

typedef struct noh_ragdolls noh_ragdolls;

typedef struct noh_ragdoll_pose {
    float position[3], rotation[4];
} noh_ragdoll_pose;

typedef struct noh_ragdoll_motion {
    float velocity[3], spin[3]; /* metres and radians per second */
} noh_ragdoll_motion;

/* The exact bytes of a set: about 1.8 KB a doll and 30 KB that they share. 0 for an impossible desc. */
size_t noh_ragdolls_size(const noh_ragdolls_desc *desc);

/* errors  ARG memory is NULL or misaligned, or a number of the rig is out of its range (where: the body); LIMIT too
 *         many dolls, bodies, pairs or substeps; MEMORY it is too small */
noh_result noh_ragdolls_init(void *memory, size_t bytes, const noh_ragdolls_desc *desc, noh_ragdolls **set,
                             noh_error *error);

/* A doll goes there at once, and is awake.
 * shapes  bodies[body_count], as noh_ragdoll_bodies has them; motions[body_count], or NULL: at rest
 * errors  ARG a number is not finite (where: the body): the doll stays as it is */
noh_result noh_ragdoll_place(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_pose *bodies,
                             const noh_ragdoll_motion *motions, noh_error *error);

/* What the animation has of a doll, from now until the next call. Velocities of held bodies follow from where they are
 * and where they are to be.
 * goals   [body_count] where bodies are to be at the end of the next step of 1/60 s; NULL: nothing holds it
 * held    bit i: body i goes there, whatever is in the way
 * hertz   [body_count] how fast the joint of body i to its parent turns to the goals' angle, critically damped: 0 limp,
 *         20 tracks; NULL: 0
 * errors  ARG a goal is not finite or hertz below 0: nothing changes */
noh_result noh_ragdoll_follow(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_pose *goals, uint32_t held,
                              const float *hertz, noh_error *error);

/* A push in newton seconds, at a point in the space of the bodies. Wakes the doll. The body nearest to the point takes
 * it alone until its speed has changed by 4.6 of the doll's sizes (noh_ragdolls_desc) in a second, 8 m/s for 1.75 m;
 * all beyond is spread over all free bodies by their masses, as if the doll were rigid, so that four times the push
 * throws it four times as fast. Its spin is limited: no body gets more than twice the mean speed, or more than the
 * limit below. ranges  no body moves faster than 23 sizes in a second, 40 m/s for 1.75 m: what is beyond that, 2,800 Ns
 *         on 70 kg at rest, is lost. A push that is not finite, or beyond 1e15, does nothing */
void noh_ragdoll_push(noh_ragdolls *set, uint32_t doll, const float point[3], const float impulse[3]);

/* Time moves on for all dolls that are awake, in any pieces. A doll of which nothing moved by more than a 50th of its
 * size in half a second falls asleep, and stands still until it is pushed, placed or followed.
 * world    NULL: nothing is in the way
 * returns  ticks that were dropped in this call */
uint32_t noh_ragdolls_step(noh_ragdolls *set, const noh_world *world, uint32_t ticks);

/* shapes  bodies[body_count] */
void noh_ragdoll_bodies(const noh_ragdolls *set, uint32_t doll, noh_ragdoll_pose *bodies);
void noh_ragdoll_motions(const noh_ragdolls *set, uint32_t doll, noh_ragdoll_motion *motions);

/* The space of all dolls moves: each point p of it, of dolls, goals and what they remember, becomes p + by. For worlds
 * that are kept near to their origin; the caller moves the noh_world. Nothing wakes.
 * units   metres, finite */
void noh_ragdolls_shift(noh_ragdolls *set, const float by[3]);

int noh_ragdoll_sleeps(const noh_ragdolls *set, uint32_t doll);

/* ---- how good it is ---- */

typedef struct noh_ragdoll_measures {
    float limit;           /* radians by which the worst joint is past its limits */
    float penetration;     /* metres by which a body is in the world */
    float separation;      /* metres between the anchors of the worst joint; of sliding ones past their limits */
    float separation_mean; /* of all joints */
    float energy;          /* joules: of motion, and of height above 0 under gravity */
} noh_ragdoll_measures;

void noh_ragdoll_measure(const noh_ragdolls *set, uint32_t doll, const noh_world *world,
                         noh_ragdoll_measures *measures);

#ifdef __cplusplus
}
#endif

#endif
