#include "triangle_tree.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

typedef struct order_key {
    float at;
    uint32_t triangle;
} order_key;

/* Equal places by number, so that the order does not depend on the C library's sort. */
static int by_key(const void *a, const void *b)
{
    const order_key *p = a, *q = b;
    if (p->at != q->at) {
        return p->at < q->at ? -1 : 1;
    }
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

/* Three times the centre. */
static float centre(const float *triangles, uint32_t triangle, uint32_t axis)
{
    const float *p = triangles + (size_t)triangle * 9u + axis;
    return p[0] + p[3] + p[6];
}

static uint32_t widest_axis(const triangle_tree *t, const float *triangles, const triangle_node *n)
{
    uint32_t widest = 0;
    float extent[3];
    for (uint32_t k = 0; k < 3u; k++) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (uint32_t i = 0; i < n->count; i++) {
            const float x = centre(triangles, t->order[n->first + i], k);
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        extent[k] = high - low;
        widest = extent[k] > extent[widest] ? k : widest;
    }
    return widest;
}

/* Sort a node's triangles along its widest axis and halve it; keys has room for them. */
static void split(triangle_tree *t, const float *triangles, triangle_node *n, order_key *keys)
{
    triangle_node *left = &t->nodes[t->node_count];
    const uint32_t axis = widest_axis(t, triangles, n), half = n->count / 2u;
    for (uint32_t k = 0; k < n->count; k++) {
        keys[k].triangle = t->order[n->first + k];
        keys[k].at = centre(triangles, keys[k].triangle, axis);
    }
    qsort(keys, n->count, sizeof *keys, by_key);
    for (uint32_t k = 0; k < n->count; k++) {
        t->order[n->first + k] = keys[k].triangle;
    }
    left[0].first = n->first;
    left[0].count = half;
    left[1].first = n->first + half;
    left[1].count = n->count - half;
    n->first = t->node_count;
    n->count = 0;
    t->node_count += 2u;
}

static void build(triangle_tree *t, const float *triangles, uint32_t leaf_most, order_key *keys)
{
    t->node_count = 1;
    t->nodes[0].first = 0;
    t->nodes[0].count = t->triangle_count;
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        t->order[i] = i;
    }
    for (uint32_t i = 0; i < t->node_count; i++) {
        if (t->nodes[i].count > leaf_most) split(t, triangles, &t->nodes[i], keys);
    }
}

int triangle_tree_make(const float *triangles, uint32_t count, uint32_t leaf_most, triangle_tree *out)
{
    order_key *keys = calloc((size_t)count + 1u, sizeof *keys);
    int failed;
    memset(out, 0, sizeof *out);
    out->triangle_count = count;
    out->nodes = calloc((size_t)count * 2u + 1u, sizeof *out->nodes);
    out->order = calloc((size_t)count + 1u, sizeof *out->order);
    failed = !keys || !out->nodes || !out->order;
    if (!failed && count) {
        build(out, triangles, leaf_most, keys);
        triangle_tree_fit(out, triangles);
    }
    free(keys);
    return failed;
}

void triangle_tree_free(triangle_tree *t)
{
    free(t->nodes);
    free(t->order);
    memset(t, 0, sizeof *t);
}

static void include(triangle_node *n, const float *low, const float *high)
{
    for (uint32_t k = 0; k < 3u; k++) {
        n->low[k] = low[k] < n->low[k] ? low[k] : n->low[k];
        n->high[k] = high[k] > n->high[k] ? high[k] : n->high[k];
    }
}

void triangle_tree_fit(triangle_tree *t, const float *triangles)
{
    for (uint32_t i = t->node_count; i-- > 0;) {
        triangle_node *n = &t->nodes[i];
        for (uint32_t k = 0; k < 3u; k++) {
            n->low[k] = FLT_MAX;
            n->high[k] = -FLT_MAX;
        }
        if (n->count == 0) {
            include(n, t->nodes[n->first].low, t->nodes[n->first].high);
            include(n, t->nodes[n->first + 1u].low, t->nodes[n->first + 1u].high);
        }
        for (uint32_t c = 0; c < n->count * 3u; c++) {
            const float *at = triangles + (size_t)t->order[n->first + c / 3u] * 9u + c % 3u * 3u;
            include(n, at, at);
        }
    }
}
