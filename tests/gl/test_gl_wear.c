/* What a garment hides of its wearer is not drawn: with the garment on, the picture is as without it; planned to the
 * byte; sets of garments share the room that there is; and all of it is there again after a lost context. */
#include "support/stage_fixture.h"

#include "gpu/canvas.h"
#include "support/gl_fixture.h"
#include "gl/stage/stage_gl_internal.h"

#define WIDTH 256u
#define HEIGHT 256u
#define PIXELS (WIDTH * HEIGHT)

enum { BODIES, COATS, KINDS };
static noh_error said;

typedef struct wardrobe {
    cast c;
    noh_actor bodies[2], coats[2];
    noh_stage_view view;
} wardrobe;

/* Puppets and coats for them, as many as their kinds say; the GPU has what the plan says. */
static void open_cast(cast *c, gpu *g, uint32_t cover_count)
{
    static char log[4096];
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, log, sizeof log };
    const uint64_t before = noh_gl_ledger_bytes(&g->ledger);
    cast_map(c, BODIES, "demo/puppet_levels.noh");
    cast_map(c, COATS, "demo/coat.noh");
    for (uint32_t i = 0; i < KINDS; i++) c->kinds[i].mesh = &c->packs[i];
    c->kinds[BODIES].cover_count = cover_count;
    c->kinds[COATS].worn_by = 1u << BODIES;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = KINDS;
    c->desc.gpu = &noh_stage_on_gl;
    cast_make(c, &device);
    assert_true(noh_gl_ledger_bytes(&g->ledger) - before == c->plan.gpu_bytes);
}

static void wardrobe_open(wardrobe *w, gpu *g, uint32_t cover_count)
{
    static const float middle[3] = { 0.0f, 1.0f, 0.0f };
    memset(w, 0, sizeof *w);
    for (uint32_t i = 0; i < KINDS; i++) w->c.kinds[i].actor_count = w->c.kinds[i].near_count = 2;
    open_cast(&w->c, g, cover_count);
    for (uint32_t i = 0; i < 2; i++) {
        const noh_place place = { .position = { i ? 0.35f : -0.35f, 0.0f, 0.0f } };
        assert_int_equal(noh_stage_spawn(w->c.stage, BODIES, &place, &w->bodies[i], NULL), NOH_OK);
        assert_int_equal(noh_stage_spawn(w->c.stage, COATS, NULL, &w->coats[i], NULL), NOH_OK);
        if (noh_actor_wear(w->c.stage, w->coats[i], w->bodies[i], &said) != NOH_OK) fail_msg("%s", said.what);
    }
    noh_view_orbit(&w->view, middle, 0.0f, 0.0f, 1.6f, WIDTH, HEIGHT);
}

static void wardrobe_close(wardrobe *w)
{
    cast_close_stage(&w->c);
    noh_file_unmap(&w->c.files[0]);
    noh_file_unmap(&w->c.files[1]);
}

