/* Springs that a glTF file brings: VRMC_springBone, secondaryAnimation of VRM 0, lines in extras; what cannot swing. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "stage/modules/springs_internal.h"
#include "noh/modules.h"

/* A triangle that node 0 moves, and a head with a strand of three joints and an end; `nodes` may add to these. */
static const char *save(const char *scale, const char *rest)
{
    static char json[8192];
    static const unsigned char joints[12];
    static const float data[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 }, weights[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
    unsigned char bytes[96];
    int used;
    memcpy(bytes, data, 36);
    memcpy(bytes + 36, weights, 48);
    memcpy(bytes + 84, joints, 12);
    used = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"springs.bin\",\"byteLength\":96}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":84,\"byteLength\":12}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"},"
        "{\"bufferView\":2,\"componentType\":5121,\"count\":3,\"type\":\"VEC4\"}],"
        "\"meshes\":[{\"name\":\"m\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"WEIGHTS_0\":1,\"JOINTS_0\":2}}]}],"
        "\"skins\":[{\"joints\":[0,1,2,3,4,5]}],\"scene\":0,\"scenes\":[{\"nodes\":[0,6]}],\"nodes\":["
        "{\"name\":\"head\",\"translation\":[0,1.5,0],\"children\":[1]%s},"
        "{\"name\":\"a\",\"translation\":[0,0.1,-0.1],\"children\":[2]},"
        "{\"name\":\"b\",\"translation\":[0,-0.1,0],\"children\":[3,5]},"
        "{\"name\":\"c\",\"translation\":[0,-0.1,0],\"children\":[4]},"
        "{\"name\":\"end\",\"translation\":[0.02,-0.08,0]},"
        "{\"name\":\"side\",\"translation\":[0.1,0,0]},"
        "{\"name\":\"m\",\"mesh\":0,\"skin\":0}]%s}",
        scale, rest);
    assert_true(used > 0 && (size_t)used < sizeof json);
    test_write_file(test_path("springs.bin"), bytes, sizeof bytes);
    test_write_file(test_path("springs.gltf"), json, (size_t)used);
    test_keep_glb_seed(json, bytes, sizeof bytes);
    return test_path("springs.gltf");
}

static uint8_t *bytes;
static noh_pack pack;

/* The springs of the pack; 0: it has none. warning: a part of what is reported, or NULL. */
static int convert(const char *scale, const char *rest, noh_springs_desc *d, const char *warning)
{
    const char *path = save(scale, rest);
    byte_buffer out = { NULL, 0, 0, 0 };
    convert_options options;
    convert_failure failure;
    char *said = NULL;
    size_t said_bytes = 0;
    memset(&options, 0, sizeof options);
    options.report = tmpfile();
    assert_non_null(options.report);
    if (convert_files(&path, 1, &options, &out, &failure)) fail_msg("refused: %s", failure.error.what);
    said_bytes = (size_t)ftell(options.report);
    said = test_zeros(said_bytes + 1u);
    rewind(options.report);
    assert_int_equal(fread(said, 1, said_bytes, options.report), said_bytes);
    (void)fclose(options.report);
    if (warning ? !strstr(said, warning) : strstr(said, "warning") != NULL) fail_msg("said: %s", said);
    free(said);
    bytes = test_aligned(out.bytes, out.count);
    pack = test_open(bytes, out.count);
    buffer_free(&out);
    return noh_springs_of_pack(&pack, 0, d);
}

static const char *row_name(const noh_springs_desc *d, uint32_t chain, uint32_t row)
{
    return noh_pack_joint_name(&pack, 0, d->rows[d->chains[chain].first_row + row].joint);
}

#define VRM1_HEAD \
    ",\"extensionsUsed\":[\"VRMC_springBone\"],\"extensions\":{\"VRMC_springBone\":{\"specVersion\":\"1.0\","
#define VRM1_JOINT(node) \
    "{\"node\":" #node   \
    ",\"hitRadius\":0.02,\"stiffness\":0.7,\"gravityPower\":0.5,\"gravityDir\":[0,0,1],\"dragForce\":0.3}"
#define VRM1_COLLIDERS                                                                                \
    "\"colliders\":[{\"node\":0,\"shape\":{\"sphere\":{\"offset\":[0,0.05,0],\"radius\":0.1}}},"      \
    "{\"node\":0,\"shape\":{\"capsule\":{\"offset\":[0,0,0],\"radius\":0.06,\"tail\":[0,-0.2,0]}}}]," \
    "\"colliderGroups\":[{\"colliders\":[1]},{\"colliders\":[0,1]}],"

