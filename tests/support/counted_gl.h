/* counted_gl.h: the null driver, with the bytes of buffers and textures that are sent to it. */
#ifndef COUNTED_GL_H
#define COUNTED_GL_H

#include "support/gl_fixture.h"

#include <string.h>

static struct {
    noh_gl_api real;
    uint64_t bytes;
} counted;

static void GL_APIENTRY count_buffer(GLenum target, GLintptr at, GLsizeiptr bytes, const void *data)
{
    counted.bytes += (uint64_t)bytes;
    counted.real.BufferSubData(target, at, bytes, data);
}

static uint64_t counted_texel(GLenum format, GLenum type)
{
    if (format == GL_RED_INTEGER || format == GL_RG || type == GL_UNSIGNED_BYTE) return 4;
    return format == GL_RGB_INTEGER ? 12 : 16;
}

static void GL_APIENTRY count_texels(GLenum target, GLint level, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format,
                                     GLenum type, const void *data)
{
    counted.bytes += (uint64_t)w * (uint64_t)h * counted_texel(format, type);
    counted.real.TexSubImage2D(target, level, x, y, w, h, format, type, data);
}

static void GL_APIENTRY count_blocks(GLenum target, GLint level, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format,
                                     GLsizei bytes, const void *data)
{
    counted.bytes += (uint64_t)bytes;
    counted.real.CompressedTexSubImage2D(target, level, x, y, w, h, format, bytes, data);
}

static void counted_open(gpu *g)
{
    memset(g, 0, sizeof *g);
    assert_int_equal(gpu_open(g, "null"), 0);
    g->caps.blend_f32 = g->caps.blend_f32_exact = g->caps.mrt3 = g->caps.render_f32 = 1;
    counted.real = g->gl;
    counted.bytes = 0;
    g->gl.BufferSubData = count_buffer;
    g->gl.TexSubImage2D = count_texels;
    g->gl.CompressedTexSubImage2D = count_blocks;
}

/* The paths that the null driver can be asked for. */
static const fixture_way counted_ways[] = { { NOH_MORPH_MRT, NOH_ACCUMULATE_F32 },
                                            { NOH_MORPH_GATHER, NOH_ACCUMULATE_F32 },
                                            { NOH_MORPH_PER_LAYER, NOH_ACCUMULATE_F32 },
                                            { NOH_MORPH_CPU, NOH_ACCUMULATE_F32 },
                                            { NOH_MORPH_DIRECT, NOH_ACCUMULATE_F32 } };

#endif
