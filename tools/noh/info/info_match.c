#include "info_match.h"

#include <stdio.h>

#include "motion/match/match_internal.h"
#include "noh/clip.h"

void info_print_match(const noh_pack *pack)
{
    const uint32_t chunk = pack->runs[NOH_CHUNK_MATCH].first;
    noh_match_table t;
    double seconds;
    if (!noh_match_table_of(pack, &t)) return;
    seconds = (double)t.header->row_count * t.header->row_ticks / NOH_TICKS_PER_SECOND;
    printf("motion matching: %u rows of %u clips, %.1f s, %.0f bytes a second; ", t.header->row_count,
           t.header->clip_count, seconds, pack->chunks[chunk].bytes / seconds);
    printf(t.header->tag_count ? "tags" : "no tags");
    for (uint32_t i = 0; i < t.header->tag_count; i++) printf(" '%s'", noh_pack_string(pack, t.tags[i].name));
    printf("\n");
}
