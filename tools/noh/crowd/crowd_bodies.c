#include "crowd_bodies.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/face.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#define NEAREST_M 1.5f
#define HALF_ANGLE_RAD 0.68f /* a little more than a 16 : 9 view shows */
#define BEHIND 8u            /* every eighth body is behind the camera */
#define NOTHING_PIXELS 1e-6f /* an error that leaves nothing out */

enum { BODY, FACE, LAYERS };
static const noh_layer_desc layers[LAYERS] = { { "body", NOH_LAYER_BASE, NULL, NULL, 1 },
                                               { "face", NOH_LAYER_OVER, "", NULL, 1 } };

/* ---- the stage's desc ---- */

static int fill_options(crowd *c, const crowd_options *o)
{
    c->options = *o;
    c->options.pixels = o->plain ? NOTHING_PIXELS : o->pixels > 0.0f ? o->pixels : 1.0f;
    c->options.width = o->width ? o->width : 1280u;
    c->options.height = o->height ? o->height : 720u;
    if (o->plain) c->options.near_count = o->count;
    return o->count && o->count <= NOH_MORPH_INSTANCES_MAX
               ? 0
               : tool_fail("crowd", "a crowd must have 1 to %u bodies", NOH_MORPH_INSTANCES_MAX);
}

/* The skeleton of the skinned mesh that targets move the most. */
static int find_skeleton(crowd *c, const pack_file *file)
{
    uint32_t most = 0;
    int found = 0;
    for (uint32_t i = 0; i < file->pack.runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_skin skin;
        noh_pack_mesh_at(&file->pack, i, &mesh, NULL);
        if (noh_pack_skin_at(&file->pack, mesh.header->skin, &skin, NULL) == NOH_OK &&
            (!found || mesh.header->pair_count > most)) {
            found = 1;
            most = mesh.header->pair_count;
            c->kind.skeleton = skin.header->skeleton;
        }
    }
    return found ? 0 : tool_fail(file->path, "a crowd needs a skinned mesh, and the pack has none");
}

int crowd_user_values(const noh_pack *pack)
{
    for (uint32_t i = 0; i < pack->material_count; i++) {
        if (pack->materials[i].surface == NOH_SURFACE_SKIN) return NOH_USER_COMPLEXION;
    }
    return 0;
}

static void fill_desc(crowd *c, const pack_file *file)
{
    const crowd_options *o = &c->options;
    c->kind.mesh = &file->pack;
    c->kind.actor_count = o->count;
    c->kind.near_count = o->near_count;
    c->kind.middle_count = o->middle_count;
    c->kind.layers = layers;
    c->kind.layer_count = LAYERS;
    c->kind.held_float_count = NOH_NONE;
    c->kind.root_axes = NOH_ROOT_X | NOH_ROOT_Z | NOH_ROOT_BY_GAME;
    c->kind.unpickable = 1;
    c->kind.springs = noh_springs_module(NULL);
    c->desc.kinds = &c->kind;
    c->desc.kind_count = 1;
    c->desc.lod.pixels = o->pixels;
    c->desc.height_px = o->height;
    c->desc.update_budget_ns = o->budget_ns;
    c->desc.user_values = o->people ? crowd_user_values(&file->pack) : 0;
    c->desc.light = c->light.name ? &c->light.desc : NULL;
    c->desc.gpu = &noh_stage_on_gl;
}

/* ---- bodies ---- */

/* Steps of additive recurrences n * step mod 2^32: X and Y together fill a square evenly (1/p and 1/p^2, p the plastic
 * number: M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), LINE an interval (1/phi). */
#define SPREAD_X 3242174889u
#define SPREAD_Y 2447445414u
#define SPREAD_LINE 2654435769u

static float spread(uint32_t n, uint32_t step)
{
    return (float)((n * step) >> 8) / 16777216.0f;
}

