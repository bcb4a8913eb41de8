/* Tests of runtime/face/face*.c: rates, distributions and aims of a simulated hour against the literature's. */
#include "life/face/face_internal.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/low_core.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define SECOND 48000u
#define HOUR_STEPS (3600u * 200u)
#define STEP (SECOND / 200u) /* 5 ms */
#define DEGREES (180.0 / 3.14159265358979)

static const noh_face_desc desc = { .eyes = { { 0.032f, 0.09f, 0.08f }, { -0.032f, 0.09f, 0.08f } } };

static noh_face face_of(uint32_t seed, uint32_t flags)
{
    noh_face face;
    assert_int_equal(noh_face_init(&face, &desc, seed, flags, NULL), NOH_OK);
    return face;
}

static noh_face_pose pose_of(const noh_face *face)
{
    noh_face_pose pose;
    noh_face_pose_of(face, &desc, &pose);
    return pose;
}

/* ---- blinks ---- */

/* Times in seconds at which the lids begin to close within an hour. */
static uint32_t blink_hour(uint32_t seed, noh_activity activity, uint32_t flags, double *starts, uint32_t most)
{
    noh_face face = face_of(seed, flags);
    uint32_t count = 0;
    float before = 0.0f;
    noh_face_set_activity(&face, activity);
    for (uint32_t i = 0; i < HOUR_STEPS; i++) {
        float now;
        noh_face_step(&face, &desc, STEP);
        now = pose_of(&face).blink;
        if (before == 0.0f && now > 0.0f && count < most) starts[count++] = (double)i / 200.0;
        before = now;
    }
    return count;
}

static void blinks_come_at_their_rates(void **state)
{
    static const double rates[] = { 17.0, 26.0, 4.5 };
    static double starts[4096];
    (void)state;
    test_skip_emulated("hours of blinks");
    for (int a = 0; a < 3; a++) {
        double sum = 0.0;
        for (uint32_t seed = 1; seed <= 4; seed++) {
            sum += blink_hour(seed, (noh_activity)a, 0, starts, 4096) / 60.0 / 4.0;
        }
        print_message("activity %d: %.2f blinks a minute\n", a, sum);
        assert_true(fabs(sum - rates[a]) <= 0.05 * rates[a]);
    }
}

/* The same without a look at the lids: when each blink began, by what a face remembers. An hour of a face whose clock
 * advances by 0.1 s is the same hour. */
static uint32_t remembered_hour(uint32_t seed, noh_activity activity, double *starts, uint32_t most)
{
    noh_face face = face_of(seed, 0);
    uint32_t count = 0, before;
    noh_face_set_activity(&face, activity);
    before = face.blink_start;
    for (uint32_t i = 0; i < 36000u; i++) {
        noh_face_step(&face, &desc, SECOND / 10u);
        if (face.blink_start == before) continue;
        before = face.blink_start;
        for (uint32_t k = 0; k < face.blinking && count < most; k++)
            starts[count++] = (double)before / SECOND + 0.3 * k;
    }
    return count;
}

static double distance_to_log_normal(double *x, uint32_t n);

