/* Tests of amplitude.c against the formulas of its source, whose errors are shown. */
#include "life/face/amplitude_internal.h"
#include "noh/base.h"
#include "noh/face.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

enum { RATE = 16000, WINDOW = RATE / 10, MAX_FRAMES = 1000 };

static int16_t sound[RATE * 70];
static noh_amplitude_frame frames[MAX_FRAMES];

/* A tone of `level`, so that the mean of |sample| is level itself: a square wave of 200 Hz. */
static void make_tone(size_t from, size_t count, int level)
{
    for (size_t i = from; i < from + count; i++) sound[i] = (int16_t)(i / 40 % 2 ? level : -level);
}

static uint32_t take_all(noh_amplitude *a, uint32_t have)
{
    while (have < MAX_FRAMES && noh_amplitude_next(a, &frames[have])) have++;
    return have;
}

static uint32_t hear(noh_amplitude *a, size_t count, size_t chunk)
{
    uint32_t have = 0;
    for (size_t at = 0; at < count;) {
        at += noh_amplitude_hear(a, sound + at, count - at < chunk ? count - at : chunk);
        have = take_all(a, have);
    }
    noh_amplitude_end(a);
    return take_all(a, have);
}

static uint32_t hear_at(uint32_t rate, uint32_t channels, size_t count)
{
    noh_amplitude a;
    assert_int_equal(noh_amplitude_init(&a, rate, channels, NULL), NOH_OK);
    return hear(&a, count, 997);
}

/* ---- the source, as it is printed ---- */

typedef struct wave {
    const int16_t *samples;
    int count, rate, channels;
} wave;

static short literal_average(const wave *w, float start, float end)
{
    const int from = (int)((float)w->rate * start) * w->channels, to = (int)((float)w->rate * end) * w->channels;
    float c, avg = 0.0f;
    if (from >= to) return 0;
    c = 1.0f / (float)(to - from);
    for (int i = from; i < to && i < w->count; i++) avg += (float)abs(w->samples[i]) * c;
    if (avg > SHRT_MAX - 1) avg = SHRT_MAX - 1;
    return (short)avg;
}

static float literal_loud(const wave *w)
{
    int most = 0;
    for (int i = 0; i < w->count; i++) most = abs(w->samples[i]) > most ? abs(w->samples[i]) : most;
    return (float)most * 0.3f;
}

static int literal_windows(float length, float *last)
{
    int count = 0;
    for (float i = 0.0f; i < length; i += 0.1f) {
        *last = i;
        count++;
    }
    return count;
}

/* ---- the mean of a window ---- */

static void a_window_that_is_cut_short_is_as_loud(void **state)
{
    const size_t count = RATE + WINDOW / 4; /* a quarter of a window at the end */
    const wave w = { sound, (int)count, RATE, 1 };
    uint32_t have;
    (void)state;
    make_tone(0, count, 8000);
    assert_true(literal_average(&w, 0.5f, 0.6f) > 7900);
    assert_true(literal_average(&w, 1.0f, 1.1f) < 2100);
    have = hear_at(RATE, 1, count);
    assert_int_equal(have, 12); /* ten, the one that is cut, and the one that shuts the mouth */
    for (uint32_t f = 0; f < 11; f++) assert_int_equal(frames[f].mean, 8000);
}

static void channels_are_counted_together(void **state)
{
    (void)state;
    for (size_t i = 0; i < RATE; i++) {
        sound[2 * i] = i % 2 ? 4000 : -4000;
        sound[2 * i + 1] = i % 2 ? 2000 : -2000;
    }
    assert_int_equal(hear_at(RATE, 2, 2 * RATE), 11);
    for (uint32_t f = 0; f < 10; f++) assert_int_equal(frames[f].mean, 3000);
}

static void the_lowest_sample_is_as_loud_as_it_is(void **state)
{
    (void)state;
    for (size_t i = 0; i < RATE; i++) sound[i] = -32768;
    hear_at(RATE, 1, RATE);
    assert_int_equal(frames[0].mean, 32768);
}

/* ---- the rule ---- */

