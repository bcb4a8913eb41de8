/* A stage that draws: bytes as planned on every path, pictures as drawn by hand, states and lost contexts without a
 * trace, and drivers that refuse. */
#include "support/stage_fixture.h"
#include "support/gl_fixture.h"
#include "support/renderer.h"

#include <math.h>

#include "gpu/canvas.h"
#include "null.h"

#define WIDTH 320u
#define HEIGHT 180u
#define PIXELS (WIDTH * HEIGHT)

static char shader_log[4096];

static noh_gl_device device_of(gpu *g)
{
    const noh_gl_device d = { &g->gl, &g->caps, &g->ledger, shader_log, sizeof shader_log };
    return d;
}

static void open_on(cast *c, gpu *g)
{
    const noh_gl_device d = device_of(g);
    c->desc.gpu = &noh_stage_on_gl;
    cast_make(c, &d);
}

static void draw(cast *c, canvas *to, uint32_t *rgba)
{
    canvas_begin(to);
    assert_int_equal(noh_stage_draw(c->stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    canvas_resolve(to);
    assert_int_equal(canvas_read(to, (uint8_t *)rgba), 0);
}

static void play_frames(cast *c, uint32_t first, uint32_t count)
{
    for (uint32_t f = first; f < first + count; f++) {
        const noh_stage_view view = cast_view(f, 5.0f + 0.1f * (float)(f % 60u));
        assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    }
}

/* Fewer slots than actors; few slots change hands in a frame. */
static void few_are_seen(cast *c)
{
    c->kinds[PUPPETS].visible_max = 3;
    c->kinds[MASKS].visible_max = 4;
    c->desc.slot_moves = 2;
}

/* ---- bytes ---- */

/* For every path and format, each without a bound and with one of four (NOH_LONG: all): the ledger counts what the plan
 * says, and afterwards what it counted before. */
static void the_plan_is_what_is_used(void **state)
{
    gpu *g = fixture_gpu();
    const noh_gl_ledger before = g->ledger;
    const noh_reflection_desc baked = { 32, noh_reflection_of_environment, noh_environment_at(0) };
    void *texels = test_zeros(noh_reflection_size(32)), *scratch = test_zeros(noh_reflection_scratch_size(32));
    noh_reflection reflection;
    const noh_gl_light_desc light = { &reflection, 256 };
    uint32_t made = 0;
    (void)state;
    assert_int_equal(noh_reflection_init(texels, noh_reflection_size(32), scratch, noh_reflection_scratch_size(32),
                                         &baked, &reflection, NULL),
                     NOH_OK);
    for (uint32_t way = 0; way < FIXTURE_WAYS; way++) {
        for (uint32_t bound = 0; bound < 5; bound++) {
            noh_stage_bytes parts[128];
            uint64_t cpu = 0, gpu_bytes = 0;
            noh_error error;
            uint32_t count;
            cast c;
            if (!getenv("NOH_LONG") && bound && bound != 1u + way % 4u) continue;
            cast_open(&c);
            c.desc.gpu = &noh_stage_on_gl;
            c.desc.morph_path = (uint32_t)fixture_ways[way].path;
            c.desc.halves = fixture_ways[way].accumulate == NOH_ACCUMULATE_F16;
            if (bound == 1) c.desc.bytes_max = 5u << 20;
            c.desc.tangents = bound == 2;
            c.desc.light = bound == 3 ? &light : NULL;
            c.desc.motion = c.desc.sort_blended = bound == 4;
            if (noh_stage_plan_make(&c.desc, &g->caps, &c.plan, &error) != NOH_OK) {
                assert_int_equal(error.result, NOH_ERR_UNSUPPORTED); /* of this driver */
                cast_close(&c);
                continue;
            }
            open_on(&c, g);
            assert_true(noh_gl_ledger_bytes(&g->ledger) - noh_gl_ledger_bytes(&before) == c.plan.gpu_bytes);
            assert_true(bound != 1 || c.plan.cpu_bytes + c.plan.gpu_bytes <= 5u << 20);
            count = noh_stage_plan_parts(&c.desc, &g->caps, &c.plan, parts, 128);
            for (uint32_t i = 0; i < count; i++) cpu += parts[i].cpu_bytes, gpu_bytes += parts[i].gpu_bytes;
            assert_true(count <= 128 && cpu == c.plan.cpu_bytes && gpu_bytes == c.plan.gpu_bytes);
            assert_string_equal(parts[count - 1u].what, "alignment");
            assert_true(parts[count - 1u].cpu_bytes < 16u * count); /* nothing is counted twice */
            play_frames(&c, 0, 3);
            assert_true(noh_gl_ledger_bytes(&g->ledger) - noh_gl_ledger_bytes(&before) == c.plan.gpu_bytes);
            cast_close(&c);
            assert_memory_equal(&before, &g->ledger, sizeof before);
            made++;
        }
    }
    assert_true(made >= 2);
    free(texels);
    free(scratch);
    fixture_expect_no_errors();
}

/* ---- pictures ---- */

/* A mask alone, at rest except for a smile: the stage's picture is the one that its parts draw, pixel by pixel. */
static void the_picture_is_that_of_the_parts(void **state)
{
    static uint32_t by_stage[PIXELS], by_hand[PIXELS];
    gpu *g = fixture_gpu();
    const noh_gl_device device = device_of(g);
    noh_stage_view view;
    noh_gl_camera camera;
    const noh_appearance finest = { .pixels = 1e-4f };
    float sphere[4];
    noh_actor actor;
    canvas to;
    cast c;
    (void)state;
    cast_open(&c);
    c.kinds[0] = c.kinds[MASKS];
    c.desc.kind_count = 1;
    c.kinds[0].actor_count = 1;
    c.desc.tangents = 1;
    open_on(&c, g);
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    assert_int_equal(noh_stage_spawn(c.stage, 0, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(
        noh_actor_hold_float(c.stage, actor, noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "smile"), 1.0f, 1.0f, NULL),
        NOH_OK);
    assert_int_equal(noh_actor_sphere(c.stage, actor, sphere, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c.stage, actor, &finest, NULL), NOH_OK);
    noh_view_orbit(&view, sphere, 0.4f, 0.1f, 1.4f * sphere[3], WIDTH, HEIGHT);
    assert_int_equal(noh_stage_frame(c.stage, 0, &view, NULL, NULL, NULL), NOH_OK);
    draw(&c, &to, by_stage);
    {
        const noh_pack *pack = &c.packs[MASKS];
        const noh_mesh mesh = test_mesh(pack, 0);
        noh_gl_mesh on_gl;
        noh_gl_renderer_desc desc;
        static noh_gl_renderer renderer;
        gpu_morph morph;
        const noh_gl_morph_desc morph_desc = { .meshes = &mesh, .mesh_count = 1, .vertices = 1 }; /* as a stage's */
        noh_gl_texture pictures[32];
        float weights[NOH_TARGETS_MAX] = { 0.0f };
        weights[noh_mesh_find_target(&mesh, "smile")] = 1.0f;
        memset(&desc, 0, sizeof desc);
        assert_int_equal(gpu_morph_open(&morph, g, &morph_desc, "mask"), 0);
        desc.layers_uint = noh_gl_morph_binding_of(morph.morph, 0).is_uint;
        desc.meshes = &mesh;
        desc.mesh_count = 1;
        assert_int_equal(noh_gl_mesh_create(&g->gl, &g->ledger, &mesh, &on_gl, NULL), NOH_OK);
        assert_int_equal(renderer_create(&device, &desc, &renderer, NULL), NOH_OK);
        for (uint32_t t = 0; t < pack->runs[NOH_CHUNK_TEXTURE].count; t++) {
            noh_texture texture;
            assert_int_equal(noh_pack_texture_at(pack, t, &texture, NULL), NOH_OK);
            assert_int_equal(noh_gl_picture_create(&g->gl, &g->ledger, &texture, &pictures[t], NULL), NOH_OK);
        }
        assert_int_equal(noh_gl_morph_set_weights(morph.morph, 0, weights, NULL), NOH_OK);
        noh_gl_morph_update(morph.morph, NULL);
        memcpy(camera.view_projection, view.view_projection, sizeof camera.view_projection);
        memcpy(camera.eye, view.eye, sizeof camera.eye);
        memcpy(camera.key, view.light, sizeof camera.key);
        canvas_begin(&to);
        noh_gl_draw_begin(&renderer, &camera);
        for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
            const noh_gl_morph_binding binding = noh_gl_morph_binding_of(morph.morph, 0);
            static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
            noh_gl_draw_mesh(&renderer, &on_gl, pack->node_count ? pack->nodes[0].world : identity, &binding, NULL,
                             NULL, pictures, pass);
        }
        noh_gl_draw_end(&renderer);
        canvas_resolve(&to);
        assert_int_equal(canvas_read(&to, (uint8_t *)by_hand), 0);
        noh_gl_renderer_delete(&renderer);
        noh_gl_mesh_delete(&g->gl, &g->ledger, &on_gl);
        for (uint32_t t = 0; t < pack->runs[NOH_CHUNK_TEXTURE].count; t++)
            noh_gl_texture_delete(&g->gl, &g->ledger, &pictures[t]);
        gpu_morph_close(&morph);
    }
    {
        uint32_t drawn = 0, apart = 0;
        for (uint32_t i = 0; i < PIXELS; i++) {
            drawn += by_hand[i] != by_hand[0];
            apart += by_hand[i] != by_stage[i];
        }
        if (drawn <= PIXELS / 20u)
            fail_msg("%u pixels are drawn, %u differ; radius %g", (unsigned)drawn, (unsigned)apart, (double)sphere[3]);
        if (apart) fail_msg("%u of %u pixels differ", (unsigned)apart, (unsigned)drawn);
    }
    canvas_close(&to);
    cast_close(&c);
    fixture_expect_no_errors();
}

/* A show of five jobs, the last one first: the picture equals one job's. */
static void pictures_do_not_depend_on_the_jobs(void **state)
{
    static uint32_t one[PIXELS], five[PIXELS];
    noh_actor actors[CAST_ACTORS];
    gpu *g = fixture_gpu();
    canvas to;
    (void)state;
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    for (uint32_t jobs = 1; jobs <= 5; jobs += 4) {
        uint32_t count;
        cast c;
        cast_open(&c);
        c.desc.job_count = jobs;
        open_on(&c, g);
        cast_enter(&c, actors);
        for (uint32_t f = 0; f < 25; f++) {
            const noh_stage_view view = cast_view(f, 5.0f + 0.1f * (float)f);
            assert_int_equal(noh_stage_step(c.stage, CAST_STEP, NULL, NULL, NULL), NOH_OK);
            assert_int_equal(noh_stage_frame_begin(c.stage, &view, 1, NULL), NOH_OK);
            while ((count = noh_stage_jobs(c.stage)) > 0) {
                assert_true(jobs == 1 ? count == 1 : count > 1);
                while (count) noh_stage_job(c.stage, --count);
            }
            assert_int_equal(noh_stage_frame_end(c.stage, NULL), NOH_OK);
        }
        draw(&c, &to, jobs == 1 ? one : five);
        cast_close(&c);
    }
    assert_memory_equal(one, five, sizeof one);
    canvas_close(&to);
    fixture_expect_no_errors();
}

static void show_a_state_again(void (*change)(cast *))
{
    static uint32_t first[PIXELS], again[PIXELS];
    noh_actor actors[CAST_ACTORS];
    gpu *g = fixture_gpu();
    uint8_t *saved;
    size_t bytes;
    canvas to;
    cast c, fork;
    cast_open(&c);
    if (change) change(&c);
    open_on(&c, g);
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    cast_enter(&c, actors);
    play_frames(&c, 0, 20);
    saved = test_aligned(noh_stage_state(c.stage, &bytes), c.plan.state_bytes);
    play_frames(&c, 20, 25);
    draw(&c, &to, first);
    play_frames(&c, 45, 10);
    assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, NULL), NOH_OK);
    play_frames(&c, 20, 25);
    draw(&c, &to, again);
    assert_memory_equal(first, again, sizeof first);
    cast_open(&fork);
    if (change) change(&fork);
    open_on(&fork, g);
    assert_int_equal(noh_stage_set_state(fork.stage, saved, bytes, NULL), NOH_OK);
    play_frames(&fork, 20, 25);
    draw(&fork, &to, again);
    assert_memory_equal(first, again, sizeof first);
    free(saved);
    canvas_close(&to);
    cast_close(&fork);
    cast_close(&c);
    fixture_expect_no_errors();
}

