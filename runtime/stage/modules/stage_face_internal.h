/* stage_face_internal.h: the faces of a kind and of its actors, a module of the stage. */
#ifndef NOH_STAGE_STAGE_FACE_INTERNAL_H
#define NOH_STAGE_STAGE_FACE_INTERNAL_H

#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_STAGE_SHUT 16384.0f /* noh_stage_face.shut of 1, less 1 */
#define NOH_STAGE_WHOLE 3.0f    /* an override by an expression that shows whole or not at all */

typedef enum noh_stage_looks { NOH_LOOKS_AHEAD = 0, NOH_LOOKS_AT_POINT, NOH_LOOKS_AT_ACTOR } noh_stage_looks;

/* State of an actor. */
typedef struct noh_stage_face {
    noh_face face;
    int64_t clock; /* tick of the stage's clock that it is at */
    float point[3];
    uint32_t target; /* id of an actor */
    float visemes[NOH_VISEME_COUNT];
    float open, mean, quiet, said; /* of live shapes: how far they open, now and lately; seconds of silence; 1: begun */
    uint8_t looks, says, begun;    /* noh_stage_looks */
    uint8_t fresh;                 /* 1: what it looks at is new: reached by a saccade */
    uint16_t
        shut[NOH_IDENTITY_CLOSINGS]; /* of noh_stage_face_kind.lids: 1 + (weight at which it is shut) * 16,384; 0: 1 */
} noh_stage_face;

NOH_STATIC_ASSERT(sizeof(noh_stage_face) == NOH_ACTOR_FACE_BYTES, stage_face);

/* A joint that a face turns. */
typedef struct noh_stage_face_joint {
    uint32_t joint; /* NOH_NONE: none */
    float axes[4];  /* from model space at rest to the joint's own axes */
    float at[3];    /* at rest, model space */
} noh_stage_face_joint;

/* What a kind's actors share. */
typedef struct noh_stage_face_kind {
    noh_face_desc desc; /* neck space */
    noh_face_rules rules;
    noh_stage_face_joint head, neck, chest, eyes[2];
    float middle[3]; /* between the eyes at rest, model space */
    uint32_t flags;
    uint32_t speech, lips_shut; /* floats of clips; NOH_NONE: no clip has them */
    uint32_t speaks[4];         /* the same: fields of noh_face_speech */
    noh_face_link
        *links; /* to floats of the set; then override_count of expressions: `channel` is the user of the face,
                           * `target` the expression's float, `weight` a noh_override, or NOH_STAGE_WHOLE */
    uint32_t lids[NOH_IDENTITY_CLOSINGS]; /* floats that blinks move; NOH_NONE past the last */
    uint32_t shuts[2]; /* floats of targets that shut both eyes and that no channel moves; NOH_NONE: none */
    uint32_t link_count;
    uint16_t override_count;
    uint8_t lids_follow; /* 1: some target is linked to NOH_CHANNEL_LIDS_DOWN */
    uint8_t looks_down;  /* 1: some target is linked to looks down, and those move lids, too */
} noh_stage_face_kind;

/* NULL: the kind has no faces. */
static inline const noh_stage_face_kind *noh_stage_face_kind_of(const noh_stage_kind *k)
{
    return k->modules[NOH_SLOT_FACE].shared;
}

/* The state of an actor's face; the kind has one. */
static inline noh_stage_face *noh_stage_face_of(const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_module *m = &k->modules[NOH_SLOT_FACE];
    return (noh_stage_face *)(void *)(m->states + index * m->stride);
}

/* The face of an actor for a change; NULL after *result. */
noh_stage_face *noh_stage_change_face(noh_stage *s, noh_actor actor, noh_stage_kind **kind, noh_result *result,
                                      noh_error *error);
/* Links by the recipes of the kind's face, or else (face NULL, too) the pack's own and those that are built in. */
uint32_t noh_stage_face_bind(const noh_kind_desc *kind, noh_face_find_fn find, const void *user, noh_face_link *links,
                             uint32_t link_max);
/* Where the joints of its eyes are at rest, model space; 0: there are none. *head: z of its head's joint, unchanged
 * without one. */
int noh_stage_face_eye_joints(const noh_kind_desc *kind, float eyes[2][3], float *head);
uint32_t noh_stage_face_links(const noh_kind_desc *kind); /* an upper bound */
void noh_stage_run_face(noh_modifier_work *w);            /* over the pose and the floats of the work */
/* noh_module_type.turn */
void noh_stage_turn_head(const noh_stage_kind *k, uint32_t index, float rotation[4], float at[3]);

#ifdef __cplusplus
}
#endif

#endif
