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
#include "core/pack/pack_internal.h"
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

static noh_gl_texture_desc picture_desc(const noh_texture *texture, int etc2, uint32_t first)
{
    const noh_texture_header *h = texture->header;
    const noh_texture_level level = noh_texture_level_at(texture, first);
    const noh_gl_texture_desc desc = { .format = is_taken(h, etc2) ? blocks_format(h) : texels_format(h),
                                       .width = level.width,
                                       .height = level.height,
                                       .levels = h->level_count - first,
                                       .filter = h->nearest ? GL_NEAREST : GL_LINEAR };
    return desc;
}

uint64_t noh_gl_picture_bytes_from(const noh_texture *texture, int etc2, uint32_t first)
{
    NOH_ASSERT(texture && texture->header);
    noh_gl_texture_desc desc = picture_desc(texture, etc2, first);
    return noh_gl_texture_bytes(&desc);
}

uint64_t noh_gl_picture_bytes(const noh_texture *texture, int etc2)
{
    return noh_gl_picture_bytes_from(texture, etc2, 0);
}

static GLint wrap_of(uint32_t wrap)
{
    return wrap == NOH_WRAP_CLAMP ? GL_CLAMP_TO_EDGE : wrap == NOH_WRAP_MIRROR ? GL_MIRRORED_REPEAT : GL_REPEAT;
}

/* ---- pieces ---- */

static uint32_t unit_side(uint32_t format)
{
    return format == NOH_TEXTURE_RGBA8 ? 1u : noh_texture_block_side(format);
}

static uint32_t unit_bytes(uint32_t format)
{
    return format == NOH_TEXTURE_RGBA8 ? 4u : noh_texture_block_bytes(format);
}

/* A piece of a level in units: texels, or blocks. */
typedef struct piece {
    uint32_t x, y, columns, rows;
    uint32_t side, across; /* texels of a unit's side; units of a row of the level */
    uint32_t bytes;        /* of a unit in the pack */
} piece;

