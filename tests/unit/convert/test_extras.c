/* Extra attributes of vertices, from a glTF file to a pack: bytes and identities stay exact, floats are within the
 * stated error, garbage is named; names that are wrong or too many are refused, and so are lies in the chunk. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "convert/convert.h"
#include "convert/model/model_extra.h"
#include "noh/low_core.h"
#include "support/pack_walk.h"

#define VERTICES 4u

static const float waves[VERTICES] = { -3.25f, 0.1f, 7.5f, 1e-3f };
static const uint8_t weights[VERTICES][4] = { { 0, 51, 255, 0 }, { 7, 8, 9, 0 }, { 255, 0, 128, 0 }, { 1, 2, 3, 0 } };
static const uint16_t identities[VERTICES][2] = { { 65535, 0 }, { 12, 0 }, { 1, 0 }, { 40000, 0 } };
static const float lightmap[VERTICES][2] = { { 0, 0 }, { 1, 0 }, { 0.3f, 0.7f }, { 1, 1 } };

/* A square: _WAVE floats, _MASK three normalised bytes, _ID a short, TEXCOORD_1 floats. `wave`: the first value. */
static const char *save(float wave)
{
    static const float position[VERTICES][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } };
    static const uint16_t indices[6] = { 0, 1, 2, 2, 1, 3 };
    static const char json[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"extras.bin\",\"byteLength\":140}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":16},"
        "{\"buffer\":0,\"byteOffset\":64,\"byteLength\":16,\"byteStride\":4},"
        "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":16,\"byteStride\":4},"
        "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":128,\"byteLength\":12}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"SCALAR\"},"
        "{\"bufferView\":2,\"componentType\":5121,\"normalized\":true,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":3,\"componentType\":5123,\"count\":4,\"type\":\"SCALAR\"},"
        "{\"bufferView\":4,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":5,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"name\":\"m\",\"primitives\":[{\"indices\":5,\"attributes\":{\"POSITION\":0,\"_WAVE\":1,"
        "\"_MASK\":2,\"_ID\":3,\"TEXCOORD_1\":4}}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}";
    uint8_t data[140];
    memcpy(data, position, 48);
    memcpy(data + 48, waves, 16);
    memcpy(data + 48, &wave, 4);
    memcpy(data + 64, weights, 16);
    memcpy(data + 80, identities, 16);
    memcpy(data + 96, lightmap, 32);
    memcpy(data + 128, indices, 12);
    test_write_file(test_path("extras.bin"), data, sizeof data);
    test_write_file(test_path("extras.gltf"), json, sizeof json - 1u);
    return test_path("extras.gltf");
}

/* NULL: refused. report: NULL, or what is printed. */
static uint8_t *build(const char *list, float wave, size_t *count, FILE *report, convert_failure *failure)
{
    const char *inputs[1] = { save(wave) };
    byte_buffer out = { NULL, 0, 0, 0 };
    convert_options options;
    uint8_t *bytes;
    memset(&options, 0, sizeof options);
    memset(failure, 0, sizeof *failure);
    options.warnings = report;
    if (extras_parse(list, &options.source.extras, &failure->error) ||
        convert_files(inputs, 1, &options, &out, failure)) {
        return NULL;
    }
    bytes = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    return bytes;
}

static const noh_extra_row *rows_of(const noh_mesh *mesh)
{
    return (const noh_extra_row *)(const void *)((const uint8_t *)mesh->extras + mesh->extras->rows_offset);
}

/* The vertex of the file at the place of the pack's. */
static uint32_t source_of(const noh_mesh *mesh, uint32_t v)
{
    const float *p = mesh->positions + 3u * (size_t)v;
    return (uint32_t)(p[0] + 0.5f) + 2u * (uint32_t)(p[1] + 0.5f);
}

