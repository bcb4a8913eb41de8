/* identity.h: people by seed: weights of the morph targets that make one face differ from another.
 *
 *   noh_identity_init     finds how a mesh's identity targets belong together, and how far each may go
 *   noh_identity_random   a person by seed
 *   noh_identity_bind     lids that still close on that person
 *   noh_actor_set_identity  (stage_face.h) an actor as a person
 *
 * A person is one vector of weights: an expression's deltas are added to the person's as to the rest face, so all
 * people share the targets of one mesh, and nothing is made or copied for each.
 *
 * What belongs together is found from names and from the deltas. Two targets are opposite (nose-width-decr,
 * nose-width-incr) where their names differ in one word and their deltas point against each other, and mirrored
 * (l-ear-lobe-incr, r-ear-lobe-incr) where the one moves what the other moves on the other side. Of two opposite
 * targets a person has one; mirrored ones are drawn together, with a little difference. Targets that move the whole
 * mesh and change no shape are left alone. Where a name says age, weight, muscle or gender, the targets that move the
 * same vertices in the same way go along. No face is torn: the targets that stretch one place share a bound.
 *
 * Space    that of the mesh: x to either side of a face that is symmetric about the middle of its bounds
 * Threads  after init read-only: any number of threads
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 9, whose faces are copies of every target for
 *          each person, out of numbers that are all equally likely and know nothing of each other */
#ifndef NOH_FACE_IDENTITY_H
#define NOH_FACE_IDENTITY_H

#include "life/face/recipe.h"
#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_IDENTITY_CLOSINGS 4u /* targets whose closing is held, at most */

/* Zero is a good value for all. */
typedef struct noh_identity_desc {
    const uint8_t *is_identity; /* [target_count] 1: makes a person, 0: an expression. NULL: those that the pack marks;
                                 * where it marks none, those that none of the recipes names */
    const noh_face_recipe *const *recipes; /* [recipe_count] NULL: the three built in */
    uint32_t recipe_count;
    float range;  /* weight of one standard deviation, before bounds; above 0, at most 1; default (0) 0.6 */
    float strain; /* the most that edges of the mesh change their length, one standard deviation, as a share; above 0,
                   * at most 1; default (0) 0.18 */
    float asymmetry; /* of mirrored targets, standard deviations; 0..1; default (0) 0.12 */
} noh_identity_desc;

/* What is known of a target. */
typedef struct noh_identity_target {
    uint16_t opposite, mirror; /* targets, or NOH_IDENTITY_NONE */
    uint16_t leader;           /* the target of age, weight and so on that it goes along with, or NOH_IDENTITY_NONE */
    uint8_t used, negative;    /* 1: makes a person; 1: is what a draw below 0 gives */
    float range;               /* weight of one standard deviation; 0: is left alone */
    float along;               /* correlation with the leader, -1..1 */
    float closing[NOH_IDENTITY_CLOSINGS]; /* what weight 1 of it adds to the weight at which each lid is shut */
} noh_identity_target;

#define NOH_IDENTITY_NONE 0xffffu

/* A view into the memory that init was given. */
typedef struct noh_identity {
    const noh_identity_target *targets; /* [target_count] */
    uint32_t target_count, used_count;
    float asymmetry;
    uint16_t closings[NOH_IDENTITY_CLOSINGS]; /* targets that shut lids */
    uint32_t closing_count;
} noh_identity;

/* Exact bytes of what is kept, and of scratch that only init needs. */
size_t noh_identity_size(const noh_mesh *mesh);
size_t noh_identity_scratch_size(const noh_mesh *mesh);

/* desc    NULL: zeros
 * errors  ARG a field of the desc is out of range, the mesh has no identity target, or memory or scratch is NULL or
 *         misaligned; MEMORY either is too small (need: its bytes) */
noh_result noh_identity_init(void *memory, size_t bytes, void *scratch, size_t scratch_bytes, const noh_mesh *mesh,
                             const noh_identity_desc *desc, noh_identity *identity, noh_error *error);

/* A person. Only weights of identity targets are written.
 * shapes  weights[target_count]
 * ranges  amount 0..2: 0 the mesh's own face, 1 as people differ; weights come out within 0..1 */
void noh_identity_random(const noh_identity *identity, uint32_t seed, float amount, float *weights);

/* The weight at which closing i of the mesh (closings[i]) is shut on a person: 0.5..2, 1 on the mesh's own face.
 * shapes  weights[target_count] of the person */
float noh_identity_shut(const noh_identity *identity, const float *weights, uint32_t i);

/* Change a binding's links for a person, so that blinks shut that person's lids, however large the eyes are.
 * shapes  weights[target_count] of the person; links[link_count] of noh_face_recipe_bind for the same targets, as it
 *         made them */
void noh_identity_bind(const noh_identity *identity, const float *weights, noh_face_link *links, uint32_t link_count);

#ifdef __cplusplus
}
#endif

#endif
