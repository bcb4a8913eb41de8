#include "obj_polygon.h"

#include <math.h>
#include <stdlib.h>

#include "convert/model/model_build.h"

typedef struct polygon {
    uint32_t count;
    double (*at)[2];         /* [count] in its plane, counter-clockwise */
    uint32_t *next, *before; /* [count] corners that are left */
    uint8_t *ear;            /* [count] */
    uint64_t *steps;
} polygon;

/* ---- its plane ---- */

/* Newell's normal: its areas seen along the three axes. Drops the axis along which the polygon looks largest. */
static void flatten(const float *points, polygon *p)
{
    double normal[3] = { 0.0, 0.0, 0.0 };
    int axis = 0, u, v;
    for (uint32_t i = 0; i < p->count; i++) {
        const float *a = points + 3 * (size_t)i, *b = points + 3 * (size_t)((i + 1) % p->count);
        for (int k = 0; k < 3; k++) {
            const int m = (k + 1) % 3, n = (k + 2) % 3;
            normal[k] += ((double)a[m] - (double)points[m]) * ((double)b[n] - (double)points[n]) -
                         ((double)a[n] - (double)points[n]) * ((double)b[m] - (double)points[m]);
        }
    }
    for (int k = 1; k < 3; k++) axis = fabs(normal[k]) > fabs(normal[axis]) ? k : axis;
    u = (axis + (normal[axis] < 0.0 ? 2 : 1)) % 3;
    v = (axis + (normal[axis] < 0.0 ? 1 : 2)) % 3;
    for (uint32_t i = 0; i < p->count; i++) {
        p->at[i][0] = (double)points[3 * (size_t)i + (size_t)u];
        p->at[i][1] = (double)points[3 * (size_t)i + (size_t)v];
    }
}

/* Twice the area of a triangle, above 0 where it turns left. */
static double turn(const polygon *p, uint32_t a, uint32_t b, uint32_t c)
{
    return (p->at[b][0] - p->at[a][0]) * (p->at[c][1] - p->at[a][1]) -
           (p->at[b][1] - p->at[a][1]) * (p->at[c][0] - p->at[a][0]);
}

/* Whether the fan from the first corner covers it. Of four corners that is so where both triangles turn left: a corner
 * that turns right may lie on the diagonal. A star turns left everywhere, but goes round more than once: then the fan's
 * triangles overlap. */
static int has_fan(const polygon *p)
{
    if (p->count == 4) return turn(p, 0, 1, 2) >= 0.0 && turn(p, 0, 2, 3) >= 0.0;
    for (uint32_t i = 0; i < p->count; i++) {
        const uint32_t b = (i + 1) % p->count, c = (i + 2) % p->count;
        if (turn(p, i, b, c) < 0.0 || (i > 0 && b > 0 && turn(p, 0, i, b) < 0.0)) return 0;
    }
    return 1;
}

/* ---- ears ---- */

static int same_point(const polygon *p, uint32_t a, uint32_t b)
{
    return p->at[a][0] == p->at[b][0] && p->at[a][1] == p->at[b][1];
}

/* Corners that lie where one of the triangle's does are not in it: holes are joined to the outline by an edge that is
 * gone along twice. */
static int is_ear(const polygon *p, uint32_t b)
{
    const uint32_t a = p->before[b], c = p->next[b];
    if (!(turn(p, a, b, c) > 0.0)) return 0;
    for (uint32_t i = p->next[c]; i != a && *p->steps; i = p->next[i], --*p->steps) {
        if (turn(p, p->before[i], i, p->next[i]) > 0.0) continue; /* where one is inside, one that turns right is */
        if (same_point(p, i, a) || same_point(p, i, b) || same_point(p, i, c)) continue;
        if (turn(p, a, b, i) >= 0.0 && turn(p, b, c, i) >= 0.0 && turn(p, c, a, i) >= 0.0) return 0;
    }
    return 1;
}

static uint32_t find_ear(const polygon *p, uint32_t from, uint32_t left)
{
    for (uint32_t i = 0; i < left && *p->steps; i++, from = p->next[from], --*p->steps) {
        if (p->ear[from]) return from;
    }
    return MODEL_NONE;
}

/* Without an ear, as where the outline crosses or touches itself: the corner with the smallest triangle. */
static uint32_t find_any(polygon *p, uint32_t from, uint32_t left)
{
    uint32_t best = from;
    double least = 0.0;
    for (uint32_t i = 0; i < left && *p->steps; i++, from = p->next[from], --*p->steps) {
        const double area = fabs(turn(p, p->before[from], from, p->next[from]));
        p->ear[from] = (uint8_t)is_ear(p, from);
        if (p->ear[from]) return from;
        if (i && area >= least) continue;
        least = area;
        best = from;
    }
    return best;
}

/* Returns 0, or 2 where the steps do not suffice. */
static int clip_ears(polygon *p, uint32_t *triangles)
{
    uint32_t from = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        p->next[i] = (i + 1) % p->count;
        p->before[i] = (i + p->count - 1) % p->count;
    }
    for (uint32_t i = 0; i < p->count; i++) p->ear[i] = (uint8_t)is_ear(p, i);
    for (uint32_t left = p->count; left > 2 && *p->steps; left--, triangles += 3) {
        uint32_t b = find_ear(p, from, left), a, c;
        if (b == MODEL_NONE) b = find_any(p, from, left);
        a = p->before[b];
        c = p->next[b];
        triangles[0] = a;
        triangles[1] = b;
        triangles[2] = c;
        p->next[a] = c;
        p->before[c] = a;
        p->ear[a] = (uint8_t)is_ear(p, a);
        p->ear[c] = (uint8_t)is_ear(p, c);
        from = p->next[c]; /* not the same corner again: that would make a fan of slivers */
    }
    return *p->steps ? 0 : 2;
}

static void make_fan(uint32_t count, uint32_t *triangles)
{
    for (uint32_t i = 0; i + 2 < count; i++) {
        triangles[3 * (size_t)i] = 0;
        triangles[3 * (size_t)i + 1] = i + 1;
        triangles[3 * (size_t)i + 2] = i + 2;
    }
}

int obj_polygon_cut(const float *points, uint32_t count, uint32_t *triangles, uint64_t *steps)
{
    polygon p = { count, NULL, NULL, NULL, NULL, steps };
    int failed = 0;
    make_fan(count, triangles);
    if (count == 3) return 0;
    p.at = model_zeros(count, sizeof *p.at);
    if (!p.at) return 1;
    flatten(points, &p);
    if (!has_fan(&p)) {
        p.next = model_zeros(count, sizeof *p.next);
        p.before = model_zeros(count, sizeof *p.before);
        p.ear = model_zeros(count, 1);
        failed = !p.next || !p.before || !p.ear ? 1 : (uint64_t)count * count > *steps ? 2 : clip_ears(&p, triangles);
    }
    free(p.at);
    free(p.next);
    free(p.before);
    free(p.ear);
    return failed;
}
