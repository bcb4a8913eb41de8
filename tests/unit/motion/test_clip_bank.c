/* test_clip_bank.c: the clips of packs, made by the converter, played by controllers through a clip bank. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "motion/anim/sync_internal.h"
#include "convert/model/lip_target.h"
#include "convert/model/model_build.h"
#include "convert/clips/raw_set.h"
#include "support/clip_bank_fixture.h"
#include "motion/bank/clip_bank_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "noh/low_core.h"

#define NAMES "abcdefghij"
#define JOINTS 10u
#define FRAMES 241u /* ten segments */
#define STEP 800u   /* 60 Hz */

/* A walk and a longer clip of one skeleton in one pack; both loop. */
static uint8_t *bytes;
static size_t byte_count;
static noh_pack pack;

static int set_up(void **state)
{
    static const char keys[] =
        "walk 0.5 left marker\nwalk 0 begin 3\nwalk 1.0 step 7\nwalk 1.5 right marker\nwalk 8 end\n"
        "turn 0.1 right marker\nturn 0.6 left marker\n";
    const char *inputs[2];
    convert_options options;
    (void)state;
    memset(&options, 0, sizeof options);
    options.clip.check_loops = 1;
    inputs[0] = clip_bvh("walk", NAMES, FRAMES);
    inputs[1] = clip_bvh("turn", NAMES, CLIP_PASS_FRAMES);
    options.events = test_path("keys.txt");
    test_write_file(options.events, keys, sizeof keys - 1);
    bytes = clip_pack(inputs, 2, &options, &byte_count);
    pack = test_open(bytes, byte_count);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(bytes);
    return 0;
}

static noh_clip_bank_desc desc_of(const noh_pack *clips)
{
    noh_clip_bank_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clips = clips;
    return desc;
}

static noh_clip_bank *set_of(const noh_pack *clips)
{
    const noh_clip_bank_desc desc = desc_of(clips);
    return test_clip_bank(&desc);
}

/* ---- what is in it ---- */

static void clips_keys_and_markers_are_joined(void **state)
{
    noh_clip_bank *set = set_of(&pack);
    const uint32_t walk = noh_clip_bank_find(set, "walk"), turn = noh_clip_bank_find(set, "turn");
    const noh_clip_entry *m = &set->clips.clips[walk];
    (void)state;
    assert_int_equal(set->clips.clip_count, 2);
    assert_int_equal(noh_clip_bank_find(set, "fly"), NOH_NONE);
    assert_int_equal(set->skeleton.joint_count, JOINTS);
    assert_int_equal(set->clips.float_count, 0);
    assert_int_equal(set->foreign_count + set->unknown_count, 0);
    assert_int_equal(m->loop, NOH_LOOP_REPEAT);
    assert_in_range(m->duration_ticks, 383990, 384000); /* 8 s; the file's frame time is rounded */
    assert_int_equal(m->event_count, 3);
    assert_int_equal(set->clips.events[m->first_event].payload[0], 3);
    assert_int_equal(set->clips.events[m->first_event + 1].tick, 48000);
    assert_int_equal(set->clips.events[m->first_event + 1].name_hash, noh_hash_name("step"));
    assert_int_equal(set->clips.events[m->first_event + 2].tick, m->duration_ticks); /* not behind the end */
    assert_int_equal(m->marker_count, 2);
    assert_int_equal(set->clips.markers[m->first_marker].tick, 24000);
    assert_int_equal(set->clips.markers[m->first_marker + 1].id, noh_hash_name("right"));
    assert_int_equal(set->clips.clips[turn].marker_count, 2);
    free(set);
}

/* Nodes in order with their defaults, a joint, and clips; one of them moves both. */
static void weights_and_joints_of_a_model(void **state)
{
    model *m = clip_model(5);
    size_t count;
    uint8_t *made = test_pack_of(m, &count, NULL);
    noh_pack p = test_open(made, count);
    noh_clip_bank *set = set_of(&p);
    const uint32_t linear = noh_clip_bank_find(set, "linear");
    (void)state;
    assert_int_equal(set->clips.clip_count, 3);
    assert_int_equal(set->skeleton.joint_count, 1);
    assert_int_equal(set->clips.float_count, 5);
    assert_int_equal(set->group_count, 1);
    assert_int_equal(set->groups[0].node, 1);
    test_same_floats(set->clips.float_defaults, p.node_weights + p.nodes[1].first_weight, 5, "defaults");
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(noh_clip_bank_moves(set, i, 0), 1);
    }
    assert_int_equal(set->clips.clips[linear].event_count, 1);
    assert_int_equal(set->clips.clips[linear].marker_count, 2);
    assert_int_equal(set->clips.events[set->clips.clips[linear].first_event].payload[0], 42);
    free(set);
    free(made);
    model_free(m);
}

