/* check_wrinkles.c: the checker of what wrinkles regions. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>

static const void *chunk_at(const noh_pack *pack, uint32_t index)
{
    return pack->bytes + pack->chunks[index].offset;
}

/* It is for a mesh of the pack, a later one than the chunk before it. */
static int names_a_mesh(const noh_pack *pack, const noh_wrinkles_header *h)
{
    const noh_wrinkles_header *before;
    if (h->mesh >= pack->mesh_count || !pack->wrinkles_count) {
        return h->mesh < pack->mesh_count;
    }
    before = chunk_at(pack, pack->first_wrinkles + pack->wrinkles_count - 1u);
    return h->mesh > before->mesh;
}

static noh_result check_header(const noh_check *check, const noh_wrinkles_header *h)
{
    const noh_mesh_header *mesh;
    if (!names_a_mesh(check->pack, h)) {
        return noh_check_fail(check, "wrinkles name a mesh that is not there, or are out of order",
                              offsetof(noh_wrinkles_header, mesh));
    }
    mesh = chunk_at(check->pack, check->pack->first_mesh + h->mesh);
    if (h->target_count != mesh->target_count) {
        return noh_check_fail(check, "wrinkles differ from their mesh in the count of targets",
                              offsetof(noh_wrinkles_header, target_count));
    }
    for (unsigned i = 0; i < sizeof h->reserved / sizeof h->reserved[0]; i++) {
        if (h->reserved[i]) {
            return noh_check_fail(check, "reserved field of wrinkles is not zero",
                                  offsetof(noh_wrinkles_header, reserved) + 4ull * i);
        }
    }
    return NOH_OK;
}

noh_result noh_check_wrinkles(noh_check *check)
{
    const noh_wrinkles_header *h = (const noh_wrinkles_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (!result) result = check_header(check, h);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_wrinkles_header, matrix_offset), h->target_count,
                                 NOH_WRINKLE_REGIONS);
    }
    return result ? result : noh_check_end(check);
}
