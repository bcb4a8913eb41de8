/* The memory contract: sizes are exact, one byte less is refused and nothing is touched, and
 * nothing outside the block is ever written; what a plan says before a load is what the load
 * takes, on the CPU and on the GPU. */
#include "support/gl_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deform/morph/morph_internal.h"
#include "gl/draw/gl_renderer_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "support/clip_bank_fixture.h"

#define CANARY 256u
#define FILL 0xa5

/* A block of `bytes` between two canaries, all filled. */
typedef struct guarded {
    uint8_t *whole, *block;
    size_t bytes;
} guarded;

static guarded guarded_new(size_t bytes)
{
    guarded g;
    g.bytes = bytes;
    g.whole = test_aligned(NULL, bytes + 2 * CANARY);
    g.block = g.whole + CANARY;
    memset(g.whole, FILL, bytes + 2 * CANARY);
    return g;
}

static int all_filled(const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (bytes[i] != FILL) {
            return 0;
        }
    }
    return 1;
}

static void expect_canaries(const guarded *g)
{
    assert_true(all_filled(g->whole, CANARY));
    assert_true(all_filled(g->block + g->bytes, CANARY));
}

static void expect_untouched(const guarded *g)
{
    assert_true(all_filled(g->whole, g->bytes + 2 * CANARY));
}

static void guarded_free(guarded *g)
{
    free(g->whole);
}

/* ---- arena ---- */

static void arena_measures_what_it_carves(void **state)
{
    test_random r = test_random_from(1);
    guarded g = guarded_new(4096);
    noh_arena measure = noh_arena_measure(), over = noh_arena_over(g.block, g.bytes);
    (void)state;
    for (int i = 0; i < 60; i++) {
        size_t bytes = test_random_below(&r, 60), alignment = (size_t)1 << test_random_below(&r, 5);
        uint8_t *p = noh_arena_carve(&over, bytes, alignment);
        assert_null(noh_arena_carve(&measure, bytes, alignment));
        assert_non_null(p);
        assert_int_equal((uintptr_t)p % alignment, 0);
        assert_true(p >= g.block && p + bytes <= g.block + g.bytes);
        memset(p, i, bytes);
        assert_int_equal(measure.used, over.used);
    }
    expect_canaries(&g);
    guarded_free(&g);
}

/* The k-th carve fails for every k, and every later one too, however small. */
static void arena_fails_at_every_size_that_is_too_small(void **state)
{
    static const size_t sizes[] = { 24, 1, 40, 16, 7 };
    guarded g = guarded_new(128);
    noh_arena measure = noh_arena_measure();
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(sizes); i++) {
        noh_arena_carve(&measure, sizes[i], 16);
    }
    for (size_t bytes = 0; bytes <= measure.used; bytes++) {
        noh_arena arena = noh_arena_over(g.block, bytes);
        int failed = 0;
        for (size_t i = 0; i < TEST_COUNT(sizes); i++) {
            void *p = noh_arena_carve(&arena, sizes[i], 16);
            assert_false(failed && p);
            failed |= !p;
        }
        assert_int_equal(failed, bytes < measure.used);
        assert_int_equal(arena.used, measure.used);
    }
    expect_untouched(&g);
    guarded_free(&g);
}

static void arena_survives_impossible_sizes(void **state)
{
    guarded g = guarded_new(64);
    noh_arena arena = noh_arena_over(g.block, g.bytes);
    (void)state;
    assert_non_null(noh_arena_carve(&arena, 3, 1));
    assert_null(noh_arena_carve(&arena, SIZE_MAX, 16));
    assert_null(noh_arena_carve(&arena, SIZE_MAX - 8, 16));
    assert_null(noh_arena_carve(&arena, 1, 1));
    arena = noh_arena_over(NULL, 64);
    assert_null(noh_arena_carve(&arena, 1, 1));
    guarded_free(&g);
}

/* ---- layers on the CPU ---- */

