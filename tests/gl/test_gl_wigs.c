/* Hair of a crowd: of whom it moves, in which bytes, in how many draws; a crowd of one looks like one; far away it
 * fades into what is painted on heads. */
#include "support/gl_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file/pack_file.h"
#include "gpu/canvas.h"
#include "life/hair/haircut.h"
#include "stage/actors/wigs.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define SIDE 192u
#define ACTORS_MAX 12u
#define TICKS 800u

typedef struct scene {
    gpu *g;
    pack_file file;
    noh_haircut cut;
    noh_wig wig;
    noh_stage_part part;
    noh_kind_desc kind;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    noh_actor actors[ACTORS_MAX];
    noh_wigs_desc wigs_desc;
    noh_wigs *wigs;
    noh_stage_hairs hairs;
    void *memory, *wigs_memory, *hairs_memory;
    canvas c;
} scene;

static void open_stage(scene *s, uint32_t actors)
{
    static char path[1024];
    const char *build = getenv("NOH_BUILD");
    const noh_gl_device device = { &s->g->gl, &s->g->caps, &s->g->ledger, NULL, 0 };
    snprintf(path, sizeof path, "%s/wig.noh", build ? build : "build");
    assert_int_equal(pack_file_open(&s->file, path), 0);
    assert_int_equal(noh_haircut_open(&s->file.pack, &s->cut, NULL), NOH_OK);
    assert_int_equal(noh_wig_make(&s->cut, &s->file.pack, NOH_NONE, &s->wig, NULL), NOH_OK);
    s->part = noh_wig_part(&s->wig);
    s->kind.mesh = &s->file.pack;
    s->kind.skeleton = NOH_NONE;
    s->kind.actor_count = s->kind.near_count = actors;
    s->kind.parts = &s->part;
    s->kind.part_count = 1;
    s->desc.kinds = &s->kind;
    s->desc.kind_count = 1;
    s->desc.height_px = SIDE;
    s->desc.gpu = &noh_stage_on_gl;
    assert_int_equal(noh_stage_plan_make(&s->desc, &s->g->caps, &s->plan, NULL), NOH_OK);
    s->memory = test_aligned(NULL, (size_t)s->plan.cpu_bytes);
    assert_int_equal(noh_stage_init(s->memory, (size_t)s->plan.cpu_bytes, &device, &s->desc, &s->plan, &s->stage, NULL),
                     NOH_OK);
}

static void open_hair(scene *s, uint32_t actors, uint32_t near_max)
{
    const noh_gl_device device = { &s->g->gl, &s->g->caps, &s->g->ledger, NULL, 0 };
    s->wigs_desc = (noh_wigs_desc){ &s->wig, 0, actors, near_max };
    const size_t bytes = noh_wigs_size(&s->wigs_desc), drawn = noh_stage_hairs_size(&s->wigs_desc);
    s->wigs_memory = test_aligned(NULL, bytes);
    s->hairs_memory = test_aligned(NULL, drawn);
    assert_int_equal(noh_wigs_init(s->wigs_memory, bytes, &s->wigs_desc, &s->wigs, NULL), NOH_OK);
    assert_int_equal(noh_stage_hairs_create(&device, s->wigs, s->hairs_memory, drawn, 0, 0, &s->hairs, NULL), NOH_OK);
}

/* Side by side, each further from the camera than the one before by `apart` metres. */
static void open_scene(scene *s, uint32_t actors, uint32_t near_max, float apart)
{
    memset(s, 0, sizeof *s);
    s->g = fixture_gpu();
    open_stage(s, actors);
    open_hair(s, actors, near_max);
    for (uint32_t i = 0; i < actors; i++) {
        const noh_place place = { { 0.3f * ((float)i - 0.5f * (float)(actors - 1u)), 0.0f, -apart * (float)i },
                                  { 0, 0, 0, 0 },
                                  0.0f };
        assert_int_equal(noh_stage_spawn(s->stage, 0, &place, &s->actors[i], NULL), NOH_OK);
    }
    assert_int_equal(canvas_open(&s->c, s->g, SIDE, SIDE), 0);
}

