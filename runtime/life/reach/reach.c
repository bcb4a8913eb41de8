/* reach.c: arms by joint names, and their bends. */
#include "core/base/quarter_internal.h"
#include "core/base/trig_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/feet_internal.h"
#include "life/reach/reach_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"

#include "core/base/assert_internal.h"
#include "life/reach/rig_internal.h"

#define REACH_SECONDS 0.35f
#define SOFT 0.97f
#define BEND_MAX (150.0f * NOH_PI / 180.0f)
#define STRAIGHT 0.05f /* an elbow bent less than this, in shares of the arm, points as in the model */

/* ---- the rig ---- */

/* Find an arm: forearms are the only hinges that bend forwards, and a row below one is a hand. */
static int arm_of(const noh_ragdoll_source *s, const noh_ragdoll_row *rows, uint32_t count, uint32_t hand,
                  noh_reach_arm *arm)
{
    const uint32_t fore = noh_ragdoll_row_above(s, rows, count, rows[hand].joint);
    if (fore == NOH_NONE || !rows[fore].hinge || rows[fore].toward != NOH_RAGDOLL_FORWARD) return 0;
    const uint32_t upper = noh_ragdoll_row_above(s, rows, count, rows[fore].joint);
    if (upper == NOH_NONE || upper == 0) return 0;
    memset(arm, 0, sizeof *arm);
    arm->hand = rows[hand].joint;
    arm->fore = rows[fore].joint;
    arm->upper = rows[upper].joint;
    return 1;
}

/* The elbow's direction from its bend in the bind pose; for a straight arm backwards and a little down. */
static void find_elbow(const noh_ragdoll_source *s, uint32_t front, noh_reach_arm *arm)
{
    float from[3], elbow[3], wrist[3], rotation[4], unused[4], along[3], side[3], back[3] = { 0.0f, -0.4f, -1.0f };
    noh_quarter_turn(front, back, back);
    noh_ragdoll_bind(&s->joints, arm->upper, from, rotation);
    noh_ragdoll_bind(&s->joints, arm->fore, elbow, unused);
    noh_ragdoll_bind(&s->joints, arm->hand, wrist, unused);
    noh_sub3(wrist, from, along);
    const float length = noh_length3(along);
    noh_normalize3(along, back);
    noh_sub3(elbow, from, side);
    noh_reject3(side, along, side);
    if (noh_length3(side) < STRAIGHT * length || side[0] * back[0] + side[2] * back[2] < 0.0f)
        memcpy(side, back, sizeof side);
    noh_perpendicular3(along, side, side);
    noh_quat_conjugate(rotation, rotation);
    noh_quat_rotate(rotation, side, arm->elbow);
}

/* How far to the left an arm begins. */
static float side_of(const noh_ragdoll_source *s, uint32_t front, const noh_reach_arm *arm)
{
    float at[3], unused[4];
    noh_ragdoll_bind(&s->joints, arm->upper, at, unused);
    noh_quarter_turn(4u - front, at, at);
    return at[0];
}

noh_result noh_reach_rig_find(const noh_ragdoll_source *source, uint32_t front, noh_reach_rig *rig, noh_error *error)
{
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
    const noh_result result = noh_ragdoll_find_rows(source, rows, &count, error);
    if (result != NOH_OK) return result;
    memset(rig, 0, sizeof *rig);
    for (uint32_t i = 0; i < count && rig->arm_count < NOH_REACH_ARMS_MAX; i++) {
        noh_reach_arm *arm = &rig->arms[rig->arm_count];
        if (!arm_of(source, rows, count, i, arm)) continue;
        find_elbow(source, front, arm);
        rig->last = arm->hand > rig->last ? arm->hand : rig->last;
        rig->arm_count++;
    }
    if (!rig->arm_count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "no upper arm of this skeleton has a forearm and a hand: it cannot reach", 0, 0);
    }
    if (rig->arm_count == 2u && side_of(source, front, &rig->arms[0]) < side_of(source, front, &rig->arms[1])) {
        const noh_reach_arm right = rig->arms[0];
        rig->arms[0] = rig->arms[1];
        rig->arms[1] = right;
    }
    return NOH_OK;
}

noh_result noh_reach_rig_make(const noh_ragdoll_source *source, noh_reach_rig *rig, noh_error *error)
{
    NOH_ASSERT(source && source->pack && rig);
    return noh_reach_rig_find(source, noh_front_of(source), rig, error);
}

/* ---- states ---- */

const char *noh_reach_check(const noh_reach *reach)
{
    for (uint32_t i = 0; i < NOH_REACH_ARMS_MAX; i++) {
        const noh_reach_hand *h = &reach->hands[i];
        if (!noh_are_sound(h->point, 3)) return "reach: a point is not a number";
        if (h->wants > 1u || !(h->part >= 0.0f && h->part <= 1.0f))
            return "reach: a fraction or a flag is out of range";
    }
    return NULL;
}

/* ---- a step ---- */

/* The point of the hand moves as part of the forearm. */
static void bend_arm(const noh_reach_arm *arm, const noh_skeleton *skeleton, noh_transform *local, const float point[3],
                     float weight)
{
    noh_ik_limb limb = { { 0.0f }, { 0.0f }, { 0.0f }, 0.0f, BEND_MAX, SOFT };
    noh_ik_bend bend;
    float rotation[4], hand[4], pole[3], along[3], side[3], axis[3];
    noh_rig_joint(skeleton, local, arm->upper, limb.start, rotation);
    noh_rig_joint(skeleton, local, arm->fore, limb.middle, hand);
    noh_rig_joint(skeleton, local, arm->hand, limb.end, hand);
    noh_quat_rotate(hand, arm->palm, axis);
    noh_madd3(limb.end, 1.0f, axis, limb.end);
    noh_sub3(limb.end, limb.start, along);
    const float length = noh_length3(along);
    noh_normalize3(along, arm->elbow);
    noh_sub3(limb.middle, limb.start, side);
    noh_reject3(side, along, pole);
    noh_quat_rotate(rotation, arm->elbow, axis);
    noh_madd3(pole, STRAIGHT * length, axis, pole);
    noh_ik_two_bone(&limb, point, pole, weight, &bend);
    noh_rig_turn(skeleton, local, arm->upper, bend.start);
    noh_rig_turn(skeleton, local, arm->fore, bend.middle);
}

void noh_reach_step(noh_reach *reach, const noh_reach_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                    float points[NOH_REACH_ARMS_MAX][3], float seconds, int cut)
{
    NOH_ASSERT(reach && rig && skeleton && local && points && seconds >= 0.0f);
    NOH_ASSERT(rig->arm_count <= NOH_REACH_ARMS_MAX && rig->last < skeleton->joint_count);
    /* the second condition is for gcc, which warns without it at -O3 */
    for (uint32_t i = 0; i < rig->arm_count && i < NOH_REACH_ARMS_MAX; i++) {
        noh_reach_hand *h = &reach->hands[i];
        const float goal = h->wants ? 1.0f : 0.0f, way = seconds / REACH_SECONDS, left = goal - h->part;
        h->part = cut || (left < way && left > -way) ? goal : h->part + (left > 0.0f ? way : left < 0.0f ? -way : 0.0f);
        const float t = h->part;
        if (t > 0.0f) bend_arm(&rig->arms[i], skeleton, local, points[i], t * t * (3.0f - 2.0f * t));
    }
}