static void layers_want_their_exact_size(void **state)
{
    fixture_meshes f;
    (void)state;
    fixture_meshes_open(&f);
    for (uint32_t i = 0; i < FIXTURE_MESHES; i++) {
        size_t need = noh_morph_layers_size(&f.meshes[i]);
        guarded g = guarded_new(need);
        noh_morph_layers layers = { NULL, NULL, NULL };
        noh_error error = { NOH_OK, NULL, 0, 0 };
        if (need) {
            assert_int_equal(noh_morph_layers_init(g.block, need - 1, &f.meshes[i], &layers, &error), NOH_ERR_MEMORY);
            assert_int_equal(error.need, need);
            assert_null(layers.position);
            expect_untouched(&g);
        }
        assert_int_equal(noh_morph_layers_init(g.block, need, &f.meshes[i], &layers, &error), NOH_OK);
        expect_canaries(&g);
        guarded_free(&g);
    }
    assert_int_equal(noh_morph_layers_size(&f.meshes[FIXTURE_BARE]), 0);
    fixture_meshes_close(&f);
}

static void layers_of_no_texels_need_no_memory(void **state)
{
    fixture_meshes f;
    noh_morph_layers layers = { NULL, NULL, NULL };
    (void)state;
    fixture_meshes_open(&f);
    assert_int_equal(noh_morph_layers_init(NULL, 0, &f.meshes[FIXTURE_BARE], &layers, NULL), NOH_OK);
    assert_int_equal(noh_morph_layers_init(NULL, 1000000, &f.meshes[0], &layers, NULL), NOH_ERR_ARG);
    fixture_meshes_close(&f);
}

static void misaligned_layers_are_refused(void **state)
{
    fixture_meshes f;
    noh_morph_layers layers;
    guarded g;
    (void)state;
    fixture_meshes_open(&f);
    g = guarded_new(noh_morph_layers_size(&f.meshes[0]) + NOH_MEMORY_ALIGN);
    for (size_t shift = 1; shift < NOH_MEMORY_ALIGN; shift++) {
        noh_error error = { NOH_OK, NULL, 0, 0 };
        assert_int_equal(noh_morph_layers_init(g.block + shift, g.bytes - shift, &f.meshes[0], &layers, &error),
                         NOH_ERR_ARG);
        assert_int_equal(error.need, noh_morph_layers_size(&f.meshes[0]));
    }
    expect_untouched(&g);
    guarded_free(&g);
    fixture_meshes_close(&f);
}

static void accumulating_stays_inside_its_layers(void **state)
{
    test_random r = test_random_from(2);
    fixture_meshes f;
    (void)state;
    fixture_meshes_open(&f);
    for (uint32_t i = 0; i < FIXTURE_MESHES; i++) {
        guarded g = guarded_new(noh_morph_layers_size(&f.meshes[i]));
        float weights[NOH_TARGETS_MAX];
        noh_morph_layers layers;
        test_random_weights(&r, weights, f.meshes[i].header->target_count);
        assert_int_equal(noh_morph_layers_init(g.block, g.bytes, &f.meshes[i], &layers, NULL), NOH_OK);
        noh_morph_accumulate(&f.meshes[i], weights, &layers);
        noh_morph_accumulate_scalar(&f.meshes[i], weights, &layers);
        noh_morph_accumulate_f16(&f.meshes[i], weights, NOH_HALF_RTZ, &layers);
        noh_morph_round_f16(&f.meshes[i], NOH_HALF_RNE, &layers);
        expect_canaries(&g);
        guarded_free(&g);
    }
    fixture_meshes_close(&f);
}

/* ---- noh_gl_morph, every path and format ---- */

static noh_gl_morph_desc desc_of(const fixture_meshes *f, fixture_way way)
{
    noh_gl_morph_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = f->meshes;
    desc.mesh_count = FIXTURE_MESHES;
    desc.path = way.path;
    desc.accumulate = way.accumulate;
    return desc;
}

/* 0 and a note where this GPU has no such path. */
static int can(const gpu *g, const noh_gl_morph_desc *desc, noh_gl_morph_plan *plan, fixture_way way)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_result result = noh_gl_morph_plan_make(desc, &g->caps, plan, &error);
    if (result == NOH_ERR_UNSUPPORTED) {
        print_message("# %s is not here: %s\n", fixture_way_name(way), error.what);
        return 0;
    }
    assert_int_equal(result, NOH_OK);
    return 1;
}

