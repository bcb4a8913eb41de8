/* The path streams: up to four targets as vertex attributes, added by the draw. Its vertices are the CPU's, whatever
 * vertices share texels; of more targets it draws those that move the most; its bytes equal the plan's; and what
 * it cannot do is refused. */
#include "support/gl_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/readback.h"
#include "deform/morph/morph_internal.h"
#include "gl/morph/gl_morph_internal.h"

typedef struct scene {
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh meshes[2];
    noh_gl_mesh gl_meshes[2];
    noh_gl_ledger ledger;
    noh_gl_morph_desc desc;
    fixture_morph morph;
} scene;

/* Two meshes of different sizes; two instances of the first. */
static void open_scene(scene *s)
{
    static const uint32_t counts[2] = { 2, 1 };
    const test_model_desc model_desc = { 2, 9, 9, TEST_TANGENTS | TEST_UVS | TEST_COLORS, 31 };
    size_t count;
    memset(s, 0, sizeof *s);
    s->bytes = test_pack(&model_desc, &count);
    s->pack = test_open(s->bytes, count);
    for (uint32_t i = 0; i < 2; i++) {
        s->meshes[i] = test_mesh(&s->pack, i);
        assert_int_equal(noh_gl_mesh_create(&fixture_gpu()->gl, &s->ledger, &s->meshes[i], &s->gl_meshes[i], NULL),
                         NOH_OK);
    }
    s->desc.meshes = s->meshes;
    s->desc.mesh_count = 2;
    s->desc.instance_counts = counts;
    s->desc.path = NOH_MORPH_STREAMS;
    fixture_morph_open(&s->morph, &s->desc, &fixture_gpu()->caps);
}

static void close_scene(scene *s)
{
    for (uint32_t i = 0; i < 2; i++) noh_gl_mesh_delete(&fixture_gpu()->gl, &s->ledger, &s->gl_meshes[i]);
    fixture_morph_close(&s->morph);
    free(s->bytes);
    fixture_expect_no_errors();
}

/* The vertices that a draw of the instance fetches, against the CPU's for these weights. */
static void expect_vertices(const scene *s, uint32_t mesh, uint32_t instance, const float *weights)
{
    const noh_mesh *m = &s->meshes[mesh];
    const noh_gl_morph_binding binding = noh_gl_morph_binding_of(s->morph.morph, instance);
    const size_t count = m->header->vertex_count;
    noh_morph_layers layers = test_layers(m);
    float *got = test_zeros(3u * 12u * count), *normals = got + 3u * count, *tangents = normals + 3u * count;
    double moved = 0.0;
    readback r;
    assert_int_equal(readback_open(&r, fixture_gpu(), 0), 0);
    assert_int_equal(readback_vertices(&r, &s->gl_meshes[mesh], &binding, got, normals, tangents), 0);
    readback_close(&r);
    noh_morph_accumulate_scalar(m, weights, &layers);
    for (uint32_t v = 0; v < count; v++) {
        noh_vertex want, rest;
        noh_morph_vertex(m, &layers, v, &want);
        noh_mesh_vertex(m, v, &rest);
        for (uint32_t c = 0; c < 3; c++) {
            const double scale = fmax(1.0, fabs((double)want.position[c]));
            if (!(fabs((double)got[3 * v + c] - (double)want.position[c]) <= 1e-6 * scale))
                fail_msg("vertex %u, axis %u: %.9g, not %.9g", v, c, (double)got[3 * v + c], (double)want.position[c]);
            assert_true(fabs((double)normals[3 * v + c] - (double)want.normal[c]) <= 1e-5);
            assert_true(fabs((double)tangents[3 * v + c] - (double)want.tangent[c]) <= 1e-5);
            moved = fmax(moved, fabs((double)want.position[c] - (double)rest.position[c]));
        }
    }
    assert_true(moved > 1e-3);
    free(layers.position);
    free(got);
}

static void four_targets_are_added_by_the_draw(void **state)
{
    static const float weights[3][9] = { { 0, 0.5f, 0, -0.25f, 0, 0, 1.5f, 0, 1 },
                                         { 1, 0, 0, 0, 0, 0, 0, 0, 0 },
                                         { 0, 0, 2, 0, 0.75f, 0.125f, 0, 0, 0 } };
    scene s;
    (void)state;
    open_scene(&s);
    for (uint32_t i = 0; i < 3; i++) fixture_set(&s.morph, i, weights[i]);
    noh_gl_morph_update(s.morph.morph, NULL);
    for (uint32_t i = 0; i < 3; i++) expect_vertices(&s, i / 2u, i, weights[i]);
    close_scene(&s);
}

/* By |weight| x radius, in index order, against sorting; the vertices equal the sums of the four alone. */
static void the_four_that_move_most_are_drawn(void **state)
{
    test_random r = test_random_from(5);
    scene s;
    (void)state;
    open_scene(&s);
    for (int round = 0; round < 20; round++) {
        float weights[9], kept[9] = { 0.0f };
        uint32_t targets[NOH_MORPH_STREAMS_MAX], count, active = 0;
        test_random_weights(&r, weights, 9);
        count = noh_gl_morph_streamed(&s.meshes[0], weights, targets);
        for (uint32_t t = 0; t < 9; t++) active += weights[t] != 0.0f;
        assert_int_equal(count, active < 4u ? active : 4u);
        for (uint32_t i = 0; i < count; i++) {
            assert_true(!i || targets[i] > targets[i - 1u]);
            kept[targets[i]] = weights[targets[i]];
        }
        for (uint32_t t = 0; t < 9; t++) {
            for (uint32_t i = 0; i < count && kept[t] == 0.0f; i++) {
                assert_true(fabsf(weights[t]) * s.meshes[0].targets[t].radius <=
                            fabsf(weights[targets[i]]) * s.meshes[0].targets[targets[i]].radius);
            }
        }
        if (!count) continue;
        fixture_set(&s.morph, 1, weights);
        noh_gl_morph_update(s.morph.morph, NULL);
        expect_vertices(&s, 0, 1, kept);
    }
    close_scene(&s);
}

