/* lod_attribute.c: changes of UVs, colours and skin weights, as lengths.
 *
 * A collapse may keep the shape and still drag the texture over it. For points on the triangles that it replaces, the
 * nearest point of the new surface is found, and the attributes interpolated there are compared with the old ones. The
 * difference is converted to a length (UVs by the mesh's length per UV unit, colours and weights by fractions of the
 * mean edge), so that it can be added to a distance and is held to the same bound. */
#include "lod_internal.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define UV_WEIGHT 0.1f
#define COLOR_EDGES 0.24f
#define MINOR_COLORS 3.0f /* in a small part, such as an eye, colours matter most */
#define SKIN_EDGES 1.0f
#define FIRST_COLOR 2u
#define COLORS (LOD_ATTRIBUTES - FIRST_COLOR)
#define FAN_BLOCKS (LOD_FAN_MAX / LOD_LANES)
#define BOUND_ROUNDING 1.0001f /* of sums over three weights that may not add up to 1 in the last bits */

static double area_of(const float *a, const float *b, const float *c, uint32_t axes)
{
    double u[3] = { 0 }, v[3] = { 0 }, x, y, z;
    for (uint32_t k = 0; k < axes; k++) {
        u[k] = (double)b[k] - a[k];
        v[k] = (double)c[k] - a[k];
    }
    x = u[1] * v[2] - u[2] * v[1];
    y = u[2] * v[0] - u[0] * v[2];
    z = u[0] * v[1] - u[1] * v[0];
    return sqrt(x * x + y * y + z * z);
}

/* Lengths of surface per UV unit, over the whole mesh. */
static float uv_length(const model_mesh *mesh)
{
    double surface = 0.0, picture = 0.0;
    for (uint32_t i = 0; mesh->uv && i + 2u < mesh->index_count; i += 3u) {
        const uint32_t *c = mesh->indices + i;
        surface += area_of(mesh->position + (size_t)c[0] * 3u, mesh->position + (size_t)c[1] * 3u,
                           mesh->position + (size_t)c[2] * 3u, 3);
        picture += area_of(mesh->uv + (size_t)c[0] * 2u, mesh->uv + (size_t)c[1] * 2u, mesh->uv + (size_t)c[2] * 2u, 2);
    }
    return picture > 0.0 ? (float)sqrt(surface / picture) : 0.0f;
}

static float chosen(float option, float standard)
{
    return option < 0.0f ? 0.0f : option > 0.0f ? option : standard;
}

int lod_attributes_make(lod_surface *s, const lod_options *o)
{
    const model_mesh *mesh = s->mesh;
    float uv = chosen(o->uv_weight, UV_WEIGHT) * uv_length(mesh);
    float color = chosen(o->color_length, (o->color_edges > 0.0f ? o->color_edges : COLOR_EDGES) * s->edge);
    s->attribute = calloc((size_t)mesh->vertex_count + 1u, LOD_ATTRIBUTES * sizeof *s->attribute);
    if (!s->attribute) {
        return 1;
    }
    s->skin_length = mesh->joint_weights ? chosen(o->skin_length, SKIN_EDGES * s->edge) : 0.0f;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        float *to = s->attribute + v * LOD_ATTRIBUTES,
              length = s->minor[s->part[s->point_of[v]]] ? color * MINOR_COLORS : color;
        for (uint32_t k = 0; mesh->uv && k < 2u; k++) {
            to[k] = mesh->uv[v * 2u + k] * uv;
        }
        for (uint32_t k = 0; mesh->color && k < 4u; k++) { /* as perceived, not linear */
            to[2u + k] = (k < 3u ? sqrtf(mesh->color[v * 4u + k]) : mesh->color[v * 4u + k]) * length;
        }
    }
    return 0;
}

/* The point of the new surface in place of one of the old. */
typedef struct place {
    float squared, weight[3];
    uint32_t vertex[3];
} place;

static uint32_t moved(const lod_move *m, uint32_t vertex)
{
    for (uint32_t w = 0; w < m->wedge_count; w++) {
        if (m->wedge_from[w] == vertex) {
            return m->wedge_to[w];
        }
    }
    return vertex;
}

/* The triangles that a move leaves, at rest. */
typedef struct rest_move {
    const lod_move *move;
    float triangles[LOD_FAN_MAX][9]; /* [kept_count] */
    lod_block blocks[FAN_BLOCKS];
} rest_move;

static void rest_move_make(const lod_surface *s, const lod_move *m, rest_move *out)
{
    out->move = m;
    for (uint32_t i = 0; i < m->kept_count; i++) {
        lod_move_triangle(s, m->kept[i], m->to, 0, out->triangles[i]);
    }
    for (uint32_t i = 0; i < m->kept_count; i += LOD_LANES) {
        const uint32_t left = m->kept_count - i;
        lod_block_prepare(out->triangles[i], left < LOD_LANES ? left : LOD_LANES, &out->blocks[i / LOD_LANES]);
    }
}

