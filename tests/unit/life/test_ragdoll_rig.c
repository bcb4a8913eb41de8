/* Tests of ragdoll_rig.c and ragdoll_names.c: real characters, and skeletons that are not characters. */
#include "life/physics/ragdoll_rig_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"
#include "support/skin_asset.h"

static noh_ragdoll_source source_of(const noh_pack *pack)
{
    noh_ragdoll_source s = { .pack = pack };
    const noh_skeleton_header *header;
    assert_int_equal(noh_pack_skeleton_at(pack, 0, &s.joints, &header, NULL), NOH_OK);
    s.metres = header->unit_cm / 100.0f;
    return s;
}

static noh_ragdoll_rig rig_of(const noh_ragdoll_source *s)
{
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_rig rig;
    uint32_t count;
    assert_int_equal(noh_ragdoll_find_rows(s, rows, &count, NULL), NOH_OK);
    assert_int_equal(noh_ragdoll_rig_make(s, rows, count, &rig, NULL), NOH_OK);
    return rig;
}

static const char *const assets[] = { "hero/body.glb" };

/* Sixteen bodies, each attached to its parent, at rest in the bind pose: all angles 0, all anchors together. */
static void zero_is_the_bind_pose(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(assets); i++) {
        skin_asset a;
        skin_asset_open(&a, assets[i], NULL);
        const noh_ragdoll_source s = source_of(&a.pack);
        const noh_ragdoll_rig rig = rig_of(&s);
        const noh_ragdolls_desc desc = { &rig, 1, 10, 0 };
        noh_ragdoll_measures m;
        noh_ragdolls *set;
        void *memory = malloc(noh_ragdolls_size(&desc));
        assert_int_equal(rig.body_count, 16);
        assert_true(rig.pair_count > 4);
        assert_int_equal(noh_ragdolls_init(memory, noh_ragdolls_size(&desc), &desc, &set, NULL), NOH_OK);
        noh_ragdoll_measure(set, 0, NULL, &m);
        assert_true(m.limit < 1e-4f && m.separation < 1e-5f);
        for (uint32_t k = 0; k < rig.body_count; k++) { /* bodies begin at their joints */
            float position[3], rotation[4];
            noh_ragdoll_bind(&s.joints, rig.bodies[k].joint, position, rotation);
            for (int n = 0; n < 3 && k; n++) {
                assert_true(fabsf(rig.joints[k].anchor[n] - position[n] * s.metres) < 1e-5f);
            }
        }
        free(memory);
        skin_asset_close(&a);
    }
}

/* The source's head is a box of 0.3 by 0.2 by 0.2 m for every character. Here a doll of a tenth of the size has
 * capsules of a tenth and a thousandth of the mass. */
static void sizes_follow_the_skin(void **state)
{
    skin_asset a;
    (void)state;
    skin_asset_open(&a, assets[0], NULL);
    noh_ragdoll_source s = source_of(&a.pack);
    const noh_ragdoll_rig large = rig_of(&s);
    float mass = 0.0f;
    s.metres *= 0.1f;
    const noh_ragdoll_rig small = rig_of(&s);
    for (uint32_t i = 0; i < large.body_count; i++) {
        const noh_ragdoll_body *b = &large.bodies[i], *c = &small.bodies[i];
        assert_true(fabsf(c->radius / b->radius - 0.1f) < 0.002f && fabsf(c->half / b->half - 0.1f) < 0.002f);
        assert_true(fabsf(c->mass / b->mass - 0.001f) < 0.0001f);
        assert_true(b->radius > 0.015f && b->radius < 0.25f);
        mass += b->mass;
    }
    assert_true(mass > 30.0f && mass < 90.0f);
    skin_asset_close(&a);
}

