/* morph_bands.c: the start of a cover: each band of rows, cut into boxes at least cost.
 *
 * A band is `rows` texture rows. Its used columns are cut into stretches, each covered by the bounding box of its
 * texels. The best cut of the first n columns is the best cut of some first m < n and one box over the rest, so dynamic
 * programming over n finds the exact minimum of area plus the rectangles' cost. The search for m ends at a box that is
 * mostly empty. Boxes of different bands are joined later (morph_rects.c). */
#include "morph_internal.h"

#include <stdlib.h>

/* A box with more empty texels than this many rectangles cost is never tried. */
#define WASTE_MOST 16.0

typedef struct band_column {
    uint32_t x, top, bottom, texels; /* bottom: one past */
} band_column;

typedef struct band {
    band_column *columns; /* the used ones, left to right */
    double *cost;         /* [width + 1] of the best cut of the first n columns */
    uint32_t *from;       /* [width + 1] where its last stretch begins */
    uint32_t count, width;
    double rect_cost;
} band;

int morph_rect_append(morph_rect_list *list, const morph_rect *r)
{
    if (list->count == list->capacity) {
        const uint32_t capacity = list->capacity ? 2u * list->capacity : 64u;
        morph_rect *grown = realloc(list->items, capacity * sizeof *grown);
        if (!grown) return 1;
        list->items = grown;
        list->capacity = capacity;
    }
    list->items[list->count++] = *r;
    return 0;
}

static int band_init(band *b, const morph_cover_options *options)
{
    b->count = 0;
    b->width = (uint32_t)1 << options->width_log2;
    b->rect_cost = (double)options->rect_cost;
    b->columns = morph_alloc(b->width, sizeof *b->columns);
    b->cost = morph_alloc((size_t)b->width + 1u, sizeof *b->cost);
    b->from = morph_alloc((size_t)b->width + 1u, sizeof *b->from);
    return !b->columns || !b->cost || !b->from;
}

static void band_free(band *b)
{
    free(b->columns);
    free(b->cost);
    free(b->from);
}

/* List the used columns of one band: count per x, then close the gaps. */
static void read_band(band *b, const uint32_t *texels, uint32_t count, uint32_t width_log2)
{
    band_column *all = b->columns;
    for (uint32_t x = 0; x < b->width; x++) all[x].texels = 0;
    for (uint32_t i = 0; i < count; i++) {
        band_column *c = &all[texels[i] & (b->width - 1u)];
        const uint32_t y = texels[i] >> width_log2;
        if (c->texels++ == 0u) c->top = y;
        c->bottom = y + 1u;
    }
    b->count = 0;
    for (uint32_t x = 0; x < b->width; x++) {
        if (all[x].texels == 0u) continue;
        all[x].x = x;
        all[b->count++] = all[x];
    }
}

/* cost and from of the first `end` columns, all shorter ones being known. */
static void cut_before(band *b, uint32_t end)
{
    const band_column *last = &b->columns[end - 1u];
    uint32_t top = last->top, bottom = last->bottom, texels = 0;
    b->cost[end] = -1.0;
    for (uint32_t i = end; i-- > 0u;) {
        const band_column *c = &b->columns[i];
        double area, cost;
        if (c->top < top) top = c->top;
        if (c->bottom > bottom) bottom = c->bottom;
        texels += c->texels;
        area = (double)(last->x - c->x + 1u) * (double)(bottom - top);
        cost = b->cost[i] + area + b->rect_cost;
        if (b->cost[end] < 0.0 || cost < b->cost[end]) {
            b->cost[end] = cost;
            b->from[end] = i;
        }
        if (area - (double)texels > WASTE_MOST * b->rect_cost) break;
    }
}

static int add_boxes(const band *b, morph_rect_list *list)
{
    for (uint32_t end = b->count; end > 0u; end = b->from[end]) {
        const uint32_t first = b->from[end];
        uint32_t top = b->columns[first].top, bottom = b->columns[first].bottom;
        morph_rect r;
        for (uint32_t i = first + 1u; i < end; i++) {
            if (b->columns[i].top < top) top = b->columns[i].top;
            if (b->columns[i].bottom > bottom) bottom = b->columns[i].bottom;
        }
        r.x = (uint16_t)b->columns[first].x;
        r.y = (uint16_t)top;
        r.w = (uint16_t)(b->columns[end - 1u].x - b->columns[first].x + 1u);
        r.h = (uint16_t)(bottom - top);
        if (morph_rect_append(list, &r)) return 1;
    }
    return 0;
}

int morph_bands(const uint32_t *texels, uint32_t count, uint32_t rows, const morph_cover_options *options,
                morph_rect_list *list)
{
    band b;
    int failed = band_init(&b, options);
    for (uint32_t first = 0, end; !failed && first < count; first = end) {
        const uint32_t strip = (texels[first] >> options->width_log2) / rows;
        for (end = first; end < count && (texels[end] >> options->width_log2) / rows == strip; end++) {}
        read_band(&b, texels + first, end - first, options->width_log2);
        for (uint32_t i = 1; i <= b.count; i++) cut_before(&b, i);
        failed = add_boxes(&b, list);
    }
    band_free(&b);
    return failed;
}
