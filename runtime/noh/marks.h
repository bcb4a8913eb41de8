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
 * Blob shadows: soft dark ellipses where bodies come near the ground, in place of a shadow map.
 *
 *   noh_blob_rig_make   boxes of the largest parts of a kind
 *   noh_actor_blobs     the blobs of an actor in the last frame
 *
 * noh_gl.h draws them. A part of radius r at height h above the ground blocks r^2 / (r^2 + (2 h)^2) of the ambient
 * light there, about as a disc does; two thirds of that are drawn. Nothing is kept from frame to frame. A standing
 * figure has a blob under each foot, a lying one under its whole body.
 *
 * Threads: the rig is read only; noh_actor_blobs as noh_actor_joint. */

/* A box in the space of a joint, or of the model if it has none. */
typedef struct noh_blob_body {
    uint32_t joint; /* NOH_NONE: rigid */
    float centre[3];
    float half[3][3]; /* from the centre to the centres of three sides */
} noh_blob_body;

typedef struct noh_blob_rig {
    noh_blob_body bodies[NOH_BLOBS_MAX];
    uint32_t body_count; /* at least 1 */
} noh_blob_rig;

/* Find the largest boxes of skin that joints move, at most one for each joint, then meshes that no joint moves.
 * kind     mesh, skeleton and nodes as for a stage
 * errors   NOT_FOUND the kind has nothing to draw */
noh_result noh_blob_rig_make(const noh_kind_desc *kind, noh_blob_rig *rig, noh_error *error);

/* An ellipse on the ground, darkest at its centre. */
typedef struct noh_blob {
    float centre[3];
    float darkness;            /* 0..1, at the centre */
    float along[3], across[3]; /* half axes; the blob fades to nothing at their ends */
} noh_blob;

/* Call it after a frame that showed or posed the actor.
 * ground   below the actor (low_life.h)
 * shapes   blobs[NOH_BLOBS_MAX]
 * returns  the number of blobs; 0: the actor is gone, was not posed, or is too high up */
uint32_t noh_actor_blobs(const noh_stage *stage, noh_actor actor, const noh_blob_rig *rig, const noh_ground *ground,
                         noh_blob *blobs);

/* ======== decals ========
 * Decals on actors: marks where something has hit them.
 *
 *   noh_decals_init     a ring of decals for one actor
 *   noh_decals_strike   add a decal where noh_stage_pick hit
 *   noh_decals_step     let time pass: decals fade
 *
 * noh_gl.h draws them. A decal lies in the bind pose of the actor's mesh: a square around the point that was
 * hit, in the plane of the triangle there. It covers surfaces that face as that triangle does, within a sphere around
 * the square. Pixels look decals up by their place in the bind pose, so joints, targets and LOD levels carry a decal
 * without a copy of vertices.
 *
 * When the ring is full, a new decal replaces the oldest one. A new decal close to another one of the same tile
 * replaces that one. A ring is your memory and has no pointers: copy it to save it.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 14, which copies the triangles around a hit and
 *          their weights, loses triangles larger than the decal, and scales texture coordinates wrongly
 * Threads: no state but the ring. */

/* 64 bytes. Lengths and directions in the bind pose of the mesh. */
typedef struct noh_decal {
    uint32_t mesh; /* of the kind's mesh pack; NOH_NONE: this entry is free */
    float centre[3];
    float normal[3], right[3]; /* unit vectors at right angles; up is normal x right */
    float size;                /* half a side of the square */
    float roughness;           /* 0..1 */
    uint8_t color[4];          /* sRGB and alpha */
    uint32_t tile;             /* of the picture */
    uint32_t age_ticks;        /* saturates */
    uint32_t reserved;         /* 0 */
} noh_decal;

typedef struct noh_decals {
    noh_decal decals[NOH_DECALS_MAX];
    uint32_t capacity; /* entries in use, 1..NOH_DECALS_MAX */
    uint32_t next;     /* the entry that the next decal replaces */
    uint32_t hold_ticks, fade_ticks;
} noh_decals;

/* capacity    1..NOH_DECALS_MAX; 0: all
 * hold_ticks  before a decal begins to fade; 0: it stays
 * fade_ticks  from then until it is gone */
void noh_decals_init(noh_decals *decals, uint32_t capacity, uint32_t hold_ticks, uint32_t fade_ticks);

typedef struct noh_decal_desc {
    float size;       /* half a side, in the unit of the mesh; above 0, up to NOH_NUMBER_MAX */
    float roll_rad;   /* rotation about the normal; 0: up is as near to +Y as possible */
    float roughness;  /* 0..1; default (0) 0.5 */
    uint8_t color[4]; /* sRGB and alpha, multiplied by the picture. All 0: opaque black */
    uint32_t tile;    /* of the picture */
} noh_decal_desc;

/* Add a decal where a ray has hit an actor, before the next frame.
 * hit      from noh_stage_pick in the last frame
 * index    of the new decal in decals->decals; may be NULL
 * errors   NOT_FOUND the actor is gone or was not shown; ARG a number of the desc is out of range */
noh_result noh_decals_strike(noh_decals *decals, const noh_stage *stage, const noh_stage_hit *hit,
                             const noh_decal_desc *desc, uint32_t *index, noh_error *error);

void noh_decals_step(noh_decals *decals, uint32_t ticks);

#ifdef __cplusplus
}
#endif

#endif