static void expect_one_byte_less_refused(const gpu *g, const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    guarded block = guarded_new((size_t)plan->cpu_bytes);
    noh_gl_ledger ledger, before;
    noh_gl_morph *morph = NULL;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    memset(&ledger, 0, sizeof ledger);
    before = ledger;
    assert_int_equal(noh_gl_morph_init(block.block, block.bytes - 1,
                                       &(noh_gl_device){ &g->gl, &g->caps, &ledger, NULL, 0 }, desc, &morph, &error),
                     NOH_ERR_MEMORY);
    assert_int_equal(error.need, plan->cpu_bytes);
    assert_null(morph);
    assert_memory_equal(&ledger, &before, sizeof ledger);
    expect_untouched(&block);
    guarded_free(&block);
}

static void set_all_and_update(noh_gl_morph *morph, const noh_gl_morph_desc *desc, uint64_t seed)
{
    test_random r = { seed * 77777u + 1u };
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        uint32_t count = desc->instance_counts ? desc->instance_counts[i] : 1u;
        for (uint32_t k = 0; k < count; k++) {
            float weights[NOH_TARGETS_MAX];
            test_random_weights(&r, weights, desc->meshes[i].header->target_count);
            assert_int_equal(noh_gl_morph_set_weights(morph, noh_gl_morph_instance(morph, i, k), weights, NULL),
                             NOH_OK);
        }
    }
    noh_gl_morph_update(morph, NULL);
}

/* The exact size works for a whole life, and the GPU's ledger is what the plan said. */
static void expect_exact_size_works(const gpu *g, const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    guarded block = guarded_new((size_t)plan->cpu_bytes);
    noh_gl_ledger ledger;
    noh_gl_morph *morph = NULL;
    memset(&ledger, 0, sizeof ledger);
    assert_int_equal(noh_gl_morph_init(block.block, block.bytes, &(noh_gl_device){ &g->gl, &g->caps, &ledger, NULL, 0 },
                                       desc, &morph, NULL),
                     NOH_OK);
    assert_int_equal(noh_gl_ledger_bytes(&ledger), plan->gpu_bytes);
    assert_int_equal(plan->gpu_bytes, plan->delta_bytes + plan->table_bytes + plan->stream_bytes + plan->layer_bytes);
    for (uint64_t seed = 1; seed <= 3; seed++) {
        set_all_and_update(morph, desc, seed);
    }
    assert_int_equal(noh_gl_ledger_bytes(&ledger), plan->gpu_bytes); /* updates ask for nothing */
    noh_gl_morph_delete(morph);
    assert_int_equal(noh_gl_ledger_bytes(&ledger), 0);
    expect_canaries(&block);
    guarded_free(&block);
}

static void gl_morph_in_memory(uint32_t instances_each)
{
    const uint32_t counts[FIXTURE_MESHES] = { instances_each, 2, instances_each };
    gpu *g = fixture_gpu();
    fixture_meshes f;
    fixture_meshes_open(&f);
    for (int i = 0; i < FIXTURE_WAYS; i++) {
        noh_gl_morph_desc desc = desc_of(&f, fixture_ways[i]);
        noh_gl_morph_plan plan;
        desc.instance_counts = instances_each > 1 ? counts : NULL;
        if (can(g, &desc, &plan, fixture_ways[i])) {
            assert_int_equal(plan.path, fixture_ways[i].path);
            assert_int_equal(plan.accumulate, fixture_ways[i].accumulate);
            expect_one_byte_less_refused(g, &desc, &plan);
            expect_exact_size_works(g, &desc, &plan);
        }
    }
    fixture_expect_no_errors();
    fixture_meshes_close(&f);
}

static void gl_morph_of_one_instance_is_exact(void **state)
{
    (void)state;
    gl_morph_in_memory(1);
}

static void gl_morph_of_100_instances_is_exact(void **state)
{
    (void)state;
    gl_morph_in_memory(100);
}

static void misaligned_or_no_memory_is_refused(void **state)
{
    gpu *g = fixture_gpu();
    fixture_meshes f;
    noh_gl_morph_desc desc;
    noh_gl_morph_plan plan;
    noh_gl_morph *morph = NULL;
    guarded block;
    const fixture_way cpu = { NOH_MORPH_CPU, NOH_ACCUMULATE_F32 };
    (void)state;
    fixture_meshes_open(&f);
    desc = desc_of(&f, cpu);
    assert_int_equal(noh_gl_morph_plan_make(&desc, &g->caps, &plan, NULL), NOH_OK);
    block = guarded_new((size_t)plan.cpu_bytes + 16);
    for (size_t shift = 1; shift < 16; shift++) {
        assert_int_equal(noh_gl_morph_init(block.block + shift, (size_t)plan.cpu_bytes,
                                           &(noh_gl_device){ &g->gl, &g->caps, &g->ledger, NULL, 0 }, &desc, &morph,
                                           NULL),
                         NOH_ERR_ARG);
    }
    assert_int_equal(noh_gl_morph_init(NULL, 1u << 30, &(noh_gl_device){ &g->gl, &g->caps, &g->ledger, NULL, 0 }, &desc,
                                       &morph, NULL),
                     NOH_ERR_ARG);
    expect_untouched(&block);
    guarded_free(&block);
    fixture_meshes_close(&f);
}