/* A key's smallest weight comes through: it is silent under a lighter track. */
static void the_smallest_weight_of_a_key_is_kept(void **state)
{
    uint8_t *copy = test_aligned(bytes, byte_count);
    noh_pack p = test_open(copy, byte_count);
    noh_clip_bank *set;
    noh_pack_clip m;
    noh_clip_event *events;
    clip_player player;
    uint32_t walk;
    (void)state;
    noh_pack_clip_at(&p, 0, &m, NULL);
    events = (noh_clip_event *)(void *)(copy + ((const uint8_t *)(const void *)m.events - copy));
    for (uint32_t i = 0; i < 3; i++) {
        events[i].weight_min = 0.25f * (float)(i + 1u);
    }
    set = set_of(&p);
    walk = noh_clip_bank_find(set, m.name);
    for (uint32_t i = 0; i < 3; i++) {
        assert_true(set->clips.events[set->clips.clips[walk].first_event + i].weight_min == 0.25f * (float)(i + 1u));
    }
    clip_player_open(&player, set);
    for (uint32_t i = 0; i <= 3; i++) { /* 0.2, 0.45, 0.7, 0.95: heavy enough for i of the keys */
        clip_start(&player, walk, NOH_LOOP_ONCE, 0, 0);
        assert_int_equal(noh_controller_set_weight(player.c, 0, 0.2f + 0.25f * (float)i), NOH_OK);
        assert_int_equal(
            noh_controller_step(player.c, &set->clips, set->clips.clips[walk].duration_ticks + 1u, NULL, NULL), i);
    }
    clip_player_close(&player);
    free(set);
    free(copy);
}

/* Weights of a mesh, of a node, of none: where the library says they are. */
static void floats_are_joined_to_meshes(void **state)
{
    model *m = clip_model(5);
    size_t count;
    uint8_t *made = test_pack_of(m, &count, NULL);
    noh_pack p = test_open(made, count);
    noh_clip_bank *set = set_of(&p);
    const uint32_t mesh = p.nodes[1].mesh;
    float floats[5] = { 0.5f, 0.25f, 0.125f, 0.0f, 1.0f };
    (void)state;
    assert_int_equal(mesh, 0);
    assert_int_equal(noh_clip_bank_node_group(set, 0), NOH_NONE); /* a joint */
    assert_int_equal(noh_clip_bank_node_group(set, 1), 0);
    assert_int_equal(noh_clip_bank_node_group(set, p.node_count), NOH_NONE);
    assert_int_equal(noh_clip_bank_node_group(set, NOH_NONE), NOH_NONE);
    assert_int_equal(noh_clip_bank_mesh_group(set, mesh), 0);
    assert_int_equal(noh_clip_bank_mesh_group(set, p.runs[NOH_CHUNK_MESH].count), NOH_NONE);
    assert_int_equal(noh_clip_bank_mesh_group(set, NOH_NONE), NOH_NONE); /* what a node without a mesh has */
    assert_ptr_equal(noh_clip_bank_mesh_weights(set, floats, mesh), floats + set->groups[0].first);
    assert_null(noh_clip_bank_mesh_weights(set, floats, p.runs[NOH_CHUNK_MESH].count));
    free(set);
    free(made);
    model_free(m);
}

/* ---- poses ---- */

/* A clip of the pack by itself. */
typedef struct alone {
    void *clip_memory, *cache_memory;
    noh_clip *clip;
    noh_clip_cache *cache;
} alone;

static void alone_open(alone *a, const noh_pack *p, uint32_t index)
{
    noh_clip_cache_desc cache;
    noh_clip_desc desc;
    noh_skeleton skeleton;
    noh_pack_clip m;
    const noh_clip *clips[1];
    size_t size;
    noh_pack_clip_at(p, index, &m, NULL);
    memset(&skeleton, 0, sizeof skeleton);
    (void)noh_pack_skeleton_at(p, m.header->skeleton, &skeleton, NULL, NULL);
    memset(&desc, 0, sizeof desc);
    desc.bytes = m.bytes;
    desc.byte_count = m.header->clip_bytes;
    desc.bind = skeleton.bind_pose;
    desc.joint_count = m.header->joint_count;
    size = noh_clip_size(&desc, NULL);
    a->clip_memory = test_aligned(NULL, size);
    assert_int_equal(noh_clip_init(a->clip_memory, size, &desc, &a->clip, NULL), NOH_OK);
    clips[0] = a->clip;
    cache.clips = clips;
    cache.clip_count = 1;
    cache.cached_segment_count = 0;
    size = noh_clip_cache_size(&cache, NULL);
    a->cache_memory = test_aligned(NULL, size);
    assert_int_equal(noh_clip_cache_init(a->cache_memory, size, &cache, &a->cache, NULL), NOH_OK);
}

static void alone_close(alone *a)
{
    free(a->clip_memory);
    free(a->cache_memory);
}

static void playing_is_sampling_to_the_bit(void **state)
{
    test_random r = test_random_from(3);
    noh_clip_bank *set = set_of(&pack);
    clip_player p;
    (void)state;
    clip_player_open(&p, set);
    for (uint32_t m = 0; m < 2; m++) {
        alone a;
        alone_open(&a, &pack, set->pack_clips[m]);
        for (int i = 0; i < 200; i++) {
            noh_transform expected[JOINTS];
            const int64_t tick = test_random_below(&r, set->clips.clips[m].duration_ticks + 1u);
            clip_start(&p, m, NOH_LOOP_ONCE, 0, tick);
            noh_controller_pose(p.c, &set->clips, &p.scratch, p.pose, p.floats);
            noh_clip_sample(a.cache, 0, tick, JOINTS, expected, NULL);
            assert_memory_equal(p.pose, expected, sizeof expected);
        }
        alone_close(&a);
    }
    clip_player_close(&p);
    free(set);
}

