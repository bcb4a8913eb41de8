/* A game's own shaders, the examples of shaders_es/README.md: behind noh_gl_shader_prefix, and put together from single
 * files as the README says. The vertices of a mesh that morphs and bends equal the CPU's, with palettes in a block
 * and in a texture, with float layers and integer ones, and for a mesh without joints. */
#include "support/gl_fixture.h"

#include "gl/draw/gl_variants_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "support/skin_asset.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the shader ---- */

static GLuint compile(const noh_gl_api *gl, GLenum stage, const char *const *texts, GLsizei count)
{
    GLuint shader = gl->CreateShader(stage);
    GLint ok = 0;
    char log[2048] = "";
    gl->ShaderSource(shader, count, texts, NULL);
    gl->CompileShader(shader);
    gl->GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    gl->GetShaderInfoLog(shader, sizeof log, NULL, log);
    if (!ok) fail_msg("%s", log);
    return shader;
}

enum { TOON_VERTEX, TOON_FRAGMENT, SINGLE_FILES }; /* the README's examples */

static char *prefix_of(noh_gl_variant_key key, GLenum stage)
{
    const size_t bytes = noh_gl_shader_prefix(key, stage, NULL, 0);
    char *text = test_zeros(bytes);
    assert_int_equal(noh_gl_shader_prefix(key, stage, text, bytes), bytes);
    assert_int_equal(strlen(text) + 1, bytes);
    return text;
}

/* From the prefix, or from single files. */
static GLuint own_vertex(const noh_gl_api *gl, noh_gl_variant_key key, int whole)
{
    char defines[NOH_GL_DEFINES_BYTES], *own = test_example("shaders_es/README.md", whole ? TOON_VERTEX : SINGLE_FILES);
    char *prefix = prefix_of(key, GL_VERTEX_SHADER);
    const char *one[] = { "#version 300 es\n", prefix, own };
    const char *files[] = { "#version 300 es\n",
                            defines,
                            "precision highp float;\nprecision highp int;\n",
                            noh_gl_shader_text("common_delta.glsl"),
                            noh_gl_shader_text("common_walk.glsl"),
                            noh_gl_shader_text("common_layers.glsl"),
                            noh_gl_shader_text("common_attributes.glsl"),
                            noh_gl_shader_text("common_skin.glsl"),
                            own };
    GLuint shader;
    noh_gl_variant_defines(key, defines);
    shader = compile(gl, GL_VERTEX_SHADER, whole ? one : files, whole ? 3 : 9);
    free(prefix);
    free(own);
    return shader;
}

static GLuint own_fragment(const noh_gl_api *gl, noh_gl_variant_key key, int whole)
{
    char *prefix = prefix_of(key, GL_FRAGMENT_SHADER), *own = test_example("shaders_es/README.md", TOON_FRAGMENT);
    const char *parts[] = { "#version 300 es\n", prefix, whole ? own : "void main() {}" };
    GLuint shader = compile(gl, GL_FRAGMENT_SHADER, parts, 3);
    free(prefix);
    free(own);
    return shader;
}

static GLuint own_program(const noh_gl_api *gl, noh_gl_variant_key key, int whole)
{
    static const char *const varyings[] = { "gl_Position", "v_normal" };
    GLuint shaders[2], program = gl->CreateProgram(), block;
    GLint ok = 0;
    shaders[0] = own_vertex(gl, key, whole);
    shaders[1] = own_fragment(gl, key, whole);
    for (int i = 0; i < 2; i++) {
        gl->AttachShader(program, shaders[i]);
        gl->DeleteShader(shaders[i]);
    }
    gl->TransformFeedbackVaryings(program, 2, varyings, GL_INTERLEAVED_ATTRIBS);
    gl->LinkProgram(program);
    gl->GetProgramiv(program, GL_LINK_STATUS, &ok);
    assert_true(ok);
    gl->UseProgram(program);
    gl->Uniform1i(gl->GetUniformLocation(program, "noh_layers"), (GLint)NOH_UNIT_LAYERS);
    gl->Uniform1i(gl->GetUniformLocation(program, "noh_deltas"), (GLint)NOH_UNIT_LAYERS);
    gl->Uniform1i(gl->GetUniformLocation(program, "noh_lists"), (GLint)NOH_UNIT_LISTS);
    gl->Uniform1i(gl->GetUniformLocation(program, "noh_starts"), (GLint)NOH_UNIT_LISTS + 1);
    gl->Uniform1i(gl->GetUniformLocation(program, "noh_palettes"), (GLint)NOH_UNIT_PALETTES);
    gl->Uniform1i(gl->GetUniformLocation(program, "noh_base_color_texture"), (GLint)NOH_UNIT_BASE_COLOR);
    block = gl->GetUniformBlockIndex(program, "noh_palette_block");
    if (block != GL_INVALID_INDEX) gl->UniformBlockBinding(program, block, 0);
    return program;
}

