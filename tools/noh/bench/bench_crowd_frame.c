/* bench_crowd_frame.c: rows crowd/cpu and crowd/gpu: a frame of 1,000 bodies over 100 m
 * (tools/noh/crowd/crowd_bodies.h), at several allowed errors in pixels, against the same stage without detail. None
 * where a pack has no skinned mesh with levels, or no clips.
 *
 * The CPU's part is a frame on a GL that does nothing. The GPU's is accumulation, upload and draws up to glFinish, into
 * 1280 x 720 pixels of four samples. On a software rasteriser the GPU's part is a whole frame less the CPU's part, in
 * process CPU time. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "crowd/crowd_bodies.h"
#include "gpu/canvas.h"

#define SAMPLE_NS 2e7
#define BODIES 1000u
#define BODIES_QUICK 50u
#define GPU_ROUNDS 5u    /* llvmpipe takes seconds for a frame */
#define FRAME_TICKS 800u /* 60 frames a second */
#define EVENT_FRAMES 120u
#define WIDTH 1280u
#define HEIGHT 720u

/* The last one is without detail. */
static const float knobs[] = { 1.0f, 2.0f, 4.0f, 16.0f };
#define KNOBS (sizeof knobs / sizeof knobs[0])
#define PLAIN KNOBS
#define VARIANTS (KNOBS + 1u)

typedef struct fair {
    bench_job *job;
    crowd crowds[VARIANTS];
    uint32_t open_count;
    canvas *canvas; /* NULL: nothing is drawn */
} fair;

typedef struct fair_work {
    fair *fair;
    crowd *crowd;
    noh_stage_view camera;
} fair_work;

/* ---- timed code ---- */

static void run_frame(void *self, uint32_t frame)
{
    const fair_work *w = self;
    (void)frame;
    crowd_frame(w->crowd, FRAME_TICKS, &w->camera);
    if (w->fair->canvas) {
        canvas_begin(w->fair->canvas);
        crowd_draw(w->crowd);
    }
}

/* ---- making ---- */

static int open_crowd(fair *f, gpu *g, uint32_t i)
{
    crowd_options o;
    crowd *c = &f->crowds[i];
    int status;
    memset(&o, 0, sizeof o);
    o.count = f->job->quick ? BODIES_QUICK : BODIES;
    o.width = WIDTH;
    o.height = HEIGHT;
    o.plain = i == PLAIN;
    o.pixels = o.plain ? 0.0f : knobs[i];
    status = crowd_open(c, g, &f->job->files[0], &o);
    f->open_count += !status;
    if (!status && noh_gl_ledger_bytes(&c->ledger) != c->plan.gpu_bytes) {
        status = tool_fail("bench", "a crowd takes a different number of bytes than planned");
    }
    return status;
}

static int fair_open(fair *f, gpu *g, canvas *to)
{
    int status = 0;
    f->canvas = to;
    f->open_count = 0;
    for (uint32_t i = 0; i < VARIANTS && !status; i++) status = open_crowd(f, g, i);
    return status;
}

static void fair_close(fair *f)
{
    while (f->open_count) crowd_close(&f->crowds[--f->open_count]);
}

static void make_work(fair *f, uint32_t variant, fair_work *w)
{
    w->fair = f;
    w->crowd = &f->crowds[variant];
    w->camera = crowd_camera_start(w->crowd);
}

/* ---- checks ---- */

static int expect_same_time(const crowd *c, const crowd *plain)
{
    if (c->events.count != plain->events.count || c->events.sum != plain->events.sum) {
        return tool_fail("bench", "crowd: %llu events with detail, %llu without", (unsigned long long)c->events.count,
                         (unsigned long long)plain->events.count);
    }
    for (uint32_t b = 0; b < c->options.count; b++) {
        const noh_track *here = noh_actor_track(c->stage, noh_stage_actor_at(c->stage, b), 0),
                        *there = noh_actor_track(plain->stage, noh_stage_actor_at(plain->stage, b), 0);
        if (here && there && here->position != there->position) {
            return tool_fail("bench", "crowd: body %u is at another time with detail than without", b);
        }
    }
    return 0;
}

/* Detail makes no difference to time: from the same start all crowds get the same events, and their clips are at the
 * same positions. */