/* Deltas are shared by all instances: only weights, tiles and streams grow. */
static void instances_share_deltas(void **state)
{
    const uint32_t hundred[FIXTURE_MESHES] = { 100, 100, 100 };
    gpu *g = fixture_gpu();
    fixture_meshes f;
    (void)state;
    fixture_meshes_open(&f);
    for (int i = 0; i < FIXTURE_WAYS; i++) {
        noh_gl_morph_desc desc = desc_of(&f, fixture_ways[i]);
        noh_gl_morph_plan one, many;
        if (can(g, &desc, &one, fixture_ways[i])) {
            desc.instance_counts = hundred;
            assert_int_equal(noh_gl_morph_plan_make(&desc, &g->caps, &many, NULL), NOH_OK);
            assert_int_equal(many.delta_bytes, one.delta_bytes);
            assert_int_equal(many.table_bytes, one.table_bytes);
            assert_true(many.layer_bytes + many.stream_bytes > one.layer_bytes + one.stream_bytes);
            assert_true(many.layer_bytes > one.layer_bytes || many.path == NOH_MORPH_DIRECT);
        }
    }
    fixture_meshes_close(&f);
}

/* ---- descs that are wrong, one field at a time ---- */

static void expect_plan(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_result expected, const char *word)
{
    noh_gl_morph_plan plan, before;
    noh_error error = { NOH_OK, "", 0, 0 };
    memset(&plan, 0x3c, sizeof plan);
    before = plan;
    assert_int_equal(noh_gl_morph_plan_make(desc, caps, &plan, &error), expected);
    assert_non_null(strstr(error.what, word));
    assert_memory_equal(&plan, &before, sizeof plan);
}

static noh_gl_caps imagined_caps(void)
{
    noh_gl_caps caps;
    memset(&caps, 0, sizeof caps);
    caps.texture_size_max = 4096;
    caps.mrt3 = caps.render_f32 = caps.render_f16 = caps.render_u32 = caps.blend_f32 = caps.blend_f16 = caps.layered =
        1;
    return caps;
}

static void a_desc_needs_meshes(void **state)
{
    const noh_gl_caps caps = imagined_caps();
    noh_gl_morph_desc desc;
    (void)state;
    memset(&desc, 0, sizeof desc);
    expect_plan(&desc, &caps, NOH_ERR_ARG, "mesh_count is 0");
    desc.mesh_count = 1;
    expect_plan(&desc, &caps, NOH_ERR_ARG, "mesh_count is 0");
}

static void fields_of_a_desc_are_checked(void **state)
{
    const noh_gl_caps caps = imagined_caps();
    const fixture_way automatic = { NOH_MORPH_AUTO, NOH_ACCUMULATE_AUTO };
    const float wrong_shares[] = { -0.1f, 1.1f, (float)NAN };
    fixture_meshes f;
    noh_gl_morph_desc desc;
    (void)state;
    fixture_meshes_open(&f);
    desc = desc_of(&f, automatic);
    desc.path = (noh_morph_path)NOH_MORPH_PATH_COUNT;
    expect_plan(&desc, &caps, NOH_ERR_ARG, "path");
    desc = desc_of(&f, automatic);
    desc.accumulate = (noh_accumulate)3;
    expect_plan(&desc, &caps, NOH_ERR_ARG, "accumulate");
    desc = desc_of(&f, automatic);
    for (size_t i = 0; i < TEST_COUNT(wrong_shares); i++) {
        desc.expected_active = wrong_shares[i];
        expect_plan(&desc, &caps, NOH_ERR_ARG, "expected_active");
    }
    fixture_meshes_close(&f);
}

