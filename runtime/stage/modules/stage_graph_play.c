/* stage_graph_play.c: the graph of an actor: playing it next to clips, its parameters and states. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "motion/anim/controller_pose_internal.h"
#include "motion/anim/tracks_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "stage/modules/stage_graph_internal.h"
#include "motion/graph/graph_pack_internal.h"

/* ---- what plays ---- */

static noh_stage_graph_slot *slot_of(const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_module *m = &k->modules[NOH_SLOT_SOURCE];
    return (noh_stage_graph_slot *)(void *)(m->states + index * m->stride);
}

noh_stage_playing noh_stage_playing_of(const noh_stage_kind *k, uint32_t index)
{
    noh_stage_playing none = { NULL, NULL, NULL }, found = none;
    noh_stage_graph_slot *slot;
    const noh_controller *c;
    if (!noh_stage_graphs_of(k) || !slot_of(k, index)->graph) {
        return none;
    }
    slot = slot_of(k, index);
    c = noh_character_controller(noh_stage_character(k, index));
    found.graph = noh_stage_graphs_of(k)->graphs[slot->graph - 1u];
    found.state = (noh_graph_state *)(void *)(slot + 1);
    for (uint32_t i = 0; i < c->track_count; i++) {
        found.track = noh_controller_track(c, i);
        if (found.track->mode != NOH_TRACK_OFF && found.track->clip == noh_stage_clip_count(k) + slot->graph - 1u) {
            return found;
        }
    }
    return none;
}

static size_t instance_bytes(const noh_stage_kind *k)
{
    return k->modules[NOH_SLOT_SOURCE].stride - sizeof(noh_stage_graph_slot);
}

static void begin(noh_stage_kind *k, uint32_t index, uint32_t graph)
{
    noh_stage_graph_slot *slot = slot_of(k, index);
    const noh_graph_pack *g = noh_stage_graphs_of(k)->graphs[graph];
    noh_graph_state *made;
    memset(slot, 0, k->modules[NOH_SLOT_SOURCE].stride);
    if (noh_graph_state_init(slot + 1, instance_bytes(k), &g->graph, &g->clips, &made, NULL) == NOH_OK) {
        slot->graph = graph + 1u; /* always: the graph was checked, and the slot measured, when the stage was made */
    }
}

static noh_controller *controller(const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_playing p = noh_stage_playing_of(k, index);
    return p.graph ? noh_graph_controller(p.state) : NULL;
}

static int root(const noh_stage_kind *k, uint32_t index, noh_given_root *given)
{
    const noh_stage_playing p = noh_stage_playing_of(k, index);
    if (!p.graph) return 0;
    given->first_clip = noh_stage_clip_count(k);
    given->moved = noh_graph_root_motion(p.state, &p.graph->graph, &p.graph->clips);
    return 1;
}

static const char *bad_play(const noh_stage_player *p, const noh_play *play)
{
    if (p->layer->mode == NOH_LAYER_ADD)
        return "cannot play a graph on a layer of NOH_LAYER_ADD: use a base or an over layer";
    if (play->speed || play->start_ticks || play->loop || play->sync_group || play->reference)
        return "speed, start_ticks, loop, sync_group and reference must be 0 in the play of a graph";
    if (play->flags & ~(NOH_PLAY_KEEP | NOH_PLAY_INERTIA))
        return "flags of a graph's play: only KEEP and INERTIA are allowed";
    return p->s->callback_of_source ? "cannot play a graph in the callback of a graph's key: set a parameter, or play "
                                      "after the step"
                                    : NULL;
}

noh_result noh_actor_play_graph(noh_stage *stage, noh_actor actor, uint32_t layer, const char *graph,
                                const noh_play *play, noh_error *error)
{
    static const noh_play plain;
    const noh_play *how = play ? play : &plain;
    const char *what;
    uint32_t index;
    noh_stage_player p;
    const noh_result result = noh_stage_open_player(stage, actor, layer, &p, error);
    NOH_ASSERT(graph);
    if (result != NOH_OK) {
        return result;
    }
    index = noh_stage_find(stage, (uint32_t)(p.k - stage->kinds), NOH_NAME_GRAPH, graph);
    if (index == NOH_NONE) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the kind has no graph of that name", (uint64_t)(p.k - stage->kinds),
                        noh_stage_graph_names(p.k, NOH_NAME_GRAPH));
    }
    what = bad_play(&p, how);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, layer, 0);
    }
    return noh_stage_play_clip(&p, noh_stage_clip_count(p.k) + index, how, error);
}

