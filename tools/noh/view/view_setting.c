#include "view/view_setting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

/* A figure and the data it refers to. */
typedef struct staged {
    figure figure;
    noh_layer_desc layers[VIEW_LAYERS];
    char part[NOH_NAME_BYTES_MAX];
} staged;

static staged *make_staged(const char *part)
{
    staged *s = calloc(1, sizeof *s); /* a figure must not move */
    if (s) {
        const noh_layer_desc layers[VIEW_LAYERS] = {
            { view_layer_names[VIEW_BODY], NOH_LAYER_BASE, NULL, NULL, VIEW_BODY_TRACKS },
            { view_layer_names[VIEW_PART], NOH_LAYER_OVER, s->part, "", VIEW_OTHER_TRACKS },
            { view_layer_names[VIEW_FACE], NOH_LAYER_OVER, "", NULL, VIEW_OTHER_TRACKS },
            { view_layer_names[VIEW_ADD], NOH_LAYER_ADD, NULL, NULL, VIEW_OTHER_TRACKS },
        };
        memcpy(s->layers, layers, sizeof layers);
        snprintf(s->part, sizeof s->part, "%s", part ? part : "");
    }
    return s;
}

void setting_close(setting *s)
{
    for (uint32_t k = 0; k < NOH_STAGE_KINDS_MAX; k++) {
        if (s->bones[k]) bones_close(s->bones[k]);
        free(s->bones[k]);
    }
    if (s->figure && s->figure->stage) figure_close(s->figure);
    free(s->figure);
    memset(s, 0, sizeof *s);
}

static int has_joints(const noh_pack *pack)
{
    return pack->runs[NOH_CHUNK_SKELETON].count > 0;
}

static int open_bones(setting *s, gpu *g, const char *path)
{
    int status = 0;
    for (uint32_t k = 0; k < s->figure->stage_desc.kind_count && !status; k++) {
        const uint32_t joints = s->figure->plan.kinds[k].joint_count;
        if (!joints) continue;
        s->bones[k] = calloc(1, sizeof *s->bones[k]);
        status = s->bones[k] ? bones_open(s->bones[k], g, joints) : tool_fail(path, "out of memory");
    }
    return status;
}

int setting_open(const view_model *m, gpu *g, const view_model_desc *desc, setting *s)
{
    staged *own = NULL;
    const noh_pack *pack = &m->file.pack;
    figure_desc d;
    int status;
    memset(s, 0, sizeof *s);
    s->show_bones = desc->show_bones || !pack->runs[NOH_CHUNK_MESH].count;
    if (s->show_bones && !has_joints(pack)) {
        return tool_fail(m->path,
                         desc->show_bones ? "the pack has no skeleton to draw" : "the pack has nothing to draw");
    }
    own = make_staged(desc->part);
    if (!own) {
        return tool_fail(m->path, "out of memory");
    }
    s->figure = &own->figure;
    memset(&d, 0, sizeof d);
    d.file = &m->file;
    d.clips = m->clips_of;
    d.level = figure_level_first(pack);
    d.by_error = 1;
    d.layers = own->layers;
    d.layer_count = VIEW_LAYERS;
    d.held_float_count = FIGURE_HELD_ALL;
    d.inertia = d.pickable = d.tangents = 1;
    d.alive = desc->alive && !s->show_bones;
    d.without_springs = desc->without_springs;
    d.weight_rules = desc->weight_rules;
    d.hair = !s->show_bones;
    d.falls = !m->cannot_fall.result;
    d.stands = has_joints(pack) && figure_rests(&d, NULL);
    d.root_axes = desc->root_motion ? NOH_ROOT_GROUND : 0;
    d.path = desc->morph_path;
    d.sums = 1;
    d.accumulate = desc->accumulate;
    d.view = desc->view;
    d.light = desc->light;
    d.shading = desc->shading;
    d.drivers = desc->drivers;
    d.graphs = m->clips_of->pack.runs[NOH_CHUNK_GRAPH].count && pack->runs[NOH_CHUNK_SKELETON].count == 1 ? "*" : NULL;
    status = figure_open(s->figure, &d, s->show_bones ? NULL : g);
    if (status && d.graphs) { /* such as graphs whose clips the pack lacks: the error was printed */
        d.graphs = NULL;
        status = figure_open(s->figure, &d, s->show_bones ? NULL : g);
    }
    if (!status) status = open_bones(s, g, m->path);
    if (!status && d.light) status = figure_pose(s->figure); /* its shadow falls by the last pose */
    if (status) setting_close(s);
    return status;
}

/* A graph restarts with its present parameters. */
static void carry_graph(const figure *from, figure *to)
{
    const noh_graph_pack *made;
    const noh_play at_once = { .fade_ticks = 1 };
    if (!noh_actor_graph(from->stage, from->actors[0], &made)) {
        return;
    }
    (void)noh_actor_play_graph(to->stage, to->actors[0], VIEW_BODY, made->source.name, &at_once, NULL);
    for (uint32_t i = 0; noh_stage_name(to->stage, 0, NOH_NAME_PARAMETER, i); i++) {
        (void)noh_actor_set_parameter(to->stage, to->actors[0], i, noh_actor_parameter(from->stage, from->actors[0], i),
                                      NULL);
    }
}

void setting_carry_tracks(const figure *from, figure *to)
{
    const noh_graph_pack *made;
    for (uint32_t k = 0; k < to->stage_desc.kind_count; k++) {
        const noh_controller *was = noh_actor_controller(from->stage, from->actors[k], NULL);
        noh_controller *is = noh_actor_controller(to->stage, to->actors[k], NULL);
        const int has_graph = noh_actor_graph(from->stage, from->actors[k], &made) != NULL;
        noh_place place;
        if (!has_graph && was->bytes == is->bytes && was->clip_count == is->clip_count) memcpy(is, was, was->bytes);
        for (uint32_t t = 0; t < is->track_count; t++) {
            noh_track *track = &noh_controller_tracks(is)[t];
            track->root_position = track->position; /* only root motion from here on moves it */
        }
        (void)noh_actor_place(from->stage, from->actors[k], &place, NULL);
        (void)noh_actor_set_place(to->stage, to->actors[k], &place, NULL);
    }
}

void setting_carry(const figure *from, figure *to)
{
    carry_graph(from, to);
    setting_carry_tracks(from, to);
}
