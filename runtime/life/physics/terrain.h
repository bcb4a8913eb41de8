/* terrain.h: the height field in a pack, used in place.
 *
 *   noh_terrain_of        get the height field (world.h): heights, normals, rays, and the ground of a world
 *
 * Threads: no state; any thread. */
#ifndef NOH_SIM_TERRAIN_H
#define NOH_SIM_TERRAIN_H

#include "core/pack/pack.h"
#include "life/physics/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the height field: a view, valid as long as the pack and its bytes.
 * units   metres
 * errors  NOT_FOUND  the pack has no terrain (build it with --terrain); *field is then unchanged */
noh_result noh_terrain_of(const noh_pack *pack, noh_field *field, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
