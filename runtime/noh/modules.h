/* modules.h: what a kind of character may do beyond clips: faces that live, eyes and bodies that look, hands that reach,
 * feet that stand on the ground, ragdolls, springs, hair, and modifiers of your own. A kind names the modules it wants;
 * what it does not name takes no memory. */

#ifndef NOH_MODULES_H
#define NOH_MODULES_H

#include <stdint.h>

#include "base.h"
#include "format.h"
#include "pack.h"
#include "clip.h"
#include "face.h"
#include "body.h"
#include "noh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== modifiers ========
 * Functions that change a pose between the clips and what is drawn: look at a point, put feet on the
 * ground, swing hair.
 *
 * A modifier is given the local pose and the floats that clips and graphs made, and changes them. A kind lists its
 * modifiers (noh_kind_desc.modifiers); they run in that order, each on what the one before left. What a modifier
 * remembers of an actor is state of the stage, of as many bytes as the modifier asks for: saved, restored, hashed and
 * forked with everything else. The game reads and writes the same bytes between frames (noh_actor_modifier): where to
 * look, what to fear.
 *
 *   typedef struct gaze { float target[3], turned; } gaze;
 *   static void look(noh_modifier_work *w) { gaze *g = w->state; ... w->local[head].rotation ... }
 *   static const noh_modifier modifiers[] = { { .name = "gaze", .modify = look, .state_bytes = sizeof(gaze) } };
 *   kind.modifiers = modifiers, kind.modifier_count = 1;
 *   ((gaze *)noh_actor_modifier(stage, actor, 0))->target[0] = 1.0f;
 *
 * A modifier runs in the jobs of a frame, on any thread, so it keeps a contract:
 *   - it reads the work, its own state and what `user` points to, and writes local, floats, state and scratch alone;
 *   - it calls no function of the stage but those below; the rest of the library's are fine where their own comments
 *     allow it;
 *   - its result depends on these alone: no clock, no address, no random numbers but those of its state. Then results
 *     have the same bits for any number of jobs, and after a restore.
 * It is called only where the actor is posed: not out of view, and at a distance less often than once a frame, for the
 * tick that the pose will be shown at. So it moves its state on by `ticks` as they come, not by frames; time that
 * passed out of view comes as one call with `cut`.
 *
 * Threads: as above; noh_actor_modifier on the stage's thread, outside of steps and frames. */

/* What a modifier is given. */
typedef struct noh_modifier_work {
    noh_actor actor;
    const noh_skeleton *skeleton; /* joint_count 0 in a kind without one */
    noh_transform *local;         /* [skeleton->joint_count] read and write; parents come before their children */
    uint32_t joint_count;         /* the first so many were sampled at this detail; the others have the bind pose */
    uint32_t level;               /* of the actor, 0 the finest */
    float pixels_per_metre; /* at the actor's nearest point; NOH_MODIFIER_FULL_DETAIL where all is shown in full */
    noh_place place;        /* of the actor after the last step. Of one that hangs on another it is the other's:
                                   * where the joint is, is not known yet */
    int64_t clock;          /* tick of the stage's clock that the pose is for: the present one, or a later one */
    uint32_t ticks;         /* since that of the pose before; 0 after a cut, or where that was for a later tick */
    uint32_t cut;           /* 1: nothing to go on from: the actor is new, has leapt, or was out of view */
    void *state;            /* [state_bytes] of this modifier and actor, aligned to 16; zeros when it is spawned */
    void *scratch;          /* [scratch_bytes] of the job, aligned to 16; undefined */
    const void *user;
    const struct noh_stage *stage; /* private, as are all below */
    const void *kind;
    float *floats, *model;
    double home[3]; /* a point near the actor, and its place from there, which is exact far from the origin */
    float near_place[3];
    float home_moved[3]; /* since the pose before: states count from `home`, and are less by so much */
} noh_modifier_work;

/* Model-space matrices of all joints, as the local pose stands now: made anew by each call, and valid until the next
 * one or the end of the modifier. To get to the world multiply by that of the place.
 * shapes   [skeleton->joint_count][12]
 * returns  NULL in a kind without a skeleton */
