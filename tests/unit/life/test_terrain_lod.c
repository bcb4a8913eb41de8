/* Tests of terrain_lod.c: how far levels are off, that no crack is between two of them, and which a picture
 * gets. */
#include "life/physics/terrain_lod_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/noh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

typedef struct hill {
    noh_field field;
    uint16_t *heights;
    void *memory;
    noh_terrain_lod lod;
} hill;

static uint32_t random_of(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Waves, and something rough on one side. */
static void open_hill(hill *h, uint32_t width, uint32_t depth)
{
    uint32_t seed = 7;
    memset(h, 0, sizeof *h);
    h->heights = calloc((size_t)width * depth, sizeof *h->heights);
    for (uint32_t i = 0; i < width * depth; i++) {
        const float x = (float)(i % width), z = (float)(i / width);
        const float rough = x > 0.7f * (float)width ? (float)(random_of(&seed) % 900u) : 0.0f;
        h->heights[i] = (uint16_t)(22000.0f + 9000.0f * sinf(0.031f * x) * cosf(0.043f * z) +
                                   3000.0f * sinf(0.21f * x + 0.17f * z) + rough);
    }
    h->field = (noh_field){ h->heights, width, depth, { -20.0f, 1.0f, 5.0f }, 0.5f, 0.0005f };
    const size_t bytes = noh_terrain_lod_size(&h->field);
    h->memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_terrain_lod_init(h->memory, bytes - 1u, &h->field, &h->lod, NULL), NOH_ERR_MEMORY);
    assert_int_equal(noh_terrain_lod_init(h->memory, bytes, &h->field, &h->lod, NULL), NOH_OK);
}

static void close_hill(hill *h)
{
    free(h->memory);
    free(h->heights);
}

static float at(const hill *h, uint32_t column, uint32_t row)
{
    return h->field.origin[1] + h->field.scale * (float)h->heights[(size_t)row * h->field.width + column];
}

/* The vertex of a piece, as the shader finds it. */
static void vertex_of(const hill *h, const noh_terrain_piece *p, uint32_t x, uint32_t z, uint32_t out[2])
{
    uint32_t k[2] = { x, z };
    if (x == 0) k[1] -= z % p->edges[0];
    if (x == p->side) k[1] -= z % p->edges[1];
    if (z == 0) k[0] -= x % p->edges[2];
    if (z == p->side) k[0] -= x % p->edges[3];
    out[0] = p->column + k[0] * p->step;
    out[1] = p->row + k[1] * p->step;
    if (out[0] > h->field.width - 1u) out[0] = h->field.width - 1u;
    if (out[1] > h->field.depth - 1u) out[1] = h->field.depth - 1u;
}

/* ---- errors ---- */

/* How far heights are from a triangle, of those that lie in it. */
static float off_triangle(const hill *h, uint32_t v[3][2])
{
    const float x0 = (float)v[0][0], z0 = (float)v[0][1];
    const float a[2] = { (float)v[1][0] - x0, (float)v[1][1] - z0 },
                b[2] = { (float)v[2][0] - x0, (float)v[2][1] - z0 };
    const float area = a[0] * b[1] - a[1] * b[0];
    uint32_t low[2] = { UINT32_MAX, UINT32_MAX }, high[2] = { 0, 0 };
    float most = 0.0f;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++) {
            if (v[i][k] < low[k]) low[k] = v[i][k];
            if (v[i][k] > high[k]) high[k] = v[i][k];
        }
    }
    for (uint32_t z = low[1]; z <= high[1] && area != 0.0f; z++) {
        for (uint32_t x = low[0]; x <= high[0]; x++) {
            const float p[2] = { (float)x - x0, (float)z - z0 };
            const float s = (p[0] * b[1] - p[1] * b[0]) / area, t = (a[0] * p[1] - a[1] * p[0]) / area;
            if (s < -1e-5f || t < -1e-5f || s + t > 1.0f + 1e-5f) continue;
            const float flat = at(h, v[0][0], v[0][1]) + s * (at(h, v[1][0], v[1][1]) - at(h, v[0][0], v[0][1])) +
                               t * (at(h, v[2][0], v[2][1]) - at(h, v[0][0], v[0][1]));
            most = fmaxf(most, fabsf(flat - at(h, x, z)));
        }
    }
    return most;
}

