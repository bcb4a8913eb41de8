/* pack_wire.c: runs the filters of runtime/core/wire/ over a finished pack, records what they code, and writes it in
 * blocks.
 *
 * The coder of runtime/core/wire/ decodes last what was coded first, so the symbols of a block are kept and coded
 * backwards. Where a filter has modes, each is tried and the shortest kept. */
#include "pack_wire.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"
#include "core/mesh/mesh_internal.h"
#include "core/wire/wire_internal.h"
#include "wire_like.h"

#define SYMBOLS_MAX (1u << 18) /* of a block: 16 KiB of bits, and what weighs next to nothing */
#define BITS_MAX (8.0 * 14000.0)

typedef struct symbol {
    uint16_t start, frequency;
} symbol;

typedef struct writer {
    noh_wire_filter filter;
    symbol *symbols;
    uint32_t symbol_count;
    uint32_t items_left;
    double bits, all_bits; /* of the block, of the section */
    int full;
    const float *costs; /* [32768] bits of a frequency */
    byte_buffer *out;
    uint32_t crc;
    const wire_steps *steps;
    wire_report *report;
} writer;

/* ---- blocks ---- */

static void record(void *user, uint32_t start, uint32_t frequency)
{
    writer *w = user;
    const symbol s = { (uint16_t)start, (uint16_t)frequency };
    w->symbols[w->symbol_count++] = s;
    w->bits += (double)w->costs[frequency];
    if (!w->full && (w->bits > BITS_MAX || w->symbol_count > SYMBOLS_MAX - 4096u)) {
        w->full = 1;
        w->items_left = w->filter.coder.items;
        w->filter.coder.items = 0;
    }
}

static void append_block(writer *w, const void *bytes, uint32_t count, uint32_t items, uint32_t flag)
{
    uint8_t head[NOH_WIRE_BLOCK_HEAD_BYTES];
    const uint32_t size = count | flag;
    head[0] = (uint8_t)items;
    head[1] = (uint8_t)(items >> 8);
    head[2] = (uint8_t)size;
    head[3] = (uint8_t)(size >> 8);
    w->crc = noh_crc32c(noh_crc32c(w->crc, head, 4), bytes, count);
    for (uint32_t i = 0; i < 4u; i++) head[4u + i] = (uint8_t)(w->crc >> 8u * i);
    buffer_append(w->out, head, sizeof head);
    buffer_append(w->out, bytes, count);
}

/* Backwards: the last symbol first, into the end of the memory. */
static uint32_t encode(const writer *w, uint8_t *memory, uint32_t size)
{
    uint32_t at = size, x = NOH_WIRE_LOW;
    for (uint32_t i = w->symbol_count; i > 0; i--) {
        const symbol s = w->symbols[i - 1u];
        if ((uint64_t)x >= (uint64_t)s.frequency << 17) {
            memory[--at] = (uint8_t)(x >> 8);
            memory[--at] = (uint8_t)x;
            x >>= 16;
        }
        x = ((x / s.frequency) << NOH_WIRE_SCALE_BITS) + x % s.frequency + s.start;
    }
    for (uint32_t i = 0; i < 4u; i++) memory[--at] = (uint8_t)(x >> (24u - 8u * i));
    return at;
}

static void begin_block(writer *w)
{
    w->filter.coder.items = NOH_WIRE_ITEMS_MAX;
    w->filter.coder.record = record;
    w->filter.coder.user = w;
    w->symbol_count = 0;
    w->bits = 0.0;
    w->full = 0;
}

static void end_block(writer *w, int write)
{
    const uint32_t left = w->full ? w->items_left + w->filter.coder.items : w->filter.coder.items;
    w->all_bits += w->bits + 96.0;
    if (write) {
        static uint8_t memory[65536];
        const uint32_t at = encode(w, memory, sizeof memory);
        append_block(w, memory + at, (uint32_t)sizeof memory - at, NOH_WIRE_ITEMS_MAX - left, 0);
    }
}

/* ---- sections ---- */

static void append_section(writer *w, const noh_wire_section *s)
{
    uint8_t bytes[NOH_WIRE_SECTION_BYTES];
    noh_wire_section_write(s, bytes);
    append_block(w, bytes, sizeof bytes, 0, NOH_WIRE_BLOCK_SECTION);
}

