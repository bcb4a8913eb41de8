/* Mip levels of textures by need: until finer levels are there a picture shows the coarser ones, and nothing else; with
 * them it equals the picture of textures that are whole. The reserve and the bytes of a frame keep their bounds. */
#include "support/counted_gl.h"
#include "support/gl_fixture.h"
#include "support/stage_fixture.h"

#include "convert/model/model_build.h"
#include "gl/stage/stage_gl_internal.h"
#include "gpu/canvas.h"
#include "noh/format.h"
#include "null.h"

#define SIDE 96u /* of the picture */
#define PIXELS (SIDE * SIDE)
#define TEXELS 256u /* of each texture's side */
#define BOUND 30000u
#define KINDS 2u
#define KINDS_MAX 3u

static char shader_log[4096];
static noh_error said;

/* ---- kinds of quads, each with a texture of its own ---- */

/* What a pack has besides: TWO: another texture, of a material that no mesh has. Of SMALL the texture has a half and a
 * quarter of the texels on its sides; READ reads it as a toon's shade, LOOSE has no material with it. */
typedef enum form { PLAIN, TWO, SMALL, READ, LOOSE } form;

static void fill_texture(model_texture *to, const char *name, form of, test_random *r)
{
    to->name = model_string(name);
    to->width = of == SMALL ? TEXELS / 2u : TEXELS;
    to->height = of == SMALL ? TEXELS / 4u : TEXELS;
    to->wrap_s = to->wrap_t = 33071;
    to->rgba = test_zeros((size_t)4 * to->width * to->height);
    for (uint32_t i = 0; i < to->width * to->height; i++) { /* bright: black would be what was never written */
        for (uint32_t c = 0; c < 3; c++) to->rgba[4u * i + c] = (uint8_t)(150u + test_random_below(r, 100));
        to->rgba[4u * i + 3u] = 255;
    }
}

