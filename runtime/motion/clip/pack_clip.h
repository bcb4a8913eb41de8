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

/* One clip. noh_clip_init (clip_codec.h) takes its `bytes`, and the bind pose of header->skeleton. */
typedef struct noh_pack_clip {
    const char *name;
    const noh_clip_header *header;
    const noh_clip_event *events;   /* [header->event_count], in time order */
    const noh_clip_marker *markers; /* [header->marker_count], in time order */
    const uint8_t *bytes;           /* [header->clip_bytes] */
    const float *joint_errors; /* [header->joint_error_count], for the LOD levels of header->skeleton, in its unit */
} noh_pack_clip;

/* The n-th skeleton; header (NULL: not wanted) receives its hash and unit.
 * errors  NOT_FOUND  past skeleton_count (where: the index, need: the count) */
noh_result noh_pack_skeleton_at(const noh_pack *pack, uint32_t index, noh_skeleton *skeleton,
                                const noh_skeleton_header **header, noh_error *error);

/* The name of a joint; "" where there is no such skeleton or joint. */
const char *noh_pack_joint_name(const noh_pack *pack, uint32_t skeleton, uint32_t joint);

/* The LOD levels of a skeleton, as counts: each poses that many joints, the first ones.
 * shapes   the result [*level_count], falling; the first is the skeleton's joint_count
 * returns  NULL, and a level_count of 0, where index is not below skeleton_count */
const uint32_t *noh_pack_joint_levels(const noh_pack *pack, uint32_t skeleton, uint32_t *level_count);

/* The n-th clip.
 * errors  NOT_FOUND  past clip_count (where: the index, need: the count) */
noh_result noh_pack_clip_at(const noh_pack *pack, uint32_t index, noh_pack_clip *clip, noh_error *error);

/* The skeleton in `pack` that a clip of another pack was built for, by hash, and its index (NULL: not wanted).
 * errors  NOT_FOUND no skeleton there has the same joints: names and parents (where: the hash) */
noh_result noh_pack_bind_clip(const noh_pack *pack, const noh_pack_clip *clip, noh_skeleton *skeleton, uint32_t *index,
                              noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
