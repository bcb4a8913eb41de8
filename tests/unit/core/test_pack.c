/* The checker of packs: a good one opens and can be used in full; cut, flipped and forged ones are errors that say what
 * and where, or packs that can still be used in full.
 * cross: never, its pack has clips, which C++ makes of a model */
#include "support/support.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/pack_walk.h"
#include "noh/low_core.h"

/* ---- a small pack of every kind of chunk ---- */

static uint8_t *good;
static size_t good_count;

static int set_up(void **state)
{
    const test_model_desc desc = { 1, 4, 3, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 7 };
    (void)state;
    good = test_pack(&desc, &good_count);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(good);
    return 0;
}

static void opens_and_walks(void **state)
{
    noh_pack pack = test_open(good, good_count);
    (void)state;
    assert_int_equal(pack.runs[NOH_CHUNK_MESH].count, 1);
    assert_int_equal(pack.runs[NOH_CHUNK_TEXTURE].count, 1);
    assert_int_equal(pack.material_count, 2);
    assert_int_equal(pack.node_count, 2);
    assert_int_equal(pack.runs[NOH_CHUNK_CLIP].count, 3);
    assert_true(test_mesh(&pack, 0).header->pair_count > 0);
    assert_int_equal(pack_walk(&pack, 1), pack_walk(&pack, 1));
    assert_int_not_equal(pack_walk(&pack, 1), pack_walk(&pack, 2));
}

static void past_the_last_is_not_found(void **state)
{
    noh_pack pack = test_open(good, good_count);
    noh_mesh mesh;
    noh_pack_clip clip;
    noh_texture texture;
    noh_skin skin;
    noh_skeleton skeleton;
    (void)state;
#define MISSING(call, index, count)                        \
    do {                                                   \
        noh_error error = { NOH_OK, NULL, 7, 7 };          \
        assert_int_equal(call, NOH_ERR_NOT_FOUND);         \
        assert_int_equal(error.result, NOH_ERR_NOT_FOUND); \
        assert_non_null(error.what);                       \
        assert_int_equal(error.where, index);              \
        assert_int_equal(error.need, count);               \
    } while (0)
    MISSING(noh_pack_mesh_at(&pack, 1, &mesh, &error), 1, 1);
    MISSING(noh_pack_clip_at(&pack, 3, &clip, &error), 3, 3);
    MISSING(noh_pack_texture_at(&pack, 1, &texture, &error), 1, 1);
    MISSING(noh_pack_skin_at(&pack, 0, &skin, &error), 0, 0);
    MISSING(noh_pack_skin_at(&pack, NOH_NONE, &skin, &error), NOH_NONE, 0);
    MISSING(noh_pack_skeleton_at(&pack, 0, &skeleton, NULL, &error), 0, 0);
#undef MISSING
    assert_string_equal(noh_pack_string(&pack, pack.string_bytes), "");
    assert_string_equal(noh_pack_chunk_name(&pack, pack.chunk_count), "");
}

/* The writer's version is reported and does not matter. */
static void the_header_has_the_version_of_its_writer(void **state)
{
    uint8_t *other = test_aligned(good, good_count);
    noh_pack pack = test_open(good, good_count);
    (void)state;
    assert_string_equal(noh_version(), NOH_VERSION);
    assert_int_equal(noh_version_number(), NOH_VERSION_NUMBER(NOH_VERSION_MAJOR, NOH_VERSION_MINOR, NOH_VERSION_PATCH));
    assert_int_equal(pack.library_version, noh_version_number());
    ((noh_pack_header *)(void *)other)->library_version = NOH_VERSION_NUMBER(9, 1, 2);
    pack_repair(other, good_count);
    pack = test_open(other, good_count);
    assert_int_equal(pack.library_version >> 24, 9);
    free(other);
}

static void the_smallest_mesh_opens(void **state)
{
    const test_model_desc desc = { 1, 2, 0, 0, 1 };
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    (void)state;
    assert_int_equal(mesh.header->touched_count, 0);
    assert_int_equal(noh_morph_layers_size(&mesh), 0);
    pack_walk(&pack, 1);
    free(bytes);
}

/* ---- arguments ---- */

static void misaligned_memory_is_an_argument_error(void **state)
{
    uint8_t *block = test_aligned(NULL, good_count + 16);
    noh_pack pack;
    (void)state;
    for (size_t shift = 1; shift < NOH_MEMORY_ALIGN; shift++) {
        noh_error error = { NOH_OK, NULL, 0, 0 };
        memcpy(block + shift, good, good_count);
        assert_int_equal(noh_pack_open(block + shift, good_count, &pack, &error), NOH_ERR_ARG);
        assert_non_null(strstr(error.what, "aligned"));
        assert_int_equal(error.need, NOH_MEMORY_ALIGN);
    }
    memcpy(block + NOH_MEMORY_ALIGN, good, good_count); /* that is enough, the 64 of the file are not asked for */
    assert_int_equal(noh_pack_open(block + NOH_MEMORY_ALIGN, good_count, &pack, NULL), NOH_OK);
    free(block);
}

