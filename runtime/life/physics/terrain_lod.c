/* terrain_lod.c: levels of a height field's blocks. */
#include "life/physics/terrain_lod_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"

/* ---- bytes ---- */

static uint32_t blocks_along(uint32_t heights)
{
    return (heights - 1u + NOH_TERRAIN_BLOCK - 1u) / NOH_TERRAIN_BLOCK;
}

static void carve(noh_arena *arena, uint32_t count, noh_terrain_lod *l)
{
    l->errors = noh_arena_carve(arena, count * (size_t)NOH_TERRAIN_LEVELS * sizeof *l->errors, 16);
    l->bounds = noh_arena_carve(arena, count * 2u * sizeof *l->bounds, 16);
    l->levels = noh_arena_carve(arena, count, 16);
    l->seen = noh_arena_carve(arena, count, 16);
}

static int is_field(const noh_field *f)
{
    return f->width >= 2u && f->depth >= 2u && f->heights;
}

size_t noh_terrain_lod_size(const noh_field *field)
{
    noh_arena arena = noh_arena_measure();
    noh_terrain_lod l;
    NOH_ASSERT(field);
    if (!is_field(field)) return 0;
    carve(&arena, blocks_along(field->width) * blocks_along(field->depth), &l);
    return arena.used;
}

/* ---- errors ---- */

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static float height_at(const noh_field *f, uint32_t column, uint32_t row)
{
    return (float)f->heights[(size_t)row * f->width + column];
}

/* The largest distance of the heights of one cell of a level from its two triangles, in steps of the field. */
static float error_of_cell(const noh_field *f, uint32_t column, uint32_t row, uint32_t step)
{
    const uint32_t right = least(column + step, f->width - 1u), next = least(row + step, f->depth - 1u);
    const float a = height_at(f, column, row), b = height_at(f, right, row), c = height_at(f, column, next),
                d = height_at(f, right, next);
    float most = 0.0f;
    for (uint32_t r = row; r <= next; r++) {
        const float v = (float)(r - row) / (float)(next - row);
        for (uint32_t k = column; k <= right; k++) {
            const float u = (float)(k - column) / (float)(right - column);
            const float flat = u + v <= 1.0f ? a + (b - a) * u + (c - a) * v
                                             : d + (c - d) * (1.0f - u) + (b - d) * (1.0f - v);
            const float off = height_at(f, k, r) - flat, size = off < 0.0f ? -off : off;
            if (size > most) most = size;
        }
    }
    return most;
}

static void measure_block(const noh_terrain_lod *l, uint32_t block)
{
    const noh_field *f = &l->field;
    const uint32_t column = block % l->width * NOH_TERRAIN_BLOCK, row = block / l->width * NOH_TERRAIN_BLOCK;
    const uint32_t right = least(column + NOH_TERRAIN_BLOCK, f->width - 1u);
    const uint32_t next = least(row + NOH_TERRAIN_BLOCK, f->depth - 1u);
    float *errors = l->errors + (size_t)block * NOH_TERRAIN_LEVELS;
    uint16_t *bounds = l->bounds + 2u * (size_t)block;
    bounds[0] = UINT16_MAX;
    bounds[1] = 0;
    for (uint32_t r = row; r <= next; r++) {
        for (uint32_t k = column; k <= right; k++) {
            const uint16_t height = f->heights[(size_t)r * f->width + k];
            if (height < bounds[0]) bounds[0] = height;
            if (height > bounds[1]) bounds[1] = height;
        }
    }
    errors[0] = 0.0f;
    for (uint32_t level = 1; level < NOH_TERRAIN_LEVELS; level++) {
        const uint32_t step = 1u << level;
        float most = errors[level - 1u] / (f->scale > 0.0f ? f->scale : 1.0f);
        for (uint32_t r = row; r < next; r += step) {
            for (uint32_t k = column; k < right; k += step) {
                const float error = error_of_cell(f, k, r, step);
                if (error > most) most = error;
            }
        }
        errors[level] = most * f->scale;
    }
}

noh_result noh_terrain_lod_init(void *memory, size_t bytes, const noh_field *field, noh_terrain_lod *out,
                                noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(field && out);
    if (!is_field(field)) return noh_fail(error, NOH_ERR_ARG, "the field has fewer than 2 x 2 heights", 0, 0);
    const noh_result result = noh_arena_open(&arena, memory, bytes, noh_terrain_lod_size(field), error);
    if (result) return result;
    out->field = *field;
    out->width = blocks_along(field->width);
    out->depth = blocks_along(field->depth);
    const uint32_t count = out->width * out->depth;
    carve(&arena, count, out);
    memset(out->levels, 0, count);
    memset(out->seen, 1, count);
    for (uint32_t block = 0; block < count; block++) measure_block(out, block);
    return NOH_OK;
}

