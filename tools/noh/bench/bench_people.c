/* bench_people.c: rows crowd/people: the shares of agents and of walkers in the CPU time of a frame with a
 * thousand bodies that walk among each other. No rows if no pack has a body that walks.
 *
 * The CPU's part is a step of the agents, their walkers, a step of the stage, its frame and its draw, on a GL that does
 * nothing. There are 60 frames a second, so that every other frame has a step of the agents: shares are of two
 * frames. The agents are dense1000, one on each square metre, and open10000, one on four. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/crowd.h"
#include "noh/gl_device.h"
#include "noh/low_life.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "platform.h"
#include "crowd/crowd_scene.h"
#include "crowd/place_people.h"

#define BODIES 1000u
#define BODIES_QUICK 50u
#define FRAMES 2u      /* to a step of the agents */
#define WARM_STEPS 60u /* after which agents have met, and clips are decoded */
#define STEPS_MAX 150u
#define WIDTH 1280u
#define HEIGHT 720u

enum { AGENTS, WALKERS, FRAME, PARTS };

typedef struct people {
    bench_job *job;
    place_people who;
    crowd_scene *scene;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_gl_ledger ledger;
    noh_stage *stage;
    noh_walkers *walkers;
    void *memory, *walkers_memory;
    noh_stage_view view;
    double agents_ns;     /* so far */
    double *parts[PARTS]; /* [STEPS_MAX] nanoseconds of a frame */
} people;

/* ---- opening ---- */

static int open_stage(people *p, gpu *g, const pack_file *file)
{
    char log[4096] = "";
    const noh_gl_device device = { &g->gl, &g->caps, &p->ledger, log, sizeof log };
    noh_error error = { NOH_OK, "", 0, 0 };
    p->desc.kinds = &p->who.kind;
    p->desc.kind_count = 1;
    p->desc.lod.pixels = 1.0f;
    p->desc.height_px = HEIGHT;
    p->desc.gpu = &noh_stage_on_gl;
    if (noh_stage_plan_make(&p->desc, &g->caps, &p->plan, &error)) return tool_fail_error(file->path, &error);
    p->memory = malloc((size_t)p->plan.cpu_bytes);
    if (!p->memory) return tool_fail(file->path, "out of memory");
    if (noh_stage_init(p->memory, (size_t)p->plan.cpu_bytes, &device, &p->desc, &p->plan, &p->stage, &error)) {
        p->stage = NULL;
        return tool_fail_error(file->path, &error);
    }
    return 0;
}

static int open_walkers(people *p, const pack_file *file)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_walkers_desc desc = p->who.walkers;
    desc.idle = noh_stage_find(p->stage, 0, NOH_NAME_CLIP, "idle") == NOH_NONE ? NULL : "idle";
    const size_t bytes = noh_walkers_size(&desc);
    p->walkers_memory = malloc(bytes);
    if (!p->walkers_memory) return tool_fail(file->path, "out of memory");
    if (noh_walkers_init(p->walkers_memory, bytes, &desc, p->stage, &p->walkers, &error)) {
        return tool_fail_error(file->path, &error);
    }
    for (uint32_t i = 0; i < p->who.kind.actor_count; i++) {
        noh_actor actor;
        if (noh_stage_spawn(p->stage, 0, NULL, &actor, &error) ||
            noh_walkers_add(p->walkers, i, p->stage, actor, i, NULL, &error)) {
            return tool_fail_error(file->path, &error);
        }
    }
    return 0;
}

/* Over the corner of their square, that all of them are seen. */
static void look(people *p)
{
    noh_crowd_agent agent;
    float high[2] = { -1e6f, -1e6f }, low[2] = { 1e6f, 1e6f };
    for (uint32_t i = 0; noh_crowd_agent_at(crowd_scene_crowd(p->scene), i, &agent); i++) {
        for (int k = 0; k < 2; k++) {
            if (agent.position[k] > high[k]) high[k] = agent.position[k];
            if (agent.position[k] < low[k]) low[k] = agent.position[k];
        }
        if (i + 1u == p->who.kind.actor_count) break;
    }
    const float target[3] = { 0.5f * (low[0] + high[0]), 1.0f, 0.5f * (low[1] + high[1]) };
    noh_view_orbit(&p->view, target, 0.6f, 0.35f, 1.1f * (high[0] - low[0]), WIDTH, HEIGHT);
}

