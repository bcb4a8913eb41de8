/* Normals of nodes with unequal scales, against closed forms in double precision: the result of noh_gl_normal_rows,
 * what leaves the vertex shader for a mesh drawn alone and in a crowd, and the colour of pixels in the middle of
 * triangles, where the interpolated normal is not unit. */
#include "support/gl_fixture.h"
#include "support/renderer.h"

#include "gl/draw/gl_skin_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 5u /* pixels across a picture; only the middle one counts */

/* ---- closed forms ---- */

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int c = 0; c < 3; c++) v[c] /= length;
}

/* The inverse transpose by Gauss-Jordan elimination: without cofactors, to share nothing with the code under test. */
static void inverse_transpose(const float world[12], double out[3][3])
{
    double m[3][6];
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            m[r][c] = (double)world[4 * r + c];
            m[r][3 + c] = r == c;
        }
    }
    for (int p = 0; p < 3; p++) {
        int best = p;
        for (int r = p + 1; r < 3; r++) best = fabs(m[r][p]) > fabs(m[best][p]) ? r : best;
        for (int c = 0; c < 6; c++) {
            const double t = m[p][c];
            m[p][c] = m[best][c];
            m[best][c] = t;
        }
        for (int r = 0; r < 3; r++) {
            const double by = r == p ? 1.0 - 1.0 / m[p][p] : m[r][p] / m[p][p];
            for (int c = 5; c >= 0; c--) m[r][c] -= by * m[p][c];
        }
    }
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) out[r][c] = m[c][3 + r];
    }
}

/* A rotation about an axis, then unequal scales, then another rotation: right angles do not stay right. */
static void random_world(test_random *r, int mirror, float world[12])
{
    float q[2][4], scale[3];
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 4; c++) q[i][c] = test_random_float(r, -1.0f, 1.0f);
        noh_quat_normalize(q[i]);
    }
    for (int c = 0; c < 3; c++) scale[c] = test_random_float(r, 0.3f, 3.0f);
    scale[1] = mirror ? -scale[1] : scale[1];
    for (int c = 0; c < 3; c++) {
        float v[3] = { 0.0f, 0.0f, 0.0f };
        v[c] = 1.0f;
        noh_quat_rotate(q[0], v, v);
        for (int k = 0; k < 3; k++) v[k] *= scale[k];
        noh_quat_rotate(q[1], v, v);
        for (int k = 0; k < 3; k++) world[4 * k + c] = v[k];
    }
    for (int k = 0; k < 3; k++) world[4 * k + 3] = test_random_float(r, -2.0f, 2.0f);
}

static void normal_rows_are_the_inverse_transpose(void **state)
{
    test_random r = test_random_from(81);
    (void)state;
    for (int i = 0; i < 200; i++) {
        float world[12], rows[12], determinant;
        double expected[3][3];
        random_world(&r, i % 2, world);
        inverse_transpose(world, expected);
        determinant = noh_gl_normal_rows(world, rows);
        assert_true(i % 2 ? determinant < 0.0f : determinant > 0.0f);
        for (int k = 0; k < 3; k++) { /* equal up to a positive factor, |determinant| */
            for (int c = 0; c < 3; c++) {
                assert_true(fabs((double)rows[4 * k + c] - expected[k][c] * fabs((double)determinant)) < 2e-5);
            }
            assert_true(rows[4 * k + 3] == 0.0f);
        }
    }
}

/* ---- a mesh ---- */

typedef struct stage {
    gpu *g;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_gl_ledger ledger;
    noh_gl_mesh gl_mesh;
    void *memory;
    noh_gl_skin *skin; /* places of a crowd */
} stage;

static const float base_color[3] = { 0.8f, 0.45f, 0.3f };
#define METALLIC 0.25f
#define ROUGHNESS 0.45f

