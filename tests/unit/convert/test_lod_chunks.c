/* LOD levels in packs: each is a part of the finer one's arrays, has the builder's triangles, and moves in the
 * same bits. */
#include "support/lod_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "support/clip_bank_fixture.h"
#include "support/pack_walk.h"
#include "deform/morph/morph_internal.h"
#include "noh/low_core.h"

static const lod_settings four_levels = { 4, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
static const float shares[NOH_LOD_LEVELS_MAX] = LOD_SHARES;

/* ---- the meshes ---- */

typedef struct example {
    const char *name;
    lod_face face; /* without columns: the tube */
    skin_cylinder tube;
    uint32_t palette;
    int odd; /* see make_odd */
    model *m;
    lod_pack p;
} example;

/* clang-format off */
static example examples[] = {
    { .name = "face", .face = { 34, 27, 12, 1, 0 } },
    { .name = "all touched", .face = { 34, 27, 7, 1, 1 } },
    { .name = "without targets", .face = { 34, 27, 0, 1, 0 } },
    { .name = "odd", .face = { 24, 16, 6, 1, 1 }, .odd = 1 },
    { .name = "tube", .tube = { 20, 50, 6, 4, 2, 1, 2.0f, 0.5f } },
    { .name = "split tube", .tube = { 20, 50, 8, 2, 2, 1, 2.0f, 0.5f }, .palette = 6 }
};
/* clang-format on */
enum { FACE, ALL_TOUCHED, WITHOUT_TARGETS, ODD, TUBE, SPLIT_TUBE };

/* A submesh of no triangles, vertices of none, a triangle without an area, and a target that moves nothing. */
static void make_odd(model *m)
{
    model_mesh *mesh = &m->meshes[0];
    mesh->index_count -= 60u;
    mesh->submeshes[1].index_count -= 60u;
    mesh->submeshes[2].first_index = mesh->index_count;
    mesh->submeshes[2].material = MODEL_NONE;
    mesh->submesh_count = 3;
    mesh->indices[mesh->submeshes[1].first_index + 31u] = mesh->indices[mesh->submeshes[1].first_index + 30u];
    memset(mesh->targets[4].position, 0, 12u * (size_t)mesh->vertex_count);
    memset(mesh->targets[4].normal, 0, 12u * (size_t)mesh->vertex_count);
    memset(mesh->targets[4].tangent, 0, 12u * (size_t)mesh->vertex_count);
}

static model *model_of(const example *e)
{
    model *m = e->face.columns ? lod_face_model(&e->face) : lod_tube_model(&e->tube);
    if (e->odd) {
        make_odd(m);
    }
    return m;
}

static int set_up(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(examples); i++) {
        example *e = &examples[i];
        e->m = model_of(e);
        lod_pack_make(e->m, &four_levels, e->palette, &e->p);
        for (uint32_t k = 0; k < e->p.levels[0].count; k++) {
            const noh_mesh_header *h = noh_mesh_at_lod(&e->p.mesh, k).header;
            print_message("# %s, level %u: %u vertices, %u triangles in %u draws, %u texels in %u rectangles\n",
                          e->name, k, h->vertex_count, h->index_count / 3u, h->submesh_count, h->texel_count,
                          h->rect_count);
        }
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(examples); i++) {
        lod_pack_free(&examples[i].p);
        model_free(examples[i].m);
    }
    return 0;
}

/* Call `check` for each level of each example, and its finer one. */
static void each_level(void (*check)(const example *e, const noh_mesh *level, const noh_mesh *finer))
{
    for (size_t i = 0; i < TEST_COUNT(examples); i++) {
        const example *e = &examples[i];
        assert_int_equal(e->p.mesh.header->level_count, 4);
        for (uint32_t k = 1; k < 4u; k++) {
            const noh_mesh level = noh_mesh_at_lod(&e->p.mesh, k), finer = noh_mesh_at_lod(&level, k - 1u);
            assert_int_equal(level.header->level, k);
            assert_int_equal(finer.header->level, k - 1u);
            check(e, &level, &finer);
        }
    }
}

