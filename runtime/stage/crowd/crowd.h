/* crowd.h: many agents that walk to their goals and avoid each other.
 *
 *   noh_crowd_size, noh_crowd_init   a crowd in one block
 *   noh_crowd_put, noh_crowd_remove  add and remove agents
 *   noh_crowd_aim, noh_crowd_pace    set its goal and speed; noh_crowd_move: its position
 *   noh_crowd_field_aim, noh_crowd_follow   a goal that many agents share, and the paths to it around walls
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
#ifndef NOH_CROWD_CROWD_H
#define NOH_CROWD_CROWD_H

#include <stddef.h>
#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "life/physics/world.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* An agent, for noh_crowd_put and noh_crowd_agent_at. */
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

/* The agent steers only by the rules of flock.h: neighbours and obstacles repel it. FLOCK: it also moves along with its
 * neighbours. */
#define NOH_CROWD_FORCES 2u
#define NOH_CROWD_FLOCK 6u

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
noh_result noh_crowd_put(noh_crowd *crowd, uint32_t index, const noh_crowd_agent *agent, noh_error *error);
void noh_crowd_remove(noh_crowd *crowd, uint32_t index);

/* Move an agent to a position, or as far towards it as walls allow; its goal and speed stay. position[2] finite */
void noh_crowd_move(noh_crowd *crowd, uint32_t index, const float position[2]);
/* Set an agent's own goal. goal[2] finite */
void noh_crowd_aim(noh_crowd *crowd, uint32_t index, const float goal[2]);
/* Set an agent's speed, clamped to 0..15 radii per second. */
void noh_crowd_pace(noh_crowd *crowd, uint32_t index, float speed);

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

#ifdef __cplusplus
}
#endif

#endif
