/* gl_picture.c: a pack's textures as GL objects.
 *
 * Blocks go from the pack to the GPU unchanged. For a context without ETC2 and EAC, noh_gl_api.decode decodes a strip of
 * blocks at a time to texels, in stack memory; ASTC is not decoded. */
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/pack.h"

#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/draw/gl_draw_internal.h"

#define STRIP_BLOCKS 16u

static GLenum blocks_format(const noh_texture_header *h)
{
    static const GLenum astc[2][4] = { { GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4, GL_COMPRESSED_SRGB8_ALPHA8_ASTC_5x5,
                                         GL_COMPRESSED_SRGB8_ALPHA8_ASTC_6x6, GL_COMPRESSED_SRGB8_ALPHA8_ASTC_8x8 },
                                       { GL_COMPRESSED_RGBA_ASTC_4x4, GL_COMPRESSED_RGBA_ASTC_5x5,
                                         GL_COMPRESSED_RGBA_ASTC_6x6, GL_COMPRESSED_RGBA_ASTC_8x8 } };
    const int is_data = (h->flags & NOH_TEXTURE_LINEAR) != 0;
    if (h->format >= NOH_TEXTURE_ASTC_4X4) return astc[is_data][h->format - NOH_TEXTURE_ASTC_4X4];
    switch (h->format) {
    case NOH_TEXTURE_ETC2_RGB: return is_data ? GL_COMPRESSED_RGB8_ETC2 : GL_COMPRESSED_SRGB8_ETC2;
    case NOH_TEXTURE_ETC2_RGBA: return is_data ? GL_COMPRESSED_RGBA8_ETC2_EAC : GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC;
    case NOH_TEXTURE_ETC2_RGBA1:
        return is_data ? GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2 : GL_COMPRESSED_SRGB8_PUNCHTHROUGH_ALPHA1_ETC2;
    default: return GL_COMPRESSED_RG11_EAC;
    }
}

static GLenum texels_format(const noh_texture_header *h)
{
    if (h->format == NOH_TEXTURE_EAC_RG) return GL_RG16F;
    return h->flags & NOH_TEXTURE_LINEAR ? GL_RGBA8 : GL_SRGB8_ALPHA8;
}

/* Whether the GPU takes the bytes of a pack as they are. */
static int is_taken(const noh_texture_header *h, int etc2)
{
    return h->format && (etc2 || h->format >= NOH_TEXTURE_ASTC_4X4);
}

static noh_gl_texture_desc picture_desc(const noh_texture *texture, int etc2)
{
    const noh_texture_header *h = texture->header;
    const noh_gl_texture_desc desc = { .format = is_taken(h, etc2) ? blocks_format(h) : texels_format(h),
                                       .width = h->width,
                                       .height = h->height,
                                       .levels = h->level_count,
                                       .filter = h->nearest ? GL_NEAREST : GL_LINEAR };
    return desc;
}

uint64_t noh_gl_picture_bytes(const noh_texture *texture, int etc2)
{
    NOH_ASSERT(texture && texture->header);
    noh_gl_texture_desc desc = picture_desc(texture, etc2);
    return noh_gl_texture_bytes(&desc);
}

static GLint wrap_of(uint32_t wrap)
{
    return wrap == NOH_WRAP_CLAMP ? GL_CLAMP_TO_EDGE : wrap == NOH_WRAP_MIRROR ? GL_MIRRORED_REPEAT : GL_REPEAT;
}

/* A strip of up to 16 blocks of a level, as texels. The last column and row may extend beyond the level's edges. */
static void send_strip(const noh_gl_api *api, uint32_t format, GLint index, const noh_texture_level *level, uint32_t x,
                       uint32_t y)
{
    uint32_t texels[4u * STRIP_BLOCKS * 4u];
    const uint32_t columns = (level->width + 3u) / 4u, left = columns - x;
    const uint32_t count = left < STRIP_BLOCKS ? left : STRIP_BLOCKS;
    const uint32_t width = level->width - 4u * x, height = level->height - 4u * y;
    const uint32_t block = noh_texture_block_bytes(format);
    const int halves = format == NOH_TEXTURE_EAC_RG;
    api->decode(format, level->pixels + ((size_t)y * columns + x) * block, count, (uint8_t *)texels);
    api->PixelStorei(GL_UNPACK_ROW_LENGTH, (GLint)(4u * count));
    api->TexSubImage2D(GL_TEXTURE_2D, index, (GLint)(4u * x), (GLint)(4u * y),
                       (GLsizei)(width < 4u * count ? width : 4u * count), (GLsizei)(height < 4u ? height : 4u),
                       halves ? GL_RG : GL_RGBA, halves ? GL_HALF_FLOAT : GL_UNSIGNED_BYTE, texels);
}

