/* figure.c: a figure is planned, made and deleted. */
#include "figure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "facing.h"

#define SETTLE_S 2.0

/* ---- its kinds ---- */

/* The skeleton that moves a node's mesh; NOH_NONE: rigid. */
static uint32_t skeleton_of(const noh_pack *pack, uint32_t mesh)
{
    noh_mesh m;
    noh_skin skin;
    (void)noh_pack_mesh_at(pack, mesh, &m, NULL);
    return noh_pack_skin_at(pack, m.header->skin, &skin, NULL) == NOH_OK ? skin.header->skeleton : NOH_NONE;
}

/* The nodes (meshes, in a pack without nodes) of a skeleton; the first skeleton also gets all rigid ones. */
static uint32_t list_nodes(const noh_pack *pack, uint32_t skeleton, uint32_t *nodes)
{
    const uint32_t count = pack->node_count ? pack->node_count : pack->runs[NOH_CHUNK_MESH].count;
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t mesh = pack->node_count ? pack->nodes[i].mesh : i;
        if (mesh != NOH_NONE) {
            const uint32_t of = skeleton_of(pack, mesh);
            if (of == skeleton || (of == NOH_NONE && !skeleton)) nodes[found++] = i;
        }
    }
    return found;
}

static int add_kind(figure *f, uint32_t skeleton, const uint32_t *nodes, uint32_t node_count)
{
    noh_kind_desc *k = &f->kinds[f->stage_desc.kind_count];
    const figure_desc *d = &f->desc;
    if (f->stage_desc.kind_count == NOH_STAGE_KINDS_MAX) {
        return tool_fail(d->file->path,
                         "too many meshes for a stage, which holds %u kinds of %u each: join them in the program that "
                         "made them",
                         NOH_STAGE_KINDS_MAX, NOH_STAGE_MESHES_MAX);
    }
    k->mesh = &d->file->pack;
    k->clips = d->clips && !d->more_clip_count ? &d->clips->pack : NULL;
    k->clip_packs = d->more_clip_count ? f->packs : d->clips ? NULL : &f->kinds[0].mesh; /* none of them */
    k->clip_pack_count = d->more_clip_count ? d->more_clip_count + 1u : 0;
    k->skeleton = k->mesh->runs[NOH_CHUNK_SKELETON].count ? skeleton : NOH_NONE;
    k->nodes = nodes;
    k->node_count = node_count;
    k->levels_by_number = 1;
    k->finest_level = d->level;
    k->actor_count = k->near_count = d->actor_count ? d->actor_count : 1u;
    k->layers = d->layers ? d->layers : f->own_layers;
    k->layer_count = d->layers ? d->layer_count : d->face_layer ? 2u : 1u;
    k->inertia = d->inertia;
    k->graphs = noh_graph_module(d->graphs);
    k->root_axes = d->root_axes;
    k->unpickable = !d->pickable && !d->marks;
    if (!d->without_springs) k->springs = noh_springs_module(NULL);
    k->weight_rules = d->weight_rules;
    f->stage_desc.kind_count++;
    return 0;
}

/* One kind, or several where there are more meshes than one can have. */
static int add_kinds(figure *f, uint32_t skeleton, const uint32_t *nodes, uint32_t count)
{
    int status = 0;
    for (uint32_t i = 0; i < count && !status; i += NOH_STAGE_MESHES_MAX) {
        status = add_kind(f, skeleton, nodes + i, count - i < NOH_STAGE_MESHES_MAX ? count - i : NOH_STAGE_MESHES_MAX);
    }
    return status;
}

static int list_kinds(figure *f, int draws)
{
    const noh_pack *pack = &f->desc.file->pack;
    const uint32_t skeletons = pack->runs[NOH_CHUNK_SKELETON].count ? pack->runs[NOH_CHUNK_SKELETON].count : 1u;
    uint32_t *next;
    int status = 0;
    f->nodes = calloc((size_t)pack->node_count + pack->runs[NOH_CHUNK_MESH].count + 1u, sizeof *f->nodes);
    if (!f->nodes) {
        return tool_fail(f->desc.file->path, "out of memory");
    }
    next = f->nodes;
    for (uint32_t s = 0; s < skeletons && !status; s++) {
        const uint32_t count = list_nodes(pack, s, next);
        status = !draws && !count ? add_kind(f, s, next, 0) : add_kinds(f, s, next, count);
        next += count;
    }
    if (!status && !f->stage_desc.kind_count) {
        status = tool_fail(f->desc.file->path, "the pack has nothing to draw");
    }
    return status;
}

