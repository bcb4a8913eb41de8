/* version.h: which noh this is. Semantic versioning; below 1.0.0 a new minor version may change the interface. The
 * format of packs has a version of its own, NOH_PACK_VERSION (format.h).
 *
 * Threads: no state; any thread. */
#ifndef NOH_BASE_VERSION_H
#define NOH_BASE_VERSION_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_VERSION_MAJOR 0
#define NOH_VERSION_MINOR 2
#define NOH_VERSION_PATCH 0
#define NOH_VERSION "0.2.0"

/* A version as one number, so that later versions compare greater; packs store it. 8 bits major, 12 minor, 12 patch. */
#define NOH_VERSION_NUMBER(major, minor, patch) ((uint32_t)(major) << 24 | (uint32_t)(minor) << 12 | (uint32_t)(patch))

/* The version of the library that is linked, "0.2.0"; a program compares it with the NOH_VERSION of its headers. */
const char *noh_version(void);

/* The same as a number. */
uint32_t noh_version_number(void);

#ifdef __cplusplus
}
#endif

#endif
