/* Nell's colours: one linear colour per vertex. */
#ifndef NELL_COLOUR_H
#define NELL_COLOUR_H

#include "mask/mesh.h"

void nell_colour(Model *model, const Frame *frames, double *const open[PARTS_MAX]);

#endif
