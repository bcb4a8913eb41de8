#include "wrinkle_strain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

#define ROUNDINGS 4.0  /* of a float, that the difference of two corners may be off by */
#define SHRINK_MAX 0.6 /* a triangle that folds up altogether wrinkles no more than this */

static void edges_of(double corners[3][3], double a[3], double b[3])
{
    for (int i = 0; i < 3; i++) {
        a[i] = corners[1][i] - corners[0][i];
        b[i] = corners[2][i] - corners[0][i];
    }
}

/* C = R^-T G R^-1, with G the inner products of the moved edges and R the edges at rest in the plane of x along the
 * first one: its eigenvalues are the squares of the stretches. */
static void metric_of(double ax, double bx, double by, double a[3], double b[3], double c[3])
{
    const double aa = vec_dot(a, a), ab = vec_dot(a, b), bb = vec_dot(b, b);
    c[0] = aa / (ax * ax);
    c[1] = (ab - bx * aa / ax) / (ax * by);
    c[2] = (bb - 2.0 * bx * ab / ax + bx * bx * aa / (ax * ax)) / (by * by);
}

/* The larger eigenvalue of [[c0, c1], [c1, c2]], the smaller one, and the direction of the larger. */
static void eigen(const double c[3], double *most, double *least, double direction[2])
{
    const double mean = 0.5 * (c[0] + c[2]), half = 0.5 * (c[0] - c[2]), root = sqrt(half * half + c[1] * c[1]);
    double length;
    *most = mean + root;
    *least = mean - root > 0.0 ? mean - root : 0.0;
    direction[0] = half >= 0.0 ? half + root : c[1];
    direction[1] = half >= 0.0 ? c[1] : root - half;
    length = sqrt(direction[0] * direction[0] + direction[1] * direction[1]);
    direction[0] = length > 0.0 ? direction[0] / length : 1.0;
    direction[1] = length > 0.0 ? direction[1] / length : 0.0;
}

int wrinkle_strain_of(double rest[3][3], double now[3][3], wrinkle_strain *out)
{
    double a[3], b[3], moved_a[3], moved_b[3], x[3], y[3], c[3], direction[2], most, least, ax, bx, by;
    edges_of(rest, a, b);
    edges_of(now, moved_a, moved_b);
    memcpy(x, a, sizeof x);
    memcpy(y, b, sizeof y);
    ax = sqrt(vec_dot(a, a));
    if (!vec_normalize(x)) {
        return 0;
    }
    bx = vec_dot(b, x);
    vec_reject(y, x);
    by = sqrt(vec_dot(y, y));
    if (by <= 1e-6 * ax || !vec_normalize(y)) {
        return 0;
    }
    metric_of(ax, bx, by, moved_a, moved_b, c);
    eigen(c, &most, &least, direction);
    out->most = sqrt(most);
    out->least = sqrt(least);
    for (int i = 0; i < 3; i++) {
        out->axis[i] = direction[0] * x[i] + direction[1] * y[i];
    }
    return 1;
}

/* ---- a mesh ---- */

static int allocate(const model_mesh *mesh, wrinkle_field *f)
{
    const size_t triangles = mesh->index_count / 3u, vertices = mesh->vertex_count, targets = mesh->target_count;
    f->triangles = model_zeros(triangles, sizeof *f->triangles);
    f->area = model_zeros(triangles, sizeof *f->area);
    f->shrink = model_zeros(triangles, targets * sizeof *f->shrink);
    f->largest = model_zeros(triangles, sizeof *f->largest);
    f->demand = model_zeros(triangles, sizeof *f->demand);
    f->point = model_zeros(vertices, sizeof *f->point);
    f->point_area = model_zeros(vertices, sizeof *f->point_area);
    f->point_shrink = model_zeros(vertices, targets * sizeof *f->point_shrink);
    f->point_largest = model_zeros(vertices, sizeof *f->point_largest);
    f->tensor = model_zeros(vertices, sizeof *f->tensor);
    return !f->triangles || !f->area || !f->shrink || !f->largest || !f->demand || !f->point || !f->point_area ||
           !f->point_shrink || !f->point_largest || !f->tensor;
}

static void corners_of(const wrinkle_field *f, uint32_t triangle, const float *delta, double out[3][3])
{
    for (uint32_t k = 0; k < 3; k++) {
        vec_posed(f->mesh->position, delta, wrinkle_corner(f, triangle, k), out[k]);
    }
}

static double area_of(double corners[3][3])
{
    double a[3], b[3], n[3];
    edges_of(corners, a, b);
    vec_cross(a, b, n);
    return 0.5 * sqrt(vec_dot(n, n));
}

/* Whether a target moves a corner of a triangle. */
static int is_moved(const wrinkle_field *f, uint32_t triangle, const float *delta)
{
    for (uint32_t k = 0; k < 3; k++) {
        const float *d = delta + 3 * (size_t)wrinkle_corner(f, triangle, k);
        if (d[0] != 0.0f || d[1] != 0.0f || d[2] != 0.0f) return 1;
    }
    return 0;
}

