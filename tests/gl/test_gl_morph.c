/* Accumulation on the GPU: every path and format, of three layers and of two, against the CPU reference, value for
 * value; what is not accumulated again; and what happens when capabilities are missing. */
#include "support/gl_fixture.h"
#include "deform/morph/morph_internal.h"
#include "gl/morph/gl_morph_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static fixture_meshes set;

static int set_up(void **state)
{
    (void)state;
    fixture_meshes_open(&set);
    return 0;
}

static int tear_down(void **state)
{
    fixture_meshes_close(&set);
    return fixture_tear_down(state);
}

static const uint32_t few[FIXTURE_MESHES] = { 3, 2, 4 };

static noh_gl_morph_desc desc_of(fixture_way way)
{
    noh_gl_morph_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = set.meshes;
    desc.mesh_count = FIXTURE_MESHES;
    desc.instance_counts = few;
    desc.path = way.path;
    desc.accumulate = way.accumulate;
    return desc;
}

/* Open an accumulator in this way, or say that it cannot run here. as_gpu: as where nothing is known of the renderer,
 * whose GPU's paths draw quads instead of points and have narrower delta texels. */
static int open_way(fixture_morph *m, noh_gl_morph_desc *desc, fixture_way way, int without_tangents, int as_gpu)
{
    noh_gl_morph_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    gpu *g = fixture_gpu();
    noh_gl_caps caps = g->caps;
    *desc = desc_of(way);
    desc->without_tangents = without_tangents;
    if (as_gpu) strcpy(caps.renderer, "a GPU");
    if (as_gpu && way.path == NOH_MORPH_CPU) return 0; /* the same */
    if (noh_gl_morph_plan_make(desc, &caps, &plan, &error) == NOH_ERR_UNSUPPORTED) {
        print_message("# %s is not here: %s\n", fixture_way_name(way), error.what);
        return 0;
    }
    fixture_morph_open(m, desc, &caps);
    assert_true(!as_gpu || (!m->plan.points && !m->plan.wide));
    return 1;
}

typedef void (*way_test)(fixture_morph *m);

static void for_every_way(way_test test)
{
    int ran = 0;
    for (int i = 0; i < 4 * FIXTURE_WAYS; i++) {
        noh_gl_morph_desc desc;
        fixture_morph m;
        if (open_way(&m, &desc, fixture_ways[i / 4], i % 2, i / 2 % 2)) {
            assert_int_equal(m.plan.layer_count, i % 2 ? 2 : 3);
            test(&m);
            fixture_morph_close(&m);
            fixture_expect_no_errors();
            ran++;
        }
    }
    assert_in_range(ran, 4, 4 * FIXTURE_WAYS); /* the CPU's two, each with and without tangents, run everywhere */
}

static noh_gl_morph_stats update(fixture_morph *m)
{
    noh_gl_morph_stats stats;
    noh_gl_morph_update(m->morph, &stats);
    return stats;
}

static uint32_t passes_of(const fixture_morph *m)
{
    const int has_passes = m->plan.path != NOH_MORPH_CPU && m->plan.path != NOH_MORPH_DIRECT;
    return !has_passes ? 0 : m->plan.path == NOH_MORPH_PER_LAYER ? m->plan.layer_count : 1;
}

static void set_all_random(fixture_morph *m, test_random *r)
{
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        fixture_set_random(m, i, r);
    }
}

/* ---- equal to the CPU ---- */

static void check_random_weights(fixture_morph *m)
{
    test_random r = { 61 };
    for (int round = 0; round < 4; round++) {
        set_all_random(m, &r);
        update(m);
        fixture_expect_all(m);
    }
}

/* What does not fit into a draw is drawn by the next. */
static void check_few_at_a_time(fixture_morph *m)
{
    test_random r = { 63 };
    if (!passes_of(m) || m->plan.path == NOH_MORPH_GATHER) return;
    const uint32_t most = m->morph->batch.entries;
    m->morph->batch.entries = m->plan.points ? 64 : 5;
    set_all_random(m, &r);
    assert_true(update(m).draws > 2u * passes_of(m));
    fixture_expect_all(m);
    m->morph->batch.entries = most;
}

static void draws_follow_each_other(void **state)
{
    (void)state;
    for_every_way(check_few_at_a_time);
}

static void every_way_equals_the_cpu(void **state)
{
    (void)state;
    for_every_way(check_random_weights);
}

static void check_weights_back_and_forth(fixture_morph *m)
{
    test_random r = { 62 };
    int exact;
    float *first, *again;
    set_all_random(m, &r);
    update(m);
    first = fixture_reference(m, 0, &exact);
    for (int round = 0; round < 20; round++) { /* every sum begins at zero, so nothing drifts */
        float saved[7];
        memcpy(saved, m->weights[0], sizeof saved);
        fixture_set_random(m, 0, &r);
        update(m);
        fixture_set(m, 0, saved);
        update(m);
    }
    again = fixture_reference(m, 0, &exact);
    test_same_floats(again, first, noh_morph_layers_size(fixture_mesh_of(m, 0)) / 4, "the reference");
    fixture_expect_all(m);
    free(first);
    free(again);
}

static void sums_do_not_drift(void **state)
{
    (void)state;
    for_every_way(check_weights_back_and_forth);
}

static void check_first_update(fixture_morph *m)
{
    noh_gl_morph_stats stats = update(m); /* a new texture may hold anything: it must be cleared */
    assert_int_equal(stats.instances, m->plan.instance_count);
    fixture_expect_all(m);
}

static void instances_start_at_rest(void **state)
{
    (void)state;
    for_every_way(check_first_update);
}

