/* Kinds that come into a stage that draws: while they are uploaded the picture is as without them, then as on a
 * stage that had them from the start; what runs keeps its pictures. Uploads keep their bound, and whatever GL call fails,
 * a kind comes or does not, the others are drawn, and nothing is left behind. */
#include "support/counted_gl.h"
#include "support/gl_fixture.h"
#include "support/stage_fixture.h"

#include "gl/stage/stage_gl_internal.h"
#include "gpu/canvas.h"
#include "null.h"
#include "stage/cast/stage_internal.h"

#define WIDTH 160u
#define HEIGHT 90u
#define PIXELS (WIDTH * HEIGHT)
#define BOUND 200000u

static char shader_log[4096];
static noh_error said;

/* Opened once for all tests. */
static cast packs;

typedef struct act {
    cast c;
    noh_gl_ledger ledger;
    noh_gl_device device;
    noh_kind_desc others[CAST_KINDS];
} act;

/* The cast, its puppets first. */
static void open_act(act *a, gpu *g, fixture_way way)
{
    memset(a, 0, sizeof *a);
    a->c = packs;
    a->c.desc.kinds = a->c.kinds;
    a->c.desc.gpu = &noh_stage_on_gl;
    a->c.desc.load_bytes = BOUND;
    a->c.desc.morph_path = (uint32_t)way.path;
    a->c.desc.without_depth = 1;
    a->c.desc.halves = way.accumulate == NOH_ACCUMULATE_F16 ? 1 : -1;
    for (uint32_t k = 0; k < CAST_KINDS; k++) {
        a->c.kinds[k].actor_count = 3;
        a->others[k] = a->c.kinds[k];
    }
    a->device = (noh_gl_device){ &g->gl, &g->caps, &a->ledger, shader_log, sizeof shader_log };
}

/* Its other kinds come later: two slots, each for all three. */
static void with_slots(act *a, uint32_t slots)
{
    for (uint32_t i = 0; i < slots; i++) {
        noh_kind_desc *d = &a->c.kinds[CAST_KINDS - slots + i];
        d->changes = 2;
        d->others = a->others;
        d->other_count = CAST_KINDS;
    }
}

/* Returns 0 where this driver has no such path. */
static int make_act(act *a)
{
    if (noh_stage_plan_make(&a->c.desc, a->device.caps, &a->c.plan, &said) != NOH_OK) {
        assert_int_equal(said.result, NOH_ERR_UNSUPPORTED);
        return 0;
    }
    cast_make(&a->c, &a->device);
    return 1;
}

static void close_act(act *a)
{
    static const noh_gl_ledger nothing;
    cast_close_stage(&a->c);
    assert_memory_equal(&nothing, &a->ledger, sizeof nothing);
}

static void put(act *a, uint32_t kind, const noh_kind_desc *desc)
{
    if (noh_stage_set_kind(a->c.stage, kind, desc, &said) != NOH_OK) fail_msg("%s", said.what);
}

static void enter(act *a, uint32_t kind, noh_actor actors[3])
{
    static const char *const clips[CAST_KINDS] = { "walk", "speak", NULL };
    for (uint32_t i = 0; i < 3; i++) {
        const noh_place place = { { 1.1f * (float)i - 1.0f, 0.0f, -1.2f * (float)kind }, { 0, 0, 0, 0 }, 0.0f };
        const noh_play play = { .start_ticks = 5000 * (int64_t)i };
        if (noh_stage_spawn(a->c.stage, kind, &place, &actors[i], &said) != NOH_OK) fail_msg("%s", said.what);
        if (clips[kind])
            assert_int_equal(noh_actor_play(a->c.stage, actors[i], kind == MASKS ? 1 : 0, clips[kind], &play, &said),
                             NOH_OK);
    }
}

static void leave(act *a, const noh_actor actors[3])
{
    for (uint32_t i = 0; i < 3; i++) assert_int_equal(noh_stage_despawn(a->c.stage, actors[i], &said), NOH_OK);
}

static void frame(act *a, uint32_t f)
{
    const noh_stage_view view = cast_view(f, 4.0f + 0.1f * (float)(f % 60u));
    if (noh_stage_frame(a->c.stage, CAST_STEP, &view, NULL, NULL, &said) != NOH_OK) fail_msg("%s", said.what);
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
    if (drawn < PIXELS / 200u) fail_msg("%u pixels are drawn", (unsigned)drawn);
    return count;
}

