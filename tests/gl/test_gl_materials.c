/* Maps of a material, each pixel against its closed form: normal maps on frames that morphs and joints left skewed and
 * that a mirror turned inside out, maps of occlusion, roughness and metallic, emissive colour; and what a material
 * lacks, no program has. */
#include "support/gl_fixture.h"

#include "support/lit_quad.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How far the middle row is from the closed form, and that from another. */
static void compare(const lit_quad *q, lit_quad_normals wrong, double *off, double *other)
{
    uint8_t *rgba = lit_quad_draw(fixture_gpu(), q, NOH_DRAW_OPAQUE);
    *off = *other = 0.0;
    for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
        double right[3], literal[3];
        lit_quad_pixel(q, x, NORMALS_BY_INVERSE_TRANSPOSE, 1, right);
        lit_quad_pixel(q, x, wrong, 1, literal);
        for (int i = 0; i < 3; i++) {
            *off = fmax(*off, fabs((double)lit_quad_at(rgba, x)[i] - right[i]));
            *other = fmax(*other, fabs(literal[i] - right[i]));
        }
    }
    free(rgba);
    fixture_expect_no_errors();
}

static lit_quad mapped(const uint8_t *texel, float hand)
{
    static const float tangent[3] = { 0.6f, 0.8f, 0.0f };
    lit_quad q = lit_quad_of();
    q.normal_map = texel;
    memcpy(q.tangent, tangent, sizeof tangent);
    q.tangent[3] = hand;
    return q;
}

static void normal_maps_turn_the_normal(void **state)
{
    static const uint8_t texels[3][4] = { { 128, 128, 255, 255 }, { 190, 128, 235, 255 }, { 100, 200, 220, 255 } };
    (void)state;
    for (int i = 0; i < 6; i++) {
        lit_quad q = mapped(texels[i / 2], i % 2 ? -1.0f : 1.0f);
        double off, other;
        q.normal_scale = i < 4 ? 1.0f : 0.5f;
        compare(&q, FRAME_AS_IT_IS, &off, &other);
        assert_true(off < LIT_QUAD_CLOSE);
    }
}

/* C12.4: normals morph and tangents stay, and nothing makes them orthogonal again. Here the quad's normals differ from
 * corner to corner and its tangents do not. */
static void errata_C12_4_a_skewed_frame_leans_the_normal(void **state)
{
    static const uint8_t texel[4] = { 230, 150, 200, 255 };
    const lit_quad q = mapped(texel, 1.0f);
    double off, other;
    (void)state;
    compare(&q, FRAME_AS_IT_IS, &off, &other);
    assert_true(off < LIT_QUAD_CLOSE);
    assert_true(other > 4.0 * LIT_QUAD_CLOSE);
}

/* C12.2: the frame in the object and the light in the world. A mirrored node tells them apart: it turns the frame
 * inside out, so the cross product of two world vectors points the wrong way. */
static void errata_C12_2_a_mirror_turns_the_frame_inside_out(void **state)
{
    static const uint8_t texel[4] = { 128, 220, 210, 255 };
    lit_quad q = mapped(texel, 1.0f);
    double off, other;
    (void)state;
    q.world[5] = -q.world[5];
    compare(&q, FRAME_NOT_MIRRORED, &off, &other);
    assert_true(off < LIT_QUAD_CLOSE);
    assert_true(other > 4.0 * LIT_QUAD_CLOSE);
}

/* C12.1: bytes as 2 t - 1 have no zero, so a flat map leans. The byte 128 stands for it. */
static void errata_C12_1_a_flat_map_changes_nothing(void **state)
{
    static const uint8_t flat[4] = { 128, 128, 255, 255 };
    const lit_quad q = mapped(flat, 1.0f), plain = lit_quad_of();
    uint8_t *a = lit_quad_draw(fixture_gpu(), &q, NOH_DRAW_OPAQUE);
    uint8_t *b = lit_quad_draw(fixture_gpu(), &plain, NOH_DRAW_OPAQUE);
    (void)state;
    for (uint32_t i = 0; i < LIT_QUAD_SIDE * LIT_QUAD_SIDE * 4u; i++) assert_in_range(a[i] + 1, b[i], b[i] + 2);
    free(a);
    free(b);
}

