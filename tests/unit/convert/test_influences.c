/* test_influences.c: JOINTS_n and WEIGHTS_n of glTF meshes. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model.h"

/* Three vertices with up to three sets: positions, then JOINTS_n as bytes, then WEIGHTS_n as floats. */
typedef struct skinned {
    uint8_t joints[3][3][4]; /* [set][vertex] */
    float weights[3][3][4];
    int sets;
    const char *attributes; /* NULL: all sets */
    int joint_count;
} skinned;

static const char *save(const skinned *s)
{
    static char json[8192], attributes[512];
    uint8_t bytes[36 + 36 + 144];
    const float positions[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    memcpy(bytes, positions, 36);
    memcpy(bytes + 36, s->joints, 36);
    memcpy(bytes + 72, s->weights, 144);
    test_write_file(test_path("skinned.bin"), bytes, sizeof bytes);
    int used = snprintf(attributes, sizeof attributes, "\"POSITION\":0");
    for (int i = 0; i < s->sets; ++i)
        used += snprintf(attributes + used, sizeof attributes - (size_t)used, ",\"JOINTS_%d\":%d,\"WEIGHTS_%d\":%d", i,
                         1 + i, i, 4 + i);
    used = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"skinned.bin\",\"byteLength\":216}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36},"
        "{\"buffer\":0,\"byteOffset\":72,\"byteLength\":144}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}");
    for (int i = 0; i < 6; ++i)
        used += snprintf(json + used, sizeof json - (size_t)used,
                         ",{\"bufferView\":%d,\"byteOffset\":%d,\"componentType\":%d,\"count\":3,\"type\":\"VEC4\"}",
                         i < 3 ? 1 : 2, i % 3 * (i < 3 ? 12 : 48), i < 3 ? 5121 : 5126);
    used += snprintf(json + used, sizeof json - (size_t)used,
                     "],\"meshes\":[{\"name\":\"m\",\"primitives\":[{\"attributes\":{%s}},{\"attributes\":{%s}}]}],"
                     "\"nodes\":[{\"mesh\":0,\"skin\":0}",
                     attributes, s->attributes ? s->attributes : attributes);
    for (int i = 0; i < s->joint_count; ++i) used += snprintf(json + used, sizeof json - (size_t)used, ",{}");
    used += snprintf(json + used, sizeof json - (size_t)used, "],\"skins\":[{\"joints\":[");
    for (int i = 0; i < s->joint_count; ++i)
        used += snprintf(json + used, sizeof json - (size_t)used, "%s%d", i ? "," : "", i + 1);
    used += snprintf(json + used, sizeof json - (size_t)used, "]}]}");
    assert_true(used > 0 && (size_t)used < sizeof json);
    test_write_file(test_path("skinned.gltf"), json, (size_t)used);
    test_keep_glb_seed(json, bytes, sizeof bytes);
    return test_path("skinned.gltf");
}

/* Every vertex wholly on joint 1. */
static skinned simple(int sets)
{
    skinned s = { { { { 0 } } }, { { { 0 } } }, sets, NULL, 20 };
    for (int v = 0; v < 3; ++v) {
        s.joints[0][v][0] = 1;
        s.weights[0][v][0] = 1.0f;
    }
    return s;
}

static model *load(const skinned *s)
{
    model *m = NULL;
    model_error error = { "", "" };
    if (model_read_gltf(save(s), &m, &error)) fail_msg("refused: %s (%s)", error.what, error.where);
    return m;
}

static int has_warning(const model *m, const char *text)
{
    int found = 0;
    for (uint32_t i = 0; i < m->warning_count; ++i) found += strstr(m->warnings[i], text) != NULL;
    return found;
}

