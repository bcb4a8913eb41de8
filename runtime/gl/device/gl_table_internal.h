/* gl_table_internal.h (private to gl_morph*.c): a one-dimensional table of texels, folded into a 2-D texture.
 *
 * Texel i lies at (i & (width - 1), i >> width_log2). Core ES 3.0 has no buffer textures, and guarantees textures of
 * 2048 x 2048, so a table may have 2^22 texels.
 *
 * Threads: the context's own thread; noh_gl_table_shape and noh_gl_table_bytes, any. */
#ifndef NOH_GL_GL_TABLE_INTERNAL_H
#define NOH_GL_GL_TABLE_INTERNAL_H

#include "noh/base.h"
#include "noh/gl_device.h"
#include "gl/device/gl_names_internal.h"
#include "noh/low_gl.h"

/* The bytes of one texel of an internal format; 0 for a block format, or one that noh does not use. */
uint32_t noh_gl_texel_bytes(unsigned format);

#define NOH_GL_TABLE_TEXELS_MAX (1u << 22)

typedef struct noh_gl_table {
    noh_gl_texture texture;
    GLenum format, transfer_format, transfer_type; /* RGB32UI, RGB_INTEGER, UNSIGNED_INT */
    uint32_t width_log2, height, texel_bytes;
} noh_gl_table;

/* The shape of a table of `count` texels: the smallest width of 256, 512, 1024 and 2048 that keeps the height within
 * 2048. */
void noh_gl_table_shape(uint32_t count, uint32_t *width_log2, uint32_t *height);

/* The bytes of a table. An empty table takes one row. */
uint64_t noh_gl_table_bytes(GLenum format, uint32_t count);

/* format: GL_RGB32UI, GL_RGBA32UI or GL_R32UI.
 * errors  as noh_gl_texture_create */
noh_result noh_gl_table_create(const noh_gl_api *api, noh_gl_ledger *ledger, GLenum format, uint32_t count,
                               noh_gl_table *out, noh_error *error);

/* Fill texels first..first+count-1 from tightly packed data. Leaves the texture bound at unit 0. */
void noh_gl_table_upload(const noh_gl_api *api, const noh_gl_table *table, uint32_t first, uint32_t count,
                         const void *data);

/* The same, between noh_gl_unpack_begin and _end, with unit 0 active. */
void noh_gl_table_put(const noh_gl_api *api, const noh_gl_table *table, uint32_t first, uint32_t count,
                      const void *data);

#endif
