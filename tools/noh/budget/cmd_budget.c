/* cmd_budget.c: the bytes that a load will take, by the sums that the load itself makes; `noh verify` compares the two.
 * With --actors or --desc those of a stage, by its plan. */
#include <stdio.h>
#include <string.h>

#include "budget_args.h"
#include "level_costs.h"
#include "gpu/gpu_args.h"
#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"

static void print_levels(const level_costs *c)
{
    if (c->count > 1) {
        printf("%-10s %10s %10s %10s %10s %12s %12s\n", "level", "vertices", "triangles", "texels", "pairs",
               "CPU bytes", "GPU bytes   when loaded from this level on");
    }
    for (uint32_t k = c->first; k < c->count && c->count > 1; k++) {
        const level_cost *l = &c->levels[k];
        printf("  %-8u %10llu %10llu %10llu %10llu %12llu %12llu\n", k, (unsigned long long)l->vertices,
               (unsigned long long)l->triangles, (unsigned long long)l->texels, (unsigned long long)l->pairs,
               (unsigned long long)l->cpu_bytes, (unsigned long long)l->gpu_bytes);
    }
}

static void json_levels(json *j, const level_costs *c)
{
    json_open(j, "levels", '[');
    for (uint32_t k = c->first; k < c->count; k++) {
        const level_cost *l = &c->levels[k];
        json_open(j, NULL, '{');
        json_integer(j, "level", k);
        json_integer(j, "vertices", l->vertices);
        json_integer(j, "triangles", l->triangles);
        json_integer(j, "texels", l->texels);
        json_integer(j, "pairs", l->pairs);
        json_integer(j, "cpu_bytes", l->cpu_bytes);
        json_integer(j, "gpu_bytes", l->gpu_bytes);
        json_close(j, '}');
    }
    json_close(j, ']');
}

/* Decoded segments: they decide the bytes of "clips". */
typedef struct segments {
    uint32_t held, all, instances;
} segments;

static void print_budget(const pack_file *file, const load_budget *b, const segments *clips, const char *device)
{
    printf("%-32s %12s %12s\n", file->path, "CPU bytes", "GPU bytes");
    for (uint32_t i = 0; i < b->part_count; i++) {
        printf("  %-30s %12llu %12llu\n", b->parts[i].name, (unsigned long long)b->parts[i].cpu_bytes,
               (unsigned long long)b->parts[i].gpu_bytes);
    }
    printf("  %-30s %12llu %12llu\n", "sum", (unsigned long long)b->cpu_bytes, (unsigned long long)b->gpu_bytes);
    printf("  %-30s %12llu %12s  read where it lies\n", "the pack itself", (unsigned long long)b->pack_bytes, "");
    printf("  %-30s %12u %12s  at most, for any call\n", "stack", NOH_STACK_BYTES, "");
    if (clips->all) {
        printf("clips: %u of %u decoded segments are held at once, enough for %u instance%s that cross-fade%s\n",
               clips->held, clips->all, clips->instances, plural(clips->instances), clips->instances == 1u ? "s" : "");
    }
    if (!b->plan.atlas_width) {
        printf("%s\n", b->plan.reason);
        return;
    }
    printf("%s-%s on %s (%s); accumulators %u x %u x 3\n", noh_morph_path_name(b->plan.path),
           noh_accumulate_name(b->plan.accumulate), device, b->plan.reason, b->plan.atlas_width, b->plan.atlas_height);
}

static int json_budget(const load_budget *b, const level_costs *levels, const segments *clips, const char *device)
{
    json j = json_begin();
    json_integer(&j, "cpu_bytes", b->cpu_bytes);
    json_integer(&j, "gpu_bytes", b->gpu_bytes);
    json_integer(&j, "pack_bytes", b->pack_bytes);
    json_integer(&j, "stack_bytes", NOH_STACK_BYTES);
    json_text(&j, "path", noh_morph_path_name(b->plan.path));
    json_text(&j, "accumulate", noh_accumulate_name(b->plan.accumulate));
    json_text(&j, "reason", b->plan.reason);
    json_text(&j, "device", device);
    json_integer(&j, "instances", clips->instances);
    json_integer(&j, "clip_segments_held", clips->held);
    json_integer(&j, "clip_segments", clips->all);
    json_open(&j, "parts", '[');
    for (uint32_t i = 0; i < b->part_count; i++) {
        json_open(&j, NULL, '{');
        json_text(&j, "name", b->parts[i].name);
        json_integer(&j, "cpu_bytes", b->parts[i].cpu_bytes);
        json_integer(&j, "gpu_bytes", b->parts[i].gpu_bytes);
        json_close(&j, '}');
    }
    json_close(&j, ']');
    json_levels(&j, levels);
    return json_end(&j);
}

