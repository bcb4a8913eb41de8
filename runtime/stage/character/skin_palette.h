/* skin_palette.h: skinning matrices from poses, for any skin of any pack.
 *
 *   noh_character_skin   matrices of a character in this frame
 *   noh_pose_skin        matrices of a pose, without a character
 *   noh_skin_skeleton    optional: applies the inverse bind matrices once per update instead of once per frame
 *
 * Matrices are in skin order: matrix k belongs to skin->joints[k], as for noh_gl_skin_set_matrices, noh_skin_vertices
 * and noh_skin_box. A skin may contain a joint several times with different inverse bind matrices (rigid parts that the
 * converter joined), and two skins may bind one joint differently. Inverse bind matrices therefore belong to skins, not
 * to the skeletons of packs.
 *
 * Threads: as character.h. noh_pose_skin and noh_skin_skeleton write only to their arguments. */
#ifndef NOH_CHARACTER_SKIN_PALETTE_H
#define NOH_CHARACTER_SKIN_PALETTE_H

#include "stage/character/character.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the skin's matrices of a character in this frame, after an update.
 * shapes  matrices[joint_count of the skin][12]
 * ranges  skin: of the skeleton that updates the character; if the skeleton has inverse bind matrices, they must be
 *         this skin's (noh_skin_skeleton) */
void noh_character_skin(const noh_character *ch, const noh_skin *skin, float *matrices);

/* Get the skin's matrices of a local pose.
 * shapes  pose[joint_count of the skeleton]; model[joint_count of the skeleton][12]: receives the joints' model-space
 *         matrices; matrices[joint_count of the skin][12] */
void noh_pose_skin(const noh_skeleton *skeleton, const noh_skin *skin, const noh_transform *pose, float *model,
                   float *matrices);

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
