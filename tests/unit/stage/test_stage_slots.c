/* Kinds that come into a running stage and go: what they show has the bits of kinds that were there from the start,
 * what runs goes on with the same bits, nothing is written outside of the block, and a state knows which kinds it is
 * of. */
#include "support/stage_fixture.h"

#include "stage/cast/stage_internal.h"

#define SLOTS 2u      /* kinds 1 and 2; kind 0 stays */
#define CANDIDATES 5u /* that a slot was planned for */
#define PLAYERS 3u    /* actors of kind 0 */

static noh_error said;

typedef struct show {
    cast c;
    noh_kind_desc candidates[CANDIDATES];
} show;

static const noh_kind_ragdoll dolls = { .count = 2 };
static const noh_kind_face alive = { .face = { .eyes = { { 0.035f, 1.55f, 0.11f }, { -0.035f, 1.55f, 0.11f } } } };

/* Opened once for all tests. */
static cast packs;
static noh_file coat;
static noh_pack coat_pack;

/* Masks that speak, tubes without clips, puppets with springs, coats with springs, puppets with all other modules. */
static void open_show(show *w)
{
    w->c = packs;
    w->c.desc.kinds = w->c.kinds;
    memset(w->candidates, 0, sizeof w->candidates);
    w->candidates[0] = w->c.kinds[MASKS];
    w->candidates[1] = w->c.kinds[TUBES];
    w->candidates[2] = w->c.kinds[PUPPETS];
    w->candidates[2].springs = noh_springs_module(NULL);
    w->candidates[2].inertia = 1;
    w->candidates[2].actor_count = 2;
    w->candidates[3].mesh = &coat_pack;
    w->candidates[3].actor_count = PLAYERS;
    w->candidates[3].worn_by = 1u << PUPPETS;
    w->candidates[3].springs = noh_springs_module(NULL);
    w->candidates[4] = w->candidates[2];
    w->candidates[4].graphs = noh_graph_module("moves");
    w->candidates[4].ragdoll = noh_ragdoll_module(&dolls);
    w->candidates[4].face = noh_face_module(&alive);
    w->c.kinds[0].actor_count = PLAYERS;
    w->c.desc.job_count = 3;
}

/* Slots that are empty at first, for each of the candidates. */
static void make_slots(show *w)
{
    for (uint32_t i = 1; i <= SLOTS; i++) {
        w->c.kinds[i] = w->candidates[0];
        w->c.kinds[i].changes = 2;
        w->c.kinds[i].others = w->candidates + 1;
        w->c.kinds[i].other_count = CANDIDATES - 1u;
    }
    cast_make(&w->c, NULL);
}

static void close_show(show *w)
{
    cast_close_stage(&w->c);
}

static void put(noh_stage *s, uint32_t kind, const noh_kind_desc *desc)
{
    if (noh_stage_set_kind(s, kind, desc, &said) != NOH_OK) fail_msg("%s", said.what);
}

static noh_actor enter(noh_stage *s, uint32_t kind, uint32_t number, const char *clip)
{
    const noh_place place = { { 1.1f * (float)number - 2.0f, 0.0f, -1.5f * (float)kind }, { 0, 0, 0, 0 }, 0.0f };
    noh_actor actor;
    if (noh_stage_spawn(s, kind, &place, &actor, &said) != NOH_OK) fail_msg("%s", said.what);
    if (clip) assert_int_equal(noh_actor_play(s, actor, clip[0] == 's' ? 1 : 0, clip, NULL, &said), NOH_OK);
    return actor;
}

static void frame(noh_stage *s, uint32_t number)
{
    const noh_stage_view view = cast_view(number, 5.0f + 0.2f * (float)number);
    if (noh_stage_frame(s, CAST_STEP, &view, NULL, NULL, &said) != NOH_OK) fail_msg("%s", said.what);
}

