/* ragdoll.h: ragdolls: a set of dolls with one rig.
 *
 *   noh_ragdolls_size, noh_ragdolls_init   a set, asleep at the rig's rest
 *   noh_ragdoll_place                      put a doll in a pose, with velocities
 *   noh_ragdoll_follow                     drive it by animation: held bodies, joints with strength
 *   noh_ragdoll_push                       an impulse at a point
 *   noh_ragdolls_step                      advance time
 *   noh_ragdoll_bodies                     transforms of the bodies
 *   noh_ragdolls_shift                     move the origin of their space
 *   noh_ragdoll_measure                    violations of joint limits and contacts
 *
 * Bodies are capsules along their z axis. A rig (ragdoll_rig.h makes one from a character) defines how they are joined.
 * Angles and limits count from the rig's rest, so a doll placed at rest has nothing to correct.
 *
 * Extended position based dynamics in small steps. Dolls have the same bodies and joints, so each SIMD lane computes
 * one doll: no gathering, and the bits depend neither on the number of dolls nor on the processor. A set is one block
 * without pointers: a copy continues identically.
 * Far from the origin: each doll is simulated about its own origin, which moves with it, with the world relative to it,
 * so it falls at 100 km as at 0. Inputs and outputs are floats in the caller's space, with a resolution of 8 mm at 100
 * km and of 1 mm at 16 km; noh_ragdolls_shift moves that space closer.
 *
 * Overlaps: a body that begins a step inside the world or another body of the doll is moved out at NOH_PUSH_OUT_SPEED
 * and keeps none of that velocity. Out of obstacles that contain the axes of bodies, it leaves on the side of the first
 * body. Joints placed past their limits turn back at 2 rad/s.
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

#define NOH_RAGDOLL_STEP_TICKS 800u /* 1/60 s, each divided into desc.substeps */

/* ---- rigs ---- */

/* A capsule: z is its axis, its centre the centre of mass. */
typedef struct noh_ragdoll_body {
    uint32_t parent;                     /* a lower index; NOH_NONE for the first body only */
    uint32_t joint;                      /* the joint of a skeleton that it moves; unused here */
    float half;                          /* half the axis between the centres of its round ends, metres, 0.. */
    float radius;                        /* above 0 */
    float mass;                          /* above 0, kilograms */
    float inertia_across, inertia_along; /* about its centre: perpendicular to z, and about z; kg m^2, above 0 */
    float position[3], rotation[4];      /* at rest */
} noh_ragdoll_body;

#define NOH_RAGDOLL_HINGE 1u  /* rotates about z of its frame only: twist is the angle, there is no swing */
#define NOH_RAGDOLL_SLIDES 2u /* slides within linear_min..linear_max; else the anchors coincide */
#define NOH_RAGDOLL_LOOSE 4u  /* no limits of swing and twist: a ball joint */

/* The joint between a body and its parent. One record for ball joint, hinge, swing-twist cone and six degrees of
 * freedom. Angles count from rest. */
typedef struct noh_ragdoll_joint {
    uint32_t flags;
    float anchor[3];                    /* at rest, in the space of the bodies' positions */
    float frame[4];                     /* at rest: z along the child's bone or the hinge, x and y the two swing axes */
    float swing_min[2], swing_max[2];   /* radians about x and y: an ellipse about their middle; -pi..0, 0..pi */
    float twist_min, twist_max;         /* radians, -pi..0 and 0..pi */
    float linear_min[3], linear_max[3]; /* metres along the frame's axes, with SLIDES; 0 and 0: locked */
    float friction;                     /* N m, 0.. */
} noh_ragdoll_joint;

