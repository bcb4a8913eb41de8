/* test_joint_order.c: joints in an order in which LOD levels are prefixes: reordering moves nothing, files of one
 * skeleton agree on the order, and levels are cut where they should be. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "convert/clips/model_clips.h"
#include "convert/clips/joint_order.h"
#include "convert/model/model_build.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"
#include "support/clip_bank_fixture.h"

/* ---- skeletons made in code ---- */

static void name_joint(raw_skeleton *s, uint32_t j, const char *name)
{
    free(s->joints[j].name);
    s->joints[j].name = model_string(name);
}

static void random_vector(test_random *r, float size, float *out)
{
    for (int i = 0; i < 3; i++) out[i] = test_random_float(r, -size, size);
}

static void random_rotation(test_random *r, float *q)
{
    float square = 0.0f;
    for (int i = 0; i < 4; i++) {
        q[i] = test_random_float(r, -1.0f, 1.0f);
        square += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++) q[i] /= sqrtf(square);
}

/* Several roots, a clip of three frames, everything at random; some bones of no length, some alike. */
static raw_set *random_set(test_random *r, uint32_t joints)
{
    raw_set *set = raw_set_new(joints, 1);
    raw_clip *clip = &set->clips[0];
    assert_non_null(set);
    assert_int_equal(raw_clip_alloc(clip, 3, joints), 0);
    for (uint32_t j = 0; j < joints; j++) {
        raw_joint *joint = &set->skeleton.joints[j];
        char name[16];
        snprintf(name, sizeof name, "j%u", j);
        name_joint(&set->skeleton, j, name);
        joint->parent = j && test_random_below(r, 8) ? test_random_below(r, j) : MODEL_NONE;
        random_rotation(r, joint->rotation);
        random_vector(r, test_random_below(r, 4) ? 10.0f : 0.0f, joint->translation);
        if (test_random_below(r, 3) == 0) joint->translation[0] = joint->translation[1] = joint->translation[2] = 2.0f;
    }
    for (uint32_t i = 0; i < 3 * joints; i++) {
        random_rotation(r, clip->rotations + 4 * i);
        random_vector(r, 10.0f, clip->translations + 3 * i);
        for (int k = 0; k < 3; k++) clip->scales[3 * i + (uint32_t)k] = test_random_float(r, 0.5f, 2.0f);
    }
    return set;
}

static uint32_t joint_called(const raw_skeleton *s, const char *name)
{
    for (uint32_t j = 0; j < s->joint_count; j++) {
        if (strcmp(s->joints[j].name, name) == 0) return j;
    }
    fail_msg("no joint '%s'", name);
    return 0;
}

/* Poses of all frames and of the bind pose: [4][joints][12]. */
static double *poses_of(const raw_set *set)
{
    const uint32_t n = set->skeleton.joint_count;
    double *out = test_zeros(sizeof *out * 4u * 12u * n);
    raw_pose_object(&set->skeleton, NULL, 0, out);
    for (uint32_t f = 0; f < 3; f++) {
        raw_pose_object(&set->skeleton, &set->clips[0], f, out + (size_t)(f + 1u) * 12u * n);
    }
    return out;
}

/* ---- order ---- */

/* A model of one skin that names every joint of set 1, and another, of set 3, that must be left alone. */
static model *model_of_skins(uint32_t joints)
{
    model *m = model_new();
    m->skins = test_zeros(2 * sizeof *m->skins);
    m->skin_count = 2;
    for (uint32_t s = 0; s < 2; s++) {
        m->skins[s].joint_count = joints;
        m->skins[s].set = s ? 1 : 3;
        m->skins[s].skeleton_joints = test_zeros(joints * sizeof(uint32_t));
        for (uint32_t j = 0; j < joints; j++) m->skins[s].skeleton_joints[j] = j;
    }
    return m;
}

static void check_order(const raw_skeleton *s)
{
    int roots = 1;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        const uint32_t parent = s->joints[j].parent;
        assert_true(parent == MODEL_NONE || parent < j);
        assert_true(roots || parent != MODEL_NONE); /* all roots come first */
        roots = roots && parent == MODEL_NONE;
    }
}

