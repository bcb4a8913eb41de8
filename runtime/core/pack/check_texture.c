/* check_texture.c: the checker of textures. */
#include "core/pack/check_internal.h"
#include "core/pack/pack_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>

/* Levels of a whole chain, down to 1 x 1. */
static uint32_t chain_of(const noh_texture_header *h)
{
    uint32_t longer = h->width > h->height ? h->width : h->height, count = 1;
    while (longer >>= 1) count++;
    return count;
}

static uint64_t level_bytes(const noh_texture_header *h)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < h->level_count; i++) {
        const uint32_t width = h->width >> i, height = h->height >> i;
        bytes += noh_texture_bytes(h->format, width ? width : 1u, height ? height : 1u);
    }
    return bytes;
}

static noh_result check_texture_format(const noh_check *check, const noh_texture_header *h)
{
    const noh_check_field format[] = {
        { offsetof(noh_texture_header, format), h->format > NOH_TEXTURE_ASTC_8X8 },
        { offsetof(noh_texture_header, format),
          h->format == NOH_TEXTURE_EAC_RG && (!(h->flags & NOH_TEXTURE_LINEAR) || h->nearest) },
    };
    const noh_check_field error = { offsetof(noh_texture_header, error), !(h->error >= 0.0f && h->error <= 65025.0f) };
    noh_result result = noh_check_fields(check, format, 2, "unknown texture format, or not one for such a texture", 0);
    if (!result) result = noh_check_fields(check, &error, 1, "texture's error is not from 0 to 65025", 0);
    return result;
}

/* What was taken out was there. */
static noh_result check_texture_trim(const noh_check *check, const noh_texture_header *h)
{
    const noh_check_field whole[] = {
        { offsetof(noh_texture_header, whole_width),
          h->trim ? h->whole_width < h->width || h->whole_width > NOH_TEXTURE_SIZE_MAX : h->whole_width != 0 },
        { offsetof(noh_texture_header, whole_height),
          h->trim ? h->whole_height < h->height || h->whole_height > NOH_TEXTURE_SIZE_MAX : h->whole_height != 0 },
    };
    return noh_check_fields(check, whole, 2, "a texture's sides do not fit what was trimmed of it", 0);
}

static noh_result check_texture_fields(const noh_check *check, const noh_texture_header *h)
{
    const noh_check_field size[] = {
        { offsetof(noh_texture_header, width), !h->width || h->width > NOH_TEXTURE_SIZE_MAX },
        { offsetof(noh_texture_header, height), !h->height || h->height > NOH_TEXTURE_SIZE_MAX },
    };
    const noh_check_field sampling[] = {
        { offsetof(noh_texture_header, wrap_s), h->wrap_s > NOH_WRAP_MIRROR },
        { offsetof(noh_texture_header, wrap_t), h->wrap_t > NOH_WRAP_MIRROR },
        { offsetof(noh_texture_header, nearest), h->nearest > 1 },
        { offsetof(noh_texture_header, flags), (h->flags & ~NOH_TEXTURE_LINEAR) != 0 },
    };
    const noh_check_field levels = { offsetof(noh_texture_header, level_count),
                                     h->level_count != (h->nearest ? 1u : chain_of(h)) };
    noh_result result = noh_check_fields(check, size, 2, "texture size is zero or over the limit", 0);
    if (!result) result = noh_check_fields(check, sampling, 4, "unknown texture sampling", 0);
    if (!result) result = noh_check_fields(check, &levels, 1, "texture has another number of mip levels", 0);
    if (!result) result = check_texture_trim(check, h);
    return result ? result : check_texture_format(check, h);
}

noh_result noh_check_texture(noh_check *check)
{
    const noh_texture_header *h = (const noh_texture_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) {
        return result;
    }
    result = check_texture_fields(check, h);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_texture_header, pixels_offset), level_bytes(h), 1);
    }
    return result ? result : noh_check_end(check);
}
