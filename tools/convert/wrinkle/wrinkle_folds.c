#include "wrinkle_folds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/angle.h"
#include "convert/model/model_build.h"

#define PI 3.14159265358979323846
#define BINS 96
#define BLUR 6            /* bins on each side */
#define SHRINK_LEAST 0.01 /* a zone that is compressed less has no folds */
#define SHARE_LEAST 0.4   /* of its depth has a fold where its zone is not compressed at all */
#define STEP 1e-4         /* between heights whose difference is a slope, face units */
#define BEHIND 0.9        /* how far behind the eyes a face reaches, face units */
#define SHOULDER 3.0      /* skin rises along a fold, */
#define SLOW 2.0          /* widths of the side that rises slowly */
#define WOBBLE 0.12       /* and no fold is quite even: of the gap */

/* A place in a zone: -1..1 along its folds and across them where it is inside. */
typedef struct fold_place {
    double along, across, radius, angle;
} fold_place;

/* ---- zones ---- */

static double degrees_of(double x, double y)
{
    const double ax = fabs(x), ay = fabs(y), most = ax > ay ? ax : ay, least = ax > ay ? ay : ax;
    const double octant = most > 0.0 ? angle_arc_tangent(least / most) * (180.0 / PI) : 0.0;
    const double quarter = ax > ay ? octant : 90.0 - octant, half = x < 0.0 ? 180.0 - quarter : quarter;
    return y < 0.0 ? -half : half;
}

static double across_of(const fold_zone *z, const fold_place *at)
{
    return z->rays ? at->angle : at->radius;
}

/* Rays of both sides are mirrored, arcs go across the middle. */
static double flip_of(const fold_zone *z, double x)
{
    return z->side != 0.0 ? z->side : z->rays && x < 0.0 ? -1.0 : 1.0;
}

static double radius_of(const fold_zone *z, const double p[3])
{
    const double x = flip_of(z, p[0]) * p[0] - z->middle[0], y = p[1] - z->middle[1];
    return sqrt(x * x + y * y);
}

/* p: face coordinates */
static fold_place place_of(const fold_zone *z, const double p[3])
{
    const double x = flip_of(z, p[0]) * p[0] - z->middle[0], y = p[1] - z->middle[1];
    fold_place at = { 0.0, 0.0, radius_of(z, p), degrees_of(x, y) };
    const double r = (2.0 * at.radius - z->radius[0] - z->radius[1]) / (z->radius[1] - z->radius[0]);
    const double a = (2.0 * at.angle - z->angle[0] - z->angle[1]) / (z->angle[1] - z->angle[0]);
    at.along = z->rays ? r : a;
    at.across = z->rays ? a : r;
    return at;
}

/* Units of the face for a unit of `across`. */
static double length_of(const fold_zone *z, const fold_place *at)
{
    return z->rays ? at->radius * (PI / 180.0) : 1.0;
}

/* How much a zone covers a place, with some skin around its folds. */
static double cover_of(const fold_zone *z, const double p[3], double facing)
{
    const fold_place at = place_of(z, p);
    const double half = 0.5 * (z->rays ? z->angle[1] - z->angle[0] : z->radius[1] - z->radius[0]);
    const double u = at.along / 1.15, v = at.across / (1.0 + z->width / (half * length_of(z, &at)));
    double cover = 1.5 * (1.0 - u * u * u * u) * (1.0 - v * v * v * v);
    if (!(u * u < 1.0 && v * v < 1.0 && facing > 0.0 && p[2] > -BEHIND)) return 0.0;
    cover *= facing < 0.2 ? 5.0 * facing : 1.0;
    return cover < 1.0 ? cover : 1.0;
}

/* The arc through two points that bends away from the middle of the face by a share of their distance. */
static void set_arc(fold_zone *z, const double from[2], const double to[2], double bend)
{
    const double dx = to[0] - from[0], dy = to[1] - from[1], length = sqrt(dx * dx + dy * dy);
    const double radius = length * (0.5 * bend + 0.125 / bend), back = radius - bend * length;
    double ends[2];
    z->middle[0] = 0.5 * (from[0] + to[0]) + back * dy / length;
    z->middle[1] = 0.5 * (from[1] + to[1]) - back * dx / length;
    ends[0] = degrees_of(to[0] - z->middle[0], to[1] - z->middle[1]);
    ends[1] = degrees_of(from[0] - z->middle[0], from[1] - z->middle[1]);
    z->angle[0] = ends[0] - 0.1 * (ends[1] - ends[0]);
    z->angle[1] = ends[1] + 0.1 * (ends[1] - ends[0]);
    z->radius[0] = radius - 0.05;
    z->radius[1] = radius + 0.05;
}

