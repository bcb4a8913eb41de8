/* face_skin.c: joints for faces that have none. */
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "noh/base.h"
#include "skins.h"

static int is_drawn_once(const model *m, uint32_t mesh)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < m->node_count; n++) count += m->nodes[n].mesh == mesh;
    return count == 1u;
}

static int move_by(model_mesh *mesh, uint32_t place)
{
    const size_t width = MODEL_INFLUENCES_MAX;
    mesh->joints = model_zeros(mesh->vertex_count * width, sizeof *mesh->joints);
    mesh->joint_weights = model_zeros(mesh->vertex_count * width, sizeof *mesh->joint_weights);
    if (!mesh->joints || !mesh->joint_weights) return 1;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        mesh->joints[v * width] = (uint16_t)place;
        mesh->joint_weights[v * width] = 1.0f;
    }
    mesh->influence_max = 1;
    mesh->joint_limit = place + 1u;
    return 0;
}

/* A joint lies where its node does, so that mesh space is the joint's. */
static int add_joint(model *m, uint32_t node, model_skin *skin)
{
    float *matrix = skin->inverse_bind + 16u * (size_t)skin->joint_count;
    for (uint32_t i = 0; i < 4u; i++) matrix[5u * i] = 1.0f;
    if (move_by(&m->meshes[m->nodes[node].mesh], skin->joint_count)) return 1;
    skin->joints[skin->joint_count++] = node;
    m->nodes[node].skin = 0;
    return 0;
}

int skins_of_faces(model *m)
{
    model_skin *skin;
    int failed;
    if (m->skin_count) return 0;
    skin = model_zeros(1, sizeof *skin);
    if (!skin) return 1;
    free(m->skins);
    m->skins = skin;
    skin->name = model_zeros(1, 6);
    skin->joints = model_zeros(m->node_count, sizeof *skin->joints);
    skin->inverse_bind = model_zeros(m->node_count, 16u * sizeof *skin->inverse_bind);
    failed = !skin->name || !skin->joints || !skin->inverse_bind;
    m->skin_count = 1;
    if (failed) return 1;
    memcpy(skin->name, "faces", 6);
    for (uint32_t n = 0; n < m->node_count && !failed; n++) {
        const uint32_t mesh = m->nodes[n].mesh;
        if (mesh == MODEL_NONE || !m->meshes[mesh].target_count || !is_drawn_once(m, mesh)) continue;
        failed = skin->joint_count < NOH_SKIN_JOINTS_MAX && add_joint(m, n, skin);
    }
    if (!skin->joint_count) {
        free(skin->name);
        free(skin->joints);
        free(skin->inverse_bind);
        memset(skin, 0, sizeof *skin);
        m->skin_count = 0;
    }
    return failed;
}
