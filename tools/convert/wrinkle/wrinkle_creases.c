#include "wrinkle_creases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/angle.h"
#include "convert/model/model_build.h"

#define PI 3.14159265358979323846
#define SPACINGS 31.0     /* creases along the diagonal of what targets move */
#define SHRINK_LEAST 0.01 /* where less is compressed, nothing is drawn */
#define WAVE_LEAST 5.0    /* texels from crease to crease: finer ones would be noise, */
#define WAVE_MOST 24.0    /* coarser ones take long to compute */
#define ROUNDS 8          /* of the filter */
#define REACH 0.8         /* of the filter, in distances from crease to crease */
#define LEAN 10.0         /* degrees from the axis of its triangle alone that a slope may be off */
#define GAIN 4.0          /* remaining noise grows into creases, which stay */
#define FOLD_FROM 0.05    /* compression that skin takes up almost as it is, */
#define FOLD_ALL 0.3      /* and from which on all of it folds */
#define FOLD_LEAST 0.25
#define SLOPE_MOST 0.42   /* of a crease's side */
#define SLOPE_BY_ROOT 1.1 /* a sine that hides a share c of a length has the slope 2 sqrt(c); skin hides less */

/* A texel that is compressed. */
typedef struct crease {
    double u[3], v[3];    /* model units to the next texel to the right, and to the one below */
    double across[3];     /* unit, in the surface: of the slope */
    float wave_x, wave_y; /* degrees from it to those two */
    float depth;          /* model units from ridge to valley */
    int reach;            /* texels that its filter takes in on each side; 0: not compressed */
} crease;

typedef struct canvas {
    const wrinkle_field *field;
    const wrinkle_raster *raster;
    double spacing;
    crease *creases; /* [height][width] */
    float *wave;     /* [height][width] -1 valley, 1 ridge */
} canvas;

/* ---- directions ---- */

/* Model units by texel of a triangle, along x and y of the texture. */
static int texel_steps(const canvas *c, uint32_t triangle, double u[3], double v[3])
{
    const model_mesh *mesh = c->field->mesh;
    double p[3][3], uv[3][2], det;
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t vertex = wrinkle_corner(c->field, triangle, k);
        vec_posed(mesh->position, NULL, vertex, p[k]);
        uv[k][0] = (double)mesh->uv[2 * (size_t)vertex] * c->raster->width;
        uv[k][1] = (double)mesh->uv[2 * (size_t)vertex + 1] * c->raster->height;
    }
    det = (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) - (uv[2][0] - uv[0][0]) * (uv[1][1] - uv[0][1]);
    for (int i = 0; i < 3 && (det > 1e-9 || det < -1e-9); i++) {
        const double a = p[1][i] - p[0][i], b = p[2][i] - p[0][i];
        u[i] = (a * (uv[2][1] - uv[0][1]) - b * (uv[1][1] - uv[0][1])) / det;
        v[i] = (b * (uv[1][0] - uv[0][0]) - a * (uv[2][0] - uv[0][0])) / det;
    }
    return det > 1e-9 || det < -1e-9;
}

/* The mean tensor of a texel's corners. */
static void tensor_at(const canvas *c, size_t at, double t[6])
{
    memset(t, 0, 6 * sizeof *t);
    for (uint32_t k = 0; k < 3; k++) {
        const double *corner = c->field->tensor[wrinkle_corner(c->field, c->raster->triangle[at], k)];
        for (int i = 0; i < 6; i++) {
            t[i] += (double)c->raster->share[at][k] * corner[i];
        }
    }
}