static void sorted_and_summed(void **state)
{
    (void)state;
    skinned s = simple(2);
    const float weights[8] = { 0.1f, 0, 0.405f, 0, 0.3f, 0.2f, 0, 0 };
    const uint8_t joints[8] = { 3, 200, 7, 0, 19, 4, 0, 255 };
    for (int i = 0; i < 8; ++i) {
        s.joints[i / 4][2][i % 4] = joints[i];
        s.weights[i / 4][2][i % 4] = weights[i];
    }
    model *m = load(&s);
    const model_mesh *mesh = &m->meshes[0];
    const uint16_t expected[8] = { 7, 19, 4, 3, 0, 0, 0, 0 };
    assert_int_equal(mesh->influence_max, 4);
    assert_int_equal(mesh->joint_limit, 20); /* what no weight uses does not count */
    assert_memory_equal(mesh->joints + 2 * MODEL_INFLUENCES_MAX, expected, sizeof expected);
    float sum = 0.0f;
    for (size_t i = 0; i < 8; ++i) sum += mesh->joint_weights[2 * MODEL_INFLUENCES_MAX + i];
    assert_true(fabsf(sum - 1.0f) < 1e-6f &&
                fabsf(mesh->joint_weights[2 * MODEL_INFLUENCES_MAX] - 0.405f / 1.005f) < 1e-6f &&
                mesh->joint_weights[2 * MODEL_INFLUENCES_MAX + 4] == 0.0f);
    assert_int_equal(mesh->joints[0], 1);
    assert_true(mesh->joint_weights[0] == 1.0f &&
                mesh->joint_weights[3 * MODEL_INFLUENCES_MAX] == 1.0f); /* the second primitive too */
    assert_int_equal(m->nodes[0].skin, 0);
    model_free(m);
}

static void more_than_eight_are_all_read(void **state)
{
    (void)state;
    skinned s = simple(3);
    for (int i = 0; i < 12; ++i) {
        s.joints[i / 4][1][i % 4] = (uint8_t)i;
        s.weights[i / 4][1][i % 4] = (float)(i + 1) / 78.0f;
    }
    model *m = load(&s);
    assert_int_equal(m->meshes[0].influence_max, 12);
    float sum = 0.0f;
    for (size_t i = 0; i < 12; ++i) {
        assert_int_equal(m->meshes[0].joints[MODEL_INFLUENCES_MAX + i], 11 - i);
        sum += m->meshes[0].joint_weights[MODEL_INFLUENCES_MAX + i];
    }
    assert_true(fabsf(sum - 1.0f) < 1e-6f);
    assert_false(has_warning(m, "more than"));
    model_free(m);
}

/* What does not sum to 1 is divided by its sum. One warning for the whole mesh: how many vertices, and the sum that is
 * farthest from 1. The second primitive has the same vertices. */
static void weights_are_normalised_with_a_warning(void **state)
{
    (void)state;
    skinned s = simple(1);
    s.weights[0][0][0] = 0.5f;
    s.weights[0][0][1] = 0.4812f;
    s.weights[0][2][0] = 0.999f; /* as exporters round: not worth a word */
    model *m = load(&s);
    assert_int_equal(m->warning_count, 1);
    assert_string_equal(
        m->warnings[0],
        "mesh 'm': the weights of 2 vertices do not sum to 1 and were divided by their sum, at worst 0.9812");
    assert_true(fabsf(m->meshes[0].joint_weights[0] - 0.5f / 0.9812f) < 1e-6f &&
                fabsf(m->meshes[0].joint_weights[1] - 0.4812f / 0.9812f) < 1e-6f);
    assert_true(m->meshes[0].joint_weights[2 * MODEL_INFLUENCES_MAX] == 1.0f);
    model_free(m);
    s.weights[0][0][0] = 0.7f; /* above 1 the implied last weight would be negative */
    s.weights[0][0][1] = 0.5f;
    s.weights[0][1][0] = 0.9f;
    m = load(&s);
    assert_true(
        has_warning(m, "the weights of 4 vertices do not sum to 1 and were divided by their sum, at worst 1.2"));
    assert_true(fabsf(m->meshes[0].joint_weights[0] - 0.7f / 1.2f) < 1e-6f &&
                fabsf(m->meshes[0].joint_weights[1] - 0.5f / 1.2f) < 1e-6f);
    model_free(m);
}

/* Without any weight a vertex would have no place in any pose. */
static void vertices_without_weights_follow_a_joint(void **state)
{
    (void)state;
    skinned s = simple(1);
    s.weights[0][2][0] = 0.0f;
    s.joints[0][2][0] = 4;
    model *m = load(&s);
    assert_true(has_warning(m, "mesh 'm': 2 vertices have no weight for any joint"));
    assert_int_equal(m->meshes[0].joints[2 * MODEL_INFLUENCES_MAX], 4);
    assert_true(m->meshes[0].joint_weights[2 * MODEL_INFLUENCES_MAX] == 1.0f &&
                m->meshes[0].joint_weights[2 * MODEL_INFLUENCES_MAX + 1] == 0.0f);
    model_free(m);
}

