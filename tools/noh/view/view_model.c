#include "view/view_model.h"

#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "gl/gl_lost.h"
#include "cli/message.h"

/* ---- the file ---- */

static int is_model(const char *path)
{
    static const char *const endings[] = { ".gltf", ".glb", ".bvh", ".rcl" };
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof endings[0]; i++) {
        if (strcmp(dot, endings[i]) == 0) {
            return 1;
        }
    }
    return 0;
}

static int convert_model(view_model *m, const lod_settings *levels)
{
    const char *inputs[1];
    convert_options options;
    convert_failure failure;
    noh_error error = { NOH_OK, "", 0, 0 };
    inputs[0] = m->path;
    memset(&options, 0, sizeof options);
    options.morph.error_um = 10.0f; /* as `noh build` without options */
    options.clip.clip.error_cm = 0.01;
    options.clip.clip.shell_cm = 3.0;
    options.clip.unit_cm = 1.0;
    options.lod = *levels;
    if (convert_files(inputs, 1, &options, &m->converted, &failure)) {
        return failure.error.where[0] ? tool_fail(m->path, "%s (%s)", failure.error.what, failure.error.where)
                                      : tool_fail(m->path, "%s", failure.error.what);
    }
    m->file.path = m->path;
    return noh_pack_open(m->converted.bytes, m->converted.count, &m->file.pack, &error)
               ? tool_fail_error(m->path, &error)
               : 0;
}

/* ---- lists for the panels ---- */

static uint32_t find_target(view_model *m, const char *name)
{
    for (uint32_t t = 0; t < m->target_count; t++) {
        if (strcmp(m->targets[t].name, name) == 0) {
            return t;
        }
    }
    m->targets[m->target_count].name = name;
    return m->target_count++;
}

static int list_targets(view_model *m)
{
    size_t most = 1;
    for (uint32_t i = 0; i < m->scene.item_count; i++) {
        most += m->scene.meshes[m->scene.items[i].mesh].header->target_count;
    }
    m->targets = calloc(most, sizeof *m->targets);
    m->weights = calloc(most, sizeof *m->weights);
    if (!m->targets || !m->weights) {
        return tool_fail(m->path, "out of memory");
    }
    m->delta_max = 1e-30f;
    for (uint32_t i = 0; i < m->scene.item_count; i++) {
        const scene_item *item = &m->scene.items[i];
        const noh_mesh *mesh = &m->scene.meshes[item->mesh];
        for (uint32_t t = 0; t < mesh->header->target_count; t++) {
            view_weight *w = &m->weights[m->weight_count++];
            w->target = find_target(m, noh_pack_string(&m->file.pack, mesh->targets[t].name));
            w->item = i;
            w->index = t;
            w->initial = item->weights[t];
            m->delta_max = mesh->targets[t].radius > m->delta_max ? mesh->targets[t].radius : m->delta_max;
        }
    }
    return 0;
}

static int list_clips(view_model *m)
{
    size_t count = 0;
    for (uint32_t p = 0; p < m->scene.player_count; p++) {
        const noh_clip_bank *set = m->scene.players[p].bank;
        count += set ? set->clips.clip_count : 0u;
    }
    m->clips = calloc(count + 1, sizeof *m->clips);
    if (!m->clips) {
        return tool_fail(m->path, "out of memory");
    }
    for (uint32_t p = 0; p < m->scene.player_count; p++) {
        const noh_clip_bank *set = m->scene.players[p].bank;
        for (uint32_t i = 0; set && i < set->clips.clip_count; i++) {
            view_clip *clip = &m->clips[m->clip_count++];
            clip->name = view_clip_name(m, p, i);
            clip->player = p;
            clip->clip = i;
            clip->seconds = (double)set->clips.clips[i].duration_ticks / (double)NOH_TICKS_PER_SECOND;
        }
    }
    return 0;
}

/* ---- opening ---- */

static int open_drawing(view_model *m, gpu *g, const view_model_desc *desc, drawing *d, load_budget *budget,
                        level_costs *costs)
{
    int show_bones = drawing_shows_bones(&m->scene, &m->file, desc->show_bones), status = 0;
    load_options options = desc->load;
    memset(budget, 0, sizeof *budget);
    memset(costs, 0, sizeof *costs);
    if (show_bones < 0) {
        return EXIT_FAILED;
    }
    options.fades = scene_level_count(&m->scene, &m->file) > 1u;
    if (!show_bones) status = load_budget_make(budget, &m->file, &m->scene, &g->caps, &options);
    if (!show_bones && !status) status = level_costs_find(costs, &m->file, &m->scene, &g->caps, &options);
    if (!status) status = drawing_open(d, g, &m->file, &m->scene, &options, show_bones, desc->width, desc->height);
    if (status) {
        load_budget_free(budget);
    }
    return status;
}