const float *noh_modifier_model(noh_modifier_work *work);

/* A float as it stands now, and a new value. Floats are counted as noh_stage_find does; one that takes its value from a
 * namesake is the namesake. In a pack without nodes whose kind has clips, weights of targets cannot be set: 0. */
float noh_modifier_float(const noh_modifier_work *work, uint32_t index);
int noh_modifier_set_float(noh_modifier_work *work, uint32_t index, float value);

/* One modifier of a kind. All but `modify` may be 0. */
typedef struct noh_modifier {
    const char *name; /* for messages; borrowed */
    void (*modify)(noh_modifier_work *work);
    /* What is wrong with a state that comes from outside (noh_stage_set_state), a constant text; NULL: it is good.
     * Without this function any bytes are good */
    const char *(*check)(const void *user, const void *state);
    const void *user;       /* for all of them; read by jobs at the same time; must outlive the stage */
    uint32_t state_bytes;   /* of each actor */
    uint32_t scratch_bytes; /* of each job; modifiers of all kinds share it */
    /* The world's origin moves by `by` (noh_stage_shift_origin): points of the world in a state become less by it */
    void (*shift)(const void *user, void *state, const float by[3]);
} noh_modifier;

/* The state of a modifier of an actor, to read and to write; modifier: its index in noh_kind_desc.modifiers. Valid
 * until the actor goes. NULL: the actor is gone, has no such modifier, or a frame has begun. */
void *noh_actor_modifier(noh_stage *stage, noh_actor actor, uint32_t modifier);

/* ======== actor hair ========
 * Hair of the actors of a kind, from one head to a crowd.
 *
 *   noh_wig_make    a haircut and the joint that carries it
 *   noh_wig_modifier    the modifier that moves it, for noh_kind_desc.modifiers
 *   noh_wig_points  where its control hairs are
 *   noh_wig_seen    where its head is, as it was shown
 *
 * Control hairs (low_life.h) are state of the stage like all that modifiers have (modules.h): planned, saved, forked and
 * hashed, with the same bits for any number of jobs. noh_gl.h draws them.
 *
 * Threads: as modules.h. `wind` may be changed between frames. */

typedef struct noh_wig {
    const noh_haircut *cut;
    uint32_t joint; /* NOH_NONE: the actor itself */
    float wind[3];  /* as in noh_hair_carrier, world */
} noh_wig;

/* skeleton  of the kind; in one without, joint_count is 0
 * errors    NOT_FOUND the skeleton has no such joint */
noh_result noh_wig_make(const noh_haircut *cut, const noh_pack *pack, uint32_t skeleton, noh_wig *out,
                        noh_error *error);

/* The modifier; the wig and its haircut must outlive the stage. Of each actor 16 bytes and those of noh_hair_size. */
noh_modifier noh_wig_modifier(const noh_wig *wig);

/* shapes  state: of noh_actor_modifier; points[hair_count][point_count][3], head space; at rest where none was posed */
void noh_wig_points(const noh_wig *wig, const void *state, float *points);

/* Where the head of an actor is, as the last frame showed it.
 * shapes   world[12]: from head space (metres); pixels_per_metre: of head space; views: a bit for each view that sees
 *          it
 * returns  0 if it was not shown; nothing is written then */
int noh_wig_seen(const noh_wig *wig, const noh_stage *stage, noh_actor actor, float world[12], float *pixels_per_metre,
                 uint32_t *views);

/* ======== hair of a crowd ========
 * Hair of a whole kind in fixed memory. Hair moves on the actors that look largest; on all others it hangs at
 * rest and follows the head.
 *
 * noh_gl.h draws it.
 *
 * Threads: the stage's, outside of steps and frames; noh_actor_hair_size, any. */

typedef struct noh_actor_hair_desc {
    const noh_haircut *cut; /* must outlive the desc */
    uint32_t joint;         /* carries the hair; NOH_NONE: the actor itself */
    uint32_t kind;          /* of the stage */
    uint32_t head_max;      /* heads visible at once, 1..NOH_STAGE_ACTORS_MAX; any more have no hair */
    uint32_t near_max;      /* heads whose hair moves at once, 0..NOH_HAIR_NEAR_MAX */
    int in_state;           /* 1: simulated by noh_actor_hair_modifier */
    float wind[3];          /* as in noh_hair_carrier, in the world; may change between frames */
} noh_actor_hair_desc;

