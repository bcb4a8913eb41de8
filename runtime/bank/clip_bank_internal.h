/* clip_bank_internal.h (private to anim/): which of the set's floats a clip's are. */
#ifndef NOH_BANK_CLIP_BANK_INTERNAL_H
#define NOH_BANK_CLIP_BANK_INTERNAL_H

#include "bank/clip_bank.h"

/* A run of a clip's floats, and where it goes in the set's. */
typedef struct noh_bank_floats {
    uint16_t from, to, width;
} noh_bank_floats;

struct noh_bank_clip {
    const noh_bank_floats *floats; /* [float_runs] */
    uint32_t float_runs;
    uint32_t joint_count;
};

/* Let set->clips sample through the set's cache, which that changes. */
void noh_clip_bank_sample_cache(noh_clip_bank *set);

#endif
