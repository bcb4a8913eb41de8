/* recipe_internal.h: the private part of face.h. */
#ifndef NOH_FACE_RECIPE_INTERNAL_H
#define NOH_FACE_RECIPE_INTERNAL_H

#include "noh/face.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Apply the rules to channels made with NOH_MOUTH_NONE. moves, shut: how much speech from a clip moves and closes the
 * mouth in addition to the channels' own visemes, 0..1. */
void noh_face_share(const noh_face_rules *rules, float moves, float shut, float *channels);

#ifdef __cplusplus
}
#endif

#endif
