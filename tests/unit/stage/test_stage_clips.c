/* Clips that come into a running stage and go: once a clip is there it plays with the bits of one that was there from
 * the start, though its chunk in the pack is overwritten; what plays stays; what is absent is reported. */
#include "support/stage_fixture.h"

#include "noh/crowd.h"
#include "stage/cast/stage_internal.h"

#define PLAYERS 4u
#define CLIPS 5u

static noh_error said;
static cast files; /* opened once */

/* A stage of puppets. With a reserve the pack is a copy, whose clips are overwritten once the stage is made. */
typedef struct show {
    cast c;
    uint8_t *copy;
    noh_pack pack;
} show;

static uint32_t clip_bytes(uint32_t clip)
{
    noh_pack_clip found;
    assert_int_equal(noh_pack_clip_at(&files.packs[PUPPETS], clip, &found, NULL), NOH_OK);
    return (found.header->clip_bytes + 15u) & ~15u;
}

static uint32_t largest_clip(void)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < CLIPS; i++) most = clip_bytes(i) > most ? clip_bytes(i) : most;
    return most;
}

static void overwrite_clips(show *w)
{
    for (uint32_t i = 0; i < w->pack.runs[NOH_CHUNK_CLIP].count; i++) {
        const noh_pack_chunk *chunk = &w->pack.chunks[w->pack.runs[NOH_CHUNK_CLIP].first + i];
        memset(w->copy + chunk->offset, 0xa5, chunk->bytes);
    }
}

static void open_show(show *w, uint32_t reserve, uint32_t jobs)
{
    const noh_file *file = &files.files[PUPPETS];
    noh_kind_desc *k = &w->c.kinds[0];
    w->c = files;
    w->c.desc.kinds = w->c.kinds;
    w->copy = test_aligned(file->data, file->bytes);
    w->pack = test_open(w->copy, file->bytes);
    k->mesh = &w->pack;
    k->actor_count = PLAYERS;
    k->graphs = noh_graph_module("moves");
    k->inertia = 1;
    k->clip_reserve = reserve;
    w->c.desc.kind_count = 1;
    w->c.desc.job_count = jobs;
}

/* With as few decoded segments as a plan can have: bytes are read again and again. */
static void make(show *w)
{
    noh_stage_plan plan;
    w->c.desc.cpu_bytes_max = 1;
    assert_int_equal(noh_stage_plan_make(&w->c.desc, NULL, &plan, &said), NOH_ERR_MEMORY);
    w->c.desc.cpu_bytes_max = said.need;
    cast_make(&w->c, NULL);
    if (w->c.kinds[0].clip_reserve) overwrite_clips(w);
}

static void close_show(show *w)
{
    cast_close_stage(&w->c);
    free(w->copy);
}

/* The bytes of a wanted clip, as read from the pack's file, at an odd address. */
static noh_result bring(noh_stage *s, noh_wanted_clip w)
{
    uint8_t *read = malloc((size_t)w.bytes + 1u);
    noh_result result;
    assert_non_null(read);
    memcpy(read + 1, (const uint8_t *)files.files[PUPPETS].data + w.offset, w.bytes);
    result = noh_stage_load_clip(s, w.kind, w.clip, read + 1, &said);
    memset(read, 0x5a, (size_t)w.bytes + 1u);
    free(read);
    return result;
}

static noh_result bring_named(noh_stage *s, const char *name)
{
    const uint32_t clip = noh_stage_find(s, 0, NOH_NAME_CLIP, name);
    const noh_stage_stats *stats = noh_stage_stats_of(s);
    assert_int_equal(noh_stage_load_clip(s, 0, clip, NULL, &said), NOH_OK);
    for (uint32_t i = 0; i < stats->wanted_count; i++) {
        if (stats->wanted[i].clip == clip) return bring(s, stats->wanted[i]);
    }
    return NOH_OK; /* it is there */
}

static int is_there(noh_stage *s, const char *name)
{
    const uint32_t clip = noh_stage_find(s, 0, NOH_NAME_CLIP, name), before = noh_stage_stats_of(s)->wanted_count;
    assert_true(clip != NOH_NONE);
    return !noh_clip_is_absent(&s->kinds[0].set, clip) && noh_stage_stats_of(s)->wanted_count == before;
}

