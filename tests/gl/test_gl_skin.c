/* Skinning on the GPU: every vertex against the CPU reference; the same bits by a uniform block, a texture and a crowd;
 * the same picture of split meshes; what is sent, and what is refused. */
#include "support/gl_skin_fixture.h"
#include "support/renderer.h"
#include "gl/draw/gl_draw_internal.h"
#include "gl/draw/gl_skin_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "noh/low_core.h"

static const char *const assets[] = { "hero/body.glb",   "hero/body_8inf.glb",          "hero/body_quantized.glb",
                                      "khronos/Fox.glb", "khronos/RobotExpressive.glb", "khronos/SimpleSkin.gltf" };
static const char *const every_mesh[] = { "all" };

static fixture_skin_desc desc_of(const char *asset, noh_palette_mode mode)
{
    fixture_skin_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.asset = asset;
    desc.mode = mode;
    return desc;
}

/* ---- equal to the CPU ---- */

/* The largest error of a position, as a share of the box. */
static double expect_equals_cpu(const fixture_skin *f, const char *what)
{
    double most = 0.0;
    for (uint32_t i = 0; i < f->mesh_count; i++) {
        noh_vertex *expected = fixture_skin_reference(f, noh_gl_skin_instance(f->skin, i, 0));
        readback_vertex *got = fixture_skin_read(f, i, 0, 0, 0);
        fixture_error e = fixture_skin_compare(got, expected, f->meshes[i].header->vertex_count);
        fixture_expect_close(&e, what);
        most = fmax(most, e.position / e.box);
        free(got);
        free(expected);
    }
    return most;
}

static void check_poses(const fixture_skin_desc *desc)
{
    test_random r = { 71 };
    fixture_skin f;
    double most = 0.0;
    fixture_skin_open(&f, desc);
    for (int round = 0; round < 3; round++) {
        fixture_skin_pose(&f, &r);
        most = fmax(most, expect_equals_cpu(&f, desc->asset));
    }
    print_message("# %s, %s: positions within %.2g of the box\n", desc->asset,
                  desc->mode == NOH_PALETTE_UNIFORM ? "uniform" : "texture", most);
    fixture_skin_close(&f);
    fixture_expect_no_errors();
}

static void every_asset_equals_the_cpu(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(assets); i++) {
        for (int mode = NOH_PALETTE_UNIFORM; mode <= NOH_PALETTE_TEXTURE; mode++) {
            fixture_skin_desc desc = desc_of(assets[i], (noh_palette_mode)mode);
            check_poses(&desc);
        }
    }
}

static void every_number_of_influences_equals_the_cpu(void **state)
{
    static const uint32_t stored[] = { 1, 2, 4, 8 };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(stored); i++) {
        fixture_skin_desc desc = desc_of("hero/body_8inf.glb", NOH_PALETTE_UNIFORM);
        desc.options.influences = stored[i];
        assert_int_equal(test_mesh(fixture_skinned_pack(desc.asset, &desc.options), 0).header->influence_count,
                         stored[i]);
        check_poses(&desc);
    }
}

static void dual_quaternions_equal_the_cpu(void **state)
{
    static const char *const some[] = { "hero/body.glb", "hero/body_8inf.glb", "khronos/SimpleSkin.gltf" };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(some); i++) {
        for (int mode = NOH_PALETTE_UNIFORM; mode <= NOH_PALETTE_TEXTURE; mode++) {
            fixture_skin_desc desc = desc_of(some[i], (noh_palette_mode)mode);
            desc.options.dual_quaternion = every_mesh;
            desc.options.dual_quaternion_count = 1;
            check_poses(&desc);
        }
    }
}

/* Every joint stretches by the same three factors and stands at (5, 5, 5). */
static void stretch_all(fixture_skin *f, const float scale[3])
{
    noh_skin skin;
    assert_int_equal(noh_pack_skin_at(f->pack, f->meshes[0].header->skin, &skin, NULL), NOH_OK);
    for (uint32_t e = 0; e < 12 * skin.header->joint_count; e++) {
        f->matrices[0][e] = e % 4 == 3 ? 5.0f : e % 4 == e / 4 % 3 ? scale[e % 4] : 0.0f;
    }
    noh_gl_skin_set_matrices(f->skin, 0, f->matrices[0]);
    noh_gl_skin_update(f->skin);
}

static void expect_one_point(const fixture_skin *f)
{
    readback_vertex *got = fixture_skin_read(f, 0, 0, 0, 0);
    for (uint32_t v = 0; v < f->meshes[0].header->vertex_count; v++) {
        for (int i = 0; i < 3; i++) { /* nothing is NaN */
            assert_true(fabsf(got[v].position[i] - 5.0f) <= 1e-5f);
            assert_true(fabsf(got[v].normal[i]) <= 1.001f && fabsf(got[v].tangent[i]) <= 1.001f);
        }
    }
    free(got);
}

static void mirrors_and_lost_axes(void **state)
{
    static const float scales[][3] = { { -1, 1, 1 }, { -1, -1, -1 }, { 0, 1, 1 }, { 1, 2, 0.25f } },
                       none[3] = { 0, 0, 0 };
    (void)state;
    for (uint32_t dual = 0; dual < 2; dual++) {
        fixture_skin_desc desc = desc_of("khronos/Fox.glb", NOH_PALETTE_TEXTURE);
        test_random r = { 72 };
        fixture_skin f;
        desc.options.dual_quaternion = every_mesh;
        desc.options.dual_quaternion_count = dual;
        fixture_skin_open(&f, &desc);
        fixture_skin_pose(&f, &r);
        for (size_t s = 0; s < TEST_COUNT(scales); s++) {
            stretch_all(&f, scales[s]);
            expect_equals_cpu(&f, "a stretched fox");
        }
        stretch_all(&f, none);
        expect_one_point(&f);
        fixture_skin_close(&f);
    }
}

