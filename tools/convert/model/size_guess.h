/* size_guess.h: whether a model's unit is what it was read as, by the distance of its eyes and its height. */
#ifndef NOH_CONVERT_MODEL_SIZE_GUESS_H
#define NOH_CONVERT_MODEL_SIZE_GUESS_H

#include <stdio.h>

#include "convert/model/model.h"

/* Report the size of a model with eyes or with the joints of a person, and warn if another unit fits it better. 0, or 1
 * when out of memory. */
int size_guess(model *m, FILE *report);

/* Metres of the unit that the model certainly has, where it was read with 1 m a unit: at most 0.1, and with it both the
 * distance of its eyes and its height are human. 1: any other model. Surfaces of materials are known. */
double size_unit(const model *m);

#endif
