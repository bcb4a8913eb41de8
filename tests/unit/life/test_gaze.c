/* Tests of gaze.c and reach.c: real characters look at points and put their hands on them. */
#include <math.h>
#include <string.h>

#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/gaze_internal.h"
#include "life/reach/reach_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "support/skin_asset.h"
#include "support/support.h"

#define FRAME (1.0f / 60.0f)
#define DEGREES 57.29577951f

typedef struct body {
    skin_asset a;
    noh_skeleton joints;
    noh_gaze_rig gaze;
    noh_reach_rig reach;
    noh_transform pose[NOH_JOINTS_MAX];
    float metre; /* in the skeleton's unit */
} body;

static const char *const persons[] = { "hero/body.glb", "khronos/RobotExpressive.glb" };

static noh_ragdoll_source open_body(body *b, const char *name)
{
    noh_ragdoll_source source = { 0 };
    const noh_skeleton_header *header;
    memset(b, 0, sizeof *b);
    skin_asset_open(&b->a, name, NULL);
    source.pack = &b->a.pack;
    assert_int_equal(noh_pack_skeleton_at(&b->a.pack, 0, &b->joints, &header, NULL), NOH_OK);
    source.joints = b->joints;
    b->metre = 100.0f / (float)header->unit_cm;
    return source;
}

static void open_person(body *b, const char *name)
{
    const noh_ragdoll_source source = open_body(b, name);
    assert_int_equal(noh_gaze_rig_make(source.pack, 0, &b->gaze, NULL), NOH_OK);
    if (noh_reach_rig_make(&source, &b->reach, NULL) != NOH_OK) b->reach.arm_count = 0;
}

static void pose_bind(body *b)
{
    memcpy(b->pose, b->joints.bind_pose, b->joints.joint_count * sizeof *b->pose);
}

static void joint_at(const body *b, uint32_t joint, float at[3], float rotation[4])
{
    noh_skeleton posed = b->joints;
    posed.bind_pose = b->pose;
    noh_ragdoll_bind(&posed, joint, at, rotation);
}

static float angle(const float a[3], const float b[3])
{
    const float x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return DEGREES * atan2f(sqrtf(x * x + y * y + z * z), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* The head's own place and direction. */
static void face_of(const body *b, float middle[3], float ahead[3])
{
    float rotation[4], way[3];
    joint_at(b, b->gaze.joints[b->gaze.joint_count - 1u], middle, rotation);
    noh_quat_rotate(rotation, b->gaze.middle, way);
    noh_quat_rotate(rotation, b->gaze.ahead, ahead);
    for (int i = 0; i < 3; i++) middle[i] += way[i];
}

/* Degrees by which it looks past a point: the worse eye, or the head. */
static float missed(const body *b, const float target[3])
{
    float at[3], ahead[3], way[3], rotation[4], worst = 0.0f;
    if (b->gaze.eyes[0] == NOH_NONE) {
        face_of(b, at, ahead);
        for (int i = 0; i < 3; i++) way[i] = target[i] - at[i];
        return angle(ahead, way);
    }
    for (int e = 0; e < 2; e++) {
        joint_at(b, b->gaze.eyes[e], at, rotation);
        noh_quat_rotate(rotation, b->gaze.eyes_ahead[e], ahead);
        for (int i = 0; i < 3; i++) way[i] = target[i] - at[i];
        worst = fmaxf(worst, angle(ahead, way));
    }
    return worst;
}

/* A point before the face, off by these angles, in degrees; distance in sizes of the rig. */
static void point_at(const body *b, float yaw, float pitch, float sizes, float target[3])
{
    float middle[3], ahead[3];
    face_of(b, middle, ahead);
    yaw /= DEGREES, pitch /= DEGREES;
    target[0] = middle[0] + sizes * b->gaze.size * sinf(yaw) * cosf(pitch);
    target[1] = middle[1] + sizes * b->gaze.size * sinf(pitch);
    target[2] = middle[2] + sizes * b->gaze.size * cosf(yaw) * cosf(pitch);
}

static void step_gaze(body *b, noh_gaze *g, const float *target, float seconds)
{
    pose_bind(b);
    noh_gaze_step(g, &b->gaze, &b->joints, b->pose, target, seconds, 0);
}

/* ---- rigs ---- */

/* Heads are on top, eyes before and above their joint, and what turns has neck and spine. */
static void persons_have_gazes(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(persons); i++) {
        static body b;
        float middle[3], ahead[3], head[3], rotation[4], sum = 0.0f;
        open_person(&b, persons[i]);
        pose_bind(&b);
        face_of(&b, middle, ahead);
        joint_at(&b, b.gaze.joints[b.gaze.joint_count - 1u], head, rotation);
        for (uint32_t j = 0; j < b.gaze.joint_count; j++) sum += b.gaze.shares[j];
        assert_true(b.gaze.joint_count >= 3 && fabsf(sum - 1.0f) < 1e-5f);
        assert_true(ahead[2] > 0.9999f && middle[1] > head[1]);
        assert_true(b.gaze.size > middle[1] - head[1]);
        if (i == 0) {
            assert_true(middle[1] - head[1] < 0.2f * b.metre && b.gaze.size < 0.9f * b.metre);
            assert_int_equal(b.reach.arm_count, 2);
            joint_at(&b, b.reach.arms[0].upper, head, rotation);
            assert_true(head[0] > 0.0f);
        }
        skin_asset_close(&b.a);
    }
}

/* An animal looks too; a skeleton whose joints are named otherwise is told apart, not guessed. */
static void others_do_or_say_why_not(void **state)
{
    static body b;
    noh_error said = { NOH_OK, "", 0, 0 };
    noh_gaze g = { 0 };
    noh_reach_rig reach;
    float target[3];
    noh_ragdoll_source source = open_body(&b, "khronos/Fox.glb");
    (void)state;
    assert_int_equal(noh_gaze_rig_make(source.pack, 0, &b.gaze, NULL), NOH_OK);
    pose_bind(&b);
    point_at(&b, 30.0f, -10.0f, 3.0f, target);
    step_gaze(&b, &g, target, FRAME);
    if (missed(&b, target) > 0.1f) fail_msg("a fox: %g degrees off", (double)missed(&b, target));
    assert_int_equal(noh_reach_rig_make(&source, &reach, &said), NOH_ERR_NOT_FOUND);
    skin_asset_close(&b.a);
    source = open_body(&b, "khronos/SimpleSkin.gltf");
    assert_int_equal(noh_gaze_rig_make(source.pack, 0, &b.gaze, &said), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "head"));
    skin_asset_close(&b.a);
}

