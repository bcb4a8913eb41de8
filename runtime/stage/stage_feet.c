/* stage_feet.c: feet on the ground as a part of a kind. */
#include "stage/stage_feet.h"

#include <string.h>

#include "base/assert.h"

#define SKIP_TICKS 24000u /* longer than half a second unseen: nothing to go on from */

static void put_on_ground(noh_part_work *w)
{
    const noh_kind_feet *f = w->user;
    noh_feet_place place;
    if (f->rig.last >= w->joint_count || !(f->ground.world || f->ground.below)) {
        return;
    }
    memcpy(place.position, w->place.position, sizeof place.position);
    memcpy(place.rotation, w->place.rotation, sizeof place.rotation);
    place.scale = w->place.scale;
    noh_feet_step(w->state, &f->rig, w->skeleton, w->local, &place, &f->ground,
                  (float)w->ticks / (float)NOH_TICKS_PER_SECOND, w->cut || w->ticks > SKIP_TICKS);
}

static const char *check(const void *user, const void *state)
{
    (void)user;
    return noh_feet_check(state);
}

noh_stage_part noh_stage_feet_part(const noh_kind_feet *feet)
{
    noh_stage_part part;
    NOH_ASSERT(feet);
    memset(&part, 0, sizeof part);
    part.name = "feet";
    part.modify = put_on_ground;
    part.check = check;
    part.user = feet;
    part.state_bytes = sizeof(noh_feet);
    return part;
}