/* What a weight cannot be counts as 0; what is left sums to 1. */
static void bad_influences_are_repaired(void **state)
{
    (void)state;
    static const float bad[4] = { -0.5f, NAN, INFINITY, -INFINITY };
    static const char *const told[4] = { "vertex 2: a weight below 0 was read as 0",
                                         "element 2: the value is NaN, infinite or above 1e12", "it was read as 0",
                                         "it was read as 0" };
    model *m;
    skinned s;
    for (size_t i = 0; i < TEST_COUNT(bad); ++i) {
        s = simple(1);
        s.weights[0][2][0] = 0.25f;
        s.weights[0][2][1] = bad[i];
        s.joints[0][2][0] = 3;
        m = load(&s);
        assert_true(has_warning(m, told[i]));
        assert_true(m->meshes[0].joints[2 * MODEL_INFLUENCES_MAX] == 3);
        assert_true(m->meshes[0].joint_weights[2 * MODEL_INFLUENCES_MAX] == 1.0f &&
                    m->meshes[0].joint_weights[2 * MODEL_INFLUENCES_MAX + 1] == 0.0f);
        model_free(m);
    }
    s = simple(1);
    s.joints[0][1][0] = 20;
    m = load(&s);
    assert_true(has_warning(m, "mesh 'm' vertex 1 follows a joint that its skin does not have"));
    assert_true(m->meshes[0].joints[MODEL_INFLUENCES_MAX] < 20 && m->meshes[0].joint_limit <= 20);
    model_free(m);
    s = simple(1);
    s.attributes = "\"POSITION\":0,\"JOINTS_0\":1";
    m = load(&s);
    assert_true(m->meshes[0].joints[3 * MODEL_INFLUENCES_MAX] == 0);
    assert_true(has_warning(m, "primitive 1: it has JOINTS_0 without WEIGHTS_0, which was ignored"));
    model_free(m);
    s.attributes = "\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":1";
    m = load(&s);
    assert_true(has_warning(m, "not allowed here"));
    model_free(m);
}

static void primitives_without_joints_follow_the_first(void **state)
{
    (void)state;
    skinned s = simple(1);
    s.attributes = "\"POSITION\":0";
    model *m = load(&s);
    assert_int_equal(m->meshes[0].joints[3 * MODEL_INFLUENCES_MAX], 0);
    assert_true(m->meshes[0].joint_weights[3 * MODEL_INFLUENCES_MAX] == 1.0f);
    assert_true(m->warning_count > 0 && strstr(m->warnings[0], "bound to the first joint"));
    model_free(m);
    s.sets = 0;
    m = load(&s);
    assert_null(m->meshes[0].joints);
    assert_int_equal(m->meshes[0].influence_max, 0);
    model_free(m);
}

static void real_meshes(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t influences;
    } files[] = { { "khronos/SimpleSkin.gltf", 2 }, { "khronos/Fox.glb", 4 },    { "khronos/RobotExpressive.glb", 4 },
                  { "hero/body.glb", 4 },           { "hero/body_8inf.glb", 7 }, { "hero/body_quantized.glb", 4 } };
    for (size_t i = 0; i < TEST_COUNT(files); ++i) {
        model *m = NULL;
        model_error error = { "", "" };
        uint32_t most = 0;
        if (model_read_gltf(test_asset(files[i].name), &m, &error))
            fail_msg("%s refused: %s (%s)", files[i].name, error.what, error.where);
        for (uint32_t k = 0; k < m->mesh_count; ++k)
            most = m->meshes[k].influence_max > most ? m->meshes[k].influence_max : most;
        print_message("%s: up to %u joints move a vertex\n", files[i].name, most);
        assert_true(most > 0 && most <= files[i].influences);
        model_free(m);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(sorted_and_summed),
    cmocka_unit_test(more_than_eight_are_all_read),
    cmocka_unit_test(weights_are_normalised_with_a_warning),
    cmocka_unit_test(vertices_without_weights_follow_a_joint),
    cmocka_unit_test(bad_influences_are_repaired),
    cmocka_unit_test(primitives_without_joints_follow_the_first),
    cmocka_unit_test(real_meshes),
};

TEST_MAIN(tests, NULL, NULL)
