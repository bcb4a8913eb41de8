/* clip_bank_internal.h (private to bank/): the mapping from the floats of a clip to the bank's. */
#ifndef NOH_BANK_CLIP_BANK_INTERNAL_H
#define NOH_BANK_CLIP_BANK_INTERNAL_H

#include "noh/clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Test whether a clip moves the floats of a group. If not, they have their defaults. */
int noh_clip_bank_moves(const noh_clip_bank *bank, uint32_t index, uint32_t group);

/* Get the float group with the morph weights of a node, or of the first node that draws a mesh.
 * returns  NOH_NONE if that node has no targets or does not exist */
uint32_t noh_clip_bank_node_group(const noh_clip_bank *bank, uint32_t node);
uint32_t noh_clip_bank_mesh_group(const noh_clip_bank *bank, uint32_t mesh);

#ifdef __cplusplus
}
#endif

/* A run of a clip's floats, and its place among the bank's. */
typedef struct noh_bank_floats {
    uint16_t from, to, width;
} noh_bank_floats;

struct noh_bank_clip {
    const noh_bank_floats *floats; /* [float_runs] */
    uint32_t float_runs;
    uint16_t joint_count;
    uint16_t is_mapped; /* 1: its joints are of the map's source */
};

/* Whether two skeletons have equal parents and bind poses. */
int noh_bank_same_skeletons(const noh_skeleton *a, const noh_skeleton *b);
/* Test whether a map is complete and its target's joints are the skeleton's. */
int noh_bank_map_fits(const noh_clip_map *map, const noh_skeleton *skeleton);

/* The joints that a map needs in memory for one pose: its source's, and those that fewer joints are cut from. */
static inline uint32_t noh_bank_map_joints(const noh_clip_map *map)
{
    return map->source->joint_count + map->least;
}

/* ---- clips that come and go (clip_bank_reserve.c) ---- */

/* From now on the packs' clips are not read: all are absent. */
void noh_clip_bank_empty(noh_clip_bank *bank);
/* Time goes on for the reserve: what is not touched from now on was used earlier. */
void noh_clip_bank_tick(noh_clip_bank *bank);
/* A clip of the bank is in use, or is asked for. Clips past the bank's own are ignored. */
void noh_clip_bank_touch(noh_clip_bank *bank, uint32_t clip);
/* Get the bytes that clips touched since the last tick take in the reserve. *absent: how many of them are absent */
uint64_t noh_clip_bank_touched(const noh_clip_bank *bank, uint32_t *absent);
/* Copy the bytes of an absent clip into the reserve. Clips that were not touched since the last tick make room, the
 * least recently used first; of equal ones the first.
 * bytes   [byte_count] those that the bank was made with
 * errors  DATA byte_count is not the clip's; MEMORY what is in use leaves too little (where: bytes in use, need:
 *         bytes). Nothing has then changed */
noh_result noh_clip_bank_bring(noh_clip_bank *bank, uint32_t clip, const uint8_t *bytes, uint32_t byte_count,
                               noh_error *error);

/* Let bank->clips sample through the bank's cache; sampling then changes the cache. */
void noh_clip_bank_sample_cache(noh_clip_bank *bank);

#endif
