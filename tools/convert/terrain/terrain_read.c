#include "terrain_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/file_kind.h"
#include "convert/base/image_file.h"
#include "convert/model/affine.h"
#include "convert/model/model.h"

#define POINTS 257u

static int check_sides(uint32_t width, uint32_t depth, model_error *error)
{
    if (width >= 2u && depth >= 2u && width <= NOH_TERRAIN_SIZE_MAX && depth <= NOH_TERRAIN_SIZE_MAX) return 0;
    return model_fail(error, "", "a terrain must have 2 to %u heights along a side, not %u x %u", NOH_TERRAIN_SIZE_MAX,
                      width, depth);
}

static void find_range(terrain *t)
{
    uint16_t low = 65535, high = 0;
    for (size_t i = 0; i < (size_t)t->width * t->depth; i++) {
        if (t->heights[i] < low) low = t->heights[i];
        if (t->heights[i] > high) high = t->heights[i];
    }
    t->low = t->origin[1] + (float)low * t->scale;
    t->high = t->origin[1] + (float)high * t->scale;
}

/* ---- pictures ---- */

static int read_picture(const char *path, const terrain_options *o, terrain *t, model_error *error)
{
    if (image_read_grey(path, &t->width, &t->depth, &t->heights, error) || check_sides(t->width, t->depth, error)) {
        return 1;
    }
    const double size = o->size_m > 0.0 ? o->size_m : (double)(t->width - 1u), spacing = size / (t->width - 1u);
    t->spacing = (float)spacing;
    t->scale = (float)((o->height_m > 0.0 ? o->height_m : 0.1 * size) / 65535.0);
    t->origin[0] = (float)(-0.5 * spacing * (t->width - 1u));
    t->origin[2] = (float)(-0.5 * spacing * (t->depth - 1u));
    return 0;
}

/* ---- models ---- */

typedef struct surface {
    double *corners; /* [count][3][3], metres */
    size_t count;
    double low[3], high[3];
} surface;

static size_t count_triangles(const model *m)
{
    size_t count = 0;
    for (uint32_t i = 0; i < m->node_count; i++) {
        if (m->nodes[i].mesh != MODEL_NONE) count += m->meshes[m->nodes[i].mesh].index_count / 3u;
    }
    return count;
}

static void add_corner(surface *s, size_t corner, const double at[3])
{
    for (int k = 0; k < 3; k++) {
        s->corners[3u * corner + (size_t)k] = at[k];
        s->low[k] = corner ? fmin(s->low[k], at[k]) : at[k];
        s->high[k] = corner ? fmax(s->high[k], at[k]) : at[k];
    }
}

static int surface_of(const model *m, surface *s, model_error *error)
{
    size_t corner = 0;
    s->count = count_triangles(m);
    if (!s->count) return model_fail(error, "", "the model has no mesh to make a terrain from");
    s->corners = model_zeros(9u * s->count, sizeof *s->corners);
    if (!s->corners) return model_fail_memory(error);
    for (uint32_t i = 0; i < m->node_count; i++) {
        if (m->nodes[i].mesh == MODEL_NONE) continue;
        const model_mesh *mesh = &m->meshes[m->nodes[i].mesh];
        for (uint32_t k = 0; k < mesh->index_count / 3u * 3u; k++) {
            double at[3];
            const float *p = mesh->position + 3u * (size_t)mesh->indices[k];
            const double point[3] = { (double)p[0], (double)p[1], (double)p[2] };
            affine_point(m->nodes[i].world, point, at);
            add_corner(s, corner++, at);
        }
    }
    return 0;
}

/* The grid over a surface: cells are square, the last column and row may lie past its edge by less than a cell. */
static int grid_of(const surface *s, const terrain_options *o, double factor, terrain *t, model_error *error)
{
    const double wide = factor * (s->high[0] - s->low[0]), deep = factor * (s->high[2] - s->low[2]);
    const uint32_t points = o->points ? o->points : POINTS;
    const double spacing = fmax(wide, deep) / (points - 1u);
    if (!(spacing >= 1e-4 && spacing <= 1e4)) {
        return model_fail(error, "", "the terrain's size of %g x %g m is too small or too large", wide, deep);
    }
    t->width = (uint32_t)ceil(wide / spacing - 1e-6) + 1u;
    t->depth = (uint32_t)ceil(deep / spacing - 1e-6) + 1u;
    t->spacing = (float)spacing;
    for (int k = 0; k < 3; k++) t->origin[k] = (float)(factor * s->low[k]);
    return check_sides(t->width, t->depth, error);
}

/* The place of the first height at or after `at`, and of the last before it. */
static int64_t first_at(double at, double origin, double spacing)
{
    return (int64_t)ceil((at - origin) / spacing - 1e-6);
}

static int64_t last_at(double at, double origin, double spacing, uint32_t count)
{
    const int64_t last = (int64_t)floor((at - origin) / spacing + 1e-6);
    return last < (int64_t)count ? last : (int64_t)count - 1;
}

