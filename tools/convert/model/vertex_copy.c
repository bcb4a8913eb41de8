#include "vertex_copy.h"

#include <stdlib.h>
#include <string.h>

/* Grow one array, if it is there; only its address changes until all have grown. */
static int grow(void *array, size_t row, const model_mesh *mesh, const uint32_t *sources, uint32_t count)
{
    const size_t before = mesh->vertex_count;
    uint8_t *old, *grown;
    memcpy(&old, array, sizeof old);
    if (!old) return 0;
    grown = realloc(old, (before + count) * row);
    if (!grown) return 1;
    for (size_t i = 0; i < count; i++) {
        memcpy(grown + (before + i) * row, grown + sources[i] * row, row);
    }
    memcpy(array, &grown, sizeof grown);
    return 0;
}

int model_copy_vertices(model_mesh *mesh, const uint32_t *sources, uint32_t count)
{
    const size_t influences = MODEL_INFLUENCES_MAX;
    int failed = grow(&mesh->position, 12u, mesh, sources, count) || grow(&mesh->normal, 12u, mesh, sources, count) ||
                 grow(&mesh->tangent, 16u, mesh, sources, count) || grow(&mesh->uv, 8u, mesh, sources, count) ||
                 grow(&mesh->color, 16u, mesh, sources, count) ||
                 grow(&mesh->extra, 16u * NOH_EXTRAS_MAX, mesh, sources, count) ||
                 grow(&mesh->joints, influences * sizeof *mesh->joints, mesh, sources, count) ||
                 grow(&mesh->joint_weights, influences * sizeof *mesh->joint_weights, mesh, sources, count);
    for (uint32_t t = 0; t < mesh->target_count && !failed; t++) {
        model_target *target = &mesh->targets[t];
        failed = grow(&target->position, 12u, mesh, sources, count) ||
                 grow(&target->normal, 12u, mesh, sources, count) ||
                 grow(&target->tangent, 12u, mesh, sources, count) || grow(&target->uv, 8u, mesh, sources, count);
    }
    if (failed) return 1;
    mesh->vertex_count += count;
    return 0;
}
