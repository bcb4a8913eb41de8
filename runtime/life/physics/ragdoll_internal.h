/* ragdoll_internal.h (private to physics/): the layout of a set of ragdolls, and the step of a group of lanes. Threads:
 * as low_life.h. */
#ifndef NOH_SIM_RAGDOLL_INTERNAL_H
#define NOH_SIM_RAGDOLL_INTERNAL_H

#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_ragdoll_measures {
    float limit;           /* radians beyond the limits, worst joint */
    float penetration;     /* metres of the deepest body inside the world; of dolls of size 1 */
    float separation;      /* metres between the anchors of the worst joint; for sliding joints beyond their limits */
    float separation_mean; /* mean over all joints */
    float energy;          /* joules: kinetic, and potential above height 0 */
} noh_ragdoll_measures;

void noh_ragdoll_measure(const noh_ragdolls *set, uint32_t doll, const noh_world *world,
                         noh_ragdoll_measures *measures);

/* Get the velocities of a doll's bodies.
 * shapes  motions[body_count] */
void noh_ragdoll_motions(const noh_ragdolls *set, uint32_t doll, noh_ragdoll_motion *motions);

/* Move the origin: every point p of dolls, goals and internal state becomes p + by. For worlds that are kept near their
 * origin; the caller moves the noh_world. Wakes nothing.
 * units   metres, finite */
void noh_ragdolls_shift(noh_ragdolls *set, const float by[3]);

/* Compute the velocities of bodies between two poses; spins take the shorter arc.
 * shapes  before, now, motions: [count]
 * ranges  seconds above 0: the time between the two */
void noh_ragdoll_motions_of(const noh_ragdoll_pose *before, const noh_ragdoll_pose *now, uint32_t count, float seconds,
                            noh_ragdoll_motion *motions);

/* Compare how the first bodies of two dolls lie (on the front, back or side, or upright), whatever their place and
 * heading. Returns the cosine of the angle between their up directions: 1 equal, -1 opposite. */
float noh_ragdoll_similarity(const noh_ragdoll_pose *a, const noh_ragdoll_pose *b);

/* Place and turn a character so that its pose lies where a doll does: the first bodies above each other, the others on
 * the same side. Turns about +Y only, and keeps the frame's height.
 * shapes  pose[count] the character's bodies, from noh_ragdoll_from_pose with *frame; doll[count]; frame: read and
 *         changed */
void noh_ragdoll_place_under(const noh_ragdoll_pose *pose, const noh_ragdoll_pose *doll, uint32_t count,
                             noh_ragdoll_frame *frame);

/* ---- rigs ---- */

/* Make masses more equal, so that heavy bodies do not pull light joints apart: child over parent within 0.8..1.2, with
 * the same total; a parent's inertia is raised to at most twice its own if its children have more.
 * source  Strunk: Stop my constraints from blowing up, as implemented in Jolt */
void noh_ragdoll_stabilize(noh_ragdoll_rig *rig);

/* Check a rig.
 * errors  ARG a number out of its range (where: the body); LIMIT too many bodies or pairs */
noh_result noh_ragdoll_rig_check(const noh_ragdoll_rig *rig, noh_error *error);

#ifdef __cplusplus
}
#endif

#define NOH_RAGDOLL_SIZE_MIN 0.01f
#define NOH_RAGDOLL_SIZE_MAX 100.0f
#define NOH_RAGDOLL_TIME_MAX 10u /* the square root of NOH_RAGDOLL_SIZE_MAX: times of the largest to times of size 1 */
#define NOH_RAGDOLL_LANES_MAX 8u
#define NOH_RAGDOLL_LANE_FLOATS 52u                       /* per body in the shared memory, for each lane */
#define NOH_RAGDOLL_PLACE_FLOATS (8u + NOH_OBSTACLES_MAX) /* per doll: its origin, and planes relative to it */
#define NOH_RAGDOLL_TOUCH_FLOATS (5u * NOH_TOUCHES_MAX)   /* per body: what a world that is asked has answered */
#define NOH_RAGDOLL_SCRATCH_FLOATS(asks)                                                              \
    ((NOH_RAGDOLL_BODIES_MAX * (NOH_RAGDOLL_LANE_FLOATS + ((asks) ? NOH_RAGDOLL_TOUCH_FLOATS : 0u)) + \
      NOH_RAGDOLL_PLACE_FLOATS) *                                                                     \
     NOH_RAGDOLL_LANES_MAX)

/* A body of a doll. Lanes have these floats in the same order. */
typedef struct noh_ragdoll_state {
    float position[3], rotation[4], velocity[3], spin[3];
    float goal_position[3], goal_rotation[4];
} noh_ragdoll_state;
#define NOH_RAGDOLL_MOVES 13u /* floats that a step changes */
#define NOH_RAGDOLL_STATE_FLOATS 20u

typedef struct noh_ragdoll_doll {
    noh_ragdoll_state bodies[NOH_RAGDOLL_BODIES_MAX];
    float lain[NOH_RAGDOLL_BODIES_MAX][7]; /* transforms of bodies when the doll last moved */
    float hertz[NOH_RAGDOLL_BODIES_MAX];
    uint32_t held;
    uint32_t asleep;
    uint16_t still; /* steps since `lain` was stored; 0: it has just been woken */
    uint16_t size_low;
    uint16_t slow; /* steps since any body was fast */
    uint16_t size_high;
    float origin[3]; /* of all its positions, near its first body: keeps the precision of floats everywhere */
    uint32_t bent;   /* steps for which joints placed beyond their limits are brought back slowly */
} noh_ragdoll_doll;

