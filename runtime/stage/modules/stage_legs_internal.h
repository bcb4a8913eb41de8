/* stage_legs_internal.h: legs of a pose that keep their feet where they are wanted while the pelvis moves. */
#ifndef NOH_STAGE_STAGE_LEGS_INTERNAL_H
#define NOH_STAGE_STAGE_LEGS_INTERNAL_H

#include "noh/base.h"
#include "noh/body.h"
#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

/* In model space, in the skeleton's unit. */
typedef struct noh_stage_leg {
    float ankle[3];                /* where it is wanted */
    float foot[4];                 /* the rotation that is wanted */
    float hip[3], knee[3], end[3]; /* as posed */
    float pole[3];                 /* the direction of the knee */
} noh_stage_leg;

/* Read a leg, with the wishes that its foot stays as it is. */
void noh_stage_read_leg(const noh_feet_rig *rig, const noh_modifier_work *w, uint32_t leg, noh_stage_leg *out);
/* Move the pelvis with all above it, lower where a leg is too short, and bend the legs to where they are wanted.
 * legs  [rig->leg_count] */
void noh_stage_move_pelvis(const noh_feet_rig *rig, const noh_modifier_work *w, noh_stage_leg *legs, const float by[3]);

#ifdef __cplusplus
}
#endif

#endif
