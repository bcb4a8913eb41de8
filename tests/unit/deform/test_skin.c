/* Skinning on the CPU: SIMD against scalar, weights, palettes, normals, dual quaternions. */
#include "support/skin_asset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/math_internal.h"
#include "convert/clips/model_clips.h"
#include "convert/pack/pack_clips.h"
#include "deform/skin/skin_internal.h"
#include "noh/low_core.h"

typedef struct made {
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_skin skin;
    noh_skeleton skeleton;
    float *matrices;
    model *m;
} made;

static made make(const skin_cylinder *c, const skin_options *options)
{
    made x;
    size_t count;
    x.m = skin_cylinder_model(c);
    x.bytes = skin_pack_of(x.m, options, 1.0f, &count, NULL);
    x.pack = test_open(x.bytes, count);
    x.mesh = test_mesh(&x.pack, 0);
    assert_int_equal(noh_pack_skin_at(&x.pack, x.mesh.header->skin, &x.skin, NULL), NOH_OK);
    assert_int_equal(noh_pack_skeleton_at(&x.pack, x.skin.header->skeleton, &x.skeleton, NULL, NULL), NOH_OK);
    x.matrices = test_zeros(48u * (size_t)x.skin.header->joint_count);
    return x;
}

static void unmake(made *x)
{
    free(x->matrices);
    free(x->bytes);
    model_free(x->m);
}

/* ---- SIMD ---- */

typedef void (*skin_function)(const noh_mesh *, const float *, const noh_morph_layers *, uint32_t, uint32_t, float *,
                              float *, float *);

#if defined(__x86_64__)
void noh_skin_vertices_sse2(const noh_mesh *, const float *, const noh_morph_layers *, uint32_t, uint32_t, float *,
                            float *, float *);
void noh_skin_vertices_avx2(const noh_mesh *, const float *, const noh_morph_layers *, uint32_t, uint32_t, float *,
                            float *, float *);
#endif

#define GUARD 8u

static void compare_range(const made *x, skin_function function, const noh_morph_layers *layers, uint32_t first,
                          uint32_t count)
{
    const uint32_t sizes[3] = { 3, 3, 4 };
    float *out[3], *expected[3];
    for (int k = 0; k < 3; k++) {
        out[k] = test_zeros(4u * ((size_t)sizes[k] * count + GUARD));
        expected[k] = test_zeros(4u * ((size_t)sizes[k] * count + GUARD));
        memset(out[k] + sizes[k] * count, 0xa5, 4 * GUARD);
        memset(expected[k] + sizes[k] * count, 0xa5, 4 * GUARD);
    }
    for (uint32_t i = 0; i < count; i++) {
        noh_vertex v;
        float position[3];
        noh_skin_vertex(&x->mesh, x->matrices, layers, first + i, &v);
        noh_skin_position(&x->mesh, x->matrices, layers, first + i, position);
        test_same_floats(position, v.position, 3, "the position alone");
        memcpy(expected[0] + 3 * i, v.position, 12);
        memcpy(expected[1] + 3 * i, v.normal, 12);
        memcpy(expected[2] + 4 * i, v.tangent, 16);
    }
    function(&x->mesh, x->matrices, layers, first, count, out[0], out[1], out[2]);
    for (int k = 0; k < 3; k++) {
        test_same_floats(out[k], expected[k], (size_t)sizes[k] * count + GUARD,
                         k == 0   ? "positions"
                         : k == 1 ? "normals"
                                  : "tangents");
        free(out[k]);
        free(expected[k]);
    }
    function(&x->mesh, x->matrices, layers, first, count, NULL, NULL, NULL);
}

/* Any affine matrices: turned, stretched, mirrored, flat. */
static void random_matrices(made *x, test_random *r)
{
    for (uint32_t i = 0; i < x->skin.header->joint_count * 12u; i++) {
        x->matrices[i] = test_random_float(r, -2.0f, 2.0f);
    }
    memset(x->matrices, 0, 12);
}

