#include "core/base/assert.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <stddef.h>
#include <string.h>

#include "core/pack/check_internal.h"

/* Chunks come in this order, so that no chunk refers to a later one. */
static int chunk_rank(uint32_t type)
{
    switch (type) {
    case NOH_CHUNK_STRINGS: return 0;
    case NOH_CHUNK_TEXTURE: return 1;
    case NOH_CHUNK_MATERIALS: return 2;
    case NOH_CHUNK_SKELETON: return 3;
    case NOH_CHUNK_SKIN: return 4;
    case NOH_CHUNK_MESH: return 5;
    case NOH_CHUNK_TRANSFER: return 6;
    case NOH_CHUNK_INFLUENCES: return 7;
    case NOH_CHUNK_WRINKLES: return 8;
    case NOH_CHUNK_NODES: return 9;
    case NOH_CHUNK_CLIP: return 10;
    case NOH_CHUNK_GRAPH: return 11;
    case NOH_CHUNK_RECIPE: return 12;
    case NOH_CHUNK_RAGDOLL: return 13;
    case NOH_CHUNK_SPRINGS: return 14;
    case NOH_CHUNK_HAIR: return 15;
    case NOH_CHUNK_TERRAIN: return 16;
    default: return -1;
    }
}

static noh_result check_header(const uint8_t *bytes, size_t byte_count, noh_error *error)
{
    noh_pack_header h;
    if ((uintptr_t)bytes % NOH_MEMORY_ALIGN != 0) {
        return noh_fail(error, NOH_ERR_ARG, "pack is not aligned to NOH_MEMORY_ALIGN in memory", 0, NOH_MEMORY_ALIGN);
    }
    if (byte_count < sizeof h) {
        return noh_fail(error, NOH_ERR_DATA, "file is shorter than a pack header", byte_count, sizeof h);
    }
    memcpy(&h, bytes, sizeof h);
    if (h.magic != NOH_PACK_MAGIC) {
        return noh_fail(error, NOH_ERR_DATA, "not a .noh pack (the first four bytes are not NOHP)", 0, 0);
    }
    if (h.version != NOH_PACK_VERSION) {
        return noh_fail(error, NOH_ERR_VERSION, "pack has another format version: build it again with this noh",
                        offsetof(noh_pack_header, version), NOH_PACK_VERSION);
    }
    if (h.byte_count != byte_count) {
        return noh_fail(error, NOH_ERR_DATA,
                        "file length differs from what its header says: it is cut or has extra bytes",
                        offsetof(noh_pack_header, byte_count), h.byte_count);
    }
    if (byte_count > NOH_PACK_BYTES_MAX || h.chunk_count == 0 || h.chunk_count > NOH_PACK_CHUNKS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "pack has no chunks, or more bytes or chunks than the limit",
                        offsetof(noh_pack_header, chunk_count), h.chunk_count);
    }
    if (sizeof h + (uint64_t)h.chunk_count * sizeof(noh_pack_chunk) > byte_count) {
        return noh_fail(error, NOH_ERR_DATA, "chunk table reaches past the end of the file",
                        offsetof(noh_pack_header, chunk_count), 0);
    }
    return NOH_OK;
}

/* The checksum covers the header, with its own field as 0, and the chunk table; the table holds the checksums of the
 * chunks. So no bit of the file is outside a checksum but padding, which must be zero. */
static noh_result check_table_crc(const uint8_t *bytes, noh_error *error)
{
    noh_pack_header h;
    uint32_t crc, stored;
    memcpy(&h, bytes, sizeof h);
    stored = h.crc;
    h.crc = 0;
    crc = noh_crc32c(0, &h, sizeof h);
    crc = noh_crc32c(crc, bytes + sizeof h, (size_t)h.chunk_count * sizeof(noh_pack_chunk));
    if (crc != stored) {
        return noh_fail(error, NOH_ERR_DATA, "header or chunk table is damaged (its checksum differs)",
                        offsetof(noh_pack_header, crc), 0);
    }
    for (unsigned i = 0; i < sizeof h.reserved / sizeof h.reserved[0]; i++) {
        if (h.reserved[i]) {
            return noh_fail(error, NOH_ERR_DATA, "reserved header field is not zero",
                            offsetof(noh_pack_header, reserved) + 4ull * i, 0);
        }
    }
    return NOH_OK;
}

/* A chunk begins at the next multiple of 64 after the one before it, with zero padding between: every byte of the file
 * then belongs to the header, the table, one chunk or padding, and all of them are checked. */
