#include "skins.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "convert/clips/model_clips.h"
#include "mesh_join.h"
#include "convert/model/affine.h"
#include "convert/model/model_build.h"
#include "skin_mirror.h"
#include "skin_rigid.h"

static int bind_skeletons(model *m, model_clips *made)
{
    for (uint32_t s = 0; s < m->skin_count; s++) {
        model_skin *skin = &m->skins[s];
        skin->set = made->skins[s].set;
        free(skin->skeleton_joints); /* of an earlier binding */
        skin->skeleton_joints = model_zeros(skin->joint_count, sizeof *skin->skeleton_joints);
        if (!skin->skeleton_joints) {
            return 1;
        }
        memcpy(skin->skeleton_joints, made->skins[s].joints, skin->joint_count * sizeof *skin->skeleton_joints);
    }
    return 0;
}

/* Give a node a copy of its mesh, bound to the node's own skin or to none. */
static int copy_for(model *m, model_node *node)
{
    model_mesh *grown = realloc(m->meshes, ((size_t)m->mesh_count + 1) * sizeof *grown);
    if (!grown) {
        return 1;
    }
    m->meshes = grown;
    if (mesh_copy(&grown[node->mesh], &grown[m->mesh_count])) {
        m->mesh_count += 1; /* freed with the model */
        return 1;
    }
    node->mesh = m->mesh_count++;
    m->meshes[node->mesh].bound = node->skin != MODEL_NONE;
    m->meshes[node->mesh].skin = node->skin != MODEL_NONE ? node->skin : 0;
    return 0;
}

static int is_bound_like(const model_mesh *mesh, const model_node *node)
{
    return mesh->bound ? mesh->skin == node->skin : node->skin == MODEL_NONE;
}

/* In a pack a mesh has one skin or none: a mesh that a file draws with several is copied. */
static int bind_meshes(model *m)
{
    uint32_t *copied_from = model_zeros((size_t)m->mesh_count + m->node_count, sizeof *copied_from),
             asset_meshes = m->mesh_count;
    uint8_t *seen = model_zeros(m->mesh_count, 1);
    int failed = !copied_from || !seen;
    for (uint32_t n = 0; !failed && n < m->node_count; n++) {
        model_node *node = &m->nodes[n];
        uint32_t mesh = node->mesh, copy = asset_meshes;
        if (mesh == MODEL_NONE) {
            continue;
        }
        if (!seen[mesh]) {
            seen[mesh] = 1;
            m->meshes[mesh].bound = node->skin != MODEL_NONE;
            m->meshes[mesh].skin = node->skin != MODEL_NONE ? node->skin : 0;
        } else if (!is_bound_like(&m->meshes[mesh], node)) {
            while (copy < m->mesh_count && (copied_from[copy] != mesh || !is_bound_like(&m->meshes[copy], node))) {
                copy++;
            }
            node->mesh = copy < m->mesh_count ? copy : mesh;
            if (copy == m->mesh_count) {
                copied_from[copy] = mesh;
                failed = copy_for(m, node);
            }
        }
    }
    free(copied_from);
    free(seen);
    return failed;
}

/* ---- fewer joints per vertex ---- */

/* Keep the strongest influences of a vertex. Returns the weight that is left out. */
static double keep_strongest(float *weights, uint16_t *joints, uint32_t limit)
{
    double kept = 0.0, lost = 0.0;
    for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX; i++) {
        *(i < limit ? &kept : &lost) += (double)weights[i];
    }
    for (uint32_t i = 0; lost > 0.0 && i < MODEL_INFLUENCES_MAX; i++) {
        weights[i] = i < limit ? (float)((double)weights[i] / kept) : 0.0f;
        joints[i] = i < limit ? joints[i] : 0;
    }
    return lost;
}

