/* compiler.h: everything that depends on the compiler, each with a fallback in plain C.
 *
 *   NOH_PLAIN_C          define it to build without builtins, attributes, pragmas and SIMD, with any C99 compiler
 *   NOH_ALWAYS_INLINE    for a function that must be inlined to be fast
 *   NOH_NEVER_INLINE     before a function that is called from so many places that inlining it would cost kilobytes
 *   NOH_UNROLL           before a short loop over an array of registers
 *   NOH_TRAP             ends the program, without a library
 *   NOH_UNUSED           of a function that a file need not call
 *   NOH_AVX2, NOH_SSE2, NOH_NEON   which vector instructions the kernels may use; undefined: none
 *   noh_leading_zeros, noh_trailing_zeros   of a word that is not 0
 *
 * The fallbacks are always compiled, as noh_..._plain, so that a test can hold them equal to what replaces them.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_COMPILER_H
#define NOH_BASE_COMPILER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__) && !defined(NOH_PLAIN_C)
#define NOH_GNU 1 /* gcc, clang and those that follow them */
#endif

#if !defined(NOH_PLAIN_C)
#if defined(__AVX2__)
#define NOH_AVX2 1
#endif
#if defined(__SSE2__)
#define NOH_SSE2 1
#elif defined(__ARM_NEON) && defined(__aarch64__) /* 32-bit NEON flushes subnormals: other bits */
#define NOH_NEON 1
#endif
#endif

#if defined(NOH_GNU)
#define NOH_ALWAYS_INLINE static inline __attribute__((always_inline))
#define NOH_NEVER_INLINE __attribute__((noinline))
#define NOH_TRAP() __builtin_trap()
#define NOH_UNUSED __attribute__((unused))
#else
#define NOH_ALWAYS_INLINE static inline
#define NOH_NEVER_INLINE
#define NOH_TRAP() ((void)(*(volatile char *)0 = 0))
#define NOH_UNUSED
#endif

/* gcc's -O2 leaves short loops over arrays of lanes as they are, in memory; unrolled they stay in registers. */
#if defined(NOH_GNU) && !defined(__clang__)
#define NOH_UNROLL _Pragma("GCC unroll 8")
#else
#define NOH_UNROLL
#endif

static inline uint32_t noh_leading_zeros_plain(uint32_t word)
{
    uint32_t zeros = 0;
    while (!(word & 0x80000000u)) {
        word <<= 1;
        zeros++;
    }
    return zeros;
}

static inline uint32_t noh_trailing_zeros_plain(uint64_t word)
{
    uint32_t zeros = 0;
    while (!(word & 1u)) {
        word >>= 1;
        zeros++;
    }
    return zeros;
}

/* How many zero bits lie above the highest set bit.
 * ranges  word is not 0 */
static inline uint32_t noh_leading_zeros(uint32_t word)
{
#if defined(NOH_GNU)
    return (uint32_t)__builtin_clz(word);
#else
    return noh_leading_zeros_plain(word);
#endif
}

/* How many zero bits lie below the lowest set bit.
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
