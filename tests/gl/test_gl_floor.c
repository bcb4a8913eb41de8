/* A shadow on a floor that is not drawn: every pixel by what is left of the light; nothing where the light comes through,
 * from below, or behind what is nearer; the same after a lost context. */
#include "support/gl_fixture.h"
#include "support/srgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/canvas.h"
#include "gl/draw/gl_light_internal.h"
#include "gl/light/light_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define SIDE 64u
#define SHADOW_PX 64u

/* From above: x to the right, z up, from -1 to 1; y from -1 to 1 is nearer. */
static const noh_stage_view above = { .view_projection = { 1, 0, 0, 0, 0, 0, -0.5f, 0, 0, 1, 0, 0, 0, 0, 0, 1 },
                                      .eye = { 0.0f, 5.0f, 0.0f } };
static const float disc[4] = { 0.1f, 0.0f, 0.0f, 0.8f };

typedef struct scene {
    gpu *g;
    void *texels;
    noh_reflection reflection;
    noh_gl_light light;
    noh_lighting lighting;
    noh_stage_floor level;
} scene;

static void open_scene(scene *s, int is_soft)
{
    const noh_environment *room = noh_environment_at(noh_environment_find("room"));
    const noh_reflection_desc desc = { 0, noh_reflection_of_environment, room };
    const size_t bytes = noh_reflection_size(0), scratch_bytes = noh_reflection_scratch_size(0);
    const float sphere[4] = { 0.0f, 0.0f, 0.0f, 2.0f };
    void *scratch = malloc(scratch_bytes);
    noh_gl_light_desc light = { &s->reflection, SHADOW_PX };
    noh_stage_view view;
    noh_light all;
    s->g = fixture_gpu();
    const noh_gl_device device = { &s->g->gl, is_soft ? &s->g->caps : NULL, &s->g->ledger, NULL, 0 };
    s->texels = malloc(bytes);
    assert_int_equal(noh_reflection_init(s->texels, bytes, scratch, scratch_bytes, &desc, &s->reflection, NULL),
                     NOH_OK);
    free(scratch);
    noh_light_from_environment(room, NOH_SH_ORDER_MAX, &all);
    noh_lighting_make(&all, NULL, 1, &s->lighting);
    noh_view_shadow(&view, sphere, s->lighting.key_direction);
    noh_lighting_shadow(&s->lighting, view.view_projection, sphere[3], SHADOW_PX);
    assert_int_equal(noh_gl_light_create(&device, &light, &s->light, NULL), NOH_OK);
    assert_int_equal(noh_stage_floor_create(&device, 0, &s->level, NULL), NOH_OK);
}

static void close_scene(scene *s)
{
    noh_stage_floor_delete(&s->level);
    noh_stage_floor_delete(&s->level);
    noh_gl_light_delete(&s->light);
    free(s->texels);
    fixture_expect_no_errors();
}

/* nearest: the least depth from the light, all over the map, 1: nothing is there */
static void picture(scene *s, float nearest, const noh_stage_view *view, float before, uint8_t *rgba)
{
    canvas c;
    assert_int_equal(canvas_open(&c, s->g, SIDE, SIDE), 0);
    noh_gl_light_begin_shadow(&s->light);
    s->g->gl.ClearBufferfv(GL_DEPTH, 0, &nearest);
    noh_gl_light_end_shadow(&s->light, s->lighting.shadow, &s->lighting);
    canvas_begin(&c);
    s->g->gl.DepthMask(GL_TRUE);
    s->g->gl.ClearBufferfv(GL_DEPTH, 0, &before);
    noh_stage_floor_draw(&s->level, &s->light, &s->lighting, view, disc);
    assert_int_equal(canvas_read(&c, rgba), 0);
    canvas_close(&c);
}

/* The share of the light that a floor in shadow keeps. */
static void left_of(const scene *s, double left[3])
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    noh_light rest = s->lighting.rest;
    float around[3];
    rest.order = 3;
    noh_light_irradiance(&rest, up, around);
    for (int k = 0; k < 3; k++) {
        const double key = (double)(s->lighting.key[k] * s->lighting.key_direction[1]);
        left[k] = 1.0 - key / ((double)around[k] + key);
    }
}

