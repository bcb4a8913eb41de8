/* Motion vectors: a shader that draws everything where it was in the last frame draws the picture of the last frame, for
 * poses, targets, places and cameras, in crowds and alone, on every path; and what was not there, or was cut, restored
 * or moved by nobody, is where it is. */
#include "support/stage_fixture.h"
#include "support/gl_fixture.h"

#include "gpu/canvas.h"

#define WIDTH 240u
#define HEIGHT 135u
#define PIXELS (WIDTH * HEIGHT)

static const char vertex[] = "out vec2 v_uv;\n"
                             "void main() {\n"
                             "    noh_vertex v = noh_fetch();\n"
                             "    v_uv = v.uv;\n"
                             "#ifdef BEFORE\n"
                             "    gl_Position = noh_clip_before();\n"
                             "#else\n"
                             "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n"
                             "#endif\n"
                             "}\n";
static const char fragment[] = "in vec2 v_uv; out vec4 color;\n"
                               "void main() { color = vec4(fract(v_uv * 3.0), 1.0, 1.0); }\n";

typedef struct film {
    cast c;
    gpu *g;
    canvas to;
    noh_actor actors[CAST_ACTORS];
    noh_stage_shader *shaders[2]; /* now, before */
    void *memory[2];
} film;

static void film_open(film *f, uint32_t path, int alone)
{
    memset(f, 0, sizeof *f);
    f->g = fixture_gpu();
    cast_open(&f->c);
    for (uint32_t k = 0; k < CAST_KINDS && alone; k++) f->c.kinds[k].actor_count = 1;
    f->c.desc.gpu = &noh_stage_on_gl;
    f->c.desc.motion = f->c.desc.full_detail = 1;
    f->c.desc.morph_path = path;
    assert_int_equal(canvas_open(&f->to, f->g, WIDTH, HEIGHT), 0);
}

static void film_make(film *f)
{
    const noh_gl_device device = { &f->g->gl, &f->g->caps, &f->g->ledger, NULL, 0 };
    cast_make(&f->c, &device);
    if (f->c.desc.kind_count == CAST_KINDS) cast_enter(&f->c, f->actors);
    for (int i = 0; i < 2; i++) {
        const noh_gl_shader_desc desc = {
            .name = "motion", .vertex = vertex, .fragment = fragment, .defines = i ? "#define BEFORE\n" : NULL
        };
        static char log[4096];
        noh_error e;
        f->memory[i] = test_aligned(NULL, noh_stage_shader_size(f->c.stage));
        if (noh_stage_shader_create(f->c.stage, f->memory[i], noh_stage_shader_size(f->c.stage), &desc, log, sizeof log,
                                    &f->shaders[i], &e)) {
            fail_msg("%s\n%s", e.what, log);
        }
    }
}

static void film_close(film *f)
{
    for (int i = 0; i < 2; i++) {
        if (f->shaders[i]) noh_stage_shader_delete(f->shaders[i]);
        free(f->memory[i]);
    }
    canvas_close(&f->to);
    cast_close(&f->c);
    fixture_expect_no_errors();
}

static void picture(film *f, int before, uint32_t *rgba)
{
    canvas_begin(&f->to);
    assert_int_equal(noh_stage_draw(f->c.stage, NOH_PASS_COLOR, 0, f->shaders[before], NULL), NOH_OK);
    canvas_resolve(&f->to);
    assert_int_equal(canvas_read(&f->to, (uint8_t *)rgba), 0);
}

static uint32_t difference(const uint32_t *a, const uint32_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) count += a[i] != b[i];
    return count;
}

static void step(film *f, uint32_t ticks, const noh_stage_view *view)
{
    noh_error e;
    if (noh_stage_frame(f->c.stage, ticks, view, NULL, NULL, &e)) fail_msg("%s", e.what);
}

/* Frames that differ; each is the last frame of the next. */
static void check_frames(film *f)
{
    static uint32_t shown[2][PIXELS], was[PIXELS];
    for (uint32_t n = 0; n < 6; n++) {
        const noh_stage_view view = cast_view(3u * n, 5.0f + 0.2f * (float)n);
        step(f, 3u * CAST_STEP, &view);
        picture(f, 0, shown[n % 2u]);
        picture(f, 1, was);
        assert_int_equal(difference(was, shown[n ? (n + 1u) % 2u : 0]), 0);
        if (n) assert_true(difference(shown[0], shown[1]) > 60u);
    }
}

