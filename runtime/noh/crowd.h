/* crowd.h: agents that walk to their goals and stay out of each other's way, objects that they use one at a time, and
 * walkers: actors of a stage that follow agents. */

#ifndef NOH_CROWD_H
#define NOH_CROWD_H

#include <stddef.h>
#include <stdint.h>

#include "base.h"
#include "body.h"
#include "noh.h"
#include "modules.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== crowds ========
 * Many agents that walk to their goals and avoid each other.
 *
 *   noh_crowd_size, noh_crowd_init   a crowd in one block
 *   noh_crowd_add, noh_crowd_remove  add and remove agents
 *   noh_crowd_set_goal, noh_crowd_set_speed   set its goal and speed; noh_crowd_move: its position
 *   noh_crowd_field_aim, noh_crowd_follow     a goal that many agents share, and the paths to it around walls
 *   noh_crowd_step                   advance time
 *   noh_crowd_begin, noh_crowd_jobs, noh_crowd_job   the same on several threads
 *   noh_crowd_agent_at               an agent as shown; noh_crowd_agent_stepped: as of the last step
 *   noh_crowd_hash                   hash of all agents, independent of order
 *
 * Agents are discs on the ground, the plane of x and z. In steps of 1/30 s each agent finds its nearest neighbours in a
 * uniform grid, plans a velocity, and corrects it a few times: sideways, by the time to a collision, and apart, by the
 * overlap after the step. Each agent of a pair takes half of the correction; an agent with speed 0 stays in place, and
 * others walk around it. Agents read only data of the previous step or iteration, so results have the same bits for any
 * order of agents and any number of threads.
 *
 * Obstacles are walls and posts that do not move; agents are never pushed through them. A planned velocity into an
 * obstacle is turned past an end within reach. If no end helps, the agent follows the obstacle until it is nearer to
 * its goal and the way is free: for any shape, it arrives if there is a path at least 4 cm wider than the agent, though
 * not always the shortest. If an agent is too wide to stand on its goal, it stops next to it; if no path leads to the
 * goal, it keeps walking around the barrier. When agents meet head-on in a door, one side makes way for the other.
 *
 * Flow fields give shortest paths: for each cell of a grid, the direction of the shortest path to a goal, in one byte.
 * Steps build them with bounded work per step; any number of agents may follow one.
 *
 * On a height field slopes slow agents down, agents do not walk up slopes that are too steep, and flow fields lead
 * around these. An agent's height is the field's (noh_field_height).
 *
 * A crowd is one block without pointers: a copy continues with the same bits on every processor.
 * source   Weiss, Litteneker, Jiang, Terzopoulos: Position-Based Multi-Agent Dynamics for Real-Time Crowd Simulation,
 *          MiG 2017 (contacts, predicted contacts, averaged Jacobi iterations); van den Berg, Guy, Lin, Manocha:
 *          Reciprocal n-Body Collision Avoidance, ISRR 2009 (NOH_CROWD_ORCA); Zhao: A fast sweeping method for Eikonal
 *          equations, Mathematics of Computation 2005; Bak, McLaughlin, Renzi: Some improvements for the fast sweeping
 *          method, SIAM Journal on Scientific Computing 2010 (only cells whose neighbours have changed); Lumelsky,
 *          Stepanov: Path-planning strategies for a point mobile automaton moving amidst unknown obstacles of arbitrary
 *          shape, Algorithmica 1987 (following obstacles); Tobler: Three presentations on geographical analysis
 *          and modeling, 1993 (speed by slope)
 * Threads: a crowd belongs to one thread at a time; only noh_crowd_job may be called from several at once. */

/* The agent steers only by the rules of low_stage.h: neighbours and obstacles repel it. FLOCK: it also moves along with
 * its neighbours. */
#define NOH_CROWD_FORCES 2u
#define NOH_CROWD_FLOCK 6u

#define NOH_CROWD_STEP_TICKS 1600u /* 1/30 s */

/* An obstacle: a wall with rounded ends, or a post if `from` and `to` are equal. */
typedef struct noh_crowd_obstacle {
    float from[2], to[2]; /* x, z */
    float radius;         /* of a post, or half the thickness of a wall; 0.. */
} noh_crowd_obstacle;

