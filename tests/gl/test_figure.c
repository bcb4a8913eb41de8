/* What the verbs draw (tools/noh/draw/figure.h): it takes the bytes that it plans, is posed and held by name, and draws
 * what the CPU says, at any level and in any debug view; without a GPU it has joints and bounds. */
#include "support/gl_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "draw/figure.h"
#include "gpu/canvas.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "life/hair/hair_internal.h"

#define SIDE 160u

static pack_file open_file(const char *name)
{
    static char path[2][1024];
    static int next;
    const char *build = getenv("NOH_BUILD");
    pack_file file;
    next = !next;
    snprintf(path[next], sizeof path[next], "%s/%s", build ? build : "build", name);
    assert_int_equal(pack_file_open(&file, path[next]), 0);
    return file;
}

static uint32_t *picture(figure *f, gpu *g, const char *camera)
{
    const view_options o = { .camera = camera, .width = SIDE, .height = SIDE };
    uint32_t *rgba = test_zeros(SIDE * SIDE * 4);
    noh_gl_camera at;
    bounds box;
    canvas c;
    assert_int_equal(figure_pose(f), 0);
    box = figure_bounds(f, view_frame_of(&o));
    assert_int_equal(view_camera(&o, &box, &at), 0);
    assert_int_equal(canvas_open(&c, g, SIDE, SIDE), 0);
    assert_int_equal(figure_look(f, &at, SIDE), 0);
    canvas_begin(&c);
    assert_int_equal(figure_draw(f), 0);
    assert_int_equal(canvas_read(&c, (uint8_t *)rgba), 0);
    canvas_close(&c);
    return rgba;
}

static uint32_t differing(const uint32_t *a, const uint32_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) count += a[i] != b[i];
    return count;
}

static uint32_t painted(const uint32_t *a)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) count += a[i] != a[0];
    return count;
}

static void it_takes_the_bytes_that_it_plans(void **state)
{
    gpu *g = fixture_gpu();
    pack_file file = open_file("demo/puppet_levels.noh");
    (void)state;
    for (uint32_t level = 0; level < 4; level++) {
        for (int halves = 0; halves < 2; halves++) {
            const uint64_t before = noh_gl_ledger_bytes(&g->ledger);
            const figure_desc d = { .file = &file,
                                    .clips = &file,
                                    .level = level,
                                    .accumulate = halves ? NOH_ACCUMULATE_F16 : NOH_ACCUMULATE_AUTO };
            figure f, planned;
            assert_int_equal(figure_plan(&planned, &d, &g->caps), 0);
            assert_int_equal(figure_open(&f, &d, g), 0);
            assert_int_equal(noh_gl_ledger_bytes(&g->ledger) - before, planned.plan.gpu_bytes);
            assert_true(planned.plan.cpu_bytes == f.plan.cpu_bytes && f.plan.kinds[0].finest_level == level);
            figure_plan_free(&planned);
            figure_close(&f);
            assert_int_equal(noh_gl_ledger_bytes(&g->ledger), before);
        }
    }
    pack_file_close(&file);
    fixture_expect_no_errors();
}

/* A clip moves it, a held target and a level change it, and a reset takes all back. */
static void clips_and_held_floats_show(void **state)
{
    gpu *g = fixture_gpu();
    pack_file file = open_file("demo/puppet_levels.noh");
    const figure_desc d = { .file = &file, .clips = &file, .held_float_count = FIGURE_HELD_ALL };
    const noh_play play = { .start_ticks = 20000 };
    uint32_t *rest, *walk, *smile, *again;
    figure f;
    (void)state;
    assert_int_equal(figure_open(&f, &d, g), 0);
    rest = picture(&f, g, "body");
    assert_true(painted(rest) > SIDE * SIDE / 20u);
    assert_int_equal(figure_play(&f, "walk", &play), 0);
    walk = picture(&f, g, "body");
    assert_true(differing(rest, walk) > SIDE * SIDE / 100u);
    assert_int_equal(figure_play(&f, "wlak", &play), EXIT_FAILED);
    assert_non_null(strstr(tool_last_failure(), "did you mean 'walk'"));
    assert_int_equal(figure_reset(&f), 0);
    assert_int_equal(figure_hold(&f, "smile", 1.0), 0);
    assert_int_equal(figure_hold(&f, "simle", 1.0), EXIT_FAILED);
    smile = picture(&f, g, "face");
    assert_int_equal(figure_hold_all(&f, 0.0), 0);
    again = picture(&f, g, "face");
    assert_true(differing(smile, again) > 20u);
    free(again);
    assert_int_equal(figure_reset(&f), 0);
    again = picture(&f, g, "body");
    assert_memory_equal(rest, again, SIDE * SIDE * 4u);
    free(again), free(smile), free(walk), free(rest);
    figure_close(&f);
    pack_file_close(&file);
    fixture_expect_no_errors();
}

