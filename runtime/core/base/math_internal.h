/* math_internal.h: the little arithmetic that the library needs, without libm.
 *
 *   noh_sqrt          correctly rounded
 *   noh_is_finite, noh_is_number, noh_is_within, noh_larger, noh_clamped
 *   noh_dot3
 *   noh_stretch       of a matrix
 *   noh_normalize3
 *
 * Everything is +, -, *, / and square roots, each rounded once, with contraction off: the same bits on every machine
 * whose float arithmetic is IEEE 754 in single precision. x87 keeps 80 bits, so it is refused.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_MATH_INTERNAL_H
#define NOH_BASE_MATH_INTERNAL_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "core/base/compiler_internal.h"
#include "noh/base.h"

/* 16: gcc's word for half floats that are kept as they are, and floats, too. */
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16 && !defined(NOH_ALLOW_X87)
#error \
    "floats have more digits here than on other machines, and noh promises the same bits on all: compile with -msse2 -mfpmath=sse, or define NOH_ALLOW_X87 to do without the promise"
#endif
#if defined(__BYTE_ORDER__) && defined(__ORDER_LITTLE_ENDIAN__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "packs are little-endian and read where they lie: noh does not run on big-endian processors"
#endif

/* Neither an infinity nor a NaN. */
static inline int noh_is_finite(float x)
{
    return x - x == 0.0f;
}

static inline int noh_is_finite3(const float v[3])
{
    return noh_is_finite(v[0]) && noh_is_finite(v[1]) && noh_is_finite(v[2]);
}

static inline float noh_abs(float x)
{
    return x < 0.0f ? -x : x;
}

static inline float noh_larger(float a, float b)
{
    return a > b ? a : b;
}

static inline int noh_is_within(float x, float low, float high)
{
    return x >= low && x <= high;
}

/* NaN: low. */
static inline float noh_clamped(float x, float low, float high)
{
    return x >= low ? x <= high ? x : high : low;
}

/* Small enough that what a frame computes of it stays finite. */
static inline int noh_is_number(float x)
{
    return x >= -NOH_NUMBER_MAX && x <= NOH_NUMBER_MAX;
}

static inline int noh_is_number3(const float v[3])
{
    return noh_is_number(v[0]) && noh_is_number(v[1]) && noh_is_number(v[2]);
}

/* Results of frames from numbers, as saved states hold them: sums and products of what the game sets may be larger than
 * NOH_NUMBER_MAX, and the squares of these are finite still. */
#define NOH_SOUND_MAX 1e18f

static inline int noh_are_sound(const float *x, size_t count)
{
    int all = 1;
    for (size_t i = 0; i < count; i++) all &= x[i] >= -NOH_SOUND_MAX && x[i] <= NOH_SOUND_MAX;
    return all;
}

/* Results of numbers that a pack alone bounds, kept such that a state with them is taken. */
static inline void noh_keep_sound(float *x, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        x[i] = x[i] >= -NOH_SOUND_MAX ? (x[i] <= NOH_SOUND_MAX ? x[i] : NOH_SOUND_MAX) : -NOH_SOUND_MAX;
    }
}

/* Whether the fields of a struct from one on, before another, are results: all of them are floats. */
#define NOH_ARE_SOUND(type, of, from, end)                                                     \
    noh_are_sound((const float *)(const void *)((const uint8_t *)(of) + offsetof(type, from)), \
                  (offsetof(type, end) - offsetof(type, from)) / sizeof(float))

#define NOH_NEAR_ORIGIN 512.0f /* along each axis: a float there is exact to 0.03 mm, in metres */

/* The point to count from instead of the origin: 0 for an x near it, else a multiple of 16 close to x, which is an exact
 * float, as is its difference from floats near x. */
static inline float noh_on_grid(float x)
{
    if (!(x > NOH_NEAR_ORIGIN || x < -NOH_NEAR_ORIGIN) || !noh_is_number(x)) return 0.0f;
    if (x >= 134217728.0f || x <= -134217728.0f) return x; /* 2^27: a multiple already */
    return (float)(int32_t)(x / 16.0f + (x < 0.0f ? -0.5f : 0.5f)) * 16.0f;
}

/* With errno off (-fno-math-errno) gcc and clang turn the builtin into the processor's instruction. With errno on they
 * call sqrtf for negative arguments, and for all where the processor has no such instruction: there the vector unit
 * takes the root, or plain C. All give the same bits. */
#if defined(NOH_GNU) && defined(__NO_MATH_ERRNO__) && !(defined(__i386__) && !defined(__SSE__)) && \
    !defined(__SOFTFP__) && !(defined(__riscv) && !defined(__riscv_flen)) && !defined(__mips_soft_float)
