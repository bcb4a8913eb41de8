/* surface_shape.h: shapes of eyes and mouths from meshes: an eye's direction, iris and lids, and the depth of teeth in
 * the mouth. It goes into the surface values of materials (noh_material). */
#ifndef NOH_CONVERT_MODEL_SURFACE_SHAPE_H
#define NOH_CONVERT_MODEL_SURFACE_SHAPE_H

#include <stdio.h>

#include "model.h"

/* For each material that is an eye or teeth. Eyes are islands of their material that lie on spheres; they look about
 * along +z. An iris is darker than the white around it, in the texture times the vertex colours; the two eyes of one
 * material share one mean. Lids are the edges of opaque skin in front of an eyeball. Values that are not found stay
 * zero, as for a painted eye. Teeth, and skin between them, are the darker, the farther
 * behind the foremost. Values of eyes are rounded to 2^-12. An iris with a painted highlight mirrors nothing, with a
 * warning, unless the surface is given.
 * keep_looks  1: the highlight stays, and so does the mirror
 * report  a line for each eye; NULL: quiet
 * errors  1: out of memory */
int surface_shapes_find(model *m, int keep_looks, FILE *report, model_error *error);

#endif
