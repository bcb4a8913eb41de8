/* ik.h: closed-form inverse kinematics: an arm or a leg that reaches a point, a head that looks at one.
 *
 *   noh_ik_two_bone     turn two bones so that their end meets a target
 *   noh_ik_look_init    look ahead
 *   noh_ik_look_step    turn towards a target, within a cone, at a limited speed
 *   noh_ik_share        a fraction of a rotation, to share a turn among spine, neck and head
 *
 * For chains of more bones see ik_chain.h. All positions and directions of a call are in the same space, which may be
 * any; rotations are applied in that space, on the left of a joint's rotation.
 *
 * No solution uses an arc cosine: bends come from lengths, and rotations from sums of vectors, so targets out of reach,
 * at the root or in line with the pole give a pose and never NaN.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 11 (law of cosines, a look-at with a limit), with
 *          its degenerate cases added
 * Threads: no state but the noh_ik_look passed; any thread. */
#ifndef NOH_SIM_IK_H
#define NOH_SIM_IK_H

#include <stdint.h>

#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- two bones ---- */

/* Shoulder, elbow and hand, or hip, knee and ankle. */
typedef struct noh_ik_limb {
    float start[3], middle[3], end[3]; /* present positions of the joints */
    float bend_min, bend_max;          /* radians between the bones: 0 straight, pi folded. Default (0, 0): no limit */
    float soft; /* share of its length beyond which a stretching limb slows down, 0.5..1; default (0) 1: never */
} noh_ik_limb;

typedef struct noh_ik_bend {
    float start[4];  /* turns the start joint with its descendants */
    float middle[4]; /* then turns the middle joint with its descendants */
    float missed;    /* distance from the target to the end; 0 within rounding if reached */
} noh_ik_bend;

/* Turn two bones so that their end meets the target. A target out of reach is approached as near as lengths and limits
 * allow, in its direction.
 * ranges  any finite positions; bones may have no length. soft 0 or 0.5..1, 0 <= bend_min <= bend_max <= pi
 * pole    the direction, perpendicular to the line from start to target, in which the middle joint should lie; any
 *         length. NULL, or along that line: it stays on its present side
 * weight  0..1: fraction of both rotations
 * errors  the end is off by at most 2e-5 of the limb's length; continuous in target and pole, except where they are in
 *         line
 * source  law of cosines; softness as in ozz-animation's two-bone job: d' = s + (1 - s) (1 - 81 / (3 + t)^4), t = (d -
 *         s) / (1 - s), in lengths of the limb */
void noh_ik_two_bone(const noh_ik_limb *limb, const float target[3], const float pole[3], float weight,
                     noh_ik_bend *bend);

/* ---- looking ---- */

/* Limits of a head. Zero is a good value for all. */
typedef struct noh_ik_look_desc {
    float angle_max; /* radians from ahead; 0..pi; default (0) 60 degrees */
    /* a target farther off than this is released until it is within angle_max again; angle_max..pi; default (0) pi:
     * never */
    float release_max;
    float speed_max; /* radians per second; default (0) 4 */
} noh_ik_look_desc;

/* The state of a look. May be copied. */
typedef struct noh_ik_look {
    float direction[3]; /* unit, the present direction */
    /* 0: no target, or a released one; 1: a target; 2, 3: a target behind, over the left or the right shoulder */
    uint32_t follows;
} noh_ik_look;

/* Make a look ahead.
 * shapes  ahead[3], unit: direction of the head at rest */
void noh_ik_look_init(noh_ik_look *look, const float ahead[3]);

/* Advance time and turn the look towards a target along a great circle, never beyond the cone. Targets outside the cone
 * are approached as far as the cone allows. Within 20 degrees of straight behind, the look stays over the shoulder from
 * which the target came, instead of turning from side to side with every small motion.
 * ranges   seconds >= 0
 * ahead    unit; of the animated pose, in the space of the head's parent
 * target   from the head, any length; NULL or 0: no target
 * rotation turns ahead to the look
 * source   Granberg 2009, chapter 11, "Look-At Inverse Kinematics" */
void noh_ik_look_step(noh_ik_look *look, const noh_ik_look_desc *desc, const float ahead[3], const float *target,
                      float seconds, float rotation[4]);

/* Get a fraction of a rotation about its axis: `share` 0..1 of the angle. Shares of consecutive joints add up. */
void noh_ik_share(const float rotation[4], float share, float out[4]);

#ifdef __cplusplus
}
#endif

#endif
