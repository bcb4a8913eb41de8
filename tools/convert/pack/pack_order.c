/* pack_order.c: walks over the triangles as the wire form's filter does, and renumbers vertices as it meets them.
 *
 * Vertices may only change places with those that lie in rectangles of the same targets and levels: then every
 * rectangle still has all its vertices, at another of its texels. In a mesh without texel references a vertex's number
 * is its texel's; with levels both are renamed, each within its level. */
#include "pack_order.h"

#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#define EDGES 15u   /* that the filter can go on from */
#define FIXED 0xffu /* of a texel under two rectangles of a target: it stays where it is */

/* ---- triangles ---- */

typedef struct edge_slot {
    uint32_t a, b, triangle; /* NOH_NONE: empty */
} edge_slot;

typedef struct walker {
    const uint32_t *from; /* [triangle_count][3] */
    uint32_t *to;
    uint32_t triangle_count, written;
    edge_slot *slots;
    uint32_t mask;
    uint8_t *seen;
    uint32_t edges[EDGES + 1u][2];
    uint32_t edge_count;
} walker;

static uint32_t slot_hash(uint32_t a, uint32_t b)
{
    const uint32_t h = a * 0x9e3779b1u ^ (b * 0x85ebca6bu + 0x7f4a7c15u);
    return h ^ h >> 15;
}

/* The triangle with an edge, or NOH_NONE; where several have it, one of them. */
static edge_slot *slot_of(const walker *w, uint32_t a, uint32_t b)
{
    uint32_t at = slot_hash(a, b) & w->mask;
    while (w->slots[at].triangle != NOH_NONE && (w->slots[at].a != a || w->slots[at].b != b)) at = (at + 1u) & w->mask;
    return &w->slots[at];
}

static void pass_edge(walker *w, uint32_t a, uint32_t b)
{
    for (uint32_t i = 0; i < w->edge_count; i++) {
        if (w->edges[i][0] == a && w->edges[i][1] == b) {
            memmove(w->edges + i, w->edges + i + 1u, (w->edge_count - i - 1u) * sizeof *w->edges);
            w->edge_count--;
            return;
        }
    }
    memmove(w->edges + 1, w->edges, EDGES * sizeof *w->edges);
    w->edges[0][0] = b;
    w->edges[0][1] = a;
    if (w->edge_count < EDGES) w->edge_count++;
}

/* Write a triangle so that it begins at a corner. */
static void write_triangle(walker *w, uint32_t triangle, uint32_t corner)
{
    const uint32_t *t = w->from + 3u * (size_t)triangle;
    const uint32_t a = t[corner], b = t[(corner + 1u) % 3u], c = t[(corner + 2u) % 3u];
    uint32_t *out = w->to + 3u * (size_t)w->written++;
    out[0] = a;
    out[1] = b;
    out[2] = c;
    w->seen[triangle] = 1;
    pass_edge(w, a, b);
    pass_edge(w, c, a);
    pass_edge(w, b, c);
}

static int go_on(walker *w)
{
    for (uint32_t i = 0; i < w->edge_count; i++) {
        const edge_slot *s = slot_of(w, w->edges[i][0], w->edges[i][1]);
        if (s->triangle != NOH_NONE && !w->seen[s->triangle]) {
            const uint32_t *t = w->from + 3u * (size_t)s->triangle;
            write_triangle(w, s->triangle, t[0] == s->a ? 0u : t[1] == s->a ? 1u : 2u);
            return 1;
        }
    }
    return 0;
}

