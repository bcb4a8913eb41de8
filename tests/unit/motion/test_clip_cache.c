/* Tests of clip_cache.c: which segments it holds, at what cost, and what is decoded late.
 * cross: long, encodes clips */
#include "motion/clip/clip_cache_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "support/set_fixture.h"

#define JOINTS 12u
#define CLIPS 8u
#define STEP 800u
#define INSTANCES 20u

static set_fixture fixture;

static int set_up(void **state)
{
    static const uint32_t frames[CLIPS] = { 241, 300, 61, 500, 20, 181, 400, 97 };
    (void)state;
    fixture = set_fixture_make(JOINTS, CLIPS, frames);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(fixture.bytes);
    return 0;
}

static noh_clip_bank_desc desc_of(void)
{
    noh_clip_bank_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clips = &fixture.pack;
    return desc;
}

/* ---- room for what plays ---- */

typedef struct actor {
    void *memory;
    noh_controller *c;
} actor;

static void open_actors(actor *actors, uint32_t count, const noh_clip_set *set)
{
    test_random r = test_random_from(20);
    noh_controller_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.set = set;
    for (uint32_t i = 0; i < count; i++) {
        const size_t bytes = noh_controller_size(&desc);
        actors[i].memory = test_aligned(NULL, bytes);
        assert_int_equal(noh_controller_init(actors[i].memory, bytes, &desc, &actors[i].c, NULL), NOH_OK);
        for (uint32_t t = 0; t < 2u; t++) {
            noh_track_desc track;
            memset(&track, 0, sizeof track);
            track.clip = test_random_below(&r, CLIPS);
            track.position_ticks = test_random_below(&r, 400000);
            track.loop = NOH_LOOP_REPEAT;
            assert_int_equal(noh_controller_start(actors[i].c, set, t, &track, NULL), NOH_OK);
        }
    }
}

/* 20 seconds at 60 Hz; the first frame has to decode everything. Returns the track-frames that were late after it. */
static uint64_t play_a_while(const noh_clip_bank_desc *desc, uint32_t count, uint32_t *missing)
{
    noh_clip_bank *set = test_clip_bank(desc);
    const size_t bytes = noh_pose_scratch_size(&set->clips, 0);
    void *memory = test_aligned(NULL, bytes);
    noh_transform pose[JOINTS];
    float floats[CLIPS + 1u];
    noh_pose_scratch scratch;
    actor actors[INSTANCES];
    uint64_t late = 0;
    *missing = 0;
    open_actors(actors, count, &set->clips);
    assert_int_equal(noh_pose_scratch_init(memory, bytes, &set->clips, 0, &scratch, NULL), NOH_OK);
    for (uint32_t frame = 0; frame < 1200; frame++) {
        noh_clip_cache_begin_frame(set->cache);
        for (uint32_t i = 0; i < count; i++) {
            (void)noh_controller_step(actors[i].c, &set->clips, STEP, NULL, NULL);
            *missing += noh_clip_bank_prefetch(set, actors[i].c, 9600);
        }
        (void)noh_clip_cache_work(set->cache, frame ? 2000 : 1000000);
        for (uint32_t i = 0; i < count; i++) {
            noh_controller_pose(actors[i].c, &set->clips, &scratch, pose, floats);
        }
        if (frame == 0) late = noh_clip_cache_stats_of(set->cache).decoded_late;
    }
    late = noh_clip_cache_stats_of(set->cache).decoded_late - late;
    for (uint32_t i = 0; i < count; i++) {
        free(actors[i].memory);
    }
    free(memory);
    free(set);
    return late;
}

