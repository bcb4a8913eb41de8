/* Extra attributes of vertices, from the model to a game's own shader: on every path, in both formats, at each level,
 * beside targets that move texture coordinates, and as the plain renderer draws them, in crowds too. */
#include "support/lod_fixture.h"
#include "support/tube_fixture.h"
#include "support/renderer.h"
#include "convert/model/model_extra.h"
#include "deform/morph/morph_internal.h"
#include "gl/draw/gl_renderer_internal.h"
#include "noh/low_core.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TARGETS 3u
#define COUNT 4u

static const char list[] = "TEXCOORD_1,_WIND:8,_ID,_NONE";

/* Values by position, as a file of floats has them; _NONE is in no mesh. */
static void value_of(const model_mesh *mesh, uint32_t k, uint32_t v, float out[4])
{
    const float *p = mesh->position + 3u * (size_t)v;
    memset(out, 0, 4u * sizeof *out);
    for (uint32_t c = 0; k == 0 && c < 2u; c++) out[c] = 1.5f * p[c] - 0.25f * p[2];
    for (uint32_t c = 0; k == 1u && c < 4u; c++) out[c] = 0.5f + 0.5f * sinf(3.0f * p[c % 3u] + (float)c);
    if (k == 2u) out[0] = floorf(40.0f * p[1]) + 1000.0f;
}

static void add_extras(model *m)
{
    model_mesh *mesh = &m->meshes[0];
    model_error error;
    assert_int_equal(extras_parse(list, &m->extras, &error), 0);
    mesh->extra = test_zeros(sizeof *mesh->extra * 4u * NOH_EXTRAS_MAX * mesh->vertex_count);
    mesh->extras[0].width = 2;
    mesh->extras[1].width = 4;
    mesh->extras[2].width = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (uint32_t k = 0; k < 3u; k++) value_of(mesh, k, v, mesh->extra + 4u * (v * NOH_EXTRAS_MAX + k));
    }
}

static void add_uv_targets(model_mesh *mesh)
{
    for (uint32_t t = 0; t < TARGETS; t++) {
        mesh->targets[t].uv = test_zeros(sizeof(float) * 2u * mesh->vertex_count);
        for (uint32_t v = 0; v < 2u * mesh->vertex_count; v++) mesh->targets[t].uv[v] = 0.1f * mesh->position[v];
    }
}

/* The pack's values are the model's within the stated errors, at every level; identities are exact. */
static void expect_values(const lod_pack *p)
{
    const uint32_t *sources = lod_pack_sources(p);
    const noh_extra_name *names = (const noh_extra_name *)(const void *)((const uint8_t *)p->mesh.extras +
                                                                         p->mesh.extras->names_offset);
    assert_int_equal(p->mesh.extras->count, COUNT);
    assert_true(names[0].error > 0.0f && names[0].error < 1e-4f && names[1].error < 2.1e-3f && names[2].error == 0.0f);
    for (uint32_t v = 0; v < p->mesh.header->vertex_count; v++) {
        static const uint32_t widths[COUNT] = { 2, 4, 1, 0 };
        for (uint32_t k = 0; k < COUNT; k++) {
            float want[4], got[4];
            value_of(p->from, k, sources[v], want);
            assert_int_equal(noh_mesh_extra(&p->mesh, k, v, got), widths[k]);
            for (int c = 0; c < 4; c++) assert_true(fabsf(got[c] - want[c]) <= names[k].error);
        }
    }
    free((void *)(uintptr_t)sources);
}