/* ---- the same bits ---- */

#define COPIES 5u

static void expect_same_bits(const readback_vertex *a, const readback_vertex *b, uint32_t count, const char *what)
{
    for (uint32_t v = 0; v < count; v++) {
        if (memcmp(&a[v], &b[v], offsetof(readback_vertex, world)) != 0) {
            fail_msg("%s: vertex %u differs", what, v);
        }
    }
}

static void check_same_bits(const char *asset, const skin_options *options)
{
    fixture_skin_desc desc = desc_of(asset, NOH_PALETTE_UNIFORM);
    fixture_skin uniform, texture;
    test_random r = { 73 }, again = { 73 };
    desc.options = *options;
    desc.copies = COPIES;
    fixture_skin_open(&uniform, &desc);
    desc.mode = NOH_PALETTE_TEXTURE;
    fixture_skin_open(&texture, &desc);
    fixture_skin_pose(&uniform, &r);
    fixture_skin_pose(&texture, &again);
    for (uint32_t i = 0; i < texture.mesh_count; i++) {
        uint32_t count = texture.meshes[i].header->vertex_count;
        readback_vertex *crowd;
        for (uint32_t k = 0; k < COPIES; k++) {
            static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
            uint32_t instance = noh_gl_skin_instance(texture.skin, i, k);
            noh_gl_morph_binding morph = noh_gl_morph_binding_of(texture.morph.morph, instance);
            assert_int_equal(noh_gl_skin_set_place(texture.skin, instance, identity, &morph, NULL), NOH_OK);
        }
        noh_gl_skin_update(texture.skin);
        crowd = fixture_skin_read(&texture, i, 1, 0, COPIES - 1u); /* all but the first */
        for (uint32_t k = 1; k < COPIES; k++) {
            readback_vertex *a = fixture_skin_read(&uniform, i, k, 0, 0), *b = fixture_skin_read(&texture, i, k, 0, 0);
            expect_same_bits(a, b, count, "uniform and texture");
            expect_same_bits(b, crowd + (size_t)(k - 1u) * count, count, "one and many");
            free(a);
            free(b);
        }
        free(crowd);
    }
    fixture_skin_close(&uniform);
    fixture_skin_close(&texture);
    fixture_expect_no_errors();
}

static void uniform_texture_and_crowd_give_the_same_bits(void **state)
{
    skin_options plain, dual, split;
    (void)state;
    memset(&plain, 0, sizeof plain);
    dual = split = plain;
    dual.dual_quaternion = every_mesh;
    dual.dual_quaternion_count = 1;
    split.palette = 6;
    check_same_bits("hero/body_8inf.glb", &plain);
    check_same_bits("hero/body.glb", &split);
    check_same_bits("khronos/Fox.glb", &dual);
    check_same_bits("khronos/RobotExpressive.glb", &plain); /* rigid meshes too */
}

static void a_crowd_stands_where_it_was_placed(void **state)
{
    fixture_skin_desc desc = desc_of("khronos/Fox.glb", NOH_PALETTE_TEXTURE);
    fixture_skin f;
    test_random r = { 74 };
    readback_vertex *got;
    float worlds[3][12];
    (void)state;
    desc.copies = 3;
    fixture_skin_open(&f, &desc);
    fixture_skin_pose(&f, &r);
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t e = 0; e < 12; e++) {
            worlds[k][e] = e % 5 == 0 ? 2.0f : test_random_float(&r, -0.3f, 0.3f) * (e % 4 == 3 ? 100.0f : 1.0f);
        }
        assert_int_equal(noh_gl_skin_set_place(f.skin, k, worlds[k], NULL, NULL), NOH_OK);
    }
    noh_gl_skin_update(f.skin);
    got = fixture_skin_read(&f, 0, 0, 0, 3);
    for (uint32_t i = 0; i < 3 * f.meshes[0].header->vertex_count; i++) {
        const float *w = worlds[i / f.meshes[0].header->vertex_count], *p = got[i].position;
        for (unsigned c = 0; c < 3; c++) {
            float expected = w[4 * c] * p[0] + w[4 * c + 1] * p[1] + w[4 * c + 2] * p[2] + w[4 * c + 3];
            assert_true(fabsf(got[i].world[c] - expected) <= 1e-3f);
        }
    }
    free(got);
    fixture_skin_close(&f);
}

/* Instances scaled by another factor along each axis: their normals are perpendicular to the scaled surface, which
 * those transformed by the matrix itself would not be. */
