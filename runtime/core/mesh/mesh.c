#include "core/base/assert_internal.h"
#include "core/mesh/mesh_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/name_internal.h"
#include "core/base/math_internal.h"
#include "core/base/octahedral_internal.h"

/* The headers of a mesh's levels lie at the chunk's start; the offsets of every level count from there. */
static const noh_mesh_header *chunk_of(const noh_mesh_header *h)
{
    return h - (h->level - h->level_first);
}

/* Point a view at a level's header. */
static void view_of(const noh_mesh_header *h, noh_mesh *mesh)
{
    const uint8_t *chunk = (const uint8_t *)chunk_of(h);
    mesh->header = h;
    mesh->positions = (const float *)(const void *)(chunk + h->positions_offset);
    mesh->attributes = chunk + h->attributes_offset;
    mesh->indices = chunk + h->indices_offset;
    mesh->submeshes = (const noh_submesh *)(const void *)(chunk + h->submeshes_offset);
    mesh->targets = (const noh_target *)(const void *)(chunk + h->targets_offset);
    mesh->weights = (const float *)(const void *)(chunk + h->weights_offset);
    mesh->rects = (const noh_rect *)(const void *)(chunk + h->rects_offset);
    mesh->texels = (const uint32_t *)(const void *)(chunk + h->texels_offset);
    mesh->target_boxes = (const float *)(const void *)(chunk + h->target_boxes_offset);
    mesh->influences = (const uint32_t *)(const void *)(chunk + h->influences_offset);
    mesh->palettes = (const noh_palette *)(const void *)(chunk + h->palettes_offset);
    mesh->palette_joints = (const uint16_t *)(const void *)(chunk + h->palette_joints_offset);
    mesh->joint_boxes = (const float *)(const void *)(chunk + h->joint_boxes_offset);
}

const void *noh_pack_chunk_of_mesh(const noh_pack *pack, noh_chunk_type type, uint32_t mesh)
{
    for (uint32_t i = 0; i < pack->runs[type].count; i++) {
        const uint32_t *words = noh_pack_chunk_at(pack, type, i);
        if (words[0] == mesh) return words;
    }
    return NULL;
}

noh_result noh_pack_mesh_at(const noh_pack *pack, uint32_t index, noh_mesh *mesh, noh_error *error)
{
    NOH_ASSERT(pack && mesh);
    if (index >= pack->runs[NOH_CHUNK_MESH].count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        pack->runs[NOH_CHUNK_MESH].count ? "mesh index is past the pack's last mesh"
                                                         : "pack holds no mesh",
                        index, pack->runs[NOH_CHUNK_MESH].count);
    }
    mesh->pack = pack;
    mesh->name = noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_MESH].first + index);
    mesh->transfer = noh_pack_chunk_of_mesh(pack, NOH_CHUNK_TRANSFER, index);
    mesh->far_joints = noh_pack_chunk_of_mesh(pack, NOH_CHUNK_FAR_JOINTS, index);
    mesh->extras = noh_pack_chunk_of_mesh(pack, NOH_CHUNK_EXTRAS, index);
    view_of(noh_pack_chunk_at(pack, NOH_CHUNK_MESH, index), mesh);
    return NOH_OK;
}

noh_mesh noh_mesh_at_lod(const noh_mesh *mesh, uint32_t level)
{
    noh_mesh other = *mesh;
    const uint32_t first = mesh->header->level_first, last = mesh->header->level_count - 1u;
    NOH_ASSERT(mesh->header->level >= first && mesh->header->level <= last);
    level = level < first ? first : level < last ? level : last;
    view_of(chunk_of(mesh->header) + (level - first), &other);
    return other;
}

uint32_t noh_mesh_source(const noh_mesh *mesh)
{
    const noh_pack *pack = mesh->pack;
    const uint8_t *chunk = (const uint8_t *)chunk_of(mesh->header);
    if (mesh->header->level_first) {
        return mesh->header->source_crc;
    }
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        if (noh_pack_chunk_at(pack, NOH_CHUNK_MESH, i) == chunk) {
            return pack->chunks[pack->runs[NOH_CHUNK_MESH].first + i].crc;
        }
    }
    return 0;
}

noh_result noh_pack_skin_at(const noh_pack *pack, uint32_t index, noh_skin *skin, noh_error *error)
{
    const uint8_t *chunk;
    NOH_ASSERT(pack && skin);
    if (index >= pack->runs[NOH_CHUNK_SKIN].count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        index == NOH_NONE ? "a rigid mesh has no skin" : "skin index is past the pack's last skin",
                        index, pack->runs[NOH_CHUNK_SKIN].count);
    }
    chunk = noh_pack_chunk_at(pack, NOH_CHUNK_SKIN, index);
    skin->name = noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_SKIN].first + index);
    skin->header = (const noh_skin_header *)(const void *)chunk;
    skin->joints = (const uint16_t *)(const void *)(chunk + skin->header->joints_offset);
    skin->inverse_bind = (const float *)(const void *)(chunk + skin->header->inverse_bind_offset);
    return NOH_OK;
}

