#include "mesh_layout.h"

#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/pack/triangle_order.h"
#include "convert/skin/palette_deal.h"

typedef struct layout_job {
    const model_mesh *mesh;
    const mesh_levels *levels;
    const morph_encoding *e;
    const uint8_t *blends;
    mesh_layout *out;
    palette_deal deal;
    uint32_t *place;            /* [the mesh's vertex_count] old vertex -> new */
    uint32_t *triangle_palette; /* [triangles] of the current level */
    uint32_t *next_copy;        /* [vertex capacity] the vertex doubled after this one, or MODEL_NONE */
    float *positions;           /* [vertex capacity][3] */
    uint32_t submesh_capacity;
} layout_job;

static int is_skinned(const model_mesh *m)
{
    return m->bound && m->joints;
}

/* ---- palettes ---- */

/* A submesh's triangles in a level: corners are the model's vertices. */
typedef struct part {
    const uint32_t *indices;
    uint32_t first, count;
} part;

static part part_of(const layout_job *j, uint32_t level, uint32_t s)
{
    const model_submesh *from = &j->mesh->submeshes[s];
    part p = { j->mesh->indices, from->first_index, from->index_count };
    if (level) {
        const lod_view view = mesh_levels_view(j->levels, level);
        p.indices = view.indices;
        p.first = view.first[s];
        p.count = view.count[s];
    }
    return p;
}

