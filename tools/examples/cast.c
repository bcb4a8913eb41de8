/* cast.c: twenty figures of two kinds in 2 MiB walk, speak and are lit by a shader of the game's own, with a shadow
 * map; who is in the middle of the picture bows. Prints a line of JSON, and saves the last frame.
 *
 *   cast PACK [CLIPPACK] [--seconds S] [--bytes N] [--json] [-o OUT.png]
 *
 * Links EGL. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "egl_context.h"
#include "target.h"

#define ACTORS 20u
#define HEROES 4u
#define WIDTH 1280
#define HEIGHT 720
#define SHADOW 1024
#define FRAME_TICKS (NOH_TICKS_PER_SECOND / 60u)

static const char vertex[] =
    "uniform mat4 u_shadow;\n"
    "out vec3 v_normal; out vec4 v_color; out vec4 v_in_shadow;\n"
    "void main() {\n"
    "    noh_vertex v = noh_fetch();\n"
    "    v_normal = v.normal; v_color = v.color; v_in_shadow = u_shadow * vec4(v.position, 1.0);\n"
    "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n"
    "}\n";
static const char fragment[] =
    "uniform highp sampler2DShadow u_shadow_map; uniform vec3 u_light;\n"
    "in vec3 v_normal; in vec4 v_color; in vec4 v_in_shadow; out vec4 color;\n"
    "void main() {\n"
    "    noh_fade();\n"
    "    vec3 at = v_in_shadow.xyz / v_in_shadow.w * 0.5 + 0.5;\n"
    "    float lit = texture(u_shadow_map, vec3(at.xy, at.z - 0.004));\n"
    "    float toon = floor(3.0 * max(dot(normalize(v_normal), u_light), 0.0) * lit + 0.5) / 3.0;\n"
    "    color = vec4(v_color.rgb * (0.3 + 0.7 * toon), 1.0);\n"
    "}\n";

typedef struct cast {
    noh_gl_api gl;
    noh_gl_caps caps;
    noh_gl_ledger ledger;
    noh_stage *stage;
    noh_stage_plan plan;
    noh_stage_view views[2]; /* the camera, the light */
    target picture, shadow;
    noh_stage_shader *toon;
    noh_actor actors[ACTORS];
    uint32_t keys, late_frames, gl_errors;
} cast;

static char shader_log[4096];

static int fail(const char *what, const noh_error *e)
{
    fprintf(stderr, "%s: %s (at %llu, need %llu)\n%s", what, e->what, (unsigned long long)e->where,
            (unsigned long long)e->need, shader_log);
    return 1;
}

static int open_pack(const char *path, noh_pack *pack)
{
    noh_error e;
    size_t bytes;
    const void *data = target_read(path, &bytes);
    return noh_pack_open(data, bytes, pack, &e) ? fail(path, &e) : 0;
}

static void bind_toon(void *user, const noh_gl_api *gl, GLuint program, const noh_material *material)
{
    const cast *c = user;
    (void)material;
    gl->UniformMatrix4fv(gl->GetUniformLocation(program, "u_shadow"), 1, GL_FALSE, c->views[1].view_projection);
    gl->Uniform3f(gl->GetUniformLocation(program, "u_light"), c->views[0].light[0], c->views[0].light[1],
                  c->views[0].light[2]);
    gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER);
    gl->BindTexture(GL_TEXTURE_2D, c->shadow.depth);
}

static int open_shader(cast *c)
{
    static const char *const samplers[] = { "u_shadow_map" };
    const noh_gl_shader_desc d = { "toon", vertex, fragment, NULL, samplers, 1, bind_toon, c };
    const size_t bytes = noh_stage_shader_size(c->stage);
    noh_error e = { NOH_ERR_MEMORY, "malloc", 0, bytes };
    void *memory = malloc(bytes);
    return !memory || noh_stage_shader_create(c->stage, memory, bytes, &d, shader_log, sizeof shader_log, &c->toon, &e)
               ? fail("toon", &e)
               : 0;
}

/* Everything that is asked for, in one place: two kinds of the same figure, within so many bytes. */
static int open_stage(cast *c, const noh_pack *mesh, const noh_pack *const *clips, uint32_t clip_count, uint64_t bytes)
{
    const noh_gl_device device = { &c->gl, &c->caps, &c->ledger, shader_log, sizeof shader_log };
    noh_kind_desc kinds[2] = { { .name = "hero", .actor_count = HEROES },
                               { .name = "extra", .actor_count = ACTORS - HEROES, .unpickable = 0 } };
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
        kinds[i].root_up = 1;
    }
    if (noh_stage_plan_make(&desc, &c->caps, &c->plan, &e)) return fail("plan", &e);
    for (uint32_t i = 0; i < c->plan.concession_count; i++) {
        const noh_concession *g = &c->plan.concessions[i];
        fprintf(stderr, "gave up: %s, now %u, %.2f pixels, for %llu bytes\n", g->what, g->value, (double)g->loss_pixels,
                (unsigned long long)(g->cpu_bytes + g->gpu_bytes));
    }
    memory = malloc((size_t)c->plan.cpu_bytes); /* nothing is allocated from here on but the shader */
    if (!memory || noh_stage_init(memory, (size_t)c->plan.cpu_bytes, &device, &desc, &c->plan, &c->stage, &e))
        return fail("stage", &e);
    return open_shader(c);
}

