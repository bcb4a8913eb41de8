/* bench_morph.c: the rows about one mesh: above the unmorphed mesh with rasterisation
 * discarded, and whole frames. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"

#define SAMPLE_NS 1e7
#define METHODS_MAX 21 /* one floor, five baselines, 13 paths and formats, and two that are not here */
#define FLOOR 0        /* methods[FLOOR] is the mesh that is not morphed */

typedef enum work_kind { WORK_ONE_PASS, WORK_THREE_PASS, WORK_FRAME } work_kind;

typedef struct work {
    bench_stage *stage;
    const bench_method *method;
    const bench_weights *weights;
    work_kind kind;
} work;

typedef struct morph_job {
    bench_job *job;
    bench_stage stage;
    bench_method methods[METHODS_MAX];
    int method_count;
    uint32_t active; /* targets of the rows that are measured */
} morph_job;

static void run_frame(void *self, uint32_t frame)
{
    const work *w = (const work *)self;
    if (w->method->prepare) {
        w->method->prepare(w->method->self, bench_weights_of(w->weights, frame));
    }
    if (w->kind == WORK_FRAME) {
        bench_draw_frame(w->stage, w->method);
    } else {
        bench_draw_discarded(w->stage, w->method, w->kind == WORK_THREE_PASS);
    }
}

/* ---- methods ---- */

/* Check a method whose open returned `status`, and add it; one that this GL lacks is left out. */
static int take(morph_job *j, int status)
{
    bench_method *m = &j->methods[j->method_count];
    if (status < 0) {
        return 0;
    }
    j->method_count += 1;
    if (status || m == &j->methods[FLOOR]) {
        return status;
    }
    return bench_check(&j->stage, m, j->job->files[0].path);
}

static int open_methods(morph_job *j)
{
    static const noh_morph_path paths[] = { NOH_MORPH_LAYERED, NOH_MORPH_MRT, NOH_MORPH_PER_LAYER, NOH_MORPH_GATHER,
                                            NOH_MORPH_DIRECT,  NOH_MORPH_CPU, NOH_MORPH_STREAMS };
    int status = take(j, bench_open_unmorphed(&j->methods[FLOOR], &j->stage));
    for (int loop = BENCH_LOOP_ALL; loop <= BENCH_LOOP_ACTIVE && !status; loop++) {
        status = take(j, bench_open_dense(&j->methods[j->method_count], &j->stage, (bench_loop)loop));
    }
    if (!status) status = take(j, bench_open_filament(&j->methods[j->method_count], &j->stage));
    if (!status) status = take(j, bench_open_quads(&j->methods[j->method_count], &j->stage, j->job->artist));
    if (!status) {
        status = take(j,
                      bench_open_path(&j->methods[j->method_count], &j->stage, NOH_MORPH_CPU, NOH_ACCUMULATE_F32, 1));
    }
    for (int a = NOH_ACCUMULATE_F32; a <= NOH_ACCUMULATE_F16; a++) {
        for (size_t p = 0; p < sizeof paths / sizeof paths[0] && !status; p++) {
            status = take(j, bench_open_path(&j->methods[j->method_count], &j->stage, paths[p], (noh_accumulate)a, 0));
        }
    }
    return status;
}

/* ---- rows ---- */

typedef struct measured {
    bench_cells cells;
    work works[METHODS_MAX];
    double cost[METHODS_MAX]; /* microseconds: above the floor, or of whole frames */
    uint32_t runs;
} measured;

static int measure(morph_job *j, const bench_weights *weights, work_kind kind, const char *what, measured *m)
{
    int status;
    memset(m, 0, sizeof *m);
    for (int i = 0; i < j->method_count; i++) {
        work w = { &j->stage, &j->methods[i], weights, kind };
        m->works[i] = w;
        bench_add_cell(&m->cells, run_frame, &m->works[i]);
    }
    status = bench_run_cells(&m->cells, &j->job->gl_clock, j->job->rounds, SAMPLE_NS, what);
    for (int i = 0; i < j->method_count && !status; i++) {
        uint32_t cell = (uint32_t)i;
        m->cost[i] = 1e-3 *
                     (kind == WORK_FRAME ? bench_median(&m->cells, cell) : bench_median_above(&m->cells, cell, FLOOR));
    }
    m->runs = m->cells.rounds;
    bench_free_cells(&m->cells);
    return status;
}