/* The height of a triangle's plane at a place, where that is in it: a hair's breadth outside counts. */
static int height_in(const double *c, double x, double z, double *height)
{
    const double area = (c[3] - c[0]) * (c[8] - c[2]) - (c[5] - c[2]) * (c[6] - c[0]);
    if (area == 0.0) return 0;
    const double u = ((x - c[0]) * (c[8] - c[2]) - (z - c[2]) * (c[6] - c[0])) / area;
    const double v = ((c[3] - c[0]) * (z - c[2]) - (c[5] - c[2]) * (x - c[0])) / area;
    if (!(u >= -1e-6 && v >= -1e-6 && u + v <= 1.0 + 1e-6)) return 0;
    *height = c[1] + u * (c[4] - c[1]) + v * (c[7] - c[1]);
    return 1;
}

/* Raise what lies under a triangle to it. c: its corners, in metres */
static void raise_to(const terrain *t, const double *c, double *heights)
{
    const double spacing = (double)t->spacing, ox = (double)t->origin[0], oz = (double)t->origin[2];
    const int64_t left = first_at(fmin(c[0], fmin(c[3], c[6])), ox, spacing);
    const int64_t right = last_at(fmax(c[0], fmax(c[3], c[6])), ox, spacing, t->width);
    const int64_t near = first_at(fmin(c[2], fmin(c[5], c[8])), oz, spacing);
    const int64_t far = last_at(fmax(c[2], fmax(c[5], c[8])), oz, spacing, t->depth);
    for (int64_t row = near < 0 ? 0 : near; row <= far; row++) {
        for (int64_t column = left < 0 ? 0 : left; column <= right; column++) {
            double height, *at = &heights[(size_t)row * t->width + (size_t)column];
            if (height_in(c, ox + spacing * (double)column, oz + spacing * (double)row, &height) && height > *at) {
                *at = height;
            }
        }
    }
}

/* Less than a cell past the last edge, the row or column before it continues. */
static void continue_edges(const terrain *t, double *heights)
{
    for (size_t row = 0; row < t->depth; row++) {
        double *h = heights + row * t->width + t->width - 2u;
        if (h[1] == -HUGE_VAL) h[1] = h[0];
    }
    for (size_t column = 0; column < t->width; column++) {
        double *h = heights + (size_t)(t->depth - 2u) * t->width + column;
        if (h[t->width] == -HUGE_VAL) h[t->width] = h[0];
    }
}

/* In 65,536 steps from the lowest to the highest. */
static int quantise(terrain *t, const double *heights, model_error *error)
{
    const size_t count = (size_t)t->width * t->depth;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        if (heights[i] == -HUGE_VAL) continue;
        low = fmin(low, heights[i]);
        high = fmax(high, heights[i]);
    }
    if (!(low <= high)) return model_fail(error, "", "the model has no surface that is visible from above");
    t->heights = model_zeros(count, sizeof *t->heights);
    if (!t->heights) return model_fail_memory(error);
    const double step = (high - low) / 65535.0;
    for (size_t i = 0; i < count; i++) {
        const int is_hole = heights[i] == -HUGE_VAL;
        t->hole_count += is_hole ? 1u : 0u;
        t->heights[i] = is_hole || !(step > 0.0) ? 0 : (uint16_t)lround((heights[i] - low) / step);
    }
    t->origin[1] = (float)low;
    t->scale = (float)step;
    return 0;
}

static int rasterise(const surface *s, double factor, terrain *t, model_error *error)
{
    const size_t count = (size_t)t->width * t->depth;
    double *heights = model_zeros(count, sizeof *heights);
    if (!heights) return model_fail_memory(error);
    for (size_t i = 0; i < count; i++) heights[i] = -HUGE_VAL;
    for (size_t i = 0; i < s->count; i++) {
        double c[9];
        for (int k = 0; k < 9; k++) c[k] = factor * s->corners[9u * i + (size_t)k];
        raise_to(t, c, heights);
    }
    continue_edges(t, heights);
    const int failed = quantise(t, heights, error);
    free(heights);
    return failed;
}

static int read_model(const char *path, const terrain_options *o, terrain *t, model_error *error)
{
    surface s = { .corners = NULL };
    model *m = NULL;
    int failed = model_read_gltf(path, &m, error) || surface_of(m, &s, error);
    if (!failed) {
        const double wide = s.high[0] - s.low[0], factor = o->size_m > 0.0 && wide > 0.0 ? o->size_m / wide : 1.0;
        failed = grid_of(&s, o, factor, t, error) || rasterise(&s, factor, t, error);
    }
    free(s.corners);
    model_free(m);
    return failed;
}

/* ---- both ---- */

int terrain_read(const char *path, const terrain_options *options, terrain *out, model_error *error)
{
    int failed;
    memset(out, 0, sizeof *out);
    if (file_has_ending(path, ".png")) {
        failed = read_picture(path, options, out, error);
    } else if (file_has_ending(path, ".glb") || file_has_ending(path, ".gltf")) {
        failed = read_model(path, options, out, error);
    } else {
        failed = model_fail(error, "", "a terrain must be a .png, .glb or .gltf file");
    }
    if (failed) {
        terrain_free(out);
    } else {
        find_range(out);
    }
    return failed;
}

void terrain_free(terrain *t)
{
    free(t->heights);
    memset(t, 0, sizeof *t);
}

noh_field terrain_field(const terrain *t)
{
    noh_field field;
    memset(&field, 0, sizeof field);
    field.heights = t->heights;
    field.width = t->width;
    field.depth = t->depth;
    memcpy(field.origin, t->origin, sizeof field.origin);
    field.spacing = t->spacing;
    field.scale = t->scale;
    return field;
}