/* ---- each is a part of the finer one ---- */

static void check_arrays(const example *e, const noh_mesh *level, const noh_mesh *finer)
{
    const noh_mesh_header *l = level->header, *f = finer->header;
    assert_true(l->vertex_count < f->vertex_count && l->index_count < f->index_count &&
                l->touched_count <= f->touched_count);
    assert_ptr_equal(level->positions, finer->positions);
    assert_ptr_equal(level->attributes, finer->attributes);
    assert_ptr_equal(level->influences, finer->influences);
    assert_ptr_equal(level->rects, finer->rects);
    assert_ptr_equal(level->texels, finer->texels);
    assert_ptr_equal(level->weights, finer->weights);
    for (uint32_t t = 0; t < l->target_count; t++) {
        const noh_target *a = &level->targets[t], *b = &finer->targets[t];
        assert_true(a->first_rect == b->first_rect && a->first_texel == b->first_texel);
        assert_true(a->rect_count <= b->rect_count && a->texel_count <= b->texel_count &&
                    a->pair_count <= b->pair_count);
        assert_string_equal(noh_pack_string(&e->p.pack, a->name), e->p.from->targets[t].name);
    }
}

static void arrays_are_shared(void **state)
{
    (void)state;
    each_level(check_arrays);
}

/* At every level, decoded, the vertex of that number in the full mesh. */
static void check_vertices(const example *e, const noh_mesh *level, const noh_mesh *finer)
{
    (void)finer;
    for (uint32_t v = 0; v < level->header->vertex_count; v++) {
        noh_vertex a, b;
        uint32_t joints[2][NOH_INFLUENCES_MAX] = { { 0 }, { 0 } };
        float weights[2][NOH_INFLUENCES_MAX] = { { 0 }, { 0 } };
        noh_mesh_vertex(level, v, &a);
        noh_mesh_vertex(&e->p.mesh, v, &b);
        assert_memory_equal(&a, &b, sizeof a);
        if (level->header->influence_count) {
            noh_mesh_influences(level, v, joints[0], weights[0]);
            noh_mesh_influences(&e->p.mesh, v, joints[1], weights[1]);
            assert_memory_equal(joints[0], joints[1], sizeof joints[0]);
            assert_memory_equal(weights[0], weights[1], sizeof weights[0]);
        }
        assert_true(noh_mesh_accumulation_texel(level, v) < level->header->touched_count ||
                    noh_mesh_accumulation_texel(&e->p.mesh, v) >= e->p.mesh.header->touched_count);
    }
}

static void vertices_are_the_same(void **state)
{
    (void)state;
    each_level(check_vertices);
}

/* Its own indices, and the coarser levels' indices, use each of its vertices; the submeshes' runs hold theirs. */
static void check_use(const example *e, const noh_mesh *level, const noh_mesh *finer)
{
    uint8_t *used = test_zeros(level->header->vertex_count);
    (void)finer;
    for (uint32_t k = level->header->level; k < e->p.mesh.header->level_count; k++) {
        const noh_mesh coarse = noh_mesh_at_lod(level, k);
        for (uint32_t s = 0; s < coarse.header->submesh_count; s++) {
            const noh_submesh *sub = &coarse.submeshes[s];
            for (uint32_t i = 0; i < sub->index_count; i++) {
                const uint32_t v = noh_mesh_index(&coarse, sub->first_index + i);
                assert_true(v < coarse.header->vertex_count);
                assert_true(v >= sub->first_vertex && v - sub->first_vertex < sub->vertex_count);
                used[v] = 1;
            }
        }
    }
    for (uint32_t v = 0; v < level->header->vertex_count; v++) {
        assert_true(used[v]);
    }
    free(used);
}

static void no_level_has_a_vertex_too_many(void **state)
{
    (void)state;
    each_level(check_use);
}

