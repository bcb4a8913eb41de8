/* wire_blocks.c: textures in blocks of ETC2 and EAC, one field of a block after the other.
 *
 * Levels are coded one by one, and blocks row by row. Each unit of 8 bytes, of colours or of one channel, is
 * coded as a copy of its left or upper neighbour if equal. Otherwise mode, colours, tables and selectors follow
 * (wire_etc2.c, wire_eac.c), each predicted from known texels: neighbours, and texels of the previous level, each the
 * mean of four. */
#include "core/wire/wire_blocks_internal.h"
#include "core/pack/pack_internal.h"

#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#define ITEM_BLOCKS 16u

/* ---- texels that are known ---- */

static void texels_of(const noh_wire_unit *u, const uint8_t *at, noh_wire_texel_value texels[16])
{
    uint8_t bytes[16][4];
    uint16_t values[16];
    const int is_channel = u->format == NOH_TEXTURE_ETC2_RGBA || u->format == NOH_TEXTURE_EAC_RG;
    if (is_channel) {
        noh_eac_decode(at, u->format == NOH_TEXTURE_EAC_RG, values);
    } else {
        noh_etc2_decode(u->format, at, 1, bytes[0]);
    }
    for (uint32_t i = 0; i < 16u; i++) {
        for (uint32_t c = 0; c < 3u; c++) texels[i].c[c] = is_channel ? values[i] : bytes[i][c];
        texels[i].share = is_channel || bytes[i][3] ? 4 : 0;
    }
}

static const uint8_t *unit_at(const noh_wire_unit *u, const noh_wire_level *l, uint32_t x, uint32_t y)
{
    x = x < l->columns ? x : l->columns - 1u;
    y = y < l->rows ? y : l->rows - 1u;
    return l->at + ((size_t)y * l->columns + x) * u->bytes + u->offset;
}

/* Each texel of the other level is four of this one. */
static void guess_by_coarser(noh_wire_unit *u)
{
    noh_wire_texel_value texels[16];
    texels_of(u, unit_at(u, u->other, u->x / 2u, u->y / 2u), texels);
    for (uint32_t i = 0; i < 16u; i++) {
        u->guess[i] = texels[4u * (u->y % 2u * 2u + i / 8u) + u->x % 2u * 2u + i % 4u / 2u];
    }
}

/* Four texels of the other level are one of this; transparent ones do not count. */
static void guess_by_finer(noh_wire_unit *u)
{
    noh_wire_texel_value texels[16];
    for (uint32_t b = 0; b < 4u; b++) {
        texels_of(u, unit_at(u, u->other, 2u * u->x + b % 2u, 2u * u->y + b / 2u), texels);
        for (uint32_t k = 0; k < 4u; k++) {
            noh_wire_texel_value *to = &u->guess[4u * (b / 2u * 2u + k / 2u) + b % 2u * 2u + k % 2u];
            const noh_wire_texel_value *from = &texels[8u * (k / 2u) + 2u * (k % 2u)];
            memset(to, 0, sizeof *to);
            for (uint32_t i = 0; i < 4u; i++) {
                const noh_wire_texel_value *t = &from[i / 2u * 4u + i % 2u];
                for (uint32_t c = 0; c < 3u && t->share; c++) to->c[c] += t->c[c];
                to->share += t->share / 4;
            }
            for (uint32_t c = 0; c < 3u && to->share; c++) to->c[c] = (to->c[c] + to->share / 2) / to->share;
        }
    }
}

/* The mean of those beside. */
static void guess_by_beside(noh_wire_unit *u)
{
    noh_wire_texel_value mean = { { 0, 0, 0 }, 0 };
    for (uint32_t i = 0; i < 8u; i++) {
        for (uint32_t c = 0; c < 3u && u->beside[i].share; c++) mean.c[c] += u->beside[i].c[c];
        mean.share += u->beside[i].share / 4;
    }
    for (uint32_t c = 0; c < 3u && mean.share; c++) mean.c[c] /= mean.share;
    mean.share = 0;
    for (uint32_t i = 0; i < 16u; i++) u->guess[i] = mean;
}

void noh_wire_look_beside(noh_wire_unit *u)
{
    noh_wire_texel_value texels[16];
    memset(u->beside, 0, sizeof u->beside);
    if (u->left) {
        texels_of(u, u->left, texels);
        for (uint32_t y = 0; y < 4u; y++) u->beside[y] = texels[4u * y + 3u];
    }
    if (u->above) {
        texels_of(u, u->above, texels);
        for (uint32_t x = 0; x < 4u; x++) u->beside[4u + x] = texels[12u + x];
    }
    for (uint32_t i = 0; i < 4u; i++) {
        const noh_wire_texel_value *l = &u->beside[i], *a = &u->beside[4u + i];
        u->light[1u + i][0] = l->share ? noh_wire_light(l->c) : NOH_WIRE_UNKNOWN;
        u->light[0][1u + i] = a->share ? noh_wire_light(a->c) : NOH_WIRE_UNKNOWN;
    }
    u->light[0][0] = NOH_WIRE_UNKNOWN;
    guess_by_beside(u);
    if (u->other) {
        const noh_wire_texel_value mean = u->guess[0];
        if (u->finer) {
            guess_by_finer(u);
        } else {
            guess_by_coarser(u);
        }
        for (uint32_t i = 0; i < 16u; i++) {
            if (!u->guess[i].share) memcpy(u->guess[i].c, mean.c, sizeof mean.c);
        }
    }
}