static void instance_counts_have_a_limit(void **state)
{
    const noh_gl_caps caps = imagined_caps();
    const fixture_way automatic = { NOH_MORPH_AUTO, NOH_ACCUMULATE_AUTO };
    const uint32_t none[] = { 0, 0, 0 }, many[] = { 1, NOH_MORPH_INSTANCES_MAX, 0 },
                   wrap[] = { 0xffffffffu, 0xffffffffu, 3 };
    fixture_meshes f;
    noh_gl_morph_desc desc;
    (void)state;
    fixture_meshes_open(&f);
    desc = desc_of(&f, automatic);
    desc.instance_counts = none;
    expect_plan(&desc, &caps, NOH_ERR_LIMIT, "1 to NOH_MORPH_INSTANCES_MAX");
    desc.instance_counts = many;
    expect_plan(&desc, &caps, NOH_ERR_LIMIT, "1 to NOH_MORPH_INSTANCES_MAX");
    desc.instance_counts = wrap;
    expect_plan(&desc, &caps, NOH_ERR_LIMIT, "1 to NOH_MORPH_INSTANCES_MAX");
    fixture_meshes_close(&f);
}

/* Instances are accepted as long as their tiles fit, and no longer. */
static void tiles_have_to_fit_a_texture(void **state)
{
    const fixture_way cpu = { NOH_MORPH_CPU, NOH_ACCUMULATE_F32 };
    noh_gl_caps caps = imagined_caps();
    fixture_meshes f;
    noh_gl_morph_desc desc;
    noh_gl_morph_plan plan;
    uint32_t count = 1, columns;
    (void)state;
    fixture_meshes_open(&f);
    caps.texture_size_max = 64;
    desc = desc_of(&f, cpu);
    desc.mesh_count = 1;
    desc.instance_counts = &count;
    columns = 64u >> f.meshes[0].header->morph_width_log2;
    while (noh_gl_morph_plan_make(&desc, &caps, &plan, NULL) == NOH_OK) {
        assert_in_range(plan.atlas_width, 1, 64);
        assert_in_range(plan.atlas_height, 1, 64);
        count++;
    }
    /* tiles may lie a little apart, but not by a whole tile */
    assert_in_range(count, columns * (64u / (f.meshes[0].header->morph_height + 3u)),
                    columns * (64u / f.meshes[0].header->morph_height) + 1u);
    expect_plan(&desc, &caps, NOH_ERR_LIMIT, "do not fit");
    fixture_meshes_close(&f);
}

static void weights_have_to_be_finite(void **state)
{
    const fixture_way cpu = { NOH_MORPH_CPU, NOH_ACCUMULATE_F32 };
    const float wrong[] = { (float)NAN, (float)INFINITY, -(float)INFINITY };
    fixture_meshes f;
    noh_gl_morph_desc desc;
    fixture_morph m;
    noh_gl_morph_stats stats;
    (void)state;
    fixture_meshes_open(&f);
    desc = desc_of(&f, cpu);
    fixture_morph_open(&m, &desc, NULL);
    noh_gl_morph_update(m.morph, NULL);
    for (size_t i = 0; i < TEST_COUNT(wrong); i++) {
        float weights[7] = { 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f };
        noh_error error = { NOH_OK, NULL, 0, 0 };
        weights[4] = wrong[i];
        assert_int_equal(noh_gl_morph_set_weights(m.morph, 0, weights, &error), NOH_ERR_ARG);
        assert_int_equal(error.where, 4);
        assert_non_null(strstr(error.what, "finite"));
    }
    noh_gl_morph_update(m.morph, &stats); /* nothing was changed, not even the weights before the wrong one */
    assert_int_equal(stats.instances, 0);
    fixture_expect_all(&m);
    fixture_morph_close(&m);
    fixture_meshes_close(&f);
}

/* ---- clip banks: the set with its clips and cache, controllers, poses ---- */

static void play_a_while(noh_clip_bank *set)
{
    clip_player p;
    clip_player_open(&p, set);
    for (uint32_t m = 0; m < set->clips.clip_count; m++) {
        clip_start(&p, m, NOH_LOOP_PING_PONG, 2 * NOH_SPEED_ONE, 100);
        for (int i = 0; i < 150; i++) {
            clip_frame(&p, 800, i % 2 ? 4800 : 0, 50);
        }
    }
    clip_player_close(&p);
}

