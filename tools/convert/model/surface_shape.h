/* surface_shape.h: what meshes tell of their eyes and mouths: where an eye looks, how wide its iris is, where its lids
 * are; how deep in the mouth teeth stand. It goes into the surface values of materials (noh_material). */
#ifndef NOH_CONVERT_MODEL_SURFACE_SHAPE_H
#define NOH_CONVERT_MODEL_SURFACE_SHAPE_H

#include <stdio.h>

#include "model.h"

/* For each material that is an eye or teeth. Eyes are islands of their material that lie on spheres; they look about
 * along +z. An iris is darker than the white around it, in the texture times the vertex colours; the two eyes of one
 * material share one mean. Lids are the edges of what is opaque in front of a ball. What is not found stays zero: a
 * drawn eye, say. Teeth, and skin between them, are the darker, the farther
 * behind the foremost. Values of eyes are rounded to 2^-12.
 * report  a line for each eye; NULL: quiet
 * errors  1: out of memory */
int surface_shapes_find(model *m, FILE *report, model_error *error);

#endif
