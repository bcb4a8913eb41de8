/* A wig on the GPU: strips of the vertex shader are those of the CPU; its bytes are those that were planned; one draw
 * for each pass, whatever the number of strips; a lost context; fewer strips cover as much. */
#include "support/gl_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/figure.h"
#include "life/hair/haircut.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "gpu/canvas.h"
#include "shaders.gen.h"

#define SIDE 192u

typedef struct scene {
    gpu *g;
    pack_file file;
    lighting light;
    figure f;
    canvas c;
} scene;

static void open_scene(scene *s, int hair, int lit)
{
    static char path[1024];
    const char *build = getenv("NOH_BUILD");
    const light_options o = { .light = "room" };
    figure_desc d;
    memset(s, 0, sizeof *s);
    memset(&d, 0, sizeof d);
    s->g = fixture_gpu();
    snprintf(path, sizeof path, "%s/wig.noh", build ? build : "build");
    assert_int_equal(pack_file_open(&s->file, path), 0);
    if (lit) assert_int_equal(lighting_open(&s->light, &o), 0);
    d.file = &s->file;
    d.hair = hair;
    d.light = lit ? &s->light : NULL;
    assert_int_equal(figure_open(&s->f, &d, s->g), 0);
    assert_int_equal(canvas_open(&s->c, s->g, SIDE, SIDE), 0);
}

static void close_scene(scene *s)
{
    const int lit = s->f.desc.light != NULL;
    canvas_close(&s->c);
    figure_close(&s->f);
    if (lit) lighting_close(&s->light);
    pack_file_close(&s->file);
    assert_int_equal(noh_gl_ledger_bytes(&s->g->ledger), 0);
    fixture_expect_no_errors();
}

static uint8_t *picture(scene *s, const char *camera)
{
    const view_options o = { .camera = camera, .width = SIDE, .height = SIDE };
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4u);
    noh_gl_camera at;
    bounds box;
    assert_int_equal(figure_pose(&s->f), 0);
    box = figure_bounds(&s->f, 0);
    assert_int_equal(view_camera(&o, &box, &at), 0);
    assert_int_equal(figure_look(&s->f, &at, SIDE), 0);
    canvas_begin(&s->c);
    assert_int_equal(figure_draw(&s->f), 0);
    canvas_resolve(&s->c);
    assert_int_equal(canvas_read(&s->c, rgba), 0);
    return rgba;
}

static uint32_t differing(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) count += memcmp(a + 4u * i, b + 4u * i, 4) != 0;
    return count;
}

/* ---- vertices ---- */

/* The shader of strips with an empty fragment shader, what it makes of vertices fed back. */
static GLuint feedback_program(gpu *g)
{
    static const char *const text[] = { "precision mediump float;\nout vec4 o;\nvoid main()\n{\n o = vec4(1.0);\n}\n" };
    static const noh_gl_source fragment = { "#version 300 es\n", text, 1 };
    static const char *const samplers[] = { "u_points" }, *const varyings[] = { "v_position", "v_tangent" };
    char log[2048] = "";
    GLuint program = 0;
    noh_gl_program_desc d;
    memset(&d, 0, sizeof d);
    d.vertex = &noh_shader_hair_vert, d.fragment = &fragment;
    d.samplers = samplers, d.sampler_count = 1;
    d.varyings = varyings, d.varying_count = 2;
    d.ledger = &g->ledger;
    if (noh_gl_program_create(&g->gl, &d, &program, log, sizeof log, NULL)) fail_msg("%s", log);
    return program;
}

static void set(gpu *g, GLuint program, const char *name, float x, float y, float z, float w)
{
    g->gl.Uniform4f(g->gl.GetUniformLocation(program, name), x, y, z, w);
}

