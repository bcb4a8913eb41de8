/* stage_ragdoll.h: actors that fall.
 *
 *   noh_kind_desc.ragdoll   what falls of a kind, how many at once, and onto what
 *   noh_actor_fall          from now on it is a ragdoll: it plays dead
 *   noh_actor_hit           an impulse at a point; who stands falls
 *   noh_actor_get_up        back to its clips, from where it lies
 *   noh_actor_kill          it falls, and does not get up; noh_actor_revive
 *   noh_actor_hold_body     parts that its clips move, and joints with strength
 *   noh_actor_body          whether it stands, falls, lies or gets up
 *
 * A falling actor goes on where its last pose was, at the speeds between that and the one before. Its clips go on in
 * time, but its bodies make the pose, and its place goes along with the first body, so that it is seen, lit and heard
 * where it lies. Bodies are those of the pack's table (noh build --ragdoll) or of its joints' names.
 *
 * Getting up: of clips that begin on the ground the one is played whose pelvis lies most like the ragdoll's; the place
 * goes under it, on the ground; what the poses differ by decays, beginning at the speeds that the bodies have.
 *
 * A part that falls: hold all bodies, let one limb go, and let the actor fall: the limb hangs from a body that its
 * clips move. A body with strength: joints with `hertz` turn to the angles that clips have, while it falls.
 *
 * All of it is state of the stage: 1,488 bytes an actor (NOH_ACTOR_RAGDOLL_BYTES), and 1,808 bytes for each that falls
 * at once; saved, restored, forked and hashed. Dolls are stepped by noh_stage_step, on its thread. Errors: NOT_FOUND
 * the actor is gone; ARG its kind has no ragdolls, or a value is out of range.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7, which leaves hand-over and getting up open */
#ifndef NOH_STAGE_STAGE_RAGDOLL_H
#define NOH_STAGE_STAGE_RAGDOLL_H

#include "sim/world.h"
#include "stage/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ACTOR_RAGDOLL_BYTES 1488u

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

typedef struct noh_get_up {
    const char *const *clips; /* [clip_count] that begin on the ground, say on the front and on the back; NULL: none, it
                               * goes back to what plays */
    uint32_t clip_count;
    uint32_t layer;       /* on which it is played, once, alone */
    uint32_t blend_ticks; /* in which the ragdoll's pose becomes the clip's; default (0) 19,200: 0.4 s */
} noh_get_up;

/* It gets up; one that stands goes on. Its ragdoll is free for another. With noh_kind_desc.inertia, fingers and all
 * else that has no body go over as smoothly; without, they leap.
 * how      NULL: zeros
 * chosen   index in `clips`, NOH_NONE without; may be NULL
 * errors   also NOT_FOUND the kind has no such clip (where: which); ARG it is dead, or the layer; LIMIT as
 *          noh_actor_play */
noh_result noh_actor_get_up(noh_stage *stage, noh_actor actor, const noh_get_up *how, uint32_t *chosen,
                            noh_error *error);

/* It falls, and noh_actor_get_up refuses it until it is revived. As soon as it lies still its ragdoll is free for
 * another; a hit takes one again.
 * errors   as noh_actor_fall */
noh_result noh_actor_kill(noh_stage *stage, noh_actor actor, noh_error *error);
noh_result noh_actor_revive(noh_stage *stage, noh_actor actor, noh_error *error);

/* What clips have of a body while its actor falls. Zeros: nothing, it is limp. */
typedef struct noh_body_hold {
    uint32_t held;  /* 1: it goes where clips have it, whatever is in the way; of the first body: the place goes as
                     * clips move it */
    float hertz;    /* how fast the joint to its parent turns to the angle that clips have: 0 limp, 20 tracks. A ragdoll
                     * with strength does not fall asleep */
    float animated; /* 0..1: how much of its rotation is shown as clips have it */
} noh_body_hold;

/* Of the body that begins at a joint, and of all below it. Holds until it is set again, however often it falls.
 * errors  also ARG no body begins there or below (where: the joint) */
noh_result noh_actor_hold_body(noh_stage *stage, noh_actor actor, uint32_t joint, const noh_body_hold *hold,
                               noh_error *error);

typedef enum noh_body_state {
    NOH_BODY_STANDS = 0, /* as its clips have it; or there is no such actor */
    NOH_BODY_FALLS,
    NOH_BODY_LIES, /* still */
    NOH_BODY_GETS_UP
} noh_body_state;

noh_body_state noh_actor_body(const noh_stage *stage, noh_actor actor);

#ifdef __cplusplus
}
#endif

#endif
