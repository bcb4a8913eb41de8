/* test_bvh_read.c: .bvh files, written here and real.
 * cross: slow, thousands of damaged files */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "convert/clips/bvh_read.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"

static raw_set *load_path(const char *path, const bvh_options *options)
{
    raw_set *set = NULL;
    model_error error = { "", "" };
    if (bvh_read(path, options, &set, &error)) fail_msg("%s refused: %s (%s)", path, error.what, error.where);
    return set;
}

static const char *save(const char *text)
{
    const char *path = test_path("clip.bvh");
    test_write_file(path, text, strlen(text));
    return path;
}

static raw_set *load(const char *text)
{
    return load_path(save(text), NULL);
}

static void refused(const char *text, const char *what, const char *where)
{
    raw_set *set = (raw_set *)1;
    model_error error = { "", "" };
    assert_int_equal(bvh_read(save(text), NULL, &set, &error), 1);
    assert_null(set);
    if (!strstr(error.what, what) || strcmp(error.where, where) != 0)
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
}

/* --- an oracle: rotation matrices, with libm --- */

static void axis_matrix(int axis, double degrees, double *m) /* rows */
{
    const double radians = degrees * 3.14159265358979323846 / 180.0, c = cos(radians), s = sin(radians);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    memset(m, 0, 9 * sizeof *m);
    m[axis * 3 + axis] = 1.0;
    m[u * 3 + u] = m[v * 3 + v] = c;
    m[u * 3 + v] = -s;
    m[v * 3 + u] = s;
}

static void product(const double *a, const double *b, double *out)
{
    for (int i = 0; i < 9; ++i)
        out[i] = a[i / 3 * 3] * b[i % 3] + a[i / 3 * 3 + 1] * b[3 + i % 3] + a[i / 3 * 3 + 2] * b[6 + i % 3];
}

/* order: axes, the first outermost */
static void euler_matrix(const int *order, const double *degrees, double *out)
{
    double next[9], sum[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    for (int i = 0; i < 3; ++i) {
        double turn[9];
        axis_matrix(order[i], degrees[i], turn);
        product(sum, turn, next);
        memcpy(sum, next, sizeof sum);
    }
    memcpy(out, sum, sizeof sum);
}

static void assert_rotation(const float *q, const double *m, double tolerance)
{
    const double x = (double)q[0], y = (double)q[1], z = (double)q[2], w = (double)q[3];
    const double got[9] = { 1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                            2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                            2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y) };
    assert_true(fabs(x * x + y * y + z * z + w * w - 1.0) < 1e-6);
    for (int i = 0; i < 9; ++i)
        if (!(fabs(got[i] - m[i]) <= tolerance))
            fail_msg("element %d of the rotation is %.9g, not %.9g", i, got[i], m[i]);
}

/* --- what is read --- */

#define MOTION_OF_2 "MOTION\nFrames: 2\nFrame Time: 0.033333\n"

static void a_small_skeleton(void **state)
{
    (void)state;
    raw_set *set = load(
        "HIERARCHY\nROOT Hips\n{\n OFFSET 1 2 3\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
        "Yrotation\n"
        " JOINT Left Leg\n {\n  OFFSET 0 -10 0.5\n  CHANNELS 3 Zrotation Yrotation Xrotation\n"
        "  End Site\n  {\n   OFFSET 0 -4 0\n  }\n }\n}\n" MOTION_OF_2
        "10 20 30 0 0 0 0 0 0\n11 20 30 90 0 0 0 0 180\n");
    const raw_skeleton *s = &set->skeleton;
    const raw_clip *c = &set->clips[0];
    assert_int_equal(s->joint_count, 2);
    assert_string_equal(s->name, "Hips");
    assert_string_equal(s->joints[0].name, "Hips");
    assert_string_equal(s->joints[1].name, "Left Leg");
    assert_int_equal(s->joints[0].parent, MODEL_NONE);
    assert_int_equal(s->joints[1].parent, 0);
    assert_true(s->joints[0].translation[1] == 2.0f && s->joints[0].rotation[3] == 1.0f &&
                s->joints[0].scale[2] == 1.0f);
    assert_true(s->joints[1].end[1] == -4.0f && s->joints[0].end[1] == 0.0f);
    assert_true(s->unit_cm == 1.0);
    assert_string_equal(c->name, "clip");
    assert_true(c->sample_rate_hz == 30.0);
    assert_int_equal(c->frame_count, 2);
    assert_int_equal(c->joint_count, 2);
    assert_true(c->translations[0] == 10.0f && c->translations[6] == 11.0f); /* positions replace the offset */
    assert_true(c->translations[3] == 0.0f && c->translations[4] == -10.0f); /* no positions: the offset */
    assert_true(fabsf(c->rotations[10] - sqrtf(0.5f)) < 1e-7f && c->rotations[8] == 0.0f);
    assert_true(c->rotations[12] == 1.0f && c->rotations[15] == 0.0f); /* 180 degrees, exactly */
    raw_set_free(set);
}

