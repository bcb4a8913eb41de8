/* Tests of halved clips (noh_clip_desc.sample_rate_needed): which frames are decoded, that these have the bits that
 * they have in the whole clip, and what lies between them.
 * cross: slow, encodes clips */
#include "support/support.h"

#include <math.h>

#include "motion/clip/clip_cache_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "motion/clip/clip_decode_internal.h"
#include "motion/clip/clip_view_internal.h"
#include "convert/codec/clip_space.h"
#include "support/clip_fixture.h"

#define JOINTS 12u
#define RATE 120u
#define FRAME_TICKS 400 /* a frame is a whole number of ticks: samples at frames blend nothing */

/* The clip of a fixture once more, halved, with a cache of its own. */
typedef struct half {
    void *clip_memory, *cache_memory;
    noh_clip *clip;
    noh_clip_cache *cache;
    noh_clip_info info;
} half;

static noh_clip_desc desc_of(const fixture *x, uint32_t enough)
{
    noh_clip_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.bytes = x->blob.bytes;
    desc.byte_count = x->blob.count;
    desc.bind = x->bind;
    desc.joint_count = JOINTS;
    desc.sample_rate_needed = enough;
    return desc;
}

static half half_open(const fixture *x, uint32_t segments)
{
    const noh_clip_desc desc = desc_of(x, RATE / 2u);
    const noh_clip *clips[1];
    noh_clip_cache_desc cache;
    half h;
    size_t bytes = noh_clip_size(&desc, NULL);
    h.clip_memory = test_zeros(bytes);
    assert_int_equal(noh_clip_init(h.clip_memory, bytes, &desc, &h.clip, NULL), NOH_OK);
    noh_clip_info_of(h.clip, &h.info);
    assert_int_equal(h.info.halved, 1);
    clips[0] = h.clip;
    memset(&cache, 0, sizeof cache);
    cache.clips = clips;
    cache.clip_count = 1;
    cache.cached_segment_count = segments;
    bytes = noh_clip_cache_size(&cache, NULL);
    h.cache_memory = test_zeros(bytes);
    assert_int_equal(noh_clip_cache_init(h.cache_memory, bytes, &cache, &h.cache, NULL), NOH_OK);
    return h;
}

static void half_close(half *h)
{
    free(h->clip_memory);
    free(h->cache_memory);
}

static fixture encoded(raw_set *set, double error_cm, double split_hz)
{
    clip_options options;
    fixture x;
    set->clips[0].sample_rate_hz = (double)RATE;
    memset(&options, 0, sizeof options);
    options.error_cm = error_cm;
    options.split_hz = split_hz;
    options.effort = 1; /* an emulated processor takes a minute for the search */
    assert_null(fixture_build(&x, set, &options, 1000));
    assert_int_equal(x.sample_rate_uhz, RATE * NOH_CLIP_MICRO);
    return x;
}

static fixture swing(uint32_t frames, double error_cm)
{
    return encoded(fixture_swing(JOINTS, frames, 2, 10.0f, 0.5, 0.4), error_cm, INFINITY);
}

/* As captured: slow, and not still. */
static raw_set *captured(uint32_t frames)
{
    raw_set *set = fixture_swing(JOINTS, frames, 2, 10.0f, 0.1, 0.1);
    fixture_shake(&set->clips[0], 0.01);
    return set;
}

/* ---- slots ---- */

