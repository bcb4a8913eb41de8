/* info_transfer.h: the transfer of a mesh, as `noh info` shows it. */
#ifndef NOH_NOH_INFO_INFO_TRANSFER_H
#define NOH_NOH_INFO_INFO_TRANSFER_H

#include "cli/json.h"
#include "noh/pack.h"

/* A line; nothing where there is none. */
void info_print_transfer(const noh_mesh *mesh);
/* "transfer": an object, or null. */
void info_json_transfer(json *j, const noh_mesh *mesh);

#endif
