/* rigid.h: a free rigid body moved by forces, torques and impulses: a box, capsule, ball or rounded box.
 *
 *   noh_rigid_init          a body at rest
 *   noh_rigid_set_motion    set velocity and spin
 *   noh_rigid_force         a force at a point, for the next step
 *   noh_rigid_torque        a torque, for the next step
 *   noh_rigid_push          an impulse at a point
 *   noh_rigid_step          advance time
 *   noh_rigid_place         position and rotation; noh_rigid_motion: velocity, spin and momentum
 *   noh_rigid_energy        kinetic energy
 *   noh_rigid_shift         move the origin of its space
 *   noh_point_touch         collide a point mass with a world, with bounce and friction
 *
 * A force F at a point p accelerates the body by F / mass and applies the torque (p - x) x F about its centre x. The
 * state is angular momentum, not spin, so free rotation conserves momentum to the last bits, and energy within a bound:
 * rotation is composed of exact turns about the three principal axes. Steps are 1/600 s. Free flight under constant
 * forces is exact.
 *
 * It collides with a noh_world through up to 24 contacts, with that world's friction and restitution: corners, edges
 * and round ends; with a height field only where corners touch. Bodies do not collide with each other or with ragdolls.
 * Overlaps separate at NOH_PUSH_OUT_SPEED. A body that moves by more than its own thickness in 1/600 s can pass through
 * a thin obstacle. A body that touches something and is slower than 0.08 m/s at its rim for half a second falls asleep
 * until a call changes it.
 *
 * A noh_rigid is the caller's, 144 bytes without pointers: a copy continues identically, with the same bits everywhere.
 * It is simulated about its own origin, like ragdolls (ragdoll.h). Read its fields with the functions below.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 6 (rigid bodies, which it leaves to a library);
 *          Dullweber, Leimkuhler, McLachlan: Symplectic splitting methods for rigid body molecular dynamics, 1997;
 *          Catto: Iterative Dynamics with Temporal Coherence, 2005 (impulses of contacts)
 * Threads: a body belongs to one thread at a time. */
#ifndef NOH_SIM_RIGID_H
#define NOH_SIM_RIGID_H

#include "core/base/limits.h"
#include "core/base/result.h"
#include "life/physics/motion.h"
#include "life/physics/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_RIGID_STEP_TICKS 80u /* 1/600 s */

typedef struct noh_rigid_desc {
    float half[3];     /* half the box's sides, 0..: all 0 a ball; 0, 0, z a capsule */
    float radius;      /* thickness added all around, 0..; half or radius above 0 */
    float mass;        /* kilograms, above 0 */
    float inertia[3];  /* kg m^2 about x, y, z of the body, above 0; all 0: of a solid of this shape and mass */
    float position[3]; /* of its centre of mass and of the box */
    float rotation[4]; /* unit; all 0: identity */
} noh_rigid_desc;

typedef struct noh_rigid {
    float half[3], radius;
    float mass, inertia[3];
    float origin[3], position[3]; /* position: relative to the origin */
    float rotation[4];
    float velocity[3], momentum[3]; /* momentum: angular, about its centre */
    float force[3], torque[3];
    noh_steps steps;
    uint32_t still; /* substeps since it became slow */
    uint32_t reserved[3];
} noh_rigid;

/* Make a body at rest.
 * errors  ARG a number out of its range (where: 0 a side, 1 the mass, 2 the inertia, 3 the place) */
noh_result noh_rigid_init(noh_rigid *body, const noh_rigid_desc *desc, noh_error *error);

/* Set velocity and spin.
 * shapes  velocity[3] m/s of its centre; spin[3] rad/s about the world's axes
 * errors  ARG not finite; nothing changes */
noh_result noh_rigid_set_motion(noh_rigid *body, const float velocity[3], const float spin[3], noh_error *error);

/* Apply a force at a point, a torque, or an impulse at a point. Forces and torques add up, act during the whole next
 * noh_rigid_step, and are then cleared. Gravity is separate. Calls with values that are not finite do nothing.
 * units  force newtons, torque newton metres, impulse newton seconds; points in world space */
void noh_rigid_force(noh_rigid *body, const float point[3], const float force[3]);
void noh_rigid_torque(noh_rigid *body, const float torque[3]);
void noh_rigid_push(noh_rigid *body, const float point[3], const float impulse[3]);

/* Advance time, in pieces of any length, by up to a quarter of a second per call.
 * world    NULL: no obstacles
 * gravity  m/s^2; NULL: NOH_GRAVITY downwards
 * returns  ticks dropped in this call */
uint32_t noh_rigid_step(noh_rigid *body, const noh_world *world, const float gravity[3], uint32_t ticks);

void noh_rigid_place(const noh_rigid *body, float position[3], float rotation[4]);

/* Get the motion.
 * shapes  velocity[3], spin[3] as set; momentum[3] angular, about its centre, kg m^2/s. Each may be NULL */
void noh_rigid_motion(const noh_rigid *body, float velocity[3], float spin[3], float momentum[3]);

/* Get the kinetic energy, including spin, in joules. */
float noh_rigid_energy(const noh_rigid *body);

int noh_rigid_sleeps(const noh_rigid *body);

/* Move the origin: each point p of its space becomes p + by, metres. Precise to what floats at the new place can
 * hold. */
void noh_rigid_shift(noh_rigid *body, const float by[3]);

/* Collide a point mass, moved by noh_point_move, with a world. It leaves an overlap by the depth that its velocity
 * caused, and any further depth at NOH_PUSH_OUT_SPEED. Its velocity towards an obstacle is reversed by the world's
 * restitution; its velocity along it is reduced by friction. For noh_verlet_move: velocity = (position - before) /
 * seconds, and afterwards before = position - seconds * velocity. Use it for the ends of springs and rods
 * (noh_distance_keep).
 * ranges   radius 0.., seconds above 0: of the preceding move
 * returns  whether it touched something */
int noh_point_touch(const noh_world *world, float radius, float position[3], float velocity[3], float seconds);

#ifdef __cplusplus
}
#endif

#endif