static void check_simd(const skin_cylinder *c, const skin_options *options, skin_function function)
{
    test_random r = test_random_from(c->influences);
    made x = make(c, options);
    noh_morph_layers layers = test_layers(&x.mesh);
    const float weights[2] = { 0.7f, -0.4f };
    const noh_morph_layers two = { layers.position, layers.normal, NULL }, *all[3] = { NULL, &layers, &two };
    uint32_t vertices = x.mesh.header->vertex_count;
    noh_morph_accumulate(&x.mesh, weights, &layers);
    for (int k = 0; k < 12; k++) {
        uint32_t first = k ? test_random_below(&r, vertices) : 0;
        random_matrices(&x, &r);
        compare_range(&x, function, all[k % 3], first,
                      k < 2 ? vertices - first : test_random_below(&r, vertices - first + 1u));
    }
    free(layers.position);
    unmake(&x);
}

static void check_all_shapes(skin_function function)
{
    for (uint32_t influences = 1; influences <= 8; influences *= 2) {
        for (int k = 0; k < 8; k++) {
            const skin_cylinder c = { 7, 11, 13, influences, k & 1 ? 2u : 0u, k & 2, 3.0f, 0.5f };
            skin_options options;
            memset(&options, 0, sizeof options);
            options.palette = k & 4 ? 3u * influences : 0;
            check_simd(&c, &options, function);
        }
    }
}

static void simd_gives_the_scalar_bits(void **state)
{
    (void)state;
    print_message("noh_skin_vertices is %s\n", noh_skin_simd());
    check_all_shapes(noh_skin_vertices);
}

static void other_instruction_sets_give_the_scalar_bits(void **state)
{
    (void)state;
#if defined(__x86_64__)
    check_all_shapes(noh_skin_vertices_sse2);
    if (!__builtin_cpu_supports("avx2")) {
        test_skip("this processor has no AVX2");
    }
    check_all_shapes(noh_skin_vertices_avx2);
#else
    test_skip("not an x86-64 machine");
#endif
}

/* ---- weights ---- */

static void weights_are_kept_and_sum_to_one(void **state)
{
    (void)state;
    for (uint32_t influences = 1; influences <= 8; influences++) {
        const skin_cylinder c = { 5, 40, 12, influences, 0, 0, 3.0f, 0.5f };
        made x = make(&c, NULL);
        double worst = 0.0;
        assert_true(x.mesh.header->influence_count >= influences && x.mesh.header->influence_count < 2 * influences);
        for (uint32_t v = 0; v < x.mesh.header->vertex_count; v++) {
            uint32_t joints[NOH_INFLUENCES_MAX], count;
            float weights[NOH_INFLUENCES_MAX], sum = 0.0f;
            const float *source = x.m->meshes[0].joint_weights;
            uint32_t old = 0;
            count = noh_mesh_influences(&x.mesh, v, joints, weights);
            while (memcmp(x.m->meshes[0].position + 3 * old, x.mesh.positions + 3 * (size_t)v, 12) != 0) {
                old++;
            }
            for (uint32_t i = 0; i < count; i++) {
                double asked = 0.0;
                for (uint32_t k = 0; k < MODEL_INFLUENCES_MAX; k++) {
                    if (weights[i] > 0.0f && x.m->meshes[0].joints[old * MODEL_INFLUENCES_MAX + k] == joints[i]) {
                        asked += (double)source[old * MODEL_INFLUENCES_MAX + k];
                    }
                }
                worst = fmax(worst, fabs(asked - (double)weights[i]));
                sum += weights[i]; /* exact: integers of 2^-22 */
            }
            assert_true(sum == 1.0f);
        }
        assert_true(worst <= 4.5 / 4194304.0); /* the first weight absorbs the rounding of the seven others */
        unmake(&x);
    }
}

