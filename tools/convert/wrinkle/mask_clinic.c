#include "mask_clinic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EMPTY 0u /* classes of codes: no region, region 1 to 3 of the channel, guard band */
#define GUARD 4u

static uint32_t class_of(uint8_t code)
{
    return code == 0 ? EMPTY : region_is_guard(code) ? GUARD : 1u + region_of_code(code);
}

static uint8_t code_at(const region_mask *m, uint32_t x, uint32_t y, uint32_t channel)
{
    return m->rgba[4 * ((size_t)y * m->width + x) + channel];
}

/* ---- seams ---- */

/* Half of a texel's neighbours; the other half lies opposite. */
static const int ways[4][2] = { { 1, 0 }, { 0, 1 }, { 1, 1 }, { 1, -1 } };

/* The two neighbours of a texel along a way, the lower code first; 0 at the border. */
static int neighbours(const region_mask *m, uint32_t x, uint32_t y, uint32_t c, const int *way, uint8_t pair[2])
{
    const int64_t dx = way[0], dy = way[1], left = (int64_t)x - dx, right = (int64_t)x + dx;
    const int64_t up = (int64_t)y - dy, down = (int64_t)y + dy;
    uint8_t a, b;
    if (left < 0 || right >= m->width || up < 0 || down < 0 || up >= m->height || down >= m->height) {
        return 0;
    }
    a = code_at(m, (uint32_t)left, (uint32_t)up, c);
    b = code_at(m, (uint32_t)right, (uint32_t)down, c);
    pair[0] = a < b ? a : b;
    pair[1] = a < b ? b : a;
    return 1;
}

/* Whether a texel is a filter's value between two regions; *pair then has the two that are farthest apart. */
static int is_seam(const region_mask *m, uint32_t x, uint32_t y, uint32_t c, uint8_t pair[2])
{
    const uint8_t code = code_at(m, x, y, c);
    const uint32_t own = class_of(code);
    int widest = 0;
    for (int w = 0; w < 4 && code; w++) {
        uint8_t p[2];
        if (neighbours(m, x, y, c, ways[w], p) && p[0] < code && code < p[1] && class_of(p[0]) != own &&
            class_of(p[1]) != own && p[1] - p[0] > widest) {
            widest = p[1] - p[0];
            memcpy(pair, p, 2);
        }
    }
    return widest > 0;
}

static int is_edge(const region_mask *m, uint32_t x, uint32_t y, uint32_t c)
{
    const uint32_t own = class_of(code_at(m, x, y, c));
    return (x + 1 < m->width && class_of(code_at(m, x + 1, y, c)) != own) ||
           (y + 1 < m->height && class_of(code_at(m, x, y + 1, c)) != own);
}

static void count_seams(const region_mask *m, mask_findings *f)
{
    uint8_t pair[2];
    for (uint32_t y = 0; y < m->height; y++) {
        for (uint32_t i = 0; i < 4 * m->width; i++) {
            f->seams[i % 4] += (uint32_t)is_seam(m, i / 4, y, i % 4, pair);
            f->edges[i % 4] += (uint32_t)is_edge(m, i / 4, y, i % 4);
        }
    }
}

/* ---- codes ---- */

/* Whether a texel is inside an area of one code. */
static int is_even(const region_mask *m, uint32_t x, uint32_t y, uint32_t c)
{
    const uint8_t code = code_at(m, x, y, c);
    if (!code || x == 0 || y == 0 || x + 1 == m->width || y + 1 == m->height) {
        return 0;
    }
    for (uint32_t i = 0; i < 9; i++) {
        if (code_at(m, x + i % 3 - 1, y + i / 3 - 1, c) != code) return 0;
    }
    return 1;
}

static int is_full(uint8_t code)
{
    return !region_is_guard(code) && code % REGION_STEP >= REGION_FULL;
}

static void count_region(mask_region *r, uint32_t x, uint32_t y, float weight)
{
    r->left = r->texels && r->left < x ? r->left : x;
    r->top = r->texels && r->top < y ? r->top : y;
    r->right = r->texels && r->right > x ? r->right : x;
    r->bottom = r->texels && r->bottom > y ? r->bottom : y;
    r->texels++;
    r->full += weight >= 1.0f;
}