static void slots_are_in_the_order_of_frames(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= NOH_CLIP_SEGMENT_FRAMES_MAX; n++) {
        for (uint32_t halved = 0; halved < 2u; halved++) {
            const uint32_t slots = noh_clip_slots(n, halved);
            assert_int_equal(noh_clip_slot_frame(0, n, halved), 0);
            assert_int_equal(noh_clip_slot_frame(slots - 1u, n, halved), n - 1u);
            if (!halved) assert_int_equal(slots, n);
            if (halved) assert_true(slots <= n / 2u + 1u);
            for (uint32_t s = 0; s < slots; s++) {
                const uint32_t frame = noh_clip_slot_frame(s, n, halved);
                const uint32_t next = s + 1u < slots ? noh_clip_slot_frame(s + 1u, n, halved) : n;
                assert_true(next > frame && next - frame <= 1u + 2u * halved);
                for (uint32_t f = frame; f < next; f++) assert_int_equal(noh_clip_slot_of(f, n, halved), s);
            }
        }
    }
}

static void only_clips_of_twice_the_rate_are_halved(void **state)
{
    static const struct {
        uint32_t enough, halved;
    } cases[] = { { 0, 0 }, { 1, 1 }, { 30, 1 }, { 60, 1 }, { 61, 0 }, { 120, 0 }, { 0xffffffffu, 0 } };
    fixture x = swing(70, 0.01);
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const noh_clip_desc desc = desc_of(&x, cases[i].enough);
        noh_clip_info info;
        size_t bytes;
        assert_int_equal(noh_clip_measure(&desc, &info, &bytes, NULL), NOH_OK);
        assert_int_equal(info.halved, cases[i].halved);
        assert_true(info.segment_bytes_max ==
                    (size_t)x.clip->frame_bytes * noh_clip_slots(info.segment_frames_max, info.halved));
    }
    fixture_free(&x);
}

/* ---- poses ---- */

static void expect_blend(const noh_transform *a, const noh_transform *b, double to_b, const noh_transform *got)
{
    for (uint32_t j = 0; j < JOINTS; j++) {
        double q[4], square = 0.0;
        for (int i = 0; i < 4; i++) {
            q[i] = (1.0 - to_b) * (double)a[j].rotation[i] + to_b * (double)b[j].rotation[i];
            square += q[i] * q[i];
        }
        for (int i = 0; i < 4; i++) assert_true(fabs(q[i] / sqrt(square) - (double)got[j].rotation[i]) < 1e-4);
        for (int i = 0; i < 3; i++) {
            const double t = (1.0 - to_b) * (double)a[j].translation[i] + to_b * (double)b[j].translation[i];
            assert_true(fabs(t - (double)got[j].translation[i]) < 1e-4);
        }
    }
}

/* Frames that are decoded have the whole clip's bits; the others are blends of those about them. */
static void check_frames(const fixture *x)
{
    half h = half_open(x, 1000);
    uint32_t apart = 0;
    for (uint32_t f = 0; f < h.info.frame_count; f++) {
        const uint32_t segment = noh_clip_segment_of(h.clip, f), first = noh_clip_segment_first(h.clip, segment);
        const uint32_t frames = noh_clip_segment_frames(h.clip, segment);
        const uint32_t slot = noh_clip_slot_of(f - first, frames, 1);
        const uint32_t before = first + noh_clip_slot_frame(slot, frames, 1);
        noh_transform got[JOINTS], want[JOINTS], next[JOINTS];
        noh_clip_sample(h.cache, 0, (int64_t)f * FRAME_TICKS, JOINTS, got, NULL);
        noh_clip_sample(x->cache, 0, (int64_t)before * FRAME_TICKS, JOINTS, want, NULL);
        if (f == before) {
            assert_memory_equal(got, want, sizeof got);
        } else {
            const uint32_t after = first + noh_clip_slot_frame(slot + 1u, frames, 1);
            noh_clip_sample(x->cache, 0, (int64_t)after * FRAME_TICKS, JOINTS, next, NULL);
            expect_blend(want, next, (double)(f - before) / (double)(after - before), got);
            noh_clip_sample(x->cache, 0, (int64_t)f * FRAME_TICKS, JOINTS, next, NULL);
            apart += memcmp(got, next, sizeof got) != 0;
        }
    }
    assert_true(h.info.frame_count < 8u || apart > h.info.frame_count / 4u); /* half of them are not decoded */
    half_close(&h);
}

