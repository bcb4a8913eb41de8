/* bench_crowd.c: a hundred heads in one accumulator, each with weights of its own, against
 * one head alone, with all targets active and with few; ten and a thousand heads with few;
 * and how cost grows with pairs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"

#define SAMPLE_NS 1e7
#define HEADS 100u
#define FEW 6u   /* active targets of an expression */
#define STEPS 4u /* quarters of the targets that are active */

typedef struct crowd {
    bench_job *job;
    noh_morph_path path;
    gpu_morph one, many;
    bench_weights weights[STEPS]; /* the last one: all targets */
    uint32_t draws;
} crowd;

typedef struct crowd_work {
    crowd *crowd;
    gpu_morph *morph;
    const bench_weights *weights;
    uint32_t heads;
} crowd_work;

/* New weights for every head, one update. */
static void run_update(void *self, uint32_t frame)
{
    const crowd_work *w = (const crowd_work *)self;
    noh_gl_morph_stats stats;
    for (uint32_t i = 0; i < w->heads; i++) {
        noh_gl_morph_set_weights(w->morph->morph, i, bench_weights_of(w->weights, frame + 7u * i), NULL);
    }
    noh_gl_morph_update(w->morph->morph, &stats);
    if (w->heads > 1) {
        w->crowd->draws = stats.draws;
    }
}

static int open_morph(crowd *c, gpu_morph *m, uint32_t heads)
{
    noh_gl_morph_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = &c->job->mesh;
    desc.mesh_count = 1;
    desc.instance_counts = &heads;
    desc.path = c->path;
    return gpu_morph_open(m, &c->job->g, &desc, c->job->files[0].path);
}

static int can_run(const crowd *c, uint32_t heads)
{
    noh_gl_morph_desc desc;
    noh_gl_morph_plan plan;
    memset(&desc, 0, sizeof desc);
    desc.meshes = &c->job->mesh;
    desc.mesh_count = 1;
    desc.instance_counts = &heads;
    desc.path = c->path;
    return !noh_gl_morph_plan_make(&desc, &c->job->g.caps, &plan, NULL);
}

/* y = fixed + slope x by least squares, and how much of the variance that explains. */
static void fit_line(const double *x, const double *y, uint32_t count, double *slope, double *fixed, double *fit)
{
    double mx = 0.0, my = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        mx += x[i] / count;
        my += y[i] / count;
    }
    for (uint32_t i = 0; i < count; i++) {
        xx += (x[i] - mx) * (x[i] - mx);
        xy += (x[i] - mx) * (y[i] - my);
        yy += (y[i] - my) * (y[i] - my);
    }
    *slope = xx > 0.0 ? xy / xx : 0.0;
    *fixed = my - *slope * mx;
    *fit = xx > 0.0 && yy > 0.0 ? xy * xy / (xx * yy) : 1.0;
}

static void add_slope(crowd *c, const bench_cells *cells)
{
    bench_slope *s = &c->job->slopes[c->job->slope_count++];
    double x[STEPS], y[STEPS], fixed;
    for (uint32_t i = 0; i < STEPS; i++) {
        x[i] = c->weights[i].pairs * HEADS;
        y[i] = bench_median(cells, 1u + i);
    }
    snprintf(s->path, sizeof s->path, "%s-f32", noh_morph_path_name(c->path));
    fit_line(x, y, STEPS, &s->ns_per_pair, &fixed, &s->fit);
    s->fixed_us = 1e-3 * fixed / HEADS;
    s->draws = c->draws;
}