static void any_order_of_rotations(void **state)
{
    (void)state;
    static const int orders[6][3] = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } };
    const double degrees[3] = { 33.25, -71.5, 140.125 };
    for (int i = 0; i < 6; ++i) {
        char text[512];
        double expected[9];
        snprintf(text, sizeof text,
                 "HIERARCHY ROOT r { OFFSET 0 0 0 CHANNELS 3 %crotation %crotation %crotation } MOTION\n"
                 "Frames: 1\nFrame Time: 1\n%g %g %g\n",
                 'X' + orders[i][0], 'X' + orders[i][1], 'X' + orders[i][2], degrees[0], degrees[1], degrees[2]);
        raw_set *set = load(text);
        euler_matrix(orders[i], degrees, expected);
        assert_rotation(set->clips[0].rotations, expected, 3e-7);
        raw_set_free(set);
    }
}

static void positions_between_rotations_on_any_joint(void **state)
{
    (void)state;
    raw_set *set = load(
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT b\n{\nOFFSET 1 2 3\n"
        "CHANNELS 4 Zrotation Yposition Xrotation Xposition\n}\n}\nMOTION\nFrames: 1\nFrame Time: 1\n30 7 40 -5\n");
    const int order[3] = { 2, 0, 1 };
    const double degrees[3] = { 30, 40, 0 };
    double expected[9];
    euler_matrix(order, degrees, expected);
    assert_rotation(set->clips[0].rotations + 4, expected, 3e-7);
    const float *t = set->clips[0].translations + 3;
    assert_true(t[0] == -5.0f && t[1] == 7.0f && t[2] == 3.0f); /* the axis without a channel keeps its offset */
    raw_set_free(set);
}

static void several_roots(void **state)
{
    (void)state;
    raw_set *set = load(
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n}\nROOT b\n{\nOFFSET 0 1 0\nCHANNELS 1 Xposition\n"
        "JOINT c\n{\nOFFSET 1 1 1\nCHANNELS 1 Xposition\nEnd Site\n{\nOFFSET 1 0 0\n}\nEnd Site\n{\nOFFSET 0 2 "
        "0\n}\n}\n}\n"
        "MOTION\nFrames: 1\nFrame Time: 1\n1 2 3\n");
    assert_int_equal(set->skeleton.joint_count, 3);
    assert_int_equal(set->skeleton.joints[1].parent, MODEL_NONE);
    assert_int_equal(set->skeleton.joints[2].parent, 1);
    assert_true(set->clips[0].translations[3] == 2.0f && set->clips[0].translations[6] == 3.0f);
    assert_true(set->skeleton.joints[2].end[1] == 2.0f); /* the longer of two */
    raw_set_free(set);
}

static void end_sites_as_joints(void **state)
{
    (void)state;
    const bvh_options options = { 2.54, 1 };
    raw_set *set = load_path(
        save("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\nEnd Site\n{\nOFFSET 1 2 3\n}\n}\n"
             "MOTION\nFrames: 1\nFrame Time: 1\n1\n"),
        &options);
    assert_true(set->skeleton.unit_cm == 2.54);
    assert_int_equal(set->skeleton.joint_count, 2);
    assert_string_equal(set->skeleton.joints[1].name, "a_end");
    assert_int_equal(set->skeleton.joints[1].parent, 0);
    assert_true(set->clips[0].translations[5] == 3.0f && set->skeleton.joints[0].end[2] == 0.0f);
    raw_set_free(set);
}

static void other_spellings(void **state)
{
    (void)state;
    raw_set *set = load("\xef\xbb\xbfhierarchy\r\nroot\tThe  Hips of:{x} {\r\n\toffset\t0\t0 0\r\n\tchannels "
                        "1\r\n\tXPOSITION\r\n\t}\r\n\r\n"
                        "Motion\r\nFRAMES :2\r\nFrame  Time :\t1e-2\r\n\r\n  +1.5e1\t\r\n.5\r\n\r\n");
    assert_string_equal(set->skeleton.joints[0].name, "The  Hips of:{x}");
    assert_true(set->clips[0].sample_rate_hz == 100.0);
    assert_true(set->clips[0].translations[0] == 15.0f && set->clips[0].translations[3] == 0.5f);
    raw_set_free(set);
}

static void signs_do_not_jump(void **state)
{
    (void)state;
    char *text = test_zeros(65536);
    strcpy(
        text,
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\nMOTION\nFrames: 400\nFrame "
        "Time: 0.01\n");
    for (int i = 0; i < 400; ++i) {
        char line[64];
        snprintf(line, sizeof line, "%d %d %d\n", (i * 7) % 360 - 180, (i * 3) % 360, i * -5);
        strcat(text, line);
    }
    raw_set *set = load(text);
    const float *q = set->clips[0].rotations;
    assert_true(q[3] >= 0.0f);
    for (size_t i = 4; i < 1600; i += 4)
        assert_true(q[i] * q[i - 4] + q[i + 1] * q[i - 3] + q[i + 2] * q[i - 2] + q[i + 3] * q[i - 1] > 0.9f);
    raw_set_free(set);
    free(text);
}

static void rate_is(const char *time, double sample_rate_hz)
{
    char text[256];
    snprintf(text, sizeof text,
             "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n}\nMOTION\nFrames: 1\nFrame Time: %s\n1\n",
             time);
    raw_set *set = load(text);
    if (!(fabs(set->clips[0].sample_rate_hz - sample_rate_hz) <= 1e-9 * sample_rate_hz))
        fail_msg("frame time %s gave %.9g Hz, not %.9g", time, set->clips[0].sample_rate_hz, sample_rate_hz);
    raw_set_free(set);
}

static void whole_rates_are_recognised(void **state)
{
    (void)state;
    rate_is(".0083333", 120.0);
    rate_is("0.033333", 30.0);
    rate_is("0.0333", 30.0);
    rate_is("0.01666667", 60.0);
    rate_is("0.0416667", 24.0);
    rate_is("0.033367", 1.0 / 0.033367); /* television */
    rate_is("0.03", 1.0 / 0.03);
    rate_is("2", 0.5);
    rate_is("1e-2", 100.0);
}

/* --- what is refused --- */

#define HEAD \
    "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zrotation\n}\nMOTION\n" /* lines 1 to 7 */
#define CLIP_2 "Frames: 2\nFrame Time: 0.01\n"

static void check_warned(const char *text, uint32_t frames, const char *expected)
{
    raw_set *set = load(text);
    assert_int_equal(set->clips[0].frame_count, frames);
    if (!set->warning || !strstr(set->warning, expected))
        fail_msg("expected '%s', got '%s'", expected, set->warning ? set->warning : "no warning");
    raw_set_free(set);
}

/* What frame `frame` has as its three channels, to a thousandth. */
static void check_frame(const raw_set *set, uint32_t frame, double x, double y, double degrees)
{
    const raw_clip *c = &set->clips[0];
    const double half = atan2((double)c->rotations[4 * frame + 2], (double)c->rotations[4 * frame + 3]);
    assert_true(fabs((double)c->translations[3 * frame] - x) < 1e-3);
    assert_true(fabs((double)c->translations[3 * frame + 1] - y) < 1e-3);
    assert_true(fabs(half * 114.591559 - degrees) < 1e-3);
}

/* A frame that cannot be read repeats the one before it, or the first that can; so the others keep their times. */
static void bad_frames_repeat_the_nearest(void **state)
{
    static const struct {
        const char *rows, *warning;
        double x[4]; /* of each frame, the first number */
    } all[] = {
        { "1 ? 3\n4 5 6\n7 8 9\n2 3 4\n", "line 10: '?' is not a number; 1 frame that", { 4, 4, 7, 2 } },
        { "1 2\n1 2 nan\n7 8 9\n2 3 4\n",
          "line 10: frame 0 has 2 numbers; the channels need 3; 2 frames",
          { 7, 7, 7, 2 } },
        { "1 2 3\n4 5 6 7\n7 8 9\n2 3 4\n", "line 11: frame 1 has more numbers than", { 1, 1, 7, 2 } },
        { "1 2 3\n4 5\n-\n2 3 4\n", "line 11: frame 1 has 2 numbers; the channels need 3; 2 frames", { 1, 1, 1, 2 } },
    };
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        char text[512];
        raw_set *set;
        (void)snprintf(text, sizeof text, HEAD "Frames: 4\nFrame Time: 0.01\n%s", all[i].rows);
        check_warned(text, 4, all[i].warning);
        set = load(text);
        for (uint32_t k = 0; k < 4; k++) {
            const double x = all[i].x[k];
            check_frame(set, k, x, x + 1.0, x + 2.0);
        }
        raw_set_free(set);
    }
    check_warned(HEAD "Frames: 4\nFrame Time: 0.01\n1 2 3\n?\n1 2 3\n4 5\n", 3,
                 "the clip ends before the last frames, which cannot be read (1 of them)");
}

