/* bench_cpu.c: rows morph/cpu: the kernels against dense scalar C and against memcpy. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "deform/morph/morph_internal.h"

#define SAMPLE_NS 5e6
#define ATTRIBUTES 9u /* position, normal, tangent */

typedef struct cpu_bench {
    const noh_mesh *mesh;
    bench_weights weights;
    void *layer_memory;
    noh_morph_layers layers;
    size_t layer_bytes;
    float *dense;              /* [target_count][vertex_count][9] */
    float *sums;               /* [vertex_count][9] */
    uint8_t *copy;             /* what memcpy writes */
    const void *volatile seen; /* keeps the results alive */
} cpu_bench;

typedef struct cpu_work {
    cpu_bench *bench;
    noh_morph_kernel kernel;
} cpu_work;

static void run_kernel(void *self, uint32_t frame)
{
    const cpu_work *w = (const cpu_work *)self;
    cpu_bench *b = w->bench;
    memset(b->layer_memory, 0, b->layer_bytes);
    w->kernel.accumulate(b->mesh, bench_weights_of(&b->weights, frame), &b->layers);
    b->seen = b->layer_memory;
}

/* Keep the compiler from vectorising the scalar baseline. */
#if defined(__clang__)
#define SCALAR_LOOP _Pragma("clang loop vectorize(disable) interleave(disable)")
#define SCALAR_FUNCTION
#elif defined(__GNUC__)
#define SCALAR_LOOP
#define SCALAR_FUNCTION __attribute__((optimize("no-tree-vectorize")))
#else
#define SCALAR_LOOP
#define SCALAR_FUNCTION
#endif

SCALAR_FUNCTION static void add_dense(float *restrict sums, const float *restrict deltas, float weight, size_t count)
{
    SCALAR_LOOP
    for (size_t i = 0; i < count; i++) {
        sums[i] += weight * deltas[i];
    }
}

/* The straightforward way: all floats of a target for every vertex; zero weights are skipped. */
static void run_dense(void *self, uint32_t frame)
{
    cpu_bench *b = ((const cpu_work *)self)->bench;
    const float *weights = bench_weights_of(&b->weights, frame);
    size_t count = (size_t)b->mesh->header->vertex_count * ATTRIBUTES;
    memset(b->sums, 0, count * sizeof *b->sums);
    for (uint32_t t = 0; t < b->mesh->header->target_count; t++) {
        if (weights[t] != 0.0f) {
            add_dense(b->sums, b->dense + t * count, weights[t], count);
        }
    }
    b->seen = b->sums;
}

/* The bytes that the kernels read and write at least: the active targets' words, the layers. */
static void run_memcpy(void *self, uint32_t frame)
{
    cpu_bench *b = ((const cpu_work *)self)->bench;
    const float *weights = bench_weights_of(&b->weights, frame);
    memcpy(b->copy, b->layer_memory, b->layer_bytes);
    for (uint32_t t = 0; t < b->mesh->header->target_count; t++) {
        const noh_target *target = &b->mesh->targets[t];
        if (weights[t] != 0.0f) {
            memcpy(b->copy, b->mesh->texels + 3u * (size_t)target->first_texel, 12u * (size_t)target->texel_count);
        }
    }
    b->seen = b->copy;
}

/* ---- making ---- */

static void fill_dense(cpu_bench *b, float *weights)
{
    const noh_mesh_header *h = b->mesh->header;
    for (uint32_t t = 0; t < h->target_count; t++) {
        float *to = b->dense + (size_t)t * h->vertex_count * ATTRIBUTES;
        bench_target_deltas(b->mesh, t, weights, &b->layers);
        for (uint32_t v = 0; v < h->touched_count; v++, to += ATTRIBUTES) {
            memcpy(to, b->layers.position + 3 * (size_t)v, 12);
            memcpy(to + 3, b->layers.normal + 3 * (size_t)v, 12);
            memcpy(to + 6, b->layers.tangent + 3 * (size_t)v, 12);
        }
    }
}

