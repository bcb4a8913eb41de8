/* walkers_internal.h: the walkers' block. Threads: as walkers.h. */
#ifndef NOH_STAGE_WALKERS_INTERNAL_H
#define NOH_STAGE_WALKERS_INTERNAL_H

#include "stage/stage_internal.h"
#include "stage/walkers.h"

enum { WALKER_WALK, WALKER_IDLE, WALKER_RUN, WALKER_CLIPS };
#define WALKER_SWAY 32u /* equal parts of a pass */

typedef struct walker_clip {
    uint32_t clip; /* NOH_NONE: none */
    uint32_t ticks;
    float stride;                   /* model units that a pass leads on */
    float sway[WALKER_SWAY + 1][2]; /* of the root about that, x and z */
} walker_clip;

typedef struct walker {
    uint32_t actor; /* 0: none */
    uint32_t agent;
    float at[2];         /* of the agent, in the last step */
    float height, climb; /* of the place, and its speed */
    float heading[2];    /* unit */
    float velocity[2];   /* smoothed, for the heading */
    float face[2];       /* 0: as it came */
    float goes, runs;    /* 0..1: how far it walks and does not stand, runs and does not walk */
    float even;          /* the speed ahead, smoothed less */
    uint16_t begun, is_near;
} walker;
NOH_STATIC_ASSERT(sizeof(walker) == 64, walker);

typedef struct walker_near {
    float square; /* of the distance */
    uint32_t index;
} walker_near;

/* Behind it lie walkers, and those that are near. */
struct noh_walkers {
    uint32_t bytes, walker_max, near_max, near_count;
    uint32_t kind, layer, feet_part;
    float turn_speed;
    float forward[2]; /* of the walk, in model space: unit x, z */
    uint32_t in_step; /* 1: markers tell that walk and run may be blended */
    uint32_t reserved;
    walker_clip clips[WALKER_CLIPS];
    uint32_t unused;
};
NOH_STATIC_ASSERT(sizeof(noh_walkers) == 880, walkers);

static inline walker *noh_walker_at(noh_walkers *w, uint32_t index)
{
    return (walker *)(void *)((char *)w + sizeof *w) + index;
}

static inline walker_near *noh_walkers_nearest(noh_walkers *w)
{
    return (walker_near *)(void *)noh_walker_at(w, w->walker_max);
}

#endif