static float off_block(const hill *h, uint32_t block)
{
    const noh_terrain_piece p = noh_terrain_lod_block(&h->lod, block);
    float most = 0.0f;
    for (uint32_t z = 0; z < p.side; z++) {
        for (uint32_t x = 0; x < p.side; x++) {
            uint32_t a[2], b[2], c[2], d[2];
            vertex_of(h, &p, x, z, a);
            vertex_of(h, &p, x + 1u, z, b);
            vertex_of(h, &p, x, z + 1u, c);
            vertex_of(h, &p, x + 1u, z + 1u, d);
            uint32_t first[3][2] = { { a[0], a[1] }, { c[0], c[1] }, { b[0], b[1] } };
            uint32_t second[3][2] = { { b[0], b[1] }, { c[0], c[1] }, { d[0], d[1] } };
            most = fmaxf(most, fmaxf(off_triangle(h, first), off_triangle(h, second)));
        }
    }
    return most;
}

/* Of every level, on a field whose sides are no multiple of a block: a bound, and no more than is needed. */
static void errors_bound_every_height(void **state)
{
    hill h;
    (void)state;
    open_hill(&h, 101, 70);
    assert_int_equal(h.lod.width * h.lod.depth, 4 * 3);
    float last = 0.0f;
    for (uint32_t level = 0; level < NOH_TERRAIN_LEVELS; level++) {
        float worst = 0.0f, told = 0.0f;
        memset(h.lod.levels, (int)level, h.lod.width * h.lod.depth);
        for (uint32_t block = 0; block < h.lod.width * h.lod.depth; block++) {
            const float off = off_block(&h, block), bound = h.lod.errors[block * NOH_TERRAIN_LEVELS + level];
            assert_true(off <= bound + 1e-4f);
            worst = fmaxf(worst, off);
            told = fmaxf(told, bound);
        }
        assert_true(told <= fmaxf(worst, last) + 1e-4f); /* a level tells no less than a finer one */
        assert_true(level == 0 ? told == 0.0f : told > 0.0f);
        last = told;
    }
    close_hill(&h);
}

/* ---- edges ---- */

/* Whatever levels two blocks have: along their edge both use the same heights. */
static void no_crack_is_between_levels(void **state)
{
    uint32_t seed = 3;
    hill h;
    (void)state;
    open_hill(&h, 257, 129);
    for (int round = 0; round < 200; round++) {
        for (uint32_t i = 0; i < h.lod.width * h.lod.depth; i++) {
            h.lod.levels[i] = (uint8_t)(random_of(&seed) % NOH_TERRAIN_LEVELS);
        }
        for (uint32_t i = 0; i + 1u < h.lod.width; i++) {
            const noh_terrain_piece here = noh_terrain_lod_block(&h.lod, i),
                                    there = noh_terrain_lod_block(&h.lod, i + 1u);
            const noh_terrain_piece below = noh_terrain_lod_block(&h.lod, i + h.lod.width);
            uint8_t used[4][NOH_TERRAIN_BLOCK + 1u] = { { 0 } };
            uint32_t v[2];
            for (uint32_t k = 0; k <= here.side; k++) {
                vertex_of(&h, &here, here.side, k, v);
                assert_int_equal(v[0], there.column);
                used[0][v[1] - here.row] = 1;
                vertex_of(&h, &here, k, here.side, v);
                assert_int_equal(v[1], below.row);
                used[2][v[0] - here.column] = 1;
            }
            for (uint32_t k = 0; k <= there.side; k++) {
                vertex_of(&h, &there, 0, k, v);
                used[1][v[1] - there.row] = 1;
            }
            for (uint32_t k = 0; k <= below.side; k++) {
                vertex_of(&h, &below, k, 0, v);
                used[3][v[0] - below.column] = 1;
            }
            assert_memory_equal(used[0], used[1], sizeof used[0]);
            assert_memory_equal(used[2], used[3], sizeof used[2]);
        }
    }
    close_hill(&h);
}

/* ---- choosing ---- */

