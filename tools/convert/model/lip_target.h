/* lip_target.h: a target that brings the lower lip to the upper teeth, for f and v. Few faces have one, and sums of
 * targets that open, press and spread a mouth do not do it.
 *
 * Lips are found by lip_rim.h; teeth are other islands near them that stay when the mouth opens. The lip's rim, after
 * the recipe's FF, moves to the nearest point of the teeth, fully in the middle of the mouth and not at all at the
 * corners; the skin around it follows less with distance. */
#ifndef NOH_CONVERT_MODEL_LIP_TARGET_H
#define NOH_CONVERT_MODEL_LIP_TARGET_H

#include <stdio.h>

#include "convert/model/model.h"

#define LIP_TARGET "lipToTeeth"

#define LIP_WHY_BYTES 256u

/* Add the target to the first mesh that has lips and teeth.
 * report  a line on the result; NULL: none
 * why     the reason why no mesh has it; "": one has
 * errors  1 and *error: out of memory */
int lip_target_add(model *m, FILE *report, char why[LIP_WHY_BYTES], model_error *error);

#endif
