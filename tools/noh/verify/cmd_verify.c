/* cmd_verify.c: compares every path and format with the CPU reference, value for value, and memory used with memory
 * predicted. */
#include <math.h>

#include "gpu/gpu_args.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "verify.h"

/* A whole load, as `noh render` makes it, against its budget, as `noh budget` prints it. */
static int verify_load(verify_job *job)
{
    load_budget b;
    load l;
    int status = load_budget_make(&b, &job->file, &job->scene, &job->g.caps, &job->load);
    if (!status) status = scene_open_players(&job->scene, &job->file, job->load.instances ? job->load.instances : 1u);
    if (!status) {
        status = load_open(&l, &job->g, &job->file, &job->scene, &job->load);
    }
    if (!status) {
        job->cpu_predicted = b.cpu_bytes;
        job->gpu_predicted = b.gpu_bytes;
        job->gpu_used = noh_gl_ledger_bytes(&job->g.ledger);
        job->cpu_used = l.morph.bytes + l.skin.bytes + l.matrix_bytes;
        for (uint32_t i = 0; i < job->scene.player_count; i++) {
            const scene_player *p = &job->scene.players[i];
            job->cpu_used += p->set_bytes + p->controller_bytes + p->pose_bytes;
        }
        status = load_update(&l, NULL);
        verify_check_memory(job, noh_gl_ledger_bytes(&job->g.ledger) == job->gpu_used,
                            "GPU memory was taken after init");
        load_close(&l);
    }
    load_budget_free(&b);
    verify_check_memory(job, job->cpu_predicted == job->cpu_used, "CPU bytes are not those predicted");
    verify_check_memory(job, job->gpu_predicted == job->gpu_used, "GPU bytes are not those predicted");
    verify_check_memory(job, noh_gl_ledger_bytes(&job->g.ledger) == 0, "GPU memory was not given back");
    job->failed |= status;
    return status;
}

typedef struct verify_args {
    const char *pack, *anim, *driver;
    double seed, instances, lod, bound_scale;
    int without_tangents, as_json;
} verify_args;

static int verify_scene(verify_job *job, const verify_args *a, uint32_t level)
{
    int status = scene_set_level(&job->scene, &job->file, level);
    if (!status) status = scene_open_anim(&job->scene, &job->file, a->anim);
    if (!status) status = gpu_open_drawing(&job->g, a->driver);
    if (status) {
        return status;
    }
    status = verify_paths(job);
    if (!status) status = verify_load(job);
    if (!status) status = a->as_json ? verify_print_json(job) : verify_print(job);
    gpu_close(&job->g);
    return status;
}

static int run(void *args)
{
    static verify_job job;
    const verify_args *a = args;
    uint32_t level = 0;
    int status = parse_instances(a->instances, &job.load.instances);
    if (!status) status = parse_level(a->lod, &level);
    if (status) {
        return status;
    }
    if (!(a->bound_scale > 0.0)) {
        return tool_usage("--bound-scale wants a number over 0");
    }
    job.bound_scale = a->bound_scale;
    job.without_tangents = a->without_tangents;
    job.state = 0x9e3779b97f4a7c15ull ^ (uint64_t)fabs(a->seed) << 20;
    status = pack_file_open(&job.file, a->pack);
    if (status) {
        return status;
    }
    status = scene_init(&job.scene, &job.file);
    if (!status) {
        status = verify_scene(&job, a, level);
        scene_free(&job.scene);
    }
    pack_file_close(&job.file);
    return status ? status : job.failed ? EXIT_FAILED : 0;
}

static verify_args arguments;

static const option options[] = {
    OPTION_ANIM(verify_args, anim, .needs = NULL),
    { .name = "--seed",
      .kind = OPTION_NUMBER,
      .at = offsetof(verify_args, seed),
      .value = "N",
      .initial = "1",
      .what = "seed of the random weights and poses, which are the same on every machine",
      .example = "7" },
    { .name = "--bound-scale",
      .kind = OPTION_NUMBER,
      .at = offsetof(verify_args, bound_scale),
      .value = "X",
      .initial = "1",
      .what =
          "multiply the bounds of skinned vertices by this, over 0: to see how close errors come, or the check fail",
      .example = "0.1" },
    { .name = "--without-tangents",
      .kind = OPTION_FLAG,
      .at = offsetof(verify_args, without_tangents),
      .what = "accumulate positions and normals alone, on every path" },
    OPTION_INSTANCES(verify_args, instances, "1",
                     .what = "copies of the scene whose memory is compared with the budget, 1 to 65536"),
    OPTION_LOD(verify_args, lod, .needs = NULL),
    OPTION_DRIVER(verify_args, driver, .initial = "egl"),
    OPTION_JSON(verify_args, as_json),
};

const verb verb_verify = {
    .name = "verify",
    .files = "PACK",
    .what = "compare every path and format with the CPU reference, and memory with its budget",
    .more =
        "Fails (exit code 1) when a value that must be equal differs, or when one exceeds its bound; each FAILED line names the row, "
        "the value and the bound.",
    .example = "face.noh\nbody.noh --instances 100 --lod 1 --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(verify_args, pack),
    .args = &arguments,
    .run = run,
};