static void normals_of_a_crowd_go_by_the_inverse_transpose(void **state)
{
    fixture_skin_desc desc = desc_of("khronos/Fox.glb", NOH_PALETTE_TEXTURE);
    static const float world[12] = { 0.4f, 0.3f, 0, 5, -0.2f, 2.0f, 0.1f, -3, 0, 0.5f, 1.2f, 1 };
    fixture_skin f;
    test_random r = { 75 };
    noh_vertex *expected;
    readback_vertex *got;
    float rows[12];
    double by_matrix = 0.0;
    (void)state;
    fixture_skin_open(&f, &desc);
    fixture_skin_pose(&f, &r);
    assert_int_equal(noh_gl_skin_set_place(f.skin, 0, world, NULL, NULL), NOH_OK);
    noh_gl_skin_update(f.skin);
    got = fixture_skin_read(&f, 0, 0, 0, 1);
    expected = fixture_skin_reference(&f, 0);
    for (int i = 0; i < 3; i++) { /* the cofactors, written out: the inverse transpose times the determinant */
        const float *a = world + 4 * ((i + 1) % 3), *b = world + 4 * ((i + 2) % 3);
        for (int c = 0; c < 3; c++) {
            rows[4 * i + c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
        }
    }
    for (uint32_t v = 0; v < f.meshes[0].header->vertex_count; v++) {
        double right[3], wrong[3], square[3] = { 0.0, 0.0, 0.0 }, near = 0.0, far = 0.0;
        for (int c = 0; c < 3; c++) {
            const float *n = expected[v].normal;
            right[c] = (double)(rows[4 * c] * n[0] + rows[4 * c + 1] * n[1] + rows[4 * c + 2] * n[2]);
            wrong[c] = (double)(world[4 * c] * n[0] + world[4 * c + 1] * n[1] + world[4 * c + 2] * n[2]);
            square[0] += right[c] * right[c];
            square[1] += wrong[c] * wrong[c];
            square[2] += (double)(got[v].normal[c] * got[v].normal[c]);
        }
        for (int c = 0; c < 3; c++) {
            near = fmax(near, fabs((double)got[v].normal[c] / sqrt(square[2]) - right[c] / sqrt(square[0])));
            far = fmax(far, fabs(wrong[c] / sqrt(square[1]) - right[c] / sqrt(square[0])));
        }
        assert_true(near < 1e-4);
        by_matrix = fmax(by_matrix, far);
    }
    assert_true(by_matrix > 0.5);
    free(expected);
    free(got);
    fixture_skin_close(&f);
}

/* ---- fewer influences ---- */

/* A vertex moved by its `drawn` strongest joints, weights scaled to a sum of 1, in double precision; without morphs. */
static void fewer(const noh_mesh *mesh, const float *matrices, uint32_t vertex, uint32_t drawn, double position[3])
{
    uint32_t joints[NOH_INFLUENCES_MAX];
    float weights[NOH_INFLUENCES_MAX];
    noh_vertex rest;
    double sum = 0.0;
    noh_mesh_influences(mesh, vertex, joints, weights);
    noh_mesh_vertex(mesh, vertex, &rest);
    for (uint32_t i = 0; i < drawn; i++) {
        sum += (double)weights[i];
    }
    for (uint32_t r = 0; r < 3; r++) {
        position[r] = 0.0;
        for (uint32_t i = 0; i < drawn; i++) {
            const float *m = matrices + 12u * (size_t)joints[i] + 4u * r;
            double at = (double)m[3];
            for (int c = 0; c < 3; c++) {
                at += (double)m[c] * (double)rest.position[c];
            }
            position[r] += (double)weights[i] / sum * at;
        }
    }
}

static void influences_can_be_capped(void **state)
{
    static const uint32_t caps[][2] = {
        { 1, 1 }, { 2, 2 }, { 3, 2 }, { 4, 4 }, { 7, 4 }, { 8, 8 }
    }; /* asked for, drawn */
    fixture_skin_desc desc = desc_of("hero/body_8inf.glb", NOH_PALETTE_TEXTURE);
    fixture_skin f;
    test_random r = { 75 };
    const float none[64] = { 0.0f };
    (void)state;
    fixture_skin_open(&f, &desc);
    fixture_skin_pose(&f, &r);
    fixture_set(&f.morph, 0, none);
    noh_gl_morph_update(f.morph.morph, NULL);
    for (size_t i = 0; i < TEST_COUNT(caps); i++) {
        readback_vertex *got = fixture_skin_read(&f, 0, 0, caps[i][0], 0);
        for (uint32_t v = 0; v < f.meshes[0].header->vertex_count; v++) {
            double expected[3];
            fewer(&f.meshes[0], f.matrices[0], v, caps[i][1], expected);
            for (int c = 0; c < 3; c++) {
                assert_true(fabs((double)got[v].position[c] - expected[c]) <= 4e-6); /* of 1.6 m */
            }
        }
        free(got);
    }
    fixture_skin_close(&f);
}

/* ---- pictures ---- */

#define SIDE 256u

typedef enum draw_kind { BIND_POSE, ALONE, CROWD } draw_kind;

/* Every copy of every mesh, side by side. */
static void draw_all(const fixture_skin *f, noh_gl_renderer *renderer, draw_kind kind, int pass)
{
    for (uint32_t i = 0; i < f->mesh_count; i++) {
        for (uint32_t k = 0; k < (kind == CROWD ? 1u : f->copies); k++) {
            const float world[12] = { 1, 0, 0, 0.7f * (float)k, 0, 1, 0, 0, 0, 0, 1, -0.1f * (float)k };
            uint32_t instance = noh_gl_skin_instance(f->skin, i, k);
            noh_gl_morph_binding morph = noh_gl_morph_binding_of(f->morph.morph, instance);
            noh_gl_skin_binding skin = noh_gl_skin_binding_of(f->skin, instance);
            if (kind == CROWD) {
                noh_gl_draw_crowd(renderer, &f->gl_meshes[i], &morph, &skin, f->copies, NULL, NULL, pass);
            } else {
                noh_gl_draw_mesh(renderer, &f->gl_meshes[i], world, &morph, kind == BIND_POSE ? NULL : &skin, NULL,
                                 NULL, pass);
            }
        }
    }
}

static void place_all(const fixture_skin *f)
{
    for (uint32_t i = 0; i < f->plan.instance_count; i++) {
        uint32_t k = i % f->copies;
        const float world[12] = { 1, 0, 0, 0.7f * (float)k, 0, 1, 0, 0, 0, 0, 1, -0.1f * (float)k };
        noh_gl_morph_binding morph = noh_gl_morph_binding_of(f->morph.morph, i);
        assert_int_equal(noh_gl_skin_set_place(f->skin, i, world, &morph, NULL), NOH_OK);
    }
    noh_gl_skin_update(f->skin);
}

/* From the front; rgba[SIDE][SIDE][4], to be freed. */
static uint8_t *picture(const fixture_skin *f, draw_kind kind)
{
    static const noh_gl_camera camera = { { 0.9f, 0, 0, 0, 0, 0.9f, 0, 0, 0, 0, -0.3f, 0, 0, -0.75f, 0, 1 },
                                          { 0, 0.8f, 9 },
                                          { 0.6f, 0, 0.8f } };
    const noh_gl_api *gl = &fixture_gpu()->gl;
    noh_gl_renderer_desc desc;
    noh_gl_renderer renderer;
    uint8_t *rgba;
    char log[4096];
    fixture_frame t;
    fixture_frame_open(&t, SIDE);
    memset(&desc, 0, sizeof desc);
    desc.meshes = f->meshes;
    desc.mesh_count = f->mesh_count;
    desc.palettes = f->plan.mode;
    desc.crowds = kind == CROWD;
    assert_int_equal(renderer_create(&(noh_gl_device){ gl, NULL, &t.ledger, log, sizeof log }, &desc, &renderer, NULL),
                     NOH_OK);
    noh_gl_draw_begin(&renderer, &camera);
    for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
        draw_all(f, &renderer, kind, pass);
    }
    noh_gl_draw_end(&renderer);
    rgba = fixture_frame_read(&t);
    noh_gl_renderer_delete(&renderer);
    fixture_frame_close(&t);
    return rgba;
}

