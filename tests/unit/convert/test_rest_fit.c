/* test_rest_fit.c: a VRM animation played by a body whose joints rest otherwise, and one joint that the animation
 * lacks. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/raw_set.h"
#include "convert/clips/rest_fit.h"

static raw_joint joint(uint32_t parent, const float q[4], float x, float y, float z)
{
    raw_joint j;
    memset(&j, 0, sizeof j);
    j.parent = parent;
    memcpy(j.rotation, q, sizeof j.rotation);
    j.translation[0] = x;
    j.translation[1] = y;
    j.translation[2] = z;
    j.scale[0] = j.scale[1] = j.scale[2] = 1.0f;
    j.node = MODEL_NONE;
    return j;
}

/* A turn by `radians` about z. */
static void about_z(double radians, const double *v, double *out)
{
    out[0] = cos(radians) * v[0] - sin(radians) * v[1];
    out[1] = sin(radians) * v[0] + cos(radians) * v[1];
    out[2] = v[2];
}

static void joints_turn_as_their_counterparts_do(void **state)
{
    static const float none[4] = { 0, 0, 0, 1 }, z90[4] = { 0, 0, 0.70710678f, 0.70710678f },
                       other[4] = { 0.5f, 0.5f, -0.5f, 0.5f }, x60[4] = { 0.5f, 0, 0, 0.8660254f };
    static const uint32_t counterpart[4] = { MODEL_NONE, 0, MODEL_NONE, 1 };
    raw_joint theirs[2] = { joint(MODEL_NONE, none, 0, 1, 0), joint(0, none, 0.5f, 0, 0) };
    raw_joint ours[4] = { joint(MODEL_NONE, z90, 0, 0, 3), joint(0, other, 2, 0, 0), joint(1, x60, 0, -1, 0),
                          joint(2, z90, 0, 0.5f, 0) };
    const raw_skeleton from = { NULL, 2, theirs, 100.0 }, to = { NULL, 4, ours, 1.0 }; /* metres; centimetres */
    double rest[48], pose[48];
    raw_clip clip, out;
    (void)state;
    memset(&clip, 0, sizeof clip);
    assert_int_equal(raw_clip_alloc(&clip, 2, 2), 0);
    for (size_t i = 0; i < 4; i++) {
        memcpy(clip.rotations + 4 * i, none, sizeof none);
        for (int k = 0; k < 3; k++) clip.scales[3 * i + (size_t)k] = 1.0f;
        memcpy(clip.translations + 3 * i, theirs[i % 2].translation, 3 * sizeof(float));
    }
    clip.rotations[4 * 3 + 2] = (float)sin(0.5); /* frame 1: the arm turns by a radian, the hips move */
    clip.rotations[4 * 3 + 3] = (float)cos(0.5);
    clip.translations[3 * 2] = 0.25f;
    memset(&out, 0, sizeof out);
    assert_int_equal(raw_clip_alloc(&out, 2, 4), 0);
    assert_int_equal(rest_fit_clip(&from, &to, counterpart, &clip, &out), 0);
    for (size_t j = 0; j < 4; j++) { /* frames are in metres */
        for (int k = 0; k < 3; k++) ours[j].translation[k] *= 0.01f;
    }
    raw_pose_object(&to, NULL, 0, rest);
    raw_pose_object(&to, &out, 0, pose);
    for (int i = 0; i < 48; i++) assert_true(fabs(pose[i] - rest[i]) < 1e-6); /* at rest: nothing has turned or moved */
    raw_pose_object(&to, &out, 1, pose);
    for (int i = 0; i < 36; i++) { /* the hips and what has no counterpart only move */
        const double moved = i % 12 == 9 && i >= 12 ? 0.25 * 0.02 : 0.0;
        assert_true(fabs(pose[i] - rest[i] - moved) < 1e-6);
    }
    for (int c = 0; c < 3; c++) {
        double turned[3];
        about_z(1.0, rest + 36 + 3 * c, turned);
        for (int k = 0; k < 3; k++) assert_true(fabs(pose[36 + 3 * c + k] - turned[k]) < 1e-6);
    }
    raw_clip_clear(&clip);
    raw_clip_clear(&out);
}

static const struct CMUnitTest tests[] = { cmocka_unit_test(joints_turn_as_their_counterparts_do) };

TEST_MAIN(tests, NULL, NULL)
