/* gl_table.c: tables of texels in 2-D textures (gl_table_internal.h). */
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_table_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"

#define WIDTH_LOG2_MIN 8u
#define WIDTH_LOG2_MAX 11u
#define HEIGHT_MAX 2048u

/* A small mesh needs only 256 columns, which waste at most a row; a wider table is needed only if the height would
 * exceed 2048. */
void noh_gl_table_shape(uint32_t count, uint32_t *width_log2, uint32_t *height)
{
    NOH_ASSERT(width_log2 && height && count <= NOH_GL_TABLE_TEXELS_MAX);
    uint32_t log2 = WIDTH_LOG2_MIN;
    while (log2 < WIDTH_LOG2_MAX && (count >> log2) >= HEIGHT_MAX) {
        log2++;
    }
    *width_log2 = log2;
    *height = (count + (1u << log2) - 1u) >> log2;
    if (*height == 0) {
        *height = 1;
    }
}

static noh_gl_texture_desc table_desc(GLenum format, uint32_t count, uint32_t *width_log2, uint32_t *height)
{
    noh_gl_texture_desc desc = { 0, 0, 0, 0, 0, 0, 0 };
    noh_gl_table_shape(count, width_log2, height);
    desc.format = format;
    desc.width = 1u << *width_log2;
    desc.height = *height;
    return desc;
}

uint64_t noh_gl_table_bytes(GLenum format, uint32_t count)
{
    uint32_t width_log2, height;
    noh_gl_texture_desc desc = table_desc(format, count, &width_log2, &height);
    return noh_gl_texture_bytes(&desc);
}

noh_result noh_gl_table_create(const noh_gl_api *api, noh_gl_ledger *ledger, GLenum format, uint32_t count,
                               noh_gl_table *out, noh_error *error)
{
    NOH_ASSERT(format == GL_R32UI || format == GL_RGB32UI || format == GL_RGBA32UI);
    noh_gl_table table;
    noh_gl_texture_desc desc = table_desc(format, count, &table.width_log2, &table.height);
    noh_result result = noh_gl_texture_create(api, ledger, &desc, &table.texture, error);
    if (result) {
        return result;
    }
    table.format = format;
    table.transfer_format = format == GL_R32UI     ? GL_RED_INTEGER
                            : format == GL_RGB32UI ? GL_RGB_INTEGER
                                                   : GL_RGBA_INTEGER;
    table.transfer_type = GL_UNSIGNED_INT;
    table.texel_bytes = noh_gl_texel_bytes(format);
    *out = table;
    return NOH_OK;
}

static void upload_block(const noh_gl_api *api, const noh_gl_table *t, uint32_t x, uint32_t y, uint32_t w, uint32_t h,
                         const uint8_t *data)
{
    if (w && h) {
        api->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)x, (GLint)y, (GLsizei)w, (GLsizei)h, t->transfer_format,
                           t->transfer_type, data);
    }
}

/* Texels first to first + count - 1 form at most three rectangles: the rest of one row, whole rows, and the start of a
 * last row. */
void noh_gl_table_put(const noh_gl_api *api, const noh_gl_table *table, uint32_t first, uint32_t count,
                      const void *data)
{
    NOH_ASSERT(table->texture.name && (data || !count));
    NOH_ASSERT((uint64_t)first + count <= (uint64_t)table->height << table->width_log2);
    uint32_t width = 1u << table->width_log2, x = first & (width - 1u), y = first >> table->width_log2;
    uint32_t head = x ? (count < width - x ? count : width - x) : 0; /* the rest of the first row */
    uint32_t rows = (count - head) >> table->width_log2;
    const uint8_t *bytes = (const uint8_t *)data;
    api->BindTexture(GL_TEXTURE_2D, table->texture.name);
    upload_block(api, table, x, y, head, 1, bytes);
    bytes += (size_t)head * table->texel_bytes;
    y += head ? 1u : 0u;
    upload_block(api, table, 0, y, width, rows, bytes);
    bytes += ((size_t)rows << table->width_log2) * table->texel_bytes;
    upload_block(api, table, 0, y + rows, count - head - (rows << table->width_log2), 1, bytes);
}

void noh_gl_table_upload(const noh_gl_api *api, const noh_gl_table *table, uint32_t first, uint32_t count,
                         const void *data)
{
    noh_gl_pixels kept;
    api->ActiveTexture(GL_TEXTURE0);
    noh_gl_unpack_begin(api, &kept);
    noh_gl_table_put(api, table, first, count, data);
    noh_gl_unpack_end(api, &kept);
}
