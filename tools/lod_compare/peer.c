/* peer.c: the levels that Debian's meshoptimizer makes. */
#include <meshoptimizer.h>

#include "compare.h"

void peer_level_new(const model_mesh *mesh, lod_level *out)
{
    out->indices = compare_zeros(mesh->index_count, sizeof *out->indices);
    out->submesh_first = compare_zeros((size_t)mesh->submesh_count * 2u, sizeof *out->submesh_first);
    out->submesh_count = out->submesh_first + mesh->submesh_count;
}

static void simplify(const model_mesh *mesh, const lod_level *ours, lod_level *out)
{
    uint32_t at = 0;
    peer_level_new(mesh, out);
    for (uint32_t i = 0; i < mesh->submesh_count; i++) {
        const model_submesh *sub = &mesh->submeshes[i];
        size_t count = meshopt_simplify(out->indices + at, mesh->indices + sub->first_index, sub->index_count,
                                        mesh->position, mesh->vertex_count, 3u * sizeof(float), ours->submesh_count[i],
                                        1.0f, 0, NULL);
        out->submesh_first[i] = at;
        out->submesh_count[i] = (uint32_t)count;
        at += (uint32_t)count;
    }
    out->index_count = at;
}

lod *peer_levels(const model_mesh *mesh, const lod *ours)
{
    lod *peer = compare_zeros(1, sizeof *peer);
    peer->submesh_count = ours->submesh_count;
    peer->level_count = ours->level_count;
    for (uint32_t i = 0; i < ours->level_count; i++) {
        simplify(mesh, &ours->levels[i], &peer->levels[i]);
    }
    return peer;
}
