#include "mesh/mesh.h"

#include <string.h>

#include "base/hash.h"
#include "base/math.h"

noh_result noh_pack_mesh(const noh_pack *pack, uint32_t index, noh_mesh *mesh)
{
    const uint8_t *chunk;
    const noh_mesh_header *h;
    if (index >= pack->mesh_count) {
        return NOH_ERR_NOT_FOUND;
    }
    chunk = pack->bytes + pack->chunks[pack->first_mesh + index].offset;
    h = (const noh_mesh_header *)(const void *)chunk;
    mesh->pack = pack;
    mesh->name = noh_pack_chunk_name(pack, pack->first_mesh + index);
    mesh->header = h;
    mesh->positions = (const float *)(const void *)(chunk + h->positions_offset);
    mesh->attributes = chunk + h->attributes_offset;
    mesh->indices = chunk + h->indices_offset;
    mesh->submeshes = (const noh_submesh *)(const void *)(chunk + h->submeshes_offset);
    mesh->targets = (const noh_target *)(const void *)(chunk + h->targets_offset);
    mesh->weights = (const float *)(const void *)(chunk + h->weights_offset);
    mesh->rects = (const noh_rect *)(const void *)(chunk + h->rects_offset);
    mesh->texels = (const uint32_t *)(const void *)(chunk + h->texels_offset);
    return NOH_OK;
}

static int names_equal(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

uint32_t noh_mesh_find_target(const noh_mesh *mesh, const char *name)
{
    uint32_t hash = noh_hash_name(name);
    for (uint32_t i = 0; i < mesh->header->target_count; i++) {
        if (mesh->targets[i].name_hash == hash && names_equal(noh_pack_string(mesh->pack, mesh->targets[i].name), name)) {
            return i;
        }
    }
    return mesh->header->target_count;
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
    return (mesh->header->flags & NOH_MESH_COLORS) ? (int)mesh->header->attribute_stride - 4 : -1;
}

uint32_t noh_mesh_index(const noh_mesh *mesh, uint32_t i)
{
    return mesh->header->index_bytes == 2 ? ((const uint16_t *)mesh->indices)[i] : ((const uint32_t *)mesh->indices)[i];
}

static uint32_t load_u32(const uint8_t *bytes)
{
    uint32_t value;
    memcpy(&value, bytes, 4);
    return value;
}

/* Unfold an octahedral pair, x and y in -1..1, to a unit vector (Meyer et al. 2010). */
static void unfold(float x, float y, float out[3])
{
    static const float up[3] = { 0.0f, 0.0f, 1.0f };
    float z = 1.0f - (x < 0.0f ? -x : x) - (y < 0.0f ? -y : y);
    float fold = z < 0.0f ? -z : 0.0f;
    out[0] = x + (x >= 0.0f ? -fold : fold);
    out[1] = y + (y >= 0.0f ? -fold : fold);
    out[2] = z;
    noh_normalize3(out, up);
}

static int32_t low_half(uint32_t word)
{
    return (int32_t)(word << 16) >> 16;
}

static int32_t high_half(uint32_t word)
{
    return (int32_t)word >> 16;
}

static void decode_color(const uint8_t *bytes, float color[4])
{
    for (int c = 0; c < 3; c++) {
        float root = (float)bytes[c] / 255.0f;
        color[c] = root * root;
    }
    color[3] = (float)bytes[3] / 255.0f;
}

void noh_mesh_vertex(const noh_mesh *mesh, uint32_t index, noh_vertex *out)
{
    const noh_mesh_header *h = mesh->header;
    const uint8_t *record = mesh->attributes + (size_t)index * h->attribute_stride;
    int tangent = noh_mesh_tangent_offset(mesh), uv = noh_mesh_uv_offset(mesh), color = noh_mesh_color_offset(mesh);
    memset(out, 0, sizeof *out);
    memcpy(out->position, mesh->positions + 3u * (size_t)index, sizeof out->position);
    unfold((float)low_half(load_u32(record)) / 32767.0f, (float)high_half(load_u32(record)) / 32767.0f, out->normal);
    for (unsigned i = 0; i < 4; i++) {
        out->color[i] = 1.0f;
    }
    if (tangent >= 0) {
        uint32_t word = load_u32(record + tangent);
        unfold((float)low_half(word) / 32767.0f, (float)(high_half(word) >> 1) / 16383.0f, out->tangent);
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
