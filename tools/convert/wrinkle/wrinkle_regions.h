/* wrinkle_regions.h: twelve regions out of what targets compress: points that the same targets compress belong
 * together, and how much each of them does is the matrix from expressions to regions. */
#ifndef NOH_CONVERT_WRINKLE_WRINKLE_REGIONS_H
#define NOH_CONVERT_WRINKLE_WRINKLE_REGIONS_H

#include "region_mask.h"
#include "wrinkle_raster.h"
#include "wrinkle_strain.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef float region_weights[REGION_COUNT];

/* The weight maps of a mask: channel c of map k is region 3 * c + k. */
typedef struct region_maps {
    uint32_t width, height;
    uint8_t *map[REGION_MAP_COUNT]; /* [height][width][4] */
} region_maps;

/* How much each region covers each vertex, 0..1: [vertex_count], to be freed. Regions that meet are of different
 * channels as far as that can be. NULL: out of memory. */
region_weights *wrinkle_regions_make(const wrinkle_field *field);

/* The matrix: [target_count][REGION_COUNT], 255 for the target that compresses a region most, to be freed. A target
 * that compresses less than a twentieth of a region by 1 % is not tied to it. NULL: out of memory. */
uint8_t *wrinkle_matrix_make(const wrinkle_field *field, const region_maps *maps);

/* The three weight maps of regions that cover vertices, [size][size][4] each, as region_maps_make orders them; outside
 * the triangles as inside their border. Returns 0, or 1: out of memory, and all three are NULL. */
int wrinkle_maps_make(const wrinkle_field *field, region_weights *regions, const wrinkle_raster *raster,
                      uint8_t *maps[REGION_MAP_COUNT]);

#ifdef __cplusplus
}
#endif
#endif
