/* check_cover.c: the checker of what a garment hides. */
#include <stddef.h>

#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

static uint32_t count_bits(const uint32_t *words, uint32_t count)
{
    uint32_t bits = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t word = words[i]; word; word &= word - 1u) bits++;
    }
    return bits;
}

noh_result noh_check_cover(noh_check *check)
{
    const noh_pack_cover_header *h = (const noh_pack_cover_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) return result;
    const uint32_t words = h->triangle_count / 32u + (h->triangle_count % 32u != 0);
    const noh_check_field fields[] = {
        { offsetof(noh_pack_cover_header, triangle_count), !h->triangle_count },
        { offsetof(noh_pack_cover_header, hidden_count), h->hidden_count > h->triangle_count },
    };
    result = noh_check_fields(check, fields, sizeof fields / sizeof *fields, "count of a cover is impossible", 0);
    if (!result) result = noh_check_reserved(check, offsetof(noh_pack_cover_header, reserved), 2);
    if (!result) result = noh_check_name(check, h->mesh, h->mesh_hash, offsetof(noh_pack_cover_header, mesh));
    if (!result) result = noh_check_array(check, offsetof(noh_pack_cover_header, bits_offset), words, 4);
    if (!result) {
        const uint32_t *bits = (const uint32_t *)(const void *)(check->bytes + h->bits_offset);
        const uint32_t rest = h->triangle_count % 32u;
        if ((rest && bits[words - 1u] >> rest) || count_bits(bits, words) != h->hidden_count) {
            return noh_check_fail(check, "a cover has more or fewer bits than its count", h->bits_offset);
        }
    }
    return result ? result : noh_check_end(check);
}
