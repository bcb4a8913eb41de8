/* check_wrinkles.c: the checker of what wrinkles regions. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <stddef.h>

static noh_result check_header(const noh_check *check, const noh_wrinkles_header *h)
{
    const noh_mesh_header *mesh = noh_check_subject(check, NOH_CHUNK_WRINKLES, NOH_CHUNK_MESH);
    if (!mesh) {
        return noh_check_fail(check, "wrinkles name a mesh that is not there, or are out of order",
                              offsetof(noh_wrinkles_header, mesh));
    }
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
