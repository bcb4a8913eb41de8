/* stage_step.c: time moves on for all actors: clocks, fades, callback keys, root motion. */
#include <string.h>

#include "core/base/assert.h"
#include "motion/anim/controller_pose.h"
#include "motion/anim/tracks.h"
#include "motion/graph/graph.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "motion/anim/root_internal.h"
#include "stage/cast/stage_internal.h"

/* ---- callback keys ---- */

typedef struct stepper {
    noh_stage *s;
    noh_stage_kind *k;
    noh_stage_actor *a;
    int64_t before; /* the controller's clock, and the stage's, at the start of the step */
    noh_stage_playing playing;
    int64_t graph_behind; /* the clock of the actor's controller less that of its graph's */
} stepper;

static uint32_t layer_of(const noh_stage_kind *k, uint32_t track)
{
    uint32_t i = 0;
    while (i + 1u < k->layer_count && track - k->layers[i].first_track >= k->layers[i].track_count) i++;
    return i;
}

static void describe(const stepper *t, const noh_event *from, noh_stage_event *out)
{
    noh_pack_clip clip;
    memset(out, 0, sizeof *out);
    out->actor = noh_stage_actor_at(t->s, (uint32_t)(t->a - t->s->actors));
    out->layer = layer_of(t->k, from->track);
    out->clip = from->clip;
    out->name = "";
    if (t->k->bank && noh_stage_pack_clip(t->k, from->clip, &clip) == NOH_OK &&
        from->index < clip.header->event_count) {
        out->name = noh_pack_string(t->k->desc->clip_packs ? t->k->desc->clip_packs[t->k->bank->packs[from->clip]]
                                                           : t->k->desc->clips,
                                    clip.events[from->index].name);
    }
    out->name_hash = from->key->name_hash;
    out->index = from->index;
    out->clock = t->s->head->clock + (from->clock - t->before);
    out->weight = from->weight;
    out->backward = from->backward != 0;
    memcpy(out->payload, from->key->payload, sizeof out->payload);
}

