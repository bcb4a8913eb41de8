/* reach.h: hands that reach for moving points.
 *
 *   noh_reach_rig_make   find arms by joint names
 *   noh_reach_init       no target
 *   noh_reach_step       bend the arms of a pose so that its hands are on their points
 *
 * An arm is two bones (noh_ik_two_bone) that slow down before they are straight; its elbow keeps its side. A hand moves
 * to its point within 0.35 s, and back as smoothly; once there it stays on the point as it moves. The arm points at a
 * point out of reach. The hand keeps its angle to the forearm.
 * Threads: no state but the noh_reach passed; any thread. */
#ifndef NOH_SIM_REACH_H
#define NOH_SIM_REACH_H

#include "core/base/limits.h"
#include "motion/pose/skeleton.h"
#include "life/physics/ragdoll_rig.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_reach_arm {
    uint32_t upper, fore, hand;
    float elbow[3]; /* unit, in the upper arm's space: direction of the elbow */
    /* the point of the hand to put on the target, in the hand's space; rigs from noh_reach_rig_make have 0: the
     * wrist */
    float palm[3];
} noh_reach_arm;

typedef struct noh_reach_rig {
    noh_reach_arm arms[NOH_REACH_ARMS_MAX]; /* the left one first: greater x in the bind pose */
    uint32_t arm_count;                     /* 1..NOH_REACH_ARMS_MAX */
    uint32_t last;                          /* the highest index of all joints above */
} noh_reach_rig;

/* Find upper arm, forearm and hand by the names that noh_ragdoll_find_rows knows.
 * errors   NOT_FOUND no upper arm has a forearm and a hand, or there are no thighs */
noh_result noh_reach_rig_make(const noh_ragdoll_source *source, noh_reach_rig *rig, noh_error *error);

typedef struct noh_reach_hand {
    float point[3]; /* for callers that store the target here (stage/stage_reach.h); unused by noh_reach_step */
    float part;     /* 0..1 fraction of the time to reach, before easing */
    uint32_t wants; /* 1: it reaches, while set */
    uint32_t unused[3];
} noh_reach_hand;

/* The state of both arms. A copy continues identically; zeros reach for nothing. */
typedef struct noh_reach {
    noh_reach_hand hands[NOH_REACH_ARMS_MAX];
} noh_reach;

void noh_reach_init(noh_reach *reach);

/* Check a state that comes from outside.
 * returns  NULL if it may be used, else a constant message */
const char *noh_reach_check(const noh_reach *reach);

/* Advance time, and bend a pose's arms.
 * local    [joint_count]; changes the rotations of upper arms and forearms
 * points   [NOH_REACH_ARMS_MAX][3] in model space, finite; used for hands that reach or return
 * seconds  since the last step, 0..
 * cut      1: hands are in their final place immediately */
void noh_reach_step(noh_reach *reach, const noh_reach_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                    float points[NOH_REACH_ARMS_MAX][3], float seconds, int cut);

#ifdef __cplusplus
}
#endif

#endif