typedef struct noh_ragdoll_rig {
    uint32_t body_count; /* 1..NOH_RAGDOLL_BODIES_MAX */
    uint32_t pair_count; /* 0..NOH_RAGDOLL_PAIRS_MAX */
    noh_ragdoll_body bodies[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_joint joints[NOH_RAGDOLL_BODIES_MAX]; /* [i] joins bodies[i] to its parent; [0] is unused */
    uint8_t pairs[NOH_RAGDOLL_PAIRS_MAX][2];          /* pairs of bodies that collide with each other */
} noh_ragdoll_rig;

/* Make masses more equal, so that heavy bodies do not pull light joints apart: child over parent within 0.8..1.2, with
 * the same total; a parent's inertia is raised to at most twice its own if its children have more.
 * source  Strunk: Stop my constraints from blowing up, as implemented in Jolt */
void noh_ragdoll_stabilize(noh_ragdoll_rig *rig);

/* Check a rig.
 * errors  ARG a number out of its range (where: the body); LIMIT too many bodies or pairs */
noh_result noh_ragdoll_rig_check(const noh_ragdoll_rig *rig, noh_error *error);

/* ---- sets ---- */

typedef struct noh_ragdolls_desc {
    const noh_ragdoll_rig *rig; /* copied */
    uint32_t count;             /* dolls, 1..NOH_RAGDOLLS_MAX */
    uint32_t substeps;          /* 5..NOH_RAGDOLL_SUBSTEPS_MAX per 1/60 s; default (0) 10 */
} noh_ragdolls_desc;

typedef struct noh_ragdolls noh_ragdolls;

typedef struct noh_ragdoll_pose {
    float position[3], rotation[4];
} noh_ragdoll_pose;

typedef struct noh_ragdoll_motion {
    float velocity[3], spin[3]; /* metres and radians per second */
} noh_ragdoll_motion;

/* Exact size of a set in bytes: about 1.8 KB per doll and 30 KB shared. 0 if the desc is invalid. */
size_t noh_ragdolls_size(const noh_ragdolls_desc *desc);

/* Make a set.
 * errors  ARG memory NULL or misaligned, or a number of the rig out of its range (where: the body); LIMIT too many
 *         dolls, bodies, pairs or substeps; MEMORY too small */
noh_result noh_ragdolls_init(void *memory, size_t bytes, const noh_ragdolls_desc *desc, noh_ragdolls **set,
                             noh_error *error);

/* Put a doll in a pose and wake it.
 * shapes  bodies[body_count], as from noh_ragdoll_bodies; motions[body_count], or NULL: at rest
 * errors  ARG a number is not finite (where: the body); the doll is then unchanged */
noh_result noh_ragdoll_place(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_pose *bodies,
                             const noh_ragdoll_motion *motions, noh_error *error);

/* Drive a doll by animation, until the next call. The velocities of held bodies follow from their present and goal
 * transforms.
 * goals   [body_count] goal transforms at the end of the next step of 1/60 s; NULL: not driven
 * held    bit i: body i moves to its goal, through any obstacle
 * hertz   [body_count] how fast the joint of body i to its parent turns to the goals' angle, critically damped: 0 limp,
 *         20 tracks; NULL: 0
 * errors  ARG a goal is not finite or hertz is below 0; nothing changes */
noh_result noh_ragdoll_follow(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_pose *goals, uint32_t held,
                              const float *hertz, noh_error *error);

/* Apply an impulse at a point, and wake the doll. The nearest body takes it alone until its speed has changed by 4.6
 * doll sizes per second (noh_ragdolls_desc), 8 m/s for 1.75 m; the rest is spread over all free bodies by mass, as if
 * the doll were rigid, so four times the impulse throws it four times as fast. Spin is limited: no body gets more than
 * twice the mean speed, or more than the limit below.
 * units   impulse in newton seconds; the point in the space of the bodies
 * ranges  no body moves faster than 23 sizes per second, 40 m/s for 1.75 m: excess, beyond 2,800 Ns on 70 kg at rest,
 *         is lost. Does nothing if the impulse is not finite or beyond 1e15 */
void noh_ragdoll_push(noh_ragdolls *set, uint32_t doll, const float point[3], const float impulse[3]);

/* Advance time for all dolls that are awake, in pieces of any length. A doll whose bodies all moved by less than a 50th
 * of its size in half a second falls asleep, and rests until it is pushed, placed or driven.
 * world    NULL: no obstacles
 * returns  ticks dropped in this call */
uint32_t noh_ragdolls_step(noh_ragdolls *set, const noh_world *world, uint32_t ticks);

/* Get the transforms, or the velocities, of a doll's bodies.
 * shapes  bodies[body_count], motions[body_count] */
void noh_ragdoll_bodies(const noh_ragdolls *set, uint32_t doll, noh_ragdoll_pose *bodies);
void noh_ragdoll_motions(const noh_ragdolls *set, uint32_t doll, noh_ragdoll_motion *motions);

/* Move the origin: every point p of dolls, goals and internal state becomes p + by. For worlds that are kept near their
 * origin; the caller moves the noh_world. Wakes nothing.
 * units   metres, finite */
void noh_ragdolls_shift(noh_ragdolls *set, const float by[3]);

int noh_ragdoll_sleeps(const noh_ragdolls *set, uint32_t doll);

/* ---- quality ---- */

typedef struct noh_ragdoll_measures {
    float limit;           /* radians beyond the limits, worst joint */
    float penetration;     /* metres of the deepest body inside the world */
    float separation;      /* metres between the anchors of the worst joint; for sliding joints beyond their limits */
    float separation_mean; /* mean over all joints */
    float energy;          /* joules: kinetic, and potential above height 0 */
} noh_ragdoll_measures;

void noh_ragdoll_measure(const noh_ragdolls *set, uint32_t doll, const noh_world *world,
                         noh_ragdoll_measures *measures);

#ifdef __cplusplus
}
#endif

#endif
