/* Vertices that coarse levels have of their own: nearer, with no crack, and nothing else changed. */
#include "support/lod_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/light/light_surface.h"
#include "convert/lod/lod_fit.h"
#include "convert/model/model_build.h"

static const lod_face head = { 60, 40, LOD_FACE_TARGETS, 0, 0 };

static mesh_levels levels_of(model *m, float own_share)
{
    const lod_settings settings = { 4, 0, LOD_QUALITY, 0.0f, own_share, NULL, 0 };
    model_error error = { "", "" };
    mesh_levels levels;
    if (mesh_levels_make(m, 0, &settings, &levels, &error)) {
        fail_msg("%s (%s)", error.what, error.where);
    }
    assert_int_equal(levels.count, 4);
    return levels;
}

static const lod_level *level_at(const mesh_levels *levels, uint32_t k)
{
    return &levels->built->levels[levels->which[k]];
}

/* [vertex_count] the vertex that each own one is a copy of, itself for others; of the level that has them. */
static uint32_t *sources_of(const model_mesh *mesh, const lod_level *shared, const lod_level *own)
{
    uint32_t *source = test_zeros(sizeof *source * mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) source[v] = v;
    assert_int_equal(shared->index_count, own->index_count);
    for (uint32_t i = 0; i < own->index_count; i++) source[own->indices[i]] = shared->indices[i];
    return source;
}

static int is_same(const float *a, const float *b, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (a[i] != b[i]) return 0;
    }
    return 1;
}

/* The coarsest level comes nearer; nothing else changes. */
static void the_coarsest_level_comes_nearer(void **state)
{
    (void)state;
    model *a = lod_face_model(&head), *b = lod_face_model(&head);
    mesh_levels shared = levels_of(a, -1.0f), own = levels_of(b, 0.0f);
    const model_mesh *from = &a->meshes[0], *to = &b->meshes[0];
    const uint32_t added = to->vertex_count - from->vertex_count;
    for (uint32_t k = 1; k < 3u; k++) {
        assert_memory_equal(&shared.errors[k], &own.errors[k], sizeof own.errors[k]);
        assert_int_equal(level_at(&shared, k)->index_count, level_at(&own, k)->index_count);
        assert_memory_equal(level_at(&shared, k)->indices, level_at(&own, k)->indices,
                            level_at(&own, k)->index_count * sizeof(uint32_t));
    }
    print_message("# %g of %g, 99 %%: %g of %g; %u vertices\n", (double)lod_worst(&own.errors[3]),
                  (double)lod_worst(&shared.errors[3]), (double)own.errors[3].rest_p99,
                  (double)shared.errors[3].rest_p99, added);
    assert_true(lod_worst(&own.errors[3]) < 0.85f * lod_worst(&shared.errors[3]));
    assert_true(own.errors[3].rest_p99 < 0.75f * shared.errors[3].rest_p99);
    assert_true(added > 0 && added <= level_at(&shared, 3)->vertex_count);
    assert_true((float)added <= LOD_OWN_SHARE * (float)from->vertex_count);
    assert_memory_equal(from->indices, to->indices, from->index_count * sizeof *from->indices);
    assert_memory_equal(from->position, to->position, 12u * (size_t)from->vertex_count);
    for (uint32_t t = 0; t < from->target_count; t++) {
        assert_memory_equal(from->targets[t].position, to->targets[t].position, 12u * (size_t)from->vertex_count);
    }
    mesh_levels_free(&shared);
    mesh_levels_free(&own);
    model_free(a);
    model_free(b);
}

/* Seams stay closed in every target, copies keep all else of their vertex, and a target moves what it moved before. */
static void copies_are_their_vertices_but_for_places(void **state)
{
    (void)state;
    model *a = lod_face_model(&head), *b = lod_face_model(&head);
    mesh_levels shared = levels_of(a, -1.0f), own = levels_of(b, 0.0f);
    const model_mesh *mesh = &b->meshes[0];
    const uint32_t before = a->meshes[0].vertex_count;
    uint32_t *source = sources_of(mesh, level_at(&shared, 3), level_at(&own, 3));
    uint32_t *point = test_zeros(sizeof *point * before), *seen = test_zeros(sizeof *seen * before), seams = 0;
    assert_int_equal(weld_vertices(&a->meshes[0], point), 0);
    for (uint32_t v = before; v < mesh->vertex_count; v++) {
        const size_t s = source[v];
        uint32_t *other = &seen[point[s]];
        assert_true(s < before);
        assert_memory_equal(mesh->uv + 2u * (size_t)v, mesh->uv + 2u * s, 8);
        assert_memory_equal(mesh->normal + 3u * (size_t)v, mesh->normal + 3u * s, 12);
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            const float zero[3] = { 0.0f, 0.0f, 0.0f }, *delta = mesh->targets[t].position;
            if (is_same(delta + 3u * s, zero, 3)) assert_true(is_same(delta + 3u * (size_t)v, zero, 3));
            if (*other) assert_true(is_same(delta + 3u * (size_t)v, delta + 3u * (size_t)*other, 3));
        }
        if (*other) {
            assert_true(is_same(mesh->position + 3u * (size_t)v, mesh->position + 3u * (size_t)*other, 3));
            seams++;
        }
        *other = v;
    }
    assert_true(seams > 3u);
    free(source);
    free(point);
    free(seen);
    mesh_levels_free(&shared);
    mesh_levels_free(&own);
    model_free(a);
    model_free(b);
}

