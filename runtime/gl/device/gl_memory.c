/* gl_memory.c: GL objects and their bytes.
 *
 * The bytes of a texture are the texels of all mip levels, each level half as wide and high as the previous one,
 * rounded down but at least 1 (OpenGL ES 3.0, 3.8.10), times layers and bytes per texel; for a compressed texture,
 * blocks in place of texels. The bytes of a renderbuffer include its samples. */
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_table_internal.h"
#include "gl/device/gl_memory_internal.h"

#define SIDE_MAX 65536u

typedef struct texel_size {
    GLenum format;
    uint32_t bytes;
} texel_size;

/* clang-format off */
static const texel_size texel_sizes[] = {
    {GL_R8, 1}, {GL_R8_SNORM, 1}, {GL_R8UI, 1}, {GL_R8I, 1},
    {GL_RG8, 2}, {GL_RG8_SNORM, 2}, {GL_RG8UI, 2}, {GL_RG8I, 2},
    {GL_R16F, 2}, {GL_R16UI, 2}, {GL_R16I, 2}, {GL_RGB565, 2}, {GL_RGBA4, 2}, {GL_RGB5_A1, 2},
    {GL_RGB8, 3}, {GL_SRGB8, 3},
    {GL_RGBA8, 4}, {GL_SRGB8_ALPHA8, 4}, {GL_RGBA8_SNORM, 4}, {GL_RGBA8UI, 4}, {GL_RGBA8I, 4},
    {GL_RGB10_A2, 4}, {GL_RGB10_A2UI, 4}, {GL_R11F_G11F_B10F, 4}, {GL_RGB9_E5, 4},
    {GL_RG16F, 4}, {GL_RG16UI, 4}, {GL_RG16I, 4}, {GL_R32F, 4}, {GL_R32UI, 4}, {GL_R32I, 4},
    {GL_RGBA16F, 8}, {GL_RGBA16UI, 8}, {GL_RGBA16I, 8}, {GL_RG32F, 8}, {GL_RG32UI, 8}, {GL_RG32I, 8},
    {GL_RGBA32F, 16}, {GL_RGBA32UI, 16}, {GL_RGBA32I, 16},
    {GL_RGB16F, 6}, {GL_RGB32F, 12}, {GL_RGB32UI, 12}, /* sampled only */
    {GL_DEPTH_COMPONENT16, 2}, {GL_DEPTH_COMPONENT24, 4}, {GL_DEPTH_COMPONENT32F, 4},
    {GL_DEPTH24_STENCIL8, 4}, {GL_DEPTH32F_STENCIL8, 8}, {GL_STENCIL_INDEX8, 1}
};
/* clang-format on */

/* The bytes of a block and its side in texels; 0: a format without blocks. */
static uint32_t block_bytes(GLenum format, uint32_t *side)
{
    *side = 4;
    switch (format) {
    case GL_COMPRESSED_RGB8_ETC2:
    case GL_COMPRESSED_SRGB8_ETC2:
    case GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2:
    case GL_COMPRESSED_SRGB8_PUNCHTHROUGH_ALPHA1_ETC2: return 8;
    case GL_COMPRESSED_RGBA8_ETC2_EAC:
    case GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:
    case GL_COMPRESSED_RG11_EAC:
    case GL_COMPRESSED_RGBA_ASTC_4x4:
    case GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4: return 16;
    case GL_COMPRESSED_RGBA_ASTC_5x5:
    case GL_COMPRESSED_SRGB8_ALPHA8_ASTC_5x5: return *side = 5, 16;
    case GL_COMPRESSED_RGBA_ASTC_6x6:
    case GL_COMPRESSED_SRGB8_ALPHA8_ASTC_6x6: return *side = 6, 16;
    case GL_COMPRESSED_RGBA_ASTC_8x8:
    case GL_COMPRESSED_SRGB8_ALPHA8_ASTC_8x8: return *side = 8, 16;
    default: return 0;
    }
}

uint32_t noh_gl_texel_bytes(GLenum format)
{
    for (size_t i = 0; i < sizeof texel_sizes / sizeof *texel_sizes; i++) {
        if (texel_sizes[i].format == format) return texel_sizes[i].bytes;
    }
    return 0;
}

static uint32_t levels_max(uint32_t width, uint32_t height)
{
    uint32_t side = width > height ? width : height;
    uint32_t levels = 0;
    for (; side; side >>= 1) levels++;
    return levels;
}