static void room_for_what_plays_decodes_nothing_late(void **state)
{
    static const uint32_t counts[] = { 1, 3, 8, INSTANCES };
    noh_clip_bank_desc desc = desc_of();
    noh_clip_bank_needs needs;
    uint32_t missing;
    uint64_t late;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(counts); i++) {
        const uint32_t count = counts[i];
        desc.instance_count = count;
        desc.cached_segment_count = 0;
        assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
        late = play_a_while(&desc, count, &missing);
        print_message("%u instances: room for %u of %u segments, %zu bytes: %llu track-frames late\n", (unsigned)count,
                      (unsigned)needs.cached_segment_count, (unsigned)needs.segment_count, needs.bytes,
                      (unsigned long long)late);
        assert_int_equal(late, 0);
        assert_int_equal(missing, 0);
    }
    desc.cached_segment_count = 2u * CLIPS; /* two for each clip, however many instances play it */
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    late = play_a_while(&desc, INSTANCES, &missing);
    print_message("%u instances: room for %u of %u segments, %zu bytes: %llu track-frames late\n", INSTANCES,
                  (unsigned)needs.cached_segment_count, (unsigned)needs.segment_count, needs.bytes,
                  (unsigned long long)late);
    assert_true(late > 10000u); /* otherwise this shows nothing */
    assert_true(missing > 0u);
}

static void the_default_follows_from_instances_and_tracks(void **state)
{
    noh_clip_bank_desc desc = desc_of();
    noh_clip_bank_needs needs;
    (void)state;
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.cached_segment_count, 6);
    desc.track_count = 1;
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.cached_segment_count, 3);
    desc.instance_count = 4;
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.cached_segment_count, 12);
    desc.instance_count = desc.track_count = 0xffffffffu; /* never more than there are */
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.cached_segment_count, needs.segment_count);
    desc.cached_segment_count = 5;
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.cached_segment_count, 5);
}

/* ---- sizes ---- */

/* Clips of floats only together with clips of joints: an entry is as large as its own clip needs, not as the largest
 * does. */
static void entries_are_as_large_as_their_segments(void **state)
{
    noh_clip_bank_desc desc = desc_of();
    noh_clip_bank *set;
    uint64_t exact = 0, had = 0;
    (void)state;
    desc.cached_segment_count = 32768;
    set = test_clip_bank(&desc);
    for (uint32_t i = 0; i < CLIPS; i++) {
        noh_clip_info info;
        noh_clip_info_of(noh_clip_cache_clip(set->cache, i), &info);
        exact += (uint64_t)info.segment_count * info.segment_bytes_max;
    }
    for (uint32_t k = 0; k < set->cache->size_count; k++) {
        had += (uint64_t)set->cache->sizes[k].count * set->cache->sizes[k].bytes;
    }
    assert_true(set->cache->size_count > 1u);
    assert_true(had >= exact && had <= exact + exact / 4u);
    free(set);
}

/* ---- what is held ---- */

/* Whether a segment of a clip is in the cache, wholly decoded or not. */
static int holds(const noh_clip_cache *cache, uint32_t clip, uint32_t segment)
{
    return cache->cached_of[cache->clips[clip].first + segment] != NOH_CLIP_NOT_CACHED;
}

static int64_t tick_of(const noh_clip_cache *cache, uint32_t clip, uint32_t segment)
{
    return 1600 * (int64_t)noh_clip_segment_first(cache->clips[clip].clip, segment) + 10;
}

/* The lists are whole: each entry occurs once, and segments and entries agree. */
static void expect_sound(const noh_clip_cache *cache)
{
    uint32_t first = 0, waiting = 0, listed = 0;
    for (uint32_t k = 0; k < cache->size_count; k++) {
        uint32_t count = 0, before = NOH_CLIP_NOT_CACHED;
        for (uint32_t s = cache->sizes[k].oldest; s != NOH_CLIP_NOT_CACHED;
             before = s, s = cache->cached[s].newer, count++) {
            assert_int_equal(cache->cached[s].older, before);
            assert_int_equal(cache->cached[s].size, k);
            assert_in_range(s, first, first + cache->sizes[k].count - 1u);
        }
        assert_int_equal(before, cache->sizes[k].newest);
        assert_int_equal(count, cache->sizes[k].count);
        first += count;
    }
    for (uint32_t s = cache->first_want; s != NOH_CLIP_NOT_CACHED; s = cache->cached[s].after) listed++;
    for (uint32_t s = 0; s < cache->cached_count; s++) {
        const noh_cached_segment *t = &cache->cached[s];
        waiting += t->waits;
        if (!t->used) continue;
        assert_int_equal(cache->cached_of[cache->clips[t->clip].first + t->cursor.segment], s);
        assert_true(t->waits || t->cursor.track >= t->wanted);
        assert_true(cache->sizes[t->size].bytes >= cache->clips[t->clip].clip->info.segment_bytes_max);
    }
    assert_int_equal(listed, waiting);
}

