/* bench_skin_cpu.c: rows skin/cpu: the kernels against straightforward scalar C, which reads the same pack
 * (plain-scalar) or floats that were unpacked before (plain-floats), and against memcpy of the same bytes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "deform/skin/skin_internal.h"
#include "noh/low_core.h"

#define SAMPLE_NS 5e6
#define OUT_FLOATS 10u /* position, normal, tangent */

#if defined(__x86_64__)
/* skin.c built again for other instruction sets (Makefile, KERNELS) */
void noh_skin_vertices_sse2(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t first,
                            uint32_t count, float *positions, float *normals, float *tangents);
void noh_skin_vertices_avx2(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t first,
                            uint32_t count, float *positions, float *normals, float *tangents);
#endif

typedef void (*skin_kernel)(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t first,
                            uint32_t count, float *positions, float *normals, float *tangents);

typedef struct skin_bench {
    const noh_mesh *mesh;
    float *matrices;
    /* what plain-floats reads */
    noh_vertex *vertices;
    uint32_t *joints; /* [vertex_count][influence_count] */
    float *weights;
    float *out, *copy; /* [3 + 3 + 4][vertex_count] */
    const void *volatile seen;
} skin_bench;

typedef struct skin_work {
    skin_bench *bench;
    skin_kernel run;
} skin_work;

static void run_kernel(void *self, uint32_t frame)
{
    const skin_work *w = (const skin_work *)self;
    skin_bench *b = w->bench;
    const size_t count = b->mesh->header->vertex_count;
    (void)frame;
    w->run(b->mesh, b->matrices, NULL, 0, (uint32_t)count, b->out, b->out + 3 * count, b->out + 6 * count);
    b->seen = b->out;
}

static void run_memcpy(void *self, uint32_t frame)
{
    skin_bench *b = ((const skin_work *)self)->bench;
    (void)frame;
    memcpy(b->copy, b->out, OUT_FLOATS * sizeof *b->out * b->mesh->header->vertex_count);
    b->seen = b->copy;
}

/* Keep the compiler from vectorising the scalar baselines. */
#if defined(__GNUC__) && !defined(__clang__)
#define SCALAR_FUNCTION __attribute__((optimize("no-tree-vectorize")))
#else
#define SCALAR_FUNCTION
#endif

static void make_unit(const float *sum, float *out)
{
    float length = sqrtf(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (int r = 0; r < 3; r++) {
        out[r] = sum[r] / length;
    }
}

/* The textbook formula: every joint transforms position, normal and tangent, and the results are blended. */
SCALAR_FUNCTION static void move_plainly(skin_bench *b, size_t v, const noh_vertex *in, const uint32_t *joints,
                                         const float *weights)
{
    const size_t vertices = b->mesh->header->vertex_count, count = b->mesh->header->influence_count;
    float p[3] = { 0.0f, 0.0f, 0.0f }, n[3] = { 0.0f, 0.0f, 0.0f }, t[3] = { 0.0f, 0.0f, 0.0f };
    for (size_t i = 0; i < count; i++) {
        const float *m = b->matrices + 12u * (size_t)joints[i], w = weights[i];
        for (int r = 0; r < 3; r++, m += 4) {
            p[r] += w * (m[0] * in->position[0] + m[1] * in->position[1] + m[2] * in->position[2] + m[3]);
            n[r] += w * (m[0] * in->normal[0] + m[1] * in->normal[1] + m[2] * in->normal[2]);
            t[r] += w * (m[0] * in->tangent[0] + m[1] * in->tangent[1] + m[2] * in->tangent[2]);
        }
    }
    memcpy(b->out + 3 * v, p, sizeof p);
    make_unit(n, b->out + 3 * vertices + 3 * v);
    make_unit(t, b->out + 6 * vertices + 4 * v);
    b->out[6 * vertices + 4 * v + 3] = in->tangent[3];
}

SCALAR_FUNCTION static void run_floats(void *self, uint32_t frame)
{
    skin_bench *b = ((const skin_work *)self)->bench;
    const size_t count = b->mesh->header->influence_count;
    (void)frame;
    for (size_t v = 0; v < b->mesh->header->vertex_count; v++) {
        move_plainly(b, v, &b->vertices[v], b->joints + v * count, b->weights + v * count);
    }
    b->seen = b->out;
}

SCALAR_FUNCTION static void run_plain(void *self, uint32_t frame)
{
    skin_bench *b = ((const skin_work *)self)->bench;
    (void)frame;
    for (uint32_t v = 0; v < b->mesh->header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX];
        noh_vertex in;
        noh_mesh_vertex(b->mesh, v, &in);
        noh_mesh_influences(b->mesh, v, joints, weights);
        move_plainly(b, v, &in, joints, weights);
    }
    b->seen = b->out;
}

/* ---- making ---- */