/* Clips of weights alone leave joints in the bind pose; a clip's weights come to their places. */
static void weights_are_sampled_to_the_bit(void **state)
{
    model *m = clip_model(5);
    size_t count;
    uint8_t *made = test_pack_of(m, &count, NULL);
    noh_pack packed = test_open(made, count);
    noh_clip_bank *set = set_of(&packed);
    clip_player p;
    (void)state;
    clip_player_open(&p, set);
    for (uint32_t i = 0; i < 3; i++) {
        alone a;
        alone_open(&a, &packed, set->pack_clips[i]);
        for (uint32_t k = 0; k <= 50; k++) {
            const int64_t tick = (int64_t)set->clips.clips[i].duration_ticks * k / 50;
            noh_transform joint = set->skeleton.bind_pose[0];
            float floats[5];
            noh_clip_info info;
            noh_clip_info_of(a.clip, &info);
            noh_clip_sample(a.cache, 0, tick, info.joint_count, &joint, floats);
            clip_start(&p, i, NOH_LOOP_ONCE, 0, tick);
            noh_controller_pose(p.c, &set->clips, &p.scratch, p.pose, p.floats);
            test_same_floats(p.floats, floats, 5, "weights");
            assert_memory_equal(p.pose, &joint, sizeof joint);
        }
        alone_close(&a);
    }
    clip_player_close(&p);
    free(set);
    free(made);
    model_free(m);
}

/* The same clips where no skeleton is asked for: weights alone. */
static void a_set_without_joints_plays_weights(void **state)
{
    model *m = clip_model(5);
    size_t count;
    uint8_t *made = test_pack_of(m, &count, NULL);
    noh_pack packed = test_open(made, count);
    noh_clip_bank_desc desc = desc_of(&packed);
    noh_clip_bank *set;
    clip_player p;
    (void)state;
    desc.skeleton = NOH_NONE;
    set = test_clip_bank(&desc);
    assert_int_equal(set->clips.clip_count, 2);
    assert_int_equal(set->foreign_count, 1);
    assert_int_equal(set->clips.joint_count, 0);
    clip_player_open(&p, set);
    clip_start(&p, noh_clip_bank_find(set, "cubic"), NOH_LOOP_PING_PONG, 0, 20000);
    for (int i = 0; i < 100; i++) {
        clip_frame(&p, STEP, 4800, 100);
    }
    assert_int_equal(noh_clip_cache_stats_of(set->cache).decoded_late, 0);
    clip_player_close(&p);
    free(set);
    free(made);
    model_free(m);
}

/* ---- keys and loops ---- */

typedef struct heard {
    uint32_t begin, step, end, steps_payload;
} heard;

static void hear(void *user, const noh_event *event)
{
    heard *h = user;
    h->begin += event->key->name_hash == noh_hash_name("begin");
    h->end += event->key->name_hash == noh_hash_name("end");
    if (event->key->name_hash == noh_hash_name("step")) {
        h->step++;
        h->steps_payload += event->key->payload[0];
    }
}

static void keys_of_a_pack_arrive_once_a_pass(void **state)
{
    noh_clip_bank *set = set_of(&pack);
    clip_player p;
    (void)state;
    clip_player_open(&p, set);
    for (uint32_t step = 100; step < 50000; step = step * 3 + 7) {
        const uint32_t walk = noh_clip_bank_find(set, "walk");
        const uint64_t way = 3ull * set->clips.clips[walk].duration_ticks + 1000;
        heard h = { 0, 0, 0, 0 };
        clip_start(&p, walk, NOH_LOOP_OF_CLIP, 0, 0);
        for (uint64_t done = 0; done < way; done += step) {
            noh_controller_step(p.c, &set->clips, (uint32_t)(way - done < step ? way - done : step), hear, &h);
        }
        assert_int_equal(h.begin, 4); /* at the start of each pass, the fourth too */
        assert_int_equal(h.step, 3);
        assert_int_equal(h.steps_payload, 21);
        assert_int_equal(h.end, 3);
    }
    clip_player_close(&p);
    free(set);
}

static void loops_go_round(void **state)
{
    noh_clip_bank *set = set_of(&pack);
    const uint32_t turn = noh_clip_bank_find(set, "turn");
    const int64_t duration = set->clips.clips[turn].duration_ticks;
    clip_player p;
    noh_transform first[JOINTS];
    (void)state;
    clip_player_open(&p, set);
    clip_start(&p, turn, NOH_LOOP_OF_CLIP, 0, duration / 3);
    clip_frame(&p, STEP, 4800, 1000);
    memcpy(first, p.pose, sizeof first);
    for (int pass = 0; pass < 5; pass++) {
        clip_frame(&p, (uint32_t)duration, 4800, 1000);
        assert_memory_equal(p.pose, first, sizeof first);
    }
    clip_player_close(&p);
    free(set);
}

/* The markers of the file keep a walk and a turn in step. */
static void markers_of_a_pack_synchronise(void **state)
{
    noh_clip_bank *set = set_of(&pack);
    clip_player p;
    (void)state;
    clip_player_open(&p, set);
    for (uint32_t i = 0; i < 2; i++) {
        noh_track_desc track;
        memset(&track, 0, sizeof track);
        track.clip = i;
        track.sync_group = 1;
        assert_int_equal(noh_controller_start(p.c, &set->clips, i, &track, NULL), NOH_OK);
    }
    for (int i = 0; i < 200; i++) {
        noh_phase a, b;
        clip_frame(&p, 480, 4800, 1000);
        a = noh_sync_phase(&set->clips, &set->clips.clips[0], noh_controller_track(p.c, 0)->position);
        b = noh_sync_phase(&set->clips, &set->clips.clips[1], noh_controller_track(p.c, 1)->position);
        assert_true(fabs((double)(a.interval % 2 - b.interval % 2) + a.fraction - b.fraction) < 1e-3);
    }
    clip_player_close(&p);
    free(set);
}

