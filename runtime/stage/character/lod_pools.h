/* lod_pools.h: GPU memory for morphing, sized by LOD level and shared among instances.
 *
 * The memory that an instance takes on the GPU to be morphed depends on its LOD level. A pool is a number of slots,
 * each for one instance at the pool's level or a coarser one: for 1,000 bodies, 16 near, 64 middle and 920 far slots
 * take a sixth of what 1,000 near ones take. Slot k of pool p can be instance noh_gl_morph_instance(morph, p, k) of a
 * noh_gl_morph whose p-th mesh is the pool's level (noh_mesh_at_lod), with as many instances as the pool has slots.
 *
 * A frame of a game:
 *   noh_lod_pools_begin(pools);
 *   noh_lod_pools_ask(pools, i, noh_lod_finest(&lod), pixels_per_metre);  for each instance that is drawn
 *   noh_lod_pools_share(pools);
 *   slot = noh_lod_pools_slot(pools, i);     for each instance that asked: draw it at slot.level or coarser, and
 *   noh_lod_set_limit(&lod, slot.level);     choose no finer level from the next frame on
 *
 * Sharing: requests are served by falling priority. Each gets the coarsest pool that holds its level; if that is full,
 * the next finer one with room, else the next coarser one, and the instance is drawn at that pool's level. Where all
 * slots are taken it rests: it is drawn without targets. An instance keeps its slot while it is given the same pool,
 * and its priority counts a quarter more than a newcomer's, so that two instances at the same distance do not take
 * turns (not where it asks afresh: noh_lod_pools_ask_at). A level that comes back fades in; an evicted instance switches level at once. `coarser_high_water` tells when
 * pools are too small to avoid that.
 *
 * A new slot is a tile to be accumulated. noh_lod_pools_share_some bounds how many slots change hands in a frame: by
 * falling priority, and where two instances hold what the other is due, they exchange. Whoever has to wait keeps the
 * slot that it has, so it is drawn coarser for a while, or rests where it has none.
 *
 * Threads: pools belong to one thread at a time. */
#ifndef NOH_CHARACTER_LOD_POOLS_H
#define NOH_CHARACTER_LOD_POOLS_H

#include "core/base/limits.h"
#include "core/base/result.h"
#include "stage/character/lod.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_lod_pools_desc {
    uint32_t instance_count; /* 1..NOH_LOD_POOL_SLOTS_MAX */
    uint32_t pool_count;     /* 1..NOH_LOD_POOLS_MAX */
    /* [pool_count] the finest LOD level that each pool's slots hold, rising; below NOH_LOD_LEVELS_MAX */
    const uint32_t *levels;
    const uint32_t *slot_counts; /* [pool_count] each at least 1; their sum at most NOH_LOD_POOL_SLOTS_MAX, and at
                                    least shown_max for all that are shown to have one */
    uint32_t shown_max;          /* requests of the highest priority that are served in a frame; default (0) all */
} noh_lod_pools_desc;

/* The slot of an instance. */
typedef struct noh_lod_slot {
    uint32_t pool, slot; /* slot 0..slot_counts[pool] - 1; pool NOH_NONE: it rests, or is left out */
    uint32_t level;      /* the finest level it may be drawn at: the one asked for, or the pool's if that is coarser */
    uint32_t left_out;   /* 1: more asked than shown_max, and of higher priority; it is not to be drawn */
} noh_lod_slot;

typedef struct noh_lod_pools noh_lod_pools;

/* Counts of the last frame, and high-water marks. */
typedef struct noh_lod_pools_stats {
    uint32_t asked;
    uint32_t coarser; /* instances that were given a coarser level than they asked for */
    uint32_t moved;   /* instances with a new slot: their morph layers must be accumulated again */
    uint32_t resting; /* instances without a slot, those that wait for one too */
    uint32_t waiting; /* instances whose slot did not change yet for the bound on moves */
    uint32_t left_out;
    uint32_t coarser_high_water;
    uint32_t used[NOH_LOD_POOLS_MAX];
    uint32_t used_high_water[NOH_LOD_POOLS_MAX];
} noh_lod_pools_stats;

/* Exact bytes: 16 per instance, 4 per slot, and 248 once; 0 for an impossible desc. */
size_t noh_lod_pools_size(const noh_lod_pools_desc *desc);

/* errors  ARG a field of the desc, or memory NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small; need: the exact
 * bytes */
noh_result noh_lod_pools_init(void *memory, size_t bytes, const noh_lod_pools_desc *desc, noh_lod_pools **pools,
                              noh_error *error);

/* Check a copy of a pools' block from outside, such as a saved game, against pools of the same desc.
 * errors  DATA not a copy of such pools, or a count or slot in it is out of range */
noh_result noh_lod_pools_check(const void *copy, const noh_lod_pools *like, noh_error *error);

void noh_lod_pools_begin(noh_lod_pools *pools);

/* Ask for a slot in this frame; each instance at most once. An instance that does not ask gives up its slot.
 * ranges  level: any; past the last pool's it counts as the last pool's. priority at least 0, higher first (NaN is 0)
 */
void noh_lod_pools_ask(noh_lod_pools *pools, uint32_t instance, uint32_t level, float priority);

/* The same; of equal priorities the nearer one comes first, to a five-hundredth of its distance.
 * ranges  distance at least 0, in any unit; afresh 1: it is nearer or farther than by what it was given its slot: keeping
 *         it counts for nothing */
void noh_lod_pools_ask_at(noh_lod_pools *pools, uint32_t instance, uint32_t level, float priority, float distance,
                          int afresh);

/* Give a slot to every instance that asked and is not left out, as far as there are slots. Linear in the requests;
 * where a pool is too small for those that want it, they are sorted first: n log n. */
void noh_lod_pools_share(noh_lod_pools *pools);

/* The same, and at most `moves` slots change hands in this frame; 2 where it is less, for an exchange is two. Every
 * frame settles some, so one that keeps asking for the same ends with what noh_lod_pools_share gives. */
void noh_lod_pools_share_some(noh_lod_pools *pools, uint32_t moves);

/* Of an instance that asked in this frame. */
noh_lod_slot noh_lod_pools_slot(const noh_lod_pools *pools, uint32_t instance);

const noh_lod_pools_stats *noh_lod_pools_stats_of(const noh_lod_pools *pools);

#ifdef __cplusplus
}
#endif

#endif
