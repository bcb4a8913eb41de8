/* test_rcl.c: .rcl in and out, and the skeleton hash. */
#include "support/support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"

/* --- a small file, byte by byte --- */

typedef struct bytes {
    uint8_t data[1024];
    size_t count;
} bytes;

static void put(bytes *b, const void *data, size_t count)
{
    assert_true(b->count + count <= sizeof b->data);
    memcpy(b->data + b->count, data, count);
    b->count += count;
}

static void put_u32(bytes *b, uint32_t value)
{
    const uint8_t data[4] = { (uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16), (uint8_t)(value >> 24) };
    put(b, data, sizeof data);
}

static void put_float(bytes *b, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u32(b, bits);
}

static void put_floats(bytes *b, const float *values, size_t count)
{
    for (size_t i = 0; i < count; ++i) put_float(b, values[i]);
}

static void put_string(bytes *b, const char *text)
{
    put_u32(b, (uint32_t)strlen(text));
    put(b, text, strlen(text));
}

static const float rest[10] = { 0, 0, 0, 1, 1, 2, 3, 1, 1, 1 };
static const float turned[10] = { 0, 0.6f, 0, 0.8f, -4, 5, 0.1f, 1, 2, 1 };

/* Offsets of fields in the file below. */
enum {
    AT_JOINTS = 4,
    AT_FRAMES = 8,
    AT_RATE = 12,
    AT_NAME = 16,
    AT_ROOT = 24,
    AT_ROOT_FLAGS = 28,
    AT_ROOT_NAME = 32,
    AT_ROOT_BIND = 40,
    AT_ROOT_FIRST = 80,
    AT_CHILD = 120,
    AT_CHILD_FLAGS = 124
};

/* Two joints, two frames: the root turns, the child moves and grows. */
static bytes small_file(void)
{
    bytes b = { { 0 }, 0 };
    put(&b, "RCL1", 4);
    put_u32(&b, 2);
    put_u32(&b, 2);
    put_float(&b, 25.0f);
    put_string(&b, "walk");
    put_u32(&b, 0xffffffffu);
    put_u32(&b, 1);
    put_string(&b, "root");
    put_floats(&b, rest, 10);
    put_floats(&b, rest, 10);
    put_u32(&b, 0);
    put_u32(&b, 6);
    put_string(&b, "");
    put_floats(&b, rest, 10);
    put_floats(&b, turned, 10);
    put_floats(&b, rest, 4);
    put_floats(&b, turned + 4, 6);
    put_floats(&b, turned, 4);
    put_floats(&b, rest + 4, 6);
    return b;
}

static const char *save(const bytes *b)
{
    const char *path = test_path("small.rcl");
    test_write_file(path, b->data, b->count);
    return path;
}

static raw_set *load(const char *path)
{
    raw_set *set = NULL;
    model_error error = { "", "" };
    if (rcl_read(path, &set, &error)) fail_msg("%s refused: %s (%s)", path, error.what, error.where);
    return set;
}

static void refused(const bytes *b, const char *what, const char *where)
{
    raw_set *set = (raw_set *)1;
    model_error error = { "", "" };
    assert_int_equal(rcl_read(save(b), &set, &error), 1);
    assert_null(set);
    if (!strstr(error.what, what) || strcmp(error.where, where) != 0)
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
}

static void small_clip_is_read(void **state)
{
    (void)state;
    bytes b = small_file();
    raw_set *set = load(save(&b));
    const raw_clip *clip = &set->clips[0];
    assert_int_equal(set->clip_count, 1);
    assert_int_equal(set->skeleton.joint_count, 2);
    assert_true(set->skeleton.unit_cm == 1.0);
    assert_string_equal(set->skeleton.joints[0].name, "root");
    assert_string_equal(set->skeleton.joints[1].name, "");
    assert_int_equal(set->skeleton.joints[0].parent, MODEL_NONE);
    assert_int_equal(set->skeleton.joints[1].parent, 0);
    assert_memory_equal(set->skeleton.joints[1].rotation, rest, 16);
    assert_string_equal(clip->name, "walk");
    assert_true(clip->sample_rate_hz == 25.0 && raw_clip_duration_s(clip) == 1.0 / 25.0);
    assert_int_equal(clip->frame_count, 2);
    /* frame 1: the root turned, in place; the child as first, but moved and grown */
    assert_memory_equal(clip->rotations + 8, turned, 16);
    assert_memory_equal(clip->translations + 6, rest + 4, 12);
    assert_memory_equal(clip->rotations + 12, turned, 16);
    assert_memory_equal(clip->translations + 9, rest + 4, 12);
    assert_memory_equal(clip->scales + 9, rest + 7, 12);
    assert_memory_equal(clip->scales + 3, turned + 7, 12);
    raw_set_free(set);
}