typedef struct noh_crowd_desc {
    uint32_t agent_max;      /* 1..NOH_CROWD_AGENTS_MAX */
    uint32_t job_count;      /* jobs that may run at once, 1..NOH_CROWD_JOBS_MAX; default (0) 1 */
    float origin[2];         /* smallest x and z of the grid; agents may leave it; obstacles count only within it */
    float extent[2];         /* of the grid along x and z, above 0 */
    float reach;             /* distance at which agents see neighbours and obstacles; default (0) 3 */
    uint32_t obstacle_count; /* 0..NOH_CROWD_OBSTACLES_MAX */
    const noh_crowd_obstacle *obstacles; /* [obstacle_count]; copied by init */
    uint32_t field_count;                /* flow fields over the grid's area, 0..NOH_CROWD_FIELDS_MAX */
    float field_cell;        /* edge of their cells, at most NOH_CROWD_FIELD_CELLS_MAX cells; default (0) 0.5 */
    float field_radius;      /* radius of the widest agent that follows one, 0..half of the reach, at least half a cell:
                              * finds paths wider than twice this plus a cell */
    const noh_field *ground; /* init reads its slopes for each of these cells; NULL: level */
    float slope_max;         /* steepest slope that agents walk up, rise over run, 0..2; default (0) 1 */
    uint32_t field_visits;   /* cells that a step visits to build a field; default (0) 8192 */
} noh_crowd_desc;

/* An agent, for noh_crowd_add and noh_crowd_agent_at. */
typedef struct noh_crowd_agent {
    float position[2]; /* x, z */
    float velocity[2]; /* metres per second */
    float goal[2];     /* it slows down before its goal and stays there; when queried: the goal of the field it
                        * follows */
    float radius;      /* above 0, at most half of the reach */
    float speed;       /* preferred speed, 0..15 radii per second; 0: it stays in place */
    uint32_t flags;    /* NOH_CROWD_ORCA, _FORCES, _FLOCK or 0 */
    uint32_t id;       /* unique in the crowd, and the same in every run, so that results do not depend on indices */
} noh_crowd_agent;

/* The agent uses optimal reciprocal collision avoidance (ORCA) instead of corrected plans: smooth among few agents,
 * slower through many, with overlaps in dense crowds. Pairs with other agents still share avoidance half and half. */
#define NOH_CROWD_ORCA 1u

typedef struct noh_crowd noh_crowd;

/* The exact bytes of a crowd; 0 for an invalid desc. 156, plus 88 per agent and 4 per grid cell. With obstacles also 16
 * per agent, 4 per grid cell, 20 per obstacle and 2 for each cell within reach of it. With ground also 28, and 2 per
 * cell of flow fields. With flow fields also 2,136, 24 per field, and for each of their cells 5 plus 1 per field.
 * Rounded up to 16. Grid cells are no smaller than the reach, and at most half as many as agents, plus one. */
size_t noh_crowd_size(const noh_crowd_desc *desc);

/* Build a crowd without agents.
 * errors  ARG memory is NULL or misaligned, or a number is out of range (where: the obstacle); LIMIT no agents, or too
 *         many agents, jobs, obstacles, flow fields or cells of flow fields; MEMORY memory is too small */
noh_result noh_crowd_init(void *memory, size_t bytes, const noh_crowd_desc *desc, noh_crowd **crowd, noh_error *error);

/* Add an agent at an index of your choice, replacing the agent there. noh_crowd_remove removes one.
 * errors  ARG a number is out of range (where: the index) */
noh_result noh_crowd_add(noh_crowd *crowd, uint32_t index, const noh_crowd_agent *agent, noh_error *error);
void noh_crowd_remove(noh_crowd *crowd, uint32_t index);

/* Move an agent to a position, or as far towards it as walls allow; its goal and speed stay. position[2] finite */
void noh_crowd_move(noh_crowd *crowd, uint32_t index, const float position[2]);
/* Set an agent's own goal. goal[2] finite */
void noh_crowd_set_goal(noh_crowd *crowd, uint32_t index, const float goal[2]);
/* Set an agent's speed, clamped to 0..15 radii per second. */
void noh_crowd_set_speed(noh_crowd *crowd, uint32_t index, float speed);

/* Move the world's origin, together with noh_stage_shift_origin: subtracts `by` from agents, goals, obstacles, grids
 * and flow fields. It is exact: a crowd computes relative to the middle of its grid, so agents far from the origin walk
 * as they do near it. by[2] x, z, finite; not during a step */
void noh_crowd_shift_origin(noh_crowd *crowd, const float by[2]);

/* ---- shared goals ---- */

