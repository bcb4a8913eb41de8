/* crowd_internal.h: a crowd's block, and what the phases of a step share. Threads: as crowd.h. */
#ifndef NOH_CROWD_CROWD_INTERNAL_H
#define NOH_CROWD_CROWD_INTERNAL_H

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/crowd.h"
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifdef __cplusplus
}
#endif

#define CROWD_STEP_S (1.0f / 30.0f)
#define CROWD_STEPS_PER_S 30.0f
#define CROWD_NEIGHBORS 8u
#define CROWD_ITERATIONS 5u
#define CROWD_NO_NEIGHBOR 0xdfffu /* a run that there is not, without CROWD_CLOSE */
#define CROWD_RUN_MAX 0x1fffu     /* agents of three cells in a row that are looked at: 13 bits of a neighbour's name */
#define CROWD_CLOSE 0x2000u       /* of a neighbour's name: it may be touched in this step */
#define CROWD_FORCES 0x10000000u  /* of crowd_body.item: it steers by the rules of a flock */
#define CROWD_FLOCK 0x20000000u   /* with those that make it one */
#define CROWD_ORCA 0x40000000u    /* its plan is not corrected */
#define CROWD_HOLDS 0x80000000u   /* it stands, and is not pushed */
#define CROWD_FLAGS 0x70000000u   /* of the state, too: NOH_CROWD_* */
#define CROWD_WAITED 0xffu        /* of the state: steps */
#define CROWD_FOLLOWS_SHIFT 8u    /* of the state: 1 and the flow field, of 8 bits */
#define CROWD_YIELDS_SHIFT 16u    /* of the state: steps, of 8 bits */
#define CROWD_HAND_SHIFT 24u      /* of the state: crowd_round.mode, of 2 bits */
#define CROWD_ITEMS 0x0fffffffu   /* the rest */
#define CROWD_FAST 1.5f           /* times the speed that an agent likes: the most that it is pushed to */

typedef struct vec2 {
    float x, z;
} vec2;

/* What an agent wants. */
typedef struct crowd_wish {
    vec2 goal;
    float radius; /* 0: there is no agent */
    float speed;
} crowd_wish;

/* An agent as a step sees it. These are in the order of their cells; their index is called a rank. */
typedef struct crowd_body {
    vec2 at;
    float radius;
    uint32_t item; /* the agent's index, CROWD_HOLDS */
} crowd_body;

/* How it gets round what is in its way (crowd_round.c); of a crowd with obstacles. */
typedef struct crowd_round {
    vec2 heading;  /* along the wall */
    float nearest; /* to its goal, as it began to walk along it; before: as it ever was. 0: not known */
    uint8_t idle;  /* steps without coming nearer */
    uint8_t mode;  /* 0: walks freely; 1, 2: keeps the wall to its left, right */
    uint8_t has_gone_round;
    uint8_t yields; /* steps for which it makes way; the state has this and mode as they were before this step */
} crowd_round;

typedef struct crowd_cells {
    vec2 origin;
    float edge, per_edge;
    uint32_t width, depth;
} crowd_cells;

/* Behind it lie arrays, at these offsets: no pointers. */
struct noh_crowd {
    uint32_t agent_max, job_count, obstacle_count;
    uint32_t phase, to_do, present; /* of the step; steps to make, with this one; agents in the grid */
    float reach;
    noh_steps time;
    crowd_cells cells;
    uint32_t position, velocity, wish, id,
        state; /* by agent; state: steps that it waited, the field that it follows, and the flags above */
    uint32_t body, plan[2], neighbor;    /* by rank; neighbor: names [CROWD_NEIGHBORS] of each */
    uint32_t start;                      /* by cell: its first rank; one more at the end */
    uint32_t obstacle, near_start, near; /* obstacles; by cell: its first in near; indices of obstacles */
    uint32_t bytes;
    uint32_t corrected; /* agents of the step whose plans are corrected */
    uint32_t round;     /* by agent; of a crowd with obstacles */
    uint32_t flow;      /* a crowd_flow; 0: there are no flow fields */
    uint32_t ground;    /* a crowd_ground; 0: it is level */
    uint32_t unused;    /* so that what follows lies at a multiple of 8 everywhere */
    double home[2];     /* where all of it counts from: noh_crowd_home_of, as far as the origin was not moved */
};
NOH_STATIC_ASSERT(sizeof(noh_crowd) == 152 && sizeof(crowd_round) == 16, crowd);

/* Behind it: int8_t[cell][2], the rise along x and along z. */
typedef struct crowd_ground {
    crowd_cells cells;
    float slope_max;
} crowd_ground;
NOH_STATIC_ASSERT(sizeof(crowd_ground) == 28, crowd_ground);

#define CROWD_CODES 256u /* of directions: 0 none, then 255 in equal steps */

