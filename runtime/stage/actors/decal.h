/* decal.h: marks on actors: where something has hit them.
 *
 *   noh_decals_init     a ring of decals for one actor
 *   noh_decals_strike   a mark where noh_stage_pick hit
 *   noh_decals_step     time moves on: marks fade
 *   noh_decal_alpha     how much of one is left
 *
 * stage_decal.h draws them. A decal lies in the bind pose of the actor's mesh: a square about the point that
 * was hit, as seen along the normal of the triangle there. Whatever moves the mesh - joints, targets, another level -
 * moves the mark, because each pixel is looked up by where it is at rest; no vertex is copied, and nothing swims. It
 * stays on what faces as the triangle does, within a sphere about the square.
 *
 * When the ring is full, the oldest mark gives up its place. A mark close to another one of the same tile takes its
 * place. A ring is the caller's and has no pointers: copy it to save it.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 14, which copies the triangles around a hit and
 *          their weights, loses those that are larger than the mark, and scales its coordinates wrongly
 * Threads: no state but the ring. */
#ifndef NOH_ACTORS_DECAL_H
#define NOH_ACTORS_DECAL_H

#include "stage/cast/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 64 bytes. Lengths and directions are those of the mesh's bind pose. */
typedef struct noh_decal {
    uint32_t mesh; /* of the kind's mesh pack; NOH_NONE: nobody is here */
    float centre[3];
    float normal[3], right[3]; /* unit, at right angles; up is normal x right */
    float size;                /* half a side */
    float roughness;           /* 0..1 */
    uint8_t color[4];          /* sRGB and alpha */
    uint32_t tile;             /* of the picture */
    uint32_t age_ticks;        /* stays at the largest value */
    uint32_t reserved;         /* 0 */
} noh_decal;

typedef struct noh_decals {
    noh_decal decals[NOH_DECALS_MAX];
    uint32_t capacity; /* 1..NOH_DECALS_MAX: so many are used */
    uint32_t next;     /* whose place the next one takes */
    uint32_t hold_ticks, fade_ticks;
} noh_decals;

/* capacity    1..NOH_DECALS_MAX; 0: all
 * hold_ticks  before a mark begins to fade; 0: it stays
 * fade_ticks  from then until it is gone */
void noh_decals_init(noh_decals *decals, uint32_t capacity, uint32_t hold_ticks, uint32_t fade_ticks);

/* What is wrong with a ring that comes from outside, a constant text; NULL: it is good. */
const char *noh_decals_check(const noh_decals *decals);

typedef struct noh_decal_desc {
    float size;       /* half a side, in the mesh's unit; above 0, up to NOH_NUMBER_MAX */
    float roll_rad;   /* turned about the normal; 0: its up is as near to +Y as may be */
    float roughness;  /* 0..1; default (0) 0.5 */
    uint8_t color[4]; /* sRGB and alpha, by which the picture is multiplied. All 0: black */
    uint32_t tile;    /* of the picture */
} noh_decal_desc;

/* Strike the actor that a ray has hit, before the next frame. Takes no memory, however often.
 * hit      of noh_stage_pick in the last frame
 * index    in decals->decals; may be NULL
 * errors   NOT_FOUND the actor is gone or was not shown; ARG a number of the desc is out of its range */
noh_result noh_decals_strike(noh_decals *decals, const noh_stage *stage, const noh_stage_hit *hit,
                             const noh_decal_desc *desc, uint32_t *index, noh_error *error);

void noh_decals_step(noh_decals *decals, uint32_t ticks);

/* 0..1, by its age. */
float noh_decal_alpha(const noh_decals *decals, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
