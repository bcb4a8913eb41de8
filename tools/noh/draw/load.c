#include "load.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

/* Instances per mesh: each drawn item of each copy of the scene has weights of its own. */
static uint32_t *count_instances(const pack_file *file, const scene *s, uint32_t copies)
{
    uint32_t *counts = calloc(file->pack.mesh_count + 1u, sizeof *counts);
    for (uint32_t i = 0; counts && i < s->item_count; i++) {
        counts[s->items[i].mesh] += copies ? copies : 1u;
    }
    return counts;
}

static noh_gl_morph_desc morph_desc(const pack_file *file, const scene *s, const load_options *o,
                                    const uint32_t *counts)
{
    noh_gl_morph_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = s->meshes;
    desc.mesh_count = file->pack.mesh_count;
    desc.instance_counts = counts;
    desc.path = o->path;
    desc.accumulate = o->accumulate;
    return desc;
}

static noh_gl_skin_desc skin_desc(const pack_file *file, const scene *s, const uint32_t *counts)
{
    noh_gl_skin_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = s->meshes;
    desc.mesh_count = file->pack.mesh_count;
    desc.instance_counts = counts;
    return desc;
}

/* Bytes of the palette of the largest skin; 0 if no drawn mesh is skinned. */
static size_t matrix_bytes(const pack_file *file, const scene *s)
{
    size_t most = 0;
    for (uint32_t i = 0; i < s->item_count; i++) {
        noh_skin skin;
        if (noh_pack_skin_at(&file->pack, s->meshes[s->items[i].mesh].header->skin, &skin, NULL) == NOH_OK) {
            size_t bytes = sizeof(float) * 12u * skin.header->joint_count;
            most = bytes > most ? bytes : most;
        }
    }
    return most;
}

/* ---- making it ---- */

static int create_pictures(load *l)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t i = 0; i < l->file->pack.texture_count; i++) {
        noh_texture texture;
        noh_pack_texture_at(&l->file->pack, i, &texture, NULL);
        if (noh_gl_picture_create(&l->g->gl, &l->g->ledger, &texture, &l->pictures[i], &error)) {
            return tool_fail_error(l->file->path, &error);
        }
    }
    return 0;
}

static int create_meshes(load *l)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t i = 0; i < l->file->pack.mesh_count; i++) {
        if (noh_gl_mesh_create(&l->g->gl, &l->g->ledger, &l->scene->meshes[i], &l->meshes[i], &error)) {
            return tool_fail_error(l->file->path, &error);
        }
    }
    return 0;
}

static int create_renderer(load *l, const load_options *o)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    noh_gl_renderer_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.view = o->view;
    desc.fades = o->fades;
    desc.layers_uint = noh_gl_morph_plan_of(l->morph.morph)->layer_format == GL_RGBA32UI;
    desc.meshes = l->scene->meshes;
    desc.mesh_count = l->file->pack.mesh_count;
    desc.palettes = l->skin.skin ? noh_gl_skin_plan_of(l->skin.skin)->mode : NOH_PALETTE_AUTO;
    if (noh_gl_renderer_create(&(noh_gl_device){ &l->g->gl, NULL, &l->g->ledger, log, sizeof log }, &desc, &l->renderer,
                               &error)) {
        fputs(log, stderr);
        return tool_fail_error("renderer", &error);
    }
    return 0;
}

static int open_skin(load *l, const uint32_t *counts)
{
    noh_gl_skin_desc desc = skin_desc(l->file, l->scene, counts);
    l->matrix_bytes = matrix_bytes(l->file, l->scene);
    if (!l->matrix_bytes) {
        return 0;
    }
    l->matrices = malloc(l->matrix_bytes);
    return l->matrices ? gpu_skin_open(&l->skin, l->g, &desc, l->file->path)
                       : tool_fail(l->file->path, "out of memory");
}