/* A visible head. */
typedef struct noh_hair_head {
    float world[12];        /* from head space (metres), less noh_stage_origin */
    float pixels_per_metre; /* of head space */
    float moves;            /* 0 (at rest) to 1 (in full motion) */
    uint32_t views;         /* a bit for each view that sees it */
    uint32_t slot;          /* 0..near_max - 1 if its hair moves; NOH_NONE: at rest */
} noh_hair_head;

typedef struct noh_actor_hair noh_actor_hair;

/* Fill a desc for one head of kind 0, simulated outside the stage. Change counts, kind and in_state as needed.
 * skeleton  of the kind; unused if the haircut names no joint
 * errors    NOT_FOUND the skeleton has no joint of the haircut's name */
noh_result noh_actor_hair_desc_make(const noh_haircut *cut, const noh_pack *pack, uint32_t skeleton,
                                    noh_actor_hair_desc *out, noh_error *error);

/* The modifier that simulates hair in the stage. `desc` must outlive the stage and stay where it is.
 * memory  16 bytes and noh_hair_size, in each actor */
noh_modifier noh_actor_hair_modifier(const noh_actor_hair_desc *desc);

/* The exact bytes: about 80 for each head and, with in_state 0, noh_hair_size for each that moves. 0 for an impossible
 * desc. */
size_t noh_actor_hair_size(const noh_actor_hair_desc *desc);

/* desc    must outlive the hair and stay where it is; with in_state 1 it is the one given to noh_actor_hair_modifier
 * errors  ARG memory is NULL or misaligned, or a count of the desc is out of range; MEMORY */
noh_result noh_actor_hair_init(void *memory, size_t bytes, const noh_actor_hair_desc *desc, noh_actor_hair **hair,
                               noh_error *error);

/* Call it after noh_stage_frame_end, in every frame.
 * ticks  that the stage was stepped by since the last frame; unused with in_state */
void noh_actor_hair_frame(noh_actor_hair *hair, noh_stage *stage, uint32_t ticks);

/* heads[*count], valid until the next frame. */
const noh_hair_head *noh_actor_hair_heads(const noh_actor_hair *hair, uint32_t *count);

/* shapes  points[hair_count][point_count][3], head space */
void noh_actor_hair_points(const noh_actor_hair *hair, uint32_t head, float *points);

const noh_actor_hair_desc *noh_actor_hair_desc_of(const noh_actor_hair *hair);

/* ======== feet of actors ========
 * Actors that stand on the ground.
 *
 *   noh_feet_modifier   a modifier of a kind (modules.h) that puts its actors' feet on the ground
 *
 *   noh_feet_rig_make(&source, &feet.rig, &error); feet.ground.world = &world;
 *   const noh_modifier modifiers[] = { gaze, noh_feet_modifier(&feet), hands, springs };
 *   kind.modifiers = modifiers, kind.modifier_count = 4;
 *
 * The order of modifiers is that of the frame: what looks comes before feet; hands and springs come after them.
 * The state is a noh_feet: planned, saved, restored, forked and hashed with the stage. The game moves places along the
 * ground as roughly as it likes, from step to step; bodies follow smoothly.
 * At a detail without the feet's joints, and without ground, poses stay as they are. An actor that hangs on another has
 * no place of its own that a modifier could know: its kind should have no such modifier.
 * Threads: the ground is read by jobs at the same time. */

/* What the feet of a kind have in common. */
typedef struct noh_kind_feet {
    noh_feet_rig rig; /* of the kind's skeleton */
    noh_ground ground;
} noh_kind_feet;

/* feet  must outlive the stage */
noh_modifier noh_feet_modifier(const noh_kind_feet *feet);

