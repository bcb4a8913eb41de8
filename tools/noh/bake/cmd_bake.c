/* cmd_bake.c: normal maps out of height maps and fine models. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"
#include "convert/base/file_kind.h"
#include "convert/base/image_file.h"
#include "convert/normal/normal_bake.h"
#include "convert/normal/normal_height.h"
#include "convert/obj/obj_read.h"
#include "file/png_file.h"

#define SIZE_MAX_TEXELS 8192.0

typedef struct bake_args {
    const char *file, *output, *from, *material;
    double depth, size, reach_mm;
    int tiles, as_json, quiet;
} bake_args;

static void report(const bake_args *a, uint32_t width, uint32_t height, const normal_map *map)
{
    FILE *out = report_stream(a->output);
    if (a->as_json) {
        json j = json_begin();
        json_text(&j, "input", a->file);
        json_text(&j, "output", a->output);
        json_integer(&j, "width", width);
        json_integer(&j, "height", height);
        if (map) {
            json_integer(&j, "covered", map->covered);
            json_integer(&j, "overlapped", map->overlapped);
            json_integer(&j, "missed", map->missed);
            json_number(&j, "reach_mm", 1000.0 * map->reach);
            json_number(&j, "lean_degrees", map->lean);
        }
        (void)json_end(&j);
        return;
    }
    if (a->quiet) return;
    fprintf(out, "%s: %u x %u texels", a->output, width, height);
    if (map) {
        fprintf(
            out,
            ", %u covered, %u overlaps, %u without a fine surface within %.3g mm; mean tilt of normals %.2f degrees",
            map->covered, map->overlapped, map->missed, 1000.0 * map->reach, map->lean);
    }
    fprintf(out, "\n");
}

static int bake_height(const bake_args *a)
{
    model_error error = { "", "" };
    uint32_t width, height;
    uint16_t *heights;
    uint8_t *rgba;
    int status;
    if (image_read_grey(a->file, &width, &height, &heights, &error)) return tool_fail(a->file, "%s", error.what);
    rgba = normal_map_of_height(heights, width, height, a->depth, a->tiles);
    free(heights);
    if (!rgba) return tool_fail(a->file, "out of memory");
    status = tool_write_png(a->output, width, height, rgba);
    free(rgba);
    if (!status) report(a, width, height, NULL);
    return status;
}

static int read_model(const char *path, model **out)
{
    const obj_options obj = { 0.0, NULL };
    model_error error = { "", "" };
    const int failed = file_has_ending(path, ".obj") ? obj_read(path, &obj, out, &error)
                                                     : model_read_gltf(path, out, &error);
    return failed
               ? tool_fail(path, "%s%s%s%s", error.what, *error.where ? " (" : "", error.where, *error.where ? ")" : "")
               : 0;
}

static int bake_model(const bake_args *a)
{
    const normal_bake_settings settings = { (uint32_t)a->size, a->reach_mm / 1000.0, a->material };
    model_error error = { "", "" };
    model *coarse = NULL, *fine = NULL;
    normal_map map = { 0 };
    int status = read_model(a->file, &coarse);
    if (!status) status = read_model(a->from, &fine);
    if (!status && normal_map_bake(coarse, fine, &settings, &map, &error))
        status = tool_fail(a->file, "%s", error.what);
    if (!status && map.missed == map.covered) {
        status = tool_fail(a->from, "no part of it lies within %.3g mm of %s: raise --reach-mm, or align the models",
                           1000.0 * map.reach, a->file);
    }
    if (!status) status = tool_write_png(a->output, map.size, map.size, map.rgba);
    if (!status) report(a, map.size, map.size, &map);
    free(map.rgba);
    if (coarse) model_free(coarse);
    if (fine) model_free(fine);
    return status;
}

static int run(void *args)
{
    const bake_args *a = args;
    if (a->as_json && report_stream(a->output) != stdout) return tool_usage("--json and -o both write to stdout");
    if (file_has_ending(a->file, ".png") == (a->from != NULL)) {
        return tool_usage("noh bake needs a height map (.png), or a model with --from FINE");
    }
    if (!a->from) {
        if (!(fabs(a->depth) <= 1e6) || a->depth == 0.0) {
            return tool_usage("--depth must be -1000000 to 1000000 texels, and not 0");
        }
        return bake_height(a);
    }
    if (!(a->size >= 16.0 && a->size <= SIZE_MAX_TEXELS) || a->size != floor(a->size)) {
        return tool_usage("--size must be a whole number of texels from 16 to 8192");
    }
    if (!(a->reach_mm >= 0.0 && a->reach_mm <= 1e6)) return tool_usage("--reach-mm must be 0 to 1000000");
    return bake_model(a);
}

static bake_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(bake_args, output),
      .required = 1,
      .value = "OUT.png",
      .what = "the normal map: tangent space, +y up",
      .example = "normal.png" },
    { .name = "--depth",
      .kind = OPTION_NUMBER,
      .at = offsetof(bake_args, depth),
      .value = "TEXELS",
      .initial = "8",
      .what = "height map: height of white above black, in texels; negative: below",
      .example = "20",
      .excludes = "--from" },
    { .name = "--tiles",
      .kind = OPTION_FLAG,
      .at = offsetof(bake_args, tiles),
      .what = "height map: it repeats, so each edge continues at the opposite edge",
      .excludes = "--from" },
    { .name = "--from",
      .kind = OPTION_INPUT,
      .at = offsetof(bake_args, from),
      .value = "FINE",
      .what = "a finer model (.glb, .gltf, .obj) of the same shape as FILE, both in their bind pose",
      .example = "sculpt.glb" },
    { .name = "--size",
      .kind = OPTION_NUMBER,
      .at = offsetof(bake_args, size),
      .value = "N",
      .initial = "1024",
      .what = "side of the map, texels, 16 to 8192",
      .example = "512",
      .needs = "--from" },
    { .name = "--reach-mm",
      .kind = OPTION_NUMBER,
      .at = offsetof(bake_args, reach_mm),
      .value = "MM",
      .initial = "0",
      .what =
          "largest distance to the fine surface along the normal, millimetres; 0: 2 % of the diagonal of FILE's bounding box",
      .example = "4",
      .needs = "--from" },
    { .name = "--material",
      .kind = OPTION_TEXT,
      .at = offsetof(bake_args, material),
      .value = "NAME",
      .what = "bake only the triangles of FILE with this material, where several share the texture coordinates",
      .example = "skin",
      .needs = "--from" },
    { .name = "--quiet",
      .kind = OPTION_FLAG,
      .at = offsetof(bake_args, quiet),
      .what = "no report",
      .excludes = "--json" },
    OPTION_JSON(bake_args, as_json),
};

const verb verb_bake = {
    .name = "bake",
    .files = "FILE",
    .what = "make a normal map from a height map or from a finer model",
    .more =
        "The map fits the texture coordinates, normals and tangents of FILE, or those noh generates where FILE has none. Set it as the normalTexture of the model's material.",
    .example = "heights.png -o normal.png --depth 12\nhead.glb --from sculpt.glb -o normal.png --size 1024",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(bake_args, file),
    .args = &arguments,
    .run = run,
};
