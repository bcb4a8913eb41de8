/* clip_cache_internal.h (private to clip/): data that a cache and its views share. */
#ifndef NOH_CLIP_CLIP_CACHE_INTERNAL_H
#define NOH_CLIP_CLIP_CACHE_INTERNAL_H

#include "motion/clip/clip_codec_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "motion/clip/clip_decode_internal.h"
#include "motion/clip/clip_sample_internal.h"
#include "noh/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Counts since init, to tune the cache size. A sample that jumps to a segment whose neighbours are not cached decodes
 * two of its frames, and counts two per track. */
typedef struct noh_clip_cache_stats {
    uint64_t samples;
    uint64_t misses; /* segments that a sample had to decode, partly or fully */
    uint64_t evictions;
    uint64_t decoded;      /* track-frames: each frame of each track of a segment counts as one */
    uint64_t decoded_late; /* track-frames that a sample had to wait for */
} noh_clip_cache_stats;

/* Get the cache's own statistics; each view has its own. */
noh_clip_cache_stats noh_clip_cache_stats_of(const noh_clip_cache *cache);

void noh_clip_cache_needs_add(noh_clip_cache_needs *needs, const noh_clip_info *info);
size_t noh_clip_cache_needs_size(const noh_clip_cache_needs *needs, uint32_t cached_segment_count, noh_error *error);

/* Request all segments from one frame of a clip to another, in that order: backwards if last < first. Frames are
 * clamped to the clip.
 * returns  the number of segments that found no room */
uint32_t noh_clip_cache_want_frames(noh_clip_cache *cache, uint32_t clip, uint32_t first, uint32_t last,
                                    uint32_t joint_count);

/* Test whether every segment of every clip is decoded; nothing is evicted then, and requests are unnecessary.
 * Linear in the segments; stops at the first one that is missing. */
int noh_clip_cache_holds_all(const noh_clip_cache *cache);

/* Forget what is decoded of a clip, and what was requested of it. */
void noh_clip_cache_forget(noh_clip_cache *cache, uint32_t clip);

/* Get the clip at an index of the desc. */
const noh_clip *noh_clip_cache_clip(const noh_clip_cache *cache, uint32_t clip);

#ifdef __cplusplus
}
#endif

#define NOH_CLIP_NOT_CACHED 0xffffu

/* The entries of one size, least recently touched first: a list through the entries' `older` and `newer`. */
typedef struct noh_clip_size_class {
    uint32_t bytes, count;
    uint16_t oldest, newest;
} noh_clip_size_class;

/* An entry of the cache: one cached segment, or room for one. */
typedef struct noh_cached_segment {
    noh_clip_cursor cursor;
    uint8_t *frames;
    uint32_t clip;
    uint32_t stamp;         /* the frame of the game that last touched it */
    uint32_t wanted;        /* decode up to this track */
    uint32_t glimpsed;      /* tracks decoded only at the frames not in `skipped`, besides the cursor's ... */
    uint32_t skipped;       /* ... as noh_clip_basis.skip */
    uint16_t older, newer;  /* in its size's list */
    uint16_t before, after; /* in the list of requests, while it is in it */
    uint8_t size;           /* index of its noh_clip_size_class */
    uint8_t used, waits;    /* 1: holds a segment; is in the list of requests */
} noh_cached_segment;

/* A clip of the cache. */
typedef struct noh_cached_clip {
    const noh_clip *clip;
    uint32_t first; /* index of its first segment in `cached_of` */
    uint32_t size;  /* index of the smallest noh_clip_size_class that fits its segments */
    uint32_t frame; /* the frame of the previous sample */
} noh_cached_clip;

