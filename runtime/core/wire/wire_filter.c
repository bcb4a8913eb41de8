/* wire_filter.c: what filters have in common: the mesh that they are about, and which of them runs. */
#include "core/wire/wire_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <string.h>

/* ---- the mesh ---- */

/* Words of scratch by vertex: order, twins, around, grid, moved and more; by accumulation texel: slots, reference. */
#define VERTEX_WORDS 17u
#define TEXEL_WORDS 2u

uint64_t noh_wire_scratch(const noh_mesh_header *h)
{
    return 4u * (VERTEX_WORDS * (uint64_t)h->vertex_count + TEXEL_WORDS * (uint64_t)h->touched_count);
}

static int array_fits(const noh_wire_filter *f, uint32_t offset, uint64_t count, uint32_t stride)
{
    return f->mesh.chunk + (uint64_t)offset + count * stride <= f->image_bytes;
}

/* The arrays lie in the image, and no count is above what the format allows: then no sum of them overflows. */
static int mesh_fits(const noh_wire_filter *f)
{
    const noh_mesh_header *h = &f->mesh.header;
    const uint32_t levels = h->level_count - h->level_first;
    return h->vertex_count && h->vertex_count <= NOH_VERTICES_MAX && h->index_count <= NOH_INDICES_MAX &&
           h->target_count <= NOH_TARGETS_MAX && h->touched_count <= NOH_VERTICES_MAX &&
           h->texel_count <= NOH_DELTA_TEXELS_MAX && h->rect_count <= NOH_DELTA_TEXELS_MAX &&
           h->attribute_stride <= 64u && h->influence_count <= NOH_INFLUENCES_MAX && h->level_count > h->level_first &&
           h->level_count <= NOH_LOD_LEVELS_MAX && (h->index_bytes == 2u || h->index_bytes == 4u) &&
           h->morph_width_log2 <= NOH_MORPH_WIDTH_LOG2_MAX && f->mesh.chunk % 4u == 0u &&
           array_fits(f, 0, levels, sizeof *h) && array_fits(f, h->positions_offset, h->vertex_count, 12u) &&
           array_fits(f, h->attributes_offset, h->vertex_count, h->attribute_stride) &&
           array_fits(f, h->indices_offset, h->index_count, h->index_bytes) &&
           array_fits(f, h->targets_offset, h->target_count, sizeof(noh_target)) &&
           array_fits(f, h->rects_offset, h->rect_count, sizeof(noh_rect)) &&
           array_fits(f, h->texels_offset, h->texel_count, 12u) &&
           array_fits(f, h->influences_offset, h->influence_count ? h->vertex_count : 0u,
                      4u * NOH_INFLUENCE_WORDS(h->influence_count));
}

/* Its arrays in the scratch, whose bytes are aligned to words. */
static int begin_mesh(noh_wire_filter *f)
{
    noh_wire_mesh *m = &f->mesh;
    const uint32_t at = f->section.at;
    uint32_t *word = (uint32_t *)(void *)f->scratch;
    size_t n;
    memset(m, 0, sizeof *m);
    if (!at || (uint64_t)at + sizeof m->header > f->image_bytes)
        return noh_wire_wrong(f, "a mesh lies outside the pack");
    memcpy(&m->header, f->image + at, sizeof m->header);
    m->chunk = at;
    if (!mesh_fits(f) || noh_wire_scratch(&m->header) > f->scratch_bytes) {
        m->chunk = 0;
        return noh_wire_wrong(f, "a mesh has arrays outside the pack, or more vertices than there is room for");
    }
    n = m->header.vertex_count;
    m->level_count = m->header.level_count - m->header.level_first;
    m->order = word;
    m->twins = word + n;
    m->around = word + 2u * n;
    m->grid = (int32_t *)(void *)(word + 5u * n);
    m->directions = (float *)(void *)(word + 5u * n);
    m->moved = (float *)(void *)(word + 8u * n);
    m->more = word + 11u * n;
    memset(m->more, 0xff, 24u * n);
    m->slots = word + 17u * n;
    m->reference = m->slots + m->header.touched_count;
    m->ends = word + 5u * n; /* until positions come */
    m->starts = word + 6u * n;
    m->beyond = word + 7u * n;
    memset(m->ends, 0xff, 8u * n);
    m->next = word + 8u * n; /* until twins are looked for */
    for (uint32_t v = 0; v <= n; v++) m->next[v] = v;
    for (uint32_t v = 0; v < n; v++) {
        m->twins[v] = v;
        m->around[3u * (size_t)v] = v; /* no triangle came to it */
    }
    return 1;
}

