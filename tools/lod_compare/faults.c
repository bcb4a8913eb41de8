/* faults.c: counts what a level must not have. */
#include <stdlib.h>
#include <string.h>

#include "compare.h"
#include "convert/model/model_build.h"

/* ---- UVs ---- */

static uint32_t root(uint32_t *parent, uint32_t v)
{
    while (parent[v] != v) {
        v = parent[v] = parent[parent[v]];
    }
    return v;
}

static int uv_sign(const model_mesh *mesh, const uint32_t *corner)
{
    const float *a = mesh->uv + (size_t)corner[0] * 2u, *b = mesh->uv + (size_t)corner[1] * 2u,
                *c = mesh->uv + (size_t)corner[2] * 2u;
    double area = ((double)b[0] - a[0]) * ((double)c[1] - a[1]) - ((double)b[1] - a[1]) * ((double)c[0] - a[0]);
    return (area > 0.0) - (area < 0.0);
}

/* Islands, and the orientation of most of an island's triangles, are taken from the full mesh. */
static uint32_t count_flips(const model_mesh *mesh, const uint32_t *indices, uint32_t index_count)
{
    uint32_t *parent = compare_zeros(mesh->vertex_count, sizeof *parent), flips = 0;
    int32_t *side = compare_zeros(mesh->vertex_count, sizeof *side);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        parent[v] = v;
    }
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        parent[root(parent, mesh->indices[i])] = root(parent, mesh->indices[i - i % 3u]);
    }
    for (uint32_t i = 0; i < mesh->index_count; i += 3u) {
        side[root(parent, mesh->indices[i])] += uv_sign(mesh, mesh->indices + i);
    }
    for (uint32_t i = 0; i < index_count; i += 3u) {
        int32_t sum = side[root(parent, indices[i])], sign = uv_sign(mesh, indices + i);
        flips += (sum > 0 && sign < 0) || (sum < 0 && sign > 0);
    }
    free(parent);
    free(side);
    return flips;
}

/* ---- edges ---- */

static int by_number(const void *a, const void *b)
{
    uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

static uint32_t count_non_manifold(const model_mesh *mesh, const uint32_t *indices, uint32_t index_count)
{
    uint32_t *weld = compare_zeros(mesh->vertex_count, sizeof *weld), count = 0, run = 1;
    uint64_t *edges = compare_zeros(index_count, sizeof *edges);
    if (weld_vertices(mesh, weld)) {
        abort();
    }
    for (uint32_t i = 0; i < index_count; i++) {
        uint64_t a = weld[indices[i]], b = weld[indices[i % 3u == 2u ? i - 2u : i + 1u]];
        edges[i] = a < b ? a << 32 | b : b << 32 | a;
    }
    qsort(edges, index_count, sizeof *edges, by_number);
    for (uint32_t i = 1; i <= index_count; i++) {
        if (i < index_count && edges[i] == edges[i - 1u]) {
            run++;
        } else {
            count += run > 2u;
            run = 1;
        }
    }
    free(weld);
    free(edges);
    return count;
}

void faults_of(const model_mesh *mesh, const uint32_t *indices, uint32_t index_count, faults *out)
{
    out->uv_flips = mesh->uv ? count_flips(mesh, indices, index_count) : 0;
    out->non_manifold = count_non_manifold(mesh, indices, index_count);
}
