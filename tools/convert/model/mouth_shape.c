#include "mouth_shape.h"

#include <math.h>

#include "convert/model/lip_rim.h"
#include "noh/format.h"

#define LIPS_APART 0.24f /* half their gap, in depths of the mouth, where no target opens them */
#define MOUTH_DEPTH 0.6f /* share of the teeth's depth beyond which they are dark */

/* The bounds of the teeth. */
static int mouth_bounds(const model *m, float low[3], float high[3])
{
    int found = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t s = 0; s < m->meshes[i].submesh_count; s++) {
            const model_submesh *part = &m->meshes[i].submeshes[s];
            if (part->material == MODEL_NONE || m->materials[part->material].surface != NOH_SURFACE_TEETH) continue;
            for (uint32_t v = 0; v < part->index_count; v++, found = 1) {
                const float *p = m->meshes[i].position + 3 * (size_t)m->meshes[i].indices[part->first_index + v];
                for (int c = 0; c < 3; c++) {
                    low[c] = !found || p[c] < low[c] ? p[c] : low[c];
                    high[c] = !found || p[c] > high[c] ? p[c] : high[c];
                }
            }
        }
    }
    return found && high[0] > low[0] && high[1] > low[1] && high[2] > low[2];
}

/* The most that a target of a mesh opens the lips. */
static float opens_by(const model_mesh *mesh)
{
    float most = 0.0f;
    for (uint32_t t = 0; t < mesh->target_count; t++) most = fmaxf(most, mesh->targets[t].lips);
    return most;
}

static int is_of_opening(const model *m, uint32_t material, float least)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t s = 0; s < m->meshes[i].submesh_count; s++) {
            if (m->meshes[i].submeshes[s].material == material && opens_by(&m->meshes[i]) >= least) return 1;
        }
    }
    return 0;
}

/* The light of a mesh follows its own targets: a mesh that has none that open the lips is lit as if they were apart. */
static int part_others(model *m)
{
    float least = 1e-6f;
    for (uint32_t i = 0; i < m->mesh_count; i++) least = fmaxf(least, 0.5f * opens_by(&m->meshes[i]));
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        model_mesh *mesh = &m->meshes[i];
        for (uint32_t s = 0; s < mesh->submesh_count && opens_by(mesh) < least; s++) {
            uint32_t own = mesh->submeshes[s].material;
            const uint32_t surface = own == MODEL_NONE ? NOH_SURFACE_PLAIN : m->materials[own].surface;
            if (surface != NOH_SURFACE_TEETH && surface != NOH_SURFACE_SKIN) continue;
            if (is_of_opening(m, own, least)) {
                if (surface == NOH_SURFACE_SKIN) continue; /* as of a body: outside of the mouth it has no use */
                if (model_own_material(m, mesh, &own)) return 1;
            }
            m->materials[own].surface_more[3] = LIPS_APART;
        }
    }
    return 0;
}

int mouth_shape_find(model *m)
{
    float low[3], high[3], gap = LIPS_APART;
    if (!mouth_bounds(m, low, high)) return 0;
    const float slope = 1.0f / (MOUTH_DEPTH * (high[2] - low[2]));
    if (lip_gaps_find(m, slope, &gap)) return 1;
    for (uint32_t i = 0; i < m->material_count; i++) {
        float *values = m->materials[i].surface_values, *more = m->materials[i].surface_more;
        if (m->materials[i].surface == NOH_SURFACE_TEETH) {
            values[2] = slope;
            values[3] = 1.0f - high[2] * slope;
            more[0] = 1.0f;
            more[3] = gap;
        } else if (m->materials[i].surface == NOH_SURFACE_SKIN) {
            for (int c = 0; c < 2; c++) {
                values[1 + c] = 0.5f * (low[c] + high[c]);
                more[c] = 0.5f * (high[c] - low[c]);
            }
            values[3] = high[2];
            more[2] = slope;
            more[3] = gap;
        }
    }
    return part_others(m);
}
