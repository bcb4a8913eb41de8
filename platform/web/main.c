/* main.c: the page's program. It shows one pack, whose targets and clips are given by index, in memory whose size was
 * fixed when the page was built. page.js calls the web_* functions. Those that return an int return 0 or a noh_result;
 * web_error then says what is wrong.
 *
 * The Makefile sets NOH_WEB_PACK_BYTES and NOH_WEB_MEMORY_BYTES to what `noh budget` says. */
#include <emscripten.h>
#include <string.h>

#include "context.h"
#include "lod.h"
#include "play.h"

#define PICTURES_MAX 64u
#define PARTS_MAX 16u

static uint8_t pack_bytes[NOH_WEB_PACK_BYTES] __attribute__((aligned(64)));
static uint8_t memory[NOH_WEB_MEMORY_BYTES] __attribute__((aligned(16)));

/* A line in the page's table of memory. */
typedef struct part {
    const char *name;
    uint32_t cpu_bytes, gpu_bytes;
} part;

static struct web {
    noh_platform_context *context;
    noh_gl_api gl;
    noh_gl_caps caps;
    noh_gl_ledger ledger;
    noh_error error;
    noh_arena arena;
    web_scene scene;
    web_playback play;
    web_lod lod;
    noh_gl_mesh meshes[WEB_MESHES_MAX];
    noh_gl_texture pictures[PICTURES_MAX];
    noh_gl_morph *morph;
    noh_gl_skin *skin; /* NULL: nothing is skinned */
    noh_gl_renderer renderer;
    noh_gl_camera camera;
    float bounds[6];
    int at_rest;
    part parts[PARTS_MAX];
    uint32_t part_count;
} web;

/* ---- loading ---- */

/* End a part: its bytes are those that were taken since the part before ended. */
static void end_part(const char *name)
{
    uint32_t cpu = (uint32_t)web.arena.used, gpu = (uint32_t)noh_gl_ledger_bytes(&web.ledger);
    for (uint32_t i = 0; i < web.part_count; i++) {
        cpu -= web.parts[i].cpu_bytes;
        gpu -= web.parts[i].gpu_bytes;
    }
    if (web.part_count < PARTS_MAX) {
        part *p = &web.parts[web.part_count++];
        p->name = name;
        p->cpu_bytes = cpu;
        p->gpu_bytes = gpu;
    }
}

static noh_result load_meshes(void)
{
    const noh_pack *pack = &web.scene.pack;
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < pack->mesh_count && !result; i++) {
        result = noh_gl_mesh_create(&web.gl, &web.ledger, &web.scene.meshes[i], &web.meshes[i], &web.error);
    }
    end_part("meshes");
    if (!result && pack->texture_count > PICTURES_MAX) {
        return noh_fail(&web.error, NOH_ERR_LIMIT, "more textures than the page has room for", pack->texture_count,
                        PICTURES_MAX);
    }
    for (uint32_t i = 0; i < pack->texture_count && !result; i++) {
        noh_texture texture;
        noh_pack_texture_at(pack, i, &texture, NULL);
        result = noh_gl_picture_create(&web.gl, &web.ledger, &texture, &web.pictures[i], &web.error);
    }
    end_part("textures");
    return result;
}

static noh_result load_morph(noh_morph_path path)
{
    noh_gl_morph_plan plan;
    noh_gl_morph_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = web.scene.meshes;
    desc.mesh_count = web.scene.pack.mesh_count;
    desc.instance_counts = web.scene.instance_counts;
    desc.path = path;
    noh_result result = noh_gl_morph_plan_make(&desc, &web.caps, &plan, &web.error);
    if (!result) {
        size_t bytes = (size_t)plan.cpu_bytes;
        void *block = noh_arena_carve(&web.arena, bytes, 16);
        result = noh_gl_morph_init(block, block ? bytes : 0,
                                   &(noh_gl_device){ &web.gl, &web.caps, &web.ledger, NULL, 0 }, &desc, &web.morph,
                                   &web.error);
    }
    for (uint32_t i = 0; i < web.scene.item_count && !result; i++) {
        web_item *item = &web.scene.items[i];
        item->instance = noh_gl_morph_instance(web.morph, item->mesh, item->instance);
    }
    end_part("morphs");
    return result;
}

