/* test_rows_draw.c: errors of the source documents that show only where something is drawn. Each test draws, and
 * fails when the source's error is put into the library or its shaders (tests/README.md lists them). */
#include "gl_fixture.h"

#include "base/math.h"
#include "convert/model/model_build.h"
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
static void defaults_come_first(void **state)
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

/* ---- one lit quad, and what its pixels have to be ---- */

#define QUAD 33u /* pixels of its picture, and of its row that is looked at */

typedef struct lit_quad {
    float world[12];
    noh_gl_camera camera;
    float base[3], metallic, roughness;
} lit_quad;

/* Half a turn about y with a scale that differs by axis; the camera looks along +z and the quad fills the picture. */
static lit_quad lit_quad_of(void)
{
    const float scale[3] = { 0.5f, 2.0f, 1.0f }, key[3] = { 0.95f, -0.2f, -0.24f };
    lit_quad q;
    memset(&q, 0, sizeof q);
    for (int i = 0; i < 3; i++) {
        q.world[5 * i] = i == 1 ? scale[i] : -scale[i];
        q.camera.key[i] = key[i] / sqrtf(noh_dot3(key, key));
        q.base[i] = 0.8f - 0.2f * (float)i;
    }
    q.camera.view_projection[0] = -1.0f / scale[0];
    q.camera.view_projection[5] = 1.0f / scale[1];
    q.camera.view_projection[10] = 0.1f;
    q.camera.view_projection[15] = 1.0f;
    q.camera.eye[2] = -4.0f;
    q.metallic = 0.25f;
    q.roughness = 0.5f;
    return q;
}

/* The unit normal at x = -1..1 of the quad is the mix of these, made unit again: they are far apart. */
static void quad_normal(float x, float out[3])
{
    out[0] = 0.96f * x;
    out[1] = 0.168f;
    out[2] = 0.224f;
}

static uint8_t *quad_pack(const lit_quad *q, size_t *count)
{
    const test_model_desc desc = { 1, 2, 0, 0, 1 };
    model *m = test_model(&desc);
    model_mesh *mesh = &m->meshes[0];
    uint8_t *bytes;
    m->materials = test_zeros(sizeof *m->materials);
    m->material_count = 1;
    m->materials[0].name = model_string("quad");
    m->materials[0].base_color_texture = MODEL_NONE;
    memcpy(m->materials[0].base_color, q->base, sizeof q->base);
    m->materials[0].base_color[3] = 1.0f;
    m->materials[0].metallic = q->metallic;
    m->materials[0].roughness = q->roughness;
    m->materials[0].alpha_cutoff = 0.5f;
    for (uint32_t v = 0; v < 4; v++) {
        const float x = v % 2 ? 1.0f : -1.0f, y = v / 2 ? 1.0f : -1.0f, at[3] = { x, y, 0.0f };
        memcpy(mesh->position + 3 * v, at, sizeof at);
        quad_normal(x, mesh->normal + 3 * v);
    }
    mesh->submeshes[0].material = 0;
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

/* The quad drawn into rgba[QUAD][QUAD][4]. */
static void draw_quad(const lit_quad *q, uint8_t *rgba)
{
    size_t count;
    uint8_t *bytes = quad_pack(q, &count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    gpu *g = fixture_gpu();
    noh_gl_ledger ledger = { 0 };
    noh_gl_renderer_desc desc;
    noh_gl_renderer renderer;
    noh_gl_mesh drawn;
    canvas c;
    char log[1024] = "";
    memset(&desc, 0, sizeof desc);
    desc.meshes = &mesh;
    desc.mesh_count = 1;
    assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, &mesh, &drawn, NULL), NOH_OK);
    assert_int_equal(noh_gl_renderer_create(&g->gl, &ledger, &desc, &renderer, log, sizeof log, NULL), NOH_OK);
    assert_int_equal(canvas_open(&c, g, QUAD, QUAD), 0);
    canvas_begin(&c);
    noh_gl_draw_begin(&renderer, &q->camera);
    noh_gl_draw_mesh(&renderer, &drawn, q->world, NULL, NULL, NULL, NULL, NOH_DRAW_OPAQUE);
    noh_gl_draw_end(&renderer);
    assert_int_equal(canvas_read(&c, rgba), 0);
    canvas_close(&c);
    noh_gl_renderer_delete(&renderer);
    noh_gl_mesh_delete(&g->gl, &ledger, &drawn);
    fixture_expect_no_errors();
    free(bytes);
}

