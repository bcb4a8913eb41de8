/* Marks drawn as triangles that were grown: coordinates to a texel through smiles, walks and levels; nothing on what
 * only touches at rest; all of a mesh in one draw; room, fades, a lost context. */
#include "support/decal_fixture.h"
#include "support/srgb.h"
#include "gl/stage/stage_patch_internal.h"
#include "stage/actors/decal_grow_internal.h"

#include <math.h>

#define TEXELS 256u /* of the picture, each way */

/* ---- coordinates ---- */

/* A picture whose red and green are the numbers of its columns and rows. */
static GLuint numbered(const noh_gl_api *gl)
{
    static uint8_t texels[TEXELS * TEXELS][4];
    GLuint name;
    for (uint32_t i = 0; i < TEXELS * TEXELS; i++) {
        texels[i][0] = (uint8_t)(i % TEXELS), texels[i][1] = (uint8_t)(i / TEXELS);
        texels[i][2] = 77, texels[i][3] = 255;
    }
    gl->GenTextures(1, &name);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, name);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_SRGB8_ALPHA8, TEXELS, TEXELS);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, TEXELS, TEXELS, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    return name;
}

static int is_changed(const uint8_t *a, const uint8_t *b, size_t pixel)
{
    return memcmp(a + 4u * pixel, b + 4u * pixel, 3) != 0;
}

/* Whether the mark is on a pixel and on its four neighbours: on its border, samples with and without it are mixed. */
static int is_inside(const uint8_t *with, const uint8_t *without, uint32_t x, uint32_t y)
{
    const size_t at = (size_t)y * WIDTH + x;
    return is_changed(with, without, at) && is_changed(with, without, at - 1u) && is_changed(with, without, at + 1u) &&
           is_changed(with, without, at - WIDTH) && is_changed(with, without, at + WIDTH);
}

/* Where a place of the picture is on the mark, in texels. 0: nothing is there. */
static int texel_at(const shot *s, surface *meshes, uint32_t count, double x, double y, double at[2])
{
    noh_pick_hit hit;
    float uv[2];
    if (!rest_at(s, meshes, count, x, y, &hit)) return 0;
    noh_decal_uv(&s->ring.decals[0], hit.bind_point, uv);
    for (int k = 0; k < 2; k++) at[k] = (double)(uv[k] * (float)TEXELS);
    return 1;
}

/* Whether a pixel has one flat surface alone: samples of an edge or a crease are mixed, and then no texel is right. */
static int is_whole(const shot *s, surface *meshes, uint32_t count, double x, double y, const double middle[2])
{
    static const double half[2][2] = { { 0.5, 0.5 }, { 0.5, -0.5 } };
    for (uint32_t i = 0; i < 2; i++) {
        double a[2], b[2];
        if (!texel_at(s, meshes, count, x - half[i][0], y - half[i][1], a)) return 0;
        if (!texel_at(s, meshes, count, x + half[i][0], y + half[i][1], b)) return 0;
        if (hypot(a[0] - middle[0], a[1] - middle[1]) > 12.0) return 0;
        if (hypot(0.5 * (a[0] + b[0]) - middle[0], 0.5 * (a[1] + b[1]) - middle[1]) > 0.5) return 0;
    }
    return 1;
}

/* How far the texels of the mark's pixels are from where they should be; one of every `step` is looked at, each way. */
static void expect_texels(shot *s, uint32_t kind, uint32_t mesh_count, uint32_t step, const char *pose)
{
    surface meshes[4];
    uint8_t *without = picture(s, WITHOUT), *with = picture(s, GROWN);
    uint32_t seen = 0;
    double most = 0.0;
    for (uint32_t m = 0; m < mesh_count; m++) open_surface(s, kind, m, &meshes[m]);
    for (uint32_t y = 1; y < HEIGHT - 1u; y += step) {
        for (uint32_t x = 1; x < WIDTH - 1u; x += step) {
            const uint8_t *rgba = with + 4u * ((size_t)y * WIDTH + x);
            double at[2];
            if (!is_inside(with, without, x, y) || abs(rgba[2] - 77) > 1) continue;
            if (!texel_at(s, meshes, mesh_count, x, y, at)) continue;
            if (!is_whole(s, meshes, mesh_count, x, y, at)) continue;
            seen++;
            for (int k = 0; k < 2; k++) most = fmax(most, fabs(rgba[k] + 0.5 - at[k]));
        }
    }
    print_message("%s: %u pixels, off by at most %.2f texels\n", pose, seen, most - 0.5);
    assert_true(seen > 8);
    assert_true(most <= 1.5); /* the middle of a texel is half of one from its sides */
    for (uint32_t m = 0; m < mesh_count; m++) close_surface(&meshes[m]);
    free(with);
    free(without);
}

