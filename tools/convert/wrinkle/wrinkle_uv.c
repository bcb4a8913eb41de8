#include "wrinkle_uv.h"

#include <math.h>
#include <stdlib.h>

#include "convert/model/islands.h"

#define REPEAT 10497u
#define BEYOND 1e-4 /* of a tile: rounding by the exporter */

/* Vertices that triangles join, with their range. */
typedef struct part {
    double low[2], high[2];
    uint8_t wrinkles; /* 1: has triangles of the field */
    uint8_t fixed[2]; /* 1: has a texture on that axis that does not repeat */
} part;

typedef struct parts {
    uint32_t *of; /* [vertex_count] a vertex of the same part; its own: the part is there */
    part *all;    /* [vertex_count] */
} parts;

static void join_triangles(parts *p, const model_mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) p->of[v] = v;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const uint32_t root = islands_root(p->of, mesh->indices[i]);
        p->of[islands_root(p->of, mesh->indices[i + 1])] = root;
        p->of[islands_root(p->of, mesh->indices[i + 2])] = root;
    }
}

static void fix_by(const model *m, uint32_t texture, part *p)
{
    if (texture >= m->texture_count) return;
    p->fixed[0] |= m->textures[texture].wrap_s != REPEAT;
    p->fixed[1] |= m->textures[texture].wrap_t != REPEAT;
}

static void measure(parts *p, const model *m, const model_mesh *mesh, const wrinkle_field *field)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        p->all[v] = (part){ { HUGE_VAL, HUGE_VAL }, { -HUGE_VAL, -HUGE_VAL }, 0, { 0, 0 } };
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        part *at = &p->all[islands_root(p->of, v)];
        for (uint32_t axis = 0; axis < 2; axis++) {
            const double uv = (double)mesh->uv[2 * (size_t)v + axis];
            at->low[axis] = fmin(at->low[axis], uv);
            at->high[axis] = fmax(at->high[axis], uv);
        }
    }
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const model_submesh *sub = &mesh->submeshes[s];
        for (uint32_t i = 0; i < sub->index_count && sub->material < m->material_count; i += 3) {
            const model_material *material = &m->materials[sub->material];
            part *at = &p->all[islands_root(p->of, mesh->indices[sub->first_index + i])];
            at->wrinkles |= sub->material == field->material;
            fix_by(m, material->base_color_texture, at);
            fix_by(m, material->normal_texture, at);
            fix_by(m, material->surface_texture, at);
            fix_by(m, material->emissive_texture, at);
            fix_by(m, material->specular_texture, at);
        }
    }
}

/* The tile that a part is in on an axis; *in is 0 where it is in several. */
static double tile_of(const part *p, uint32_t axis, int *in)
{
    const double tile = floor(p->low[axis] + BEYOND);
    *in = p->high[axis] <= tile + 1.0 + BEYOND;
    return tile;
}

static void settle_axis(parts *p, model_mesh *mesh, uint32_t axis, uint8_t *clamped)
{
    *clamped = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const part *at = &p->all[islands_root(p->of, v)];
        float *uv = &mesh->uv[2 * (size_t)v + axis];
        int in;
        const double tile = tile_of(at, axis, &in);
        if (!at->wrinkles) continue;
        if (!in || (tile != 0.0 && at->fixed[axis])) {
            *clamped = 0;
            continue;
        }
        if (tile == 0.0 && *uv >= 0.0f && *uv <= 1.0f) continue;
        *uv = (float)fmin(fmax((double)*uv - tile, 0.0), 1.0);
    }
}

int wrinkle_uv_settle(const model *m, model_mesh *mesh, wrinkle_field *field)
{
    parts p = { model_zeros(mesh->vertex_count, sizeof *p.of), model_zeros(mesh->vertex_count, sizeof *p.all) };
    const int failed = !p.of || !p.all;
    if (!failed) {
        join_triangles(&p, mesh);
        measure(&p, m, mesh, field);
        for (uint32_t axis = 0; axis < 2; axis++) settle_axis(&p, mesh, axis, &field->clamped[axis]);
    }
    free(p.of);
    free(p.all);
    return failed;
}
