#include "wrinkle_raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

#define INSIDE 0.02   /* this far inside a second triangle, in shares, is no rounding at a common edge */
#define REPEATS_MAX 4 /* a triangle over more repeats of the texture than that covers all of it anyway */

typedef struct flat_triangle {
    double x[3], y[3], area; /* texels; twice the area, signed */
} flat_triangle;

static int flatten(const wrinkle_field *f, uint32_t i, const wrinkle_raster *r, flat_triangle *t)
{
    for (uint32_t k = 0; k < 3; k++) {
        const float *uv = f->mesh->uv + 2 * (size_t)wrinkle_corner(f, i, k);
        t->x[k] = (double)uv[0] * r->width;
        t->y[k] = (double)uv[1] * r->height;
    }
    t->area = (t->x[1] - t->x[0]) * (t->y[2] - t->y[0]) - (t->x[2] - t->x[0]) * (t->y[1] - t->y[0]);
    return t->area > 1e-9 || t->area < -1e-9;
}

static double least_of(const double v[3])
{
    return v[0] < v[1] ? (v[0] < v[2] ? v[0] : v[2]) : (v[1] < v[2] ? v[1] : v[2]);
}

static double most_of(const double v[3])
{
    return v[0] > v[1] ? (v[0] > v[2] ? v[0] : v[2]) : (v[1] > v[2] ? v[1] : v[2]);
}

static void shares_at(const flat_triangle *t, double x, double y, double share[3])
{
    share[1] = ((x - t->x[0]) * (t->y[2] - t->y[0]) - (t->x[2] - t->x[0]) * (y - t->y[0])) / t->area;
    share[2] = ((t->x[1] - t->x[0]) * (y - t->y[0]) - (x - t->x[0]) * (t->y[1] - t->y[0])) / t->area;
    share[0] = 1.0 - share[1] - share[2];
}

static uint32_t repeat(int64_t at, uint32_t size)
{
    const int64_t rest = at % (int64_t)size;
    return (uint32_t)(rest < 0 ? rest + (int64_t)size : rest);
}

static void claim(wrinkle_raster *r, uint32_t triangle, const flat_triangle *t, int64_t x, int64_t y)
{
    const size_t at = (size_t)repeat(y, r->height) * r->width + repeat(x, r->width);
    double share[3];
    shares_at(t, (double)x + 0.5, (double)y + 0.5, share);
    if (least_of(share) < 0.0) {
        return;
    }
    if (r->triangle[at] == MODEL_NONE) {
        r->triangle[at] = triangle;
        r->covered++;
        for (int k = 0; k < 3; k++) {
            r->share[at][k] = (float)share[k];
        }
    } else if (least_of(share) > INSIDE) {
        const double first[3] = { (double)r->share[at][0], (double)r->share[at][1], (double)r->share[at][2] };
        r->overlapped += least_of(first) > INSIDE;
    }
}

static void draw(wrinkle_raster *r, uint32_t triangle, const flat_triangle *t)
{
    const double left = least_of(t->x), right = most_of(t->x), top = least_of(t->y), bottom = most_of(t->y);
    if (!(right - left <= (double)REPEATS_MAX * r->width && bottom - top <= (double)REPEATS_MAX * r->height) ||
        !(left > -1e9 && right < 1e9 && top > -1e9 && bottom < 1e9)) {
        r->overlapped += r->width * r->height;
        return;
    }
    for (int64_t y = (int64_t)floor(top); y <= (int64_t)floor(bottom); y++) {
        for (int64_t x = (int64_t)floor(left); x <= (int64_t)floor(right); x++) {
            claim(r, triangle, t, x, y);
        }
    }
}

