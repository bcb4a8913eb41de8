/* cast.c: twenty figures of two kinds in 2 MiB walk and speak, each with its own tint, lit by the game's own shader
 * with a shadow map. The figure in the middle of the picture bows. The game steps 30 times a second and draws 60
 * frames. Prints a line of JSON and saves the last frame.
 *
 *   cast PACK [CLIPPACK] [--seconds S] [--bytes N] [--json] [-o OUT.png]
 *
 * Links EGL. */
#define _POSIX_C_SOURCE 199309L
#include <string.h>

#include "measure.h"
#include "start.h"
#include "target.h"
#include "toon.h"
#include "noh/noh_gl.h"

#define ACTORS 20u
#define HEROES 4u
#define WIDTH 1280
#define HEIGHT 720
#define SHADOW 1024
#define FRAME_TICKS (NOH_TICKS_PER_SECOND / 60u)

typedef struct cast {
    noh_stage *stage;
    noh_stage_plan plan;
    noh_stage_view views[2]; /* the camera, the light */
    target picture, shadow;
    noh_stage_shader *toon;
    noh_actor actors[ACTORS];
    uint32_t keys, late_frames, gl_errors;
    uint64_t cpu_bytes; /* of the block */
    double ns;          /* of steps and jobs */
} cast;

static noh_gl gl;

static void bind_toon(void *user, const noh_gl_api *api, GLuint program, const noh_material *material)
{
    const cast *c = user;
    (void)material;
    api->UniformMatrix4fv(api->GetUniformLocation(program, "u_shadow"), 1, GL_FALSE, c->views[1].view_projection);
    api->Uniform3f(api->GetUniformLocation(program, "u_light"), c->views[0].light[0], c->views[0].light[1],
                   c->views[0].light[2]);
    api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER);
    api->BindTexture(GL_TEXTURE_2D, c->shadow.depth);
}

static int open_shader(cast *c)
{
    static const char *const samplers[] = { "u_shadow_map" };
    const noh_gl_shader_desc d = { "toon",    toon_vertex, toon_fragment, NULL, samplers, 1,
                                   bind_toon, c,           NOH_VIEW_LIT,  NULL, 0,        NULL };
    const size_t bytes = noh_stage_shader_size(c->stage);
    noh_error e = { NOH_ERR_MEMORY, "malloc", 0, bytes };
    void *memory = malloc(bytes);
    return !memory || noh_stage_shader_create(c->stage, memory, bytes, &d, gl.log, sizeof gl.log, &c->toon, &e)
               ? start_fail(&gl, "toon", &e)
               : 0;
}

/* The whole request in one place: two kinds of the same figure, within a limit of bytes. */
static int open_stage(cast *c, const noh_pack *mesh, const noh_pack *const *clips, uint32_t clip_count, uint64_t bytes)
{
    noh_kind_desc kinds[2] = { { .name = "hero", .actor_count = HEROES },
                               { .name = "extra", .actor_count = ACTORS - HEROES } };
    const noh_stage_desc desc = {
        .kinds = kinds, .kind_count = 2, .bytes_max = bytes, .height_px = HEIGHT, .gpu = &noh_stage_on_gl
    };
    noh_error e;
    void *memory;
    for (int i = 0; i < 2; i++) {
        kinds[i].mesh = mesh;
        kinds[i].clip_packs = clips;
        kinds[i].clip_pack_count = clip_count;
        kinds[i].root_axes = NOH_ROOT_GROUND;
        kinds[i].springs = noh_springs_module(NULL); /* sleeves and hems swing */
    }
    if (noh_stage_plan_make(&desc, &gl.caps, &c->plan, &e)) return start_fail(&gl, "plan", &e);
    for (uint32_t i = 0; i < c->plan.concession_count; i++) {
        const noh_concession *g = &c->plan.concessions[i];
        fprintf(stderr, "gave up: %s, now %u, %.2f pixels, for %llu bytes\n", g->what, g->value, (double)g->loss_pixels,
                (unsigned long long)(g->cpu_bytes + g->gpu_bytes));
    }
    c->cpu_bytes = c->plan.cpu_bytes;
    memory = malloc((size_t)c->cpu_bytes); /* from here on only the shader allocates */
    if (!memory || noh_stage_init(memory, (size_t)c->cpu_bytes, &gl.device, &desc, &c->plan, &c->stage, &e))
        return start_fail(&gl, "stage", &e);
    return open_shader(c);
}

static int enter(cast *c)
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { .position = { 1.4f * (float)(i % 5u) - 2.8f, 0.0f, -1.6f * (float)(i / 5u) } };
        const noh_appearance look = { .tint = { 255, (uint8_t)(205u + 25u * (i % 3u)), (uint8_t)(190u + 59u * i % 66u),
                                                255 } };
        const noh_play walk = { .speed = 58000 + 900 * (int32_t)i, .start_ticks = 7001 * (int64_t)i };
        noh_error e;
        if (noh_stage_spawn(c->stage, i >= HEROES, &place, &c->actors[i], &e) ||
            noh_actor_play(c->stage, c->actors[i], 0, "walk", &walk, &e) ||
            noh_actor_set_appearance(c->stage, c->actors[i], &look, &e))
            return start_fail(&gl, "actor", &e);
        (void)noh_actor_play(c->stage, c->actors[i], 1, "speak", NULL, NULL); /* if the pack has this clip */
    }
    return 0;
}