static uint32_t drawn_pixels(const uint8_t *rgba)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        count += rgba[4 * i + 3] != 0;
    }
    return count;
}

static uint32_t differing_pixels(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        count += memcmp(a + 4 * i, b + 4 * i, 4) != 0;
    }
    return count;
}

static int largest_difference(const uint8_t *a, const uint8_t *b)
{
    int most = 0;
    for (uint32_t i = 0; i < 4u * SIDE * SIDE; i++) {
        const int d = a[i] > b[i] ? a[i] - b[i] : b[i] - a[i];
        most = d > most ? d : most;
    }
    return most;
}

static uint8_t *body_picture(uint32_t palette, noh_palette_mode mode, uint32_t *palettes)
{
    fixture_skin_desc desc = desc_of("hero/body.glb", mode);
    test_random r = { 76 };
    fixture_skin f;
    uint8_t *rgba;
    desc.options.palette = palette;
    fixture_skin_open(&f, &desc);
    *palettes = f.meshes[0].header->palette_count;
    fixture_skin_pose(&f, &r);
    rgba = picture(&f, ALONE);
    fixture_skin_close(&f);
    fixture_expect_no_errors();
    return rgba;
}

static void small_palettes_give_the_same_picture(void **state)
{
    static const uint32_t limits[] = { 20, 8, 6 };
    uint32_t palettes;
    uint8_t *whole = body_picture(0, NOH_PALETTE_UNIFORM, &palettes);
    (void)state;
    assert_int_equal(palettes, 1);
    assert_in_range(drawn_pixels(whole), SIDE * SIDE / 20, SIDE * SIDE);
    for (size_t i = 0; i < TEST_COUNT(limits); i++) {
        for (int mode = NOH_PALETTE_UNIFORM; mode <= NOH_PALETTE_TEXTURE; mode++) {
            uint8_t *parts = body_picture(limits[i], (noh_palette_mode)mode, &palettes);
            assert_true(palettes > 1);
            assert_int_equal(differing_pixels(parts, whole), 0);
            free(parts);
        }
    }
    free(whole);
}

static void check_crowd_picture(const char *asset, uint32_t palette)
{
    fixture_skin_desc desc = desc_of(asset, NOH_PALETTE_TEXTURE);
    test_random r = { 78 };
    fixture_skin f;
    uint8_t *one_by_one, *at_once;
    desc.copies = 3;
    desc.options.palette = palette;
    fixture_skin_open(&f, &desc);
    fixture_skin_pose(&f, &r);
    place_all(&f);
    one_by_one = picture(&f, ALONE);
    at_once = picture(&f, CROWD);
    assert_in_range(drawn_pixels(at_once), SIDE * SIDE / 20, SIDE * SIDE);
    assert_int_equal(differing_pixels(one_by_one, at_once), 0);
    free(one_by_one);
    free(at_once);
    fixture_skin_close(&f);
    fixture_expect_no_errors();
}

static void a_crowd_looks_like_its_instances(void **state)
{
    (void)state;
    check_crowd_picture("hero/body.glb", 0);
    check_crowd_picture("hero/body.glb", 8);
    check_crowd_picture("khronos/RobotExpressive.glb", 0);
}

