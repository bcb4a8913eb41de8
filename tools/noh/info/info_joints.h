/* info_joints.h: the part of `noh info` about joint levels, springs, and the errors of fewer joints and lower rates. */
#ifndef NOH_NOH_INFO_INFO_JOINTS_H
#define NOH_NOH_INFO_INFO_JOINTS_H

#include "cli/json.h"
#include "noh/clip.h"
#include "noh/pack.h"

/* Print the end of a skeleton's line, and the lines below a clip's; or add members to the open object. */
void info_print_levels(const noh_pack *pack, uint32_t skeleton);
void info_json_levels(json *j, const noh_pack *pack, uint32_t skeleton);
/* The springs of a skeleton: lines, or a member of the open object. */
void info_print_springs(const noh_pack *pack, uint32_t skeleton);
void info_json_springs(json *j, const noh_pack *pack, uint32_t skeleton);
/* Joints as a tree, or with their parents' names (null: a root). */
void info_print_joints(const noh_pack *pack, uint32_t skeleton);
void info_json_joints(json *j, const noh_pack *pack, uint32_t skeleton);
/* Callback keys and sync markers with their times. */
void info_print_keys(const noh_pack *pack, const noh_pack_clip *clip);
void info_json_keys(json *j, const noh_pack *pack, const noh_pack_clip *clip);
void info_print_errors(const noh_pack *pack, const noh_pack_clip *clip);
void info_json_errors(json *j, const noh_pack *pack, const noh_pack_clip *clip);

#endif
