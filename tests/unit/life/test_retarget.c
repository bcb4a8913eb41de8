/* test_retarget.c: poses of one figure on another: equal ones in any axes and bind poses, feet, hips, hands and knees of
 * others, and what is refused. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "convert/clips/rcl.h"
#include "convert/convert.h"
#include "convert/retarget/bones.h"
#include "convert/clips/raw_set.h"

#include "support/humanoid_fixture.h"

#define FRAMES 60u
#define BOTH (NOH_RETARGET_FEET | NOH_RETARGET_HANDS)

static const humanoid_form usual = { .unit = 1.0f };

/* A stroll over the ground with swinging arms, twisted hands and a turning body. */
static void move(const humanoid *h, uint32_t frame, noh_transform *pose)
{
    static const struct {
        uint32_t bone;
        float x, y, z, phase;
    } turns[] = { { NOH_BONE_UPPER_LEG, 0.5f, 0.05f, 0, 0 },
                  { NOH_BONE_LOWER_LEG, 0.4f, 0, 0, 1.6f },
                  { NOH_BONE_FOOT, 0.3f, 0.1f, 0, 0.5f },
                  { NOH_BONE_UPPER_ARM, 0.5f, 0.3f, 0.4f, 3.1f },
                  { NOH_BONE_LOWER_ARM, 0.4f, -0.6f, 0.1f, 2.0f },
                  { NOH_BONE_HAND, 0.7f, 0.2f, 0.2f, 1.0f },
                  { NOH_BONE_INDEX, 0, 0, 0.4f, 1.0f } };
    const float t = 0.2f * (float)frame;
    float hips[4], way[3] = { 0.05f * sinf(t), 0.02f * sinf(2.0f * t) + 0.3f, 0.03f * (float)frame };
    memcpy(pose, h->bind, h->skeleton.joint_count * sizeof *pose);
    for (uint32_t i = 0; i < TEST_COUNT(turns); i++) {
        for (uint32_t side = 0; side < 2; side++) {
            const uint32_t j = h->rig.bones[turns[i].bone + side * NOH_BONE_RIGHT];
            const float at = sinf(t + turns[i].phase + (side ? 3.14f : 0.0f));
            float q[4], wave = turns[i].bone == NOH_BONE_LOWER_LEG || turns[i].bone == NOH_BONE_LOWER_ARM
                                   ? 0.6f + 0.4f * at
                                   : at;
            humanoid_axis(turns[i].x, turns[i].y, turns[i].z, 0.9f * wave, q);
            noh_quat_mul(pose[j].rotation, q, pose[j].rotation);
        }
    }
    humanoid_axis(0.1f, 1.0f, 0.0f, 0.4f * sinf(0.5f * t), hips);
    noh_transform *root = &pose[h->rig.bones[NOH_BONE_HIPS]];
    noh_quat_mul(root->rotation, hips, root->rotation);
    for (int i = 0; i < 3; i++) root->translation[i] += way[i];
}

typedef struct pair {
    humanoid from, to;
    noh_retarget map;
    noh_retarget_joint joints[HUMANOID_JOINTS];
    noh_transform source[HUMANOID_JOINTS], target[HUMANOID_JOINTS];
} pair;

static void open_pair(pair *p, const humanoid_form *from, const humanoid_form *to, uint32_t flags)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    humanoid_make(&p->from, from);
    humanoid_make(&p->to, to);
    if (noh_retarget_init(&p->map, &p->from.rig, &p->to.rig, flags, p->joints, &error)) fail_msg("%s", error.what);
}

static void play(pair *p, uint32_t frame)
{
    move(&p->from, frame, p->source);
    noh_retarget_pose(&p->map, p->source, NULL, p->to.skeleton.joint_count, p->target);
}

static float apart(const float a[3], const float b[3])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* One person in another unit, other axes of joints, another bind pose of arms and hands, facing elsewhere: the same pose,
 * twist included, as fingers show. */