/* A skeleton in centimetres below a root with a scale of 0.01, as exporters write it, is the same figure. */
static void scales_of_joints_count(void **state)
{
    skin_asset a;
    noh_skin skin;
    (void)state;
    skin_asset_open(&a, assets[0], NULL);
    noh_ragdoll_source s = source_of(&a.pack);
    const noh_ragdoll_rig rig = rig_of(&s);
    noh_transform *bind = test_zeros(s.joints.joint_count * sizeof *bind);
    memcpy(bind, s.joints.bind_pose, s.joints.joint_count * sizeof *bind);
    for (uint32_t j = 1; j < s.joints.joint_count; j++) {
        for (int i = 0; i < 3; i++) bind[j].translation[i] *= 100.0f;
    }
    for (int i = 0; i < 3; i++) bind[0].scale[i] *= 0.01f;
    for (uint32_t k = 0; noh_pack_skin_at(&a.pack, k, &skin, NULL) == NOH_OK; k++) {
        float *rows = (float *)(uintptr_t)skin.inverse_bind; /* the test's own memory */
        for (uint32_t i = 0; i < 12u * skin.header->joint_count; i++) rows[i] *= 100.0f;
    }
    s.joints.bind_pose = bind;
    const noh_ragdoll_rig scaled = rig_of(&s);
    assert_int_equal(scaled.body_count, rig.body_count);
    for (uint32_t i = 0; i < rig.body_count; i++) {
        const noh_ragdoll_body *b = &rig.bodies[i], *c = &scaled.bodies[i];
        assert_true(fabsf(c->radius - b->radius) < 1e-4f && fabsf(c->half - b->half) < 1e-4f);
        assert_true(fabsf(c->mass - b->mass) < 1e-2f * b->mass);
        for (int n = 0; n < 3; n++) assert_true(fabsf(c->position[n] - b->position[n]) < 1e-4f);
    }
    free(bind);
    skin_asset_close(&a);
}

/* Left and right are each other's mirror, except for the skin's asymmetry. */
static void sides_are_alike(void **state)
{
    skin_asset a;
    (void)state;
    skin_asset_open(&a, assets[0], NULL);
    const noh_ragdoll_source s = source_of(&a.pack);
    const noh_ragdoll_rig rig = rig_of(&s);
    uint32_t mirrored = 0;
    for (uint32_t i = 0; i < rig.body_count; i++) {
        for (uint32_t k = 0; k < i; k++) {
            const noh_ragdoll_body *b = &rig.bodies[i], *c = &rig.bodies[k];
            if (fabsf(b->position[0] + c->position[0]) > 0.02f || fabsf(b->position[1] - c->position[1]) > 0.02f ||
                fabsf(b->position[0]) < 0.03f) {
                continue;
            }
            assert_true(fabsf(b->radius - c->radius) < 0.2f * b->radius);
            assert_true(fabsf(rig.joints[i].twist_max - rig.joints[k].twist_max) < 0.1f);
            mirrored++;
        }
    }
    assert_int_equal(mirrored, 6);
    skin_asset_close(&a);
}

