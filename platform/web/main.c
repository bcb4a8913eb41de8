/* main.c: the program behind a canvas. It shows the characters of one pack on a stage, in memory that was sized for
 * this pack and cannot grow; targets and clips are given by index. program.js creates the memory and calls the web_*
 * functions. Functions that return an int return 0 or a noh_result; web_error returns the message. */
#include <emscripten.h>
#include <string.h>

#include "bounds.h"
#include "web.h"
#include "core/base/quarter_internal.h"
#include "deform/pick/bounds_internal.h"
#include "gl/device/gl_api_internal.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"

#define SPEED_ONE 65536

struct web web = { .light = { .environment = WEB_PLAIN } };

/* ---- loading ---- */

noh_result web_open_context(void)
{
    if (noh_platform_web.create(NULL, &web.context, NULL, 0)) {
        return noh_fail(&web.error, NOH_ERR_UNSUPPORTED, "cannot create a WebGL 2 context: use a browser with WebGL 2",
                        0, 0);
    }
    noh_result result = noh_gl_api_load(&web.gl, NULL, NULL, &web.error);
    web.gl.decode = noh_etc2_decode;
    if (result || web.caps.version) return result; /* probed by another program on this context */
    return noh_gl_caps_probe(&web.gl, &web.caps, &web.error);
}

void *web_block(size_t at)
{
    return web.block + at;
}

static noh_result make_stage(const web_wants *wants)
{
    const noh_gl_device device = { &web.gl, &web.caps, &web.ledger, NULL, 0 };
    noh_result result = web_cast_plan(&web.cast, &web.pack, wants, web.block, web.block_bytes, &web.caps, &web.error);
    if (!result && web.cast.bytes > web.block_bytes) {
        return noh_fail(&web.error, NOH_ERR_MEMORY, "the memory is smaller than planned", 0, web.cast.bytes);
    }
    if (!result) result = web_light_bake();
    if (!result) {
        result = noh_stage_init(web.block, (size_t)web.cast.plan.cpu_bytes, &device, &web.cast.desc, &web.cast.plan,
                                &web.stage, &web.error);
    }
    if (!result) result = web_light_open();
    return result ? result : web_hair_open();
}

static void close_stage(void)
{
    web_light_close();
    web_hair_close();
    if (web.stage) noh_stage_delete(web.stage);
    web.stage = NULL;
}

/* The state is kept at the end of the block, after everything that the stages and their light use. */
noh_result web_open_stage(const web_wants *wants)
{
    size_t bytes = 0;
    const void *state = web.stage ? noh_stage_state(web.stage, &bytes) : NULL;
    uint8_t *kept = web.block + web.block_bytes - bytes;
    noh_result result;
    if (web.stage) {
        memmove(kept, state, bytes);
        close_stage();
    }
    result = make_stage(wants);
    if (!result && state) result = noh_stage_set_state(web.stage, kept, bytes, &web.error);
    if (result) return result;
    web.part_count = noh_stage_plan_parts(&web.cast.desc, &web.caps, &web.cast.plan, web.parts, WEB_PARTS_MAX);
    web.part_count = web.part_count < WEB_PARTS_MAX ? web.part_count : WEB_PARTS_MAX - 1u;
    if (web.cast.has_hair) {
        web.parts[web.part_count++] = (noh_stage_bytes){ "hair", NOH_NONE, web.cast.cpu_bytes - web.cast.plan.cpu_bytes,
                                                         web.cast.gpu_bytes - web.cast.plan.gpu_bytes };
    }
    web.view.cut = 1;
    return NOH_OK;
}

/* The first character stands in the middle, the others alternate to its left and right, across where they face. */
static void go_home(void)
{
    for (uint32_t i = 0; i < web.figure_count; i++) {
        const uint32_t n = web.figures[i].character;
        noh_place place;
        memset(&place, 0, sizeof place);
        place.position[0] = web.spacing * (float)((n + 1u) / 2u) * (n % 2u ? 1.0f : -1.0f);
        noh_quarter_turn((uint32_t)((int32_t)web.facing / 90), place.position, place.position);
        (void)noh_actor_set_place(web.stage, web.figures[i].actor, &place, NULL);
    }
}

static noh_result enter(uint32_t characters)
{
    noh_result result = NOH_OK;
    for (uint32_t n = 0; n < characters; n++) {
        for (uint32_t k = 0; k < web.cast.desc.kind_count && !result; k++) {
            web_figure *f = &web.figures[web.figure_count++];
            f->kind = k;
            f->character = n;
            result = noh_stage_spawn(web.stage, k, NULL, &f->actor, &web.error);
        }
    }
    return result;
}

