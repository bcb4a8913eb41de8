/* The jobs of a crowd run by four threads at once: the bits of one thread, and (tests/tsan.sh) no race; what makes them
 * so: neighbours whose order does not depend on the order of agents. */
#define _POSIX_C_SOURCE 200112L
#include "stage/crowd/crowd_internal.h"
#include "noh/base.h"
#include "noh/crowd.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define THREADS 4u
#define AGENTS 600u
#define STEPS 120u

typedef struct pool {
    noh_crowd *crowd;
    pthread_barrier_t begin, end;
    uint32_t job_count; /* of this phase; 0: the pool ends */
} pool;

typedef struct worker {
    pool *pool;
    uint32_t index;
} worker;

static void run_mine(const pool *p, uint32_t index)
{
    for (uint32_t i = index; i < p->job_count; i += THREADS) noh_crowd_job(p->crowd, i);
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

/* Of all sorts, among posts and walls. */
static noh_crowd *made(uint32_t job_count)
{
    static const noh_crowd_obstacle walls[2] = { { { -6.0f, 0.0f }, { 5.0f, 1.0f }, 0.1f },
                                                 { { 8.0f, 8.0f }, { 8.0f, 8.0f }, 1.0f } };
    static const uint32_t flags[5] = { 0, 0, NOH_CROWD_ORCA, NOH_CROWD_FORCES, NOH_CROWD_FLOCK };
    noh_crowd_desc desc;
    uint32_t seed = 3;
    noh_crowd *crowd = NULL;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = AGENTS;
    desc.job_count = job_count;
    desc.origin[0] = desc.origin[1] = -15.0f;
    desc.extent[0] = desc.extent[1] = 30.0f;
    desc.obstacles = walls;
    desc.obstacle_count = 2;
    const size_t bytes = noh_crowd_size(&desc);
    void *memory = malloc(bytes);
    assert_int_equal(noh_crowd_init(memory, bytes, &desc, &crowd, NULL), NOH_OK);
    for (uint32_t i = 0; i < AGENTS; i++) {
        float r[4];
        for (int k = 0; k < 4; k++) {
            seed = seed * 1664525u + 1013904223u;
            r[k] = (float)(seed >> 8) * (30.0f / 16777216.0f) - 15.0f;
        }
        const noh_crowd_agent a = {
            { r[0], r[1] }, { 0.0f, 0.0f }, { r[2], r[3] }, 0.25f, i % 17u ? 1.3f : 0.0f, flags[i % 5u], i
        };
        assert_int_equal(noh_crowd_add(crowd, i, &a, NULL), NOH_OK);
    }
    return crowd;
}

static void step_by_pool(pool *p)
{
    (void)noh_crowd_begin(p->crowd, NOH_CROWD_STEP_TICKS);
    while ((p->job_count = noh_crowd_jobs(p->crowd)) > 0) {
        (void)pthread_barrier_wait(&p->begin);
        run_mine(p, 0);
        (void)pthread_barrier_wait(&p->end);
    }
}

static void four_threads_make_the_bits_of_one(void **state)
{
    noh_crowd *one = made(1);
    pool p = { .crowd = made(7) };
    pthread_t threads[THREADS];
    worker workers[THREADS];
    (void)state;
    assert_int_equal(pthread_barrier_init(&p.begin, NULL, THREADS), 0);
    assert_int_equal(pthread_barrier_init(&p.end, NULL, THREADS), 0);
    for (uint32_t i = 1; i < THREADS; i++) {
        workers[i].pool = &p;
        workers[i].index = i;
        assert_int_equal(pthread_create(&threads[i], NULL, work, &workers[i]), 0);
    }
    for (uint32_t step = 0; step < STEPS; step++) {
        step_by_pool(&p);
        (void)noh_crowd_step(one, NOH_CROWD_STEP_TICKS);
        assert_int_equal(noh_crowd_hash(p.crowd), noh_crowd_hash(one));
    }
    p.job_count = 0;
    (void)pthread_barrier_wait(&p.begin);
    for (uint32_t i = 1; i < THREADS; i++) assert_int_equal(pthread_join(threads[i], NULL), 0);
    (void)pthread_barrier_destroy(&p.begin);
    (void)pthread_barrier_destroy(&p.end);
    free(p.crowd);
    free(one);
}

/* One agent has two neighbours, as far away on either side: the one with the lower id comes first, on whatever side. */
static void ids_break_ties(void **state)
{
    (void)state;
    for (uint32_t turn = 0; turn < 2; turn++) {
        noh_crowd_desc desc = { .agent_max = 64, .origin = { -8.0f, -8.0f }, .extent = { 16.0f, 16.0f } };
        const size_t bytes = noh_crowd_size(&desc);
        noh_crowd *crowd = NULL;
        crowd_runs runs = { .until = 0 };
        uint32_t seen = 0;
        assert_int_equal(noh_crowd_init(malloc(bytes), bytes, &desc, &crowd, NULL), NOH_OK);
        assert_true(crowd->cells.width > 1); /* they are in two cells, so that ranks do not follow ids */
        for (uint32_t i = 0; i < 3; i++) {
            const float x = floorf(crowd->cells.origin.x + crowd->cells.edge) + (float)i - 1.0f;
            const noh_crowd_agent a = { .position = { x, 0.5f }, .radius = 0.25f, .id = turn ? 2u - i : i };
            assert_int_equal(noh_crowd_add(crowd, i, &a, NULL), NOH_OK);
        }
        (void)noh_crowd_begin(crowd, NOH_CROWD_STEP_TICKS);
        (void)noh_crowd_jobs(crowd); /* sorts */
        for (uint32_t rank = 0; rank < 3; rank++) {
            const uint16_t *names = CROWD_CONST(uint16_t, crowd, neighbor) + rank * CROWD_NEIGHBORS;
            const crowd_body *bodies = CROWD_CONST(crowd_body, crowd, body);
            const uint32_t *ids = CROWD_CONST(uint32_t, crowd, id);
            if (ids[CROWD_ITEM(bodies + rank)] != 1u) continue;
            seen++;
            noh_crowd_find_runs(crowd, rank, &runs);
            noh_crowd_see(crowd, rank, &runs);
            for (uint32_t k = 0; k < 2; k++) {
                const uint32_t there = noh_crowd_rank_of(&runs, names[k]);
                assert_int_equal(ids[CROWD_ITEM(bodies + there)], 2u * k);
            }
            assert_int_equal(names[2], CROWD_NO_NEIGHBOR);
        }
        assert_int_equal(seen, 1);
        free(crowd);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = { cmocka_unit_test(four_threads_make_the_bits_of_one),
                                               cmocka_unit_test(ids_break_ties) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
