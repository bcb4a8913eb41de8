/* parts_fixture.h: what a pack draws, joined by hand from the parts below the stage: meshes, textures, accumulators and
 * a renderer, on one gpu. For tests of these parts. */
#ifndef NOH_TESTS_SUPPORT_PARTS_FIXTURE_H
#define NOH_TESTS_SUPPORT_PARTS_FIXTURE_H

#include "support.h"

#include <stdlib.h>
#include <string.h>

#include "draw/camera.h"
#include "draw/figure.h"
#include "gpu/gpu.h"
#include "renderer.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/pack.h"
#include "noh/gl_device.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

#define PARTS_MAX 16u

/* A node with a mesh; in a pack without nodes a mesh. */
typedef struct part_item {
    const float *world;
    uint32_t mesh, instance; /* of the accumulators */
    float weights[NOH_TARGETS_MAX];
} part_item;

typedef struct parts {
    gpu *g;
    const pack_file *file;
    noh_mesh meshes[PARTS_MAX];
    noh_gl_mesh on_gl[PARTS_MAX];
    noh_gl_texture pictures[PARTS_MAX];
    uint32_t counts[PARTS_MAX]; /* instances of each mesh */
    part_item items[PARTS_MAX];
    uint32_t item_count;
    noh_gl_renderer renderer;
    gpu_morph morph;
} parts;

static inline void parts_list(parts *p)
{
    static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    const noh_pack *pack = &p->file->pack;
    const uint32_t count = pack->node_count ? pack->node_count : pack->runs[NOH_CHUNK_MESH].count;
    assert_true(pack->runs[NOH_CHUNK_MESH].count <= PARTS_MAX && pack->runs[NOH_CHUNK_TEXTURE].count <= PARTS_MAX);
    for (uint32_t i = 0; i < count; i++) {
        part_item *item = &p->items[p->item_count];
        const uint32_t mesh = pack->node_count ? pack->nodes[i].mesh : i;
        if (mesh == NOH_NONE) continue;
        assert_true(p->item_count < PARTS_MAX);
        item->mesh = mesh;
        item->world = pack->node_count ? pack->nodes[i].world : identity;
        p->counts[mesh]++;
        p->item_count++;
    }
}

/* instances: of everything, all but the first without an item. vertices: as noh_gl_morph_desc has it. */
static inline void parts_open_as(parts *p, gpu *g, const pack_file *file, noh_morph_path path,
                                 noh_accumulate accumulate, int vertices, uint32_t instances)
{
    const noh_pack *pack = &file->pack;
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
    uint32_t next[PARTS_MAX] = { 0 };
    noh_gl_renderer_desc renderer;
    noh_gl_morph_desc morph;
    memset(p, 0, sizeof *p);
    p->g = g;
    p->file = file;
    parts_list(p);
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        p->meshes[i] = test_mesh(pack, i);
        p->counts[i] *= instances;
        assert_int_equal(noh_gl_mesh_create(&g->gl, &g->ledger, &p->meshes[i], &p->on_gl[i], NULL), NOH_OK);
    }
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_texture texture;
        assert_int_equal(noh_pack_texture_at(pack, i, &texture, NULL), NOH_OK);
        assert_int_equal(noh_gl_picture_create(&g->gl, &g->ledger, &texture, &p->pictures[i], NULL), NOH_OK);
    }
    memset(&morph, 0, sizeof morph);
    morph.meshes = p->meshes;
    morph.mesh_count = pack->runs[NOH_CHUNK_MESH].count;
    morph.instance_counts = p->counts;
    morph.path = path;
    morph.accumulate = accumulate;
    morph.vertices = vertices;
    assert_int_equal(gpu_morph_open(&p->morph, g, &morph, file->path), 0);
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        assert_int_equal(noh_gl_morph_set_mesh(p->morph.morph, i, &p->on_gl[i], NULL), NOH_OK);
    }
    memset(&renderer, 0, sizeof renderer);
    renderer.layers_uint = noh_gl_morph_binding_of(p->morph.morph, 0).is_uint;
    renderer.meshes = p->meshes;
    renderer.mesh_count = pack->runs[NOH_CHUNK_MESH].count;
    assert_int_equal(renderer_create(&device, &renderer, &p->renderer, NULL), NOH_OK);
    for (uint32_t i = 0; i < p->item_count; i++) {
        const uint32_t mesh = p->items[i].mesh;
        p->items[i].instance = noh_gl_morph_instance(p->morph.morph, mesh, next[mesh]++);
    }
}

