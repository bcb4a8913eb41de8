/* skin_palette.h: from poses to the matrices that a skinned mesh is drawn with, for any skin of any pack.
 *
 *   noh_character_skin   what a character shows in this frame
 *   noh_pose_skin        a pose, without a character
 *   noh_skin_skeleton    optional: moves the product with the inverse bind matrices from frames to updates
 *
 * All give skin order: matrix k belongs to skin->joints[k], as noh_gl_skin_set_matrices, noh_skin_vertices and
 * noh_skin_box take them. A skin may hold one joint several times, each time with another inverse bind matrix (rigid
 * parts that the converter joined), and two skins may bind one joint in different ways: skeletons of packs therefore
 * have no inverse bind matrices, skins have.
 *
 * Threads: as character.h. noh_pose_skin and noh_skin_skeleton write only to what they are given. */
#ifndef NOH_CHARACTER_SKIN_PALETTE_H
#define NOH_CHARACTER_SKIN_PALETTE_H

#include "stage/character/character.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The skin's matrices as the character shows them in this frame, once it was updated.
 * shapes  matrices[skin's joint_count][12]
 * ranges  a skin of the skeleton that the character is updated with; if that skeleton has inverse bind matrices, they
 *         must be this skin's (noh_skin_skeleton) */
void noh_character_skin(const noh_character *ch, const noh_skin *skin, float *matrices);

/* The skin's matrices of a local pose.
 * shapes  pose[the skeleton's joint_count]; model[the skeleton's joint_count][12]: the joints' model-space matrices
 *         afterwards; matrices[skin's joint_count][12] */
void noh_pose_skin(const noh_skeleton *skeleton, const noh_skin *skin, const noh_transform *pose, float *model,
                   float *matrices);

/* Give a skeleton the inverse bind matrices of a skin, where only meshes of this skin are drawn. Updates then multiply
 * by them, and noh_character_skin only mixes and gathers. Where the skin holds a joint twice no such matrices exist:
 * `out` is then the skeleton without any, which noh_character_skin takes as well.
 * shapes   inverse_bind[the skeleton's joint_count][12], borrowed by `out`; out may be skeleton
 * returns  1: `out` has inverse bind matrices; 0: it has none */
int noh_skin_skeleton(const noh_skin *skin, const noh_skeleton *skeleton, float *inverse_bind, noh_skeleton *out);

#ifdef __cplusplus
}
#endif

#endif
