/* Stages that share: what one pack has on the GPU is there once for all of them. On every path pictures are the same as
 * of stages that do not share; the second stage sends nothing that the first one sent; plans have every byte, in any
 * order in which stages and kinds of slots come and go, after lost contexts and with a driver that fails. */
#include "support/counted_gl.h"
#include "support/gl_fixture.h"
#include "support/stage_fixture.h"

#include "convert/pack/pack_strip.h"
#include "gl/stage/stage_gl_internal.h"
#include "gpu/canvas.h"
#include "null.h"

#define WIDTH 160u
#define HEIGHT 90u
#define PIXELS (WIDTH * HEIGHT)
#define ALL_KINDS 7u

static char shader_log[4096];
static noh_error said;

/* Opened once for all tests: the cast, but with faces that have textures in place of tubes. */
#define FACES TUBES
static cast packs;
static noh_file face_file;
static noh_pack face_pack;

typedef struct show {
    cast c; /* of `packs` */
    noh_gl_device device;
    noh_kind_desc others[CAST_KINDS];
    noh_stage_peer peers[2];
    noh_stage_peers share;
} show;

/* Kinds of a mask, three actors of each. ledger NULL: of the GPU */
static void open_show(show *s, gpu *g, noh_gl_ledger *ledger, fixture_way way, uint32_t kinds)
{
    memset(s, 0, sizeof *s);
    s->c = packs;
    s->c.desc.kinds = s->c.kinds;
    s->c.desc.kind_count = 0;
    for (uint32_t k = 0; k < CAST_KINDS; k++) {
        s->others[k] = packs.kinds[k];
        s->others[k].actor_count = 3;
        if (kinds >> k & 1u) s->c.kinds[s->c.desc.kind_count++] = s->others[k];
    }
    s->c.desc.gpu = &noh_stage_on_gl;
    s->c.desc.morph_path = (uint32_t)way.path;
    s->c.desc.halves = way.accumulate == NOH_ACCUMULATE_F16 ? 1 : -1;
    s->c.desc.without_depth = 1;
    s->device = (noh_gl_device){ &g->gl, &g->caps, ledger ? ledger : &g->ledger, shader_log, sizeof shader_log };
}

static void with_peers(show *s, const show *one, const show *other)
{
    const show *of[2] = { one, other };
    for (uint32_t i = 0; i < 2 && of[i]; i++) {
        s->peers[s->share.peer_count++] = (noh_stage_peer){ &of[i]->c.desc, &of[i]->c.plan };
    }
    s->share.peers = s->peers;
    s->c.desc.share = &s->share;
}

/* The last `count` kinds become slots for all of the cast. */
static void with_slots(show *s, uint32_t count)
{
    for (uint32_t i = 1; i <= count; i++) {
        noh_kind_desc *d = &s->c.kinds[s->c.desc.kind_count - i];
        d->changes = 2;
        d->others = s->others;
        d->other_count = CAST_KINDS;
    }
}

/* Returns 0 where this driver has no such path. */
static int make(show *s)
{
    if (noh_stage_plan_make(&s->c.desc, s->device.caps, &s->c.plan, &said)) {
        assert_int_equal(said.result, NOH_ERR_UNSUPPORTED);
        return 0;
    }
    cast_make(&s->c, &s->device);
    return 1;
}

static void end(show *s)
{
    cast_close_stage(&s->c);
}

static uint64_t bytes_of(const gpu *g)
{
    return noh_gl_ledger_bytes(&g->ledger);
}

static void expect_nothing(const noh_gl_ledger *ledger)
{
    noh_gl_ledger nothing;
    memset(&nothing, 0, sizeof nothing);
    nothing.contexts = ledger->contexts;
    assert_memory_equal(&nothing, ledger, sizeof nothing);
}