static void any_use_leaves_the_lists_whole(void **state)
{
    test_random r = test_random_from(4);
    (void)state;
    for (uint32_t slots = 2; slots < 40; slots += 3) {
        noh_clip_bank_desc desc = desc_of();
        noh_clip_bank *set;
        noh_transform pose[JOINTS];
        float floats[64];
        desc.cached_segment_count = slots;
        set = test_clip_bank(&desc);
        for (int i = 0; i < 1500; i++) {
            const uint32_t clip = test_random_below(&r, CLIPS), joints = test_random_below(&r, JOINTS + 1u);
            const int64_t tick = (int64_t)test_random_below(&r, 900000) - 1000;
            switch (test_random_below(&r, 5)) {
            case 0: noh_clip_cache_begin_frame(set->cache); break;
            case 1: (void)noh_clip_cache_want(set->cache, clip, tick, joints); break;
            case 2:
                (void)noh_clip_cache_want_frames(set->cache, clip, test_random_below(&r, 600),
                                                 test_random_below(&r, 600), joints);
                break;
            case 3: (void)noh_clip_cache_work(set->cache, test_random_below(&r, 200)); break;
            default: noh_clip_sample(set->cache, clip, tick, joints, pose, floats); break;
            }
            expect_sound(set->cache);
        }
        free(set);
    }
}

static void the_one_touched_longest_ago_goes(void **state)
{
    noh_clip_bank_desc desc = desc_of();
    noh_clip_bank *set;
    noh_clip_cache *cache;
    (void)state;
    desc.cached_segment_count = 3;
    set = test_clip_bank(&desc);
    cache = set->cache;
    for (uint32_t s = 0; s < 3u; s++) {
        noh_clip_cache_begin_frame(cache);
        assert_int_equal(noh_clip_cache_want(cache, 3, tick_of(cache, 3, s), JOINTS), 1);
    }
    noh_clip_cache_begin_frame(cache);
    assert_int_equal(noh_clip_cache_want(cache, 3, tick_of(cache, 3, 0), JOINTS), 1); /* touched again */
    assert_int_equal(noh_clip_cache_want(cache, 3, tick_of(cache, 3, 5), JOINTS), 1);
    assert_true(holds(cache, 3, 0) && !holds(cache, 3, 1) && holds(cache, 3, 2) && holds(cache, 3, 5));
    assert_int_equal(noh_clip_cache_want(cache, 3, tick_of(cache, 3, 6), JOINTS), 1);
    assert_int_equal(noh_clip_cache_want(cache, 3, tick_of(cache, 3, 7), JOINTS), 0); /* all three are of this frame */
    assert_int_equal(noh_clip_cache_stats_of(cache).evictions, 2);
    free(set);
}

/* Requests are served in order, and a segment that was evicted is not decoded. */
static void wants_are_met_in_order(void **state)
{
    noh_clip_bank_desc desc = desc_of();
    noh_clip_bank *set;
    noh_clip_cache *cache;
    (void)state;
    desc.cached_segment_count = 3;
    set = test_clip_bank(&desc);
    cache = set->cache;
    for (uint32_t s = 4; s-- > 1u;) {
        noh_clip_cache_begin_frame(cache);
        assert_int_equal(noh_clip_cache_want(cache, 3, tick_of(cache, 3, s), JOINTS), 1);
    }
    noh_clip_cache_begin_frame(cache);
    assert_int_equal(noh_clip_cache_want(cache, 3, tick_of(cache, 3, 9), JOINTS),
                     1); /* evicts segment 3, which waits */
    (void)noh_clip_cache_work(cache, 1);
    assert_true(cache->cached[cache->cached_of[cache->clips[3].first + 2u]].cursor.track > 0u);
    assert_int_equal(cache->cached[cache->cached_of[cache->clips[3].first + 1u]].cursor.track, 0);
    (void)noh_clip_cache_work(cache, 1000000);
    assert_int_equal(noh_clip_cache_work(cache, 1000000), 0);
    for (uint32_t s = 0; s < 3u; s++) {
        assert_int_equal(cache->cached[s].cursor.track, cache->cached[s].wanted);
    }
    free(set);
}