static void a_spring_bone_is_a_chain(void **state)
{
    noh_springs_desc d;
    (void)state;
    assert_true(convert("",
                        VRM1_HEAD VRM1_COLLIDERS "\"springs\":[{\"joints\":[" VRM1_JOINT(1) "," VRM1_JOINT(
                            2) "," VRM1_JOINT(3) ",{\"node\":4}],\"colliderGroups\":[0]}]}}",
                        &d, NULL));
    assert_int_equal(d.chain_count, 1);
    assert_int_equal(d.row_count, 3); /* the last joint is an end alone */
    assert_string_equal(row_name(&d, 0, 0), "a");
    assert_string_equal(row_name(&d, 0, 2), "c");
    assert_float_equal(d.chains[0].end[0], 0.02f, 1e-6);
    assert_float_equal(d.chains[0].end[1], -0.08f, 1e-6);
    assert_float_equal(d.rows[1].stiffness, 0.7f, 1e-6);
    assert_float_equal(d.rows[1].drag, 0.3f, 1e-6);
    assert_float_equal(d.rows[1].radius, 0.02f, 1e-6);
    assert_float_equal(d.rows[1].gravity[2], 0.5f, 1e-6);
    assert_int_equal(d.collider_count, 2);
    assert_int_equal(d.chains[0].collides, 2);
    assert_float_equal(d.colliders[1].to[1], -0.2f, 1e-6);
    assert_float_equal(d.colliders[0].to[1], 0.05f, 1e-6); /* a sphere */
    free(bytes);
}

/* Colliders without a shape, springs of one joint, numbers that are no nodes: left out with a warning. */
static void what_is_broken_is_left_out(void **state)
{
    noh_springs_desc d;
    (void)state;
    assert_false(
        convert("", VRM1_HEAD "\"springs\":[{\"joints\":[" VRM1_JOINT(1) "]}]}}", &d, "fewer than two joints"));
    free(bytes);
    assert_true(convert("",
                        VRM1_HEAD
                        "\"colliders\":[{\"node\":0,\"shape\":{\"box\":{}}}],\"springs\":[{\"joints\":[" VRM1_JOINT(
                            1) "," VRM1_JOINT(2) "],\"center\":0}]}}",
                        &d, "neither a sphere nor a capsule"));
    assert_int_equal(d.collider_count, 0);
    free(bytes);
    assert_true(convert("", VRM1_HEAD "\"springs\":[{\"joints\":[" VRM1_JOINT(1) "," VRM1_JOINT(2) "],\"center\":0}]}}",
                        &d, "a center was ignored"));
    free(bytes);
    assert_false(convert("",
                         VRM1_HEAD "\"springs\":[{\"joints\":[{\"node\":99},{\"node\":-1},{\"node\":1e30},7,null]},"
                                   "{\"joints\":3},5],\"colliders\":7,\"colliderGroups\":{}}}",
                         &d, "fewer than two joints"));
    free(bytes);
    assert_true(convert("",
                        VRM1_HEAD VRM1_COLLIDERS "\"springs\":[{\"joints\":[" VRM1_JOINT(1) "," VRM1_JOINT(
                            99) "," VRM1_JOINT(2) "],\"colliderGroups\":[0]}]}}",
                        &d, "springs: a joint was left out: its node does not exist"));
    assert_int_equal(d.row_count, 1);
    free(bytes);
    assert_true(convert("",
                        VRM1_HEAD VRM1_COLLIDERS
                        "\"springs\":[{\"joints\":[" VRM1_JOINT(1) "," VRM1_JOINT(2) "],\"colliderGroups\":[0,9]}]}}",
                        &d, "springs: a collider group was ignored: the file has no such one"));
    assert_int_equal(d.chains[0].collides, 2);
    free(bytes);
    /* numbers out of their range become the nearest good ones */
    assert_true(convert("",
                        VRM1_HEAD "\"springs\":[{\"joints\":[{\"node\":1,\"dragForce\":9,\"stiffness\":-4,"
                                  "\"hitRadius\":-1,\"gravityDir\":[1e300,0,0],\"gravityPower\":2},{\"node\":2}]}]}}",
                        &d, NULL));
    assert_float_equal(d.rows[0].drag, 1.0f, 0.0);
    assert_float_equal(d.rows[0].stiffness, 0.0f, 0.0);
    assert_float_equal(d.rows[0].gravity[0], 0.0f, 0.0);
    free(bytes);
}

