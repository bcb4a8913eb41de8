/* feet.h: foot placement on the ground: stairs, slopes, rough terrain.
 *
 *   noh_ground_below        the ground below a point: from a world, or a function of the game
 *   noh_feet_rig_make       legs and soles of any skeleton, by joint names and skin
 *   noh_feet_init           an initial state
 *   noh_feet_step           move pelvis and legs of a pose so that the soles meet the ground
 *
 * Clips are made on a flat floor: the model's plane y = 0 at its place. A foot keeps its clip's height above that floor
 * as its height above the ground, and leans with the ground where that is flat enough to stand on. A foot is planted
 * while its clip holds it still on the floor: the lowest part of its sole (heel, ball or toes) is then locked in place
 * until the clip lifts it or moves it away. The pelvis follows the foot that is lowest or is about to be, with an
 * acceleration of at most 20 leg lengths per second squared, and immediately if a planted leg would be too short.
 *
 * Soles do not enter the ground where the legs reach. Heights are stored in world space, so a place that jumps from
 * step to step moves the body smoothly. Without ground within reach below a sole, that foot keeps its clip.
 * source   ozz-animation, sample_foot_ik (rays, the pelvis by the foot that needs most, the ankle by the normal)
 * Threads: no state but the noh_feet passed; any thread, if the ground's function allows it. */
#ifndef NOH_SIM_FEET_H
#define NOH_SIM_FEET_H

#include "core/base/limits.h"
#include "motion/pose/skeleton.h"
#include "life/physics/ragdoll_rig.h"
#include "life/physics/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_FEET_POINTS 6u /* per sole: heel, ball and toes, inner and outer side of each */

/* ---- the ground ---- */

typedef struct noh_ground {
    const noh_world *world; /* checked by noh_world_check; NULL: none */
    /* Instead of a world: returns the distance from a point straight down to the ground, at most `depth`, and its unit
     * normal; below 0: no ground. Must be a pure function */
    float (*below)(const void *user, const float from[3], float depth, float normal[3]);
    const void *user;
} noh_ground;

/* Find the ground straight below a point. Obstacles that contain the point are ignored.
 * shapes   normal[3] unit
 * returns  the distance, at most depth; below 0: no ground */
float noh_ground_below(const noh_ground *ground, const float from[3], float depth, float normal[3]);

/* ---- legs ---- */

typedef struct noh_feet_point {
    uint32_t joint; /* of the foot or below it */
    float at[3];    /* in the joint's space */
} noh_feet_point;

typedef struct noh_feet_leg {
    uint32_t thigh, shin, foot;
    float knee[3];                          /* unit, in the thigh's space: direction of the knee */
    noh_feet_point points[NOH_FEET_POINTS]; /* heel, heel, ball, ball, toes, toes */
} noh_feet_leg;

typedef struct noh_feet_rig {
    noh_feet_leg legs[NOH_FEET_LEGS_MAX];
    uint32_t leg_count; /* 1..NOH_FEET_LEGS_MAX */
    uint32_t top;       /* the joint that moves with the pelvis, with all its descendants */
    uint32_t last;      /* the highest index of all joints above: a pose without it is not changed */
    float length;       /* of the longest leg, in the skeleton's unit */
} noh_feet_rig;

/* Find thigh, shin and foot by the names that noh_ragdoll_find_rows knows; a sole is the lowest skin of a foot.
 * source   as for a ragdoll; metres and mass are unused
 * errors   NOT_FOUND no thighs, or no thigh with a shin and a skinned foot */
noh_result noh_feet_rig_make(const noh_ragdoll_source *source, noh_feet_rig *rig, noh_error *error);

/* ---- feet ---- */

/* The state of a foot. Heights and positions are in world space. */
typedef struct noh_foot {
    float height, speed; /* of the ground below it, smoothed */
    float normal[3];     /* of the ground that it leans with */
    float was[3][3];     /* heel, ball and toes, as in the clip */
    float moved[2];      /* x and z, from the clip's position */
    float held[2];       /* x and z where `part` is planted */
    float stands;        /* 0..1: how far it is planted */
    uint32_t part;       /* the lowest: 0 heel, 1 ball, 2 toes */
    uint32_t is_held;    /* 1: it is planted */
    uint32_t has_ground; /* 1: there was ground below it */
} noh_foot;

/* The state of all feet. A copy continues identically. */
typedef struct noh_feet {
    noh_foot feet[NOH_FEET_LEGS_MAX];
    float pelvis, speed; /* height of the pelvis above the floor of its clips, in world space */
    uint32_t begun;
    /* 1 + the leg that the caller's placement keeps still: no other leg is planted, and no foot is moved along the
     * ground; 0: none, every leg is planted while its clip holds it still */
    uint32_t kept;
} noh_feet;

void noh_feet_init(noh_feet *feet);

/* Move the origin of the world: all positions p become p - by. */
void noh_feet_shift(noh_feet *feet, const float by[3]);

/* Check a state that comes from outside.
 * returns  NULL if it may be used, else a constant message */
const char *noh_feet_check(const noh_feet *feet);

/* The transform of a model. */
typedef struct noh_feet_place {
    float position[3], rotation[4]; /* its up must be the world's, +Y */
    float scale;                    /* world units per unit of the skeleton, above 0 */
} noh_feet_place;

/* Advance time, and put a pose on the ground.
 * local    [joint_count], from a clip; changes the rig's top, thighs, shins and feet
 * seconds  since the last step, 0..; 0: repeat the same pose
 * cut      1: ignore the previous state, as for a new noh_feet */
void noh_feet_step(noh_feet *feet, const noh_feet_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                   const noh_feet_place *place, const noh_ground *ground, float seconds, int cut);

#ifdef __cplusplus
}
#endif

#endif
