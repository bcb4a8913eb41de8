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

static void wardrobe_open(wardrobe *w, gpu *g, uint32_t cover_count)
{
    static const float middle[3] = { 0.0f, 1.0f, 0.0f };
    static char log[4096];
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, log, sizeof log };
    const uint64_t before = noh_gl_ledger_bytes(&g->ledger);
    memset(w, 0, sizeof *w);
    cast_map(&w->c, BODIES, "demo/puppet_levels.noh");
    cast_map(&w->c, COATS, "demo/coat.noh");
    for (uint32_t i = 0; i < KINDS; i++) {
        w->c.kinds[i].mesh = &w->c.packs[i];
        w->c.kinds[i].actor_count = w->c.kinds[i].near_count = 2;
    }
    w->c.kinds[BODIES].cover_count = cover_count;
    w->c.kinds[COATS].worn_by = 1u << BODIES;
    w->c.desc.kinds = w->c.kinds;
    w->c.desc.kind_count = KINDS;
    w->c.desc.gpu = &noh_stage_on_gl;
    cast_make(&w->c, &device);
    assert_true(noh_gl_ledger_bytes(&g->ledger) - before == w->c.plan.gpu_bytes);
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

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hidden_triangles_are_not_drawn),
        cmocka_unit_test(a_set_is_shared_and_makes_way),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