/* Strips without width, curled and strayed, in head space; [strips][segments + 1][2] of position and tangent. */
static float *vertices_of_gpu(scene *s, const noh_pack_hair_header *h, uint32_t strips)
{
    static const float rows[3][4] = { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 } };
    const GLuint program = feedback_program(s->g);
    const noh_gl_api *gl = &s->g->gl;
    const uint32_t vertices = 2u * (h->segment_count + 1u);
    float *strip_list = test_zeros((size_t)strips * vertices * 6u * sizeof(float));
    GLuint vertex_array;
    noh_gl_buffer buffer;
    const void *mapped;
    assert_int_equal(noh_gl_buffer_create(gl, &s->g->ledger, GL_TRANSFORM_FEEDBACK_BUFFER,
                                          (uint64_t)strips * vertices * 24u, NULL, GL_STREAM_READ, &buffer, NULL),
                     NOH_OK);
    gl->GenVertexArrays(1, &vertex_array);
    gl->BindVertexArray(vertex_array);
    gl->UseProgram(program);
    set(s->g, program, "u_counts", (float)h->point_count, (float)h->hair_count, (float)h->patch_count,
        (float)h->segment_count);
    set(s->g, program, "u_widths", 0.0f, 0.0f, h->scatter, 0.0f);
    set(s->g, program, "u_curl", h->curl_radius, h->curl_turns, 0.0f, 0.0f);
    set(s->g, program, "u_eye", 0.0f, 0.0f, 5.0f, 1.0f);
    gl->Uniform4fv(gl->GetUniformLocation(program, "u_world"), 3, rows[0]);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, s->f.hair.texture.name);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer.name);
    gl->Enable(GL_RASTERIZER_DISCARD);
    gl->BeginTransformFeedback(GL_POINTS);
    gl->DrawArraysInstanced(GL_POINTS, 0, (GLsizei)vertices, (GLsizei)strips);
    gl->EndTransformFeedback();
    gl->Disable(GL_RASTERIZER_DISCARD);
    mapped = gl->MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, (GLsizeiptr)((size_t)strips * vertices * 24u),
                                GL_MAP_READ_BIT);
    assert_non_null(mapped);
    memcpy(strip_list, mapped, (size_t)strips * vertices * 24u);
    (void)gl->UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->DeleteVertexArrays(1, &vertex_array);
    noh_gl_buffer_delete(gl, &s->g->ledger, &buffer);
    {
        GLuint p = program;
        noh_gl_program_delete(gl, &s->g->ledger, &p);
    }
    return strip_list;
}

static void strips_are_those_of_the_cpu(void **state)
{
    scene s;
    double worst = 0.0, turned = 1.0;
    (void)state;
    open_scene(&s, 1, 0);
    const noh_pack_hair_header *h = s.f.cut.header;
    const uint32_t strips = h->strip_count, vertices = 2u * (h->segment_count + 1u);
    float *gpu_made = vertices_of_gpu(&s, h, strips);
    for (uint32_t i = 0; i < strips * vertices; i++) {
        const float along = (float)(i % vertices / 2u) / (float)h->segment_count, *v = gpu_made + 6u * (size_t)i;
        float p[3], t[3];
        noh_haircut_vertex(&s.f.cut, s.f.cut.desc.rest, i / vertices, along, p, t);
        for (int c = 0; c < 3; c++) worst = fmax(worst, fabs((double)(p[c] - v[c])));
        turned = fmin(turned, (double)t[0] * v[3] + (double)t[1] * v[4] + (double)t[2] * v[5]);
    }
    printf("# %u strips: off by at most %.1f um, %.5f degrees\n", strips, 1e6 * worst, acos(fmin(turned, 1.0)) * 57.3);
    assert_true(worst < 20e-6);
    assert_true(turned > 0.99999);
    free(gpu_made);
    close_scene(&s);
}

/* ---- bytes, draws, a lost context ---- */

