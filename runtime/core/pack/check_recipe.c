/* check_recipe.c: the checker of a face's recipe. */
#include <stddef.h>

#include "noh/base.h"
#include "noh/format.h"
#include "core/pack/check_internal.h"

static noh_result check_row(const noh_check *check, const noh_recipe_row *row, uint64_t at)
{
    const noh_check_field fields[] = {
        { offsetof(noh_recipe_row, weight), !(row->weight >= -4.0f && row->weight <= 4.0f) },
    };
    noh_result result = noh_check_name(check, row->target, row->target_hash, at + offsetof(noh_recipe_row, target));
    if (!result) {
        result = noh_check_name(check, row->channel, row->channel_hash, at + offsetof(noh_recipe_row, channel));
    }
    if (!result) result = noh_check_reserved(check, at + offsetof(noh_recipe_row, reserved), 3);
    return result ? result : noh_check_fields(check, fields, 1, "row of a recipe is impossible", at);
}

noh_result noh_check_recipe(noh_check *check)
{
    const noh_recipe_header *h = (const noh_recipe_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) return result;
    if (!h->row_count || h->row_count > NOH_FACE_ROWS_MAX || h->reserved[0] || h->reserved[1]) {
        return noh_check_fail(check, "recipe has no rows, too many, or a reserved field that is not zero", 0);
    }
    result = noh_check_array(check, offsetof(noh_recipe_header, rows_offset), h->row_count, sizeof(noh_recipe_row));
    for (uint32_t i = 0; !result && i < h->row_count; i++) {
        const uint64_t at = h->rows_offset + (uint64_t)i * sizeof(noh_recipe_row);
        result = check_row(check, (const noh_recipe_row *)(const void *)(check->bytes + at), at);
    }
    if (!result) result = noh_check_end(check);
    if (!result) {
        check->opens->recipe_rows = (const noh_recipe_row *)(const void *)(check->bytes + h->rows_offset);
        check->opens->recipe_row_count = h->row_count;
    }
    return result;
}
