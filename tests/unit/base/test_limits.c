/* test_limits.c: every desc at the limits of base/limits.h is measured, and one past them, or at the end of 32 bits, is
 * refused with a reason: no size wraps to a small one. */
#include "support/support.h"

#include <stdlib.h>
#include <string.h>

#include "anim/event_queue.h"
#include "character/character.h"
#include "character/lod_pools.h"
#include "character/scheduler.h"
#include "clip/clip_cache.h"
#include "gl/gl_morph.h"
#include "gl/gl_skin.h"

static union {
    uint8_t bytes[64];
    uint64_t words[8];
} small __attribute__((aligned(16))); /* far less than anything needs */

/* What refuses says ARG or LIMIT, and why. */
static void expect_refused(noh_result result, const noh_error *error)
{
    assert_true(result == NOH_ERR_ARG || result == NOH_ERR_LIMIT);
    assert_int_equal(error->result, result);
    assert_true(error->what && error->what[0]);
}

/* ---- controllers and characters ---- */

static void controller(uint32_t joints, uint32_t floats, uint32_t tracks, uint32_t changes, int fits)
{
    noh_clip_set set;
    noh_character_desc d;
    noh_controller *c;
    noh_character *ch;
    noh_character_scratch scratch;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    memset(&set, 0, sizeof set);
    memset(&d, 0, sizeof d);
    set.clip_count = 1;
    set.joint_count = joints;
    set.float_count = floats;
    d.controller.set = &set;
    d.controller.track_count = tracks;
    d.controller.change_count = changes;
    for (uint32_t flags = 0; flags <= NOH_CONTROLLER_INERTIAL; flags += NOH_CONTROLLER_INERTIAL) {
        d.controller.flags = flags;
        if (fits) {
            const size_t bytes = noh_controller_size(&d.controller);
            assert_true(bytes >= tracks * sizeof(noh_track) + changes * sizeof(noh_change));
            assert_true(noh_character_size(&d) >= bytes + 96u * (size_t)joints + 8u * (size_t)floats);
            assert_true(noh_character_scratch_size(&d) >= bytes + 88u * (size_t)joints + 4u * (size_t)floats);
            assert_int_equal(noh_controller_init(&small, sizeof small, &d.controller, &c, &error), NOH_ERR_MEMORY);
            assert_true(error.need == bytes);
            continue;
        }
        assert_true(noh_controller_size(&d.controller) == 0);
        assert_true(noh_character_size(&d) == 0 && noh_character_scratch_size(&d) == 0);
        expect_refused(noh_controller_init(&small, sizeof small, &d.controller, &c, &error), &error);
        expect_refused(noh_character_init(&small, sizeof small, &d, &ch, &error), &error);
        expect_refused(noh_character_scratch_init(&small, sizeof small, &d, &scratch, &error), &error);
    }
}

static void controllers_and_characters(void **state)
{
    (void)state;
    controller(NOH_JOINTS_MAX, NOH_FLOATS_MAX, NOH_TRACKS_MAX, NOH_CHANGES_MAX, 1);
    controller(NOH_JOINTS_MAX + 1u, 1, 1, 1, 0);
    controller(1, NOH_FLOATS_MAX + 1u, 1, 1, 0);
    controller(1, 1, NOH_TRACKS_MAX + 1u, 1, 0);
    controller(1, 1, 1, NOH_CHANGES_MAX + 1u, 0);
    controller(UINT32_MAX, 1, 1, 1, 0);
    controller(1, UINT32_MAX, 1, 1, 0);
    controller(1, 1, UINT32_MAX, 1, 0);
    controller(1, 1, 1, UINT32_MAX, 0);
}

static void event_queues_and_schedules(void **state)
{
    static const uint32_t past[] = { 0, NOH_SCHEDULE_MAX + 1u, 0x80000000u, UINT32_MAX };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_event_queue queue;
    noh_schedule schedule;
    (void)state;
    assert_true(noh_schedule_size(NOH_SCHEDULE_MAX) == NOH_SCHEDULE_MAX * sizeof(noh_schedule_item));
    assert_true(noh_event_queue_size(1u << 24) == ((size_t)1 << 24) * sizeof(noh_event));
    for (size_t i = 0; i < TEST_COUNT(past); i++) {
        const uint32_t capacity = i == 1 ? (1u << 24) + 1u : past[i];
        assert_true(noh_schedule_size(past[i]) == 0 && noh_event_queue_size(capacity) == 0);
        expect_refused(noh_schedule_init(&small, sizeof small, past[i], &schedule, &error), &error);
        expect_refused(noh_event_queue_init(&small, sizeof small, capacity, &queue, &error), &error);
    }
}

static void lod_pools(void **state)
{
    static const uint32_t levels[NOH_LOD_POOLS_MAX] = { 0, 1, 2, 3, 4, 5, 6, 7 };
    uint32_t slots[NOH_LOD_POOLS_MAX];
    noh_lod_pools_desc d = { NOH_LOD_POOL_SLOTS_MAX, NOH_LOD_POOLS_MAX, levels, slots };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_lod_pools *pools;
    (void)state;
    for (uint32_t i = 0; i < NOH_LOD_POOLS_MAX; i++) slots[i] = NOH_LOD_POOL_SLOTS_MAX / NOH_LOD_POOLS_MAX;
    assert_true(noh_lod_pools_size(&d) >= 20u * (size_t)NOH_LOD_POOL_SLOTS_MAX);
    assert_int_equal(noh_lod_pools_init(&small, sizeof small, &d, &pools, &error), NOH_ERR_MEMORY);
    for (int k = 0; k < 3; k++) { /* one slot too many; so many that 32 bits wrap to what would do; all ones */
        for (uint32_t i = 0; i < NOH_LOD_POOLS_MAX; i++) {
            slots[i] = k == 0   ? NOH_LOD_POOL_SLOTS_MAX / NOH_LOD_POOLS_MAX + (i == 7u)
                       : k == 1 ? 0x20000000u + NOH_LOD_POOL_SLOTS_MAX / NOH_LOD_POOLS_MAX
                                : UINT32_MAX;
        }
        assert_true(noh_lod_pools_size(&d) == 0);
        expect_refused(noh_lod_pools_init(&small, sizeof small, &d, &pools, &error), &error);
    }
}