static void expect_exact_view(const noh_clip_bank *set, size_t bytes)
{
    noh_transform *pose = test_zeros(sizeof *pose * (set->clips.joint_count + 1u));
    float *floats = test_zeros(sizeof *floats * (set->clips.float_count + 1u));
    noh_clip_bank_view *view = NULL;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    guarded g = guarded_new(bytes);
    assert_int_equal(noh_clip_bank_view_size(set), bytes);
    assert_int_equal(noh_clip_bank_view_init(NULL, bytes, set, &view, &error), NOH_ERR_ARG);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_clip_bank_view_init(g.block, bytes - 1, set, &view, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_clip_bank_view_init(g.block + 4, bytes, set, &view, &error), NOH_ERR_ARG);
    assert_null(view);
    expect_untouched(&g);
    assert_int_equal(noh_clip_bank_view_init(g.block, bytes, set, &view, &error), NOH_OK);
    for (uint32_t m = 0; m < set->clips.clip_count; m++) {
        const uint32_t duration = set->clips.clips[m].duration_ticks;
        for (uint32_t i = 0; i <= 100; i++) {
            view->clips.sample(view->clips.user, m, duration / 100u * i, set->clips.joint_count, pose,
                               set->clips.float_count, floats);
        }
    }
    expect_canaries(&g);
    guarded_free(&g);
    free(pose);
    free(floats);
}

static void expect_exact_set(const noh_clip_bank_desc *of)
{
    noh_clip_bank_desc desc = *of;
    noh_clip_bank_needs needs;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_clip_bank *set = NULL;
    guarded g;
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, &error), NOH_OK);
    assert_int_equal(needs.bytes, noh_clip_bank_size(&desc, NULL));
    g = guarded_new(needs.bytes);
    assert_int_equal(noh_clip_bank_init(g.block, needs.bytes - 1, &desc, &set, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, needs.bytes);
    assert_int_equal(noh_clip_bank_init(g.block + 4, needs.bytes, &desc, &set, &error), NOH_ERR_ARG);
    assert_null(set);
    expect_untouched(&g);
    assert_int_equal(noh_clip_bank_init(g.block, needs.bytes, &desc, &set, &error), NOH_OK);
    assert_int_equal(set->clips.clip_count, needs.shape.clip_count);
    assert_int_equal(set->clips.joint_count, needs.shape.joint_count);
    assert_int_equal(set->clips.float_count, needs.shape.float_count);
    play_a_while(set);
    expect_exact_view(set, needs.view_bytes);
    expect_canaries(&g);
    guarded_free(&g);
}

static void clip_banks_want_their_exact_size(void **state)
{
    const char *inputs[2];
    model *m = clip_model(7);
    size_t counts[2];
    uint8_t *made[2];
    noh_pack packs[2];
    const noh_pack *const both[2] = { &packs[0], &packs[1] };
    noh_clip_bank_desc desc;
    (void)state;
    memset(&desc, 0, sizeof desc);
    inputs[0] = clip_bvh("walk", "abcde", 100);
    inputs[1] = clip_bvh("long", "abcde", 211);
    made[0] = clip_pack(inputs, 2, NULL, &counts[0]);
    made[1] = test_pack_of(m, &counts[1], NULL);
    for (int i = 0; i < 2; i++) {
        packs[i] = test_open(made[i], counts[i]);
    }
    for (int i = 0; i < 3; i++) { /* the third: of both packs, whose clips without joints are for any skeleton */
        desc.clips = i < 2 ? &packs[i] : NULL;
        desc.clip_packs = i < 2 ? NULL : both;
        desc.clip_pack_count = i < 2 ? 0 : 2;
        for (uint32_t slots = 0; slots <= 40; slots += slots ? 13 : 2) {
            desc.cached_segment_count = slots;
            desc.root_axes = slots % 2 ? NOH_ROOT_GROUND : 0;
            expect_exact_set(&desc);
        }
    }
    desc.skeleton = NOH_NONE;
    desc.mesh = &packs[1];
    desc.cached_segment_count = desc.root_axes = 0;
    expect_exact_set(&desc);
    free(made[0]);
    free(made[1]);
    model_free(m);
}

/* ---- meshes, pictures, the renderer ---- */

