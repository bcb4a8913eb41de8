#include "core/base/assert_internal.h"
#include "motion/graph/graph_weights_internal.h"
#include "noh/base.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

#include <string.h>

void noh_blend_space_1d_weights(uint32_t count, const float *thresholds, float x, float *weights)
{
    uint32_t i = 0;
    NOH_ASSERT(count > 0 && thresholds && weights);
    memset(weights, 0, count * sizeof *weights);
    if (!(x > thresholds[0])) {
        weights[0] = 1.0f;
        return;
    }
    while (i + 1 < count && thresholds[i + 1] <= x) {
        i++;
    }
    weights[i] = 1.0f;
    if (i + 1 < count) {
        float t = (x - thresholds[i]) / (thresholds[i + 1] - thresholds[i]);
        weights[i] = 1.0f - t;
        weights[i + 1] = t;
    }
}

/* ---- weights in two dimensions ---- */

typedef struct nearest_edge {
    float distance, length; /* squared */
    float t;
    uint32_t a, b;
} nearest_edge;

/* Keep an edge if it is nearer to (x, y) than the best so far, or equally near and shorter. */
static void try_edge(const noh_blend_space_2d *s, uint32_t a, uint32_t b, float x, float y, nearest_edge *best)
{
    float ex = s->points[2u * b] - s->points[2u * a], ey = s->points[2u * b + 1u] - s->points[2u * a + 1u];
    float px = x - s->points[2u * a], py = y - s->points[2u * a + 1u];
    float length = ex * ex + ey * ey, t = length > 0.0f ? (px * ex + py * ey) / length : 0.0f;
    float dx, dy, distance;
    t = t > 0.0f ? (t < 1.0f ? t : 1.0f) : 0.0f;
    dx = px - t * ex;
    dy = py - t * ey;
    distance = dx * dx + dy * dy;
    if (best->distance < 0.0f || distance < best->distance || (distance <= best->distance && length < best->length)) {
        best->distance = distance;
        best->length = length;
        best->t = t;
        best->a = a;
        best->b = b;
    }
}

/* A point outside all triangles: use the weights of the nearest point on any edge, which is one of the hull's. */
static void edge_weights(const noh_blend_space_2d *s, float x, float y, float *weights)
{
    nearest_edge best = { -1.0f, 0.0f, 0.0f, 0, 0 };
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            try_edge(s, s->triangles[3u * i + k], s->triangles[3u * i + (k + 1) % 3], x, y, &best);
        }
    }
    if (s->triangle_count == 0) { /* all points on a line: among overlapping edges, the shortest joins neighbours */
        for (uint32_t a = 0; a < s->point_count; a++) {
            for (uint32_t b = a + 1; b < s->point_count; b++) {
                try_edge(s, a, b, x, y, &best);
            }
        }
    }
    weights[best.a] = 1.0f - best.t;
    weights[best.b] += best.t;
}

/* Barycentric weights in a triangle: the area opposite each corner, over the whole. Returns 0 if the point is
 * outside. */
static int triangle_weights(const noh_blend_space_2d *s, const uint8_t t[3], float x, float y, float *weights)
{
    const float *a = s->points + 2u * t[0], *b = s->points + 2u * t[1], *c = s->points + 2u * t[2];
    float area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    float wb = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
    float wc = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
    float wa = 1.0f - wb - wc;
    if (!(wa >= 0.0f && wb >= 0.0f && wc >= 0.0f)) {
        return 0;
    }
    weights[t[0]] = wa;
    weights[t[1]] = wb;
    weights[t[2]] = wc;
    return 1;
}

static float clamped(float x)
{
    const float most = NOH_BLEND_SPACE_COORDINATE_MAX;
    return x > most ? most : x < -most ? -most : x == x ? x : 0.0f;
}

void noh_blend_space_2d_weights(const noh_blend_space_2d *space, float x, float y, float *weights)
{
    float px = clamped(x), py = clamped(y);
    NOH_ASSERT(space && space->points && weights && space->point_count > 0 &&
               space->point_count <= NOH_BLEND_SPACE_POINTS_MAX);
    memset(weights, 0, space->point_count * sizeof *weights);
    for (uint32_t i = 0; i < space->triangle_count; i++) {
        if (triangle_weights(space, space->triangles + 3u * i, px, py, weights)) {
            return;
        }
    }
    edge_weights(space, px, py, weights);
}

