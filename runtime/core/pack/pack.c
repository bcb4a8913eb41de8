#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <stddef.h>
#include <string.h>

#include "core/base/compiler_internal.h"
#include "core/pack/check_internal.h"
#include "core/pack/pack_internal.h"

#define CHUNK_TAG(NAME, name, tag, many) NOH_TAG_##NAME,
#define CHUNK_MANY(NAME, name, tag, many) many,
#define CHUNK_CHECK(NAME, name, tag, many) \
    case NOH_CHUNK_##NAME: return noh_check_##name(check);

/* NOH_CHUNK_TYPES for an unknown tag. */
static uint32_t type_of(uint32_t tag)
{
    static const uint32_t tags[NOH_CHUNK_TYPES] = { NOH_CHUNKS(CHUNK_TAG) };
    uint32_t type = 0;
    while (type < NOH_CHUNK_TYPES && tags[type] != tag) type++;
    return type;
}

static int is_single(uint32_t type)
{
    static const uint8_t many[NOH_CHUNK_TYPES] = { NOH_CHUNKS(CHUNK_MANY) };
    return !many[type];
}

/* A switch, since a table of functions is data that the linker must be able to write. */
static noh_result check_content(noh_check *check, uint32_t type)
{
    switch (type) {
        NOH_CHUNKS(CHUNK_CHECK)
    default: return noh_check_fail(check, "chunk of an unknown type", 0);
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
        return noh_fail(error, NOH_ERR_DATA, "chunk does not begin at the end of the previous chunk",
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

static noh_result open_chunk(noh_pack *pack, uint32_t index, uint32_t type, noh_error *error)
{
    const noh_pack_chunk *c = &pack->chunks[index];
    noh_check check = { pack, pack->bytes + c->offset, c->bytes, c->offset, 0, error, pack };
    const noh_result result = check_content(&check, type);
    if (!pack->runs[type].count++) pack->runs[type].first = index;
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

/* Every chunk in turn: its type and order, its place, its checksum, its content. */
static noh_result open_chunks(noh_pack *pack, noh_error *error)
{
    uint64_t cursor = sizeof(noh_pack_header) + (uint64_t)pack->chunk_count * sizeof(noh_pack_chunk);
    uint32_t last = 0;
    for (uint32_t i = 0; i < pack->chunk_count; i++) {
        const uint64_t table_at = sizeof(noh_pack_header) + (uint64_t)i * sizeof(noh_pack_chunk);
        const uint32_t type = type_of(pack->chunks[i].type);
        noh_result result;
        if (type == NOH_CHUNK_TYPES || type < last || (i && is_single(type) && type == last) ||
            (i == 0) != (type == NOH_CHUNK_STRINGS)) {
            return noh_fail(error, NOH_ERR_DATA, "chunk of an unknown type, or out of order", table_at, 0);
        }
        last = type;
        result = check_chunk_reserved(&pack->chunks[i], table_at, error);
        if (!result) {
            result = check_place(pack, i, &cursor, error);
        }
        if (!result) {
            result = open_chunk(pack, i, type, error);
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
NOH_COLD noh_result noh_pack_open(const void *bytes, size_t byte_count, noh_pack *pack, noh_error *error)
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

const void *noh_pack_chunk_at(const noh_pack *pack, noh_chunk_type type, uint32_t index)
{
    NOH_ASSERT(pack && (uint32_t)type < NOH_CHUNK_TYPES);
    const noh_chunk_run *run = &pack->runs[type];
    return index < run->count ? pack->bytes + pack->chunks[run->first + index].offset : NULL;
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
    if (index >= pack->runs[NOH_CHUNK_TEXTURE].count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        pack->runs[NOH_CHUNK_TEXTURE].count ? "texture index is past the pack's last texture"
                                                            : "pack holds no texture",
                        index, pack->runs[NOH_CHUNK_TEXTURE].count);
    }
    chunk = noh_pack_chunk_at(pack, NOH_CHUNK_TEXTURE, index);
    texture->name = noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_TEXTURE].first + index);
    texture->header = (const noh_texture_header *)(const void *)chunk;
    texture->pixels = chunk + texture->header->pixels_offset;
    return NOH_OK;
}

uint32_t noh_texture_block_bytes(uint32_t format)
{
    if (format == NOH_TEXTURE_RGBA8) return 0;
    return format == NOH_TEXTURE_ETC2_RGB || format == NOH_TEXTURE_ETC2_RGBA1 ? 8u : 16u;
}

uint32_t noh_texture_block_side(uint32_t format)
{
    static const uint8_t astc[] = { 4, 5, 6, 8 };
    return format < NOH_TEXTURE_ASTC_4X4 ? 4u : astc[format - NOH_TEXTURE_ASTC_4X4];
}

uint32_t noh_texture_bytes(uint32_t format, uint32_t width, uint32_t height)
{
    const uint32_t block = noh_texture_block_bytes(format), side = noh_texture_block_side(format);
    return block ? (width + side - 1u) / side * ((height + side - 1u) / side) * block : width * height * 4u;
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
