/* The page's program: one pack, its targets and clips by number, in memory whose size was known
 * when the page was built. page.js calls the web_* functions.
 *
 * NOH_WEB_PACK_BYTES and NOH_WEB_MEMORY_BYTES come from the Makefile, which asks `noh budget`. */
#include <emscripten.h>
#include <string.h>

#include "canvas.h"
#include "context.h"
#include "noh.h"

#define MESHES_MAX 64u
#define PICTURES_MAX 64u
#define ITEMS_MAX 128u
#define NAMES_MAX NOH_TARGETS_MAX
#define WEIGHTS_MAX 8192u /* of all items together */
#define SAMPLES 4u

static uint8_t pack_bytes[NOH_WEB_PACK_BYTES] __attribute__((aligned(64)));
static uint8_t memory[NOH_WEB_MEMORY_BYTES] __attribute__((aligned(16)));

typedef struct item {
    uint32_t node, mesh, instance, first_weight;
} item;

static struct web {
    noh_platform_context *context;
    noh_gl_api gl;
    noh_gl_caps caps;
    noh_gl_ledger ledger;
    noh_error error;
    noh_pack pack;
    noh_mesh views[MESHES_MAX];
    noh_gl_mesh meshes[MESHES_MAX];
    noh_gl_texture pictures[PICTURES_MAX];
    uint32_t instance_counts[MESHES_MAX];
    item items[ITEMS_MAX];
    uint32_t item_count, weight_count, name_count;
    const char *names[NAMES_MAX];
    float weights[WEIGHTS_MAX];
    noh_gl_morph *morph;
    noh_gl_renderer renderer;
    web_canvas canvas;
    noh_gl_camera camera;
    float bounds[6];
} web;

/* ---- the pack ---- */

/* Where the page puts the file; NULL where it is larger than the page was built for. */
EMSCRIPTEN_KEEPALIVE void *web_pack(uint32_t bytes)
{
    return bytes <= sizeof pack_bytes ? pack_bytes : NULL;
}

static noh_result add_item(uint32_t node, uint32_t mesh)
{
    const noh_mesh *m = &web.views[mesh];
    uint32_t count = m->header->target_count;
    const float *defaults = m->weights;
    if (web.item_count == ITEMS_MAX || web.weight_count + count > WEIGHTS_MAX) {
        return noh_fail(&web.error, NOH_ERR_LIMIT, "more meshes or weights than the page has room for", node, 0);
    }
    if (node != NOH_NONE && web.pack.nodes[node].first_weight != NOH_NONE) {
        defaults = web.pack.node_weights + web.pack.nodes[node].first_weight;
    }
    item *to = &web.items[web.item_count++];
    to->node = node;
    to->mesh = mesh;
    to->instance = web.instance_counts[mesh]++;
    to->first_weight = web.weight_count;
    memcpy(web.weights + web.weight_count, defaults, sizeof *defaults * count);
    web.weight_count += count;
    return NOH_OK;
}

static void add_names(const noh_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const char *name = noh_pack_string(&web.pack, mesh->targets[t].name);
        uint32_t i = 0;
        while (i < web.name_count && strcmp(web.names[i], name) != 0) i++;
        if (i == web.name_count && i < NAMES_MAX) web.names[web.name_count++] = name;
    }
}

static noh_result list_pack(void)
{
    const noh_pack *pack = &web.pack;
    noh_result result = NOH_OK;
    if (pack->mesh_count > MESHES_MAX || pack->texture_count > PICTURES_MAX) {
        return noh_fail(&web.error, NOH_ERR_LIMIT, "more meshes or textures than the page has room for", pack->mesh_count, MESHES_MAX);
    }
    for (uint32_t i = 0; i < pack->mesh_count; i++) {
        noh_pack_mesh(pack, i, &web.views[i]);
        add_names(&web.views[i]);
    }
    for (uint32_t n = 0; n < pack->node_count && !result; n++) {
        if (pack->nodes[n].mesh != NOH_NONE) result = add_item(n, pack->nodes[n].mesh);
    }
    for (uint32_t i = 0; i < pack->mesh_count && !pack->node_count && !result; i++) result = add_item(NOH_NONE, i);
    if (!result && !web.item_count) result = noh_fail(&web.error, NOH_ERR_DATA, "the pack has nothing to draw", 0, 0);
    return result;
}

static const float *world_of(const item *it)
{
    static const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    return it->node == NOH_NONE ? identity : web.pack.nodes[it->node].world;
}