/* The k-th item that draws a mesh is its k-th instance. */
static void number_items(load *l, uint32_t *next)
{
    memset(next, 0, sizeof *next * l->file->pack.mesh_count);
    for (uint32_t i = 0; i < l->scene->item_count; i++) {
        uint32_t mesh = l->scene->items[i].mesh;
        l->item_instances[i] = noh_gl_morph_instance(l->morph.morph, mesh, next[mesh]++);
        l->lods[i].parts[0].to = 1.0f;
        l->lods[i].part_count = 1;
    }
}

int load_open(load *l, gpu *g, const pack_file *file, const scene *s, const load_options *o)
{
    uint32_t *counts = count_instances(file, s, o->instances);
    noh_gl_morph_desc desc = morph_desc(file, s, o, counts);
    int status = 0;
    memset(l, 0, sizeof *l);
    l->g = g;
    l->file = file;
    l->scene = s;
    l->meshes = calloc(file->pack.mesh_count + 1u, sizeof *l->meshes);
    l->pictures = calloc(file->pack.texture_count + 1u, sizeof *l->pictures);
    l->item_instances = calloc(s->item_count + 1u, sizeof *l->item_instances);
    l->lods = calloc(s->item_count + 1u, sizeof *l->lods);
    if (!counts || !l->meshes || !l->pictures || !l->item_instances || !l->lods) {
        status = tool_fail(file->path, "out of memory");
    } else if (s->item_count == 0) {
        status = tool_fail(file->path, "the pack has nothing to draw");
    }
    if (!status) status = create_meshes(l);
    if (!status) status = create_pictures(l);
    if (!status) status = gpu_morph_open(&l->morph, g, &desc, file->path);
    if (!status) status = open_skin(l, counts);
    if (!status) status = create_renderer(l, o);
    if (!status) number_items(l, counts);
    free(counts);
    if (status) {
        load_close(l);
    }
    return status;
}

void load_close(load *l)
{
    for (uint32_t i = 0; l->meshes && i < l->file->pack.mesh_count; i++) {
        noh_gl_mesh_delete(&l->g->gl, &l->g->ledger, &l->meshes[i]);
    }
    for (uint32_t i = 0; l->pictures && i < l->file->pack.texture_count; i++) {
        noh_gl_texture_delete(&l->g->gl, &l->g->ledger, &l->pictures[i]);
    }
    if (l->renderer.gl) {
        noh_gl_renderer_delete(&l->renderer);
    }
    gpu_morph_close(&l->morph);
    gpu_skin_close(&l->skin);
    free(l->matrices);
    free(l->meshes);
    free(l->pictures);
    free(l->item_instances);
    free(l->lods);
    memset(l, 0, sizeof *l);
}

/* ---- using it ---- */

static void update_joints(load *l)
{
    for (uint32_t i = 0; i < l->scene->item_count; i++) {
        noh_skin skin;
        if (noh_pack_skin_at(&l->file->pack, l->scene->meshes[l->scene->items[i].mesh].header->skin, &skin, NULL) ==
            NOH_OK) {
            scene_skin_matrices(l->scene, &skin, l->matrices);
            noh_gl_skin_set_matrices(l->skin.skin, l->item_instances[i], l->matrices);
        }
    }
    noh_gl_skin_update(l->skin.skin);
}

int load_update(load *l, noh_gl_morph_stats *stats)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t i = 0; i < l->scene->item_count; i++) {
        if (noh_gl_morph_set_weights(l->morph.morph, l->item_instances[i], l->scene->items[i].weights, &error)) {
            return tool_fail_error(l->file->path, &error);
        }
    }
    noh_gl_morph_update(l->morph.morph, stats);
    if (l->skin.skin) {
        update_joints(l);
    }
    return 0;
}

const noh_gl_skin_binding *load_skin_binding(const load *l, uint32_t item, noh_gl_skin_binding *out)
{
    if (l->scene->meshes[l->scene->items[item].mesh].header->skin == NOH_NONE) {
        return NULL;
    }
    *out = noh_gl_skin_binding_of(l->skin.skin, l->item_instances[item]);
    return out;
}
