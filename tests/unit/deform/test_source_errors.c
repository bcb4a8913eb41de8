/* Errors of the source documents about skinning, morphing and picking: each test shows how the source's version fails
 * and what the library does instead. tests/README.md names the sources. Where an error is about what a GPU binds, the
 * test is of the data. */
#include "support/skin_asset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/math_internal.h"
#include "convert/skin/mesh_join.h"
#include "convert/model/model_build.h"
#include "convert/model/two_stream.h"
#include "support/pack_walk.h"
#include "deform/morph/morph_internal.h"
#include "noh/low_core.h"

/* A tube with its pack, posed by bending each joint about z. */
typedef struct tube {
    model *m;
    uint32_t *order; /* new to old */
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_skin skin;
    noh_skeleton skeleton;
    float matrices[16 * 12], space[16 * 12];
} tube;

static tube *make_tube(const skin_cylinder *c, const skin_options *options)
{
    tube *t = test_zeros(sizeof *t);
    size_t count;
    t->m = skin_cylinder_model(c);
    t->bytes = skin_pack_of(t->m, options, 1.0f, &count, &t->order);
    t->pack = test_open(t->bytes, count);
    t->mesh = test_mesh(&t->pack, 0);
    assert_int_equal(noh_pack_skin_at(&t->pack, t->mesh.header->skin, &t->skin, NULL), NOH_OK);
    assert_int_equal(noh_pack_skeleton_at(&t->pack, t->skin.header->skeleton, &t->skeleton, NULL, NULL), NOH_OK);
    return t;
}

static void free_tube(tube *t)
{
    free(t->order);
    free(t->bytes);
    model_free(t->m);
    free(t);
}

static void bend(tube *t, float radians, float sx, float sy)
{
    noh_transform pose[16];
    memcpy(pose, t->skeleton.bind_pose, sizeof *pose * t->skeleton.joint_count);
    for (uint32_t j = 1; j < t->skeleton.joint_count; j++) {
        pose[j].rotation[2] = sinf(0.5f * radians);
        pose[j].rotation[3] = cosf(0.5f * radians);
    }
    pose[0].scale[0] = sx;
    pose[0].scale[1] = sy;
    noh_local_to_model(&t->skeleton, pose, t->skeleton.joint_count, t->space);
    noh_skin_matrices(&t->skin, t->space, t->matrices);
}

static double distance(const float *a, const float *b)
{
    return sqrt(
        (double)((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2])));
}

/* The weights of a packed vertex before it was packed, and its joints. */
static const float *source_weights(const tube *t, uint32_t vertex, const uint16_t **joints)
{
    const size_t at = (size_t)MODEL_INFLUENCES_MAX * t->order[vertex];
    *joints = t->m->meshes[0].joints + at;
    return t->m->meshes[0].joint_weights + at;
}

static void point(const float m[12], const float p[3], float out[3])
{
    for (int r = 0; r < 3; r++) {
        out[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
    }
}

/* ---- skinned meshes ---- */

/* "A bone can influence any number of vertices" misses the point: what matters is how many bones a vertex can follow.
 */
static void a_vertex_may_follow_many_joints(void **state)
{
    const skin_cylinder c = { 6, 40, 12, 7, 0, 0, 4.0f, 0.5f };
    skin_options two;
    tube *any = make_tube(&c, NULL), *limited;
    double worst = 0.0, kept = 0.0;
    (void)state;
    memset(&two, 0, sizeof two);
    two.influences = 2;
    limited = make_tube(&c, &two);
    assert_true(any->mesh.header->influence_count == 8 && limited->mesh.header->influence_count == 2);
    bend(any, 0.15f, 1, 1);
    bend(limited, 0.15f, 1, 1);
    for (uint32_t v = 0; v < any->mesh.header->vertex_count; v++) {
        float a[3], b[3];
        const uint16_t *joints;
        const float *weights = source_weights(any, v, &joints);
        float all[3] = { 0.0f, 0.0f, 0.0f };
        for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX; i++) {
            float p[3];
            point(any->matrices + 12 * joints[i], any->mesh.positions + 3 * (size_t)v, p);
            for (int k = 0; k < 3; k++) all[k] += weights[i] * p[k];
        }
        noh_skin_position(&any->mesh, any->matrices, NULL, v, a);
        noh_skin_position(&limited->mesh, limited->matrices, NULL, v, b);
        kept = fmax(kept, distance(a, all));
        worst = fmax(worst, distance(a, b));
    }
    assert_true(kept < 1e-5);
    assert_true(worst > 1e-3); /* a limit changes the result; without one all seven of the source are kept */
    free_tube(any);
    free_tube(limited);
}

