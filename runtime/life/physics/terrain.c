/* terrain.c: a pack's terrain as a height field. */
#include "noh/base.h"
#include "noh/body.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/assert_internal.h"

noh_result noh_terrain_of(const noh_pack *pack, noh_field *field, noh_error *error)
{
    NOH_ASSERT(pack && field);
    const uint8_t *bytes = noh_pack_chunk_at(pack, NOH_CHUNK_TERRAIN, 0);
    const noh_pack_terrain_header *h = (const noh_pack_terrain_header *)(const void *)bytes;
    if (!h) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the pack has no terrain: build it with --terrain", 0, 0);
    }
    field->heights = (const uint16_t *)(const void *)(bytes + h->heights_offset);
    field->width = h->width;
    field->depth = h->depth;
    memcpy(field->origin, h->origin, sizeof field->origin);
    field->spacing = h->spacing;
    field->scale = h->scale;
    return NOH_OK;
}
