/* A height field drawn in blocks: where rays meet it, without a hole between any levels, within a pixel of the whole,
 * in the reported bytes, and again after a lost context. */
#include "support/gl_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "life/physics/terrain_lod_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "gpu/canvas.h"

#define WIDTH 320u
#define HEIGHT 200u
#define PIXELS (WIDTH * HEIGHT)
#define SIDE 257u

typedef struct land {
    gpu *g;
    canvas to;
    uint16_t *heights;
    noh_field field;
    void *memory;
    noh_stage_terrain terrain;
    noh_stage_view view;
    uint8_t seen[2][PIXELS][4];
} land;

static uint32_t random_of(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static void open_land(land *l)
{
    static const noh_stage_terrain_desc desc = { .flat = { 0.1f, 0.8f, 0.1f }, .steep = { 0.1f, 0.8f, 0.1f } };
    char log[2048] = "";
    memset(l, 0, sizeof *l);
    l->g = fixture_gpu();
    l->heights = calloc((size_t)SIDE * SIDE, sizeof *l->heights);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const float x = (float)(i % SIDE), z = (float)(i / SIDE);
        l->heights[i] = (uint16_t)(25000.0f + 12000.0f * sinf(0.03f * x) * cosf(0.04f * z) +
                                   2500.0f * sinf(0.4f * x) * sinf(0.3f * z));
    }
    l->field = (noh_field){ l->heights, SIDE, SIDE, { -32.0f, 0.0f, -32.0f }, 0.25f, 0.0002f };
    const noh_gl_device device = { &l->g->gl, &l->g->caps, &l->g->ledger, log, sizeof log };
    const size_t bytes = noh_stage_terrain_size(&l->field);
    const uint64_t before = noh_gl_ledger_bytes(&l->g->ledger);
    noh_error error = { NOH_OK, "", 0, 0 };
    l->memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_stage_terrain_create(&device, &l->field, &desc, l->memory, bytes - 1u, &l->terrain, NULL),
                     NOH_ERR_MEMORY);
    if (noh_stage_terrain_create(&device, &l->field, &desc, l->memory, bytes, &l->terrain, &error)) {
        fail_msg("%s\n%s", error.what, log);
    }
    assert_int_equal(bytes, 1920);
    assert_int_equal(noh_stage_terrain_bytes(&l->field), 2u * SIDE * SIDE);
    assert_int_equal(noh_gl_ledger_bytes(&l->g->ledger) - before, 2u * SIDE * SIDE);
    assert_int_equal(canvas_open(&l->to, l->g, WIDTH, HEIGHT), 0);
}

static void close_land(land *l)
{
    canvas_close(&l->to);
    noh_stage_terrain_delete(&l->terrain);
    free(l->memory);
    free(l->heights);
    fixture_expect_no_errors();
}

static void draw(land *l, uint8_t rgba[PIXELS][4])
{
    const unsigned lookups = fixture_uniform_lookups();
    canvas_begin(&l->to);
    noh_stage_terrain_draw(&l->terrain, NULL, &l->view);
    assert_int_equal(fixture_uniform_lookups(), lookups);
    assert_int_equal(canvas_read(&l->to, rgba[0]), 0);
}

static int is_land(const uint8_t *pixel)
{
    return pixel[1] > pixel[0] + 20 && pixel[1] > pixel[2] + 20;
}

static void set_levels(land *l, uint32_t *seed)
{
    noh_terrain_lod *levels = &l->terrain.lod;
    for (uint32_t i = 0; i < levels->width * levels->depth; i++) {
        levels->levels[i] = seed ? (uint8_t)(random_of(seed) % NOH_TERRAIN_LEVELS) : 0;
        levels->seen[i] = 1;
    }
}

/* Whether a ray comes down to the field, in steps of a tenth of a unit. */
static int meets_land(const noh_field *f, const float from[3], const float direction[3])
{
    for (float t = 0.0f; t < 100.0f; t += 0.1f) {
        float height;
        if (noh_field_height(f, from[0] + t * direction[0], from[2] + t * direction[2], &height, NULL) &&
            from[1] + t * direction[1] <= height)
            return 1;
    }
    return 0;
}

