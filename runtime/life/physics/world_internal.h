/* world_internal.h (private to physics/): a world relative to a nearby origin, where floats have more digits. Threads:
 * as body.h. */
#ifndef NOH_SIM_WORLD_INTERNAL_H
#define NOH_SIM_WORLD_INTERNAL_H

#include "noh/body.h"
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifdef __cplusplus
}
#endif

/* Get the distance of a plane from an origin, along its normal. */
float noh_plane_distance(const noh_plane *plane, const float origin[3]);

/* noh_field_height with x, z and *height relative to the origin. */
int noh_field_height_about(const noh_field *field, const float origin[3], float x, float z, float *height,
                           float normal[3]);

#endif