uint32_t noh_mesh_find_target(const noh_mesh *mesh, const char *name)
{
    const uint32_t hash = noh_hash_name(name);
    NOH_ASSERT(mesh && mesh->header);
    for (uint32_t i = 0; i < mesh->header->target_count; i++) {
        if (mesh->targets[i].name_hash == hash &&
            noh_names_equal(noh_pack_string(mesh->pack, mesh->targets[i].name), name)) {
            return i;
        }
    }
    return NOH_NONE;
}

int noh_mesh_tangent_offset(const noh_mesh *mesh)
{
    return (mesh->header->flags & NOH_MESH_TANGENTS) ? 4 : -1;
}

int noh_mesh_uv_offset(const noh_mesh *mesh)
{
    if (!(mesh->header->flags & NOH_MESH_UVS)) {
        return -1;
    }
    return (mesh->header->flags & NOH_MESH_TANGENTS) ? 8 : 4;
}

int noh_mesh_color_offset(const noh_mesh *mesh)
{
    return mesh->header->flags & NOH_MESH_COLORS ? (int)noh_mesh_extra_offset(mesh->header) - 4 : -1;
}

uint32_t noh_mesh_index(const noh_mesh *mesh, uint32_t i)
{
    NOH_ASSERT(i < mesh->header->index_count);
    return noh_mesh_index_of_all(mesh, i);
}

static uint32_t load_u32(const uint8_t *bytes)
{
    uint32_t value;
    memcpy(&value, bytes, 4);
    return value;
}

static uint32_t texel_word(const noh_mesh *mesh, uint32_t vertex)
{
    NOH_ASSERT(vertex < mesh->header->vertex_count);
    return (mesh->header->flags & NOH_MESH_TEXELS)
               ? load_u32(mesh->attributes + ((size_t)vertex + 1u) * mesh->header->attribute_stride - 4u)
               : vertex;
}

uint32_t noh_mesh_accumulation_texel(const noh_mesh *mesh, uint32_t vertex)
{
    return texel_word(mesh, vertex) & ((1u << NOH_TEXEL_VERTEX_BITS) - 1u);
}

uint32_t noh_mesh_palette(const noh_mesh *mesh, uint32_t vertex)
{
    return texel_word(mesh, vertex) >> NOH_TEXEL_VERTEX_BITS;
}

uint32_t noh_mesh_uv_texel(const noh_mesh *mesh, uint32_t vertex)
{
    NOH_ASSERT(vertex < mesh->header->vertex_count);
    return mesh->header->flags & NOH_MESH_UV_TARGETS
               ? load_u32(mesh->attributes + ((size_t)vertex + 1u) * mesh->header->attribute_stride - 8u)
               : NOH_TEXEL_NONE;
}

uint32_t noh_mesh_extra(const noh_mesh *mesh, uint32_t index, uint32_t vertex, float value[4])
{
    const noh_mesh_header *h = mesh->header;
    const noh_extra_row *row;
    const uint8_t *at;
    NOH_ASSERT(vertex < h->vertex_count && value);
    memset(value, 0, 4u * sizeof *value);
    if (!mesh->extras || index >= mesh->extras->count) return 0;
    row = (const noh_extra_row *)(const void *)((const uint8_t *)mesh->extras + mesh->extras->rows_offset) + index;
    at = mesh->attributes + (size_t)vertex * h->attribute_stride + noh_mesh_extra_offset(h);
    for (uint32_t c = 0; c < (uint32_t)row->component_count; c++) {
        const uint32_t bits = (uint32_t)row->bits, byte = ((uint32_t)row->first_bit + c * bits) / 8u;
        const uint32_t n = bits == 8u ? at[byte] : at[byte] | (uint32_t)at[byte + 1u] << 8;
        value[c] = row->offset[c] + row->step[c] * (float)n;
    }
    return (uint32_t)row->component_count;
}

/* The n-th stored weight (the first is n = 1), in units of 1 / NOH_WEIGHT_ONE: the second heaviest, at most a half, in
 * 22 bits, the others, at most a third, in 21. */
static uint32_t stored_weight(const uint32_t *words, uint32_t n)
{
    uint32_t bit = n == 1 ? 0 : 22u + 21u * (n - 2u), size = n == 1 ? 22u : 21u;
    uint64_t pair = words[bit / 32u];
    if (bit % 32u + size > 32u) {
        pair |= (uint64_t)words[bit / 32u + 1u] << 32;
    }
    return (uint32_t)(pair >> bit % 32u) & ((1u << size) - 1u);
}

/* The first joint's weight is not stored: it is what the others leave of 1. As integers of 2^-22 all weights, and their
 * sum, are exact in float32. */
