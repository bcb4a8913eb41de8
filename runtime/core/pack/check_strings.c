/* check_strings.c: the checker of the strings. */
#include "core/pack/check_internal.h"
#include "noh/base.h"

/* The chunk begins and ends with a zero, and no string is too long: so every offset below its size is a string that
 * ends in the chunk, and offset 0 is the empty one. */
noh_result noh_check_strings(noh_check *check)
{
    const char *strings = (const char *)check->bytes;
    uint32_t length = 0;
    if (!check->count || strings[0] || strings[check->count - 1]) {
        return noh_check_fail(check, "string chunk does not begin and end with a zero", 0);
    }
    for (uint32_t i = 0; i < check->count; i++) {
        length = strings[i] ? length + 1 : 0;
        if (length >= NOH_NAME_BYTES_MAX) {
            return noh_fail(check->error, NOH_ERR_LIMIT, "name is longer than the limit",
                            check->file_offset + (uint64_t)i, NOH_NAME_BYTES_MAX);
        }
    }
    check->opens->strings = strings;
    check->opens->string_bytes = check->count;
    return NOH_OK;
}
