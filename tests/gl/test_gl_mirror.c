/* test_gl_mirror.c: an actor attached to a joint that mirrors is drawn alike among many of its kind and alone, opaque or
 * with several blended meshes. */
#include "support/clip_bank_fixture.h"
#include "support/gl_fixture.h"
#include "support/octahedra.h"

#include "gpu/canvas.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#define SIDE 128u

static noh_pack pack_of(octahedra *o, const char *name, const char *json, uint8_t **bytes)
{
    const char *path = octahedra_write(o, 1, name, json);
    size_t count;
    *bytes = clip_pack(&path, 1, NULL, &count);
    return test_open(*bytes, count);
}

/* The second kind's actor is attached to the first kind's joint, next to its octahedron. */
static void draw_pair(gpu *g, const noh_pack packs[2], uint32_t of_kind, uint32_t *rgba)
{
    static char shader_log[4096];
    static const float middle[3] = { 0.0f, 0.0f, 0.0f };
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, shader_log, sizeof shader_log };
    const noh_place beside = { { 2.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 0.0f }, 0.5f };
    const noh_kind_desc kinds[2] = { { .mesh = &packs[0], .actor_count = 1 },
                                     { .mesh = &packs[1], .actor_count = of_kind } };
    const noh_stage_desc desc = { .kinds = kinds, .kind_count = 2, .gpu = &noh_stage_on_gl };
    noh_stage_plan plan;
    noh_stage_view view;
    noh_stage *stage;
    noh_actor holder, held;
    canvas to;
    void *memory;
    assert_int_equal(noh_stage_plan_make(&desc, &g->caps, &plan, NULL), NOH_OK);
    memory = test_aligned(NULL, (size_t)plan.cpu_bytes);
    assert_int_equal(noh_stage_init(memory, (size_t)plan.cpu_bytes, &device, &desc, &plan, &stage, NULL), NOH_OK);
    assert_int_equal(noh_stage_spawn(stage, 0, NULL, &holder, NULL), NOH_OK);
    assert_int_equal(noh_stage_spawn(stage, 1, NULL, &held, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(stage, held, holder, 1, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_place(stage, held, &beside, NULL), NOH_OK);
    noh_view_orbit(&view, middle, 0.3f, 0.2f, 8.0f, SIDE, SIDE);
    assert_int_equal(noh_stage_frame(stage, 0, &view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(canvas_open(&to, g, SIDE, SIDE), 0);
    canvas_begin(&to);
    assert_int_equal(noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    canvas_resolve(&to);
    assert_int_equal(canvas_read(&to, (uint8_t *)rgba), 0);
    canvas_close(&to);
    noh_stage_delete(stage);
    free(memory);
}

static const char opaque_held[] = ",\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"meshes\":[{\"primitives\":["
                                  "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":5}]}]";
static const char blended_held[] =
    ",\"nodes\":[{\"mesh\":0},{\"mesh\":1,\"translation\":[0.0,0.7,0.4]}],\"scenes\":[{\"nodes\":[0,1]}],\"materials\":["
    "{\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.1,0.1,0.5]}}],\"meshes\":["
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":5,\"material\":0}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":5,\"material\":0}]}]";

static void check_held(const char *held_json)
{
    static octahedra o;
    static uint32_t alone[SIDE * SIDE], in_crowd[SIDE * SIDE];
    static const float upright[OCTAHEDRA_MAX] = { 1.0f, 1.0f };
    uint8_t *bytes[2];
    noh_pack packs[2];
    uint32_t drawn = 0;
    gpu *g = fixture_gpu();
    octahedra_make(&o, upright);
    packs[0] = pack_of(&o, "holder",
                       ",\"nodes\":[{\"name\":\"root\",\"scale\":[-1,1,1],\"children\":[1,2]},{\"name\":\"a\"},"
                       "{\"mesh\":0,\"skin\":0}],\"skins\":[{\"joints\":[1]}],\"scenes\":[{\"nodes\":[0]}],"
                       "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"JOINTS_0\":3,"
                       "\"WEIGHTS_0\":4},\"indices\":5}]}]",
                       &bytes[0]);
    packs[1] = pack_of(&o, "held", held_json, &bytes[1]);
    draw_pair(g, packs, 1, alone);
    draw_pair(g, packs, 3, in_crowd);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) drawn += alone[i] != alone[0];
    assert_true(drawn > 500);
    assert_memory_equal(alone, in_crowd, sizeof alone);
    free(bytes[0]);
    free(bytes[1]);
    fixture_expect_no_errors();
}

static void what_hangs_on_a_mirror_is_drawn_in_a_crowd(void **state)
{
    (void)state;
    check_held(opaque_held);
}

static void so_is_what_blends(void **state)
{
    (void)state;
    check_held(blended_held);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_hangs_on_a_mirror_is_drawn_in_a_crowd),
    cmocka_unit_test(so_is_what_blends),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