/* Get the size of a doll, as a multiple of its rig's. Bytes that are all 0 stand for size 1. Its positions, origin and
 * velocities count in multiples of it, not in metres: for a large doll the world is small, gravity weak. Functions take
 * and give metres. */
float noh_ragdoll_size(const noh_ragdoll_doll *doll);

/* Whether dolls may have a size. */
static inline int noh_ragdoll_is_size(float size)
{
    return size >= NOH_RAGDOLL_SIZE_MIN && size <= NOH_RAGDOLL_SIZE_MAX;
}

/* Shared data of a body and of the joint to its parent, in the bodies' own spaces. */
typedef struct noh_ragdoll_constants {
    float half, radius, mass, inertia_across, inertia_along;
    uint32_t parent, flags;
    float anchor_parent[3], anchor[3];
    float
        rest_parent[4]; /* the frame in the parent's space at rest; the next two: at the centre of the swing ellipse */
    float frame_parent[4], frame[4];
    float swing[2];                   /* one over the squared sine of half of the ellipse's half axes */
    float twist_min[2], twist_max[2]; /* sine and cosine of half of it */
    float linear_min[3], linear_max[3];
    float friction;
} noh_ragdoll_constants;

typedef struct noh_ragdoll_pair {
    uint32_t a, b;
    float distance; /* least distance of their axes: the sum of their radii, or less if they are closer at rest */
} noh_ragdoll_pair;

typedef struct noh_ragdoll_shape {
    uint32_t body_count, pair_count, substeps;
    float speed_max; /* metres per second */
    float slack;     /* metres by which a doll may overlap the world at the end of a step */
    noh_ragdoll_constants bodies[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_pair pairs[NOH_RAGDOLL_PAIRS_MAX];
} noh_ragdoll_shape;

struct noh_ragdolls {
    uint32_t count;
    float size; /* of the rig at rest, metres */
    noh_steps steps;
    noh_ragdoll_shape shape;
};

/* The step, for as many dolls as the processor has lanes. ragdoll_lanes.c can be compiled again under another name, for
 * other instructions. */
#if !defined(NOH_RAGDOLL_STEP)
#define NOH_RAGDOLL_STEP noh_ragdoll_step_dolls
#endif

/* 1/60 s.
 * world   its own shapes are in the dolls' unit
 * size    of the dolls
 * shapes  dolls[count], all awake; scratch[NOH_RAGDOLL_SCRATCH_FLOATS], aligned to 32 bytes; the larger one if the
 *         world asks */
void NOH_RAGDOLL_STEP(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                      uint32_t count, float *scratch, float size);

/* Ask what the bodies of a doll touch during the next 1/60 s.
 * shapes  touches[body_count], in the doll's unit */
void noh_ragdoll_ask(const noh_ragdoll_shape *shape, const noh_world *world, const noh_ragdoll_doll *doll,
                     noh_touches *touches);

/* A set without the memory that its dolls share, which a stage stores apart from its state. It can be used like any
 * other, but stepped only by noh_ragdolls_step_once.
 * memory   noh_ragdolls_state_size bytes, aligned to 16; rig checked, count and substeps in range */
size_t noh_ragdolls_state_size(uint32_t count);
noh_ragdolls *noh_ragdolls_begin(void *memory, const noh_ragdolls_desc *desc);
/* Give a doll the bytes that noh_ragdolls_begin gives it: asleep, at rest. rig: of the set */
void noh_ragdoll_rest(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_rig *rig);
int noh_ragdoll_rests(const noh_ragdolls *set, uint32_t doll, const noh_ragdoll_rig *rig); /* 1: it has these bytes */

/* How many steps of 1/60 s `ticks` more make; noh_ragdolls_step_once makes one.
 * scratch  [NOH_RAGDOLL_SCRATCH_FLOATS(asks)], aligned to 32 bytes; undefined before and after
 * asks     0: the physics of the world is not asked */
uint32_t noh_ragdolls_take(noh_ragdolls *set, uint32_t ticks);
void noh_ragdolls_step_once(noh_ragdolls *set, const noh_world *world, float *scratch, uint32_t asks);

/* Variants of the public functions with positions relative to `origin`, a point of the bodies' space.
 * size    the doll's from now on, NOH_RAGDOLL_SIZE_MIN.._MAX: lengths of its rig times it, masses times its cube */
noh_result noh_ragdoll_place_about(noh_ragdolls *set, uint32_t doll, const float origin[3], float size,
                                   const noh_ragdoll_pose *bodies, const noh_ragdoll_motion *motions, noh_error *error);
noh_result noh_ragdoll_follow_about(noh_ragdolls *set, uint32_t doll, const float origin[3],
                                    const noh_ragdoll_pose *goals, uint32_t held, const float *hertz, noh_error *error);

/* Get the bodies relative to *origin: as stored if their size is 1.
 * shapes  bodies[body_count] */
void noh_ragdoll_bodies_local(const noh_ragdolls *set, uint32_t doll, float origin[3], noh_ragdoll_pose *bodies);

/* Get the origin to use for a position `at`, in whole metres as far as floats hold them. */
void noh_ragdoll_origin_near(const float at[3], float origin[3]);

/* Move an origin. lost: the part that its floats cannot hold, to be added to all positions relative to it. */
void noh_ragdoll_origin_shift(float origin[3], const float by[3], float lost[3]);

/* Check a copy of the set from outside; returns NULL or a message. */
const char *noh_ragdolls_check(const noh_ragdolls *set, const noh_ragdolls *copy);

/* Get the dolls of a set, and the memory that they share. */
noh_ragdoll_doll *noh_ragdoll_dolls(noh_ragdolls *set);
float *noh_ragdoll_scratch(noh_ragdolls *set);

#endif