/* Four rows of constants for each matrix waste one: 16 KiB, the smallest uniform block that ES 3.0 guarantees, then
 * hold 256 joints and nothing else. Three rows leave room. The converter fills palettes up to that limit, and
 * noh_skin_matrices writes exactly three rows of four for a joint. */
static void a_palette_fits_a_uniform_block(void **state)
{
    const skin_cylinder c = { 4, 400, 300, 2, 0, 0, 40.0f, 0.5f };
    const uint32_t block = 16384, others = 1024, row_bytes = 4u * sizeof(float); /* others: view, lights */
    tube *t = make_tube(&c, NULL);
    const uint32_t joints = t->skin.header->joint_count;
    float *space = test_zeros(12 * sizeof(float) * t->skeleton.joint_count),
          *matrices = test_zeros(sizeof(float) * (12u * joints + 1u));
    uint32_t fullest = 0;
    (void)state;
    assert_int_equal(joints, 300);
    assert_true(t->mesh.header->palette_count > 1);
    for (uint32_t p = 0; p < t->mesh.header->palette_count; p++) {
        const uint32_t count = t->mesh.palettes[p].joint_count;
        assert_true(count * 3u * row_bytes + others <= block);
        fullest = count > fullest ? count : fullest;
    }
    assert_true(fullest * 4u * row_bytes + others > block);
    matrices[12u * joints] = 77.0f;
    noh_local_to_model(&t->skeleton, t->skeleton.bind_pose, t->skeleton.joint_count, space);
    noh_skin_matrices(&t->skin, space, matrices);
    assert_true(matrices[12u * joints] == 77.0f);
    for (uint32_t j = 0; j < joints; j++) { /* in the bind pose nothing moves */
        for (uint32_t e = 0; e < 12; e++) {
            assert_true(fabsf(matrices[12u * j + e] - (e % 5u == 0 ? 1.0f : 0.0f)) < 1e-4f);
        }
    }
    free(matrices);
    free(space);
    free_tube(t);
}

/* Weights rounded to bytes one by one sum to anything near 255, and are off by up to 1/510. Ours sum to one, and each
 * is the source's to 2^-21. */
static void quantised_weights_are_those_of_the_source(void **state)
{
    const skin_cylinder c = { 3, 60, 8, 4, 0, 0, 4.0f, 0.5f };
    model *m = skin_cylinder_model(&c);
    size_t byte_count;
    uint32_t *order, wrong = 0;
    uint8_t *packed = skin_pack_of(m, NULL, 1.0f, &byte_count, &order);
    noh_pack pack = test_open(packed, byte_count);
    noh_mesh mesh = test_mesh(&pack, 0);
    (void)state;
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        const float *source = m->meshes[0].joint_weights + (size_t)MODEL_INFLUENCES_MAX * order[v];
        uint32_t joints[NOH_INFLUENCES_MAX], bytes = 0, count;
        float weights[NOH_INFLUENCES_MAX], sum = 0.0f;
        count = noh_mesh_influences(&mesh, v, joints, weights);
        for (uint32_t i = 0; i < count; i++) {
            bytes += (uint32_t)floorf(weights[i] * 255.0f + 0.5f);
            sum += weights[i];
            assert_true(fabsf(weights[i] - source[i]) <= 1.0f / 2097152.0f);
        }
        wrong += bytes != 255;
        assert_true(sum == 1.0f);
    }
    assert_true(wrong > 0);
    free(order);
    free(packed);
    model_free(m);
}

/* Normals moved by the vertices' own matrix tilt where the scale differs by axis, and a vector that is made unit before
 * its last matrix is not unit after it. */
static void normals_by_the_inverse_transpose(void **state)
{
    const skin_cylinder c = { 16, 9, 2, 2, 0, 0, 2.0f, 0.5f };
    tube *t = make_tube(&c, NULL);
    double by_matrix = 0.0, ours = 0.0, early = 0.0;
    (void)state;
    bend(t, 0.0f, 3.0f, 1.0f);
    for (uint32_t v = 0; v < t->mesh.header->vertex_count; v++) {
        noh_vertex rest, moved;
        float n[3], around[3], along[3], length;
        noh_mesh_vertex(&t->mesh, v, &rest);
        noh_skin_vertex(&t->mesh, t->matrices, NULL, v, &moved);
        for (int r = 0; r < 3; r++) { /* the ring's direction at the vertex, moved as points are */
            const float *m = t->matrices + 4 * r;
            n[r] = m[0] * rest.normal[0] + m[1] * rest.normal[1] + m[2] * rest.normal[2];
            around[r] = m[0] * -rest.normal[2] + m[2] * rest.normal[0];
            along[r] = m[1];
        }
        length = sqrtf(noh_dot3(n, n));
        early = fmax(early, fabs((double)length - 1.0));
        by_matrix = fmax(by_matrix, fabs((double)(noh_dot3(n, around) / (length * sqrtf(noh_dot3(around, around))))));
        ours = fmax(ours, fabs((double)(noh_dot3(moved.normal, around) / sqrtf(noh_dot3(around, around)))));
        ours = fmax(ours, fabs((double)noh_dot3(moved.normal, along)));
        assert_true(fabs(sqrt((double)noh_dot3(moved.normal, moved.normal)) - 1.0) < 1e-6);
    }
    assert_true(by_matrix > 0.5 && early > 1.0);
    assert_true(ours < 1e-4);
    free_tube(t);
}

