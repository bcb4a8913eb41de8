/* The paint: one linear colour per vertex. */
#ifndef MASK_COLOUR_H
#define MASK_COLOUR_H

#include "mesh.h"

/* `frames` is the model at rest; `open` is from occlusion_bake. */
void colour_bake(Model *model, const Frame *frames, double *const open[PARTS_MAX]);

#endif
