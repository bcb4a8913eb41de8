/* Packs without their finest LOD levels: what is left is to the bit what the full pack has there, is chosen at the same
 * scales, keeps its numbers and errors, and knows where it came from. Lies in such packs are refused. */
#include "support/lod_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/pack/pack_strip.h"
#include "stage/character/lod_internal.h"
#include "stage/character/lod_pack_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "support/level_fixture.h"
#include "support/pack_walk.h"

#define LEVELS 4u
#define SCALES 4000

/* ---- packs ---- */

typedef struct kept {
    uint8_t *bytes;
    size_t count;
    noh_pack pack;
} kept;

static kept face, tube; /* rigid, with targets; skinned, in two palettes: LEVELS levels each */

static kept keep(const uint8_t *bytes, size_t count)
{
    kept k;
    k.bytes = test_aligned(bytes, count);
    k.count = count;
    k.pack = test_open(k.bytes, count);
    return k;
}

static kept build(model *m, uint32_t palette)
{
    const lod_settings settings = { LEVELS, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    lod_pack p;
    kept k;
    lod_pack_make(m, &settings, palette, &p);
    assert_int_equal(p.mesh.header->level_count, LEVELS);
    k = keep(p.bytes, p.byte_count);
    lod_pack_free(&p);
    model_free(m);
    return k;
}

static int set_up(void **state)
{
    const lod_face of_face = { 24, 20, LOD_FACE_TARGETS, 1, 0 };
    const skin_cylinder of_tube = { 4, 16, 24, 2, 2, 0, 2.0f, 0.5f };
    (void)state;
    face = build(lod_face_model(&of_face), 0);
    tube = build(lod_tube_model(&of_tube), 6);
    assert_true(test_mesh(&tube.pack, 0).header->palette_count > 1);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(face.bytes);
    free(tube.bytes);
    return 0;
}

static kept strip(const noh_pack *pack, const char *item)
{
    const strip_levels levels = { &item, 1 };
    uint32_t *first = test_zeros((pack->runs[NOH_CHUNK_MESH].count + 1u) * sizeof *first);
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error = { "", "" };
    kept k;
    if (strip_levels_of(&levels, pack, first, &error) || pack_strip(pack, first, &out, &error)) {
        fail_msg("%s", error.what);
    }
    k = keep(out.bytes, out.count);
    buffer_free(&out);
    free(first);
    return k;
}

/* For each pack and each level to cut at. */
static void for_all(void (*check)(const noh_mesh *full, const noh_mesh *stripped, uint32_t first))
{
    static const char *const items[LEVELS] = { "0", "1", "2", "3" };
    const kept *const all[2] = { &face, &tube };
    for (uint32_t i = 0; i < 2; i++) {
        for (uint32_t first = 1; first < LEVELS; first++) {
            kept k = strip(&all[i]->pack, items[first]);
            const noh_mesh full = test_mesh(&all[i]->pack, 0), stripped = test_mesh(&k.pack, 0);
            check(&full, &stripped, first);
            free(k.bytes);
        }
    }
}

/* ---- what is left ---- */

static void expect_same_vertices(const noh_mesh *a, const noh_mesh *b)
{
    const noh_mesh_header *h = a->header;
    assert_memory_equal(a->positions, b->positions, h->vertex_count * 12u);
    assert_memory_equal(a->attributes, b->attributes, h->vertex_count * h->attribute_stride);
    assert_memory_equal(a->influences, b->influences, h->vertex_count * 4u * NOH_INFLUENCE_WORDS(h->influence_count));
    assert_memory_equal(a->submeshes, b->submeshes, h->submesh_count * sizeof *a->submeshes);
    for (uint32_t i = 0; i < h->index_count; i++) {
        assert_int_equal(noh_mesh_index(a, i), noh_mesh_index(b, i));
    }
}

/* All but the place of what levels share, and the fields that say what is missing. */
static void expect_same_header(const noh_mesh *a, const noh_mesh *b, uint32_t first)
{
    noh_mesh_header x = *a->header, y = *b->header;
    assert_int_equal(y.level_first, first);
    y.level_first = y.source_crc = 0;
    x.positions_offset = y.positions_offset, x.attributes_offset = y.attributes_offset;
    x.indices_offset = y.indices_offset, x.submeshes_offset = y.submeshes_offset;
    x.targets_offset = y.targets_offset, x.weights_offset = y.weights_offset;
    x.rects_offset = y.rects_offset, x.texels_offset = y.texels_offset;
    x.target_boxes_offset = y.target_boxes_offset, x.influences_offset = y.influences_offset;
    x.palettes_offset = y.palettes_offset, x.palette_joints_offset = y.palette_joints_offset;
    x.joint_boxes_offset = y.joint_boxes_offset;
    assert_memory_equal(&x, &y, sizeof x);
}

static void expect_same_targets(const noh_mesh *a, const noh_mesh *b)
{
    test_random r = test_random_from(5);
    const uint32_t targets = a->header->target_count;
    float *weights = test_zeros((targets + 1u) * sizeof *weights);
    noh_morph_layers x = test_layers(a), y = test_layers(b);
    for (uint32_t t = 0; t < targets; t++) {
        weights[t] = 2.0f * (float)test_random_below(&r, 1000u) / 1000.0f - 0.5f;
        assert_string_equal(noh_pack_string(a->pack, a->targets[t].name), noh_pack_string(b->pack, b->targets[t].name));
        assert_true(a->targets[t].radius == b->targets[t].radius);
    }
    noh_morph_accumulate(a, weights, &x);
    noh_morph_accumulate(b, weights, &y);
    assert_int_equal(noh_morph_layers_size(a), noh_morph_layers_size(b));
    if (noh_morph_layers_size(a)) assert_memory_equal(x.position, y.position, noh_morph_layers_size(a));
    assert_memory_equal(a->weights, b->weights, targets * sizeof *weights);
    assert_memory_equal(a->target_boxes, b->target_boxes, targets * 24u);
    free(x.position);
    free(y.position);
    free(weights);
}

static void expect_same_levels(const noh_mesh *full, const noh_mesh *stripped, uint32_t first)
{
    for (uint32_t k = first; k < LEVELS; k++) {
        const noh_mesh a = noh_mesh_at_lod(full, k), b = noh_mesh_at_lod(stripped, k);
        assert_int_equal(b.header->level, k);
        expect_same_header(&a, &b, first);
        expect_same_vertices(&a, &b);
        expect_same_targets(&a, &b);
    }
}

static void levels_that_stay_are_the_full_pack_s_to_the_bit(void **state)
{
    (void)state;
    for_all(expect_same_levels);
}

static void expect_numbers(const noh_mesh *full, const noh_mesh *stripped, uint32_t first)
{
    assert_int_equal(stripped->header->level, first);
    assert_int_equal(stripped->header->level_count, LEVELS);
    assert_true(stripped->header->level_error_rest > 0.0f);
    for (uint32_t k = 0; k < 10; k++) {
        const uint32_t level = k < first ? first : k < LEVELS ? k : LEVELS - 1u;
        const noh_mesh at = noh_mesh_at_lod(stripped, k), back = noh_mesh_at_lod(&at, 0);
        assert_int_equal(at.header->level, level);
        assert_ptr_equal(back.header, stripped->header);
        assert_int_equal(noh_mesh_source(&at), noh_mesh_source(full));
    }
    assert_int_not_equal(noh_mesh_source(full), 0);
    assert_true(stripped->pack->byte_count < full->pack->byte_count);
}

static void levels_keep_their_numbers_and_their_source(void **state)
{
    (void)state;
    for_all(expect_numbers);
    assert_int_not_equal(test_mesh(&face.pack, 0).header->vertex_count, test_mesh(&tube.pack, 0).header->vertex_count);
    {
        const noh_mesh a = test_mesh(&face.pack, 0), b = test_mesh(&tube.pack, 0);
        assert_int_not_equal(noh_mesh_source(&a), noh_mesh_source(&b));
    }
}

/* The scale falls and rises again, and trembles: hysteresis, fades and all. */
static void expect_same_choices(const noh_mesh *full, const noh_mesh *stripped, uint32_t first)
{
    const noh_mesh loaded = noh_mesh_at_lod(full, first);
    noh_lod_mesh levels[2][NOH_LOD_LEVELS_MAX];
    noh_lod_table tables[2];
    noh_lod states[2];
    noh_lod_settings settings;
    test_random r = test_random_from(11);
    uint32_t seen = 0;
    memset(&settings, 0, sizeof settings);
    memset(tables, 0, sizeof tables);
    memset(states, 0, sizeof states);
    noh_lod_mesh_levels(&loaded, levels[0], &tables[0]);
    noh_lod_mesh_levels(stripped, levels[1], &tables[1]);
    assert_int_equal(noh_lod_table_check(&tables[1], NULL), NOH_OK);
    assert_int_equal(tables[1].mesh_level_first, first);
    assert_memory_equal(levels[0] + first, levels[1] + first, (LEVELS - first) * sizeof levels[0][0]);
    for (int i = 0; i < SCALES; i++) {
        const double there = fabs((double)(i % 800) / 400.0 - 1.0);
        const double scale = pow(10.0, 7.0 * there - 2.0) * (0.9 + 2e-4 * (double)test_random_below(&r, 1000u));
        for (int k = 0; k < 2; k++) {
            noh_lod_choose(&states[k], &tables[k], &settings, (float)scale, NULL, 400 * (int64_t)i);
        }
        assert_memory_equal(&states[0], &states[1], sizeof states[0]);
        seen |= 1u << states[1].mesh;
    }
    assert_int_equal(seen, ((1u << LEVELS) - 1u) & ~((1u << first) - 1u));
}

static void the_same_levels_are_chosen_at_the_same_scales(void **state)
{
    (void)state;
    for_all(expect_same_choices);
}

static void nothing_but_a_prefix_is_left(void **state)
{
    kept k = strip(&face.pack, "2");
    const noh_mesh full = test_mesh(&face.pack, 0), level = noh_mesh_at_lod(&full, 2), mesh = test_mesh(&k.pack, 0);
    const noh_pack_chunk *chunk = &k.pack.chunks[k.pack.runs[NOH_CHUNK_MESH].first],
                         *from = &face.pack.chunks[face.pack.runs[NOH_CHUNK_MESH].first];
    const uint32_t vertices = full.header->vertex_count - level.header->vertex_count,
                   texels = full.header->texel_count - level.header->texel_count;
    (void)state;
    assert_true(vertices > 0 && texels > 0);
    assert_in_range(from->bytes - chunk->bytes, vertices * (12u + full.header->attribute_stride) + 12u * texels,
                    from->bytes);
    assert_int_equal(mesh.header->texel_count, level.header->texel_count);
    assert_int_equal(mesh.header->rect_count, level.header->rect_count);
    free(k.bytes);
}

/* ---- what is asked for ---- */

static void expect_same_bytes(const kept *a, const kept *b)
{
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->bytes, b->bytes, a->count);
}

