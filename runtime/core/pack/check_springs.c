/* check_springs.c: the checker of springs. */
#include <stddef.h>

#include "core/base/math_internal.h"
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

/* What the rows of a chunk are checked against. */
typedef struct springs_check {
    const noh_check *check;
    const noh_springs_header *h;
    const noh_spring_row *rows;
    const uint16_t *parents;
    const float *bind; /* [joint_count][10] */
} springs_check;

static noh_result check_header(const noh_check *check, const noh_springs_header *h)
{
    const noh_skeleton_header *skeleton = noh_check_subject(check, NOH_CHUNK_SPRINGS, NOH_CHUNK_SKELETON);
    if (!skeleton) {
        return noh_check_fail(check, "springs name a missing skeleton, or are out of order",
                              offsetof(noh_springs_header, skeleton));
    }
    const noh_check_field fields[] = {
        { offsetof(noh_springs_header, joint_count), h->joint_count != skeleton->joint_count },
        { offsetof(noh_springs_header, row_count), !h->row_count || h->row_count > h->joint_count },
        { offsetof(noh_springs_header, chain_count), !h->chain_count || h->chain_count > h->row_count },
        { offsetof(noh_springs_header, collider_count), h->collider_count > NOH_SPRING_COLLIDERS_MAX },
    };
    const noh_result result = noh_check_fields(check, fields, sizeof fields / sizeof *fields,
                                               "count of springs is impossible", 0);
    return result ? result : noh_check_reserved(check, offsetof(noh_springs_header, reserved), 4);
}

static NOH_NEVER_INLINE int is_not_below(float value)
{
    return !(value >= 0.0f) || !noh_is_finite(value);
}

static NOH_NEVER_INLINE int is_not_finite3(const float v[3])
{
    return !noh_is_finite(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static NOH_NEVER_INLINE int has_no_length(const float v[3])
{
    return !(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] > 0.0f) || is_not_finite3(v);
}

/* A row of a chain. `above`: the joint of the row before; NOH_NONE: it is the first. */
static noh_result check_row(const springs_check *c, uint32_t index, uint32_t above)
{
    const noh_spring_row *row = &c->rows[index];
    const uint64_t at = c->h->rows_offset + (uint64_t)index * sizeof *row;
    const uint32_t parent = row->joint < c->h->joint_count ? c->parents[row->joint] : NOH_PACK_JOINT_ROOT;
    const noh_check_field fields[] = {
        { offsetof(noh_spring_row, joint), parent == NOH_PACK_JOINT_ROOT || (above != NOH_NONE && parent != above) },
        { offsetof(noh_spring_row, stiffness), is_not_below(row->stiffness) },
        { offsetof(noh_spring_row, drag), is_not_below(row->drag) || row->drag > 1.0f },
        { offsetof(noh_spring_row, radius), is_not_below(row->radius) },
        { offsetof(noh_spring_row, gravity), is_not_finite3(row->gravity) },
    };
    const noh_result result = noh_check_fields(c->check, fields, sizeof fields / sizeof *fields,
                                               "row of springs is invalid, or not a child of the previous row", at);
    if (!result && above != NOH_NONE && has_no_length(c->bind + 10u * (size_t)row->joint + 4u)) {
        return noh_check_fail(c->check, "joint of a spring is at the position of its parent", at);
    }
    return result;
}

static noh_result check_chain(const springs_check *c, uint32_t index, uint32_t *next)
{
    const noh_spring_chain *chain = (const noh_spring_chain *)(const void *)(c->check->bytes + c->h->chains_offset) +
                                    index;
    const uint64_t at = c->h->chains_offset + (uint64_t)index * sizeof *chain;
    const uint32_t left = c->h->row_count - *next, colliders = c->h->collider_count;
    const noh_check_field fields[] = {
        { offsetof(noh_spring_chain, first_row), chain->first_row != *next },
        { offsetof(noh_spring_chain, row_count),
          !chain->row_count || chain->row_count > left || chain->row_count > NOH_SPRING_JOINTS_MAX },
        { offsetof(noh_spring_chain, collides), colliders < 32u && chain->collides >> colliders != 0 },
        { offsetof(noh_spring_chain, end), has_no_length(chain->end) },
    };
    noh_result result = noh_check_fields(c->check, fields, sizeof fields / sizeof *fields,
                                         "chain of springs is invalid, or out of order", at);
    for (uint32_t i = 0; !result && i < chain->row_count; i++) {
        result = check_row(c, *next + i, i ? c->rows[*next + i - 1u].joint : NOH_NONE);
    }
    if (!result) *next += chain->row_count;
    return result;
}

static noh_result check_distinct(const springs_check *c)
{
    uint8_t taken[NOH_JOINTS_MAX / 8u] = { 0 };
    for (uint32_t i = 0; i < c->h->row_count; i++) {
        const uint32_t joint = c->rows[i].joint, bit = 1u << (joint & 7u);
        if (taken[joint >> 3] & bit) {
            return noh_check_fail(c->check, "joint is in two rows of springs",
                                  c->h->rows_offset + (uint64_t)i * sizeof *c->rows);
        }
        taken[joint >> 3] = (uint8_t)(taken[joint >> 3] | bit);
    }
    return NOH_OK;
}

static noh_result check_colliders(const noh_check *check, const noh_springs_header *h)
{
    const noh_spring_capsule *all = (const noh_spring_capsule *)(const void *)(check->bytes + h->colliders_offset);
    for (uint32_t i = 0; i < h->collider_count; i++) {
        const noh_check_field fields[] = {
            { offsetof(noh_spring_capsule, joint), all[i].joint >= h->joint_count },
            { offsetof(noh_spring_capsule, from), is_not_finite3(all[i].from) },
            { offsetof(noh_spring_capsule, to), is_not_finite3(all[i].to) },
            { offsetof(noh_spring_capsule, radius), is_not_below(all[i].radius) },
        };
        const noh_result result = noh_check_fields(check, fields, sizeof fields / sizeof *fields,
                                                   "collider of springs is invalid",
                                                   h->colliders_offset + (uint64_t)i * sizeof *all);
        if (result) return result;
    }
    return NOH_OK;
}

static noh_result check_all(const noh_check *check, const noh_springs_header *h)
{
    const uint8_t *skeleton = noh_pack_chunk_at(check->pack, NOH_CHUNK_SKELETON, h->skeleton);
    const noh_skeleton_header *s = (const noh_skeleton_header *)(const void *)skeleton;
    const springs_check c = { check, h, (const noh_spring_row *)(const void *)(check->bytes + h->rows_offset),
                              (const uint16_t *)(const void *)(skeleton + s->parents_offset),
                              (const float *)(const void *)(skeleton + s->bind_offset) };
    uint32_t next = 0;
    noh_result result = NOH_OK;
    for (uint32_t i = 0; !result && i < h->chain_count; i++) result = check_chain(&c, i, &next);
    if (!result && next != h->row_count) {
        result = noh_check_fail(check, "row of springs is in no chain", offsetof(noh_springs_header, row_count));
    }
    if (!result) result = check_distinct(&c);
    return result ? result : check_colliders(check, h);
}

noh_result noh_check_springs(noh_check *check)
{
    const noh_springs_header *h = (const noh_springs_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (!result) result = check_header(check, h);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_springs_header, rows_offset), h->row_count,
                                 sizeof(noh_spring_row));
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_springs_header, chains_offset), h->chain_count,
                                 sizeof(noh_spring_chain));
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_springs_header, colliders_offset), h->collider_count,
                                 sizeof(noh_spring_capsule));
    }
    if (!result) result = noh_check_end(check);
    return result ? result : check_all(check, h);
}
