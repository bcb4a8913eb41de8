/* check_ragdoll.c: the checker of a ragdoll's table. */
#include <stddef.h>

#include "core/base/math_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "core/pack/check_internal.h"

#define HALF_TURN 3.1415927f
#define FRICTION_MAX 10000.0f

static noh_result check_row(const noh_check *check, const noh_pack_ragdoll_row *row, uint64_t at)
{
    const noh_check_field fields[] = {
        { offsetof(noh_pack_ragdoll_row, hinge), row->hinge > 1u },
        { offsetof(noh_pack_ragdoll_row, toward), row->toward > 2u },
        { offsetof(noh_pack_ragdoll_row, bend_min), !noh_is_within(row->bend_min, -HALF_TURN, 0.0f) },
        { offsetof(noh_pack_ragdoll_row, bend_max), !noh_is_within(row->bend_max, 0.0f, HALF_TURN) },
        { offsetof(noh_pack_ragdoll_row, side), !noh_is_within(row->side, 0.0f, HALF_TURN) },
        { offsetof(noh_pack_ragdoll_row, twist), !noh_is_within(row->twist, 0.0f, HALF_TURN) },
        { offsetof(noh_pack_ragdoll_row, friction), !noh_is_within(row->friction, 0.0f, FRICTION_MAX) },
    };
    noh_result result = noh_check_name(check, row->joint, row->joint_hash, at + offsetof(noh_pack_ragdoll_row, joint));
    if (!result) result = noh_check_reserved(check, at + offsetof(noh_pack_ragdoll_row, reserved), 3);
    return result ? result
                  : noh_check_fields(check, fields, sizeof fields / sizeof *fields,
                                     "row of a ragdoll's table is impossible", at);
}

/* A joint has one row: string offsets of equal names may differ, so hashes are compared. */
static int is_new(const noh_pack_ragdoll_row *rows, uint32_t i)
{
    uint32_t k = 0;
    while (k < i && rows[k].joint_hash != rows[i].joint_hash) k++;
    return k == i;
}

noh_result noh_check_ragdoll(noh_check *check)
{
    const noh_pack_ragdoll_header *h = (const noh_pack_ragdoll_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) return result;
    if (!h->row_count || h->row_count > NOH_RAGDOLL_BODIES_MAX || h->reserved[0] || h->reserved[1]) {
        return noh_check_fail(check, "table of a ragdoll has no rows, too many, or a reserved field that is not zero",
                              0);
    }
    result = noh_check_array(check, offsetof(noh_pack_ragdoll_header, rows_offset), h->row_count,
                             sizeof(noh_pack_ragdoll_row));
    for (uint32_t i = 0; !result && i < h->row_count; i++) {
        const noh_pack_ragdoll_row *rows = (const noh_pack_ragdoll_row *)(const void *)(check->bytes + h->rows_offset);
        const uint64_t at = h->rows_offset + (uint64_t)i * sizeof *rows;
        result = check_row(check, &rows[i], at);
        if (!result && !is_new(rows, i)) result = noh_check_fail(check, "two rows of a ragdoll have one joint", at);
    }
    if (!result) result = noh_check_end(check);
    if (!result) {
        check->opens->ragdoll_rows = (const noh_pack_ragdoll_row *)(const void *)(check->bytes + h->rows_offset);
        check->opens->ragdoll_row_count = h->row_count;
    }
    return result;
}
