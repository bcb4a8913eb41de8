/* mouth_shape.h: where a mouth is, and how far its lips are apart, for the light in it. */
#ifndef NOH_CONVERT_MODEL_MOUTH_SHAPE_H
#define NOH_CONVERT_MODEL_MOUTH_SHAPE_H

#include "convert/model/model.h"

/* Set the values of teeth and skin (noh_material.surface_values) by the bounds of the teeth, and what targets do to the
 * lips (lip_rim.h). Without teeth nothing changes.
 * returns  1: out of memory */
int mouth_shape_find(model *m);

#endif