/* One half is exact: the first stored weight has one bit more than the others. */
static void halves_are_exact(void **state)
{
    skin_cylinder c = { 3, 3, 3, 2, 0, 0, 2.0f, 0.5f };
    made x;
    model *m = skin_cylinder_model(&c);
    size_t count;
    uint32_t halves = 0;
    (void)state;
    for (uint32_t v = 0; v < m->meshes[0].vertex_count; v++) {
        m->meshes[0].joint_weights[v * MODEL_INFLUENCES_MAX] =
            m->meshes[0].joint_weights[v * MODEL_INFLUENCES_MAX + 1] = 0.5f;
        m->meshes[0].joints[v * MODEL_INFLUENCES_MAX] = 1;
        m->meshes[0].joints[v * MODEL_INFLUENCES_MAX + 1] = 2;
    }
    x.bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
    x.pack = test_open(x.bytes, count);
    x.mesh = test_mesh(&x.pack, 0);
    for (uint32_t v = 0; v < x.mesh.header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX];
        noh_mesh_influences(&x.mesh, v, joints, weights);
        halves += weights[0] == 0.5f && weights[1] == 0.5f && joints[0] == 1 && joints[1] == 2;
    }
    assert_int_equal(halves, x.mesh.header->vertex_count);
    free(x.bytes);
    model_free(m);
}

static void limited_influences_are_reported(void **state)
{
    const skin_cylinder c = { 5, 20, 12, 6, 0, 0, 3.0f, 0.5f };
    skin_options options;
    made x;
    (void)state;
    memset(&options, 0, sizeof options);
    options.influences = 2;
    x = make(&c, &options);
    assert_int_equal(x.mesh.header->influence_count, 2);
    assert_int_equal(x.m->warning_count, 1);
    assert_non_null(strstr(x.m->warnings[0], "more than 2 joints"));
    unmake(&x);
}

/* ---- palettes ---- */

/* A triangle's corners, wherever its vertices are stored. */
static int compare_triangles(const void *a, const void *b)
{
    return memcmp(a, b, 36);
}

static float *sorted_triangles(const noh_mesh *mesh)
{
    uint32_t count = mesh->header->index_count;
    float *corners = test_zeros(12u * (size_t)count);
    for (uint32_t i = 0; i < count; i += 3) {
        uint32_t start = 0; /* cache optimisation may rotate a triangle's corners: begin with the smallest */
        for (uint32_t k = 1; k < 3; k++) {
            if (memcmp(mesh->positions + 3u * (size_t)noh_mesh_index(mesh, i + k),
                       mesh->positions + 3u * (size_t)noh_mesh_index(mesh, i + start), 12) < 0) {
                start = k;
            }
        }
        for (uint32_t k = 0; k < 3; k++) {
            memcpy(corners + 3 * (size_t)(i + k),
                   mesh->positions + 3u * (size_t)noh_mesh_index(mesh, i + (start + k) % 3), 12);
        }
    }
    qsort(corners, count / 3, 36, compare_triangles);
    return corners;
}

static void splits_draw_the_same_triangles(void **state)
{
    const skin_cylinder c = { 6, 30, 20, 4, 1, 0, 5.0f, 0.5f };
    made whole = make(&c, NULL);
    float *expected = sorted_triangles(&whole.mesh);
    (void)state;
    assert_int_equal(whole.mesh.header->palette_count, 1);
    assert_int_equal(whole.mesh.header->flags & NOH_MESH_TEXELS, 0);
    for (uint32_t limit = 5; limit < 20; limit++) {
        skin_options options;
        made x;
        float *got;
        memset(&options, 0, sizeof options);
        options.palette = limit;
        x = make(&c, &options);
        got = sorted_triangles(&x.mesh);
        assert_true(x.mesh.header->palette_count > 1);
        assert_int_equal(x.mesh.header->index_count, whole.mesh.header->index_count);
        assert_int_equal(x.mesh.header->touched_count, whole.mesh.header->touched_count);
        assert_memory_equal(got, expected, 12u * (size_t)x.mesh.header->index_count);
        for (uint32_t p = 0; p < x.mesh.header->palette_count; p++) {
            assert_true(x.mesh.palettes[p].joint_count <= limit);
        }
        free(got);
        unmake(&x);
    }
    free(expected);
    unmake(&whole);
}

