/* Errors of the source documents that show only when something is drawn. Each test draws, and fails if the source's
 * error is put into the library or its shaders (tests/README.md lists them). */
#include "support/gl_fixture.h"

#include "core/base/math_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gpu/canvas.h"
#include "support/lit_quad.h"
#include "support/parts_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 48u

typedef struct stage {
    gpu *g;
    pack_file file;
    uint8_t *bytes;
    parts parts;
    canvas c;
    noh_gl_camera camera;
} stage;

/* bytes: a pack; freed with the stage */
static void open_stage_of(stage *st, uint8_t *bytes, const size_t *count)
{
    memset(st, 0, sizeof *st);
    st->g = fixture_gpu();
    st->bytes = bytes;
    st->file.path = "a pack in memory";
    st->file.pack = test_open(st->bytes, *count);
    parts_open(&st->parts, st->g, &st->file, NOH_MORPH_AUTO, NOH_ACCUMULATE_AUTO, 1);
    parts_update(&st->parts, NULL);
    assert_int_equal(canvas_open(&st->c, st->g, SIDE, SIDE), 0);
    parts_camera(&st->parts, "0,0", SIDE, &st->camera);
}

static void open_stage(stage *st)
{
    const test_model_desc desc = { 1, 9, 3, TEST_UVS, 5 };
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    open_stage_of(st, bytes, &count);
}

static void close_stage(stage *st)
{
    canvas_close(&st->c);
    parts_close(&st->parts);
    free(st->bytes);
    fixture_expect_no_errors();
}

static void draw_mesh(stage *st)
{
    parts_draw_item(&st->parts, &st->parts.renderer, 0, NULL, NOH_DRAW_OPAQUE);
}

/* Set the light to its default: before the mesh is drawn, or after a draw, which shows nothing, has set it. */
static void reset_light(stage *st, int after_a_draw)
{
    const noh_gl_api *gl = &st->g->gl;
    if (after_a_draw) {
        gl->Enable(GL_RASTERIZER_DISCARD);
        draw_mesh(st);
        gl->Disable(GL_RASTERIZER_DISCARD);
    }
    for (uint32_t i = 0; i < st->parts.renderer.variant_count; i++) {
        gl->UseProgram(st->parts.renderer.variants[i].program);
        gl->Uniform3f(st->parts.renderer.variants[i].u_key, 0.0f, 0.0f, 0.0f);
    }
}

typedef enum light_reset { NEVER, FIRST, AFTER_THE_LIGHT } light_reset;

/* The mean of green in the pixels that were drawn over the background. */
static double brightness(stage *st, light_reset reset)
{
    uint8_t *rgba = test_zeros((size_t)SIDE * SIDE * 4u);
    double sum = 0.0;
    uint32_t drawn = 0;
    canvas_begin(&st->c);
    noh_gl_draw_begin(&st->parts.renderer, &st->camera);
    if (reset != NEVER) {
        reset_light(st, reset == AFTER_THE_LIGHT);
    }
    draw_mesh(st);
    noh_gl_draw_end(&st->parts.renderer);
    assert_int_equal(canvas_read(&st->c, rgba), 0);
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        if (!lit_quad_is_background(rgba + 4 * i)) {
            sum += rgba[4 * i + 1];
            drawn++;
        }
    }
    free(rgba);
    assert_true(drawn > SIDE * SIDE / 8u);
    return sum / drawn;
}

/* The source sets the light, and then resets all constants, the light among them. Here it is set by
 * the first draw of a pass, last. */
static void defaults_come_first(void **state)
{
    stage st;
    double lit, reset;
    (void)state;
    open_stage(&st);
    lit = brightness(&st, NEVER);
    reset = brightness(&st, AFTER_THE_LIGHT);
    assert_true(reset < 0.8 * lit);
    assert_true(fabs(brightness(&st, FIRST) - lit) < 0.5); /* the next pass sets it again, whatever was reset */
    assert_true(fabs(brightness(&st, NEVER) - lit) < 0.5);
    close_stage(&st);
}

