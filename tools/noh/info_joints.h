/* info_joints.h: what `noh info` says of levels of joints, and of what leaving out joints and updates costs. */
#ifndef NOH_TOOL_INFO_JOINTS_H
#define NOH_TOOL_INFO_JOINTS_H

#include "json.h"
#include "noh.h"

/* Behind a skeleton's line and below a clip's; members of the open object. */
void info_print_levels(const noh_pack *pack, uint32_t skeleton);
void info_json_levels(json *j, const noh_pack *pack, uint32_t skeleton);
void info_print_errors(const noh_pack *pack, const noh_pack_motion *motion);
void info_json_errors(json *j, const noh_pack *pack, const noh_pack_motion *motion);

#endif