/* Frames of three numbers, x, x + 1 and x + 2, on lines of any length. */
static void frames_may_be_wrapped(void **state)
{
    static const struct {
        const char *head, *rows, *warning; /* warning NULL: none */
        uint32_t count;
        double x[4];
    } all[] = {
        { "Frames: 3", "1 2\n3\n4 5\n6\n7 8\n9\n", NULL, 3, { 1, 4, 7 } },
        { "Frames: 3", "1\n2\n3\n\n4\n5\n6\n7\n8\n9", NULL, 3, { 1, 4, 7 } },
        { "Frames: 4", "1 2 3 4\n5 6 7 8\n9 2 3 4\n", NULL, 4, { 1, 4, 7, 2 } },
        { "Frames: 3", "1 2 3 4 5 6 7 8 9\n", NULL, 3, { 1, 4, 7 } },
        { "Frames: 0", "1 2\n3\n4 5\n6\n", "gives no frames", 2, { 1, 4 } },
        { "Frames: 3", "1 2\n3\n4 ?\n6\n7 8\n9\n", "line 12: '?' is not a number; 1 frame", 3, { 1, 1, 7 } },
        { "Frames: 3", "1 2\n3\n4 5\n6\n7 8\n", "line 15: frame 2 has 2 numbers", 2, { 1, 4 } },
        { "Frames: 2", "1 2\n3\n4 5\n6\n7 8\n9\n", "more frames than", 2, { 1, 4 } },
    };
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        char text[512];
        raw_set *set;
        (void)snprintf(text, sizeof text, HEAD "%s\nFrame Time: 0.01\n%s", all[i].head, all[i].rows);
        set = load(text);
        if (all[i].warning) check_warned(text, all[i].count, all[i].warning);
        if (!all[i].warning && set->warning) fail_msg("%zu: %s", i, set->warning);
        assert_int_equal(set->clips[0].frame_count, all[i].count);
        for (uint32_t k = 0; k < all[i].count; k++) {
            check_frame(set, k, all[i].x[k], all[i].x[k] + 1.0, all[i].x[k] + 2.0);
        }
        raw_set_free(set);
    }
}

