/* identity_measure.c: measures deltas of identity targets: what they move, relative to each other and along the mesh's
 * edges. */
#include <string.h>

#include "core/base/math_internal.h"
#include "life/face/identity_internal.h"
#include "core/mesh/mesh_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "noh/low_core.h"
#include "noh/deform.h"
#include "noh/face.h"

static uint32_t texel_count(const noh_identity_scratch *s)
{
    return s->mesh->header->touched_count;
}

/* Accumulate positions only, from the words that noh_morph_accumulate reads (morph.c). */
void noh_identity_field(const noh_identity_scratch *s, uint32_t target, const noh_morph_layers *field)
{
    const noh_target *t = &s->mesh->targets[target];
    const uint32_t *words = s->mesh->texels + 3u * (size_t)t->first_texel;
    memset(field->position, 0,
           (((size_t)s->mesh->header->morph_height << s->mesh->header->morph_width_log2)) * 3u *
               sizeof *field->position);
    for (uint32_t i = 0; i < t->rect_count; i++) {
        const noh_rect *rect = &s->mesh->rects[t->first_rect + i];
        for (uint32_t y = 0; y < rect->h; y++) {
            const size_t texel = ((size_t)(rect->y + y) << s->mesh->header->morph_width_log2) + rect->x;
            for (uint32_t x = 0; x < 3u * rect->w; x++) {
                field->position[3u * texel + x] = (float)((int32_t)*words++ >> (32u - t->position_bits)) *
                                                  t->position_scale;
            }
        }
    }
}

void noh_identity_delta(const noh_identity_scratch *s, const noh_morph_layers *field, uint32_t vertex, float delta[3])
{
    const uint32_t texel = noh_mesh_accumulation_texel(s->mesh, vertex);
    delta[0] = delta[1] = delta[2] = 0.0f;
    if (texel < texel_count(s)) memcpy(delta, field->position + 3u * (size_t)texel, 3u * sizeof *delta);
}

noh_identity_moments noh_identity_moments_of(const noh_identity_scratch *s)
{
    noh_identity_moments m;
    memset(&m, 0, sizeof m);
    for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) {
        const float *p = s->mesh->positions + 3u * (size_t)v;
        float delta[3], square;
        noh_identity_delta(s, &s->field, v, delta);
        square = noh_dot3(delta, delta);
        m.square += square;
        m.length += noh_sqrt(square);
        m.moved += square > 0.0f;
        for (int c = 0; c < 3; c++) {
            m.centre[c] += square * p[c];
            m.sum[c] += delta[c];
        }
    }
    for (int c = 0; c < 3 && m.square > 0.0f; c++) m.centre[c] /= m.square;
    return m;
}

float noh_identity_cosine(const noh_identity_scratch *s, int over)
{
    float dot = 0.0f, a = 0.0f, b = 0.0f;
    for (uint32_t t = 0; t < texel_count(s); t++) {
        const float *x = s->field.position + 3u * (size_t)t, *y = s->other.position + 3u * (size_t)t;
        const float square = noh_dot3(x, x);
        if (over && square == 0.0f) continue;
        dot += noh_dot3(x, y);
        a += square;
        b += noh_dot3(y, y);
    }
    return a > 0.0f && b > 0.0f ? dot / (noh_sqrt(a) * noh_sqrt(b)) : 0.0f;
}

/* ---- neighbours ---- */

#define CHAIN_MAX 64u /* most vertices examined per cell: limits the time for hostile meshes */

/* Cells as wide as the search radius, in chains by a hash: s->partner holds their heads, s->next the rest. */
static int32_t cell_of(const noh_identity_scratch *s, const float *p, int axis)
{
    const float cell = (p[axis] - s->mesh->header->bounds_min[axis]) * (50.0f / s->size);
    return cell > 0.0f && cell < 64.0f ? (int32_t)cell : 0;
}