static double faded(uint32_t x, uint32_t y)
{
    const double dx = 2.0 * (x + 0.5) / SIDE - 1.0 - (double)disc[0],
                 dz = 1.0 - 2.0 * (y + 0.5) / SIDE - (double)disc[2];
    const double t = fmin(fmax((sqrt(dx * dx + dz * dz) / (double)disc[3] - 0.5) / 0.5, 0.0), 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

static void expect(const scene *s, const uint8_t *rgba, int in_shadow)
{
    static const double background[3] = { CANVAS_BACKGROUND_LINEAR };
    double left[3], worst = 0.0;
    left_of(s, left);
    for (int k = 0; k < 3; k++) assert_true(left[k] > 0.1 && left[k] < 0.9);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double taken = in_shadow ? faded(i % SIDE, i / SIDE) : 0.0;
        for (uint32_t k = 0; k < 3; k++) {
            const double want = background[k] * (1.0 - (1.0 - left[k]) * taken);
            worst = fmax(worst, fabs(rgba[4 * i + k] - encoded(want)));
        }
    }
    print_message("worst pixel %.2f of 255\n", worst);
    assert_true(worst < 2.0);
}

static void check_pixels(int is_soft)
{
    static uint8_t first[SIDE * SIDE * 4], again[SIDE * SIDE * 4];
    scene s;
    open_scene(&s, is_soft);
    picture(&s, 0.0f, &above, 1.0f, first);
    expect(&s, first, 1);
    assert_int_equal(noh_stage_floor_restore(&s.level, NULL, 0, NULL), NOH_OK);
    picture(&s, 0.0f, &above, 1.0f, again);
    assert_memory_equal(first, again, sizeof first);
    picture(&s, 1.0f, &above, 1.0f, again); /* the light comes through */
    expect(&s, again, 0);
    s.lighting.has_floor = 1; /* where it replaces what was not drawn, the light comes through, too */
    picture(&s, 1.0f, &above, 1.0f, again);
    expect(&s, again, 0);
    close_scene(&s);
}

static void pixels_are_what_is_left_of_the_light(void **state)
{
    (void)state;
    check_pixels(0);
    check_pixels(1);
}

/* A page that shines through a transparent picture is darkened by alpha. */
static void it_darkens_what_lies_behind_the_picture(void **state)
{
    static const float nothing[4] = { 0.0f, 0.0f, 0.0f, 0.0f }, lit = 0.0f, far = 1.0f;
    static uint8_t rgba[SIDE * SIDE * 4];
    double left[3], worst = 0.0;
    scene s;
    canvas c;
    (void)state;
    open_scene(&s, 0);
    assert_int_equal(canvas_open(&c, s.g, SIDE, SIDE), 0);
    noh_gl_light_begin_shadow(&s.light);
    s.g->gl.ClearBufferfv(GL_DEPTH, 0, &lit);
    noh_gl_light_end_shadow(&s.light, s.lighting.shadow, &s.lighting);
    canvas_begin(&c);
    s.g->gl.DepthMask(GL_TRUE);
    s.g->gl.ClearBufferfv(GL_DEPTH, 0, &far);
    s.g->gl.ClearBufferfv(GL_COLOR, 0, nothing);
    noh_stage_floor_draw(&s.level, &s.light, &s.lighting, &above, disc);
    canvas_resolve(&c); /* canvas_read has no alpha */
    s.g->gl.BindFramebuffer(GL_FRAMEBUFFER, c.resolved_framebuffer);
    s.g->gl.ReadPixels(0, 0, (GLsizei)SIDE, (GLsizei)SIDE, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    s.g->gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    canvas_close(&c);
    left_of(&s, left);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double dark = (1.0 - (left[0] + left[1] + left[2]) / 3.0) * faded(i % SIDE, SIDE - 1u - i / SIDE);
        assert_int_equal(rgba[4 * i] | rgba[4 * i + 1] | rgba[4 * i + 2], 0);
        worst = fmax(worst, fabs(rgba[4 * i + 3] - 255.0 * dark));
    }
    print_message("worst alpha %.2f of 255\n", worst);
    assert_true(worst < 2.0);
    close_scene(&s);
}

static void it_is_seen_from_above_alone(void **state)
{
    static uint8_t rgba[SIDE * SIDE * 4];
    noh_stage_view below = above;
    scene s;
    (void)state;
    open_scene(&s, 0);
    below.eye[1] = -1.0f;
    picture(&s, 0.0f, &below, 1.0f, rgba);
    expect(&s, rgba, 0);
    picture(&s, 0.0f, &above, 0.1f, rgba); /* something is nearer */
    expect(&s, rgba, 0);
    s.light.desc.shadow_px = 0;
    picture(&s, 0.0f, &above, 1.0f, rgba); /* no shadow map */
    expect(&s, rgba, 0);
    s.light.desc.shadow_px = SHADOW_PX;
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(it_darkens_what_lies_behind_the_picture),
                                        cmocka_unit_test(pixels_are_what_is_left_of_the_light),
                                        cmocka_unit_test(it_is_seen_from_above_alone) };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
