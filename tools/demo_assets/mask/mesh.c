#include "mesh.h"

#include "shared/grab.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
    V3 at, open; /* at rest; with the jaw open, which parts lips that meet at rest */
    int vertex;
} Placed;

static int compare(double a, double b)
{
    return (a > b) - (a < b);
}

static int compare_places(V3 a, V3 b)
{
    int order = compare(a.x, b.x);
    if (!order) {
        order = compare(a.y, b.y);
    }
    return order ? order : compare(a.z, b.z);
}

static int placed_order(const void *left, const void *right)
{
    const Placed *a = left, *b = right;
    int order = compare_places(a->at, b->at);
    if (!order) {
        order = compare_places(a->open, b->open);
    }
    return order ? order : (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

int *mesh_weld(const Part *part)
{
    static const Pose rest, open = { .jaw_open = 1 };
    int count = part->seed_count;
    Placed *placed = grab(NULL, count, (int)sizeof *placed);
    int *first = grab(NULL, count, (int)sizeof *first);
    for (int i = 0; i < count; i++) {
        placed[i].at = part->place(&part->seeds[i], &rest);
        placed[i].open = part->place(&part->seeds[i], &open);
        placed[i].vertex = i;
    }
    qsort(placed, (size_t)count, sizeof *placed, placed_order);
    for (int i = 0; i < count; i++) {
        const Placed *last = &placed[i > 0 ? i - 1 : 0];
        int joined = i > 0 && !compare_places(last->at, placed[i].at) && !compare_places(last->open, placed[i].open);
        first[placed[i].vertex] = joined ? first[last->vertex] : placed[i].vertex;
    }
    free(placed);
    return first;
}

static double corner_angle(V3 at, V3 next, V3 last)
{
    V3 a = v3_unit(v3_sub(next, at)), b = v3_unit(v3_sub(last, at));
    return acos(clamp(v3_dot(a, b), -1, 1));
}

/* Direction in which u (or v) grows over a triangle; zero where the texture
 * is flat. */
static V3 gradient(V3 edge1, V3 edge2, double across1, double across2, double turn)
{
    if (fabs(turn) < 1e-14) {
        return v3(0, 0, 0);
    }
    V3 sum = v3_sub(v3_scale(edge1, across2), v3_scale(edge2, across1));
    return v3_unit(v3_scale(sum, turn > 0 ? 1 : -1));
}

typedef struct {
    V3 *normal, *along_u, *along_v;
} Sums;

static void add_triangle(const Part *part, const int *first, const Frame *frame, Sums sums, const uint32_t *corner)
{
    const Seed *s0 = &part->seeds[corner[0]], *s1 = &part->seeds[corner[1]], *s2 = &part->seeds[corner[2]];
    V3 p[3];
    for (int i = 0; i < 3; i++) {
        p[i] = frame->position[corner[i]];
    }
    V3 edge1 = v3_sub(p[1], p[0]), edge2 = v3_sub(p[2], p[0]);
    V3 normal = v3_unit(v3_cross(edge1, edge2));
    double u1 = s1->u - s0->u, u2 = s2->u - s0->u, v1 = s1->v - s0->v, v2 = s2->v - s0->v;
    double turn = u1 * v2 - u2 * v1;
    V3 along_u = gradient(edge1, edge2, v1, v2, turn);
    V3 along_v = gradient(edge1, edge2, u1, u2, -turn);
    for (int i = 0; i < 3; i++) {
        double angle = corner_angle(p[i], p[(i + 1) % 3], p[(i + 2) % 3]);
        V3 *n = &sums.normal[first[corner[i]]];
        *n = v3_add(*n, v3_scale(normal, angle));
        V3 *u = &sums.along_u[corner[i]], *v = &sums.along_v[corner[i]];
        *u = v3_add(*u, v3_scale(along_u, angle));
        *v = v3_add(*v, v3_scale(along_v, angle));
    }
}

/* The part of `along` that lies in the surface; if there is none, any direction in the surface. */
static V3 in_surface(V3 along, V3 normal)
{
    V3 flat = v3_sub(along, v3_scale(normal, v3_dot(along, normal)));
    if (v3_length(flat) > 1e-6) {
        return v3_unit(flat);
    }
    V3 other = fabs(normal.y) < 0.9 ? v3(0, 1, 0) : v3(1, 0, 0);
    return v3_unit(v3_cross(other, normal));
}

Frame mesh_frame(const Part *part, const int *first, const Pose *pose)
{
    int count = part->seed_count, vector = (int)sizeof(V3);
    Frame frame = { .count = count };
    frame.position = grab(NULL, count, vector);
    frame.normal = grab(NULL, count, vector);
    frame.tangent = grab(NULL, count, vector);
    frame.handedness = grab(NULL, count, (int)sizeof(double));
    Sums sums = { grab(NULL, count, vector), grab(NULL, count, vector), grab(NULL, count, vector) };
    for (int i = 0; i < count; i++) {
        frame.position[i] = part->place(&part->seeds[i], pose);
        sums.normal[i] = sums.along_u[i] = sums.along_v[i] = v3(0, 0, 0);
    }
    for (int i = 0; i < part->index_count; i += 3) {
        add_triangle(part, first, &frame, sums, &part->indices[i]);
    }
    for (int i = 0; i < count; i++) {
        V3 normal = v3_unit(sums.normal[first[i]]);
        V3 tangent = in_surface(sums.along_u[i], normal);
        /* v runs down the image, and the bitangent must run up. */
        double up = -v3_dot(v3_cross(normal, tangent), sums.along_v[i]);
        frame.normal[i] = normal;
        frame.tangent[i] = tangent;
        frame.handedness[i] = up < 0 ? -1 : 1;
    }
    free(sums.normal);
    free(sums.along_u);
    free(sums.along_v);
    return frame;
}

void mesh_free(Frame *frame)
{
    free(frame->position);
    free(frame->normal);
    free(frame->tangent);
    free(frame->handedness);
}
