#include "mesh_layout.h"

#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

#include "model_build.h"
#include "palette_deal.h"

typedef struct layout_job {
    const model_mesh *mesh;
    const morph_encoding *e;
    const uint8_t *blends;
    mesh_layout *out;
    palette_deal deal;
    uint32_t *place;            /* [the mesh's vertex_count] old vertex -> new */
    uint32_t *triangle_palette; /* [triangles] */
    uint32_t *next_copy;        /* [vertex capacity] the vertex doubled after this one, or MODEL_NONE */
    uint32_t submesh_capacity;
} layout_job;

static int is_skinned(const model_mesh *m)
{
    return m->bound && m->joints;
}

/* ---- palettes ---- */

/* Each triangle's palette; a blended submesh's go up, so that its triangles stay in order. */
static int deal_triangles(layout_job *j, model_error *error)
{
    const model_mesh *m = j->mesh;
    for (uint32_t s = 0; s < m->submesh_count; s++) {
        uint32_t first = 0, begin = m->submeshes[s].first_index / 3, end = begin + m->submeshes[s].index_count / 3;
        for (uint32_t t = begin; t < end; t++) {
            if (palette_deal_triangle(&j->deal, m, m->indices + 3 * (size_t)t, first, &j->triangle_palette[t], error)) {
                return 1;
            }
            first = j->blends[s] ? j->triangle_palette[t] : 0;
        }
    }
    return 0;
}

static uint32_t find_copy(const layout_job *j, uint32_t vertex, uint32_t palette)
{
    while (vertex != MODEL_NONE && j->out->palette[vertex] != palette) {
        vertex = j->next_copy[vertex];
    }
    return vertex;
}

/* The new vertex of an old one, for a palette; doubled where another palette has it. */
static uint32_t vertex_for(layout_job *j, uint32_t old, uint32_t palette)
{
    mesh_layout *out = j->out;
    uint32_t v = j->place[old], copy;
    if (out->palette[v] == MODEL_NONE) {
        out->palette[v] = palette;
    }
    copy = find_copy(j, v, palette);
    if (copy == MODEL_NONE) {
        copy = out->vertex_count++;
        out->source[copy] = old;
        out->texel[copy] = v;
        out->palette[copy] = palette;
        j->next_copy[copy] = j->next_copy[v];
        j->next_copy[v] = copy;
    }
    return copy;
}

/* Vertices of no triangle have a palette too: the CPU moves them with the others. */
static int deal_loose_vertices(layout_job *j, model_error *error)
{
    for (uint32_t v = 0; v < j->mesh->vertex_count; v++) {
        uint32_t old = j->out->source[v], alone[3] = { old, old, old };
        if (j->out->palette[v] == MODEL_NONE && palette_deal_triangle(&j->deal, j->mesh, alone, 0, &j->out->palette[v], error)) {
            return 1;
        }
    }
    return 0;
}

static int store_palettes(layout_job *j)
{
    mesh_layout *out = j->out;
    uint32_t total = 0;
    for (uint32_t p = 0; p < j->deal.palette_count; p++) {
        total += j->deal.sizes[p];
    }
    out->palettes = model_zeros(j->deal.palette_count, sizeof *out->palettes);
    out->palette_joints = model_zeros(total, sizeof *out->palette_joints);
    if (!out->palettes || !out->palette_joints) {
        return 1;
    }
    out->palette_count = j->deal.palette_count;
    for (uint32_t p = 0; p < out->palette_count; p++) {
        out->palettes[p].first_joint = out->palette_joint_count;
        out->palettes[p].joint_count = j->deal.sizes[p];
        for (uint32_t joint = 0; joint < j->deal.joint_count; joint++) {
            if (palette_deal_has(&j->deal, p, joint)) {
                out->palette_joints[out->palette_joint_count++] = (uint16_t)joint;
            }
        }
    }
    return 0;
}

/* ---- triangles ---- */

/* The triangles of one submesh that one palette draws, reordered for the vertex cache. Those of blended
 * materials keep the artist's order: in it they are drawn over each other. */