/* ---- ahead ---- */

/* A minute at 60 Hz; returns the track-frames that were decoded late. */
static uint64_t play_a_minute(noh_loop loop, int32_t speed, uint32_t ahead_ticks)
{
    noh_clip_bank *set = set_of(&pack);
    clip_player p;
    uint64_t late;
    clip_player_open(&p, set);
    clip_start(&p, noh_clip_bank_find(set, "walk"), loop, speed, 20000);
    for (int i = 0; i < 3600; i++) {
        clip_frame(&p, STEP, ahead_ticks, 1000);
    }
    late = noh_clip_cache_stats_of(set->cache).decoded_late;
    assert_true(noh_clip_cache_stats_of(set->cache).decoded > 200);
    clip_player_close(&p);
    free(set);
    return late;
}

static void nothing_is_decoded_late(void **state)
{
    static const int32_t speeds[] = { NOH_SPEED_ONE, -NOH_SPEED_ONE, 5 * NOH_SPEED_ONE / 2, -5 * NOH_SPEED_ONE / 2,
                                      NOH_SPEED_ONE / 7 };
    (void)state;
    for (int loop = NOH_LOOP_REPEAT; loop <= NOH_LOOP_PING_PONG; loop++) {
        for (size_t i = 0; i < TEST_COUNT(speeds); i++) {
            assert_int_equal(play_a_minute((noh_loop)loop, speeds[i], 4800), 0);
            assert_true(play_a_minute((noh_loop)loop, speeds[i], 0) > 0); /* else this shows nothing */
        }
    }
}

/* A budget that is spread: enough in the mean, far from enough for a segment at once. */
static void a_small_budget_is_enough_ahead(void **state)
{
    noh_clip_bank *set = set_of(&pack);
    clip_player p;
    noh_clip_cache_stats before, after;
    (void)state;
    clip_player_open(&p, set);
    clip_start(&p, noh_clip_bank_find(set, "walk"), NOH_LOOP_REPEAT, NOH_SPEED_ONE, 0);
    clip_frame(&p, 0, 24000, 10000);
    before = noh_clip_cache_stats_of(set->cache);
    for (int i = 0; i < 1200; i++) {
        clip_frame(&p, STEP, 24000, 24);
    }
    after = noh_clip_cache_stats_of(set->cache);
    assert_int_equal(after.decoded_late - before.decoded_late, 0);
    clip_player_close(&p);
    free(set);
}

/* Root motion is measured from where it was last taken, which may be a segment that no pose needs any more: that
 * segment is asked for too. */
static void where_root_motion_was_last_is_asked_for(void **state)
{
    noh_clip_bank_desc desc = desc_of(&pack);
    noh_clip_cache_stats before, after;
    noh_clip_bank *set;
    clip_player p;
    uint32_t walk;
    (void)state;
    desc.cached_segment_count = 4;
    desc.root_axes = NOH_ROOT_X | NOH_ROOT_Z;
    desc.root_up = 1;
    set = test_clip_bank(&desc);
    walk = noh_clip_bank_find(set, "walk");
    clip_player_open(&p, set);
    for (int seconds = 1; seconds <= 5; seconds++) {
        clip_start(&p, walk, NOH_LOOP_REPEAT, NOH_SPEED_ONE, 0);
        noh_clip_cache_begin_frame(set->cache); /* the four entries hold the end of the walk */
        assert_int_equal(noh_clip_cache_want_frames(set->cache, walk, 160, 240, JOINTS), 0);
        (void)noh_controller_step(p.c, &set->clips, 48000u * (uint32_t)seconds, NULL, NULL);
        noh_clip_cache_begin_frame(set->cache);
        assert_int_equal(noh_clip_bank_prefetch(set, p.c, 0), 0);
        (void)noh_clip_cache_work(set->cache, 1000000);
        before = noh_clip_cache_stats_of(set->cache);
        (void)noh_controller_root_motion(p.c, &set->clips);
        after = noh_clip_cache_stats_of(set->cache);
        assert_true(after.samples > before.samples);
        assert_int_equal(after.decoded_late - before.decoded_late, 0);
    }
    clip_player_close(&p);
    free(set);
}

static void ahead_says_what_finds_no_room(void **state)
{
    noh_clip_bank_desc desc = desc_of(&pack);
    noh_clip_bank *set;
    clip_player p;
    (void)state;
    desc.cached_segment_count = 2;
    set = test_clip_bank(&desc);
    clip_player_open(&p, set);
    clip_start(&p, noh_clip_bank_find(set, "walk"), NOH_LOOP_ONCE, 0, 0);
    noh_clip_cache_begin_frame(set->cache);
    assert_int_equal(noh_clip_bank_prefetch(set, p.c, 100), 0);
    assert_int_equal(noh_clip_bank_prefetch(set, p.c, 48000 * 20), 8); /* ten segments, two slots */
    assert_int_equal(noh_controller_set_mode(p.c, 0, NOH_TRACK_TIME_ONLY), NOH_OK);
    assert_int_equal(noh_clip_bank_prefetch(set, p.c, 48000 * 20), 0);
    clip_player_close(&p);
    free(set);
}