/* A clip ends before frames at its end that cannot be read. */
static void bad_frames_end_the_clip(void **state)
{
    (void)state;
    check_warned(HEAD CLIP_2 "1 2 3\n1 2\n", 1,
                 "line 11: frame 1 has 2 numbers; the channels need 3; the clip ends before it");
    refused(HEAD CLIP_2 "1 2 3 4\n1 2\n", "frame 0 has more numbers than the 3 channels", "line 10");
    check_warned(HEAD CLIP_2 "1 2 3\n", 1, "ends after 1 of 2 frames");
    check_warned(HEAD CLIP_2 "1 2 3\n\n\n4 5", 1, "line 13: frame 1 has 2 numbers");
    check_warned(HEAD CLIP_2 "1 2 3\n4 5 6\n7 8 9\n1 2 3\n", 2, "more frames than its header gives");
    check_warned(HEAD CLIP_2 "1 2 3\n4 5 6\n7 8\n", 2, "more frames than its header gives");
    check_warned(HEAD CLIP_2 "1 2 3\n4 5 nan\n", 1, "'nan' is not finite");
    refused(HEAD CLIP_2 "1 -inf 3\n4 inf 6\n", "'-inf' is not finite", "line 10");
    check_warned(HEAD CLIP_2 "1 2 3\n4 1e999 6\n", 1, "too large");
    check_warned(HEAD CLIP_2 "1 2 3\n4 1.1e12 6\n", 1, "too large");
    check_warned(HEAD CLIP_2 "1 2 3\n4 0x10 6\n", 1, "'0x10' is not a number");
    check_warned(HEAD CLIP_2 "1 2 3\n4 5,5 6\n", 1, "'5,5' is not a number");
    check_warned(HEAD CLIP_2 "1 2 3\n4 5.5.5 6\n", 1, "'5.5.5' is not a number");
    refused(HEAD CLIP_2, "ends after 0 of 2 frames", "line 10");
}

