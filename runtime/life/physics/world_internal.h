/* world_internal.h (private to sim/): a world seen from an origin near to what meets it, where floats have more digits.
 * Threads: as world.h. */
#ifndef NOH_SIM_WORLD_INTERNAL_H
#define NOH_SIM_WORLD_INTERNAL_H

#include "life/physics/world.h"

/* How far a plane is from an origin, along its normal. */
float noh_plane_distance(const noh_plane *plane, const float origin[3]);

/* noh_field_height, with x, z and *height from the origin. */
int noh_field_height_about(const noh_field *field, const float origin[3], float x, float z, float *height,
                           float normal[3]);

#endif
