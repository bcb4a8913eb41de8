/* The library on a GL that does nothing and checks every call (platform/null.h): whole loads,
 * frames and deletions without a violation, every object labelled and deleted, every pass in a
 * debug group, no object made in a frame. And the checks themselves: each finds its own error. */
#include "support/level_fixture.h"

#include "null.h"
#include "support/parts_fixture.h"
#include "support/renderer.h"
#include "gl/draw/gl_renderer_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The capabilities of a good phone: the null platform draws nothing, so a probe would find none. */
static void all_abilities(noh_gl_caps *caps)
{
    caps->mrt3 = caps->layered = 1;
    caps->render_f32 = caps->render_f16 = caps->render_u32 = 1;
    caps->blend_f32 = caps->blend_f16 = caps->blend_f32_exact = 1;
}

static void open_null(gpu *g)
{
    assert_int_equal(gpu_open(g, "null"), 0);
}

static noh_null_report report_of(const gpu *g)
{
    noh_null_report report;
    noh_null_report_of(g->context, &report);
    return report;
}

static void expect_clean(const gpu *g)
{
    noh_null_report report = report_of(g);
    if (report.violations) fail_msg("%u violations, the first: %s", (unsigned)report.violations, report.first);
    assert_int_equal(report.groups, 0);
    assert_int_equal(noh_null_calls_of(g->context, "glPushDebugGroup"),
                     noh_null_calls_of(g->context, "glPopDebugGroup"));
}

static void expect_nothing_lives(const gpu *g)
{
    noh_null_report report = report_of(g);
    for (int kind = 0; kind < NOH_NULL_KINDS; kind++) assert_int_equal(report.live[kind], 0);
    assert_int_equal(report.bytes, 0);
}

/* ---- the probe ---- */

static void the_probe_calls_in_order(void **state)
{
    (void)state;
    gpu g;
    open_null(&g);
    noh_null_report report = report_of(&g);
    expect_clean(&g);
    expect_nothing_lives(&g);
    assert_int_equal(report.outside, 0);
    assert_true(report.draws > 0);
    assert_int_equal(g.caps.render_f32 + g.caps.render_f16 + g.caps.render_u32 + g.caps.layered, 0);
    gpu_close(&g);
}

/* ---- whole loads ---- */

typedef struct way {
    noh_morph_path path;
    noh_accumulate accumulate;
    int uint_layers;   /* without renderable floats */
    int no_extensions; /* neither debug functions nor geometry shaders, nor mapped buffers */
    int vertices;      /* finished ones, of the path cpu */
} way;

static void set_weights(parts *p, uint32_t frame, int which)
{
    for (uint32_t i = 0; i < p->item_count; i++) {
        uint32_t count = p->meshes[p->items[i].mesh].header->target_count;
        for (uint32_t t = 0; t < count; t++) {
            if (which == 2 || (int)i % 2 == which) p->items[i].weights[t] = (float)((frame + t) % 5u) * 0.25f;
        }
    }
}

static void frame(parts *p, uint32_t number, int which)
{
    noh_gl_camera camera;
    memset(&camera, 0, sizeof camera);
    set_weights(p, number, which);
    parts_update(p, NULL);
    parts_draw(p, &camera, NULL);
}

/* 8 frames in which all weights are new, some, or none: no object is made, and every call is in a group. */
static void steady_frames(gpu *g, parts *p, const char *name)
{
    uint64_t most = 0, still = 0;
    for (uint32_t i = 0; i < 8; i++) {
        noh_null_count_anew(g->context);
        frame(p, i / 2, (int)(i % 3));
        noh_null_report report = report_of(g);
        assert_int_equal(report.allocations, 0);
        assert_int_equal(report.outside, 0);
        most = report.calls > most ? report.calls : most;
    }
    frame(p, 9, 2);
    noh_null_count_anew(g->context);
    frame(p, 9, 2);
    still = report_of(g).calls;
    print_message("# %s: %lu GL calls in a frame in which all weights change, %lu where none does\n", name,
                  (unsigned long)most, (unsigned long)still);
    assert_true(most < 600);
    assert_true(still < most);
}

