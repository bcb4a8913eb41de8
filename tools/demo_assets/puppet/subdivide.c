#include "subdivide.h"

#include "shared/grab.h"

#include <stdio.h>
#include <stdlib.h>

/* One side of a face. Sorted, the two that share an edge are neighbours. */
typedef struct {
    int low, high; /* its vertices */
    int face, side;
} HalfEdge;

static int half_edge_order(const void *left, const void *right)
{
    const HalfEdge *a = left, *b = right;
    int order = (a->low > b->low) - (a->low < b->low);
    if (!order) {
        order = (a->high > b->high) - (a->high < b->high);
    }
    return order ? order : (a->face > b->face) - (a->face < b->face);
}

static HalfEdge *sort_edges(const Cage *cage)
{
    int count = 4 * cage->face_count;
    HalfEdge *edges = grab(NULL, count, (int)sizeof *edges);
    for (int i = 0; i < count; i++) {
        const int *corner = cage->faces[i / 4].corner;
        int a = corner[i % 4], b = corner[(i + 1) % 4];
        HalfEdge edge = { a < b ? a : b, a < b ? b : a, i / 4, i % 4 };
        edges[i] = edge;
    }
    qsort(edges, (size_t)count, sizeof *edges, half_edge_order);
    for (int i = 0; i < count; i += 2) {
        int again = i + 2 < count && edges[i + 2].low == edges[i].low && edges[i + 2].high == edges[i].high;
        if (again || edges[i].low != edges[i + 1].low || edges[i].high != edges[i + 1].high) {
            fprintf(stderr, "demo_assets: the puppet's cage is not closed at vertex %d\n", edges[i].low);
            exit(1);
        }
    }
    return edges;
}

static void add(CageVertex *sum, const CageVertex *more, double k)
{
    sum->at = v3_add(sum->at, v3_scale(more->at, k));
    for (int i = 0; i < JOINT_COUNT; i++) {
        sum->hold.by[i] += k * more->hold.by[i];
    }
}

static int blank(Cage *fine)
{
    Hold nothing = { { 0 } };
    return cage_vertex(fine, v3(0, 0, 0), nothing);
}

/* The new vertices lie in this order: of vertices, of faces, of edges. */
static void make_face_points(const Cage *cage, Cage *fine)
{
    for (int f = 0; f < cage->face_count; f++) {
        int middle = blank(fine);
        for (int i = 0; i < 4; i++) {
            add(&fine->vertices[middle], &cage->vertices[cage->faces[f].corner[i]], 0.25);
        }
    }
}

/* edge_of: for each side of each face the new vertex on it. */
static void make_edge_points(const Cage *cage, const HalfEdge *edges, Cage *fine, int *edge_of)
{
    int first_face = cage->vertex_count;
    for (int i = 0; i < 4 * cage->face_count; i += 2) {
        int point = blank(fine);
        CageVertex sum = fine->vertices[point];
        add(&sum, &cage->vertices[edges[i].low], 0.25);
        add(&sum, &cage->vertices[edges[i].high], 0.25);
        add(&sum, &fine->vertices[first_face + edges[i].face], 0.25);
        add(&sum, &fine->vertices[first_face + edges[i + 1].face], 0.25);
        fine->vertices[point] = sum;
        edge_of[4 * edges[i].face + edges[i].side] = point;
        edge_of[4 * edges[i + 1].face + edges[i + 1].side] = point;
    }
}

/* With n faces about a vertex: the mean of their centres, plus twice the mean of its edges' midpoints, plus n - 3 times
 * itself, all over n. */
static void make_vertex_points(const Cage *cage, const HalfEdge *edges, Cage *fine)
{
    int *around = grab(NULL, cage->vertex_count, (int)sizeof *around);
    for (int i = 0; i < cage->vertex_count; i++) {
        around[i] = 0;
    }
    for (int i = 0; i < 4 * cage->face_count; i++) {
        around[cage->faces[i / 4].corner[i % 4]]++;
    }
    for (int i = 0; i < 4 * cage->face_count; i++) {
        int vertex = cage->faces[i / 4].corner[i % 4];
        add(&fine->vertices[vertex], &fine->vertices[cage->vertex_count + i / 4],
            1.0 / around[vertex] / around[vertex]);
    }
    for (int i = 0; i < 4 * cage->face_count; i += 2) {
        int ends[2] = { edges[i].low, edges[i].high };
        for (int e = 0; e < 2; e++) {
            double k = 1.0 / around[ends[e]] / around[ends[e]];
            add(&fine->vertices[ends[e]], &cage->vertices[ends[0]], k);
            add(&fine->vertices[ends[e]], &cage->vertices[ends[1]], k);
        }
    }
    for (int i = 0; i < cage->vertex_count; i++) {
        add(&fine->vertices[i], &cage->vertices[i], (around[i] - 3.0) / around[i]);
    }
    free(around);
}

static void split_faces(const Cage *cage, const int *edge_of, Cage *fine)
{
    for (int f = 0; f < cage->face_count; f++) {
        const CageFace *face = &cage->faces[f];
        double u = 0, v = 0;
        for (int i = 0; i < 4; i++) {
            u += 0.25 * face->u[i];
            v += 0.25 * face->v[i];
        }
        for (int i = 0; i < 4; i++) {
            int next = (i + 1) % 4, last = (i + 3) % 4;
            CageFace part = { { face->corner[i], edge_of[4 * f + i], cage->vertex_count + f, edge_of[4 * f + last] },
                              { face->u[i], 0.5 * (face->u[i] + face->u[next]), u, 0.5 * (face->u[i] + face->u[last]) },
                              { face->v[i], 0.5 * (face->v[i] + face->v[next]), v, 0.5 * (face->v[i] + face->v[last]) },
                              face->paint };
            cage_face(fine, &part);
        }
    }
}

Cage subdivide(const Cage *cage)
{
    Cage fine = { 0 };
    HalfEdge *edges = sort_edges(cage);
    int *edge_of = grab(NULL, 4 * cage->face_count, (int)sizeof *edge_of);
    for (int i = 0; i < cage->vertex_count; i++) {
        blank(&fine);
    }
    make_face_points(cage, &fine);
    make_edge_points(cage, edges, &fine, edge_of);
    make_vertex_points(cage, edges, &fine);
    split_faces(cage, edge_of, &fine);
    free(edges);
    free(edge_of);
    return fine;
}
