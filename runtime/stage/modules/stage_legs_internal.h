/* stage_legs_internal.h: legs of a pose that keep their feet where they are wanted while the pelvis moves. */
#ifndef NOH_STAGE_STAGE_LEGS_INTERNAL_H
#define NOH_STAGE_STAGE_LEGS_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
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

/* The breath of a body that stands or lies: 0 exhaled .. 1 inhaled. */
NOH_UNUSED static inline float noh_stage_breath(int64_t clock)
{
    const uint32_t period = 4u * NOH_TICKS_PER_SECOND, at = (uint32_t)((uint64_t)clock % period);
    float sine, cosine;
    noh_sin_cos_turn((uint32_t)(((uint64_t)at << 32) / period), &sine, &cosine);
    return 0.5f - 0.5f * cosine;
}

#ifdef __cplusplus
}
#endif

#endif
