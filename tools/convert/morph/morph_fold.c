/* morph_fold.c: lays the line of vertices into the texture and improves it there.
 *
 * The texture is cut into strips of MORPH_STRIP_ROWS rows, and the line fills a strip column by column. Rectangles are
 * then a few texels high, which suits rasterisers: they shade 2x2 quads on GPUs and 4x4 blocks in software, so a run
 * one texel high would cost as much as one of two to four.
 *
 * A target needs every column that holds one of its vertices, so runs should start and stop where columns do. The line
 * is annealed once more, with that cost: short stretches are reversed and exchanged (2-opt and or-opt moves), and a
 * change is accepted if it costs nothing, else with a probability that falls with its cost and as the temperature
 * falls. The cost sums, over all columns, the targets that use them. A change affects only the columns of its stretch,
 * so `used` holds that set for every column, and `cost` what it costs: only the stretch is read again. */
#include "morph_internal.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH_LOG2_MIN 4u
#define WIDTH_LOG2_MAX 10u
#define STEPS_PER_VERTEX 200u
#define STEPS_MOST 1200000u /* divided by the words of a row */
#define STAGES 48u
#define STAGES_WARM 40u
#define STRETCH_MOST 96u /* vertices of the longest stretch that a step moves */
#define COST_MOST 1000u

typedef struct fold {
    const uint64_t *bits; /* of vertices */
    uint32_t *line;       /* place -> row of vertices */
    uint32_t count, words, rect_cost;
    uint32_t columns;
    uint32_t *first;  /* [columns + 1] column -> place */
    uint32_t *column; /* place -> column */
    uint8_t *starts;  /* the column is the first of its strip, or a gap precedes it */
    uint64_t *used;   /* [columns][words] the targets that move a vertex of a column */
    uint32_t *cost;   /* [columns + 1] */
    uint64_t *saved;  /* [STRETCH_MOST + 1][words] `used` of a stretch before it was moved, and `cost`: */
    uint32_t *saved_cost;
    morph_random random;
} fold;

/* Nearly square: tiled GPUs and software work in square tiles, whose empty rows cost too. */
void morph_fold_size(uint32_t touched, uint32_t *width_log2, uint32_t *height)
{
    uint32_t log2 = WIDTH_LOG2_MIN;
    while (log2 < WIDTH_LOG2_MAX && (uint64_t)1 << 2u * log2 < touched) log2++;
    *width_log2 = log2;
    *height = (uint32_t)(((uint64_t)touched + ((uint64_t)1 << log2) - 1u) >> log2);
}

/* ---- places ---- */

static uint32_t first_strip(const morph_region *r)
{
    return (r->first >> r->width_log2) & ~(MORPH_STRIP_ROWS - 1u);
}

static uint32_t end_row(const morph_region *r)
{
    return ((r->first + r->count - 1u) >> r->width_log2) + 1u;
}

static int has_texel(const morph_region *r, uint32_t texel)
{
    return texel >= r->first && texel - r->first < r->count;
}

/* The rows of a strip's column that lie in the region: its first and last row may be partly filled. */
static uint32_t rows_of_column(const morph_region *r, uint32_t y0, uint32_t x)
{
    uint32_t rows = 0;
    for (uint32_t y = y0; y < y0 + MORPH_STRIP_ROWS; y++) rows += (uint32_t)has_texel(r, (y << r->width_log2) + x);
    return rows;
}

static void find_columns(fold *f, const morph_region *r)
{
    uint32_t place = 0;
    for (uint32_t y0 = first_strip(r); y0 < end_row(r); y0 += MORPH_STRIP_ROWS) {
        int starts = 1;
        for (uint32_t x = 0; x < (uint32_t)1 << r->width_log2; x++) {
            const uint32_t rows = rows_of_column(r, y0, x);
            if (rows == 0u) {
                starts = 1;
                continue;
            }
            f->starts[f->columns] = (uint8_t)starts;
            starts = 0;
            f->first[f->columns] = place;
            for (uint32_t i = 0; i < rows; i++) f->column[place++] = f->columns;
            f->first[++f->columns] = place;
        }
    }
}