static void surface_maps_and_emissive_colours_count(void **state)
{
    static const uint8_t texels[2][4] = { { 80, 160, 200, 255 }, { 255, 90, 20, 255 } };
    (void)state;
    for (int i = 0; i < 4; i++) {
        lit_quad q = lit_quad_of();
        double off, other;
        q.surface_map = texels[i % 2];
        q.metallic = 0.8f;
        q.roughness = 0.9f;
        q.occlusion_strength = i < 2 ? 1.0f : 0.4f;
        q.emissive[0] = i < 2 ? 0.0f : 0.2f;
        q.emissive[2] = 0.1f;
        compare(&q, NORMALS_BY_NOTHING, &off, &other);
        assert_true(off < LIT_QUAD_CLOSE);
    }
}

/* ---- what a material lacks costs nothing ---- */

static void programs_have_what_materials_have(void **state)
{
    static const char *const names[] = { "noh_normal_texture", "noh_surface_texture", "noh_emissive_texture",
                                         "noh_surface_values" };
    static const uint8_t features[] = { 0,
                                        NOH_FEATURE_NORMAL_MAP,
                                        NOH_FEATURE_SURFACE_MAP,
                                        NOH_FEATURE_EMISSIVE,
                                        NOH_FEATURE_SKIN,
                                        NOH_FEATURE_EYE,
                                        NOH_FEATURE_TEETH };
    gpu *g = fixture_gpu();
    noh_gl_ledger ledger;
    (void)state;
    memset(&ledger, 0, sizeof ledger);
    for (size_t i = 0; i < TEST_COUNT(features); i++) {
        noh_gl_variant_key key = { 0 };
        noh_gl_variant v;
        key.features = features[i];
        assert_int_equal(
            noh_gl_variant_create(&(noh_gl_device){ &g->gl, NULL, &ledger, NULL, 0 }, key, NULL, NULL, 0, &v, NULL),
            NOH_OK);
        for (size_t k = 0; k < TEST_COUNT(names); k++) {
            const GLint at = g->gl.GetUniformLocation(v.program, names[k]);
            assert_int_equal(at >= 0, i > 3u ? k == 3u : k + 1u == i);
        }
        noh_gl_variant_delete(&g->gl, &ledger, &v);
    }
    fixture_expect_no_errors();
}

static void features_follow_material_and_mesh(void **state)
{
    noh_mesh_header header;
    noh_mesh mesh;
    noh_material m;
    (void)state;
    memset(&header, 0, sizeof header);
    memset(&mesh, 0, sizeof mesh);
    memset(&m, 0, sizeof m);
    mesh.header = &header;
    m.surface_texture = m.wrinkle_texture = NOH_NONE; /* the normal map is texture 0 */
    assert_int_equal(noh_gl_features_of(&mesh, &m), 0);
    header.flags = NOH_MESH_TANGENTS;
    assert_int_equal(noh_gl_features_of(&mesh, &m), NOH_FEATURE_NORMAL_MAP);
    m.emissive[1] = 0.5f;
    m.surface = NOH_SURFACE_EYE;
    assert_int_equal(noh_gl_features_of(&mesh, &m), NOH_FEATURE_NORMAL_MAP | NOH_FEATURE_EMISSIVE | NOH_FEATURE_EYE);
    m.surface = NOH_SURFACE_SKIN;
    assert_int_equal(noh_gl_features_of(&mesh, &m), NOH_FEATURE_NORMAL_MAP | NOH_FEATURE_EMISSIVE | NOH_FEATURE_SKIN);
    m.surface = NOH_SURFACE_TEETH;
    assert_int_equal(noh_gl_features_of(&mesh, &m), NOH_FEATURE_NORMAL_MAP | NOH_FEATURE_EMISSIVE | NOH_FEATURE_TEETH);
    m.flags = NOH_MATERIAL_UNLIT;
    assert_int_equal(noh_gl_features_of(&mesh, &m), 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(normal_maps_turn_the_normal),
    cmocka_unit_test(errata_C12_4_a_skewed_frame_leans_the_normal),
    cmocka_unit_test(errata_C12_2_a_mirror_turns_the_frame_inside_out),
    cmocka_unit_test(errata_C12_1_a_flat_map_changes_nothing),
    cmocka_unit_test(surface_maps_and_emissive_colours_count),
    cmocka_unit_test(programs_have_what_materials_have),
    cmocka_unit_test(features_follow_material_and_mesh),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