static void meshes_take_what_they_say(void **state)
{
    gpu *g = fixture_gpu();
    fixture_meshes f;
    (void)state;
    fixture_meshes_open(&f);
    for (uint32_t i = 0; i < FIXTURE_MESHES; i++) {
        noh_gl_ledger ledger;
        noh_gl_mesh mesh;
        memset(&ledger, 0, sizeof ledger);
        assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, &f.meshes[i], &mesh, NULL), NOH_OK);
        assert_int_equal(noh_gl_ledger_bytes(&ledger), noh_gl_mesh_bytes(&f.meshes[i]));
        noh_gl_mesh_delete(&g->gl, &ledger, &mesh);
        assert_int_equal(noh_gl_ledger_bytes(&ledger), 0);
    }
    fixture_expect_no_errors();
    fixture_meshes_close(&f);
}

static void pictures_and_the_renderer_take_what_they_say(void **state)
{
    const test_model_desc made = { 1, 4, 1, TEST_SCENE, 1 };
    gpu *g = fixture_gpu();
    size_t count;
    uint8_t *bytes = test_pack(&made, &count);
    noh_pack pack = test_open(bytes, count);
    noh_texture texture;
    noh_gl_texture picture;
    const noh_mesh mesh = test_mesh(&pack, 0);
    const noh_gl_renderer_desc desc = { .meshes = &mesh, .mesh_count = 1 };
    const size_t size = noh_gl_renderer_size(&desc);
    uint8_t *variants = test_aligned(NULL, size);
    noh_gl_renderer renderer;
    noh_error error;
    noh_gl_ledger ledger;
    const noh_gl_device device = { &g->gl, NULL, &ledger, NULL, 0 };
    (void)state;
    memset(&ledger, 0, sizeof ledger);
    assert_int_equal(noh_pack_texture_at(&pack, 0, &texture, NULL), NOH_OK);
    assert_int_equal(noh_gl_picture_create(&g->gl, &ledger, &texture, &picture, NULL), NOH_OK);
    assert_int_equal(noh_gl_ledger_bytes(&ledger), noh_gl_picture_bytes(&texture, 1));
    assert_true(size > 0);
    memset(variants, 0x5a, size);
    assert_int_equal(noh_gl_renderer_create(&device, &desc, variants, size - 1u, &renderer, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, size);
    for (size_t i = 0; i < size; i++) assert_int_equal(variants[i], 0x5a);
    assert_int_equal(noh_gl_renderer_create(&device, &desc, variants, size, &renderer, NULL), NOH_OK);
    assert_int_equal(size, renderer.variant_count * sizeof *renderer.variants);
    assert_int_equal(noh_gl_ledger_bytes(&ledger), noh_gl_picture_bytes(&texture, 1) + NOH_GL_RENDERER_BYTES);
    noh_gl_renderer_delete(&renderer);
    noh_gl_texture_delete(&g->gl, &ledger, &picture);
    assert_int_equal(noh_gl_ledger_bytes(&ledger), 0);
    assert_int_equal(ledger.programs + ledger.textures, 0);
    fixture_expect_no_errors();
    free(variants);
    free(bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(arena_measures_what_it_carves),
    cmocka_unit_test(arena_fails_at_every_size_that_is_too_small),
    cmocka_unit_test(arena_survives_impossible_sizes),
    cmocka_unit_test(layers_want_their_exact_size),
    cmocka_unit_test(layers_of_no_texels_need_no_memory),
    cmocka_unit_test(misaligned_layers_are_refused),
    cmocka_unit_test(accumulating_stays_inside_its_layers),
    cmocka_unit_test(gl_morph_of_one_instance_is_exact),
    cmocka_unit_test(gl_morph_of_100_instances_is_exact),
    cmocka_unit_test(misaligned_or_no_memory_is_refused),
    cmocka_unit_test(instances_share_deltas),
    cmocka_unit_test(a_desc_needs_meshes),
    cmocka_unit_test(fields_of_a_desc_are_checked),
    cmocka_unit_test(instance_counts_have_a_limit),
    cmocka_unit_test(tiles_have_to_fit_a_texture),
    cmocka_unit_test(weights_have_to_be_finite),
    cmocka_unit_test(clip_banks_want_their_exact_size),
    cmocka_unit_test(meshes_take_what_they_say),
    cmocka_unit_test(pictures_and_the_renderer_take_what_they_say),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
