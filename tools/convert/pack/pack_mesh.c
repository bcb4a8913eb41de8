/* pack_mesh.c: vertices in the encoder's order, compact attributes, indices, targets, influences. */
#include "pack_mesh.h"

#include <math.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "convert/morph/f16_bound.h"
#include "convert/skin/influence_pack.h"
#include "mesh_layout.h"
#include "pack_skin.h"

/* A unit vector as an octahedral pair in -1 to 1. */
static void fold(const float v[3], float pair[2])
{
    float sum = fabsf(v[0]) + fabsf(v[1]) + fabsf(v[2]);
    float x = sum > 0.0f ? v[0] / sum : 0.0f, y = sum > 0.0f ? v[1] / sum : 0.0f;
    pair[0] = v[2] >= 0.0f ? x : (1.0f - fabsf(y)) * (x >= 0.0f ? 1.0f : -1.0f);
    pair[1] = v[2] >= 0.0f ? y : (1.0f - fabsf(x)) * (y >= 0.0f ? 1.0f : -1.0f);
}

static uint32_t round_to(float value, float top)
{
    return (uint32_t)(int32_t)floorf(value * top + 0.5f);
}

static uint32_t pack_normal(const float v[3])
{
    float pair[2];
    fold(v, pair);
    return (round_to(pair[0], 32767.0f) & 0xffffu) | round_to(pair[1], 32767.0f) << 16;
}

static uint32_t pack_tangent(const float v[4])
{
    float pair[2];
    fold(v, pair);
    return (round_to(pair[0], 32767.0f) & 0xffffu) | round_to(pair[1], 16383.0f) << 17 | (v[3] < 0.0f ? 0x10000u : 0u);
}

static uint32_t unorm(float value, float top)
{
    float clamped = value < 0.0f ? 0.0f : value > 1.0f ? 1.0f : value;
    return (uint32_t)floorf(clamped * top + 0.5f);
}

static uint32_t pack_color(const float c[4])
{
    uint32_t word = unorm(c[3], 255.0f) << 24;
    for (unsigned i = 0; i < 3; i++) {
        word |= unorm(sqrtf(c[i] > 0.0f ? c[i] : 0.0f), 255.0f) << (8u * i);
    }
    return word;
}

static uint32_t mesh_flags(const model_mesh *m)
{
    return (m->tangent ? NOH_MESH_TANGENTS : 0u) | (m->uv ? NOH_MESH_UVS : 0u) | (m->color ? NOH_MESH_COLORS : 0u);
}

static void set_bounds(const model_mesh *m, noh_mesh_header *h)
{
    for (int c = 0; c < 3; c++) {
        h->bounds_min[c] = h->bounds_max[c] = m->position[c];
    }
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        for (int c = 0; c < 3; c++) {
            float p = m->position[3 * (size_t)v + (size_t)c];
            h->bounds_min[c] = p < h->bounds_min[c] ? p : h->bounds_min[c];
            h->bounds_max[c] = p > h->bounds_max[c] ? p : h->bounds_max[c];
        }
    }
}

/* UVs are 16-bit fractions of their own range, so that tiling ones keep their precision. */
static void set_uv_range(const model_mesh *m, noh_mesh_header *h)
{
    float low[2] = { 0.0f, 0.0f }, high[2] = { 0.0f, 0.0f };
    for (uint32_t v = 0; m->uv && v < m->vertex_count; v++) {
        for (int c = 0; c < 2; c++) {
            float value = m->uv[2 * (size_t)v + (size_t)c];
            low[c] = v == 0 || value < low[c] ? value : low[c];
            high[c] = v == 0 || value > high[c] ? value : high[c];
        }
    }
    for (int c = 0; c < 2; c++) {
        h->uv_offset[c] = low[c];
        h->uv_scale[c] = high[c] - low[c];
    }
}

