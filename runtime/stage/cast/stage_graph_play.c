/* stage_graph_play.c: the graph of an actor: what plays, its pose beside those of clips, its parameters and states. */
#include <string.h>

#include "motion/graph/graph.h"
#include "stage/character/character.h"
#include "stage/character/time_lod.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"

/* ---- what plays ---- */

static noh_stage_graph_slot *slot_of(const noh_stage_kind *k, uint32_t index)
{
    return (noh_stage_graph_slot *)(void *)(k->graph_slots + (size_t)index * k->slot_bytes);
}

noh_stage_playing noh_stage_playing_of(const noh_stage_kind *k, uint32_t index)
{
    noh_stage_playing none = { NULL, NULL, NULL }, found = none;
    noh_stage_graph_slot *slot;
    const noh_controller *c;
    if (!k->graph_count || !slot_of(k, index)->graph) {
        return none;
    }
    slot = slot_of(k, index);
    c = noh_character_controller(noh_stage_character(k, index));
    found.graph = k->graphs[slot->graph - 1u];
    found.state = (noh_graph_state *)(void *)(slot + 1);
    for (uint32_t i = 0; i < c->track_count; i++) {
        found.track = noh_controller_track(c, i);
        if (found.track->mode != NOH_TRACK_OFF && found.track->clip == noh_stage_clip_count(k) + slot->graph - 1u) {
            return found;
        }
    }
    return none;
}

void noh_stage_begin_graph(noh_stage_kind *k, uint32_t index, uint32_t graph)
{
    noh_stage_graph_slot *slot = slot_of(k, index);
    const noh_graph_pack *g = k->graphs[graph];
    noh_graph_state *made;
    memset(slot, 0, k->slot_bytes);
    if (noh_graph_state_init(slot + 1, k->slot_bytes - sizeof *slot, &g->graph, &g->clips, &made, NULL) == NOH_OK) {
        slot->graph = graph + 1u; /* always: the graph was checked, and the slot measured, when the stage was made */
    }
}

/* ---- its pose ---- */

/* Clips that stand for graphs have the pose that was made for the actor; where none was made, the bind pose. */
static void sample_with_graphs(void *user, uint32_t clip, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose,
                               uint32_t float_count, float *floats)
{
    const noh_stage_sampler *s = user;
    const int other = s->poses[1] && clip_tick != s->tick;
    if (clip < s->first_graph_clip) {
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
    memset(sampler, 0, sizeof *sampler);
    sampler->sample = set->sample;
    sampler->user = set->user;
    sampler->first_graph_clip = noh_stage_clip_count(k);
    sampler->bind_pose = set->bind_pose;
    sampler->float_defaults = set->float_defaults;
    set->sample = sample_with_graphs;
    set->user = sampler;
}

/* A job's scratch, as noh_stage_measure_graphs counts it. */
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
    noh_arena arena = noh_arena_over(job->graph_scratch, s->graph_scratch_bytes);
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

static void follow_lod(noh_graph_state *state, const noh_controller *c)
{
    (void)noh_controller_set_lod(noh_graph_controller(state), c->lod,
                                 c->lod_joint_count < c->joint_count ? c->lod_joint_count : 0);
}

void noh_stage_pose_graph(const noh_stage *s, const noh_stage_job_part *job, noh_stage_kind *k, uint32_t index,
                          int64_t ahead, int64_t ago, noh_stage_sampler *sampler)
{
    const noh_stage_playing p = noh_stage_playing_of(k, index);
    noh_graph_state *state = p.state;
    work w;
    sampler->poses[0] = sampler->poses[1] = NULL;
    if (!p.graph || open_work(s, job, &p, sampler, &w) != NOH_OK) {
        return;
    }
    follow_lod(p.state, noh_character_controller(noh_stage_character(k, index)));
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

/* ---- detail ---- */

noh_due noh_stage_look_graph(noh_stage_kind *k, uint32_t index, const noh_lod_settings *settings,
                             float pixels_per_metre)
{
    const noh_stage_playing p = noh_stage_playing_of(k, index);
    noh_character *ch = noh_stage_character(k, index);
    float error_m[NOH_UPDATE_RATE_COUNT], of_graph[NOH_UPDATE_RATE_COUNT];
    if (!p.graph || !k->table.update_error_m) {
        return noh_character_look(ch, &k->table, settings, pixels_per_metre);
    }
    noh_time_lod_error(noh_character_controller(ch), k->table.update_error_m, error_m);
    noh_time_lod_error(noh_graph_controller(p.state), k->table.update_error_m, of_graph);
    for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
        error_m[r] = of_graph[r] > error_m[r] ? of_graph[r] : error_m[r];
    }
    return noh_character_look_given(ch, &k->table, settings, pixels_per_metre, error_m);
}

void noh_stage_follow_lod(const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_playing p = noh_stage_playing_of(k, index);
    if (p.graph) follow_lod(p.state, noh_character_controller(noh_stage_character(k, index)));
}

uint32_t noh_stage_graph_work(const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_playing p = noh_stage_playing_of(k, index);
    const noh_controller *c;
    uint32_t tracks = 0;
    if (!p.graph) {
        return 0;
    }
    c = noh_graph_controller(p.state);
    for (uint32_t i = 0; i < c->track_count; i++) tracks += noh_controller_track(c, i)->mode == NOH_TRACK_ON;
    return tracks * c->lod_joint_count;
}

/* ---- a state from outside ---- */

noh_result noh_stage_check_graph(const noh_stage_kind *k, const void *memory, noh_error *error)
{
    const noh_stage_graph_slot *slot = memory;
    const noh_graph_pack *g;
    if (!k->graph_count || !slot->graph) {
        return NOH_OK;
    }
    if (slot->graph > k->graph_count) {
        return noh_fail(error, NOH_ERR_DATA, "state: an actor plays a graph that its kind has not", slot->graph,
                        k->graph_count);
    }
    g = k->graphs[slot->graph - 1u];
    return noh_graph_state_check(slot + 1, k->slot_bytes - sizeof *slot, &g->graph, &g->clips, error);
}

/* ---- parameters and states ---- */

/* What an index of a kind's parameters or machines is in the graph that plays: its own, or the one of that name. */
static uint32_t local_index(const noh_stage_kind *k, noh_name what, const noh_stage_playing *p, uint32_t index)
{
    const noh_graph_pack *of;
    uint32_t graph;
    if (!p->graph || !noh_stage_in_graph(k, what, &index, &graph)) {
        return NOH_NONE;
    }
    of = k->graphs[graph];
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
