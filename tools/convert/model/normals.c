/* normals.c: smooth normals for meshes that have none.
 *
 * glTF (2.0, 3.7.2.1) asks for flat normals where a file has none, which would split every vertex of an indexed mesh.
 * The vertices are kept: all triangles of one vertex
 * share its normal, and triangles of welded vertices join in where they meet at
 * an edge below the crease angle. A mesh that splits vertices at its hard edges keeps these hard, and seams in smooth
 * surfaces do not show. Triangles are weighted by their angle at the vertex, which makes the normal independent of the
 * triangulation (Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998). */
#include "islands.h"
#include "model_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CREASE_COSINE 0.5 /* 60 degrees */

/* A triangle is degenerate when its height is below this part of its longest
 * edge: its normal would be rounding noise. */
#define SLIVER 1e-6

/* Where a triangle's edges point and which way it faces, in one pose. */
typedef struct face {
    double edge[3][3]; /* edge[i] leads from corner i to corner i+1 */
    double normal[3];  /* unit, or zero when degenerate */
} face;

static void face_evaluate(const model_mesh *mesh, const float *delta, size_t first_corner, face *out)
{
    double p[3][3], longest = 0.0;
    for (size_t k = 0; k < 3; ++k) vec_posed(mesh->position, delta, mesh->indices[first_corner + k], p[k]);
    for (size_t k = 0; k < 3; ++k) {
        for (size_t i = 0; i < 3; ++i) out->edge[k][i] = p[(k + 1) % 3][i] - p[k][i];
        double square = vec_dot(out->edge[k], out->edge[k]);
        longest = square > longest ? square : longest;
    }
    vec_cross(out->edge[0], out->edge[1], out->normal);
    double twice_area = sqrt(vec_dot(out->normal, out->normal));
    if (!(twice_area > SLIVER * longest) || !vec_normalize(out->normal)) memset(out->normal, 0, sizeof out->normal);
}

static int face_usable(const face *f)
{
    return vec_dot(f->normal, f->normal) > 0.0;
}

static double face_corner_angle(const face *f, size_t k)
{
    double back[3];
    for (size_t i = 0; i < 3; ++i) back[i] = -f->edge[(k + 2) % 3][i];
    return vec_angle(f->edge[k], back);
}

/* An edge of the welded surface and the triangles found at it so far. More than two are kept because doubled cards
 * (lashes, leaves) have four at one edge. */
#define EDGE_FACES 4
typedef struct edge {
    uint32_t a, b;             /* welded vertices, a < b; a == b: the entry is free */
    uint32_t face_count;       /* of all found; `face` holds the latest */
    uint32_t face[EDGE_FACES]; /* triangle * 3 + k: the edge leaves its corner k */
} edge;

typedef struct fan_builder {
    const model_mesh *mesh;
    const uint32_t *weld;
    uint32_t *parent; /* [corner_count] */
    float *normal;    /* [triangle_count][3] of the base pose */
    edge *edges;
    size_t edge_slots;
} fan_builder;

static edge *edge_find(fan_builder *b, uint32_t v0, uint32_t v1)
{
    uint32_t low = v0 < v1 ? v0 : v1, high = v0 < v1 ? v1 : v0;
    uint64_t hash = (((uint64_t)high << 32) | low) * 0x9e3779b97f4a7c15u;
    size_t slot = (size_t)(hash >> 20) & (b->edge_slots - 1);
    for (;; slot = (slot + 1) & (b->edge_slots - 1)) {
        edge *e = &b->edges[slot];
        if (e->a == e->b) {
            e->a = low;
            e->b = high;
            return e;
        }
        if (e->a == low && e->b == high) return e;
    }
}

static int smooth_between(const fan_builder *b, uint32_t triangle_0, uint32_t triangle_1)
{
    const float *n0 = b->normal + (size_t)triangle_0 * 3, *n1 = b->normal + (size_t)triangle_1 * 3;
    double cosine = 0.0;
    for (int i = 0; i < 3; ++i) cosine += (double)n0[i] * (double)n1[i];
    return cosine >= CREASE_COSINE;
}

/* Join the corners of two triangles at both ends of their shared edge, which leaves from_0 in one triangle and from_1
 * in the other. */
static void join_across(fan_builder *b, uint32_t from_0, uint32_t from_1)
{
    uint32_t to_0 = from_0 / 3 * 3 + (from_0 + 1) % 3, to_1 = from_1 / 3 * 3 + (from_1 + 1) % 3;
    const uint32_t *index = b->mesh->indices;
    if (b->weld[index[from_0]] != b->weld[index[from_1]]) { /* the usual case: opposite directions */
        uint32_t swap = from_1;
        from_1 = to_1;
        to_1 = swap;
    }
    islands_join(b->parent, from_0, from_1);
    islands_join(b->parent, to_0, to_1);
}

static void add_edge(fan_builder *b, uint32_t corner)
{
    uint32_t next = corner / 3 * 3 + (corner + 1) % 3;
    uint32_t v0 = b->weld[b->mesh->indices[corner]], v1 = b->weld[b->mesh->indices[next]];
    if (v0 == v1) return;
    edge *e = edge_find(b, v0, v1);
    uint32_t kept = e->face_count < EDGE_FACES ? e->face_count : EDGE_FACES;
    for (uint32_t i = 0; i < kept; ++i)
        if (smooth_between(b, corner / 3, e->face[i] / 3)) join_across(b, corner, e->face[i]);
    e->face[e->face_count % EDGE_FACES] = corner;
    ++e->face_count;
}

