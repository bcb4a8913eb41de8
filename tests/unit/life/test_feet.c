/* Tests of feet.c, feet_rig.c and feet_ground.c: the ground below a point, legs and soles of real
 * characters, and poses that are put on the ground. Walks are in test_stage_feet. */
#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/feet_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include <math.h>
#include <string.h>

#include "support/skin_asset.h"
#include "support/support.h"

/* ---- the ground ---- */

static float below(const noh_world *w, float x, float y, float z, float depth, float normal[3])
{
    const noh_ground ground = { w, NULL, NULL };
    const float from[3] = { x, y, z };
    return noh_ground_below(&ground, from, depth, normal);
}

static void the_nearest_obstacle_is_the_ground(void **state)
{
    static const uint16_t heights[4] = { 0, 1000, 0, 1000 };
    const noh_field field = { heights, 2, 2, { 10.0f, 0.0f, 0.0f }, 1.0f, 0.001f };
    const noh_plane planes[2] = { { { 0.0f, 1.0f, 0.0f }, -1.0f }, { { 1.0f, 0.0f, 0.0f }, -50.0f } };
    const noh_obb box = { { 0.0f, 0.0f, 0.0f }, { 1.0f, 0.5f, 1.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_capsule ball = { { 5.0f, 0.0f, 0.0f }, { 5.0f, 0.0f, 0.0f }, 1.0f };
    noh_world w = { planes, &ball, &box, 2, 1, 1, &field, 0.0f, 0.0f, NULL };
    float n[3];
    (void)state;
    assert_true(fabsf(below(&w, 0.2f, 2.0f, 0.1f, 9.0f, n) - 1.5f) < 1e-6f && n[1] > 0.9999f);
    assert_true(fabsf(below(&w, 3.0f, 2.0f, 0.0f, 9.0f, n) - 3.0f) < 1e-6f && n[1] > 0.9999f);
    assert_true(fabsf(below(&w, 5.5f, 2.0f, 0.0f, 9.0f, n) - (2.0f - sqrtf(0.75f))) < 1e-5f);
    assert_true(fabsf(n[0] - 0.5f) < 1e-5f && fabsf(n[1] - sqrtf(0.75f)) < 1e-5f);
    assert_true(fabsf(below(&w, 10.5f, 2.0f, 0.5f, 9.0f, n) - 1.5f) < 1e-5f && fabsf(n[0] + n[1]) < 1e-5f);
    assert_true(fabsf(below(&w, 0.2f, 0.2f, 0.1f, 9.0f, n) - 1.2f) < 1e-6f); /* within the box: it is not seen */
    assert_true(below(&w, 3.0f, 2.0f, 0.0f, 2.9f, n) < 0.0f);
    w.plane_count = 0;
    assert_true(below(&w, 3.0f, 2.0f, 0.0f, 9.0f, n) < 0.0f);
    assert_true(below(NULL, 3.0f, 2.0f, 0.0f, 9.0f, n) < 0.0f);
}

/* A plank on its edge, turned by 80 degrees about z: what is stood on is its broad side, wherever a foot is. */
static void a_turned_box_is_stood_on_its_side(void **state)
{
    const float turn[3] = { 0.0f, 0.0f, 80.0f * 3.14159265f / 180.0f }, side[2] = { cosf(turn[2]), sinf(turn[2]) };
    noh_obb box = { { 0.0f, 0.0f, 0.0f }, { 0.1f, 2.0f, 1.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_world w = { .boxes = &box, .box_count = 1 };
    (void)state;
    noh_quat_from_rotation(turn, box.rotation);
    for (int i = -15; i <= 15; i++) {
        const float along = 0.1f * (float)i, x = 0.1f * side[0] - along * side[1], y = 0.1f * side[1] + along * side[0];
        float n[3];
        assert_float_equal(below(&w, x, 3.0f, 0.2f, 9.0f, n), 3.0f - y, 1e-4f);
        assert_true(fabsf(n[0] - side[0]) < 1e-5f && fabsf(n[1] - side[1]) < 1e-5f && fabsf(n[2]) < 1e-5f);
    }
}

static float ask(const void *user, const float from[3], float depth, float normal[3])
{
    const float height = *(const float *)user;
    normal[0] = normal[2] = 0.0f;
    normal[1] = 1.0f;
    return from[1] - height <= depth ? from[1] - height : 1e9f;
}

/* ---- characters ---- */

typedef struct stood {
    skin_asset a;
    noh_skeleton joints;
    noh_feet_rig rig;
    noh_transform pose[NOH_JOINTS_MAX];
    noh_feet feet;
    noh_feet_place place;
} stood;

static void open_stood(stood *s, const char *name)
{
    noh_ragdoll_source source = { 0 };
    const noh_skeleton_header *header;
    skin_asset_open(&s->a, name, NULL);
    source.pack = &s->a.pack;
    assert_int_equal(noh_pack_skeleton_at(&s->a.pack, 0, &s->joints, &header, NULL), NOH_OK);
    source.joints = s->joints;
    assert_int_equal(noh_feet_rig_make(&source, &s->rig, NULL), NOH_OK);
    memset(&s->place, 0, sizeof s->place);
    s->place.rotation[3] = 1.0f;
    s->place.scale = (float)header->unit_cm / 100.0f;
    noh_feet_init(&s->feet);
}

static void pose_bind(stood *s)
{
    memcpy(s->pose, s->joints.bind_pose, s->joints.joint_count * sizeof *s->pose);
}

/* A point of a sole in the world, as the pose has it. */
static void sole_point(const stood *s, uint32_t leg, uint32_t point, float out[3])
{
    noh_skeleton posed = s->joints;
    const noh_feet_point *p = &s->rig.legs[leg].points[point];
    float rotation[4];
    posed.bind_pose = s->pose;
    noh_ragdoll_bind(&posed, p->joint, out, rotation);
    float turned[3];
    noh_quat_rotate(rotation, p->at, turned);
    for (int i = 0; i < 3; i++) out[i] = (out[i] + turned[i]) * s->place.scale + s->place.position[i];
}

static float lowest(const stood *s, uint32_t leg)
{
    float least = 1e9f;
    for (uint32_t i = 0; i < NOH_FEET_POINTS; i++) {
        float p[3];
        sole_point(s, leg, i, p);
        least = p[1] < least ? p[1] : least;
    }
    return least;
}

static void step_for(stood *s, const noh_ground *ground, int frames)
{
    for (int f = 0; f < frames; f++) {
        pose_bind(s);
        noh_feet_step(&s->feet, &s->rig, &s->joints, s->pose, &s->place, ground, 1.0f / 60.0f, 0);
    }
}

static const char *const assets[] = { "hero/body.glb" };

/* Soles are the lowest skin, heels are behind the toes, and a leg is about half of a person. */
static void legs_are_found_in_real_characters(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(assets); i++) {
        static stood s;
        open_stood(&s, assets[i]);
        assert_int_equal(s.rig.leg_count, 2);
        pose_bind(&s);
        for (uint32_t l = 0; l < 2; l++) {
            float heel[3], toes[3];
            sole_point(&s, l, 0, heel);
            sole_point(&s, l, 4, toes);
            assert_true(hypotf(heel[0] - toes[0], heel[2] - toes[2]) > 0.12f);
            assert_true(toes[2] > heel[2] && fabsf(lowest(&s, l)) < 0.03f);
        }
        assert_true(s.rig.length * s.place.scale > 0.6f && s.rig.length * s.place.scale < 1.1f);
        skin_asset_close(&s.a);
    }
}

/* Over a floor that moves up and down: soles on it, wherever the place is; far below or without any, as the clip is. */
static void a_pose_stands_on_what_the_game_says(void **state)
{
    static const float heights[] = { 0.0f, 0.15f, -0.1f };
    static stood s;
    noh_ground ground = { NULL, ask, NULL };
    (void)state;
    open_stood(&s, assets[0]);
    for (int i = 0; i < 3; i++) {
        ground.user = &heights[i];
        step_for(&s, &ground, 120);
        for (uint32_t l = 0; l < 2; l++) {
            assert_int_equal(s.feet.feet[l].is_held, 1);
            assert_true(fabsf(lowest(&s, l) - heights[i]) < 0.001f);
        }
    }
    const float far = -9.0f;
    ground.user = &far;
    step_for(&s, &ground, 120);
    for (uint32_t j = 0; j < s.joints.joint_count; j++) {
        for (int k = 0; k < 3; k++) {
            assert_true(fabsf(s.pose[j].translation[k] - s.joints.bind_pose[j].translation[k]) < 1e-2f);
        }
        assert_true(fabsf(noh_quat_dot(s.pose[j].rotation, s.joints.bind_pose[j].rotation)) > 0.9999f);
    }
    skin_asset_close(&s.a);
}

/* One foot on a block: the other on the floor, the pelvis with the lower one. */
static void each_foot_has_its_own_ground(void **state)
{
    static stood s;
    const noh_plane floor = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    const noh_obb block = { { 5.0f, 0.0f, 0.0f }, { 5.0f, 0.2f, 5.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_world w = { &floor, NULL, &block, 1, 0, 1, NULL, 0.0f, 0.0f, NULL };
    const noh_ground ground = { &w, NULL, NULL };
    float p[3];
    (void)state;
    open_stood(&s, assets[0]);
    step_for(&s, &ground, 120);
    for (uint32_t l = 0; l < 2; l++) {
        sole_point(&s, l, 0, p);
        assert_true(fabsf(lowest(&s, l) - (p[0] > 0.0f ? 0.2f : 0.0f)) < 0.001f);
    }
    assert_true(fabsf(s.feet.pelvis) < 0.05f);
    skin_asset_close(&s.a);
}

/* The same instant once more, as paused games have it, is the same pose; and states are looked at before they are
 * taken. */
static void the_same_instant_is_the_same_pose(void **state)
{
    static stood s;
    static noh_transform first[NOH_JOINTS_MAX];
    const float height = 0.1f;
    const noh_ground ground = { NULL, ask, &height };
    (void)state;
    open_stood(&s, assets[0]);
    step_for(&s, &ground, 10);
    memcpy(first, s.pose, sizeof first);
    const noh_feet before = s.feet;
    pose_bind(&s);
    noh_feet_step(&s.feet, &s.rig, &s.joints, s.pose, &s.place, &ground, 0.0f, 0);
    assert_memory_equal(&before, &s.feet, sizeof before);
    assert_memory_equal(first, s.pose, s.joints.joint_count * sizeof *first);
    assert_null(noh_feet_check(&s.feet));
    for (int i = 0; i < 10; i++) {
        noh_feet bad = s.feet;
        if (i == 0) bad.feet[1].part = 3;
        if (i == 1) bad.pelvis = NAN;
        if (i == 2) bad.feet[0].normal[1] = 0.5f;
        if (i == 3) bad.feet[0].stands = 1.5f;
        if (i == 4) bad.begun = 2;
        if (i == 5) bad.kept = NOH_FEET_LEGS_MAX + 1u;
        if (i == 6) bad.feet[NOH_FEET_LEGS_MAX - 1u].is_held = 2;
        if (i == 7) bad.feet[0].has_ground = 2;
        if (i == 8) bad.feet[1].was[2][2] = INFINITY;
        if (i == 9) bad.feet[1].held[1] = NAN;
        assert_non_null(noh_feet_check(&bad));
    }
    skin_asset_close(&s.a);
}

/* A shin is a hinge that bends backwards: what only bends, or only points backwards, is none. */
static void what_is_no_shin_makes_no_leg(void **state)
{
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    noh_pack_ragdoll_row own[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_source source = { 0 };
    noh_feet_rig rig;
    uint32_t count, shin = NOH_NONE;
    skin_asset a;
    (void)state;
    skin_asset_open(&a, assets[0], NULL);
    source.pack = &a.pack;
    assert_int_equal(noh_pack_skeleton_at(&a.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    assert_int_equal(noh_ragdoll_find_rows(&source, rows, &count, NULL), NOH_OK);
    for (uint32_t i = 0; i < count; i++) {
        const char *name = noh_pack_joint_name(&a.pack, 0, rows[i].joint);
        own[i] = (noh_pack_ragdoll_row){ .joint = (uint32_t)(name - noh_pack_string(&a.pack, 0)),
                                         .hinge = rows[i].hinge,
                                         .toward = rows[i].toward };
        if (rows[i].hinge && rows[i].toward == NOH_RAGDOLL_BACKWARD) shin = i;
    }
    a.pack.ragdoll_rows = own;
    a.pack.ragdoll_row_count = count;
    assert_true(shin != NOH_NONE);
    for (uint32_t hinge = 0; hinge < 2; hinge++) {
        for (uint32_t toward = NOH_RAGDOLL_FORWARD; toward <= NOH_RAGDOLL_BACKWARD; toward++) {
            own[shin].hinge = hinge;
            own[shin].toward = toward;
            assert_int_equal(noh_feet_rig_make(&source, &rig, NULL), NOH_OK);
            assert_int_equal(rig.leg_count, hinge && toward == NOH_RAGDOLL_BACKWARD ? 2 : 1);
        }
    }
    skin_asset_close(&a);
}

static void what_has_no_feet_is_refused(void **state)
{
    noh_ragdoll_source source = { 0 };
    noh_feet_rig rig;
    noh_error said;
    skin_asset a;
    (void)state;
    skin_asset_open(&a, "khronos/Fox.glb", NULL);
    source.pack = &a.pack;
    assert_int_equal(noh_pack_skeleton_at(&a.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    assert_int_equal(noh_feet_rig_make(&source, &rig, &said), NOH_ERR_NOT_FOUND);
    skin_asset_close(&a);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_obstacle_is_the_ground),  cmocka_unit_test(legs_are_found_in_real_characters),
        cmocka_unit_test(a_pose_stands_on_what_the_game_says), cmocka_unit_test(each_foot_has_its_own_ground),
        cmocka_unit_test(a_turned_box_is_stood_on_its_side),   cmocka_unit_test(the_same_instant_is_the_same_pose),
        cmocka_unit_test(what_has_no_feet_is_refused),         cmocka_unit_test(what_is_no_shin_makes_no_leg),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
