/* bench_crowd_frame.c: rows crowd/cpu and crowd/gpu: a frame of 1,000 bodies over 100 m (tools/noh/crowd/crowd.h), at
 * several allowed errors in pixels, against the same frame without LOD. None where a pack has no skinned mesh with
 * levels, or no clips.
 *
 * The CPU's part ends with palettes and weights handed to the library; the GPU's is accumulation, upload and draws up
 * to glFinish, into 1280 x 720 pixels of four samples. On a software rasteriser the GPU's part is a whole frame less
 * the CPU's part, in process CPU time. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "crowd/crowd.h"
#include "gpu/canvas.h"
#include "cli/message.h"

#define SAMPLE_NS 2e7
#define BODIES 1000u
#define BODIES_QUICK 50u
#define GPU_ROUNDS 5u    /* llvmpipe takes seconds for a frame */
#define FRAME_TICKS 800u /* 60 frames a second */
#define EVENT_FRAMES 120u
#define WIDTH 1280u
#define HEIGHT 720u

/* One crowd and its memory. */
typedef struct stand {
    crowd_plan plan;
    crowd crowd;
    void *memory;
    int is_open;
} stand;

/* The last but one is without LOD; the last is the same crowd with invisible bodies drawn too. */
static const float knobs[] = { 1.0f, 2.0f, 4.0f, 16.0f };
#define KNOBS (sizeof knobs / sizeof knobs[0])
#define PLAIN KNOBS
#define UNCULLED (KNOBS + 1u)
#define VARIANTS (KNOBS + 2u)

typedef struct fair {
    bench_job *job;
    stand stands[KNOBS + 1u];
    canvas canvas;
    int has_canvas;
} fair;

typedef struct fair_work {
    fair *fair;
    crowd *crowd;
    crowd_camera camera;
    int unculled;
} fair_work;

/* ---- what is timed ---- */

static void run_cpu(void *self, uint32_t frame)
{
    const fair_work *w = self;
    (void)frame;
    w->crowd->unculled = w->unculled;
    crowd_step(w->crowd, FRAME_TICKS);
    crowd_look(w->crowd, &w->camera);
    crowd_show(w->crowd);
}

static void run_frame(void *self, uint32_t frame)
{
    const fair_work *w = self;
    run_cpu(self, frame);
    crowd_send(w->crowd);
    canvas_begin(&w->fair->canvas);
    crowd_draw(w->crowd, &w->camera);
}

/* ---- making ---- */

static int open_stand(fair *f, uint32_t i)
{
    gpu *g = &f->job->g;
    stand *s = &f->stands[i];
    crowd_options o;
    int status;
    memset(&o, 0, sizeof o);
    o.count = f->job->quick ? BODIES_QUICK : BODIES;
    o.width = WIDTH;
    o.height = HEIGHT;
    o.plain = i == PLAIN;
    o.pixels = o.plain ? 0.0f : knobs[i];
    status = crowd_plan_make(&s->plan, &f->job->files[0], &g->caps, &o);
    if (!status) {
        s->memory = malloc((size_t)s->plan.cpu_bytes);
        status = s->memory ? 0 : tool_fail("bench", "out of memory");
    }
    if (!status) {
        status = crowd_open(&s->crowd, &s->plan, s->memory, (size_t)s->plan.cpu_bytes, g, &f->job->files[0]);
        s->is_open = !status;
    }
    if (!status &&
        (s->crowd.used_bytes != s->plan.cpu_bytes || noh_gl_ledger_bytes(&s->crowd.ledger) != s->plan.gpu_bytes)) {
        status = tool_fail("bench", "a crowd takes another number of bytes than planned");
    }
    return status;
}

static int fair_open(fair *f)
{
    int status = canvas_open(&f->canvas, &f->job->g, WIDTH, HEIGHT);
    f->has_canvas = !status;
    for (uint32_t i = 0; i <= PLAIN && !status; i++) {
        status = open_stand(f, i);
    }
    return status;
}

static void fair_close(fair *f)
{
    for (uint32_t i = 0; i <= PLAIN; i++) {
        if (f->stands[i].is_open) {
            crowd_close(&f->stands[i].crowd);
        }
        free(f->stands[i].memory);
    }
    if (f->has_canvas) {
        canvas_close(&f->canvas);
    }
}

static void make_work(fair *f, uint32_t variant, fair_work *w)
{
    w->fair = f;
    w->crowd = &f->stands[variant < PLAIN ? variant : PLAIN].crowd;
    w->camera = crowd_camera_start(w->crowd);
    w->unculled = variant == UNCULLED;
}

/* ---- checks ---- */