/* Every range of a mesh's triangles is drawn, each once: a grid of three ranges looks like the same grid of one. */
static void ranges_make_the_whole_mesh(void **state)
{
    const test_model_desc desc = { 1, 9, 0, TEST_UVS, 5 };
    uint8_t *rgba[2] = { test_zeros((size_t)SIDE * SIDE * 4u), test_zeros((size_t)SIDE * SIDE * 4u) };
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        model *m = test_model(&desc);
        model_mesh *mesh = &m->meshes[0];
        const uint32_t ranges = i ? 3u : 1u, third = mesh->index_count / 9u * 3u;
        stage st;
        size_t count;
        if (i) mesh->submeshes = realloc(mesh->submeshes, ranges * sizeof *mesh->submeshes);
        for (uint32_t r = 1; r < ranges; r++) {
            mesh->submeshes[r] = mesh->submeshes[0];
            mesh->submeshes[r].first_index = r * third;
            mesh->submeshes[r].index_count = r == 1 ? third : mesh->index_count - 2u * third;
            mesh->submeshes[r].vertex_count = 0;
        }
        if (i) mesh->submeshes[0].index_count = third;
        mesh->submesh_count = ranges;
        uint8_t *bytes = test_pack_of(m, &count, NULL);
        open_stage_of(&st, bytes, &count);
        assert_int_equal(test_mesh(&st.file.pack, 0).header->submesh_count, ranges);
        canvas_begin(&st.c);
        noh_gl_draw_begin(&st.parts.renderer, &st.camera);
        draw_mesh(&st);
        noh_gl_draw_end(&st.parts.renderer);
        assert_int_equal(canvas_read(&st.c, rgba[i]), 0);
        close_stage(&st);
        model_free(m);
    }
    assert_false(lit_quad_is_background(rgba[0] + 4u * (SIDE / 2u * SIDE + SIDE / 2u)));
    assert_memory_equal(rgba[0], rgba[1], (size_t)SIDE * SIDE * 4u);
    free(rgba[0]);
    free(rgba[1]);
}

/* A light in world space needs normals in world space: by the inverse transpose, made unit again in every pixel, and
 * dark where they face away. The source has the light in world space and a normal in object space that is not unit, and
 * a product that may be negative. Every pixel of a row is compared with the closed form. */
static void light_and_normal_in_one_space(void **state)
{
    const lit_quad q = lit_quad_of();
    uint8_t *rgba = lit_quad_draw(fixture_gpu(), &q, NOH_DRAW_OPAQUE);
    double off = 0.0, by_matrix = 0.0, by_nothing = 0.0, not_unit = 0.0, not_held = 0.0;
    (void)state;
    for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
        const uint8_t *pixel = lit_quad_at(rgba, x);
        double right[3], wrong[4][3];
        lit_quad_pixel(&q, x, NORMALS_BY_INVERSE_TRANSPOSE, 1, right);
        lit_quad_pixel(&q, x, NORMALS_BY_MATRIX, 1, wrong[0]);
        lit_quad_pixel(&q, x, NORMALS_BY_NOTHING, 1, wrong[1]);
        lit_quad_pixel(&q, x, NORMALS_NOT_UNIT, 1, wrong[2]);
        lit_quad_pixel(&q, x, NORMALS_BY_INVERSE_TRANSPOSE, 0, wrong[3]);
        for (int i = 0; i < 3; i++) {
            off = fmax(off, fabs((double)pixel[i] - right[i]));
            by_matrix = fmax(by_matrix, fabs(wrong[0][i] - right[i]));
            by_nothing = fmax(by_nothing, fabs(wrong[1][i] - right[i]));
            not_unit = fmax(not_unit, fabs(wrong[2][i] - right[i]));
            not_held = fmax(not_held, fabs(wrong[3][i] - right[i]));
        }
    }
    print_message(
        "off by %.2f; normals by the matrix %.0f, by nothing %.0f, not unit %.0f, light not held %.0f (of 255)\n", off,
        by_matrix, by_nothing, not_unit, not_held);
    assert_true(off < LIT_QUAD_CLOSE);
    assert_true(by_matrix > 10.0 && by_nothing > 10.0 && not_unit > 10.0 && not_held > 10.0);
    fixture_expect_no_errors();
    free(rgba);
}

/* ---- streams ---- */

/* Two meshes with vertices of different sizes, both on the GPU at once: each is fetched with its own stride. The source
 * binds the first mesh with the stride of the second, which a later bind hides. */