static void draws_leave_the_state_that_they_say(void **state)
{
    static const GLenum bindings[] = { GL_CURRENT_PROGRAM, GL_VERTEX_ARRAY_BINDING, GL_UNIFORM_BUFFER_BINDING,
                                       GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY };
    (void)state;
    for (int mode = NOH_PALETTE_UNIFORM; mode <= NOH_PALETTE_TEXTURE; mode++) {
        fixture_skin_desc desc = desc_of("khronos/SimpleSkin.gltf", (noh_palette_mode)mode);
        const noh_gl_api *gl = &fixture_gpu()->gl;
        test_random r = { 79 };
        fixture_skin f;
        fixture_skin_open(&f, &desc);
        fixture_skin_pose(&f, &r);
        free(picture(&f, ALONE));
        for (GLenum unit = GL_TEXTURE0; unit <= GL_TEXTURE2; unit++) {
            gl->ActiveTexture(unit);
            for (size_t i = 0; i < TEST_COUNT(bindings); i++) {
                GLint value = -1;
                gl->GetIntegerv(bindings[i], &value);
                assert_int_equal(value, 0);
            }
        }
        gl->ActiveTexture(GL_TEXTURE0);
        assert_false(gl->IsEnabled(GL_BLEND) || gl->IsEnabled(GL_DEPTH_TEST) || gl->IsEnabled(GL_CULL_FACE));
        fixture_skin_close(&f);
    }
    fixture_expect_no_errors();
}

static void without_joints_stands_the_bind_pose(void **state)
{
    fixture_skin_desc desc = desc_of("hero/body.glb", NOH_PALETTE_UNIFORM);
    test_random r = { 77 };
    fixture_skin f;
    uint8_t *bind, *fresh, *posed;
    (void)state;
    desc.options.palette = 6;
    fixture_skin_open(&f, &desc);
    noh_gl_morph_update(f.morph.morph, NULL);
    noh_gl_skin_update(f.skin);
    fresh = picture(&f, ALONE); /* identities, from init */
    bind = picture(&f, BIND_POSE);
    fixture_skin_pose(&f, &r);
    posed = picture(&f, ALONE);
    assert_in_range(drawn_pixels(bind), SIDE * SIDE / 20, SIDE * SIDE);
    /* Identities round the last bit of a normal, which skin shows: its curvature is of derivatives. */
    assert_in_range(differing_pixels(bind, fresh), 0, 4);
    assert_in_range(largest_difference(bind, fresh), 0, 2);
    assert_in_range(differing_pixels(bind, posed), SIDE * SIDE / 40, SIDE * SIDE);
    free(bind);
    free(fresh);
    free(posed);
    fixture_skin_close(&f);
    fixture_expect_no_errors();
}

/* ---- meshes made here: two palettes of three and two joints, a rigid one, one with dual quaternions ---- */

#define MADE 3u

typedef struct made_meshes {
    noh_mesh_header headers[MADE];
    noh_palette palettes[2];
    noh_submesh submesh; /* without a material */
    uint16_t joints[5];
    noh_mesh meshes[MADE];
    uint32_t counts[MADE];
} made_meshes;

static void make_meshes(made_meshes *m)
{
    static const uint16_t joints[5] = { 0, 1, 3, 1, 2 };
    memset(m, 0, sizeof *m);
    m->submesh.material = NOH_NONE;
    m->palettes[0].joint_count = 3;
    m->palettes[1].first_joint = 3;
    m->palettes[1].joint_count = 2;
    memcpy(m->joints, joints, sizeof joints);
    for (uint32_t i = 0; i < MADE; i++) {
        m->meshes[i].header = &m->headers[i];
        m->meshes[i].palettes = m->palettes;
        m->meshes[i].palette_joints = m->joints;
        m->meshes[i].submeshes = &m->submesh;
        m->headers[i].submesh_count = 1;
        m->headers[i].palette_count = i == 1 ? 0 : 2;
        m->counts[i] = 1;
    }
    m->headers[2].flags = NOH_MESH_DUAL_QUATERNION;
}

static noh_gl_skin_desc made_desc(const made_meshes *m, noh_palette_mode mode)
{
    noh_gl_skin_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = m->meshes;
    desc.mesh_count = MADE;
    desc.instance_counts = m->counts;
    desc.mode = mode;
    return desc;
}

static void plans_choose_and_refuse(void **state)
{
    made_meshes m;
    noh_gl_skin_desc desc, bad;
    noh_gl_skin_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_caps caps;
    (void)state;
    memset(&caps, 0, sizeof caps);
    caps.texture_size_max = 2048;
    caps.uniform_block_bytes_max = 16384;
    caps.uniform_offset_align = 64;
    make_meshes(&m);
    desc = made_desc(&m, NOH_PALETTE_AUTO);
    assert_int_equal(noh_gl_skin_plan_make(&desc, &caps, &plan, &error), NOH_OK);
    assert_int_equal(plan.mode, NOH_PALETTE_UNIFORM);
    assert_int_equal(plan.texel_count, 12 + 8 + 12 + 8); /* 9, 6, 12 and 8 rows, each at a multiple of 4 */
    assert_int_equal(plan.gpu_bytes, 16 * 40 + 16384);
    strcpy(caps.renderer, "Mali-G52 r1 (Panfrost)");
    assert_int_equal(noh_gl_skin_plan_make(&desc, &caps, &plan, &error), NOH_OK);
    assert_int_equal(plan.mode, NOH_PALETTE_TEXTURE);
    assert_non_null(strstr(plan.reason, "cost this GPU less"));
    caps.renderer[0] = 0;
    caps.uniform_block_bytes_max = 16383; /* the one with dual quaternions no longer fits */
    assert_int_equal(noh_gl_skin_plan_make(&desc, &caps, &plan, &error), NOH_OK);
    assert_int_equal(plan.mode, NOH_PALETTE_TEXTURE);
    desc.mode = NOH_PALETTE_UNIFORM;
    assert_int_equal(noh_gl_skin_plan_make(&desc, &caps, &plan, &error), NOH_ERR_UNSUPPORTED);
    assert_int_equal(error.need, 16384);
    caps.uniform_block_bytes_max = 16384;
    m.counts[1] = 100; /* a crowd of rigid ones */
    desc.mode = NOH_PALETTE_AUTO;
    assert_int_equal(noh_gl_skin_plan_make(&desc, &caps, &plan, &error), NOH_OK);
    assert_int_equal(plan.mode, NOH_PALETTE_TEXTURE);
    assert_int_equal(plan.texel_count, 102 * 4 + 15 + 20);
    assert_int_equal(plan.gpu_bytes, 16 * plan.width * plan.height);
    assert_in_range(plan.width * plan.height, plan.texel_count, plan.texel_count + plan.width - 1);
    m.counts[0] = NOH_MORPH_INSTANCES_MAX;
    assert_int_equal(noh_gl_skin_plan_make(&desc, &caps, &plan, &error), NOH_ERR_LIMIT);
    m.counts[0] = 1;
    m.counts[1] = 60000;
    caps.texture_size_max = 256;
    assert_int_equal(noh_gl_skin_plan_make(&desc, &caps, &plan, &error), NOH_ERR_LIMIT);
    bad = desc;
    bad.mesh_count = 0;
    assert_int_equal(noh_gl_skin_plan_make(&bad, &caps, &plan, &error), NOH_ERR_ARG);
    bad = desc;
    bad.mode = (noh_palette_mode)3;
    assert_int_equal(noh_gl_skin_plan_make(&bad, &caps, &plan, &error), NOH_ERR_ARG);
}