/* 0, or 1 when there is no memory. */
static int walk(uint32_t *indices, uint32_t triangle_count)
{
    walker w;
    uint32_t size = 16;
    memset(&w, 0, sizeof w);
    while (size < 6u * triangle_count) size *= 2u;
    w.mask = size - 1u;
    w.triangle_count = triangle_count;
    w.from = indices;
    w.slots = malloc(size * sizeof *w.slots);
    w.seen = calloc(triangle_count + 1u, 1);
    w.to = malloc(12u * (size_t)triangle_count + 1u);
    if (w.slots && w.seen && w.to) {
        memset(w.slots, 0xff, size * sizeof *w.slots);
        for (uint32_t i = 0; i < 3u * triangle_count; i++) {
            edge_slot *s = slot_of(&w, indices[i], indices[i % 3u == 2u ? i - 2u : i + 1u]);
            s->a = indices[i];
            s->b = indices[i % 3u == 2u ? i - 2u : i + 1u];
            if (s->triangle == NOH_NONE) s->triangle = i / 3u;
        }
        for (uint32_t i = 0; i < triangle_count; i++) {
            if (w.seen[i]) continue;
            write_triangle(&w, i, 0);
            while (go_on(&w)) {}
        }
        memcpy(indices, w.to, 12u * (size_t)triangle_count);
    }
    free(w.slots);
    free(w.seen);
    free(w.to);
    return !w.slots || !w.seen || !w.to;
}

/* ---- a mesh that is changed in place ---- */

typedef struct orderer {
    noh_mesh mesh;
    uint8_t *chunk;
    uint32_t *vertex_to, *texel_to; /* new numbers */
    uint32_t *vertex_run, *texel_run;
    uint8_t *members; /* [touched_count][target_count] 1 + the coarsest level in which a rectangle lies over a texel */
    uint32_t *indices;
} orderer;

static noh_mesh level_of(const orderer *o, uint32_t k)
{
    return noh_mesh_at_lod(&o->mesh, o->mesh.header->level_first + k);
}

static uint32_t level_count(const orderer *o)
{
    return o->mesh.header->level_count - o->mesh.header->level_first;
}

static void put_index(const orderer *o, const noh_mesh *level, uint32_t i, uint32_t index)
{
    uint8_t *at = o->chunk + level->header->indices_offset + (size_t)i * level->header->index_bytes;
    const uint16_t narrow = (uint16_t)index;
    if (level->header->index_bytes == 2u)
        memcpy(at, &narrow, 2);
    else
        memcpy(at, &index, 4);
}

static int is_blended(const orderer *o, const noh_submesh *s)
{
    return s->material != NOH_NONE && (o->mesh.pack->materials[s->material].flags & NOH_MATERIAL_BLEND);
}

static int order_triangles(orderer *o)
{
    for (uint32_t k = 0; k < level_count(o); k++) {
        const noh_mesh level = level_of(o, k);
        for (uint32_t s = 0; s < level.header->submesh_count; s++) {
            const noh_submesh *sub = &level.submeshes[s];
            if (is_blended(o, sub)) continue;
            for (uint32_t i = 0; i < sub->index_count; i++)
                o->indices[i] = noh_mesh_index(&level, sub->first_index + i);
            if (walk(o->indices, sub->index_count / 3u)) return 1;
            for (uint32_t i = 0; i < sub->index_count; i++) put_index(o, &level, sub->first_index + i, o->indices[i]);
        }
    }
    return 0;
}

/* ---- runs: what may change places ---- */

/* A level has the first rectangles of each target. */
static uint8_t coarsest_with(const orderer *o, uint32_t target, uint32_t rect)
{
    uint32_t k = level_count(o) - 1u;
    while (k && rect >= level_of(o, k).targets[target].rect_count) k--;
    return (uint8_t)(k + 1u);
}

static void note_member(const orderer *o, uint32_t target, uint32_t rect)
{
    const noh_rect *r = &o->mesh.rects[o->mesh.targets[target].first_rect + rect];
    const uint8_t level = coarsest_with(o, target, rect);
    const noh_mesh_header *h = o->mesh.header;
    for (uint32_t n = 0; n < (uint32_t)r->w * r->h; n++) {
        const uint32_t texel = ((r->y + n / r->w) << h->morph_width_log2) + r->x + n % r->w;
        if (texel < h->touched_count) {
            uint8_t *member = &o->members[(size_t)texel * h->target_count + target];
            *member = *member ? FIXED : level;
        }
    }
}

