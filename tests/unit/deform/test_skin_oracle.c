/* Skinned assets against the formula of glTF 2.0 (3.7.3), evaluated in double precision by a reader that shares nothing
 * with the converter's (gltf_oracle.c): every clip at random times, with random morph weights, every vertex. First only
 * the arithmetic (the pack's own numbers in double precision), then the pack against the file. */
#include "support/skin_asset.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "noh/low_core.h"

#define TIMES 20

typedef struct errors {
    double arithmetic, whole; /* of the bounding box's diagonal */
    uint64_t compared;
} errors;

/* The nodes' world matrices in double precision, from the same float transforms that the library gets. */
static double *model_of(const skin_asset *a, const double *locals)
{
    uint32_t nodes = oracle_node_count(a->o);
    double *narrow = test_zeros(sizeof *narrow * 10 * nodes), *worlds = test_zeros(sizeof *worlds * 16 * nodes);
    for (size_t i = 0; i < 10 * (size_t)nodes; i++) {
        narrow[i] = (double)(float)locals[i];
    }
    oracle_worlds(a->o, narrow, worlds);
    free(narrow);
    return worlds;
}

static uint32_t node_of_joint(const skin_asset *a, uint32_t skeleton, uint32_t joint)
{
    const char *name = noh_pack_joint_name(&a->pack, skeleton, joint);
    uint32_t n = 0;
    char made[32];
    for (;; n++) {
        const char *given = oracle_node_name(a->o, n);
        snprintf(made, sizeof made, "node_%u", (unsigned)n);
        if (strcmp(given ? given : made, name) == 0) {
            return n;
        }
    }
}

/* [joint_count] the file's node of each joint of a skin; to be freed. */
static uint32_t *nodes_of_joints(const skin_asset *a, const noh_skin *skin)
{
    uint32_t *nodes = test_zeros(sizeof *nodes * skin->header->joint_count);
    for (uint32_t j = 0; j < skin->header->joint_count; j++) {
        nodes[j] = node_of_joint(a, skin->header->skeleton, skin->joints[j]);
    }
    return nodes;
}

/* sum of w * world * inverse bind * (base + deltas), all from the pack's floats */
static void formula(const noh_mesh *mesh, const noh_skin *skin, const uint32_t *nodes, const double *worlds,
                    const noh_morph_layers *layers, uint32_t vertex, double out[3])
{
    uint32_t joints[NOH_INFLUENCES_MAX], count;
    float weights[NOH_INFLUENCES_MAX];
    size_t texel = noh_mesh_accumulation_texel(mesh, vertex);
    double p[3];
    count = noh_mesh_influences(mesh, vertex, joints, weights);
    out[0] = out[1] = out[2] = 0.0;
    for (int c = 0; c < 3; c++) {
        p[c] = (double)mesh->positions[3 * (size_t)vertex + (size_t)c] +
               (texel < mesh->header->touched_count ? (double)layers->position[3 * texel + (size_t)c] : 0.0);
    }
    for (uint32_t i = 0; i < count; i++) {
        const float *b = skin->inverse_bind + 12 * (size_t)joints[i];
        const double *w = worlds + 16 * (size_t)nodes[joints[i]];
        double q[3];
        for (int r = 0; r < 3; r++) {
            q[r] = (double)b[4 * r] * p[0] + (double)b[4 * r + 1] * p[1] + (double)b[4 * r + 2] * p[2] +
                   (double)b[4 * r + 3];
        }
        for (int r = 0; r < 3; r++) {
            out[r] += (double)weights[i] * (w[r] * q[0] + w[4 + r] * q[1] + w[8 + r] * q[2] + w[12 + r]);
        }
    }
}

static double distance(const float *a, const double *b)
{
    double x = (double)a[0] - b[0], y = (double)a[1] - b[1], z = (double)a[2] - b[2];
    return sqrt(x * x + y * y + z * z);
}

