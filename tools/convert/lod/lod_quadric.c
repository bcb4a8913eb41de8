/* lod_quadric.c: one quadric per point and pose; the largest counts.
 *
 * A quadric is the sum of squared distances to the planes of the triangles around a point, weighted by their areas: a
 * symmetric 4 x 4 matrix, ten numbers, that can be added when two points become one (Garland and Heckbert 1997). At
 * borders, planes through the edge and perpendicular to the triangle are added, so that outlines hold.
 *
 * A row holds the poses in which the point or one of its neighbours differs from rest, sorted; in every other pose its
 * surroundings lie as at rest, so the rest quadric serves. A target moves a part of a face, so most rows are short. */
#include "lod_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BORDER_WEIGHT 4.0 /* of the perpendicular planes at borders, relative to the triangles' own */

static void add_plane(lod_quadric *q, const double *n, double d, double area)
{
    double plane[4] = { n[0], n[1], n[2], d };
    uint32_t at = 0;
    for (uint32_t i = 0; i < 4u; i++) {
        for (uint32_t j = i; j < 4u; j++) {
            q->a[at++] += area * plane[i] * plane[j];
        }
    }
}

static double evaluate(const lod_quadric *q, const float *p)
{
    const double *a = q->a;
    double x = p[0], y = p[1], z = p[2];
    return x * (a[0] * x + 2.0 * (a[1] * y + a[2] * z + a[3])) + y * (a[4] * y + 2.0 * (a[5] * z + a[6])) +
           z * (a[7] * z + 2.0 * a[8]) + a[9];
}

static void add(lod_quadric *to, const lod_quadric *from)
{
    for (uint32_t i = 0; i < 10u; i++) {
        to->a[i] += from->a[i];
    }
    to->area += from->area;
}

static void sub(const float *a, const float *b, double *out)
{
    for (uint32_t k = 0; k < 3u; k++) {
        out[k] = (double)a[k] - b[k];
    }
}

