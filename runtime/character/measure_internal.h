/* measure_internal.h (private to character/): what measuring errors shares. */
#ifndef NOH_CHARACTER_MEASURE_INTERNAL_H
#define NOH_CHARACTER_MEASURE_INTERNAL_H

#include "anim/pose.h"
#include "base/arena.h"
#include "character/time_lod.h"

/* The name of a probe's or a motion's fault; NULL: none. joint_reach_m is not looked at. */
const char *noh_probe_fault(const noh_time_probe *probe, uint32_t motion);

/* How far joint 0 is from where it began when a motion that repeats begins again; 0 of another, or where the probe does not travel.
 * shapes  pose[joint_count], floats[float_count] to work in */
void noh_probe_travel(const noh_time_probe *probe, uint32_t motion, noh_transform *pose, float *floats, float travel[3]);

/* The matrices and floats of a motion at a tick of its own clock, played in its own loop mode; moved by `travel` for
 * every pass that a repeating one has made: NULL: not.
 * shapes  pose[joint_count], model[joint_count][12], floats[float_count] */
void noh_probe_sample(const noh_time_probe *probe, uint32_t motion, int64_t tick, const float *travel, noh_transform *pose, float *model,
                      float *floats);

/* ---- rates ---- */

typedef struct noh_rate_pose {
    float *model;
    float *floats;
} noh_rate_pose;

/* What measuring rates works in: the two poses that are mixed, and the true one in between. */
typedef struct noh_rate_work {
    noh_transform *pose;
    noh_rate_pose from, to, right;
    float travel[3];
} noh_rate_work;

/* The most that a mix of the two poses, `part` of the second, is off; `least` where it is not more. */
typedef float (*noh_rate_off)(void *user, const noh_time_probe *probe, const noh_rate_work *work, float part, float least);

void noh_rate_carve(noh_arena *arena, const noh_anim_set *set, noh_rate_work *work);

/* What the probe's floats are off in a mix, all at their worst. */
float noh_rate_floats_off(const noh_time_probe *probe, const noh_rate_work *work, float part);

/* error_m[NOH_RATE_COUNT] of a motion, over all intervals and places that time_lod.h names. */
void noh_rate_measure(const noh_time_probe *probe, uint32_t motion, noh_rate_off off, void *user, noh_rate_work *work, float *error_m);

/* ---- */

/* The most that a point within reach of a joint is off where the joint's matrix is off by this difference: the joint's own
 * way, and the turn; `least` where it is not more than that. */
float noh_probe_off(const float difference[12], float reach, float least);

#endif
