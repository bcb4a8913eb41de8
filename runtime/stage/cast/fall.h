/* fall.h: what most games do with actors that fall: push them, wait until they lie still, play the right clip for
 * getting up.
 *
 *   noh_kind_can_fall   whether a kind can have ragdolls, or why not
 *   noh_push_away       a level push away from an eye
 *   noh_actor_push      at a point, or at the chest
 *   noh_actor_rise      get up by the clips named for it
 *   noh_fall_step       wait, and get up in time
 *   noh_fall_lasts      whether a fall is still under way
 *
 * A noh_fall is the game's, one for each actor that may fall, zeros at first; noh_fall_step comes before each step of
 * the stage. Errors are those of stage_ragdoll.h. Threads: as the stage. */
#ifndef NOH_STAGE_FALL_H
#define NOH_STAGE_FALL_H

#include "life/physics/ragdoll_rig.h"
#include "stage/cast/stage_ragdoll.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_RISE_CLIPS "get_up"                                   /* how the names of clips for getting up begin */
#define NOH_FALL_STAY_TICKS (NOH_TICKS_PER_SECOND / 5u)           /* it lies still for so long */
#define NOH_FALL_WAIT_TICKS (4u * (uint32_t)NOH_TICKS_PER_SECOND) /* then it gets up, at rest or not */

typedef struct noh_fall {
    uint32_t down_ticks, still_ticks; /* since it fell; since it has lain still */
    uint32_t rise_ticks;              /* until the clip for getting up ends; 0: none plays */
} noh_fall;

/* The bodies that a kind's ragdolls would have: of mesh and skeleton, and of the mass of `ragdoll` where that is given.
 * errors  NOT_FOUND, ARG, LIMIT: why it cannot fall */
noh_result noh_kind_can_fall(const noh_kind_desc *kind, noh_ragdoll_rig *rig, noh_error *error);

/* shapes  eye[3], point[3]: of one world; impulse[3]: level, in the unit of `strength` (newton seconds). Zeros where
 * the point is straight above or below the eye */
void noh_push_away(const float eye[3], const float point[3], float strength, float impulse[3]);

/* shapes  point[3] as noh_stage_pick finds it, in the world's units. NULL: its chest, three quarters of the way up from
 *         its place to its highest joint, which needs a pose
 *         impulse[3] newton seconds */
noh_result noh_actor_push(noh_stage *stage, noh_actor actor, const float point[3], const float impulse[3],
                          noh_error *error);

/* noh_actor_get_up by the clips of its kind whose names begin with NOH_RISE_CLIPS; without any, back to what plays.
 * layer  on which the clip plays, once
 * ticks  until it is up; may be NULL */
noh_result noh_actor_rise(noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t *ticks, noh_error *error);

/* Call it before noh_stage_step, with the same ticks. An actor that has lain still for NOH_FALL_STAY_TICKS, or has been
 * down for NOH_FALL_WAIT_TICKS, gets up. */
noh_result noh_fall_step(noh_fall *fall, noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t ticks,
                         noh_error *error);

/* 1 while the actor falls, lies, or plays the clip for getting up. */
int noh_fall_lasts(const noh_fall *fall, const noh_stage *stage, noh_actor actor);

#ifdef __cplusplus
}
#endif

#endif