/* A pixel is drawn where its ray comes to the field, seen from over it; along edges a pixel may be either. */
static void it_is_where_rays_meet_it(void **state)
{
    static const float target[3] = { 0.0f, 4.0f, 0.0f };
    static land l;
    uint32_t land_count = 0, sky_count = 0, wrong = 0;
    (void)state;
    open_land(&l);
    noh_view_orbit(&l.view, target, 0.7f, 0.26f, 25.0f, WIDTH, HEIGHT);
    set_levels(&l, NULL);
    draw(&l, l.seen[0]);
    for (uint32_t i = 0; i < PIXELS; i++) {
        float from[3], direction[3];
        assert_true(noh_view_ray(&l.view, (float)(i % WIDTH), (float)(i / WIDTH), WIDTH, HEIGHT, from, direction));
        const int meets = meets_land(&l.field, from, direction);
        land_count += (uint32_t)meets;
        sky_count += !meets;
        wrong += meets != is_land(l.seen[0][i]);
    }
    assert_true(land_count > PIXELS / 5u && sky_count > PIXELS / 50u);
    print_message("%u of %u pixels differ\n", wrong, PIXELS);
    assert_true(wrong < 2u * WIDTH); /* along the silhouette */
    close_land(&l);
}

static void no_hole_is_between_levels(void **state)
{
    static const float target[3] = { 0.0f, 4.0f, 0.0f };
    uint32_t seed = 11;
    static land l;
    (void)state;
    open_land(&l);
    for (int round = 0; round < 12; round++) {
        noh_view_orbit(&l.view, target, 0.5f * (float)round, 0.9f, 22.0f, WIDTH, HEIGHT);
        set_levels(&l, &seed);
        draw(&l, l.seen[0]);
        for (uint32_t i = 0; i < PIXELS; i++) assert_true(is_land(l.seen[0][i]));
    }
    close_land(&l);
}

/* With levels that are off by at most a pixel hardly any pixel of the silhouette changes, for a part of the triangles.
 */
static void levels_are_within_a_pixel(void **state)
{
    static const float target[3] = { 0.0f, 4.0f, 0.0f };
    static land l;
    uint32_t whole, changed = 0, edge = 0;
    (void)state;
    open_land(&l);
    noh_view_orbit(&l.view, target, 0.7f, 0.12f, 60.0f, WIDTH, HEIGHT);
    set_levels(&l, NULL);
    draw(&l, l.seen[0]);
    whole = l.terrain.triangles;
    noh_stage_terrain_choose(&l.terrain, &l.view, 1.0f);
    draw(&l, l.seen[1]);
    for (uint32_t i = WIDTH; i < PIXELS - WIDTH; i++) {
        const int was = is_land(l.seen[0][i]);
        if (was == is_land(l.seen[1][i])) continue;
        changed++; /* at most by a pixel: one above or below is the other */
        edge += was != is_land(l.seen[0][i - WIDTH]) || was != is_land(l.seen[0][i + WIDTH]);
    }
    print_message("%u triangles for %u; %u of %u pixels of the silhouette changed\n", l.terrain.triangles, whole,
                  changed, PIXELS);
    assert_true(2u * l.terrain.triangles < whole);
    assert_int_equal(edge, changed);
    assert_true(changed < WIDTH);
    close_land(&l);
}

static void it_comes_back_after_a_lost_context(void **state)
{
    static const float target[3] = { 0.0f, 4.0f, 0.0f };
    char log[2048] = "";
    static land l;
    (void)state;
    open_land(&l);
    noh_view_orbit(&l.view, target, 0.7f, 0.3f, 40.0f, WIDTH, HEIGHT);
    noh_stage_terrain_choose(&l.terrain, &l.view, 1.0f);
    draw(&l, l.seen[0]);
    noh_gl_drawable old = l.terrain.drawable; /* this context is not lost, so they are deleted by hand */
    assert_int_equal(noh_stage_terrain_restore(&l.terrain, log, sizeof log, NULL), NOH_OK);
    draw(&l, l.seen[1]);
    assert_memory_equal(l.seen[0], l.seen[1], sizeof l.seen[0]);
    l.g->gl.DeleteTextures(1, &old.texture.name);
    l.g->gl.DeleteProgram(old.programs[0]);
    l.g->gl.DeleteProgram(old.programs[1]);
    l.g->gl.DeleteVertexArrays(1, &old.vertex_array);
    close_land(&l);
}

int main(int argument_count, char **arguments)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_where_rays_meet_it),
        cmocka_unit_test(no_hole_is_between_levels),
        cmocka_unit_test(levels_are_within_a_pixel),
        cmocka_unit_test(it_comes_back_after_a_lost_context),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
