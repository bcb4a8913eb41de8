/* The table for motion matching in a pack: made of a text and clips, features as they were moved; lies are refused, and
 * whatever opens can be searched. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "convert/convert.h"
#include "motion/match/match_internal.h"
#include "support/pack_walk.h"

#define FRAMES 241 /* 8 s at 30 Hz */

static uint8_t *good;
static size_t good_count;

/* A person of sticks walks 1 m/s along +z, and on a circle to the left: 1 rad/s. Centimetres and degrees. */
static const char *write_bvh(int turns)
{
    static const char *const sides[2] = { "Left", "Right" };
    const char *path = test_path(turns ? "circle.bvh" : "straight.bvh");
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fprintf(out, "HIERARCHY\nROOT Hips\n{\nOFFSET 0 90 0\n"
                 "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n");
    for (int i = 0; i < 2; i++) {
        fprintf(out,
                "JOINT %sUpLeg\n{\nOFFSET %d -5 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
                "JOINT %sLeg\n{\nOFFSET 0 -42 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
                "JOINT %sFoot\n{\nOFFSET 0 -40 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
                "End Site\n{\nOFFSET 0 -3 12\n}\n}\n}\n}\n",
                sides[i], i ? -9 : 9, sides[i], sides[i]);
    }
    fprintf(out, "}\nMOTION\nFrames: %d\nFrame Time: 0.033333333\n", FRAMES);
    for (int f = 0; f < FRAMES; f++) {
        const double t = f / 30.0, swing = 25.0 * sin(6.0 * t);
        fprintf(out, "%.6f 90 %.6f 0 %.6f 0", turns ? 100.0 * (1.0 - cos(t)) : 0.0, 100.0 * (turns ? sin(t) : t),
                turns ? t * 57.29577951 : 0.0);
        fprintf(out, " 0 %.6f 0 0 0 0 0 0 0 0 %.6f 0 0 0 0 0 0 0\n", swing, -swing);
    }
    fclose(out);
    return path;
}

static uint8_t *build(const char *text, size_t *count, convert_failure *failure)
{
    const char *inputs[2] = { write_bvh(0), write_bvh(1) };
    const char *lines = test_path("walk.match");
    byte_buffer out = { NULL, 0, 0, 0 };
    convert_options options;
    uint8_t *bytes;
    memset(&options, 0, sizeof options);
    memset(failure, 0, sizeof *failure);
    test_write_file(lines, text, strlen(text));
    options.texts[NOH_CHUNK_MATCH] = lines;
    if (convert_files(inputs, 2, &options, &out, failure)) return NULL;
    bytes = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    return bytes;
}

static int set_up(void **state)
{
    convert_failure failure;
    (void)state;
    good = build("rows 10 # a second\nclip straight calm\nclip * all\n", &good_count, &failure);
    if (!good) fail_msg("%s", failure.error.what);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(good);
    return 0;
}

static noh_match_table table_of(const noh_pack *pack)
{
    noh_match_table t;
    assert_true(noh_match_table_of(pack, &t));
    return t;
}

static uint32_t clip_named(const noh_pack *pack, const noh_match_table *t, const char *name)
{
    uint32_t i = 0;
    while (i < t->header->clip_count && strcmp(noh_pack_string(pack, t->clips[i].name), name) != 0) i++;
    assert_true(i < t->header->clip_count);
    return i;
}

/* A feature of a row, as well as its number knows it. */
static double feature_of(const noh_match_table *t, uint32_t row, uint32_t feature)
{
    int16_t numbers[NOH_MATCH_FEATURES];
    uint32_t place = 0;
    while (t->order[place] != row) place++;
    noh_match_row(t, place, numbers);
    return (double)t->means[feature] + numbers[feature] / (double)t->scales[feature];
}

