/* root_internal.h (private): places that root motion moves. */
#ifndef NOH_ANIM_ROOT_INTERNAL_H
#define NOH_ANIM_ROOT_INTERNAL_H

#include "motion/anim/root_motion.h"

/* Move a place by a displacement of its own space, in double precision: floats lose a step of 2 cm at 10^6 units, and a
 * day of turns adds up to a tenth of a degree. rotation: x, y, z, w, unit within a float's rounding; exactly so after. */
void noh_root_drive(uint32_t up, const noh_root_pose *moved, double scale, double position[3], double rotation[4]);

/* A sum of two floats that is nearer to a double than one float is. Volatile, because gcc 12 takes a pair of doubles
 * that go to floats and back for unchanged where it vectorizes. */
static inline void noh_split(double value, float *high, float *low)
{
    const volatile float rounded = (float)value;
    *high = rounded;
    *low = (float)(value - (double)rounded);
}

#endif