static inline void parts_open(parts *p, gpu *g, const pack_file *file, noh_morph_path path, noh_accumulate accumulate,
                              uint32_t instances)
{
    parts_open_as(p, g, file, path, accumulate, 0, instances);
}

static inline void parts_close(parts *p)
{
    for (uint32_t i = 0; i < p->file->pack.runs[NOH_CHUNK_MESH].count; i++) {
        noh_gl_mesh_delete(&p->g->gl, &p->g->ledger, &p->on_gl[i]);
    }
    for (uint32_t i = 0; i < p->file->pack.runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_gl_texture_delete(&p->g->gl, &p->g->ledger, &p->pictures[i]);
    }
    noh_gl_renderer_delete(&p->renderer);
    gpu_morph_close(&p->morph);
}

/* In a new context, with which g->gl was filled. */
static inline noh_result parts_restore(parts *p)
{
    const noh_gl_api *gl = &p->g->gl;
    noh_result result = NOH_OK;
    for (uint32_t i = 0; !result && i < p->file->pack.runs[NOH_CHUNK_MESH].count; i++) {
        result = noh_gl_mesh_restore(gl, &p->g->ledger, &p->on_gl[i], NULL);
    }
    for (uint32_t i = 0; !result && i < p->file->pack.runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_texture texture;
        (void)noh_pack_texture_at(&p->file->pack, i, &texture, NULL);
        result = noh_gl_picture_restore(gl, &p->g->ledger, &texture, &p->pictures[i], NULL);
    }
    if (!result) result = noh_gl_morph_restore(p->morph.morph, NULL, 0, NULL);
    for (uint32_t i = 0; !result && i < p->file->pack.runs[NOH_CHUNK_MESH].count; i++) {
        result = noh_gl_morph_set_mesh(p->morph.morph, i, &p->on_gl[i], NULL);
    }
    return result ? result : noh_gl_renderer_restore(&p->renderer, NULL, 0, NULL);
}

/* Upload the weights, and accumulate. */
static inline void parts_update(parts *p, noh_gl_morph_stats *stats)
{
    for (uint32_t i = 0; i < p->item_count; i++) {
        assert_int_equal(noh_gl_morph_set_weights(p->morph.morph, p->items[i].instance, p->items[i].weights, NULL),
                         NOH_OK);
    }
    noh_gl_morph_update(p->morph.morph, stats);
}

static inline void parts_draw_item(parts *p, noh_gl_renderer *r, uint32_t item, const noh_gl_lod *level, int pass)
{
    const part_item *at = &p->items[item];
    const noh_gl_morph_binding morph = noh_gl_morph_binding_of(p->morph.morph, at->instance);
    noh_gl_draw_mesh(r, &p->on_gl[at->mesh], at->world, &morph, NULL, level, p->pictures, pass);
}

static inline void parts_draw(parts *p, const noh_gl_camera *camera, const noh_gl_lod *level)
{
    noh_gl_draw_begin(&p->renderer, camera);
    for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
        for (uint32_t i = 0; i < p->item_count; i++) parts_draw_item(p, &p->renderer, i, level, pass);
    }
    noh_gl_draw_end(&p->renderer);
}

/* A camera that frames everything at rest. */
static inline void parts_camera(const parts *p, const char *camera, uint32_t side, noh_gl_camera *out)
{
    const view_options view = { .camera = camera, .width = side, .height = side };
    const figure_desc desc = { .file = p->file };
    figure f;
    bounds box;
    assert_int_equal(figure_open(&f, &desc, NULL), 0);
    assert_int_equal(figure_pose(&f), 0);
    box = figure_bounds(&f, FRAME_FULL);
    figure_close(&f);
    assert_int_equal(view_camera(&view, &box, out), 0);
}

#endif
