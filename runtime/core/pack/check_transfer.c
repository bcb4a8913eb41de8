/* check_transfer.c: the checker of transfers. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <stddef.h>

static noh_result check_header(const noh_check *check, const noh_transfer_header *h)
{
    const noh_check_field known[] = {
        { offsetof(noh_transfer_header, order), h->order != 4 && h->order != 6 },
        { offsetof(noh_transfer_header, flags), (h->flags & ~NOH_TRANSFER_ON_NORMAL) != 0 },
        { offsetof(noh_transfer_header, ray_count), !h->ray_count },
        { offsetof(noh_transfer_header, bounce), h->bounce > 255u },
    };
    noh_result result = noh_check_fields(
        check, known, 4, "transfer has an unknown order or flag, reflects more than it gets, or was not measured", 0);
    return result ? result
                  : noh_check_reserved(check, offsetof(noh_transfer_header, reserved),
                                       sizeof h->reserved / sizeof h->reserved[0]);
}

/* As many vertices, delta texels and targets as its mesh has. */
static noh_result check_mesh_counts(const noh_check *check, const noh_transfer_header *h)
{
    const noh_mesh_header *mesh = noh_check_subject(check, NOH_CHUNK_TRANSFER, NOH_CHUNK_MESH);
    if (!mesh) {
        return noh_check_fail(check, "transfer names a missing mesh, or is out of order",
                              offsetof(noh_transfer_header, mesh));
    }
    const noh_check_field counts[] = {
        { offsetof(noh_transfer_header, vertex_count), h->vertex_count != mesh->vertex_count },
        { offsetof(noh_transfer_header, texel_count), h->texel_count != mesh->texel_count },
        { offsetof(noh_transfer_header, target_count), h->target_count != mesh->target_count },
    };
    return noh_check_fields(check, counts, 3, "transfer differs from its mesh in a count", 0);
}

/* Signed bytes are -127..127. */
static noh_result check_signed(const noh_check *check, uint64_t at, uint64_t count, const char *what)
{
    for (uint64_t i = 0; i < count; i++) {
        if (check->bytes[at + i] == 0x80u) {
            return noh_check_fail(check, what, at + i);
        }
    }
    return NOH_OK;
}

static noh_result check_values(const noh_check *check, const noh_transfer_header *h)
{
    const uint32_t stride = NOH_TRANSFER_RECORD_BYTES(h->order, h->flags);
    const float *scales = (const float *)(const void *)(check->bytes + h->scales_offset);
    noh_result result = NOH_OK;
    for (uint32_t v = 0; !result && v < h->vertex_count; v++) {
        result = check_signed(check, h->records_offset + (uint64_t)v * stride + 1u, stride - 1u,
                              "shape or axis of a transfer is -128");
    }
    if (!result) result = noh_check_floats(check, scales, h->target_count, "scale of a transfer is not finite");
    for (uint32_t t = 0; !result && t < h->target_count; t++) {
        if (scales[t] < 0.0f) {
            result = noh_check_fail(check, "scale of a transfer is below 0", h->scales_offset + 4ull * t);
        }
    }
    return result ? result
                  : check_signed(check, h->deltas_offset, h->texel_count, "occlusion delta of a transfer is -128");
}

noh_result noh_check_transfer(noh_check *check)
{
    const noh_transfer_header *h = (const noh_transfer_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (!result) result = check_header(check, h);
    if (!result) result = check_mesh_counts(check, h);
    if (result) {
        return result;
    }
    result = noh_check_array(check, offsetof(noh_transfer_header, records_offset), h->vertex_count,
                             NOH_TRANSFER_RECORD_BYTES(h->order, h->flags));
    if (!result) result = noh_check_array(check, offsetof(noh_transfer_header, scales_offset), h->target_count, 4);
    if (!result) result = noh_check_array(check, offsetof(noh_transfer_header, deltas_offset), h->texel_count, 1);
    if (!result) result = noh_check_end(check);
    return result ? result : check_values(check, h);
}
