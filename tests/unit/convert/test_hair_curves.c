/* Control hairs from curves (tools/convert/base/curves.h, model/hair_grow.h): lines of a glTF file, and hair that takes
 * their shapes.
 * cross: never, the reader of glTF is C++ */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "convert/base/curves.h"
#include "convert/base/hair_read.h"
#include "convert/model/hair_grow.h"

/* Seven points, and primitives of them as JSON; the node is moved by 1 along x. */
static const char *save(const char *primitives)
{
    static const float points[21] = { 0, 1, 0, 0, 2, 0, 0, 2, 1, 5, 1, 0, 5, 3, 0, NAN, 0, 0, 6, 6, 6 };
    char json[2048];
    const int used = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"curves.bin\",\"byteLength\":104}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":84},{\"buffer\":0,\"byteOffset\":84,\"byteLength\":20}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":7,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":10,\"type\":\"SCALAR\"}],"
        "\"nodes\":[{\"mesh\":0,\"translation\":[1,0,0]}],\"meshes\":[{\"name\":\"hair\",\"primitives\":[%s]}]}",
        primitives);
    const uint16_t index[10] = { 0, 1, 1, 2, 3, 4, 2, 6, 9, 9 };
    unsigned char data[104];
    assert_true(used > 0 && (size_t)used < sizeof json);
    memcpy(data, points, 84);
    memcpy(data + 84, index, 20);
    test_write_file(test_path("curves.bin"), data, sizeof data);
    test_write_file(test_path("curves.gltf"), json, (size_t)used);
    return test_path("curves.gltf");
}

static void expect_point(const curve_list *c, uint32_t point, float x, float y, float z)
{
    const float *p = c->points + 3 * point;
    assert_true(p[0] == x && p[1] == y && p[2] == z);
}

static void a_strip_is_a_curve(void **state)
{
    curve_list c;
    model_error error = { "", "" };
    (void)state;
    assert_int_equal(curves_read(save("{\"mode\":3,\"attributes\":{\"POSITION\":0}}"), &c, &error), 0);
    assert_int_equal(c.count, 1); /* what is behind the damaged point is one point: no curve */
    assert_int_equal(c.starts[1], 5);
    expect_point(&c, 0, 1, 1, 0);
    expect_point(&c, 4, 6, 3, 0);
    curves_free(&c);
}

static void chains_of_segments_are_curves(void **state)
{
    curve_list c;
    model_error error = { "", "" };
    (void)state;
    assert_int_equal(curves_read(save("{\"mode\":1,\"indices\":1,\"attributes\":{\"POSITION\":0}}"), &c, &error), 0);
    assert_int_equal(c.count, 3);
    assert_int_equal(c.starts[1], 3);
    assert_int_equal(c.starts[2], 5);
    assert_int_equal(c.starts[3], 7);
    expect_point(&c, 2, 1, 2, 1);
    expect_point(&c, 3, 6, 1, 0);
    curves_free(&c);
}

static void without_curves_it_is_refused(void **state)
{
    curve_list c;
    model_error error = { "", "" };
    (void)state;
    assert_int_equal(curves_read(save("{\"attributes\":{\"POSITION\":0}}"), &c, &error), 1);
    assert_non_null(strstr(error.what, "the file has no curves: export them as lines"));
    curves_free(&c);
    assert_int_equal(curves_read(save("{\"mode\":3,\"attributes\":{\"POSITION\":7}}"), &c, &error), 1);
    assert_non_null(strstr(error.what, "accessor 7 does not exist"));
    curves_free(&c);
}

