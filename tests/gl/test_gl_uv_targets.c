/* Texture coordinates that targets move, as mesh.vert leaves them: on every path, in both formats, at each level, in
 * crowds, and in depth passes that cut by alpha; streams refuse them. */
#include "support/lod_fixture.h"
#include "support/tube_fixture.h"
#include "deform/morph/morph_internal.h"
#include "gl/draw/gl_variants_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TARGETS 3u
#define FUSED 1e-6 /* what a GPU may fuse */

static void add_deltas(model_mesh *mesh)
{
    for (uint32_t t = 0; t < TARGETS; t++) {
        model_target *to = &mesh->targets[t];
        to->uv = test_zeros(sizeof *to->uv * 2u * mesh->vertex_count);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            const float *p = mesh->position + 3u * v;
            if (t == 2u && v % 3u) continue; /* others stay where they are */
            to->uv[2u * v] = 0.2f * sinf(5.0f * p[0] + (float)t);
            to->uv[2u * v + 1u] = 0.1f * cosf(4.0f * p[1]) - 0.05f * (float)t;
        }
    }
    memset(mesh->targets[1].position, 0, sizeof(float) * 3u * mesh->vertex_count);
}

static void make(model *m, uint32_t levels, lod_pack *p)
{
    const lod_settings settings = { levels, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    lod_pack_make(m, &settings, 0, p);
    assert_true(p->mesh.header->flags & NOH_MESH_UV_TARGETS);
}

/* The largest difference from the CPU's, over a level's vertices, by its own layers. */
static double off_by(const readback_vertex *got, const noh_mesh *level, const float *weights)
{
    noh_morph_layers layers = test_layers(level);
    double worst = 0.0;
    noh_morph_accumulate_scalar(level, weights, &layers);
    for (uint32_t v = 0; v < level->header->vertex_count; v++) {
        noh_vertex want;
        noh_morph_vertex(level, &layers, v, &want);
        for (int c = 0; c < 2; c++) worst = fmax(worst, fabs((double)got[v].uv[c] - (double)want.uv[c]));
    }
    free(layers.position);
    return worst;
}

static void check_way(const lod_pack *p, fixture_way way)
{
    static const float weights[TARGETS] = { 0.8f, 1.0f, -0.6f };
    const noh_gl_morph_desc desc = {
        .meshes = &p->mesh, .mesh_count = 1, .path = way.path, .accumulate = way.accumulate
    };
    gpu *g = fixture_gpu();
    readback_vertex *got = test_zeros(sizeof *got * p->mesh.header->vertex_count);
    fixture_morph m;
    noh_gl_ledger ledger;
    noh_gl_mesh gl_mesh;
    readback back;
    memset(&ledger, 0, sizeof ledger);
    fixture_morph_open(&m, &desc, NULL);
    assert_int_equal(noh_gl_mesh_create(&g->gl, &ledger, &p->mesh, &gl_mesh, NULL), NOH_OK);
    fixture_set(&m, 0, weights);
    for (uint32_t k = 0; k < p->mesh.header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(&p->mesh, k);
        const int is_half = way.accumulate == NOH_ACCUMULATE_F16;
        const double bound = FUSED +
                             (is_half ? (double)(level.header->f16_position_bound * level.header->uv_per_unit) : 0);
        noh_gl_morph_binding binding;
        fixture_set_level(&m, 0, k);
        fixture_set(&m, 0, weights);
        noh_gl_morph_update(m.morph, NULL);
        binding = noh_gl_morph_binding_of(m.morph, 0);
        assert_int_equal(readback_open(&back, g, binding.is_uint), 0);
        assert_int_equal(readback_skinned(&back, &gl_mesh, &binding, NULL, 0, got), 0);
        readback_close(&back);
        {
            const double off = off_by(got, &level, weights);
            if (is_half) print_message("%s, level %u: %.2f texels of 2048\n", fixture_way_name(way), k, off * 2048.0);
            assert_true(off <= bound && off < 1.0 / 2048.0);
        }
    }
    noh_gl_mesh_delete(&g->gl, &ledger, &gl_mesh);
    fixture_morph_close(&m);
    free(got);
    fixture_expect_no_errors();
}

static void every_way_moves_them(void **state)
{
    const lod_face face = { 18, 14, TARGETS, 0, 0 };
    model *m = lod_face_model(&face);
    lod_pack p;
    uint32_t ways = 0;
    (void)state;
    add_deltas(&m->meshes[0]);
    make(m, 3, &p);
    for (size_t i = 0; i < FIXTURE_WAYS; i++) {
        const noh_gl_morph_desc desc = {
            .meshes = &p.mesh, .mesh_count = 1, .path = fixture_ways[i].path, .accumulate = fixture_ways[i].accumulate
        };
        noh_gl_morph_plan plan;
        if (noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, NULL) != NOH_OK) continue;
        check_way(&p, fixture_ways[i]);
        ways++;
    }
    print_message("%u ways\n", ways);
    assert_true(ways >= 2);
    lod_pack_free(&p);
    model_free(m);
}

/* A tube with texture coordinates. */
static model *tube_model(void)
{
    const skin_cylinder c = { 12, 9, 5, 4, TARGETS, 1, 2.0f, 0.35f };
    model *m = lod_tube_model(&c);
    model_mesh *mesh = &m->meshes[0];
    if (!mesh->uv) mesh->uv = test_zeros(sizeof *mesh->uv * 2u * mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        mesh->uv[2u * v] = 0.5f + mesh->position[3u * v];
        mesh->uv[2u * v + 1u] = 0.5f * mesh->position[3u * v + 1u];
    }
    add_deltas(mesh);
    return m;
}