int wrinkle_raster_make(const wrinkle_field *field, uint32_t width, uint32_t height, wrinkle_raster *out)
{
    const size_t count = (size_t)width * height;
    flat_triangle t;
    *out = (wrinkle_raster){ .width = width, .height = height };
    memcpy(out->clamped, field->clamped, sizeof out->clamped);
    out->triangle = model_zeros(count, sizeof *out->triangle);
    out->share = model_zeros(count, sizeof *out->share);
    if (!out->triangle || !out->share) {
        return 1;
    }
    memset(out->triangle, 0xff, count * sizeof *out->triangle);
    for (uint32_t i = 0; i < field->triangle_count; i++) {
        if (flatten(field, i, out, &t)) draw(out, i, &t);
    }
    return 0;
}

void wrinkle_raster_free(wrinkle_raster *r)
{
    free(r->triangle);
    free(r->share);
    memset(r, 0, sizeof *r);
}

void wrinkle_raster_frame(const wrinkle_raster *r, const wrinkle_field *field, size_t at, double tangent[3],
                          double bitangent[3], double normal[3])
{
    const model_mesh *mesh = field->mesh;
    double sign = 1.0;
    memset(normal, 0, 3 * sizeof *normal);
    memset(tangent, 0, 3 * sizeof *tangent);
    for (uint32_t k = 0; k < 3; k++) {
        const size_t v = wrinkle_corner(field, r->triangle[at], k);
        for (int i = 0; i < 3; i++) {
            normal[i] += (double)r->share[at][k] * (double)mesh->normal[3 * v + (size_t)i];
            tangent[i] += (double)r->share[at][k] * (double)mesh->tangent[4 * v + (size_t)i];
        }
        sign = (double)mesh->tangent[4 * v + 3];
    }
    (void)vec_normalize(normal);
    vec_reject(tangent, normal);
    (void)vec_normalize(tangent);
    vec_cross(normal, tangent, bitangent);
    for (int i = 0; i < 3; i++) bitangent[i] *= sign;
}

/* The mean of the filled neighbours of an empty texel. */
static int fill_texel(const wrinkle_raster *r, const uint8_t *filled, const uint8_t *from, uint32_t x, uint32_t y,
                      uint8_t *to)
{
    uint32_t sum[4] = { 0 }, count = 0;
    for (uint32_t i = 0; i < 9; i++) {
        const int64_t nx = (int64_t)x + (int64_t)(i % 3) - 1, ny = (int64_t)y + (int64_t)(i / 3) - 1;
        const size_t at = (size_t)repeat(ny, r->height) * r->width + repeat(nx, r->width);
        if (r->clamped[0] && (nx < 0 || nx >= (int64_t)r->width)) continue;
        if (r->clamped[1] && (ny < 0 || ny >= (int64_t)r->height)) continue;
        for (uint32_t c = 0; c < 4 && filled[at]; c++) {
            sum[c] += from[4 * at + c];
        }
        count += filled[at];
    }
    for (uint32_t c = 0; c < 4 && count; c++) {
        to[c] = (uint8_t)((sum[c] + count / 2) / count);
    }
    return count > 0;
}

static void dilate_once(const wrinkle_raster *r, uint8_t *rgba, const uint8_t *from, uint8_t *filled,
                        const uint8_t *before)
{
    for (uint32_t y = 0; y < r->height; y++) {
        for (uint32_t x = 0; x < r->width; x++) {
            const size_t at = (size_t)y * r->width + x;
            if (!before[at]) filled[at] = (uint8_t)fill_texel(r, before, from, x, y, rgba + 4 * at);
        }
    }
}

int wrinkle_raster_dilate(const wrinkle_raster *r, uint8_t *rgba, uint32_t rounds)
{
    const size_t count = (size_t)r->width * r->height;
    uint8_t *filled = model_zeros(count, 1), *before = model_zeros(count, 1), *from = model_zeros(count, 4);
    const int failed = !filled || !before || !from;
    for (size_t i = 0; i < count && !failed; i++) {
        filled[i] = r->triangle[i] != MODEL_NONE;
    }
    for (uint32_t round = 0; round < rounds && !failed; round++) {
        memcpy(before, filled, count);
        memcpy(from, rgba, 4 * count);
        dilate_once(r, rgba, from, filled, before);
    }
    free(filled);
    free(before);
    free(from);
    return failed;
}
