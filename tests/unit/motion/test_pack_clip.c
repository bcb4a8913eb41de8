/* Skeletons and compressed clips in a pack: built from a .bvh that the test writes, bound by the skeleton's hash, and
 * damaged in every bit. */
#include "support/support.h"

#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "convert/model/model_build.h"
#include "support/clip_bank_fixture.h"
#include "support/pack_walk.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

static const char bvh[] =
    "HIERARCHY\nROOT hips\n{\n  OFFSET 0 0 0\n  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT knee\n  {\n    OFFSET 0 -10 0\n    CHANNELS 3 Zrotation Xrotation Yrotation\n"
    "    End Site\n    {\n      OFFSET 0 -10 0\n    }\n  }\n}\n"
    "MOTION\nFrames: 5\nFrame Time: 0.0333333\n"
    "0 20 0 0 0 0 0 0 0\n1 20 0 5 0 0 10 0 0\n2 21 0 10 0 0 25 0 0\n3 20 0 5 0 0 10 0 0\n4 20 0 0 0 0 0 0 0\n";

static byte_buffer good;
static uint8_t *weights; /* a pack of a mesh with weights, a joint, keys and markers */
static size_t weights_count;

static int build(const char *text, const char *events, byte_buffer *out, convert_failure *failure)
{
    convert_options options;
    const char *input = test_path("walk.bvh");
    memset(&options, 0, sizeof options);
    test_write_file(input, text, strlen(text));
    if (events) {
        options.events = test_path("keys.txt");
        test_write_file(options.events, events, strlen(events));
    }
    memset(out, 0, sizeof *out);
    return convert_files(&input, 1, &options, out, failure);
}

static int set_up(void **state)
{
    convert_failure failure;
    model *m = clip_model(2);
    (void)state;
    weights = test_pack_of(m, &weights_count, NULL);
    model_free(m);
    return build(bvh,
                 "walk 0.05 step_left 7 min=0.5\nwalk 0.1 step_right\nwalk 0 left marker\nwalk 0.09 right marker\n",
                 &good, &failure);
}

static int tear_down(void **state)
{
    (void)state;
    buffer_free(&good);
    free(weights);
    return 0;
}

static void pack_holds_skeleton_clip_and_keys(void **state)
{
    noh_pack pack = test_open(good.bytes, good.count);
    noh_pack_clip clip;
    noh_skeleton skeleton;
    uint32_t index = 9;
    (void)state;
    assert_int_equal(pack.runs[NOH_CHUNK_SKELETON].count, 1);
    assert_int_equal(pack.runs[NOH_CHUNK_CLIP].count, 1);
    assert_int_equal(noh_pack_clip_at(&pack, 0, &clip, NULL), NOH_OK);
    assert_int_equal(noh_pack_clip_at(&pack, 1, &clip, NULL), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_pack_bind_clip(&pack, &clip, &skeleton, &index, NULL), NOH_OK);
    assert_int_equal(index, 0);
    assert_int_equal(skeleton.joint_count, 2);
    assert_int_equal(skeleton.parents[0], NOH_JOINT_ROOT);
    assert_int_equal(skeleton.parents[1], 0);
    assert_string_equal(noh_pack_joint_name(&pack, 0, 1), "knee");
    assert_true(skeleton.bind_pose[1].translation[1] == -10.0f);
    assert_int_equal(clip.header->event_count, 2);
    assert_int_equal(clip.events[0].tick, 2400); /* 0.05 s of 48,000 ticks */
    assert_string_equal(noh_pack_string(&pack, clip.events[0].name), "step_left");
    assert_int_equal(clip.events[0].payload[0], 7);
    assert_true(clip.events[0].weight_min == 0.5f);
    assert_int_equal(clip.header->marker_count, 2);
    assert_int_equal(clip.markers[1].tick, 4320);
    assert_string_equal(noh_pack_string(&pack, clip.markers[1].name), "right");
}

/* ---- keys that have been through compression ---- */

typedef struct fired_key {
    int64_t clock;
    uint32_t name_hash, payload;
    float weight_min;
} fired_key;

typedef struct fired_list {
    fired_key items[64];
    uint32_t count;
} fired_list;

static void note_key(void *user, const noh_event *event)
{
    fired_list *list = user;
    assert_true(list->count < TEST_COUNT(list->items));
    list->items[list->count++] = (fired_key){ event->clock, event->key->name_hash, event->key->payload[0],
                                              event->key->weight_min };
}