static void null_is_an_argument_error(void **state)
{
    noh_pack pack;
    (void)state;
    assert_int_equal(noh_pack_open(NULL, good_count, &pack, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_pack_open(good, good_count, NULL, NULL), NOH_ERR_ARG);
}

static void a_failed_open_leaves_the_pack_alone(void **state)
{
    noh_pack pack, before;
    (void)state;
    memset(&pack, 0x5a, sizeof pack);
    before = pack;
    assert_int_not_equal(noh_pack_open(good, good_count - 1, &pack, NULL), NOH_OK);
    assert_memory_equal(&pack, &before, sizeof pack);
}

/* ---- every cut, every flip ---- */

static int is_clean_error(const noh_error *error, noh_result result, size_t count)
{
    int kind = result == NOH_ERR_DATA || result == NOH_ERR_LIMIT || result == NOH_ERR_VERSION;
    return kind && error->result == result && error->what && error->what[0] && error->where <= count;
}

static void every_truncation_is_an_error(void **state)
{
    (void)state;
    for (size_t count = 0; count < good_count; count++) {
        uint8_t *cut = test_aligned(good, count); /* exactly as long: a read past the end is a fault */
        noh_pack pack;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result = noh_pack_open(cut, count, &pack, &error);
        if (!is_clean_error(&error, result, count)) {
            fail_msg("cut to %zu of %zu bytes: result %d", count, good_count, (int)result);
        }
        free(cut);
    }
}

static void every_truncation_is_an_error_even_if_the_header_agrees(void **state)
{
    (void)state;
    for (size_t count = 64; count < good_count; count++) {
        uint8_t *cut = test_aligned(good, count);
        noh_pack pack;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result;
        ((noh_pack_header *)(void *)cut)->byte_count = (uint32_t)count;
        pack_repair(cut, count);
        result = noh_pack_open(cut, count, &pack, &error);
        if (!is_clean_error(&error, result, count)) {
            fail_msg("cut to %zu of %zu bytes, header told: result %d", count, good_count, (int)result);
        }
        free(cut);
    }
}

static void every_single_bit_flip_is_an_error(void **state)
{
    uint8_t *bytes = test_aligned(good, good_count);
    (void)state;
    for (size_t bit = 0; bit < 8 * good_count; bit++) {
        noh_pack pack;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result;
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        result = noh_pack_open(bytes, good_count, &pack, &error);
        if (!is_clean_error(&error, result, good_count)) {
            fail_msg("bit %zu of byte %zu: result %d", bit % 8, bit / 8, (int)result);
        }
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    free(bytes);
}

/* With repaired checksums only the structural checks are left. Many flips then give valid packs (another colour,
 * another weight), which must be usable in full. */
static void every_flip_with_repaired_checksums_is_safe(void **state)
{
    uint8_t *bytes = test_aligned(NULL, good_count);
    size_t opened = 0, refused = 0;
    (void)state;
    for (size_t bit = 0; bit < 8 * good_count; bit++) {
        noh_pack pack;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result;
        memcpy(bytes, good, good_count);
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        pack_repair(bytes, good_count);
        result = noh_pack_open(bytes, good_count, &pack, &error);
        if (result == NOH_OK) {
            pack_walk(&pack, (uint32_t)bit);
            opened++;
        } else if (is_clean_error(&error, result, good_count)) {
            refused++;
        } else {
            fail_msg("bit %zu of byte %zu: result %d", bit % 8, bit / 8, (int)result);
        }
    }
    print_message("# %zu bytes: %zu flips open, %zu are refused\n", good_count, opened, refused);
    assert_true(opened > 0 && refused > 0);
    free(bytes);
}

/* Several random bytes reach states that one bit does not. */
static void random_damage_with_repaired_checksums_is_safe(void **state)
{
    static const uint32_t extremes[] = { 0, 1, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0x7fc00000u, 0x7f800000u, 64 };
    test_random r = test_random_from(11);
    uint8_t *bytes = test_aligned(NULL, good_count);
    (void)state;
    for (int round = 0; round < 20000; round++) {
        noh_pack pack;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result;
        memcpy(bytes, good, good_count);
        for (uint32_t i = 0; i <= test_random_below(&r, 3); i++) {
            uint32_t word = test_random_below(&r, (uint32_t)good_count / 4u);
            uint32_t value = test_random_below(&r, 2) ? extremes[test_random_below(&r, 8)] : test_random_below(&r, 300);
            memcpy(bytes + 4u * word, &value, 4);
        }
        pack_repair(bytes, good_count);
        result = noh_pack_open(bytes, good_count, &pack, &error);
        if (result == NOH_OK) {
            pack_walk(&pack, (uint32_t)round);
        } else if (!is_clean_error(&error, result, good_count)) {
            fail_msg("round %d: result %d", round, (int)result);
        }
    }
    free(bytes);
}

/* ---- forged packs: one lie each ---- */

/* A copy of the good pack, with names for its parts. */
typedef struct forged {
    uint8_t *bytes;
    size_t count;
    noh_pack_header *header;
    noh_pack_chunk *chunks;
    noh_pack_chunk *strings_at, *texture_at, *materials_at, *mesh_at, *nodes_at, *clip_at; /* in the table */
    char *strings;
    noh_texture_header *texture;
    noh_material *materials;
    noh_mesh_header *mesh;
    float *positions, *weights;
    uint16_t *indices;
    noh_submesh *submeshes;
    noh_target *targets;
    noh_rect *rects;
    uint32_t *texels;
    noh_nodes_header *nodes_header;
    noh_node *nodes;
    float *node_weights;
    noh_clip_header *clip;
} forged;

static void *chunk_of(const forged *f, const noh_pack_chunk *c)
{
    return f->bytes + c->offset;
}

static void name_mesh(forged *f)
{
    uint8_t *base = chunk_of(f, f->mesh_at);
    f->mesh = (noh_mesh_header *)(void *)base;
    f->positions = (float *)(void *)(base + f->mesh->positions_offset);
    f->indices = (uint16_t *)(void *)(base + f->mesh->indices_offset);
    f->submeshes = (noh_submesh *)(void *)(base + f->mesh->submeshes_offset);
    f->targets = (noh_target *)(void *)(base + f->mesh->targets_offset);
    f->weights = (float *)(void *)(base + f->mesh->weights_offset);
    f->rects = (noh_rect *)(void *)(base + f->mesh->rects_offset);
    f->texels = (uint32_t *)(void *)(base + f->mesh->texels_offset);
}

static void name_scene(forged *f)
{
    uint8_t *nodes = chunk_of(f, f->nodes_at);
    f->texture = chunk_of(f, f->texture_at);
    f->materials = chunk_of(f, f->materials_at);
    f->nodes_header = (noh_nodes_header *)(void *)nodes;
    f->nodes = (noh_node *)(void *)(nodes + f->nodes_header->nodes_offset);
    f->node_weights = (float *)(void *)(nodes + f->nodes_header->weights_offset);
    f->clip = chunk_of(f, f->clip_at);
}

static void forge(forged *f)
{
    f->bytes = test_aligned(good, good_count);
    f->count = good_count;
    f->header = (noh_pack_header *)(void *)f->bytes;
    f->chunks = (noh_pack_chunk *)(void *)(f->bytes + sizeof *f->header);
    f->strings_at = f->chunks;
    f->texture_at = f->chunks + 1;
    f->materials_at = f->chunks + 2;
    f->mesh_at = f->chunks + 3;
    f->nodes_at = f->chunks + 4;
    f->clip_at = f->chunks + 5;
    f->strings = chunk_of(f, f->strings_at);
    name_mesh(f);
    name_scene(f);
}

static void swap_chunks(forged *f, int a, int b)
{
    noh_pack_chunk c = f->chunks[a];
    f->chunks[a] = f->chunks[b];
    f->chunks[b] = c;
}

/* The last touched vertex is moved by some target; now its texel belongs to no vertex. */
static void lose_last_touched(forged *f)
{
    f->mesh->touched_count -= 1;
}

/* A run of letters over all strings, so that every name differs. */
static void fill_strings(forged *f)
{
    memset(f->strings + 1, 'a', f->strings_at->bytes - 2);
}

static float nan_value(void)
{
    return (float)NAN;
}

#define INFINITE ((float)INFINITY)

/* name, expected result, a word of the message, the lie */
#define FORGERIES(X)                                                                                                 \
    X(magic, DATA, "NOHP", f->header->magic ^= 1u)                                                                   \
    X(version_newer, VERSION, "version", f->header->version += 1)                                                    \
    X(version_zero, VERSION, "version", f->header->version = 0)                                                      \
    X(byte_count_larger, DATA, "length", f->header->byte_count += 64)                                                \
    X(byte_count_smaller, DATA, "length", f->header->byte_count -= 64)                                               \
    X(no_chunks, LIMIT, "no chunks", f->header->chunk_count = 0)                                                     \
    X(chunk_count_overflows, LIMIT, "limit", f->header->chunk_count = 0xffffffffu)                                   \
    X(chunk_count_past_end, DATA, "past the end", f->header->chunk_count = NOH_PACK_CHUNKS_MAX)                      \
    X(header_reserved, DATA, "reserved", f->header->reserved[9] = 1)                                                 \
    X(chunk_type_unknown, DATA, "unknown type", f->mesh_at->type ^= 0x20u)                                           \
    X(chunk_reserved, DATA, "reserved field of a chunk", f->mesh_at->reserved[1] = 1)                                \
    X(chunks_out_of_order, DATA, "out of order", f->clip_at[1].type = NOH_TAG_TEXTURE)                               \
    X(chunks_swapped, DATA, "begin", swap_chunks(f, 3, 4))                                                           \
    X(chunk_before_strings, DATA, "out of order", swap_chunks(f, 0, 1))                                              \
    X(strings_twice, DATA, "out of order", f->texture_at->type = NOH_TAG_STRINGS)                                    \
    X(materials_twice, DATA, "out of order", f->mesh_at->type = NOH_TAG_MATERIALS)                                   \
    X(nodes_twice, DATA, "out of order", f->clip_at->type = NOH_TAG_NODES)                                           \
    X(chunk_offset_past_end, DATA, "begin", f->mesh_at->offset = (uint32_t)f->count)                                 \
    X(chunk_offset_far_past_end, DATA, "begin", f->mesh_at->offset = 0xffffffc0u)                                    \
    X(chunk_offset_inside_the_one_before, DATA, "begin", f->mesh_at->offset -= 64)                                   \
    X(chunk_offset_misaligned, DATA, "begin", f->mesh_at->offset += 16)                                              \
    X(chunk_offset_in_header, DATA, "begin", f->strings_at->offset = 0)                                              \
    X(chunk_bytes_overflow, DATA, "past the end", f->mesh_at->bytes = 0xffffffffu)                                   \
    X(chunk_bytes_past_end, DATA, "past the end", f->chunks[f->header->chunk_count - 1].bytes += 65)                 \
    X(chunk_bytes_one_short, DATA, "", f->mesh_at->bytes -= 1)                                                       \
    X(chunk_bytes_zero, DATA, "", f->mesh_at->bytes = 0)                                                             \
    X(chunks_overlap, DATA, "", f->texture_at->bytes += 64)                                                          \
    X(chunk_name_outside, DATA, "outside the strings", f->mesh_at->name = f->strings_at->bytes)                      \
    X(chunk_name_far_outside, DATA, "outside the strings", f->mesh_at->name = 0xffffffffu)                           \
    X(chunk_name_hash, DATA, "hash", f->mesh_at->name_hash ^= 1u)                                                    \
    X(strings_not_ended, DATA, "zero", f->strings[f->strings_at->bytes - 1] = 'x')                                   \
    X(strings_first_not_empty, DATA, "zero", f->strings[0] = 'x')                                                    \
    X(strings_run_together, DATA, "", fill_strings(f))                                                               \
    X(texture_wide, DATA, "size", f->texture->width = 0xffffffffu)                                                   \
    X(texture_no_rows, DATA, "size", f->texture->height = 0)                                                         \
    X(texture_larger_than_chunk, DATA, "past the end", (f->texture->height = 2048, f->texture->level_count = 12))    \
    X(texture_smaller_than_chunk, DATA, "longer", f->texture->height = 1)                                            \
    X(texture_pixels_elsewhere, DATA, "begin", f->texture->pixels_offset = 0)                                        \
    X(texture_wrap, DATA, "sampling", f->texture->wrap_s = 3)                                                        \
    X(texture_filter, DATA, "sampling", f->texture->nearest = 2)                                                     \
    X(texture_levels, DATA, "mip levels", f->texture->level_count -= 1)                                              \
    X(texture_levels_overflow, DATA, "mip levels", f->texture->level_count = 0xffffffffu)                            \
    X(texture_levels_of_nearest, DATA, "mip levels", f->texture->nearest = 1)                                        \
    X(texture_flags, DATA, "sampling", f->texture->flags = 2)                                                        \
    X(texture_trim_alone, DATA, "trimmed", f->texture->trim = 1)                                                     \
    X(texture_whole_alone, DATA, "trimmed", f->texture->whole_height = 4)                                            \
    X(texture_whole_smaller, DATA, "trimmed",                                                                        \
      (f->texture->trim = 9, f->texture->whole_width = 2048,                                                         \
       f->texture->whole_height = (uint16_t)(f->texture->height - 1u)))                                              \
    X(texture_whole_too_large, DATA, "trimmed",                                                                      \
      (f->texture->trim = 9, f->texture->whole_width = 2048, f->texture->whole_height = 2049))                       \
    X(texture_format, DATA, "unknown texture format", f->texture->format = NOH_TEXTURE_ASTC_8X8 + 1)                 \
    X(texture_format_colors, DATA, "not one for such a texture", f->texture->format = NOH_TEXTURE_EAC_RG)            \
    X(texture_blocks_smaller, DATA, "", f->texture->format = NOH_TEXTURE_ETC2_RGBA)                                  \
    X(texture_astc_blocks_smaller, DATA, "", f->texture->format = NOH_TEXTURE_ASTC_8X8)                              \
    X(texture_error, DATA, "texture's error", f->texture->error = -1.0f)                                             \
    X(texture_error_nan, DATA, "texture's error", f->texture->error = nan_value())                                   \
    X(texture_of_data, DATA, "data texture for colours", f->texture->flags = NOH_TEXTURE_LINEAR)                     \
    X(material_normal_missing, DATA, "texture", f->materials[0].normal_texture = 1)                                  \
    X(material_normal_colors, DATA, "colour texture for data", f->materials[0].normal_texture = 0)                   \
    X(material_weights_missing, DATA, "texture", f->materials[0].more_textures[2] = 1)                               \
    X(material_surface, DATA, "unknown surface", f->materials[0].surface = NOH_SURFACE_HAIR + 1)                     \
    X(material_f0_nan, DATA, "not finite", f->materials[0].f0[2] = nan_value())                                      \
    X(material_values_nan, DATA, "not finite", f->materials[1].surface_values[3] = nan_value())                      \
    X(material_more_nan, DATA, "not finite", f->materials[1].surface_more[5] = nan_value())                          \
    X(material_skin, DATA, "less than 0 millimetres",                                                                \
      (f->materials[0].surface = NOH_SURFACE_SKIN, f->materials[0].surface_values[0] = -1.0f))                       \
    X(material_skin_gap, DATA, "gap of lips",                                                                        \
      (f->materials[0].surface = NOH_SURFACE_SKIN, f->materials[0].surface_more[3] = -0.1f))                         \
    X(material_teeth_gap, DATA, "gap of lips",                                                                       \
      (f->materials[0].surface = NOH_SURFACE_TEETH, f->materials[0].surface_more[3] = -1e-40f))                      \
    X(material_toon, DATA, "hardness of a toon",                                                                     \
      (f->materials[0].surface = NOH_SURFACE_TOON, f->materials[0].surface_more[0] = 1.5f))                          \
    X(material_toon_color, DATA, "toon's rim or outline",                                                            \
      (f->materials[0].surface = NOH_SURFACE_TOON, f->materials[0].surface_more[5] = 16777216.0f))                   \
    X(material_toon_rim, DATA, "power of a toon's rim",                                                              \
      (f->materials[0].surface = NOH_SURFACE_TOON, f->materials[0].surface_more[2] = -1.0f))                         \
    X(material_toon_flags, DATA, "flags of a toon", f->materials[0].flags |= NOH_MATERIAL_TOON_MASKS)                \
    X(material_toon_matcap, DATA, "colour texture for data", f->materials[0].more_textures[NOH_TOON_MATCAP] = 0)     \
    X(material_texture_missing, DATA, "texture", f->materials[0].base_color_texture = 1)                             \
    X(material_flags, DATA, "flags", f->materials[0].flags = 32)                                                     \
    X(material_wrinkles, DATA, "unknown models of wrinkles", f->materials[0].wrinkle_models = 1)                     \
    X(material_flags_unknown, DATA, "flags", f->materials[0].flags |= 2048)                                          \
    X(material_specular_missing, DATA, "specular map", f->materials[0].flags |= 192)                                 \
    X(material_f90, DATA, "grazing angles", f->materials[0].f90_loss = 1.5f)                                         \
    X(material_specular_unused, DATA, "specular map", f->materials[0].specular_texture = 1)                          \
    X(material_color_nan, DATA, "not finite", f->materials[0].base_color[2] = nan_value())                           \
    X(material_cutoff_infinite, DATA, "not finite", f->materials[1].alpha_cutoff = INFINITE)                         \
    X(material_name, DATA, "outside the strings", f->materials[0].name = 0x10000000u)                                \
    X(no_vertices, DATA, "vertex count", f->mesh->vertex_count = 0)                                                  \
    X(vertex_count_overflows, DATA, "vertex count", f->mesh->vertex_count = 0xffffffffu)                             \
    X(vertex_count_one_more, DATA, "", f->mesh->vertex_count += 1)                                                   \
    X(index_count_overflows, DATA, "index count", f->mesh->index_count = 0xffffffffu)                                \
    X(index_count_not_triangles, DATA, "three", f->mesh->index_count -= 1)                                           \
    X(index_width, DATA, "2 nor 4", f->mesh->index_bytes = 3)                                                        \
    X(index_width_lies, DATA, "", f->mesh->index_bytes = 4)                                                          \
    X(submesh_count_overflows, DATA, "submesh count", f->mesh->submesh_count = 0xffffffffu)                          \
    X(submesh_count_zero, DATA, "submesh count", f->mesh->submesh_count = 0)                                         \
    X(target_count_overflows, DATA, "limit", f->mesh->target_count = 0xffffffffu)                                    \
    X(target_count_one_less, DATA, "", f->mesh->target_count -= 1)                                                   \
    X(texel_count_overflows, DATA, "limit", f->mesh->texel_count = 0xffffffffu)                                      \
    X(rect_count_overflows, DATA, "limit", f->mesh->rect_count = 0xffffffffu)                                        \
    X(pair_count_lies, DATA, "add up", f->mesh->pair_count += 1)                                                     \
    X(mesh_flags, DATA, "flags", f->mesh->flags |= 8u)                                                               \
    X(mesh_unknown, DATA, "", f->mesh->flags = 0x80000000u)                                                          \
    X(touched_more_than_vertices, DATA, "touched", f->mesh->touched_count = f->mesh->vertex_count + 1)               \
    X(touched_more_than_texels, DATA, "fit", f->mesh->morph_height = 0)                                              \
    X(rows_that_nothing_touches, DATA, "fit", f->mesh->morph_height += 1)                                            \
    X(morph_width_small, DATA, "limits", f->mesh->morph_width_log2 = 1)                                              \
    X(morph_width_large, DATA, "limits", f->mesh->morph_width_log2 = 12)                                             \
    X(morph_width_shifts_out, DATA, "limits", f->mesh->morph_width_log2 = 40)                                        \
    X(morph_height_overflows, DATA, "limits", f->mesh->morph_height = 0xffffffffu)                                   \
    X(attribute_stride, DATA, "stride", f->mesh->attribute_stride = 12)                                              \
    X(positions_offset, DATA, "begin", f->mesh->positions_offset += 16)                                              \
    X(arrays_overlap, DATA, "begin", f->mesh->texels_offset = f->mesh->rects_offset)                                 \
    X(array_past_end, DATA, "begin", f->mesh->indices_offset = 0xfffffff0u)                                          \
    X(bounds_nan, DATA, "not finite", f->mesh->bounds_min[1] = nan_value())                                          \
    X(bounds_infinite, DATA, "not finite", f->mesh->bounds_max[2] = -INFINITE)                                       \
    X(uv_scale_infinite, DATA, "not finite", f->mesh->uv_scale[1] = INFINITE)                                        \
    X(f16_bound_nan, DATA, "not finite", f->mesh->f16_direction_bound = nan_value())                                 \
    X(world_scale_infinite, DATA, "not finite", f->mesh->world_scale = INFINITE)                                     \
    X(position_nan, DATA, "position is not finite", f->positions[3] = nan_value())                                   \
    X(position_infinite, DATA, "position is not finite", f->positions[47] = INFINITE)                                \
    X(position_beyond, DATA, "larger than 10^12", f->positions[47] = -1.001f * NOH_NUMBER_MAX)                       \
    X(bounds_beyond, DATA, "larger than 10^12", f->mesh->bounds_max[2] = 3e38f)                                      \
    X(index_past_vertices, DATA, "past the last vertex", f->indices[5] = (uint16_t)f->mesh->vertex_count)            \
    X(padding_behind_indices, DATA, "padding", f->indices[f->mesh->index_count] = 1)                                 \
    X(submesh_past_indices, DATA, "outside the mesh", f->submeshes[1].first_index += 3)                              \
    X(submesh_overflows, DATA, "outside the mesh", f->submeshes[1].first_index = 0xfffffffdu)                        \
    X(submesh_not_triangles, DATA, "outside the mesh", f->submeshes[0].index_count -= 1)                             \
    X(submesh_past_vertices, DATA, "vertices lie outside", f->submeshes[0].vertex_count = f->mesh->vertex_count + 1) \
    X(submesh_vertices_overflow, DATA, "vertices lie outside", f->submeshes[0].first_vertex = 0xffffffffu)           \
    X(submesh_material, DATA, "material", f->submeshes[0].material = 2)                                              \
    X(target_name, DATA, "outside the strings", f->targets[0].name = f->strings_at->bytes)                           \
    X(target_name_hash, DATA, "hash", f->targets[1].name_hash ^= 0x80000000u)                                        \
    X(target_name_inside_another, DATA, "hash", f->targets[0].name += 1)                                             \
    X(target_first_rect, DATA, "outside the mesh", f->targets[1].first_rect += 1)                                    \
    X(target_first_texel, DATA, "outside the mesh", f->targets[1].first_texel = 0xffffffffu)                         \
    X(target_rect_count, DATA, "outside the mesh", f->targets[0].rect_count = 0xffffffffu)                           \
    X(target_texel_count, DATA, "outside the mesh", f->targets[0].texel_count = 0xffffffffu)                         \
    X(target_texel_count_one_more, DATA, "", f->targets[0].texel_count += 1)                                         \
    X(target_pair_count, DATA, "pair count is wrong", f->targets[0].pair_count += 1)                                 \
    X(target_bits_zero, DATA, "bit widths", f->targets[0].normal_bits = 0)                                           \
    X(target_bits_too_many, DATA, "bit widths", f->targets[0].position_bits = 24)                                    \
    X(target_bits_wrap, DATA, "bit widths", f->targets[0].tangent_bits = 255)                                        \
    X(target_reserved, DATA, "reserved field of a target", f->targets[0].reserved1 = 1)                              \
    X(target_scale_nan, DATA, "not finite", f->targets[0].position_scale = nan_value())                              \
    X(target_scale_infinite, DATA, "not finite", f->targets[2].tangent_scale = INFINITE)                             \
    X(target_scale_negative, DATA, "negative", f->targets[1].normal_scale = -1.0f)                                   \
    X(target_error_nan, DATA, "not finite", f->targets[1].position_error = nan_value())                              \
    X(target_displacement_infinite, DATA, "not finite", f->targets[1].radius = INFINITE)                             \
    X(default_weight_nan, DATA, "weight is not finite", f->weights[0] = nan_value())                                 \
    X(rect_x_outside, DATA, "outside the accumulation", f->rects[0].x = 0xffffu)                                     \
    X(rect_y_outside, DATA, "outside the accumulation", f->rects[0].y = (uint16_t)f->mesh->morph_height)             \
    X(rect_empty, DATA, "", f->rects[0].w = 0)                                                                       \
    X(rect_larger_than_target, DATA, "more texels", f->rects[0].w = f->rects[0].h = 0xffffu)                         \
    X(delta_on_no_vertex, DATA, "no vertex", lose_last_touched(f))                                                   \
    X(texel_zeroed, DATA, "pair count is wrong", memset(f->texels, 0, 12))                                           \
    X(node_count_overflows, DATA, "node count", f->nodes_header->node_count = 0xffffffffu)                           \
    X(node_count_one_more, DATA, "", f->nodes_header->node_count += 1)                                               \
    X(node_weight_count_overflows, DATA, "past the end", f->nodes_header->weight_count = 0xffffffffu)                \
    X(node_parent_is_itself, DATA, "parent", f->nodes[1].parent = 1)                                                 \
    X(node_parent_after_child, DATA, "parent", f->nodes[0].parent = 1)                                               \
    X(node_parent_missing, DATA, "parent", f->nodes[1].parent = 0xfffffffeu)                                         \
    X(node_mesh_missing, DATA, "missing mesh", f->nodes[1].mesh = 1)                                                 \
    X(node_transform_nan, DATA, "not finite", f->nodes[1].rotation[0] = nan_value())                                 \
    X(node_world_infinite, DATA, "not finite", f->nodes[0].world[11] = INFINITE)                                     \
    X(node_world_beyond, DATA, "larger than 10^12", f->nodes[0].world[11] = 3e38f)                                   \
    X(node_weights_outside, DATA, "outside the weights", f->nodes[1].first_weight = 1)                               \
    X(node_weights_far_outside, DATA, "outside the weights", f->nodes[1].first_weight = 0xfffffffeu)                 \
    X(node_weights_without_mesh, DATA, "outside the weights", f->nodes[0].first_weight = 0)                          \
    X(node_flags, DATA, "flags", f->nodes[0].flags = 1)                                                              \
    X(node_name, DATA, "outside the strings", f->nodes[0].name = 0xffffffffu)                                        \
    X(node_weight_nan, DATA, "weight is not finite", f->node_weights[0] = nan_value())                               \
    X(clip_joints_without_skeleton, DATA, "missing skeleton", f->clip->joint_count = 1)                              \
    X(clip_skeleton_without_joints, DATA, "names a skeleton", f->clip->skeleton = 0)                                 \
    X(clip_hash_without_joints, DATA, "names a skeleton", f->clip->skeleton_hash = 1)                                \
    X(clip_joint_errors_without_joints, DATA, "joint errors", f->clip->joint_error_count = 1)                        \
    X(clip_joint_errors_elsewhere, DATA, "begin", f->clip->joint_errors_offset += 16)                                \
    X(clip_update_rate_error_at_full_rate, DATA, "update rate errors", f->clip->update_rate_error[0] = 1.0f)         \
    X(clip_update_rate_error_nan, DATA, "update rate errors", f->clip->update_rate_error[3] = nan_value())           \
    X(clip_update_rate_error_falls, DATA, "update rate errors",                                                      \
      f->clip->update_rate_error[1] = f->clip->update_rate_error[2] + 1.0f)                                          \
    X(clip_shell_negative, DATA, "shell", f->clip->error_shell = -1.0f)                                              \
    X(clip_shell_infinite, DATA, "shell", f->clip->error_shell = INFINITE)                                           \
    X(clip_root_end_nan, DATA, "root joint's first or last", f->clip->root_ends[1][6] = nan_value())                 \
    X(clip_clip_one_more, DATA, "", f->clip->clip_bytes += 1)                                                        \
    X(clip_clip_elsewhere, DATA, "begin", f->clip->clip_offset += 16)

typedef struct forgery {
    void (*lie)(forged *f);
    noh_result result;
    const char *word;
} forgery;

#define X(name, code, word, statement) \
    static void lie_##name(forged *f)  \
    {                                  \
        statement;                     \
    }
FORGERIES(X)
#undef X

static void forged_pack_is_refused(void **state)
{
    const forgery *expected = *state;
    noh_error error = { NOH_OK, "nothing", 0, 0 };
    noh_pack pack;
    noh_result result;
    forged f;
    forge(&f);
    expected->lie(&f);
    pack_repair(f.bytes, f.count);
    result = noh_pack_open(f.bytes, f.count, &pack, &error);
    free(f.bytes);
    if (result != expected->result || !strstr(error.what, expected->word)) {
        fail_msg("result %d (%s), expected %d (...%s...)", (int)result, error.what, (int)expected->result,
                 expected->word);
    }
    assert_true(error.where <= f.count);
    if (result == NOH_ERR_VERSION) {
        assert_int_equal(error.need, NOH_PACK_VERSION);
    }
}

/* The control: the same steps without a lie. */
static void an_honest_copy_opens(void **state)
{
    forged f;
    (void)state;
    forge(&f);
    pack_repair(f.bytes, f.count);
    assert_memory_equal(f.bytes, good, good_count);
    test_open(f.bytes, f.count);
    free(f.bytes);
}

/* Else padding_behind_indices would change a submesh. */
static void there_is_padding_behind_the_indices(void **state)
{
    forged f;
    (void)state;
    forge(&f);
    assert_true(f.mesh->indices_offset + 2 * f.mesh->index_count < f.mesh->submeshes_offset);
    free(f.bytes);
}

/* The byte that the error names, for lies in a single field. */
static void errors_say_where(void **state)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_pack pack;
    forged f;
    (void)state;
    forge(&f);
    f.positions[7] = nan_value();
    pack_repair(f.bytes, f.count);
    assert_int_equal(noh_pack_open(f.bytes, f.count, &pack, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, (uint8_t *)(f.positions + 7) - f.bytes);
    free(f.bytes);
    forge(&f);
    f.indices[8] = 0xffff;
    pack_repair(f.bytes, f.count);
    assert_int_equal(noh_pack_open(f.bytes, f.count, &pack, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, (uint8_t *)(f.indices + 8) - f.bytes);
    free(f.bytes);
    forge(&f);
    f.bytes[f.mesh_at->offset + 200] ^= 1u; /* not repaired */
    assert_int_equal(noh_pack_open(f.bytes, f.count, &pack, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, "checksum"));
    assert_int_equal(error.where, f.mesh_at->offset);
    free(f.bytes);
}

/* The error names the byte of the field that is wrong. */
#define PLACES(X)                                       \
    X(mesh_at->reserved[1], = 1)                        \
    X(mesh_at->offset, += 64)                           \
    X(mesh_at->bytes, = 0xffffffffu)                    \
    X(mesh_at->name, = 0xffffffffu)                     \
    X(mesh_at->name_hash, ^= 1u)                        \
    X(header->version, += 1)                            \
    X(header->byte_count, += 64)                        \
    X(header->chunk_count, = 0)                         \
    X(header->reserved[9], = 1)                         \
    X(texture->width, = 0)                              \
    X(texture->height, = 0)                             \
    X(texture->wrap_s, = 9)                             \
    X(texture->wrap_t, = 9)                             \
    X(texture->nearest, = 2)                            \
    X(texture->level_count, = 1)                        \
    X(texture->flags, = 8)                              \
    X(texture->whole_width, = 1)                        \
    X(texture->pixels_offset, += 16)                    \
    X(materials[1].base_color_texture, = 7)             \
    X(materials[0].flags, = 32)                         \
    X(materials[1].normal_texture, = 0)                 \
    X(materials[1].surface, = 9)                        \
    X(materials[1].f90_loss, = -0.5f)                   \
    X(materials[1].name, = 0xffffffffu)                 \
    X(materials[0].name_hash, ^= 1u)                    \
    X(mesh->flags, = 0x80000000u)                       \
    X(mesh->vertex_count, = 0)                          \
    X(mesh->index_count, -= 1)                          \
    X(mesh->index_bytes, = 3)                           \
    X(mesh->submesh_count, = 0)                         \
    X(mesh->target_count, = NOH_TARGETS_MAX + 1u)       \
    X(mesh->rect_count, = f.mesh->texel_count + 1u)     \
    X(mesh->texel_count, = NOH_DELTA_TEXELS_MAX + 1u)   \
    X(mesh->touched_count, = f.mesh->vertex_count + 1u) \
    X(mesh->morph_width_log2, = 1)                      \
    X(mesh->morph_height, += 1)                         \
    X(mesh->attribute_stride, += 4)                     \
    X(mesh->skin, = 0)                                  \
    X(mesh->level, = 1)                                 \
    X(mesh->level_count, = NOH_LOD_LEVELS_MAX + 1u)     \
    X(mesh->level_error_rest, = 1.0f)                   \
    X(mesh->level_skipped, = 1.0f)                      \
    X(mesh->influence_errors[1], = -1.0f)               \
    X(mesh->reserved[0], = 1)                           \
    X(mesh->reserved[3], = 1)                           \
    X(mesh->uv_per_unit, = 1.0f)                        \
    X(mesh->level_first, = 1)                           \
    X(mesh->source_crc, = 1)                            \
    X(mesh->influence_count, = 4)                       \
    X(mesh->palette_count, = 1)                         \
    X(mesh->palette_joint_count, = 1)                   \
    X(mesh->positions_offset, += 16)                    \
    X(mesh->attributes_offset, -= 16)                   \
    X(mesh->indices_offset, += 2)                       \
    X(mesh->submeshes_offset, = 0)                      \
    X(mesh->targets_offset, += 64)                      \
    X(mesh->weights_offset, += 16)                      \
    X(mesh->rects_offset, += 8)                         \
    X(mesh->texels_offset, += 12)                       \
    X(mesh->target_boxes_offset, += 16)                 \
    X(mesh->influences_offset, += 16)                   \
    X(mesh->palettes_offset, += 16)                     \
    X(mesh->palette_joints_offset, += 16)               \
    X(mesh->joint_boxes_offset, = 0xffffffffu)          \
    X(mesh->pair_count, += 1)                           \
    X(submeshes[0].first_index, = 0xffffffffu)          \
    X(submeshes[0].index_count, += 1)                   \
    X(submeshes[0].first_vertex, = 0xffffffffu)         \
    X(submeshes[0].vertex_count, = 0xffffffffu)         \
    X(submeshes[0].material, = 77)                      \
    X(submeshes[0].palette, = 1)                        \
    X(targets[1].name, = 0xffffffffu)                   \
    X(targets[0].name_hash, ^= 1u)                      \
    X(targets[1].first_rect, += 1)                      \
    X(targets[1].rect_count, = 0xffffffffu)             \
    X(targets[1].first_texel, += 1)                     \
    X(targets[1].texel_count, = 0xffffffffu)            \
    X(targets[0].pair_count, += 1)                      \
    X(targets[1].position_bits, = 0)                    \
    X(targets[1].normal_bits, = 25)                     \
    X(targets[1].tangent_bits, = 0)                     \
    X(targets[1].flags, = 2)                            \
    X(targets[1].reserved1, = 1)                        \
    X(targets[1].position_scale, = -1.0f)               \
    X(targets[1].normal_scale, = -1.0f)                 \
    X(targets[1].tangent_scale, = nan_value())          \
    X(targets[1].radius, = -1.0f)                       \
    X(rects[0].w, = 0)                                  \
    X(rects[0].h, = 0)                                  \
    X(nodes_header->nodes_offset, += 16)                \
    X(nodes_header->weights_offset, += 16)              \
    X(nodes_header->node_count, = NOH_NODES_MAX + 1u)   \
    X(nodes[1].parent, = 1)                             \
    X(nodes[1].mesh, = 1)                               \
    X(nodes[0].first_weight, = 0)                       \
    X(nodes[0].flags, = 1)                              \
    X(nodes[1].name, = 0xffffffffu)                     \
    X(clip->skeleton, = 0)                              \
    X(clip->skeleton_hash, = 1)                         \
    X(clip->joint_error_count, = 1)                     \
    X(clip->events_offset, += 16)                       \
    X(clip->markers_offset, += 16)                      \
    X(clip->joint_errors_offset, += 16)                 \
    X(clip->clip_offset, += 16)                         \
    X(clip->event_count, = NOH_CLIP_EVENTS_MAX + 1u)    \
    X(clip->marker_count, = NOH_CLIP_MARKERS_MAX + 1u)  \
    X(clip->update_rate_error[0], = 1.0f)               \
    X(clip->error_shell, = -1.0f)                       \
    X(clip->root_ends[0][4], = INFINITE)

static void an_error_is_at_its_field(void **state)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_pack pack;
    size_t at;
    forged f;
    (void)state;
#define X(field, lie)                                                                               \
    forge(&f);                                                                                      \
    at = (size_t)((const uint8_t *)&f.field - f.bytes);                                             \
    f.field lie;                                                                                    \
    pack_repair(f.bytes, f.count);                                                                  \
    assert_int_not_equal(noh_pack_open(f.bytes, f.count, &pack, &error), NOH_OK);                   \
    if (error.where != at) {                                                                        \
        fail_msg("%s: byte %lu, not %zu (%s)", #field, (unsigned long)error.where, at, error.what); \
    }                                                                                               \
    free(f.bytes);
    PLACES(X)
#undef X
}

static void padding_has_to_be_zero(void **state)
{
    forged f;
    noh_pack pack;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    uint32_t end;
    (void)state;
    forge(&f);
    end = f.strings_at->offset + f.strings_at->bytes;
    assert_true(end % NOH_PACK_ALIGN != 0); /* otherwise this tests nothing: rename a target */
    f.bytes[end] = 1;
    assert_int_equal(noh_pack_open(f.bytes, f.count, &pack, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, "padding"));
    assert_int_equal(error.where, end);
    free(f.bytes);
}

static void bytes_after_the_last_chunk_are_refused(void **state)
{
    uint8_t *longer = test_aligned(NULL, good_count + 64);
    noh_pack pack;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    (void)state;
    memcpy(longer, good, good_count);
    memset(longer + good_count, 0, 64);
    ((noh_pack_header *)(void *)longer)->byte_count += 64;
    pack_repair(longer, good_count + 64);
    assert_int_equal(noh_pack_open(longer, good_count + 64, &pack, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, "end with its last chunk"));
    free(longer);
}

#define X(name, code, word, statement) { lie_##name, NOH_ERR_##code, word },
static const forgery forgeries[] = { FORGERIES(X) };
#undef X

enum {
#define X(name, code, word, statement) forgery_##name,
    FORGERIES(X)
#undef X
};

static const struct CMUnitTest tests[] = { cmocka_unit_test(opens_and_walks),
                                           cmocka_unit_test(past_the_last_is_not_found),
                                           cmocka_unit_test(the_header_has_the_version_of_its_writer),
                                           cmocka_unit_test(the_smallest_mesh_opens),
                                           cmocka_unit_test(misaligned_memory_is_an_argument_error),
                                           cmocka_unit_test(null_is_an_argument_error),
                                           cmocka_unit_test(a_failed_open_leaves_the_pack_alone),
                                           cmocka_unit_test(every_truncation_is_an_error),
                                           cmocka_unit_test(every_truncation_is_an_error_even_if_the_header_agrees),
                                           cmocka_unit_test(every_single_bit_flip_is_an_error),
                                           cmocka_unit_test(every_flip_with_repaired_checksums_is_safe),
                                           cmocka_unit_test(random_damage_with_repaired_checksums_is_safe),
                                           cmocka_unit_test(an_honest_copy_opens),
                                           cmocka_unit_test(there_is_padding_behind_the_indices),
                                           cmocka_unit_test(errors_say_where),
                                           cmocka_unit_test(an_error_is_at_its_field),
                                           cmocka_unit_test(padding_has_to_be_zero),
                                           cmocka_unit_test(bytes_after_the_last_chunk_are_refused),
#define X(name, code, word, statement) \
    { "forged_" #name, forged_pack_is_refused, NULL, NULL, (void *)(uintptr_t)&forgeries[forgery_##name] },
                                           FORGERIES(X)
#undef X
};

TEST_MAIN(tests, set_up, tear_down)