static void fewer_joints_are_decoded_for_less_lod(void **state)
{
    uint64_t decoded[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        noh_clip_bank *set = set_of(&pack);
        clip_player p;
        clip_player_open(&p, set);
        assert_int_equal(noh_controller_set_lod(p.c, 0, i ? 3u : 0u), NOH_OK);
        clip_start(&p, 0, NOH_LOOP_REPEAT, NOH_SPEED_ONE, 0);
        for (int k = 0; k < 400; k++) {
            clip_frame(&p, STEP, 4800, 1000);
        }
        assert_int_equal(noh_clip_cache_stats_of(set->cache).decoded_late, 0);
        decoded[i] = noh_clip_cache_stats_of(set->cache).decoded;
        clip_player_close(&p);
        free(set);
    }
    assert_true(decoded[1] * 2 < decoded[0]);
}

static void a_hundred_controllers_share_a_set(void **state)
{
    test_random r = test_random_from(9);
    noh_clip_bank *set = set_of(&pack), *single = set_of(&pack);
    clip_player crowd[100], one;
    (void)state;
    clip_player_open(&one, single);
    for (uint32_t i = 0; i < 100; i++) {
        clip_player_open(&crowd[i], set);
        clip_start(&crowd[i], i % 2, (noh_loop)(NOH_LOOP_REPEAT + i % 2),
                   (int32_t)(i % 3 ? NOH_SPEED_ONE : -NOH_SPEED_ONE), (int64_t)test_random_below(&r, 90000));
    }
    for (int frame = 0; frame < 60; frame++) {
        noh_clip_cache_begin_frame(set->cache);
        for (uint32_t i = 0; i < 100; i++) {
            const noh_track *t = noh_controller_track(crowd[i].c, 0);
            noh_controller_step(crowd[i].c, &set->clips, STEP, NULL, NULL);
            noh_controller_pose(crowd[i].c, &set->clips, &crowd[i].scratch, crowd[i].pose, crowd[i].floats);
            clip_start(&one, t->clip, (noh_loop)t->loop, t->speed, 0);
            noh_controller_tracks(one.c)[0].position = t->position;
            noh_controller_pose(one.c, &single->clips, &one.scratch, one.pose, one.floats);
            assert_memory_equal(crowd[i].pose, one.pose, sizeof *one.pose * JOINTS);
        }
    }
    for (uint32_t i = 0; i < 100; i++) {
        clip_player_close(&crowd[i]);
    }
    clip_player_close(&one);
    free(set);
    free(single);
}

/* ---- root motion ---- */

static void the_way_of_the_root_is_taken_out(void **state)
{
    noh_clip_bank_desc desc = desc_of(&pack);
    noh_clip_bank *set;
    clip_player p;
    double way = 0.0;
    (void)state;
    desc.root_axes = NOH_ROOT_Z;
    desc.root_up = 1;
    set = test_clip_bank(&desc);
    clip_player_open(&p, set);
    clip_start(&p, noh_clip_bank_find(set, "walk"), NOH_LOOP_REPEAT, 0, 0);
    for (int i = 0; i < 1000; i++) {
        clip_frame(&p, STEP, 4800, 1000);
        way += noh_controller_root_motion(p.c, &set->clips).translation[2];
        assert_true(fabsf(p.pose[0].translation[2]) < 1e-4f);
    }
    assert_true(fabs(way - 4.0 * 30.0 * 1000.0 * (double)STEP / 48000.0) < 0.1); /* 4 cm a frame */
    assert_true(noh_clip_cache_stats_of(set->cache).misses <= 4); /* where the ends of both clips were measured */
    clip_player_close(&p);
    free(set);
}

/* ---- two packs ---- */

static void mesh_and_clips_apart(void **state)
{
    const char *input = clip_bvh("walk", NAMES, CLIP_PASS_FRAMES);
    convert_options options;
    size_t counts[3];
    uint8_t *packs[3];
    noh_pack whole, mesh, anim;
    noh_clip_bank_desc desc;
    noh_clip_bank *together, *apart;
    clip_player a, b;
    (void)state;
    memset(&options, 0, sizeof options);
    for (int only = CONVERT_ALL; only <= CONVERT_CLIPS; only++) {
        options.only = (convert_only)only;
        packs[only] = clip_pack(&input, 1, &options, &counts[only]);
    }
    whole = test_open(packs[CONVERT_ALL], counts[CONVERT_ALL]);
    mesh = test_open(packs[CONVERT_MESH], counts[CONVERT_MESH]);
    anim = test_open(packs[CONVERT_CLIPS], counts[CONVERT_CLIPS]);
    assert_int_equal(mesh.runs[NOH_CHUNK_CLIP].count, 0);
    assert_int_equal(mesh.runs[NOH_CHUNK_SKELETON].count, 1);
    together = set_of(&whole);
    desc = desc_of(&anim);
    desc.mesh = &mesh;
    apart = test_clip_bank(&desc);
    clip_player_open(&a, together);
    clip_player_open(&b, apart);
    clip_start(&a, 0, NOH_LOOP_PING_PONG, 0, 0);
    clip_start(&b, 0, NOH_LOOP_PING_PONG, 0, 0);
    for (int i = 0; i < 300; i++) {
        clip_frame(&a, STEP, 4800, 1000);
        clip_frame(&b, STEP, 4800, 1000);
        assert_memory_equal(a.pose, b.pose, sizeof *a.pose * JOINTS);
    }
    clip_player_close(&a);
    clip_player_close(&b);
    free(together);
    free(apart);
    for (int i = 0; i < 3; i++) {
        free(packs[i]);
    }
}

