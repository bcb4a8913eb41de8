/* stage_warn.h: warnings of what a finished pack has more of than a stage takes. Such a pack opens, and a game may draw
 * a part of it, so it is no error. */
#ifndef NOH_CONVERT_PACK_STAGE_WARN_H
#define NOH_CONVERT_PACK_STAGE_WARN_H

#include <stdio.h>

#include "noh/pack.h"

/* Returns 1: out of memory. */
int stage_warn(const noh_pack *pack, FILE *out);

#endif
