/* pack_strip.c: copies chunk by chunk; of a mesh with levels to cut, array by array.
 *
 * Levels are prefixes of one another: vertices, accumulation texels, and for each target its rectangles and delta
 * texels. So the arrays are cut at the counts of the finest level that stays. Rectangles and delta texels of all
 * targets lie in one array each, in target order: they move together, and the targets of every level get the new
 * offsets. A mesh's transfer and influence list are cut likewise. */
#include "pack_strip.h"

#include <string.h>

#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "pack_copy.h"

/* ---- which levels ---- */

int strip_level_parse(const char *item, size_t *name_bytes, uint32_t *level)
{
    const char *equals = strrchr(item, '='), *digit = equals ? equals + 1 : item;
    *name_bytes = equals ? (size_t)(equals - item) : 0;
    if (equals == item || digit[0] < '0' || digit[0] >= (char)('0' + NOH_LOD_LEVELS_MAX) || digit[1]) {
        return 1;
    }
    *level = (uint32_t)(digit[0] - '0');
    return 0;
}

static int is_for(const char *item, size_t name_bytes, const char *mesh)
{
    return !name_bytes || (strlen(mesh) == name_bytes && memcmp(item, mesh, name_bytes) == 0);
}

static uint32_t at_most(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

int strip_levels_of(const strip_levels *levels, const noh_pack *pack, uint32_t *first, model_error *error)
{
    memset(first, 0, pack->runs[NOH_CHUNK_MESH].count * sizeof *first);
    for (uint32_t i = 0; i < levels->count; i++) {
        size_t name_bytes;
        uint32_t level, found = 0;
        if (strip_level_parse(levels->items[i], &name_bytes, &level)) {
            return model_fail(error, "", "'%.100s' is not a level: it must be K or MESH=K, K from 0 to %u",
                              levels->items[i], NOH_LOD_LEVELS_MAX - 1u);
        }
        for (uint32_t m = 0; m < pack->runs[NOH_CHUNK_MESH].count; m++) {
            if (is_for(levels->items[i], name_bytes, noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_MESH].first + m))) {
                first[m] = level;
                found = 1;
            }
        }
        if (!found && name_bytes) {
            return model_fail(error, "", "no mesh is named '%.*s'", (int)at_most((uint32_t)name_bytes, 100u),
                              levels->items[i]);
        }
    }
    for (uint32_t m = 0; m < pack->runs[NOH_CHUNK_MESH].count; m++) {
        noh_mesh mesh;
        (void)noh_pack_mesh_at(pack, m, &mesh, NULL);
        first[m] = noh_mesh_at_lod(&mesh, first[m]).header->level;
    }
    return 0;
}

/* ---- a mesh ---- */

typedef struct stripper {
    const noh_pack *pack;
    const uint32_t *first;
    noh_mesh from;        /* at the finest level that stays */
    noh_mesh_header *h;   /* [levels that stay] */
    uint32_t level_count; /* that stay */
    size_t base;          /* of the chunk in out */
    byte_buffer *out;
} stripper;

static noh_mesh level_at(const stripper *s, uint32_t k)
{
    return noh_mesh_at_lod(&s->from, s->from.header->level + k);
}

/* Arrays begin at multiples of 16 of their chunk. Returns the offset in the chunk. */
static uint32_t append(stripper *s, const void *bytes, size_t count)
{
    const size_t at = (buffer_align(s->out, 16), s->out->count - s->base);
    buffer_append(s->out, bytes ? bytes : "", count);
    return (uint32_t)at;
}

/* Indices and submeshes of all levels, one after the other. Indices take 2 bytes where that is now enough. */
static void append_triangles(stripper *s)
{
    const uint32_t narrow = s->from.header->vertex_count <= 65536u, wide = s->from.header->index_bytes;
    uint32_t at = append(s, NULL, 0);
    for (uint32_t k = 0; k < s->level_count; k++) {
        const noh_mesh level = level_at(s, k);
        s->h[k].index_bytes = narrow ? 2u : wide;
        s->h[k].indices_offset = at;
        at += level.header->index_count * s->h[k].index_bytes;
        for (uint32_t i = 0; i < level.header->index_count; i++) {
            const uint32_t index = noh_mesh_index(&level, i);
            const uint16_t small = (uint16_t)index;
            buffer_append(s->out, narrow ? (const void *)&small : (const void *)&index, s->h[k].index_bytes);
        }
    }
    at = append(s, NULL, 0);
    for (uint32_t k = 0; k < s->level_count; k++) {
        const noh_mesh level = level_at(s, k);
        s->h[k].submeshes_offset = at;
        at += level.header->submesh_count * (uint32_t)sizeof *level.submeshes;
        buffer_append(s->out, level.submeshes, level.header->submesh_count * sizeof *level.submeshes);
    }
}

