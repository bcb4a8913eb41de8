#include "hair_grow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SUBSTEPS 8
#define RADIANS (3.14159265358979 / 180.0)
#define ROOTED 0.98 /* of the radii: roots are in the skin */
#define CURVES_NEAR 3u
#define SETTLE 0.010 /* metres above its height at which hair turns back at 45 degrees */
#define CROWN 4.0    /* degrees: the innermost row is no point */

typedef struct vec {
    double x, y, z;
} vec;

static vec add(vec a, double s, vec b)
{
    return (vec){ a.x + s * b.x, a.y + s * b.y, a.z + s * b.z };
}

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec unit(vec a)
{
    const double length = sqrt(dot(a, a));
    return length > 1e-12 ? (vec){ a.x / length, a.y / length, a.z / length } : (vec){ 0.0, -1.0, 0.0 };
}

static double smooth(double low, double high, double x)
{
    double t = (x - low) / (high - low);
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    return t * t * (3.0 - 2.0 * t);
}

/* ---- the skull ---- */

typedef struct skull {
    vec centre, radii;
    double mean;
} skull;

static skull skull_of(const hair_text *t)
{
    const float *s = t->skull;
    return (skull){ { s[0], s[1], s[2] }, { s[3], s[4], s[5] }, (s[3] + s[4] + s[5]) / 3.0 };
}

/* A place as a multiple of the radii. */
static vec within(const skull *s, vec p)
{
    return (vec){ (p.x - s->centre.x) / s->radii.x, (p.y - s->centre.y) / s->radii.y,
                  (p.z - s->centre.z) / s->radii.z };
}

static vec from_within(const skull *s, vec q, double factor)
{
    return (vec){ s->centre.x + factor * q.x * s->radii.x, s->centre.y + factor * q.y * s->radii.y,
                  s->centre.z + factor * q.z * s->radii.z };
}

static vec normal_at(const skull *s, vec p)
{
    const vec q = within(s, p);
    return unit((vec){ q.x / s->radii.x, q.y / s->radii.y, q.z / s->radii.z });
}

/* Out of the skull, as high above it as hair lies there; out of the text's spheres. */
static vec push_out(const hair_text *t, const skull *s, vec p, double height)
{
    const vec q = within(s, p);
    const double size = sqrt(dot(q, q)), least = 1.0 + height / s->mean;
    if (size < least) p = from_within(s, unit(q), least);
    for (uint32_t i = 0; i < t->sphere_count; i++) {
        const float *k = t->spheres[i];
        const vec centre = { k[0], k[1], k[2] }, way = add(p, -1.0, centre);
        const double distance = sqrt(dot(way, way));
        if (distance < k[3] + 0.002) p = add(centre, k[3] + 0.002, unit(way));
    }
    return p;
}

/* ---- a hair ---- */

/* The hairline's angle from the crown, by the angle about it from the front. */
static double rim_at(const hair_text *t, double azimuth)
{
    const double side = sin(azimuth) * sin(azimuth), end = cos(azimuth) >= 0.0 ? t->hairline[0] : t->hairline[2];
    return end + (t->hairline[1] - end) * side;
}

static vec root_at(const hair_text *t, const skull *s, double azimuth, double share)
{
    const double angle = (CROWN + (rim_at(t, azimuth) - CROWN) * share) * RADIANS;
    return from_within(s, (vec){ sin(angle) * sin(azimuth), cos(angle), sin(angle) * cos(azimuth) }, ROOTED);
}

/* Where hair wants to go from here: along the comb on the skull and back to its height over it, down where that falls
 * away. */
static vec way_at(const skull *s, vec comb, vec p, double height)
{
    const vec n = normal_at(s, p), q = within(s, p), down = { 0.0, -1.0, 0.0 };
    const double away = sqrt(dot(q, q)) - 1.0;
    const double falls = fmax(smooth(0.1, -0.5, n.y), smooth(0.15, 0.4, away));
    const double above = fmin(fmax((away * s->mean - height) / SETTLE, 0.0), 1.0);
    const vec along = unit(add(unit(add(comb, -dot(comb, n), n)), -above, n));
    return unit(add(add((vec){ 0.0, 0.0, 0.0 }, 1.0 - falls, along), falls, down));
}

