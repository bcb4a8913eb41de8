/* bench_match.c: rows clip/match: the search of motion matching down its tree against the same comparison of all rows,
 * and the groups of eight that it compares, at the 99th percentile. Queries are of an actor that follows a stick. */
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "motion/match/match_internal.h"

#define QUERIES 256u
#define PATH 15u /* features from here on are the path */
#define SAMPLE_NS 5e6

typedef struct match_work {
    noh_match_table table;
    int16_t queries[QUERIES][NOH_MATCH_FEATURES];
    int32_t limits[QUERIES]; /* what plays, less the bias */
    uint32_t costs[QUERIES]; /* groups compared */
    uint32_t wrong;
} match_work;

static uint32_t place_of(const noh_match_table *t, uint32_t row)
{
    uint32_t place = 0;
    while (t->order[place] != row && place + 1u < t->header->row_count) place++;
    return place;
}

/* A stick that points elsewhere ten searches later: the path turns from what plays to what another row does, and what
 * was found plays on. */
static void make_queries(match_work *w)
{
    const noh_match_table *t = &w->table;
    uint32_t seed = 1, row = 0, wanted = 0;
    for (uint32_t i = 0; i < QUERIES; i++) {
        const int32_t share = (int32_t)(i % 10u) < 5 ? (int32_t)(i % 10u) + 1 : 5; /* of 5 */
        int16_t *query = w->queries[i], path[NOH_MATCH_FEATURES];
        noh_match_hit hit;
        seed = seed * 1664525u + 1013904223u;
        if (i % 10u == 0) wanted = (seed >> 8) % t->header->row_count;
        noh_match_row(t, place_of(t, row), query);
        noh_match_row(t, wanted, path);
        for (uint32_t k = PATH; k < NOH_MATCH_FEATURES; k++) {
            query[k] = (int16_t)(query[k] + (path[k] - query[k]) * share / 5);
        }
        noh_match_row(t, place_of(t, row), path);
        w->limits[i] = noh_match_cost(query, path) - NOH_MATCH_UNIT * NOH_MATCH_UNIT;
        hit.cost = w->limits[i];
        noh_match_search(t, query, 0, &hit);
        if (hit.row != NOH_NONE) row = hit.row;
        row = row + 1u < t->header->row_count ? row + 1u : 0u;
    }
}

static void search_tree(void *self, uint32_t frame)
{
    match_work *w = self;
    (void)frame;
    for (uint32_t i = 0; i < QUERIES; i++) {
        noh_match_hit hit = { w->limits[i], NOH_NONE, 0 };
        noh_match_search(&w->table, w->queries[i], 0, &hit);
        w->costs[i] = hit.groups;
    }
}

static void search_all(void *self, uint32_t frame)
{
    match_work *w = self;
    (void)frame;
    for (uint32_t i = 0; i < QUERIES; i++) {
        noh_match_hit hit = { w->limits[i], NOH_NONE, 0 };
        noh_match_search_all(&w->table, w->queries[i], 0, &hit);
        w->wrong += hit.row == NOH_NONE;
    }
}

static int by_value(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

int bench_match(bench_job *job)
{
    match_work *w = calloc(1, sizeof *w);
    bench_cells cells;
    uint32_t file = 0;
    int status = 0;
    if (!w) return tool_fail("bench", "out of memory");
    while (file < job->file_count && !noh_match_table_of(&job->files[file].pack, &w->table)) file++;
    memset(&cells, 0, sizeof cells);
    if (file < job->file_count) {
        make_queries(w);
        bench_add_cell(&cells, search_all, w);
        bench_add_cell(&cells, search_tree, w);
        status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "clip/match");
        if (!status) {
            bench_add_row(&job->rows, "clip/match", "all-rows", bench_median(&cells, 0) / QUERIES,
                          bench_median(&cells, 1) / QUERIES, "ns/search", cells.rounds);
            const uint32_t groups = (w->table.header->row_count + 7u) / 8u, at = QUERIES * 99u / 100u;
            qsort(w->costs, QUERIES, sizeof *w->costs, by_value);
            bench_add_row(&job->rows, "clip/match_groups", "all-rows", groups, w->costs[at], "groups at p99", QUERIES);
        }
    }
    bench_free_cells(&cells);
    free(w);
    return status;
}
