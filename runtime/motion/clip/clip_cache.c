#include "core/base/assert_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "motion/clip/clip_codec_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#include <string.h>

typedef noh_cached_segment cached;

#define SEGMENT_BYTES_MIN 16u
#define GLIMPSE_FRAMES 16u      /* segments up to this length are always decoded whole */
#define PLAY_FRAMES 8u          /* samples at most this far apart count as steady play */
#define SEGMENTS_MAX (1u << 28) /* over all clips of a cache: their table fits in 32 bits of bytes */

/* ---- sizes ---- */

/* The size class of a number of bytes: its highest three bits and their position, so four classes per doubling. Entries
 * of a class are as large as its largest segment, so at most a fifth of an entry is wasted. */
static uint32_t size_class(size_t bytes)
{
    uint32_t shift = 0;
    while (bytes >> shift > 7u) {
        shift++;
    }
    return 4u * shift + ((uint32_t)(bytes >> shift) & 3u);
}

static uint32_t entry_bytes(const noh_clip_info *info)
{
    const uint32_t bytes = (uint32_t)info->segment_bytes_max;
    return bytes > SEGMENT_BYTES_MIN ? bytes : SEGMENT_BYTES_MIN;
}

void noh_clip_cache_needs_add(noh_clip_cache_needs *needs, const noh_clip_info *info)
{
    const uint32_t bytes = entry_bytes(info), size = size_class(bytes);
    const uint8_t basis = (uint8_t)(1u << noh_clip_basis_of(info));
    NOH_ASSERT(size < NOH_CLIP_CACHE_SIZES);
    needs->clip_count++;
    if (info->segment_count == 0 || info->segment_count > SEGMENTS_MAX - needs->segment_count) {
        needs->segment_count = SEGMENTS_MAX; /* rejected later */
        return;
    }
    needs->segment_count += info->segment_count;
    needs->size_segments[size] += info->segment_count;
    if (bytes > needs->size_bytes[size]) needs->size_bytes[size] = bytes;
    needs->lengths[info->segment_frames_max] |= basis; /* segments of a clip have one or two lengths */
    needs->lengths[info->frame_count / info->segment_count] |= basis;
}

/* The number of entries, of `left`, for a class; classes are asked from the largest down. */
static uint32_t share_of(const noh_clip_cache_needs *needs, uint32_t size, uint32_t left)
{
    return needs->size_segments[size] < left ? needs->size_segments[size] : left;
}

static uint32_t capacity_of(const noh_clip_cache_needs *needs, uint32_t cached_segment_count)
{
    const uint32_t count = cached_segment_count ? cached_segment_count
                                                : NOH_CLIP_CACHE_SEGMENTS_PER_TRACK * needs->clip_count;
    return count < needs->segment_count ? count : needs->segment_count;
}

static noh_result check_counts(const noh_clip_cache_needs *needs, uint32_t cached_segment_count, noh_error *error)
{
    if (needs->clip_count == 0u || needs->clip_count > NOH_CLIP_CACHE_CLIPS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "clip_count of a clip cache must be 1 to NOH_CLIP_CACHE_CLIPS_MAX", 0,
                        needs->clip_count);
    }
    if (needs->segment_count >= SEGMENTS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "the clips of a clip cache have too many segments", 0,
                        needs->segment_count);
    }
    if (cached_segment_count == 1u) {
        return noh_fail(error, NOH_ERR_ARG,
                        "cached_segment_count of a clip cache must be at least 2: a pose can need two segments", 0,
                        NOH_CLIP_CACHE_SEGMENTS_MIN);
    }
    if (capacity_of(needs, cached_segment_count) > NOH_CLIP_CACHE_SEGMENTS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "cached_segment_count of a clip cache is above NOH_CLIP_CACHE_SEGMENTS_MAX",
                        0, NOH_CLIP_CACHE_SEGMENTS_MAX);
    }
    return NOH_OK;
}

