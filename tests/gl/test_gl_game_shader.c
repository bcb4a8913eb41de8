/* A game's own shaders in the plain renderer: they draw every kind of mesh in every pass as the library's own text
 * does, get the textures and uniforms that the game binds, and where they are wrong say so and leave nothing. */
#include "support/tube_fixture.h"

#include "support/lit_quad.h"
#include "support/skin_asset.h"
#include "support/renderer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 128u

/* ---- the library's own text, as a game's ---- */

typedef struct tube_kind {
    uint32_t dual, uniform, is_uint; /* each 0 or 1; is_uint also NOH_LAYERS_DIRECT */
    noh_debug_view view;
} tube_kind;

static void open_tube(tube *t, uint8_t **bytes, noh_pack *pack, const tube_kind *k)
{
    static const char *const every_mesh[] = { "all" };
    const skin_cylinder c = { 24, 33, 9, 4, 3, 1, 2.0f, 0.35f };
    noh_gl_caps caps = fixture_gpu()->caps;
    model *m = skin_cylinder_model(&c);
    skin_options options;
    noh_mesh mesh;
    size_t count;
    memset(&options, 0, sizeof options);
    options.palette = 6;
    options.dual_quaternion = every_mesh;
    options.dual_quaternion_count = k->dual;
    *bytes = skin_pack_of(m, &options, 1.0f, &count, NULL);
    model_free(m);
    *pack = test_open(*bytes, count);
    mesh = test_mesh(pack, 0);
    if (k->is_uint == 1u) caps.render_f32 = caps.blend_f32 = 0;
    tube_open_with(t, &mesh, k->uniform ? NOH_PALETTE_UNIFORM : NOH_PALETTE_TEXTURE,
                   k->is_uint == 1u                  ? NOH_MORPH_GATHER
                   : k->is_uint == NOH_LAYERS_DIRECT ? NOH_MORPH_DIRECT
                                                     : NOH_MORPH_CPU,
                   0, &caps);
}

static noh_gl_renderer_desc desc_of(const tube *t, const tube_kind *k, const noh_gl_shader_desc *shaders)
{
    noh_gl_renderer_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = &t->mesh;
    desc.mesh_count = 1;
    desc.palettes = k->uniform ? NOH_PALETTE_UNIFORM : NOH_PALETTE_TEXTURE;
    desc.crowds = !k->uniform;
    desc.layers_uint = (int)k->is_uint;
    desc.fewer_influences = desc.fades = 1;
    desc.passes = NOH_PASSES_ALL;
    desc.view = k->view;
    desc.shaders = shaders;
    return desc;
}

static noh_gl_renderer renderer_of(const noh_gl_renderer_desc *desc, noh_gl_ledger *ledger)
{
    noh_gl_renderer r;
    char log[4096] = "";
    if (renderer_create(&(noh_gl_device){ &fixture_gpu()->gl, NULL, ledger, log, sizeof log }, desc, &r, NULL)) {
        fail_msg("%s", log);
    }
    return r;
}

/* Passes in order, each drawing what `drawn` says; to be freed. */
static uint8_t *picture(noh_gl_renderer *r, const tube *t, draw_kind kind, const noh_gl_lod *drawn, const int *passes,
                        uint32_t pass_count)
{
    uint8_t *rgba;
    fixture_frame f;
    fixture_frame_open(&f, SIDE);
    noh_gl_draw_begin(r, &tube_camera);
    for (uint32_t i = 0; i < pass_count; i++) {
        tube_draw(r, t, &t->gl, kind, drawn, passes[i]);
    }
    noh_gl_draw_end(r);
    rgba = fixture_frame_read(&f);
    fixture_frame_close(&f);
    fixture_expect_no_errors();
    return rgba;
}

static uint32_t covered(const uint8_t *rgba)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        count += rgba[4u * i + 3u] != 0;
    }
    return count;
}