static void values_arrive(void **state)
{
    convert_failure failure;
    size_t count;
    uint8_t *bytes = build("TEXCOORD_1,_MASK,_ID,_WAVE", waves[0], &count, NULL, &failure);
    noh_pack pack;
    noh_mesh mesh;
    (void)state;
    if (!bytes) fail_msg("%s", failure.error.what);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    assert_int_equal(mesh.header->extra_words, 3); /* 4 halves, then 3 bytes */
    assert_int_equal(mesh.header->attribute_stride, 16);
    for (uint32_t v = 0; v < VERTICES; v++) {
        const uint32_t from = source_of(&mesh, v);
        float got[4];
        assert_int_equal(noh_mesh_extra(&mesh, 0, v, got), 2);
        for (int c = 0; c < 2; c++) assert_true(fabsf(got[c] - lightmap[from][c]) <= 0.5f / 65535.0f + 1e-7f);
        assert_int_equal(noh_mesh_extra(&mesh, 1, v, got), 3);
        for (int c = 0; c < 3; c++) assert_true(fabsf(got[c] - (float)weights[from][c] / 255.0f) <= 6e-8f);
        assert_true(got[3] == 0.0f);
        assert_int_equal(noh_mesh_extra(&mesh, 2, v, got), 1);
        assert_true(got[0] == (float)identities[from][0]);
        assert_int_equal(noh_mesh_extra(&mesh, 3, v, got), 1);
        assert_true(fabsf(got[0] - waves[from]) <= 0.5f * 10.75f / 65535.0f + 1e-6f);
        assert_int_equal(noh_mesh_extra(&mesh, 4, v, got), 0);
    }
    free(bytes);
}

/* Without the option the pack has the same bytes as before there was one; with 8 bits the record is smaller. */
static void they_cost_what_is_asked_for(void **state)
{
    convert_failure failure;
    size_t plain, bytes_8, bytes_16;
    uint8_t *packs[3];
    noh_pack pack;
    noh_mesh mesh;
    (void)state;
    packs[0] = build(NULL, 0.0f, &plain, NULL, &failure);
    packs[1] = build("_WAVE:8,_ID:16", 0.0f, &bytes_8, NULL, &failure);
    packs[2] = build("_WAVE,_MASK:16", 0.0f, &bytes_16, NULL, &failure);
    pack = test_open(packs[0], plain);
    mesh = test_mesh(&pack, 0);
    assert_null(mesh.extras);
    assert_int_equal(mesh.header->attribute_stride, 4);
    pack = test_open(packs[1], bytes_8);
    mesh = test_mesh(&pack, 0);
    assert_int_equal(mesh.header->extra_words, 1);
    assert_true(rows_of(&mesh)[0].bits == 8.0f && rows_of(&mesh)[0].first_bit == 16.0f);
    pack = test_open(packs[2], bytes_16);
    mesh = test_mesh(&pack, 0);
    assert_int_equal(mesh.header->extra_words, 2);
    assert_true(rows_of(&mesh)[1].bits == 8.0f); /* as the file has it: 16 would add nothing */
    for (int i = 0; i < 3; i++) free(packs[i]);
}

static void garbage_is_named(void **state)
{
    static char said[2048];
    FILE *report = tmpfile();
    convert_failure failure;
    size_t count, bytes_read;
    uint8_t *bytes = build("_WAVE", NAN, &count, report, &failure);
    noh_pack pack;
    noh_mesh mesh;
    float got[4];
    (void)state;
    if (!bytes) fail_msg("%s", failure.error.what);
    rewind(report);
    bytes_read = fread(said, 1, sizeof said - 1u, report);
    said[bytes_read] = 0;
    fclose(report);
    assert_non_null(strstr(said, "_WAVE (accessor 1), element 0: the value is NaN"));
    assert_non_null(strstr(said, "the attribute _MASK was left out; --attributes keeps it"));
    assert_null(strstr(said, "the attribute _WAVE"));
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    for (uint32_t v = 0; v < VERTICES; v++) {
        const uint32_t from = source_of(&mesh, v);
        (void)noh_mesh_extra(&mesh, 0, v, got);
        assert_true(fabsf(got[0] - (from ? waves[from] : 0.0f)) < 1e-3f);
    }
    free(bytes);
}