static noh_result needs_of(const noh_clip_cache_desc *desc, noh_clip_cache_needs *needs, noh_error *error)
{
    memset(needs, 0, sizeof *needs);
    if (!desc->clips || desc->clip_count > NOH_CLIP_CACHE_CLIPS_MAX) {
        return noh_fail(error, NOH_ERR_ARG,
                        desc->clips ? "clip_count of a clip cache is above NOH_CLIP_CACHE_CLIPS_MAX"
                                    : "clips of a clip cache is NULL",
                        0, NOH_CLIP_CACHE_CLIPS_MAX);
    }
    for (uint32_t i = 0; i < desc->clip_count; i++) {
        if (!desc->clips[i]) return noh_fail(error, NOH_ERR_ARG, "a clip of a clip cache is NULL", i, 0);
        noh_clip_cache_needs_add(needs, &desc->clips[i]->info);
    }
    return check_counts(needs, desc->cached_segment_count, error);
}

/* ---- memory ---- */

/* Carve the transform of each segment length in use, shared by all clips. */
static void carve_bases(noh_arena *arena, const noh_clip_cache_needs *needs, noh_clip_cache *cache, int build)
{
    for (uint32_t i = 0; i < NOH_CLIP_BASES * NOH_CLIP_SEGMENT_FRAMES_MAX; i++) {
        const uint32_t n = i / NOH_CLIP_BASES + 1u, basis = i % NOH_CLIP_BASES;
        float *rows;
        if (!(needs->lengths[n] >> basis & 1u)) continue;
        rows = noh_arena_carve(arena, noh_clip_basis_count(n) * sizeof *rows, 16u);
        if (rows && build) {
            noh_clip_basis_build(n, basis, rows);
            cache->rows[basis][n] = rows;
        }
    }
}

/* Carve the frames of all entries: the largest class first, the entries of a class in a row. */
static void carve_frames(noh_arena *arena, const noh_clip_cache_needs *needs, noh_clip_cache *cache, int build)
{
    uint32_t made = 0;
    for (uint32_t size = NOH_CLIP_CACHE_SIZES; size-- > 0u;) {
        const uint32_t count = share_of(needs, size, cache->cached_count - made), bytes = needs->size_bytes[size];
        for (uint32_t i = 0; i < count; i++) {
            uint8_t *frames = noh_arena_carve(arena, bytes, 16u);
            if (build) {
                cache->cached[made + i].frames = frames;
                cache->cached[made + i].size = (uint8_t)cache->size_count;
            }
        }
        if (count && build) {
            cache->sizes[cache->size_count].bytes = bytes;
            cache->sizes[cache->size_count].count = count;
            cache->size_count++;
        }
        made += count;
    }
}

static uint32_t count_sizes(const noh_clip_cache_needs *needs, uint32_t cached_segment_count)
{
    uint32_t count = 0;
    for (uint32_t size = NOH_CLIP_CACHE_SIZES; size-- > 0u && cached_segment_count;) {
        const uint32_t share = share_of(needs, size, cached_segment_count);
        count += share != 0u;
        cached_segment_count -= share;
    }
    return count;
}

static void carve(noh_arena *arena, const noh_clip_cache_needs *needs, uint32_t cached_segment_count,
                  noh_clip_cache *cache, int build)
{
    cache->clip_count = needs->clip_count;
    cache->cached_count = capacity_of(needs, cached_segment_count);
    carve_bases(arena, needs, cache, build);
    cache->clips = noh_arena_carve(arena, cache->clip_count * sizeof *cache->clips, 8u);
    cache->cached = noh_arena_carve(arena, cache->cached_count * sizeof *cache->cached, 8u);
    cache->sizes = noh_arena_carve(arena, count_sizes(needs, cache->cached_count) * sizeof *cache->sizes, 4u);
    cache->cached_of = noh_arena_carve(arena, needs->segment_count * sizeof *cache->cached_of, 2u);
    if (build) {
        memset(cache->cached, 0, cache->cached_count * sizeof *cache->cached);
        cache->size_count = 0;
    }
    carve_frames(arena, needs, cache, build);
}

