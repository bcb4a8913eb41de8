/* crowd.h: many agents that walk to their goals and stay out of each other's way.
 *
 *   noh_crowd_size, noh_crowd_init   a crowd in one block
 *   noh_crowd_put, noh_crowd_remove  an agent enters, leaves
 *   noh_crowd_aim, noh_crowd_pace    where it wants to go, how fast; noh_crowd_move: where it is
 *   noh_crowd_field_aim, noh_crowd_follow   a goal that many agents share, behind any walls, and who follows it
 *   noh_crowd_step                   time moves on
 *   noh_crowd_begin, noh_crowd_jobs, noh_crowd_job   the same on several threads
 *   noh_crowd_agent_at               where an agent is, as shown; noh_crowd_agent_stepped: as of the last step
 *   noh_crowd_hash                   of all agents, in any order
 *
 * Agents are discs on the ground, which is the plane of x and z. In steps of 1/30 s each sees its nearest neighbours in
 * a uniform grid, plans the velocity that it would like, and corrects it a few times: sideways, by how soon it would
 * meet a neighbour, and apart, by how much they would overlap after the step. Both of a pair yield half of that; an
 * agent whose speed is 0 holds its place, and others make way. What an agent reads was written in the step or iteration
 * before, so that neither the order of agents nor the number of threads changes a bit. Obstacles are walls and posts
 * that do not move, and no agent is ever pushed through. A wish that leads into one is turned past an end within reach.
 * Where none helps, the agent walks along what blocks it until it is nearer to its goal and can go on: whatever the
 * shape, it arrives where there is a way that it fits through by 4 cm. The way is not always the shortest. A goal that
 * it is too wide to stand on is the place beside it; where no way leads to its goal, it walks round what shuts that in
 * for as long as it is asked to. Against each other in a door, those of one side make way for those of the other.
 *
 * Shortest ways are found by a flow field: for each cell of a grid the direction of the shortest way to a goal, in one
 * byte. Steps build it in slices of bounded work; any number of agents may follow it.
 *
 * Where the ground is a height field agents are slowed by its slopes, do not walk up what is too steep, and are led
 * around it by flow fields. Their height is the field's (noh_field_height).
 *
 * A crowd is one block without pointers: a copy of it continues with the same bits, on every processor.
 * source   Weiss, Litteneker, Jiang, Terzopoulos: Position-Based Multi-Agent Dynamics for Real-Time Crowd Simulation,
 *          MiG 2017 (contacts, predicted contacts, averaged Jacobi iterations); van den Berg, Guy, Lin, Manocha:
 *          Reciprocal n-Body Collision Avoidance, ISRR 2009 (NOH_CROWD_ORCA); Zhao: A fast sweeping method for Eikonal
 *          equations, Mathematics of Computation 2005; Bak, McLaughlin, Renzi: Some improvements for the fast sweeping
 *          method, SIAM Journal on Scientific Computing 2010 (only cells whose neighbours have changed); Lumelsky,
 *          Stepanov: Path-planning strategies for a point mobile automaton moving amidst unknown obstacles of arbitrary
 *          shape, Algorithmica 1987 (along what blocks the way)
 *          Tobler: Three presentations on geographical analysis and modeling, 1993 (speed by slope)
 * Threads: a crowd belongs to one thread at a time; noh_crowd_job alone may be called from several at once. */
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

/* What agents walk around: a wall where `from` and `to` differ, with rounded ends, a post where they are equal. */
typedef struct noh_crowd_obstacle {
    float from[2], to[2]; /* x, z */
    float radius;         /* 0.., of a post; half the thickness of a wall */
} noh_crowd_obstacle;

typedef struct noh_crowd_desc {
    uint32_t agent_max;      /* 1..NOH_CROWD_AGENTS_MAX */
    uint32_t job_count;      /* noh_crowd_job may run this many at once, 1..NOH_CROWD_JOBS_MAX; default (0) 1 */
    float origin[2];         /* of the grid: its least x and z; agents may leave it, obstacles are known within it */
    float extent[2];         /* of the grid along x and z, above 0 */
    float reach;             /* how far an agent looks for neighbours and obstacles; default (0) 3 */
    uint32_t obstacle_count; /* 0..NOH_CROWD_OBSTACLES_MAX */
    const noh_crowd_obstacle *obstacles; /* [obstacle_count]; copied by init */
    uint32_t field_count;                /* flow fields over the grid's area, 0..NOH_CROWD_FIELDS_MAX */
    float field_cell;   /* edge of their cells, which are at most NOH_CROWD_FIELD_CELLS_MAX; default (0) 0.5 */
    float field_radius; /* of the widest agent that follows one, 0..half of the reach, at least half a cell: a way is
                           found where it is wider than twice this and a cell */
    const noh_field *ground; /* slopes are read by init, for each of these cells; NULL: level */
    float slope_max;         /* rise of a run of 1 that is too steep to walk up, 0..2; default (0) 1 */
    uint32_t field_visits;   /* cells that a step looks at for a field that is being built; default (0) 8192 */
} noh_crowd_desc;

/* An agent as it enters, and as it is asked for. */
typedef struct noh_crowd_agent {
    float position[2]; /* x, z */
    float velocity[2]; /* metres per second */
    float goal[2];     /* it slows down before its goal, and stays there; as asked: that of a field it follows */
    float radius;      /* above 0, at most half of the reach */
    float speed;       /* that it likes to walk at, 0..15 radii per second; 0: it holds its place */
    uint32_t flags;    /* NOH_CROWD_ORCA, _FORCES, _FLOCK or 0 */
    uint32_t id; /* tells agents apart whatever their indices are: equal in each run, no two of a crowd the same */
} noh_crowd_agent;

