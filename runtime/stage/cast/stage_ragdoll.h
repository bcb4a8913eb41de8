/* stage_ragdoll.h: actors that fall.
 *
 *   noh_kind_desc.ragdoll   how many actors of a kind may fall at once, and what they collide with
 *   noh_actor_fall          turn an actor into a ragdoll
 *   noh_actor_hit           an impulse at a point; a standing actor falls
 *   noh_actor_get_up        back to its clips, from where it lies
 *   noh_actor_kill          it falls and stays down; noh_actor_revive
 *   noh_actor_hold_body     parts that its clips move, and joints with strength
 *   noh_actor_body          whether it stands, falls, lies or gets up
 *
 * A falling actor starts in its last pose, at the velocities between that pose and the one before. Its clips play on,
 * but its bodies make the pose, and its place moves with the first body, so that it is seen, lit and heard where it
 * lies. The bodies come from the pack's table (noh build --ragdoll) or from the names of its joints.
 *
 * Getting up: among clips that begin on the ground, the one whose pelvis lies most like the ragdoll's is played. The
 * place moves under it, on the ground, and the difference between the poses decays from the bodies' velocities.
 *
 * It falls alike at any distance from the origin that a place can have: bodies are kept from an origin near to them.
 * What is inside an obstacle as it begins to fall comes out at NOH_PUSH_OUT_SPEED (world.h) and is not thrown.
 *
 * For one limp limb, hold all bodies, release the limb, and let the actor fall: the limb hangs from a body that clips
 * move. For a fall with strength, give joints a `hertz`: they turn towards the angles of the clips.
 *
 * All of it is part of the stage's state: 1,488 bytes an actor (NOH_ACTOR_RAGDOLL_BYTES), and 1,824 bytes for each that
 * falls at once; saved, restored, forked and hashed. Dolls are stepped by noh_stage_step, on its thread. Errors:
 * NOT_FOUND the actor is gone; ARG its kind has no ragdolls, or a value is out of range.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7; it leaves hand-over and getting up open */
#ifndef NOH_STAGE_STAGE_RAGDOLL_H
#define NOH_STAGE_STAGE_RAGDOLL_H

#include "life/physics/world.h"
#include "stage/cast/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ACTOR_RAGDOLL_BYTES 1488u

typedef struct noh_kind_ragdoll {
    uint32_t count;         /* actors that may be down at once, 1..NOH_RAGDOLLS_MAX */
    uint32_t substeps;      /* of 1/60 s, 5..NOH_RAGDOLL_SUBSTEPS_MAX; default (0) 10 */
    float mass;             /* kilograms; default (0) 70 for a height of 1.75 m, by its cube */
    const noh_world *world; /* metres; read by steps, must outlive the stage. NULL: nothing to collide with */
} noh_kind_ragdoll;

/* Let an actor fall; one that falls already is not changed.
 * errors  also ARG its place has a scale, or it hangs on another actor; LIMIT `count` actors of the kind are down */
noh_result noh_actor_fall(noh_stage *stage, noh_actor actor, noh_error *error);

/* Let an actor fall with a push.
 * shapes  point[3] in the world, metres: the body nearest to it is pushed; impulse[3] newton seconds, of which much is
 *         spread over all bodies, up to a limit of about 40 m/s (noh_ragdoll_push)
 * errors  as noh_actor_fall; also ARG not finite */
noh_result noh_actor_hit(noh_stage *stage, noh_actor actor, const float point[3], const float impulse[3],
                         noh_error *error);

typedef struct noh_get_up {
    const char *const *clips; /* [clip_count] that begin on the ground, such as one from the front and one from the
                               * back; NULL: none, it returns to what plays */
    uint32_t clip_count;
    uint32_t layer;       /* on which it is played, once, alone */
    uint32_t blend_ticks; /* in which the ragdoll's pose becomes the clip's; default (0) 19,200: 0.4 s */
} noh_get_up;

/* Let an actor get up; one that stands is not changed. Its ragdoll becomes free. With noh_kind_desc.inertia, fingers
 * and other joints without a body follow as smoothly; without it they jump.
 * how      NULL: zeros
 * chosen   index in `clips`, NOH_NONE without; may be NULL
 * errors   also NOT_FOUND the kind has no such clip (where: which); ARG it is dead, or the layer; LIMIT as
 *          noh_actor_play */
noh_result noh_actor_get_up(noh_stage *stage, noh_actor actor, const noh_get_up *how, uint32_t *chosen,
                            noh_error *error);

/* Let an actor fall; noh_actor_get_up then refuses it until it is revived. Its ragdoll becomes free once it lies still;
 * a hit takes one again.
 * errors   as noh_actor_fall */
noh_result noh_actor_kill(noh_stage *stage, noh_actor actor, noh_error *error);
noh_result noh_actor_revive(noh_stage *stage, noh_actor actor, noh_error *error);

/* How much clips move a body while its actor falls. All zeros: not at all, it is limp. */
typedef struct noh_body_hold {
    uint32_t held;  /* 1: clips move it, whatever is in the way; for the first body: clips move the place, too */
    float hertz;    /* how fast the joint to its parent turns to the angle of the clips: 0 limp, 20 follows closely. A
                     * ragdoll with strength does not fall asleep */
    float animated; /* 0..1: how much of its shown rotation is that of the clips */
} noh_body_hold;

/* Set it for the body that begins at a joint, and for all below. It stays until it is set again.
 * errors  also ARG no body begins there or below (where: the joint) */
noh_result noh_actor_hold_body(noh_stage *stage, noh_actor actor, uint32_t joint, const noh_body_hold *hold,
                               noh_error *error);

typedef enum noh_body_state {
    NOH_BODY_STANDS = 0, /* moved by its clips; also if there is no such actor */
    NOH_BODY_FALLS,
    NOH_BODY_LIES, /* still */
    NOH_BODY_GETS_UP
} noh_body_state;

noh_body_state noh_actor_body(const noh_stage *stage, noh_actor actor);

#ifdef __cplusplus
}
#endif

#endif