static void a_palette_too_small_for_a_triangle_is_refused(void **state)
{
    const skin_cylinder c = { 6, 30, 20, 8, 0, 0, 5.0f, 0.5f };
    model *m = skin_cylinder_model(&c);
    model_clips *moved;
    sample_options rate = { 0.0 };
    skin_options options;
    morph_options morph = { 0 };
    morph_encoding *e;
    clips_settings settings;
    encoded_clips encoded;
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error;
    (void)state;
    memset(&options, 0, sizeof options);
    memset(&settings, 0, sizeof settings);
    options.palette = 7;
    assert_int_equal(clips_from_model(m, &rate, &moved, &error), 0);
    assert_int_equal(skins_bind(m, moved, &options, &error), 0);
    assert_int_equal(morph_encode(&m->meshes[0], &morph, &e, &error), 0);
    assert_int_equal(clips_encode(moved->sets, moved->set_count, &settings, &encoded, &error), 0);
    assert_int_equal(pack_write(m, NULL, &e, &encoded, &out, &error), 1);
    assert_non_null(strstr(error.what, "raise --palette to at least"));
    assert_non_null(strstr(error.where, "cylinder"));
    assert_null(out.bytes);
    morph_encoding_free(e);
    clips_free(&encoded);
    model_clips_free(moved);
    model_free(m);
}

/* ---- normals and stretches ---- */

static double length3(const float *v)
{
    return sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
}

/* Normals stay at right angles to the surface, mirrored or not, and keep pointing outwards. */
static void normals_stay_at_right_angles(void **state)
{
    const skin_cylinder c = { 16, 3, 2, 1, 0, 1, 1.0f, 1.0f };
    made x = make(&c, NULL);
    (void)state;
    for (int mirror = 0; mirror < 2; mirror++) {
        const float m[12] = { mirror ? -3.0f : 3.0f, 0.5f, 0.0f, 1.0f, 0.0f, 0.2f, 0.7f, 2.0f, 0.1f, 0.0f, 1.0f, 3.0f };
        for (int i = 0; i < 24; i++) {
            x.matrices[i] = m[i % 12];
        }
        for (uint32_t v = 0; v < x.mesh.header->vertex_count; v++) {
            noh_vertex rest, moved;
            float along[3], outward[3];
            noh_mesh_vertex(&x.mesh, v, &rest);
            noh_skin_vertex(&x.mesh, x.matrices, NULL, v, &moved);
            for (int r = 0; r < 3; r++) { /* the tube's axis and its radius */
                along[r] = m[4 * r + 1];
                outward[r] = m[4 * r] * rest.position[0] + m[4 * r + 2] * rest.position[2];
            }
            assert_true(fabs((double)noh_dot3(moved.normal, along)) < 1e-4);
            assert_true(fabs((double)noh_dot3(moved.normal, moved.tangent)) <
                        1e-3); /* 16-bit rest vectors, stretched */
            assert_true(noh_dot3(moved.normal, outward) > 0.0f);
            assert_true(fabs(length3(moved.normal) - 1.0) < 1e-6 && fabs(length3(moved.tangent) - 1.0) < 1e-6);
            assert_true(moved.tangent[3] == (mirror ? -rest.tangent[3] : rest.tangent[3]));
        }
    }
    unmake(&x);
}

static void joints_of_no_size_give_finite_vertices(void **state)
{
    const skin_cylinder c = { 8, 9, 4, 4, 1, 1, 1.0f, 1.0f };
    made x = make(&c, NULL);
    noh_dual_quaternion *joints = test_zeros(sizeof *joints * x.skin.header->joint_count);
    (void)state;
    for (uint32_t dropped = 0; dropped <= 4;
         dropped++) { /* the first joints have no size; in the last round none has */
        float *all = test_zeros(40u * (size_t)x.mesh.header->vertex_count);
        for (uint32_t j = 0; j < 4; j++) {
            for (int i = 0; i < 12; i++) {
                x.matrices[12 * j + (uint32_t)i] = i % 5 == 0 && j >= dropped ? 1.0f : 0.0f;
            }
        }
        noh_skin_vertices(&x.mesh, x.matrices, NULL, 0, x.mesh.header->vertex_count, all,
                          all + 3 * x.mesh.header->vertex_count, all + 6 * x.mesh.header->vertex_count);
        noh_skin_dual_quaternions(x.matrices, 4, joints);
        for (uint32_t v = 0; v < x.mesh.header->vertex_count; v++) {
            noh_vertex vertex;
            noh_skin_vertex_dual(&x.mesh, joints, NULL, v, &vertex);
            for (int i = 0; i < 3; i++) {
                assert_true(vertex.position[i] - vertex.position[i] == 0.0f &&
                            vertex.normal[i] - vertex.normal[i] == 0.0f);
            }
            assert_true(fabs(length3(vertex.normal) - 1.0) < 1e-5);
        }
        for (uint32_t i = 0; i < 10 * x.mesh.header->vertex_count; i++) {
            assert_true(all[i] - all[i] == 0.0f);
        }
        free(all);
    }
    free(joints);
    unmake(&x);
}