static void close_scene(scene *s)
{
    canvas_close(&s->c);
    noh_stage_hairs_delete(&s->hairs);
    noh_stage_delete(s->stage);
    pack_file_close(&s->file);
    free(s->memory);
    free(s->wigs_memory);
    free(s->hairs_memory);
    assert_int_equal(noh_gl_ledger_bytes(&s->g->ledger), 0);
    fixture_expect_no_errors();
}

static void frame(scene *s, float distance)
{
    const float target[3] = { 0.0f, 0.0f, 0.0f };
    noh_stage_view view;
    noh_view_orbit(&view, target, 0.0f, 0.0f, distance, SIDE, SIDE);
    assert_int_equal(noh_stage_frame(s->stage, TICKS, &view, NULL, NULL, NULL), NOH_OK);
    noh_wigs_frame(s->wigs, s->stage, TICKS);
}

/* hair  0: none, 1: the crowd's, 2: the first actor's own */
static uint8_t *picture(scene *s, int hair, noh_stage_hair *own)
{
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4u);
    noh_stage_hairs_update(&s->hairs);
    if (hair == 2) assert_int_equal(noh_stage_hair_update(own, s->stage, s->actors[0], 0, NULL), NOH_OK);
    canvas_begin(&s->c);
    assert_int_equal(noh_stage_draw(s->stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    if (hair == 1) noh_stage_hairs_draw(&s->hairs, s->stage, 0, NOH_PASS_COLOR);
    if (hair == 2) noh_stage_hair_draw(own, s->stage, 0, NOH_PASS_COLOR);
    canvas_resolve(&s->c);
    assert_int_equal(canvas_read(&s->c, rgba), 0);
    return rgba;
}

static uint32_t differing(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) count += memcmp(a + 4u * i, b + 4u * i, 4) != 0;
    return count;
}

/* ---- whose hair moves ---- */

static uint32_t moving(const scene *s, float *least, float *most_at_rest)
{
    uint32_t count, found = 0;
    const noh_wigs_body *bodies = noh_wigs_bodies(s->wigs, &count);
    *least = 1e9f;
    *most_at_rest = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        if (bodies[i].slot == NOH_NONE) {
            *most_at_rest = fmaxf(*most_at_rest, bodies[i].pixels_per_metre);
        } else {
            *least = fminf(*least, bodies[i].pixels_per_metre);
            found++;
        }
    }
    return found;
}

/* How far hair of a body is from its rest. */
static float swing(const scene *s, uint32_t body)
{
    const size_t count = (size_t)s->cut.desc.hair_count * s->cut.desc.point_count * 3u;
    float *points = test_zeros(count * sizeof *points), most = 0.0f;
    noh_wigs_points(s->wigs, body, points);
    for (size_t i = 0; i < count; i++) most = fmaxf(most, fabsf(points[i] - s->cut.desc.rest[i]));
    free(points);
    return most;
}

static void shake(scene *s, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++) {
        for (uint32_t i = 0; i < s->kind.actor_count; i++) {
            noh_place place;
            assert_int_equal(noh_actor_place(s->stage, s->actors[i], &place, NULL), NOH_OK);
            place.position[0] += 0.02f * cosf(0.3f * (float)f);
            assert_int_equal(noh_actor_set_place(s->stage, s->actors[i], &place, NULL), NOH_OK);
        }
        frame(s, 3.0f);
    }
}

