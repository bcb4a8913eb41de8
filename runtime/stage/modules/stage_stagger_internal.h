/* stage_stagger_internal.h: the state of an actor that keeps its feet after a push, and of one that braces for the
 * ground. */
#ifndef NOH_STAGE_STAGE_STAGGER_INTERNAL_H
#define NOH_STAGE_STAGE_STAGGER_INTERNAL_H

#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Metres, along the world's axes, from the actor's place, which moves with the centre of mass. [2] are x and z. */
typedef struct noh_stage_foothold {
    float stance[3];          /* of the ankle when the push came */
    float rotation[4];        /* of the foot then, in model space */
    float off[2], from[2];    /* from `stance`: now, and where its step began */
    float height, height_was; /* of the ground under it, likewise */
} noh_stage_foothold;

typedef struct noh_stage_stagger {
    noh_stage_foothold feet[NOH_FEET_LEGS_MAX];
    float to[2], to_height;          /* where the step ends */
    float speed[2];                  /* of the centre of mass, m/s */
    float left[2];                   /* of its way that the floats of the place could not hold */
    float pelvis[2], strays[2];      /* the pelvis when the push came; how far the clips have it from there */
    float lean[2], lean_speed[2];    /* of the trunk, radians; per second times the square root of the scale */
    float arms;                      /* 0..1: how far they spread */
    float weight;                    /* 0..1: of all of it */
    uint32_t foot;                   /* 1 + the foot that steps; 0: none */
    uint32_t step_ticks, step_lasts; /* since the step began; of the whole step */
    uint32_t steps, last;            /* steps since the last push; the foot of the last one */
    uint32_t rest_ticks;             /* not simulated yet */
    uint32_t ends;                   /* 1: it stands, and `weight` goes to 0 */
} noh_stage_stagger;

typedef struct noh_stage_brace {
    float strength;  /* 1 until the trunk has landed, then to 0 */
    float toward[2]; /* unit: where it falls to */
    uint32_t ticks;  /* since it fell */
    float fastest;   /* downwards, of the trunk so far, m/s */
} noh_stage_brace;

#ifdef __cplusplus
}
#endif

#endif