/* Blocks of one row as texels, 16 at a time. The last column and row may extend beyond the level's edges. */
static void send_strips(const noh_gl_api *api, uint32_t format, GLint index, const noh_texture_level *level, piece of,
                        uint32_t y)
{
    uint32_t texels[4u * STRIP_BLOCKS * 4u];
    const int halves = format == NOH_TEXTURE_EAC_RG;
    for (uint32_t x = of.x; x < of.x + of.columns; x += STRIP_BLOCKS) {
        const uint32_t left = of.x + of.columns - x, count = left < STRIP_BLOCKS ? left : STRIP_BLOCKS;
        const uint32_t width = level->width - 4u * x, height = level->height - 4u * y;
        api->decode(format, level->pixels + ((size_t)y * of.across + x) * of.bytes, count, (uint8_t *)texels);
        api->PixelStorei(GL_UNPACK_ROW_LENGTH, (GLint)(4u * count));
        api->TexSubImage2D(GL_TEXTURE_2D, index, (GLint)(4u * x), (GLint)(4u * y),
                           (GLsizei)(width < 4u * count ? width : 4u * count), (GLsizei)(height < 4u ? height : 4u),
                           halves ? GL_RG : GL_RGBA, halves ? GL_HALF_FLOAT : GL_UNSIGNED_BYTE, texels);
    }
    api->PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

static GLsizei texels_of(uint32_t first, uint32_t count, uint32_t side, uint32_t end)
{
    const uint32_t left = end - first * side;
    return (GLsizei)(left < count * side ? left : count * side);
}

static void send_piece(const noh_gl_api *api, const noh_texture *texture, uint32_t index,
                       const noh_texture_level *level, piece of)
{
    const uint32_t format = texture->header->format;
    const GLint x = (GLint)(of.x * of.side), y = (GLint)(of.y * of.side);
    const GLsizei width = texels_of(of.x, of.columns, of.side, level->width);
    const GLsizei height = texels_of(of.y, of.rows, of.side, level->height);
    const uint8_t *pixels = level->pixels + ((size_t)of.y * of.across + of.x) * of.bytes;
    if (format == NOH_TEXTURE_RGBA8) {
        api->TexSubImage2D(GL_TEXTURE_2D, (GLint)index, x, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    } else if (is_taken(texture->header, api->etc2)) {
        api->CompressedTexSubImage2D(GL_TEXTURE_2D, (GLint)index, x, y, width, height, blocks_format(texture->header),
                                     (GLsizei)(of.columns * of.rows * of.bytes), pixels);
    } else {
        for (uint32_t row = of.y; row < of.y + of.rows; row++) send_strips(api, format, (GLint)index, level, of, row);
    }
}

/* The next piece from unit `from` of a level on, within `bytes`: whole rows, or a part of one. Returns the bytes that it
 * sends; 0: not even a unit fits. */
static uint32_t next_piece(const noh_texture *texture, int etc2, const noh_texture_level *level, uint32_t from,
                           uint32_t bytes, piece *of)
{
    const noh_texture_header *h = texture->header;
    const uint32_t side = unit_side(h->format);
    const uint32_t down = (level->height + side - 1u) / side;
    const uint32_t sent = h->format && !is_taken(h, etc2) ? 64u : unit_bytes(h->format);
    of->side = side;
    of->across = (level->width + side - 1u) / side;
    of->bytes = unit_bytes(h->format);
    of->x = from % of->across;
    of->y = from / of->across;
    of->columns = of->across - of->x;
    of->rows = 1;
    if (of->columns > bytes / sent) of->columns = bytes / sent;
    if (of->columns == of->across) {
        const uint32_t fit = bytes / sent / of->across;
        of->rows = down - of->y < fit ? down - of->y : fit;
    }
    return of->columns * of->rows * sent;
}

int noh_gl_picture_fill(const noh_gl_api *api, const noh_texture *texture, uint32_t first,
                        const noh_gl_texture *picture, uint32_t *at, uint32_t *bytes)
{
    uint32_t begin = 0; /* units of the levels before */
    noh_gl_pixels kept;
    int done = 1;
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, picture->name);
    noh_gl_unpack_begin(api, &kept);
    for (uint32_t i = first; i < texture->header->level_count && done; i++) {
        const noh_texture_level level = noh_texture_level_at(texture, i);
        const uint32_t side = unit_side(texture->header->format);
        const uint32_t units = (level.width + side - 1u) / side * ((level.height + side - 1u) / side);
        while (*at < begin + units) {
            piece of;
            const uint32_t sent = next_piece(texture, api->etc2, &level, *at - begin, *bytes, &of);
            if (!sent) break;
            send_piece(api, texture, i - first, &level, of);
            *at += of.columns * of.rows;
            *bytes -= sent;
        }
        begin += units;
        done = *at >= begin;
    }
    noh_gl_unpack_end(api, &kept);
    api->BindTexture(GL_TEXTURE_2D, 0);
    return done;
}

noh_result noh_gl_picture_check(const noh_texture *texture, int astc, noh_error *error)
{
    if (astc || texture->header->format < NOH_TEXTURE_ASTC_4X4) return NOH_OK;
    return noh_fail(error, NOH_ERR_UNSUPPORTED,
                    "the pack has ASTC textures, which the context does not support: build it with --textures etc2", 0,
                    0);
}

noh_result noh_gl_picture_create_empty(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                       uint32_t first, noh_gl_texture *out, noh_error *error)
{
    noh_gl_texture picture;
    noh_result result;
    NOH_ASSERT(api && ledger && texture && texture->header && out);
    result = noh_gl_picture_check(texture, api->astc, error);
    if (result) return result;
    if (texture->header->format && !is_taken(texture->header, api->etc2) && !api->decode) {
        return noh_fail(error, NOH_ERR_UNSUPPORTED,
                        "the context does not support ETC2: set noh_gl_api.decode to noh_etc2_decode", 0, 0);
    }
    noh_gl_texture_desc desc = picture_desc(texture, api->etc2, first);
    result = noh_gl_texture_create(api, ledger, &desc, &picture, error);
    if (result) {
        return result;
    }
    api->BindTexture(GL_TEXTURE_2D, picture.name);
    noh_gl_label(api, GL_TEXTURE, picture.name, "texture", texture->name);
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_of(texture->header->wrap_s));
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_of(texture->header->wrap_t));
    api->BindTexture(GL_TEXTURE_2D, 0);
    picture.premultiplied = (texture->header->format == NOH_TEXTURE_ETC2_RGBA1) & 1u;
    *out = picture;
    return NOH_OK;
}

noh_result noh_gl_picture_create_from(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                      uint32_t first, noh_gl_texture *out, noh_error *error)
{
    noh_gl_texture picture;
    uint32_t at = 0, bytes = UINT32_MAX;
    noh_result result = noh_gl_picture_create_empty(api, ledger, texture, first, &picture, error);
    if (result) return result;
    while (!noh_gl_picture_fill(api, texture, first, &picture, &at, &bytes)) bytes = UINT32_MAX;
    result = noh_gl_error_check(api, "the driver refused the pixels of a texture", picture.bytes, error);
    if (result) {
        noh_gl_texture_delete(api, ledger, &picture);
        return result;
    }
    *out = picture;
    return NOH_OK;
}

noh_result noh_gl_picture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                 noh_gl_texture *out, noh_error *error)
{
    return noh_gl_picture_create_from(api, ledger, texture, 0, out, error);
}

noh_result noh_gl_picture_restore(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                  noh_gl_texture *picture, noh_error *error)
{
    NOH_ASSERT(texture && texture->header && picture);
    noh_gl_texture_delete(noh_gl_lost_api(), ledger, picture);
    return noh_gl_picture_create(api, ledger, texture, picture, error);
}
