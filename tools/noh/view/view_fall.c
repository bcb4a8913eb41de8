#include "view/view_fall.h"

#include <string.h>

#include "cli/message.h"

#define PUSH 150.0f /* newton seconds */
#define GO_ON_S 0.3f

int view_fall_push(view_model *m, const view_pick *pick, const float eye[3])
{
    noh_stage *s = m->figure->stage;
    noh_error error = m->cannot_fall;
    const noh_place place = view_model_place(m);
    float impulse[3];
    if (error.result) {
        return tool_fail(m->path, "it cannot ragdoll: %s", error.what);
    }
    if (pick && pick->kind) {
        return tool_fail(m->path, "only the pack's first skeleton can ragdoll");
    }
    noh_push_away(eye, pick ? pick->hit.point : place.position, PUSH, impulse);
    return noh_actor_push(s, m->figure->actors[0], pick ? pick->hit.point : NULL, impulse, &error)
               ? tool_fail_error(m->path, &error)
               : 0;
}

static uint32_t body_clip(const view_model *m)
{
    const noh_track *track = noh_actor_track(m->figure->stage, m->figure->actors[0], VIEW_BODY);
    return track ? track->clip : NOH_NONE;
}

static int go_on(const view_fall *f, view_model *m, view_pad *pad)
{
    const view_how how = { .layer = 1u + VIEW_BODY, .fade_s = GO_ON_S, .weight = 1.0f, .speed = 1.0f };
    if (body_clip(m) != f->rise || f->rise == f->clip) {
        return 0; /* another was chosen meanwhile, or it had no clip to get up by */
    }
    if (f->had_pad) {
        return view_pad_play(pad, m);
    }
    if (f->graph != NOH_NONE) {
        return view_graph_play(m, f->graph, GO_ON_S);
    }
    for (uint32_t i = 0; i < m->clip_count && f->clip != NOH_NONE; i++) {
        if (m->clips[i].clips[0] == f->clip) return view_start(m, i, &how, 0);
    }
    view_stop_layer(m, VIEW_BODY, GO_ON_S);
    return 0;
}

int view_fall_step(view_fall *f, view_model *m, view_pad *pad, uint32_t ticks)
{
    noh_stage *s = m->figure->stage;
    noh_error error = { NOH_OK, "", 0, 0 };
    if (m->cannot_fall.result) {
        return 0;
    }
    if (!f->fall.rise_ticks) {
        f->clip = body_clip(m);
        f->graph = view_graph_playing(m);
        f->had_pad = pad->plays;
    }
    if (noh_fall_step(&f->fall, s, m->figure->actors[0], VIEW_BODY, ticks, &error)) {
        return tool_fail_error(m->path, &error);
    }
    if (f->fall.rise_ticks && !f->has_risen) {
        f->has_risen = 1;
        f->rise = body_clip(m);
    }
    if (f->has_risen && !view_fall_lasts(f, m)) {
        f->has_risen = 0;
        return go_on(f, m, pad);
    }
    return 0;
}

int view_fall_lasts(const view_fall *f, const view_model *m)
{
    return noh_fall_lasts(&f->fall, m->figure->stage, m->figure->actors[0]);
}