/* Not the mean of many people alone: of each of 64 in three activities, with the blinks that go with looks. */
static void each_person_blinks_at_the_rate(void **state)
{
    static const double rates[] = { 17.0, 26.0, 4.5 };
    static double starts[4096];
    double off = 0.0, distance = 0.0;
    (void)state;
    test_skip_emulated("hours of blinks");
    for (uint32_t seed = 1; seed <= 64; seed++) {
        for (int a = 0; a < 3; a++) {
            const uint32_t n = remembered_hour(seed, (noh_activity)a, starts, 4096);
            off = fmax(off, fabs(n / 60.0 - rates[a]) / rates[a]);
        }
    }
    for (uint32_t seed = 1; seed <= 64; seed++) {
        noh_face face = face_of(seed, NOH_FACE_NO_WANDER);
        uint32_t before = face.blink_start, count = 0;
        double last = 0.0;
        for (uint32_t i = 0; i < 36000u; i++) {
            noh_face_step(&face, &desc, SECOND / 10u);
            if (face.blink_start == before) continue;
            before = face.blink_start;
            if (last > 0.0 && face.blinking == 1) starts[count++] = (double)before / SECOND - last;
            last = face.blinking == 1 ? (double)before / SECOND : 0.0;
        }
        distance = fmax(distance, distance_to_log_normal(starts, count));
    }
    print_message("64 people: an hour's rate is off by %.1f %% at most, the distance at most %.3f\n", 100.0 * off,
                  distance);
    assert_true(off <= 0.05 && distance < 1.035);
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The largest distance between the distribution of n logarithms and the normal one of their mean and deviation, times
 * sqrt(n): above 1.035 with a probability of 1 % (Lilliefors). */
static double distance_to_log_normal(double *x, uint32_t n)
{
    double mean = 0.0, square = 0.0, worst = 0.0;
    for (uint32_t i = 0; i < n; i++) mean += (x[i] = log(x[i])) / n;
    for (uint32_t i = 0; i < n; i++) square += (x[i] - mean) * (x[i] - mean) / n;
    qsort(x, n, sizeof *x, ascending);
    for (uint32_t i = 0; i < n; i++) {
        const double p = 0.5 * erfc(-(x[i] - mean) / sqrt(2.0 * square));
        worst = fmax(worst, fmax(p - i / (double)n, (i + 1.0) / n - p));
    }
    return worst * sqrt((double)n);
}

static void intervals_are_log_normal(void **state)
{
    static double starts[4096];
    (void)state;
    test_skip_emulated("hours of blinks");
    for (int a = 0; a < 3; a++) {
        uint32_t n = blink_hour(77, (noh_activity)a, NOH_FACE_NO_WANDER, starts, 4096), count = 0;
        double distance;
        for (uint32_t i = 1; i < n; i++) {
            const double interval = starts[i] - starts[i - 1u];
            if (interval > 0.36) starts[count++] = interval; /* the two of a double blink are one */
        }
        distance = distance_to_log_normal(starts, count);
        print_message("activity %d: %u intervals, distance %.3f\n", a, count, distance);
        assert_true(distance < 1.035);
    }
    /* Granberg's timer (Character Animation with Direct3D, chapter 9): 1.5 to 5.5 s even, in time that runs at 0.8 */
    srand(1);
    for (uint32_t i = 0; i < 1020; i++) starts[i] = (1.5 + (rand() % 4000) / 1000.0) / 0.8 + 0.1875;
    assert_true(distance_to_log_normal(starts, 1020) > 1.035);
}

/* ---- the mode of four channels ---- */

/* Granberg's timers: blinks of 0.1875 s every 1.875 to 6.875 s after the last one, emotions that change by 1 a second
 * and hold for 2 to 8 s; whatever the length of a step. */
static void four_channels_keep_the_timers(void **state)
{
    uint32_t shortest = UINT32_MAX, longest = 0;
    (void)state;
    test_skip_emulated("hours of blinks");
    for (uint32_t seed = 0; seed < 20; seed++) {
        noh_face face = face_of(seed, NOH_FACE_FOUR);
        float blink = 0.0f, felt = 0.0f;
        uint32_t opened = 0, shut = 0, full = 0, last = NOH_EMOTION_COUNT, moods = 0;
        for (uint32_t ms = 0; ms < 120000; ms++) {
            noh_face_pose pose;
            noh_face_four four;
            noh_face_step(&face, &desc, SECOND / 1000u);
            pose = pose_of(&face);
            noh_face_four_of(&pose, NULL, &four);
            assert_true(four.weights[0] == pose.blink && fabsf(four.weights[1] - felt) <= 0.00101f);
            if (pose.blink > 0.0f && blink == 0.0f) {
                if (opened) assert_true(ms - opened >= 1874 && ms - opened <= 6877);
                shut = ms;
            }
            if (pose.blink == 0.0f && blink > 0.0f) {
                assert_true(ms - shut >= 186 && ms - shut <= 189);
                opened = ms;
            }
            if (four.weights[1] == 1.0f && felt < 1.0f) full = ms;
            if (four.weights[1] < 1.0f && felt == 1.0f) {
                const uint32_t held = ms - full;
                assert_true(held >= 1999 && held <= 8001);
                shortest = held < shortest ? held : shortest;
                longest = held > longest ? held : longest;
            }
            if (four.emotion != NOH_EMOTION_COUNT && four.emotion != last) moods++, last = four.emotion;
            blink = pose.blink;
            felt = four.weights[1];
        }
        assert_true(opened && moods >= 12 && moods <= 31);
    }
    assert_true(shortest < 2600 && longest > 7400); /* of some three hundred */
}

/* The source's lid is a sine that is looked at once a frame, and its fades add the length of a frame: at 5 frames a
 * second half of the blinks are not seen shut, and weights pass 1 and 0. */
static void fades_end_at_their_goals(void **state)
{
    double w = 0.0, worst = 0.0;
    noh_face coarse = face_of(6, NOH_FACE_FOUR), fine = coarse;
    (void)state;
    for (int i = 0; i < 4; i++) worst = fmax(worst, w += 0.3); /* += dt while w < 1 */
    assert_true(worst > 1.0);
    for (uint32_t i = 0; i < 1000; i++) {
        noh_face_pose a, b;
        noh_face_step(&coarse, &desc, 14400);
        for (uint32_t k = 0; k < 48; k++) noh_face_step(&fine, &desc, 300);
        a = pose_of(&coarse);
        b = pose_of(&fine);
        assert_memory_equal(&a, &b, sizeof a);
        for (int e = 0; e < NOH_EMOTION_COUNT; e++) assert_true(a.emotions[e] >= 0.0f && a.emotions[e] <= 1.0f);
    }
}

static void four_channels_hold_the_two_strongest_shapes(void **state)
{
    float visemes[15] = { 0 }, back[15], sum = 0.0f;
    noh_face_four four;
    (void)state;
    visemes[10] = 0.9f;
    visemes[13] = 0.6f;
    visemes[4] = 0.5f;
    noh_face_four_of(NULL, visemes, &four);
    assert_true(four.speech[0] == 10 && four.speech[1] == 13 && four.emotion == NOH_EMOTION_COUNT);
    assert_true(fabsf(four.weights[2] - 0.6f) < 1e-6f && fabsf(four.weights[3] - 0.4f) < 1e-6f);
    noh_face_four_visemes(&four, back);
    for (int v = 0; v < 15; v++) sum += back[v];
    assert_true(fabsf(sum - 1.0f) < 1e-6f && back[4] == 0.0f && back[10] == four.weights[2]);
}

static void emotions_of_four_channels_may_be_called(void **state)
{
    noh_face face = face_of(3, NOH_FACE_FOUR), calm = face_of(3, NOH_FACE_FOUR | NOH_FACE_CALM);
    noh_face_pose pose;
    (void)state;
    noh_face_step(&face, &desc, SECOND);
    assert_int_equal(noh_face_set_emotion(&face, NOH_EMOTION_FEAR, 0.5f, 0, SECOND, 0, NULL), NOH_OK);
    noh_face_step(&face, &desc, SECOND + SECOND / 2u);
    pose = pose_of(&face);
    assert_true(pose.emotions[NOH_EMOTION_FEAR] == 0.5f);
    noh_face_step(&face, &desc, SECOND);
    assert_true(fabsf(pose_of(&face).emotions[NOH_EMOTION_FEAR] - 0.25f) < 1e-5f);
    noh_face_set_flags(&face, 0);
    assert_true(pose_of(&face).emotions[NOH_EMOTION_FEAR] == 0.0f);
    noh_face_set_flags(&face, NOH_FACE_FOUR);
    noh_face_skip(&face, &desc, 100000ll * SECOND);
    noh_face_step(&face, &desc, 2u * SECOND);
    pose = pose_of(&calm);
    noh_face_step(&calm, &desc, 600u * SECOND);
    {
        const noh_face_pose still = pose_of(&calm);
        assert_memory_equal(&pose, &still, sizeof pose);
    }
}

/* ---- lids ---- */

static void lids_shut_and_open_again(void **state)
{
    noh_face face = face_of(5, NOH_FACE_CALM);
    double shut = 0.0, down = 0.0, up = 0.0;
    float before = 0.0f;
    (void)state;
    noh_face_blink(&face);
    for (uint32_t i = 0; i < 500; i++) {
        float now;
        noh_face_step(&face, &desc, SECOND / 1000u);
        now = pose_of(&face).blink;
        assert_true(now >= 0.0f && now <= 1.0f);
        shut += now == 1.0f;
        down += now > before && now < 1.0f;
        up += now < before;
        before = now;
    }
    print_message("%g ms down, %g shut, %g up\n", down, shut, up);
    assert_true(down >= 70 && down <= 100 && shut >= 20 && shut <= 51 && up >= 149 && up <= 201 && before == 0.0f);
}

static void a_blink_with_a_look_takes_the_place_of_the_next(void **state)
{
    noh_face face = face_of(9, 0);
    uint32_t count = 0;
    float before = 0.0f;
    (void)state;
    test_skip_emulated("hours of blinks");
    for (uint32_t i = 0; i < HOUR_STEPS; i++) {
        const float side = i / 600u % 2u ? 1.0f : -1.0f; /* from side to side every three seconds */
        const float point[3] = { side, 0.1f, 1.0f };
        float now;
        if (i % 600u == 0) assert_int_equal(noh_face_look_at(&face, &desc, point, NULL), NOH_OK);
        noh_face_step(&face, &desc, STEP);
        now = pose_of(&face).blink;
        count += before == 0.0f && now > 0.0f;
        before = now;
    }
    print_message("%.2f a minute with 1200 large shifts an hour\n", count / 60.0);
    assert_true(fabs(count / 60.0 - 17.0) <= 0.1 * 17.0);
}

/* ---- gaze ---- */

/* The direction of an eye in neck space, from the head's rotation and the eye's angles. */
static void eye_way(const noh_face_pose *pose, int eye, double way[3])
{
    const double yaw = (double)pose->eyes[eye][0], pitch = (double)pose->eyes[eye][1];
    float v[3] = { (float)(sin(yaw) * cos(pitch)), (float)sin(pitch), (float)(cos(yaw) * cos(pitch)) };
    noh_quat_rotate(pose->head, v, v);
    for (int i = 0; i < 3; i++) way[i] = (double)v[i];
}

/* How far an eye misses a point, degrees. */
static double miss(const noh_face_pose *pose, int eye, const float point[3])
{
    float centre[3];
    double way[3], to[3], dot = 0.0, cross[3], length = 0.0;
    memcpy(centre, desc.eyes[eye], sizeof centre);
    noh_quat_rotate(pose->head, centre, centre);
    eye_way(pose, eye, way);
    for (int i = 0; i < 3; i++) {
        to[i] = (double)point[i] - (double)centre[i];
        dot += to[i] * way[i];
    }
    for (int i = 0; i < 3; i++) {
        cross[i] = to[(i + 1) % 3] * way[(i + 2) % 3] - to[(i + 2) % 3] * way[(i + 1) % 3];
        length += cross[i] * cross[i];
    }
    return atan2(sqrt(length), dot) * DEGREES;
}

static void each_eye_aims_at_its_target(void **state)
{
    double worst = 0.0;
    (void)state;
    for (uint32_t i = 0; i < 2000; i++) {
        noh_face face = face_of(i, i % 2u ? NOH_FACE_CALM : NOH_FACE_NO_WANDER);
        const double distance = 0.3 * pow(10.0 / 0.3, (double)(i % 50u) / 49.0);
        const double yaw = ((double)(i * 37u % 101u) - 50.0) / DEGREES,
                     pitch = ((double)(i * 53u % 41u) - 20.0) / DEGREES;
        const float point[3] = { (float)(distance * sin(yaw) * cos(pitch)), (float)(0.09 + distance * sin(pitch)),
                                 (float)(0.08 + distance * cos(yaw) * cos(pitch)) };
        noh_face_pose pose;
        assert_int_equal(noh_face_look_at(&face, &desc, point, NULL), NOH_OK);
        noh_face_step(&face, &desc, 2u * SECOND);
        pose = pose_of(&face);
        worst = fmax(worst, fmax(miss(&pose, 0, point), miss(&pose, 1, point)));
    }
    print_message("the worst aim is %.4f degrees off\n", worst);
    assert_true(worst <= 0.1);
}

/* Saccades of 2 to 28 degrees: how long the eyes move, sampled at 1 kHz. */
static void saccades_follow_the_main_sequence(void **state)
{
    (void)state;
    for (uint32_t size = 2; size <= 28; size += 2) {
        noh_face face = face_of(size, NOH_FACE_CALM);
        const double half = 0.5 * size / DEGREES;
        const float from[3] = { (float)(-50.0 * sin(half)), 0.09f, (float)(50.0 * cos(half)) };
        const float to[3] = { (float)(50.0 * sin(half)), 0.09f, (float)(50.0 * cos(half)) };
        const double expected_ms = 21.0 + 2.2 * size;
        double begin = -1.0, end = -1.0;
        float before[3] = { 0 }, yaw;
        noh_face_look_at(&face, &desc, from, NULL);
        noh_face_step(&face, &desc, 5u * SECOND);
        before[0] = pose_of(&face).eyes[0][0] + pose_of(&face).head_angles[0];
        noh_face_look_at(&face, &desc, to, NULL);
        for (uint32_t i = 0; i < 20000; i++) {
            noh_face_step(&face, &desc, 24);
            yaw = pose_of(&face).eyes[0][0] + pose_of(&face).head_angles[0];
            if (fabs((double)(yaw - before[0])) > 1e-5) {
                begin = begin < 0.0 ? i * 0.5 : begin;
                end = i * 0.5;
            }
            before[0] = yaw;
        }
        assert_true(begin >= 140.0 && begin <= 260.0);
        if (fabs(end - begin - expected_ms) > 0.05 * expected_ms + 1.5) {
            print_message("%u degrees: %.1f ms, expected %.1f\n", size, end - begin, expected_ms);
            fail();
        }
    }
}

static void eyes_stay_within_their_limits_and_the_head_helps(void **state)
{
    noh_face face = face_of(3, NOH_FACE_CALM);
    const float aside[3] = { 2.0f, 0.1f, 0.5f }, near_ahead[3] = { 0.4f, 0.1f, 2.0f };
    noh_face_pose pose;
    (void)state;
    noh_face_look_at(&face, &desc, aside, NULL);
    for (uint32_t i = 0; i < 400; i++) {
        noh_face_step(&face, &desc, STEP);
        pose = pose_of(&face);
        assert_true(fabs((double)pose.eyes[0][0]) <= 35.01 / DEGREES &&
                    fabs((double)pose.eyes[1][0]) <= 35.01 / DEGREES);
    }
    assert_true((double)pose.head_angles[0] * DEGREES > 40.0 && miss(&pose, 0, aside) < 0.1);
    noh_face_look_at(&face, &desc, near_ahead, NULL);
    noh_face_step(&face, &desc, 3u * SECOND);
    pose = pose_of(&face);
    assert_true(fabs((double)pose.head_angles[0]) * DEGREES < 0.01); /* 11 degrees: the eyes alone */
}

/* A target that goes round behind: the head turns as far as it may, and changes sides once. */
static void a_target_behind_is_looked_at_over_one_shoulder(void **state)
{
    noh_face face = face_of(5, NOH_FACE_CALM);
    (void)state;
    for (int d = 0; d < 360; d++) {
        const float yaw = (float)(d / DEGREES), point[3] = { 3.0f * sinf(yaw), 0.09f, 3.0f * cosf(yaw) };
        noh_face_pose pose;
        assert_int_equal(noh_face_follow(&face, &desc, point, NULL), NOH_OK);
        noh_face_step(&face, &desc, SECOND);
        pose = pose_of(&face);
        if (d > 112 && d < 198) assert_true(fabs((double)pose.head_angles[0] * DEGREES - 75.0) < 0.2);
        if (d > 202 && d < 248) assert_true(fabs((double)pose.head_angles[0] * DEGREES + 75.0) < 0.2);
    }
    for (int n = 0; n < 50; n++) { /* to and fro behind */
        const float point[3] = { n & 1 ? 0.3f : -0.3f, 0.09f, -3.0f };
        assert_int_equal(noh_face_look_at(&face, &desc, point, NULL), NOH_OK);
        noh_face_step(&face, &desc, SECOND);
        if (n) assert_true((double)pose_of(&face).head_angles[0] * DEGREES < -74.0);
    }
}

static void lids_follow_the_eyes_at_once(void **state)
{
    noh_face face = face_of(4, NOH_FACE_CALM);
    const float below[3] = { 0.0f, -0.3f, 1.0f };
    (void)state;
    noh_face_look_at(&face, &desc, below, NULL);
    for (uint32_t i = 0; i < 200; i++) {
        noh_face_pose pose;
        double pitch;
        noh_face_step(&face, &desc, STEP);
        pose = pose_of(&face);
        pitch = 0.5 * ((double)pose.eyes[0][1] + (double)pose.eyes[1][1]) * DEGREES;
        assert_true(fabs((double)pose.lids_down - fmax(0.0, -pitch / 30.0)) < 1e-5);
    }
    assert_true(pose_of(&face).lids_down > 0.3f);
}

/* ---- the whole face ---- */

/* Everything is called, and time is cut in different ways. */
static noh_face play(uint32_t cut)
{
    noh_face face = face_of(1234, 0);
    for (uint32_t second = 0; second < 120; second++) {
        const float point[3] = { 0.4f * (float)(second % 5u) - 0.8f, 0.1f * (float)(second % 3u),
                                 0.6f + (float)(second % 7u) };
        if (second % 11u == 0) noh_face_look_at(&face, &desc, second % 22u ? point : NULL, NULL);
        if (second % 7u == 3u)
            noh_face_set_emotion(&face, (noh_emotion)(second % 7u), 0.7f, 0, second % 2u ? 9600 : 0, 0, NULL);
        if (second % 17u == 5u) noh_face_set_activity(&face, (noh_activity)(second % 3u));
        if (second % 13u == 6u) noh_face_blink(&face);
        for (uint32_t left = SECOND; left;) {
            const uint32_t ticks = cut ? (left < cut ? left : cut) : left;
            noh_face_step(&face, &desc, ticks);
            left -= ticks;
        }
    }
    return face;
}

static void steps_may_be_cut_anywhere(void **state)
{
    const noh_face whole = play(0);
    const noh_face_pose expected = pose_of(&whole);
    static const uint32_t cuts[] = { 1600, 800, 333, 47999, 17 };
    (void)state;
    for (size_t i = 0; i < sizeof cuts / sizeof cuts[0]; i++) {
        const noh_face cut = play(cuts[i]);
        const noh_face_pose pose = pose_of(&cut);
        assert_memory_equal(&pose, &expected, sizeof pose);
        assert_int_equal(cut.blinks, whole.blinks);
    }
}

static void the_longest_step_is_many_short_ones(void **state)
{
    noh_face once = face_of(7, 0), often = once;
    const uint32_t piece = UINT32_MAX / 255u; /* 255 * 16843009 */
    (void)state;
    noh_face_step(&once, &desc, UINT32_MAX);
    for (int i = 0; i < 255; i++) noh_face_step(&often, &desc, piece);
    assert_memory_equal(&once, &often, sizeof once);
    assert_int_equal(once.clock, UINT32_MAX);
}

static void a_copy_goes_on_as_the_face(void **state)
{
    noh_face face = play(800), copy = face;
    (void)state;
    for (uint32_t i = 0; i < 1000; i++) {
        noh_face_pose a, b;
        noh_face_step(&face, &desc, 777);
        noh_face_step(&copy, &desc, 777);
        a = pose_of(&face);
        b = pose_of(&copy);
        assert_memory_equal(&a, &b, sizeof a);
    }
}

static void a_face_never_stands_still_unless_it_is_calm(void **state)
{
    (void)state;
    for (uint32_t seed = 0; seed < 16; seed++) {
        noh_face face = face_of(seed, 0), calm = face_of(seed, NOH_FACE_CALM);
        noh_face_pose before = pose_of(&face), still = pose_of(&calm);
        for (uint32_t i = 0; i < 7200; i++) { /* an hour */
            noh_face_pose now;
            double moved = 0.0;
            noh_face_step(&face, &desc, SECOND / 2u);
            noh_face_step(&calm, &desc, SECOND / 2u);
            now = pose_of(&face);
            for (int k = 0; k < 3; k++) moved += fabs((double)(now.head_angles[k] - before.head_angles[k])) * DEGREES;
            assert_true(moved + fabs((double)(now.breath - before.breath)) > 0.02);
            before = now;
            now = pose_of(&calm);
            assert_memory_equal(&now, &still, sizeof now);
        }
    }
}

static void emotions_come_hold_and_go(void **state)
{
    noh_face face = face_of(8, NOH_FACE_CALM);
    (void)state;
    assert_int_equal(noh_face_set_emotion(&face, NOH_EMOTION_JOY, 0.8f, SECOND / 4u, SECOND, SECOND / 2u, NULL),
                     NOH_OK);
    noh_face_step(&face, &desc, SECOND / 4u);
    assert_true(fabs((double)pose_of(&face).emotions[NOH_EMOTION_JOY] - 0.76) < 0.002); /* 95 % */
    noh_face_step(&face, &desc, SECOND * 3u / 4u);
    assert_true(pose_of(&face).emotions[NOH_EMOTION_JOY] > 0.799f);
    noh_face_step(&face, &desc, SECOND / 2u);
    assert_true(fabs((double)pose_of(&face).emotions[NOH_EMOTION_JOY] - 0.04) < 0.002);
    for (int i = 0; i < NOH_EMOTION_COUNT; i++) {
        noh_face_set_emotion(&face, (noh_emotion)i, 0.1f * (float)(i + 1), 480, 0, 0, NULL);
        noh_face_step(&face, &desc, SECOND);
    }
    assert_true(pose_of(&face).emotions[NOH_EMOTION_CONTEMPT] > 0.69f); /* the strongest are kept */
    assert_true(pose_of(&face).emotions[NOH_EMOTION_SADNESS] == 0.0f);
}

/* A bad float of a desc is named by its index among the desc's floats. */
static void each_bad_float_is_named(void **state)
{
    static const struct {
        float value;
        uint32_t first, end; /* of the floats that cannot have it */
    } bads[] = { { NAN, 0, 8 }, { INFINITY, 0, 8 }, { -1e30f, 0, 8 }, { -1.0f, 6, 8 }, { 3.2f, 6, 8 }, { 1.6f, 7, 8 } };
    (void)state;
    for (uint32_t b = 0; b < sizeof bads / sizeof bads[0]; b++) {
        for (uint32_t i = bads[b].first; i < bads[b].end; i++) {
            noh_face_desc bad = desc;
            noh_face face;
            noh_error error;
            float *floats[] = { &bad.eyes[0][0], &bad.eyes[0][1], &bad.eyes[0][2],   &bad.eyes[1][0],
                                &bad.eyes[1][1], &bad.eyes[1][2], &bad.head_yaw_max, &bad.head_pitch_max };
            *floats[i] = bads[b].value;
            assert_int_equal(noh_face_init(&face, &bad, 1, 0, &error), NOH_ERR_ARG);
            assert_int_equal(error.where, i);
            if (i >= 6u) assert_non_null(strstr(error.what, i == 6u ? "head_yaw_max" : "head_pitch_max"));
        }
    }
}

static void bad_values_are_refused(void **state)
{
    noh_face_desc bad = desc;
    noh_face face, before;
    noh_error error;
    const float near_point[3] = { 0.0f, 0.09f, 0.1f }, nan_point[3] = { NAN, 0.0f, 1.0f };
    (void)state;
    bad.eyes[0][0] = -0.1f;
    assert_int_equal(noh_face_init(&face, &bad, 1, 0, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 0);
    assert_int_equal(noh_face_init(&face, &desc, 1, NOH_FACE_FLAGS + 1u, &error), NOH_ERR_ARG);
    face = before = face_of(1, 0);
    assert_int_equal(noh_face_look_at(&face, &desc, near_point, &error), NOH_ERR_ARG);
    assert_int_equal(noh_face_look_at(&face, &desc, nan_point, &error), NOH_ERR_ARG);
    assert_int_equal(noh_face_set_emotion(&face, NOH_EMOTION_COUNT, 0.5f, 0, 0, 0, &error), NOH_ERR_ARG);
    assert_int_equal(noh_face_set_emotion(&face, NOH_EMOTION_JOY, 1.5f, 0, 0, 0, &error), NOH_ERR_ARG);
    assert_int_equal(noh_face_set_emotion(&face, NOH_EMOTION_JOY, NAN, 0, 0, 0, &error), NOH_ERR_ARG);
    assert_int_equal(noh_face_set_emotion(&face, NOH_EMOTION_JOY, 1.0f, 0x80000000u, 0, 0, &error), NOH_ERR_ARG);
    assert_memory_equal(&face, &before, sizeof face);
}

static void a_face_lives_past_the_day_at_which_ticks_wrap(void **state)
{
    noh_face face = face_of(2, 0);
    (void)state;
    noh_face_set_emotion(&face, NOH_EMOTION_JOY, 0.5f, 0, 0, 0, NULL);
    for (uint32_t hour = 0; hour < 60; hour++) {
        for (uint32_t i = 0; i < 60; i++) noh_face_step(&face, &desc, 60u * SECOND);
        assert_true(fabs((double)pose_of(&face).emotions[NOH_EMOTION_JOY] - 0.5) < 1e-6);
    }
    print_message("%.2f blinks a minute in 60 hours\n", face.blinks / 3600.0);
    assert_true(fabs(face.blinks / 3600.0 - 17.0) < 0.4);
}

/* Stress raises brows and nods the head, with eyes that keep their aim; a rise of `blink` is one blink; `away` looks aside
 * until it falls. */
static void speech_moves_the_upper_face(void **state)
{
    const float point[3] = { 0.1f, 0.1f, 1.0f };
    noh_face face = face_of(3, NOH_FACE_NO_IDLE | NOH_FACE_NO_WANDER | NOH_FACE_NO_BLINK);
    noh_face_speech asked = { 1.0f, 1.0f, 1.0f, 0.0f };
    noh_error error;
    uint32_t blinks;
    noh_face_pose before, now;
    (void)state;
    noh_face_look_at(&face, &desc, point, NULL);
    noh_face_step(&face, &desc, 2u * SECOND);
    before = pose_of(&face);
    blinks = face.blinks;
    for (int i = 0; i < 3; i++) assert_int_equal(noh_face_speak(&face, &desc, &asked, NULL), NOH_OK);
    noh_face_step(&face, &desc, SECOND / 12u);
    now = pose_of(&face);
    assert_true(now.brows > before.brows + 0.4f && now.blink > 0.5f);
    assert_true((double)(before.head_angles[1] - now.head_angles[1]) * DEGREES > 3.0);
    assert_true(miss(&now, 0, point) < 0.1 && miss(&now, 1, point) < 0.1);
    assert_true(face.blinks - blinks <= 2u); /* one, or a double one */
    asked = (noh_face_speech){ 0.0f, 0.0f, 0.0f, 1.0f };
    assert_int_equal(noh_face_speak(&face, &desc, &asked, NULL), NOH_OK);
    noh_face_step(&face, &desc, SECOND / 2u);
    now = pose_of(&face);
    assert_true(now.brows < 0.2f && miss(&now, 0, point) > 0.5);
    assert_int_equal(noh_face_speak(&face, &desc, NULL, NULL), NOH_OK);
    noh_face_step(&face, &desc, SECOND / 2u);
    now = pose_of(&face);
    assert_true(miss(&now, 0, point) < 0.1);
    asked.nod = 1.5f;
    assert_int_equal(noh_face_speak(&face, &desc, &asked, &error), NOH_ERR_ARG);
    asked.nod = NAN;
    assert_int_equal(noh_face_speak(&face, &desc, &asked, &error), NOH_ERR_ARG);
}

/* Equal on every processor: `make cross` runs this there. */
static void the_bits_are_the_same_everywhere(void **state)
{
    noh_face face = play(1000);
    uint32_t hash = 2166136261u;
    (void)state;
    for (uint32_t i = 0; i < 2000; i++) {
        noh_face_pose pose;
        const uint8_t *bytes = (const uint8_t *)&pose;
        noh_face_step(&face, &desc, 800);
        pose = pose_of(&face);
        for (size_t k = 0; k < sizeof pose; k++) hash = (hash ^ bytes[k]) * 16777619u;
    }
    print_message("hash %08x\n", hash);
    assert_int_equal(hash, 0xfdbfbd06);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blinks_come_at_their_rates),
        cmocka_unit_test(each_person_blinks_at_the_rate),
        cmocka_unit_test(intervals_are_log_normal),
        cmocka_unit_test(four_channels_keep_the_timers),
        cmocka_unit_test(fades_end_at_their_goals),
        cmocka_unit_test(four_channels_hold_the_two_strongest_shapes),
        cmocka_unit_test(emotions_of_four_channels_may_be_called),
        cmocka_unit_test(lids_shut_and_open_again),
        cmocka_unit_test(a_blink_with_a_look_takes_the_place_of_the_next),
        cmocka_unit_test(each_eye_aims_at_its_target),
        cmocka_unit_test(saccades_follow_the_main_sequence),
        cmocka_unit_test(eyes_stay_within_their_limits_and_the_head_helps),
        cmocka_unit_test(a_target_behind_is_looked_at_over_one_shoulder),
        cmocka_unit_test(lids_follow_the_eyes_at_once),
        cmocka_unit_test(steps_may_be_cut_anywhere),
        cmocka_unit_test(the_longest_step_is_many_short_ones),
        cmocka_unit_test(a_copy_goes_on_as_the_face),
        cmocka_unit_test(a_face_never_stands_still_unless_it_is_calm),
        cmocka_unit_test(emotions_come_hold_and_go),
        cmocka_unit_test(each_bad_float_is_named),
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(a_face_lives_past_the_day_at_which_ticks_wrap),
        cmocka_unit_test(speech_moves_the_upper_face),
        cmocka_unit_test(the_bits_are_the_same_everywhere),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
