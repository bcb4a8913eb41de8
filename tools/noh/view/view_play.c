/* view_play.c: playback: which clips play, at which time, and the callback keys they fire. */
#include <string.h>

#include "view/view_model.h"
#include "cli/message.h"

const char *view_clip_name(const view_model *m, uint32_t player, uint32_t clip)
{
    noh_pack_clip found;
    noh_pack_clip_at(&m->scene.anim->pack, m->scene.players[player].bank->pack_clips[clip], &found, NULL);
    return found.name;
}

int view_add(view_model *m, uint32_t clip)
{
    const scene_player *p = &m->scene.players[m->clips[clip].player];
    noh_controller *c = p->controllers[0];
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_track_desc desc;
    uint32_t track = 0;
    while (track < c->track_count && noh_controller_track(c, track)->mode != NOH_TRACK_OFF) {
        track++;
    }
    if (track == c->track_count) {
        return tool_fail(m->path, "all %u tracks are on: stop one to play '%s'", c->track_count, m->clips[clip].name);
    }
    memset(&desc, 0, sizeof desc);
    desc.clip = m->clips[clip].clip;
    return noh_controller_start(c, &p->bank->clips, track, &desc, &error) ? tool_fail_error(m->path, &error) : 0;
}

void view_stop(view_model *m, uint32_t player, uint32_t track)
{
    noh_controller_set_mode(m->scene.players[player].controllers[0], track, NOH_TRACK_OFF);
}

static void stop_player(view_model *m, uint32_t player)
{
    const scene_player *p = &m->scene.players[player];
    for (uint32_t t = 0; p->bank && t < p->controllers[0]->track_count; t++) {
        view_stop(m, player, t);
    }
}

void view_stop_all(view_model *m)
{
    for (uint32_t p = 0; p < m->scene.player_count; p++) {
        stop_player(m, p);
    }
}

int view_start(view_model *m, uint32_t clip)
{
    stop_player(m, m->clips[clip].player);
    return view_add(m, clip);
}

int view_plays(const view_model *m)
{
    for (uint32_t i = 0; i < m->scene.player_count; i++) {
        const scene_player *p = &m->scene.players[i];
        for (uint32_t t = 0; p->bank && t < p->controllers[0]->track_count; t++) {
            if (noh_controller_track(p->controllers[0], t)->mode != NOH_TRACK_OFF) {
                return 1;
            }
        }
    }
    return 0;
}

void view_seek(view_model *m, uint32_t player, uint32_t track, double seconds)
{
    const scene_player *p = &m->scene.players[player];
    noh_error error = { NOH_OK, "", 0, 0 };
    if (noh_controller_seek(p->controllers[0], &p->bank->clips, track, noh_ticks_from_seconds(seconds), NOH_SEEK_SKIP,
                            &error)) {
        tool_fail_error(m->path, &error);
    }
}

double view_position(const view_model *m, uint32_t player, uint32_t track)
{
    const scene_player *p = &m->scene.players[player];
    const noh_track *t = noh_controller_track(p->controllers[0], track);
    return (double)noh_track_clip_tick(t, &p->bank->clips.clips[t->clip], 0) / (double)NOH_TICKS_PER_SECOND;
}

typedef struct step {
    const view_model *m;
    uint32_t player;
    view_event_fn fn;
    void *user;
} step;

static void pass_event(void *user, const noh_event *event)
{
    const step *s = (const step *)user;
    const noh_pack *pack = &s->m->scene.anim->pack;
    noh_pack_clip clip;
    view_passed passed;
    noh_pack_clip_at(pack, s->m->scene.players[s->player].bank->pack_clips[event->clip], &clip, NULL);
    passed.clock_s = (double)event->clock / (double)NOH_TICKS_PER_SECOND;
    passed.clip = clip.name;
    passed.key = noh_pack_string(pack, clip.events[event->index].name);
    passed.track = event->track;
    passed.weight = event->weight;
    s->fn(s->user, &passed);
}

void view_step(view_model *m, double seconds, view_event_fn fn, void *user)
{
    step s = { m, 0, fn, user };
    for (; s.player < m->scene.player_count; s.player++) {
        const scene_player *p = &m->scene.players[s.player];
        if (p->bank) {
            noh_clip_cache_begin_frame(p->bank->cache);
            noh_controller_step(p->controllers[0], &p->bank->clips, (uint32_t)noh_ticks_from_seconds(seconds),
                                pass_event, &s);
        }
    }
}