static void one_person_keeps_its_pose(void **state)
{
    static const humanoid_form forms[] = {
        { .unit = 1.0f },
        { .unit = 100.0f, .axes = 3 },
        { .unit = 1.0f, .arms_down = 0.7f, .axes = 7 },
        { .unit = 0.5f, .arms_down = 1.2f, .twist = 1.0f, .turned = 3.0f, .axes = 11 },
        { .unit = 1.0f, .twist = -0.8f, .turned = -1.2f },
    };
    (void)state;
    for (uint32_t i = 0; i < TEST_COUNT(forms); i++) {
        pair p;
        float turn[4], worst[2] = { 0.0f, 0.0f }; /* knees and elbows that are straight have no side */
        open_pair(&p, &usual, &forms[i], BOTH);
        assert_int_equal(p.map.bone_count, 29);
        humanoid_axis(0, 1, 0, forms[i].turned, turn);
        for (uint32_t f = 0; f < FRAMES; f++) {
            play(&p, f);
            for (uint32_t b = 0; b < NOH_BONES; b++) {
                float a[3], c[3];
                if (p.to.rig.bones[b] == NOH_JOINT_ROOT) continue;
                humanoid_place(&p.from, p.source, b, a);
                humanoid_place(&p.to, p.target, b, c);
                noh_quat_rotate(turn, a, a);
                for (int k = 0; k < 3; k++) c[k] /= forms[i].unit;
                const uint32_t of_side = b < NOH_BONE_SHOULDER + NOH_BONE_RIGHT ? b : b - NOH_BONE_RIGHT;
                float *off = &worst[of_side == NOH_BONE_LOWER_ARM || of_side == NOH_BONE_LOWER_LEG];
                *off = fmaxf(*off, apart(a, c));
            }
        }
        if (worst[0] > 1e-3f || worst[1] > 0.01f) {
            fail_msg("form %u: joints are off by %g m, knees and elbows by %g", i, (double)worst[0], (double)worst[1]);
        }
    }
}

/* Longer shins and feet, wide hips: limbs point as the source's without the solvers. */
static void limbs_point_as_the_source_does(void **state)
{
    static const humanoid_form other = {
        .unit = 1.0f, .shin = 1.3f, .foot = 1.4f, .width = 1.5f, .arms_down = 0.8f, .axes = 5, .is_plain = 1
    };
    static const uint32_t bones[4] = { NOH_BONE_UPPER_ARM, NOH_BONE_LOWER_ARM, NOH_BONE_UPPER_LEG, NOH_BONE_LOWER_LEG };
    pair p;
    (void)state;
    open_pair(&p, &usual, &other, 0);
    for (uint32_t f = 0; f < FRAMES; f++) {
        play(&p, f);
        for (uint32_t i = 0; i < 8; i++) {
            const uint32_t b = bones[i % 4u] + i / 4u * NOH_BONE_RIGHT;
            float a[2][3], c[2][3], dot = 0.0f;
            for (uint32_t k = 0; k < 2; k++) {
                humanoid_place(&p.from, p.source, b + k, a[k]);
                humanoid_place(&p.to, p.target, b + k, c[k]);
            }
            for (int k = 0; k < 3; k++) dot += (a[1][k] - a[0][k]) * (c[1][k] - c[0][k]);
            assert_true(dot > 0.99999f * apart(a[0], a[1]) * apart(c[0], c[1]));
        }
    }
}

/* The left leg of a figure in the model's axes, with a foot of its own pitch. */
static void bend_leg(const humanoid *h, const noh_ik_limb *leg, const float goal[3], const float pitch[4],
                     noh_transform *pose)
{
    float *thigh = pose[h->rig.bones[NOH_BONE_UPPER_LEG]].rotation,
          *shin = pose[h->rig.bones[NOH_BONE_LOWER_LEG]].rotation, *foot = pose[h->rig.bones[NOH_BONE_FOOT]].rotation;
    noh_ik_bend bend;
    noh_ik_two_bone(leg, goal, (const float[3]){ 0, 0, 1 }, 1.0f, &bend);
    memcpy(thigh, bend.start, sizeof bend.start);
    noh_quat_mul(bend.middle, bend.start, foot); /* of the shin, in the model's space */
    noh_quat_conjugate(thigh, shin);
    noh_quat_mul(shin, foot, shin);
    noh_quat_conjugate(foot, foot);
    noh_quat_mul(foot, pitch, foot);
}

