/* How open each vertex is to light from the front, at rest. */
#ifndef MASK_OCCLUSION_H
#define MASK_OCCLUSION_H

#include "mesh.h"

/* One value per vertex of each part: 1 in the open, towards 0 in a crease. */
void occlusion_bake(const Model *model, const Frame *frames, double *open[PARTS_MAX]);

#endif
