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

/* Let set->anim sample through the set's cache, which that changes. */
void noh_motion_set_sample_cache(noh_motion_set *set);

#endif
