/* stage_lie.c: figures that lie after a fall breathe.
 *
 * Breath is added to the pose after the ragdoll's: the chest rises, away from the ground however it lies, and all joints
 * on it stay where they are, so that head and hands do not slide. The ragdoll's bodies stay, too, and sleep on. */
#include "core/base/math_internal.h"
#include "life/reach/rig_internal.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "stage/modules/stage_legs_internal.h"
#include "stage/modules/stage_ragdoll_internal.h"

#define RESTED_TICKS (2u * NOH_TICKS_PER_SECOND) /* until its breath is full */
#define ENDS_FASTER 8u                           /* when it is pushed again */
#define OUT_TICKS (NOH_TICKS_PER_SECOND / 2u)    /* as it gets up */
#define LIFT_M 0.006f                            /* of the chest */

void noh_stage_step_lying(const noh_stage_ragdoll_kind *shared, noh_stage_body *b, uint32_t ticks)
{
    const uint64_t rested = (uint64_t)b->rise_ticks + ticks, less = (uint64_t)ticks * ENDS_FASTER;
    if (noh_ragdoll_sleeps(shared->dolls, b->doll - 1u) && !b->dead) {
        b->rise_ticks = rested < RESTED_TICKS ? (uint32_t)rested : RESTED_TICKS;
    } else {
        b->rise_ticks = b->rise_ticks > less ? b->rise_ticks - (uint32_t)less : 0u;
    }
}

/* Move a joint by a vector in its carrier's space; the joints on it stay. */
static void move_alone(const noh_skeleton *k, noh_transform *local, uint32_t joint, const float by[3])
{
    float back[4], moved[3];
    noh_quat_conjugate(local[joint].rotation, back);
    noh_quat_rotate(back, by, moved);
    for (int i = 0; i < 3; i++) moved[i] = local[joint].scale[i] == 0.0f ? 0.0f : moved[i] / local[joint].scale[i];
    for (uint32_t c = joint + 1u; c < k->joint_count; c++) {
        if (k->parents[c] == joint) noh_madd3(local[c].translation, -1.0f, moved, local[c].translation);
    }
    noh_madd3(local[joint].translation, 1.0f, by, local[joint].translation);
}

/* share: of the highest the chest gets */
static void lift_chest(const noh_stage_kind *k, const noh_modifier_work *w, float share)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    float up[3] = { 0.0f, share * LIFT_M / shared->metres, 0.0f }, turn[4], at[3], carrier[4];
    if (shared->parts.chest == NOH_NONE || share == 0.0f) return;
    const uint32_t chest = shared->fit.joints[shared->parts.chest];
    uint32_t on = w->skeleton->parents[chest];
    if (on == NOH_JOINT_ROOT) return; /* all of it would move */
    noh_rig_joint(w->skeleton, w->local, on, at, carrier);
    noh_quat_mul(w->place.rotation, carrier, turn);
    noh_quat_conjugate(turn, turn);
    noh_quat_rotate(turn, up, up);
    for (; on != NOH_JOINT_ROOT; on = w->skeleton->parents[on]) {
        if (w->local[on].scale[0] == 0.0f) return; /* a point, which does not show */
        for (int i = 0; i < 3; i++) up[i] /= w->local[on].scale[0];
    }
    move_alone(w->skeleton, w->local, chest, up);
}

static float breath_of(const noh_stage_body *b, int64_t clock)
{
    const float rested = (float)b->rise_ticks / (float)RESTED_TICKS;
    return rested * rested * (3.0f - 2.0f * rested) * noh_stage_breath(clock);
}

void noh_stage_breathe_lying(const noh_stage_kind *k, const noh_stage_body *b, const noh_modifier_work *w)
{
    float weights[NOH_RAGDOLL_BODIES_MAX];
    const uint32_t chest = noh_stage_ragdoll_kind_of(k)->parts.chest;
    if (chest == NOH_NONE || !b->rise_ticks || b->state != NOH_BODY_FALLS) return;
    noh_stage_ragdoll_weights(k, b, weights);
    lift_chest(k, w, weights[chest] * breath_of(b, w->clock));
}

uint8_t noh_stage_breath_left(const noh_stage_body *b, int64_t clock)
{
    if (b->state != NOH_BODY_FALLS) return 0;
    const uint32_t byte = (uint32_t)(breath_of(b, clock) * 255.0f + 0.5f);
    return (uint8_t)byte;
}

void noh_stage_breathe_out(const noh_stage_kind *k, noh_stage_body *b, const noh_modifier_work *w)
{
    const uint64_t less = 1u + (uint64_t)w->ticks * 255u / OUT_TICKS;
    b->goals = w->cut || b->goals <= less ? 0u : (uint8_t)(b->goals - less);
    lift_chest(k, w, (float)b->goals / 255.0f);
}
