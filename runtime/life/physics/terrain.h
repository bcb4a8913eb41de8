/* terrain.h: the height field of a pack, where it lies.
 *
 *   noh_terrain_of        the height field (world.h): its heights, normals, rays, and a world's ground
 *
 * Threads: no state; any thread. */
#ifndef NOH_SIM_TERRAIN_H
#define NOH_SIM_TERRAIN_H

#include "core/pack/pack.h"
#include "life/physics/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A view: valid as long as the pack and its bytes are.
 * units   metres
 * errors  NOT_FOUND  the pack has no terrain: it was built without --terrain; *field is untouched */
noh_result noh_terrain_of(const noh_pack *pack, noh_field *field, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
