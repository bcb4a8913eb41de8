/* ik.h: inverse kinematics in closed form: an arm or a leg that reaches a point, a head that looks at one.
 *
 *   noh_ik_two_bone     turn two bones so that their end meets a target
 *   noh_ik_look_init    looks ahead
 *   noh_ik_look_step    turn towards a target, within a cone, at a limited speed
 *   noh_ik_share        a part of a rotation: spine, neck and head that turn together
 *
 * For chains of more bones see ik_chain.h. All positions and directions of a call are in one space, whichever it is;
 * rotations are applied in that space, to the left of what a joint has.
 *
 * Nothing takes an arc cosine of what it solves for: bends come out of lengths, and rotations out of sums of vectors,
 * so that targets out of reach, on the root or in line with the pole give a pose and never a NaN.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 11 (law of cosines, a look-at with a limit), with
 *          its limits cases added
 * Threads: no state but the noh_ik_look that is passed; any thread. */
#ifndef NOH_SIM_IK_H
#define NOH_SIM_IK_H

#include <stdint.h>

#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- two bones ---- */

/* Shoulder, elbow and hand; hip, knee and ankle. */
typedef struct noh_ik_limb {
    float start[3], middle[3], end[3]; /* where the joints are now */
    float bend_min, bend_max;          /* radians between the bones: 0 straight, pi folded. Default (0, 0): no limit */
    float soft; /* share of its length from which a limb that stretches slows down, 0.5..1; default (0) 1: never */
} noh_ik_limb;

typedef struct noh_ik_bend {
    float start[4];  /* turns the start joint and what hangs on it */
    float middle[4]; /* then turns the middle joint and what hangs on it */
    float missed;    /* from the target to where the end comes; 0 within rounding where it is reached */
} noh_ik_bend;

/* Turn two bones so that their end meets the target. Where it cannot, it comes as near as lengths and limits allow, in
 * the target's direction.
 * ranges  any finite positions; bones may have no length. soft 0 or 0.5..1, 0 <= bend_min <= bend_max <= pi
 * pole    the direction, at right angles to the line from start to target, in which the middle joint is to lie; any
 *         length. NULL, or along that line: it stays on the side where it is
 * weight  0..1: how much of both rotations
 * errors  the end is off by at most 2e-5 of the limb's length; continuous in target and pole, except where they are in
 *         line
 * source  law of cosines; softness as in ozz-animation's two-bone job: d' = s + (1 - s) (1 - 81 / (3 + t)^4),
 *         t = (d - s) / (1 - s), in lengths of the limb */
void noh_ik_two_bone(const noh_ik_limb *limb, const float target[3], const float pole[3], float weight,
                     noh_ik_bend *bend);

/* ---- looking ---- */

/* What a head can do. Zero is a good value for all. */
typedef struct noh_ik_look_desc {
    float angle_max;   /* radians from ahead; 0..pi; default (0) 60 degrees */
    float release_max; /* a target farther off than this is let go of, until it is within angle_max again;
                        * angle_max..pi; default (0) pi: none is */
    float speed_max;   /* radians per second; default (0) 4 */
} noh_ik_look_desc;

/* 16 bytes: a copy of it looks where it looks. */
typedef struct noh_ik_look {
    float direction[3]; /* unit, where it looks */
    uint32_t follows;   /* 0: nothing, or what was let go of; 1: a target; 2, 3: one behind, over the left or the right
                         * shoulder */
} noh_ik_look;

/* shapes  ahead[3], unit: where the head looks of itself */
void noh_ik_look_init(noh_ik_look *look, const float ahead[3]);

/* Time moves on, and the look turns towards a target: along a great circle, never beyond the cone. A target outside of
 * the cone is looked towards as far as the cone goes. Within 20 degrees of straight behind, the look stays over the
 * shoulder where the target came from: it would else turn from side to side with every small motion there.
 * ranges   seconds >= 0
 * ahead    unit; of the animated pose, in the space of what carries the head
 * target   from the head, any length; NULL or 0: nothing to look at
 * rotation turns ahead to the look
 * source   Granberg 2009, chapter 11, "Look-At Inverse Kinematics" */
void noh_ik_look_step(noh_ik_look *look, const noh_ik_look_desc *desc, const float ahead[3], const float *target,
                      float seconds, float rotation[4]);

/* A part of a rotation about its axis: `share` 0..1 of the angle. Shares of joints that follow each other add up. */
void noh_ik_share(const float rotation[4], float share, float out[4]);

#ifdef __cplusplus
}
#endif

#endif
