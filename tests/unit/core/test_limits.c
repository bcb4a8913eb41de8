/* test_limits.c: every desc at the limits of base.h is measured, and one past them, or at the end of 32 bits, is
 * refused with a reason: no size wraps to a small one. */
#include "support/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "motion/anim/changes_internal.h"
#include "motion/anim/controller_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "motion/graph/graph_internal.h"
#include "stage/character/joint_lod_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "stage/character/scheduler_internal.h"
#include "stage/character/time_lod_internal.h"
#include "stage/character/character_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/gl_device.h"
#include "noh/graph.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "convert/clips/raw_set.h"
#include "convert/model/model_build.h"
#include "convert/pack/pack_clips.h"

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

/* ---- what is posed, and what is measured beforehand ---- */

/* Counts whose product with a pose's, a matrix's or a float's bytes passes 32 bits by a little. */
#define JOINTS_WRAP (UINT32_MAX / (uint32_t)sizeof(noh_transform) + 1u)
#define MATRICES_WRAP (UINT32_MAX / 48u + 1u)
#define FLOATS_WRAP (UINT32_MAX / 4u + 1u)

static const uint32_t counts_past[][2] = { { NOH_JOINTS_MAX + 1u, 1 }, { 1, NOH_FLOATS_MAX + 1u }, { JOINTS_WRAP, 1 },
                                           { MATRICES_WRAP, 1 },       { 1, FLOATS_WRAP },         { UINT32_MAX, 1 },
                                           { 1, UINT32_MAX },          { UINT32_MAX, UINT32_MAX } };

static noh_clip_set set_of_counts(const noh_clip_entry *clip, uint32_t joints, uint32_t floats)
{
    noh_clip_set set;
    memset(&set, 0, sizeof set);
    set.clips = clip;
    set.clip_count = 1;
    set.joint_count = joints;
    set.float_count = floats;
    return set;
}

static void pose_scratches(void **state)
{
    const noh_clip_set most = set_of_counts(NULL, NOH_JOINTS_MAX, NOH_FLOATS_MAX);
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_pose_scratch scratch;
    (void)state;
    for (int inertial = 0; inertial < 2; inertial++) {
        const size_t poses = inertial ? 6u : 2u;
        assert_true(noh_pose_scratch_size(&most, inertial) >=
                    poses * (sizeof(noh_transform) * NOH_JOINTS_MAX + 4u * NOH_FLOATS_MAX));
        assert_int_equal(noh_pose_scratch_init(&small, sizeof small, &most, inertial, &scratch, &error),
                         NOH_ERR_MEMORY);
        assert_true(error.need == noh_pose_scratch_size(&most, inertial));
        for (size_t i = 0; i < TEST_COUNT(counts_past); i++) {
            const noh_clip_set set = set_of_counts(NULL, counts_past[i][0], counts_past[i][1]);
            assert_true(noh_pose_scratch_size(&set, inertial) == 0);
            expect_refused(noh_pose_scratch_init(&small, sizeof small, &set, inertial, &scratch, &error), &error);
        }
    }
}

