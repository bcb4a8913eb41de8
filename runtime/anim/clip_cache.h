/* clip_cache.h: decoded segments in a fixed block, and samples taken from them.
 *
 * One cache serves all instances that play its clips. A frame of a game:
 *   noh_clip_cache_tick(cache);                            once
 *   noh_clip_cache_want(cache, clip, soon, joints);        per playing track: what it needs next
 *   noh_clip_cache_work(cache, budget);                    decodes that much of what was wanted
 *   noh_clip_sample(cache, clip, ticks, joints, out, f);   per playing track
 * A sample whose segments are not there (nobody wanted them, the budget was short, a jump)
 * decodes them at once: the same bits, at the cost of up to two segments.
 *
 * Memory: noh_clip_cache_size says it; `slot_count` segments of the largest clip's size. */
#ifndef NOH_ANIM_CLIP_CACHE_H
#define NOH_ANIM_CLIP_CACHE_H

#include "anim/clip_codec.h"
#include "base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_clip_cache_desc {
    const noh_clip *const *clips; /* [clip_count], copied; the clips must outlive the cache */
    uint32_t clip_count;          /* 1..NOH_CLIP_CACHE_CLIPS_MAX */
    uint32_t slot_count;          /* segments held at once; 0: two per clip; at least 2 */
} noh_clip_cache_desc;

typedef struct noh_clip_cache noh_clip_cache;

/* High-water marks and counts since init, to budget the next build by. */
typedef struct noh_clip_cache_stats {
    uint64_t samples;
    uint64_t misses;        /* segments that a sample had to decode, in part or whole */
    uint64_t evictions;
    uint64_t decoded;       /* track-frames */
    uint64_t decoded_late;  /* those of misses */
} noh_clip_cache_stats;

/* Exact bytes of a cache; 0 for an impossible desc (the error says why). */
size_t noh_clip_cache_size(const noh_clip_cache_desc *desc, noh_error *error);

/* Build a cache in memory[bytes], 16-byte aligned.
 * errors  NOH_ERR_ARG; NOH_ERR_MEMORY with the bytes that are needed */
noh_result noh_clip_cache_init(void *memory, size_t bytes, const noh_clip_cache_desc *desc, noh_clip_cache **out, noh_error *error);

/* What the size follows from, clip after clip, for who has measured clips and not opened them yet.
 * Zero it, add each clip, ask. */
typedef struct noh_clip_cache_needs {
    uint32_t clip_count, segment_count;
    size_t segment_bytes;                             /* of the largest segment */
    uint8_t lengths[NOH_CLIP_SEGMENT_FRAMES_MAX + 1u]; /* 1: some segment has so many frames */
} noh_clip_cache_needs;

void noh_clip_cache_needs_add(noh_clip_cache_needs *needs, const noh_clip_info *info);
size_t noh_clip_cache_needs_size(const noh_clip_cache_needs *needs, uint32_t slot_count, noh_error *error);

/* A new frame of the game: what was touched in it will not be evicted by a want. */
void noh_clip_cache_tick(noh_clip_cache *cache);

/* Ask for the segment of a time (1/48,000 s; clamped to the clip), its first `joint_count` joints.
 * Costs no decoding. Returns 1 when a slot holds or awaits it, 0 when all slots are in use in this frame. */
int noh_clip_cache_want(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count);

/* Ask for all segments from one frame to another, in that order: backwards where last < first.
 * Returns how many of them no slot is left for. */
uint32_t noh_clip_cache_want_frames(noh_clip_cache *cache, uint32_t clip, uint32_t first, uint32_t last, uint32_t joint_count);

/* Decode what was wanted, oldest first, until `budget` track-frames are spent (the last track may
 * pass it). Returns what was spent. */
uint32_t noh_clip_cache_work(noh_clip_cache *cache, uint32_t budget);

/* Sample a pose.
 * shapes  out[joint_count], floats[float_count of the clip] (NULL: not wanted)
 * ranges  clip below clip_count; joint_count up to the clip's: a prefix is decoded and sampled alone
 * between frames: translations, scales and floats are lerped, rotations lerped and normalised. At
 *         rates whose ticks are no whole parts of a frame, rotations are taken up to 1/65,000 of a frame beside the time */
void noh_clip_sample(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count, noh_transform *out, float *floats);

noh_clip_cache_stats noh_clip_cache_stats_of(const noh_clip_cache *cache);

/* The clip at an index of the desc. */
const noh_clip *noh_clip_cache_clip(const noh_clip_cache *cache, uint32_t clip);

#ifdef __cplusplus
}
#endif

#endif
