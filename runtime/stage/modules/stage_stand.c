/* stage_stand.c: how humanoids stand that play nothing.
 *
 * All motion is a function of the clock and of the actor: values that are held for some seconds and go over to the
 * next, and a breath. At the first tick all of it is 0. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/quarter_internal.h"
#include "life/face/face_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/feet_internal.h"
#include "life/reach/gaze_internal.h"
#include "life/reach/reach_internal.h"
#include "life/reach/rig_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "stage/cast/stage_internal.h"
#include "stage/modules/stage_legs_internal.h"

#define SECONDS(s) ((uint32_t)((s) * (float)NOH_TICKS_PER_SECOND))
#define ARM_OUT 0.24f /* of a lowered upper arm, relative to its height */
#define FORE_OUT 0.06f
#define FORE_AHEAD 0.22f
#define LOWERED 0.93f /* cosine to straight down: arms at least as low stay as they are */
#define BREATH 0.022f /* radians */
#define SHIFT 0.035f  /* of a leg, to each side */
#define TILT 0.035f   /* radians, of the pelvis */
#define TURN 0.3f     /* of the head, to each side */
#define NOD 0.08f
#define DRIFT 0.006f /* of a leg: always on its way */

enum { WEIGHT, YAW, PITCH, DRIFT_X, DRIFT_Z, PHASE };

/* ---- values ---- */

/* The weight goes from one leg to the other. */
static float key_of(uint32_t seed, uint32_t stream, uint32_t index)
{
    if (!index) return 0.0f;
    const float u = noh_face_uniform(seed, NOH_FACE_STAND + stream, index);
    if (stream != WEIGHT) return 2.0f * u - 1.0f;
    return (index + seed) % 2u ? 0.6f + 0.4f * u : -0.6f - 0.4f * u;
}

/* -1..1: held, then for `moves` seconds of each period on its way to the next value. */
static float held(const noh_modifier_work *w, uint32_t stream, float period, float moves)
{
    const uint32_t seed = w->actor.id, ticks = SECONDS(period);
    const uint64_t clock = (uint64_t)w->clock;
    const uint32_t index = (uint32_t)(clock / ticks);
    const float at = (float)(clock % ticks) / (float)NOH_TICKS_PER_SECOND;
    const float begins = (period - moves) * noh_face_uniform(seed, NOH_FACE_STAND + PHASE, index);
    const float part = (at - begins) / moves, s = part < 0.0f ? 0.0f : part > 1.0f ? 1.0f : part;
    const float from = key_of(seed, stream, index), to = key_of(seed, stream, index + 1u);
    return from + (to - from) * s * s * s * (10.0f - s * (15.0f - 6.0f * s));
}

/* A vector of the body, to its left, up and ahead, in the model. */
static void vector_of(const noh_kind_stand *s, float left, float up, float ahead, float out[3])
{
    const float own[3] = { left, up, ahead };
    noh_quarter_turn(s->front, own, out);
}

/* ---- arms ---- */

static void point(const noh_modifier_work *w, const noh_kind_stand *s, uint32_t joint, uint32_t next, float side,
                  float forth)
{
    float bone[3], direction[3], ahead[3], turn[4];
    vector_of(s, side, -1.0f, forth, direction);
    vector_of(s, 0.0f, 0.0f, 1.0f, ahead);
    noh_rig_bone(w->skeleton, w->local, joint, next, bone);
    noh_quat_between(bone, direction, ahead, turn);
    noh_rig_turn(w->skeleton, w->local, joint, turn);
}

static void lower_arm(const noh_modifier_work *w, const noh_kind_stand *s, const noh_reach_arm *arm, float side)
{
    float bone[3];
    noh_rig_bone(w->skeleton, w->local, arm->upper, arm->fore, bone);
    if (-bone[1] >= LOWERED * noh_length3(bone)) return;
    point(w, s, arm->upper, arm->fore, side * ARM_OUT, 0.0f);
    point(w, s, arm->fore, arm->hand, side * FORE_OUT, FORE_AHEAD);
}

static void lower_arms(const noh_modifier_work *w, const noh_kind_stand *s)
{
    const noh_reach_rig *rig = &s->arms;
    float left[3];
    vector_of(s, 1.0f, 0.0f, 0.0f, left);
    for (uint32_t i = 0; i < rig->arm_count && w->joint_count > rig->last; i++) {
        float root[3], hand[3], unused[4];
        noh_rig_joint(w->skeleton, w->local, 0, root, unused);
        noh_rig_joint(w->skeleton, w->local, rig->arms[i].hand, hand, unused);
        lower_arm(w, s, &rig->arms[i], noh_dot3(hand, left) < noh_dot3(root, left) ? -1.0f : 1.0f);
    }
}

/* ---- body ---- */

