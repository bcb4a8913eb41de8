#include "canvas.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "gl/device/gl_api_internal.h"

#define SAMPLES 4

static GLuint renderbuffer(const noh_gl_api *gl, GLenum format, GLsizei samples, uint32_t width, uint32_t height)
{
    GLuint name = 0;
    gl->GenRenderbuffers(1, &name);
    gl->BindRenderbuffer(GL_RENDERBUFFER, name);
    gl->RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, (GLsizei)width, (GLsizei)height);
    return name;
}

static GLuint picture(const noh_gl_api *gl, uint32_t width, uint32_t height)
{
    GLuint name = 0;
    gl->GenTextures(1, &name);
    gl->BindTexture(GL_TEXTURE_2D, name);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_SRGB8_ALPHA8, (GLsizei)width, (GLsizei)height);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    return name;
}

int canvas_open(canvas *c, gpu *g, uint32_t width, uint32_t height)
{
    const noh_gl_api *gl = &g->gl;
    GLsizei samples = g->caps.samples_max < SAMPLES ? (GLsizei)g->caps.samples_max : SAMPLES;
    if (samples < 2) samples = 0; /* drivers give one sample as four */
    GLenum status;
    memset(c, 0, sizeof *c);
    c->g = g;
    c->width = width;
    c->height = height;
    noh_gl_error_take(gl);
    gl->GenFramebuffers(1, &c->framebuffer);
    gl->GenFramebuffers(1, &c->resolved_framebuffer);
    c->color = renderbuffer(gl, GL_SRGB8_ALPHA8, samples, width, height);
    c->depth = renderbuffer(gl, GL_DEPTH_COMPONENT24, samples, width, height);
    c->resolved = picture(gl, width, height);
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->resolved_framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, c->resolved, 0);
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, c->color);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, c->depth);
    status = gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    gl->BindRenderbuffer(GL_RENDERBUFFER, 0);
    if (noh_gl_error_take(gl) != GL_NO_ERROR || status != GL_FRAMEBUFFER_COMPLETE) {
        canvas_close(c);
        return tool_fail("canvas", "the driver cannot create a target of %ux%u pixels", width, height);
    }
    return 0;
}

void canvas_close(canvas *c)
{
    const noh_gl_api *gl = &c->g->gl;
    const GLuint buffers[2] = { c->color, c->depth }, framebuffers[2] = { c->framebuffer, c->resolved_framebuffer };
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->DeleteFramebuffers(2, framebuffers);
    gl->DeleteRenderbuffers(2, buffers);
    gl->DeleteTextures(1, &c->resolved);
}

void canvas_begin(canvas *c)
{
    static const float background[4] = { CANVAS_BACKGROUND_LINEAR, 1.0f };
    static const float far = 1.0f;
    const noh_gl_api *gl = &c->g->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->framebuffer);
    gl->Viewport(0, 0, (GLsizei)c->width, (GLsizei)c->height);
    if (!c->g->caps.is_es) {
        gl->Enable(DESKTOP_FRAMEBUFFER_SRGB);
    }
    gl->DepthMask(GL_TRUE);
    gl->ClearBufferfv(GL_COLOR, 0, background);
    gl->ClearBufferfv(GL_DEPTH, 0, &far);
}

void canvas_clear_depth(const canvas *c)
{
    static const float far = 1.0f;
    c->g->gl.ClearBufferfv(GL_DEPTH, 0, &far);
}

void canvas_resolve(canvas *c)
{
    const noh_gl_api *gl = &c->g->gl;
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, c->framebuffer);
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, c->resolved_framebuffer);
    gl->BlitFramebuffer(0, 0, (GLint)c->width, (GLint)c->height, 0, 0, (GLint)c->width, (GLint)c->height,
                        GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
}

int picture_from_gl(uint8_t *rgba, uint32_t width, uint32_t height)
{
    const size_t row = (size_t)width * 4;
    uint8_t *swap = malloc(row);
    if (!swap) {
        return tool_fail("canvas", "out of memory");
    }
    for (uint32_t y = 0; y < height / 2; y++) {
        uint8_t *top = rgba + y * row, *bottom = rgba + (height - 1 - y) * row;
        memcpy(swap, top, row);
        memcpy(top, bottom, row);
        memcpy(bottom, swap, row);
    }
    free(swap);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        rgba[4 * i + 3] = 255;
    }
    return 0;
}

int canvas_read(canvas *c, uint8_t *rgba)
{
    const noh_gl_api *gl = &c->g->gl;
    GLenum error;
    canvas_resolve(c);
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->resolved_framebuffer);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(0, 0, (GLsizei)c->width, (GLsizei)c->height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    error = gl->GetError();
    return error ? tool_fail("canvas", "GL error 0x%x while drawing", error)
                 : picture_from_gl(rgba, c->width, c->height);
}