/* The smallest graph, one clip, with as many parameters as there may be. */
static void graphs(void **state)
{
    const noh_clip_entry clip = { .duration_ticks = 48000, .loop = NOH_LOOP_REPEAT };
    const noh_graph_node node = { .kind = NOH_NODE_CLIP, .param = NOH_GRAPH_NONE, .param_y = NOH_GRAPH_NONE };
    const noh_track_desc track = { .weight = 1.0f };
    const noh_graph most = {
        .node_count = 1, .clip_count = 1, .param_count = NOH_GRAPH_PARAMS_MAX, .nodes = &node, .clips = &track
    };
    const noh_clip_set set = set_of_counts(&clip, NOH_JOINTS_MAX, NOH_FLOATS_MAX);
    const size_t counts[] = { offsetof(noh_graph, node_count), offsetof(noh_graph, child_count),
                              offsetof(noh_graph, clip_count), offsetof(noh_graph, machine_count),
                              offsetof(noh_graph, param_count) };
    const uint32_t limits[] = { NOH_GRAPH_NODES_MAX, NOH_GRAPH_NODES_MAX - 1u, NOH_TRACKS_MAX, 1,
                                NOH_GRAPH_PARAMS_MAX };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_graph_state *made;
    noh_graph_scratch scratch;
    (void)state;
    assert_true(noh_graph_state_size(&most, &set) >= 4u * NOH_GRAPH_PARAMS_MAX + sizeof(noh_track));
    assert_int_equal(noh_graph_state_init(&small, sizeof small, &most, &set, &made, &error), NOH_ERR_MEMORY);
    assert_true(noh_graph_scratch_size(&most, &set) >
                noh_pose_scratch_size(&set, 0) + sizeof(noh_transform) * NOH_JOINTS_MAX);
    assert_int_equal(noh_graph_scratch_init(&small, sizeof small, &most, &set, &scratch, &error), NOH_ERR_MEMORY);
    for (size_t i = 0; i < 2u * TEST_COUNT(counts); i++) {
        const uint32_t past = i % 2u ? UINT32_MAX : limits[i / 2u] + 1u;
        noh_graph graph = most;
        memcpy((uint8_t *)&graph + counts[i / 2u], &past, sizeof past);
        assert_true(noh_graph_state_size(&graph, &set) == 0);
        expect_refused(noh_graph_state_init(&small, sizeof small, &graph, &set, &made, &error), &error);
    }
    for (size_t i = 0; i < TEST_COUNT(counts_past); i++) {
        const noh_clip_set past = set_of_counts(&clip, counts_past[i][0], counts_past[i][1]);
        assert_true(noh_graph_state_size(&most, &past) == 0 && noh_graph_scratch_size(&most, &past) == 0);
        expect_refused(noh_graph_state_init(&small, sizeof small, &most, &past, &made, &error), &error);
        expect_refused(noh_graph_scratch_init(&small, sizeof small, &most, &past, &scratch, &error), &error);
    }
}

/* The measurements of LOD errors, with a skeleton of as many joints as their set. */
static void measured_lod(void **state)
{
    const float radius = 1.0f;
    const uint32_t one = 1;
    const noh_time_hold hold = { 0, 1.0f, { 0.0f, 0.0f, 0.0f } };
    const noh_time_lod_points points = { &hold, 1, 1 };
    const noh_clip_set most = set_of_counts(NULL, NOH_JOINTS_MAX, NOH_FLOATS_MAX);
    const noh_time_probe full = { &most, NULL, &radius, NULL, 0 };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    float errors[NOH_UPDATE_RATE_COUNT];
    (void)state;
    assert_true(noh_time_lod_measure_size(&full) >= 3u * (48u * NOH_JOINTS_MAX + 4u * NOH_FLOATS_MAX));
    assert_true(noh_time_lod_points_size(&full) >= noh_time_lod_measure_size(&full) + 48u * NOH_JOINTS_MAX);
    assert_true(noh_joint_lod_measure_size(&full) >= 2u * 48u * NOH_JOINTS_MAX);
    for (size_t i = 0; i < TEST_COUNT(counts_past); i++) {
        const noh_clip_set set = set_of_counts(NULL, counts_past[i][0], counts_past[i][1]);
        noh_skeleton skeleton;
        const noh_time_probe probe = { &set, &skeleton, &radius, NULL, 0 };
        memset(&skeleton, 0, sizeof skeleton);
        skeleton.joint_count = set.joint_count;
        assert_true(noh_time_lod_measure_size(&probe) == 0 && noh_time_lod_points_size(&probe) == 0 &&
                    noh_joint_lod_measure_size(&probe) == 0);
        expect_refused(noh_time_lod_measure(&small, sizeof small, &probe, 0, errors, &error), &error);
        expect_refused(noh_time_lod_points_measure(&small, sizeof small, &probe, &points, 0, errors, &error), &error);
        expect_refused(noh_joint_lod_measure(&small, sizeof small, &probe, 0, &one, 1, errors, &error), &error);
    }
}