static void memory_is_exact(void **state)
{
    gpu *g = fixture_gpu();
    made_meshes m;
    (void)state;
    make_meshes(&m);
    for (int mode = NOH_PALETTE_UNIFORM; mode <= NOH_PALETTE_TEXTURE; mode++) {
        noh_gl_skin_desc desc = made_desc(&m, (noh_palette_mode)mode);
        noh_gl_skin_plan plan;
        noh_gl_skin *skin = NULL;
        noh_gl_ledger ledger;
        noh_error error = { NOH_OK, "", 0, 0 };
        uint8_t *memory;
        size_t bytes;
        memset(&ledger, 0, sizeof ledger);
        assert_int_equal(noh_gl_skin_plan_make(&desc, &g->caps, &plan, NULL), NOH_OK);
        bytes = (size_t)plan.cpu_bytes;
        memory = test_aligned(NULL, bytes + 64);
        memset(memory, 0xa5, bytes + 64);
        assert_int_equal(noh_gl_skin_init(memory, bytes - 1, &(noh_gl_device){ &g->gl, &g->caps, &ledger, NULL, 0 },
                                          &desc, &skin, &error),
                         NOH_ERR_MEMORY);
        assert_int_equal(error.need, bytes);
        for (size_t i = 0; i < bytes + 64; i++) {
            assert_int_equal(memory[i], 0xa5);
        }
        assert_int_equal(noh_gl_skin_init(memory + 1, bytes, &(noh_gl_device){ &g->gl, &g->caps, &ledger, NULL, 0 },
                                          &desc, &skin, &error),
                         NOH_ERR_ARG);
        assert_int_equal(noh_gl_skin_init(memory, bytes, &(noh_gl_device){ &g->gl, &g->caps, &ledger, NULL, 0 }, &desc,
                                          &skin, &error),
                         NOH_OK);
        assert_true(noh_gl_ledger_bytes(&ledger) == plan.gpu_bytes);
        noh_gl_skin_update(skin);
        assert_true(noh_gl_ledger_bytes(&ledger) == plan.gpu_bytes);
        for (size_t i = bytes; i < bytes + 64; i++) {
            assert_int_equal(memory[i], 0xa5);
        }
        noh_gl_skin_delete(skin);
        assert_true(noh_gl_ledger_bytes(&ledger) == 0 && ledger.buffers + ledger.textures == 0);
        free(memory);
    }
    fixture_expect_no_errors();
}

/* ---- what is sent ---- */

static struct {
    unsigned calls;
    GLintptr first;
    GLsizeiptr bytes;
} sent;

static void GL_APIENTRY note_buffer(GLenum target, GLintptr offset, GLsizeiptr size, const void *data)
{
    (void)target;
    (void)data;
    sent.calls++;
    sent.first = offset;
    sent.bytes = size;
}

static void GL_APIENTRY note_texture(GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                                     GLenum format, GLenum type, const void *data)
{
    (void)target;
    (void)level;
    (void)x;
    (void)format;
    (void)type;
    (void)data;
    sent.calls++;
    sent.first = y * width * 16;
    sent.bytes = width * height * 16;
}

static noh_gl_skin *noted_skin(noh_gl_api *api, noh_gl_ledger *ledger, made_meshes *m, noh_palette_mode mode,
                               void **memory, noh_gl_skin_plan *plan)
{
    gpu *g = fixture_gpu();
    noh_gl_skin_desc desc;
    noh_gl_skin *skin = NULL;
    *api = g->gl;
    api->BufferSubData = note_buffer;
    api->TexSubImage2D = note_texture;
    memset(ledger, 0, sizeof *ledger);
    make_meshes(m);
    m->counts[1] = 30;
    desc = made_desc(m, mode);
    assert_int_equal(noh_gl_skin_plan_make(&desc, &g->caps, plan, NULL), NOH_OK);
    *memory = test_aligned(NULL, (size_t)plan->cpu_bytes);
    assert_int_equal(noh_gl_skin_init(*memory, (size_t)plan->cpu_bytes,
                                      &(noh_gl_device){ api, &g->caps, ledger, NULL, 0 }, &desc, &skin, NULL),
                     NOH_OK);
    return skin;
}

static void expect_sent(unsigned calls, uint64_t first, uint64_t bytes)
{
    assert_int_equal(sent.calls, calls);
    if (calls) {
        assert_int_equal(sent.first, first);
        assert_int_equal(sent.bytes, bytes);
    }
    sent.calls = 0;
}

