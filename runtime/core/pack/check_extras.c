/* check_extras.c: the checker of a mesh's extra attributes. */
#include <stddef.h>

#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

/* A row that a mesh lacks is all zeros; else its bits lie within the words. */
static noh_result check_row(const noh_check *check, const noh_extra_row *row, uint32_t word_count, uint64_t at)
{
    const float bits = row->bits, first = row->first_bit, count = row->component_count;
    const noh_check_field fields[] = {
        { offsetof(noh_extra_row, component_count),
          !(count == 0.0f || count == 1.0f || count == 2.0f || count == 3.0f || count == 4.0f) },
        { offsetof(noh_extra_row, bits), count == 0.0f ? bits != 0.0f : bits != 8.0f && bits != 16.0f },
        { offsetof(noh_extra_row, first_bit),
          count == 0.0f ? first != 0.0f : !(first >= 0.0f && first + count * bits <= 32.0f * (float)word_count) },
        { offsetof(noh_extra_row, reserved), row->reserved != 0.0f },
    };
    noh_result result = noh_check_fields(check, fields, 4, "extra attribute has impossible bits", at);
    if (!result) result = noh_check_floats(check, row->offset, 8, "extra attribute has a box that is not finite");
    for (uint32_t c = 0; !result && c < 4u; c++) {
        const int there = (float)c < count;
        const noh_check_field box[] = {
            { offsetof(noh_extra_row, offset) + 4u * c, !there && row->offset[c] != 0.0f },
            { offsetof(noh_extra_row, step) + 4u * c, there ? row->step[c] < 0.0f : row->step[c] != 0.0f },
        };
        result = noh_check_fields(check, box, 2, "extra attribute has a step below 0, or one of no component", at);
    }
    if (!result && count != 0.0f && ((float)(uint32_t)first != first || (uint32_t)first % (uint32_t)bits)) {
        result = noh_check_fail(check, "extra attribute begins within a component",
                                at + offsetof(noh_extra_row, first_bit));
    }
    return result;
}

static noh_result check_name(const noh_check *check, const noh_extra_name *name, uint64_t at)
{
    const noh_check_field fields[] = { { offsetof(noh_extra_name, error), name->error < 0.0f },
                                       { offsetof(noh_extra_name, reserved), name->reserved != 0 } };
    noh_result result = noh_check_name(check, name->name, name->name_hash, at);
    if (!result) result = noh_check_floats(check, &name->error, 1, "error of an extra attribute is not finite");
    return result ? result : noh_check_fields(check, fields, 2, "error or reserved field of an extra attribute", at);
}

noh_result noh_check_extras(noh_check *check)
{
    const noh_extras_header *h = (const noh_extras_header *)(const void *)check->bytes;
    const noh_mesh_header *mesh;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) return result;
    mesh = noh_check_subject(check, NOH_CHUNK_EXTRAS, NOH_CHUNK_MESH);
    const noh_check_field fields[] = {
        { offsetof(noh_extras_header, mesh), !mesh },
        { offsetof(noh_extras_header, count), !h->count || h->count > NOH_EXTRAS_MAX },
        { offsetof(noh_extras_header, word_count), mesh && (!h->word_count || h->word_count != mesh->extra_words) },
        { offsetof(noh_extras_header, reserved), h->reserved[0] != 0 },
        { offsetof(noh_extras_header, reserved) + 4u, h->reserved[1] != 0 },
        { offsetof(noh_extras_header, reserved) + 8u, h->reserved[2] != 0 },
    };
    result = noh_check_fields(check, fields, sizeof fields / sizeof *fields, "extra attributes do not fit their mesh",
                              0);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_extras_header, names_offset), h->count, sizeof(noh_extra_name));
    }
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
