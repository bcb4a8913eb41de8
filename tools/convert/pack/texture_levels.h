/* texture_levels.h: a texture's mip levels, made when a pack is built.
 *
 *   texture_levels_write   append them to a buffer, as a texture chunk has them
 *
 * Each level's texel is the mean of the area that it covers, whatever the sides: of linear light for colours (weighted
 * by alpha where alpha counts), of the bytes for data, of the vectors, made unit again, for normal maps. Where a
 * material cuts by alpha, each level's alphas are scaled so that as large a part of it stays as of the first (Castano,
 * "Computing Alpha Mipmaps", 2010). All sums are of integers: every machine makes the same bytes. */
#ifndef NOH_CONVERT_PACK_TEXTURE_LEVELS_H
#define NOH_CONVERT_PACK_TEXTURE_LEVELS_H

#include "convert/base/byte_buffer.h"
#include "convert/model/model.h"
#include "noh/format.h"

/* Append the levels of a texture, as blocks where from->blocks asks for them and they fit: not with `nearest`, nor with
 * a side below 4, nor up to 64 x 64 below 38 dB. Normal maps are ETC2_RGB from 40 dB on, else EAC_RG; textures
 * whose alpha is only a cutoff are ETC2_RGBA1 from 38 dB on, also of the alphas, else ETC2_RGBA. With
 * MODEL_BLOCKS_ASTC, normal maps have the largest blocks up to 6 x 6 that keep 40 dB, other textures without a material
 * that cuts or blends by their alpha the largest up to 8 x 8 that keep 38 dB, else 4 x 4. The first level is no larger
 * than from->size_max or NOH_TEXTURE_SIZE_MAX, and has what is kept of it alone. Sets the header's width, height,
 * format, error, level_count, trim and whole sides, by header->nearest. Returns 0, or 1: out of memory, or astcenc
 * failed. */
int texture_levels_write(const model_texture *from, noh_texture_header *header, byte_buffer *out);

#endif
