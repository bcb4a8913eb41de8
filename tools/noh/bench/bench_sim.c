/* bench_sim.c: rows sim/ragdoll: sixteen dolls of the first pack that fall for half a second, by each set of
 * instructions, against the same solver with one float at a time. Nothing falls asleep in it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "drop/drop_scene.h"
#include "life/physics/ragdoll_internal.h"

#define DOLLS 16u
#define STEPS 30u
#define SAMPLE_NS 5e6

typedef void (*sim_step)(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                         uint32_t count, float *scratch, float size);

/* ragdoll_lanes.c built again (Makefile, KERNELS) */
#if defined(__x86_64__)
void noh_ragdoll_step_dolls_sse2(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                                 uint32_t count, float *scratch, float size);
void noh_ragdoll_step_dolls_avx2(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                                 uint32_t count, float *scratch, float size);
#endif
void noh_ragdoll_step_dolls_scalar(const noh_ragdoll_shape *shape, const noh_world *world,
                                   noh_ragdoll_doll *const *dolls, uint32_t count, float *scratch, float size);

typedef struct sim_work {
    const char *name;
    sim_step step;
    drop_scene *scene;
    noh_ragdoll_doll *start;
} sim_work;

static void fall(void *self, uint32_t frame)
{
    const sim_work *w = self;
    noh_ragdoll_doll *dolls = noh_ragdoll_dolls(w->scene->set), *all[DOLLS];
    (void)frame;
    memcpy(dolls, w->start, DOLLS * sizeof *dolls);
    for (uint32_t i = 0; i < DOLLS; i++) all[i] = &dolls[i];
    for (uint32_t i = 0; i < STEPS; i++) {
        w->step(&w->scene->set->shape, &w->scene->world, all, DOLLS, noh_ragdoll_scratch(w->scene->set), 1.0f);
    }
}

static uint32_t list_works(sim_work *works)
{
    uint32_t count = 0;
    works[count].name = "scalar";
    works[count++].step = noh_ragdoll_step_dolls_scalar;
#if defined(__x86_64__)
    works[count].name = "sse2";
    works[count++].step = noh_ragdoll_step_dolls_sse2;
    if (__builtin_cpu_supports("avx2")) {
        works[count].name = "avx2";
        works[count++].step = noh_ragdoll_step_dolls_avx2;
    }
#else
    works[count].name = "own";
    works[count++].step = noh_ragdoll_step_dolls;
#endif
    return count;
}

static int measure(bench_job *job, drop_scene *scene, noh_ragdoll_doll *start)
{
    sim_work works[3];
    const uint32_t count = list_works(works);
    const double steps = (double)STEPS * DOLLS * scene->rig.body_count;
    bench_cells cells;
    memset(&cells, 0, sizeof cells);
    memcpy(start, noh_ragdoll_dolls(scene->set), DOLLS * sizeof *start);
    for (uint32_t i = 0; i < count; i++) {
        works[i].scene = scene;
        works[i].start = start;
        bench_add_cell(&cells, fall, &works[i]);
    }
    const int status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "sim/ragdoll");
    for (uint32_t i = 1; i < count && !status; i++) {
        char name[64];
        snprintf(name, sizeof name, "sim/ragdoll/%s", works[i].name);
        bench_add_row(&job->rows, name, "scalar", bench_median(&cells, 0) / steps, bench_median(&cells, i) / steps,
                      "ns/body and step", cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

int bench_sim(bench_job *job)
{
    drop_scene scene;
    noh_ragdoll_doll *start;
    int status = bench_springs(job);
    if (!status) status = bench_hair(job);
    if (!status) status = bench_ik(job);
    if (status || !drop_scene_can(&job->files[0])) return status;
    status = drop_scene_open(&scene, &job->files[0], DOLLS, 1.0, 10, 1);
    if (status) return status;
    start = malloc(DOLLS * sizeof *start);
    status = start ? measure(job, &scene, start) : tool_fail("bench", "out of memory");
    free(start);
    drop_scene_close(&scene);
    return status;
}