/* What an actor shows: its joints and floats. */
static void expect_same_shown(const noh_stage *a, noh_actor actor_a, const noh_stage *b, noh_actor actor_b)
{
    noh_stage_kind *ka = NULL, *kb = NULL;
    const noh_stage_actor *of_a = noh_stage_actor_of(a, actor_a, &ka), *of_b = noh_stage_actor_of(b, actor_b, &kb);
    float ma[12], mb[12];
    assert_true(of_a && of_b);
    assert_int_equal(ka->skeleton.joint_count, kb->skeleton.joint_count);
    assert_int_equal(ka->float_count, kb->float_count);
    for (uint32_t j = 0; j < ka->skeleton.joint_count; j++) {
        const noh_result result = noh_actor_joint(a, actor_a, j, ma, NULL);
        assert_int_equal(noh_actor_joint(b, actor_b, j, mb, NULL), result);
        if (result == NOH_OK) assert_memory_equal(ma, mb, sizeof ma);
    }
    assert_memory_equal(noh_actor_floats(a, actor_a), noh_actor_floats(b, actor_b), ka->float_count * sizeof(float));
}

static const char *const clip_of[CANDIDATES] = { "speak", NULL, "dance", NULL, "bow" };

/* Of each candidate: a stage that had it at init, and one without slots. */
static void a_kind_that_comes_equals_one_that_was_there(void **state)
{
    (void)state;
    for (uint32_t which = 0; which < CANDIDATES; which++) {
        show late, early, plain;
        noh_stage *s[3];
        noh_actor last[3] = { { 0 }, { 0 }, { 0 } }, first[3];
        open_show(&late), open_show(&early), open_show(&plain);
        make_slots(&late);
        early.c.kinds[1] = early.candidates[which];
        early.c.kinds[1].changes = 1;
        early.c.kinds[1].others = early.candidates;
        early.c.kinds[1].other_count = CANDIDATES;
        early.c.kinds[2] = early.candidates[0];
        early.c.kinds[2].changes = 2;
        early.c.kinds[2].others = early.candidates + 1;
        early.c.kinds[2].other_count = CANDIDATES - 1u;
        cast_make(&early.c, NULL);
        plain.c.kinds[1] = plain.candidates[which];
        plain.c.desc.kind_count = 2;
        cast_make(&plain.c, NULL);
        s[0] = late.c.stage, s[1] = early.c.stage, s[2] = plain.c.stage;
        assert_int_equal(late.c.plan.cpu_bytes, early.c.plan.cpu_bytes);
        for (uint32_t i = 0; i < 3; i++) {
            first[i] = enter(s[i], 0, 0, "walk");
            for (uint32_t f = 0; f < 12; f++) frame(s[i], f);
            if (i == 0) put(s[0], 1, &late.candidates[which]);
            for (uint32_t n = 0; n < 2; n++) last[i] = enter(s[i], 1, n, clip_of[which]);
            if (which == 3) assert_int_equal(noh_actor_wear(s[i], last[i], first[i], &said), NOH_OK);
            if (which == 4) assert_int_equal(noh_actor_play_graph(s[i], last[i], 0, "moves", NULL, &said), NOH_OK);
            if (which == 4) assert_int_equal(noh_actor_fall(s[i], last[i], &said), NOH_OK);
        }
        for (uint32_t f = 12; f < 40; f++) {
            for (uint32_t i = 0; i < 3; i++) frame(s[i], f);
            assert_true(noh_stage_hash(s[0]) == noh_stage_hash(s[1]));
            expect_same_shown(s[0], last[0], s[2], last[2]);
            expect_same_shown(s[0], first[0], s[2], first[2]);
        }
        assert_true(noh_stage_stats_of(s[0])->seen >= 2u);
        close_show(&late), close_show(&early), close_show(&plain);
    }
}

/* ---- any order ---- */

typedef struct slot {
    uint32_t holds; /* 1 + candidate; 0: nothing */
    noh_actor actors[16];
    uint32_t count;
} slot;