/* Set the goal of a flow field; if no agent can stand there, the nearest place where one can. The following steps build
 * the fields one after another; until then agents follow the previous field, or go straight without one.
 * shapes  goal[2] finite; clamped to the grid's area */
void noh_crowd_field_aim(noh_crowd *crowd, uint32_t field, const float goal[2]);
/* Build flow fields now, visiting up to `visits` cells, for loading screens; steps visit field_visits each.
 * returns  the number of flow fields not built yet */
uint32_t noh_crowd_field_build(noh_crowd *crowd, uint32_t visits);
/* Make an agent follow a flow field; it goes straight where it sees the goal or no path leads to it. NOH_NONE: back to
 * its own last goal. */
void noh_crowd_follow(noh_crowd *crowd, uint32_t index, uint32_t field);
/* Get the direction of a flow field at a position.
 * shapes   direction[2] unit
 * returns  0 if no path leads to the goal from there, or the field is not built; nothing is then written */
int noh_crowd_field_at(const noh_crowd *crowd, uint32_t field, const float at[2], float direction[2]);

/* Advance time by ticks, in steps of NOH_CROWD_STEP_TICKS; at most NOH_CROWD_STEPS_MAX steps per call, the rest of a
 * longer time is dropped.
 * returns  the number of steps made */
uint32_t noh_crowd_step(noh_crowd *crowd, uint32_t ticks);

/* Advance time on several threads. Change agents only after all jobs are done.
 *   noh_crowd_begin(crowd, ticks);
 *   while ((count = noh_crowd_jobs(crowd)) > 0)
 *       noh_crowd_job(crowd, i) for each i below count, on any threads, in any order; wait for all
 * returns  the number of steps that will be made */
uint32_t noh_crowd_begin(noh_crowd *crowd, uint32_t ticks);
uint32_t noh_crowd_jobs(noh_crowd *crowd);
void noh_crowd_job(noh_crowd *crowd, uint32_t job);

/* Get an agent as shown, between its last two steps.
 * returns  0 if there is none; `agent` is then untouched */
int noh_crowd_agent_at(const noh_crowd *crowd, uint32_t index, noh_crowd_agent *agent);
/* Get an agent as of the last step; returns as noh_crowd_agent_at. */
int noh_crowd_agent_stepped(const noh_crowd *crowd, uint32_t index, noh_crowd_agent *agent);

/* A hash of all agents as of the last step, independent of their indices; equal on every processor, for any number of
 * jobs. */
uint32_t noh_crowd_hash(const noh_crowd *crowd);

/* ======== walkers ========
 * Agents of a crowd as actors of a stage.
 *
 *   noh_walkers_size, noh_walkers_init   walkers in one block, and their clips
 *   noh_walkers_add, noh_walkers_remove  bind an actor to an agent, and unbind it
 *   noh_walkers_face                     set the direction for a walker that stands
 *   noh_walkers_step                     make places and clips follow the agents
 *   noh_walkers_feet_modifier            feet on the ground, for the nearest walkers
 *   noh_walkers_near                     choose the nearest walkers
 *   noh_walkers_push                     make walkers near a point fall, as ragdolls from a pool
 *   noh_walkers_tend                     advance fallen walkers: wait, get up, walk on
 *
 *   noh_walkers_tend(walkers, crowd, stage, ACTS, ticks, NULL);
 *   noh_crowd_step(crowd, ticks);
 *   noh_walkers_step(walkers, crowd, stage, &ground, ticks, NULL);
 *   noh_stage_step(stage, ticks, ...);
 *   noh_walkers_near(walkers, stage, view.eye);
 *   noh_stage_frame_begin(stage, &view, 1, NULL);
 *
 * The crowd makes steps of 1/30 s; frames may have any rate. An actor follows the shown position of its agent
 * (noh_crowd_agent_at) at the pace of its own walk clip, forwards or backwards. It turns at a limited speed, about its
 * standing foot, and only while the other foot is in the air, so a standing foot does not slide. A standing actor
 * starts with a step, stops with a step that brings its feet together, and turns in place by steps. It stays within a
 * few centimetres of its agent and may stop 0.2 m from it. It falls behind by up to 0.7 m if the agent turns or is
 * pushed faster than feet can follow; beyond 0.7 m the actor is pulled along. Behind an agent slower than a quarter of
 * the walk's speed it makes single steps. Above the walk's speed it runs: blended if sync markers show that both clips
 * are in step, otherwise by a change of clip.
 * This needs feet_modifier (for the soles), two legs, an idle clip, and a walk in which each leg swings past the other
 * above the ground. Without an idle clip the actor always walks. Without soles it turns about its middle at any time,
 * and below a quarter of the walk's speed it takes shorter steps: the walk blended with idle.
 *
 * The kind's clips must not move the actor themselves: set root_axes to NOH_ROOT_X | NOH_ROOT_Z | NOH_ROOT_BY_GAME (the
 * heading of a root stays in the pose). Init measures how far the root moves in one loop; its sway about the straight
 * line is added to the actor's place. The layer is a base layer whose tracks belong to the walkers; play other clips on
 * layers above it.
 *
 * Walkers are one block without pointers. A copy of it, of the crowd and of the stage's state continues with the same
 * bits.
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 13, corrected: there, clips play at one speed
 *         however fast the agent walks
 * Threads: walkers belong to the stage's thread. */

