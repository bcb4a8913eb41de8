/* quarter_internal.h: quarter turns about y, which say where a body's front is: 0..3, from +z towards +x. Threads: no
 * state; any thread. */
#ifndef NOH_BASE_QUARTER_INTERNAL_H
#define NOH_BASE_QUARTER_INTERNAL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The nearest quarter of a direction. */
uint32_t noh_quarter_of(float x, float z);

/* Turn a vector, exactly; 4 less a quarter turns it back. in and out may be the same. */
void noh_quarter_turn(uint32_t quarter, const float in[3], float out[3]);

#ifdef __cplusplus
}
#endif

#endif
