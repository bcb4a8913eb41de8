/* Materials whose triangles read no texel below their cutoff become opaque. */
#include "convert/texture/texture_solid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "noh/format.h"
#include "support/support.h"

#define SIDE 64u

/* Two triangles of a material with a cutoff, the second at level 0 alone. Both read the left half of a texture, which is
 * as solid as the cutoff asks for; its right half is clear. */
static model *solid_model(void)
{
    static const float left[12] = { 0.1f, 0.1f, 0.4f, 0.1f, 0.1f, 0.9f, 0.2f, 0.2f, 0.3f, 0.2f, 0.2f, 0.5f };
    model *m = model_new();
    model_mesh *mesh = m->meshes = test_zeros(sizeof *m->meshes);
    model_texture *t = m->textures = test_zeros(2 * sizeof *m->textures);
    m->materials = test_zeros(2 * sizeof *m->materials);
    for (int i = 0; i < 2; i++) {
        m->materials[i] = model_material_default();
        m->materials[i].name = model_string("skin");
        m->materials[i].base_color_texture = 0;
        m->textures[i].name = model_string(i ? "coat" : "skin");
    }
    m->materials[0].alpha = MODEL_ALPHA_MASK;
    m->material_count = m->texture_count = 2;
    m->mesh_count = 1;
    t->width = t->height = SIDE;
    t->rgba = test_zeros((size_t)4 * SIDE * SIDE);
    t->with_alpha = 1;
    t->alpha_cutoff = 0.5f;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) t->rgba[4u * i + 3u] = i % SIDE < SIDE / 2u ? 128 : 0;
    mesh->name = model_string("skin");
    mesh->vertex_count = mesh->index_count = 6;
    mesh->position = test_zeros(18 * sizeof *mesh->position);
    mesh->uv = test_zeros(sizeof left);
    memcpy(mesh->uv, left, sizeof left);
    mesh->indices = test_zeros(6 * sizeof *mesh->indices);
    for (uint32_t i = 0; i < 6; i++) mesh->indices[i] = i;
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submesh_count = 1;
    mesh->submeshes[0].vertex_count = mesh->submeshes[0].index_count = 6;
    return m;
}

/* Whether the material became opaque; unread: whether its texture's alpha went with it */
static int becomes_opaque(model *m, const mesh_levels *levels, int *unread)
{
    uint32_t count;
    assert_int_equal(texture_solid(m, levels, &count), 0);
    const int is_opaque = m->materials[0].alpha == MODEL_ALPHA_OPAQUE;
    assert_int_equal(count, is_opaque);
    *unread = m->textures[0].alpha_unread;
    model_free(m);
    return is_opaque;
}

static void solid_materials_become_opaque(void **state)
{
    int unread;
    (void)state;
    assert_true(becomes_opaque(solid_model(), NULL, &unread));
    assert_true(unread);
}

static void whole_textures_repeat_as_they_like(void **state)
{
    int unread;
    (void)state;
    model *m = solid_model();
    for (uint32_t i = 0; i < SIDE * SIDE; i++) m->textures[0].rgba[4u * i + 3u] = 128;
    m->meshes[0].uv[0] = -7.5f;
    assert_true(becomes_opaque(m, NULL, &unread));
}

static void alpha_that_others_read_is_kept(void **state)
{
    int unread;
    (void)state;
    model *m = solid_model();
    m->materials[1].alpha = MODEL_ALPHA_BLEND;
    assert_true(becomes_opaque(m, NULL, &unread));
    assert_false(unread);
    m = solid_model();
    m->textures[0].alpha_is_data = 1;
    assert_true(becomes_opaque(m, NULL, &unread));
    assert_false(unread);
}

enum {
    NEAR,
    BEYOND,
    DIAGONAL,
    NO_NUMBER,
    NO_UV,
    CUTOFF,
    ABOVE_ONE,
    FACTOR,
    VERTICES,
    HAIR,
    EYE,
    BLEND,
    SET,
    TARGET,
    KINDS
};

/* A change after which the material cuts, or could. */
static void change(model *m, int kind)
{
    model_mesh *mesh = &m->meshes[0];
    model_material *of = &m->materials[0];
    switch (kind) {
    case NEAR: mesh->uv[2] = 0.485f; break; /* within a filter's reach of the clear half */
    case BEYOND: mesh->uv[2] = -0.1f; break;
    case DIAGONAL: mesh->uv[2] = 0.9f; break;
    case NO_NUMBER: mesh->uv[2] = NAN; break;
    case NO_UV: free(mesh->uv), mesh->uv = NULL; break;
    case CUTOFF: of->alpha_cutoff = 0.51f; break;
    case ABOVE_ONE: of->alpha_cutoff = 1.5f; break;
    case FACTOR: of->base_color[3] = 0.9f; break;
    case VERTICES: mesh->color = test_zeros(24 * sizeof(float)); break;
    case HAIR: of->surface = NOH_SURFACE_HAIR; break;
    case EYE: of->surface = NOH_SURFACE_EYE; break;
    case BLEND: of->alpha = MODEL_ALPHA_BLEND; break;
    case SET: free(m->textures[1].name), m->textures[1].name = model_string("skin.dirty"); break;
    default:
        mesh->targets = test_zeros(sizeof *mesh->targets);
        mesh->targets[0].uv = test_zeros(12 * sizeof(float));
        mesh->target_count = 1;
    }
}

static void what_may_cut_stays(void **state)
{
    int unread;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        model *m = solid_model();
        change(m, kind);
        if (becomes_opaque(m, NULL, &unread)) fail_msg("kind %d became opaque", kind);
        assert_false(unread);
    }
}

/* A coarse triangle that spans the clear half, which no fine one reads. */
static void coarse_levels_count(void **state)
{
    static uint32_t indices[3] = { 0, 3, 6 }, first[1] = { 0 }, count[1] = { 3 };
    static lod built;
    const mesh_levels levels = { .count = 2, .built = &built, .which = { 0, 0 } };
    int unread;
    (void)state;
    built.levels[0] = (lod_level){ .indices = indices, .submesh_first = first, .submesh_count = count };
    for (int spans = 0; spans < 2; spans++) {
        model *m = solid_model();
        model_mesh *mesh = &m->meshes[0];
        mesh->uv = realloc(mesh->uv, 14 * sizeof *mesh->uv);
        assert_non_null(mesh->uv);
        mesh->uv[12] = spans ? 0.8f : 0.3f;
        mesh->uv[13] = 0.8f;
        assert_int_equal(becomes_opaque(m, &levels, &unread), !spans);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solid_materials_become_opaque),
        cmocka_unit_test(whole_textures_repeat_as_they_like),
        cmocka_unit_test(alpha_that_others_read_is_kept),
        cmocka_unit_test(what_may_cut_stays),
        cmocka_unit_test(coarse_levels_count),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