/* After frames of its own, a state that is put back shows again what followed it, on the same stage and on another;
 * while actors wait for slots too. */
static void a_state_shows_the_same_picture_again(void **state)
{
    (void)state;
    show_a_state_again(NULL);
    show_a_state_again(few_are_seen);
}

static const char vertex[] = "out vec3 v_normal;\n"
                             "void main() {\n"
                             "    noh_vertex v = noh_fetch();\n"
                             "    v_normal = v.normal;\n"
                             "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n"
                             "}\n";
static const char fragment[] = "in vec3 v_normal; out vec4 color;\n"
                               "void main() { noh_fade(); color = vec4(normalize(v_normal) * 0.5 + 0.5, 1.0); }\n";

/* A shader of the game's own covers the same pixels as the library's, in other colours; one that does not compile is
 * DATA and leaves nothing. */
static void own_shaders_draw_the_same_shapes(void **state)
{
    static uint32_t own[PIXELS], built_in[PIXELS];
    noh_actor actors[CAST_ACTORS];
    gpu *g = fixture_gpu();
    noh_gl_shader_desc desc;
    noh_stage_shader *shader = NULL;
    noh_gl_ledger before;
    noh_error error;
    void *memory;
    canvas to;
    cast c;
    uint32_t covered = 0, apart = 0;
    (void)state;
    cast_open(&c);
    open_on(&c, g);
    before = g->ledger;
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    cast_enter(&c, actors);
    play_frames(&c, 0, 10);
    memory = test_aligned(NULL, noh_stage_shader_size(c.stage));
    memset(&desc, 0, sizeof desc);
    desc.vertex = vertex;
    desc.fragment = "void main() { not glsl; }\n";
    assert_int_equal(noh_stage_shader_create(c.stage, memory, noh_stage_shader_size(c.stage), &desc, shader_log,
                                             sizeof shader_log, &shader, &error),
                     NOH_ERR_DATA);
    assert_true(shader == NULL && shader_log[0]);
    assert_memory_equal(&before, &g->ledger, sizeof before);
    desc.fragment = fragment;
    assert_int_equal(
        noh_stage_shader_create(c.stage, memory, noh_stage_shader_size(c.stage) - 1u, &desc, NULL, 0, &shader, &error),
        NOH_ERR_MEMORY);
    assert_int_equal(noh_stage_shader_create(c.stage, memory, noh_stage_shader_size(c.stage), &desc, shader_log,
                                             sizeof shader_log, &shader, &error),
                     NOH_OK);
    draw(&c, &to, built_in);
    canvas_begin(&to);
    assert_int_equal(noh_stage_draw(c.stage, NOH_PASS_COLOR, 0, shader, NULL), NOH_OK);
    canvas_resolve(&to);
    assert_int_equal(canvas_read(&to, (uint8_t *)own), 0);
    for (uint32_t i = 0; i < PIXELS; i++) {
        covered += built_in[i] != built_in[0];
        apart += (built_in[i] != built_in[0]) != (own[i] != own[0]);
    }
    assert_true(covered > PIXELS / 50u && apart < covered / 100u);
    assert_int_equal(noh_stage_draw(c.stage, NOH_PASS_DEPTH, 1, NULL, &error), NOH_ERR_ARG); /* there is no such view */
    noh_stage_shader_delete(shader);
    assert_memory_equal(&before, &g->ledger, sizeof before);
    free(memory);
    canvas_close(&to);
    cast_close(&c);
    fixture_expect_no_errors();
}

