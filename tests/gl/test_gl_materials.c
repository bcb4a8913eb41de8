/* Maps of a material, each pixel against its closed form: normal maps on frames that morphs and joints left skewed and
 * that a mirror turned inside out, maps of occlusion, roughness and metallic, emissive colour; and what a material
 * lacks, no program has. */
#include "support/gl_fixture.h"

#include "support/lit_quad.h"
#include "gl/draw/gl_variants_internal.h"

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

/* A slope of the map that grazes the view, on a surface that faces it. The quad is black: all that it shows is what it
 * mirrors. */
static void creases_of_a_map_are_no_mirrors(void **state)
{
    static const uint8_t slopes[2][4] = { { 254, 128, 134, 255 }, { 128, 2, 136, 255 } };
    (void)state;
    for (int i = 0; i < 2; i++) {
        lit_quad q = mapped(slopes[i], 1.0f);
        double off, other;
        q.normal_scale = 1.0f;
        q.base[0] = q.base[1] = q.base[2] = q.metallic = 0.0f;
        compare(&q, FRAME_AS_IT_IS, &off, &other);
        assert_true(off < LIT_QUAD_CLOSE);
    }
}

/* C12.4: normals morph and tangents stay, and nothing makes them orthogonal again. Here the quad's normals differ from
 * corner to corner and its tangents do not. */
static void a_skewed_frame_is_made_orthogonal(void **state)
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
static void a_mirror_turns_the_frame_along(void **state)
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

/* C12.2: the first listing has the light in the world, and normal and tangent in the object. */
static void light_and_frame_are_in_one_space(void **state)
{
    static const uint8_t texel[4] = { 200, 160, 220, 255 };
    const lit_quad q = mapped(texel, 1.0f);
    double off, other;
    (void)state;
    compare(&q, FRAME_IN_OBJECT, &off, &other);
    assert_true(off < LIT_QUAD_CLOSE);
    assert_true(other > 4.0 * LIT_QUAD_CLOSE);
}

/* The quad elsewhere in the world, with the camera: what is seen does not change. */
static lit_quad shifted(const lit_quad *q, const float by[3])
{
    lit_quad out = *q;
    for (int i = 0; i < 3; i++) {
        out.world[4 * i + 3] += by[i];
        out.camera.view_projection[12 + i] -= out.camera.view_projection[5 * i] * by[i];
        out.camera.eye[i] += by[i];
    }
    return out;
}

static uint32_t largest_difference(const uint8_t *a, const uint8_t *b)
{
    uint32_t largest = 0;
    for (uint32_t i = 0; i < LIT_QUAD_SIDE * LIT_QUAD_SIDE * 4u; i++) {
        const uint32_t d = (uint32_t)abs(a[i] - b[i]);
        largest = d > largest ? d : largest;
    }
    return largest;
}

static const float far_away[3] = { 0.4f, -0.7f, 0.5f };

/* C12.2: "a point in world space" is a vector: turned as a point, the light takes the world's shift along. */
static void a_light_is_a_direction(void **state)
{
    static const uint8_t texel[4] = { 200, 160, 220, 255 };
    const lit_quad here = mapped(texel, 1.0f), there = shifted(&here, far_away);
    lit_quad literal = there;
    uint8_t *a = lit_quad_draw(fixture_gpu(), &here, NOH_DRAW_OPAQUE);
    uint8_t *b = lit_quad_draw(fixture_gpu(), &there, NOH_DRAW_OPAQUE), *c;
    float length = 0.0f;
    (void)state;
    for (int i = 0; i < 3; i++) {
        literal.camera.key[i] += far_away[i];
        length += literal.camera.key[i] * literal.camera.key[i];
    }
    for (int i = 0; i < 3; i++) literal.camera.key[i] /= sqrtf(length);
    c = lit_quad_draw(fixture_gpu(), &literal, NOH_DRAW_OPAQUE);
    assert_true(largest_difference(a, b) <= 1);
    assert_true(largest_difference(a, c) > 10);
    free(a);
    free(b);
    free(c);
}

/* C12.4: float3 times float4x4 takes the world's shift into normal and tangent. */
static void a_shift_turns_no_frame(void **state)
{
    static const uint8_t texel[4] = { 230, 150, 200, 255 };
    const lit_quad here = mapped(texel, 1.0f), there = shifted(&here, far_away);
    uint8_t *a = lit_quad_draw(fixture_gpu(), &here, NOH_DRAW_OPAQUE);
    uint8_t *b = lit_quad_draw(fixture_gpu(), &there, NOH_DRAW_OPAQUE);
    (void)state;
    assert_true(largest_difference(a, b) <= 1);
    for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
        double n[3], cosine = 0.0, length = 0.0;
        lit_quad_normal(&here, x, NORMALS_BY_INVERSE_TRANSPOSE, n);
        for (int i = 0; i < 3; i++) {
            const double literal = n[i] + (double)far_away[i];
            cosine += n[i] * literal;
            length += literal * literal;
        }
        assert_true(cosine / sqrt(length) < 0.97); /* 14 degrees and more */
    }
    free(a);
    free(b);
}