static void add_target(const char *name)
{
    web_target t = { name, 0, NOH_NONE };
    for (uint32_t i = 0; i < web.target_count; i++) {
        if (strcmp(web.targets[i].name, name) == 0) return;
    }
    for (uint32_t k = 0; k < web.cast.desc.kind_count && t.index == NOH_NONE; k++) { /* figure k has kind k */
        t.figure = k;
        t.index = noh_stage_find(web.stage, k, NOH_NAME_FLOAT, name);
    }
    if (t.index != NOH_NONE && web.target_count < NOH_TARGETS_MAX) web.targets[web.target_count++] = t;
}

static void list_targets(void)
{
    for (uint32_t i = 0; i < web.pack.runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_pack_mesh_at(&web.pack, i, &mesh, NULL);
        for (uint32_t t = 0; t < mesh.header->target_count; t++) {
            add_target(noh_pack_string(&web.pack, mesh.targets[t].name));
        }
    }
}

/* Create the stage with its characters in their initial state. */
static noh_result begin(const web_wants *wants)
{
    noh_result result = web_open_stage(wants);
    if (!result) result = enter(web.character_count);
    if (!result) list_targets();
    web.speed = SPEED_ONE;
    if (!result) {
        (void)web_measure();
        web_light_find_floor();
    }
    return result;
}

/* Call before web_plan and web_open. 1: another renderer draws the output of vertices.c, and web_draw is not called. */
EMSCRIPTEN_KEEPALIVE void web_set_elsewhere(int on)
{
    web.elsewhere = on;
}

/* Open the loaded pack. path: a noh_morph_path; characters: their number; alive 0: without faces; shading: a noh_shading. All as in
 * web_plan. */
EMSCRIPTEN_KEEPALIVE int web_open(int path, uint32_t characters, int alive, int shading)
{
    const web_wants wants = {
        characters, (noh_morph_path)path, web.light.environment != WEB_PLAIN, alive, 0, web.elsewhere,
        0,          (noh_shading)shading
    };
    noh_result result = web_load(&web.pack);
    web.character_count = characters;
    if (!result) web.facing = web_cast_facing(&web.pack);
    if (!result) result = web_open_context();
    return (int)(result ? result : begin(&wants));
}

/* Delete all GL objects. No call may follow. */
EMSCRIPTEN_KEEPALIVE void web_close(void)
{
    close_stage();
}