static void empty_slot(noh_stage *s, uint32_t kind, slot *at)
{
    for (uint32_t i = 0; i < at->count; i++) {
        assert_int_equal(noh_stage_set_kind(s, kind, NULL, &said), NOH_ERR_ARG);
        assert_int_equal(said.need, at->count - i);
        assert_int_equal(noh_stage_despawn(s, at->actors[i], &said), NOH_OK);
    }
    put(s, kind, NULL);
    for (uint32_t i = 0; i < at->count; i++) { /* they are gone for good */
        assert_int_equal(noh_stage_despawn(s, at->actors[i], NULL), NOH_ERR_NOT_FOUND);
    }
    at->count = at->holds = 0;
}

static void act(show *w, noh_stage *s, uint32_t kind, slot *at, test_random *r)
{
    const uint32_t what = test_random_below(r, 8);
    if (!at->holds) {
        const uint32_t which = test_random_below(r, CANDIDATES);
        noh_actor nobody;
        assert_int_equal(noh_stage_spawn(s, kind, NULL, &nobody, &said), NOH_ERR_ARG);
        assert_non_null(strstr(said.what, "empty"));
        put(s, kind, &w->candidates[which]);
        at->holds = 1u + which;
    } else if (what == 0) {
        empty_slot(s, kind, at);
    } else if (what < 5u && at->count < w->candidates[at->holds - 1u].actor_count) {
        at->actors[at->count] = enter(s, kind, at->count, clip_of[at->holds - 1u]);
        at->count++;
    } else if (at->count) {
        assert_int_equal(noh_stage_despawn(s, at->actors[--at->count], &said), NOH_OK);
    }
}

/* A new stage with the same kinds in its slots takes the state, and has the bits of this one from then on. */
static void expect_fork(show *w, noh_stage *s, const slot *slots)
{
    const noh_stage_desc *desc = &w->c.desc;
    void *memory = test_aligned(NULL, (size_t)w->c.plan.cpu_bytes);
    noh_stage *fork;
    size_t bytes;
    const void *state = noh_stage_state(s, &bytes);
    void *copy = test_aligned(state, bytes);
    assert_int_equal(noh_stage_init(memory, (size_t)w->c.plan.cpu_bytes, NULL, desc, &w->c.plan, &fork, &said), NOH_OK);
    if (slots[0].holds || slots[1].holds) {
        assert_int_equal(noh_stage_set_state(fork, copy, bytes, &said), NOH_ERR_DATA);
        assert_non_null(strstr(said.what, "slots"));
    }
    for (uint32_t i = 0; i < SLOTS; i++) {
        if (slots[i].holds) put(fork, 1u + i, &w->candidates[slots[i].holds - 1u]);
    }
    if (noh_stage_set_state(fork, copy, bytes, &said) != NOH_OK) fail_msg("%s", said.what);
    for (uint32_t f = 0; f < 4; f++) {
        frame(s, f);
        frame(fork, f);
        assert_true(noh_stage_hash(fork) == noh_stage_hash(s));
    }
    noh_stage_delete(fork);
    free(copy);
    free(memory);
}

