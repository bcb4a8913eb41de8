/* skin_palette_internal.h: the private part of low_stage.h. */
#ifndef NOH_CHARACTER_SKIN_PALETTE_INTERNAL_H
#define NOH_CHARACTER_SKIN_PALETTE_INTERNAL_H

#include "noh/clip.h"
#include "noh/low_stage.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Give a skeleton the inverse bind matrices of a skin, if only meshes of this skin are drawn. Updates then multiply by
 * them, and noh_character_skin only blends and gathers. If the skin contains a joint twice, this is impossible: `out`
 * then has no inverse bind matrices, which noh_character_skin also accepts.
 * shapes   inverse_bind[joint_count of the skeleton][12], borrowed by `out`; out may be skeleton
 * returns  1: `out` has inverse bind matrices; 0: it has none */
int noh_skin_skeleton(const noh_skin *skin, const noh_skeleton *skeleton, float *inverse_bind, noh_skeleton *out);

#ifdef __cplusplus
}
#endif

#endif