static void nothing_moves_but_places(void **state)
{
    test_random r = test_random_from(71);
    uint32_t moved = 0;
    (void)state;
    for (int round = 0; round < 200; round++) {
        const uint32_t n = 1u + test_random_below(&r, 60);
        raw_set *sets[2] = { raw_set_new(0, 0), random_set(&r, n) };
        model *m = model_of_skins(n);
        double *before = poses_of(sets[1]), *after;
        assert_int_equal(joint_order_sets(sets, 2, m), 0);
        after = poses_of(sets[1]);
        check_order(&sets[1]->skeleton);
        for (uint32_t j = 0; j < n; j++) {
            char name[16];
            uint32_t place;
            snprintf(name, sizeof name, "j%u", j);
            place = joint_called(&sets[1]->skeleton, name);
            moved += place != j;
            assert_int_equal(m->skins[1].skeleton_joints[j], place);
            assert_int_equal(m->skins[0].skeleton_joints[j], j);
            for (uint32_t f = 0; f < 4; f++) {
                assert_memory_equal(before + ((size_t)f * n + j) * 12u, after + ((size_t)f * n + place) * 12u,
                                    12 * sizeof(double));
            }
        }
        free(before);
        free(after);
        model_free(m);
        raw_set_free(sets[0]);
        raw_set_free(sets[1]);
    }
    assert_true(moved > 1000);
}

static void ordering_twice_changes_nothing(void **state)
{
    test_random r = test_random_from(72);
    (void)state;
    for (int round = 0; round < 50; round++) {
        raw_set *set = random_set(&r, 1u + test_random_below(&r, 60));
        model *m = model_new();
        uint32_t hash;
        assert_int_equal(joint_order_sets(&set, 1, m), 0);
        hash = raw_skeleton_hash(&set->skeleton);
        assert_int_equal(joint_order_sets(&set, 1, m), 0);
        assert_int_equal(raw_skeleton_hash(&set->skeleton), hash);
        model_free(m);
        raw_set_free(set);
    }
}

/* ---- levels ---- */

typedef struct bone {
    const char *name;
    int parent;
    float length;
} bone;

static raw_set *set_of(const bone *bones, uint32_t count)
{
    raw_set *set = raw_set_new(count, 0);
    for (uint32_t j = 0; j < count; j++) {
        name_joint(&set->skeleton, j, bones[j].name);
        set->skeleton.joints[j].parent = bones[j].parent < 0 ? MODEL_NONE : (uint32_t)bones[j].parent;
        set->skeleton.joints[j].translation[1] = bones[j].length;
    }
    return set;
}

#define HAND(n)                                                                                                     \
    { "hand", n - 1, 25.0f }, { "f1", n, 9.0f }, { "g1", n + 1, 4.0f }, { "f2", n, 9.001f }, { "g2", n + 3, 4.0f }, \
        { "f3", n, 8.999f }, { "g3", n + 5, 4.0f }, { "f4", n, 9.0f }, { "g4", n + 7, 4.0f }, { "f5", n, 9.0f },    \
    {                                                                                                               \
        "g5", n + 9, 4.0f                                                                                           \
    }

/* Hips, three of the spine, two arms with hands of five fingers, neck, head, eyes; two legs. */
/* clang-format off */
static const bone body[] = {
    { "hips", -1, 100.0f }, { "spine", 0, 15.0f }, { "spine1", 1, 15.0f }, { "spine2", 2, 15.0f },
    { "clavicle", 3, 12.0f }, { "arm", 4, 15.0f }, { "forearm", 5, 28.0f }, HAND(7),
    { "clavicle", 3, 12.0f }, { "arm", 18, 15.0f }, { "forearm", 19, 28.0f }, HAND(21),
    { "neck", 3, 12.0f }, { "head", 32, 12.0f }, { "eye", 33, 9.5f }, { "eye", 33, 9.5f },
    { "thigh", 0, 10.0f }, { "shin", 36, 42.0f }, { "foot", 37, 42.0f }, { "toe", 38, 15.0f },
    { "thigh", 0, 10.0f }, { "shin", 40, 42.0f }, { "foot", 41, 42.0f }, { "toe", 42, 15.0f }
};
/* clang-format on */