size_t noh_clip_cache_needs_size(const noh_clip_cache_needs *needs, uint32_t cached_segment_count, noh_error *error)
{
    noh_clip_cache measured;
    noh_arena arena = noh_arena_measure();
    if (check_counts(needs, cached_segment_count, error) != NOH_OK) return 0;
    (void)noh_arena_carve(&arena, sizeof measured, 16u);
    carve(&arena, needs, cached_segment_count, &measured, 0);
    return arena.used;
}

size_t noh_clip_cache_size(const noh_clip_cache_desc *desc, noh_error *error)
{
    noh_clip_cache_needs needs;
    return needs_of(desc, &needs, error) ? 0u : noh_clip_cache_needs_size(&needs, desc->cached_segment_count, error);
}

/* Link the entries of each size, in order; all are free. */
static void link_all(noh_clip_cache *cache)
{
    uint32_t first = 0;
    for (uint32_t k = 0; k < cache->size_count; k++) {
        noh_clip_size_class *size = &cache->sizes[k];
        const uint32_t end = first + size->count;
        size->oldest = (uint16_t)first;
        size->newest = (uint16_t)(end - 1u);
        for (uint32_t s = first; s < end; s++) {
            cache->cached[s].older = (uint16_t)(s > first ? s - 1u : NOH_CLIP_NOT_CACHED);
            cache->cached[s].newer = (uint16_t)(s + 1u < end ? s + 1u : NOH_CLIP_NOT_CACHED);
        }
        first = end;
    }
}

static void add_clips(const noh_clip_cache_desc *desc, noh_clip_cache *cache)
{
    uint32_t segments = 0;
    for (uint32_t i = 0; i < desc->clip_count; i++) {
        noh_cached_clip *e = &cache->clips[i];
        const uint32_t bytes = entry_bytes(&desc->clips[i]->info);
        e->clip = desc->clips[i];
        e->frame = 0;
        e->first = segments;
        e->size = cache->size_count - 1u;
        while (cache->sizes[e->size].bytes < bytes) {
            e->size--; /* terminates: the class of the largest segment always exists */
        }
        segments += desc->clips[i]->info.segment_count;
        cache->segment_bytes = bytes > cache->segment_bytes ? bytes : cache->segment_bytes;
    }
    memset(cache->cached_of, 0xff, segments * sizeof *cache->cached_of);
}

noh_result noh_clip_cache_init(void *memory, size_t bytes, const noh_clip_cache_desc *desc, noh_clip_cache **out,
                               noh_error *error)
{
    noh_arena arena;
    noh_clip_cache_needs needs;
    noh_clip_cache *cache;
    noh_result r = needs_of(desc, &needs, error);
    if (!r)
        r = noh_arena_open(&arena, memory, bytes, noh_clip_cache_needs_size(&needs, desc->cached_segment_count, NULL),
                           error);
    if (r) return r;
    cache = noh_arena_carve(&arena, sizeof *cache, 16u);
    memset(cache, 0, sizeof *cache);
    carve(&arena, &needs, desc->cached_segment_count, cache, 1);
    link_all(cache);
    add_clips(desc, cache);
    cache->first_want = cache->last_want = NOH_CLIP_NOT_CACHED;
    cache->stamp = 1;
    *out = cache;
    return NOH_OK;
}

/* ---- the list of wants: entries with something to decode, in the order of asking ---- */

static void add_want(noh_clip_cache *cache, uint32_t s)
{
    cached *t = &cache->cached[s];
    t->waits = 1;
    t->before = cache->last_want;
    t->after = NOH_CLIP_NOT_CACHED;
    if (cache->last_want == NOH_CLIP_NOT_CACHED) {
        cache->first_want = (uint16_t)s;
    } else {
        cache->cached[cache->last_want].after = (uint16_t)s;
    }
    cache->last_want = (uint16_t)s;
}

static void drop_want(noh_clip_cache *cache, uint32_t s)
{
    cached *t = &cache->cached[s];
    if (!t->waits) return;
    t->waits = 0;
    if (t->before == NOH_CLIP_NOT_CACHED) {
        cache->first_want = t->after;
    } else {
        cache->cached[t->before].after = t->after;
    }
    if (t->after == NOH_CLIP_NOT_CACHED) {
        cache->last_want = t->before;
    } else {
        cache->cached[t->after].before = t->before;
    }
}

