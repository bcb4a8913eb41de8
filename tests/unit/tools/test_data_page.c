/* The data textures of morph targets as pictures (tools/noh/draw/data_page.h): every pixel of the base, of a target's
 * deltas and of the sums is the value that the runtime reads there, and pixels without a vertex are clear. */
#include "draw/data_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"
#include "deform/morph/morph_internal.h"
#include "noh/low_core.h"

typedef struct scene {
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    data_page page;
} scene;

static void open_scene(scene *s)
{
    const test_model_desc desc = { 1, 9, 6, TEST_TANGENTS | TEST_UVS, 31 };
    size_t count;
    s->bytes = test_pack(&desc, &count);
    s->pack = test_open(s->bytes, count);
    s->mesh = test_mesh(&s->pack, 0);
    assert_int_equal(data_page_open(&s->page, &s->mesh), 0);
    assert_int_equal(s->page.width, 1u << s->mesh.header->morph_width_log2);
    assert_int_equal(s->page.height, s->mesh.header->morph_height);
}

static void close_scene(scene *s)
{
    data_page_close(&s->page);
    free(s->bytes);
}

static const uint8_t *pixel_of(const scene *s, uint32_t layer, uint32_t texel)
{
    return s->page.rgba + 4u * ((size_t)layer * s->page.width * s->page.height + texel);
}

/* want: 0 black, 1 white */
static void expect_pixel(const uint8_t *pixel, const double want[3], uint32_t texel)
{
    for (uint32_t c = 0; c < 3; c++) {
        if (fabs((double)pixel[c] - 255.0 * fmin(fmax(want[c], 0.0), 1.0)) > 0.51)
            fail_msg("texel %u, axis %u: %u, not %.2f", texel, c, pixel[c], 255.0 * want[c]);
    }
    assert_int_equal(pixel[3], 255);
}

static void expect_clear_behind(const scene *s)
{
    for (uint32_t layer = 0; layer < DATA_LAYERS; layer++) {
        for (uint32_t i = s->mesh.header->touched_count; i < s->page.width * s->page.height; i++) {
            assert_int_equal(pixel_of(s, layer, i)[3], 0);
        }
    }
}

static void the_base_is_the_bind_pose(void **state)
{
    scene s;
    uint32_t seen = 0;
    (void)state;
    open_scene(&s);
    data_page_base(&s.page, &s.mesh);
    for (uint32_t i = 0; i < s.mesh.header->vertex_count; i++) {
        const noh_mesh_header *h = s.mesh.header;
        const uint32_t texel = noh_mesh_accumulation_texel(&s.mesh, i);
        noh_vertex v;
        double want[3][3];
        if (texel >= h->touched_count) continue;
        noh_mesh_vertex(&s.mesh, i, &v);
        for (uint32_t c = 0; c < 3; c++) {
            const double size = (double)h->bounds_max[c] - (double)h->bounds_min[c];
            want[0][c] = size > 0.0 ? ((double)v.position[c] - (double)h->bounds_min[c]) / size : 0.5;
            want[1][c] = 0.5 + 0.5 * (double)v.normal[c];
            want[2][c] = 0.5 + 0.5 * (double)v.tangent[c];
        }
        for (uint32_t layer = 0; layer < 3; layer++) expect_pixel(pixel_of(&s, layer, texel), want[layer], texel);
        seen++;
    }
    assert_int_equal(seen, s.mesh.header->touched_count);
    expect_clear_behind(&s);
    close_scene(&s);
}

/* The page's against vertices as they are drawn: what noh_morph_accumulate puts where. */
static void expect_sums(const scene *s, const float *weights, double gain)
{
    const size_t bytes = noh_morph_layers_size(&s->mesh);
    void *memory = test_zeros(bytes);
    noh_morph_layers layers;
    assert_int_equal(noh_morph_layers_init(memory, bytes, &s->mesh, &layers, NULL), NOH_OK);
    noh_morph_accumulate_scalar(&s->mesh, weights, &layers);
    const float *values[3] = { layers.position, layers.normal, layers.tangent };
    for (uint32_t layer = 0; layer < 3; layer++) {
        double most = 0.0, spread = 0.0;
        for (uint32_t i = 0; i < 3u * s->mesh.header->touched_count; i++) {
            most = fmax(most, fabs((double)values[layer][i]));
        }
        assert_true(most > 0.0 && fabs((double)s->page.most[layer] - most) <= 1e-6 * most);
        for (uint32_t i = 0; i < s->mesh.header->touched_count; i++) {
            double want[3];
            for (uint32_t c = 0; c < 3; c++) {
                want[c] = 0.5 + 0.5 * gain * (double)values[layer][3u * i + c] / most;
                spread = fmax(spread, fabs(want[c] - 0.5));
            }
            expect_pixel(pixel_of(s, layer, i), want, i);
        }
        assert_true(spread > 0.49 * gain); /* plain grey would fail */
    }
    expect_clear_behind(s);
    free(memory);
}

static void each_target_has_its_own_page(void **state)
{
    scene s;
    float weights[8] = { 0.0f };
    (void)state;
    open_scene(&s);
    for (uint32_t t = 0; t < s.mesh.header->target_count; t++) {
        weights[t] = 1.0f;
        data_page_delta(&s.page, &s.mesh, t, 1.0f);
        expect_sums(&s, weights, 1.0);
        weights[t] = 0.0f;
    }
    close_scene(&s);
}

static void sums_are_what_is_accumulated(void **state)
{
    scene s;
    float weights[8];
    test_random r = test_random_from(77);
    (void)state;
    open_scene(&s);
    test_random_weights(&r, weights, s.mesh.header->target_count);
    data_page_sums(&s.page, &s.mesh, weights, 0.5f);
    expect_sums(&s, weights, 0.5);
    close_scene(&s);
}

/* Without weights there is nothing to divide by: all is grey. */
static void nothing_is_grey(void **state)
{
    static const float weights[8] = { 0.0f };
    static const double grey[3] = { 0.5, 0.5, 0.5 };
    scene s;
    (void)state;
    open_scene(&s);
    data_page_sums(&s.page, &s.mesh, weights, 1.0f);
    for (uint32_t i = 0; i < s.mesh.header->touched_count; i++) expect_pixel(pixel_of(&s, 0, i), grey, i);
    assert_true(s.page.most[0] == 0.0f);
    close_scene(&s);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(the_base_is_the_bind_pose),
                                        cmocka_unit_test(each_target_has_its_own_page),
                                        cmocka_unit_test(sums_are_what_is_accumulated),
                                        cmocka_unit_test(nothing_is_grey) };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