static void add_part(layout_job *j, uint32_t s, uint32_t palette)
{
    const model_submesh *from = &j->mesh->submeshes[s];
    mesh_layout *out = j->out;
    noh_submesh *to = &out->submeshes[out->submesh_count];
    uint32_t low = MODEL_NONE, high = 0, *indices = out->indices + out->index_count;
    memset(to, 0, sizeof *to);
    to->first_index = out->index_count;
    to->material = from->material;
    to->palette = palette;
    for (uint32_t i = from->first_index; i < from->first_index + from->index_count; i++) {
        if (j->triangle_palette[i / 3] == palette) {
            uint32_t v = vertex_for(j, j->mesh->indices[i], palette);
            indices[to->index_count++] = v;
            low = v < low ? v : low;
            high = v > high ? v : high;
        }
    }
    if (!to->index_count && j->deal.palette_count > 1) {
        return;
    }
    if (to->index_count) {
        to->first_vertex = low;
        to->vertex_count = high - low + 1;
        if (!j->blends[s]) {
            meshopt_optimizeVertexCache(indices, indices, to->index_count, out->vertex_count);
        }
    }
    out->index_count += to->index_count;
    out->submesh_count += 1;
}

static int add_parts(layout_job *j, model_error *error)
{
    for (uint32_t s = 0; s < j->mesh->submesh_count; s++) {
        for (uint32_t p = 0; p == 0 || p < j->deal.palette_count; p++) {
            if (j->out->submesh_count == j->submesh_capacity) {
                return model_fail(error, j->mesh->name, "palettes of %u joints cut it into more than %u draws: give --palette more",
                                  j->deal.limit, j->submesh_capacity);
            }
            add_part(j, s, p);
        }
    }
    return 0;
}

/* ---- all of it ---- */

static int allocate(layout_job *j)
{
    const model_mesh *m = j->mesh;
    size_t most = (size_t)m->vertex_count + (is_skinned(m) ? m->index_count : 0u);
    mesh_layout *out = j->out;
    j->submesh_capacity = is_skinned(m) ? NOH_SUBMESHES_MAX : m->submesh_count;
    out->source = model_zeros(most, sizeof *out->source);
    out->texel = model_zeros(most, sizeof *out->texel);
    out->palette = model_zeros(most, sizeof *out->palette);
    out->indices = model_zeros(m->index_count, sizeof *out->indices);
    out->submeshes = model_zeros(j->submesh_capacity + 1u, sizeof *out->submeshes);
    j->place = model_zeros(m->vertex_count, sizeof *j->place);
    j->triangle_palette = model_zeros(m->index_count / 3u, sizeof *j->triangle_palette);
    j->next_copy = model_zeros(most, sizeof *j->next_copy);
    if (!out->source || !out->texel || !out->palette || !out->indices || !out->submeshes || !j->place || !j->triangle_palette ||
        !j->next_copy) {
        return 1;
    }
    memset(j->next_copy, 0xff, most * sizeof *j->next_copy);
    return is_skinned(m) && palette_deal_begin(&j->deal, m->joint_limit, m->palette_limit ? m->palette_limit : NOH_PALETTE_JOINTS_MAX);
}

static void place_vertices(layout_job *j)
{
    mesh_layout *out = j->out;
    out->vertex_count = j->mesh->vertex_count;
    for (uint32_t v = 0; v < out->vertex_count; v++) {
        out->source[v] = j->e->order[v];
        out->texel[v] = v;
        out->palette[v] = is_skinned(j->mesh) ? MODEL_NONE : 0;
        j->place[j->e->order[v]] = v;
    }
}

static int make(layout_job *j, model_error *error)
{
    if (allocate(j)) {
        return model_fail(error, "", "out of memory");
    }
    place_vertices(j);
    if (is_skinned(j->mesh) && deal_triangles(j, error)) {
        return 1;
    }
    if (add_parts(j, error)) {
        return 1;
    }
    if (is_skinned(j->mesh)) {
        return deal_loose_vertices(j, error) || (store_palettes(j) && model_fail(error, "", "out of memory"));
    }
    return 0;
}

int mesh_layout_make(const model_mesh *mesh, const morph_encoding *e, const uint8_t *submesh_blends, mesh_layout *out,
                     model_error *error)
{
    layout_job job;
    int failed;
    memset(&job, 0, sizeof job);
    memset(out, 0, sizeof *out);
    job.mesh = mesh;
    job.e = e;
    job.blends = submesh_blends;
    job.out = out;
    failed = make(&job, error);
    if (!failed && out->vertex_count > NOH_VERTICES_MAX) {
        failed = model_fail(error, mesh->name, "%u vertices after the split into palettes: a mesh holds up to %u", out->vertex_count,
                            NOH_VERTICES_MAX);
    }
    palette_deal_free(&job.deal);
    free(job.place);
    free(job.triangle_palette);
    free(job.next_copy);
    return failed;
}

void mesh_layout_free(mesh_layout *layout)
{
    free(layout->source);
    free(layout->texel);
    free(layout->palette);
    free(layout->indices);
    free(layout->submeshes);
    free(layout->palettes);
    free(layout->palette_joints);
}