/* ---- a mesh that morphs and bends ---- */

typedef struct stage {
    gpu *g;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_gl_ledger ledger;
    noh_gl_mesh gl_mesh;
    fixture_morph morph;
    noh_gl_morph_desc morph_desc;
    void *memory;
    noh_gl_skin *skin; /* NULL: a mesh without joints */
    float matrices[16 * 12];
} stage;

static void open_skin(stage *st, noh_palette_mode mode)
{
    noh_gl_skin_desc desc;
    noh_gl_skin_plan plan;
    noh_skin skin;
    noh_skeleton skeleton;
    noh_transform pose[16];
    float world[16 * 12];
    test_random r = test_random_from(95);
    assert_int_equal(noh_pack_skin_at(&st->pack, st->mesh.header->skin, &skin, NULL), NOH_OK);
    assert_int_equal(noh_pack_skeleton_at(&st->pack, skin.header->skeleton, &skeleton, NULL, NULL), NOH_OK);
    assert_in_range(skeleton.joint_count, 2, 16);
    memcpy(pose, skeleton.bind_pose, sizeof *pose * skeleton.joint_count);
    for (uint32_t i = 0; i < skeleton.joint_count; i++) {
        const float turn[3] = { test_random_float(&r, -0.4f, 0.4f), test_random_float(&r, -0.4f, 0.4f), 0.2f };
        float q[4];
        noh_quat_from_rotation(turn, q);
        noh_quat_mul(pose[i].rotation, q, pose[i].rotation);
    }
    noh_local_to_model(&skeleton, pose, skeleton.joint_count, world);
    noh_skin_matrices(&skin, world, st->matrices);
    memset(&desc, 0, sizeof desc);
    desc.meshes = &st->mesh;
    desc.mesh_count = 1;
    desc.mode = mode;
    assert_int_equal(noh_gl_skin_plan_make(&desc, &st->g->caps, &plan, NULL), NOH_OK);
    st->memory = test_aligned(NULL, (size_t)plan.cpu_bytes);
    assert_int_equal(noh_gl_skin_init(st->memory, (size_t)plan.cpu_bytes,
                                      &(noh_gl_device){ &st->g->gl, &st->g->caps, &st->ledger, NULL, 0 }, &desc,
                                      &st->skin, NULL),
                     NOH_OK);
    noh_gl_skin_set_matrices(st->skin, 0, st->matrices);
    noh_gl_skin_update(st->skin);
}

static void open_stage(stage *st, int jointed, noh_palette_mode mode, int layers)
{
    const skin_cylinder tube = { 12, 9, 4, 2, 3, 1, 2.0f, 0.3f };
    const test_model_desc grid = { 1, 9, 3, TEST_TANGENTS, 96 };
    noh_gl_caps caps;
    test_random r = test_random_from(97);
    model *m = jointed ? skin_cylinder_model(&tube) : NULL;
    size_t count;
    memset(st, 0, sizeof *st);
    st->g = fixture_gpu();
    caps = st->g->caps;
    if (layers == 1) caps.render_f32 = caps.blend_f32 = 0;
    st->bytes = jointed ? skin_pack_of(m, NULL, 0.5f, &count, NULL) : test_pack(&grid, &count);
    if (m) model_free(m);
    st->pack = test_open(st->bytes, count);
    st->mesh = test_mesh(&st->pack, 0);
    assert_int_equal(noh_gl_mesh_create(&st->g->gl, &st->ledger, &st->mesh, &st->gl_mesh, NULL), NOH_OK);
    st->morph_desc.meshes = &st->mesh;
    st->morph_desc.mesh_count = 1;
    st->morph_desc.path = layers == 1 ? NOH_MORPH_GATHER : layers ? NOH_MORPH_DIRECT : NOH_MORPH_CPU;
    fixture_morph_open(&st->morph, &st->morph_desc, &caps);
    fixture_set_random(&st->morph, 0, &r);
    noh_gl_morph_update(st->morph.morph, NULL);
    if (jointed) open_skin(st, mode);
}