static void make(model *m, uint32_t levels, lod_pack *p)
{
    const lod_settings settings = { levels, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    add_extras(m);
    lod_pack_make(m, &settings, 0, p);
    expect_values(p);
}

static const char vertex_text[] = "out vec4 v_extra_0, v_extra_1, v_extra_2, v_extra_3;\nvoid main() {\n"
                                  "    noh_vertex v = noh_fetch();\n    v_extra_0 = noh_extra(0);\n"
                                  "    v_extra_1 = noh_extra(1);\n    v_extra_2 = noh_extra(2);\n"
                                  "    v_extra_3 = noh_extra(3);\n"
                                  "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n}\n";
static const char fragment_text[] = "layout(location = 0) out vec4 o;\nvoid main() { o = vec4(1.0); }\n";

/* Draw a level's vertices, and compare what arrives. */
static void check_arrival(const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph, const noh_mesh *level)
{
    static const char *const varyings[] = { "v_extra_0", "v_extra_1", "v_extra_2", "v_extra_3" };
    const noh_gl_shader_desc own = {
        .name = "extras", .vertex = vertex_text, .fragment = fragment_text, .defines = "#define NOH_EXTRAS\n"
    };
    const noh_gl_api *gl = &fixture_gpu()->gl;
    const uint32_t count = level->header->vertex_count;
    const size_t bytes = sizeof(float) * 4u * COUNT * count;
    noh_gl_variant_key key = noh_gl_variant_key_of(level, NULL, 0, morph->is_uint, NOH_VIEW_LIT);
    noh_gl_variant v;
    char log[4096] = "";
    const float *mapped;
    GLuint buffer = 0;
    key.two_layers = morph->layer_count == 2;
    if (noh_gl_variant_create(&(noh_gl_device){ gl, NULL, NULL, log, sizeof log }, key, &own, varyings, COUNT, &v,
                              NULL))
        fail_msg("%s", log);
    gl->UseProgram(v.program);
    gl->Uniform4fv(v.u_extras, 3 * (GLsizei)COUNT,
                   (const GLfloat *)(const void *)((const uint8_t *)level->extras + level->extras->rows_offset));
    noh_gl_morph_bind(gl, morph);
    gl->GenBuffers(1, &buffer);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl->BufferData(GL_TRANSFORM_FEEDBACK_BUFFER, (GLsizeiptr)bytes, NULL, GL_STREAM_READ);
    noh_gl_mesh_bind(gl, mesh, morph);
    noh_gl_morph_bind_streams(gl, v.u_streams, morph);
    gl->Enable(GL_RASTERIZER_DISCARD);
    gl->BeginTransformFeedback(GL_POINTS);
    gl->DrawArrays(GL_POINTS, 0, (GLsizei)count);
    gl->EndTransformFeedback();
    gl->Disable(GL_RASTERIZER_DISCARD);
    mapped = gl->MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, (GLsizeiptr)bytes, GL_MAP_READ_BIT);
    assert_non_null(mapped);
    for (uint32_t i = 0; i < count * COUNT; i++) {
        float want[4];
        (void)noh_mesh_extra(level, i % COUNT, i / COUNT, want);
        for (uint32_t c = 0; c < 4u; c++) assert_true(fabsf(mapped[4u * i + c] - want[c]) <= 1e-6f * fabsf(want[c]));
    }
    gl->UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    noh_gl_mesh_unbind(gl, mesh, morph);
    gl->UseProgram(0);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->DeleteBuffers(1, &buffer);
    noh_gl_variant_delete(gl, NULL, &v);
}

static void check_way(const lod_pack *p, fixture_way way, int vertices)
{
    const noh_gl_morph_desc desc = { .meshes = &p->mesh,
                                     .mesh_count = 1,
                                     .path = way.path,
                                     .accumulate = way.accumulate,
                                     .vertices = (uint8_t)vertices };
    gpu *g = fixture_gpu();
    fixture_morph m;
    noh_gl_ledger ledger;
    noh_gl_mesh gl_mesh;
    test_random random = test_random_from(5);
    memset(&ledger, 0, sizeof ledger);
    fixture_morph_open(&m, &desc, NULL);
    assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, &p->mesh, &gl_mesh, NULL), NOH_OK);
    assert_int_equal(noh_gl_ledger_bytes(&ledger), noh_gl_mesh_bytes(&p->mesh));
    for (uint32_t k = 0; k < p->mesh.header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(&p->mesh, k);
        noh_gl_morph_binding binding;
        fixture_set_level(&m, 0, k);
        fixture_set_random(&m, 0, &random);
        noh_gl_morph_update(m.morph, NULL);
        binding = noh_gl_morph_binding_of(m.morph, 0);
        check_arrival(&gl_mesh, &binding, &level);
    }
    noh_gl_mesh_delete(&g->gl, &ledger, &gl_mesh);
    fixture_morph_close(&m);
    fixture_expect_no_errors();
}

