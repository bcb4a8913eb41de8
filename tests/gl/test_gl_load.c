/* Levels that come later: a stage on packs of coarse levels draws what such packs alone would, loads the finer levels
 * in pieces, draws what the full packs would, and drops them again. Whatever pack is not the right one is refused. */
#include "support/counted_gl.h"
#include "support/gl_fixture.h"
#include "support/stage_fixture.h"

#include "convert/pack/pack_strip.h"
#include "gpu/canvas.h"
#include "null.h"

#define WIDTH 160u
#define HEIGHT 90u
#define PIXELS (WIDTH * HEIGHT)
#define BOUND 200000u
#define FEW 2u /* kinds that have coarse packs: PUPPETS and MASKS */

static char shader_log[4096];

/* ---- packs ---- */

typedef struct bytes_of_pack {
    uint8_t *bytes;
    size_t count;
    noh_pack pack;
} bytes_of_pack;

static bytes_of_pack keep(const void *bytes, size_t count)
{
    bytes_of_pack k;
    k.bytes = test_aligned(bytes, count);
    k.count = count;
    k.pack = test_open(k.bytes, count);
    return k;
}

/* Without the levels below `level`. */
static bytes_of_pack strip(const noh_pack *from, uint32_t level)
{
    uint32_t first[64];
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error;
    bytes_of_pack k;
    assert_true(from->runs[NOH_CHUNK_MESH].count <= 64);
    for (uint32_t i = 0; i < from->runs[NOH_CHUNK_MESH].count; i++) {
        const noh_mesh mesh = test_mesh(from, i);
        first[i] = noh_mesh_at_lod(&mesh, level).header->level;
    }
    if (pack_strip(from, first, &out, &error)) fail_msg("%s", error.what);
    k = keep(out.bytes, out.count);
    buffer_free(&out);
    return k;
}

/* A pack's file in other memory, and nothing that could be read by mistake where it was. */
static void forget(bytes_of_pack *k)
{
    memset(k->bytes, 0xa5, k->count);
    free(k->bytes);
    memset(k, 0, sizeof *k);
}

/* ---- three casts: full packs, coarse packs, coarse packs with finer levels to come ---- */

typedef enum what { FULL, COARSE, LATER } what;

typedef struct act {
    cast c;
    bytes_of_pack coarse[FEW], finer[FEW];
    noh_actor actors[CAST_ACTORS];
} act;

static noh_gl_device device_of(gpu *g)
{
    const noh_gl_device d = { &g->gl, &g->caps, &g->ledger, shader_log, sizeof shader_log };
    return d;
}

static void make_desc(act *a, what kind)
{
    cast_open(&a->c);
    a->c.desc.gpu = &noh_stage_on_gl;
    a->c.desc.load_bytes = BOUND;
    for (uint32_t k = 0; k < FEW && kind != FULL; k++) {
        a->coarse[k] = strip(&a->c.packs[k], 2);
        a->c.kinds[k].mesh = &a->coarse[k].pack;
        if (kind == LATER) {
            a->finer[k] = keep(a->c.files[k].data, a->c.files[k].bytes);
            a->c.kinds[k].finer = &a->finer[k].pack;
        }
    }
}

/* Returns 0 where this driver has no such path. After init nothing is left where the finer packs were. */
static int open_act(act *a, what kind, gpu *g, fixture_way way)
{
    const noh_gl_device d = device_of(g);
    noh_error error;
    memset(a, 0, sizeof *a);
    make_desc(a, kind);
    a->c.desc.morph_path = (uint32_t)way.path;
    a->c.desc.halves = way.accumulate == NOH_ACCUMULATE_F16 ? 1 : -1;
    if (noh_stage_plan_make(&a->c.desc, &g->caps, &a->c.plan, &error) != NOH_OK) {
        assert_int_equal(error.result, NOH_ERR_UNSUPPORTED);
        return 0;
    }
    cast_make(&a->c, &d);
    for (uint32_t k = 0; k < FEW && kind == LATER; k++) forget(&a->finer[k]);
    cast_enter(&a->c, a->actors);
    return 1;
}