/* The direction of a crease: the larger principal axis of a tensor in the plane of u and v. */
static void crease_axis(const double t[6], const double *u, const double *v, double axis[3])
{
    double x[3], y[3], xx, xy, yy, half, root, a, b;
    memcpy(x, u, sizeof x);
    memcpy(y, v, sizeof y);
    (void)vec_normalize(x);
    vec_reject(y, x);
    (void)vec_normalize(y);
    {
        const double tx[3] = { t[0] * x[0] + t[3] * x[1] + t[4] * x[2], t[3] * x[0] + t[1] * x[1] + t[5] * x[2],
                               t[4] * x[0] + t[5] * x[1] + t[2] * x[2] };
        const double ty[3] = { t[0] * y[0] + t[3] * y[1] + t[4] * y[2], t[3] * y[0] + t[1] * y[1] + t[5] * y[2],
                               t[4] * y[0] + t[5] * y[1] + t[2] * y[2] };
        xx = vec_dot(tx, x);
        xy = vec_dot(tx, y);
        yy = vec_dot(ty, y);
    }
    half = 0.5 * (xx - yy);
    root = sqrt(half * half + xy * xy);
    a = half >= 0.0 ? half + root : xy;
    b = half >= 0.0 ? xy : root - half;
    for (int i = 0; i < 3; i++) {
        axis[i] = a * x[i] + b * y[i];
    }
    if (!vec_normalize(axis)) memcpy(axis, x, sizeof x);
}

/* Turn an axis towards another one until they are no further than LEAN apart. */
static void lean(double axis[3], const double to[3])
{
    const double sign = vec_dot(axis, to) < 0.0 ? -1.0 : 1.0, cosine = sign * vec_dot(axis, to);
    double side[3], s, c;
    for (int i = 0; i < 3; i++) {
        side[i] = sign * axis[i];
    }
    vec_reject(side, to);
    angle_sin_cos_degrees(LEAN, &s, &c);
    if (cosine >= c || !vec_normalize(side)) return;
    for (int i = 0; i < 3; i++) {
        axis[i] = c * to[i] + s * side[i];
    }
}

/* How much a texel is compressed: the mean of its corners. */
static double shrink_at(const canvas *c, size_t at)
{
    double shrink = 0.0;
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t vertex = wrinkle_corner(c->field, c->raster->triangle[at], k);
        shrink += (double)c->raster->share[at][k] * (double)c->field->point_largest[vertex];
    }
    return shrink;
}

/* Degrees from texel to texel across creases `spacing` apart, within what the texture can show. */
static void set_wave(const canvas *c, crease *to)
{
    const double x = 360.0 / c->spacing * vec_dot(to->across, to->u),
                 y = 360.0 / c->spacing * vec_dot(to->across, to->v);
    const double texels = 360.0 / sqrt(x * x + y * y + 1e-30);
    const double held = texels < WAVE_LEAST ? WAVE_LEAST : texels > WAVE_MOST ? WAVE_MOST : texels;
    to->wave_x = (float)(x * texels / held);
    to->wave_y = (float)(y * texels / held);
    to->depth = (float)(c->spacing * held / texels);
    to->reach = (int)(REACH * held + 0.5);
}

/* The share of a compression that folds. Skin takes up little of it as it is: it wrinkles where much is asked. */
static double folded(double shrink)
{
    const double t = (shrink - FOLD_FROM) / (FOLD_ALL - FOLD_FROM), at = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    return FOLD_LEAST + (1.0 - FOLD_LEAST) * at * at * (3.0 - 2.0 * at);
}

static void set_crease(const canvas *c, size_t at)
{
    crease *to = &c->creases[at];
    double t[6], axis[3], own[3], normal[3], shrink, slope;
    if (c->raster->triangle[at] == MODEL_NONE || (shrink = shrink_at(c, at)) < SHRINK_LEAST ||
        !texel_steps(c, c->raster->triangle[at], to->u, to->v)) {
        return;
    }
    tensor_at(c, at, t);
    crease_axis(t, to->u, to->v, axis);
    vec_cross(to->u, to->v, normal);
    if (!vec_normalize(normal)) return;
    vec_cross(normal, axis, to->across);
    set_wave(c, to);
    crease_axis(c->field->demand[c->raster->triangle[at]], to->u, to->v, own);
    lean(axis, own);
    vec_cross(normal, axis, to->across);
    slope = SLOPE_BY_ROOT * sqrt(shrink) * folded(shrink);
    to->depth *= (float)((slope < SLOPE_MOST ? slope : SLOPE_MOST) / PI); /* a sine's slope is pi * depth / length */
}

