/* wrinkle_sheet.h: a model of one square sheet of 17 x 17 vertices, from -1 to 1 in x and y, for tests of wrinkles. */
#ifndef NOH_TESTS_SUPPORT_WRINKLE_SHEET_H
#define NOH_TESTS_SUPPORT_WRINKLE_SHEET_H

#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

#define WRINKLE_SHEET_SIDE 17u
#define WRINKLE_SHEET_VERTICES (WRINKLE_SHEET_SIDE * WRINKLE_SHEET_SIDE)
#define WRINKLE_SHEET_INDICES ((WRINKLE_SHEET_SIDE - 1u) * (WRINKLE_SHEET_SIDE - 1u) * 6u)

/* Where a target moves a vertex. */
typedef struct sheet_target {
    const char *name;
    void (*move)(float at[3]);
} sheet_target;

static void sheet_fill_vertices(model_mesh *mesh)
{
    for (uint32_t v = 0; v < WRINKLE_SHEET_VERTICES; ++v) {
        float x = (float)(v % WRINKLE_SHEET_SIDE) / (WRINKLE_SHEET_SIDE - 1u),
              y = (float)(v / WRINKLE_SHEET_SIDE) / (WRINKLE_SHEET_SIDE - 1u);
        mesh->position[3 * v] = 2.0f * x - 1.0f;
        mesh->position[3 * v + 1] = 1.0f - 2.0f * y;
        mesh->normal[3 * v + 2] = 1.0f;
        mesh->tangent[4 * v] = mesh->tangent[4 * v + 3] = 1.0f;
        mesh->uv[2 * v] = x;
        mesh->uv[2 * v + 1] = y;
    }
}

static void sheet_fill_indices(model_mesh *mesh)
{
    uint32_t at = 0;
    for (uint32_t cell = 0; cell < (WRINKLE_SHEET_SIDE - 1u) * (WRINKLE_SHEET_SIDE - 1u); ++cell) {
        const uint32_t a = cell / (WRINKLE_SHEET_SIDE - 1u) * WRINKLE_SHEET_SIDE + cell % (WRINKLE_SHEET_SIDE - 1u);
        const uint32_t corners[6] = { a,     a + WRINKLE_SHEET_SIDE, a + 1,
                                      a + 1, a + WRINKLE_SHEET_SIDE, a + WRINKLE_SHEET_SIDE + 1 };
        memcpy(mesh->indices + at, corners, sizeof corners);
        at += 6;
    }
}

static void sheet_fill_target(const model_mesh *mesh, const sheet_target *from, model_target *to)
{
    to->name = model_string(from->name);
    to->position = model_zeros(WRINKLE_SHEET_VERTICES, 3 * sizeof(float));
    to->normal = model_zeros(WRINKLE_SHEET_VERTICES, 3 * sizeof(float));
    to->tangent = model_zeros(WRINKLE_SHEET_VERTICES, 3 * sizeof(float));
    to->has_position = 1;
    for (uint32_t v = 0; v < WRINKLE_SHEET_VERTICES; ++v) {
        float at[3];
        memcpy(at, mesh->position + 3 * v, sizeof at);
        from->move(at);
        for (uint32_t c = 0; c < 3; ++c) to->position[3 * v + c] = at[c] - mesh->position[3 * v + c];
    }
}

static void sheet_add_material(model *m)
{
    m->textures = model_zeros(1, sizeof *m->textures);
    m->textures[0] = (model_texture){ .name = model_string("paint"),
                                      .width = 1,
                                      .height = 1,
                                      .rgba = model_zeros(1, 4),
                                      .wrap_s = 10497,
                                      .wrap_t = 10497 };
    m->texture_count = 1;
    m->materials = model_zeros(1, sizeof *m->materials);
    m->materials[0] = model_material_default();
    m->materials[0].name = model_string("skin");
    m->materials[0].base_color_texture = 0;
    m->material_count = 1;
}

/* Texture coordinates run from 0 to 1, v down. One opaque material, whose base colour has a texture that repeats. To be
 * freed by model_free. */
static model *wrinkle_sheet_make(const sheet_target *targets, uint32_t target_count)
{
    model *m = model_new();
    m->meshes = model_zeros(1, sizeof *m->meshes);
    model_mesh *mesh = m->meshes;
    m->mesh_count = 1;
    mesh->name = model_string("sheet");
    mesh->vertex_count = WRINKLE_SHEET_VERTICES;
    mesh->index_count = WRINKLE_SHEET_INDICES;
    mesh->position = model_zeros(WRINKLE_SHEET_VERTICES, 3 * sizeof(float));
    mesh->normal = model_zeros(WRINKLE_SHEET_VERTICES, 3 * sizeof(float));
    mesh->tangent = model_zeros(WRINKLE_SHEET_VERTICES, 4 * sizeof(float));
    mesh->uv = model_zeros(WRINKLE_SHEET_VERTICES, 2 * sizeof(float));
    mesh->indices = model_zeros(WRINKLE_SHEET_INDICES, sizeof(uint32_t));
    sheet_fill_vertices(mesh);
    sheet_fill_indices(mesh);
    mesh->submeshes = model_zeros(1, sizeof *mesh->submeshes);
    mesh->submeshes[0] = (model_submesh){ .index_count = WRINKLE_SHEET_INDICES,
                                          .vertex_count = WRINKLE_SHEET_VERTICES };
    mesh->submesh_count = 1;
    mesh->targets = model_zeros(target_count, sizeof *mesh->targets);
    mesh->weights = model_zeros(target_count, sizeof(float));
    mesh->target_count = target_count;
    for (uint32_t t = 0; t < target_count; ++t) sheet_fill_target(mesh, &targets[t], &mesh->targets[t]);
    sheet_add_material(m);
    return m;
}

#endif