/* Run a section; its bits. */
static double run(writer *w, const noh_wire_section *s, int write)
{
    int done;
    if (write) append_section(w, s);
    w->all_bits = 0.0;
    begin_block(w);
    done = noh_wire_begin(&w->filter, s);
    while (!done) {
        begin_block(w);
        done = noh_wire_run(&w->filter);
        end_block(w, write);
    }
    return done < 0 ? 1e30 : w->all_bits;
}

static double write_section(writer *w, const noh_wire_section *s, uint64_t *sum)
{
    const size_t before = w->out->count;
    const double bits = run(w, s, 1);
    *sum += w->out->count - before;
    return bits;
}

/* The mode with the fewest bits, and how many. */
static double find_best(writer *w, noh_wire_section *s, uint32_t modes)
{
    double best = 1e31;
    uint32_t mode = 0;
    for (uint32_t i = 0; i < modes; i++) {
        double bits;
        s->mode = (uint8_t)i;
        bits = run(w, s, 0);
        if (bits < best) {
            best = bits;
            mode = i;
        }
    }
    s->mode = (uint8_t)mode;
    return best;
}

static void write_best(writer *w, noh_wire_section s, uint32_t modes, uint64_t *sum)
{
    (void)find_best(w, &s, modes);
    write_section(w, &s, sum);
}

static void write_bytes(writer *w, uint32_t at, uint32_t count, uint64_t *sum)
{
    static const uint16_t strides[] = { 1, 4, 8, 12, 16 };
    noh_wire_section s, best;
    double least = 1e31;
    memset(&s, 0, sizeof s);
    s.kind = NOH_WIRE_BYTES;
    s.at = at;
    s.count = count;
    best = s;
    for (uint32_t i = 0; i < 2u * sizeof strides / sizeof *strides; i++) {
        double bits;
        s.mode = (uint8_t)(i % 2u);
        s.stride = strides[i / 2u];
        bits = run(w, &s, 0);
        if (bits < least) {
            least = bits;
            best = s;
        }
    }
    if (count) write_section(w, &best, sum);
}

/* ---- a mesh ---- */

static void write_column(writer *w, uint32_t chunk, uint32_t offset, const uint32_t params[8])
{
    noh_wire_section s;
    memset(&s, 0, sizeof s);
    s.kind = NOH_WIRE_COLUMN;
    s.at = chunk;
    s.stride = (uint16_t)offset;
    memcpy(s.params, params, sizeof s.params);
    write_best(w, s, 4u, &w->report->attributes);
}

/* Whether a component of 8 bits lies in a word of the extra attributes. */
static int has_bytes(const noh_extras_header *e, uint32_t word)
{
    const noh_extra_row *rows = (const noh_extra_row *)(const void *)((const uint8_t *)e + e->rows_offset);
    for (uint32_t k = 0; k < e->count; k++) {
        const float first = rows[k].first_bit, end = first + rows[k].bits * rows[k].component_count;
        if (rows[k].bits == 8.0f && first < 32.0f * (float)(word + 1u) && end > 32.0f * (float)word) return 1;
    }
    return 0;
}

/* The words of extra attributes, as two halves or four bytes. */
static void write_extras(writer *w, const noh_mesh *mesh, uint32_t chunk)
{
    static const uint32_t halves[8] = { 16u << 8, 65535, 16u << 8 | 16u, 65535 };
    static const uint32_t bytes[8] = { 8u << 8, 255, 8u << 8 | 8u, 255, 8u << 8 | 16u, 255, 8u << 8 | 24u, 255 };
    const noh_mesh_header *h = mesh->header;
    for (uint32_t i = 0; i < h->extra_words; i++) {
        write_column(w, chunk, noh_mesh_extra_offset(h) + 4u * i,
                     mesh->extras && has_bytes(mesh->extras, i) ? bytes : halves);
    }
}