static void make_texel_runs(orderer *o)
{
    const noh_mesh_header *h = o->mesh.header;
    uint32_t run = 0;
    int before = 0; /* the texel before stays where it is */
    for (uint32_t t = 0; t < h->target_count; t++) {
        for (uint32_t i = 0; i < o->mesh.targets[t].rect_count; i++) note_member(o, t, i);
    }
    for (uint32_t i = 0; i < h->touched_count; i++) {
        const uint8_t *now = o->members + (size_t)i * h->target_count;
        const int fixed = memchr(now, FIXED, h->target_count) != NULL;
        int other = i && (fixed || before || memcmp(now, now - h->target_count, h->target_count) != 0);
        before = fixed;
        for (uint32_t k = 1; k < level_count(o); k++) other |= i == level_of(o, k).header->touched_count;
        run += (uint32_t)other;
        o->texel_run[i] = run;
    }
}

/* The submesh that uses a vertex first, of its coarsest level. */
static void make_owners(const orderer *o, uint32_t *owners)
{
    memset(owners, 0xff, 4u * (size_t)o->mesh.header->vertex_count);
    for (uint32_t k = level_count(o); k > 0; k--) {
        const noh_mesh level = level_of(o, k - 1u);
        for (uint32_t s = 0; s < level.header->submesh_count; s++) {
            for (uint32_t i = 0; i < level.submeshes[s].index_count; i++) {
                uint32_t *owner = &owners[noh_mesh_index(&level, level.submeshes[s].first_index + i)];
                if (*owner == NOH_NONE) *owner = s;
            }
        }
    }
}

static void make_vertex_runs(orderer *o, uint32_t *owners)
{
    const noh_mesh_header *h = o->mesh.header;
    const int named = (h->flags & NOH_MESH_TEXELS) != 0;
    uint32_t run = 0, changes = 0;
    make_owners(o, owners);
    for (uint32_t v = 1; v < h->vertex_count; v++) changes += owners[v] != owners[v - 1u];
    if (changes > 2u * h->submesh_count) memset(owners, 0, 4u * (size_t)h->vertex_count); /* no ranges to keep apart */
    for (uint32_t v = 0; v < h->vertex_count; v++) {
        int other = v && owners[v] != owners[v - 1u];
        for (uint32_t k = 1; k < level_count(o); k++) other |= v == level_of(o, k).header->vertex_count;
        if (!named && v && v < h->touched_count) other |= o->texel_run[v] != o->texel_run[v - 1u];
        if (!named && v == h->touched_count) other = 1;
        run += (uint32_t)other;
        o->vertex_run[v] = run;
    }
}

/* ---- new numbers ---- */

/* Numbers within runs in the order of meeting, then the rest. `next` [runs]: the first free number. */
static void number(uint32_t *to, const uint32_t *run, uint32_t *next, uint32_t at)
{
    if (to[at] == NOH_NONE) to[at] = next[run[at]]++;
}

static void begin_runs(const uint32_t *run, uint32_t count, uint32_t *to, uint32_t *next)
{
    for (uint32_t i = count; i > 0; i--) next[run[i - 1u]] = i - 1u;
    memset(to, 0xff, 4u * (size_t)count);
}

static void make_numbers(orderer *o, uint32_t *vertex_next, uint32_t *texel_next)
{
    const noh_mesh_header *h = o->mesh.header;
    begin_runs(o->vertex_run, h->vertex_count, o->vertex_to, vertex_next);
    begin_runs(o->texel_run, h->touched_count, o->texel_to, texel_next);
    for (uint32_t k = level_count(o); k > 0; k--) {
        const noh_mesh level = level_of(o, k - 1u);
        for (uint32_t i = 0; i < level.header->index_count; i++) {
            number(o->vertex_to, o->vertex_run, vertex_next, noh_mesh_index(&level, i));
        }
    }
    for (uint32_t v = 0; v < h->vertex_count; v++) number(o->vertex_to, o->vertex_run, vertex_next, v);
    for (uint32_t v = 0; v < h->vertex_count; v++) vertex_next[o->vertex_to[v]] = v; /* now the old numbers */
    for (uint32_t i = 0; i < h->vertex_count; i++) {
        const uint32_t texel = noh_mesh_accumulation_texel(&o->mesh, vertex_next[i]);
        if (texel < h->touched_count) number(o->texel_to, o->texel_run, texel_next, texel);
    }
    for (uint32_t i = 0; i < h->touched_count; i++) number(o->texel_to, o->texel_run, texel_next, i);
}

