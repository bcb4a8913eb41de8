/* target.h: a render target for examples without a window: a framebuffer with colour, or with a depth texture for
 * shadows; saved as PNG. It is not part of the library. */
#ifndef NOH_EXAMPLES_TARGET_H
#define NOH_EXAMPLES_TARGET_H

#include <stdio.h>
#include <stdlib.h>

#include <GLES3/gl32.h>

#include "noh/gl_device.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

typedef struct target {
    GLuint framebuffer, depth; /* depth: a texture for a sampler2DShadow */
    GLsizei width, height;
} target;

static void target_make(const noh_gl_api *gl, GLsizei width, GLsizei height, int shadow, target *t)
{
    GLuint color;
    t->width = width;
    t->height = height;
    gl->GenFramebuffers(1, &t->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    gl->GenTextures(1, &t->depth);
    gl->BindTexture(GL_TEXTURE_2D, t->depth);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT24, width, height);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, t->depth, 0);
    if (!shadow) {
        gl->GenRenderbuffers(1, &color);
        gl->BindRenderbuffer(GL_RENDERBUFFER, color);
        gl->RenderbufferStorage(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, width, height);
        gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    }
}

static void target_clear(const noh_gl_api *gl, const target *t)
{
    static const GLfloat grey[4] = { 0.16f, 0.17f, 0.2f, 1.0f }, far_away = 1.0f;
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    gl->Viewport(0, 0, t->width, t->height);
    gl->ClearBufferfv(GL_COLOR, 0, grey);
    gl->ClearBufferfv(GL_DEPTH, 0, &far_away);
}

/* 0 on success. */
static int target_save(const noh_gl_api *gl, const target *t, const char *path)
{
    unsigned char *pixels = malloc((size_t)t->width * (size_t)t->height * 4u);
    int written = 0;
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    if (pixels) {
        gl->ReadPixels(0, 0, t->width, t->height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
        stbi_flip_vertically_on_write(1);
        written = stbi_write_png(path, t->width, t->height, 4, pixels, 0);
    }
    free(pixels);
    return !written;
}

#endif
