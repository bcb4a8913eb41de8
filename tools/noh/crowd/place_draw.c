#include "place_draw.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "crowd_hair.h"
#include "gpu/canvas.h"
#include "stage/view.h"

#define FRAME_TICKS NOH_CROWD_STEP_TICKS
#define SHOWN_FRAMES 24u  /* before the picture, so that feet and levels have settled */
#define HIT_HEIGHT_M 1.2f /* above the ground */
#define RADIAN 0.017453292519943295

enum { PEOPLE, SCENERY, KINDS };

typedef struct scene {
    const pack_file *file;
    const place_file *place;
    const place_draw_options *options;
    place_life *life;
    lighting light;
    pack_file scenery;
    noh_kind_desc kinds[KINDS];
    place_people people;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_gl_ledger ledger;
    noh_stage *stage;
    noh_walkers *walkers;
    void *memory, *walkers_memory;
    noh_backdrop backdrop;
    noh_stage_terrain terrain; /* drawn where the place has a ground */
    void *terrain_memory;
    crowd_hair hair;
    noh_actor *actors;
    noh_smart_phase *phases; /* as they are shown */
    size_t walkers_bytes;
    uint32_t near_count, step, fell, down;
} scene;

static void fill_desc(scene *s)
{
    s->kinds[PEOPLE] = s->people.kind;
    s->kinds[SCENERY].mesh = &s->scenery.pack;
    s->kinds[SCENERY].actor_count = 1;
    s->kinds[SCENERY].skeleton = NOH_NONE;
    s->kinds[SCENERY].unpickable = 1;
    s->desc.kinds = s->kinds;
    s->desc.kind_count = s->options->scenery ? KINDS : SCENERY;
    s->desc.lod.pixels = s->options->pixels;
    s->desc.height_px = s->options->height;
    s->desc.light = &s->light.desc;
    s->desc.gpu = &noh_stage_on_gl;
}

/* ---- opening ---- */

static int open_terrain(scene *s, const noh_gl_device *device)
{
    const noh_stage_terrain_desc desc = { .lit = 1 };
    const size_t bytes = noh_stage_terrain_size(s->place->ground);
    noh_error error = { NOH_OK, "", 0, 0 };
    s->terrain_memory = malloc(bytes);
    if (!s->terrain_memory) return tool_fail("terrain", "out of memory");
    if (noh_stage_terrain_create(device, s->place->ground, &desc, s->terrain_memory, bytes, &s->terrain, &error)) {
        return tool_fail_error("terrain", &error);
    }
    return 0;
}

static int open_stage(scene *s, gpu *g)
{
    char log[4096] = "";
    const noh_gl_device device = { &g->gl, &g->caps, &s->ledger, log, sizeof log };
    noh_error error = { NOH_OK, "", 0, 0 };
    if (noh_stage_plan_make(&s->desc, &g->caps, &s->plan, &error)) return tool_fail_error(s->file->path, &error);
    s->memory = malloc((size_t)s->plan.cpu_bytes);
    if (!s->memory) return tool_fail(s->file->path, "out of memory");
    if (noh_stage_init(s->memory, (size_t)s->plan.cpu_bytes, &device, &s->desc, &s->plan, &s->stage, &error)) {
        s->stage = NULL;
        fputs(log, stderr);
        return tool_fail_error(s->file->path, &error);
    }
    noh_stage_set_lighting(s->stage, &s->light.told);
    if (noh_backdrop_create(&device, 0, &s->backdrop, &error)) return tool_fail_error("backdrop", &error);
    return s->place->ground ? open_terrain(s, &device) : 0;
}

static int open_walkers(scene *s)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_walkers_desc desc = s->people.walkers;
    desc.idle = noh_stage_find(s->stage, PEOPLE, NOH_NAME_CLIP, "idle") == NOH_NONE ? NULL : "idle";
    desc.run = noh_stage_find(s->stage, PEOPLE, NOH_NAME_CLIP, "run") == NOH_NONE ? NULL : "run";
    s->walkers_bytes = noh_walkers_size(&desc);
    s->walkers_memory = malloc(s->walkers_bytes);
    if (!s->walkers_memory) return tool_fail(s->file->path, "out of memory");
    if (noh_walkers_init(s->walkers_memory, s->walkers_bytes, &desc, s->stage, &s->walkers, &error)) {
        return tool_fail(s->file->path, "%s; a place wants a clip 'walk', best an 'idle'", error.what);
    }
    return 0;
}

