/* stage_step.c: time moves on for all actors: clocks, fades, callback keys, root motion. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "motion/anim/controller_pose_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "motion/anim/root_internal.h"
#include "stage/cast/stage_internal.h"

/* ---- callback keys ---- */

static uint32_t layer_of(const noh_stage_kind *k, uint32_t track)
{
    uint32_t i = 0;
    while (i + 1u < k->layer_count && track - k->layers[i].first_track >= k->layers[i].track_count) i++;
    return i;
}

static const char *event_name(const noh_stage_kind *k, const noh_event *from)
{
    const noh_clip_reserve *r = k->bank ? k->bank->clips.reserve : NULL;
    noh_pack_clip clip;
    uint32_t name;
    if (from->clip >= noh_stage_clip_count(k)) return "";
    if (!NOH_PAGE && r) {
        name = r->event_names[k->bank->clips.clips[from->clip].first_event + from->index];
    } else {
        (void)noh_pack_clip_at(noh_stage_clip_pack(k, from->clip), k->bank->pack_clips[from->clip], &clip, NULL);
        name = clip.events[from->index].name;
    }
    return noh_pack_string(noh_stage_clip_pack(k, from->clip), name);
}

static void describe(const noh_stage_stepper *t, const noh_event *from, noh_stage_event *out)
{
    memset(out, 0, sizeof *out);
    out->actor = noh_stage_actor_at(t->s, (uint32_t)(t->a - t->s->actors));
    out->layer = layer_of(t->k, from->track);
    out->clip = from->clip;
    out->name = event_name(t->k, from);
    out->name_hash = from->key->name_hash;
    out->index = from->index;
    out->clock = t->s->head->clock + (from->clock - t->before);
    out->weight = from->weight;
    out->backward = from->backward != 0;
    memcpy(out->payload, from->key->payload, sizeof out->payload);
}

void noh_stage_on_key(void *user, const noh_event *event)
{
    const noh_stage_stepper *t = user;
    noh_stage *s = t->s;
    noh_stage_event told;
    describe(t, event, &told);
    s->stats.events++;
    if (s->events_held < s->desc.event_count) {
        s->events[s->events_held++] = told;
    } else {
        s->stats.events_lost++;
    }
    if (s->on_key) {
        s->callback_actor = told.actor.id;
        s->on_key(s->on_key_user, s, &told);
        s->callback_actor = 0;
    }
}

const noh_stage_event *noh_stage_events(const noh_stage *stage, uint32_t *count)
{
    NOH_ASSERT(stage && count);
    *count = stage->events_held;
    return stage->events;
}

/* ---- root motion ---- */

static void drive(noh_stage_actor *a, const noh_root_pose *moved)
{
    double position[3], rotation[4];
    for (int i = 0; i < 3; i++) position[i] = (double)a->place.position[i] + (double)a->rest[i];
    for (int i = 0; i < 4; i++) rotation[i] = (double)a->place.rotation[i] + (double)a->rotation_rest[i];
    noh_root_drive(NOH_STAGE_UP, moved, (double)a->place.scale, position, rotation);
    for (int i = 0; i < 3; i++) noh_split(position[i], &a->place.position[i], &a->rest[i]);
    for (int i = 0; i < 4; i++) noh_split(rotation[i], &a->place.rotation[i], &a->rotation_rest[i]);
    if (!NOH_PAGE) noh_stage_keep_within(&a->place, a->rest);
}

/* Apply the root motion of an actor's clips, and of its graph as far as it plays. */
static void move_root(noh_stage_kind *k, uint32_t index, noh_stage_actor *a)
{
    const noh_module_type *type = k->modules[NOH_SLOT_SOURCE].type;
    noh_controller *c = noh_character_controller(noh_stage_character(k, index));
    noh_given_root given;
    const int is_given = type && type->source->root(k, index, &given);
    a->moved = noh_controller_root_motion_given(c, &k->set, is_given ? &given : NULL);
    if (!(k->desc->root_axes & NOH_ROOT_BY_GAME) && !a->parent && !noh_stage_is_carried(k, index)) drive(a, &a->moved);
}

/* ---- a step ---- */

static void step_actor(noh_stage *s, noh_stage_kind *k, uint32_t index, uint32_t ticks)
{
    noh_character *ch = noh_stage_character(k, index);
    const noh_module_type *type = k->modules[NOH_SLOT_SOURCE].type;
    noh_stage_stepper t = { s, k, &k->actors[index], noh_character_controller(ch)->clock };
    if (!t.a->on_its_way) noh_stage_keep_before(t.a);
    t.a->on_its_way = 1; /* places that callbacks set belong to this step */
    if (type) {
        type->source->step_actor(&t, ch, ticks);
    } else {
        (void)noh_character_step(ch, &k->set, ticks, noh_stage_on_key, &t);
    }
    if (k->set.roots) move_root(k, index, t.a);
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
        const noh_module_type *module = k->modules[slot].type;
        if (module && module->steer) module->steer(s, k, index, ticks);
    }
    t.a->on_its_way = 0;
}

noh_result noh_stage_step(noh_stage *stage, uint32_t ticks, noh_stage_event_fn on_key, void *user, noh_error *error)
{
    NOH_ASSERT(stage);
    if (stage->phase != NOH_STAGE_IDLE) {
        return noh_fail(error, NOH_ERR_ARG, "cannot step the stage during a step or a frame", 0, 0);
    }
    stage->phase = NOH_STAGE_STEPPING;
    stage->on_key = on_key;
    stage->on_key_user = user;
    stage->events_held = 0;
    stage->stats.events = 0;
    for (uint32_t i = 0; i < stage->desc.kind_count; i++) {
        noh_stage_kind *k = &stage->kinds[i];
        for (uint32_t a = 0; a < k->desc->actor_count; a++) {
            if (k->actors[a].alive) step_actor(stage, k, a, ticks);
        }
        for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
            const noh_module_type *type = k->modules[slot].type;
            if (type && type->step) type->step(k, ticks);
        }
    }
    if (stage->stats.events > stage->stats.events_high) stage->stats.events_high = stage->stats.events;
    stage->head->clock += ticks;
    stage->head->step_ticks = ticks;
    stage->phase = NOH_STAGE_IDLE;
    if (!NOH_PAGE) noh_stage_use_clips(stage);
    return NOH_OK;
}