/* ---- morphing ---- */

/* float3 times float4x4 with w = 1 carries the translation into the normal, and w into its length. */
static void a_shift_turns_no_normal(void **state)
{
    const float matrix[12] = { 1, 0, 0, 30, 0, 1, 0, -4, 0, 0, 1, 9 }, n[3] = { 0, 0, 1 };
    const skin_cylinder c = { 8, 3, 1, 1, 0, 0, 1.0f, 0.5f };
    tube *t = make_tube(&c, NULL);
    float moved[4], length;
    (void)state;
    point(matrix, n, moved);
    moved[3] = 1.0f;
    length = sqrtf(noh_dot3(moved, moved) + moved[3] * moved[3]);
    assert_true(fabsf(moved[2] / length - 1.0f) > 0.5f); /* the source's normal */
    memcpy(t->matrices, matrix, sizeof matrix);
    for (uint32_t v = 0; v < t->mesh.header->vertex_count; v++) {
        noh_vertex rest, out;
        noh_mesh_vertex(&t->mesh, v, &rest);
        noh_skin_vertex(&t->mesh, t->matrices, NULL, v, &out);
        assert_true(distance(rest.normal, out.normal) < 1e-6); /* a shift turns nothing */
    }
    free_tube(t);
}

/* Morphs are added in bind space, before the skin, and move normals too. */
static void morph_then_skin(void **state)
{
    const skin_cylinder c = { 8, 9, 3, 2, 1, 0, 2.0f, 0.5f };
    tube *t = make_tube(&c, NULL);
    noh_morph_layers layers = test_layers(&t->mesh);
    const float weight = 1.0f;
    double after = 0.0, unmorphed = 0.0;
    (void)state;
    noh_morph_accumulate(&t->mesh, &weight, &layers);
    bend(t, 1.2f, 1, 1);
    for (uint32_t v = 0; v < t->mesh.header->touched_count; v++) {
        noh_vertex skinned, both, morphed;
        float m[12] = { 0 }, weights[NOH_INFLUENCES_MAX], expected[3], late[3], alone[3];
        uint32_t joints[NOH_INFLUENCES_MAX], count = noh_mesh_influences(&t->mesh, v, joints, weights);
        for (uint32_t i = 0; i < count; i++) {
            for (uint32_t e = 0; e < 12; e++) {
                m[e] += weights[i] * t->matrices[12 * joints[i] + e];
            }
        }
        noh_skin_vertex(&t->mesh, t->matrices, NULL, v, &skinned);
        noh_skin_vertex(&t->mesh, t->matrices, &layers, v, &both);
        noh_morph_vertex(&t->mesh, &layers, v, &morphed);
        noh_skin_position(&t->mesh, t->matrices, &layers, v, alone);
        point(m, morphed.position, expected);
        for (int i = 0; i < 3; i++) {
            late[i] = skinned.position[i] + layers.position[3 * (size_t)v + (size_t)i];
        }
        assert_true(distance(both.position, expected) < 1e-6);
        assert_true(distance(alone, expected) < 1e-6);
        after = fmax(after, distance(late, expected));
        unmorphed = fmax(unmorphed, distance(both.normal, skinned.normal));
    }
    assert_true(after > 0.05 && unmorphed > 0.1);
    free(layers.position);
    free_tube(t);
}

/* ---- picking ---- */

/* A pick clones nothing, sees the morphed and posed surface, leaves its outputs untouched on a miss, and finds rigid
 * meshes. */
