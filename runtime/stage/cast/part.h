/* modules.h: what the library keeps to itself of runtime/noh/modules.h. */
#ifndef NOH_STAGE_PART_H
#define NOH_STAGE_PART_H

#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PART_FULL_DETAIL 1e9f

#ifdef __cplusplus
}
#endif

#endif