void morph_fold_order(const uint32_t *line, const morph_region *r, uint32_t *order)
{
    uint32_t place = 0;
    if (r->count == 0u) return;
    for (uint32_t y0 = first_strip(r); y0 < end_row(r); y0 += MORPH_STRIP_ROWS)
        for (uint32_t x = 0; x < (uint32_t)1 << r->width_log2; x++)
            for (uint32_t y = y0; y < y0 + MORPH_STRIP_ROWS; y++) {
                const uint32_t texel = (y << r->width_log2) + x;
                if (has_texel(r, texel)) order[texel - r->first] = line[place++];
            }
}

/* ---- the cost of some columns ---- */

/* Most meshes have at most 64 targets: with a known count of words, loops over them disappear. */
#if defined(__GNUC__)
#define FOLD_INLINE static inline __attribute__((always_inline))
#else
#define FOLD_INLINE static inline
#endif

/* A column's texels, and the rectangles that start there, summed over targets. */
FOLD_INLINE uint32_t column_cost(const fold *f, uint32_t c, uint32_t words)
{
    const uint64_t *here = f->used + (size_t)c * words, *before = f->starts[c] ? NULL : here - words;
    uint32_t texels = 0, rects = 0;
    for (uint32_t w = 0; w < words; w++) {
        texels += morph_popcount(here[w]);
        rects += morph_popcount(before ? here[w] & ~before[w] : here[w]);
    }
    return (f->first[c + 1u] - f->first[c]) * texels + rects * f->rect_cost;
}

/* Read the vertices of columns low to high. The column behind them starts other rectangles then. */
FOLD_INLINE void use_columns(fold *f, uint32_t low, uint32_t high, uint32_t words)
{
    for (uint32_t c = low; c <= high; c++) {
        for (uint32_t w = 0; w < words; w++) {
            uint64_t any = 0;
            for (uint32_t i = f->first[c]; i < f->first[c + 1u]; i++) any |= f->bits[(size_t)f->line[i] * words + w];
            f->used[(size_t)c * words + w] = any;
        }
        f->cost[c] = column_cost(f, c, words);
    }
    if (high + 1u < f->columns) f->cost[high + 1u] = column_cost(f, high + 1u, words);
}

/* Of columns low to high and the one behind them. */
static int64_t cost_of(const fold *f, uint32_t low, uint32_t high)
{
    int64_t sum = 0;
    for (uint32_t c = low; c <= high + 1u && c < f->columns; c++) sum += f->cost[c];
    return sum;
}

/* ---- annealing ---- */

static void turn(uint32_t *line, uint32_t low, uint32_t high)
{
    for (; low + 1u < high; low++, high--) {
        const uint32_t a = line[low];
        line[low] = line[high - 1u];
        line[high - 1u] = a;
    }
}

FOLD_INLINE int same_pattern(const fold *f, uint32_t a, uint32_t b, uint32_t words)
{
    const uint64_t *p = f->bits + (size_t)f->line[a] * words, *q = f->bits + (size_t)f->line[b] * words;
    uint32_t w = 0;
    while (w < words && p[w] == q[w]) w++;
    return w == words;
}

/* The next place at or after `at`, at most `limit`, where the pattern changes. */
FOLD_INLINE uint32_t next_change(const fold *f, uint32_t at, uint32_t limit, uint32_t words)
{
    while (at < limit && at > 0u && same_pattern(f, at - 1u, at, words)) at++;
    return at;
}

/* Reverse [a, c), or exchange [a, b) and [b, c): both consist of reversals, and are undone by reversals. */
FOLD_INLINE void step(fold *f, uint32_t odds, uint32_t words)
{
    uint32_t a = morph_random_below(&f->random, f->count), b, c, limit, low, high;
    const uint32_t kind = morph_random_below(&f->random, 4u);
    size_t bytes, costs;
    int64_t old;
    limit = a + STRETCH_MOST < f->count ? a + STRETCH_MOST : f->count;
    if (kind & 1u) a = next_change(f, a, limit, words);
    b = a + 1u + morph_random_below(&f->random, STRETCH_MOST / 2u);
    if (b >= limit) return;
    if (kind & 1u) b = next_change(f, b, limit, words);
    c = b + 1u + morph_random_below(&f->random, STRETCH_MOST / 2u);
    if (c > limit) c = limit;
    if (kind & 1u && c < limit) c = next_change(f, c, limit, words);
    if (b >= c) return;
    if (kind & 2u) b = c;
    low = f->column[a];
    high = f->column[c - 1u];
    bytes = (size_t)(high - low + 1u) * words * sizeof *f->used;
    costs = (size_t)(high - low + 2u) * sizeof *f->cost;
    old = cost_of(f, low, high);
    memcpy(f->saved, f->used + (size_t)low * words, bytes);
    memcpy(f->saved_cost, f->cost + low, costs);
    turn(f->line, a, b);
    turn(f->line, b, c);
    if (b < c) turn(f->line, a, c);
    use_columns(f, low, high, words);
    if (morph_accepts(&f->random, cost_of(f, low, high) - old, odds)) return;
    memcpy(f->used + (size_t)low * words, f->saved, bytes);
    memcpy(f->cost + low, f->saved_cost, costs);
    if (b < c) turn(f->line, a, c);
    turn(f->line, b, c);
    turn(f->line, a, b);
}

