/* feet.h: feet that stand on the ground: stairs, slopes, rough terrain.
 *
 *   noh_ground_below        what is below a point: a world, or a function of the game
 *   noh_feet_rig_make       legs and soles of any skeleton, by its joints' names and its skin
 *   noh_feet_init           stands nowhere yet
 *   noh_feet_step           the pelvis and the legs of a pose are moved so that the soles meet the ground
 *
 * Clips are made on a flat floor: the plane y = 0 of the model, where its place is. A foot keeps the height above the
 * ground that its clip gives it above that floor, and leans with the ground as far as it is flat enough to stand on. It
 * stands where its clip holds it still on the floor: the lowest part of its sole (heel, ball or toes) is then held at
 * its place, until the clip lifts it or takes it away. The pelvis goes with the foot that is lowest
 * or is about to be, with an acceleration of at most 20 legs a square second, and at once where a leg that stands would
 * be too short.
 *
 * Soles do not enter the ground where the legs reach. Heights are remembered in the world, so that a place that leaps
 * from step to step moves the body smoothly. Nothing below a sole within reach: that foot is left to its clip.
 * source   ozz-animation, sample_foot_ik (rays, the pelvis by the foot that needs most, the ankle by the normal)
 * Threads: no state but the noh_feet that is passed; any thread, as far as the ground's function allows it. */
#ifndef NOH_SIM_FEET_H
#define NOH_SIM_FEET_H

#include "core/base/limits.h"
#include "motion/pose/skeleton.h"
#include "life/physics/ragdoll_rig.h"
#include "life/physics/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_FEET_POINTS 6u /* of a sole: heel, ball and toes, the inner and the outer side of each */

/* ---- the ground ---- */

typedef struct noh_ground {
    const noh_world *world; /* NULL: none; checked by noh_world_check */
    /* In place of a world: the distance from a point straight down to the ground, at most `depth`, and its unit normal;
     * below 0: nothing is there. It must return the same for the same question */
    float (*below)(const void *user, const float from[3], float depth, float normal[3]);
    const void *user;
} noh_ground;

/* What is straight below. Obstacles that hold the point itself are not seen: nothing stands on a ceiling.
 * shapes   normal[3] unit
 * returns  the distance, at most depth; below 0: nothing is there */
float noh_ground_below(const noh_ground *ground, const float from[3], float depth, float normal[3]);

/* ---- legs ---- */

typedef struct noh_feet_point {
    uint32_t joint; /* of the foot or below it */
    float at[3];    /* in the joint's space */
} noh_feet_point;

typedef struct noh_feet_leg {
    uint32_t thigh, shin, foot;
    float knee[3];                          /* unit, in the thigh's space: where the knee points */
    noh_feet_point points[NOH_FEET_POINTS]; /* heel, heel, ball, ball, toes, toes */
} noh_feet_leg;

typedef struct noh_feet_rig {
    noh_feet_leg legs[NOH_FEET_LEGS_MAX];
    uint32_t leg_count; /* 1..NOH_FEET_LEGS_MAX */
    uint32_t top;       /* the joint that moves with the pelvis, and all that hangs on it */
    uint32_t last;      /* the highest index of all joints above: a pose without it is left alone */
    float length;       /* of the longest leg, in the skeleton's unit */
} noh_feet_rig;

/* Thigh, shin and foot by the names that noh_ragdoll_find_rows knows; a sole is the lowest skin of a foot.
 * source   as for a ragdoll; metres and mass are not read
 * errors   NOT_FOUND no thighs, or no thigh with a shin and a foot on which there is skin */
noh_result noh_feet_rig_make(const noh_ragdoll_source *source, noh_feet_rig *rig, noh_error *error);

/* ---- feet ---- */

/* 88 bytes. Heights and places are the world's. */
typedef struct noh_foot {
    float height, speed; /* of the ground that it follows */
    float normal[3];     /* that it leans with */
    float was[3][3];     /* heel, ball and toes, where the clip had them */
    float moved[2];      /* x and z, from where the clip has it */
    float held[2];       /* x and z at which `part` stands */
    float stands;        /* 0..1 */
    uint32_t part;       /* the lowest: 0 heel, 1 ball, 2 toes */
    uint32_t is_held;    /* 1: it stands */
    uint32_t has_ground; /* 1: there was some below it */
} noh_foot;

/* A copy of it goes on as it does. */
typedef struct noh_feet {
    noh_foot feet[NOH_FEET_LEGS_MAX];
    float pelvis, speed; /* its height above the floor of its clips, in the world */
    uint32_t begun;
    uint32_t kept; /* 1 + the leg that the place keeps still, where it does: no other stands, and no foot is moved
                    * along the ground; 0: any leg stands whose clip holds it still */
} noh_feet;

void noh_feet_init(noh_feet *feet);

/* The origin of the world moves by `by`: so much less is where feet and pelvis are. */
void noh_feet_shift(noh_feet *feet, const float by[3]);

/* What is wrong with a state that comes from outside, a constant text; NULL: it is good. */
const char *noh_feet_check(const noh_feet *feet);

/* Where a model stands. */
typedef struct noh_feet_place {
    float position[3], rotation[4]; /* its up is to be the world's, +Y */
    float scale;                    /* world units of one of the skeleton's, above 0 */
} noh_feet_place;

/* Time moves on, and a pose is put on the ground.
 * local    [joint_count], of a clip; changed are the rig's top, thighs, shins and feet
 * seconds  since the step before, 0..; 0: the same pose once more
 * cut      1: nothing to go on from, as for a new noh_feet */
void noh_feet_step(noh_feet *feet, const noh_feet_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                   const noh_feet_place *place, const noh_ground *ground, float seconds, int cut);

#ifdef __cplusplus
}
#endif

#endif