/* uv: targets move texture coordinates too, whose texels take a location. */
static void check_ways(int uv)
{
    const lod_face face = { 18, 14, TARGETS, 0, 0 };
    model *m = lod_face_model(&face);
    uint32_t ways = 0;
    lod_pack p;
    if (uv) add_uv_targets(&m->meshes[0]);
    make(m, 3, &p);
    assert_int_equal(p.mesh.header->extra_words, 3);
    assert_int_equal((p.mesh.header->flags & NOH_MESH_UV_TARGETS) != 0, uv);
    for (size_t i = 0; i < 2u * FIXTURE_WAYS; i++) {
        const fixture_way way = fixture_ways[i / 2u];
        const noh_gl_morph_desc desc = {
            .meshes = &p.mesh, .mesh_count = 1, .path = way.path, .accumulate = way.accumulate, .vertices = i % 2u
        };
        noh_gl_morph_plan plan;
        if (noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, NULL) != NOH_OK) continue;
        check_way(&p, way, (int)(i % 2u));
        ways++;
    }
    print_message("%u ways\n", ways);
    assert_true(ways >= 4);
    lod_pack_free(&p);
    model_free(m);
}

static void they_arrive_on_every_path(void **state)
{
    (void)state;
    check_ways(0);
}

static void and_beside_texture_coordinates_that_move(void **state)
{
    (void)state;
    check_ways(1);
}

/* ---- the renderer ---- */

#define SIDE 96u

/* Each pixel shows the attribute: of a constant value, it is the colour of every pixel. */
static void the_renderer_sets_what_they_need(void **state)
{
    static const char vertex[] = "flat out vec4 v_extra;\nvoid main() {\n    noh_vertex v = noh_fetch();\n"
                                 "    v_extra = noh_extra(1);\n"
                                 "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n}\n";
    static const char fragment[] = "flat in vec4 v_extra;\nlayout(location = 0) out vec4 o;\n"
                                   "void main() { o = vec4(v_extra.xyz, 1.0); }\n";
    const noh_gl_shader_desc own = {
        .name = "extras", .vertex = vertex, .fragment = fragment, .defines = "#define NOH_EXTRAS\n"
    };
    const skin_cylinder c = { 12, 9, 5, 4, TARGETS, 1, 2.0f, 0.35f };
    noh_gl_ledger ledger = { 0 };
    for (int without = 0; without < 2; without++) {
        const uint8_t want[3] = { without ? 0 : 51, without ? 0 : 102, without ? 0 : 255 };
        const lod_settings settings = { 1, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
        model *m = lod_tube_model(&c);
        noh_gl_renderer_desc desc;
        noh_gl_renderer r;
        lod_pack p;
        tube t;
        if (!without) add_extras(m);
        for (uint32_t v = 0; v < m->meshes[0].vertex_count && !without; v++) {
            static const float constant[4] = { 0.2f, 0.4f, 1.0f, 0.0f };
            memcpy(m->meshes[0].extra + 4u * (v * NOH_EXTRAS_MAX + 1u), constant, sizeof constant);
        }
        lod_pack_make(m, &settings, 0, &p);
        tube_open(&t, &p.mesh, NOH_PALETTE_TEXTURE);
        memset(&desc, 0, sizeof desc);
        desc.meshes = &t.mesh;
        desc.mesh_count = 1;
        desc.palettes = NOH_PALETTE_TEXTURE;
        desc.crowds = 1;
        desc.fewer_influences = desc.fades = 1;
        desc.passes = NOH_PASSES_ALL;
        desc.shaders = &own;
        assert_int_equal(
            renderer_create(&(noh_gl_device){ &fixture_gpu()->gl, NULL, &ledger, NULL, 0 }, &desc, &r, NULL), NOH_OK);
        for (int kind = RIGID; kind <= CROWD; kind++) {
            uint32_t seen = 0;
            fixture_frame f;
            uint8_t *rgba;
            fixture_frame_open(&f, SIDE);
            noh_gl_draw_begin(&r, &tube_camera);
            tube_draw(&r, &t, &t.gl, (draw_kind)kind, NULL, NOH_DRAW_OPAQUE);
            noh_gl_draw_end(&r);
            rgba = fixture_frame_read(&f);
            fixture_frame_close(&f);
            for (uint32_t i = 0; i < SIDE * SIDE; i++) {
                for (uint32_t k = 0; rgba[4u * i + 3u] && k < 3u; k++)
                    assert_in_range(rgba[4u * i + k] + 1, want[k], want[k] + 2);
                seen += rgba[4u * i + 3u] != 0;
            }
            assert_true(seen > SIDE * SIDE / 50u);
            free(rgba);
        }
        noh_gl_renderer_delete(&r);
        tube_close(&t);
        lod_pack_free(&p);
        model_free(m);
    }
    (void)state;
    fixture_expect_no_errors();
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(they_arrive_on_every_path),
    cmocka_unit_test(and_beside_texture_coordinates_that_move),
    cmocka_unit_test(the_renderer_sets_what_they_need),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
