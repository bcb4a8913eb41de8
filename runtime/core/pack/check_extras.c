/* check_extras.c: the checker of a mesh's extra attributes. */
#include <stddef.h>

#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

/* A row that a mesh lacks is all zeros; else its components lie within the words, none across two of them. */
static noh_result check_row(const noh_check *check, const noh_extra_row *row, uint32_t word_count, uint64_t at)
{
    const uint32_t bit_count = 32u * word_count;
    noh_result result = noh_check_floats(check, row->offset, 12, "extra attribute is not finite");
    if (result) return result;
    int wrong = !(row->component_count >= 0.0f && row->component_count <= 4.0f && row->first_bit >= 0.0f &&
                  row->first_bit <= (float)bit_count) ||
                row->reserved != 0.0f;
    if (!wrong) {
        const uint32_t count = (uint32_t)row->component_count, first = (uint32_t)row->first_bit;
        const uint32_t bits = count ? row->bits == 8.0f ? 8u : 16u : 1u;
        wrong = (float)count != row->component_count || (float)first != row->first_bit ||
                row->bits != (count ? (float)bits : 0.0f) || first % bits ||
                (count ? first + count * bits > bit_count : first);
        for (uint32_t c = 0; c < 4u; c++) {
            wrong |= c < count ? row->step[c] < 0.0f : row->step[c] != 0.0f || row->offset[c] != 0.0f;
        }
    }
    return wrong ? noh_check_fail(check, "extra attribute has impossible bits, or a step below 0", at) : NOH_OK;
}

static noh_result check_name(const noh_check *check, const noh_extra_name *name, uint64_t at)
{
    noh_result result = noh_check_name(check, name->name, name->name_hash, at);
    if (!result) result = noh_check_floats(check, &name->error, 1, "error of an extra attribute is not finite");
    if (!result && (name->error < 0.0f || name->reserved)) {
        result = noh_check_fail(check, "error or reserved field of an extra attribute", at);
    }
    return result;
}

noh_result noh_check_extras(noh_check *check)
{
    const noh_extras_header *h = (const noh_extras_header *)(const void *)check->bytes;
    const noh_mesh_header *mesh;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) return result;
    mesh = noh_check_subject(check, NOH_CHUNK_EXTRAS, NOH_CHUNK_MESH);
    if (!mesh || !h->count || h->count > NOH_EXTRAS_MAX || !h->word_count || h->word_count != mesh->extra_words) {
        return noh_check_fail(check, "extra attributes do not fit their mesh", 0);
    }
    result = noh_check_reserved(check, offsetof(noh_extras_header, reserved), 3);
    if (!result)
        result = noh_check_array(check, offsetof(noh_extras_header, names_offset), h->count, sizeof(noh_extra_name));
    if (!result) {
        result = noh_check_array(check, offsetof(noh_extras_header, rows_offset), h->count, sizeof(noh_extra_row));
    }
    for (uint32_t i = 0; !result && i < h->count; i++) {
        const uint64_t name = h->names_offset + (uint64_t)i * sizeof(noh_extra_name);
        const uint64_t row = h->rows_offset + (uint64_t)i * sizeof(noh_extra_row);
        result = check_name(check, (const noh_extra_name *)(const void *)(check->bytes + name), name);
        if (!result) {
            result = check_row(check, (const noh_extra_row *)(const void *)(check->bytes + row), h->word_count, row);
        }
    }
    return result ? result : noh_check_end(check);
}