/* The largest number over all kinds. */
static uint32_t count_targets(const figure *f)
{
    const noh_pack *pack = &f->desc.file->pack;
    uint32_t most = 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        uint32_t targets = 0;
        for (uint32_t i = 0; i < f->kinds[k].node_count; i++) {
            const uint32_t node = f->kinds[k].nodes[i];
            noh_mesh mesh;
            (void)noh_pack_mesh_at(pack, pack->node_count ? pack->nodes[node].mesh : node, &mesh, NULL);
            targets += mesh.header->target_count;
        }
        most = targets > most ? targets : most;
    }
    return most;
}

static void set_held(figure *f)
{
    uint32_t held = f->desc.held_float_count == FIGURE_HELD_ALL ? count_targets(f) : f->desc.held_float_count;
    held = held > NOH_FLOATS_MAX ? NOH_FLOATS_MAX : held;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        f->kinds[k].held_float_count = held ? held : NOH_NONE;
    }
}

static void add_faces(figure *f)
{
    f->faces_found = figure_find_faces(f->kinds, f->stage_desc.kind_count, f->faces);
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        if (f->faces_found >> k & 1u) f->kinds[k].face = noh_face_module(&f->faces[k]);
    }
}

/* ---- its bytes ---- */

/* Clips that no kind can play: why. */
static int check_clips(const figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        noh_clip_bank_desc bank;
        noh_clip_bank_needs needs;
        memset(&bank, 0, sizeof bank);
        bank.mesh = f->kinds[k].mesh;
        bank.clips = f->kinds[k].clips;
        bank.skeleton = f->kinds[k].skeleton;
        if (f->desc.more_clip_count || f->plan.kinds[k].segment_count ||
            noh_clip_bank_measure(&bank, &needs, &error) == NOH_OK)
            return 0;
    }
    return tool_fail(f->desc.clips->path, "for %s: %s", f->desc.file->path, error.what);
}

int figure_tier(const char *text, noh_shading *shading)
{
    const int phone = strcmp(text, "phone") == 0;
    *shading = phone ? NOH_SHADING_PHONE : NOH_SHADING_FULL;
    return phone || strcmp(text, "full") == 0 ? 0 : tool_usage("--tier must be full or phone, not '%s'", text);
}

int figure_plan(figure *f, const figure_desc *desc, const noh_gl_caps *caps)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_stage_desc *d = &f->stage_desc;
    int status;
    memset(f, 0, sizeof *f);
    f->desc = *desc;
    f->facing = pack_facing(&desc->file->pack);
    f->own_layers[0] = (noh_layer_desc){ "body", NOH_LAYER_BASE, NULL, NULL, desc->track_count };
    f->own_layers[1] = (noh_layer_desc){ "face", NOH_LAYER_OVER, "", NULL, desc->track_count };
    for (uint32_t i = 0; desc->more_clip_count && i <= desc->more_clip_count; i++) {
        f->packs[i] = i ? &desc->more_clips[i - 1u].pack : &desc->clips->pack;
    }
    d->kinds = f->kinds;
    d->full_detail = !desc->by_error;
    d->lod = desc->lod;
    d->tangents = desc->tangents || desc->view == NOH_VIEW_TANGENT;
    d->halves = desc->accumulate == NOH_ACCUMULATE_F16 ? 1 : desc->accumulate == NOH_ACCUMULATE_F32 ? -1 : 0;
    d->morph_path = (uint32_t)desc->path;
    d->morph_sums = desc->sums;
    d->shading = desc->shading;
    d->user_values = desc->complexions ? NOH_USER_COMPLEXION : 0;
    d->light = desc->light && caps ? &desc->light->desc : NULL;
    d->without_transfer = desc->light && desc->light->without_transfer;
    d->without_depth = !d->light || !d->light->shadow_px;
    d->without_shader = desc->view != NOH_VIEW_LIT && d->without_depth; /* its own draws shadows */
    d->gpu = caps ? &noh_stage_on_gl : NULL;
    status = figure_check_level(desc->file, desc->level);
    if (!status) status = list_kinds(f, caps != NULL);
    if (!status) {
        set_held(f);
        if (desc->alive) add_faces(f);
        if (desc->body) status = figure_body_add(desc->body, desc->file->path, f->kinds, d->kind_count);
    }
    if (!status) {
        figure_want_fall(f);
        figure_add_rest(f);
        status = figure_add_hair(f);
    }
    if (!status) {
        status = noh_stage_plan_make(d, caps, &f->plan, &error) ? tool_fail_error(desc->file->path, &error) : 0;
    }
    if (!status && desc->clips && desc->clips->pack.runs[NOH_CHUNK_CLIP].count) status = check_clips(f);
    if (status) figure_plan_free(f);
    return status;
}

void figure_plan_free(figure *f)
{
    free(f->nodes);
    memset(f, 0, sizeof *f);
}

void figure_bytes(const figure *f, uint64_t *cpu_bytes, uint64_t *gpu_bytes)
{
    figure_hair_bytes(f, cpu_bytes, gpu_bytes);
    *cpu_bytes += f->plan.cpu_bytes;
    *gpu_bytes += f->plan.gpu_bytes;
}

