/* pack_copy.c: header and table are left free, and filled when the chunks are there. */
#include "pack_copy.h"

#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

void pack_copy_as_is(const noh_pack *pack, uint32_t index, byte_buffer *out)
{
    buffer_append(out, pack->bytes + pack->chunks[index].offset, pack->chunks[index].bytes);
}

static void write_table(const noh_pack *pack, const noh_pack_chunk *chunks, byte_buffer *out)
{
    const size_t table = pack->chunk_count * sizeof *chunks;
    noh_pack_header h;
    memcpy(&h, pack->bytes, sizeof h);
    h.library_version = noh_version_number();
    h.byte_count = (uint32_t)out->count;
    h.crc = 0;
    h.crc = noh_crc32c(noh_crc32c(0, &h, sizeof h), chunks, table);
    memcpy(out->bytes, &h, sizeof h);
    memcpy(out->bytes + sizeof h, chunks, table);
}

int pack_copy(const noh_pack *pack, pack_copy_chunk *chunk, void *context, byte_buffer *out, model_error *error)
{
    const size_t table = pack->chunk_count * sizeof(noh_pack_chunk);
    noh_pack_chunk *chunks = malloc(table);
    buffer_append(out, NULL, sizeof(noh_pack_header) + table);
    for (uint32_t i = 0; chunks && i < pack->chunk_count; i++) {
        size_t base;
        buffer_align(out, NOH_PACK_ALIGN);
        base = out->count;
        chunk(context, i, out);
        chunks[i] = pack->chunks[i];
        chunks[i].offset = (uint32_t)base;
        chunks[i].bytes = (uint32_t)(out->count - base);
        chunks[i].crc = out->failed ? 0 : noh_crc32c(0, out->bytes + base, chunks[i].bytes);
    }
    buffer_align(out, NOH_PACK_ALIGN);
    if (!chunks || out->failed) {
        free(chunks);
        buffer_free(out);
        return model_fail_memory(error);
    }
    write_table(pack, chunks, out);
    free(chunks);
    return 0;
}
