/* motion_set_internal.h (private to anim/): which of the set's floats a clip's are. */
#ifndef NOH_ANIM_MOTION_SET_INTERNAL_H
#define NOH_ANIM_MOTION_SET_INTERNAL_H

#include "anim/motion_set.h"

/* A run of a clip's floats, and where it goes in the set's. */
typedef struct noh_motion_floats {
    uint16_t from, to, width;
} noh_motion_floats;

struct noh_motion_set_clip {
    const noh_motion_floats *floats; /* [float_runs] */
    uint32_t float_runs;
    uint32_t joint_count;
};

/* A noh_motion_sample whose user is the noh_motion_set: through its cache, which it changes. */
void noh_motion_set_sample(void *user, uint32_t motion, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose, uint32_t float_count,
                           float *floats);

#endif
