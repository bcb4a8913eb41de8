/* clip_cache.h: decoded segments of clips in a fixed block, and poses sampled from them.
 *
 * A clip is stored in segments of up to NOH_CLIP_SEGMENT_FRAMES_MAX frames; a pose is sampled from one or two of
 * them. One cache serves all instances that play its clips. In each frame of a game call
 *   noh_clip_cache_begin_frame(cache);                     once
 *   noh_clip_cache_want(cache, clip, soon, joints);        per playing track: what it needs next
 *   noh_clip_cache_work(cache, budget);                    once: decodes that much of what was wanted
 *   noh_clip_sample(cache, clip, ticks, joints, out, f);   per playing track
 * A sample whose segments are missing (they were not wanted, the budget was too small, the track jumped) decodes them
 * at once: the same bits, at the cost of up to two segments; `decoded_late` counts it. Where nothing is wanted and a
 * clip is played on, forwards or backwards, each sample decodes a part of the segment that comes next, where there is
 * room: no frame decodes all of it.
 *
 *   noh_clip_cache_size, _init                    for clips that are open
 *   noh_clip_cache_needs_add, _needs_size         the size for clips that are not open yet
 *   noh_clip_cache_begin_frame, _want, _want_frames, _work   decode ahead
 *   noh_clip_sample                               a pose
 *   noh_clip_cache_stats_of, _capacity, _holds_all, _clip   what it did, and what it holds
 *
 * Threads: every call that takes a cache without const is for one thread at a time, with no other call on that cache
 * meanwhile. To sample on several threads between those calls, give each a view: clip_view.h.
 *
 * Memory: a cached segment takes the bytes of its frames. A cache of n segments has room for the n largest of its
 * clips: segments are sorted into size classes (four to each doubling), and each class has as many entries, all of the
 * size of its largest segment, as it has segments among those n. A segment goes to its own class, or to the next
 * larger one with an entry to spare. */
#ifndef NOH_CLIP_CLIP_CACHE_H
#define NOH_CLIP_CLIP_CACHE_H

#include "motion/clip/clip_codec.h"
#include "core/base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What one playing track needs at most, when it looks ahead by up to a segment: the segment it is in, the next one, and
 * the one before, where root motion is measured across their border. */
#define NOH_CLIP_CACHE_SEGMENTS_PER_TRACK 3u

typedef struct noh_clip_cache_desc {
    const noh_clip *const *clips;  /* [clip_count], copied; the clips must outlive the cache */
    uint32_t clip_count;           /* 1..NOH_CLIP_CACHE_CLIPS_MAX */
    uint32_t cached_segment_count; /* segments held at once, 2..NOH_CLIP_CACHE_SEGMENTS_MAX; default (0)
                                    * NOH_CLIP_CACHE_SEGMENTS_PER_TRACK for each clip, as if one track played each.
                                    * Never more than the clips have */
} noh_clip_cache_desc;

typedef struct noh_clip_cache noh_clip_cache;

/* Counts since init: what to size the cache by next time. A sample that jumps to a segment whose neighbours are not
 * cached decodes two frames of it, and counts two for each track. */
typedef struct noh_clip_cache_stats {
    uint64_t samples;
    uint64_t misses; /* segments that a sample had to decode, in part or whole */
    uint64_t evictions;
    uint64_t decoded;      /* track-frames: one track of a segment counts once for each of its frames */
    uint64_t decoded_late; /* those that a sample had to wait for */
} noh_clip_cache_stats;

/* Exact bytes of a cache; 0 for an impossible desc (the error says why). */
size_t noh_clip_cache_size(const noh_clip_cache_desc *desc, noh_error *error);

/* Build a cache in memory[bytes], aligned to NOH_MEMORY_ALIGN.
 * errors  ARG a field of desc, or memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_clip_cache_init(void *memory, size_t bytes, const noh_clip_cache_desc *desc, noh_clip_cache **out,
                               noh_error *error);

/* What the size of a cache follows from, for a caller that has measured its clips and not opened them yet. Set it to
 * zeros, add each clip, ask for the size. */
#define NOH_CLIP_CACHE_SIZES 120u
typedef struct noh_clip_cache_needs {
    uint32_t clip_count, segment_count;
    uint32_t size_segments[NOH_CLIP_CACHE_SIZES];      /* segments in each size class */
    uint32_t size_bytes[NOH_CLIP_CACHE_SIZES];         /* bytes of the largest segment of each */
    uint8_t lengths[NOH_CLIP_SEGMENT_FRAMES_MAX + 1u]; /* bit b: some segment of transform b has so many frames */
} noh_clip_cache_needs;

void noh_clip_cache_needs_add(noh_clip_cache_needs *needs, const noh_clip_info *info);
size_t noh_clip_cache_needs_size(const noh_clip_cache_needs *needs, uint32_t cached_segment_count, noh_error *error);

/* A frame of the game begins. Until the next call no want evicts a segment that this frame has wanted or sampled. */
void noh_clip_cache_begin_frame(noh_clip_cache *cache);

/* Ask for the first `joint_count` joints of the segment at a time. Decodes nothing.
 * units    ticks, clamped to the clip
 * returns  1 when the segment is cached or will be; 0 when there is no room, because this frame uses all that is cached
 */
int noh_clip_cache_want(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count);

/* Ask for all segments from one frame of a clip to another, in that order: backwards where last < first. Frames are
 * clamped to the clip.
 * returns  how many of the segments found no room */
uint32_t noh_clip_cache_want_frames(noh_clip_cache *cache, uint32_t clip, uint32_t first, uint32_t last,
                                    uint32_t joint_count);

/* Decode what was wanted, in the order of asking, until `budget` track-frames are spent (the last track may exceed it).
 * returns  the track-frames spent */
uint32_t noh_clip_cache_work(noh_clip_cache *cache, uint32_t budget);

/* Sample a pose.
 * shapes  out[joint_count], floats[float_count of the clip] (NULL: not wanted)
 * ranges  clip below clip_count; joint_count up to the clip's: only these first joints are decoded and sampled
 * Between frames translations, scales and floats are interpolated linearly, rotations linearly and then normalised. At
 * sample rates whose frames are not a whole number of ticks, rotations are those of a time within 1/65,000 of a frame
 * of the one asked for. */
void noh_clip_sample(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count, noh_transform *out,
                     float *floats);

/* The counts of the cache itself; each view has its own. */
noh_clip_cache_stats noh_clip_cache_stats_of(const noh_clip_cache *cache);

/* How many segments it holds at once. */
uint32_t noh_clip_cache_capacity(const noh_clip_cache *cache);

/* 1 where every segment of every clip is decoded: none is ever evicted then, and there is nothing left to want. Linear
 * in the segments while it is so, else until the first that is missing. */
int noh_clip_cache_holds_all(const noh_clip_cache *cache);

/* The clip at an index of the desc. */
const noh_clip *noh_clip_cache_clip(const noh_clip_cache *cache, uint32_t clip);

#ifdef __cplusplus
}
#endif

#endif