static uint32_t pack_uv(const float uv[2], const noh_mesh_header *h)
{
    uint32_t word = 0;
    for (unsigned c = 0; c < 2; c++) {
        float fraction = h->uv_scale[c] > 0.0f ? (uv[c] - h->uv_offset[c]) / h->uv_scale[c] : 0.0f;
        word |= unorm(fraction, 65535.0f) << (16u * c);
    }
    return word;
}

#define RECORD_WORDS_MAX 14u

static uint32_t attribute_record(const mesh_input *from, const mesh_layout *l, uint32_t vertex,
                                 const noh_mesh_header *h, uint32_t record[RECORD_WORDS_MAX])
{
    const model_mesh *m = from->mesh;
    const morph_encoding *e = from->encoding;
    size_t old = l->source[vertex];
    uint32_t words = 0;
    record[words++] = pack_normal(m->normal + 3 * old);
    if (m->tangent) {
        record[words++] = pack_tangent(m->tangent + 4 * old);
    }
    if (m->uv) {
        record[words++] = pack_uv(m->uv + 2 * old, h);
    }
    if (m->color) {
        record[words++] = pack_color(m->color + 4 * old);
    }
    extras_pack(from->extras, m, old, record + words);
    words += from->extras->word_count;
    if (e->uv_texel) {
        record[words++] = e->uv_texel[old] == MODEL_NONE ? NOH_TEXEL_NONE : e->uv_texel[old];
    }
    if (h->flags & NOH_MESH_TEXELS) {
        record[words++] = l->texel[vertex] | l->palette[vertex] << NOH_TEXEL_VERTEX_BITS;
    }
    return words;
}

static void append_vertices(const mesh_input *from, const mesh_layout *l, noh_mesh_header *h, size_t base,
                            byte_buffer *out)
{
    const model_mesh *m = from->mesh;
    buffer_align(out, 16);
    h->positions_offset = (uint32_t)(out->count - base);
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        buffer_append(out, m->position + 3 * (size_t)l->source[v], 12);
    }
    buffer_align(out, 16);
    h->attributes_offset = (uint32_t)(out->count - base);
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        uint32_t record[RECORD_WORDS_MAX];
        h->attribute_stride = 4 * attribute_record(from, l, v, h, record);
        buffer_append(out, record, h->attribute_stride);
    }
}

/* For all levels; h is the full mesh's header. */
static void append_indices(const mesh_layout *l, noh_mesh_header *h, size_t base, byte_buffer *out)
{
    buffer_align(out, 16);
    h->indices_offset = (uint32_t)(out->count - base);
    h->index_bytes = h->vertex_count <= 65536u ? 2u : 4u;
    for (uint32_t i = 0; i < l->index_count; i++) {
        uint16_t narrow = (uint16_t)l->indices[i];
        buffer_append(out, h->index_bytes == 2 ? (const void *)&narrow : (const void *)&l->indices[i], h->index_bytes);
    }
    buffer_align(out, 16);
    h->submeshes_offset = (uint32_t)(out->count - base);
    buffer_append(out, l->submeshes, sizeof *l->submeshes * l->submesh_count);
}

static noh_target target_of(const model_mesh *m, const morph_encoding *e, uint32_t level, uint32_t t,
                            string_table *strings)
{
    const morph_target *from = &e->targets[t];
    const morph_part *part = &e->parts[(size_t)level * e->target_count + t];
    noh_target to;
    memset(&to, 0, sizeof to);
    to.name = string_offset(strings, m->targets[t].name);
    to.name_hash = string_hash(m->targets[t].name);
    to.first_rect = from->first_rect;
    to.rect_count = part->rect_count;
    to.first_texel = from->first_texel;
    to.texel_count = part->texel_count;
    to.pair_count = part->pair_count;
    to.position_bits = from->position_bits;
    to.normal_bits = from->normal_bits;
    to.tangent_bits = from->tangent_bits;
    to.flags = m->targets[t].identity ? NOH_TARGET_IDENTITY : 0;
    to.lips = (int16_t)lrintf(4096.0f * m->targets[t].lips);
    to.position_scale = from->position_scale;
    to.normal_scale = from->normal_scale;
    to.tangent_scale = from->tangent_scale;
    to.radius = from->radius;
    to.position_error = from->position_error;
    to.normal_error = from->normal_error;
    to.tangent_error = from->tangent_error;
    return to;
}