/* A debug view is a shader without texts: it covers the pixels of the lit one, in the colours of levels. */
static void levels_are_shown_in_their_colours(void **state)
{
    static uint32_t colours[PIXELS], built_in[PIXELS];
    noh_actor actors[CAST_ACTORS];
    gpu *g = fixture_gpu();
    const noh_gl_shader_desc desc = { .name = "levels", .view = NOH_VIEW_LOD };
    noh_stage_shader *shader = NULL;
    void *memory;
    canvas to;
    cast c;
    uint32_t covered = 0, apart = 0, differing = 0;
    (void)state;
    cast_open(&c);
    open_on(&c, g);
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    cast_enter(&c, actors);
    play_frames(&c, 0, 40);
    memory = test_aligned(NULL, noh_stage_shader_size(c.stage));
    assert_int_equal(noh_stage_shader_create(c.stage, memory, noh_stage_shader_size(c.stage), &desc, shader_log,
                                             sizeof shader_log, &shader, NULL),
                     NOH_OK);
    draw(&c, &to, built_in);
    canvas_begin(&to);
    assert_int_equal(noh_stage_draw(c.stage, NOH_PASS_COLOR, 0, shader, NULL), NOH_OK);
    canvas_resolve(&to);
    assert_int_equal(canvas_read(&to, (uint8_t *)colours), 0);
    for (uint32_t i = 0; i < PIXELS; i++) {
        covered += built_in[i] != built_in[0];
        apart += (built_in[i] != built_in[0]) != (colours[i] != colours[0]);
        differing += built_in[i] != colours[i];
    }
    assert_true(covered > PIXELS / 50u && apart < covered / 100u && differing > covered / 2u);
    noh_stage_shader_delete(shader);
    free(memory);
    canvas_close(&to);
    cast_close(&c);
    fixture_expect_no_errors();
}