static void picking_sees_the_morphed_and_posed_surface(void **state)
{
    const skin_cylinder c = { 24, 17, 3, 2, 1, 0, 2.0f, 0.5f };
    tube *t = make_tube(&c, NULL);
    noh_morph_layers layers = test_layers(&t->mesh);
    const float weight = 1.0f, d[3] = { -1, 0, 0 };
    float *scratch = test_zeros(36 * sizeof(float)), at[3], o[3] = { 5, 0, 0.02f };
    noh_pick_surface plain = { &t->mesh, NULL, t->matrices, NULL, NULL, NULL, NULL }, smiling = plain;
    noh_pick_hit hit, other, miss;
    (void)state;
    noh_morph_accumulate(&t->mesh, &weight, &layers);
    smiling.layers = &layers;
    smiling.weights = &weight;
    bend(t, 0.0f, 1, 1);
    noh_morph_position(&t->mesh, &layers, 0, at); /* a ring that the target moves */
    o[1] = at[1];
    assert_int_equal(noh_pick(&plain, o, d, 100.0f, scratch, 36 * sizeof(float), &hit, NULL), NOH_OK);
    assert_int_equal(noh_pick(&smiling, o, d, 100.0f, scratch, 36 * sizeof(float), &other, NULL), NOH_OK);
    assert_true(hit.distance - other.distance >
                0.15f);    /* the bulge of 0.2 comes first; a clone of the base misses it */
    smiling.layers = NULL; /* where there is no memory for them, by the weights alone */
    assert_int_equal(noh_pick(&smiling, o, d, 100.0f, scratch, 36 * sizeof(float), &hit, NULL), NOH_OK);
    assert_memory_equal(&hit, &other, sizeof hit);
    smiling.layers = &layers;
    bend(t, 1.0f, 1, 1);
    memset(&miss, 0x5a, sizeof miss);
    hit = miss;
    o[1] = 40.0f;
    assert_int_equal(noh_pick(&smiling, o, d, 100.0f, scratch, 36 * sizeof(float), &miss, NULL), NOH_ERR_NOT_FOUND);
    assert_memory_equal(&miss, &hit, sizeof hit);
    free(layers.position);
    free(scratch);
    free_tube(t);
}

/* A clone of the mesh for each pick takes bytes by its vertices; ours takes two boxes a joint, of the caller's. */
static void a_pick_copies_no_vertex(void **state)
{
    const skin_cylinder few = { 8, 9, 3, 2, 0, 0, 2.0f, 0.5f }, many = { 64, 90, 3, 2, 0, 0, 2.0f, 0.5f };
    const float o[3] = { 5, 1.03f, 0.01f }, d[3] = { -1, 0, 0 };
    tube *tubes[2] = { make_tube(&few, NULL), make_tube(&many, NULL) };
    size_t cloned[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        const noh_pick_surface surface = { &tubes[i]->mesh, NULL, tubes[i]->matrices, NULL, NULL, NULL, NULL };
        const size_t bytes = noh_pick_scratch_size(&tubes[i]->mesh);
        float *scratch = test_zeros(bytes + sizeof(float));
        noh_pick_hit first, again;
        scratch[bytes / sizeof(float)] = 12345.0f;
        bend(tubes[i], 0.3f, 1, 1);
        cloned[i] = sizeof(noh_vertex) * tubes[i]->mesh.header->vertex_count;
        for (int click = 0; click < 100; click++) {
            assert_int_equal(noh_pick(&surface, o, d, 100.0f, scratch, bytes, click ? &again : &first, NULL), NOH_OK);
            if (click) assert_memory_equal(&first, &again, sizeof first);
        }
        assert_true(scratch[bytes / sizeof(float)] == 12345.0f);
        assert_int_equal(bytes, noh_pick_scratch_size(&tubes[0]->mesh));
        free(scratch);
    }
    assert_true(cloned[1] > 50u * cloned[0] && cloned[1] > 100u * noh_pick_scratch_size(&tubes[1]->mesh));
    free_tube(tubes[0]);
    free_tube(tubes[1]);
}

/* A miss has the distance -1 in the source, and the texture coordinates that were there before: of several meshes, one
 * that is missed is the nearest, and is hit where another was. */
static void a_miss_is_not_the_nearest(void **state)
{
    const skin_cylinder c = { 24, 17, 3, 2, 0, 0, 2.0f, 0.5f };
    const float o[3] = { 5, 1.03f, 0.01f }, d[3] = { -1, 0, 0 }, aside[3] = { 5, 40, 0 };
    tube *t = make_tube(&c, NULL);
    float *scratch = test_zeros(noh_pick_scratch_size(&t->mesh)), nearest = 1e30f, u = 0.0f;
    const noh_pick_surface surface = { &t->mesh, NULL, t->matrices, NULL, NULL, NULL, NULL };
    int literal = -1, ours = -1;
    noh_pick_hit best;
    (void)state;
    bend(t, 0.0f, 1, 1);
    memset(&best, 0, sizeof best);
    best.distance = 1e30f;
    for (int i = 0; i < 2; i++) { /* the first is hit, the second missed */
        noh_pick_hit hit;
        const noh_result result = noh_pick(&surface, i ? aside : o, d, 100.0f, scratch, noh_pick_scratch_size(&t->mesh),
                                           &hit, NULL);
        const float distance = result ? -1.0f : hit.distance;
        u = result ? u : hit.barycentric[1]; /* not written where nothing is hit */
        if (distance < nearest) nearest = distance, literal = i;
        if (!result && hit.distance < best.distance) best = hit, ours = i;
    }
    assert_int_equal(literal, 1);
    assert_true(nearest < 0.0f && u == best.barycentric[1]);
    assert_int_equal(ours, 0);
    assert_true(fabsf(best.distance - 4.5f) < 0.05f);
    free(scratch);
    free_tube(t);
}