static void cross(const double *a, const double *b, double *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Add the triangle's plane and, for its edges from the point that are borders, the planes perpendicular to it. */
static void add_triangle(const lod_surface *s, const lod_fan *fan, uint32_t corner, uint32_t pose, lod_quadric *q)
{
    const uint32_t ends[2] = { lod_point(s, lod_next(corner)), lod_point(s, lod_previous(corner)) };
    const float *p = lod_posed(&s->poses, fan->point, pose);
    double a[3], b[3], n[3], length;
    sub(lod_posed(&s->poses, ends[0], pose), p, a);
    sub(lod_posed(&s->poses, ends[1], pose), p, b);
    cross(a, b, n);
    length = sqrt(dot(n, n));
    if (!(length > 0.0)) {
        return;
    }
    for (uint32_t k = 0; k < 3u; k++) {
        n[k] /= length;
    }
    add_plane(q, n, -(n[0] * p[0] + n[1] * p[1] + n[2] * p[2]), 0.5 * length);
    q->area += 0.5 * length;
    for (uint32_t e = 0; e < 2u; e++) {
        uint32_t i = 0;
        while (fan->ring[i] != ends[e]) {
            i++;
        }
        if (fan->ring_use[i] == 1u) {
            double side[3], squared;
            cross(e ? b : a, n, side);
            squared = dot(side, side);
            for (uint32_t k = 0; k < 3u && squared > 0.0; k++) {
                side[k] /= sqrt(squared);
            }
            add_plane(q, side, -(side[0] * p[0] + side[1] * p[1] + side[2] * p[2]), BORDER_WEIGHT * squared);
        }
    }
}

/* The poses in which a point or its ring moves; rest is among them. */
static uint32_t row_poses(const lod_surface *s, const lod_fan *fan, uint64_t *set, uint16_t *out)
{
    uint32_t words = s->poses.words, count = 0;
    memcpy(set, s->poses.moves + (size_t)fan->point * words, words * sizeof *set);
    for (uint32_t i = 0; i < fan->ring_count; i++) {
        for (uint32_t w = 0; w < words; w++) {
            set[w] |= s->poses.moves[(size_t)fan->ring[i] * words + w];
        }
    }
    set[0] |= 1u;
    for (uint32_t pose = 0; pose < s->poses.count; pose++) {
        if (lod_set_has(set, pose)) {
            out[count++] = (uint16_t)pose;
        }
    }
    return count;
}

static int row_alloc(lod_quadric_row *row, uint32_t count)
{
    row->pose = calloc(count, sizeof *row->pose);
    row->quadric = calloc(count, sizeof *row->quadric);
    row->count = count;
    return !row->pose || !row->quadric;
}

lod_quadric_row *lod_quadrics_make(lod_surface *s)
{
    lod_quadric_row *rows = calloc(s->mesh->vertex_count + 1u, sizeof *rows);
    uint64_t *set = calloc(s->poses.words, sizeof *set);
    uint16_t *poses = calloc(s->poses.count, sizeof *poses);
    int failed = !rows || !set || !poses;
    for (uint32_t p = 0; p < s->mesh->vertex_count && !failed; p++) {
        lod_fan fan;
        uint32_t count;
        if (s->first[p] == LOD_NONE || lod_fan_gather(s, p, &fan)) {
            continue;
        }
        count = row_poses(s, &fan, set, poses);
        failed = row_alloc(&rows[p], count);
        for (uint32_t i = 0; i < count && !failed; i++) {
            rows[p].pose[i] = poses[i];
            for (uint32_t c = 0; c < fan.count; c++) {
                add_triangle(s, &fan, fan.corner[c], poses[i], &rows[p].quadric[i]);
            }
        }
    }
    free(set);
    free(poses);
    if (failed && rows) {
        lod_quadrics_free(rows, s->mesh->vertex_count);
    }
    return failed ? NULL : rows;
}

void lod_quadrics_free(lod_quadric_row *rows, uint32_t count)
{
    for (uint32_t i = 0; rows && i < count; i++) {
        free(rows[i].pose);
        free(rows[i].quadric);
    }
    free(rows);
}

/* Walks two rows at once. A row that lacks a pose has its rest quadric there. */
typedef struct pair {
    uint32_t a, b; /* places in the rows */
    uint32_t pose;
    const lod_quadric *qa, *qb;
} pair;

static int pair_next(const lod_quadric_row *a, const lod_quadric_row *b, pair *p)
{
    uint32_t pa = p->a < a->count ? a->pose[p->a] : LOD_NONE, pb = p->b < b->count ? b->pose[p->b] : LOD_NONE;
    if (pa == LOD_NONE && pb == LOD_NONE) {
        return 0;
    }
    p->pose = pa < pb ? pa : pb;
    p->qa = pa == p->pose ? &a->quadric[p->a++] : a->quadric;
    p->qb = pb == p->pose ? &b->quadric[p->b++] : b->quadric;
    return 1;
}

double lod_quadric_cost(const lod_surface *s, const lod_quadric_row *rows, uint32_t from, uint32_t to)
{
    const lod_quadric_row *a = &rows[from], *b = &rows[to];
    pair p = { 0, 0, 0, NULL, NULL };
    double worst = 0.0;
    if (!a->count || !b->count) {
        return 0.0;
    }
    while (pair_next(a, b, &p)) {
        const float *at = lod_posed(&s->poses, to, p.pose);
        double area = p.qa->area + p.qb->area, squared = evaluate(p.qa, at) + evaluate(p.qb, at);
        squared = area > 0.0 ? squared / area * s->poses.weight[p.pose] : 0.0;
        worst = squared > worst ? squared : worst;
    }
    return worst;
}

int lod_quadric_merge(lod_quadric_row *rows, uint32_t from, uint32_t to)
{
    lod_quadric_row *a = &rows[from], *b = &rows[to], sum = { 0, NULL, NULL };
    pair p = { 0, 0, 0, NULL, NULL };
    uint32_t count = 0;
    if (!a->count || !b->count) {
        return 0;
    }
    while (pair_next(a, b, &p)) {
        count++;
    }
    if (row_alloc(&sum, count)) {
        free(sum.pose);
        free(sum.quadric);
        return 1;
    }
    p.a = p.b = 0;
    for (uint32_t i = 0; pair_next(a, b, &p); i++) {
        sum.pose[i] = (uint16_t)p.pose;
        sum.quadric[i] = *p.qa;
        add(&sum.quadric[i], p.qb);
    }
    free(a->pose);
    free(a->quadric);
    free(b->pose);
    free(b->quadric);
    memset(a, 0, sizeof *a);
    *b = sum;
    return 0;
}
