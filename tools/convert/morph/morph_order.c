/* morph_order.c: a line of patterns along which targets rarely start or stop.
 *
 * Vertices that exactly the same targets move form a pattern. A target's vertices along the line form runs, and a run
 * becomes a rectangle. A gap of g vertices between two runs costs min(g, gap_max) texels: it is filled with zeros, or a
 * new rectangle starts, whichever is cheaper. Finding the line of least cost is a travelling-salesman problem, with a
 * pattern for each city and about the Hamming distance between them; it is solved as such problems are: a
 * nearest-neighbour tour, then 2-opt reversals accepted by simulated annealing (Kirkpatrick, Gelatt and Vecchi,
 * "Optimization by Simulated Annealing", 1983).
 *
 * A reversal is judged in constant time. With c(t, p) the distance from a cut to the nearest vertex of target t on
 * side p of it, two sides that lie together save max(0, gap_max - c(t, left) - c(t, right)) against lying far apart,
 * and nothing else depends on the cut. Reversing a stretch changes the two cuts at its ends and no other, so the change
 * of cost is the difference of four such sums, each a few words of bits.
 *
 * Costs are integers and random numbers come from a fixed sequence without libm, so every machine takes the same
 * decisions and writes the same bytes. */
#include "morph_internal.h"

#include <stdlib.h>
#include <string.h>

#define GAP_LIMIT 8u   /* a larger one takes longer and gains nothing */
#define GAP_MORE 2u    /* in addition to its cost a rectangle has ragged ends: empty texels in a column */
#define NEIGHBOURS 10u /* nearest patterns of each, the partners tried */
/* candidates looked at for a nearest pattern: patterns are sorted, so they are the likeliest */
#define SCAN_MOST 6000u
#define REVERSE_MOST 1000u /* patterns: longer reversals of big meshes cost more than they bring */
#define STEPS_PER_PATTERN 2000u
#define STEPS_MOST 2000000u /* divided by the words of a row */
#define STAGES 64u          /* temperatures */

typedef struct line {
    const morph_patterns *patterns;
    uint32_t count, words, gap_max, neighbours;
    uint32_t *path;      /* place -> pattern */
    uint32_t *place;     /* pattern -> place */
    uint32_t *neighbour; /* [count][neighbours] */
    uint64_t *side[4];   /* [gap_max][words]: targets within 1, 2, ... vertices of a cut's side */
    morph_random random;
} line;

static const uint64_t *pattern_bits(const line *l, uint32_t pattern)
{
    return morph_row(&l->patterns->bits, pattern);
}

static uint32_t pattern_size(const line *l, uint32_t pattern)
{
    return l->patterns->first[pattern + 1u] - l->patterns->first[pattern];
}

static uint32_t distance(const line *l, uint32_t a, uint32_t b)
{
    const uint64_t *p = pattern_bits(l, a), *q = pattern_bits(l, b);
    uint32_t d = 0;
    for (uint32_t w = 0; w < l->words; w++) d += morph_popcount(p[w] ^ q[w]);
    return d;
}

/* ---- the first tour ---- */

static void nearest_neighbour_path(line *l)
{
    for (uint32_t i = 0; i < l->count; i++) l->path[i] = i;
    for (uint32_t i = 1; i < l->count; i++) {
        const uint32_t end = l->count - i < SCAN_MOST ? l->count : i + SCAN_MOST;
        uint32_t best = i, least = UINT32_MAX, pattern;
        for (uint32_t j = i; j < end; j++) {
            const uint32_t d = distance(l, l->path[i - 1u], l->path[j]);
            if (d >= least) continue;
            least = d;
            best = j;
        }
        pattern = l->path[best];
        l->path[best] = l->path[i];
        l->path[i] = pattern;
    }
    for (uint32_t i = 0; i < l->count; i++) l->place[l->path[i]] = i;
}

/* The nearest patterns of `a`, by insertion; ties go to the lower index. */
static void find_neighbours(line *l, uint32_t a)
{
    uint32_t far[NEIGHBOURS], found = 0;
    uint32_t *list = l->neighbour + (size_t)a * l->neighbours;
    const uint32_t start = a > SCAN_MOST / 2u ? a - SCAN_MOST / 2u : 0u;
    const uint32_t end = l->count - start < SCAN_MOST ? l->count : start + SCAN_MOST;
    for (uint32_t b = start; b < end; b++) {
        const uint32_t d = b == a ? UINT32_MAX : distance(l, a, b);
        uint32_t at;
        if (b == a || (found == l->neighbours && d >= far[found - 1u])) continue;
        if (found < l->neighbours) found++;
        for (at = found - 1u; at > 0u && far[at - 1u] > d; at--) {
            far[at] = far[at - 1u];
            list[at] = list[at - 1u];
        }
        far[at] = d;
        list[at] = b;
    }
}

/* ---- the cost of a reversal ---- */

/* side[k] = the targets of the k + 1 vertices from place `at` in direction `step`; beyond the ends there are none. */
static void look_aside(const line *l, uint32_t at, uint32_t step, uint64_t *side)
{
    uint32_t k = 0;
    while (k < l->gap_max) {
        const int ended = at >= l->count; /* also for -1 */
        uint32_t size = ended ? l->gap_max : pattern_size(l, l->path[at]);
        if (size > l->gap_max - k) size = l->gap_max - k;
        for (uint32_t end = k + size; k < end; k++)
            for (uint32_t w = 0; w < l->words; w++)
                side[k * l->words + w] = (k ? side[(k - 1u) * l->words + w] : 0u) |
                                         (ended ? 0u : pattern_bits(l, l->path[at])[w]);
        at += step;
    }
}