typedef struct pair {
    act late, full; /* kinds that come; that were there */
    canvas to;
    gpu *g;
    uint32_t f;
} pair;

static void step(pair *t)
{
    frame(&t->late, t->f);
    frame(&t->full, t->f++);
}

static void expect_full(pair *t, uint32_t frames, const char *when)
{
    for (uint32_t i = 0; i < frames; i++) {
        uint32_t count;
        step(t);
        count = apart(&t->late, &t->full, &t->to);
        if (count) fail_msg("%s, frame %u: %u pixels differ", when, (unsigned)t->f, (unsigned)count);
        assert_true(noh_gl_ledger_bytes(&t->late.ledger) <= t->late.c.plan.gpu_bytes);
    }
}

static void lose(pair *t)
{
    const noh_gl_ledger before = t->late.ledger;
    char message[1024];
    canvas_close(&t->to);
    t->g->platform->destroy(t->g->context);
    assert_int_equal(t->g->platform->create(NULL, &t->g->context, message, sizeof message), NOH_OK);
    assert_int_equal(noh_gl_api_load(&t->g->gl, t->g->platform->get_proc, t->g->context, NULL), NOH_OK);
    assert_int_equal(noh_stage_restore(t->late.c.stage, NULL), NOH_OK);
    assert_int_equal(noh_stage_restore(t->full.c.stage, NULL), NOH_OK);
    assert_memory_equal(&before, &t->late.ledger, sizeof before);
    assert_int_equal(canvas_open(&t->to, t->g, WIDTH, HEIGHT), 0);
}

/* Until the kind is drawn; meanwhile the other stage is drawn without its kind. `lost`: the context is, on the way. */
static uint32_t come(pair *t, uint32_t kind, int lost)
{
    const noh_stage_stats *stats = noh_stage_stats_of(t->late.c.stage);
    uint32_t frames = 0;
    for (;; frames++) {
        step(t);
        assert_true(stats->load_bytes <= BOUND && frames < 200);
        assert_int_equal(stats->loading, stats->coming ? 1 : 0);
        if (!stats->coming) break;
        assert_int_equal(stats->coming, 1u << kind);
        if (frames == 1u) {
            t->full.c.stage->kinds[kind].finer.hidden = 1;
            assert_int_equal(apart(&t->late, &t->full, &t->to), 0);
            t->full.c.stage->kinds[kind].finer.hidden = 0;
        }
        if (lost && frames == 2) lose(t);
    }
    assert_int_equal(apart(&t->late, &t->full, &t->to), 0);
    return frames;
}

static int open_pair(pair *t, gpu *g, fixture_way way)
{
    memset(t, 0, sizeof *t);
    t->g = g;
    open_act(&t->late, g, way), open_act(&t->full, g, way);
    with_slots(&t->late, 2);
    if (!make_act(&t->late)) return 0;
    assert_true(make_act(&t->full));
    assert_int_equal(canvas_open(&t->to, g, WIDTH, HEIGHT), 0);
    return 1;
}

static void close_pair(pair *t)
{
    canvas_close(&t->to);
    close_act(&t->late), close_act(&t->full);
}

static void kinds_come_on(gpu *g, fixture_way way, int loses, uint32_t *made)
{
    static pair t;
    noh_actor tubes[2][3], masks[2][3];
    noh_gl_ledger empty;
    if (!open_pair(&t, g, way)) return;
    enter(&t.late, PUPPETS, masks[0]), enter(&t.full, PUPPETS, masks[1]);
    expect_full(&t, 1, "puppets alone");
    empty = t.late.ledger;
    for (uint32_t round = 0; round < 2; round++) {
        put(&t.late, TUBES, &t.late.others[TUBES]); /* nobody is of it */
        (void)come(&t, TUBES, 0);
        enter(&t.late, TUBES, tubes[0]), enter(&t.full, TUBES, tubes[1]);
        expect_full(&t, 1, "with tubes");
        put(&t.late, MASKS, &t.late.others[MASKS]);
        enter(&t.late, MASKS, masks[0]), enter(&t.full, MASKS, masks[1]);
        assert_true(come(&t, MASKS, loses && round == 1) > 3u);
        expect_full(&t, 1, "with masks");
        leave(&t.late, tubes[0]), leave(&t.full, tubes[1]);
        put(&t.late, TUBES, NULL);
        expect_full(&t, 1, "without tubes");
        leave(&t.late, masks[0]), leave(&t.full, masks[1]);
        put(&t.late, MASKS, NULL);
        expect_full(&t, 1, "puppets alone again");
        assert_memory_equal(&empty, &t.late.ledger, sizeof empty);
    }
    close_pair(&t);
    (*made)++;
}