/* The joints of a kind, at the start and at the end of a prefix of `count`: how many are in it. */
static uint32_t kept(const raw_skeleton *s, const char *name, uint32_t count)
{
    uint32_t found = 0;
    for (uint32_t j = 0; j < count; j++) found += strcmp(s->joints[j].name, name) == 0;
    return found;
}

static void levels_drop_fingers_before_limbs(void **state)
{
    raw_set *set = set_of(body, TEST_COUNT(body));
    model *m = model_new();
    uint32_t counts[NOH_LOD_LEVELS_MAX], level_count;
    static const char *const limbs[] = { "spine2", "clavicle", "arm", "forearm", "thigh", "shin", "head" };
    (void)state;
    assert_int_equal(joint_order_sets(&set, 1, m), 0);
    level_count = joint_levels(&set->skeleton, counts);
    assert_true(level_count >= 4 && level_count <= 5);
    assert_int_equal(counts[0], TEST_COUNT(body));
    for (uint32_t i = 1; i < level_count; i++) {
        static const double shares[] = { 1.0, 0.6, 0.35, 0.2, 0.1 };
        assert_true(counts[i] < counts[i - 1]);
        print_message("%u of %u joints\n", counts[i], counts[0]);
        if (level_count == 5)
            assert_true(fabs(counts[i] - shares[i] * counts[0]) <= fmax(0.3 * shares[i] * counts[0], 1.0));
        /* all fingertips or none, though their bones differ by a hundredth of a millimetre */
        assert_true(kept(&set->skeleton, "g1", counts[i]) == kept(&set->skeleton, "g5", counts[i]));
        assert_true(kept(&set->skeleton, "g2", counts[i]) == kept(&set->skeleton, "g3", counts[i]));
        assert_true(kept(&set->skeleton, "f1", counts[i]) == kept(&set->skeleton, "f2", counts[i]));
        assert_true(kept(&set->skeleton, "f3", counts[i]) == kept(&set->skeleton, "f4", counts[i]));
        assert_true(kept(&set->skeleton, "arm", counts[i]) != 1 && kept(&set->skeleton, "shin", counts[i]) != 1);
    }
    for (uint32_t i = 0; i < TEST_COUNT(limbs); i++) {
        const uint32_t all = kept(&set->skeleton, limbs[i], counts[0]);
        assert_int_equal(kept(&set->skeleton, limbs[i], counts[1]), all);
    }
    assert_int_equal(kept(&set->skeleton, "g1", counts[1]), 0);
    model_free(m);
    raw_set_free(set);
}

/* Whatever the skeleton, also one that was not put into order: prefixes with all roots, and no more than the limit. */
static void levels_are_sound_for_any_skeleton(void **state)
{
    test_random r = test_random_from(73);
    uint32_t several = 0;
    (void)state;
    for (int round = 0; round < 400; round++) {
        raw_set *set = random_set(&r, 1u + test_random_below(&r, 100));
        model *m = model_new();
        uint32_t counts[NOH_LOD_LEVELS_MAX], level_count;
        if (round % 2) assert_int_equal(joint_order_sets(&set, 1, m), 0);
        level_count = joint_levels(&set->skeleton, counts);
        assert_true(level_count >= 1 && level_count <= 5);
        assert_int_equal(counts[0], set->skeleton.joint_count);
        for (uint32_t i = 1; i < level_count; i++) assert_true(counts[i] && counts[i] < counts[i - 1]);
        for (uint32_t j = counts[level_count - 1]; j < set->skeleton.joint_count; j++) {
            assert_true(set->skeleton.joints[j].parent != MODEL_NONE);
        }
        several += level_count > 2;
        model_free(m);
        raw_set_free(set);
    }
    assert_true(several > 50);
}

/* ---- files ---- */

static const char *puppet_path(void)
{
    static char path[4096];
    const char *build = getenv("NOH_BUILD");
    snprintf(path, sizeof path, "%s/demo/puppet.glb", build ? build : "build");
    return path;
}

