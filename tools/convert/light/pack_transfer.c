#include "pack_transfer.h"

#include <stdlib.h>
#include <string.h>

#include "convert/pack/pack_write.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

typedef struct copier {
    const noh_pack *pack;
    const transfer_settings *settings;
    light_rays rays;
    byte_buffer *out;
    noh_pack_chunk *chunks;
    uint32_t chunk_count;
    model_error *error;
} copier;

static void begin_chunk(copier *c, const noh_pack_chunk *like)
{
    buffer_align(c->out, NOH_PACK_ALIGN);
    c->chunks[c->chunk_count] = *like;
    c->chunks[c->chunk_count].offset = (uint32_t)c->out->count;
}

static void end_chunk(copier *c)
{
    noh_pack_chunk *chunk = &c->chunks[c->chunk_count++];
    chunk->bytes = (uint32_t)(c->out->count - chunk->offset);
    chunk->crc = c->out->failed ? 0 : noh_crc32c(0, c->out->bytes + chunk->offset, chunk->bytes);
}

static void copy_chunks(copier *c, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++) {
        begin_chunk(c, &c->pack->chunks[i]);
        buffer_append(c->out, c->pack->bytes + c->pack->chunks[i].offset, c->pack->chunks[i].bytes);
        end_chunk(c);
    }
}

static uint32_t append(copier *c, size_t base, const void *bytes, size_t count)
{
    const size_t at = (buffer_align(c->out, 16), c->out->count - base);
    buffer_append(c->out, bytes, count);
    return (uint32_t)at;
}

/* The chunk of one mesh, under the mesh's name. */
static int add_transfer(copier *c, uint32_t index)
{
    noh_pack_chunk like = c->pack->chunks[c->pack->runs[NOH_CHUNK_MESH].first + index];
    noh_transfer_header h;
    transfer_data data;
    noh_mesh mesh;
    size_t base;
    if (transfer_make(c->pack, index, &c->rays, c->settings, &data, c->error)) {
        transfer_data_free(&data);
        return 1;
    }
    (void)noh_pack_mesh_at(c->pack, index, &mesh, NULL);
    memset(&h, 0, sizeof h);
    h.mesh = index;
    h.order = c->settings->order;
    h.flags = c->settings->flags;
    h.bounce = c->settings->bounce;
    h.vertex_count = mesh.header->vertex_count;
    h.texel_count = mesh.header->texel_count;
    h.target_count = mesh.header->target_count;
    h.ray_count = c->rays.count;
    like.type = NOH_TAG_TRANSFER;
    begin_chunk(c, &like);
    base = c->out->count;
    buffer_append(c->out, NULL, sizeof h);
    h.records_offset = append(c, base, data.records,
                              (size_t)h.vertex_count * NOH_TRANSFER_RECORD_BYTES(h.order, h.flags));
    h.scales_offset = append(c, base, data.scales, 4u * (size_t)h.target_count);
    h.deltas_offset = append(c, base, data.deltas, h.texel_count);
    if (!c->out->failed) {
        memcpy(c->out->bytes + base, &h, sizeof h);
    }
    end_chunk(c);
    transfer_data_free(&data);
    return 0;
}

/* Header and table, now that offsets and checksums are known. */
static void close_pack(copier *c)
{
    const size_t table = c->chunk_count * sizeof *c->chunks;
    noh_pack_header h;
    buffer_align(c->out, NOH_PACK_ALIGN);
    if (c->out->failed) {
        return;
    }
    memcpy(&h, c->pack->bytes, sizeof h);
    h.library_version = noh_version_number();
    h.byte_count = (uint32_t)c->out->count;
    h.chunk_count = c->chunk_count;
    h.crc = 0;
    h.crc = noh_crc32c(noh_crc32c(0, &h, sizeof h), c->chunks, table);
    memcpy(c->out->bytes, &h, sizeof h);
    memcpy(c->out->bytes + sizeof h, c->chunks, table);
}

static int copy(copier *c)
{
    const uint32_t after = c->pack->runs[NOH_CHUNK_MESH].first + c->pack->runs[NOH_CHUNK_MESH].count;
    int failed = 0;
    buffer_append(c->out, NULL,
                  sizeof(noh_pack_header) +
                      sizeof *c->chunks * (c->pack->chunk_count + c->pack->runs[NOH_CHUNK_MESH].count));
    copy_chunks(c, 0, after);
    for (uint32_t i = 0; i < c->pack->runs[NOH_CHUNK_MESH].count && !failed; i++) {
        failed = add_transfer(c, i);
    }
    copy_chunks(c, after, c->pack->chunk_count);
    if (!failed) {
        close_pack(c);
    }
    return failed;
}

int pack_transfer(const noh_pack *pack, const transfer_settings *settings, byte_buffer *out, model_error *error)
{
    const uint32_t count = pack->chunk_count + pack->runs[NOH_CHUNK_MESH].count;
    copier c;
    int failed, refused = 0;
    size_t bytes;
    if (count > NOH_PACK_CHUNKS_MAX) {
        return model_fail(error, "", "more than %u chunks with a transfer for each mesh: build several packs",
                          NOH_PACK_CHUNKS_MAX);
    }
    memset(&c, 0, sizeof c);
    c.pack = pack;
    c.settings = settings;
    c.out = out;
    c.error = error;
    c.chunks = model_zeros(count, sizeof *c.chunks);
    failed = !c.chunks || light_rays_make(TRANSFER_RAYS, &c.rays);
    if (!failed) {
        refused = copy(&c);
    }
    bytes = out->count;
    failed |= !refused && (out->failed || bytes > NOH_PACK_BYTES_MAX);
    light_rays_free(&c.rays);
    free(c.chunks);
    if (failed || refused) {
        buffer_free(out);
    }
    return failed ? pack_fail_size(bytes, error) : refused;
}
