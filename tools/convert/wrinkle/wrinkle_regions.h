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

/* How much each region covers each vertex, 0..1: [vertex_count], to be freed. NULL: out of memory. */
region_weights *wrinkle_regions_make(const wrinkle_field *field);

/* The matrix for regions that cover vertices: [target_count][REGION_COUNT], 255 for the target that compresses a region
 * most, to be freed. NULL: out of memory. */
uint8_t *wrinkle_matrix_make(const wrinkle_field *field, region_weights *regions);

/* The same for a mask: the triangle of each texel counts as much as the mask says. */
uint8_t *wrinkle_matrix_of_mask(const wrinkle_field *field, const wrinkle_raster *raster, uint8_t *const *maps);

/* The three weight maps of regions that cover vertices, [size][size][4] each, as region_maps_make orders them; outside
 * the triangles as inside their border. Returns 0, or 1: out of memory, and all three are NULL. */
int wrinkle_maps_make(const wrinkle_field *field, region_weights *regions, const wrinkle_raster *raster,
                      uint8_t *maps[REGION_MAP_COUNT]);

#ifdef __cplusplus
}
#endif
#endif