static void open_stage(stage *st)
{
    const test_model_desc desc = { 1, 9, 0, 0, 5 };
    static const uint32_t copies = 3;
    noh_gl_skin_desc skin;
    noh_gl_skin_plan plan;
    size_t count;
    model *m = test_model(&desc);
    memset(st, 0, sizeof *st);
    m->material_count = 1;
    m->materials = test_zeros(sizeof *m->materials);
    m->materials[0] = model_material_default();
    m->materials[0].name = test_zeros(5);
    memcpy(m->materials[0].name, "clay", 4);
    memcpy(m->materials[0].base_color, base_color, sizeof base_color);
    m->materials[0].base_color[3] = 1.0f;
    m->materials[0].base_color_texture = MODEL_NONE;
    m->materials[0].metallic = METALLIC;
    m->materials[0].roughness = ROUGHNESS;
    m->materials[0].alpha = MODEL_ALPHA_OPAQUE;
    m->meshes[0].submeshes[0].material = 0;
    st->g = fixture_gpu();
    st->bytes = test_pack_of(m, &count, NULL);
    model_free(m);
    st->pack = test_open(st->bytes, count);
    st->mesh = test_mesh(&st->pack, 0);
    assert_int_equal(noh_gl_mesh_create(&st->g->gl, &st->ledger, &st->mesh, &st->gl_mesh, NULL), NOH_OK);
    memset(&skin, 0, sizeof skin);
    skin.meshes = &st->mesh;
    skin.mesh_count = 1;
    skin.instance_counts = &copies;
    skin.mode = NOH_PALETTE_TEXTURE;
    assert_int_equal(noh_gl_skin_plan_make(&skin, &st->g->caps, &plan, NULL), NOH_OK);
    st->memory = test_aligned(NULL, (size_t)plan.cpu_bytes);
    assert_int_equal(noh_gl_skin_init(st->memory, (size_t)plan.cpu_bytes,
                                      &(noh_gl_device){ &st->g->gl, &st->g->caps, &st->ledger, NULL, 0 }, &skin,
                                      &st->skin, NULL),
                     NOH_OK);
}

static void close_stage(stage *st)
{
    noh_gl_skin_delete(st->skin);
    noh_gl_mesh_delete(&st->g->gl, &st->ledger, &st->gl_mesh);
    assert_true(noh_gl_ledger_bytes(&st->ledger) == 0);
    free(st->memory);
    free(st->bytes);
    fixture_expect_no_errors();
}

/* The corners of a triangle in the world: positions, and normals by the inverse transpose, not unit. */
typedef struct corner {
    double position[3], normal[3];
} corner;

static void corners_of(const stage *st, const float world[12], uint32_t triangle, corner out[3])
{
    double rows[3][3];
    const float determinant = noh_gl_normal_rows(world, (float[12]){ 0 });
    inverse_transpose(world, rows);
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t at = 3u * triangle + k;
        noh_vertex v;
        noh_mesh_vertex(&st->mesh, ((const uint16_t *)st->mesh.indices)[at], &v);
        for (int r = 0; r < 3; r++) {
            out[k].position[r] = (double)world[4 * r + 3];
            out[k].normal[r] = 0.0;
            for (int c = 0; c < 3; c++) {
                out[k].position[r] += (double)world[4 * r + c] * (double)v.position[c];
                out[k].normal[r] += rows[r][c] * (double)v.normal[c] * fabs((double)determinant);
            }
        }
    }
}

/* A camera that looks along the triangle's own normal at the point with these barycentric coordinates. The projection
 * is parallel, so at that point the interpolated values are the sums weighted by them. */
static const double shares[3] = { 0.5, 0.3, 0.2 };