static void silence_shuts_the_mouth(void **state)
{
    const wave w = { sound, RATE, RATE, 1 };
    (void)state;
    memset(sound, 0, sizeof sound);
    assert_true(isnan((float)literal_average(&w, 0.0f, 0.1f) / literal_loud(&w)));
    assert_int_equal(hear_at(RATE, 1, RATE), 11);
    for (uint32_t f = 0; f < 11; f++) {
        assert_int_equal(frames[f].viseme, NOH_VISEME_SIL);
        assert_true(frames[f].weight == 0.0f);
    }
    {
        float weight;
        assert_int_equal(noh_amplitude_shape(0, 0, &weight), NOH_VISEME_SIL);
        assert_true(weight == 0.0f);
    }
}

static void windows_do_not_drift(void **state)
{
    float last = 0.0f;
    (void)state;
    assert_int_equal(literal_windows(3.0f, &last), 31);
    assert_int_equal(literal_windows(60.0f, &last), 601);
    assert_true(last > 59.99f); /* it begins where the sound ends */
    make_tone(0, RATE * 60, 3000);
    assert_int_equal(hear_at(RATE, 1, RATE * 60), 601); /* 600, and the one that shuts the mouth */
    assert_int_equal(frames[599].mean, 3000);
    assert_int_equal(frames[600].mean, 0);
    make_tone(0, 11025 * 3, 3000); /* a tenth of a second is no whole number of samples */
    assert_int_equal(hear_at(11025, 1, 11025 * 3), 31);
    assert_int_equal(frames[29].mean, 3000);
}

static void one_click_mutes_nothing(void **state)
{
    const wave w = { sound, RATE * 4, RATE, 1 };
    float before = 0.0f, after = 0.0f;
    (void)state;
    make_tone(0, RATE * 4, 1500);
    assert_true((float)literal_average(&w, 0.2f, 0.3f) / literal_loud(&w) > 0.9f);
    sound[RATE] = 32767;
    assert_true((float)literal_average(&w, 0.2f, 0.3f) / literal_loud(&w) < 0.2f); /* all of it has become silent */
    {
        noh_amplitude a;
        assert_int_equal(noh_amplitude_init(&a, RATE, 1, NULL), NOH_OK);
        for (int again = 0; again < 20; again++) {
            hear(&a, RATE * 4, 997);
            noh_amplitude_restart(&a);
        }
        hear(&a, RATE * 4, 997);
    }
    before = frames[9].weight;
    after = frames[11].weight;
    assert_int_equal(frames[9].viseme, NOH_VISEME_AA);
    assert_int_equal(frames[11].viseme, NOH_VISEME_AA);
    assert_true(before >= 0.9f && after >= 0.9f);
}

static void shapes_change_at_the_sources_thresholds(void **state)
{
    static const struct {
        uint32_t mean;
        noh_viseme viseme;
        float weight;
    } cases[] = { { 0, NOH_VISEME_SIL, 0.0f },    { 590, NOH_VISEME_SIL, 0.0f }, { 610, NOH_VISEME_IH, 0.3f },
                  { 1050, NOH_VISEME_IH, 0.75f }, { 1210, NOH_VISEME_E, 0.3f },  { 1650, NOH_VISEME_E, 0.5f },
                  { 2110, NOH_VISEME_AA, 0.3f },  { 3000, NOH_VISEME_AA, 1.0f }, { 30000, NOH_VISEME_AA, 1.0f } };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        float weight;
        assert_int_equal(noh_amplitude_shape(cases[i].mean, 10000, &weight), cases[i].viseme);
        assert_true(fabsf(weight - cases[i].weight) < 1e-3f);
    }
}

/* ---- played ---- */

/* m_visemeIndex begins at 1, and moves by one a frame of the game. */
static void one_window_is_enough(void **state)
{
    uint32_t have;
    (void)state;
    make_tone(0, WINDOW, 6000);
    have = hear_at(RATE, 1, WINDOW);
    assert_int_equal(have, 2); /* the source has one, and plays the second */
    assert_int_equal(frames[1].viseme, NOH_VISEME_SIL);
}

/* `if (time > next) index++` once a frame of the game: after one frame that lasts a second the source is still at its
 * second window, and takes nine frames more to be where the sound is. A position follows from the time alone. */
