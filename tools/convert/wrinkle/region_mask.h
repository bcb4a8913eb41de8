/* region_mask.h: painted masks of twelve wrinkle regions, three in each channel of one RGBA picture.
 *
 * A channel's value 0..255 is a code: value / 90 says which of the channel's three regions a texel belongs to, the
 * remainder how much: 0 none, 72 and up all of it (0.014 a step). A remainder above 75 is a guard band that no painted
 * mask contains. 0 is no region. Region numbers are 3 * channel + value / 90: red 0 to 2, green 3 to 5, blue 6 to 8,
 * alpha 9 to 11. Source: "character wrinkle", computeWeight, with the remainder that its listing lacks.
 *
 * Codes cannot be filtered: half-way between region 0 and region 2 lies region 1. Decoded weights can. */
#ifndef NOH_CONVERT_WRINKLE_REGION_MASK_H
#define NOH_CONVERT_WRINKLE_REGION_MASK_H

#include <stdint.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

#define REGION_COUNT 12u
#define REGION_MAP_COUNT 3u /* weight maps: channel c of map k is region 3 * c + k */
#define REGION_STEP 90u     /* codes from one region to the next */
#define REGION_LAST 75u     /* the largest remainder that is not in a guard band */
#define REGION_FULL 72u     /* the smallest remainder that is the whole weight */

typedef struct region_mask {
    uint32_t width, height;
    uint8_t *rgba; /* [height][width][4] codes, the top row first */
} region_mask;

/* Which of its channel's three regions a code belongs to. */
static inline uint32_t region_of_code(uint8_t code)
{
    return code / REGION_STEP;
}

/* Whether a code is in a guard band, which no mask should contain. */
static inline int region_is_guard(uint8_t code)
{
    return code % REGION_STEP > REGION_LAST;
}

/* The weight of a code, 0..1; 0 in a guard band. */
float region_weight(uint8_t code);

/* The same as a texel of a weight map: the nearest of 256 steps. */
uint8_t region_weight_byte(uint8_t code);

/* The source's combination for one texel: each channel's weight times its region's, the largest of the four.
 * weights: [REGION_COUNT] 0..1. */
float region_texel_weight(const uint8_t rgba[4], const float *weights);

/* Three weight maps out of a mask: each [height][width][4], channel c of map k the weight of region 3 * c + k. They may
 * be filtered and have mip levels. Returns 0, or 1: out of memory, and all three are NULL. */
int region_maps_make(const region_mask *mask, uint8_t *maps[REGION_MAP_COUNT]);

/* The mask of three such maps, [height][width][4] each: the code whose weight is the nearest, of the region of each
 * channel that weighs most. Decoded again it gives the same maps where no two regions of a channel meet, to half a step
 * of 0.014, and a mask of what was decoded gives the same codes except a full weight, which is 75. Returns 0, or 1: out
 * of memory. */
int region_mask_make(uint8_t *const maps[REGION_MAP_COUNT], uint32_t width, uint32_t height, region_mask *mask);

/* The same combination from the maps' texels. */
float region_maps_weight(const uint8_t *const texels[REGION_MAP_COUNT], const float *weights);

/* Read a mask. Its alpha channel is empty where the file has none. A file of 16 bits a channel is refused, because
 * codes do not survive its conversion. Returns 0, or 1 and *error. */
int region_mask_read(const char *path, region_mask *mask, model_error *error);
void region_mask_free(region_mask *mask);

#ifdef __cplusplus
}
#endif
#endif
