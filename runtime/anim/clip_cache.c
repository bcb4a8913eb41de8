#include "anim/clip_cache.h"

#include <string.h>

#include "base/arena.h"
#include "anim/clip_decode.h"
#include "anim/clip_sample.h"

#define NO_SLOT 0xffffu

typedef struct slot {
    noh_clip_cursor cursor;
    uint32_t clip;
    uint32_t stamp;      /* of the last touch */
    uint32_t wanted;     /* tracks to decode up to */
    uint32_t order;      /* of the want: older ones are decoded first */
    uint8_t used;
} slot;

typedef struct entry {
    const noh_clip *clip;
    uint32_t first;      /* of its segments in `slot_of` */
} entry;

struct noh_clip_cache {
    entry *entries;      /* [clip_count] */
    uint16_t *slot_of;   /* [segments of all clips] */
    slot *slots;         /* [slot_count] */
    uint8_t *frames;     /* [slot_count][slot_bytes] */
    size_t slot_bytes;
    uint32_t clip_count, slot_count;
    uint32_t stamp, order;
    uint32_t pending;    /* slots that may have something to decode */
    noh_clip_cache_stats stats;
    noh_clip_basis bases[NOH_CLIP_SEGMENT_FRAMES_MAX + 1u];
};

/* ---- memory ---- */

static uint32_t slots_of(uint32_t slot_count, uint32_t clip_count)
{
    const uint32_t count = slot_count ? slot_count : 2u * clip_count;
    return count < NOH_CLIP_CACHE_SLOTS_MIN ? NOH_CLIP_CACHE_SLOTS_MIN : count;
}

static noh_result check_counts(uint32_t clip_count, uint32_t slot_count, noh_error *error)
{
    if (clip_count == 0u || clip_count > NOH_CLIP_CACHE_CLIPS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "clips of a clip cache", 0, clip_count);
    }
    if (slot_count == 1u || slots_of(slot_count, clip_count) > NOH_CLIP_CACHE_SLOTS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "slots of a clip cache", 0, NOH_CLIP_CACHE_SLOTS_MIN);
    }
    return NOH_OK;
}

static noh_result check_desc(const noh_clip_cache_desc *desc, noh_error *error)
{
    const noh_result r = check_counts(desc->clips ? desc->clip_count : 0u, desc->slot_count, error);
    for (uint32_t i = 0; r == NOH_OK && i < desc->clip_count; i++) {
        if (!desc->clips[i]) return noh_fail(error, NOH_ERR_ARG, "clips of a clip cache", i, 0);
    }
    return r;
}

void noh_clip_cache_needs_add(noh_clip_cache_needs *needs, const noh_clip_info *info)
{
    needs->clip_count++;
    needs->segment_count += info->segment_count;
    if (info->segment_bytes_max > needs->segment_bytes) needs->segment_bytes = info->segment_bytes_max;
    needs->lengths[info->segment_frames_max] = 1; /* segments of a clip have one or two lengths */
    needs->lengths[info->frame_count / info->segment_count] = 1;
}

static noh_clip_cache_needs needs_of(const noh_clip_cache_desc *desc)
{
    noh_clip_cache_needs needs;
    memset(&needs, 0, sizeof needs);
    for (uint32_t i = 0; i < desc->clip_count; i++) {
        noh_clip_cache_needs_add(&needs, &desc->clips[i]->info);
    }
    return needs;
}

static void carve_bases(noh_arena *arena, const noh_clip_cache_needs *needs, noh_clip_basis *bases)
{
    for (uint32_t n = 1; n <= NOH_CLIP_SEGMENT_FRAMES_MAX; n++) {
        float *rows;
        if (!needs->lengths[n]) continue;
        rows = noh_arena_carve(arena, noh_clip_basis_count(n) * sizeof *rows, 16u);
        if (rows && bases) {
            noh_clip_basis_build(n, rows);
            bases[n].frames = n;
            bases[n].half = noh_clip_basis_half(n);
            bases[n].rows = rows;
        }
    }
}

static void carve(noh_arena *arena, const noh_clip_cache_needs *needs, uint32_t slot_count, noh_clip_cache *cache, int build)
{
    cache->clip_count = needs->clip_count;
    cache->slot_count = slots_of(slot_count, needs->clip_count);
    cache->slot_bytes = needs->segment_bytes > 16u ? needs->segment_bytes : 16u;
    cache->frames = noh_arena_carve(arena, cache->slot_bytes * cache->slot_count, 16u);
    carve_bases(arena, needs, build ? cache->bases : NULL);
    cache->entries = noh_arena_carve(arena, cache->clip_count * sizeof *cache->entries, 8u);
    cache->slots = noh_arena_carve(arena, cache->slot_count * sizeof *cache->slots, 8u);
    cache->slot_of = noh_arena_carve(arena, needs->segment_count * sizeof *cache->slot_of, 2u);
}

