/* silhouette.h: the silhouette of a figure in a camera, and the share of it inside the picture. The triangles of the
 * posed meshes are rasterised on the CPU, in a raster five pictures wide and high.
 *
 *   silhouette_measure */
#ifndef NOH_NOH_DRAW_SILHOUETTE_H
#define NOH_NOH_DRAW_SILHOUETTE_H

#include "figure.h"
#include "noh/low_gl.h"

typedef struct silhouette {
    double inside; /* 0..1: the share of the silhouette in the picture; 0 if part of it is behind the camera */
    double height; /* of the silhouette, in heights of the picture */
} silhouette;

/* level: an LOD level, or NOH_LOD_LEVELS_MAX: the coarsest. Prints an error and returns an exit code. */
int silhouette_measure(const figure *f, const noh_gl_camera *camera, uint32_t level, silhouette *out);

#endif
