#include "core/base/half_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"

#include <string.h>

#define FLOAT_INFINITY 0x7f800000u
#define FLOAT_HALF_MIN 0x38800000u     /* 2^-14, the smallest normal half */
#define FLOAT_HALF_REBIAS 0x38000000u  /* (127 - 15) << 23 */
#define FLOAT_RTZ_MAX 0x477fffffu      /* the last float below 65536 */
#define FLOAT_RNE_INFINITY 0x477ff000u /* 65520, halfway between 65504 and 65536 */
#define HALF_INFINITY 0x7c00u

/* value >> shift, rounded as `mode` says. shift 1..31. */
static uint32_t shift_rounded(uint32_t value, uint32_t shift, noh_half_mode mode)
{
    uint32_t kept = value >> shift;
    if (mode == NOH_HALF_RTZ) return kept;
    uint32_t rest = value & ((1u << shift) - 1u);
    uint32_t middle = 1u << (shift - 1u);
    if (rest > middle || (rest == middle && (kept & 1u))) kept++;
    return kept;
}

/* `magnitude`: the bits of a finite float without its sign. A carry out of the mantissa runs into the exponent, which
 * is the right result for normal halves and denormals alike. */
static uint32_t half_magnitude(uint32_t magnitude, noh_half_mode mode)
{
    if (magnitude >= FLOAT_HALF_MIN) return shift_rounded(magnitude - FLOAT_HALF_REBIAS, 13, mode);
    uint32_t exponent = magnitude >> 23;
    /* Below 2^-25 nothing is left in either mode. */
    if (exponent < 102u) return 0;
    uint32_t mantissa = (magnitude & 0x7fffffu) | 0x800000u;
    return shift_rounded(mantissa, 126u - exponent, mode);
}

/* A half has 5 bits of exponent (bias 15) and 10 of mantissa, a float 8 (bias 127) and 23. In the normal range both are
 * the same bits except for the bias and 13 mantissa bits, which are rounded off; a carry out of the mantissa increments
 * the exponent, which is the next half. Below 2^-14 the mantissa, its hidden bit made visible, is shifted to the fixed
 * exponent of denormals. What lies above the largest half stops there (RTZ) or becomes infinity (RNE). */
uint16_t noh_half_from_float(float value, noh_half_mode mode)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t sign = (bits >> 16) & 0x8000u;
    uint32_t magnitude = bits & 0x7fffffffu;
    uint32_t half;
    if (mode != NOH_HALF_RTZ && magnitude - FLOAT_HALF_MIN < FLOAT_RNE_INFINITY - FLOAT_HALF_MIN) {
        /* nearly every value: a normal half, to nearest; ties go to even by the last bit that stays */
        half = (magnitude - FLOAT_HALF_REBIAS + 0xfffu + ((magnitude >> 13) & 1u)) >> 13;
    } else if (magnitude == 0) {
        half = 0;
    } else if (magnitude > FLOAT_INFINITY) {
        half = HALF_INFINITY | 0x200u | ((magnitude >> 13) & 0x3ffu);
    } else if (magnitude == FLOAT_INFINITY) {
        half = HALF_INFINITY;
    } else if (mode == NOH_HALF_RTZ) {
        half = half_magnitude(magnitude > FLOAT_RTZ_MAX ? FLOAT_RTZ_MAX : magnitude, mode);
    } else {
        half = magnitude >= FLOAT_RNE_INFINITY ? HALF_INFINITY : half_magnitude(magnitude, mode);
    }
    return (uint16_t)(sign | half);
}

float noh_half_to_float(uint16_t half)
{
    uint32_t sign = ((uint32_t)half & 0x8000u) << 16;
    uint32_t exponent = ((uint32_t)half >> 10) & 0x1fu;
    uint32_t mantissa = (uint32_t)half & 0x3ffu;
    uint32_t bits;
    if (exponent == 0x1fu) {
        bits = FLOAT_INFINITY | (mantissa << 13);
    } else if (exponent != 0) {
        bits = ((exponent + 112u) << 23) | (mantissa << 13);
    } else if (mantissa == 0) {
        bits = 0;
    } else {
        /* A denormal has no hidden bit: bring its highest bit to that place, one exponent lower for each shift. */
        exponent = 113;
        while (!(mantissa & 0x400u)) {
            mantissa <<= 1;
            exponent--;
        }
        bits = (exponent << 23) | ((mantissa & 0x3ffu) << 13);
    }
    bits |= sign;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
