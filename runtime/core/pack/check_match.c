/* check_match.c: the checker of a table for motion matching. Boxes that do not hold their rows would hide the nearest
 * one from a search. */
#include <stddef.h>

#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#define PAIRS (NOH_MATCH_FEATURES / 2u)
#define TICKS_MAX 48000u /* a second */

static uint32_t groups_of(uint32_t count)
{
    return (count + 7u) / 8u;
}

static noh_result check_header(const noh_check *check, const noh_pack_match_header *h)
{
    const noh_check_field fields[] = {
        { offsetof(noh_pack_match_header, root_axes), h->root_axes > 15u },
        { offsetof(noh_pack_match_header, root_up), h->root_up > 2u },
        { offsetof(noh_pack_match_header, row_count), !h->row_count || h->row_count > NOH_MATCH_ROWS_MAX },
        { offsetof(noh_pack_match_header, row_ticks), !h->row_ticks || h->row_ticks > TICKS_MAX },
        { offsetof(noh_pack_match_header, clip_count), !h->clip_count || h->clip_count > NOH_CLIPS_MAX },
        { offsetof(noh_pack_match_header, tag_count), h->tag_count > NOH_MATCH_TAGS_MAX },
        { offsetof(noh_pack_match_header, reserved), h->reserved[0] || h->reserved[1] },
    };
    return noh_check_fields(check, fields, sizeof fields / sizeof fields[0],
                            "count of a motion matching table is out of its range", 0);
}

static noh_result check_arrays(noh_check *check, const noh_pack_match_header *h)
{
    static const uint32_t boxes[NOH_MATCH_LEVELS] = { 16, 64, 512 };
    noh_result result = noh_check_array(check, offsetof(noh_pack_match_header, clips_offset), h->clip_count,
                                        sizeof(noh_pack_match_clip));
    if (!result) {
        result = noh_check_array(check, offsetof(noh_pack_match_header, tags_offset), h->tag_count,
                                 sizeof(noh_pack_match_tag));
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_pack_match_header, numbers_offset), 2u * NOH_MATCH_FEATURES,
                                 sizeof(float));
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_pack_match_header, order_offset), h->row_count, sizeof(uint16_t));
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_pack_match_header, rows_offset), groups_of(h->row_count),
                                 NOH_MATCH_GROUP_BYTES);
    }
    for (uint32_t i = 0; i < NOH_MATCH_LEVELS && !result; i++) {
        result = noh_check_array(check, offsetof(noh_pack_match_header, boxes_offset) + i * sizeof(uint32_t),
                                 groups_of((h->row_count + boxes[i] - 1u) / boxes[i]), 2u * NOH_MATCH_GROUP_BYTES);
    }
    return result ? result : noh_check_end(check);
}

static noh_result check_clips(const noh_check *check, const noh_pack_match_header *h)
{
    const noh_pack_match_clip *clips = (const noh_pack_match_clip *)(const void *)(check->bytes + h->clips_offset);
    const uint32_t all = h->tag_count < 32u ? (1u << h->tag_count) - 1u : 0xffffffffu;
    uint32_t first = 0;
    for (uint32_t i = 0; i < h->clip_count; i++) {
        const noh_pack_match_clip *c = &clips[i];
        const uint64_t at = h->clips_offset + (uint64_t)i * sizeof *c;
        const noh_check_field fields[] = {
            { offsetof(noh_pack_match_clip, first_row), c->first_row != first },
            { offsetof(noh_pack_match_clip, row_count), !c->row_count || c->row_count > h->row_count - first },
            { offsetof(noh_pack_match_clip, tags), (c->tags & ~all) != 0 },
            { offsetof(noh_pack_match_clip, reserved), c->reserved != 0 },
        };
        noh_result result = noh_check_fields(check, fields, sizeof fields / sizeof fields[0],
                                             "clip of a motion matching table is wrong", at);
        if (!result) result = noh_check_name(check, c->name, c->name_hash, at);
        if (result) return result;
        first += c->row_count;
    }
    return first == h->row_count ? NOH_OK
                                 : noh_check_fail(check, "rows of a motion matching table belong to no clip",
                                                  offsetof(noh_pack_match_header, row_count));
}

static noh_result check_tags(const noh_check *check, const noh_pack_match_header *h)
{
    const noh_pack_match_tag *tags = (const noh_pack_match_tag *)(const void *)(check->bytes + h->tags_offset);
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < h->tag_count && !result; i++) {
        result = noh_check_name(check, tags[i].name, tags[i].name_hash, h->tags_offset + (uint64_t)i * sizeof *tags);
    }
    return result;
}

static noh_result check_numbers(const noh_check *check, const noh_pack_match_header *h)
{
    const float *numbers = (const float *)(const void *)(check->bytes + h->numbers_offset);
    const uint16_t *order = (const uint16_t *)(const void *)(check->bytes + h->order_offset);
    noh_result result = noh_check_floats(check, numbers, 2u * NOH_MATCH_FEATURES,
                                         "number of a motion matching table is not finite");
    for (uint32_t i = NOH_MATCH_FEATURES; i < 2u * NOH_MATCH_FEATURES && !result; i++) {
        if (numbers[i] < 0.0f || numbers[i] > 1e6f) {
            result = noh_check_fail(check, "scale of a motion matching table is out of its range",
                                    h->numbers_offset + i * sizeof *numbers);
        }
    }
    for (uint32_t i = 0; i < h->row_count && !result; i++) {
        if (order[i] >= h->row_count) {
            result = noh_check_fail(check, "row of a motion matching table has no such number",
                                    h->order_offset + i * sizeof *order);
        }
    }
    return result;
}

/* Byte of a number in the group of eight that its row or box lies in. */
static size_t at(uint32_t index, uint32_t feature)
{
    return (size_t)(feature / 2u) * 16u + index % 8u * 2u + feature % 2u;
}

/* A row's numbers are within the boxes of all levels. */
static noh_result check_boxes(const noh_check *check, const noh_pack_match_header *h)
{
    static const uint32_t sizes[NOH_MATCH_LEVELS] = { 16, 64, 512 };
    for (uint32_t row = 0; row < h->row_count; row++) {
        const uint64_t group = h->rows_offset + (uint64_t)(row / 8u) * NOH_MATCH_GROUP_BYTES;
        for (uint32_t level = 0; level < NOH_MATCH_LEVELS; level++) {
            const uint32_t box = row / sizes[level];
            const uint64_t low = h->boxes_offset[level] + (uint64_t)(box / 8u) * 2u * NOH_MATCH_GROUP_BYTES;
            for (uint32_t k = 0; k < 2u * PAIRS; k++) {
                const int number = (int8_t)check->bytes[group + at(row, k)];
                if (number < (int8_t)check->bytes[low + at(box, k)] ||
                    number > (int8_t)check->bytes[low + NOH_MATCH_GROUP_BYTES + at(box, k)])
                    return noh_check_fail(check, "box of a motion matching table does not hold its rows",
                                          low + at(box, k));
            }
        }
    }
    return NOH_OK;
}

noh_result noh_check_match(noh_check *check)
{
    const noh_pack_match_header *h = (const noh_pack_match_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (!result) result = check_header(check, h);
    if (!result) result = check_arrays(check, h);
    if (!result) result = check_clips(check, h);
    if (!result) result = check_tags(check, h);
    if (!result) result = check_numbers(check, h);
    return result ? result : check_boxes(check, h);
}
