#include "model_attach.h"

#include <stdlib.h>
#include <string.h>

#include <math.h>

#include "affine.h"
#include "life/reach/gaze_internal.h"
#include "model_build.h"

/* ---- nodes ---- */

static const char *plain_name(const char *name)
{
    const char *colon = name ? strrchr(name, ':') : NULL;
    return colon ? colon + 1 : name;
}

static uint32_t find_node(const model *m, uint32_t count, const model_node *node)
{
    const char *name = plain_name(node->name);
    for (uint32_t n = 0; name && *name && node->mesh == MODEL_NONE && n < count; n++) {
        const char *own = plain_name(m->nodes[n].name);
        if (m->nodes[n].mesh == MODEL_NONE && own && strcmp(own, name) == 0) return n;
    }
    return MODEL_NONE;
}

/* Where its parent is in the model now, it may not be where it was. */
static void place_node(const model *m, model_node *node)
{
    double local[16];
    affine_of_node(node, local);
    if (node->parent == MODEL_NONE) {
        memcpy(node->world, local, sizeof local);
    } else {
        affine_multiply(m->nodes[node->parent].world, local, node->world);
    }
}

/* map [other's nodes]: the node of `m` that each is now. */
static int move_nodes(model *m, model *other, uint32_t *map)
{
    const uint32_t before = m->node_count;
    model_node *grown = realloc(m->nodes, ((size_t)before + other->node_count + 1u) * sizeof *grown);
    if (!grown) return 1;
    m->nodes = grown;
    for (uint32_t n = 0; n < other->node_count; n++) {
        model_node *node = &other->nodes[n];
        map[n] = find_node(m, before, node);
        if (map[n] != MODEL_NONE) continue;
        map[n] = m->node_count;
        if (node->parent != MODEL_NONE) node->parent = map[node->parent];
        if (node->mesh != MODEL_NONE) node->mesh += m->mesh_count;
        if (node->skin != MODEL_NONE) node->skin += m->skin_count;
        place_node(m, node);
        m->nodes[m->node_count++] = *node;
        memset(node, 0, sizeof *node); /* its name and weights have moved */
    }
    return 0;
}

/* ---- skins, meshes, materials, textures ---- */

/* An array with another one behind it; NULL: out of memory, and nothing has changed. */
static void *joined(void *to, uint32_t *to_count, const void *from, uint32_t *from_count, size_t bytes)
{
    uint8_t *grown = realloc(to, ((size_t)*to_count + *from_count + 1u) * bytes);
    if (!grown) return NULL;
    if (*from_count) memcpy(grown + *to_count * bytes, from, *from_count * bytes);
    *to_count += *from_count;
    *from_count = 0; /* their contents are freed with their new model */
    return grown;
}

static int move_arrays(model *m, model *other)
{
    void *skins = joined(m->skins, &m->skin_count, other->skins, &other->skin_count, sizeof *m->skins);
    void *meshes = joined(m->meshes, &m->mesh_count, other->meshes, &other->mesh_count, sizeof *m->meshes);
    void *materials = joined(m->materials, &m->material_count, other->materials, &other->material_count,
                             sizeof *m->materials);
    void *textures = joined(m->textures, &m->texture_count, other->textures, &other->texture_count,
                            sizeof *m->textures);
    if (skins) m->skins = skins;
    if (meshes) m->meshes = meshes;
    if (materials) m->materials = materials;
    if (textures) m->textures = textures;
    return !skins || !meshes || !materials || !textures;
}

static uint32_t moved(uint32_t index, uint32_t by)
{
    return index == MODEL_NONE ? MODEL_NONE : index + by;
}

static void renumber(const model *m, model *other, const uint32_t *map)
{
    for (uint32_t s = 0; s < other->skin_count; s++) {
        for (uint32_t j = 0; j < other->skins[s].joint_count; j++) {
            other->skins[s].joints[j] = map[other->skins[s].joints[j]];
        }
    }
    for (uint32_t i = 0; i < other->mesh_count; i++) {
        for (uint32_t k = 0; k < other->meshes[i].submesh_count; k++) {
            model_submesh *part = &other->meshes[i].submeshes[k];
            part->material = moved(part->material, m->material_count);
        }
    }
    for (uint32_t i = 0; i < other->material_count; i++) {
        uint32_t *maps[MODEL_MAPS];
        model_maps(&other->materials[i], maps);
        for (uint32_t k = 0; k < MODEL_MAPS; k++) *maps[k] = moved(*maps[k], m->texture_count);
    }
}

/* ---- on a joint ---- */

static int is_joint(const model *m, uint32_t node)
{
    for (uint32_t s = 0; s < m->skin_count; s++) {
        for (uint32_t j = 0; j < m->skins[s].joint_count; j++) {
            if (m->skins[s].joints[j] == node) return 1;
        }
    }
    return 0;
}

/* Of the first `count` nodes, the joint of that name, or, name NULL, the head. */
static uint32_t find_joint(const model *m, uint32_t count, const char *name)
{
    for (uint32_t n = 0; n < count; n++) {
        const char *own = plain_name(m->nodes[n].name);
        if (!own || !is_joint(m, n)) continue;
        if (name ? strcmp(own, plain_name(name)) == 0 || strcmp(m->nodes[n].name, name) == 0 : noh_name_is_head(own))
            return n;
    }
    return MODEL_NONE;
}

