/* clip_cache.h: decoded segments of clips in a fixed block, and poses sampled from them.
 *
 * A clip is stored in segments of up to NOH_CLIP_SEGMENT_FRAMES_MAX frames; a pose is sampled from one or two of them.
 * One cache serves all instances that play its clips. In each frame of a game call
 *   noh_clip_cache_begin_frame(cache);                     once
 *   noh_clip_cache_want(cache, clip, soon, joints);        per playing track: what it needs next
 *   noh_clip_cache_work(cache, budget);                    once: decodes requested segments within the budget
 *   noh_clip_sample(cache, clip, ticks, joints, out, f);   per playing track
 * A sample whose segments are missing (not requested, budget too small, track jumped) decodes them immediately: the
 * same bits, at the cost of up to two segments, counted in `decoded_late`. If nothing is requested and a clip plays
 * steadily, forwards or backwards, each sample decodes part of the next segment if there is room, so no single frame
 * decodes all of it.
 *
 *   noh_clip_cache_size, _init                    for clips that are open
 *   noh_clip_cache_needs_add, _needs_size         the size for clips that are not open yet
 *   noh_clip_cache_begin_frame, _want, _want_frames, _work   decode ahead
 *   noh_clip_sample                               a pose
 *   noh_clip_cache_stats_of, _capacity, _holds_all, _clip   statistics and contents
 *
 * Threads: every call that takes a non-const cache is for one thread at a time, with no other call on that cache at the
 * same time. To sample on several threads between those calls, give each a view: clip_view.h.
 *
 * Memory: a cached segment takes the bytes of its frames. A cache of n segments has room for the n largest segments of
 * its clips: segments are sorted into size classes (four per doubling), and each class has as many entries as it has
 * segments among those n, each entry as large as the largest segment of the class. A segment is stored in its own
 * class, or in the next larger class with a free entry. */
#ifndef NOH_CLIP_CLIP_CACHE_H
#define NOH_CLIP_CLIP_CACHE_H

#include "motion/clip/clip_codec.h"
#include "core/base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Most segments that a playing track needs when it looks ahead by up to one segment: its current segment, the next one,
 * and the previous one, used for root motion across their border. */
#define NOH_CLIP_CACHE_SEGMENTS_PER_TRACK 3u

typedef struct noh_clip_cache_desc {
    const noh_clip *const *clips; /* [clip_count], copied; the clips must outlive the cache */
    uint32_t clip_count;          /* 1..NOH_CLIP_CACHE_CLIPS_MAX */
    /* segments held at the same time, 2..NOH_CLIP_CACHE_SEGMENTS_MAX; default (0) NOH_CLIP_CACHE_SEGMENTS_PER_TRACK for
     * each clip, as if one track played each. Never more than the clips have */
    uint32_t cached_segment_count;
} noh_clip_cache_desc;

typedef struct noh_clip_cache noh_clip_cache;

/* Counts since init, to tune the cache size. A sample that jumps to a segment whose neighbours are not cached decodes
 * two of its frames, and counts two per track. */
typedef struct noh_clip_cache_stats {
    uint64_t samples;
    uint64_t misses; /* segments that a sample had to decode, partly or fully */
    uint64_t evictions;
    uint64_t decoded;      /* track-frames: each frame of each track of a segment counts as one */
    uint64_t decoded_late; /* track-frames that a sample had to wait for */
} noh_clip_cache_stats;

/* Exact size of a cache in bytes; 0 if the desc is invalid (see the error). */
size_t noh_clip_cache_size(const noh_clip_cache_desc *desc, noh_error *error);

/* Make a cache in memory[bytes], aligned to NOH_MEMORY_ALIGN.
 * errors  ARG a field of desc, or memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_clip_cache_init(void *memory, size_t bytes, const noh_clip_cache_desc *desc, noh_clip_cache **out,
                               noh_error *error);

/* Inputs of a cache's size, for clips that are measured but not open yet. Zero it, add each clip, then get the size. */
#define NOH_CLIP_CACHE_SIZES 120u
typedef struct noh_clip_cache_needs {
    uint32_t clip_count, segment_count;
    uint32_t size_segments[NOH_CLIP_CACHE_SIZES];      /* segments in each size class */
    uint32_t size_bytes[NOH_CLIP_CACHE_SIZES];         /* bytes of the largest segment in each class */
    uint8_t lengths[NOH_CLIP_SEGMENT_FRAMES_MAX + 1u]; /* bit b: some segment of transform b has this many frames */
} noh_clip_cache_needs;

void noh_clip_cache_needs_add(noh_clip_cache_needs *needs, const noh_clip_info *info);
size_t noh_clip_cache_needs_size(const noh_clip_cache_needs *needs, uint32_t cached_segment_count, noh_error *error);

/* Begin a frame of the game. Until the next call no request evicts a segment that this frame has requested or
 * sampled. */
void noh_clip_cache_begin_frame(noh_clip_cache *cache);

/* Request the first `joint_count` joints of the segment at a time. Decodes nothing.
 * units    ticks, clamped to the clip
 * returns  1 if the segment is cached or will be; 0 if there is no room because this frame uses every cached segment */
int noh_clip_cache_want(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count);

/* Request all segments from one frame of a clip to another, in that order: backwards if last < first. Frames are
 * clamped to the clip.
 * returns  the number of segments that found no room */
uint32_t noh_clip_cache_want_frames(noh_clip_cache *cache, uint32_t clip, uint32_t first, uint32_t last,
                                    uint32_t joint_count);

/* Decode requested segments, in the order of the requests, until `budget` track-frames are spent (the last track may
 * exceed it).
 * returns  the track-frames spent */
uint32_t noh_clip_cache_work(noh_clip_cache *cache, uint32_t budget);

/* Sample a pose. Between frames, translations, scales and floats are interpolated linearly; rotations linearly, then
 * normalised. At sample rates whose frames are not a whole number of ticks, rotations are taken at a time within
 * 1/65,000 of a frame of the requested one.
 * shapes  out[joint_count], floats[float_count of the clip] (NULL: not wanted)
 * ranges  clip below clip_count; joint_count up to the clip's: only these first joints are decoded and sampled */
void noh_clip_sample(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count, noh_transform *out,
                     float *floats);

/* Get the cache's own statistics; each view has its own. */
noh_clip_cache_stats noh_clip_cache_stats_of(const noh_clip_cache *cache);

/* Get the number of segments that it holds at the same time. */
uint32_t noh_clip_cache_capacity(const noh_clip_cache *cache);

/* Test whether every segment of every clip is decoded; nothing is evicted then, and requests are unnecessary.
 * Linear in the segments; stops at the first one that is missing. */
int noh_clip_cache_holds_all(const noh_clip_cache *cache);

/* Get the clip at an index of the desc. */
const noh_clip *noh_clip_cache_clip(const noh_clip_cache *cache, uint32_t clip);

#ifdef __cplusplus
}
#endif

#endif
