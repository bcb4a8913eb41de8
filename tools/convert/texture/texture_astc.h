/* texture_astc.h: levels of a texture as ASTC blocks, by the program astcenc (Debian's package of that name).
 *
 *   texture_astc_find     whether it can be run
 *   texture_astc_encode   a level to blocks
 *   texture_astc_decode   and back
 *
 * Pictures go to the program and back in files of a temporary folder ($TMPDIR, or /tmp). The bytes of a pack are the
 * same wherever the version of the program and the kind of processor are. */
#ifndef NOH_CONVERT_TEXTURE_TEXTURE_ASTC_H
#define NOH_CONVERT_TEXTURE_TEXTURE_ASTC_H

#include "convert/base/byte_buffer.h"
#include "convert/base/error.h"
#include "convert/texture/texture_blocks.h"

/* 0, or 1 and the error: which package to install. */
int texture_astc_find(model_error *error);

/* format: NOH_TEXTURE_ASTC_*. Of normal maps, x and y alone. 0, or 1: out of memory, or the program failed. */
int texture_astc_encode(const texture_image *level, uint32_t format, byte_buffer *out);

/* rgba[height][width][4]. 0, or 1: out of memory, or the program failed. */
int texture_astc_decode(const texture_image *level, uint32_t format, const uint8_t *blocks, uint8_t *rgba);

#endif
