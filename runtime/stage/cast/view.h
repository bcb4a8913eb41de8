/* view.h: cameras and lights for a stage.
 *
 *   noh_view_orbit    a camera that looks at a point from a distance
 *   noh_view_shadow   a light that sees a sphere
 *   noh_view_ray      the ray under a pixel
 *
 * Threads: pure functions of their arguments; any thread. */
#ifndef NOH_STAGE_VIEW_H
#define NOH_STAGE_VIEW_H

#include "stage/cast/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A perspective camera, y up, 40 degrees from top to bottom, that sees from a hundredth to a hundred times the
 * distance. The light comes from its left, above.
 * units   yaw_rad 0: the camera is on the side of +z; pitch_rad above 0: it looks down
 * ranges  distance above 0; width, height in pixels, at least 1 */
void noh_view_orbit(noh_stage_view *view, const float target[3], float yaw_rad, float pitch_rad, float distance,
                    uint32_t width, uint32_t height);

/* A parallel view along a light, for a shadow map: all of a sphere, and what stands between it and the light by one
 * diameter.
 * shapes  sphere: centre x, y, z, radius; light: unit vector towards the light */
void noh_view_shadow(noh_stage_view *view, const float sphere[4], const float light[3]);

/* The ray through the middle of a pixel, from the near plane on; x to the right, y down, from 0.
 * shapes  origin, direction: world; the direction's length is 1
 * returns 0 where the view's matrix cannot be inverted */
int noh_view_ray(const noh_stage_view *view, float x, float y, uint32_t width, uint32_t height, float origin[3],
                 float direction[3]);

#ifdef __cplusplus
}
#endif

#endif
