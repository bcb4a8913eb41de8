/* bench_stage.c: where the methods draw: one 512 x 512 target, one camera, one fragment shader. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "shaders.gen.h"
#include "tool_shaders.gen.h"
#include "cli/message.h"

/* ---- the stage ---- */

static noh_result create_targets(bench_stage *s, noh_error *error)
{
    gpu *g = s->g;
    noh_gl_texture_desc color = { GL_SRGB8_ALPHA8, BENCH_FRAME_SIZE, BENCH_FRAME_SIZE, 0, 0, 0, 0 };
    noh_gl_texture_desc white = { GL_RGBA8, 1, 1, 0, 0, 0, 0 };
    static const uint8_t texel[4] = { 255, 255, 255, 255 };
    noh_result result = noh_gl_texture_create(&g->gl, &g->ledger, &color, &s->color, error);
    if (!result) {
        result = noh_gl_texture_create(&g->gl, &g->ledger, &white, &s->white, error);
    }
    if (!result) {
        g->gl.BindTexture(GL_TEXTURE_2D, s->white.name);
        g->gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel);
        g->gl.BindTexture(GL_TEXTURE_2D, 0);
        result = noh_gl_renderbuffer_create(&g->gl, &g->ledger, GL_DEPTH_COMPONENT24, BENCH_FRAME_SIZE,
                                            BENCH_FRAME_SIZE, 0, &s->depth, error);
    }
    return result ? result : noh_gl_framebuffer_create(&g->gl, &g->ledger, &s->framebuffer, error);
}

static noh_result attach_targets(bench_stage *s, noh_error *error)
{
    const noh_gl_api *gl = &s->g->gl;
    GLenum status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, s->color.name, 0);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, s->depth.name);
    status = gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    return status == GL_FRAMEBUFFER_COMPLETE ? NOH_OK
                                             : noh_fail(error, NOH_ERR_GL, "the driver refuses the frame", status, 0);
}

int bench_stage_open(bench_stage *s, gpu *g, const noh_mesh *mesh)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    memset(s, 0, sizeof *s);
    s->g = g;
    s->mesh = mesh;
    if (create_targets(s, &error) || attach_targets(s, &error) ||
        noh_gl_mesh_create(&g->gl, &g->ledger, mesh, &s->gl_mesh, &error)) {
        bench_stage_close(s);
        return tool_fail_error("bench", &error);
    }
    return 0;
}

void bench_stage_close(bench_stage *s)
{
    gpu *g = s->g;
    noh_gl_mesh_delete(&g->gl, &g->ledger, &s->gl_mesh);
    noh_gl_framebuffer_delete(&g->gl, &g->ledger, &s->framebuffer);
    noh_gl_renderbuffer_delete(&g->gl, &g->ledger, &s->depth);
    noh_gl_texture_delete(&g->gl, &g->ledger, &s->color);
    noh_gl_texture_delete(&g->gl, &g->ledger, &s->white);
}

/* ---- programs ---- */

static float largest(const float v[3])
{
    float m = v[0] > v[1] ? v[0] : v[1];
    return m > v[2] ? m : v[2];
}

