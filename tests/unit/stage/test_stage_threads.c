/* The jobs of a stage run by four threads at once: in every frame the state and what is shown equal one thread's
 * to the bit, and (tests/tsan.sh) there is no race. */
#define _POSIX_C_SOURCE 200112L
#include "support/look_part.h"
#include "support/stage_fixture.h"

#include "stage/cast/stage_internal.h" /* what each job has done */

#include <pthread.h>
#include <time.h>

#define THREADS 4u
#define FRAMES 200u
#define KINDS 2u
#define ACTORS 36u

typedef struct pool {
    cast cast;
    pthread_barrier_t begin, end;
    uint32_t thread_count, job_count; /* job_count: of this phase; 0: the pool ends */
    uint32_t ran[THREADS];            /* jobs that each thread ran */
    uint32_t posed[THREADS];          /* actors that each job of the second phase has posed */
} pool;

typedef struct worker {
    pool *pool;
    uint32_t index;
} worker;

/* What a frame came to. */
typedef struct result {
    uint64_t state, shown;
} result;

/* ---- the pool ---- */

static void run_mine(pool *p, uint32_t index)
{
    for (uint32_t i = index; i < p->job_count; i += p->thread_count) {
        noh_stage_job(p->cast.stage, i);
        if (p->cast.stage->phase == NOH_STAGE_POSING) p->posed[i] += p->cast.stage->jobs[i].updated;
        p->ran[index]++;
    }
}

static void *work(void *user)
{
    const worker *w = user;
    for (;;) {
        (void)pthread_barrier_wait(&w->pool->begin);
        if (!w->pool->job_count) return NULL;
        run_mine(w->pool, w->index);
        (void)pthread_barrier_wait(&w->pool->end);
    }
}

/* All phases of a frame that has begun. */
static void run_phases(pool *p)
{
    while ((p->job_count = noh_stage_jobs(p->cast.stage)) > 0) {
        if (p->thread_count > 1u) (void)pthread_barrier_wait(&p->begin);
        run_mine(p, 0);
        if (p->thread_count > 1u) (void)pthread_barrier_wait(&p->end);
    }
}

/* ---- the show ---- */

/* Puppets play from a reserve. */
static void bring_clips(cast *c)
{
    const noh_chunk_run run = c->packs[PUPPETS].runs[NOH_CHUNK_CLIP];
    for (uint32_t i = 0; i < run.count; i++) {
        const void *chunk = noh_pack_chunk_at(&c->packs[PUPPETS], NOH_CHUNK_CLIP, i);
        const char *name = noh_pack_chunk_name(&c->packs[PUPPETS], run.first + i);
        const uint32_t clip = noh_stage_find(c->stage, PUPPETS, NOH_NAME_CLIP, name);
        assert_int_equal(noh_stage_load_clip(c->stage, PUPPETS, clip, chunk, NULL), NOH_OK);
    }
}

static void open_cast(cast *c)
{
    static look_joint joint;
    static const noh_modifier gaze = {
        .name = "gaze", .modify = look_modify, .check = look_check, .user = &joint, .state_bytes = sizeof(look_state)
    };
    static const uint32_t counts[KINDS] = { 24, 12 };
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    cast_map(c, MASKS, "mask_levels.noh");
    for (uint32_t k = 0; k < KINDS; k++) {
        c->kinds[k].mesh = &c->packs[k];
        c->kinds[k].actor_count = counts[k];
    }
    c->kinds[PUPPETS].root_axes = NOH_ROOT_GROUND;
    c->kinds[PUPPETS].clip_reserve = 1u << 16;
    c->kinds[PUPPETS].graphs = noh_graph_module("moves");
    joint = look_joint_of(&c->packs[PUPPETS], "head");
    c->kinds[PUPPETS].modifiers = &gaze;
    c->kinds[PUPPETS].modifier_count = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = KINDS;
    c->desc.job_count = THREADS;
    cast_make(c, NULL);
    bring_clips(c);
}

static void close_cast(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
    noh_file_unmap(&c->files[1]);
}

static void enter(cast *c, uint32_t kind, uint32_t number)
{
    const noh_place place = { { 0.7f * (float)(number % 9u) - 3.0f, 0.0f, -1.1f * (float)(number / 9u) },
                              { 0, 0, 0, 0 },
                              0.0f };
    const noh_play play = { .speed = 60000 + 1500 * (int32_t)(number % 12u), .start_ticks = 5000 * (int64_t)number };
    noh_actor actor;
    if (noh_stage_spawn(c->stage, kind, &place, &actor, NULL) != NOH_OK) return; /* all of the kind are there */
    assert_int_equal(noh_actor_play(c->stage, actor, kind == MASKS, kind == MASKS ? "speak" : "walk", &play, NULL),
                     NOH_OK);
    if (kind == PUPPETS && number % 2u) {
        assert_int_equal(noh_actor_play_graph(c->stage, actor, 0, "moves", NULL, NULL), NOH_OK);
    }
}

/* Somebody goes, comes or changes. */
static void direct(cast *c, test_random *r, uint32_t frame)
{
    static const char *const clips[] = { "walk", "run", "bow" };
    const uint32_t index = test_random_below(r, ACTORS), what = test_random_below(r, 5);
    const noh_actor actor = noh_stage_actor_at(c->stage, index);
    if (what == 0 && actor.id) assert_int_equal(noh_stage_despawn(c->stage, actor, NULL), NOH_OK);
    if (what == 1) enter(c, index < c->kinds[PUPPETS].actor_count ? PUPPETS : MASKS, index + frame);
    if (what == 2 && actor.id) (void)noh_actor_play(c->stage, actor, 0, clips[frame % 3u], NULL, NULL);
    if (what == 4 && actor.id) { /* where it plays the graph */
        (void)noh_actor_set_parameter(c->stage, actor, frame % 3u, test_random_float(r, 0, 1), NULL);
    }
    if (what == 4 && index < c->kinds[PUPPETS].actor_count && actor.id) {
        look_state *state = noh_actor_modifier(c->stage, actor, 0);
        state->target[0] = test_random_float(r, -3, 3);
        state->wanted = 1.0f;
    }
    if (what == 3 && actor.id) (void)noh_actor_hold_float(c->stage, actor, 0, test_random_float(r, 0, 1), 0.5f, NULL);
}

