#include "info_extras.h"

#include <stdio.h>

static uint32_t count_of(const noh_mesh *mesh)
{
    return mesh->extras ? mesh->extras->count : 0;
}

static const void *array_of(const noh_mesh *mesh, uint32_t offset)
{
    return (const uint8_t *)mesh->extras + offset;
}

void info_print_extras(const noh_mesh *mesh)
{
    if (count_of(mesh)) printf("  extra attributes, %u bytes a vertex:\n", 4u * mesh->header->extra_words);
    for (uint32_t k = 0; k < count_of(mesh); k++) {
        const noh_extra_name *name = (const noh_extra_name *)array_of(mesh, mesh->extras->names_offset) + k;
        const noh_extra_row *row = (const noh_extra_row *)array_of(mesh, mesh->extras->rows_offset) + k;
        printf("    %u %s: ", k, noh_pack_string(mesh->pack, name->name));
        if (row->component_count > 0.0f) {
            printf("%g x %g bits, within %.2g\n", (double)row->component_count, (double)row->bits, (double)name->error);
        } else {
            printf("not in this mesh\n");
        }
    }
}

void info_json_extras(json *j, const noh_mesh *mesh)
{
    json_open(j, "extras", '[');
    for (uint32_t k = 0; k < count_of(mesh); k++) {
        const noh_extra_name *name = (const noh_extra_name *)array_of(mesh, mesh->extras->names_offset) + k;
        const noh_extra_row *row = (const noh_extra_row *)array_of(mesh, mesh->extras->rows_offset) + k;
        json_open(j, NULL, '{');
        json_text(j, "name", noh_pack_string(mesh->pack, name->name));
        json_integer(j, "components", (uint64_t)row->component_count);
        json_integer(j, "bits", (uint64_t)row->bits);
        json_number(j, "error", (double)name->error);
        json_close(j, '}');
    }
    json_close(j, ']');
}