/* ======== ragdolls of actors ========
 * Actors that fall.
 *
 *   noh_ragdoll_module      for noh_kind_desc.ragdoll: how many actors of a kind may fall at once, and on what
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
 * What is inside an obstacle as it begins to fall comes out at NOH_PUSH_OUT_SPEED (body.h) and is not thrown.
 *
 * For one limp limb, hold all bodies, release the limb, and let the actor fall: the limb hangs from a body that clips
 * move. For a fall with strength, give joints a `hertz`: they turn towards the angles of the clips.
 *
 * All of it is part of the stage's state: 1,488 bytes an actor (NOH_ACTOR_RAGDOLL_BYTES), and 1,824 bytes for each that
 * falls at once; saved, restored, forked and hashed. Dolls are stepped by noh_stage_step, on its thread. Errors:
 * NOT_FOUND the actor is gone; ARG its kind has no ragdolls, or a value is out of range.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7; it leaves hand-over and getting up open */

typedef struct noh_kind_ragdoll {
    uint32_t count;         /* actors that may be down at once, 1..NOH_RAGDOLLS_MAX */
    uint32_t substeps;      /* of 1/60 s, 5..NOH_RAGDOLL_SUBSTEPS_MAX; default (0) 10 */
    float mass;             /* kilograms; default (0) 70 for a height of 1.75 m, by its cube */
    const noh_world *world; /* metres; read by steps, must outlive the stage. NULL: nothing to collide with */
} noh_kind_ragdoll;

/* For noh_kind_desc.ragdoll.
 * ragdoll  read by plans and by init. NULL: none */
noh_module noh_ragdoll_module(const noh_kind_ragdoll *ragdoll);

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

/* ======== pushes and falls ========
 * What most games do with actors that fall: push them, wait until they lie still, play the right clip for
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
 * the stage. Errors are those of modules.h. Threads: as the stage. */

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

/* ======== springs ========
 * Springs of a kind: chains of its joints that swing as its actors move.
 *
 *   noh_springs_module                   for noh_kind_desc.springs: those of the mesh's pack (noh build --springs)
 *   noh_springs_of_pack                  what a pack has
 *   noh_springs_size, noh_springs_init   chains and colliders of a skeleton, shared by all actors that have it
 *   noh_springs_modifier                 the modifier that runs them, for noh_kind_desc.modifiers
 *
 * noh_springs_module is all that the springs of a pack need: the stage makes them, and runs them after everything else
 * that changes a pose. The other calls are for springs that the game describes itself.
 *
 * What swings is state of the stage, planned, saved, forked and hashed with all else, and has the same bits for any
 * number of jobs. Each chain is a spring of low_life.h, carried by the parent of its first joint as clips, faces and the
 * modifiers before have posed it. Clips that move a joint of a chain are overruled: its rest is the bind pose.
 *
 * A chain that looks shorter than NOH_SPRINGS_FADE_PIXELS fades into its rest, and stands at rest, at no cost, from
 * half of that length down; it begins anew from rest, and fades in. All chains are at rest after a cut.
 * Threads: noh_springs_init as any init; afterwards it is read only. */

/* Rows, chains and capsules are those of format.h. All is read at init. */
typedef struct noh_springs_desc {
    noh_skeleton skeleton; /* of the kinds that use it */
    float metres;          /* of one unit of the skeleton: noh_skeleton_header.unit_cm / 100 */
    const noh_spring_row *rows;
    uint32_t row_count; /* 1..NOH_JOINTS_MAX */
    uint32_t chain_count;
    const noh_spring_chain *chains; /* they come in this order: one that hangs on another behind it */
    const noh_spring_capsule *colliders;
    uint32_t collider_count; /* 0..NOH_SPRING_COLLIDERS_MAX */
    float restitution;       /* noh_spring_desc.restitution of all chains; 0 of a pack's */
} noh_springs_desc;

typedef struct noh_springs noh_springs;

/* For noh_kind_desc.springs: the springs that the mesh's pack has for the kind's skeleton swing. At no cost where the
 * pack has none. */
noh_module noh_springs_module(void);

/* What a pack has for one of its skeletons; it points into the pack.
 * returns  0: there are none, and *desc is untouched */
int noh_springs_of_pack(const noh_pack *pack, uint32_t skeleton, noh_springs_desc *desc);

/* Bytes of each actor and of each job that their modifier will have; of a desc that noh_springs_init takes. */
void noh_springs_measure(const noh_springs_desc *desc, size_t *state_bytes, size_t *scratch_bytes);

