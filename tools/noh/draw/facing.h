/* facing.h: which way a body faces. In glTF it should be +z; pictures, and the page (platform/web), show others from
 * their own front. */
#ifndef NOH_NOH_DRAW_FACING_H
#define NOH_NOH_DRAW_FACING_H

#include "noh/pack.h"

/* Degrees from +z towards +x, in steps of 90, by its feet (noh_feet_front). 0: it faces +z, or this is not known. */
double pack_facing(const noh_pack *pack);

#endif