/* ---- entries ---- */

/* Move an entry to the end of its size's list, at most once per frame of the game: entries touched in one frame are
 * equally recent. */
static void touch(noh_clip_cache *cache, uint32_t s)
{
    cached *t = &cache->cached[s];
    noh_clip_size_class *size = &cache->sizes[t->size];
    if (t->stamp == cache->stamp) return;
    t->stamp = cache->stamp;
    if (size->newest == s) return;
    if (t->older == NOH_CLIP_NOT_CACHED) {
        size->oldest = t->newer;
    } else {
        cache->cached[t->older].newer = t->newer;
    }
    cache->cached[t->newer].older = t->older;
    cache->cached[size->newest].newer = (uint16_t)s;
    t->older = size->newest;
    t->newer = NOH_CLIP_NOT_CACHED;
    size->newest = (uint16_t)s;
}

/* The entry to use for a clip's segment, except `keep`: free or least recently touched, of the smallest sufficient size
 * that has one not touched in this frame. If all were touched: none, or with `must` the oldest that fits. */
static uint32_t find_room(const noh_clip_cache *cache, uint32_t clip, uint32_t keep, int must)
{
    uint32_t any = NOH_CLIP_NOT_CACHED;
    for (uint32_t k = cache->clips[clip].size + 1u; k-- > 0u;) {
        uint32_t s = cache->sizes[k].oldest;
        if (s == keep) s = cache->cached[s].newer;
        if (s == NOH_CLIP_NOT_CACHED) continue;
        if (!cache->cached[s].used || cache->cached[s].stamp != cache->stamp) return s;
        if (any == NOH_CLIP_NOT_CACHED) any = s;
    }
    return must ? any : NOH_CLIP_NOT_CACHED;
}

/* Assign an entry to a segment, evicting its old one. */
static void take(noh_clip_cache *cache, uint32_t s, uint32_t clip, uint32_t segment)
{
    cached *t = &cache->cached[s];
    const noh_cached_clip *e = &cache->clips[clip];
    if (t->used) {
        cache->cached_of[cache->clips[t->clip].first + t->cursor.segment] = NOH_CLIP_NOT_CACHED;
        cache->stats.evictions++;
        drop_want(cache, s);
    }
    t->used = 1;
    t->clip = clip;
    t->cursor = noh_clip_cursor_at(e->clip, segment);
    t->wanted = t->glimpsed = 0;
    t->stamp = cache->stamp - 1u; /* so that touch() moves it, even if it was evicted in the frame that touched it */
    cache->cached_of[e->first + segment] = (uint16_t)s;
}

void noh_clip_cache_forget(noh_clip_cache *cache, uint32_t clip)
{
    for (uint32_t s = 0; s < cache->cached_count; s++) {
        cached *t = &cache->cached[s];
        if (!t->used || t->clip != clip) continue;
        cache->cached_of[cache->clips[clip].first + t->cursor.segment] = NOH_CLIP_NOT_CACHED;
        drop_want(cache, s);
        t->used = 0;
    }
}

static uint32_t decode_cached(noh_clip_cache *cache, uint32_t s, uint32_t track_end)
{
    cached *t = &cache->cached[s];
    return noh_clip_decode_up_to(cache, cache->clips[t->clip].clip, &t->cursor, track_end, t->frames);
}

/* Whether a clip's segment is decoded whole, up to a track. */
static int is_whole(const noh_clip_cache *cache, uint32_t clip, uint32_t segment, uint32_t tracks)
{
    const noh_cached_clip *e = &cache->clips[clip];
    const uint32_t s = segment < e->clip->info.segment_count ? cache->cached_of[e->first + segment]
                                                             : NOH_CLIP_NOT_CACHED;
    return s != NOH_CLIP_NOT_CACHED && cache->cached[s].cursor.track >= tracks;
}