static int enter(cast *c)
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { .position = { 1.4f * (float)(i % 5u) - 2.8f, 0.0f, -1.6f * (float)(i / 5u) } };
        const noh_play walk = { .speed = 58000 + 900 * (int32_t)i, .start_ticks = 7001 * (int64_t)i };
        noh_error e;
        if (noh_stage_spawn(c->stage, i >= HEROES, &place, &c->actors[i], &e) ||
            noh_actor_play(c->stage, c->actors[i], 0, "walk", &walk, &e))
            return fail("actor", &e);
        (void)noh_actor_play(c->stage, c->actors[i], 1, "speak", NULL, NULL); /* where there is such a clip */
    }
    return 0;
}

/* Who is under the middle of the picture bows. */
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

static int frame(cast *c, uint32_t number)
{
    const float walked = 0.0073f * (float)number, middle[3] = { 0.0f, 0.8f, walked - 1.5f };
    const float all[4] = { 0.0f, 1.0f, walked - 2.0f, 6.0f };
    uint32_t count;
    noh_error e;
    noh_view_orbit(&c->views[0], middle, 0.5f + 0.004f * (float)number, 0.2f, 8.0f, WIDTH, HEIGHT);
    noh_view_shadow(&c->views[1], all, c->views[0].light);
    if (noh_stage_step(c->stage, FRAME_TICKS, NULL, NULL, &e)) return fail("step", &e);
    if (noh_stage_frame_begin(c->stage, c->views, 2, &e)) return fail("frame", &e);
    while ((count = noh_stage_jobs(c->stage)) > 0) { /* each phase on as many threads as you like */
        for (uint32_t i = 0; i < count; i++) noh_stage_job(c->stage, i);
    }
    if (noh_stage_frame_end(c->stage, &e)) return fail("frame", &e);
    (void)noh_stage_events(c->stage, &count);
    c->keys += count;
    c->late_frames += noh_stage_stats_of(c->stage)->decoded_late > 0;
    if (number % 60u == 30u) pick(c);
    target_clear(&c->gl, &c->shadow);
    if (noh_stage_draw(c->stage, NOH_PASS_DEPTH, 1, NULL, &e)) return fail("shadow", &e);
    target_clear(&c->gl, &c->picture);
    if (noh_stage_draw(c->stage, NOH_PASS_COLOR, 0, c->toon, &e)) return fail("colour", &e);
    c->gl_errors += c->gl.GetError() != GL_NO_ERROR;
    return 0;
}

int main(int argc, char **argv)
{
    static cast c;
    static noh_pack packs[2];
    const noh_pack *clips[2] = { &packs[0], &packs[1] };
    const char *out = NULL;
    uint32_t frames = 300, pack_count = 0;
    uint64_t bytes = 2u << 20;
    noh_error e;
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
        else if (pack_count == 2 || open_pack(argv[i], &packs[pack_count++]))
            return 2;
    }
    if (!pack_count || egl_context_open()) return 2;
    if (noh_gl_api_load(&c.gl, egl_context_get, NULL, &e) || noh_gl_caps_probe(&c.gl, &c.caps, &e))
        return fail("GL", &e);
    target_make(&c.gl, WIDTH, HEIGHT, 0, &c.picture);
    target_make(&c.gl, SHADOW, SHADOW, 1, &c.shadow);
    if (open_stage(&c, &packs[0], clips, pack_count, bytes) || enter(&c)) return 1;
    for (uint32_t i = 0; i < frames; i++) {
        if (frame(&c, i)) return 1;
    }
    if (json) {
        printf("{\"actors\": %u, \"frames\": %u, \"cpu_bytes\": %llu, \"gpu_bytes\": %llu, \"cpu_predicted\": %llu, "
               "\"gpu_predicted\": %llu, \"gl_errors\": %u, \"keys\": %u, \"late_frames\": %u}\n",
               ACTORS, frames, (unsigned long long)noh_stage_plan_of(c.stage)->cpu_bytes,
               (unsigned long long)noh_gl_ledger_bytes(&c.ledger), (unsigned long long)c.plan.cpu_bytes,
               (unsigned long long)c.plan.gpu_bytes, c.gl_errors, c.keys, c.late_frames);
    }
    return out && target_save(&c.gl, &c.picture, out);
}
