/* morph_patterns.c: groups vertices that exactly the same targets move.
 *
 * A face has few such groups (a head with 2,966 touched vertices has 318), and no good order separates vertices of one
 * group, so groups are ordered instead of vertices. The rows of bits are merge-sorted, which makes equal ones
 * neighbours. */
#include "morph_internal.h"

#include <stdlib.h>
#include <string.h>

void *morph_alloc(size_t count, size_t size)
{
    if (size != 0u && count > (size_t)-1 / size) return NULL;
    return calloc(count ? count : 1u, size ? size : 1u);
}

static int compare_rows(const morph_bits *b, uint32_t x, uint32_t y)
{
    const uint64_t *p = morph_row(b, x), *q = morph_row(b, y);
    for (uint32_t w = 0; w < b->words; w++)
        if (p[w] != q[w]) return p[w] < q[w] ? -1 : 1;
    return 0;
}

static void merge(const morph_bits *b, const uint32_t *from, uint32_t *to, uint32_t low, uint32_t middle, uint32_t high)
{
    uint32_t i = low, j = middle;
    for (uint32_t k = low; k < high; k++) {
        const int left = i < middle && (j >= high || compare_rows(b, from[i], from[j]) <= 0);
        to[k] = left ? from[i++] : from[j++];
    }
}

/* Merge sort, bottom-up and stable; qsort's order of equal keys differs between C libraries. Returns the one of the two
 * arrays that holds the result. */
static uint32_t *sort_rows(const morph_bits *b, uint32_t *a, uint32_t *spare)
{
    for (uint32_t size = 1; size < b->rows; size *= 2u) {
        uint32_t *swap = a;
        for (uint32_t low = 0; low < b->rows; low += 2u * size) {
            const uint32_t middle = low + size < b->rows ? low + size : b->rows;
            const uint32_t high = middle + size < b->rows ? middle + size : b->rows;
            merge(b, a, spare, low, middle, high);
        }
        a = spare;
        spare = swap;
    }
    return a;
}

static void group(morph_patterns *p, const morph_bits *vertices, const uint32_t *sorted)
{
    const size_t row_bytes = vertices->words * sizeof(uint64_t);
    for (uint32_t i = 0; i < vertices->rows; i++) {
        p->members[i] = sorted[i];
        if (i == 0u || compare_rows(vertices, sorted[i - 1u], sorted[i]) != 0) {
            memcpy(p->bits.bits + (size_t)p->count * vertices->words, morph_row(vertices, sorted[i]), row_bytes);
            p->first[p->count++] = i;
        }
    }
    p->first[p->count] = vertices->rows;
    p->bits.rows = p->count;
}

int morph_patterns_init(morph_patterns *p, const morph_bits *vertices)
{
    uint32_t *a = morph_alloc(vertices->rows, sizeof *a), *b = morph_alloc(vertices->rows, sizeof *b);
    memset(p, 0, sizeof *p);
    p->bits.words = vertices->words;
    p->bits.bits = morph_alloc((size_t)vertices->rows * vertices->words, sizeof *p->bits.bits);
    p->first = morph_alloc((size_t)vertices->rows + 1u, sizeof *p->first);
    p->members = morph_alloc(vertices->rows, sizeof *p->members);
    if (!a || !b || !p->bits.bits || !p->first || !p->members) {
        free(a);
        free(b);
        morph_patterns_free(p);
        return 1;
    }
    for (uint32_t i = 0; i < vertices->rows; i++) a[i] = i;
    group(p, vertices, sort_rows(vertices, a, b));
    free(a);
    free(b);
    return 0;
}

void morph_patterns_free(morph_patterns *p)
{
    free(p->bits.bits);
    free(p->first);
    free(p->members);
    memset(p, 0, sizeof *p);
}
