#include "level_corners.h"

uint32_t level_count_of(const mesh_levels *of)
{
    return of && of->count > 1u ? of->count : 1u;
}

level_corners level_corners_of(const model_mesh *mesh, const mesh_levels *of, uint32_t level, uint32_t submesh)
{
    if (level) {
        const lod_view view = mesh_levels_view(of, level);
        return (level_corners){ view.indices + view.first[submesh], view.count[submesh] };
    }
    return (level_corners){ mesh->indices + mesh->submeshes[submesh].first_index,
                            mesh->submeshes[submesh].index_count };
}