/* ---- clip caches ---- */

/* As many clips as a cache takes, of as many segments as a clip has: their sum is 2^32. */
static void segments_of_a_cache_are_not_wrapped(void **state)
{
    noh_clip_cache_needs needs;
    noh_clip_info info;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    (void)state;
    memset(&needs, 0, sizeof needs);
    memset(&info, 0, sizeof info);
    info.frame_count = info.segment_count = NOH_CLIP_FRAMES_MAX;
    info.segment_frames_max = 1;
    info.segment_bytes_max = 64;
    for (uint32_t i = 0; i < 8u; i++) noh_clip_cache_needs_add(&needs, &info);
    assert_true(noh_clip_cache_needs_size(&needs, 2, &error) > 8u * 2u * (size_t)NOH_CLIP_FRAMES_MAX);
    for (uint32_t i = 8u; i < NOH_CLIP_CACHE_CLIPS_MAX; i++) noh_clip_cache_needs_add(&needs, &info);
    assert_int_equal(needs.clip_count, NOH_CLIP_CACHE_CLIPS_MAX);
    assert_true(noh_clip_cache_needs_size(&needs, 2, &error) == 0);
    expect_refused(error.result, &error);
}

static void cached_segments(void **state)
{
    noh_clip_cache_needs needs;
    noh_clip_info info;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    static const uint32_t refused[] = { 1, NOH_CLIP_CACHE_SEGMENTS_MAX + 1u, UINT32_MAX };
    (void)state;
    memset(&needs, 0, sizeof needs);
    memset(&info, 0, sizeof info);
    info.frame_count = info.segment_count = 2u * NOH_CLIP_CACHE_SEGMENTS_MAX;
    info.segment_frames_max = 1;
    info.segment_bytes_max = 64;
    noh_clip_cache_needs_add(&needs, &info);
    assert_true(noh_clip_cache_needs_size(&needs, NOH_CLIP_CACHE_SEGMENTS_MAX, &error) >
                64u * (size_t)NOH_CLIP_CACHE_SEGMENTS_MAX);
    for (size_t i = 0; i < TEST_COUNT(refused); i++) {
        memset(&error, 0, sizeof error);
        assert_true(noh_clip_cache_needs_size(&needs, refused[i], &error) == 0);
        expect_refused(error.result, &error);
    }
    needs.clip_count = NOH_CLIP_CACHE_CLIPS_MAX + 1u;
    assert_true(noh_clip_cache_needs_size(&needs, 2, &error) == 0);
    expect_refused(error.result, &error);
}

/* ---- GL plans, which need no GL ---- */

static noh_gl_caps caps_of_a_gpu(void)
{
    noh_gl_caps caps;
    memset(&caps, 0, sizeof caps);
    caps.texture_size_max = 16384;
    caps.uniform_block_bytes_max = 65536;
    caps.uniform_offset_align = 256;
    caps.mrt3 = caps.render_f32 = caps.render_f16 = caps.render_u32 = caps.blend_f32 = caps.blend_f16 = caps.layered =
        1;
    return caps;
}

static void plans_of_instances(void **state)
{
    static const uint32_t counts[][2] = { { NOH_MORPH_INSTANCES_MAX, 1 }, { UINT32_MAX, 1 }, { UINT32_MAX, UINT32_MAX },
                                          { 0x80000000u, 0x80000000u },   { UINT32_MAX, 2 }, { 0, 0 } };
    const test_model_desc model_desc = { 2, 3, 2, 0, 1 };
    size_t count;
    uint8_t *bytes = test_pack(&model_desc, &count);
    const noh_pack pack = test_open(bytes, count);
    const noh_mesh meshes[2] = { test_mesh(&pack, 0), test_mesh(&pack, 1) };
    const noh_gl_caps caps = caps_of_a_gpu();
    (void)state;
    for (int path = 0; path < NOH_MORPH_PATH_COUNT; path++) {
        noh_gl_morph_desc morph = { meshes, 2, NULL, (noh_morph_path)path, NOH_ACCUMULATE_AUTO, 0.0f };
        noh_gl_skin_desc skin = { meshes, 2, NULL, path % 2 ? NOH_PALETTE_TEXTURE : NOH_PALETTE_AUTO };
        noh_gl_morph_plan plan;
        noh_gl_skin_plan skin_plan;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        for (size_t i = 0; i < TEST_COUNT(counts); i++) {
            morph.instance_counts = skin.instance_counts = counts[i];
            expect_refused(noh_gl_morph_plan_make(&morph, &caps, &plan, &error), &error);
            expect_refused(noh_gl_skin_plan_make(&skin, &caps, &skin_plan, &error), &error);
        }
    }
    free(bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(controllers_and_characters),
    cmocka_unit_test(event_queues_and_schedules),
    cmocka_unit_test(lod_pools),
    cmocka_unit_test(segments_of_a_cache_are_not_wrapped),
    cmocka_unit_test(cached_segments),
    cmocka_unit_test(plans_of_instances),
};

TEST_MAIN(tests, NULL, NULL)
