/* lod_tree.c: distances by a tree of boxes that is split once, at rest; for each pose only the boxes are fitted. The
 * triangles of a leaf are measured at once. */
#include "lod_tree.h"

#include <stdlib.h>
#include <string.h>

#include "lod_internal.h"

/* Leaves that a search may measure, on average, and those in hand for searches that take more. Ordinary surfaces take
 * two to three. Where thousands of slivers lie across the axes, such as a fan's, the boxes of most of them hold each
 * point, and without an end the time would grow by the square of the triangles. */
#define MEAN_LEAVES 8u
#define SPARE_LEAVES (1u << 20)

static void pose_triangles(lod_tree *t, const float *position)
{
    for (uint32_t i = 0; i < t->boxes.triangle_count * 3u; i++) {
        memcpy(t->triangles + (size_t)i * 3u, position + (size_t)t->indices[i] * 3u, 3u * sizeof *position);
    }
}

static int number_leaves(lod_tree *t)
{
    t->block_of = calloc((size_t)t->boxes.node_count + 1u, sizeof *t->block_of);
    for (uint32_t i = 0; t->block_of && i < t->boxes.node_count; i++) {
        t->block_of[i] = t->block_count;
        t->block_count += t->boxes.nodes[i].count > 0;
    }
    t->blocks = calloc((size_t)t->block_count + 1u, sizeof *t->blocks);
    return !t->block_of || !t->blocks;
}

static void prepare_leaf(lod_tree *t, uint32_t node)
{
    const triangle_node *n = &t->boxes.nodes[node];
    float triangles[9u * LOD_LANES];
    for (uint32_t k = 0; k < n->count; k++) {
        memcpy(triangles + 9u * k, t->triangles + 9u * (size_t)t->boxes.order[n->first + k], 9u * sizeof *triangles);
    }
    lod_block_prepare(triangles, n->count, &t->blocks[t->block_of[node]]);
}

static void prepare_leaves(lod_tree *t)
{
    for (uint32_t i = 0; i < t->boxes.node_count; i++) {
        if (t->boxes.nodes[i].count) {
            prepare_leaf(t, i);
        }
    }
}

int lod_tree_make(const uint32_t *indices, uint32_t triangle_count, const float *position, lod_tree *t)
{
    t->indices = indices;
    t->triangles = calloc((size_t)triangle_count + 1u, 9u * sizeof *t->triangles);
    if (!t->triangles) {
        return 1; /* the caller frees the tree */
    }
    t->boxes.triangle_count = triangle_count;
    pose_triangles(t, position);
    if (triangle_tree_make(t->triangles, triangle_count, LOD_LANES, &t->boxes) || number_leaves(t)) {
        return 1;
    }
    prepare_leaves(t);
    t->spare_leaves = SPARE_LEAVES;
    return 0;
}

void lod_tree_free(lod_tree *t)
{
    triangle_tree_free(&t->boxes);
    free(t->triangles);
    free(t->block_of);
    free(t->blocks);
}

void lod_tree_pose(lod_tree *t, const float *position)
{
    pose_triangles(t, position);
    triangle_tree_fit(&t->boxes, t->triangles);
    prepare_leaves(t);
}

static float box_squared(const triangle_node *n, const float *p)
{
    float sum = 0.0f;
    for (uint32_t k = 0; k < 3u; k++) {
        float below = n->low[k] - p[k], above = p[k] - n->high[k], d = below > above ? below : above;
        d = d > 0.0f ? d : 0.0f; /* no branch: which side it is on is hard to foresee */
        sum += d * d;
    }
    return sum;
}

/* The boxes still to be visited; the tree is balanced, so they are few. */
typedef struct box_stack {
    uint32_t node[TRIANGLE_TREE_STACK], count;
    float squared[TRIANGLE_TREE_STACK];
} box_stack;

static void push(box_stack *s, const lod_tree *t, uint32_t node, const float *point)
{
    s->squared[s->count] = box_squared(&t->boxes.nodes[node], point);
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
    return lod_distance_point(t->triangles + (size_t)triangle * 9u, point);
}

float lod_tree_nearest(lod_tree *t, const float *point, float enough, uint32_t *nearest)
{
    float best = lod_tree_distance(t, point, *nearest);
    uint64_t leaves = t->spare_leaves + MEAN_LEAVES;
    box_stack s;
    s.count = 0;
    push(&s, t, 0, point);
    while (s.count && best > enough && leaves) {
        const uint32_t node = s.node[--s.count];
        const triangle_node *n = &t->boxes.nodes[node];
        if (s.squared[s.count] >= best) {
            continue;
        }
        if (n->count) {
            float squared[LOD_LANES];
            leaves--;
            lod_block_distances(&t->blocks[t->block_of[node]], point, squared);
            for (uint32_t k = 0; k < n->count; k++) {
                if (squared[k] < best) {
                    best = squared[k];
                    *nearest = t->boxes.order[n->first + k];
                }
            }
        } else {
            push(&s, t, n->first, point);
            push(&s, t, n->first + 1u, point);
            swap_last(&s); /* the nearer one is visited first */
        }
    }
    t->spare_leaves = leaves;
    return best;
}
