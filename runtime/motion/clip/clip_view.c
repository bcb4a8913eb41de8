#include "core/base/assert_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "motion/clip/clip_view_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#include <string.h>

/* A segment of the view's own. It is kept from sample to sample, so a clip that plays without being requested is
 * decoded once per segment, not once per sample. */
typedef struct spill {
    noh_clip_cursor cursor;
    uint8_t *frames;
    uint32_t clip;
    int used;
} spill;

struct noh_clip_view {
    const noh_clip_cache *cache;
    spill spills[2];
    uint32_t latest; /* index of the spill used last */
    noh_clip_cache_stats stats;
};

/* ---- memory ---- */

static void carve(noh_arena *arena, size_t segment_bytes, spill *spills)
{
    for (uint32_t i = 0; i < 2u; i++) {
        uint8_t *frames = noh_arena_carve(arena, segment_bytes, 16u);
        if (spills) spills[i].frames = frames;
    }
}

static size_t size_of(size_t segment_bytes)
{
    noh_arena arena = noh_arena_measure();
    (void)noh_arena_carve(&arena, sizeof(noh_clip_view), 16u);
    carve(&arena, segment_bytes, NULL);
    return arena.used;
}

size_t noh_clip_view_size(const noh_clip_cache *cache)
{
    return size_of(cache->segment_bytes);
}

size_t noh_clip_view_needs_size(const noh_clip_cache_needs *needs)
{
    uint32_t size = NOH_CLIP_CACHE_SIZES;
    while (size > 0u && !needs->size_bytes[size - 1u]) {
        size--;
    }
    return size_of(size ? needs->size_bytes[size - 1u] : 0u);
}

noh_result noh_clip_view_init(void *memory, size_t bytes, const noh_clip_cache *cache, noh_clip_view **out,
                              noh_error *error)
{
    noh_arena arena;
    noh_clip_view *view;
    const noh_result r = noh_arena_open(&arena, memory, bytes, noh_clip_view_size(cache), error);
    if (r) return r;
    view = noh_arena_carve(&arena, sizeof *view, 16u);
    if (view) { /* always: the arena has its size */
        memset(view, 0, sizeof *view);
        view->cache = cache;
        carve(&arena, cache->segment_bytes, view->spills);
    }
    *out = view;
    return NOH_OK;
}

/* ---- sampling ---- */

/* The spill that holds a segment, or the one to decode it into: not the one used last, which may be the first half of a
 * sample between two segments. */
static spill *find_spill(noh_clip_view *view, uint32_t clip, uint32_t segment)
{
    spill *s;
    for (uint32_t i = 0; i < 2u; i++) {
        s = &view->spills[i];
        if (s->used && s->clip == clip && s->cursor.segment == segment) {
            view->latest = i;
            return s;
        }
    }
    view->latest = 1u - view->latest;
    s = &view->spills[view->latest];
    s->used = 1;
    s->clip = clip;
    s->cursor = noh_clip_cursor_at(view->cache->clips[clip].clip, segment);
    return s;
}

/* The frames of a segment with at least `tracks` decoded: from the cache, or from the view. */
static const uint8_t *frames_of(noh_clip_view *view, uint32_t clip, uint32_t segment, uint32_t tracks)
{
    const noh_clip_cache *cache = view->cache;
    const uint32_t at = cache->cached_of[cache->clips[clip].first + segment];
    spill *s;
    if (at != NOH_CLIP_NOT_CACHED && cache->cached[at].cursor.track >= tracks) {
        return cache->cached[at].frames;
    }
    s = find_spill(view, clip, segment);
    if (s->cursor.track < tracks) {
        const uint32_t spent = noh_clip_decode_up_to(cache, cache->clips[clip].clip, &s->cursor, tracks, s->frames);
        view->stats.misses++;
        view->stats.decoded += spent;
        view->stats.decoded_late += spent;
    }
    return s->frames;
}

void noh_clip_view_sample(noh_clip_view *view, uint32_t clip, int64_t ticks, uint32_t joint_count, noh_transform *out,
                          float *floats)
{
    const noh_clip_place p = noh_clip_place_of(noh_clip_cache_clip(view->cache, clip), ticks, joint_count);
    const uint8_t *frames = frames_of(view, clip, p.segment, p.tracks);
    const uint8_t *next = p.crosses ? frames_of(view, clip, p.segment + 1u, p.tracks) : NULL;
    NOH_ASSERT(out || p.joints == 0u);
    view->stats.samples++;
    noh_clip_blend_place(&p, frames, next, out, floats);
}

noh_clip_cache_stats noh_clip_view_stats_of(const noh_clip_view *view)
{
    return view->stats;
}