static void each_mesh_has_its_own_stride(void **state)
{
    const test_model_desc lean = { 1, 7, 0, 0, 3 }, rich = { 1, 7, 0, TEST_UVS | TEST_COLORS | TEST_TANGENTS, 3 };
    size_t counts[2];
    uint8_t *bytes[2] = { test_pack(&lean, &counts[0]), test_pack(&rich, &counts[1]) };
    noh_pack packs[2] = { test_open(bytes[0], counts[0]), test_open(bytes[1], counts[1]) };
    noh_mesh meshes[2] = { test_mesh(&packs[0], 0), test_mesh(&packs[1], 0) };
    gpu *g = fixture_gpu();
    noh_gl_ledger ledger = { 0 };
    noh_gl_mesh uploaded[2];
    readback r;
    (void)state;
    assert_int_not_equal(meshes[0].header->attribute_stride, meshes[1].header->attribute_stride);
    assert_int_equal(readback_open(&r, g, 0), 0);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, &meshes[i], &uploaded[i], NULL), NOH_OK);
    }
    for (int i = 0; i < 4; i++) { /* by turns: what one left bound must not affect the other */
        const noh_mesh *mesh = &meshes[i % 2];
        const uint32_t count = mesh->header->vertex_count;
        float *got = test_zeros(9u * sizeof *got * count);
        assert_int_equal(readback_vertices(&r, &uploaded[i % 2], NULL, got, got + 3u * count, got + 6u * count), 0);
        for (uint32_t v = 0; v < count; v++) {
            noh_vertex expected;
            noh_mesh_vertex(mesh, v, &expected);
            for (uint32_t k = 0; k < 3; k++) {
                assert_true(fabsf(got[3u * v + k] - expected.position[k]) < 1e-6f);
                assert_true(fabsf(got[3u * count + 3u * v + k] - expected.normal[k]) < 1e-5f);
                assert_true(i % 2 == 0 || fabsf(got[6u * count + 3u * v + k] - expected.tangent[k]) < 1e-5f);
            }
        }
        free(got);
    }
    for (int i = 0; i < 2; i++) {
        noh_gl_mesh_delete(&g->gl, &ledger, &uploaded[i]);
        free(bytes[i]);
    }
    readback_close(&r);
    fixture_expect_no_errors();
}

/* In the source, only messages are looked at, so a program that fails without one passes. Here the result tells which
 * stage failed, without a log too, also if the stages compile and do not fit each other. */
static void a_failed_shader_is_an_error_without_a_message(void **state)
{
    static const char *const bad[] = { "void main() { this is no shader }\n" };
    static const char *const flat[] = {
        "in vec3 v_there;\nprecision mediump float;\nout vec4 c;\nvoid main() { c = vec4(v_there, 1.0); }\n"
    };
    static const char *const alone[] = { "void main() { gl_Position = vec4(0.0); }\n" };
    static const char *const what[] = { "the vertex shader does not compile", "the fragment shader does not compile",
                                        "the program does not link" };
    gpu *g = fixture_gpu();
    (void)state;
    for (int i = 0; i < 3; i++) {
        const noh_gl_source vertex = { "#version 300 es\n", i == 0 ? bad : alone, 1 };
        const noh_gl_source fragment = { "#version 300 es\nprecision mediump float;\n", i == 1 ? bad : flat, 1 };
        noh_gl_program_desc desc;
        noh_error error = { NOH_OK, "", 0, 0 };
        GLuint program = 77;
        memset(&desc, 0, sizeof desc);
        desc.vertex = &vertex;
        desc.fragment = &fragment;
        assert_int_equal(noh_gl_program_create(&g->gl, &desc, &program, NULL, 0, &error), NOH_ERR_DATA);
        assert_string_equal(error.what, what[i]);
        assert_int_equal(program, 77);
    }
}

/* In the source, the number of matrices that blend is state that an earlier draw may have left. Here it is part of each
 * draw: after one with one joint per vertex, the next has all of its own. */
static void influences_go_with_the_draw(void **state)
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
        cmocka_unit_test(defaults_come_first),
        cmocka_unit_test(ranges_make_the_whole_mesh),
        cmocka_unit_test(light_and_normal_in_one_space),
        cmocka_unit_test(each_mesh_has_its_own_stride),
        cmocka_unit_test(a_failed_shader_is_an_error_without_a_message),
        cmocka_unit_test(influences_go_with_the_draw),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