/* A joint that is skipped ends a chain, and what follows is the next one. */
static void a_gap_makes_two_chains(void **state)
{
    noh_springs_desc d;
    (void)state;
    assert_true(
        convert("", VRM1_HEAD "\"springs\":[{\"joints\":[" VRM1_JOINT(1) "," VRM1_JOINT(3) "," VRM1_JOINT(4) "]}]}}",
                &d, NULL));
    assert_int_equal(d.chain_count, 2);
    assert_float_equal(d.chains[0].end[1], -0.2f, 1e-6); /* over the joint between */
    assert_string_equal(row_name(&d, 1, 0), "c");
    free(bytes);
}

static void the_older_format_swings_all_below(void **state)
{
    noh_springs_desc d;
    (void)state;
    assert_true(convert(
        "",
        ",\"extensionsUsed\":[\"VRM\"],\"extensions\":{\"VRM\":{\"secondaryAnimation\":{\"boneGroups\":"
        "[{\"stiffiness\":0.6,\"gravityPower\":0.25,\"gravityDir\":{\"x\":0,\"y\":-1,\"z\":0},\"dragForce\":0.35,"
        "\"center\":-1,\"hitRadius\":0.03,\"bones\":[1],\"colliderGroups\":[0]}],\"colliderGroups\":"
        "[{\"node\":0,\"colliders\":[{\"offset\":{\"x\":0.01,\"y\":0.02,\"z\":0.03},\"radius\":0.09}]}]}}}",
        &d, NULL));
    assert_int_equal(d.chain_count, 2);
    assert_int_equal(d.row_count, 5); /* a, b, c, end; side */
    assert_int_equal(d.collider_count, 1);
    assert_float_equal(d.colliders[0].from[2], -0.03f, 1e-6);
    for (uint32_t i = 0; i < 2; i++) {
        const float *end = d.chains[i].end;
        assert_float_equal(sqrtf(end[0] * end[0] + end[1] * end[1] + end[2] * end[2]), 0.07f, 1e-6);
        assert_int_equal(d.chains[i].collides, 1);
    }
    assert_float_equal(d.rows[0].stiffness, 0.6f, 1e-6);
    assert_float_equal(d.rows[0].gravity[1], -0.25f, 1e-6);
    free(bytes);
}

static void extras_are_lines(void **state)
{
    noh_springs_desc d;
    (void)state;
    assert_true(
        convert(",\"extras\":{\"springs\":[\"collider head 0.1\",\"chain a to c stiffness 0.4\"]}", "", &d, NULL));
    assert_int_equal(d.row_count, 3);
    assert_float_equal(d.chains[0].end[1], -0.08f, 1e-6); /* to the joint below */
    assert_int_equal(d.chains[0].collides, 1);
    free(bytes);
    assert_true(convert("", ",\"extras\":{\"springs\":\"chain side; chain nose\"}", &d,
                        "'nose' in extras: no skeleton has this joint"));
    assert_int_equal(d.row_count, 1);
    free(bytes);
    assert_true(convert("", ",\"extras\":{\"springs\":\"chain side drag 7; chain a to b\"}", &d, "drag is 7"));
    assert_int_equal(d.row_count, 2);
    free(bytes);
}

/* A joint where its parent is has no direction: the chain goes round it. */
static void bones_without_length_do_not_swing(void **state)
{
    noh_springs_desc d;
    (void)state;
    assert_true(
        convert("", ",\"extras\":{\"springs\":\"chain side end 0 0 0; chain a to b\"}", &d, "no bone with a length"));
    assert_int_equal(d.row_count, 2);
    free(bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_spring_bone_is_a_chain), cmocka_unit_test(what_is_broken_is_left_out),
    cmocka_unit_test(a_gap_makes_two_chains),   cmocka_unit_test(the_older_format_swings_all_below),
    cmocka_unit_test(extras_are_lines),         cmocka_unit_test(bones_without_length_do_not_swing),
};

TEST_MAIN(tests, NULL, NULL)