/* The vertices after the fetch of the vertex shader. */
static void check_fetched(fixture_morph *m)
{
    gpu *g = fixture_gpu();
    test_random r = { 63 };
    uint32_t instance = noh_gl_morph_instance(m->morph, 2, 1);
    const noh_mesh *mesh = &set.meshes[2];
    size_t floats = 3u * (size_t)mesh->header->vertex_count;
    float *positions = test_zeros(4 * floats), *normals = test_zeros(4 * floats), *tangents = test_zeros(4 * floats);
    noh_gl_morph_binding binding = noh_gl_morph_binding_of(m->morph, instance);
    noh_gl_ledger ledger;
    noh_gl_mesh gl_mesh;
    noh_morph_layers layers;
    readback back;
    int exact;
    memset(&ledger, 0, sizeof ledger);
    fixture_set_random(m, instance, &r);
    update(m);
    layers.position = fixture_reference(m, instance, &exact);
    layers.normal = layers.position + noh_morph_layers_size(mesh) / 12;
    layers.tangent = m->plan.layer_count == 3 ? layers.normal + noh_morph_layers_size(mesh) / 12 : NULL;
    assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, mesh, &gl_mesh, NULL), NOH_OK);
    assert_int_equal(readback_open(&back, g, binding.is_uint), 0);
    assert_int_equal(readback_vertices(&back, &gl_mesh, &binding, positions, normals, tangents), 0);
    for (uint32_t v = 0; v < mesh->header->vertex_count && exact; v++) {
        noh_vertex expected;
        noh_morph_vertex(mesh, &layers, v, &expected);
        for (uint32_t c = 0; c < 3; c++) {
            assert_true(positions[3 * v + c] == expected.position[c]);
            assert_true(fabsf(normals[3 * v + c] - expected.normal[c]) <= 1e-5f);
            assert_true(fabsf(tangents[3 * v + c] - expected.tangent[c]) <= 1e-5f);
        }
    }
    readback_close(&back);
    noh_gl_mesh_delete(&g->gl, &ledger, &gl_mesh);
    free(layers.position);
    free(positions);
    free(normals);
    free(tangents);
}

static void vertices_are_fetched_as_the_cpu_makes_them(void **state)
{
    (void)state;
    for_every_way(check_fetched);
}

/* ---- only what changed ---- */

static void check_one_dirty(fixture_morph *m)
{
    test_random r = { 64 };
    set_all_random(m, &r);
    update(m);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        noh_gl_morph_stats stats;
        if (!fixture_mesh_of(m, i)->header->target_count) {
            continue;
        }
        fixture_set_random(m, i, &r);
        stats = update(m);
        assert_int_equal(stats.instances, 1);
        fixture_expect_all(m); /* the others kept their sums */
    }
}

static void only_the_changed_instance_is_accumulated(void **state)
{
    (void)state;
    for_every_way(check_one_dirty);
}

static void check_unchanged(fixture_morph *m)
{
    test_random r = { 65 };
    noh_gl_morph_stats stats, zero;
    memset(&zero, 0, sizeof zero);
    set_all_random(m, &r);
    update(m);
    stats = update(m);
    assert_memory_equal(&stats, &zero, sizeof zero);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        fixture_set(m, i, m->weights[i]); /* the same again */
    }
    stats = update(m);
    assert_memory_equal(&stats, &zero, sizeof zero);
    fixture_expect_all(m);
}

static void unchanged_weights_draw_nothing(void **state)
{
    (void)state;
    for_every_way(check_unchanged);
}

static void check_zero(fixture_morph *m)
{
    const float zeros[7] = { 0 };
    test_random r = { 66 };
    noh_gl_morph_stats stats;
    set_all_random(m, &r);
    update(m);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        fixture_set(m, i, zeros);
    }
    stats = update(m);
    assert_int_equal(stats.targets, 0);
    if (m->plan.path != NOH_MORPH_GATHER) { /* it writes zeros by drawing */
        assert_int_equal(stats.draws + stats.rects + stats.texels + stats.pairs, 0);
    }
    fixture_expect_all(m);
}

static void zero_weights_are_not_drawn_but_cleared(void **state)
{
    (void)state;
    for_every_way(check_zero);
}

static void check_draws(fixture_morph *m)
{
    test_random r = { 67 };
    noh_gl_morph_stats stats;
    noh_morph_cost sum = { 0, 0, 0, 0 };
    set_all_random(m, &r);
    stats = update(m);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        noh_morph_cost cost = noh_morph_cost_of(fixture_mesh_of(m, i), m->weights[i]);
        sum.targets += cost.targets;
        sum.rects += cost.rects;
        sum.texels += cost.texels;
        sum.pairs += cost.pairs;
    }
    assert_int_equal(stats.draws, passes_of(m)); /* one draw per pass for all instances of all meshes */
    assert_int_equal(stats.targets, sum.targets);
    assert_int_equal(stats.rects, sum.rects);
    assert_int_equal(stats.texels, sum.texels);
    assert_int_equal(stats.pairs, sum.pairs);
}

static void everything_is_one_draw_per_pass(void **state)
{
    (void)state;
    for_every_way(check_draws);
}

/* ---- sizes beyond the small meshes ---- */

/* More rectangles and pairs than are sent at once at load (gl_morph_internal.h). */
static void large_meshes_are_sent_in_chunks(void **state)
{
    const test_model_desc made = { 1, 70, 40, 0, 68 };
    size_t count;
    uint8_t *bytes = test_pack(&made, &count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    gpu *g = fixture_gpu();
    test_random r = test_random_from(68);
    (void)state;
    assert_true(mesh.header->rect_count > 256 && mesh.header->pair_count > 2 * 2048);
    for (int i = 0; i < FIXTURE_WAYS; i++) {
        noh_gl_morph_desc desc = desc_of(fixture_ways[i]);
        noh_gl_morph_plan plan;
        fixture_morph m;
        desc.meshes = &mesh;
        desc.mesh_count = 1;
        desc.instance_counts = NULL;
        if (noh_gl_morph_plan_make(&desc, &g->caps, &plan, NULL) == NOH_OK) {
            fixture_morph_open(&m, &desc, NULL);
            fixture_set_random(&m, 0, &r);
            update(&m);
            fixture_expect_all(&m);
            fixture_morph_close(&m);
        }
    }
    fixture_expect_no_errors();
    free(bytes);
}

static void set_all_active(fixture_morph *m, test_random *r)
{
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        float weights[7];
        for (int t = 0; t < 7; t++) {
            weights[t] = test_random_float(r, 0.5f, 1.0f); /* none is 0: all staging is used */
        }
        fixture_set(m, i, weights);
    }
}

/* The kept weights are still those that were set: nothing overwrote them. */
static void expect_weights_kept(fixture_morph *m)
{
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        fixture_set(m, i, m->weights[i]);
    }
    assert_int_equal(update(m).instances, 0);
}

