#include "skin_mirror.h"

#include <stdlib.h>

#include "convert/model/affine.h"
#include "convert/model/model_build.h"

/* A scale of 0 counts as positive: the sign then comes from the other axes, as in the pose once the scale grows. */
static int own_side(const model_node *node)
{
    int side = 1;
    for (int i = 0; i < 3; i++) side = node->scale[i] < 0.0f ? -side : side;
    return side;
}

/* With its parents; sides [nodes] is filled from this node up to one that is known, 0: not yet. */
static int node_side(const model *m, uint32_t node, signed char *sides)
{
    int side = 1;
    uint32_t n = node;
    for (; n != MODEL_NONE && !sides[n]; n = m->nodes[n].parent) side *= own_side(&m->nodes[n]);
    side *= n != MODEL_NONE ? sides[n] : 1;
    for (n = node; n != MODEL_NONE && !sides[n]; n = m->nodes[n].parent) {
        sides[n] = (signed char)side;
        side *= own_side(&m->nodes[n]);
    }
    return sides[node];
}

static int joint_side(const model *m, const model_skin *skin, uint32_t joint, signed char *node_sides)
{
    const int side = node_side(m, skin->joints[joint], node_sides);
    double bind[16];
    affine_of_floats(skin->inverse_bind + 16 * (size_t)joint, bind);
    return affine_determinant(bind) < 0.0 ? -side : side;
}

/* ---- all of it ---- */

static void negate(float *values, uint32_t count, uint32_t stride)
{
    for (size_t i = 0; values && i < count; i++) values[i * stride] = 0.0f - values[i * stride];
}

static void turn_over(uint32_t *triangle)
{
    const uint32_t second = triangle[1];
    triangle[1] = triangle[2];
    triangle[2] = second;
}

/* By x = 0, as seen from mesh space. */
static void mirror_mesh(model_mesh *mesh)
{
    const uint32_t count = mesh->vertex_count;
    negate(mesh->position, count, 3);
    negate(mesh->normal, count, 3);
    negate(mesh->tangent, count, 4);
    if (mesh->tangent) negate(mesh->tangent + 3, count, 4);
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        negate(mesh->targets[t].position, count, 3);
        negate(mesh->targets[t].normal, count, 3);
        negate(mesh->targets[t].tangent, count, 3);
    }
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) turn_over(mesh->indices + i);
}

static void mirror_skin(model *m, uint32_t index)
{
    model_skin *skin = &m->skins[index];
    for (uint32_t j = 0; j < skin->joint_count; j++) negate(skin->inverse_bind + 16 * (size_t)j, 3, 1);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (m->meshes[i].bound && m->meshes[i].skin == index) mirror_mesh(&m->meshes[i]);
    }
}

/* ---- a part of it ---- */

static int vertex_mirrors(const model_mesh *mesh, const signed char *sides, uint32_t vertex)
{
    const size_t first = (size_t)vertex * MODEL_INFLUENCES_MAX;
    float sum = 0.0f;
    for (size_t i = first; i < first + MODEL_INFLUENCES_MAX && mesh->joint_weights[i] > 0.0f; i++) {
        sum += mesh->joint_weights[i] * (float)sides[mesh->joints[i]];
    }
    return sum < 0.0f;
}

static int wind_mesh(model *m, model_mesh *mesh, const signed char *sides)
{
    uint32_t mirrored = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) mirrored += (uint32_t)vertex_mirrors(mesh, sides, v);
    for (uint32_t i = 0; mirrored && i + 2 < mesh->index_count; i += 3) {
        int corners = 0;
        for (uint32_t k = 0; k < 3; k++) corners += vertex_mirrors(mesh, sides, mesh->indices[i + k]);
        if (corners > 1) turn_over(mesh->indices + i);
    }
    return mirrored && mirrored < mesh->vertex_count &&
           model_warn(
               m,
               "mesh '%.40s': its joints mirror %u of its %u vertices; triangles face as most of their corners do "
               "(apply negative scales before export)",
               mesh->name, mirrored, mesh->vertex_count);
}

static int wind_meshes(model *m, uint32_t index, const signed char *sides)
{
    int failed = 0;
    for (uint32_t i = 0; !failed && i < m->mesh_count; i++) {
        if (m->meshes[i].bound && m->meshes[i].skin == index) failed = wind_mesh(m, &m->meshes[i], sides);
    }
    return failed;
}

int skins_mirror(model *m)
{
    signed char *node_sides = model_zeros(m->node_count, 1);
    int failed = !node_sides;
    for (uint32_t s = 0; !failed && s < m->skin_count; s++) {
        const model_skin *skin = &m->skins[s];
        signed char *sides = model_zeros(skin->joint_count, 1);
        uint32_t mirrored = 0;
        failed = !sides;
        for (uint32_t j = 0; j < skin->joint_count && sides; j++) {
            sides[j] = (signed char)joint_side(m, skin, j, node_sides);
            mirrored += sides[j] < 0;
        }
        if (mirrored && mirrored == skin->joint_count) {
            mirror_skin(m, s);
        } else if (mirrored) {
            failed = wind_meshes(m, s, sides);
        }
        free(sides);
    }
    free(node_sides);
    return failed;
}

/* ---- in clips ---- */

static int is_mirrored(const float scale[3])
{
    return scale[0] * scale[1] * scale[2] < 0.0f;
}

static int culls_faces(const model *m)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t k = 0; k < m->meshes[i].submesh_count; k++) {
            const uint32_t material = m->meshes[i].submeshes[k].material;
            if (material == MODEL_NONE || !m->materials[material].double_sided) return 1;
        }
    }
    return 0;
}

static int warn_of_clip(model *m, const raw_skeleton *skeleton, const raw_clip *clip)
{
    for (size_t i = 0; i < (size_t)clip->frame_count * clip->joint_count; i++) {
        const raw_joint *joint = &skeleton->joints[i % clip->joint_count];
        if (is_mirrored(clip->scales + 3 * i) == is_mirrored(joint->scale)) continue;
        return model_warn(m,
                          "clip '%.60s': it mirrors joint '%.60s' by a scale below 0, and faces that follow it are "
                          "drawn inside out (model the mirrored mesh, or make its material double-sided)",
                          clip->name, joint->name);
    }
    return 0;
}

int clips_mirror_warn(model *m, raw_set *const *sets, uint32_t set_count)
{
    int failed = 0;
    for (uint32_t s = 0; s < set_count && culls_faces(m); s++) {
        for (uint32_t c = 0; !failed && c < sets[s]->clip_count; c++) {
            failed = warn_of_clip(m, &sets[s]->skeleton, &sets[s]->clips[c]);
        }
    }
    return failed;
}