static void grow_hair(const hair_text *t, const skull *s, vec p, double length, float *points)
{
    const uint32_t count = (uint32_t)t->points;
    const double step = length / ((count - 1u) * SUBSTEPS);
    const vec comb = unit((vec){ t->comb[0], t->comb[1], t->comb[2] });
    vec way = unit(add(way_at(s, comb, p, 0.0), 0.4, normal_at(s, p)));
    double grown = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        points[3u * i] = (float)p.x, points[3u * i + 1u] = (float)p.y, points[3u * i + 2u] = (float)p.z;
        for (int k = 0; k < SUBSTEPS; k++) {
            const vec before = p;
            grown += step;
            const double height = t->lift * smooth(0.0, 0.12, grown);
            way = unit(add(way, 0.35, way_at(s, comb, p, height)));
            p = push_out(t, s, add(p, step, way), height);
            way = unit(add(p, -1.0, before));
            p = add(before, step, way);
        }
    }
}

/* ---- curves ---- */

/* The place at a share of a curve's length, less its root. */
static vec along(const curve_list *c, uint32_t curve, double share)
{
    const float *p = c->points + 3 * (size_t)c->starts[curve];
    const uint32_t count = c->starts[curve + 1u] - c->starts[curve];
    const vec root = { p[0], p[1], p[2] };
    double length = 0.0, left;
    for (uint32_t i = 0; i + 1u < count; i++) {
        const vec a = { p[3u * i], p[3u * i + 1u], p[3u * i + 2u] };
        const vec way = add((vec){ p[3u * i + 3u], p[3u * i + 4u], p[3u * i + 5u] }, -1.0, a);
        length += sqrt(dot(way, way));
    }
    left = share * length;
    for (uint32_t i = 0; i + 1u < count; i++) {
        const vec a = { p[3u * i], p[3u * i + 1u], p[3u * i + 2u] };
        const vec way = add((vec){ p[3u * i + 3u], p[3u * i + 4u], p[3u * i + 5u] }, -1.0, a);
        const double step = sqrt(dot(way, way));
        if (step > 0.0 && (left <= step || i + 2u == count))
            return add(add(a, -1.0, root), fmin(left / step, 1.0), way);
        left -= step;
    }
    return (vec){ 0.0, 0.0, 0.0 };
}

/* The curves whose roots are nearest, and how much each counts: less the farther it is. */
static uint32_t nearest_curves(const curve_list *c, vec p, uint32_t found[CURVES_NEAR], double weights[CURVES_NEAR])
{
    double far[CURVES_NEAR], sum = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const float *r = c->points + 3 * (size_t)c->starts[i];
        const vec way = add((vec){ r[0], r[1], r[2] }, -1.0, p);
        const double distance = dot(way, way);
        uint32_t at = count < CURVES_NEAR ? count++ : CURVES_NEAR;
        for (; at > 0 && far[at - 1u] > distance; at--) {
            if (at < CURVES_NEAR) far[at] = far[at - 1u], found[at] = found[at - 1u];
        }
        if (at < CURVES_NEAR) far[at] = distance, found[at] = i;
    }
    for (uint32_t i = 0; i < count; i++) sum += weights[i] = 1.0 / (far[i] + 1e-6);
    for (uint32_t i = 0; i < count; i++) weights[i] /= sum;
    return count;
}