static void append_targets(const model_mesh *m, const morph_encoding *e, string_table *strings, noh_mesh_header *h,
                           size_t base, byte_buffer *out)
{
    buffer_align(out, 16);
    h->targets_offset = (uint32_t)(out->count - base);
    for (uint32_t i = 0; i < e->level_count * e->target_count; i++) {
        const noh_target to = target_of(m, e, i / e->target_count, i % e->target_count, strings);
        buffer_append(out, &to, sizeof to);
    }
    buffer_align(out, 16);
    h->weights_offset = (uint32_t)(out->count - base);
    buffer_append(out, m->weights, 4u * (size_t)m->target_count);
    buffer_align(out, 16);
    h->rects_offset = (uint32_t)(out->count - base);
    buffer_append(out, e->rects, sizeof(noh_rect) * (size_t)e->rect_count);
    buffer_align(out, 16);
    h->texels_offset = (uint32_t)(out->count - base);
    buffer_append(out, e->texels, 12u * (size_t)e->texel_count);
}

/* From the source's deltas; decoded ones differ by at most the certified error. */
static void append_target_boxes(const mesh_input *from, noh_mesh_header *h, size_t base, byte_buffer *out)
{
    const model_mesh *m = from->mesh;
    const morph_encoding *e = from->encoding;
    const float *baked = from->levels->joints.boxes; /* of what virtual joints do instead */
    buffer_align(out, 16);
    h->target_boxes_offset = (uint32_t)(out->count - base);
    for (uint32_t t = 0; t < e->target_count; t++) {
        float box[6] = { 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f };
        for (uint32_t v = 0; v < m->vertex_count; v++) {
            pack_grow_box(box, m->targets[t].position + 3 * (size_t)v);
        }
        if (baked) {
            pack_grow_box(box, baked + 6 * (size_t)t);
            pack_grow_box(box, baked + 6 * (size_t)t + 3);
        }
        for (int c = 0; c < 3; c++) {
            box[c] -= e->targets[t].position_error;
            box[3 + c] += e->targets[t].position_error;
        }
        buffer_append(out, box, sizeof box);
    }
}

static void set_counts(const model_mesh *m, const morph_encoding *e, const mesh_layout *l, noh_mesh_header *h)
{
    memset(h, 0, sizeof *h);
    h->flags = mesh_flags(m);
    h->vertex_count = l->vertex_count;
    h->index_count = l->levels[0].index_count;
    h->submesh_count = l->levels[0].submesh_count;
    h->target_count = e->target_count;
    h->rect_count = e->rect_count;
    h->texel_count = e->texel_count;
    h->pair_count = e->pair_count;
    h->source_pair_count = e->source_pairs;
    h->touched_count = e->touched_count;
    h->morph_width_log2 = e->width_log2;
    h->morph_height = e->height;
    h->texels_one_rect = e->texels_one_rect;
    h->level_count = l->level_count;
    h->flags |= e->uv_texel ? NOH_MESH_UV_TARGETS : 0u;
    h->uv_per_unit = e->uv_per_unit;
    set_bounds(m, h);
    set_uv_range(m, h);
}

static void set_skin(const model_mesh *m, const mesh_layout *l, uint32_t skin, noh_mesh_header *h)
{
    h->flags |= l->texel_references ? NOH_MESH_TEXELS : 0u;
    h->skin = skin;
    if (skin != NOH_NONE) {
        h->flags |= m->dual_quaternion ? NOH_MESH_DUAL_QUATERNION : 0u;
        h->influence_count = influence_width(m);
        h->palette_count = l->palette_count;
        h->palette_joint_count = l->palette_joint_count;
    }
}

