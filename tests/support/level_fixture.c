#include "level_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/byte_buffer.h"
#include "pack_walk.h"
#include "noh/low_core.h"

#define CELLS 1024 /* to each side */

/* A mesh being rewritten. Vertices, texels and triangles are the old mesh's, until they are written. */
typedef struct maker {
    const noh_mesh *mesh;
    uint32_t level_count;
    uint32_t *indices[NOH_LOD_LEVELS_MAX]; /* [index_count] */
    uint32_t index_count[NOH_LOD_LEVELS_MAX];
    noh_submesh *submeshes[NOH_LOD_LEVELS_MAX]; /* [submesh_count] */
    uint32_t *order, *place;                    /* new to old, old to new */
    uint32_t vertex_count[NOH_LOD_LEVELS_MAX];
    uint32_t *texel; /* old texel to new */
    uint32_t touched_count[NOH_LOD_LEVELS_MAX];
    uint32_t (*words)[3];                    /* one target's deltas, by new texel */
    noh_target *targets[NOH_LOD_LEVELS_MAX]; /* [target_count] */
    byte_buffer rects, texels;
} maker;

/* ---- triangles ---- */

/* The first vertex of a submesh in each vertex's cell. */
static void cluster(const maker *m, const noh_submesh *s, float cell, uint32_t *representative)
{
    const uint32_t count = m->mesh->header->vertex_count;
    uint32_t *cells = test_zeros(4u * (size_t)count), mask = 1, *firsts;
    while (mask < 2u * count) mask = 2u * mask + 1u;
    firsts = test_zeros(4u * ((size_t)mask + 1u)); /* the first vertex of each cell, plus 1 */
    for (uint32_t v = 0; v < count; v++) {
        const float *p = m->mesh->positions + 3u * (size_t)v;
        uint32_t number = 0;
        for (int c = 0; c < 3; c++) {
            number = number * CELLS + (uint32_t)((int)floorf(p[c] / cell) + CELLS / 2);
        }
        cells[v] = number;
        representative[v] = NOH_NONE;
    }
    for (uint32_t i = 0; i < s->index_count; i++) {
        const uint32_t v = noh_mesh_index(m->mesh, s->first_index + i);
        representative[v] = v;
    }
    for (uint32_t v = 0; v < count; v++) {
        uint32_t slot = cells[v] * 2654435761u & mask;
        if (representative[v] != v) continue;
        while (firsts[slot] && cells[firsts[slot] - 1u] != cells[v]) slot = (slot + 1u) & mask;
        if (firsts[slot]) {
            representative[v] = firsts[slot] - 1u;
        } else {
            firsts[slot] = v + 1u;
        }
    }
    free(firsts);
    free(cells);
}

static void cut_triangles(maker *m, uint32_t level, float cell)
{
    const noh_mesh_header *h = m->mesh->header;
    uint32_t *representative = test_zeros(4u * (size_t)h->vertex_count);
    m->indices[level] = test_zeros(4u * (size_t)h->index_count);
    m->submeshes[level] = test_zeros(sizeof(noh_submesh) * h->submesh_count);
    for (uint32_t s = 0; s < h->submesh_count; s++) {
        noh_submesh *to = &m->submeshes[level][s];
        *to = m->mesh->submeshes[s];
        to->first_index = m->index_count[level];
        cluster(m, &m->mesh->submeshes[s], cell, representative);
        for (uint32_t i = 0; i < m->mesh->submeshes[s].index_count; i += 3) {
            uint32_t t[3];
            for (uint32_t c = 0; c < 3; c++) {
                const uint32_t v = noh_mesh_index(m->mesh, m->mesh->submeshes[s].first_index + i + c);
                t[c] = level ? representative[v] : v;
            }
            if (!level || (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])) {
                memcpy(m->indices[level] + m->index_count[level], t, sizeof t);
                m->index_count[level] += 3;
            }
        }
        to->index_count = m->index_count[level] - to->first_index;
    }
    assert_true(m->index_count[level] > 0);
    free(representative);
}

/* ---- vertices and texels: the coarsest level's first ---- */

static void sort_vertices(maker *m)
{
    const uint32_t count = m->mesh->header->vertex_count;
    uint8_t *coarsest = test_zeros(count);
    uint32_t n = 0;
    for (uint32_t level = 1; level < m->level_count; level++) {
        for (uint32_t i = 0; i < m->index_count[level]; i++) {
            coarsest[m->indices[level][i]] = (uint8_t)level;
        }
    }
    m->order = test_zeros(4u * (size_t)count);
    m->place = test_zeros(4u * (size_t)count);
    for (uint32_t level = m->level_count; level-- > 0;) {
        for (uint32_t v = 0; v < count; v++) {
            if (coarsest[v] == level) {
                m->place[v] = n;
                m->order[n++] = v;
            }
        }
        m->vertex_count[level] = n;
    }
    free(coarsest);
}

