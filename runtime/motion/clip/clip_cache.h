/* low_motion.h: what the library keeps to itself of runtime/noh/low_motion.h. */
#ifndef NOH_CLIP_CLIP_CACHE_H
#define NOH_CLIP_CLIP_CACHE_H

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Most segments that a playing track needs when it looks ahead by up to one segment: its current segment, the next one,
 * and the previous one, used for root motion across their border. */
#define NOH_CLIP_CACHE_SEGMENTS_PER_TRACK 3u

void noh_clip_cache_needs_add(noh_clip_cache_needs *needs, const noh_clip_info *info);
size_t noh_clip_cache_needs_size(const noh_clip_cache_needs *needs, uint32_t cached_segment_count, noh_error *error);

/* Request all segments from one frame of a clip to another, in that order: backwards if last < first. Frames are
 * clamped to the clip.
 * returns  the number of segments that found no room */
uint32_t noh_clip_cache_want_frames(noh_clip_cache *cache, uint32_t clip, uint32_t first, uint32_t last,
                                    uint32_t joint_count);

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
