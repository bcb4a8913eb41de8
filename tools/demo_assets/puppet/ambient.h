/* How open each vertex of a surface is to light from all sides. */
#ifndef PUPPET_AMBIENT_H
#define PUPPET_AMBIENT_H

#include "cage.h"

/* open: for each vertex of the surface, 0 (closed in) to 1; freed by the caller. */
double *ambient_bake(const Cage *surface, const V3 *normals);

#endif