static void check_same(const tube *t, const tube_kind *k, noh_gl_renderer r[2])
{
    static const int passes[2][2] = { { NOH_DRAW_OPAQUE }, { NOH_DRAW_DEPTH, NOH_DRAW_OPAQUE } };
    const noh_gl_lod drawn[2] = { { 0, 0.0f, 1.0f }, { 0, 0.3f, 0.8f } };
    for (int i = 0; i < 4 * (k->uniform ? 3 : 4); i++) {
        const draw_kind kind = (draw_kind)(i / 4);
        uint8_t *got = picture(&r[1], t, kind, &drawn[i % 2], passes[i / 2 % 2], 1u + (uint32_t)(i / 2 % 2));
        uint8_t *want = picture(&r[0], t, kind, &drawn[i % 2], passes[0], 1);
        assert_true(covered(want) > SIDE * SIDE / 50u);
        assert_memory_equal(got, want, SIDE * SIDE * 4u);
        free(got);
        free(want);
    }
}

/* texts: which of the two are given: 1 vertex, 2 fragment, 3 both. */
static void check_own(const tube_kind *k, int texts)
{
    char *vertex = test_shader_body("shaders_es/mesh.vert"), *fragment = test_shader_body("shaders_es/mesh.frag");
    const noh_gl_shader_desc own = { .name = "own",
                                     .vertex = texts & 1 ? vertex : NULL,
                                     .fragment = texts & 2 ? fragment : NULL };
    noh_gl_ledger ledger = { 0 };
    noh_gl_renderer_desc desc;
    noh_gl_renderer r[2];
    uint8_t *bytes;
    noh_pack pack;
    tube t;
    fixture_gpu();
    open_tube(&t, &bytes, &pack, k);
    for (int i = 0; i < 2; i++) {
        desc = desc_of(&t, k, i ? &own : NULL);
        r[i] = renderer_of(&desc, &ledger);
    }
    assert_int_equal(r[0].variant_count, r[1].variant_count);
    check_same(&t, k, r);
    for (int i = 0; i < 2; i++) {
        noh_gl_renderer_delete(&r[i]);
    }
    assert_true(ledger.programs == 0 && noh_gl_ledger_bytes(&ledger) == 0);
    tube_close(&t);
    free(bytes);
    free(vertex);
    free(fragment);
}

static void the_text_of_the_library_draws_its_pictures(void **state)
{
    const tube_kind kinds[] = { { 0, 0, 0, NOH_VIEW_LIT },
                                { 0, 0, NOH_LAYERS_DIRECT, NOH_VIEW_LIT },
                                { 1, 0, 0, NOH_VIEW_TANGENT },
                                { 0, 1, 0, NOH_VIEW_NORMAL } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(kinds); i++) {
        check_own(&kinds[i], 3);
    }
}

static void so_with_integer_layers(void **state)
{
    const tube_kind k = { 0, 0, 1, NOH_VIEW_LIT };
    (void)state;
    if (!fixture_gpu()->caps.render_u32) test_skip("no renderable RGBA32UI here");
    check_own(&k, 3);
}

static void one_of_two_is_enough(void **state)
{
    const tube_kind k = { 0, 0, 0, NOH_VIEW_LIT };
    (void)state;
    check_own(&k, 1);
    check_own(&k, 2);
}

/* ---- a toon shader ---- */

/* The README's: three steps of light. */
static void a_toon_shader_has_its_steps(void **state)
{
    char *vertex = test_example("shaders_es/README.md", 0), *fragment = test_example("shaders_es/README.md", 1);
    const noh_gl_shader_desc toon = { .name = "toon", .vertex = vertex, .fragment = fragment };
    lit_quad q = lit_quad_of();
    uint32_t steps_seen = 0, compared = 0;
    uint8_t *rgba;
    (void)state;
    q.shaders = &toon;
    rgba = lit_quad_draw(fixture_gpu(), &q, NOH_DRAW_OPAQUE);
    for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
        double n[3], light = 0.0, steps;
        lit_quad_normal(&q, x, NORMALS_BY_INVERSE_TRANSPOSE, n);
        for (int i = 0; i < 3; i++) {
            light += n[i] * (double)q.camera.key[i];
        }
        light = 3.0 * fmax(light, 0.0);
        steps = floor(light);
        if (fabs(light - rint(light)) > 0.01 || light <= 0.0) {
            for (int i = 0; i < 3; i++) {
                const double want = encoded((double)q.base[i] * (0.4 + 0.6 * steps / 3.0));
                assert_true(fabs((double)lit_quad_at(rgba, x)[i] - want) <= LIT_QUAD_CLOSE);
            }
            steps_seen |= 1u << (int)steps;
            compared++;
        }
    }
    assert_true(compared > LIT_QUAD_SIDE - 6u);
    assert_true((steps_seen & (steps_seen - 1u)) != 0); /* at least two steps */
    free(rgba);
    free(vertex);
    free(fragment);
    fixture_expect_no_errors();
}

