/* recipe_whole.h: targets that move more of a face than one row of a recipe should: the whole face for an emotion, or
 * what another target of the same meaning moves, too. */
#ifndef NOH_CONVERT_MODEL_RECIPE_WHOLE_H
#define NOH_CONVERT_MODEL_RECIPE_WHOLE_H

#include "convert/base/recipe_read.h"
#include "convert/model/model.h"

/* Where several targets of one meaning move a face the same way, one is used and the others are held by it: the same
 * shape under another name, or a shape that moves more than it should. The smallest is used; one that moves less than half
 * as far as another is a detail, and is held. Of equal ones the first is used.
 * meaning [count]: equal numbers for targets of one meaning; MODEL_NONE: none. held [count]: 1 for a target that is
 * held. 0, or 1 when out of memory. */
int targets_find_held(const model *m, const char *const *names, const uint32_t *meaning, uint32_t count, uint8_t *held);

/* Where an emotion's upper face takes a target of the whole face (VRoid's Fcl_ALL_Joy), and the mesh has its parts
 * (Fcl_BRW_Joy, Fcl_EYE_Joy, Fcl_MTH_Joy) which add up to it, take the parts, so that speech can take the mouth; and
 * where the eyes' part shuts the lids, blinks leave as much. Rows that an artist wrote, in a text or in extras, stay as
 * they are: they have a line. 0, or 1 when out of memory or there are too many rows. */
int recipe_split_whole(recipe_text *recipe, const model *m);

#endif