/* Corners of the same vertex are in one fan, whatever the angle. */
static void join_vertices(fan_builder *b, uint32_t *first_corner)
{
    const model_mesh *mesh = b->mesh;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) first_corner[v] = MODEL_NONE;
    for (uint32_t c = 0; c < mesh->index_count; ++c) {
        uint32_t *first = &first_corner[mesh->indices[c]];
        if (*first == MODEL_NONE)
            *first = c;
        else
            islands_join(b->parent, *first, c);
    }
}

static void join_smooth_edges(fan_builder *b)
{
    for (uint32_t c = 0; c + 2 < b->mesh->index_count; c += 3) {
        face f;
        face_evaluate(b->mesh, NULL, c, &f);
        for (size_t i = 0; i < 3; ++i) b->normal[(size_t)c + i] = (float)f.normal[i];
        for (uint32_t k = 0; face_usable(&f) && k < 3; ++k) add_edge(b, c + k);
    }
}

/* Number the fans in order of their first corner. */
static void number_fans(fan_builder *b, normal_fans *out)
{
    for (uint32_t c = 0; c < out->corner_count; ++c) {
        uint32_t root = islands_root(b->parent, c);
        out->corner_fan[c] = root == c ? out->fan_count++ : out->corner_fan[root];
    }
    /* until here vertex_fan held each vertex's first corner */
    for (uint32_t v = 0; v < b->mesh->vertex_count; ++v)
        if (out->vertex_fan[v] != MODEL_NONE) out->vertex_fan[v] = out->corner_fan[out->vertex_fan[v]];
}

static int builder_allocate(fan_builder *b, normal_fans *out)
{
    size_t corners = b->mesh->index_count;
    b->edge_slots = 16;
    while (b->edge_slots < corners * 2) b->edge_slots *= 2;
    b->parent = model_zeros(corners, sizeof *b->parent);
    b->normal = model_zeros(corners, sizeof *b->normal);
    b->edges = model_zeros(b->edge_slots, sizeof *b->edges);
    out->corner_count = b->mesh->index_count;
    out->corner_fan = model_zeros(corners, sizeof *out->corner_fan);
    out->vertex_fan = model_zeros(b->mesh->vertex_count, sizeof *out->vertex_fan);
    return !b->parent || !b->normal || !b->edges || !out->corner_fan || !out->vertex_fan;
}

int normals_build(const model_mesh *mesh, const uint32_t *weld, normal_fans *out)
{
    fan_builder b = { 0 };
    b.mesh = mesh;
    b.weld = weld;
    memset(out, 0, sizeof *out);
    int failed = builder_allocate(&b, out);
    if (!failed) {
        for (uint32_t c = 0; c < mesh->index_count; ++c) b.parent[c] = c;
        join_vertices(&b, out->vertex_fan);
        join_smooth_edges(&b);
        number_fans(&b, out);
        out->normal = model_zeros(out->fan_count, 3 * sizeof *out->normal);
        failed = out->normal == NULL;
    }
    free(b.parent);
    free(b.normal);
    free(b.edges);
    if (failed) normals_free(out);
    return failed;
}

static int wanted(const uint8_t *touched, uint32_t fan)
{
    return !touched || touched[fan];
}

static void add_face(normal_fans *fans, const face *f, const uint32_t *fan, const uint8_t *touched)
{
    for (size_t k = 0; k < 3; ++k) {
        if (!wanted(touched, fan[k])) continue;
        double angle = face_corner_angle(f, k);
        for (size_t i = 0; i < 3; ++i) fans->normal[(size_t)fan[k] * 3 + i] += f->normal[i] * angle;
    }
}

void normals_evaluate(normal_fans *fans, const model_mesh *mesh, const float *delta, const uint8_t *touched)
{
    for (uint32_t n = 0; n < fans->fan_count; ++n)
        if (wanted(touched, n)) memset(fans->normal + (size_t)n * 3, 0, 3 * sizeof(double));
    for (uint32_t c = 0; c + 2 < fans->corner_count; c += 3) {
        const uint32_t *fan = fans->corner_fan + c;
        if (!wanted(touched, fan[0]) && !wanted(touched, fan[1]) && !wanted(touched, fan[2])) continue;
        face f;
        face_evaluate(mesh, delta, c, &f);
        if (face_usable(&f)) add_face(fans, &f, fan, touched);
    }
    for (uint32_t n = 0; n < fans->fan_count; ++n) {
        double *normal = fans->normal + (size_t)n * 3;
        if (wanted(touched, n) && (!(vec_dot(normal, normal) > 1e-12) || !vec_normalize(normal)))
            memset(normal, 0, 3 * sizeof(double)); /* no area, or faces that cancel out */
    }
}

void normals_free(normal_fans *fans)
{
    free(fans->corner_fan);
    free(fans->vertex_fan);
    free(fans->normal);
    memset(fans, 0, sizeof *fans);
}