static void the_last_frame_is_drawn_again(void **state)
{
    static const uint32_t paths[] = { NOH_MORPH_AUTO, NOH_MORPH_CPU, NOH_MORPH_PER_LAYER, NOH_MORPH_GATHER,
                                      NOH_MORPH_DIRECT };
    (void)state;
    for (uint32_t i = 0; i < 2u * TEST_COUNT(paths); i++) {
        film f;
        film_open(&f, paths[i / 2u], i % 2u == 1u);
        if (noh_stage_plan_make(&f.c.desc, &f.g->caps, &f.c.plan, NULL) == NOH_OK) {
            film_make(&f);
            check_frames(&f);
        }
        film_close(&f);
    }
}

/* Masks that speak, near a camera that stands still: targets alone move, and in some frames none does. */
static void faces_move_by_targets_alone(void **state)
{
    static const uint32_t paths[] = { NOH_MORPH_CPU, NOH_MORPH_PER_LAYER, NOH_MORPH_GATHER, NOH_MORPH_DIRECT };
    static uint32_t shown[2][PIXELS], was[PIXELS];
    static const float middle[3] = { 0.0f, 0.0f, 0.0f };
    uint32_t films = 0;
    (void)state;
    for (uint32_t i = 0; i < 2u * TEST_COUNT(paths); i++) {
        noh_stage_view view;
        uint32_t moved = 0;
        film f;
        film_open(&f, paths[i / 2u], 0);
        f.c.kinds[0] = f.c.kinds[MASKS];
        f.c.kinds[0].actor_count = 1u + i % 2u;
        f.c.desc.kind_count = 1;
        if (noh_stage_plan_make(&f.c.desc, &f.g->caps, &f.c.plan, NULL) == NOH_OK) {
            film_make(&f);
            for (uint32_t a = 0; a < f.c.kinds[0].actor_count; a++) {
                const noh_place place = { { 0.12f * (float)a, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
                const noh_play play = { .start_ticks = 9000 * (int64_t)a };
                assert_int_equal(noh_stage_spawn(f.c.stage, 0, &place, &f.actors[a], NULL), NOH_OK);
                assert_int_equal(noh_actor_play(f.c.stage, f.actors[a], 1, "speak", &play, NULL), NOH_OK);
            }
            noh_view_orbit(&view, middle, 0.2f, 0.0f, 0.5f, WIDTH, HEIGHT);
            for (uint32_t n = 0; n < 10; n++) {
                step(&f, n % 3u == 2u ? 0 : 4u * CAST_STEP, &view);
                picture(&f, 0, shown[n % 2u]);
                picture(&f, 1, was);
                assert_int_equal(difference(was, shown[n ? (n + 1u) % 2u : 0]), 0);
                if (n) moved += difference(shown[0], shown[1]);
            }
            assert_true(moved > 200u);
            films++;
        }
        film_close(&f);
    }
    assert_true(films >= 4u);
}

/* Actors come into view and leave it, and change their places in the draws; meshes are taken off and put on. */
static void whoever_is_drawn_where(void **state)
{
    static uint32_t now[PIXELS], was[PIXELS];
    const noh_stage_view view = cast_view(0, 6.0f);
    film f;
    (void)state;
    film_open(&f, NOH_MORPH_AUTO, 0);
    film_make(&f);
    for (uint32_t n = 0; n < 12; n++) {
        for (uint32_t a = 0; a < CAST_ACTORS; a++) { /* some disappear for a frame; who appears has no last frame */
            const noh_appearance look = { .hidden = (a + n) % 3u == 0 };
            assert_int_equal(noh_actor_set_appearance(f.c.stage, f.actors[a], &look, NULL), NOH_OK);
        }
        step(&f, n % 2u ? 0 : CAST_STEP, &view); /* in odd frames nothing moves */
        picture(&f, 0, now);
        picture(&f, 1, was);
        if (n % 2u) assert_int_equal(difference(now, was), 0);
    }
    film_close(&f);
}

/* A figure that is moved: as far as it went, or not at all if it was cut; nor after a camera was cut, in the first frame
 * or after a state was restored. */
static void cuts_have_no_velocity(void **state)
{
    static uint32_t now[PIXELS], was[PIXELS], last[PIXELS];
    const noh_place far_away = { { 1.5f, 0.0f, 0.5f }, { 0, 0, 0, 0 }, 0.0f };
    noh_stage_view view = cast_view(0, 6.0f);
    film f;
    size_t bytes;
    void *kept;
    (void)state;
    film_open(&f, NOH_MORPH_AUTO, 0);
    film_make(&f);
    step(&f, CAST_STEP, &view);
    step(&f, CAST_STEP, &view);
    (void)noh_stage_state(f.c.stage, &bytes);
    kept = test_aligned(noh_stage_state(f.c.stage, &bytes), bytes);
    picture(&f, 0, last);
    for (int cut = 0; cut < 2; cut++) {
        assert_int_equal(noh_actor_set_place(f.c.stage, f.actors[0], &far_away, NULL), NOH_OK);
        if (cut) assert_int_equal(noh_actor_cut(f.c.stage, f.actors[0], NULL), NOH_OK);
        step(&f, 0, &view);
        picture(&f, 0, now);
        picture(&f, 1, was);
        assert_true(difference(now, last) > 100u);
        assert_int_equal(difference(was, cut ? now : last), 0);
        assert_int_equal(noh_stage_set_state(f.c.stage, kept, bytes, NULL), NOH_OK);
        step(&f, 0, &view); /* the figure leaps back, by a restored state */
        picture(&f, 0, now);
        picture(&f, 1, was);
        assert_int_equal(difference(now, last), 0);
        assert_int_equal(difference(was, now), 0);
    }
    view = cast_view(20, 6.0f);
    view.cut = 1;
    step(&f, 0, &view);
    picture(&f, 0, now);
    picture(&f, 1, was);
    assert_true(difference(now, last) > 100u);
    assert_int_equal(difference(was, now), 0);
    free(kept);
    film_close(&f);
}

/* The world's origin moves between two frames: so does where everything was. A lost context keeps the weights. */
static void the_origin_may_move(void **state)
{
    static const float by[3] = { 64.0f, 0.0f, -32.0f };
    static uint32_t now[PIXELS], was[PIXELS], last[PIXELS];
    noh_stage_view view = cast_view(0, 6.0f);
    film f;
    (void)state;
    film_open(&f, NOH_MORPH_AUTO, 0);
    film_make(&f);
    step(&f, CAST_STEP, &view);
    step(&f, CAST_STEP, &view);
    picture(&f, 0, last);
    assert_int_equal(noh_stage_shift_origin(f.c.stage, by, NULL), NOH_OK);
    for (int r = 0; r < 4; r++) { /* the camera, too */
        for (int i = 0; i < 3; i++) view.view_projection[12 + r] += view.view_projection[4 * i + r] * by[i];
    }
    for (int i = 0; i < 3; i++) view.eye[i] -= by[i];
    step(&f, 8u * CAST_STEP, &view);
    picture(&f, 0, now);
    picture(&f, 1, was);
    assert_true(difference(now, last) > 500u);
    assert_true(difference(was, last) < 60u); /* of what rounds otherwise */
    film_close(&f);
}

/* Without motion a shader gets the present positions. */
static void a_stage_without_it_has_no_velocity(void **state)
{
    static uint32_t now[PIXELS], was[PIXELS];
    (void)state;
    for (int alone = 0; alone < 2; alone++) {
        film f;
        film_open(&f, NOH_MORPH_AUTO, alone);
        f.c.desc.motion = 0;
        f.c.desc.morph_sums = 1;
        film_make(&f);
        for (uint32_t n = 0; n < 3; n++) {
            const noh_stage_view view = cast_view(3u * n, 5.0f);
            step(&f, 3u * CAST_STEP, &view);
            picture(&f, 0, now);
            picture(&f, 1, was);
            assert_int_equal(difference(was, now), 0);
        }
        film_close(&f);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_last_frame_is_drawn_again), cmocka_unit_test(faces_move_by_targets_alone),
    cmocka_unit_test(whoever_is_drawn_where),        cmocka_unit_test(cuts_have_no_velocity),
    cmocka_unit_test(the_origin_may_move),           cmocka_unit_test(a_stage_without_it_has_no_velocity),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