int budget_caps(const budget_args *a, int draws, noh_gl_caps *caps)
{
    gpu g;
    int status;
    if (a->nominal || !draws) {
        *caps = nominal_caps();
        return 0;
    }
    status = gpu_open(&g, a->driver);
    if (!status) {
        *caps = g.caps;
        gpu_close(&g);
    }
    return status;
}

/* Clips alone draw nothing. */
static int check_clips_alone(const budget_args *a)
{
    const char *given = a->load.path != NOH_MORPH_AUTO              ? "--path"
                        : a->load.accumulate != NOH_ACCUMULATE_AUTO ? "--accumulate"
                                                                    : NULL;
    return given ? tool_usage("%s has no effect with a pack of clips alone", given) : 0;
}

static int budget_of(const budget_args *a, const pack_file *file)
{
    noh_gl_caps caps;
    level_costs levels;
    segments clips = { 0, 0, a->load.instances ? a->load.instances : 1u };
    load_budget b;
    scene s;
    int status = scene_init(&s, file);
    if (status) {
        return status;
    }
    memset(&b, 0, sizeof b);
    status = s.item_count ? 0 : check_clips_alone(a);
    if (!status) status = budget_caps(a, s.item_count != 0, &caps);
    if (!status) status = scene_set_level(&s, file, a->level);
    if (!status) status = scene_open_anim(&s, file, a->anim);
    if (!status) status = load_budget_make(&b, file, &s, &caps, &a->load);
    if (!status) status = level_costs_find(&levels, file, &s, &caps, &a->load);
    if (!status) {
        scene_measure_segments(&s, file, clips.instances, &clips.held, &clips.all);
        if (a->as_json) {
            status = json_budget(&b, &levels, &clips, caps.renderer);
        } else {
            print_budget(file, &b, &clips, caps.renderer);
            print_levels(&levels);
        }
    }
    load_budget_free(&b);
    scene_free(&s);
    return status;
}

static int budget_of_pack(const budget_args *a)
{
    pack_file file;
    int status = pack_file_open(&file, a->pack);
    if (!status) {
        status = budget_of(a, &file);
        pack_file_close(&file);
    }
    return status;
}

/* ---- the verb ---- */

static int check_args(budget_args *a)
{
    int status = parse_path(a->path, &a->load.path);
    if (!status) status = parse_accumulate(a->accumulate, &a->load.accumulate);
    if (!status) status = parse_instances(a->instances, &a->load.instances);
    if (!status) status = parse_level(a->lod, &a->level);
    return status ? status : stage_args_check(a);
}

static int run(void *args)
{
    budget_args *a = args;
    const int status = check_args(a);
    if (status) {
        return status;
    }
    if (a->desc) {
        return budget_of_desc(a);
    }
    return a->counts[ACTORS] ? budget_of_actors(a) : budget_of_pack(a);
}

static budget_args arguments;

#define OF_STAGE "--actors --desc"
#define COUNT_OPTION(text, index, unit, ...)                                                                     \
    {                                                                                                            \
        .name = text, .kind = OPTION_TEXT, .at = offsetof(budget_args, texts[index]), .value = unit, __VA_ARGS__ \
    }

