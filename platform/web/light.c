/* light.c: the light of the page, with the names of `noh render --light`. */
#include <emscripten.h>
#include <math.h>
#include <string.h>

#include "web.h"

/* ---- the environment ---- */

static int is_lit(void)
{
    return web.light.environment != WEB_PLAIN;
}

/* The page keeps the texels of each environment, for other stages and elements (package/gl.js). take returns 1 if it
 * has written them. */
#define NAMED(what) __attribute__((import_module("noh"), import_name(what)))
NAMED("take_baked") extern int take_baked(int environment, void *texels, size_t bytes);
NAMED("keep_baked") extern void keep_baked(int environment, const void *texels, size_t bytes);

noh_result web_light_bake(void)
{
    const uint32_t side = web.cast.reflection.side;
    const size_t bytes = noh_reflection_size(side);
    void *texels;
    noh_reflection_desc desc;
    noh_result result;
    if (!is_lit()) return NOH_OK;
    texels = web_block(web.cast.texels_at);
    memset(&desc, 0, sizeof desc);
    desc.side = side;
    desc.radiance = noh_reflection_of_environment;
    desc.user = noh_environment_at((uint32_t)web.light.environment);
    noh_light_from_environment(desc.user, NOH_SH_ORDER_MAX, &web.light.all);
    if (take_baked(web.light.environment, texels, bytes)) {
        web.cast.reflection.texels = texels;
        return NOH_OK;
    }
    result = noh_reflection_init(texels, bytes, web_block(web.cast.scratch_at), web.cast.scratch_bytes, &desc,
                                 &web.cast.reflection, &web.error);
    if (!result) keep_baked(web.light.environment, texels, bytes);
    return result;
}

static void rotate(float degrees, float rotation[9])
{
    float s, c;
    noh_sin_cos_turn(web_turn((double)degrees / 360.0), &s, &c);
    const float turn[9] = { c, 0.0f, s, 0.0f, 1.0f, 0.0f, -s, 0.0f, c };
    memcpy(rotation, turn, sizeof turn);
}

/* Pass the lighting to the stage, turned to the figures' front. Without a shadow map no key light is split off. */
static void tell(void)
{
    float rotation[9];
    if (!is_lit()) return;
    rotate(web.light.degrees + web.facing, rotation);
    noh_lighting_make(&web.light.all, rotation, web.light.shadow == WEB_SHADOW_MAP, &web.light.told);
    web.light.told.tonemap = (noh_tonemap)web.light.tonemap;
    rotate(web.light.degrees, rotation);
    web.light.told.exposure = noh_light_exposure(&web.light.all, rotation);
    noh_stage_set_lighting(web.stage, &web.light.told);
}

noh_result web_light_open(void)
{
    const noh_gl_device device = { &web.gl, &web.caps, &web.ledger, NULL, 0 };
    noh_result result;
    if (!is_lit()) return NOH_OK;
    tell();
    for (uint32_t k = 0; k < web.cast.desc.kind_count; k++) {
        (void)noh_blob_rig_make(&web.cast.kinds[k], &web.light.rigs[k],
                                NULL); /* a kind that draws nothing has no spots */
    }
    result = noh_backdrop_create(&device, 1, &web.light.backdrop, &web.error);
    if (!result) result = noh_stage_blob_create(&device, &web.light.blob, &web.error);
    if (result || !web_joint_count()) return result; /* a figure without joints has no floor */
    return noh_stage_floor_create(&device, 1, &web.light.ground, &web.error);
}

void web_light_close(void)
{
    noh_backdrop_delete(&web.light.backdrop);
    noh_stage_blob_delete(&web.light.blob);
    noh_stage_floor_delete(&web.light.ground);
    memset(&web.light.ground, 0, sizeof web.light.ground);
    memset(&web.light.backdrop, 0, sizeof web.light.backdrop);
    memset(&web.light.blob, 0, sizeof web.light.blob);
}

noh_result web_light_restore(void)
{
    noh_result result = NOH_OK;
    if (!is_lit()) return result;
    result = noh_backdrop_restore(&web.light.backdrop, NULL, 0, &web.error);
    if (!result) result = noh_stage_blob_restore(&web.light.blob, NULL, 0, &web.error);
    if (!result && web.light.ground.drawable.gl)
        result = noh_stage_floor_restore(&web.light.ground, NULL, 0, &web.error);
    return result;
}

/* ---- a frame ---- */

int web_light_shadow(noh_stage_view *view)
{
    noh_place place;
    float *sphere = web.light.sphere, square = 0.0f;
    if (!is_lit() || web.light.shadow != WEB_SHADOW_MAP) return 0;
    (void)noh_actor_place(web.stage, web.figures[0].actor, &place, NULL);
    for (int i = 0; i < 3; i++) {
        const float half = 0.5f * (web.bounds[3 + i] - web.bounds[i]);
        sphere[i] = web.bounds[i] + half + place.position[i] - web.from[i];
        square += half * half;
    }
    sphere[3] = 1.02f * sqrtf(square);
    sphere[3] = sphere[3] > 1e-6f ? sphere[3] : 1e-6f;
    noh_view_shadow(view, sphere, web.light.told.key_direction);
    noh_lighting_shadow(&web.light.told, view->view_projection, sphere[3], web.cast.light.shadow_px);
    web.light.told.has_floor = web.light.on_floor && web.light.ground.drawable.gl;
    web.light.told.floor = web.light.floor;
    return 1;
}