size_t noh_clip_cache_needs_size(const noh_clip_cache_needs *needs, uint32_t slot_count, noh_error *error)
{
    noh_clip_cache measured;
    noh_arena arena = noh_arena_measure();
    if (check_counts(needs->clip_count, slot_count, error) != NOH_OK) return 0;
    (void)noh_arena_carve(&arena, sizeof measured, 16u);
    carve(&arena, needs, slot_count, &measured, 0);
    return arena.used;
}

size_t noh_clip_cache_size(const noh_clip_cache_desc *desc, noh_error *error)
{
    noh_clip_cache_needs needs;
    if (check_desc(desc, error) != NOH_OK) return 0;
    needs = needs_of(desc);
    return noh_clip_cache_needs_size(&needs, desc->slot_count, error);
}

noh_result noh_clip_cache_init(void *memory, size_t bytes, const noh_clip_cache_desc *desc, noh_clip_cache **out, noh_error *error)
{
    noh_arena arena = noh_arena_over(memory, bytes);
    noh_clip_cache_needs needs;
    noh_clip_cache *cache;
    uint32_t segments = 0;
    size_t need;
    const noh_result r = check_desc(desc, error);
    if (r != NOH_OK) return r;
    needs = needs_of(desc);
    need = noh_clip_cache_needs_size(&needs, desc->slot_count, error);
    if (bytes < need || !memory) return noh_fail(error, NOH_ERR_MEMORY, "memory of a clip cache", 0, need);
    cache = noh_arena_carve(&arena, sizeof *cache, 16u);
    memset(cache, 0, sizeof *cache);
    carve(&arena, &needs, desc->slot_count, cache, 1);
    memset(cache->slots, 0, cache->slot_count * sizeof *cache->slots);
    for (uint32_t i = 0; i < desc->clip_count; i++) {
        cache->entries[i].clip = desc->clips[i];
        cache->entries[i].first = segments;
        segments += desc->clips[i]->info.segment_count;
    }
    memset(cache->slot_of, 0xff, segments * sizeof *cache->slot_of);
    cache->stamp = 1;
    *out = cache;
    return NOH_OK;
}

/* ---- slots ---- */

static uint8_t *slot_frames(const noh_clip_cache *cache, uint32_t s)
{
    return cache->frames + cache->slot_bytes * s;
}

/* The slot to give up: a free one, else the one touched longest ago, but not `keep`. */
static uint32_t oldest_slot(const noh_clip_cache *cache, uint32_t keep)
{
    uint32_t best = NO_SLOT, best_age = 0;
    for (uint32_t s = 0; s < cache->slot_count; s++) {
        const uint32_t age = cache->slots[s].used ? cache->stamp - cache->slots[s].stamp : 0xffffffffu;
        if (s != keep && (best == NO_SLOT || age > best_age)) {
            best = s;
            best_age = age;
        }
    }
    return best;
}

static void take_slot(noh_clip_cache *cache, uint32_t s, uint32_t clip, uint32_t segment)
{
    slot *t = &cache->slots[s];
    const entry *e = &cache->entries[clip];
    if (t->used) {
        cache->slot_of[cache->entries[t->clip].first + t->cursor.segment] = NO_SLOT;
        cache->stats.evictions++;
    }
    t->used = 1;
    t->clip = clip;
    t->cursor = noh_clip_cursor_at(e->clip, segment);
    t->wanted = 0;
    t->stamp = cache->stamp;
    t->order = cache->order++;
    cache->slot_of[e->first + segment] = (uint16_t)s;
}

/* Decode a slot up to a track. Returns track-frames. */
static uint32_t decode_slot(noh_clip_cache *cache, uint32_t s, uint32_t track_end)
{
    slot *t = &cache->slots[s];
    const noh_clip *clip = cache->entries[t->clip].clip;
    const uint32_t frames = noh_clip_segment_first(clip, t->cursor.segment + 1u) - noh_clip_segment_first(clip, t->cursor.segment);
    const uint32_t before = t->cursor.track;
    if (track_end > before) {
        noh_clip_decode(clip, &cache->bases[frames], &t->cursor, track_end, slot_frames(cache, s));
    }
    return (t->cursor.track - before) * frames;
}

/* The slot of a segment with at least `tracks` decoded, whatever it takes. */
static uint32_t ready_slot(noh_clip_cache *cache, uint32_t clip, uint32_t segment, uint32_t tracks, uint32_t keep)
{
    uint32_t s = cache->slot_of[cache->entries[clip].first + segment];
    if (s == NO_SLOT) {
        s = oldest_slot(cache, keep);
        take_slot(cache, s, clip, segment);
    }
    cache->slots[s].stamp = cache->stamp;
    if (cache->slots[s].cursor.track < tracks) {
        const uint32_t spent = decode_slot(cache, s, tracks);
        cache->stats.misses++;
        cache->stats.decoded += spent;
        cache->stats.decoded_late += spent;
    }
    return s;
}