static uint32_t chain_of(const noh_identity_scratch *s, int32_t x, int32_t y, int32_t z)
{
    const uint32_t h = (uint32_t)x * 0x9e3779b1u + (uint32_t)y * 0x85ebca77u + (uint32_t)z * 0xc2b2ae3du;
    return (h ^ h >> 15) % s->mesh->header->vertex_count;
}

static void fill_cells(noh_identity_scratch *s)
{
    for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) s->partner[v] = NOH_NONE;
    for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) {
        const float *p = s->mesh->positions + 3u * (size_t)v;
        const uint32_t chain = chain_of(s, cell_of(s, p, 0), cell_of(s, p, 1), cell_of(s, p, 2));
        s->next[v] = s->partner[chain];
        s->partner[chain] = v;
    }
}

/* The nearest vertex that faces this one, in one chain. */
static void search_chain(const noh_identity_scratch *s, uint32_t chain, uint32_t vertex, float *nearest)
{
    const float *p = s->mesh->positions + 3u * (size_t)vertex;
    float normal[3], other[3];
    uint32_t v = s->partner[chain];
    noh_mesh_directions(s->mesh, vertex, normal, other);
    for (uint32_t i = 0; i < CHAIN_MAX && v != NOH_NONE; i++, v = s->next[v]) {
        const float *q = s->mesh->positions + 3u * (size_t)v;
        const float apart[3] = { q[0] - p[0], q[1] - p[1], q[2] - p[2] };
        const float square = noh_dot3(apart, apart);
        float tangent[3];
        if (square >= *nearest) continue;
        noh_mesh_directions(s->mesh, v, other, tangent);
        if (noh_dot3(normal, other) >= 0.0f) continue;
        *nearest = square;
        s->facing[vertex] = v;
    }
}

void noh_identity_facing(noh_identity_scratch *s)
{
    fill_cells(s);
    for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) {
        const float *p = s->mesh->positions + 3u * (size_t)v;
        float nearest = (s->size / 50.0f) * (s->size / 50.0f);
        s->facing[v] = NOH_NONE;
        for (int32_t i = 0; i < 27; i++) {
            const uint32_t chain = chain_of(s, cell_of(s, p, 0) + i % 3 - 1, cell_of(s, p, 1) + i / 3 % 3 - 1,
                                            cell_of(s, p, 2) + i / 9 - 1);
            search_chain(s, chain, v, &nearest);
        }
    }
}

/* Short edges count as if they were longer by a 200th of the mesh: skin folded in a corner of the mouth may unfold. */
static float edge_strain(const noh_identity_scratch *s, uint32_t a, uint32_t b)
{
    const float *p = s->mesh->positions + 3u * (size_t)a, *q = s->mesh->positions + 3u * (size_t)b;
    float x[3], y[3], edge[3];
    noh_identity_delta(s, &s->field, a, x);
    noh_identity_delta(s, &s->field, b, y);
    for (int c = 0; c < 3; c++) {
        x[c] -= y[c];
        edge[c] = p[c] - q[c];
    }
    return noh_sqrt(noh_dot3(x, x)) / (noh_sqrt(noh_dot3(edge, edge)) + s->size / 200.0f);
}

void noh_identity_strain(noh_identity_scratch *s)
{
    memset(s->strain, 0, s->mesh->header->vertex_count * sizeof *s->strain);
    for (uint32_t i = 0; i + 2u < s->mesh->header->index_count; i += 3u) {
        uint32_t corner[3];
        for (uint32_t k = 0; k < 3u; k++) corner[k] = noh_mesh_index(s->mesh, i + k);
        for (uint32_t k = 0; k < 3u; k++) {
            const uint32_t a = corner[k], b = corner[(k + 1u) % 3u];
            const float strain = edge_strain(s, a, b);
            if (s->strain[a] < strain) s->strain[a] = strain;
            if (s->strain[b] < strain) s->strain[b] = strain;
        }
    }
    for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) {
        const float strain = s->facing[v] == NOH_NONE ? 0.0f : edge_strain(s, v, s->facing[v]);
        if (s->strain[v] < strain) s->strain[v] = strain;
    }
}

