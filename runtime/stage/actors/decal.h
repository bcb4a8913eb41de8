/* marks.h: what the library keeps to itself of runtime/noh/marks.h. */
#ifndef NOH_ACTORS_DECAL_H
#define NOH_ACTORS_DECAL_H

#include "noh/marks.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is wrong with a ring that comes from outside, a constant text; NULL: it is good. */
const char *noh_decals_check(const noh_decals *decals);

/* 0..1, by its age. */
float noh_decal_alpha(const noh_decals *decals, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
