/* check.c: what all chunk checkers share. */
#include "core/base/math_internal.h"
#include "core/base/compiler_internal.h"
#include "core/pack/check_internal.h"

#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

NOH_NEVER_INLINE noh_result noh_check_fail(const noh_check *check, const char *what, uint64_t offset)
{
    return noh_fail(check->error, NOH_ERR_DATA, what, check->file_offset + offset, 0);
}

noh_result noh_check_fields(const noh_check *check, const noh_check_field *fields, size_t count, const char *what,
                            uint64_t record)
{
    for (size_t i = 0; i < count; i++) {
        if (fields[i].wrong) {
            return noh_check_fail(check, what, record + fields[i].at);
        }
    }
    return NOH_OK;
}

noh_result noh_check_reserved(const noh_check *check, uint64_t at, uint32_t count)
{
    for (uint32_t i = 0; i < 4u * count; i++) {
        if (check->bytes[at + i]) return noh_check_fail(check, "reserved field is not zero", at + (i & ~3u));
    }
    return NOH_OK;
}

noh_result noh_check_head(noh_check *check, uint32_t bytes)
{
    if (check->count < bytes) {
        return noh_check_fail(check, "chunk is smaller than its header", 0);
    }
    check->cursor = bytes;
    return NOH_OK;
}

/* Arrays lie in a fixed order, each at the next multiple of 16, so an offset in the file can only be right or wrong: it
 * is compared with the cursor, which then moves past the array. Nothing overlaps, and no byte is left unchecked. */
noh_result noh_check_array(noh_check *check, size_t field, uint64_t count, uint32_t stride)
{
    uint32_t offset;
    uint64_t start = ((uint64_t)check->cursor + 15u) & ~(uint64_t)15u;
    uint64_t end = start + count * stride; /* counts are limited to 2^26, strides to 2^16: no overflow */
    memcpy(&offset, check->bytes + field, sizeof offset);
    if (offset != start) {
        return noh_check_fail(check, "an array does not begin at the end of the previous array", field);
    }
    if (end > check->count) {
        return noh_check_fail(check, "an array reaches past the end of its chunk", field);
    }
    for (uint64_t i = check->cursor; i < start; i++) {
        if (check->bytes[i]) {
            return noh_check_fail(check, "padding is not zero", i);
        }
    }
    check->cursor = (uint32_t)end;
    return NOH_OK;
}

noh_result noh_check_end(const noh_check *check)
{
    if (check->cursor != check->count) {
        return noh_check_fail(check, "chunk is longer than its arrays", check->cursor);
    }
    return NOH_OK;
}

const void *noh_check_subject(const noh_check *check, noh_chunk_type type, noh_chunk_type about)
{
    const uint32_t n = *(const uint32_t *)(const void *)check->bytes, before = check->pack->runs[type].count;
    if (before && n <= *(const uint32_t *)noh_pack_chunk_at(check->pack, type, before - 1u)) return NULL;
    return noh_pack_chunk_at(check->pack, about, n);
}

noh_result noh_check_floats(const noh_check *check, const float *values, uint32_t count, const char *what)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!noh_is_finite(values[i])) {
            return noh_check_fail(check, what, (uint64_t)((const uint8_t *)(values + i) - check->bytes));
        }
        if (!(values[i] >= -NOH_NUMBER_MAX && values[i] <= NOH_NUMBER_MAX)) {
            return noh_check_fail(check, "number is larger than 10^12",
                                  (uint64_t)((const uint8_t *)(values + i) - check->bytes));
        }
    }
    return NOH_OK;
}

noh_result noh_check_name(const noh_check *check, uint32_t name, uint32_t hash, uint64_t offset)
{
    if (name >= check->pack->string_bytes) {
        return noh_check_fail(check, "name lies outside the strings", offset);
    }
    if (noh_hash_name(check->pack->strings + name) != hash) {
        return noh_check_fail(check, "name and its hash differ", offset + sizeof name);
    }
    return NOH_OK;
}

/* Graphs are checked when they are opened, by noh_pack_check_graph, so that a program without graphs links none of it.
 */
noh_result noh_check_graph(noh_check *check)
{
    (void)check;
    return NOH_OK;
}