/* Each debug view is another picture of the same pixels; a level has facets of its own. */
static void debug_views_and_levels_show(void **state)
{
    gpu *g = fixture_gpu();
    pack_file file = open_file("demo/puppet_levels.noh");
    uint32_t *seen[8];
    uint32_t count = 0;
    (void)state;
    for (int view = NOH_VIEW_LIT; view <= NOH_VIEW_LOD; view++) {
        for (uint32_t level = 0; level < (view == NOH_VIEW_LOD ? 4u : 1u); level++) {
            const figure_desc d = { .file = &file, .level = level, .view = (noh_debug_view)view };
            figure f;
            assert_int_equal(figure_open(&f, &d, g), 0);
            seen[count] = picture(&f, g, "body");
            for (uint32_t i = 0; i < count; i++) assert_true(differing(seen[i], seen[count]) > SIDE * SIDE / 20u);
            count++;
            figure_close(&f);
        }
    }
    while (count) free(seen[--count]);
    pack_file_close(&file);
    fixture_expect_no_errors();
}

/* The vertices on the GPU equal the CPU's, of each mesh. */
static void vertices_are_those_of_the_cpu(void **state)
{
    gpu *g = fixture_gpu();
    pack_file file = open_file("demo/puppet_levels.noh");
    const figure_desc d = { .file = &file, .clips = &file, .held_float_count = 4 };
    const noh_play play = { .start_ticks = 20000 };
    readback r;
    figure f;
    (void)state;
    assert_int_equal(figure_open(&f, &d, g), 0);
    assert_int_equal(figure_play(&f, "walk", &play), 0);
    assert_int_equal(figure_hold(&f, "smile", 1.0), 0);
    free(picture(&f, g, "body"));
    assert_int_equal(readback_open(&r, g, 0), 0);
    for (uint32_t m = 0; m < f.plan.kinds[0].mesh_count; m++) {
        noh_stage_drawn drawn;
        noh_actor_mesh shown;
        noh_mesh mesh;
        noh_vertex *cpu = figure_deform(&f, 0, m, 0, &mesh, &shown);
        readback_vertex *gpu_vertices = test_zeros(mesh.header->vertex_count * sizeof *gpu_vertices);
        assert_int_equal(noh_actor_on_gl(f.stage, f.actors[0], m, &drawn, NULL), NOH_OK);
        assert_int_equal(readback_skinned(&r, drawn.mesh, drawn.is_morphed ? &drawn.morph : NULL,
                                          drawn.is_skinned ? &drawn.skin : NULL, 0, gpu_vertices),
                         0);
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            for (int i = 0; i < 3; i++) {
                assert_true(fabsf(gpu_vertices[v].position[i] - cpu[v].position[i]) < 1e-5f);
            }
        }
        free(gpu_vertices);
        free(cpu);
    }
    readback_close(&r);
    figure_close(&f);
    pack_file_close(&file);
    fixture_expect_no_errors();
}

