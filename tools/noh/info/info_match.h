/* info_match.h: `noh info` for a pack's table of motion matching. */
#ifndef NOH_NOH_INFO_INFO_MATCH_H
#define NOH_NOH_INFO_INFO_MATCH_H

#include "noh/pack.h"

void info_print_match(const noh_pack *pack);

#endif