/* ---- what the game binds ---- */

typedef struct binder {
    uint32_t calls, made;
    GLuint programs[64]; /* `made` of them were received */
    GLuint texture;
    const noh_material *material;
} binder;

static void bind(void *user, const noh_gl_api *api, GLuint program, const noh_material *material)
{
    binder *b = user;
    GLint current = 0;
    api->GetIntegerv(GL_CURRENT_PROGRAM, &current);
    assert_int_equal(current, program);
    api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + 1u);
    api->BindTexture(GL_TEXTURE_2D, b->texture);
    b->material = material;
    b->calls++;
}

/* Of a program that `bind` has not seen yet. */
static void made(void *user, const noh_gl_api *api, GLuint program, noh_gl_variant_key key)
{
    binder *b = user;
    GLint current = 0;
    api->GetIntegerv(GL_CURRENT_PROGRAM, &current);
    assert_int_equal(current, program);
    assert_in_range(key.influences, 0, 8);
    assert_in_range(b->made, 0, 63);
    for (uint32_t i = 0; i < b->made; i++) assert_int_not_equal(b->programs[i], program);
    b->programs[b->made++] = program;
    if (!key.depth) api->Uniform4f(api->GetUniformLocation(program, "u_add"), 0.0f, 0.5f, 0.0f, 0.0f);
}

static GLuint texel_of(const noh_gl_api *gl, const uint8_t rgba[4])
{
    GLuint name = 0;
    gl->GenTextures(1, &name);
    gl->BindTexture(GL_TEXTURE_2D, name);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 1, 1);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    return name;
}

/* A texture at the second sampler's unit, a uniform, and a define; a renderer that is restored has them too. */
static void textures_uniforms_and_defines_arrive(void **state)
{
    static const char fragment[] = "uniform sampler2D u_other, u_mine;\nuniform vec4 u_add;\nin vec4 v_color;\n"
                                   "layout(location = 0) out vec4 o_color;\nvoid main() {\n"
                                   "    o_color = texture(u_mine, vec2(0.5)) + u_add + vec4(0.0, 0.0, BLUE, 1.0);\n}\n";
    static const char *const samplers[] = { "u_other", "u_mine" };
    static const uint8_t red[4] = { 255, 0, 0, 255 };
    static const int opaque[] = { NOH_DRAW_OPAQUE };
    const tube_kind k = { 0, 0, 0, NOH_VIEW_LIT };
    binder b = { 0 };
    const noh_gl_shader_desc own = { .fragment = fragment,
                                     .defines = "#define BLUE 1.0\n",
                                     .samplers = samplers,
                                     .sampler_count = 2,
                                     .bind = bind,
                                     .made = made,
                                     .user = &b };
    const noh_gl_api *gl = &fixture_gpu()->gl;
    noh_gl_ledger ledger = { 0 };
    noh_gl_renderer_desc desc;
    noh_gl_renderer r;
    uint8_t *bytes;
    noh_pack pack;
    tube t;
    (void)state;
    b.texture = texel_of(gl, red);
    open_tube(&t, &bytes, &pack, &k);
    desc = desc_of(&t, &k, &own);
    r = renderer_of(&desc, &ledger);
    assert_int_equal(b.made, r.variant_count);
    for (int restored = 0; restored < 2; restored++) {
        uint8_t *rgba;
        uint32_t seen = 0;
        b.calls = 0;
        rgba = picture(&r, &t, SKINNED, NULL, opaque, 1);
        assert_int_equal(b.calls, COPIES * t.mesh.header->submesh_count);
        assert_non_null(b.material);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            static const uint8_t want[4] = { 255, 128, 255, 255 };
            for (int c = 0; rgba[4u * i + 3u] && c < 4; c++) {
                assert_in_range(rgba[4u * i + (uint32_t)c] + 1, want[c], want[c] + 2);
            }
            seen += rgba[4u * i + 3u] != 0;
        }
        assert_true(seen > SIDE * SIDE / 50u);
        free(rgba);
        b.made = 0;
        assert_int_equal(noh_gl_renderer_restore(&r, NULL, 0, NULL), NOH_OK);
        assert_int_equal(b.made, r.variant_count);
    }
    noh_gl_renderer_delete(&r);
    gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + 1u);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->DeleteTextures(1, &b.texture);
    tube_close(&t);
    free(bytes);
}

