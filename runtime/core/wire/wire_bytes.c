/* wire_bytes.c: bytes as they come, and textures. */
#include "core/wire/wire_internal.h"
#include "noh/base.h"

#include <string.h>

/* ---- rows of bytes ---- */

#define COLUMNS 16u
#define ITEM_BYTES 64u

/* A byte is two symbols: the upper half given its column, the lower half given both. Mode 1: the difference from the
 * byte a row before. */
static void code_byte(noh_wire_filter *f, uint32_t i)
{
    const noh_wire_section *s = &f->section;
    const uint32_t column = i % s->stride % COLUMNS;
    uint8_t *at = f->image + s->at + i;
    const uint32_t before = s->mode == 1 && i >= s->stride ? at[-(ptrdiff_t)s->stride] : 0u;
    const uint32_t value = (*at - before) & 255u;
    const uint32_t high = noh_wire_symbol(&f->coder, &f->models[column], value >> 4);
    const uint32_t low = noh_wire_symbol(&f->coder, &f->models[COLUMNS + column * 16u + high], value & 15u);
    if (!noh_wire_writes(f)) *at = (uint8_t)((high << 4 | low) + before);
}

int noh_wire_run_bytes(noh_wire_filter *f)
{
    const uint32_t count = f->section.count;
    if ((uint64_t)f->section.at + count > f->image_bytes || !f->section.stride) {
        return noh_wire_wrong(f, "bytes lie outside the pack");
    }
    while (f->cursor[0] < count) {
        if (!noh_wire_item(&f->coder)) return 0;
        for (uint32_t k = 0; k < ITEM_BYTES && f->cursor[0] < count; k++) code_byte(f, f->cursor[0]++);
    }
    return 1;
}

/* ---- a texture with its mip levels ---- */

typedef struct place {
    const uint8_t *row; /* of this level */
    const uint8_t *finer;
    uint32_t width, height, x, y;
} place;

/* Of three neighbours the middle one, or where left and above lie to one side of the corner, their sum less the corner:
 * an edge goes on.
 * source  Weinberger, Seroussi, Sapiro: The LOCO-I lossless image compression algorithm, 2000 */
static int32_t median(int32_t left, int32_t above, int32_t corner)
{
    const int32_t low = left < above ? left : above, high = left < above ? above : left;
    return corner >= high ? low : corner <= low ? high : left + above - corner;
}

/* A mip level's texel is about the mean of the four finer ones. */
static int32_t mean(const place *p, uint32_t c)
{
    const uint32_t w = p->width, x = 2u * p->x, y = 2u * p->y;
    const uint32_t x1 = x + 1u < w ? x + 1u : x, y1 = y + 1u < p->height ? y + 1u : y;
    return (p->finer[4u * ((size_t)y * w + x) + c] + p->finer[4u * ((size_t)y * w + x1) + c] +
            p->finer[4u * ((size_t)y1 * w + x) + c] + p->finer[4u * ((size_t)y1 * w + x1) + c] + 2) /
           4;
}

static void code_texel(noh_wire_filter *f, uint32_t at, const place *p, uint32_t width)
{
    uint8_t *texel = f->image + at;
    uint32_t before = 0;
    for (uint32_t c = 0; c < 4u; c++) {
        const int32_t left = p->x ? texel[(int)c - 4] : p->y ? texel[(ptrdiff_t)c - 4 * (ptrdiff_t)width] : 0;
        const int32_t above = p->y ? texel[(ptrdiff_t)c - 4 * (ptrdiff_t)width] : left;
        const int32_t corner = p->x && p->y ? texel[(ptrdiff_t)c - 4 * (ptrdiff_t)width - 4] : above;
        const uint32_t active = noh_wire_magnitude(left - corner) + noh_wire_magnitude(above - corner);
        const int32_t guess = p->finer ? mean(p, c) : median(left, above, corner);
        const uint32_t model = (p->finer ? 256u : 0u) + c * 64u + (before < 3u ? before : before < 9u ? 3u : 4u) * 8u;
        const int32_t residual = noh_wire_residual(f, model, active, (int8_t)(uint8_t)(texel[c] - guess));
        if (!noh_wire_writes(f)) texel[c] = (uint8_t)(guess + residual);
        before = noh_wire_magnitude(residual);
    }
}

/* cursor: byte of the level, texel of the level, level; params: width, height, levels. */
static int code_level(noh_wire_filter *f, uint32_t width, uint32_t height, uint32_t finer)
{
    const uint32_t count = width * height;
    place p;
    memset(&p, 0, sizeof p);
    p.width = width;
    p.height = height;
    if (f->cursor[2]) {
        p.finer = f->image + finer;
        p.width = f->last[0] > 0 ? (uint32_t)f->last[0] : 1u;
        p.height = f->last[1] > 0 ? (uint32_t)f->last[1] : 1u;
    }
    while (f->cursor[1] < count) {
        if (!noh_wire_item(&f->coder)) return 0;
        for (uint32_t k = 0; k < 16u && f->cursor[1] < count; k++, f->cursor[1]++) {
            p.x = f->cursor[1] % width;
            p.y = f->cursor[1] / width;
            code_texel(f, f->cursor[0] + 4u * f->cursor[1], &p, width);
        }
    }
    return 1;
}

static int texture_fits(const noh_wire_filter *f)
{
    const noh_wire_section *s = &f->section;
    uint32_t width = s->params[0], height = s->params[1];
    uint64_t bytes = 0;
    if (!width || !height || width > NOH_TEXTURE_SIZE_MAX || height > NOH_TEXTURE_SIZE_MAX || s->params[2] > 32u) {
        return 0;
    }
    for (uint32_t i = 0; i < s->params[2]; i++) {
        bytes += 4u * (uint64_t)width * height;
        width = noh_wire_half(width);
        height = noh_wire_half(height);
    }
    return s->at + bytes <= f->image_bytes;
}

int noh_wire_run_texture(noh_wire_filter *f)
{
    uint32_t width = f->section.params[0], height = f->section.params[1], at = f->section.at, finer = at;
    if (!f->image || !texture_fits(f)) return noh_wire_wrong(f, "a texture lies outside the pack");
    for (uint32_t i = 0; i < f->section.params[2]; i++) {
        if (i == f->cursor[2]) {
            f->cursor[0] = at;
            if (!code_level(f, width, height, finer)) return 0;
            f->last[0] = (int32_t)width;
            f->last[1] = (int32_t)height;
            f->cursor[1] = 0;
            f->cursor[2]++;
        }
        finer = at;
        at += 4u * width * height;
        width = noh_wire_half(width);
        height = noh_wire_half(height);
    }
    return 1;
}
