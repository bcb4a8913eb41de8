/* facing.h: where a body faces that does not face +z, as glTF has it: pictures then show it from its own front. */
#ifndef NOH_NOH_DRAW_FACING_H
#define NOH_NOH_DRAW_FACING_H

#include "noh/pack.h"

/* Degrees from +z towards +x, in steps of 90: what left and right limbs in the bind pose say, where both feet point the
 * same way. 0: it faces +z, or nothing tells. */
double pack_facing(const noh_pack *pack);

#endif