static void rows_out_of_order_are_refused(void **state)
{
    skin_asset a;
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_rig rig;
    noh_error error;
    uint32_t count;
    (void)state;
    skin_asset_open(&a, assets[0], NULL);
    const noh_ragdoll_source s = source_of(&a.pack);
    assert_int_equal(noh_ragdoll_find_rows(&s, rows, &count, NULL), NOH_OK);
    assert_int_equal(noh_ragdoll_rig_make(&s, rows, 0, &rig, NULL), NOH_ERR_LIMIT);
    assert_int_equal(noh_ragdoll_rig_make(&s, rows + 1, count - 1, &rig, NULL), NOH_ERR_ARG);
    rows[4].bend_max = NAN;
    assert_int_equal(noh_ragdoll_rig_make(&s, rows, count, &rig, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 4);
    skin_asset_close(&a);
}

/* Give a joint another name: its offset into the skeleton's names now points to a string behind the pack's own. */
static void rename_joint(skin_asset *a, const char *from, const char *to)
{
    const noh_skeleton_header *h;
    noh_skeleton joints;
    assert_int_equal(noh_pack_skeleton_at(&a->pack, 0, &joints, &h, NULL), NOH_OK);
    for (uint32_t i = 0; i < joints.joint_count; i++) {
        uint32_t *name = (uint32_t *)(void *)(a->bytes + ((const uint8_t *)h - a->bytes) + h->names_offset) + i;
        if (strcmp(noh_pack_joint_name(&a->pack, 0, i), from) != 0) continue;
        char *strings = realloc((char *)(uintptr_t)a->pack.strings, a->pack.string_bytes + strlen(to) + 1u);
        assert_non_null(strings);
        *name = a->pack.string_bytes;
        (void)strcpy(strings + *name, to);
        a->pack.strings = strings;
        a->pack.string_bytes += (uint32_t)strlen(to) + 1u;
        return;
    }
    fail_msg("no joint has the name %s", from);
}

/* Names of other tools: the joints are the same, so the rows are. The pelvis of the first is named as a hip too, its
 * collar bones as shoulders, and both have the limbs below them. The second is MikuMikuDance's, the fourth the same
 * from Blender. The third calls a forearm an arm. */
static void other_names_find_the_same_limbs(void **state)
{
    static const char *const sides[5][2] = {
        { "Left", "Right" }, { "L_", "R_" }, { "左", "右" }, { "Left", "Right" }, { ".L", ".R" }
    };
    static const char *const names[][4] = {
        { "UpLeg", "Hip", "足", "UpperLeg" },  { "Leg", "Knee", "ひざ", "Leg" },
        { "Foot", "Ankle", "足首", "Foot" },   { "Arm", "Shoulder", "腕", "UpperArm" },
        { "ForeArm", "Elbow", "ひじ", "Arm" }, { "Hand", "Wrist", "手首", "Hand" }
    };
    noh_ragdoll_row before[NOH_RAGDOLL_BODIES_MAX], after[NOH_RAGDOLL_BODIES_MAX];
    uint32_t counts[2];
    (void)state;
    for (int tool = 1; tool < 5; tool++) {
        skin_asset a;
        noh_gaze_rig gaze[2];
        noh_retarget_rig bones[2];
        skin_asset_open(&a, assets[0], NULL);
        const noh_ragdoll_source s = source_of(&a.pack);
        assert_int_equal(noh_ragdoll_find_rows(&s, before, &counts[0], NULL), NOH_OK);
        assert_int_equal(noh_gaze_rig_make(&a.pack, 0, &gaze[0], NULL), NOH_OK);
        assert_int_equal(noh_retarget_rig_make(&s, &bones[0], NULL), NOH_OK);
        char *strings = malloc(a.pack.string_bytes);
        assert_non_null(strings);
        a.pack.strings = memcpy(strings, a.pack.strings, a.pack.string_bytes);
        for (size_t i = 0; i < 2u * TEST_COUNT(names); i++) {
            const char *side = sides[tool][i % 2u], *name = names[i / 2u][tool == 4 ? 2 : tool];
            char from[32], to[32];
            (void)snprintf(from, sizeof from, "%s%s", sides[0][i % 2u], names[i / 2u][0]);
            (void)snprintf(to, sizeof to, "%s%s", tool == 4 ? name : side, tool == 4 ? side : name);
            rename_joint(&a, from, to);
        }
        if (tool == 2 || tool == 4) {
            rename_joint(&a, "Head", "頭");
            rename_joint(&a, "Neck", "首");
        }
        assert_int_equal(noh_ragdoll_find_rows(&s, after, &counts[1], NULL), NOH_OK);
        assert_int_equal(counts[0], 16);
        assert_int_equal(counts[1], 16);
        assert_memory_equal(before, after, sizeof before);
        assert_int_equal(noh_gaze_rig_make(&a.pack, 0, &gaze[1], NULL), NOH_OK);
        assert_int_equal(gaze[0].joint_count, gaze[1].joint_count);
        assert_memory_equal(gaze[0].joints, gaze[1].joints, gaze[0].joint_count * sizeof *gaze[0].joints);
        assert_int_equal(noh_retarget_rig_make(&s, &bones[1], NULL), NOH_OK);
        for (uint32_t i = 0; i < 12; i++) {
            const uint32_t limb = i & 1u ? NOH_BONE_UPPER_ARM : NOH_BONE_UPPER_LEG;
            const uint32_t bone = limb + i / 4u + (i & 2u ? NOH_BONE_RIGHT : 0u);
            assert_int_equal(bones[0].bones[bone], bones[1].bones[bone]);
        }
        free((char *)(uintptr_t)a.pack.strings);
        skin_asset_close(&a);
    }
}

/* Each arm of a chain has a hand. The time must not double with each arm: each turn took 20 s, all of them longer
 * than a test may run. */
static void chains_of_arms_are_refused_at_once(void **state)
{
    skin_asset a;
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
    (void)state;
    skin_asset_open(&a, "khronos/RobotExpressive.glb", NULL);
    noh_ragdoll_source s = source_of(&a.pack);
    const uint32_t arms = s.joints.joint_count / 2u;
    uint16_t *parents = test_zeros(s.joints.joint_count * sizeof *parents);
    char *strings = malloc(a.pack.string_bytes);
    assert_non_null(strings);
    a.pack.strings = memcpy(strings, a.pack.strings, a.pack.string_bytes);
    for (uint32_t j = 0; j < s.joints.joint_count; j++) {
        parents[j] = j == 0 ? NOH_JOINT_ROOT : (uint16_t)(j < arms ? j - 1u : (j - arms) % arms);
        rename_joint(&a, noh_pack_joint_name(&a.pack, 0, j), j < arms ? "Arm" : "Hand");
    }
    s.joints.parents = parents;
    for (uint32_t i = 0; i < 100; i++) {
        assert_int_equal(noh_ragdoll_find_rows(&s, rows, &count, NULL), NOH_ERR_NOT_FOUND);
    }
    free(parents);
    free((char *)(uintptr_t)a.pack.strings);
    skin_asset_close(&a);
}

/* Legs may hang from a joint next to the spine, below what carries both. */
static void a_pelvis_is_above_legs_and_spine(void **state)
{
    noh_ragdoll_row before[NOH_RAGDOLL_BODIES_MAX], after[NOH_RAGDOLL_BODIES_MAX];
    uint32_t counts[2], hips = NOH_NONE;
    skin_asset a;
    (void)state;
    skin_asset_open(&a, assets[0], NULL);
    noh_ragdoll_source s = source_of(&a.pack);
    uint16_t *parents = test_zeros(s.joints.joint_count * sizeof *parents);
    memcpy(parents, s.joints.parents, s.joints.joint_count * sizeof *parents);
    assert_int_equal(noh_ragdoll_find_rows(&s, before, &counts[0], NULL), NOH_OK);
    for (uint32_t j = 0; j < s.joints.joint_count; j++) {
        const char *name = noh_pack_joint_name(&a.pack, 0, j);
        if (strcmp(name, "LHipJoint") == 0) hips = j;
        if (strcmp(name, "RightUpLeg") == 0) {
            assert_int_not_equal(hips, NOH_NONE);
            parents[j] = (uint16_t)hips;
        }
    }
    s.joints.parents = parents;
    assert_int_equal(noh_ragdoll_find_rows(&s, after, &counts[1], NULL), NOH_OK);
    assert_int_equal(counts[1], counts[0]);
    assert_memory_equal(before, after, sizeof before);
    free(parents);
    skin_asset_close(&a);
}

/* ---- falls ---- */

static uint32_t seed = 1;

static float random_float(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)((double)(seed >> 8) / 8388608.0 - 1.0);
}

