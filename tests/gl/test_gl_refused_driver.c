/* A real driver that refuses one call, of a load or of a frame (support/refusing_gl.h): a load fails, leaves nothing
 * and succeeds when it is tried again; frames go on, and a few frames later their pictures are what they would have
 * been. A few calls of each function, all of them with NOH_LONG set. */
#define _POSIX_C_SOURCE 200809L /* unsetenv */

#include "support/gl_fixture.h"
#include "support/refusing_gl.h"
#include "support/stage_fixture.h"

#include "gpu/canvas.h"

#define WIDTH 160u
#define HEIGHT 120u
#define PIXELS (WIDTH * HEIGHT)

static gpu g;
static char shader_log[4096];

static noh_gl_device device_of(void)
{
    const noh_gl_device d = { &g.gl, &g.caps, &g.ledger, shader_log, sizeof shader_log };
    return d;
}

/* What a driver says after calls that it never saw is not ours. */
static void drain(void)
{
    for (int i = 0; i < 64 && g.gl.GetError(); i++) {}
}

static void open_driver(void)
{
    const char *wish = getenv("NOH_TEST_DRIVER");
    unsetenv("NOH_GL_DEBUG"); /* it ends the program at the first error */
    if (gpu_open(&g, wish)) {
        print_message("SKIP: no GL here\n");
        skip();
    }
    refusing_gl_install(&g.gl);
}

static void close_driver(void)
{
    refusing_gl_remove(&g.gl);
    gpu_close(&g);
}

/* One mask that speaks and one tube. */
static void small_cast(cast *c, noh_morph_path path)
{
    cast_open(c);
    c->kinds[0] = c->kinds[MASKS];
    c->kinds[1] = c->kinds[TUBES];
    c->kinds[0].actor_count = c->kinds[1].actor_count = 1;
    c->desc.kind_count = 2;
    c->desc.gpu = &noh_stage_on_gl;
    c->desc.morph_path = (uint32_t)path;
}

/* The calls of a function that are tried: the first, the second, one in the middle, the last. */
static uint32_t next_call(uint32_t k, uint32_t count)
{
    if (getenv("NOH_LONG") || k == 0) return k + 1u;
    return k < count / 2u ? count / 2u : k + 1u < count ? count - 1u : count;
}

/* ---- loads ---- */

static noh_result load(cast *c, noh_error *error)
{
    const noh_gl_device d = device_of();
    return noh_stage_init(c->memory, (size_t)c->plan.cpu_bytes, &d, &c->desc, &c->plan, &c->stage, error);
}

static uint32_t refuse_loads(cast *c, uint32_t function, uint32_t count)
{
    const noh_gl_ledger before = g.ledger;
    uint32_t refused = 0;
    for (uint32_t k = 0; k < count; k = next_call(k, count)) {
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result;
        refusing_gl_at(function, k);
        c->stage = NULL;
        result = load(c, &error);
        if (!refusing_gl_happened()) break;
        if (result == NOH_OK) fail_msg("%s refused at %u, and the stage was made", refusing_gl_names[function], k);
        if (c->stage || !error.what) fail_msg("%s refused at %u: no message", refusing_gl_names[function], k);
        assert_memory_equal(&before, &g.ledger, sizeof before);
        refusing_gl_at(REFUSING_GL_COUNT, 0);
        drain();
        refused++;
    }
    return refused;
}

static void no_load_hides_a_refusal(void **state)
{
    /* What a frame binds, draws or sends is tried below. */
    static const uint32_t in_frames[] = { REFUSING_BindFramebuffer, REFUSING_UseProgram, REFUSING_DrawElements,
                                          REFUSING_DrawElementsInstanced, REFUSING_DrawArraysInstanced };
    static const noh_morph_path paths[] = { NOH_MORPH_MRT, NOH_MORPH_GATHER };
    uint32_t refused = 0;
    (void)state;
    open_driver();
    for (size_t p = 0; p < TEST_COUNT(paths); p++) {
        uint32_t counts[REFUSING_GL_COUNT];
        noh_error error;
        cast c;
        small_cast(&c, paths[p]);
        if (noh_stage_plan_make(&c.desc, &g.caps, &c.plan, &error) != NOH_OK) {
            cast_close(&c);
            continue;
        }
        c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
        refusing_gl_at(REFUSING_GL_COUNT, 0);
        assert_int_equal(load(&c, &error), NOH_OK);
        for (uint32_t f = 0; f < REFUSING_GL_COUNT; f++) counts[f] = refusing_gl_calls(f);
        noh_stage_delete(c.stage);
        c.stage = NULL;
        for (uint32_t f = 0; f < REFUSING_GL_COUNT; f++) {
            int framed = 0;
            for (size_t i = 0; i < TEST_COUNT(in_frames); i++) framed |= in_frames[i] == f;
            if (!framed) refused += refuse_loads(&c, f, counts[f]);
        }
        refusing_gl_at(REFUSING_GL_COUNT, 0);
        assert_int_equal(load(&c, &error), NOH_OK); /* and after all of that it is made */
        cast_close(&c);
    }
    print_message("# %s: %u refused calls in loads\n", g.caps.renderer, refused);
    assert_true(refused > 30);
    close_driver();
}