/* C12.5: a normal that is filtered between vertices is shorter than one, and the exponent of a highlight makes much of
 * it. */
static void filtered_normals_are_unit(void **state)
{
    lit_quad q = lit_quad_of();
    double off, other;
    (void)state;
    q.roughness = 0.35f;
    compare(&q, NORMALS_NOT_UNIT, &off, &other);
    assert_true(off < LIT_QUAD_CLOSE);
    assert_true(other > 4.0 * LIT_QUAD_CLOSE);
}

/* C12.5: pow(sat(n h), 85) * 0.4 also shines where the light is behind the surface. The quad is metal, so that nothing
 * but highlights shows the light; in the middle column it lies 3 degrees behind the surface and the eye 12 in front of
 * it, on the other side. Then it is far behind, which must look the same. */
static void nothing_shines_from_behind(void **state)
{
    const uint32_t middle = LIT_QUAD_SIDE / 2u;
    lit_quad near = lit_quad_of(), far;
    double n[3], nh = 0.0, length = 0.0;
    uint8_t *a, *b;
    (void)state;
    near.metallic = 1.0f;
    near.roughness = 0.3f;
    lit_quad_normal(&near, middle, NORMALS_BY_INVERSE_TRANSPOSE, n);
    assert_true(fabs(n[0]) < 1e-6);
    far = near;
    for (int i = 0; i < 3; i++) { /* the row runs along x */
        near.camera.key[i] = (float)(i == 0 ? -cos(0.05) : -sin(0.05) * n[i]);
        near.camera.eye[i] = (float)(100.0 * (i == 0 ? cos(0.2) : sin(0.2) * n[i]));
        far.camera.key[i] = (float)-n[i];
        far.camera.eye[i] = near.camera.eye[i];
    }
    for (int i = 0; i < 3; i++) {
        const double h = (double)(near.camera.key[i] + 0.01f * near.camera.eye[i]);
        nh += n[i] * h;
        length += h * h;
    }
    assert_true(0.4 * pow(nh / sqrt(length), 85.0) > 0.1); /* the literal highlight: 89 of 255 and more */
    a = lit_quad_draw(fixture_gpu(), &near, NOH_DRAW_OPAQUE);
    b = lit_quad_draw(fixture_gpu(), &far, NOH_DRAW_OPAQUE);
    for (int i = 0; i < 3; i++) assert_true(abs(lit_quad_at(a, middle)[i] - lit_quad_at(b, middle)[i]) <= 1);
    free(a);
    free(b);
}

/* C12.1: bytes as 2 t - 1 have no zero, so a flat map leans. The byte 128 stands for it. */
static void a_flat_map_changes_nothing(void **state)
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

/* Colours and weights of reflections by texel, as KHR_materials_specular has them, and roughness beside colours. */
static void specular_maps_count(void **state)
{
    static const uint8_t maps[4][4] = {
        { 255, 120, 40, 255 }, { 200, 255, 90, 120 }, { 255, 255, 255, 0 }, { 60, 180, 250, 70 }
    };
    static const uint8_t surface[4] = { 230, 140, 255, 90 };
    (void)state;
    for (int i = 0; i < 32; i++) {
        lit_quad q = lit_quad_of();
        double off, other;
        q.specular_map = i & 16 ? NULL : maps[i % 4];
        q.specular_roughness = i >> 2 & 1;
        q.surface_map = i >> 3 & 1 ? surface : NULL;
        q.f90_loss = i % 3 ? 0.25f : 0.0f;
        q.f0 = i % 5 ? 0.5f : 2.5f; /* above 1: colours of a factor of 30 and more */
        if (!q.specular_map && q.f0 > 1.0f) q.f0 = 1.0f - q.f90_loss;
        q.metallic = i % 2 ? 0.0f : 0.3f;
        if (!q.specular_map) q.specular_roughness = 0;
        compare(&q, NORMALS_BY_NOTHING, &off, &other);
        if (off >= LIT_QUAD_CLOSE) print_error("case %d: off by %.2f\n", i, off);
        assert_true(off < LIT_QUAD_CLOSE);
    }
}

/* ---- what a material lacks costs nothing ---- */