/* ---- what the game calls ---- */

void noh_clip_cache_tick(noh_clip_cache *cache)
{
    cache->stamp++;
}

static int want_segment(noh_clip_cache *cache, uint32_t clip, uint32_t segment, uint32_t tracks)
{
    uint32_t s = cache->slot_of[cache->entries[clip].first + segment];
    if (s == NO_SLOT) {
        s = oldest_slot(cache, NO_SLOT);
        if (cache->slots[s].used && cache->slots[s].stamp == cache->stamp) return 0;
        take_slot(cache, s, clip, segment);
    }
    cache->slots[s].stamp = cache->stamp;
    if (cache->slots[s].wanted < tracks) {
        cache->slots[s].wanted = tracks;
        cache->pending = 1;
    }
    return 1;
}

static uint32_t tracks_of(const noh_clip *c, uint32_t joint_count)
{
    return c->prefixes[joint_count < c->info.joint_count ? joint_count : c->info.joint_count].tracks;
}

int noh_clip_cache_want(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count)
{
    const noh_clip *c = cache->entries[clip].clip;
    float fraction;
    const uint32_t segment = noh_clip_segment_of(c, noh_clip_frame_at(c, ticks, &fraction));
    return want_segment(cache, clip, segment, tracks_of(c, joint_count));
}

uint32_t noh_clip_cache_want_frames(noh_clip_cache *cache, uint32_t clip, uint32_t first, uint32_t last, uint32_t joint_count)
{
    const noh_clip *c = cache->entries[clip].clip;
    const uint32_t tracks = tracks_of(c, joint_count), end = noh_clip_segment_of(c, last);
    uint32_t segment = noh_clip_segment_of(c, first), missing = 0;
    for (;;) {
        missing += !want_segment(cache, clip, segment, tracks);
        if (segment == end) return missing;
        segment = segment < end ? segment + 1u : segment - 1u;
    }
}

/* The oldest want that is not met; NO_SLOT when there is none. */
static uint32_t next_pending(const noh_clip_cache *cache)
{
    uint32_t best = NO_SLOT;
    for (uint32_t s = 0; s < cache->slot_count; s++) {
        const slot *t = &cache->slots[s];
        if (t->used && t->cursor.track < t->wanted &&
            (best == NO_SLOT || cache->order - t->order > cache->order - cache->slots[best].order)) {
            best = s;
        }
    }
    return best;
}

uint32_t noh_clip_cache_work(noh_clip_cache *cache, uint32_t budget)
{
    uint32_t spent = 0;
    while (cache->pending && spent < budget) {
        const uint32_t s = next_pending(cache);
        if (s == NO_SLOT) {
            cache->pending = 0;
            break;
        }
        while (cache->slots[s].cursor.track < cache->slots[s].wanted && spent < budget) {
            spent += decode_slot(cache, s, cache->slots[s].cursor.track + 1u);
        }
    }
    cache->stats.decoded += spent;
    return spent;
}

void noh_clip_sample(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count, noh_transform *out, float *floats)
{
    const noh_clip *c = cache->entries[clip].clip;
    const uint32_t joints = joint_count < c->info.joint_count ? joint_count : c->info.joint_count;
    const uint32_t tracks = c->prefixes[joints].tracks;
    float fraction;
    const uint32_t frame = noh_clip_frame_at(c, ticks, &fraction);
    const uint32_t segment = noh_clip_segment_of(c, frame);
    const uint32_t s = ready_slot(cache, clip, segment, tracks, NO_SLOT);
    const uint8_t *a = slot_frames(cache, s) + (size_t)(frame - noh_clip_segment_first(c, segment)) * c->frame_bytes;
    const uint8_t *b = a;
    cache->stats.samples++;
    if (fraction > 0.0f) {
        if (frame + 1u < noh_clip_segment_first(c, segment + 1u)) {
            b = a + c->frame_bytes;
        } else {
            b = slot_frames(cache, ready_slot(cache, clip, segment + 1u, tracks, s));
        }
    }
    noh_clip_blend_frames(c, a, b, fraction, joints, out, floats);
}

noh_clip_cache_stats noh_clip_cache_stats_of(const noh_clip_cache *cache)
{
    return cache->stats;
}

const noh_clip *noh_clip_cache_clip(const noh_clip_cache *cache, uint32_t clip)
{
    NOH_ASSERT(clip < cache->clip_count);
    return cache->entries[clip].clip;
}