/* ---- dual quaternions ---- */

/* The last joint turned about the tube's axis. */
static void twist(made *x, float radians)
{
    uint32_t joints = x->skin.header->joint_count;
    noh_transform *pose = test_zeros(sizeof *pose * joints);
    float *space = test_zeros(48u * (size_t)joints);
    memcpy(pose, x->skeleton.bind_pose, sizeof *pose * joints);
    pose[joints - 1].rotation[1] = sinf(0.5f * radians);
    pose[joints - 1].rotation[3] = cosf(0.5f * radians);
    noh_local_to_model(&x->skeleton, pose, joints, space);
    noh_skin_matrices(&x->skin, space, x->matrices);
    free(space);
    free(pose);
}

static float smallest_radius(const noh_mesh *mesh, const float *matrices, const noh_dual_quaternion *joints)
{
    float smallest = 1e9f;
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        float p[3], square;
        if (joints) {
            noh_vertex vertex;
            noh_skin_vertex_dual(mesh, joints, NULL, v, &vertex);
            memcpy(p, vertex.position, sizeof p);
        } else {
            noh_skin_position(mesh, matrices, NULL, v, p);
        }
        square = p[0] * p[0] + p[2] * p[2];
        smallest = square < smallest ? square : smallest;
    }
    return sqrtf(smallest);
}

/* Half a turn collapses a linear blend to a point; dual quaternions keep the radius. */
static void a_twisted_tube_keeps_its_radius(void **state)
{
    const skin_cylinder c = { 16, 41, 2, 2, 0, 0, 4.0f, 0.5f };
    made x = make(&c, NULL);
    noh_dual_quaternion joints[2];
    (void)state;
    for (int degrees = 0; degrees <= 180; degrees += 30) {
        float linear, dual;
        twist(&x, (float)degrees * 3.14159265f / 180.0f);
        noh_skin_dual_quaternions(x.matrices, 2, joints);
        linear = smallest_radius(&x.mesh, x.matrices, NULL);
        dual = smallest_radius(&x.mesh, x.matrices, joints);
        print_message("%3d degrees: linear %.3f, dual quaternions %.3f of the radius\n", degrees, (double)linear / 0.5,
                      (double)dual / 0.5);
        assert_true(fabsf(dual - 0.5f) < 2e-6f);
        assert_true(fabsf(linear - 0.5f * fabsf(cosf((float)degrees * 3.14159265f / 360.0f))) < 1e-2f);
    }
    unmake(&x);
}

/* A joint alone moves a vertex as its matrix does, whatever the matrix. */
static void one_joint_is_its_matrix(void **state)
{
    const skin_cylinder c = { 6, 4, 3, 1, 0, 1, 1.0f, 1.0f };
    made x = make(&c, NULL);
    test_random r = test_random_from(11);
    noh_dual_quaternion joints[3];
    (void)state;
    for (int k = 0; k < 200; k++) {
        for (int i = 0; i < 36; i++) {
            x.matrices[i] = test_random_float(&r, -1.0f, 1.0f) * (k % 5 == 1 ? 1e-3f : k % 5 == 2 ? 50.0f : 1.0f);
        }
        noh_skin_dual_quaternions(x.matrices, 3, joints);
        for (uint32_t v = 0; v < x.mesh.header->vertex_count; v++) {
            noh_vertex a, b;
            double size = length3(x.matrices) + length3(x.matrices + 4) + length3(x.matrices + 8) +
                          length3(x.matrices + 12);
            noh_skin_vertex(&x.mesh, x.matrices, NULL, v, &a);
            noh_skin_vertex_dual(&x.mesh, joints, NULL, v, &b);
            for (int i = 0; i < 3; i++) {
                assert_true(fabs((double)(a.position[i] - b.position[i])) < 1e-5 * size + 1e-9);
            }
            assert_true(noh_dot3(a.normal, b.normal) > 0.999f && a.tangent[3] == b.tangent[3]);
            assert_true(noh_dot3(a.tangent, b.tangent) > 0.999f);
        }
    }
    unmake(&x);
}

