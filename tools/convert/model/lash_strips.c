#include "eye_paint.h"

#include <stdlib.h>

#include "convert/model/islands.h"
#include "convert/model/model_build.h"
#include "convert/model/surface_kind.h"

#define STRIP_TRIANGLES 16u /* a lash of its own has fewer */
#define STRIPS_MAX 16u      /* of a part: four lids with a few layers; more are modelled lashes */

/* Triangles that share vertices are one piece; lashes may touch the skin. joined: [vertex_count] */
static int is_strip(const model_mesh *mesh, const model_submesh *part, uint32_t *joined)
{
    const uint32_t *indices = mesh->indices + part->first_index;
    uint32_t pieces = 0;
    for (uint32_t i = 0; i < part->index_count; i++) joined[indices[i]] = indices[i];
    for (uint32_t i = 0; i < part->index_count; i++) {
        joined[islands_root(joined, indices[i])] = islands_root(joined, indices[i / 3u * 3u]);
    }
    for (uint32_t i = 0; i < part->index_count; i++) {
        if (joined[indices[i]] != indices[i]) continue;
        joined[indices[i]] = MODEL_NONE; /* counted */
        pieces++;
    }
    return surface_is_white(mesh, part) && pieces <= STRIPS_MAX && part->index_count / 3u >= STRIP_TRIANGLES * pieces;
}

/* 1 if all that the material is on are strips, -1 when out of memory. */
static int on_strips(const model *m, uint32_t material)
{
    uint32_t strips = 0, others = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        for (uint32_t s = 0; s < mesh->submesh_count; s++) {
            uint32_t *joined;
            if (mesh->submeshes[s].material != material) continue;
            joined = model_zeros(mesh->vertex_count, sizeof *joined);
            if (!joined) return -1;
            if (is_strip(mesh, &mesh->submeshes[s], joined)) {
                strips++;
            } else {
                others++;
            }
            free(joined);
        }
    }
    return strips > 0 && others == 0;
}

int lash_strips_hide(model *m)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        model_material *lashes = &m->materials[i];
        int hidden;
        if (lashes->surface_given || lashes->alpha != MODEL_ALPHA_OPAQUE || lashes->base_color_texture != MODEL_NONE ||
            !surface_is_lashes(lashes->name))
            continue;
        hidden = on_strips(m, i);
        if (hidden < 0) return 1;
        if (!hidden) continue;
        surface_hide(lashes);
        if (model_warn(m,
                       "material '%s': lashes without a picture would be a slab, so they are left out (--surface "
                       "'%s=plain' keeps them)",
                       lashes->name, lashes->name))
            return 1;
    }
    return 0;
}
