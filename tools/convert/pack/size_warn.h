/* size_warn.h: warnings of sizes: of a figure that cannot be seen, of a clip's tolerance that does not fit its figure,
 * of weights. */
#ifndef NOH_CONVERT_PACK_SIZE_WARN_H
#define NOH_CONVERT_PACK_SIZE_WARN_H

#include "convert/clips/raw_clip.h"

/* The longest side of a box about a mesh, in the world; 0: there are none. */
double meshes_cm(const model *m);

/* Warn of meshes that are too small, or too far from the origin, to be drawn. Returns 1: out of memory. */
int extent_warn(model *m);

/* Warn of clips whose targets' weights are far beyond what a target is for. */
int weights_warn(model *m, raw_set *const *sets, uint32_t set_count);

/* Distances in centimetres: of points around joints, as clips are encoded to them. The default tolerance is right for
 * people. On a coin it is visible, and on a ship it wastes bytes; the suggestion is the same share of the size. If the
 * size would be usual in another unit, the warning says so.
 * sets      [set_count]; meshes bound. Where the default would be visible, the suggestion is stored in them.
 * error_cm  0: none was asked for
 * Returns 1 when out of memory. */
int size_warn(model *m, raw_set *const *sets, uint32_t set_count, double error_cm);

#endif