/* naked: the coats are on, and their meshes off */
static void draw(wardrobe *w, canvas *to, int naked, uint32_t *rgba)
{
    for (uint32_t i = 0; i < 2; i++) {
        const noh_appearance look = { .hidden_meshes = naked ? ~0u : 0, .pixels = 1e-3f };
        assert_int_equal(noh_actor_set_appearance(w->c.stage, w->coats[i], &look, NULL), NOH_OK);
    }
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(noh_stage_frame(w->c.stage, 0, &w->view, NULL, NULL, NULL), NOH_OK);
    canvas_begin(to);
    assert_int_equal(noh_stage_draw(w->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    canvas_resolve(to);
    assert_int_equal(canvas_read(to, (uint8_t *)rgba), 0);
}

static uint32_t count_different(const uint32_t *a, const uint32_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        for (uint32_t k = 0; k < 24u; k += 8u) {
            const int by = (int)(a[i] >> k & 255u) - (int)(b[i] >> k & 255u);
            if (by > 8 || by < -8) {
                count++;
                break;
            }
        }
    }
    return count;
}

/* Under the coats there is nothing; over them everything is as it was. */
static void hidden_triangles_are_not_drawn(void **state)
{
    static uint32_t whole[2][PIXELS], covered[2][PIXELS], again[PIXELS];
    gpu *g = fixture_gpu();
    canvas to;
    wardrobe w;
    (void)state;
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    wardrobe_open(&w, g, 0);
    for (int naked = 0; naked < 2; naked++) draw(&w, &to, naked, whole[naked]);
    wardrobe_close(&w);
    wardrobe_open(&w, g, 1);
    for (int naked = 0; naked < 2; naked++) draw(&w, &to, naked, covered[naked]);
    print_message("%u pixels of %u under coats, %u over them\n", count_different(whole[1], covered[1]), PIXELS,
                  count_different(whole[0], covered[0]));
    assert_true(count_different(whole[1], covered[1]) > PIXELS / 25u);
    assert_true(count_different(whole[0], covered[0]) < PIXELS / 1000u);
    assert_int_equal(noh_stage_restore(w.c.stage, &said), NOH_OK);
    draw(&w, &to, 1, again);
    assert_memory_equal(again, covered[1], sizeof again);
    wardrobe_close(&w);
    canvas_close(&to);
    fixture_expect_no_errors();
}

/* One wears a coat, the other does not; then the other way round; then both. */
static void a_set_is_shared_and_makes_way(void **state)
{
    const noh_actor nobody = { 0 };
    gpu *g = fixture_gpu();
    wardrobe w;
    (void)state;
    wardrobe_open(&w, g, 1);
    for (uint32_t way = 0; way < 3; way++) {
        const noh_stage *s = w.c.stage;
        for (uint32_t i = 0; i < 2; i++) {
            if (way == 2 || way == i) {
                assert_int_equal(noh_actor_wear(w.c.stage, w.coats[i], w.bodies[i], &said), NOH_OK);
            } else {
                assert_int_equal(noh_actor_attach(w.c.stage, w.coats[i], nobody, 0, &said), NOH_OK);
            }
        }
        assert_int_equal(noh_stage_frame(w.c.stage, 0, &w.view, NULL, NULL, NULL), NOH_OK);
        for (uint32_t i = 0; i < 2; i++) assert_int_equal(s->shown[i].cover, way == 2 || way == i);
        assert_int_equal(((const noh_stage_gl *)s->gpu)->kinds[BODIES].covers[0].garments, 1u << COATS);
    }
    wardrobe_close(&w);
    fixture_expect_no_errors();
}

/* ---- a crowd ---- */

#define PEOPLE 12u
#define CROWD_COATS 5u

typedef struct crowd {
    cast c;
    noh_actor people[PEOPLE], coats[CROWD_COATS];
    noh_appearance looks[PEOPLE];
    uint32_t wearer[CROWD_COATS]; /* NOH_NONE: nobody wears it */
    noh_stage_view view;
} crowd;

static void crowd_open(crowd *w, gpu *g, uint32_t cover_count)
{
    static const float middle[3] = { 0.0f, 0.9f, -0.8f };
    memset(w, 0, sizeof *w);
    w->c.kinds[BODIES].actor_count = PEOPLE;
    w->c.kinds[COATS].actor_count = CROWD_COATS;
    w->c.desc.full_detail = 1;
    open_cast(&w->c, g, cover_count);
    for (uint32_t i = 0; i < PEOPLE; i++) {
        const noh_place place = { .position = { 0.6f * (float)(i % 4u) - 0.9f, 0.0f, -0.8f * (float)(i / 4u) } };
        const noh_play play = { .start_ticks = 4000 * (int64_t)i };
        assert_int_equal(noh_stage_spawn(w->c.stage, BODIES, &place, &w->people[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_play(w->c.stage, w->people[i], 0, "walk", &play, NULL), NOH_OK);
    }
    for (uint32_t i = 0; i < CROWD_COATS; i++)
        assert_int_equal(noh_stage_spawn(w->c.stage, COATS, NULL, &w->coats[i], NULL), NOH_OK);
    noh_view_orbit(&w->view, middle, 0.4f, 0.2f, 3.4f, WIDTH, HEIGHT);
}

/* Parts off and coats on, by chance; a coat that nobody wears is hidden. */
static void crowd_dress(crowd *w, test_random *r)
{
    const noh_appearance away = { .hidden = 1 };
    memset(w->looks, 0, sizeof w->looks);
    for (uint32_t i = 0; i < PEOPLE; i++) {
        w->looks[i].hidden_meshes = test_random_below(r, 3);
        w->looks[i].tint[0] = (uint8_t)(1u + test_random_below(r, 255));
        memset(w->looks[i].tint + 1, 255, 3);
    }
    for (uint32_t i = 0; i < CROWD_COATS; i++) {
        const uint32_t by = test_random_below(r, 3) ? (i * 5u + test_random_below(r, 5)) % PEOPLE : NOH_NONE;
        const noh_appearance seen = { .tint = { 255, (uint8_t)(40u * i + 1u), 99, 255 } };
        const noh_actor nobody = { 0 };
        w->wearer[i] = by;
        assert_int_equal(noh_actor_attach(w->c.stage, w->coats[i], nobody, 0, &said), NOH_OK);
        if (by != NOH_NONE) assert_int_equal(noh_actor_wear(w->c.stage, w->coats[i], w->people[by], &said), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(w->c.stage, w->coats[i], by == NOH_NONE ? &away : &seen, NULL),
                         NOH_OK);
    }
}

/* only: an actor, the others are hidden; NOH_NONE: all. Returns the draws of opaque meshes. */
static uint32_t crowd_draw(crowd *w, uint32_t only)
{
    for (uint32_t i = 0; i < PEOPLE; i++) {
        noh_appearance look = w->looks[i];
        look.hidden = only != NOH_NONE && only != i;
        assert_int_equal(noh_actor_set_appearance(w->c.stage, w->people[i], &look, NULL), NOH_OK);
    }
    assert_int_equal(noh_stage_frame(w->c.stage, 0, &w->view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_draw(w->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    return noh_stage_list_draws(w->c.stage, 0, 0, NULL, 0);
}

/* The draws that these looks need: one of each submesh for each look in which its mesh is on. */
static uint32_t crowd_looks(const crowd *w, int covers, uint32_t submesh_counts[2], uint32_t of_coats)
{
    uint32_t worn = 0, needed = 0;
    for (uint32_t hidden = 0; hidden < 3u; hidden++) {
        uint32_t there = 0;
        for (uint32_t i = 0; i < PEOPLE; i++) {
            uint32_t wears = 0;
            for (uint32_t k = 0; k < CROWD_COATS; k++) wears |= w->wearer[k] == i;
            if (w->looks[i].hidden_meshes == hidden) there |= 1u << (covers ? wears : 0u);
        }
        for (uint32_t m = 0; m < 2; m++)
            needed += hidden >> m & 1u ? 0 : submesh_counts[m] * ((there & 1u) + (there >> 1));
    }
    for (uint32_t k = 0; k < CROWD_COATS; k++) worn |= w->wearer[k] != NOH_NONE;
    return needed + worn * of_coats;
}

static uint32_t submeshes_of(const crowd *w, uint32_t pack, uint32_t mesh)
{
    noh_mesh m;
    assert_int_equal(noh_pack_mesh_at(&w->c.packs[pack], mesh, &m, NULL), NOH_OK);
    return m.header->submesh_count;
}

/* Each of a crowd shows the parts and coats that it shows alone; a look is drawn at once, for all that have it. */
static void a_crowd_wears_by_look(void **state)
{
    static uint32_t together[PIXELS], one_by_one[PIXELS], before[PIXELS];
    test_random r = test_random_from(21);
    gpu *g = fixture_gpu();
    canvas to;
    crowd w;
    (void)state;
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    for (uint32_t covers = 0; covers < 2; covers++) {
        crowd_open(&w, g, covers);
        assert_int_equal(w.c.plan.kinds[BODIES].mesh_count, 2);
        uint32_t counts[2] = { submeshes_of(&w, BODIES, 0), submeshes_of(&w, BODIES, 1) };
        for (uint32_t f = 0; f < 2; f++) {
            uint32_t draws;
            crowd_dress(&w, &r);
            assert_int_equal(noh_stage_step(w.c.stage, CAST_STEP, NULL, NULL, NULL), NOH_OK);
            canvas_begin(&to);
            draws = crowd_draw(&w, NOH_NONE);
            canvas_resolve(&to);
            assert_int_equal(canvas_read(&to, (uint8_t *)together), 0);
            assert_in_range(draws, 1, crowd_looks(&w, (int)covers, counts, submeshes_of(&w, COATS, 0)));
            canvas_begin(&to);
            for (uint32_t i = 0; i < PEOPLE; i++) (void)crowd_draw(&w, i);
            canvas_resolve(&to);
            assert_int_equal(canvas_read(&to, (uint8_t *)one_by_one), 0);
            assert_true(count_different(together, one_by_one) < PIXELS / 2000u);
            if (f) assert_true(count_different(together, before) > PIXELS / 200u);
            memcpy(before, together, sizeof before);
        }
        cast_close_stage(&w.c);
        for (uint32_t i = 0; i < KINDS; i++) noh_file_unmap(&w.c.files[i]);
    }
    canvas_close(&to);
    fixture_expect_no_errors();
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hidden_triangles_are_not_drawn),
        cmocka_unit_test(a_set_is_shared_and_makes_way),
        cmocka_unit_test(a_crowd_wears_by_look),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