static const option options[] = {
    OPTION_ANIM(budget_args, anim, .excludes = OF_STAGE),
    OPTION_INSTANCES(budget_args, instances, "1", .what = "copies of the scene, 1 to 65536", .excludes = OF_STAGE),
    OPTION_PATH(budget_args, path, .initial = "auto", .excludes = "--no-gpu"),
    OPTION_ACCUMULATE(budget_args, accumulate, .initial = "auto", .excludes = OF_STAGE),
    OPTION_LOD(budget_args, lod, .excludes = OF_STAGE),
    OPTION_DRIVER(budget_args, driver, .initial = "egl", .excludes = "--nominal --no-gpu"),
    { .name = "--nominal",
      .kind = OPTION_FLAG,
      .at = offsetof(budget_args, nominal),
      .what = "assume a GLES 3.2 device that supports everything; needs no driver",
      .excludes = "--no-gpu" },
    COUNT_OPTION("--actors", ACTORS, "N", .example = "20", .excludes = "--desc",
                 .what = "a stage with this many characters of the pack at one time, 1 to 65535"),
    COUNT_OPTION(
        "--near", NEAR, "N", .needs = "--actors", .example = "4",
        .what = "of these at the finest level at once; without --near and --middle by an even spread over 100 m"),
    COUNT_OPTION("--middle", MIDDLE, "N", .needs = "--actors", .example = "8", .what = "and at the next level"),
    COUNT_OPTION("--finest", FINEST, "K", .needs = "--actors", .example = "1",
                 .what = "the finest level that may be used, 0 to 7; 0: all"),
    { .name = "--clips",
      .kind = OPTION_LIST,
      .at = offsetof(budget_args, clips),
      .value = "PACK",
      .what =
          "take the clips from this pack; repeat it for several, of which a later one's clip replaces one of the same "
          "name",
      .example = "body_anim.noh",
      .needs = "--actors" },
    { .name = "--desc",
      .kind = OPTION_INPUT,
      .at = offsetof(budget_args, desc),
      .value = "FILE",
      .what = "a stage of several kinds, as a text (noh help FORMATS); stands in place of PACK",
      .example = "cast.txt" },
    COUNT_OPTION("--bytes", BYTES, "N", .needs = OF_STAGE, .example = "2097152",
                 .what = "the stage may take this many bytes, CPU and GPU together; what is given up for it is listed"),
    COUNT_OPTION("--cpu-bytes", CPU_BYTES, "N", .needs = OF_STAGE, .example = "1048576", .what = "and on the CPU"),
    COUNT_OPTION("--gpu-bytes", GPU_BYTES, "N", .needs = OF_STAGE, .example = "1048576", .what = "and on the GPU"),
    { .name = "--pixels",
      .kind = OPTION_TEXT,
      .at = offsetof(budget_args, pixels_text),
      .value = "F",
      .what = "largest error that LOD may show, in pixels, above 0; without it 1, or what --desc says",
      .example = "0.5",
      .needs = OF_STAGE },
    COUNT_OPTION("--height", HEIGHT, "N", .needs = OF_STAGE, .example = "720",
                 .what = "lines of the picture, 1 to 65536; without it 1080, or what --desc says"),
    COUNT_OPTION("--jobs", JOBS, "N", .needs = OF_STAGE, .example = "4", .what = "parallel jobs of a frame, 1 to 64"),
    { .name = "--f16",
      .kind = OPTION_FLAG,
      .at = offsetof(budget_args, halves),
      .what = "16-bit accumulation texels",
      .needs = OF_STAGE,
      .excludes = "--no-gpu" },
    { .name = "--no-gpu",
      .kind = OPTION_FLAG,
      .at = offsetof(budget_args, without_gpu),
      .what = "a stage that steps and poses, and draws nothing",
      .needs = OF_STAGE },
    OPTION_JSON(budget_args, as_json),
};

const verb verb_budget = {
    .name = "budget",
    .files = "PACK",
    .what = "the bytes that a load, or a stage, will take, CPU and GPU, by part",
    .more =
        "With --actors, or with --desc in place of PACK, it plans a stage: its parts, each kind's levels, and what is "
        "given up where the stage has to keep a bound.",
    .example = "face.noh\nface.noh --instances 100 --path mrt --nominal --json\n"
               "body.noh --actors 20 --near 4 --bytes 2097152\n--desc cast.txt --nominal",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .instead = "--desc",
    .files_at = offsetof(budget_args, pack),
    .args = &arguments,
    .run = run,
};
