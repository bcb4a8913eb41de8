/* lod_cards.c: hair cards, lashes, fringes: small open strips, which must not lose their area.
 *
 * A card's points lie on its border, so each collapse may cut a piece off, and the distance to the nearest surface is
 * small: the next card is near. What is lost shows all the same, as hair that thins until the scalp is seen. So a card
 * keeps CARD_AREA of its area, and at least two triangles; what its shape allows beyond goes first, such as the rows of
 * a card that is hardly bent. */
#include "lod_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/islands.h"
#include "convert/model/model_build.h"

#define CARD_AREA 0.875
#define CARD_TRIANGLES 512u /* an open sheet of more is no card */
#define CARD_LEAST 2u       /* triangles */

static double area_at_rest(const lod_surface *s, uint32_t corner, uint32_t point)
{
    float t[9];
    double a[3], b[3], n[3];
    lod_move_triangle(s, corner, point, 0, t);
    for (uint32_t k = 0; k < 3u; k++) {
        a[k] = (double)t[3u + k] - t[k];
        b[k] = (double)t[6u + k] - t[k];
    }
    vec_cross(a, b, n);
    return 0.5 * sqrt(vec_dot(n, n));
}

/* Join the points of each triangle; parent [vertex_count]. */
static void join(const lod_surface *s, uint32_t *parent)
{
    for (uint32_t v = 0; v < s->mesh->vertex_count; v++) {
        parent[v] = v;
    }
    for (uint32_t c = 0; c < s->triangle_count * 3u; c++) {
        if (!s->dead[c / 3u]) {
            islands_join(parent, lod_point(s, c), lod_point(s, lod_next(c)));
        }
    }
}

/* By root: points, border points, triangles. */
typedef struct island_count {
    uint32_t points, border, triangles;
} island_count;

static int is_card(const island_count *c)
{
    return c->border * 2u >= c->points && c->triangles >= CARD_LEAST && c->triangles <= CARD_TRIANGLES;
}

static void count_islands(const lod_surface *s, const uint8_t *border, uint32_t *parent, island_count *counts)
{
    for (uint32_t p = 0; p < s->mesh->vertex_count; p++) {
        if (s->first[p] != LOD_NONE) {
            island_count *c = &counts[islands_root(parent, p)];
            c->points++;
            c->border += border[p];
        }
    }
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        if (!s->dead[t]) counts[islands_root(parent, lod_point(s, t * 3u))].triangles++;
    }
}

static void number_cards(lod_surface *s, uint32_t *parent, island_count *counts)
{
    for (uint32_t p = 0; p < s->mesh->vertex_count; p++) {
        const uint32_t root = islands_root(parent, p);
        if (p == root && is_card(&counts[p])) {
            counts[p].points = s->card_count++;
        } else if (p == root) {
            counts[p].points = LOD_NONE;
        }
        s->card[p] = s->first[p] == LOD_NONE ? LOD_NONE : counts[root].points;
    }
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t card = s->card[lod_point(s, t * 3u)];
        if (!s->dead[t] && card != LOD_NONE) {
            s->cards[card].full += area_at_rest(s, t * 3u, lod_point(s, t * 3u));
            s->cards[card].triangles++;
        }
    }
    for (uint32_t i = 0; i < s->card_count; i++) {
        s->cards[i].left = s->cards[i].full;
    }
}

int lod_cards_make(lod_surface *s, const uint8_t *border)
{
    const size_t vertices = (size_t)s->mesh->vertex_count + 1u;
    uint32_t *parent = calloc(vertices, sizeof *parent);
    island_count *counts = calloc(vertices, sizeof *counts);
    const int failed = !parent || !counts;
    s->card = calloc(vertices, sizeof *s->card);
    s->cards = calloc(vertices, sizeof *s->cards);
    if (!failed && s->card && s->cards) {
        join(s, parent);
        count_islands(s, border, parent, counts);
        number_cards(s, parent, counts);
    }
    free(parent);
    free(counts);
    return failed || !s->card || !s->cards;
}

uint32_t lod_cards_least(const lod_surface *s)
{
    return s->card_count * CARD_LEAST;
}

/* The change of area of the triangles around a point by its move. */
static double area_change(const lod_surface *s, const lod_move *m)
{
    double change = 0.0;
    for (uint32_t i = 0; i < m->kept_count; i++) {
        change += area_at_rest(s, m->kept[i], m->to) - area_at_rest(s, m->kept[i], m->from);
    }
    for (uint32_t i = 0; i < m->gone_count; i++) {
        change -= area_at_rest(s, m->gone[i], m->from);
    }
    return change;
}

int lod_cards_allow(const lod_surface *s, const lod_move *m)
{
    const lod_card *c;
    if (s->card[m->from] == LOD_NONE) {
        return 1;
    }
    c = &s->cards[s->card[m->from]];
    return c->triangles >= CARD_LEAST + m->gone_count && c->left + area_change(s, m) >= CARD_AREA * c->full;
}

void lod_cards_move(lod_surface *s, const lod_move *m)
{
    if (s->card[m->from] != LOD_NONE) {
        lod_card *c = &s->cards[s->card[m->from]];
        c->left += area_change(s, m);
        c->triangles -= m->gone_count;
    }
}