static void enter(noh_stage *s, noh_actor *actors)
{
    for (uint32_t i = 0; i < PLAYERS; i++) {
        const noh_place place = { { 1.1f * (float)i - 2.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
        if (noh_stage_spawn(s, 0, &place, &actors[i], &said) != NOH_OK) fail_msg("%s", said.what);
    }
}

static void frame(noh_stage *s, uint32_t number)
{
    const noh_stage_view view = cast_view(number % 40u, 6.0f);
    if (noh_stage_frame(s, 3u * CAST_STEP, &view, NULL, NULL, &said) != NOH_OK) fail_msg("%s", said.what);
}

static void expect_same(noh_stage *a, const noh_actor *of_a, noh_stage *b, const noh_actor *of_b)
{
    uint32_t count[2];
    const noh_stage_event *told_a = noh_stage_events(a, &count[0]), *told_b = noh_stage_events(b, &count[1]);
    assert_true(noh_stage_hash(a) == noh_stage_hash(b));
    assert_int_equal(count[0], count[1]);
    for (uint32_t i = 0; i < count[0]; i++) assert_string_equal(told_a[i].name, told_b[i].name);
    for (uint32_t i = 0; i < PLAYERS; i++) {
        for (uint32_t j = 0; j < a->kinds[0].skeleton.joint_count; j++) {
            float ma[12], mb[12];
            const noh_result result = noh_actor_joint(a, of_a[i], j, ma, NULL);
            assert_int_equal(noh_actor_joint(b, of_b[i], j, mb, NULL), result);
            if (result == NOH_OK) assert_memory_equal(ma, mb, sizeof ma);
        }
    }
}

/* ---- playing ---- */

static noh_result do_play(noh_stage *s, noh_actor actor, uint32_t what, const char *clip)
{
    const noh_play plays[3] = { { 0 }, { .flags = NOH_PLAY_INERTIA }, { .flags = NOH_PLAY_PHASE } };
    const noh_play from_bow = { .reference = "bow" };
    if (what == 3) return noh_actor_stop(s, actor, 0, 0, &said);
    if (what == 4) return noh_actor_play(s, actor, 2, clip, &plays[0], &said); /* additive */
    if (what == 5) return noh_actor_play_graph(s, actor, 0, "moves", NULL, &said);
    if (what == 6) return noh_actor_play(s, actor, 2, clip, &from_bow, &said); /* additive, from another clip */
    return noh_actor_play(s, actor, 0, clip, &plays[what], &said);
}

static void stop_all(noh_stage *s, noh_actor actor)
{
    assert_int_equal(noh_actor_stop(s, actor, 0, 1, &said), NOH_OK);
    assert_int_equal(noh_actor_stop(s, actor, 2, 1, &said), NOH_OK);
}

/* In any order, with room for a few clips: the stage that has all clips in place is the oracle. A play fails where a
 * clip is absent, and the actor plays as before; then the game brings what is wanted, if what plays leaves room. */
static void any_order_has_the_bits_of_clips_in_place(void **state)
{
    test_random r = test_random_from(43u);
    uint32_t refused = 0, brought = 0, full = 0;
    (void)state;
    for (uint32_t jobs = 1; jobs <= 3; jobs += 2) {
        show a, b;
        noh_actor of_a[PLAYERS], of_b[PLAYERS];
        open_show(&a, 0, 1), open_show(&b, largest_clip() + clip_bytes(1) + 64u, jobs);
        make(&a), make(&b);
        enter(a.c.stage, of_a), enter(b.c.stage, of_b);
        for (uint32_t round = 0; round < 160; round++) {
            const uint32_t who = test_random_below(&r, PLAYERS), what = test_random_below(&r, 6);
            const char *clip = noh_stage_name(a.c.stage, 0, NOH_NAME_CLIP, test_random_below(&r, CLIPS));
            const noh_stage_stats *stats = noh_stage_stats_of(b.c.stage);
            noh_result result = do_play(b.c.stage, of_b[who], what, clip);
            for (uint32_t i = 0; result == NOH_ERR_NOT_FOUND && stats->wanted_count && i < CLIPS; i++) {
                refused++;
                assert_true(noh_stage_hash(a.c.stage) == noh_stage_hash(b.c.stage));
                result = bring(b.c.stage, stats->wanted[0]);
                brought += result == NOH_OK;
                if (result == NOH_OK) result = do_play(b.c.stage, of_b[who], what, clip);
            }
            full += result == NOH_ERR_MEMORY;
            if (result == NOH_OK) assert_int_equal(do_play(a.c.stage, of_a[who], what, clip), NOH_OK);
            for (uint32_t i = 0; round % 8u == 7u && i < PLAYERS; i++) {
                stop_all(a.c.stage, of_a[i]), stop_all(b.c.stage, of_b[i]);
            }
            for (uint32_t f = 0; f < 3; f++) {
                frame(a.c.stage, round), frame(b.c.stage, round);
                expect_same(a.c.stage, of_a, b.c.stage, of_b);
            }
        }
        close_show(&a), close_show(&b);
    }
    printf("# %u refused, %u brought, %u without room\n", refused, brought, full);
    assert_true(refused > 20u && brought > 20u && full > 5u);
}

static void the_least_recently_used_goes(void **state)
{
    noh_actor actors[PLAYERS];
    show w;
    noh_stage *s;
    (void)state;
    open_show(&w, largest_clip() + clip_bytes(0), 1);
    make(&w);
    s = w.c.stage;
    enter(s, actors);
    assert_false(is_there(s, "dance") || is_there(s, "idle"));
    assert_int_equal(noh_actor_play(s, actors[0], 0, "dance", NULL, &said), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "not in memory"));
    assert_int_equal(noh_stage_stats_of(s)->wanted_count, 1);
    assert_null(noh_actor_track(s, actors[0], 0));
    assert_int_equal(bring_named(s, "dance"), NOH_OK);
    assert_int_equal(noh_stage_stats_of(s)->wanted_count, 0);
    assert_int_equal(bring_named(s, "idle"), NOH_OK);
    assert_int_equal(bring_named(s, "walk"), NOH_OK); /* dance came first, and nothing played it */
    assert_true(is_there(s, "idle") && is_there(s, "walk") && !is_there(s, "dance"));
    assert_int_equal(noh_actor_play(s, actors[0], 0, "walk", NULL, &said), NOH_OK);
    frame(s, 0);
    assert_int_equal(bring_named(s, "dance"), NOH_OK); /* idle goes, walk plays */
    assert_true(is_there(s, "dance") && is_there(s, "walk") && !is_there(s, "idle"));
    assert_int_equal(noh_actor_play(s, actors[1], 0, "dance", NULL, &said), NOH_OK);
    assert_int_equal(bring_named(s, "bow"), NOH_ERR_MEMORY);
    assert_non_null(strstr(said.what, "reserve"));
    assert_int_equal(said.where, clip_bytes(1) + largest_clip());
    assert_int_equal(said.need, said.where + clip_bytes(2));
    assert_true(is_there(s, "dance") && is_there(s, "walk"));
    assert_int_equal(noh_actor_stop(s, actors[0], 0, 1, &said), NOH_OK);
    frame(s, 1);
    assert_int_equal(bring_named(s, "idle"), NOH_OK);
    assert_true(is_there(s, "dance") && !is_there(s, "walk"));
    close_show(&w);
}

static void a_graph_needs_all_its_clips(void **state)
{
    noh_actor actors[PLAYERS];
    const noh_stage_stats *stats;
    uint32_t wanted;
    show w;
    (void)state;
    open_show(&w, 1u << 16, 1);
    make(&w);
    stats = noh_stage_stats_of(w.c.stage);
    enter(w.c.stage, actors);
    assert_int_equal(noh_actor_play_graph(w.c.stage, actors[0], 0, "moves", NULL, &said), NOH_ERR_NOT_FOUND);
    wanted = stats->wanted_count;
    assert_true(wanted >= 2u);
    assert_int_equal(said.need, wanted);
    while (stats->wanted_count) {
        assert_int_equal(noh_actor_play_graph(w.c.stage, actors[0], 0, "moves", NULL, &said), NOH_ERR_NOT_FOUND);
        assert_int_equal(bring(w.c.stage, stats->wanted[stats->wanted_count - 1u]), NOH_OK);
    }
    assert_int_equal(noh_actor_play_graph(w.c.stage, actors[0], 0, "moves", NULL, &said), NOH_OK);
    for (uint32_t f = 0; f < 20; f++) frame(w.c.stage, f);
    close_show(&w);
}

static uint32_t wanted_bytes(noh_stage *s)
{
    const noh_stage_stats *stats = noh_stage_stats_of(s);
    uint32_t bytes = 0;
    for (uint32_t i = 0; i < stats->wanted_count; i++) bytes += clip_bytes(stats->wanted[i].clip);
    return bytes;
}

/* The bytes of all clips that something takes at once. what: as do_play */
static uint32_t bytes_together(uint32_t what)
{
    noh_actor actors[PLAYERS];
    uint32_t bytes;
    show w;
    open_show(&w, 1u << 16, 1);
    make(&w);
    enter(w.c.stage, actors);
    assert_int_equal(do_play(w.c.stage, actors[0], what, "dance"), NOH_ERR_NOT_FOUND);
    bytes = wanted_bytes(w.c.stage);
    close_show(&w);
    return bytes;
}

/* Clips that need each other: with room for all they come, one after another and whatever was there before; with 16
 * bytes less the call fails at once with what they take. */
static void what_plays_together_comes_together(void **state)
{
    (void)state;
    for (uint32_t what = 5; what <= 6; what++) {
        const uint32_t need = bytes_together(what);
        for (uint32_t less = 0; less <= 16; less += 16) {
            noh_actor actors[PLAYERS];
            noh_result result = NOH_ERR_NOT_FOUND;
            noh_stage *s;
            show w;
            assert_true(need - less >= largest_clip());
            open_show(&w, need - less, 1);
            make(&w);
            s = w.c.stage;
            enter(s, actors);
            assert_int_equal(bring_named(s, "walk"), NOH_OK);
            for (uint32_t i = 0; i < CLIPS; i++) {
                assert_int_equal(bring_named(s, noh_stage_name(s, 0, NOH_NAME_CLIP, i)), NOH_OK);
            }
            for (uint32_t i = 0; result == NOH_ERR_NOT_FOUND && i < 2; i++) {
                result = do_play(s, actors[0], what, "dance");
                while (result == NOH_ERR_NOT_FOUND && noh_stage_stats_of(s)->wanted_count) {
                    assert_int_equal(bring(s, noh_stage_stats_of(s)->wanted[0]), NOH_OK);
                }
            }
            assert_int_equal(result, less ? NOH_ERR_MEMORY : NOH_OK);
            if (less) {
                assert_int_equal(said.need, need);
                assert_non_null(strstr(said.what, "raise clip_reserve"));
                assert_int_equal(noh_stage_stats_of(s)->wanted_count, 0);
            }
            close_show(&w);
        }
    }
}

#define COPIES 4u /* of the kind, with clips of their own */

/* Others are listed though the game cannot bring some: the oldest give way. */
static void a_full_list_drops_the_oldest(void **state)
{
    const noh_stage_stats *stats;
    noh_kind_desc kinds[COPIES];
    show w;
    (void)state;
    open_show(&w, 1u << 15, 1);
    for (uint32_t i = 0; i < COPIES; i++) {
        kinds[i] = w.c.kinds[0];
        kinds[i].clip_reserve += 16u * i;
    }
    w.c.desc.kinds = kinds;
    w.c.desc.kind_count = COPIES;
    cast_make(&w.c, NULL);
    stats = noh_stage_stats_of(w.c.stage);
    for (uint32_t i = 0; i < COPIES * CLIPS; i++) {
        assert_int_equal(noh_stage_load_clip(w.c.stage, i / CLIPS, i % CLIPS, NULL, &said), NOH_OK);
    }
    assert_int_equal(stats->wanted_count, NOH_WANTED_CLIPS_MAX);
    for (uint32_t i = 0; i < NOH_WANTED_CLIPS_MAX; i++) {
        const uint32_t n = i + COPIES * CLIPS - NOH_WANTED_CLIPS_MAX;
        assert_int_equal(stats->wanted[i].kind * CLIPS + stats->wanted[i].clip, n);
    }
    close_show(&w);
}

static uint32_t clip_of(const char *name)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < CLIPS; i++) {
        noh_pack_clip clip;
        assert_int_equal(noh_pack_clip_at(&files.packs[PUPPETS], i, &clip, NULL), NOH_OK);
        if (strcmp(clip.name, name) == 0) found = clip_bytes(i);
    }
    assert_true(found > 0u);
    return found;
}

