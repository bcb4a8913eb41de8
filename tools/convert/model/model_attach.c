#include "model_attach.h"

#include <stdlib.h>
#include <string.h>

#include "affine.h"
#include "model_build.h"

static int fail_memory(model_error *error)
{
    return model_fail(error, "", "out of memory");
}

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
    *from_count = 0; /* what is in them is freed with the model that has them now */
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
        model_material *a = &other->materials[i];
        a->base_color_texture = moved(a->base_color_texture, m->texture_count);
        a->normal_texture = moved(a->normal_texture, m->texture_count);
        a->surface_texture = moved(a->surface_texture, m->texture_count);
        a->emissive_texture = moved(a->emissive_texture, m->texture_count);
        a->specular_texture = moved(a->specular_texture, m->texture_count);
        a->wrinkle_texture = moved(a->wrinkle_texture, m->texture_count);
        for (int k = 0; k < 3; k++) a->wrinkle_weights[k] = moved(a->wrinkle_weights[k], m->texture_count);
    }
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
    if (other->clip_count && model_warn(m, "%s: its clips were left out: give the file among the inputs too", path)) {
        return 1;
    }
    return (other->spring_count || other->spring_lines) &&
           model_warn(m, "%s: its springs were left out: give them by --springs", path);
}

int model_attach(model *m, model *other, const char *path, model_error *error)
{
    const uint32_t before = m->node_count;
    uint32_t *map;
    int failed;
    if (!other->mesh_count) return model_fail(error, "", "it has no meshes to attach");
    map = model_zeros(other->node_count, sizeof *map);
    if (!map || move_nodes(m, other, map)) {
        free(map);
        return fail_memory(error);
    }
    if (!shares_joint(other, map, before)) {
        free(map);
        return model_fail(error, "", "none of its joints has the name of a joint of the model that it is attached to");
    }
    renumber(m, other, map);
    free(map);
    failed = move_arrays(m, other) || tell(m, other, path);
    return failed ? fail_memory(error) : 0;
}