static void a_long_frame_does_not_fall_behind(void **state)
{
    float visemes[NOH_VISEME_COUNT];
    uint32_t have, index = 1;
    const double after_s = 1.05;
    (void)state;
    make_tone(0, WINDOW * 9, 0); /* loud from the tenth window on */
    make_tone(WINDOW * 9, WINDOW * 3, 12000);
    have = hear_at(RATE, 1, WINDOW * 12);
    if (after_s > 0.1 * (double)index) index++; /* the long frame */
    assert_int_equal(frames[index].viseme, NOH_VISEME_SIL);
    index = (uint32_t)(after_s / 0.1);
    assert_true(index + 1u < have);
    noh_amplitude_between(&frames[index], &frames[index + 1u], (float)(after_s / 0.1 - index), visemes);
    assert_true(visemes[NOH_VISEME_SIL] < 0.5f);
}

static void between_windows_weights_are_shared(void **state)
{
    const noh_amplitude_frame from = { 0, 0, NOH_VISEME_AA, 0.8f }, to = { 1, 0, NOH_VISEME_IH, 0.4f };
    static const float parts[] = { -1.0f, 0.0f, 0.25f, 0.5f, 1.0f, 7.0f };
    (void)state;
    for (int i = 0; i < 6; i++) {
        const float p = fminf(fmaxf(parts[i], 0.0f), 1.0f);
        float visemes[NOH_VISEME_COUNT], sum = 0.0f;
        noh_amplitude_between(&from, &to, parts[i], visemes);
        assert_true(fabsf(visemes[NOH_VISEME_AA] - 0.8f * (1.0f - p)) < 1e-6f);
        assert_true(fabsf(visemes[NOH_VISEME_IH] - 0.4f * p) < 1e-6f);
        for (int v = 0; v < NOH_VISEME_COUNT; v++) sum += visemes[v];
        assert_true(fabsf(sum - 1.0f) < 1e-6f);
    }
}

/* ---- any chunks, any numbers ---- */

static void chunks_of_any_size_give_the_same_windows(void **state)
{
    static const size_t chunks[] = { 1, 7, 160, 4096, 1000000 };
    noh_amplitude_frame first[64];
    (void)state;
    for (size_t i = 0; i < RATE * 3; i++) sound[i] = (int16_t)((i * 7919 % 20011) * (i / 3000 % 4) / 3);
    for (int c = 0; c < 5; c++) {
        noh_amplitude a;
        uint32_t have;
        assert_int_equal(noh_amplitude_init(&a, RATE, 1, NULL), NOH_OK);
        have = hear(&a, RATE * 3, chunks[c]);
        assert_int_equal(have, 31);
        if (!c) memcpy(first, frames, have * sizeof *frames);
        assert_memory_equal(first, frames, have * sizeof *frames);
    }
}

static void wrong_rates_and_channels_are_refused(void **state)
{
    noh_amplitude a;
    noh_error error;
    (void)state;
    assert_int_equal(noh_amplitude_init(&a, 0, 1, &error), NOH_ERR_ARG);
    assert_int_equal(noh_amplitude_init(&a, 192001, 1, &error), NOH_ERR_ARG);
    assert_int_equal(noh_amplitude_init(&a, RATE, 0, &error), NOH_ERR_ARG);
    assert_int_equal(noh_amplitude_init(&a, RATE, 65, &error), NOH_ERR_ARG);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_window_that_is_cut_short_is_as_loud),
        cmocka_unit_test(channels_are_counted_together),
        cmocka_unit_test(the_lowest_sample_is_as_loud_as_it_is),
        cmocka_unit_test(silence_shuts_the_mouth),
        cmocka_unit_test(windows_do_not_drift),
        cmocka_unit_test(one_click_mutes_nothing),
        cmocka_unit_test(shapes_change_at_the_sources_thresholds),
        cmocka_unit_test(one_window_is_enough),
        cmocka_unit_test(a_long_frame_does_not_fall_behind),
        cmocka_unit_test(between_windows_weights_are_shared),
        cmocka_unit_test(chunks_of_any_size_give_the_same_windows),
        cmocka_unit_test(wrong_rates_and_channels_are_refused),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