/* ---- the arrays ---- */

static int permute(uint8_t *array, uint32_t count, size_t stride, const uint32_t *to)
{
    uint8_t *copy = malloc(count * stride + 1u);
    if (!copy) return 1;
    memcpy(copy, array, count * stride);
    for (uint32_t i = 0; i < count; i++) memcpy(array + to[i] * stride, copy + i * stride, stride);
    free(copy);
    return 0;
}

static void rename_indices(orderer *o)
{
    for (uint32_t k = 0; k < level_count(o); k++) {
        const noh_mesh level = level_of(o, k);
        for (uint32_t i = 0; i < level.header->index_count; i++) {
            put_index(o, &level, i, o->vertex_to[noh_mesh_index(&level, i)]);
        }
        for (uint32_t s = 0; s < level.header->submesh_count; s++) {
            noh_submesh sub = level.submeshes[s];
            uint32_t first = NOH_NONE, last = 0;
            for (uint32_t i = 0; i < sub.index_count; i++) {
                const uint32_t v = noh_mesh_index(&level, sub.first_index + i);
                first = v < first ? v : first;
                last = v > last ? v : last;
            }
            if (sub.index_count) {
                sub.first_vertex = first;
                sub.vertex_count = last - first + 1u;
            }
            memcpy(o->chunk + level.header->submeshes_offset + s * sizeof sub, &sub, sizeof sub);
        }
    }
}

static void rename_texel_words(orderer *o)
{
    const noh_mesh_header *h = o->mesh.header;
    for (uint32_t v = 0; v < h->vertex_count; v++) {
        uint8_t *at = o->chunk + h->attributes_offset + ((size_t)v + 1u) * h->attribute_stride - 4u;
        uint32_t word;
        memcpy(&word, at, 4);
        if ((word & NOH_TEXEL_NONE) < h->touched_count) {
            word = (word & ~NOH_TEXEL_NONE) | o->texel_to[word & NOH_TEXEL_NONE];
            memcpy(at, &word, 4);
        }
    }
}

/* A target's delta texels: each moves to the place of its accumulation texel's new number in the rectangles. */
static void move_texels(orderer *o, uint32_t target, uint32_t *slots, uint32_t *copy)
{
    const noh_mesh_header *h = o->mesh.header;
    const noh_target *t = &o->mesh.targets[target];
    uint32_t *texels = (uint32_t *)(void *)(o->chunk + h->texels_offset) + 3u * (size_t)t->first_texel, *now = slots;
    uint32_t slot = 0;
    memcpy(copy, texels, 12u * (size_t)t->texel_count);
    for (int pass = 0; pass < 2; pass++, slot = 0) {
        for (uint32_t i = 0; i < t->rect_count; i++) {
            const noh_rect r = o->mesh.rects[t->first_rect + i];
            for (uint32_t n = 0; n < (uint32_t)r.w * r.h; n++, slot++) {
                const uint32_t texel = ((r.y + n / r.w) << h->morph_width_log2) + r.x + n % r.w;
                if (texel >= h->touched_count || o->texel_to[texel] == texel) continue;
                if (!pass)
                    now[texel] = slot;
                else
                    memcpy(texels + 3u * (size_t)now[o->texel_to[texel]], copy + 3u * (size_t)slot, 12u);
            }
        }
    }
}

