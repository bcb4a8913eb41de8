/* LOD levels in the accumulators: every path at every level against the CPU; the same bits in finer and coarser levels;
 * what a coarser level saves; and descs that hold several levels of one mesh. */
#include "support/gl_fixture.h"
#include "support/level_fixture.h"

#include <stdlib.h>
#include <string.h>

#define LEVELS 3u

static fixture_meshes plain;
static fixture_levels levels;
static noh_mesh meshes[FIXTURE_MESHES];

static int set_up(void **state)
{
    (void)state;
    fixture_meshes_open(&plain);
    fixture_levels_open(&levels, &plain.pack, LEVELS, 2.0f);
    for (uint32_t i = 0; i < FIXTURE_MESHES; i++) {
        meshes[i] = test_mesh(&levels.pack, i);
    }
    /* the shapes that these tests need */
    for (uint32_t k = 1; k < LEVELS; k++) {
        const noh_mesh_header *h = &meshes[2].header[k];
        assert_true(h->touched_count && h->touched_count < h[-1].touched_count && h->texel_count < h[-1].texel_count);
        assert_true(h->touched_count & ((1u << h->morph_width_log2) - 1u)); /* a level may end within a row */
    }
    return 0;
}

static int tear_down(void **state)
{
    fixture_levels_close(&levels);
    fixture_meshes_close(&plain);
    return fixture_tear_down(state);
}

static const uint32_t few[FIXTURE_MESHES] = { 4, 2, 5 };

typedef void (*way_test)(fixture_morph *m);

/* Check accumulators of these meshes in every way that this context can. */
static void in_every_way(const noh_mesh *views, const uint32_t *counts, uint32_t count, way_test test)
{
    int ran = 0;
    for (int i = 0; i < FIXTURE_WAYS; i++) {
        noh_gl_morph_desc desc;
        noh_gl_morph_plan plan;
        fixture_morph m;
        memset(&desc, 0, sizeof desc);
        desc.meshes = views;
        desc.mesh_count = count;
        desc.instance_counts = counts;
        desc.path = fixture_ways[i].path;
        desc.accumulate = fixture_ways[i].accumulate;
        if (noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, NULL) == NOH_OK) {
            fixture_morph_open(&m, &desc, NULL);
            assert_true(noh_gl_ledger_bytes(&m.ledger) == plan.gpu_bytes);
            test(&m);
            fixture_morph_close(&m);
            fixture_expect_no_errors();
            ran++;
        }
    }
    assert_in_range(ran, 2, FIXTURE_WAYS); /* the CPU's two run everywhere */
}

static noh_gl_morph_stats update(fixture_morph *m)
{
    noh_gl_morph_stats stats;
    noh_gl_morph_update(m->morph, &stats);
    return stats;
}

/* ---- equal to the CPU ---- */

static void check_random_levels(fixture_morph *m)
{
    test_random r = { 81 };
    for (int round = 0; round < 8; round++) {
        for (uint32_t i = 0; i < m->plan.instance_count; i++) {
            const uint32_t what = test_random_below(&r, 4);
            if (what == 1) { /* a finer level, the same weights */
                fixture_set_level(m, i, test_random_below(&r, m->levels[i] + 1u));
            }
            if (what == 2) {
                fixture_set_level(m, i, test_random_below(&r, LEVELS));
            }
            if (what >= 2) {
                fixture_set_random(m, i, &r);
            }
        }
        update(m);
        fixture_expect_all(m);
    }
}

static void every_way_equals_the_cpu_at_every_level(void **state)
{
    (void)state;
    in_every_way(meshes, few, FIXTURE_MESHES, check_random_levels);
}

/* A level's texels in all three layers have the bits of another level's. */
static void expect_prefix(const float *coarse, const noh_mesh_header *c, const float *fine, const noh_mesh_header *f)
{
    for (size_t layer = 0; layer < 3; layer++) {
        const size_t row = (size_t)3 << c->morph_width_log2;
        test_same_floats(coarse + layer * c->morph_height * row, fine + layer * f->morph_height * row,
                         3u * c->touched_count, "a prefix");
    }
}