/* A sample across two segments keeps the first one, also where that is what was touched longest ago. */
static void a_second_segment_spares_the_first(void **state)
{
    noh_clip_bank_desc desc = desc_of();
    noh_clip_bank *small, *large;
    noh_transform pose[JOINTS], expected[JOINTS];
    float floats[64], expected_floats[64];
    int64_t across;
    (void)state;
    desc.cached_segment_count = 2;
    small = test_clip_bank(&desc);
    desc.cached_segment_count = 32768;
    large = test_clip_bank(&desc);
    across = tick_of(large->cache, 3, 1) - 800; /* between the last frame of segment 0 and the first of 1 */
    noh_clip_cache_begin_frame(small->cache);
    noh_clip_sample(small->cache, 3, tick_of(large->cache, 3, 0), JOINTS, pose, floats);
    noh_clip_sample(small->cache, 3, tick_of(large->cache, 3, 5), JOINTS, pose, floats);
    noh_clip_sample(small->cache, 3, across, JOINTS, pose, floats);
    noh_clip_sample(large->cache, 3, across, JOINTS, expected, expected_floats);
    assert_memory_equal(pose, expected, sizeof pose);
    assert_true(holds(small->cache, 3, 0) && holds(small->cache, 3, 1));
    free(small);
    free(large);
}

/* Where nobody wants anything, each sample decodes its share of what comes next: whole segments in single frames were
 * spikes. Only the first segment is decoded late: two frames of it, and the rest when play has left them. */
static void play_without_wants_is_even(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 4u; i++) {
        const int64_t backwards = i & 2u;
        noh_clip_bank_desc desc = desc_of();
        noh_transform pose[JOINTS];
        const noh_clip *clip;
        noh_clip_bank *set;
        uint64_t late = 0, most = 0, segment;
        desc.cached_segment_count = i & 1u ? 2u : 0u;
        set = test_clip_bank(&desc);
        clip = noh_clip_cache_clip(set->cache, 3);
        segment = (uint64_t)clip->info.track_count * clip->info.segment_frames_max;
        for (int64_t at = 0; at <= (int64_t)clip->info.duration_ticks; at += STEP) {
            const noh_clip_cache_stats before = noh_clip_cache_stats_of(set->cache);
            noh_clip_cache_stats after;
            noh_clip_cache_begin_frame(set->cache);
            noh_clip_sample(set->cache, 3, backwards ? (int64_t)clip->info.duration_ticks - at : at, JOINTS, pose,
                            NULL);
            after = noh_clip_cache_stats_of(set->cache);
            if (at <= 12 * STEP) late = after.decoded_late;
            if (at > 12 * STEP && after.decoded - before.decoded > most) most = after.decoded - before.decoded;
        }
        print_message("%s, %s: %u of %u track-frames in a frame at most\n", backwards ? "backwards" : "forwards",
                      i & 1u ? "two segments" : "default", (unsigned)most, (unsigned)segment);
        assert_true(most * 4u <= segment);
        assert_int_equal(noh_clip_cache_stats_of(set->cache).decoded_late, late);
        free(set);
    }
}

