/* model.c: making, warning about, and freeing a model. */
#include <math.h>
#include "affine.h"
#include "model_build.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

model *model_new(void)
{
    return model_zeros(1, sizeof(model));
}

/* The array grows to powers of two, so its capacity need not be stored. */
static int warnings_grow(model *m)
{
    uint32_t count = m->warning_count;
    if (count != 0 && (count & (count - 1)) != 0) return 0;
    size_t capacity = count ? (size_t)count * 2 : 1;
    char **grown = realloc(m->warnings, capacity * sizeof *grown);
    if (!grown) return 1;
    m->warnings = grown;
    return 0;
}

int model_warn(model *m, const char *format, ...)
{
    if (m->warning_count > MODEL_WARNINGS_MAX) return 0;
    char text[512];
    if (m->warning_count == MODEL_WARNINGS_MAX) {
        (void)snprintf(text, sizeof text, "further warnings are not shown");
    } else {
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
    }
    char *copy = model_string(text);
    if (!copy || warnings_grow(m)) {
        free(copy);
        return 1;
    }
    m->warnings[m->warning_count++] = copy;
    return 0;
}

model_material model_material_default(void)
{
    const model_material plain = { .base_color = { 1.0f, 1.0f, 1.0f, 1.0f },
                                   .base_color_texture = MODEL_NONE,
                                   .metallic = 1.0f,
                                   .roughness = 1.0f,
                                   .alpha_cutoff = 0.5f,
                                   .normal_scale = 1.0f,
                                   .occlusion_strength = 1.0f,
                                   .f0 = { 0.04f, 0.04f, 0.04f },
                                   .normal_texture = MODEL_NONE,
                                   .surface_texture = MODEL_NONE,
                                   .emissive_texture = MODEL_NONE,
                                   .specular_texture = MODEL_NONE,
                                   .wrinkle_texture = MODEL_NONE,
                                   .color_texture = MODEL_NONE,
                                   .more_textures = { MODEL_NONE, MODEL_NONE, MODEL_NONE } };
    return plain;
}

static int is_shared(const model *m, const model_mesh *mesh, uint32_t material)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t s = 0; s < m->meshes[i].submesh_count && &m->meshes[i] != mesh; s++) {
            if (m->meshes[i].submeshes[s].material == material) return 1;
        }
    }
    return 0;
}

int model_own_material(model *m, model_mesh *mesh, uint32_t *material)
{
    const uint32_t from = *material;
    if (!is_shared(m, mesh, from)) return 0;
    model_material *grown = realloc(m->materials, (m->material_count + 1u) * sizeof *grown);
    char *name = grown ? model_string(grown[from].name ? grown[from].name : "") : NULL;
    if (grown) m->materials = grown;
    if (!name) return 1;
    *material = m->material_count++;
    grown[*material] = grown[from];
    grown[*material].name = name;
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        if (mesh->submeshes[s].material == from) mesh->submeshes[s].material = *material;
    }
    return 0;
}

static void target_free(model_target *target)
{
    free(target->name);
    free(target->position);
    free(target->normal);
    free(target->tangent);
    free(target->uv);
    free(target->missing);
}

void model_mesh_clear(model_mesh *mesh)
{
    for (uint32_t i = 0; mesh->targets && i < mesh->target_count; ++i) target_free(&mesh->targets[i]);
    free(mesh->targets);
    free(mesh->name);
    free(mesh->position);
    free(mesh->normal);
    free(mesh->tangent);
    free(mesh->uv);
    free(mesh->color);
    free(mesh->extra);
    free(mesh->indices);
    free(mesh->submeshes);
    free(mesh->weights);
    free(mesh->joints);
    free(mesh->joint_weights);
    free(mesh->wrinkles);
    free(mesh->colors);
    free(mesh->recipe);
}

void model_drop_mesh(model *m, uint32_t mesh)
{
    model_mesh_clear(&m->meshes[mesh]);
    m->mesh_count -= 1;
    memmove(m->meshes + mesh, m->meshes + mesh + 1, (m->mesh_count - mesh) * sizeof *m->meshes);
    for (uint32_t n = 0; n < m->node_count; n++) {
        m->nodes[n].mesh -= m->nodes[n].mesh != MODEL_NONE && m->nodes[n].mesh > mesh;
    }
}

static void clip_free(model_clip *clip)
{
    for (uint32_t i = 0; clip->channels && i < clip->channel_count; ++i) {
        free(clip->channels[i].times);
        free(clip->channels[i].values);
    }
    for (uint32_t i = 0; clip->events && i < clip->event_count; ++i) free(clip->events[i].name);
    free(clip->channels);
    free(clip->events);
    free(clip->name);
}