/* This agent takes the velocity of optimal reciprocal collision avoidance (ORCA) in place of plans that are corrected:
 * smooth among few, slower through many, and it overlaps where it is dense. Others make way for it by half, as it does
 * for them. */
#define NOH_CROWD_ORCA 1u

/* This agent steers by the rules of flock.h alone: it is repelled by neighbours and obstacles on its way. FLOCK:
 * it goes along with its neighbours, too. */
#define NOH_CROWD_FORCES 2u
#define NOH_CROWD_FLOCK 6u

typedef struct noh_crowd noh_crowd;

/* The exact bytes of a crowd: 156, 88 an agent, 4 a cell of the grid; with obstacles 16 an agent and 4 a cell more, 20
 * an obstacle and 2 for each cell within reach of it; rounded up to 16. Cells are no smaller than the reach, and no more
 * than half as many as agents, and one. With ground 28 and 2 a cell of flow fields. With flow fields 2,136, 24 a field, and for each
 * of their cells 5 and one a field. 0 for an impossible desc. */
size_t noh_crowd_size(const noh_crowd_desc *desc);

/* A crowd without agents.
 * errors  ARG memory is NULL or misaligned, a number is out of its range (where: the obstacle); LIMIT no agents, or too
 *         many agents, jobs, obstacles, flow fields or cells of these; MEMORY it is too small */
noh_result noh_crowd_init(void *memory, size_t bytes, const noh_crowd_desc *desc, noh_crowd **crowd, noh_error *error);

/* An agent enters at an index of the caller's choice, in place of the one that is there.
 * errors  ARG a number is out of its range (where: the index) */
noh_result noh_crowd_put(noh_crowd *crowd, uint32_t index, const noh_crowd_agent *agent, noh_error *error);
void noh_crowd_remove(noh_crowd *crowd, uint32_t index);

/* An agent stands somewhere else from now on, as far on the way there as walls let it: one that was carried there, or
 * fell. What it wants stays. position[2] finite */
void noh_crowd_move(noh_crowd *crowd, uint32_t index, const float position[2]);
/* goal[2] finite */
void noh_crowd_aim(noh_crowd *crowd, uint32_t index, const float goal[2]);
/* speed 0..15 radii per second: what is outside is clamped */
void noh_crowd_pace(noh_crowd *crowd, uint32_t index, float speed);

/* Move the origin of the crowd's world, with noh_stage_shift_origin: agents, goals, obstacles, grids and flow fields are
 * less by `by` then. Nothing is lost: a crowd counts from the middle of its grid, so agents far from the origin walk as
 * they do at it. by[2] x, z, finite; not while a step is under way */
void noh_crowd_shift_origin(noh_crowd *crowd, const float by[2]);

/* ---- goals that many share ---- */

/* A flow field is to lead to a goal, or to the place nearest to it where an agent can stand. Fields are built one after
 * the other by the steps that follow; until then agents follow the one before, and where there is none go straight.
 * shapes  goal[2] finite: within the grid's area, or clamped to it */
void noh_crowd_field_aim(noh_crowd *crowd, uint32_t field, const float goal[2]);
/* Look at up to this many cells at once, as when a game loads, in place of field_visits a step.
 * returns  flow fields that are asked for and not built yet */
uint32_t noh_crowd_field_build(noh_crowd *crowd, uint32_t visits);
/* An agent goes where a flow field leads, and straight from where it can see its goal or no way leads to it. NOH_NONE:
 * to a goal of its own again, the last that it was given. */
void noh_crowd_follow(noh_crowd *crowd, uint32_t index, uint32_t field);
/* shapes   direction[2] unit
 * returns  0 where no way leads to the goal from, or the field is not built: nothing is written */
int noh_crowd_field_at(const noh_crowd *crowd, uint32_t field, const float at[2], float direction[2]);

/* Time passes, in any pieces; in one call by NOH_CROWD_STEPS_MAX steps, what is left of a longer time is dropped.
 * returns  steps that were made */
uint32_t noh_crowd_step(noh_crowd *crowd, uint32_t ticks);

/* The same on several threads. Agents enter, leave and change their minds when all jobs are done.
 *   noh_crowd_begin(crowd, ticks);
 *   while ((count = noh_crowd_jobs(crowd)) > 0)
 *       noh_crowd_job(crowd, i) for each i below count, on any threads, in any order; wait for all
 * returns  steps that will be made */
uint32_t noh_crowd_begin(noh_crowd *crowd, uint32_t ticks);
uint32_t noh_crowd_jobs(noh_crowd *crowd);
void noh_crowd_job(noh_crowd *crowd, uint32_t job);

/* An agent as shown: between its last two steps.
 * returns  0 where there is none: `agent` is untouched */
int noh_crowd_agent_at(const noh_crowd *crowd, uint32_t index, noh_crowd_agent *agent);
/* As of the last step. */
int noh_crowd_agent_stepped(const noh_crowd *crowd, uint32_t index, noh_crowd_agent *agent);

/* Of all agents as of the last step, whatever their indices are: equal on every processor, for any number of jobs. */
uint32_t noh_crowd_hash(const noh_crowd *crowd);

#ifdef __cplusplus
}
#endif

#endif
