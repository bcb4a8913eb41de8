/* lod_tree.c: a bounding volume hierarchy of axis-aligned boxes. The tree is split once, at the median of the widest
 * axis at rest; for each pose only the boxes are refitted, from the leaves up, in linear time. */
#include "lod_tree.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "lod_internal.h"

#define LEAF_TRIANGLES 4u
#define STACK_MAX 64u

typedef struct order_key {
    float at;
    uint32_t triangle;
} order_key;

static int by_key(const void *a, const void *b)
{
    const order_key *p = a, *q = b;
    if (p->at != q->at) {
        return p->at < q->at ? -1 : 1;
    }
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

static float centre(const lod_tree *t, uint32_t triangle, uint32_t axis)
{
    const float *p = t->triangles + (size_t)triangle * 9u + axis;
    return p[0] + p[3] + p[6];
}

static uint32_t widest_axis(const lod_tree *t, const lod_tree_node *n)
{
    uint32_t widest = 0;
    float extent[3];
    for (uint32_t k = 0; k < 3u; k++) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (uint32_t i = 0; i < n->count; i++) {
            float x = centre(t, t->order[n->first + i], k);
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        extent[k] = high - low;
        widest = extent[k] > extent[widest] ? k : widest;
    }
    return widest;
}

/* Halve every node with too many triangles at the median of its widest axis. */
static void split_nodes(lod_tree *t, order_key *keys)
{
    t->node_count = 1;
    t->nodes[0].first = 0;
    t->nodes[0].count = t->triangle_count;
    for (uint32_t i = 0; i < t->node_count; i++) {
        lod_tree_node *n = &t->nodes[i], *left = &t->nodes[t->node_count];
        uint32_t axis, half = n->count / 2u;
        if (n->count <= LEAF_TRIANGLES) {
            continue;
        }
        axis = widest_axis(t, n);
        for (uint32_t k = 0; k < n->count; k++) {
            keys[k].triangle = t->order[n->first + k];
            keys[k].at = centre(t, keys[k].triangle, axis);
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
}

int lod_tree_make(const uint32_t *indices, uint32_t triangle_count, const float *position, lod_tree *t)
{
    order_key *keys = calloc((size_t)triangle_count + 1u, sizeof *keys);
    t->triangle_count = triangle_count;
    t->indices = indices;
    t->nodes = calloc((size_t)triangle_count * 2u + 1u, sizeof *t->nodes);
    t->order = calloc((size_t)triangle_count + 1u, sizeof *t->order);
    t->triangles = calloc((size_t)triangle_count + 1u, 9u * sizeof *t->triangles);
    if (!keys || !t->nodes || !t->order || !t->triangles) {
        free(keys);
        return 1; /* the caller frees the tree */
    }
    for (uint32_t i = 0; i < triangle_count; i++) {
        t->order[i] = i;
    }
    t->node_count = 0;
    lod_tree_pose(t, position);
    split_nodes(t, keys);
    lod_tree_pose(t, position);
    free(keys);
    return 0;
}

void lod_tree_free(lod_tree *t)
{
    free(t->nodes);
    free(t->order);
    free(t->triangles);
}

static void include(lod_tree_node *n, const float *low, const float *high)
{
    for (uint32_t k = 0; k < 3u; k++) {
        n->low[k] = low[k] < n->low[k] ? low[k] : n->low[k];
        n->high[k] = high[k] > n->high[k] ? high[k] : n->high[k];
    }
}

void lod_tree_pose(lod_tree *t, const float *position)
{
    for (uint32_t i = 0; i < t->triangle_count * 3u; i++) {
        memcpy(t->triangles + (size_t)i * 3u, position + (size_t)t->indices[i] * 3u, 3u * sizeof *position);
    }
    for (uint32_t i = t->node_count; i-- > 0;) {
        lod_tree_node *n = &t->nodes[i];
        for (uint32_t k = 0; k < 3u; k++) {
            n->low[k] = FLT_MAX;
            n->high[k] = -FLT_MAX;
        }
        if (n->count == 0) {
            include(n, t->nodes[n->first].low, t->nodes[n->first].high);
            include(n, t->nodes[n->first + 1u].low, t->nodes[n->first + 1u].high);
        }
        for (uint32_t c = 0; c < n->count * 3u; c++) {
            const float *at = t->triangles + (size_t)t->order[n->first + c / 3u] * 9u + c % 3u * 3u;
            include(n, at, at);
        }
    }
}

static float box_squared(const lod_tree_node *n, const float *p)
{
    float sum = 0.0f;
    for (uint32_t k = 0; k < 3u; k++) {
        float below = n->low[k] - p[k], above = p[k] - n->high[k], d = below > above ? below : above;
        sum += d > 0.0f ? d * d : 0.0f;
    }
    return sum;
}

/* The boxes still to be visited; the tree is balanced, so they are few. */
typedef struct box_stack {
    uint32_t node[STACK_MAX], count;
    float squared[STACK_MAX];
} box_stack;

static void push(box_stack *s, const lod_tree *t, uint32_t node, const float *point)
{
    s->squared[s->count] = box_squared(&t->nodes[node], point);
    s->node[s->count++] = node;
}

static void swap_last(box_stack *s)
{
    uint32_t a = s->count - 2u, b = s->count - 1u, node = s->node[a];
    float squared = s->squared[a];
    if (s->squared[b] > squared) {
        s->node[a] = s->node[b];
        s->squared[a] = s->squared[b];
        s->node[b] = node;
        s->squared[b] = squared;
    }
}

float lod_tree_distance(const lod_tree *t, const float *point, uint32_t triangle)
{
    return lod_distance_point(t->triangles + (size_t)triangle * 9u, point, NULL);
}

float lod_tree_nearest(const lod_tree *t, const float *point, uint32_t *nearest)
{
    float best = lod_distance_point(t->triangles + (size_t)*nearest * 9u, point, NULL);
    box_stack s;
    s.count = 0;
    push(&s, t, 0, point);
    while (s.count) {
        const lod_tree_node *n = &t->nodes[s.node[--s.count]];
        if (s.squared[s.count] >= best) {
            continue;
        }
        for (uint32_t i = 0; i < n->count; i++) {
            uint32_t triangle = t->order[n->first + i];
            float squared = lod_distance_point(t->triangles + (size_t)triangle * 9u, point, NULL);
            if (squared < best) {
                best = squared;
                *nearest = triangle;
            }
        }
        if (n->count == 0) {
            push(&s, t, n->first, point);
            push(&s, t, n->first + 1u, point);
            swap_last(&s); /* the nearer one is visited first */
        }
    }
    return best;
}
