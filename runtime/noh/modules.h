/* modules.h: what actors can do besides playing clips: live faces, gaze, reaching hands, feet on the ground, ragdolls,
 * springs, hair, and modifiers that you write. A kind lists the modules that it uses; the others take no memory. */

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
 * A modifier changes the local pose and the floats that clips and graphs have computed. A kind lists its modifiers in
 * noh_kind_desc.modifiers. They run in that order, each on the result of the previous one. A modifier has state_bytes
 * of state for each actor. The stage saves, restores, hashes and forks them with all other state. The game reads and
 * writes the same bytes between frames with noh_actor_modifier, for example to set the point to look at.
 *
 *   typedef struct gaze { float target[3], turned; } gaze;
 *   static void look(noh_modifier_work *w) { gaze *g = w->state; ... w->local[head].rotation ... }
 *   static const noh_modifier modifiers[] = { { .name = "gaze", .modify = look, .state_bytes = sizeof(gaze) } };
 *   kind.modifiers = modifiers, kind.modifier_count = 1;
 *   ((gaze *)noh_actor_modifier(stage, actor, 0))->target[0] = 1.0f;
 *
 * A modifier runs in the jobs of a frame, on any thread. It must keep these rules:
 *   - Read only the work, its own state and the data at `user`. Write only local, floats, state and scratch.
 *   - Call no functions of the stage except the noh_modifier_ functions below. Other functions of the library are
 *     allowed if their comments permit it on any thread.
 *   - Compute results only from this input. Use no clock and no addresses, and keep random numbers in the state.
 *     Results then have the same bits for any number of jobs, and after a restore.
 * It is called only when the actor is posed: not out of view, and less than once a frame at a distance. The pose is for
 * the tick at which it will be shown. Advance the state by `ticks`, not by frames. When an actor comes back into view,
 * its first call has `cut` set.
 *
 * Threads: as above; noh_actor_modifier on the stage's thread, outside of steps and frames. */

#define NOH_MODIFIER_FULL_DETAIL 1e9f

/* Input and output of a modifier. */
typedef struct noh_modifier_work {
    noh_actor actor;
    const noh_skeleton *skeleton; /* joint_count 0 in a kind without one */
    noh_transform *local;         /* [skeleton->joint_count] read and write; parents come before their children */
    uint32_t joint_count;         /* joints sampled at this level, from the first; the others have the bind pose */
    uint32_t level;               /* of the actor, 0 the finest */
    float pixels_per_metre;       /* at the actor's nearest point; NOH_MODIFIER_FULL_DETAIL without LOD */
    noh_place place; /* of the actor after the last step. For an attached actor: its parent's place, because
                             * the parent's joint is not posed yet */
    int64_t clock;   /* the pose's tick on the stage's clock: the current tick or a later one */
    uint32_t ticks;  /* since the previous pose; 0 after a cut, or if the previous pose was for a later tick */
    uint32_t cut;    /* 1: no previous pose to continue from: new, teleported, or was out of view */
    void *state;     /* [state_bytes] of this modifier and actor, aligned to 16; zeros when it is spawned */
    void *scratch;   /* [scratch_bytes] of the job, aligned to 16; undefined */
    const void *user;
    const struct noh_stage *stage; /* private, as are all below */
    const void *kind;
    float *floats, *model;
    double home[3]; /* a point near the actor; near_place is relative to it, for precision far from the origin */
    float near_place[3];
    float home_moved[3]; /* change of `home` since the previous pose; to be subtracted from state relative to it */
} noh_modifier_work;

/* Get the model-space matrices of all joints for the current local pose. Each call computes them again; they are valid
 * until the next call or the end of the modifier. Multiply by the matrix of `place` to get world matrices.
 * shapes   [skeleton->joint_count][12]
 * returns  NULL in a kind without a skeleton */
const float *noh_modifier_model(noh_modifier_work *work);

/* Get or set a float, by its index from noh_stage_find. Floats with the same name share one value.
 * returns  of noh_modifier_set_float: 0 if the float cannot be set, as the weights of targets in a pack without nodes
 *          whose kind has clips */
float noh_modifier_float(const noh_modifier_work *work, uint32_t index);
int noh_modifier_set_float(noh_modifier_work *work, uint32_t index, float value);

