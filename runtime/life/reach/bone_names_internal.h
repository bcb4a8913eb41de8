/* bone_names_internal.h: which joints are a person's bones, by their names. The converter's reader of names
 * (tools/convert/base/names.h) takes its keys and its rows from here. Threads: no state; any thread. */
#ifndef NOH_REACH_BONE_NAMES_INTERNAL_H
#define NOH_REACH_BONE_NAMES_INTERNAL_H

#include <stddef.h>
#include <stdint.h>

#include "noh/base.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_BONE_NAMES 29

/* `keys`: keys of the names that a bone has, with blanks between them. */
typedef struct noh_bone_name {
    const char *vrm; /* as VRM spells it; '*': left or right */
    const char *keys;
} noh_bone_name;

/* In the order of noh_bone, from the hips; a bone of both sides has one row. */
extern const noh_bone_name noh_bone_names[NOH_BONE_NAMES];

/* Keys of what stands in front of names or behind them, with blanks between them. */
extern const char noh_bone_strips[];

/* Make the key of a name: its words in small letters, joined, without what stands before a ':' or '|', the number of a
 * copy (.001) and the first word that is a side. Returns the side, 'l' or 'r'; 0: none. */
char noh_name_key(const char *name, char key[NOH_NAME_BYTES_MAX]);

/* Cut `part` off the start of a key, or off its end. Returns 0, and changes nothing, if it is not there or is all. */
int noh_name_cut(char *key, const char *part, size_t part_bytes);

/* The bone of a joint with this name; NOH_BONES: none. */
uint32_t noh_bone_of(const char *name);

/* Hips are above both thighs, whatever joint has their name; the topmost joint above them is the root if none is yet. A
 * bone of a limb without a name of its own is what the next one hangs from.
 * shapes  parents[] of joints, NOH_JOINT_ROOT for those without one; bones[NOH_BONES] */
void noh_bones_find_trunk(const uint16_t *parents, uint16_t *bones);

#ifdef __cplusplus
}
#endif

#endif
