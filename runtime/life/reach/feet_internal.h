/* feet_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_FEET_INTERNAL_H
#define NOH_SIM_FEET_INTERNAL_H

#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where a body's front is, in quarter turns from +z towards +x, 0..3: where the soles of its feet point in the bind
 * pose, or, if the rig has no legs because they have no skin, where the joints of their toes lie. Names of left and
 * right are not needed. 0 if there are no feet, or they point along the line of the hips. Everything that needs a
 * front calls this, except faces, which may have no legs (stage_face_open.c). */
uint32_t noh_feet_front(const noh_ragdoll_source *source, const noh_feet_rig *rig);

/* The same with the rig made for it. */
uint32_t noh_front_of(const noh_ragdoll_source *source);

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

/* The transform of a model. */
typedef struct noh_feet_place {
    float position[3], rotation[4]; /* its up must be the world's, +Y */
    float scale;                    /* world units per unit of the skeleton, above 0 */
    uint32_t
        stands; /* bits: leg i stands in the clip that a blend goes to: it is planted even while the blend moves it */
} noh_feet_place;

/* Advance time, and put a pose on the ground.
 * local    [joint_count], from a clip; changes the rig's top, thighs, shins and feet
 * seconds  since the last step, 0..; 0: repeat the same pose
 * cut      1: ignore the previous state, as for a new noh_feet */
void noh_feet_step(noh_feet *feet, const noh_feet_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                   const noh_feet_place *place, const noh_ground *ground, float seconds, int cut);

/* ---- the ground ---- */

#define NOH_GROUND_RAYS_MAX 18u /* of one sole: below its points and between them */

/* noh_ground_below for rays that go straight down; one question to the physics of the ground's world.
 * shapes  rays[count] with direction 0, -1, 0; hits[count]: distance below 0: no ground
 * ranges  count 0..NOH_GROUND_RAYS_MAX */
void noh_ground_below_all(const noh_ground *ground, const noh_ray *rays, uint32_t count, noh_world_hit *hits);

/* ---- feet ---- */

/* Move the origin of the world: all positions p become p - by. */
void noh_feet_shift(noh_feet *feet, const float by[3]);

/* Check a state that comes from outside.
 * returns  NULL if it may be used, else a constant message */
const char *noh_feet_check(const noh_feet *feet);

#ifdef __cplusplus
}
#endif

#endif