/* One modifier of a kind. All but `modify` may be 0. */
typedef struct noh_modifier {
    const char *name; /* for messages; borrowed */
    void (*modify)(noh_modifier_work *work);
    /* Check a state passed to noh_stage_set_state. Returns a string constant that describes the fault; NULL: valid.
     * Without this function all bytes are valid */
    const char *(*check)(const void *user, const void *state);
    const void *user;       /* shared by all actors; read by several jobs at once; must outlive the stage */
    uint32_t state_bytes;   /* of each actor */
    uint32_t scratch_bytes; /* of each job; modifiers of all kinds share it */
    /* noh_stage_shift_origin was called: subtract `by` from world points in the state */
    void (*shift)(const void *user, void *state, const float by[3]);
    /* Asked by plans, init and noh_stage_set_kind: what is wrong in a stage with job_count jobs, as a string constant;
     * NULL: nothing. Without this function it fits every stage */
    const char *(*refuse)(const void *user, uint32_t job_count);
} noh_modifier;

/* Get the state of an actor's modifier, to read and to write. Valid until the actor is despawned.
 * modifier  index in noh_kind_desc.modifiers
 * returns   NULL if the actor is gone or has no such modifier, or during a frame */
void *noh_actor_modifier(noh_stage *stage, noh_actor actor, uint32_t modifier);

/* ======== hair of actors ========
 * Hair of the actors of a kind, from one head to a crowd, in fixed memory.
 *
 *   noh_actor_hair_desc_make   a haircut and the joint that carries it
 *   noh_actor_hair_modifier    with in_state 1: the modifier that moves the hair of every actor, for
 *                              noh_kind_desc.modifiers. Control hairs are then state of the stage: planned, saved,
 *                              forked and hashed, with the same bits for any number of jobs
 *   noh_actor_hair_init        the heads of a stage; noh_actor_hair_frame finds those that are visible
 *
 * With in_state 0 the hair moves on the actors that look largest, outside the stage's state; all other hair is at rest
 * and follows the head. noh_gl.h draws both.
 *
 * Threads: the stage's, outside of steps and frames; noh_actor_hair_size, any. */

typedef struct noh_actor_hair_desc {
    const noh_haircut *cut; /* must outlive the desc */
    uint32_t joint;         /* carries the hair; NOH_NONE: the actor itself */
    uint32_t kind;          /* of the stage */
    uint32_t head_max;      /* heads visible at once, 1..NOH_STAGE_ACTORS_MAX; any more have no hair */
    uint32_t near_max;      /* heads whose hair moves at once, 0..NOH_HAIR_NEAR_MAX */
    int in_state;           /* 1: simulated by noh_actor_hair_modifier */
    float wind[3];          /* mean acceleration, metres per second squared, in the world; gusts reach twice as much */
} noh_actor_hair_desc;

/* A visible head. */
typedef struct noh_hair_head {
    float world[12];        /* from head space (metres), less noh_stage_origin */
    float pixels_per_metre; /* of head space */
    float moves;            /* 0 (at rest) to 1 (in full motion) */
    uint16_t views;         /* a bit for each view that sees it */
    uint16_t melanin;       /* of its complexion's hair, two bytes (noh_complexion_random); 0: the haircut's colours */
    uint32_t slot;          /* 0..near_max - 1 if its hair moves; NOH_NONE: at rest */
} noh_hair_head;

typedef struct noh_actor_hair noh_actor_hair;

/* Fill a desc for one head of kind 0, simulated outside the stage. Change counts, kind and in_state as needed.
 * skeleton  of the kind; unused if the haircut names no joint
 * errors    NOT_FOUND the skeleton has no joint of the haircut's name */
noh_result noh_actor_hair_desc_make(const noh_haircut *cut, const noh_pack *pack, uint32_t skeleton,
                                    noh_actor_hair_desc *out, noh_error *error);

/* The modifier that simulates hair in the stage. `desc` must outlive the stage and stay where it is.
 * memory  128 bytes, and 40 for each point of its control hairs, in each actor */
noh_modifier noh_actor_hair_modifier(const noh_actor_hair_desc *desc);

/* The exact bytes: about 80 for each head and, with in_state 0, 112 and 40 for each point of one that moves. 0 for an
 * impossible desc. */
size_t noh_actor_hair_size(const noh_actor_hair_desc *desc);

/* desc    must outlive the hair and stay where it is; with in_state 1 it is the one given to noh_actor_hair_modifier
 * errors  ARG memory is NULL or misaligned, or a count of the desc is out of range; MEMORY */