static void sort_texels(maker *m)
{
    const uint32_t touched = m->mesh->header->touched_count;
    uint32_t n = 0, v = 0;
    m->texel = test_zeros(4u * (size_t)touched);
    memset(m->texel, 0xff, 4u * (size_t)touched);
    for (uint32_t level = m->level_count; level-- > 0;) {
        for (; v < m->vertex_count[level]; v++) {
            const uint32_t old = noh_mesh_accumulation_texel(m->mesh, m->order[v]);
            if (old < touched && m->texel[old] == NOH_NONE) {
                m->texel[old] = n++;
            }
        }
        m->touched_count[level] = n;
    }
    assert_int_equal(n, touched);
}

/* ---- targets ---- */

static void spread_words(maker *m, const noh_target *t)
{
    const noh_rect *rect = m->mesh->rects + t->first_rect;
    const uint32_t *words = m->mesh->texels + 3u * (size_t)t->first_texel;
    memset(m->words, 0, 12u * (size_t)m->mesh->header->touched_count);
    for (uint32_t r = 0; r < t->rect_count; r++, rect++) {
        for (uint32_t i = 0; i < (uint32_t)rect->w * rect->h; i++, words += 3) {
            const uint32_t old = ((rect->y + i / rect->w) << m->mesh->header->morph_width_log2) + rect->x + i % rect->w;
            if (old < m->mesh->header->touched_count) {
                memcpy(m->words[m->texel[old]], words, 12);
            }
        }
    }
}

static int moves(const maker *m, uint32_t texel)
{
    return (m->words[texel][0] | m->words[texel][1] | m->words[texel][2]) != 0;
}

/* Texels from..to-1 in runs of a row; a run includes single texels that do not move. */
static void put_runs(maker *m, uint32_t from, uint32_t to, noh_target *t)
{
    const uint32_t log2 = m->mesh->header->morph_width_log2, width = 1u << log2;
    for (uint32_t i = from; i < to;) {
        uint32_t end = i;
        while (end < to && end >> log2 == i >> log2 &&
               (moves(m, end) || (end > i && end + 1 < to && moves(m, end + 1)))) {
            t->pair_count += (uint32_t)moves(m, end);
            end++;
        }
        if (end > i && !moves(m, end - 1)) { /* the row ended on one */
            end--;
        }
        if (end > i) {
            const noh_rect rect = { (uint16_t)(i & (width - 1u)), (uint16_t)(i >> log2), (uint16_t)(end - i), 1 };
            buffer_append(&m->rects, &rect, sizeof rect);
            buffer_append(&m->texels, m->words + i, 12u * (size_t)(end - i));
            t->rect_count++;
            t->texel_count += end - i;
        }
        i = end > i ? end : i + 1;
    }
}

static void cut_targets(maker *m)
{
    const noh_mesh_header *h = m->mesh->header;
    m->words = test_zeros(12u * (size_t)h->touched_count);
    for (uint32_t level = 0; level < m->level_count; level++) {
        m->targets[level] = test_zeros(sizeof(noh_target) * h->target_count);
    }
    for (uint32_t i = 0; i < h->target_count; i++) {
        noh_target t = m->mesh->targets[i];
        uint32_t from = 0;
        t.first_rect = (uint32_t)(m->rects.count / sizeof(noh_rect));
        t.first_texel = (uint32_t)(m->texels.count / 12u);
        t.rect_count = t.texel_count = t.pair_count = 0;
        spread_words(m, &m->mesh->targets[i]);
        for (uint32_t level = m->level_count; level-- > 0; from = m->touched_count[level]) {
            noh_target *own = &m->targets[level][i];
            put_runs(m, from, m->touched_count[level], &t);
            *own = t;
            if (i == 0 && level && level == m->level_count - 1) {
                own->rect_count = own->texel_count = own->pair_count = 0;
            }
        }
    }
}

/* ---- the chunk ---- */

