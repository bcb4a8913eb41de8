/* Tests of tools/convert/mocap/: gaps, jitter, contacts and roots of recordings, on motions whose truth is known. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/quat.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"
#include "convert/mocap/clean.h"
#include "convert/mocap/contacts.h"
#include "convert/mocap/gaps.h"
#include "convert/mocap/jitter.h"
#include "convert/model/model_build.h"
#include "support/support.h"

#define TURN 6.28318530717958647692
#define RATE 60.0
#define FRAMES 361u
#define HEIGHT 1.8f

/* ---- a walker whose truth is known ---- */

enum { HIPS, HEAD, LEFT, LEFT_TOE, RIGHT, RIGHT_TOE, JOINTS };

static const float rest[JOINTS][3] = { { 0, 0.95f, 0 },      { 0, 0.85f, 0 },      { 0.1f, -0.87f, 0 },
                                       { 0, -0.05f, 0.15f }, { -0.1f, -0.87f, 0 }, { 0, -0.05f, 0.15f } };

/* Where a foot is, of a walk of 1.2 m a second in steps of 0.6 s, and whether it stands. */
static int walking_foot(double t, int right, double *z, double *y)
{
    const double cycle = 1.0, speed = 1.2, phase = t / cycle + (right ? 0.5 : 0.0), whole = floor(phase);
    const double in = phase - whole, stance = 0.6, stride = speed * cycle;
    *y = 0.0;
    *z = whole * stride - (right ? 0.5 * stride : 0.0);
    if (in < stance) return 1;
    const double u = (in - stance) / (1.0 - stance);
    *z += stride * u * u * (3.0 - 2.0 * u);
    *y = 0.12 * sin(0.5 * TURN * u) * sin(0.5 * TURN * u);
    return 0;
}

