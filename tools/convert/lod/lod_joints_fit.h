/* lod_joints_fit.h (private to lod_joints.c): a few joints whose motions, blended by weights, follow all targets.
 *
 * A joint has a motion for each target: a move b and a small turn w about its centre c. At weights u of the targets it
 * takes a point p to p + sum u (b + w x (p - c)), and a normal n to n + sum u (w x n), before its parent moves both. All
 * of it is linear in the weights, as targets are: what is off for each target alone bounds what is off in a mix.
 *
 * source  Le and Deng, "Smooth Skinning Decomposition with Rigid Bones" (2012), which alternates between sparse convex
 *         weights and motions; here motions are linear, so that all of them are one system of equations, and points that
 *         are farthest off count more from round to round (Lawson's weights), since a level is chosen by its largest
 *         error */
#ifndef NOH_CONVERT_LOD_LOD_JOINTS_FIT_H
#define NOH_CONVERT_LOD_LOD_JOINTS_FIT_H

#include <stdint.h>

#define JOINTS_PER_VERTEX 4u

/* Points that lie at one place and are moved alike get the same weights, fitted to the first one's normal. */
typedef struct joint_fit_points {
    uint32_t count, target_count;
    const float *place, *normal; /* [count][3] */
    const float *move, *turn;    /* [count][target_count][3] of each target: of the point, of the unit normal */
    const uint16_t *parent;      /* [count] the joint of the skin that moves it most */
    const float *share;          /* [count] that joint's weight, which is dealt out; the rest is other joints' */
    const uint8_t *slots;        /* [count] 1..JOINTS_PER_VERTEX: the most that the share is dealt to */
    float normal_length;         /* a normal that is off by 1 counts as that length */
} joint_fit_points;

typedef struct joint_fit {
    uint32_t joint_count, target_count;
    uint16_t *parent; /* [joint_count] */
    float *centre;    /* [joint_count][3] */
    float *scale;     /* [joint_count][2] of moves and of turns */
    int16_t *motion;  /* [joint_count][target_count][6] move and turn, -JOINT_MOTION_MAX..JOINT_MOTION_MAX */
    uint8_t *joint;   /* [count][JOINTS_PER_VERTEX] */
    float *weight;    /* [count][JOINTS_PER_VERTEX] 0 and above; what they leave of the share is the parent's */
} joint_fit;

#define JOINT_MOTION_MAX 511

/* Fit at most joint_max joints. Fewer where fewer leave nothing. 0, or 1 when out of memory; free in both cases. */
int joint_fit_make(const joint_fit_points *points, uint32_t joint_max, joint_fit *out);
void joint_fit_free(joint_fit *f);

/* What a target at weight 1 does to a point: its move, and the turn w of what lies about it. */
void joint_fit_motion(const joint_fit_points *points, const joint_fit *f, uint32_t point, uint32_t target,
                      float move[3], float turn[3]);

#endif
