/* festival.c: the page's crowd: the scene of `noh crowd --place` (crowd/place_scene.h) on a canvas, in memory taken
 * when the page starts, which does not grow. festival.js calls the festival_* functions; if one returns an int other
 * than 0, festival_error returns the message. */
#include <emscripten.h>
#include <string.h>

#include "cli/message.h"
#include "context.h"
#include "crowd/place_scene.h"
#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

static struct {
    gpu g;
    pack_file people;
    place_file *place;
    place_draw_options options;
    place_scene scene;
    noh_stage_view view;
} festival;

static int open_context(gpu *g)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    g->platform = &noh_platform_web;
    if (noh_platform_web.create(NULL, &g->context, NULL, 0)) {
        return tool_fail("canvas", "cannot create a WebGL 2 context: use a browser with WebGL 2");
    }
    if (noh_gl_api_load(&g->gl, NULL, NULL, &error) ||
        noh_gl_caps_probe(&g->gl, &g->caps, &error)) {
        return tool_fail_error("canvas", &error);
    }
    g->gl.decode = noh_etc2_decode;
    return 0;
}

/* Open the files people.nohz, festival.nohz and festival.place. shadow 1: everybody casts one; pixels: largest error of
 * LOD levels; plain_sky 1: a gradient, which costs less than the environment. */
EMSCRIPTEN_KEEPALIVE int festival_open(uint32_t agents, uint32_t width, uint32_t height, int shadow, float pixels,
                                       int plain_sky)
{
    place_draw_options *o = &festival.options;
    int status = open_context(&festival.g);
    memset(o, 0, sizeof *o);
    o->agents = agents;
    o->seed = 1;
    o->pixels = pixels;
    o->scenery = "festival.nohz";
    o->light = (light_options){ "sky", NULL, shadow ? "on" : "off", NULL, plain_sky ? "gradient" : "light", 0.0 };
    o->width = width;
    o->height = height;
    o->encode_srgb = 1; /* a canvas does not encode */
    if (!status) status = pack_file_open(&festival.people, "people.nohz");
    if (!status) status = place_read("festival.place", &festival.place);
    if (!status) status = place_scene_open(&festival.scene, &festival.g, &festival.people, festival.place, o);
    return status;
}

EMSCRIPTEN_KEEPALIVE const char *festival_error(void)
{
    return tool_last_failure();
}

/* Advance by a number of steps of 1/30 s. */
EMSCRIPTEN_KEEPALIVE void festival_step(uint32_t steps)
{
    for (uint32_t i = 0; i < steps; i++) place_scene_step(&festival.scene);
}

/* Move the camera: radians, metres; about x, z. */
EMSCRIPTEN_KEEPALIVE void festival_look(float azimuth, float elevation, float distance, float x, float z,
                                        uint32_t width, uint32_t height)
{
    const float target[3] = { x, 1.0f, z };
    noh_view_orbit(&festival.view, target, azimuth, elevation, distance, width, height);
    memcpy(festival.view.light, festival.scene.light.told.key_direction, sizeof festival.view.light);
}

static void begin(uint32_t width, uint32_t height)
{
    static const float black[4] = { 0.0f, 0.0f, 0.0f, 1.0f }, far = 1.0f;
    const noh_gl_api *gl = &festival.g.gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->Viewport(0, 0, (GLsizei)width, (GLsizei)height);
    gl->DepthMask(GL_TRUE);
    gl->Enable(GL_SAMPLE_ALPHA_TO_COVERAGE); /* of leaves and hair; the canvas has no alpha */
    gl->ClearBufferfv(GL_COLOR, 0, black);
    gl->ClearBufferfv(GL_DEPTH, 0, &far);
}

/* Draw a frame from the camera of festival_look. Draws nothing in a lost context. */
EMSCRIPTEN_KEEPALIVE int festival_draw(void)
{
    uint32_t width, height;
    int status;
    if (noh_platform_web.present(festival.g.context)) return 0;
    noh_platform_web.size(festival.g.context, &width, &height);
    status = place_scene_show(&festival.scene, &festival.view);
    if (!status) status = place_scene_shadow(&festival.scene, &festival.view);
    if (!status) begin(width, height);
    return status ? status : place_scene_draw(&festival.scene, &festival.view);
}

/* Of the last frame: visible figures; figures at a level. */
EMSCRIPTEN_KEEPALIVE uint32_t festival_seen(void)
{
    return noh_stage_stats_of(festival.scene.stage)->seen;
}
EMSCRIPTEN_KEEPALIVE uint32_t festival_gpu_bytes(void)
{
    return (uint32_t)noh_gl_ledger_bytes(&festival.scene.ledger);
}
EMSCRIPTEN_KEEPALIVE uint32_t festival_stage_bytes(void)
{
    return (uint32_t)(festival.scene.plan.cpu_bytes + festival.scene.walkers_bytes +
                      place_life_bytes(festival.scene.life));
}

/* Restore every GL object after the browser restored a lost context. */
EMSCRIPTEN_KEEPALIVE int festival_restore(void)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    gpu *g = &festival.g;
    noh_web_enable_extensions(g->context);
    if (noh_gl_api_load(&g->gl, NULL, NULL, &error) ||
        noh_stage_restore(festival.scene.stage, &error) ||
        noh_backdrop_restore(&festival.scene.backdrop, NULL, 0, &error)) {
        return tool_fail_error("canvas", &error);
    }
    return 0;
}
EMSCRIPTEN_KEEPALIVE uint32_t festival_error_of_gl(void)
{
    return noh_gl_error_take(&festival.g.gl);
}