/* Whatever comes and goes, kind 0 shows what it shows on a stage of its own, and each state can be restored. */
static void any_order_leaves_what_runs_alone(void **state)
{
    test_random r = test_random_from(20261129u);
    slot slots[SLOTS];
    uint32_t filled = 0, emptied = 0;
    show w, quiet;
    noh_actor actors[PLAYERS], alone[PLAYERS];
    (void)state;
    memset(slots, 0, sizeof slots);
    open_show(&w), open_show(&quiet);
    make_slots(&w);
    quiet.c.desc.kind_count = 1;
    cast_make(&quiet.c, NULL);
    for (uint32_t i = 0; i < PLAYERS; i++) {
        actors[i] = enter(w.c.stage, 0, i, i ? "walk" : "dance");
        alone[i] = enter(quiet.c.stage, 0, i, i ? "walk" : "dance");
    }
    for (uint32_t round = 0; round < 80; round++) {
        for (uint32_t i = 0; i < SLOTS; i++) {
            const uint32_t before = slots[i].holds;
            act(&w, w.c.stage, 1u + i, &slots[i], &r);
            filled += !before && slots[i].holds;
            emptied += before && !slots[i].holds;
        }
        frame(w.c.stage, round % 40u);
        frame(quiet.c.stage, round % 40u);
        for (uint32_t i = 0; i < PLAYERS; i++) expect_same_shown(w.c.stage, actors[i], quiet.c.stage, alone[i]);
        if (round % 25u == 24u) {
            expect_fork(&w, w.c.stage, slots);
            for (uint32_t f = 0; f < 4; f++) frame(quiet.c.stage, f);
        }
    }
    assert_true(filled > 8u && emptied > 8u);
    close_show(&w), close_show(&quiet);
}

/* ---- bytes and errors ---- */

static void the_plan_has_every_byte(void **state)
{
    noh_stage_bytes parts[64];
    uint64_t sum = 0;
    uint32_t count;
    noh_stage *made = NULL;
    show w;
    (void)state;
    open_show(&w);
    make_slots(&w);
    count = noh_stage_plan_parts(&w.c.desc, NULL, &w.c.plan, parts, TEST_COUNT(parts));
    assert_true(count <= TEST_COUNT(parts));
    for (uint32_t i = 0; i < count; i++) sum += parts[i].cpu_bytes;
    assert_int_equal(sum, w.c.plan.cpu_bytes);
    assert_int_equal(
        noh_stage_init(w.c.memory, (size_t)w.c.plan.cpu_bytes - 1u, NULL, &w.c.desc, &w.c.plan, &made, &said),
        NOH_ERR_MEMORY);
    assert_int_equal(said.need, w.c.plan.cpu_bytes);
    close_show(&w);
}

static void refuse(noh_stage *s, uint32_t kind, const noh_kind_desc *desc, noh_result result, const char *what)
{
    const uint64_t before = noh_stage_hash(s);
    if (noh_stage_set_kind(s, kind, desc, &said) != result) fail_msg("not refused: %s", what);
    if (!strstr(said.what, what)) fail_msg("'%s' is not about %s", said.what, what);
    assert_true(noh_stage_hash(s) == before);
}

/* A slot that was planned for a mask alone. Its room is the mask's to the byte. */
static void what_does_not_fit_is_refused(void **state)
{
    static const noh_layer_desc layer = { .name = "body", .joints = "no_such_joint" };
    noh_kind_desc desc;
    noh_stage *s;
    show w;
    (void)state;
    open_show(&w);
    w.c.kinds[1] = w.candidates[0];
    w.c.kinds[1].changes = 2;
    w.c.desc.kind_count = 2;
    cast_make(&w.c, NULL);
    s = w.c.stage;
    refuse(s, 0, &w.candidates[0], NOH_ERR_ARG, "no slot");
    refuse(s, 2, &w.candidates[0], NOH_ERR_ARG, "no slot");
    refuse(s, 1, &w.candidates[1], NOH_ERR_MEMORY, "more actors");
    assert_int_equal(said.need, cast_counts[TUBES]);
    assert_int_equal(said.where, cast_counts[MASKS]);
    refuse(s, 1, &w.candidates[2], NOH_ERR_MEMORY, "more joints");
    desc = w.candidates[0];
    desc.finer = desc.mesh; /* not shown without a GPU, so that a server takes the same descs */
    put(s, 1, &desc);
    put(s, 1, NULL);
    desc = w.candidates[0];
    desc.inertia = 1;
    refuse(s, 1, &desc, NOH_ERR_MEMORY, "bytes of state");
    assert_true(said.need > said.where && said.where == w.c.plan.kinds[1].room.state_bytes);
    desc = w.candidates[0];
    desc.mesh = NULL; /* as init says */
    refuse(s, 1, &desc, NOH_ERR_ARG, "mesh of a kind is NULL");
    desc = w.candidates[0];
    desc.layer_count = 17;
    refuse(s, 1, &desc, NOH_ERR_ARG, "layer_count of a kind");
    desc.layers = &layer;
    desc.layer_count = 1;
    refuse(s, 1, &desc, NOH_ERR_NOT_FOUND, "joints of a layer"); /* found once the kind is half made */
    assert_null(noh_stage_name(s, 1, NOH_NAME_LAYER, 0));
    put(s, 1, &w.candidates[0]);
    refuse(s, 1, &w.candidates[0], NOH_ERR_ARG, "holds a kind");
    (void)enter(s, 1, 0, "speak");
    refuse(s, 1, NULL, NOH_ERR_ARG, "actors of the kind");
    assert_int_equal(noh_stage_frame_begin(s, NULL, 0, NULL), NOH_OK);
    refuse(s, 1, NULL, NOH_ERR_ARG, "during a step or a frame");
    assert_int_equal(noh_stage_frame_end(s, NULL), NOH_OK);
    close_show(&w);
}

