/* view_print.c: the viewer's state as lines of text, to copy into a report, and for tests to read. */
#include <stdio.h>

#include "view/view_app.h"

static const char *mode_name(uint32_t mode)
{
    return mode == NOH_TRACK_TIME_ONLY ? "muted" : "on";
}

static const char *loop_name(uint32_t loop)
{
    return loop == NOH_LOOP_ONCE ? "once" : loop == NOH_LOOP_REPEAT ? "repeat" : "ping-pong";
}

static void print_track(const view_model *m, uint32_t kind, uint32_t track)
{
    const noh_track *t = noh_controller_track(view_controller(m, kind, NULL), track);
    printf("track %u %s %s %.3f s, weight %.3f, speed %.3f, sync %u, %s, %s\n", track,
           view_layer_names[view_layer_of(track)], view_clip_name(m, kind, t->clip), view_position(m, kind, track),
           (double)t->weight, (double)t->speed_now / NOH_SPEED_ONE, t->sync_group, loop_name(t->loop),
           mode_name(t->mode));
}

static void print_pad(const view_app *a)
{
    printf("pad at %.3f %.3f", (double)a->pad.at[0], (double)a->pad.at[1]);
    for (uint32_t i = 0; i < a->pad.count; i++) {
        printf(", %s %.3f", a->model->clips[a->pad.clips[i]].name, (double)a->pad.weights[i]);
    }
    printf("\n");
}

static void print_graph(const view_model *m)
{
    noh_stage *s = m->figure->stage;
    noh_pack_graph g;
    const char *name;
    if (noh_pack_graph_at(&m->clips_of->pack, view_graph_playing(m), &g, NULL) != NOH_OK) {
        return;
    }
    printf("graph %s", g.name);
    for (uint32_t i = 0; (name = noh_stage_name(s, 0, NOH_NAME_PARAMETER, i)) != NULL; i++) {
        printf(", %s %.3f", name, (double)view_graph_parameter(m, i));
    }
    for (uint32_t i = 0; (name = noh_stage_name(s, 0, NOH_NAME_MACHINE, i)) != NULL; i++) {
        const char *state = noh_actor_state(s, m->figure->actors[0], i);
        printf(", %s: %s", name, state ? state : "");
    }
    printf("\n");
}

/* None of what cannot fall. */
static void print_body(const view_app *a)
{
    static const char *const states[] = { "stands", "falls", "lies", "gets up" };
    const view_model *m = a->model;
    const noh_body_state body = noh_actor_body(m->figure->stage, m->figure->actors[0]);
    if (m->cannot_fall.result) {
        return;
    }
    printf("body %s\n", states[body == NOH_BODY_STANDS && view_fall_lasts(&a->fall, m) ? NOH_BODY_GETS_UP : body]);
}

void view_print(const view_app *a)
{
    const view_model *m = a->model;
    const noh_place place = view_model_place(m);
    char text[512];
    printf("state of %s\n", m->path);
    for (uint32_t k = 0; k < m->figure->stage_desc.kind_count; k++) {
        const noh_controller *c = view_controller(m, k, NULL);
        for (uint32_t t = 0; t < c->track_count; t++) {
            if (noh_controller_track(c, t)->mode != NOH_TRACK_OFF) print_track(m, k, t);
        }
    }
    if (a->pad.count) print_pad(a);
    print_graph(m);
    print_body(a);
    printf("place %.4f %.4f %.4f\n", (double)place.position[0], (double)place.position[1], (double)place.position[2]);
    printf("center %.4f %.4f %.4f\n", a->orbit.center[0], a->orbit.center[1], a->orbit.center[2]);
    if (a->desc.light) printf("light turned %.1f\n", a->desc.light->degrees);
    view_lod_text(&a->lod, text, sizeof text);
    printf("%s\n", text);
    if (a->pick.is_on) {
        view_pick_text(&a->pick, m, text, sizeof text);
        printf("picked %s\n", text);
    }
    if (a->log.total) {
        printf("key %u %s\n", a->log.total, a->log.lines[(a->log.next + VIEW_LINES - 1u) % VIEW_LINES]);
    }
    printf("end of state\n");
    fflush(stdout);
}
