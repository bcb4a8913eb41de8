/* view_play.c: playback: which clips play on which layers, at which time, and the callback keys they fire. */
#include <string.h>

#include "view/view_model.h"
#include "cli/message.h"

const char *const view_layer_names[VIEW_LAYERS] = { "body", "part", "face", "add" };

noh_controller *view_controller(const view_model *m, uint32_t kind, const noh_clip_set **set)
{
    return noh_actor_controller(m->figure->stage, m->figure->actors[kind], set);
}

uint32_t view_layer_of(uint32_t track)
{
    const uint32_t body = VIEW_BODY_TRACKS;
    return track < body ? VIEW_BODY : VIEW_PART + (track - body) / VIEW_OTHER_TRACKS;
}

int view_clip_of(const view_model *m, uint32_t kind, const noh_track *track)
{
    return noh_stage_name(m->figure->stage, kind, NOH_NAME_CLIP, track->clip) != NULL;
}

const char *view_clip_name(const view_model *m, uint32_t kind, uint32_t clip)
{
    const char *name = noh_stage_name(m->figure->stage, kind, NOH_NAME_CLIP, clip);
    return name ? name : "graph"; /* indices past the packs' clips stand for graphs */
}

static uint32_t kind_count(const view_model *m)
{
    return m->figure->stage_desc.kind_count;
}

/* ---- start and stop ---- */

static uint32_t fade_ticks(float seconds)
{
    const int64_t ticks = noh_ticks_from_seconds((double)seconds);
    return ticks > 1 ? (uint32_t)ticks : 1u;
}

static noh_play play_of(const view_how *how, int beside)
{
    noh_play play;
    memset(&play, 0, sizeof play);
    play.fade_ticks = fade_ticks(how->fade_s);
    play.weight = how->weight;
    play.speed = (int32_t)(how->speed * NOH_SPEED_ONE);
    play.loop = how->loop;
    play.sync_group = how->sync_group;
    play.flags = beside ? NOH_PLAY_BESIDE : how->inertia ? NOH_PLAY_INERTIA : 0;
    return play;
}

static int start_on(view_model *m, uint32_t kind, uint32_t clip, const view_how *how, int beside)
{
    const view_clip *c = &m->clips[clip];
    const noh_play play = play_of(how, beside);
    noh_error error = { NOH_OK, "", 0, 0 };
    const noh_clip_set *set;
    uint32_t layer = how->layer - 1u;
    (void)view_controller(m, kind, &set);
    if (!how->layer) layer = set->clips[c->clips[kind]].flags & NOH_CLIP_FLOATS_ONLY ? VIEW_FACE : VIEW_BODY;
    switch (noh_actor_play(m->figure->stage, m->figure->actors[kind], layer, c->name, &play, &error)) {
    case NOH_OK: return 0;
    case NOH_ERR_LIMIT:
        return tool_fail(m->path, "'%s' cannot play on '%s': %s", c->name, view_layer_names[layer], error.what);
    default: return tool_fail_error(m->path, &error);
    }
}

int view_start(view_model *m, uint32_t clip, const view_how *how, int beside)
{
    int status = 0;
    m->touched = 1;
    for (uint32_t k = 0; k < kind_count(m) && !status; k++) {
        if (m->clips[clip].clips[k] != NOH_NONE) status = start_on(m, k, clip, how, beside);
    }
    return status;
}

void view_stop_track(view_model *m, uint32_t kind, uint32_t track)
{
    view_set_mode(m, kind, track, NOH_TRACK_OFF);
}

void view_stop_layer(view_model *m, uint32_t layer, float fade_s)
{
    m->touched = 1;
    for (uint32_t k = 0; k < kind_count(m); k++) {
        (void)noh_actor_stop(m->figure->stage, m->figure->actors[k], layer, fade_ticks(fade_s), NULL);
    }
}

void view_stop_all(view_model *m)
{
    for (uint32_t layer = 0; layer < VIEW_LAYERS; layer++) view_stop_layer(m, layer, 0.0f);
}

int view_plays(const view_model *m)
{
    for (uint32_t k = 0; k < kind_count(m); k++) {
        const noh_controller *c = view_controller(m, k, NULL);
        for (uint32_t t = 0; t < c->track_count; t++) {
            if (noh_controller_track(c, t)->mode != NOH_TRACK_OFF) return 1;
        }
    }
    return 0;
}

/* ---- one track ---- */

void view_set_weight(view_model *m, uint32_t kind, uint32_t track, float weight)
{
    (void)noh_controller_set_weight(view_controller(m, kind, NULL), track, weight);
    m->touched = 1;
}