/* Without an inverse transpose normals of the picked clone go by the bones' matrices: where these scale by axis, the
 * normal at the hit is not the normal of the triangle that was hit. */
static void normals_of_the_picked_face(void **state)
{
    const skin_cylinder c = { 64, 9, 2, 2, 0, 0, 2.0f, 0.5f };
    const float o[3] = { 5, 1.03f, 0.4f }, d[3] = { -1, 0, 0 };
    tube *t = make_tube(&c, NULL);
    float *scratch = test_zeros(noh_pick_scratch_size(&t->mesh)), corner[3][3], a[3], b[3], face[3];
    const noh_pick_surface surface = { &t->mesh, NULL, t->matrices, NULL, NULL, NULL, NULL };
    float literal[3] = { 0, 0, 0 }, ours[3] = { 0, 0, 0 };
    noh_pick_hit hit;
    (void)state;
    bend(t, 0.0f, 3.0f, 1.0f);
    assert_int_equal(noh_pick(&surface, o, d, 100.0f, scratch, noh_pick_scratch_size(&t->mesh), &hit, NULL), NOH_OK);
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t v = noh_mesh_index(&t->mesh, 3u * hit.triangle + k);
        noh_vertex rest, moved;
        noh_mesh_vertex(&t->mesh, v, &rest);
        noh_skin_vertex(&t->mesh, t->matrices, NULL, v, &moved);
        memcpy(corner[k], moved.position, sizeof corner[k]);
        for (int r = 0; r < 3; r++) {
            literal[r] += hit.barycentric[k] * noh_dot3(t->matrices + 4 * r, rest.normal);
            ours[r] += hit.barycentric[k] * moved.normal[r];
        }
    }
    for (int r = 0; r < 3; r++) a[r] = corner[1][r] - corner[0][r], b[r] = corner[2][r] - corner[0][r];
    for (int r = 0; r < 3; r++) face[r] = a[(r + 1) % 3] * b[(r + 2) % 3] - a[(r + 2) % 3] * b[(r + 1) % 3];
    const float right = noh_dot3(face, ours) / sqrtf(noh_dot3(face, face) * noh_dot3(ours, ours));
    const float wrong = noh_dot3(face, literal) / sqrtf(noh_dot3(face, face) * noh_dot3(literal, literal));
    assert_true(fabsf(right) > 0.995f); /* 6 degrees: the tube has 64 sides */
    assert_true(fabsf(wrong) < 0.9f);
    free(scratch);
    free_tube(t);
}

/* ---- two streams ---- */

/* The tube, and a second mesh of the same triangles that is wider at the top. `shuffle`: only its triangles are
 * reordered. */
static model *two_tubes(int shuffle)
{
    const skin_cylinder c = { 12, 9, 2, 2, 0, 1, 2.0f, 0.5f };
    model *m = skin_cylinder_model(&c);
    model_mesh *b;
    m->meshes = realloc(m->meshes, 2 * sizeof *m->meshes);
    b = &m->meshes[1];
    assert_int_equal(mesh_copy(&m->meshes[0], b), 0);
    free(b->name);
    b->name = model_string("wide");
    free(b->tangent); /* the second stream has attributes of its own */
    b->tangent = NULL;
    m->mesh_count = 2;
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        for (uint32_t i = 0; i < 3; i += 2) {
            b->position[3 * v + i] *= 1.0f + b->position[3 * v + 1];
        }
        b->normal[3 * v + 1] = -0.45f;
        for (uint32_t i = 0; i < 3; i++) {
            b->normal[3 * v + i] /= sqrtf(1.0f + 0.45f * 0.45f);
        }
    }
    if (shuffle) {
        uint32_t first = b->indices[0];
        memmove(b->indices, b->indices + 3, (b->index_count - 3) * sizeof *b->indices);
        b->indices[b->index_count - 1] = first;
    }
    return m;
}

/* The source's code computes A(1 - S) + B S; the comment next to the formula says the opposite, which would begin with
 * B. */