static void compare(const skin_asset *a, uint32_t index, const double *locals, test_random *random, errors *e)
{
    noh_mesh mesh = test_mesh(&a->pack, index);
    const uint32_t vertices = mesh.header->vertex_count, targets = mesh.header->target_count;
    noh_morph_layers layers = test_layers(&mesh);
    float *weights = test_zeros(4u * (size_t)targets), *got = test_zeros(12u * (size_t)vertices), *matrices;
    double *wide = test_zeros(8u * (size_t)targets), *expected = test_zeros(24u * (size_t)vertices), *worlds;
    uint32_t *nodes;
    noh_skin skin;
    assert_int_equal(noh_pack_skin_at(&a->pack, mesh.header->skin, &skin, NULL), NOH_OK);
    for (uint32_t t = 0; t < targets; t++) {
        weights[t] = test_random_below(random, 8) ? 0.0f : test_random_float(random, -0.5f, 1.0f);
        wide[t] = (double)weights[t];
    }
    noh_morph_accumulate(&mesh, weights, &layers);
    matrices = skin_asset_matrices(a, &mesh, locals);
    noh_skin_vertices(&mesh, matrices, &layers, 0, vertices, got, NULL, NULL);
    worlds = model_of(a, locals);
    nodes = nodes_of_joints(a, &skin);
    for (uint32_t v = 0; v < vertices; v++) {
        double p[3];
        formula(&mesh, &skin, nodes, worlds, &layers, v, p);
        e->arithmetic = fmax(e->arithmetic, distance(got + 3 * (size_t)v, p) / a->size);
    }
    free(worlds);
    worlds = test_zeros(sizeof *worlds * 16 * oracle_node_count(a->o));
    oracle_worlds(a->o, locals, worlds);
    skin_asset_expected(a, index, worlds, wide, expected);
    for (uint32_t v = 0; v < vertices; v++) {
        e->whole = fmax(e->whole, distance(got + 3 * (size_t)v, expected + 3 * (size_t)v) / a->size);
    }
    e->compared += vertices;
    free(nodes);
    free(worlds);
    free(matrices);
    free(expected);
    free(wide);
    free(got);
    free(weights);
    free(layers.position);
}

static void check_asset(const char *name, const skin_options *options, int times)
{
    test_random random = test_random_from(4);
    double *locals;
    errors e = { 0.0, 0.0, 0 };
    skin_asset a;
    skin_asset_open(&a, name, options);
    locals = test_zeros(sizeof *locals * 10 * oracle_node_count(a.o));
    times = test_rounds(times);
    for (int clip = -1; clip < (int)oracle_animation_count(a.o); clip++) {
        for (int k = 0; k < (clip < 0 ? 1 : times); k++) {
            double end = clip < 0 ? 0.0 : oracle_animation_end(a.o, (uint32_t)clip);
            oracle_pose(a.o, clip, end * (double)test_random_float(&random, 0.0f, 1.0f), locals);
            for (uint32_t m = 0; m < a.pack.runs[NOH_CHUNK_MESH].count; m++) {
                compare(&a, m, locals, &random, &e);
            }
        }
    }
    print_message("%s: %llu vertices, arithmetic off by %.2g of the box, from the file by %.2g\n", name,
                  (unsigned long long)e.compared, e.arithmetic, e.whole);
    assert_true(e.compared > 0);
    assert_true(e.arithmetic <= 1e-6);
    assert_true(e.whole <= 1e-6);
    free(locals);
    skin_asset_close(&a);
}

static void body(void **state)
{
    (void)state;
    check_asset("hero/body.glb", NULL, TIMES);
}
static void body_of_seven_influences(void **state)
{
    (void)state;
    check_asset("hero/body_8inf.glb", NULL, TIMES);
}
static void body_quantized(void **state)
{
    (void)state;
    check_asset("hero/body_quantized.glb", NULL, TIMES);
}
static void fox(void **state)
{
    (void)state;
    check_asset("khronos/Fox.glb", NULL, TIMES);
}
static void robot_joined(void **state)
{
    (void)state;
    check_asset("khronos/RobotExpressive.glb", NULL, TIMES);
}
static void simple_skin(void **state)
{
    (void)state;
    check_asset("khronos/SimpleSkin.gltf", NULL, TIMES);
}

static void robot_in_parts(void **state)
{
    skin_options options;
    (void)state;
    memset(&options, 0, sizeof options);
    options.keep_parts = 1;
    check_asset("khronos/RobotExpressive.glb", &options, 4);
}

static void body_split_into_small_palettes(void **state)
{
    skin_options options;
    (void)state;
    memset(&options, 0, sizeof options);
    options.palette = 8;
    check_asset("hero/body.glb", &options, 2);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(body),           cmocka_unit_test(body_of_seven_influences),
    cmocka_unit_test(body_quantized), cmocka_unit_test(fox),
    cmocka_unit_test(robot_joined),   cmocka_unit_test(robot_in_parts),
    cmocka_unit_test(simple_skin),    cmocka_unit_test(body_split_into_small_palettes),
};

TEST_MAIN(tests, NULL, NULL)