void view_set_speed(view_model *m, uint32_t kind, uint32_t track, float speed)
{
    (void)noh_controller_set_speed(view_controller(m, kind, NULL), track, (int32_t)(speed * NOH_SPEED_ONE));
}

void view_set_mode(view_model *m, uint32_t kind, uint32_t track, noh_track_mode mode)
{
    (void)noh_controller_set_mode(view_controller(m, kind, NULL), track, mode);
    m->touched = 1;
}

void view_seek(view_model *m, uint32_t kind, uint32_t track, double seconds)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const noh_clip_set *set;
    noh_controller *c = view_controller(m, kind, &set);
    if (noh_controller_seek(c, set, track, noh_ticks_from_seconds(seconds), NOH_SEEK_SKIP, &error)) {
        tool_fail_error(m->path, &error);
    }
    m->touched = 1;
}

void view_seek_newest(view_model *m, uint32_t kind, uint32_t layer, double seconds)
{
    const noh_controller *c = view_controller(m, kind, NULL);
    const noh_track *newest = noh_actor_track(m->figure->stage, m->figure->actors[kind], layer);
    for (uint32_t t = 0; t < c->track_count; t++) {
        if (noh_controller_track(c, t) == newest) view_seek(m, kind, t, seconds);
    }
}

double view_position(const view_model *m, uint32_t kind, uint32_t track)
{
    const noh_clip_set *set;
    const noh_track *t = noh_controller_track(view_controller(m, kind, &set), track);
    return (double)noh_track_clip_tick(t, &set->clips[t->clip], 0) / (double)NOH_TICKS_PER_SECOND;
}

int view_ramp(view_model *m, uint32_t kind, uint32_t track, noh_change_kind what, float to, float seconds)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const noh_clip_set *set;
    noh_controller *c = view_controller(m, kind, &set);
    noh_change_desc d;
    memset(&d, 0, sizeof d);
    d.kind = what;
    d.track = track;
    d.duration_ticks = fade_ticks(seconds);
    d.curve = NOH_CURVE_SMOOTHSTEP;
    d.weight = to;
    d.speed = (int32_t)(to * NOH_SPEED_ONE);
    return noh_controller_change(c, set, &d, &error) ? tool_fail_error(m->path, &error) : 0;
}

/* ---- graphs ---- */

int view_graph_play(view_model *m, uint32_t n, float fade_s)
{
    const noh_play play = { .fade_ticks = fade_ticks(fade_s) };
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_pack_graph g;
    m->touched = 1;
    return noh_pack_graph_at(&m->clips_of->pack, n, &g, &error) ||
                   noh_actor_play_graph(m->figure->stage, m->figure->actors[0], VIEW_BODY, g.name, &play, &error)
               ? tool_fail_error(m->path, &error)
               : 0;
}

uint32_t view_graph_playing(const view_model *m)
{
    const noh_graph_pack *made;
    return noh_actor_graph(m->figure->stage, m->figure->actors[0], &made)
               ? noh_pack_graph_find(&m->clips_of->pack, made->source.name)
               : NOH_NONE;
}

float view_graph_parameter(const view_model *m, uint32_t parameter)
{
    return noh_actor_parameter(m->figure->stage, m->figure->actors[0], parameter);
}

void view_graph_set(view_model *m, uint32_t parameter, float value)
{
    (void)noh_actor_set_parameter(m->figure->stage, m->figure->actors[0], parameter, value, NULL);
    m->touched = 1;
}

/* ---- time ---- */

typedef struct listener {
    const view_model *m;
    view_event_fn fn;
    void *user;
} listener;

static uint32_t kind_of(const view_model *m, noh_actor actor)
{
    uint32_t kind = 0;
    while (kind + 1u < kind_count(m) && m->figure->actors[kind].id != actor.id) kind++;
    return kind;
}

static void pass_event(void *user, noh_stage *stage, const noh_stage_event *event)
{
    const listener *l = user;
    view_passed passed;
    (void)stage;
    passed.clock_s = (double)event->clock / (double)NOH_TICKS_PER_SECOND;
    passed.layer = view_layer_names[event->layer];
    passed.clip = view_clip_name(l->m, kind_of(l->m, event->actor), event->clip);
    passed.key = event->name;
    passed.weight = event->weight;
    l->fn(l->user, &passed);
}

void view_step(view_model *m, uint32_t ticks, view_event_fn fn, void *user)
{
    listener l = { m, fn, user };
    (void)noh_stage_step(m->figure->stage, ticks, pass_event, &l, NULL);
    m->touched = 0;
}
