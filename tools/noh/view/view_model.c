#include "view/view_model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "anim/controller_pose.h"
#include "gl/gl_lost.h"
#include "cli/message.h"

/* ---- the file ---- */

static int is_model(const char *path)
{
    static const char *const endings[] = { ".gltf", ".glb", ".vrm", ".fbx", ".obj", ".bvh", ".rcl" };
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

static uint32_t kind_count(const view_model *m)
{
    return m->figure->stage_desc.kind_count;
}

static view_target *find_target(view_model *m, const char *name)
{
    for (uint32_t t = 0; t < m->target_count; t++) {
        if (strcmp(m->targets[t].name, name) == 0) {
            return &m->targets[t];
        }
    }
    m->targets[m->target_count].name = name;
    memset(m->targets[m->target_count].floats, 0xff, sizeof m->targets[0].floats); /* NOH_NONE */
    return &m->targets[m->target_count++];
}

/* All floats that have a name: morph targets, and named floats of clips. */
static int list_targets(view_model *m)
{
    noh_stage *s = m->figure->stage;
    size_t most = 1;
    for (uint32_t k = 0; k < kind_count(m); k++) most += m->figure->plan.kinds[k].float_count;
    m->targets = calloc(most, sizeof *m->targets);
    m->floats = calloc(most, sizeof *m->floats);
    if (!m->targets || !m->floats) {
        return tool_fail(m->path, "out of memory");
    }
    for (uint32_t k = 0; k < kind_count(m); k++) {
        const char *name;
        for (uint32_t f = 0; (name = noh_stage_name(s, k, NOH_NAME_FLOAT, f)) != NULL; f++) {
            view_target *t = name[0] ? find_target(m, name) : NULL;
            if (t && t->floats[k] == NOH_NONE) t->floats[k] = f;
        }
    }
    return 0;
}

static view_clip *find_clip(view_model *m, const char *name)
{
    for (uint32_t c = 0; c < m->clip_count; c++) {
        if (strcmp(m->clips[c].name, name) == 0) {
            return &m->clips[c];
        }
    }
    m->clips[m->clip_count].name = name;
    memset(m->clips[m->clip_count].clips, 0xff, sizeof m->clips[0].clips);
    return &m->clips[m->clip_count++];
}

static int list_clips(view_model *m)
{
    noh_stage *s = m->figure->stage;
    m->clips = calloc((size_t)m->clips_of->pack.clip_count + 1u, sizeof *m->clips);
    if (!m->clips) {
        return tool_fail(m->path, "out of memory");
    }
    for (uint32_t k = 0; k < kind_count(m); k++) {
        const noh_clip_set *set;
        const char *name;
        (void)view_controller(m, k, &set);
        for (uint32_t i = 0; (name = noh_stage_name(s, k, NOH_NAME_CLIP, i)) != NULL; i++) {
            view_clip *clip = find_clip(m, name);
            clip->clips[k] = i;
            clip->seconds = (double)set->clips[i].duration_ticks / (double)NOH_TICKS_PER_SECOND;
        }
    }
    return 0;
}

/* How far a target moves a vertex, for pictures of accumulators. */
static void measure_targets(view_model *m)
{
    m->delta_max = 1e-30f;
    for (uint32_t i = 0; i < m->file.pack.mesh_count; i++) {
        noh_mesh mesh;
        (void)noh_pack_mesh_at(&m->file.pack, i, &mesh, NULL);
        for (uint32_t t = 0; t < mesh.header->target_count; t++) {
            m->delta_max = fmaxf(m->delta_max, mesh.targets[t].radius);
        }
    }
}

/* ---- a stage ---- */

/* A figure, and what it borrows. */
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

/* What a stage of these options is, and what it has for the panels. */
typedef struct setting {
    figure *figure; /* the first member of a `staged` */
    int show_bones;
    bones *bones[NOH_STAGE_KINDS_MAX];
} setting;

static void close_setting(setting *s)
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
    return pack->skeleton_count > 0;
}

static int open_bones(setting *s, gpu *g, const char *path)
{
    int status = 0;
    for (uint32_t k = 0; k < s->figure->stage_desc.kind_count && !status; k++) {
        const uint32_t joints = s->figure->plan.kinds[k].joint_count;
        if (!s->show_bones || !joints) continue;
        s->bones[k] = calloc(1, sizeof *s->bones[k]);
        status = s->bones[k] ? bones_open(s->bones[k], g, joints) : tool_fail(path, "out of memory");
    }
    return status;
}