static void bad_clip_headers(void **state)
{
    (void)state;
    refused(HEAD "Frames: 0\nFrame Time: 0.01\n", "there are no frames", "line 10");
    check_warned(HEAD "Frames: 0\nFrame Time: 0.01\n1 2 3\n4 5 6\n", 2, "the header gives no frames; all that follow");
    check_warned(HEAD "Frames: -5\nFrame Time: 0.01\n1 2 3\n", 1, "line 8: '-5' is not a whole number; all frames");
    check_warned(HEAD "Frames: 99999999999\nFrame Time: 0.01\n1 2 3\n", 1, "above the limit");
    check_warned(HEAD "Frames:\nFrame Time: 0.01\n1 2 3\n", 1, "line 8: a number is missing; all frames that follow");
    refused(HEAD "Frame Time: 0.01\n", "expected 'Frames:'", "line 8");
    refused(HEAD "Frames: 1\n1 2 3\n", "expected 'Frame Time:'", "line 9");
    check_warned(HEAD "Frames: 1\nFrame Time: 0\n1 2 3\n", 1,
                 "the frame time of 0 s is impossible; the clip was read at 30");
    check_warned(HEAD "Frames: 2\nFrame Time: 0\n1 2 3\n", 1, "read at 30 Hz; line 11: the file ends after 1 of 2");
    check_warned(HEAD "Frames: 1\nFrame Time: -0.01\n1 2 3\n", 1, "the frame time of -0.01 s is impossible");
    check_warned(HEAD "Frames: 1\nFrame Time: nan\n1 2 3\n", 1, "not finite; the clip was read at 30 Hz");
    check_warned(HEAD "Frames: 1\nFrame Time:\n1 2 3\n", 1, "not a number; the clip was read at 30 Hz");
    check_warned(HEAD "Frames: 1 frame\nFrame Time: 1\n1 2 3\n", 1, "'frame' is unexpected here; all frames");
    refused(HEAD, "expected 'Frames:'", "line 8");
}