/* ---- frames ---- */

static void play(cast *c, canvas *to, uint32_t frames, uint32_t function, uint32_t at_frame, uint32_t k, uint32_t *rgba)
{
    static const noh_place here = { { 0.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
    noh_actor actors[2];
    for (uint32_t i = 0; i < 2; i++) {
        assert_int_equal(noh_stage_spawn(c->stage, i, &here, &actors[i], NULL), NOH_OK);
    }
    for (uint32_t f = 0; f < frames; f++) {
        const noh_stage_view view = cast_view(f, 3.0f);
        const float smile = 0.1f + 0.05f * (float)f;
        assert_int_equal(noh_actor_hold_float(c->stage, actors[0], 0, smile, 1.0f, NULL), NOH_OK);
        refusing_gl_at(f == at_frame ? function : REFUSING_GL_COUNT, k);
        (void)noh_stage_frame(c->stage, CAST_STEP, &view, NULL, NULL, NULL); /* it may say so */
        canvas_begin(to);
        (void)noh_stage_draw(c->stage, NOH_PASS_COLOR, 0, NULL, NULL);
        canvas_resolve(to);
        if (f == at_frame && rgba == NULL) return;
    }
    refusing_gl_at(REFUSING_GL_COUNT, 0);
    if (function != REFUSING_GL_COUNT) drain();
    assert_int_equal(canvas_read(to, (uint8_t *)rgba), 0);
}

/* Refuse calls of one path's frames, each in a stage of its own. Returns how many. */
static uint32_t refuse_frames(cast *c, canvas *to, const char *path)
{
    static uint32_t right[PIXELS], now[PIXELS];
    const noh_gl_device d = device_of();
    uint32_t counts[REFUSING_GL_COUNT], refused = 0, drawn = 0;
    cast_make(c, &d);
    play(c, to, 6, REFUSING_GL_COUNT, 2, 0, NULL); /* how often a frame calls what */
    for (uint32_t i = 0; i < REFUSING_GL_COUNT; i++) counts[i] = refusing_gl_calls(i);
    cast_close_stage(c);
    cast_make(c, &d);
    play(c, to, 6, REFUSING_GL_COUNT, 99, 0, right);
    cast_close_stage(c);
    for (uint32_t i = 0; i < PIXELS; i++) drawn += right[i] != right[0];
    assert_true(drawn > 500);
    for (uint32_t f = 0; f < REFUSING_GL_COUNT; f++) {
        for (uint32_t k = 0; k < counts[f]; k = next_call(k, counts[f])) {
            uint32_t wrong = 0;
            noh_gl_ledger before;
            cast_make(c, &d);
            before = g.ledger;
            play(c, to, 6, f, 2, k, now);
            assert_memory_equal(&before, &g.ledger, sizeof before);
            for (uint32_t i = 0; i < PIXELS; i++) wrong += now[i] != right[i];
            if (wrong) {
                fail_msg("%s: %s refused at %u of a frame: %u pixels differ three frames later", path,
                         refusing_gl_names[f], k, wrong);
            }
            cast_close_stage(c);
            refused++;
        }
    }
    return refused;
}

static void frames_go_on_after_a_refusal(void **state)
{
    uint32_t refused = 0, paths = 0;
    canvas to;
    (void)state;
    open_driver();
    assert_int_equal(canvas_open(&to, &g, WIDTH, HEIGHT), 0);
    for (uint32_t way = 0; way < FIXTURE_WAYS; way++) {
        noh_error error;
        cast c;
        if (test_is_sanitized() && fixture_ways[way].accumulate == NOH_ACCUMULATE_F16)
            continue; /* the calls of floats */
        small_cast(&c, fixture_ways[way].path);
        c.desc.halves = fixture_ways[way].accumulate == NOH_ACCUMULATE_F16;
        if (noh_stage_plan_make(&c.desc, &g.caps, &c.plan, &error) == NOH_OK) {
            refused += refuse_frames(&c, &to, fixture_way_name(fixture_ways[way]));
            paths++;
        }
        cast_close(&c);
    }
    print_message("# %u refused calls in frames, on %u paths\n", refused, paths);
    assert_true(refused > 20 && paths >= 2);
    canvas_close(&to);
    close_driver();
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_load_hides_a_refusal),
        cmocka_unit_test(frames_go_on_after_a_refusal),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