static void bring_wanted(noh_stage *s)
{
    const noh_stage_stats *stats = noh_stage_stats_of(s);
    for (uint32_t i = stats->wanted_count; i-- > 0;) assert_int_equal(bring(s, stats->wanted[i]), NOH_OK);
    assert_int_equal(stats->wanted_count, 0);
}

/* Walkers measure their clips, and start them by themselves. */
static void walkers_need_their_clips(void **state)
{
    const noh_walkers_desc desc = { .walk = "walk", .idle = "idle", .walker_max = 2, .walk_speed = 1.0f };
    const uint32_t both = clip_of("walk") + clip_of("idle");
    noh_actor actors[PLAYERS];
    noh_walkers *walkers;
    uint64_t before;
    void *memory;
    show w;
    (void)state;
    open_show(&w, both > largest_clip() ? both : largest_clip(), 1);
    w.c.kinds[0].root_axes |= NOH_ROOT_BY_GAME;
    make(&w);
    enter(w.c.stage, actors);
    memory = test_aligned(NULL, noh_walkers_size(&desc));
    assert_int_equal(noh_walkers_init(memory, noh_walkers_size(&desc), &desc, w.c.stage, &walkers, &said),
                     NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "not in memory"));
    assert_int_equal(noh_stage_stats_of(w.c.stage)->wanted_count, 2);
    bring_wanted(w.c.stage);
    if (noh_walkers_init(memory, noh_walkers_size(&desc), &desc, w.c.stage, &walkers, &said) != NOH_OK)
        fail_msg("%s", said.what);
    assert_int_equal(bring_named(w.c.stage, "dance"), NOH_OK); /* one of the two goes, or both */
    assert_int_equal(bring_named(w.c.stage, "walk"), NOH_OK);
    before = noh_stage_hash(w.c.stage);
    assert_int_equal(noh_walkers_add(walkers, 0, w.c.stage, actors[0], 0, NULL, &said), NOH_ERR_NOT_FOUND);
    assert_true(noh_stage_hash(w.c.stage) == before);
    assert_int_equal(noh_stage_stats_of(w.c.stage)->wanted_count, 1);
    bring_wanted(w.c.stage);
    assert_int_equal(noh_walkers_add(walkers, 0, w.c.stage, actors[0], 0, NULL, &said), NOH_OK);
    free(memory);
    close_show(&w);
}