static void bad_hierarchies_are_refused(void **state)
{
    (void)state;
    refused("", "does not start with HIERARCHY", "line 1");
    refused("\n\nglTF", "does not start with HIERARCHY", "line 3");
    refused("HIERARCHY\nMOTION\nFrames: 1\nFrame Time: 1\n1\n", "no ROOT", "line 2");
    refused("HIERARCHY\nJOINT a\n{", "expected ROOT or MOTION, got 'JOINT'", "line 2");
    refused("HIERARCHY\nROOT\n{\nOFFSET 0 0 0\n", "a root has no name", "line 2");
    refused("HIERARCHY\nROOT a\nOFFSET 0 0 0\n", "expected { after the name, got 'OFFSET'", "line 3");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0\nCHANNELS 0\n}\n", "'CHANNELS' is not a number", "line 5");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 1e39\n", "too large", "line 4");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n}\nMOTION\n", "joint 'a' has no CHANNELS", "line 5");
    refused("HIERARCHY\nROOT a\n{\nCHANNELS 1 Xposition\n}\nMOTION\n", "joint 'a' has no OFFSET", "line 5");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation\nJOINT b\n", "'JOINT' is not a channel",
            "line 6");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xscale\n}\n", "'Xscale' is not a channel", "line 5");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 2 Xrotation xrotation\n}\n", "the channel xrotation twice",
            "line 5");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 7 Xrotation\n}\n", "above the limit of 6", "line 5");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation Yrotation\n}\n", "'Yrotation' is not allowed",
            "line 5");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nOFFSET 0 0 0\n}\n", "two OFFSETs", "line 5");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\nCHANNELS 0\n}\n", "two lists of CHANNELS", "line 6");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n}\nMOTION\nFrames: 1\nFrame Time: 1\n\n",
            "no joint has a channel", "line 8");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\nEnd Site\n{\n}\n}\n", "expected OFFSET", "line 8");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nEnd Site\n{\nOFFSET 1 2 3\nJOINT b\n", "expected }", "line 8");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n", "the file ends inside joint 'a'", "line 6");
    refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n}\n}\n", "expected ROOT or MOTION, got '}'", "line 7");
}

static char *chain_of(uint32_t joints)
{
    char *text = test_zeros((size_t)joints * 64 + 256), *at = text;
    at += sprintf(at, "HIERARCHY\n");
    for (uint32_t j = 0; j < joints; ++j)
        at += sprintf(at, "%s j%u\n{\nOFFSET 0 0 0\nCHANNELS %s\n", j ? "JOINT" : "ROOT", j, j ? "0" : "1 Xposition");
    for (uint32_t j = 0; j < joints; ++j) at += sprintf(at, "}\n");
    sprintf(at, "MOTION\nFrames: 1\nFrame Time: 1\n5\n");
    return text;
}

static void joint_limit(void **state)
{
    (void)state;
    char *text = chain_of(4096);
    raw_set *set = load(text);
    assert_int_equal(set->skeleton.joint_count, 4096);
    assert_int_equal(set->skeleton.joints[4095].parent, 4094);
    raw_set_free(set);
    free(text);
    text = chain_of(4097);
    refused(text, "more than 4096 joints", "line 16386");
    free(text);
}

static void frames_too_many_are_a_warning(void **state)
{
    (void)state;
    raw_set *set = load(HEAD CLIP_2 "1 2 3\n4 5 6\n7 8 9\n");
    assert_int_equal(set->clips[0].frame_count, 2);
    assert_non_null(set->warning);
    raw_set_free(set);
    set = load(HEAD CLIP_2 "1 2 3\n4 5 6\n");
    assert_null(set->warning);
    raw_set_free(set);
}

static void huge_promises_need_no_memory(void **state)
{
    (void)state;
    check_warned(HEAD "Frames: 1000000\nFrame Time: 0.01\n1 2 3\n", 1, "ends after 1 of 1000000 frames");
}

static void truncations_are_refused_or_warned_of(void **state)
{
    (void)state;
    const char *text = HEAD CLIP_2 "1 2 3\n4 5 67", *first = strstr(text, "3\n4") + 1;
    char cut[256];
    for (size_t length = 0; length + 1 < strlen(text);
         ++length) { /* without "67" a number is missing, without "7" none is */
        raw_set *set = NULL;
        model_error error = { "", "" };
        memcpy(cut, text, length);
        cut[length] = '\0';
        assert_int_equal(bvh_read(save(cut), NULL, &set, &error), text + length < first);
        if (set) assert_non_null(set->warning);
        if (!set) assert_memory_equal(error.where, "line ", 5);
        raw_set_free(set);
    }
}

static void check_size_warning(const char *offset, double unit_cm, const char *expected)
{
    const bvh_options options = { unit_cm, 0 };
    char text[512];
    (void)snprintf(text, sizeof text,
                   "HIERARCHY\nROOT a\n{\nOFFSET 0 9 0\nCHANNELS 1 Xposition\nEnd Site\n{\nOFFSET %s\n}\n}\nMOTION\n"
                   "Frames: 1\nFrame Time: 0.1\n1\n",
                   offset);
    raw_set *set = load_path(save(text), &options);
    if (!expected) assert_null(set->warning);
    if (expected && (!set->warning || !strstr(set->warning, expected)))
        fail_msg("expected '%s', got '%s'", expected, set->warning ? set->warning : "no warning");
    raw_set_free(set);
}