static void load_and_draw(const pack_file *file, const way *w)
{
    static parts p;
    gpu g;
    uint64_t bytes;
    char name[64];
    open_null(&g);
    all_abilities(&g.caps);
    if (w->uint_layers) g.caps.render_f32 = g.caps.blend_f32 = 0;
    if (w->no_extensions) {
        g.gl.ObjectLabel = NULL;
        g.gl.PushDebugGroup = NULL;
        g.gl.PopDebugGroup = NULL;
        g.gl.MapBufferRange = NULL;
    }
    snprintf(name, sizeof name, "%s%s %s%s%s", noh_morph_path_name(w->path), w->vertices ? " of vertices" : "",
             noh_accumulate_name(w->accumulate), w->uint_layers ? " as integers" : "",
             w->no_extensions ? " without extensions" : "");
    parts_open_as(&p, &g, file, w->path, w->accumulate, w->vertices, 3);
    assert_int_equal(noh_gl_morph_plan_of(p.morph.morph)->vertex_ring != 0, w->vertices);
    bytes = noh_gl_morph_plan_of(p.morph.morph)->gpu_bytes + NOH_GL_RENDERER_BYTES;
    for (uint32_t i = 0; i < file->pack.runs[NOH_CHUNK_MESH].count; i++) bytes += noh_gl_mesh_bytes(&p.meshes[i]);
    for (uint32_t i = 0; i < file->pack.runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_texture texture;
        assert_int_equal(noh_pack_texture_at(&file->pack, i, &texture, NULL), NOH_OK);
        bytes += noh_gl_picture_bytes(&texture, 1);
    }
    noh_null_report loaded = report_of(&g);
    assert_true(loaded.bytes == bytes);
    if (!w->no_extensions) {
        assert_int_equal(loaded.unlabelled, 0);
        steady_frames(&g, &p, name);
    } else {
        frame(&p, 1, 2);
    }
    parts_close(&p);
    expect_clean(&g);
    expect_nothing_lives(&g);
    gpu_close(&g);
}

static void every_path_keeps_the_order(void **state)
{
    static const way ways[] = {
        { NOH_MORPH_LAYERED, NOH_ACCUMULATE_F32, 0, 0, 0 },   { NOH_MORPH_MRT, NOH_ACCUMULATE_F32, 0, 0, 0 },
        { NOH_MORPH_PER_LAYER, NOH_ACCUMULATE_F16, 0, 0, 0 }, { NOH_MORPH_GATHER, NOH_ACCUMULATE_F32, 0, 0, 0 },
        { NOH_MORPH_GATHER, NOH_ACCUMULATE_F32, 1, 0, 0 },    { NOH_MORPH_CPU, NOH_ACCUMULATE_F32, 0, 0, 0 },
        { NOH_MORPH_CPU, NOH_ACCUMULATE_F16, 0, 0, 0 },       { NOH_MORPH_MRT, NOH_ACCUMULATE_F32, 0, 1, 0 },
        { NOH_MORPH_CPU, NOH_ACCUMULATE_F32, 0, 0, 1 },       { NOH_MORPH_CPU, NOH_ACCUMULATE_F32, 0, 1, 1 },
        { NOH_MORPH_DIRECT, NOH_ACCUMULATE_F32, 0, 0, 0 },    { NOH_MORPH_DIRECT, NOH_ACCUMULATE_F32, 0, 1, 0 }
    };
    const test_model_desc desc = { 3, 7, 9, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 11 };
    pack_file file;
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    (void)state;
    memset(&file, 0, sizeof file);
    file.path = "a pack in memory";
    file.pack = test_open(bytes, count);
    for (size_t i = 0; i < TEST_COUNT(ways); i++) load_and_draw(&file, &ways[i]);
    free(bytes);
}

/* ---- LOD levels ---- */