/* The counts of targets in one word whose gap is at most 0, 1, ... gap_max - 1, summed: the saving of the two sides. */
static uint32_t saved_word(const line *l, const uint64_t *left, const uint64_t *right)
{
    const uint64_t far_left = left[(size_t)(l->gap_max - 1u) * l->words],
                   far_right = right[(size_t)(l->gap_max - 1u) * l->words];
    uint32_t sum = 0;
    if (!(far_left & far_right)) return 0;
    if (left[0] == far_left && right[0] == far_right) return l->gap_max * morph_popcount(far_left & far_right);
    for (uint32_t most = 0; most < l->gap_max; most++) {
        uint64_t near = left[0] & right[(size_t)most * l->words];
        for (uint32_t k = 1; k <= most; k++) near |= left[(size_t)k * l->words] & right[(size_t)(most - k) * l->words];
        sum += morph_popcount(near);
    }
    return sum;
}

/* The saving of placing the two sides together: texels, summed over targets. */
static uint32_t saved(const line *l, const uint64_t *left, const uint64_t *right)
{
    uint32_t sum = 0;
    for (uint32_t w = 0; w < l->words; w++) sum += saved_word(l, left + w, right + w);
    return sum;
}

/* The change of cost when path[low..high] is reversed. For a stretch shorter than gap_max the result is inexact,
 * because its ends see past it; that costs quality, not correctness. */
static int32_t change(line *l, uint32_t low, uint32_t high)
{
    look_aside(l, low - 1u, (uint32_t)-1, l->side[0]);
    look_aside(l, low, 1u, l->side[1]);
    look_aside(l, high, (uint32_t)-1, l->side[2]);
    look_aside(l, high + 1u, 1u, l->side[3]);
    return (int32_t)(saved(l, l->side[0], l->side[1]) + saved(l, l->side[2], l->side[3])) -
           (int32_t)(saved(l, l->side[0], l->side[2]) + saved(l, l->side[1], l->side[3]));
}

static void reverse(line *l, uint32_t low, uint32_t high)
{
    for (; low < high; low++, high--) {
        const uint32_t a = l->path[low], b = l->path[high];
        l->path[low] = b;
        l->place[b] = low;
        l->path[high] = a;
        l->place[a] = high;
    }
}

/* ---- annealing ---- */

static void try_reversal(line *l, uint32_t odds)
{
    const uint32_t a = morph_random_below(&l->random, l->count);
    const uint32_t b = l->neighbour[(size_t)a * l->neighbours + morph_random_below(&l->random, l->neighbours)];
    const uint32_t i = l->place[a], j = l->place[b], after = morph_random32(&l->random) & 1u;
    uint32_t low = i < j ? i : j, high = i < j ? j : i;
    if (after)
        low++;
    else
        high--;
    if (low >= high || high - low > REVERSE_MOST) return;
    if (morph_accepts(&l->random, change(l, low, high), odds)) reverse(l, low, high);
}

/* The temperature falls geometrically from gap_max to a tenth of it. */
static void anneal(line *l)
{
    uint64_t steps = (uint64_t)STEPS_PER_PATTERN * l->count;
    uint32_t heat = l->gap_max << MORPH_HEAT_BITS;
    if (steps > STEPS_MOST / l->words) steps = STEPS_MOST / l->words;
    for (uint32_t stage = 0; stage < STAGES; stage++) {
        const uint32_t odds = morph_odds(heat);
        for (uint64_t s = 0; s < steps / STAGES; s++) try_reversal(l, odds);
        heat -= heat / 28u; /* (27/28)^64 = 1/10.2 */
    }
}

static int line_init(line *l)
{
    l->neighbours = l->count - 1u < NEIGHBOURS ? l->count - 1u : NEIGHBOURS;
    l->place = morph_alloc(l->count, sizeof *l->place);
    l->neighbour = morph_alloc((size_t)l->count * l->neighbours, sizeof *l->neighbour);
    for (uint32_t i = 0; i < 4u; i++) {
        l->side[i] = morph_alloc((size_t)l->gap_max * l->words, sizeof *l->side[i]);
        if (!l->side[i]) return 1;
    }
    return !l->place || !l->neighbour;
}

int morph_order_path(const morph_patterns *patterns, float rect_cost, uint32_t *path)
{
    line l;
    int failed;
    if (patterns->count == 0u) return 0;
    memset(&l, 0, sizeof l);
    l.patterns = patterns;
    l.count = patterns->count;
    l.words = patterns->bits.words;
    l.gap_max = rect_cost + (float)GAP_MORE < (float)GAP_LIMIT ? (uint32_t)(rect_cost + (float)GAP_MORE) : GAP_LIMIT;
    l.path = path;
    l.random = MORPH_RANDOM_SEED;
    failed = line_init(&l);
    if (!failed) {
        nearest_neighbour_path(&l);
        for (uint32_t a = 0; a < l.count; a++) find_neighbours(&l, a);
        if (l.count > 2u) anneal(&l);
    }
    free(l.place);
    free(l.neighbour);
    for (uint32_t i = 0; i < 4u; i++) free(l.side[i]);
    return failed;
}
