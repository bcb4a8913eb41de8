/* Marks drawn: on each pixel by where it is at rest, in any pose and at any level; all of a mesh in one draw; nothing
 * is left behind. */
#include "support/decal_fixture.h"
#include "noh/noh_gl.h"

#include <math.h>

/* How a triangle faces at rest, unit: by the normals of its corners, as they are drawn. */
static void rest_normal(const noh_mesh *mesh, const noh_pick_hit *hit, double normal[3])
{
    double square = 0.0;
    memset(normal, 0, 3 * sizeof *normal);
    for (uint32_t i = 0; i < 3; i++) {
        noh_vertex v;
        noh_mesh_vertex(mesh, noh_mesh_index(mesh, 3u * hit->triangle + i), &v);
        for (int k = 0; k < 3; k++) normal[k] += (double)hit->barycentric[i] * (double)v.normal[k];
    }
    for (int k = 0; k < 3; k++) square += normal[k] * normal[k];
    for (int k = 0; k < 3; k++) normal[k] /= sqrt(square);
}

/* The distance to the middle of a mark that faces as the place does: 0 there, 1 at the edge of its spot. facing: the
 * least cosine */
static double nearest_mark(const noh_decals *ring, uint32_t mesh, const float rest[3], const double normal[3],
                           double facing)
{
    double least = 1e9;
    for (uint32_t i = 0; i < ring->capacity; i++) {
        const noh_decal *d = &ring->decals[i];
        double square = 0.0, along = 0.0, faces = 0.0;
        if (d->mesh != mesh) continue;
        for (int k = 0; k < 3; k++) {
            const double to = ((double)rest[k] - (double)d->centre[k]) / (double)d->size;
            square += to * to;
            along += to * (double)d->normal[k];
            faces += normal[k] * (double)d->normal[k];
        }
        if (square < 2.0 && faces > facing) least = fmin(least, sqrt(fmax(square - along * along, 0.0)));
    }
    return least;
}

/* Rays of the CPU are slow: of the pixels that marks have changed every fifth each way is looked at, of the others
 * every fifteenth; under sanitizers every eighth and twenty-fourth. */
static uint32_t pixel_step(void)
{
    const char *sanitizers = getenv("NOH_SAN");
    return sanitizers && *sanitizers ? 8u : 5u;
}

/* Pixels well inside of a spot are red, those well outside are as they were. */
static void expect_marks(shot *s, uint32_t kind, uint32_t mesh_count, const char *pose)
{
    surface meshes[4];
    uint8_t *without = picture(s, 0), *with = picture(s, 1);
    const uint32_t step = pixel_step();
    uint32_t inside = 0, outside = 0, wrong_inside = 0, wrong_outside = 0;
    for (uint32_t m = 0; m < mesh_count; m++) open_surface(s, kind, m, &meshes[m]);
    for (uint32_t y = step; y + step < HEIGHT; y += step) {
        for (uint32_t x = step; x + step < WIDTH; x += step) {
            const size_t at = 4u * ((size_t)y * WIDTH + x);
            const int changed = memcmp(with + at, without + at, 3) != 0;
            noh_pick_hit hit;
            double normal[3], sure = 1e9, any = 1e9;
            uint32_t found;
            if (!changed && (x % (3u * step) || y % (3u * step))) continue;
            found = rest_at(s, meshes, mesh_count, x, y, &hit);
            if (found) {
                const surface *u = &meshes[found - 1u];
                rest_normal(&u->mesh, &hit, normal);
                sure = nearest_mark(&s->ring, u->drawn.mesh, hit.bind_point, normal, 0.3);
                any = nearest_mark(&s->ring, u->drawn.mesh, hit.bind_point, normal, 0.1);
            }
            if (sure < 0.6) {
                inside++;
                wrong_inside += with[at] < with[at + 1u] + 20 || with[at] < with[at + 2u] + 20;
            } else if (any > 1.5) {
                outside++;
                wrong_outside += (uint32_t)changed;
            }
        }
    }
    print_message("%s: %u of %u pixels inside are not red, %u of %u outside are not as before\n", pose, wrong_inside,
                  inside, wrong_outside, outside);
    assert_true(inside * step * step > 800u && outside > 40u);
    assert_true(wrong_inside * 20u <= inside + 19u && wrong_outside * 20u <= outside); /* edges of the figure */
    for (uint32_t m = 0; m < mesh_count; m++) close_surface(&meshes[m]);
    free(without);
    free(with);
}