static void on_event(void *user, const noh_event *event)
{
    const stepper *t = user;
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

static void drive(noh_stage_actor *a, const noh_root_pose *moved, uint32_t up)
{
    double position[3], rotation[4];
    for (int i = 0; i < 3; i++) position[i] = (double)a->place.position[i] + (double)a->rest[i];
    for (int i = 0; i < 4; i++) rotation[i] = (double)a->place.rotation[i] + (double)a->rotation_rest[i];
    noh_root_drive(up, moved, (double)a->place.scale, position, rotation);
    for (int i = 0; i < 3; i++) noh_split(position[i], &a->place.position[i], &a->rest[i]);
    for (int i = 0; i < 4; i++) noh_split(rotation[i], &a->place.rotation[i], &a->rotation_rest[i]);
}

/* What the clips of an actor have moved it by, those of its graph as far as that plays. */
static void move_root(noh_stage_kind *k, uint32_t index, noh_stage_actor *a)
{
    const noh_stage_playing p = noh_stage_playing_of(k, index);
    noh_controller *c = noh_character_controller(noh_stage_character(k, index));
    noh_given_root given;
    if (p.graph) {
        given.first_clip = noh_stage_clip_count(k);
        given.moved = noh_graph_root_motion(p.state, &p.graph->graph, &p.graph->clips);
    }
    a->moved = noh_controller_root_motion_given(c, &k->set, p.graph ? &given : NULL);
    if (!k->desc->root_told && !a->parent && !(k->ragdoll && noh_stage_is_carried(noh_stage_body_of(k, index))))
        drive(a, &a->moved, k->desc->root_up);
}

/* ---- graphs ---- */

/* A key of the graph's clips, weighed by the track that stands for the graph. */
static void on_graph_event(void *user, const noh_event *event)
{
    stepper *t = user;
    const noh_controller *c = noh_character_controller(noh_stage_character(t->k, noh_stage_index(t->k, t->a)));
    noh_event told = *event;
    told.weight *= t->playing.track->weight;
    told.track = (uint32_t)(t->playing.track - noh_controller_track(c, 0));
    told.clock += t->graph_behind;
    if (told.weight < event->key->weight_min) {
        return;
    }
    t->s->callback_of_graph = 1;
    on_event(t, &told);
    t->s->callback_of_graph = 0;
}

/* Ticks until the next key of any track, at most `ticks`. */
static uint32_t until_key(const noh_controller *c, const noh_clip_set *set, uint32_t ticks)
{
    for (uint32_t i = 0; i < c->track_count; i++) {
        const int64_t next = noh_track_next_event(noh_controller_track(c, i), set, ticks);
        if (next > 0 && next < (int64_t)ticks) ticks = (uint32_t)next;
    }
    return ticks;
}

/* Transitions of this step. One that is taken shows at once, however seldom the actor is posed. */
static void decide(noh_character *ch, const noh_stage_playing *p, uint32_t ticks)
{
    uint32_t before = 0, after = 0;
    for (uint32_t i = 0; i < p->graph->graph.machine_count; i++) {
        before = before * 31u + noh_graph_machine_state(p->state, i);
    }
    noh_graph_decide(p->state, &p->graph->graph, &p->graph->clips, ticks);
    for (uint32_t i = 0; i < p->graph->graph.machine_count; i++) {
        after = after * 31u + noh_graph_machine_state(p->state, i);
    }
    if (before != after) noh_character_wake(ch);
}

/* Clips and graph move on from key to key, so that all keys come in the order of time, and what a callback changes
 * holds from that tick on for both. */
static void step_both(stepper *t, noh_character *ch, uint32_t ticks)
{
    const uint32_t index = noh_stage_index(t->k, t->a);
    const noh_controller *c = noh_character_controller(ch);
    t->playing = noh_stage_playing_of(t->k, index);
    if (t->playing.graph) decide(ch, &t->playing, ticks);
    while (ticks) {
        uint32_t next = ticks;
        t->s->graph_begun = 0;
        if (t->playing.graph) {
            next = until_key(c, &t->k->set, ticks);
            next = until_key(noh_graph_controller(t->playing.state), &t->playing.graph->clips, next);
        }
        (void)noh_character_step(ch, &t->k->set, next, on_event, t);
        t->playing = noh_stage_playing_of(t->k, index);
        if (t->playing.graph && !t->s->graph_begun) {
            noh_controller *inner = noh_graph_controller(t->playing.state);
            t->graph_behind = c->clock - next - inner->clock;
            (void)noh_controller_step(inner, &t->playing.graph->clips, next, on_graph_event, t);
            t->playing = noh_stage_playing_of(t->k, index);
        }
        ticks -= next;
    }
}

/* ---- a step ---- */

static void step_actor(noh_stage *s, noh_stage_kind *k, uint32_t index, uint32_t ticks)
{
    noh_character *ch = noh_stage_character(k, index);
    stepper t;
    memset(&t, 0, sizeof t);
    t.s = s;
    t.k = k;
    t.a = &k->actors[index];
    t.before = noh_character_controller(ch)->clock;
    if (!t.a->on_its_way) noh_stage_keep_before(t.a);
    t.a->on_its_way = 1; /* places that callbacks set belong to this step */
    if (k->graph_count) {
        step_both(&t, ch, ticks);
    } else {
        (void)noh_character_step(ch, &k->set, ticks, on_event, &t);
    }
    if (k->set.roots) move_root(k, index, t.a);
    t.a->on_its_way = 0;
}

noh_result noh_stage_step(noh_stage *stage, uint32_t ticks, noh_stage_event_fn on_key, void *user, noh_error *error)
{
    NOH_ASSERT(stage);
    if (stage->phase != NOH_STAGE_IDLE) {
        return noh_fail(error, NOH_ERR_ARG, "a stage is stepped outside of steps and frames", 0, 0);
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
        if (k->ragdoll) noh_stage_step_ragdolls(k, ticks);
    }
    stage->head->clock += ticks;
    stage->head->step_ticks = ticks;
    stage->phase = NOH_STAGE_IDLE;
    if (stage->stats.events > stage->stats.events_high) stage->stats.events_high = stage->stats.events;
    return NOH_OK;
}