static int check_time(fair *f)
{
    int status = 0;
    for (uint32_t i = 0; i < VARIANTS; i++) {
        fair_work w;
        make_work(f, i, &w);
        for (uint32_t frame = 0; frame < EVENT_FRAMES; frame++) run_frame(&w, frame);
    }
    for (uint32_t i = 0; i < PLAIN && !status; i++) status = expect_same_time(&f->crowds[i], &f->crowds[PLAIN]);
    f->job->crowd_events = f->crowds[PLAIN].events.count;
    return status;
}

static void note_memory(fair *f)
{
    for (uint32_t i = 0; i < VARIANTS; i++) {
        bench_memory *m = &f->job->memories[f->job->memory_count++];
        const crowd *c = &f->crowds[i];
        if (i == PLAIN) {
            snprintf(m->name, sizeof m->name, "crowd, without LOD");
        } else {
            snprintf(m->name, sizeof m->name, "crowd, %g pixel%s", (double)knobs[i], knobs[i] > 1.0f ? "s" : "");
        }
        m->planned_cpu = m->cpu = c->plan.cpu_bytes; /* noh_stage_init takes exactly these */
        m->planned_gpu = c->plan.gpu_bytes;
        m->gpu = noh_gl_ledger_bytes(&c->ledger);
    }
}

/* ---- rows ---- */

/* cost[VARIANTS] in nanoseconds a frame. */
static void add_rows(fair *f, const char *part, const double *cost, uint32_t rounds)
{
    for (uint32_t i = 0; i < KNOBS; i++) {
        char name[64];
        snprintf(name, sizeof name, "crowd/%s/%g-pixel%s", part, (double)knobs[i], knobs[i] > 1.0f ? "s" : "");
        bench_add_row(&f->job->rows, name, "without-detail", cost[PLAIN] * 1e-6, cost[i] * 1e-6, "ms/frame", rounds);
    }
}

/* Time one part of all variants; cost[VARIANTS] in nanoseconds. */
static int measure(fair *f, bench_clock *clock, uint32_t rounds, const char *what, double *cost)
{
    fair_work works[VARIANTS];
    bench_cells cells;
    int status;
    memset(&cells, 0, sizeof cells);
    for (uint32_t i = 0; i < VARIANTS; i++) {
        make_work(f, i, &works[i]);
        bench_add_cell(&cells, run_frame, &works[i]);
    }
    status = bench_run_cells(&cells, clock, rounds, SAMPLE_NS, what);
    for (uint32_t i = 0; i < VARIANTS && !status; i++) {
        cost[i] = bench_median(&cells, i);
    }
    bench_free_cells(&cells);
    return status;
}

/* On a GL that does nothing. */
static int measure_cpu(fair *f, double *cost)
{
    gpu g;
    int status = gpu_open(&g, "null");
    if (status) {
        return status;
    }
    g.caps.blend_f32 = g.caps.blend_f32_exact = 1; /* or the CPU would accumulate */
    status = fair_open(f, &g, NULL);
    if (!status) status = check_time(f);
    if (!status) status = measure(f, &f->job->cpu_clock, f->job->rounds, "crowd/cpu", cost);
    if (!status) add_rows(f, "cpu", cost, f->job->rounds);
    fair_close(f);
    gpu_close(&g);
    return status;
}

static int measure_gpu(fair *f, const double *cpu)
{
    const uint32_t rounds = f->job->rounds < GPU_ROUNDS ? f->job->rounds : GPU_ROUNDS;
    double drawn[VARIANTS];
    canvas to;
    int status = canvas_open(&to, &f->job->g, WIDTH, HEIGHT);
    if (status) {
        return status;
    }
    status = fair_open(f, &f->job->g, &to);
    if (!status) status = measure(f, &f->job->gl_clock, rounds, "crowd/gpu", drawn);
    for (uint32_t i = 0; i < VARIANTS && !status && !f->job->gl_clock.is_gpu; i++) {
        drawn[i] -= cpu[i];
    }
    if (!status) {
        add_rows(f, "gpu", drawn, rounds);
        note_memory(f);
    }
    fair_close(f);
    canvas_close(&to);
    return status;
}

int bench_crowd_frame(bench_job *job)
{
    double cpu[VARIANTS];
    fair *f;
    int status;
    if (!bench_has_cast(&job->files[0].pack)) {
        return 0;
    }
    f = calloc(1, sizeof *f);
    if (!f) {
        return tool_fail("bench", "out of memory");
    }
    f->job = job;
    status = measure_cpu(f, cpu);
    if (!status) status = measure_gpu(f, cpu);
    free(f);
    return status;
}