static void enter_kind(show *s, uint32_t kind, noh_actor actors[3])
{
    for (uint32_t i = 0; i < 3; i++) {
        const noh_place place = { { 1.1f * (float)i - 1.0f, 0.5f, -1.2f * (float)kind }, { 0, 0, 0, 0 }, 0.0f };
        const int speaks = s->c.kinds[kind].mesh != packs.kinds[PUPPETS].mesh;
        const noh_play play = { .start_ticks = 5000 * (int64_t)i };
        if (noh_stage_spawn(s->c.stage, kind, &place, &actors[i], &said)) fail_msg("%s", said.what);
        assert_int_equal(noh_actor_play(s->c.stage, actors[i], speaks ? 1 : 0, speaks ? "speak" : "walk", &play, &said),
                         NOH_OK);
    }
}

static void enter(show *s)
{
    noh_actor actors[3];
    for (uint32_t k = 0; k < s->c.desc.kind_count; k++) {
        if (!s->c.kinds[k].changes) enter_kind(s, k, actors);
    }
}

static void frame(show *s, uint32_t f)
{
    const noh_stage_view view = cast_view(f, 4.0f);
    if (noh_stage_frame(s->c.stage, CAST_STEP, &view, NULL, NULL, &said)) fail_msg("%s", said.what);
}

