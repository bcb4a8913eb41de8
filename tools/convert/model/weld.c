/* weld.c: which vertices are one point of the surface.
 *
 * glTF splits a vertex where UVs, normals or materials change; computed normals and tangents must not show those seams.
 */
#include "model_build.h"

#include <stdlib.h>
#include <string.h>

static uint64_t hash_floats(uint64_t hash, const float *values, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        float value = values[i] + 0.0f; /* -0 and +0 are the same place */
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

int model_same_floats(const float *a, const float *b, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        if (!(a[i] == b[i])) return 0;
    return 1;
}

static uint64_t vertex_hash(const model_mesh *mesh, uint32_t v)
{
    uint64_t hash = hash_floats(0, mesh->position + (size_t)v * 3, 3);
    for (uint32_t t = 0; t < mesh->target_count; ++t)
        hash = hash_floats(hash, mesh->targets[t].position + (size_t)v * 3, 3);
    return hash;
}

static int vertex_same(const model_mesh *mesh, uint32_t a, uint32_t b)
{
    if (!model_same_floats(mesh->position + (size_t)a * 3, mesh->position + (size_t)b * 3, 3)) return 0;
    for (uint32_t t = 0; t < mesh->target_count; ++t) {
        const float *delta = mesh->targets[t].position;
        if (!model_same_floats(delta + (size_t)a * 3, delta + (size_t)b * 3, 3)) return 0;
    }
    return 1;
}

int weld_vertices(const model_mesh *mesh, uint32_t *out)
{
    size_t slots = 16;
    while (slots < (size_t)mesh->vertex_count * 2) slots *= 2;
    uint32_t *table = model_zeros(slots, sizeof *table); /* vertex + 1, 0 = free */
    if (!table) return 1;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        size_t slot = (size_t)vertex_hash(mesh, v) & (slots - 1);
        while (table[slot] && !vertex_same(mesh, table[slot] - 1, v)) slot = (slot + 1) & (slots - 1);
        if (!table[slot]) table[slot] = v + 1;
        out[v] = table[slot] - 1;
    }
    free(table);
    return 0;
}