/* ---- on the driver that counts ---- */

static void open_null(gpu *g)
{
    memset(g, 0, sizeof *g);
    assert_int_equal(gpu_open(g, "null"), 0);
    g->caps.blend_f32 = g->caps.blend_f32_exact = 1;
}

/* Ten thousand frames of coming, going, playing and cutting: no call that makes anything, none that GL would refuse. */
static void frames_make_nothing(void **state)
{
    test_random r = test_random_from(3);
    static const char *const clips[CAST_KINDS][2] = { { "walk", "dance" }, { "speak", "blink" }, { "none", "none" } };
    static gpu g;
    noh_actor actors[CAST_ACTORS];
    noh_null_report report;
    cast c;
    const uint32_t frames = test_is_sanitized() ? 1500 : 10000;
    (void)state;
    open_null(&g);
    cast_open(&c);
    few_are_seen(&c);
    open_on(&c, &g);
    cast_enter(&c, actors);
    noh_null_count_anew(g.context);
    for (uint32_t f = 0; f < frames; f++) {
        const uint32_t which = test_random_below(&r, CAST_ACTORS), kind = which < 5    ? PUPPETS
                                                                          : which < 12 ? MASKS
                                                                                       : TUBES;
        const noh_actor actor = noh_stage_actor_at(c.stage, which);
        noh_stage_view view = cast_view(f, 3.0f + (float)test_random_below(&r, 40));
        noh_actor made;
        switch (test_random_below(&r, 6)) {
        case 0: (void)noh_stage_despawn(c.stage, actor, NULL); break;
        case 1: (void)noh_stage_spawn(c.stage, kind, NULL, &made, NULL); break;
        case 2: (void)noh_actor_play(c.stage, actor, test_random_below(&r, 3), clips[kind][f % 2u], NULL, NULL); break;
        case 3: view.cut = 1; break;
        default: break;
        }
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_draw(c.stage, f % 3u ? NOH_PASS_COLOR : NOH_PASS_DEPTH, 0, NULL, NULL), NOH_OK);
    }
    noh_null_report_of(g.context, &report);
    if (report.violations) fail_msg("%s", report.first);
    assert_int_equal(report.allocations, 0);
    assert_true(report.draws > frames);
    cast_close(&c);
    noh_null_report_of(g.context, &report);
    for (uint32_t i = 0; i < NOH_NULL_KINDS; i++) assert_true(report.live[i] <= 1);
    gpu_close(&g);
}