static void count_codes(const region_mask *m, mask_findings *f, uint32_t even[4][256])
{
    double sums[REGION_COUNT] = { 0 };
    for (uint32_t y = 0; y < m->height; y++) {
        for (uint32_t i = 0; i < 4 * m->width; i++) {
            const uint32_t x = i / 4, c = i % 4;
            const uint8_t code = code_at(m, x, y, c);
            const uint32_t region = 3 * c + region_of_code(code);
            const float weight = region_weight(code);
            f->histogram[c][code]++;
            f->guard[c] += (uint32_t)region_is_guard(code);
            even[c][code] += (uint32_t)is_even(m, x, y, c);
            if (weight > 0.0f) {
                count_region(&f->regions[region], x, y, weight);
                sums[region] += (double)weight;
            }
        }
    }
    for (uint32_t r = 0; r < REGION_COUNT; r++) {
        f->regions[r].mean = f->regions[r].texels ? (float)(sums[r] / (double)f->regions[r].texels) : 0.0f;
    }
    for (uint32_t i = 0; i < 4 * 256; i++) {
        f->even[i / 256] += even[i / 256][i % 256];
        f->even_full[i / 256] += is_full((uint8_t)(i % 256)) ? even[i / 256][i % 256] : 0;
    }
}

/* ---- curves ---- */

typedef struct curve {
    const char *name;
    double exponent; /* of a power; 0: to sRGB, -1: from it */
} curve;

static const curve curves[] = {
    { "linear data read as sRGB (brighter)", 0.0 },
    { "sRGB data read as linear (darker)", -1.0 },
    { "a power of 1/2.2", 1.0 / 2.2 },
    { "a power of 2.2", 2.2 },
    { "a power of 1/1.8", 1.0 / 1.8 },
    { "a power of 1.8", 1.8 },
    { "a power of 1.8/2.2", 1.8 / 2.2 },
    { "a power of 2.2/1.8", 2.2 / 1.8 },
};
#define CURVE_COUNT (sizeof curves / sizeof curves[0])

static double bend(const curve *by, double v)
{
    if (by->exponent > 0.0) {
        return pow(v, by->exponent);
    }
    if (by->exponent < 0.0) {
        return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    }
    return v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}

/* The legal code that a curve brings nearest to each value, the one of more weight where it brings several there; and
 * how far off that is. */
static void undo_table(const curve *by, uint8_t codes[256], double off[256])
{
    for (int value = 0; value < 256; value++) {
        off[value] = 1e9;
        for (int code = 0; code < 256; code++) {
            const double made = by ? floor(255.0 * bend(by, code / 255.0) + 0.5) : code;
            if (!region_is_guard((uint8_t)code) && fabs(made - value) <= off[value]) {
                off[value] = fabs(made - value);
                codes[value] = (uint8_t)code;
            }
        }
    }
    codes[0] = 0;
}

/* The faults of a mask once a curve is undone: texels that no legal code explains, and even ones without full
 * weight, of those that are not empty. by NULL: as it is. */
static double wrong_share(const mask_findings *f, uint32_t even[4][256], const curve *by)
{
    uint8_t codes[256];
    double off[256], wrong = 0.0, all = 0.0;
    undo_table(by, codes, off);
    for (uint32_t c = 0; c < 4; c++) {
        for (uint32_t v = 1; v < 256; v++) {
            const int unknown = off[v] > (by ? 1.0 : 0.0);
            all += f->histogram[c][v];
            wrong += unknown ? f->histogram[c][v] : is_full(codes[v]) ? 0 : even[c][v];
        }
    }
    return all > 0.0 ? wrong / all : 0.0;
}

#define EVEN_LEAST 16u /* fewer texels inside even areas say nothing about a curve */

static void find_gamma(mask_findings *f, uint32_t even[4][256])
{
    const double before = wrong_share(f, even, NULL);
    double least = before / 4.0;
    const uint32_t inside = f->even[0] + f->even[1] + f->even[2] + f->even[3];
    for (size_t i = 0; i < CURVE_COUNT && before > 0.02 && inside >= EVEN_LEAST; i++) {
        const double share = wrong_share(f, even, &curves[i]);
        if (share < least) {
            least = share;
            f->gamma = curves[i].name;
            f->damage |= MASK_GAMMA;
        }
    }
}

static const curve *curve_of(const mask_findings *f)
{
    for (size_t i = 0; i < CURVE_COUNT; i++) {
        if (f->gamma && strcmp(curves[i].name, f->gamma) == 0) return &curves[i];
    }
    return NULL;
}

static void undo_curve(region_mask *m, const curve *by)
{
    uint8_t codes[256];
    double off[256];
    undo_table(by, codes, off);
    for (size_t i = 0; i < 4 * (size_t)m->width * m->height; i++) {
        m->rgba[i] = codes[m->rgba[i]];
    }
}