static void expect_error(const noh_clip_bank_desc *desc, noh_result result, const char *word)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_clip_bank *set = NULL;
    uint8_t *memory = test_aligned(NULL, 1u << 20);
    assert_int_equal(noh_clip_bank_size(desc, &error), noh_clip_bank_size(desc, NULL));
    assert_int_equal(noh_clip_bank_init(memory, 1u << 20, desc, &set, &error), result);
    if (!strstr(error.what, word)) {
        fail_msg("'%s' does not say '%s'", error.what, word);
    }
    assert_null(set);
    free(memory);
}

static void another_skeleton_or_unit_is_refused(void **state)
{
    const char *other = clip_bvh("walk", "abcdefghix", CLIP_PASS_FRAMES),
               *same = clip_bvh("turn", NAMES, CLIP_PASS_FRAMES);
    convert_options options;
    size_t count;
    uint8_t *made;
    noh_pack mesh;
    noh_clip_bank_desc desc = desc_of(&pack);
    (void)state;
    memset(&options, 0, sizeof options);
    options.only = CONVERT_MESH;
    made = clip_pack(&other, 1, &options, &count);
    mesh = test_open(made, count);
    desc.mesh = &mesh;
    expect_error(&desc, NOH_ERR_NOT_FOUND, "another skeleton");
    free(made);
    options.source.unit_cm = 2.54;
    made = clip_pack(&same, 1, &options, &count);
    mesh = test_open(made, count);
    expect_error(&desc, NOH_ERR_NOT_FOUND, "unit");
    free(made);
}

/* The clips of one model on the nodes of another: found by name, unless their targets are others. */
static void weights_are_bound_by_name(void **state)
{
    model *clips = clip_model(5), *mesh = clip_model(5), *other = clip_model(4);
    size_t counts[3];
    uint8_t *made[3];
    noh_pack packs[3];
    noh_clip_bank_desc desc;
    noh_clip_bank *set;
    (void)state;
    made[0] = test_pack_of(clips, &counts[0], NULL);
    free(mesh->nodes[0].name); /* another joint: only the clips without joints fit */
    mesh->nodes[0].name = model_string("trunk");
    made[1] = test_pack_of(mesh, &counts[1], NULL);
    made[2] = test_pack_of(other, &counts[2], NULL);
    for (int i = 0; i < 3; i++) {
        packs[i] = test_open(made[i], counts[i]);
    }
    desc = desc_of(&packs[0]);
    desc.mesh = &packs[1];
    set = test_clip_bank(&desc);
    assert_int_equal(set->clips.clip_count, 2);
    assert_int_equal(set->foreign_count, 1);
    assert_int_equal(set->unknown_count, 0);
    assert_int_equal(noh_clip_bank_moves(set, 0, 0), 1);
    free(set);
    desc.mesh = &packs[2];
    set = test_clip_bank(&desc);
    assert_int_equal(set->unknown_count, 3);
    assert_int_equal(set->clips.float_count, 4);
    assert_int_equal(noh_clip_bank_moves(set, 0, 0), 0);
    free(set);
    for (int i = 0; i < 3; i++) {
        free(made[i]);
    }
    model_free(clips);
    model_free(mesh);
    model_free(other);
}

/* A target that the build added to the mesh keeps its default; the file's own move as the clip has them. */
static void clips_fit_a_mesh_with_an_added_target(void **state)
{
    model *clips = clip_model(4), *mesh = clip_model(5);
    size_t counts[2];
    uint8_t *made[2];
    noh_pack packs[2];
    noh_clip_bank *apart, *own;
    noh_clip_bank_desc desc;
    clip_player a, b;
    (void)state;
    free(mesh->meshes[0].targets[4].name);
    mesh->meshes[0].targets[4].name = model_string(LIP_TARGET);
    made[0] = test_pack_of(clips, &counts[0], NULL);
    made[1] = test_pack_of(mesh, &counts[1], NULL);
    for (int i = 0; i < 2; i++) packs[i] = test_open(made[i], counts[i]);
    own = set_of(&packs[0]);
    desc = desc_of(&packs[0]);
    desc.mesh = &packs[1];
    apart = test_clip_bank(&desc);
    assert_int_equal(apart->unknown_count, 0);
    assert_int_equal(apart->clips.float_count, 5);
    clip_player_open(&a, own);
    clip_player_open(&b, apart);
    clip_start(&a, 0, NOH_LOOP_REPEAT, 0, 0);
    clip_start(&b, 0, NOH_LOOP_REPEAT, 0, 0);
    for (int i = 0; i < 30; i++) {
        clip_frame(&a, STEP, 4800, 1000);
        clip_frame(&b, STEP, 4800, 1000);
        assert_memory_equal(a.floats, b.floats, 4 * sizeof *a.floats);
        assert_true(b.floats[4] == apart->clips.float_defaults[4]);
    }
    assert_memory_not_equal(b.floats, apart->clips.float_defaults, 4 * sizeof *b.floats);
    clip_player_close(&a);
    clip_player_close(&b);
    free(own);
    free(apart);
    for (int i = 0; i < 2; i++) free(made[i]);
    model_free(clips);
    model_free(mesh);
}

