/* assert_internal.h: checks for bugs of the caller, in two tiers; never for file bytes.
 *
 *   NOH_ASSERT    cheap: a null pointer, an index past a count
 *   NOH_VALIDATE  costly: walks a whole structure
 *
 * NOH_ASSERT_LEVEL 0 (default) compiles neither, 1 the cheap ones (debug builds), 2 both (tests). A failed check calls
 * NOH_ASSERT_FAILED(condition, file, line), which a build may define; by default it traps, because the library links
 * nothing that prints.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_ASSERT_INTERNAL_H
#define NOH_BASE_ASSERT_INTERNAL_H

#include "core/base/compiler_internal.h"

#ifndef NOH_ASSERT_LEVEL
#define NOH_ASSERT_LEVEL 0
#endif

#ifndef NOH_ASSERT_FAILED
#define NOH_ASSERT_FAILED(condition, file, line) NOH_TRAP()
#endif

#if NOH_ASSERT_LEVEL >= 1
#define NOH_ASSERT(condition) ((condition) ? (void)0 : NOH_ASSERT_FAILED(#condition, __FILE__, __LINE__))
#else
#define NOH_ASSERT(condition) ((void)0)
#endif

#if NOH_ASSERT_LEVEL >= 2
#define NOH_VALIDATE(condition) NOH_ASSERT(condition)
#else
#define NOH_VALIDATE(condition) ((void)0)
#endif

#endif
