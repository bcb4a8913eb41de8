/* How muscles drag the closed face plane. */
#ifndef MASK_STROKE_H
#define MASK_STROKE_H

#include "shared/maths.h"

/* A stroke drags the plane around one point; the drag falls to zero at the ellipse's edge. Written for the left side (x
 * outwards); the right side is its mirror image. */
typedef struct {
    double x, y, rx, ry; /* centre and radii of the ellipse */
    double dx, dy, dz;   /* by how much it drags */
} Stroke;

/* Adds to `shift` what a stroke pulled by `pull` does at (s, t). */
void drag(V3 *shift, double s, double t, int side, double pull, Stroke stroke);

#endif