#define CROWD 200u
#define CROWD_SEEN 12u
#define CROWD_MOVES 4u

/* Masks in a square; few are seen at once. */
static void open_crowd(cast *c, gpu *g, uint32_t visible_max)
{
    cast_open(c);
    c->kinds[0] = c->kinds[MASKS];
    c->desc.kind_count = 1;
    c->kinds[0].actor_count = CROWD;
    c->kinds[0].visible_max = visible_max;
    c->kinds[0].near_count = 2;
    c->kinds[0].middle_count = 4;
    c->desc.slot_moves = CROWD_MOVES;
    open_on(c, g);
    for (uint32_t i = 0; i < CROWD; i++) {
        const noh_place place = { { 1.5f * (float)(i % 20u) - 15.0f, 0.0f, 2.0f - 1.5f * (float)(i / 20u) },
                                  { 0, 0, 0, 0 },
                                  0.0f };
        noh_actor actor;
        assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c->stage, actor, 1, "speak", NULL, NULL), NOH_OK);
    }
}

/* No culled actor is nearer than the farthest drawn one, except for the quarter that keeps equals from taking turns.
 */
static void expect_the_nearest(const cast *c, const noh_stage_view *view)
{
    float farthest = 0.0f, nearest = 1e9f;
    for (uint32_t i = 0; i < CROWD; i++) {
        const noh_actor actor = noh_stage_actor_at(c->stage, i);
        noh_place place;
        float square = 0.0f, clip[4];
        assert_int_equal(noh_actor_place(c->stage, actor, &place, NULL), NOH_OK);
        for (int k = 0; k < 3; k++) square += (place.position[k] - view->eye[k]) * (place.position[k] - view->eye[k]);
        for (int k = 0; k < 4; k++) {
            const float *m = view->view_projection + k;
            clip[k] = m[0] * place.position[0] + m[4] * place.position[1] + m[8] * place.position[2] + m[12];
        }
        if (noh_actor_floats(c->stage, actor)) {
            if (square > farthest) farthest = square;
        } else if (clip[3] > 1.0f && fabsf(clip[0]) < 0.9f * clip[3] && fabsf(clip[1]) < 0.9f * clip[3]) {
            if (square < nearest) nearest = square; /* well inside the picture, and not drawn */
        }
    }
    assert_true(sqrtf(farthest) < 1.35f * sqrtf(nearest) + 1.0f);
}

/* Slots and palettes for those that are seen at once; of more the nearest are drawn. However the camera moves, few
 * slots change hands in a frame, and once it stands all have what they are due. */