/* The fields of a level's own, in a copy of the full mesh's header. */
static void fill_level(const maker *m, uint32_t level, noh_mesh_header *h)
{
    h->vertex_count = m->vertex_count[level];
    h->index_count = m->index_count[level];
    h->touched_count = m->touched_count[level];
    h->morph_height = (h->touched_count + (1u << h->morph_width_log2) - 1u) >> h->morph_width_log2;
    h->rect_count = h->texel_count = h->pair_count = 0;
    for (uint32_t i = 0; i < h->target_count; i++) {
        h->rect_count += m->targets[level][i].rect_count;
        h->texel_count += m->targets[level][i].texel_count;
        h->pair_count += m->targets[level][i].pair_count;
    }
    h->level = level;
    h->level_count = m->level_count;
    h->level_error_rest = 0.01f * (float)level;
    h->level_error_rest_p99 = 0.005f * (float)level;
    h->level_error_targets = h->level_error_pairs = h->level_error_clip = 0.02f * (float)level;
    h->level_skipped = level && level == m->level_count - 1 && h->target_count ? m->mesh->targets[0].radius : 0.0f;
}

static uint32_t begin_array(byte_buffer *out)
{
    buffer_align(out, 16);
    return (uint32_t)out->count;
}

static void put_vertices(const maker *m, noh_mesh_header *h, byte_buffer *out)
{
    const noh_mesh_header *old = m->mesh->header;
    h->positions_offset = begin_array(out);
    for (uint32_t v = 0; v < old->vertex_count; v++) {
        buffer_append(out, m->mesh->positions + 3u * (size_t)m->order[v], 12);
    }
    h->attributes_offset = begin_array(out);
    for (uint32_t v = 0; v < old->vertex_count; v++) {
        const uint32_t texel = noh_mesh_accumulation_texel(m->mesh, m->order[v]);
        const uint32_t word = texel < old->touched_count ? m->texel[texel] : NOH_TEXEL_NONE;
        const uint32_t palette = old->palette_count > 1
                                     ? noh_mesh_palette(m->mesh, m->order[v]) << NOH_TEXEL_VERTEX_BITS
                                     : 0;
        const uint32_t kept = word | palette;
        buffer_append(out, m->mesh->attributes + (size_t)old->attribute_stride * m->order[v], h->attribute_stride - 4u);
        buffer_append(out, &kept, 4);
    }
}

static void put_triangles(const maker *m, noh_mesh_header *headers, byte_buffer *out)
{
    begin_array(out);
    for (uint32_t level = 0; level < m->level_count; level++) {
        headers[level].indices_offset = (uint32_t)out->count;
        for (uint32_t i = 0; i < m->index_count[level]; i++) {
            const uint32_t v = m->place[m->indices[level][i]];
            const uint16_t narrow = (uint16_t)v;
            buffer_append(out, headers->index_bytes == 2 ? (const void *)&narrow : &v, headers->index_bytes);
        }
    }
    begin_array(out);
    for (uint32_t level = 0; level < m->level_count; level++) {
        headers[level].submeshes_offset = (uint32_t)out->count;
        for (uint32_t s = 0; s < headers->submesh_count; s++) {
            noh_submesh submesh = m->submeshes[level][s];
            submesh.first_vertex = 0;
            submesh.vertex_count = m->vertex_count[level];
            buffer_append(out, &submesh, sizeof submesh);
        }
    }
    begin_array(out);
    for (uint32_t level = 0; level < m->level_count; level++) {
        headers[level].targets_offset = (uint32_t)out->count;
        buffer_append(out, m->targets[level], sizeof(noh_target) * headers->target_count);
    }
}

static uint32_t put_array(byte_buffer *out, const void *bytes, size_t count)
{
    const uint32_t offset = begin_array(out);
    buffer_append(out, bytes, count);
    return offset;
}

static void put_rest(const maker *m, noh_mesh_header *h, byte_buffer *out)
{
    const noh_mesh *old = m->mesh;
    const uint32_t words = NOH_INFLUENCE_WORDS(h->influence_count);
    noh_skin skin;
    const uint32_t joints = noh_pack_skin_at(old->pack, h->skin, &skin, NULL) == NOH_OK ? skin.header->joint_count : 0;
    h->weights_offset = put_array(out, old->weights, 4u * (size_t)h->target_count);
    h->rects_offset = put_array(out, m->rects.bytes, m->rects.count);
    h->texels_offset = put_array(out, m->texels.bytes, m->texels.count);
    h->target_boxes_offset = put_array(out, old->target_boxes, 24u * (size_t)h->target_count);
    h->influences_offset = begin_array(out);
    for (uint32_t v = 0; v < h->vertex_count; v++) {
        buffer_append(out, old->influences + (size_t)words * m->order[v], 4u * words);
    }
    h->palettes_offset = put_array(out, old->palettes, sizeof(noh_palette) * h->palette_count);
    h->palette_joints_offset = put_array(out, old->palette_joints, 2u * (size_t)h->palette_joint_count);
    h->joint_boxes_offset = put_array(out, old->joint_boxes, 24u * (size_t)joints);
}