/* A target that moves one side of the seam alone: it is closed at rest, and stays so. */
static void points_that_a_target_tears_stay(void **state)
{
    (void)state;
    model *m = lod_face_model(&head);
    model_mesh *mesh = &m->meshes[0];
    const uint32_t before = mesh->vertex_count, row = head.columns + 1u;
    uint32_t kept = 0;
    mesh_levels levels;
    for (uint32_t y = 1; y < head.rows; y++) mesh->targets[6].position[3u * (size_t)(y * row)] += 0.02f;
    levels = levels_of(m, 0.0f);
    for (uint32_t i = 0; i < level_at(&levels, 3)->index_count; i++) {
        const uint32_t v = level_at(&levels, 3)->indices[i];
        kept += v < row * (head.rows + 1u) && (v % row == 0 || v % row == head.columns);
    }
    for (uint32_t v = before; v < mesh->vertex_count; v++) {
        for (uint32_t y = 1; y < head.rows; y++) {
            assert_false(is_same(mesh->uv + 2u * (size_t)v, mesh->uv + 2u * (size_t)(y * row), 2));
            assert_false(is_same(mesh->uv + 2u * (size_t)v, mesh->uv + 2u * (size_t)(y * row + head.columns), 2));
        }
    }
    assert_true(kept > 0);
    mesh_levels_free(&levels);
    model_free(m);
}

/* Too large a level has none, nor has one whose errors are guesses. */
static void levels_have_none_beyond_their_share(void **state)
{
    (void)state;
    const lod_settings few = { 4, 0, LOD_QUALITY, 0.0f, 0.02f, NULL, 0 },
                       fast = { 4, 0, LOD_FAST, 0.0f, 1.0f, NULL, 0 };
    model *m = lod_face_model(&head);
    const uint32_t before = m->meshes[0].vertex_count;
    model_error error = { "", "" };
    mesh_levels levels;
    assert_int_equal(mesh_levels_make(m, 0, &few, &levels, &error), 0);
    assert_int_equal(m->meshes[0].vertex_count, before);
    mesh_levels_free(&levels);
    assert_int_equal(mesh_levels_make(m, 0, &fast, &levels, &error), 0);
    assert_int_equal(m->meshes[0].vertex_count, before);
    mesh_levels_free(&levels);
    model_free(m);
}

/* Vertices off the surface are lit as at the surface. */
static void light_reaches_the_surface_beside_them(void **state)
{
    (void)state;
    const lod_settings settings = { 4, 0, LOD_QUALITY, 0.0f, 0.0f, NULL, 0 };
    model *m = lod_face_model(&head);
    model_error error = { "", "" };
    light_surface s;
    lod_pack p;
    uint8_t *used;
    uint32_t loose = 0;
    lod_pack_make(m, &settings, 0, &p);
    assert_int_equal(light_surface_open(&p.pack, 0, &s, &error), 0);
    used = test_zeros(s.mesh.header->vertex_count);
    for (uint32_t i = 0; i < s.mesh.header->index_count; i++) used[noh_mesh_index(&s.mesh, i)] = 1;
    for (uint32_t v = 0; v < s.mesh.header->vertex_count; v++) {
        const float *at = s.mesh.positions + 3u * (size_t)v, *light = s.position + 3u * (size_t)v;
        const float d[3] = { at[0] - light[0], at[1] - light[1], at[2] - light[2] };
        assert_true(used[s.stand_in[v]]);
        assert_true(used[v] == (s.stand_in[v] == v));
        loose += !used[v];
        if (!used[v]) assert_true(sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) < 0.02f); /* of a radius of 0.1 */
    }
    assert_true(loose > 10u);
    free(used);
    light_surface_close(&s);
    lod_pack_free(&p);
    model_free(m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_coarsest_level_comes_nearer),       cmocka_unit_test(copies_are_their_vertices_but_for_places),
    cmocka_unit_test(points_that_a_target_tears_stay),       cmocka_unit_test(levels_have_none_beyond_their_share),
    cmocka_unit_test(light_reaches_the_surface_beside_them),
};

TEST_MAIN(tests, NULL, NULL)
