#include "info_chunks.h"

#include <stdio.h>

#define LABEL(NAME, name, tag, many) #name,
static const char *const names[NOH_CHUNK_TYPES] = { NOH_CHUNKS(LABEL) };

static uint64_t run_bytes(const noh_pack *pack, const noh_chunk_run *run)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < run->count; i++) bytes += pack->chunks[run->first + i].bytes;
    return bytes;
}

void info_print_chunks(const noh_pack *pack)
{
    for (int type = 0; type < NOH_CHUNK_TYPES; type++) {
        const noh_chunk_run *run = &pack->runs[type];
        if (!run->count) continue;
        printf("%s%s %u, %llu bytes", type ? "; " : "chunks: ", names[type], run->count,
               (unsigned long long)run_bytes(pack, run));
    }
    printf("\n");
}

void info_json_chunks(json *j, const noh_pack *pack)
{
    json_open(j, "chunks", '{');
    for (int type = 0; type < NOH_CHUNK_TYPES; type++) {
        const noh_chunk_run *run = &pack->runs[type];
        if (!run->count) continue;
        json_open(j, names[type], '{');
        json_integer(j, "count", run->count);
        json_integer(j, "bytes", run_bytes(pack, run));
        json_close(j, '}');
    }
    json_close(j, '}');
}