/* A vertex shader that moves the surface moves its depth too: with depth first, no pixel is lost. */
static void depth_follows_an_own_vertex_shader(void **state)
{
    static const char vertex[] =
        "out vec3 v_normal;\nvoid main() {\n    noh_vertex v = noh_fetch();\n"
        "    vec3 at = v.position + 0.2 * sin(9.0 * v.position.yzx);\n"
        "    v_normal = v.normal;\n    gl_Position = noh_view_projection * vec4(at, 1.0);\n}\n";
    static const char fragment[] = "in vec3 v_normal;\nlayout(location = 0) out vec4 o_color;\nvoid main() {\n"
                                   "    noh_fade();\n    o_color = vec4(normalize(v_normal) * 0.5 + 0.5, 1.0);\n}\n";
    static const int alone[] = { NOH_DRAW_OPAQUE }, first[] = { NOH_DRAW_DEPTH, NOH_DRAW_OPAQUE };
    const noh_gl_shader_desc own = { .name = "wave", .vertex = vertex, .fragment = fragment };
    const noh_gl_lod drawn = { 0, 0.2f, 1.0f };
    const tube_kind k = { 0, 0, 0, NOH_VIEW_LIT };
    noh_gl_ledger ledger = { 0 };
    noh_gl_renderer_desc desc;
    noh_gl_renderer r[2];
    uint8_t *bytes, *still;
    noh_pack pack;
    tube t;
    (void)state;
    fixture_gpu();
    open_tube(&t, &bytes, &pack, &k);
    for (int i = 0; i < 2; i++) {
        desc = desc_of(&t, &k, i ? &own : NULL);
        r[i] = renderer_of(&desc, &ledger);
    }
    still = picture(&r[0], &t, RIGID, &drawn, alone, 1);
    for (int kind = RIGID; kind <= CROWD; kind++) {
        uint8_t *want = picture(&r[1], &t, (draw_kind)kind, &drawn, alone, 1);
        uint8_t *got = picture(&r[1], &t, (draw_kind)kind, &drawn, first, 2);
        assert_true(covered(want) > SIDE * SIDE / 50u);
        assert_true(kind != RIGID || covered(want) != covered(still)); /* it does move */
        assert_memory_equal(got, want, SIDE * SIDE * 4u);
        free(got);
        free(want);
    }
    noh_gl_renderer_delete(&r[0]);
    noh_gl_renderer_delete(&r[1]);
    assert_int_equal(ledger.programs, 0);
    tube_close(&t);
    free(bytes);
    free(still);
}

/* ---- what is wrong ---- */

static noh_result create_with(const noh_gl_shader_desc *own, char *log, size_t log_bytes, noh_error *error)
{
    noh_gl_ledger ledger = { 0 }, nothing = { 0 };
    const tube_kind k = { 0, 0, 0, NOH_VIEW_LIT };
    noh_gl_renderer_desc desc;
    noh_gl_renderer r;
    noh_result result;
    uint8_t *bytes;
    noh_pack pack;
    tube t;
    fixture_gpu();
    open_tube(&t, &bytes, &pack, &k);
    desc = desc_of(&t, &k, own);
    result = renderer_create(&(noh_gl_device){ &fixture_gpu()->gl, NULL, &ledger, log, log_bytes }, &desc, &r, error);
    if (!result) noh_gl_renderer_delete(&r);
    assert_memory_equal(&ledger, &nothing, sizeof ledger);
    tube_close(&t);
    free(bytes);
    return result;
}

