/* recipe_internal.h: the private part of face.h. */
#ifndef NOH_FACE_RECIPE_INTERNAL_H
#define NOH_FACE_RECIPE_INTERNAL_H

#include "noh/face.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Apply the rules to channels made with NOH_MOUTH_NONE. moves, shut: how much speech from a clip moves and closes the
 * mouth in addition to the channels' own visemes, 0..1. */
void noh_face_share(const noh_face_rules *rules, float moves, float shut, float *channels);

/* Users of a face that an expression may override: noh_face_rules.lids, .eyes and .speech. */
#define NOH_FACE_USERS 3u

/* Scale the channels of a user. */
void noh_face_scale_user(uint32_t user, float by, float *channels);

/* The user that a row of a recipe overrides; NOH_NONE: it is another row. */
uint32_t noh_recipe_overrides(const noh_pack *pack, const noh_recipe_row *row, noh_override *how);

/* The emotion that looks most like one for which a face may have no targets, as VRM's have none for fear;
 * NOH_EMOTION_COUNT: none does. */
uint32_t noh_emotion_like(uint32_t emotion);

/* Find the emotions that show the targets of noh_emotion_like, since the recipes bind none of their own: bit e for
 * emotion e. Arguments as for noh_face_recipe_bind_by. */
uint32_t noh_face_taken(const noh_face_recipe *const *recipes, uint32_t recipe_count, noh_face_find_fn find,
                        const void *user);

/* Give the taken emotions the rules of those whose targets they show, except those for which the pack has a rule.
 * taken  bit e for emotion e; noh_face_taken
 * rules  as noh_face_rules_of_pack read them from the pack */
void noh_face_share_rules(const noh_pack *pack, uint32_t taken, noh_face_rules *rules);

/* As noh_weight_rules_bind, but of expressions alone. */
uint32_t noh_expressions_bind(const noh_mesh *mesh, noh_weight_rule *rules, uint32_t rule_max);

#ifdef __cplusplus
}
#endif

#endif