/* ---- its pose ---- */

/* Clips that stand for graphs have the pose that was made for the actor; where none was made, the bind pose. */
static void sample_with_graphs(void *user, uint32_t clip, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose,
                               uint32_t float_count, float *floats)
{
    const noh_stage_sampler *s = user;
    const int other = s->poses[1] && clip_tick != s->tick;
    if (clip < s->first_source_clip) {
        s->sample(s->user, clip, clip_tick, joint_count, pose, float_count, floats);
        return;
    }
    memcpy(pose, s->poses[0] ? s->poses[other] : s->bind_pose, joint_count * sizeof *pose);
    if (s->poses[0] && float_count) {
        memcpy(floats, s->floats[other], float_count * sizeof *floats);
    } else {
        for (uint32_t i = 0; i < float_count; i++) floats[i] = s->float_defaults ? s->float_defaults[i] : 0.0f;
    }
}

void noh_stage_wrap(const noh_stage_kind *k, noh_clip_set *set, noh_stage_sampler *sampler)
{
    if (set->sample == sample_with_graphs) { /* already: with no pose */
        *sampler = *(const noh_stage_sampler *)set->user;
        set->user = sampler;
        return;
    }
    memset(sampler, 0, sizeof *sampler);
    sampler->sample = set->sample;
    sampler->user = set->user;
    sampler->first_source_clip = noh_stage_clip_count(k);
    sampler->bind_pose = set->bind_pose;
    sampler->float_defaults = set->float_defaults;
    set->sample = sample_with_graphs;
    set->user = sampler;
}

/* A job's scratch, as stage_graph.c counts it. */
typedef struct work {
    noh_transform *poses[2];
    float *floats[2];
    noh_graph_state *ahead;
    noh_graph_scratch evaluation;
    noh_clip_set set; /* of the graph */
} work;

static noh_result open_work(const noh_stage *s, const noh_stage_job_part *job, const noh_stage_playing *p,
                            const noh_stage_sampler *sampler, work *w)
{
    noh_arena arena = noh_arena_over(job->module_scratch, s->module_scratch_bytes);
    const size_t bytes = noh_graph_scratch_size(&p->graph->graph, &p->graph->clips);
    w->set = p->graph->clips;
    w->set.sample = sampler->sample;
    w->set.user = sampler->user;
    for (int i = 0; i < 2; i++) {
        w->poses[i] = noh_arena_carve(&arena, w->set.joint_count * sizeof(noh_transform), 16);
        w->floats[i] = noh_arena_carve(&arena, w->set.float_count * sizeof(float), 16);
    }
    w->ahead = noh_arena_carve(&arena, p->state->bytes, 16);
    return noh_graph_scratch_init(noh_arena_carve(&arena, bytes, 16), bytes, &p->graph->graph, &w->set, &w->evaluation,
                                  NULL);
}