static int measure(crowd *c)
{
    crowd_work works[1 + STEPS] = { { c, &c->one, &c->weights[STEPS - 1u], 1 } };
    bench_cells cells;
    char name[64];
    int status;
    memset(&cells, 0, sizeof cells);
    snprintf(name, sizeof name, "crowd/100-heads/%s-f32", noh_morph_path_name(c->path));
    bench_add_cell(&cells, run_update, &works[0]);
    for (uint32_t i = 0; i < STEPS; i++) {
        crowd_work w = { c, &c->many, &c->weights[i], HEADS };
        works[1 + i] = w;
        bench_add_cell(&cells, run_update, &works[1 + i]);
    }
    status = bench_run_cells(&cells, &c->job->gl_clock, c->job->rounds, SAMPLE_NS, name);
    if (!status) {
        double one = 1e-3 * bench_median(&cells, 0), head = 1e-3 * bench_median(&cells, STEPS) / HEADS;
        bench_add_row(&c->job->rows, name, "one-head", one, head, "us/head", cells.rounds);
        add_slope(c, &cells);
    }
    bench_free_cells(&cells);
    return status;
}

/* One head and many heads with this many active targets. */
static int measure_few(crowd *c, uint32_t heads, uint32_t active)
{
    bench_weights weights;
    crowd_work works[2] = { { c, &c->one, &weights, 1 }, { c, &c->many, &weights, heads } };
    bench_cells cells;
    char name[64];
    int status = bench_weights_open(&weights, &c->job->mesh, active);
    if (status) return status;
    memset(&cells, 0, sizeof cells);
    snprintf(name, sizeof name, "crowd/%u-heads/%u-active/%s-f32", (unsigned)heads, (unsigned)active,
             noh_morph_path_name(c->path));
    for (int i = 0; i < 2; i++) bench_add_cell(&cells, run_update, &works[i]);
    status = bench_run_cells(&cells, &c->job->gl_clock, c->job->rounds, SAMPLE_NS, name);
    if (!status) {
        bench_add_row(&c->job->rows, name, "one-head", 1e-3 * bench_median(&cells, 0),
                      1e-3 * bench_median(&cells, 1) / heads, "us/head", cells.rounds);
    }
    bench_free_cells(&cells);
    bench_weights_close(&weights);
    return status;
}

static int bench_path(crowd *c)
{
    static const uint32_t few[] = { 2, FEW, 34 }, others[] = { 10, 1000 };
    int status = open_morph(c, &c->one, 1);
    if (!status) {
        status = open_morph(c, &c->many, HEADS);
    }
    if (!status) {
        status = measure(c);
    }
    for (size_t i = 0; i < sizeof few / sizeof few[0] && !status; i++) {
        if (c->job->mesh.header->target_count >= few[i] && !c->job->quick) status = measure_few(c, HEADS, few[i]);
    }
    gpu_morph_close(&c->many);
    for (size_t i = 0; i < sizeof others / sizeof others[0] && !status && !c->job->quick; i++) {
        if (c->job->mesh.header->target_count < FEW || !can_run(c, others[i])) continue;
        status = open_morph(c, &c->many, others[i]);
        if (!status) status = measure_few(c, others[i], FEW);
        gpu_morph_close(&c->many);
    }
    gpu_morph_close(&c->one);
    return status;
}

int bench_crowd(bench_job *job)
{
    static const noh_morph_path paths[] = { NOH_MORPH_LAYERED, NOH_MORPH_MRT, NOH_MORPH_PER_LAYER,
                                            NOH_MORPH_GATHER,  NOH_MORPH_CPU, NOH_MORPH_DIRECT };
    crowd c;
    int status = 0;
    memset(&c, 0, sizeof c);
    c.job = job;
    for (uint32_t i = 0; i < STEPS && !status; i++) {
        uint32_t active = ((i + 1u) * job->mesh.header->target_count + STEPS - 1u) / STEPS;
        status = bench_weights_open(&c.weights[i], &job->mesh, active);
    }
    for (size_t p = 0; p < sizeof paths / sizeof paths[0] && !status; p++) {
        c.path = paths[p];
        if (can_run(&c, HEADS)) {
            status = bench_path(&c);
        }
    }
    for (uint32_t i = 0; i < STEPS; i++) {
        bench_weights_close(&c.weights[i]);
    }
    return status;
}
