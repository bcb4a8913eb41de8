/* walkers_feet.c: feet on the ground for the nearest walkers. */
#include "core/base/assert_internal.h"
#include "life/reach/feet_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/actors/walkers_internal.h"

#define SKIP_TICKS 24000u /* unseen for longer than this: its feet start afresh */
#define FADE_PER_S 4.0f
#define KEPT (1u + 3u * NOH_FEET_LEGS_MAX)
#define BONUS 0.81f /* factor on the squared distance of a chosen walker */

/* State of the modifier. */
typedef struct near_feet {
    noh_feet feet;
    float part; /* 0..1: how far its feet are put on the ground */
    uint32_t is_near;
    uint32_t runs, unused;
} near_feet;

/* ---- the modifier ---- */

static uint32_t joints_of(const noh_feet_rig *rig, uint32_t joints[KEPT])
{
    uint32_t count = 0;
    joints[count++] = rig->top;
    for (uint32_t l = 0; l < rig->leg_count; l++) {
        joints[count++] = rig->legs[l].thigh;
        joints[count++] = rig->legs[l].shin;
        joints[count++] = rig->legs[l].foot;
    }
    return count;
}

static void mix(noh_transform *to, const noh_transform *from, float part)
{
    for (int i = 0; i < 3; i++)
        to->translation[i] = from->translation[i] + part * (to->translation[i] - from->translation[i]);
    noh_quat_nlerp(from->rotation, to->rotation, part, to->rotation);
}

static void put_on_ground(noh_modifier_work *w, const noh_kind_feet *f, near_feet *n, float seconds)
{
    noh_transform before[KEPT];
    uint32_t joints[KEPT];
    const uint32_t count = joints_of(&f->rig, joints);
    for (uint32_t i = 0; i < count; i++) before[i] = w->local[joints[i]];
    noh_modifier_feet(w, &n->feet, f, seconds, w->cut || !n->runs || w->ticks > SKIP_TICKS);
    n->runs = 1;
    for (uint32_t i = 0; i < count && n->part < 1.0f; i++) mix(&w->local[joints[i]], &before[i], n->part);
}

static void modify(noh_modifier_work *w)
{
    const noh_kind_feet *f = w->user;
    near_feet *n = w->state;
    const float seconds = (float)w->ticks * (1.0f / (float)NOH_TICKS_PER_SECOND);
    const float by = w->cut ? 1.0f : FADE_PER_S * seconds;
    n->part += n->is_near ? by : -by;
    n->part = n->part > 1.0f ? 1.0f : n->part;
    if (!(n->part > 0.0f) || f->rig.last >= w->joint_count || !(f->ground.world || f->ground.below)) {
        n->part = 0.0f;
        n->runs = 0;
        return;
    }
    put_on_ground(w, f, n, seconds);
}

static const char *check(const void *user, const void *state)
{
    const near_feet *n = state;
    (void)user;
    if (!(n->part >= 0.0f && n->part <= 1.0f)) return "state: the weight of a walker's feet is not in 0..1";
    return noh_feet_check(&n->feet);
}

static const char *refuse(const void *user, uint32_t job_count)
{
    return noh_modifier_feet_refuse(user, job_count);
}

noh_modifier noh_walkers_feet_modifier(const noh_kind_feet *feet)
{
    NOH_ASSERT(feet);
    return (noh_modifier){
        .name = "feet of near walkers",
        .modify = modify,
        .check = check,
        .user = feet,
        .state_bytes = sizeof(near_feet),
        .refuse = refuse,
    };
}

const noh_feet_rig *noh_walkers_rig(const noh_modifier *part)
{
    return part->modify == modify ? &((const noh_kind_feet *)part->user)->rig : NULL;
}

void noh_walkers_tell_leg(const noh_walkers *w, noh_stage *stage, const walker *r)
{
    near_feet *n = r->is_near && w->leg_count
                       ? noh_actor_modifier(stage, (noh_actor){ r->actor }, w->feet_modifier - 1u)
                       : NULL;
    if (n) n->feet.kept = 1u + r->stands / WALKER_PARTS;
}

/* ---- the nearest walkers ---- */

/* Insert into the list of the nearest, by distance; at equal distance the first stays first. */
static void take(noh_walkers *w, uint32_t index, float square)
{
    walker_near *near = noh_walkers_nearest(w);
    uint32_t at = w->near_count;
    if (at == w->near_max && !(square < near[at - 1u].square)) return;
    if (at < w->near_max)
        w->near_count++;
    else
        at--;
    for (; at > 0 && square < near[at - 1u].square; at--) near[at] = near[at - 1u];
    near[at].square = square;
    near[at].index = index;
}

static void set_near(noh_walkers *w, noh_stage *stage, uint32_t index, uint8_t is_near)
{
    walker *r = noh_walker_at(w, index);
    near_feet *n = noh_actor_modifier(stage, (noh_actor){ r->actor }, w->feet_modifier - 1u);
    r->is_near = is_near;
    if (n) n->is_near = is_near;
}

/* World x, z of the actor, which moves with the origin of the stage. Returns 0 if the actor is gone. */
static int agent_of(const noh_stage *stage, const walker *r, float at[2])
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, (noh_actor){ r->actor }, &k);
    for (int i = 0; i < 2 && a; i++) {
        const double off = (double)r->at[i] - (double)r->body[i];
        at[i] = (float)((double)a->place.position[2 * i] + (double)a->rest[2 * i] + off);
    }
    return a != NULL;
}

uint32_t noh_walkers_near(noh_walkers *walkers, noh_stage *stage, const float eye[3])
{
    NOH_ASSERT(walkers && stage && eye);
    if (!walkers->near_max || stage->phase != NOH_STAGE_IDLE) return walkers->near_count;
    walkers->near_count = 0;
    for (uint32_t i = 0; i < walkers->walker_max; i++) {
        const walker *r = noh_walker_at(walkers, i);
        float at[2];
        if (!r->actor || !r->begun || !agent_of(stage, r, at)) continue;
        const float x = at[0] - eye[0], y = r->height - eye[1], z = at[1] - eye[2];
        take(walkers, i, (x * x + y * y + z * z) * (r->is_near ? BONUS : 1.0f));
    }
    for (uint32_t i = 0; i < walkers->walker_max; i++) {
        if (noh_walker_at(walkers, i)->is_near) noh_walker_at(walkers, i)->is_near = 2u; /* until it is chosen again */
    }
    for (uint32_t i = 0; i < walkers->near_count; i++) {
        walker *r = noh_walker_at(walkers, noh_walkers_nearest(walkers)[i].index);
        if (r->is_near)
            r->is_near = 1u;
        else
            set_near(walkers, stage, noh_walkers_nearest(walkers)[i].index, 1u);
    }
    for (uint32_t i = 0; i < walkers->walker_max; i++) {
        if (noh_walker_at(walkers, i)->is_near == 2u) set_near(walkers, stage, i, 0u);
    }
    return walkers->near_count;
}
