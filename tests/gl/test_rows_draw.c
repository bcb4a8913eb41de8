/* test_rows_draw.c: the mistakes of the systems table's rows D5, D6, D7, D9 and E7 that show only where something
 * is drawn: each fails as its source has it, beside what the library does. */
#include "gl_fixture.h"

#include "base/math.h"
#include "gl/gl_program.h"
#include "load.h"
#include "camera.h"
#include "canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 48u

typedef struct stage {
    gpu *g;
    pack_file file;
    uint8_t *bytes;
    scene s;
    load l;
    canvas c;
    noh_gl_camera camera;
} stage;

static void open_stage(stage *st)
{
    const test_model_desc desc = { 1, 9, 3, TEST_UVS, 5 };
    const view_options view = { "0,0", SIDE, SIDE };
    load_options options;
    size_t count;
    bounds box;
    memset(st, 0, sizeof *st);
    memset(&options, 0, sizeof options);
    st->g = fixture_gpu();
    st->bytes = test_pack(&desc, &count);
    st->file.path = "a pack in memory";
    st->file.pack = test_open(st->bytes, count);
    assert_int_equal(scene_init(&st->s, &st->file), 0);
    assert_int_equal(load_open(&st->l, st->g, &st->file, &st->s, &options), 0);
    assert_int_equal(load_update(&st->l, NULL), 0);
    assert_int_equal(canvas_open(&st->c, st->g, SIDE, SIDE), 0);
    box = scene_bounds(&st->s, &st->file, 0);
    assert_int_equal(view_camera(&view, &box, &st->camera), 0);
}

static void close_stage(stage *st)
{
    canvas_close(&st->c);
    load_close(&st->l);
    scene_free(&st->s);
    free(st->bytes);
    fixture_expect_no_errors();
}

/* The mean of green where something was drawn over the background. */
static double brightness(stage *st, int reset_light)
{
    static const uint8_t background[3] = { CANVAS_BACKGROUND_SRGB };
    const noh_gl_api *gl = &st->g->gl;
    noh_gl_morph_binding morph = noh_gl_morph_binding_of(st->l.morph.morph, st->l.item_instances[0]);
    uint8_t *rgba = test_zeros((size_t)SIDE * SIDE * 4u);
    double sum = 0.0;
    uint32_t drawn = 0;
    canvas_begin(&st->c);
    noh_gl_draw_begin(&st->l.renderer, &st->camera);
    for (uint32_t i = 0; reset_light && i < st->l.renderer.variant_count; i++) {
        gl->UseProgram(st->l.renderer.variants[i].program);
        gl->Uniform3f(st->l.renderer.variants[i].u_key, 0.0f, 0.0f, 0.0f);
    }
    noh_gl_draw_mesh(&st->l.renderer, &st->l.meshes[0], scene_world(&st->s, &st->file, 0), &morph, NULL, NULL, st->l.pictures,
                     NOH_DRAW_OPAQUE);
    noh_gl_draw_end(&st->l.renderer);
    assert_int_equal(canvas_read(&st->c, rgba), 0);
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        if (memcmp(rgba + 4 * i, background, 3) != 0) {
            sum += rgba[4 * i + 1];
            drawn++;
        }
    }
    free(rgba);
    assert_true(drawn > SIDE * SIDE / 8u);
    return sum / drawn;
}

/* The light is set, then all constants are set to their defaults: the light is gone. Ours is set once a frame, last. */
static void D5_defaults_come_first(void **state)
{
    stage st;
    double lit, reset;
    (void)state;
    open_stage(&st);
    lit = brightness(&st, 0);
    reset = brightness(&st, 1);
    assert_true(reset < 0.8 * lit);
    assert_true(fabs(brightness(&st, 0) - lit) < 0.5); /* the next frame sets it again */
    close_stage(&st);
}

/* A light of the world against normals of the object, and a negative product that is not clamped. */
static void D6_light_and_normal_in_one_space(void **state)
{
    static const float turned[12] = { -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0 }; /* half a turn about y */
    static const float light[3] = { 0.0f, 0.0f, 1.0f }, normal[3] = { 0.0f, 0.0f, 1.0f };
    float rows[12], world[3], source, ours;
    (void)state;
    assert_true(noh_gl_normal_rows(turned, rows) > 0.0f);
    for (int r = 0; r < 3; r++) {
        world[r] = noh_dot3(rows + 4 * r, normal);
    }
    source = noh_dot3(light, normal);
    ours = noh_dot3(light, world);
    assert_true(source == 1.0f);  /* lit from behind */
    assert_true(ours == -1.0f);   /* the side that is turned away, which takes light away where it is not clamped */
    assert_true(fmaxf(ours, 0.0f) == 0.0f); /* mesh.frag's */
}