/* The modifier; the springs must outlive the stage. Of each actor: 4 bytes a chain rounded up to 16, and a noh_spring
 * each. The kind's skeleton is that of the desc: a kind with fewer joints is not swung. */
noh_modifier noh_springs_modifier(const noh_springs *springs);

/* ======== faces of actors ========
 * Faces of actors: they blink, look, feel, breathe, and are never still.
 *
 *   noh_face_module           for noh_kind_desc.face: one line makes a kind's actors alive
 *   noh_kind_find_eyes        where its eyes are, where no joints say so
 *   noh_actor_look_at         a point of the world; noh_actor_look_at_actor: another actor's eyes
 *   noh_actor_set_emotion     an emotion by name: comes, holds and goes
 *   noh_actor_set_activity    resting, talking, reading
 *   noh_actor_set_visemes     mouth shapes that come live, of an ear or a network
 *   noh_actor_set_face_flags  calm, or without one of the things that a face does by itself
 *   noh_actor_seed_face       another person
 *   noh_actor_set_identity    a person of face.h
 *   noh_actor_blink           now
 *   noh_actor_face            what shows
 *
 * A face moves what the kind has: morph targets by recipes (face.h), and joints of head, neck, chest and eyes by
 * name. It changes the pose before the modifiers of the game (modules.h) do: over what clips say, below floats that
 * are held. A clip of speech (noh speak) tells it how much of the mouth is taken, by its named floats "speech" and
 * "lips-shut": an emotion leaves the mouth as far as it says.
 *
 * All of it is state of the stage: 336 bytes an actor (NOH_ACTOR_FACE_BYTES), saved, restored, forked and hashed. A
 * face out of view rests, and goes on when it is seen again. Errors: NOT_FOUND the actor is gone; ARG its kind has no
 * face, or a value is out of range. */

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

/* For noh_kind_desc.face.
 * face  read by plans and by init. NULL: none */
noh_module noh_face_module(const noh_kind_face *face);

/* Where the eyes of a kind are at rest, for noh_kind_face.face.eyes: the joints of the eyes; without these behind what
 * its recipes blink with, or turn eyes with: the middle of what moves on each side, 0.19 of their distance further in.
 * kind     mesh, skeleton, nodes and face (none: as zeros) as a stage would be given them
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

/* ======== gaze and reach of actors ========
 * Actors that look at points and reach for them.
 *
 *   noh_gaze_modifier    a modifier of a kind (modules.h) that turns spine, neck, head and eyes
 *   noh_reach_modifier   one that puts hands on points
 *
 *   noh_gaze_rig_make(&pack, 0, &gaze.rig, &error);
 *   const noh_modifier modifiers[] = { noh_gaze_modifier(&gaze), noh_feet_modifier(&feet),
 *                                    noh_reach_modifier(&reach) };
 *   noh_gaze *g = noh_actor_modifier(stage, actor, 0);      g->point[2] = 3.0f, g->looks = 1;
 *   noh_reach *r = noh_actor_modifier(stage, actor, 2);     r->hands[0].point[1] = 1.0f, r->hands[0].wants = 1;
 *
 * Points are the world's: the game sets them whenever they move. What looks comes before feet, hands come after them,
 * because feet move the body. States are a noh_gaze and a noh_reach: planned, saved, restored, forked and hashed with
 * the stage.
 *
 * In a kind with a face the gaze modifier leaves poses alone: head and eyes are the face's (noh_actor_look_at). At a
 * detail without the rig's joints poses stay as they are. An actor that hangs on another has no place of its own that a
 * modifier could know: its kind should have no such modifier. */

/* What the gazes of a kind have in common. */
typedef struct noh_kind_gaze {
    noh_gaze_rig rig;      /* of the kind's skeleton */
    noh_ik_look_desc head; /* zeros: as in body.h */
} noh_kind_gaze;

/* They must outlive the stage. */
noh_modifier noh_gaze_modifier(const noh_kind_gaze *gaze);
noh_modifier noh_reach_modifier(const noh_reach_rig *rig);

#ifdef __cplusplus
}
#endif

#endif
