/* spring_internal.h (private to physics/): the layout of a spring, and its step. Threads: as low_life.h. */
#ifndef NOH_SIM_SPRING_INTERNAL_H
#define NOH_SIM_SPRING_INTERNAL_H

#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/low_life.h"
#include <stddef.h>
#include <stdint.h>

#include "core/base/compiler_internal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the ends of the joints.
 * shapes  ends[joint_count][3], world space, at the last step's carrier */
void noh_spring_ends(const noh_spring *spring, const noh_spring_desc *desc, float *ends);

/* Check a desc.
 * errors  ARG, LIMIT: as noh_spring_init */
noh_result noh_spring_check_desc(const noh_spring_desc *desc, noh_error *error);

/* Whether a carrier's numbers are within their range, and its rotation is unit. */
int noh_spring_carries(const noh_spring_carrier *carrier);

/* Put a chain at rest at its carrier. */
void noh_spring_reset(noh_spring *spring, const noh_spring_desc *desc, const noh_spring_carrier *carrier);

/* Check a spring of this desc whose bytes come from outside.
 * shapes   spring: noh_spring_size bytes, aligned to 16
 * returns  NULL if it may be used, else a constant message */
const char *noh_spring_check(const noh_spring *spring, const noh_spring_desc *desc);

#ifdef __cplusplus
}
#endif

/* The end of a joint. Positions are relative to the first joint in the last step, so that a character far from the
 * origin loses no digits. */
typedef struct noh_spring_point {
    float now[3], before[3]; /* in the last two steps */
    float length;
} noh_spring_point;

/* Followed by noh_spring_point[joint_count], then noh_spring_collider[collider_count] of the last call. */
struct noh_spring {
    uint32_t joint_count, collider_count, collides;
    uint32_t left;              /* ticks since the last step */
    noh_spring_carrier last;    /* of the last call */
    noh_spring_carrier stepped; /* of the last step */
    float moved[3];             /* motion of the carrier in the last step */
    float turned[4];            /* its rotation in the previous step */
    uint32_t reserved;
};
NOH_STATIC_ASSERT(sizeof(noh_spring) == 104, spring);
NOH_STATIC_ASSERT(sizeof(noh_spring_point) == 28, spring_point);

/* Move the origin of its world by `by`: all positions p become p - by. */
void noh_spring_shift(noh_spring *spring, const float by[3]);

static inline noh_spring_point *noh_spring_points(noh_spring *s)
{
    return (noh_spring_point *)(void *)(s + 1);
}

static inline const noh_spring_point *noh_spring_const_points(const noh_spring *s)
{
    return (const noh_spring_point *)(const void *)(s + 1);
}

static inline noh_spring_collider *noh_spring_colliders(noh_spring *s)
{
    return (noh_spring_collider *)(void *)(noh_spring_points(s) + s->joint_count);
}

/* noh_spring_step and noh_spring_rotations, for as many chains at a time as the processor has lanes. spring_lanes.c can
 * be compiled again under other names, for other instructions. */
#if !defined(NOH_SPRING_STEP)
#define NOH_SPRING_STEP noh_spring_step
#define NOH_SPRING_ROTATIONS noh_spring_rotations
#else
uint32_t NOH_SPRING_STEP(const noh_spring_move *moves, uint32_t count, uint32_t ticks, float *scratch);
void NOH_SPRING_ROTATIONS(const noh_spring_move *moves, uint32_t count);
#endif

#endif