static void close_act(act *a)
{
    cast_close(&a->c);
    for (uint32_t k = 0; k < FEW; k++) {
        free(a->coarse[k].bytes);
        free(a->finer[k].bytes);
    }
}

static void frame(act *a, uint32_t f, uint32_t cut)
{
    noh_stage_view view = cast_view(f, 4.0f + 0.1f * (float)(f % 60u));
    view.cut = cut;
    assert_int_equal(noh_stage_frame(a->c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

static void draw(const act *a, canvas *to, uint32_t *rgba)
{
    canvas_begin(to);
    assert_int_equal(noh_stage_draw(a->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    canvas_resolve(to);
    assert_int_equal(canvas_read(to, (uint8_t *)rgba), 0);
}

static uint32_t apart(const act *a, const act *b, canvas *to)
{
    static uint32_t one[PIXELS], other[PIXELS];
    uint32_t count = 0, drawn = 0;
    draw(a, to, one);
    draw(b, to, other);
    for (uint32_t i = 0; i < PIXELS; i++) {
        count += one[i] != other[i];
        drawn += one[i] != one[0];
    }
    assert_true(drawn > PIXELS / 50u);
    return count;
}

/* Both show the next frame, and it is the same. */
static void expect_equal(act *a, act *b, uint32_t f, uint32_t cut, canvas *to, const char *when)
{
    uint32_t count;
    frame(a, f, cut);
    frame(b, f, cut);
    count = apart(a, b, to);
    if (count) fail_msg("%s, frame %u: %u pixels differ", when, (unsigned)f, (unsigned)count);
}

static void load(act *a, const noh_pack packs[FEW])
{
    for (uint32_t k = 0; k < FEW; k++) {
        noh_error error;
        if (noh_stage_load_level(a->c.stage, k, &packs[k], &error) != NOH_OK) fail_msg("load: %s", error.what);
    }
}

static void drop(act *a)
{
    for (uint32_t k = 0; k < FEW; k++) assert_int_equal(noh_stage_load_level(a->c.stage, k, NULL, NULL), NOH_OK);
}

static void lose(gpu *g)
{
    char message[1024];
    g->platform->destroy(g->context);
    assert_int_equal(g->platform->create(NULL, &g->context, message, sizeof message), NOH_OK);
    assert_int_equal(noh_gl_api_load(&g->gl, g->platform->get_proc, g->context, NULL), NOH_OK);
}

static void expect_planned(const act *a, const gpu *g, const noh_gl_ledger *before)
{
    assert_true(noh_gl_ledger_bytes(&g->ledger) - noh_gl_ledger_bytes(before) == a->c.plan.gpu_bytes);
}

/* Load within the bound, while all that is drawn stays as it was. Returns the frames that it took. */
static uint32_t load_in_pieces(act *later, act *coarse, const noh_pack packs[FEW], uint32_t f, canvas *to)
{
    const noh_stage_stats *stats = noh_stage_stats_of(later->c.stage);
    uint32_t frames = 0;
    load(later, packs);
    do {
        if (frames == 0 || stats->loading == FEW) { /* the kind that is ready first shows its levels at once */
            expect_equal(later, coarse, f + frames, 0, to, "while levels are loaded");
        } else {
            frame(later, f + frames, 0);
            frame(coarse, f + frames, 0);
        }
        frames++;
        assert_true(stats->load_bytes <= BOUND && frames < 100);
        assert_true(!stats->loading || stats->load_bytes > BOUND - 256u);
    } while (stats->loading);
    return frames;
}

/* The states of a stage with and without its finer levels. */
static void states_cross(act *later, act *full, const noh_pack packs[FEW], uint32_t f, canvas *to)
{
    static uint32_t first[PIXELS], again[PIXELS];
    const noh_stage_stats *stats = noh_stage_stats_of(later->c.stage);
    size_t bytes;
    uint8_t *fine = test_aligned(noh_stage_state(later->c.stage, &bytes), later->c.plan.state_bytes), *coarse;
    for (uint32_t i = 0; i < 5; i++) frame(later, f + i, 0);
    draw(later, to, first);
    drop(later);
    for (uint32_t i = 0; i < 5; i++) frame(later, f + i, 0);
    coarse = test_aligned(noh_stage_state(later->c.stage, &bytes), later->c.plan.state_bytes);
    assert_int_equal(noh_stage_set_state(later->c.stage, fine, bytes, NULL), NOH_OK);
    for (uint32_t i = 0; i < 5; i++) frame(later, f + i, 0);
    load(later, packs);
    do {
        frame(later, f, 0);
    } while (stats->loading);
    assert_int_equal(noh_stage_set_state(later->c.stage, coarse, bytes, NULL), NOH_OK);
    for (uint32_t i = 0; i < 5; i++) frame(later, f + i, 0);
    assert_int_equal(noh_stage_set_state(later->c.stage, fine, bytes, NULL), NOH_OK);
    for (uint32_t i = 0; i < 5; i++) frame(later, f + i, 0);
    draw(later, to, again);
    assert_memory_equal(first, again, sizeof first);
    for (uint32_t i = 0; i < 5; i++) frame(full, f + i, 0);
    assert_int_equal(apart(later, full, to), 0);
    free(fine);
    free(coarse);
}

static void lose_and_restore(act *acts, gpu *g, canvas *to)
{
    noh_gl_ledger before;
    canvas_close(to);
    before = g->ledger;
    lose(g);
    for (uint32_t i = 0; i < 3; i++) assert_int_equal(noh_stage_restore(acts[i].c.stage, NULL), NOH_OK);
    assert_memory_equal(&before, &g->ledger, sizeof before);
    assert_int_equal(canvas_open(to, g, WIDTH, HEIGHT), 0);
}

/* In rounds `first` to 1: in round 0 states cross, in round 1 contexts are lost. */
static void levels_come_and_go_on(fixture_way way, uint32_t first, uint32_t *made)
{
    static act acts[3];
    gpu *g = fixture_gpu();
    const noh_gl_ledger before = g->ledger;
    uint32_t f = 0;
    canvas to;
    if (!open_act(&acts[LATER], LATER, g, way)) {
        close_act(&acts[LATER]);
        return;
    }
    expect_planned(&acts[LATER], g, &before);
    assert_true(open_act(&acts[FULL], FULL, g, way) && open_act(&acts[COARSE], COARSE, g, way));
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    for (; f < 6; f++) expect_equal(&acts[LATER], &acts[COARSE], f, f == 0, &to, "before levels are loaded");
    for (uint32_t i = 0; i < 6; i++) frame(&acts[FULL], i, i == 0);
    assert_true(apart(&acts[LATER], &acts[FULL], &to) > 20);
    for (uint32_t round = first; round < 2; round++) {
        bytes_of_pack brought[FEW];
        noh_pack packs[FEW];
        uint32_t frames;
        for (uint32_t k = 0; k < FEW; k++) {
            brought[k] = keep(acts[LATER].c.files[k].data, acts[LATER].c.files[k].bytes);
            packs[k] = brought[k].pack;
        }
        frames = load_in_pieces(&acts[LATER], &acts[COARSE], packs, f, &to);
        for (uint32_t i = 0; i < frames; i++) frame(&acts[FULL], f + i, 0);
        f += frames;
        assert_true(frames > 5);
        for (uint32_t i = 0; i < 4; i++, f++) {
            expect_equal(&acts[LATER], &acts[FULL], f, i == 0, &to, "with all levels");
            frame(&acts[COARSE], f, i == 0);
        }
        if (round == 1) lose_and_restore(acts, g, &to);
        expect_equal(&acts[LATER], &acts[FULL], f, 0, &to, "with all levels, restored");
        frame(&acts[COARSE], f++, 0);
        if (round == 0) {
            states_cross(&acts[LATER], &acts[FULL], packs, f, &to);
            for (uint32_t i = 0; i < 5; i++) frame(&acts[COARSE], f + i, 0);
            f += 5;
        }
        drop(&acts[LATER]);
        for (uint32_t k = 0; k < FEW; k++) forget(&brought[k]);
        for (uint32_t i = 0; i < 4; i++, f++) {
            expect_equal(&acts[LATER], &acts[COARSE], f, i == 0, &to, "with levels dropped");
            frame(&acts[FULL], f, i == 0);
        }
        if (round == 1) lose_and_restore(acts, g, &to);
        expect_equal(&acts[LATER], &acts[COARSE], f, 0, &to, "with levels dropped, restored");
        frame(&acts[FULL], f++, 0);
    }
    canvas_close(&to);
    close_act(&acts[FULL]);
    close_act(&acts[COARSE]);
    expect_planned(&acts[LATER], g, &before);
    close_act(&acts[LATER]);
    assert_memory_equal(&before, &g->ledger, sizeof before);
    (*made)++;
}

/* By blending, by lists, on the CPU and as draws sum (NOH_LONG: on every path, in floats and half floats; under
 * sanitizers on one): the picture equals the coarse packs' before and while levels are loaded, the full packs'
 * afterwards, the coarse packs' once they are dropped; over lost contexts. By blending and as draws sum (NOH_LONG, and
 * under sanitizers: on all of these) a round with states comes before. */
static void levels_come_and_go(void **state)
{
    uint32_t made = 0;
    (void)state;
    for (uint32_t w = 0; w < FIXTURE_WAYS; w++) {
        const int in_turn = w == 0 || w == 7 || w == 8 || w == 10; /* layered f32, gather f16, cpu f32, direct */
        const int is_left_out = test_is_sanitized() ? w != 4 : !in_turn;
        const int has_states = getenv("NOH_LONG") || test_is_sanitized() || w == 0 || w == 10;
        if (getenv("NOH_LONG") || !is_left_out) levels_come_and_go_on(fixture_ways[w], has_states ? 0 : 1, &made);
    }
    assert_true(made >= 1);
    fixture_expect_no_errors();
}

/* ---- on the driver that counts ---- */

/* Load a kind frame by frame; returns the bytes. */
static uint64_t load_alone(act *a, uint32_t kind, uint32_t bound)
{
    const noh_stage_stats *stats = noh_stage_stats_of(a->c.stage);
    uint64_t sum = 0;
    assert_int_equal(noh_stage_load_level(a->c.stage, kind, &a->c.packs[kind], NULL), NOH_OK);
    do {
        const noh_stage_view view = cast_view(0, 5.0f);
        counted.bytes = 0;
        assert_int_equal(noh_stage_frame(a->c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_true(counted.bytes == stats->load_bytes && counted.bytes <= bound);
        assert_true(!stats->loading || counted.bytes > 0);
        sum += counted.bytes;
    } while (stats->loading);
    return sum;
}

/* With nobody on the stage all that is uploaded is levels: as much as is reported, and no more than the bound, whatever
 * it is; and in all as much as without a bound. */
static void each_frame_keeps_the_bound(void **state)
{
    static const uint32_t bounds[] = { 1, 100, 5000, 65536, 100u << 20 };
    static gpu g;
    static act a;
    (void)state;
    for (uint32_t w = 0; w < TEST_COUNT(counted_ways); w++) {
        uint64_t least = UINT64_MAX, most = 0;
        for (uint32_t b = 0; b < TEST_COUNT(bounds); b++) {
            const uint32_t bound = bounds[b] < 256u ? 256u : bounds[b];
            uint64_t sum = 0;
            const int by_block = counted_ways[w].path == NOH_MORPH_GATHER || counted_ways[w].path == NOH_MORPH_DIRECT;
            if (bounds[b] < 5000u && by_block) continue; /* two walks for each piece */
            counted_open(&g);
            memset(&a, 0, sizeof a);
            make_desc(&a, LATER);
            a.c.desc.kind_count = FEW;
            a.c.desc.load_bytes = bounds[b];
            a.c.desc.morph_path = (uint32_t)counted_ways[w].path;
            {
                const noh_gl_device d = device_of(&g);
                cast_make(&a.c, &d);
            }
            for (uint32_t k = 0; k < FEW; k++) {
                /* what changes over to new levels, or is there for the first time, is cleared */
                assert_int_equal(noh_stage_frame(a.c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
                sum += load_alone(&a, k, bound);
            }
            least = sum < least ? sum : least;
            most = sum > most ? sum : most;
            close_act(&a);
            gpu_close(&g);
        }
        assert_true(least == most && least > 100000u);
    }
}

/* Levels that come and go at any time, on every path: no call that makes anything, none that GL would refuse. */
static void frames_make_nothing(void **state)
{
    static gpu g;
    static act a;
    test_random r = test_random_from(5);
    (void)state;
    for (uint32_t w = 0; w < TEST_COUNT(counted_ways); w++) {
        noh_null_report report;
        uint32_t loaded = 0, dropped = 0;
        counted_open(&g);
        assert_true(open_act(&a, LATER, &g, counted_ways[w]));
        noh_null_count_anew(g.context);
        for (uint32_t f = 0; f < 600; f++) {
            const uint32_t kind = test_random_below(&r, FEW);
            if (test_random_below(&r, 20) == 0) {
                assert_int_equal(noh_stage_load_level(a.c.stage, kind, &a.c.packs[kind], NULL), NOH_OK);
                loaded++;
            }
            if (test_random_below(&r, 60) == 0) {
                assert_int_equal(noh_stage_load_level(a.c.stage, kind, NULL, NULL), NOH_OK);
                dropped++;
            }
            frame(&a, f, test_random_below(&r, 10) == 0);
            assert_int_equal(noh_stage_draw(a.c.stage, f % 3u ? NOH_PASS_COLOR : NOH_PASS_DEPTH, 0, NULL, NULL),
                             NOH_OK);
        }
        noh_null_report_of(g.context, &report);
        if (report.violations) fail_msg("%s", report.first);
        assert_int_equal(report.allocations, 0);
        assert_true(loaded > 10 && dropped > 3 && report.draws > 600);
        assert_true(noh_gl_ledger_bytes(&g.ledger) == a.c.plan.gpu_bytes);
        close_act(&a);
        gpu_close(&g);
    }
}

static uint32_t finest_shown(const act *a)
{
    const noh_stage_stats *stats = noh_stage_stats_of(a->c.stage);
    uint32_t level = 0;
    while (level + 1u < NOH_LOD_LEVELS_MAX && !stats->at_level[level]) level++;
    return level;
}

/* Two kinds of the same packs have one mesh on the GPU, so what is loaded or dropped for one is for both. */
static void kinds_share_their_levels(void **state)
{
    const noh_appearance finest = { .pixels = 1e-4f };
    static gpu g;
    static act a;
    uint32_t coarse;
    (void)state;
    counted_open(&g);
    memset(&a, 0, sizeof a);
    make_desc(&a, LATER);
    a.c.kinds[0] = a.c.kinds[1] = a.c.kinds[MASKS];
    a.c.desc.kind_count = 2;
    {
        const noh_gl_device d = device_of(&g);
        cast_make(&a.c, &d);
    }
    assert_int_equal(noh_stage_spawn(a.c.stage, 0, NULL, &a.actors[0], NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(a.c.stage, a.actors[0], &finest, NULL), NOH_OK);
    frame(&a, 0, 1);
    coarse = finest_shown(&a);
    assert_true(coarse > 0);
    assert_int_equal(noh_stage_load_level(a.c.stage, 1, &a.c.packs[MASKS], NULL), NOH_OK);
    do {
        frame(&a, 0, 0);
    } while (noh_stage_stats_of(a.c.stage)->loading);
    frame(&a, 1, 1);
    assert_int_equal(finest_shown(&a), 0);
    assert_int_equal(noh_stage_load_level(a.c.stage, 1, NULL, NULL), NOH_OK);
    frame(&a, 2, 0);
    assert_int_equal(finest_shown(&a), coarse);
    close_act(&a);
    gpu_close(&g);
}

/* ---- what is refused ---- */

static void expect_refused(act *a, const noh_pack *pack, noh_result result)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    assert_int_equal(noh_stage_load_level(a->c.stage, MASKS, pack, &error), result);
    assert_true(error.result == result && error.what[0]);
    frame(a, 1, 0);
    assert_int_equal(noh_stage_stats_of(a->c.stage)->loading, 0);
}

/* A pack whose first mesh's header says something else, and whose checksums are right. */
static bytes_of_pack forge(const noh_pack *from, size_t field, uint32_t value)
{
    bytes_of_pack k = keep(from->bytes, from->byte_count);
    uint8_t *mesh = k.bytes + k.pack.chunks[k.pack.runs[NOH_CHUNK_MESH].first].offset;
    memcpy(mesh + field, &value, sizeof value);
    return k;
}

/* What is not the pack that the kind's was stripped from, or has too few levels, is refused, and changes nothing. */
static void other_packs_are_refused(void **state)
{
    static gpu g;
    static act a;
    bytes_of_pack shorter, coarse, forged;
    (void)state;
    counted_open(&g);
    assert_true(open_act(&a, LATER, &g, counted_ways[0]));
    shorter = strip(&a.c.packs[MASKS], 1);
    coarse = strip(&a.c.packs[MASKS], 2);
    expect_refused(&a, &a.c.packs[PUPPETS], NOH_ERR_DATA);
    expect_refused(&a, &a.c.packs[TUBES], NOH_ERR_DATA);
    expect_refused(&a, &shorter.pack, NOH_ERR_DATA);
    expect_refused(&a, &coarse.pack, NOH_ERR_DATA);
    forged = forge(&a.c.packs[MASKS], offsetof(noh_mesh_header, texel_count), 1u << 20);
    expect_refused(&a, &forged.pack, NOH_ERR_DATA);
    forget(&forged);
    forged = forge(&a.c.packs[MASKS], offsetof(noh_mesh_header, vertex_count), 1u << 20);
    expect_refused(&a, &forged.pack, NOH_ERR_DATA);
    forget(&forged);
    {
        const noh_pack none = { .bytes = a.c.packs[MASKS].bytes };
        noh_error error;
        expect_refused(&a, &none, NOH_ERR_DATA);
        assert_int_equal(noh_stage_load_level(a.c.stage, TUBES, &a.c.packs[TUBES], &error), NOH_ERR_UNSUPPORTED);
        assert_int_equal(noh_stage_load_level(a.c.stage, 9, &a.c.packs[MASKS], &error), NOH_ERR_ARG);
        assert_int_equal(noh_stage_load_level(a.c.stage, 9, NULL, &error), NOH_ERR_ARG);
        assert_int_equal(noh_stage_load_level(a.c.stage, TUBES, NULL, &error), NOH_OK);
        assert_int_equal(noh_stage_frame_begin(a.c.stage, NULL, 0, NULL), NOH_OK);
        assert_int_equal(noh_stage_load_level(a.c.stage, MASKS, &a.c.packs[MASKS], &error), NOH_ERR_ARG);
        assert_int_equal(noh_stage_load_level(a.c.stage, MASKS, NULL, &error), NOH_ERR_ARG);
        assert_int_equal(noh_stage_frame_end(a.c.stage, NULL), NOH_OK);
    }
    free(shorter.bytes);
    free(coarse.bytes);
    close_act(&a);
    gpu_close(&g);
}

static uint64_t gpu_bytes_of(what kind, const gpu *g, noh_morph_path path)
{
    static act a;
    noh_stage_plan plan;
    memset(&a, 0, sizeof a);
    make_desc(&a, kind);
    a.c.desc.morph_path = (uint32_t)path;
    assert_int_equal(noh_stage_plan_make(&a.c.desc, &g->caps, &plan, NULL), NOH_OK);
    close_act(&a);
    return plan.gpu_bytes;
}

/* Room for levels to come is the room of the full pack, and the tables of the coarse levels. */
static void room_costs_little(void **state)
{
    static gpu g;
    (void)state;
    counted_open(&g);
    assert_true(gpu_bytes_of(LATER, &g, NOH_MORPH_CPU) == gpu_bytes_of(FULL, &g, NOH_MORPH_CPU));
    for (uint32_t w = 0; w < TEST_COUNT(counted_ways); w++) {
        const uint64_t full = gpu_bytes_of(FULL, &g, counted_ways[w].path);
        const uint64_t later = gpu_bytes_of(LATER, &g, counted_ways[w].path);
        print_message("# %s: %u bytes on the GPU with all levels, %u with finer ones to come\n",
                      noh_morph_path_name(counted_ways[w].path), (unsigned)full, (unsigned)later);
        assert_true(later >= full && later - full < full / 8u);
    }
    gpu_close(&g);
}

/* A `finer` that is not the mesh's is refused by plans; a byte too little is MEMORY; a finer that lacks the first level
 * is good for the levels that it has. */
static void plans_know_the_finer_levels(void **state)
{
    static gpu g;
    static act a;
    bytes_of_pack half;
    noh_stage_plan full, some;
    noh_stage *stage = NULL;
    noh_error error;
    uint8_t *memory;
    (void)state;
    counted_open(&g);
    memset(&a, 0, sizeof a);
    make_desc(&a, LATER);
    half = strip(&a.c.packs[MASKS], 1);
    {
        const noh_gl_device d = device_of(&g);
        const noh_gl_ledger before = g.ledger;
        assert_int_equal(noh_stage_plan_make(&a.c.desc, &g.caps, &full, NULL), NOH_OK);
        memory = test_aligned(NULL, (size_t)full.cpu_bytes);
        assert_int_equal(noh_stage_init(memory, (size_t)full.cpu_bytes - 1u, &d, &a.c.desc, &full, &stage, &error),
                         NOH_ERR_MEMORY);
        assert_true(error.need == full.cpu_bytes && !stage);
        assert_memory_equal(&before, &g.ledger, sizeof before);
        free(memory);
    }
    a.c.kinds[MASKS].finer = &half.pack;
    assert_int_equal(noh_stage_plan_make(&a.c.desc, &g.caps, &some, NULL), NOH_OK);
    assert_true(some.gpu_bytes < full.gpu_bytes);
    a.c.kinds[MASKS].finer = &a.c.packs[PUPPETS];
    assert_int_equal(noh_stage_plan_make(&a.c.desc, &g.caps, &some, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, MASKS);
    a.c.kinds[MASKS].mesh = &half.pack;
    a.c.kinds[MASKS].finer = &a.coarse[MASKS].pack; /* the wrong way round */
    assert_int_equal(noh_stage_plan_make(&a.c.desc, &g.caps, &some, &error), NOH_ERR_ARG);
    free(half.bytes);
    close_act(&a);
    gpu_close(&g);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_come_and_go),      cmocka_unit_test(each_frame_keeps_the_bound),
        cmocka_unit_test(frames_make_nothing),     cmocka_unit_test(kinds_share_their_levels),
        cmocka_unit_test(other_packs_are_refused), cmocka_unit_test(plans_know_the_finer_levels),
        cmocka_unit_test(room_costs_little),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
