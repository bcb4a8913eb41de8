/* wigs.h: hair of a whole kind in fixed memory. Hair moves on the actors that look largest; on all others it hangs at
 * rest and follows the head.
 *
 *   noh_wigs_size, noh_wigs_init   for a wig (wig.h), a number of actors, and a number whose hair moves at once
 *   noh_wigs_frame                 after each frame: find the visible actors, choose whose hair moves, step it
 *   noh_wigs_bodies                the visible actors, and where each head is
 *   noh_wigs_points                control hairs of one of them
 *
 * noh_wig_part, by contrast, gives every actor of a kind hair of its own: hundreds of them would take tens of kilobytes
 * each, and time for hair that nobody sees. Wigs are not part of the stage's state: they are not saved, forked or
 * hashed, and a restored stage begins with hair at rest. stage_hairs.h draws them.
 *
 * Hair begins to move at NOH_WIGS_MOVING_PIXELS pixels a metre and moves fully from twice that on, so that it swings
 * more or less as an actor approaches or recedes, without a jump. If more than near_max actors are that large, the
 * largest are chosen. A chosen actor is kept until another looks a quarter larger; its hair is then at rest at once.
 *
 * Threads: the stage's, outside of steps and frames; noh_wigs_size, any. */
#ifndef NOH_ACTORS_WIGS_H
#define NOH_ACTORS_WIGS_H

#include "stage/cast/stage.h"
#include "stage/actors/wig.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_WIGS_MOVING_PIXELS 60.0f

typedef struct noh_wigs_desc {
    const noh_wig *wig; /* must outlive all */
    uint32_t kind;      /* of the stage */
    uint32_t actor_max; /* actors of the kind that are visible at once, 1..NOH_STAGE_ACTORS_MAX; any more
                         * have no hair */
    uint32_t near_max;  /* actors whose hair moves at once, 0..NOH_WIGS_NEAR_MAX */
} noh_wigs_desc;

/* A visible actor. */
typedef struct noh_wigs_body {
    float world[12];        /* from head space (metres), less noh_stage_origin */
    float pixels_per_metre; /* of head space */
    float moves;            /* 0 (at rest) to 1 (in full motion) */
    uint32_t views;         /* a bit for each view that sees it */
    uint32_t slot;          /* among those whose hair moves; NOH_NONE: at rest */
} noh_wigs_body;

typedef struct noh_wigs noh_wigs;

/* The exact bytes: 80 for each actor, and noh_hair_size for each whose hair moves. 0 for an impossible desc. */
size_t noh_wigs_size(const noh_wigs_desc *desc);

/* errors  ARG memory, or a number of the desc is out of its range; MEMORY */
noh_result noh_wigs_init(void *memory, size_t bytes, const noh_wigs_desc *desc, noh_wigs **wigs, noh_error *error);

/* After noh_stage_frame_end, in every frame.
 * ticks  by which the stage was stepped since the last frame */
void noh_wigs_frame(noh_wigs *wigs, noh_stage *stage, uint32_t ticks);

/* bodies[*count], until the next frame. */
const noh_wigs_body *noh_wigs_bodies(const noh_wigs *wigs, uint32_t *count);

/* shapes  points[hair_count][point_count][3], head space; at rest where its hair does not move */
void noh_wigs_points(const noh_wigs *wigs, uint32_t body, float *points);

const noh_wigs_desc *noh_wigs_desc_of(const noh_wigs *wigs);

#ifdef __cplusplus
}
#endif

#endif
