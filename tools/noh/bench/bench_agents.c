/* bench_agents.c: rows crowd/agents: a step of agents that cross a square at 0.25 a square metre, against optimal
 * reciprocal collision avoidance (ORCA) among the same neighbours of the same grid; and how the cost of an agent grows
 * with their number. Needs no pack's data. */
#include <stdio.h>
#include <string.h>

#include "bench_job.h"
#include "crowd/crowd_scene.h"

#define SAMPLE_NS 5e7
#define WARM_STEPS 60u /* after which agents have met */

static void step(void *self, uint32_t frame)
{
    (void)frame;
    (void)noh_crowd_step(self, NOH_CROWD_STEP_TICKS);
}

/* Two seconds after the start, and long before agents arrive. */
static int open_scene(uint32_t agents, uint32_t flags, crowd_scene **scene)
{
    const crowd_scene_options options = { "open10000", agents, 60.0, 1, 1, flags };
    const int status = crowd_scene_open(&options, scene);
    for (uint32_t i = 0; i < WARM_STEPS && !status; i++) {
        (void)noh_crowd_step(crowd_scene_crowd(*scene), NOH_CROWD_STEP_TICKS);
    }
    return status;
}

/* One against the other: agents of each, in turn. */
static int compare(bench_job *job, const char *row, const char *baseline, const uint32_t agents[2],
                   const uint32_t flags[2])
{
    crowd_scene *scenes[2] = { NULL, NULL };
    bench_cells cells;
    int status = 0;
    memset(&cells, 0, sizeof cells);
    for (uint32_t i = 0; i < 2u && !status; i++) {
        status = open_scene(agents[i], flags[i], &scenes[i]);
        if (!status) bench_add_cell(&cells, step, crowd_scene_crowd(scenes[i]));
    }
    if (!status) status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "crowd/agents");
    if (!status) {
        bench_add_row(&job->rows, row, baseline, bench_median(&cells, 0) / agents[0],
                      bench_median(&cells, 1) / agents[1], "ns/agent and step", cells.rounds);
    }
    bench_free_cells(&cells);
    for (uint32_t i = 0; i < 2u; i++) {
        if (scenes[i]) crowd_scene_close(scenes[i]);
    }
    return status;
}

int bench_agents(bench_job *job)
{
    static const uint32_t same[2] = { 10000, 10000 }, more[2] = { 1000, 50000 };
    static const uint32_t orca[2] = { NOH_CROWD_ORCA, 0 }, none[2] = { 0, 0 };
    int status = compare(job, "crowd/agents/10000", "ORCA", same, orca);
    if (!status) status = compare(job, "crowd/agents/50000", "1000 agents", more, none);
    return status;
}
