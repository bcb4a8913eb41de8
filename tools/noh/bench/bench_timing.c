/* bench_timing.c: cells timed in interleaved rounds. Slow disturbances hit all cells of a round alike, and the median
 * drops those that hit only one. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench_job.h"
#include "cli/message.h"

#define REPEATS_MAX 100000u
#define PROGRESS_NS 1000000000u
#define GROUP_NS 6000000000u /* a group of cells that takes longer than this gets fewer rounds, */
#define ROUNDS_MIN 5u        /* but not fewer than these */

/* ---- clocks ---- */

/* A software rasteriser runs on this CPU: its time is CPU time. */
static int is_software(const noh_gl_caps *caps)
{
    static const char *const names[] = { "llvmpipe", "softpipe", "SwiftShader", "swrast" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strstr(caps->renderer, names[i])) {
            return 1;
        }
    }
    return 0;
}

void bench_clock_open(bench_clock *clock, gpu *g)
{
    memset(clock, 0, sizeof *clock);
    clock->what = "process CPU time";
    if (!g) {
        return;
    }
    clock->gl = &g->gl;
    if (!is_software(&g->caps) && g->caps.timer_query) {
        noh_gl_timer_init(&clock->gpu, &g->gl, &g->caps);
        clock->is_gpu = clock->gpu.available;
        clock->what = clock->is_gpu ? "GPU time" : clock->what;
    }
}

void bench_clock_close(bench_clock *clock)
{
    if (clock->is_gpu) {
        noh_gl_timer_delete(&clock->gpu, clock->gl);
    }
    clock->is_gpu = 0;
}

static void finish(const bench_clock *clock)
{
    if (clock->gl) {
        clock->gl->Finish();
    }
}

/* Wait until the GL has finished. */
static void repeat(bench_cell *cell, const bench_clock *clock)
{
    for (uint32_t i = 0; i < cell->repeats; i++) {
        cell->work(cell->self, cell->frame++);
        finish(clock);
    }
}

/* 0 where the GPU's clock was disjoint and the time is void. */
static double time_on_gpu(bench_cell *cell, bench_clock *clock)
{
    uint64_t elapsed = 0;
    noh_gl_timer_begin(&clock->gpu, clock->gl);
    for (uint32_t i = 0; i < cell->repeats; i++) {
        cell->work(cell->self, cell->frame++);
        clock->gl->Flush();
    }
    noh_gl_timer_end(&clock->gpu, clock->gl);
    finish(clock);
    for (uint64_t until = noh_clock_ns() + PROGRESS_NS; noh_clock_ns() < until;) {
        noh_result result = noh_gl_timer_poll(&clock->gpu, clock->gl, &elapsed);
        if (result != NOH_ERR_NOT_FOUND) {
            return result ? 0.0 : (double)elapsed;
        }
    }
    return 0.0;
}

static double time_cell(bench_cell *cell, bench_clock *clock)
{
    uint64_t from;
    if (clock->is_gpu) {
        double elapsed = 0.0;
        for (int tries = 0; tries < 8 && elapsed <= 0.0; tries++) {
            elapsed = time_on_gpu(cell, clock);
        }
        return elapsed;
    }
    from = noh_cpu_clock_ns();
    repeat(cell, clock);
    return (double)(noh_cpu_clock_ns() - from);
}

/* ---- cells ---- */

uint32_t bench_add_cell(bench_cells *cells, void (*work)(void *self, uint32_t frame), void *self)
{
    if (cells->count == cells->capacity) {
        uint32_t capacity = cells->capacity ? 2 * cells->capacity : 32;
        bench_cell *grown = realloc(cells->cells, capacity * sizeof *grown);
        if (!grown) {
            cells->failed = 1;
            return 0;
        }
        cells->cells = grown;
        cells->capacity = capacity;
    }
    memset(&cells->cells[cells->count], 0, sizeof *cells->cells);
    cells->cells[cells->count].work = work;
    cells->cells[cells->count].self = self;
    return cells->count++;
}