static double encoded(double linear)
{
    double c = fmin(fmax(linear, 0.0), 1.0);
    return 255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055);
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

/* GGX with Smith's visibility (Walter et al. 2007), as mesh.frag has it. */
static double highlight(double nh, double nl, double nv, double roughness)
{
    const double a = roughness * roughness, d = nh * nh * (a * a - 1.0) + 1.0, k = 0.5 * a;
    return a * a / (3.14159265 * d * d) * 0.25 / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
}

/* mesh.frag's light on a point of the world, in sRGB 0..255. `held`: what faces away takes no light; the source does
 * not hold it. */
static void shade(const lit_quad *q, const double n[3], const double at[3], int held, double out[3])
{
    static const double warm[3] = { 1.02, 0.98, 0.92 }, ground[3] = { 0.23, 0.20, 0.18 }, above[3] = { 0.50, 0.54, 0.60 };
    const double key[3] = { (double)q->camera.key[0], (double)q->camera.key[1], (double)q->camera.key[2] };
    double v[3], h[3], nl = dot(n, key), nv, nh, lit, wrapped, edge;
    for (int i = 0; i < 3; i++) {
        v[i] = (double)q->camera.eye[i] - at[i];
    }
    unit(v);
    for (int i = 0; i < 3; i++) {
        h[i] = key[i] + v[i];
    }
    unit(h);
    nv = fmax(dot(n, v), 1e-3);
    nh = fmax(dot(n, h), 0.0);
    lit = held ? fmax(nl, 0.0) : nl;
    wrapped = held ? fmax((nl + 0.18) / 1.18, 0.0) : nl;
    edge = pow(1.0 - fmax(dot(h, v), 0.0), 5.0);
    for (int i = 0; i < 3; i++) {
        const double albedo = (double)q->base[i], metallic = (double)q->metallic, rough = (double)q->roughness;
        const double f0 = 0.04 + (albedo - 0.04) * metallic, sky = ground[i] + (above[i] - ground[i]) * (0.5 * n[1] + 0.5);
        double color = albedo * (1.0 - metallic) * (warm[i] * wrapped * fabs(wrapped) + 0.62 * sky);
        color += (f0 + (1.0 - f0) * edge) * highlight(nh, fmax(lit, 0.0), nv, rough) * lit * 2.6;
        color += f0 * sky * (0.7 - 0.4 * rough) * (0.15 + 0.85 * metallic);
        color += 0.10 * sky * pow(1.0 - nv, 3.0) * (1.0 - 0.6 * rough);
        out[i] = encoded(color);
    }
}

/* How normals come to the light. */
typedef enum normals_by { BY_INVERSE_TRANSPOSE, BY_MATRIX, BY_NOTHING, NOT_UNIT } normals_by;

/* The pixel of a column of the quad's middle row. */
static void quad_pixel(const lit_quad *q, uint32_t column, normals_by by, int held, double out[3])
{
    const float x = (2.0f * (float)column + 1.0f) / (float)QUAD - 1.0f;
    const double at[3] = { (double)(q->world[0] * x), 0.0, 0.0 };
    float normal[3];
    double n[3];
    quad_normal(x, normal);
    for (int i = 0; i < 3; i++) {
        const double axis = (double)q->world[5 * i];
        n[i] = (double)normal[i] * (by == BY_MATRIX ? axis : by == BY_NOTHING ? 1.0 : 1.0 / axis);
    }
    if (by == NOT_UNIT) { /* the light, by the cofactors' length: the determinant is 1 */
        shade(q, n, at, held, out);
    } else {
        unit(n);
        shade(q, n, at, held, out);
    }
}

