#include <stdlib.h>
#include <string.h>

#include "view.h"

#define SAMPLES 4
#define DESKTOP_FRAMEBUFFER_SRGB 0x8DB9 /* desktop GL encodes only when asked to; ES always does */

static GLuint renderbuffer(const noh_gl_api *gl, GLenum format, GLsizei samples, uint32_t width, uint32_t height)
{
    GLuint name = 0;
    gl->GenRenderbuffers(1, &name);
    gl->BindRenderbuffer(GL_RENDERBUFFER, name);
    gl->RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, (GLsizei)width, (GLsizei)height);
    return name;
}

int canvas_open(canvas *c, gpu *g, uint32_t width, uint32_t height)
{
    const noh_gl_api *gl = &g->gl;
    GLsizei samples = g->caps.samples_max < SAMPLES ? (GLsizei)g->caps.samples_max : SAMPLES;
    GLenum status;
    memset(c, 0, sizeof *c);
    c->g = g;
    c->width = width;
    c->height = height;
    gl->GenFramebuffers(1, &c->framebuffer);
    gl->GenFramebuffers(1, &c->resolved_framebuffer);
    c->color = renderbuffer(gl, GL_SRGB8_ALPHA8, samples, width, height);
    c->depth = renderbuffer(gl, GL_DEPTH_COMPONENT24, samples, width, height);
    c->resolved = renderbuffer(gl, GL_SRGB8_ALPHA8, 0, width, height);
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->resolved_framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, c->resolved);
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, c->color);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, c->depth);
    status = gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    gl->BindRenderbuffer(GL_RENDERBUFFER, 0);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        canvas_close(c);
        return tool_fail("canvas", "the driver refuses a target of %ux%u pixels", width, height);
    }
    return 0;
}

void canvas_close(canvas *c)
{
    const noh_gl_api *gl = &c->g->gl;
    const GLuint buffers[3] = { c->color, c->depth, c->resolved }, framebuffers[2] = { c->framebuffer, c->resolved_framebuffer };
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->DeleteFramebuffers(2, framebuffers);
    gl->DeleteRenderbuffers(3, buffers);
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

int canvas_read(canvas *c, uint8_t *rgba)
{
    const noh_gl_api *gl = &c->g->gl;
    size_t row = (size_t)c->width * 4;
    uint8_t *swap = malloc(row);
    GLenum error;
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, c->framebuffer);
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, c->resolved_framebuffer);
    gl->BlitFramebuffer(0, 0, (GLint)c->width, (GLint)c->height, 0, 0, (GLint)c->width, (GLint)c->height, GL_COLOR_BUFFER_BIT,
                        GL_NEAREST);
    gl->BindFramebuffer(GL_FRAMEBUFFER, c->resolved_framebuffer);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(0, 0, (GLsizei)c->width, (GLsizei)c->height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    error = gl->GetError();
    if (!swap) {
        return tool_fail("canvas", "out of memory");
    }
    for (uint32_t y = 0; y < c->height / 2; y++) { /* GL's first row is the bottom one */
        uint8_t *top = rgba + y * row, *bottom = rgba + (c->height - 1 - y) * row;
        memcpy(swap, top, row);
        memcpy(top, bottom, row);
        memcpy(bottom, swap, row);
    }
    free(swap);
    for (size_t i = 0; i < (size_t)c->width * c->height; i++) {
        rgba[4 * i + 3] = 255; /* what blended meshes left in alpha is not the picture's */
    }
    return error ? tool_fail("canvas", "GL error 0x%x while drawing", error) : 0;
}