/* A root on the ground above hips, whose offset is where the person stood: the body's size counts. */
static void check_led_size(const char *hips, const char *head, const char *expected)
{
    char text[512];
    (void)snprintf(text, sizeof text,
                   "HIERARCHY\nROOT ground\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\nJOINT hips\n{\nOFFSET %s\n"
                   "CHANNELS 0\nJOINT head\n{\nOFFSET %s\nCHANNELS 0\nEnd Site\n{\nOFFSET 0 0 0\n}\n}\n"
                   "JOINT foot\n{\nOFFSET 0 -90 0\nCHANNELS 0\nEnd Site\n{\nOFFSET 0 0 0\n}\n}\n}\n}\nMOTION\n"
                   "Frames: 1\nFrame Time: 0.1\n1\n",
                   hips, head);
    raw_set *set = load(text);
    if (!expected) assert_null(set->warning);
    if (expected && (!set->warning || !strstr(set->warning, expected)))
        fail_msg("expected '%s', got '%s'", expected, set->warning ? set->warning : "no warning");
    raw_set_free(set);
}

/* The format has no unit: an implausible size for a person is reported, with the unit that would fit. */
static void sizes_of_people(void **state)
{
    (void)state;
    check_size_warning("0 -1.8 0", 0.0,
                       "the skeleton is 1.8 cm large with a unit of 1 cm; if it is a person, try "
                       "--unit-cm 100");
    check_size_warning("0 -1.8 0", 100.0, NULL);
    check_size_warning("1800 0 0", 0.0, "--unit-cm 0.1");
    check_size_warning("0 0 28", 0.0, "--unit-cm 6.07");
    check_size_warning("0 170 0", 0.0, NULL);
    check_size_warning("0 0 0", 0.0, NULL);
    check_led_size("1 94 -452", "0 80 0", NULL);
    check_led_size("1 94 -452", "0 710 0", "the skeleton is 800 cm large with a unit of 1 cm");
}

static void bad_units_are_refused(void **state)
{
    (void)state;
    raw_set *set = NULL;
    model_error error = { "", "" };
    const bvh_options options = { -1.0, 0 };
    assert_int_equal(bvh_read(save(HEAD CLIP_2), &options, &set, &error), 1);
    assert_non_null(strstr(error.what, "not -1 cm"));
    assert_int_equal(bvh_read(test_path("none.bvh"), NULL, &set, &error), 1);
}

/* --- mutated --- */

static void mutations_never_crash(void **state)
{
    (void)state;
    const char *text = HEAD CLIP_2 "1 2 3\n4 5 6\n";
    const char bytes[] = " \n{}0123456789-+.eE:XYZJROEnd\t\0\xff";
    const char *seconds = getenv("NOH_FUZZ_ROUNDS");
    const uint32_t rounds = seconds ? (uint32_t)strtoul(seconds, NULL, 10) : 20000;
    test_random r = test_random_from(3);
    uint32_t accepted = 0;
    for (uint32_t i = 0; i < rounds; ++i) {
        char changed[256];
        size_t length = strlen(text);
        memcpy(changed, text, length);
        for (uint32_t n = 1 + test_random_below(&r, 4); n > 0; --n)
            changed[test_random_below(&r, (uint32_t)length)] = bytes[test_random_below(&r, sizeof bytes - 1)];
        raw_set *set = NULL;
        model_error error = { "", "" };
        test_write_file(test_path("mutated.bvh"), changed, length);
        if (!bvh_read(test_path("mutated.bvh"), NULL, &set, &error)) ++accepted;
        raw_set_free(set);
    }
    assert_true(accepted > 0 && accepted < rounds);
}

/* --- real files --- */

