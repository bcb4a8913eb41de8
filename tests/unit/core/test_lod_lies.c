/* LOD levels that a reader refuses: lies in their headers, targets, indices and texel references, with repaired
 * checksums; every cut and every flipped bit. */
#include "support/lod_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/pack_walk.h"

/* ---- two small packs ---- */

typedef struct small_pack {
    uint8_t *bytes;
    size_t count;
} small_pack;

static small_pack rigid, split; /* texel references in both; the second is skinned, in two palettes */

static small_pack keep(model *m, uint32_t palette)
{
    const lod_settings three = { 3, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    small_pack kept;
    lod_pack p;
    lod_pack_make(m, &three, palette, &p);
    assert_int_equal(p.mesh.header->level_count, 3);
    assert_true(p.mesh.header->flags & NOH_MESH_TEXELS);
    kept.count = p.byte_count;
    kept.bytes = test_aligned(p.bytes, p.byte_count);
    lod_pack_free(&p);
    model_free(m);
    return kept;
}

static int set_up(void **state)
{
    const lod_face face = { 12, 10, 2, 0, 0 };
    const skin_cylinder tube = { 4, 12, 8, 2, 2, 0, 2.0f, 0.5f };
    (void)state;
    rigid = keep(lod_face_model(&face), 0);
    split = keep(lod_tube_model(&tube), 6);
    print_message("# packs of %zu and %zu bytes\n", rigid.count, split.count);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(rigid.bytes);
    free(split.bytes);
    return 0;
}

/* ---- lies ---- */

/* What a lie may reach for: of the full mesh (0) and of its two coarser levels. */
typedef struct forged {
    noh_mesh_header *h; /* [3] */
    uint16_t *indices[3];
    noh_submesh *submeshes[3];
    noh_target *targets[3];
    noh_rect *rects;
    uint32_t *texels;
    uint8_t *chunk;
} forged;

static forged reach(uint8_t *bytes)
{
    const noh_pack_header *h = (const noh_pack_header *)(const void *)bytes;
    const noh_pack_chunk *chunks = (const noh_pack_chunk *)(const void *)(bytes + sizeof *h);
    forged f = { NULL };
    while (chunks->type != NOH_TAG_MESH) {
        chunks++;
    }
    f.chunk = bytes + chunks->offset;
    f.h = (noh_mesh_header *)(void *)f.chunk;
    f.rects = (noh_rect *)(void *)(f.chunk + f.h->rects_offset);
    f.texels = (uint32_t *)(void *)(f.chunk + f.h->texels_offset);
    for (uint32_t k = 0; k < 3u; k++) {
        f.indices[k] = (uint16_t *)(void *)(f.chunk + f.h[k].indices_offset);
        f.submeshes[k] = (noh_submesh *)(void *)(f.chunk + f.h[k].submeshes_offset);
        f.targets[k] = (noh_target *)(void *)(f.chunk + f.h[k].targets_offset);
    }
    return f;
}

static uint32_t *reference(const forged *f, uint32_t vertex)
{
    return (uint32_t *)(void *)(f->chunk + f->h->attributes_offset + (vertex + 1u) * f->h->attribute_stride - 4u);
}

/* The first vertex of a level's own (k) that has a texel (wanted 1) or has none (0). */
static uint32_t own_vertex(const forged *f, uint32_t k, int wanted)
{
    uint32_t v = k < 2u ? f->h[k + 1u].vertex_count : 0u;
    while ((int)((*reference(f, v) & NOH_TEXEL_NONE) != NOH_TEXEL_NONE) != wanted) {
        v++;
    }
    assert_true(v < f->h[k].vertex_count);
    return v;
}

/* The first target with fewer rectangles in level k than in the finer one, and some. */
static uint32_t cut_target(const forged *f, uint32_t k)
{
    uint32_t t = 0;
    while (!f->targets[k][t].rect_count || f->targets[k][t].rect_count == f->targets[k - 1u][t].rect_count) {
        t++;
    }
    assert_true(t < f->h->target_count);
    return t;
}

/* A field of all headers at once, so that they still agree. */
#define IN_ALL(statement)                   \
    do {                                    \
        for (uint32_t k = 0; k < 3u; k++) { \
            statement;                      \
        }                                   \
    } while (0)

/* Level 1 gets the finer level's rectangle after its own. */
static void take_a_rectangle(forged *f)
{
    noh_target *t = &f->targets[1][cut_target(f, 1)];
    const noh_rect *r = &f->rects[t->first_rect + t->rect_count];
    const uint32_t area = (uint32_t)r->w * r->h, *texel = f->texels + 3u * (t->first_texel + t->texel_count);
    uint32_t pairs = 0;
    for (uint32_t i = 0; i < area; i++) {
        pairs += (texel[3u * i] | texel[3u * i + 1u] | texel[3u * i + 2u]) != 0u;
    }
    t->rect_count += 1;
    t->texel_count += area;
    t->pair_count += pairs;
    f->h[1].rect_count += 1;
    f->h[1].texel_count += area;
    f->h[1].pair_count += pairs;
}

/* Level 1 gives a row of its texture back. */
static void lose_a_row(forged *f)
{
    f->h[1].touched_count -= 1u << f->h->morph_width_log2;
    f->h[1].morph_height -= 1;
}

static void lose_a_vertex(forged *f)
{
    uint32_t largest = 0;
    for (uint32_t i = 0; i < f->h[1].index_count; i++) {
        largest = f->indices[1][i] > largest ? f->indices[1][i] : largest;
    }
    f->h[1].vertex_count = largest;
}

/* Level 1's target, and the sum, tell of more than the finer level has. */
static void have_more_rectangles(forged *f)
{
    f->targets[2][0].rect_count = f->targets[1][0].rect_count + 1u;
}

/* name, the lie, a part of the message; in the rigid mesh */
#define LIES(X)                                                                                                      \
    X(no_levels, f->h->level_count = 0, "no level or too many")                                                      \
    X(nine_levels, f->h->level_count = 9, "no level or too many")                                                    \
    X(begins_with_a_coarse_one, f->h->level = 1, "begin with the finest")                                            \
    X(full_mesh_has_an_error, f->h->level_error_rest = 1e-6f, "full mesh has the error")                             \
    X(full_mesh_has_an_error_that_is_none, f->h->level_error_clip = NAN, "full mesh has the error")                  \
    X(full_mesh_skips, f->h->level_skipped = 1.0f, "full mesh has the error")                                        \
    X(one_level_more, f->h->level_count = 4, "differs from the coarser LOD levels")                                  \
    X(one_level_less, f->h->level_count = 2, "differs in what all levels share")                                     \
    X(levels_exchanged, (f->h[1].level = 2, f->h[2].level = 1), "out of order")                                      \
    X(level_twice, f->h[2].level = 1, "out of order")                                                                \
    X(other_flags, f->h[1].flags ^= NOH_MESH_UVS, "differs in what all levels share")                                \
    X(other_index_bytes, f->h[1].index_bytes = 4, "differs in what all levels share")                                \
    X(other_target_count, f->h[2].target_count -= 1, "differs in what all levels share")                             \
    X(other_width, f->h[1].morph_width_log2 += 1, "differs in what all levels share")                                \
    X(other_stride, f->h[1].attribute_stride += 4, "differs in what all levels share")                               \
    X(other_positions, f->h[1].positions_offset += 16, "differs in what all levels share")                           \
    X(other_attributes, f->h[1].attributes_offset += 16, "differs in what all levels share")                         \
    X(other_weights, f->h[1].weights_offset += 16, "differs in what all levels share")                               \
    X(other_rects, f->h[1].rects_offset += 8, "differs in what all levels share")                                    \
    X(other_texels, f->h[2].texels_offset += 12, "differs in what all levels share")                                 \
    X(other_bounds, f->h[1].bounds_max[1] *= 0.5f, "differs in what all levels share")                               \
    X(other_uvs, f->h[1].uv_scale[0] *= 0.5f, "differs in what all levels share")                                    \
    X(other_half_bound, f->h[1].f16_position_bound *= 0.5f, "differs in what all levels share")                      \
    X(other_scale, f->h[1].world_scale *= 2.0f, "differs in what all levels share")                                  \
    X(other_source_pairs, f->h[1].source_pair_count += 1, "differs in what all levels share")                        \
    X(other_boxes, f->h[1].target_boxes_offset += 16, "differs in what all levels share")                            \
    X(other_skin, f->h[1].skin = 0, "differs in what all levels share")                                              \
    X(other_level_count, f->h[1].level_count = 2, "differs in what all levels share")                                \
    X(other_reserved, f->h[2].reserved[3] = 1, "differs in what all levels share")                                   \
    X(falling_influences, f->h[0].influence_errors[0] = 1.0f, "fewer influences")                                    \
    X(unknown_influences, f->h[0].influence_errors[2] = NAN, "fewer influences")                                     \
    X(no_vertices, f->h[2].vertex_count = 0, "higher count")                                                         \
    X(more_vertices, f->h[1].vertex_count = f->h->vertex_count + 1u, "higher count")                                 \
    X(more_indices, f->h[1].index_count = f->h->index_count + 3u, "higher count")                                    \
    X(indices_not_triangles, f->h[1].index_count -= 1, "higher count")                                               \
    X(no_submeshes, f->h[1].submesh_count = 0, "higher count")                                                       \
    X(too_many_submeshes, f->h[1].submesh_count = 257, "higher count")                                               \
    X(more_touched, f->h[1].touched_count = f->h->touched_count + 1u, "higher count")                                \
    X(more_rects, f->h[1].rect_count = f->h->rect_count + 1u, "higher count")                                        \
    X(more_texels, f->h[1].texel_count = f->h->texel_count + 1u, "higher count")                                     \
    X(more_pairs, f->h[1].pair_count = f->h->pair_count + 1u, "higher count")                                        \
    X(more_than_the_finer, f->h[2].vertex_count = f->h[1].vertex_count + 1u, "higher count")                         \
    X(error_nan, f->h[1].level_error_targets = NAN, "error is not finite")                                           \
    X(error_infinite, f->h[2].level_error_pairs = INFINITY, "error is not finite")                                   \
    X(skipped_nan, f->h[2].level_skipped = NAN, "error is not finite")                                               \
    X(error_negative, f->h[1].level_error_clip = -1.0f, "below the finer")                                           \
    X(error_falls, f->h[2].level_error_rest = f->h[1].level_error_rest * 0.5f, "below the finer")                    \
    X(p99_falls, f->h[2].level_error_rest_p99 = 0.0f, "below the finer")                                             \
    X(skipped_falls, f->h[1].level_skipped = 9.0f, "below the finer")                                                \
    X(indices_elsewhere, f->h[1].indices_offset += 6, "do not follow the finer level's")                             \
    X(indices_shared, f->h[1].indices_offset = f->h->indices_offset, "do not follow the finer level's")              \
    X(submeshes_elsewhere, f->h[2].submeshes_offset -= 24, "do not follow the finer level's")                        \
    X(targets_elsewhere, f->h[2].targets_offset -= 64, "do not follow the finer level's")                            \
    X(fewer_indices, f->h[2].index_count -= 3, "")                                                                   \
    X(fewer_submeshes, IN_ALL(f->h[k].submesh_count += 1), "")                                                       \
    X(texture_too_high, f->h[1].morph_height += 1, "does not fit the touched")                                       \
    X(texture_too_low, f->h[1].morph_height = 0, "does not fit the touched")                                         \
    X(touched_without_vertices, (f->h[2].vertex_count = 1), "")                                                      \
    X(index_outside_its_level, f->indices[2][0] = (uint16_t)f->h[2].vertex_count, "past the last vertex")            \
    X(vertex_missing, lose_a_vertex(f), "past the last vertex")                                                      \
    X(submesh_outside, f->submeshes[1][0].index_count += 3, "submesh indices lie outside")                           \
    X(submesh_not_triangles, f->submeshes[2][0].index_count -= 1, "submesh indices lie outside")                     \
    X(submesh_vertices_outside, f->submeshes[2][0].vertex_count = f->h[2].vertex_count + 1u,                         \
      "submesh vertices lie outside")                                                                                \
    X(submesh_material, f->submeshes[1][0].material = 2, "missing material")                                         \
    X(submesh_palette, f->submeshes[1][0].palette = 1, "missing palette")                                            \
    X(target_other_name, f->targets[1][0].name = f->targets[0][1].name, "target differs from the full mesh's")       \
    X(target_other_bits, f->targets[2][1].position_bits -= 1, "target differs from the full mesh's")                 \
    X(target_other_scale, f->targets[1][1].position_scale *= 2.0f, "target differs from the full mesh's")            \
    X(target_other_first, f->targets[1][1].first_rect -= 1, "target differs from the full mesh's")                   \
    X(target_other_texel, f->targets[1][1].first_texel -= 1, "target differs from the full mesh's")                  \
    X(target_more_rects, have_more_rectangles(f), "more rectangles than the finer level's")                          \
    X(target_more_texels, f->targets[1][0].texel_count = f->targets[0][0].texel_count + 1u,                          \
      "more rectangles than the finer")                                                                              \
    X(target_texels_lie, f->targets[1][0].texel_count -= 1, "")                                                      \
    X(target_pairs_lie, f->targets[1][0].pair_count -= 1, "pair count is wrong")                                     \
    X(rects_do_not_add_up, f->h[2].rect_count = f->h[1].rect_count, "do not add up to the level's")                  \
    X(texels_do_not_add_up, f->h[2].texel_count += 1, "do not add up to the level's")                                \
    X(pairs_do_not_add_up, f->h[1].pair_count -= 1, "do not add up to the level's")                                  \
    X(rectangle_of_the_finer, take_a_rectangle(f), "")                                                               \
    X(a_row_less, lose_a_row(f), "")                                                                                 \
    X(texel_of_the_finer, *reference(f, own_vertex(f, 1, 1)) = f->h[1].touched_count,                                \
      "one that its level does not have")                                                                            \
    X(texel_past_all, *reference(f, own_vertex(f, 0, 1)) = f->h->touched_count, "one that its level does not have")  \
    X(almost_no_texel, *reference(f, own_vertex(f, 0, 0)) = NOH_TEXEL_NONE - 1u, "one that its level does not have") \
    X(rigid_with_a_palette, *reference(f, 0) |= 1u << NOH_TEXEL_VERTEX_BITS, "one that its level does not have")

/* The same in the split mesh, where vertices have palettes. */
#define SPLIT_LIES(X)                                                                                             \
    X(other_influences, f->h[1].influence_count = 4, "differs in what all levels share")                          \
    X(other_influence_place, f->h[1].influences_offset += 16, "differs in what all levels share")                 \
    X(other_palette_count, f->h[2].palette_count = 1, "differs in what all levels share")                         \
    X(other_palettes, f->h[1].palettes_offset += 16, "differs in what all levels share")                          \
    X(other_palette_joint_count, f->h[1].palette_joint_count -= 1, "differs in what all levels share")            \
    X(other_palette_joints, f->h[1].palette_joints_offset += 2, "differs in what all levels share")               \
    X(other_joint_boxes, f->h[1].joint_boxes_offset += 16, "differs in what all levels share")                    \
    X(submesh_of_another_palette, f->submeshes[2][0].palette ^= 1u, "vertex of another palette")                  \
    X(submesh_of_no_palette, f->submeshes[2][0].palette = 40, "missing palette")                                  \
    X(index_of_another_palette, f->indices[2][0] = f->indices[2][f->submeshes[2][1].first_index],                 \
      "vertex of another palette")                                                                                \
    X(vertex_of_no_palette, *reference(f, 0) |= 0xffc00000u, "vertex of another palette")                         \
    X(without_references, IN_ALL(f->h[k].flags &= ~NOH_MESH_TEXELS), "texel references")                          \
    X(shared_texel_of_the_finer, *reference(f, 0) = (*reference(f, 0) & ~NOH_TEXEL_NONE) | f->h[2].touched_count, \
      "one that its level does not have")

static void check_refused(const small_pack *good, void (*lie)(forged *f), const char *message)
{
    uint8_t *bytes = test_aligned(good->bytes, good->count);
    forged f = reach(bytes);
    noh_error error = { NOH_OK, "nothing", 0, 0 };
    noh_pack pack;
    noh_result result;
    lie(&f);
    pack_repair(bytes, good->count);
    result = noh_pack_open(bytes, good->count, &pack, &error);
    free(bytes);
    if (result != NOH_ERR_DATA || !strstr(error.what, message)) {
        fail_msg("result %d: %s; not %s", (int)result, error.what, message);
    }
    assert_true(error.where <= good->count);
}

#define X(name, statement, message)                 \
    static void lie_##name(forged *f)               \
    {                                               \
        statement;                                  \
    }                                               \
    static void level_##name(void **state)          \
    {                                               \
        (void)state;                                \
        check_refused(&rigid, lie_##name, message); \
    }
LIES(X)
#undef X
#define X(name, statement, message)                       \
    static void split_lie_##name(forged *f)               \
    {                                                     \
        statement;                                        \
    }                                                     \
    static void split_##name(void **state)                \
    {                                                     \
        (void)state;                                      \
        check_refused(&split, split_lie_##name, message); \
    }
SPLIT_LIES(X)
#undef X

/* Each of these fields, wrong in the header of one level alone, is named by its byte; in the full mesh's header too,
 * where only the count of texels cannot be checked against the array that it sizes. */
static void errors_name_the_field(void **state)
{
#define AT(field) offsetof(noh_mesh_header, field)
    static const size_t fields[] = { AT(flags),
                                     AT(vertex_count),
                                     AT(index_count),
                                     AT(submesh_count),
                                     AT(target_count),
                                     AT(rect_count),
                                     AT(texel_count),
                                     AT(pair_count),
                                     AT(touched_count),
                                     AT(attribute_stride),
                                     AT(positions_offset),
                                     AT(bounds_max),
                                     AT(world_scale),
                                     AT(skin),
                                     AT(joint_boxes_offset),
                                     AT(level),
                                     AT(level_count),
                                     AT(indices_offset),
                                     AT(submeshes_offset),
                                     AT(targets_offset),
                                     AT(reserved) };
#undef AT
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(fields); i++) {
        for (uint32_t k = fields[i] == offsetof(noh_mesh_header, texel_count); k < 3u; k++) {
            uint8_t *bytes = test_aligned(rigid.bytes, rigid.count);
            forged f = reach(bytes);
            const size_t at = (size_t)(f.chunk - bytes) + k * sizeof *f.h + fields[i];
            noh_error error = { NOH_OK, "nothing", 0, 0 };
            noh_pack pack;
            bytes[at + 2u] ^= 0x7f;
            pack_repair(bytes, rigid.count);
            assert_int_equal(noh_pack_open(bytes, rigid.count, &pack, &error), NOH_ERR_DATA);
            if (error.where != at) {
                fail_msg("level %u, byte %lu of its header: where is byte %ld of it (%s)", (unsigned)k,
                         (unsigned long)fields[i], (long)error.where - (long)at + (long)fields[i], error.what);
            }
            free(bytes);
        }
    }
    {
        uint8_t *bytes = test_aligned(rigid.bytes, rigid.count);
        forged f = reach(bytes);
        const size_t at = (size_t)(f.chunk - bytes) + 2u * sizeof *f.h + offsetof(noh_mesh_header, level_error_clip);
        noh_error error = { NOH_OK, "nothing", 0, 0 };
        noh_pack pack;
        f.h[1].level_error_clip = 2.0f * (f.h[2].level_error_clip = 1.0f);
        pack_repair(bytes, rigid.count);
        assert_int_equal(noh_pack_open(bytes, rigid.count, &pack, &error), NOH_ERR_DATA);
        assert_int_equal(error.where, at);
        free(bytes);
    }
}

/* A mesh whose targets move every vertex needs no references: vertex and texel have the same number. */
static void texels_without_references_are_counted(void **state)
{
    const lod_settings three = { 3, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    const lod_face face = { 12, 10, 2, 0, 1 };
    model *m = lod_face_model(&face);
    noh_error error = { NOH_OK, "nothing", 0, 0 };
    noh_pack pack;
    forged f;
    lod_pack p;
    (void)state;
    lod_pack_make(m, &three, 0, &p);
    assert_int_equal(p.mesh.header->level_count, 3);
    assert_false(p.mesh.header->flags & NOH_MESH_TEXELS);
    assert_int_equal(p.mesh.header->touched_count, p.mesh.header->vertex_count);
    f = reach(p.bytes);
    assert_int_equal(f.h[2].touched_count, f.h[2].vertex_count);
    /* level 2 draws nothing, has no targets' rectangles and no texels, but vertices that have some */
    f.h[2].touched_count = f.h[2].morph_height = f.h[2].rect_count = f.h[2].texel_count = f.h[2].pair_count = 0;
    for (uint32_t t = 0; t < 2u; t++) {
        f.targets[2][t].rect_count = f.targets[2][t].texel_count = f.targets[2][t].pair_count = 0;
    }
    pack_repair(p.bytes, p.byte_count);
    assert_int_equal(noh_pack_open(p.bytes, p.byte_count, &pack, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, "has no texels for some of its vertices"));
    lod_pack_free(&p);
    model_free(m);
}

/* The control: the same steps without a lie. */
static void honest_copies_open(void **state)
{
    const small_pack *both[2] = { &rigid, &split };
    (void)state;
    for (int i = 0; i < 2; i++) {
        uint8_t *bytes = test_aligned(both[i]->bytes, both[i]->count);
        noh_pack pack;
        pack_repair(bytes, both[i]->count);
        assert_memory_equal(bytes, both[i]->bytes, both[i]->count);
        pack = test_open(bytes, both[i]->count);
        assert_int_equal(pack_walk(&pack, 1), pack_walk(&pack, 1));
        free(bytes);
    }
}

/* ---- cuts and flips ---- */

static void refuse_cuts_and_flips(const small_pack *good)
{
    uint8_t *bytes = test_aligned(good->bytes, good->count);
    noh_pack pack;
    for (size_t length = 0; length < good->count; length++) {
        uint8_t *cut = test_aligned(good->bytes, length); /* exactly as long: a read past the end is a fault */
        assert_int_not_equal(noh_pack_open(cut, length, &pack, NULL), NOH_OK);
        free(cut);
    }
    for (size_t bit = 0; bit < good->count * 8u; bit++) {
        bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        assert_int_not_equal(noh_pack_open(bytes, good->count, &pack, NULL), NOH_OK);
        bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
    }
    free(bytes);
}

static void every_truncation_and_flip_is_refused(void **state)
{
    (void)state;
    refuse_cuts_and_flips(&rigid);
    refuse_cuts_and_flips(&split);
}

/* With repaired checksums every flip is refused, or the pack that opens is read without a step out of bounds. */
static void walk_flips(const small_pack *good)
{
    uint8_t *bytes = test_aligned(good->bytes, good->count);
    uint32_t opened = 0, refused = 0;
    for (size_t bit = 0; bit < good->count * 8u; bit++) {
        noh_pack pack;
        memcpy(bytes, good->bytes, good->count);
        bytes[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        pack_repair(bytes, good->count);
        if (noh_pack_open(bytes, good->count, &pack, NULL) != NOH_OK) {
            refused++;
        } else if (opened++ % 16u == 0) {
            (void)pack_walk(&pack, (uint32_t)bit);
        }
    }
    print_message("# %zu bytes: %u flips open, %u are refused\n", good->count, opened, refused);
    assert_true(opened > 0 && refused > 0);
    free(bytes);
}

static void repaired_flips_stay_in_bounds(void **state)
{
    (void)state;
    walk_flips(&rigid);
    walk_flips(&split);
}

static const struct CMUnitTest tests[] = { cmocka_unit_test(honest_copies_open),
                                           cmocka_unit_test(errors_name_the_field),
                                           cmocka_unit_test(texels_without_references_are_counted),
                                           cmocka_unit_test(every_truncation_and_flip_is_refused),
                                           cmocka_unit_test(repaired_flips_stay_in_bounds),
#define X(name, statement, message) cmocka_unit_test(level_##name),
                                           LIES(X)
#undef X
#define X(name, statement, message) cmocka_unit_test(split_##name),
                                               SPLIT_LIES(X)
#undef X
};

TEST_MAIN(tests, set_up, tear_down)
