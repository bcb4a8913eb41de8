/* walkers_internal.h: state of walkers. Threads: as crowd.h. */
#ifndef NOH_ACTORS_WALKERS_INTERNAL_H
#define NOH_ACTORS_WALKERS_INTERNAL_H

#include "stage/crowd/crowd_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/crowd.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"

/* Get the direction that a walker faces: a unit vector x, z.
 * returns  0 if there is no such walker */
int noh_walkers_heading(const noh_walkers *walkers, uint32_t index, float heading[2]);

enum { WALKER_WALK, WALKER_IDLE, WALKER_RUN, WALKER_CLIPS };
#define WALKER_SWAY 32u /* equal parts of a pass of the clip */
#define WALKER_PARTS (NOH_FEET_POINTS / 2u)

typedef struct walker_clip {
    uint32_t clip; /* NOH_NONE: none */
    uint32_t ticks;
    float stride;                   /* model units of a pass */
    float sway[WALKER_SWAY + 1][2]; /* of the root about the straight way, x and z */
} walker_clip;

/* Heel, ball and toes of each foot, model space: noh_walkers_soles_at. */
typedef struct walker_feet {
    float at[NOH_FEET_LEGS_MAX][WALKER_PARTS][3];
} walker_feet;

typedef struct walker_soles {
    float at[WALKER_SWAY + 1][NOH_FEET_LEGS_MAX][WALKER_PARTS][3];
} walker_soles;

typedef struct walker {
    uint32_t actor; /* 0: none */
    uint32_t agent;
    float at[2];         /* of the agent in the last step, less the crowd's home */
    float body[2];       /* of the actor, less the crowd's home */
    float height, climb; /* of the actor, and its speed */
    float heading[2];    /* unit */
    float velocity[2];   /* smoothed, for the heading */
    float face[2];       /* zeros: as it arrived */
    float goes, runs;    /* 0..1: blend from standing to walking, from walking to running */
    float even;          /* speed ahead, smoothed less */
    uint32_t stands;     /* leg * WALKER_PARTS + part */
    uint8_t begun, is_near;
    uint8_t goes_back;    /* 1: walks backwards */
    uint8_t fallen;       /* 1: it falls, lies or gets up */
    uint8_t gait, swings; /* WALKER_STANDS..; leg of the next or current step on the spot */
    uint8_t free, unused; /* 0..255: how far the other foot is in the air */
    float pace;           /* when fallen: pace of its agent before */
    noh_fall fall;
} walker;
NOH_STATIC_ASSERT(sizeof(walker) == 96, walker);

/* walker.gait. All but WALKER_WALKS only where steps are known (noh_walkers.knows_steps). */
enum {
    WALKER_STANDS,
    WALKER_LIFTS,  /* a foot, with the walk at the moment when the legs pass */
    WALKER_LOWERS, /* that foot */
    WALKER_WALKS,
    WALKER_CLOSES /* walks on until the legs pass */
};

/* walker.begun: 0 teleports to its agent, 1 continues, otherwise starts again where it is. */
#define WALKER_STANDS_UP 2u

typedef struct walker_near {
    float square; /* squared distance */
    uint32_t index;
} walker_near;

/* Walkers and the list of the nearest follow. */
struct noh_walkers {
    uint32_t bytes, walker_max, near_max, near_count;
    uint32_t kind, layer, feet_modifier;
    float turn_speed;
    float forward[2];     /* of the walk: unit x, z, model space */
    uint16_t in_step;     /* 1: walk and run may be blended */
    uint16_t knows_steps; /* 1: the kind has two legs and an idle clip, and `passes` is valid */
    walker_clip clips[WALKER_CLIPS];
    uint32_t leg_count; /* 0: feet are not known */
    float leg;          /* its length, model units */
    walker_soles soles[WALKER_CLIPS];
    uint32_t passes[NOH_FEET_LEGS_MAX]; /* bit i: this leg passes the other between samples i and i + 1 of the walk */
};
NOH_STATIC_ASSERT(sizeof(noh_walkers) == 8016, walkers);

/* The rig of a noh_walkers_feet_modifier; NULL: the modifier is another one. */
const noh_feet_rig *noh_walkers_rig(const noh_modifier *part);

/* Measure the soles of all clips. Not during a step or a frame: uses a job's scratch memory. */
void noh_walkers_measure_soles(noh_walkers *w, noh_stage *stage, const noh_stage_kind *k, const noh_feet_rig *rig);

/* Soles in the blend of the clips, each at its phase. */
void noh_walkers_soles_at(const noh_walkers *w, const float shares[WALKER_CLIPS], const float weights[WALKER_CLIPS],
                          walker_feet *feet);

/* The phase of the walk when a leg passes the other between samples i and i + 1. */
float noh_walkers_pass_at(const noh_walkers *w, uint32_t leg, uint32_t i);

/* Tell the feet modifier of a near walker which foot stands. */
void noh_walkers_tell_leg(const noh_walkers *w, noh_stage *stage, const walker *r);

/* leg * WALKER_PARTS + part of the lowest sole. */
uint32_t noh_walkers_stand(const noh_walkers *w, const walker_feet *feet, uint32_t was);

/* How far the other foot is in the air: 0..1. */
float noh_walkers_free(const noh_walkers *w, const walker_feet *feet, uint32_t stands);

/* ---- gait ---- */

/* Speeds in model units per second. */
typedef struct walker_speed {
    float walk, run; /* of the clips */
    float now, even; /* speed ahead in this step, and smoothed */
    float angle;     /* to the wanted direction, at least 0 */
    int wants_to_go;
} walker_speed;

/* Choose the gait after `seconds`. It changes only while no foot on the ground would move.
 * share    phase of the walk
 * returns  the phase to which the walk jumps while it is invisible; below 0: it does not jump */
float noh_walkers_gait(const noh_walkers *w, walker *r, const walker_speed *g, float seconds, float share);

/* Passes until a leg next passes the other, in the direction of walking.
 * leg  which one; NULL: not wanted */
float noh_walkers_until_passing(const noh_walkers *w, const walker *r, float share, uint32_t *leg);

/* Passes per second in the current gait, where `rate` is wanted. */
float noh_walkers_pace(const noh_walkers *w, const walker *r, const walker_speed *g, float rate, float share,
                       float seconds);

static inline float noh_walker_towards(float x, float goal, float most)
{
    const float off = goal - x;
    return off > most ? x + most : off < -most ? x - most : goal;
}

static inline walker *noh_walker_at(noh_walkers *w, uint32_t index)
{
    return (walker *)(void *)((char *)w + sizeof *w) + index;
}

static inline walker_near *noh_walkers_nearest(noh_walkers *w)
{
    return (walker_near *)(void *)noh_walker_at(w, w->walker_max);
}

#endif
