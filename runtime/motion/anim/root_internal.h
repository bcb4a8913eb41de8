/* root_internal.h (private): places moved by root motion. */
#ifndef NOH_ANIM_ROOT_INTERNAL_H
#define NOH_ANIM_ROOT_INTERNAL_H

#include "noh/clip.h"

/* Move a place by a displacement in its own space, in double precision: floats lose a step of 2 cm at 10^6 units, and
 * the turns of a day add up to a tenth of a degree. rotation: x, y, z, w, unit within a float's rounding on input,
 * exactly on output. */
void noh_root_drive(uint32_t up, const noh_root_pose *moved, double scale, double position[3], double rotation[4]);

/* Split a double into two floats whose sum is nearer to it than one float. Volatile, because gcc 12, when it
 * vectorises, treats a pair of doubles converted to floats and back as unchanged. */
static inline void noh_split(double value, float *high, float *low)
{
    const volatile float rounded = (float)value;
    *high = rounded;
    *low = (float)(value - (double)rounded);
}

#endif