/* Proportions of adult faces; widths and depths as they look right, not as they are measured. */
static void set_zones(const wrinkle_face *f, fold_zone *z)
{
    const double nose[2] = { 0.65 * f->mouth[0], 0.58 * f->mouth[1] };
    const double corner[2] = { f->mouth[0] + 0.1, f->mouth[1] - 0.02 };
    const double frown = 0.55 * f->brow + 0.54; /* from the point at which the lines between the brows would meet */
    *z++ = (fold_zone){ .region = 2,
                        .middle = { 0.0, f->brow + 3.42 },
                        .radius = { 2.64, 3.27 },
                        .angle = { -104, -76 },
                        .rise = 1,
                        .gain = 1,
                        .gap = 0.17,
                        .width = 0.083,
                        .depth = 0.028,
                        .most = 3 };
    *z++ = (fold_zone){ .region = 5,
                        .rays = 1,
                        .middle = { 0.0, -0.5 },
                        .radius = { frown - 0.22, frown + 0.22 },
                        .angle = { 78, 87 },
                        .rise = -1,
                        .gain = 1,
                        .gap = 12,
                        .width = 0.07,
                        .depth = 0.02,
                        .most = 1 };
    for (uint32_t right = 0; right < 2; right++) {
        const double side = right ? -1.0 : 1.0;
        *z++ = (fold_zone){ .region = right,
                            .rays = 1,
                            .side = side,
                            .middle = { 0.45, 0.0 },
                            .radius = { 0.29, 0.61 },
                            .angle = { -42, 26 },
                            .rise = 1,
                            .gain = 3,
                            .gap = 17,
                            .width = 0.037,
                            .depth = 0.0085,
                            .most = 3 };
        *z++ = (fold_zone){ .region = 3 + right,
                            .side = side,
                            .middle = { 0.5, 0.1 },
                            .radius = { 0.28, 0.48 },
                            .angle = { -144, -40 },
                            .rise = 1,
                            .gain = 3,
                            .gap = 0.085,
                            .width = 0.041,
                            .depth = 0.006,
                            .most = 2 };
        *z = (fold_zone){ .region = 6 + right,
                          .side = side,
                          .rise = 1,
                          .gain = 1,
                          .gap = 0.12,
                          .width = 0.075,
                          .depth = 0.022,
                          .hangs = 1,
                          .most = 1 };
        set_arc(z++, nose, corner, 0.05);
    }
    *z = (fold_zone){ .region = 9,
                      .middle = { 0.0, f->mouth[1] - 0.9 },
                      .radius = { 0.52, 0.7 },
                      .angle = { 60, 120 },
                      .gain = 1,
                      .gap = 0.3,
                      .width = 0.1,
                      .depth = 0.014,
                      .most = 1 };
}

/* ---- compression ---- */

/* The zone that covers a triangle most, NULL: none. across: its folds' normal, model space */
static const fold_zone *zone_of(const wrinkle_field *f, const wrinkle_folds *folds, uint32_t triangle, double across[3])
{
    const wrinkle_face *face = &folds->face;
    const fold_zone *zone = NULL;
    double corners[3][3], middle[3], a[3], b[3], normal[3], p[3], best = 0.0, towards[2], s, c;
    for (uint32_t k = 0; k < 3; k++) vec_posed(f->mesh->position, NULL, wrinkle_corner(f, triangle, k), corners[k]);
    for (int i = 0; i < 3; i++) {
        middle[i] = (corners[0][i] + corners[1][i] + corners[2][i]) / 3.0;
        a[i] = corners[1][i] - corners[0][i];
        b[i] = corners[2][i] - corners[0][i];
    }
    vec_cross(a, b, normal);
    if (!vec_normalize(normal)) return NULL;
    wrinkle_face_point(face, middle, p);
    for (uint32_t i = 0; i < FOLD_ZONES; i++) {
        const double cover = cover_of(&folds->zones[i], p, vec_dot(normal, face->axis[2]));
        if (!(cover > best)) continue;
        best = cover;
        zone = &folds->zones[i];
    }
    if (!zone) return NULL;
    angle_sin_cos_degrees(place_of(zone, p).angle, &s, &c);
    towards[0] = zone->rays ? -s : c;
    towards[1] = zone->rays ? c : s;
    towards[0] *= flip_of(zone, p[0]);
    for (int i = 0; i < 3; i++) across[i] = towards[0] * face->axis[0][i] + towards[1] * face->axis[1][i];
    vec_reject(across, normal);
    return vec_normalize(across) ? zone : NULL;
}