static void few_of_a_crowd_are_drawn(void **state)
{
    static gpu g;
    uint64_t all;
    uint32_t left_out = 0, waited = 0;
    cast c;
    (void)state;
    open_null(&g);
    open_crowd(&c, &g, 0);
    all = c.plan.gpu_bytes;
    cast_close(&c);
    open_crowd(&c, &g, CROWD_SEEN);
    assert_true(noh_gl_ledger_bytes(&g.ledger) == c.plan.gpu_bytes && c.plan.gpu_bytes < all / 5u * 3u);
    for (uint32_t f = 0; f < 400; f++) {
        const noh_stage_stats *stats = noh_stage_stats_of(c.stage);
        noh_stage_view view = cast_view(f < 300u ? 3u * f + f / 25u * 40u : 1337u, 4.0f);
        view.cut = f == 100u;
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_draw(c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
        assert_true(stats->seen <= CROWD_SEEN && stats->resting <= stats->waiting);
        assert_true(stats->left_out == 0 || stats->seen == CROWD_SEEN);
        assert_true(stats->moved <= (view.cut ? CROWD_SEEN : CROWD_MOVES));
        if (view.cut) assert_int_equal(stats->waiting, 0);
        expect_the_nearest(&c, &view);
        left_out += stats->left_out;
        waited += stats->waiting;
        if (f > 320u) assert_int_equal(stats->waiting + stats->moved + stats->resting, 0);
    }
    assert_true(left_out > 1000 && waited > 20);
    cast_close(&c);
    gpu_close(&g);
}

/* Random casts: kinds that share packs or do not, with levels, layers and bounds of all sorts. What is planned is what
 * is used, CPU and GPU, and a frame passes. */
static void random_casts_use_what_is_planned(void **state)
{
    static const noh_layer_desc layers[3] = { { "body", NOH_LAYER_BASE, NULL, "", 3 },
                                              { "face", NOH_LAYER_BASE, "", NULL, 1 },
                                              { "breath", NOH_LAYER_ADD, NULL, NULL, 1 } };
    test_random r = test_random_from(21);
    static gpu g;
    uint32_t made = 0, bounded = 0;
    cast c;
    (void)state;
    cast_open(&c);
    for (uint32_t round = 0; round < 120; round++) {
        static const noh_gl_ledger before; /* nothing */
        noh_kind_desc kinds[5];
        noh_stage_view view = cast_view(round, 6.0f);
        noh_error error;
        noh_actor actor;
        uint64_t full;
        open_null(&g); /* again: it never gives a name twice, and has few of them */
        memset(kinds, 0, sizeof kinds);
        memset(&c.desc, 0, sizeof c.desc);
        c.desc.kinds = kinds;
        c.desc.kind_count = 1u + test_random_below(&r, 5);
        for (uint32_t k = 0; k < c.desc.kind_count; k++) {
            kinds[k].mesh = &c.packs[test_random_below(&r, CAST_KINDS)];
            kinds[k].actor_count = 1u + test_random_below(&r, 20);
            kinds[k].visible_max = test_random_below(&r, 2) ? 1u + test_random_below(&r, kinds[k].actor_count) : 0;
            kinds[k].near_count = test_random_below(&r, 2) ? test_random_below(&r, 5) : 0;
            kinds[k].middle_count = test_random_below(&r, 2) ? test_random_below(&r, 9) : 0;
            kinds[k].finest_level = test_random_below(&r, 3) ? 0 : test_random_below(&r, 5);
            kinds[k].inertia = (int)test_random_below(&r, 2);
            kinds[k].unpickable = (int)test_random_below(&r, 2);
            kinds[k].held_float_count = test_random_below(&r, 2) ? NOH_NONE : test_random_below(&r, 20);
            kinds[k].layers = test_random_below(&r, 2) ? layers : NULL;
            kinds[k].layer_count = kinds[k].layers ? 3 : 0;
            kinds[k].root_axes = test_random_below(&r, 2) ? NOH_ROOT_GROUND : 0;
        }
        c.desc.job_count = test_random_below(&r, 5);
        c.desc.slot_moves = test_random_below(&r, 5);
        c.desc.halves = (int)test_random_below(&r, 2);
        c.desc.tangents = (int)test_random_below(&r, 2);
        c.desc.gpu = test_random_below(&r, 5) ? &noh_stage_on_gl : NULL;
        if (noh_stage_plan_make(&c.desc, c.desc.gpu ? &g.caps : NULL, &c.plan, &error) != NOH_OK)
            fail_msg("plan: %s", error.what);
        full = c.plan.cpu_bytes + c.plan.gpu_bytes;
        if (test_random_below(&r, 2)) {
            c.desc.bytes_max = full / 4u + (uint64_t)((double)full * 0.75 * (double)test_random_float(&r, 0.0f, 1.0f));
            if (noh_stage_plan_make(&c.desc, c.desc.gpu ? &g.caps : NULL, &c.plan, &error) != NOH_OK) {
                assert_int_equal(error.result, NOH_ERR_MEMORY);
                assert_true(error.need > c.desc.bytes_max);
                gpu_close(&g);
                continue;
            }
            assert_true(c.plan.cpu_bytes + c.plan.gpu_bytes <= c.desc.bytes_max);
            bounded++;
        }
        if (c.desc.gpu) {
            open_on(&c, &g);
        } else {
            cast_make(&c, NULL);
        }
        assert_true(noh_gl_ledger_bytes(&g.ledger) - noh_gl_ledger_bytes(&before) == c.plan.gpu_bytes);
        for (uint32_t k = 0; k < c.desc.kind_count; k++) {
            for (uint32_t i = 0; i < kinds[k].actor_count; i++) {
                const char *clip = noh_stage_name(c.stage, k, NOH_NAME_CLIP, i % 3u);
                assert_int_equal(noh_stage_spawn(c.stage, k, NULL, &actor, NULL), NOH_OK);
                if (clip) assert_int_equal(noh_actor_play(c.stage, actor, i % 3u, clip, NULL, NULL), NOH_OK);
            }
        }
        for (int f = 0; f < 3; f++) {
            assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
            if (c.desc.gpu) assert_int_equal(noh_stage_draw(c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
        }
        cast_close_stage(&c);
        assert_memory_equal(&before, &g.ledger, sizeof before);
        gpu_close(&g);
        made++;
    }
    assert_true(made > 80 && bounded > 15);
    cast_close(&c);
}

#define REFUSED(call, word)                        \
    do {                                           \
        memset(&error, 0, sizeof error);           \
        assert_int_equal(call, NOH_ERR_ARG);       \
        assert_non_null(strstr(error.what, word)); \
    } while (0)

/* Of a stage without `gpu`: what returns a result says what to set, what returns none does nothing. And objects that
 * take a device say which call was forgotten. */
static void every_call_without_a_gpu_is_refused(const cast *c, gpu *g)
{
    static const noh_gl_shader_desc shader_desc = { .name = "none" };
    static noh_gl none;
    static noh_lighting lighting;
    static noh_stage_decals decals;
    static noh_gl_renderer renderer;
    static noh_stage_floor floor;
    const noh_gl_renderer_desc renderer_desc = { .mesh_count = 0 };
    const noh_gl_device device = device_of(g);
    const noh_gl_device without_caps = { device.api, NULL, device.ledger, NULL, 0 };
    static const noh_gl_skin_desc skin_desc;
    static const noh_gl_morph_desc morph_desc;
    static const noh_field field;
    static noh_stage_terrain terrain;
    noh_gl_skin *skin;
    noh_gl_morph *morph;
    noh_stage_shader *shader;
    noh_stage_drawn drawn;
    noh_error error;
    REFUSED(noh_stage_draw_shadow(c->stage, 0, &error), "noh_stage_on_gl");
    REFUSED(noh_actor_on_gl(c->stage, noh_stage_actor_at(c->stage, 0), 0, &drawn, &error), "noh_stage_on_gl");
    assert_int_equal(noh_stage_shader_size(c->stage), 0);
    REFUSED(noh_stage_shader_create(c->stage, NULL, 0, &shader_desc, NULL, 0, &shader, &error), "noh_stage_on_gl");
    assert_int_equal(noh_stage_decals_size(c->stage), 0);
    REFUSED(noh_stage_decals_create(c->stage, &device, NULL, 0, NULL, &decals, &error), "noh_stage_on_gl");
    noh_stage_set_lighting(c->stage, &lighting);
    assert_null(noh_stage_light_of(c->stage));
    REFUSED(noh_stage_floor_create(&none.device, 0, &floor, &error), "noh_gl_open");
    REFUSED(noh_gl_renderer_create(&none.device, &renderer_desc, NULL, 0, &renderer, &error), "noh_gl_open");
    REFUSED(noh_gl_skin_init(NULL, 0, &without_caps, &skin_desc, &skin, &error), "noh_gl_open");
    REFUSED(noh_gl_morph_init(NULL, 0, &without_caps, &morph_desc, &morph, &error), "noh_gl_open");
    REFUSED(noh_gl_skin_init(NULL, 0, NULL, &skin_desc, &skin, &error), "noh_gl_open");
    REFUSED(noh_gl_morph_init(NULL, 0, NULL, &morph_desc, &morph, &error), "noh_gl_open");
    REFUSED(noh_stage_terrain_create(NULL, &field, NULL, NULL, 0, &terrain, &error), "noh_gl_open");
}

/* Where noh_gl_open was forgotten, plan and stage say so; and a draw, where the stage has no gpu. */
static void a_device_that_was_not_opened_is_refused(void **state)
{
    const float middle[3] = { 0.0f, 1.0f, 0.0f };
    static noh_gl none;
    noh_stage_view view;
    static gpu g;
    noh_stage *stage;
    noh_error error;
    cast c;
    (void)state;
    open_null(&g);
    cast_open(&c);
    c.desc.gpu = &noh_stage_on_gl;
    assert_int_equal(noh_stage_plan_make(&c.desc, &none.caps, &c.plan, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "noh_gl_open"));
    assert_int_equal(noh_stage_plan_make(&c.desc, &g.caps, &c.plan, NULL), NOH_OK);
    c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes, &none.device, &c.desc, &c.plan, &stage, &error),
                     NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "noh_gl_open"));
    free(c.memory);
    c.desc.gpu = NULL;
    cast_make(&c, NULL);
    noh_view_orbit(&view, middle, 0.0f, 0.0f, 5.0f, 64, 64);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_draw(c.stage, NOH_PASS_COLOR, 0, NULL, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "noh_stage_on_gl"));
    every_call_without_a_gpu_is_refused(&c, &g);
    cast_close(&c);
    gpu_close(&g);
}

