/* lod_rims.c: where the surface opens and closes: lids, lips.
 *
 * The distance to the nearest surface cannot see a gap between two lids that should meet: each lid
 * may lie well within the error, and the eye shows between them. So the points that a target brings together or takes
 * apart are found here, and count more. */
#include "lod_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define APART 2.5f /* far is this many times near */

typedef struct cell_entry {
    int32_t cell[3];
    uint32_t point;
} cell_entry;

static int cell_order(const int32_t *a, const int32_t *b)
{
    for (uint32_t k = 0; k < 3u; k++) {
        if (a[k] != b[k]) {
            return a[k] < b[k] ? -1 : 1;
        }
    }
    return 0;
}

static int by_cell(const void *a, const void *b)
{
    const cell_entry *p = a, *q = b;
    int order = cell_order(p->cell, q->cell);
    return order ? order : (p->point > q->point) - (p->point < q->point);
}

static void cell_of(const float *at, float size, int32_t *out)
{
    for (uint32_t k = 0; k < 3u; k++) {
        float c = floorf(at[k] / size);
        out[k] = c < -1e9f ? -1000000000 : c > 1e9f ? 1000000000 : (int32_t)c;
    }
}

/* The first entry of a cell or behind it. */
static uint32_t find_cell(const cell_entry *list, uint32_t count, const int32_t *cell)
{
    uint32_t low = 0, high = count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2u;
        if (cell_order(list[middle].cell, cell) < 0) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

static float distance(const lod_surface *s, uint32_t a, uint32_t b, uint32_t pose)
{
    const float *p = lod_posed(&s->poses, a, pose), *q = lod_posed(&s->poses, b, pose);
    float d[3] = { p[0] - q[0], p[1] - q[1], p[2] - q[2] };
    return sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

static void note(lod_surface *s, uint32_t point, uint32_t pose)
{
    s->shows[(size_t)point * s->poses.words + pose / 64u] |= UINT64_C(1) << (pose % 64u);
}

/* For two points that are near in one pose: note both poses if they are far apart in the other. */
static void compare_poses(lod_surface *s, uint32_t a, uint32_t b, uint32_t near_pose, uint32_t far_pose, float near)
{
    if (distance(s, a, b, far_pose) > APART * near) {
        note(s, a, near_pose);
        note(s, b, near_pose);
        note(s, a, far_pose);
        note(s, b, far_pose);
    }
}

/* Points that a target brings together are apart at rest; points that it takes apart are together at rest. */
static void compare_pair(lod_surface *s, uint32_t a, uint32_t b, uint32_t pose, float near)
{
    if (pose) {
        compare_poses(s, a, b, pose, 0, near);
        return;
    }
    for (uint32_t t = 1; t <= s->mesh->target_count; t++) {
        compare_poses(s, a, b, 0, t, near);
    }
}

/* Test an entry with those after it in the surrounding cells. */
static void compare_near(lod_surface *s, const cell_entry *list, uint32_t count, const cell_entry *at, uint32_t pose,
                         float near)
{
    for (int32_t i = 0; i < 9; i++) {
        int32_t cell[3] = { at->cell[0] + i / 3 - 1, at->cell[1] + i % 3 - 1, at->cell[2] - 1 }, last = at->cell[2] + 1;
        for (uint32_t e = find_cell(list, count, cell); e < count; e++) {
            const cell_entry *other = &list[e];
            if (other->cell[0] != cell[0] || other->cell[1] != cell[1] || other->cell[2] > last) {
                break;
            }
            if (other->point > at->point && s->part[other->point] == s->part[at->point] &&
                distance(s, other->point, at->point, pose) < near) {
                compare_pair(s, other->point, at->point, pose, near);
            }
        }
    }
}

/* The mean edge of the triangles that targets move; 0 where there are none. */
static float face_edge(const lod_surface *s)
{
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->triangle_count * 3u; i++) {
        uint32_t a = lod_point(s, i), b = lod_point(s, lod_next(i));
        if (s->face[a] && s->face[b]) {
            sum += distance(s, a, b, 0);
            count++;
        }
    }
    return count ? (float)(sum / count) : 0.0f;
}

/* Rims are as wide as a triangle: a lid's edge is a fold of a few rows. Returns 1 when out of memory. */
static int widen(lod_surface *s)
{
    size_t words = s->poses.words, count = s->mesh->vertex_count * words;
    uint64_t *narrow = malloc((count + 1u) * sizeof *narrow);
    if (!narrow) {
        return 1;
    }
    memcpy(narrow, s->shows, count * sizeof *narrow);
    for (uint32_t c = 0; c < s->triangle_count * 3u; c++) {
        uint32_t a = lod_point(s, c), b = lod_point(s, lod_next(c));
        for (size_t w = 0; w < words; w++) {
            s->shows[a * words + w] |= narrow[b * words + w];
            s->shows[b * words + w] |= narrow[a * words + w];
        }
    }
    free(narrow);
    return 0;
}

int lod_rims_mark(lod_surface *s)
{
    uint32_t vertices = s->mesh->vertex_count;
    cell_entry *list = calloc((size_t)vertices + 1u, sizeof *list);
    float near = face_edge(s);
    s->shows = calloc((size_t)vertices * s->poses.words + 1u, sizeof *s->shows);
    if (!list || !s->shows) {
        free(list);
        return 1;
    }
    for (uint32_t pose = 0; pose <= s->mesh->target_count && near > 0.0f; pose++) {
        uint32_t count = 0;
        for (uint32_t p = 0; p < vertices; p++) {
            if (s->first[p] != LOD_NONE && s->face[p]) {
                cell_of(lod_posed(&s->poses, p, pose), near, list[count].cell);
                list[count++].point = p;
            }
        }
        qsort(list, count, sizeof *list, by_cell);
        for (uint32_t i = 0; i < count; i++) {
            compare_near(s, list, count, &list[i], pose, near);
        }
    }
    free(list);
    return widen(s);
}
