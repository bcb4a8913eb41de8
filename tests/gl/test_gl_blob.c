/* Spots on the ground: every pixel by the formula, in one draw for 32, behind what is nearer, and back after a lost
 * context. */
#include "support/gl_fixture.h"
#include "support/srgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/canvas.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define SIDE 128u

/* From above: x to the right, z up, from -1 to 1; y from -1 to 1 is nearer. */
static const noh_stage_view above = { .view_projection = { 1, 0, 0, 0, 0, 0, -0.5f, 0, 0, 1, 0, 0, 0, 0, 0, 1 } };

static void picture_from(gpu *g, noh_stage_blob *b, const noh_stage_view *view, const noh_blob *blobs, uint32_t count,
                         float nearest, uint8_t *rgba)
{
    canvas c;
    assert_int_equal(canvas_open(&c, g, SIDE, SIDE), 0);
    canvas_begin(&c);
    g->gl.DepthMask(GL_TRUE);
    g->gl.ClearDepthf(nearest);
    g->gl.Clear(GL_DEPTH_BUFFER_BIT);
    g->gl.ClearDepthf(1.0f);
    noh_stage_blob_draw(b, view, blobs, count);
    assert_int_equal(canvas_read(&c, rgba), 0);
    canvas_close(&c);
}

static void picture(gpu *g, noh_stage_blob *b, const noh_blob *blobs, uint32_t count, float nearest, uint8_t *rgba)
{
    picture_from(g, b, &above, blobs, count, nearest, rgba);
}

/* What a spot leaves at a place, by its definition. */
static double left_at(const noh_blob *b, double x, double z)
{
    const double det = (double)b->along[0] * (double)b->across[2] - (double)b->along[2] * (double)b->across[0];
    const double dx = x - (double)b->centre[0], dz = z - (double)b->centre[2];
    const double u = (dx * (double)b->across[2] - dz * (double)b->across[0]) / det;
    const double v = (dz * (double)b->along[0] - dx * (double)b->along[2]) / det;
    const double inside = fmax(1.0 - u * u - v * v, 0.0);
    return 1.0 - (double)b->darkness * inside * inside;
}

static void expect(const uint8_t *rgba, const noh_blob *blobs, uint32_t count)
{
    static const double background[3] = { CANVAS_BACKGROUND_LINEAR };
    double worst = 0.0;
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            double left = 1.0;
            for (uint32_t i = 0; i < count; i++) {
                left *= left_at(&blobs[i], 2.0 * (x + 0.5) / SIDE - 1.0, 1.0 - 2.0 * (y + 0.5) / SIDE);
            }
            for (uint32_t k = 0; k < 3; k++) {
                worst = fmax(worst, fabs(rgba[4 * (SIDE * y + x) + k] - encoded(left * background[k])));
            }
        }
    }
    print_message("worst pixel %.2f of 255\n", worst);
    assert_true(worst < 2.0);
}

static void pixels_are_those_of_the_formula(void **state)
{
    static const noh_blob two[2] = { { { 0.1f, 0.0f, -0.2f }, 0.8f, { 0.5f, 0.0f, 0.2f }, { -0.1f, 0.0f, 0.25f } },
                                     { { -0.2f, 0.0f, 0.1f }, 0.5f, { 0.0f, 0.0f, 0.6f }, { 0.4f, 0.0f, 0.0f } } };
    static uint8_t first[SIDE * SIDE * 4], again[SIDE * SIDE * 4], none[SIDE * SIDE * 4];
    gpu *g = fixture_gpu();
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
    noh_stage_blob b;
    (void)state;
    assert_int_equal(noh_stage_blob_create(&device, &b, NULL), NOH_OK);
    picture(g, &b, two, 2, 1.0f, first);
    expect(first, two, 2);
    assert_int_equal(noh_stage_blob_restore(&b, NULL, 0, NULL), NOH_OK);
    picture(g, &b, two, 2, 1.0f, again);
    assert_memory_equal(first, again, sizeof first);
    picture(g, &b, two, 0, 1.0f, none);
    picture(g, &b, two, 2, 0.1f, again); /* something is nearer */
    assert_memory_equal(none, again, sizeof none);
    expect(none, two, 0);
    noh_stage_blob_delete(&b);
    noh_stage_blob_delete(&b);
    fixture_expect_no_errors();
}

/* A thousand kilometres away, where floats are 0.125 m apart, by the view's own origin: the last view had another. */
static void spots_far_away_are_as_near_by(void **state)
{
    static const noh_blob spot = { { 0.125f, 0.0f, -0.25f }, 0.8f, { 0.53f, 0.0f, 0.2f }, { -0.11f, 0.0f, 0.27f } };
    static uint8_t rgba[SIDE * SIDE * 4];
    const float away[2] = { 1048576.0f, -1048576.0f };
    noh_stage_view view = above;
    noh_blob far = spot;
    gpu *g = fixture_gpu();
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
    noh_stage_blob b;
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        view.eye[2u * i] = away[i];
        view.view_projection[12 + i] = -away[i];
        far.centre[2u * i] += away[i];
    }
    assert_int_equal(noh_stage_blob_create(&device, &b, NULL), NOH_OK);
    picture(g, &b, &spot, 1, 1.0f, rgba);
    expect(rgba, &spot, 1);
    picture_from(g, &b, &view, &far, 1, 1.0f, rgba);
    expect(rgba, &spot, 1);
    noh_stage_blob_delete(&b);
    fixture_expect_no_errors();
}

static void many_are_a_few_draws(void **state)
{
    static uint8_t all[SIDE * SIDE * 4];
    noh_blob many[3 * NOH_BLOBS_DRAWN + 1];
    const uint32_t count = sizeof many / sizeof *many;
    gpu *g = fixture_gpu();
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
    noh_stage_blob b;
    (void)state;
    for (uint32_t i = 0; i < count; i++) {
        const noh_blob one = { { 0.19f * (float)(i % 10u) - 0.86f, 0.0f, 0.19f * (float)(i / 10u) - 0.86f },
                               0.01f * (float)i,
                               { 0.09f, 0.0f, 0.0f },
                               { 0.0f, 0.0f, 0.09f } };
        many[i] = one;
    }
    assert_int_equal(noh_stage_blob_create(&device, &b, NULL), NOH_OK);
    picture(g, &b, many, count, 1.0f, all);
    assert_int_equal(b.draws, 4);
    expect(all, many, count);
    noh_stage_blob_delete(&b);
    fixture_expect_no_errors();
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(pixels_are_those_of_the_formula),
                                        cmocka_unit_test(spots_far_away_are_as_near_by),
                                        cmocka_unit_test(many_are_a_few_draws) };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