/* As large as a figure of 1.75 m times this. */
static float scale_of(const noh_ragdoll_rig *rig)
{
    float low = 1e30f, high = -1e30f;
    for (uint32_t i = 0; i < rig->body_count; i++) {
        const noh_ragdoll_body *b = &rig->bodies[i];
        low = fminf(low, b->position[1] - b->half - b->radius);
        high = fmaxf(high, b->position[1] + b->half + b->radius);
    }
    return (high - low) / 1.75f;
}

/* Turned at random, thrown sideways, clear of the ground. */
static void throw_all(const noh_ragdoll_rig *rig, float scale, noh_ragdolls *set, uint32_t count)
{
    for (uint32_t d = 0; d < count; d++) {
        noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
        noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
        float turn[4];
        for (int k = 0; k < 4; k++) turn[k] = random_float() + (k == 3 ? 0.1f : 0.0f);
        noh_quat_normalize(turn);
        const float speed[2] = { 3.0f * random_float(), 3.0f * random_float() };
        memset(motions, 0, sizeof motions);
        for (uint32_t i = 0; i < rig->body_count; i++) {
            float from[3];
            for (int k = 0; k < 3; k++) from[k] = rig->bodies[i].position[k] - rig->bodies[0].position[k];
            noh_quat_rotate(turn, from, poses[i].position);
            poses[i].position[1] += 1.5f * scale;
            noh_quat_mul(turn, rig->bodies[i].rotation, poses[i].rotation);
            motions[i].velocity[0] = speed[0];
            motions[i].velocity[2] = speed[1];
        }
        assert_int_equal(noh_ragdoll_place(set, d, poses, motions, NULL), NOH_OK);
    }
}

