/* etc2.h: the blocks of compressed textures, decoded as a GPU decodes them.
 *
 *   noh_etc2_decode   a row of blocks to texels
 *   noh_eac_decode    one channel of a block
 *
 * For contexts without ETC2 (desktop GL below 4.3, WebGL 2 on most desktops), for renderers on the CPU, and for rays
 * (pick.h), which ask for alpha. A program without any of these does not link them.
 *
 * Threads: no state; any thread. */
#ifndef NOH_PACK_ETC2_H
#define NOH_PACK_ETC2_H

#include "core/pack/format.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decode blocks that lie side by side.
 * shapes  blocks[count], of 8 or 16 bytes by the format; texels[4][4 * count][4]: RGBA8, exactly what OpenGL ES 3.0
 *         demands. Of NOH_TEXTURE_EAC_RG a texel is two halves in place of four bytes: red and green within 2^-12 of
 *         their 11 bits
 * ranges  format is NOH_TEXTURE_ETC2_RGB, _ETC2_RGBA, _ETC2_RGBA1 or _EAC_RG; any bytes are blocks
 * source  OpenGL ES 3.0.6, appendix C.1 */
void noh_etc2_decode(uint32_t format, const uint8_t *blocks, uint32_t count, uint8_t *texels);

/* Decode 8 bytes of EAC: values[4][4], rows top to bottom, of 0..255, or with eleven 0..2047. */
void noh_eac_decode(const uint8_t block[8], int eleven, uint16_t values[16]);

#ifdef __cplusplus
}
#endif

#endif