float crowd_share(uint32_t person, uint32_t which)
{
    uint32_t x = (person + 1u) * 2654435769u + which * 2246822519u;
    x = (x ^ (x >> 15)) * 2246822519u;
    x = (x ^ (x >> 13)) * 3266489917u;
    return (float)((x ^ (x >> 16)) >> 8) / 16777216.0f;
}

float crowd_size(uint32_t person)
{
    return 0.94f + 0.12f * crowd_share(person, 8);
}

noh_appearance crowd_look(uint32_t person)
{
    static const uint8_t robes[][3] = { { 255, 255, 255 }, { 255, 208, 188 }, { 205, 220, 255 }, { 236, 244, 208 },
                                        { 255, 238, 188 }, { 228, 208, 255 }, { 186, 186, 192 }, { 255, 204, 220 } };
    const uint8_t *robe = robes[(uint32_t)(crowd_share(person, 0) * 8.0f)];
    const float shade = 0.6f + 0.4f * crowd_share(person, 1);
    noh_appearance look;
    memset(&look, 0, sizeof look);
    for (int i = 0; i < 3; i++) look.tint[i] = (uint8_t)(shade * (float)robe[i]);
    look.tint[3] = 255;
    noh_complexion_random(person, 1.0f, look.user);
    return look;
}

static noh_place place_of(uint32_t body, int people)
{
    const float distance_m = NEAREST_M + (CROWD_FIELD_M - NEAREST_M) * sqrtf(spread(body + 1u, SPREAD_X));
    const float angle = (2.0f * spread(body + 1u, SPREAD_Y) - 1.0f) * HALF_ANGLE_RAD;
    const float side = body % BEHIND == BEHIND - 1u ? 1.0f : -1.0f;
    const float half_turn = 3.1415927f * spread(body + 1u, SPREAD_LINE);
    const noh_place place = { { distance_m * sinf(angle), 0.0f, side * distance_m * cosf(angle) },
                              { 0.0f, sinf(half_turn), 0.0f, cosf(half_turn) },
                              people ? crowd_size(body) : 1.0f };
    return place;
}

/* The n-th clip, modulo their count, of those with joints (joints 1) or of those without (0); NOH_NONE: there is none.
 */
static uint32_t nth_clip(const noh_clip_set *set, uint32_t n, int joints)
{
    uint32_t count = 0, m = 0;
    for (uint32_t i = 0; i < set->clip_count; i++) {
        count += ((set->clips[i].flags & NOH_CLIP_FLOATS_ONLY) == 0) == joints;
    }
    if (count == 0) {
        return NOH_NONE;
    }
    for (n %= count; ((set->clips[m].flags & NOH_CLIP_FLOATS_ONLY) == 0) != joints || n-- > 0; m++) {}
    return m;
}

static noh_result play(crowd *c, noh_actor actor, uint32_t body, uint32_t layer, uint32_t clip, const noh_clip_set *set,
                       noh_error *error)
{
    const char *name = noh_stage_name(c->stage, 0, NOH_NAME_CLIP, clip);
    noh_play p;
    memset(&p, 0, sizeof p);
    p.fade_ticks = 1;
    p.start_ticks = (int64_t)(spread(body + 1u, SPREAD_Y) * 1e6f);
    p.speed = (int32_t)((0.8f + 0.4f * spread(body + 1u, SPREAD_LINE)) * 65536.0f);
    if (!name) {
        return NOH_OK; /* the pack has none of that sort */
    }
    if (set->clips[clip].loop == NOH_LOOP_ONCE) {
        p.loop = NOH_LOOP_PING_PONG;
    }
    return noh_actor_play(c->stage, actor, layer, name, &p, error);
}

static noh_result enter(crowd *c, uint32_t body, noh_error *error)
{
    const noh_place place = place_of(body, c->options.people);
    const noh_clip_set *set = NULL;
    noh_actor *actor = &c->actors[body];
    noh_result result = noh_stage_spawn(c->stage, 0, &place, actor, error);
    if (!result && c->options.people) {
        const noh_appearance look = crowd_look(body);
        result = noh_actor_set_appearance(c->stage, *actor, &look, error);
    }
    if (!result) {
        (void)noh_actor_controller(c->stage, *actor, &set);
        result = play(c, *actor, body, BODY, nth_clip(set, body, 1), set, error);
    }
    if (!result) result = play(c, *actor, body, FACE, nth_clip(set, body / 3u, 0), set, error);
    return result;
}