noh_result noh_actor_hair_init(void *memory, size_t bytes, const noh_actor_hair_desc *desc, noh_actor_hair **hair,
                               noh_error *error);

/* Call it after noh_stage_frame_end, in every frame.
 * ticks  that the stage was stepped by since the last frame; unused with in_state */
void noh_actor_hair_frame(noh_actor_hair *hair, noh_stage *stage, uint32_t ticks);

/* ======== feet of actors ========
 * Actors that stand on the ground.
 *
 *   noh_feet_modifier   a modifier of a kind that puts its actors' feet on the ground
 *
 *   noh_feet_rig_make(&source, &feet.rig, &error); feet.ground.world = &world;
 *   const noh_modifier modifiers[] = { gaze, noh_feet_modifier(&feet), hands, springs };
 *   kind.modifiers = modifiers, kind.modifier_count = 4;
 *
 * low_life.h has the makers of rigs. List gaze before feet, and hands and springs after them: feet move the body. The
 * stage plans, saves, restores, forks and hashes their state. The game may move places along the ground in coarse
 * steps; bodies follow smoothly.
 * The pose is unchanged at a LOD level without the feet's joints, and where there is no ground. Do not use it in a kind
 * whose actors are attached to others: a modifier does not know their own place.
 * Threads: the ground is read by jobs at the same time. Plans and init refuse a world whose physics answers one thread
 * (body.h) in a stage with several jobs; one that is set later is not asked. */

/* Data shared by the feet of a kind's actors. */
typedef struct noh_kind_feet {
    noh_feet_rig rig; /* of the kind's skeleton */
    noh_ground ground;
} noh_kind_feet;

/* feet  must outlive the stage */
noh_modifier noh_feet_modifier(const noh_kind_feet *feet);

/* ======== standing ========
 * How humanoids stand that play nothing: arms down, breathing, shifting their weight, looking about.
 *
 *   noh_kind_stand_make   find arms, legs and head of a kind, by joint names
 *   noh_stand_modifier    a modifier of a kind whose actors have no clips for standing
 *
 * It poses the bind pose, or whatever clips show: arms that are spread hang down, the rest is added. Feet stay where
 * they are. Actors differ, and each moves as a function of time alone: the modifier has no state. In a kind with a face
 * the face moves the head. List it before gaze, feet and hands.
 * Threads: no state; any thread. */

typedef struct noh_kind_stand {
    noh_reach_rig arms; /* arm_count 0: none */
    noh_feet_rig legs;  /* leg_count 0: none */
    noh_gaze_rig trunk; /* joint_count 0: none */
    uint32_t front;     /* where its soles point in the bind pose: quarter turns from +z towards +x, 0..3 */
} noh_kind_stand;

/* Make the rig of a kind, from its mesh and skeleton.
 * errors  NOT_FOUND it has no skeleton, or none of arms, legs and head */
noh_result noh_kind_stand_make(const noh_kind_desc *kind, noh_kind_stand *stand, noh_error *error);

/* stand  must outlive the stage */
noh_modifier noh_stand_modifier(const noh_kind_stand *stand);

/* ======== ragdolls of actors ========
 * Actors that become ragdolls.
 *
 *   noh_ragdoll_module      for noh_kind_desc.ragdoll: most ragdolls at once, and the world they collide with
 *   noh_actor_fall          turn an actor into a ragdoll
 *   noh_actor_hit           an impulse at a point; a standing actor staggers or falls
 *   noh_actor_get_up        return to clips from where the actor lies
 *   noh_actor_kill          the actor falls and stays down; noh_actor_revive
 *   noh_actor_hold_body     bodies moved by clips, and joints with strength
 *   noh_actor_body          whether the actor stands, falls, lies or gets up
 *
 * A fall starts from the actor's last pose, with the velocities between its last two poses. Clips continue to play, but
 * the bodies determine the pose. The actor's place follows its first body, so it is culled, lit and heard where it
 * lies. The bodies come from the pack's table (noh build --ragdoll) or from the names of its joints.
 *
 * Getting up plays the clip whose first pose has a pelvis most like the ragdoll's. The actor's place moves to the
 * pelvis, on the ground. The difference between the poses decays, starting with the bodies' velocities.
 *
 * Precision does not depend on the distance from the origin: bodies are stored relative to a nearby origin. Bodies
 * inside an obstacle at the start of a fall leave it at NOH_PUSH_OUT_SPEED (body.h), without an impulse.
 *
 * An actor of another scale falls as a ragdoll of that size, under the same gravity. A `mass` is for scale 1 and grows
 * by the cube of the scale. A `stagger_speed` grows by its square root, and so do the times that staggers and falls
 * take. The greatest speed of a ragdoll grows by the scale itself: 40 m/s for 1.75 m, 4 m/s for a tenth of it.
 *
 * For one limp limb, hold all bodies except the limb's, then let the actor fall. For a fall with strength, set
 * noh_body_hold.hertz: joints then turn towards the angles of the clips.
 *
 * Memory: 1,488 bytes for each actor (NOH_ACTOR_RAGDOLL_BYTES) and 1,824 bytes for each ragdoll at once, part of the
 * stage's state: saved, restored, forked and hashed. noh_stage_step steps ragdolls on its own thread.
 * errors   of all: NOT_FOUND the actor is gone; ARG its kind has no ragdolls, or a value is out of range
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7; it leaves hand-over and getting up open */