/* A pack of two clips without joints: "one" has the floats "glow" 1 and "heat" 2, "two" has "glow" 3 and "cold" 4. */
static uint8_t *named_floats_pack(size_t *count)
{
    static const char *const names[2][2] = { { "glow", "heat" }, { "glow", "cold" } };
    raw_set *raw = raw_set_new(0, 2);
    model *empty = model_new();
    clips_settings settings;
    encoded_clips made;
    model_error error;
    byte_buffer out = { NULL, 0, 0, 0 };
    uint8_t *copy;
    raw->skeleton.unit_cm = 1.0;
    for (uint32_t c = 0; c < 2; c++) {
        raw_clip *clip = &raw->clips[c];
        clip->name = model_string(c ? "two" : "one");
        clip->sample_rate_hz = 30.0;
        assert_int_equal(raw_clip_alloc(clip, 40, 0), 0);
        clip->floats = test_zeros(2 * sizeof *clip->floats);
        clip->float_count = 2;
        for (uint32_t g = 0; g < 2; g++) {
            assert_int_equal(raw_floats_alloc(&clip->floats[g], 40, 1), 0);
            clip->floats[g].name = model_string(names[c][g]);
            for (uint32_t f = 0; f < 40; f++) {
                clip->floats[g].values[f] = (float)(1u + g + 2u * c);
            }
        }
    }
    memset(&settings, 0, sizeof settings);
    assert_int_equal(clips_encode(&raw, 1, &settings, &made, &error), 0);
    assert_int_equal(pack_write(empty, NULL, NULL, &made, &out, &error), 0);
    copy = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    clips_free(&made);
    model_free(empty);
    raw_set_free(raw);
    return copy;
}

/* "glow" is one float in the set, whichever clip it is of. */
static void named_floats_are_shared(void **state)
{
    size_t count;
    uint8_t *made = named_floats_pack(&count);
    const noh_pack packed = test_open(made, count);
    noh_clip_bank *set = set_of(&packed);
    (void)state;
    assert_int_equal(set->group_count, 3);
    assert_int_equal(set->clips.float_count, 3);
    for (uint32_t c = 0; c < 2; c++) {
        float floats[3];
        noh_transform none;
        set->clips.sample(set, c, 1000, 0, &none, 3, floats);
        assert_true(fabsf(floats[0] - (float)(1u + 2u * c)) < 2e-3f);
        assert_true(fabsf(floats[1] - (c ? 0.0f : 2.0f)) < 2e-3f);
        assert_true(fabsf(floats[2] - (c ? 4.0f : 0.0f)) < 2e-3f);
    }
    free(set);
    free(made);
}

/* Clips of two floats: one of its own, whose name every fourth clip has from the one before it, and one that
 * all have. */
static uint8_t *many_names_pack(uint32_t clips, size_t *count)
{
    raw_set *raw = raw_set_new(0, clips);
    model *empty = model_new();
    clips_settings settings;
    encoded_clips made;
    model_error error;
    byte_buffer out = { NULL, 0, 0, 0 };
    uint8_t *copy;
    raw->skeleton.unit_cm = 1.0;
    for (uint32_t c = 0; c < clips; c++) {
        raw_clip *clip = &raw->clips[c];
        char name[32];
        snprintf(name, sizeof name, "clip%u", c);
        clip->name = model_string(name);
        clip->sample_rate_hz = 30.0;
        assert_int_equal(raw_clip_alloc(clip, 2, 0), 0);
        clip->floats = test_zeros(2 * sizeof *clip->floats);
        clip->float_count = 2;
        snprintf(name, sizeof name, "own%u", c % 4u == 3u ? c - 1u : c);
        for (uint32_t g = 0; g < 2; g++) {
            assert_int_equal(raw_floats_alloc(&clip->floats[g], 2, 1), 0);
            clip->floats[g].name = model_string(g ? "shared" : name);
            clip->floats[g].values[0] = clip->floats[g].values[1] = (float)(g ? 0u : c + 1u);
        }
    }
    memset(&settings, 0, sizeof settings);
    assert_int_equal(clips_encode(&raw, 1, &settings, &made, &error), 0);
    assert_int_equal(pack_write(empty, NULL, NULL, &made, &out, &error), 0);
    copy = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    clips_free(&made);
    model_free(empty);
    raw_set_free(raw);
    return copy;
}

/* Floats are counted in batches, without memory: the numbers around a batch, and thousands. Each clip moves its own. */
static void many_named_floats_are_counted(void **state)
{
    static const uint32_t numbers[] = { 1, 127, 169, 170, 171, 4000 };
    (void)state;
    for (uint32_t n = 0; n < sizeof numbers / sizeof numbers[0]; n++) {
        size_t count;
        uint8_t *made = many_names_pack(numbers[n], &count);
        const noh_pack packed = test_open(made, count);
        noh_clip_bank *set = set_of(&packed);
        const uint32_t own = numbers[n] - numbers[n] / 4u;
        float *floats = test_zeros((own + 1u) * sizeof *floats);
        assert_int_equal(set->group_count, own + 1u);
        assert_int_equal(set->clips.float_count, own + 1u);
        for (uint32_t c = 0; c < numbers[n]; c += 1u + numbers[n] / 50u) {
            noh_transform none;
            uint32_t moved = 0;
            set->clips.sample(set, c, 0, 0, &none, own + 1u, floats);
            for (uint32_t f = 0; f < own + 1u; f++) {
                moved += floats[f] != 0.0f;
            }
            assert_int_equal(moved, 1);
            assert_true(noh_clip_bank_moves(set, c, 1)); /* the second that was found: the shared one */
        }
        free(floats);
        free(set);
        free(made);
    }
}

