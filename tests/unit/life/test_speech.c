/* Tests of speech.c and phones.c: lips meet, rounding comes early, nothing jitters; on made-up speech and
 * on real speech with its phones. */
#include "noh/base.h"
#include "noh/face.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define MS 48u
#define PHONES 4096u

static const noh_viseme AA = NOH_VISEME_AA, PP = NOH_VISEME_PP, DD = NOH_VISEME_DD, OU = NOH_VISEME_OU;

static void visemes_at(const noh_speech *s, int64_t tick, float *v)
{
    float of[NOH_VISEME_COUNT + 1u], sum = 0.0f;
    of[NOH_VISEME_COUNT] = 7.0f;
    noh_speech_visemes(s, tick, of);
    assert_true(of[NOH_VISEME_COUNT] == 7.0f);
    memcpy(v, of, NOH_VISEME_COUNT * sizeof *v);
    for (int i = 0; i < NOH_VISEME_COUNT; i++) {
        assert_true(v[i] >= 0.0f && v[i] <= 1.00001f);
        sum += v[i];
    }
    assert_true(fabsf(sum - 1.0f) < 1e-5f);
}

/* ---- lips ---- */

/* Random speech: for each p, b, m, f, v there is a frame at 30 Hz, whatever the phase, at which the lips are wholly
 * shut; and so they are for 34 ms in a row. */
static void lips_meet_at_every_phase_of_30_hz(void **state)
{
    test_random r = test_random_from(3);
    (void)state;
    for (int round = 0; round < 50; round++) {
        noh_phone phones[60];
        uint32_t tick = 0;
        noh_speech s = { phones, 60, 0 };
        float v[NOH_VISEME_COUNT];
        for (uint32_t i = 0; i < 60; i++) {
            phones[i].start = tick;
            phones[i].viseme = i % 3u == 1u ? PP + (i / 3u) % 2u : test_random_below(&r, NOH_VISEME_COUNT);
            tick += MS * (20u + test_random_below(&r, 140));
        }
        s.end = tick;
        assert_int_equal(noh_speech_check(&s, NULL), NOH_OK);
        for (uint32_t i = 1; i < 60; i += 3) {
            const uint32_t end = i + 1u < 60 ? phones[i + 1u].start : s.end, middle = (phones[i].start + end) / 2u;
            for (int64_t at = -17 * (int64_t)MS; at <= 17 * (int64_t)MS; at += MS) {
                visemes_at(&s, (int64_t)middle + at, v);
                /* a lip on teeth gives way to lips that meet, and to nothing else */
                assert_true(v[NOH_VISEME_PP] + (phones[i].viseme == PP ? 0.0f : v[NOH_VISEME_FF]) > 0.9999f);
            }
        }
    }
}

/* "cupful": of 30 ms each, and in either order, lips meet for 34 ms and are on the teeth in the middle of the f. */
static void neighbours_each_have_their_time(void **state)
{
    const noh_phone after[] = { { 0, AA }, { 100 * MS, PP }, { 130 * MS, NOH_VISEME_FF }, { 160 * MS, AA } };
    const noh_phone before[] = { { 0, AA }, { 100 * MS, NOH_VISEME_FF }, { 130 * MS, PP }, { 160 * MS, AA } };
    const noh_speech cupful = { after, 4, 260 * MS }, halfback = { before, 4, 260 * MS };
    float v[NOH_VISEME_COUNT], w[NOH_VISEME_COUNT];
    (void)state;
    for (uint32_t at = 0; at <= 34; at++) {
        visemes_at(&cupful, (98 + at) * MS, v);
        visemes_at(&halfback, (128 + at) * MS, w);
        assert_true(v[NOH_VISEME_PP] > 0.9999f && w[NOH_VISEME_PP] > 0.9999f);
    }
    visemes_at(&cupful, 145 * MS, v);
    visemes_at(&halfback, 115 * MS, w);
    assert_true(v[NOH_VISEME_FF] > 0.9999f && w[NOH_VISEME_FF] > 0.9999f);
}

/* Without the rule that comes last, dominance alone leaves a short b between two open vowels half open. */
static void lips_shut_where_they_have_to(void **state)
{
    const noh_phone phones[] = { { 0, AA }, { 150 * MS, DD }, { 190 * MS, AA } };
    const noh_phone shut[] = { { 0, AA }, { 150 * MS, PP }, { 190 * MS, AA } };
    const noh_speech soft = { phones, 3, 340 * MS }, hard = { shut, 3, 340 * MS };
    float v[NOH_VISEME_COUNT];
    (void)state;
    visemes_at(&soft, 170 * MS, v);
    assert_true(v[AA] > 0.3f);
    visemes_at(&hard, 170 * MS, v);
    assert_true(v[AA] == 0.0f && v[PP] > 0.9999f);
}