/* ---- opening ---- */

static noh_result open_shader(crowd *c, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_shader_desc desc = { .name = "crowd", .view = c->options.view };
    const size_t bytes = noh_stage_shader_size(c->stage);
    if (c->options.view == NOH_VIEW_LIT) {
        return NOH_OK;
    }
    c->shader_memory = malloc(bytes);
    if (!c->shader_memory) {
        return noh_fail(error, NOH_ERR_MEMORY, "out of memory", 0, bytes);
    }
    return noh_stage_shader_create(c->stage, c->shader_memory, bytes, &desc, log, log_bytes, &c->shader, error);
}

static noh_result open_spots(crowd *c, const noh_gl_device *device, noh_error *error)
{
    c->actors = calloc(c->options.count, sizeof *c->actors);
    if (!c->actors) return noh_fail(error, NOH_ERR_MEMORY, "out of memory", 0, 0);
    if (!c->options.spots || c->options.view != NOH_VIEW_LIT) return NOH_OK;
    const noh_result result = noh_blob_rig_make(&c->kind, &c->rig, error);
    return result ? result : noh_stage_blob_create(device, &c->blob, error);
}

/* Far bodies have no shadow but their spots: a map of all the field would be coarse. */
static int open_light(crowd *c, const pack_file *file)
{
    light_options light = { .light = NULL };
    if (c->options.light) light = *c->options.light;
    light.shadow = "off";
    return lighting_wanted(&light, &file->pack, c->options.view == NOH_VIEW_LIT) ? lighting_open(&c->light, &light) : 0;
}

static noh_result open_backdrop(crowd *c, gpu *g, noh_error *error)
{
    char log[4096] = "";
    const noh_gl_device device = { &g->gl, &g->caps, &c->behind, log, sizeof log };
    if (!c->light.name) return NOH_OK;
    noh_stage_set_lighting(c->stage, &c->light.told);
    return noh_backdrop_create(&device, 0, &c->backdrop, error);
}

static noh_result open_stage(crowd *c, gpu *g, noh_error *error)
{
    char log[4096] = "";
    const noh_gl_device device = { &g->gl, &g->caps, &c->ledger, log, sizeof log };
    noh_result result = noh_stage_plan_make(&c->desc, &g->caps, &c->plan, error);
    if (result) {
        return result;
    }
    c->memory = malloc((size_t)c->plan.cpu_bytes);
    result = c->memory
                 ? noh_stage_init(c->memory, (size_t)c->plan.cpu_bytes, &device, &c->desc, &c->plan, &c->stage, error)
                 : noh_fail(error, NOH_ERR_MEMORY, "out of memory", 0, c->plan.cpu_bytes);
    if (result) {
        c->stage = NULL;
    } else {
        result = open_shader(c, log, sizeof log, error);
        if (!result) result = open_spots(c, &device, error);
        if (!result) result = open_backdrop(c, g, error);
    }
    if (result) fputs(log, stderr);
    return result;
}

int crowd_open(crowd *c, gpu *g, const pack_file *file, const crowd_options *options)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_result result;
    int status;
    memset(c, 0, sizeof *c);
    status = fill_options(c, options);
    if (!status) status = find_skeleton(c, file);
    if (!status) status = open_light(c, file);
    if (status) {
        return status;
    }
    fill_desc(c, file);
    result = drawn_hair_plan(&c->hair, &file->pack, 0, c->kind.skeleton, c->options.count, &error);
    if (!result) result = open_stage(c, g, &error);
    for (uint32_t i = 0; i < c->options.count && !result; i++) result = enter(c, i, &error);
    if (result) {
        crowd_close(c);
        return tool_fail_error(file->path, &error);
    }
    if (c->options.view == NOH_VIEW_LIT)
        status = drawn_hair_open(&c->hair, g, &c->ledger, c->light.name != NULL);
    else
        c->hair.is_there = 0;
    if (status) crowd_close(c);
    return status;
}