/* Zero is a good value for all but walker_max and walk. */
typedef struct noh_walkers_desc {
    uint32_t walker_max;    /* 1..NOH_CROWD_AGENTS_MAX; required */
    uint32_t near_max;      /* most walkers with feet on the ground at once; 0 without feet_modifier */
    uint32_t feet_modifier; /* 1 + the index of noh_walkers_feet_modifier in the kind's modifiers; default 0: none */
    uint32_t kind, layer;   /* of the stage; the layer has a track for each clip */
    const char *walk;       /* clip, played as a loop: straight ahead, at a constant speed; required */
    const char *idle, *run; /* default (NULL) none */
    float walk_speed, run_speed; /* of the clips, model units a second; default (0): measured from their roots */
    float turn_speed;            /* radians a second, at most; default (0) 4 */
} noh_walkers_desc;

typedef struct noh_walkers noh_walkers;

/* The exact bytes: 8,016, 96 per walker and 8 per near_max; rounded up to 16. 0 for an invalid desc. */
size_t noh_walkers_size(const noh_walkers_desc *desc);

/* Build walkers, none bound yet.
 * stage   its clips are measured; the pointer is not kept
 * errors  ARG memory is NULL or misaligned, a number is out of range, the kind, layer or modifier does not exist, the
 *         kind's roots move actors, or a clip moves no root and its speed is 0; NOT_FOUND no such clip (where: 0 walk,
 *         1 idle, 2 run); LIMIT; MEMORY; with clip_reserve as noh_stage_load_clip says */
noh_result noh_walkers_init(void *memory, size_t bytes, const noh_walkers_desc *desc, noh_stage *stage,
                            noh_walkers **walkers, noh_error *error);

/* Bind an actor of the desc's kind to an agent. The actor moves there at once, onto ground at most 2 m above its place,
 * and stands. The phase of its clips depends on the index, so that walkers do not move in unison.
 * index   below walker_max; the previous actor of this index is unbound
 * heading [2] unit vector x, z to face at first; NULL: +z
 * errors  NOT_FOUND the actor is gone; ARG the index is out of range, or the actor is of another kind; with
 *         clip_reserve as noh_stage_load_clip says. The actor is then as it was */
noh_result noh_walkers_add(noh_walkers *walkers, uint32_t index, noh_stage *stage, noh_actor actor, uint32_t agent,
                           const float heading[2], noh_error *error);
void noh_walkers_remove(noh_walkers *walkers, uint32_t index);

/* Set the direction that a walker turns to when it stands.
 * direction [2] x, z of any length; NULL: as it arrived */
void noh_walkers_face(noh_walkers *walkers, uint32_t index, const float direction[2]);

/* Move the world's origin, together with noh_crowd_shift_origin and noh_stage_shift_origin: subtracts `by` from
 * walkers. x and z are relative to the crowd's origin, so walkers are as precise at 100 km as at the origin. Heights
 * are floats in the world. */
void noh_walkers_shift_origin(noh_walkers *walkers, const float by[3]);

/* Make actors and their clips follow their agents. Call before noh_stage_step, with the same ticks. An actor that is
 * gone is unbound; a fallen actor (modules.h) is not changed until it stands again.
 * ground  under the walkers; NULL: the plane y = 0
 * errors  ARG called during a step or a frame of the stage */
noh_result noh_walkers_step(noh_walkers *walkers, const noh_crowd *crowd, noh_stage *stage, const noh_ground *ground,
                            uint32_t ticks, noh_error *error);

