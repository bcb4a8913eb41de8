/* view_print.c: the viewer's state as lines of text, to copy into a report, and for tests to read. */
#include <stdio.h>
#include <string.h>

#include "draw/camera.h"
#include "view/view_app.h"

static const char *mode_name(uint32_t mode)
{
    return mode == NOH_TRACK_TIME_ONLY ? "muted" : "on";
}

static const char *loop_name(uint32_t loop)
{
    return loop == NOH_LOOP_ONCE ? "once" : loop == NOH_LOOP_REPEAT ? "repeat" : "ping-pong";
}

static void print_track(FILE *out, const view_model *m, uint32_t kind, uint32_t track)
{
    const noh_track *t = noh_controller_track(view_controller(m, kind, NULL), track);
    fprintf(out, "track %u %s %s %.3f s, weight %.3f, speed %.3f, sync %u, %s, %s\n", track,
            view_layer_names[view_layer_of(track)], view_clip_name(m, kind, t->clip), view_position(m, kind, track),
            (double)t->weight, (double)t->speed_now / NOH_SPEED_ONE, t->sync_group, loop_name(t->loop),
            mode_name(t->mode));
}

static void print_pad(FILE *out, const view_app *a)
{
    fprintf(out, "pad at %.3f %.3f", (double)a->pad.at[0], (double)a->pad.at[1]);
    for (uint32_t i = 0; i < a->pad.count; i++) {
        fprintf(out, ", %s %.3f", a->model->clips[a->pad.clips[i]].name, (double)a->pad.weights[i]);
    }
    fprintf(out, "\n");
}

static void print_graph(FILE *out, const view_model *m)
{
    noh_stage *s = m->figure->stage;
    noh_pack_graph g;
    const char *name;
    if (noh_pack_graph_at(&m->clips_of->pack, view_graph_playing(m), &g, NULL) != NOH_OK) {
        return;
    }
    fprintf(out, "graph %s", g.name);
    for (uint32_t i = 0; (name = noh_stage_name(s, 0, NOH_NAME_PARAMETER, i)) != NULL; i++) {
        fprintf(out, ", %s %.3f", name, (double)view_graph_parameter(m, i));
    }
    for (uint32_t i = 0; (name = noh_stage_name(s, 0, NOH_NAME_MACHINE, i)) != NULL; i++) {
        const char *state = noh_actor_state(s, m->figure->actors[0], i);
        fprintf(out, ", %s: %s", name, state ? state : "");
    }
    fprintf(out, "\n");
}

/* Nothing for a figure that cannot fall. */
static void print_body(FILE *out, const view_app *a)
{
    static const char *const states[] = { "stands", "falls", "lies", "gets up" };
    const view_model *m = a->model;
    const noh_body_state body = noh_actor_body(m->figure->stage, m->figure->actors[0]);
    if (m->cannot_fall.result) {
        return;
    }
    fprintf(out, "body %s\n",
            states[body == NOH_BODY_STANDS && view_fall_lasts(&a->fall, m) ? NOH_BODY_GETS_UP : body]);
}

/* The user's settings. */
static void print_set(FILE *out, const view_app *a)
{
    static const char *const withs[] = { "nothing", "level", "path" }, *const skins[] = { "surface", "joints",
                                                                                          "weights" };
    const view_model *m = a->model;
    const char *joint = noh_stage_name(m->figure->stage, 0, NOH_NAME_JOINT, a->over.joint);
    for (uint32_t t = 0; t < m->target_count; t++) {
        if (m->targets[t].held) fprintf(out, "held %s %g\n", m->targets[t].name, (double)m->targets[t].value);
    }
    fprintf(out, "over %s%s%s%s%s%s\n", skins[a->over.skin], a->over.skin == VIEW_SKIN_WEIGHTS && joint ? " of " : "",
            a->over.skin == VIEW_SKIN_WEIGHTS && joint ? joint : "", a->over.wireframe ? ", wireframe" : "",
            a->over.normals ? ", normals" : "", a->over.bones ? ", bones" : "");
    if (a->compare.is.with != VIEW_COMPARE_OFF) {
        fprintf(out, "compared with another %s: %u pixels differ, most %u\n", withs[a->compare.is.with],
                a->compare.differing, a->compare.most);
    }
    fprintf(out, "step %u of %u, presets %u\n", a->undo.at, a->undo.count, a->presets.count);
    for (uint32_t i = 0; i < a->presets.count; i++) {
        fprintf(out, "preset %s%s\n", a->presets.list[i].name, a->presets.list[i].own ? ", own" : "");
    }
}

/* Work in progress. */
static void print_going_on(FILE *out, const view_app *a)
{
    noh_gl_camera camera;
    orbit_camera(&a->camera.orbit, &camera);
    if (!a->model->show_bones) fprintf(out, "seen %.4f\n", orbit_sees(a->model->figure, &camera));
    fprintf(out, "%s%s\n", a->playing ? "playing" : "paused", a->camera.turntable ? ", turning" : "");
    if (a->files.load.state == VIEW_LOAD_RUNS)
        fprintf(out, "converting %s: %s\n", a->files.load.path, a->files.load.does);
    if (a->film.job.is_on)
        fprintf(out, "film %s: frame %u of %u\n", a->film.job.film.path, a->film.job.film.count, a->film.job.frames);
    view_capture_print(&a->capture, out);
    if (a->files.reloads) fprintf(out, "reloads %u\n", a->files.reloads);
    if (a->window.quit_asked) fprintf(out, "asks whether to quit\n");
    if (a->message[0]) fprintf(out, "message %s\n", a->message);
}

void view_print(const view_app *a, FILE *out)
{
    const view_model *m = a->model;
    const noh_place place = view_model_place(m);
    char text[512];
    fprintf(out, "state of %s\n", m->path);
    for (uint32_t k = 0; k < m->figure->stage_desc.kind_count; k++) {
        const noh_controller *c = view_controller(m, k, NULL);
        for (uint32_t t = 0; t < c->track_count; t++) {
            if (noh_controller_track(c, t)->mode != NOH_TRACK_OFF) print_track(out, m, k, t);
        }
    }
    if (a->pad.count) print_pad(out, a);
    print_graph(out, m);
    print_body(out, a);
    fprintf(out, "place %.4f %.4f %.4f\n", (double)place.position[0], (double)place.position[1],
            (double)place.position[2]);
    fprintf(out, "center %.4f %.4f %.4f\n", a->camera.orbit.center[0], a->camera.orbit.center[1],
            a->camera.orbit.center[2]);
    if (a->desc.light) fprintf(out, "light turned %.1f, %s\n", a->desc.light->degrees, view_lights_shown(&a->lights));
    view_lod_text(&a->lod, text, sizeof text);
    fprintf(out, "%s\n", text);
    print_set(out, a);
    print_going_on(out, a);
    if (a->pick.is_on) {
        view_pick_text(&a->pick, m, text, sizeof text);
        fprintf(out, "picked %s\n", text);
    }
    if (a->log.total) {
        fprintf(out, "key %u %s\n", a->log.total, a->log.lines[(a->log.next + VIEW_LINES - 1u) % VIEW_LINES]);
    }
    fprintf(out, "end of state\n");
    fflush(out);
}
