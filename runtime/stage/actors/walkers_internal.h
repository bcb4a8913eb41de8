/* walkers_internal.h: the walkers' block. Threads: as crowd.h. */
#ifndef NOH_ACTORS_WALKERS_INTERNAL_H
#define NOH_ACTORS_WALKERS_INTERNAL_H

#include "stage/crowd/crowd_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/crowd.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"

enum { WALKER_WALK, WALKER_IDLE, WALKER_RUN, WALKER_CLIPS };
#define WALKER_SWAY 32u /* equal parts of a pass */
#define WALKER_PARTS (NOH_FEET_POINTS / 2u)

typedef struct walker_clip {
    uint32_t clip; /* NOH_NONE: none */
    uint32_t ticks;
    float stride;                   /* model units that a pass leads on */
    float sway[WALKER_SWAY + 1][2]; /* of the root about that, x and z */
} walker_clip;

/* Of each foot heel, ball and toes, in model space: see noh_walkers_soles_at. */
typedef struct walker_feet {
    float at[NOH_FEET_LEGS_MAX][WALKER_PARTS][3];
} walker_feet;

typedef struct walker_soles {
    float at[WALKER_SWAY + 1][NOH_FEET_LEGS_MAX][WALKER_PARTS][3];
} walker_soles;

typedef struct walker {
    uint32_t actor; /* 0: none */
    uint32_t agent;
    float at[2];         /* of the agent, in the last step, from the crowd's home */
    float body[2];       /* where it is drawn, likewise: the actor's place less home */
    float height, climb; /* of the place, and its speed */
    float heading[2];    /* unit */
    float velocity[2];   /* smoothed, for the heading */
    float face[2];       /* 0: as it came */
    float goes, runs;    /* 0..1: how far it walks and does not stand, runs and does not walk */
    float even;          /* the speed ahead, smoothed less */
    uint32_t stands;     /* leg * WALKER_PARTS + part */
    uint8_t begun, is_near;
    uint8_t goes_back;    /* 1 */
    uint8_t fallen;       /* 1: it falls, lies or gets up */
    uint8_t gait, swings; /* WALKER_STANDS.., and the leg of its next or present step on the spot */
    uint8_t free, unused; /* 0..255: how far the foot that it does not stand on is in the air */
    float pace;           /* then: that of its agent before */
    noh_fall fall;
} walker;
NOH_STATIC_ASSERT(sizeof(walker) == 96, walker);

/* walker.gait. All but WALKER_WALKS only where steps are known (noh_walkers.knows_steps). */
enum {
    WALKER_STANDS,
    WALKER_LIFTS,  /* a foot, its walk at the moment at which the feet pass each other */
    WALKER_LOWERS, /* that foot */
    WALKER_WALKS,
    WALKER_CLOSES /* goes on to where the feet pass each other next */
};

/* walker.begun: 0 it leaps to its agent, 1 it goes on, or it begins anew where it is. */
#define WALKER_STANDS_UP 2u

typedef struct walker_near {
    float square; /* of the distance */
    uint32_t index;
} walker_near;

/* Behind it lie walkers, and those that are near. */
struct noh_walkers {
    uint32_t bytes, walker_max, near_max, near_count;
    uint32_t kind, layer, feet_part;
    float turn_speed;
    float forward[2];     /* of the walk, in model space: unit x, z */
    uint16_t in_step;     /* 1: markers tell that walk and run may be blended */
    uint16_t knows_steps; /* 1: the kind has two legs and stands, and `passes` are known */
    walker_clip clips[WALKER_CLIPS];
    uint32_t leg_count; /* 0: nothing is known of feet */
    float leg;          /* its length, model units */
    walker_soles soles[WALKER_CLIPS];
    uint32_t
        passes[NOH_FEET_LEGS_MAX]; /* bit i: between samples i and i + 1 of the walk this leg swings past the other */
};
NOH_STATIC_ASSERT(sizeof(noh_walkers) == 8016, walkers);

/* The rig of a part of noh_walkers_feet_part; NULL: the part is another one. */
const noh_feet_rig *noh_walkers_rig(const noh_stage_part *part);

/* Soles of all clips, into w. Not within a step or a frame: a job's scratch is used. */
void noh_walkers_measure_soles(noh_walkers *w, noh_stage *stage, const noh_stage_kind *k, const noh_feet_rig *rig);

/* Soles in the blend of the clips, each at its share of a pass. */
void noh_walkers_soles_at(const noh_walkers *w, const float shares[WALKER_CLIPS], const float weights[WALKER_CLIPS],
                          walker_feet *feet);

/* The share of the walk at which a leg swings past the other between samples i and i + 1. */
float noh_walkers_pass_at(const noh_walkers *w, uint32_t leg, uint32_t i);

/* Feet of one who is near know which of them is kept still. */
void noh_walkers_tell_leg(const noh_walkers *w, noh_stage *stage, const walker *r);

/* leg * WALKER_PARTS + part of the lowest sole. */
uint32_t noh_walkers_stand(const noh_walkers *w, const walker_feet *feet, uint32_t was);

/* How far a foot is in the air that it does not stand on: 0..1. */
float noh_walkers_free(const noh_walkers *w, const walker_feet *feet, uint32_t stands);

/* ---- gait ---- */

/* Speeds in model units a second. */
typedef struct walker_speed {
    float walk, run; /* of the clips */
    float now, even; /* ahead in this step, and smoothed */
    float angle;     /* between where it faces and where it wants to: 0.. */
    int wants_to_go;
} walker_speed;

/* Whether it stands, steps on the spot or walks, after `seconds`. It changes only where no foot on the ground moves.
 * share: of its pass, at which the walk is. returns the share to which the walk leaps, since it does not show; below 0:
 * it does not */
float noh_walkers_gait(const noh_walkers *w, walker *r, const walker_speed *g, float seconds, float share);

/* Passes that are left, forwards or backwards as it goes, until a leg swings past the other.
 * leg: which one; NULL: not told */
float noh_walkers_until_passing(const noh_walkers *w, const walker *r, float share, uint32_t *leg);

/* Passes in a second that it makes in its gait, where it wants to make `rate`. */
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