/* Turn by radians about the axes of vector_of. */
static void turn_by(const noh_modifier_work *w, const noh_kind_stand *s, uint32_t joint, float side, float up,
                    float ahead)
{
    float turn[3];
    vector_of(s, side, up, ahead, turn);
    noh_rig_rotate(w->skeleton, w->local, joint, turn);
}

static void shift_weight(const noh_modifier_work *w, const noh_kind_stand *s)
{
    const noh_feet_rig *rig = &s->legs;
    const noh_gaze_rig *trunk = &s->trunk;
    const float weight = held(w, WEIGHT, 6.0f, 1.6f), size = rig->length;
    noh_stage_leg legs[NOH_FEET_LEGS_MAX];
    float by[3];
    if (!rig->leg_count || w->joint_count <= rig->last) return;
    vector_of(s, size * (SHIFT * weight + DRIFT * held(w, DRIFT_X, 2.2f, 2.2f)), 0.0f,
              size * DRIFT * held(w, DRIFT_Z, 1.7f, 1.7f), by);
    for (uint32_t i = 0; i < rig->leg_count; i++) noh_stage_read_leg(rig, w, i, &legs[i]);
    turn_by(w, s, rig->top, 0.0f, 0.0f, -TILT * weight);
    if (trunk->joint_count > 1u) turn_by(w, s, trunk->joints[0], 0.0f, 0.0f, TILT * weight);
    for (uint32_t i = 0; i < rig->leg_count; i++) {
        const noh_stage_leg was = legs[i];
        noh_stage_read_leg(rig, w, i, &legs[i]);
        memcpy(legs[i].ankle, was.ankle, sizeof was.ankle);
        memcpy(legs[i].foot, was.foot, sizeof was.foot);
    }
    noh_stage_move_pelvis(rig, w, legs, by);
}

static void move_trunk(const noh_modifier_work *w, const noh_kind_stand *s)
{
    const noh_gaze_rig *rig = &s->trunk;
    const noh_stage_kind *k = w->kind;
    const float breath = BREATH * noh_stage_breath(w->clock), yaw = TURN * held(w, YAW, 4.3f, 0.7f);
    const float pitch = NOD * held(w, PITCH, 3.1f, 0.8f);
    if (!rig->joint_count || w->joint_count <= rig->last) return;
    if (rig->joint_count > 1u) turn_by(w, s, rig->joints[0], -breath, 0.0f, 0.0f);
    for (uint32_t i = 0; i < rig->joint_count && !k->modules[NOH_SLOT_FACE].type; i++) {
        turn_by(w, s, rig->joints[i], rig->shares[i] * pitch, rig->shares[i] * yaw, 0.0f);
    }
    turn_by(w, s, rig->joints[rig->joint_count - 1u], breath, 0.0f, 0.0f);
}

static void stand_pose(noh_modifier_work *w)
{
    const noh_kind_stand *s = w->user;
    lower_arms(w, s);
    shift_weight(w, s);
    move_trunk(w, s);
}

/* ---- made ---- */

noh_result noh_kind_stand_make(const noh_kind_desc *kind, noh_kind_stand *stand, noh_error *error)
{
    const noh_skeleton_header *header;
    NOH_ASSERT(kind && stand);
    noh_ragdoll_source source = { .pack = kind->mesh, .skeleton = kind->skeleton };
    memset(stand, 0, sizeof *stand);
    if (source.skeleton == NOH_NONE || !source.pack->runs[NOH_CHUNK_SKELETON].count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "stand: the kind has no skeleton: use the pack of a skinned model", 0,
                        0);
    }
    const noh_result result = noh_pack_skeleton_at(source.pack, source.skeleton, &source.joints, &header, error);
    if (result != NOH_OK) return result;
    source.metres = header->unit_cm / 100.0f;
    if (noh_feet_rig_make(&source, &stand->legs, NULL)) stand->legs.leg_count = 0;
    stand->front = noh_feet_front(&source, &stand->legs);
    if (noh_reach_rig_find(&source, stand->front, &stand->arms, NULL)) stand->arms.arm_count = 0;
    if (noh_gaze_rig_find(&source, stand->front, &stand->trunk, NULL)) stand->trunk.joint_count = 0;
    if (stand->arms.arm_count || stand->legs.leg_count || stand->trunk.joint_count) return NOH_OK;
    return noh_fail(error, NOH_ERR_NOT_FOUND,
                    "stand: no joints have the names of arms, legs or a head: fill in "
                    "noh_kind_stand by hand",
                    0, 0);
}

noh_modifier noh_stand_modifier(const noh_kind_stand *stand)
{
    NOH_ASSERT(stand);
    return (noh_modifier){ .name = "stand", .modify = stand_pose, .user = stand };
}
