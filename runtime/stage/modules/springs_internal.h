/* springs_internal.h: springs of a kind from a description. */
#ifndef NOH_STAGE_SPRINGS_INTERNAL_H
#define NOH_STAGE_SPRINGS_INTERNAL_H

#include "noh/body.h"
#include "noh/low_life.h"
#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_springs noh_springs;

/* Rows, chains and capsules: see format.h. All are read at init. */
typedef struct noh_springs_desc {
    noh_skeleton skeleton; /* of the kinds that use it */
    float metres;          /* of one unit of the skeleton: noh_skeleton_header.unit_cm / 100 */
    const noh_spring_row *rows;
    uint32_t row_count; /* 1..NOH_JOINTS_MAX */
    uint32_t chain_count;
    const noh_spring_chain *chains; /* simulated in this order: a chain attached to another comes after it */
    const noh_spring_capsule *colliders;
    uint32_t collider_count; /* 0..NOH_SPRING_COLLIDERS_MAX */
    float restitution;       /* noh_spring_desc.restitution of all chains; 0 for a pack's springs */
    const noh_world *world;  /* metres; read by frames, must outlive the stage; NULL: none */
} noh_springs_desc;

/* What a job asks with. */
typedef struct noh_springs_world {
    const noh_world *world;
    float metres;          /* of one unit of the skeleton */
    noh_world_body *balls; /* [joints of all moves of a call], with their answers; undefined before and after */
    noh_touches *touches;
} noh_springs_world;

/* Ask what chains touch before they are stepped by the work's ticks: one question for all. Sets their `touches`. */
void noh_springs_ask(const noh_modifier_work *w, const noh_springs_world *world, noh_spring_move *moves,
                     uint32_t count);

/* Get the springs that a pack has for one of its skeletons. `desc` points into the pack.
 * returns  0: the pack has none, and *desc is untouched */
int noh_springs_of_pack(const noh_pack *pack, uint32_t skeleton, noh_springs_desc *desc);

/* Get the state_bytes and scratch_bytes of the modifier, for a valid desc. */
void noh_springs_measure(const noh_springs_desc *desc, size_t *state_bytes, size_t *scratch_bytes);

/* Get the modifier. The springs must outlive the stage. The kind must have the desc's skeleton; springs do not move a
 * kind with fewer joints.
 * memory  in each actor: 4 bytes for each chain, rounded up to 16, and a noh_spring for each */
noh_modifier noh_springs_modifier(const noh_springs *springs);

/* The exact bytes; 0 for counts that are impossible. */
size_t noh_springs_size(const noh_springs_desc *desc);

/* errors  ARG memory is NULL or misaligned, a chain's rows are not there or not parent and child, a joint swings twice,
 *         or a number is out of its range (where: the chain, row or collider); LIMIT a count, or the state of
 *         one actor would have more than NOH_MODIFIER_BYTES_MAX; MEMORY it is too small */
noh_result noh_springs_init(void *memory, size_t bytes, const noh_springs_desc *desc, noh_springs **springs,
                            noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