static void decoded_frames_have_the_bits_of_the_whole_clip(void **state)
{
    static const uint32_t counts[] = { 1, 2, 3, 4, 5, 31, 32, 33, 66, 97 };
    (void)state;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        fixture x = swing(counts[i], 0.01);
        check_frames(&x);
        fixture_free(&x);
    }
}

/* So tight a bound keeps rotations as floats, and tracks raw. */
static void rotations_of_floats_and_raw_tracks(void **state)
{
    fixture x = swing(70, 1e-5);
    (void)state;
    assert_true(x.clip->info.flags & NOH_CLIP_FLAG_WIDE);
    assert_true(noh_clip_cursor_at(x.clip, 0).raw_tracks || noh_clip_cursor_at(x.clip, 1).raw_tracks);
    check_frames(&x);
    fixture_free(&x);
}

/* Jumps, play forwards and backwards, wants, the first joints alone, a view: always the same bits. */
static void check_ways(fixture x)
{
    half all = half_open(&x, 1000), two = half_open(&x, 2);
    const size_t view_bytes = noh_clip_view_size(two.cache);
    void *view_memory = test_zeros(view_bytes);
    const int64_t duration = (int64_t)all.info.duration_ticks;
    noh_clip_view *view;
    uint32_t random = 3;
    int64_t ticks = 0;
    assert_int_equal(noh_clip_view_init(view_memory, view_bytes, two.cache, &view, NULL), NOH_OK);
    for (uint32_t i = 0; i < 3000u; i++) {
        const uint32_t way = i / 100u % 3u, joints = i % 7u == 0u ? 5u : JOINTS;
        noh_transform want[JOINTS], got[JOINTS], viewed[JOINTS];
        random = random * 1664525u + 1013904223u;
        ticks = way == 0u ? (int64_t)(random >> 8) % duration : (ticks + (way == 1u ? 800 : duration - 800)) % duration;
        noh_clip_cache_begin_frame(two.cache);
        if (i / 300u % 2u) {
            noh_clip_cache_want(two.cache, 0, ticks, joints);
            noh_clip_cache_work(two.cache, 40);
        }
        noh_clip_view_sample(view, 0, ticks, joints, viewed, NULL);
        noh_clip_sample(two.cache, 0, ticks, joints, got, NULL);
        noh_clip_sample(all.cache, 0, ticks, joints, want, NULL);
        assert_memory_equal(got, want, joints * sizeof *want);
        assert_memory_equal(viewed, want, joints * sizeof *want);
    }
    assert_true(noh_clip_cache_stats_of(two.cache).misses > 100u);
    free(view_memory);
    half_close(&all);
    half_close(&two);
    fixture_free(&x);
}

static void how_a_time_was_reached_makes_no_difference(void **state)
{
    (void)state;
    check_ways(swing(130, 0.01));
    check_ways(encoded(captured(130), 0.01, 0.0)); /* split */
}

/* ---- segments that are split ---- */

static uint32_t splits_of(const noh_clip *clip)
{
    noh_clip_info info;
    uint32_t count = 0;
    noh_clip_info_of(clip, &info);
    for (uint32_t s = 0; s < info.segment_count; s++) count += noh_clip_cursor_at(clip, s).high != 0u;
    return count;
}

static void a_split_changes_no_frame_of_the_whole_clip(void **state)
{
    static const uint32_t counts[] = { 17, 64, 99 };
    (void)state;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        fixture split = encoded(captured(counts[i]), 0.01, 0.0), whole = encoded(captured(counts[i]), 0.01, INFINITY);
        assert_true(splits_of(split.clip) > 0u);
        assert_int_equal(splits_of(whole.clip), 0);
        for (uint32_t f = 0; f < counts[i]; f++) {
            const uint32_t joints = f % 3u ? JOINTS : 4u;
            noh_transform a[JOINTS], b[JOINTS];
            noh_clip_sample(split.cache, 0, (int64_t)f * FRAME_TICKS, joints, a, NULL);
            noh_clip_sample(whole.cache, 0, (int64_t)f * FRAME_TICKS, joints, b, NULL);
            assert_memory_equal(a, b, joints * sizeof *a);
        }
        fixture_free(&split);
        fixture_free(&whole);
    }
}

