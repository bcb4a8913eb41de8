/* texture_blocks.h: levels of a texture as blocks of ETC2, EAC and ASTC, and their errors.
 *
 *   texture_blocks_append   encode a level
 *   texture_blocks_error    the mean square error of a level
 *   texture_quality_db      the same of a texture in a pack, as its peak signal to noise ratio
 *   texture_format_name     "ETC2 RGB" and so on
 *   texture_unit_bytes      a normal map's texel, unit
 *
 * Vectors of normal maps are made unit first: EAC_RG and ASTC keep x and y, from which z follows. */
#ifndef NOH_CONVERT_TEXTURE_TEXTURE_BLOCKS_H
#define NOH_CONVERT_TEXTURE_TEXTURE_BLOCKS_H

#include "convert/base/byte_buffer.h"
#include "convert/model/model.h"
#include "noh/format.h"

/* A level: rgba[height][width][4]. */
typedef struct texture_image {
    const uint8_t *rgba;
    uint32_t width, height;
    int with_alpha;     /* colours do not count where alpha is 0 */
    uint32_t bit_worth; /* squares of bytes, summed over a block, that are given up for a bit less when it is sent */
    uint32_t cutoff; /* with ETC2_RGBA1: texels whose alpha is below are transparent, and their colours do not count */
    model_texture_use use; /* with ASTC: colours are sRGB, normal maps keep x and y */
    int keeps_alpha;       /* with ASTC; otherwise alpha is 1 */
} texture_image;

/* format: any but NOH_TEXTURE_RGBA8. Texels beyond an edge are those at the edge. Returns 0, or 1: out of memory, or
 * astcenc failed. */
int texture_blocks_append(const texture_image *level, uint32_t format, byte_buffer *out);

/* Decoded blocks against the level, in bytes: over red, green, blue where they count, with ETC2_RGBA and _RGBA1 alpha
 * too, and with ASTC where it is kept; of normal maps over x, y and z. 0: nothing was lost. Below 0: out of memory, or
 * astcenc failed. */
float texture_blocks_error(const texture_image *level, uint32_t format, const uint8_t *blocks);

/* Below this a texture is worth a word: errors of three of 255 steps. */
#define TEXTURE_QUALITY_DB 38.0

/* 10 log10(255^2 / error), at most 99: nothing was lost. */
double texture_quality_db(const noh_texture_header *header);

const char *texture_format_name(uint32_t format);

/* The vector of a normal map's texel, unit, as bytes with alpha 255. */
void texture_unit_bytes(const uint8_t texel[4], uint8_t unit[4]);

#endif