uint64_t noh_gl_texture_bytes(const noh_gl_texture_desc *desc)
{
    NOH_ASSERT(desc);
    uint32_t side;
    const uint32_t block = block_bytes(desc->format, &side);
    const uint64_t unit = block ? block : noh_gl_texel_bytes(desc->format);
    uint32_t width = desc->width, height = desc->height;
    uint64_t layers = desc->layers == NOH_GL_CUBE ? 6 : desc->layers ? desc->layers : 1;
    uint32_t levels = desc->levels ? desc->levels : 1;
    if (!unit || !width || !height || width > SIDE_MAX || height > SIDE_MAX || layers > SIDE_MAX) return 0;
    if (levels > levels_max(width, height) || (desc->layers == NOH_GL_CUBE && width != height)) return 0;
    uint64_t units = 0;
    for (uint32_t level = 0; level < levels; level++) {
        units += block ? (uint64_t)((width + side - 1u) / side) * ((height + side - 1u) / side)
                       : (uint64_t)width * height;
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    }
    return units * layers * unit;
}

uint64_t noh_gl_renderbuffer_bytes(GLenum format, uint32_t width, uint32_t height, uint32_t samples)
{
    if (width > SIDE_MAX || height > SIDE_MAX || samples > 64) return 0;
    return (uint64_t)width * height * (samples ? samples : 1) * noh_gl_texel_bytes(format);
}

uint64_t noh_gl_ledger_bytes(const noh_gl_ledger *ledger)
{
    NOH_ASSERT(ledger);
    return ledger->buffer_bytes + ledger->texture_bytes + ledger->renderbuffer_bytes;
}

noh_result noh_gl_buffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, GLenum target, uint64_t bytes,
                                const void *data, GLenum usage, noh_gl_buffer *out, noh_error *error)
{
    NOH_ASSERT(api && ledger && out);
    if (bytes == 0) return noh_fail(error, NOH_ERR_ARG, "the size of a buffer is 0", 0, 0);
    if (bytes > (uint64_t)PTRDIFF_MAX)
        return noh_fail(error, NOH_ERR_LIMIT, "a buffer is larger than the address space", (uint64_t)PTRDIFF_MAX,
                        bytes);
    noh_gl_error_take(api);
    GLuint name = 0;
    api->GenBuffers(1, &name);
    api->BindBuffer(target, name);
    api->BufferData(target, (GLsizeiptr)bytes, data, usage);
    api->BindBuffer(target, 0);
    noh_result result = noh_gl_error_check(api, "the driver refused a buffer", bytes, error);
    if (result != NOH_OK) {
        api->DeleteBuffers(1, &name);
        return result;
    }
    ledger->buffers++;
    ledger->buffer_bytes += bytes;
    out->name = name;
    out->bytes = bytes;
    return NOH_OK;
}

void noh_gl_buffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_buffer *buffer)
{
    NOH_ASSERT(api && ledger && buffer);
    if (!buffer->name) return;
    NOH_ASSERT(ledger->buffers > 0 && ledger->buffer_bytes >= buffer->bytes);
    api->DeleteBuffers(1, &buffer->name);
    ledger->buffers--;
    ledger->buffer_bytes -= buffer->bytes;
    buffer->name = 0;
    buffer->bytes = 0;
}

static void set_parameters(const noh_gl_api *api, GLenum target, const noh_gl_texture_desc *desc)
{
    GLenum filter = desc->filter ? desc->filter : GL_NEAREST;
    GLenum wrap = desc->wrap ? desc->wrap : GL_CLAMP_TO_EDGE;
    GLenum minify = filter;
    if (desc->levels > 1) minify = filter == GL_LINEAR ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_NEAREST;
    api->TexParameteri(target, GL_TEXTURE_MIN_FILTER, (GLint)minify);
    api->TexParameteri(target, GL_TEXTURE_MAG_FILTER, (GLint)filter);
    api->TexParameteri(target, GL_TEXTURE_WRAP_S, (GLint)wrap);
    api->TexParameteri(target, GL_TEXTURE_WRAP_T, (GLint)wrap);
}