static void a_broken_shader_says_where(void **state)
{
    noh_gl_shader_desc own = { .name = "toon", .vertex = "void main()\n{\n    gl_Position = nowhere;\n}\n" };
    char log[2048];
    noh_error error;
    (void)state;
    assert_int_equal(create_with(&own, log, sizeof log, &error), NOH_ERR_DATA);
    assert_string_equal(error.what, "the vertex shader does not compile");
    assert_int_equal(error.where, GL_VERTEX_SHADER);
    assert_true(strncmp(log, "toon: vertex: ", 14) == 0);
    assert_non_null(strstr(log, "nowhere"));
    /* line 3 of the text, not of what stands before it, as Mesa writes it or NVIDIA */
    assert_true(strstr(log, ":3") || strstr(log, "(3)"));
    own.vertex = NULL;
    own.fragment =
        "in vec3 v_elsewhere;\nlayout(location = 0) out vec4 o;\nvoid main() { o = vec4(v_elsewhere, 1.0); }\n";
    assert_int_equal(create_with(&own, log, sizeof log, &error), NOH_ERR_DATA);
    assert_string_equal(error.what, "the program does not link");
    assert_true(strncmp(log, "toon: link: ", 12) == 0);
    assert_int_equal(create_with(&own, NULL, 0, &error), NOH_ERR_DATA);
    fixture_expect_no_errors();
}

/* Attributes of meshes are all that a game's shader can read: another one would be what nobody wrote. */
static void a_shader_reads_what_meshes_have(void **state)
{
    noh_gl_shader_desc own = {
        .name = "toon",
        .vertex = "layout(location = 15) in vec4 mine;\nvoid main()\n{\n    gl_Position = mine;\n}\n",
        .fragment = "layout(location = 0) out vec4 o;\nvoid main() { o = vec4(1.0); }\n",
    };
    char log[2048];
    noh_error error;
    (void)state;
    assert_int_equal(create_with(&own, log, sizeof log, &error), NOH_ERR_DATA);
    assert_string_equal(error.what, "a vertex shader reads an attribute that is not in the desc's inputs");
    assert_int_equal(error.where, 15);
    assert_true(strncmp(log, "toon: vertex: mine: ", 20) == 0);
    own.inputs = &(noh_gl_input){ 15, GL_FLOAT_VEC4 };
    own.input_count = 1;
    assert_int_equal(create_with(&own, log, sizeof log, &error), NOH_OK);
    own.inputs = &(noh_gl_input){ 15, GL_INT_VEC4 };
    assert_int_equal(create_with(&own, log, sizeof log, &error), NOH_ERR_DATA);
    own.input_count = NOH_GL_OWN_INPUTS_MAX + 1;
    assert_int_equal(create_with(&own, NULL, 0, &error), NOH_ERR_LIMIT);
    fixture_expect_no_errors();
}

static void too_many_samplers_are_refused(void **state)
{
    const char *names[NOH_GL_OWN_SAMPLERS_MAX + 1];
    noh_gl_shader_desc own = { .samplers = names, .sampler_count = NOH_GL_OWN_SAMPLERS_MAX };
    noh_error error;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(names); i++) {
        names[i] = "u_nothing";
    }
    assert_int_equal(create_with(&own, NULL, 0, &error), NOH_OK);
    own.sampler_count++;
    assert_int_equal(create_with(&own, NULL, 0, &error), NOH_ERR_LIMIT);
    assert_int_equal(error.where, NOH_GL_OWN_SAMPLERS_MAX);
    assert_int_equal(error.need, NOH_GL_OWN_SAMPLERS_MAX + 1);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_text_of_the_library_draws_its_pictures),
    cmocka_unit_test(so_with_integer_layers),
    cmocka_unit_test(one_of_two_is_enough),
    cmocka_unit_test(a_toon_shader_has_its_steps),
    cmocka_unit_test(textures_uniforms_and_defines_arrive),
    cmocka_unit_test(depth_follows_an_own_vertex_shader),
    cmocka_unit_test(a_broken_shader_says_where),
    cmocka_unit_test(a_shader_reads_what_meshes_have),
    cmocka_unit_test(too_many_samplers_are_refused),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
