/* clip_view_internal.h: the private part of low_motion.h. */
#ifndef NOH_CLIP_CLIP_VIEW_INTERNAL_H
#define NOH_CLIP_CLIP_VIEW_INTERNAL_H

#include "noh/clip.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the view's own statistics (evictions stays 0). */
noh_clip_cache_stats noh_clip_view_stats_of(const noh_clip_view *view);

#ifdef __cplusplus
}
#endif

#endif