/* A number of 0 to 1 for a person, another for each `which`. */
static float share_of(uint32_t person, uint32_t which)
{
    uint32_t x = (person + 1u) * 2654435769u + which * 2246822519u;
    x = (x ^ (x >> 15)) * 2246822519u;
    x = (x ^ (x >> 13)) * 3266489917u;
    return (float)((x ^ (x >> 16)) >> 8) / 16777216.0f;
}

static noh_look look_of(uint32_t person)
{
    static const uint8_t robes[][3] = { { 255, 255, 255 }, { 255, 208, 188 }, { 205, 220, 255 }, { 236, 244, 208 },
                                        { 255, 238, 188 }, { 228, 208, 255 }, { 186, 186, 192 }, { 255, 204, 220 } };
    const uint8_t *robe = robes[(uint32_t)(share_of(person, 0) * 8.0f)];
    const float shade = 0.6f + 0.4f * share_of(person, 1);
    noh_look look;
    memset(&look, 0, sizeof look);
    for (int i = 0; i < 3; i++) look.tint[i] = (uint8_t)(shade * (float)robe[i]);
    look.tint[3] = 255;
    return look;
}

/* Of the ground; 0 without one. */
static float height_at(const place_file *place, const float at[2])
{
    float height = 0.0f;
    if (place->ground) (void)noh_field_height(place->ground, at[0], at[1], &height, NULL);
    return height;
}

static int enter(scene *s, uint32_t person)
{
    static const char *const faces[] = { "smile", "surprise", "frown", "anger" };
    const noh_look look = look_of(person);
    const float *at = place_life_agent(s->life, person)->position;
    noh_place place = { .rotation = { 0.0f, 0.0f, 0.0f, 1.0f }, .scale = 1.0f };
    const float turn = 6.2831853f * share_of(person, 2), heading[2] = { sinf(turn), cosf(turn) };
    const uint32_t face = share_of(person, 3) < 0.7f ? 0u : (uint32_t)(4.0f * share_of(person, 4));
    const uint32_t shown = noh_stage_find(s->stage, PEOPLE, NOH_NAME_FLOAT, faces[face]);
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_actor *a = &s->actors[person];
    place.position[1] = height_at(s->place, at);
    if (noh_stage_spawn(s->stage, PEOPLE, &place, a, &error) || noh_actor_set_look(s->stage, *a, &look, &error) ||
        noh_walkers_put(s->walkers, person, s->stage, *a, person, heading, &error)) {
        return tool_fail_error(s->file->path, &error);
    }
    if (shown != NOH_NONE) (void)noh_actor_hold_float(s->stage, *a, shown, share_of(person, 5), 1.0f, NULL);
    return 0;
}

static int enter_all(scene *s)
{
    const uint32_t count = place_life_agents(s->life);
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_actor still;
    int status = 0;
    s->actors = calloc(count, sizeof *s->actors);
    s->phases = calloc(count, sizeof *s->phases);
    if (!s->actors || !s->phases) return tool_fail(s->file->path, "out of memory");
    if (s->options->scenery && noh_stage_spawn(s->stage, SCENERY, NULL, &still, &error)) {
        return tool_fail_error(s->options->scenery, &error);
    }
    for (uint32_t i = 0; i < count && !status; i++) status = enter(s, i);
    return status;
}