/* ---- gazes ---- */

static void a_body_looks_at_its_point(void **state)
{
    static const float angles[][2] = { { 0, 0 }, { 40, 0 }, { -40, 10 }, { 0, 35 }, { 0, -35 }, { 25, -25 } };
    static const float distances[] = { 1.2f, 5.0f, 80.0f };
    (void)state;
    for (size_t p = 0; p < TEST_COUNT(persons); p++) {
        static body b;
        open_person(&b, persons[p]);
        for (size_t i = 0; i < TEST_COUNT(angles); i++) {
            for (size_t d = 0; d < TEST_COUNT(distances); d++) {
                noh_gaze g = { 0 };
                float target[3];
                pose_bind(&b);
                point_at(&b, angles[i][0], angles[i][1], distances[d], target);
                step_gaze(&b, &g, target, FRAME);
                if (missed(&b, target) > 0.2f) fail_msg("%s: %g degrees off", persons[p], (double)missed(&b, target));
            }
        }
        skin_asset_close(&b.a);
    }
}

/* A point that goes round: within the cone it is followed, behind it the face stays turned towards the side where it went,
 * then comes round once; no joint turns faster than the head may. */
static void a_point_that_goes_round(void **state)
{
    static body b;
    static noh_transform before[NOH_JOINTS_MAX];
    noh_gaze g = { 0 };
    float target[3], fastest = 0.0f, least[2] = { 1e9f, 1e9f };
    uint32_t followed = 0, sides = 0;
    (void)state;
    open_person(&b, persons[0]);
    for (int f = 0; f < 720; f++) {
        const float yaw = 0.5f * (float)f;
        pose_bind(&b);
        point_at(&b, yaw, 5.0f, 4.0f, target);
        step_gaze(&b, &g, target, FRAME);
        for (uint32_t j = 0; f && j < b.joints.joint_count; j++) {
            const float turned = 2.0f * acosf(fminf(1.0f, fabsf(noh_quat_dot(before[j].rotation, b.pose[j].rotation))));
            const int is_eye = j == b.gaze.eyes[0] || j == b.gaze.eyes[1];
            if (!is_eye) fastest = fmaxf(fastest, turned / FRAME);
        }
        memcpy(before, b.pose, sizeof before);
        if (f > 60 && yaw < 55.0f) {
            followed++;
            assert_true(missed(&b, target) < 2.0f);
        }
        if ((yaw > 100.0f && yaw < 199.0f) || (yaw > 260.0f && yaw < 290.0f)) {
            float middle[3], ahead[3];
            const float z[3] = { 0.0f, 0.0f, 1.0f };
            face_of(&b, middle, ahead);
            least[yaw > 200.0f] = fminf(least[yaw > 200.0f], angle(ahead, z));
            sides += (ahead[0] > 0.0f) == (yaw < 200.0f);
            assert_true(g.head.follows != 0);
        }
    }
    assert_true(followed > 10);
    assert_int_equal(sides, 197 + 59);
    assert_true(least[0] > 40.0f && least[1] > 40.0f);
    assert_true(fastest < 4.2f);
    assert_null(noh_gaze_check(&g));
    skin_asset_close(&b.a);
}