/* What a row is compared with: baselines, and for draws that sum, the pass that does it for them. */
static int is_compared(const bench_method *m, const bench_method *with)
{
    return with->is_baseline || (strcmp(m->name, "direct-f32") == 0 && strcmp(with->name, "gather-f32") == 0);
}

/* Every method against every baseline but itself; the floor is a baseline of whole frames only. */
static void add_rows(morph_job *j, const measured *m, const char *prefix, int with_floor)
{
    for (int i = 1; i < j->method_count; i++) {
        char name[64];
        if (j->methods[i].most_targets && j->methods[i].most_targets < j->active) continue;
        snprintf(name, sizeof name, "%s/%s", prefix, j->methods[i].name);
        for (int b = with_floor ? FLOOR : FLOOR + 1; b < j->method_count; b++) {
            if (b != i && is_compared(&j->methods[i], &j->methods[b])) {
                bench_add_row(&j->job->rows, name, b == FLOOR ? "unmorphed" : j->methods[b].name, m->cost[b],
                              m->cost[i], "us", m->runs);
            }
        }
    }
}

/* The names of the rows for a number of active targets; NULL: none of this kind. */
typedef struct row_names {
    const char *of[3]; /* by work_kind */
} row_names;

static const row_names names_of_all = { { "morph/one-pass", "morph/three-pass", "frame" } };
static const row_names names_of_34 = { { "morph/34-active/one-pass", "morph/34-active/three-pass", NULL } };

static int measure_rows(morph_job *j, const bench_weights *weights, work_kind kind, const char *prefix)
{
    measured *m = malloc(sizeof *m);
    int status = m ? measure(j, weights, kind, prefix, m) : tool_fail("bench", "out of memory");
    if (!status) add_rows(j, m, prefix, kind == WORK_FRAME);
    /* 34 targets that are all there are have both names */
    if (!status && prefix == names_of_all.of[kind] && j->active == 34u && names_of_34.of[kind]) {
        add_rows(j, m, names_of_34.of[kind], 0);
    }
    free(m);
    return status;
}

static int measure_active(morph_job *j, uint32_t active, const row_names *names)
{
    bench_weights weights;
    int status;
    j->active = active;
    status = bench_weights_open(&weights, j->stage.mesh, active);
    for (int kind = WORK_ONE_PASS; kind <= WORK_FRAME && !status; kind++) {
        if (names->of[kind]) status = measure_rows(j, &weights, (work_kind)kind, names->of[kind]);
    }
    bench_weights_close(&weights);
    return status;
}

/* All targets; then four, two, six and 34 of more. */
static int measure_all(morph_job *j)
{
    static const struct few {
        uint32_t active;
        row_names names;
    } fews[] = {
        { 4, { { "morph/4-active/one-pass", "morph/4-active/three-pass", "frame/4-active" } } },
        { 2, { { "morph/2-active/one-pass", "morph/2-active/three-pass", NULL } } },
        { 6, { { "morph/6-active/one-pass", "morph/6-active/three-pass", NULL } } },
    };
    const uint32_t targets = j->stage.mesh->header->target_count;
    int status = measure_active(j, targets, &names_of_all);
    for (size_t i = 0; i < sizeof fews / sizeof fews[0] && !status; i++) {
        if (targets > fews[i].active && !(i && j->job->quick)) {
            status = measure_active(j, fews[i].active, &fews[i].names);
        }
    }
    if (!status && targets > 34u && !j->job->quick) status = measure_active(j, 34, &names_of_34);
    return status;
}

int bench_morph(bench_job *job)
{
    morph_job j;
    int status;
    memset(&j, 0, sizeof j);
    j.job = job;
    status = bench_stage_open(&j.stage, &job->g, &job->mesh);
    if (status) {
        return status;
    }
    status = open_methods(&j);
    if (!status) {
        status = measure_all(&j);
    }
    for (int i = 0; i < j.method_count; i++) {
        bench_method_close(&j.stage, &j.methods[i]);
    }
    bench_stage_close(&j.stage);
    if (!status && job->g.gl.GetError() != GL_NO_ERROR) {
        return tool_fail(job->files[0].path, "a GL error while measuring");
    }
    return status;
}