#define NOH_ACTOR_RAGDOLL_BYTES 1488u

typedef struct noh_kind_ragdoll {
    uint32_t count;         /* actors that may be down at once, 1..NOH_RAGDOLLS_MAX */
    uint32_t substeps;      /* of 1/60 s, 5..NOH_RAGDOLL_SUBSTEPS_MAX; default (0) 10 */
    float mass;             /* kilograms; default (0) 70 for a height of 1.75 m, by its cube */
    const noh_world *world; /* metres; read by steps, must outlive the stage. With `physics`, set before the plan, the
                             * kind is 20,480 bytes larger. NULL: nothing to collide with */
    float stagger_speed;    /* most speed, metres per second, that a hit may give a standing actor that keeps its feet
                             * by steps; default (0) 0.6 of the square root of 9.82 times its leg: 1.73 for 0.85 m.
                             * Below 0: every hit makes it fall */
} noh_kind_ragdoll;

/* For noh_kind_desc.ragdoll.
 * ragdoll  read by plans and by init. NULL: none */
noh_module noh_ragdoll_module(const noh_kind_ragdoll *ragdoll);

/* Turn an actor into a ragdoll. No effect if it is one already.
 * errors  also ARG it is attached, or its scale is not in 0.01..100; LIMIT `count` actors of the kind are down */
noh_result noh_actor_fall(noh_stage *stage, noh_actor actor, noh_error *error);

/* Push an actor. The impulse over the actor's mass decides what a standing one with two legs does: it sways on its
 * feet, steps to keep them (NOH_BODY_STAGGERS; its place then moves, also over the ground of `world`), or falls as a
 * whole over its feet with arms reaching for the ground and joints going limp once it has landed. One without such
 * legs, or one that gets up, falls; one that has fallen is pushed.
 * shapes  point[3] in the world, metres: the body nearest to it is pushed; impulse[3] newton seconds, spread
 *         over the bodies and limited to 23 sizes a second (noh_ragdoll_push)
 * errors  as noh_actor_fall; also ARG a number beyond NOH_NUMBER_MAX */
noh_result noh_actor_hit(noh_stage *stage, noh_actor actor, const float point[3], const float impulse[3],
                         noh_error *error);

#define NOH_GET_UP_CLIPS "get_up" /* prefix of the names of clips for getting up */

typedef struct noh_get_up {
    const char *const *clips; /* [clip_count] names of clips that begin on the ground, such as one from the front and
                               * one from the back; NULL: all of the kind that begin with NOH_GET_UP_CLIPS */
    uint32_t clip_count;      /* 0 with `clips` set: none, blend back to the clips that play */
    uint32_t layer;           /* layer that plays the clip, once, alone */
    uint32_t blend_ticks;     /* blend from the ragdoll's pose to the clip; default (0) 19,200: 0.4 s */
} noh_get_up;

/* Make an actor get up and free its ragdoll. No effect if it stands. If there is no clip for getting up, it blends back
 * to the clips that play. Joints without a body, such as fingers, blend only with noh_kind_desc.inertia; without it
 * they jump.
 * how      NULL: zeros
 * ticks    until it is up; may be NULL
 * errors   also NOT_FOUND the kind has no such clip (where: which); ARG it is dead, or the layer; LIMIT as
 *          noh_actor_play */
noh_result noh_actor_get_up(noh_stage *stage, noh_actor actor, const noh_get_up *how, uint32_t *ticks,
                            noh_error *error);

