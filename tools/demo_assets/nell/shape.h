/* Nell's head, neck and shoulders without features: rings stacked from the crown to the collar. */
#ifndef NELL_SHAPE_H
#define NELL_SHAPE_H

#include "shared/maths.h"

/* The plane that is laid around the head, metres: s from -HALF_ROUND to HALF_ROUND, 0 in front; t from TOP down to
 * BOTTOM. In the face s and t are about x and y, whose origin is between the eyes. */
#define HALF_ROUND 0.200
#define TOP 0.182
#define BOTTOM (-0.215)

V3 shape_at(double s, double t);

/* The surface's normal, of length 1. */
V3 shape_normal(double s, double t);

/* Where features stand out to: ahead in the face, sideways at the sides, never up or down. */
V3 shape_out(double s, double t);

#endif
