/* normal_height.h: a normal map out of a height map. */
#ifndef NOH_CONVERT_NORMAL_NORMAL_HEIGHT_H
#define NOH_CONVERT_NORMAL_NORMAL_HEIGHT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A unit vector as a texel of a normal map: rgb 128 + 127 * xyz, so that 128 is 0; alpha 255. */
void normal_texel(const double v[3], uint8_t rgba[4]);

/* Slopes by Sobel's operator: differences over two texels, of three rows or columns with the middle one twice.
 * height  [height][width] 0 to 65535, the top row first
 * depth   how far 65535 lies above 0, in texels
 * tiles   1: an edge continues at the opposite one; 0: edge values repeat
 * Returns rgba [height][width][4], tangent space, +y up in the picture, to be freed; NULL: out of memory */
uint8_t *normal_map_of_height(const uint16_t *heights, uint32_t width, uint32_t height, double depth, int tiles);

#ifdef __cplusplus
}
#endif
#endif
