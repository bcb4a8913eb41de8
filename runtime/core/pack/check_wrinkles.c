/* check_wrinkles.c: the checker of what wrinkles and colours regions. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <stddef.h>

static noh_result check_header(const noh_check *check, const noh_wrinkles_header *h)
{
    const noh_mesh_header *mesh = noh_check_subject(check, NOH_CHUNK_WRINKLES, NOH_CHUNK_MESH);
    if (!mesh) {
        return noh_check_fail(check, "wrinkles name a missing mesh, or are out of order",
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

/* A pixel reads the colour map besides the material's other maps. */
static noh_result check_colors(const noh_check *check, const noh_wrinkles_header *h)
{
    const noh_pack *pack = check->pack;
    const noh_texture_header *t = noh_pack_chunk_at(pack, NOH_CHUNK_TEXTURE, h->color_texture);
    if (!h->colors_offset) {
        return h->color_material || h->color_texture
                   ? noh_check_fail(check, "a mesh without colours has a material or a map of them",
                                    offsetof(noh_wrinkles_header, color_material))
                   : NOH_OK;
    }
    if (h->color_material >= pack->material_count) {
        return noh_check_fail(check, "colours name a missing material", offsetof(noh_wrinkles_header, color_material));
    }
    if (!t || !(t->flags & NOH_TEXTURE_LINEAR)) {
        return noh_check_fail(check, "colours have no map, or one of colours in place of data",
                              offsetof(noh_wrinkles_header, color_texture));
    }
    return noh_material_maps(&pack->materials[h->color_material]) < NOH_MATERIAL_MAPS_MAX
               ? NOH_OK
               : noh_check_fail(check, "material has more maps than a pixel may read, with its map of colours",
                                offsetof(noh_wrinkles_header, color_material));
}

noh_result noh_check_wrinkles(noh_check *check)
{
    const noh_wrinkles_header *h = (const noh_wrinkles_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (!result) result = check_header(check, h);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_wrinkles_header, matrix_offset), h->target_count,
                                 NOH_WRINKLE_FOLDS);
    }
    if (!result) result = check_colors(check, h);
    if (!result && h->colors_offset) {
        result = noh_check_array(check, offsetof(noh_wrinkles_header, colors_offset),
                                 (uint64_t)NOH_WRINKLE_COLORS + h->target_count, 4);
    }
    return result ? result : noh_check_end(check);
}