static void check_prefixes(fixture_morph *m)
{
    const uint32_t first = noh_gl_morph_instance(m->morph, 2, 0);
    test_random r = { 82 };
    float weights[NOH_TARGETS_MAX], *fine;
    test_random_weights(&r, weights, meshes[2].header->target_count);
    weights[0] = 0.0f; /* the coarsest level leaves it out */
    for (uint32_t k = 0; k < LEVELS; k++) {
        fixture_set_level(m, first + k, k);
        fixture_set(m, first + k, weights);
    }
    update(m);
    fine = fixture_layers(m, first);
    for (uint32_t k = 1; k < LEVELS; k++) {
        float *coarse = fixture_layers(m, first + k);
        expect_prefix(coarse, &meshes[2].header[k], fine, meshes[2].header);
        free(coarse);
    }
    free(fine);
}

static void coarser_levels_hold_bits_of_the_finer_one(void **state)
{
    (void)state;
    in_every_way(meshes, few, FIXTURE_MESHES, check_prefixes);
}

/* A target without rectangles in a level does not move it, though the lists of a finer level name the target. */
static void check_skipped(fixture_morph *m)
{
    const uint32_t i = noh_gl_morph_instance(m->morph, 2, 0);
    float weights[NOH_TARGETS_MAX] = { 1.0f }, *got, sum = 0.0f;
    size_t floats;
    noh_mesh view;
    fixture_set_level(m, i, LEVELS - 1u);
    fixture_set(m, i, weights);
    assert_int_equal(update(m).targets, 0);
    got = fixture_layers(m, i);
    view = fixture_view_of(m, i);
    floats = noh_morph_layers_size(&view) / 4u;
    for (size_t k = 0; k < floats; k++) {
        sum += got[k] * got[k];
    }
    assert_true(sum == 0.0f);
    free(got);
    fixture_set_level(m, i, 0);
    assert_int_equal(update(m).targets, 1);
    fixture_expect_instance(m, i);
}

static void a_level_does_without_targets_that_it_has_not(void **state)
{
    (void)state;
    assert_int_equal(meshes[2].header->level_count, LEVELS);
    in_every_way(meshes, few, FIXTURE_MESHES, check_skipped);
}

/* ---- only what the level needs ---- */

static void check_changes(fixture_morph *m)
{
    const uint32_t i = noh_gl_morph_instance(m->morph, 2, 1);
    test_random r = { 83 };
    float weights[NOH_TARGETS_MAX];
    noh_gl_morph_stats stats;
    test_random_weights(&r, weights, meshes[2].header->target_count);
    weights[0] = 0.0f; /* left out by the coarsest level */
    fixture_set(m, i, weights);
    update(m);
    fixture_set_level(m, i, 2); /* coarser: its texels are there already */
    stats = update(m);
    assert_int_equal(stats.instances, 0);
    fixture_expect_instance(m, i);
    fixture_set_random(m, i, &r);
    assert_int_equal(update(m).instances, 1);
    fixture_set_level(m, i, 1); /* finer: accumulated again */
    stats = update(m);
    assert_int_equal(stats.instances, 1);
    fixture_expect_all(m);
    fixture_set_level(m, i, 1);
    assert_int_equal(update(m).instances, 0);
}

static void going_finer_accumulates_again(void **state)
{
    (void)state;
    in_every_way(meshes, few, FIXTURE_MESHES, check_changes);
}

static void check_stats(fixture_morph *m)
{
    const uint32_t i = noh_gl_morph_instance(m->morph, 2, 0);
    float weights[NOH_TARGETS_MAX];
    update(m);
    for (uint32_t k = 0; k < LEVELS; k++) {
        const noh_mesh_header *h = &meshes[2].header[k];
        noh_gl_morph_stats stats;
        for (uint32_t t = 0; t < h->target_count; t++) {
            weights[t] = 0.5f + (float)k;
        }
        fixture_set_level(m, i, k);
        fixture_set(m, i, weights);
        stats = update(m);
        assert_int_equal(stats.instances, 1);
        assert_int_equal(stats.pairs, h->pair_count);
        assert_int_equal(stats.texels, h->texel_count);
        assert_int_equal(stats.targets, h->target_count - (k == LEVELS - 1u));
    }
}

static void less_is_done_at_coarser_levels(void **state)
{
    (void)state;
    in_every_way(meshes, few, FIXTURE_MESHES, check_stats);
}

