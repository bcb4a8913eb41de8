/* What blends of one figure: meshes from far to near, of each actor, alone and in a crowd, with levels that fade or not;
 * before that by the priority of their materials; and actors from far to near, where a stage sorts them. */
#include "support/stage_fixture.h"
#include "support/gl_fixture.h"

#include "convert/model/model_build.h"
#include "gpu/canvas.h"

#include <math.h>

#define WIDTH 128u
#define HEIGHT 64u
#define PIXELS (WIDTH * HEIGHT)
#define PANES 3u

/* In the order of the pack: neither from far to near nor from near to far, from any side. */
static const float depths[PANES] = { 0.0f, 0.3f, -0.3f };

/* Panes behind each other, red, green and blue, each half transparent. */
static uint8_t *panes_pack(const int priorities[PANES], size_t *count)
{
    const test_model_desc desc = { PANES, 2, 0, 0, 1 };
    model *m = test_model(&desc);
    uint8_t *bytes;
    m->materials = test_zeros(PANES * sizeof *m->materials);
    m->material_count = PANES;
    for (uint32_t i = 0; i < PANES; i++) {
        model_material *material = &m->materials[i];
        model_mesh *mesh = &m->meshes[i];
        const uint32_t side = 2u + 6u * i;
        *material = model_material_default();
        material->name = model_string("pane");
        for (uint32_t c = 0; c < 4; c++) material->base_color[c] = c == 3 ? 0.5f : c == i ? 1.0f : 0.0f;
        material->unlit = material->double_sided = 1;
        material->alpha = MODEL_ALPHA_BLEND;
        material->priority = (int8_t)priorities[i];
        mesh->submeshes[0].material = i;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            mesh->position[3 * v] = (float)(v % side) / (float)(side - 1u) * 0.8f - 0.4f;
            mesh->position[3 * v + 1] = (float)(v / side) / (float)(side - 1u) * 0.8f - 0.4f;
            mesh->position[3 * v + 2] = depths[i];
        }
    }
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

/* The panes of an actor from the one that was drawn first to the last, by what is left of each in a pixel. */
static void expect_order(const uint32_t *rgba, uint32_t column, const uint32_t order[PANES])
{
    const uint8_t *pixel = (const uint8_t *)&rgba[HEIGHT / 2u * WIDTH + column];
    for (uint32_t i = 0; i + 1u < PANES; i++) {
        if (pixel[order[i]] + 20 > pixel[order[i + 1u]]) {
            fail_msg("%u, %u, %u: pane %u is over pane %u", pixel[0], pixel[1], pixel[2], order[i], order[i + 1u]);
        }
    }
}