/* Whether a mesh that no skin moves lies on a node or below it. */
static int has_rigid_mesh(const model *m, uint32_t root)
{
    for (uint32_t n = root; n < m->node_count; n++) {
        uint32_t at = n;
        if (m->nodes[n].mesh == MODEL_NONE || m->nodes[n].skin != MODEL_NONE) continue;
        while (at != root && at != MODEL_NONE) at = m->nodes[at].parent;
        if (at == root) return 1;
    }
    return 0;
}

/* The rotation of three columns at right angles, of length 1 each. */
static void rotation_of(double r[3][3], float out[4])
{
    double q[4], length = 0.0;
    if (r[0][0] + r[1][1] + r[2][2] > 0.0) {
        q[3] = 1.0 + r[0][0] + r[1][1] + r[2][2];
        q[0] = r[1][2] - r[2][1], q[1] = r[2][0] - r[0][2], q[2] = r[0][1] - r[1][0];
    } else {
        const int i = r[0][0] > r[1][1] && r[0][0] > r[2][2] ? 0 : r[1][1] > r[2][2] ? 1 : 2;
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        q[i] = 1.0 + r[i][i] - r[j][j] - r[k][k];
        q[j] = r[i][j] + r[j][i], q[k] = r[i][k] + r[k][i], q[3] = r[j][k] - r[k][j];
    }
    for (int i = 0; i < 4; i++) length += q[i] * q[i];
    for (int i = 0; i < 4; i++) out[i] = (float)(q[i] / sqrt(length));
}

/* Below a joint, where it stands in the world. returns 1 where the joint's place has no inverse */
static int hang_on(model *m, uint32_t node, uint32_t joint)
{
    model_node *n = &m->nodes[node];
    double back[16], local[16], columns[3][3];
    if (affine_invert(m->nodes[joint].world, back)) return 1;
    affine_multiply(back, n->world, local);
    for (int c = 0; c < 3; c++) {
        const double *from = local + 4 * c;
        double length = sqrt(from[0] * from[0] + from[1] * from[1] + from[2] * from[2]);
        if (c == 2 && affine_determinant(local) < 0.0) length = -length;
        for (int i = 0; i < 3; i++) columns[c][i] = length != 0.0 ? from[i] / length : (double)(i == c);
        n->scale[c] = (float)length;
        n->translation[c] = (float)local[12 + c];
    }
    rotation_of(columns, n->rotation);
    n->parent = joint;
    return 0;
}

/* Attach the topmost added nodes that no joint moves. joint_name NULL: the head's, and only of a model that
 * is not skinned. returns 1 on error */
static int hang_all(model *m, uint32_t before, int is_skinned, const char *joint_name, const char *path,
                    model_error *error)
{
    const uint32_t joint = find_joint(m, before, joint_name);
    if (joint_name && joint == MODEL_NONE) {
        return model_fail(error, "", "the model has no joint '%s' to attach it to: name another with --attach-joint",
                          joint_name);
    }
    for (uint32_t n = before; n < m->node_count; n++) {
        if (m->nodes[n].parent != MODEL_NONE || !has_rigid_mesh(m, n) || (is_skinned && !joint_name)) continue;
        if (joint == MODEL_NONE || hang_on(m, n, joint)) {
            return model_warn(
                       m,
                       "%s: no joint moves it, as none of the model's joints has 'head' in its name: name one with "
                       "--attach-joint",
                       path) &&
                   model_fail_memory(error);
        }
    }
    return 0;
}

/* ---- all ---- */

static int shares_joint(const model *other, const uint32_t *map, uint32_t before)
{
    for (uint32_t s = 0; s < other->skin_count; s++) {
        for (uint32_t j = 0; j < other->skins[s].joint_count; j++) {
            if (map[other->skins[s].joints[j]] < before) return 1;
        }
    }
    return !other->skin_count;
}

static int tell(model *m, const model *other, const char *path)
{
    for (uint32_t i = 0; i < other->warning_count; i++) {
        if (model_warn(m, "%s: %s", path, other->warnings[i])) return 1;
    }
    if (other->clip_count && model_warn(m, "%s: its clips were left out: give the file as an input, too", path)) {
        return 1;
    }
    return (other->spring_count || other->spring_lines) &&
           model_warn(m, "%s: its springs were left out: give them with --springs", path);
}

int model_attach(model *m, model *other, const char *joint, const char *path, model_error *error)
{
    const uint32_t before = m->node_count;
    const int is_skinned = other->skin_count != 0;
    uint32_t *map;
    int failed;
    if (!other->mesh_count) return model_fail(error, "", "it has no meshes to attach");
    map = model_zeros(other->node_count, sizeof *map);
    if (!map || move_nodes(m, other, map)) {
        free(map);
        return model_fail_memory(error);
    }
    if (!shares_joint(other, map, before)) {
        free(map);
        return model_fail(error, "", "none of its joints has the name of a joint of the model to attach it to");
    }
    renumber(m, other, map);
    free(map);
    if (hang_all(m, before, is_skinned, joint, path, error)) return 1;
    failed = move_arrays(m, other) || tell(m, other, path);
    return failed ? model_fail_memory(error) : 0;
}
