#include "joint_radius.h"

#include <math.h>

static float distance(const float *inverse_bind, const float *position)
{
    double square = 0.0;
    for (int r = 0; r < 3; r++) {
        double at = (double)inverse_bind[12 + r];
        for (int c = 0; c < 3; c++) {
            at += (double)inverse_bind[4 * c + r] * (double)position[c];
        }
        square += at * at;
    }
    return (float)sqrt(square);
}

static void add_mesh(const model_mesh *mesh, const model_skin *skin, float *out)
{
    for (size_t i = 0; i < (size_t)mesh->vertex_count * MODEL_INFLUENCES_MAX; i++) {
        if (mesh->joint_weights[i] >= MOVED_WEIGHT_LEAST) {
            const uint32_t place = mesh->joints[i];
            float *radius = &out[skin->skeleton_joints[place]];
            *radius = fmaxf(*radius, distance(skin->inverse_bind + 16 * (size_t)place,
                                              mesh->position + i / MODEL_INFLUENCES_MAX * 3));
        }
    }
}

int joint_radius(const model *m, uint32_t set, uint32_t joint_count, float *out)
{
    int found = 0;
    for (uint32_t j = 0; j < joint_count; j++) {
        out[j] = -1.0f;
    }
    for (uint32_t i = 0; m && joint_count && i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        if (mesh->bound && mesh->joints && m->skins[mesh->skin].skeleton_joints && m->skins[mesh->skin].set == set) {
            add_mesh(mesh, &m->skins[mesh->skin], out);
            found = 1;
        }
    }
    return found;
}