/* ---- hands ---- */

static void palm_at(const body *b, uint32_t arm, float at[3])
{
    float rotation[4];
    joint_at(b, b->reach.arms[arm].hand, at, rotation);
}

static float arm_length(const body *b, uint32_t arm)
{
    float s[3], m[3], e[3], unused[4];
    joint_at(b, b->reach.arms[arm].upper, s, unused);
    joint_at(b, b->reach.arms[arm].fore, m, unused);
    joint_at(b, b->reach.arms[arm].hand, e, unused);
    return hypotf(hypotf(m[0] - s[0], m[1] - s[1]), m[2] - s[2]) +
           hypotf(hypotf(e[0] - m[0], e[1] - m[1]), e[2] - m[2]);
}

/* Before the shoulder, `part` of the arm away, as a point goes round. */
static void point_before(const body *b, uint32_t arm, float turn, float part, float point[3])
{
    float unused[4];
    joint_at(b, b->reach.arms[arm].upper, point, unused);
    const float length = part * arm_length(b, arm);
    point[0] += length * 0.6f * sinf(turn);
    point[1] += length * 0.6f * cosf(turn);
    point[2] += length * 0.8f;
}

/* Hands meet points that move, elbows point back and down rather than up, and no 1 mm turns a joint by 2 degrees. */
static void hands_meet_points_that_move(void **state)
{
    (void)state;
    static body b;
    static noh_transform before[NOH_JOINTS_MAX];
    noh_reach r = { 0 };
    float points[NOH_REACH_ARMS_MAX][3] = { { 0.0f } }, worst = 0.0f, most = 0.0f;
    open_person(&b, persons[0]);
    for (int f = 0; f < 600; f++) {
        pose_bind(&b);
        for (uint32_t a = 0; a < 2; a++) {
            /* 1 mm a frame */
            point_before(&b, a, (float)f * 0.001f * b.metre / (0.6f * 0.8f * arm_length(&b, a)), 0.8f, points[a]);
            r.hands[a].wants = 1;
        }
        noh_reach_step(&r, &b.reach, &b.joints, b.pose, points, FRAME, f == 0);
        for (uint32_t j = 0; f && j < b.joints.joint_count; j++) {
            const float dot = fminf(1.0f, fabsf(noh_quat_dot(before[j].rotation, b.pose[j].rotation)));
            most = fmaxf(most, 2.0f * acosf(dot) * DEGREES);
        }
        memcpy(before, b.pose, sizeof before);
        for (uint32_t a = 0; a < 2; a++) {
            float at[3], shoulder[3], elbow[3], unused[4];
            palm_at(&b, a, at);
            joint_at(&b, b.reach.arms[a].upper, shoulder, unused);
            joint_at(&b, b.reach.arms[a].fore, elbow, unused);
            for (int i = 0; i < 3; i++) worst = fmaxf(worst, fabsf(at[i] - points[a][i]) / b.metre);
            assert_true(elbow[1] < fmaxf(shoulder[1], at[1]) + 0.02f * b.metre);
        }
    }
    printf("  %-22s off by %.1f um, a joint turns by %.3f degrees for 1 mm\n", persons[0], 1e6 * worst, most);
    assert_true(worst < 2e-4f && most < 2.0f);
    skin_asset_close(&b.a);
}