/* ---- its stage ---- */

static int open_stage(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_device device;
    const size_t bytes = (size_t)f->plan.cpu_bytes;
    f->memory = malloc(bytes);
    if (!f->memory) {
        return tool_fail(f->desc.file->path, "out of memory");
    }
    if (f->g) device = (noh_gl_device){ &f->g->gl, &f->g->caps, &f->g->ledger, log, sizeof log };
    if (noh_stage_init(f->memory, bytes, f->g ? &device : NULL, &f->stage_desc, &f->plan, &f->stage, &error)) {
        fputs(log, stderr);
        return tool_fail_error(f->desc.file->path, &error);
    }
    return 0;
}

static int open_shader(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    const noh_gl_shader_desc desc = { .view = f->desc.view };
    size_t bytes;
    if (!f->g || f->desc.view == NOH_VIEW_LIT) {
        return 0;
    }
    bytes = noh_stage_shader_size(f->stage);
    f->shader_memory = malloc(bytes);
    if (!f->shader_memory) {
        return tool_fail("renderer", "out of memory");
    }
    if (noh_stage_shader_create(f->stage, f->shader_memory, bytes, &desc, log, sizeof log, &f->shader, &error)) {
        fputs(log, stderr);
        return tool_fail_error("renderer", &error);
    }
    return 0;
}

static int open_backdrop(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_device device;
    if (!f->g || !f->desc.light) {
        return 0;
    }
    device = (noh_gl_device){ &f->g->gl, &f->g->caps, &f->g->ledger, log, sizeof log };
    if (noh_backdrop_create(&device, 0, &f->backdrop, &error)) {
        fputs(log, stderr);
        return tool_fail_error("backdrop", &error);
    }
    return 0;
}

static int open_actors(figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        if (noh_stage_spawn(f->stage, k, NULL, &f->actors[k], &error)) {
            return tool_fail_error(f->desc.file->path, &error);
        }
    }
    const figure_body *body = f->desc.body;
    const int status = body ? figure_body_place(body, f->stage, f->kinds, f->actors, f->stage_desc.kind_count) : 0;
    if (status || figure_set_look(f, &f->look)) return status ? status : EXIT_FAILED;
    return body && body->has_faces ? figure_live(f, SETTLE_S, 0.0) : 0; /* eyes take their time to turn */
}

int figure_set_look(figure *f, const noh_appearance *look)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    f->look = *look;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        if (noh_actor_set_appearance(f->stage, f->actors[k], &f->look, &error)) {
            return tool_fail_error(f->desc.file->path, &error);
        }
    }
    return 0;
}

int figure_open(figure *f, const figure_desc *desc, gpu *g)
{
    int status = figure_plan(f, desc, g ? &g->caps : NULL);
    if (status) {
        return status;
    }
    f->g = g;
    status = open_stage(f);
    if (!status) status = open_shader(f);
    if (!status) status = open_backdrop(f);
    if (!status && desc->body) status = figure_body_open_gl(desc->body, g);
    if (!status) status = figure_open_hair(f);
    if (!status) status = open_actors(f);
    if (!status) status = figure_open_floor(f);
    if (!status) status = figure_open_blobs(f);
    if (!status) status = figure_open_decals(f);
    if (status) figure_close(f);
    return status;
}

void figure_close(figure *f)
{
    if (f->shader) noh_stage_shader_delete(f->shader);
    noh_backdrop_delete(&f->backdrop);
    noh_stage_blob_delete(&f->blob);
    noh_stage_floor_delete(&f->level);
    figure_close_decals(f);
    if (f->desc.body) figure_body_close_gl(f->desc.body);
    drawn_hair_close(&f->hair);
    if (f->stage) noh_stage_delete(f->stage);
    free(f->shader_memory);
    free(f->memory);
    figure_plan_free(f);
}

int figure_restore(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_result result = noh_stage_restore(f->stage, &error);
    if (!result && f->shader) result = noh_stage_shader_restore(f->shader, log, sizeof log, &error);
    if (!result && f->backdrop.drawable.gl) result = noh_backdrop_restore(&f->backdrop, log, sizeof log, &error);
    if (!result && f->blob.drawable.gl) result = noh_stage_blob_restore(&f->blob, log, sizeof log, &error);
    if (!result && f->level.drawable.gl) result = noh_stage_floor_restore(&f->level, log, sizeof log, &error);
    if (!result && f->decals.drawable.gl) result = figure_restore_decals(f, log, sizeof log, &error);
    if (!result) result = drawn_hair_restore(&f->hair, log, sizeof log, &error);
    if (result) {
        fputs(log, stderr);
        return tool_fail_error(f->desc.file->path, &error);
    }
    return 0;
}

