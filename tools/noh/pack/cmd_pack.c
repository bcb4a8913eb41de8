/* cmd_pack.c: the wire form of a pack. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"
#include "convert/pack/pack_order.h"
#include "convert/pack/pack_round.h"
#include "convert/pack/pack_strip.h"
#include "convert/pack/pack_wire.h"
#include "file/pack_file.h"
#include "noh/base.h"
#include "noh/pack.h"

typedef struct pack_args {
    const char *pack, *output;
    double error_um;
    int keep_tangents, at_once, quiet, as_json;
} pack_args;

/* The steps from a pack to its wire form, and the report. */
typedef struct packing {
    const pack_args *a;
    const noh_pack *from;
    noh_pack packs[2]; /* the coarse one, where there is one, and the whole one */
    uint32_t pack_count;
    byte_buffer ordered, rounded, coarse, out;
    round_mesh *meshes;
    wire_grid *grids;
    wire_report report;
    noh_wire_info info;
} packing;

/* ---- the report ---- */

static void print_mesh(FILE *report, const packing *p, uint32_t i)
{
    const round_mesh *m = &p->meshes[i];
    const char *name = noh_pack_chunk_name(p->from, p->from->runs[NOH_CHUNK_MESH].first + i);
    if (m->dropped_tangents) {
        fprintf(report, "mesh '%s': no material needs tangents: they were left out (--keep-tangents keeps them)\n",
                name);
    }
    if (p->a->error_um > 0.0 && m->grid.step > 0.0f) {
        fprintf(report, "mesh '%s': vertices moved by at most %.2f um, normals turned by %.2f degrees", name,
                1e6 * m->moved_m, m->turned);
        fprintf(report, m->delta_off > 0.0 ? ", target normals off by %.4f\n" : "\n", m->delta_off);
    } else if (p->a->error_um > 0.0) {
        fprintf(report, "mesh '%s': too large for the grid of --error-um: its positions stay exact\n", name);
    }
}

static void print_text(const packing *p)
{
    FILE *report = report_stream(p->a->output);
    const wire_report *r = &p->report;
    for (uint32_t i = 0; i < p->from->runs[NOH_CHUNK_MESH].count; i++) print_mesh(report, p, i);
    fprintf(report, "%s: %zu bytes of %u, unpacked in a block of %u", p->a->output, p->out.count, p->from->byte_count,
            p->info.block_bytes);
    fprintf(report, p->info.coarse_bytes ? ", the coarsest levels first (a pack of %u)\n" : "\n", p->info.coarse_bytes);
    fprintf(
        report,
        "  triangles %llu, positions %llu, attributes %llu, influences %llu, deltas %llu, textures %llu, the rest %llu\n",
        (unsigned long long)r->triangles, (unsigned long long)r->positions, (unsigned long long)r->attributes,
        (unsigned long long)r->influences, (unsigned long long)r->deltas, (unsigned long long)r->textures,
        (unsigned long long)r->rest);
}

static void json_mesh(json *j, const packing *p, uint32_t i)
{
    const round_mesh *m = &p->meshes[i];
    json_open(j, NULL, '{');
    json_text(j, "name", noh_pack_chunk_name(p->from, p->from->runs[NOH_CHUNK_MESH].first + i));
    json_integer(j, "tangents_left_out", (uint32_t)m->dropped_tangents);
    json_number(j, "moved_um", 1e6 * m->moved_m);
    json_number(j, "normals_degrees", m->turned);
    json_number(j, "delta_normals", m->delta_off);
    json_close(j, '}');
}

