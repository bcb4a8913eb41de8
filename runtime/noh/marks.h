/* marks.h: decals on actors, and soft shadows under them. noh_gl.h draws both. */

#ifndef NOH_MARKS_H
#define NOH_MARKS_H

#include <stdint.h>

#include "base.h"
#include "body.h"
#include "noh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== blob shadows ========
 * Soft dark spots where bodies come near the ground, in place of a shadow map.
 *
 *   noh_blob_rig_make   boxes of a kind's largest parts
 *   noh_actor_blobs     the spots of an actor, as it was shown last
 *
 * noh_gl.h draws them. A part of radius r at a height h over the ground takes r^2 / (r^2 + (2 h)^2) of the
 * light that comes from all sides there, about as a disc would: two thirds of that are drawn. Nothing is kept from
 * frame to frame. Standing figures have a spot under each foot, those that lie under all of their bodies.
 *
 * Threads: the rig is read only; noh_actor_blobs as noh_actor_joint. */

/* A box, in the space of a joint or, without one, of the model. */
typedef struct noh_blob_body {
    uint32_t joint; /* NOH_NONE: rigid */
    float centre[3];
    float half[3][3]; /* from the centre to the middle of three sides */
} noh_blob_body;

typedef struct noh_blob_rig {
    noh_blob_body bodies[NOH_BLOBS_MAX];
    uint32_t body_count; /* 1.. */
} noh_blob_rig;

/* Of the kind's mesh pack: the largest boxes of skin that its joints move, at most one a joint; then meshes that no
 * joint moves.
 * kind     mesh, skeleton and nodes as a stage would be given them
 * errors   NOT_FOUND the kind draws nothing */
noh_result noh_blob_rig_make(const noh_kind_desc *kind, noh_blob_rig *rig, noh_error *error);

/* An ellipse on the ground, darkest in its middle. */
typedef struct noh_blob {
    float centre[3];
    float darkness;            /* 0..1, in the middle */
    float along[3], across[3]; /* half axes, to where nothing is left of it */
} noh_blob;

/* After a frame that showed the actor, or posed it.
 * ground   what is below it (low_life.h)
 * shapes   blobs[NOH_BLOBS_MAX]
 * returns  how many there are; 0: the actor is gone, was not posed, or is too high up */
uint32_t noh_actor_blobs(const noh_stage *stage, noh_actor actor, const noh_blob_rig *rig, const noh_ground *ground,
                         noh_blob *blobs);

/* ======== decals ========
 * Marks on actors: where something has hit them.
 *
 *   noh_decals_init     a ring of decals for one actor
 *   noh_decals_strike   a mark where noh_stage_pick hit
 *   noh_decals_step     time moves on: marks fade
 *   noh_decal_alpha     how much of one is left
 *
 * noh_gl.h draws them. A decal lies in the bind pose of the actor's mesh: a square about the point that
 * was hit, as seen along the normal of the triangle there. Whatever moves the mesh - joints, targets, another level -
 * moves the mark, because each pixel is looked up by where it is at rest; no vertex is copied, and nothing swims. It
 * stays on what faces as the triangle does, within a sphere about the square.
 *
 * When the ring is full, the oldest mark gives up its place. A mark close to another one of the same tile takes its
 * place. A ring is the caller's and has no pointers: copy it to save it.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 14, which copies the triangles around a hit and
 *          their weights, loses those that are larger than the mark, and scales its coordinates wrongly
 * Threads: no state but the ring. */

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

#ifdef __cplusplus
}
#endif

#endif