static void close_stage(stage *st)
{
    if (st->skin) noh_gl_skin_delete(st->skin);
    fixture_morph_close(&st->morph);
    noh_gl_mesh_delete(&st->g->gl, &st->ledger, &st->gl_mesh);
    assert_true(noh_gl_ledger_bytes(&st->ledger) == 0);
    free(st->memory);
    free(st->bytes);
    fixture_expect_no_errors();
}

/* ---- drawing with it ---- */

/* [vertex_count] position, 1 and normal, to be freed. */
static float *draw(const stage *st, int whole)
{
    static const float identity[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    const noh_gl_api *gl = &st->g->gl;
    const noh_gl_morph_binding morph = noh_gl_morph_binding_of(st->morph.morph, 0);
    const noh_gl_skin_binding skin = st->skin ? noh_gl_skin_binding_of(st->skin, 0) : (noh_gl_skin_binding){ 0 };
    const size_t bytes = 28u * (size_t)st->mesh.header->vertex_count;
    noh_gl_variant own;
    GLuint buffer = 0;
    float *out = test_zeros(bytes);
    const void *mapped;
    memset(&own, 0, sizeof own);
    own.key = noh_gl_variant_key_of(&st->mesh, st->skin ? &skin : NULL, 0, morph.is_uint, NOH_VIEW_LIT);
    own.program = own_program(gl, own.key, whole);
    own.u_skin = gl->GetUniformLocation(own.program, "noh_skin");
    gl->UniformMatrix4fv(gl->GetUniformLocation(own.program, whole ? "noh_view_projection" : "u_view_projection"), 1,
                         GL_FALSE, identity);
    gl->Uniform4fv(gl->GetUniformLocation(own.program, "noh_world"), 3, identity);
    gl->Uniform4fv(gl->GetUniformLocation(own.program, "noh_normal"), 3, identity);
    gl->Uniform4i(gl->GetUniformLocation(own.program, "noh_morph"), morph.tile_x, morph.tile_y, morph.width_log2,
                  morph.touched);
    noh_gl_morph_bind(gl, &morph);
    gl->GenBuffers(1, &buffer);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl->BufferData(GL_TRANSFORM_FEEDBACK_BUFFER, (GLsizeiptr)bytes, NULL, GL_STREAM_READ);
    gl->BindVertexArray(st->gl_mesh.vertex_array);
    if (st->skin) noh_gl_variant_skin(gl, &own, &st->mesh, &skin, 0);
    gl->Enable(GL_RASTERIZER_DISCARD);
    gl->BeginTransformFeedback(GL_POINTS);
    gl->DrawArrays(GL_POINTS, 0, (GLsizei)st->mesh.header->vertex_count);
    gl->EndTransformFeedback();
    gl->Disable(GL_RASTERIZER_DISCARD);
    mapped = gl->MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, (GLsizeiptr)bytes, GL_MAP_READ_BIT);
    assert_non_null(mapped);
    memcpy(out, mapped, bytes);
    gl->UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->BindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
    gl->DeleteBuffers(1, &buffer);
    gl->DeleteProgram(own.program);
    return out;
}

static void check_one(int jointed, noh_palette_mode mode, int is_uint, int whole)
{
    stage st;
    noh_morph_layers layers;
    float *got;
    double moved = 0.0;
    open_stage(&st, jointed, mode, is_uint);
    got = draw(&st, whole);
    layers = test_layers(&st.mesh);
    noh_morph_accumulate(&st.mesh, st.morph.weights[0], &layers);
    for (uint32_t v = 0; v < st.mesh.header->vertex_count; v++) {
        noh_vertex rest, want;
        noh_mesh_vertex(&st.mesh, v, &rest);
        if (jointed) {
            noh_skin_vertex(&st.mesh, st.matrices, &layers, v, &want);
        } else {
            noh_morph_vertex(&st.mesh, &layers, v, &want);
        }
        for (int c = 0; c < 3; c++) {
            moved = fmax(moved, fabs((double)want.position[c] - (double)rest.position[c]));
            if (jointed) {
                assert_true(fabsf(got[7 * v + (uint32_t)c] - want.position[c]) < 4e-6f);
            } else {
                assert_memory_equal(&got[7 * v + (uint32_t)c], &want.position[c], 4); /* one sum: the same bits */
            }
            assert_true(fabsf(got[7 * v + 4 + (uint32_t)c] - want.normal[c]) < 2e-5f);
        }
    }
    assert_true(moved > 0.05);
    free(layers.position);
    free(got);
    close_stage(&st);
}

