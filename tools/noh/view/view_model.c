#include "view/view_model.h"
#include "view/view_setting.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "cli/message.h"

/* ---- the file ---- */

/* A model's pack, as view_load made it; its bytes are the model's from now on. */
static int open_converted(view_model *m, byte_buffer *converted)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    m->converted = *converted;
    memset(converted, 0, sizeof *converted);
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
    m->clips = calloc((size_t)m->clips_of->pack.runs[NOH_CHUNK_CLIP].count + 1u, sizeof *m->clips);
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
    for (uint32_t i = 0; i < m->file.pack.runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        (void)noh_pack_mesh_at(&m->file.pack, i, &mesh, NULL);
        for (uint32_t t = 0; t < mesh.header->target_count; t++) {
            m->delta_max = fmaxf(m->delta_max, mesh.targets[t].radius);
        }
    }
}

/* ---- the cost of a stage ---- */

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
    if (!status) status = setting_open(m, g, desc, &s);
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
    view_model *m = calloc(1, sizeof *m); /* opened objects keep its address */
    int status;
    if (!m || strlen(desc->path) >= sizeof m->path) {
        free(m);
        return tool_fail(desc->path, m ? "the path is too long" : "out of memory");
    }
    strcpy(m->path, desc->path);
    status = desc->converted ? open_converted(m, desc->converted) : pack_file_open_draft(&m->file, m->path);
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
    setting_close(&s);
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

int view_model_reload(view_model *m, gpu *g, const view_model_desc *desc)
{
    setting is, was = setting_of(m);
    int status = setting_open(m, g, desc, &is);
    if (!status && is.figure->stage_desc.kind_count != was.figure->stage_desc.kind_count) {
        status = tool_fail(m->path, "the pack is planned with other kinds");
    }
    if (!status) status = count_setting(m, g, &is);
    if (status) {
        setting_close(&is);
        (void)count_setting(m, g, &was);
        return status;
    }
    setting_carry(was.figure, is.figure);
    use_setting(m, &is, desc);
    setting_close(&was);
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
    int status = restore_bones(m, g);
    if (!status && !m->show_bones) status = figure_restore(m->figure);
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
    return m->show_bones ? joint_bounds(m) : figure_bounds(m->figure, FRAME_FULL);
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

/* The root's place: the body's clips averaged by weight, or the pose's root before any clip plays; for a graph, the
 * root of the last pose. */
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

void view_model_draw_bones(view_model *m, const noh_gl_camera *camera)
{
    for (uint32_t k = 0; k < kind_count(m); k++) {
        noh_skeleton skeleton;
        float *matrices = m->bones[k] ? figure_joints(m->figure, k, &skeleton) : NULL;
        if (matrices) bones_draw(m->bones[k], &skeleton, matrices, camera);
        free(matrices);
    }
}

/* The surface, or what replaces it. */
static int draw_surface(view_model *m, overlay *o, const view_over *over, const noh_gl_camera *camera)
{
    switch (over->skin) {
    case VIEW_SKIN_JOINTS: return overlay_draw(o, m->figure, OVERLAY_JOINTS, NOH_NONE, camera);
    case VIEW_SKIN_WEIGHTS: return overlay_draw(o, m->figure, OVERLAY_WEIGHTS, over->joint, camera);
    default: return figure_draw(m->figure);
    }
}

int view_model_draw(view_model *m, canvas *c, overlay *o, const view_over *over, const noh_gl_camera *camera)
{
    int status = 0;
    if (!m->show_bones) {
        figure_update_hair(m->figure);
        status = figure_shade(m->figure);
    }
    if (status) {
        return status;
    }
    canvas_begin(c);
    if (m->show_bones) {
        view_model_draw_bones(m, camera);
        return 0;
    }
    status = draw_surface(m, o, over, camera);
    if (!status && over->wireframe) status = overlay_draw(o, m->figure, OVERLAY_WIREFRAME, NOH_NONE, camera);
    if (!status && over->normals) status = overlay_draw(o, m->figure, OVERLAY_NORMALS, NOH_NONE, camera);
    if (!status && over->bones) {
        canvas_clear_depth(c);
        view_model_draw_bones(m, camera);
    }
    return status;
}