/* The targets of all levels: each begins where the targets before it end in the finest level that stays. */
static void append_targets(stripper *s)
{
    uint32_t at = append(s, NULL, 0);
    for (uint32_t k = 0; k < s->level_count; k++) {
        const noh_mesh level = level_at(s, k);
        uint32_t rects = 0, texels = 0;
        s->h[k].targets_offset = at;
        for (uint32_t t = 0; t < level.header->target_count; t++) {
            noh_target target = level.targets[t];
            target.first_rect = rects;
            target.first_texel = texels;
            rects += s->from.targets[t].rect_count;
            texels += s->from.targets[t].texel_count;
            buffer_append(s->out, &target, sizeof target);
        }
        at += level.header->target_count * (uint32_t)sizeof *level.targets;
    }
}

static void append_deltas(stripper *s)
{
    const noh_mesh *m = &s->from;
    s->h->rects_offset = append(s, NULL, 0);
    for (uint32_t t = 0; t < m->header->target_count; t++) {
        buffer_append(s->out, m->rects + m->targets[t].first_rect, m->targets[t].rect_count * sizeof *m->rects);
    }
    s->h->texels_offset = append(s, NULL, 0);
    for (uint32_t t = 0; t < m->header->target_count; t++) {
        buffer_append(s->out, m->texels + 3u * (size_t)m->targets[t].first_texel, m->targets[t].texel_count * 12u);
    }
}

static void append_skin(stripper *s)
{
    const noh_mesh_header *of = s->from.header;
    noh_skin skin;
    const uint32_t joints = noh_pack_skin_at(s->pack, of->skin, &skin, NULL) ? 0u : skin.header->joint_count;
    s->h->influences_offset = append(s, s->from.influences,
                                     of->vertex_count * 4u * (size_t)NOH_INFLUENCE_WORDS(of->influence_count));
    s->h->palettes_offset = append(s, s->from.palettes, of->palette_count * sizeof *s->from.palettes);
    s->h->palette_joints_offset = append(s, s->from.palette_joints,
                                         of->palette_joint_count * sizeof *s->from.palette_joints);
    s->h->joint_boxes_offset = append(s, s->from.joint_boxes, joints * 24u);
}

/* Data shared by all levels is in the finest one. */
static void share_offsets(stripper *s)
{
    for (uint32_t k = 0; k < s->level_count; k++) {
        noh_mesh_header *h = &s->h[k];
        h->level_first = s->from.header->level;
        h->source_crc = noh_mesh_source(&s->from);
        h->positions_offset = s->h->positions_offset;
        h->attributes_offset = s->h->attributes_offset;
        h->weights_offset = s->h->weights_offset;
        h->rects_offset = s->h->rects_offset;
        h->texels_offset = s->h->texels_offset;
        h->target_boxes_offset = s->h->target_boxes_offset;
        h->influences_offset = s->h->influences_offset;
        h->palettes_offset = s->h->palettes_offset;
        h->palette_joints_offset = s->h->palette_joints_offset;
        h->joint_boxes_offset = s->h->joint_boxes_offset;
    }
}

static void append_mesh(stripper *s)
{
    const noh_mesh_header *of = s->from.header;
    noh_mesh_header headers[NOH_LOD_LEVELS_MAX];
    s->level_count = of->level_count - of->level;
    s->h = headers;
    for (uint32_t k = 0; k < s->level_count; k++) {
        headers[k] = *level_at(s, k).header;
    }
    buffer_append(s->out, NULL, s->level_count * sizeof *headers);
    headers->positions_offset = append(s, s->from.positions, of->vertex_count * (size_t)12u);
    headers->attributes_offset = append(s, s->from.attributes, of->vertex_count * (size_t)of->attribute_stride);
    append_triangles(s);
    append_targets(s);
    headers->weights_offset = append(s, s->from.weights, of->target_count * 4u);
    append_deltas(s);
    headers->target_boxes_offset = append(s, s->from.target_boxes, of->target_count * 24u);
    append_skin(s);
    share_offsets(s);
    if (!s->out->failed) {
        memcpy(s->out->bytes + s->base, headers, s->level_count * sizeof *headers);
    }
}