static int apply(orderer *o)
{
    const noh_mesh_header *h = o->mesh.header;
    uint32_t *slots = malloc(4u * (size_t)h->touched_count + 4u), *copy = malloc(12u * (size_t)h->texel_count + 4u);
    int failed = !slots || !copy || permute(o->chunk + h->positions_offset, h->vertex_count, 12u, o->vertex_to) ||
                 permute(o->chunk + h->attributes_offset, h->vertex_count, h->attribute_stride, o->vertex_to) ||
                 permute(o->chunk + h->influences_offset, h->vertex_count, 4u * NOH_INFLUENCE_WORDS(h->influence_count),
                         o->vertex_to);
    if (!failed) {
        rename_indices(o);
        if (h->flags & NOH_MESH_TEXELS) rename_texel_words(o);
        for (uint32_t t = 0; t < h->target_count; t++) move_texels(o, t, slots, copy);
    }
    free(slots);
    free(copy);
    return failed;
}

/* ---- a mesh ---- */

/* Vertices keep their places where something else refers to them: a transfer, an influence list, texels shared between
 * palettes, or texels of texture coordinates. */
static int may_rename(const orderer *o, const noh_pack *pack, uint32_t index)
{
    noh_skin_list list;
    return !o->mesh.transfer && !(o->mesh.header->flags & NOH_MESH_UV_TARGETS) &&
           noh_pack_skin_list(pack, index, &list, NULL) &&
           !((o->mesh.header->flags & NOH_MESH_TEXELS) && o->mesh.header->level_count == 1u) &&
           o->mesh.header->palette_count <= 1u;
}

static int rename_all(orderer *o)
{
    const noh_mesh_header *h = o->mesh.header;
    const size_t n = h->vertex_count, m = h->touched_count;
    uint32_t *memory = malloc(4u * (4u * n + 3u * m + 8u)), *next = memory ? memory + 3u * n + 2u * m : NULL;
    int failed;
    o->members = calloc(m * h->target_count + 1u, 1);
    failed = !memory || !o->members;
    if (!failed) {
        o->vertex_to = memory;
        o->vertex_run = memory + n;
        o->texel_to = memory + 2u * n;
        o->texel_run = memory + 2u * n + m;
        make_texel_runs(o);
        make_vertex_runs(o, memory + 2u * n + 2u * m);
        make_numbers(o, next, next + n);
        failed = apply(o);
    }
    free(memory);
    free(o->members);
    return failed;
}

static int order_mesh(noh_pack *copy, uint32_t index)
{
    orderer o;
    int failed;
    memset(&o, 0, sizeof o);
    (void)noh_pack_mesh_at(copy, index, &o.mesh, NULL);
    o.chunk = (uint8_t *)(uintptr_t)noh_pack_chunk_at(copy, NOH_CHUNK_MESH, index);
    o.indices = malloc(4u * (size_t)o.mesh.header->index_count + 4u);
    failed = !o.indices || order_triangles(&o) || (may_rename(&o, copy, index) && rename_all(&o));
    free(o.indices);
    return failed;
}

int pack_order(const noh_pack *pack, byte_buffer *out, model_error *error)
{
    noh_pack copy = *pack;
    noh_pack_header h;
    noh_pack_chunk *chunks;
    int failed = !buffer_append(out, pack->bytes, pack->byte_count);
    copy.bytes = out->bytes;
    copy.chunks = failed ? NULL : (const noh_pack_chunk *)(const void *)(out->bytes + sizeof h);
    for (uint32_t i = 0; !failed && i < pack->runs[NOH_CHUNK_MESH].count; i++) failed = order_mesh(&copy, i);
    if (failed) {
        buffer_free(out);
        return model_fail_memory(error);
    }
    chunks = (noh_pack_chunk *)(void *)(out->bytes + sizeof h);
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        noh_pack_chunk *c = &chunks[pack->runs[NOH_CHUNK_MESH].first + i];
        c->crc = noh_crc32c(0, out->bytes + c->offset, c->bytes);
    }
    memcpy(&h, out->bytes, sizeof h);
    h.crc = 0;
    h.crc = noh_crc32c(noh_crc32c(0, &h, sizeof h), chunks, pack->chunk_count * sizeof *chunks);
    memcpy(out->bytes, &h, sizeof h);
    return 0;
}