void crowd_close(crowd *c)
{
    drawn_hair_close(&c->hair);
    if (c->shader) noh_stage_shader_delete(c->shader);
    noh_stage_blob_delete(&c->blob);
    noh_backdrop_delete(&c->backdrop);
    lighting_close(&c->light);
    if (c->stage) noh_stage_delete(c->stage);
    free(c->shader_memory);
    free(c->memory);
    free(c->actors);
    memset(c, 0, sizeof *c);
}

/* ---- a frame ---- */

static void on_key(void *user, noh_stage *stage, const noh_stage_event *event)
{
    crowd_events *events = user;
    const uint64_t what[4] = { event->actor.id, event->clip, event->index, (uint64_t)event->clock };
    uint64_t hash = 14695981039346656037u;
    (void)stage;
    for (int i = 0; i < 4; i++) {
        hash = (hash ^ what[i]) * 1099511628211u;
    }
    events->count++;
    events->sum += hash;
}

void crowd_frame(crowd *c, uint32_t ticks, const noh_stage_view *view)
{
    (void)noh_stage_frame(c->stage, ticks, view, on_key, &c->events, NULL); /* a camera of ours is finite */
    drawn_hair_frame(&c->hair, c->stage, ticks);
    c->seen = *view;
}

/* Many bodies at once: a draw has a fixed cost. */
static void draw_spots(crowd *c)
{
    const noh_plane plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    const noh_world world = { .planes = &plane, .plane_count = 1 };
    const noh_ground ground = { &world, NULL, NULL };
    noh_blob blobs[16u * NOH_BLOBS_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->options.count; i++) {
        count += noh_actor_blobs(c->stage, c->actors[i], &c->rig, &ground, blobs + count);
        if (count + NOH_BLOBS_MAX <= sizeof blobs / sizeof blobs[0] && i + 1u < c->options.count) continue;
        noh_stage_blob_draw(&c->blob, &c->seen, blobs, count);
        count = 0;
    }
}

void crowd_draw(crowd *c)
{
    if (c->light.name)
        noh_backdrop_draw(&c->backdrop, NOH_BACKDROP_LIGHT, noh_stage_light_of(c->stage), &c->light.told, &c->seen);
    if (c->blob.drawable.gl) draw_spots(c);
    (void)noh_stage_draw(c->stage, NOH_PASS_COLOR, 0, c->shader, NULL); /* a frame with a view was before */
    drawn_hair_update(&c->hair);
    drawn_hair_draw(&c->hair, c->stage, 0, NOH_PASS_COLOR);
}

/* ---- the camera ---- */

#define AHEAD_M 20.0f /* noh_view_orbit then sees from 0.2 m on */

noh_stage_view crowd_camera_at(const crowd *c, const float eye[3], float heading_rad, float down_rad)
{
    const float ahead[3] = { sinf(heading_rad) * cosf(down_rad), -sinf(down_rad), -cosf(heading_rad) * cosf(down_rad) };
    static const float light[3] = { -0.424f, 0.778f, 0.463f };
    noh_stage_view view;
    float target[3];
    for (int i = 0; i < 3; i++) target[i] = eye[i] + AHEAD_M * ahead[i];
    noh_view_orbit(&view, target, -heading_rad, down_rad, AHEAD_M, c->options.width, c->options.height);
    memcpy(view.light, light, sizeof view.light);
    return view;
}

noh_stage_view crowd_camera_start(const crowd *c)
{
    static const float eye[3] = { 0.0f, 4.0f, 0.0f };
    return crowd_camera_at(c, eye, 0.0f, 0.14f);
}
