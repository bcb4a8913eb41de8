#include "texture_cut.h"

#define CUTOFF_LEAST 0.25f
#define CUTOFF_MOST 0.75f

int texture_cut_vertices(const model *m, uint32_t material)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        for (uint32_t s = 0; s < mesh->submesh_count && mesh->color; s++) {
            const model_submesh *part = &mesh->submeshes[s];
            for (uint32_t k = 0; part->material == material && k < part->index_count; k++) {
                if (mesh->color[4u * (size_t)mesh->indices[part->first_index + k] + 3u] < 1.0f) return 1;
            }
        }
    }
    return 0;
}

static int cuts(const model *m, uint32_t material, const model_texture *t)
{
    const model_material *of = &m->materials[material];
    return of->alpha == MODEL_ALPHA_MASK && of->alpha_cutoff >= t->alpha_cutoff &&
           of->alpha_cutoff <= t->alpha_cutoff && of->base_color[3] >= 1.0f && !texture_cut_vertices(m, material);
}

void texture_cut_mark(model *m)
{
    for (uint32_t i = 0; i < m->texture_count; i++) {
        model_texture *t = &m->textures[i];
        t->cut_alone = t->use == MODEL_TEXTURE_COLOR && t->with_alpha && t->alpha_cutoff >= CUTOFF_LEAST &&
                       t->alpha_cutoff <= CUTOFF_MOST;
    }
    for (uint32_t i = 0; i < m->material_count; i++) {
        const uint32_t base = m->materials[i].base_color_texture, emissive = m->materials[i].emissive_texture;
        if (emissive != MODEL_NONE) m->textures[emissive].cut_alone = 0;
        if (base != MODEL_NONE && !cuts(m, i, &m->textures[base])) m->textures[base].cut_alone = 0;
    }
}