/* ---- blocks ---- */

/* The different values of a channel in a block, rising. */
static int block_values(const region_mask *m, uint32_t x, uint32_t y, uint32_t c, uint8_t values[16])
{
    int count = 0;
    for (uint32_t i = 0; i < 16; i++) {
        const uint8_t code = code_at(m, x + i % 4, y + i / 4, c);
        int at = 0;
        while (at < count && values[at] < code) at++;
        if (at == count || values[at] != code) {
            memmove(&values[at + 1], &values[at], (size_t)(count - at));
            values[at] = code;
            count++;
        }
    }
    return count;
}

static int end_point(int step, int bits)
{
    return bits == 5 ? step << 3 | step >> 2 : step << 2 | step >> 4;
}

static int fits(const uint8_t *values, int count, int low, int high)
{
    for (int i = 0; i < count; i++) {
        int nearest = 256;
        for (int third = 0; third <= 3; third++) {
            const int off = abs((3 * low + third * (high - low) + 1) / 3 - values[i]);
            nearest = off < nearest ? off : nearest;
        }
        if (nearest > (values[i] == low || values[i] == high ? 0 : 1)) return 0;
    }
    return 1;
}

/* Whether two end points of `bits` bits, and thirds between them, give these values. */
static int is_stored(const uint8_t *values, int count, int bits)
{
    for (int a = 0; a < 1 << bits && count <= 4; a++) {
        for (int b = a; b < 1 << bits && end_point(a, bits) <= values[0]; b++) {
            if (end_point(b, bits) >= values[count - 1] &&
                fits(values, count, end_point(a, bits), end_point(b, bits))) {
                return 1;
            }
        }
    }
    return 0;
}

/* A block counts if a channel has three values or more: good compressors store any two. */
static void count_blocks(const region_mask *m, mask_findings *f)
{
    for (uint32_t y = 0; y + 4 <= m->height; y += 4) {
        for (uint32_t x = 0; x + 4 <= m->width; x += 4) {
            int tells = 0, stored = 1;
            for (uint32_t c = 0; c < 3; c++) {
                uint8_t values[16];
                const int count = block_values(m, x, y, c, values);
                tells |= count > 2;
                stored = stored && (count <= 2 || is_stored(values, count, c == 1 ? 6 : 5));
            }
            f->blocks += (uint32_t)tells;
            f->blocks_stored += (uint32_t)(tells && stored);
        }
    }
}

/* Without a telling block: whether all even colours are end points, as a simple compressor leaves them. */
static int on_end_points(const mask_findings *f, uint32_t even[4][256])
{
    uint32_t all = 0, on = 0;
    for (uint32_t c = 0; c < 3; c++) {
        const int bits = c == 1 ? 6 : 5;
        for (int step = 1; step < 1 << bits; step++) {
            on += even[c][end_point(step, bits)];
        }
        all += f->even[c];
    }
    return all > 0 && on == all;
}

static void find_blocks(const region_mask *m, mask_findings *f, uint32_t even[4][256])
{
    uint32_t guard = 0;
    for (uint32_t c = 0; c < 4; c++) {
        guard += f->guard[c];
    }
    count_blocks(m, f);
    if (guard && (f->blocks >= 8 ? f->blocks_stored >= f->blocks - f->blocks / 20 : on_end_points(f, even))) {
        f->damage |= MASK_BLOCKS;
    }
}

/* ---- all of it ---- */

static int copy_mask(const region_mask *m, region_mask *copy)
{
    const size_t bytes = 4 * (size_t)m->width * m->height;
    *copy = *m;
    copy->rgba = malloc(bytes ? bytes : 1);
    if (!copy->rgba) {
        return 1;
    }
    memcpy(copy->rgba, m->rgba, bytes);
    return 0;
}

static void find_seams(const region_mask *m, mask_findings *f)
{
    uint32_t seams = 0, edges = 0;
    count_seams(m, f);
    for (uint32_t c = 0; c < 4; c++) {
        seams += f->seams[c];
        edges += f->edges[c];
    }
    if (!(f->damage & MASK_BLOCKS) && seams >= 4 && seams >= edges / 50) {
        f->damage |= MASK_SMOOTHED;
    }
}

int mask_examine(const region_mask *mask, mask_findings *f)
{
    uint32_t even[4][256] = { { 0 } };
    region_mask copy;
    memset(f, 0, sizeof *f);
    if (copy_mask(mask, &copy)) {
        return 1;
    }
    count_codes(mask, f, even);
    find_blocks(mask, f, even);
    if (!(f->damage & MASK_BLOCKS)) {
        find_gamma(f, even);
    }
    if (f->damage & MASK_GAMMA) {
        undo_curve(&copy, curve_of(f));
    }
    find_seams(&copy, f);
    region_mask_free(&copy);
    return 0;
}