static noh_result check_place(const noh_pack *pack, uint32_t index, uint64_t *cursor, noh_error *error)
{
    const noh_pack_chunk *c = &pack->chunks[index];
    uint64_t start = (*cursor + NOH_PACK_ALIGN - 1) & ~(uint64_t)(NOH_PACK_ALIGN - 1);
    uint64_t table_at = sizeof(noh_pack_header) + (uint64_t)index * sizeof *c;
    if (c->offset != start) {
        return noh_fail(error, NOH_ERR_DATA, "chunk does not begin where the one before it ended",
                        table_at + offsetof(noh_pack_chunk, offset), start);
    }
    if (c->bytes > pack->byte_count || start + c->bytes > pack->byte_count) {
        return noh_fail(error, NOH_ERR_DATA, "chunk reaches past the end of the file",
                        table_at + offsetof(noh_pack_chunk, bytes), start + c->bytes);
    }
    for (uint64_t i = *cursor; i < start; i++) {
        if (pack->bytes[i]) {
            return noh_fail(error, NOH_ERR_DATA, "padding between chunks is not zero", i, 0);
        }
    }
    *cursor = start + c->bytes;
    if (noh_crc32c(0, pack->bytes + start, c->bytes) != c->crc) {
        return noh_fail(error, NOH_ERR_DATA, "chunk is damaged (its checksum differs)", start, 0);
    }
    return NOH_OK;
}

/* The chunk begins and ends with a zero, and no string is too long: so every offset below its size is a string that
 * ends in the chunk, and offset 0 is the empty one. */
static noh_result open_strings(noh_pack *pack, const noh_pack_chunk *c, noh_error *error)
{
    const char *strings = (const char *)pack->bytes + c->offset;
    uint32_t length = 0;
    if (!c->bytes || strings[0] || strings[c->bytes - 1]) {
        return noh_fail(error, NOH_ERR_DATA, "string chunk does not begin and end with a zero", c->offset, 0);
    }
    for (uint32_t i = 0; i < c->bytes; i++) {
        length = strings[i] ? length + 1 : 0;
        if (length >= NOH_NAME_BYTES_MAX) {
            return noh_fail(error, NOH_ERR_LIMIT, "name is longer than the limit", c->offset + i, NOH_NAME_BYTES_MAX);
        }
    }
    pack->strings = strings;
    pack->string_bytes = c->bytes;
    return NOH_OK;
}

/* Chunks of a type are neighbours, so a count and the first one's index find them all. */
static void count_chunk(uint32_t *count, uint32_t *first, uint32_t index)
{
    if (*count == 0) {
        *first = index;
    }
    *count += 1;
}