static void write_attributes(writer *w, const noh_mesh *mesh, uint32_t chunk)
{
    const uint32_t uv = w->steps->uv_steps,
                   tangents[8] = { 16u << 8 | 1u << 16, 32767, 16u << 8 | 16u | 1u << 16, 32767 };
    const uint32_t uvs[8] = { 16u << 8, uv, 16u << 8 | 16u, uv };
    const uint32_t colors[8] = { 8u << 8, 255, 8u << 8 | 8u, 255, 8u << 8 | 16u, 255, 8u << 8 | 24u, 255 };
    noh_wire_section s;
    memset(&s, 0, sizeof s);
    s.at = chunk;
    s.kind = NOH_WIRE_NORMALS;
    s.params[0] = w->steps->normal_steps;
    write_best(w, s, 3u, &w->report->attributes);
    if (noh_mesh_tangent_offset(mesh) >= 0) write_column(w, chunk, (uint32_t)noh_mesh_tangent_offset(mesh), tangents);
    if (noh_mesh_uv_offset(mesh) >= 0) write_column(w, chunk, (uint32_t)noh_mesh_uv_offset(mesh), uvs);
    if (noh_mesh_color_offset(mesh) >= 0) write_column(w, chunk, (uint32_t)noh_mesh_color_offset(mesh), colors);
    write_extras(w, mesh, chunk);
    if (mesh->header->flags & NOH_MESH_TEXELS) {
        s.kind = NOH_WIRE_TEXEL_REFS;
        s.mode = 0;
        s.stride = (uint16_t)(mesh->header->attribute_stride - 4u);
        write_section(w, &s, &w->report->attributes);
    }
    if (mesh->header->flags & NOH_MESH_UV_TARGETS) {
        s.stride = (uint16_t)(mesh->header->attribute_stride - 8u);
        write_section(w, &s, &w->report->attributes);
    }
}

static int write_positions(writer *w, uint32_t chunk, const wire_grid *grid)
{
    uint32_t *plan = malloc((w->filter.mesh.order_count + 1u) * sizeof *plan);
    noh_wire_section s;
    int failed = !plan || wire_plan_positions(&w->filter, plan);
    memset(&s, 0, sizeof s);
    s.kind = NOH_WIRE_POSITIONS;
    s.at = chunk;
    s.mode = grid && grid->step > 0.0f;
    if (s.mode) memcpy(s.params, grid, sizeof *grid);
    w->filter.plan = plan;
    if (!failed) write_section(w, &s, &w->report->positions);
    w->filter.plan = NULL;
    free(plan);
    return failed;
}

static int write_deltas(writer *w, const noh_mesh *mesh, uint32_t chunk)
{
    uint32_t *plan = calloc(mesh->header->target_count + 1u, sizeof *plan);
    noh_wire_section s;
    if (!plan) return 1;
    memset(&s, 0, sizeof s);
    s.kind = NOH_WIRE_DELTAS;
    s.at = chunk;
    if (wire_plan_targets(&w->filter, plan)) {
        free(plan);
        return 1;
    }
    w->filter.plan = plan;
    write_best(w, s, 3u, &w->report->deltas);
    w->filter.plan = NULL;
    free(plan);
    return 0;
}

/* A mesh's chunk: filtered arrays, and plain bytes between them. */
static int write_mesh(writer *w, const noh_pack *pack, uint32_t index, const wire_grid *grid)
{
    const noh_pack_chunk *c = &pack->chunks[pack->runs[NOH_CHUNK_MESH].first + index];
    const uint32_t at = c->offset;
    noh_wire_section s;
    noh_mesh mesh;
    uint32_t rest;
    (void)noh_pack_mesh_at(pack, index, &mesh, NULL);
    memset(&s, 0, sizeof s);
    s.kind = NOH_WIRE_MESH;
    s.at = at;
    write_bytes(w, at, (mesh.header->level_count - mesh.header->level_first) * (uint32_t)sizeof *mesh.header,
                &w->report->rest);
    if (write_section(w, &s, &w->report->rest) > 1e29) return 1;
    s.kind = NOH_WIRE_INDICES;
    write_section(w, &s, &w->report->triangles);
    if (write_positions(w, at, grid)) return 1;
    write_attributes(w, &mesh, at);
    rest = mesh.header->submeshes_offset;
    write_bytes(w, at + rest, mesh.header->texels_offset - rest, &w->report->rest);
    if (mesh.header->target_count && write_deltas(w, &mesh, at)) return 1;
    rest = mesh.header->target_boxes_offset;
    if (!mesh.header->influence_count) {
        write_bytes(w, at + rest, c->bytes - rest, &w->report->rest);
        return 0;
    }
    write_bytes(w, at + rest, mesh.header->influences_offset - rest, &w->report->rest);
    s.kind = NOH_WIRE_INFLUENCES;
    s.params[0] = w->steps->weight_shift;
    write_section(w, &s, &w->report->influences);
    rest = mesh.header->palettes_offset;
    write_bytes(w, at + rest, c->bytes - rest, &w->report->rest);
    return 0;
}