/* Two meshes whose records differ in length: one read by the other's stride is another mesh. */
static void D7_each_mesh_has_its_own_stride(void **state)
{
    const test_model_desc lean = { 1, 7, 1, 0, 3 }, rich = { 1, 7, 1, TEST_UVS | TEST_COLORS | TEST_TANGENTS, 3 };
    size_t counts[2];
    uint8_t *bytes[2] = { test_pack(&lean, &counts[0]), test_pack(&rich, &counts[1]) };
    noh_pack packs[2] = { test_open(bytes[0], counts[0]), test_open(bytes[1], counts[1]) };
    noh_mesh meshes[2] = { test_mesh(&packs[0], 0), test_mesh(&packs[1], 0) };
    const uint32_t own = meshes[1].header->attribute_stride, other = meshes[0].header->attribute_stride;
    uint32_t wrong = 0;
    (void)state;
    assert_true(own > other);
    for (uint32_t v = 1; v < meshes[1].header->vertex_count; v++) {
        noh_mesh misread = meshes[1];
        noh_mesh_header header = *misread.header;
        noh_vertex right, got;
        header.attribute_stride = other;
        misread.header = &header;
        noh_mesh_vertex(&meshes[1], v, &right);
        noh_mesh_vertex(&misread, v, &got);
        wrong += memcmp(right.normal, got.normal, sizeof right.normal) != 0;
        assert_true(fabsf(noh_dot3(right.normal, right.normal) - 1.0f) < 1e-5f);
    }
    assert_true(wrong > meshes[1].header->vertex_count / 2u);
    free(bytes[0]);
    free(bytes[1]);
}

/* A program that failed without a message passes where only messages are looked at; here the result tells. */
static void D9_a_failed_shader_is_an_error_without_a_message(void **state)
{
    static const char *const bad[] = { "void main() { this is no shader }\n" };
    static const char *const good[] = { "precision mediump float;\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n" };
    const noh_gl_source vertex = { "#version 300 es\n", bad, 1 }, fragment = { "#version 300 es\n", good, 1 };
    gpu *g = fixture_gpu();
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    GLuint program = 77;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.vertex = &vertex;
    desc.fragment = &fragment;
    assert_int_equal(noh_gl_program_create(&g->gl, &desc, &program, NULL, 0, &error), NOH_ERR_DATA);
    assert_int_equal(program, 77);
}

/* How many matrices blend is state that somebody else may have left; ours goes with each draw: what was drawn with one
 * joint a vertex leaves the next draw with all of its own. */
static void E7_influences_go_with_the_draw(void **state)
{
    noh_gl_skin_binding binding;
    noh_mesh_header header;
    noh_mesh mesh;
    (void)state;
    memset(&binding, 0, sizeof binding);
    memset(&header, 0, sizeof header);
    memset(&mesh, 0, sizeof mesh);
    header.influence_count = 4;
    mesh.header = &header;
    binding.mode = NOH_PALETTE_UNIFORM;
    for (uint32_t limit = 1; limit <= 4; limit *= 2u) {
        binding.influences = limit;
        assert_int_equal(noh_gl_variant_key_of(&mesh, &binding, 0, 0, NOH_VIEW_LIT).drawn, limit);
    }
    binding.influences = 0;
    assert_int_equal(noh_gl_variant_key_of(&mesh, &binding, 0, 0, NOH_VIEW_LIT).drawn, 4);
    assert_int_equal(noh_gl_variant_key_of(&mesh, NULL, 0, 0, NOH_VIEW_LIT).drawn, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(D5_defaults_come_first),
        cmocka_unit_test(D6_light_and_normal_in_one_space),
        cmocka_unit_test(D7_each_mesh_has_its_own_stride),
        cmocka_unit_test(D9_a_failed_shader_is_an_error_without_a_message),
        cmocka_unit_test(E7_influences_go_with_the_draw),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