/* Every target of every instance at once: the most that one update can send. */
static void a_crowd_with_every_target_active_works(void **state)
{
    const uint32_t crowd[FIXTURE_MESHES] = { 60, 1, 60 };
    gpu *g = fixture_gpu();
    test_random r = test_random_from(74);
    (void)state;
    for (int i = 0; i < FIXTURE_WAYS; i++) {
        noh_gl_morph_desc desc = desc_of(fixture_ways[i]);
        noh_gl_morph_plan plan;
        fixture_morph m;
        desc.instance_counts = crowd;
        if (noh_gl_morph_plan_make(&desc, &g->caps, &plan, NULL) == NOH_OK) {
            fixture_morph_open(&m, &desc, NULL);
            set_all_active(&m, &r);
            update(&m);
            expect_weights_kept(&m);
            fixture_expect_all(&m);
            fixture_morph_close(&m);
        }
    }
    fixture_expect_no_errors();
}

/* More weights than 16 bits can count. */
static void very_many_instances_work(void **state)
{
    const uint32_t many[FIXTURE_MESHES] = { 9400, 1, 1 };
    static const noh_morph_path paths[] = { NOH_MORPH_MRT, NOH_MORPH_GATHER };
    gpu *g = fixture_gpu();
    test_random r = test_random_from(69);
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(paths); i++) {
        const fixture_way way = { paths[i], NOH_ACCUMULATE_F32 };
        noh_gl_morph_desc desc = desc_of(way);
        noh_gl_morph_plan plan;
        fixture_morph m;
        desc.instance_counts = many;
        if (noh_gl_morph_plan_make(&desc, &g->caps, &plan, NULL) != NOH_OK) {
            continue;
        }
        assert_true(plan.weight_count > 65536);
        fixture_morph_open(&m, &desc, NULL);
        set_all_active(&m, &r);
        update(&m);
        expect_weights_kept(&m);
        for (uint32_t k = 0; k < plan.instance_count; k += 571) {
            fixture_set_random(&m, k, &r);
        }
        update(&m);
        for (uint32_t k = 0; k < plan.instance_count; k += 571) {
            fixture_expect_instance(&m, k);
            fixture_expect_instance(&m, k + 1);
        }
        fixture_expect_instance(&m, plan.instance_count - 1);
        fixture_morph_close(&m);
    }
    fixture_expect_no_errors();
}

static void a_set_without_any_target_works(void **state)
{
    (void)state;
    for (int i = 0; i < FIXTURE_WAYS; i++) {
        noh_gl_morph_desc desc = desc_of(fixture_ways[i]);
        noh_gl_morph_plan plan;
        noh_gl_morph_stats stats;
        fixture_morph m;
        desc.meshes = &set.meshes[FIXTURE_BARE];
        desc.mesh_count = 1;
        if (noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, NULL) != NOH_OK) {
            continue;
        }
        fixture_morph_open(&m, &desc, NULL);
        stats = update(&m);
        assert_int_equal(stats.draws, 0);
        fixture_morph_close(&m);
        fixture_expect_no_errors();
    }
}

/* direct: each block of an instance's texels has a start of its own. */
static void check_starts(fixture_morph *m)
{
    uint32_t end = 0;
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh_header *h = fixture_mesh_of(m, i)->header;
        noh_gl_morph_binding b = noh_gl_morph_binding_of(m->morph, i);
        const uint32_t first = (uint32_t)(b.tile_x | b.tile_y << 16);
        assert_true(b.is_uint == NOH_LAYERS_DIRECT && !b.texture && b.tables[0] && b.tables[1] && b.tables[2]);
        assert_int_equal(b.width_log2, h->morph_width_log2); /* and tables of 256 texels across */
        assert_int_equal(b.touched, h->touched_count);
        if (!h->touched_count) continue;
        assert_int_equal(first, end);
        end += (h->morph_height + 3u) / 4u << (h->morph_width_log2 - 2u);
    }
}

static void check_tiles(fixture_morph *m)
{
    uint8_t *owner;
    if (m->plan.path == NOH_MORPH_DIRECT) {
        check_starts(m);
        return;
    }
    owner = test_zeros((size_t)m->plan.atlas_width * m->plan.atlas_height);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh_header *h = fixture_mesh_of(m, i)->header;
        noh_gl_morph_binding b = noh_gl_morph_binding_of(m->morph, i);
        assert_int_equal(b.width_log2, h->morph_width_log2);
        assert_int_equal(b.touched, h->touched_count);
        for (uint32_t v = 0; v < h->touched_count; v++) {
            uint32_t x = (uint32_t)b.tile_x + (v & ((1u << h->morph_width_log2) - 1u));
            uint32_t y = (uint32_t)b.tile_y + (v >> h->morph_width_log2);
            assert_true(x < m->plan.atlas_width && y < m->plan.atlas_height);
            assert_int_equal(owner[(size_t)y * m->plan.atlas_width + x], 0);
            owner[(size_t)y * m->plan.atlas_width + x] = 1;
        }
    }
    free(owner);
}

static void tiles_do_not_overlap(void **state)
{
    (void)state;
    for_every_way(check_tiles);
}

/* ---- the state that is promised after an update ---- */

/* A game's own state must not leak into the sums, and stays. test_gl_state.c has all of it. */
static void check_state(fixture_morph *m)
{
    static const GLenum bindings[] = { GL_VERTEX_ARRAY_BINDING, GL_CURRENT_PROGRAM, GL_ARRAY_BUFFER_BINDING };
    static const GLenum switches[] = { GL_BLEND, GL_SCISSOR_TEST, GL_DEPTH_TEST, GL_CULL_FACE };
    gpu *g = fixture_gpu();
    test_random r = { 70 };
    GLint viewport[4] = { 0, 0, 0, 0 };
    set_all_random(m, &r);
    for (size_t i = 0; i < TEST_COUNT(switches); i++) g->gl.Enable(switches[i]);
    g->gl.Scissor(0, 0, 1, 1);
    g->gl.CullFace(GL_FRONT_AND_BACK);
    g->gl.BlendFunc(GL_ZERO, GL_ZERO);
    g->gl.BlendEquation(GL_FUNC_REVERSE_SUBTRACT);
    g->gl.Viewport(3, 3, 2, 2);
    update(m);
    for (size_t i = 0; i < TEST_COUNT(bindings); i++) {
        GLint name = -1;
        g->gl.GetIntegerv(bindings[i], &name);
        assert_int_equal(name, 0);
    }
    for (size_t i = 0; i < TEST_COUNT(switches); i++) {
        assert_true(g->gl.IsEnabled(switches[i]));
        g->gl.Disable(switches[i]);
    }
    g->gl.GetIntegerv(GL_VIEWPORT, viewport);
    assert_int_equal(viewport[0], 3);
    assert_int_equal(viewport[3], 2);
    g->gl.CullFace(GL_BACK);
    g->gl.BlendFunc(GL_ONE, GL_ZERO);
    g->gl.BlendEquation(GL_FUNC_ADD);
    for (GLenum unit = 0; unit < 3; unit++) {
        GLint flat = -1, array = -1;
        g->gl.ActiveTexture(GL_TEXTURE0 + unit);
        g->gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &flat);
        g->gl.GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &array);
        assert_int_equal(flat, 0);
        assert_int_equal(array, 0);
    }
    g->gl.ActiveTexture(GL_TEXTURE0);
    fixture_expect_all(m);
}