static void marks_stay_through_a_smile_and_levels(void **state)
{
    shot s;
    float sphere[4];
    uint32_t levels, smile;
    (void)state;
    open_shot(&s, MASKS);
    assert_int_equal(noh_actor_sphere(s.c.stage, s.actor, sphere, NULL), NOH_OK);
    noh_view_orbit(&s.view, sphere, 0.3f, 0.1f, 1.6f * sphere[3], WIDTH, HEIGHT); /* something is left of the mask */
    frame(&s);
    assert_true(strike(&s, 60, 0.09f, 64) > 3u);
    levels = s.c.plan.kinds[MASKS].level_count;
    smile = noh_stage_find(s.c.stage, MASKS, NOH_NAME_FLOAT, "smile");
    expect_marks(&s, MASKS, 1, "at rest");
    assert_int_equal(noh_actor_hold_float(s.c.stage, s.actor, smile, 1.0f, 1.0f, NULL), NOH_OK);
    frame(&s);
    expect_marks(&s, MASKS, 1, "smiling");
    set_level(&s, levels - 1u);
    expect_marks(&s, MASKS, 1, "smiling, at the coarsest level");
    close_shot(&s);
}

static void marks_stay_through_a_walk(void **state)
{
    const noh_play play = { .fade_ticks = 1, .start_ticks = 20000 };
    shot s;
    (void)state;
    open_shot(&s, PUPPETS);
    assert_true(strike(&s, 30, 0.06f, 64) > 6u);
    expect_marks(&s, PUPPETS, 2, "at rest");
    assert_int_equal(noh_actor_play(s.c.stage, s.actor, 0, "walk", &play, NULL), NOH_OK);
    frame(&s);
    expect_marks(&s, PUPPETS, 2, "walking");
    set_level(&s, s.c.plan.kinds[PUPPETS].level_count - 1u);
    expect_marks(&s, PUPPETS, 2, "walking, at the coarsest level");
    close_shot(&s);
}

/* ---- size, one draw, a lost context ---- */

/* Where the green is: its middle, and how many pixels it covers. */
static double green(const uint8_t *rgba, double middle[2])
{
    double count = 0.0;
    middle[0] = middle[1] = 0.0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        if (rgba[4u * i + 1u] < rgba[4u * i] + 60) continue;
        count += 1.0;
        middle[0] += i % WIDTH;
        middle[1] += i / WIDTH;
    }
    middle[0] /= fmax(count, 1.0), middle[1] /= fmax(count, 1.0);
    return count;
}

/* The source's u = 0.5 + 2 s (p - c) . R / (s / 4) makes a mark of 0.0625 metres right and every other one wrong: at
 * its edge it is 0.5 + 8 s, where ours is 1 for any size, so that areas go by the square of sizes. Nor is a mark on a
 * triangle larger than itself lost, as where vertices alone are asked: the forehead's are farther apart than the
 * smallest spot here. */
static void a_mark_is_as_large_as_asked(void **state)
{
    static const float shares[3] = { 0.02f, 0.04f, 0.08f };
    double area[3], middle[3][2];
    noh_stage_hit hit;
    shot s;
    (void)state;
    open_shot(&s, MASKS);
    assert_true(pick(&s, 112.0, 60.0, &hit)); /* the forehead */
    for (int i = 0; i < 3; i++) {
        const noh_decal_desc look = { .size = shares[i] * s.size, .color = { 0, 200, 0, 255 } };
        uint8_t *rgba;
        noh_decals_init(&s.ring, 0, 0, 0);
        assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hit, &look, NULL, NULL), NOH_OK);
        rgba = picture(&s, 1);
        area[i] = green(rgba, middle[i]);
        free(rgba);
        assert_true(fabs(0.5 + 8.0 * (double)look.size - 1.0) > 0.2); /* the source's edge */
    }
    print_message("areas %g, %g, %g pixels\n", area[0], area[1], area[2]);
    for (int i = 1; i < 3; i++) {
        assert_true(fabs(area[i] / area[i - 1] - 4.0) < 0.8);
        assert_true(hypot(middle[i][0] - middle[0][0], middle[i][1] - middle[0][1]) < 4.0);
    }
    close_shot(&s);
}

