/* measure_internal.h (private to character/): shared by the measurements of LOD errors. */
#ifndef NOH_CHARACTER_MEASURE_INTERNAL_H
#define NOH_CHARACTER_MEASURE_INTERNAL_H

#include "stage/character/time_lod_internal.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"

/* The error message of a probe or a clip; NULL: valid. Does not check joint_radius_m. */
const char *noh_probe_fault(const noh_time_probe *probe, uint32_t clip);

/* The travel of joint 0 in one pass of a repeating clip; 0 for other clips, or if the probe does not travel.
 * shapes  scratch: pose[joint_count], floats[float_count] */
void noh_probe_travel(const noh_time_probe *probe, uint32_t clip, noh_transform *pose, float *floats, float travel[3]);

/* The matrices and floats of a clip at a tick of its own clock, played in its own loop mode, moved by `travel` for
 * every completed pass; NULL: not moved.
 * shapes  pose[joint_count], model[joint_count][12], floats[float_count] */
void noh_probe_sample(const noh_time_probe *probe, uint32_t clip, int64_t tick, const float *travel,
                      noh_transform *pose, float *model, float *floats);

/* ---- update rates ---- */

typedef struct noh_rate_pose {
    float *model;
    float *floats;
} noh_rate_pose;

/* Working memory of measuring update rates: the two poses that are mixed, and the true one in between. */
typedef struct noh_rate_work {
    noh_transform *pose;
    noh_rate_pose from, to, right;
    float travel[3];
} noh_rate_work;

/* The largest error of a mix of the two poses, `part` of the second, or `least` if that is larger. */
typedef float (*noh_rate_off)(void *user, const noh_time_probe *probe, const noh_rate_work *work, float part,
                              float least);

void noh_rate_carve(noh_arena *arena, const noh_clip_set *set, noh_rate_work *work);

/* The error of the probe's floats in a mix: the sum of their worst displacements. */
float noh_rate_floats_off(const noh_time_probe *probe, const noh_rate_work *work, float part);

/* Compute error_m[NOH_UPDATE_RATE_COUNT] of a clip, over all periods and ticks listed in low_stage.h. */
void noh_rate_measure(const noh_time_probe *probe, uint32_t clip, noh_rate_off off, void *user, noh_rate_work *work,
                      float *error_m);

/* ---- points ---- */

/* The largest error of a point within `radius` of a joint whose matrix has this error (shown minus true): the error of
 * its translation plus radius times the norm of the rest; or `least` if that is larger. */
float noh_probe_off(const float difference[12], float radius, float least);

#endif