/* Bind pose matrices: the cost does not depend on their values. */
static int make_matrices(skin_bench *b)
{
    noh_skin skin;
    noh_skeleton skeleton;
    float *model;
    noh_pack_skin_at(b->mesh->pack, b->mesh->header->skin, &skin, NULL);
    noh_pack_skeleton_at(b->mesh->pack, skin.header->skeleton, &skeleton, NULL, NULL);
    b->matrices = calloc(skin.header->joint_count, 48);
    model = calloc(skeleton.joint_count, 48);
    if (b->matrices && model) {
        noh_local_to_model(&skeleton, skeleton.bind_pose, skeleton.joint_count, model);
        noh_skin_matrices(&skin, model, b->matrices);
    }
    free(model);
    return !b->matrices || !model;
}

static int skin_open(skin_bench *b, const noh_mesh *mesh)
{
    const size_t vertices = mesh->header->vertex_count, count = mesh->header->influence_count;
    b->mesh = mesh;
    b->vertices = calloc(vertices, sizeof *b->vertices);
    b->joints = calloc(vertices * count, sizeof *b->joints);
    b->weights = calloc(vertices * count, sizeof *b->weights);
    b->out = calloc(vertices * OUT_FLOATS, sizeof *b->out);
    b->copy = calloc(vertices * OUT_FLOATS, sizeof *b->copy);
    if (!b->vertices || !b->joints || !b->weights || !b->out || !b->copy || make_matrices(b)) {
        return tool_fail("bench", "out of memory");
    }
    for (uint32_t v = 0; v < vertices; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX];
        noh_mesh_vertex(mesh, v, &b->vertices[v]);
        noh_mesh_influences(mesh, v, joints, weights);
        memcpy(b->joints + v * count, joints, count * sizeof *joints);
        memcpy(b->weights + v * count, weights, count * sizeof *weights);
    }
    return 0;
}

static void skin_close(skin_bench *b)
{
    free(b->matrices);
    free(b->vertices);
    free(b->joints);
    free(b->weights);
    free(b->out);
    free(b->copy);
}

/* Both give the same vertices, within rounding. */
static int skin_check(skin_bench *b, skin_work *kernel, const char *name)
{
    const size_t floats = 3u * (size_t)b->mesh->header->vertex_count;
    skin_work plain = { b, NULL };
    float worst = 0.0f, largest = 0.0f;
    run_plain(&plain, 0);
    memcpy(b->copy, b->out, floats * sizeof *b->out);
    run_kernel(kernel, 0);
    for (size_t i = 0; i < floats; i++) {
        worst = fmaxf(worst, fabsf(b->out[i] - b->copy[i]));
        largest = fmaxf(largest, fabsf(b->copy[i]));
    }
    return worst > 1e-5f * largest ? tool_fail("bench", "skin/cpu/%s and plain-scalar give different vertices", name)
                                   : 0;
}

/* ---- rows ---- */

#define SKIN_KERNELS_MAX 3

typedef struct skin_entry {
    const char *name;
    skin_kernel run;
} skin_entry;

static uint32_t list_kernels(skin_entry *k)
{
    uint32_t count = 0;
#if defined(__x86_64__)
    k[count].name = "sse2";
    k[count++].run = noh_skin_vertices_sse2;
    if (__builtin_cpu_supports("avx2")) {
        k[count].name = "avx2";
        k[count++].run = noh_skin_vertices_avx2;
    }
#else
    k[count].name = noh_skin_simd();
    k[count++].run = noh_skin_vertices;
#endif
    return count;
}

static int measure(bench_job *job, skin_bench *b)
{
    skin_entry kernels[SKIN_KERNELS_MAX];
    skin_work works[SKIN_KERNELS_MAX + 3];
    uint32_t count = list_kernels(kernels);
    double vertices = b->mesh->header->vertex_count;
    bench_cells cells;
    int status = 0;
    memset(&cells, 0, sizeof cells);
    for (uint32_t k = 0; k < count + 3u && !status; k++) {
        works[k].bench = b;
        works[k].run = k < count ? kernels[k].run : NULL;
        bench_add_cell(&cells,
                       k < count        ? run_kernel
                       : k == count     ? run_plain
                       : k == count + 1 ? run_floats
                                        : run_memcpy,
                       &works[k]);
        status = k < count ? skin_check(b, &works[k], kernels[k].name) : 0;
    }
    status = status ? status : bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "skin/cpu");
    for (uint32_t k = 0; k < count && !status; k++) {
        char name[64];
        double own = bench_median(&cells, k) / vertices;
        snprintf(name, sizeof name, "skin/cpu/%s", kernels[k].name);
        bench_add_row(&job->rows, name, "plain-scalar", bench_median(&cells, count) / vertices, own, "ns/vertex",
                      cells.rounds);
        bench_add_row(&job->rows, name, "plain-floats", bench_median(&cells, count + 1u) / vertices, own, "ns/vertex",
                      cells.rounds);
        bench_add_row(&job->rows, name, "memcpy", bench_median(&cells, count + 2u) / vertices, own, "ns/vertex",
                      cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

int bench_skin_cpu(bench_job *job)
{
    skin_bench b;
    int status;
    if (job->mesh.header->skin == NOH_NONE) {
        return 0;
    }
    memset(&b, 0, sizeof b);
    status = skin_open(&b, &job->mesh);
    status = status ? status : measure(job, &b);
    skin_close(&b);
    return status;
}