static int open_scene(view_model *m, gpu *g, const view_model_desc *desc)
{
    int status = scene_init(&m->scene, &m->file);
    if (!status) status = scene_open_anim(&m->scene, &m->file, desc->anim);
    if (!status) status = scene_open_players(&m->scene, &m->file, 1);
    if (!status) status = list_targets(m);
    if (!status) status = list_clips(m);
    if (!status) status = scene_lod_open(&m->lod, &m->file, &m->scene);
    if (!status) status = open_drawing(m, g, desc, &m->drawing, &m->budget, &m->costs);
    return status;
}

int view_model_open(gpu *g, const view_model_desc *desc, view_model **out)
{
    view_model *m = calloc(1, sizeof *m); /* its address is kept by what is opened */
    int status;
    if (!m || strlen(desc->path) >= sizeof m->path) {
        free(m);
        return tool_fail(desc->path, m ? "the path is too long" : "out of memory");
    }
    strcpy(m->path, desc->path);
    status = is_model(m->path) ? convert_model(m, &desc->lod) : pack_file_open(&m->file, m->path);
    if (!status) status = open_scene(m, g, desc);
    if (status) {
        view_model_close(m);
        return status;
    }
    *out = m;
    return 0;
}

void view_model_close(view_model *m)
{
    if (!m) {
        return;
    }
    drawing_close(&m->drawing);
    load_budget_free(&m->budget);
    scene_lod_close(&m->lod);
    scene_free(&m->scene);
    if (m->file.file.data) {
        pack_file_close(&m->file);
    }
    buffer_free(&m->converted);
    free(m->targets);
    free(m->weights);
    free(m->clips);
    free(m);
}

int view_model_reload(view_model *m, gpu *g, const view_model_desc *desc)
{
    drawing d;
    load_budget budget;
    level_costs costs;
    int status = open_drawing(m, g, desc, &d, &budget, &costs);
    if (status) {
        return status;
    }
    drawing_close(&m->drawing);
    load_budget_free(&m->budget);
    m->drawing = d;
    m->budget = budget;
    m->costs = costs;
    return 0;
}

void view_model_lost(view_model *m, gpu *g)
{
    const noh_gl_api gl = g->gl;
    m->drawing.has_canvas = 0;
    g->gl = *noh_gl_lost_api();
    while (m->drawing.bones_count) {
        bones_close(&m->drawing.bones[--m->drawing.bones_count]);
    }
    g->gl = gl;
}

static int restore_bones(drawing *d, gpu *g)
{
    int status = 0;
    for (; d->bones_count < d->scene->player_count && !status; d->bones_count++) {
        const uint32_t joints = d->scene->players[d->bones_count].skeleton.joint_count;
        status = joints ? bones_open(&d->bones[d->bones_count], g, joints) : 0;
    }
    return status;
}

int view_model_restore(view_model *m, gpu *g)
{
    drawing *d = &m->drawing;
    int status = d->bones ? restore_bones(d, g) : load_restore(&d->load);
    if (!status) {
        status = canvas_open(&d->canvas, g, d->canvas.width, d->canvas.height);
        d->has_canvas = !status;
    }
    return status;
}

bounds view_model_bounds(const view_model *m)
{
    return drawing_bounds(&m->scene, &m->file, 0, m->drawing.bones != NULL);
}

/* ---- posing ---- */

void view_model_pose(view_model *m)
{
    for (uint32_t i = 0; i < m->weight_count; i++) {
        const view_weight *w = &m->weights[i];
        m->scene.items[w->item].weights[w->index] = w->initial;
    }
    for (uint32_t p = 0; p < m->scene.player_count; p++) {
        if (m->scene.players[p].bank) {
            scene_pose_player(&m->scene, &m->scene.players[p]);
        }
    }
    for (uint32_t i = 0; i < m->weight_count; i++) {
        const view_weight *w = &m->weights[i];
        float *weight = &m->scene.items[w->item].weights[w->index];
        if (m->targets[w->target].held) {
            *weight = m->targets[w->target].value;
        } else {
            m->targets[w->target].value = *weight;
        }
    }
}
