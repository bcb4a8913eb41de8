/* Tests of hearing.c: how fast the mouth of a recording without words moves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/face.h"
#include "speak/hearing.h"
#include "support/support.h"

#define RATE 16000u
#define SECONDS 6u

/* A buzz of 120 Hz through the first two resonances of an a, and pauses of a tenth of a second. */
static sound babble(void)
{
    static const double hertz[2] = { 750.0, 1250.0 };
    sound s = { test_zeros(RATE * SECONDS * sizeof(float)), RATE * SECONDS, RATE, 0, 0 };
    double state[2][2] = { { 0.0, 0.0 }, { 0.0, 0.0 } };
    for (size_t i = 0; i < s.count; i++) {
        double value = i % (RATE / 120u) == 0 && i / (RATE / 10u) % 4u != 3u ? 1.0 : 0.0;
        for (int k = 0; k < 2; k++) {
            const double r = exp(-3.14159265 * 90.0 / RATE), w = 6.2831853 * hertz[k] / RATE;
            const double out = value + 2.0 * r * cos(w) * state[k][0] - r * r * state[k][1];
            state[k][1] = state[k][0];
            state[k][0] = out;
            value = out;
        }
        s.samples[i] = (float)(0.005 * value);
    }
    return s;
}

static float open_at(const speech_track *t, uint32_t ms)
{
    float visemes[NOH_VISEME_COUNT], open = 0.0f;
    speech_track_visemes(t, (int64_t)ms * (NOH_TICKS_PER_SECOND / 1000), visemes);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) open += visemes[v] * viseme_open(v);
    return open;
}

static void a_mouth_closes_no_faster_than_people_do(void **state)
{
    sound s = babble();
    float most[2] = { 0.0f, 0.0f }, widest[2] = { 0.0f, 0.0f }, jaw[2] = { 0.0f, 0.0f };
    (void)state;
    for (int live = 0; live < 2; live++) {
        const hearing how = { live, 40.0, 0 };
        synthesis said;
        speech_track track;
        assert_int_equal(hearing_make(&s, &how, &said, &track), 0);
        for (uint32_t ms = 100; ms + 133u < SECONDS * 1000u; ms++) {
            most[live] = fmaxf(most[live], fabsf(open_at(&track, ms + 33u) - open_at(&track, ms)));
            widest[live] = fmaxf(widest[live], open_at(&track, ms));
        }
        for (uint32_t f = 1; f < track.frame_count; f++) {
            jaw[live] = fmaxf(jaw[live], fabsf(track.frames[f].open - track.frames[f - 1u].open));
        }
        synthesis_free(&said);
        speech_track_free(&track);
    }
    assert_true(widest[0] > 0.6f && widest[1] > 0.6f);
    assert_true(most[1] > 0.5f); /* what is heard now cannot be known before */
    assert_true(most[0] < 0.45f);
    assert_true(jaw[1] > 0.13f && jaw[0] < 0.13f); /* the curve "open" of --json, too */
    sound_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_mouth_closes_no_faster_than_people_do) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
