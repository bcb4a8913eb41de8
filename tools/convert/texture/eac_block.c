/* eac_block.c: one channel of a block: a base, and for each texel one of eight steps from it. */
#include "etc2_block.h"

#include <limits.h>
#include <string.h>

#include "noh/low_core.h"

/* clang-format off */
static const int8_t tables[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8}
};
/* clang-format on */

typedef struct fit {
    int32_t base, times, table;
    uint8_t indices[16];
    uint32_t error;
} fit;

static int32_t step_of(int32_t times, int eleven)
{
    return eleven ? (times ? times * 8 : 1) : times;
}

/* Choose the index of each texel; *left is the sum of the errors. */
static void select_all(const int32_t values[16], int eleven, fit *f, int32_t *left)
{
    const int32_t most = eleven ? 2047 : 255, base = eleven ? f->base * 8 + 4 : f->base;
    int32_t steps[8];
    for (int k = 0; k < 8; k++) {
        steps[k] = etc2_clamp(base + tables[f->table][k] * step_of(f->times, eleven), most);
    }
    f->error = 0;
    *left = 0;
    for (int i = 0; i < 16; i++) {
        int32_t nearest = INT_MAX;
        for (int k = 0; k < 8; k++) {
            const int32_t off = values[i] - steps[k];
            if (off * off < nearest) {
                nearest = off * off;
                f->indices[i] = (uint8_t)k;
            }
        }
        f->error += (uint32_t)nearest;
        *left += values[i] - steps[f->indices[i]];
    }
}

static void try_table(const int32_t values[16], int eleven, int32_t table, int32_t times, int32_t middle, fit *best)
{
    fit f;
    int32_t left, base;
    f.table = table;
    f.times = times;
    base = middle - (tables[table][3] + tables[table][7]) * step_of(times, eleven) / 2;
    f.base = etc2_clamp(eleven ? (base < 0 ? 0 : base / 8) : base, 255);
    for (int round = 0; round < 3; round++) {
        select_all(values, eleven, &f, &left);
        if (f.error < best->error) *best = f;
        const int32_t sixteenths = eleven ? left / 8 : left;
        const int32_t moved = etc2_clamp(f.base + (sixteenths + (sixteenths < 0 ? -8 : 8)) / 16, 255);
        if (moved == f.base) break;
        f.base = moved;
    }
}

/* The error of a neighbouring block here. */
static uint64_t error_of(const int32_t values[16], int eleven, const uint8_t block[8])
{
    uint16_t got[16];
    uint64_t error = 0;
    noh_eac_decode(block, eleven, got);
    for (int i = 0; i < 16; i++) {
        const int64_t off = got[i % 4 * 4 + i / 4] - values[i];
        error += (uint64_t)(off * off);
    }
    return error;
}

/* Bits of a block that differs from its neighbours, when it is sent. */
#define BITS_OF_ITS_OWN 40u

void eac_encode(const int32_t values[16], int eleven, uint32_t bit_worth, const uint8_t *const beside[2],
                uint8_t block[8])
{
    fit best = { 0, 1, 0, { 0 }, UINT_MAX };
    int32_t low = values[0], high = values[0];
    uint64_t bits;
    for (int i = 1; i < 16; i++) {
        low = values[i] < low ? values[i] : low;
        high = values[i] > high ? values[i] : high;
    }
    for (int32_t table = 15; table >= 0 && best.error; table--) {
        const int32_t span = (tables[table][7] - tables[table][3]) * (eleven ? 8 : 1);
        const int32_t times = (2 * (high - low) + span) / (2 * span);
        for (int32_t t = times - 1; t <= times + 1 && best.error; t++) {
            if (t < (eleven ? 0 : 1) || t > 15) continue;
            try_table(values, eleven, table, t, (low + high) / 2, &best);
        }
    }
    bits = (uint64_t)best.base << 56 | (uint64_t)best.times << 52 | (uint64_t)best.table << 48;
    for (int i = 0; i < 16; i++) bits |= (uint64_t)best.indices[i] << (45 - 3 * i);
    for (int i = 0; i < 8; i++) block[i] = (uint8_t)(bits >> (56 - 8 * i));
    uint64_t most = best.error + (uint64_t)BITS_OF_ITS_OWN * bit_worth * (eleven ? 64u : 1u);
    for (int i = 0; i < 2; i++) {
        const uint64_t error = beside[i] ? error_of(values, eleven, beside[i]) : UINT64_MAX;
        if (error > most) continue;
        most = error ? error - 1u : 0;
        memcpy(block, beside[i], 8);
    }
}