/* On the CPU, with a context that is lost (NOH_LONG: on every path but streams). */
static void pictures_are_those_of_kinds_that_were_there(void **state)
{
    gpu *g = fixture_gpu();
    uint32_t made = 0;
    (void)state;
    for (uint32_t w = 0; w < FIXTURE_WAYS; w++) {
        const fixture_way way = fixture_ways[w];
        const int by_cpu = way.path == NOH_MORPH_CPU && way.accumulate == NOH_ACCUMULATE_F32;
        if (way.path == NOH_MORPH_STREAMS || !(by_cpu || getenv("NOH_LONG"))) continue;
        kinds_come_on(g, way, by_cpu, &made);
    }
    assert_true(made >= 1);
    fixture_expect_no_errors();
}

/* ---- on the driver that counts ---- */

/* Upload a kind that nobody is of. Returns its bytes. */
static uint64_t upload_alone(act *a, uint32_t bound)
{
    const noh_stage_stats *stats = noh_stage_stats_of(a->c.stage);
    uint64_t sum = 0;
    put(a, MASKS, &a->others[MASKS]);
    do {
        counted.bytes = 0;
        assert_int_equal(noh_stage_frame(a->c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        if (!stats->coming) break;                                /* its sums are made for the first time */
        if (sum) assert_true(counted.bytes == stats->load_bytes); /* the first frame has its palettes, too */
        assert_true(stats->load_bytes <= bound && stats->load_bytes > 0);
        sum += stats->load_bytes;
    } while (1);
    return sum;
}

/* Whatever the bound is, each frame keeps it, and in all as much is sent as without one. */
static void each_frame_keeps_the_bound(void **state)
{
    static const uint32_t bounds[] = { 1, 777, 5000, 65536, 100u << 20 };
    static gpu g;
    static act a;
    (void)state;
    for (uint32_t w = 0; w < TEST_COUNT(counted_ways); w++) {
        uint64_t least = UINT64_MAX, most = 0;
        for (uint32_t b = 0; b < TEST_COUNT(bounds); b++) {
            const uint32_t bound = bounds[b] < 256u ? 256u : bounds[b];
            const int by_block = counted_ways[w].path == NOH_MORPH_GATHER || counted_ways[w].path == NOH_MORPH_DIRECT;
            uint64_t sum;
            if (bounds[b] < 5000u && (by_block || w == 2)) continue; /* two walks for each piece */
            counted_open(&g);
            open_act(&a, &g, counted_ways[w]);
            with_slots(&a, 2);
            a.c.desc.load_bytes = bounds[b];
            assert_true(make_act(&a));
            sum = upload_alone(&a, bound);
            least = sum < least ? sum : least;
            most = sum > most ? sum : most;
            close_act(&a);
            gpu_close(&g);
        }
        assert_true(least == most && least > 100000u);
    }
}

static void GL_APIENTRY count_contents(GLenum target, GLsizeiptr bytes, const void *data, GLenum usage)
{
    counted.bytes += data ? (uint64_t)bytes : 0;
    counted.real.BufferData(target, bytes, data, usage);
}

static uint64_t bytes_of_restore(act *a)
{
    counted.bytes = 0;
    assert_int_equal(noh_stage_restore(a->c.stage, NULL), NOH_OK);
    return counted.bytes;
}

/* A kind that is there is sent once more; one that is on its way begins again, and keeps the bound. */
static void a_new_context_gets_each_byte_once(void **state)
{
    static gpu g;
    static act a;
    (void)state;
    for (uint32_t w = 0; w < TEST_COUNT(counted_ways); w++) {
        const noh_stage_stats *stats;
        uint64_t sum, without, with, later, left = 0;
        counted_open(&g);
        g.gl.BufferData = count_contents;
        open_act(&a, &g, counted_ways[w]);
        with_slots(&a, 2);
        a.c.desc.load_bytes = 65536;
        assert_true(make_act(&a));
        stats = noh_stage_stats_of(a.c.stage);
        without = bytes_of_restore(&a);
        sum = upload_alone(&a, 65536);
        with = bytes_of_restore(&a) - without;
        assert_true(with >= sum && with < sum + sum / 4u);
        put(&a, MASKS, NULL);
        put(&a, MASKS, &a.others[MASKS]);
        assert_int_equal(noh_stage_frame(a.c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        later = bytes_of_restore(&a) - without;
        while (assert_int_equal(noh_stage_frame(a.c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK), stats->coming) {
            assert_true(stats->load_bytes <= 65536);
            left += stats->load_bytes;
        }
        assert_true(later < sum / 4u && left == sum);
        close_act(&a);
        gpu_close(&g);
    }
}

/* ---- any order, with a driver that fails ---- */

static const char *const functions[] = {
    "glGenBuffers",      "glBufferData",    "glBufferSubData",          "glGenVertexArrays",
    "glGenTextures",     "glTexStorage2D",  "glTexStorage3D",           "glTexSubImage2D",
    "glGenFramebuffers", "glTexSubImage3D", "glCompressedTexSubImage2D"
};

typedef struct fate {
    uint32_t holds; /* 1 + kind; 0: nothing */
    noh_actor actors[3];
    uint32_t count;
    uint32_t refused, came, went;
} fate;

static void act_at_random(act *a, uint32_t slot, fate *at, const gpu *g, test_random *r)
{
    const uint32_t what = test_random_below(r, 6);
    if (!at->holds) {
        const uint32_t kind = test_random_below(r, CAST_KINDS);
        const uint64_t before = noh_gl_ledger_bytes(&a->ledger), hash = noh_stage_hash(a->c.stage);
        const int fails = test_random_below(r, 4) != 0;
        noh_result result;
        noh_null_report was, is;
        noh_null_report_of(g->context, &was);
        if (fails)
            noh_null_refuse(g->context, functions[test_random_below(r, TEST_COUNT(functions))], test_random_below(r, 3),
                            test_random_below(r, 2) ? GL_OUT_OF_MEMORY : GL_INVALID_OPERATION);
        result = noh_stage_set_kind(a->c.stage, slot, &a->others[kind], &said);
        if (noh_null_refused(g->context)) {
            assert_true(result != NOH_OK && said.what[0]);
            at->refused++;
            noh_null_report_of(g->context, &is);
            assert_memory_equal(was.live, is.live, sizeof was.live);
            assert_true(noh_gl_ledger_bytes(&a->ledger) == before && noh_stage_hash(a->c.stage) == hash);
        } else {
            if (result) fail_msg("%s", said.what);
            noh_null_report_of(g->context, &is);
            assert_int_equal(was.violations, is.violations);
            at->holds = 1u + kind;
            at->came++;
        }
        noh_null_refuse(g->context, NULL, 0, 0);
    } else if (what == 0) {
        while (at->count) assert_int_equal(noh_stage_despawn(a->c.stage, at->actors[--at->count], NULL), NOH_OK);
        put(a, slot, NULL);
        at->holds = 0;
        at->went++;
    } else if (what < 4 && at->count < 3) {
        assert_int_equal(noh_stage_spawn(a->c.stage, slot, NULL, &at->actors[at->count++], NULL), NOH_OK);
    } else if (at->count) {
        assert_int_equal(noh_stage_despawn(a->c.stage, at->actors[--at->count], NULL), NOH_OK);
    }
}

/* A piece that fails is sent again. */
static void frame_at_random(act *a, const gpu *g, uint32_t f, test_random *r, uint32_t *failed)
{
    noh_null_report before, report;
    const int fails = test_random_below(r, 4) == 0;
    noh_null_report_of(g->context, &before);
    if (fails) noh_null_refuse(g->context, "glBufferSubData", test_random_below(r, 3), GL_OUT_OF_MEMORY);
    frame(a, f);
    *failed += noh_null_refused(g->context) && noh_stage_stats_of(a->c.stage)->coming;
    noh_null_refuse(g->context, NULL, 0, 0);
    (void)g->gl.GetError();
    assert_int_equal(noh_stage_draw(a->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    noh_null_report_of(g->context, &report);
    if (report.violations != before.violations) fail_msg("%s", report.first);
    assert_true(report.bytes == noh_gl_ledger_bytes(&a->ledger) && report.bytes <= a->c.plan.gpu_bytes);
}

static void any_order_with_a_driver_that_fails(void **state)
{
    static gpu g;
    static act a;
    test_random r = test_random_from(20261129u);
    uint32_t refused = 0, came = 0, went = 0, failed = 0;
    (void)state;
    for (uint32_t w = 0; w < TEST_COUNT(counted_ways); w++) {
        fate slots[2];
        noh_actor actors[3];
        memset(slots, 0, sizeof slots);
        counted_open(&g);
        open_act(&a, &g, counted_ways[w]);
        with_slots(&a, 2);
        a.c.desc.load_bytes = 40000;
        a.c.desc.motion = a.c.desc.user_values = w % 2u;
        assert_true(make_act(&a));
        enter(&a, PUPPETS, actors);
        for (uint32_t f = 0; f < 150; f++) {
            for (uint32_t i = 0; i < 2 && f % 3u == 0; i++) act_at_random(&a, 1u + i, &slots[i], &g, &r);
            if (f == 100) assert_int_equal(noh_stage_restore(a.c.stage, NULL), NOH_OK);
            if (f == 100) break;
            frame_at_random(&a, &g, f, &r, &failed);
        }
        for (uint32_t i = 0; i < 2; i++) {
            refused += slots[i].refused;
            came += slots[i].came;
            went += slots[i].went;
        }
        close_act(&a);
        gpu_close(&g);
    }
    print_message("# %u kinds came, %u were refused, %u went, %u pieces failed\n", (unsigned)came, (unsigned)refused,
                  (unsigned)went, (unsigned)failed);
    assert_true(refused > 10u && came > 30u && went > 20u && failed > 5u);
}

/* ---- bytes and errors ---- */

static void the_plan_has_every_byte(void **state)
{
    static gpu g;
    static act a;
    (void)state;
    for (uint32_t w = 0; w < TEST_COUNT(counted_ways); w++) {
        noh_stage_bytes parts[96];
        noh_stage *made = NULL;
        uint64_t cpu = 0, gpu_sum = 0, room = 0, taken, most = 0;
        uint32_t count;
        counted_open(&g);
        open_act(&a, &g, counted_ways[w]);
        with_slots(&a, 2);
        assert_true(make_act(&a));
        count = noh_stage_plan_parts(&a.c.desc, &g.caps, &a.c.plan, parts, TEST_COUNT(parts));
        assert_true(count <= TEST_COUNT(parts));
        for (uint32_t i = 0; i < count; i++) cpu += parts[i].cpu_bytes, gpu_sum += parts[i].gpu_bytes;
        assert_true(cpu == a.c.plan.cpu_bytes && gpu_sum == a.c.plan.gpu_bytes);
        for (uint32_t i = 1; i < CAST_KINDS; i++) room += a.c.plan.kinds[i].room.gpu_bytes;
        assert_true(room > 0 && noh_gl_ledger_bytes(&a.ledger) == a.c.plan.gpu_bytes - room);
        for (uint32_t k = 0; k < CAST_KINDS; k++) {
            put(&a, 1, &a.others[k]);
            taken = noh_gl_ledger_bytes(&a.ledger) + room - a.c.plan.gpu_bytes;
            most = taken > most ? taken : most;
            put(&a, 1, NULL);
        }
        assert_true(most == a.c.plan.kinds[1].room.gpu_bytes);
        close_act(&a);
        cast_make(&a.c, &a.device);
        cast_close_stage(&a.c);
        a.c.memory = test_aligned(NULL, (size_t)a.c.plan.cpu_bytes);
        assert_int_equal(
            noh_stage_init(a.c.memory, (size_t)a.c.plan.cpu_bytes - 1u, &a.device, &a.c.desc, &a.c.plan, &made, &said),
            NOH_ERR_MEMORY);
        assert_int_equal(said.need, a.c.plan.cpu_bytes);
        close_act(&a);
        gpu_close(&g);
    }
}

static void refuse(act *a, const noh_kind_desc *desc, noh_result result, const char *what)
{
    const noh_gl_ledger before = a->ledger;
    if (noh_stage_set_kind(a->c.stage, TUBES, desc, &said) != result) fail_msg("%d %s", said.result, said.what);
    if (!strstr(said.what, what)) fail_msg("'%s' is not about %s", said.what, what);
    assert_memory_equal(&before, &a->ledger, sizeof before);
    frame(a, 0);
    assert_int_equal(noh_stage_draw(a->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
}

/* A slot for tubes alone, with room for actors of any size. */
static void what_the_plan_does_not_have_is_refused(void **state)
{
    noh_gl_renderer *renderer;
    noh_kind_desc desc;
    uint32_t count;
    static gpu g;
    static act a;
    (void)state;
    counted_open(&g);
    open_act(&a, &g, counted_ways[0]);
    a.c.kinds[TUBES].changes = 2;
    assert_true(make_act(&a));
    desc = a.others[TUBES];
    desc.finer = desc.mesh;
    refuse(&a, &desc, NOH_ERR_UNSUPPORTED, "finer");
    a.c.stage->slots->plan.kinds[TUBES].room.mesh_count--;
    refuse(&a, &a.others[TUBES], NOH_ERR_MEMORY, "more meshes");
    a.c.stage->slots->plan.kinds[TUBES].room.mesh_count++;
    a.c.stage->slots->plan.kinds[TUBES].room.drawn_bytes -= 16;
    refuse(&a, &a.others[TUBES], NOH_ERR_MEMORY, "on the CPU");
    a.c.stage->slots->plan.kinds[TUBES].room.drawn_bytes += 16;
    a.c.stage->slots->plan.kinds[TUBES].room.gpu_bytes--;
    refuse(&a, &a.others[TUBES], NOH_ERR_MEMORY, "on the GPU");
    a.c.stage->slots->plan.kinds[TUBES].room.gpu_bytes++;
    renderer = ((noh_stage_gl *)a.c.stage->gpu)->renderer;
    count = renderer->variant_count;
    renderer->variant_count = 1;
    assert_int_equal(noh_stage_set_kind(a.c.stage, TUBES, &a.others[TUBES], &said), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(said.what, "programs"));
    renderer->variant_count = count;
    put(&a, TUBES, &a.others[TUBES]);
    close_act(&a);
    a.c.kinds[TUBES].finer = a.c.kinds[TUBES].mesh;
    assert_int_equal(noh_stage_plan_make(&a.c.desc, &g.caps, &a.c.plan, &said), NOH_ERR_UNSUPPORTED);
    a.c.kinds[TUBES].finer = NULL;
    a.c.desc.morph_path = NOH_MORPH_STREAMS;
    a.c.desc.halves = 0;
    assert_int_equal(noh_stage_plan_make(&a.c.desc, &g.caps, &a.c.plan, &said), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(said.what, "streams"));
    gpu_close(&g);
}

/* The programs of a lit stage have soft shadows where the driver has half floats; kinds of the plan need no other. */
static void planned_kinds_come_into_lit_stages(void **state)
{
    const noh_reflection_desc baked = { 32, noh_reflection_of_environment, noh_environment_at(0) };
    void *texels = test_zeros(noh_reflection_size(32)), *scratch = test_zeros(noh_reflection_scratch_size(32));
    noh_reflection reflection;
    const noh_gl_light_desc light = { &reflection, 256 };
    (void)state;
    assert_int_equal(noh_reflection_init(texels, noh_reflection_size(32), scratch, noh_reflection_scratch_size(32),
                                         &baked, &reflection, NULL),
                     NOH_OK);
    for (int half_floats = 0; half_floats < 2; half_floats++) {
        static gpu g;
        static act a;
        counted_open(&g);
        g.caps.render_f16 = half_floats;
        open_act(&a, &g, counted_ways[0]);
        a.c.desc.light = &light;
        a.c.kinds[TUBES].changes = 2;
        assert_true(make_act(&a));
        put(&a, TUBES, &a.others[TUBES]);
        close_act(&a);
        gpu_close(&g);
    }
    free(texels);
    free(scratch);
}

static int open_packs(void **state)
{
    (void)state;
    cast_open(&packs);
    return 0;
}

static int close_packs(void **state)
{
    cast_close(&packs);
    return fixture_tear_down(state);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_those_of_kinds_that_were_there),
        cmocka_unit_test(each_frame_keeps_the_bound),
        cmocka_unit_test(a_new_context_gets_each_byte_once),
        cmocka_unit_test(any_order_with_a_driver_that_fails),
        cmocka_unit_test(the_plan_has_every_byte),
        cmocka_unit_test(what_the_plan_does_not_have_is_refused),
        cmocka_unit_test(planned_kinds_come_into_lit_stages),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, open_packs, close_packs);
}