/* Turn an actor into a ragdoll that cannot get up until noh_actor_revive. Its ragdoll is freed once it lies still; a
 * hit takes one again.
 * errors   as noh_actor_fall */
noh_result noh_actor_kill(noh_stage *stage, noh_actor actor, noh_error *error);
noh_result noh_actor_revive(noh_stage *stage, noh_actor actor, noh_error *error);

/* How much clips move a body of a falling actor. All zeros: limp. */
typedef struct noh_body_hold {
    uint32_t held;  /* 1: clips move it, through obstacles too; for the first body: clips also move the place */
    float hertz;    /* how fast the joint to its parent turns to the angle of the clips: 0 limp, 20 follows closely; up
                     * to NOH_NUMBER_MAX. A ragdoll with strength does not fall asleep */
    float animated; /* 0..1: share of the clips in its shown rotation */
} noh_body_hold;

/* Set how clips move the body that begins at a joint, and all bodies below it, until it is set again.
 * errors  also ARG no body begins there or below (where: the joint) */
noh_result noh_actor_hold_body(noh_stage *stage, noh_actor actor, uint32_t joint, const noh_body_hold *hold,
                               noh_error *error);

typedef enum noh_body_state {
    NOH_BODY_STANDS = 0, /* moved by its clips; also if there is no such actor */
    NOH_BODY_FALLS,
    NOH_BODY_LIES, /* still */
    NOH_BODY_GETS_UP,
    NOH_BODY_STAGGERS /* keeps its feet after a hit: sways or steps */
} noh_body_state;

noh_body_state noh_actor_body(const noh_stage *stage, noh_actor actor);

/* ======== pushes and falls ========
 * What most games do with ragdolls: push actors, wait until they lie still, and play the right clip to get up.
 *
 *   noh_kind_can_fall   whether a kind can have ragdolls, or why not
 *   noh_push_away       a level push away from an eye
 *   noh_actor_push      at a point, or at the chest
 *   noh_fall_step       wait, then get up
 *   noh_fall_lasts      whether a fall is still in progress
 *
 * Keep a noh_fall for each actor that may fall, zero at first, and call noh_fall_step before each step of the stage.
 * errors   as the section on ragdolls of actors
 * Threads: as the stage. */

#define NOH_FALL_STAY_TICKS (NOH_TICKS_PER_SECOND / 5u)           /* time that it lies still */
#define NOH_FALL_WAIT_TICKS (4u * (uint32_t)NOH_TICKS_PER_SECOND) /* then it gets up, at rest or not */

typedef struct noh_fall {
    uint32_t down_ticks, still_ticks; /* since the fall; since the actor came to rest */
    uint32_t rise_ticks;              /* until the clip for getting up ends; 0: none plays */
} noh_fall;

/* Get the bodies that a kind's ragdolls would have, from its mesh and skeleton, and the mass of `ragdoll` if it is set.
 * errors  NOT_FOUND, ARG, LIMIT: why the kind cannot have ragdolls */
noh_result noh_kind_can_fall(const noh_kind_desc *kind, noh_ragdoll_rig *rig, noh_error *error);

/* Get a horizontal impulse at a point, away from an eye.
 * shapes  eye[3], point[3]: in one space; impulse[3]: level, in the unit of `strength` (newton seconds). Zeros if
 *         the point is straight above or below the eye */
void noh_push_away(const float eye[3], const float point[3], float strength, float impulse[3]);

/* Push an actor at a point, or at its chest, so that it falls.
 * shapes  point[3] from noh_stage_pick, in the world's units. NULL: the chest, three quarters of the way up from the
 *         actor's place to its highest joint; the actor must have been posed
 *         impulse[3] newton seconds */
noh_result noh_actor_push(noh_stage *stage, noh_actor actor, const float point[3], const float impulse[3],
                          noh_error *error);

/* Call before noh_stage_step, with the same ticks. An actor that has lain still for NOH_FALL_STAY_TICKS, or has been
 * down for NOH_FALL_WAIT_TICKS, times the square root of its scale if that is above 1, gets up. */
noh_result noh_fall_step(noh_fall *fall, noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t ticks,
                         noh_error *error);

/* 1 while the actor falls, lies, or plays the clip for getting up. */
int noh_fall_lasts(const noh_fall *fall, const noh_stage *stage, noh_actor actor);