static void sample(const noh_stage *s, const noh_stage_job_part *job, const noh_stage_kind *k, uint32_t index,
                   int64_t ahead, int64_t ago, noh_clip_set *set, noh_stage_sampler *sampler)
{
    const noh_stage_playing p = noh_stage_playing_of(k, index);
    noh_graph_state *state = p.state;
    work w;
    noh_stage_wrap(k, set, sampler);
    if (!p.graph || open_work(s, job, &p, sampler, &w) != NOH_OK) {
        return;
    }
    noh_stage_follow_lod(noh_graph_controller(p.state), noh_character_controller(noh_stage_character(k, index)));
    if (ahead > 0) { /* what begins now by inertia begins now, and is played on in a copy */
        if (state->inertia_ticks) {
            noh_graph_pose(state, &p.graph->graph, &w.set, &w.evaluation, w.poses[1], w.floats[1]);
        }
        memcpy(w.ahead, state, state->bytes);
        state = w.ahead;
        (void)noh_graph_step(state, &p.graph->graph, &w.set, (uint32_t)ahead, NULL, NULL);
    }
    noh_graph_pose(state, &p.graph->graph, &w.set, &w.evaluation, w.poses[0], w.floats[0]);
    sampler->poses[0] = w.poses[0];
    sampler->floats[0] = w.floats[0];
    if (ago > 0) {
        noh_graph_pose_ago(state, &p.graph->graph, &w.set, &w.evaluation, ago, w.poses[1], w.floats[1]);
        sampler->poses[1] = w.poses[1];
        sampler->floats[1] = w.floats[1];
        sampler->tick = noh_track_clip_tick(p.track, &k->set.clips[p.track->clip], 0);
    }
}

/* ---- time ---- */

typedef struct stepper {
    noh_stage_stepper *of;
    noh_stage_playing playing;
    int64_t behind; /* the clock of the actor's controller minus the clock of its graph's */
} stepper;

/* A key of the actor's clips. */
static void on_key(void *user, const noh_event *event)
{
    const stepper *t = user;
    noh_stage_on_key(t->of, event);
}