static void check_crowd(noh_morph_path path)
{
    model *m = tube_model();
    lod_pack p;
    tube t;
    readback back;
    readback_vertex *got;
    make(m, 1, &p);
    tube_open_with(&t, &p.mesh, NOH_PALETTE_TEXTURE, path, 0, NULL);
    got = test_zeros(sizeof *got * COPIES * p.mesh.header->vertex_count);
    for (uint32_t crowd = 0; crowd <= COPIES; crowd += COPIES) {
        for (uint32_t i = 0; i < COPIES; i++) {
            const noh_gl_morph_binding morph = noh_gl_morph_binding_of(t.morph.morph, crowd ? 0 : i);
            const noh_gl_skin_binding skin = noh_gl_skin_binding_of(t.skin, crowd ? 0 : i);
            assert_int_equal(readback_open(&back, fixture_gpu(), morph.is_uint), 0);
            assert_int_equal(readback_skinned(&back, &t.gl, &morph, &skin, crowd, got), 0);
            readback_close(&back);
            assert_true(off_by(got + (crowd ? i : 0u) * p.mesh.header->vertex_count, &p.mesh, t.morph.weights[i]) <=
                        FUSED);
        }
    }
    free(got);
    tube_close(&t);
    lod_pack_free(&p);
    model_free(m);
    fixture_expect_no_errors();
}

/* The variants of depth: without alpha none exists, with it the coordinates are fetched. */
static void depth_fetches_them_where_alpha_cuts(void **state)
{
    static const char *const varyings[] = { "v_uv" };
    gpu *g = fixture_gpu();
    model *m = tube_model();
    lod_pack p;
    (void)state;
    make(m, 1, &p);
    for (int cut = 0; cut < 2; cut++) {
        const noh_gl_variant_key key = noh_gl_variant_key_depth(
            noh_gl_variant_key_of(&p.mesh, NULL, 0, 0, NOH_VIEW_LIT), cut);
        noh_gl_variant v;
        assert_int_equal(key.uv_targets, cut);
        assert_int_equal(
            noh_gl_variant_create(&(noh_gl_device){ &g->gl, NULL, NULL, NULL, 0 }, key, NULL, varyings, 1, &v, NULL),
            NOH_OK);
        assert_int_equal(g->gl.GetAttribLocation(v.program, "noh_a_uv_texel"),
                         cut ? (GLint)NOH_ATTRIBUTE_UV_TEXEL : -1);
        noh_gl_variant_delete(&g->gl, NULL, &v);
    }
    lod_pack_free(&p);
    model_free(m);
    fixture_expect_no_errors();
}

/* One accumulator for a mesh with them and one without: the first alone asks for sums in place of finished vertices, so
 * both have them, and the other's vertices are the CPU's as ever. */
static void a_mesh_with_them_beside_one_without(void **state)
{
    const skin_cylinder c = { 12, 9, 5, 4, TARGETS, 1, 2.0f, 0.35f };
    const lod_settings one_level = { .level_count = 1, .mode = LOD_FAST };
    model *m = tube_model(), *plain = lod_tube_model(&c);
    uint32_t ways = 0;
    lod_pack with, without;
    (void)state;
    make(m, 1, &with);
    lod_pack_make(plain, &one_level, 0, &without);
    assert_false(without.mesh.header->flags & NOH_MESH_UV_TARGETS);
    for (size_t i = 0; i < FIXTURE_WAYS; i++) {
        const noh_mesh both[2] = { with.mesh, without.mesh };
        noh_gl_morph_desc desc = { .meshes = both,
                                   .mesh_count = 2,
                                   .path = fixture_ways[i].path,
                                   .accumulate = fixture_ways[i].accumulate,
                                   .vertices = 1 };
        noh_gl_morph_desc alone = desc;
        noh_gl_morph_plan plan;
        fixture_morph morph;
        test_random random = test_random_from(11);
        if (noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, NULL) != NOH_OK) continue;
        assert_int_equal(plan.vertex_ring, 0);
        alone.meshes = &without.mesh;
        alone.mesh_count = 1;
        assert_int_equal(noh_gl_morph_plan_make(&alone, &fixture_gpu()->caps, &plan, NULL), NOH_OK);
        assert_int_equal(plan.vertex_ring != 0, plan.path == NOH_MORPH_CPU && plan.accumulate == NOH_ACCUMULATE_F32);
        fixture_morph_open(&morph, &desc, NULL);
        for (uint32_t k = 0; k < 2u; k++) fixture_set_random(&morph, k, &random);
        noh_gl_morph_update(morph.morph, NULL);
        fixture_expect_all(&morph);
        fixture_morph_close(&morph);
        ways++;
    }
    assert_true(ways >= 2);
    lod_pack_free(&with);
    lod_pack_free(&without);
    model_free(m);
    model_free(plain);
    fixture_expect_no_errors();
}

static void each_of_a_crowd_has_its_own(void **state)
{
    (void)state;
    check_crowd(NOH_MORPH_CPU);
    check_crowd(NOH_MORPH_DIRECT);
}

static void streams_refuse_them(void **state)
{
    model *m = tube_model();
    lod_pack p;
    noh_gl_morph_desc desc = { .mesh_count = 1, .path = NOH_MORPH_STREAMS };
    noh_gl_morph_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    (void)state;
    make(m, 1, &p);
    desc.meshes = &p.mesh;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, &error), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.what, "texture coordinates"));
    lod_pack_free(&p);
    model_free(m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_way_moves_them),
    cmocka_unit_test(each_of_a_crowd_has_its_own),
    cmocka_unit_test(depth_fetches_them_where_alpha_cuts),
    cmocka_unit_test(a_mesh_with_them_beside_one_without),
    cmocka_unit_test(streams_refuse_them),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