static void foreign_state_stays_and_does_not_matter(void **state)
{
    (void)state;
    for_every_way(check_state);
}

/* ---- capabilities that are missing ---- */

typedef struct lacking {
    noh_morph_path path;
    noh_accumulate accumulate;
    const char *field; /* what is cleared */
    const char *word;  /* what the error names */
} lacking;

static void clear_cap(noh_gl_caps *caps, const char *field)
{
    const struct {
        const char *name;
        int *flag;
    } flags[] = { { "mrt3", &caps->mrt3 },
                  { "layered", &caps->layered },
                  { "blend_f32", &caps->blend_f32 },
                  { "blend_f16", &caps->blend_f16 },
                  { "render_f16", &caps->render_f16 },
                  { "render_f32", &caps->render_f32 },
                  { "render_u32", &caps->render_u32 } };
    for (size_t i = 0; i < TEST_COUNT(flags); i++) {
        if (strstr(field, flags[i].name)) {
            *flags[i].flag = 0;
        }
    }
}

static void forced_paths_name_what_is_missing(void **state)
{
    static const lacking cases[] = { { NOH_MORPH_LAYERED, NOH_ACCUMULATE_F32, "layered", "EXT_geometry_shader" },
                                     { NOH_MORPH_LAYERED, NOH_ACCUMULATE_F32, "blend_f32", "EXT_float_blend" },
                                     { NOH_MORPH_LAYERED, NOH_ACCUMULATE_F16, "blend_f16",
                                       "EXT_color_buffer_half_float" },
                                     { NOH_MORPH_MRT, NOH_ACCUMULATE_F32, "blend_f32", "EXT_float_blend" },
                                     { NOH_MORPH_MRT, NOH_ACCUMULATE_F16, "blend_f16", "RGBA16F" },
                                     { NOH_MORPH_MRT, NOH_ACCUMULATE_F32, "mrt3", "three draw buffers" },
                                     { NOH_MORPH_PER_LAYER, NOH_ACCUMULATE_F32, "blend_f32", "RGBA32F" },
                                     { NOH_MORPH_PER_LAYER, NOH_ACCUMULATE_F16, "blend_f16", "RGBA16F" },
                                     { NOH_MORPH_GATHER, NOH_ACCUMULATE_F32, "mrt3", "three draw buffers" },
                                     { NOH_MORPH_GATHER, NOH_ACCUMULATE_F16, "render_f16", "RGBA16F" },
                                     { NOH_MORPH_GATHER, NOH_ACCUMULATE_F32, "render_f32 render_u32", "RGBA32UI" } };
    gpu *g = fixture_gpu();
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        const fixture_way way = { cases[i].path, cases[i].accumulate };
        noh_gl_morph_desc desc = desc_of(way);
        noh_gl_caps caps = g->caps;
        noh_gl_morph_plan plan;
        noh_error error = { NOH_OK, "", 0, 0 };
        noh_gl_morph *morph = NULL;
        uint8_t memory[16];
        caps.mrt3 = caps.layered = caps.blend_f32 = caps.blend_f16 = caps.render_f16 = caps.render_f32 =
            caps.render_u32 = 1;
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
        clear_cap(&caps, cases[i].field);
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, &error), NOH_ERR_UNSUPPORTED);
        if (!strstr(error.what, cases[i].word)) {
            fail_msg("%s without %s: '%s' does not name %s", fixture_way_name(way), cases[i].field, error.what,
                     cases[i].word);
        }
        assert_int_equal(noh_gl_morph_init(memory, sizeof memory,
                                           &(noh_gl_device){ &g->gl, &caps, &g->ledger, NULL, 0 }, &desc, &morph,
                                           &error),
                         NOH_ERR_UNSUPPORTED);
        assert_null(morph);
    }
}

typedef struct falling {
    const char *cleared;
    noh_accumulate accumulate;
    float active;
    noh_morph_path path;
    GLenum format;
} falling;

/* The choice of AUTO as capabilities are taken away, one after the other; the sums are right each time. */
static void automatic_falls_to_the_next_path(void **state)
{
    static const falling cases[] = {
        { "", NOH_ACCUMULATE_F32, 0.05f, NOH_MORPH_GATHER, GL_RGBA32F },
        { "layered", NOH_ACCUMULATE_F32, 0.05f, NOH_MORPH_GATHER, GL_RGBA32F },
        { "blend_f32", NOH_ACCUMULATE_F32, 0.05f, NOH_MORPH_GATHER, GL_RGBA32F },
        { "blend_f32 render_f32", NOH_ACCUMULATE_F32, 0.05f, NOH_MORPH_GATHER, GL_RGBA32UI },
        { "mrt3", NOH_ACCUMULATE_F32, 0.05f, NOH_MORPH_PER_LAYER, GL_RGBA32F },
        { "mrt3 blend_f32", NOH_ACCUMULATE_F32, 0.05f, NOH_MORPH_CPU, GL_RGB32F },
        { "blend_f32 render_f32 render_u32", NOH_ACCUMULATE_F32, 0.05f, NOH_MORPH_CPU, GL_RGB32F },
        { "", NOH_ACCUMULATE_F16, 0.05f, NOH_MORPH_GATHER, GL_RGBA16F },
        { "render_f16", NOH_ACCUMULATE_F16, 0.05f, NOH_MORPH_MRT, GL_RGBA16F },
        { "blend_f16", NOH_ACCUMULATE_F16, 0.05f, NOH_MORPH_GATHER, GL_RGBA16F },
        { "blend_f16 render_f16", NOH_ACCUMULATE_F16, 0.05f, NOH_MORPH_CPU, GL_RGB16F }
    };
    gpu *g = fixture_gpu();
    test_random r = test_random_from(72);
    (void)state;
    if (!g->caps.blend_f32 || !g->caps.mrt3 || !g->caps.render_f16) {
        test_skip("this driver lacks more than the test takes away");
    }
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        const fixture_way way = { NOH_MORPH_AUTO, cases[i].accumulate };
        noh_gl_morph_desc desc = desc_of(way);
        noh_gl_caps caps = g->caps;
        fixture_morph m;
        strcpy(caps.renderer, "a GPU"); /* not a software rasteriser */
        clear_cap(&caps, cases[i].cleared);
        desc.expected_active = cases[i].active;
        desc.without_direct = 1;
        fixture_morph_open(&m, &desc, &caps);
        if (m.plan.path != cases[i].path || m.plan.layer_format != cases[i].format) {
            fail_msg("without '%s', %g active: %s (%s)", cases[i].cleared, (double)cases[i].active,
                     noh_morph_path_name(m.plan.path), m.plan.reason);
        }
        assert_non_null(strstr(m.plan.reason, noh_morph_path_name(cases[i].path)));
        set_all_random(&m, &r);
        update(&m);
        fixture_expect_all(&m);
        fixture_morph_close(&m);
        fixture_expect_no_errors();
    }
}