static int open_setting(view_model *m, gpu *g, const view_model_desc *desc, setting *s)
{
    staged *own = NULL;
    const noh_pack *pack = &m->file.pack;
    figure_desc d;
    int status;
    memset(s, 0, sizeof *s);
    s->show_bones = desc->show_bones || !pack->mesh_count;
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
    d.root_axes = desc->root_motion ? NOH_ROOT_GROUND : 0;
    d.path = desc->morph_path;
    d.accumulate = desc->accumulate;
    d.view = desc->view;
    d.light = desc->light;
    d.graphs = m->clips_of->pack.graph_count && pack->skeleton_count == 1 ? "*" : NULL;
    status = figure_open(s->figure, &d, s->show_bones ? NULL : g);
    if (status && d.graphs) { /* such as graphs of clips that the pack of clips lacks: it has been told */
        d.graphs = NULL;
        status = figure_open(s->figure, &d, s->show_bones ? NULL : g);
    }
    if (!status) status = open_bones(s, g, m->path);
    if (!status && d.light) status = figure_pose(s->figure); /* its shadow falls by the last pose */
    if (status) close_setting(s);
    return status;
}

static int find_costs(view_costs *out, const figure *f, const noh_gl_caps *caps)
{
    pack_budget b;
    const int status = pack_budget_make(&b, &f->desc, caps);
    memset(out, 0, sizeof *out);
    if (status) {
        return status;
    }
    memcpy(out->levels, b.levels, sizeof out->levels);
    out->first = b.level_first;
    out->count = b.level_count;
    pack_budget_free(&b);
    return 0;
}

static int count_setting(view_model *m, const gpu *g, const setting *s)
{
    const figure *f = s->figure;
    int status = 0;
    memset(&m->costs, 0, sizeof m->costs);
    m->part_count = noh_stage_plan_parts(&f->stage_desc, s->show_bones ? NULL : &g->caps, &f->plan, m->parts,
                                         VIEW_PARTS_MAX);
    m->part_count = m->part_count < VIEW_PARTS_MAX ? m->part_count : VIEW_PARTS_MAX;
    m->is_morphed = 0;
    if (!s->show_bones) {
        m->is_morphed = f->plan.morph_path != 0 &&
                        noh_stage_morph_plan(&f->stage_desc, &g->caps, &f->plan, &m->morph_plan, NULL) == NOH_OK;
        status = find_costs(&m->costs, f, &g->caps);
    }
    return status;
}

static setting setting_of(const view_model *m)
{
    setting s;
    s.figure = m->figure;
    s.show_bones = m->show_bones;
    memcpy(s.bones, m->bones, sizeof s.bones);
    return s;
}

static void use_setting(view_model *m, const setting *s, const view_model_desc *desc)
{
    m->figure = s->figure;
    m->show_bones = s->show_bones;
    m->root_motion = desc->root_motion;
    m->has_graphs = s->figure->desc.graphs != NULL;
    memcpy(m->bones, s->bones, sizeof m->bones);
}

/* ---- opening ---- */

static int open_model(view_model *m, gpu *g, const view_model_desc *desc)
{
    setting s;
    int status = figure_open_clips(&m->anim_file, desc->anim, &m->file, &m->clips_of);
    (void)figure_can_fall(&m->file.pack, &m->cannot_fall);
    if (!status) status = open_setting(m, g, desc, &s);
    if (status) {
        return status;
    }
    use_setting(m, &s, desc);
    status = count_setting(m, g, &s);
    if (!status) status = list_targets(m);
    if (!status) status = list_clips(m);
    if (!status) status = view_model_fit(m, g, desc->width, desc->height);
    if (!status) status = figure_pose(m->figure);
    measure_targets(m);
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
    if (!status) status = open_model(m, g, desc);
    if (status) {
        view_model_close(m);
        return status;
    }
    *out = m;
    return 0;
}