static void put_chunk(const maker *m, byte_buffer *out)
{
    noh_mesh_header headers[NOH_LOD_LEVELS_MAX];
    headers[0] = *m->mesh->header;
    headers[0].flags |= NOH_MESH_TEXELS;
    headers[0].attribute_stride += (m->mesh->header->flags & NOH_MESH_TEXELS) ? 0u : 4u;
    buffer_append(out, NULL, sizeof headers[0] * m->level_count);
    put_vertices(m, &headers[0], out);
    put_triangles(m, headers, out);
    put_rest(m, &headers[0], out);
    for (uint32_t level = m->level_count; level-- > 0;) {
        noh_mesh_header *h = &headers[level];
        const uint32_t own[3] = { h->indices_offset, h->submeshes_offset, h->targets_offset };
        *h = headers[0];
        h->indices_offset = own[0];
        h->submeshes_offset = own[1];
        h->targets_offset = own[2];
        fill_level(m, level, h);
    }
    memcpy(out->bytes, headers, sizeof headers[0] * m->level_count);
}

static uint32_t *make_mesh(const noh_mesh *mesh, uint32_t level_count, float cell, byte_buffer *out)
{
    maker m;
    memset(&m, 0, sizeof m);
    m.mesh = mesh;
    m.level_count = level_count;
    cut_triangles(&m, 0, cell);
    for (uint32_t level = 1; level < level_count; level++, cell *= 2.0f) {
        cut_triangles(&m, level, cell);
    }
    sort_vertices(&m);
    sort_texels(&m);
    cut_targets(&m);
    put_chunk(&m, out);
    for (uint32_t level = 0; level < level_count; level++) {
        free(m.indices[level]);
        free(m.submeshes[level]);
        free(m.targets[level]);
    }
    free(m.place);
    free(m.texel);
    free(m.words);
    buffer_free(&m.rects);
    buffer_free(&m.texels);
    return m.order;
}

/* ---- the pack ---- */

void fixture_levels_open(fixture_levels *f, const noh_pack *from, uint32_t level_count, float cell)
{
    const size_t table = sizeof(noh_pack_header) + from->chunk_count * sizeof(noh_pack_chunk);
    byte_buffer out = { NULL, 0, 0, 0 };
    noh_pack_header *header;
    memset(f, 0, sizeof *f);
    f->orders = test_zeros(sizeof *f->orders * from->runs[NOH_CHUNK_MESH].count);
    buffer_append(&out, from->bytes, table);
    for (uint32_t i = 0; i < from->chunk_count; i++) {
        byte_buffer chunk = { NULL, 0, 0, 0 };
        noh_pack_chunk *entry;
        noh_mesh mesh;
        if (noh_pack_mesh_at(from, i - from->runs[NOH_CHUNK_MESH].first, &mesh, NULL) == NOH_OK) {
            f->orders[i - from->runs[NOH_CHUNK_MESH].first] = make_mesh(&mesh, level_count, cell, &chunk);
        } else {
            buffer_append(&chunk, from->bytes + from->chunks[i].offset, from->chunks[i].bytes);
        }
        buffer_align(&out, NOH_PACK_ALIGN);
        entry = (noh_pack_chunk *)(void *)(out.bytes + sizeof(noh_pack_header)) + i;
        entry->offset = (uint32_t)out.count;
        entry->bytes = (uint32_t)chunk.count;
        buffer_append(&out, chunk.bytes, chunk.count);
        buffer_free(&chunk);
    }
    buffer_align(&out, NOH_PACK_ALIGN);
    assert_false(out.failed);
    header = (noh_pack_header *)(void *)out.bytes;
    header->byte_count = (uint32_t)out.count;
    pack_repair(out.bytes, out.count);
    f->bytes = test_aligned(out.bytes, out.count);
    f->pack = test_open(f->bytes, out.count);
    buffer_free(&out);
}

void fixture_levels_close(fixture_levels *f)
{
    for (uint32_t i = 0; i < f->pack.runs[NOH_CHUNK_MESH].count; i++) {
        free(f->orders[i]);
    }
    free(f->orders);
    free(f->bytes);
}