/* The temperature falls from a third of a texel to about zero, then is zero: these are repairs, and a warmer start
 * would only undo the order that came in. */
static void settle(fold *f)
{
    uint64_t steps = (uint64_t)STEPS_PER_VERTEX * f->count;
    uint32_t heat = ((uint32_t)1 << MORPH_HEAT_BITS) / 3u;
    if (steps > STEPS_MOST / f->words) steps = STEPS_MOST / f->words;
    for (uint32_t stage = 0; stage < STAGES; stage++) {
        const uint32_t odds = stage < STAGES_WARM ? morph_odds(heat) : 0u;
        for (uint64_t s = 0; s < steps / STAGES; s++) {
            if (f->words == 1u)
                step(f, odds, 1u);
            else
                step(f, odds, f->words);
        }
        heat -= heat / 12u;
    }
}

/* For big meshes the steps may end too early: keep the order that came in if it is the better one. */
static int settle_or_leave(fold *f)
{
    const size_t bytes = f->count * sizeof *f->line;
    int64_t before;
    uint32_t *old = morph_alloc(f->count, sizeof *old);
    if (!old) return 1;
    memcpy(old, f->line, bytes);
    use_columns(f, 0, f->columns - 1u, f->words);
    before = cost_of(f, 0, f->columns - 1u);
    settle(f);
    if (cost_of(f, 0, f->columns - 1u) > before) memcpy(f->line, old, bytes);
    free(old);
    return 0;
}

static size_t most_columns(const morph_region *r)
{
    return (size_t)((end_row(r) - first_strip(r) + MORPH_STRIP_ROWS - 1u) / MORPH_STRIP_ROWS) << r->width_log2;
}

int morph_fold_settle(const morph_bits *vertices, const morph_region *region, float rect_cost, uint32_t *line)
{
    fold f;
    int failed;
    if (vertices->rows == 0u) return 0;
    memset(&f, 0, sizeof f);
    f.bits = vertices->bits;
    f.line = line;
    f.count = vertices->rows;
    f.words = vertices->words;
    f.rect_cost = rect_cost < 1.0f ? 1u : rect_cost > (float)COST_MOST ? COST_MOST : (uint32_t)(rect_cost + 0.5f);
    f.random = MORPH_RANDOM_SEED;
    f.first = morph_alloc(most_columns(region) + 1u, sizeof *f.first);
    f.column = morph_alloc(f.count, sizeof *f.column);
    f.starts = morph_alloc(most_columns(region), sizeof *f.starts);
    f.used = morph_alloc(most_columns(region) * f.words, sizeof *f.used);
    f.cost = morph_alloc(most_columns(region) + 1u, sizeof *f.cost);
    f.saved = morph_alloc((STRETCH_MOST + 1u) * (size_t)f.words, sizeof *f.saved);
    f.saved_cost = morph_alloc(STRETCH_MOST + 2u, sizeof *f.saved_cost);
    failed = !f.first || !f.column || !f.starts || !f.used || !f.cost || !f.saved || !f.saved_cost;
    if (!failed) {
        find_columns(&f, region);
        failed = settle_or_leave(&f);
    }
    free(f.first);
    free(f.column);
    free(f.starts);
    free(f.used);
    free(f.cost);
    free(f.saved);
    free(f.saved_cost);
    return failed;
}