static void past_the_last_is_the_coarsest(void **state)
{
    const noh_mesh coarsest = noh_mesh_at_lod(&examples[FACE].p.mesh, 3), past = noh_mesh_at_lod(&coarsest, 99);
    (void)state;
    assert_memory_equal(&coarsest, &past, sizeof past);
}

/* ---- triangles ---- */

typedef struct triangle {
    uint32_t corner[3]; /* vertices of the model */
    uint32_t material;
} triangle;

typedef struct triangle_list {
    uint32_t count;
    triangle *items;
} triangle_list;

static void add_triangles(triangle_list *list, const uint32_t *indices, uint32_t count, uint32_t material)
{
    for (uint32_t i = 0; i < count; i += 3u) {
        triangle *t = &list->items[list->count++];
        memcpy(t->corner, indices + i, sizeof t->corner);
        t->material = material;
    }
}

static triangle_list packed_triangles(const noh_mesh *level, const uint32_t *sources)
{
    triangle_list list = { 0, test_zeros(sizeof *list.items * (level->header->index_count / 3u + 1u)) };
    for (uint32_t s = 0; s < level->header->submesh_count; s++) {
        const noh_submesh *sub = &level->submeshes[s];
        for (uint32_t i = 0; i < sub->index_count; i += 3u) {
            uint32_t corner[3];
            for (uint32_t c = 0; c < 3u; c++) {
                corner[c] = sources[noh_mesh_index(level, sub->first_index + i + c)];
            }
            add_triangles(&list, corner, 3, sub->material);
        }
    }
    return list;
}

static triangle_list built_triangles(const lod_pack *p, uint32_t level)
{
    const model_mesh *m = p->from;
    triangle_list list = { 0, test_zeros(sizeof *list.items * (m->index_count / 3u + 1u)) };
    for (uint32_t s = 0; s < m->submesh_count; s++) {
        const model_submesh *sub = &m->submeshes[s];
        if (level) {
            const lod_level *l = &p->levels[0].built->levels[p->levels[0].which[level]];
            add_triangles(&list, l->indices + l->submesh_first[s], l->submesh_count[s], sub->material);
        } else {
            add_triangles(&list, m->indices + sub->first_index, sub->index_count, sub->material);
        }
    }
    return list;
}

static int by_corners(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(triangle));
}

/* The smallest corner first, its sense kept; then the triangles in an order of their own. */
static void sort_triangles(triangle_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        uint32_t *c = list->items[i].corner;
        while (c[0] > c[1] || c[0] > c[2]) {
            const uint32_t first = c[0];
            c[0] = c[1];
            c[1] = c[2];
            c[2] = first;
        }
    }
    qsort(list->items, list->count, sizeof *list->items, by_corners);
}

static void triangles_are_the_builders(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(examples); i++) {
        const lod_pack *p = &examples[i].p;
        uint32_t *sources = lod_pack_sources(p);
        for (uint32_t k = 0; k < p->levels[0].count; k++) {
            const noh_mesh level = noh_mesh_at_lod(&p->mesh, k);
            triangle_list got = packed_triangles(&level, sources), expected = built_triangles(p, k);
            assert_int_equal(got.count, expected.count);
            sort_triangles(&got);
            sort_triangles(&expected);
            assert_memory_equal(got.items, expected.items, sizeof *got.items * got.count);
            free(got.items);
            free(expected.items);
        }
        free(sources);
    }
}

/* The eye's material blends: in every level its triangles are drawn in the artist's order. */
static void blended_triangles_keep_their_order(void **state)
{
    const lod_pack *p = &examples[FACE].p;
    uint32_t *sources = lod_pack_sources(p), compared = 0;
    (void)state;
    for (uint32_t k = 0; k < p->levels[0].count; k++) {
        const noh_mesh level = noh_mesh_at_lod(&p->mesh, k);
        triangle_list got = packed_triangles(&level, sources), expected = built_triangles(p, k);
        for (uint32_t i = 0; i < got.count; i++) {
            if (expected.items[i].material == 1u) {
                assert_memory_equal(&got.items[i], &expected.items[i], sizeof *got.items);
                compared++;
            }
        }
        free(got.items);
        free(expected.items);
    }
    assert_true(compared > 200u);
    free(sources);
}

