/* strands.h: where strands run in the textures of hair. */
#ifndef NOH_CONVERT_MODEL_STRANDS_H
#define NOH_CONVERT_MODEL_STRANDS_H

#include <stdio.h>

#include "model.h"

/* For each material of hair: colour and alpha of its base colour's texture change least along strands. Where they change
 * about as much in all directions, or there is no texture, strands run along v. Roots are assumed at the smaller v, or
 * u. The direction is rounded to 2^-12.
 * report  a line for each material; NULL: quiet */
void strands_find(model *m, FILE *report);

#endif