/* The squared distances of a point to them, [LOD_FAN_MAX]. */
static void rest_move_distances(const rest_move *r, const float *at, float *squared)
{
    for (uint32_t i = 0; i < r->move->kept_count; i += LOD_LANES) {
        lod_block_distances(&r->blocks[i / LOD_LANES], at, squared + i);
    }
}

/* The nearest one at rest, among the new triangles of an island (LOD_NONE: all). 0 if the island has none here. */
static int nearest_place(const lod_surface *s, const rest_move *r, const float *at, uint32_t island, place *out)
{
    const lod_move *m = r->move;
    float squared[LOD_FAN_MAX];
    lod_prepared nearest;
    uint32_t best = LOD_NONE, corner;
    rest_move_distances(r, at, squared);
    out->squared = FLT_MAX;
    for (uint32_t i = 0; i < m->kept_count; i++) {
        if (squared[i] < out->squared && (island == LOD_NONE || s->island[m->kept[i] / 3u] == island)) {
            out->squared = squared[i];
            best = i;
        }
    }
    if (best == LOD_NONE) {
        return 0;
    }
    corner = m->kept[best];
    lod_prepare(r->triangles[best], &nearest);
    (void)lod_distance_weights(&nearest, at, out->weight);
    out->vertex[0] = moved(m, s->corner[corner]);
    out->vertex[1] = s->corner[lod_next(corner)];
    out->vertex[2] = s->corner[lod_previous(corner)];
    return 1;
}

/* The squared difference of attributes first to end - 1, at a point of the new surface and at the weights `mean` of an
 * old triangle's corners. */
static float attribute_error(const lod_surface *s, const place *p, const uint32_t *corners, const float *mean,
                             uint32_t first, uint32_t end)
{
    float sum = 0.0f;
    for (uint32_t k = first; k < end; k++) {
        float there = 0.0f, here = 0.0f;
        for (uint32_t i = 0; i < 3u; i++) {
            there += p->weight[i] * s->attribute[(size_t)p->vertex[i] * LOD_ATTRIBUTES + k];
            here += mean[i] * s->attribute[(size_t)corners[i] * LOD_ATTRIBUTES + k];
        }
        sum += (there - here) * (there - here);
    }
    return sum;
}

/* The part of a vertex's weight on one joint that the new point lacks. */
static float missing_weight(const model_mesh *mesh, const place *p, uint16_t joint, float weight)
{
    for (uint32_t i = 0; i < 3u; i++) {
        size_t row = (size_t)p->vertex[i] * MODEL_INFLUENCES_MAX;
        for (uint32_t k = 0; k < MODEL_INFLUENCES_MAX && mesh->joint_weights[row + k] > 0.0f; k++) {
            if (mesh->joints[row + k] == joint) {
                weight -= p->weight[i] * mesh->joint_weights[row + k];
            }
        }
    }
    return weight > 0.0f ? weight : 0.0f;
}

static double skin_error(const lod_surface *s, const rest_move *m)
{
    size_t row = (size_t)m->move->from * MODEL_INFLUENCES_MAX;
    float missing = 0.0f;
    place p;
    if (!(s->skin_length > 0.0f) || !nearest_place(s, m, lod_posed(&s->poses, m->move->from, 0), LOD_NONE, &p)) {
        return 0.0;
    }
    for (uint32_t k = 0; k < MODEL_INFLUENCES_MAX && s->mesh->joint_weights[row + k] > 0.0f; k++) {
        missing += missing_weight(s->mesh, &p, s->mesh->joints[row + k], s->mesh->joint_weights[row + k]);
    }
    return (double)(missing * s->skin_length) * (missing * s->skin_length);
}

static void weigh_corners(const lod_surface *s, const uint32_t *corners, const float *mean, float at[3])
{
    for (uint32_t k = 0; k < 3u; k++) {
        at[k] = mean[0] * lod_posed(&s->poses, corners[0], 0)[k] + mean[1] * lod_posed(&s->poses, corners[1], 0)[k] +
                mean[2] * lod_posed(&s->poses, corners[2], 0)[k];
    }
}

/* The middle of a triangle, and points near its corners. */
static const float inner_points[4][3] = {
    { 1.0f / 3.0f, 1.0f / 3.0f, 1.0f / 3.0f }, { 0.8f, 0.1f, 0.1f }, { 0.1f, 0.8f, 0.1f }, { 0.1f, 0.1f, 0.8f }
};

/* Colours are compared at the nearest point of any island, where they are seen: otherwise a pupil with its own vertices
 * would shrink into the iris around it. They often change at an edge, where a triangle's centre does not show it. */
static float color_error(const lod_surface *s, const rest_move *m, const uint32_t *corners)
{
    float worst = 0.0f;
    for (uint32_t i = 0; i < 4u; i++) {
        float at[3], error;
        place p;
        weigh_corners(s, corners, inner_points[i], at);
        nearest_place(s, m, at, LOD_NONE, &p);
        error = attribute_error(s, &p, corners, inner_points[i], FIRST_COLOR, LOD_ATTRIBUTES);
        worst = error > worst ? error : worst;
    }
    return worst;
}