/* Of the rest pose, in the world. */
static void measure(void)
{
    int first = 1;
    for (uint32_t i = 0; i < web.item_count; i++) {
        const noh_mesh *mesh = &web.views[web.items[i].mesh];
        const float *w = world_of(&web.items[i]);
        for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
            const float *p = mesh->positions + 3 * (size_t)v;
            for (int c = 0; c < 3; c++) {
                float x = w[4 * c] * p[0] + w[4 * c + 1] * p[1] + w[4 * c + 2] * p[2] + w[4 * c + 3];
                if (first || x < web.bounds[c]) web.bounds[c] = x;
                if (first || x > web.bounds[3 + c]) web.bounds[3 + c] = x;
            }
            first = 0;
        }
    }
}

/* ---- loading ---- */

static noh_result load_meshes(void)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < web.pack.mesh_count && !result; i++) {
        result = noh_gl_mesh_create(&web.gl, &web.ledger, &web.views[i], &web.meshes[i], &web.error);
    }
    for (uint32_t i = 0; i < web.pack.texture_count && !result; i++) {
        noh_texture texture;
        noh_pack_texture(&web.pack, i, &texture);
        result = noh_gl_picture_create(&web.gl, &web.ledger, &texture, &web.pictures[i], &web.error);
    }
    return result;
}

static noh_result load_morph(noh_morph_path path)
{
    noh_gl_morph_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = web.views;
    desc.mesh_count = web.pack.mesh_count;
    desc.instance_counts = web.instance_counts;
    desc.path = path;
    noh_result result = noh_gl_morph_init(memory, sizeof memory, &web.gl, &web.caps, &web.ledger, &desc, &web.morph, NULL, 0, &web.error);
    for (uint32_t i = 0; i < web.item_count && !result; i++) {
        web.items[i].instance = noh_gl_morph_instance(web.morph, web.items[i].mesh, web.items[i].instance);
    }
    return result;
}

static noh_result open_context(void)
{
    if (noh_platform_web.create(NULL, &web.context, NULL, 0)) {
        return noh_fail(&web.error, NOH_ERR_UNSUPPORTED, "this browser gives no WebGL 2 context", 0, 0);
    }
    noh_result result = noh_gl_api_load(&web.gl, noh_platform_web.get_proc, web.context, &web.error);
    return result ? result : noh_gl_caps_probe(&web.gl, &web.caps, &web.error);
}

/* path: a noh_morph_path. 0, or a noh_result: web_error says what. */
EMSCRIPTEN_KEEPALIVE int web_open(uint32_t bytes, int path)
{
    noh_result result = noh_pack_open(pack_bytes, bytes, &web.pack, &web.error);
    if (!result) result = list_pack();
    if (!result) result = open_context();
    if (!result) result = load_meshes();
    if (!result) result = load_morph((noh_morph_path)path);
    if (!result) {
        int is_uint = noh_gl_morph_plan_of(web.morph)->layer_format == GL_RGBA32UI;
        result = noh_gl_renderer_create(&web.gl, &web.ledger, NOH_VIEW_LIT, is_uint, &web.renderer, NULL, 0, &web.error);
    }
    if (!result) measure();
    return (int)result;
}

/* After the browser took the context away and gave it back: everything again out of the pack. */
EMSCRIPTEN_KEEPALIVE int web_restore(void)
{
    noh_web_enable_extensions(web.context);
    web_canvas_close(&web.canvas, noh_gl_lost_api());
    noh_result result = noh_gl_api_load(&web.gl, noh_platform_web.get_proc, web.context, &web.error);
    for (uint32_t i = 0; i < web.pack.mesh_count && !result; i++) {
        result = noh_gl_mesh_restore(&web.gl, &web.ledger, &web.meshes[i], &web.error);
    }
    for (uint32_t i = 0; i < web.pack.texture_count && !result; i++) {
        noh_texture texture;
        noh_pack_texture(&web.pack, i, &texture);
        result = noh_gl_picture_restore(&web.gl, &web.ledger, &texture, &web.pictures[i], &web.error);
    }
    if (!result) result = noh_gl_morph_restore(web.morph, NULL, 0, &web.error);
    if (!result) result = noh_gl_renderer_restore(&web.renderer, NULL, 0, &web.error);
    return (int)result;
}

/* ---- what the page asks and sets ---- */