/* ---- states ---- */

static void a_state_that_plays_what_is_absent_is_refused(void **state)
{
    noh_actor of_a[PLAYERS], of_b[PLAYERS];
    show a, b;
    const void *own;
    void *copy;
    size_t bytes;
    uint64_t before;
    (void)state;
    open_show(&a, 1u << 16, 1), open_show(&b, 1u << 16, 1);
    make(&a), make(&b);
    enter(a.c.stage, of_a), enter(b.c.stage, of_b);
    assert_int_equal(bring_named(a.c.stage, "walk"), NOH_OK);
    assert_int_equal(bring_named(a.c.stage, "bow"), NOH_OK);
    assert_int_equal(noh_actor_play(a.c.stage, of_a[1], 0, "walk", NULL, &said), NOH_OK);
    assert_int_equal(noh_actor_play(a.c.stage, of_a[2], 0, "bow", NULL, &said), NOH_OK);
    for (uint32_t f = 0; f < 5; f++) frame(a.c.stage, f);
    own = noh_stage_state(a.c.stage, &bytes);
    copy = test_aligned(own, bytes);
    before = noh_stage_hash(b.c.stage);
    assert_int_equal(noh_stage_set_state(b.c.stage, copy, bytes, &said), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "not in memory"));
    assert_int_equal(said.need, 2);
    assert_true(noh_stage_hash(b.c.stage) == before);
    while (noh_stage_stats_of(b.c.stage)->wanted_count) {
        assert_int_equal(noh_stage_set_state(b.c.stage, copy, bytes, NULL), NOH_ERR_NOT_FOUND);
        assert_int_equal(bring(b.c.stage, noh_stage_stats_of(b.c.stage)->wanted[0]), NOH_OK);
    }
    assert_int_equal(noh_stage_set_state(b.c.stage, copy, bytes, &said), NOH_OK);
    for (uint32_t f = 5; f < 12; f++) {
        frame(a.c.stage, f), frame(b.c.stage, f);
        expect_same(a.c.stage, of_a, b.c.stage, of_a);
    }
    free(copy);
    close_show(&a), close_show(&b);
}

