/* ik_chain.h: inverse kinematics of chains of any length: tails, tentacles, a reaching spine.
 *
 *   noh_ik_chain_solve   turn the joints of a chain until its end meets a target
 *   noh_ik_limit_apply   clamp one joint's rotation to its limits
 *
 * Three solvers, all iterative, all with limits:
 *   NOH_IK_CCD      turns one joint after the other, the last first. Curls the end of the chain most
 *   NOH_IK_FABRIK   drags the joints along, to and from the target. Fewest iterations: tails
 *   NOH_IK_DLS      damped least squares: the smallest change of all joints together. Spines
 *
 * The best pose so far is kept: more iterations never make it worse. A chain points at a target out of reach.
 * source   Wang, Chen: A combined optimization method for solving the inverse kinematics problem of mechanical
 *          manipulators, 1991 (CCD); Aristidou, Lasenby: FABRIK, Graphical Models 73, 2011; Buss: Introduction to
 *          inverse kinematics with Jacobian transpose, pseudoinverse and damped least squares methods, 2004
 * Threads: no state; any thread. */
#ifndef NOH_SIM_IK_CHAIN_H
#define NOH_SIM_IK_CHAIN_H

#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_ik_solver { NOH_IK_CCD = 0, NOH_IK_FABRIK, NOH_IK_DLS } noh_ik_solver;

#define NOH_IK_LIMIT_SWING 1u
#define NOH_IK_LIMIT_TWIST 2u

/* Limits of a joint from its bind rotation: swing away from the bone's direction, and twist about it. */
typedef struct noh_ik_limit {
    uint32_t flags;             /* NOH_IK_LIMIT_*: the limits in use */
    float swing_max;            /* radians, in all directions, 0..pi */
    float twist_min, twist_max; /* radians, -pi..0 and 0..pi */
} noh_ik_limit;

typedef struct noh_ik_chain {
    uint32_t count;             /* joints that turn, 1..NOH_IK_JOINTS_MAX */
    const float *root;          /* [3] position of the first joint */
    const float *root_rotation; /* [4] rotation of its parent; NULL: the identity */
    const float *bones; /* [count][3] from each joint to the next, and from the last to the end, in the joint's space */
    const float *binds; /* [count][4] local rotations from which limits count; NULL: identities */
    const noh_ik_limit *limits; /* [count]; NULL: none */
} noh_ik_chain;

typedef struct noh_ik_chain_result {
    uint32_t iterations; /* iterations used */
    float missed;        /* distance from the target to the end */
} noh_ik_chain_result;

/* Turn the joints of a chain until its end is within `tolerance` of the target.
 * ranges     iterations 1..1000, the most to run; tolerance > 0, in the chain's unit
 * rotations  [count][4] local, in and out; input is the start pose. Joints beyond their limits are clamped to them
 * errors     ARG a count of 0 or above NOH_IK_JOINTS_MAX, or a target that is not finite; nothing is written */
noh_result noh_ik_chain_solve(const noh_ik_chain *chain, noh_ik_solver solver, const float target[3], float tolerance,
                              uint32_t iterations, float *rotations, noh_ik_chain_result *result, noh_error *error);

/* Clamp a local rotation to a limit.
 * bone  [3] the joint's bone, the axis of twist, in the joint's space
 * bind  [4] or NULL: the identity */
void noh_ik_limit_apply(const noh_ik_limit *limit, const float bone[3], const float *bind, float rotation[4]);

#ifdef __cplusplus
}
#endif

#endif
