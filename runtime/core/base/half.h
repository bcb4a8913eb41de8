/* half.h: 16-bit floats, as render targets store them.
 *
 *   noh_half_from_float   one float to half, in a named rounding mode
 *   noh_half_to_float     one half to float, always exact
 *
 * Drivers differ in how they round a colour into an RGBA16F target. The roundings in use are here, so that a CPU
 * reference can reproduce a driver's bits. Only integers are used: the result does not depend on the processor.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_HALF_H
#define NOH_BASE_HALF_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_half_mode {
    NOH_HALF_UNKNOWN = 0, /* neither of these: results can only be compared within a bound */
    NOH_HALF_RTZ,         /* round toward zero */
    NOH_HALF_RNE,         /* round to nearest, ties to even */
    NOH_HALF_RTZ_RNE      /* of sums: what is added is rounded toward zero, then the sum to nearest (NVIDIA) */
} noh_half_mode;

/* Round a float to half.
 * ranges  any float. RTZ never turns a finite value into infinity: it stops at 65504. RNE overflows to infinity from
 *         65520. Infinities stay, NaN stays NaN (quiet, upper payload bits kept), denormals are kept, not flushed.
 *         NOH_HALF_UNKNOWN and RTZ_RNE round as RNE does
 * source  IEEE 754-2008, 4.3.1 and 4.3.2 */
uint16_t noh_half_from_float(float value, noh_half_mode mode);

/* The float that a half stands for; exact. NaN stays NaN with its payload. */
float noh_half_to_float(uint16_t half);

#ifdef __cplusplus
}
#endif

#endif
