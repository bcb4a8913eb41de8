/* stage_feet.c: feet on the ground as a modifier of a kind. */
#include "life/physics/world_ask_internal.h"
#include "life/reach/feet_internal.h"
#include "life/reach/rig_internal.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_life.h"
#include "noh/modules.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "stage/cast/stage_internal.h"

#define STANDS_SPEED 0.5f /* in leg lengths a second: an ankle of a standing foot is slower */
#define SKIP_TICKS 24000u /* longer than half a second unseen: nothing to go on from */

/* The ground as it is seen from an actor's home. */
typedef struct home_ground {
    const noh_ground *ground;
    const double *home;
} home_ground;

static float below_home(const void *user, const float from[3], float depth, float normal[3])
{
    const home_ground *g = user;
    float at[3];
    for (int i = 0; i < 3; i++) at[i] = (float)((double)from[i] + g->home[i]);
    return noh_ground_below(g->ground, at, depth, normal);
}

static float side_of(const noh_modifier_work *w, uint32_t joint)
{
    float at[3], unused[4];
    noh_rig_joint(w->skeleton, w->skeleton->bind_pose, joint, at, unused);
    return at[0];
}

/* The legs that stand in the clip that plays, where the kind knows: with motion matching. */
static uint32_t standing_legs(const noh_modifier_work *w, const noh_feet_rig *rig)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(w->stage, w->actor, &k);
    const noh_module_type *match = a ? k->modules[NOH_SLOT_MATCH].type : NULL;
    if (!match || rig->leg_count != 2u) return 0;
    const uint32_t bits = match->stands(w->stage, k, noh_stage_index(k, a), STANDS_SPEED * rig->length);
    return side_of(w, rig->legs[0].foot) > side_of(w, rig->legs[1].foot) ? bits : bits >> 1 | (bits & 1u) << 1;
}

const char *noh_modifier_feet_refuse(const void *user, uint32_t job_count)
{
    const noh_kind_feet *f = user;
    return noh_world_may_ask(f->ground.world, job_count)
               ? NULL
               : "feet of a kind: the physics of their world answers one thread, and "
                 "the stage has several jobs: set its `threads`, or job_count to 1";
}

void noh_modifier_feet(noh_modifier_work *w, noh_feet *feet, const noh_kind_feet *f, float seconds, int cut)
{
    const home_ground from = { &f->ground, w->home };
    const noh_ground near_ground = { NULL, below_home, &from };
    const int is_home = w->home[0] == 0.0 && w->home[1] == 0.0 && w->home[2] == 0.0;
    noh_feet_place place;
    if (noh_modifier_home_moved(w)) noh_feet_shift(feet, w->home_moved);
    if (!noh_world_may_ask(f->ground.world, w->stage->desc.job_count)) return; /* a world that was set after init */
    memcpy(place.position, w->near_place, sizeof place.position);
    memcpy(place.rotation, w->place.rotation, sizeof place.rotation);
    place.scale = w->place.scale;
    place.stands = standing_legs(w, &f->rig);
    noh_feet_step(feet, &f->rig, w->skeleton, w->local, &place, is_home ? &f->ground : &near_ground, seconds, cut);
}

static void put_on_ground(noh_modifier_work *w)
{
    const noh_kind_feet *f = w->user;
    if (f->rig.last >= w->joint_count || !(f->ground.world || f->ground.below)) {
        if (noh_modifier_home_moved(w)) noh_feet_shift(w->state, w->home_moved);
        return;
    }
    noh_modifier_feet(w, w->state, f, (float)w->ticks / (float)NOH_TICKS_PER_SECOND, w->cut || w->ticks > SKIP_TICKS);
}

static const char *check(const void *user, const void *state)
{
    (void)user;
    return noh_feet_check(state);
}

noh_modifier noh_feet_modifier(const noh_kind_feet *feet)
{
    NOH_ASSERT(feet);
    return (noh_modifier){
        .name = "feet",
        .modify = put_on_ground,
        .check = check,
        .user = feet,
        .state_bytes = sizeof(noh_feet),
        .refuse = noh_modifier_feet_refuse,
    };
}