static void rounding_begins_before_its_sound(void **state)
{
    const noh_phone phones[] = {
        { 0, NOH_VISEME_SS }, { 120 * MS, DD }, { 200 * MS, NOH_VISEME_RR }, { 280 * MS, OU }
    };
    const noh_speech s = { phones, 4, 480 * MS };
    float v[NOH_VISEME_COUNT], early;
    (void)state;
    visemes_at(&s, 180 * MS, v); /* "strew": a tenth of a second before the vowel */
    early = v[OU];
    visemes_at(&s, 380 * MS, v);
    print_message("rounded %.2f 100 ms before, %.2f within\n", (double)early, (double)v[OU]);
    assert_true(early > 0.2f && v[OU] > 0.7f);
}

static void it_is_silent_before_and_after(void **state)
{
    const noh_phone phones[] = { { 10 * MS, AA }, { 200 * MS, OU } };
    const noh_speech s = { phones, 2, 400 * MS };
    float v[NOH_VISEME_COUNT];
    (void)state;
    visemes_at(&s, -100000, v);
    assert_true(v[NOH_VISEME_SIL] > 0.999f);
    visemes_at(&s, 400 * MS + 100000, v);
    assert_true(v[NOH_VISEME_SIL] > 0.999f);
    visemes_at(&s, INT64_C(1) << 60, v);
    assert_true(v[NOH_VISEME_SIL] > 0.999f);
}

static void nothing_leaps(void **state)
{
    test_random r = test_random_from(11);
    noh_phone phones[200];
    noh_speech s = { phones, 200, 0 };
    float v[NOH_VISEME_COUNT], before[NOH_VISEME_COUNT];
    (void)state;
    for (uint32_t i = 0; i < 200; i++) {
        phones[i].start = s.end;
        phones[i].viseme = test_random_below(&r, NOH_VISEME_COUNT);
        s.end += MS * (30u + test_random_below(&r, 120));
    }
    visemes_at(&s, 0, before);
    for (uint32_t tick = MS; tick < s.end; tick += MS) { /* within a millisecond */
        visemes_at(&s, tick, v);
        for (int i = 0; i < NOH_VISEME_COUNT; i++) assert_true(fabsf(v[i] - before[i]) < 0.1f);
        memcpy(before, v, sizeof v);
    }
}

/* Lips that close on a wide open mouth take more than a frame at 30 Hz, so that nothing pops. */
static void lips_close_no_faster_than_people_do(void **state)
{
    test_random r = test_random_from(5);
    noh_phone phones[100];
    noh_speech s = { phones, 100, 0 };
    float most = 0.0f;
    (void)state;
    for (uint32_t i = 0; i < 100; i++) {
        phones[i].start = s.end;
        phones[i].viseme = i % 2u ? PP + (i / 2u) % 2u : AA;
        s.end += MS * (60u + test_random_below(&r, 140));
    }
    for (uint32_t tick = 0; tick + 33u * MS < s.end; tick += MS) {
        float v[NOH_VISEME_COUNT], w[NOH_VISEME_COUNT];
        visemes_at(&s, tick, v);
        visemes_at(&s, tick + 33u * MS, w);
        most = fmaxf(most, fabsf(w[AA] - v[AA]));
    }
    assert_true(most > 0.3f && most < 0.5f);
}