static void stripping_in_steps_gives_the_same_bytes(void **state)
{
    const kept *const all[2] = { &face, &tube };
    (void)state;
    for (int i = 0; i < 2; i++) {
        kept at_once = strip(&all[i]->pack, "3"), first = strip(&all[i]->pack, "1"), then = strip(&first.pack, "3"),
             back = strip(&at_once.pack, "1"), none = strip(&all[i]->pack, "0"), past = strip(&all[i]->pack, "7");
        expect_same_bytes(&at_once, &then);
        expect_same_bytes(&at_once, &back); /* a level that is not there any more */
        expect_same_bytes(all[i], &none);
        expect_same_bytes(&at_once, &past);
        free(at_once.bytes);
        free(first.bytes);
        free(then.bytes);
        free(back.bytes);
        free(none.bytes);
        free(past.bytes);
    }
}

/* Three meshes, with levels and without, and everything else that a pack has. */
static void meshes_are_cut_by_name(void **state)
{
    const test_model_desc made = { 3, 7, 3, TEST_SCENE | TEST_COLORS, 1 };
    static const char *const items[] = { "2", "=1", "x=1", "8", "1x", "", "-1", "1=", "mesh_1=" };
    size_t count;
    uint8_t *bytes = test_pack(&made, &count);
    noh_pack plain = test_open(bytes, count);
    fixture_levels levels;
    (void)state;
    fixture_levels_open(&levels, &plain, 3, 1.5f);
    for (uint32_t m = 0; m < 3; m++) {
        char item[64];
        kept k, of_plain;
        snprintf(item, sizeof item, "%s=2",
                 noh_pack_chunk_name(&levels.pack, levels.pack.runs[NOH_CHUNK_MESH].first + m));
        k = strip(&levels.pack, item);
        of_plain = strip(&plain, item); /* its coarsest is its only one */
        assert_memory_equal(of_plain.bytes, plain.bytes, count);
        for (uint32_t i = 0; i < 3; i++) {
            assert_int_equal(test_mesh(&k.pack, i).header->level, i == m ? 2 : 0);
        }
        assert_int_equal(k.pack.chunk_count, levels.pack.chunk_count);
        for (uint32_t c = 0; c < k.pack.chunk_count; c++) {
            const noh_pack_chunk *a = &k.pack.chunks[c], *b = &levels.pack.chunks[c];
            assert_int_equal(a->type, b->type);
            if (c != k.pack.runs[NOH_CHUNK_MESH].first + m) assert_int_equal(a->crc, b->crc);
        }
        assert_int_equal(pack_walk(&k.pack, 1), pack_walk(&k.pack, 1));
        free(k.bytes);
        free(of_plain.bytes);
    }
    for (size_t i = 1; i < TEST_COUNT(items); i++) {
        const strip_levels wrong = { &items[i], 1 };
        uint32_t first[3];
        model_error error = { "", "" };
        assert_int_equal(strip_levels_of(&wrong, &levels.pack, first, &error), 1);
        assert_non_null(strstr(error.what, i == 2 ? "no mesh is named 'x'" : "is not a level"));
    }
    fixture_levels_close(&levels);
    free(bytes);
}