static void the_mix_begins_with_the_source(void **state)
{
    model *m = two_tubes(0), *source = two_tubes(0);
    size_t count;
    uint32_t *order;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    model_error error;
    (void)state;
    assert_int_equal(two_stream_join(m, "cylinder=wide", &error), 0);
    assert_int_equal(m->mesh_count, 1);
    bytes = skin_pack_of(m, NULL, 0.1f, &count, &order);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    assert_int_equal(noh_mesh_find_target(&mesh, "wide"), 0);
    for (int k = 0; k <= 4; k++) {
        float s = noh_ramp(k * 100, 400);
        noh_morph_layers layers = test_layers(&mesh);
        double commented = 0.0;
        noh_morph_accumulate(&mesh, &s, &layers);
        assert_true(s == 0.25f * (float)k);
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            const float *a = source->meshes[0].position + 3 * (size_t)order[v],
                        *b = source->meshes[1].position + 3 * (size_t)order[v];
            float got[3], mix[3], wrong[3];
            noh_morph_position(&mesh, &layers, v, got);
            for (int i = 0; i < 3; i++) {
                mix[i] = a[i] * (1.0f - s) + b[i] * s;
                wrong[i] = a[i] * s + b[i] * (1.0f - s);
            }
            assert_true(distance(got, mix) < 2e-6);
            commented = fmax(commented, distance(got, wrong));
        }
        assert_true(k == 2 ? commented < 2e-6 : commented > 0.4);
        free(layers.position);
    }
    free(order);
    free(bytes);
    model_free(m);
    model_free(source);
}

static float source_ping_pong(uint32_t milliseconds)
{
    float f = (float)(milliseconds % 501u) / 250.0f;
    return f <= 1.0f ? f : 2.0f - f;
}

/* The source's period of 501 has 0 twice in a row, and its 32-bit clock jumps when it wraps. */
static void ping_pong_never_stalls(void **state)
{
    const int64_t wrap = (int64_t)1 << 32;
    (void)state;
    assert_true(source_ping_pong(500) == 0.0f && source_ping_pong(501) == 0.0f);             /* a stall */
    assert_true(fabsf(source_ping_pong(0) - source_ping_pong(0xffffffffu)) > 2.0f / 250.0f); /* a jump */
    for (int64_t t = -2000; t < 4000; t++) {
        float a = noh_ping_pong(t, 250), b = noh_ping_pong(t + 1, 250);
        assert_true(a >= 0.0f && a <= 1.0f);
        assert_true(fabsf(fabsf(a - b) - 1.0f / 250.0f) < 1e-6f); /* always on the move */
        assert_true(noh_ping_pong(t + 500, 250) == a);
    }
    for (int64_t t = wrap - 600; t < wrap + 600; t++) {
        assert_true(fabsf(fabsf(noh_ping_pong(t + 1, 250) - noh_ping_pong(t, 250)) - 1.0f / 250.0f) < 1e-6f);
    }
    assert_true(noh_ping_pong(0, 250) == 0.0f && noh_ping_pong(250, 250) == 1.0f && noh_ping_pong(500, 250) == 0.0f);
}

/* S = t / T is undefined at T = 0, and leaves 0..1 after T. */
static void a_ramp_without_a_duration_is_over(void **state)
{
    (void)state;
    assert_true(!((0.0f / 0.0f) <= 1.0f) && 900.0f / 400.0f > 1.0f); /* the source's */
    assert_true(noh_ramp(0, 0) == 1.0f && noh_ramp(-1, 0) == 0.0f);
    assert_true(noh_ramp(900, 400) == 1.0f && noh_ramp(-5, 400) == 0.0f && noh_ramp(100, 400) == 0.25f);
    assert_true(noh_ping_pong(7, 0) == 0.0f && noh_ping_pong(7, -3) == 0.0f);
}

/* Mixed normals are shorter than one; their length must not darken the light. */
static void mixed_normals_are_unit(void **state)
{
    model *m = two_tubes(0);
    size_t count;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_morph_layers layers;
    const float s = 0.5f;
    float shortest = 1.0f;
    model_error error;
    (void)state;
    assert_int_equal(two_stream_join(m, "cylinder=wide", &error), 0);
    bytes = skin_pack_of(m, NULL, 0.1f, &count, NULL);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    layers = test_layers(&mesh);
    noh_morph_accumulate(&mesh, &s, &layers);
    for (uint32_t v = 0; v < mesh.header->touched_count; v++) {
        noh_vertex rest, mixed;
        float sum[3];
        noh_mesh_vertex(&mesh, v, &rest);
        noh_morph_vertex(&mesh, &layers, v, &mixed);
        for (size_t i = 0; i < 3; i++) {
            sum[i] = rest.normal[i] + layers.normal[3 * (size_t)v + i];
        }
        shortest = fminf(shortest, sqrtf(noh_dot3(sum, sum)));
        assert_true(fabsf(sqrtf(noh_dot3(mixed.normal, mixed.normal)) - 1.0f) < 1e-6f);
    }
    assert_true(shortest < 0.99f);
    free(layers.position);
    free(bytes);
    model_free(m);
}