/* The builder stops at the first collapse that reaches the share; one takes two triangles, at a pole a few. In the
 * coarsest level of a mesh this small it may run out of those that fold nothing. */
static void counts_are_the_shares(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(examples); i++) {
        for (uint32_t k = 1; k < 4u && i != ODD; k++) { /* its open eye cannot become as coarse */
            const double full = examples[i].p.mesh.header->index_count / 3u, asked = ceil((double)shares[k] * full);
            const double got = noh_mesh_at_lod(&examples[i].p.mesh, k).header->index_count / 3u;
            if (got > asked + (k == 3u ? 0.005 * full : 0.0) || got < asked - 4.0) {
                fail_msg("%s, level %u: %g triangles, not %g", examples[i].name, k, got, asked);
            }
        }
    }
}

/* ---- accumulating ---- */

typedef void (*accumulate_function)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

static void accumulate_half(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate_f16(mesh, weights, NOH_HALF_RNE, layers);
}

/* The level's texels in all three layers, and nothing behind them. */
static void compare_layers(const noh_mesh *level, const noh_morph_layers *a, const noh_mesh *full,
                           const noh_morph_layers *b)
{
    const size_t texels = (size_t)level->header->morph_height << level->header->morph_width_log2,
                 touched = level->header->touched_count;
    const float *got[3] = { a->position, a->normal, a->tangent }, *expected[3] = { b->position, b->normal, b->tangent };
    assert_true(touched <= full->header->touched_count);
    for (int layer = 0; layer < 3; layer++) {
        test_same_floats(got[layer], expected[layer], 3u * touched, "a level's texels");
        for (size_t i = 3u * touched; i < 3u * texels; i++) {
            assert_true(got[layer][i] == 0.0f);
        }
    }
}

static void compare_morphed(const noh_mesh *level, const noh_morph_layers *a, const noh_mesh *full,
                            const noh_morph_layers *b)
{
    for (uint32_t v = 0; v < level->header->vertex_count; v++) {
        noh_vertex got, expected;
        noh_morph_vertex(level, a, v, &got);
        noh_morph_vertex(full, b, v, &expected);
        assert_memory_equal(&got, &expected, sizeof got);
    }
}

static void accumulate_levels(const noh_mesh *full, const float *weights, accumulate_function accumulate)
{
    lod_layers all = lod_layers_make(full);
    accumulate(full, weights, &all.layers);
    for (uint32_t k = 1; k < full->header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(full, k);
        lod_layers own = lod_layers_make(&level);
        accumulate(&level, weights, &own.layers);
        compare_layers(&level, &own.layers, full, &all.layers);
        compare_morphed(&level, &own.layers, full, &all.layers);
        lod_layers_free(&own);
    }
    lod_layers_free(&all);
}

static void levels_accumulate_the_first_texels(void **state)
{
    static const accumulate_function ways[3] = { noh_morph_accumulate, noh_morph_accumulate_scalar, accumulate_half };
    test_random r = test_random_from(21);
    float weights[LOD_FACE_TARGETS];
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(examples); i++) {
        for (uint32_t round = 0; round < 6u; round++) {
            test_random_weights(&r, weights, LOD_FACE_TARGETS);
            accumulate_levels(&examples[i].p.mesh, weights, ways[round % 3u]);
        }
    }
}

/* ---- skinning ---- */

typedef struct skinned {
    float *position, *normal, *tangent;
} skinned;

#define GUARD_FLOATS 16u

static float *guarded(size_t count)
{
    float *values = test_zeros(sizeof *values * (count + GUARD_FLOATS));
    memset(values + count, 0xa5, sizeof *values * GUARD_FLOATS);
    return values;
}

static void free_guarded(float *values, size_t count)
{
    for (size_t i = 0; i < sizeof *values * GUARD_FLOATS; i++) {
        assert_int_equal(((const uint8_t *)(values + count))[i], 0xa5);
    }
    free(values);
}