void web_light_backdrop(void)
{
    if (!is_lit() || !web.light.background) return;
    noh_backdrop_draw(&web.light.backdrop, (noh_backdrop_kind)(web.light.background - 1), noh_stage_light_of(web.stage),
                      &web.light.told, &web.view);
}

#define FLOOR_REACHES 3.0f /* in radii of the shadow casters */
#define LEVEL 0.05f        /* share of the figures' height: nearer to 0, the floor is at 0 */

void web_light_find_floor(void)
{
    const float low = web.bounds[1], height = web.bounds[4] - low;
    web.light.floor = fabsf(low) < LEVEL * height ? 0.0f : low;
}

void web_light_floor(void)
{
    const float *s = web.light.sphere, disc[4] = { s[0], web.light.floor, s[2], FLOOR_REACHES * s[3] };
    if (!is_lit() || web.light.shadow != WEB_SHADOW_MAP || !web.light.on_floor || !web.light.ground.drawable.gl) return;
    noh_stage_floor_draw(&web.light.ground, noh_stage_light_of(web.stage), &web.light.told, &web.view, disc);
}

#define CONTACT 0.6f /* darkness of the spots where the shadow falls, too */

/* Soft spots under the figures. */
void web_light_spots(void)
{
    const noh_plane plane = { { 0.0f, 1.0f, 0.0f }, web.light.floor };
    const noh_world world = { .planes = &plane, .plane_count = 1 };
    const noh_ground ground = { &world, NULL, NULL };
    const int spots = web.light.shadow == WEB_SHADOW_SPOTS;
    const int contact = web.light.shadow == WEB_SHADOW_MAP && web.light.on_floor && web.light.ground.drawable.gl;
    if (!is_lit() || (!spots && !contact) || web.view.eye[1] <= web.light.floor) return; /* none from below */
    for (uint32_t i = 0; i < web.figure_count; i++) {
        noh_blob blobs[NOH_BLOBS_MAX];
        const web_figure *f = &web.figures[i];
        const uint32_t count = noh_actor_blobs(web.stage, f->actor, &web.light.rigs[f->kind], &ground, blobs);
        for (uint32_t n = 0; n < count && !spots; n++) blobs[n].darkness *= CONTACT;
        noh_stage_blob_draw(&web.light.blob, &web.view, blobs, count);
    }
}

/* ---- calls from the page ---- */

EMSCRIPTEN_KEEPALIVE uint32_t web_light_count(void)
{
    return NOH_ENVIRONMENT_COUNT;
}
EMSCRIPTEN_KEEPALIVE const char *web_light_name(uint32_t i)
{
    return noh_environment_at(i)->name;
}

/* degrees about the vertical axis; shadow: a web_shadow; tonemap: a noh_tonemap; background: 0 plain, 1 a gradient, 2
 * the light, blurred. May be called before web_open. */
EMSCRIPTEN_KEEPALIVE void web_set_lighting(float degrees, int shadow, int tonemap, int background)
{
    web.light.degrees = degrees;
    web.light.shadow = shadow;
    web.light.tonemap = tonemap;
    web.light.background = background;
    if (web.stage) tell();
}

/* The colour of a plain background, 0..1, alpha last. May be called before web_open. */
EMSCRIPTEN_KEEPALIVE void web_set_background(float red, float green, float blue, float alpha)
{
    const float color[4] = { red * alpha, green * alpha, blue * alpha, alpha };
    memcpy(web.light.color, color, sizeof color);
}

/* 1: the shadow also falls on the floor. May be called before web_open. */
EMSCRIPTEN_KEEPALIVE void web_set_floor(int on)
{
    web.light.on_floor = on;
}

/* Set an environment, or -1: the plain renderer's light. Changing between the two recreates the stage. May be called
 * before web_open. */
EMSCRIPTEN_KEEPALIVE int web_set_light(int environment)
{
    const int was_lit = is_lit();
    web_wants wants = web.cast.wants;
    noh_result result;
    if (environment == web.light.environment) return 0;
    web.light.environment = environment;
    if (!web.stage) return 0;
    if (was_lit != is_lit()) {
        wants.lit = is_lit();
        return (int)web_open_stage(&wants);
    }
    result = web_light_bake();
    if (!result && is_lit()) result = noh_gl_light_upload(noh_stage_light_of(web.stage), &web.error);
    tell();
    return (int)result;
}

/* 1: the pack has precomputed light of vertices. */
EMSCRIPTEN_KEEPALIVE int web_has_transfer(void)
{
    for (uint32_t i = 0; i < web.pack.runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        if (noh_pack_mesh_at(&web.pack, i, &mesh, NULL) == NOH_OK && mesh.transfer) return 1;
    }
    return 0;
}

/* Use precomputed light (1) or not (0). Recreates the stage. */
EMSCRIPTEN_KEEPALIVE int web_set_transfer(int on)
{
    web_wants wants = web.cast.wants;
    if (wants.without_transfer == !on) return 0;
    wants.without_transfer = !on;
    return (int)web_open_stage(&wants);
}