uint32_t noh_mesh_influences(const noh_mesh *mesh, uint32_t vertex, uint32_t joints[NOH_INFLUENCES_MAX],
                             float weights[NOH_INFLUENCES_MAX])
{
    NOH_ASSERT(mesh->header->skin != NOH_NONE && vertex < mesh->header->vertex_count && joints && weights);
    uint32_t count = mesh->header->influence_count, rest = NOH_WEIGHT_ONE;
    const uint32_t *words = mesh->influences + (size_t)vertex * NOH_INFLUENCE_WORDS(count);
    const uint16_t *palette;
    palette = mesh->palette_joints + mesh->palettes[noh_mesh_palette(mesh, vertex)].first_joint;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t weight = i ? stored_weight(words + (count == 8u ? 2 : 1), i) : 0;
        joints[i] = palette[words[i / 4u] >> 8u * (i % 4u) & 255u];
        weights[i] = (float)weight / (float)NOH_WEIGHT_ONE;
        rest -= weight;
    }
    weights[0] = (float)rest / (float)NOH_WEIGHT_ONE;
    return count;
}

static int32_t low_half(uint32_t word)
{
    return (int32_t)(word << 16) >> 16;
}

static int32_t high_half(uint32_t word)
{
    return (int32_t)word >> 16;
}

/* Stored as square roots, close to how the eye tells shades apart: 8 bits then show no steps, and decoding is a
 * product. */
static void decode_color(const uint8_t *bytes, float color[4])
{
    for (int c = 0; c < 3; c++) {
        float root = (float)bytes[c] / 255.0f;
        color[c] = root * root;
    }
    color[3] = (float)bytes[3] / 255.0f;
}

void noh_mesh_directions(const noh_mesh *mesh, uint32_t index, float normal[3], float tangent[3])
{
    NOH_ASSERT(index < mesh->header->vertex_count && normal && tangent);
    const uint8_t *record = mesh->attributes + (size_t)index * mesh->header->attribute_stride;
    uint32_t word;
    word = load_u32(record);
    noh_octahedral_unfold((float)low_half(word) * (1.0f / 32767.0f), (float)high_half(word) * (1.0f / 32767.0f),
                          normal);
    memset(tangent, 0, 3 * sizeof *tangent);
    if (noh_mesh_tangent_offset(mesh) >= 0) {
        word = load_u32(record + noh_mesh_tangent_offset(mesh));
        noh_octahedral_unfold((float)low_half(word) * (1.0f / 32767.0f),
                              (float)(high_half(word) >> 1) * (1.0f / 16383.0f), tangent);
    }
}

void noh_mesh_vertex(const noh_mesh *mesh, uint32_t index, noh_vertex *out)
{
    static const float up[3] = { 0.0f, 0.0f, 1.0f };
    const noh_mesh_header *h = mesh->header;
    const uint8_t *record = mesh->attributes + (size_t)index * h->attribute_stride;
    const int tangent = noh_mesh_tangent_offset(mesh), uv = noh_mesh_uv_offset(mesh),
              color = noh_mesh_color_offset(mesh);
    NOH_ASSERT(index < h->vertex_count && out);
    memset(out, 0, sizeof *out);
    memcpy(out->position, mesh->positions + 3u * (size_t)index, sizeof out->position);
    noh_mesh_directions(mesh, index, out->normal, out->tangent);
    noh_normalize3(out->normal, up);
    for (unsigned i = 0; i < 4; i++) {
        out->color[i] = 1.0f;
    }
    if (tangent >= 0) {
        uint32_t word = load_u32(record + tangent);
        noh_normalize3(out->tangent, up);
        out->tangent[3] = (word & 0x10000u) ? -1.0f : 1.0f;
    }
    if (uv >= 0) {
        uint32_t word = load_u32(record + uv);
        out->uv[0] = h->uv_offset[0] + h->uv_scale[0] * ((float)(word & 0xffffu) / 65535.0f);
        out->uv[1] = h->uv_offset[1] + h->uv_scale[1] * ((float)(word >> 16) / 65535.0f);
    }
    if (color >= 0) {
        decode_color(record + color, out->color);
    }
}

/* ---- materials ---- */

const noh_material *noh_mesh_material(const noh_mesh *mesh, const noh_submesh *submesh)
{
    static const noh_material plain = { .base_color_texture = NOH_NONE,
                                        .base_color = { 1.0f, 1.0f, 1.0f, 1.0f },
                                        .metallic = 1.0f,
                                        .roughness = 1.0f,
                                        .alpha_cutoff = 0.5f,
                                        .normal_scale = 1.0f,
                                        .occlusion_strength = 1.0f,
                                        .f0 = { 0.04f, 0.04f, 0.04f },
                                        .normal_texture = NOH_NONE,
                                        .surface_texture = NOH_NONE,
                                        .emissive_texture = NOH_NONE,
                                        .wrinkle_texture = NOH_NONE,
                                        .wrinkle_models = 0,
                                        .more_textures = { NOH_NONE, NOH_NONE, NOH_NONE } };
    return submesh->material == NOH_NONE ? &plain : &mesh->pack->materials[submesh->material];
}

int noh_mesh_next_priority(const noh_mesh *mesh, int above)
{
    int lowest = NOH_PRIORITY_NONE;
    NOH_ASSERT(mesh && mesh->header);
    for (uint32_t i = 0; i < mesh->header->submesh_count; i++) {
        const noh_material *m = noh_mesh_material(mesh, &mesh->submeshes[i]);
        if ((m->flags & NOH_MATERIAL_BLEND) && m->priority > above && m->priority < lowest) lowest = m->priority;
    }
    return lowest;
}