/* Decode an entry up to a track, either whole or only at the frames of `quads` (bits from noh_clip_quad_bit).
 *
 * A jump needs two frames, and the next sample may be elsewhere. So for an unrequested segment without cached
 * neighbours, only the frames around these two are summed. Its bits must still be read, and again when the rest is
 * needed: play that continues after a jump decodes the segment twice. */
static void decode_late(noh_clip_cache *cache, uint32_t s, uint32_t tracks, uint32_t quads)
{
    cached *t = &cache->cached[s];
    const noh_clip *clip = cache->clips[t->clip].clip;
    const uint32_t segment = t->cursor.segment;
    noh_clip_basis basis = noh_clip_cache_basis(cache, clip, segment, ~quads);
    uint32_t spent;
    if (t->glimpsed || t->wanted || t->cursor.track > 0u || basis.frames <= GLIMPSE_FRAMES ||
        is_whole(cache, t->clip, segment - 1u, tracks) || is_whole(cache, t->clip, segment + 1u, tracks)) {
        spent = decode_cached(cache, s, tracks);
    } else {
        noh_clip_cursor cursor = t->cursor;
        noh_clip_decode(clip, &basis, &cursor, tracks, t->frames);
        t->glimpsed = tracks;
        t->skipped = ~quads;
        spent = tracks * 2u;
    }
    cache->stats.misses++;
    cache->stats.decoded += spent;
    cache->stats.decoded_late += spent;
}

/* The entry of a segment, decoded for at least `tracks` at the frames of `quads`. A clip's second segment always finds
 * room next to its first (`keep`): a size class with a single entry either has a single segment, or is the last class
 * that got any, and then a larger entry exists, because a cache of several segments has at least two. */
static uint32_t ready(noh_clip_cache *cache, uint32_t clip, uint32_t segment, uint32_t tracks, uint32_t quads,
                      uint32_t keep)
{
    const cached *t;
    uint32_t s = cache->cached_of[cache->clips[clip].first + segment];
    if (s == NOH_CLIP_NOT_CACHED) {
        s = find_room(cache, clip, keep, 1);
        NOH_ASSERT(s != NOH_CLIP_NOT_CACHED);
        take(cache, s, clip, segment);
    }
    touch(cache, s);
    t = &cache->cached[s];
    if (t->cursor.track < tracks && (t->glimpsed < tracks || t->skipped & quads)) decode_late(cache, s, tracks, quads);
    return s;
}

/* The segment that steady play without requests reaches next, and the number of samples until then; NOH_CLIP_NOT_CACHED
 * if the clip does not play steadily: its last sample was more than PLAY_FRAMES away, or in the same frame. */
static uint32_t next_segment(const noh_clip *clip, const noh_clip_place *p, uint32_t before, uint32_t *samples)
{
    const uint32_t first = noh_clip_segment_first(clip, p->segment), frame = first + p->frame;
    const uint32_t step = frame > before ? frame - before : before - frame;
    if (step == 0u || step > PLAY_FRAMES) return NOH_CLIP_NOT_CACHED;
    if (frame < before) {
        *samples = p->frame / step + 1u;
        return p->segment ? p->segment - 1u : NOH_CLIP_NOT_CACHED;
    }
    *samples = (noh_clip_segment_first(clip, p->segment + 1u) - 1u - frame) / step + 1u;
    if (p->segment + 1u < clip->info.segment_count) return p->segment + 1u;
    return clip->info.flags & NOH_CLIP_FLAG_LOOP ? 0u : NOH_CLIP_NOT_CACHED;
}

/* An entry for an unrequested segment: never one touched in this frame or the previous one, because other playing clips
 * will return to it. None if there is no room for two segments of everything that plays: each clip that moves on to its
 * next segment would evict one in use. */
static uint32_t find_spare(const noh_clip_cache *cache, uint32_t clip, uint32_t keep)
{
    uint32_t s;
    if (cache->samples_before > cache->cached_count / 2u) return NOH_CLIP_NOT_CACHED;
    s = find_room(cache, clip, keep, 0);
    if (s == NOH_CLIP_NOT_CACHED || !cache->cached[s].used) return s;
    return cache->stamp - cache->cached[s].stamp > 1u ? s : NOH_CLIP_NOT_CACHED;
}