static void levels_are_clamped(void **state)
{
    const noh_mesh views[2] = { noh_mesh_at_lod(&meshes[2], 1), meshes[0] };
    noh_gl_morph_desc desc;
    fixture_morph m;
    test_random r = { 84 };
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.meshes = views;
    desc.mesh_count = 2;
    desc.path = NOH_MORPH_CPU;
    fixture_morph_open(&m, &desc, NULL);
    update(&m);
    fixture_set_level(&m, 0, 0); /* finer than the desc has */
    assert_int_equal(update(&m).instances, 0);
    fixture_set_random(&m, 0, &r);
    update(&m);
    fixture_expect_instance(&m, 0);
    fixture_set_level(&m, 0, 99);
    fixture_set_random(&m, 0, &r);
    assert_true(update(&m).pairs < meshes[2].header[1].pair_count);
    fixture_expect_instance(&m, 0);
    assert_int_equal(noh_gl_morph_binding_of(m.morph, 0).touched, meshes[2].header[1].touched_count);
    fixture_morph_close(&m);
}

/* ---- several levels of one mesh in a desc ---- */

static void compare_with_level(const fixture_morph *m, uint32_t level, const noh_mesh *mesh)
{
    const noh_mesh finest = noh_mesh_at_lod(mesh, level);
    const uint32_t one = 1;
    noh_gl_morph_desc desc = *m->desc;
    noh_gl_morph_plan plan;
    desc.meshes = &finest;
    desc.mesh_count = 1;
    desc.instance_counts = &one;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &m->caps, &plan, NULL), NOH_OK);
    assert_true(m->plan.delta_bytes == plan.delta_bytes);
    assert_true(m->plan.table_bytes == plan.table_bytes);
    assert_int_equal(m->plan.rect_count, finest.header->rect_count);
    assert_int_equal(m->plan.texel_count, finest.header->texel_count);
    assert_int_equal(m->plan.pair_count, finest.header->pair_count);
}

static void check_pools(fixture_morph *m)
{
    uint32_t finest = LEVELS;
    for (uint32_t i = 0; i < m->desc->mesh_count; i++) {
        const uint32_t level = m->desc->meshes[i].header->level;
        finest = level < finest ? level : finest;
    }
    compare_with_level(m, finest, m->desc->meshes);
    check_random_levels(m);
}

static void levels_of_a_mesh_share_their_tables(void **state)
{
    const noh_mesh all[3] = { noh_mesh_at_lod(&meshes[2], 2), meshes[2], noh_mesh_at_lod(&meshes[2], 1) };
    const noh_mesh coarse[3] = { noh_mesh_at_lod(&meshes[2], 2), noh_mesh_at_lod(&meshes[2], 1),
                                 noh_mesh_at_lod(&meshes[2], 1) };
    const uint32_t counts[3] = { 20, 2, 5 };
    (void)state;
    in_every_way(all, counts, 3, check_pools);
    in_every_way(coarse, counts, 3, check_pools);
    in_every_way(coarse, counts, 1, check_pools); /* the coarsest alone */
}

/* The same with other meshes, whose tables lie behind. */
static void pools_stand_beside_other_meshes(void **state)
{
    const noh_mesh views[5] = { noh_mesh_at_lod(&meshes[0], 1), meshes[FIXTURE_BARE], noh_mesh_at_lod(&meshes[2], 2),
                                meshes[0], noh_mesh_at_lod(&meshes[2], 1) };
    const uint32_t counts[5] = { 3, 1, 7, 2, 2 };
    (void)state;
    in_every_way(views, counts, 5, check_random_levels);
}

/* Coarse levels save memory, because their tiles are small. */
static void pools_take_less_memory(void **state)
{
    const noh_mesh views[2] = { meshes[2], noh_mesh_at_lod(&meshes[2], 2) };
    const uint32_t near_and_far[2] = { 10, 1000 };
    const uint32_t all = 1010;
    noh_gl_morph_desc desc;
    noh_gl_morph_plan pools, one;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.meshes = views;
    desc.mesh_count = 2;
    desc.instance_counts = near_and_far;
    desc.path = NOH_MORPH_CPU;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &pools, NULL), NOH_OK);
    desc.mesh_count = 1;
    desc.instance_counts = &all;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &one, NULL), NOH_OK);
    assert_true(pools.layer_bytes * 2u < one.layer_bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_way_equals_the_cpu_at_every_level),
    cmocka_unit_test(coarser_levels_hold_bits_of_the_finer_one),
    cmocka_unit_test(a_level_does_without_targets_that_it_has_not),
    cmocka_unit_test(going_finer_accumulates_again),
    cmocka_unit_test(less_is_done_at_coarser_levels),
    cmocka_unit_test(levels_are_clamped),
    cmocka_unit_test(levels_of_a_mesh_share_their_tables),
    cmocka_unit_test(pools_stand_beside_other_meshes),
    cmocka_unit_test(pools_take_less_memory),
};

TEST_MAIN(tests, set_up, tear_down)