/* Whatever call a driver refuses while a stage is made: it is not made, nothing is left, and then it is made. */
static void a_refusing_driver_leaves_nothing(void **state)
{
    static const char *const calls[] = { "glBufferData",      "glTexStorage2D",    "glTexStorage3D",
                                         "glGenVertexArrays", "glGenFramebuffers", "glCreateProgram" };
    static gpu g;
    uint32_t refused = 0;
    cast c;
    (void)state;
    open_null(&g);
    cast_open(&c);
    c.desc.gpu = &noh_stage_on_gl;
    assert_int_equal(noh_stage_plan_make(&c.desc, &g.caps, &c.plan, NULL), NOH_OK);
    c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
    for (uint32_t i = 0; i < TEST_COUNT(calls); i++) {
        for (uint32_t k = 0; k < 200; k += k < 4 ? 1 : 13) {
            const noh_gl_device d = device_of(&g);
            const noh_gl_ledger before = g.ledger;
            noh_stage *stage = NULL;
            noh_error error;
            noh_result result;
            if (!noh_null_refuse(g.context, calls[i], k, GL_OUT_OF_MEMORY)) break;
            result = noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes, &d, &c.desc, &c.plan, &stage, &error);
            if (!noh_null_refused(g.context)) {
                assert_int_equal(result, NOH_OK);
                noh_stage_delete(stage);
                break;
            }
            if (result == NOH_OK) fail_msg("%s refused at %u, and the stage was made", calls[i], (unsigned)k);
            assert_null(stage);
            assert_memory_equal(&before, &g.ledger, sizeof before);
            refused++;
        }
        (void)noh_null_refuse(g.context, NULL, 0, 0);
    }
    assert_true(refused > 20);
    cast_close(&c);
    gpu_close(&g);
}