static void open_two_kinds(show *w)
{
    open_show(w, 1u << 16, 1);
    w->c.kinds[1] = w->c.kinds[0];
    w->c.kinds[1].clip_reserve += 16u;
    w->c.desc.kind_count = 2;
    cast_make(&w->c, NULL);
}

/* Clips of all kinds, each once though two actors play it. */
static void a_state_counts_its_clips(void **state)
{
    const noh_stage_stats *stats;
    show a, b;
    void *copy;
    size_t bytes;
    (void)state;
    open_two_kinds(&a), open_two_kinds(&b);
    stats = noh_stage_stats_of(a.c.stage);
    for (uint32_t i = 0; i < 4; i++) {
        noh_actor actor;
        assert_int_equal(noh_stage_spawn(a.c.stage, i % 2u, NULL, &actor, &said), NOH_OK);
        if (noh_actor_play(a.c.stage, actor, 0, "walk", NULL, &said) == NOH_OK) continue;
        assert_int_equal(bring(a.c.stage, stats->wanted[0]), NOH_OK);
        assert_int_equal(noh_actor_play(a.c.stage, actor, 0, "walk", NULL, &said), NOH_OK);
    }
    copy = test_aligned(noh_stage_state(a.c.stage, &bytes), a.c.plan.state_bytes);
    assert_int_equal(noh_stage_set_state(b.c.stage, copy, bytes, &said), NOH_ERR_NOT_FOUND);
    assert_int_equal(said.need, 2);
    assert_int_equal(noh_stage_stats_of(b.c.stage)->wanted_count, 2);
    free(copy);
    close_show(&a), close_show(&b);
}

