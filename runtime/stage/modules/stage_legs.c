/* stage_legs.c: legs of a pose that keep their feet where they are wanted while the pelvis moves. */
#include "stage/modules/stage_legs_internal.h"

#include <string.h>

#include "core/base/vector_internal.h"
#include "life/reach/rig_internal.h"
#include "noh/body.h"
#include "noh/low_core.h"

#define STRAIGHT 0.985f /* of a leg, at most */
#define BEND 0.3f       /* of a leg: how much its pole counts where it is straight */

void noh_stage_read_leg(const noh_feet_rig *rig, const noh_modifier_work *w, uint32_t leg, noh_stage_leg *out)
{
    const noh_feet_leg *l = &rig->legs[leg];
    float thigh[4], unused[4], along[3];
    noh_rig_joint(w->skeleton, w->local, l->thigh, out->hip, thigh);
    noh_rig_joint(w->skeleton, w->local, l->shin, out->knee, unused);
    noh_rig_joint(w->skeleton, w->local, l->foot, out->end, out->foot);
    memcpy(out->ankle, out->end, sizeof out->ankle);
    noh_quat_rotate(thigh, l->knee, out->pole);
    noh_sub3(out->knee, out->hip, along);
    noh_madd3(along, BEND * rig->length, out->pole, out->pole);
}

/* How far a hip must come down so that its leg reaches. */
static float lacks(const noh_stage_leg *l, const float by[3])
{
    float upper[3], lower[3], way[3];
    noh_sub3(l->knee, l->hip, upper);
    noh_sub3(l->end, l->knee, lower);
    noh_sub3(l->ankle, l->hip, way);
    noh_sub3(way, by, way);
    const float reach = STRAIGHT * (noh_length3(upper) + noh_length3(lower));
    const float room = reach * reach - way[0] * way[0] - way[2] * way[2];
    const float down = -way[1] - (room > 0.0f ? noh_sqrt(room) : 0.0f);
    return down > 0.0f ? down : 0.0f;
}

static void move_top(const noh_feet_rig *rig, const noh_modifier_work *w, const float by[3])
{
    const uint32_t parent = w->skeleton->parents[rig->top];
    float at[3], carrier[4] = { 0.0f, 0.0f, 0.0f, 1.0f }, way[3];
    if (parent != NOH_JOINT_ROOT) noh_rig_joint(w->skeleton, w->local, parent, at, carrier);
    noh_quat_conjugate(carrier, carrier);
    noh_quat_rotate(carrier, by, way);
    noh_madd3(w->local[rig->top].translation, 1.0f, way, w->local[rig->top].translation);
}

static void bend_leg(const noh_feet_leg *leg, const noh_modifier_work *w, const noh_stage_leg *l, const float by[3])
{
    noh_ik_limb limb = { { 0.0f }, { 0.0f }, { 0.0f }, 0.0f, 0.0f, 0.0f };
    noh_ik_bend bend;
    float at[3], turn[4];
    noh_madd3(l->hip, 1.0f, by, limb.start);
    noh_madd3(l->knee, 1.0f, by, limb.middle);
    noh_madd3(l->end, 1.0f, by, limb.end);
    noh_ik_two_bone(&limb, l->ankle, l->pole, 1.0f, &bend);
    noh_rig_turn(w->skeleton, w->local, leg->thigh, bend.start);
    noh_rig_turn(w->skeleton, w->local, leg->shin, bend.middle);
    noh_rig_joint(w->skeleton, w->local, leg->foot, at, turn);
    noh_quat_conjugate(turn, turn);
    noh_quat_mul(l->foot, turn, turn);
    noh_rig_turn(w->skeleton, w->local, leg->foot, turn);
}

void noh_stage_move_pelvis(const noh_feet_rig *rig, const noh_modifier_work *w, noh_stage_leg *legs, const float by[3])
{
    float way[3] = { by[0], by[1], by[2] }, down = 0.0f;
    for (uint32_t i = 0; i < rig->leg_count; i++) {
        const float lack = lacks(&legs[i], by);
        down = lack > down ? lack : down;
    }
    way[1] -= down;
    move_top(rig, w, way);
    for (uint32_t i = 0; i < rig->leg_count; i++) bend_leg(&rig->legs[i], w, &legs[i], way);
}