/* ======== springs ========
 * Springs of a kind: chains of joints that swing as its actors move.
 *
 *   noh_springs_module   for noh_kind_desc.springs: the springs of the pack (noh build --springs)
 *
 * The stage creates them, runs them after all modifiers, and plans, saves, forks and hashes their state. It has the
 * same bits for any number of jobs. A chain is a noh_spring (low_life.h), moved by the parent of its first joint as
 * posed by clips, faces and modifiers. Springs replace what clips do to the joints of a chain; chains rest in the bind
 * pose.
 *
 * A chain shorter than NOH_SPRINGS_FADE_PIXELS on the screen fades to its rest. Below half of that length it stays at
 * rest and costs nothing. Larger again, it starts from rest and fades in. All chains are at rest after a cut.
 * Threads: as the stage. */

#define NOH_SPRINGS_FADE_PIXELS 16.0f

/* For noh_kind_desc.springs: use the springs that the mesh's pack has for the kind's skeleton. Costs nothing if the
 * pack has none.
 * world  metres; ends of joints stay out of it, without friction, after their own colliders, except on frames with
 *        `cut` and while a chain fades. Frames ask it for every chain that swings, up to eight chains of an actor at a
 *        time; must outlive the stage. It costs each job 1,664 bytes for each joint of the longest chain. Plans and
 *        init refuse a world whose physics answers one thread in a stage with several jobs. NULL: none */
noh_module noh_springs_module(const noh_world *world);

/* ======== motion matching ========
 * Actors that go where the game wants by whatever moment of their clips goes there, without a graph.
 *
 *   noh_match_module   for noh_kind_desc.match: a kind whose packs have a table (noh build --match)
 *   noh_actor_match    how an actor is to move from now on
 *
 *   kind.match = noh_match_module(&match), kind.inertia = 1;
 *   kind.root_axes = NOH_ROOT_GROUND;
 *   noh_match_goal goal = { .velocity = { 0, 0, 1.2f } };
 *   noh_actor_match(stage, actor, &goal, &error);
 *
 * A row of the table describes a moment of a clip: where feet and hips are and how they move, and where the actor will
 * be and face within a second. While an actor has a goal, every search_ticks the stage compares all rows with what
 * plays and with the path to the goal. If another moment fits better by `bias`, it plays from there, and the difference
 * between the poses decays as in NOH_PLAY_INERTIA. Root motion of the clips moves the actor; the goal does not.
 * A search reads about a hundredth of the table. It finds the row that comparing all of them finds, on every processor.
 *
 * The game may play on other layers, and on the same layer once the actor has no goal. Ragdolls and attached actors do
 * not search. In a step the stage searches at most once for each actor.
 *
 * Memory: 48 bytes for each actor, part of the stage's state; 2 bytes for each row, and the table in the pack: 35 bytes
 * for each row, 420 for a second of clips at 12 rows a second.
 * source   Clavet, Motion Matching and The Road to Next-Gen Animation, GDC 2016
 * Threads: the stage's, outside of steps and frames */

typedef struct noh_kind_match {
    uint32_t layer;        /* that clips play on; default (0) the first */
    uint32_t search_ticks; /* between searches; default (0) 4,800: a tenth of a second */
    uint32_t blend_ticks;  /* how long a difference between poses decays; default (0) 14,400 */
    float response_s;      /* time in which half of the way to another velocity or facing is gone, 0.02..10 s; default
                            * (0) 0.27. Shorter: the actor answers sooner, with more abrupt clips */
    float bias;            /* how much better another moment must be, in squared standard deviations of features,
                            * 0.01..1000; default (0) 1 */
    float steer; /* turns that clips make may be this share faster or slower, to face the goal, 0..1; default (0) 0.5;
                  * below 0: none */
} noh_kind_match;

typedef struct noh_match_goal {
    float velocity[3]; /* in the world, units a second, up to 1e6; y is not used */
    float facing[3];   /* direction in the world of the model's z axis, each number up to 1e6; y is not used. Default
                        * (0) where it goes, or where it faces while the velocity is 0 */
    const char *tags;  /* names of the table's tags, separated by blanks: clips that have all of them play. Default
                        * (NULL) all clips. Read by the call */
} noh_match_goal;

/* match  may be NULL: all defaults. Must outlive the stage */
noh_module noh_match_module(const noh_kind_match *match);