/* Edges of a triangle from its first corner. */
static void edges_of(const wrinkle_field *f, uint32_t triangle, const float *delta, double edge[2][3])
{
    double p[3][3];
    for (uint32_t k = 0; k < 3; k++) vec_posed(f->mesh->position, delta, wrinkle_corner(f, triangle, k), p[k]);
    for (int i = 0; i < 6; i++) edge[i / 3][i % 3] = p[1 + i / 3][i % 3] - p[0][i % 3];
}

/* Whether a target moves a triangle the way that folds its zone. */
static int moves_so(const wrinkle_field *f, const wrinkle_face *face, const fold_zone *z, uint32_t triangle,
                    const float *delta)
{
    double rise = 0.0;
    for (uint32_t i = 0; i < 9; i++) {
        rise += face->axis[1][i % 3] * (double)delta[3 * (size_t)wrinkle_corner(f, triangle, i / 3) + i % 3];
    }
    return z->rise * rise >= 0.0;
}

/* How much each target shortens a triangle along a unit direction in its plane. Brows that come down fold the skin
 * between them, in whichever direction they compress it. */
static void measure_across(wrinkle_field *f, const wrinkle_face *face, const fold_zone *z, uint32_t triangle,
                           const double direction[3])
{
    float *shrink = &f->shrink[(size_t)triangle * f->mesh->target_count];
    double rest[2][3], share[2], aa, ab, bb, ad, bd;
    edges_of(f, triangle, NULL, rest);
    aa = vec_dot(rest[0], rest[0]), ab = vec_dot(rest[0], rest[1]), bb = vec_dot(rest[1], rest[1]);
    ad = vec_dot(rest[0], direction), bd = vec_dot(rest[1], direction);
    share[0] = (bb * ad - ab * bd) / (aa * bb - ab * ab);
    share[1] = (aa * bd - ab * ad) / (aa * bb - ab * ab);
    f->largest[triangle] = 0.0f;
    for (uint32_t t = 0; t < f->mesh->target_count; t++) {
        const float *delta = f->mesh->targets[t].position;
        double now[2][3], moved[3], less = (double)shrink[t];
        if (!(less > 0.0)) continue;
        edges_of(f, triangle, delta, now);
        for (int i = 0; i < 3; i++) moved[i] = share[0] * now[0][i] + share[1] * now[1][i];
        if (z->rise >= 0.0) less = z->gain * (1.0 - sqrt(vec_dot(moved, moved)));
        if (!moves_so(f, face, z, triangle, delta)) less = 0.0;
        shrink[t] = less > 0.0 ? (float)less : 0.0f;
        f->largest[triangle] = fmaxf(f->largest[triangle], shrink[t]);
    }
}

int wrinkle_folds_find(wrinkle_field *field, const recipe_text *recipe, wrinkle_folds *out)
{
    memset(out, 0, sizeof *out);
    if (!wrinkle_face_find(field, recipe, &out->face)) return 0;
    set_zones(&out->face, out->zones);
    for (uint32_t i = 0; i < field->triangle_count; i++) {
        double across[3];
        const fold_zone *z = zone_of(field, out, i, across);
        if (z) measure_across(field, &out->face, z, i, across);
    }
    return 1;
}

double wrinkle_folds_finest(const wrinkle_folds *folds)
{
    double width = folds->zones[0].width;
    for (uint32_t i = 1; i < FOLD_ZONES; i++) width = fmin(width, folds->zones[i].width);
    return 2.0 * width * folds->face.unit;
}

/* ---- places ---- */