static void calibrate(bench_cell *cell, bench_clock *clock, double sample_ns)
{
    cell->repeats = 1;
    time_cell(cell, clock); /* the first time compiles shaders and touches memory */
    for (;;) {
        double elapsed = time_cell(cell, clock), wanted;
        if (elapsed >= sample_ns || cell->repeats >= REPEATS_MAX) {
            return;
        }
        wanted = elapsed > 0.0 ? 1.2 * sample_ns / elapsed * cell->repeats : 8.0 * cell->repeats;
        wanted = wanted > 8.0 * cell->repeats ? 8.0 * cell->repeats : wanted;
        wanted = wanted > REPEATS_MAX ? REPEATS_MAX : wanted;
        cell->repeats = (uint32_t)wanted > cell->repeats ? (uint32_t)wanted : cell->repeats + 1u;
    }
}

static void show_progress(const char *what, uint32_t round, uint32_t rounds, uint64_t start, int *shown)
{
    if (isatty(STDERR_FILENO) && noh_clock_ns() - start > PROGRESS_NS) {
        fprintf(stderr, "\r\033[K%s: round %u of %u", what, round, rounds);
        fflush(stderr);
        *shown = 1;
    }
}

int bench_run_cells(bench_cells *cells, bench_clock *clock, uint32_t rounds, double sample_ns, const char *what)
{
    uint64_t start = noh_clock_ns();
    int shown = 0;
    cells->rounds = rounds;
    for (uint32_t i = 0; i < cells->count && !cells->failed; i++) {
        cells->cells[i].samples = calloc(rounds, sizeof(double));
        cells->failed |= !cells->cells[i].samples;
        calibrate(&cells->cells[i], clock, sample_ns);
        show_progress(what, 0, rounds, start, &shown);
    }
    for (uint32_t r = 0; r < rounds && !cells->failed; r++) {
        for (uint32_t i = 0; i < cells->count; i++) {
            bench_cell *cell = &cells->cells[(i + r) % cells->count]; /* vary which cell precedes which */
            cell->samples[r] = time_cell(cell, clock) / cell->repeats;
            show_progress(what, r + 1, rounds, start, &shown);
        }
        if (r + 1 >= ROUNDS_MIN && noh_clock_ns() - start > GROUP_NS) {
            cells->rounds = r + 1;
            break;
        }
    }
    if (shown) {
        fputs("\r\033[K", stderr);
    }
    return cells->failed ? tool_fail("bench", "out of memory") : 0;
}

void bench_free_cells(bench_cells *cells)
{
    for (uint32_t i = 0; i < cells->count; i++) {
        free(cells->cells[i].samples);
    }
    free(cells->cells);
    memset(cells, 0, sizeof *cells);
}

/* ---- medians ---- */

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

double bench_median_of(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return count & 1u ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

#define ROUNDS_MAX 1024u /* no fewer than --rounds allows */

double bench_median_above(const bench_cells *cells, uint32_t cell, uint32_t floor)
{
    double values[ROUNDS_MAX];
    for (uint32_t r = 0; r < cells->rounds; r++) {
        values[r] = cells->cells[cell].samples[r] - cells->cells[floor].samples[r];
    }
    return bench_median_of(values, cells->rounds);
}

double bench_low_tenth(const bench_cells *cells, uint32_t cell)
{
    double values[ROUNDS_MAX];
    memcpy(values, cells->cells[cell].samples, cells->rounds * sizeof *values);
    qsort(values, cells->rounds, sizeof *values, compare_doubles);
    return values[cells->rounds / 10u];
}

double bench_median(const bench_cells *cells, uint32_t cell)
{
    double values[ROUNDS_MAX];
    memcpy(values, cells->cells[cell].samples, cells->rounds * sizeof *values);
    return bench_median_of(values, cells->rounds);
}
