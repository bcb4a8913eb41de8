/* etc2.h: decode the blocks of compressed textures exactly like a GPU.
 *
 *   noh_etc2_decode   a row of blocks to texels
 *   noh_eac_decode    one channel of a block
 *
 * For contexts without ETC2 (desktop GL below 4.3, WebGL 2 on most desktops), renderers on the CPU, and rays (pick.h),
 * which read alpha. A program that uses none of these does not link the decoders.
 *
 * Threads: no state; any thread. */
#ifndef NOH_PACK_ETC2_H
#define NOH_PACK_ETC2_H

#include "core/pack/format.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decode a row of blocks.
 * shapes  blocks[count], of 8 or 16 bytes by the format; texels[4][4 * count][4]: RGBA8, exactly as OpenGL ES 3.0
 *         specifies. With NOH_TEXTURE_EAC_RG a texel is two halves instead of four bytes: red and green within 2^-12 of
 *         their 11 bits
 * ranges  format is NOH_TEXTURE_ETC2_RGB, _ETC2_RGBA, _ETC2_RGBA1 or _EAC_RG; any bytes are valid blocks
 * source  OpenGL ES 3.0.6, appendix C.1 */
void noh_etc2_decode(uint32_t format, const uint8_t *blocks, uint32_t count, uint8_t *texels);

/* Decode an 8-byte EAC block to values[4][4], rows top to bottom: 0..255, or 0..2047 with eleven. */
void noh_eac_decode(const uint8_t block[8], int eleven, uint16_t values[16]);

#ifdef __cplusplus
}
#endif

#endif
