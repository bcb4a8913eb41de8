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

/* captured: hips that go; else as an exoskeleton has them, at one place. from_s: where in its walk it begins. */
static raw_set *walker_from(int captured, double from_s)
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
        const double t = f / RATE + from_s, z = 1.2 * t;
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

static raw_set *walker(int captured)
{
    return walker_from(captured, 0.0);
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
    assert_int_equal(clean_set(set, CLEAN_ROOT | CLEAN_CONTACTS, NULL, NULL), 0); /* a second time: it goes already */
    assert_true(fabs((double)clip->translations[(size_t)(FRAMES - 1) * JOINTS * 3 + 2] - 7.2) < 0.15);
    assert_in_range(clip->event_count, 10, 12);
    const raw_event *first = clip->events + (strcmp(clip->events[0].name, "foot_l") == 0); /* at the loop's seam */
    assert_true(first[0].is_marker);
    assert_string_equal(first[0].name, "foot_r");
    assert_true(fabs(first[0].time_s - 0.5) < 0.06);
    assert_string_equal(first[1].name, "foot_l");
    assert_true(fabs(first[1].time_s - 1.0) < 0.06);
    raw_set_free(set);
}

/* A loop of six passes has six keys a foot, wherever in a pass it begins: none twice at its seam, and none missing. */
static void steps_get_callback_keys(void **state)
{
    double worst = 0.0;
    (void)state;
    for (uint32_t begin = 0; begin < 120; begin++) {
        const double from_s = (begin % 60u) / RATE;
        raw_set *set = walker_from(begin < 60u, from_s);
        raw_clip *clip = &set->clips[0];
        uint32_t counts[2] = { 0, 0 };
        assert_int_equal(clean_set(set, CLEAN_KEYS | CLEAN_CONTACTS, NULL, NULL), 0);
        for (uint32_t i = 0; i < clip->event_count; i++) {
            const raw_event *e = &clip->events[i];
            const int right = strcmp(e->name, "right_foot") == 0;
            if (e->is_marker) continue;
            if (!right) assert_string_equal(e->name, "left_foot");
            counts[right]++;
            assert_int_equal(e->payload[0], right);
            assert_true(e->time_s >= 0.0 && e->time_s < raw_clip_duration_s(clip));
            const double phase = e->time_s + from_s + (right ? 0.5 : 0.0), off = phase - floor(phase + 0.5);
            worst = fmax(worst, fabs(off));
        }
        if (counts[0] != 6 || counts[1] != 6 || clip->event_count != 24)
            fail_msg("begun at %.3f s: %u left, %u right of %u", from_s, counts[0], counts[1], clip->event_count);
        raw_set_free(set);
    }
    print_message("keys within %.3f s of where feet come down\n", worst);
    assert_true(worst < 0.04);
}

/* Sides by names and by place. A clip that is no loop has no key for a foot that stands at its start. */
static void keys_are_named_by_sides(void **state)
{
    static const char *const names[4][3] = { { "foot_l", "foot_r", "left_foot" },
                                             { "RightFoot", "LeftFoot", "right_foot" },
                                             { "a", "b", "left_foot" },
                                             { "Bip R Foot", "Bip L Foot", "right_foot" } };
    const raw_event own = { .name = (char[]){ "shout" }, .time_s = 2.0 };
    (void)state;
    for (int i = 0; i < 4; i++) {
        raw_set *set = walker_from(1, 0.1);
        raw_clip *clip = &set->clips[0];
        for (uint32_t side = 0; side < 2; side++) {
            char **name = &set->skeleton.joints[side ? RIGHT : LEFT].name;
            free(*name);
            *name = model_string(names[i][side]);
        }
        clip->frame_count = 331; /* five passes and a half */
        assert_int_equal(raw_clip_add_event(clip, &own), 0);
        assert_int_equal(clean_set(set, CLEAN_KEYS, NULL, NULL), 0);
        assert_int_equal(clip->event_count, 1 + 5 + 6);
        uint32_t lefts = 0, others = 0;
        for (uint32_t k = 0; k < clip->event_count; k++) {
            const raw_event *e = &clip->events[k];
            assert_true(k == 0 || e->time_s >= clip->events[k - 1u].time_s);
            lefts += e->payload[0] == 0 && strcmp(e->name, names[i][2]) == 0;
            others += strcmp(e->name, "shout") == 0;
        }
        assert_int_equal(lefts, 5); /* of the first foot */
        assert_int_equal(others, 1);
        raw_set_free(set);
    }
}

/* A rig with two joints to a foot has one key a step. */
static void a_foot_of_two_joints_steps_once(void **state)
{
    (void)state;
    for (uint32_t begin = 0; begin < 60; begin++) {
        raw_set *set = walker_from(1, begin / RATE);
        raw_clip *clip = &set->clips[0];
        set->skeleton.joints[LEFT_TOE].parent = HIPS;
        for (size_t at = 0; at < (size_t)FRAMES * JOINTS * 3; at += JOINTS * 3)
            memcpy(clip->translations + at + 3 * LEFT_TOE, clip->translations + at + 3 * LEFT, 3 * sizeof(float));
        memcpy(set->skeleton.joints[LEFT_TOE].translation, rest[LEFT], sizeof rest[LEFT]);
        free(set->skeleton.joints[LEFT_TOE].name);
        set->skeleton.joints[LEFT_TOE].name = model_string("ik.l");
        set->skeleton.joints[LEFT_TOE].translation[0] += 0.02f;
        assert_int_equal(clean_set(set, CLEAN_KEYS, NULL, NULL), 0);
        assert_int_equal(clip->event_count, 12);
        raw_set_free(set);
    }
}

/* A figure that only stands takes no step, and the report says so. */
static void no_step_is_a_warning(void **state)
{
    raw_set *set = walker(1);
    raw_clip *clip = &set->clips[0];
    char line[256] = "";
    FILE *report = tmpfile();
    (void)state;
    assert_non_null(report);
    for (uint32_t f = 1; f < FRAMES; f++)
        memcpy(clip->translations + (size_t)f * JOINTS * 3, clip->translations, JOINTS * 3 * sizeof(float));
    assert_int_equal(clean_set(set, CLEAN_KEYS, NULL, report), 0);
    assert_int_equal(clip->event_count, 0);
    rewind(report);
    assert_non_null(fgets(line, sizeof line, report));
    assert_non_null(strstr(line, "warning: clip 'walk' has no contact-keys"));
    fclose(report);
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
    assert_int_equal(clean_parse("contact-keys,gaps", &what), 0);
    assert_int_equal(what, CLEAN_GAPS | CLEAN_KEYS);
    assert_int_equal(clean_parse("contact", &what), 1);
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
        cmocka_unit_test(steps_get_callback_keys),
        cmocka_unit_test(keys_are_named_by_sides),
        cmocka_unit_test(a_foot_of_two_joints_steps_once),
        cmocka_unit_test(no_step_is_a_warning),
        cmocka_unit_test(what_was_seen_is_left),
        cmocka_unit_test(gaps_are_filled),
        cmocka_unit_test(jitter_is_filtered),
        cmocka_unit_test(motion_is_not_jitter),
        cmocka_unit_test(words_are_parsed),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