/* Restore every GL object from the pack after the browser restored a lost context. */
EMSCRIPTEN_KEEPALIVE int web_restore(void)
{
    noh_web_enable_extensions(web.context);
    noh_result result = noh_gl_api_load(&web.gl, NULL, NULL, &web.error);
    web.gl.decode = noh_etc2_decode;
    if (!result) result = noh_stage_restore(web.stage, &web.error);
    if (!result) result = web_hair_restore();
    return (int)(result ? result : web_light_restore());
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
/* "" if the pack has no targets. */
EMSCRIPTEN_KEEPALIVE const char *web_path(void)
{
    const uint32_t path = web.cast.plan.morph_path;
    return path ? noh_morph_path_name((noh_morph_path)path) : "";
}
EMSCRIPTEN_KEEPALIVE uint32_t web_memory_room(void)
{
    return (uint32_t)web.block_bytes;
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
    return web.parts[i].what;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_part_cpu_bytes(uint32_t i)
{
    return (uint32_t)web.parts[i].cpu_bytes;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_part_gpu_bytes(uint32_t i)
{
    return (uint32_t)web.parts[i].gpu_bytes;
}

EMSCRIPTEN_KEEPALIVE uint32_t web_target_count(void)
{
    return web.target_count;
}
EMSCRIPTEN_KEEPALIVE const char *web_target_name(uint32_t i)
{
    return web.targets[i].name;
}
/* The weight of the last frame, if it showed the figure. */
EMSCRIPTEN_KEEPALIVE float web_weight(uint32_t i)
{
    const float *floats = noh_actor_floats(web.stage, web.figures[web.targets[i].figure].actor);
    return floats ? floats[web.targets[i].index] : 0.0f;
}
/* Hold a target at a weight, or release it to the clips. */
EMSCRIPTEN_KEEPALIVE void web_hold(uint32_t i, float weight, int holds)
{
    for (uint32_t f = 0; f < web.figure_count; f++) {
        const uint32_t index = noh_stage_find(web.stage, web.figures[f].kind, NOH_NAME_FLOAT, web.targets[i].name);
        if (index != NOH_NONE) {
            (void)noh_actor_hold_float(web.stage, web.figures[f].actor, index, weight, holds ? 1.0f : 0.0f, NULL);
        }
    }
}

/* ---- clips ---- */

/* Joints of the skeleton that clips move; 0: clips move only faces. */
EMSCRIPTEN_KEEPALIVE uint32_t web_joint_count(void)
{
    return web.cast.plan.kinds[0].joint_count;
}

EMSCRIPTEN_KEEPALIVE uint32_t web_clip_count(void)
{
    return web.pack.runs[NOH_CHUNK_CLIP].count;
}
EMSCRIPTEN_KEEPALIVE const char *web_clip_name(uint32_t i)
{
    noh_pack_clip clip;
    return noh_pack_clip_at(&web.pack, i, &clip, NULL) == NOH_OK ? clip.name : "";
}
/* Negative if the clip moves nothing here. */
EMSCRIPTEN_KEEPALIVE double web_clip_seconds(uint32_t i)
{
    for (uint32_t k = 0; k < web.cast.desc.kind_count; k++) {
        const uint32_t clip = noh_stage_find(web.stage, k, NOH_NAME_CLIP, web_clip_name(i));
        const noh_clip_set *set;
        (void)noh_actor_controller(web.stage, web.figures[k].actor, &set);
        if (clip != NOH_NONE) return (double)set->clips[clip].duration_ticks / NOH_TICKS_PER_SECOND;
    }
    return -1.0;
}

static void set_speeds(const web_figure *f, int32_t body, int32_t rest)
{
    noh_controller *c = noh_actor_controller(web.stage, f->actor, NULL);
    const noh_track *on_body = noh_actor_track(web.stage, f->actor, WEB_BODY);
    for (uint32_t t = 0; t < c->track_count; t++) {
        (void)noh_controller_set_speed(c, t, noh_controller_track(c, t) == on_body ? body : rest);
    }
}

static void set_all_speeds(int32_t body, int32_t rest)
{
    for (uint32_t i = 0; i < web.figure_count; i++) set_speeds(&web.figures[i], body, rest);
}

/* 1: original speed; 0: paused. */
EMSCRIPTEN_KEEPALIVE void web_set_speed(float speed)
{
    web.speed = (int32_t)(speed * (float)SPEED_ONE);
    set_all_speeds(web.speed, web.speed);
}

/* Play a clip by name, or none, on a figure's layer. The body uses inertial transitions, so that it does not slow
 * down. */
static noh_result play(const web_figure *f, uint32_t layer, const char *clip, uint32_t fade_ticks)
{
    noh_play how;
    if (noh_stage_find(web.stage, f->kind, NOH_NAME_CLIP, clip) == NOH_NONE) {
        return noh_actor_stop(web.stage, f->actor, layer, fade_ticks, &web.error);
    }
    memset(&how, 0, sizeof how);
    how.fade_ticks = fade_ticks;
    how.loop = NOH_LOOP_REPEAT;
    how.flags = fade_ticks > 1u && layer == WEB_BODY ? NOH_PLAY_INERTIA : 0;
    return noh_actor_play(web.stage, f->actor, layer, clip, &how, &web.error);
}

/* Seek the body clips to a time, from the start positions: root motion moves the bodies. */
static noh_result seek(double time_s)
{
    const int64_t ticks = noh_ticks_from_seconds(time_s);
    noh_result result;
    go_home();
    set_all_speeds(0, 0);
    result = noh_stage_step(web.stage, 1, NULL, NULL, &web.error); /* removes clips faded out at once */
    set_all_speeds(SPEED_ONE, 0);
    if (!result && ticks > 0) result = noh_stage_step(web.stage, (uint32_t)ticks, NULL, NULL, &web.error);
    web.view.cut = 1;
    return result;
}

/* Play a clip on a layer, -1: none. With a transition in seconds it starts from the shown pose; without, the bodies
 * start at a time in seconds. */
EMSCRIPTEN_KEEPALIVE int web_play(uint32_t layer, int clip, double time_s, double transition_s)
{
    const uint32_t fade_ticks = transition_s > 0.0 ? (uint32_t)noh_ticks_from_seconds(transition_s) : 1u;
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < web.figure_count && !result; i++) {
        result = play(&web.figures[i], layer, clip < 0 ? "" : web_clip_name((uint32_t)clip), fade_ticks);
    }
    if (!result && layer == WEB_BODY && fade_ticks <= 1u) result = seek(time_s);
    set_all_speeds(web.speed, web.speed);
    return (int)result;
}

/* The position of the body clip, in seconds. */
EMSCRIPTEN_KEEPALIVE double web_time(void)
{
    for (uint32_t k = 0; k < web.cast.desc.kind_count; k++) {
        const noh_track *track = noh_actor_track(web.stage, web.figures[k].actor, WEB_BODY);
        const noh_clip_set *set;
        (void)noh_actor_controller(web.stage, web.figures[k].actor, &set);
        if (track) return (double)noh_track_clip_tick(track, &set->clips[track->clip], 0) / NOH_TICKS_PER_SECOND;
    }
    return 0.0;
}

/* ---- appearance: LOD levels, wrinkles ---- */

static void set_looks(int posed)
{
    noh_appearance look;
    memset(&look, 0, sizeof look);
    look.posed = posed != 0;
    look.level = web.level;
    look.smoothed = web.smoothed;
    for (uint32_t i = 0; i < web.figure_count; i++) {
        (void)noh_actor_set_appearance(web.stage, web.figures[i].actor, &look, NULL);
    }
}

/* 1: some material has wrinkles. */
EMSCRIPTEN_KEEPALIVE int web_wrinkles(void)
{
    int any = 0;
    for (uint32_t i = 0; i < web.pack.material_count; i++) any |= web.pack.materials[i].wrinkle_models != 0;
    return any;
}
/* Strength: 1: unchanged, 0: smooth. */
EMSCRIPTEN_KEEPALIVE void web_set_wrinkles(float strength)
{
    web.smoothed = (uint8_t)(255.0f - 255.0f * strength + 0.5f);
    set_looks(0);
}

/* The largest number of levels of any kind. */
EMSCRIPTEN_KEEPALIVE uint32_t web_level_count(void)
{
    uint32_t most = 0;
    for (uint32_t k = 0; k < web.cast.desc.kind_count; k++) {
        const uint32_t count = web.cast.plan.kinds[k].level_count;
        most = count > most ? count : most;
    }
    return most;
}
/* An LOD level, or -1: the coarsest level within one pixel. */
EMSCRIPTEN_KEEPALIVE void web_set_level(int level)
{
    web.level = (uint32_t)(level + 1);
    set_looks(0);
}
/* Of the last frame: the finest level of any figure, the largest error in pixels, whether any level fades. */
EMSCRIPTEN_KEEPALIVE uint32_t web_level(void)
{
    const uint32_t *at_level = noh_stage_stats_of(web.stage)->at_level;
    uint32_t level = 0;
    while (level + 1u < NOH_LOD_LEVELS_MAX && !at_level[level]) level++;
    return level;
}
EMSCRIPTEN_KEEPALIVE float web_error_pixels(void)
{
    return noh_stage_stats_of(web.stage)->error_pixels;
}
EMSCRIPTEN_KEEPALIVE int web_fades(void)
{
    return noh_stage_stats_of(web.stage)->fading > 0;
}

/* ---- a frame ---- */

/* Where the figures' front is, in degrees from +z towards +x, in steps of 90. */
EMSCRIPTEN_KEEPALIVE float web_facing(void)
{
    return web.facing;
}

/* The position of the first character, which the camera follows: 3 floats, valid until the next call. */
EMSCRIPTEN_KEEPALIVE float *web_walked(void)
{
    static noh_place place;
    (void)noh_actor_place(web.stage, web.figures[0].actor, &place, NULL);
    return place.position;
}

static void measure(int face, float box[6])
{
    web_bounds(web.stage, &web.pack, web.cast.desc.kind_count * web.cast.wants.actors, web_block(web.cast.matrices_at),
               face, box);
}

/* The box of all figures in their current pose: 6 floats, valid until the next call. */
EMSCRIPTEN_KEEPALIVE float *web_measure(void)
{
    set_looks(1);
    if (noh_stage_frame(web.stage, 0, NULL, NULL, NULL, &web.error) == NOH_OK) {
        measure(0, web.bounds);
    }
    set_looks(0);
    web.view.cut = 1;
    memcpy(web.from, web_walked(), sizeof web.from);
    return web.bounds;
}

/* The box of what targets move, as last posed for web_measure; low is above high without targets. */
EMSCRIPTEN_KEEPALIVE float *web_measure_face(void)
{
    static float box[6];
    measure(1, box);
    return box;
}

/* Pose a clip on the bodies at regular times, and measure each pose relative to the first character. */
static void grow_by_clip(int clip, double seconds, uint32_t poses, float box[6])
{
    for (uint32_t i = 0; i < poses && !web_play(WEB_BODY, clip, seconds * i / poses, 0.0); i++) {
        const float *now = web_measure();
        for (int c = 0; c < 3; c++) {
            const float low = now[c] - web.from[c], high = now[3 + c] - web.from[c];
            box[c] = low < box[c] ? low : box[c];
            box[3 + c] = high > box[3 + c] ? high : box[3 + c];
        }
    }
}

/* The box of all figures over `poses` poses of a body clip, at the first character's current position; as web_measure.
 * Playback is unchanged. */
EMSCRIPTEN_KEEPALIVE float *web_measure_clip(int clip, double seconds, uint32_t poses)
{
    size_t bytes;
    float box[6];
    const void *state = noh_stage_state(web.stage, &bytes);
    uint8_t *kept = web.block + web.block_bytes - bytes; /* as in web_open_stage */
    memcpy(kept, state, bytes);
    noh_box_empty(box);
    grow_by_clip(clip, seconds, poses, box);
    (void)noh_stage_set_state(web.stage, kept, bytes, &web.error);
    memcpy(web.from, web_walked(), sizeof web.from);
    for (int c = 0; c < 6; c++) web.bounds[c] = box[c] + web.from[c % 3];
    return web.bounds;
}

/* Place the characters side by side at this distance. */
EMSCRIPTEN_KEEPALIVE void web_set_spacing(float spacing)
{
    web.spacing = spacing;
    go_home();
}

/* The matrix, eye and light of the noh_stage_view, filled in by the page: 22 floats. */
EMSCRIPTEN_KEEPALIVE float *web_view(void)
{
    return web.view.view_projection;
}

/* Advance time, also in a lost context. */
EMSCRIPTEN_KEEPALIVE int web_step(double seconds)
{
    const uint32_t ticks = noh_frame_clock_advance(&web.clock, seconds);
    const noh_result result = web_rise(ticks);
    web_hair_shake(seconds);
    if (web.calm) web.cast.wants.held_ticks += ticks;
    return (int)(result ? result : noh_stage_step(web.stage, ticks, NULL, NULL, &web.error));
}

static void begin_frame(uint32_t width, uint32_t height)
{
    static const float far = 1.0f;
    web.gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    web.gl.Viewport(0, 0, (GLsizei)width, (GLsizei)height);
    web.gl.DepthMask(GL_TRUE);
    web.gl.ClearBufferfv(GL_COLOR, 0, web.light.color);
    web.gl.ClearBufferfv(GL_DEPTH, 0, &far);
    web_light_backdrop();
    web_light_floor();
    web_light_spots();
}

/* Draw a frame. In a lost context, draw nothing and return 0. */
EMSCRIPTEN_KEEPALIVE int web_draw(void)
{
    noh_stage_view views[2];
    uint32_t width, height;
    noh_result result;
    int shadow;
    if (noh_platform_web.present(web.context)) return 0;
    noh_platform_web.size(web.context, &width, &height);
    web.view.height_px = height;
    views[0] = web.view;
    shadow = web_light_shadow(&views[1]);
    result = noh_stage_frame_begin(web.stage, views, shadow ? 2 : 1, &web.error);
    if (!result) result = noh_stage_frame_end(web.stage, &web.error);
    web.view.cut = 0;
    if (!result) web_hair_update();
    if (!result && shadow) result = noh_stage_draw_shadow(web.stage, 1, &web.error);
    if (result) return (int)result;
    if (shadow) web_hair_shadow();
    begin_frame(width, height);
    if (!web.light.background && web.light.color[3] < 1.0f) return (int)web_hair_draw();
    web.gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    web.gl.ColorMask(1, 1, 1, 0); /* the page would be seen through the smooth edges of cards */
    result = web_hair_draw();
    web.gl.ColorMask(1, 1, 1, 1);
    web.gl.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    return (int)result;
}

/* An error if GL raised one since the last call. Waits for the GPU. */
EMSCRIPTEN_KEEPALIVE int web_check(void)
{
    GLenum code = noh_gl_error_take(&web.gl);
    return code ? (int)noh_fail(&web.error, NOH_ERR_GL, "GL raised an error in a frame", code, 0) : 0;
}