static int limit_influences(model *m, model_mesh *mesh, uint32_t limit)
{
    uint32_t changed = 0;
    double most = 0.0;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        double lost = keep_strongest(mesh->joint_weights + v * MODEL_INFLUENCES_MAX,
                                     mesh->joints + v * MODEL_INFLUENCES_MAX, limit);
        changed += lost > 0.0;
        most = lost > most ? lost : most;
    }
    mesh->influence_max = mesh->influence_max > limit ? limit : mesh->influence_max;
    return changed
               ? model_warn(
                     m,
                     "mesh '%.40s': %u vertices have more than %u joints; the strongest were kept, up to %.2g of the "
                     "weight was dropped (--influences keeps more)",
                     mesh->name, changed, limit, most)
               : 0;
}

/* ---- sizes at rest ---- */

#define SMALLER 20.0
#define HIDDEN 1e6 /* times smaller: on purpose */

/* How many times larger a joint shows what follows it than it was bound. */
static double joint_size(const model *m, const model_skin *skin, uint32_t joint)
{
    double bind[16];
    affine_of_floats(skin->inverse_bind + 16 * (size_t)joint, bind);
    return cbrt(fabs(affine_determinant(m->nodes[skin->joints[joint]].world) * affine_determinant(bind)));
}

/* Joints that vertices follow. */
static void mark_followed(const model *m, uint32_t skin, uint8_t *followed)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        if (!mesh->bound || mesh->skin != skin) continue;
        for (size_t k = 0; k < (size_t)mesh->vertex_count * MODEL_INFLUENCES_MAX; k++) {
            if (mesh->joint_weights[k] > 0.0f) followed[mesh->joints[k]] = 1;
        }
    }
}

static int warn_of_sizes(model *m, uint32_t index)
{
    const model_skin *skin = &m->skins[index];
    uint8_t *followed = model_zeros(skin->joint_count, 1);
    double largest = 0.0, first_size = 0.0;
    uint32_t small = 0, first = 0;
    if (!followed) return 1;
    mark_followed(m, index, followed);
    for (uint32_t j = 0; j < skin->joint_count; j++) {
        if (followed[j]) largest = fmax(largest, joint_size(m, skin, j));
    }
    for (uint32_t j = 0; j < skin->joint_count; j++) {
        const double size = joint_size(m, skin, j);
        if (!followed[j] || !(size > 0.0) || size * SMALLER > largest || size * HIDDEN < largest || small++) continue;
        first = j;
        first_size = size;
    }
    free(followed);
    return small && model_warn(m,
                               "skin '%.40s': at rest joint '%.40s' and %u more show what follows them %.3g times "
                               "smaller than it was bound, so it is hardly seen (export the skeleton in its bind pose)",
                               skin->name, m->nodes[skin->joints[first]].name, small - 1u, largest / first_size);
}

static int warn_of_skins(model *m)
{
    int failed = 0;
    for (uint32_t s = 0; s < m->skin_count && !failed; s++) failed = warn_of_sizes(m, s);
    return failed;
}

/* ---- dual quaternions ---- */

static int mark_dual_quaternion(model *m, const char *name, model_error *error)
{
    int found = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (m->meshes[i].bound && (strcmp(name, "all") == 0 || strcmp(name, m->meshes[i].name) == 0)) {
            m->meshes[i].dual_quaternion = 1;
            found = 1;
        }
    }
    if (found) return 0;
    return strcmp(name, "all") == 0
               ? model_fail(error, "", "--dual-quaternion all: no mesh is skinned")
               : model_fail(error, "", "--dual-quaternion: no skinned mesh is named '%.80s'", name);
}

int skins_bind(model *m, model_clips *made, const skin_options *options, model_error *error)
{
    const uint32_t limit = options->influences ? options->influences : NOH_INFLUENCES_MAX;
    if (bind_skeletons(m, made) || bind_meshes(m) || skin_rigid_meshes(m, made, options->keep_parts, options->report) ||
        skins_mirror(m) || warn_of_skins(m)) {
        return model_fail_memory(error);
    }
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        m->meshes[i].palette_limit = options->palette;
        if (m->meshes[i].bound && limit_influences(m, &m->meshes[i], limit)) {
            return model_fail_memory(error);
        }
    }
    for (uint32_t i = 0; i < options->dual_quaternion_count; i++) {
        if (mark_dual_quaternion(m, options->dual_quaternion[i], error)) {
            return 1;
        }
    }
    return 0;
}
