/* stage_gaze.c: gazes and hands as modifiers of a kind. */
#include "life/reach/gaze_internal.h"
#include "life/reach/reach_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"
#include "stage/cast/stage_internal.h"

#define SKIP_TICKS 24000u /* longer than half a second unseen: nothing to go on from */

/* A point of the world in model space. */
static void to_model(const noh_modifier_work *w, const float point[3], float out[3])
{
    float back[4];
    for (int i = 0; i < 3; i++) out[i] = (float)((double)point[i] - w->home[i]) - w->near_place[i];
    noh_quat_conjugate(w->place.rotation, back);
    noh_quat_rotate(back, out, out);
    for (int i = 0; i < 3; i++) out[i] /= w->place.scale;
}

static float seconds_of(const noh_modifier_work *w)
{
    return (float)w->ticks / (float)NOH_TICKS_PER_SECOND;
}

/* ---- gazes ---- */

static void look(noh_modifier_work *w)
{
    const noh_gaze_rig *rig = w->user;
    const noh_stage_kind *k = w->kind;
    noh_gaze *g = w->state;
    float target[3];
    if (k->modules[NOH_SLOT_FACE].type || rig->last >= w->joint_count) return;
    to_model(w, g->point, target);
    noh_gaze_step(g, rig, w->skeleton, w->local, g->looks ? target : NULL, seconds_of(w),
                  w->cut || w->ticks > SKIP_TICKS);
}

static const char *check_gaze(const void *user, const void *state)
{
    (void)user;
    return noh_gaze_check(state);
}

static void shift_gaze(const void *user, void *state, const float by[3])
{
    float *point = ((noh_gaze *)state)->point;
    (void)user;
    noh_sub3(point, by, point);
}

noh_modifier noh_gaze_modifier(const noh_gaze_rig *rig)
{
    NOH_ASSERT(rig);
    return (noh_modifier){ .name = "gaze",
                           .modify = look,
                           .check = check_gaze,
                           .shift = shift_gaze,
                           .user = rig,
                           .state_bytes = sizeof(noh_gaze) };
}

/* ---- hands ---- */

static void reach_out(noh_modifier_work *w)
{
    const noh_reach_rig *rig = w->user;
    noh_reach *r = w->state;
    float points[NOH_REACH_ARMS_MAX][3];
    if (rig->last >= w->joint_count) return;
    for (uint32_t i = 0; i < NOH_REACH_ARMS_MAX; i++) to_model(w, r->hands[i].point, points[i]);
    noh_reach_step(r, rig, w->skeleton, w->local, points, seconds_of(w), w->cut || w->ticks > SKIP_TICKS);
}

static const char *check_reach(const void *user, const void *state)
{
    (void)user;
    return noh_reach_check(state);
}

static void shift_reach(const void *user, void *state, const float by[3])
{
    noh_reach_hand *hands = ((noh_reach *)state)->hands;
    (void)user;
    for (uint32_t i = 0; i < NOH_REACH_ARMS_MAX; i++) noh_sub3(hands[i].point, by, hands[i].point);
}

noh_modifier noh_reach_modifier(const noh_reach_rig *rig)
{
    NOH_ASSERT(rig);
    return (noh_modifier){ .name = "hands",
                           .modify = reach_out,
                           .check = check_reach,
                           .shift = shift_reach,
                           .user = rig,
                           .state_bytes = sizeof(noh_reach) };
}