static void the_last_item_for_a_mesh_counts(void **state)
{
    static const char *const items[] = { "3", "face=1", "2" };
    uint32_t first = 9;
    (void)state;
    assert_string_equal(noh_pack_chunk_name(&face.pack, face.pack.runs[NOH_CHUNK_MESH].first), "face");
    for (uint32_t count = 0; count <= 3; count++) {
        static const uint32_t expected[] = { 0, 3, 1, 2 };
        const strip_levels levels = { items, count };
        assert_int_equal(strip_levels_of(&levels, &face.pack, &first, NULL), 0);
        assert_int_equal(first, expected[count]);
    }
}

/* More than 65,536 vertices take 4 bytes an index, the level that is left 2. */
static void indices_become_narrow_where_they_fit(void **state)
{
    const test_model_desc large = { 1, 270, 0, 0, 1 };
    size_t count;
    uint8_t *bytes = test_pack(&large, &count);
    noh_pack plain = test_open(bytes, count);
    fixture_levels levels;
    noh_mesh full, mesh;
    kept k;
    (void)state;
    fixture_levels_open(&levels, &plain, 3, 2.0f);
    k = strip(&levels.pack, "2");
    full = test_mesh(&levels.pack, 0);
    mesh = test_mesh(&k.pack, 0);
    full = noh_mesh_at_lod(&full, 2);
    assert_int_equal(full.header->index_bytes, 4);
    assert_int_equal(mesh.header->index_bytes, 2);
    assert_true(mesh.header->index_count > 0);
    expect_same_vertices(&full, &mesh);
    free(k.bytes);
    fixture_levels_close(&levels);
    free(bytes);
}