/* ---- a pack ---- */

static void write_texture(writer *w, const noh_pack *pack, uint32_t index)
{
    const noh_pack_chunk *c = &pack->chunks[pack->runs[NOH_CHUNK_TEXTURE].first + index];
    noh_texture texture;
    noh_wire_section s;
    uint32_t head;
    (void)noh_pack_texture_at(pack, index, &texture, NULL);
    head = texture.header->pixels_offset;
    memset(&s, 0, sizeof s);
    s.kind = NOH_WIRE_TEXTURE;
    s.at = c->offset + head;
    s.params[0] = texture.header->width;
    s.params[1] = texture.header->height;
    s.params[2] = texture.header->level_count;
    write_bytes(w, c->offset, head, &w->report->textures);
    if (texture.header->format >= NOH_TEXTURE_ASTC_4X4) { /* blocks have no fields at fixed bits */
        write_bytes(w, s.at, c->bytes - head, &w->report->textures);
        return;
    }
    if (texture.header->format != NOH_TEXTURE_RGBA8) { /* blocks */
        s.kind = NOH_WIRE_BLOCKS;
        s.params[3] = texture.header->format;
        if (find_best(w, &s, 2u) < 8.0 * (c->bytes - head)) {
            write_section(w, &s, &w->report->textures);
        } else { /* noise */
            write_bytes(w, s.at, c->bytes - head, &w->report->textures);
        }
        return;
    }
    write_section(w, &s, &w->report->textures);
}

/* A chunk that the pack before has, too, is copied from there. */
static int copy_chunk(writer *w, const noh_pack *pack, uint32_t index, const noh_pack *before)
{
    const noh_pack_chunk *c = &pack->chunks[index];
    noh_wire_section s;
    for (uint32_t i = 0; before && i < before->chunk_count; i++) {
        const noh_pack_chunk *b = &before->chunks[i];
        if (b->type == c->type && b->bytes == c->bytes &&
            memcmp(before->bytes + b->offset, pack->bytes + c->offset, c->bytes) == 0) {
            memset(&s, 0, sizeof s);
            s.kind = NOH_WIRE_COPY;
            s.at = c->offset;
            s.count = c->bytes;
            s.params[0] = b->offset;
            write_section(w, &s, &w->report->rest);
            return 1;
        }
    }
    return 0;
}

static int write_pack(writer *w, const noh_pack *pack, const noh_pack *before)
{
    const uint32_t table = (uint32_t)(sizeof(noh_pack_header) + pack->chunk_count * sizeof(noh_pack_chunk));
    write_bytes(w, 0, table, &w->report->rest);
    for (uint32_t i = 0; i < pack->chunk_count; i++) {
        const uint32_t mesh = i - pack->runs[NOH_CHUNK_MESH].first, texture = i - pack->runs[NOH_CHUNK_TEXTURE].first;
        if (copy_chunk(w, pack, i, before)) continue;
        if (i >= pack->runs[NOH_CHUNK_MESH].first && mesh < pack->runs[NOH_CHUNK_MESH].count) {
            if (write_mesh(w, pack, mesh, w->steps->grids ? &w->steps->grids[mesh] : NULL)) return 1;
        } else if (i >= pack->runs[NOH_CHUNK_TEXTURE].first && texture < pack->runs[NOH_CHUNK_TEXTURE].count) {
            write_texture(w, pack, texture);
        } else {
            write_bytes(w, pack->chunks[i].offset, pack->chunks[i].bytes, &w->report->rest);
        }
    }
    return 0;
}