int figure_reset(figure *f)
{
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        (void)noh_stage_despawn(f->stage, f->actors[k], NULL);
    }
    return open_actors(f);
}

/* ---- frames ---- */

int figure_frame(figure *f, const noh_stage_view *views, uint32_t view_count)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_result result = noh_stage_step(f->stage, 0, NULL, NULL, &error);
    uint32_t jobs;
    if (!result) result = noh_stage_frame_begin(f->stage, views, view_count, &error);
    while (!result && (jobs = noh_stage_jobs(f->stage)) > 0) {
        for (uint32_t i = 0; i < jobs; i++) noh_stage_job(f->stage, i);
    }
    if (!result) result = noh_stage_frame_end(f->stage, &error);
    if (result) return tool_fail_error(f->desc.file->path, &error);
    figure_update_hair(f);
    return 0;
}

int figure_pose(figure *f)
{
    const noh_appearance own = f->look;
    noh_appearance posed = own;
    int status;
    posed.posed = 1;
    status = figure_set_look(f, &posed);
    if (!status) status = figure_frame(f, NULL, 0);
    return status ? status : figure_set_look(f, &own);
}

noh_stage_view figure_view(const noh_gl_camera *camera, uint32_t height)
{
    noh_stage_view view;
    memset(&view, 0, sizeof view);
    memcpy(view.view_projection, camera->view_projection, sizeof view.view_projection);
    memcpy(view.eye, camera->eye, sizeof view.eye);
    memcpy(view.light, camera->key, sizeof view.light);
    view.height_px = height;
    return view;
}

uint32_t figure_views(figure *f, const noh_gl_camera *camera, uint32_t height, noh_stage_view views[2])
{
    lighting *light = f->desc.light;
    views[0] = f->seen = figure_view(camera, height);
    if (!light || !f->g) {
        return 1;
    }
    noh_stage_set_lighting(f->stage, &light->told);
    if (!light->desc.shadow_px) {
        return 1;
    }
    const bounds box = figure_bounds(f, FRAME_FULL);
    views[1] = lighting_shadow_view(light, &box);
    return 2;
}

int figure_shade(figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    if (!f->desc.light || !f->g || !f->desc.light->desc.shadow_px) {
        return 0;
    }
    f->desc.light->told.has_floor = f->shows_floor;
    f->desc.light->told.floor = f->floor;
    if (noh_stage_draw_shadow(f->stage, 1, &error)) return tool_fail_error(f->desc.file->path, &error);
    drawn_hair_draw_shadow(&f->hair, f->stage, 1);
    return 0;
}

int figure_look(figure *f, const noh_gl_camera *camera, uint32_t height)
{
    noh_stage_view views[2];
    const int status = figure_frame(f, views, figure_views(f, camera, height, views));
    return status ? status : figure_shade(f);
}

static void draw_backdrop(const figure *f)
{
    const lighting *l = f->desc.light;
    if (!f->backdrop.drawable.gl || l->background == BACKGROUND_PLAIN || f->desc.view != NOH_VIEW_LIT) {
        return;
    }
    noh_backdrop_draw(&f->backdrop, l->background == BACKGROUND_LIGHT ? NOH_BACKDROP_LIGHT : NOH_BACKDROP_GRADIENT,
                      noh_stage_light_of(f->stage), &l->told, &f->seen);
}

/* Opaque meshes, then marks and hair on them, then blended meshes over both. */
static noh_result draw_in_parts(figure *f, noh_error *error)
{
    noh_result result = noh_stage_draw(f->stage, NOH_PASS_OPAQUE, 0, NULL, error);
    if (!result && figure_draw_decals(f)) return noh_fail(error, NOH_ERR_GL, "marks could not be drawn", 0, 0);
    if (!result) drawn_hair_draw(&f->hair, f->stage, 0, NOH_PASS_OPAQUE);
    if (!result) result = noh_stage_draw(f->stage, NOH_PASS_BLENDED, 0, NULL, error);
    if (!result) drawn_hair_draw(&f->hair, f->stage, 0, NOH_PASS_BLENDED);
    return result;
}

int figure_draw(figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const int in_parts = !f->shader && (f->hair.heads || f->decals.drawable.gl);
    noh_result result;
    draw_backdrop(f);
    if (f->desc.body) figure_body_draw(f->desc.body, &f->seen);
    if (f->shows_floor) figure_draw_floor(f);
    if (f->blob.drawable.gl && f->desc.view == NOH_VIEW_LIT) figure_draw_blobs(f);
    f->g->gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    result = in_parts ? draw_in_parts(f, &error) : noh_stage_draw(f->stage, NOH_PASS_COLOR, 0, f->shader, &error);
    f->g->gl.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    return result ? tool_fail_error(f->desc.file->path, &error) : 0;
}