/* The policy `blend`: layered draws where supported, per-layer passes otherwise, whatever else could run, on software
 * GL too; every sum has the bits of the CPU. Without blending it is refused, and the error says what is missing. */
static void blending_is_layered_or_per_layer(void **state)
{
    static const struct {
        const char *cleared;
        noh_accumulate accumulate;
        noh_morph_path path;
    } cases[] = { { "", NOH_ACCUMULATE_F32, NOH_MORPH_LAYERED },
                  { "", NOH_ACCUMULATE_F16, NOH_MORPH_LAYERED },
                  { "layered", NOH_ACCUMULATE_F32, NOH_MORPH_PER_LAYER },
                  { "layered", NOH_ACCUMULATE_F16, NOH_MORPH_PER_LAYER },
                  { "mrt3", NOH_ACCUMULATE_F32, NOH_MORPH_LAYERED },
                  { "mrt3 layered render_u32", NOH_ACCUMULATE_F32, NOH_MORPH_PER_LAYER } };
    gpu *g = fixture_gpu();
    test_random r = test_random_from(74);
    const fixture_way blend = { NOH_MORPH_BLEND, NOH_ACCUMULATE_F32 };
    noh_gl_morph_desc refused = desc_of(blend);
    noh_gl_morph_plan plan;
    noh_gl_caps bare = g->caps;
    noh_error error = { NOH_OK, "", 0, 0 };
    (void)state;
    clear_cap(&bare, "blend_f32");
    assert_int_equal(noh_gl_morph_plan_make(&refused, &bare, &plan, &error), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.what, "EXT_float_blend"));
    if (!g->caps.blend_f32 || !g->caps.blend_f16 || !g->caps.layered) {
        test_skip("this driver lacks more than the test takes away");
    }
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        const fixture_way way = { NOH_MORPH_BLEND, cases[i].accumulate };
        noh_gl_morph_desc desc = desc_of(way);
        noh_gl_caps caps = g->caps;
        fixture_morph m;
        noh_gl_morph_stats stats;
        clear_cap(&caps, cases[i].cleared);
        fixture_morph_open(&m, &desc, &caps);
        assert_int_equal(m.plan.path, cases[i].path);
        assert_non_null(strstr(m.plan.reason, noh_morph_path_name(cases[i].path)));
        set_all_random(&m, &r);
        stats = update(&m);
        assert_int_equal(stats.draws, cases[i].path == NOH_MORPH_LAYERED ? 1 : 3);
        fixture_expect_all(&m);
        fixture_morph_close(&m);
        fixture_expect_no_errors();
    }
}

/* AUTO takes gather, whatever is active, unless rectangles are single texels far apart; where layers do not fit the
 * tile memory, or hardly anything is active and the clear is what counts, then too. */
static void automatic_weighs_blending_against_lists(void **state)
{
    static const struct {
        const char *renderer;
        uint32_t apart;
        float active;
        noh_morph_path path;
    } cases[] = { { "a GPU", 0, 1.0f, NOH_MORPH_GATHER },
                  { "a GPU", 0, 0.05f, NOH_MORPH_GATHER },
                  { "a GPU", 1, 1.0f, NOH_MORPH_MRT },
                  { "a GPU", 1, 0.01f, NOH_MORPH_GATHER },
                  { "Apple A8 GPU", 1, 1.0f, NOH_MORPH_GATHER } };
    noh_mesh_header header = *set.meshes[0].header;
    noh_mesh scattered = set.meshes[0];
    noh_target targets[7];
    static noh_rect rects[7 * 8];
    (void)state;
    assert_int_equal(header.target_count, 7);
    memcpy(targets, scattered.targets, sizeof targets);
    for (uint32_t t = 0; t < 7; t++) {
        targets[t].first_rect = 8 * t;
        targets[t].rect_count = 8;
        for (uint32_t r = 0; r < 8; r++) rects[8 * t + r] = (noh_rect){ 0, (uint16_t)(4 * r), 1, 1 };
    }
    header.rect_count = header.texel_count = header.pair_count = 7 * 8;
    header.touched_count = 8;
    scattered.header = &header;
    scattered.targets = targets;
    scattered.rects = rects;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        const fixture_way way = { NOH_MORPH_AUTO, NOH_ACCUMULATE_AUTO };
        noh_gl_morph_desc desc = desc_of(way);
        noh_gl_caps caps = fixture_gpu()->caps;
        noh_gl_morph_plan plan;
        caps.mrt3 = caps.blend_f32 = caps.render_f32 = 1;
        strcpy(caps.renderer, cases[i].renderer);
        desc.meshes = cases[i].apart ? &scattered : &set.meshes[2];
        desc.mesh_count = 1;
        desc.instance_counts = NULL;
        desc.expected_active = cases[i].active;
        desc.without_direct = 1;
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
        if (plan.path != cases[i].path || (plan.costs.gather <= plan.costs.mrt) != (plan.path == NOH_MORPH_GATHER)) {
            fail_msg("case %u: %s; mrt %g, gather %g", (unsigned)i, plan.reason, (double)plan.costs.mrt,
                     (double)plan.costs.gather);
        }
    }
}