/* Five streams of 32 bytes; streams 1 to 4 bring texture coordinates that nothing reads: 8 bytes a vertex and
 * target. Here a vertex of a target takes 12 bytes, normal and tangent included. */
static void streams_hold_no_texture_coordinates(void **state)
{
    scene s;
    uint64_t vertices = 0;
    (void)state;
    open_scene(&s);
    for (uint32_t i = 0; i < 2; i++) vertices += s.meshes[i].header->vertex_count;
    assert_true(s.morph.plan.delta_bytes == 12u * 9u * vertices);
    assert_true(s.morph.plan.delta_bytes < (32u - 8u) * 9u * vertices);
    assert_true(s.morph.plan.gpu_bytes == s.morph.plan.delta_bytes);
    assert_true(noh_gl_ledger_bytes(&s.morph.ledger) == s.morph.plan.gpu_bytes);
    assert_int_equal(noh_gl_morph_binding_of(s.morph.morph, 0).texture, 0);
    close_scene(&s);
}

/* SetStreamSource with the stride of the target for the source, and a second bind that hides it: each stream has the
 * stride and the offset of its own. With the mesh's stride the second target would be read askew. */
static void each_stream_has_its_own_stride(void **state)
{
    static const float weights[9] = { 0, 0, 1, 0, 0, 0, 0, 0, 0 };
    scene s;
    (void)state;
    open_scene(&s);
    fixture_set(&s.morph, 2, weights);
    noh_gl_morph_update(s.morph.morph, NULL);
    const noh_gl_morph_binding b = noh_gl_morph_binding_of(s.morph.morph, 2);
    assert_int_equal(b.stream_offsets[0] % 12u, 0);
    assert_int_equal(b.stream_offsets[0],
                     12u * (9u * s.meshes[0].header->vertex_count + 2u * s.meshes[1].header->vertex_count));
    assert_true(s.meshes[1].header->attribute_stride != 12u);
    expect_vertices(&s, 1, 2, weights);
    close_scene(&s);
}

/* Moves an earlier rectangle of a target onto a later one, with zeros. The number of the target; 9 if none has two. */
static uint32_t overlap_rects(const noh_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const noh_target *target = &mesh->targets[t];
        for (uint32_t r = 1; r < target->rect_count; r++) {
            noh_rect *early = (noh_rect *)(uintptr_t)(mesh->rects + target->first_rect), *late = early + r;
            const uint32_t area = (uint32_t)early->w * early->h;
            if (area > late->w) continue;
            early->x = late->x;
            early->y = late->y;
            early->w = (uint16_t)area;
            early->h = 1;
            memset((uint32_t *)(uintptr_t)(mesh->texels + 3u * (size_t)target->first_texel), 0, 12u * area);
            return t;
        }
    }
    return 9;
}

static void rectangles_of_a_target_may_overlap(void **state)
{
    float weights[9] = { 0.0f };
    scene s;
    uint32_t target;
    (void)state;
    open_scene(&s);
    fixture_morph_close(&s.morph);
    target = overlap_rects(&s.meshes[0]);
    assert_true(target < 9);
    fixture_morph_open(&s.morph, &s.desc, &fixture_gpu()->caps);
    weights[target] = 0.75f;
    fixture_set(&s.morph, 0, weights);
    noh_gl_morph_update(s.morph.morph, NULL);
    expect_vertices(&s, 0, 0, weights);
    close_scene(&s);
}

static void what_streams_cannot_do_is_refused(void **state)
{
    scene s;
    noh_gl_morph_desc desc;
    noh_gl_morph_plan plan;
    noh_error error;
    (void)state;
    open_scene(&s);
    memset(&desc, 0, sizeof desc);
    desc.meshes = s.meshes;
    desc.mesh_count = 1;
    desc.path = NOH_MORPH_STREAMS;
    desc.accumulate = NOH_ACCUMULATE_F16;
    assert_int_equal(noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, &error), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.what, "f16"));
    desc.accumulate = NOH_ACCUMULATE_F32;
    desc.coarse = &s.meshes[0]; /* without its blocks and strips, no path can be planned */
    desc.later_blocks = noh_gl_morph_blocks(&s.meshes[0]);
    assert_int_equal(noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, &error), NOH_ERR_ARG);
    desc.later_strips = noh_gl_morph_strips(&s.meshes[0]);
    assert_int_equal(noh_gl_morph_plan_make(&desc, &fixture_gpu()->caps, &plan, &error), NOH_ERR_UNSUPPORTED);
    close_scene(&s);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_targets_are_added_by_the_draw),  cmocka_unit_test(the_four_that_move_most_are_drawn),
        cmocka_unit_test(streams_hold_no_texture_coordinates), cmocka_unit_test(each_stream_has_its_own_stride),
        cmocka_unit_test(rectangles_of_a_target_may_overlap),  cmocka_unit_test(what_streams_cannot_do_is_refused)
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