static void schedules(void **state)
{
    static const uint32_t past[] = { 0, NOH_SCHEDULE_MAX + 1u, 0x80000000u, UINT32_MAX };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_schedule schedule;
    (void)state;
    assert_true(noh_schedule_size(NOH_SCHEDULE_MAX) == NOH_SCHEDULE_MAX * sizeof(noh_schedule_item));
    for (size_t i = 0; i < TEST_COUNT(past); i++) {
        assert_true(noh_schedule_size(past[i]) == 0);
        expect_refused(noh_schedule_init(&small, sizeof small, past[i], &schedule, &error), &error);
    }
}

static void lod_pools(void **state)
{
    static const uint32_t levels[NOH_LOD_POOLS_MAX] = { 0, 1, 2, 3, 4, 5, 6, 7 };
    uint32_t slots[NOH_LOD_POOLS_MAX];
    noh_lod_pools_desc d = { NOH_LOD_POOL_SLOTS_MAX, NOH_LOD_POOLS_MAX, levels, slots, 0 };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_lod_pools *pools;
    (void)state;
    for (uint32_t i = 0; i < NOH_LOD_POOLS_MAX; i++) slots[i] = NOH_LOD_POOL_SLOTS_MAX / NOH_LOD_POOLS_MAX;
    assert_true(noh_lod_pools_size(&d) >= 20u * (size_t)NOH_LOD_POOL_SLOTS_MAX);
    assert_int_equal(noh_lod_pools_init(&small, sizeof small, &d, &pools, &error), NOH_ERR_MEMORY);
    for (int k = 0; k < 3; k++) { /* one slot too many; a count that wraps at 32 bits to one that would do; all ones */
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

/* ---- clip banks ---- */

/* A pack of `count` clips of one frame, named after a letter and a number; each has `floats` floats, of its own name
 * or, if it is only one, of the name that all share. */
static uint8_t *float_clips(char letter, uint32_t count, uint32_t floats, noh_pack *pack)
{
    raw_set *raw = raw_set_new(0, count);
    model *empty = model_new();
    clips_settings settings;
    encoded_clips made;
    model_error error;
    byte_buffer out = { NULL, 0, 0, 0 };
    uint8_t *copy;
    assert_true(raw && empty);
    raw->skeleton.unit_cm = 1.0;
    for (uint32_t i = 0; i < count; i++) {
        raw_clip *clip = &raw->clips[i];
        char name[32];
        snprintf(name, sizeof name, "%c%u", letter, (unsigned)i);
        clip->name = model_string(name);
        clip->sample_rate_hz = 30.0;
        assert_int_equal(raw_clip_alloc(clip, 1, 0), 0);
        clip->floats = test_zeros(sizeof *clip->floats);
        clip->float_count = 1;
        assert_int_equal(raw_floats_alloc(&clip->floats[0], 1, floats), 0);
        clip->floats[0].name = model_string(floats == 1u ? "glow" : name);
    }
    memset(&settings, 0, sizeof settings);
    assert_int_equal(clips_encode(&raw, 1, &settings, &made, &error), 0);
    assert_int_equal(pack_write(empty, NULL, NULL, &made, &out, &error), 0);
    copy = test_aligned(out.bytes, out.count);
    *pack = test_open(copy, out.count);
    buffer_free(&out);
    clips_free(&made);
    model_free(empty);
    raw_set_free(raw);
    return copy;
}

static void expect_bank(const noh_clip_bank_desc *desc, int fits)
{
    noh_clip_bank_needs needs;
    noh_clip_bank *bank;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    if (fits) {
        assert_int_equal(noh_clip_bank_measure(desc, &needs, &error), NOH_OK);
        assert_true(noh_clip_bank_size(desc, &error) == needs.bytes);
        assert_int_equal(noh_clip_bank_init(&small, sizeof small, desc, &bank, &error), NOH_ERR_MEMORY);
        assert_true(error.need == needs.bytes);
    } else {
        expect_refused(noh_clip_bank_measure(desc, &needs, &error), &error);
        assert_true(noh_clip_bank_size(desc, &error) == 0);
        expect_refused(noh_clip_bank_init(&small, sizeof small, desc, &bank, &error), &error);
    }
}

/* Named floats of several clips are added up. */
static void floats_of_a_bank(void **state)
{
    noh_pack packs[2];
    const noh_pack *const both[2] = { &packs[0], &packs[1] };
    uint8_t *bytes[2] = { float_clips('a', 4, NOH_FLOATS_MAX / 4u, &packs[0]), float_clips('b', 1, 2, &packs[1]) };
    noh_clip_bank_desc desc;
    noh_clip_bank_needs needs;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.clip_packs = both;
    desc.clip_pack_count = 1;
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.shape.float_count, NOH_FLOATS_MAX);
    expect_bank(&desc, 1);
    desc.clip_pack_count = 2;
    expect_bank(&desc, 0);
    for (int i = 0; i < 2; i++) free(bytes[i]);
}

/* A pack has as many chunks as a bank may have clips, but not all are clips: it takes two packs to fill one. All clips
 * move the same float: of different ones, each would be looked for in all clips before. */
static void clips_of_a_bank(void **state)
{
    noh_pack packs[3];
    const noh_pack *const all[3] = { &packs[0], &packs[1], &packs[2] };
    uint8_t *bytes[3] = { float_clips('a', NOH_CLIP_CACHE_CLIPS_MAX / 2u, 1, &packs[0]),
                          float_clips('b', NOH_CLIP_CACHE_CLIPS_MAX / 2u, 1, &packs[1]),
                          float_clips('c', 1, 1, &packs[2]) };
    noh_clip_bank_desc desc;
    noh_clip_bank_needs needs;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.clip_packs = all;
    desc.clip_pack_count = 2;
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.shape.clip_count, NOH_CLIP_CACHE_CLIPS_MAX);
    expect_bank(&desc, 1);
    desc.clip_pack_count = 3;
    expect_bank(&desc, 0);
    for (int i = 0; i < 3; i++) free(bytes[i]);
}

