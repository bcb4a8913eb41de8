/* lod_pack_internal.h: the private part of low_stage.h. */
#ifndef NOH_CHARACTER_LOD_PACK_INTERNAL_H
#define NOH_CHARACTER_LOD_PACK_INTERNAL_H

#include "noh/low_stage.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fill only the mesh levels of a table, for your own table, or for a mesh that no clip moves. Level numbers are the
 * same everywhere (the pack, this table, noh_gl_mesh_lod, noh_gl_morph_set_lod): 0 is the full mesh, loaded or not.
 * error_m is the level's largest error in any pose plus the movement by targets that it drops, in metres.
 * shapes  levels[NOH_LOD_LEVELS_MAX], borrowed by the table; mesh: at the finest loaded level */
void noh_lod_mesh_levels(const noh_mesh *mesh, noh_lod_mesh *levels, noh_lod_table *table);

/* Get the radius of each target, its largest displacement at weight 1 in metres, for noh_lod_targets.
 * shapes  radius_m[target_count] */
void noh_lod_target_radii(const noh_mesh *mesh, float *radius_m);

#ifdef __cplusplus
}
#endif

#endif