static void check(int jointed, noh_palette_mode mode, int is_uint)
{
    for (int whole = 0; whole < 2; whole++) {
        check_one(jointed, mode, is_uint, whole);
    }
}

static void it_morphs(void **state)
{
    (void)state;
    check(0, NOH_PALETTE_AUTO, 0);
}

static void it_morphs_with_integer_layers(void **state)
{
    (void)state;
    if (!fixture_gpu()->caps.render_u32) test_skip("no renderable RGBA32UI here");
    check(0, NOH_PALETTE_AUTO, 1);
}

static void it_morphs_where_draws_sum(void **state)
{
    (void)state;
    check(0, NOH_PALETTE_AUTO, NOH_LAYERS_DIRECT);
    check(1, NOH_PALETTE_TEXTURE, NOH_LAYERS_DIRECT);
}

static void it_skins_by_a_block(void **state)
{
    (void)state;
    check(1, NOH_PALETTE_UNIFORM, 0);
}

static void it_skins_by_a_texture(void **state)
{
    (void)state;
    check(1, NOH_PALETTE_TEXTURE, 0);
}

static void other_names_have_no_text(void **state)
{
    static const char *const names[] = { "common_layers.glsl",  "common_attributes.glsl", "common_skin.glsl",
                                         "common_vertex.glsl",  "common_fade.glsl",       "common_fragment.glsl",
                                         "common_wrinkle.glsl", "common_material.glsl",   "common_face.glsl",
                                         "common_scatter.glsl", "common_eye.glsl",        "common_transfer.glsl",
                                         "common_light.glsl" };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(names); i++) {
        const char *text = noh_gl_shader_text(names[i]);
        assert_non_null(text);
        assert_null(strstr(text, "#version"));
        assert_null(strstr(text, "/*"));
    }
    assert_null(noh_gl_shader_text("common_layers"));
    assert_null(noh_gl_shader_text("mesh.vert"));
    assert_null(noh_gl_shader_text(""));
}

/* One byte short, nothing is written. */
static void a_short_prefix_is_not_written(void **state)
{
    static const GLenum stages[] = { GL_VERTEX_SHADER, GL_FRAGMENT_SHADER };
    const noh_gl_variant_key key = { 8, 4, 1, 1, 1, 1, 1, NOH_VIEW_LOD, 1, 1, 0, 1, 63, 0, 1, 4, 1 };
    (void)state;
    for (int i = 0; i < 2; i++) {
        const size_t bytes = noh_gl_shader_prefix(key, stages[i], NULL, 0);
        char *text = test_zeros(bytes + 1);
        text[0] = text[bytes] = 7;
        assert_int_equal(noh_gl_shader_prefix(key, stages[i], text, bytes - 1), bytes);
        assert_int_equal(text[0], 7);
        assert_int_equal(text[1], 0);
        assert_int_equal(noh_gl_shader_prefix(key, stages[i], text, bytes), bytes);
        assert_int_equal(text[bytes - 1], 0);
        assert_int_equal(text[bytes], 7);
        assert_int_equal(strlen(text), bytes - 1);
        assert_memory_equal(text + bytes - 12, "\n#line 1 0\n", 12);
        free(text);
    }
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_morphs),
        cmocka_unit_test(it_morphs_with_integer_layers),
        cmocka_unit_test(it_morphs_where_draws_sum),
        cmocka_unit_test(it_skins_by_a_block),
        cmocka_unit_test(it_skins_by_a_texture),
        cmocka_unit_test(other_names_have_no_text),
        cmocka_unit_test(a_short_prefix_is_not_written),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