/* Coordinates are floats, and differences of floats where a target came from: a compression up to this is rounding. */
static double noise_of(double rest[3][3], double now[3][3], double area)
{
    double largest = 0.0, longest = 0.0;
    for (int k = 0; k < 3; k++) {
        double edge[3];
        for (int c = 0; c < 3; c++) {
            largest = fmax(largest, fmax(fabs(rest[k][c]), fabs(now[k][c])));
            edge[c] = rest[(k + 1) % 3][c] - rest[k][c];
        }
        longest = fmax(longest, vec_dot(edge, edge));
    }
    return ROUNDINGS * 0x1p-23 * largest * sqrt(longest) / (2.0 * area); /* over the least height */
}

static void measure_triangle(wrinkle_field *f, uint32_t i)
{
    const uint32_t targets = f->mesh->target_count;
    double rest[3][3], now[3][3];
    corners_of(f, i, NULL, rest);
    f->area[i] = area_of(rest);
    for (uint32_t t = 0; t < targets; t++) {
        const float *delta = f->mesh->targets[t].position;
        wrinkle_strain strain;
        double shrink;
        if (!is_moved(f, i, delta)) continue;
        corners_of(f, i, delta, now);
        if (!wrinkle_strain_of(rest, now, &strain) || 1.0 - strain.least <= noise_of(rest, now, f->area[i])) continue;
        shrink = 1.0 - strain.least < SHRINK_MAX ? 1.0 - strain.least : SHRINK_MAX;
        f->shrink[(size_t)i * targets + t] = (float)shrink;
        f->largest[i] = (float)shrink > f->largest[i] ? (float)shrink : f->largest[i];
        for (int k = 0; k < 6; k++) {
            static const int row[6] = { 0, 1, 2, 0, 0, 1 }, column[6] = { 0, 1, 2, 1, 2, 2 };
            f->demand[i][k] += shrink * shrink * strain.axis[row[k]] * strain.axis[column[k]];
        }
    }
    f->shrinking += f->area[i] * (double)f->largest[i];
}

static void add_to_point(wrinkle_field *f, uint32_t i, uint32_t point)
{
    const uint32_t targets = f->mesh->target_count;
    f->point_area[point] += f->area[i];
    for (uint32_t t = 0; t < targets; t++) {
        f->point_shrink[(size_t)point * targets + t] += (float)(f->area[i] *
                                                                (double)f->shrink[(size_t)i * targets + t]);
    }
    for (int k = 0; k < 6; k++) {
        f->tensor[point][k] += f->area[i] * f->demand[i][k];
    }
}

static void divide_point(wrinkle_field *f, uint32_t point)
{
    const uint32_t targets = f->mesh->target_count;
    const double area = f->point_area[point];
    for (uint32_t t = 0; t < targets && area > 0.0; t++) {
        float *shrink = &f->point_shrink[(size_t)point * targets + t];
        *shrink = (float)((double)*shrink / area);
        f->point_largest[point] = *shrink > f->point_largest[point] ? *shrink : f->point_largest[point];
    }
    for (int k = 0; k < 6 && area > 0.0; k++) {
        f->tensor[point][k] /= area;
    }
}

/* Vertices at the same place get the first one's value. */
static void copy_point(wrinkle_field *f, uint32_t vertex)
{
    const uint32_t point = f->point[vertex], targets = f->mesh->target_count;
    f->point_area[vertex] = f->point_area[point];
    f->point_largest[vertex] = f->point_largest[point];
    memcpy(f->tensor[vertex], f->tensor[point], sizeof *f->tensor);
    memcpy(&f->point_shrink[(size_t)vertex * targets], &f->point_shrink[(size_t)point * targets],
           targets * sizeof *f->point_shrink);
}

static void list_triangles(const model_mesh *mesh, uint32_t material, wrinkle_field *f)
{
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const model_submesh *sub = &mesh->submeshes[s];
        for (uint32_t i = 0; i + 2 < sub->index_count && sub->material == material; i += 3) {
            f->triangles[f->triangle_count++] = sub->first_index + i;
        }
    }
}

int wrinkle_field_make(const model_mesh *mesh, uint32_t material, wrinkle_field *out)
{
    memset(out, 0, sizeof *out);
    out->mesh = mesh;
    out->material = material;
    if (allocate(mesh, out) || weld_vertices(mesh, out->point)) {
        return 1;
    }
    list_triangles(mesh, material, out);
    for (uint32_t i = 0; i < out->triangle_count; i++) {
        measure_triangle(out, i);
        for (uint32_t k = 0; k < 3; k++) {
            add_to_point(out, i, out->point[wrinkle_corner(out, i, k)]);
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (out->point[v] == v) divide_point(out, v);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (out->point[v] != v) copy_point(out, v);
    }
    return 0;
}

void wrinkle_field_free(wrinkle_field *f)
{
    free(f->triangles);
    free(f->area);
    free(f->shrink);
    free(f->largest);
    free(f->demand);
    free(f->point);
    free(f->point_area);
    free(f->point_shrink);
    free(f->point_largest);
    free(f->tensor);
    memset(f, 0, sizeof *f);
}
