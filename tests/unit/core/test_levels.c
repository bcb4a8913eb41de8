/* test_levels.c: LOD levels on the CPU: views, accumulation and skinning of each level against the full mesh's,
 * bit for bit. */
#include "support/level_fixture.h"
#include "support/skin_asset.h"

#include <stdlib.h>
#include <string.h>

#include "deform/morph/morph_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/pack.h"

#define LEVELS 4u

/* A tube with joints and targets; palette: joints to a palette at most, 0 all. */
typedef struct made {
    uint8_t *bytes;
    noh_pack pack;
    fixture_levels levels;
    noh_mesh plain, mesh;
    float *matrices;
} made;

static void make(made *x, uint32_t influences, uint32_t palette)
{
    const skin_cylinder c = { 11, 23, 13, influences, 3, influences > 1, 3.0f, 0.5f };
    model *m = skin_cylinder_model(&c);
    test_random r = test_random_from(influences + palette);
    skin_options options;
    noh_skin skin;
    size_t count;
    memset(&options, 0, sizeof options);
    options.palette = palette;
    x->bytes = skin_pack_of(m, &options, 1.0f, &count, NULL);
    model_free(m);
    x->pack = test_open(x->bytes, count);
    fixture_levels_open(&x->levels, &x->pack, LEVELS, 0.15f);
    x->plain = test_mesh(&x->pack, 0);
    x->mesh = test_mesh(&x->levels.pack, 0);
    assert_int_equal(noh_pack_skin_at(&x->pack, x->plain.header->skin, &skin, NULL), NOH_OK);
    x->matrices = test_zeros(48u * (size_t)skin.header->joint_count);
    for (uint32_t i = 0; i < 12u * skin.header->joint_count; i++) {
        x->matrices[i] = test_random_float(&r, -2.0f, 2.0f);
    }
}

static void unmake(made *x)
{
    free(x->matrices);
    fixture_levels_close(&x->levels);
    free(x->bytes);
}

/* For every target except the first, which the coarsest level leaves out. */
static const float weights[3] = { 0.0f, 0.7f, -0.4f };

static noh_morph_layers accumulated(const noh_mesh *mesh)
{
    noh_morph_layers layers = test_layers(mesh);
    noh_morph_accumulate(mesh, weights, &layers);
    return layers;
}

/* ---- views ---- */

static void views_are_found_from_any_level(void **state)
{
    made x;
    (void)state;
    make(&x, 4, 0);
    for (uint32_t from = 0; from < LEVELS; from++) {
        const noh_mesh at = noh_mesh_at_lod(&x.mesh, from);
        assert_int_equal(at.header->level, from);
        for (uint32_t to = 0; to < LEVELS + 3u; to++) {
            const noh_mesh view = noh_mesh_at_lod(&at, to), expected = noh_mesh_at_lod(&x.mesh, to);
            assert_int_equal(view.header->level, to < LEVELS ? to : LEVELS - 1u);
            assert_memory_equal(&view, &expected, sizeof view);
            assert_ptr_equal(view.positions, x.mesh.positions);
            assert_ptr_equal(view.texels, x.mesh.texels);
        }
    }
    unmake(&x);
}

/* The fixture's mesh is the original one in another order. */
static void the_full_level_is_the_mesh(void **state)
{
    noh_morph_layers plain, layers;
    made x;
    (void)state;
    make(&x, 4, 0);
    plain = accumulated(&x.plain);
    layers = accumulated(&x.mesh);
    assert_int_equal(x.mesh.header->vertex_count, x.plain.header->vertex_count);
    for (uint32_t v = 0; v < x.mesh.header->vertex_count; v++) {
        noh_vertex got, expected;
        noh_skin_vertex(&x.mesh, x.matrices, &layers, v, &got);
        noh_skin_vertex(&x.plain, x.matrices, &plain, x.levels.orders[0][v], &expected);
        test_same_floats((const float *)&got, (const float *)&expected, sizeof got / 4u, "a vertex");
    }
    free(plain.position);
    free(layers.position);
    unmake(&x);
}

/* ---- accumulation ---- */

typedef void (*accumulator)(const noh_mesh *mesh, const noh_morph_layers *layers);

static void simd(const noh_mesh *mesh, const noh_morph_layers *layers)
{
    noh_morph_accumulate(mesh, weights, layers);
}

static void scalar(const noh_mesh *mesh, const noh_morph_layers *layers)
{
    noh_morph_accumulate_scalar(mesh, weights, layers);
}

static void half(const noh_mesh *mesh, const noh_morph_layers *layers)
{
    noh_morph_accumulate_f16(mesh, weights, NOH_HALF_RNE, layers);
}