/* The later of two settings may lie in front of the earlier one: the span covers both. */
static void changes_in_any_order_are_sent(void **state)
{
    static const noh_palette_mode modes[2] = { NOH_PALETTE_UNIFORM, NOH_PALETTE_TEXTURE };
    (void)state;
    for (int i = 0; i < 2; i++) {
        fixture_skin_desc desc = desc_of("khronos/Fox.glb", modes[i]);
        fixture_skin f;
        test_random r = { 76 };
        float *swap;
        desc.copies = 2;
        fixture_skin_open(&f, &desc);
        fixture_skin_pose(&f, &r);
        swap = f.matrices[0];
        f.matrices[0] = f.matrices[1];
        f.matrices[1] = swap;
        for (uint32_t k = 2; k-- > 0;) {
            noh_gl_skin_set_matrices(f.skin, k, f.matrices[k]);
        }
        noh_gl_skin_update(f.skin);
        for (uint32_t k = 0; k < 2; k++) {
            noh_vertex *expected = fixture_skin_reference(&f, k);
            readback_vertex *got = fixture_skin_read(&f, 0, k, 0, 0);
            const fixture_error e = fixture_skin_compare(got, expected, f.meshes[0].header->vertex_count);
            fixture_expect_close(&e, "after a change in falling order");
            free(got);
            free(expected);
        }
        fixture_skin_close(&f);
    }
}

static void only_changes_are_sent(void **state)
{
    noh_gl_api api;
    noh_gl_ledger ledger;
    noh_gl_skin_plan plan;
    made_meshes m;
    void *memory;
    float matrices[4][12];
    noh_gl_skin *skin = noted_skin(&api, &ledger, &m, NOH_PALETTE_UNIFORM, &memory, &plan);
    noh_gl_skin_binding binding = noh_gl_skin_binding_of(skin, 0);
    uint32_t first, last;
    (void)state;
    noh_gl_skin_update(skin);
    expect_sent(1, 0, 16u * plan.texel_count); /* a new buffer holds nothing: all of it */
    noh_gl_skin_update(skin);
    expect_sent(0, 0, 0);
    for (uint32_t j = 0; j < 4; j++) {
        for (uint32_t e = 0; e < 12; e++) {
            matrices[j][e] = e % 5 == 0 ? 1.0f : 0.0f; /* the identity, which is there already */
        }
    }
    noh_gl_skin_set_matrices(skin, 0, matrices[0]);
    noh_gl_skin_set_matrices(skin, 1, matrices[0]); /* rigid: nothing */
    noh_gl_skin_update(skin);
    expect_sent(0, 0, 0);
    matrices[1][3] = 7.0f; /* the second of the first palette, the first of the second */
    noh_gl_skin_set_matrices(skin, 0, matrices[0]);
    noh_gl_skin_update(skin);
    expect_sent(1, 16u * 3u,
                16u * noh_gl_palette_row(&binding, &m.meshes[0], 1)); /* rows 3 to 5, and to the next's 0 to 2 */
    assert_int_equal(noh_gl_skin_write_matrices(skin, 0, matrices[0]), 0);
    matrices[1][3] = 8.0f;
    assert_int_equal(noh_gl_skin_write_matrices(skin, 0, matrices[0]), 1);
    noh_gl_skin_update(skin);
    expect_sent(0, 0, 0); /* not before it is touched */
    noh_gl_skin_touch(skin, 0);
    noh_gl_skin_update(skin);
    expect_sent(1, 16u * binding.first, 16u * binding.stride);
    noh_gl_skin_delete(skin);
    free(memory);

    skin = noted_skin(&api, &ledger, &m, NOH_PALETTE_TEXTURE, &memory, &plan);
    noh_gl_skin_update(skin);
    expect_sent(1, 0, plan.gpu_bytes);
    binding = noh_gl_skin_binding_of(skin, noh_gl_skin_instance(skin, 2, 0)); /* the same, but of four rows a joint */
    first = (binding.first + noh_gl_palette_row(&binding, &m.meshes[2], 0) + 4u) / plan.width;
    last = (binding.first + noh_gl_palette_row(&binding, &m.meshes[2], 1) + 3u) / plan.width;
    assert_true(first > 0);
    noh_gl_skin_set_matrices(skin, noh_gl_skin_instance(skin, 2, 0), matrices[0]);
    noh_gl_skin_update(skin);
    expect_sent(1, 16u * plan.width * first, 16u * plan.width * (last + 1u - first)); /* whole rows of texels */
    noh_gl_skin_delete(skin);
    free(memory);
    fixture_expect_no_errors();
}