static void wrong_lists_are_refused(void **state)
{
    static const char *const lists[][2] = {
        { "", "neither TEXCOORD_n nor" },
        { "COLOR_1", "neither TEXCOORD_n nor" },
        { "TEXCOORD_x", "neither TEXCOORD_n" },
        { "_WAVE:12", "8 or 16 bits" },
        { "_WAVE,_WAVE", "twice" },
        { "_A,_B,_C,_D,_E,_F", "up to 5 names" },
        { "_NOWHERE", "no mesh has '_NOWHERE'" },
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(lists); i++) {
        convert_failure failure;
        size_t count;
        assert_null(build(lists[i][0], 0.0f, &count, NULL, &failure));
        if (!strstr(failure.error.what, lists[i][1])) fail_msg("%s: '%s'", lists[i][0], failure.error.what);
    }
}

/* ---- lies ---- */

typedef struct forged {
    uint8_t *bytes;
    size_t count;
    noh_pack_chunk *chunk;
    noh_extras_header *h;
    noh_extra_name *names;
    noh_extra_row *rows;
} forged;

static void forge(forged *f)
{
    convert_failure failure;
    uint8_t *base;
    f->bytes = build("_WAVE,_MASK", waves[0], &f->count, NULL, &failure);
    assert_non_null(f->bytes);
    f->chunk = pack_find(f->bytes, NOH_TAG_EXTRAS);
    assert_non_null(f->chunk);
    base = f->bytes + f->chunk->offset;
    f->h = (noh_extras_header *)(void *)base;
    f->names = (noh_extra_name *)(void *)(base + f->h->names_offset);
    f->rows = (noh_extra_row *)(void *)(base + f->h->rows_offset);
}

/* name, a word of the message, the lie */
#define FORGERIES(X)                                                    \
    X(mesh, "do not fit their mesh", f->h->mesh = 1)                    \
    X(none, "do not fit their mesh", f->h->count = 0)                   \
    X(many, "do not fit their mesh", f->h->count = NOH_EXTRAS_MAX + 1u) \
    X(words, "do not fit their mesh", f->h->word_count = 3)             \
    X(reserved, "reserved field", f->h->reserved[2] = 1)                \
    X(names, "begin", f->h->names_offset += 16)                         \
    X(rows, "begin", f->h->rows_offset += 16)                           \
    X(name, "name", f->names[0].name_hash ^= 1u)                        \
    X(error, "error or reserved", f->names[1].error = -1.0f)            \
    X(error_nan, "not finite", f->names[1].error = NAN)                 \
    X(bits, "impossible bits", f->rows[0].bits = 12.0f)                 \
    X(bits_nan, "not finite", f->rows[0].bits = NAN)                    \
    X(components, "impossible bits", f->rows[0].component_count = 1.5f) \
    X(five, "impossible bits", f->rows[0].component_count = 5.0f)       \
    X(outside, "impossible bits", f->rows[1].first_bit = 48.0f)         \
    X(before, "impossible bits", f->rows[1].first_bit = -8.0f)          \
    X(within, "impossible bits", f->rows[1].first_bit = 20.0f)          \
    X(fraction, "impossible bits", f->rows[1].first_bit = 16.5f)        \
    X(box, "not finite", f->rows[0].offset[0] = INFINITY)               \
    X(step, "step below 0", f->rows[0].step[0] = -1.0f)                 \
    X(no_component, "impossible bits", f->rows[0].step[3] = 1.0f)       \
    X(lacking, "impossible bits", f->rows[0].component_count = 0.0f)
#include "support/forgeries_template.h"

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(values_arrive),    cmocka_unit_test(they_cost_what_is_asked_for),
    cmocka_unit_test(garbage_is_named), cmocka_unit_test(wrong_lists_are_refused),
    cmocka_unit_test(lies_are_refused),
};

TEST_MAIN(tests, NULL, NULL)