static void skin_free(model_skin *skin)
{
    free(skin->name);
    free(skin->joints);
    free(skin->inverse_bind);
    free(skin->skeleton_joints);
}

void model_free(model *m)
{
    if (!m) return;
    for (uint32_t i = 0; m->meshes && i < m->mesh_count; ++i) model_mesh_clear(&m->meshes[i]);
    for (uint32_t i = 0; m->nodes && i < m->node_count; ++i) {
        free(m->nodes[i].name);
        free(m->nodes[i].weights);
        free(m->nodes[i].expression);
    }
    for (uint32_t i = 0; m->skins && i < m->skin_count; ++i) skin_free(&m->skins[i]);
    for (uint32_t i = 0; m->clips && i < m->clip_count; ++i) clip_free(&m->clips[i]);
    for (uint32_t i = 0; m->materials && i < m->material_count; ++i) free(m->materials[i].name);
    for (uint32_t i = 0; m->textures && i < m->texture_count; ++i) {
        free(m->textures[i].name);
        free(m->textures[i].rgba);
    }
    for (uint32_t i = 0; m->springs && i < m->spring_count; ++i) free(m->springs[i].joints);
    free(m->springs);
    free(m->colliders);
    free(m->spring_lines);
    for (uint32_t i = 0; i < m->warning_count; ++i) free(m->warnings[i]);
    free(m->meshes);
    free(m->nodes);
    free(m->skins);
    free(m->clips);
    free(m->materials);
    free(m->textures);
    free(m->warnings);
    free(m);
}

/* The longest column of a matrix, squared. */
static double scale_square(const double *w)
{
    double largest = 0.0;
    for (int c = 0; c < 3; c++) {
        double square = w[4 * c] * w[4 * c] + w[4 * c + 1] * w[4 * c + 1] + w[4 * c + 2] * w[4 * c + 2];
        largest = square > largest ? square : largest;
    }
    return largest;
}

/* The joints that move a vertex. */
static double skin_scale_square(const model *m, const model_mesh *mesh, const model_skin *skin)
{
    double largest = 0.0, *squares = model_zeros(skin->joint_count, sizeof *squares);
    for (uint32_t j = 0; squares && j < skin->joint_count; j++) {
        double bind[16], product[16];
        affine_of_floats(skin->inverse_bind + 16 * (size_t)j, bind);
        affine_multiply(m->nodes[skin->joints[j]].world, bind, product);
        squares[j] = scale_square(product);
    }
    for (size_t i = 0; squares && i < (size_t)mesh->vertex_count * MODEL_INFLUENCES_MAX; i++) {
        if (mesh->joint_weights[i] > 0.0f && squares[mesh->joints[i]] > largest) {
            largest = squares[mesh->joints[i]];
        }
    }
    free(squares);
    return largest;
}

uint32_t model_find_target(const model_mesh *mesh, const char *name)
{
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        if (strcmp(mesh->targets[t].name, name) == 0) return t;
    }
    return MODEL_NONE;
}

int model_has_target(const model *m, const char *name)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (model_find_target(&m->meshes[i], name) != MODEL_NONE) return 1;
    }
    return 0;
}

void model_maps(model_material *m, uint32_t *maps[MODEL_MAPS])
{
    uint32_t *const all[MODEL_MAPS] = { &m->base_color_texture, &m->normal_texture,   &m->surface_texture,
                                        &m->emissive_texture,   &m->wrinkle_texture,  &m->more_textures[0],
                                        &m->more_textures[1],   &m->more_textures[2], &m->specular_texture,
                                        &m->color_texture };
    memcpy(maps, all, sizeof all);
}

int model_moves_uv(const model_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->target_count; i++) {
        if (mesh->targets[i].uv) return 1;
    }
    return 0;
}

int model_replaces_texture(const model_texture *t, const model_texture *of)
{
    const size_t size = of->name ? strlen(of->name) : 0;
    return size && t->name && strncmp(t->name, of->name, size) == 0 && t->name[size];
}

float model_mesh_scale(const model *m, uint32_t mesh)
{
    double largest = 0.0;
    for (uint32_t i = 0; i < m->node_count; i++) {
        const model_node *n = &m->nodes[i];
        if (n->mesh == mesh) {
            int skinned = n->skin != MODEL_NONE && n->skin < m->skin_count && m->meshes[mesh].joints;
            double square = skinned ? skin_scale_square(m, &m->meshes[mesh], &m->skins[n->skin])
                                    : scale_square(n->world);
            largest = square > largest ? square : largest;
        }
    }
    return largest > 1e-24 && largest < 1e24 ? (float)sqrt(largest) : 1.0f;
}