/* A key of the graph's clips, weighed by the track that stands for the graph. */
static void on_graph_key(void *user, const noh_event *event)
{
    const stepper *t = user;
    const noh_stage_stepper *of = t->of;
    const noh_controller *c = noh_character_controller(noh_stage_character(of->k, noh_stage_index(of->k, of->a)));
    noh_event told = *event;
    told.weight *= t->playing.track->weight;
    told.track = (uint32_t)(t->playing.track - noh_controller_track(c, 0));
    told.clock += t->behind;
    if (told.weight < event->key->weight_min) {
        return;
    }
    of->s->callback_of_source = 1;
    noh_stage_on_key(t->of, &told);
    of->s->callback_of_source = 0;
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
static void step_actor(noh_stage_stepper *of, noh_character *ch, uint32_t ticks)
{
    const uint32_t index = noh_stage_index(of->k, of->a);
    const noh_controller *c = noh_character_controller(ch);
    stepper t = { of, noh_stage_playing_of(of->k, index), 0 };
    if (t.playing.graph) decide(ch, &t.playing, ticks);
    while (ticks) {
        uint32_t next = ticks;
        of->s->source_begun = 0;
        if (t.playing.graph) {
            next = until_key(c, &of->k->set, ticks);
            next = until_key(noh_graph_controller(t.playing.state), &t.playing.graph->clips, next);
        }
        (void)noh_character_step(ch, &of->k->set, next, on_key, &t);
        t.playing = noh_stage_playing_of(of->k, index);
        if (t.playing.graph && !of->s->source_begun) {
            noh_controller *inner = noh_graph_controller(t.playing.state);
            t.behind = c->clock - next - inner->clock;
            (void)noh_controller_step(inner, &t.playing.graph->clips, next, on_graph_key, &t);
            t.playing = noh_stage_playing_of(of->k, index);
        }
        ticks -= next;
    }
}

/* ---- a state from outside ---- */

noh_result noh_stage_check_graph(const noh_stage_kind *k, const void *memory, noh_error *error)
{
    const noh_stage_graphs *all = noh_stage_graphs_of(k);
    const noh_stage_graph_slot *slot = memory;
    const noh_graph_pack *g;
    if (!slot->graph) {
        return NOH_OK;
    }
    if (slot->graph > all->count) {
        return noh_fail(error, NOH_ERR_DATA, "state: an actor plays a graph that its kind does not have", slot->graph,
                        all->count);
    }
    g = all->graphs[slot->graph - 1u];
    return noh_graph_state_check(slot + 1, instance_bytes(k), &g->graph, &g->clips, error);
}

/* ---- names ---- */

static const char *name(const noh_stage_kind *k, noh_name what, uint32_t index)
{
    const noh_stage_graphs *all = noh_stage_graphs_of(k);
    uint32_t graph;
    if (what == NOH_NAME_GRAPH) return index < all->count ? all->graphs[index]->source.name : NULL;
    if (!noh_stage_in_graph(k, what, &index, &graph)) return NULL;
    return what == NOH_NAME_PARAMETER ? noh_graph_pack_param_name(all->graphs[graph], index)
                                      : noh_graph_pack_machine_name(all->graphs[graph], index);
}

static uint32_t clip_at(const noh_stage_kind *k, uint32_t number, uint32_t i)
{
    const noh_graph *g = &noh_stage_graphs_of(k)->graphs[number]->graph;
    return i < g->clip_count ? g->clips[i].clip : NOH_NONE;
}

const noh_source_type noh_stage_graph_source = {
    .begin = begin,
    .step_actor = step_actor,
    .root = root,
    .controller = controller,
    .sample = sample,
    .clip = clip_at,
    .name_count = noh_stage_graph_names,
    .name = name,
};

/* ---- parameters and states ---- */

/* What an index of a kind's parameters or machines is in the graph that plays: its own, or the one of that name. */
static uint32_t local_index(const noh_stage_kind *k, noh_name what, const noh_stage_playing *p, uint32_t index)
{
    const noh_graph_pack *of;
    uint32_t graph;
    if (!p->graph || !noh_stage_in_graph(k, what, &index, &graph)) {
        return NOH_NONE;
    }
    of = noh_stage_graphs_of(k)->graphs[graph];
    if (of == p->graph) {
        return index;
    }
    return what == NOH_NAME_PARAMETER ? noh_graph_pack_find_param(p->graph, noh_graph_pack_param_name(of, index))
                                      : noh_graph_pack_find_machine(p->graph, noh_graph_pack_machine_name(of, index));
}

noh_result noh_actor_set_parameter(noh_stage *stage, noh_actor actor, uint32_t parameter, float value, noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_playing p;
    uint32_t index;
    const noh_result result = noh_stage_change(stage, actor, &a, &k, error);
    if (result != NOH_OK) {
        return result;
    }
    p = noh_stage_playing_of(k, noh_stage_index(k, a));
    index = local_index(k, NOH_NAME_PARAMETER, &p, parameter);
    if (index == NOH_NONE) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        p.graph ? "the graph that plays has no such parameter" : "the actor plays no graph", parameter,
                        noh_stage_graph_names(k, NOH_NAME_PARAMETER));
    }
    return noh_graph_pack_set_param(p.graph, p.state, index, value) == NOH_OK
               ? NOH_OK
               : noh_fail(error, NOH_ERR_ARG, "value of a parameter is not finite", parameter, 0);
}

float noh_actor_parameter(const noh_stage *stage, noh_actor actor, uint32_t parameter)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    noh_stage_playing p;
    uint32_t index;
    if (!a) {
        return 0.0f;
    }
    p = noh_stage_playing_of(k, noh_stage_index(k, a));
    index = local_index(k, NOH_NAME_PARAMETER, &p, parameter);
    return index == NOH_NONE ? 0.0f : noh_graph_param(p.state, index);
}

const char *noh_actor_state(const noh_stage *stage, noh_actor actor, uint32_t machine)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    noh_stage_playing p;
    uint32_t index;
    if (!a) {
        return NULL;
    }
    p = noh_stage_playing_of(k, noh_stage_index(k, a));
    index = local_index(k, NOH_NAME_MACHINE, &p, machine);
    return index == NOH_NONE ? NULL
                             : noh_graph_pack_state_name(p.graph, index, noh_graph_machine_state(p.state, index));
}

noh_graph_state *noh_actor_graph(noh_stage *stage, noh_actor actor, const noh_graph_pack **graph)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    noh_stage_playing p;
    if (!a) {
        return NULL;
    }
    p = noh_stage_playing_of(k, noh_stage_index(k, a));
    if (graph && p.graph) *graph = p.graph;
    return p.state;
}
