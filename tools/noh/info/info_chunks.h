/* info_chunks.h: how many chunks of each type a pack has, and their bytes: what noh info says of every type in the list
 * NOH_CHUNKS, without a line of its own for it. */
#ifndef NOH_NOH_INFO_INFO_CHUNKS_H
#define NOH_NOH_INFO_INFO_CHUNKS_H

#include "cli/json.h"
#include "noh/pack.h"

void info_print_chunks(const noh_pack *pack);
void info_json_chunks(json *j, const noh_pack *pack);

#endif