/* r and -r are one rotation: turning a joint by 360 degrees more changes nothing. */
static void signs_of_quaternions_do_not_matter(void **state)
{
    const skin_cylinder c = { 6, 9, 4, 4, 0, 0, 1.0f, 1.0f };
    made x = make(&c, NULL);
    noh_dual_quaternion joints[4], turned[4];
    (void)state;
    twist(&x, 2.0f);
    noh_skin_dual_quaternions(x.matrices, 4, joints);
    for (int mask = 0; mask < 16; mask++) {
        memcpy(turned, joints, sizeof turned);
        for (int j = 0; j < 4; j++) {
            for (int i = 0; i < 4; i++) {
                turned[j].real[i] *= mask >> j & 1 ? -1.0f : 1.0f;
                turned[j].dual[i] *= mask >> j & 1 ? -1.0f : 1.0f;
            }
        }
        for (uint32_t v = 0; v < x.mesh.header->vertex_count; v++) {
            noh_vertex a, b;
            noh_skin_vertex_dual(&x.mesh, joints, NULL, v, &a);
            noh_skin_vertex_dual(&x.mesh, turned, NULL, v, &b);
            test_same_floats(b.position, a.position, 3, "position");
        }
    }
    unmake(&x);
}

static void many_vertices_by_dual_quaternions(void **state)
{
    const skin_cylinder c = { 6, 9, 4, 4, 1, 1, 1.0f, 1.0f };
    made x = make(&c, NULL);
    noh_dual_quaternion joints[4];
    const uint32_t vertices = x.mesh.header->vertex_count;
    float *all = test_zeros(40u * (size_t)vertices);
    (void)state;
    twist(&x, 1.0f);
    noh_skin_dual_quaternions(x.matrices, 4, joints);
    noh_skin_vertices_dual(&x.mesh, joints, NULL, 5, vertices - 5, all, all + 3 * vertices, all + 6 * vertices);
    for (uint32_t v = 5; v < vertices; v++) {
        noh_vertex one;
        noh_skin_vertex_dual(&x.mesh, joints, NULL, v, &one);
        test_same_floats(all + 3 * (v - 5), one.position, 3, "position");
        test_same_floats(all + 3 * vertices + 3 * (v - 5), one.normal, 3, "normal");
        test_same_floats(all + 6 * vertices + 4 * (v - 5), one.tangent, 4, "tangent");
    }
    free(all);
    unmake(&x);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(simd_gives_the_scalar_bits),
    cmocka_unit_test(other_instruction_sets_give_the_scalar_bits),
    cmocka_unit_test(weights_are_kept_and_sum_to_one),
    cmocka_unit_test(halves_are_exact),
    cmocka_unit_test(limited_influences_are_reported),
    cmocka_unit_test(splits_draw_the_same_triangles),
    cmocka_unit_test(a_palette_too_small_for_a_triangle_is_refused),
    cmocka_unit_test(normals_stay_at_right_angles),
    cmocka_unit_test(joints_of_no_size_give_finite_vertices),
    cmocka_unit_test(a_twisted_tube_keeps_its_radius),
    cmocka_unit_test(one_joint_is_its_matrix),
    cmocka_unit_test(signs_of_quaternions_do_not_matter),
    cmocka_unit_test(many_vertices_by_dual_quaternions),
};

TEST_MAIN(tests, NULL, NULL)
