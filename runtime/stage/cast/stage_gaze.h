/* stage_gaze.h: actors that look at points and reach for them.
 *
 *   noh_stage_gaze_part    a part of a kind (part.h) that turns spine, neck, head and eyes
 *   noh_stage_reach_part   one that puts hands on points
 *
 *   noh_gaze_rig_make(&pack, 0, &gaze.rig, &error);
 *   const noh_stage_part parts[] = { noh_stage_gaze_part(&gaze), noh_stage_feet_part(&feet),
 *                                    noh_stage_reach_part(&reach) };
 *   noh_gaze *g = noh_actor_part(stage, actor, 0);      g->point[2] = 3.0f, g->looks = 1;
 *   noh_reach *r = noh_actor_part(stage, actor, 2);     r->hands[0].point[1] = 1.0f, r->hands[0].wants = 1;
 *
 * Points are the world's: the game sets them whenever they move. What looks comes before feet, hands come after them,
 * because feet move the body. States are a noh_gaze and a noh_reach: planned, saved, restored, forked and hashed with
 * the stage.
 *
 * In a kind with a face the gaze part leaves poses alone: head and eyes are the face's (noh_actor_look_at). At a detail
 * without the rig's joints poses stay as they are. An actor that hangs on another has no place of its own that a part
 * could know: its kind should have no such part. */
#ifndef NOH_STAGE_STAGE_GAZE_H
#define NOH_STAGE_STAGE_GAZE_H

#include "life/reach/gaze.h"
#include "life/reach/reach.h"
#include "stage/cast/part.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the gazes of a kind have in common. */
typedef struct noh_kind_gaze {
    noh_gaze_rig rig;      /* of the kind's skeleton */
    noh_ik_look_desc head; /* zeros: as in ik.h */
} noh_kind_gaze;

/* They must outlive the stage. */
noh_stage_part noh_stage_gaze_part(const noh_kind_gaze *gaze);
noh_stage_part noh_stage_reach_part(const noh_reach_rig *rig);

#ifdef __cplusplus
}
#endif

#endif