#define NOH_SQRT_BUILTIN 1
#elif defined(NOH_SSE2)
#include <emmintrin.h>
#elif defined(NOH_NEON)
#include <arm_neon.h>
#endif

/* The largest integer whose square is at most n, n below 2^50: 25 bits of result, the highest first, as in long
 * division. A bit is kept if the square of the root so far, with that bit set, is not above n; `rest` is n less the
 * square of the root so far. */
static inline uint32_t noh_integer_root(uint64_t n)
{
    uint64_t root = 0, rest = n;
    for (uint64_t bit = (uint64_t)1 << 48; bit; bit >>= 2) { /* the square of the bit being tried */
        if (rest >= root + bit) {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    return (uint32_t)root;
}

/* The square root in integers, correctly rounded.
 *
 * x = m 2^e with m of 24 bits and e even or odd. m is shifted left by 25 or 26 bits, whichever leaves an even exponent,
 * so that it lies in 2^48..2^50 and its integer root in 2^24..2^25: the 24 bits of the result and one more, which says
 * on which side of the middle between two floats the root lies. The root is never the middle itself: 25 bits with
 * the last bit set have an odd square, and the shifted m is even. So adding that bit rounds correctly, and the sum does
 * not reach the next power of two. */
NOH_UNUSED static inline float noh_sqrt_plain(float x)
{
    uint32_t bits, mantissa, root;
    int32_t exponent;
    memcpy(&bits, &x, sizeof bits);
    if ((bits & 0x7fffffffu) == 0u || bits == 0x7f800000u) {
        return x; /* 0, -0 and infinity */
    }
    if (bits > 0x7f800000u) {
        return (x - x) / (x - x); /* a negative number gives NaN, and NaN stays NaN */
    }
    exponent = (int32_t)(bits >> 23);
    mantissa = bits & 0x7fffffu;
    if (exponent) {
        mantissa |= 0x800000u;
    } else { /* subnormal: shift its highest bit to where the hidden bit is */
        const int32_t shift = (int32_t)noh_leading_zeros(mantissa) - 8;
        mantissa <<= shift;
        exponent = 1 - shift;
    }
    exponent -= 127; /* of a mantissa in 1..2 */
    root = noh_integer_root((uint64_t)mantissa << ((exponent & 1) ? 26 : 25));
    bits = ((root + 1u) >> 1) + ((uint32_t)(((exponent & 1) ? exponent - 1 : exponent) / 2 + 126) << 23);
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline float noh_sqrt(float x)
{
#if defined(NOH_SQRT_BUILTIN)
    return __builtin_sqrtf(x);
#elif defined(NOH_SSE2)
    return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(x)));
#elif defined(NOH_NEON)
    return vget_lane_f32(vsqrt_f32(vdup_n_f32(x)), 0);
#else
    return noh_sqrt_plain(x);
#endif
}

static inline float noh_dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The most that a matrix [12], rows of 3 x 4, lengthens a vector: its longest column where the columns are at right
 * angles, no less than the right figure where they are not (Gershgorin's bound on the eigenvalues of M^T M). */
static inline float noh_stretch(const float m[12])
{
    const float xx = m[0] * m[0] + m[4] * m[4] + m[8] * m[8], xy = m[0] * m[1] + m[4] * m[5] + m[8] * m[9];
    const float yy = m[1] * m[1] + m[5] * m[5] + m[9] * m[9], yz = m[1] * m[2] + m[5] * m[6] + m[9] * m[10];
    const float zz = m[2] * m[2] + m[6] * m[6] + m[10] * m[10], zx = m[2] * m[0] + m[6] * m[4] + m[10] * m[8];
    const float a = xy < 0.0f ? -xy : xy, b = yz < 0.0f ? -yz : yz, c = zx < 0.0f ? -zx : zx;
    const float x = xx + (c + a), y = yy + (a + b), z = zz + (b + c);
    const float most = x > y ? x : y;
    return noh_sqrt(most > z ? most : z);
}

/* Bring v to length 1; a vector too short to have a direction becomes `fallback`. */
static inline void noh_normalize3(float v[3], const float fallback[3])
{
    float square = noh_dot3(v, v);
    if (square > 1e-30f) {
        float inverse = 1.0f / noh_sqrt(square);
        v[0] *= inverse;
        v[1] *= inverse;
        v[2] *= inverse;
    } else {
        v[0] = fallback[0];
        v[1] = fallback[1];
        v[2] = fallback[2];
    }
}

#endif
