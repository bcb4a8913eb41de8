/* What an LOD level of the mask costs: only its own vertices are transformed and only its own texels accumulated, and
 * both get fewer with each level. */
#include "support/gl_fixture.h"
#include "file/pack_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LEVELS 4u

static pack_file file;
static noh_mesh mask;
static fixture_morph morph;
static noh_gl_morph_desc desc;

static int tear_down(void **state)
{
    if (morph.morph) {
        fixture_morph_close(&morph);
    }
    if (file.path) {
        pack_file_close(&file);
    }
    return fixture_tear_down(state);
}

/* Opened by the first test that needs it. */
static void open_mask(void)
{
    static char path[1024];
    const char *folder = getenv("NOH_BUILD");
    fixture_gpu();
    if (!file.path) {
        snprintf(path, sizeof path, "%s/mask_levels.noh", folder ? folder : "build");
        assert_int_equal(pack_file_open(&file, path), 0);
        mask = test_mesh(&file.pack, 0);
        desc.meshes = &mask;
        desc.mesh_count = 1;
        fixture_morph_open(&morph, &desc, NULL);
    }
    assert_int_equal(mask.header->level_count, LEVELS);
}

/* Of the full mesh's. */
static double share(uint32_t count, uint32_t full)
{
    return (double)count / (double)full;
}

static void a_level_draws_all_its_vertices_and_no_other(void **state)
{
    (void)state;
    open_mask();
    for (uint32_t k = 0; k < LEVELS; k++) {
        const noh_mesh level = noh_mesh_at_lod(&mask, k);
        uint8_t *used = test_zeros(mask.header->vertex_count);
        for (uint32_t i = 0; i < level.header->index_count; i++) {
            used[noh_mesh_index(&level, i)] = 1;
        }
        for (uint32_t v = 0; v < mask.header->vertex_count; v++) {
            assert_int_equal(used[v], v < level.header->vertex_count);
        }
        free(used);
    }
}

/* All targets active, accumulated again at each level, from the finest down and from the coarsest up. */
static noh_gl_morph_stats accumulate(uint32_t level, float weight)
{
    noh_gl_morph_stats stats;
    float weights[NOH_TARGETS_MAX];
    for (uint32_t t = 0; t < mask.header->target_count; t++) {
        weights[t] = weight;
    }
    fixture_set_level(&morph, 0, level);
    fixture_set(&morph, 0, weights);
    noh_gl_morph_update(morph.morph, &stats);
    return stats;
}

static void an_update_accumulates_what_the_level_has(void **state)
{
    (void)state;
    open_mask();
    for (uint32_t i = 0; i < 2u * LEVELS; i++) {
        const uint32_t k = i < LEVELS ? i : 2u * LEVELS - 1u - i;
        const noh_mesh_header *h = noh_mesh_at_lod(&mask, k).header;
        const noh_gl_morph_stats stats = accumulate(k, 0.1f + 0.1f * (float)i);
        assert_int_equal(stats.instances, 1);
        assert_int_equal(stats.pairs, h->pair_count);
        assert_int_equal(stats.texels, h->texel_count);
        assert_int_equal(stats.rects, h->rect_count);
        fixture_expect_instance(&morph, 0);
    }
}

static void its_cost_falls_as_its_vertices_do(void **state)
{
    (void)state;
    open_mask();
    for (uint32_t k = 1; k < LEVELS; k++) {
        const noh_mesh_header *full = mask.header, *h = noh_mesh_at_lod(&mask, k).header;
        const noh_gl_morph_stats stats = accumulate(k, 0.05f + 0.1f * (float)k);
        const double vertices = share(h->vertex_count, full->vertex_count),
                     accumulator = share(h->touched_count, full->touched_count);
        const double deltas = share(stats.texels, full->texel_count);
        print_message("# level %u: vertices %.3f, accumulation texels %.3f, delta texels %.3f of the full mesh's\n", k,
                      vertices, accumulator, deltas);
        assert_true(accumulator <= 1.1 * vertices);
        assert_true(deltas <= 1.1 * vertices);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_level_draws_all_its_vertices_and_no_other),
    cmocka_unit_test(an_update_accumulates_what_the_level_has),
    cmocka_unit_test(its_cost_falls_as_its_vertices_do),
};

TEST_MAIN(tests, NULL, tear_down)