/* AUTO sums in the draws where that costs less than a pass with what draws then fetch: few draws, few entries for a
 * block, or a pass for a single instance. A desc can exclude it, and halves do. */
static void automatic_weighs_draws_against_a_pass(void **state)
{
    static const uint32_t one[1] = { 1 }, many[1] = { 400 };
    static const struct {
        uint32_t draws;
        const uint32_t *instances;
        float active;
        noh_accumulate accumulate;
        int without, direct;
    } cases[] = { { 0, one, 0.5f, NOH_ACCUMULATE_AUTO, 0, 1 },    { 1, one, 0.05f, NOH_ACCUMULATE_AUTO, 0, 1 },
                  { 1, one, 0.05f, NOH_ACCUMULATE_AUTO, 1, 0 },   { 1, one, 0.05f, NOH_ACCUMULATE_F16, 0, 0 },
                  { 1000, one, 0.5f, NOH_ACCUMULATE_AUTO, 0, 0 }, { 1, many, 0.05f, NOH_ACCUMULATE_AUTO, 0, 1 },
                  { 3, many, 1.0f, NOH_ACCUMULATE_AUTO, 0, 0 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        noh_gl_morph_desc desc = { .meshes = &set.meshes[2], .mesh_count = 1, .draws = cases[i].draws };
        noh_gl_morph_plan plan;
        noh_gl_caps caps;
        float other;
        noh_gl_caps_nominal(&caps);
        desc.instance_counts = cases[i].instances;
        desc.expected_active = cases[i].active;
        desc.accumulate = cases[i].accumulate;
        desc.without_direct = cases[i].without;
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
        other = plan.costs.gather < plan.costs.mrt ? plan.costs.gather : plan.costs.mrt;
        if ((plan.path == NOH_MORPH_DIRECT) != cases[i].direct ||
            (!cases[i].without && !cases[i].accumulate && (plan.costs.direct < other) != cases[i].direct)) {
            fail_msg("case %u: %s; direct %g, gather %g, mrt %g", (unsigned)i, plan.reason, (double)plan.costs.direct,
                     (double)plan.costs.gather, (double)plan.costs.mrt);
        }
        assert_int_equal(plan.costs.draws, cases[i].draws ? cases[i].draws : 1);
        assert_true(plan.path != NOH_MORPH_DIRECT || !plan.layer_bytes);
    }
}

static noh_gl_morph_costs costs_of(const char *renderer, const noh_mesh *meshes, uint32_t count, float active)
{
    const noh_gl_morph_desc desc = { .meshes = meshes, .mesh_count = count, .expected_active = active };
    noh_gl_morph_plan plan;
    noh_gl_caps caps;
    noh_gl_caps_nominal(&caps);
    strcpy(caps.renderer, renderer);
    assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
    return plan.costs;
}

/* Twice the meshes cost twice as much, except for the passes of a GPU, which all instances of an update share; and each
 * path costs more with more active targets. */
static void costs_add_up(void **state)
{
    static const char *const renderers[] = { "a GPU", "llvmpipe", "Apple A8 GPU" };
    noh_mesh meshes[2];
    (void)state;
    meshes[0] = meshes[1] = set.meshes[2];
    for (size_t i = 0; i < TEST_COUNT(renderers); i++) {
        const noh_gl_morph_costs one = costs_of(renderers[i], meshes, 1, 0.5f),
                                 two = costs_of(renderers[i], meshes, 2, 0.5f),
                                 all = costs_of(renderers[i], meshes, 1, 1.0f);
        assert_float_equal(two.cpu, 2.0f * one.cpu, 1e-3f * one.cpu);
        assert_float_equal(two.direct, 2.0f * one.direct, 1e-3f * one.direct);
        if (i == 1) assert_float_equal(two.gather, 2.0f * one.gather, 1e-3f * one.gather);
        if (i == 1) assert_float_equal(two.mrt, 2.0f * one.mrt, 1e-3f * one.mrt);
        assert_true(all.cpu > 1.01f * one.cpu && all.gather > 1.01f * one.gather && all.mrt > 1.01f * one.mrt &&
                    all.direct > 1.01f * one.direct);
    }
}

/* Tiles of more and more instances: the texture is as wide as they need, and no wider. */
static void a_texture_is_as_wide_as_its_tiles_need(void **state)
{
    uint32_t widest = 0;
    (void)state;
    for (uint32_t count = 1; count <= 20000; count *= 10) {
        noh_gl_morph_desc desc = { .meshes = &set.meshes[2], .mesh_count = 1, .instance_counts = &count };
        noh_gl_morph_plan plan;
        noh_gl_caps caps;
        noh_gl_caps_nominal(&caps);
        desc.path = NOH_MORPH_GATHER;
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
        assert_true(plan.atlas_width >= widest && plan.atlas_width <= 2048 && plan.atlas_height <= 2048);
        assert_true((uint64_t)plan.atlas_width * plan.atlas_height >=
                    (uint64_t)count * set.meshes[2].header->touched_count);
        widest = plan.atlas_width;
    }
    assert_true(widest > 1u << set.meshes[2].header->morph_width_log2);
}

/* No accumulator: what a GPU holds for direct are deltas and lists, and the CPU holds no more than for gather. */
static void direct_holds_no_accumulator(void **state)
{
    static const uint32_t counts[] = { 1, 2, 100 };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(counts); i++) {
        const uint32_t instances[FIXTURE_MESHES] = { counts[i], counts[i], counts[i] };
        noh_gl_morph_desc desc = desc_of((fixture_way){ NOH_MORPH_GATHER, NOH_ACCUMULATE_F32 });
        noh_gl_morph_plan gather, direct;
        noh_gl_caps caps;
        noh_gl_caps_nominal(&caps);
        desc.instance_counts = instances;
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &gather, NULL), NOH_OK);
        desc.path = NOH_MORPH_DIRECT;
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &direct, NULL), NOH_OK);
        assert_int_equal(direct.layer_bytes, 0);
        assert_int_equal(direct.delta_bytes, gather.delta_bytes);
        assert_true(direct.cpu_bytes <= gather.cpu_bytes && direct.gpu_bytes < gather.gpu_bytes);
    }
}

