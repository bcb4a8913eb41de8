/* level_pools.h: memory that is as large as the level of detail, shared out among instances (row C16.4).
 *
 * What an instance takes on the GPU to be morphed is as large as its level. A pool is a number of slots, each for one
 * instance at the pool's level or a coarser one: of 1,000 bodies 16 near, 64 middle and 920 far slots take a sixth of
 * what 1,000 near ones take. Slot k of pool p can be instance noh_gl_morph_instance(morph, p, k) of a noh_gl_morph whose
 * p-th mesh is the pool's level (noh_mesh_at_level), with as many instances as the pool has slots.
 *
 * A frame of a game:
 *   noh_level_pools_begin(pools);
 *   noh_level_pools_ask(pools, i, noh_detail_finest(&detail), pixels_per_metre);  per instance that is drawn
 *   noh_level_pools_share(pools);
 *   slot = noh_level_pools_slot(pools, i);                      per instance that asked: draw it at slot.level or coarser, and
 *   noh_detail_limit(&detail, slot.level);                      from the next frame on choose no finer one
 *
 * Who gets what: the highest priority first, each the coarsest pool that holds the level it asks for; where those are
 * full, the next coarser pool: it is then drawn at that one's level. There are as many slots as instances, so
 * everyone gets one. Who holds a slot keeps it while it is given the same pool, and counts a quarter more than who does
 * not, so that two that are equally near do not take turns. A level that comes back fades in; who has to make room for
 * one that is nearer changes its level at once: `coarser_high_water` tells when pools are too small for that not to happen. */
#ifndef NOH_CHARACTER_LEVEL_POOLS_H
#define NOH_CHARACTER_LEVEL_POOLS_H

#include "base/limits.h"
#include "base/result.h"
#include "character/detail.h"

typedef struct noh_level_pools_desc {
    uint32_t instance_count;     /* 1..NOH_LEVEL_POOL_SLOTS_MAX */
    uint32_t pool_count;         /* 1..NOH_LEVEL_POOLS_MAX */
    const uint32_t *levels;      /* [pool_count] the finest level that a slot of each holds, rising; below NOH_DETAIL_LEVELS_MAX */
    const uint32_t *slot_counts; /* [pool_count] each at least 1; in all at least instance_count, at most NOH_LEVEL_POOL_SLOTS_MAX */
} noh_level_pools_desc;

/* Where an instance is. */
typedef struct noh_level_slot {
    uint32_t pool, slot; /* slot 0..slot_counts[pool] - 1 */
    uint32_t level;      /* the finest that it may be drawn at: what it asked for, or the pool's where that is coarser */
} noh_level_slot;

typedef struct noh_level_pools noh_level_pools;

/* Counts of the frame that was shared last, and high-water marks. */
typedef struct noh_level_pools_stats {
    uint32_t asked;
    uint32_t coarser;            /* how many were given a coarser level than they asked for */
    uint32_t moved;              /* how many were given another slot than they had, or a first one: to be accumulated afresh */
    uint32_t coarser_high_water;
    uint32_t used[NOH_LEVEL_POOLS_MAX];
    uint32_t used_high_water[NOH_LEVEL_POOLS_MAX];
} noh_level_pools_stats;

/* Exact bytes: 16 for an instance, 4 for a slot, 248 for all; 0 for an impossible desc. */
size_t noh_level_pools_size(const noh_level_pools_desc *desc);

/* errors  ARG names the field; MEMORY need: the bytes */
noh_result noh_level_pools_init(void *memory, size_t bytes, const noh_level_pools_desc *desc, noh_level_pools **pools, noh_error *error);

void noh_level_pools_begin(noh_level_pools *pools);

/* Ask for a slot in this frame; each instance at most once. Who does not ask gives up its slot.
 * ranges  level: past the last pool's it is the last pool's to hold; priority at least 0 (NaN is 0): the more, the sooner */
void noh_level_pools_ask(noh_level_pools *pools, uint32_t instance, uint32_t level, float priority);

/* Give everyone who asked a slot. Where one of the pools is too small for all who ask for it, they are sorted: n log n. */
void noh_level_pools_share(noh_level_pools *pools);

/* Of an instance that asked in this frame. */
noh_level_slot noh_level_pools_slot(const noh_level_pools *pools, uint32_t instance);

const noh_level_pools_stats *noh_level_pools_stats_of(const noh_level_pools *pools);

#endif