/* ---- lids ---- */

/* The vertex that a closing one touches: of the same submesh, nearly still itself, near the closing one's end position
 * and not near its start. NOH_NONE if there is none. */
static uint32_t touched_by(const noh_identity_scratch *s, const noh_submesh *part, uint32_t vertex, const float move[3])
{
    const float *p = s->mesh->positions + 3u * (size_t)vertex;
    const float far = noh_dot3(move, move);
    float nearest = far * 0.04f; /* a fifth of its way */
    uint32_t found = NOH_NONE;
    for (uint32_t i = 0; i < part->index_count; i++) {
        const uint32_t v = noh_mesh_index(s->mesh, part->first_index + i);
        const float *q = s->mesh->positions + 3u * (size_t)v;
        float delta[3], rest[3], shut[3];
        for (int c = 0; c < 3; c++) {
            rest[c] = q[c] - p[c];
            shut[c] = rest[c] - move[c];
        }
        if (noh_dot3(shut, shut) >= nearest || noh_dot3(rest, rest) < far * 0.25f) continue;
        noh_identity_delta(s, &s->other, v, delta);
        if (noh_dot3(delta, delta) > far * 0.09f) continue;
        nearest = noh_dot3(shut, shut);
        found = v;
    }
    return found;
}

/* Find pairs of vertices that meet as lids close, s->partner; returns their number. Those that move farthest are the
 * rim. */
static uint32_t find_partners(noh_identity_scratch *s)
{
    float furthest = 0.0f;
    uint32_t count = 0;
    for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) {
        float delta[3];
        noh_identity_delta(s, &s->other, v, delta);
        furthest = noh_dot3(delta, delta) > furthest ? noh_dot3(delta, delta) : furthest;
        s->partner[v] = NOH_NONE;
    }
    for (uint32_t k = 0; k < s->mesh->header->submesh_count && furthest > 0.0f; k++) {
        const noh_submesh *part = &s->mesh->submeshes[k];
        for (uint32_t i = 0; i < part->index_count; i++) {
            const uint32_t v = noh_mesh_index(s->mesh, part->first_index + i);
            float delta[3];
            noh_identity_delta(s, &s->other, v, delta);
            if (s->partner[v] != NOH_NONE || noh_dot3(delta, delta) < furthest * 0.36f) continue;
            s->partner[v] = touched_by(s, part, v, delta);
            count += s->partner[v] != NOH_NONE;
        }
    }
    return count;
}

/* For lids that meet at weight 1: the weight at which they meet after identity moved them. The distance between
 * partners changes by the identity's deltas, and the closing target moves along its own. Least squares over all
 * pairs. */
static float closing_of(const noh_identity_scratch *s)
{
    float along = 0.0f, way = 0.0f;
    for (uint32_t v = 0; v < s->mesh->header->vertex_count; v++) {
        float move[3], p[3], q[3];
        if (s->partner[v] == NOH_NONE) continue;
        noh_identity_delta(s, &s->other, v, move);
        noh_identity_delta(s, &s->field, v, p);
        noh_identity_delta(s, &s->field, s->partner[v], q);
        for (int c = 0; c < 3; c++) {
            along += (q[c] - p[c]) * move[c];
            way += move[c] * move[c];
        }
    }
    return way > 0.0f ? along / way : 0.0f;
}

uint32_t noh_identity_closing(noh_identity_scratch *s, noh_identity_target *targets, uint32_t closing, uint32_t index)
{
    uint32_t pairs;
    noh_identity_field(s, closing, &s->other);
    pairs = find_partners(s);
    for (uint32_t t = 0; t < s->mesh->header->target_count && pairs; t++) {
        if (!targets[t].used) continue;
        noh_identity_field(s, t, &s->field);
        targets[t].closing[index] = closing_of(s);
    }
    return pairs;
}
