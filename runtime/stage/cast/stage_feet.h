/* stage_feet.h: actors that stand on the ground.
 *
 *   noh_stage_feet_part   a part of a kind (part.h) that puts its actors' feet on the ground
 *
 *   noh_feet_rig_make(&source, &feet.rig, &error); feet.ground.world = &world;
 *   const noh_stage_part parts[] = { gaze, noh_stage_feet_part(&feet), hands, springs };
 *   kind.parts = parts, kind.part_count = 4;
 *
 * The order of parts is that of the frame: what looks comes before feet; hands and springs come after them.
 * The state is a noh_feet: planned, saved, restored, forked and hashed with the stage. The game moves places along the
 * ground as roughly as it likes, from step to step; bodies follow smoothly.
 * At a detail without the feet's joints, and without ground, poses stay as they are. An actor that hangs on another has
 * no place of its own that a part could know: its kind should have no such part.
 * Threads: the ground is read by jobs at the same time. */
#ifndef NOH_STAGE_STAGE_FEET_H
#define NOH_STAGE_STAGE_FEET_H

#include "life/reach/feet.h"
#include "stage/cast/part.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the feet of a kind have in common. */
typedef struct noh_kind_feet {
    noh_feet_rig rig; /* of the kind's skeleton */
    noh_ground ground;
} noh_kind_feet;

/* feet  must outlive the stage */
noh_stage_part noh_stage_feet_part(const noh_kind_feet *feet);

#ifdef __cplusplus
}
#endif

#endif