static int open_scene(scene *s, gpu *g)
{
    const place_draw_options *o = s->options;
    light_options light = o->light;
    int status = lighting_wanted(&light, 1) ? 0 : tool_usage("a place is lit: --light is not 'none'");
    if (!status) status = lighting_open(&s->light, &light);
    if (!status && o->scenery) status = pack_file_open(&s->scenery, o->scenery);
    if (!status) status = place_life_open(s->place, o->agents, o->seed, &s->life);
    if (!status)
        status = place_people_make(&s->people, s->file, s->place, o->agents, o->hit.is_given ? PLACE_RAGDOLLS : 0u);
    if (!status) fill_desc(s);
    if (!status) status = open_stage(s, g);
    if (!status) {
        const noh_kind_desc *k = &s->kinds[PEOPLE];
        status = crowd_hair_plan(&s->hair, s->file, PEOPLE, k->skeleton, k->actor_count);
    }
    if (!status) status = crowd_hair_open(&s->hair, g, &s->ledger, 1);
    if (!status) status = open_walkers(s);
    return status ? status : enter_all(s);
}

static void close_scene(scene *s)
{
    crowd_hair_close(&s->hair);
    if (s->backdrop.gl) noh_backdrop_delete(&s->backdrop);
    if (s->terrain.gl) noh_stage_terrain_delete(&s->terrain);
    free(s->terrain_memory);
    if (s->stage) noh_stage_delete(s->stage);
    if (s->life) place_life_close(s->life);
    if (s->scenery.path) pack_file_close(&s->scenery);
    lighting_close(&s->light);
    free(s->memory);
    free(s->walkers_memory);
    free(s->actors);
    free(s->phases);
}

/* ---- frames ---- */

/* A clip of the place; 0: none. Loops begin anywhere, so that neighbours are not in step. */
static void play_clip(const scene *s, uint32_t person, uint32_t clip, noh_loop loop)
{
    noh_play play;
    if (!clip) return;
    memset(&play, 0, sizeof play);
    play.fade_ticks = 24000;
    play.loop = loop;
    if (loop == NOH_LOOP_REPEAT) {
        play.speed = (int32_t)(65536.0f * (0.8f + 0.4f * share_of(person, 6)));
        play.start_ticks = (int64_t)(480000.0f * share_of(person, 7));
    }
    (void)noh_actor_play(s->stage, s->actors[person], PLACE_ACT, s->place->clips[clip - 1u], &play, NULL);
}

/* What a slot lets its holder do: enter it, facing its way, use it and leave it, by its clips. */
static void act(scene *s, uint32_t person)
{
    const noh_smart_use use = place_life_use(s->life, person);
    if (use.phase == s->phases[person]) return;
    const noh_smart_slot *slot = use.phase >= NOH_SMART_GOING ? place_life_slot(s->life, use.slot) : NULL;
    const uint32_t leaves = use.phase == NOH_SMART_LEAVING ? slot->leave_clip : 0u;
    if (use.phase == NOH_SMART_ENTERING) {
        noh_walkers_face(s->walkers, person, slot->face);
        play_clip(s, person, slot->enter_clip, NOH_LOOP_ONCE);
    } else if (use.phase == NOH_SMART_USING) {
        noh_walkers_face(s->walkers, person, slot->face);
        play_clip(s, person, slot->use_clip, NOH_LOOP_REPEAT);
    } else if (leaves) {
        play_clip(s, person, leaves, NOH_LOOP_ONCE);
    } else {
        noh_walkers_face(s->walkers, person, NULL);
        (void)noh_actor_stop(s->stage, s->actors[person], PLACE_ACT, 24000, NULL);
    }
    s->phases[person] = use.phase;
}

/* Who falls is let alone until it stands. */
static void fall(scene *s)
{
    const place_hit *hit = &s->options->hit;
    if (!hit->is_given) return;
    if (s->step == (uint32_t)(hit->time_s * 30.0f + 0.5f)) {
        const float point[3] = { hit->at[0], height_at(s->place, hit->at) + HIT_HEIGHT_M, hit->at[1] };
        s->fell = noh_walkers_push(s->walkers, s->stage, point, hit->radius, hit->impulse);
    }
    s->down = noh_walkers_tend(s->walkers, place_life_crowd(s->life), s->stage, PLACE_ACT, FRAME_TICKS, NULL);
    for (uint32_t i = 0; i < place_life_agents(s->life); i++) {
        const int is_down = noh_walkers_is_down(s->walkers, i);
        place_life_set_down(s->life, i, is_down);
        if (is_down) s->phases[i] = NOH_SMART_AWAY; /* what it did is over */
    }
}

