/* stage_feet.c: feet on the ground as a modifier of a kind. */
#include "life/reach/feet_internal.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_life.h"
#include "noh/modules.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "stage/cast/stage_internal.h"

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

void noh_modifier_feet(noh_modifier_work *w, noh_feet *feet, const noh_kind_feet *f, float seconds, int cut)
{
    const home_ground from = { &f->ground, w->home };
    const noh_ground near_ground = { NULL, below_home, &from };
    const int is_home = w->home[0] == 0.0 && w->home[1] == 0.0 && w->home[2] == 0.0;
    noh_feet_place place;
    if (noh_modifier_home_moved(w)) noh_feet_shift(feet, w->home_moved);
    memcpy(place.position, w->near_place, sizeof place.position);
    memcpy(place.rotation, w->place.rotation, sizeof place.rotation);
    place.scale = w->place.scale;
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
    noh_modifier part;
    NOH_ASSERT(feet);
    memset(&part, 0, sizeof part);
    part.name = "feet";
    part.modify = put_on_ground;
    part.check = check;
    part.user = feet;
    part.state_bytes = sizeof(noh_feet);
    return part;
}