/* ---- the file ---- */

static void make_costs(float *costs)
{
    costs[0] = 15.0f;
    for (uint32_t i = 1; i <= 32768u; i++) costs[i] = (float)(15.0 - log2((double)i));
}

static uint64_t scratch_of(const noh_pack *pack)
{
    uint64_t most = 0;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        uint64_t bytes;
        (void)noh_pack_mesh_at(pack, i, &mesh, NULL);
        bytes = noh_wire_scratch(mesh.header);
        most = bytes > most ? bytes : most;
    }
    return most;
}

static void write_head(writer *w, const noh_pack *packs, uint32_t pack_count, uint64_t scratch)
{
    noh_wire_head h;
    memset(&h, 0, sizeof h);
    h.magic = NOH_WIRE_MAGIC;
    h.version = NOH_WIRE_VERSION;
    h.library_version = noh_version_number();
    h.image_count = pack_count;
    for (uint32_t i = 0; i < pack_count; i++) h.image_bytes[i] = packs[i].byte_count;
    h.scratch_bytes = (uint32_t)scratch;
    buffer_append(w->out, &h, sizeof h);
}

/* The length of the file is known last, and every block's checksum follows from the header's: they are made again. */
static void seal(byte_buffer *out)
{
    noh_wire_head h;
    uint32_t crc;
    memcpy(&h, out->bytes, sizeof h);
    h.file_bytes = (uint32_t)out->count;
    crc = h.crc = noh_crc32c(0, &h, offsetof(noh_wire_head, crc));
    memcpy(out->bytes, &h, sizeof h);
    for (size_t at = sizeof h; at < out->count;) {
        uint8_t *b = out->bytes + at;
        const uint32_t count = ((uint32_t)b[2] | (uint32_t)b[3] << 8) & (NOH_WIRE_BLOCK_SECTION - 1u);
        crc = noh_crc32c(noh_crc32c(crc, b, 4), b + NOH_WIRE_BLOCK_HEAD_BYTES, count);
        for (uint32_t i = 0; i < 4u; i++) b[4u + i] = (uint8_t)(crc >> 8u * i);
        at += NOH_WIRE_BLOCK_HEAD_BYTES + count;
    }
}

static int write_packs(writer *w, const noh_pack *packs, uint32_t pack_count)
{
    noh_wire_section end;
    memset(&end, 0, sizeof end);
    end.kind = NOH_WIRE_END;
    for (uint32_t i = 0; i < pack_count; i++) {
        w->filter.before = i ? packs[i - 1u].bytes : NULL;
        w->filter.before_bytes = i ? packs[i - 1u].byte_count : 0u;
        w->filter.image = (uint8_t *)(uintptr_t)packs[i].bytes; /* not written: the filters record */
        w->filter.image_bytes = packs[i].byte_count;
        if (write_pack(w, &packs[i], i ? &packs[i - 1u] : NULL)) return 1;
        append_section(w, &end);
        if (i + 1u < pack_count) w->report->first = w->out->count;
    }
    return w->out->failed;
}

int pack_wire(const noh_pack *packs, uint32_t pack_count, const wire_steps *steps, byte_buffer *out,
              wire_report *report, model_error *error)
{
    const uint64_t scratch = scratch_of(&packs[pack_count - 1u]);
    writer *w = calloc(1, sizeof *w);
    float *costs = malloc(32769u * sizeof *costs);
    int failed = 1;
    memset(report, 0, sizeof *report);
    if (w && costs) {
        make_costs(costs);
        w->costs = costs;
        w->out = out;
        w->steps = steps;
        w->report = report;
        w->symbols = malloc(SYMBOLS_MAX * sizeof *w->symbols);
        w->filter.scratch = malloc((size_t)scratch + 1u);
        w->filter.scratch_bytes = (uint32_t)scratch;
        if (w->symbols && w->filter.scratch) {
            write_head(w, packs, pack_count, scratch);
            failed = write_packs(w, packs, pack_count);
        }
        free(w->symbols);
        free(w->filter.scratch);
    }
    free(w);
    free(costs);
    if (failed) {
        buffer_free(out);
        return model_fail_memory(error);
    }
    seal(out);
    return 0;
}