/* ---- triangulation ----
 *
 * A sweep over the points by x joins each to the hull of the previous ones; then edges are flipped until all are
 * Delaunay. There are few points and this runs once, so neither step needs to be fast. */

typedef struct mesh {
    uint32_t count, triangle_count;
    int64_t x[NOH_BLEND_SPACE_POINTS_MAX], y[NOH_BLEND_SPACE_POINTS_MAX]; /* 0..4096 */
    uint8_t order[NOH_BLEND_SPACE_POINTS_MAX];                            /* by x, then y */
    uint8_t hull[NOH_BLEND_SPACE_POINTS_MAX + 1u];                        /* counter-clockwise */
    uint32_t hull_count;
    uint8_t *triangles;
} mesh;

/* Twice the signed area; positive when a, b, c turn left. */
static int64_t turn(const mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    return (m->x[b] - m->x[a]) * (m->y[c] - m->y[a]) - (m->y[b] - m->y[a]) * (m->x[c] - m->x[a]);
}

/* Positive when d lies strictly inside the circle of the left-turning a, b, c. Under 2^55. */
static int64_t in_circle(const mesh *m, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    int64_t ax = m->x[a] - m->x[d], ay = m->y[a] - m->y[d];
    int64_t bx = m->x[b] - m->x[d], by = m->y[b] - m->y[d];
    int64_t cx = m->x[c] - m->x[d], cy = m->y[c] - m->y[d];
    return (ax * ax + ay * ay) * (bx * cy - by * cx) - (bx * bx + by * by) * (ax * cy - ay * cx) +
           (cx * cx + cy * cy) * (ax * by - ay * bx);
}

static void add_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    int left = turn(m, a, b, c) > 0;
    uint8_t *t = m->triangles + 3u * m->triangle_count++;
    t[0] = (uint8_t)a;
    t[1] = (uint8_t)(left ? b : c);
    t[2] = (uint8_t)(left ? c : b);
}

static int64_t grid(float value, float low, float extent)
{
    return extent > 0.0f ? (int64_t)((double)(value - low) / (double)extent * 4096.0 + 0.5) : 0;
}

static void round_points(mesh *m, const float *points)
{
    float low[2] = { points[0], points[1] }, high[2] = { points[0], points[1] };
    for (uint32_t i = 1; i < m->count; i++) {
        for (uint32_t k = 0; k < 2; k++) {
            float value = points[2u * i + k];
            low[k] = value < low[k] ? value : low[k];
            high[k] = value > high[k] ? value : high[k];
        }
    }
    for (uint32_t i = 0; i < m->count; i++) {
        m->x[i] = grid(points[2u * i], low[0], high[0] - low[0]);
        m->y[i] = grid(points[2u * i + 1u], low[1], high[1] - low[1]);
    }
}

static int comes_before(const mesh *m, uint32_t a, uint32_t b)
{
    return m->x[a] < m->x[b] || (m->x[a] == m->x[b] && m->y[a] < m->y[b]);
}

static void sort_points(mesh *m)
{
    for (uint32_t i = 0; i < m->count; i++) {
        uint32_t k = i;
        while (k > 0 && comes_before(m, i, m->order[k - 1])) {
            m->order[k] = m->order[k - 1];
            k--;
        }
        m->order[k] = (uint8_t)i;
    }
}

/* The first triangles of the sweep: a fan from the first point off the line through the previous points to all of them.
 * Returns the number of points used; count if all lie on one line. */
static uint32_t first_fan(mesh *m)
{
    uint32_t k = 2, tip;
    while (k < m->count && turn(m, m->order[0], m->order[1], m->order[k]) == 0) {
        k++;
    }
    if (k >= m->count) {
        return m->count;
    }
    tip = m->order[k];
    for (uint32_t i = 0; i + 1 < k; i++) {
        add_triangle(m, m->order[i], m->order[i + 1], tip);
    }
    for (uint32_t i = 0; i < k; i++) { /* along the line so that the tip is on its left */
        m->hull[i] = m->order[turn(m, m->order[0], m->order[1], tip) > 0 ? i : k - 1 - i];
    }
    m->hull[k] = (uint8_t)tip;
    m->hull_count = k + 1;
    return k + 1;
}