static noh_result load_skin(void)
{
    noh_gl_skin_plan plan;
    noh_gl_skin_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = web.scene.meshes;
    desc.mesh_count = web.scene.pack.mesh_count;
    desc.instance_counts = web.scene.instance_counts;
    noh_result result = web_playback_open_matrices(&web.play, &web.arena, &web.error);
    end_part("skin matrices");
    if (result || !web.play.matrices) return result;
    result = noh_gl_skin_plan_make(&desc, &web.caps, &plan, &web.error);
    if (!result) {
        size_t bytes = (size_t)plan.cpu_bytes;
        void *block = noh_arena_carve(&web.arena, bytes, 16);
        result = noh_gl_skin_init(block, block ? bytes : 0,
                                  &(noh_gl_device){ &web.gl, &web.caps, &web.ledger, NULL, 0 }, &desc, &web.skin,
                                  &web.error);
    }
    end_part("palettes");
    return result;
}

static noh_result load_clips(void)
{
    noh_result result = web_playback_open_clips(&web.play, &web.scene, &web.arena, &web.error);
    end_part("clips");
    if (!result) result = web_playback_open_controllers(&web.play, &web.arena, &web.error);
    end_part("controllers");
    if (!result) result = web_playback_open_poses(&web.play, &web.arena, &web.error);
    end_part("pose scratch");
    return result;
}

static noh_result load_renderer(void)
{
    noh_gl_renderer_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.layers_uint = noh_gl_morph_plan_of(web.morph)->layer_format == GL_RGBA32UI;
    desc.meshes = web.scene.meshes;
    desc.mesh_count = web.scene.pack.mesh_count;
    desc.fades = web.lod.level_count > 1;
    desc.encode_srgb = 1; /* a canvas does not encode */
    desc.palettes = web.skin ? noh_gl_skin_plan_of(web.skin)->mode : NOH_PALETTE_AUTO;
    noh_result result = noh_gl_renderer_create(&(noh_gl_device){ &web.gl, NULL, &web.ledger, NULL, 0 }, &desc,
                                               &web.renderer, &web.error);
    end_part("renderer");
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

/* Where the page is to write the file; NULL if it has more bytes than the page was built for. */
EMSCRIPTEN_KEEPALIVE void *web_pack(uint32_t bytes)
{
    return bytes <= sizeof pack_bytes ? pack_bytes : NULL;
}

/* Open the pack of so many bytes. path: a noh_morph_path. */
EMSCRIPTEN_KEEPALIVE int web_open(uint32_t bytes, int path)
{
    web.arena = noh_arena_over(memory, sizeof memory);
    noh_result result = noh_pack_open(pack_bytes, bytes, &web.scene.pack, &web.error);
    if (!result) result = web_scene_list(&web.scene, &web.error);
    if (!result) web_lod_open(&web.lod, &web.scene);
    if (!result) result = open_context();
    if (!result) result = load_meshes();
    if (!result) result = load_morph((noh_morph_path)path);
    if (!result) result = load_clips();
    if (!result) result = load_skin();
    if (!result) result = load_renderer();
    return (int)result;
}

static noh_result restore_meshes(void)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < web.scene.pack.mesh_count && !result; i++) {
        result = noh_gl_mesh_restore(&web.gl, &web.ledger, &web.meshes[i], &web.error);
    }
    for (uint32_t i = 0; i < web.scene.pack.texture_count && !result; i++) {
        noh_texture texture;
        noh_pack_texture_at(&web.scene.pack, i, &texture, NULL);
        result = noh_gl_picture_restore(&web.gl, &web.ledger, &texture, &web.pictures[i], &web.error);
    }
    return result;
}

/* Make every GL object again from the pack, after the browser restored a lost context. */
EMSCRIPTEN_KEEPALIVE int web_restore(void)
{
    noh_web_enable_extensions(web.context);
    noh_result result = noh_gl_api_load(&web.gl, noh_platform_web.get_proc, web.context, &web.error);
    if (!result) result = restore_meshes();
    if (!result) result = noh_gl_morph_restore(web.morph, NULL, 0, &web.error);
    if (!result && web.skin) result = noh_gl_skin_restore(web.skin, &web.error);
    if (!result) result = noh_gl_renderer_restore(&web.renderer, NULL, 0, &web.error);
    return (int)result;
}

