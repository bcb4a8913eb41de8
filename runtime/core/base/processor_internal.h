/* processor_internal.h: what the processor can that the compiler may not take for granted.
 *
 * The instruction cpuid leaves a virtual machine, which takes microseconds: ask when an object is made and keep the
 * answer in it, not in each frame.
 * source  Intel 64 and IA-32 Architectures Software Developer's Manual, volume 1, chapter 14.7.1: AVX2 may be used
 *         where the processor has it, and the operating system saves its registers
 * Threads: no state; any thread. */
#ifndef NOH_BASE_PROCESSOR_INTERNAL_H
#define NOH_BASE_PROCESSOR_INTERNAL_H

#include "core/base/compiler_internal.h"

/* Where AVX2 is not compiled in as a whole, the compiler can make single functions of it. */
#if defined(NOH_GNU) && defined(__x86_64__) && defined(NOH_SSE2) && !defined(NOH_AVX2)
#define NOH_AVX2_AT_RUN_TIME 1
#define NOH_TARGET_AVX2 __attribute__((target("avx2")))
#else
#define NOH_TARGET_AVX2
#endif

#if defined(NOH_AVX2_AT_RUN_TIME)
static inline void noh_cpuid(uint32_t leaf, uint32_t out[4])
{
    __asm__ volatile("cpuid" : "=a"(out[0]), "=b"(out[1]), "=c"(out[2]), "=d"(out[3]) : "a"(leaf), "c"(0));
}

/* __builtin_cpu_supports would link a table of libgcc that is filled in before main. */
static inline int noh_processor_has_avx2(void)
{
    const uint32_t saves_and_has_avx = 3u << 27, avx2 = 1u << 5, xmm_and_ymm = 6u;
    uint32_t r[4], saved, high;
    noh_cpuid(0, r);
    if (r[0] < 7u) return 0;
    noh_cpuid(1, r);
    if ((r[2] & saves_and_has_avx) != saves_and_has_avx) return 0;
    __asm__ volatile("xgetbv" : "=a"(saved), "=d"(high) : "c"(0));
    if ((saved & xmm_and_ymm) != xmm_and_ymm) return 0;
    noh_cpuid(7, r);
    return (r[1] & avx2) != 0;
}
#else
static inline int noh_processor_has_avx2(void)
{
    return 0;
}
#endif

#endif
