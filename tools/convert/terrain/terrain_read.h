/* terrain_read.h: a height field out of a picture or a model, for packs and for the ground that a figure stands on. */
#ifndef NOH_CONVERT_TERRAIN_TERRAIN_READ_H
#define NOH_CONVERT_TERRAIN_TERRAIN_READ_H

#include <stdint.h>

#include "convert/base/error.h"
#include "noh/body.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct terrain_options {
    double size_m;   /* along X; 0: of a picture a metre between pixels, of a model as it is */
    double height_m; /* of a picture, from black to white; 0: a tenth of the size */
    uint32_t points; /* along the longer side of a model; 0: 257 */
} terrain_options;

/* Heights as noh_field has them. A picture lies about the origin, black at y = 0; a model where it is. */
typedef struct terrain {
    uint32_t width, depth;
    float origin[3], spacing, scale;
    uint16_t *heights;   /* [depth][width] */
    float low, high;     /* metres, of all heights */
    uint32_t hole_count; /* heights at which a model has no surface: they are its lowest */
} terrain;

/* Read a .png (8 or 16 bits; of a coloured one the luminance counts) or a .glb or .gltf file.
 * returns  0, or 1 and *error: it cannot be read, has no area, or more than NOH_TERRAIN_SIZE_MAX heights along a side
 */
int terrain_read(const char *path, const terrain_options *options, terrain *out, model_error *error);
void terrain_free(terrain *t);

/* The library's view of it. */
noh_field terrain_field(const terrain *t);

#ifdef __cplusplus
}
#endif
#endif