/* A second mesh that was optimised on its own no longer corresponds: it is refused, not drawn as a tangle of spikes.
 * Ours are reordered together (the_mix_begins_with_the_source compares every vertex behind the encoder's order). */
static void two_streams_must_correspond(void **state)
{
    model *m = two_tubes(1);
    model_error error;
    (void)state;
    assert_int_equal(two_stream_join(m, "cylinder=wide", &error), 1);
    assert_non_null(strstr(error.what, "different triangles"));
    assert_int_equal(two_stream_join(m, "cylinder=none", &error), 1);
    assert_non_null(strstr(error.what, "SOURCE=TARGET"));
    assert_int_equal(two_stream_join(m, "cylinder", &error), 1);
    m->meshes[1].vertex_count -= 1;
    assert_int_equal(two_stream_join(m, "cylinder=wide", &error), 1);
    assert_non_null(strstr(error.what, "must have the same"));
    m->meshes[1].vertex_count += 1;
    model_free(m);
}

/* ---- geometry blending ---- */

/* n matrices need n - 1 weights: v = W1 V1 + .. + (1 - W1 - ..) Vn, for 2, 3 and 4, with the weights as they were
 * before they were packed. */
static void the_last_weight_is_implied(void **state)
{
    (void)state;
    for (uint32_t n = 2; n <= 4; n++) {
        const skin_cylinder c = { 6, 30, 6, n, 0, 0, 3.0f, 0.5f };
        tube *t = make_tube(&c, NULL);
        bend(t, 0.3f, 1, 1);
        for (uint32_t v = 0; v < t->mesh.header->vertex_count; v++) {
            const uint16_t *joints;
            const float *w = source_weights(t, v, &joints);
            float got[3];
            double sum[3] = { 0, 0, 0 }, last = 1.0;
            for (uint32_t i = 0; i < n; i++) {
                const double weight = i + 1u < n ? (double)w[i] : last;
                float p[3];
                point(t->matrices + 12 * joints[i], t->mesh.positions + 3 * (size_t)v, p);
                last -= weight;
                for (int k = 0; k < 3; k++) {
                    sum[k] += weight * (double)p[k];
                }
            }
            noh_skin_position(&t->mesh, t->matrices, NULL, v, got);
            for (int k = 0; k < 3; k++) {
                assert_true(fabs((double)got[k] - sum[k]) < 4e-6);
            }
        }
        free_tube(t);
    }
}

/* Where the given weights sum to more than one, the implied one is negative and the vertex leaves the hull of its
 * joints. A pack's weights may sum to exactly one; one unit more is refused, and for that reason alone. */
static void weights_above_one_are_refused(void **state)
{
    const skin_cylinder c = { 4, 5, 4, 4, 0, 0, 1.0f, 0.5f };
    tube *t = make_tube(&c, NULL);
    uint32_t *words = (uint32_t *)(uintptr_t)t->mesh.influences, joints[NOH_INFLUENCES_MAX];
    const uint32_t joint_words = words[0], half = NOH_WEIGHT_ONE / 2u, quarter = NOH_WEIGHT_ONE / 4u;
    float weights[NOH_INFLUENCES_MAX];
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_pack pack;
    (void)state;
    assert_int_equal(t->mesh.header->influence_count, 4);
    for (uint32_t over = 0; over < 2; over++) { /* w1 22 bits, w2 and w3 21, lowest first */
        const uint64_t bits = (uint64_t)(half + over) | (uint64_t)quarter << 22 | (uint64_t)quarter << 43;
        words[0] = joint_words;
        words[1] = (uint32_t)bits;
        words[2] = (uint32_t)(bits >> 32);
        pack_repair(t->bytes, t->pack.byte_count);
        if (!over) {
            assert_int_equal(noh_pack_open(t->bytes, t->pack.byte_count, &pack, &error), NOH_OK);
            noh_mesh_influences(&t->mesh, 0, joints, weights);
            assert_true(weights[0] == 0.0f && weights[1] == 0.5f && weights[2] == 0.25f && weights[3] == 0.25f);
        }
    }
    assert_int_equal(noh_pack_open(t->bytes, t->pack.byte_count, &pack, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, "above 1"));
    assert_int_equal(error.where, (uint8_t *)words - t->bytes);
    free_tube(t);
}