/* Where a foot of the source stays, flat or on its toes, so does the target's; elsewhere it moves by the ratio of legs. */
static void feet_stay_where_the_source_stands(void **state)
{
    static const humanoid_form other = {
        .unit = 1.0f, .thigh = 0.8f, .shin = 1.1f, .foot = 1.5f, .width = 1.4f, .arms_down = 0.5f, .axes = 9
    };
    static const float at_rest[3] = { 0.1f, 0.02f, 0.15f };
    float first[3], rest[3];
    pair p;
    (void)state;
    open_pair(&p, &usual, &other, BOTH);
    for (uint32_t f = 0; f < 20; f++) { /* the heel goes up about the toes while the hips go ahead */
        noh_ik_limb leg = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 }, 0.0f, 0.0f, 0.0f };
        float pitch[4], goal[3], toes[3];
        memcpy(p.source, p.from.bind, sizeof p.source);
        p.source[p.from.rig.bones[NOH_BONE_HIPS]].translation[1] -= 0.08f;
        p.source[p.from.rig.bones[NOH_BONE_HIPS]].translation[2] += 0.01f * (float)f;
        humanoid_axis(1, 0, 0, 0.03f * (float)f, pitch);
        noh_quat_rotate(pitch, (const float[3]){ 0, 0.02f - 0.08f, 0.15f }, toes);
        for (int k = 0; k < 3; k++) goal[k] = at_rest[k] - toes[k];
        humanoid_place(&p.from, p.source, NOH_BONE_UPPER_LEG, leg.start);
        humanoid_place(&p.from, p.source, NOH_BONE_LOWER_LEG, leg.middle);
        humanoid_place(&p.from, p.source, NOH_BONE_FOOT, leg.end);
        bend_leg(&p.from, &leg, goal, pitch, p.source);
        humanoid_place(&p.from, p.source, NOH_BONE_TOES, goal);
        assert_true(apart(goal, at_rest) < 1e-4f);
        noh_retarget_pose(&p.map, p.source, NULL, p.to.skeleton.joint_count, p.target);
        humanoid_place(&p.to, p.target, NOH_BONE_TOES, toes);
        if (!f) memcpy(first, toes, sizeof first);
        if (apart(first, toes) > 2e-3f) fail_msg("frame %u: toes slid by %g m", f, (double)apart(first, toes));
    }
    humanoid_place(&p.to, p.to.bind, NOH_BONE_TOES, rest);
    assert_true(apart(first, rest) < 1e-3f); /* where they rest: as the source's do */
}