uint32_t noh_wire_index(const noh_wire_filter *f, uint32_t n)
{
    const noh_mesh_header *h = &f->mesh.header;
    const uint8_t *b = f->image + f->mesh.chunk + h->indices_offset + (size_t)n * h->index_bytes;
    uint32_t index = (uint32_t)b[0] | (uint32_t)b[1] << 8;
    if (h->index_bytes == 4u) index |= (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    return index < h->vertex_count ? index : h->vertex_count - 1u;
}

uint32_t noh_wire_texel(const noh_wire_filter *f, uint32_t v)
{
    const noh_mesh_header *h = &f->mesh.header;
    uint32_t texel = v;
    if (h->flags & NOH_MESH_TEXELS) {
        texel = noh_wire_load(f, (uint64_t)f->mesh.chunk + h->attributes_offset +
                                     ((uint64_t)v + 1u) * h->attribute_stride - 4u) &
                NOH_TEXEL_NONE;
    }
    return texel < h->touched_count ? texel : NOH_NONE;
}

void noh_wire_position(const noh_wire_filter *f, uint32_t v, float position[3])
{
    memcpy(position, f->image + f->mesh.chunk + f->mesh.header.positions_offset + 12u * (size_t)v, 12u);
}

/* ---- prediction ---- */

static void add_parallelogram(noh_wire_near *near, const uint32_t of[3])
{
    for (uint32_t i = 0; i < 3u; i++) {
        near->vertex[near->count] = of[i];
        near->sign[near->count++] = i < 2u ? 1 : -1;
    }
}

noh_wire_near noh_wire_near_of(const noh_wire_filter *f, uint32_t v)
{
    const uint32_t *around = f->mesh.around + 3u * (size_t)v, *more = f->mesh.more + 6u * (size_t)v;
    noh_wire_near near;
    near.a = around[0];
    near.b = around[1];
    near.across = around[2];
    near.count = 0;
    if (near.across != NOH_NONE) add_parallelogram(&near, around);
    if (more[2] != NOH_NONE) add_parallelogram(&near, more);
    if (more[5] != NOH_NONE) add_parallelogram(&near, more + 3);
    near.divisor = (int32_t)(near.count / 3u);
    for (uint32_t i = 0; i < 2u && !near.divisor && around[i] != NOH_NONE; i++) {
        near.vertex[near.count] = around[i];
        near.sign[near.count++] = 1;
    }
    near.divisor = near.divisor ? near.divisor : near.count ? (int32_t)near.count : 1;
    return near;
}

/* ---- vertices at one place ---- */

static uint32_t hash_place(const uint32_t p[3])
{
    uint32_t h = p[0] * 0x9e3779b1u ^ p[1] * 0x85ebca6bu ^ p[2] * 0xc2b2ae35u;
    h ^= h >> 15;
    return h * 0x2c1b3c6du;
}

/* A table of vertices by their place, in the memory of `moved`: with 3 words a vertex it is never full. */
void noh_wire_find_twins(noh_wire_filter *f)
{
    uint32_t *table = (uint32_t *)(void *)f->mesh.moved;
    const uint32_t size = 3u * f->mesh.header.vertex_count;
    memset(table, 0xff, 4u * (size_t)size);
    for (uint32_t v = 0; v < f->mesh.header.vertex_count; v++) f->mesh.twins[v] = v;
    for (uint32_t i = 0; i < f->mesh.order_count; i++) {
        const uint32_t v = f->mesh.order[i];
        uint32_t place[3], other[3], at;
        noh_wire_position(f, v, (float *)(void *)place);
        at = (uint32_t)(((uint64_t)hash_place(place) * size) >> 32);
        for (; table[at] != NOH_NONE; at = at + 1u < size ? at + 1u : 0u) {
            noh_wire_position(f, table[at], (float *)(void *)other);
            if (memcmp(place, other, sizeof place) == 0) break;
        }
        if (table[at] == NOH_NONE) table[at] = v;
        f->mesh.twins[v] = table[at];
    }
}

/* ---- sections ---- */

static void put_word(uint8_t *bytes, uint32_t word)
{
    for (uint32_t i = 0; i < 4u; i++) bytes[i] = (uint8_t)(word >> 8u * i);
}

static uint32_t get_word(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

void noh_wire_section_write(const noh_wire_section *s, uint8_t bytes[NOH_WIRE_SECTION_BYTES])
{
    put_word(bytes, (uint32_t)s->kind | (uint32_t)s->mode << 8 | (uint32_t)s->stride << 16);
    put_word(bytes + 4, s->at);
    put_word(bytes + 8, s->count);
    for (uint32_t i = 0; i < 8u; i++) put_word(bytes + 12u + 4u * i, s->params[i]);
}

void noh_wire_section_read(noh_wire_section *s, const uint8_t bytes[NOH_WIRE_SECTION_BYTES])
{
    const uint32_t first = get_word(bytes);
    s->kind = (uint8_t)first;
    s->mode = (uint8_t)(first >> 8);
    s->stride = (uint16_t)(first >> 16);
    s->at = get_word(bytes + 4);
    s->count = get_word(bytes + 8);
    for (uint32_t i = 0; i < 8u; i++) s->params[i] = get_word(bytes + 12u + 4u * i);
}

static int run_copy(noh_wire_filter *f)
{
    const noh_wire_section *s = &f->section;
    if ((uint64_t)s->at + s->count > f->image_bytes || (uint64_t)s->params[0] + s->count > f->before_bytes) {
        return noh_wire_wrong(f, "a copy reaches outside its pack");
    }
    if (!noh_wire_writes(f) && s->count) memcpy(f->image + s->at, f->before + s->params[0], s->count);
    return 1;
}

int noh_wire_begin(noh_wire_filter *f, const noh_wire_section *section)
{
    f->section = *section;
    memset(f->cursor, 0, sizeof f->cursor);
    memset(f->last, 0, sizeof f->last);
    noh_wire_model_reset(f->models, NOH_WIRE_MODELS);
    if (section->kind == NOH_WIRE_MESH) return begin_mesh(f);
    if (section->kind == NOH_WIRE_COPY) return run_copy(f);
    if (section->kind == NOH_WIRE_BYTES || section->kind == NOH_WIRE_TEXTURE || section->kind == NOH_WIRE_BLOCKS) {
        return 0;
    }
    if (section->kind > NOH_WIRE_TEXTURE) return noh_wire_wrong(f, "a section of an unknown kind");
    if (!f->mesh.chunk) return noh_wire_wrong(f, "section of a mesh without a mesh before it");
    if (section->kind == NOH_WIRE_INDICES && f->mesh.begun) {
        return noh_wire_wrong(f, "a mesh has two sections of triangles, or other arrays before its triangles");
    }
    f->mesh.begun = 1;
    memset(f->edges, 0xff, sizeof f->edges);
    memset(f->recent, 0, sizeof f->recent);
    return 0;
}

int noh_wire_run(noh_wire_filter *f)
{
    int done;
    switch (f->section.kind) {
    case NOH_WIRE_BYTES: done = noh_wire_run_bytes(f); break;
    case NOH_WIRE_TEXTURE: done = noh_wire_run_texture(f); break;
    case NOH_WIRE_BLOCKS: done = noh_wire_run_blocks(f); break;
    case NOH_WIRE_INDICES: done = noh_wire_run_indices(f); break;
    case NOH_WIRE_POSITIONS:
        done = noh_wire_run_positions(f);
        if (done == 1) noh_wire_find_twins(f);
        break;
    case NOH_WIRE_NORMALS: done = noh_wire_run_normals(f); break;
    case NOH_WIRE_COLUMN: done = noh_wire_run_column(f); break;
    case NOH_WIRE_TEXEL_REFS: done = noh_wire_run_texel_refs(f); break;
    case NOH_WIRE_INFLUENCES: done = noh_wire_run_influences(f); break;
    case NOH_WIRE_DELTAS: done = noh_wire_run_deltas(f); break;
    default: return noh_wire_wrong(f, "a section of an unknown kind");
    }
    return done;
}
