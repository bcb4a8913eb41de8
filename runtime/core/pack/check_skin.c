/* check_skin.c: the checkers of skins, and of what a skinned mesh says of its vertices. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>

static uint32_t skeleton_joints(const noh_pack *pack, uint32_t skeleton)
{
    const noh_skeleton_header *h = noh_pack_chunk_at(pack, NOH_CHUNK_SKELETON, skeleton);
    return h->joint_count;
}

uint32_t noh_check_skin_joints(const noh_pack *pack, uint32_t skin)
{
    const noh_skin_header *h = noh_pack_chunk_at(pack, NOH_CHUNK_SKIN, skin);
    return h ? h->joint_count : 0;
}

noh_result noh_check_skin(noh_check *check)
{
    const noh_skin_header *h = (const noh_skin_header *)(const void *)check->bytes;
    const uint16_t *joints;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) {
        return result;
    }
    if (!h->joint_count || h->joint_count > NOH_SKIN_JOINTS_MAX) {
        return noh_check_fail(check, "skin has no joints or too many", offsetof(noh_skin_header, joint_count));
    }
    if (h->skeleton >= check->pack->runs[NOH_CHUNK_SKELETON].count) {
        return noh_check_fail(check, "skin names a missing skeleton", offsetof(noh_skin_header, skeleton));
    }
    result = noh_check_array(check, offsetof(noh_skin_header, joints_offset), h->joint_count, 2);
    if (!result) result = noh_check_array(check, offsetof(noh_skin_header, inverse_bind_offset), h->joint_count, 48);
    if (!result) result = noh_check_end(check);
    if (result) {
        return result;
    }
    joints = (const uint16_t *)(const void *)(check->bytes + h->joints_offset);
    for (uint32_t j = 0; j < h->joint_count; j++) {
        if (joints[j] >= skeleton_joints(check->pack, h->skeleton)) {
            return noh_check_fail(check, "skin names a joint that its skeleton does not have",
                                  h->joints_offset + 2ull * j);
        }
    }
    return noh_check_floats(check, (const float *)(const void *)(check->bytes + h->inverse_bind_offset),
                            h->joint_count * 12u, "inverse bind matrix is not finite");
}

/* ---- meshes ---- */

/* The palettes follow each other without gaps, and name joints of the skin. */
static noh_result check_palettes(const noh_check *check, const noh_mesh_header *h)
{
    const noh_palette *palettes = (const noh_palette *)(const void *)(check->bytes + h->palettes_offset);
    const uint16_t *joints = (const uint16_t *)(const void *)(check->bytes + h->palette_joints_offset);
    uint32_t joint_count = noh_check_skin_joints(check->pack, h->skin), next = 0;
    for (uint32_t p = 0; p < h->palette_count; p++) {
        const uint32_t left = h->palette_joint_count - next;
        const noh_check_field fields[] = {
            { offsetof(noh_palette, first_joint), palettes[p].first_joint != next },
            { offsetof(noh_palette, joint_count), !palettes[p].joint_count || palettes[p].joint_count > left ||
                                                      palettes[p].joint_count > NOH_PALETTE_JOINTS_MAX },
        };
        const noh_result result = noh_check_fields(
            check, fields, 2, "palette is empty, too large, or does not follow the previous palette",
            h->palettes_offset + 8ull * p);
        if (result) {
            return result;
        }
        next += palettes[p].joint_count;
    }
    if (next != h->palette_joint_count) {
        return noh_check_fail(check, "the palettes' joints do not add up to the mesh's", h->palettes_offset);
    }
    for (uint32_t j = 0; j < next; j++) {
        if (joints[j] >= joint_count) {
            return noh_check_fail(check, "palette names a joint that its skin does not have",
                                  h->palette_joints_offset + 2ull * j);
        }
    }
    return NOH_OK;
}

/* `count` bits of a vertex's weights from `bit` up. */
static uint32_t take_bits(const uint32_t *words, uint32_t bit, uint32_t count)
{
    uint64_t pair = words[bit / 32u];
    if (bit % 32u + count > 32u) {
        pair |= (uint64_t)words[bit / 32u + 1u] << 32;
    }
    return (uint32_t)(pair >> bit % 32u) & ((1u << count) - 1u);
}

/* Joints lie in the palette, a joint without a weight repeats the first, the weights are at most 1, and bits that mean
 * nothing are 0. */
static noh_result check_record(const noh_check *check, const uint32_t *words, uint32_t count, uint32_t places,
                               uint64_t at)
{
    uint32_t joint_words = count == 8u ? 2u : 1u, bit = 0, end = 32u * (NOH_INFLUENCE_WORDS(count) - joint_words);
    uint32_t first = words[0] & 255u;
    uint64_t sum = 0;
    for (uint32_t i = 0; i < 4u * joint_words; i++) {
        uint32_t place = words[i / 4u] >> 8u * (i % 4u) & 255u, weight = 0;
        if (i > 0 && i < count) {
            weight = take_bits(words + joint_words, bit, i == 1 ? 22u : 21u);
            bit += i == 1 ? 22u : 21u;
        }
        if (i < count ? place >= places || (i && !weight && place != first) : place) {
            return noh_check_fail(check, "vertex follows a joint outside its palette, or one without a weight", at);
        }
        sum += weight;
    }
    if (sum > NOH_WEIGHT_ONE) {
        return noh_check_fail(check, "vertex's weights are above 1: nothing is left for the first joint", at);
    }
    while (bit < end && bit % 32u != 0) {
        if (take_bits(words + joint_words, bit++, 1u)) {
            return noh_check_fail(check, "vertex's weights are followed by bits that mean nothing", at);
        }
    }
    return NOH_OK;
}

static noh_result check_vertices(const noh_check *check, const noh_mesh_header *h)
{
    const noh_palette *palettes = (const noh_palette *)(const void *)(check->bytes + h->palettes_offset);
    const uint32_t *words = (const uint32_t *)(const void *)(check->bytes + h->influences_offset);
    uint32_t stride = NOH_INFLUENCE_WORDS(h->influence_count);
    for (uint32_t v = 0; v < h->vertex_count; v++) {
        uint32_t palette = noh_check_texel_word(check, h, v) >> NOH_TEXEL_VERTEX_BITS;
        noh_result result;
        if (palette >= h->palette_count) {
            return noh_check_fail(check, "vertex names a missing palette",
                                  h->attributes_offset + (uint64_t)v * h->attribute_stride);
        }
        result = check_record(check, words + (size_t)v * stride, h->influence_count, palettes[palette].joint_count,
                              h->influences_offset + 4ull * v * stride);
        if (result) {
            return result;
        }
    }
    return NOH_OK;
}

noh_result noh_check_mesh_skin(const noh_check *check, const noh_mesh_header *h)
{
    noh_result result = noh_check_draws(check, h);
    if (h->skin == NOH_NONE) {
        return result;
    }
    if (!result) result = check_palettes(check, h);
    if (!result) result = check_vertices(check, h);
    return result;
}