/* Without a GPU: joints, anchor, bounds. */
static void without_a_gpu_it_is_posed(void **state)
{
    pack_file file = open_file("demo/puppet_levels.noh");
    const figure_desc d = { .file = &file, .clips = &file };
    const noh_play play = { .start_ticks = 20000 };
    double anchor[3], moved[3], seconds;
    noh_skeleton skeleton;
    float *joints;
    bounds box;
    figure f;
    (void)state;
    assert_int_equal(figure_open(&f, &d, NULL), 0);
    assert_int_equal(figure_pose(&f), 0);
    figure_anchor(&f, anchor);
    box = figure_bounds(&f, FRAME_FULL);
    assert_int_equal(figure_clip_seconds(&f, "walk", &seconds), 0);
    assert_true(seconds > 0.2);
    assert_int_equal(figure_play(&f, "walk", &play), 0);
    assert_int_equal(figure_pose(&f), 0);
    figure_anchor(&f, moved);
    assert_true(fabs(moved[0] - anchor[0]) + fabs(moved[2] - anchor[2]) > 0.0);
    joints = figure_joints(&f, 0, &skeleton);
    assert_non_null(joints);
    for (uint32_t j = 0; j < skeleton.joint_count; j++) {
        assert_true(joints[12u * j + 7u] > (float)box.low[1] - 0.3f &&
                    joints[12u * j + 7u] < (float)box.high[1] + 0.3f);
    }
    free(joints);
    figure_close(&f);
    pack_file_close(&file);
}

/* The mean of a backdrop, 0..1. */
static double backdrop_mean(gpu *g, const figure *f, noh_backdrop *b, noh_backdrop_kind kind)
{
    const lighting *l = f->desc.light;
    const noh_stage_view view = { .view_projection = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.2f, 0 } };
    static uint8_t rgba[64 * 64 * 4];
    double sum = 0.0;
    canvas c;
    assert_int_equal(canvas_open(&c, g, 64, 64), 0);
    canvas_begin(&c);
    noh_backdrop_draw(b, kind, noh_stage_light_of(f->stage), &l->told, &view);
    assert_int_equal(canvas_read(&c, rgba), 0);
    canvas_close(&c);
    for (uint32_t i = 0; i < 64u * 64u; i++) {
        for (uint32_t k = 0; k < 3u; k++) sum += rgba[4u * i + k] / (255.0 * 3.0 * 64.0 * 64.0);
    }
    return sum;
}

/* A backdrop shows the light: another one once the reflection is made again; the same after a lost context. */
static void what_is_behind_is_the_light(gpu *g, figure *f, lighting *light)
{
    static __attribute__((aligned(16))) uint8_t scratch[1024 * 1024];
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
    const noh_reflection_desc white = { 0, noh_reflection_of_environment,
                                        noh_environment_at(noh_environment_find("white")) };
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_reflection again;
    noh_backdrop b;
    double room, after;
    assert_true(noh_reflection_scratch_size(0) <= sizeof scratch);
    assert_int_equal(noh_backdrop_create(&device, 0, &b, &error), NOH_OK);
    room = backdrop_mean(g, f, &b, NOH_BACKDROP_LIGHT);
    assert_true(fabs(room - backdrop_mean(g, f, &b, NOH_BACKDROP_GRADIENT)) > 0.005);
    assert_int_equal(
        noh_reflection_init(light->texels, noh_reflection_size(0), scratch, sizeof scratch, &white, &again, &error),
        NOH_OK);
    assert_true(fabs(room - backdrop_mean(g, f, &b, NOH_BACKDROP_LIGHT)) < 1e-9); /* not uploaded yet */
    assert_int_equal(noh_gl_light_upload(noh_stage_light_of(f->stage), &error), NOH_OK);
    after = backdrop_mean(g, f, &b, NOH_BACKDROP_LIGHT);
    assert_true(fabs(room - after) > 0.02);
    assert_int_equal(noh_backdrop_restore(&b, NULL, 0, &error), NOH_OK);
    assert_true(fabs(after - backdrop_mean(g, f, &b, NOH_BACKDROP_LIGHT)) < 1e-9);
    noh_backdrop_delete(&b);
    noh_backdrop_delete(&b);
    assert_int_equal(noh_gl_error_take(&g->gl), 0);
}