/* Set how an actor is to move. The first goal starts a clip at the next step, whatever plays on the layer.
 * goal    NULL: none; the clip that plays goes on
 * errors  ARG the kind has no match module, a number of the goal is out of range; NOT_FOUND the actor is gone, or the
 *         table has no such tag (where: its byte in `tags`) */
noh_result noh_actor_match(noh_stage *stage, noh_actor actor, const noh_match_goal *goal, noh_error *error);

/* ======== faces of actors ========
 * Faces of actors: blinking, gaze, emotions, breathing, and small idle motion.
 *
 *   noh_face_module           for noh_kind_desc.face: give a kind's actors live faces
 *   noh_kind_find_eyes        find the eyes of a kind without eye joints
 *   noh_actor_look_at         a point of the world; noh_actor_look_at_actor: another actor's eyes
 *   noh_actor_set_emotion     an emotion by name, with onset, hold and fade
 *   noh_actor_set_activity    resting, talking, reading
 *   noh_actor_set_visemes     live mouth shapes, such as from a microphone or the network
 *   noh_actor_set_face_flags  calm, or with some automatic motion turned off
 *   noh_actor_seed_face       change the seed of automatic motion
 *   noh_actor_set_identity    the facial shape of a person (face.h)
 *   noh_actor_blink           blink now
 *   noh_actor_face            get the current face
 *
 * A face moves morph targets by recipes (face.h), and joints of head, neck, chest and eyes by name, as far as the kind
 * has them. A head without joints turns, breathes and drifts as a whole, about the base of its skull, which is found by
 * its eyes: spheres, rays, hair and what noh_actor_mesh_at returns follow. A face changes the pose after clips and
 * before the game's modifiers; held floats override it.
 *
 * Speech comes from clips (noh speak) and from noh_actor_set_visemes. The clip's named floats "speech" and "lips-shut"
 * give the share of the mouth that speech uses: emotions leave half of it alone, and lips that close entirely.
 * "speech-brows", "speech-nod", "speech-blink" and "speech-away" are the fields of noh_face_speech (face.h). Live mouth
 * shapes move brows, head, lids and gaze, too: by how far they open, and by pauses. Where clips shut the lids, a face
 * does not blink as well.
 *
 * Memory: 368 bytes for each actor (NOH_ACTOR_FACE_BYTES), part of the stage's state: saved, restored, forked and
 * hashed. A face out of view pauses until it is visible again.
 * errors  of all: NOT_FOUND the actor is gone; ARG its kind has no face, or a value is out of range */

#define NOH_ACTOR_FACE_BYTES 368u

/* Zero is a good value for all fields if the kind has eye joints. Strings and recipes are read at init. */
typedef struct noh_kind_face {
    /* face.eyes: centres in model space at rest, used instead of eye joints; both zero: at the eye joints */
    noh_face_desc face;
    const noh_face_recipe *const *recipes; /* [recipe_count] the best first; default (NULL) the pack's recipe, if
                                            * any, then the three built-in recipes */
    uint32_t recipe_count;
    /* Joint names; default (NULL): those in the pack's recipe (rows joint-head and so on), else common names; "": none.
     * Without a head joint a kind that is a head turns as a whole; with head "", and in all other kinds, only the
     * eyes turn */
    const char *head, *neck, *chest, *eyes[2];
    uint32_t flags;       /* NOH_FACE_* of new actors */
    noh_face_rules rules; /* all but `mouth` 0: those in the pack's recipe */
} noh_kind_face;

/* For noh_kind_desc.face.
 * face  read by plans and by init. NULL: none */
noh_module noh_face_module(const noh_kind_face *face);

/* Find the eyes of a kind at rest, for noh_kind_face.face.eyes: at the eye joints, or without eye joints behind the
 * vertices that its targets for blinking or gaze move, on each side. Depth behind these: 0.19 of the eyes' distance.
 * Without eye joints, the face must look along +z, or with a head joint along -z.
 * kind     mesh, skeleton, nodes and face (NULL: zeros) as for a stage
 * scratch  [scratch_bytes] at least noh_kind_find_eyes_size, aligned to NOH_MEMORY_ALIGN; not kept
 * shapes   eyes: centres of the left and the right eye, model space
 * errors   NOT_FOUND no eye joints and no targets for blinking or gaze; ARG scratch is NULL or misaligned; MEMORY
 *          scratch is too small (need: bytes). eyes are then untouched */
noh_result noh_kind_find_eyes(const noh_kind_desc *kind, void *scratch, size_t scratch_bytes, float eyes[2][3],
                              noh_error *error);