/* A flow field: where it leads, where it is to lead, and its codes, one a cell. */
typedef struct crowd_field {
    vec2 goal, asked;
    uint32_t codes; /* where they lie behind the crowd_flow */
    uint16_t is_built, is_asked;
} crowd_field;

/* All flow fields, and the one that is being built. Distances are the lengths of the shortest ways to the goal. */
typedef struct crowd_flow {
    crowd_cells cells;
    uint32_t field_count, visits;  /* visits: of a step */
    uint32_t building, phase;      /* NOH_NONE: no field is being built */
    uint32_t next;                 /* to be built, if it is asked for */
    uint32_t cursor, sweep, awake; /* of the phase; cells whose neighbours have changed */
    uint32_t source;               /* the cell nearest to the goal that an agent can stand in */
    float source_square;
    vec2 goal;                                  /* of the field that is being built */
    uint32_t field, distance, codes, direction; /* [field_count]; by cell, below 0: blocked; by cell; [CROWD_CODES] */
} crowd_flow;
NOH_STATIC_ASSERT(sizeof(crowd_field) == 24 && sizeof(crowd_flow) == 88, crowd_flow);
NOH_STATIC_ASSERT(sizeof(crowd_body) == 16 && sizeof(crowd_wish) == 16, crowd_records);

#define CROWD_ARRAY(type, crowd, name) ((type *)(void *)((char *)(crowd) + (crowd)->name))
#define CROWD_CONST(type, crowd, name) ((const type *)(const void *)((const char *)(crowd) + (crowd)->name))

static inline vec2 v2(float x, float z)
{
    vec2 v;
    v.x = x;
    v.z = z;
    return v;
}

static inline vec2 v2_sub(vec2 a, vec2 b)
{
    return v2(a.x - b.x, a.z - b.z);
}

static inline vec2 v2_madd(vec2 a, float s, vec2 b)
{
    return v2(a.x + s * b.x, a.z + s * b.z);
}

static inline vec2 v2_scale(vec2 a, float s)
{
    return v2(a.x * s, a.z * s);
}

static inline float v2_dot(vec2 a, vec2 b)
{
    return a.x * b.x + a.z * b.z;
}

static inline float v2_cross(vec2 a, vec2 b)
{
    return a.x * b.z - a.z * b.x;
}

static inline float v2_length(vec2 a)
{
    return noh_sqrt(v2_dot(a, a));
}

/* Near the middle of the grid, so that agents far from the origin are as exact as at it; 0 near the origin. */
static inline vec2 noh_crowd_home_of(const noh_crowd_desc *desc)
{
    return v2(noh_on_grid(desc->origin[0] + 0.5f * desc->extent[0]),
              noh_on_grid(desc->origin[1] + 0.5f * desc->extent[1]));
}

static inline noh_crowd_obstacle noh_crowd_obstacle_less(const noh_crowd_obstacle *o, vec2 home)
{
    const noh_crowd_obstacle out = { { o->from[0] - home.x, o->from[1] - home.z },
                                     { o->to[0] - home.x, o->to[1] - home.z },
                                     o->radius };
    return out;
}

/* Where noh_crowd_agent_at shows an agent, less the crowd's home, which floats of the world lose far away. returns 0 if
 * there is no such agent */
int noh_crowd_shown(const noh_crowd *crowd, uint32_t index, float at[2]);

/* A place of the world, as it is kept; and back. */
static inline vec2 noh_crowd_from(const noh_crowd *c, const float at[2])
{
    return v2((float)((double)at[0] - c->home[0]), (float)((double)at[1] - c->home[1]));
}

static inline void noh_crowd_to(const noh_crowd *c, vec2 at, float out[2])
{
    out[0] = (float)((double)at.x + c->home[0]);
    out[1] = (float)((double)at.z + c->home[1]);
}

/* ---- crowd_grid.c ---- */

/* As many cells as are useful: none smaller than the reach, at most one for two agents. */
crowd_cells noh_crowd_cells_of(const noh_crowd_desc *desc);
/* The cell of a place, and of its row and column; what is outside is in the cells of the edge. */
uint32_t noh_crowd_cell_at(const crowd_cells *cells, vec2 at, uint32_t *column, uint32_t *row);
/* Which obstacles are within reach of a cell. returns how many entries that makes; start and list: NULL, or filled */
uint32_t noh_crowd_near(const crowd_cells *cells, const noh_crowd_desc *desc, uint32_t *start, uint16_t *list);
void noh_crowd_sort(noh_crowd *c);

/* The up to three runs of ranks in the cells around a cell: the same for all of it, up to a rank. */
typedef struct crowd_runs {
    uint32_t first[3], end[3];
    uint32_t count, until;
} crowd_runs;
/* Find the runs of a rank: again only where a cell ends, so that ranks in order find them once per cell. until: 0
 * before the first call */
void noh_crowd_find_runs(const noh_crowd *c, uint32_t rank, crowd_runs *runs);
static inline void noh_crowd_runs_of(const noh_crowd *c, uint32_t rank, crowd_runs *runs)
{
    if (rank >= runs->until) noh_crowd_find_runs(c, rank, runs);
}

