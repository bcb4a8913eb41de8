/* compiler_internal.h: all compiler-dependent definitions, each with a fallback in plain C.
 *
 *   NOH_PLAIN_C          define it to build without builtins, attributes, pragmas and SIMD, with any C99 compiler
 *   NOH_ALWAYS_INLINE    for a function that must be inlined to be fast
 *   NOH_NEVER_INLINE     for a function with many callers, where inlining would cost kilobytes
 *   NOH_UNROLL           before a short loop over an array of registers
 *   NOH_TRAP             ends the program, without a library
 *   NOH_UNUSED           for a function that a file may leave unused
 *   NOH_PAGE             1: for a program that is one small stage, as the web page: no worlds for springs, no stages
 *                        that share, no clips or levels of textures by need, no checks of states that others made
 *   NOH_AVX2, NOH_SSE2, NOH_NEON   which vector instructions the kernels may use; undefined: none
 *   noh_leading_zeros, noh_trailing_zeros   of a nonzero word
 *
 * The fallbacks are always compiled, as noh_..._plain, so that tests can compare them with the builtins.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_COMPILER_INTERNAL_H
#define NOH_BASE_COMPILER_INTERNAL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef NOH_PAGE
#define NOH_PAGE 0
#endif

#if defined(__GNUC__) && !defined(NOH_PLAIN_C)
#define NOH_GNU 1 /* gcc, clang and compatible compilers */
#endif

#if !defined(NOH_PLAIN_C)
#if defined(__AVX2__)
#define NOH_AVX2 1
#endif
#if defined(__SSE2__)
#define NOH_SSE2 1
#elif defined(__ARM_NEON) && defined(__aarch64__) /* 32-bit NEON flushes subnormals, which changes bits */
#define NOH_NEON 1
#endif
#endif

#if defined(NOH_GNU)
#define NOH_ALWAYS_INLINE static inline __attribute__((always_inline))
#define NOH_NEVER_INLINE __attribute__((noinline))
#define NOH_TRAP() __builtin_trap()
#define NOH_UNUSED __attribute__((unused))
#define NOH_COLD __attribute__((cold)) /* compiled for size, also at -O2 */
#else
#define NOH_ALWAYS_INLINE static inline
#define NOH_NEVER_INLINE
#define NOH_TRAP() ((void)(*(volatile char *)0 = 0))
#define NOH_UNUSED
#define NOH_COLD
#endif

/* At -O2 gcc keeps short loops over arrays of lanes in memory; unrolled they stay in registers. */
#if defined(NOH_GNU) && !defined(__clang__)
#define NOH_UNROLL _Pragma("GCC unroll 8")
#else
#define NOH_UNROLL
#endif

static inline NOH_UNUSED uint32_t noh_leading_zeros_plain(uint32_t word)
{
    uint32_t zeros = 0;
    while (!(word & 0x80000000u)) {
        word <<= 1;
        zeros++;
    }
    return zeros;
}

static inline NOH_UNUSED uint32_t noh_trailing_zeros_plain(uint64_t word)
{
    uint32_t zeros = 0;
    while (!(word & 1u)) {
        word >>= 1;
        zeros++;
    }
    return zeros;
}

/* Count the zero bits above the highest set bit.
 * ranges  word is not 0 */
static inline uint32_t noh_leading_zeros(uint32_t word)
{
#if defined(NOH_GNU)
    return (uint32_t)__builtin_clz(word);
#else
    return noh_leading_zeros_plain(word);
#endif
}

/* Count the zero bits below the lowest set bit.
 * ranges  word is not 0 */
static inline uint32_t noh_trailing_zeros(uint64_t word)
{
#if defined(NOH_GNU)
    return (uint32_t)__builtin_ctzll(word);
#else
    return noh_trailing_zeros_plain(word);
#endif
}

#ifdef __cplusplus
}
#endif

#endif