/* A light of the world wants normals of the world: by the inverse transpose, made unit again in every pixel, and what
 * faces away from the light takes none. The source has the light in the world and the normal in the object, mixed and
 * not made unit, and a product that may be negative. Every pixel of a row is held against the closed form. */
static void light_and_normal_in_one_space(void **state)
{
    const lit_quad q = lit_quad_of();
    uint8_t *rgba = test_zeros(QUAD * QUAD * 4u);
    double off = 0.0, by_matrix = 0.0, by_nothing = 0.0, not_unit = 0.0, not_held = 0.0;
    (void)state;
    draw_quad(&q, rgba);
    for (uint32_t x = 0; x < QUAD; x++) {
        const uint8_t *pixel = rgba + 4u * (QUAD / 2u * QUAD + x);
        for (int i = 0; i < 3; i++) {
            double right[3], wrong[4][3];
            quad_pixel(&q, x, BY_INVERSE_TRANSPOSE, 1, right);
            quad_pixel(&q, x, BY_MATRIX, 1, wrong[0]);
            quad_pixel(&q, x, BY_NOTHING, 1, wrong[1]);
            quad_pixel(&q, x, NOT_UNIT, 1, wrong[2]);
            quad_pixel(&q, x, BY_INVERSE_TRANSPOSE, 0, wrong[3]);
            off = fmax(off, fabs((double)pixel[i] - right[i]));
            by_matrix = fmax(by_matrix, fabs(wrong[0][i] - right[i]));
            by_nothing = fmax(by_nothing, fabs(wrong[1][i] - right[i]));
            not_unit = fmax(not_unit, fabs(wrong[2][i] - right[i]));
            not_held = fmax(not_held, fabs(wrong[3][i] - right[i]));
        }
    }
    print_message("off by %.2f; normals by the matrix %.0f, by nothing %.0f, not unit %.0f, light not held %.0f (of 255)\n", off, by_matrix,
                  by_nothing, not_unit, not_held);
    assert_true(off < 1.5);
    assert_true(by_matrix > 10.0 && by_nothing > 10.0 && not_unit > 10.0 && not_held > 10.0);
    free(rgba);
}

/* ---- streams ---- */

/* Two meshes whose records differ in length, both on the GPU at once: each is fetched by its own stride. The source
 * binds the first mesh with the second one's, and a later bind hides it. */
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
    for (int i = 0; i < 4; i++) { /* in turns: what one left bound must not reach the other */
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

/* A program that failed without a message passes where only messages are looked at. Here the result tells which stage
 * failed, with no log to read, and so it does where the stages compile and do not fit each other. */
static void a_failed_shader_is_an_error_without_a_message(void **state)
{
    static const char *const bad[] = { "void main() { this is no shader }\n" };
    static const char *const flat[] = { "in vec3 v_there;\nprecision mediump float;\nout vec4 c;\nvoid main() { c = vec4(v_there, 1.0); }\n" };
    static const char *const alone[] = { "void main() { gl_Position = vec4(0.0); }\n" };
    static const char *const what[] = { "the vertex shader does not compile", "the fragment shader does not compile", "the program does not link" };
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

/* How many matrices blend is state that somebody else may have left; ours goes with each draw: what was drawn with one
 * joint a vertex leaves the next draw with all of its own. */
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
        cmocka_unit_test(light_and_normal_in_one_space),
        cmocka_unit_test(each_mesh_has_its_own_stride),
        cmocka_unit_test(a_failed_shader_is_an_error_without_a_message),
        cmocka_unit_test(influences_go_with_the_draw),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
