/* lod_cut.c: levels from a list of collapses. */
#include "lod_internal.h"

#include <stdlib.h>
#include <string.h>

#include "convert/model/islands.h"

int lod_level_alloc(lod_level *level, uint32_t submesh_count)
{
    level->indices = calloc((size_t)level->index_count + 1u, sizeof *level->indices);
    level->submesh_first = calloc((size_t)submesh_count * 2u + 1u, sizeof *level->submesh_first);
    level->submesh_count = level->submesh_first ? level->submesh_first + submesh_count : NULL;
    return !level->indices || !level->submesh_first;
}

static int cut(const model_mesh *mesh, const lod *l, uint32_t collapses, uint32_t *to, uint8_t *used, lod_level *out)
{
    uint32_t at = 0;
    for (uint32_t t = 0; t < mesh->index_count / 3u; t++) {
        out->index_count += l->gone[t] > collapses ? 3u : 0u;
    }
    if (lod_level_alloc(out, l->submesh_count)) {
        return 1;
    }
    memset(used, 0, mesh->vertex_count);
    for (uint32_t i = 0; i < l->submesh_count; i++) {
        const model_submesh *sub = &mesh->submeshes[i];
        out->submesh_first[i] = at;
        for (uint32_t c = sub->first_index; c < sub->first_index + sub->index_count; c++) {
            if (l->gone[c / 3u] > collapses) {
                out->indices[at] = islands_root(to, mesh->indices[c]); /* what removed vertices became */
                out->vertex_count += !used[out->indices[at]];
                used[out->indices[at++]] = 1;
            }
        }
        out->submesh_count[i] = at - out->submesh_first[i];
    }
    out->collapse_count = collapses;
    out->cost = collapses ? l->collapses[collapses - 1u].cost : 0.0f;
    return 0;
}

int lod_cut(const model_mesh *mesh, lod *l, const uint32_t *collapse_counts, uint32_t level_count)
{
    uint32_t *to = calloc((size_t)mesh->vertex_count + 1u, sizeof *to), done = 0;
    uint8_t *used = calloc((size_t)mesh->vertex_count + 1u, 1);
    int failed = !to || !used;
    for (uint32_t i = 0; i < LOD_LEVELS_MAX; i++) {
        free(l->levels[i].indices);
        free(l->levels[i].submesh_first);
    }
    memset(l->levels, 0, sizeof l->levels);
    l->level_count = 0;
    for (uint32_t v = 0; !failed && v < mesh->vertex_count; v++) {
        to[v] = v;
    }
    for (uint32_t k = 0; k < level_count && !failed; k++) {
        for (; done < collapse_counts[k]; done++) {
            to[l->collapses[done].from] = l->collapses[done].to;
        }
        failed = cut(mesh, l, done, to, used, &l->levels[k]);
        l->level_count += !failed;
    }
    free(to);
    free(used);
    return failed;
}