/* Join a point to every hull edge that it sees. Points come in order of x, so each lies outside the hull of the
 * previous ones, and the edges that it sees are consecutive: they leave the hull and two new edges replace them. */
static void add_point(mesh *m, uint32_t p)
{
    uint8_t hull[NOH_BLEND_SPACE_POINTS_MAX + 1u];
    uint32_t n = m->hull_count, count = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t before = m->hull[(i + n - 1) % n], a = m->hull[i], b = m->hull[(i + 1) % n];
        int sees_before = turn(m, before, a, p) < 0, sees = turn(m, a, b, p) < 0;
        if (sees) {
            add_triangle(m, a, b, p);
        }
        if (!(sees_before && sees)) {
            hull[count++] = (uint8_t)a;
        }
        if (sees && !sees_before) {
            hull[count++] = (uint8_t)p;
        }
    }
    memcpy(m->hull, hull, count);
    m->hull_count = count;
}

/* Flip the edge that two triangles share if it is not Delaunay: if the fourth point lies inside the circle of the other
 * three. */
static int flip(mesh *m, uint8_t *s, uint8_t *t)
{
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            uint8_t a = s[i], b = s[(i + 1) % 3], c = s[(i + 2) % 3], d = t[(k + 2) % 3];
            if (t[k] == b && t[(k + 1) % 3] == a && in_circle(m, a, b, c, d) > 0) {
                s[0] = a, s[1] = d, s[2] = c;
                t[0] = d, t[1] = b, t[2] = c;
                return 1;
            }
        }
    }
    return 0;
}

static void flip_all(mesh *m)
{
    /* Lawson's algorithm (1977). Lift each point to the height x^2 + y^2: every flip lowers the surface of lifted
     * triangles, so no triangulation repeats and this terminates; n^2 passes are far more than it needs. */
    uint32_t passes = m->count * m->count, flips = 1;
    while (flips && passes--) {
        flips = 0;
        for (uint32_t i = 0; i < m->triangle_count; i++) {
            for (uint32_t k = i + 1; k < m->triangle_count; k++) {
                flips += (uint32_t)flip(m, m->triangles + 3u * i, m->triangles + 3u * k);
            }
        }
    }
}

static int in_range(float x)
{
    return x >= -NOH_BLEND_SPACE_COORDINATE_MAX && x <= NOH_BLEND_SPACE_COORDINATE_MAX; /* false for NaN */
}

static noh_result check_points(const mesh *m, const float *points, noh_error *error)
{
    for (uint32_t i = 0; i < m->count; i++) {
        if (!in_range(points[2u * i]) || !in_range(points[2u * i + 1u])) {
            return noh_fail(error, NOH_ERR_DATA, "a point is not finite, or beyond NOH_BLEND_SPACE_COORDINATE_MAX", i,
                            0);
        }
    }
    return NOH_OK;
}

static noh_result check_apart(const mesh *m, noh_error *error)
{
    for (uint32_t i = 1; i < m->count; i++) {
        if (!comes_before(m, m->order[i - 1], m->order[i])) {
            return noh_fail(error, NOH_ERR_DATA, "two points are equal", m->order[i], 0);
        }
    }
    return NOH_OK;
}

noh_result noh_blend_space_2d_triangulate(uint32_t count, const float *points, uint8_t *triangles,
                                          uint32_t *triangle_count, noh_error *error)
{
    mesh m;
    noh_result result;
    NOH_ASSERT(points && triangles && triangle_count);
    if (count == 0 || count > NOH_BLEND_SPACE_POINTS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "count must be 1 to NOH_BLEND_SPACE_POINTS_MAX", count,
                        NOH_BLEND_SPACE_POINTS_MAX);
    }
    memset(&m, 0, sizeof m);
    m.count = count;
    m.triangles = triangles;
    result = check_points(&m, points, error);
    if (result != NOH_OK) {
        return result;
    }
    round_points(&m, points);
    sort_points(&m);
    result = check_apart(&m, error);
    if (result != NOH_OK) {
        return result;
    }
    for (uint32_t i = first_fan(&m); i < count; i++) {
        add_point(&m, m.order[i]);
    }
    flip_all(&m);
    *triangle_count = m.triangle_count;
    return NOH_OK;
}
