#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#include <string.h>

NOH_STATIC_ASSERT(sizeof(noh_transform) == 40, transform_is_packed);
NOH_STATIC_ASSERT(NOH_PACK_JOINT_ROOT == NOH_JOINT_ROOT, joint_roots_agree);

noh_result noh_pack_skeleton_at(const noh_pack *pack, uint32_t index, noh_skeleton *skeleton,
                                const noh_skeleton_header **header, noh_error *error)
{
    const uint8_t *chunk;
    const noh_skeleton_header *h;
    NOH_ASSERT(pack && skeleton);
    if (index >= pack->runs[NOH_CHUNK_SKELETON].count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        pack->runs[NOH_CHUNK_SKELETON].count ? "index is past the pack's last skeleton"
                                                             : "the pack has no skeleton",
                        index, pack->runs[NOH_CHUNK_SKELETON].count);
    }
    chunk = noh_pack_chunk_at(pack, NOH_CHUNK_SKELETON, index);
    h = (const noh_skeleton_header *)(const void *)chunk;
    memset(skeleton, 0, sizeof *skeleton);
    skeleton->joint_count = h->joint_count;
    skeleton->parents = (const uint16_t *)(const void *)(chunk + h->parents_offset);
    skeleton->bind_pose = (const noh_transform *)(const void *)(chunk + h->bind_offset);
    if (header) {
        *header = h;
    }
    return NOH_OK;
}

const char *noh_pack_joint_name(const noh_pack *pack, uint32_t skeleton, uint32_t joint)
{
    noh_skeleton s;
    const noh_skeleton_header *h = NULL;
    if (noh_pack_skeleton_at(pack, skeleton, &s, &h, NULL) || !h || joint >= h->joint_count) {
        return "";
    }
    return noh_pack_string(pack, ((const uint32_t *)(const void *)((const uint8_t *)h + h->names_offset))[joint]);
}

const uint32_t *noh_pack_joint_levels(const noh_pack *pack, uint32_t skeleton, uint32_t *level_count)
{
    noh_skeleton s;
    const noh_skeleton_header *h = NULL;
    if (noh_pack_skeleton_at(pack, skeleton, &s, &h, NULL) || !h) {
        *level_count = 0;
        return NULL;
    }
    *level_count = h->level_count;
    return (const uint32_t *)(const void *)((const uint8_t *)h + h->levels_offset);
}

noh_result noh_pack_clip_at(const noh_pack *pack, uint32_t index, noh_pack_clip *clip, noh_error *error)
{
    const uint8_t *chunk;
    NOH_ASSERT(pack && clip);
    if (index >= pack->runs[NOH_CHUNK_CLIP].count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        pack->runs[NOH_CHUNK_CLIP].count ? "index is past the pack's last clip"
                                                         : "the pack has no clip",
                        index, pack->runs[NOH_CHUNK_CLIP].count);
    }
    chunk = noh_pack_chunk_at(pack, NOH_CHUNK_CLIP, index);
    clip->name = noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_CLIP].first + index);
    clip->header = (const noh_clip_header *)(const void *)chunk;
    clip->events = (const noh_clip_event *)(const void *)(chunk + clip->header->events_offset);
    clip->markers = (const noh_clip_marker *)(const void *)(chunk + clip->header->markers_offset);
    clip->bytes = chunk + clip->header->clip_offset;
    clip->joint_errors = (const float *)(const void *)(chunk + clip->header->joint_errors_offset);
    return NOH_OK;
}

noh_result noh_pack_bind_clip(const noh_pack *pack, const noh_pack_clip *clip, noh_skeleton *skeleton, uint32_t *index,
                              noh_error *error)
{
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_SKELETON].count; i++) {
        const noh_skeleton_header *h;
        if (noh_pack_skeleton_at(pack, i, skeleton, &h, NULL) == NOH_OK && h->hash == clip->header->skeleton_hash &&
            h->joint_count == clip->header->joint_count) {
            if (index) {
                *index = i;
            }
            return NOH_OK;
        }
    }
    return noh_fail(error, NOH_ERR_NOT_FOUND, "the clip was built for another skeleton: joint names or parents differ",
                    clip->header->skeleton_hash, 0);
}