/* There in a third of a second, back as long, without a leap; then the pose is the clip's to the byte. */
static void a_hand_comes_and_goes(void **state)
{
    static body b;
    noh_reach r = { 0 };
    float points[NOH_REACH_ARMS_MAX][3] = { { 0.0f } }, last[3] = { 0.0f }, fastest = 0.0f;
    (void)state;
    open_person(&b, persons[0]);
    for (int f = 0; f < 120; f++) {
        float at[3], way = 0.0f;
        pose_bind(&b);
        point_before(&b, 0, 1.0f, 0.8f, points[0]);
        r.hands[0].wants = f >= 10 && f < 60;
        noh_reach_step(&r, &b.reach, &b.joints, b.pose, points, FRAME, 0);
        palm_at(&b, 0, at);
        for (int i = 0; i < 3; i++) way += (at[i] - last[i]) * (at[i] - last[i]);
        if (f) fastest = fmaxf(fastest, sqrtf(way) / b.metre);
        memcpy(last, at, sizeof last);
        way = 0.0f;
        for (int i = 0; i < 3; i++) way = fmaxf(way, fabsf(at[i] - points[0][i]) / b.metre);
        if (f > 40 && f < 60) assert_true(way < 2e-4f);
    }
    assert_memory_equal(b.pose, b.joints.bind_pose, b.joints.joint_count * sizeof *b.pose);
    assert_true(fastest < 0.1f);
    assert_null(noh_reach_check(&r));
    skin_asset_close(&b.a);
}

/* ---- all points ---- */

static int is_sound(const body *b)
{
    for (uint32_t j = 0; j < b->joints.joint_count; j++) {
        const float square = noh_quat_dot(b->pose[j].rotation, b->pose[j].rotation);
        if (!(square > 0.99f && square < 1.01f)) return 0;
    }
    return 1;
}

static void no_point_makes_a_nan(void **state)
{
    static body b;
    static const float scales[] = { 0.0f, 1e-6f, 0.1f, 1.0f, 1e6f };
    noh_gaze g = { 0 };
    noh_reach r = { 0 };
    uint32_t seed = 5u;
    (void)state;
    open_person(&b, persons[0]);
    for (int n = 0; n < 2000; n++) {
        float points[NOH_REACH_ARMS_MAX][3], middle[3], ahead[3], unused[4];
        pose_bind(&b);
        face_of(&b, middle, ahead);
        for (uint32_t a = 0; a < 2; a++) joint_at(&b, b.reach.arms[a].upper, points[a], unused);
        for (int i = 0; i < 9; i++) {
            seed = seed * 1664525u + 1013904223u;
            const float by = ((float)(seed >> 8) / 8388608.0f - 1.0f) * scales[n % 5];
            if (i < 3)
                middle[i] += by;
            else
                points[(i - 3) / 3][i % 3] += by;
        }
        r.hands[0].wants = n % 3 != 0, r.hands[1].wants = n % 4 != 0;
        step_gaze(&b, &g, n % 7 ? middle : NULL, n % 11 ? FRAME : 0.0f);
        noh_reach_step(&r, &b.reach, &b.joints, b.pose, points, FRAME, n % 13 == 0);
        if (!is_sound(&b) || noh_gaze_check(&g) || noh_reach_check(&r)) fail_msg("case %d", n);
    }
    skin_asset_close(&b.a);
}

static void states_are_looked_at(void **state)
{
    static body b;
    noh_gaze g = { 0 };
    noh_reach r = { 0 };
    (void)state;
    assert_null(noh_gaze_check(&g));
    assert_null(noh_reach_check(&r));
    open_person(&b, persons[0]);
    step_gaze(&b, &g, NULL, FRAME);
    for (int i = 0; i < 5; i++) {
        noh_gaze bad = g;
        if (i == 0) bad.head.direction[0] = 3.0f;
        if (i == 1) bad.looks = 2;
        if (i == 2) bad.near = NAN;
        if (i == 3) bad.point[1] = INFINITY;
        if (i == 4) bad.eyes.follows = 4;
        assert_non_null(noh_gaze_check(&bad));
    }
    for (int i = 0; i < 3; i++) {
        noh_reach bad = r;
        if (i == 0) bad.hands[1].point[2] = NAN;
        if (i == 1) bad.hands[0].wants = 7;
        if (i == 2) bad.hands[0].part = 1.5f;
        assert_non_null(noh_reach_check(&bad));
    }
    skin_asset_close(&b.a);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(persons_have_gazes),          cmocka_unit_test(others_do_or_say_why_not),
        cmocka_unit_test(a_body_looks_at_its_point),   cmocka_unit_test(a_point_that_goes_round),
        cmocka_unit_test(hands_meet_points_that_move), cmocka_unit_test(a_hand_comes_and_goes),
        cmocka_unit_test(no_point_makes_a_nan),        cmocka_unit_test(states_are_looked_at),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
