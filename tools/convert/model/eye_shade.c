#include <math.h>

#include "convert/model/model_build.h"
#include "eye_paint.h"
#include "noh/format.h"

#define HUES 0.01f  /* channels of grey differ by less */
#define SHADE 0.05f /* less is no shadow */

/* Whether the colours are greys, with shadows among them. */
static int is_shaded(const model_mesh *mesh, const model_submesh *part)
{
    float darkest = 1.0f, brightest = 0.0f;
    for (uint32_t i = 0; mesh->color && i < part->index_count; i++) {
        const float *c = mesh->color + 4 * (size_t)mesh->indices[part->first_index + i],
                    least = fminf(c[0], fminf(c[1], c[2]));
        const float most = fmaxf(c[0], fmaxf(c[1], c[2]));
        if (most - least > HUES) return 0;
        darkest = fminf(darkest, least);
        brightest = fmaxf(brightest, most);
    }
    return brightest - darkest > SHADE;
}

static void whiten(model_mesh *mesh, const model_submesh *part)
{
    for (uint32_t i = 0; i < part->index_count; i++) {
        for (size_t c = 0; c < 3; c++) mesh->color[4 * (size_t)mesh->indices[part->first_index + i] + c] = 1.0f;
    }
}

int eye_shade_clear(model *m)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        const model_material *eye = &m->materials[i];
        int shaded = 0;
        if (eye->surface != NOH_SURFACE_EYE || eye->surface_given || eye->unlit || eye->alpha == MODEL_ALPHA_BLEND ||
            eye->base_color_texture == MODEL_NONE)
            continue;
        for (uint32_t k = 0; k < m->mesh_count; k++) {
            model_mesh *mesh = &m->meshes[k];
            for (uint32_t s = 0; s < mesh->submesh_count; s++) {
                const model_submesh *part = &mesh->submeshes[s];
                if (part->material != i || !is_shaded(mesh, part)) continue;
                whiten(mesh, part);
                shaded = 1;
            }
        }
        if (shaded && model_warn(m,
                                 "material '%s': shadows in the vertex colours of eyes would turn with them, so they "
                                 "are left out (--surface '%s=eye' keeps them)",
                                 eye->name, eye->name))
            return 1;
    }
    return 0;
}