void view_model_close(view_model *m)
{
    setting s;
    if (!m) {
        return;
    }
    s = setting_of(m);
    close_setting(&s);
    if (m->has_canvas) canvas_close(&m->canvas);
    if (m->clips_of) figure_close_clips(&m->anim_file, m->clips_of);
    if (m->file.file.data) {
        pack_file_close(&m->file);
    }
    buffer_free(&m->converted);
    free(m->targets);
    free(m->floats);
    free(m->clips);
    free(m);
}

/* A graph begins anew, with the parameters that it had. */
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

/* Tracks, changes and places of one stage to another with the same clips and layers. */
static void carry_over(const figure *from, figure *to)
{
    const noh_graph_pack *made;
    carry_graph(from, to);
    for (uint32_t k = 0; k < to->stage_desc.kind_count; k++) {
        const noh_controller *was = noh_actor_controller(from->stage, from->actors[k], NULL);
        noh_controller *is = noh_actor_controller(to->stage, to->actors[k], NULL);
        const int has_graph = noh_actor_graph(from->stage, from->actors[k], &made) != NULL;
        noh_place place;
        if (!has_graph && was->bytes == is->bytes && was->clip_count == is->clip_count) memcpy(is, was, was->bytes);
        for (uint32_t t = 0; t < is->track_count; t++) {
            noh_track *track = &noh_controller_tracks(is)[t];
            track->root_position = track->position; /* only what is walked from here on moves it */
        }
        (void)noh_actor_place(from->stage, from->actors[k], &place, NULL);
        (void)noh_actor_set_place(to->stage, to->actors[k], &place, NULL);
    }
}

int view_model_reload(view_model *m, gpu *g, const view_model_desc *desc)
{
    setting is, was = setting_of(m);
    int status = open_setting(m, g, desc, &is);
    if (!status && is.figure->stage_desc.kind_count != was.figure->stage_desc.kind_count) {
        status = tool_fail(m->path, "the same pack is planned with other kinds");
    }
    if (!status) status = count_setting(m, g, &is);
    if (status) {
        close_setting(&is);
        (void)count_setting(m, g, &was);
        return status;
    }
    carry_over(was.figure, is.figure);
    use_setting(m, &is, desc);
    close_setting(&was);
    return 0;
}

void view_model_lost(view_model *m, gpu *g)
{
    const noh_gl_api gl = g->gl;
    m->has_canvas = 0;
    g->gl = *noh_gl_lost_api();
    for (uint32_t k = 0; k < NOH_STAGE_KINDS_MAX; k++) {
        if (m->bones[k]) bones_close(m->bones[k]);
    }
    g->gl = gl;
}

static int restore_bones(view_model *m, gpu *g)
{
    int status = 0;
    for (uint32_t k = 0; k < NOH_STAGE_KINDS_MAX && !status; k++) {
        if (m->bones[k]) status = bones_open(m->bones[k], g, m->figure->plan.kinds[k].joint_count);
    }
    return status;
}

int view_model_restore(view_model *m, gpu *g)
{
    int status = m->show_bones ? restore_bones(m, g) : figure_restore(m->figure);
    if (!status) {
        status = canvas_open(&m->canvas, g, m->canvas.width, m->canvas.height);
        m->has_canvas = !status;
    }
    return status;
}

int view_model_fit(view_model *m, gpu *g, uint32_t width, uint32_t height)
{
    int status;
    if (m->has_canvas && width == m->canvas.width && height == m->canvas.height) {
        return 0;
    }
    if (m->has_canvas) canvas_close(&m->canvas);
    m->has_canvas = 0;
    status = canvas_open(&m->canvas, g, width, height);
    m->has_canvas = !status;
    return status;
}

/* ---- where it stands ---- */

static bounds joint_bounds(const view_model *m)
{
    bounds box = { { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY } };
    for (uint32_t k = 0; k < kind_count(m); k++) {
        noh_skeleton skeleton;
        float *matrices = figure_joints(m->figure, k, &skeleton);
        if (matrices) box = bounds_union(box, bones_bounds(skeleton.joint_count, matrices));
        free(matrices);
    }
    return box;
}

bounds view_model_bounds(const view_model *m)
{
    return m->show_bones ? joint_bounds(m) : figure_bounds(m->figure, 0);
}

noh_place view_model_place(const view_model *m)
{
    noh_place place;
    memset(&place, 0, sizeof place);
    (void)noh_actor_place(m->figure->stage, m->figure->actors[0], &place, NULL);
    return place;
}