static void features_are_as_moved(void **state)
{
    const noh_pack pack = test_open(good, good_count);
    const noh_match_table t = table_of(&pack);
    const uint32_t straight = clip_named(&pack, &t, "straight"), circle = clip_named(&pack, &t, "circle");
    (void)state;
    assert_int_equal(t.header->row_ticks, 4800);
    assert_int_equal(t.header->clip_count, 2);
    assert_int_equal(t.header->tag_count, 2);
    assert_int_equal(t.clips[straight].tags, 3);
    assert_int_equal(t.clips[circle].tags, 2);
    assert_in_range(t.clips[straight].row_count, 76, 77); /* all but the last third of a second */
    assert_int_equal(t.header->row_count, t.clips[0].row_count + t.clips[1].row_count);
    for (uint32_t n = 0; n < t.clips[straight].row_count; n++) {
        const uint32_t row = t.clips[straight].first_row + n;
        for (uint32_t i = 0; i < 3; i++) {
            const double s = (i + 1) / 3.0;
            assert_true(fabs(feature_of(&t, row, 15 + 2 * i)) < 6.0);
            assert_true(fabs(feature_of(&t, row, 16 + 2 * i) - 100.0 * s) < 6.0);
            assert_true(fabs(feature_of(&t, row, 21 + 2 * i)) < 0.06);
            assert_true(fabs(feature_of(&t, row, 22 + 2 * i) - 1.0) < 0.06);
        }
        assert_true(fabs(feature_of(&t, row, 14) - 100.0) < 6.0);
    }
    for (uint32_t n = 0; n < t.clips[circle].row_count; n++) {
        const uint32_t row = t.clips[circle].first_row + n;
        const double foot = -82.0 * sin(25.0 / 57.29577951 * sin(6.0 * n / 10.0));
        for (uint32_t i = 0; i < 3; i++) {
            const double s = (i + 1) / 3.0;
            assert_true(fabs(feature_of(&t, row, 15 + 2 * i) - 100.0 * (1.0 - cos(s))) < 6.0);
            assert_true(fabs(feature_of(&t, row, 16 + 2 * i) - 100.0 * sin(s)) < 6.0);
            assert_true(fabs(feature_of(&t, row, 21 + 2 * i) - sin(s)) < 0.06);
            assert_true(fabs(feature_of(&t, row, 22 + 2 * i) - cos(s)) < 0.06);
        }
        assert_true(fabs(feature_of(&t, row, 0) - 9.0) < 3.0);
        assert_true(fabs(feature_of(&t, row, 2) - foot) < 3.0);
        assert_true(fabs(feature_of(&t, row, 12)) < 6.0);
    }
}

static void its_rows_are_found(void **state)
{
    const noh_pack pack = test_open(good, good_count);
    const noh_match_table t = table_of(&pack);
    (void)state;
    for (uint32_t place = 0; place < t.header->row_count; place++) {
        noh_match_hit hit = { INT32_MAX, NOH_NONE, 0 };
        int16_t query[NOH_MATCH_FEATURES];
        noh_match_row(&t, place, query);
        noh_match_search(&t, query, 0, &hit);
        assert_int_equal(hit.cost, 0);
        assert_true(hit.row <= t.order[place]);
        hit.cost = INT32_MAX;
        noh_match_search(&t, query, 1, &hit);
        assert_true(t.clips[noh_match_clip_of(&t, hit.row)].tags & 1u);
    }
}

/* ---- lies ---- */

typedef struct forged {
    uint8_t *bytes;
    size_t count;
    noh_pack_chunk *chunk;
    noh_pack_match_header *h;
    noh_pack_match_clip *clips;
    noh_pack_match_tag *tags;
    float *numbers;
    uint16_t *order;
    int8_t *rows, *boxes[NOH_MATCH_LEVELS];
} forged;

static void forge(forged *f)
{
    uint8_t *base;
    f->count = good_count;
    f->bytes = test_aligned(good, f->count);
    f->chunk = pack_find(f->bytes, NOH_TAG_MATCH);
    assert_non_null(f->chunk);
    base = f->bytes + f->chunk->offset;
    f->h = (noh_pack_match_header *)(void *)base;
    f->clips = (noh_pack_match_clip *)(void *)(base + f->h->clips_offset);
    f->tags = (noh_pack_match_tag *)(void *)(base + f->h->tags_offset);
    f->numbers = (float *)(void *)(base + f->h->numbers_offset);
    f->order = (uint16_t *)(void *)(base + f->h->order_offset);
    f->rows = (int8_t *)(base + f->h->rows_offset);
    for (int i = 0; i < 3; i++) f->boxes[i] = (int8_t *)(base + f->h->boxes_offset[i]);
}