/* Debian's assimp-testmodels, against .rcl files that another reader made from the same captures. */
static void compare_with_rcl(const char *bvh, const char *rcl, double unit_cm)
{
    struct stat status;
    if (stat(bvh, &status) != 0) test_skip("no %s (Debian: assimp-testmodels)", bvh);
    const bvh_options options = { unit_cm, 0 };
    raw_set *a = load_path(bvh, &options), *b = NULL;
    model_error error = { "", "" };
    if (rcl_read(test_asset(rcl), &b, &error)) fail_msg("%s (%s)", error.what, error.where);
    const raw_clip *ca = &a->clips[0], *cb = &b->clips[0];
    assert_int_equal(raw_skeleton_hash(&a->skeleton), raw_skeleton_hash(&b->skeleton));
    assert_int_equal(ca->frame_count, cb->frame_count);
    assert_true(ca->sample_rate_hz == cb->sample_rate_hz);
    double worst_turn = 0.0, worst_cm = 0.0;
    for (size_t i = 0; i < (size_t)ca->frame_count * ca->joint_count; ++i) {
        double dot = 0.0;
        for (size_t k = 0; k < 4; ++k) dot += (double)ca->rotations[i * 4 + k] * (double)cb->rotations[i * 4 + k];
        for (size_t k = 0; k < 4; ++k)
            worst_turn = fmax(worst_turn, fabs((double)ca->rotations[i * 4 + k] -
                                               copysign(1.0, dot) * (double)cb->rotations[i * 4 + k]));
        for (size_t k = 0; k < 3; ++k)
            worst_cm = fmax(worst_cm,
                            fabs((double)ca->translations[i * 3 + k] * unit_cm - (double)cb->translations[i * 3 + k]));
    }
    print_message("%s: %u frames, largest difference %.3g of a quaternion, %.3g cm\n", rcl, ca->frame_count, worst_turn,
                  worst_cm);
    assert_true(worst_turn < 1e-6 && worst_cm < 1e-3);
    raw_set_free(a);
    raw_set_free(b);
}

#define MODELS "/usr/share/assimp/models/BVH/"

static void real_walk(void **state)
{
    (void)state;
    compare_with_rcl(MODELS "01_01.bvh", "clips/cmu_01_01.rcl", 5.6444);
}

static void real_climb(void **state)
{
    (void)state;
    compare_with_rcl(MODELS "01_03.bvh", "clips/cmu_01_03.rcl", 5.6444);
}

static void real_boxing(void **state)
{
    (void)state;
    struct stat status;
    if (stat(MODELS "Boxing_Toes.bvh", &status) != 0)
        test_skip("no " MODELS "Boxing_Toes.bvh (Debian: assimp-testmodels)");
    raw_set *set = load_path(MODELS "Boxing_Toes.bvh", NULL);
    assert_int_equal(set->clips[0].frame_count, 3069); /* as announced; the file has 3070 */
    assert_non_null(set->warning);
    assert_int_equal(set->skeleton.joint_count, 21);
    assert_true(set->clips[0].sample_rate_hz == 100.0);
    raw_set_free(set);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_small_skeleton),
    cmocka_unit_test(any_order_of_rotations),
    cmocka_unit_test(positions_between_rotations_on_any_joint),
    cmocka_unit_test(several_roots),
    cmocka_unit_test(end_sites_as_joints),
    cmocka_unit_test(other_spellings),
    cmocka_unit_test(signs_do_not_jump),
    cmocka_unit_test(whole_rates_are_recognised),
    cmocka_unit_test(bad_frames_repeat_the_nearest),
    cmocka_unit_test(frames_may_be_wrapped),
    cmocka_unit_test(bad_frames_end_the_clip),
    cmocka_unit_test(bad_clip_headers),
    cmocka_unit_test(bad_hierarchies_are_refused),
    cmocka_unit_test(joint_limit),
    cmocka_unit_test(frames_too_many_are_a_warning),
    cmocka_unit_test(huge_promises_need_no_memory),
    cmocka_unit_test(truncations_are_refused_or_warned_of),
    cmocka_unit_test(sizes_of_people),
    cmocka_unit_test(bad_units_are_refused),
    cmocka_unit_test(mutations_never_crash),
    cmocka_unit_test(real_walk),
    cmocka_unit_test(real_climb),
    cmocka_unit_test(real_boxing),
};

TEST_MAIN(tests, NULL, NULL)
