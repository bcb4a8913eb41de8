/* wrinkle_raster.h: which triangle lies under each texel of a texture. */
#ifndef NOH_CONVERT_WRINKLE_WRINKLE_RASTER_H
#define NOH_CONVERT_WRINKLE_WRINKLE_RASTER_H

#include "wrinkle_strain.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wrinkle_raster {
    uint32_t width, height;
    uint8_t clamped[2];  /* of the field: whether a side ends where it ends, else its opposite one follows */
    uint32_t *triangle;  /* [height][width] of the field, MODEL_NONE where there is none */
    float (*share)[3];   /* [height][width] barycentric coordinates of the texel's centre */
    uint32_t covered;    /* texels with a triangle */
    uint32_t overlapped; /* of those, inside a second one too */
} wrinkle_raster;

/* Texture coordinates outside 0..1 repeat. Returns 0, or 1: out of memory. Free in both cases. */
int wrinkle_raster_make(const wrinkle_field *field, uint32_t width, uint32_t height, wrinkle_raster *out);
void wrinkle_raster_free(wrinkle_raster *r);

/* The unit vectors of a texel's tangent space, model space: its texture's x and y, and the normal. */
void wrinkle_raster_frame(const wrinkle_raster *r, const wrinkle_field *field, size_t at, double tangent[3],
                          double bitangent[3], double normal[3]);

/* Fill texels without a triangle from their neighbours, `rounds` texels far: filters and mip levels reach over the
 * border of a chart. */
int wrinkle_raster_dilate(const wrinkle_raster *r, uint8_t *rgba, uint32_t rounds);

#ifdef __cplusplus
}
#endif
#endif