/* name, a word of the message, the lie */
#define FORGERIES(X)                                                          \
    X(axes, "count of a motion", f->h->root_axes = 16)                        \
    X(up, "count of a motion", f->h->root_up = 3)                             \
    X(no_rows, "count of a motion", f->h->row_count = 0)                      \
    X(rows_overflow, "count of a motion", f->h->row_count = 0xffffffffu)      \
    X(row_more, "begin", f->h->row_count += 600)                              \
    X(no_ticks, "count of a motion", f->h->row_ticks = 0)                     \
    X(ticks_huge, "count of a motion", f->h->row_ticks = 48001)               \
    X(no_clips, "count of a motion", f->h->clip_count = 0)                    \
    X(tags_overflow, "count of a motion", f->h->tag_count = 33)               \
    X(reserved, "count of a motion", f->h->reserved[1] = 1)                   \
    X(clips_elsewhere, "begin", f->h->clips_offset += 16)                     \
    X(order_elsewhere, "begin", f->h->order_offset = 0xfffffff0u)             \
    X(boxes_elsewhere, "begin", f->h->boxes_offset[2] = 0)                    \
    X(clip_first, "clip of a motion", f->clips[1].first_row -= 1)             \
    X(clip_empty, "clip of a motion", f->clips[0].row_count = 0)              \
    X(clip_long, "clip of a motion", f->clips[1].row_count += 1)              \
    X(clip_short, "belong to no clip", f->clips[1].row_count -= 1)            \
    X(clip_tag, "clip of a motion", f->clips[0].tags = 4)                     \
    X(clip_name, "name", f->clips[0].name_hash += 1)                          \
    X(tag_name, "name", f->tags[1].name_hash += 1)                            \
    X(mean_nan, "not finite", f->numbers[0] = (float)NAN)                     \
    X(scale_infinite, "not finite", f->numbers[30] = (float)INFINITY)         \
    X(scale_below, "scale of a motion", f->numbers[30] = -1.0f)               \
    X(order_beyond, "no such number", f->order[3] = 0xffff)                   \
    X(row_outside, "does not hold", f->rows[2] = f->rows[2] > 0 ? -127 : 127) \
    X(box_16, "does not hold", f->boxes[0][0] = 127)                          \
    X(box_64, "does not hold", f->boxes[1][NOH_MATCH_GROUP_BYTES] = -127)     \
    X(box_512, "does not hold", f->boxes[2][NOH_MATCH_GROUP_BYTES + 1] = -127)

#include "support/forgeries_template.h"

static void what_opens_can_be_searched(void **state)
{
    test_random r = test_random_from(31);
    uint32_t opened = 0, refused = 0;
    forged f;
    (void)state;
    forge(&f);
    for (int i = 0; i < test_rounds(4000); i++) {
        uint8_t *byte = (uint8_t *)f.h + test_random_below(&r, i % 2 ? 512 : f.chunk->bytes);
        const uint8_t kept = *byte;
        noh_pack pack;
        *byte = (uint8_t)(kept ^ 1u << test_random_below(&r, 8));
        pack_repair(f.bytes, good_count);
        if (noh_pack_open(f.bytes, good_count, &pack, NULL) == NOH_OK) {
            const noh_match_table t = table_of(&pack);
            noh_match_hit hit = { INT32_MAX, NOH_NONE, 0 }, all = hit;
            int16_t query[NOH_MATCH_FEATURES];
            for (uint32_t k = 0; k < NOH_MATCH_FEATURES; k++) query[k] = (int16_t)(test_random_below(&r, 200) - 100u);
            noh_match_search(&t, query, 0, &hit);
            noh_match_search_all(&t, query, 0, &all);
            assert_int_equal(hit.row, all.row);
            assert_int_equal(hit.cost, all.cost);
            opened++;
        } else {
            refused++;
        }
        *byte = kept;
    }
    free(f.bytes);
    for (size_t count = 0; count < good_count; count += 64) {
        uint8_t *cut = test_aligned(good, count);
        noh_pack pack;
        assert_int_not_equal(noh_pack_open(cut, count, &pack, NULL), NOH_OK);
        free(cut);
    }
    assert_true(opened > 0 && refused > 0);
}

/* ---- texts ---- */

static void bad_texts_are_refused(void **state)
{
    static const struct {
        const char *text, *what;
        uint32_t line;
    } rows[] = {
        { "# nothing\n", "clip NAME", 0 },
        { "clip\n", "clip NAME", 1 },
        { "\nclip run\n", "has the name 'run'", 2 },
        { "clip *\nfeet LeftFoot\n", "feet LEFT RIGHT", 2 },
        { "clip *\nfeet LeftFoot Paw\n", "no joint 'Paw'", 0 },
        { "rows 1\n", "2 to 60", 1 },
        { "rows many\n", "number", 1 },
        { "walk\n", "no statement", 1 },
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(rows); i++) {
        convert_failure failure;
        size_t count;
        if (build(rows[i].text, &count, &failure) || !strstr(failure.error.what, rows[i].what)) {
            fail_msg("%zu: '%s'", i, failure.error.what);
        }
        assert_int_equal(failure.line, rows[i].line);
    }
}

static void the_same_input_gives_the_same_bytes(void **state)
{
    convert_failure failure;
    size_t count;
    uint8_t *again = build("rows 10\nclip straight calm\nclip * all\n", &count, &failure);
    (void)state;
    assert_non_null(again);
    assert_int_equal(count, good_count);
    assert_memory_equal(again, good, good_count);
    free(again);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(features_are_as_moved), cmocka_unit_test(its_rows_are_found),
    cmocka_unit_test(lies_are_refused),      cmocka_unit_test(what_opens_can_be_searched),
    cmocka_unit_test(bad_texts_are_refused), cmocka_unit_test(the_same_input_gives_the_same_bytes),
};

TEST_MAIN(tests, set_up, tear_down)