/* Repeats the pack's clip at its own speed, a millisecond a step. */
static void play_pack(uint32_t passes, fired_list *list)
{
    noh_pack pack = test_open(good.bytes, good.count);
    noh_clip_bank_desc desc;
    noh_clip_bank *set;
    clip_player player;
    memset(&desc, 0, sizeof desc);
    memset(list, 0, sizeof *list);
    desc.clips = &pack;
    set = test_clip_bank(&desc);
    clip_player_open(&player, set);
    clip_start(&player, 0, NOH_LOOP_REPEAT, NOH_SPEED_ONE, 0);
    for (uint32_t ticks = 0; ticks < passes * set->clips.clips[0].duration_ticks; ticks += 48) {
        noh_controller_step(player.c, &set->clips, 48, note_key, list);
    }
    clip_player_close(&player);
    free(set);
}

/* The source of this design compresses a keyframe set into a new one that is created with 0 callback keys, so every
 * key is lost (Granberg, Character Animation with Direct3D, chapter 5). Here the keys come out of the compressed pack,
 * in every pass, with all that the text file said of them. */
static void keys_survive_compression(void **state)
{
    fired_list list;
    (void)state;
    play_pack(5, &list);
    assert_int_equal(list.count, 10);
    for (uint32_t i = 0; i < list.count; i++) {
        assert_int_equal(list.items[i].name_hash, noh_hash_name(i % 2 ? "step_right" : "step_left"));
        assert_int_equal(list.items[i].payload, i % 2 ? 0 : 7);
        assert_true(list.items[i].weight_min == (i % 2 ? 0.0f : 0.5f));
    }
}

/* The source stores a key's time in seconds in a field that counts ticks, so every key of the first second is in the
 * first tick (the same chapter). Keys at 0.05 s and 0.1 s fire at these times of the clock: 48,000 ticks are a second.
 */
static void key_times_are_ticks(void **state)
{
    fired_list list;
    (void)state;
    play_pack(1, &list);
    assert_int_equal(list.count, 2);
    assert_int_equal(list.items[0].clock, 2400);
    assert_int_equal(list.items[1].clock, 4800);
    assert_int_equal(noh_ticks_from_seconds(0.75), 36000);
    assert_int_equal(noh_ticks_from_seconds(-0.75), -36000);
    assert_int_equal(noh_ticks_from_seconds(1e300), 0);
}

/* Two joints: the error of the level without the knee, in a clip whose knee turns by at most 25 degrees. */
static void levels_and_errors_are_there(void **state)
{
    noh_pack pack = test_open(good.bytes, good.count);
    noh_pack_clip clip;
    uint32_t count = 9;
    const uint32_t *levels = noh_pack_joint_levels(&pack, 0, &count);
    (void)state;
    assert_int_equal(count, 2);
    assert_int_equal(levels[0], 2);
    assert_int_equal(levels[1], 1);
    assert_null(noh_pack_joint_levels(&pack, 1, &count));
    assert_int_equal(count, 0);
    assert_int_equal(noh_pack_clip_at(&pack, 0, &clip, NULL), NOH_OK);
    assert_int_equal(clip.header->joint_error_count, 2);
    assert_true(clip.joint_errors[0] == 0.0f);
    /* 3 cm from the knee a turn by 25 degrees moves a point by 3 * 2 sin(12.5 degrees) = 1.2987 */
    assert_true(clip.joint_errors[1] > 1.2986f && clip.joint_errors[1] < 1.2987f * 1.15f);
    assert_true(clip.header->error_shell == 3.0f);
    assert_true(clip.header->update_rate_error[0] == 0.0f &&
                clip.header->update_rate_error[3] >= clip.header->update_rate_error[1]);
    assert_true(clip.header->update_rate_error[3] > 0.0f);
}

static void another_skeleton_is_refused_by_name(void **state)
{
    byte_buffer other;
    convert_failure failure;
    char renamed[sizeof bvh];
    noh_pack pack = test_open(good.bytes, good.count), other_pack;
    noh_pack_clip clip;
    noh_skeleton skeleton;
    noh_error error = { NOH_OK, "", 0, 0 };
    (void)state;
    memcpy(renamed, bvh, sizeof bvh);
    memcpy(strstr(renamed, "knee"), "shin", 4);
    assert_int_equal(build(renamed, NULL, &other, &failure), 0);
    other_pack = test_open(other.bytes, other.count);
    noh_pack_clip_at(&pack, 0, &clip, NULL);
    assert_int_equal(noh_pack_bind_clip(&other_pack, &clip, &skeleton, NULL, &error), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(error.what, "another skeleton"));
    buffer_free(&other);
}