/* A shot of an unlit actor with one large mark that has the numbered picture. */
static GLuint open_numbered(shot *s, uint32_t kind, double x, double y, float share)
{
    noh_decal_desc look = { .color = { 255, 255, 255, 255 } };
    noh_stage_hit hit;
    GLuint texture;
    open_shot_as(s, kind, 1);
    texture = numbered(&s->g->gl);
    look.size = share * s->size;
    s->decals.picture.texture = texture;
    s->decals.picture.columns = s->decals.picture.rows = 1;
    assert_true(pick(s, x, y, &hit));
    assert_int_equal(noh_decals_strike(&s->ring, s->c.stage, &hit, &look, NULL, NULL), NOH_OK);
    open_patches(s, 16384);
    return texture;
}

static void a_smile_and_levels_keep_every_texel(void **state)
{
    shot s;
    uint32_t smile, levels;
    GLuint texture;
    (void)state;
    texture = open_numbered(&s, MASKS, 90.0, 140.0, 0.12f); /* a cheek, which smiles */
    levels = s.c.plan.kinds[MASKS].level_count;
    expect_texels(&s, MASKS, 1, 13, "at rest");
    smile = noh_stage_find(s.c.stage, MASKS, NOH_NAME_FLOAT, "smile");
    assert_int_equal(noh_actor_hold_float(s.c.stage, s.actor, smile, 1.0f, 1.0f, NULL), NOH_OK);
    frame(&s);
    expect_texels(&s, MASKS, 1, 13, "smiling");
    for (uint32_t level = 1; level < levels; level += levels - 2u) {
        set_level(&s, level);
        expect_texels(&s, MASKS, 1, 13, "smiling, at a coarser level");
    }
    assert_int_equal(s.patches.left_out, 0);
    s.g->gl.DeleteTextures(1, &texture);
    close_shot(&s);
}

static void a_walk_keeps_every_texel(void **state)
{
    const noh_play play = { .fade_ticks = 1, .start_ticks = 20000 };
    shot s;
    GLuint texture;
    (void)state;
    texture = open_numbered(&s, PUPPETS, 120.0, 150.0, 0.12f);
    expect_texels(&s, PUPPETS, 2, 5, "at rest");
    assert_int_equal(noh_actor_play(s.c.stage, s.actor, 0, "walk", &play, NULL), NOH_OK);
    frame(&s);
    expect_texels(&s, PUPPETS, 2, 5, "walking");
    set_level(&s, s.c.plan.kinds[PUPPETS].level_count - 1u);
    expect_texels(&s, PUPPETS, 2, 5, "walking, at the coarsest level");
    s.g->gl.DeleteTextures(1, &texture);
    close_shot(&s);
}

/* ---- folds ---- */

/* Whether a triangle of the patch is at a place of the picture, or within a pixel of it. */
static int is_of(const shot *s, surface *u, const noh_decal_patch *patch, double x, double y)
{
    for (uint32_t i = 0; i < 9; i++) {
        static const double steps[3] = { 0.0, -1.0, 1.0 };
        noh_pick_hit hit;
        if (!rest_at(s, u, 1, x + steps[i % 3u], y + steps[i / 3u], &hit)) continue;
        for (uint32_t k = 0; k < patch->count; k++) {
            if (patch->triangles[k] == hit.triangle) return 1;
        }
    }
    return 0;
}

/* A mark on the upper lip: looked up by place it is also on the teeth behind it, and on the lower lip, which rests
 * there. Grown it is only on triangles of its own, wherever they are by now. */
static void what_touches_at_rest_does_not_share_a_mark(void **state)
{
    shot s;
    surface u;
    noh_decal_desc look = { .color = { 0, 200, 0, 255 } };
    noh_decal_patch patch = { NULL, 8192, 0, 0, 0 };
    noh_stage_hit hit;
    uint8_t *without, *resting, *grown;
    uint32_t jaw, own = 0, shared = 0, wrong = 0;
    (void)state;
    open_shot(&s, MASKS);
    open_patches(&s, 8192);
    look.size = 0.09f * s.size;
    assert_true(pick(&s, 111.0, 158.0, &hit));
    assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    jaw = noh_stage_find(s.c.stage, MASKS, NOH_NAME_FLOAT, "jawOpen");
    assert_int_equal(noh_actor_hold_float(s.c.stage, s.actor, jaw, 1.0f, 1.0f, NULL), NOH_OK);
    frame(&s);
    open_surface(&s, MASKS, 0, &u);
    patch.triangles = test_zeros(patch.room * sizeof(uint32_t));
    noh_decal_grow(&s.ring.decals[0], &u.mesh, hit.triangle, &patch);
    without = picture(&s, WITHOUT), resting = picture(&s, RESTING), grown = picture(&s, GROWN);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const int has = is_changed(grown, without, i);
        if (!has && !is_changed(resting, without, i)) continue;
        shared += !has;
        if (i % 47 || !has) continue;
        own++;
        wrong += !is_of(&s, &u, &patch, (double)(i % WIDTH), i / WIDTH);
    }
    print_message("%u pixels have the mark, %u are not on its own triangles; %u have it by place alone\n", own, wrong,
                  shared);
    assert_true(own > 40 && wrong == 0 && shared > 20);
    free(patch.triangles);
    free(without);
    free(resting);
    free(grown);
    close_surface(&u);
    close_shot(&s);
}

