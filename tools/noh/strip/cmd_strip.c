/* cmd_strip.c: a pack of the coarser LOD levels alone, out of a finished pack: for a device that never shows the finer
 * ones, or that gets them later. */
#include <stdio.h>
#include <stdlib.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"
#include "convert/pack/pack_strip.h"
#include "file/pack_file.h"
#include "stage/character/lod_pack_internal.h"

typedef struct strip_args {
    const char *pack, *output;
    option_list levels;
    int quiet, as_json;
} strip_args;

/* The level requested for all meshes: the last one without a name; 0: none. */
static uint32_t level_of_all(const option_list *levels)
{
    uint32_t of_all = 0, level;
    size_t name_bytes;
    for (int i = 0; i < levels->count; i++) {
        if (!strip_level_parse(levels->items[i], &name_bytes, &level) && !name_bytes) of_all = level;
    }
    return of_all;
}

static int check_args(const strip_args *a)
{
    uint32_t level;
    size_t name_bytes;
    for (int i = 0; i < a->levels.count; i++) {
        if (strip_level_parse(a->levels.items[i], &name_bytes, &level)) {
            return tool_usage("--from-level must be K or MESH=K, K from 0 to %u, not '%s'", NOH_LOD_LEVELS_MAX - 1u,
                              a->levels.items[i]);
        }
    }
    return a->as_json && report_stream(a->output) != stdout ? tool_usage("--json and -o both write to stdout") : 0;
}

/* The largest error of the finest remaining level, millimetres, on which the choice of LOD depends. */
static double error_mm(const noh_mesh *mesh)
{
    noh_lod_mesh levels[NOH_LOD_LEVELS_MAX];
    noh_lod_table table;
    noh_lod_mesh_levels(mesh, levels, &table);
    return 1e3 * (double)levels[table.mesh_level_first].error_m;
}

static void print_meshes(FILE *report, const noh_pack *before, const noh_pack *after)
{
    noh_mesh from, to;
    for (uint32_t i = 0; noh_pack_mesh_at(after, i, &to, NULL) == NOH_OK; i++) {
        (void)noh_pack_mesh_at(before, i, &from, NULL);
        fprintf(report, "mesh '%s': levels %u to %u; %u of %u vertices, %u of %u triangles, off by at most %.3f mm\n",
                to.name, to.header->level, to.header->level_count - 1u, to.header->vertex_count,
                from.header->vertex_count, to.header->index_count / 3u, from.header->index_count / 3u, error_mm(&to));
    }
}

static void json_mesh(json *j, const noh_mesh *from, const noh_mesh *to)
{
    json_open(j, NULL, '{');
    json_text(j, "name", to->name);
    json_integer(j, "level_first", to->header->level);
    json_integer(j, "level_count", to->header->level_count);
    json_integer(j, "source", noh_mesh_source(to));
    json_integer(j, "vertices_before", from->header->vertex_count);
    json_integer(j, "vertices", to->header->vertex_count);
    json_integer(j, "triangles_before", from->header->index_count / 3u);
    json_integer(j, "triangles", to->header->index_count / 3u);
    json_number(j, "error_um", 1e3 * error_mm(to));
    json_close(j, '}');
}

static int print_json(const strip_args *a, const noh_pack *before, const noh_pack *after)
{
    json j = json_begin();
    noh_mesh from, to;
    json_text(&j, "input", a->pack);
    json_text(&j, "output", a->output);
    json_integer(&j, "from_level", level_of_all(&a->levels));
    json_integer(&j, "bytes_before", before->byte_count);
    json_integer(&j, "bytes_after", after->byte_count);
    json_open(&j, "meshes", '[');
    for (uint32_t i = 0; noh_pack_mesh_at(after, i, &to, NULL) == NOH_OK; i++) {
        (void)noh_pack_mesh_at(before, i, &from, NULL);
        json_mesh(&j, &from, &to);
    }
    json_close(&j, ']');
    return json_end(&j);
}

static int report_all(const strip_args *a, const noh_pack *before, const noh_pack *after)
{
    FILE *report = report_stream(a->output);
    if (a->as_json) {
        return print_json(a, before, after);
    }
    if (!a->quiet) {
        print_meshes(report, before, after);
        fprintf(report, "%s: %u bytes of %u\n", a->output, after->byte_count, before->byte_count);
    }
    return 0;
}

/* The stripped pack is opened with the library's own reader before it is written. */
static int write_pack(const strip_args *a, const noh_pack *before, const byte_buffer *out)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_pack after;
    if (noh_pack_open(out->bytes, out->count, &after, &error)) {
        return tool_fail(a->pack,
                         "the stripped pack does not open: %s (byte %llu); this is a bug in noh: please report it",
                         error.what, (unsigned long long)error.where);
    }
    if (noh_file_write(a->output, out->bytes, out->count, &error)) {
        return tool_fail(a->output, "cannot write: %s", error.what);
    }
    return report_all(a, before, &after);
}

static int strip(const strip_args *a, const noh_pack *pack)
{
    const strip_levels levels = { a->levels.items, (uint32_t)a->levels.count };
    uint32_t *first = calloc(pack->runs[NOH_CHUNK_MESH].count + 1u, sizeof *first);
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error;
    int status = first ? 0 : tool_fail(a->pack, "out of memory");
    if (!status && !pack->runs[NOH_CHUNK_MESH].count) {
        status = tool_fail(a->pack, "the pack has no meshes, and so no levels to strip");
    }
    if (!status && (strip_levels_of(&levels, pack, first, &error) || pack_strip(pack, first, &out, &error))) {
        status = tool_fail(a->pack, "%s", error.what);
    }
    if (!status) status = write_pack(a, pack, &out);
    buffer_free(&out);
    free(first);
    return status;
}

static int run(void *args)
{
    const strip_args *a = args;
    pack_file file;
    int status = check_args(a);
    if (!status) status = pack_file_open(&file, a->pack);
    if (!status) {
        status = strip(a, &file.pack);
        pack_file_close(&file);
    }
    return status;
}

static strip_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(strip_args, output),
      .required = 1,
      .value = "OUT.noh",
      .what = "the pack without the finer levels",
      .example = "small.noh" },
    { .name = "--from-level",
      .kind = OPTION_LIST,
      .at = offsetof(strip_args, levels),
      .required = 1,
      .value = "K|MESH=K",
      .what =
          "the finest level to keep, 0 to 7, for all meshes or for one; a mesh with fewer levels keeps its coarsest; may repeat: the last one for each mesh counts",
      .example = "2" },
    { .name = "--quiet",
      .kind = OPTION_FLAG,
      .at = offsetof(strip_args, quiet),
      .what = "no report",
      .excludes = "--json" },
    OPTION_JSON(strip_args, as_json),
};

const verb verb_strip = {
    .name = "strip",
    .files = "PACK|MODEL",
    .what = "make a pack of only the coarser LOD levels from a finished pack",
    .more =
        "Levels keep their numbers and errors, so they are chosen and look the same as in the full pack. Skins, clips, nodes, materials and textures are unchanged.",
    .example =
        "head.noh -o head_small.noh --from-level 2\nbody.noh -o body_small.noh --from-level 1 --from-level mask=3",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(strip_args, pack),
    .args = &arguments,
    .run = run,
};