static noh_gl_camera camera_at(const corner t[3], double point[3])
{
    noh_gl_camera camera;
    double a[3], b[3], n[3], u[3], v[3];
    for (int c = 0; c < 3; c++) {
        a[c] = t[1].position[c] - t[0].position[c];
        b[c] = t[2].position[c] - t[0].position[c];
        point[c] = shares[0] * t[0].position[c] + shares[1] * t[1].position[c] + shares[2] * t[2].position[c];
    }
    cross(a, b, n);
    unit(n);
    memcpy(u, a, sizeof u);
    unit(u);
    cross(n, u, v);
    memset(&camera, 0, sizeof camera);
    for (int c = 0; c < 3; c++) {
        const double along = sqrt(dot(a, a)), zoom = 8.0 / along;
        camera.view_projection[4 * c + 0] = (float)(zoom * u[c]);
        camera.view_projection[4 * c + 1] = (float)(zoom * v[c]);
        camera.view_projection[4 * c + 2] = (float)(-0.02 * n[c]);
        camera.view_projection[12] -= (float)(zoom * u[c] * point[c]);
        camera.view_projection[13] -= (float)(zoom * v[c] * point[c]);
        camera.view_projection[14] += (float)(0.02 * n[c] * point[c]);
        camera.eye[c] = (float)(point[c] + 1.5 * n[c] + 0.4 * u[c] - 0.3 * v[c]);
        camera.key[c] = (float)(0.8 * n[c] + 0.6 * u[c]);
    }
    camera.view_projection[15] = 1.0f;
    return camera;
}

/* The normal there: the weighted sum, made unit. */
static void normal_at(const corner t[3], double n[3])
{
    for (int c = 0; c < 3; c++)
        n[c] = shares[0] * t[0].normal[c] + shares[1] * t[1].normal[c] + shares[2] * t[2].normal[c];
    unit(n);
}

static void middle_pixel(stage *st, noh_debug_view view, const float world[12], int crowd, const noh_gl_camera *camera,
                         uint8_t rgb[3])
{
    noh_gl_renderer_desc desc;
    noh_gl_renderer renderer;
    fixture_frame frame;
    char log[4096];
    uint8_t *rgba;
    memset(&desc, 0, sizeof desc);
    desc.view = view;
    desc.meshes = &st->mesh;
    desc.mesh_count = 1;
    desc.palettes = NOH_PALETTE_TEXTURE;
    desc.crowds = 1;
    assert_int_equal(
        renderer_create(&(noh_gl_device){ &st->g->gl, NULL, &st->ledger, log, sizeof log }, &desc, &renderer, NULL),
        NOH_OK);
    fixture_frame_open(&frame, SIDE);
    noh_gl_draw_begin(&renderer, camera);
    if (crowd) {
        noh_gl_skin_binding first = noh_gl_skin_binding_of(st->skin, 0);
        static const float away[12] = { 1, 0, 0, 900, 0, 1, 0, 900, 0, 0, 1, 900 };
        for (uint32_t k = 0; k < 3; k++)
            assert_int_equal(noh_gl_skin_set_place(st->skin, k, k == 1 ? world : away, NULL, NULL), NOH_OK);
        noh_gl_skin_update(st->skin);
        noh_gl_draw_crowd(&renderer, &st->gl_mesh, NULL, &first, 3, NULL, NULL, NOH_DRAW_OPAQUE);
    } else {
        noh_gl_draw_mesh(&renderer, &st->gl_mesh, world, NULL, NULL, NULL, NULL, NOH_DRAW_OPAQUE);
    }
    noh_gl_draw_end(&renderer);
    rgba = fixture_frame_read(&frame);
    memcpy(rgb, rgba + 4u * (SIDE * SIDE / 2u), 3);
    assert_int_equal(rgba[4u * (SIDE * SIDE / 2u) + 3u], 255); /* something was drawn there */
    free(rgba);
    fixture_frame_close(&frame);
    noh_gl_renderer_delete(&renderer);
}

static void expect_rgb(const uint8_t got[3], const double expected[3], const char *what, int round)
{
    for (int c = 0; c < 3; c++) {
        const double want = 255.0 * fmin(fmax(expected[c], 0.0), 1.0);
        if (fabs((double)got[c] - want) > 1.5)
            fail_msg("%s %d, channel %d: %u, not %.1f", what, round, c, (unsigned)got[c], want);
    }
}

/* ---- what leaves the vertex shader, seen as colours ---- */

static uint32_t triangle_count(const stage *st)
{
    return st->mesh.submeshes[0].index_count / 3u;
}