/* ---- what is refused ---- */

static void descs_are_checked(void **state)
{
    noh_clip_bank_desc desc = desc_of(NULL);
    (void)state;
    expect_error(&desc, NOH_ERR_ARG, "clips");
    desc = desc_of(&pack), desc.skeleton = 1;
    expect_error(&desc, NOH_ERR_ARG, "skeleton");
    desc = desc_of(&pack), desc.cached_segment_count = 1;
    expect_error(&desc, NOH_ERR_ARG, "cached_segment_count");
    desc = desc_of(&pack), desc.root_axes = NOH_ROOT_GROUND | NOH_ROOT_BY_GAME;
    expect_error(&desc, NOH_ERR_ARG, "bits of NOH_ROOT_GROUND and NOH_ROOT_Y");
    desc = desc_of(&pack), desc.root_axes = NOH_ROOT_X, desc.root_up = 3;
    expect_error(&desc, NOH_ERR_ARG, "root_up");
    desc = desc_of(&pack), desc.skeleton = NOH_NONE;
    expect_error(&desc, NOH_ERR_NOT_FOUND, "no clip fits");
}

static void a_pack_without_clips_is_not_found(void **state)
{
    const test_model_desc bare = { 1, 3, 2, 0, 1 };
    size_t count;
    uint8_t *made = test_pack(&bare, &count);
    noh_pack p = test_open(made, count);
    noh_clip_bank_desc desc = desc_of(&p);
    (void)state;
    expect_error(&desc, NOH_ERR_NOT_FOUND, "no clips");
    free(made);
}

/* Lies that only opening the clips can find: the error names the clip. */
static void lies_are_told_with_the_clip(void **state)
{
    uint8_t *copy = test_aligned(bytes, byte_count);
    noh_pack p = test_open(copy, byte_count);
    noh_clip_bank_desc desc = desc_of(&p);
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_pack_clip m;
    noh_clip_event *event;
    noh_clip_marker *marker;
    uint32_t tick;
    (void)state;
    noh_pack_clip_at(&p, 0, &m, NULL);
    event = (noh_clip_event *)(void *)(copy + ((const uint8_t *)(const void *)m.events - copy)) + 2;
    tick = event->tick;
    event->tick += 1;
    expect_error(&desc, NOH_ERR_DATA, "event's tick is after the end");
    event->tick = tick;
    noh_pack_clip_at(&p, 1, &m, NULL);
    marker = (noh_clip_marker *)(void *)(copy + ((const uint8_t *)(const void *)m.markers - copy)) + 1;
    marker->tick = 1u << 30;
    expect_error(&desc, NOH_ERR_DATA, "marker's tick is not before");
    copy[m.bytes - copy + 1] ^= 0x80u; /* a flag that does not exist */
    assert_int_equal(noh_clip_bank_size(&desc, &error), 0);
    assert_int_not_equal(error.result, NOH_OK);
    assert_int_equal(error.where, 1);
    free(copy);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(clips_keys_and_markers_are_joined),
    cmocka_unit_test(weights_and_joints_of_a_model),
    cmocka_unit_test(the_smallest_weight_of_a_key_is_kept),
    cmocka_unit_test(floats_are_joined_to_meshes),
    cmocka_unit_test(playing_is_sampling_to_the_bit),
    cmocka_unit_test(weights_are_sampled_to_the_bit),
    cmocka_unit_test(a_set_without_joints_plays_weights),
    cmocka_unit_test(keys_of_a_pack_arrive_once_a_pass),
    cmocka_unit_test(loops_go_round),
    cmocka_unit_test(markers_of_a_pack_synchronise),
    cmocka_unit_test(nothing_is_decoded_late),
    cmocka_unit_test(a_small_budget_is_enough_ahead),
    cmocka_unit_test(where_root_motion_was_last_is_asked_for),
    cmocka_unit_test(ahead_says_what_finds_no_room),
    cmocka_unit_test(fewer_joints_are_decoded_for_less_lod),
    cmocka_unit_test(a_hundred_controllers_share_a_set),
    cmocka_unit_test(the_way_of_the_root_is_taken_out),
    cmocka_unit_test(mesh_and_clips_apart),
    cmocka_unit_test(another_skeleton_or_unit_is_refused),
    cmocka_unit_test(weights_are_bound_by_name),
    cmocka_unit_test(clips_fit_a_mesh_with_an_added_target),
    cmocka_unit_test(named_floats_are_shared),
    cmocka_unit_test(many_named_floats_are_counted),
    cmocka_unit_test(descs_are_checked),
    cmocka_unit_test(a_pack_without_clips_is_not_found),
    cmocka_unit_test(lies_are_told_with_the_clip),
};

TEST_MAIN(tests, set_up, tear_down)
