#include "ray_tree.h"

#include <stdlib.h>
#include <string.h>

#define LEAF_TRIANGLES 4u

int ray_tree_make(const float *triangles, uint32_t count, ray_tree *out)
{
    out->triangles = malloc((count + 1u) * 9u * sizeof *out->triangles);
    if (triangle_tree_make(triangles, count, LEAF_TRIANGLES, &out->boxes) || !out->triangles) {
        return 1;
    }
    for (uint32_t i = 0; i < count; i++) {
        memcpy(out->triangles + 9u * (size_t)i, triangles + 9u * (size_t)out->boxes.order[i], 9u * sizeof *triangles);
    }
    return 0;
}

void ray_tree_free(ray_tree *t)
{
    triangle_tree_free(&t->boxes);
    free(t->triangles);
    t->triangles = NULL;
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

static int meets_box(const ray *r, const triangle_node *node)
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
    *u = scale * dot(s, p);
    if (*u < 0.0f || *u > 1.0f) {
        return 0.0f;
    }
    cross(s, e, q);
    *v = scale * dot(r->direction, q);
    if (*v < 0.0f || *u + *v > 1.0f) {
        return 0.0f;
    }
    distance = scale * dot(f, q);
    return distance > r->least && distance < r->farthest ? distance : 0.0f;
}

/* Walk the tree; with `meeting` to the nearest triangle, without to any. */
static int walk(const ray_tree *t, ray *r, ray_meeting *meeting)
{
    uint32_t stack[TRIANGLE_TREE_STACK], depth = 0, found = 0;
    if (t->boxes.triangle_count) {
        stack[depth++] = 0;
    }
    while (depth) {
        const triangle_node *node = &t->boxes.nodes[stack[--depth]];
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
                *meeting = (ray_meeting){ t->boxes.order[i], u, v };
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
