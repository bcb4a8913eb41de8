/* wrinkle_folds.h: the folds of a face: lines across the forehead and between the brows, crow's feet, under the eyes,
 * from the nose to the corners of the mouth, and above the chin.
 *
 * Each zone is a part of a disk in the face's coordinates (wrinkle_face.h), and its folds are arcs about the disk's
 * middle or rays from it. They lie where targets compress the zone most across them, a few of them, not closer than
 * skin folds. Zones are regions, so each shows as much as the expressions compress it. After C. Oat: Animated wrinkle
 * maps, SIGGRAPH 2007, whose maps an artist paints. */
#ifndef NOH_CONVERT_WRINKLE_WRINKLE_FOLDS_H
#define NOH_CONVERT_WRINKLE_WRINKLE_FOLDS_H

#include "wrinkle_face.h"
#include "wrinkle_raster.h"
#include "wrinkle_regions.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FOLD_ZONES 9u
#define FOLD_LINES 3u

/* Lengths in units of the face, angles in degrees from x to y. Zones with a side of 0 are on both. */
typedef struct fold_zone {
    uint32_t region;
    int rays;                   /* 1: folds are rays from the middle of the disk, 0: arcs about it */
    double side;                /* of x: -1, 0 or 1 */
    double middle[2];           /* x of the side */
    double radius[2], angle[2]; /* its part of the disk: from, to */
    double rise;                /* 1 or -1: it folds where skin moves up or down; 0: either way */
    double gain;                /* thin skin folds at less compression */
    double gap;                 /* the least between two folds: a length, or degrees for rays */
    double width, depth;        /* of a fold: from its valley to where the skin is even; of its valley */
    int hangs;                  /* 1: of an arc, the skin outside hangs over the skin inside */
    uint32_t most;              /* folds at most */
    uint32_t count;             /* folds that were placed */
    double at[FOLD_LINES];      /* their radius or angle */
    double share[FOLD_LINES];   /* 0..1 of the depth */
} fold_zone;

typedef struct wrinkle_folds {
    wrinkle_face face;
    fold_zone zones[FOLD_ZONES];
} wrinkle_folds;

/* Find the face and measure the compression of its zones across their folds, in place of the largest one
 * (field->shrink). Returns 1, or 0: it is not a face, and nothing is changed. */
int wrinkle_folds_find(wrinkle_field *field, const recipe_text *recipe, wrinkle_folds *out);

/* From side to side of the finest fold, model units. */
double wrinkle_folds_finest(const wrinkle_folds *folds);

/* Choose where the folds of each zone lie, and widen those that are finer than what the texture shows (finest, model
 * units). Returns 0 where targets compress none of the zones. */
int wrinkle_folds_place(const wrinkle_field *field, const wrinkle_raster *raster, double finest, wrinkle_folds *folds);

/* Their normal map, like wrinkle_creases_make. To be freed; NULL: out of memory. */
uint8_t *wrinkle_folds_map(const wrinkle_field *field, const wrinkle_raster *raster, const wrinkle_folds *folds);

/* Zones with folds as regions, like wrinkle_regions_make. To be freed; NULL: out of memory. */
region_weights *wrinkle_folds_regions(const wrinkle_field *field, const wrinkle_folds *folds);

#ifdef __cplusplus
}
#endif
#endif