static void same_file(const char *a, const char *b)
{
    size_t bytes_a = 0, bytes_b = 0;
    model_error error;
    char *data_a = input_read(a, &bytes_a, &error), *data_b = input_read(b, &bytes_b, &error);
    assert_non_null(data_a);
    assert_non_null(data_b);
    assert_int_equal(bytes_a, bytes_b);
    assert_memory_equal(data_a, data_b, bytes_a);
    free(data_a);
    free(data_b);
}

static void round_trip(const char *path)
{
    model_error error = { "", "" };
    raw_set *set = load(path);
    const char *copy = test_path("copy.rcl");
    assert_int_equal(rcl_write(copy, &set->skeleton, &set->clips[0], &error), 0);
    same_file(path, copy);
    raw_set_free(set);
}

static void small_clip_round_trips(void **state)
{
    (void)state;
    bytes b = small_file();
    round_trip(save(&b));
}

static void metres_become_centimetres(void **state)
{
    (void)state;
    model_error error = { "", "" };
    bytes b = small_file();
    raw_set *set = load(save(&b));
    set->skeleton.unit_cm = 100.0;
    const char *path = test_path("copy.rcl");
    assert_int_equal(rcl_write(path, &set->skeleton, &set->clips[0], &error), 0);
    raw_set *again = load(path);
    assert_true(again->skeleton.unit_cm == 1.0);
    assert_true(again->skeleton.joints[0].translation[2] == 300.0f);
    assert_true(again->clips[0].translations[3] == -400.0f && again->clips[0].scales[4] == 2.0f);
    raw_set_free(again);
    raw_set_free(set);
}

static void clips_without_joints_are_not_written(void **state)
{
    (void)state;
    model_error error = { "", "" };
    raw_set *set = raw_set_new(0, 1);
    assert_non_null(set);
    assert_int_equal(rcl_write(test_path("none.rcl"), &set->skeleton, &set->clips[0], &error), 1);
    assert_non_null(strstr(error.what, "no joints"));
    raw_set_free(set);
}

static void every_truncation_is_refused(void **state)
{
    (void)state;
    bytes b = small_file();
    for (size_t count = 0; count < b.count; ++count) {
        raw_set *set = NULL;
        model_error error = { "", "" };
        test_write_file(test_path("cut.rcl"), b.data, count);
        assert_int_equal(rcl_read(test_path("cut.rcl"), &set, &error), 1);
        assert_null(set);
        assert_memory_equal(error.where, "byte ", 5);
    }
}

static void with_u32(size_t at, uint32_t value, const char *what, const char *where)
{
    bytes b = small_file();
    for (size_t i = 0; i < 4; ++i) b.data[at + i] = (uint8_t)(value >> (8 * i));
    refused(&b, what, where);
}

