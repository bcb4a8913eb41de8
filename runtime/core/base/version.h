/* version.h: the version of noh. Semantic versioning; below 1.0.0 a new minor version may change the interface. The
 * pack format has its own version, NOH_PACK_VERSION (format.h).
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

/* A version as one number that grows with the version; packs store it. 8 bits major, 12 minor, 12 patch. */
#define NOH_VERSION_NUMBER(major, minor, patch) ((uint32_t)(major) << 24 | (uint32_t)(minor) << 12 | (uint32_t)(patch))

/* The version of the linked library, "0.2.0", to be compared with NOH_VERSION of the headers. */
const char *noh_version(void);

/* The version of the linked library, as NOH_VERSION_NUMBER. */
uint32_t noh_version_number(void);

#ifdef __cplusplus
}
#endif

#endif
