#include "texture_solid.h"

#include <math.h>
#include <stdlib.h>

#include "convert/model/model_build.h"
#include "convert/model/texture_cut.h"
#include "level_corners.h"
#include "noh/format.h"

#define MARGIN 2.0 /* texels about a triangle that filters read */
#define FAR 2.0f   /* texture coordinates beyond it are outside in any case, and no number is within it */

#define ROWS_MAX (1u << 27) /* rows of texels of all triangles: a few seconds; beyond it a material counts as cut */

/* How many texels above and left of each corner are cut. */
typedef struct cut_sums {
    uint32_t width, height;
    uint32_t rows; /* looked at so far */
    uint32_t *at;  /* [height + 1][width + 1] */
} cut_sums;

static int sums_make(const model_texture *t, float cutoff, cut_sums *s)
{
    const size_t row = (size_t)t->width + 1u;
    *s = (cut_sums){ t->width, t->height, 0, model_zeros(row * ((size_t)t->height + 1u), sizeof *s->at) };
    for (size_t y = 0; s->at && y < t->height; y++) {
        for (size_t x = 0; x < t->width; x++) {
            const uint32_t cut = (float)t->rgba[4u * (y * t->width + x) + 3u] < cutoff * 255.0f;
            uint32_t *to = s->at + (y + 1u) * row + x + 1u;
            *to = cut + to[-1] + to[-(ptrdiff_t)row] - to[-(ptrdiff_t)row - 1];
        }
    }
    return !s->at;
}

/* What a triangle covers of a row of texels, from `range[0]` to `range[1]`; at: its corners, in texels. */
static void span_of(double at[3][2], double row, double range[2])
{
    const double low = row - MARGIN, high = row + 1.0 + MARGIN;
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const double *p = at[k], *q = at[(k + 1) % 3], rise = q[1] - p[1];
        if (fmax(p[1], q[1]) < low || fmin(p[1], q[1]) > high) continue;
        for (int end = 0; end < 2; end++) {
            const double y = fmin(fmax(end ? q[1] : p[1], low), high);
            const double x = rise < 0.0 || rise > 0.0 ? p[0] + (q[0] - p[0]) * (y - p[1]) / rise : end ? q[0] : p[0];
            range[0] = fmin(range[0], x - MARGIN);
            range[1] = fmax(range[1], x + MARGIN);
        }
    }
}

/* Whether it reads a texel that is cut, or what is beyond the texture. */
static int triangle_is_cut(double at[3][2], cut_sums *s)
{
    const size_t row = (size_t)s->width + 1u;
    const double low = fmin(at[0][1], fmin(at[1][1], at[2][1])) - MARGIN;
    const double high = fmax(at[0][1], fmax(at[1][1], at[2][1])) + MARGIN;
    if (low < 0.0 || high >= s->height) return 1;
    for (uint32_t y = (uint32_t)low; y <= (uint32_t)high; y++) {
        double range[2];
        if (++s->rows > ROWS_MAX) return 1;
        span_of(at, y, range);
        if (range[0] > range[1]) continue;
        if (range[0] < 0.0 || range[1] >= s->width) return 1;
        const uint32_t *above = s->at + y * row, *below = above + row, from = (uint32_t)range[0];
        const uint32_t to = (uint32_t)range[1] + 1u;
        if (below[to] - below[from] != above[to] - above[from]) return 1;
    }
    return 0;
}

static int is_cut(const float *uv, level_corners c, cut_sums *s)
{
    for (uint32_t i = 0; i + 2u < c.count; i += 3u) {
        double at[3][2];
        for (uint32_t k = 0; k < 3u; k++) {
            const float *corner = uv + 2u * (size_t)c.vertices[i + k];
            if (!(fabsf(corner[0]) < FAR && fabsf(corner[1]) < FAR)) return 1;
            at[k][0] = (double)corner[0] * s->width;
            at[k][1] = (double)corner[1] * s->height;
        }
        if (triangle_is_cut(at, s)) return 1;
    }
    return 0;
}

static int is_solid(const model *m, const mesh_levels *levels, uint32_t material, cut_sums *s)
{
    const uint32_t all = s->at[((size_t)s->width + 1u) * ((size_t)s->height + 1u) - 1u];
    uint32_t parts = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        const mesh_levels *of = levels ? &levels[i] : NULL;
        for (uint32_t k = 0; k < mesh->submesh_count; k++) {
            if (mesh->submeshes[k].material != material) continue;
            parts++;
            if (!all) continue;
            if (!mesh->uv || model_moves_uv(mesh)) return 0;
            for (uint32_t level = 0; level < level_count_of(of); level++) {
                if (is_cut(mesh->uv, level_corners_of(mesh, of, level, k), s)) return 0;
            }
        }
    }
    return parts != 0;
}

/* Whether its texels decide alone what is cut. */
static int cuts_by_texels(const model *m, uint32_t material)
{
    const model_material *of = &m->materials[material];
    if (of->alpha != MODEL_ALPHA_MASK || of->base_color_texture == MODEL_NONE || of->base_color[3] < 1.0f ||
        of->surface == NOH_SURFACE_HAIR || of->surface == NOH_SURFACE_EYE || texture_cut_vertices(m, material)) {
        return 0;
    }
    for (uint32_t i = 0; i < m->texture_count; i++) {
        if (model_replaces_texture(&m->textures[i], &m->textures[of->base_color_texture])) return 0;
    }
    return 1;
}

/* A material that no longer cuts leaves its texture's alpha to others, if any. */
static void let_go(model *m, uint32_t texture)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        if (m->materials[i].alpha != MODEL_ALPHA_OPAQUE && m->materials[i].base_color_texture == texture) return;
    }
    m->textures[texture].alpha_unread = !m->textures[texture].alpha_is_data;
    m->textures[texture].alpha_cutoff = 0.0f;
}

int texture_solid(model *m, const mesh_levels *levels, uint32_t *count)
{
    *count = 0;
    for (uint32_t i = 0; i < m->material_count; i++) {
        model_material *of = &m->materials[i];
        cut_sums s;
        if (!cuts_by_texels(m, i)) continue;
        if (sums_make(&m->textures[of->base_color_texture], of->alpha_cutoff, &s)) return 1;
        if (is_solid(m, levels, i, &s)) {
            of->alpha = MODEL_ALPHA_OPAQUE;
            let_go(m, of->base_color_texture);
            ++*count;
        }
        free(s.at);
    }
    return 0;
}
