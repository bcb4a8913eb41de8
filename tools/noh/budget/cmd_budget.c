/* cmd_budget.c: the bytes of a pack on the stage that the other verbs make of it, by its plan; `noh verify` compares
 * the two. With --actors or --desc, the bytes of a game's own stage. */
#include <stdio.h>
#include <string.h>

#include "info/info_materials.h"
#include "budget_args.h"
#include "budget_why.h"
#include "pack_budget.h"
#include "gpu/gpu_args.h"
#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"

static void print_levels(const pack_budget *b)
{
    if (b->level_count > 1) {
        printf("%-10s %10s %10s %10s %10s %12s %12s\n", "level", "vertices", "triangles", "texels", "pairs",
               "CPU bytes", "GPU bytes   when loaded from this level on");
    }
    for (uint32_t k = b->level_first; k < b->level_count && b->level_count > 1; k++) {
        const level_cost *l = &b->levels[k];
        printf("  %-8u %10llu %10llu %10llu %10llu %12llu %12llu\n", k, (unsigned long long)l->vertices,
               (unsigned long long)l->triangles, (unsigned long long)l->texels, (unsigned long long)l->pairs,
               (unsigned long long)l->cpu_bytes, (unsigned long long)l->gpu_bytes);
    }
}

static void json_levels(json *j, const pack_budget *b)
{
    json_open(j, "levels", '[');
    for (uint32_t k = b->level_first; k < b->level_count; k++) {
        const level_cost *l = &b->levels[k];
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

/* Of its chunk; 0: there is none. */
static uint64_t terrain_bytes(const pack_budget *b)
{
    const noh_pack_terrain_header *h = noh_pack_chunk_at(&b->planned.desc.file->pack, NOH_CHUNK_TERRAIN, 0);
    return h ? h->heights_offset + 2u * (uint64_t)h->width * h->depth : 0;
}

static void print_parts(const pack_budget *b)
{
    const noh_stage_plan *plan = &b->planned.plan;
    printf("%-32s %12s %12s\n", b->planned.desc.file->path, "CPU bytes", "GPU bytes");
    for (uint32_t i = 0; i < b->part_count; i++) {
        char name[96];
        pack_budget_name(b, i, name, sizeof name);
        printf("  %-30s %12llu %12llu\n", name, (unsigned long long)b->parts[i].cpu_bytes,
               (unsigned long long)b->parts[i].gpu_bytes);
    }
    printf("  %-30s %12llu %12llu\n", "sum", (unsigned long long)b->cpu_bytes, (unsigned long long)b->gpu_bytes);
    printf("  %-30s %12llu %12s  read in place\n", "the pack itself", (unsigned long long)plan->pack_bytes, "");
    if (terrain_bytes(b)) printf("  %-30s %12llu\n", "  the terrain in it", (unsigned long long)terrain_bytes(b));
    printf("  %-30s %12u %12s  at most, for any call\n", "stack", NOH_STACK_BYTES, "");
}

static void print_budget(const pack_budget *b, const char *device, int why, const budget_phone *phone)
{
    const uint32_t instances = b->planned.kinds[0].actor_count;
    print_parts(b);
    if (b->segment_count) {
        printf("clips: %u of %u decoded segments are held at once, enough for %u instance%s that cross-fade%s\n",
               b->cached_segment_count, b->segment_count, instances, plural(instances), instances == 1u ? "s" : "");
    }
    if (b->morph.atlas_width) {
        printf("%s-%s on %s (%s)\n", noh_morph_path_name(b->morph.path), noh_accumulate_name(b->morph.accumulate),
               device, b->morph.reason);
    } else {
        printf("%s\n", b->morph.reason);
    }
    if (why && b->morph.instance_count) budget_why_print(&b->morph);
    print_levels(b);
    if (b->planned.kinds[0].mesh) info_print_costs(b->planned.kinds[0].mesh);
    if (b->planned.kinds[0].mesh) info_print_textures(b->planned.kinds[0].mesh);
    if (b->planned.kinds[0].mesh && phone->gpu) budget_phone_print(phone, b->planned.kinds[0].mesh);
}

static int json_budget(const pack_budget *b, const char *device, int why, const budget_phone *phone)
{
    const noh_stage_plan *plan = &b->planned.plan;
    json j = json_begin();
    json_integer(&j, "cpu_bytes", b->cpu_bytes);
    json_integer(&j, "gpu_bytes", b->gpu_bytes);
    json_integer(&j, "pack_bytes", plan->pack_bytes);
    json_integer(&j, "terrain_bytes", terrain_bytes(b));
    json_integer(&j, "stack_bytes", NOH_STACK_BYTES);
    json_text(&j, "path", noh_morph_path_name(b->morph.path));
    json_text(&j, "accumulate", noh_accumulate_name(b->morph.accumulate));
    json_text(&j, "reason", b->morph.reason);
    json_text(&j, "device", device);
    if (why && b->morph.instance_count) budget_why_json(&j, &b->morph);
    json_integer(&j, "instances", b->planned.kinds[0].actor_count);
    json_integer(&j, "clip_segments_held", b->cached_segment_count);
    json_integer(&j, "clip_segments", b->segment_count);
    json_open(&j, "parts", '[');
    for (uint32_t i = 0; i < b->part_count; i++) {
        char name[96];
        pack_budget_name(b, i, name, sizeof name);
        json_open(&j, NULL, '{');
        json_text(&j, "name", name);
        json_integer(&j, "cpu_bytes", b->parts[i].cpu_bytes);
        json_integer(&j, "gpu_bytes", b->parts[i].gpu_bytes);
        json_close(&j, '}');
    }
    json_close(&j, ']');
    json_levels(&j, b);
    if (b->planned.kinds[0].mesh) info_json_costs(&j, b->planned.kinds[0].mesh);
    if (b->planned.kinds[0].mesh) info_json_textures(&j, b->planned.kinds[0].mesh);
    if (b->planned.kinds[0].mesh && phone->gpu) budget_phone_json(&j, phone, b->planned.kinds[0].mesh);
    return json_end(&j);
}

int budget_caps(const budget_args *a, int draws, noh_gl_caps *caps)
{
    gpu g;
    int status;
    if (a->nominal || !draws) {
        noh_gl_caps_nominal(caps);
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
    const char *given = a->figure.path != NOH_MORPH_AUTO              ? "--path"
                        : a->figure.accumulate != NOH_ACCUMULATE_AUTO ? "--accumulate"
                                                                      : NULL;
    return given ? tool_usage("%s has no effect with a pack that holds only clips", given) : 0;
}

static int budget_of(const budget_args *a, const figure_desc *desc)
{
    const int draws = figure_draws(&desc->file->pack);
    noh_gl_caps caps;
    pack_budget b;
    int status = draws ? 0 : check_clips_alone(a);
    if (!draws && !status && !desc->clips->pack.runs[NOH_CHUNK_CLIP].count) {
        status = tool_fail(desc->file->path, "the pack has neither meshes nor clips");
    }
    if (!status) status = budget_caps(a, draws, &caps);
    if (!status) status = pack_budget_make(&b, desc, draws ? &caps : NULL);
    if (!status) {
        if (a->as_json) {
            status = json_budget(&b, caps.renderer, a->why, &a->phone);
        } else {
            print_budget(&b, caps.renderer, a->why, &a->phone);
        }
        pack_budget_free(&b);
    }
    return status;
}

static int budget_of_pack(const budget_args *a)
{
    figure_desc desc = a->figure;
    pack_file file, anim;
    int status = pack_file_open(&file, a->pack);
    if (status) {
        return status;
    }
    desc.file = &file;
    desc.hair = 1;
    status = figure_open_clips(&anim, a->anim, &file, &desc.clips);
    if (!status) status = budget_of(a, &desc);
    figure_close_clips(&anim, desc.clips);
    pack_file_close(&file);
    return status;
}

/* ---- the verb ---- */

static int check_args(budget_args *a)
{
    int status = parse_path(a->path, &a->figure.path);
    if (!status) status = parse_accumulate(a->accumulate, &a->figure.accumulate);
    if (!status) status = parse_instances(a->instances, &a->figure.actor_count);
    if (!status) status = parse_level(a->lod, &a->figure.level);
    if (!status) status = figure_tier(a->tier, &a->phone.shading);
    if (!status && a->gpu) status = budget_phone_choose(a->gpu, &a->phone);
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
    { .name = "--why",
      .kind = OPTION_FLAG,
      .at = offsetof(budget_args, why),
      .what = "also list the terms by which the morph path is chosen",
      .excludes = OF_STAGE },
    { .name = "--gpu",
      .kind = OPTION_TEXT,
      .at = offsetof(budget_args, gpu),
      .value = "g52|g57|g610|a630|v3d",
      .what = "also the share of a frame that the shaders take on this GPU, by a model: the figures of make phones",
      .example = "g52",
      .excludes = OF_STAGE },
    { .name = "--size",
      .kind = OPTION_SIZE,
      .at = offsetof(budget_args, phone.size),
      .value = "WxH",
      .initial = "1920x1080",
      .what = "size of the picture on that GPU, pixels",
      .example = "1280x720",
      .needs = "--gpu" },
    OPTION_TIER(budget_args, tier, .needs = "--gpu"),
    COUNT_OPTION("--actors", ACTORS, "N", .example = "20", .excludes = "--desc",
                 .what = "plan a stage with this many characters of the pack at one time, 1 to 65535"),
    COUNT_OPTION("--near", NEAR, "N", .needs = "--actors", .example = "4",
                 .what = "most of them at the finest level at once; default, with --middle: an even spread over 100 m"),
    COUNT_OPTION("--middle", MIDDLE, "N", .needs = "--actors", .example = "8", .what = "most at the next level"),
    COUNT_OPTION("--finest", FINEST, "K", .needs = "--actors", .example = "1",
                 .what = "the finest level that may be used, 0 to 7; 0: all"),
    { .name = "--clips",
      .kind = OPTION_LIST,
      .at = offsetof(budget_args, clips),
      .value = "PACK",
      .what = "take the clips from this pack; may repeat: a clip of a later pack replaces one of the same name",
      .example = "body_anim.noh",
      .needs = "--actors" },
    { .name = "--desc",
      .kind = OPTION_INPUT,
      .at = offsetof(budget_args, desc),
      .value = "FILE",
      .what = "plan a stage of several kinds, a text file (noh help FORMATS), in place of PACK",
      .example = "cast.txt" },
    COUNT_OPTION("--bytes", BYTES, "N", .needs = OF_STAGE, .example = "2097152",
                 .what = "limit of the stage's bytes, CPU and GPU together; lists what it gives up to meet the limit"),
    COUNT_OPTION("--cpu-bytes", CPU_BYTES, "N", .needs = OF_STAGE, .example = "1048576",
                 .what = "limit of its CPU bytes"),
    COUNT_OPTION("--gpu-bytes", GPU_BYTES, "N", .needs = OF_STAGE, .example = "1048576",
                 .what = "limit of its GPU bytes"),
    { .name = "--pixels",
      .kind = OPTION_TEXT,
      .at = offsetof(budget_args, pixels_text),
      .value = "F",
      .what = "largest error that LOD may show, in pixels, above 0; default: 1, or the value of --desc",
      .example = "0.5",
      .needs = OF_STAGE },
    COUNT_OPTION("--height", HEIGHT, "N", .needs = OF_STAGE, .example = "720",
                 .what = "picture height in lines, 1 to 65536; default: 1080, or the value of --desc"),
    COUNT_OPTION("--jobs", JOBS, "N", .needs = OF_STAGE, .example = "4", .what = "parallel jobs per frame, 1 to 64"),
    COUNT_OPTION("--ragdolls", RAGDOLLS, "N", .needs = "--actors", .example = "16",
                 .what = "characters that may be ragdolls at once, 1 to 1024"),
    { .name = "--place",
      .kind = OPTION_INPUT,
      .at = offsetof(budget_args, place),
      .value = "FILE",
      .what =
          "add a place (noh help FORMATS) with its agents, flow fields, smart objects and walkers, as in noh crowd --place",
      .example = "festival.place",
      .needs = "--actors" },
    { .name = "--ground",
      .kind = OPTION_INPUT,
      .at = offsetof(budget_args, ground),
      .value = "FILE",
      .what = "put the place on a height field, as in noh crowd --ground",
      .example = "hill.noh",
      .needs = "--place" },
    { .name = "--f16",
      .kind = OPTION_FLAG,
      .at = offsetof(budget_args, halves),
      .what = "16-bit accumulation texels",
      .needs = OF_STAGE,
      .excludes = "--no-gpu" },
    { .name = "--no-gpu",
      .kind = OPTION_FLAG,
      .at = offsetof(budget_args, without_gpu),
      .what = "plan a stage that steps and poses without drawing",
      .needs = OF_STAGE },
    { .name = "--strict",
      .kind = OPTION_FLAG,
      .at = offsetof(budget_args, strict),
      .what = "exit with 1 if the stage gives something up to meet a limit",
      .needs = OF_STAGE },
    OPTION_JSON(budget_args, as_json),
};

const verb verb_budget = {
    .name = "budget",
    .files = "PACK|MODEL",
    .what = "show the bytes that a load or a stage will take, CPU and GPU, by part",
    .more =
        "With --actors, or with --desc in place of PACK, it plans a stage: its parts, the levels of each kind, and what it gives up to meet a limit.",
    .example = "face.noh\nface.noh --instances 100 --path mrt --nominal --json\n"
               "face.noh --why --nominal\nbody.noh --actors 20 --near 4 --bytes 2097152\n--desc cast.txt --nominal",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .instead = "--desc",
    .files_at = offsetof(budget_args, pack),
    .args = &arguments,
    .run = run,
};
