/* identity.h: random faces: weights of the morph targets that make one person's face differ from another.
 *
 *   noh_identity_init     group a mesh's identity targets and find the range of each
 *   noh_identity_random   make a person from a seed
 *   noh_identity_bind     adjust blinks so that the person's lids close
 *   noh_actor_set_identity  (stage_face.h) give an actor an identity
 *
 * A person is one vector of weights. Deltas of expressions are added to the person's face as to the rest face, so all
 * people share the targets of one mesh, and nothing is copied per person.
 *
 * Targets are grouped by names and deltas. Two targets are opposite (nose-width-decr, nose-width-incr) if their names
 * differ in one word and their deltas point against each other, and mirrored (l-ear-lobe-incr, r-ear-lobe-incr) if one
 * moves the mirror image of what the other moves. A person uses one of two opposite targets; mirrored targets get
 * similar weights. Targets that move the whole mesh without changing its shape are ignored. If a name contains age,
 * weight, muscle or gender, targets that move the same vertices in the same way are correlated with it. To keep faces
 * intact, targets that stretch the same place share a bound.
 *
 * Space    of the mesh: x to either side of a face that is symmetric about the middle of its bounds
 * Threads  read-only after init: any number of threads
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 9, where every person has a copy of every target,
 *          with weights that are independent and uniformly distributed */
#ifndef NOH_FACE_IDENTITY_H
#define NOH_FACE_IDENTITY_H

#include "life/face/recipe.h"
#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_IDENTITY_CLOSINGS 4u /* most targets whose closing is tracked */

/* Zero is a good value for all. */
typedef struct noh_identity_desc {
    /* [target_count] 1: identity, 0: expression. NULL: as marked in the pack; without marks, all targets that no recipe
     * names */
    const uint8_t *is_identity;
    const noh_face_recipe *const *recipes; /* [recipe_count] NULL: the three built in */
    uint32_t recipe_count;
    float range; /* weight of one standard deviation, before bounds; above 0, at most 1; default (0) 0.6 */
    /* largest relative change of an edge's length at one standard deviation; above 0, at most 1; default (0) 0.18 */
    float strain;
    float asymmetry; /* difference of mirrored targets, in standard deviations; 0..1; default (0) 0.12 */
} noh_identity_desc;

/* Data of one target. */
typedef struct noh_identity_target {
    uint16_t opposite, mirror; /* targets, or NOH_IDENTITY_NONE */
    /* the target of age, weight and so on that it is correlated with, or NOH_IDENTITY_NONE */
    uint16_t leader;
    uint8_t used, negative; /* used: 1 if it varies between people. negative: 1 if negative samples select it */
    float range;            /* weight of one standard deviation; 0: unused */
    float along;            /* correlation with the leader, -1..1 */
    /* change, per unit of its weight, of the weight at which each lid is closed */
    float closing[NOH_IDENTITY_CLOSINGS];
} noh_identity_target;

#define NOH_IDENTITY_NONE 0xffffu

/* A view into the memory passed to init. */
typedef struct noh_identity {
    const noh_identity_target *targets; /* [target_count] */
    uint32_t target_count, used_count;
    float asymmetry;
    uint16_t closings[NOH_IDENTITY_CLOSINGS]; /* targets that close lids */
    uint32_t closing_count;
} noh_identity;

/* Get the exact size in bytes of the identity, and of the scratch for init. */
size_t noh_identity_size(const noh_mesh *mesh);
size_t noh_identity_scratch_size(const noh_mesh *mesh);

/* Make an identity.
 * desc    NULL: zeros
 * errors  ARG a field of the desc is out of range, the mesh has no identity target, or memory or scratch is NULL or
 *         misaligned; MEMORY either is too small (need: its bytes) */
noh_result noh_identity_init(void *memory, size_t bytes, void *scratch, size_t scratch_bytes, const noh_mesh *mesh,
                             const noh_identity_desc *desc, noh_identity *identity, noh_error *error);

/* Make a person. Writes only weights of identity targets.
 * shapes  weights[target_count]
 * ranges  amount 0..2: 0 the mesh's own face, 1 natural variation; resulting weights are 0..1 */
void noh_identity_random(const noh_identity *identity, uint32_t seed, float amount, float *weights);

/* Get the weight at which target closings[i] closes a person's lids: 0.5..2, 1 on the mesh's own face.
 * shapes  weights[target_count] of the person */
float noh_identity_shut(const noh_identity *identity, const float *weights, uint32_t i);

/* Scale a binding's links for a person, so that blinks close that person's lids, whatever the size of the eyes.
 * shapes  weights[target_count] of the person; links[link_count] as made by noh_face_recipe_bind for the same
 *         targets */
void noh_identity_bind(const noh_identity *identity, const float *weights, noh_face_link *links, uint32_t link_count);

#ifdef __cplusplus
}
#endif

#endif