static void places_are_refused_where_they_cannot_be(void **state)
{
    static const float mirror[12] = { -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 },
                       identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    noh_gl_api api;
    noh_gl_ledger ledger;
    noh_gl_skin_plan plan;
    made_meshes m;
    void *memory;
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_skin *skin = noted_skin(&api, &ledger, &m, NOH_PALETTE_UNIFORM, &memory, &plan);
    (void)state;
    assert_int_equal(noh_gl_skin_set_place(skin, 0, identity, NULL, &error), NOH_ERR_UNSUPPORTED);
    noh_gl_skin_delete(skin);
    free(memory);
    skin = noted_skin(&api, &ledger, &m, NOH_PALETTE_TEXTURE, &memory, &plan);
    assert_int_equal(noh_gl_skin_set_place(skin, 5, mirror, NULL, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 5);
    assert_int_equal(noh_gl_skin_set_place(skin, 5, identity, NULL, &error), NOH_OK);
    noh_gl_skin_delete(skin);
    free(memory);
}

/* ---- renderers ---- */

static void renderers_make_what_they_were_told_of(void **state)
{
    gpu *g = fixture_gpu();
    made_meshes m;
    noh_gl_ledger ledger;
    noh_gl_renderer_desc desc;
    noh_gl_renderer r;
    noh_gl_skin_binding skin = { .mode = NOH_PALETTE_TEXTURE };
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    (void)state;
    memset(&ledger, 0, sizeof ledger);
    memset(&desc, 0, sizeof desc);
    make_meshes(&m);
    m.headers[0].influence_count = m.headers[2].influence_count = 4;
    desc.meshes = m.meshes;
    desc.mesh_count = MADE;
    desc.crowds = 1;
    assert_int_equal(renderer_create(&(noh_gl_device){ &g->gl, NULL, &ledger, log, sizeof log }, &desc, &r, &error),
                     NOH_ERR_ARG);
    desc.palettes = NOH_PALETTE_TEXTURE;
    desc.fewer_influences = 1;
    assert_int_equal(renderer_create(&(noh_gl_device){ &g->gl, NULL, &ledger, log, sizeof log }, &desc, &r, &error),
                     NOH_OK);
    assert_int_equal(
        r.variant_count,
        14); /* the bind pose, and 4, 2, 1 joints by matrices and by dual quaternions; alone and in crowds */
    assert_int_equal(ledger.programs, 14);
    assert_true(noh_gl_ledger_bytes(&ledger) == NOH_GL_RENDERER_BYTES);
    skin.influences = 3;
    assert_non_null(noh_gl_renderer_variant(&r, noh_gl_variant_key_of(&m.meshes[2], &skin, 1, 0, NOH_VIEW_LIT)));
    assert_null(noh_gl_renderer_variant(&r, noh_gl_variant_key_of(&m.meshes[2], &skin, 1, 1, NOH_VIEW_LIT)));
    m.headers[0].flags = NOH_MESH_TEXELS;
    assert_null(noh_gl_renderer_variant(&r, noh_gl_variant_key_of(&m.meshes[0], &skin, 0, 0, NOH_VIEW_LIT)));
    noh_gl_renderer_delete(&r);
    assert_int_equal(ledger.programs, 0);
    fixture_expect_no_errors();
}

/* WebGL wants a program's uniform block bound even if nothing reads it, so a program without joints has none; and
 * encoding is a define of its own. */
static void rigid_variants_have_no_palettes(void **state)
{
    gpu *g = fixture_gpu();
    made_meshes m;
    noh_gl_ledger ledger;
    noh_gl_renderer_desc desc;
    noh_gl_renderer r;
    noh_gl_skin_binding skin = { .mode = NOH_PALETTE_UNIFORM };
    const noh_gl_variant *rigid, *skinned;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    (void)state;
    memset(&ledger, 0, sizeof ledger);
    memset(&desc, 0, sizeof desc);
    make_meshes(&m);
    m.headers[0].influence_count = 4;
    desc.meshes = m.meshes;
    desc.mesh_count = 1;
    desc.palettes = NOH_PALETTE_UNIFORM;
    desc.encode_srgb = 1;
    assert_int_equal(renderer_create(&(noh_gl_device){ &g->gl, NULL, &ledger, log, sizeof log }, &desc, &r, &error),
                     NOH_OK);
    rigid = noh_gl_renderer_variant(&r, noh_gl_variant_key_of(&m.meshes[0], NULL, 0, 0, NOH_VIEW_LIT));
    skinned = noh_gl_renderer_variant(&r, noh_gl_variant_key_of(&m.meshes[0], &skin, 0, 0, NOH_VIEW_LIT));
    assert_true(rigid->key.encode_srgb && skinned->key.encode_srgb);
    assert_true(g->gl.GetUniformBlockIndex(rigid->program, "noh_palette_block") == GL_INVALID_INDEX);
    assert_true(g->gl.GetUniformBlockIndex(skinned->program, "noh_palette_block") == 0);
    noh_gl_renderer_delete(&r);
    fixture_expect_no_errors();
}

static const struct CMUnitTest tests[] = { cmocka_unit_test(every_asset_equals_the_cpu),
                                           cmocka_unit_test(every_number_of_influences_equals_the_cpu),
                                           cmocka_unit_test(dual_quaternions_equal_the_cpu),
                                           cmocka_unit_test(mirrors_and_lost_axes),
                                           cmocka_unit_test(uniform_texture_and_crowd_give_the_same_bits),
                                           cmocka_unit_test(a_crowd_stands_where_it_was_placed),
                                           cmocka_unit_test(normals_of_a_crowd_go_by_the_inverse_transpose),
                                           cmocka_unit_test(influences_can_be_capped),
                                           cmocka_unit_test(small_palettes_give_the_same_picture),
                                           cmocka_unit_test(a_crowd_looks_like_its_instances),
                                           cmocka_unit_test(draws_leave_the_state_that_they_say),
                                           cmocka_unit_test(without_joints_stands_the_bind_pose),
                                           cmocka_unit_test(plans_choose_and_refuse),
                                           cmocka_unit_test(memory_is_exact),
                                           cmocka_unit_test(changes_in_any_order_are_sent),
                                           cmocka_unit_test(only_changes_are_sent),
                                           cmocka_unit_test(places_are_refused_where_they_cannot_be),
                                           cmocka_unit_test(renderers_make_what_they_were_told_of),
                                           cmocka_unit_test(rigid_variants_have_no_palettes) };

TEST_MAIN(tests, NULL, fixture_tear_down)