noh_result noh_gl_texture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_gl_texture_desc *desc,
                                 noh_gl_texture *out, noh_error *error)
{
    NOH_ASSERT(api && ledger && desc && out);
    uint64_t bytes = noh_gl_texture_bytes(desc);
    if (bytes == 0)
        return noh_fail(error, NOH_ERR_ARG, "texture desc: unknown format, size of 0, or too many levels", 0, 0);
    const int array = desc->layers && desc->layers != NOH_GL_CUBE;
    GLenum target = array ? GL_TEXTURE_2D_ARRAY : desc->layers ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D;
    GLsizei width = (GLsizei)desc->width, height = (GLsizei)desc->height;
    GLsizei levels = desc->levels ? (GLsizei)desc->levels : 1;
    noh_gl_error_take(api);
    GLuint name = 0;
    api->ActiveTexture(GL_TEXTURE0);
    api->GenTextures(1, &name);
    api->BindTexture(target, name);
    if (array) {
        api->TexStorage3D(target, levels, desc->format, width, height, (GLsizei)desc->layers);
    } else {
        api->TexStorage2D(target, levels, desc->format, width, height);
    }
    set_parameters(api, target, desc);
    api->BindTexture(target, 0);
    noh_result result = noh_gl_error_check(api, "the driver refused a texture", bytes, error);
    if (result != NOH_OK) {
        api->DeleteTextures(1, &name);
        return result;
    }
    ledger->textures++;
    ledger->texture_bytes += bytes;
    out->name = name;
    out->target = target & 0x7fffffffu;
    out->premultiplied = 0;
    out->bytes = bytes;
    return NOH_OK;
}

void noh_gl_texture_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_texture *texture)
{
    NOH_ASSERT(api && ledger && texture);
    if (!texture->name) return;
    NOH_ASSERT(ledger->textures > 0 && ledger->texture_bytes >= texture->bytes);
    api->DeleteTextures(1, &texture->name);
    ledger->textures--;
    ledger->texture_bytes -= texture->bytes;
    texture->name = 0;
    texture->bytes = 0;
}

noh_result noh_gl_renderbuffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, GLenum format, uint32_t width,
                                      uint32_t height, uint32_t samples, noh_gl_renderbuffer *out, noh_error *error)
{
    NOH_ASSERT(api && ledger && out);
    uint64_t bytes = noh_gl_renderbuffer_bytes(format, width, height, samples);
    if (bytes == 0)
        return noh_fail(error, NOH_ERR_ARG, "renderbuffer: unknown format, size of 0, or too many samples", 0, 0);
    noh_gl_error_take(api);
    GLuint name = 0;
    api->GenRenderbuffers(1, &name);
    api->BindRenderbuffer(GL_RENDERBUFFER, name);
    GLsizei sample_count = samples > 1 ? (GLsizei)samples : 0;
    api->RenderbufferStorageMultisample(GL_RENDERBUFFER, sample_count, format, (GLsizei)width, (GLsizei)height);
    api->BindRenderbuffer(GL_RENDERBUFFER, 0);
    noh_result result = noh_gl_error_check(api, "the driver refused a renderbuffer", bytes, error);
    if (result != NOH_OK) {
        api->DeleteRenderbuffers(1, &name);
        return result;
    }
    ledger->renderbuffers++;
    ledger->renderbuffer_bytes += bytes;
    out->name = name;
    out->bytes = bytes;
    return NOH_OK;
}

void noh_gl_renderbuffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_renderbuffer *renderbuffer)
{
    NOH_ASSERT(api && ledger && renderbuffer);
    if (!renderbuffer->name) return;
    NOH_ASSERT(ledger->renderbuffers > 0 && ledger->renderbuffer_bytes >= renderbuffer->bytes);
    api->DeleteRenderbuffers(1, &renderbuffer->name);
    ledger->renderbuffers--;
    ledger->renderbuffer_bytes -= renderbuffer->bytes;
    renderbuffer->name = 0;
    renderbuffer->bytes = 0;
}

noh_result noh_gl_framebuffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, GLuint *out, noh_error *error)
{
    NOH_ASSERT(api && ledger && out);
    noh_gl_error_take(api);
    GLuint name = 0;
    api->GenFramebuffers(1, &name);
    noh_result result = noh_gl_error_check(api, "the driver refused a framebuffer", 0, error);
    if (result == NOH_OK && !name)
        result = noh_fail(error, NOH_ERR_GL, "the driver returned no name for a framebuffer", 0, 0);
    if (result != NOH_OK) {
        if (name) api->DeleteFramebuffers(1, &name);
        return result;
    }
    ledger->framebuffers++;
    *out = name;
    return NOH_OK;
}

void noh_gl_framebuffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, GLuint *framebuffer)
{
    NOH_ASSERT(api && ledger && framebuffer);
    if (!*framebuffer) return;
    NOH_ASSERT(ledger->framebuffers > 0);
    api->DeleteFramebuffers(1, framebuffer);
    ledger->framebuffers--;
    *framebuffer = 0;
}