/* ---- stripes ---- */

static float noise(size_t at)
{
    uint64_t h = ((uint64_t)at + 1u) * 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 31)) * 0xbf58476d1ce4e5b9u;
    h ^= h >> 29;
    return (float)(h >> 40) * (2.0f / 16777216.0f) - 1.0f;
}

#define REACH_MAX 25

/* Cosine and sine of whole steps, from -reach to reach. */
static void turns(float step, int reach, float cosine[2 * REACH_MAX + 1], float sine[2 * REACH_MAX + 1])
{
    double s, c, turned_s = 0.0, turned_c = 1.0;
    angle_sin_cos_degrees((double)step, &s, &c);
    for (int i = 0; i <= reach; i++) {
        const double last = turned_s;
        cosine[reach + i] = cosine[reach - i] = (float)turned_c;
        sine[reach + i] = (float)turned_s;
        sine[reach - i] = (float)-turned_s;
        turned_s = turned_s * c + turned_c * s;
        turned_c = turned_c * c - last * s;
    }
}

/* The filter at one texel: a cosine across the crease in a round window, without its mean. */
static float filter(const canvas *c, uint32_t x, uint32_t y)
{
    const uint32_t width = c->raster->width, height = c->raster->height;
    const crease *k = &c->creases[(size_t)y * width + x];
    const int r = k->reach;
    float cx[2 * REACH_MAX + 1], sx[2 * REACH_MAX + 1], cy[2 * REACH_MAX + 1], sy[2 * REACH_MAX + 1];
    float sum = 0.0f, waves = 0.0f, windows = 0.0f, values = 0.0f;
    turns(k->wave_x, r, cx, sx);
    turns(k->wave_y, r, cy, sy);
    for (int dy = -r; dy <= r; dy++) {
        const int64_t ny = (int64_t)y + dy;
        for (int dx = -r; dx <= r && ny >= 0 && ny < height; dx++) {
            const int64_t nx = (int64_t)x + dx;
            const float far = (float)(dx * dx + dy * dy) / (float)((r + 1) * (r + 1));
            float window, wave;
            if (far >= 1.0f || nx < 0 || nx >= width || !c->creases[(size_t)ny * width + (size_t)nx].reach) continue;
            window = (1.0f - far) * (1.0f - far);
            wave = window * (cx[dx + r] * cy[dy + r] - sx[dx + r] * sy[dy + r]);
            sum += wave * c->wave[(size_t)ny * width + (size_t)nx];
            values += window * c->wave[(size_t)ny * width + (size_t)nx];
            waves += wave;
            windows += window;
        }
    }
    return (sum - waves / windows * values) / windows;
}

static int grow(canvas *c)
{
    const size_t count = (size_t)c->raster->width * c->raster->height;
    float *next = model_zeros(count, sizeof *next);
    for (size_t i = 0; i < count; i++) {
        c->wave[i] = c->creases[i].reach ? noise(i) : 0.0f;
    }
    for (int round = 0; round < ROUNDS && next; round++) {
        float *swap = c->wave;
        for (size_t i = 0; i < count; i++) {
            if (c->creases[i].reach) {
                const float v = (float)GAIN *
                                filter(c, (uint32_t)(i % c->raster->width), (uint32_t)(i / c->raster->width));
                next[i] = v / sqrtf(1.0f + v * v);
            }
        }
        c->wave = next;
        next = swap;
    }
    free(next);
    return !next;
}

/* ---- normals ---- */

/* Model units above the valley: a narrow valley, a broad ridge. */
static double height_at(const canvas *c, size_t at)
{
    const double below = 0.5 - 0.5 * (double)c->wave[at];
    return c->creases[at].reach ? -(double)c->creases[at].depth * below * below : 0.0;
}