/* Where a bound is kept, finished vertices go first, and nothing else if that is enough. */
static void vertices_are_given_up_first(void **state)
{
    noh_gl_caps caps = fixture_gpu()->caps;
    noh_stage_plan wide, sums;
    cast c;
    noh_error error;
    (void)state;
    cast_open(&c);
    for (uint32_t k = 0; k < CAST_KINDS; k++) c.kinds[k].actor_count = 1;
    c.desc.gpu = &noh_stage_on_gl;
    c.desc.morph_path = NOH_MORPH_CPU;
    assert_int_equal(noh_stage_plan_make(&c.desc, &caps, &wide, &error), NOH_OK);
    c.desc.morph_sums = 1;
    assert_int_equal(noh_stage_plan_make(&c.desc, &caps, &sums, &error), NOH_OK);
    assert_true(wide.cpu_bytes + wide.gpu_bytes > sums.cpu_bytes + sums.gpu_bytes);
    c.desc.morph_sums = 0;
    for (int halves = -1; halves <= 0; halves++) {
        c.desc.halves = halves;
        c.desc.bytes_max = sums.cpu_bytes + sums.gpu_bytes;
        cast_make(&c, &(noh_gl_device){ &fixture_gpu()->gl, &caps, &fixture_gpu()->ledger, NULL, 0 });
        assert_true(c.plan.sums && !c.plan.halves && c.plan.concession_count == 1);
        assert_string_equal(c.plan.concessions[0].what, "finished vertices");
        assert_true(c.plan.cpu_bytes == sums.cpu_bytes && c.plan.gpu_bytes == sums.gpu_bytes);
        cast_close_stage(&c);
        c.desc.bytes_max = wide.cpu_bytes + wide.gpu_bytes;
        assert_int_equal(noh_stage_plan_make(&c.desc, &caps, &c.plan, &error), NOH_OK);
        assert_true(!c.plan.sums && !c.plan.concession_count);
    }
    cast_close(&c);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_plan_is_what_is_used),
        cmocka_unit_test(the_picture_is_that_of_the_parts),
        cmocka_unit_test(a_state_shows_the_same_picture_again),
        cmocka_unit_test(pictures_do_not_depend_on_the_jobs),
        cmocka_unit_test(own_shaders_draw_the_same_shapes),
        cmocka_unit_test(levels_are_shown_in_their_colours),
        cmocka_unit_test(frames_make_nothing),
        cmocka_unit_test(few_of_a_crowd_are_drawn),
        cmocka_unit_test(random_casts_use_what_is_planned),
        cmocka_unit_test(a_device_that_was_not_opened_is_refused),
        cmocka_unit_test(a_refusing_driver_leaves_nothing),
        cmocka_unit_test(vertices_are_given_up_first),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
