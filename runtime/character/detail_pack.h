/* detail_pack.h: a detail table out of packs (row C16.4).
 *
 * The converter measured what each level of a mesh is off, what fewer influences are, and what each clip is with fewer
 * joints and at lower rates; here that is brought to metres and joined for the motions of a set. Mesh levels have the
 * worst of their errors, at rest, with targets and in motion, and what the targets that they do without move. Joint levels
 * are those of the set's skeleton, each with the worst error of all its motions. */
#ifndef NOH_CHARACTER_DETAIL_PACK_H
#define NOH_CHARACTER_DETAIL_PACK_H

#include "anim/motion_set.h"
#include "character/detail.h"
#include "mesh/mesh.h"

typedef struct noh_detail_pack_desc {
    const noh_motion_set *set;            /* required */
    const noh_motion_set_desc *set_desc;  /* that it was made by; required */
    const noh_mesh *mesh;                 /* what is drawn, at the finest level that is loaded: a mesh of set_desc->mesh that the set's
                                           * skeleton moves, or a rigid one; default (NULL) not known: no mesh levels, no margins */
    const float *weights;                 /* [the mesh's target_count] as noh_margins_add has them; default (NULL) 1 each */
} noh_detail_pack_desc;

/* Lies in the memory; nothing of the packs is needed any more. */
typedef struct noh_detail_pack {
    noh_detail_table table; /* clip_error_m is what the clips certify at their own shell distance */
    float *margin_m;        /* [the skeleton's joint_count] of the mesh, for noh_character_update; NULL without a skinned mesh. Add
                             * others that are drawn by noh_margins_add */
    float *reach_m;         /* [the mesh's target_count] what each target moves at most at weight 1, for noh_detail_targets; NULL without
                             * a mesh */
} noh_detail_pack;

/* Fill only the mesh levels of a table: for a table of your own, or for a mesh that no clip moves. Levels have the same
 * numbers everywhere (the pack, this table, noh_gl_mesh_level, noh_gl_morph_level): 0 is the full mesh, loaded or not.
 * error_m is a level's worst error in any pose plus what the targets that it leaves out can add; metres.
 * shapes   levels[NOH_DETAIL_LEVELS_MAX], borrowed by the table; mesh: at the finest level that is loaded */
void noh_detail_mesh_levels(const noh_mesh *mesh, noh_mesh_level *levels, noh_detail_table *table);

/* What each target moves at most at weight 1, metres, for noh_detail_targets.
 * shapes  reach_m[target_count] */
void noh_detail_target_reach(const noh_mesh *mesh, float *reach_m);

/* Exact bytes; 0 for an impossible desc. Of the set only anim.motion_count and skeleton.joint_count are read: before there
 * is one, zeros with the counts of noh_motion_set_needs.shape do. */
size_t noh_detail_pack_size(const noh_detail_pack_desc *desc);

/* Fill a table.
 * A clip that was built without a mesh has the errors of points at a shell distance. With a mesh they are
 * multiplied by how much farther its margins reach: safe, but several times too high. Build clips together with
 * their mesh (noh build BODY MOVES, also with --only anim), or measure them when you load (joint_lod.h, time_lod.h).
 * Rates of a clip that was built with its mesh are what some hundred of its vertices are off, exactly; what lies between
 * them may be a little more (noh_time_points_measure).
 * Rates are for sets that take out what root motion there is: the leap of a loop that travels is not counted.
 * Where clips were built for a skeleton of other proportions, levels may differ: a level that no level of a clip
 * vouches for is left out, and those after it.
 * memory  16-byte aligned
 * errors  ARG the field of desc, named; MEMORY need: the bytes */
noh_result noh_detail_pack_init(void *memory, size_t bytes, const noh_detail_pack_desc *desc, noh_detail_pack *detail, noh_error *error);

#endif