/* All crowds get the same events from the same start. */
static int check_events(fair *f)
{
    const crowd_events *expected = &f->stands[PLAIN].crowd.events;
    for (uint32_t i = 0; i <= PLAIN; i++) {
        fair_work w;
        make_work(f, i, &w);
        for (uint32_t frame = 0; frame < EVENT_FRAMES; frame++) {
            run_cpu(&w, frame);
        }
    }
    for (uint32_t i = 0; i < PLAIN; i++) {
        const crowd_events *got = &f->stands[i].crowd.events;
        if (!expected->count || got->count != expected->count || got->sum != expected->sum) {
            return tool_fail("bench", "crowd: %llu events with LOD, %llu without", (unsigned long long)got->count,
                             (unsigned long long)expected->count);
        }
    }
    f->job->crowd_events = expected->count;
    return 0;
}

static void note_memory(fair *f)
{
    for (uint32_t i = 0; i <= PLAIN; i++) {
        bench_memory *m = &f->job->memories[f->job->memory_count++];
        const stand *s = &f->stands[i];
        if (i == PLAIN) {
            snprintf(m->name, sizeof m->name, "crowd, without LOD");
        } else {
            snprintf(m->name, sizeof m->name, "crowd, %g pixel%s", (double)knobs[i], knobs[i] > 1.0f ? "s" : "");
        }
        m->planned_cpu = s->plan.cpu_bytes;
        m->planned_gpu = s->plan.gpu_bytes;
        m->cpu = s->crowd.used_bytes;
        m->gpu = noh_gl_ledger_bytes(&s->crowd.ledger);
    }
}

/* ---- rows ---- */

/* Both baselines for each allowed error. cost[VARIANTS] in nanoseconds a frame. */
static void add_rows(fair *f, const char *part, const double *cost, uint32_t rounds)
{
    for (uint32_t i = 0; i < KNOBS; i++) {
        char name[64];
        snprintf(name, sizeof name, "crowd/%s/%g-pixel%s", part, (double)knobs[i], knobs[i] > 1.0f ? "s" : "");
        bench_add_row(&f->job->rows, name, "without-detail", cost[PLAIN] * 1e-6, cost[i] * 1e-6, "ms/frame", rounds);
        bench_add_row(&f->job->rows, name, "without-detail, unculled", cost[UNCULLED] * 1e-6, cost[i] * 1e-6,
                      "ms/frame", rounds);
    }
}

/* Time one part of all variants; cost[VARIANTS] in nanoseconds. */
static int measure(fair *f, void (*run)(void *, uint32_t), bench_clock *clock, uint32_t rounds, const char *what,
                   double *cost)
{
    fair_work works[VARIANTS];
    bench_cells cells;
    int status;
    memset(&cells, 0, sizeof cells);
    for (uint32_t i = 0; i < VARIANTS; i++) {
        make_work(f, i, &works[i]);
        bench_add_cell(&cells, run, &works[i]);
    }
    status = bench_run_cells(&cells, clock, rounds, SAMPLE_NS, what);
    for (uint32_t i = 0; i < VARIANTS && !status; i++) {
        cost[i] = bench_median(&cells, i);
    }
    bench_free_cells(&cells);
    return status;
}

static int measure_all(fair *f)
{
    bench_job *job = f->job;
    const uint32_t gpu_rounds = job->rounds < GPU_ROUNDS ? job->rounds : GPU_ROUNDS;
    double cpu[VARIANTS], drawn[VARIANTS];
    int status = measure(f, run_cpu, &job->cpu_clock, job->rounds, "crowd/cpu", cpu);
    if (!status) status = measure(f, run_frame, &job->gl_clock, gpu_rounds, "crowd/gpu", drawn);
    for (uint32_t i = 0; i < VARIANTS && !status && !job->gl_clock.is_gpu; i++) {
        drawn[i] -= cpu[i];
    }
    if (!status) {
        add_rows(f, "cpu", cpu, job->rounds);
        add_rows(f, "gpu", drawn, gpu_rounds);
    }
    return status;
}

/* A mesh with joints and levels, and clips for it. */
static int has_crowd(const noh_pack *pack)
{
    int found = 0;
    for (uint32_t i = 0; i < pack->mesh_count; i++) {
        noh_mesh mesh;
        noh_pack_mesh_at(pack, i, &mesh, NULL);
        found |= mesh.header->skin != NOH_NONE && mesh.header->level_count > 1u;
    }
    return found && pack->clip_count;
}

int bench_crowd_frame(bench_job *job)
{
    fair *f;
    int status;
    if (!has_crowd(&job->files[0].pack)) {
        return 0;
    }
    f = calloc(1, sizeof *f);
    if (!f) {
        return tool_fail("bench", "out of memory");
    }
    f->job = job;
    status = fair_open(f);
    if (!status) status = check_events(f);
    if (!status) status = measure_all(f);
    if (!status) note_memory(f);
    fair_close(f);
    free(f);
    return status;
}
