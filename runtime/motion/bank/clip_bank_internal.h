/* clip_bank_internal.h (private to bank/): the mapping from the floats of a clip to the bank's. */
#ifndef NOH_BANK_CLIP_BANK_INTERNAL_H
#define NOH_BANK_CLIP_BANK_INTERNAL_H

#include "noh/clip.h"

/* A run of a clip's floats, and its place among the bank's. */
typedef struct noh_bank_floats {
    uint16_t from, to, width;
} noh_bank_floats;

struct noh_bank_clip {
    const noh_bank_floats *floats; /* [float_runs] */
    uint32_t float_runs;
    uint32_t joint_count;
};

/* Let bank->clips sample through the bank's cache; sampling then changes the cache. */
void noh_clip_bank_sample_cache(noh_clip_bank *bank);

#endif
