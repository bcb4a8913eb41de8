/* recipe_internal.h: the private part of face.h. */
#ifndef NOH_FACE_RECIPE_INTERNAL_H
#define NOH_FACE_RECIPE_INTERNAL_H

#include "noh/face.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the recipe in a pack (`noh build --recipe`) as a table. Skips rows of unknown channels.
 * shapes  rows[row_max]; they refer to the pack's strings
 * errors  NOT_FOUND the pack has none; MEMORY more rows than row_max (need: the count). *recipe is then unchanged */
noh_result noh_face_recipe_of_pack(const noh_pack *pack, noh_face_row *rows, uint32_t row_max, noh_face_recipe *recipe,
                                   noh_error *error);

/* Apply the rules to channels made with NOH_MOUTH_NONE. moves, shut: how much speech from a clip moves and closes the
 * mouth in addition to the channels' own visemes, 0..1. */
void noh_face_share(const noh_face_rules *rules, float moves, float shut, float *channels);

#ifdef __cplusplus
}
#endif

#endif
