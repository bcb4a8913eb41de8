/* lod_pack.h: LOD tables from packs.
 *
 * The converter measures the errors of each mesh level, of fewer influences, and of each clip with fewer joints and at
 * lower update rates. These functions convert them to metres and combine them for the clips of a set. The error of a
 * mesh level is its largest (at rest, with targets, in clips) plus the movement by targets that the level drops. Joint
 * levels come from the set's skeleton, each with the largest error of all clips.
 *
 * Threads: as lod.h; filling a table reads the set and its packs and writes only to the memory given. */
#ifndef NOH_CHARACTER_LOD_PACK_H
#define NOH_CHARACTER_LOD_PACK_H

#include "motion/bank/clip_bank.h"
#include "stage/character/lod.h"
#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_lod_pack_desc {
    const noh_clip_bank *set;           /* required */
    const noh_clip_bank_desc *set_desc; /* the desc of the set; required */
    /* the drawn mesh, at the finest loaded level: a mesh of set_desc->mesh that the set's skeleton moves, or a rigid
     * one; default (NULL) unknown: no mesh levels, no radii */
    const noh_mesh *mesh;
    const float *weights; /* [target_count of the mesh] as in noh_mesh_add_joint_radii; default (NULL) 1 each */
} noh_lod_pack_desc;

/* An LOD table and radii. The arrays are in the memory passed to init; the packs are no longer needed. */
typedef struct noh_lod_pack {
    noh_lod_table table; /* clip_error_m is the clips' compression bound, at their shell distance */
    /* [joint_count of the skeleton] joint radii of the mesh, for noh_character_update; NULL without a skinned mesh. Add
     * other drawn meshes with noh_mesh_add_joint_radii */
    float *joint_radius_m;
    /* [target_count of the mesh] radius of each target at weight 1, for noh_lod_targets; NULL without a mesh */
    float *radius_m;
} noh_lod_pack;

/* Fill only the mesh levels of a table, for your own table, or for a mesh that no clip moves. Level numbers are the
 * same everywhere (the pack, this table, noh_gl_mesh_lod, noh_gl_morph_set_lod): 0 is the full mesh, loaded or not.
 * error_m is the level's largest error in any pose plus the movement by targets that it drops, in metres.
 * shapes  levels[NOH_LOD_LEVELS_MAX], borrowed by the table; mesh: at the finest loaded level */
void noh_lod_mesh_levels(const noh_mesh *mesh, noh_lod_mesh *levels, noh_lod_table *table);

/* Get the radius of each target, its largest displacement at weight 1 in metres, for noh_lod_targets.
 * shapes  radius_m[target_count] */
void noh_lod_target_radii(const noh_mesh *mesh, float *radius_m);

/* Exact bytes; 0 for an invalid desc. Only clips.clip_count and skeleton.joint_count of the set are read, so before a
 * set exists, pass a zeroed one with these two counts from noh_clip_bank_needs.shape. */
size_t noh_lod_pack_size(const noh_lod_pack_desc *desc);

/* Fill a table.
 *
 * A clip built without a mesh has errors of points at a shell distance from the joints. For a mesh with larger radii
 * they are scaled up in proportion: safe, but several times too high. Build clips together with their mesh (noh build
 * BODY MOVES, also with --only anim), or measure them at load time (joint_lod.h, time_lod.h).
 *
 * A clip built with its mesh has exact errors of a few hundred vertices at each update rate; vertices between them may
 * have slightly larger errors (noh_time_lod_points_measure). These errors assume that the set extracts root motion: the
 * jump at the end of a travelling loop is not counted. A clip built for a skeleton of other proportions may have other
 * joint levels: a joint level without an error for every clip is omitted, with all coarser ones.
 * errors  ARG a field of desc, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the exact
 *         bytes) */
noh_result noh_lod_pack_init(void *memory, size_t bytes, const noh_lod_pack_desc *desc, noh_lod_pack *lod,
                             noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