static int print_json(const packing *p)
{
    const wire_report *r = &p->report;
    json j = json_begin();
    json_text(&j, "input", p->a->pack);
    json_text(&j, "output", p->a->output);
    json_integer(&j, "bytes_before", p->from->byte_count);
    json_integer(&j, "bytes_after", (uint32_t)p->out.count);
    json_integer(&j, "block_bytes", p->info.block_bytes);
    json_integer(&j, "pack_bytes", p->info.pack_bytes);
    json_integer(&j, "coarse_bytes", p->info.coarse_bytes);
    json_integer(&j, "first_bytes", (uint32_t)r->first);
    json_integer(&j, "triangles_bytes", (uint32_t)r->triangles);
    json_integer(&j, "positions_bytes", (uint32_t)r->positions);
    json_integer(&j, "attributes_bytes", (uint32_t)r->attributes);
    json_integer(&j, "influences_bytes", (uint32_t)r->influences);
    json_integer(&j, "deltas_bytes", (uint32_t)r->deltas);
    json_integer(&j, "textures_bytes", (uint32_t)r->textures);
    json_open(&j, "meshes", '[');
    for (uint32_t i = 0; i < p->from->runs[NOH_CHUNK_MESH].count; i++) json_mesh(&j, p, i);
    json_close(&j, ']');
    return json_end(&j);
}

/* ---- the way ---- */

static int open_made(const packing *p, const byte_buffer *made, noh_pack *pack)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    if (noh_pack_open(made->bytes, made->count, pack, &error)) {
        return tool_fail(p->a->pack,
                         "an intermediate pack does not open: %s (byte %llu); this is a bug in noh: please report it",
                         error.what, (unsigned long long)error.where);
    }
    return 0;
}

/* The coarsest levels as a pack of their own, where there are any. */
static int make_coarse(packing *p)
{
    const noh_pack *whole = &p->packs[0];
    uint32_t *first = calloc(whole->runs[NOH_CHUNK_MESH].count + 1u, sizeof *first), levels = 0;
    model_error error;
    int status = 0;
    if (!first) return tool_fail(p->a->pack, "out of memory");
    for (uint32_t i = 0; i < whole->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        (void)noh_pack_mesh_at(whole, i, &mesh, NULL);
        first[i] = mesh.header->level_count - 1u;
        levels += first[i] - mesh.header->level_first;
    }
    if (levels && !p->a->at_once) {
        if (pack_strip(whole, first, &p->coarse, &error)) status = tool_fail(p->a->pack, "%s", error.what);
        p->packs[1] = p->packs[0];
        if (!status) status = open_made(p, &p->coarse, &p->packs[0]);
        p->pack_count = 2;
    }
    free(first);
    return status;
}

static int make_packs(packing *p)
{
    const round_desc desc = { 1e-6 * p->a->error_um, p->a->keep_tangents };
    noh_pack ordered = *p->from;
    model_error error;
    int status = 0;
    if (desc.bound_m > 0.0) {
        if (pack_order(p->from, &p->ordered, &error)) return tool_fail(p->a->pack, "%s", error.what);
        status = open_made(p, &p->ordered, &ordered);
    }
    if (!status && pack_round(&ordered, &desc, &p->rounded, p->meshes, &error)) {
        status = tool_fail(p->a->pack, "%s", error.what);
    }
    for (uint32_t i = 0; !status && i < p->from->runs[NOH_CHUNK_MESH].count; i++) p->grids[i] = p->meshes[i].grid;
    if (!status) status = open_made(p, &p->rounded, &p->packs[0]);
    p->pack_count = 1;
    return status ? status : make_coarse(p);
}

/* The result is unpacked with the library's own reader, and must equal the pack, before it is written. */
static int check_back(packing *p)
{
    const noh_pack *whole = &p->packs[p->pack_count - 1u];
    noh_error error = { NOH_OK, "other bytes", 0, 0 };
    void *memory = malloc(noh_wire_size());
    noh_wire_desc desc;
    noh_wire *wire;
    int status = 0;
    (void)noh_wire_info_read(p->out.bytes, p->out.count, &p->info, &error);
    desc.block_bytes = p->info.block_bytes;
    desc.block = malloc(desc.block_bytes + 1u);
    if (!memory || !desc.block) {
        status = tool_fail(p->a->pack, "out of memory");
    } else if (noh_wire_init(memory, noh_wire_size(), &desc, &wire, &error) ||
               noh_wire_push(wire, p->out.bytes, p->out.count, &error) || !noh_wire_is_complete(wire) ||
               memcmp(desc.block, whole->bytes, whole->byte_count) != 0) {
        status = tool_fail(
            p->a->pack,
            "the wire form does not unpack to the pack: %s (byte %llu); this is a bug in noh: please report it",
            error.what, (unsigned long long)error.where);
    }
    free(memory);
    free(desc.block);
    return status;
}

