#include "crowd.h"

#include <stdio.h>
#include <string.h>

#include "cli/message.h"

/* ---- opening ---- */

/* A copy of the bank's set in which clips that end play ping-pong, so that every body keeps moving. A pack without
 * callback keys gets two per clip, so that the crowd always has events to fire. */
static void open_clips(crowd *c)
{
    const noh_clip_set *from = &c->bank->clips;
    c->set = *from;
    c->set.clips = c->clips;
    memcpy(c->clips, from->clips, from->clip_count * sizeof *c->clips);
    for (uint32_t m = 0; m < from->clip_count; m++) {
        if (c->clips[m].loop == NOH_LOOP_ONCE) {
            c->clips[m].loop = NOH_LOOP_PING_PONG;
        }
    }
    if (from->event_count) {
        return;
    }
    c->set.events = c->keys;
    for (uint32_t m = 0; m < from->clip_count; m++) {
        c->clips[m].first_event = c->set.event_count;
        c->clips[m].event_count = 2;
        for (uint32_t k = 0; k < 2; k++) {
            noh_event_key *key = &c->keys[c->set.event_count++];
            memset(key, 0, sizeof *key);
            key->tick = c->clips[m].duration_ticks / 4u * (1u + 2u * k);
        }
    }
}

/* Where the mesh's weights begin among the floats of a pose: those of the first node that draws it. */
static void find_weights(crowd *c)
{
    const uint32_t group = noh_clip_bank_mesh_group(c->bank, c->plan->mesh_index);
    c->first_weight = group == NOH_NONE ? NOH_NONE : c->bank->groups[group].first;
}

static noh_result open_characters(crowd *c, void *scratch, noh_error *error)
{
    const crowd_plan *p = c->plan;
    noh_character_desc desc = crowd_character_desc(&c->set);
    noh_result result = noh_character_scratch_init(scratch, p->scratch_bytes, &desc, &c->scratch, error);
    memset(c->bodies, 0, p->options.count * sizeof *c->bodies);
    for (uint32_t i = 0; i < p->options.count && !result; i++) {
        noh_character *made;
        desc.instance = i;
        result = noh_character_init(c->characters + i * p->character_bytes, p->character_bytes, &desc, &made, error);
    }
    return result;
}

/* The finest level that any pool holds, and all coarser ones. */
static noh_result open_meshes(crowd *c, void *morph, void *palettes, char *log, size_t log_bytes, noh_error *error)
{
    const crowd_plan *p = c->plan;
    const noh_gl_api *gl = &c->g->gl;
    noh_gl_skin_desc skin = { &p->mesh, 1, &p->options.count, NOH_PALETTE_TEXTURE };
    noh_result result = noh_gl_mesh_create(gl, &c->ledger, &p->views[0], &c->gl_mesh, error);
    memset(c->pictures, 0, p->mesh.pack->texture_count * sizeof *c->pictures);
    for (uint32_t i = 0; i < p->mesh.pack->texture_count && !result; i++) {
        noh_texture texture;
        noh_pack_texture_at(p->mesh.pack, i, &texture, NULL);
        result = noh_gl_picture_create(gl, &c->ledger, &texture, &c->pictures[i], error);
    }
    if (!result) {
        result = noh_gl_morph_init(morph, (size_t)p->morph.cpu_bytes,
                                   &(noh_gl_device){ gl, &c->g->caps, &c->ledger, log, log_bytes }, &p->morph_desc,
                                   &c->morph, error);
    }
    if (!result) {
        result = noh_gl_skin_init(palettes, (size_t)p->skin_plan.cpu_bytes,
                                  &(noh_gl_device){ gl, &c->g->caps, &c->ledger, NULL, 0 }, &skin, &c->palettes, error);
    }
    return result;
}

static noh_result open_renderer(crowd *c, char *log, size_t log_bytes, noh_error *error)
{
    noh_gl_renderer_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.view = c->plan->options.view;
    desc.layers_uint = c->plan->morph.layer_format == GL_RGBA32UI;
    desc.meshes = &c->plan->mesh;
    desc.mesh_count = 1;
    desc.palettes = c->plan->skin_plan.mode;
    desc.crowds = 1;
    desc.fades = !c->plan->options.plain;
    desc.fewer_influences = !c->plan->options.plain;
    return noh_gl_renderer_create(&(noh_gl_device){ &c->g->gl, NULL, &c->ledger, log, log_bytes }, &desc, &c->renderer,
                                  error);
}

static int open_all(crowd *c, noh_arena *arena)
{
    const crowd_plan *p = c->plan;
    const noh_lod_pools_desc pools_desc = crowd_pools_desc(p);
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    crowd_parts parts;
    noh_result result;
    crowd_carve(arena, p, c, &parts);
    c->used_bytes = arena->used;
    result = noh_clip_bank_init(parts.bank, p->bank_needs.bytes, &p->bank_desc, &c->bank, &error);
    if (!result) {
        (void)noh_skin_skeleton(&p->skin, &c->bank->skeleton, c->inverse_bind,
                                &c->skeleton); /* with one skin, updates can multiply by it */
        open_clips(c);
        find_weights(c);
        result = open_characters(c, parts.scratch, &error);
    }
    if (!result) result = noh_lod_pools_init(parts.pools, p->pools_bytes, &pools_desc, &c->pools, &error);
    if (!result) result = noh_schedule_init(parts.schedule, p->schedule_bytes, p->options.count, &c->schedule, &error);
    if (!result) result = open_meshes(c, parts.morph, parts.palettes, log, sizeof log, &error);
    if (!result) result = open_renderer(c, log, sizeof log, &error);
    if (result) {
        fputs(log, stderr);
        return tool_fail_error(c->file->path, &error);
    }
    return crowd_place(c, parts.lod);
}

int crowd_open(crowd *c, const crowd_plan *plan, void *memory, size_t bytes, gpu *g, const pack_file *file)
{
    noh_arena arena = noh_arena_over(memory, bytes);
    int status;
    if (bytes < plan->cpu_bytes) {
        return tool_fail(file->path, "the crowd needs %llu bytes", (unsigned long long)plan->cpu_bytes);
    }
    memset(c, 0, sizeof *c);
    c->plan = plan;
    c->g = g;
    c->file = file;
    c->unculled = plan->options.unculled;
    status = open_all(c, &arena);
    if (status) {
        crowd_close(c);
    }
    return status;
}

void crowd_close(crowd *c)
{
    const noh_gl_api *gl = &c->g->gl;
    if (c->renderer.gl) noh_gl_renderer_delete(&c->renderer);
    if (c->palettes) noh_gl_skin_delete(c->palettes);
    if (c->morph) noh_gl_morph_delete(c->morph);
    for (uint32_t i = 0; c->gl_mesh.vertex_array && i < c->plan->mesh.pack->texture_count; i++) {
        noh_gl_texture_delete(gl, &c->ledger, &c->pictures[i]);
    }
    noh_gl_mesh_delete(gl, &c->ledger, &c->gl_mesh);
    memset(c, 0, sizeof *c);
}

noh_character *crowd_character(const crowd *c, uint32_t body)
{
    return (noh_character *)(void *)(c->characters + body * c->plan->character_bytes);
}
