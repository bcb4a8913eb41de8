/* rigid.h: a free rigid body that forces, torques and impulses move: a box, a capsule, a ball, a rounded box.
 *
 *   noh_rigid_init          a body at rest
 *   noh_rigid_set_motion    its velocity and spin
 *   noh_rigid_force         a force at a point, for the next step
 *   noh_rigid_torque        a torque, for the next step
 *   noh_rigid_push          an impulse at a point
 *   noh_rigid_step          time moves on
 *   noh_rigid_place         where it is; noh_rigid_motion: how it moves
 *   noh_rigid_energy        of its motion
 *   noh_rigid_shift         the space that it is in moves
 *   noh_point_touch         a point mass out of a world, with bounce and friction
 *
 * A force F at a point p accelerates the body by F / mass, and turns it by the torque (p - x) x F about its centre x.
 * What is kept is the angular momentum, not the spin, so a body that turns freely keeps it to the last bits, and its
 * energy within a bound: rotation is put together out of exact turns about the three axes of inertia. Time goes in
 * steps of 1/600 s. Free flight under constant forces is exact.
 *
 * It collides with a noh_world, by up to 24 contacts, with that world's friction and restitution: corners, edges and
 * round ends; of a height field what corners touch. Bodies do not meet each other or ragdolls. What overlaps comes
 * apart at NOH_PUSH_OUT_SPEED. A body that moves by more than its own thickness in 1/600 s can pass through a thin
 * obstacle. One that touches something, and is slower than 0.08 m/s at its rim for half a second, falls asleep until
 * something is done to it.
 *
 * A noh_rigid is the caller's, 144 bytes without pointers: a copy goes on as it would, with the same bits everywhere.
 * It is simulated about an origin of its own, as ragdolls are (ragdoll.h). Its fields are read by calls.
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
    float half[3];     /* half of the box's sides, 0..: all 0 a ball, 0, 0, z a capsule */
    float radius;      /* by which it is thicker all around, 0..; half or radius above 0 */
    float mass;        /* kilograms, above 0 */
    float inertia[3];  /* kg m^2 about x, y, z of the body, above 0; all 0: of a solid of this shape and mass */
    float position[3]; /* of its centre of mass and of the box */
    float rotation[4]; /* unit; all 0: none */
} noh_rigid_desc;

typedef struct noh_rigid {
    float half[3], radius;
    float mass, inertia[3];
    float origin[3], position[3]; /* position: from the origin */
    float rotation[4];
    float velocity[3], momentum[3]; /* momentum: angular, about its centre */
    float force[3], torque[3];
    noh_steps steps;
    uint32_t still; /* substeps for which it has been slow */
    uint32_t reserved[3];
} noh_rigid;

/* errors  ARG a number is out of its range (where: 0 a side, 1 the mass, 2 the inertia, 3 the place) */
noh_result noh_rigid_init(noh_rigid *body, const noh_rigid_desc *desc, noh_error *error);

/* shapes  velocity[3] m/s of its centre; spin[3] rad/s about the world's axes
 * errors  ARG not finite: nothing changes */
noh_result noh_rigid_set_motion(noh_rigid *body, const float velocity[3], const float spin[3], noh_error *error);

/* They add up, and act for all the time of the next noh_rigid_step, then are gone. Gravity acts without them. Calls
 * with what is not finite do nothing.
 * units  force newtons, torque newton metres, impulse newton seconds; points in the world */
void noh_rigid_force(noh_rigid *body, const float point[3], const float force[3]);
void noh_rigid_torque(noh_rigid *body, const float torque[3]);
void noh_rigid_push(noh_rigid *body, const float point[3], const float impulse[3]);

/* Time moves on, in any pieces, by up to a quarter of a second in a call.
 * world    NULL: nothing is in the way
 * gravity  m/s^2; NULL: NOH_GRAVITY downwards
 * returns  ticks that were dropped in this call */
uint32_t noh_rigid_step(noh_rigid *body, const noh_world *world, const float gravity[3], uint32_t ticks);

void noh_rigid_place(const noh_rigid *body, float position[3], float rotation[4]);

/* shapes  velocity[3], spin[3] as set; momentum[3] angular, about its centre, kg m^2/s. Each may be NULL */
void noh_rigid_motion(const noh_rigid *body, float velocity[3], float spin[3], float momentum[3]);

/* returns  joules of its motion and spin */
float noh_rigid_energy(const noh_rigid *body);

int noh_rigid_sleeps(const noh_rigid *body);

/* Each point p of its space becomes p + by, metres; it loses nothing that floats at the new place cannot hold. */
void noh_rigid_shift(noh_rigid *body, const float by[3]);

/* A point mass, as noh_point_move moves it, out of a world: what overlaps leaves by what its speed has brought it in,
 * and otherwise at NOH_PUSH_OUT_SPEED. Its speed towards an obstacle is turned back by the world's restitution, its
 * speed along it braked by friction. For noh_verlet_move: velocity = (position - before) / seconds, and afterwards
 * before = position - seconds * velocity. Ends of springs and rods (noh_distance_keep) are such points.
 * ranges   radius 0.., seconds above 0: of the move that came before
 * returns  whether it touched something */
int noh_point_touch(const noh_world *world, float radius, float position[3], float velocity[3], float seconds);

#ifdef __cplusplus
}
#endif

#endif