static void draw(const show *s, canvas *to, uint32_t *rgba)
{
    canvas_begin(to);
    assert_int_equal(noh_stage_draw(s->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    canvas_resolve(to);
    assert_int_equal(canvas_read(to, (uint8_t *)rgba), 0);
}

/* ---- on real drivers ---- */

/* A frame of a stage that shares, and of one that is alone with its own objects: in picture and in state the same. */
static void expect_same(show *s, show *alone, canvas *to, uint32_t f, const char *when)
{
    static uint32_t one[PIXELS], other[PIXELS];
    uint32_t count = 0, drawn = 0;
    frame(s, f), frame(alone, f);
    draw(s, to, one), draw(alone, to, other);
    for (uint32_t i = 0; i < PIXELS; i++) {
        count += one[i] != other[i];
        drawn += one[i] != one[0];
    }
    if (drawn < PIXELS / 200u || count) fail_msg("%s: %u pixels, %u differ", when, (unsigned)drawn, (unsigned)count);
    assert_true(noh_stage_hash(s->c.stage) == noh_stage_hash(alone->c.stage));
}

static void lose(gpu *g)
{
    char message[1024];
    g->platform->destroy(g->context);
    assert_int_equal(g->platform->create(NULL, &g->context, message, sizeof message), NOH_OK);
    assert_int_equal(noh_gl_api_load(&g->gl, g->platform->get_proc, g->context, NULL), NOH_OK);
}

/* A state goes from a stage that shares to one that does not, and back. */
static void swap_states(show *s, show *alone)
{
    size_t bytes;
    const void *state = noh_stage_state(s->c.stage, &bytes);
    assert_int_equal(noh_stage_set_state(alone->c.stage, state, bytes, &said), NOH_OK);
    state = noh_stage_state(alone->c.stage, &bytes);
    assert_int_equal(noh_stage_set_state(s->c.stage, state, bytes, &said), NOH_OK);
}

/* Another path with the same order of delta texels. */
static fixture_way akin(fixture_way way)
{
    way.path = way.path == NOH_MORPH_MRT      ? NOH_MORPH_PER_LAYER
               : way.path == NOH_MORPH_GATHER ? NOH_MORPH_DIRECT
                                              : way.path;
    if (way.path == NOH_MORPH_DIRECT) way.accumulate = NOH_ACCUMULATE_F32;
    return way;
}

/* A level, and its dressing room with one of its kinds. loses: the context, on the way */
static int stages_on(gpu *g, fixture_way way, int loses)
{
    static show level, room, alone[2];
    static noh_gl_ledger own;
    const uint32_t most = getenv("NOH_LONG") ? ALL_KINDS : 1u << MASKS | 1u << FACES, some = 1u << FACES;
    canvas to;
    memset(&own, 0, sizeof own);
    open_show(&level, g, NULL, way, most), open_show(&room, g, NULL, akin(way), some);
    open_show(&alone[0], g, &own, way, most), open_show(&alone[1], g, &own, akin(way), some);
    with_peers(&level, NULL, NULL), with_peers(&room, &level, NULL);
    if (!make(&level)) return 0;
    assert_true(make(&room) && make(&alone[0]) && make(&alone[1]));
    assert_true(room.c.plan.shared_bytes > 100000u && !level.c.plan.shared_bytes);
    assert_true(room.c.plan.gpu_bytes + room.c.plan.shared_bytes == alone[1].c.plan.gpu_bytes);
    assert_true(bytes_of(g) == level.c.plan.gpu_bytes + room.c.plan.gpu_bytes);
    print_message("# %-14s %8llu bytes on the GPU in two stages, %8llu where they share\n", fixture_way_name(way),
                  (unsigned long long)noh_gl_ledger_bytes(&own), (unsigned long long)bytes_of(g));
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    enter(&level), enter(&room), enter(&alone[0]), enter(&alone[1]);
    expect_same(&level, &alone[0], &to, 0, "the level");
    expect_same(&room, &alone[1], &to, 0, "the room");
    if (loses) {
        const noh_gl_ledger before = g->ledger;
        canvas_close(&to);
        lose(g);
        assert_int_equal(noh_stage_restore(room.c.stage, &said), NOH_ERR_ARG);
        assert_non_null(strstr(said.what, "contexts"));
        g->ledger.contexts++;
        assert_int_equal(noh_stage_restore(room.c.stage, &said), NOH_OK);
        assert_int_equal(noh_stage_restore(level.c.stage, &said), NOH_OK);
        assert_int_equal(noh_stage_restore(alone[0].c.stage, &said), NOH_OK);
        assert_int_equal(noh_stage_restore(alone[1].c.stage, &said), NOH_OK);
        assert_true(noh_gl_ledger_bytes(&before) == bytes_of(g) && before.buffers == g->ledger.buffers);
        assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
        expect_same(&level, &alone[0], &to, 1, "the level in a new context");
        expect_same(&room, &alone[1], &to, 1, "the room in a new context");
    }
    swap_states(&level, &alone[0]);
    end(&level);
    assert_true(bytes_of(g) == alone[1].c.plan.gpu_bytes);
    expect_same(&room, &alone[1], &to, 2, "the room after the level");
    with_peers(&level, &room, NULL);
    assert_true(make(&level));
    assert_true(bytes_of(g) == alone[1].c.plan.gpu_bytes + level.c.plan.gpu_bytes);
    assert_true(level.c.plan.shared_bytes == room.c.plan.shared_bytes);
    end(&room);
    swap_states(&alone[0], &level);
    expect_same(&level, &alone[0], &to, 2, "the next level");
    end(&level);
    expect_nothing(&g->ledger);
    end(&alone[0]), end(&alone[1]);
    canvas_close(&to);
    return 1;
}

/* By four paths, whose delta texels lie in two orders (NOH_LONG: by all). */
static void pictures_are_those_of_stages_alone(void **state)
{
    gpu *g = fixture_gpu();
    uint32_t made = 0;
    (void)state;
    for (uint32_t w = 0; w < FIXTURE_WAYS; w++) {
        const noh_morph_path path = fixture_ways[w].path;
        const int usual = (path == NOH_MORPH_MRT || path == NOH_MORPH_GATHER) &&
                          fixture_ways[w].accumulate == NOH_ACCUMULATE_F32;
        if (usual || getenv("NOH_LONG")) made += (uint32_t)stages_on(g, fixture_ways[w], path == NOH_MORPH_MRT);
    }
    assert_true(made >= 1);
    fixture_expect_no_errors();
}

/* A kind leaves its slot in one stage while another draws it by the same objects, and the other way round. */
static void slots_lend_and_borrow(void **state)
{
    const fixture_way way = { NOH_MORPH_CPU, NOH_ACCUMULATE_F32 };
    static show slots, room, alone;
    static noh_gl_ledger own;
    noh_actor actors[3];
    uint64_t before;
    gpu *g = fixture_gpu();
    canvas to;
    (void)state;
    memset(&own, 0, sizeof own);
    open_show(&slots, g, NULL, way, ALL_KINDS), open_show(&room, g, NULL, way, 1u << FACES);
    open_show(&alone, g, &own, way, 1u << FACES);
    with_slots(&slots, 2);
    slots.c.desc.load_bytes = 50000;
    with_peers(&slots, NULL, NULL), with_peers(&room, NULL, NULL);
    assert_true(make(&slots) && make(&alone));
    assert_int_equal(canvas_open(&to, g, WIDTH, HEIGHT), 0);
    before = bytes_of(g);
    assert_int_equal(noh_stage_set_kind(slots.c.stage, 1, &slots.others[FACES], &said), NOH_OK);
    frame(&slots, 0);
    assert_true(noh_stage_stats_of(slots.c.stage)->coming);
    assert_true(make(&room)); /* has its own, for the other one's are not filled */
    assert_true(bytes_of(g) >= before + 2u * room.c.plan.gpu_bytes - 100000u);
    end(&room);
    for (uint32_t f = 0; noh_stage_stats_of(slots.c.stage)->coming; f++) frame(&slots, f);
    before = bytes_of(g);
    assert_true(make(&room));
    assert_true(bytes_of(g) < before + room.c.plan.gpu_bytes - 100000u);
    enter(&room), enter(&alone);
    enter_kind(&slots, 1, actors);
    frame(&slots, 1);
    expect_same(&room, &alone, &to, 1, "a room that borrows from a slot");
    for (uint32_t i = 0; i < 3; i++) assert_int_equal(noh_stage_despawn(slots.c.stage, actors[i], &said), NOH_OK);
    assert_int_equal(noh_stage_set_kind(slots.c.stage, 1, NULL, &said), NOH_OK);
    expect_same(&room, &alone, &to, 2, "the kind left its slot");
    before = bytes_of(g);
    assert_int_equal(noh_stage_set_kind(slots.c.stage, 2, &slots.others[FACES], &said), NOH_OK);
    frame(&slots, 2);
    assert_int_equal(noh_stage_stats_of(slots.c.stage)->load_bytes, 0); /* all is there */
    frame(&slots, 3);
    assert_int_equal(noh_stage_stats_of(slots.c.stage)->coming, 0);
    assert_true(bytes_of(g) < before + room.c.plan.gpu_bytes - 100000u);
    end(&room);
    end(&alone);
    frame(&slots, 4);
    end(&slots);
    expect_nothing(&g->ledger);
    canvas_close(&to);
    fixture_expect_no_errors();
}

/* ---- on the driver that counts ---- */

static void GL_APIENTRY count_contents(GLenum target, GLsizeiptr bytes, const void *data, GLenum usage)
{
    counted.bytes += data ? (uint64_t)bytes : 0;
    counted.real.BufferData(target, bytes, data, usage);
}

/* Besides a few numbers that each stage has for itself, the second stage sends nothing; and each byte of what it shares
 * was sent once. */
static void the_second_stage_sends_nothing(void **state)
{
    static gpu g;
    static show level, room;
    (void)state;
    for (uint32_t w = 0; w < TEST_COUNT(counted_ways); w++) {
        uint64_t first, second;
        counted_open(&g);
        g.gl.BufferData = count_contents;
        open_show(&level, &g, NULL, counted_ways[w], ALL_KINDS), open_show(&room, &g, NULL, counted_ways[w], ALL_KINDS);
        with_peers(&level, NULL, NULL), with_peers(&room, &level, NULL);
        assert_true(make(&level));
        first = counted.bytes;
        assert_true(make(&room));
        second = counted.bytes - first;
        if (second > first / 20u || first - second > room.c.plan.shared_bytes) {
            fail_msg("%s: %llu bytes, then %llu", fixture_way_name(counted_ways[w]), (unsigned long long)first,
                     (unsigned long long)second);
        }
        counted.bytes = 0;
        g.ledger.contexts++;
        assert_int_equal(noh_stage_restore(level.c.stage, &said), NOH_OK);
        assert_int_equal(noh_stage_restore(room.c.stage, &said), NOH_OK);
        assert_true(counted.bytes == first + second);
        end(&level), end(&room);
        expect_nothing(&g.ledger);
        gpu_close(&g);
    }
}

/* In a new context kinds of slots share with each other, and with kinds that stay, after these in the desc: what is
 * there is sent once, and no texture stays empty. */
static void restored_slots_send_all_once(void **state)
{
    static gpu g;
    static show s;
    (void)state;
    for (uint32_t slots = 1; slots <= 2; slots++) {
        noh_actor actors[3];
        noh_gl_ledger before;
        uint64_t sent;
        counted_open(&g);
        g.gl.BufferData = count_contents;
        open_show(&s, &g, NULL, counted_ways[3], 1u << MASKS | 1u << FACES);
        s.c.kinds[0] = s.others[FACES];
        for (uint32_t i = 0; i < slots; i++) s.c.kinds[i].changes = 1;
        with_peers(&s, NULL, NULL);
        assert_true(make(&s));
        sent = counted.bytes;
        enter_kind(&s, 0, actors), enter_kind(&s, 1, actors);
        frame(&s, 0);
        before = g.ledger;
        counted.bytes = 0;
        g.ledger.contexts++;
        assert_int_equal(noh_stage_restore(s.c.stage, &said), NOH_OK);
        if (counted.bytes != sent || before.textures != g.ledger.textures ||
            bytes_of(&g) != noh_gl_ledger_bytes(&before))
            fail_msg("%u slots: %u textures, %llu bytes, then %u, %llu", (unsigned)slots, (unsigned)before.textures,
                     (unsigned long long)sent, (unsigned)g.ledger.textures, (unsigned long long)counted.bytes);
        frame(&s, 1);
        end(&s);
        expect_nothing(&g.ledger);
        gpu_close(&g);
    }
}

/* Every part of a plan, with peers that have all of it, some, or none. */
static void plans_have_every_byte(void **state)
{
    static const uint32_t casts[][3] = {
        { ALL_KINDS, ALL_KINDS, 0 }, { 1, 6, 7 }, { 2, 4, 7 }, { 1, 2, 4 }, { 3, 5, 2 }
    };
    static gpu g;
    static show s[3];
    (void)state;
    counted_open(&g);
    for (uint32_t i = 0; i < TEST_COUNT(casts) * TEST_COUNT(counted_ways); i++) {
        const fixture_way way = counted_ways[i % TEST_COUNT(counted_ways)];
        const uint32_t *kinds = casts[i / TEST_COUNT(counted_ways)];
        uint64_t sum = 0;
        for (uint32_t n = 0; n < 3; n++) {
            noh_stage_bytes parts[96];
            uint64_t listed = 0;
            open_show(&s[n], &g, NULL, way, kinds[n] ? kinds[n] : ALL_KINDS);
            if (!kinds[n]) s[n].c.kinds[MASKS].finest_level = 1; /* other objects */
            s[n].c.desc.without_shader = 1;
            with_peers(&s[n], n > 0 ? &s[0] : NULL, n > 1 ? &s[1] : NULL);
            assert_true(make(&s[n]));
            sum += s[n].c.plan.gpu_bytes;
            assert_true(bytes_of(&g) == sum);
            const uint32_t count = noh_stage_plan_parts(&s[n].c.desc, &g.caps, &s[n].c.plan, parts, TEST_COUNT(parts));
            for (uint32_t p = 0; p < count; p++) listed += parts[p].gpu_bytes;
            assert_true(listed == s[n].c.plan.gpu_bytes);
        }
        for (uint32_t n = 0; n < 3; n++) end(&s[(n + i) % 3u]);
        expect_nothing(&g.ledger);
    }
    gpu_close(&g);
}

/* Each stage has its own meshes where finer levels are loaded later: one stage loads its levels and drops them while
 * the other one waits, is drawn and ends. */
static void levels_that_are_loaded_later_are_not_shared(void **state)
{
    static gpu g;
    static show level, room;
    noh_pack coarse, finer = packs.packs[MASKS];
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error;
    uint32_t first[64], frames = 0;
    noh_null_report report;
    uint8_t *bytes;
    (void)state;
    for (uint32_t i = 0; i < TEST_COUNT(first); i++) first[i] = 2;
    assert_true(finer.runs[NOH_CHUNK_MESH].count <= TEST_COUNT(first));
    if (pack_strip(&finer, first, &out, &error)) fail_msg("%s", error.what);
    bytes = test_aligned(out.bytes, out.count);
    coarse = test_open(bytes, out.count);
    buffer_free(&out);
    counted_open(&g);
    open_show(&level, &g, NULL, counted_ways[0], 1u << MASKS), open_show(&room, &g, NULL, counted_ways[0], 1u << MASKS);
    level.c.kinds[0].mesh = room.c.kinds[0].mesh = &coarse;
    level.c.kinds[0].finer = room.c.kinds[0].finer = &finer;
    with_peers(&level, NULL, NULL), with_peers(&room, &level, NULL);
    assert_true(make(&level) && make(&room));
    assert_int_equal(room.c.plan.shared_bytes, 0);
    assert_true(bytes_of(&g) == level.c.plan.gpu_bytes + room.c.plan.gpu_bytes);
    assert_int_equal(noh_stage_load_level(level.c.stage, 0, &finer, &said), NOH_OK);
    do {
        frame(&level, frames), frame(&room, frames);
        assert_true(noh_stage_draw(room.c.stage, NOH_PASS_COLOR, 0, NULL, NULL) == NOH_OK && frames++ < 200u);
    } while (noh_stage_stats_of(level.c.stage)->loading);
    end(&room);
    assert_int_equal(noh_stage_load_level(level.c.stage, 0, NULL, &said), NOH_OK);
    frame(&level, frames);
    assert_int_equal(noh_stage_draw(level.c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    noh_null_report_of(g.context, &report);
    assert_true(frames > 1u && report.bytes == level.c.plan.gpu_bytes && !report.violations);
    end(&level);
    expect_nothing(&g.ledger);
    gpu_close(&g);
    free(bytes);
}

/* ---- a driver that fails ---- */

static const char *const functions[] = {
    "glGenBuffers",   "glBufferData",    "glGenVertexArrays", "glGenTextures",
    "glTexStorage2D", "glTexStorage3D",  "glTexSubImage2D",   "glGenFramebuffers",
    "glCreateShader", "glCompileShader", "glCreateProgram",   "glLinkProgram",
    "glBindBuffer",   "glBufferSubData", "glBindTexture",     "glFramebufferTextureLayer",
    "glUseProgram",   "glTexParameteri"
};

/* Make `room` while the level is there, calls 0, 1, 3, 7 and so on of each function refused. Returns how often it
 * failed. */
static uint32_t refuse_each(gpu *g, show *level, show *room)
{
    uint32_t refused = 0;
    for (uint32_t f = 0; f < TEST_COUNT(functions); f++) {
        for (uint32_t k = 0;; k = 2u * k + 1u) {
            const noh_gl_ledger before = g->ledger;
            noh_null_report was, is;
            noh_stage *made = NULL;
            noh_result result;
            noh_null_report_of(g->context, &was);
            said.what = NULL;
            noh_null_refuse(g->context, functions[f], k, GL_OUT_OF_MEMORY);
            result = noh_stage_init(room->c.memory, (size_t)room->c.plan.cpu_bytes, &room->device, &room->c.desc,
                                    &room->c.plan, &made, &said);
            if (!noh_null_refused(g->context)) {
                assert_int_equal(result, NOH_OK);
                if (made) noh_stage_delete(made);
                noh_null_refuse(g->context, NULL, 0, 0);
                break;
            }
            noh_null_refuse(g->context, NULL, 0, 0);
            if (!result || !said.what) fail_msg("%s %u: no error", functions[f], (unsigned)k);
            noh_null_report_of(g->context, &is);
            assert_memory_equal(was.live, is.live, sizeof was.live);
            assert_memory_equal(&before, &g->ledger, sizeof before);
            refused++;
        }
        frame(level, f);
        assert_int_equal(noh_stage_draw(level->c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    }
    return refused;
}

static void a_stage_that_fails_leaves_the_others_what_they_have(void **state)
{
    static gpu g;
    static show level, room;
    uint32_t refused = 0;
    (void)state;
    for (uint32_t w = 0; w < 2; w++) {
        counted_open(&g);
        open_show(&level, &g, NULL, counted_ways[w], ALL_KINDS), open_show(&room, &g, NULL, counted_ways[w], 6);
        with_peers(&level, NULL, NULL), with_peers(&room, NULL, NULL);
        assert_true(make(&level) && make(&room));
        noh_stage_delete(room.c.stage);
        room.c.stage = NULL;
        enter(&level);
        refused += refuse_each(&g, &level, &room);
        end(&room), end(&level);
        expect_nothing(&g.ledger);
        gpu_close(&g);
    }
    print_message("# %u stages were refused\n", (unsigned)refused);
    assert_true(refused > 60u);
}

/* A restore that failed may be tried again; until it succeeds the stage has nothing, and the others what they had. */
static void a_restore_that_fails_is_tried_again(void **state)
{
    static gpu g;
    static show level, room;
    noh_null_report report;
    uint64_t both, one;
    uint32_t violations;
    (void)state;
    counted_open(&g);
    open_show(&level, &g, NULL, counted_ways[1], ALL_KINDS), open_show(&room, &g, NULL, counted_ways[1], 6);
    with_peers(&level, NULL, NULL), with_peers(&room, NULL, NULL);
    assert_true(make(&level));
    one = bytes_of(&g);
    assert_true(make(&room));
    both = bytes_of(&g);
    enter(&level), enter(&room);
    for (uint32_t round = 0; round < 3; round++) {
        lose(&g);
        g.ledger.contexts++;
        if (round) assert_int_equal(noh_stage_restore(level.c.stage, &said), NOH_OK);
        for (uint32_t f = 0; f < 6; f++) {
            noh_null_refuse(g.context, functions[f], 0, GL_OUT_OF_MEMORY);
            said.what = NULL;
            assert_true(noh_stage_restore(room.c.stage, &said) != NOH_OK && said.what);
            assert_true(noh_null_refused(g.context));
            noh_null_refuse(g.context, NULL, 0, 0);
            noh_null_report_of(g.context, &report);
            assert_true(bytes_of(&g) == one && report.bytes == (round ? one : 0));
        }
        violations = report.violations; /* refused names were used */
        assert_int_equal(noh_stage_restore(room.c.stage, &said), NOH_OK);
        if (!round) assert_int_equal(noh_stage_restore(level.c.stage, &said), NOH_OK);
        noh_null_report_of(g.context, &report);
        assert_true(bytes_of(&g) == both && report.bytes == both && report.violations == violations);
        frame(&level, round), frame(&room, round);
        assert_int_equal(noh_stage_draw(room.c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    }
    end(&level), end(&room);
    expect_nothing(&g.ledger);
    gpu_close(&g);
}

/* ---- any order ---- */

#define SHOWS 4u

static void act(show *s, test_random *r, uint32_t *kind_of, gpu *g)
{
    const uint32_t slot = s->c.desc.kind_count - 1u;
    if (!s->c.stage) {
        open_show(s, g, NULL, counted_ways[test_random_below(r, 2)], 1u + test_random_below(r, 7));
        s->c.kinds[0].finest_level = test_random_below(r, 2);
        s->c.desc.load_bytes = 30000;
        if (test_random_below(r, 2) && s->c.desc.kind_count > 1u) with_slots(s, 1);
        if (test_random_below(r, 4)) with_peers(s, NULL, NULL);
        assert_true(make(s));
        enter(s);
        *kind_of = 0;
    } else if (test_random_below(r, 8) == 0) {
        end(s);
    } else if (s->c.kinds[slot].changes && test_random_below(r, 3) == 0) {
        const uint32_t kind = test_random_below(r, CAST_KINDS);
        if (*kind_of) assert_int_equal(noh_stage_set_kind(s->c.stage, slot, NULL, &said), NOH_OK);
        if (*kind_of || noh_stage_set_kind(s->c.stage, slot, &s->others[kind], &said)) {
            *kind_of = 0; /* it went, or its programs are not there */
        } else {
            *kind_of = 1;
        }
    }
}

static void stages_and_kinds_come_and_go_in_any_order(void **state)
{
    static gpu g;
    static show s[SHOWS];
    uint32_t kind_of[SHOWS] = { 0 }, lost = 0, drawn = 0;
    test_random r = test_random_from(20261130u);
    noh_null_report report;
    (void)state;
    counted_open(&g);
    memset(s, 0, sizeof s);
    for (uint32_t f = 0; f < 240; f++) {
        const uint32_t which = test_random_below(&r, SHOWS);
        act(&s[which], &r, &kind_of[which], &g);
        if (f % 60u == 59u) {
            lose(&g);
            g.ledger.contexts++;
            lost++;
        }
        for (uint32_t i = 0; i < SHOWS; i++) {
            const uint32_t n = (i + f) % SHOWS;
            if (!s[n].c.stage) continue;
            if (f % 60u == 59u) assert_int_equal(noh_stage_restore(s[n].c.stage, &said), NOH_OK);
            if (n != which) continue;
            frame(&s[n], f);
            assert_int_equal(noh_stage_draw(s[n].c.stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
            drawn++;
        }
        noh_null_report_of(g.context, &report);
        if (report.violations) fail_msg("%u: %s", (unsigned)f, report.first);
        assert_true(report.bytes == bytes_of(&g));
    }
    for (uint32_t i = 0; i < SHOWS; i++) end(&s[i]);
    expect_nothing(&g.ledger);
    noh_null_report_of(g.context, &report);
    assert_true(report.bytes == 0 && lost == 4u && drawn > 100u);
    gpu_close(&g);
}

static void wrong_peers_have_a_message(void **state)
{
    static gpu g;
    static show level, room;
    (void)state;
    counted_open(&g);
    for (uint32_t i = 0; i < 5; i++) {
        open_show(&level, &g, NULL, counted_ways[0], 3), open_show(&room, &g, NULL, counted_ways[0], 3);
        with_peers(&level, NULL, NULL);
        assert_int_equal(noh_stage_plan_make(&level.c.desc, &g.caps, &level.c.plan, &said), NOH_OK);
        with_peers(&room, &level, &level);
        if (i == 0) room.share.peers = NULL;
        if (i == 1) room.peers[1].desc = NULL;
        if (i == 2) room.peers[1].plan = NULL;
        if (i == 3) level.c.desc.share = NULL;
        if (i == 4) level.c.desc.gpu = NULL;
        assert_int_equal(noh_stage_plan_make(&room.c.desc, &g.caps, &room.c.plan, &said), NOH_ERR_ARG);
        assert_non_null(strstr(said.what, "peer"));
        assert_int_equal(said.where, i == 1 || i == 2 ? 1 : 0);
    }
    gpu_close(&g);
}

static int open_packs(void **state)
{
    (void)state;
    const char *build = getenv("NOH_BUILD");
    char path[1024];
    snprintf(path, sizeof path, "%s/mask.noh", build ? build : "build");
    if (noh_file_map(path, &face_file, &said)) fail_msg("%s: %s", path, said.what);
    cast_open(&packs);
    face_pack = test_open(face_file.data, face_file.bytes);
    packs.kinds[FACES].mesh = &face_pack;
    return 0;
}

static int close_packs(void **state)
{
    cast_close(&packs);
    noh_file_unmap(&face_file);
    return fixture_tear_down(state);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_those_of_stages_alone),
        cmocka_unit_test(slots_lend_and_borrow),
        cmocka_unit_test(the_second_stage_sends_nothing),
        cmocka_unit_test(restored_slots_send_all_once),
        cmocka_unit_test(plans_have_every_byte),
        cmocka_unit_test(levels_that_are_loaded_later_are_not_shared),
        cmocka_unit_test(a_stage_that_fails_leaves_the_others_what_they_have),
        cmocka_unit_test(a_restore_that_fails_is_tried_again),
        cmocka_unit_test(stages_and_kinds_come_and_go_in_any_order),
        cmocka_unit_test(wrong_peers_have_a_message),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, open_packs, close_packs);
}
