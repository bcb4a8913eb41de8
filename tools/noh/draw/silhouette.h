/* silhouette.h: what a figure covers as a camera sees it: how much of that is inside the picture. It is what the
 * triangles of the posed meshes cover, on a raster on the CPU that is five pictures wide and high.
 *
 *   silhouette_measure */
#ifndef NOH_NOH_DRAW_SILHOUETTE_H
#define NOH_NOH_DRAW_SILHOUETTE_H

#include "figure.h"
#include "noh/low_gl.h"

typedef struct silhouette {
    double inside; /* 0..1, of what is covered: the share in the picture; 0 where some is behind the camera */
    double height; /* of what is covered, in heights of the picture */
} silhouette;

/* level: an LOD level, or NOH_LOD_LEVELS_MAX: the coarsest. Prints an error and returns an exit code. */
int silhouette_measure(const figure *f, const noh_gl_camera *camera, uint32_t level, silhouette *out);

#endif