static int cpu_open(cpu_bench *b, const noh_mesh *mesh, uint32_t active)
{
    const noh_mesh_header *h = mesh->header;
    size_t row = (size_t)h->vertex_count * ATTRIBUTES;
    float *weights = calloc(h->target_count + 1u, sizeof *weights);
    int failed = bench_weights_open(&b->weights, mesh, active);
    b->mesh = mesh;
    b->layer_bytes = noh_morph_layers_size(mesh);
    b->layer_memory = malloc(b->layer_bytes + 16u);
    b->dense = calloc(row * h->target_count + 1u, sizeof *b->dense);
    b->sums = calloc(row + 1u, sizeof *b->sums);
    b->copy = calloc(1, b->layer_bytes + 12u * (size_t)h->texel_count + 16u);
    if (failed || !weights || !b->layer_memory || !b->dense || !b->sums || !b->copy) {
        free(weights);
        return tool_fail("bench", "out of memory");
    }
    noh_morph_layers_init(b->layer_memory, b->layer_bytes, mesh, &b->layers, NULL);
    fill_dense(b, weights);
    free(weights);
    return 0;
}

static void cpu_close(cpu_bench *b)
{
    bench_weights_close(&b->weights);
    free(b->layer_memory);
    free(b->dense);
    free(b->sums);
    free(b->copy);
}

/* The dense sums must be the kernel's, up to the order of rounding. */
static int cpu_check(cpu_bench *b, const cpu_work *kernel_work, const char *name)
{
    const noh_mesh_header *h = b->mesh->header;
    float worst = 0.0f, largest = 0.0f;
    cpu_work dense = { b, { "dense-scalar", NULL, NULL, NULL } };
    run_dense(&dense, 0);
    run_kernel((void *)(uintptr_t)kernel_work, 0);
    for (uint32_t v = 0; v < h->touched_count; v++) {
        for (uint32_t c = 0; c < 3; c++) {
            float ours = b->layers.position[3 * (size_t)v + c], theirs = b->sums[ATTRIBUTES * (size_t)v + c];
            float off = ours > theirs ? ours - theirs : theirs - ours, size = theirs < 0.0f ? -theirs : theirs;
            worst = off > worst ? off : worst;
            largest = size > largest ? size : largest;
        }
    }
    return worst > 1e-5f * largest ? tool_fail("bench", "morph/cpu/%s and dense-scalar give different sums", name) : 0;
}

/* ---- rows ---- */

#define KERNELS_MAX 4

/* Those that run here. */
static uint32_t list_kernels(noh_morph_kernel *kernels)
{
    static const char *const names[KERNELS_MAX] = { "scalar", "sse2", "avx2", "neon" };
    uint32_t count = 0;
    for (uint32_t i = 0; i < KERNELS_MAX; i++) {
        count += noh_morph_kernel_find(names[i], &kernels[count], NULL) == NOH_OK;
    }
    return count;
}

static void add_rows(bench_job *job, const cpu_bench *b, const bench_cells *cells, const noh_morph_kernel *kernels,
                     uint32_t count, const char *prefix)
{
    double pairs = b->weights.pairs > 0.0 ? b->weights.pairs : 1.0;
    double dense = bench_median(cells, count) / pairs, copy = bench_median(cells, count + 1u) / pairs;
    for (uint32_t k = 0; k < count; k++) {
        char name[64];
        double own = bench_median(cells, k) / pairs;
        snprintf(name, sizeof name, "%s/%s", prefix, kernels[k].name);
        bench_add_row(&job->rows, name, "dense-scalar", dense, own, "ns/pair", cells->rounds);
        bench_add_row(&job->rows, name, "memcpy", copy, own, "ns/pair", cells->rounds);
    }
}

static int measure(bench_job *job, uint32_t active, const char *prefix)
{
    noh_morph_kernel kernels[KERNELS_MAX];
    cpu_work works[KERNELS_MAX + 2];
    uint32_t count = list_kernels(kernels);
    bench_cells cells;
    cpu_bench b;
    int status;
    memset(&b, 0, sizeof b);
    memset(&cells, 0, sizeof cells);
    status = cpu_open(&b, &job->mesh, active);
    for (uint32_t k = 0; k < count + 2u && !status; k++) {
        works[k].bench = &b;
        if (k < count) works[k].kernel = kernels[k];
        bench_add_cell(&cells, k < count ? run_kernel : k == count ? run_dense : run_memcpy, &works[k]);
        status = k < count ? cpu_check(&b, &works[k], kernels[k].name) : 0;
    }
    if (!status) {
        status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, prefix);
    }
    if (!status) {
        add_rows(job, &b, &cells, kernels, count, prefix);
    }
    bench_free_cells(&cells);
    cpu_close(&b);
    return status;
}

int bench_cpu(bench_job *job)
{
    uint32_t targets = job->mesh.header->target_count;
    int status = measure(job, targets, "morph/cpu");
    return status || targets <= 4 ? status : measure(job, 4, "morph/4-active/cpu");
}