static void hair_of_the_largest_moves(void **state)
{
    scene s;
    float least, most;
    uint32_t count;
    (void)state;
    open_scene(&s, ACTORS_MAX, 4, 0.05f);
    shake(&s, 12);
    assert_int_equal(moving(&s, &least, &most), 4);
    assert_true(least >= most);
    const noh_wigs_body *bodies = noh_wigs_bodies(s.wigs, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (bodies[i].slot == NOH_NONE) assert_true(swing(&s, i) == 0.0f);
        if (bodies[i].slot != NOH_NONE) assert_true(swing(&s, i) > 0.002f);
    }
    const noh_place near = { { 0.0f, 0.0f, 1.5f }, { 0, 0, 0, 0 }, 0.0f }, away = { { 0.0f, 0.0f, 9e3f }, { 0 }, 0.0f };
    assert_int_equal(noh_actor_set_place(s.stage, s.actors[ACTORS_MAX - 1u], &near, NULL), NOH_OK);
    frame(&s, 3.0f);
    assert_int_equal(moving(&s, &least, &most), 4);
    bodies = noh_wigs_bodies(s.wigs, &count);
    assert_true(count > 4 && bodies[count - 1u].slot != NOH_NONE);
    for (uint32_t i = 0; i < ACTORS_MAX - 1u; i++) {
        assert_int_equal(noh_actor_set_place(s.stage, s.actors[i], &away, NULL), NOH_OK);
    }
    frame(&s, 3.0f);
    assert_int_equal(moving(&s, &least, &most), 1); /* only one is seen */
    close_scene(&s);
}

/* Who is small hangs as at rest though there is room, and swings more and more as it comes nearer. */
static void hair_moves_more_as_it_comes_nearer(void **state)
{
    scene s;
    float before = 0.0f, least, most;
    uint32_t count;
    (void)state;
    open_scene(&s, 1, 1, 0.0f);
    for (float distance = 16.0f; distance > 1.0f; distance *= 0.7f) {
        frame(&s, distance);
        const noh_wigs_body *b = noh_wigs_bodies(s.wigs, &count);
        assert_int_equal(count, b->pixels_per_metre > 25.0f);
        if (!count) continue;
        assert_int_equal(moving(&s, &least, &most), b->pixels_per_metre > NOH_WIGS_MOVING_PIXELS);
        assert_true(b->moves >= before && b->moves <= 1.0f);
        before = b->moves;
    }
    assert_true(before == 1.0f);
    close_scene(&s);
}

/* ---- bytes and draws ---- */

static void bytes_are_exact(void **state)
{
    scene s;
    noh_wigs *wigs = NULL;
    noh_stage_hairs hairs;
    uint8_t *before, *after;
    (void)state;
    open_scene(&s, ACTORS_MAX, 4, 0.05f);
    const noh_gl_device device = { &s.g->gl, &s.g->caps, &s.g->ledger, NULL, 0 };
    const size_t bytes = noh_wigs_size(&s.wigs_desc), drawn = noh_stage_hairs_size(&s.wigs_desc);
    uint8_t *memory = test_aligned(NULL, bytes + drawn);
    assert_int_equal(noh_wigs_init(memory, bytes - 1u, &s.wigs_desc, &wigs, NULL), NOH_ERR_MEMORY);
    assert_int_equal(noh_stage_hairs_create(&device, s.wigs, memory, drawn - 1u, 0, 0, &hairs, NULL), NOH_ERR_MEMORY);
    noh_wigs_desc bad = s.wigs_desc;
    bad.near_max = NOH_WIGS_NEAR_MAX + 1u;
    assert_int_equal(noh_wigs_size(&bad), 0);
    assert_int_equal(noh_wigs_init(memory, bytes, &bad, &wigs, NULL), NOH_ERR_ARG);
    free(memory);
    const uint64_t used = noh_gl_ledger_bytes(&s.g->ledger);
    noh_stage_hairs_delete(&s.hairs);
    assert_int_equal(used - noh_gl_ledger_bytes(&s.g->ledger), noh_stage_hairs_bytes(&s.wigs_desc));
    assert_int_equal(noh_stage_hairs_restore(&s.hairs, NULL, 0, NULL), NOH_OK);
    assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), used);
    shake(&s, 4);
    before = picture(&s, 1, NULL);
    noh_stage_hairs_delete(&s.hairs);
    assert_int_equal(noh_stage_hairs_restore(&s.hairs, NULL, 0, NULL), NOH_OK);
    after = picture(&s, 1, NULL);
    assert_int_equal(differing(before, after), 0);
    free(before);
    free(after);
    close_scene(&s);
}