static void bad_speech_is_refused(void **state)
{
    const noh_phone falls[] = { { 100, AA }, { 100, OU } }, unknown[] = { { 0, AA }, { 10, NOH_VISEME_COUNT } };
    noh_speech s = { NULL, 0, 0 };
    noh_error error;
    (void)state;
    assert_int_equal(noh_speech_check(&s, &error), NOH_ERR_ARG);
    s.phones = falls;
    s.phone_count = 2;
    s.end = 200;
    assert_int_equal(noh_speech_check(&s, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, 0);
    s.phones = unknown;
    assert_int_equal(noh_speech_check(&s, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, 1);
    s.phone_count = 1;
    s.end = 0;
    assert_int_equal(noh_speech_check(&s, &error), NOH_ERR_DATA);
}

/* ---- phones ---- */

static void phones_have_shapes(void **state)
{
    static const struct {
        const char *phone;
        noh_viseme first, second;
    } cases[] = {
        { "M", NOH_VISEME_PP, NOH_VISEME_COUNT },
        { "AY1", NOH_VISEME_AA, NOH_VISEME_IH },
        { "OW0", NOH_VISEME_OH, NOH_VISEME_OU },
        { "JH", NOH_VISEME_CH, NOH_VISEME_COUNT },
        { "SIL", NOH_VISEME_SIL, NOH_VISEME_COUNT },
        { "XYZ", NOH_VISEME_COUNT, NOH_VISEME_COUNT },
        { "", NOH_VISEME_SIL, NOH_VISEME_COUNT },
        { "\xcb\x88"
          "a\xc9\xaa",
          NOH_VISEME_AA, NOH_VISEME_IH },                 /* stressed ai */
        { "t\xca\x83", NOH_VISEME_CH, NOH_VISEME_COUNT }, /* tsh */
        { "u\xcb\x90", NOH_VISEME_OU, NOH_VISEME_COUNT }, /* long u */
        { "o\xca\x8a", NOH_VISEME_OH, NOH_VISEME_OU },
        { "\xc5\x8b", NOH_VISEME_KK, NOH_VISEME_COUNT },
        { "\xcb\x90", NOH_VISEME_COUNT, NOH_VISEME_COUNT }, /* a mark alone */
        { "_:", NOH_VISEME_SIL, NOH_VISEME_COUNT },
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        noh_viseme second;
        assert_int_equal(noh_viseme_of_phone(cases[i].phone, &second), cases[i].first);
        assert_int_equal(second, cases[i].second);
    }
    assert_int_equal(noh_viseme_of_phone("B", NULL), NOH_VISEME_PP);
}

/* Phones with their times, one in a line: begin, end, name. */
static uint32_t read_phones(const char *path, noh_phone *phones, uint32_t *end)
{
    FILE *file = fopen(path, "r");
    double from, to;
    char name[32];
    uint32_t count = 0;
    if (!file) return 0;
    while (count + 2u < PHONES && fscanf(file, "%lf %lf %31s", &from, &to, name) == 3) {
        noh_viseme second;
        const noh_viseme first = noh_viseme_of_phone(name, &second);
        const uint32_t start = (uint32_t)(from * 48000.0);
        assert_int_not_equal(first, NOH_VISEME_COUNT);
        phones[count].start = start;
        phones[count++].viseme = first;
        *end = (uint32_t)(to * 48000.0);
        if (second != NOH_VISEME_COUNT) { /* two fifths of a diphthong are its second vowel */
            phones[count].start = start + (*end - start) * 3u / 5u;
            phones[count++].viseme = second;
        }
    }
    fclose(file);
    return count;
}

static int strongest(const float *v)
{
    int best = 0;
    for (int i = 1; i < NOH_VISEME_COUNT; i++) best = v[i] > v[best] ? i : best;
    return best;
}

/* On labelled speech: lips meet for every p, b, m; the strongest shape changes no oftener than phones do. */
static void real_speech_is_followed(void **state)
{
    static const char *const names[] = { "sense_0870", "sense_0880", "sense_0890", "bobby" };
    static noh_phone phones[PHONES];
    uint32_t files = 0;
    (void)state;
    for (size_t f = 0; f < sizeof names / sizeof names[0]; f++) {
        char file[64];
        const char *path;
        noh_speech s = { phones, 0, 0 };
        uint32_t changes = 0, closures = 0;
        float v[NOH_VISEME_COUNT];
        int last = -1;
        snprintf(file, sizeof file, "speech/%s.phones", names[f]);
        path = test_asset(file);
        s.phone_count = path ? read_phones(path, phones, &s.end) : 0;
        if (!s.phone_count) continue;
        files++;
        assert_int_equal(noh_speech_check(&s, NULL), NOH_OK);
        for (uint32_t i = 0; i < s.phone_count; i++) {
            const uint32_t end = i + 1u < s.phone_count ? phones[i + 1u].start : s.end;
            if (phones[i].viseme != NOH_VISEME_PP) continue;
            closures++;
            visemes_at(&s, (phones[i].start + end) / 2u, v);
            assert_true(v[NOH_VISEME_PP] > 0.5f && v[NOH_VISEME_PP] + v[NOH_VISEME_FF] > 0.9999f);
        }
        for (uint32_t tick = 0; tick < s.end; tick += 480) {
            visemes_at(&s, tick, v);
            changes += last >= 0 && strongest(v) != last;
            last = strongest(v);
        }
        print_message("%s: %u phones, %u closures, %.1f changes a second\n", names[f], s.phone_count, closures,
                      changes / (s.end / 48000.0));
        assert_true(changes < s.phone_count);
    }
    if (!files) test_skip("no labelled speech in NOH_ASSETS");
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lips_meet_at_every_phase_of_30_hz),
        cmocka_unit_test(neighbours_each_have_their_time),
        cmocka_unit_test(lips_shut_where_they_have_to),
        cmocka_unit_test(rounding_begins_before_its_sound),
        cmocka_unit_test(it_is_silent_before_and_after),
        cmocka_unit_test(nothing_leaps),
        cmocka_unit_test(lips_close_no_faster_than_people_do),
        cmocka_unit_test(bad_speech_is_refused),
        cmocka_unit_test(phones_have_shapes),
        cmocka_unit_test(real_speech_is_followed),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
