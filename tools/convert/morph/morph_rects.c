/* morph_rects.c: covers the texels of one target by disjoint rectangles.
 *
 * The least cover by rectangles is NP-hard, and here rectangles may also hold texels that the target does not need,
 * stored as zeros. So the cover is greedy: it starts from the boxes of bands (of single rows, and of strips; the
 * cheaper result is kept) and joins two rectangles into their bounding box, together with all that the box touches, as
 * long as that pays: each rectangle saved is worth `rect_cost` texels, each empty texel taken in costs one. The join
 * that gains most comes first. A rectangle's candidates are its successor in row order and those directly below it;
 * each remembers its best join, and after a join only nearby ones search again. */
#include "morph_internal.h"

#include <stdlib.h>

#define PIECES_MOST 4096u /* joining takes time quadratic in their number; noise that has more keeps its bands */
#define NO_PIECE UINT32_MAX
#define HOPELESS (-1e30)

typedef struct box {
    uint32_t x0, y0, x1, y1;
} box; /* x1, y1: one past */

typedef struct piece {
    box b;
    box join;      /* the box with its best partner */
    double gain;   /* of that join, in texels */
    uint8_t dirty; /* gain and join are out of date */
} piece;

typedef struct cover {
    piece *pieces; /* in order of y0, then x0 */
    uint32_t count, capacity;
    double rect_cost;
} cover;

static uint64_t area(const box *b)
{
    return (uint64_t)(b->x1 - b->x0) * (b->y1 - b->y0);
}

static int overlap(const box *a, const box *b)
{
    return a->x0 < b->x1 && b->x0 < a->x1 && a->y0 < b->y1 && b->y0 < a->y1;
}

static void include(box *a, const box *b)
{
    if (b->x0 < a->x0) a->x0 = b->x0;
    if (b->y0 < a->y0) a->y0 = b->y0;
    if (b->x1 > a->x1) a->x1 = b->x1;
    if (b->y1 > a->y1) a->y1 = b->y1;
}

static int contains(const box *a, const box *b)
{
    return a->x0 <= b->x0 && a->y0 <= b->y0 && a->x1 >= b->x1 && a->y1 >= b->y1;
}

static int comes_before(const box *a, const box *b)
{
    return a->y0 != b->y0 ? a->y0 < b->y0 : a->x0 < b->x0;
}

/* Keeps the row order. */
static int add_piece(cover *c, const box *b)
{
    uint32_t at;
    if (c->count == c->capacity) {
        const uint32_t capacity = c->capacity ? 2u * c->capacity : 64u;
        piece *grown = realloc(c->pieces, capacity * sizeof *grown);
        if (!grown) return 1;
        c->pieces = grown;
        c->capacity = capacity;
    }
    for (at = c->count++; at > 0u && comes_before(b, &c->pieces[at - 1u].b); at--) c->pieces[at] = c->pieces[at - 1u];
    c->pieces[at].b = *b;
    c->pieces[at].gain = HOPELESS;
    c->pieces[at].dirty = 1;
    return 0;
}

/* Grows *b until no piece lies partly in it; returns what joining all of them gains. */
static double close_box(const cover *c, box *b)
{
    uint64_t inside = 0;
    uint32_t pieces = 0;
    int grew;
    do {
        grew = 0;
        for (uint32_t i = 0; i < c->count; i++) {
            if (!overlap(&c->pieces[i].b, b) || contains(b, &c->pieces[i].b)) continue;
            include(b, &c->pieces[i].b);
            grew = 1;
        }
    } while (grew);
    for (uint32_t i = 0; i < c->count; i++) {
        if (!contains(b, &c->pieces[i].b)) continue;
        inside += area(&c->pieces[i].b);
        pieces++;
    }
    return c->rect_cost * (double)(pieces - 1u) - (double)(area(b) - inside);
}

static void try_join(cover *c, piece *p, const piece *q)
{
    box b = p->b;
    double gain;
    include(&b, &q->b);
    gain = close_box(c, &b);
    if (gain > p->gain) {
        p->gain = gain;
        p->join = b;
    }
}

static void find_join(cover *c, uint32_t index)
{
    piece *p = &c->pieces[index];
    p->gain = HOPELESS;
    p->dirty = 0;
    if (index + 1u < c->count) try_join(c, p, &c->pieces[index + 1u]);
    for (uint32_t i = index + 1u; i < c->count && c->pieces[i].b.y0 <= p->b.y1; i++) {
        const box *b = &c->pieces[i].b;
        if (b->y0 == p->b.y1 && b->x0 <= p->b.x1 && p->b.x0 <= b->x1) try_join(c, p, &c->pieces[i]);
    }
}

