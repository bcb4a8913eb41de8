#include "islands.h"

#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

uint32_t islands_root(uint32_t *parent, uint32_t v)
{
    while (parent[v] != v) {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    return v;
}

void islands_join(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = islands_root(parent, a);
    b = islands_root(parent, b);
    parent[a > b ? a : b] = a > b ? b : a;
}

static const float *sorted_positions; /* qsort has no user pointer */

static int by_position(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    const int order = memcmp(sorted_positions + 3 * (size_t)x, sorted_positions + 3 * (size_t)y, 12);
    return order ? order : (x > y) - (x < y);
}

void islands_find(const model_mesh *mesh, uint32_t *island, uint32_t *work)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) island[v] = work[v] = v;
    sorted_positions = mesh->position;
    qsort(work, mesh->vertex_count, sizeof *work, by_position);
    for (uint32_t i = 1; i < mesh->vertex_count; i++) {
        const uint32_t a = work[i - 1], b = work[i];
        if (memcmp(mesh->position + 3 * (size_t)a, mesh->position + 3 * (size_t)b, 12) == 0) islands_join(island, a, b);
    }
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        islands_join(island, mesh->indices[i], mesh->indices[i + 1]);
        islands_join(island, mesh->indices[i], mesh->indices[i + 2]);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) island[v] = islands_root(island, v);
}

void islands_chain(const uint32_t *island, uint32_t count, uint32_t *next)
{
    for (uint32_t v = 0; v < count; v++) next[v] = MODEL_NONE;
    for (uint32_t v = count; v-- > 0;) { /* behind the first, before what is already there */
        if (island[v] == v) continue;
        next[v] = next[island[v]];
        next[island[v]] = v;
    }
}

uint32_t islands_list(const uint32_t *next, uint32_t first, uint32_t end, uint32_t *out)
{
    uint32_t count = 0;
    for (uint32_t v = first; v < end; v = next[v]) out[count++] = v; /* MODEL_NONE is beyond any */
    return count;
}

int islands_open(const model_mesh *mesh, mesh_islands *out)
{
    out->first = model_zeros(mesh->vertex_count, sizeof *out->first);
    out->next = model_zeros(mesh->vertex_count, sizeof *out->next);
    out->room = model_zeros(mesh->vertex_count, sizeof *out->room);
    if (!out->first || !out->next || !out->room) return 1;
    islands_find(mesh, out->first, out->room);
    islands_chain(out->first, mesh->vertex_count, out->next);
    return 0;
}

uint8_t *islands_part(const model_mesh *mesh, const model_submesh *part)
{
    uint8_t *used = model_zeros(mesh->vertex_count, 1);
    for (uint32_t i = 0; used && i < part->index_count; i++) used[mesh->indices[part->first_index + i]] = 1;
    return used;
}

void islands_close(mesh_islands *islands)
{
    free(islands->first);
    free(islands->next);
    free(islands->room);
}