struct noh_clip_cache {
    noh_cached_clip *clips;     /* [clip_count] */
    uint16_t *cached_of;        /* [segments of all clips] the entry that holds each, or NOH_CLIP_NOT_CACHED */
    noh_cached_segment *cached; /* [cached_count] */
    noh_clip_size_class *sizes; /* [size_count], largest first */
    uint32_t clip_count, cached_count, size_count;
    uint32_t segment_bytes; /* of the largest segment of any clip */
    uint32_t stamp;
    /* stats.samples at the start of this frame; samples of the previous frame */
    uint32_t samples_begun, samples_before;
    uint16_t first_want, last_want;
    noh_clip_cache_stats stats;
    /* by transform and by frames of a segment; only those that the clips use */
    const float *rows[NOH_CLIP_BASES][NOH_CLIP_SEGMENT_FRAMES_MAX + 1u];
};

/* The place of a sample in its clip. */
typedef struct noh_clip_place {
    const noh_clip *clip;
    uint32_t joints, tracks; /* joints to sample, and tracks to decode for them */
    uint32_t segment, frame; /* frame: in the segment */
    uint32_t slot, slots;    /* where it is decoded, and the number of slots in the segment */
    float fraction;          /* towards the next slot */
    int crosses;             /* 1: the next frame is the first of the next segment */
} noh_clip_place;

static inline noh_clip_place noh_clip_place_of(const noh_clip *clip, int64_t ticks, uint32_t joint_count)
{
    noh_clip_place p;
    const uint32_t frame = noh_clip_frame_at(clip, ticks, &p.fraction), halved = clip->info.halved;
    uint32_t frames;
    p.clip = clip;
    p.joints = joint_count < clip->info.joint_count ? joint_count : clip->info.joint_count;
    p.tracks = clip->prefixes[p.joints].tracks;
    p.segment = noh_clip_segment_of(clip, frame);
    p.frame = frame - noh_clip_segment_first(clip, p.segment);
    p.crosses = p.fraction > 0.0f && frame + 1u == noh_clip_segment_first(clip, p.segment + 1u);
    frames = noh_clip_segment_frames(clip, p.segment);
    p.slots = noh_clip_slots(frames, halved);
    p.slot = noh_clip_slot_of(p.frame, frames, halved);
    if (halved && p.slot + 1u < p.slots) {
        const uint32_t here = noh_clip_slot_frame(p.slot, frames, 1);
        p.fraction = ((float)(p.frame - here) + p.fraction) /
                     (float)(noh_clip_slot_frame(p.slot + 1u, frames, 1) - here);
    }
    return p;
}

/* Blend two slots. `next`: the frames of the next segment, read only if the place crosses into it. */
static inline void noh_clip_blend_place(const noh_clip_place *p, const uint8_t *frames, const uint8_t *next,
                                        noh_transform *out, float *floats)
{
    const uint8_t *a = frames + (size_t)p->slot * p->clip->frame_bytes;
    const uint8_t *b = p->crosses ? next : p->fraction > 0.0f ? a + p->clip->frame_bytes : a;
    noh_clip_blend_frames(p->clip, a, b, p->fraction, p->joints, out, floats);
}

static inline noh_clip_basis noh_clip_cache_basis(const noh_clip_cache *cache, const noh_clip *clip, uint32_t segment,
                                                  uint32_t skip)
{
    const uint32_t frames = noh_clip_segment_frames(clip, segment);
    const noh_clip_basis basis = { frames, noh_clip_basis_half(frames),
                                   cache->rows[noh_clip_basis_of(&clip->info)][frames], skip, clip->info.halved };
    return basis;
}

/* Decode a segment from its cursor up to a track. Returns the number of track-frames. */
static inline uint32_t noh_clip_decode_up_to(const noh_clip_cache *cache, const noh_clip *clip, noh_clip_cursor *cursor,
                                             uint32_t track_end, uint8_t *out)
{
    const noh_clip_basis basis = noh_clip_cache_basis(cache, clip, cursor->segment, 0);
    const uint32_t before = cursor->track;
    if (track_end > before) {
        noh_clip_decode(clip, &basis, cursor, track_end, out);
    }
    return (cursor->track - before) * noh_clip_slots(basis.frames, basis.halved);
}

#endif