static void step(scene *s)
{
    fall(s);
    place_life_step(s->life);
    for (uint32_t i = 0; i < place_life_agents(s->life); i++) {
        if (!noh_walkers_is_down(s->walkers, i)) act(s, i);
    }
    (void)noh_walkers_step(s->walkers, place_life_crowd(s->life), s->stage, &s->people.feet.ground, FRAME_TICKS, NULL);
    (void)noh_stage_step(s->stage, FRAME_TICKS, NULL, NULL, NULL);
    s->step++;
}

static int camera_of(const scene *s, noh_stage_view *view)
{
    const place_area *a = &s->place->area;
    const float wide = hypotf(a->high[0] - a->low[0], a->high[1] - a->low[1]);
    double azimuth = 0.0, elevation = 25.0, distance = 1.2 * (double)wide, x = 0.5 * (double)(a->low[0] + a->high[0]),
           z = 0.5 * (double)(a->low[1] + a->high[1]);
    char end;
    if (s->options->camera) {
        const int count = sscanf(s->options->camera, "%lf,%lf,%lf,%lf,%lf%c", &azimuth, &elevation, &distance, &x, &z,
                                 &end);
        if (count != 3 && count != 5) {
            return tool_usage("--camera of a place wants AZ,EL,DIST or AZ,EL,DIST,X,Z, not '%s'", s->options->camera);
        }
    }
    if (!(fabs(x) <= 1e5) || !(fabs(z) <= 1e5) || !(fabs(azimuth) <= 3600.0) ||
        !(elevation >= -89.0 && elevation <= 89.0) || !(distance > 0.0 && distance < 1e5)) {
        return tool_usage("--camera wants EL from -89 to 89, DIST above 0 and a place that is not far away");
    }
    const float at[2] = { (float)x, (float)z }, target[3] = { at[0], 1.0f + height_at(s->place, at), at[1] };
    noh_view_orbit(view, target, (float)(azimuth * RADIAN), (float)(elevation * RADIAN), (float)distance,
                   s->options->width, s->options->height);
    return 0;
}

static int show(scene *s, const noh_stage_view views[2])
{
    noh_error error = { NOH_OK, "", 0, 0 };
    s->near_count = noh_walkers_near(s->walkers, s->stage, views[0].eye);
    if (noh_stage_frame_begin(s->stage, views, s->light.has_shadow ? 2u : 1u, &error) ||
        noh_stage_frame_end(s->stage, &error)) {
        return tool_fail_error(s->file->path, &error);
    }
    crowd_hair_frame(&s->hair, s->stage, FRAME_TICKS);
    return 0;
}

/* All steps up to the time; frames before the last one are not drawn. */
static int run(scene *s, const noh_stage_view views[2], double time_s)
{
    const uint32_t steps = (uint32_t)(time_s * 30.0 + 0.5);
    int status = 0;
    while (s->step < steps || s->step < 2u) {
        const uint32_t i = s->step;
        step(s);
        if (i + SHOWN_FRAMES >= steps && !status) status = show(s, views);
    }
    return status;
}

