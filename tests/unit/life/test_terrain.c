/* Tests of terrain: a picture and a model as a height field (tools/convert/terrain/), in a pack and out of it
 * (body.h), and what the pack's reader refuses. */
#include "noh/base.h"
#include "noh/body.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "support/pack_walk.h"
#include "support/support.h"

/* A hill of a model: 5 x 3 vertices, 8 x 4 m, height x^2 / 8 - z; and below it a triangle, the last one. */
static const char hill_gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    "\"nodes\":[{\"mesh\":0,\"translation\":[1,2,3]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
    "\"indices\":1}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":18,\"type\":\"VEC3\","
    "\"min\":[-4,-2,-2],\"max\":[4,4,2]},{\"bufferView\":1,\"componentType\":5123,\"count\":51,\"type\":\"SCALAR\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":216},{\"buffer\":0,\"byteOffset\":216,\"byteLength\":102}],"
    "\"buffers\":[{\"uri\":\"hill.bin\",\"byteLength\":318}]}";

static float hill_at(float x, float z)
{
    return x * x / 8.0f - z;
}

static const char *hill(void)
{
    static const float below[3][3] = { { -4.0f, -2.0f, -2.0f }, { -4.0f, -2.0f, 2.0f }, { 4.0f, -2.0f, 2.0f } };
    static const uint16_t last[3] = { 15, 16, 17 };
    uint8_t bytes[318];
    for (uint32_t i = 0; i < 15u; i++) {
        const float x = -4.0f + 2.0f * (float)(i % 5u), z = -2.0f + 2.0f * (float)(i / 5u);
        const float at[3] = { x, hill_at(x, z), z };
        memcpy(bytes + 12u * i, at, sizeof at);
    }
    for (uint32_t i = 0; i < 8u; i++) {
        const uint16_t a = (uint16_t)(i / 4u * 5u + i % 4u), b = (uint16_t)(a + 1u), c = (uint16_t)(a + 5u);
        const uint16_t six[6] = { a, c, b, b, c, (uint16_t)(c + 1u) };
        memcpy(bytes + 216u + 12u * i, six, sizeof six);
    }
    memcpy(bytes + 180, below, sizeof below);
    memcpy(bytes + 312, last, sizeof last);
    test_write_file(test_path("hill.bin"), bytes, sizeof bytes);
    const char *path = test_path("hill.gltf");
    test_write_file(path, hill_gltf, sizeof hill_gltf - 1u);
    return path;
}

static float height_at(const noh_field *f, float x, float z)
{
    float height = NAN;
    assert_true(noh_field_height(f, x, z, &height, NULL));
    return height;
}

/* Between the model's vertices along x, and from one row of them to the next: its surface to half a step. */
static void a_model_is_its_highest_surface(void **state)
{
    const terrain_options options = { 0.0, 0.0, 65 };
    model_error error;
    terrain t;
    (void)state;
    if (terrain_read(hill(), &options, &t, &error)) fail_msg("%s", error.what);
    assert_int_equal(t.width, 65);
    assert_int_equal(t.depth, 33);
    assert_int_equal(t.hole_count, 0);
    const noh_field f = terrain_field(&t);
    for (uint32_t i = 0; i < 15u; i++) {
        const float x = -4.0f + 2.0f * (float)(i % 5u), z = -2.0f + 2.0f * (float)(i / 5u);
        assert_float_equal(height_at(&f, x + 1.0f, z + 3.0f), 2.0f + hill_at(x, z), 1e-4f);
    }
    assert_float_equal(height_at(&f, 2.0f, 3.0f), 2.0f + 0.25f, 1e-4f); /* half way to the vertex of height 0.5 */
    terrain_free(&t);
}

static uint8_t *packed(size_t *count)
{
    convert_options options;
    convert_failure failure;
    byte_buffer out = { NULL, 0, 0, 0 };
    memset(&options, 0, sizeof options);
    options.texts[NOH_CHUNK_TERRAIN] = hill();
    options.ground.points = 17;
    if (convert_files(NULL, 0, &options, &out, &failure)) fail_msg("%s: %s", failure.file, failure.error.what);
    uint8_t *bytes = malloc(out.count);
    memcpy(bytes, out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    return bytes;
}

/* A pack of the ground alone. */
static void a_pack_has_it_in_place(void **state)
{
    size_t count;
    uint8_t *bytes = packed(&count);
    noh_pack pack;
    noh_field f;
    float normal[3], height;
    (void)state;
    assert_int_equal(noh_pack_open(bytes, count, &pack, NULL), NOH_OK);
    assert_int_equal(noh_terrain_of(&pack, &f, NULL), NOH_OK);
    assert_int_equal(f.width, 17);
    assert_int_equal(f.depth, 9);
    assert_true((const uint8_t *)f.heights > bytes && (const uint8_t *)(f.heights + 17u * 9u) <= bytes + count);
    assert_true(noh_field_height(&f, 1.0f, 3.0f, &height, normal));
    assert_float_equal(height, 2.0f, 1e-3f);
    assert_float_equal(normal[2] / normal[1], 1.0f, 1e-2f); /* it falls along z, one to one */
    free(bytes);
}

static void packs_without_have_none(void **state)
{
    const test_model_desc desc = { 1, 3, 2, 0, 6 };
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    noh_field f = { .width = 7 };
    noh_error error;
    noh_pack pack;
    (void)state;
    assert_int_equal(noh_pack_open(bytes, count, &pack, NULL), NOH_OK);
    assert_int_equal(noh_terrain_of(&pack, &f, &error), NOH_ERR_NOT_FOUND);
    assert_int_equal(f.width, 7);
    free(bytes);
}

/* Every word of its header, wrong in turn. */
static void broken_ones_are_refused(void **state)
{
    static const struct {
        size_t at;
        uint32_t value;
    } wrong[] = {
        { offsetof(noh_pack_terrain_header, width), 1 },
        { offsetof(noh_pack_terrain_header, width), 18 },
        { offsetof(noh_pack_terrain_header, depth), NOH_TERRAIN_SIZE_MAX + 1u },
        { offsetof(noh_pack_terrain_header, depth), 8 },
        { offsetof(noh_pack_terrain_header, origin), 0x7fc00000u },
        { offsetof(noh_pack_terrain_header, origin) + 8u, 0x7f800000u },
        { offsetof(noh_pack_terrain_header, spacing), 0 },
        { offsetof(noh_pack_terrain_header, spacing), 0xbf800000u },
        { offsetof(noh_pack_terrain_header, scale), 0xbf800000u },
        { offsetof(noh_pack_terrain_header, heights_offset), 64 },
        { offsetof(noh_pack_terrain_header, reserved) + 12u, 1 },
    };
    size_t count;
    uint8_t *bytes = packed(&count);
    noh_error error;
    noh_pack pack;
    (void)state;
    assert_int_equal(noh_pack_open(bytes, count, &pack, NULL), NOH_OK);
    const size_t at = (size_t)((const uint8_t *)noh_pack_chunk_at(&pack, NOH_CHUNK_TERRAIN, 0) - bytes);
    for (size_t i = 0; i < TEST_COUNT(wrong); i++) {
        uint32_t before;
        memcpy(&before, bytes + at + wrong[i].at, sizeof before);
        memcpy(bytes + at + wrong[i].at, &wrong[i].value, sizeof before);
        pack_repair(bytes, count);
        const noh_result result = noh_pack_open(bytes, count, &pack, &error);
        if (result != NOH_ERR_DATA || error.where < at)
            fail_msg("row %u: %d at %llu", (unsigned)i, result, (unsigned long long)error.where);
        memcpy(bytes + at + wrong[i].at, &before, sizeof before);
    }
    pack_repair(bytes, count);
    assert_int_equal(noh_pack_open(bytes, count, &pack, &error), NOH_OK);
    free(bytes);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_model_is_its_highest_surface),
        cmocka_unit_test(a_pack_has_it_in_place),
        cmocka_unit_test(packs_without_have_none),
        cmocka_unit_test(broken_ones_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
