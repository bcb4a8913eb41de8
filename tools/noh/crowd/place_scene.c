#include "place_scene.h"
#include "crowd_bodies.h"
#include "noh/face.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

#define FRAME_TICKS NOH_CROWD_STEP_TICKS
#define HIT_HEIGHT_M 1.2f /* above the ground */
#define FLOOR_RADII 3.0f  /* of the place */

static void fill_desc(place_scene *s)
{
    s->kinds[PLACE_PEOPLE] = s->people.kind;
    s->kinds[PLACE_SCENERY].mesh = &s->scenery.pack;
    s->kinds[PLACE_SCENERY].actor_count = 1;
    s->kinds[PLACE_SCENERY].skeleton = NOH_NONE;
    s->kinds[PLACE_SCENERY].unpickable = 1;
    s->desc.kinds = s->kinds;
    s->desc.kind_count = s->options->scenery ? PLACE_KINDS : PLACE_SCENERY;
    s->desc.lod.pixels = s->options->pixels;
    s->desc.height_px = s->options->height;
    s->desc.light = &s->light.desc;
    s->desc.encode_srgb = s->options->encode_srgb;
    s->desc.user_values = crowd_user_values(&s->file->pack);
    s->desc.gpu = &noh_stage_on_gl;
}

/* ---- opening ---- */

static int open_terrain(place_scene *s, const noh_gl_device *device)
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

static int open_stage(place_scene *s, gpu *g)
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
    if (s->place->ground) return open_terrain(s, &device);
    if (s->options->scenery) return 0;
    return noh_stage_floor_create(&device, 0, &s->floor, &error) ? tool_fail_error("floor", &error) : 0;
}

static int open_walkers(place_scene *s)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_walkers_desc desc = s->people.walkers;
    desc.idle = noh_stage_find(s->stage, PLACE_PEOPLE, NOH_NAME_CLIP, "idle") == NOH_NONE ? NULL : "idle";
    desc.run = noh_stage_find(s->stage, PLACE_PEOPLE, NOH_NAME_CLIP, "run") == NOH_NONE ? NULL : "run";
    s->walkers_bytes = noh_walkers_size(&desc);
    s->walkers_memory = malloc(s->walkers_bytes);
    if (!s->walkers_memory) return tool_fail(s->file->path, "out of memory");
    if (noh_walkers_init(s->walkers_memory, s->walkers_bytes, &desc, s->stage, &s->walkers, &error)) {
        return tool_fail(s->file->path, "%s: a place needs a pack with a clip 'walk', and preferably 'idle'",
                         error.what);
    }
    return 0;
}

float place_scene_height(const place_file *place, const float at[2])
{
    float height = 0.0f;
    if (place->ground) (void)noh_field_height(place->ground, at[0], at[1], &height, NULL);
    return height;
}

static int enter(place_scene *s, uint32_t person)
{
    static const char *const faces[] = { "smile", "surprise", "frown", "anger" };
    const noh_appearance look = crowd_look(person);
    const float *at = place_life_agent(s->life, person)->position;
    noh_place place = { .rotation = { 0.0f, 0.0f, 0.0f, 1.0f }, .scale = crowd_size(person) };
    const float turn = 6.2831853f * crowd_share(person, 2), heading[2] = { sinf(turn), cosf(turn) };
    const uint32_t face = crowd_share(person, 3) < 0.7f ? 0u : (uint32_t)(4.0f * crowd_share(person, 4));
    const uint32_t shown = noh_stage_find(s->stage, PLACE_PEOPLE, NOH_NAME_FLOAT, faces[face]);
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_actor *a = &s->actors[person];
    place.position[1] = place_scene_height(s->place, at);
    if (noh_stage_spawn(s->stage, PLACE_PEOPLE, &place, a, &error) ||
        noh_actor_set_appearance(s->stage, *a, &look, &error) ||
        noh_walkers_add(s->walkers, person, s->stage, *a, person, heading, &error)) {
        return tool_fail_error(s->file->path, &error);
    }
    if (shown != NOH_NONE) (void)noh_actor_hold_float(s->stage, *a, shown, crowd_share(person, 5), 1.0f, NULL);
    return 0;
}

static int enter_all(place_scene *s)
{
    const uint32_t count = place_life_agents(s->life);
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_actor still;
    int status = 0;
    s->actors = calloc(count, sizeof *s->actors);
    s->phases = calloc(count, sizeof *s->phases);
    if (!s->actors || !s->phases) return tool_fail(s->file->path, "out of memory");
    if (s->options->scenery && noh_stage_spawn(s->stage, PLACE_SCENERY, NULL, &still, &error)) {
        return tool_fail_error(s->options->scenery, &error);
    }
    for (uint32_t i = 0; i < count && !status; i++) status = enter(s, i);
    return status;
}

