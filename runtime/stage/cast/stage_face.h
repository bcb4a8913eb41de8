/* modules.h: what the library keeps to itself of runtime/noh/modules.h. */
#ifndef NOH_STAGE_STAGE_FACE_H
#define NOH_STAGE_STAGE_FACE_H

#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ACTOR_FACE_BYTES 336u

#ifdef __cplusplus
}
#endif

#endif