static void sums_of_a_level_are_those_of_the_full_mesh(void **state)
{
    static const accumulator ways[] = { simd, scalar, half };
    made x;
    (void)state;
    make(&x, 4, 0);
    for (size_t i = 0; i < TEST_COUNT(ways); i++) {
        noh_morph_layers full = test_layers(&x.mesh);
        ways[i](&x.mesh, &full);
        for (uint32_t k = 1; k < LEVELS; k++) {
            const noh_mesh view = noh_mesh_at_lod(&x.mesh, k);
            const size_t floats = 3u * (size_t)view.header->touched_count;
            noh_morph_layers layers = test_layers(&view);
            assert_true(noh_morph_layers_size(&view) < noh_morph_layers_size(&x.mesh));
            ways[i](&view, &layers);
            test_same_floats(layers.position, full.position, floats, "positions");
            test_same_floats(layers.normal, full.normal, floats, "normals");
            test_same_floats(layers.tangent, full.tangent, floats, "tangents");
            free(layers.position);
        }
        free(full.position);
    }
    unmake(&x);
}

static void a_level_costs_less(void **state)
{
    const float all[3] = { 1.0f, 1.0f, 1.0f };
    noh_morph_cost before;
    made x;
    (void)state;
    make(&x, 2, 0);
    before = noh_morph_cost_of(&x.mesh, all);
    for (uint32_t k = 1; k < LEVELS; k++) {
        const noh_mesh view = noh_mesh_at_lod(&x.mesh, k);
        const noh_morph_cost cost = noh_morph_cost_of(&view, all);
        assert_true(cost.pairs < before.pairs && cost.texels < before.texels && cost.rects < before.rects);
        assert_int_equal(cost.pairs, view.header->pair_count);
        assert_true(cost.targets <= before.targets && cost.targets < 3u + (k < LEVELS - 1u));
        before = cost;
    }
    unmake(&x);
}

/* ---- skinning ---- */

typedef void (*skin_function)(const noh_mesh *, const float *, const noh_morph_layers *, uint32_t, uint32_t, float *,
                              float *, float *);

#if defined(__x86_64__)
void noh_skin_vertices_sse2(const noh_mesh *, const float *, const noh_morph_layers *, uint32_t, uint32_t, float *,
                            float *, float *);
void noh_skin_vertices_avx2(const noh_mesh *, const float *, const noh_morph_layers *, uint32_t, uint32_t, float *,
                            float *, float *);
#endif

/* Every vertex of a level as noh_skin_vertex has it, and as the full mesh has it. */
static void check_level(const made *x, uint32_t level, skin_function function, int morphed)
{
    const noh_mesh view = noh_mesh_at_lod(&x->mesh, level);
    const uint32_t count = view.header->vertex_count;
    noh_morph_layers layers = accumulated(&view), full = accumulated(&x->mesh);
    float *positions = test_zeros(12u * (size_t)count), *normals = test_zeros(12u * (size_t)count),
          *tangents = test_zeros(16u * (size_t)count);
    function(&view, x->matrices, morphed ? &layers : NULL, 0, count, positions, normals, tangents);
    for (uint32_t v = 0; v < count; v++) {
        noh_vertex one, whole;
        noh_skin_vertex(&view, x->matrices, morphed ? &layers : NULL, v, &one);
        noh_skin_vertex(&x->mesh, x->matrices, morphed ? &full : NULL, v, &whole);
        test_same_floats(positions + 3u * v, one.position, 3, "positions");
        test_same_floats(normals + 3u * v, one.normal, 3, "normals");
        test_same_floats(tangents + 4u * v, one.tangent, 4, "tangents");
        test_same_floats((const float *)&one, (const float *)&whole, sizeof one / 4u, "the full mesh's vertex");
    }
    free(positions);
    free(normals);
    free(tangents);
    free(layers.position);
    free(full.position);
}

static void check_skins(skin_function function)
{
    for (uint32_t influences = 1; influences <= 8; influences *= 2) {
        for (uint32_t palette = 0; palette < 2; palette++) {
            made x;
            make(&x, influences, palette * 3u * influences);
            assert_true((palette && influences < 8u) == (x.mesh.header->palette_count > 1));
            for (uint32_t level = 0; level < LEVELS; level++) {
                check_level(&x, level, function, 0);
                check_level(&x, level, function, 1);
            }
            unmake(&x);
        }
    }
}

static void levels_are_skinned_as_the_full_mesh(void **state)
{
    (void)state;
    check_skins(noh_skin_vertices);
}

static void by_other_instruction_sets_too(void **state)
{
    (void)state;
#if defined(__x86_64__)
    check_skins(noh_skin_vertices_sse2);
    if (!__builtin_cpu_supports("avx2")) {
        test_skip("this processor has no AVX2");
    }
    check_skins(noh_skin_vertices_avx2);
#else
    test_skip("not an x86-64 machine");
#endif
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(views_are_found_from_any_level),
    cmocka_unit_test(the_full_level_is_the_mesh),
    cmocka_unit_test(sums_of_a_level_are_those_of_the_full_mesh),
    cmocka_unit_test(a_level_costs_less),
    cmocka_unit_test(levels_are_skinned_as_the_full_mesh),
    cmocka_unit_test(by_other_instruction_sets_too),
};

TEST_MAIN(tests, NULL, NULL)
