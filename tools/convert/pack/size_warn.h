/* size_warn.h: a warning where a clip's tolerance does not go with the size of what it moves. */
#ifndef NOH_CONVERT_PACK_SIZE_WARN_H
#define NOH_CONVERT_PACK_SIZE_WARN_H

#include "convert/clips/raw_clip.h"

/* Distances in centimetres: of points around joints, as clips are encoded to them. The default tolerance is right for
 * people. On what is as small as a coin it shows, and on what is as large as a ship it costs bytes that nobody sees; a
 * suggestion has the same share of the size. Sizes that would be usual in another unit are said to be.
 * sets  [set_count]; meshes bound. Returns 1 when out of memory. */
int size_warn(model *m, raw_set *const *sets, uint32_t set_count, double error_cm);

#endif