static void send_decoded(const noh_gl_api *api, uint32_t format, GLint index, const noh_texture_level *level)
{
    for (uint32_t y = 0; 4u * y < level->height; y++) {
        for (uint32_t x = 0; 4u * x < level->width; x += STRIP_BLOCKS) send_strip(api, format, index, level, x, y);
    }
    api->PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

static void send_level(const noh_gl_api *api, const noh_texture *texture, uint32_t index)
{
    const noh_texture_level level = noh_texture_level_at(texture, index);
    const GLsizei width = (GLsizei)level.width, height = (GLsizei)level.height;
    if (texture->header->format == NOH_TEXTURE_RGBA8) {
        api->TexSubImage2D(GL_TEXTURE_2D, (GLint)index, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, level.pixels);
    } else if (is_taken(texture->header, api->etc2)) {
        api->CompressedTexSubImage2D(GL_TEXTURE_2D, (GLint)index, 0, 0, width, height, blocks_format(texture->header),
                                     (GLsizei)level.bytes, level.pixels);
    } else {
        send_decoded(api, texture->header->format, (GLint)index, &level);
    }
}

noh_result noh_gl_picture_check(const noh_texture *texture, int astc, noh_error *error)
{
    if (astc || texture->header->format < NOH_TEXTURE_ASTC_4X4) return NOH_OK;
    return noh_fail(error, NOH_ERR_UNSUPPORTED,
                    "the pack has ASTC textures, which the context does not support: build it with --textures etc2", 0,
                    0);
}

noh_result noh_gl_picture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                 noh_gl_texture *out, noh_error *error)
{
    noh_gl_texture picture;
    noh_gl_pixels kept;
    noh_result result;
    NOH_ASSERT(api && ledger && texture && texture->header && out);
    result = noh_gl_picture_check(texture, api->astc, error);
    if (result) return result;
    if (texture->header->format && !is_taken(texture->header, api->etc2) && !api->decode) {
        return noh_fail(error, NOH_ERR_UNSUPPORTED,
                        "the context does not support ETC2: set noh_gl_api.decode to noh_etc2_decode", 0, 0);
    }
    noh_gl_texture_desc desc = picture_desc(texture, api->etc2);
    result = noh_gl_texture_create(api, ledger, &desc, &picture, error);
    if (result) {
        return result;
    }
    api->BindTexture(GL_TEXTURE_2D, picture.name);
    noh_gl_label(api, GL_TEXTURE, picture.name, "texture", texture->name);
    noh_gl_unpack_begin(api, &kept);
    for (uint32_t i = 0; i < desc.levels; i++) send_level(api, texture, i);
    noh_gl_unpack_end(api, &kept);
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_of(texture->header->wrap_s));
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_of(texture->header->wrap_t));
    api->BindTexture(GL_TEXTURE_2D, 0);
    result = noh_gl_error_check(api, "the driver refused the pixels of a texture", picture.bytes, error);
    if (result) {
        noh_gl_texture_delete(api, ledger, &picture);
        return result;
    }
    picture.premultiplied = (texture->header->format == NOH_TEXTURE_ETC2_RGBA1) & 1u;
    *out = picture;
    return NOH_OK;
}

noh_result noh_gl_picture_restore(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                  noh_gl_texture *picture, noh_error *error)
{
    NOH_ASSERT(texture && texture->header && picture);
    noh_gl_texture_delete(noh_gl_lost_api(), ledger, picture);
    return noh_gl_picture_create(api, ledger, texture, picture, error);
}