/* A linear grey by row and an alpha by column, over what is 0.75 in sRGB, as strands are blended in linear light. */
static const char strands_fragment[] =
    "out vec4 o_color;\n"
    "void main()\n"
    "{\n"
    "    vec2 at = gl_FragCoord.xy / 33.0;\n"
    "    vec4 strand = vec4(vec3(pow(at.y, 2.2)), at.x);\n"
    "    o_color = vec4(mix(vec3(pow(0.75, 2.2)), strand.rgb, noh_strand_alpha(strand)), 1.0);\n"
    "}\n";

/* Dark strands look as if they were blended in sRGB; as their alpha says, they would be up to 51 of 255 paler. */
static void dark_strands_are_as_they_were_painted(void **state)
{
    const noh_gl_shader_desc own = { .name = "strands", .fragment = strands_fragment };
    lit_quad q = lit_quad_of();
    double worst = 0.0, literal = 0.0;
    uint8_t *rgba;
    (void)state;
    q.shaders = &own;
    rgba = lit_quad_draw(fixture_gpu(), &q, NOH_DRAW_OPAQUE);
    for (uint32_t row = 0; row < LIT_QUAD_SIDE; row++) {
        for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
            const double shade = (LIT_QUAD_SIDE - row - 0.5) / LIT_QUAD_SIDE, alpha = (x + 0.5) / LIT_QUAD_SIDE;
            const double linear = alpha * pow(shade, 2.2) + (1.0 - alpha) * pow(0.75, 2.2);
            const double painted = 255.0 * (alpha * shade + (1.0 - alpha) * 0.75);
            worst = fmax(worst, fabs(rgba[4u * (row * LIT_QUAD_SIDE + x)] - painted));
            literal = fmax(literal, fabs(encoded(linear) - painted));
        }
    }
    print_message("# off by at most %.1f of 255; as their alpha says %.1f\n", worst, literal);
    assert_true(worst < 16.0);
    assert_true(literal > 40.0);
    free(rgba);
    fixture_expect_no_errors();
}

static uint8_t *draw_cut(const float *colors, model_alpha alpha, float cutoff, int covers)
{
    const noh_gl_api *gl = &fixture_gpu()->gl;
    lit_quad q = lit_quad_of();
    uint8_t *rgba;
    q.color = colors;
    q.alpha = alpha;
    q.cutoff = cutoff;
    q.unlit = 1;
    if (covers) gl->Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    rgba = lit_quad_draw(fixture_gpu(), &q, alpha == MODEL_ALPHA_BLEND ? NOH_DRAW_BLENDED : NOH_DRAW_OPAQUE);
    assert_int_equal(gl->IsEnabled(GL_SAMPLE_ALPHA_TO_COVERAGE), covers);
    gl->Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    fixture_expect_no_errors();
    return rgba;
}

/* A ramp of alpha at a slant over the quad, cut in its middle or blended. */
static uint8_t *draw_ramp(model_alpha alpha, int covers)
{
    static const float ramp[16] = { 1, 1, 1, 0.1f, 1, 1, 1, 0.8f, 1, 1, 1, 0.3f, 1, 1, 1, 1 };
    return draw_cut(ramp, alpha, 0.5f, covers);
}

/* How many pixels of a row are neither like its first nor like its last. */
static uint32_t between(const uint8_t *row)
{
    uint32_t count = 0;
    for (uint32_t x = 1; x + 1u < LIT_QUAD_SIDE; x++) {
        count += abs(row[4u * x] - row[0]) > 1 && abs(row[4u * x] - row[4u * (LIT_QUAD_SIDE - 1u)]) > 1;
    }
    return count;
}

/* In a target of one sample every pixel is drawn or not, in a pattern along the edge that covers as much as it did. */
static void expect_a_dither(const uint8_t *sharp)
{
    uint32_t differ = 0, more = 0;
    uint8_t *dithered = draw_ramp(MODEL_ALPHA_MASK, 1);
    for (uint32_t row = 0; row < LIT_QUAD_SIDE; row++) {
        const uint8_t *a = sharp + 4u * (size_t)row * LIT_QUAD_SIDE, *b = dithered + 4u * (size_t)row * LIT_QUAD_SIDE;
        assert_int_equal(between(b), 0);
        for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
            const int drawn = abs(b[4u * x] - a[0]) > 1, was = abs(a[4u * x] - a[0]) > 1;
            differ += drawn != was;
            more += drawn && !was;
        }
    }
    print_message("# %u pixels of %u rows are dithered, %u of them drawn\n", differ, LIT_QUAD_SIDE, more);
    assert_in_range(differ, LIT_QUAD_SIDE / 8u, LIT_QUAD_SIDE);
    assert_in_range(more, 1, differ - 1u);
    free(dithered);
}