static uint32_t best_piece(cover *c)
{
    uint32_t best = NO_PIECE;
    for (uint32_t i = 0; i < c->count; i++) {
        if (c->pieces[i].dirty) find_join(c, i);
        if (c->pieces[i].gain <= HOPELESS) continue;
        if (best == NO_PIECE || c->pieces[i].gain > c->pieces[best].gain) best = i;
    }
    return best;
}

/* Mark the pieces whose best join the new box may change: its neighbours, and those whose joined box it cuts. */
static void mark_dirty(cover *c, const box *joined, uint32_t at)
{
    box near = *joined;
    near.x0 -= near.x0 > 0u;
    near.y0 -= near.y0 > 0u;
    near.x1++;
    near.y1++;
    for (uint32_t i = 0; i < c->count; i++) {
        piece *p = &c->pieces[i];
        if (overlap(&p->b, &near) || p->gain <= HOPELESS || overlap(&p->join, &near)) p->dirty = 1;
    }
    if (at > 0u) c->pieces[at - 1u].dirty = 1;
}

static void join_pieces(cover *c, box joined)
{
    uint32_t kept = 0, at;
    for (uint32_t i = 0; i < c->count; i++) {
        if (contains(&joined, &c->pieces[i].b)) {
            if (kept > 0u) c->pieces[kept - 1u].dirty = 1; /* its successor is gone */
            continue;
        }
        c->pieces[kept++] = c->pieces[i];
    }
    for (at = kept; at > 0u && comes_before(&joined, &c->pieces[at - 1u].b); at--) c->pieces[at] = c->pieces[at - 1u];
    c->pieces[at].b = joined;
    c->pieces[at].dirty = 1;
    c->count = kept + 1u;
    mark_dirty(c, &joined, at);
}

/* The boxes of bands, in row order. */
static int add_bands(cover *c, const uint32_t *texels, uint32_t count, uint32_t rows,
                     const morph_cover_options *options)
{
    morph_rect_list start = { NULL, 0, 0 };
    int failed = morph_bands(texels, count, rows, options, &start);
    c->count = 0;
    for (uint32_t i = 0; !failed && i < start.count; i++) {
        const morph_rect *r = &start.items[i];
        box b = { r->x, r->y, (uint32_t)r->x + r->w, (uint32_t)r->y + r->h };
        failed = add_piece(c, &b);
    }
    free(start.items);
    return failed;
}

/* The same, with higher bands until there are few enough to be joined if they must be. */
static int add_few_bands(cover *c, const uint32_t *texels, uint32_t count, uint32_t rows,
                         const morph_cover_options *options)
{
    morph_cover_options coarse = *options;
    while (!add_bands(c, texels, count, rows, &coarse)) {
        if (options->most_rects == 0u || c->count <= PIECES_MOST) return 0;
        coarse.rect_cost *= 4.0f;
        rows *= 2u;
    }
    return 1;
}

/* Join pieces as long as that pays, or there are more than allowed. */
static int join_bands(cover *c, const uint32_t *texels, uint32_t count, uint32_t rows,
                      const morph_cover_options *options)
{
    const int failed = add_few_bands(c, texels, count, rows, options);
    if (c->count > PIECES_MOST) return failed;
    while (!failed && c->count > 1u) {
        const uint32_t best = best_piece(c);
        const int too_many = options->most_rects != 0u && c->count > options->most_rects;
        if (!too_many && c->pieces[best].gain <= 0.0) break;
        join_pieces(c, c->pieces[best].join);
    }
    return failed;
}

static double cost(const cover *c)
{
    double sum = c->rect_cost * (double)c->count;
    for (uint32_t i = 0; i < c->count; i++) sum += (double)area(&c->pieces[i].b);
    return sum;
}

static int append(morph_rect_list *list, const cover *c)
{
    for (uint32_t i = 0; i < c->count; i++) {
        const box *b = &c->pieces[i].b;
        morph_rect r;
        r.x = (uint16_t)b->x0;
        r.y = (uint16_t)b->y0;
        r.w = (uint16_t)(b->x1 - b->x0);
        r.h = (uint16_t)(b->y1 - b->y0);
        if (morph_rect_append(list, &r)) return 1;
    }
    return 0;
}

int morph_cover(const uint32_t *texels, uint32_t count, const morph_cover_options *options, morph_rect_list *list)
{
    cover rows = { NULL, 0, 0, (double)options->rect_cost }, strips = rows;
    int failed = join_bands(&rows, texels, count, 1u, options) ||
                 join_bands(&strips, texels, count, MORPH_STRIP_ROWS, options);
    failed = failed || append(list, cost(&rows) < cost(&strips) ? &rows : &strips);
    free(rows.pieces);
    free(strips.pieces);
    return failed;
}