/* The last sample of a segment ends what was decoded ahead of the next, wherever play began. */
static void the_next_segment_is_ready_when_play_gets_there(void **state)
{
    (void)state;
    for (uint32_t frames = 2; frames < 9; frames++) {
        noh_clip_bank_desc desc = desc_of();
        desc.cached_segment_count = 32768;
        noh_clip_bank *set = test_clip_bank(&desc);
        const noh_clip *clip = noh_clip_cache_clip(set->cache, 3);
        const int64_t next = tick_of(set->cache, 3, 1), step = next / (int64_t)noh_clip_segment_first(clip, 1);
        noh_transform pose[JOINTS];
        for (uint32_t i = frames; i > 0; i--) {
            noh_clip_cache_begin_frame(set->cache);
            noh_clip_sample(set->cache, 3, next - (int64_t)i * step, JOINTS, pose, NULL);
        }
        assert_true(holds(set->cache, 3, 1));
        assert_int_equal(set->cache->cached[set->cache->cached_of[set->cache->clips[3].first + 1u]].cursor.track,
                         clip->prefixes[JOINTS].tracks);
        free(set);
    }
}

/* Every clip in turn, in a cache with room for `count` segments: what is decoded for 300 frames. */
static noh_clip_cache_stats play_side_by_side(uint32_t count)
{
    noh_clip_bank_desc desc = desc_of();
    noh_transform pose[JOINTS];
    noh_clip_cache_stats stats;
    noh_clip_bank *set;
    desc.cached_segment_count = count;
    set = test_clip_bank(&desc);
    for (int64_t frame = 0; frame < 300; frame++) {
        noh_clip_cache_begin_frame(set->cache);
        for (uint32_t clip = 0; clip < CLIPS; clip++)
            noh_clip_sample(set->cache, clip, frame * STEP, JOINTS, pose, NULL);
    }
    stats = noh_clip_cache_stats_of(set->cache);
    free(set);
    return stats;
}

/* Decoding ahead takes no entry that plays at the time: where only what is played has room, no more is decoded than
 * with room for all. */
static void decoding_ahead_evicts_nothing_that_plays(void **state)
{
    const noh_clip_cache_stats all = play_side_by_side(32768);
    (void)state;
    for (uint32_t count = CLIPS + 2u; count <= 2u * CLIPS; count += 3u) {
        const noh_clip_cache_stats few = play_side_by_side(count);
        print_message("room for %u: %llu track-frames decoded, for all %llu\n", (unsigned)count,
                      (unsigned long long)few.decoded, (unsigned long long)all.decoded);
        assert_true(few.decoded * 4u <= all.decoded * 5u);
    }
}

/* What work spends is counted as decoded, and not as late. */
static void work_is_counted(void **state)
{
    noh_clip_bank_desc desc = desc_of();
    noh_clip_bank *set = test_clip_bank(&desc);
    const noh_clip_cache_stats before = noh_clip_cache_stats_of(set->cache);
    noh_clip_cache_stats after;
    uint32_t spent;
    (void)state;
    noh_clip_cache_begin_frame(set->cache);
    assert_int_equal(noh_clip_cache_want(set->cache, 3, tick_of(set->cache, 3, 2), JOINTS), 1);
    spent = noh_clip_cache_work(set->cache, 1000000);
    after = noh_clip_cache_stats_of(set->cache);
    assert_true(spent > 0u);
    assert_int_equal(after.decoded - before.decoded, spent);
    assert_int_equal(after.decoded_late, before.decoded_late);
    free(set);
}

/* Once all is decoded nothing is wanted any more; a cache without room for all never gets there. */
static void a_cache_says_when_it_holds_all(void **state)
{
    (void)state;
    for (uint32_t segments = 3; segments <= 32768; segments += 32765) {
        noh_clip_bank_desc desc = desc_of();
        noh_clip_bank *set;
        desc.cached_segment_count = segments;
        set = test_clip_bank(&desc);
        for (uint32_t clip = 0; clip < set->clips.clip_count; clip++) {
            const uint32_t all = noh_clip_cache_clip(set->cache, clip)->info.joint_count;
            assert_int_equal(noh_clip_cache_holds_all(set->cache), 0);
            noh_clip_cache_begin_frame(set->cache);
            (void)noh_clip_cache_want_frames(set->cache, clip, 0, 0xffffffffu, all);
            (void)noh_clip_cache_work(set->cache, UINT32_MAX);
        }
        assert_int_equal(noh_clip_cache_holds_all(set->cache), segments > 3);
        free(set);
    }
}

