/* lod_pack.h: a LOD table filled in from packs.
 *
 * The converter measured the error of each mesh level, of fewer influences, and of each clip with fewer joints and at
 * lower update rates. Here these errors become metres and are combined for the clips of a set. The error of a mesh
 * level is its worst one (at rest, with targets, in clips) plus what the targets that the level leaves out could move.
 * Joint levels are those of the set's skeleton, each with the worst error of all clips.
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
    const noh_clip_bank_desc *set_desc; /* the desc of that set; required */
    /* the mesh that is drawn, at the finest level that is loaded: one of set_desc->mesh that the set's skeleton moves,
     * or a rigid one; default (NULL) unknown: no LOD levels of the mesh, no radii */
    const noh_mesh *mesh;
    const float *weights; /* [the mesh's target_count] as noh_mesh_add_joint_radii takes them; default (NULL) 1 each */
} noh_lod_pack_desc;

/* Its arrays lie in the memory given; the packs are no longer needed. */
typedef struct noh_lod_pack {
    noh_lod_table table; /* clip_error_m is the clips' own bound, at their shell distance */
    /* [the skeleton's joint_count] the mesh's joint radii, for noh_character_update; NULL without a skinned mesh. Add
     * other meshes that are drawn by noh_mesh_add_joint_radii */
    float *joint_radius_m;
    /* [the mesh's target_count] each target's radius at weight 1, for noh_lod_targets; NULL without a mesh */
    float *radius_m;
} noh_lod_pack;

/* Fill only the mesh levels of a table: for a table of your own, or for a mesh that no clip moves. Levels have the same
 * numbers everywhere (the pack, this table, noh_gl_mesh_lod, noh_gl_morph_set_lod): 0 is the full mesh, loaded or not.
 * error_m is a level's worst error in any pose plus what the targets that it leaves out can add, in metres.
 * shapes  levels[NOH_LOD_LEVELS_MAX], borrowed by the table; mesh: at the finest level that is loaded */
void noh_lod_mesh_levels(const noh_mesh *mesh, noh_lod_mesh *levels, noh_lod_table *table);

/* Each target's radius: the largest displacement at weight 1, metres; for noh_lod_targets.
 * shapes  radius_m[target_count] */
void noh_lod_target_radii(const noh_mesh *mesh, float *radius_m);

/* Exact bytes; 0 for an impossible desc. Of the set only clips.clip_count and skeleton.joint_count are read, so before
 * there is a set, a zeroed one with the two counts of noh_clip_bank_needs.shape will do. */
size_t noh_lod_pack_size(const noh_lod_pack_desc *desc);

/* Fill a table.
 *
 * A clip built without a mesh has the errors of points at a shell distance from the joints. For a mesh whose radii are
 * larger they are scaled up in proportion: safe, but several times too high. Build clips together with their mesh (noh
 * build BODY MOVES, also with --only anim), or measure them at load time (joint_lod.h, time_lod.h).
 *
 * A clip built with its mesh has the exact errors of some hundred vertices at each update rate; the vertices in between
 * may be off by a little more (noh_time_lod_points_measure). Those errors assume that the set extracts root motion: the
 * jump at the seam of a clip that travels is not counted. A clip built for a skeleton of other proportions may have
 * other joint levels: a joint level that some clip has no error for is left out, and so are all coarser ones.
 * errors  ARG the field of desc, or memory NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small; need: the exact
 * bytes */
noh_result noh_lod_pack_init(void *memory, size_t bytes, const noh_lod_pack_desc *desc, noh_lod_pack *lod,
                             noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
