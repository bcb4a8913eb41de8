/* lod_pools_internal.h: GPU memory for morphing, sized by LOD level and shared among instances.
 *
 * The GPU memory for morphing an instance depends on its LOD level. A pool has slots for instances at the pool's level
 * or a coarser one. For 1,000 bodies, 16 near, 64 middle and 920 far slots take a sixth of the memory of 1,000 near
 * ones. Slot k of pool p can be instance noh_gl_morph_instance(morph, p, k) of a noh_gl_morph whose p-th mesh is the
 * pool's level (noh_mesh_at_lod), with as many instances as the pool has slots.
 *
 * A frame of a game:
 *   noh_lod_pools_begin(pools);
 *   noh_lod_pools_ask_at(pools, i, noh_lod_finest(&lod), pixels_per_metre, distance, 0);  for each drawn instance
 *   noh_lod_pools_share_some(pools, moves);
 *   slot = noh_lod_pools_slot(pools, i);     for each drawn instance: draw it at slot.level or coarser, and
 *   noh_lod_set_limit(&lod, slot.level);     choose no finer level from the next frame on
 *
 * Requests are served by decreasing priority. Each gets the coarsest pool that holds its level; if it is full, the next
 * finer pool with room, otherwise the next coarser one, and the instance is drawn at this pool's level. If all slots
 * are taken the instance rests: it is drawn without targets. An instance keeps its slot while it is assigned the same
 * pool, and its priority then counts a quarter more, so that two instances at the same distance do not alternate
 * (unless `afresh` is set in noh_lod_pools_ask_at). A finer level fades in; an evicted instance switches level at once.
 * If coarser_high_water is above 0, the pools were too small to avoid this.
 *
 * A new slot must be accumulated. noh_lod_pools_share_some bounds the slots reassigned per frame, by decreasing
 * priority; two instances that hold each other's slots exchange them. A waiting instance keeps its current slot and is
 * drawn coarser for a while, or rests without one.
 *
 * Threads: pools belong to one thread at a time. */
#ifndef NOH_CHARACTER_LOD_POOLS_INTERNAL_H
#define NOH_CHARACTER_LOD_POOLS_INTERNAL_H

#include "noh/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_lod_pools_desc {
    uint32_t instance_count; /* 1..NOH_LOD_POOL_SLOTS_MAX */
    uint32_t pool_count;     /* 1..NOH_LOD_POOLS_MAX */
    /* [pool_count] the finest LOD level of each pool's slots, increasing; below NOH_LOD_LEVELS_MAX */
    const uint32_t *levels;
    const uint32_t *slot_counts; /* [pool_count] each at least 1; sum at most NOH_LOD_POOL_SLOTS_MAX, and at least
                                  * shown_max if every shown instance needs a slot */
    uint32_t shown_max;          /* most requests served per frame, by priority; default (0) all */
} noh_lod_pools_desc;

/* The slot of an instance. */
typedef struct noh_lod_slot {
    uint32_t pool, slot; /* slot 0..slot_counts[pool] - 1; pool NOH_NONE: rests, or left out */
    uint32_t level;      /* finest level it may be drawn at: the requested one, or the pool's if coarser */
    uint32_t left_out;   /* 1: do not draw it: shown_max instances had higher priority */
} noh_lod_slot;

typedef struct noh_lod_pools noh_lod_pools;

/* Counts of the last frame, and high-water marks. */
typedef struct noh_lod_pools_stats {
    uint32_t asked;
    uint32_t coarser; /* instances with a coarser level than requested */
    uint32_t moved;   /* instances with a new slot, whose morph layers must be accumulated again */
    uint32_t resting; /* instances without a slot, including waiting ones */
    uint32_t waiting; /* instances that wait for a new slot because of the bound on moves */
    uint32_t left_out;
    uint32_t coarser_high_water;
    uint32_t used[NOH_LOD_POOLS_MAX];
    uint32_t used_high_water[NOH_LOD_POOLS_MAX];
} noh_lod_pools_stats;

/* Exact bytes: 248, plus 16 per instance and 4 per slot; 0 for an invalid desc. */
size_t noh_lod_pools_size(const noh_lod_pools_desc *desc);

/* Build pools in memory[bytes].
 * errors  ARG a field of the desc, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the
 *         exact bytes) */
noh_result noh_lod_pools_init(void *memory, size_t bytes, const noh_lod_pools_desc *desc, noh_lod_pools **pools,
                              noh_error *error);

/* Check a copy of a pools block, such as from a saved game, against pools of the same desc.
 * errors  DATA the copy was made with a different desc, or a count or slot in it is out of range */
noh_result noh_lod_pools_check(const void *copy, const noh_lod_pools *like, noh_error *error);

void noh_lod_pools_begin(noh_lod_pools *pools);

/* Request a slot for this frame; at most once per instance. An instance without a request loses its slot: the slot of a
 * despawned actor is free from the next frame on, and what the actor leaves in the block is never drawn. With equal
 * priorities the nearer instance comes first, to a five-hundredth of its distance.
 * ranges  level: any; past the last pool's it counts as the last pool's. priority at least 0, higher first (NaN is
 *         0). distance at least 0, in any unit; afresh 1: its distance has changed since it got its slot, so holding
 *         the slot does not raise its priority */
void noh_lod_pools_ask_at(noh_lod_pools *pools, uint32_t instance, uint32_t level, float priority, float distance,
                          int afresh);

/* Assign slots to all requests that are not left out, as far as there are slots, but reassign at most `moves` in this
 * frame; below 2 counts as 2, because an exchange moves two. Repeated frames with the same requests end with the result
 * of UINT32_MAX moves. Linear in the requests; n log n if a pool has too few slots and requests must be sorted. */
void noh_lod_pools_share_some(noh_lod_pools *pools, uint32_t moves);

/* The slot of an instance that requested one in this frame. */
noh_lod_slot noh_lod_pools_slot(const noh_lod_pools *pools, uint32_t instance);

const noh_lod_pools_stats *noh_lod_pools_stats_of(const noh_lod_pools *pools);

#ifdef __cplusplus
}
#endif

#endif
