/* bench_ear.c: row face/ear: a hundredth of a second of sound heard, against one frame of the mesh as it is drawn. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "noh/face.h"
#include "noh/noh_gl.h"

#define SAMPLE_NS 1e7
#define RATE 16000u
#define HOP (RATE / NOH_EAR_FRAME_RATE)
#define SECONDS 2u

typedef struct ear_bench {
    bench_stage stage;
    bench_method method;
    bench_weights weights;
    noh_ear ear;
    int16_t sound[RATE * SECONDS];
    volatile float seen; /* keeps the results alive */
} ear_bench;

/* A voice of sorts: a saw whose pitch and loudness wander. */
static void make_sound(ear_bench *b)
{
    uint32_t phase = 0;
    for (uint32_t i = 0; i < RATE * SECONDS; i++) {
        const uint32_t at = i * 64u / RATE;
        phase += (100u + at * 37u % 60u) * (65536u * 256u / RATE);
        b->sound[i] = (int16_t)(((int32_t)(phase >> 8 & 65535u) - 32768) * (int32_t)(at * 29u % 16u) / 40);
    }
}

static void run_ear(void *self, uint32_t frame)
{
    ear_bench *b = self;
    const int16_t *sound = b->sound + frame % (NOH_EAR_FRAME_RATE * SECONDS) * HOP;
    noh_ear_frame heard;
    for (size_t at = 0; at < HOP;) {
        at += noh_ear_hear(&b->ear, sound + at, HOP - at);
        while (noh_ear_next(&b->ear, &heard)) b->seen = heard.open;
    }
}

static void run_draw(void *self, uint32_t frame)
{
    ear_bench *b = self;
    if (b->method.prepare) b->method.prepare(b->method.self, bench_weights_of(&b->weights, frame));
    bench_draw_frame(&b->stage, &b->method);
}

/* The first path that this GL has. */
static int open_path(ear_bench *b)
{
    static const noh_morph_path paths[] = { NOH_MORPH_LAYERED, NOH_MORPH_MRT, NOH_MORPH_PER_LAYER, NOH_MORPH_GATHER,
                                            NOH_MORPH_CPU };
    int status = -1;
    for (size_t p = 0; p < sizeof paths / sizeof paths[0] && status < 0; p++) {
        status = bench_open_path(&b->method, &b->stage, paths[p], NOH_ACCUMULATE_F32, paths[p] == NOH_MORPH_CPU);
    }
    return status < 0 ? tool_fail("bench", "this GL supports no path that can draw the mesh") : status;
}

static int measure(bench_job *job, ear_bench *b)
{
    bench_cells heard, drawn;
    char baseline[32];
    int status;
    memset(&heard, 0, sizeof heard);
    memset(&drawn, 0, sizeof drawn);
    bench_add_cell(&heard, run_ear, b);
    bench_add_cell(&drawn, run_draw, b);
    status = bench_run_cells(&heard, &job->cpu_clock, job->rounds, SAMPLE_NS, "face/ear");
    if (!status) status = bench_run_cells(&drawn, &job->gl_clock, job->rounds, SAMPLE_NS, "face/ear");
    snprintf(baseline, sizeof baseline, "frame/%.20s", b->method.name);
    if (!status) {
        bench_add_row(&job->rows, "face/ear", baseline, 1e-3 * bench_median(&drawn, 0), 1e-3 * bench_median(&heard, 0),
                      "us", heard.rounds);
    }
    bench_free_cells(&heard);
    bench_free_cells(&drawn);
    return status;
}

int bench_ear(bench_job *job)
{
    ear_bench *b = calloc(1, sizeof *b);
    int status = b ? bench_stage_open(&b->stage, &job->g, &job->mesh) : tool_fail("bench", "out of memory");
    if (status) {
        free(b);
        return status;
    }
    make_sound(b);
    (void)noh_ear_init(&b->ear, RATE, NOH_EAR_LATENCY_MAX_MS, NULL); /* a rate that it takes */
    status = bench_weights_open(&b->weights, &job->mesh, job->mesh.header->target_count);
    if (!status) {
        status = open_path(b);
        if (!status) status = measure(job, b);
        bench_method_close(&b->stage, &b->method);
        bench_weights_close(&b->weights);
    }
    bench_stage_close(&b->stage);
    free(b);
    return status;
}