void view_model_send_home(view_model *m)
{
    static const noh_place home;
    for (uint32_t k = 0; k < kind_count(m); k++) {
        (void)noh_actor_set_place(m->figure->stage, m->figure->actors[k], &home, NULL);
    }
}

/* By weight the places where the body's clips have the root now: that of the pose, before there is one. Of a graph that
 * of the last pose. */
void view_model_anchor(view_model *m, double anchor[3])
{
    const noh_clip_set *set;
    const noh_controller *c = view_controller(m, 0, &set);
    const noh_place place = view_model_place(m);
    float joint[12];
    double sum = 0.0;
    memset(anchor, 0, 3 * sizeof *anchor);
    for (uint32_t t = 0; !m->root_motion && set->joint_count && t < VIEW_BODY_TRACKS; t++) {
        const noh_track *track = noh_controller_track(c, t);
        noh_transform root;
        if (track->mode != NOH_TRACK_ON || !(track->weight > 0.0f) || !view_clip_of(m, 0, track)) continue;
        set->sample(set->user, track->clip, noh_track_clip_tick(track, &set->clips[track->clip], 0), 1, &root,
                    set->float_count, m->floats);
        for (int i = 0; i < 3; i++) anchor[i] += (double)track->weight * (double)root.translation[i];
        sum += (double)track->weight;
    }
    if (!m->root_motion && view_graph_playing(m) != NOH_NONE &&
        noh_actor_joint(m->figure->stage, m->figure->actors[0], 0, joint, NULL) == NOH_OK) {
        anchor[0] = (double)joint[3];
        anchor[2] = (double)joint[11];
        return;
    }
    for (int i = 0; i < 3; i += 2) {
        if (sum > 0.0) {
            anchor[i] /= sum;
        } else if (set->joint_count) {
            anchor[i] = (double)set->bind_pose[0].translation[i];
        }
        anchor[i] += (double)place.position[i];
    }
    anchor[1] = 0.0;
}

/* ---- a frame ---- */

static void hold_float(view_model *m, uint32_t kind, view_target *t)
{
    noh_stage *s = m->figure->stage;
    const noh_actor actor = m->figure->actors[kind];
    const float *shown = noh_actor_floats(s, actor);
    if (t->floats[kind] == NOH_NONE) {
        return;
    }
    if (t->held || t->let_go) {
        (void)noh_actor_hold_float(s, actor, t->floats[kind], t->value, t->held ? 1.0f : 0.0f, NULL);
    } else if (shown) {
        t->value = shown[t->floats[kind]];
    }
}

void view_model_hold(view_model *m)
{
    for (uint32_t i = 0; i < m->target_count; i++) {
        for (uint32_t k = 0; k < kind_count(m); k++) hold_float(m, k, &m->targets[i]);
        m->targets[i].let_go = 0;
    }
}

int view_model_pose(view_model *m, const noh_gl_camera *camera, int cut)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_stage *s = m->figure->stage;
    noh_stage_view views[2];
    const uint32_t view_count = figure_views(m->figure, camera, m->canvas.height, views);
    uint32_t count;
    views[0].cut = (uint32_t)cut;
    if (noh_stage_frame_begin(s, views, view_count, &error)) {
        return tool_fail_error(m->path, &error);
    }
    while ((count = noh_stage_jobs(s)) > 0) {
        for (uint32_t i = 0; i < count; i++) noh_stage_job(s, i);
    }
    return 0;
}

static void draw_bones(view_model *m, const noh_gl_camera *camera)
{
    for (uint32_t k = 0; k < kind_count(m); k++) {
        noh_skeleton skeleton;
        float *matrices = m->bones[k] ? figure_joints(m->figure, k, &skeleton) : NULL;
        if (matrices) bones_draw(m->bones[k], &skeleton, matrices, camera);
        free(matrices);
    }
}

int view_model_draw(view_model *m, const noh_gl_camera *camera)
{
    int status = m->show_bones ? 0 : figure_update_hair(m->figure);
    if (!status && !m->show_bones) status = figure_shade(m->figure);
    if (status) {
        return status;
    }
    canvas_begin(&m->canvas);
    if (m->show_bones) {
        draw_bones(m, camera);
        return 0;
    }
    return figure_draw(m->figure);
}
