/* modifier_internal.h: the private part of modules.h. */
#ifndef NOH_STAGE_MODIFIER_INTERNAL_H
#define NOH_STAGE_MODIFIER_INTERNAL_H

#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_MODIFIER_FULL_DETAIL 1e9f

#ifdef __cplusplus
}
#endif

#endif