/* From heads that fill the picture to some that are a few pixels. */
static void all_heads_are_some_draws(void **state)
{
    scene s;
    uint32_t count, strips = 0;
    (void)state;
    open_scene(&s, ACTORS_MAX, 4, 0.8f);
    frame(&s, 1.5f);
    const uint32_t draws = s.hairs.hair.draws;
    free(picture(&s, 1, NULL));
    const noh_wigs_body *bodies = noh_wigs_bodies(s.wigs, &count);
    for (uint32_t i = 0; i < count; i++) strips += noh_haircut_strips(&s.cut, bodies[i].pixels_per_metre);
    printf("# %u heads, %u strips, %u draws\n", count, strips, s.hairs.hair.draws - draws);
    assert_true(count > 6);
    assert_int_equal(s.hairs.strips, strips);
    assert_true(s.hairs.hair.draws - draws <= 2u * NOH_HAIRS_GROUPS);
    close_scene(&s);
}

/* ---- what is seen ---- */

static void a_crowd_of_one_looks_like_one(void **state)
{
    static const float distances[] = { 0.8f, 2.5f, 4.0f };
    scene s;
    noh_stage_hair own;
    (void)state;
    open_scene(&s, 1, 0, 0.0f);
    const noh_gl_device device = { &s.g->gl, &s.g->caps, &s.g->ledger, NULL, 0 };
    const size_t bytes = noh_stage_hair_size(&s.cut);
    void *memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_stage_hair_create(&device, &s.wig, memory, bytes, 0, 0, &own, NULL), NOH_OK);
    for (size_t i = 0; i < TEST_COUNT(distances); i++) {
        frame(&s, distances[i]);
        memset(noh_actor_part(s.stage, s.actors[0], 0), 0, s.part.state_bytes); /* at rest */
        uint8_t *bald = picture(&s, 0, NULL), *crowd = picture(&s, 1, NULL), *one = picture(&s, 2, &own);
        const uint32_t hair = differing(one, bald), off = differing(one, crowd);
        printf("# at %.1f m: %u pixels of hair, %u differ\n", (double)distances[i], hair, off);
        assert_true(hair > 20);
        assert_true(off <= hair / 50u);
        free(bald);
        free(crowd);
        free(one);
    }
    noh_stage_hair_delete(&own);
    free(memory);
    close_scene(&s);
}

static double difference(const uint8_t *a, const uint8_t *b)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < 4u * SIDE * SIDE; i++) sum += abs((int)a[i] - (int)b[i]);
    return sum / 255.0;
}

/* How much of it still shows, of the area that it would take, by how far it has faded. */
static void hair_fades_into_paint(void **state)
{
    scene s;
    double share[3];
    uint32_t count;
    float distance = 8.0f;
    (void)state;
    open_scene(&s, ACTORS_MAX, 0, 0.0f);
    for (int i = 0; i < 3; i++) { /* at 51, 37.5 and 24 pixels a metre */
        const float wanted = i == 0 ? 51.0f : i == 1 ? 37.5f : 24.0f;
        frame(&s, distance);
        const noh_wigs_body *b = noh_wigs_bodies(s.wigs, &count);
        if (count) distance *= b->pixels_per_metre / wanted;
        frame(&s, distance);
        b = noh_wigs_bodies(s.wigs, &count);
        uint8_t *bald = picture(&s, 0, NULL), *hair = picture(&s, 1, NULL);
        const double area = (double)(wanted * wanted) * 0.04 * ACTORS_MAX;
        share[i] = difference(hair, bald) / area;
        printf("# %.1f pixels a metre, fade %.2f: %.3f\n", (double)(count ? b->pixels_per_metre : 0.0f),
               (double)noh_haircut_fade(count ? b->pixels_per_metre : 0.0f), share[i]);
        free(bald);
        free(hair);
    }
    assert_true(share[0] > 0.05);
    assert_true(share[1] > 0.4 * share[0] && share[1] < 0.6 * share[0]);
    assert_true(share[2] == 0.0);
    close_scene(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(hair_of_the_largest_moves),
    cmocka_unit_test(hair_moves_more_as_it_comes_nearer),
    cmocka_unit_test(bytes_are_exact),
    cmocka_unit_test(all_heads_are_some_draws),
    cmocka_unit_test(a_crowd_of_one_looks_like_one),
    cmocka_unit_test(hair_fades_into_paint),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