/* ---- getting and setting ---- */

EMSCRIPTEN_KEEPALIVE const char *web_error(void)
{
    return web.error.what;
}
EMSCRIPTEN_KEEPALIVE const char *web_renderer(void)
{
    return web.caps.renderer;
}
EMSCRIPTEN_KEEPALIVE const char *web_path(void)
{
    return noh_morph_path_name(noh_gl_morph_plan_of(web.morph)->path);
}
EMSCRIPTEN_KEEPALIVE uint32_t web_pack_room(void)
{
    return sizeof pack_bytes;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_memory_room(void)
{
    return sizeof memory;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_gpu_bytes(void)
{
    return (uint32_t)noh_gl_ledger_bytes(&web.ledger);
}
EMSCRIPTEN_KEEPALIVE uint32_t web_part_count(void)
{
    return web.part_count;
}
EMSCRIPTEN_KEEPALIVE const char *web_part_name(uint32_t i)
{
    return web.parts[i].name;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_part_cpu_bytes(uint32_t i)
{
    return web.parts[i].cpu_bytes;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_part_gpu_bytes(uint32_t i)
{
    return web.parts[i].gpu_bytes;
}

EMSCRIPTEN_KEEPALIVE uint32_t web_target_count(void)
{
    return web.scene.name_count;
}
EMSCRIPTEN_KEEPALIVE const char *web_target_name(uint32_t i)
{
    return web.scene.names[i];
}
EMSCRIPTEN_KEEPALIVE float web_weight(uint32_t target)
{
    return web_scene_weight(&web.scene, target);
}
EMSCRIPTEN_KEEPALIVE void web_set_weight(uint32_t target, float weight)
{
    web_scene_set_weight(&web.scene, target, weight);
}

EMSCRIPTEN_KEEPALIVE uint32_t web_clip_count(void)
{
    return web.scene.pack.clip_count;
}
EMSCRIPTEN_KEEPALIVE double web_clip_seconds(uint32_t i)
{
    return web_playback_seconds(&web.play, i);
}
EMSCRIPTEN_KEEPALIVE double web_time(void)
{
    return web_playback_time(&web.play);
}
EMSCRIPTEN_KEEPALIVE void web_set_speed(float speed)
{
    web_playback_set_speed(&web.play, speed);
}
EMSCRIPTEN_KEEPALIVE void web_step(double seconds)
{
    web_playback_step(&web.play, seconds);
}

EMSCRIPTEN_KEEPALIVE uint32_t web_level_count(void)
{
    return web.lod.level_count;
}
/* An LOD level, or -1: the coarsest that an error of one pixel allows. */
EMSCRIPTEN_KEEPALIVE void web_set_level(int level)
{
    web.lod.level = level;
}
/* Of the last frame: the finest level of any item, the largest error in pixels, whether any level fades. */
EMSCRIPTEN_KEEPALIVE uint32_t web_level(void)
{
    uint32_t finest = NOH_LOD_LEVELS_MAX;
    for (uint32_t i = 0; i < web.scene.item_count; i++) {
        finest = web.lod.states[i].mesh < finest ? web.lod.states[i].mesh : finest;
    }
    return finest;
}
EMSCRIPTEN_KEEPALIVE float web_error_pixels(void)
{
    float most = 0.0f;
    for (uint32_t i = 0; i < web.scene.item_count; i++) {
        const float error = noh_lod_error_pixels(&web.lod.states[i]);
        most = error > most ? error : most;
    }
    return most;
}
EMSCRIPTEN_KEEPALIVE int web_fades(void)
{
    int fades = 0;
    for (uint32_t i = 0; i < web.scene.item_count; i++) fades |= noh_lod_fade(&web.lod.states[i], web.lod.clock) < 1.0f;
    return fades;
}

EMSCRIPTEN_KEEPALIVE const char *web_clip_name(uint32_t i)
{
    noh_pack_clip clip;
    return noh_pack_clip_at(&web.scene.pack, i, &clip, NULL) == NOH_OK ? clip.name : "";
}

/* Play a clip, -1: none, from a time in seconds, with a transition in seconds. */
EMSCRIPTEN_KEEPALIVE int web_play(int clip, double time_s, double transition_s)
{
    return (int)web_playback_start(&web.play, clip < 0 ? NOH_NONE : (uint32_t)clip, time_s, transition_s, &web.error);
}

/* ---- a frame ---- */

/* The scene's bounding box in the current pose: 6 floats, valid until the next call. */
EMSCRIPTEN_KEEPALIVE float *web_measure(void)
{
    web_playback_bounds(&web.play, web.bounds);
    return web.bounds;
}

/* The noh_gl_camera that the page is to fill in. */
EMSCRIPTEN_KEEPALIVE float *web_camera(void)
{
    return web.camera.view_projection;
}

/* Draw without morphs, and without their cost: what the benchmark compares with. */
EMSCRIPTEN_KEEPALIVE void web_set_at_rest(int at_rest)
{
    web.at_rest = at_rest;
}

static noh_result update(void)
{
    uint32_t width, height;
    noh_platform_web.size(web.context, &width, &height);
    for (uint32_t i = 0; i < web.scene.item_count; i++) {
        const web_item *item = &web.scene.items[i];
        const float *matrices = web_playback_matrices(&web.play, item) ? web.play.matrices : NULL;
        web_lod_choose(&web.lod, &web.scene, i, matrices, &web.camera, height);
        noh_gl_morph_set_lod(web.morph, item->instance, noh_lod_drawn(&web.lod.states[i], web.lod.clock));
        noh_result result = noh_gl_morph_set_weights(web.morph, item->instance,
                                                     web_lod_weights(&web.lod, &web.scene, i), &web.error);
        if (result) return result;
        if (matrices) noh_gl_skin_set_matrices(web.skin, item->instance, matrices);
    }
    noh_gl_morph_update(web.morph, NULL);
    if (web.skin) noh_gl_skin_update(web.skin);
    return NOH_OK;
}

static void draw_item(uint32_t index, int pass)
{
    const web_item *item = &web.scene.items[index];
    noh_lod_part parts[2];
    const uint32_t part_count = noh_lod_parts(&web.lod.states[index], web.lod.clock, parts);
    noh_gl_morph_binding morph = noh_gl_morph_binding_of(web.morph, item->instance);
    noh_gl_skin_binding skin;
    int is_skinned = web.scene.meshes[item->mesh].header->skin != NOH_NONE;
    if (is_skinned) skin = noh_gl_skin_binding_of(web.skin, item->instance);
    for (uint32_t k = 0; k < part_count; k++) {
        const noh_gl_lod lod = { parts[k].level, parts[k].from, parts[k].to };
        noh_gl_draw_mesh(&web.renderer, &web.meshes[item->mesh], web_scene_world(&web.scene, item),
                         web.at_rest ? NULL : &morph, is_skinned ? &skin : NULL, &lod, web.pictures, pass);
    }
}

static void begin_frame(void)
{
    static const float background[4] = { 0.3035f, 0.3094f, 0.3227f, 1.0f }, far = 1.0f;
    uint32_t width, height;
    noh_platform_web.size(web.context, &width, &height);
    web.gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    web.gl.Viewport(0, 0, (GLsizei)width, (GLsizei)height);
    web.gl.DepthMask(GL_TRUE);
    web.gl.ClearBufferfv(GL_COLOR, 0, background);
    web.gl.ClearBufferfv(GL_DEPTH, 0, &far);
}

/* Draw a frame. seconds: since the last one, for fades. In a lost context nothing is drawn, which is no error. */
EMSCRIPTEN_KEEPALIVE int web_draw(double seconds)
{
    web.lod.clock += (int64_t)(seconds * NOH_TICKS_PER_SECOND);
    if (noh_platform_web.present(web.context)) return 0;
    noh_result result = web.at_rest ? NOH_OK : update();
    if (result) return (int)result;
    begin_frame();
    noh_gl_draw_begin(&web.renderer, &web.camera);
    for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
        for (uint32_t i = 0; i < web.scene.item_count; i++) draw_item(i, pass);
    }
    noh_gl_draw_end(&web.renderer);
    return 0;
}

/* An error if GL raised one since the last call. Waits for the GPU. */
EMSCRIPTEN_KEEPALIVE int web_check(void)
{
    GLenum code = noh_gl_error_take(&web.gl);
    return code ? (int)noh_fail(&web.error, NOH_ERR_GL, "a GL error in a frame", code, 0) : 0;
}