/* ---- a slot, bytes and errors ---- */

static void a_slot_has_a_reserve_of_its_own(void **state)
{
    noh_kind_desc desc;
    noh_actor actor;
    noh_stage *s;
    show w;
    (void)state;
    open_show(&w, 1u << 15, 1);
    desc = w.c.kinds[0];
    w.c.kinds[0].changes = 2;
    cast_make(&w.c, NULL);
    s = w.c.stage;
    assert_int_equal(noh_stage_set_kind(s, 0, &desc, &said), NOH_OK);
    assert_int_equal(noh_stage_spawn(s, 0, NULL, &actor, &said), NOH_OK);
    assert_int_equal(noh_actor_play(s, actor, 0, "walk", NULL, &said), NOH_ERR_NOT_FOUND);
    assert_int_equal(bring_named(s, "walk"), NOH_OK);
    assert_int_equal(noh_actor_play(s, actor, 0, "walk", NULL, &said), NOH_OK);
    frame(s, 0);
    assert_int_equal(noh_actor_play(s, actor, 0, "bow", NULL, &said), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_stage_despawn(s, actor, &said), NOH_OK);
    assert_int_equal(noh_stage_set_kind(s, 0, NULL, &said), NOH_OK);
    assert_int_equal(noh_stage_stats_of(s)->wanted_count, 0);
    close_show(&w);
}

/* The plan has no list of wanted clips then. */
static void a_slot_of_a_plan_without_reserves_takes_none(void **state)
{
    noh_kind_desc desc, large;
    show w;
    (void)state;
    open_show(&w, 0, 1);
    desc = large = w.c.kinds[0];
    large.actor_count += 40u;
    w.c.kinds[0].changes = 2;
    w.c.kinds[0].others = &large;
    w.c.kinds[0].other_count = 1;
    cast_make(&w.c, NULL);
    desc.actor_count = 1;
    desc.clip_reserve = largest_clip();
    assert_int_equal(noh_stage_set_kind(w.c.stage, 0, &desc, &said), NOH_ERR_UNSUPPORTED);
    assert_non_null(strstr(said.what, "others"));
    desc.clip_reserve = 0;
    assert_int_equal(noh_stage_set_kind(w.c.stage, 0, &desc, &said), NOH_OK);
    close_show(&w);
}

/* Clips that some kind reads in place have to be there, whatever other kinds of the pack do. */
static void clips_read_in_place_stay_in_the_pack(void **state)
{
    uint64_t bytes[2][2], clips = 0;
    show w;
    (void)state;
    for (uint32_t first = 0; first < 2; first++) {
        for (uint32_t second = 0; second < 2; second++) {
            open_show(&w, first ? 1u << 15 : 0, 1);
            w.c.kinds[1] = w.c.kinds[0];
            w.c.kinds[1].clip_reserve = second ? 1u << 15 : 0;
            w.c.desc.kind_count = 2;
            assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_OK);
            bytes[first][second] = w.c.plan.pack_bytes;
            if (first + second == 0) {
                for (uint32_t i = 0; i < CLIPS; i++)
                    clips += w.pack.chunks[w.pack.runs[NOH_CHUNK_CLIP].first + i].bytes;
            }
            close_show(&w);
        }
    }
    assert_int_equal(bytes[0][0], w.pack.byte_count);
    assert_int_equal(bytes[0][1], bytes[0][0]);
    assert_int_equal(bytes[1][0], bytes[0][0]);
    assert_int_equal(bytes[1][1], bytes[0][0] - clips);
}