/* On a forehead nothing folds: both ways are the same picture, at each level and while levels fade. */
static void on_one_surface_both_ways_are_the_same_picture(void **state)
{
    noh_decal_desc look = { .color = { 0, 200, 0, 255 } };
    noh_stage_hit hit;
    shot s;
    uint32_t levels, grown;
    (void)state;
    open_shot(&s, MASKS);
    open_patches(&s, 0);
    look.size = 0.05f * s.size;
    for (uint32_t i = 0; i < 3; i++) {
        assert_true(pick(&s, 100.0 + 12.0 * i, 78.0, &hit));
        assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    }
    levels = s.c.plan.kinds[MASKS].level_count;
    for (uint32_t level = 0; level < levels; level++) {
        uint8_t *resting, *own;
        set_level(&s, level);
        resting = picture(&s, RESTING), own = picture(&s, GROWN);
        assert_memory_equal(resting, own, PIXELS * 4u);
        free(resting);
        free(own);
    }
    grown = s.patches.grown;
    assert_int_equal(grown, 3u * levels);
    set_level(&s, levels - 2u); /* two levels are kept */
    free(picture(&s, GROWN));
    set_level(&s, levels - 1u);
    free(picture(&s, GROWN));
    assert_int_equal(s.patches.grown, grown);
    close_shot(&s);
}

/* ---- one draw, room ---- */

static uint32_t draw_calls;
static PFNGLDRAWELEMENTSPROC real_draw;
static void GL_APIENTRY counted_draw(GLenum mode, GLsizei count, GLenum type, const void *first)
{
    draw_calls++;
    real_draw(mode, count, type, first);
}

static void sixty_four_are_one_draw_and_come_back(void **state)
{
    uint64_t bytes;
    uint8_t *before, *after;
    noh_gl_api *gl;
    shot s;
    (void)state;
    open_shot(&s, MASKS);
    gl = &s.g->gl;
    bytes = noh_gl_ledger_bytes(&s.g->ledger);
    open_patches(&s, 0);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger) - bytes,
                     NOH_STAGE_PATCHES_BYTES(NOH_DECALS_MAX, NOH_DECALS_MAX * NOH_DECAL_TRIANGLES));
    bytes = noh_gl_ledger_bytes(&s.g->ledger);
    for (uint32_t i = 0; i < 64; i++) { /* all on the skin: one submesh */
        const noh_decal_desc look = { .size = 0.01f * s.size, .color = { 200, 0, 0, 255 } };
        noh_stage_hit hit;
        assert_true(pick(&s, 92.0 + 4.0 * (i % 8), 64.0 + 4.0 * (i / 8), &hit));
        assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    }
    real_draw = gl->DrawElements;
    gl->DrawElements = counted_draw;
    draw_calls = 0;
    free(picture(&s, WITHOUT));
    {
        const uint32_t plain = draw_calls;
        before = picture(&s, GROWN);
        assert_int_equal(draw_calls, 2u * plain + 1u);
    }
    gl->DrawElements = real_draw;
    assert_int_equal(s.patches.grown, 64);
    assert_int_equal(s.patches.left_out, 0);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), bytes);
    assert_int_equal(noh_stage_decals_restore(&s.decals, NULL, NULL, 0, NULL), NOH_OK);
    assert_int_equal(noh_stage_patches_restore(&s.patches, NULL), NOH_OK);
    after = picture(&s, GROWN);
    assert_memory_equal(before, after, PIXELS * 4u);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), bytes);
    free(before);
    free(after);
    for (uint32_t i = 0; i < 5; i++) { /* the oldest five make room: what the others have grown is kept, and moves up */
        const noh_decal_desc look = { .size = 0.01f * s.size, .color = { 0, 0, 200, 255 } };
        noh_stage_hit hit;
        assert_true(pick(&s, 94.0 + 4.0 * i, 100.0, &hit));
        assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    }
    const uint32_t grown = s.patches.grown;
    before = picture(&s, GROWN);
    assert_int_equal(s.patches.grown, grown + 5);
    assert_int_equal(noh_stage_patches_restore(&s.patches, NULL), NOH_OK);
    after = picture(&s, GROWN);
    assert_memory_equal(before, after, PIXELS * 4u);
    free(before);
    free(after);
    close_shot(&s);
}