static noh_result open_chunk(noh_pack *pack, uint32_t index, noh_error *error)
{
    const noh_pack_chunk *c = &pack->chunks[index];
    noh_check check = { pack, pack->bytes + c->offset, c->bytes, c->offset, 0, error };
    noh_result result = NOH_OK;
    switch (c->type) {
    case NOH_CHUNK_STRINGS: result = open_strings(pack, c, error); break;
    case NOH_CHUNK_TEXTURE:
        result = noh_check_texture(&check);
        count_chunk(&pack->texture_count, &pack->first_texture, index);
        break;
    case NOH_CHUNK_MATERIALS:
        result = noh_check_materials(&check);
        pack->materials = (const noh_material *)(const void *)check.bytes;
        pack->material_count = c->bytes / (uint32_t)sizeof(noh_material);
        break;
    case NOH_CHUNK_MESH:
        result = noh_check_mesh(&check);
        count_chunk(&pack->mesh_count, &pack->first_mesh, index);
        break;
    case NOH_CHUNK_TRANSFER:
        result = noh_check_transfer(&check);
        count_chunk(&pack->transfer_count, &pack->first_transfer, index);
        break;
    case NOH_CHUNK_INFLUENCES:
        result = noh_check_influences(&check);
        count_chunk(&pack->influences_count, &pack->first_influences, index);
        break;
    case NOH_CHUNK_WRINKLES:
        result = noh_check_wrinkles(&check);
        count_chunk(&pack->wrinkles_count, &pack->first_wrinkles, index);
        break;
    case NOH_CHUNK_NODES:
        result = noh_check_nodes(&check);
        if (!result) {
            const noh_nodes_header *h = (const noh_nodes_header *)(const void *)check.bytes;
            pack->node_count = h->node_count;
            pack->nodes = (const noh_node *)(const void *)(check.bytes + h->nodes_offset);
            pack->node_weight_count = h->weight_count;
            pack->node_weights = (const float *)(const void *)(check.bytes + h->weights_offset);
        }
        break;
    case NOH_CHUNK_SKELETON:
        result = noh_check_skeleton(&check);
        count_chunk(&pack->skeleton_count, &pack->first_skeleton, index);
        break;
    case NOH_CHUNK_SKIN:
        result = noh_check_skin(&check);
        count_chunk(&pack->skin_count, &pack->first_skin, index);
        break;
    case NOH_CHUNK_CLIP:
        result = noh_check_clip(&check);
        count_chunk(&pack->clip_count, &pack->first_clip, index);
        break;
    case NOH_CHUNK_RECIPE:
        result = noh_check_recipe(&check);
        if (!result) {
            const noh_recipe_header *h = (const noh_recipe_header *)(const void *)check.bytes;
            pack->recipe_row_count = h->row_count;
            pack->recipe_rows = (const noh_recipe_row *)(const void *)(check.bytes + h->rows_offset);
        }
        break;
    case NOH_CHUNK_RAGDOLL:
        result = noh_check_ragdoll(&check);
        if (!result) {
            const noh_pack_ragdoll_header *h = (const noh_pack_ragdoll_header *)(const void *)check.bytes;
            pack->ragdoll_row_count = h->row_count;
            pack->ragdoll_rows = (const noh_pack_ragdoll_row *)(const void *)(check.bytes + h->rows_offset);
        }
        break;
    case NOH_CHUNK_SPRINGS:
        result = noh_check_springs(&check);
        count_chunk(&pack->springs_count, &pack->first_springs, index);
        break;
    case NOH_CHUNK_HAIR:
        result = noh_check_hair(&check);
        pack->hair = (const noh_pack_hair_header *)(const void *)check.bytes;
        break;
    case NOH_CHUNK_TERRAIN:
        result = noh_check_terrain(&check);
        pack->terrain = (const noh_pack_terrain_header *)(const void *)check.bytes;
        break;
    default: /* a graph, which noh_pack_check_graph checks when it is opened */
        count_chunk(&pack->graph_count, &pack->first_graph, index);
        break;
    }
    check.file_offset = (uint32_t)((const uint8_t *)c - pack->bytes); /* the name is in the chunk table */
    return result ? result : noh_check_name(&check, c->name, c->name_hash, offsetof(noh_pack_chunk, name));
}

static noh_result check_chunk_reserved(const noh_pack_chunk *c, uint64_t table_at, noh_error *error)
{
    for (unsigned i = 0; i < 2; i++) {
        if (c->reserved[i]) {
            return noh_fail(error, NOH_ERR_DATA, "reserved field of a chunk is not zero",
                            table_at + offsetof(noh_pack_chunk, reserved) + 4ull * i, 0);
        }
    }
    return NOH_OK;
}

/* Every chunk in turn: its type and rank, its place, its checksum, its content. */
static noh_result open_chunks(noh_pack *pack, noh_error *error)
{
    uint64_t cursor = sizeof(noh_pack_header) + (uint64_t)pack->chunk_count * sizeof(noh_pack_chunk);
    int last_rank = -1;
    for (uint32_t i = 0; i < pack->chunk_count; i++) {
        uint64_t table_at = sizeof(noh_pack_header) + (uint64_t)i * sizeof(noh_pack_chunk);
        uint32_t type = pack->chunks[i].type;
        int rank = chunk_rank(type);
        int single = type == NOH_CHUNK_STRINGS || type == NOH_CHUNK_MATERIALS || type == NOH_CHUNK_NODES ||
                     type == NOH_CHUNK_RECIPE || type == NOH_CHUNK_RAGDOLL || type == NOH_CHUNK_HAIR ||
                     type == NOH_CHUNK_TERRAIN;
        noh_result result;
        if (rank < 0 || rank < last_rank || (single && rank == last_rank) || (i == 0) != (rank == 0)) {
            return noh_fail(error, NOH_ERR_DATA, "chunk of an unknown type, or out of order", table_at, 0);
        }
        last_rank = rank;
        result = check_chunk_reserved(&pack->chunks[i], table_at, error);
        if (!result) {
            result = check_place(pack, i, &cursor, error);
        }
        if (!result) {
            result = open_chunk(pack, i, error);
        }
        if (result) {
            return result;
        }
    }
    if (((cursor + NOH_PACK_ALIGN - 1) & ~(uint64_t)(NOH_PACK_ALIGN - 1)) != pack->byte_count) {
        return noh_fail(error, NOH_ERR_DATA, "file does not end with its last chunk", cursor, 0);
    }
    return NOH_OK;
}