/* Two actors who stand back to back, seen from in front: what each shows of its panes. */
static void check_panes(const int priorities[PANES], uint32_t kinds, const uint32_t orders[2][PANES])
{
    static uint32_t rgba[PIXELS];
    static const float middle[3] = { 0.5f, 0.0f, 0.0f };
    gpu *g = fixture_gpu();
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
    size_t count;
    uint8_t *bytes = panes_pack(priorities, &count);
    noh_pack pack = test_open(bytes, count);
    noh_kind_desc of[2];
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage_view view;
    noh_stage *stage;
    noh_error error;
    void *memory;
    canvas to;
    memset(of, 0, sizeof of);
    memset(&desc, 0, sizeof desc);
    for (uint32_t i = 0; i < kinds; i++) {
        of[i].mesh = &pack;
        of[i].actor_count = 2u / kinds;
    }
    desc.kinds = of;
    desc.kind_count = kinds;
    desc.gpu = &noh_stage_on_gl;
    if (noh_stage_plan_make(&desc, &g->caps, &plan, &error)) fail_msg("%s", error.what);
    memory = test_aligned(NULL, (size_t)plan.cpu_bytes);
    if (noh_stage_init(memory, (size_t)plan.cpu_bytes, &device, &desc, &plan, &stage, &error)) {
        fail_msg("%s", error.what);
    }
    for (uint32_t i = 0; i < 2; i++) {
        noh_place place = { .position = { (float)i, 0.0f, 0.0f } };
        noh_actor actor;
        place.rotation[1] = i ? 1.0f : 0.0f; /* half a turn */
        place.rotation[3] = i ? 0.0f : 1.0f;
        assert_int_equal(noh_stage_spawn(stage, kinds == 2 ? i : 0, &place, &actor, NULL), NOH_OK);
    }
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    noh_view_orbit(&view, middle, 0.0f, 0.0f, 3.0f, WIDTH, HEIGHT);
    assert_int_equal(noh_stage_frame(stage, 0, &view, NULL, NULL, NULL), NOH_OK);
    canvas_begin(&to);
    assert_int_equal(noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    canvas_resolve(&to);
    assert_int_equal(canvas_read(&to, (uint8_t *)rgba), 0);
    for (uint32_t i = 0; i < 2; i++) {
        const float *m = view.view_projection, x = m[0] * (float)i + m[12], w = m[3] * (float)i + m[15];
        expect_order(rgba, (uint32_t)((0.5f + 0.5f * x / w) * (float)WIDTH), orders[i]);
    }
    canvas_close(&to);
    noh_stage_delete(stage);
    free(memory);
    free(bytes);
    fixture_expect_no_errors();
}

static void meshes_are_drawn_from_far_to_near(void **state)
{
    static const int alike[PANES] = { 0, 0, 0 };
    static const uint32_t orders[2][PANES] = { { 2, 0, 1 }, { 1, 0, 2 } };
    (void)state;
    check_panes(alike, 1, orders); /* in one crowd */
    check_panes(alike, 2, orders); /* alone */
}

static void priorities_come_first(void **state)
{
    static const int one_last[PANES] = { 3, -2, -2 }, all[PANES] = { -128, 127, 5 };
    static const uint32_t middle_last[2][PANES] = { { 2, 1, 0 }, { 1, 2, 0 } };
    static const uint32_t as_given[2][PANES] = { { 0, 2, 1 }, { 0, 2, 1 } };
    (void)state;
    check_panes(one_last, 1, middle_last);
    check_panes(one_last, 2, middle_last);
    check_panes(all, 1, as_given);
    check_panes(all, 2, as_given);
}

/* Three actors of two kinds behind each other, seen from in front and from behind: each is drawn after those that it
 * hides, and its panes from far to near. */
static void actors_are_sorted_where_asked(void **state)
{
    static const float places[PANES] = { 0.0f, 4.0f, -4.0f }, middle[3] = { 0.0f, 0.0f, 0.0f };
    static const int alike[PANES] = { 0, 0, 0 };
    static const uint32_t panes[2][PANES] = { { 2, 0, 1 }, { 1, 0, 2 } };
    size_t count;
    uint8_t *bytes = panes_pack(alike, &count);
    const noh_pack pack = test_open(bytes, count);
    const noh_kind_desc kinds[2] = { { .mesh = &pack, .actor_count = 2 }, { .mesh = &pack, .actor_count = 1 } };
    (void)state;
    for (int sorts = 0; sorts < 2; sorts++) {
        const noh_stage_desc desc = { .kinds = kinds, .kind_count = 2, .sort_blended = sorts };
        noh_stage_plan plan;
        noh_stage *stage;
        void *memory;
        assert_int_equal(noh_stage_plan_make(&desc, NULL, &plan, NULL), NOH_OK);
        memory = test_aligned(NULL, (size_t)plan.cpu_bytes);
        assert_int_equal(noh_stage_init(memory, (size_t)plan.cpu_bytes, NULL, &desc, &plan, &stage, NULL), NOH_OK);
        for (uint32_t i = 0; i < PANES; i++) {
            const noh_place place = { .position = { 0.0f, 0.0f, places[i] } };
            noh_actor actor;
            assert_int_equal(noh_stage_spawn(stage, i == 1, &place, &actor, NULL), NOH_OK);
        }
        for (uint32_t side = 0; side < 2; side++) {
            static const uint32_t by_kind[2][PANES] = { { 0, 1, 2 }, { 0, 1, 2 } };     /* actors 0 and 1 are a kind */
            static const uint32_t by_distance[2][PANES] = { { 1, 0, 2 }, { 2, 0, 1 } }; /* z: -4, 0, 4 */
            noh_draw draws[PANES * PANES];
            noh_stage_view view;
            noh_view_orbit(&view, middle, side ? 3.14159f : 0.0f, 0.0f, 12.0f, WIDTH, HEIGHT);
            assert_int_equal(noh_stage_frame(stage, 0, &view, NULL, NULL, NULL), NOH_OK);
            assert_int_equal(noh_stage_list_draws(stage, 0, 1, draws, PANES * PANES), PANES * PANES);
            for (uint32_t i = 0; i < PANES * PANES; i++) {
                const uint32_t actor = (sorts ? by_distance : by_kind)[side][i / PANES];
                assert_int_equal(draws[i].actor_count, 1);
                assert_int_equal(draws[i].first_actor + draws[i].actors[0], actor);
                assert_int_equal(draws[i].index, panes[side][i % PANES]);
            }
        }
        noh_stage_delete(stage);
        free(memory);
    }
    free(bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(actors_are_sorted_where_asked),
    cmocka_unit_test(meshes_are_drawn_from_far_to_near),
    cmocka_unit_test(priorities_come_first),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