/* The segmented arm: the lower half turns about the elbow, so the elbow is moved to the origin, turned and moved back;
 * the source's listing names a member that does not exist, and without the last step the arm comes apart. The blended
 * arm bends. */
static void segmented_and_blended_arm(void **state)
{
    const skin_cylinder rigid = { 16, 21, 3, 1, 0, 0, 2.0f, 0.3f }, blended = { 16, 21, 3, 2, 0, 0, 2.0f, 0.3f };
    tube *arm = make_tube(&rigid, NULL), *banana = make_tube(&blended, NULL);
    const float c = cosf(0.785398163f), s = sinf(0.785398163f);
    const float turned[12] = { c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0 };
    float corrected[12], elbow[3] = { 0, 1, 0 }, naive[3], kept[3];
    double apart = 0.0, ours = 0.0, bent = 0.0;
    (void)state;
    memcpy(corrected, turned, sizeof corrected); /* T(elbow) R T(-elbow) */
    corrected[3] = s;
    corrected[7] = 1.0f - c;
    point(turned, elbow, naive);
    point(corrected, elbow, kept);
    assert_true(distance(naive, elbow) > 0.7 && distance(kept, elbow) < 1e-6);
    for (int k = 0; k < 2; k++) {
        tube *t = k ? banana : arm;
        noh_transform pose[3];
        memcpy(pose, t->skeleton.bind_pose, sizeof pose);
        pose[1].rotation[2] = sinf(0.5f * 0.785398163f);
        pose[1].rotation[3] = cosf(0.5f * 0.785398163f);
        noh_local_to_model(&t->skeleton, pose, 3, t->space);
        noh_skin_matrices(&t->skin, t->space, t->matrices);
    }
    for (uint32_t v = 0; v < arm->mesh.header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX], a[3], b[3], wrong[3];
        noh_mesh_influences(&arm->mesh, v, joints, weights);
        noh_skin_position(&arm->mesh, arm->matrices, NULL, v, a);
        if (joints[0] > 0) {
            point(corrected, arm->mesh.positions + 3 * (size_t)v, b);
            point(turned, arm->mesh.positions + 3 * (size_t)v, wrong);
            ours = fmax(ours, distance(a, b));
            apart = fmax(apart, distance(a, wrong));
        }
        noh_skin_position(&banana->mesh, banana->matrices, NULL, v, b);
        bent = fmax(bent, distance(a, b));
    }
    assert_true(ours < 1e-6 && apart > 0.7 && bent > 0.05);
    free_tube(arm);
    free_tube(banana);
}

/* A joint of weight zero does not affect the vertex, wherever it moves. */
static void weight_zero_is_not_affected(void **state)
{
    const skin_cylinder c = { 6, 11, 6, 2, 0, 0, 2.0f, 0.5f };
    tube *t = make_tube(&c, NULL);
    (void)state;
    bend(t, 0.0f, 1, 1);
    for (int i = 0; i < 12; i++) {
        t->matrices[12 * 5 + i] = 1000.0f;
    }
    for (uint32_t v = 0; v < t->mesh.header->vertex_count; v++) {
        const uint16_t *joints;
        const float *weights = source_weights(t, v, &joints);
        float last = 0.0f, p[3];
        for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX; i++) {
            last += joints[i] == 5 ? weights[i] : 0.0f;
        }
        noh_skin_position(&t->mesh, t->matrices, NULL, v, p);
        assert_true((distance(p, t->mesh.positions + 3 * (size_t)v) < 1e-5) == (last == 0.0f));
    }
    free_tube(t);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_vertex_may_follow_many_joints),
    cmocka_unit_test(a_palette_fits_a_uniform_block),
    cmocka_unit_test(quantised_weights_are_those_of_the_source),
    cmocka_unit_test(normals_by_the_inverse_transpose),
    cmocka_unit_test(a_shift_turns_no_normal),
    cmocka_unit_test(morph_then_skin),
    cmocka_unit_test(picking_sees_the_morphed_and_posed_surface),
    cmocka_unit_test(a_pick_copies_no_vertex),
    cmocka_unit_test(a_miss_is_not_the_nearest),
    cmocka_unit_test(normals_of_the_picked_face),
    cmocka_unit_test(the_mix_begins_with_the_source),
    cmocka_unit_test(a_ramp_without_a_duration_is_over),
    cmocka_unit_test(ping_pong_never_stalls),
    cmocka_unit_test(mixed_normals_are_unit),
    cmocka_unit_test(two_streams_must_correspond),
    cmocka_unit_test(the_last_weight_is_implied),
    cmocka_unit_test(weights_above_one_are_refused),
    cmocka_unit_test(segmented_and_blended_arm),
    cmocka_unit_test(weight_zero_is_not_affected),
};

TEST_MAIN(tests, NULL, NULL)