size_t noh_kind_find_eyes_size(const noh_kind_desc *kind);

/* Make an actor look at a fixed point, also while it moves.
 * point  world; NULL: ahead
 * errors also ARG not finite or beyond NOH_NUMBER_MAX */
noh_result noh_actor_look_at(noh_stage *stage, noh_actor actor, const float point[3], noh_error *error);

/* Make an actor look between another actor's eyes, or at its middle if it has no face. The other actor's rest pose in
 * its place is used. The actor looks ahead once the other is gone. */
noh_result noh_actor_look_at_actor(noh_stage *stage, noh_actor actor, noh_actor other, noh_error *error);

/* emotion  "joy", "sadness", "surprise", "fear", "anger", "disgust", "contempt"; the rest as noh_face_set_emotion */
noh_result noh_actor_set_emotion(noh_stage *stage, noh_actor actor, const char *emotion, float amount,
                                 uint32_t onset_ticks, uint32_t hold_ticks, uint32_t fade_ticks, noh_error *error);

noh_result noh_actor_set_activity(noh_stage *stage, noh_actor actor, noh_activity activity, noh_error *error);

/* Set live mouth shapes, until set again. They add to the speech of clips.
 * shapes  visemes[NOH_VISEME_COUNT], 0..1; NULL: none */
noh_result noh_actor_set_visemes(noh_stage *stage, noh_actor actor, const float *visemes, noh_error *error);

noh_result noh_actor_set_face_flags(noh_stage *stage, noh_actor actor, uint32_t flags, noh_error *error);

/* Start the face again with this seed, looking ahead and without emotion. A new actor's seed is its id. */
noh_result noh_actor_seed_face(noh_stage *stage, noh_actor actor, uint32_t seed, noh_error *error);

/* Give an actor the face of a person: hold the floats of the identity's targets (noh_actor_hold_float) at these
 * weights, and adapt blinks to the lids. Takes a held float for each weight that is not 0.
 * mesh    of the kind's pack, as used to make the identity
 * shapes  weights[target_count] of noh_identity_random, up to NOH_NUMBER_MAX; NULL: back to the mesh's own face
 * errors  also NOT_FOUND the kind has no float with a target's name; LIMIT held_float_count is too small (need: the
 *         count). The actor is then unchanged */
noh_result noh_actor_set_identity(noh_stage *stage, noh_actor actor, const noh_identity *identity, const noh_mesh *mesh,
                                  const float *weights, noh_error *error);

noh_result noh_actor_blink(noh_stage *stage, noh_actor actor, noh_error *error);

/* Get the current face. */
noh_result noh_actor_face(const noh_stage *stage, noh_actor actor, noh_face_pose *pose, noh_error *error);

/* ======== gaze and reach of actors ========
 * Actors that look at points and reach for them.
 *
 *   noh_gaze_modifier    a modifier of a kind that turns spine, neck, head and eyes
 *   noh_reach_modifier   a modifier that puts hands on points
 *
 *   noh_gaze_rig_make(&pack, 0, &gaze, &error);
 *   const noh_modifier modifiers[] = { noh_gaze_modifier(&gaze), noh_feet_modifier(&feet),
 *                                    noh_reach_modifier(&reach) };
 *   noh_gaze *g = noh_actor_modifier(stage, actor, 0);      g->point[2] = 3.0f, g->looks = 1;
 *   noh_reach *r = noh_actor_modifier(stage, actor, 2);     r->hands[0].point[1] = 1.0f, r->hands[0].wants = 1;
 *
 * Rigs, noh_gaze and noh_reach are in low_life.h. Points are in the world; the game sets them when they move. List gaze
 * before feet and reach after them: feet move the body. The states are a noh_gaze and a noh_reach; the stage plans,
 * saves, restores, forks and hashes them.
 *
 * In a kind with a face the gaze modifier does nothing: the face turns head and eyes (noh_actor_look_at). The pose is
 * unchanged at a LOD level without the rig's joints. Do not use these modifiers in a kind whose actors are attached to
 * others: a modifier does not know their own place. */

/* rig  of the kind's skeleton; must outlive the stage */
noh_modifier noh_gaze_modifier(const noh_gaze_rig *rig);
noh_modifier noh_reach_modifier(const noh_reach_rig *rig);

#ifdef __cplusplus
}
#endif

#endif
