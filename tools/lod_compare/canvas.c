/* canvas.c: triangles into a z-buffer, orthographic, from the front. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare.h"

#define NOTHING 255u

canvas canvas_new(float left, float bottom, float right, float top, float pixel)
{
    canvas c = { 0 };
    c.width = (uint32_t)ceilf((right - left) / pixel);
    c.height = (uint32_t)ceilf((top - bottom) / pixel);
    c.left = left;
    c.top = top;
    c.pixel = pixel;
    c.depth = compare_zeros((size_t)c.width * c.height, sizeof *c.depth);
    c.submesh = compare_zeros((size_t)c.width * c.height, 1);
    c.rgb = compare_zeros((size_t)c.width * c.height, 3);
    for (size_t i = 0; i < (size_t)c.width * c.height; i++) {
        c.depth[i] = -FLT_MAX;
    }
    memset(c.submesh, NOTHING, (size_t)c.width * c.height);
    memset(c.rgb, 110, (size_t)c.width * c.height * 3u);
    return c;
}

void canvas_free(canvas *c)
{
    free(c->depth);
    free(c->submesh);
    free(c->rgb);
}

typedef struct corner {
    float x, y, z, color[3];
} corner;

static uint8_t to_byte(float linear)
{
    float x = linear < 0.0f ? 0.0f : linear > 1.0f ? 1.0f : sqrtf(linear); /* close to sRGB */
    return (uint8_t)(x * 255.0f + 0.5f);
}

static float edge(const corner *a, const corner *b, float x, float y)
{
    return (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
}

static void fill_pixel(canvas *c, uint32_t column, uint32_t row, const corner *p, const float *weight, uint32_t submesh)
{
    size_t at = (size_t)row * c->width + column;
    float depth = weight[0] * p[0].z + weight[1] * p[1].z + weight[2] * p[2].z;
    if (depth <= c->depth[at]) {
        return;
    }
    c->depth[at] = depth;
    c->submesh[at] = (uint8_t)submesh;
    for (uint32_t k = 0; k < 3u; k++) {
        c->rgb[at * 3u + k] = to_byte(weight[0] * p[0].color[k] + weight[1] * p[1].color[k] +
                                      weight[2] * p[2].color[k]);
    }
}

static uint32_t clamped(float x, uint32_t limit)
{
    return x <= 0.0f ? 0u : x >= (float)limit ? limit : (uint32_t)x;
}

static void fill_triangle(canvas *c, const corner *p, uint32_t submesh)
{
    float area = edge(&p[0], &p[1], p[2].x, p[2].y);
    uint32_t first_x = clamped(fminf(p[0].x, fminf(p[1].x, p[2].x)), c->width);
    uint32_t first_y = clamped(fminf(p[0].y, fminf(p[1].y, p[2].y)), c->height);
    uint32_t last_x = clamped(fmaxf(p[0].x, fmaxf(p[1].x, p[2].x)) + 1.0f, c->width);
    uint32_t last_y = clamped(fmaxf(p[0].y, fmaxf(p[1].y, p[2].y)) + 1.0f, c->height);
    for (uint32_t row = first_y; row < last_y; row++) {
        for (uint32_t column = first_x; column < last_x; column++) {
            float x = (float)column + 0.5f, y = (float)row + 0.5f, weight[3];
            weight[0] = edge(&p[1], &p[2], x, y) / area;
            weight[1] = edge(&p[2], &p[0], x, y) / area;
            weight[2] = 1.0f - weight[0] - weight[1];
            if (weight[0] >= 0.0f && weight[1] >= 0.0f && weight[2] >= 0.0f) {
                fill_pixel(c, column, row, p, weight, submesh);
            }
        }
    }
}

static void shade(const model_mesh *mesh, const model_material *material, uint32_t v, const float *normal, float *out)
{
    const float *n = normal + (size_t)v * 3u;
    float key = 0.45f * n[0] + 0.55f * n[1] + 0.7f * n[2], fill = 0.5f + 0.5f * n[1],
          light = 0.2f * fill + (key > 0.0f ? 0.75f * key : 0.0f);
    for (uint32_t k = 0; k < 3u; k++) {
        out[k] = light * (mesh->color ? mesh->color[(size_t)v * 4u + k] : 1.0f) *
                 (material ? material->base_color[k] : 0.8f);
    }
}

typedef struct drawing {
    const model_mesh *mesh;
    const model_material *material; /* NULL: none */
    const float *position, *normal;
    uint32_t submesh;
} drawing;

static void draw_triangle(canvas *c, const drawing *d, const uint32_t *vertices)
{
    corner p[3];
    float area;
    for (uint32_t k = 0; k < 3u; k++) {
        const float *at = d->position + (size_t)vertices[k] * 3u;
        p[k].x = (at[0] - c->left) / c->pixel;
        p[k].y = (c->top - at[1]) / c->pixel;
        p[k].z = at[2];
        shade(d->mesh, d->material, vertices[k], d->normal, p[k].color);
    }
    area = edge(&p[0], &p[1], p[2].x, p[2].y);
    if (area < 0.0f || (area > 0.0f && d->material && d->material->double_sided)) {
        fill_triangle(c, p, d->submesh);
    }
}

void canvas_draw(canvas *c, const model *m, const model_mesh *mesh, const lod_level *level, const float *position,
                 const float *normal)
{
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const model_material *material = mesh->submeshes[s].material == MODEL_NONE
                                             ? NULL
                                             : &m->materials[mesh->submeshes[s].material];
        drawing d = { mesh, material, position, normal, s };
        if (material && material->alpha == MODEL_ALPHA_BLEND) {
            continue;
        }
        for (uint32_t i = 0; i < level->submesh_count[s]; i += 3u) {
            draw_triangle(c, &d, level->indices + level->submesh_first[s] + i);
        }
    }
}

uint32_t canvas_count(const canvas *c, uint32_t submesh)
{
    uint32_t count = 0;
    for (size_t i = 0; i < (size_t)c->width * c->height; i++) {
        count += c->submesh[i] == submesh;
    }
    return count;
}

void canvas_paste(const canvas *c, uint32_t shrink, uint8_t *sheet, uint32_t sheet_width, uint32_t x, uint32_t y)
{
    for (uint32_t row = 0; row < c->height / shrink; row++) {
        for (uint32_t i = 0; i < c->width / shrink * 3u; i++) {
            uint32_t sum = 0;
            for (uint32_t k = 0; k < shrink * shrink; k++) {
                sum += c->rgb[((size_t)(row * shrink + k / shrink) * c->width + i / 3u * shrink + k % shrink) * 3u +
                              i % 3u];
            }
            sheet[((size_t)(y + row) * sheet_width + x) * 3u + i] = (uint8_t)(sum / (shrink * shrink));
        }
    }
}
