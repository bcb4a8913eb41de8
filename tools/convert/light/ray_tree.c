#include "ray_tree.h"

#include <stdlib.h>
#include <string.h>

#define LEAF 4u
#define DEPTH 64u /* halving: 2^32 triangles need 32 */

typedef struct key {
    float at;
    uint32_t triangle;
} key;

/* Equal places by number, so that the order does not depend on the C library's sort. */
static int by_place(const void *a, const void *b)
{
    const key *x = a, *y = b;
    if (x->at != y->at) {
        return x->at < y->at ? -1 : 1;
    }
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static void fit_box(const float *triangles, const uint32_t *order, ray_node *node)
{
    memcpy(node->low, triangles + 9u * (size_t)order[node->first], sizeof node->low);
    memcpy(node->high, node->low, sizeof node->high);
    for (uint32_t i = 0; i < node->count; i++) {
        const float *corners = triangles + 9u * (size_t)order[node->first + i];
        for (uint32_t k = 0; k < 9u; k++) {
            float *low = &node->low[k % 3u], *high = &node->high[k % 3u];
            *low = corners[k] < *low ? corners[k] : *low;
            *high = corners[k] > *high ? corners[k] : *high;
        }
    }
}

static uint32_t longest_side(const ray_node *node)
{
    uint32_t axis = 0;
    for (uint32_t k = 1; k < 3u; k++) {
        if (node->high[k] - node->low[k] > node->high[axis] - node->low[axis]) axis = k;
    }
    return axis;
}

/* Sort a node's triangles along its longest side and halve it; keys has room for them. */
static void split(ray_tree *t, const float *triangles, uint32_t index, key *keys)
{
    ray_node *node = &t->nodes[index];
    const uint32_t axis = longest_side(node), first = node->first, count = node->count, half = count / 2u;
    for (uint32_t i = 0; i < count; i++) {
        const float *corners = triangles + 9u * (size_t)t->order[first + i] + axis;
        keys[i].triangle = t->order[first + i];
        keys[i].at = corners[0] + corners[3] + corners[6];
    }
    qsort(keys, count, sizeof *keys, by_place);
    for (uint32_t i = 0; i < count; i++) {
        t->order[first + i] = keys[i].triangle;
    }
    node->first = t->node_count;
    node->count = 0;
    for (uint32_t side = 0; side < 2u; side++) {
        ray_node *child = &t->nodes[t->node_count++];
        child->first = side ? first + half : first;
        child->count = side ? count - half : half;
        fit_box(triangles, t->order, child);
    }
}

static void build(ray_tree *t, const float *triangles, key *keys)
{
    t->nodes[0].first = 0;
    t->nodes[0].count = t->triangle_count;
    t->node_count = 1;
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        t->order[i] = i;
    }
    fit_box(triangles, t->order, &t->nodes[0]);
    for (uint32_t i = 0; i < t->node_count; i++) {
        if (t->nodes[i].count > LEAF) split(t, triangles, i, keys);
    }
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        memcpy(t->triangles + 9u * (size_t)i, triangles + 9u * (size_t)t->order[i], 9u * sizeof *triangles);
    }
}

int ray_tree_make(const float *triangles, uint32_t count, ray_tree *out)
{
    key *keys = malloc((count + 1u) * sizeof *keys);
    memset(out, 0, sizeof *out);
    out->triangle_count = count;
    out->nodes = malloc((2u * (size_t)count + 1u) * sizeof *out->nodes);
    out->order = malloc((count + 1u) * sizeof *out->order);
    out->triangles = malloc((count + 1u) * 9u * sizeof *out->triangles);
    if (keys && out->nodes && out->order && out->triangles && count) {
        build(out, triangles, keys);
    }
    free(keys);
    return !keys || !out->nodes || !out->order || !out->triangles;
}

void ray_tree_free(ray_tree *t)
{
    free(t->nodes);
    free(t->order);
    free(t->triangles);
    memset(t, 0, sizeof *t);
}

/* ---- rays ---- */

typedef struct ray {
    float origin[3], direction[3], inverse[3];
    float least, farthest;
} ray;

static ray ray_of(const float origin[3], const float direction[3], float least)
{
    ray r;
    memcpy(r.origin, origin, sizeof r.origin);
    memcpy(r.direction, direction, sizeof r.direction);
    for (uint32_t k = 0; k < 3u; k++) {
        r.inverse[k] = 1.0f / (direction[k] > -1e-20f && direction[k] < 1e-20f ? 1e-20f : direction[k]);
    }
    r.least = least;
    r.farthest = 1e30f;
    return r;
}

static int meets_box(const ray *r, const ray_node *node)
{
    float near = r->least, far = r->farthest;
    for (uint32_t k = 0; k < 3u; k++) {
        const float a = (node->low[k] - r->origin[k]) * r->inverse[k];
        const float b = (node->high[k] - r->origin[k]) * r->inverse[k];
        const float first = a < b ? a : b, last = a < b ? b : a;
        near = first > near ? first : near;
        far = last < far ? last : far;
    }
    return near <= far * 1.000001f;
}

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The distance to a triangle's plane, if it is hit nearer than the farthest so far; else 0. */
static float meets_triangle(const ray *r, const float *corners, float *u, float *v)
{
    float e[3], f[3], s[3], p[3], q[3], scale, distance;
    for (uint32_t k = 0; k < 3u; k++) {
        e[k] = corners[3u + k] - corners[k];
        f[k] = corners[6u + k] - corners[k];
        s[k] = r->origin[k] - corners[k];
    }
    cross(r->direction, f, p);
    scale = dot(e, p);
    if (scale > -1e-20f && scale < 1e-20f) {
        return 0.0f; /* edge on, or without area */
    }
    scale = 1.0f / scale;
    cross(s, e, q);
    *u = scale * dot(s, p);
    *v = scale * dot(r->direction, q);
    if (*u < 0.0f || *v < 0.0f || *u + *v > 1.0f) {
        return 0.0f;
    }
    distance = scale * dot(f, q);
    return distance > r->least && distance < r->farthest ? distance : 0.0f;
}

/* Walk the tree; with `meeting` to the nearest triangle, without to any. */
static int walk(const ray_tree *t, ray *r, ray_meeting *meeting)
{
    uint32_t stack[DEPTH], depth = 0, found = 0;
    if (t->triangle_count) {
        stack[depth++] = 0;
    }
    while (depth) {
        const ray_node *node = &t->nodes[stack[--depth]];
        if (!meets_box(r, node)) {
            continue;
        }
        if (!node->count) {
            stack[depth++] = node->first;
            stack[depth++] = node->first + 1u;
        }
        for (uint32_t i = node->first; i < node->first + node->count; i++) {
            float u, v;
            const float distance = meets_triangle(r, t->triangles + 9u * (size_t)i, &u, &v);
            if (distance > 0.0f && !meeting) {
                return 1;
            }
            if (distance > 0.0f) {
                *meeting = (ray_meeting){ t->order[i], u, v };
                r->farthest = distance;
                found = 1;
            }
        }
    }
    return (int)found;
}

int ray_tree_hit(const ray_tree *t, const float origin[3], const float direction[3], float least)
{
    ray r = ray_of(origin, direction, least);
    return walk(t, &r, NULL);
}

int ray_tree_nearest(const ray_tree *t, const float origin[3], const float direction[3], float least,
                     ray_meeting *meeting)
{
    ray r = ray_of(origin, direction, least);
    return walk(t, &r, meeting);
}