/* A lit figure takes the bytes of its plan, light included; after a lost context its picture is the same. */
static void light_is_counted_and_comes_back(void **state)
{
    const light_options o = { .light = "room" };
    pack_file file = open_file("mask.noh");
    const figure_desc plain = { .file = &file };
    figure_desc d = plain;
    char message[1024];
    lighting light;
    uint32_t *before, *after;
    figure f, unlit;
    gpu g;
    (void)state;
    if (gpu_open(&g, "egl")) test_skip("no context of EGL here");
    assert_int_equal(lighting_open(&light, &o), 0);
    d.light = &light;
    assert_int_equal(figure_plan(&unlit, &plain, &g.caps), 0);
    assert_int_equal(figure_open(&f, &d, &g), 0);
    assert_int_equal(noh_gl_ledger_bytes(&g.ledger), f.plan.gpu_bytes);
    assert_int_equal(f.plan.gpu_bytes - unlit.plan.gpu_bytes, noh_gl_light_bytes(&light.desc, g.caps.render_f16));
    assert_int_equal(noh_gl_light_bytes(&light.desc, 0), noh_reflection_size(0) + 2 * 512 * 512);
    assert_int_equal(noh_gl_light_bytes(&light.desc, 1),
                     noh_reflection_size(0) + 2 * 512 * 512 + 4 * (256 * 256 + 128 * 128));
    before = picture(&f, &g, "face");
    for (int round = 0; round < 2; round++) {
        g.platform->destroy(g.context);
        assert_int_equal(g.platform->create(NULL, &g.context, message, sizeof message), NOH_OK);
        assert_int_equal(noh_gl_api_load(&g.gl, g.platform->get_proc, g.context, NULL), NOH_OK);
        assert_int_equal(figure_restore(&f), 0);
        assert_int_equal(noh_gl_ledger_bytes(&g.ledger), f.plan.gpu_bytes);
        after = picture(&f, &g, "face");
        assert_int_equal(differing(before, after), 0);
        free(after);
    }
    free(before);
    what_is_behind_is_the_light(&g, &f, &light);
    figure_close(&f);
    figure_plan_free(&unlit);
    lighting_close(&light);
    assert_int_equal(noh_gl_ledger_bytes(&g.ledger), 0);
    gpu_close(&g);
    pack_file_close(&file);
}

/* --turn: the head stands turned before it turns. The hair stays behind by the way of the turn, and is not thrown about
 * by a leap to where the turn begins. */
static void hair_turns_from_where_the_turn_begins(void **state)
{
    const double turned = 400.0 * (3.14159265358979 / 180.0) * 5.0 / 60.0; /* from the first step to the last */
    pack_file file = open_file("wig.noh");
    const figure_desc d = { .file = &file, .clips = &file, .hair = 1 };
    double most = 0.0, beyond = -1.0;
    figure f;
    (void)state;
    assert_int_equal(figure_open(&f, &d, NULL), 0);
    assert_int_equal(figure_pose(&f), 0);
    assert_int_equal(figure_live(&f, 0.1, -400.0), 0);
    const noh_hair_desc *hair = &f.hair.cut.desc;
    const uint32_t count = hair->hair_count * hair->point_count;
    const char *made = noh_actor_modifier(f.stage, f.actors[f.hair.desc.kind], 0);
    float *points = test_zeros(12u * (size_t)count);
    assert_non_null(made);
    noh_hair_points((const noh_hair *)(const void *)(made + 16), hair, points);
    for (uint32_t i = 0; i < count; i++) {
        const float *at = points + 3u * i, *rest = hair->rest + 3u * i;
        const double x = (double)at[0] - (double)rest[0], y = (double)at[1] - (double)rest[1];
        const double z = (double)at[2] - (double)rest[2], moved = sqrt(x * x + y * y + z * z);
        most = fmax(most, moved);
        beyond = fmax(beyond, moved - turned * hypot((double)rest[0], (double)rest[2]));
    }
    print_message("# hair moved by %.0f mm at most, by %.0f mm more than the turn\n", 1e3 * most, 1e3 * beyond);
    assert_true(most > 0.01 && beyond < 0.02);
    free(points);
    figure_close(&f);
    pack_file_close(&file);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_takes_the_bytes_that_it_plans),
        cmocka_unit_test(clips_and_held_floats_show),
        cmocka_unit_test(debug_views_and_levels_show),
        cmocka_unit_test(vertices_are_those_of_the_cpu),
        cmocka_unit_test(without_a_gpu_it_is_posed),
        cmocka_unit_test(light_is_counted_and_comes_back),
        cmocka_unit_test(hair_turns_from_where_the_turn_begins),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
