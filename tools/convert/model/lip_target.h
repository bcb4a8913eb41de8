/* lip_target.h: a target that brings the lower lip to the upper teeth, for f and v. Few faces have one, and none of
 * those that open, press and spread a mouth does it when they are added up.
 *
 * Lips, jaw and teeth are found by what the targets of an open mouth (the recipe's aa) move: skin is what hangs
 * together with the point that they move farthest; the lower lip is skin that goes along and touches skin that stays;
 * teeth are other islands near the lips that stay. The lip's rim, as the recipe's FF leaves it, is led to the nearest
 * point of the teeth, in the middle of the mouth all the way and at the corners not at all; the skin around it goes
 * along the less the farther it is. */
#ifndef NOH_CONVERT_MODEL_LIP_TARGET_H
#define NOH_CONVERT_MODEL_LIP_TARGET_H

#include <stdio.h>

#include "convert/model/model.h"

#define LIP_TARGET "lipToTeeth"

/* Add the target to the first mesh that has lips and teeth. Where none has, a warning says why.
 * report  a line on what was found; NULL: none
 * errors  1 and *error: out of memory */
int lip_target_add(model *m, FILE *report, model_error *error);

#endif