/* Each triangle's palette. In a blended submesh palettes only rise, so that its triangles stay in order. */
static int deal_triangles(layout_job *j, uint32_t level, model_error *error)
{
    const model_mesh *m = j->mesh;
    for (uint32_t s = 0; s < m->submesh_count; s++) {
        const part p = part_of(j, level, s);
        uint32_t first = 0, begin = p.first / 3, end = begin + p.count / 3;
        for (uint32_t t = begin; t < end; t++) {
            if (palette_deal_triangle(&j->deal, m, p.indices + 3 * (size_t)t, first, &j->triangle_palette[t], error)) {
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

/* The new vertex for an old one in a palette; doubled if another palette has it. */
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
        out->texel[copy] = out->texel[v];
        out->palette[copy] = palette;
        memcpy(j->positions + 3 * (size_t)copy, j->positions + 3 * (size_t)v, 12);
        j->next_copy[copy] = j->next_copy[v];
        j->next_copy[v] = copy;
    }
    return copy;
}

/* Vertices of no triangle get a palette too: the CPU skins them with the others. */
static int deal_loose_vertices(layout_job *j, model_error *error)
{
    for (uint32_t v = 0; v < j->mesh->vertex_count; v++) {
        uint32_t old = j->out->source[v], alone[3] = { old, old, old };
        if (j->out->palette[v] == MODEL_NONE &&
            palette_deal_triangle(&j->deal, j->mesh, alone, 0, &j->out->palette[v], error)) {
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

/* The triangles of one submesh that use one palette. Triangles of blended materials keep the artist's order, in which
 * they are drawn over each other. Returns 1: out of memory. */
static int add_part(layout_job *j, uint32_t level, uint32_t s, uint32_t palette)
{
    const part from = part_of(j, level, s);
    mesh_layout *out = j->out;
    noh_submesh *to = &out->submeshes[out->submesh_count];
    uint32_t *indices = out->indices + out->index_count;
    memset(to, 0, sizeof *to);
    to->first_index = out->index_count - out->levels[level].first_index;
    to->material = j->mesh->submeshes[s].material;
    to->palette = palette;
    for (uint32_t i = from.first; i < from.first + from.count; i++) {
        if (j->triangle_palette[i / 3] == palette) {
            indices[to->index_count++] = vertex_for(j, from.indices[i], palette);
        }
    }
    if (!to->index_count && j->deal.palette_count > 1) {
        return 0;
    }
    if (to->index_count && !j->blends[s] && triangle_order(indices, to->index_count, j->positions, out->vertex_count)) {
        return 1;
    }
    out->index_count += to->index_count;
    out->submesh_count += 1;
    return 0;
}

static int add_parts(layout_job *j, uint32_t level, model_error *error)
{
    level_layout *l = &j->out->levels[level];
    l->first_index = j->out->index_count;
    l->first_submesh = j->out->submesh_count;
    for (uint32_t s = 0; s < j->mesh->submesh_count; s++) {
        for (uint32_t p = 0; p == 0 || p < j->deal.palette_count; p++) {
            if (j->out->submesh_count - l->first_submesh == j->submesh_capacity) {
                return model_fail(error, j->mesh->name,
                                  "palettes of %u joints cut it into more than %u draws: raise --palette",
                                  j->deal.limit, j->submesh_capacity);
            }
            if (add_part(j, level, s, p)) return model_fail_memory(error);
        }
    }
    l->index_count = j->out->index_count - l->first_index;
    l->submesh_count = j->out->submesh_count - l->first_submesh;
    return 0;
}

/* ---- levels ---- */

/* rank[vertex_count]: the coarsest level whose triangles use a vertex. */
static void rank_by_use(const mesh_layout *l, uint8_t *rank)
{
    for (uint32_t k = 1; k < l->level_count; k++) {
        for (uint32_t i = 0; i < l->levels[k].index_count; i++) {
            rank[l->indices[l->levels[k].first_index + i]] = (uint8_t)k;
        }
    }
}

static void move_words(uint32_t *words, const uint32_t *to, uint32_t count, uint32_t *scratch)
{
    for (uint32_t v = 0; v < count; v++) {
        scratch[to[v]] = words[v];
    }
    memcpy(words, scratch, (size_t)count * sizeof *words);
}

/* With levels, or texels of texture coordinates, a texel reference is the texel or none. */
static void set_texels(mesh_layout *l, uint32_t touched)
{
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        l->texel_references |= l->texel[v] != v && (l->texel[v] < touched || v < touched);
        if (l->texel[v] >= touched) {
            l->texel[v] = NOH_TEXEL_NONE;
        }
    }
}

/* Vertices of coarse levels go first; otherwise the order stays. */
static int sort_by_level(layout_job *j)
{
    mesh_layout *l = j->out;
    uint8_t *rank = model_zeros(l->vertex_count, sizeof *rank);
    uint32_t *to = model_zeros(l->vertex_count, 2 * sizeof *to), next = 0;
    for (uint32_t k = l->level_count; rank && to && k-- > 0;) {
        if (k + 1u == l->level_count) {
            rank_by_use(l, rank);
        }
        for (uint32_t v = 0; v < l->vertex_count; v++) {
            if (rank[v] == k) {
                to[v] = next++;
            }
        }
        l->levels[k].vertex_count = next;
    }
    if (rank && to) {
        move_words(l->source, to, l->vertex_count, to + l->vertex_count);
        move_words(l->palette, to, l->vertex_count, to + l->vertex_count);
        move_words(l->texel, to, l->vertex_count, to + l->vertex_count);
        for (uint32_t i = 0; i < l->index_count; i++) {
            l->indices[i] = to[l->indices[i]];
        }
    }
    free(rank);
    free(to);
    return !rank || !to;
}

/* The vertices that each draw uses. */
static void find_vertex_runs(mesh_layout *l)
{
    for (uint32_t k = 0; k < l->level_count; k++) {
        for (uint32_t s = 0; s < l->levels[k].submesh_count; s++) {
            noh_submesh *sub = &l->submeshes[l->levels[k].first_submesh + s];
            uint32_t low = MODEL_NONE, high = 0;
            for (uint32_t i = 0; i < sub->index_count; i++) {
                uint32_t v = l->indices[l->levels[k].first_index + sub->first_index + i];
                low = v < low ? v : low;
                high = v > high ? v : high;
            }
            sub->first_vertex = sub->index_count ? low : 0;
            sub->vertex_count = sub->index_count ? high - low + 1 : 0;
        }
    }
}

/* ---- all of it ---- */

static uint32_t indices_of_all(const model_mesh *m, const mesh_levels *levels)
{
    uint32_t count = m->index_count;
    for (uint32_t k = 1; k < levels->count; k++) {
        count += levels->built->levels[levels->which[k]].index_count;
    }
    return count;
}

static int allocate(layout_job *j)
{
    const model_mesh *m = j->mesh;
    const uint32_t index_count = indices_of_all(m, j->levels);
    const size_t most = (size_t)m->vertex_count + (is_skinned(m) ? index_count : 0u);
    mesh_layout *out = j->out;
    j->submesh_capacity = is_skinned(m) ? NOH_SUBMESHES_MAX : m->submesh_count;
    out->source = model_zeros(most, sizeof *out->source);
    out->texel = model_zeros(most, sizeof *out->texel);
    out->palette = model_zeros(most, sizeof *out->palette);
    out->indices = model_zeros(index_count, sizeof *out->indices);
    out->submeshes = model_zeros(((size_t)j->submesh_capacity + 1u) * j->levels->count, sizeof *out->submeshes);
    j->place = model_zeros(m->vertex_count, sizeof *j->place);
    j->triangle_palette = model_zeros(m->index_count / 3u, sizeof *j->triangle_palette);
    j->next_copy = model_zeros(most, sizeof *j->next_copy);
    j->positions = model_zeros(most, 3 * sizeof *j->positions);
    if (!out->source || !out->texel || !out->palette || !out->indices || !out->submeshes || !j->place ||
        !j->triangle_palette || !j->next_copy || !j->positions) {
        return 1;
    }
    memset(j->next_copy, 0xff, most * sizeof *j->next_copy);
    return is_skinned(m) &&
           palette_deal_begin(&j->deal, m->joint_limit, m->palette_limit ? m->palette_limit : NOH_PALETTE_JOINTS_MAX);
}

static void place_vertices(layout_job *j)
{
    mesh_layout *out = j->out;
    out->level_count = j->levels->count;
    for (uint32_t i = 0; i < j->e->vertex_count; i++) {
        const uint32_t v = out->vertex_count, old = j->e->order[i];
        if (old >= j->mesh->vertex_count) continue; /* a texel of texture coordinates */
        out->source[v] = old;
        out->texel[v] = i;
        out->palette[v] = is_skinned(j->mesh) ? MODEL_NONE : 0;
        j->place[old] = v;
        memcpy(j->positions + 3 * (size_t)v, j->mesh->position + 3 * (size_t)old, 12);
        out->vertex_count++;
    }
}

static int make(layout_job *j, model_error *error)
{
    mesh_layout *out = j->out;
    if (allocate(j)) {
        return model_fail_memory(error);
    }
    place_vertices(j);
    for (uint32_t k = 0; k < out->level_count; k++) {
        if ((is_skinned(j->mesh) && deal_triangles(j, k, error)) || add_parts(j, k, error)) {
            return 1;
        }
    }
    if (is_skinned(j->mesh) && (deal_loose_vertices(j, error) || (store_palettes(j) && model_fail_memory(error)))) {
        return 1;
    }
    out->levels[0].vertex_count = out->vertex_count;
    out->texel_references = out->palette_count > 1;
    if (out->level_count > 1 && sort_by_level(j)) {
        return model_fail_memory(error);
    }
    if (out->level_count > 1 || j->e->uv_texel) set_texels(out, j->e->touched_count);
    out->texel_references |= j->e->uv_texel != NULL;
    find_vertex_runs(out);
    return 0;
}

int mesh_layout_make(const model_mesh *mesh, const mesh_levels *levels, const morph_encoding *e,
                     const uint8_t *submesh_blends, mesh_layout *out, model_error *error)
{
    layout_job job;
    int failed;
    memset(&job, 0, sizeof job);
    memset(out, 0, sizeof *out);
    job.mesh = mesh;
    job.levels = levels;
    job.e = e;
    job.blends = submesh_blends;
    job.out = out;
    failed = make(&job, error);
    if (!failed && out->vertex_count > NOH_VERTICES_MAX) {
        failed = model_fail(error, mesh->name,
                            "%u vertices after the split into palettes, more than the limit of %u: raise --palette",
                            out->vertex_count, NOH_VERTICES_MAX);
    }
    palette_deal_free(&job.deal);
    free(job.place);
    free(job.triangle_palette);
    free(job.next_copy);
    free(job.positions);
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
