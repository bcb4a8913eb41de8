/* decal_internal.h: the private part of marks.h. */
#ifndef NOH_ACTORS_DECAL_INTERNAL_H
#define NOH_ACTORS_DECAL_INTERNAL_H

#include "noh/marks.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 0..1, from the age of the decal. */
float noh_decal_alpha(const noh_decals *decals, uint32_t index);

/* Check a ring from an untrusted source. Returns a constant text that says what is wrong; NULL: nothing. */
const char *noh_decals_check(const noh_decals *decals);

#ifdef __cplusplus
}
#endif

#endif
