/* raw_turn.h: the rest pose and the direction of recordings, which .bvh files leave open.
 *
 *   raw_rest_from_frame  take the bind pose from a frame
 *   raw_side             whether a joint is a left or a right one
 *   raw_facing           where a skeleton faces, by its left and right
 *   raw_turn             skeleton and clips turned about +y
 *   raw_stand_up         skeleton and clips turned from +z up to +y up */
#ifndef NOH_CONVERT_CLIPS_RAW_TURN_H
#define NOH_CONVERT_CLIPS_RAW_TURN_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The pose and direction of .bvh and .rcl recordings. Zeros: as in the file. */
typedef struct turn_options {
    int rest_first_frame; /* 1: take the bind pose from a frame */
    int faces_ahead;      /* 1: turned so that the bind pose faces +z, by its left and right */
    double degrees;       /* else the turn, from +z towards +x */
} turn_options;

/* Uses the first clip that moves joints. Clips are unchanged. Returns 0, or 1: there is none. */
int raw_rest_from_frame(raw_set *set, uint32_t frame);

/* By the names of the joint and of those above it, as below: 1 left, -1 right, 0 neither. */
int raw_side(const raw_skeleton *skeleton, uint32_t joint);

/* Joints in pairs by their names (LeftUpLeg and RightUpLeg, lHip and rHip, hand_l and hand_r, thigh.L and thigh.R):
 * with y up, forward is what left and up make. degrees  from +z towards +x, -180 to 180, of the bind pose returns  0,
 * or 1: no pair, or left and right are above each other */
int raw_facing(const raw_skeleton *skeleton, double *degrees);

/* Roots, in the bind pose and in every frame, from +z towards +x. */
void raw_turn(raw_set *set, double degrees);

/* A person whose head is above its feet along +z, in the bind pose and as each clip begins, is turned so that +y is up.
 * Returns 1 if it was. */
int raw_stand_up(raw_set *set);

#ifdef __cplusplus
}
#endif
#endif