static void bad_fields_are_refused(void **state)
{
    (void)state;
    const uint32_t nan_bits = 0x7fc00000u, infinity_bits = 0x7f800000u;
    with_u32(0, 0x31435352u, "not a .rcl file", "byte 0");
    with_u32(AT_JOINTS, 0, "0 joints", "byte 4");
    with_u32(AT_JOINTS, 4097, "1 to 4096", "byte 4");
    with_u32(AT_FRAMES, 0, "0 frames", "byte 8");
    with_u32(AT_FRAMES, 0xffffffffu, "frames", "byte 8");
    with_u32(AT_FRAMES, 1000000, "ends before the end of its last frame", "byte 292");
    with_u32(AT_RATE, 0, "rate", "byte 12");
    with_u32(AT_RATE, nan_bits, "not finite", "byte 12");
    with_u32(AT_NAME, 0xfffffff0u, "ends too early", "byte 20");
    with_u32(AT_NAME + 4, 0x00616161u, "zero byte", "byte 20");
    with_u32(AT_ROOT, 0, "not an earlier joint", "byte 24");
    with_u32(AT_CHILD, 1, "not an earlier joint", "byte 120");
    with_u32(AT_CHILD, 0xfffffffeu, "not an earlier joint", "byte 120");
    with_u32(AT_ROOT_FLAGS, 8, "flags", "byte 28");
    with_u32(AT_ROOT_BIND + 16, infinity_bits, "not finite", "byte 56");
    with_u32(AT_ROOT_BIND + 12, 0, "unit quaternion", "byte 40");
    with_u32(AT_ROOT_FIRST + 36, nan_bits, "not finite", "byte 116");
    with_u32(AT_CHILD_FLAGS, 7, "ends before the end of its last frame", "byte 292");
    with_u32(AT_CHILD_FLAGS, 4, "bytes follow", "byte 268");
}

static void missing_files_are_refused(void **state)
{
    (void)state;
    raw_set *set = NULL;
    model_error error = { "", "" };
    assert_int_equal(rcl_read(test_path("nothing here.rcl"), &set, &error), 1);
    assert_non_null(strstr(error.what, "cannot be read"));
}

/* --- the hash --- */

static void hash_is_fnv_of_names_and_parents(void **state)
{
    (void)state;
    bytes b = small_file();
    raw_set *set = load(save(&b));
    const uint8_t hashed[] = { 2, 0, 0, 0, 'r', 'o', 'o', 't', 0, 255, 255, 255, 255, 0, 0, 0, 0, 0 };
    uint32_t expected = 2166136261u;
    for (size_t i = 0; i < sizeof hashed; ++i) expected = (expected ^ hashed[i]) * 16777619u;
    assert_int_equal(raw_skeleton_hash(&set->skeleton), expected);
    set->skeleton.joints[1].translation[0] += 1.0f; /* another bind pose binds all the same */
    assert_int_equal(raw_skeleton_hash(&set->skeleton), expected);
    set->skeleton.joints[1].parent = MODEL_NONE;
    assert_int_not_equal(raw_skeleton_hash(&set->skeleton), expected);
    set->skeleton.joints[1].parent = 0;
    set->skeleton.joints[0].name[0] = 'R';
    assert_int_not_equal(raw_skeleton_hash(&set->skeleton), expected);
    raw_set_free(set);
}

/* --- real clips --- */

static void all_real_clips_round_trip(void **state)
{
    (void)state;
    char folder[4096], path[4096 + 300];
    snprintf(folder, sizeof folder, "%s", test_asset("clips"));
    DIR *listing = opendir(folder);
    assert_non_null(listing);
    int count = 0;
    for (struct dirent *entry = readdir(listing); entry; entry = readdir(listing)) {
        size_t length = strlen(entry->d_name);
        if (length < 4 || strcmp(entry->d_name + length - 4, ".rcl") != 0) continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        round_trip(path);
        ++count;
    }
    closedir(listing);
    assert_true(count >= 23);
    print_message("%d clips read and written back to the same bytes\n", count);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(small_clip_is_read),          cmocka_unit_test(small_clip_round_trips),
    cmocka_unit_test(metres_become_centimetres),   cmocka_unit_test(clips_without_joints_are_not_written),
    cmocka_unit_test(every_truncation_is_refused), cmocka_unit_test(bad_fields_are_refused),
    cmocka_unit_test(missing_files_are_refused),   cmocka_unit_test(hash_is_fnv_of_names_and_parents),
    cmocka_unit_test(all_real_clips_round_trip),
};

TEST_MAIN(tests, NULL, NULL)