/* All vertices of a level by random matrices, morphed. dual: NULL, or the same as dual quaternions. */
static skinned skin_level(const noh_mesh *level, const float *matrices, const noh_dual_quaternion *dual,
                          const float *weights)
{
    const size_t count = level->header->vertex_count;
    skinned s = { guarded(3u * count), guarded(3u * count), guarded(4u * count) };
    lod_layers l = lod_layers_make(level);
    noh_morph_accumulate(level, weights, &l.layers);
    if (dual) {
        noh_skin_vertices_dual(level, dual, &l.layers, 0, (uint32_t)count, s.position, s.normal, s.tangent);
    } else {
        noh_skin_vertices(level, matrices, &l.layers, 0, (uint32_t)count, s.position, s.normal, s.tangent);
    }
    lod_layers_free(&l);
    return s;
}

static void skinned_free(skinned *s, const noh_mesh *level)
{
    free_guarded(s->position, 3u * (size_t)level->header->vertex_count);
    free_guarded(s->normal, 3u * (size_t)level->header->vertex_count);
    free_guarded(s->tangent, 4u * (size_t)level->header->vertex_count);
}

static void compare_skinned(const noh_mesh *full, const float *matrices, const noh_dual_quaternion *dual,
                            const float *weights)
{
    skinned all = skin_level(full, matrices, dual, weights);
    for (uint32_t k = 1; k < full->header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(full, k);
        const size_t count = level.header->vertex_count;
        skinned own = skin_level(&level, matrices, dual, weights);
        test_same_floats(own.position, all.position, 3u * count, "a level's positions");
        test_same_floats(own.normal, all.normal, 3u * count, "a level's normals");
        test_same_floats(own.tangent, all.tangent, 4u * count, "a level's tangents");
        skinned_free(&own, &level);
    }
    skinned_free(&all, full);
}

static void levels_skin_the_first_vertices(void **state)
{
    test_random r = test_random_from(22);
    (void)state;
    for (size_t i = TUBE; i <= SPLIT_TUBE; i++) {
        const lod_pack *p = &examples[i].p;
        const uint32_t joints = examples[i].tube.joints;
        float *matrices = test_zeros(48u * joints), weights[2];
        noh_dual_quaternion *dual = test_zeros(sizeof *dual * joints);
        for (uint32_t round = 0; round < 4u; round++) {
            test_random_weights(&r, weights, 2);
            for (uint32_t n = 0; n < 12u * joints; n++) {
                matrices[n] = test_random_float(&r, -2.0f, 2.0f);
            }
            noh_skin_dual_quaternions(matrices, joints, dual);
            compare_skinned(&p->mesh, matrices, round % 2u ? dual : NULL, weights);
        }
        free(dual);
        free(matrices);
    }
}

static void the_split_tube_is_split(void **state)
{
    const noh_mesh *mesh = &examples[SPLIT_TUBE].p.mesh;
    (void)state;
    assert_true(mesh->header->palette_count > 1 &&
                mesh->header->vertex_count > examples[SPLIT_TUBE].m->meshes[0].vertex_count);
    assert_true(noh_mesh_at_lod(mesh, 3).header->submesh_count > 1);
}

/* ---- costs ---- */

/* Where targets move everything, pairs and texels fall with the vertices. */
static void texels_fall_with_the_vertices(void **state)
{
    const noh_mesh *full = &examples[ALL_TOUCHED].p.mesh;
    (void)state;
    for (uint32_t k = 1; k < 4u; k++) {
        const noh_mesh_header *l = noh_mesh_at_lod(full, k).header, *f = full->header;
        const double vertices = (double)l->vertex_count / f->vertex_count,
                     texels = (double)l->texel_count / f->texel_count;
        const double pairs = (double)l->pair_count / f->pair_count;
        print_message("# level %u: %.4f of the vertices, %.4f of the texels, %.4f of the pairs\n", k, vertices, texels,
                      pairs);
        assert_true(fabs(texels - vertices) <= 0.1 * vertices);
        assert_true(fabs(pairs - vertices) <= 0.1 * vertices);
    }
}