static void texel_point(const wrinkle_field *f, const wrinkle_raster *r, const wrinkle_face *face, size_t at,
                        double p[3])
{
    double sum[3] = { 0 };
    for (uint32_t k = 0; k < 3; k++) {
        const float *corner = f->mesh->position + 3 * (size_t)wrinkle_corner(f, r->triangle[at], k);
        for (int i = 0; i < 3; i++) sum[i] += (double)(r->share[at][k] * corner[i]);
    }
    wrinkle_face_point(face, sum, p);
}

/* An angle costs more than a radius, which decides for most of the face. */
static int is_outside(const fold_zone *z, double radius)
{
    return radius < z->radius[0] || radius > z->radius[1];
}

/* The mean compression by bins across a zone, blurred. */
static void measure_zone(const wrinkle_field *f, const wrinkle_raster *r, const wrinkle_face *face, const fold_zone *z,
                         double out[BINS])
{
    double sum[BINS] = { 0 }, count[BINS] = { 0 };
    for (size_t at = 0; at < (size_t)r->width * r->height; at++) {
        double p[3];
        fold_place in;
        int bin;
        if (r->triangle[at] == MODEL_NONE) continue;
        texel_point(f, r, face, at, p);
        if (p[2] < -BEHIND || is_outside(z, radius_of(z, p))) continue;
        in = place_of(z, p);
        bin = (int)floor(0.5 * (in.across + 1.0) * BINS);
        if (bin < 0 || bin >= BINS || fabs(in.along) > 0.8) continue;
        sum[bin] += (double)f->largest[r->triangle[at]];
        count[bin] += 1.0;
    }
    for (int i = 0; i < BINS; i++) {
        double weights = 0.0, mean = 0.0;
        for (int k = -BLUR; k <= BLUR; k++) {
            if (i + k < 0 || i + k >= BINS || count[i + k] < 1.0) continue;
            mean += (BLUR + 1 - abs(k)) * sum[i + k] / count[i + k];
            weights += BLUR + 1 - abs(k);
        }
        out[i] = weights > 0.0 ? mean / weights : 0.0;
    }
}

/* Evenly about the middle of the compression, as far as they stay inside; each as deep as its own place asks for. */
static void place_zone(fold_zone *z, const double shrink[BINS])
{
    const double *range = z->rays ? z->angle : z->radius;
    const double step = (range[1] - range[0]) / BINS, reach = 0.5 * (z->most - 1.0) * z->gap;
    double most = 0.0, sum = 0.0, middle = 0.0;
    for (int i = 0; i < BINS; i++) {
        most = fmax(most, shrink[i]);
        sum += shrink[i];
        middle += shrink[i] * (range[0] + (i + 0.5) * step);
    }
    if (most < SHRINK_LEAST) return;
    middle = fmin(fmax(middle / sum, range[0] + reach), range[1] - reach);
    for (z->count = 0; z->count < z->most; z->count++) {
        const double at = middle - reach + z->count * z->gap, bin = fmin((at - range[0]) / step, BINS - 1.0);
        z->at[z->count] = at;
        z->share[z->count] = SHARE_LEAST + (1.0 - SHARE_LEAST) * sqrt(shrink[(int)bin] / most);
    }
}

int wrinkle_folds_place(const wrinkle_field *field, const wrinkle_raster *raster, double finest, wrinkle_folds *folds)
{
    int any = 0;
    for (uint32_t i = 0; i < FOLD_ZONES; i++) {
        double shrink[BINS];
        measure_zone(field, raster, &folds->face, &folds->zones[i], shrink);
        place_zone(&folds->zones[i], shrink);
        folds->zones[i].width = fmax(folds->zones[i].width, 0.5 * finest / folds->face.unit);
        any = any || folds->zones[i].count;
    }
    return any;
}

/* ---- maps ---- */

/* Across a fold, 1 at its bottom: a narrow valley between low shoulders. Where one side hangs over the other, that side
 * alone has a shoulder, and the other rises slowly. far: from the bottom, 1 at the end of a shoulder */
static double profile_of(const fold_zone *z, double far)
{
    const int slow = z->hangs && far < 0.0;
    const double at = slow ? far / SLOW : far, even = 1.0 - at * at;
    return even > 0.0 ? even * even * (slow ? 1.0 : 1.0 - SHOULDER * at * at) : 0.0;
}

/* Whether a fold is even skin at this place across: the wave that moves it is at most 1. */
static int is_far(const fold_zone *z, uint32_t fold, double across, double length)
{
    return (fabs(across - z->at[fold]) - WOBBLE * z->gap) * length > 1.001 * SLOW * z->width;
}