/* Lists of all instances are in one table: more of them than it holds are refused, and AUTO does not take them. */
static void direct_refuses_too_many_instances(void **state)
{
    noh_gl_morph_desc desc = desc_of((fixture_way){ NOH_MORPH_DIRECT, NOH_ACCUMULATE_F32 });
    const uint32_t instances[FIXTURE_MESHES] = { NOH_MORPH_INSTANCES_MAX - 2u, 1, 1 };
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_mesh_header header = *set.meshes[0].header;
    noh_target targets[7];
    static noh_rect rects[7 * 256];
    noh_gl_morph_plan plan;
    noh_gl_caps caps;
    (void)state;
    noh_gl_caps_nominal(&caps);
    caps.texture_size_max = 65536;
    memcpy(targets, set.meshes[0].targets, sizeof targets);
    for (uint32_t t = 0; t < 7; t++) {
        targets[t].first_rect = 256 * t;
        targets[t].rect_count = 256;
        for (uint32_t r = 0; r < 256; r++) rects[256 * t + r] = (noh_rect){ 0, 0, 1, 1 };
    }
    desc.instance_counts = instances;
    noh_mesh meshes[FIXTURE_MESHES] = { set.meshes[0], set.meshes[1], set.meshes[2] };
    meshes[0].header = &header;
    meshes[0].targets = targets;
    meshes[0].rects = rects;
    desc.meshes = meshes;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, &error), NOH_ERR_LIMIT);
    assert_non_null(strstr(error.what, "direct"));
    desc.path = NOH_MORPH_AUTO;
    desc.expected_active = 0.0001f;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, &error), NOH_OK);
    assert_int_not_equal(plan.path, NOH_MORPH_DIRECT);
}

static struct {
    noh_gl_api real;
    uint64_t bytes;
} sent;

static uint64_t texel_bytes(GLenum format, GLenum type)
{
    const uint64_t parts = format == GL_RED_INTEGER ? 1u : format == GL_RGB || format == GL_RGB_INTEGER ? 3u : 4u;
    return parts * (type == GL_HALF_FLOAT ? 2u : 4u);
}

static void GL_APIENTRY count_buffer(GLenum target, GLintptr at, GLsizeiptr bytes, const void *data)
{
    sent.bytes += (uint64_t)bytes;
    sent.real.BufferSubData(target, at, bytes, data);
}

static void GL_APIENTRY count_texels(GLenum target, GLint level, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format,
                                     GLenum type, const void *data)
{
    sent.bytes += (uint64_t)w * (uint64_t)h * texel_bytes(format, type);
    sent.real.TexSubImage2D(target, level, x, y, w, h, format, type, data);
}

static void GL_APIENTRY count_layers(GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei w, GLsizei h,
                                     GLsizei d, GLenum format, GLenum type, const void *data)
{
    sent.bytes += (uint64_t)w * (uint64_t)h * (uint64_t)d * texel_bytes(format, type);
    sent.real.TexSubImage3D(target, level, x, y, z, w, h, d, format, type, data);
}

/* What an update sends is no more than the plan says, and with all targets active more than half of it. With one of
 * them active, gather and the blended paths send less. */
static void check_sent(fixture_morph *m)
{
    static const float one[8] = { 0.5f };
    test_random r = test_random_from(75);
    noh_gl_api *gl = &fixture_gpu()->gl;
    uint64_t all;
    sent.real = *gl;
    gl->BufferSubData = count_buffer;
    gl->TexSubImage2D = count_texels;
    gl->TexSubImage3D = count_layers;
    set_all_active(m, &r);
    sent.bytes = 0;
    update(m);
    all = sent.bytes;
    for (uint32_t i = 0; i < m->plan.instance_count; i++) fixture_set(m, i, one);
    sent.bytes = 0;
    update(m);
    *gl = sent.real;
    if (all > m->plan.update_bytes || 2u * all <= m->plan.update_bytes ||
        (m->plan.path != NOH_MORPH_CPU && sent.bytes >= all)) {
        fail_msg("%s: at most %u bytes planned, %u sent, %u for one target", noh_morph_path_name(m->plan.path),
                 (unsigned)m->plan.update_bytes, (unsigned)all, (unsigned)sent.bytes);
    }
}

static void updates_send_what_the_plan_says(void **state)
{
    (void)state;
    for_every_way(check_sent);
}

static void automatic_takes_the_cpu_on_a_software_rasteriser(void **state)
{
    static const char *const names[] = { "llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe",
                                         "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device))",
                                         "ANGLE (Microsoft, Microsoft Basic Render Driver Direct3D11 vs_5_0 ps_5_0)",
                                         "swrast" };
    const fixture_way way = { NOH_MORPH_AUTO, NOH_ACCUMULATE_AUTO };
    noh_gl_morph_desc desc = desc_of(way);
    noh_gl_caps caps = fixture_gpu()->caps;
    noh_gl_morph_plan plan;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(names); i++) {
        strcpy(caps.renderer, names[i]);
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
        assert_int_equal(plan.path, NOH_MORPH_CPU);
        assert_int_equal(plan.accumulate, NOH_ACCUMULATE_F32);
        assert_non_null(strstr(plan.reason, "software"));
    }
}

/* The vendor's advice stands above the model. Without gather it blends here too. */
static void automatic_spares_mali_the_blending(void **state)
{
    const fixture_way way = { NOH_MORPH_AUTO, NOH_ACCUMULATE_AUTO };
    noh_gl_morph_desc desc = desc_of(way);
    noh_gl_caps caps = fixture_gpu()->caps;
    noh_gl_morph_plan plan;
    (void)state;
    caps.mrt3 = caps.blend_f32 = caps.render_f32 = caps.blend_f16 = 1;
    desc.expected_active = 0.01f;
    desc.without_direct = 1;
    strcpy(caps.renderer, "Mali-G78 MC20");
    assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
    assert_int_equal(plan.path, NOH_MORPH_GATHER);
    assert_non_null(strstr(plan.reason, "vendor"));
    desc.accumulate = NOH_ACCUMULATE_F16;
    caps.render_f16 = 0;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
    assert_int_equal(plan.path, NOH_MORPH_MRT);
}