/* At the coarsest level a mark is where it was, except for that level's error. */
static void a_mark_stays_where_it_is_when_the_level_changes(void **state)
{
    noh_decal_desc look = { .color = { 0, 200, 0, 255 } };
    noh_actor_detail detail;
    double fine[2], coarse[2], areas[2];
    noh_stage_hit hit;
    uint8_t *rgba;
    shot s;
    (void)state;
    open_shot(&s, MASKS);
    look.size = 0.1f * s.size;
    assert_true(pick(&s, 112.0, 60.0, &hit));
    assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    rgba = picture(&s, 1);
    areas[0] = green(rgba, fine);
    free(rgba);
    set_level(&s, s.c.plan.kinds[MASKS].level_count - 1u);
    rgba = picture(&s, 1);
    areas[1] = green(rgba, coarse);
    free(rgba);
    assert_int_equal(noh_actor_detail_of(s.c.stage, s.actor, &detail, NULL), NOH_OK);
    print_message("moved by %.2f pixels, where the level is off by %.2f\n",
                  hypot(fine[0] - coarse[0], fine[1] - coarse[1]), (double)(detail.error_m * detail.pixels_per_metre));
    assert_true(hypot(fine[0] - coarse[0], fine[1] - coarse[1]) <=
                1.25 * fmax((double)(detail.error_m * detail.pixels_per_metre), 0.4));
    assert_true(areas[1] > 0.85 * areas[0] && areas[1] < 1.15 * areas[0]);
    close_shot(&s);
}

static void sixty_four_are_one_draw_and_come_back(void **state)
{
    uint8_t *before, *after;
    uint64_t bytes;
    int row_length = 0;
    shot s;
    (void)state;
    open_shot(&s, MASKS);
    bytes = noh_gl_ledger_bytes(&s.g->ledger);
    assert_int_equal(strike(&s, 14, 0.03f, 64), 64);
    s.g->gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 70); /* whatever a game has set, while rows are sent */
    before = picture(&s, 1);
    s.g->gl.GetIntegerv(GL_UNPACK_ROW_LENGTH, &row_length);
    assert_int_equal(row_length, 70);
    s.g->gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    assert_int_equal(s.decals.draws, 1);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), bytes);
    noh_stage_decals_delete(&s.decals);
    assert_int_equal(bytes - noh_gl_ledger_bytes(&s.g->ledger), NOH_STAGE_DECALS_BYTES + NOH_GL_RENDERER_BYTES);
    {
        const noh_gl_device d = device_of(s.g);
        assert_int_equal(
            noh_stage_decals_create(s.c.stage, &d, s.memory, noh_stage_decals_size(s.c.stage), NULL, &s.decals, NULL),
            NOH_OK);
    }
    assert_int_equal(noh_stage_decals_restore(&s.decals, NULL, NULL, 0, NULL), NOH_OK);
    after = picture(&s, 1);
    assert_memory_equal(before, after, PIXELS * 4u);
    assert_int_equal(noh_stage_despawn(s.c.stage, s.actor, NULL), NOH_OK);
    assert_int_equal(noh_stage_decals_draw(&s.decals, 0, s.actor, &s.ring, NULL), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_stage_decals_draw(&s.decals, 7, s.actor, &s.ring, NULL), NOH_ERR_ARG);
    free(before);
    free(after);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_stay_through_a_smile_and_levels),
        cmocka_unit_test(marks_stay_through_a_walk),
        cmocka_unit_test(a_mark_is_as_large_as_asked),
        cmocka_unit_test(a_mark_stays_where_it_is_when_the_level_changes),
        cmocka_unit_test(sixty_four_are_one_draw_and_come_back),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