/* Get the modifier that puts the feet of walkers chosen by noh_walkers_near on the ground. It fades in and out within a
 * quarter of a second. For all other walkers it costs one comparison.
 * feet    must outlive the stage */
noh_modifier noh_walkers_feet_modifier(const noh_kind_feet *feet);

/* Choose the near_max walkers nearest to a point. Walkers chosen by the previous call count as a tenth nearer, which
 * prevents flicker between two. Does nothing during a step or a frame.
 * returns  number of walkers chosen */
uint32_t noh_walkers_near(noh_walkers *walkers, noh_stage *stage, const float eye[3]);

/* ---- falling ---- */

/* Push standing walkers within a radius of a point (measured in x and z) away from it. They fall, the nearest first,
 * as long as their kind has a ragdoll left (noh_kind_ragdoll.count); the others stay on their feet.
 * shapes   point[3] in the stage's unit; y is the height of the hit
 * impulse  newton seconds on each, away from the point; a walker at the point itself falls in the direction it faces
 * returns  number of walkers that fell; 0 for a kind without ragdolls, and during a step or a frame */
uint32_t noh_walkers_push(noh_walkers *walkers, noh_stage *stage, const float point[3], float radius, float impulse);

/* Advance fallen walkers. Call before noh_crowd_step, with the same ticks. The agent of a fallen walker stays under it,
 * so that others walk around it. The walker gets up (modules.h), frees its ragdoll and walks on at its previous
 * pace; a dead one (noh_actor_kill) stays down. This covers walkers that fell by noh_actor_fall or noh_actor_hit, too.
 * layer    that plays the clip for getting up; not the walkers' own layer
 * returns  number of walkers not on their feet
 * errors   as noh_fall_step, which is tried again at the next call; ARG the layer, or called during a step or a
 *          frame */
uint32_t noh_walkers_tend(noh_walkers *walkers, noh_crowd *crowd, noh_stage *stage, uint32_t layer, uint32_t ticks,
                          noh_error *error);

/* Whether a walker has fallen and is not on its feet again. */
int noh_walkers_is_down(const noh_walkers *walkers, uint32_t index);

/* ======== objects that agents use ========
 * Objects that agents use: a bench to sit on, a stall to eat at, a drum to listen to.
 *
 *   noh_smart_size, noh_smart_init      objects and their agents, in one block
 *   noh_smart_enter, noh_smart_leave    add and remove an agent
 *   noh_smart_request                   request the best free slot for a need
 *   noh_smart_arrive                    the agent has reached its slot
 *   noh_smart_release                   cancel a request or a use
 *   noh_smart_step                      advance time: needs grow, uses end, free slots are assigned
 *   noh_smart_use_of, noh_smart_most    the phase of an agent; its largest need
 *
 * An object stores where its slots are, the direction to face there, the clips to enter, use and leave a slot, and
 * which need it satisfies at what rate. Agents have needs, 0 to 1, which grow.
 *
 * An agent is in one of these phases:
 *   FREE      no request
 *   WAITING   in the queue for its need, because no slot is free
 *   GOING     a slot is reserved; ends with noh_smart_arrive
 *   ENTERING  for enter_ticks of the slot
 *   USING     until the need is gone, or use_ticks have passed
 *   LEAVING   for leave_ticks; then it is FREE
 * An agent holds its slot alone from GOING to the end of LEAVING. If it does not arrive within the object's
 * going_ticks, it loses the slot and is FREE. noh_smart_leave frees its slot at once.
 *
 * No agent starves: a free slot goes to the agent that has waited longest for its need. With n agents, s slots for a
 * need, no agent waits longer than ceil(n / s) h: h is the largest sum of a slot's going, enter, use and leave ticks,
 * plus five steps, since each of four phases may end a step late and a slot is passed on in the next.
 *
 * Results do not depend on addresses, and ties are broken by index: the same bits everywhere. The block has no
 * pointers, so a copy continues identically.
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 13 (smart objects, without reservation)
 * Threads: smart objects belong to one thread at a time. */

/* A place for one agent. Clips are numbers chosen by the game, such as name hashes or indices; 0: none. */
typedef struct noh_smart_slot {
    float at[2];   /* x, z in the world */
    float face[2]; /* direction to face: unit x, z */
    uint32_t enter_clip, use_clip, leave_clip;
    uint32_t enter_ticks, leave_ticks;
    uint32_t use_ticks; /* longest use; above 0 */
} noh_smart_slot;

