/* half_internal.h: 16-bit floats, as render targets store them. */
#ifndef NOH_BASE_HALF_INTERNAL_H
#define NOH_BASE_HALF_INTERNAL_H

#include "noh/low_core.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== 16-bit floats ========
 * 16-bit floats, as render targets store them.
 *
 *   noh_half_from_float   one float to half, in a named rounding mode
 *   noh_half_to_float     one half to float, always exact
 *   noh_half_round        to half and back
 *
 * Drivers round colours into RGBA16F targets in different ways. A CPU reference can reproduce a driver's bits with
 * these modes. Only integers are used, so results do not depend on the processor.
 * Threads: no state; any thread. */

/* Round a float to half.
 * ranges  any float. RTZ never turns a finite value into infinity: it stops at 65504. RNE overflows to infinity from
 *         65520. Infinities stay, NaN stays NaN (quiet, upper payload bits kept), denormals are kept, not flushed.
 *         NOH_HALF_UNKNOWN and RTZ_RNE round like RNE
 * source  IEEE 754-2008, 4.3.1 and 4.3.2 */
uint16_t noh_half_from_float(float value, noh_half_mode mode);

/* Convert a half to float; exact. NaN stays NaN with its payload. */
float noh_half_to_float(uint16_t half);

/* Round a float to one that a half can hold. */
static inline float noh_half_round(float value, noh_half_mode mode)
{
    return noh_half_to_float(noh_half_from_float(value, mode));
}

#ifdef __cplusplus
}
#endif

#endif
