/* cmd_verify.c: compares every path and format with the CPU reference, value for value, and memory used with memory
 * predicted. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/gpu_args.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "verify.h"

static int is_untouched(const uint8_t *memory, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++) {
        if (memory[i] != 0xa5) return 0;
    }
    return 1;
}

/* init must take a block of the planned size, and must refuse one byte less and leave it untouched. Returns the planned
 * bytes, or 0 if a smaller block was accepted or written to. */
static uint64_t least_block(verify_job *job, const figure *planned)
{
    const noh_gl_device device = { &job->g.gl, &job->g.caps, &job->g.ledger, NULL, 0 };
    const size_t bytes = (size_t)planned->plan.cpu_bytes;
    noh_error error = { NOH_OK, "", 0, 0 };
    uint8_t *memory = malloc(bytes);
    noh_stage *stage = NULL;
    int ok = memory != NULL;
    if (ok) {
        memset(memory, 0xa5, bytes);
        ok = noh_stage_init(memory, bytes - 1u, &device, &planned->stage_desc, &planned->plan, &stage, &error) ==
                 NOH_ERR_MEMORY &&
             error.need == bytes && is_untouched(memory, bytes);
    }
    free(memory);
    return ok ? bytes : 0;
}

/* The same for the hair: 0 if it takes another size than it says. */
static uint64_t least_hair(verify_job *job, const figure *planned)
{
    const noh_actor_hair_desc *desc = &planned->hair.desc;
    const noh_gl_device device = { &job->g.gl, &job->g.caps, &job->g.ledger, NULL, 0 };
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_actor_hair *heads;
    noh_stage_hair drawn;
    if (!planned->hair.is_there) return 0;
    const size_t bytes = noh_actor_hair_size(desc), drawn_bytes = noh_stage_hair_size(desc);
    uint8_t *memory = malloc(bytes), *drawn_memory = malloc(drawn_bytes);
    int ok = memory && drawn_memory;
    if (ok) {
        memset(memory, 0xa5, bytes);
        memset(drawn_memory, 0xa5, drawn_bytes);
        ok = noh_actor_hair_init(memory, bytes - 1u, desc, &heads, &error) == NOH_ERR_MEMORY && error.need == bytes &&
             is_untouched(memory, bytes) && noh_actor_hair_init(memory, bytes, desc, &heads, &error) == NOH_OK &&
             noh_stage_hair_create(&device, heads, drawn_memory, drawn_bytes - 1u, 0, 0, &drawn, &error) ==
                 NOH_ERR_MEMORY &&
             error.need == drawn_bytes && is_untouched(drawn_memory, drawn_bytes);
    }
    free(memory);
    free(drawn_memory);
    return ok ? bytes + drawn_bytes : 0;
}

/* A frame that a camera sees, with the first clip playing. */
static int show(figure *f)
{
    const char *clip = noh_stage_name(f->stage, 0, NOH_NAME_CLIP, 0);
    const noh_play play = { .start_ticks = 4800 };
    noh_gl_camera camera;
    bounds box;
    orbit at;
    int status = clip ? figure_play(f, clip, &play) : 0;
    if (!status) status = figure_pose(f);
    if (status) {
        return status;
    }
    box = figure_bounds(f, FRAME_FULL);
    at = orbit_fit(&box, 1.0, 0.0);
    orbit_camera(&at, &camera);
    return figure_look(f, &camera, 512);
}