static int open_people(people *p, gpu *g, const char *scene)
{
    static place_file open; /* a place without anything in it */
    const uint32_t bodies = p->job->quick ? BODIES_QUICK : BODIES;
    const crowd_scene_options options = { scene, bodies, 60.0, 1, 1, 0 };
    int status = place_people_make(&p->who, &p->job->files[0], &open, bodies, 0);
    for (int i = 0; i < PARTS && !status; i++) {
        p->parts[i] = calloc(STEPS_MAX, sizeof *p->parts[i]);
        if (!p->parts[i]) status = tool_fail("bench", "out of memory");
    }
    if (!status) status = crowd_scene_open(&options, &p->scene);
    if (!status) status = open_stage(p, g, &p->job->files[0]);
    if (!status) status = open_walkers(p, &p->job->files[0]);
    if (!status) look(p);
    return status;
}

static void close_people(people *p)
{
    if (p->stage) noh_stage_delete(p->stage);
    if (p->scene) crowd_scene_close(p->scene);
    for (int i = 0; i < PARTS; i++) free(p->parts[i]);
    free(p->walkers_memory);
    free(p->memory);
}

/* ---- a frame ---- */

/* The agents' step, and the frames up to the next. */
static void run_step(people *p, uint32_t at)
{
    const uint32_t ticks = NOH_CROWD_STEP_TICKS / FRAMES;
    double walkers = 0.0;
    (void)crowd_scene_step(p->scene);
    const double agents = crowd_scene_cpu_ns(p->scene) - p->agents_ns; /* without what measures the scene */
    const uint64_t start = noh_thread_clock_ns();
    for (uint32_t i = 0; i < FRAMES; i++) {
        const uint64_t before = noh_thread_clock_ns();
        (void)noh_walkers_step(p->walkers, crowd_scene_crowd(p->scene), p->stage, &p->who.feet.ground, ticks, NULL);
        (void)noh_walkers_near(p->walkers, p->stage, p->view.eye);
        walkers += (double)(noh_thread_clock_ns() - before);
        (void)noh_stage_frame(p->stage, ticks, &p->view, NULL, NULL, NULL);
        (void)noh_stage_draw(p->stage, NOH_PASS_COLOR, 0, NULL, NULL); /* a frame with a view was before */
    }
    p->agents_ns += agents;
    p->parts[AGENTS][at] = agents;
    p->parts[WALKERS][at] = walkers;
    p->parts[FRAME][at] = agents + (double)(noh_thread_clock_ns() - start);
}

static void add_row(people *p, const char *scene, const char *part, const double *cost, uint32_t steps)
{
    double share[STEPS_MAX];
    char name[64];
    snprintf(name, sizeof name, "crowd/people/%s/%s", scene, part);
    for (uint32_t i = 0; i < steps; i++) share[i] = 100.0 * cost[i] / p->parts[FRAME][i];
    bench_add_row(&p->job->rows, name, "the CPU's frame", 100.0, bench_median_of(share, steps), "% of it", steps);
}

static void measure(people *p, const char *scene)
{
    const uint32_t wanted = 10u * p->job->rounds, steps = wanted < STEPS_MAX ? wanted : STEPS_MAX;
    for (uint32_t i = 0; i < WARM_STEPS; i++) run_step(p, 0);
    for (uint32_t i = 0; i < steps; i++) run_step(p, i);
    add_row(p, scene, "agents", p->parts[AGENTS], steps);
    add_row(p, scene, "walkers", p->parts[WALKERS], steps);
}

/* A clip "walk", and a body with the feet for it. */
static int has_people(const noh_pack *pack)
{
    noh_ragdoll_source source;
    noh_feet_rig rig;
    int walks = 0;
    memset(&source, 0, sizeof source);
    source.pack = pack;
    source.metres = 1.0f;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_CLIP].count; i++) {
        noh_pack_clip clip;
        walks |= noh_pack_clip_at(pack, i, &clip, NULL) == NOH_OK && strcmp(clip.name, "walk") == 0;
    }
    return walks && noh_pack_skeleton_at(pack, 0, &source.joints, NULL, NULL) == NOH_OK &&
           noh_feet_rig_make(&source, &rig, NULL) == NOH_OK;
}

static int bench_scene(bench_job *job, gpu *g, const char *scene)
{
    people *p = calloc(1, sizeof *p);
    if (!p) return tool_fail("bench", "out of memory");
    p->job = job;
    const int status = open_people(p, g, scene);
    if (!status) measure(p, scene);
    close_people(p);
    free(p);
    return status;
}

int bench_people(bench_job *job)
{
    gpu g;
    if (!has_people(&job->files[0].pack)) return 0;
    int status = gpu_open(&g, "null");
    if (status) return status;
    g.caps.blend_f32 = g.caps.blend_f32_exact = 1; /* or the CPU would accumulate */
    status = bench_scene(job, &g, "dense1000");
    if (!status) status = bench_scene(job, &g, "open10000");
    gpu_close(&g);
    return status;
}
