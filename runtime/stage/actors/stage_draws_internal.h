/* stage_draws_internal.h (private to stage_draws.c and what draws): what a pass of a view draws, in which order. */
#ifndef NOH_ACTORS_STAGE_DRAWS_INTERNAL_H
#define NOH_ACTORS_STAGE_DRAWS_INTERNAL_H

#include "stage/cast/stage_internal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A mesh of neighbours in a kind's order, which are drawn alike. */
typedef struct noh_stage_drawing {
    const noh_stage_kind *k;
    uint32_t mesh, first, count; /* places in k->order */
    uint32_t level;              /* of the actors, not of the mesh */
    uint32_t influence_count;    /* 0: all */
    float from, to;              /* share of the pixels, as in noh_draw */
    int priority;                /* of the blended materials to draw; NOH_STAGE_OPAQUE: all others */
    int alone;                   /* 1: one actor, mirrored or fading */
} noh_stage_drawing;

#define NOH_STAGE_OPAQUE 1000 /* above all priorities */

typedef struct noh_stage_pass {
    const noh_stage *s;
    uint32_t view;
    int blended, fades; /* fades: 0: actors that fade show their new level alone */
    void (*draw)(void *user, const noh_stage_drawing *drawing);
    void *user;
} noh_stage_pass;

void noh_stage_draw_pass(const noh_stage_pass *pass);

/* A level of an actor, and its share of the pixels (noh_draw). */
typedef struct noh_stage_part {
    uint32_t level;
    float from, to;
} noh_stage_part;

/* The levels that a mesh of an actor shows: 1, or 2 while it fades. */
uint32_t noh_stage_parts_of(const noh_stage_kind *k, const noh_stage_shown *shown, uint32_t mesh, int fades,
                            noh_stage_part parts[2]);

static inline uint32_t noh_stage_mesh_level(const noh_stage_kind *k, uint32_t mesh, uint32_t level)
{
    return k->plan->levels[level].mesh_levels[mesh];
}

/* One actor's mesh at one of its levels, by itself and opaque. */
noh_stage_drawing noh_stage_drawing_alone(const noh_stage_kind *k, uint32_t mesh, uint32_t place, noh_stage_part part);

/* Whether an actor's mesh is mirrored, by its node or by the joint that the actor is attached to. One draw has one
 * winding, so it is drawn alone. Places of their own never mirror. */
int noh_stage_is_mirrored(const noh_stage_mesh *mesh, const noh_stage_actor *actor, const noh_stage_shown *shown);

#ifdef __cplusplus
}
#endif

#endif
