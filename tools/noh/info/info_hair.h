/* info_hair.h: `noh info` for a pack's haircut. */
#ifndef NOH_NOH_INFO_INFO_HAIR_H
#define NOH_NOH_INFO_INFO_HAIR_H

#include "cli/json.h"
#include "noh/pack.h"

/* Nothing where there is none. */
void info_print_hair(const noh_pack *pack);
/* "hair": null, or an object. */
void info_json_hair(json *j, const noh_pack *pack);

#endif