/* The zeros between the last chunk and the file's end. */
static noh_result check_tail(const noh_pack *pack, noh_error *error)
{
    const noh_pack_chunk *last = &pack->chunks[pack->chunk_count - 1];
    for (uint32_t i = last->offset + last->bytes; i < pack->byte_count; i++) {
        if (pack->bytes[i]) {
            return noh_fail(error, NOH_ERR_DATA, "padding at the end is not zero", i, 0);
        }
    }
    return NOH_OK;
}

/* Checks come in an order in which each may rely on those before it: the counts of the header, the checksum of header
 * and table, then chunk by chunk its place, its checksum and its content, and the padding at the end. The pack is built
 * in a copy, which the caller gets only when everything has passed. */
noh_result noh_pack_open(const void *bytes, size_t byte_count, noh_pack *pack, noh_error *error)
{
    noh_pack p;
    noh_result result;
    if (!bytes || !pack) {
        return noh_fail(error, NOH_ERR_ARG, "bytes or pack is NULL", 0, 0);
    }
    result = check_header((const uint8_t *)bytes, byte_count, error);
    if (!result) result = check_table_crc((const uint8_t *)bytes, error);
    if (result) {
        return result;
    }
    memset(&p, 0, sizeof p);
    p.bytes = (const uint8_t *)bytes;
    p.byte_count = (uint32_t)byte_count;
    p.chunk_count = ((const noh_pack_header *)bytes)->chunk_count;
    p.library_version = ((const noh_pack_header *)bytes)->library_version;
    p.chunks = (const noh_pack_chunk *)(const void *)(p.bytes + sizeof(noh_pack_header));
    result = open_chunks(&p, error);
    if (!result) result = check_tail(&p, error);
    if (!result) *pack = p;
    return result;
}

const char *noh_pack_string(const noh_pack *pack, uint32_t offset)
{
    NOH_ASSERT(pack);
    return offset < pack->string_bytes ? pack->strings + offset : "";
}

const char *noh_pack_chunk_name(const noh_pack *pack, uint32_t chunk)
{
    NOH_ASSERT(pack);
    return chunk < pack->chunk_count ? noh_pack_string(pack, pack->chunks[chunk].name) : "";
}

noh_result noh_pack_texture_at(const noh_pack *pack, uint32_t index, noh_texture *texture, noh_error *error)
{
    const uint8_t *chunk;
    NOH_ASSERT(pack && texture);
    if (index >= pack->texture_count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        pack->texture_count ? "texture index is past the pack's last texture" : "pack holds no texture",
                        index, pack->texture_count);
    }
    chunk = pack->bytes + pack->chunks[pack->first_texture + index].offset;
    texture->name = noh_pack_chunk_name(pack, pack->first_texture + index);
    texture->header = (const noh_texture_header *)(const void *)chunk;
    texture->pixels = chunk + texture->header->pixels_offset;
    return NOH_OK;
}

uint32_t noh_texture_block_bytes(uint32_t format)
{
    if (format == NOH_TEXTURE_RGBA8) return 0;
    return format == NOH_TEXTURE_ETC2_RGB || format == NOH_TEXTURE_ETC2_RGBA1 ? 8u : 16u;
}

uint32_t noh_texture_bytes(uint32_t format, uint32_t width, uint32_t height)
{
    const uint32_t block = noh_texture_block_bytes(format);
    return block ? ((width + 3u) / 4u) * ((height + 3u) / 4u) * block : width * height * 4u;
}

noh_texture_level noh_texture_level_at(const noh_texture *texture, uint32_t level)
{
    NOH_ASSERT(texture && level < texture->header->level_count);
    noh_texture_level at = { texture->header->width, texture->header->height, 0, texture->pixels };
    for (uint32_t i = 0; i < level; i++) {
        at.pixels += noh_texture_bytes(texture->header->format, at.width, at.height);
        at.width = at.width > 1u ? at.width / 2u : 1u;
        at.height = at.height > 1u ? at.height / 2u : 1u;
    }
    at.bytes = noh_texture_bytes(texture->header->format, at.width, at.height);
    return at;
}