static void put_bvh_joint(FILE *f, const raw_skeleton *s, uint32_t joint, int depth)
{
    const raw_joint *at = &s->joints[joint];
    const double longer = 1.0 + ((double)(joint % 5u) - 2.0) * 1e-5;
    int children = 0;
    fprintf(f, "%s %s\n{\nOFFSET %.4f %.4f %.4f\nCHANNELS 3 Zrotation Xrotation Yrotation\n", depth ? "JOINT" : "ROOT",
            at->name, longer * 100.0 * (double)at->translation[0], longer * 100.0 * (double)at->translation[1],
            longer * 100.0 * (double)at->translation[2]);
    for (uint32_t j = joint + 1u; j < s->joint_count; j++) {
        if (s->joints[j].parent == joint) {
            put_bvh_joint(f, s, j, depth + 1);
            children++;
        }
    }
    if (!children) fprintf(f, "End Site\n{\nOFFSET 0 1 0\n}\n");
    fprintf(f, "}\n");
}

/* The same skeleton in centimetres, its bones off by up to 2e-5, its joints in depth-first order, its ends known. */
static const char *write_bvh(const raw_skeleton *s)
{
    const char *path = test_path("puppet.bvh");
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "HIERARCHY\n");
    put_bvh_joint(f, s, 0, 0);
    fprintf(f, "MOTION\nFrames: 2\nFrame Time: 0.0333333\n");
    for (uint32_t i = 0; i < 2u * 3u * s->joint_count; i++) {
        fprintf(f, "%s%s", i % 3u ? " 1" : " 2", (i + 1u) % (3u * s->joint_count) ? "" : "\n");
    }
    assert_int_equal(fclose(f), 0);
    return path;
}

static uint32_t hash_of_pack(const char *input, convert_only only, char *first_names, size_t room)
{
    convert_options options;
    size_t bytes;
    uint8_t *built;
    noh_pack pack;
    noh_skeleton skeleton;
    const noh_skeleton_header *header;
    uint32_t hash;
    memset(&options, 0, sizeof options);
    options.only = only;
    built = clip_pack(&input, 1, &options, &bytes);
    pack = test_open(built, bytes);
    assert_int_equal(noh_pack_skeleton_at(&pack, 0, &skeleton, &header, NULL), NOH_OK);
    hash = header->hash;
    first_names[0] = 0;
    for (uint32_t j = 0; j < skeleton.joint_count; j++) {
        size_t used = strlen(first_names);
        snprintf(first_names + used, room - used, "%s ", noh_pack_joint_name(&pack, 0, j));
    }
    free(built);
    return hash;
}

static void packs_built_apart_agree(void **state)
{
    model *m;
    model_clips *made;
    model_error error = { "", "" };
    sample_options rate = { 0.0 };
    char in_glb[2048], in_other[2048];
    const char *rcl = test_path("puppet.rcl");
    uint32_t hash;
    (void)state;
    assert_int_equal(model_read_gltf(puppet_path(), &m, &error), 0);
    assert_int_equal(clips_from_model(m, &rate, &made, &error), 0);
    assert_int_equal(rcl_write(rcl, &made->sets[0]->skeleton, &made->sets[0]->clips[0], &error), 0);
    hash = hash_of_pack(puppet_path(), CONVERT_MESH, in_glb, sizeof in_glb);
    assert_int_equal(hash_of_pack(rcl, CONVERT_ALL, in_other, sizeof in_other), hash);
    assert_string_equal(in_other, in_glb);
    assert_int_equal(hash_of_pack(write_bvh(&made->sets[0]->skeleton), CONVERT_ALL, in_other, sizeof in_other), hash);
    assert_string_equal(in_other, in_glb);
    assert_true(raw_skeleton_hash(&made->sets[0]->skeleton) != hash); /* else there was nothing to put into order */
    model_clips_free(made);
    model_free(m);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(nothing_moves_but_places),
                                        cmocka_unit_test(ordering_twice_changes_nothing),
                                        cmocka_unit_test(levels_drop_fingers_before_limbs),
                                        cmocka_unit_test(levels_are_sound_for_any_skeleton),
                                        cmocka_unit_test(packs_built_apart_agree) };
    if (argument_count > 1) {
        cmocka_set_test_filter(arguments[1]);
    }
    return cmocka_run_group_tests_name("joint_order", tests, NULL, NULL);
}
