/* world_internal.h: a world relative to a nearby origin, where floats have more digits. Threads: as body.h. */
#ifndef NOH_SIM_WORLD_INTERNAL_H
#define NOH_SIM_WORLD_INTERNAL_H

#include "noh/body.h"
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Get the distance of a plane from an origin, along its normal. */
float noh_plane_distance(const noh_plane *plane, const float origin[3]);

/* noh_field_height with x, z and *height relative to the origin. */
int noh_field_height_about(const noh_field *field, const float origin[3], float x, float z, float *height,
                           float normal[3]);

/* Find the highest ground at a place that is not above `top`. Returns 0 if there is none. Points and heights are
 * relative to the origin. */
int noh_world_ground_below(const noh_world *world, const float origin[3], const float at[3], float top, float *height);
/* Get the distance along a level ray to a wall, in lengths of its direction; 1e30: there is none. The ray is relative
 * to the origin. */
float noh_world_wall_ahead(const noh_world *world, const float origin[3], const noh_ray *ray);

#ifdef __cplusplus
}
#endif

#endif