static int paint(scene *s, gpu *g, const noh_stage_view views[2], uint8_t *rgba)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    canvas target;
    int status;
    if (s->light.has_shadow && noh_stage_draw_shadow(s->stage, 1, &error)) {
        return tool_fail_error(s->file->path, &error);
    }
    if (s->terrain.gl) noh_stage_terrain_choose(&s->terrain, &views[0], s->options->pixels);
    if (s->terrain.gl && s->light.has_shadow) noh_stage_terrain_draw_shadow(&s->terrain, s->stage, &views[1]);
    crowd_hair_update(&s->hair);
    if (s->light.has_shadow) crowd_hair_draw_shadow(&s->hair, s->stage, 1);
    status = canvas_open(&target, g, s->options->width, s->options->height);
    if (status) return status;
    canvas_begin(&target);
    noh_backdrop_draw(&s->backdrop,
                      s->light.background == BACKGROUND_LIGHT ? NOH_BACKDROP_LIGHT : NOH_BACKDROP_GRADIENT,
                      noh_stage_light_of(s->stage), &s->light.told, &views[0]);
    if (s->terrain.gl) noh_stage_terrain_draw(&s->terrain, s->stage, &views[0]);
    if (noh_stage_draw(s->stage, NOH_PASS_COLOR, 0, NULL, &error)) status = tool_fail_error(s->file->path, &error);
    crowd_hair_draw(&s->hair, s->stage, 0);
    if (!status) status = canvas_read(&target, rgba);
    canvas_close(&target);
    return status;
}

/* Each picture into its columns. */
static int paint_all(scene *s, gpu *g, const noh_stage_view views[2], uint8_t *rgba)
{
    const place_draw_options *o = s->options;
    const size_t row = (size_t)o->width * 4u;
    uint8_t *one = malloc(row * o->height);
    int status = one ? 0 : tool_fail(s->file->path, "out of memory");
    for (uint32_t i = 0; i < o->count && !status; i++) {
        status = run(s, views, o->time_s + i * o->apart_s);
        if (!status) status = paint(s, g, views, one);
        for (uint32_t y = 0; y < o->height && !status; y++) {
            memcpy(rgba + (y * (size_t)o->count + i) * row, one + y * row, row);
        }
    }
    free(one);
    return status;
}

static void take_drawn(const scene *s, place_drawn *d)
{
    uint64_t cpu, on_gpu;
    crowd_hair_bytes(&s->hair, &cpu, &on_gpu);
    memset(d, 0, sizeof *d);
    d->stats = *noh_stage_stats_of(s->stage);
    d->agents = place_life_agents(s->life);
    d->level_count = s->plan.kinds[PEOPLE].level_count;
    d->near_count = s->near_count;
    d->fell = s->fell;
    d->down = s->down;
    d->cpu_bytes = s->plan.cpu_bytes + cpu;
    d->gpu_bytes = s->plan.gpu_bytes + on_gpu;
    d->walkers_bytes = s->walkers_bytes;
    d->crowd_bytes = place_life_bytes(s->life);
    if (!s->terrain.gl) return;
    d->terrain_bytes = noh_stage_terrain_size(s->place->ground);
    d->terrain_gpu_bytes = noh_stage_terrain_bytes(s->place->ground);
    d->terrain_blocks = s->terrain.draws;
    d->terrain_triangles = s->terrain.triangles;
}

/* Where something casts a shadow: up to 3 m above the ground. */
static bounds box_of(const place_file *place)
{
    const place_area *a = &place->area;
    const noh_field *f = place->ground;
    double low = f ? 1e9 : 0.0, high = f ? -1e9 : 0.0;
    for (uint32_t i = 0; f && i < f->width * f->depth; i++) {
        const double y = (double)f->origin[1] + (double)f->scale * (double)f->heights[i];
        low = y < low ? y : low;
        high = y > high ? y : high;
    }
    return (bounds){ { (double)a->low[0], low, (double)a->low[1] },
                     { (double)a->high[0], high + 3.0, (double)a->high[1] } };
}

int place_draw(gpu *g, const pack_file *file, const place_file *place, const place_draw_options *o, uint8_t *rgba,
               place_drawn *drawn)
{
    static scene s;
    noh_stage_view views[2];
    int status;
    memset(&s, 0, sizeof s);
    s.file = file;
    s.place = place;
    s.options = o;
    status = camera_of(&s, &views[0]);
    if (!status) status = open_scene(&s, g);
    if (!status) {
        const bounds box = box_of(place);
        memcpy(views[0].light, s.light.told.key_direction, sizeof views[0].light);
        views[1] = lighting_shadow_view(&s.light, &box);
        status = paint_all(&s, g, views, rgba);
    }
    if (!status) take_drawn(&s, drawn);
    close_scene(&s);
    return status;
}