static void normals_of_nodes_with_unequal_scales(void **state)
{
    test_random r = test_random_from(82);
    stage st;
    (void)state;
    open_stage(&st);
    for (int round = 0; round < 24; round++) {
        const int crowd = round % 3 == 2, mirror = round % 3 == 1;
        float world[12];
        corner t[3];
        double n[3], point[3], color[3];
        noh_gl_camera camera;
        uint8_t rgb[3];
        random_world(&r, mirror, world);
        corners_of(&st, world, test_random_below(&r, triangle_count(&st)), t);
        if (mirror) { /* seen from its front, which is on the other side now */
            const corner swap = t[1];
            t[1] = t[2];
            t[2] = swap;
        }
        camera = camera_at(t, point);
        normal_at(t, n);
        for (int c = 0; c < 3; c++) color[c] = pow(n[c] * 0.5 + 0.5, 2.2);
        middle_pixel(&st, NOH_VIEW_NORMAL, world, crowd, &camera, rgb);
        expect_rgb(rgb, color, crowd ? "crowd" : mirror ? "mirrored" : "alone", round);
    }
    close_stage(&st);
}

/* ---- one shaded pixel ---- */

static double at_least(double x, double least)
{
    return x > least ? x : least;
}

/* The light of mesh.frag, from its description: wrapped key light, sky and ground, GGX (Walter et al. 2007) with
 * Schlick's Fresnel term and visibility, a rim. */
static void shaded(const double n[3], const double point[3], const noh_gl_camera *camera, double color[3])
{
    static const double key_color[3] = { 1.02, 0.98, 0.92 }, ground[3] = { 0.23, 0.20, 0.18 },
                        zenith[3] = { 0.50, 0.54, 0.60 };
    const double rough = (double)ROUGHNESS, metal = (double)METALLIC, a = rough * rough, k = 0.5 * a;
    double key[3], view[3], half[3], nl, nv, nh, hv, wrapped, d, specular;
    for (int c = 0; c < 3; c++) {
        key[c] = (double)camera->key[c];
        view[c] = (double)camera->eye[c] - point[c];
    }
    unit(view);
    for (int c = 0; c < 3; c++) half[c] = key[c] + view[c];
    unit(half);
    nl = at_least(dot(n, key), 0.0);
    nv = at_least(dot(n, view), 1e-3);
    nh = at_least(dot(n, half), 0.0);
    hv = at_least(dot(half, view), 0.0);
    wrapped = at_least((dot(n, key) + 0.18) / 1.18, 0.0);
    d = nh * nh * (a * a - 1.0) + 1.0;
    specular = a * a / (3.14159265358979 * d * d) * 0.25 / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
    for (int c = 0; c < 3; c++) {
        const double albedo = (double)base_color[c], f0 = 0.04 + (albedo - 0.04) * metal;
        const double sky = ground[c] + (zenith[c] - ground[c]) * (n[1] * 0.5 + 0.5);
        color[c] = albedo * (1.0 - metal) * (key_color[c] * wrapped * wrapped + 0.62 * sky);
        color[c] += (f0 + (1.0 - f0) * pow(1.0 - hv, 5.0)) * specular * nl * 2.6;
        color[c] += f0 * sky * (0.7 - 0.4 * rough) * (0.15 + 0.85 * metal);
        color[c] += 0.10 * sky * pow(1.0 - nv, 3.0) * (1.0 - 0.6 * rough);
    }
}

static void a_shaded_pixel_has_its_closed_form(void **state)
{
    test_random r = test_random_from(83);
    stage st;
    (void)state;
    open_stage(&st);
    for (int round = 0; round < 16; round++) {
        float world[12];
        corner t[3];
        double n[3], point[3], color[3];
        noh_gl_camera camera;
        uint8_t rgb[3];
        random_world(&r, 0, world);
        corners_of(&st, world, test_random_below(&r, triangle_count(&st)), t);
        camera = camera_at(t, point);
        normal_at(t, n);
        shaded(n, point, &camera, color);
        middle_pixel(&st, NOH_VIEW_LIT, world, round % 2, &camera, rgb);
        expect_rgb(rgb, color, "shaded", round);
    }
    close_stage(&st);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal_rows_are_the_inverse_transpose),
        cmocka_unit_test(normals_of_nodes_with_unequal_scales),
        cmocka_unit_test(a_shaded_pixel_has_its_closed_form),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