/* As init says: what wears garments is not worn itself. */
static void garments_are_not_worn_by_garments(void **state)
{
    noh_kind_desc desc;
    show w;
    (void)state;
    open_show(&w);
    w.c.kinds[0].worn_by = 1u << 1;
    w.c.kinds[1] = w.c.kinds[2] = w.candidates[0];
    w.c.kinds[1].changes = 2;
    w.c.desc.kind_count = 3;
    cast_make(&w.c, NULL);
    desc = w.candidates[0];
    desc.worn_by = 1u << 2;
    refuse(w.c.stage, 1, &desc, NOH_ERR_ARG, "clear one of both");
    put(w.c.stage, 1, &w.candidates[0]);
    close_show(&w);
}

static void fields_of_slots_are_checked(void **state)
{
    show w;
    (void)state;
    open_show(&w);
    w.c.desc.kind_count = 2;
    w.c.kinds[1].changes = 3;
    assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_ERR_ARG);
    assert_int_equal(said.where, 1);
    w.c.kinds[1].changes = 1;
    w.c.kinds[1].other_count = 1;
    assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_ERR_ARG);
    w.c.kinds[1].others = w.candidates;
    w.candidates[0].actor_count = 0;
    assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "actor_count"));
    w.candidates[0].actor_count = 40000; /* of a slot the most count */
    w.c.kinds[0].actor_count = 40000;
    assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_ERR_LIMIT);
    close_show(&w);
}

/* A byte of the stage's state that nothing uses: a state with another value there is refused. */
static void expect_unused(noh_stage *s, const void *at)
{
    size_t bytes;
    uint8_t *copy = test_aligned(noh_stage_state(s, &bytes), s->state_bytes);
    const uint64_t before = noh_stage_hash(s);
    copy[(const uint8_t *)at - s->state] = 1;
    assert_int_equal(noh_stage_set_state(s, copy, bytes, &said), NOH_ERR_DATA);
    assert_true(noh_stage_hash(s) == before);
    copy[(const uint8_t *)at - s->state] = 0;
    assert_int_equal(noh_stage_set_state(s, copy, bytes, &said), NOH_OK);
    free(copy);
}