/* ---- lies ---- */

static void expect_refused(const kept *good, void (*lie)(noh_mesh_header *h), const char *message)
{
    uint8_t *bytes = test_aligned(good->bytes, good->count);
    noh_error error = { NOH_OK, "nothing", 0, 0 };
    noh_pack pack;
    noh_result result;
    lie((noh_mesh_header *)(void *)(bytes + good->pack.chunks[good->pack.runs[NOH_CHUNK_MESH].first].offset));
    pack_repair(bytes, good->count);
    result = noh_pack_open(bytes, good->count, &pack, &error);
    if (result != NOH_ERR_DATA || !strstr(error.what, message)) {
        fail_msg("result %d: %s; not %s", (int)result, error.what, message);
    }
    free(bytes);
}

/* h: the headers of levels 1, 2 and 3 */
#define LIES(X)                                                                                           \
    X(lacks_fewer, (h[0].level_first = h[1].level_first = h[2].level_first = 0), "begin with the finest") \
    X(lacks_more, (h[0].level_first = h[1].level_first = h[2].level_first = 2), "begin with the finest")  \
    X(lacks_all, (h[0].level_first = h[0].level = 4), "lacks all")                                        \
    X(lacks_too_many, (h[0].level_first = h[0].level = 0xffffffffu), "lacks all")                         \
    X(is_level_0, (h[0].level_first = h[0].level = 0), "has all levels but names a source")               \
    X(one_level_only, h[0].level_count = 2, "an array does not begin at")                                 \
    X(level_twice, h[1].level = 1, "out of order")                                                        \
    X(other_first, h[1].level_first = 0, "differs in what all levels share")                              \
    X(other_source, h[2].source_crc ^= 1u, "differs in what all levels share")                            \
    X(negative_error, h[0].level_error_rest = -1.0f, "error")                                             \
    X(error_falls, h[0].level_error_rest = h[2].level_error_rest * 2.0f, "below the finer")               \
    X(reserved, h[0].reserved[0] = 1, "reserved")