/* What a bank's cache holds is asked for by segments, or follows from instances and tracks, and no number of them is
 * too large: there are never more segments than the clips have. */
static void cached_segments_of_a_bank(void **state)
{
    noh_pack pack;
    uint8_t *bytes = float_clips('a', 3, 1, &pack);
    noh_clip_bank_desc desc;
    noh_clip_bank_needs needs;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.clips = &pack;
    for (int i = 0; i < 8; i++) {
        desc.cached_segment_count = i == 7 ? NOH_CLIP_CACHE_SEGMENTS_MAX : 0u;
        desc.instance_count = i & 1 ? UINT32_MAX : i & 2 ? 0x80000000u : 1u;
        desc.track_count = i & 2 ? UINT32_MAX : i & 4 ? 0x55555556u : 1u;
        assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
        assert_int_equal(needs.cached_segment_count, 3);
        expect_bank(&desc, 1);
    }
    desc.cached_segment_count = 1;
    expect_bank(&desc, 0);
    free(bytes);
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
        noh_gl_morph_desc morph = { .meshes = meshes, .mesh_count = 2, .path = (noh_morph_path)path };
        noh_gl_skin_desc skin = { meshes, 2, NULL, path % 2 ? NOH_PALETTE_TEXTURE : NOH_PALETTE_AUTO, 0, 0 };
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
    cmocka_unit_test(pose_scratches),
    cmocka_unit_test(graphs),
    cmocka_unit_test(measured_lod),
    cmocka_unit_test(schedules),
    cmocka_unit_test(lod_pools),
    cmocka_unit_test(segments_of_a_cache_are_not_wrapped),
    cmocka_unit_test(cached_segments),
    cmocka_unit_test(floats_of_a_bank),
    cmocka_unit_test(clips_of_a_bank),
    cmocka_unit_test(cached_segments_of_a_bank),
    cmocka_unit_test(plans_of_instances),
};

TEST_MAIN(tests, NULL, NULL)
