/* lod_internal.h: the private part of low_stage.h. */
#ifndef NOH_CHARACTER_LOD_INTERNAL_H
#define NOH_CHARACTER_LOD_INTERNAL_H

#include "noh/base.h"
#include "noh/low_stage.h"
#include "noh/noh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Call when the camera has jumped or the character was out of view: the next choice ignores the current levels and does
 * not fade. */
void noh_lod_cut(noh_lod *d);

/* Show one mesh level in full detail otherwise, regardless of error, for tools and debugging. For a level that is not
 * loaded or past the last, the nearest existing one is shown. The next noh_lod_choose does not fade. */
void noh_lod_set_mesh(noh_lod *d, const noh_lod_table *table, uint32_t level, float pixels_per_metre);

/* From the next choice on, take no finer mesh level than this one, because finer ones have no memory. 0:
 * no limit. mesh_wanted is still the level within the quality setting; error_m is for the level shown. */
void noh_lod_set_limit(noh_lod *d, uint32_t level);

/* The finest mesh level that needs memory: the finest of the level shown, the level a fade leaves, and the level
 * wanted. */
uint32_t noh_lod_finest(const noh_lod *d);

/* The total error in pixels, including targets. It is within the quality setting, unless the finest levels and the
 * clips themselves exceed it, or the scale grew too fast for the lead during a fade. */
float noh_lod_error_pixels(const noh_lod *d);

/* Joints to pose, and influences to use per vertex, at the chosen levels; 0: all, the table has no levels of the
 * kind. */
uint32_t noh_lod_joint_count(const noh_lod *d, const noh_lod_table *table);
uint32_t noh_lod_influence_count(const noh_lod *d, const noh_lod_table *table);

NOH_STATIC_ASSERT(sizeof(noh_lod) == 32, lod);

/* Check a table once before using it.
 * errors  DATA a count is 0, or an error is negative, not finite, or below the previous level's (where: the level); ARG
 *         a level count is over the limit, or an array is NULL */
noh_result noh_lod_table_check(const noh_lod_table *table, noh_error *error);

/* Check settings.
 * errors  ARG `what` names the field */
noh_result noh_lod_settings_check(const noh_lod_settings *settings, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