/* Whichever kinds, lists and texture sets name it. */
static void each_pack_counts_once(void **state)
{
    const noh_pack *lists[2][3];
    uint64_t clips = 0;
    noh_pack again;
    show w;
    (void)state;
    open_show(&w, 0, 1);
    again = w.pack; /* the same bytes under another address */
    lists[0][0] = lists[1][0] = lists[0][2] = &again;
    lists[0][1] = lists[1][2] = &w.c.packs[PUPPETS];
    lists[1][1] = &w.c.packs[MASKS];
    for (uint32_t i = 0; i < CLIPS; i++) clips += w.pack.chunks[w.pack.runs[NOH_CHUNK_CLIP].first + i].bytes;
    w.c.kinds[0].graphs = noh_graph_module(NULL);
    w.c.kinds[1] = w.c.kinds[0];
    w.c.desc.kind_count = 2;
    for (uint32_t i = 0; i < 2; i++) w.c.kinds[i].clip_packs = lists[i];
    for (uint32_t first = 1; first <= 3; first++) {
        for (uint32_t second = 1; second <= 3; second++) {
            for (uint32_t reserve = 0; reserve < 2; reserve++) {
                const int puppets = first > 1 || second > 2, masks = second > 1;
                for (uint32_t i = 0; i < 2; i++) {
                    w.c.kinds[i].clip_pack_count = i ? second : first;
                    w.c.kinds[i].clip_reserve = reserve ? 1u << 15 : 0;
                }
                if (noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said)) fail_msg("%s", said.what);
                uint64_t expected = w.pack.byte_count * (puppets ? 2u : 1u) -
                                    (reserve ? clips * (puppets ? 2u : 1u) : 0);
                if (masks) expected += w.c.packs[MASKS].byte_count;
                for (uint32_t i = 0; masks && reserve && i < w.c.packs[MASKS].runs[NOH_CHUNK_CLIP].count; i++) {
                    expected -= w.c.packs[MASKS].chunks[w.c.packs[MASKS].runs[NOH_CHUNK_CLIP].first + i].bytes;
                }
                assert_int_equal(w.c.plan.pack_bytes, expected);
            }
        }
    }
    close_show(&w);
}

static void the_plan_states_the_reserve(void **state)
{
    noh_stage_bytes parts[32];
    uint64_t sum = 0, reserve = 0;
    uint32_t count;
    show w;
    (void)state;
    open_show(&w, largest_clip() + 1u, 1);
    cast_make(&w.c, NULL);
    count = noh_stage_plan_parts(&w.c.desc, NULL, &w.c.plan, parts, TEST_COUNT(parts));
    for (uint32_t i = 0; i < count && i < TEST_COUNT(parts); i++) {
        sum += parts[i].cpu_bytes;
        if (strcmp(parts[i].what, "clip reserve") == 0) reserve += parts[i].cpu_bytes;
    }
    assert_int_equal(sum, w.c.plan.cpu_bytes);
    assert_int_equal(reserve, largest_clip() + 16u);
    close_show(&w);
}

static void refuse(noh_stage *s, uint32_t kind, uint32_t clip, const void *chunk, noh_result result, const char *what)
{
    assert_int_equal(noh_stage_load_clip(s, kind, clip, chunk, &said), result);
    if (!strstr(said.what, what)) fail_msg("'%s' is not about %s", said.what, what);
}