/* Decode a segment, halved or not, and return where its readers stand. */
static noh_clip_cursor decoded(const noh_clip *clip, uint32_t segment, uint32_t halved)
{
    const uint32_t frames = noh_clip_segment_frames(clip, segment);
    float *rows = test_zeros(noh_clip_basis_count(frames) * sizeof *rows);
    uint8_t *out = test_zeros((size_t)frames * clip->frame_bytes);
    const noh_clip_basis basis = { frames, noh_clip_basis_half(frames), rows, 0, halved };
    noh_clip_cursor cursor = noh_clip_cursor_at(clip, segment);
    noh_clip_basis_build(frames, noh_clip_basis_of(&clip->info), rows);
    noh_clip_decode(clip, &basis, &cursor, clip->info.track_count, out);
    free(rows);
    free(out);
    return cursor;
}

/* Halved, a segment is read up to where its high part begins; whole, to its end. */
static void who_plays_half_does_not_read_the_high_part(void **state)
{
    fixture x = encoded(captured(99), 0.01, 0.0);
    (void)state;
    for (uint32_t s = 0; s < x.clip->info.segment_count; s++) {
        const noh_clip_cursor start = noh_clip_cursor_at(x.clip, s);
        const size_t end = (size_t)x.clip->segment_offsets[s + 1u] * 8u;
        assert_true(start.high > start.position && start.high < end);
        assert_int_equal(decoded(x.clip, s, 1).position, start.high);
        assert_int_equal(decoded(x.clip, s, 0).position, start.high);
        assert_true(decoded(x.clip, s, 0).high + 8u > end && decoded(x.clip, s, 0).high <= end);
        assert_true(end - start.high > (end - start.position) / 8u); /* which is worth it */
    }
    fixture_free(&x);
}

/* The mean distance of the last joint from the raw clip's, over all frames. */
static double off_from_raw(const fixture *x, noh_clip_cache *cache, uint32_t first, uint32_t end)
{
    const raw_clip *raw = &x->set->clips[0];
    double sum = 0.0;
    for (uint32_t f = first; f < end; f++) {
        noh_transform got[JOINTS];
        space_global a[JOINTS], b[JOINTS];
        noh_clip_sample(cache, 0, (int64_t)f * FRAME_TICKS, JOINTS, got, NULL);
        for (uint32_t j = 0; j < JOINTS; j++) {
            const uint32_t parent = x->set->skeleton.joints[j].parent;
            space_local l, r;
            for (int i = 0; i < 4; i++) l.q[i] = (double)got[j].rotation[i];
            for (int i = 0; i < 3; i++) l.t[i] = (double)got[j].translation[i], l.s[i] = (double)got[j].scale[i];
            for (int i = 0; i < 4; i++) r.q[i] = (double)raw->rotations[((size_t)f * JOINTS + j) * 4u + (uint32_t)i];
            for (int i = 0; i < 3; i++) {
                r.t[i] = (double)raw->translations[((size_t)f * JOINTS + j) * 3u + (uint32_t)i];
                r.s[i] = (double)raw->scales[((size_t)f * JOINTS + j) * 3u + (uint32_t)i];
            }
            space_compose(parent == MODEL_NONE ? NULL : &a[parent], &l, &a[j]);
            space_compose(parent == MODEL_NONE ? NULL : &b[parent], &r, &b[j]);
        }
        sum += space_distance(a[JOINTS - 1u].p, b[JOINTS - 1u].p);
    }
    return sum / (double)(end - first);
}