/* A whole stage, as `noh render` makes it, against its budget, as `noh budget` prints it. */
static int verify_figure(verify_job *job)
{
    figure planned, f;
    int status = figure_plan(&planned, &job->figure, &job->g.caps);
    if (status) {
        return status;
    }
    figure_bytes(&planned, &job->cpu_predicted, &job->gpu_predicted);
    job->cpu_used = least_block(job, &planned) + least_hair(job, &planned);
    figure_plan_free(&planned);
    status = figure_open(&f, &job->figure, &job->g);
    if (!status) {
        job->gpu_used = noh_gl_ledger_bytes(&job->g.ledger);
        status = show(&f);
        verify_check_memory(job, noh_gl_ledger_bytes(&job->g.ledger) == job->gpu_used,
                            "GPU memory was allocated after init");
        figure_close(&f);
    }
    verify_check_memory(job, job->cpu_predicted == job->cpu_used, "CPU bytes differ from the prediction");
    verify_check_memory(job, job->gpu_predicted == job->gpu_used, "GPU bytes differ from the prediction");
    verify_check_memory(job, noh_gl_ledger_bytes(&job->g.ledger) == 0, "GPU memory was not freed");
    job->failed |= status;
    return status;
}

typedef struct verify_args {
    const char *pack, *anim, *driver;
    double seed, instances, lod, bound_scale;
    int without_tangents, as_json;
} verify_args;

static int open_meshes(verify_job *job)
{
    const noh_pack *pack = &job->file.pack;
    const int status = figure_check_level(&job->file, job->figure.level);
    if (status) {
        return status;
    }
    job->meshes = calloc(pack->runs[NOH_CHUNK_MESH].count + 1u, sizeof *job->meshes);
    for (uint32_t i = 0; job->meshes && i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh full;
        (void)noh_pack_mesh_at(pack, i, &full, NULL);
        job->meshes[i] = noh_mesh_at_lod(&full, job->figure.level);
    }
    return job->meshes ? 0 : tool_fail(job->file.path, "out of memory");
}

static int verify_pack(verify_job *job, const verify_args *a)
{
    int status = open_meshes(job);
    if (!status) status = gpu_open_drawing(&job->g, a->driver);
    if (!status) {
        status = verify_paths(job);
        if (!status) status = verify_figure(job);
        if (!status) status = a->as_json ? verify_print_json(job) : verify_print(job);
        gpu_close(&job->g);
    }
    free(job->meshes);
    return status;
}

static int run(void *args)
{
    static verify_job job;
    const verify_args *a = args;
    pack_file anim;
    int status = parse_instances(a->instances, &job.figure.actor_count);
    if (!status) status = parse_level(a->lod, &job.figure.level);
    if (status) {
        return status;
    }
    if (!(a->bound_scale > 0.0)) {
        return tool_usage("--bound-scale must be a number over 0");
    }
    job.bound_scale = a->bound_scale;
    job.without_tangents = a->without_tangents;
    job.state = 0x9e3779b97f4a7c15ull ^ (uint64_t)fabs(a->seed) << 20;
    status = pack_file_open(&job.file, a->pack);
    if (status) {
        return status;
    }
    job.figure.file = &job.file;
    job.figure.hair = 1;
    status = figure_open_clips(&anim, a->anim, &job.file, &job.figure.clips);
    if (!status) status = verify_pack(&job, a);
    figure_close_clips(&anim, job.figure.clips);
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
          "multiply the error bounds of skinned vertices by this, above 0: shows how close errors come to them, or makes the check fail",
      .example = "0.1" },
    { .name = "--without-tangents",
      .kind = OPTION_FLAG,
      .at = offsetof(verify_args, without_tangents),
      .what = "accumulate only positions and normals, on every path" },
    OPTION_INSTANCES(verify_args, instances, "1",
                     .what = "copies of the scene for the comparison of memory and budget, 1 to 65536"),
    OPTION_LOD(verify_args, lod, .needs = NULL),
    OPTION_DRIVER(verify_args, driver, .initial = "egl"),
    OPTION_JSON(verify_args, as_json),
};

const verb verb_verify = {
    .name = "verify",
    .files = "PACK|MODEL",
    .what = "compare every path and format with the CPU reference, and memory with its budget",
    .more =
        "Fails (exit code 1) if a value that must be equal differs, or if one exceeds its bound; each FAILED line names the row, the value and the bound.",
    .example = "face.noh\nbody.noh --instances 100 --lod 1 --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(verify_args, pack),
    .args = &arguments,
    .run = run,
};
