/* reach.h: hands that reach for points that move.
 *
 *   noh_reach_rig_make   arms, by the names of joints
 *   noh_reach_init       reaches for nothing
 *   noh_reach_step       a pose with its hands on their points
 *
 * An arm is two bones (noh_ik_two_bone) that slow down before they are straight and whose elbow keeps its side. A hand
 * goes to its point within 0.35 s and back as smoothly, and from then on is on it however it moves; a point out of
 * reach is pointed at. The hand keeps its angle to the forearm.
 * Threads: no state but the noh_reach that is passed; any thread. */
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
    float elbow[3]; /* unit, in the upper arm's space: where the elbow points */
    float palm[3];  /* what is to be on the point, in the hand's space; of a made rig 0: the wrist */
} noh_reach_arm;

typedef struct noh_reach_rig {
    noh_reach_arm arms[NOH_REACH_ARMS_MAX]; /* the left one first: at the greater x in the bind pose */
    uint32_t arm_count;                     /* 1..NOH_REACH_ARMS_MAX */
    uint32_t last;                          /* the highest index of all joints above */
} noh_reach_rig;

/* Upper arm, forearm and hand by the names that noh_ragdoll_find_rows knows.
 * errors   NOT_FOUND no upper arm has a forearm and a hand, or there are no thighs */
noh_result noh_reach_rig_make(const noh_ragdoll_source *source, noh_reach_rig *rig, noh_error *error);

typedef struct noh_reach_hand {
    float point[3]; /* for whom keeps the target with it (stage/stage_reach.h); noh_reach_step does not read it */
    float part;     /* 0..1 of the way in time, before it is eased */
    uint32_t wants; /* 1: it reaches, for as long */
    uint32_t unused[3];
} noh_reach_hand;

/* 64 bytes. A copy of it goes on as it does; zeros reach for nothing. */
typedef struct noh_reach {
    noh_reach_hand hands[NOH_REACH_ARMS_MAX];
} noh_reach;

void noh_reach_init(noh_reach *reach);

/* What is wrong with a state that comes from outside, a constant text; NULL: it is good. */
const char *noh_reach_check(const noh_reach *reach);

/* Time moves on, and a pose's arms are bent.
 * local    [joint_count]; changed are the rotations of upper arms and forearms
 * points   [NOH_REACH_ARMS_MAX][3] in model space, finite; read of hands that reach or still come back
 * seconds  since the step before, 0..
 * cut      1: hands are where they shall be at once */
void noh_reach_step(noh_reach *reach, const noh_reach_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                    float points[NOH_REACH_ARMS_MAX][3], float seconds, int cut);

#ifdef __cplusplus
}
#endif

#endif