/* Decode a share of the next segment if nothing requests it, spread evenly over the samples until it is needed; without
 * this it would be decoded late, all at once. */
static void decode_ahead(noh_clip_cache *cache, uint32_t clip, const noh_clip_place *p, uint32_t here)
{
    noh_cached_clip *e = &cache->clips[clip];
    const uint32_t before = e->frame;
    uint32_t samples = 1, segment, s, done;
    e->frame = noh_clip_segment_first(e->clip, p->segment) + p->frame;
    if (cache->cached[here].wanted) return;
    segment = next_segment(e->clip, p, before, &samples);
    if (segment == NOH_CLIP_NOT_CACHED || segment == p->segment) return;
    s = cache->cached_of[e->first + segment];
    if (s == NOH_CLIP_NOT_CACHED) {
        s = find_spare(cache, clip, here);
        if (s == NOH_CLIP_NOT_CACHED) return;
        take(cache, s, clip, segment);
    }
    touch(cache, s);
    done = cache->cached[s].cursor.track;
    if (done < p->tracks)
        cache->stats.decoded += decode_cached(cache, s, done + (p->tracks - done + samples - 1u) / samples);
}

#if NOH_ASSERT_LEVEL >= 2
/* Each size's list contains each of its entries once; `cached_of` and the entries agree; every waiting entry is in the
 * list of requests. */
static int is_sound(const noh_clip_cache *cache)
{
    uint32_t first = 0, listed = 0, waiting = 0;
    for (uint32_t k = 0; k < cache->size_count; k++) {
        uint32_t count = 0, before = NOH_CLIP_NOT_CACHED;
        for (uint32_t s = cache->sizes[k].oldest; s != NOH_CLIP_NOT_CACHED && count <= cache->sizes[k].count;
             s = cache->cached[s].newer, count++) {
            if (cache->cached[s].older != before || cache->cached[s].size != k || s < first ||
                s - first >= cache->sizes[k].count)
                return 0;
            before = s;
        }
        if (count != cache->sizes[k].count || before != cache->sizes[k].newest) return 0;
        first += count;
    }
    for (uint32_t s = cache->first_want; s != NOH_CLIP_NOT_CACHED && listed <= cache->cached_count;
         s = cache->cached[s].after) {
        listed++;
    }
    for (uint32_t s = 0; s < cache->cached_count; s++) {
        const cached *t = &cache->cached[s];
        waiting += t->waits;
        if (!t->used) continue;
        if (cache->cached_of[cache->clips[t->clip].first + t->cursor.segment] != s) return 0;
        if (!t->waits && t->cursor.track < t->wanted) return 0;
    }
    return listed == waiting;
}
#endif

/* ---- what the game calls ---- */

void noh_clip_cache_begin_frame(noh_clip_cache *cache)
{
    NOH_VALIDATE(is_sound(cache));
    cache->stamp++;
    cache->samples_before = (uint32_t)cache->stats.samples - cache->samples_begun;
    cache->samples_begun = (uint32_t)cache->stats.samples;
}

/* Assign an entry to a segment, store the track up to which it is requested, and queue it if anything must be
 * decoded. */
static int want_segment(noh_clip_cache *cache, uint32_t clip, uint32_t segment, uint32_t tracks)
{
    NOH_ASSERT(tracks <= cache->clips[clip].clip->info.track_count);
    uint32_t s = cache->cached_of[cache->clips[clip].first + segment];
    if (s == NOH_CLIP_NOT_CACHED) {
        s = find_room(cache, clip, NOH_CLIP_NOT_CACHED, 0);
        if (s == NOH_CLIP_NOT_CACHED) return 0;
        take(cache, s, clip, segment);
    }
    touch(cache, s);
    if (cache->cached[s].wanted < tracks) {
        cache->cached[s].wanted = tracks;
        if (!cache->cached[s].waits && cache->cached[s].cursor.track < tracks) add_want(cache, s);
    }
    return 1;
}

