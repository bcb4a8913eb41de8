/* check_terrain.c: the checker of a terrain. Every height is one. */
#include <stddef.h>

#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#define FAR 1e6f

static int is_far(float at)
{
    return !(at >= -FAR && at <= FAR);
}

static int is_side(uint32_t count)
{
    return count >= 2u && count <= NOH_TERRAIN_SIZE_MAX;
}

noh_result noh_check_terrain(noh_check *check)
{
    const noh_pack_terrain_header *h = (const noh_pack_terrain_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) return result;
    const noh_check_field fields[] = {
        { offsetof(noh_pack_terrain_header, width), !is_side(h->width) },
        { offsetof(noh_pack_terrain_header, depth), !is_side(h->depth) },
        { offsetof(noh_pack_terrain_header, origin), is_far(h->origin[0]) },
        { offsetof(noh_pack_terrain_header, origin) + 4u, is_far(h->origin[1]) },
        { offsetof(noh_pack_terrain_header, origin) + 8u, is_far(h->origin[2]) },
        { offsetof(noh_pack_terrain_header, spacing), !(h->spacing >= 1e-4f && h->spacing <= 1e4f) },
        { offsetof(noh_pack_terrain_header, scale), !(h->scale >= 0.0f && h->scale <= 1e2f) },
    };
    result = noh_check_fields(check, fields, sizeof fields / sizeof fields[0],
                              "number of a terrain is out of its range", 0);
    if (!result) result = noh_check_reserved(check, offsetof(noh_pack_terrain_header, reserved), 4);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_pack_terrain_header, heights_offset),
                                 (uint64_t)h->width * h->depth, sizeof(uint16_t));
    }
    return result ? result : noh_check_end(check);
}