/* Hips that the source keeps low let legs of other proportions reach, or go down for them; knees bend ahead. */
static void hips_go_down_where_legs_do_not_reach(void **state)
{
    static const humanoid_form other = { .unit = 1.0f, .thigh = 1.2f, .shin = 0.8f, .width = 2.5f };
    float wide[2][3], stand[3], knee[3];
    pair p;
    (void)state;
    open_pair(&p, &usual, &other, BOTH);
    memcpy(p.source, p.from.bind, sizeof p.source);
    for (uint32_t side = 0; side < 2; side++) { /* legs apart, straight */
        noh_transform *leg = &p.source[p.from.rig.bones[NOH_BONE_UPPER_LEG + side * NOH_BONE_RIGHT]];
        humanoid_axis(0, 0, 1, side ? -0.6f : 0.6f, leg->rotation);
        humanoid_axis(0, 0, 1, side ? 0.6f : -0.6f,
                      p.source[p.from.rig.bones[NOH_BONE_FOOT + side * NOH_BONE_RIGHT]].rotation);
    }
    p.source[p.from.rig.bones[NOH_BONE_HIPS]].translation[1] -= 0.82f * (1.0f - cosf(0.6f));
    noh_retarget_pose(&p.map, p.source, NULL, p.to.skeleton.joint_count, p.target);
    for (uint32_t side = 0; side < 2; side++) {
        humanoid_place(&p.to, p.target, NOH_BONE_FOOT + side * NOH_BONE_RIGHT, wide[side]);
        assert_true(fabsf(wide[side][1] - 0.08f) < 4e-3f);
    }
    humanoid_place(&p.to, p.target, NOH_BONE_HIPS, stand);
    humanoid_place(&p.to, p.target, NOH_BONE_LOWER_LEG, knee);
    assert_true(knee[2] > 0.0f);
    p.map.flags = 0;
    noh_retarget_pose(&p.map, p.source, NULL, p.to.skeleton.joint_count, p.target);
    humanoid_place(&p.to, p.target, NOH_BONE_HIPS, knee);
    assert_true(stand[1] <= knee[1] + 1e-5f);
}

/* Short arms on broad shoulders: hands that meet do so. */
static void hands_meet_where_the_source_claps(void **state)
{
    static const humanoid_form other = { .unit = 1.0f, .arm = 1.2f, .width = 1.6f, .arms_down = 0.9f, .axes = 13 };
    pair p;
    (void)state;
    open_pair(&p, &usual, &other, BOTH);
    for (uint32_t f = 0; f < 10; f++) {
        float a[2][3], b[2][3], by;
        memcpy(p.source, p.from.bind, sizeof p.source);
        for (uint32_t side = 0; side < 2; side++) {
            noh_transform *arm = &p.source[p.from.rig.bones[NOH_BONE_UPPER_ARM + side * NOH_BONE_RIGHT]];
            humanoid_axis(0, 1, 0, (side ? 1.0f : -1.0f) * (1.2f + 0.06f * (float)f), arm->rotation);
        }
        noh_retarget_pose(&p.map, p.source, NULL, p.to.skeleton.joint_count, p.target);
        for (uint32_t side = 0; side < 2; side++) {
            humanoid_place(&p.from, p.source, NOH_BONE_HAND + side * NOH_BONE_RIGHT, a[side]);
            humanoid_place(&p.to, p.target, NOH_BONE_HAND + side * NOH_BONE_RIGHT, b[side]);
        }
        by = 0.5f * (p.map.limbs[2].ratio + p.map.limbs[3].ratio);
        if (apart(a[0], a[1]) < 0.35f * 0.53f) assert_true(fabsf(apart(b[0], b[1]) - by * apart(a[0], a[1])) < 0.01f);
    }
}

/* Joints between, and roots above the hips, of one of the two or both. */
static void roots_and_spines_may_differ(void **state)
{
    static const humanoid_form forms[] = { { .unit = 1.0f, .has_root = 1 },
                                           { .unit = 1.0f, .has_root = 1, .is_plain = 1, .axes = 2 } };
    (void)state;
    for (uint32_t i = 0; i < 4; i++) {
        pair p;
        float a[3], b[3];
        open_pair(&p, i & 1u ? &forms[i / 2u] : &usual, i & 1u ? &usual : &forms[i / 2u], BOTH);
        for (uint32_t f = 0; f < FRAMES; f++) {
            play(&p, f);
            humanoid_place(&p.from, p.source, NOH_BONE_HAND, a);
            humanoid_place(&p.to, p.target, NOH_BONE_HAND, b);
            assert_true(apart(a, b) < 0.03f);
        }
    }
}

static void a_lower_level_has_the_first_joints_alone(void **state)
{
    pair p;
    noh_transform few[HUMANOID_JOINTS];
    (void)state;
    open_pair(&p, &usual, &usual, BOTH);
    play(&p, 7);
    memset(few, 0xa5, sizeof few);
    noh_retarget_pose(&p.map, p.source, NULL, 5, few);
    assert_memory_equal(few, p.target, 3 * sizeof *few);
    assert_memory_not_equal(&few[5], &p.target[5], sizeof *few);
}