/* ---- ends ---- */

static void frames_past_the_end_are_clamped(void **state)
{
    noh_clip_bank_desc desc = desc_of();
    noh_clip_bank *set;
    (void)state;
    desc.cached_segment_count = 32768;
    set = test_clip_bank(&desc);
    assert_int_equal(noh_clip_cache_want_frames(set->cache, 2, 0xffffffffu, 61, JOINTS), 0);
    assert_int_equal(noh_clip_cache_want_frames(set->cache, 2, 60, 0xffffffffu, JOINTS), 0);
    assert_int_equal(noh_clip_cache_want(set->cache, 2, INT64_MAX, JOINTS), 1);
    assert_int_equal(noh_clip_cache_want(set->cache, 2, INT64_MIN, 0xffffffffu), 1);
    assert_true(holds(set->cache, 2, 0));
    expect_sound(set->cache);
    free(set);
}

static void memory_and_descs_are_checked(void **state)
{
    noh_clip_bank_desc set_desc = desc_of();
    noh_clip_bank *set = test_clip_bank(&set_desc);
    const noh_clip *clips[2];
    noh_clip_cache_desc desc = { clips, 2, 4 };
    noh_clip_cache *cache = NULL;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    size_t bytes;
    uint8_t *memory;
    (void)state;
    clips[0] = noh_clip_cache_clip(set->cache, 0);
    clips[1] = NULL;
    assert_int_equal(noh_clip_cache_size(&desc, &error), 0);
    assert_int_equal(error.where, 1);
    clips[1] = noh_clip_cache_clip(set->cache, 4);
    bytes = noh_clip_cache_size(&desc, &error);
    memory = test_aligned(NULL, bytes + 16u);
    assert_int_equal(noh_clip_cache_init(NULL, bytes, &desc, &cache, &error), NOH_ERR_ARG);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_clip_cache_init(memory + NOH_MEMORY_ALIGN / 2, bytes, &desc, &cache, &error), NOH_ERR_ARG);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_clip_cache_init(memory, bytes - 1u, &desc, &cache, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, bytes);
    assert_null(cache);
    assert_int_equal(noh_clip_cache_init(memory, bytes, &desc, &cache, &error), NOH_OK);
    assert_int_equal(cache->cached_count, 4);
    desc.clip_count = NOH_CLIP_CACHE_CLIPS_MAX + 1u;
    assert_int_equal(noh_clip_cache_init(memory, bytes, &desc, &cache, &error), NOH_ERR_ARG);
    desc.clip_count = 0;
    assert_int_equal(noh_clip_cache_init(memory, bytes, &desc, &cache, &error), NOH_ERR_ARG);
    desc.clips = NULL;
    assert_int_equal(noh_clip_cache_init(memory, bytes, &desc, &cache, &error), NOH_ERR_ARG);
    assert_non_null(error.what);
    free(memory);
    free(set);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(room_for_what_plays_decodes_nothing_late),
    cmocka_unit_test(the_default_follows_from_instances_and_tracks),
    cmocka_unit_test(entries_are_as_large_as_their_segments),
    cmocka_unit_test(any_use_leaves_the_lists_whole),
    cmocka_unit_test(the_one_touched_longest_ago_goes),
    cmocka_unit_test(wants_are_met_in_order),
    cmocka_unit_test(a_second_segment_spares_the_first),
    cmocka_unit_test(play_without_wants_is_even),
    cmocka_unit_test(decoding_ahead_evicts_nothing_that_plays),
    cmocka_unit_test(the_next_segment_is_ready_when_play_gets_there),
    cmocka_unit_test(work_is_counted),
    cmocka_unit_test(a_cache_says_when_it_holds_all),
    cmocka_unit_test(frames_past_the_end_are_clamped),
    cmocka_unit_test(memory_and_descs_are_checked),
};

TEST_MAIN(tests, set_up, tear_down)