/* So the state of a stage has one hash: a kind that comes or goes clears nothing that a state brought. */
static void bytes_that_nothing_uses_are_refused(void **state)
{
    const noh_stage_kind *k;
    size_t held;
    show w;
    (void)state;
    open_show(&w);
    make_slots(&w);
    noh_stage *s = w.c.stage;
    const noh_stage_slot *lies = &s->slots->of[1];
    const size_t room = (size_t)w.c.plan.kinds[1].room.state_bytes;
    expect_unused(s, lies->state);
    expect_unused(s, lies->state + room / 2u);
    expect_unused(s, lies->state + room - 1u);
    expect_unused(s, &s->head->kinds[1].count);
    expect_unused(s, &s->head->kinds[NOH_STAGE_KINDS_MAX - 1u]);
    put(s, 1, &w.candidates[2]); /* 2 of 9 actors */
    k = &s->kinds[1];
    assert_in_range(lies->used, 1, room - 1u);
    expect_unused(s, lies->state + lies->used);
    expect_unused(s, lies->state + room - 1u);
    expect_unused(s, &s->head->kinds[1].reserved);
    expect_unused(s, &k->actors[0].place.scale); /* of an actor that is not there */
    (void)enter(s, 1, 0, "dance");
    frame(s, 0);
    expect_unused(s, &k->actors[0].reserved);
    expect_unused(s, &k->actors[0].look.reserved[1]);
    held = k->desc->actor_count * (size_t)k->desc->held_float_count * sizeof *k->held;
    if (held % NOH_MEMORY_ALIGN) expect_unused(s, (const uint8_t *)k->held + held);
    close_show(&w);
}

/* Bits of a state flipped, in slots and in what they leave free. */
static void a_damaged_state_does_no_harm(void **state)
{
    test_random r = test_random_from(7);
    uint32_t taken = 0;
    size_t bytes;
    uint8_t *copy, *good;
    show w;
    (void)state;
    open_show(&w);
    make_slots(&w);
    put(w.c.stage, 1, &w.candidates[2]); /* 2 of 9 actors */
    (void)enter(w.c.stage, 1, 0, "dance");
    frame(w.c.stage, 0);
    good = test_aligned(noh_stage_state(w.c.stage, &bytes), w.c.plan.state_bytes);
    copy = test_aligned(good, bytes);
    for (uint32_t i = w.c.stage->kinds[1].first_actor + 2u; i < w.c.stage->actor_count; i++) {
        noh_stage_actor *a = (noh_stage_actor *)(void *)(copy + ((uint8_t *)&w.c.stage->actors[i] - w.c.stage->state));
        a->alive = 1;
        assert_int_equal(noh_stage_set_state(w.c.stage, copy, bytes, &said), NOH_ERR_DATA);
        a->alive = 0;
    }
    for (uint32_t n = 0; n < 1000; n++) {
        const size_t at = test_random_below(&r, (uint32_t)bytes);
        copy[at] ^= (uint8_t)(1u << test_random_below(&r, 8));
        if (noh_stage_set_state(w.c.stage, copy, bytes, NULL) == NOH_OK) {
            taken++;
            if (n % 16u == 0) frame(w.c.stage, 1);
        }
        copy[at] = good[at];
    }
    assert_true(taken > 0);
    free(copy);
    free(good);
    close_show(&w);
}

static int open_packs(void **state)
{
    const char *build = getenv("NOH_BUILD");
    char path[1024];
    (void)state;
    cast_open(&packs);
    snprintf(path, sizeof path, "%s/demo/coat.noh", build ? build : "build");
    assert_int_equal(noh_file_map(path, &coat, &said), NOH_OK);
    coat_pack = test_open(coat.data, coat.bytes);
    return 0;
}

static int close_packs(void **state)
{
    (void)state;
    cast_close(&packs);
    noh_file_unmap(&coat);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_kind_that_comes_equals_one_that_was_there),
        cmocka_unit_test(any_order_leaves_what_runs_alone),
        cmocka_unit_test(the_plan_has_every_byte),
        cmocka_unit_test(what_does_not_fit_is_refused),
        cmocka_unit_test(garments_are_not_worn_by_garments),
        cmocka_unit_test(fields_of_slots_are_checked),
        cmocka_unit_test(bytes_that_nothing_uses_are_refused),
        cmocka_unit_test(a_damaged_state_does_no_harm),
    };
    return cmocka_run_group_tests(tests, open_packs, close_packs);
}