static int open_all(place_scene *s, gpu *g)
{
    const place_draw_options *o = s->options;
    light_options light = o->light;
    int status = lighting_wanted(&light, NULL, 1)
                     ? 0
                     : tool_usage("--light none cannot draw a place: choose another light");
    if (!status) status = lighting_open(&s->light, &light);
    if (!status && o->scenery) status = pack_file_open_draft(&s->scenery, o->scenery);
    if (!status) status = place_life_open(s->place, o->agents, o->seed, &s->life);
    if (!status)
        status = place_people_make(&s->people, s->file, s->place, o->agents, o->hit.is_given ? PLACE_RAGDOLLS : 0u);
    if (!status) fill_desc(s);
    if (!status) status = open_stage(s, g);
    if (!status) {
        const noh_kind_desc *k = &s->kinds[PLACE_PEOPLE];
        noh_error error = { NOH_OK, "", 0, 0 };
        if (drawn_hair_plan(&s->hair, &s->file->pack, PLACE_PEOPLE, k->skeleton, k->actor_count, &error)) {
            status = tool_fail_error(s->file->path, &error);
        }
    }
    if (!status) status = drawn_hair_open(&s->hair, g, &s->ledger, 1);
    if (!status) status = open_walkers(s);
    return status ? status : enter_all(s);
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

int place_scene_open(place_scene *s, gpu *g, const pack_file *file, const place_file *place,
                     const place_draw_options *o)
{
    bounds box;
    int status;
    memset(s, 0, sizeof *s);
    s->file = file;
    s->place = place;
    s->options = o;
    status = open_all(s, g);
    if (status) return status;
    box = box_of(place);
    s->shadow_view = lighting_shadow_view(&s->light, &box);
    return 0;
}

void place_scene_close(place_scene *s)
{
    drawn_hair_close(&s->hair);
    noh_backdrop_delete(&s->backdrop);
    noh_stage_floor_delete(&s->floor);
    noh_stage_terrain_delete(&s->terrain);
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

/* A clip of the place; 0: none. Loops begin at random times, so that neighbours are not in step. */
static void play_clip(const place_scene *s, uint32_t person, uint32_t clip, noh_loop loop)
{
    noh_play play;
    if (!clip) return;
    memset(&play, 0, sizeof play);
    play.fade_ticks = 24000;
    play.loop = loop;
    if (loop == NOH_LOOP_REPEAT) {
        play.speed = (int32_t)(65536.0f * (0.8f + 0.4f * crowd_share(person, 6)));
        play.start_ticks = (int64_t)(480000.0f * crowd_share(person, 7));
    }
    (void)noh_actor_play(s->stage, s->actors[person], PLACE_ACT, s->place->clips[clip - 1u], &play, NULL);
}

/* The holder of a slot enters it, facing its direction, uses it and leaves it, with its clips. */
static void act(place_scene *s, uint32_t person)
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

/* A body that falls is left alone until it stands. */
static void fall(place_scene *s)
{
    const place_hit *hit = &s->options->hit;
    if (!hit->is_given) return;
    if (s->step == (uint32_t)(hit->time_s * 30.0f + 0.5f)) {
        const float point[3] = { hit->at[0], place_scene_height(s->place, hit->at) + HIT_HEIGHT_M, hit->at[1] };
        s->fell = noh_walkers_push(s->walkers, s->stage, point, hit->radius, hit->impulse);
    }
    s->down = noh_walkers_tend(s->walkers, place_life_crowd(s->life), s->stage, PLACE_ACT, FRAME_TICKS, NULL);
    for (uint32_t i = 0; i < place_life_agents(s->life); i++) {
        const int is_down = noh_walkers_is_down(s->walkers, i);
        place_life_set_down(s->life, i, is_down);
        if (is_down) s->phases[i] = NOH_SMART_AWAY; /* its action is over */
    }
}

void place_scene_step(place_scene *s)
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

int place_scene_show(place_scene *s, const noh_stage_view *view)
{
    const noh_stage_view views[2] = { *view, s->shadow_view };
    noh_error error = { NOH_OK, "", 0, 0 };
    s->near_count = noh_walkers_near(s->walkers, s->stage, view->eye);
    if (noh_stage_frame_begin(s->stage, views, s->light.has_shadow ? 2u : 1u, &error) ||
        noh_stage_frame_end(s->stage, &error)) {
        return tool_fail_error(s->file->path, &error);
    }
    drawn_hair_frame(&s->hair, s->stage, FRAME_TICKS);
    return 0;
}

int place_scene_shadow(place_scene *s, const noh_stage_view *view)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    if (s->light.has_shadow && noh_stage_draw_shadow(s->stage, 1, &error)) {
        return tool_fail_error(s->file->path, &error);
    }
    if (s->terrain.drawable.gl) noh_stage_terrain_choose(&s->terrain, view, s->options->pixels);
    if (s->terrain.drawable.gl && s->light.has_shadow)
        noh_stage_terrain_draw_shadow(&s->terrain, s->stage, &s->shadow_view);
    drawn_hair_update(&s->hair);
    if (s->light.has_shadow) drawn_hair_draw_shadow(&s->hair, s->stage, 1);
    return 0;
}

int place_scene_draw(place_scene *s, const noh_stage_view *view)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    int status = 0;
    noh_backdrop_draw(&s->backdrop,
                      s->light.background == BACKGROUND_LIGHT ? NOH_BACKDROP_LIGHT : NOH_BACKDROP_GRADIENT,
                      noh_stage_light_of(s->stage), &s->light.told, view);
    const float *middle = s->light.sphere, disc[4] = { middle[0], 0.0f, middle[2], FLOOR_RADII * middle[3] };
    if (s->floor.drawable.gl) noh_stage_floor_draw(&s->floor, noh_stage_light_of(s->stage), &s->light.told, view, disc);
    if (s->terrain.drawable.gl) noh_stage_terrain_draw(&s->terrain, s->stage, view);
    if (noh_stage_draw(s->stage, NOH_PASS_COLOR, 0, NULL, &error)) status = tool_fail_error(s->file->path, &error);
    drawn_hair_draw(&s->hair, s->stage, 0, NOH_PASS_COLOR);
    return status;
}