static void what_cannot_be_mapped_is_refused(void **state)
{
    humanoid a, b;
    noh_retarget map;
    noh_retarget_joint joints[HUMANOID_JOINTS];
    noh_error error = { NOH_OK, "", 0, 0 };
    (void)state;
    assert_int_equal(sizeof(noh_retarget_joint), 20);
    humanoid_make(&a, &usual);
    humanoid_make(&b, &usual);
    humanoid_axis(1, 0, 0, 1.5f, b.bind[0].rotation); /* lies */
    assert_int_equal(noh_retarget_init(&map, &a.rig, &b.rig, BOTH, joints, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, 1);
    assert_int_equal(noh_retarget_init(&map, &b.rig, &a.rig, BOTH, joints, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, 0);
    b.rig.reference = a.bind; /* which stands */
    assert_int_equal(noh_retarget_init(&map, &a.rig, &b.rig, BOTH, joints, &error), NOH_OK);
    b.rig.bones[NOH_BONE_HIPS] = NOH_JOINT_ROOT;
    assert_int_equal(noh_retarget_init(&map, &a.rig, &b.rig, BOTH, joints, &error), NOH_ERR_NOT_FOUND);
    for (uint32_t bone = NOH_BONE_HIPS + 1; bone < NOH_BONES; bone++) a.rig.bones[bone] = NOH_JOINT_ROOT;
    b.rig.bones[NOH_BONE_HIPS] = 0;
    assert_int_equal(noh_retarget_init(&map, &a.rig, &b.rig, BOTH, joints, &error), NOH_ERR_NOT_FOUND);
}

/* ---- packs ---- */

/* A pack of a recording's skeleton alone. */
static byte_buffer skeleton_pack(const char *name, noh_pack *pack, noh_ragdoll_source *from)
{
    char path[64];
    const char *input;
    convert_options options;
    convert_failure failure;
    byte_buffer bytes = { NULL, 0, 0, 0 };
    (void)snprintf(path, sizeof path, "clips/%s.rcl", name);
    input = test_asset(path);
    memset(&options, 0, sizeof options);
    options.only = CONVERT_MESH;
    if (convert_files(&input, 1, &options, &bytes, &failure)) fail_msg("%s", failure.error.what);
    assert_int_equal(noh_pack_open(bytes.bytes, bytes.count, pack, NULL), NOH_OK);
    memset(from, 0, sizeof *from);
    from->pack = pack;
    assert_int_equal(noh_pack_skeleton_at(pack, 0, &from->joints, NULL, NULL), NOH_OK);
    return bytes;
}

static void bones_of_packs_are_found_by_names(void **state)
{
    static const char *const names[2] = { "cmu_01_03", "Knight__Idle" };
    static const struct {
        uint32_t bone;
        const char *joints[2];
    } expected[] = { { NOH_BONE_HIPS, { "Hips", "hips" } },
                     { NOH_BONE_HEAD, { "Head", "head" } },
                     { NOH_BONE_UPPER_ARM, { "LeftArm", "upperarm.l" } },
                     { NOH_BONE_HAND + NOH_BONE_RIGHT, { "RightHand", "wrist.r" } },
                     { NOH_BONE_LOWER_LEG, { "LeftLeg", "lowerleg.l" } },
                     { NOH_BONE_TOES + NOH_BONE_RIGHT, { "RightToeBase", "toes.r" } } };
    noh_pack packs[2];
    noh_ragdoll_source sources[2];
    noh_retarget_rig rigs[2];
    noh_retarget map;
    noh_retarget_joint joints[64];
    noh_error error = { NOH_OK, "", 0, 0 };
    byte_buffer bytes[2];
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        bytes[i] = skeleton_pack(names[i], &packs[i], &sources[i]);
        if (noh_retarget_rig_make(&sources[i], &rigs[i], &error)) fail_msg("%s: %s", names[i], error.what);
        for (uint32_t k = 0; k < TEST_COUNT(expected); k++) {
            const uint32_t joint = rigs[i].bones[expected[k].bone];
            if (joint == NOH_JOINT_ROOT) fail_msg("%s: no bone %u", names[i], expected[k].bone);
            assert_string_equal(noh_pack_joint_name(&packs[i], 0, joint), expected[k].joints[i]);
        }
    }
    assert_true(sources[1].joints.joint_count <= 64);
    if (noh_retarget_init(&map, &rigs[0], &rigs[1], BOTH, joints, &error)) fail_msg("%s", error.what);
    assert_true(map.bone_count >= 17);
    for (uint32_t i = 0; i < 4; i++) assert_int_equal(map.limbs[i].exists, 1);
    for (uint32_t i = 0; i < 2; i++) buffer_free(&bytes[i]);
}

static const char *name_of(const raw_skeleton *raw, uint16_t joint)
{
    return joint == NOH_JOINT_ROOT ? "none" : raw->joints[joint].name;
}

/* Every kind of rig in the assets; the last two are no person. */
static void packs_and_recordings_have_the_same_bones(void **state)
{
    static const char *const names[] = { "Knight__Idle", "RobotExpressive__Wave", "ad_zombie",
                                         "cmu_01_03",    "cmu_indian_04",         "cmu_martial_03",
                                         "cmu_salsa_01", "Fox__Survey",           "CesiumMan" };
    (void)state;
    for (uint32_t i = 0; i < TEST_COUNT(names); i++) {
        char path[64];
        uint16_t bones[NOH_BONES];
        noh_pack pack;
        noh_ragdoll_source from;
        noh_retarget_rig rig;
        raw_set *set;
        model_error error;
        byte_buffer bytes = skeleton_pack(names[i], &pack, &from);
        const noh_result result = noh_retarget_rig_make(&from, &rig, NULL);
        (void)snprintf(path, sizeof path, "clips/%s.rcl", names[i]);
        if (rcl_read(test_asset(path), &set, &error)) fail_msg("%s: %s", names[i], error.what);
        bones_find(&set->skeleton, bones);
        assert_int_equal(result, i < 7 ? NOH_OK : NOH_ERR_NOT_FOUND);
        for (uint32_t b = 0; b < NOH_BONES; b++) {
            const uint16_t own = rig.bones[b];
            const char *found = own == NOH_JOINT_ROOT ? "none" : noh_pack_joint_name(&pack, 0, own);
            if (result == NOH_OK && strcmp(found, name_of(&set->skeleton, bones[b])) != 0)
                fail_msg("%s: bone %u is %s, not %s", names[i], b, found, name_of(&set->skeleton, bones[b]));
        }
        if (i == 1) {
            assert_string_equal(name_of(&set->skeleton, bones[NOH_BONE_HEAD]), "Head");
            assert_string_equal(name_of(&set->skeleton, bones[NOH_BONE_HIPS]), "Body");
        }
        raw_set_free(set);
        buffer_free(&bytes);
    }
}

static const struct CMUnitTest tests[] = { cmocka_unit_test(one_person_keeps_its_pose),
                                           cmocka_unit_test(limbs_point_as_the_source_does),
                                           cmocka_unit_test(feet_stay_where_the_source_stands),
                                           cmocka_unit_test(hips_go_down_where_legs_do_not_reach),
                                           cmocka_unit_test(hands_meet_where_the_source_claps),
                                           cmocka_unit_test(roots_and_spines_may_differ),
                                           cmocka_unit_test(a_lower_level_has_the_first_joints_alone),
                                           cmocka_unit_test(what_cannot_be_mapped_is_refused),
                                           cmocka_unit_test(bones_of_packs_are_found_by_names),
                                           cmocka_unit_test(packs_and_recordings_have_the_same_bones) };

TEST_MAIN(tests, NULL, NULL)
