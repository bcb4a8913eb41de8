/* gaze.h: a body that looks at a point: spine, neck, head and eyes turn together.
 *
 *   noh_gaze_rig_make   the joints that turn, by their names
 *   noh_gaze_init       looks ahead
 *   noh_gaze_step       a pose looks on: within a cone, at a limited speed
 *
 * The head turns as ik.h has it (noh_ik_look_step): towards what is outside of its cone as far as it may. Spine and
 * neck take their shares of its turn. Eyes are quicker: they are on the target while the head still turns, and take a
 * quarter of the way for themselves. What clips do to joints of eyes is not kept.
 *
 * For bodies whose face does not live by itself: faces (face.h, stage_face.h) have a gaze of their own.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 11, "Look-At Inverse Kinematics", which turns the
 *          head alone
 * Threads: no state but the noh_gaze that is passed; any thread. */
#ifndef NOH_SIM_GAZE_H
#define NOH_SIM_GAZE_H

#include "core/base/limits.h"
#include "motion/pose/skeleton.h"
#include "life/reach/ik.h"
#include "life/physics/ragdoll_rig.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A rig may also be filled by hand. */
typedef struct noh_gaze_rig {
    uint32_t joints[NOH_GAZE_JOINTS_MAX]; /* each below the one before; the last is the head */
    float shares[NOH_GAZE_JOINTS_MAX];    /* of the turn, 0..1; their sum is 1 */
    uint32_t joint_count;                 /* 1..NOH_GAZE_JOINTS_MAX */
    uint32_t eyes[2];                     /* below the head; NOH_NONE: the head does all */
    float ahead[3];                       /* unit, in the head's space: where the face points */
    float middle[3];                      /* between the eyes, in the head's space */
    float eyes_ahead[2][3];               /* unit, in the eyes' spaces */
    float size;                           /* from the first joint to `middle`, in the skeleton's unit, above 0 */
    uint32_t last;                        /* the highest index of all joints above */
} noh_gaze_rig;

/* Spine, neck, head and eyes, as far as joints have such names ('mixamorig:Spine1', 'neck.x', 'b_Head_05', 'LeftEye');
 * a spine is what has no legs below it. The body looks along +z in the bind pose. Without joints for eyes they are in
 * the middle of the head's skin.
 * pack     its names, and the skinned meshes of that skeleton
 * errors   NOT_FOUND no joint's name has 'head', or as noh_pack_skeleton_at */
noh_result noh_gaze_rig_make(const noh_pack *pack, uint32_t skeleton, noh_gaze_rig *rig, noh_error *error);

/* 64 bytes. A copy of it goes on as it does; zeros look ahead. */
typedef struct noh_gaze {
    noh_ik_look head, eyes;
    float point[3]; /* for whom keeps the target with it (stage_gaze.h); noh_gaze_step does not read it */
    uint32_t looks; /* 1: at the point; likewise */
    float near;     /* 1 / distance of what it looks at */
    uint32_t begun, unused[2];
} noh_gaze;

void noh_gaze_init(noh_gaze *gaze);

/* What is wrong with a state that comes from outside, a constant text; NULL: it is good. */
const char *noh_gaze_check(const noh_gaze *gaze);

/* Time moves on, and a pose is turned.
 * desc     of the head; zeros: as in ik.h
 * local    [joint_count], of a clip; changed are the rotations of the rig's joints and eyes
 * target   in model space, finite; NULL: ahead
 * seconds  since the step before, 0..
 * cut      1: it looks there at once, as a new noh_gaze does */
void noh_gaze_step(noh_gaze *gaze, const noh_gaze_rig *rig, const noh_ik_look_desc *desc, const noh_skeleton *skeleton,
                   noh_transform *local, const float *target, float seconds, int cut);

#ifdef __cplusplus
}
#endif

#endif