/* captured: hips that go; else as an exoskeleton has them, at one place. */
static raw_set *walker(int captured)
{
    static const char *const names[JOINTS] = { "hips", "head", "foot_l", "toe_l", "foot_r", "toe_r" };
    static const uint32_t parents[JOINTS] = { MODEL_NONE, HIPS, HIPS, LEFT, HIPS, RIGHT };
    raw_set *set = raw_set_new(JOINTS, 1);
    raw_clip *clip = &set->clips[0];
    set->skeleton.unit_cm = 100.0;
    assert_int_equal(raw_clip_alloc(clip, FRAMES, JOINTS), 0);
    clip->name = model_string("walk");
    clip->sample_rate_hz = RATE;
    for (uint32_t j = 0; j < JOINTS; j++) {
        free(set->skeleton.joints[j].name);
        set->skeleton.joints[j].name = model_string(names[j]);
        set->skeleton.joints[j].parent = parents[j];
        memcpy(set->skeleton.joints[j].translation, rest[j], sizeof rest[j]);
    }
    for (uint32_t f = 0; f < FRAMES; f++) {
        const double t = f / RATE, z = 1.2 * t;
        for (uint32_t j = 0; j < JOINTS; j++) {
            const size_t at = (size_t)f * JOINTS + j;
            const double angle = 0.5 * sin(TURN * t + j);
            const float q[4] = { (float)sin(0.5 * angle), 0.0f, 0.0f, (float)cos(0.5 * angle) };
            const float none[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
            memcpy(clip->rotations + 4 * at, j == HEAD ? q : none, sizeof q);
            memcpy(clip->translations + 3 * at, rest[j], sizeof rest[j]);
            for (int i = 0; i < 3; i++) clip->scales[3 * at + (size_t)i] = 1.0f;
            if (j == HIPS && captured) clip->translations[3 * at + 2] = (float)z;
            if (j == LEFT || j == RIGHT) {
                double foot_z, foot_y;
                (void)walking_foot(t, j == RIGHT, &foot_z, &foot_y);
                clip->translations[3 * at + 1] += (float)foot_y;
                clip->translations[3 * at + 2] = (float)(foot_z - z);
            }
        }
    }
    return set;
}

static void feet_are_found_when_they_stand(void **state)
{
    (void)state;
    for (int captured = 0; captured < 2; captured++) {
        raw_set *set = walker(captured);
        int failed;
        contacts *c = contacts_find(&set->skeleton, &set->clips[0], &failed);
        uint32_t wrong = 0, stood = 0;
        assert_non_null(c);
        assert_int_equal(contacts_feet(c), 2);
        assert_int_equal(contacts_joint(c, 0), LEFT);
        assert_int_equal(contacts_joint(c, 1), RIGHT);
        assert_int_equal(contacts_on_the_spot(c), !captured);
        for (uint32_t f = 0; f < FRAMES; f++) {
            for (uint32_t foot = 0; foot < 2; foot++) {
                double y, z;
                const int truth = walking_foot(f / RATE, foot == 1, &z, &y);
                const int before = walking_foot(f / RATE - 0.08, foot == 1, &z, &y);
                const int after = walking_foot(f / RATE + 0.08, foot == 1, &z, &y);
                stood += (uint32_t)truth;
                if (truth == before && truth == after) wrong += contacts_stands(c, foot, f) != truth;
            }
        }
        assert_in_range(stood, 300, 600);
        assert_int_equal(wrong, 0);
        contacts_free(c);
        raw_set_free(set);
    }
}

/* Mechanical capture has no place: the feet say that the walker went 1.2 m a second. */
static void a_root_is_made_of_contacts(void **state)
{
    raw_set *set = walker(0);
    raw_clip *clip = &set->clips[0];
    int failed;
    contacts *c = contacts_find(&set->skeleton, clip, &failed);
    (void)state;
    assert_non_null(c);
    const double gone = contacts_move_root(c, &set->skeleton, clip);
    print_message("gone %.3f m\n", gone);
    assert_true(fabs(gone - 7.2) < 0.02 * 7.2);
    for (uint32_t f = 0; f < FRAMES; f++) {
        const float *t = clip->translations + (size_t)f * JOINTS * 3;
        assert_true(fabs((double)t[2] - 1.2 * f / RATE) < 0.04); /* no more than a fiftieth of a body, all the way */
        assert_true(fabsf(t[0]) < 0.001f && fabsf(t[1] - 0.95f) < 0.001f);
    }
    contacts_free(c);
    assert_int_equal(clean_set(set, CLEAN_ROOT | CLEAN_CONTACTS, NULL), 0); /* a second time: it goes already */
    assert_true(fabs((double)clip->translations[(size_t)(FRAMES - 1) * JOINTS * 3 + 2] - 7.2) < 0.15);
    assert_in_range(clip->event_count, 10, 12);
    assert_true(clip->events[0].is_marker);
    assert_string_equal(clip->events[0].name, "foot_r");
    assert_true(fabs(clip->events[0].time_s - 0.5) < 0.06);
    assert_string_equal(clip->events[1].name, "foot_l");
    assert_true(fabs(clip->events[1].time_s - 1.0) < 0.06);
    raw_set_free(set);
}

/* ---- all known clips ---- */

static double angle_between(const raw_clip *a, const raw_clip *b, size_t at)
{
    double p[4], q[4];
    for (size_t i = 0; i < 4; i++) {
        p[i] = (double)a->rotations[4 * at + i];
        q[i] = (double)b->rotations[4 * at + i];
    }
    (void)quat_normalize(p);
    (void)quat_normalize(q);
    return quat_angle(p, q);
}

static raw_set *read_clip(const char *name)
{
    raw_set *set;
    model_error error = { "", "" };
    char file[64];
    snprintf(file, sizeof file, "clips/%s.rcl", name);
    assert_int_equal(rcl_read(test_asset(file), &set, &error), 0);
    return set;
}

#define CAPTURED 5u /* the first */
static const char *const known[] = { "cmu_01_01",
                                     "cmu_01_03",
                                     "cmu_indian_04",
                                     "cmu_martial_03",
                                     "cmu_salsa_01",
                                     "Knight__Walking_A",
                                     "Knight__Running_A",
                                     "Knight__Cheer",
                                     "Fox__Run",
                                     "Knight__Jump_Full_Long",
                                     "RobotExpressive__Dance",
                                     "CesiumMan" };

/* What has no gaps is left alone: hits, jumps, rests, loops. The captured ones have some of their own (whole limbs held
 * for a quarter of a second, joints that are elsewhere for one frame): a two-hundredth of their frames and less. */
static void what_was_seen_is_left(void **state)
{
    (void)state;
    for (size_t k = 0; k < TEST_COUNT(known); k++) {
        raw_set *set = read_clip(known[k]);
        gaps_report gaps = { 0, 0, 0, 0, 0.0 };
        raw_clip *clip = &set->clips[0];
        assert_int_equal(gaps_fill(&set->skeleton, clip, &gaps), 0);
        print_message("%-24s %u gaps, %u frames of %u\n", known[k], gaps.filled, gaps.frames,
                      clip->frame_count * clip->joint_count);
        assert_true(gaps.frames * 200u <= (k < CAPTURED ? clip->frame_count * clip->joint_count : 0u));
        raw_set_free(set);
    }
}

/* Gaps of up to half a second, held or fallen to zero: joints come nearer to the truth by what the motion allows. */
static void gaps_are_filled(void **state)
{
    (void)state;
    for (size_t k = 0; k < CAPTURED; k++) {
        raw_set *set = read_clip(known[k]), *truth = read_clip(known[k]);
        double worse = 0.0, better = 0.0, missed = 0.0;
        uint32_t cut = 0, found = 0;
        gaps_report gaps = { 0, 0, 0, 0, 0.0 };
        raw_clip *clip = &set->clips[0], *right = &truth->clips[0];
        assert_int_equal(gaps_fill(&set->skeleton, clip, &gaps), 0); /* its own */
        memcpy(right->rotations, clip->rotations, (size_t)clip->frame_count * clip->joint_count * 16);
        const uint32_t length = (uint32_t)(0.25 * clip->sample_rate_hz), joints = clip->joint_count;
        uint8_t *lost = test_zeros((size_t)clip->frame_count * joints);
        for (uint32_t f = 20, n = 0; f + length + 20 < clip->frame_count; f += 2 * length, n++) {
            const uint32_t j = (n * 7u) % joints;
            for (uint32_t i = 0; i < length; i++) {
                float *q = clip->rotations + 4 * ((size_t)(f + i) * joints + j);
                const float zero[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
                memcpy(q, n % 2 ? zero : clip->rotations + 4 * ((size_t)(f - 1) * joints + j), sizeof zero);
                lost[(size_t)(f + i) * joints + j] = 1;
            }
        }
        raw_set *broken = read_clip(known[k]);
        memcpy(broken->clips[0].rotations, clip->rotations, (size_t)clip->frame_count * joints * 16);
        assert_int_equal(gaps_fill(&set->skeleton, clip, &gaps), 0);
        for (size_t at = 0; at < (size_t)clip->frame_count * joints; at++) {
            const double was = angle_between(&broken->clips[0], right, at), is = angle_between(clip, right, at);
            if (!lost[at] || was < 0.03) continue;
            cut++;
            if (memcmp(clip->rotations + 4 * at, broken->clips[0].rotations + 4 * at, 16) == 0) {
                missed += was * was;
                continue;
            }
            found++;
            worse += was * was;
            better += is * is;
        }
        print_message(
            "%-24s %u frames lost by more than 1.7 degrees: %u filled, %.2f degrees off (%.2f before), the others %.2f\n",
            known[k], cut, found, sqrt(better / found) / TURN * 360.0, sqrt(worse / found) / TURN * 360.0,
            sqrt(missed / (cut - found + 1e-9)) / TURN * 360.0);
        assert_true(found * 10 >= cut * 7);
        assert_true(better < 0.7 * worse);
        free(lost);
        raw_set_free(set);
        raw_set_free(truth);
        raw_set_free(broken);
    }
}

/* ---- jitter ---- */

/* A normal number, by the sum of twelve. */
static float normal(uint32_t *seed)
{
    float sum = -6.0f;
    for (int i = 0; i < 12; i++) {
        *seed = *seed * 1664525u + 1013904223u;
        sum += (float)(*seed >> 8) / 16777216.0f;
    }
    return sum;
}

static double off(const raw_clip *a, const raw_clip *b)
{
    double sum = 0.0;
    const size_t count = (size_t)a->frame_count * a->joint_count;
    for (size_t at = 0; at < count; at++) sum += angle_between(a, b, at) * angle_between(a, b, at);
    return sqrt(sum / (double)count);
}

static void jitter_is_filtered(void **state)
{
    double left = 0.0;
    (void)state;
    for (size_t k = 0; k < CAPTURED; k++) {
        raw_set *set = read_clip(known[k]), *truth = read_clip(known[k]);
        jitter_report clean = { 0, 0.0, 0.0, 0.0, 0.0, 0.0 }, noisy = clean;
        uint32_t seed = 5;
        raw_clip *clip = &set->clips[0], *right = &truth->clips[0];
        assert_int_equal(jitter_filter(&truth->skeleton, right, &clean), 0); /* the recording's own */
        for (size_t at = 0; at < (size_t)clip->frame_count * clip->joint_count; at++) {
            for (size_t i = 0; i < 4; i++)
                clip->rotations[4 * at + i] = right->rotations[4 * at + i] + 0.005f * normal(&seed);
        }
        const double before = off(clip, right);
        assert_int_equal(jitter_filter(&set->skeleton, clip, &noisy), 0);
        const double after = off(clip, right);
        print_message("%-24s own jitter in %u tracks; put in: %.3f degrees, left %.3f (%u tracks of %u)\n", known[k],
                      clean.tracks, before / TURN * 360.0, after / TURN * 360.0, noisy.tracks, clip->joint_count);
        assert_true(after < 0.9 * before);
        left += after / before / CAPTURED;
        assert_true(noisy.degrees > 0.8 && noisy.degrees < 1.6);
        raw_set_free(set);
        raw_set_free(truth);
    }
    assert_true(left < 0.6);
}

/* A motion without noise keeps its bits; a hit within noise is not rounded away. */
static void motion_is_not_jitter(void **state)
{
    raw_set *set = walker(1), *same = walker(1);
    jitter_report r = { 0, 0.0, 0.0, 0.0, 0.0, 0.0 };
    raw_clip *clip = &set->clips[0];
    uint32_t seed = 9;
    (void)state;
    const size_t floats = (size_t)FRAMES * JOINTS * 3;
    assert_int_equal(jitter_filter(&set->skeleton, clip, &r), 0);
    assert_int_equal(r.tracks, 0);
    assert_memory_equal(clip->translations, same->clips[0].translations, floats * sizeof(float));
    for (uint32_t f = 0; f < FRAMES; f++) { /* the head is hit by 8 cm in one frame, among 2 mm of noise */
        float *t = clip->translations + ((size_t)f * JOINTS + HEAD) * 3;
        for (int i = 0; i < 3; i++) t[i] += 0.002f * normal(&seed);
        if (f >= 180) t[0] += 0.08f;
    }
    assert_int_equal(jitter_filter(&set->skeleton, clip, &r), 0);
    assert_int_equal(r.tracks, 1);
    const float *hit = clip->translations + (180 * JOINTS + HEAD) * 3;
    assert_true(hit[0] - hit[-(int)JOINTS * 3] > 0.05f);
    raw_set_free(set);
    raw_set_free(same);
}

static void words_are_parsed(void **state)
{
    unsigned what = 99;
    (void)state;
    assert_int_equal(clean_parse("off", &what), 0);
    assert_int_equal(what, 0);
    assert_int_equal(clean_parse("all", &what), 0);
    assert_int_equal(what, 15);
    assert_int_equal(clean_parse("jitter,gaps", &what), 0);
    assert_int_equal(what, CLEAN_GAPS | CLEAN_JITTER);
    assert_int_equal(clean_parse("", &what), 1);
    assert_int_equal(clean_parse("gaps,", &what), 1);
    assert_int_equal(clean_parse("gap", &what), 1);
    assert_int_equal(clean_parse("all,gaps", &what), 1);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_are_found_when_they_stand),
        cmocka_unit_test(a_root_is_made_of_contacts),
        cmocka_unit_test(what_was_seen_is_left),
        cmocka_unit_test(gaps_are_filled),
        cmocka_unit_test(jitter_is_filtered),
        cmocka_unit_test(motion_is_not_jitter),
        cmocka_unit_test(words_are_parsed),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