static void bytes_are_planned_and_come_back(void **state)
{
    scene s;
    uint8_t *before, *after;
    (void)state;
    open_scene(&s, 1, 1);
    before = picture(&s, "30,10");
    canvas_close(&s.c);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), s.f.plan.gpu_bytes + noh_stage_hair_bytes(&s.f.cut));
    assert_int_equal(figure_restore(&s.f), 0);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), s.f.plan.gpu_bytes + noh_stage_hair_bytes(&s.f.cut));
    assert_int_equal(canvas_open(&s.c, s.g, SIDE, SIDE), 0);
    after = picture(&s, "30,10");
    assert_int_equal(differing(before, after), 0);
    free(before);
    free(after);
    close_scene(&s);
}

static void all_strips_are_one_draw(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, 0);
    free(picture(&s, "30,10"));
    assert_int_equal(s.f.hair.draws, 2); /* the core, and the fringe */
    noh_stage_hair_draw(&s.f.hair, s.f.stage, 0, NOH_PASS_OPAQUE);
    assert_int_equal(s.f.hair.draws, 3);
    s.f.hair.pixels_per_metre = 20.0f; /* far away */
    noh_stage_hair_draw(&s.f.hair, s.f.stage, 0, NOH_PASS_COLOR);
    assert_int_equal(s.f.hair.draws, 3);
    close_scene(&s);
}

/* One byte short is refused, and nothing is touched. */
static void memory_is_exact(void **state)
{
    scene s;
    noh_stage_hair hair;
    (void)state;
    open_scene(&s, 1, 0);
    const size_t bytes = noh_stage_hair_size(&s.f.cut);
    const uint64_t used = noh_gl_ledger_bytes(&s.g->ledger);
    const noh_gl_device device = { &s.g->gl, &s.g->caps, &s.g->ledger, NULL, 0 };
    uint8_t *memory = test_aligned(NULL, bytes);
    memset(memory, 0x5a, bytes);
    assert_int_equal(noh_stage_hair_create(&device, &s.f.wig, memory, bytes - 1u, 0, 0, &hair, NULL), NOH_ERR_MEMORY);
    for (size_t i = 0; i < bytes; i++) assert_int_equal(memory[i], 0x5a);
    assert_int_equal(noh_stage_hair_create(&device, &s.f.wig, memory, bytes, 0, 0, &hair, NULL), NOH_OK);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), used + noh_stage_hair_bytes(&s.f.cut));
    noh_stage_hair_delete(&hair);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), used);
    free(memory);
    close_scene(&s);
}

/* ---- what is seen ---- */

/* The share of the picture that the wig changes. */
static double coverage(scene *s, const uint8_t *bald, uint32_t strips)
{
    const noh_pack_hair_header *all = s->f.cut.header;
    const float widen = noh_haircut_widen(&s->f.cut, strips);
    noh_pack_hair_header fewer = *all;
    uint8_t *rgba;
    double share;
    fewer.strip_count = strips;
    fewer.width_root *= widen, fewer.width_tip *= widen;
    s->f.cut.header = &fewer;
    rgba = picture(s, "120,10,0.8");
    s->f.cut.header = all;
    share = differing(rgba, bald) / (double)(SIDE * SIDE);
    free(rgba);
    return share;
}

static void fewer_strips_cover_as_much(void **state)
{
    scene s;
    uint8_t *bald;
    (void)state;
    open_scene(&s, 0, 0);
    bald = picture(&s, "120,10,0.8");
    close_scene(&s);
    open_scene(&s, 1, 0);
    const double all = coverage(&s, bald, s.f.cut.header->strip_count);
    const double quarter = coverage(&s, bald, s.f.cut.header->strip_count / 4u);
    printf("# coverage %.4f, of a quarter of the strips %.4f\n", all, quarter);
    assert_true(all > 0.1);
    assert_true(fabs(quarter / all - 1.0) <= 0.06);
    free(bald);
    close_scene(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(strips_are_those_of_the_cpu), cmocka_unit_test(bytes_are_planned_and_come_back),
    cmocka_unit_test(all_strips_are_one_draw),     cmocka_unit_test(memory_is_exact),
    cmocka_unit_test(fewer_strips_cover_as_much),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