/* Instances at changing levels, drawn in two fading parts. */
static void draw_levels(parts *p, noh_gl_renderer *r, uint32_t number)
{
    noh_gl_camera camera;
    memset(&camera, 0, sizeof camera);
    for (uint32_t i = 0; i < p->item_count; i++)
        noh_gl_morph_set_lod(p->morph.morph, p->items[i].instance, (number + i) % 4u);
    parts_update(p, NULL);
    noh_gl_draw_begin(r, &camera);
    for (uint32_t i = 0; i < 2u * p->item_count; i++) {
        const noh_gl_lod part = { (number + i) % 4u, i % 2u ? 0.4f : 0.0f, i % 2u ? 1.0f : 0.4f };
        parts_draw_item(p, r, i / 2u, &part, NOH_DRAW_OPAQUE);
    }
    noh_gl_draw_end(r);
}

/* Each program that a pass draws with is given the camera once, however many meshes it draws; the others never. */
static void expect_cameras(const gpu *g, const parts *p, const noh_gl_renderer *r)
{
    uint32_t used = 0;
    for (uint32_t i = 0; i < r->variant_count; i++) {
        used += r->variants[i].has_camera;
    }
    assert_in_range(used, 1, r->variant_count - 1u); /* the variants that draw every pixel are not used here */
    assert_true(2u * p->item_count > used);
    assert_int_equal(noh_null_calls_of(g->context, "glUniformMatrix4fv"), used);
}

/* No index past its buffer, no object made in a frame, no call outside the groups. */
static void load_and_draw_levels(const pack_file *file, noh_morph_path path, int vertices)
{
    noh_gl_renderer_desc desc;
    noh_gl_renderer renderer;
    static parts p;
    gpu g;
    memset(&desc, 0, sizeof desc);
    open_null(&g);
    all_abilities(&g.caps);
    parts_open_as(&p, &g, file, path, NOH_ACCUMULATE_AUTO, vertices, 1);
    desc.layers_uint = noh_gl_morph_binding_of(p.morph.morph, 0).is_uint;
    desc.meshes = p.meshes;
    desc.mesh_count = file->pack.runs[NOH_CHUNK_MESH].count;
    desc.fades = 1;
    assert_int_equal(renderer_create(&(noh_gl_device){ &g.gl, NULL, &g.ledger, NULL, 0 }, &desc, &renderer, NULL),
                     NOH_OK);
    assert_int_equal(report_of(&g).unlabelled, 0);
    for (uint32_t number = 0; number < 8; number++) {
        set_weights(&p, number, 2);
        noh_null_count_anew(g.context);
        draw_levels(&p, &renderer, number);
        expect_cameras(&g, &p, &renderer);
        assert_int_equal(report_of(&g).allocations, 0);
        assert_int_equal(report_of(&g).outside, 0);
    }
    noh_gl_renderer_delete(&renderer);
    parts_close(&p);
    expect_clean(&g);
    expect_nothing_lives(&g);
    gpu_close(&g);
}

static void levels_keep_the_order(void **state)
{
    const test_model_desc desc = { 3, 7, 9, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 11 };
    const noh_morph_path paths[] = { NOH_MORPH_MRT, NOH_MORPH_GATHER, NOH_MORPH_CPU, NOH_MORPH_CPU, NOH_MORPH_DIRECT };
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    const noh_pack pack = test_open(bytes, count);
    fixture_levels levels;
    pack_file file;
    (void)state;
    memset(&file, 0, sizeof file);
    fixture_levels_open(&levels, &pack, 3, 2.0f);
    file.path = "a pack in memory";
    file.pack = levels.pack;
    for (size_t i = 0; i < TEST_COUNT(paths); i++) load_and_draw_levels(&file, paths[i], i == 3);
    fixture_levels_close(&levels);
    free(bytes);
}

/* ---- the checks find what is wrong ---- */

typedef void (*lie)(const noh_gl_api *gl);

static GLuint make_buffer(const noh_gl_api *gl, GLsizeiptr bytes)
{
    GLuint name = 0;
    gl->GenBuffers(1, &name);
    gl->BindBuffer(GL_ARRAY_BUFFER, name);
    gl->BufferData(GL_ARRAY_BUFFER, bytes, NULL, GL_STATIC_DRAW);
    return name;
}