int32_t noh_wire_light_beside(const noh_wire_unit *u, uint32_t x, uint32_t y)
{
    const int32_t left = u->light[1u + y][x], above = u->light[y][1u + x], corner = u->light[y][x];
    const int32_t low = left < above ? left : above, high = left < above ? above : left;
    if (left < 0 && above < 0) return noh_wire_light(u->guess[4u * y + x].c);
    if (left < 0 || above < 0) return high;
    if (corner < 0) return (left + above) / 2;
    return corner >= high ? low : corner <= low ? high : left + above - corner;
}

uint32_t noh_wire_zone(const int32_t *lights, uint32_t count, int32_t light)
{
    uint32_t nearest = 0;
    while (nearest + 1u < count && 2 * light > lights[nearest] + lights[nearest + 1u]) nearest++;
    return 2u * nearest + (light > lights[nearest]);
}

uint32_t noh_wire_spread(const noh_wire_unit *u, uint32_t texels)
{
    static const uint16_t steps[7] = { 8, 20, 40, 70, 110, 170, 260 };
    int32_t low = INT32_MAX, high = 0;
    uint32_t k = 0;
    for (uint32_t i = 0; i < 16u; i++) {
        if (!(texels >> i & 1u)) continue;
        const int32_t light = noh_wire_light(u->guess[i].c);
        low = light < low ? light : low;
        high = light > high ? light : high;
    }
    if (u->format == NOH_TEXTURE_EAC_RG) high = (high - low) / 8, low = 0;
    while (k < 7u && high - low >= steps[k]) k++;
    return k;
}

/* ---- blocks ---- */

static void code_unit(noh_wire_filter *f, noh_wire_unit *u)
{
    const noh_wire_level *l = u->here;
    const size_t row = (size_t)l->columns * u->bytes;
    const uint8_t *corner;
    u->now = l->at + (size_t)u->y * row + (size_t)u->x * u->bytes + u->offset;
    u->left = u->x ? u->now - u->bytes : NULL;
    u->above = u->y ? u->now - row : NULL;
    corner = u->x && u->y ? u->above - u->bytes : NULL;
    u->equal = (u->left && corner && memcmp(u->left, corner, 8) == 0) |
               (uint32_t)(u->above && corner && memcmp(u->above, corner, 8) == 0) << 1;
    if (u->format == NOH_TEXTURE_ETC2_RGB || u->format == NOH_TEXTURE_ETC2_RGBA1) {
        noh_wire_code_colors(f, u);
    } else {
        noh_wire_code_channel(f, u);
    }
}

static void code_block(noh_wire_filter *f, const noh_wire_level *here, const noh_wire_level *other, uint32_t index)
{
    const uint32_t format = f->section.params[3];
    noh_wire_unit u = { .format = format,
                        .bytes = noh_texture_block_bytes(format),
                        .x = index % here->columns,
                        .y = index / here->columns,
                        .here = here,
                        .other = other,
                        .finer = f->section.mode == 1 };
    code_unit(f, &u);
    if (u.bytes == 8u) return;
    u.offset = 8;
    u.format = format == NOH_TEXTURE_ETC2_RGBA ? NOH_TEXTURE_ETC2_RGB : format;
    code_unit(f, &u);
}

/* ---- levels ---- */

static noh_wire_level level_of(const noh_wire_filter *f, uint32_t index)
{
    uint32_t width = f->section.params[0], height = f->section.params[1], at = f->section.at;
    noh_wire_level l;
    for (uint32_t i = 0; i < index; i++) {
        at += noh_texture_bytes(f->section.params[3], width, height);
        width = noh_wire_half(width);
        height = noh_wire_half(height);
    }
    l.columns = (width + 3u) / 4u;
    l.rows = (height + 3u) / 4u;
    l.at = f->image + at;
    return l;
}

static int blocks_fit(const noh_wire_filter *f)
{
    const noh_wire_section *s = &f->section;
    uint32_t width = s->params[0], height = s->params[1];
    uint64_t bytes = 0;
    if (!width || !height || width > NOH_TEXTURE_SIZE_MAX || height > NOH_TEXTURE_SIZE_MAX || s->params[2] > 32u ||
        !s->params[3] || s->params[3] > NOH_TEXTURE_ETC2_RGBA1) {
        return 0;
    }
    for (uint32_t i = 0; i < s->params[2]; i++) {
        bytes += noh_texture_bytes(s->params[3], width, height);
        width = noh_wire_half(width);
        height = noh_wire_half(height);
    }
    return s->at + bytes <= f->image_bytes;
}

/* cursor: levels done, blocks of this one done; params: width, height, levels, format. Mode 0: the coarsest level
 * first, 1: the finest. */
int noh_wire_run_blocks(noh_wire_filter *f)
{
    const uint32_t levels = f->section.params[2];
    if (!f->image || !blocks_fit(f)) return noh_wire_wrong(f, "a texture in blocks lies outside the pack");
    for (; f->cursor[0] < levels; f->cursor[0]++, f->cursor[1] = 0) {
        const int finer = f->section.mode == 1;
        const uint32_t index = finer ? f->cursor[0] : levels - 1u - f->cursor[0];
        const noh_wire_level here = level_of(f, index);
        const noh_wire_level other = level_of(f, f->cursor[0] ? finer ? index - 1u : index + 1u : index);
        while (f->cursor[1] < here.columns * here.rows) {
            if (f->coder.bad || !noh_wire_item(&f->coder)) return 0;
            for (uint32_t k = 0; k < ITEM_BLOCKS && f->cursor[1] < here.columns * here.rows; k++) {
                code_block(f, &here, f->cursor[0] ? &other : NULL, f->cursor[1]++);
            }
        }
    }
    return 1;
}
