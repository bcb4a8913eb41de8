/* wrinkle_creases.h: a normal map of the creases that compression makes.
 *
 * Creases run along the direction of the larger stretch and repeat across it. A band-pass filter turned to that
 * direction at every texel, applied to noise over and over, lets stripes of that direction and distance grow together,
 * as they do in synthetic fingerprints (Cappelli, Maio, Maltoni: Synthetic fingerprint-image generation, ICPR 2000);
 * their profile is a narrow valley between broad ridges, as deep as the surface that is to be hidden in it asks for;
 * of mild compression, which skin takes up, a part is shown. */
#ifndef NOH_CONVERT_WRINKLE_WRINKLE_CREASES_H
#define NOH_CONVERT_WRINKLE_WRINKLE_CREASES_H

#include "wrinkle_raster.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The map, [height][width][4], tangent space: rgb 128 + 127 * xyz, the mesh's tangent along x and cross(normal,
 * tangent) times its sign along y; flat where nothing is compressed. To be freed; NULL: out of memory. spacing  the
 * distance from crease to crease, model units */
uint8_t *wrinkle_creases_make(const wrinkle_field *field, const wrinkle_raster *raster, double spacing);

/* A distance between creases for a mesh: a share of the diagonal of what its targets move. */
double wrinkle_spacing(const wrinkle_field *field);

#ifdef __cplusplus
}
#endif
#endif
