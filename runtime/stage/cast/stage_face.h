/* stage_face.h: faces of actors: they blink, look, feel, breathe, and are never still.
 *
 *   noh_kind_desc.face        what faces of a kind have in common: one line makes its actors alive
 *   noh_kind_find_eyes        where its eyes are, where no joints say so
 *   noh_actor_look_at         a point of the world; noh_actor_look_at_actor: another actor's eyes
 *   noh_actor_set_emotion     an emotion by name: comes, holds and goes
 *   noh_actor_set_activity    resting, talking, reading
 *   noh_actor_set_visemes     mouth shapes that come live, of an ear or a network
 *   noh_actor_set_face_flags  calm, or without one of the things that a face does by itself
 *   noh_actor_seed_face       another person
 *   noh_actor_set_identity    a person of identity.h
 *   noh_actor_blink           now
 *   noh_actor_face            what shows
 *
 * A face moves what the kind has: morph targets by recipes (recipe.h), and joints of head, neck, chest and eyes by
 * name. It is a part of the pose (part.h) that comes before the parts of the game: over what clips say, below floats
 * that are held. A clip of speech (noh speak) tells it how much of the mouth is taken, by its named floats "speech" and
 * "lips-shut": an emotion leaves the mouth as far as it says.
 *
 * All of it is state of the stage: 336 bytes an actor (NOH_ACTOR_FACE_BYTES), saved, restored, forked and hashed. A
 * face out of view rests, and goes on when it is seen again. Errors: NOT_FOUND the actor is gone; ARG its kind has no
 * face, or a value is out of range. */
#ifndef NOH_STAGE_STAGE_FACE_H
#define NOH_STAGE_STAGE_FACE_H

#include "life/face/identity.h"
#include "life/face/recipe.h"
#include "stage/cast/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ACTOR_FACE_BYTES 336u

/* Zero is a good value for all where the kind has joints for its eyes. Strings and recipes are read at init. */
typedef struct noh_kind_face {
    /* `eyes`: their centres in model space at rest, whatever the joints; both zero: where the joints of the eyes are */
    noh_face_desc face;
    const noh_face_recipe *const *recipes; /* [recipe_count] the best first; default (NULL) the pack's own, if it
                                            * brings one, then the three built in */
    uint32_t recipe_count;
    /* Joints; default (NULL) looked for under the names that they usually have, "": none. Without a head the eyes turn
     * alone */
    const char *head, *neck, *chest, *eyes[2];
    uint32_t flags; /* NOH_FACE_* of new actors */
    noh_face_rules rules;
} noh_kind_face;

/* Where the eyes of a kind are at rest, for noh_kind_face.face.eyes: the joints of the eyes; without these behind what
 * its recipes blink with, or turn eyes with: the middle of what moves on each side, 0.19 of their distance further in.
 * kind     mesh, skeleton, nodes and face (NULL: as zeros) as a stage would be given them
 * scratch  [scratch_bytes] aligned to NOH_MEMORY_ALIGN, yours again afterwards; noh_kind_find_eyes_size tells how much
 * shapes   eyes: centres of the left and the right one, model space
 * errors   NOT_FOUND nothing tells: no face; ARG scratch is NULL or misaligned; MEMORY it is too small (need: its
 *          bytes). *eyes is then untouched */
noh_result noh_kind_find_eyes(const noh_kind_desc *kind, void *scratch, size_t scratch_bytes, float eyes[2][3],
                              noh_error *error);
size_t noh_kind_find_eyes_size(const noh_kind_desc *kind);

/* Look at a point from now on, wherever the actor goes.
 * point  world; NULL: ahead
 * errors also ARG not finite */
noh_result noh_actor_look_at(noh_stage *stage, noh_actor actor, const float point[3], noh_error *error);

/* Look between the eyes of another one, or at the middle of one without a face, where they are as it stands at rest in
 * its place. Once it is gone: ahead. */
noh_result noh_actor_look_at_actor(noh_stage *stage, noh_actor actor, noh_actor other, noh_error *error);

/* emotion  "joy", "sadness", "surprise", "fear", "anger", "disgust", "contempt"; all else as noh_face_set_emotion */
noh_result noh_actor_set_emotion(noh_stage *stage, noh_actor actor, const char *emotion, float amount,
                                 uint32_t onset_ticks, uint32_t hold_ticks, uint32_t fade_ticks, noh_error *error);

noh_result noh_actor_set_activity(noh_stage *stage, noh_actor actor, noh_activity activity, noh_error *error);

/* From now on, beside what clips say.
 * shapes  visemes[NOH_VISEME_COUNT], 0..1; NULL: says nothing */
noh_result noh_actor_set_visemes(noh_stage *stage, noh_actor actor, const float *visemes, noh_error *error);

noh_result noh_actor_set_face_flags(noh_stage *stage, noh_actor actor, uint32_t flags, noh_error *error);

/* A new face by this seed, which looks ahead and feels nothing. A new actor's seed is its id. */
noh_result noh_actor_seed_face(noh_stage *stage, noh_actor actor, uint32_t seed, noh_error *error);

/* Make the actor a person: its floats of the identity's targets are held (noh_actor_hold_float) at these weights, and
 * its blinks shut this person's lids. Costs as many held floats as weights are not 0.
 * shapes  mesh that the identity was made of, of the kind's pack; weights[target_count] of noh_identity_random; NULL:
 *         the mesh's own face again
 * errors  also NOT_FOUND the kind has no float of a target's name; LIMIT held_float_count is too small (need: it). The
 *         actor is then as it was */
noh_result noh_actor_set_identity(noh_stage *stage, noh_actor actor, const noh_identity *identity, const noh_mesh *mesh,
                                  const float *weights, noh_error *error);

noh_result noh_actor_blink(noh_stage *stage, noh_actor actor, noh_error *error);

/* As it is now. */
noh_result noh_actor_face(const noh_stage *stage, noh_actor actor, noh_face_pose *pose, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
