#include "canvas.h"

#include <string.h>

#include "gl/gl_program.h"
#include "web_shaders.gen.h"

void web_canvas_close(web_canvas *c, const noh_gl_api *gl)
{
    noh_gl_framebuffer_delete(gl, c->ledger, &c->framebuffer);
    noh_gl_framebuffer_delete(gl, c->ledger, &c->resolved_framebuffer);
    noh_gl_renderbuffer_delete(gl, c->ledger, &c->color);
    noh_gl_renderbuffer_delete(gl, c->ledger, &c->depth);
    noh_gl_texture_delete(gl, c->ledger, &c->resolved);
    noh_gl_program_delete(gl, c->ledger, &c->program);
    if (c->vertex_array) gl->DeleteVertexArrays(1, &c->vertex_array);
    memset(c, 0, sizeof *c);
}

static noh_result create_program(web_canvas *c, noh_error *error)
{
    static const char *const samplers[] = {"u_picture"};
    noh_gl_program_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.name = "present";
    desc.vertex = &noh_shader_present_vert;
    desc.fragment = &noh_shader_present_frag;
    desc.samplers = samplers;
    desc.sampler_count = 1;
    desc.ledger = c->ledger;
    return noh_gl_program_create(c->gl, &desc, &c->program, NULL, 0, error);
}

static noh_result create_targets(web_canvas *c, uint32_t samples, noh_error *error)
{
    noh_gl_texture_desc resolved = {GL_SRGB8_ALPHA8, c->width, c->height, 0, 0, 0, 0};
    noh_result result = noh_gl_renderbuffer_create(c->gl, c->ledger, GL_SRGB8_ALPHA8, c->width, c->height, samples, &c->color, error);
    if (!result) {
        result = noh_gl_renderbuffer_create(c->gl, c->ledger, GL_DEPTH_COMPONENT24, c->width, c->height, samples, &c->depth, error);
    }
    if (!result) result = noh_gl_texture_create(c->gl, c->ledger, &resolved, &c->resolved, error);
    if (!result) result = noh_gl_framebuffer_create(c->gl, c->ledger, &c->framebuffer, error);
    if (!result) result = noh_gl_framebuffer_create(c->gl, c->ledger, &c->resolved_framebuffer, error);
    return result;
}

static noh_result attach(const web_canvas *c, noh_error *error)
{
    const noh_gl_api *gl = c->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->resolved_framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, c->resolved.name, 0);
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, c->color.name);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, c->depth.name);
    GLenum status = gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    if (status == GL_FRAMEBUFFER_COMPLETE) return NOH_OK;
    return noh_fail(error, NOH_ERR_GL, "the browser refuses the canvas's framebuffer", status, 0);
}

noh_result web_canvas_open(web_canvas *c, const noh_gl_api *gl, noh_gl_ledger *ledger, uint32_t width, uint32_t height,
                           uint32_t samples, noh_error *error)
{
    if (c->gl) web_canvas_close(c, gl);
    c->gl = gl;
    c->ledger = ledger;
    c->width = width;
    c->height = height;
    noh_result result = create_program(c, error);
    if (!result) result = create_targets(c, samples, error);
    if (!result) result = attach(c, error);
    if (!result) gl->GenVertexArrays(1, &c->vertex_array);
    else web_canvas_close(c, gl);
    return result;
}

void web_canvas_begin(const web_canvas *c)
{
    static const float background[4] = {0.075f, 0.078f, 0.085f, 1.0f}, far = 1.0f;
    c->gl->BindFramebuffer(GL_FRAMEBUFFER, c->framebuffer);
    c->gl->Viewport(0, 0, (GLsizei)c->width, (GLsizei)c->height);
    c->gl->DepthMask(GL_TRUE);
    c->gl->ClearBufferfv(GL_COLOR, 0, background);
    c->gl->ClearBufferfv(GL_DEPTH, 0, &far);
}

void web_canvas_show(const web_canvas *c)
{
    const noh_gl_api *gl = c->gl;
    GLint w = (GLint)c->width, h = (GLint)c->height;
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, c->framebuffer);
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, c->resolved_framebuffer);
    gl->BlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->Viewport(0, 0, w, h);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, c->resolved.name);
    gl->UseProgram(c->program);
    gl->BindVertexArray(c->vertex_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}