/* ---- a transfer ---- */

/* Its records follow the vertices, its differences the delta texels. */
static void append_transfer(stripper *s, uint32_t index)
{
    const uint8_t *from = s->pack->bytes + s->pack->chunks[index].offset;
    const noh_transfer_header *of = (const noh_transfer_header *)(const void *)from;
    noh_transfer_header h = *of;
    (void)noh_pack_mesh_at(s->pack, of->mesh, &s->from, NULL);
    s->from = noh_mesh_at_lod(&s->from, s->first[of->mesh]);
    h.vertex_count = s->from.header->vertex_count;
    h.texel_count = s->from.header->texel_count;
    buffer_append(s->out, NULL, sizeof h);
    h.records_offset = append(s, from + of->records_offset,
                              h.vertex_count * (size_t)NOH_TRANSFER_RECORD_BYTES(h.order, h.flags));
    h.scales_offset = append(s, from + of->scales_offset, 4u * (size_t)h.target_count);
    h.deltas_offset = append(s, NULL, 0);
    for (uint32_t t = 0; t < h.target_count; t++) {
        buffer_append(s->out, from + of->deltas_offset + s->from.targets[t].first_texel,
                      s->from.targets[t].texel_count);
    }
    if (!s->out->failed) {
        memcpy(s->out->bytes + s->base, &h, sizeof h);
    }
}

/* ---- an influence list ---- */

/* Vertices of the levels that stay are the first ones, and the list is in their order. */
static void append_influences(stripper *s, uint32_t index)
{
    const uint8_t *from = s->pack->bytes + s->pack->chunks[index].offset;
    noh_influences_header h = *(const noh_influences_header *)(const void *)from;
    const uint32_t *firsts = (const uint32_t *)(const void *)(from + h.firsts_offset);
    noh_skin_list list;
    (void)noh_pack_mesh_at(s->pack, h.mesh, &s->from, NULL);
    (void)noh_pack_skin_list(s->pack, h.mesh, &list, NULL);
    s->from = noh_mesh_at_lod(&s->from, s->first[h.mesh]);
    h.vertex_count = noh_skin_list_place(&list, s->from.header->vertex_count);
    h.influence_count = firsts[h.vertex_count];
    h.most = 0;
    for (uint32_t i = 0; i < h.vertex_count; i++) {
        h.most = firsts[i + 1u] - firsts[i] > h.most ? firsts[i + 1u] - firsts[i] : h.most;
    }
    buffer_append(s->out, NULL, sizeof h);
    h.vertices_offset = append(s, list.vertices, 4u * (size_t)h.vertex_count);
    h.firsts_offset = append(s, firsts, 4u * (h.vertex_count + (size_t)1u));
    h.weights_offset = append(s, list.weights, 4u * (size_t)h.influence_count);
    h.joints_offset = append(s, list.joints, 2u * (size_t)h.influence_count);
    if (!s->out->failed) {
        memcpy(s->out->bytes + s->base, &h, sizeof h);
    }
}

/* ---- the pack ---- */

static void append_chunk(void *context, uint32_t index, byte_buffer *out)
{
    stripper *s = context;
    const uint32_t mesh = index - s->pack->runs[NOH_CHUNK_MESH].first;
    const int is_mesh = index >= s->pack->runs[NOH_CHUNK_MESH].first && mesh < s->pack->runs[NOH_CHUNK_MESH].count;
    s->out = out;
    s->base = out->count;
    if (is_mesh) {
        (void)noh_pack_mesh_at(s->pack, mesh, &s->from, NULL);
    }
    if (is_mesh && s->first[mesh] > s->from.header->level) {
        s->from = noh_mesh_at_lod(&s->from, s->first[mesh]);
        append_mesh(s);
    } else if (s->pack->chunks[index].type == NOH_TAG_TRANSFER) {
        append_transfer(s, index);
    } else if (s->pack->chunks[index].type == NOH_TAG_INFLUENCES) {
        append_influences(s, index);
    } else {
        pack_copy_as_is(s->pack, index, out);
    }
}

int pack_strip(const noh_pack *pack, const uint32_t *first, byte_buffer *out, model_error *error)
{
    stripper s;
    memset(&s, 0, sizeof s);
    s.pack = pack;
    s.first = first;
    return pack_copy(pack, append_chunk, &s, out, error);
}
