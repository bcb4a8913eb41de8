#include "view/view_screen.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "tool_shaders.gen.h"
#include "cli/message.h"

/* ---- making it ---- */

static int make_program(gpu *g, const noh_gl_source *vertex, const noh_gl_source *fragment, const char *defines,
                        const char *sampler, const char *second, GLuint *program)
{
    const char *samplers[2] = { sampler, second };
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(&desc, 0, sizeof desc);
    desc.name = "view";
    desc.vertex = vertex;
    desc.fragment = fragment;
    desc.defines = defines;
    desc.samplers = samplers;
    desc.sampler_count = second ? 2 : 1;
    if (noh_gl_program_create(&g->gl, &desc, program, log, sizeof log, &error)) {
        fputs(log, stderr);
        return tool_fail_error("view", &error);
    }
    return 0;
}

static int make_programs(view_screen *s)
{
    static const char uint_layers[] = "#define NOH_LAYERS_UINT\n";
    gpu *g = s->g;
    int status = make_program(g, &noh_shader_full_screen_vert, &noh_shader_view_picture_frag, NULL, "u_picture", NULL,
                              &s->picture_program);
    if (!status)
        status = make_program(g, &noh_shader_view_panel_vert, &noh_shader_view_panel_frag, NULL, "u_picture", NULL,
                              &s->panel_program);
    if (!status)
        status = make_program(g, &noh_shader_full_screen_vert, &noh_shader_view_difference_frag, NULL, "u_picture",
                              "u_other", &s->difference_program);
    for (int i = 0; i < 2 && !status; i++) {
        status = make_program(g, &noh_shader_full_screen_vert, &noh_shader_view_layer_frag, i ? uint_layers : NULL,
                              "noh_layers", NULL, &s->layer_programs[i]);
    }
    return status;
}

static void describe_vertices(view_screen *s)
{
    const noh_gl_api *gl = &s->g->gl;
    const GLsizei stride = (GLsizei)sizeof(view_vertex);
    gl->GenVertexArrays(1, &s->empty_array);
    gl->GenVertexArrays(1, &s->panel_array);
    gl->GenBuffers(1, &s->vertex_buffer);
    gl->GenBuffers(1, &s->index_buffer);
    gl->BindVertexArray(s->panel_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, s->vertex_buffer);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, s->index_buffer);
    for (GLuint i = 0; i < 3; i++) {
        gl->EnableVertexAttribArray(i);
    }
    gl->VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, (const void *)offsetof(view_vertex, position));
    gl->VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, (const void *)offsetof(view_vertex, uv));
    gl->VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, (const void *)offsetof(view_vertex, color));
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
}

int view_screen_open(view_screen *s, gpu *g)
{
    int status;
    memset(s, 0, sizeof *s);
    s->g = g;
    status = make_programs(s);
    if (status) {
        view_screen_close(s);
        return status;
    }
    describe_vertices(s);
    return 0;
}

static void delete_layers(view_screen *s)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->DeleteTextures(3, s->layers);
    gl->DeleteFramebuffers(1, &s->layers_framebuffer);
    s->layers_width = s->layers_height = 0;
}

void view_screen_close(view_screen *s)
{
    const noh_gl_api *gl;
    if (!s->g) {
        return;
    }
    gl = &s->g->gl;
    noh_gl_program_delete(gl, NULL, &s->picture_program);
    noh_gl_program_delete(gl, NULL, &s->panel_program);
    noh_gl_program_delete(gl, NULL, &s->difference_program);
    noh_gl_program_delete(gl, NULL, &s->layer_programs[0]);
    noh_gl_program_delete(gl, NULL, &s->layer_programs[1]);
    gl->DeleteVertexArrays(1, &s->empty_array);
    gl->DeleteVertexArrays(1, &s->panel_array);
    gl->DeleteBuffers(1, &s->vertex_buffer);
    gl->DeleteBuffers(1, &s->index_buffer);
    gl->DeleteTextures(1, &s->font);
    delete_layers(s);
    memset(s, 0, sizeof *s);
}

static GLuint make_texture(const noh_gl_api *gl, uint32_t width, uint32_t height, GLint filter)
{
    GLuint name = 0;
    gl->GenTextures(1, &name);
    gl->BindTexture(GL_TEXTURE_2D, name);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, (GLsizei)width, (GLsizei)height);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    return name;
}

void view_screen_font(view_screen *s, uint32_t width, uint32_t height, const uint8_t *rgba)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->DeleteTextures(1, &s->font);
    s->font = make_texture(gl, width, height, GL_LINEAR);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)width, (GLsizei)height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

/* ---- the canvas and the layers ---- */

static void cover(view_screen *s)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->BindVertexArray(s->empty_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
}

void view_screen_begin(view_screen *s)
{
    static const float black[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    const noh_gl_api *gl = &s->g->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!s->g->caps.is_es) {
        gl->Disable(DESKTOP_FRAMEBUFFER_SRGB);
    }
    gl->ClearBufferfv(GL_COLOR, 0, black);
}