typedef struct noh_smart_object {
    uint32_t need;                   /* the need it satisfies, 0..need_count - 1 */
    float rate;                      /* satisfaction per second, above 0 */
    uint32_t going_ticks;            /* time to arrive; above 0 */
    uint32_t first_slot, slot_count; /* in the desc's slots */
} noh_smart_object;

typedef struct noh_smart_desc {
    uint32_t agent_max;                /* 1..NOH_CROWD_AGENTS_MAX */
    uint32_t need_count;               /* 1..NOH_SMART_NEEDS_MAX */
    uint32_t object_count;             /* 1..NOH_SMART_OBJECTS_MAX */
    uint32_t slot_count;               /* 1..NOH_SMART_SLOTS_MAX */
    const noh_smart_object *objects;   /* [object_count]; copied by init, like slots */
    const noh_smart_slot *slots;       /* [slot_count] */
    float growth[NOH_SMART_NEEDS_MAX]; /* of each need per second, 0.. */
} noh_smart_desc;

typedef enum noh_smart_phase {
    NOH_SMART_AWAY = 0, /* no such agent */
    NOH_SMART_FREE,
    NOH_SMART_WAITING,
    NOH_SMART_GOING,
    NOH_SMART_ENTERING,
    NOH_SMART_USING,
    NOH_SMART_LEAVING
} noh_smart_phase;

/* The phase of an agent and its slot. */
typedef struct noh_smart_use {
    noh_smart_phase phase;
    uint32_t need;         /* from WAITING on */
    uint32_t object, slot; /* from GOING on; otherwise NOH_NONE. slot: index in the desc's slots */
    uint32_t ticks;        /* in this phase so far */
} noh_smart_use;

typedef struct noh_smart noh_smart;

/* The exact bytes: 160, plus 20 per object, 44 per slot, and per agent 36 and 4 per need; rounded up to 16. 0 for an
 * invalid desc. */
size_t noh_smart_size(const noh_smart_desc *desc);

/* Build smart objects without agents.
 * errors  ARG memory is NULL or misaligned, a number is out of range (where: the object or slot), or a slot belongs to
 *         no object or to two; LIMIT; MEMORY memory is too small */
noh_result noh_smart_init(void *memory, size_t bytes, const noh_smart_desc *desc, noh_smart **smart, noh_error *error);

/* Add an agent, FREE, replacing the agent at this index.
 * needs   [need_count] clamped to 0..1; NULL: all 0 */
void noh_smart_enter(noh_smart *smart, uint32_t agent, const float *needs);
/* Remove an agent in any phase and free its slot. */
void noh_smart_leave(noh_smart *smart, uint32_t agent);

/* Request a slot for a need of a FREE agent. The object with a free slot and the largest rate / (1 + distance in
 * metres) is chosen, and its nearest free slot; but if other agents already wait for this need, the agent queues behind
 * them.
 * at       [2] the agent's position, x, z
 * returns  1: it is now GOING or WAITING; 0: it was not FREE, or no object satisfies the need; nothing has changed */
int noh_smart_request(noh_smart *smart, uint32_t agent, uint32_t need, const float at[2]);
/* Report that an agent has reached its slot.
 * returns  1: it was GOING and is now ENTERING; 0: nothing has changed */
int noh_smart_arrive(noh_smart *smart, uint32_t agent);
/* Cancel the request of an agent, which is then FREE; an agent that has arrived is then LEAVING.
 * returns  1: its phase has changed */
int noh_smart_release(noh_smart *smart, uint32_t agent);

/* Advance time: needs grow or are satisfied, phases end, and free slots go to waiting agents. Phases that end during
 * the step count as ending at its end. At most 2^30 - 1 ticks, six hours; the rest of a longer time is dropped. */
void noh_smart_step(noh_smart *smart, uint32_t ticks);

void noh_smart_use_of(const noh_smart *smart, uint32_t agent, noh_smart_use *use);
/* The agent's largest need that some object satisfies, the first of equal ones; NOH_NONE: none is above `least`. */
uint32_t noh_smart_most(const noh_smart *smart, uint32_t agent, float least);

/* A slot, as in the desc. */
const noh_smart_slot *noh_smart_slot_at(const noh_smart *smart, uint32_t slot);
/* The agent that holds a slot; NOH_NONE: it is free. */
uint32_t noh_smart_holder(const noh_smart *smart, uint32_t slot);

#ifdef __cplusplus
}
#endif

#endif