static void levels_are_as_coarse_as_pixels_allow(void **state)
{
    static const float target[3] = { 40.0f, 10.0f, 60.0f };
    uint32_t at_level[NOH_TERRAIN_LEVELS] = { 0 }, hidden = 0;
    noh_stage_view view;
    hill h;
    (void)state;
    open_hill(&h, 257, 257);
    assert_int_equal(noh_terrain_lod_size(&h.field), 64 * 30);
    noh_view_orbit(&view, target, 0.4f, 0.35f, 60.0f, 640, 360);
    noh_terrain_lod_choose(&h.lod, view.view_projection, view.eye, 360, 1.0f);
    const float half = 0.5f * 360.0f / tanf(20.0f * 3.14159265f / 180.0f); /* pixels a metre, a metre away */
    for (uint32_t i = 0; i < 64u; i++) {
        const float low[2] = { h.field.origin[0] + 16.0f * (float)(i % 8u),
                               h.field.origin[2] + 16.0f * (float)(i / 8u) };
        float square = 0.0f;
        for (int k = 0; k < 2; k++) {
            const float eye = view.eye[2 * k], off = fmaxf(fmaxf(low[k] - eye, eye - low[k] - 16.0f), 0.0f);
            square += off * off;
        }
        const float top = h.field.origin[1] + h.field.scale * (float)h.lod.bounds[2u * i + 1u];
        const float above = fmaxf(view.eye[1] - top, 0.0f), distance = sqrtf(square + above * above);
        const float *errors = h.lod.errors + i * NOH_TERRAIN_LEVELS;
        const uint32_t level = h.lod.levels[i];
        assert_true(errors[level] * half <= 1.001f * distance);
        assert_true(level + 1u == NOH_TERRAIN_LEVELS || errors[level + 1u] * half > 0.999f * distance);
        at_level[level]++;
        hidden += !h.lod.seen[i];
    }
    assert_true(hidden > 4 && hidden < 60);
    print_message("blocks at each level: %u %u %u %u %u %u; %u not seen\n", at_level[0], at_level[1], at_level[2],
                  at_level[3], at_level[4], at_level[5], hidden);
    noh_terrain_lod_choose(&h.lod, view.view_projection, view.eye, 360, 1e9f);
    for (uint32_t i = 0; i < 64u; i++) assert_int_equal(h.lod.levels[i], NOH_TERRAIN_LEVELS - 1u);
    close_hill(&h);
}

/* A block that is said to be hidden has no vertex in the picture. */
static void what_is_hidden_is_not_in_the_picture(void **state)
{
    static const float target[3] = { 40.0f, 10.0f, 60.0f };
    noh_stage_view view;
    hill h;
    (void)state;
    open_hill(&h, 257, 257);
    for (int turn = 0; turn < 12; turn++) {
        noh_view_orbit(&view, target, 0.5f * (float)turn, 0.3f, 30.0f, 640, 360);
        noh_terrain_lod_choose(&h.lod, view.view_projection, view.eye, 360, 1.0f);
        for (uint32_t z = 0; z < 257u; z++) {
            for (uint32_t x = 0; x < 257u; x++) {
                const float p[3] = { h.field.origin[0] + 0.5f * (float)x, at(&h, x, z),
                                     h.field.origin[2] + 0.5f * (float)z };
                float clip[4];
                for (int r = 0; r < 4; r++) {
                    const float *m = view.view_projection + r;
                    clip[r] = m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12];
                }
                if (!(fabsf(clip[0]) < clip[3] && fabsf(clip[1]) < clip[3] && fabsf(clip[2]) < clip[3])) continue;
                const uint32_t column = x / 32u < 8u ? x / 32u : 7u, row = z / 32u < 8u ? z / 32u : 7u;
                assert_true(h.lod.seen[row * 8u + column]);
            }
        }
    }
    close_hill(&h);
}

static void a_line_is_no_field(void **state)
{
    uint16_t heights[4] = { 0, 1, 2, 3 };
    const noh_field line = { heights, 4, 1, { 0.0f, 0.0f, 0.0f }, 1.0f, 1.0f };
    noh_terrain_lod out;
    noh_error error = { NOH_OK, "", 0, 0 };
    void *memory = test_aligned(NULL, 1024);
    (void)state;
    assert_int_equal(noh_terrain_lod_size(&line), 0);
    assert_int_equal(noh_terrain_lod_init(memory, 1024, &line, &out, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "2 x 2"));
    free(memory);
}

int main(int argument_count, char **arguments)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_bound_every_height),
        cmocka_unit_test(no_crack_is_between_levels),
        cmocka_unit_test(levels_are_as_coarse_as_pixels_allow),
        cmocka_unit_test(what_is_hidden_is_not_in_the_picture),
        cmocka_unit_test(a_line_is_no_field),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