/* Parallel light rays need no perspective, and neither does a bench: the mesh fills the frame. */
static void set_constants(const bench_stage *s, GLuint program)
{
    static const float rows[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    const noh_gl_api *gl = &s->g->gl;
    const noh_mesh_header *h = s->mesh->header;
    float size[3], view[16] = { 0 }, scale;
    for (int i = 0; i < 3; i++) {
        size[i] = h->bounds_max[i] - h->bounds_min[i];
    }
    scale = largest(size) > 0.0f ? 1.9f / largest(size) : 1.0f;
    for (int i = 0; i < 3; i++) {
        float sign = i == 2 ? -0.5f : 1.0f; /* towards +z lies nearer; half the depth for what targets move */
        view[5 * i] = sign * scale;
        view[12 + i] = -sign * scale * 0.5f * (h->bounds_max[i] + h->bounds_min[i]);
    }
    view[15] = 1.0f;
    gl->UseProgram(program);
    gl->UniformMatrix4fv(gl->GetUniformLocation(program, "u_view_projection"), 1, GL_FALSE, view);
    gl->Uniform4fv(gl->GetUniformLocation(program, "u_world"), 3, rows);
    gl->Uniform4fv(gl->GetUniformLocation(program, "u_normal"), 3, rows);
    gl->Uniform4f(gl->GetUniformLocation(program, "u_uv"), h->uv_offset[0], h->uv_offset[1], h->uv_scale[0],
                  h->uv_scale[1]);
    gl->Uniform3f(gl->GetUniformLocation(program, "noh_camera"), 0.0f, 0.0f, 4.0f / scale);
    gl->Uniform3f(gl->GetUniformLocation(program, "noh_key"), 0.48f, 0.6f, 0.64f);
    gl->Uniform4f(gl->GetUniformLocation(program, "noh_base_color"), 0.8f, 0.7f, 0.6f, 1.0f);
    gl->Uniform4f(gl->GetUniformLocation(program, "noh_material"), 0.6f, 0.0f, -1.0f, 0.0f);
    gl->Uniform1i(gl->GetUniformLocation(program, "noh_base_color_texture"), 2);
    gl->UseProgram(0);
}

#define LIT_PIECES 8u
typedef struct lit_source {
    noh_gl_source source;
    char *prefix; /* to be freed */
    const char *pieces[LIT_PIECES];
} lit_source;

/* The library's fragment shader of a lit mesh, with all that goes before it. */
static int lit_source_make(lit_source *lit)
{
    const noh_gl_variant_key plain = { 0 };
    const noh_gl_source *own = &noh_shader_mesh_frag;
    const size_t bytes = noh_gl_shader_prefix(plain, GL_FRAGMENT_SHADER, NULL, 0);
    lit->prefix = malloc(bytes);
    if (!lit->prefix || own->piece_count >= LIT_PIECES) {
        return tool_fail("bench", "out of memory");
    }
    noh_gl_shader_prefix(plain, GL_FRAGMENT_SHADER, lit->prefix, bytes);
    lit->pieces[0] = lit->prefix;
    memcpy(lit->pieces + 1, own->pieces, own->piece_count * sizeof *own->pieces);
    lit->source = (noh_gl_source){ own->version, lit->pieces, own->piece_count + 1u };
    return 0;
}

static int create_program(bench_stage *s, bench_method *m, const char *defines, bench_pass pass)
{
    static const char *const varyings[] = { "v_model", "v_normal" };
    const char *names[NOH_UNIT_USER];
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    lit_source lit = { 0 };
    int status = lit_source_make(&lit);
    memset(&desc, 0, sizeof desc);
    for (uint32_t i = 0; i < NOH_UNIT_USER; i++) names[i] = "";
    names[NOH_UNIT_LAYERS] = strstr(defines, "BENCH_DENSE")      ? "u_targets"
                             : strstr(defines, "BENCH_FILAMENT") ? "u_positions"
                             : strstr(defines, "BENCH_QUADS")    ? "u_sums"
                             : strstr(defines, "NOH_DIRECT")     ? "noh_deltas"
                                                                 : "noh_layers";
    names[1] = "u_frames";
    names[NOH_UNIT_LISTS] = "noh_lists";
    names[NOH_UNIT_LISTS + 1u] = "noh_starts";
    desc.name = m->name;
    desc.vertex = &noh_shader_bench_mesh_vert;
    desc.fragment = pass == BENCH_COLOR ? &lit.source : &noh_shader_bench_depth_frag;
    desc.defines = defines;
    desc.samplers = names;
    desc.sampler_count = NOH_UNIT_USER;
    desc.varyings = varyings;
    desc.varying_count = pass == BENCH_CHECK ? 2 : 0;
    if (!status && noh_gl_program_create(&s->g->gl, &desc, &m->programs[pass], log, sizeof log, &error)) {
        fputs(log, stderr);
        status = tool_fail_error(m->name, &error);
    }
    free(lit.prefix);
    if (!status) {
        set_constants(s, m->programs[pass]);
    }
    return status;
}

int bench_programs(bench_stage *s, bench_method *m, const char *defines)
{
    int status = 0;
    for (int pass = 0; pass < BENCH_PASS_COUNT && !status; pass++) {
        status = create_program(s, m, defines, (bench_pass)pass);
    }
    return status;
}

void bench_method_close(bench_stage *s, bench_method *m)
{
    for (int pass = 0; pass < BENCH_PASS_COUNT; pass++) {
        noh_gl_program_delete(&s->g->gl, NULL, &m->programs[pass]);
    }
    if (m->close) {
        m->close(m->self);
    }
    memset(m, 0, sizeof *m);
}

/* ---- drawing ---- */

static void draw_pass(const bench_stage *s, const bench_method *m, bench_pass pass)
{
    const noh_gl_api *gl = &s->g->gl;
    const int finished = m->binding && m->binding->vertex_buffer;
    gl->UseProgram(m->programs[pass]);
    if (m->bind) {
        m->bind(m->self, pass);
    }
    if (finished) noh_gl_mesh_bind(gl, m->mesh, m->binding);
    gl->DrawElements(GL_TRIANGLES, (GLsizei)m->mesh->mesh.header->index_count, m->mesh->index_type, NULL);
    if (finished) {
        noh_gl_mesh_unbind(gl, m->mesh, m->binding);
        gl->BindVertexArray(m->mesh->vertex_array);
    }
}

static void begin(const bench_stage *s, const bench_method *m)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->framebuffer);
    gl->Viewport(0, 0, BENCH_FRAME_SIZE, BENCH_FRAME_SIZE);
    gl->Enable(GL_DEPTH_TEST);
    gl->Enable(GL_CULL_FACE);
    gl->ActiveTexture(GL_TEXTURE2);
    gl->BindTexture(GL_TEXTURE_2D, s->white.name);
    gl->VertexAttribI4i(NOH_ATTRIBUTE_TANGENT, 0, 0, 0, 1);
    gl->VertexAttrib4f(NOH_ATTRIBUTE_UV, 0.0f, 0.0f, 0.0f, 1.0f);
    gl->VertexAttrib4f(NOH_ATTRIBUTE_COLOR, 1.0f, 1.0f, 1.0f, 1.0f);
    gl->BindVertexArray(m->mesh->vertex_array);
}

static void end(const bench_stage *s)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
}

void bench_draw_discarded(bench_stage *s, const bench_method *m, int three_passes)
{
    const noh_gl_api *gl = &s->g->gl;
    begin(s, m);
    gl->Enable(GL_RASTERIZER_DISCARD);
    if (three_passes) {
        draw_pass(s, m, BENCH_DEPTH); /* shadow */
        draw_pass(s, m, BENCH_DEPTH);
    }
    draw_pass(s, m, BENCH_COLOR);
    gl->Disable(GL_RASTERIZER_DISCARD);
    end(s);
}

void bench_draw_frame(bench_stage *s, const bench_method *m)
{
    const noh_gl_api *gl = &s->g->gl;
    begin(s, m);
    gl->ClearColor(0.1f, 0.1f, 0.1f, 1.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw_pass(s, m, BENCH_COLOR);
    end(s);
}
