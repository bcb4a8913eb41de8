/* pack_clip.h: skeletons and compressed clips of a pack, as pointers into its bytes.
 *
 * Threads: a pack is read-only; any number of threads. */
#ifndef NOH_CLIP_PACK_CLIP_H
#define NOH_CLIP_PACK_CLIP_H

#include "motion/pose/skeleton.h"
#include "core/pack/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One clip. Pass its `bytes`, and the bind pose of header->skeleton, to noh_clip_init (clip_codec.h). */
typedef struct noh_pack_clip {
    const char *name;
    const noh_clip_header *header;
    const noh_clip_event *events;   /* [header->event_count], in time order */
    const noh_clip_marker *markers; /* [header->marker_count], in time order */
    const uint8_t *bytes;           /* [header->clip_bytes] */
    const float *joint_errors; /* [header->joint_error_count], for the LOD levels of header->skeleton, in its unit */
} noh_pack_clip;

/* Get a skeleton by index; header (NULL: not wanted) receives its hash and unit.
 * errors  NOT_FOUND index past skeleton_count (where: the index, need: the count) */
noh_result noh_pack_skeleton_at(const noh_pack *pack, uint32_t index, noh_skeleton *skeleton,
                                const noh_skeleton_header **header, noh_error *error);

/* Get the name of a joint; "" if there is no such skeleton or joint. */
const char *noh_pack_joint_name(const noh_pack *pack, uint32_t skeleton, uint32_t joint);

/* Get the LOD levels of a skeleton as joint counts: each level poses that many of the first joints.
 * shapes   the result [*level_count], descending; the first is the skeleton's joint_count
 * returns  NULL, and a level_count of 0, if index is not below skeleton_count */
const uint32_t *noh_pack_joint_levels(const noh_pack *pack, uint32_t skeleton, uint32_t *level_count);

/* Get a clip by index.
 * errors  NOT_FOUND index past clip_count (where: the index, need: the count) */
noh_result noh_pack_clip_at(const noh_pack *pack, uint32_t index, noh_pack_clip *clip, noh_error *error);

/* Find the skeleton in `pack` that a clip of another pack was built for, by hash, and its index (NULL: not wanted).
 * errors  NOT_FOUND no skeleton in `pack` has the same joints: names and parents (where: the hash) */
noh_result noh_pack_bind_clip(const noh_pack *pack, const noh_pack_clip *clip, noh_skeleton *skeleton, uint32_t *index,
                              noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