/* What a level leaves out: the targets that have nothing to move in it. */
static void targets_left_out_are_told(void **state)
{
    uint32_t left_out = 0;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(examples); i++) {
        const noh_mesh *full = &examples[i].p.mesh;
        for (uint32_t k = 0; k < full->header->level_count; k++) {
            const noh_mesh level = noh_mesh_at_lod(full, k);
            double sum = 0.0;
            for (uint32_t t = 0; t < level.header->target_count; t++) {
                const int is_out = full->targets[t].rect_count && !level.targets[t].rect_count;
                sum += is_out ? (double)full->targets[t].radius : 0.0;
                left_out += (uint32_t)is_out;
            }
            assert_true(fabs((double)level.header->level_skipped - sum) <= 1e-6 * sum);
        }
    }
    assert_true(left_out > 0);
}

/* ---- odd meshes ---- */

static void same_bytes_twice(void **state)
{
    (void)state;
    for (size_t i = ODD; i <= SPLIT_TUBE; i++) {
        model *m = model_of(&examples[i]);
        lod_pack again;
        lod_pack_make(m, &four_levels, examples[i].palette, &again);
        assert_int_equal(again.byte_count, examples[i].p.byte_count);
        assert_memory_equal(again.bytes, examples[i].p.bytes, again.byte_count);
        lod_pack_free(&again);
        model_free(m);
    }
}

