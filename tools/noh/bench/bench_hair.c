/* bench_hair.c: rows sim/hair: a step of 48 control hairs of 12 points round four spheres, by each set of instructions,
 * against as many two-bone solves; and rows sim/hair_points: the points shown between two steps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "life/hair/hair_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"

#define HAIRS 48u
#define POINTS 12u
#define WORKS 3u /* sets of instructions at most */
#define SAMPLE_NS 5e6

/* hair_lanes.c built again (Makefile, KERNELS) */
typedef uint32_t step_fn(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, uint32_t ticks);
step_fn noh_hair_step_scalar, noh_hair_step_sse2, noh_hair_step_avx2;
typedef void hair_points(const noh_hair *hair, const noh_hair_desc *desc, float *points);
hair_points noh_hair_points_scalar, noh_hair_points_sse2, noh_hair_points_avx2;

typedef struct hair_work {
    const char *name;
    step_fn *step;
    hair_points *show;
    noh_hair_desc desc;
    noh_hair_sphere spheres[4];
    float rest[3u * HAIRS * POINTS], points[3u * HAIRS * POINTS];
    noh_hair *hair;
    volatile float seen; /* keeps the results alive */
} hair_work;

/* Hair that goes out from a ring about the top of a head, and then down. */
static int make_work(hair_work *w)
{
    static const noh_hair_carrier at = { { 0.0f, 1.5f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, { 0.0f, 0.0f, 0.0f } };
    static const noh_hair_sphere head[4] = { { { 0.0f, 0.08f, -0.01f }, 0.09f },
                                             { { 0.0f, 0.05f, 0.03f }, 0.085f },
                                             { { 0.03f, 0.02f, 0.0f }, 0.08f },
                                             { { -0.03f, 0.02f, 0.0f }, 0.08f } };
    for (uint32_t h = 0; h < HAIRS; h++) {
        const float a = 6.2831853f * (float)h / (float)HAIRS, x = sinf(a), z = cosf(a);
        float *p = w->rest + 3u * (size_t)POINTS * h;
        p[0] = 0.115f * x, p[1] = 0.12f, p[2] = 0.125f * z;
        for (uint32_t i = 1; i < POINTS; i++, p += 3) {
            const float out = i < 3u ? 0.6f : 0.02f;
            p[3] = p[0] + 0.03f * out * x;
            p[4] = p[1] - 0.03f * sqrtf(1.0f - out * out);
            p[5] = p[2] + 0.03f * out * z;
        }
    }
    memcpy(w->spheres, head, sizeof head);
    w->desc = (noh_hair_desc){ w->rest, HAIRS, POINTS, w->spheres, 4, 7, 0.02f, 0.005f, 3.0f, 0.5f };
    const size_t bytes = noh_hair_size(&w->desc);
    void *memory = malloc(bytes);
    if (!memory || noh_hair_init(memory, bytes, &w->desc, &at, &w->hair, NULL) != NOH_OK) {
        free(memory);
        return tool_fail("bench", "out of memory");
    }
    return 0;
}

/* A head that shakes and nods in the wind. */
static void move(void *self, uint32_t frame)
{
    hair_work *w = self;
    const float turn = 0.2f * sinf(0.15f * (float)frame), nod = 0.1f * sinf(0.11f * (float)frame);
    const noh_hair_carrier at = { { 0.05f * sinf(0.1f * (float)frame), 1.5f, 0.0f },
                                  { nod, turn, 0.0f, sqrtf(1.0f - turn * turn - nod * nod) },
                                  { -2.0f, 0.0f, 0.0f } };
    (void)w->step(w->hair, &w->desc, &at, NOH_HAIR_STEP_TICKS);
}

static void show(void *self, uint32_t frame)
{
    hair_work *w = self;
    (void)frame;
    w->show(w->hair, &w->desc, w->points);
    w->seen = w->points[0];
}

static uint32_t list_works(hair_work *works)
{
    uint32_t count = 0;
    works[count].name = "scalar";
    works[count].step = noh_hair_step_scalar;
    works[count++].show = noh_hair_points_scalar;
#if defined(__x86_64__)
    works[count].name = "sse2";
    works[count].step = noh_hair_step_sse2;
    works[count++].show = noh_hair_points_sse2;
    if (__builtin_cpu_supports("avx2")) {
        works[count].name = "avx2";
        works[count].step = noh_hair_step_avx2;
        works[count++].show = noh_hair_points_avx2;
    }
#else
    works[count].name = "own";
    works[count].step = noh_hair_step;
    works[count++].show = noh_hair_points;
#endif
    return count;
}

static int measure(bench_job *job, hair_work *works, uint32_t count)
{
    const double points = (double)HAIRS * POINTS;
    bench_cells cells;
    memset(&cells, 0, sizeof cells);
    bench_add_cell(&cells, bench_two_bone, NULL);
    for (uint32_t i = 0; i < count; i++) bench_add_cell(&cells, move, &works[i]);
    for (uint32_t i = 0; i < count; i++) bench_add_cell(&cells, show, &works[i]);
    const int status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "sim/hair");
    for (uint32_t i = 0; i < 2u * count && !status; i++) {
        char name[64];
        snprintf(name, sizeof name, "sim/hair%s/%s", i < count ? "" : "_points", works[i % count].name);
        bench_add_row(&job->rows, name, "two-bone", bench_median(&cells, 0) / BENCH_TWO_BONE_SOLVES,
                      bench_median(&cells, 1 + i) / points, i < count ? "ns/point and step" : "ns/point", cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

int bench_hair(bench_job *job)
{
    hair_work *works = calloc(WORKS, sizeof *works);
    const uint32_t count = works ? list_works(works) : 0;
    int status = works ? 0 : tool_fail("bench", "out of memory");
    for (uint32_t i = 0; i < count && !status; i++) status = make_work(&works[i]);
    if (!status) status = measure(job, works, count);
    for (uint32_t k = 0; k < count; k++) free(works[k].hair);
    free(works);
    return status;
}
