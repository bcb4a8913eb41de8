/* cmd_mask.c: checks a painted mask of wrinkle regions: damage, regions, repair. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"
#include "convert/wrinkle/mask_clinic.h"
#include "file/png_file.h"
#include "mask/mask_export.h"

typedef struct mask_args {
    const char *file, *output, *show, *exported;
    double size;
    int as_json, quiet;
} mask_args;

static const char *const channel_names[4] = { "red", "green", "blue", "alpha" };

static const struct {
    uint32_t damage;
    const char *name, *advice;
} causes[] = {
    { MASK_BLOCKS, "block-compression", "keep the mask uncompressed; noh build compresses the maps it makes from it" },
    { MASK_GAMMA, "gamma", "save it without colour management, as linear data" },
    { MASK_SMOOTHED, "smoothing", "select without anti-aliasing, and resize by nearest texels only" },
};
#define CAUSE_COUNT (sizeof causes / sizeof causes[0])

static uint32_t sum_of(const uint32_t counts[4])
{
    return counts[0] + counts[1] + counts[2] + counts[3];
}

static void print_causes(FILE *out, const mask_findings *f)
{
    const uint32_t guard = sum_of(f->guard);
    for (size_t i = 0; i < CAUSE_COUNT; i++) {
        if (f->damage & causes[i].damage) {
            fprintf(out, "damage: %s%s%s: %s\n", causes[i].name, causes[i].damage == MASK_GAMMA ? ", " : "",
                    causes[i].damage == MASK_GAMMA ? f->gamma : "", causes[i].advice);
        }
    }
    if (!f->damage && guard) {
        fprintf(out, "damage: illegal codes of unknown cause; --show draws where they are\n");
    }
    if (!f->damage && !guard) {
        fprintf(out, "no damage\n");
    }
    if (!f->damage && sum_of(f->even_full) < sum_of(f->even)) {
        fprintf(out, "%u of %u texels in even areas have less than full weight\n",
                sum_of(f->even) - sum_of(f->even_full), sum_of(f->even));
    }
}

static void print_regions(FILE *out, const mask_findings *f)
{
    fprintf(out, "%-8s %-8s %-8s %9s %9s %6s   %s\n", "region", "channel", "codes", "texels", "full", "mean",
            "left, top to right, bottom");
    for (uint32_t r = 0; r < REGION_COUNT; r++) {
        const mask_region *region = &f->regions[r];
        const uint32_t first = r % 3 * REGION_STEP;
        fprintf(out, "%-8u %-8s %3u-%-4u %9u %9u %6.3f   ", r, channel_names[r / 3], first, first + REGION_LAST,
                region->texels, region->full, (double)region->mean);
        if (region->texels) {
            fprintf(out, "%u, %u to %u, %u\n", region->left, region->top, region->right, region->bottom);
        } else {
            fprintf(out, "empty\n");
        }
    }
}

static void print_text(FILE *out, const mask_args *a, const region_mask *m, const mask_findings *f, uint32_t changed)
{
    fprintf(out, "%s: %u x %u texels, %u illegal codes, %u of %u edge texels are seams\n", a->file, m->width, m->height,
            sum_of(f->guard), sum_of(f->seams), sum_of(f->edges));
    print_causes(out, f);
    print_regions(out, f);
    if (a->output) {
        fprintf(out, "%s: %u texel%s changed\n", a->output, changed, plural(changed));
    }
}

static void json_channels(json *j, const mask_findings *f)
{
    json_open(j, "channels", '[');
    for (uint32_t c = 0; c < 4; c++) {
        json_open(j, NULL, '{');
        json_text(j, "name", channel_names[c]);
        json_integer(j, "illegal", f->guard[c]);
        json_integer(j, "seams", f->seams[c]);
        json_integer(j, "edges", f->edges[c]);
        json_integer(j, "even", f->even[c]);
        json_integer(j, "even_full", f->even_full[c]);
        json_open(j, "histogram", '[');
        for (uint32_t code = 0; code < 256; code++) {
            json_integer(j, NULL, f->histogram[c][code]);
        }
        json_close(j, ']');
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_regions(json *j, const mask_findings *f)
{
    json_open(j, "regions", '[');
    for (uint32_t r = 0; r < REGION_COUNT; r++) {
        const mask_region *region = &f->regions[r];
        json_open(j, NULL, '{');
        json_integer(j, "region", r);
        json_text(j, "channel", channel_names[r / 3]);
        json_integer(j, "first_code", r % 3 * REGION_STEP);
        json_integer(j, "last_code", r % 3 * REGION_STEP + REGION_LAST);
        json_integer(j, "texels", region->texels);
        json_integer(j, "full", region->full);
        json_number(j, "mean", (double)region->mean);
        json_integer(j, "left", region->left);
        json_integer(j, "top", region->top);
        json_integer(j, "right", region->right);
        json_integer(j, "bottom", region->bottom);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static int print_json(const mask_args *a, const region_mask *m, const mask_findings *f, uint32_t changed)
{
    json j = json_begin();
    json_text(&j, "input", a->file);
    json_integer(&j, "width", m->width);
    json_integer(&j, "height", m->height);
    json_integer(&j, "illegal", sum_of(f->guard));
    json_open(&j, "damage", '[');
    for (size_t i = 0; i < CAUSE_COUNT; i++) {
        if (f->damage & causes[i].damage) json_text(&j, NULL, causes[i].name);
    }
    if (!f->damage && sum_of(f->guard)) json_text(&j, NULL, "unknown");
    json_close(&j, ']');
    if (f->gamma) {
        json_text(&j, "gamma", f->gamma);
    } else {
        json_null(&j, "gamma");
    }
    json_integer(&j, "blocks", f->blocks);
    json_integer(&j, "blocks_stored", f->blocks_stored);
    json_channels(&j, f);
    json_regions(&j, f);
    if (a->output) json_integer(&j, "changed", changed);
    return json_end(&j);
}

static int write_picture(const mask_args *a, const region_mask *mask)
{
    uint8_t *picture = mask_show(mask);
    const int status = picture ? tool_write_png(a->show, mask->width, mask->height, picture)
                               : tool_fail(a->file, "out of memory");
    free(picture);
    return status;
}

static int look_over(const mask_args *a, region_mask *mask)
{
    mask_findings found;
    uint32_t changed = 0;
    int status = mask_examine(mask, &found) ? tool_fail(a->file, "out of memory") : 0;
    const region_mask seen = *mask;
    if (!status && a->show) status = write_picture(a, mask);
    if (!status && a->output) {
        changed = mask_repair(mask, &found);
        status = changed == UINT32_MAX ? tool_fail(a->file, "out of memory")
                                       : tool_write_png(a->output, mask->width, mask->height, mask->rgba);
    }
    if (!status && a->as_json) {
        status = print_json(a, &seen, &found, changed);
    } else if (!status && !a->quiet) {
        print_text(a->output ? report_stream(a->output) : stdout, a, &seen, &found, changed);
    }
    return status;
}

static int run(void *args)
{
    const mask_args *a = args;
    model_error error = { "", "" };
    region_mask mask;
    int status;
    if (a->as_json && a->output && report_stream(a->output) != stdout) {
        return tool_usage("--json and -o both write to stdout");
    }
    if (mask_is_exported(a->file) && !a->exported) {
        return tool_usage("noh mask checks a PNG; use --export FILE.png to write one from a pack or a model");
    }
    if (a->size != (double)(uint32_t)a->size || (a->size > 0.0 && a->size < 16.0) || a->size > 4096.0) {
        return tool_usage("--size must be a whole number of texels from 16 to 4096, or 0");
    }
    if (a->exported) {
        status = mask_export(a->file, (uint32_t)a->size, &mask);
        if (!status) status = tool_write_png(a->exported, mask.width, mask.height, mask.rgba);
        if (status) region_mask_free(&mask);
        if (status) return status;
    } else if (region_mask_read(a->file, &mask, &error)) {
        return tool_fail(a->file, "%s", error.what);
    }
    status = look_over(a, &mask);
    region_mask_free(&mask);
    return status;
}

static mask_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(mask_args, output),
      .value = "OUT.png",
      .what = "a repaired mask, without illegal codes",
      .example = "repaired.png" },
    { .name = "--show",
      .kind = OPTION_OUTPUT,
      .at = offsetof(mask_args, show),
      .value = "OUT.png",
      .what = "a picture of the damage: illegal codes red, seams yellow",
      .example = "damage.png" },
    { .name = "--export",
      .kind = OPTION_OUTPUT,
      .at = offsetof(mask_args, exported),
      .value = "OUT.png",
      .what =
          "write the regions of a pack, or the regions that noh build --wrinkles auto would give a model with targets, as a mask to paint on; noh build --region-mask reads it",
      .example = "regions.png",
      .excludes = "-o" },
    { .name = "--size",
      .kind = OPTION_NUMBER,
      .at = offsetof(mask_args, size),
      .value = "N",
      .initial = "0",
      .what = "side of a model's mask, texels; 0: as noh build would make it, a quarter of the normal map's side",
      .example = "512",
      .needs = "--export" },
    { .name = "--quiet",
      .kind = OPTION_FLAG,
      .at = offsetof(mask_args, quiet),
      .what = "no report",
      .excludes = "--json" },
    OPTION_JSON(mask_args, as_json),
};

const verb verb_mask = {
    .name = "mask",
    .files = "FILE",
    .what = "check and repair a painted mask of wrinkle regions, or write one to paint on",
    .more =
        "Each channel of a mask has three regions, by its value: 0 to 75, 90 to 165, 180 to 255. Values between these ranges are illegal: they come from anti-aliasing, colour management or block compression, which also change regions into others.",
    .example = "regions.png\nregions.png -o repaired.png --show damage.png\nhead.glb --export regions.png",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(mask_args, file),
    .args = &arguments,
    .run = run,
};