EMSCRIPTEN_KEEPALIVE const char *web_error(void) { return web.error.what; }
EMSCRIPTEN_KEEPALIVE const char *web_renderer(void) { return web.caps.renderer; }
EMSCRIPTEN_KEEPALIVE const char *web_path(void) { return noh_morph_path_name(noh_gl_morph_plan_of(web.morph)->path); }
EMSCRIPTEN_KEEPALIVE uint32_t web_gpu_bytes(void) { return (uint32_t)noh_gl_ledger_bytes(&web.ledger); }
EMSCRIPTEN_KEEPALIVE uint32_t web_memory_bytes(void) { return (uint32_t)noh_gl_morph_plan_of(web.morph)->cpu_bytes; }
EMSCRIPTEN_KEEPALIVE uint32_t web_static_bytes(void) { return (uint32_t)(sizeof pack_bytes + sizeof memory); }
EMSCRIPTEN_KEEPALIVE float *web_bounds(void) { return web.bounds; }
EMSCRIPTEN_KEEPALIVE float *web_camera(void) { return web.camera.view_projection; }

EMSCRIPTEN_KEEPALIVE uint32_t web_target_count(void) { return web.name_count; }
EMSCRIPTEN_KEEPALIVE const char *web_target_name(uint32_t i) { return web.names[i]; }

EMSCRIPTEN_KEEPALIVE void web_set_weight(uint32_t target, float weight)
{
    for (uint32_t i = 0; i < web.item_count; i++) {
        const noh_mesh *mesh = &web.views[web.items[i].mesh];
        uint32_t t = noh_mesh_find_target(mesh, web.names[target]);
        if (t < mesh->header->target_count) web.weights[web.items[i].first_weight + t] = weight;
    }
}

/* The first drawn mesh that has the target. */
EMSCRIPTEN_KEEPALIVE float web_weight(uint32_t target)
{
    for (uint32_t i = 0; i < web.item_count; i++) {
        const noh_mesh *mesh = &web.views[web.items[i].mesh];
        uint32_t t = noh_mesh_find_target(mesh, web.names[target]);
        if (t < mesh->header->target_count) return web.weights[web.items[i].first_weight + t];
    }
    return 0.0f;
}

EMSCRIPTEN_KEEPALIVE uint32_t web_clip_count(void) { return web.pack.clip_count; }

EMSCRIPTEN_KEEPALIVE const char *web_clip_name(uint32_t i)
{
    noh_weight_clip clip;
    return noh_pack_weight_clip(&web.pack, i, &clip) == NOH_OK ? clip.name : "";
}

EMSCRIPTEN_KEEPALIVE float web_clip_seconds(uint32_t i)
{
    noh_weight_clip clip;
    return noh_pack_weight_clip(&web.pack, i, &clip) == NOH_OK ? clip.header->duration_s : 0.0f;
}

EMSCRIPTEN_KEEPALIVE void web_set_clip(uint32_t index, float time_s)
{
    noh_weight_clip clip;
    if (noh_pack_weight_clip(&web.pack, index, &clip)) return;
    for (uint32_t c = 0; c < clip.header->channel_count; c++) {
        for (uint32_t i = 0; i < web.item_count; i++) {
            if (web.items[i].node == clip.channels[c].node) {
                noh_weight_clip_sample(&clip, c, time_s, web.weights + web.items[i].first_weight);
            }
        }
    }
}

/* ---- a frame ---- */

static void draw_items(void)
{
    noh_gl_draw_begin(&web.renderer, &web.camera);
    for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
        for (uint32_t i = 0; i < web.item_count; i++) {
            const item *it = &web.items[i];
            noh_gl_morph_binding binding = noh_gl_morph_binding_of(web.morph, it->instance);
            noh_gl_draw_mesh(&web.renderer, &web.meshes[it->mesh], world_of(it), &binding, web.pictures, pass);
        }
    }
    noh_gl_draw_end(&web.renderer);
}

/* 0, or a noh_result: web_error says what. A lost context is not an error: nothing is drawn. */
EMSCRIPTEN_KEEPALIVE int web_draw(void)
{
    uint32_t width, height;
    if (noh_platform_web.present(web.context)) return 0;
    noh_platform_web.size(web.context, &width, &height);
    if (width != web.canvas.width || height != web.canvas.height) {
        uint32_t samples = web.caps.samples_max < SAMPLES ? web.caps.samples_max : SAMPLES;
        noh_result result = web_canvas_open(&web.canvas, &web.gl, &web.ledger, width, height, samples, &web.error);
        if (result) return (int)result;
    }
    for (uint32_t i = 0; i < web.item_count; i++) {
        if (noh_gl_morph_weights(web.morph, web.items[i].instance, web.weights + web.items[i].first_weight, &web.error)) {
            return NOH_ERR_ARG;
        }
    }
    noh_gl_morph_update(web.morph, NULL);
    web_canvas_begin(&web.canvas);
    draw_items();
    web_canvas_show(&web.canvas);
    GLenum code = noh_gl_error_take(&web.gl);
    return code ? (int)noh_fail(&web.error, NOH_ERR_GL, "a GL error in the frame", code, 0) : 0;
}