/* UVs are compared in the triangle's own island: a vanished one does not count for the others. */
static float uv_error(const lod_surface *s, const rest_move *m, const uint32_t *corners, uint32_t island)
{
    static const float middle[3] = { 1.0f / 3.0f, 1.0f / 3.0f, 1.0f / 3.0f };
    float at[3];
    place p;
    weigh_corners(s, corners, middle, at);
    return nearest_place(s, m, at, island, &p) ? attribute_error(s, &p, corners, middle, 0, FIRST_COLOR) : 0.0f;
}

static void widen(const lod_surface *s, uint32_t vertex, float *low, float *high)
{
    const float *color = s->attribute + (size_t)vertex * LOD_ATTRIBUTES + FIRST_COLOR;
    for (uint32_t k = 0; k < COLORS; k++) {
        low[k] = color[k] < low[k] ? color[k] : low[k];
        high[k] = color[k] > high[k] ? color[k] : high[k];
    }
}

/* No colour error at a triangle is above this: the colours of the new surface here, and its own, differ by no more. */
static float color_bound(const lod_surface *s, const lod_move *m, const uint32_t *corners)
{
    float low[COLORS], high[COLORS], sum = 0.0f;
    memcpy(low, s->attribute + (size_t)corners[0] * LOD_ATTRIBUTES + FIRST_COLOR, sizeof low);
    memcpy(high, low, sizeof high);
    widen(s, corners[1], low, high);
    widen(s, corners[2], low, high);
    for (uint32_t i = 0; i < m->kept_count; i++) {
        const uint32_t c = m->kept[i];
        widen(s, moved(m, s->corner[c]), low, high);
        widen(s, s->corner[lod_next(c)], low, high);
        widen(s, s->corner[lod_previous(c)], low, high);
    }
    for (uint32_t k = 0; k < COLORS; k++) {
        sum += (high[k] - low[k]) * (high[k] - low[k]);
    }
    return sum;
}

/* The squared distance of a point to the triangles of a submesh that a move leaves; where none is left, to the point
 * that stays. */
static float part_squared(const lod_surface *s, const rest_move *r, const float *at, uint32_t submesh)
{
    const float *stays = lod_posed(&s->poses, r->move->to, 0);
    float squareds[LOD_FAN_MAX], best = FLT_MAX, squared;
    rest_move_distances(r, at, squareds);
    for (uint32_t i = 0; i < r->move->kept_count; i++) {
        if (s->submesh[r->move->kept[i] / 3u] == submesh) {
            best = squareds[i] < best ? squareds[i] : best;
        }
    }
    squared = (at[0] - stays[0]) * (at[0] - stays[0]) + (at[1] - stays[1]) * (at[1] - stays[1]) +
              (at[2] - stays[2]) * (at[2] - stays[2]);
    return best < FLT_MAX ? best : squared;
}

/* Whether all triangles that a move leaves are of one submesh, and which. */
static int is_one_part(const lod_surface *s, const lod_move *m, uint32_t *submesh)
{
    *submesh = s->submesh[m->kept[0] / 3u];
    for (uint32_t i = 1; i < m->kept_count; i++) {
        if (s->submesh[m->kept[i] / 3u] != *submesh) {
            return 0;
        }
    }
    return 1;
}

/* Where materials meet, the surface may stay and one of them spread over the other: so the triangles of each are
 * compared with what is left of it. */
static float part_error(const lod_surface *s, const rest_move *r, uint32_t triangle, const uint32_t *corners)
{
    float worst = 0.0f;
    for (uint32_t i = 0; i < 4u; i++) {
        float at[3], squared;
        weigh_corners(s, corners, inner_points[i], at);
        squared = part_squared(s, r, at, s->submesh[triangle]);
        worst = squared > worst ? squared : worst;
    }
    return worst;
}

double lod_attribute_cost(const lod_surface *s, const lod_move *m, const uint32_t *triangles, uint32_t count,
                          const uint32_t *source, double *parts)
{
    uint32_t part;
    rest_move r;
    double worst;
    int one_part;
    *parts = 0.0;
    if (!m->kept_count) {
        return 0.0;
    }
    rest_move_make(s, m, &r);
    one_part = is_one_part(s, m, &part);
    worst = skin_error(s, &r);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corners = source + (size_t)triangles[i] * 3u;
        float error = s->mesh->uv ? uv_error(s, &r, corners, s->island[triangles[i]]) : 0.0f;
        if (s->mesh->color && error + color_bound(s, m, corners) * BOUND_ROUNDING > worst) {
            error += color_error(s, &r, corners);
        }
        if (!one_part || s->submesh[triangles[i]] != part) {
            const float apart = part_error(s, &r, triangles[i], corners);
            *parts = apart > *parts ? apart : *parts;
            error += apart;
        }
        worst = error > worst ? error : worst;
    }
    return worst;
}