static uint64_t mix(uint64_t hash, const void *data, size_t bytes)
{
    const uint8_t *p = data;
    for (size_t i = 0; i < bytes; i++) hash = (hash ^ p[i]) * 1099511628211u;
    return hash;
}

/* Of joints and floats as they showed. */
static uint64_t hash_shown(const cast *c)
{
    uint64_t hash = 14695981039346656037u;
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_actor actor = noh_stage_actor_at(c->stage, i);
        const uint32_t kind = i < c->kinds[PUPPETS].actor_count ? PUPPETS : MASKS;
        const float *floats = actor.id ? noh_actor_floats(c->stage, actor) : NULL;
        float matrix[12];
        if (floats) hash = mix(hash, floats, c->plan.kinds[kind].float_count * sizeof *floats);
        for (uint32_t j = 0; floats && j < c->plan.kinds[kind].joint_count; j++) {
            if (noh_actor_joint(c->stage, actor, j, matrix, NULL) == NOH_OK) hash = mix(hash, matrix, sizeof matrix);
        }
    }
    return hash;
}

static double now(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Returns the seconds that the phases took. */
static double play_frames(pool *p, result *results)
{
    cast *c = &p->cast;
    test_random r = test_random_from(31);
    double seconds = 0.0;
    for (uint32_t i = 0; i < ACTORS; i++) enter(c, i < c->kinds[PUPPETS].actor_count ? PUPPETS : MASKS, i);
    for (uint32_t f = 0; f < FRAMES; f++) {
        const noh_stage_view view = cast_view(f, 4.0f + 12.0f * (float)(f % 80u) / 80.0f);
        direct(c, &r, f);
        assert_int_equal(noh_stage_step(c->stage, 500u + test_random_below(&r, 700), NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_between(c->stage, &view, 1, 1.0f - 0.3f * (float)(f % 3u), NULL), NOH_OK);
        seconds -= now();
        run_phases(p);
        seconds += now();
        assert_int_equal(noh_stage_frame_end(c->stage, NULL), NOH_OK);
        results[f].state = noh_stage_hash(c->stage);
        results[f].shown = hash_shown(c);
    }
    return seconds;
}

static double run(pool *p, uint32_t thread_count, result *results)
{
    pthread_t threads[THREADS];
    worker workers[THREADS];
    double seconds;
    memset(p, 0, sizeof *p);
    p->thread_count = thread_count;
    open_cast(&p->cast);
    assert_int_equal(pthread_barrier_init(&p->begin, NULL, thread_count), 0);
    assert_int_equal(pthread_barrier_init(&p->end, NULL, thread_count), 0);
    for (uint32_t i = 1; i < thread_count; i++) {
        workers[i].pool = p;
        workers[i].index = i;
        assert_int_equal(pthread_create(&threads[i], NULL, work, &workers[i]), 0);
    }
    seconds = play_frames(p, results);
    p->job_count = 0;
    if (thread_count > 1u) (void)pthread_barrier_wait(&p->begin);
    for (uint32_t i = 1; i < thread_count; i++) assert_int_equal(pthread_join(threads[i], NULL), 0);
    (void)pthread_barrier_destroy(&p->begin);
    (void)pthread_barrier_destroy(&p->end);
    close_cast(&p->cast);
    return seconds;
}

/* ---- the test ---- */

static void four_threads_show_what_one_shows(void **state)
{
    static result one[FRAMES], two[FRAMES], four[FRAMES];
    static pool p;
    double alone, pair, together;
    uint32_t changed = 0, posed = 0, most = 0;
    (void)state;
    alone = run(&p, 1, one);
    pair = run(&p, 2, two);
    together = run(&p, THREADS, four);
    for (uint32_t i = 0; i < THREADS; i++) assert_true(p.ran[i] >= FRAMES); /* each had a part in every frame */
    for (uint32_t f = 0; f < FRAMES; f++) {
        if (one[f].state != four[f].state) fail_msg("the state differs in frame %u", (unsigned)f);
        if (memcmp(&one[f], &two[f], sizeof two[f]) != 0) fail_msg("two threads differ in frame %u", (unsigned)f);
        if (one[f].shown != four[f].shown) fail_msg("what is shown differs in frame %u", (unsigned)f);
        changed += f > 0 && one[f].shown != one[f - 1u].shown;
    }
    assert_true(changed > FRAMES * 9u / 10u); /* else equal hashes show nothing */
    for (uint32_t i = 0; i < THREADS; i++) {
        posed += p.posed[i];
        most = p.posed[i] > most ? p.posed[i] : most;
    }
    print_message("# poses of the job that has the most: %.2f of the mean\n", (double)most * THREADS / posed);
    assert_true(posed > 10u * FRAMES &&
                most * THREADS * 10u <= posed * 14u); /* split evenly: at most 1.4 of the mean */
    print_message("# phases: one thread takes %.2f times as long as 2, %.2f times as long as %u\n", alone / pair,
                  alone / together, THREADS);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(four_threads_show_what_one_shows),
};

TEST_MAIN(tests, NULL, NULL)
