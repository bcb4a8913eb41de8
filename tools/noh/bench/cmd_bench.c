/* cmd_bench.c: what noh costs, as ratios to named baselines measured in the same run. */
#define _POSIX_C_SOURCE 200809L

#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "cli/message.h"
#include "convert/base/nearest.h"

typedef struct bench_args {
    const char *packs[BENCH_FILES_MAX], *driver, *source, *only;
    int pack_count;
    double rounds;
    int as_json, quick;
} bench_args;

/* Measures the mesh with the most pairs whose targets do not move texture coordinates, as the loops of the baselines
 * do not move them. */
static void choose_mesh(bench_job *job)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < job->files[0].pack.runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_pack_mesh_at(&job->files[0].pack, i, &mesh, NULL);
        if (mesh.header->flags & NOH_MESH_UV_TARGETS) continue;
        if (mesh.header->pair_count > most) {
            most = mesh.header->pair_count;
            job->mesh = mesh;
            job->mesh_index = i;
        }
    }
    job->has_mesh = most != 0;
}

/* The rows, group by group: --only takes one. */
static const struct group {
    const char *name;
    int (*run)(bench_job *job);
    int draws; /* needs a mesh with targets */
} groups[] = {
    { "morph", bench_morph, 1 },       { "morph-cpu", bench_cpu, 1 },       { "skin-cpu", bench_skin_cpu, 1 },
    { "skin-gpu", bench_skin_gpu, 1 }, { "heads", bench_crowd, 1 },         { "clip", bench_clip_rows, 0 },
    { "pose", bench_crowd_pose, 0 },   { "crowd", bench_crowd_frame, 1 },   { "stage", bench_cast, 0 },
    { "look", bench_look, 1 },         { "face", bench_face, 1 },           { "ear", bench_ear, 1 },
    { "sim", bench_sim, 0 },           { "agents", bench_agents, 0 },       { "people", bench_people, 0 },
    { "wire", bench_wire, 0 },         { "morph-before", bench_before, 1 },
};
#define GROUPS (sizeof groups / sizeof groups[0])

static int check_only(const char *only)
{
    const char *names[GROUPS], *near;
    for (size_t i = 0; i < GROUPS; i++) {
        names[i] = groups[i].name;
        if (!only || strcmp(only, names[i]) == 0) {
            return 0;
        }
    }
    near = nearest_name(only, names, GROUPS);
    return tool_usage("--only must be a group of rows, not '%s'%s%s%s", only, near ? " (did you mean '" : "",
                      near ? near : "", near ? "'?)" : "");
}

static int check_args(const bench_args *a)
{
    if (a->rounds < 1.0 || a->rounds > 1000.0 || a->rounds != (double)(uint32_t)a->rounds) {
        return tool_usage("--rounds must be a whole number from 1 to 1000");
    }
    return check_only(a->only);
}

static int bench_groups(bench_job *job, const bench_args *a, uint32_t **artist)
{
    int status = 0;
    if (job->has_mesh && a->source) {
        status = bench_artist_order(a->source, job->mesh_index, &job->mesh, artist);
        job->artist = *artist;
    }
    for (size_t i = 0; i < GROUPS && !status; i++) {
        if ((!groups[i].draws || job->has_mesh) && (!a->only || strcmp(a->only, groups[i].name) == 0)) {
            status = groups[i].run(job);
        }
    }
    return status;
}

static int bench_all(bench_job *job, const bench_args *a)
{
    uint32_t *artist = NULL;
    int status = bench_groups(job, a, &artist);
    if (!status && job->rows.failed) {
        status = tool_fail(a->packs[0], "out of memory");
    }
    if (!status && !job->rows.count) {
        status = tool_fail(a->packs[0],
                           a->only ? "the pack has no data for these rows"
                                   : "there is nothing to measure: no target moves a vertex, and there are no clips");
    }
    if (!status) {
        status = a->as_json ? bench_print_json(job) : (bench_print(job), 0);
    }
    free(artist);
    return status;
}

static int open_packs(bench_job *job, const bench_args *a)
{
    int status = 0;
    while (!status && job->file_count < (uint32_t)a->pack_count) {
        status = pack_file_open(&job->files[job->file_count], a->packs[job->file_count]);
        job->file_count += !status;
    }
    return status;
}

/* A GL context only where something is drawn. */
static int bench_packs(bench_job *job, const bench_args *a)
{
    int status;
    bench_clock_open(&job->cpu_clock, NULL);
    if (!job->has_mesh) {
        return bench_all(job, a);
    }
    setenv("LP_NUM_THREADS", "0",
           0); /* llvmpipe draws on this thread, which times the work and not the waking of other threads */
    status = gpu_open_drawing(&job->g, a->driver);
    if (!status) {
        bench_clock_open(&job->gl_clock, &job->g);
        status = bench_all(job, a);
        bench_clock_close(&job->gl_clock);
        gpu_close(&job->g);
    }
    return status;
}

static int run(void *args)
{
    const bench_args *a = args;
    bench_job job;
    int status = check_args(a);
    if (status) {
        return status;
    }
    memset(&job, 0, sizeof job);
    job.rounds = a->quick ? 1u : (uint32_t)a->rounds;
    job.quick = a->quick;
    job.only = a->only;
    status = open_packs(&job, a);
    if (!status) {
        choose_mesh(&job);
        status = bench_packs(&job, a);
    }
    free(job.rows.rows);
    while (job.file_count > 0) {
        pack_file_close(&job.files[--job.file_count]);
    }
    return status;
}

static bench_args arguments;

static const option options[] = {
    { .name = "--only",
      .kind = OPTION_TEXT,
      .at = offsetof(bench_args, only),
      .value = "GROUP",
      .what =
          "measure only these rows: morph, morph-before, morph-cpu, skin-cpu, skin-gpu, heads, clip, pose, crowd, stage, look, face, ear, "
          "sim, agents, people or wire; default: all for which the packs have data",
      .example = "look" },
    { .name = "--source",
      .kind = OPTION_INPUT,
      .at = offsetof(bench_args, source),
      .value = "ASSET",
      .what = "the model that the first pack was built from, for the baselines that need its vertex order",
      .example = "head.glb" },
    { .name = "--rounds",
      .kind = OPTION_NUMBER,
      .at = offsetof(bench_args, rounds),
      .value = "N",
      .initial = "15",
      .what = "measurements per row, 1 to 1000; the median is printed",
      .example = "31",
      .excludes = "--quick" },
    { .name = "--quick",
      .kind = OPTION_FLAG,
      .at = offsetof(bench_args, quick),
      .what = "one short round, as a smoke test" },
    OPTION_DRIVER(bench_args, driver, .initial = "egl"),
    OPTION_JSON(bench_args, as_json),
};

const verb verb_bench = {
    .name = "bench",
    .files = "PACK|MODEL...",
    .what = "measure costs as ratios to named baselines from the same run",
    .example = "head.noh --source head.glb\nwalk.noh run.noh --only clip --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = BENCH_FILES_MAX,
    .files_at = offsetof(bench_args, packs),
    .file_count_at = offsetof(bench_args, pack_count),
    .args = &arguments,
    .run = run,
};
