/* info_extras.h: the extra attributes of a mesh, as `noh info` shows them. */
#ifndef NOH_NOH_INFO_INFO_EXTRAS_H
#define NOH_NOH_INFO_INFO_EXTRAS_H

#include "cli/json.h"
#include "noh/pack.h"

/* A line each; nothing where there is none. */
void info_print_extras(const noh_mesh *mesh);
/* "extras": an array. */
void info_json_extras(json *j, const noh_mesh *mesh);

#endif