/* A level's header, from the full mesh's, whose offsets are known by now. */
static noh_mesh_header level_header(const noh_mesh_header *full, const morph_encoding *e, const mesh_layout *l,
                                    const mesh_levels *levels, uint32_t level)
{
    const level_layout *own = &l->levels[level];
    const lod_errors *errors = &levels->errors[level];
    const int has_targets = !levels->joints.level || level < levels->joints.level;
    noh_mesh_header h = *full;
    h.level = level;
    h.vertex_count = own->vertex_count;
    h.index_count = own->index_count;
    h.submesh_count = own->submesh_count;
    h.touched_count = e->level_touched[level];
    h.morph_height = (h.touched_count + (1u << h.morph_width_log2) - 1u) >> h.morph_width_log2;
    h.rect_count = h.texel_count = h.pair_count = 0;
    for (uint32_t t = 0; t < e->target_count; t++) {
        const morph_part *part = &e->parts[(size_t)level * e->target_count + t];
        h.rect_count += part->rect_count;
        h.texel_count += part->texel_count;
        h.pair_count += part->pair_count;
        h.level_skipped += has_targets && e->targets[t].rect_count && !part->rect_count ? e->targets[t].radius : 0.0f;
    }
    h.indices_offset += own->first_index * h.index_bytes;
    h.submeshes_offset += own->first_submesh * (uint32_t)sizeof(noh_submesh);
    h.targets_offset += level * h.target_count * (uint32_t)sizeof(noh_target);
    h.level_error_rest = errors->rest;
    h.level_error_rest_p99 = errors->rest_p99;
    h.level_error_targets = errors->targets;
    h.level_error_pairs = errors->pairs;
    h.level_error_clip = errors->clip;
    return h;
}

static int check_extras(const mesh_input *from, model_error *error)
{
    const uint32_t most = NOH_EXTRA_WORDS_ROOM(from->encoding->uv_texel ? NOH_MESH_UV_TARGETS : 0u);
    if (from->extras->word_count <= most) return 0;
    return model_fail(error, from->mesh->name,
                      "its --attributes take %u bytes a vertex, and it has room for %u: NAME:8 stores one in bytes",
                      4u * from->extras->word_count, 4u * most);
}

int pack_mesh(const mesh_input *from, string_table *strings, byte_buffer *out, mesh_extra *extra, model_error *error)
{
    const model_mesh *m = from->mesh;
    const mesh_levels *levels = from->levels;
    const morph_encoding *e = from->encoding;
    size_t base = out->count;
    noh_mesh_header h;
    mesh_layout l = { 0 };
    int failed = check_extras(from, error) || mesh_layout_make(m, levels, e, from->submesh_blends, &l, error);
    if (!failed) {
        set_counts(m, e, &l, &h);
        if (f16_bound(e, &h.f16_position_bound, &h.f16_direction_bound)) out->failed = 1;
        set_skin(m, &l, from->skin, &h);
        h.world_scale = from->world_scale;
        h.extra_words = from->extras->word_count;
        memcpy(h.influence_errors, levels->cap_error, sizeof h.influence_errors);
        buffer_append(out, NULL, sizeof h * l.level_count);
        append_vertices(from, &l, &h, base, out);
        append_indices(&l, &h, base, out);
        append_targets(m, e, strings, &h, base, out);
        append_target_boxes(from, &h, base, out);
        pack_influences(m, &l, &h, base, out);
        pack_joint_boxes(m, from->skin_joint_count, &h, base, out);
        pack_influence_list(m, &l, extra->index, &extra->influences);
    }
    for (uint32_t k = 0; k < l.level_count && !failed && !out->failed; k++) {
        const noh_mesh_header header = level_header(&h, e, &l, levels, k);
        memcpy(out->bytes + base + k * sizeof header, &header, sizeof header);
    }
    mesh_layout_free(&l);
    return failed;
}
