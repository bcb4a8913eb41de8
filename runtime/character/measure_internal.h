/* measure_internal.h (private to character/): what measuring errors shares. */
#ifndef NOH_CHARACTER_MEASURE_INTERNAL_H
#define NOH_CHARACTER_MEASURE_INTERNAL_H

#include "anim/pose.h"
#include "base/arena.h"
#include "character/time_lod.h"

/* The name of a probe's or a motion's fault; NULL: none. */
const char *noh_probe_fault(const noh_time_probe *probe, uint32_t motion);

/* MEMORY where memory[bytes] is not what measuring needs; ARG where it is not aligned. */
noh_result noh_probe_check_memory(const void *memory, size_t bytes, size_t need, noh_error *error);

/* How far joint 0 is from where it began when a motion that repeats begins again; 0 of another, or where the probe does not travel.
 * shapes  pose[joint_count], floats[float_count] to work in */
void noh_probe_travel(const noh_time_probe *probe, uint32_t motion, noh_transform *pose, float *floats, float travel[3]);

/* The matrices and floats of a motion at a tick of its own clock, played in its own loop mode; moved by `travel` for
 * every pass that a repeating one has made: NULL: not.
 * shapes  pose[joint_count], model[joint_count][12], floats[float_count] */
void noh_probe_sample(const noh_time_probe *probe, uint32_t motion, int64_t tick, const float *travel, noh_transform *pose, float *model,
                      float *floats);

/* The most that a point within reach of a joint is off where the joint's matrix is off by this difference: the joint's own
 * way, and the turn; `least` where it is not more than that. */
float noh_probe_off(const float difference[12], float reach, float least);

#endif