static uint32_t tracks_of(const noh_clip *c, uint32_t joint_count)
{
    return c->prefixes[joint_count < c->info.joint_count ? joint_count : c->info.joint_count].tracks;
}

static uint32_t segment_of(const noh_clip *c, uint32_t frame)
{
    return noh_clip_segment_of(c, frame < c->info.frame_count ? frame : c->info.frame_count - 1u);
}

int noh_clip_cache_want(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count)
{
    const noh_clip *c = noh_clip_cache_clip(cache, clip);
    float fraction;
    return want_segment(cache, clip, segment_of(c, noh_clip_frame_at(c, ticks, &fraction)), tracks_of(c, joint_count));
}

uint32_t noh_clip_cache_want_frames(noh_clip_cache *cache, uint32_t clip, uint32_t first, uint32_t last,
                                    uint32_t joint_count)
{
    const noh_clip *c = noh_clip_cache_clip(cache, clip);
    const uint32_t tracks = tracks_of(c, joint_count), end = segment_of(c, last);
    uint32_t segment = segment_of(c, first), missing = 0;
    for (;;) {
        missing += !want_segment(cache, clip, segment, tracks);
        if (segment == end) return missing;
        segment = segment < end ? segment + 1u : segment - 1u;
    }
}

/* Requests are served in order, one track at a time. If the budget ends within a segment its cursor stays, and the next
 * call continues there. */
uint32_t noh_clip_cache_work(noh_clip_cache *cache, uint32_t budget)
{
    uint32_t spent = 0;
    while (cache->first_want != NOH_CLIP_NOT_CACHED && spent < budget) {
        const uint32_t s = cache->first_want;
        const cached *t = &cache->cached[s];
        while (t->cursor.track < t->wanted && spent < budget) {
            spent += decode_cached(cache, s, t->cursor.track + 1u);
        }
        if (t->cursor.track >= t->wanted) drop_want(cache, s);
    }
    cache->stats.decoded += spent;
    return spent;
}

/* The slots that a sample needs of its first segment, as noh_clip_quad_bit. Of a next segment it needs the first. */
static uint32_t quads_of(const noh_clip_place *p)
{
    const uint32_t here = noh_clip_quad_bit(p->slot, p->slots);
    return p->crosses || p->fraction == 0.0f ? here : here | noh_clip_quad_bit(p->slot + 1u, p->slots);
}

void noh_clip_sample(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count, noh_transform *out,
                     float *floats)
{
    const noh_clip_place p = noh_clip_place_of(noh_clip_cache_clip(cache, clip), ticks, joint_count);
    NOH_ASSERT(out || p.joints == 0u);
    const uint32_t s = ready(cache, clip, p.segment, p.tracks, quads_of(&p), NOH_CLIP_NOT_CACHED);
    const uint8_t *next = p.crosses ? cache->cached[ready(cache, clip, p.segment + 1u, p.tracks, 1u, s)].frames : NULL;
    cache->stats.samples++;
    noh_clip_blend_place(&p, cache->cached[s].frames, next, out, floats);
    decode_ahead(cache, clip, &p, s);
}

noh_clip_cache_stats noh_clip_cache_stats_of(const noh_clip_cache *cache)
{
    return cache->stats;
}

int noh_clip_cache_holds_all(const noh_clip_cache *cache)
{
    for (uint32_t i = 0; i < cache->clip_count; i++) {
        const noh_cached_clip *e = &cache->clips[i];
        for (uint32_t segment = 0; segment < e->clip->info.segment_count; segment++) {
            const uint32_t s = cache->cached_of[e->first + segment];
            if (s == NOH_CLIP_NOT_CACHED || cache->cached[s].cursor.track < e->clip->info.track_count) return 0;
        }
    }
    return 1;
}

const noh_clip *noh_clip_cache_clip(const noh_clip_cache *cache, uint32_t clip)
{
    NOH_ASSERT(clip < cache->clip_count);
    return cache->clips[clip].clip;
}