static int is_far_from_all(const fold_zone *z, const double p[3])
{
    const double radius = radius_of(z, p);
    uint32_t k = 0;
    if (z->rays) return is_outside(z, radius);
    while (k < z->count && is_far(z, k, radius, 1.0)) k++;
    return k == z->count;
}

/* Below the skin, face units; folds fade to their ends. */
static double height_at(const wrinkle_folds *folds, const double p[3])
{
    double height = 0.0;
    for (uint32_t i = 0; i < FOLD_ZONES; i++) {
        const fold_zone *z = &folds->zones[i];
        fold_place at;
        if (z->count == 0 || is_far_from_all(z, p)) continue;
        at = place_of(z, p);
        for (uint32_t k = 0; k < z->count && fabs(at.along) < 1.0; k++) {
            if (is_far(z, k, across_of(z, &at), length_of(z, &at))) continue;
            const double end = at.along / (1.0 - 0.12 * k), taper = 1.0 - end * end;
            double wave, cosine, far;
            angle_sin_cos_degrees(130.0 * at.along + 97.0 * k, &wave, &cosine);
            far = (across_of(z, &at) - z->at[k] - WOBBLE * z->gap * wave) * length_of(z, &at) / z->width;
            if (taper > 0.0) height -= z->depth * z->share[k] * taper * taper * profile_of(z, far);
        }
    }
    return height;
}

/* The slope of the height in a direction of the surface, model space. */
static double slope_along(const wrinkle_folds *folds, const double p[3], const double direction[3])
{
    double d[3], before[3], after[3];
    wrinkle_face_direction(&folds->face, direction, d);
    for (int i = 0; i < 3; i++) {
        before[i] = p[i] - STEP * d[i];
        after[i] = p[i] + STEP * d[i];
    }
    return (height_at(folds, after) - height_at(folds, before)) / (2.0 * STEP);
}

static void normal_at(const wrinkle_field *f, const wrinkle_raster *r, const wrinkle_folds *folds, size_t at,
                      uint8_t *rgba)
{
    double tangent[3], bitangent[3], normal[3], p[3], n[3] = { 0.0, 0.0, 1.0 };
    wrinkle_raster_frame(r, f, at, tangent, bitangent, normal);
    texel_point(f, r, &folds->face, at, p);
    if (vec_dot(normal, folds->face.axis[2]) <= 0.0 || p[2] < -BEHIND) return;
    n[0] = -slope_along(folds, p, tangent);
    n[1] = -slope_along(folds, p, bitangent);
    (void)vec_normalize(n);
    for (int i = 0; i < 3; i++) rgba[i] = (uint8_t)(128.5 + 127.0 * n[i]);
}

uint8_t *wrinkle_folds_map(const wrinkle_field *field, const wrinkle_raster *raster, const wrinkle_folds *folds)
{
    const size_t count = (size_t)raster->width * raster->height;
    uint8_t *map = model_zeros(count, 4);
    for (size_t at = 0; at < count && map; at++) {
        memcpy(map + 4 * at, (const uint8_t[4]){ 128, 128, 255, 255 }, 4);
        if (raster->triangle[at] != MODEL_NONE) normal_at(field, raster, folds, at, map + 4 * at);
    }
    if (map && wrinkle_raster_dilate(raster, map, 8)) {
        free(map);
        map = NULL;
    }
    return map;
}

region_weights *wrinkle_folds_regions(const wrinkle_field *field, const wrinkle_folds *folds)
{
    const model_mesh *mesh = field->mesh;
    region_weights *weights = model_zeros(mesh->vertex_count, sizeof *weights);
    for (uint32_t v = 0; v < mesh->vertex_count && weights; v++) {
        double at[3], p[3], normal[3];
        vec_posed(mesh->position, NULL, v, at);
        vec_posed(mesh->normal, NULL, v, normal);
        wrinkle_face_point(&folds->face, at, p);
        for (uint32_t i = 0; i < FOLD_ZONES; i++) {
            const fold_zone *z = &folds->zones[i];
            if (z->count) weights[v][z->region] = (float)cover_of(z, p, vec_dot(normal, folds->face.axis[2]));
        }
    }
    return weights;
}