static void what_is_wrong_is_refused(void **state)
{
    noh_wanted_clip first;
    uint8_t *bytes;
    show w, plain;
    (void)state;
    open_show(&w, largest_clip() - 16u, 1);
    assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "raise it"));
    assert_int_equal(said.need, largest_clip());
    w.c.kinds[0].clip_reserve = NOH_CLIP_RESERVE_MAX + 1u;
    assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_ERR_ARG);
    w.c.kinds[0].clip_reserve = largest_clip();
    make(&w);
    open_show(&plain, 0, 1);
    make(&plain);
    refuse(plain.c.stage, 0, 0, NULL, NOH_ERR_UNSUPPORTED, "clip_reserve");
    refuse(w.c.stage, 1, 0, NULL, NOH_ERR_ARG, "no such kind");
    refuse(w.c.stage, 0, CLIPS, NULL, NOH_ERR_NOT_FOUND, "no such clip");
    assert_int_equal(noh_stage_load_clip(w.c.stage, 0, 0, NULL, &said), NOH_OK);
    first = noh_stage_stats_of(w.c.stage)->wanted[0];
    bytes = test_aligned((const uint8_t *)files.files[PUPPETS].data + first.offset, first.bytes);
    for (uint32_t i = 0; i < first.bytes; i += 97u) {
        bytes[i] ^= 1u;
        refuse(w.c.stage, 0, 0, bytes, NOH_ERR_DATA, "not its chunk");
        bytes[i] ^= 1u;
    }
    assert_int_equal(noh_stage_frame_begin(w.c.stage, NULL, 0, NULL), NOH_OK);
    refuse(w.c.stage, 0, 0, bytes, NOH_ERR_ARG, "during a step or a frame");
    assert_int_equal(noh_stage_frame_end(w.c.stage, NULL), NOH_OK);
    assert_int_equal(noh_stage_load_clip(w.c.stage, 0, 0, bytes, &said), NOH_OK);
    assert_int_equal(noh_stage_load_clip(w.c.stage, 0, 0, bytes, &said), NOH_OK);
    free(bytes);
    close_show(&w), close_show(&plain);
}

/* Bytes with the checksum of the pack's table, and places in them past their end. */
static void places_in_a_chunk_are_checked(void **state)
{
    const uint32_t bad[][2] = { { UINT32_MAX, 1 }, { 64, UINT32_MAX - 32u }, { 1u << 20, 16 } };
    noh_pack_chunk *chunk;
    noh_clip_header *header;
    noh_clip_header was;
    uint8_t *bytes;
    show w;
    (void)state;
    open_show(&w, largest_clip(), 1);
    make(&w);
    chunk = (noh_pack_chunk *)(void *)(w.copy + ((const uint8_t *)w.pack.chunks - (const uint8_t *)w.pack.bytes));
    chunk += w.pack.runs[NOH_CHUNK_CLIP].first;
    bytes = test_aligned((const uint8_t *)files.files[PUPPETS].data + chunk->offset, chunk->bytes);
    header = (noh_clip_header *)(void *)bytes;
    was = *header;
    for (uint32_t i = 0; i < TEST_COUNT(bad); i++) {
        header->clip_offset = bad[i][0];
        header->clip_bytes = bad[i][1];
        chunk->crc = noh_crc32c(0, bytes, chunk->bytes);
        refuse(w.c.stage, 0, 0, bytes, NOH_ERR_DATA, "not in its chunk");
    }
    *header = was;
    chunk->crc = noh_crc32c(0, bytes, chunk->bytes);
    assert_int_equal(noh_stage_load_clip(w.c.stage, 0, 0, bytes, &said), NOH_OK);
    free(bytes);
    close_show(&w);
}

static int open_files(void **state)
{
    (void)state;
    cast_open(&files);
    return 0;
}

static int close_files(void **state)
{
    (void)state;
    cast_close(&files);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_order_has_the_bits_of_clips_in_place),
        cmocka_unit_test(the_least_recently_used_goes),
        cmocka_unit_test(a_graph_needs_all_its_clips),
        cmocka_unit_test(what_plays_together_comes_together),
        cmocka_unit_test(a_full_list_drops_the_oldest),
        cmocka_unit_test(walkers_need_their_clips),
        cmocka_unit_test(a_state_that_plays_what_is_absent_is_refused),
        cmocka_unit_test(a_state_counts_its_clips),
        cmocka_unit_test(a_slot_has_a_reserve_of_its_own),
        cmocka_unit_test(a_slot_of_a_plan_without_reserves_takes_none),
        cmocka_unit_test(clips_read_in_place_stay_in_the_pack),
        cmocka_unit_test(each_pack_counts_once),
        cmocka_unit_test(the_plan_states_the_reserve),
        cmocka_unit_test(what_is_wrong_is_refused),
        cmocka_unit_test(places_in_a_chunk_are_checked),
    };
    return cmocka_run_group_tests(tests, open_files, close_files);
}
