/* stage_ragdoll.h: actors that fall.
 *
 *   noh_kind_desc.ragdoll   what falls of a kind, how many at once, and onto what
 *   noh_actor_fall          from now on it is a ragdoll
 *   noh_actor_hit           an impulse at a point; who stands falls
 *   noh_actor_falls         whether it is a ragdoll, and whether it lies still
 *
 * A falling actor goes on where its last pose was, at the speeds between that and the one before. Its clips go on in
 * time, but its bodies make the pose, and its place goes along with the first body, so that it is seen, lit and heard
 * where it lies. Bodies are those of the pack's table (noh build --ragdoll) or of its joints' names.
 *
 * All of it is state of the stage: 928 bytes an actor (NOH_ACTOR_RAGDOLL_BYTES), and 1,808 bytes for each that falls at
 * once; saved, restored, forked and hashed. Dolls are stepped by noh_stage_step, on its thread. Errors: NOT_FOUND the
 * actor is gone; ARG its kind has no ragdolls, or a value is out of range. */
#ifndef NOH_STAGE_STAGE_RAGDOLL_H
#define NOH_STAGE_STAGE_RAGDOLL_H

#include "sim/world.h"
#include "stage/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ACTOR_RAGDOLL_BYTES 928u

typedef struct noh_kind_ragdoll {
    uint32_t count;         /* actors that fall at once, 1..NOH_RAGDOLLS_MAX; they keep it while they lie */
    uint32_t substeps;      /* of 1/60 s, 5..NOH_RAGDOLL_SUBSTEPS_MAX; default (0) 10 */
    float mass;             /* kilograms; default (0) 70 for a height of 1.75 m, by its cube */
    const noh_world *world; /* metres; read by steps, must outlive the stage. NULL: nothing is in the way */
} noh_kind_ragdoll;

/* It falls; one that falls already goes on.
 * errors  also ARG its place has a scale, or it hangs on another actor; LIMIT `count` actors of the kind fall */
noh_result noh_actor_fall(noh_stage *stage, noh_actor actor, noh_error *error);

/* It falls, pushed.
 * shapes  point[3] in the world, metres: the body nearest to it is pushed; impulse[3] newton seconds
 * errors  as noh_actor_fall; also ARG not finite */
noh_result noh_actor_hit(noh_stage *stage, noh_actor actor, const float point[3], const float impulse[3],
                         noh_error *error);

/* 0: it stands, or there is no such actor; 1: it falls; 2: it lies still. */
int noh_actor_falls(const noh_stage *stage, noh_actor actor);

#ifdef __cplusplus
}
#endif

#endif