/* ---- repair ---- */

/* The nearest code that is in no guard band, if it is at most `reach` off. */
static uint8_t snap(uint8_t code, uint32_t reach)
{
    const uint32_t low = code - (code % REGION_STEP - REGION_LAST), high = (code / REGION_STEP + 1) * REGION_STEP;
    if (!region_is_guard(code)) {
        return code;
    }
    if (code - low <= high - code) {
        return (uint8_t)(code - low <= reach ? low : code);
    }
    return (uint8_t)(high - code <= reach ? high : code);
}

static void snap_all(region_mask *m, uint32_t reach)
{
    for (size_t i = 0; i < 4 * (size_t)m->width * m->height; i++) {
        m->rgba[i] = snap(m->rgba[i], reach);
    }
}

/* What a filter made of two codes, as the painter meant it: an edge between a region and none keeps its
 * share of the region; an edge between two regions goes to the nearer one. */
static uint8_t unmixed(uint8_t code, const uint8_t pair[2])
{
    const uint32_t high = snap(pair[1], 255), region = high / REGION_STEP, offset = high % REGION_STEP;
    if (pair[0] == 0) {
        return (uint8_t)(region * REGION_STEP + (offset * code + pair[1] / 2u) / pair[1]);
    }
    return pair[1] - code <= code - pair[0] ? (uint8_t)high : snap(pair[0], 255);
}

/* Seams as wide as `from` shows them, one texel each side, read from one mask and written to another. */
static void mend_seams(region_mask *to, const region_mask *from)
{
    for (uint32_t y = 0; y < to->height; y++) {
        for (uint32_t i = 0; i < 4 * to->width; i++) {
            uint8_t pair[2];
            if (is_seam(from, i / 4, y, i % 4, pair)) {
                to->rgba[4 * (size_t)y * to->width + i] = unmixed(code_at(from, i / 4, y, i % 4), pair);
            }
        }
    }
}

static uint32_t count_changes(const region_mask *a, const region_mask *b)
{
    uint32_t count = 0;
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        count += memcmp(&a->rgba[4 * i], &b->rgba[4 * i], 4) != 0;
    }
    return count;
}

#define PASSES 3 /* the widest seam of a filter on each side, texels */

uint32_t mask_repair(region_mask *mask, const mask_findings *findings)
{
    const size_t bytes = 4 * (size_t)mask->width * mask->height;
    region_mask before, work;
    uint32_t changed;
    if (copy_mask(mask, &before)) {
        return UINT32_MAX;
    }
    if (copy_mask(mask, &work)) {
        region_mask_free(&before);
        return UINT32_MAX;
    }
    if (curve_of(findings)) {
        undo_curve(mask, curve_of(findings));
    }
    snap_all(mask, 3);
    for (int pass = 0; pass < PASSES && (findings->damage & (MASK_SMOOTHED | MASK_BLOCKS)); pass++) {
        memcpy(work.rgba, mask->rgba, bytes);
        mend_seams(mask, &work);
    }
    snap_all(mask, 255);
    changed = count_changes(mask, &before);
    region_mask_free(&before);
    region_mask_free(&work);
    return changed;
}

/* ---- the picture ---- */

static void show_texel(const region_mask *m, uint32_t x, uint32_t y, uint8_t *out)
{
    int guard = 0, seam = 0;
    uint8_t pair[2], largest = 0;
    for (uint32_t c = 0; c < 4; c++) {
        const uint8_t code = code_at(m, x, y, c), weight = region_weight_byte(code);
        guard |= region_is_guard(code);
        seam |= is_seam(m, x, y, c, pair);
        largest = weight > largest ? weight : largest;
    }
    out[0] = guard || seam ? 255 : (uint8_t)(32 + largest / 2);
    out[1] = guard ? 0 : seam ? 220 : out[0];
    out[2] = guard || seam ? 0 : out[0];
    out[3] = 255;
}

uint8_t *mask_show(const region_mask *mask)
{
    uint8_t *picture = model_zeros((size_t)mask->width * mask->height, 4);
    for (uint32_t y = 0; y < mask->height && picture; y++) {
        for (uint32_t x = 0; x < mask->width; x++) {
            show_texel(mask, x, y, picture + 4 * ((size_t)y * mask->width + x));
        }
    }
    return picture;
}