void view_screen_picture(view_screen *s, canvas *c, int x, int y)
{
    const noh_gl_api *gl = &s->g->gl;
    canvas_resolve(c);
    gl->Viewport(x, y, (GLsizei)c->width, (GLsizei)c->height);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, c->resolved);
    gl->UseProgram(s->picture_program);
    gl->Uniform2i(gl->GetUniformLocation(s->picture_program, "u_corner"), x, y);
    cover(s);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

void view_screen_difference(view_screen *s, const canvas *a, const canvas *b, float gain, int x, int y)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->Viewport(x, y, (GLsizei)a->width, (GLsizei)a->height);
    gl->ActiveTexture(GL_TEXTURE0 + 1);
    gl->BindTexture(GL_TEXTURE_2D, b->resolved);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, a->resolved);
    gl->UseProgram(s->difference_program);
    gl->Uniform2i(gl->GetUniformLocation(s->difference_program, "u_corner"), x, y);
    gl->Uniform1f(gl->GetUniformLocation(s->difference_program, "u_gain"), gain);
    cover(s);
    gl->ActiveTexture(GL_TEXTURE0 + 1);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

static void make_layers(view_screen *s, uint32_t width, uint32_t height)
{
    const noh_gl_api *gl = &s->g->gl;
    if (width == s->layers_width && height == s->layers_height) {
        return;
    }
    delete_layers(s);
    for (int i = 0; i < 3; i++) {
        s->layers[i] = make_texture(gl, width, height, GL_NEAREST);
    }
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->GenFramebuffers(1, &s->layers_framebuffer);
    s->layers_width = width;
    s->layers_height = height;
}

void view_screen_layers(view_screen *s, const noh_gl_morph_plan *plan, const noh_gl_morph_binding *binding,
                        const float gains[3])
{
    const noh_gl_api *gl = &s->g->gl;
    const GLuint program = s->layer_programs[binding->is_uint ? 1 : 0];
    make_layers(s, plan->atlas_width, plan->atlas_height);
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->layers_framebuffer);
    gl->Viewport(0, 0, (GLsizei)s->layers_width, (GLsizei)s->layers_height);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, binding->texture);
    for (int i = 0; i < 3; i++) {
        gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, s->layers[i], 0);
        gl->UseProgram(program);
        gl->Uniform1i(gl->GetUniformLocation(program, "u_layer"), i);
        gl->Uniform1f(gl->GetUniformLocation(program, "u_gain"), gains[i]);
        cover(s);
    }
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
}

void view_screen_data(view_screen *s, const data_page *page)
{
    const noh_gl_api *gl = &s->g->gl;
    const size_t bytes = 4u * (size_t)page->width * page->height;
    if (!bytes) return;
    make_layers(s, page->width, page->height);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    for (uint32_t i = 0; i < DATA_LAYERS; i++) {
        gl->BindTexture(GL_TEXTURE_2D, s->layers[i]);
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)page->width, (GLsizei)page->height, GL_RGBA,
                          GL_UNSIGNED_BYTE, page->rgba + i * bytes);
    }
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

/* ---- the panels ---- */

void view_triangles_begin(view_screen *s, float width, float height)
{
    const noh_gl_api *gl = &s->g->gl;
    s->scale[0] = (float)s->width / width;
    s->scale[1] = (float)s->height / height;
    gl->Viewport(0, 0, (GLsizei)s->width, (GLsizei)s->height);
    gl->Enable(GL_BLEND);
    gl->BlendEquation(GL_FUNC_ADD);
    gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl->Enable(GL_SCISSOR_TEST);
    gl->UseProgram(s->panel_program);
    gl->Uniform2f(gl->GetUniformLocation(s->panel_program, "u_size"), width, height);
    gl->BindVertexArray(s->panel_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, s->vertex_buffer);
    gl->ActiveTexture(GL_TEXTURE0);
}

void view_triangles_list(view_screen *s, const view_vertex *vertices, size_t vertex_count, const uint16_t *indices,
                         size_t index_count)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(vertex_count * sizeof *vertices), vertices, GL_STREAM_DRAW);
    gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(index_count * sizeof *indices), indices, GL_STREAM_DRAW);
}

void view_triangles_draw(view_screen *s, const float clip[4], GLuint texture, size_t first_index, size_t index_count)
{
    const noh_gl_api *gl = &s->g->gl;
    const int left = (int)(clip[0] * s->scale[0]), right = (int)(clip[2] * s->scale[0]);
    const int top = (int)(clip[1] * s->scale[1]), bottom = (int)(clip[3] * s->scale[1]);
    if (right <= left || bottom <= top) {
        return;
    }
    gl->Scissor(left, (GLint)s->height - bottom, right - left, bottom - top);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    gl->DrawElements(GL_TRIANGLES, (GLsizei)index_count, GL_UNSIGNED_SHORT,
                     (const void *)(first_index * sizeof(uint16_t)));
}

void view_triangles_end(view_screen *s)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->UseProgram(0);
    gl->Disable(GL_SCISSOR_TEST);
    gl->Disable(GL_BLEND);
}

int view_screen_read(view_screen *s, uint8_t *rgba)
{
    const noh_gl_api *gl = &s->g->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(0, 0, (GLsizei)s->width, (GLsizei)s->height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    return picture_from_gl(rgba, s->width, s->height);
}