/* The pack has the full mesh alone, and the bytes that it has without levels asked for. */
static void check_has_no_levels(model *m, const lod_settings *settings)
{
    const lod_settings none = { 0, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    lod_pack with, without;
    lod_pack_make(m, settings, 0, &with);
    lod_pack_make(m, &none, 0, &without);
    assert_int_equal(with.mesh.header->level_count, 1);
    assert_int_equal(with.byte_count, without.byte_count);
    assert_memory_equal(with.bytes, without.bytes, with.byte_count);
    lod_pack_free(&with);
    lod_pack_free(&without);
    model_free(m);
}

static void one_level_is_none(void **state)
{
    const lod_settings one = { 1, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    const lod_face face = { 12, 8, 3, 1, 0 };
    (void)state;
    check_has_no_levels(lod_face_model(&face), &one);
}

static void what_cannot_be_simplified_has_no_levels(void **state)
{
    const lod_settings by_error = { 0, 1, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    const lod_face octahedron = { 4, 2, 0, 0, 0 };
    model *m = lod_face_model(&octahedron);
    (void)state;
    m->meshes[0].index_count = m->meshes[0].submeshes[0].index_count = 3; /* a triangle of it */
    check_has_no_levels(m, &four_levels);
    check_has_no_levels(lod_face_model(&octahedron), &by_error);
}

static void what_has_no_triangles_has_no_levels(void **state)
{
    const lod_face face = { 6, 4, 3, 0, 0 };
    model *m = lod_face_model(&face);
    (void)state;
    m->meshes[0].index_count = m->meshes[0].submeshes[0].index_count = 0;
    check_has_no_levels(m, &four_levels);
}

/* A pack of clips alone is not affected. */
static void clip_has_no_levels(void **state)
{
    const char *input = clip_bvh("lod_clip", "abc", 10);
    convert_options options;
    uint8_t *with, *without;
    size_t with_count, without_count;
    (void)state;
    memset(&options, 0, sizeof options);
    without = clip_pack(&input, 1, &options, &without_count);
    options.lod = four_levels;
    with = clip_pack(&input, 1, &options, &with_count);
    assert_int_equal(with_count, without_count);
    assert_memory_equal(with, without, with_count);
    free(with);
    free(without);
}

/* Levels asked for by their error instead of their share of triangles: each has fewer triangles, and at most eight are
 * made. */
static void levels_by_error(void **state)
{
    const lod_settings by_error = { 0, 1, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    const lod_face face = { 24, 16, 6, 1, 0 };
    model *m = lod_face_model(&face);
    lod_pack p;
    (void)state;
    lod_pack_make(m, &by_error, 0, &p);
    assert_true(p.mesh.header->level_count > 2 && p.mesh.header->level_count <= NOH_LOD_LEVELS_MAX);
    for (uint32_t k = 1; k < p.mesh.header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(&p.mesh, k), finer = noh_mesh_at_lod(&p.mesh, k - 1u);
        assert_true(level.header->index_count < finer.header->index_count);
        assert_true(level.header->level_error_rest > 0.0f);
    }
    lod_pack_free(&p);
    model_free(m);
}

/* Grids of two sizes whose submeshes share vertices, with colours, a texture and a scene. */
static void every_mesh_has_its_levels(void **state)
{
    const test_model_desc desc = { 2, 16, 5, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 9 };
    model *m = test_model(&desc);
    lod_pack p;
    (void)state;
    lod_pack_make(m, &four_levels, 0, &p);
    assert_int_equal(p.pack.runs[NOH_CHUNK_MESH].count, 2);
    for (uint32_t i = 0; i < 2u; i++) {
        const noh_mesh mesh = test_mesh(&p.pack, i);
        float weights[5] = { 1.0f, -0.5f, 0.25f, 0.0f, 2.0f };
        assert_true(mesh.header->level_count > 1);
        accumulate_levels(&mesh, weights, noh_morph_accumulate);
    }
    assert_int_equal(pack_walk(&p.pack, 3), pack_walk(&p.pack, 3));
    lod_pack_free(&p);
    model_free(m);
}

/* Above 65,536 vertices indices are words, in every level: also in those that have fewer. */
static void large_meshes_have_word_indices(void **state)
{
    const lod_settings two = { 2, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    const lod_face face = { 360, 182, 0, 0, 0 };
    model *m = lod_face_model(&face);
    lod_pack p;
    noh_mesh level;
    (void)state;
    /* the width is the vertices' width; an eighth of the triangles is simplified in an eighth of the time */
    m->meshes[0].index_count = m->meshes[0].submeshes[0].index_count = m->meshes[0].index_count / 8u / 3u * 3u;
    lod_pack_make(m, &two, 0, &p);
    level = noh_mesh_at_lod(&p.mesh, 1);
    assert_true(p.mesh.header->vertex_count > 65536u && level.header->vertex_count < 65536u);
    assert_int_equal(p.mesh.header->index_bytes, 4);
    assert_int_equal(level.header->index_bytes, 4);
    for (uint32_t i = 0; i < level.header->index_count; i++) {
        assert_true(noh_mesh_index(&level, i) < level.header->vertex_count);
    }
    lod_pack_free(&p);
    model_free(m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(arrays_are_shared),
    cmocka_unit_test(vertices_are_the_same),
    cmocka_unit_test(no_level_has_a_vertex_too_many),
    cmocka_unit_test(past_the_last_is_the_coarsest),
    cmocka_unit_test(triangles_are_the_builders),
    cmocka_unit_test(blended_triangles_keep_their_order),
    cmocka_unit_test(counts_are_the_shares),
    cmocka_unit_test(levels_accumulate_the_first_texels),
    cmocka_unit_test(levels_skin_the_first_vertices),
    cmocka_unit_test(the_split_tube_is_split),
    cmocka_unit_test(texels_fall_with_the_vertices),
    cmocka_unit_test(targets_left_out_are_told),
    cmocka_unit_test(same_bytes_twice),
    cmocka_unit_test(one_level_is_none),
    cmocka_unit_test(what_cannot_be_simplified_has_no_levels),
    cmocka_unit_test(what_has_no_triangles_has_no_levels),
    cmocka_unit_test(clip_has_no_levels),
    cmocka_unit_test(levels_by_error),
    cmocka_unit_test(every_mesh_has_its_levels),
    cmocka_unit_test(large_meshes_have_word_indices),
};

TEST_MAIN(tests, set_up, tear_down)
