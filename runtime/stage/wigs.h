/* wigs.h: hair of a whole kind in fixed memory: of the actors that look the largest it moves, of all others it hangs as
 * at rest and goes with the head.
 *
 *   noh_wigs_size, noh_wigs_init   for a wig (wig.h), so many actors, and so many whose hair moves at once
 *   noh_wigs_frame                 after each frame: who is seen, whose hair moves, its steps
 *   noh_wigs_bodies                who is seen, and where each head is
 *   noh_wigs_points                control hairs of one of them
 *
 * In place of noh_wig_part, which gives hair of its own to every actor of a kind: hundreds of them would take tens of
 * kilobytes each, and time for hair that nobody sees. Nothing of it is state of the stage: it is not saved, forked or
 * hashed, and a restored stage begins with hair at rest. stage_gl/stage_hairs.h draws it.
 *
 * Hair moves from NOH_WIGS_MOVING_PIXELS pixels a metre on, fully from twice that, so that who comes nearer or goes
 * away swings more or less, and never leaps. Where more actors than near_max are that large, the largest have it; one
 * that has it keeps it until another looks a quarter larger, and then hangs at rest at once.
 *
 * Threads: the stage's, outside of steps and frames; noh_wigs_size, any. */
#ifndef NOH_STAGE_WIGS_H
#define NOH_STAGE_WIGS_H

#include "stage/stage.h"
#include "stage/wig.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_WIGS_MOVING_PIXELS 60.0f

typedef struct noh_wigs_desc {
    const noh_wig *wig; /* must outlive all */
    uint32_t kind;      /* of the stage */
    uint32_t actor_max; /* actors of the kind that are seen at once, 1..NOH_STAGE_ACTORS_MAX; more are bald */
    uint32_t near_max;  /* whose hair moves, 0..NOH_WIGS_NEAR_MAX */
} noh_wigs_desc;

/* One that is seen. */
typedef struct noh_wigs_body {
    float world[12];        /* from head space (metres) */
    float pixels_per_metre; /* of head space */
    float moves;            /* 0 at rest, to 1: as its hair moves */
    uint32_t views;         /* a bit for each that sees it */
    uint32_t slot;          /* of those whose hair moves; NOH_NONE: at rest */
} noh_wigs_body;

typedef struct noh_wigs noh_wigs;

/* The exact bytes: 80 an actor, those of noh_hair_size for each whose hair moves. 0 for an impossible desc. */
size_t noh_wigs_size(const noh_wigs_desc *desc);

/* errors  ARG memory, or a number of the desc is out of its range; MEMORY */
noh_result noh_wigs_init(void *memory, size_t bytes, const noh_wigs_desc *desc, noh_wigs **wigs, noh_error *error);

/* After noh_stage_frame_end, in every frame.
 * ticks  that the stage was stepped by since the frame before */
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