/* Tile memory by GPU: what fits is blended at full rate. */
static void tile_memory_is_by_gpu(void **state)
{
    static const struct {
        const char *renderer;
        uint32_t bytes;
    } cases[] = { { "a GPU", 0 },
                  { "Mali-T860 (Panfrost)", 16 },
                  { "Mali-G71", 16 },
                  { "Mali-G72 MP12", 32 },
                  { "Mali-G52 r1 (Panfrost)", 32 },
                  { "Mali-G57", 32 },
                  { "Mali-G610 (Panfrost)", 64 },
                  { "Mali-G710", 64 },
                  { "Apple A8 GPU", 32 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        noh_gl_morph_desc desc = desc_of((fixture_way){ NOH_MORPH_MRT, NOH_ACCUMULATE_F32 });
        noh_gl_morph_plan plan, known;
        noh_gl_caps caps;
        noh_gl_caps_nominal(&caps);
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &plan, NULL), NOH_OK);
        strcpy(caps.renderer, cases[i].renderer);
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &known, NULL), NOH_OK);
        assert_int_equal(known.costs.tile_bytes, cases[i].bytes);
        assert_int_equal(known.costs.pixel_bytes, 48);
        assert_int_equal(known.costs.mrt > plan.costs.mrt, cases[i].bytes && cases[i].bytes < 48);
    }
}

static void a_chosen_path_says_so(void **state)
{
    const fixture_way way = { NOH_MORPH_CPU, NOH_ACCUMULATE_F16 };
    noh_gl_morph_desc desc = desc_of(way);
    noh_gl_morph_plan plan;
    (void)state;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, NULL), NOH_OK);
    assert_non_null(strstr(plan.reason, "chosen by the desc"));
}

/* The gather path needs no extension at all: the floats' bits in RGBA32UI. */
/* On every path and with every format, the accumulation texels are two thirds of what they are with tangents, and on
 * the CPU's, the staging memory too; everything else stays as it is. */
static void a_third_is_saved_without_tangents(void **state)
{
    gpu *g = fixture_gpu();
    (void)state;
    for (int i = 0; i < 2 * FIXTURE_WAYS; i++) {
        noh_gl_morph_desc desc = desc_of(fixture_ways[i / 2]);
        noh_gl_caps caps = g->caps;
        noh_gl_morph_plan three, two;
        if (i % 2) clear_cap(&caps, "render_f32"); /* RGBA32UI */
        if (noh_gl_morph_plan_make(&desc, &caps, &three, NULL) != NOH_OK || !three.layer_bytes) {
            continue;
        }
        desc.without_tangents = 1;
        assert_int_equal(noh_gl_morph_plan_make(&desc, &caps, &two, NULL), NOH_OK);
        assert_int_equal(two.layer_format, three.layer_format);
        assert_true(three.layer_bytes > 0 && two.layer_bytes * 3u == three.layer_bytes * 2u);
        assert_int_equal(three.gpu_bytes - two.gpu_bytes, three.layer_bytes - two.layer_bytes);
        if (two.path == NOH_MORPH_CPU) {
            uint64_t layer = 0; /* of the mesh with the largest layers, which the staging memory holds */
            for (uint32_t m = 0; m < FIXTURE_MESHES; m++) {
                const uint64_t bytes = noh_morph_layers_size(&set.meshes[m]) / 3u;
                layer = bytes > layer ? bytes : layer;
            }
            assert_in_range(three.cpu_bytes - two.cpu_bytes, layer - 12u, layer + 12u); /* alignment */
        } else {
            assert_int_equal(three.cpu_bytes, two.cpu_bytes);
        }
    }
}

static void gather_works_on_core_es3_with(int without_tangents)
{
    const fixture_way way = { NOH_MORPH_GATHER, NOH_ACCUMULATE_F32 };
    noh_gl_morph_desc desc = desc_of(way);
    noh_gl_caps caps = fixture_gpu()->caps;
    test_random r = test_random_from(73);
    fixture_morph m;
    desc.without_tangents = without_tangents;
    clear_cap(&caps, "layered blend_f32 blend_f16 render_f32 render_f16");
    fixture_morph_open(&m, &desc, &caps);
    assert_int_equal(m.plan.layer_format, GL_RGBA32UI);
    assert_true(noh_gl_morph_binding_of(m.morph, 0).is_uint);
    for (int round = 0; round < 3; round++) {
        set_all_random(&m, &r);
        update(&m);
        fixture_expect_all(&m);
    }
    fixture_morph_close(&m);
    fixture_expect_no_errors();
}

static void gather_works_on_core_es3(void **state)
{
    (void)state;
    gather_works_on_core_es3_with(0);
    gather_works_on_core_es3_with(1);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_way_equals_the_cpu),
    cmocka_unit_test(draws_follow_each_other),
    cmocka_unit_test(sums_do_not_drift),
    cmocka_unit_test(instances_start_at_rest),
    cmocka_unit_test(vertices_are_fetched_as_the_cpu_makes_them),
    cmocka_unit_test(only_the_changed_instance_is_accumulated),
    cmocka_unit_test(unchanged_weights_draw_nothing),
    cmocka_unit_test(zero_weights_are_not_drawn_but_cleared),
    cmocka_unit_test(everything_is_one_draw_per_pass),
    cmocka_unit_test(large_meshes_are_sent_in_chunks),
    cmocka_unit_test(a_crowd_with_every_target_active_works),
    cmocka_unit_test(very_many_instances_work),
    cmocka_unit_test(a_set_without_any_target_works),
    cmocka_unit_test(tiles_do_not_overlap),
    cmocka_unit_test(foreign_state_stays_and_does_not_matter),
    cmocka_unit_test(forced_paths_name_what_is_missing),
    cmocka_unit_test(automatic_falls_to_the_next_path),
    cmocka_unit_test(blending_is_layered_or_per_layer),
    cmocka_unit_test(automatic_weighs_blending_against_lists),
    cmocka_unit_test(costs_add_up),
    cmocka_unit_test(a_texture_is_as_wide_as_its_tiles_need),
    cmocka_unit_test(automatic_weighs_draws_against_a_pass),
    cmocka_unit_test(tile_memory_is_by_gpu),
    cmocka_unit_test(direct_holds_no_accumulator),
    cmocka_unit_test(direct_refuses_too_many_instances),
    cmocka_unit_test(updates_send_what_the_plan_says),
    cmocka_unit_test(automatic_takes_the_cpu_on_a_software_rasteriser),
    cmocka_unit_test(automatic_spares_mali_the_blending),
    cmocka_unit_test(a_chosen_path_says_so),
    cmocka_unit_test(a_third_is_saved_without_tangents),
    cmocka_unit_test(gather_works_on_core_es3),
};

TEST_MAIN(tests, set_up, tear_down)