typedef struct fall {
    noh_ragdoll_measures worst;
    double separation; /* of the worst joint, the mean of dolls and steps, metres */
    float asleep;      /* the last one, seconds */
} fall;

#define DOLLS 16u

static fall let_fall(const noh_ragdoll_rig *rig, float scale, int steps)
{
    const noh_plane floor = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    const noh_world world = { .planes = &floor, .plane_count = 1, .friction = 0.6f };
    const noh_ragdolls_desc desc = { rig, DOLLS, 10, 0 };
    fall f = { .asleep = 0.0f };
    noh_ragdolls *set;
    void *memory = malloc(noh_ragdolls_size(&desc));
    assert_int_equal(noh_ragdolls_init(memory, noh_ragdolls_size(&desc), &desc, &set, NULL), NOH_OK);
    throw_all(rig, scale, set, DOLLS);
    for (int step = 1; step <= steps; step++) {
        noh_ragdolls_step(set, &world, NOH_RAGDOLL_STEP_TICKS);
        for (uint32_t d = 0; d < DOLLS; d++) {
            noh_ragdoll_measures m;
            noh_ragdoll_measure(set, d, &world, &m);
            assert_true(m.limit - m.limit == 0.0f && m.separation - m.separation == 0.0f);
            f.worst.limit = fmaxf(f.worst.limit, m.limit);
            f.worst.penetration = fmaxf(f.worst.penetration, m.penetration);
            f.separation += (double)m.separation / ((double)steps * DOLLS);
            if (!noh_ragdoll_sleeps(set, d)) f.asleep = (float)step / 60.0f;
        }
    }
    free(memory);
    return f;
}

/* For every character lengths grow with the size, times with its root. The robot's legs end in bodies that have hardly
 * any skin, and its trunk is wide where it has none: such bodies flew apart by metres, and spun past limits by 25
 * degrees. */
static void everybody_falls_and_lies(void **state)
{
    static const char *const all[] = { "hero/body.glb", "hero/body_8inf.glb", "hero/body_quantized.glb",
                                       "khronos/RobotExpressive.glb" };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(all); i++) {
        skin_asset a;
        skin_asset_open(&a, all[i], NULL);
        const noh_ragdoll_source s = source_of(&a.pack);
        const noh_ragdoll_rig rig = rig_of(&s);
        const float scale = scale_of(&rig), most = 4.0f * sqrtf(scale);
        seed = 1;
        for (int n = 0; n < (test_is_sanitized() ? 1 : 3); n++) {
            const fall f = let_fall(&rig, scale, (int)(60.0f * most) + 60);
            print_message("%s of %.2f m: limits %.1f degrees, floor %.1f mm, joints %.2f mm, asleep after %.2f s\n",
                          all[i], (double)scale * 1.75, (double)f.worst.limit * 57.29577951,
                          (double)f.worst.penetration * 1e3, f.separation * 1e3, (double)f.asleep);
            assert_true(f.worst.limit * 57.29578f < 12.0f);
            assert_true(f.worst.penetration < 5e-3f * fmaxf(scale, 1.0f));
            assert_true(f.separation < 0.3e-3 * (double)fmaxf(scale, 1.0f));
            assert_true(f.asleep < most);
        }
        skin_asset_close(&a);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(everybody_falls_and_lies),
    cmocka_unit_test(zero_is_the_bind_pose),
    cmocka_unit_test(sizes_follow_the_skin),
    cmocka_unit_test(scales_of_joints_count),
    cmocka_unit_test(sides_are_alike),
    cmocka_unit_test(rows_out_of_order_are_refused),
    cmocka_unit_test(other_names_find_the_same_limbs),
    cmocka_unit_test(chains_of_arms_are_refused_at_once),
    cmocka_unit_test(a_pelvis_is_above_legs_and_spine),
};

TEST_MAIN(tests, NULL, NULL)
