/* gaze.h: turns a body to look at a point: spine, neck, head and eyes together.
 *
 *   noh_gaze_rig_make   find the joints that turn, by name
 *   noh_gaze_init       look ahead
 *   noh_gaze_step       turn a pose: within a cone, at a limited speed
 *
 * The head turns as in ik.h (noh_ik_look_step): towards a target outside its cone as far as it can. Spine and neck take
 * their shares of the turn. Eyes are faster: they are on the target while the head still turns, and take a quarter of
 * the angle themselves. Animation of eye joints in clips is overwritten.
 *
 * For bodies without an animated face: faces (face.h, stage_face.h) have their own gaze.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 11, "Look-At Inverse Kinematics", which turns
 *          only the head
 * Threads: no state but the noh_gaze passed; any thread. */
#ifndef NOH_SIM_GAZE_H
#define NOH_SIM_GAZE_H

#include "core/base/limits.h"
#include "motion/pose/skeleton.h"
#include "life/reach/ik.h"
#include "life/physics/ragdoll_rig.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The joints that turn. May also be filled in by hand. */
typedef struct noh_gaze_rig {
    uint32_t joints[NOH_GAZE_JOINTS_MAX]; /* each below the previous one; the last is the head */
    float shares[NOH_GAZE_JOINTS_MAX];    /* of the turn, 0..1; their sum is 1 */
    uint32_t joint_count;                 /* 1..NOH_GAZE_JOINTS_MAX */
    uint32_t eyes[2];                     /* below the head; NOH_NONE: the head turns all the way */
    float ahead[3];                       /* unit, in the head's space: direction of the face */
    float middle[3];                      /* midpoint of the eyes, in the head's space */
    float eyes_ahead[2][3];               /* unit, in the eyes' spaces */
    float size;                           /* from the first joint to `middle`, in the skeleton's unit, above 0 */
    uint32_t last;                        /* the highest index of all joints above */
} noh_gaze_rig;

/* Find spine, neck, head and eyes by joint names such as 'mixamorig:Spine1', 'neck.x', 'b_Head_05', 'LeftEye'; joints
 * of the spine have no legs below them. The body must face +z in the bind pose. Without eye joints, the eyes are at the
 * middle of the head's skin.
 * pack     joint names, and skinned meshes of that skeleton
 * errors   NOT_FOUND no joint's name contains 'head', or as noh_pack_skeleton_at */
noh_result noh_gaze_rig_make(const noh_pack *pack, uint32_t skeleton, noh_gaze_rig *rig, noh_error *error);

/* The state of a gaze. A copy continues identically; zeros look ahead. */
typedef struct noh_gaze {
    noh_ik_look head, eyes;
    float point[3]; /* for callers that store the target here (stage_gaze.h); unused by noh_gaze_step */
    uint32_t looks; /* 1: at the point; likewise */
    float near;     /* 1 / distance of the target */
    uint32_t begun, unused[2];
} noh_gaze;

void noh_gaze_init(noh_gaze *gaze);

/* Check a state that comes from outside.
 * returns  NULL if it may be used, else a constant message */
const char *noh_gaze_check(const noh_gaze *gaze);

/* Advance time, and turn a pose.
 * desc     of the head; zeros: as in ik.h
 * local    [joint_count], from a clip; changes the rotations of the rig's joints and eyes
 * target   in model space, finite; NULL: ahead
 * seconds  since the last step, 0..
 * cut      1: look there immediately, as a new noh_gaze does */
void noh_gaze_step(noh_gaze *gaze, const noh_gaze_rig *rig, const noh_ik_look_desc *desc, const noh_skeleton *skeleton,
                   noh_transform *local, const float *target, float seconds, int cut);

#ifdef __cplusplus
}
#endif

#endif