/* With one curve every hair has its shape: from its root up by 1, then ahead by 1, where the skull leaves room. */
static void hair_takes_the_shape_of_curves(void **state)
{
    static const char text[] = "skull 0 0 0 0.1 0.1 0.1\naround 4\nrows 2\npoints 3\ncurves curves.gltf\n";
    static const char strip[] = "{\"mode\":1,\"indices\":1,\"attributes\":{\"POSITION\":0}}";
    hair_text *hair = NULL;
    hair_grown grown;
    model_error error = { "", "" };
    uint32_t line = 0;
    (void)state;
    (void)save(strip);
    test_write_file(test_path("curves.hair"), text, sizeof text - 1u);
    if (hair_read(test_path("curves.hair"), &hair, &line, &error)) fail_msg("line %u: %s", line, error.what);
    assert_int_equal(hair->curves.count, 3);
    hair->curves.count = 1; /* the first: up, then ahead */
    assert_int_equal(hair_grow(hair, &grown), 0);
    assert_int_equal(grown.hair_count, 8);
    for (uint32_t h = 0; h < grown.hair_count; h++) {
        const float *p = grown.points + 9 * h;
        const float radius = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        assert_true(fabsf(radius - 0.098f) < 1e-4f); /* roots are on the skull, as without curves */
        assert_true(fabsf(p[3] - p[0]) + fabsf(p[4] - p[1] - 1.0f) + fabsf(p[5] - p[2]) < 1e-4f);
        assert_true(fabsf(p[6] - p[0]) + fabsf(p[7] - p[1] - 1.0f) + fabsf(p[8] - p[2] - 1.0f) < 1e-4f);
    }
    hair_grown_free(&grown);
    hair_free(hair);
    test_write_file(test_path("curves.hair"), "skull 0 0 0 1 1 1\ncurves no.gltf\n", 33);
    assert_int_equal(hair_read(test_path("curves.hair"), &hair, &line, &error), 1);
    assert_int_equal(line, 2);
    assert_non_null(strstr(error.what, "no.gltf: the file does not exist"));
    hair_free(hair);
}

/* Between two curves of different lengths, hair is between them, and nearer to the nearer one. */
static void hair_between_curves_is_between_them(void **state)
{
    static float points[12] = { 0, 0.1f, -0.1f, 0, 0.1f, -1.1f, 0, 0.1f, 0.1f, 0, 0.1f, 3.1f };
    static uint32_t starts[3] = { 0, 2, 4 };
    static const char text[] = "skull 0 0 0 0.1 0.1 0.1\nrows 3\naround 8\npoints 2\n";
    hair_text *hair = NULL;
    hair_grown grown;
    model_error error = { "", "" };
    uint32_t line = 0;
    float least = 1e9f, most = -1e9f;
    (void)state;
    test_write_file(test_path("plain.hair"), text, sizeof text - 1u);
    assert_int_equal(hair_read(test_path("plain.hair"), &hair, &line, &error), 0);
    hair->curves = (curve_list){ points, starts, 2 };
    assert_int_equal(hair_grow(hair, &grown), 0);
    for (uint32_t h = 0; h < grown.hair_count; h++) {
        const float *p = grown.points + 6 * h, way = p[5] - p[2];
        assert_true(way > -1.001f && way < 3.001f);
        least = fminf(least, way);
        most = fmaxf(most, way);
    }
    assert_true(least < 0.3f && most > 1.7f);
    hair_grown_free(&grown);
    memset(&hair->curves, 0, sizeof hair->curves);
    hair_free(hair);
}

/* Combed over the top of a skull, hair lies at its height over it, not ever farther away along a tangent. */
static void combed_hair_lies_on_the_skull(void **state)
{
    static const char text[] = "skull 0 0 0 0.09 0.09 0.09\ncomb 0 -0.45 -0.9\nlength 0.3 0.3\nlift 0.004\n";
    hair_text *hair = NULL;
    hair_grown grown;
    model_error error = { "", "" };
    uint32_t line = 0;
    float most = 0.0f;
    (void)state;
    test_write_file(test_path("plain.hair"), text, sizeof text - 1u);
    assert_int_equal(hair_read(test_path("plain.hair"), &hair, &line, &error), 0);
    assert_int_equal(hair_grow(hair, &grown), 0);
    for (uint32_t i = 0; i < grown.hair_count * grown.point_count; i++) {
        const float *p = grown.points + 3 * i;
        if (p[1] > 0.06f) most = fmaxf(most, sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
    }
    print_message("# at most %.1f mm over the skull\n", 1e3 * ((double)most - 0.09));
    assert_true(most > 0.0925f && most < 0.0980f);
    hair_grown_free(&grown);
    hair_free(hair);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_strip_is_a_curve),
        cmocka_unit_test(chains_of_segments_are_curves),
        cmocka_unit_test(without_curves_it_is_refused),
        cmocka_unit_test(hair_takes_the_shape_of_curves),
        cmocka_unit_test(hair_between_curves_is_between_them),
        cmocka_unit_test(combed_hair_lies_on_the_skull),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
