/* bench_walkers.c: row crowd/simulation: what agents cost in the CPU's part of a frame of a thousand bodies who follow
 * them (stage/walkers.h), at a square with 4 square metres for each: the crowd's steps and the walkers' against the
 * whole frame, 60 times a second. Nothing is drawn: a GL's own part is not counted, and the share is the larger for it.
 * None where a pack has no clip 'walk' whose root moves. */
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "crowd/crowd_scene.h"
#include "stage/view.h"
#include "stage/walkers.h"

#define SAMPLE_NS 5e7
#define BODIES 1000u
#define BODIES_QUICK 100u
#define FRAME_TICKS 800u
#define WARM_FRAMES 120u

static const noh_layer_desc layers[] = { { "body", NOH_LAYER_BASE, NULL, NULL, 3 } };

typedef struct town {
    crowd_scene *scene;
    noh_kind_desc kind;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    noh_walkers *walkers;
    void *memory, *walkers_memory;
    noh_stage_view view;
    int sim_alone;
} town;

/* ---- what is timed ---- */

static void run_frame(void *self, uint32_t frame)
{
    town *t = self;
    (void)frame;
    (void)noh_crowd_step(crowd_scene_crowd(t->scene), FRAME_TICKS);
    (void)noh_walkers_step(t->walkers, crowd_scene_crowd(t->scene), t->stage, NULL, FRAME_TICKS, NULL);
    if (!t->sim_alone) (void)noh_stage_frame(t->stage, FRAME_TICKS, &t->view, NULL, NULL, NULL);
}

/* ---- making ---- */

static noh_result open_stage(town *t, const pack_file *file, uint32_t bodies, noh_error *error)
{
    t->kind.mesh = &file->pack;
    t->kind.actor_count = bodies;
    t->kind.layers = layers;
    t->kind.layer_count = 1;
    t->kind.held_float_count = NOH_NONE;
    t->kind.root_axes = NOH_ROOT_X | NOH_ROOT_Z;
    t->kind.root_up = 1;
    t->kind.root_told = 1;
    t->desc.kinds = &t->kind;
    t->desc.kind_count = 1;
    noh_result result = noh_stage_plan_make(&t->desc, NULL, &t->plan, error);
    if (result) return result;
    t->memory = malloc((size_t)t->plan.cpu_bytes);
    if (!t->memory) return noh_fail(error, NOH_ERR_MEMORY, "out of memory", 0, t->plan.cpu_bytes);
    result = noh_stage_init(t->memory, (size_t)t->plan.cpu_bytes, NULL, &t->desc, &t->plan, &t->stage, error);
    if (result) t->stage = NULL;
    return result;
}

static noh_result open_walkers(town *t, uint32_t bodies, noh_error *error)
{
    noh_walkers_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.walker_max = bodies;
    desc.walk = "walk";
    desc.idle = noh_stage_find(t->stage, 0, NOH_NAME_CLIP, "idle") == NOH_NONE ? NULL : "idle";
    const size_t bytes = noh_walkers_size(&desc);
    t->walkers_memory = malloc(bytes);
    if (!t->walkers_memory) return noh_fail(error, NOH_ERR_MEMORY, "out of memory", 0, bytes);
    noh_result result = noh_walkers_init(t->walkers_memory, bytes, &desc, t->stage, &t->walkers, error);
    for (uint32_t i = 0; i < bodies && !result; i++) {
        noh_actor actor;
        result = noh_stage_spawn(t->stage, 0, NULL, &actor, error);
        if (!result) result = noh_walkers_put(t->walkers, i, t->stage, actor, i, NULL, error);
    }
    return result;
}

/* returns an exit code; *none: the pack has no such walk */
static int open_town(town *t, const bench_job *job, uint32_t bodies, int *none)
{
    const crowd_scene_options options = { "open10000", bodies, 600.0, 1, 1, 0 };
    const float side = 2.0f * (float)(bodies == BODIES ? 31.6 : 10.0), middle[3] = { 0.5f * side, 1.0f, 0.5f * side };
    noh_error error = { NOH_OK, "", 0, 0 };
    int status = crowd_scene_open(&options, &t->scene);
    if (status) return status;
    noh_result result = open_stage(t, &job->files[0], bodies, &error);
    if (!result) result = open_walkers(t, bodies, &error);
    *none = result != NOH_OK;
    noh_view_orbit(&t->view, middle, 0.0f, 0.3f, side, 1280, 720);
    for (uint32_t i = 0; i < WARM_FRAMES && !*none; i++) run_frame(t, i);
    return 0;
}

static void close_town(town *t)
{
    if (t->stage) noh_stage_delete(t->stage);
    if (t->scene) crowd_scene_close(t->scene);
    free(t->memory);
    free(t->walkers_memory);
}

int bench_walkers(bench_job *job)
{
    static town towns[2];
    const uint32_t bodies = job->quick ? BODIES_QUICK : BODIES;
    bench_cells cells;
    int status = 0, none = 0;
    memset(&cells, 0, sizeof cells);
    memset(towns, 0, sizeof towns);
    for (uint32_t i = 0; i < 2u && !status && !none; i++) {
        status = open_town(&towns[i], job, bodies, &none);
        towns[i].sim_alone = i == 0;
        if (!status && !none) bench_add_cell(&cells, run_frame, &towns[i]);
    }
    if (!status && !none) status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "crowd/simulation");
    if (!status && !none) {
        bench_add_row(&job->rows, bodies == BODIES ? "crowd/simulation/1000" : "crowd/simulation/100",
                      "the whole frame", bench_median(&cells, 0), bench_median(&cells, 1), "ns/frame", cells.rounds);
    }
    bench_free_cells(&cells);
    for (uint32_t i = 0; i < 2u; i++) close_town(&towns[i]);
    return status;
}