/* The mark's part of a pixel's green, which it has none of: by the same picture without it. */
static double part_of_mark(const uint8_t *without, const uint8_t *with, size_t pixel)
{
    return 1.0 - decoded(with[4u * pixel + 1u]) / decoded(without[4u * pixel + 1u]);
}

/* Drawn once for each attribute group of the mesh below it, as the source draws its decals, a mark that is half
 * transparent covers nearly all. */
static void a_mark_is_drawn_once_for_all_groups(void **state)
{
    const double half = 128.0 / 255.0;
    noh_stage_hit hit;
    uint8_t *without, *once, *groups;
    shot s;
    (void)state;
    open_shot_as(&s, MASKS, 1);
    const noh_mesh mesh = test_mesh(&s.c.packs[MASKS], 0);
    const uint32_t count = mesh.header->submesh_count;
    const noh_decal_desc look = { .size = 0.12f * s.size, .color = { 255, 0, 0, 128 } };
    assert_true(count > 1 && pick(&s, 90.0, 140.0, &hit));
    assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hit, &look, NULL, NULL), NOH_OK);
    open_patches(&s, 16384);
    without = picture(&s, WITHOUT);
    once = picture(&s, GROWN);
    canvas_begin(&s.to);
    assert_int_equal(noh_stage_draw(s.c.stage, NOH_PASS_OPAQUE, 0, NULL, NULL), NOH_OK);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(noh_stage_patches_draw(&s.patches, 0, s.actor, &s.ring, NULL), NOH_OK);
    }
    groups = test_zeros(PIXELS * 4u);
    assert_int_equal(canvas_read(&s.to, groups), 0);
    const size_t at = 140u * WIDTH + 90u;
    const double ours = part_of_mark(without, once, at), literal = part_of_mark(without, groups, at);
    print_message("a mark of %.2f: %.2f drawn once, %.2f once for each of %u groups\n", half, ours, literal, count);
    assert_true(fabs(ours - half) < 0.02);
    assert_true(literal > half + 0.2);
    free(without);
    free(once);
    free(groups);
    close_shot(&s);
}

/* 10,000 hits in a ring of 64, drawn now and then, in room that they do not all fit: what is there stays as it was
 * planned, and the last mark shows. */
static void ten_thousand_hits_take_nothing(void **state)
{
    uint64_t bytes;
    shot s;
    noh_stage_hit hits[64];
    uint32_t count = 0;
    uint8_t *without, *with;
    (void)state;
    open_shot(&s, MASKS);
    open_patches(&s, 300);
    for (uint32_t i = 0; i < 4096 && count < 64; i++) {
        count += (uint32_t)pick(&s, (i * 37u) % WIDTH + 0.5, (i * 101u) % HEIGHT + 0.5, &hits[count]);
    }
    assert_int_equal(count, 64);
    bytes = noh_gl_ledger_bytes(&s.g->ledger);
    for (uint32_t i = 0; i < 10000; i++) {
        const noh_decal_desc look = { .size = (0.002f + 0.004f * (float)(i % 7u)) * s.size, .tile = i % 5u };
        assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hits[(i * 29u) % 64u], &look, NULL, NULL), NOH_OK);
        if (i % 5000u == 4999u) free(picture(&s, GROWN));
    }
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), bytes);
    assert_true(s.patches.left_out > 0);
    noh_decals_init(&s.ring, 4, 10, 10); /* the same room, another ring; then it fades away */
    {
        const noh_decal_desc look = { .size = 0.03f * s.size, .color = { 0, 200, 0, 255 } };
        assert_int_equal(noh_decals_strike(&s.ring, s.c.stage, &hits[0], &look, NULL, NULL), NOH_OK);
    }
    without = picture(&s, WITHOUT), with = picture(&s, GROWN);
    assert_memory_not_equal(without, with, PIXELS * 4u);
    free(with);
    noh_decals_step(&s.ring, 30);
    with = picture(&s, GROWN);
    assert_memory_equal(without, with, PIXELS * 4u);
    free(with);
    free(without);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_smile_and_levels_keep_every_texel),
        cmocka_unit_test(a_walk_keeps_every_texel),
        cmocka_unit_test(what_touches_at_rest_does_not_share_a_mark),
        cmocka_unit_test(on_one_surface_both_ways_are_the_same_picture),
        cmocka_unit_test(sixty_four_are_one_draw_and_come_back),
        cmocka_unit_test(a_mark_is_drawn_once_for_all_groups),
        cmocka_unit_test(ten_thousand_hits_take_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