static void expect_damage_refused(const uint8_t *from, size_t whole)
{
    uint8_t *bytes = test_aligned(from, whole);
    noh_pack pack;
    noh_error error;
    for (size_t count = 0; count < whole; count++) {
        assert_int_not_equal(noh_pack_open(bytes, count, &pack, &error), NOH_OK);
    }
    for (size_t bit = 0; bit < whole * 8; bit++) {
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_int_not_equal(noh_pack_open(bytes, whole, &pack, &error), NOH_OK);
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    free(bytes);
}

static void every_truncation_and_flip_is_refused(void **state)
{
    (void)state;
    expect_damage_refused(good.bytes, good.count);
    expect_damage_refused(weights, weights_count);
}

/* Returns how many opened. */
static uint32_t walk_flips(const uint8_t *from, size_t count)
{
    uint32_t opened = 0;
    for (size_t bit = 0; bit < count * 8; bit++) {
        uint8_t *bytes = test_aligned(from, count);
        noh_pack pack;
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        pack_repair(bytes, count);
        if (noh_pack_open(bytes, count, &pack, NULL) == NOH_OK) {
            opened += 1;
            pack_walk(&pack, (uint32_t)bit);
        }
        free(bytes);
    }
    return opened;
}

/* With repaired checksums only the checkers and the decoder are left. */
static void repaired_flips_stay_in_bounds(void **state)
{
    (void)state;
    assert_true(walk_flips(good.bytes, good.count) > 100); /* else nothing was walked */
    assert_true(walk_flips(weights, weights_count) > 100);
}

typedef struct forged {
    uint8_t *bytes;
    noh_skeleton_header *skeleton;
    noh_clip_header *clip;
    uint8_t *skeleton_chunk, *clip_chunk;
} forged;

static forged forge(void)
{
    forged f;
    noh_pack pack = test_open(good.bytes, good.count);
    f.bytes = test_aligned(good.bytes, good.count);
    f.skeleton_chunk = f.bytes + pack.chunks[pack.runs[NOH_CHUNK_SKELETON].first].offset;
    f.clip_chunk = f.bytes + pack.chunks[pack.runs[NOH_CHUNK_CLIP].first].offset;
    f.skeleton = (noh_skeleton_header *)(void *)f.skeleton_chunk;
    f.clip = (noh_clip_header *)(void *)f.clip_chunk;
    return f;
}

static void expect_refused(forged *f, const char *what)
{
    noh_pack pack;
    noh_error error = { NOH_OK, "", 0, 0 };
    pack_repair(f->bytes, good.count);
    assert_int_equal(noh_pack_open(f->bytes, good.count, &pack, &error), NOH_ERR_DATA);
    if (!strstr(error.what, what)) {
        fail_msg("expected '%s', got '%s'", what, error.what);
    }
    assert_true(error.where < good.count);
    free(f->bytes);
}

static uint32_t *levels_of(forged *f)
{
    return (uint32_t *)(void *)(f->skeleton_chunk + f->skeleton->levels_offset);
}

static float *joint_errors_of(forged *f)
{
    return (float *)(void *)(f->clip_chunk + f->clip->joint_errors_offset);
}

static void lies_are_named(void **state)
{
    forged f = forge();
    (void)state;
    f.skeleton->joint_count = 0;
    expect_refused(&f, "joint count");
    f = forge();
    f.skeleton->joint_count = 0xffffffffu;
    expect_refused(&f, "joint count");
    f = forge();
    f.skeleton->unit_cm = 0.0f;
    expect_refused(&f, "unit");
    f = forge();
    ((uint16_t *)(void *)(f.skeleton_chunk + f.skeleton->parents_offset))[1] = 1;
    expect_refused(&f, "before its parent");
    f = forge();
    ((float *)(void *)(f.skeleton_chunk + f.skeleton->bind_offset))[3] = 2.0f;
    expect_refused(&f, "unit quaternion");
    f = forge();
    ((uint32_t *)(void *)(f.skeleton_chunk + f.skeleton->names_offset))[1] = 0x7fffffffu;
    expect_refused(&f, "outside the strings");
    f = forge();
    f.clip->event_count = NOH_CLIP_EVENTS_MAX + 1u;
    expect_refused(&f, "over the limit");
    f = forge();
    f.clip->marker_count = NOH_CLIP_MARKERS_MAX + 1u;
    expect_refused(&f, "over the limit");
    f = forge();
    ((noh_clip_marker *)(void *)(f.clip_chunk + f.clip->markers_offset))[1].tick = 0;
    expect_refused(&f, "markers are not in time order");
    f = forge();
    ((noh_clip_marker *)(void *)(f.clip_chunk + f.clip->markers_offset))[1].name_hash += 1;
    expect_refused(&f, "hash");
    f = forge();
    ((noh_clip_event *)(void *)(f.clip_chunk + f.clip->events_offset))[0].weight_min = -1.0f;
    expect_refused(&f, "weight");
    f = forge();
    f.clip->skeleton = 1;
    expect_refused(&f, "missing skeleton");
    f = forge();
    f.clip->skeleton_hash += 1;
    expect_refused(&f, "not its skeleton's");
    f = forge();
    f.clip->joint_count = 3;
    expect_refused(&f, "not its skeleton's");
    f = forge();
    f.clip->clip_bytes += 1;
    expect_refused(&f, "past the end");
    f = forge();
    ((noh_clip_event *)(void *)(f.clip_chunk + f.clip->events_offset))[0].tick = 0xffffffu;
    expect_refused(&f, "time order");
}

static void lies_about_lod_are_named(void **state)
{
    forged f = forge();
    (void)state;
    f.skeleton->level_count = 0;
    expect_refused(&f, "joint levels is zero");
    f = forge();
    f.skeleton->level_count = NOH_LOD_LEVELS_MAX + 1u;
    expect_refused(&f, "joint levels is zero or over");
    f = forge();
    f.skeleton->levels_offset += 16;
    expect_refused(&f, "does not begin");
    f = forge();
    levels_of(&f)[0] = 1;
    expect_refused(&f, "do not begin with all");
    f = forge();
    levels_of(&f)[1] = 2;
    expect_refused(&f, "do not fall");
    f = forge();
    levels_of(&f)[1] = 0;
    expect_refused(&f, "do not fall");
    f = forge();
    ((uint16_t *)(void *)(f.skeleton_chunk + f.skeleton->parents_offset))[1] = NOH_PACK_JOINT_ROOT;
    expect_refused(&f, "leaves out a joint that has no parent");
    f = forge();
    f.clip->joint_error_count = 1;
    expect_refused(&f, "differs from its skeleton's joint levels");
    f = forge();
    joint_errors_of(&f)[0] = 0.5f;
    expect_refused(&f, "joint errors do not begin with 0");
    f = forge();
    joint_errors_of(&f)[1] = -0.5f;
    expect_refused(&f, "joint errors do not begin with 0, or fall");
    f = forge();
    memset(&joint_errors_of(&f)[1], 0xff, 4);
    expect_refused(&f, "joint errors");
    f = forge();
    f.clip->update_rate_error[0] = 0.5f;
    expect_refused(&f, "update rate errors");
    f = forge();
    f.clip->update_rate_error[2] = -1.0f;
    expect_refused(&f, "update rate errors");
    f = forge();
    memset(&f.clip->update_rate_error[3], 0xff, 4);
    expect_refused(&f, "update rate errors");
    f = forge();
    f.clip->error_shell = -3.0f;
    expect_refused(&f, "shell");
    f = forge();
    f.clip->root_ends[1][3] += 0.5f;
    expect_refused(&f, "root joint's rotation");
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(pack_holds_skeleton_clip_and_keys),
                                        cmocka_unit_test(keys_survive_compression),
                                        cmocka_unit_test(key_times_are_ticks),
                                        cmocka_unit_test(levels_and_errors_are_there),
                                        cmocka_unit_test(another_skeleton_is_refused_by_name),
                                        cmocka_unit_test(every_truncation_and_flip_is_refused),
                                        cmocka_unit_test(repaired_flips_stay_in_bounds),
                                        cmocka_unit_test(lies_are_named),
                                        cmocka_unit_test(lies_about_lod_are_named) };
    if (argument_count > 1) {
        cmocka_set_test_filter(arguments[1]);
    }
    return cmocka_run_group_tests_name("pack_clip", tests, set_up, tear_down);
}