/* ---- choosing ---- */

static void box_of(const noh_terrain_lod *l, uint32_t block, float low[3], float high[3])
{
    const noh_field *f = &l->field;
    const uint32_t first[2] = { block % l->width * NOH_TERRAIN_BLOCK, block / l->width * NOH_TERRAIN_BLOCK };
    const uint32_t counts[2] = { f->width, f->depth };
    for (int i = 0; i < 2; i++) {
        low[2 * i] = f->origin[2 * i] + (float)first[i] * f->spacing;
        high[2 * i] = f->origin[2 * i] + (float)least(first[i] + NOH_TERRAIN_BLOCK, counts[i] - 1u) * f->spacing;
    }
    for (int i = 0; i < 2; i++) {
        const float y = f->origin[1] + (float)l->bounds[2u * (size_t)block + (size_t)i] * f->scale;
        if (i) high[1] = y;
        if (!i) low[1] = y;
    }
}

/* A box is outside the picture if all of it is beyond one of the six planes. */
static int is_seen(const float m[16], const float low[3], const float high[3])
{
    for (int plane = 0; plane < 6; plane++) {
        const int row = plane >> 1;
        const float sign = plane & 1 ? -1.0f : 1.0f;
        float most = m[15] + sign * m[12 + row];
        for (int i = 0; i < 3; i++) {
            const float along = m[4 * i + 3] + sign * m[4 * i + row];
            most += along * (along > 0.0f ? high[i] : low[i]);
        }
        if (most < 0.0f) return 0;
    }
    return 1;
}

static float distance_to(const float eye[3], const float low[3], const float high[3])
{
    float square = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float off = eye[i] < low[i] ? low[i] - eye[i] : eye[i] > high[i] ? eye[i] - high[i] : 0.0f;
        square += off * off;
    }
    return noh_sqrt(square);
}

void noh_terrain_lod_choose(noh_terrain_lod *lod, const float view_projection[16], const float eye[3],
                            uint32_t height_px, float pixels)
{
    const float *m = view_projection;
    const float wide = noh_sqrt(m[1] * m[1] + m[5] * m[5] + m[9] * m[9]);
    const float deep = noh_sqrt(m[3] * m[3] + m[7] * m[7] + m[11] * m[11]);
    NOH_ASSERT(lod && view_projection && eye);
    for (uint32_t block = 0; block < lod->width * lod->depth; block++) {
        const float *errors = lod->errors + (size_t)block * NOH_TERRAIN_LEVELS;
        float low[3], high[3];
        uint32_t level = NOH_TERRAIN_LEVELS - 1u;
        box_of(lod, block, low, high);
        lod->seen[block] = (uint8_t)is_seen(m, low, high);
        /* an error of e at a distance d is e 0.5 height wide / (d deep) pixels high; a parallel view has no depth */
        const float far = deep > 0.0f ? deep * distance_to(eye, low, high) : 1.0f;
        while (level && errors[level] * 0.5f * (float)height_px * wide > pixels * far) level--;
        lod->levels[block] = (uint8_t)level;
    }
}

/* ---- pieces ---- */

static uint32_t edge_to(const noh_terrain_lod *l, uint32_t level, int has, uint32_t other)
{
    return has && l->levels[other] > level ? 1u << (l->levels[other] - level) : 1u;
}

noh_terrain_piece noh_terrain_lod_block(const noh_terrain_lod *lod, uint32_t block)
{
    noh_terrain_piece p;
    NOH_ASSERT(lod && block < lod->width * lod->depth);
    const uint32_t level = lod->levels[block], column = block % lod->width, row = block / lod->width;
    p.column = column * NOH_TERRAIN_BLOCK;
    p.row = row * NOH_TERRAIN_BLOCK;
    p.side = NOH_TERRAIN_BLOCK >> level;
    p.step = 1u << level;
    p.edges[0] = edge_to(lod, level, column > 0, block - 1u);
    p.edges[1] = edge_to(lod, level, column + 1u < lod->width, block + 1u);
    p.edges[2] = edge_to(lod, level, row > 0, block - lod->width);
    p.edges[3] = edge_to(lod, level, row + 1u < lod->depth, block + lod->width);
    return p;
}