#define X(name, statement, message)            \
    static void lie_##name(noh_mesh_header *h) \
    {                                          \
        (void)(statement);                     \
    }
LIES(X)
#undef X

static void lies_about_what_is_missing_are_refused(void **state)
{
    kept k = strip(&face.pack, "1");
    (void)state;
#define X(name, statement, message) expect_refused(&k, lie_##name, message);
    LIES(X)
#undef X
    free(k.bytes);
}

/* With repaired checksums a flipped bit of a header may be harmless; then everything can be used. */
static void any_bit_of_the_headers_may_flip(void **state)
{
    const kept *const all[2] = { &face, &tube };
    uint32_t opened = 0;
    (void)state;
    for (int i = 0; i < 2; i++) {
        kept k = strip(&all[i]->pack, "2");
        const size_t at = k.pack.chunks[k.pack.runs[NOH_CHUNK_MESH].first].offset;
        for (size_t bit = 8u * at; bit < 8u * (at + 2u * sizeof(noh_mesh_header)); bit++) {
            noh_pack pack;
            k.bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
            pack_repair(k.bytes, k.count);
            if (noh_pack_open(k.bytes, k.count, &pack, NULL) == NOH_OK) {
                (void)pack_walk(&pack, (uint32_t)bit);
                opened++;
            }
            k.bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        }
        free(k.bytes);
    }
    assert_true(opened > 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(levels_that_stay_are_the_full_pack_s_to_the_bit),
    cmocka_unit_test(levels_keep_their_numbers_and_their_source),
    cmocka_unit_test(the_same_levels_are_chosen_at_the_same_scales),
    cmocka_unit_test(nothing_but_a_prefix_is_left),
    cmocka_unit_test(stripping_in_steps_gives_the_same_bytes),
    cmocka_unit_test(meshes_are_cut_by_name),
    cmocka_unit_test(the_last_item_for_a_mesh_counts),
    cmocka_unit_test(indices_become_narrow_where_they_fit),
    cmocka_unit_test(lies_about_what_is_missing_are_refused),
    cmocka_unit_test(any_bit_of_the_headers_may_flip),
};

TEST_MAIN(tests, set_up, tear_down)
