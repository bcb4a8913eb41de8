/* zoom_target.c: pictures of a zoom, read back with their coverage in alpha. */
#include <math.h>
#include <string.h>

#include "zoom.h"
#include "gpu/canvas.h"
#include "cli/message.h"

#define MARGIN 8.0 /* pixels around the scene */

static GLuint renderbuffer(const zoom_target *t, GLenum format, uint32_t samples)
{
    const noh_gl_api *gl = &t->g->gl;
    GLuint name = 0;
    gl->GenRenderbuffers(1, &name);
    gl->BindRenderbuffer(GL_RENDERBUFFER, name);
    gl->RenderbufferStorageMultisample(GL_RENDERBUFFER, (GLsizei)samples, format, (GLsizei)t->side, (GLsizei)t->side);
    return name;
}

int zoom_target_open(zoom_target *t, gpu *g, uint32_t side, uint32_t samples)
{
    const noh_gl_api *gl = &g->gl;
    GLenum status;
    memset(t, 0, sizeof *t);
    t->g = g;
    t->side = t->size = side;
    gl->GenFramebuffers(1, &t->framebuffer);
    gl->GenFramebuffers(1, &t->resolved_framebuffer);
    t->color = renderbuffer(t, GL_SRGB8_ALPHA8, samples < g->caps.samples_max ? samples : g->caps.samples_max);
    t->depth = renderbuffer(t, GL_DEPTH_COMPONENT24, samples < g->caps.samples_max ? samples : g->caps.samples_max);
    t->resolved_color = renderbuffer(t, GL_SRGB8_ALPHA8, 0);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->resolved_framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, t->resolved_color);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, t->color);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, t->depth);
    status = gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->BindRenderbuffer(GL_RENDERBUFFER, 0);
    return status == GL_FRAMEBUFFER_COMPLETE
               ? 0
               : tool_fail("zoom", "the driver cannot create a target of %ux%u pixels", side, side);
}

void zoom_target_close(zoom_target *t)
{
    if (t->g) {
        const GLuint buffers[3] = { t->color, t->depth, t->resolved_color },
                     framebuffers[2] = { t->framebuffer, t->resolved_framebuffer };
        t->g->gl.DeleteFramebuffers(2, framebuffers);
        t->g->gl.DeleteRenderbuffers(3, buffers);
    }
    memset(t, 0, sizeof *t);
}

void zoom_target_frame(zoom_target *t, double share)
{
    const double half = fmin(t->side / 2.0, ceil(share * t->side / 2.0) + MARGIN);
    t->size = 2u * (uint32_t)half;
}

/* Resolves; leaves framebuffer 0 bound. */
static int read_back(const zoom_target *t, zoom_picture *out)
{
    const noh_gl_api *gl = &t->g->gl;
    const GLint low = (GLint)((t->side - t->size) / 2u), high = low + (GLint)t->size;
    GLenum error;
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, t->framebuffer);
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, t->resolved_framebuffer);
    gl->BlitFramebuffer(low, low, high, high, low, low, high, high, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->resolved_framebuffer);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(low, low, (GLsizei)t->size, (GLsizei)t->size, GL_RGBA, GL_UNSIGNED_BYTE, out->rgba);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    out->size = t->size;
    error = gl->GetError();
    return error ? tool_fail("zoom", "GL error 0x%x while drawing", error) : 0;
}

int zoom_target_draw(zoom_target *t, const figure *f, uint32_t view, noh_stage_shader *shader, zoom_picture *out)
{
    static const float background[4] = { CANVAS_BACKGROUND_LINEAR, 0.0f }, far = 1.0f;
    const noh_gl_api *gl = &t->g->gl;
    const GLint low = (GLint)((t->side - t->size) / 2u);
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_result result;
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    gl->Viewport(0, 0, (GLsizei)t->side, (GLsizei)t->side); /* all of it: fades dither by pixel coordinates */
    gl->Enable(GL_SCISSOR_TEST);
    gl->Scissor(low, low, (GLsizei)t->size, (GLsizei)t->size);
    if (!t->g->caps.is_es) {
        gl->Enable(DESKTOP_FRAMEBUFFER_SRGB);
    }
    gl->DepthMask(GL_TRUE);
    gl->ClearBufferfv(GL_COLOR, 0, background);
    gl->ClearBufferfv(GL_DEPTH, 0, &far);
    result = noh_stage_draw(f->stage, NOH_PASS_COLOR, view, shader, &error);
    gl->Disable(GL_SCISSOR_TEST);
    return result ? tool_fail_error(f->desc.file->path, &error) : read_back(t, out);
}