/* Neighbours are named by run and place in the run, in 2 and 13 bits. */
static inline uint32_t noh_crowd_rank_of(const crowd_runs *runs, uint32_t name)
{
    return runs->first[name >> 14] + (name & CROWD_RUN_MAX);
}

#define CROWD_ITEM(body) ((body)->item & CROWD_ITEMS)

/* ---- crowd_ground.c ---- */

uint32_t noh_crowd_ground_bytes(const crowd_cells *cells);
void noh_crowd_ground_init(noh_crowd *c, const noh_crowd_desc *desc);
/* Whether the ground is too steep to stand on. */
int noh_crowd_is_steep(const noh_crowd *c, vec2 at);
/* How fast an agent walks in a direction, of its speed on level ground; of a crowd with a ground. */
float noh_crowd_ease(const noh_crowd *c, vec2 at, vec2 direction);

/* ---- crowd_see.c ---- */

void noh_crowd_see(noh_crowd *c, uint32_t rank, const crowd_runs *runs);

/* ---- crowd_obstacle.c ---- */

/* The obstacles of the cell of a place. returns how many */
uint32_t noh_crowd_near_of(const noh_crowd *c, vec2 at, const uint16_t **near);
/* From the nearest point of its middle line. */
vec2 noh_crowd_away_from(const noh_crowd_obstacle *o, vec2 at);
/* Whether a point can go from one place to another within reach, past all that is near. */
int noh_crowd_sees(const noh_crowd *c, vec2 from, vec2 to);
/* The unit direction in which to walk towards what lies `distance` away in a unit direction. */
vec2 noh_crowd_detour(const noh_crowd *c, vec2 at, float radius, vec2 direction, float distance);
/* The nearest obstacle within reach, of those in the way in a unit direction (NULL: of all); NULL: none. inward: unit,
 * to its nearest point */
const noh_crowd_obstacle *noh_crowd_nearest(const noh_crowd *c, vec2 at, float radius, const vec2 *direction,
                                            float distance, vec2 *inward);
/* Whether the way in a unit direction is free, with a hair's breadth of tolerance. */
int noh_crowd_is_free(const noh_crowd *c, vec2 at, float radius, vec2 direction, float distance);
/* Where a step from `from` to `to` ends: outside of everything. */
vec2 noh_crowd_keep_out(const noh_crowd *c, vec2 from, vec2 to, float radius);

/* ---- crowd_round.c ---- */

/* The direction in which to walk to a goal, and how far that is as the crow flies, or on the way round something may be
 * walked so. returns 0 where it is there */
int noh_crowd_round(noh_crowd *c, const crowd_body *b, vec2 now, vec2 goal, float speed, vec2 *direction,
                    float *distance);
/* Make an agent turn around that has waited long at a wall, blocked by an agent that stays there or comes the other
 * way. Never both at once. */
void noh_crowd_turn_round(noh_crowd *c, uint32_t rank, const crowd_runs *runs, uint32_t waited);

/* ---- crowd_flow.c, crowd_follow.c ---- */

/* Rows and columns of flow fields. returns 0 where they are too many */
int noh_crowd_flow_cells(const noh_crowd_desc *desc, crowd_cells *cells);
uint32_t noh_crowd_flow_bytes(const crowd_cells *cells, uint32_t field_count);
/* Which cells are blocked, and no field. */
void noh_crowd_flow_init(noh_crowd *c, const noh_crowd_desc *desc);
/* returns  fields that are still to be built */
uint32_t noh_crowd_flow_build(noh_crowd *c, uint32_t visits);
/* The field that an agent follows; NULL: none */
const crowd_field *noh_crowd_followed(const noh_crowd *c, uint32_t state);
/* returns  0 where no way is known */
int noh_crowd_flow_way(const noh_crowd *c, const crowd_field *field, vec2 at, vec2 *direction);

/* ---- flock.c ---- */

/* Two in one place are parted by who they are: a unit direction that both find, with opposite signs. */
void noh_crowd_direction_of(uint32_t id, uint32_t other, float direction[2]);

/* ---- crowd_plan.c, crowd_avoid.c: the phases of a body's step ---- */

/* The velocity that is nearest to `wish`, no faster than `fast`, and meets no neighbour (crowd_orca.c). */
vec2 noh_crowd_orca(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, vec2 wish, float fast);
/* The velocity after a step by the rules of a flock (crowd_flock.c). */
vec2 noh_crowd_flock(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, vec2 wish, float speed);
void noh_crowd_plan(noh_crowd *c, uint32_t rank, const crowd_runs *runs);
void noh_crowd_iterate(noh_crowd *c, uint32_t begin, uint32_t end, uint32_t iteration); /* of ranks */
void noh_crowd_finish(noh_crowd *c, uint32_t rank);

#endif