/* The edge of a cut is a pixel wide where alpha becomes coverage, and what blends is as it was. */
static void cut_edges_take_the_samples_of_the_target(void **state)
{
    uint8_t *sharp, *soft, *blended, *again;
    uint32_t all = 0;
    (void)state;
    fixture_gpu()->caps.samples_max = 4;
    sharp = draw_ramp(MODEL_ALPHA_MASK, 0);
    soft = draw_ramp(MODEL_ALPHA_MASK, 1);
    blended = draw_ramp(MODEL_ALPHA_BLEND, 0);
    again = draw_ramp(MODEL_ALPHA_BLEND, 1);
    fixture_gpu()->caps.samples_max = 1;
    for (uint32_t row = 0; row < LIT_QUAD_SIDE; row++) {
        const size_t at = 4u * (size_t)row * LIT_QUAD_SIDE;
        assert_int_equal(between(sharp + at), 0);
        assert_in_range(between(soft + at), 0, 2);
        all += between(soft + at);
    }
    print_message("# %u pixels of %u rows are partly covered\n", all, LIT_QUAD_SIDE);
    assert_true(2u * all > LIT_QUAD_SIDE);
    assert_memory_equal(blended, again, 4u * LIT_QUAD_SIDE * LIT_QUAD_SIDE);
    free(soft);
    expect_a_dither(sharp);
    free(sharp);
    free(blended);
    free(again);
}

/* Where all of a surface has the alpha of the cutoff, all of it is drawn, with whatever samples. */
static void alpha_equal_to_the_cutoff_is_drawn(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const float alpha = i & 1 ? 1.0f : 0.0f;
        const float colors[16] = { 1, 1, 1, alpha, 1, 1, 1, alpha, 1, 1, 1, alpha, 1, 1, 1, alpha };
        uint8_t *sharp = draw_cut(colors, MODEL_ALPHA_MASK, alpha, 0), *soft;
        fixture_gpu()->caps.samples_max = i & 2 ? 1u : 4u;
        soft = draw_cut(colors, MODEL_ALPHA_MASK, alpha, 1);
        fixture_gpu()->caps.samples_max = 1;
        assert_memory_equal(sharp, soft, 4u * LIT_QUAD_SIDE * LIT_QUAD_SIDE);
        free(sharp);
        free(soft);
    }
}

static void programs_have_what_materials_have(void **state)
{
    static const char *const names[] = { "noh_normal_texture", "noh_surface_texture", "noh_emissive_texture",
                                         "noh_surface_values", "noh_specular_texture" };
    static const uint32_t features[] = { 0,
                                         NOH_FEATURE_NORMAL_MAP,
                                         NOH_FEATURE_SURFACE_MAP,
                                         NOH_FEATURE_EMISSIVE,
                                         NOH_FEATURE_SKIN,
                                         NOH_FEATURE_EYE,
                                         NOH_FEATURE_TEETH,
                                         NOH_FEATURE_HAIR,
                                         NOH_FEATURE_SPECULAR_MAP };
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
            assert_int_equal(at >= 0, i > 7u ? k == 4u : i > 3u ? k == 3u : k + 1u == i);
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
    m.surface = NOH_SURFACE_HAIR;
    assert_int_equal(noh_gl_features_of(&mesh, &m), NOH_FEATURE_NORMAL_MAP | NOH_FEATURE_EMISSIVE | NOH_FEATURE_HAIR);
    m.flags = NOH_MATERIAL_UNLIT;
    assert_int_equal(noh_gl_features_of(&mesh, &m), 0);
    m.flags = NOH_MATERIAL_UNLIT | NOH_MATERIAL_MASK;
    assert_int_equal(noh_gl_features_of(&mesh, &m), NOH_FEATURE_ALPHA);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(normal_maps_turn_the_normal),
    cmocka_unit_test(creases_of_a_map_are_no_mirrors),
    cmocka_unit_test(a_skewed_frame_is_made_orthogonal),
    cmocka_unit_test(a_mirror_turns_the_frame_along),
    cmocka_unit_test(light_and_frame_are_in_one_space),
    cmocka_unit_test(a_light_is_a_direction),
    cmocka_unit_test(a_shift_turns_no_frame),
    cmocka_unit_test(filtered_normals_are_unit),
    cmocka_unit_test(nothing_shines_from_behind),
    cmocka_unit_test(a_flat_map_changes_nothing),
    cmocka_unit_test(surface_maps_and_emissive_colours_count),
    cmocka_unit_test(specular_maps_count),
    cmocka_unit_test(dark_strands_are_as_they_were_painted),
    cmocka_unit_test(cut_edges_take_the_samples_of_the_target),
    cmocka_unit_test(alpha_equal_to_the_cutoff_is_drawn),
    cmocka_unit_test(programs_have_what_materials_have),
    cmocka_unit_test(features_follow_material_and_mesh),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
