/* clip_view_internal.h: views of a clip cache. */
#ifndef NOH_CLIP_CLIP_VIEW_INTERNAL_H
#define NOH_CLIP_CLIP_VIEW_INTERNAL_H

#include "motion/clip/clip_cache_internal.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== views of a clip cache, for threads ========
 * Sampling one clip cache from several threads.
 *
 * A view only reads its cache. It decodes missing segments into two segments of its own: the same bits, counted as
 * late. So request and decode segments on one thread, then sample on many:
 *   noh_clip_cache_begin_frame, _want, _work   one thread
 *   noh_clip_view_sample(view, ...)            any number of threads, each with its own view
 * Begin the next frame after all of them have finished.
 *
 * Threads: a view belongs to one thread at a time. While views sample, nothing may change their cache (low_motion.h
 * lists the calls that do). There is no lock and no atomic; the caller orders the two phases (a join, a barrier, a job
 * counter). */

/* Exact size in bytes: the head, and two segments as large as the largest of the cache's clips. */
size_t noh_clip_view_size(const noh_clip_cache *cache);
size_t noh_clip_view_needs_size(const noh_clip_cache_needs *needs); /* before the cache is made */

/* Make a view in memory[bytes], aligned to NOH_MEMORY_ALIGN. The cache must outlive it.
 * errors  ARG memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_clip_view_init(void *memory, size_t bytes, const noh_clip_cache *cache, noh_clip_view **out,
                              noh_error *error);

/* Sample a pose; bit-identical to noh_clip_sample. */
void noh_clip_view_sample(noh_clip_view *view, uint32_t clip, int64_t ticks, uint32_t joint_count, noh_transform *out,
                          float *floats);

/* Get the view's own statistics (evictions stays 0). */
noh_clip_cache_stats noh_clip_view_stats_of(const noh_clip_view *view);

#ifdef __cplusplus
}
#endif

#endif