static int write_wire(packing *p)
{
    const int rounds = p->a->error_um > 0.0;
    const wire_steps steps = { p->grids, rounds ? ROUND_NORMAL_STEPS : 32767u, rounds ? ROUND_UV_STEPS : 65535u,
                               rounds ? ROUND_WEIGHT_SHIFT : 0u };
    noh_error error;
    model_error made;
    int status;
    if (pack_wire(p->packs, p->pack_count, &steps, &p->out, &p->report, &made)) {
        return tool_fail(p->a->pack, "%s", made.what);
    }
    status = check_back(p);
    if (!status && noh_file_write(p->a->output, p->out.bytes, p->out.count, &error)) {
        status = tool_fail(p->a->output, "cannot write: %s", error.what);
    }
    if (!status && p->a->as_json) return print_json(p);
    if (!status && !p->a->quiet) print_text(p);
    return status;
}

static int pack(const pack_args *a, const noh_pack *from)
{
    packing p;
    int status;
    memset(&p, 0, sizeof p);
    p.a = a;
    p.from = from;
    p.meshes = calloc(from->runs[NOH_CHUNK_MESH].count + 1u, sizeof *p.meshes);
    p.grids = calloc(from->runs[NOH_CHUNK_MESH].count + 1u, sizeof *p.grids);
    status = p.meshes && p.grids ? make_packs(&p) : tool_fail(a->pack, "out of memory");
    if (!status) status = write_wire(&p);
    buffer_free(&p.ordered);
    buffer_free(&p.rounded);
    buffer_free(&p.coarse);
    buffer_free(&p.out);
    free(p.meshes);
    free(p.grids);
    return status;
}

static int check_args(const pack_args *a)
{
    if (a->error_um < 0.0 || a->error_um > 1e6) {
        return tool_usage("--error-um must be a number from 0, nothing is rounded, to 1000000");
    }
    return a->as_json && report_stream(a->output) != stdout ? tool_usage("--json and -o both write to stdout") : 0;
}

static int run(void *args)
{
    const pack_args *a = args;
    pack_file file;
    int status = check_args(a);
    if (!status) status = pack_file_open(&file, a->pack);
    if (!status) {
        status = pack(a, &file.pack);
        pack_file_close(&file);
    }
    return status;
}

static pack_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(pack_args, output),
      .required = 1,
      .value = "OUT.nohz",
      .what = "the wire form",
      .example = "head.nohz" },
    { .name = "--error-um",
      .kind = OPTION_NUMBER,
      .at = offsetof(pack_args, error_um),
      .value = "UM",
      .initial = "0",
      .what =
          "round: rest positions move by at most this many micrometres, 0 to 1000000; normals become 9 bits a component (half a degree), normal deltas multiples of 0.0039, texture coordinates 12 bits, joint weights multiples of 1/16384, and triangles and vertices are reordered to compress better; 0: all values stay exact",
      .example = "10" },
    { .name = "--keep-tangents",
      .kind = OPTION_FLAG,
      .at = offsetof(pack_args, keep_tangents),
      .what = "keep the tangents of meshes without a normal map, too" },
    { .name = "--at-once",
      .kind = OPTION_FLAG,
      .at = offsetof(pack_args, at_once),
      .what = "write only the whole pack, without the coarsest LOD levels first" },
    { .name = "--quiet",
      .kind = OPTION_FLAG,
      .at = offsetof(pack_args, quiet),
      .what = "no report",
      .excludes = "--json" },
    OPTION_JSON(pack_args, as_json),
};

const verb verb_pack = {
    .name = "pack",
    .files = "PACK|MODEL",
    .what = "make the wire form of a pack: several times smaller to send, unpacked while it arrives",
    .more =
        "Every verb that reads a pack also reads its wire form. A game unpacks it piece by piece with noh_wire_push (noh/pack.h). A pack with LOD levels is preceded by a pack of its coarsest levels, which can be shown while the rest arrives.",
    .example = "head.noh -o head.nohz\nhead.noh -o head.nohz --error-um 10",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(pack_args, pack),
    .args = &arguments,
    .run = run,
};