/* A hair from its own root, of the shape and length of the nearest curves, outside of the skull. */
static void follow_curves(const hair_text *t, const skull *s, vec root, float *points)
{
    const uint32_t count = (uint32_t)t->points;
    uint32_t near[CURVES_NEAR];
    double weights[CURVES_NEAR];
    const uint32_t near_count = nearest_curves(&t->curves, root, near, weights);
    for (uint32_t i = 0; i < count; i++) {
        vec p = root;
        for (uint32_t k = 0; k < near_count; k++) {
            p = add(p, weights[k], along(&t->curves, near[k], (double)i / (count - 1u)));
        }
        if (i) p = push_out(t, s, p, 0.0);
        points[3u * i] = (float)p.x, points[3u * i + 1u] = (float)p.y, points[3u * i + 2u] = (float)p.z;
    }
}

/* ---- all of it ---- */

static void grow_all(const hair_text *t, hair_grown *g)
{
    const skull s = skull_of(t);
    const uint32_t around = (uint32_t)t->around, rows = (uint32_t)t->rows;
    for (uint32_t r = 0; r < rows; r++) {
        /* the outer rows lie closer: a hairline is thick, and a crown small */
        const double inward = 1.0 - (double)r / (rows - 1u), share = 1.0 - inward * inward;
        for (uint32_t a = 0; a < around; a++) {
            const double azimuth = 360.0 * RADIANS * a / around;
            const vec root = root_at(t, &s, azimuth, share);
            float *points = g->points + (size_t)(r * around + a) * g->point_count * 3u;
            if (t->curves.count)
                follow_curves(t, &s, root, points);
            else
                grow_hair(t, &s, root, t->length[0] + (t->length[1] - t->length[0]) * share, points);
        }
    }
    for (uint32_t i = 0; i < g->patch_count; i++) {
        const uint32_t first = i / around * around, next = first + (i + 1u) % around;
        g->patches[i][0] = i;
        g->patches[i][1] = next;
        g->patches[i][2] = i + around;
        g->patches[i][3] = next + around;
    }
}

static void add_sphere(hair_grown *g, vec centre, double radius)
{
    float *s = g->spheres[g->sphere_count++];
    s[0] = (float)centre.x, s[1] = (float)centre.y, s[2] = (float)centre.z, s[3] = (float)radius;
}

/* One in the middle of the skull, and two on each of the longer axes, as large as the ellipsoid is bent there. */
static void fit_spheres(const hair_text *t, hair_grown *g)
{
    const skull s = skull_of(t);
    const double r[3] = { s.radii.x, s.radii.y, s.radii.z }, least = fmin(r[0], fmin(r[1], r[2]));
    int shortest = r[0] == least ? 0 : r[1] == least ? 1 : 2;
    add_sphere(g, s.centre, 0.98 * least);
    for (int i = 0; i < 3; i++) {
        const double radius = 0.98 * least * least / r[i], out = r[i] - least * least / r[i];
        const vec axis = { i == 0, i == 1, i == 2 };
        if (i == shortest || r[i] < 1.03 * least) continue;
        add_sphere(g, add(s.centre, out, axis), radius);
        add_sphere(g, add(s.centre, -out, axis), radius);
    }
    for (uint32_t i = 0; i < t->sphere_count; i++) {
        const float *k = t->spheres[i];
        add_sphere(g, (vec){ k[0], k[1], k[2] }, k[3]);
    }
}

int hair_grow(const hair_text *text, hair_grown *out)
{
    const uint32_t around = (uint32_t)text->around, rows = (uint32_t)text->rows;
    memset(out, 0, sizeof *out);
    out->hair_count = around * rows;
    out->point_count = (uint32_t)text->points;
    out->patch_count = around * (rows - 1u);
    out->points = calloc((size_t)out->hair_count * out->point_count * 3u, sizeof *out->points);
    out->patches = calloc(out->patch_count, sizeof *out->patches);
    if (!out->points || !out->patches) return 1;
    grow_all(text, out);
    fit_spheres(text, out);
    return 0;
}

void hair_grown_free(hair_grown *grown)
{
    free(grown->points);
    free(grown->patches);
    memset(grown, 0, sizeof *grown);
}