/* Let the figure in the middle of the picture bow. */
static void pick(cast *c)
{
    float origin[3], direction[3];
    noh_stage_hit hit;
    if (noh_view_ray(&c->views[0], WIDTH / 2.0f, HEIGHT / 2.0f, WIDTH, HEIGHT, origin, direction) &&
        noh_stage_pick(c->stage, origin, direction, 100.0f, &hit, NULL) == NOH_OK) {
        const noh_play slowly = { .fade_ticks = NOH_TICKS_PER_SECOND / 2, .flags = NOH_PLAY_KEEP };
        (void)noh_actor_play(c->stage, hit.actor, 0, "bow", &slowly, NULL);
    }
}

/* A step is two frames long: the first shows its middle, the second its end. */
static int frame(cast *c, uint32_t number)
{
    const float walked = 0.0073f * (float)number, middle[3] = { 0.0f, 0.8f, walked - 1.5f };
    const float all[4] = { 0.0f, 1.0f, walked - 2.0f, 6.0f };
    uint32_t count;
    noh_error e;
    noh_view_orbit(&c->views[0], middle, 0.6f + 0.001f * (float)number, 0.2f, 8.0f, WIDTH, HEIGHT);
    noh_view_shadow(&c->views[1], all, c->views[0].light);
    c->ns -= measure_ns();
    if (number % 2u == 0 && noh_stage_step(c->stage, 2u * FRAME_TICKS, NULL, NULL, &e))
        return start_fail(&gl, "step", &e);
    if (noh_stage_frame_between(c->stage, c->views, 2, number % 2u ? 1.0f : 0.5f, &e))
        return start_fail(&gl, "frame", &e);
    while ((count = noh_stage_jobs(c->stage)) > 0) { /* each phase may run on any number of threads */
        for (uint32_t i = 0; i < count; i++) noh_stage_job(c->stage, i);
    }
    c->ns += measure_ns();
    if (noh_stage_frame_end(c->stage, &e)) return start_fail(&gl, "frame", &e);
    (void)noh_stage_events(c->stage, &count);
    c->keys += number % 2u ? 0 : count;
    c->late_frames += noh_stage_stats_of(c->stage)->decoded_late > 0;
    if (number % 60u == 30u) pick(c);
    target_clear(&gl.api, &c->shadow);
    if (noh_stage_draw(c->stage, NOH_PASS_DEPTH, 1, NULL, &e)) return start_fail(&gl, "shadow", &e);
    target_clear(&gl.api, &c->picture);
    if (noh_stage_draw(c->stage, NOH_PASS_COLOR, 0, c->toon, &e)) return start_fail(&gl, "colour", &e);
    c->gl_errors += gl.api.GetError() != GL_NO_ERROR;
    return 0;
}

/* The toon shader has a renderer of its own. */
static void print(const cast *c, uint32_t frames, unsigned allocated)
{
    printf("{\"actors\": %u, \"frames\": %u, \"cpu_bytes\": %llu, \"gpu_bytes\": %llu, \"cpu_predicted\": %llu, "
           "\"gpu_predicted\": %llu, \"allocations\": %u, \"gl_errors\": %u, \"keys\": %u, \"late_frames\": %u, "
           "\"ns_per_actor\": %.0f}\n",
           ACTORS, frames, (unsigned long long)c->cpu_bytes, (unsigned long long)noh_gl_ledger_bytes(&gl.ledger),
           (unsigned long long)c->plan.cpu_bytes, (unsigned long long)c->plan.gpu_bytes + NOH_GL_RENDERER_BYTES,
           allocated, c->gl_errors, c->keys, c->late_frames, frames ? c->ns / frames / ACTORS : 0.0);
}

int main(int argc, char **argv)
{
    static cast c;
    static noh_pack packs[2];
    const noh_pack *clips[2] = { &packs[0], &packs[1] };
    const char *out = NULL;
    uint32_t frames = 300, pack_count = 0;
    uint64_t bytes = 2u << 20;
    unsigned before;
    int json = 0;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--json"))
            json = 1;
        else if (!strcmp(argv[i], "-o") && i + 1 < argc)
            out = argv[++i];
        else if (!strcmp(argv[i], "--seconds") && i + 1 < argc)
            frames = (uint32_t)(60.0 * atof(argv[++i]));
        else if (!strcmp(argv[i], "--bytes") && i + 1 < argc)
            bytes = strtoull(argv[++i], NULL, 10);
        else if (pack_count == 2 || start_pack(&gl, argv[i], &packs[pack_count++]))
            return 2;
    }
    if (!pack_count || start_gl(&gl)) return 2;
    target_make(&gl.api, WIDTH, HEIGHT, 0, &c.picture);
    target_make(&gl.api, SHADOW, SHADOW, 1, &c.shadow);
    if (open_stage(&c, &packs[0], clips, pack_count, bytes)) return 1;
    before = measure_allocations; /* allocations of the packs and the stage */
    if (!before) return fprintf(stderr, "allocations are not counted: see measure.h\n"), 1;
    if (enter(&c)) return 1;
    for (uint32_t i = 0; i < frames; i++) {
        if (frame(&c, i)) return 1;
    }
    if (json) print(&c, frames, measure_allocations - before);
    return out && target_save(&gl.api, &c.picture, out);
}