static uint8_t *quad_pack(uint32_t which, form of, size_t *count)
{
    const test_model_desc desc = { 1, 2, 0, TEST_UVS, 1 };
    test_random r = test_random_from(7u + which);
    model *m = test_model(&desc);
    uint8_t *bytes;
    m->material_count = m->texture_count = of == TWO ? 2u : 1u;
    m->materials = test_zeros(m->material_count * sizeof *m->materials);
    m->textures = test_zeros(m->texture_count * sizeof *m->textures);
    for (uint32_t i = 0; i < m->material_count; i++) {
        model_material *material = &m->materials[i];
        *material = model_material_default();
        material->name = model_string(i ? "cloth-x" : "cloth");
        if (of != READ && of != LOOSE) material->base_color_texture = i;
        if (of == READ) material->surface = NOH_SURFACE_TOON, material->more_textures[NOH_TOON_SHADE] = i;
        for (int c = 0; c < 4; c++) material->base_color[c] = 1.0f;
        material->unlit = material->double_sided = 1;
        fill_texture(&m->textures[i], material->name, of, &r);
    }
    m->meshes[0].submeshes[0].material = 0;
    for (uint32_t v = 0; v < 4; v++) {
        m->meshes[0].position[3 * v] = v % 2 ? 0.4f : -0.4f;
        m->meshes[0].position[3 * v + 1] = v / 2 ? 0.4f : -0.4f;
        m->meshes[0].position[3 * v + 2] = 0.0f;
        m->meshes[0].uv[2 * v] = v % 2 ? 1.0f : 0.0f;
        m->meshes[0].uv[2 * v + 1] = v / 2 ? 1.0f : 0.0f;
    }
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

typedef struct show {
    uint8_t *bytes[KINDS_MAX];
    noh_pack packs[KINDS_MAX];
    noh_kind_desc kinds[KINDS_MAX];
    noh_texture_set sets; /* the second kind may wear the first one's texture */
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory;
    noh_actor actors[KINDS_MAX];
    noh_gl_ledger ledger;
    noh_gl_device device;
} show;

static void open_forms(show *w, gpu *g, const form *forms, uint32_t kinds)
{
    memset(w, 0, sizeof *w);
    for (uint32_t i = 0; i < kinds; i++) {
        size_t count;
        w->bytes[i] = quad_pack(i, forms[i], &count);
        w->packs[i] = test_open(w->bytes[i], count);
        w->kinds[i].mesh = &w->packs[i];
        w->kinds[i].actor_count = 1;
    }
    w->sets = (noh_texture_set){ .name = "other", .pack = &w->packs[0] };
    w->kinds[1].texture_sets = &w->sets;
    w->kinds[1].texture_set_count = 1;
    w->desc.kinds = w->kinds;
    w->desc.kind_count = kinds;
    w->desc.gpu = &noh_stage_on_gl;
    w->desc.load_bytes = BOUND;
    w->device = (noh_gl_device){ &g->gl, &g->caps, &w->ledger, shader_log, sizeof shader_log };
}

static void open_show(show *w, gpu *g, uint64_t reserve)
{
    static const form forms[KINDS] = { PLAIN, PLAIN };
    open_forms(w, g, forms, KINDS);
    w->desc.texture_reserve = reserve;
}

static void make(show *w)
{
    if (noh_stage_plan_make(&w->desc, w->device.caps, &w->plan, &said) != NOH_OK) fail_msg("plan: %s", said.what);
    w->memory = test_aligned(NULL, (size_t)w->plan.cpu_bytes);
    if (noh_stage_init(w->memory, (size_t)w->plan.cpu_bytes, &w->device, &w->desc, &w->plan, &w->stage, &said) !=
        NOH_OK)
        fail_msg("stage: %s", said.what);
    for (uint32_t i = 0; i < w->desc.kind_count; i++) {
        const noh_place place = { .position = { 100.0f * (float)i, 0.0f, 0.0f } }; /* a picture shows one of them */
        assert_int_equal(noh_stage_spawn(w->stage, i, &place, &w->actors[i], &said), NOH_OK);
    }
}

static void close_show(show *w)
{
    static const noh_gl_ledger nothing;
    if (w->stage) noh_stage_delete(w->stage);
    assert_memory_equal(&nothing, &w->ledger, sizeof nothing);
    free(w->memory);
    for (uint32_t i = 0; i < KINDS_MAX; i++) free(w->bytes[i]);
}

/* The bytes of a texture from a level on. */
static uint64_t bytes_from(const show *w, uint32_t kind, uint32_t level)
{
    noh_texture texture;
    assert_int_equal(noh_pack_texture_at(&w->packs[kind], 0, &texture, NULL), NOH_OK);
    return noh_gl_picture_bytes_from(&texture, w->device.caps->etc2, level);
}

/* One texture is whole, the other has its small levels, and there is room to change. */
static uint64_t least_reserve(const show *w)
{
    return bytes_from(w, 0, 0) + 3u * bytes_from(w, 0, 2);
}

static uint32_t first_of(const show *w, uint32_t kind)
{
    return ((const noh_stage_gl *)w->stage->gpu)->streamed[kind].first;
}

static void frame(show *w, uint32_t kind, float distance)
{
    const float middle[3] = { 100.0f * (float)kind, 0.0f, 0.0f };
    noh_stage_view view;
    noh_view_orbit(&view, middle, 0.0f, 0.0f, distance, SIDE, SIDE);
    if (noh_stage_frame(w->stage, CAST_STEP, &view, NULL, NULL, &said) != NOH_OK) fail_msg("%s", said.what);
    assert_true(noh_stage_stats_of(w->stage)->load_bytes <= BOUND);
    assert_true(noh_gl_ledger_bytes(&w->ledger) <= w->plan.gpu_bytes);
}

static const noh_stage_stats *stats_of(const show *w)
{
    return noh_stage_stats_of(w->stage);
}

/* ---- pictures ---- */

static void draw(const show *w, canvas *to, uint32_t *rgba)
{
    canvas_begin(to);
    assert_int_equal(noh_stage_draw(w->stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    canvas_resolve(to);
    assert_int_equal(canvas_read(to, (uint8_t *)rgba), 0);
}

/* How many pixels differ. Each pixel that the whole texture's picture covers is bright in the other, too. */
static uint32_t apart(const show *whole, const show *part, canvas *to)
{
    static uint32_t one[PIXELS], other[PIXELS];
    uint32_t count = 0, drawn = 0;
    draw(whole, to, one);
    draw(part, to, other);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint8_t *a = (const uint8_t *)&one[i], *b = (const uint8_t *)&other[i];
        count += one[i] != other[i];
        if (a[0] < 140 || a[1] < 140 || a[2] < 140) continue;
        drawn++;
        if (b[0] < 140 || b[1] < 140 || b[2] < 140) fail_msg("pixel %u is dark", (unsigned)i);
    }
    assert_true(drawn > PIXELS / 200u);
    return count;
}

static void wear_the_other(const show *w)
{
    const noh_appearance look = { .texture_set = 1 };
    assert_int_equal(noh_actor_set_appearance(w->stage, w->actors[1], &look, &said), NOH_OK);
}

/* From afar the small levels are all that the whole texture shows. Near, they are shown until finer ones come. */
static void coarser_levels_are_shown_until_the_finer_come(void **state)
{
    gpu *g = fixture_gpu();
    show whole, part;
    uint32_t waited = 0;
    canvas to;
    (void)state;
    assert_int_equal(canvas_open(&to, g, SIDE, SIDE), 0);
    open_show(&whole, g, 0), open_show(&part, g, 0);
    part.desc.texture_reserve = least_reserve(&part);
    make(&whole), make(&part);
    assert_true(noh_gl_ledger_bytes(&part.ledger) < noh_gl_ledger_bytes(&whole.ledger));
    for (uint32_t kind = 0; kind < 3; kind++) { /* the first one again: its fine levels were dropped for the second's */
        frame(&whole, kind % KINDS, 12.0f), frame(&part, kind % KINDS, 12.0f);
        assert_int_equal(apart(&whole, &part, &to), 0);
        frame(&whole, kind % KINDS, 0.7f), frame(&part, kind % KINDS, 0.7f);
        assert_int_equal(stats_of(&part)->textures_coarser, 1);
        while (stats_of(&part)->textures_coarser) {
            assert_true(apart(&whole, &part, &to) > PIXELS / 10u);
            frame(&whole, kind % KINDS, 0.7f), frame(&part, kind % KINDS, 0.7f);
            assert_true(++waited < 200u);
        }
        assert_int_equal(first_of(&part, kind % KINDS), 0);
        assert_int_equal(apart(&whole, &part, &to), 0);
    }
    assert_int_equal(first_of(&part, 1), 2);
    assert_true(waited > 10u);
    wear_the_other(&whole), wear_the_other(&part);
    for (waited = 0; waited < 60u; waited++) frame(&whole, 1, 0.7f), frame(&part, 1, 0.7f);
    assert_int_equal(first_of(&part, 0), 0);
    assert_int_equal(apart(&whole, &part, &to), 0);
    fixture_expect_no_errors();
    close_show(&whole), close_show(&part);
    canvas_close(&to);
}

/* ---- bounds ---- */

/* Any cameras, a lost context in between: `frame` compares ledger and plan. */
static void the_reserve_holds_in_any_order(void **state)
{
    test_random r = test_random_from(43u);
    uint32_t finer = 0, coarser = 0, before[KINDS] = { 2, 2 };
    gpu g;
    show w;
    (void)state;
    counted_open(&g);
    open_show(&w, &g, 0);
    w.desc.texture_reserve = least_reserve(&w);
    make(&w);
    for (uint32_t f = 0; f < 600; f++) {
        const uint32_t kind = f / 60u % KINDS;
        frame(&w, kind, f % 20u < 10u ? 0.6f : 0.5f + 0.1f * (float)test_random_below(&r, 150));
        for (uint32_t k = 0; k < KINDS; k++) {
            finer += first_of(&w, k) < before[k];
            coarser += first_of(&w, k) > before[k];
            before[k] = first_of(&w, k);
        }
        if (f % 97u == 96u) {
            const uint64_t bytes = noh_gl_ledger_bytes(&w.ledger);
            assert_int_equal(noh_stage_restore(w.stage, &said), NOH_OK);
            assert_true(noh_gl_ledger_bytes(&w.ledger) <= bytes); /* what was under way begins again */
        }
    }
    assert_true(finer > 6u && coarser > 6u);
    close_show(&w);
    gpu_close(&g);
}

/* Out of memory now and then: what is shown stays, and a later frame begins again. */
static void a_driver_that_fails_shows_what_was_there(void **state)
{
    static const char *const functions[] = { "glGenTextures", "glTexStorage2D", "glTexSubImage2D",
                                             "glCompressedTexSubImage2D" };
    test_random r = test_random_from(44u);
    uint32_t failed = 0, whole = 0;
    gpu g;
    show w;
    (void)state;
    counted_open(&g);
    open_show(&w, &g, 0);
    w.desc.texture_reserve = least_reserve(&w);
    make(&w);
    for (uint32_t f = 0; f < 400; f++) {
        const uint32_t kind = f / 40u % KINDS, before = first_of(&w, kind);
        if (f % 40u < 25u)
            noh_null_refuse(g.context, functions[test_random_below(&r, TEST_COUNT(functions))], 0, GL_OUT_OF_MEMORY);
        frame(&w, kind, 0.6f);
        if (noh_null_refused(g.context)) assert_int_equal(first_of(&w, kind), before);
        failed += noh_null_refused(g.context) != 0;
        noh_null_refuse(g.context, NULL, 0, 0);
        whole += before && !first_of(&w, kind);
    }
    assert_true(failed > 20u && whole > 2u);
    close_show(&w);
    gpu_close(&g);
}

/* A slot has its textures whole; the other kind's come by need. */
static void textures_of_slots_are_whole(void **state)
{
    gpu g;
    show w;
    (void)state;
    counted_open(&g);
    open_show(&w, &g, 0);
    w.kinds[1].changes = 1;
    w.desc.texture_reserve = bytes_from(&w, 0, 0) + 2u * bytes_from(&w, 0, 2);
    make(&w);
    assert_int_equal(((const noh_stage_gl *)w.stage->gpu)->streamed_count, 1);
    for (uint32_t f = 0; f < 40; f++) frame(&w, 0, 0.6f);
    assert_int_equal(first_of(&w, 0), 0);
    close_show(&w);
    gpu_close(&g);
}

static void a_reserve_that_is_too_small_is_refused(void **state)
{
    noh_stage_bytes parts[64];
    uint64_t sum = 0, stated = 0;
    uint32_t count;
    gpu g;
    show w;
    (void)state;
    counted_open(&g);
    open_show(&w, &g, 0);
    w.desc.texture_reserve = least_reserve(&w) - 1u;
    assert_int_equal(noh_stage_plan_make(&w.desc, w.device.caps, &w.plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "texture_reserve"));
    assert_int_equal(said.need, least_reserve(&w));
    w.desc.texture_reserve = said.need;
    make(&w);
    count = noh_stage_plan_parts(&w.desc, w.device.caps, &w.plan, parts, TEST_COUNT(parts));
    for (uint32_t i = 0; i < count; i++) {
        sum += parts[i].gpu_bytes;
        if (strcmp(parts[i].what, "texture reserve") == 0) stated += parts[i].gpu_bytes;
    }
    assert_int_equal(sum, w.plan.gpu_bytes);
    assert_int_equal(stated, w.desc.texture_reserve);
    close_show(&w);
    gpu_close(&g);
}

/* ---- which textures, and which first ---- */

/* The least reserve of a desc. */
static uint64_t need_of(show *w)
{
    w->desc.texture_reserve = 1;
    assert_int_equal(noh_stage_plan_make(&w->desc, w->device.caps, &w->plan, &said), NOH_ERR_ARG);
    return said.need;
}

/* The largest texture has all of the reserve; of two more that are near as well, one is small enough for the rest. */
static void a_texture_without_room_keeps_no_other_waiting(void **state)
{
    static const form forms[] = { PLAIN, PLAIN, SMALL };
    gpu g;
    show w;
    (void)state;
    counted_open(&g);
    open_forms(&w, &g, forms, 3);
    w.desc.texture_reserve = need_of(&w) + bytes_from(&w, 2, 0);
    make(&w);
    for (uint32_t f = 0; f < 40; f++) frame(&w, 0, 0.6f);
    assert_int_equal(first_of(&w, 0), 0);
    for (uint32_t i = 1; i < 3; i++) {
        const noh_place place = { .position = { 0.0f, 0.0f, -0.01f * (float)i } };
        assert_int_equal(noh_actor_set_place(w.stage, w.actors[i], &place, &said), NOH_OK);
    }
    for (uint32_t f = 0; f < 40; f++) frame(&w, 0, 0.6f);
    assert_int_equal(first_of(&w, 0), 0);
    assert_int_equal(first_of(&w, 1), 2);
    assert_int_equal(first_of(&w, 2), 0);
    assert_int_equal(stats_of(&w)->textures_coarser, 1);
    close_show(&w);
    gpu_close(&g);
}

/* The first kind has a texture that only the second one shows, while it wears it. */
static void kinds_bring_what_they_show(void **state)
{
    static const form forms[] = { TWO, PLAIN };
    gpu g;
    show w;
    (void)state;
    counted_open(&g);
    open_forms(&w, &g, forms, 2);
    w.sets.suffix = "-x";
    w.desc.texture_reserve = 2u * need_of(&w);
    make(&w);
    for (uint32_t f = 0; f < 60; f++) frame(&w, f / 30u, 0.6f);
    assert_int_equal(((const noh_stage_gl *)w.stage->gpu)->streamed_count, 3);
    assert_int_equal(first_of(&w, 0), 0);
    assert_int_equal(first_of(&w, 1), 2);
    assert_int_equal(first_of(&w, 2), 0);
    wear_the_other(&w);
    for (uint32_t f = 0; f < 30; f++) frame(&w, 1, 0.6f);
    assert_int_equal(first_of(&w, 1), 0);
    close_show(&w);
    gpu_close(&g);
}

/* The first kind's texture stays whole where the second one may wear it as a shade. */
static void shades_of_other_kinds_are_whole(void **state)
{
    static const form forms[] = { PLAIN, READ };
    gpu g;
    show w;
    (void)state;
    counted_open(&g);
    for (uint32_t sets = 0; sets < 2; sets++) {
        uint32_t count;
        open_forms(&w, &g, forms, 2);
        w.kinds[1].texture_set_count = sets;
        w.desc.texture_reserve = 4u * bytes_from(&w, 0, 0);
        assert_int_equal(noh_gl_textures_plan(&w.desc, w.device.caps, &count, &said), NOH_OK);
        assert_int_equal(count, 1u - sets);
        close_show(&w);
    }
    gpu_close(&g);
}

/* Nobody lends a texture whose levels come by need, in whatever kind and set it is found. */
static void plans_count_what_peers_lend(void **state)
{
    static const form forms[] = { PLAIN, LOOSE };
    noh_stage_peers none = { NULL, 0 }, peers;
    noh_stage_peer peer;
    uint64_t before;
    gpu g;
    show level, room;
    (void)state;
    counted_open(&g);
    open_forms(&level, &g, forms, 2), open_forms(&room, &g, forms, 1);
    level.desc.texture_reserve = need_of(&level);
    level.desc.share = &none;
    make(&level);
    peer = (noh_stage_peer){ &level.desc, &level.plan };
    peers = (noh_stage_peers){ &peer, 1 };
    room.kinds[0].mesh = &level.packs[0];
    room.desc.share = &peers;
    room.device.ledger = &level.ledger;
    before = noh_gl_ledger_bytes(&level.ledger);
    make(&room);
    assert_true(room.plan.shared_bytes > 0);
    assert_int_equal(noh_gl_ledger_bytes(&level.ledger) - before, room.plan.gpu_bytes);
    close_show(&room), close_show(&level);
    gpu_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coarser_levels_are_shown_until_the_finer_come),
        cmocka_unit_test(the_reserve_holds_in_any_order),
        cmocka_unit_test(a_driver_that_fails_shows_what_was_there),
        cmocka_unit_test(textures_of_slots_are_whole),
        cmocka_unit_test(a_reserve_that_is_too_small_is_refused),
        cmocka_unit_test(a_texture_without_room_keeps_no_other_waiting),
        cmocka_unit_test(kinds_bring_what_they_show),
        cmocka_unit_test(shades_of_other_kinds_are_whole),
        cmocka_unit_test(plans_count_what_peers_lend),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
