/* pack_limits.c: refuses models that exceed the format's limits, and names the limit. */
#include <stdio.h>

#include "noh/base.h"
#include "pack_write.h"

#define DIVIDE "simplify the mesh, or divide it into several"

static int over(uint64_t count, uint64_t limit, const char *what, const char *kind, const char *name,
                const char *advice, model_error *error)
{
    if (count <= limit) {
        return 0;
    }
    snprintf(error->what, sizeof error->what, "%llu %s: a pack holds up to %llu: %s", (unsigned long long)count, what,
             (unsigned long long)limit, advice);
    error->where[0] = 0;
    if (name) {
        snprintf(error->where, sizeof error->where, "%s '%.80s'", kind, name);
    }
    return 1;
}

static int check_mesh(const model_mesh *m, model_error *error)
{
    return over(m->vertex_count, NOH_VERTICES_MAX, "vertices", "mesh", m->name, DIVIDE, error) ||
           over(m->index_count, NOH_INDICES_MAX, "indices", "mesh", m->name, DIVIDE, error) ||
           over(m->submesh_count, NOH_SUBMESHES_MAX, "primitives", "mesh", m->name, "join parts and materials",
                error) ||
           over(m->target_count, NOH_TARGETS_MAX, "morph targets", "mesh", m->name, "remove some", error);
}

int pack_check_model(const model *m, model_error *error)
{
    uint64_t chunks = (uint64_t)m->mesh_count + m->texture_count + m->skin_count + 3;
    if (over(m->material_count, NOH_MATERIALS_MAX, "materials", NULL, NULL, "join some", error) ||
        over(m->node_count, NOH_NODES_MAX, "nodes", NULL, NULL,
             "join meshes, remove empty nodes, or build several packs", error) ||
        over(chunks, NOH_PACK_CHUNKS_MAX, "meshes, skins and textures", NULL, NULL,
             "join meshes, or build several packs", error)) {
        return 1;
    }
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (check_mesh(&m->meshes[i], error)) {
            return 1;
        }
    }
    for (uint32_t i = 0; i < m->skin_count; i++) {
        if (over(m->skins[i].joint_count, NOH_SKIN_JOINTS_MAX, "joints", "skin", m->skins[i].name, "remove some",
                 error)) {
            return 1;
        }
    }
    return 0;
}

int pack_check_encoding(const model_mesh *m, const morph_encoding *e, model_error *error)
{
    uint64_t touched_max = (uint64_t)NOH_MORPH_HEIGHT_MAX << e->width_log2;
    return over(e->touched_count, touched_max, "vertices that targets move", "mesh", m->name, DIVIDE, error) ||
           over(e->texel_count, NOH_DELTA_TEXELS_MAX, "delta texels", "mesh", m->name, DIVIDE, error);
}
