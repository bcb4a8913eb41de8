/* hair_internal.h (private to hair/): the layout of hair, and its step. Threads: as low_life.h. */
#ifndef NOH_SIM_HAIR_INTERNAL_H
#define NOH_SIM_HAIR_INTERNAL_H

#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Check hair of this desc whose bytes come from outside.
 * shapes   hair: noh_hair_size bytes, aligned to 16
 * returns  NULL if it may be used, else a constant message */
const char *noh_hair_check(const noh_hair *hair, const noh_hair_desc *desc);

/* Compute a point of the Catmull-Rom curve through the points of a hair, as used for strips. Tangents are half the
 * difference of the neighbours; with the full difference, as in the source, the curve overshoots.
 * shapes  points[count][3]
 * ranges  count 2..; t 0 the root, 1 the tip */
void noh_hair_curve(const float *points, uint32_t count, float t, float out[3]);

#ifdef __cplusplus
}
#endif

#define NOH_HAIR_STEP_SECONDS ((float)NOH_HAIR_STEP_TICKS / 48000.0f)

/* All in the head's space at the step. */
typedef struct noh_hair_point {
    float now[3], before[3]; /* in the last two steps */
    float velocity[3];       /* in the world, along the head's axes */
    float length;            /* from the previous point; 0 for a root */
} noh_hair_point;

/* Followed by noh_hair_point[hair_count][point_count]. */
struct noh_hair {
    uint32_t hair_count, point_count;
    uint32_t left;            /* ticks since the last step */
    uint32_t steps;           /* in total, for gusts */
    noh_hair_carrier last;    /* of the last call */
    noh_hair_carrier stepped; /* of the last step */
    uint32_t reserved[4];
};
NOH_STATIC_ASSERT(sizeof(noh_hair) == 112, hair);
NOH_STATIC_ASSERT(sizeof(noh_hair_point) == 40, hair_point);

/* The head's motion in a step: the transform from its space in the last step to its space in this one, and
 * accelerations. */
typedef struct noh_hair_motion {
    float turn[3][3], moved[3]; /* columns */
    float gravity[3], wind[3];  /* head space */
    float keep;                 /* share of a velocity that is kept */
} noh_hair_motion;

static inline noh_hair_point *noh_hair_points_of(noh_hair *h)
{
    return (noh_hair_point *)(void *)(h + 1);
}

static inline const noh_hair_point *noh_hair_const_points_of(const noh_hair *h)
{
    return (const noh_hair_point *)(const void *)(h + 1);
}

/* Move the origin of its world by `by`, metres: the head's position becomes p - by. */
void noh_hair_shift(noh_hair *hair, const float by[3]);

/* Interpolate the carrier at a fraction `t` of a call's time, and compute the motion of a step to there. */
void noh_hair_carry(const noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, float t,
                    noh_hair_carrier *at, noh_hair_motion *motion);

/* noh_hair_step and noh_hair_points, for as many hairs at a time as the processor has lanes. hair_lanes.c can be
 * compiled again under other names, for other instructions. */
#if !defined(NOH_HAIR_STEP)
#define NOH_HAIR_STEP noh_hair_step
#define NOH_HAIR_POINTS noh_hair_points
#else
uint32_t NOH_HAIR_STEP(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, uint32_t ticks);
void NOH_HAIR_POINTS(const noh_hair *hair, const noh_hair_desc *desc, float *points);
#endif

#endif