static double off_halved(const fixture *x, uint32_t first, uint32_t end)
{
    half h = half_open(x, 1000);
    const double off = off_from_raw(x, h.cache, first, end);
    half_close(&h);
    return off;
}

/* What is between the frames that are left is lost anyway; the high frequencies are no more than that. */
static void without_its_high_part_a_clip_is_about_as_near(void **state)
{
    fixture split = encoded(captured(99), 0.01, 0.0), whole = encoded(captured(99), 0.01, INFINITY);
    const double off = off_halved(&split, 0, 99), whole_off = off_halved(&whole, 0, 99);
    (void)state;
    assert_true(whole_off > 0.01);
    assert_true(off < 1.3 * whole_off);
    assert_true(off_from_raw(&split, split.cache, 0, 99) < 0.01);
    fixture_free(&split);
    fixture_free(&whole);
}

/* About a jump the high frequencies are needed: without them it rings through its segment. */
static void a_segment_with_a_jump_is_not_split(void **state)
{
    raw_set *set = captured(96);
    fixture x;
    (void)state;
    for (uint32_t f = 0; f < 40u; f++) fixture_axis_angle(fixture_rotation(&set->clips[0], f, 0), 0, 0, 1, 2.0);
    x = encoded(set, 0.01, 0.0);
    for (uint32_t s = 0; s < x.clip->info.segment_count; s++) {
        const uint32_t first = noh_clip_segment_first(x.clip, s);
        const uint32_t jumps = first < 40u && 40u < first + noh_clip_segment_frames(x.clip, s);
        assert_int_equal(noh_clip_cursor_at(x.clip, s).high == 0u, jumps);
    }
    assert_true(off_halved(&x, 0, 38) < 0.3 && off_halved(&x, 42, 96) < 0.3);
    fixture_free(&x);
}

/* ---- what it saves ---- */

static void half_the_bytes_and_half_the_frames(void **state)
{
    fixture x = swing(130, 0.01);
    half h = half_open(&x, 1000);
    noh_clip_info whole;
    noh_transform pose[JOINTS];
    (void)state;
    noh_clip_info_of(x.clip, &whole);
    assert_true(h.info.segment_bytes_max <= (size_t)x.clip->frame_bytes * (whole.segment_frames_max / 2u + 1u));
    for (uint32_t s = 0; s < whole.segment_count; s++) {
        const int64_t ticks = (int64_t)noh_clip_segment_first(x.clip, s) * FRAME_TICKS;
        noh_clip_cache_want(x.cache, 0, ticks, JOINTS);
        noh_clip_cache_want(h.cache, 0, ticks, JOINTS);
    }
    assert_true(noh_clip_cache_work(h.cache, UINT32_MAX) * 10u < noh_clip_cache_work(x.cache, UINT32_MAX) * 6u);
    assert_true(noh_clip_cache_holds_all(h.cache));
    noh_clip_sample(h.cache, 0, 0, JOINTS, pose, NULL);
    assert_int_equal(noh_clip_cache_stats_of(h.cache).misses, 0);
    half_close(&h);
    fixture_free(&x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slots_are_in_the_order_of_frames),
        cmocka_unit_test(only_clips_of_twice_the_rate_are_halved),
        cmocka_unit_test(decoded_frames_have_the_bits_of_the_whole_clip),
        cmocka_unit_test(rotations_of_floats_and_raw_tracks),
        cmocka_unit_test(how_a_time_was_reached_makes_no_difference),
        cmocka_unit_test(a_split_changes_no_frame_of_the_whole_clip),
        cmocka_unit_test(who_plays_half_does_not_read_the_high_part),
        cmocka_unit_test(without_its_high_part_a_clip_is_about_as_near),
        cmocka_unit_test(a_segment_with_a_jump_is_not_split),
        cmocka_unit_test(half_the_bytes_and_half_the_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
