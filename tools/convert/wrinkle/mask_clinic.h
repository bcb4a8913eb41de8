/* mask_clinic.h: the damage of a painted region mask, and its repair.
 *
 * Codes (region_mask.h) survive neither filtering nor changes of colours, so changes by an editor or a texture
 * compressor are visible: as codes in the guard bands, as thin seams of a wrong region between two others, or as whole
 * areas off the codes of full weight. The causes leave different traces:
 *
 *   smoothing    values that lie strictly between two opposite neighbours of other regions: anti-aliasing, resizing
 *   gamma        codes are illegal and even areas lack full weight, but neither once one common curve is undone
 *   blocks       each aligned square of 4 x 4 texels has what BC1 to BC3 can store of its colours: four at most,
 *                between end points of 5, 6 and 5 bits */
#ifndef NOH_CONVERT_WRINKLE_MASK_CLINIC_H
#define NOH_CONVERT_WRINKLE_MASK_CLINIC_H

#include "convert/wrinkle/region_mask.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MASK_SMOOTHED 1u
#define MASK_GAMMA 2u
#define MASK_BLOCKS 4u

typedef struct mask_region {
    uint32_t texels;                   /* with a weight above 0 */
    uint32_t full;                     /* of those, with weight 1 */
    float mean;                        /* weight of those above 0 */
    uint32_t left, top, right, bottom; /* the smallest box of texels, both ends included; if texels is not 0 */
} mask_region;

typedef struct mask_findings {
    uint32_t damage;            /* MASK_* */
    uint32_t histogram[4][256]; /* texels by channel and code */
    uint32_t guard[4];          /* texels in guard bands */
    uint32_t seams[4];          /* texels strictly between two opposite neighbours of other regions, once the curve is
                                 * undone */
    uint32_t edges[4];          /* texels beside one of another region, likewise */
    uint32_t even[4], even_full[4]; /* texels inside even areas, and how many have full weight */
    const char *gamma;              /* the curve, for MASK_GAMMA; else NULL */
    uint32_t blocks, blocks_stored; /* squares with telling colours, and how many BC1 to BC3 can store */
    mask_region regions[REGION_COUNT];
} mask_findings;

/* Look a mask over. Returns 0, or 1: out of memory. */
int mask_examine(const region_mask *mask, mask_findings *findings);

/* Undo the damage, in place: the curve, then seams, then values left in guard bands. No code of the result is in a
 * guard band. Returns the number of texels changed, or UINT32_MAX: out of memory, nothing changed. */
uint32_t mask_repair(region_mask *mask, const mask_findings *findings);

/* A picture of what was found, rgba[height][width][4] to be freed: guard bands red, seams yellow, all else grey by its
 * largest weight. NULL: out of memory. */
uint8_t *mask_show(const region_mask *mask);

#ifdef __cplusplus
}
#endif
#endif