/* The difference of heights to the next texel, from both sides; 0 across the border of the compressed area. */
static double height_step(const canvas *c, uint32_t x, uint32_t y, int down)
{
    const uint32_t width = c->raster->width;
    const size_t at = (size_t)y * width + x, step = down ? width : 1;
    const int before = down ? y > 0 : x > 0, after = down ? y + 1 < c->raster->height : x + 1 < width;
    const size_t a = before && c->creases[at - step].reach ? at - step : at;
    const size_t b = after && c->creases[at + step].reach ? at + step : at;
    const size_t steps = (b - a) / step;
    return b > a ? (height_at(c, b) - height_at(c, a)) / (double)steps : 0.0;
}

/* Slopes count across the crease only: where stripes end or meet, nothing leads in another direction. */
static void normal_at(const canvas *c, uint32_t x, uint32_t y, uint8_t *rgba)
{
    const size_t at = (size_t)y * c->raster->width + x;
    const crease *k = &c->creases[at];
    const double hx = height_step(c, x, y, 0), hy = height_step(c, x, y, 1);
    const double uu = vec_dot(k->u, k->u), uv = vec_dot(k->u, k->v), vv = vec_dot(k->v, k->v), det = uu * vv - uv * uv;
    double tangent[3], bitangent[3], normal[3], gradient[3], n[3], slope;
    if (!(det > 0.0)) return;
    for (int i = 0; i < 3; i++) {
        gradient[i] = ((vv * hx - uv * hy) * k->u[i] + (uu * hy - uv * hx) * k->v[i]) / det;
    }
    wrinkle_raster_frame(c->raster, c->field, at, tangent, bitangent, normal);
    slope = vec_dot(gradient, k->across);
    n[0] = -slope * vec_dot(k->across, tangent);
    n[1] = -slope * vec_dot(k->across, bitangent);
    n[2] = 1.0;
    (void)vec_normalize(n);
    for (int i = 0; i < 3; i++) {
        rgba[i] = (uint8_t)(128.5 + 127.0 * n[i]);
    }
}

uint8_t *wrinkle_creases_make(const wrinkle_field *field, const wrinkle_raster *raster, double spacing)
{
    const size_t count = (size_t)raster->width * raster->height;
    canvas c = { field, raster, spacing, model_zeros(count, sizeof *c.creases), model_zeros(count, sizeof *c.wave) };
    uint8_t *map = model_zeros(count, 4);
    int failed = !c.creases || !c.wave || !map;
    for (size_t at = 0; at < count && !failed; at++) {
        set_crease(&c, at);
        memcpy(map + 4 * at, (const uint8_t[4]){ 128, 128, 255, 255 }, 4);
    }
    failed = failed || grow(&c);
    for (size_t at = 0; at < count && !failed; at++) {
        if (c.creases[at].reach)
            normal_at(&c, (uint32_t)(at % raster->width), (uint32_t)(at / raster->width), map + 4 * at);
    }
    failed = failed || wrinkle_raster_dilate(raster, map, 8);
    free(c.creases);
    free(c.wave);
    if (failed) {
        free(map);
        map = NULL;
    }
    return map;
}

double wrinkle_spacing(const wrinkle_field *field)
{
    double low[3] = { 0 }, high[3] = { 0 }, diagonal = 0.0;
    int any = 0;
    for (uint32_t i = 0; i < 3 * field->triangle_count; i++) {
        const uint32_t v = wrinkle_corner(field, i / 3, i % 3);
        for (int k = 0; k < 3 && field->point_largest[v] >= (float)SHRINK_LEAST; k++) {
            const double p = (double)field->mesh->position[3 * (size_t)v + (size_t)k];
            low[k] = !any || p < low[k] ? p : low[k];
            high[k] = !any || p > high[k] ? p : high[k];
        }
        any = any || field->point_largest[v] >= (float)SHRINK_LEAST;
    }
    for (int k = 0; k < 3; k++) {
        diagonal += (high[k] - low[k]) * (high[k] - low[k]);
    }
    return sqrt(diagonal) / SPACINGS;
}
