/* blob.h: soft dark spots where bodies come near the ground, in place of a shadow map.
 *
 *   noh_blob_rig_make   boxes of a kind's largest parts
 *   noh_actor_blobs     the spots of an actor, as it was shown last
 *
 * stage_blob.h draws them. A part of radius r at a height h over the ground takes r^2 / (r^2 + (2 h)^2) of the
 * light that comes from all sides there, about as a disc would: two thirds of that are drawn. Nothing is kept from
 * frame to frame. Standing figures have a spot under each foot, those that lie under all of their bodies.
 *
 * Threads: the rig is read only; noh_actor_blobs as noh_actor_joint. */
#ifndef NOH_ACTORS_BLOB_H
#define NOH_ACTORS_BLOB_H

#include "life/reach/feet.h"
#include "stage/cast/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

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
 * ground   what is below it (feet.h)
 * shapes   blobs[NOH_BLOBS_MAX]
 * returns  how many there are; 0: the actor is gone, was not posed, or is too high up */
uint32_t noh_actor_blobs(const noh_stage *stage, noh_actor actor, const noh_blob_rig *rig, const noh_ground *ground,
                         noh_blob *blobs);

#ifdef __cplusplus
}
#endif

#endif