static GLuint make_texture(const noh_gl_api *gl)
{
    GLuint name = 0;
    gl->GenTextures(1, &name);
    gl->BindTexture(GL_TEXTURE_2D, name);
    gl->TexStorage2D(GL_TEXTURE_2D, 2, GL_RGBA8, 8, 4);
    return name;
}

static GLuint use_program(const noh_gl_api *gl)
{
    static const char *const text = "#version 300 es\n";
    static const GLenum stages[2] = { GL_VERTEX_SHADER, GL_FRAGMENT_SHADER };
    GLuint program = gl->CreateProgram();
    for (int i = 0; i < 2; i++) {
        GLuint shader = gl->CreateShader(stages[i]);
        gl->ShaderSource(shader, 1, &text, NULL);
        gl->CompileShader(shader);
        gl->AttachShader(program, shader);
        gl->DeleteShader(shader);
    }
    gl->LinkProgram(program);
    gl->UseProgram(program);
    return program;
}

static void bind_vertices(const noh_gl_api *gl)
{
    GLuint array = 0;
    gl->GenVertexArrays(1, &array);
    gl->BindVertexArray(array);
    make_buffer(gl, 36);
    gl->EnableVertexAttribArray(0);
    gl->VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 12, NULL);
}

static void target_texture(const noh_gl_api *gl)
{
    GLuint framebuffer = 0, texture = make_texture(gl);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

static void draw_right(const noh_gl_api *gl)
{
    use_program(gl);
    bind_vertices(gl);
    target_texture(gl);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_without_program(const noh_gl_api *gl)
{
    bind_vertices(gl);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_with_deleted_program(const noh_gl_api *gl)
{
    GLuint program = use_program(gl);
    bind_vertices(gl);
    gl->DeleteProgram(program);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_without_vertex_array(const noh_gl_api *gl)
{
    use_program(gl);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_past_the_vertices(const noh_gl_api *gl)
{
    use_program(gl);
    bind_vertices(gl);
    gl->DrawArrays(GL_TRIANGLES, 0, 4);
}

static void draw_past_the_instances(const noh_gl_api *gl)
{
    use_program(gl);
    bind_vertices(gl);
    gl->VertexAttribDivisor(0, 1);
    gl->DrawArraysInstanced(GL_TRIANGLES, 0, 30, 4);
}

static void draw_without_indices(const noh_gl_api *gl)
{
    use_program(gl);
    bind_vertices(gl);
    gl->DrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, NULL);
}

static void draw_past_the_indices(const noh_gl_api *gl)
{
    GLuint name = 0;
    use_program(gl);
    bind_vertices(gl);
    gl->GenBuffers(1, &name);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, name);
    gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, 6, NULL, GL_STATIC_DRAW);
    gl->DrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, (const void *)(uintptr_t)2);
}

static void draw_from_deleted_buffer(const noh_gl_api *gl)
{
    GLuint array = 0, buffer;
    use_program(gl);
    gl->GenVertexArrays(1, &array);
    gl->BindVertexArray(array);
    buffer = make_buffer(gl, 36);
    gl->EnableVertexAttribArray(0);
    gl->VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, NULL);
    gl->DeleteBuffers(1, &buffer);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_to_nothing(const noh_gl_api *gl)
{
    GLuint framebuffer = 0;
    use_program(gl);
    bind_vertices(gl);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_what_is_read(const noh_gl_api *gl)
{
    use_program(gl);
    bind_vertices(gl);
    target_texture(gl);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

static void uniform_without_program(const noh_gl_api *gl)
{
    gl->Uniform1i(0, 1);
}

static void use_unlinked(const noh_gl_api *gl)
{
    gl->UseProgram(gl->CreateProgram());
}

static void buffer_past_its_end(const noh_gl_api *gl)
{
    make_buffer(gl, 16);
    gl->BufferSubData(GL_ARRAY_BUFFER, 8, 9, "123456789");
}

static void buffer_unbound(const noh_gl_api *gl)
{
    gl->BufferSubData(GL_ARRAY_BUFFER, 0, 1, "1");
}

static void texture_past_its_edge(const noh_gl_api *gl)
{
    make_texture(gl);
    gl->TexSubImage2D(GL_TEXTURE_2D, 1, 0, 0, 4, 3, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
}

static void texture_stored_twice(const noh_gl_api *gl)
{
    make_texture(gl);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 8, 4);
}

static void delete_twice(const noh_gl_api *gl)
{
    GLuint name = make_buffer(gl, 4);
    gl->DeleteBuffers(1, &name);
    gl->DeleteBuffers(1, &name);
}

static void bind_deleted(const noh_gl_api *gl)
{
    GLuint name = make_texture(gl);
    gl->DeleteTextures(1, &name);
    gl->BindTexture(GL_TEXTURE_2D, name);
}

static void bind_invented(const noh_gl_api *gl)
{
    gl->BindFramebuffer(GL_FRAMEBUFFER, 77);
}

static void pop_without_push(const noh_gl_api *gl)
{
    gl->PopDebugGroup();
}

static void label_before_bind(const noh_gl_api *gl)
{
    GLuint name = 0;
    gl->GenTextures(1, &name);
    gl->ObjectLabel(GL_TEXTURE, name, -1, "early");
}

static void each_lie_is_found(void **state)
{
    static const struct {
        lie tell;
        const char *says; /* NULL: nothing is wrong */
    } lies[] = {
        { draw_right, NULL },
        { draw_without_program, "glDrawArrays: no program in use" },
        { draw_with_deleted_program, "glDrawArrays: program 1 was deleted" },
        { draw_without_vertex_array, "glDrawArrays: no vertex array is bound" },
        { draw_past_the_vertices, "glDrawArrays: attribute 0 reads past its buffer of 36 bytes" },
        { draw_past_the_instances, "glDrawArraysInstanced: attribute 0 reads past its buffer of 36 bytes" },
        { draw_without_indices, "glDrawElements: buffer 0 was never created" },
        { draw_past_the_indices, "glDrawElements: indices up to byte 8 of 6" },
        { draw_from_deleted_buffer, "glDrawArrays: buffer 1 was deleted" },
        { draw_to_nothing, "glDrawArrays: the framebuffer is not complete" },
        { draw_what_is_read, "glDrawArrays: texture 1 is drawn to and bound to unit 0" },
        { uniform_without_program, "glUniform1i: no program in use" },
        { use_unlinked, "glUseProgram: the program is not linked" },
        { buffer_past_its_end, "glBufferSubData: bytes 8 to 17 of a buffer of 16" },
        { buffer_unbound, "glBufferSubData: no buffer is bound" },
        { texture_past_its_edge, "glTexSubImage2D: outside the texture" },
        { texture_stored_twice, "glTexStorage2D: the texture already has storage" },
        { delete_twice, "glDeleteBuffers: buffer 1 was deleted" },
        { bind_deleted, "glBindTexture: texture 1 was deleted" },
        { bind_invented, "glBindFramebuffer: framebuffer 77 was never created" },
        { pop_without_push, "glPopDebugGroup: no group is open" },
        { label_before_bind, "glObjectLabel: texture 1 is not bound yet" },
    };
    const noh_platform *null = noh_platform_find("null");
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(lies); i++) {
        noh_platform_context *context = NULL;
        noh_null_report report;
        noh_gl_api gl;
        assert_int_equal(null->create(NULL, &context, NULL, 0), NOH_OK);
        assert_int_equal(noh_gl_api_load(&gl, null->get_proc, context, NULL), NOH_OK);
        lies[i].tell(&gl);
        noh_null_report_of(context, &report);
        assert_string_equal(report.first, lies[i].says ? lies[i].says : "");
        assert_int_equal(gl.GetError(), lies[i].says ? GL_INVALID_OPERATION : GL_NO_ERROR);
        assert_int_equal(gl.GetError(), GL_NO_ERROR);
        null->destroy(context);
    }
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_probe_calls_in_order),
        cmocka_unit_test(every_path_keeps_the_order),
        cmocka_unit_test(levels_keep_the_order),
        cmocka_unit_test(each_lie_is_found),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
