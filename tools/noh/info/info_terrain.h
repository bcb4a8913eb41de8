/* info_terrain.h: `noh info` for a pack's terrain. */
#ifndef NOH_NOH_INFO_INFO_TERRAIN_H
#define NOH_NOH_INFO_INFO_TERRAIN_H

#include "cli/json.h"
#include "noh/pack.h"

void info_print_terrain(const noh_pack *pack);
void info_json_terrain(json *j, const noh_pack *pack);

#endif
