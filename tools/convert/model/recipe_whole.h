/* recipe_whole.h: targets that move more of a face than one row of a recipe should: the whole face for an emotion, or
 * what another target of the same meaning moves, too. */
#ifndef NOH_CONVERT_MODEL_RECIPE_WHOLE_H
#define NOH_CONVERT_MODEL_RECIPE_WHOLE_H

#include "convert/base/recipe_read.h"
#include "convert/model/model.h"

/* Whether b moves what a moves, too, and should stand for both: the same shape under another name, or a part of a. Of
 * two that are equal the first one stays. */
int target_is_held(const model *m, const char *a, const char *b, int b_is_first);

/* From row `from` on: where an emotion's upper face takes a target of the whole face (VRoid's Fcl_ALL_Joy), and the
 * mesh has its parts (Fcl_BRW_Joy, Fcl_EYE_Joy, Fcl_MTH_Joy) which add up to it, take the parts, so that speech can
 * take the mouth; and where the eyes' part shuts the lids, blinks leave as much. 0, or 1 when out of memory or there
 * are too many rows. */
int recipe_split_whole(recipe_text *recipe, const model *m, uint32_t from);

#endif
