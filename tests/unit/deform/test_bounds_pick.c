/* Boxes of deformed meshes contain every vertex, and rays hit what a search through all triangles hits: real assets
 * over all their clips with random weights, and rigid meshes. */
#include "support/skin_asset.h"
#include "deform/morph/morph_internal.h"
#include "deform/pick/bounds_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "noh/low_core.h"

#define TIMES 4

/* One mesh in one pose. */
typedef struct scene_pose {
    noh_mesh mesh;
    float *matrices, *weights, *positions; /* positions: every vertex as drawn */
    noh_dual_quaternion *dual;             /* or NULL */
    noh_morph_layers layers;
} scene_pose;

static void pose_mesh(const skin_asset *a, uint32_t index, const double *locals, test_random *r, scene_pose *p)
{
    noh_skin skin;
    memset(p, 0, sizeof *p);
    p->mesh = test_mesh(&a->pack, index);
    assert_int_equal(noh_pack_skin_at(&a->pack, p->mesh.header->skin, &skin, NULL), NOH_OK);
    p->matrices = skin_asset_matrices(a, &p->mesh, locals);
    p->weights = test_zeros(4u * (size_t)p->mesh.header->target_count);
    p->positions = test_zeros(12u * (size_t)p->mesh.header->vertex_count);
    p->layers = test_layers(&p->mesh);
    test_random_weights(r, p->weights, p->mesh.header->target_count);
    noh_morph_accumulate(&p->mesh, p->weights, &p->layers);
    if (p->mesh.header->flags & NOH_MESH_DUAL_QUATERNION) {
        p->dual = test_zeros(sizeof *p->dual * skin.header->joint_count);
        noh_skin_dual_quaternions(p->matrices, skin.header->joint_count, p->dual);
        noh_skin_vertices_dual(&p->mesh, p->dual, &p->layers, 0, p->mesh.header->vertex_count, p->positions, NULL,
                               NULL);
    } else {
        noh_skin_vertices(&p->mesh, p->matrices, &p->layers, 0, p->mesh.header->vertex_count, p->positions, NULL, NULL);
    }
}

static void unpose(scene_pose *p)
{
    free(p->matrices);
    free(p->weights);
    free(p->positions);
    free(p->dual);
    free(p->layers.position);
}

/* ---- boxes ---- */

/* The diagonal of the box divided by the tightest box's. */
static double check_box(const float box[6], const float *positions, uint32_t count)
{
    float tight[6];
    double square = 0.0, tight_square = 0.0;
    noh_box_empty(tight);
    for (uint32_t v = 0; v < count; v++) {
        const float *p = positions + 3 * (size_t)v, point[6] = { p[0], p[1], p[2], p[0], p[1], p[2] };
        noh_box_unite(tight, point, tight);
    }
    for (int i = 0; i < 3; i++) {
        assert_true(box[i] <= tight[i] && box[i + 3] >= tight[i + 3]);
        square += ((double)box[i + 3] - (double)box[i]) * ((double)box[i + 3] - (double)box[i]);
        tight_square += ((double)tight[i + 3] - (double)tight[i]) * ((double)tight[i + 3] - (double)tight[i]);
    }
    return sqrt(square / tight_square);
}

/* ---- assets, converted once for boxes and rays ---- */

typedef struct opened_asset {
    const char *name, *dual_quaternion; /* dual_quaternion: the meshes skinned so, or NULL */
    skin_asset asset;
} opened_asset;

static opened_asset opened[16];
static size_t opened_count;

static const skin_asset *open_asset(const char *name, const char *dual_quaternion)
{
    opened_asset *to = &opened[opened_count];
    skin_options options;
    for (size_t i = 0; i < opened_count; i++) {
        if (strcmp(opened[i].name, name) == 0 && !opened[i].dual_quaternion == !dual_quaternion) {
            return &opened[i].asset;
        }
    }
    assert_true(opened_count < TEST_COUNT(opened));
    memset(&options, 0, sizeof options);
    options.dual_quaternion = &dual_quaternion;
    options.dual_quaternion_count = dual_quaternion != NULL;
    skin_asset_open(&to->asset, name, &options);
    to->name = name;
    to->dual_quaternion = dual_quaternion;
    opened_count++;
    return &to->asset;
}

static int close_assets(void **state)
{
    (void)state;
    while (opened_count) {
        skin_asset_close(&opened[--opened_count].asset);
    }
    return 0;
}

/* ---- poses ---- */

typedef void (*pose_check)(const scene_pose *p, test_random *r, void *context);

static void each_pose(const char *name, const char *dual_quaternion, int times, pose_check check, void *context)
{
    const skin_asset *a = open_asset(name, dual_quaternion);
    test_random r = test_random_from(9);
    double *locals = test_zeros(sizeof *locals * 10 * oracle_node_count(a->o));
    times = test_rounds(times);
    for (uint32_t clip = 0; clip < oracle_animation_count(a->o); clip++) {
        for (int k = 0; k < times; k++) {
            oracle_pose(a->o, (int)clip, oracle_animation_end(a->o, clip) * (double)test_random_float(&r, 0.0f, 1.0f),
                        locals);
            for (uint32_t m = 0; m < a->pack.runs[NOH_CHUNK_MESH].count; m++) {
                scene_pose p;
                pose_mesh(a, m, locals, &r, &p);
                check(&p, &r, context);
                unpose(&p);
            }
        }
    }
    free(locals);
}

static void contains_all(const scene_pose *p, test_random *r, void *context)
{
    double *worst = context, looseness;
    float box[6];
    (void)r;
    noh_skin_box(&p->mesh, p->matrices, p->weights, box);
    looseness = check_box(box, p->positions, p->mesh.header->vertex_count);
    *worst = fmax(*worst, looseness);
}

static void check_boxes(const char *name, const char *dual_quaternion)
{
    double worst = 0.0;
    each_pose(name, dual_quaternion, 2 * TIMES, contains_all, &worst);
    print_message("%s%s: the box's diagonal is at most %.2f of the tightest one's\n", name,
                  dual_quaternion ? " by dual quaternions" : "", worst);
    assert_true(worst > 1.0 && worst < 4.0);
}

static void boxes_of_body(void **state)
{
    (void)state;
    check_boxes("hero/body.glb", NULL);
}
static void boxes_of_body_quantized(void **state)
{
    (void)state;
    check_boxes("hero/body_quantized.glb", NULL);
}
static void boxes_of_body_with_eight_influences(void **state)
{
    (void)state;
    check_boxes("hero/body_8inf.glb", NULL);
}
static void boxes_of_fox(void **state)
{
    (void)state;
    check_boxes("khronos/Fox.glb", NULL);
}
static void boxes_of_robot(void **state)
{
    (void)state;
    check_boxes("khronos/RobotExpressive.glb", NULL);
}
static void boxes_of_simple_skin(void **state)
{
    (void)state;
    check_boxes("khronos/SimpleSkin.gltf", NULL);
}
static void boxes_by_dual_quaternions(void **state)
{
    (void)state;
    check_boxes("hero/body.glb", "all");
    check_boxes("khronos/Fox.glb", "all");
}

/* Each vertex has two joints of weight 1/2, and the second one turns about a line far from it. By dual quaternions the
 * vertex then moves along an arc that leaves the boxes of both joints, by as much as half the distance between the two
 * places where they alone would put it. */
static void check_arcs(uint32_t other)
{
    const skin_cylinder c = { 6, 9, 3, 2, 0, 0, 2.0f, 0.05f };
    static const char *const names[] = { "all" };
    const skin_options all = { .dual_quaternion = names, .dual_quaternion_count = 1 };
    model *m = skin_cylinder_model(&c);
    model_mesh *source = &m->meshes[0];
    noh_dual_quaternion dual[3];
    float largest = 0.0f;
    noh_pack pack;
    noh_mesh mesh;
    uint8_t *bytes;
    float *positions;
    size_t count;
    const float pivot = (float)other;
    for (size_t v = 0; v < source->vertex_count; v++) {
        memset(source->joints + MODEL_INFLUENCES_MAX * v, 0, sizeof *source->joints * MODEL_INFLUENCES_MAX);
        memset(source->joint_weights + MODEL_INFLUENCES_MAX * v, 0,
               sizeof *source->joint_weights * MODEL_INFLUENCES_MAX);
        source->joints[MODEL_INFLUENCES_MAX * v + 1u] = (uint16_t)other;
        source->joint_weights[MODEL_INFLUENCES_MAX * v] = source->joint_weights[MODEL_INFLUENCES_MAX * v + 1u] = 0.5f;
    }
    bytes = skin_pack_of(m, &all, 1.0f, &count, NULL);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    assert_true(mesh.header->flags & NOH_MESH_DUAL_QUATERNION);
    positions = test_zeros(12u * (size_t)mesh.header->vertex_count);
    for (int degrees = 0; degrees < 180; degrees += 10) {
        const float turn = (float)degrees * 0.0174532925f, cosine = cosf(turn), sine = sinf(turn);
        const float turned[12] = {
            cosine, -sine, 0, pivot * sine, sine, cosine, 0, pivot - pivot * cosine, 0, 0, 1, 0
        };
        float matrices[36] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1,
                               0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
        float box[6], joints[18];
        memcpy(matrices + 12u * other, turned, sizeof turned);
        noh_skin_dual_quaternions(matrices, 3, dual);
        noh_skin_vertices_dual(&mesh, dual, NULL, 0, mesh.header->vertex_count, positions, NULL, NULL);
        noh_skin_box(&mesh, matrices, NULL, box);
        check_box(box, positions, mesh.header->vertex_count);
        noh_skin_joint_boxes(&mesh, matrices, NULL, joints);
        assert_true(noh_box_is_empty(joints + 6u * (3u - other))); /* the joint that moves no vertex */
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            const float *rest = mesh.positions + 3u * (size_t)v, y = rest[1] - pivot, cx = cosf(0.5f * turn),
                        sx = sinf(0.5f * turn);
            assert_true(fabsf(positions[3 * v] - (cx * rest[0] - sx * y)) <
                        1e-5f); /* by halves: half of the turn, about the same line */
            assert_true(fabsf(positions[3 * v + 1] - (sx * rest[0] + cx * y + pivot)) < 1e-5f);
            largest = fmaxf(largest, fabsf(positions[3 * v]));
        }
    }
    assert_true(largest > 0.75f * pivot); /* the arc does leave the boxes */
    free(positions);
    free(bytes);
    model_free(m);
}

static void boxes_hold_the_arcs_of_dual_quaternions(void **state)
{
    (void)state;
    check_arcs(1);
    check_arcs(2);
}

/* How far dual quaternions may carry a vertex depends on pairs of joints, not on which of two comes first. */
static void boxes_do_not_depend_on_the_order_of_joints(void **state)
{
    const skin_cylinder c = { 6, 9, 3, 2, 0, 0, 2.0f, 0.05f };
    static const char *const names[] = { "all" };
    const skin_options all = { .dual_quaternion = names, .dual_quaternion_count = 1 };
    model *m = skin_cylinder_model(&c);
    test_random r = test_random_from(31);
    size_t count;
    uint8_t *bytes = skin_pack_of(m, &all, 1.0f, &count, NULL);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    (void)state;
    for (int round = 0; round < 200; round++) {
        float boxes[2][18], matrices[2][36], found[2][6];
        for (uint32_t j = 0; j < 3; j++) {
            for (uint32_t k = 0; k < 12; k++) matrices[0][12u * j + k] = test_random_float(&r, -1.0f, 1.0f);
            for (uint32_t k = 0; k < 3; k++) {
                boxes[0][6u * j + k] = test_random_float(&r, -1.0f, 0.0f);
                boxes[0][6u * j + 3u + k] = test_random_float(&r, 0.0f, 1.0f);
            }
            memcpy(boxes[1] + 6u * (2u - j), boxes[0] + 6u * j, 6 * sizeof(float));
            memcpy(matrices[1] + 12u * (2u - j), matrices[0] + 12u * j, 12 * sizeof(float));
        }
        for (uint32_t i = 0; i < 2; i++) {
            mesh.joint_boxes = boxes[i];
            noh_skin_box(&mesh, matrices[i], NULL, found[i]);
        }
        assert_memory_equal(found[0], found[1], sizeof found[0]);
    }
    free(bytes);
    model_free(m);
}

static void boxes_of_rigid_meshes(void **state)
{
    const test_model_desc desc = { 1, 12, 6, TEST_TANGENTS, 3 };
    test_random r = test_random_from(5);
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    float *positions = test_zeros(12u * (size_t)mesh.header->vertex_count);
    (void)state;
    for (int k = 0; k < 200; k++) {
        noh_morph_layers layers = test_layers(&mesh);
        float weights[6], world[12], box[6];
        test_random_weights(&r, weights, 6);
        for (int i = 0; i < 12; i++) {
            world[i] = test_random_float(&r, -3.0f, 3.0f);
        }
        noh_morph_accumulate(&mesh, weights, &layers);
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            float p[3];
            noh_morph_position(&mesh, &layers, v, p);
            for (int i = 0; i < 3; i++) {
                positions[3 * v + (uint32_t)i] = world[4 * i] * p[0] + world[4 * i + 1] * p[1] +
                                                 world[4 * i + 2] * p[2] + world[4 * i + 3];
            }
        }
        noh_mesh_box(&mesh, world, weights, box);
        check_box(box, positions, mesh.header->vertex_count);
        free(layers.position);
    }
    free(positions);
    free(bytes);
}

/* ---- rays ---- */

/* Every triangle, in double precision. Returns the nearest distance, or -1; `second` is the next one behind it. */
static double brute_force(const noh_mesh *mesh, const float *positions, const float *o, const float *d,
                          uint32_t *triangle, double *margin)
{
    double nearest = -1.0;
    for (uint32_t i = 0; i < mesh->header->index_count; i += 3) {
        double c[3][3], e[3], f[3], s[3], p[3], q[3], determinant, u, v, t;
        for (uint32_t k = 0; k < 3; k++) {
            for (uint32_t x = 0; x < 3; x++) {
                c[k][x] = (double)positions[3 * (size_t)noh_mesh_index(mesh, i + k) + x];
            }
        }
        for (int x = 0; x < 3; x++) {
            e[x] = c[1][x] - c[0][x];
            f[x] = c[2][x] - c[0][x];
            s[x] = (double)o[x] - c[0][x];
        }
        for (int x = 0; x < 3; x++) {
            p[x] = (double)d[(x + 1) % 3] * f[(x + 2) % 3] - (double)d[(x + 2) % 3] * f[(x + 1) % 3];
            q[x] = s[(x + 1) % 3] * e[(x + 2) % 3] - s[(x + 2) % 3] * e[(x + 1) % 3];
        }
        determinant = e[0] * p[0] + e[1] * p[1] + e[2] * p[2];
        u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / determinant;
        v = ((double)d[0] * q[0] + (double)d[1] * q[1] + (double)d[2] * q[2]) / determinant;
        t = (f[0] * q[0] + f[1] * q[1] + f[2] * q[2]) / determinant;
        if (determinant != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 && (nearest < 0.0 || t < nearest)) {
            nearest = t;
            *triangle = i / 3;
            *margin = fmin(fmin(u, v), 1.0 - u - v); /* distance from an edge */
        }
    }
    return nearest;
}

typedef struct ray_counts {
    uint32_t rays, hits;
    double size;
} ray_counts;

static void check_hit(const scene_pose *p, const noh_pick_hit *hit, const float *o, const float *d)
{
    uint32_t corners[3];
    float rest[3] = { 0, 0, 0 }, drawn[3] = { 0, 0, 0 };
    const noh_submesh *sub = &p->mesh.submeshes[hit->submesh];
    assert_true(3 * hit->triangle >= sub->first_index && 3 * hit->triangle < sub->first_index + sub->index_count);
    assert_true(fabsf(hit->barycentric[0] + hit->barycentric[1] + hit->barycentric[2] - 1.0f) < 1e-5f);
    for (uint32_t c = 0; c < 3; c++) {
        corners[c] = noh_mesh_index(&p->mesh, 3 * hit->triangle + c);
        for (uint32_t i = 0; i < 3; i++) {
            rest[i] += hit->barycentric[c] * p->mesh.positions[3 * (size_t)corners[c] + i];
            drawn[i] += hit->barycentric[c] * p->positions[3 * (size_t)corners[c] + i];
        }
    }
    for (int i = 0; i < 3; i++) {
        assert_true(rest[i] == hit->bind_point[i]);
        assert_true(hit->point[i] == o[i] + hit->distance * d[i]);
        assert_true(fabsf(drawn[i] - hit->point[i]) <
                    1e-4f * (1.0f + fabsf(hit->point[i]) + fabsf(o[i]) + hit->distance * fabsf(d[i])));
    }
    {
        uint32_t joints[NOH_INFLUENCES_MAX], count, known = 0;
        float weights[NOH_INFLUENCES_MAX];
        for (uint32_t c = 0; c < 3; c++) {
            count = noh_mesh_influences(&p->mesh, corners[c], joints, weights);
            for (uint32_t i = 0; i < count; i++) {
                known |= joints[i] == hit->joint && weights[i] > 0.0f;
            }
        }
        assert_true(known);
    }
}

static void rays_agree(const scene_pose *p, test_random *r, void *context)
{
    ray_counts *counts = context;
    size_t bytes = noh_pick_scratch_size(&p->mesh);
    void *scratch = test_zeros(bytes);
    const noh_pick_surface surface = { &p->mesh, NULL, p->matrices, p->dual, &p->layers, p->weights, NULL };
    uint32_t vertices = p->mesh.header->vertex_count;
    for (int k = 0; k < 12; k++) {
        /* from near one vertex towards near another: most rays hit, and many just miss */
        const float *a = p->positions + 3 * (size_t)test_random_below(r, vertices),
                    *b = p->positions + 3 * (size_t)test_random_below(r, vertices);
        float o[3], d[3], length = 0.0f;
        noh_pick_hit hit;
        noh_result result;
        uint32_t triangle = 0;
        double expected, margin = 0.0;
        for (int i = 0; i < 3; i++) {
            d[i] = b[i] - a[i];
            length += d[i] * d[i];
        }
        if (length == 0.0f) {
            continue;
        }
        for (int i = 0; i < 3; i++) {
            d[i] += test_random_float(r, -0.1f, 0.1f) * sqrtf(length);
            o[i] = a[i] - test_random_float(r, 1.0f, 2.0f) * d[i];
        }
        expected = brute_force(&p->mesh, p->positions, o, d, &triangle, &margin);
        result = noh_pick(&surface, o, d, 1e6f, scratch, bytes, &hit, NULL);
        counts->rays += 1;
        { /* without layers the same, to the bit */
            noh_pick_surface by_weights = surface;
            noh_pick_hit same = hit;
            if (result == NOH_OK) memset(&same, 0x5a, sizeof same);
            by_weights.layers = NULL;
            assert_int_equal(noh_pick(&by_weights, o, d, 1e6f, scratch, bytes, &same, NULL), result);
            if (result == NOH_OK) assert_memory_equal(&same, &hit, sizeof hit);
        }
        if (expected >= 0.0 && margin > 1e-3) {
            counts->hits += 1;
            assert_int_equal(result, NOH_OK);
            assert_true(fabs((double)hit.distance - expected) < 1e-4 * (1.0 + expected));
            check_hit(p, &hit, o, d);
        } else if (result == NOH_OK && expected < 0.0) { /* within rounding of an edge */
            assert_true(fminf(hit.barycentric[0], fminf(hit.barycentric[1], hit.barycentric[2])) < 1e-3f);
        }
    }
    free(scratch);
}

static void check_rays(const char *name, const char *dual_quaternion)
{
    ray_counts counts = { 0, 0, 0.0 };
    each_pose(name, dual_quaternion, TIMES, rays_agree, &counts);
    print_message("%s%s: %u of %u rays hit, all where a search through all triangles does\n", name,
                  dual_quaternion ? " by dual quaternions" : "", counts.hits, counts.rays);
    assert_true(counts.hits > counts.rays / 4);
}

static void rays_at_body(void **state)
{
    (void)state;
    check_rays("hero/body.glb", NULL);
}
static void rays_at_body_with_eight_influences(void **state)
{
    (void)state;
    check_rays("hero/body_8inf.glb", NULL);
}
static void rays_at_fox(void **state)
{
    (void)state;
    check_rays("khronos/Fox.glb", NULL);
}
static void rays_at_robot(void **state)
{
    (void)state;
    check_rays("khronos/RobotExpressive.glb", NULL);
}
static void rays_by_dual_quaternions(void **state)
{
    (void)state;
    check_rays("khronos/Fox.glb", "all");
}

/* Rigid meshes are picked as they are placed and morphed. */
static void rays_at_a_rigid_mesh(void **state)
{
    const test_model_desc desc = { 1, 6, 2, 0, 3 };
    const float world[12] = { 2, 0, 0, 5, 0, 2, 0, 6, 0, 0, 2, 7 }, weights[2] = { 1.0f, 0.5f };
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    noh_morph_layers layers = test_layers(&mesh);
    const noh_pick_surface surface = { &mesh, world, NULL, NULL, &layers, weights, NULL };
    (void)state;
    noh_morph_accumulate(&mesh, weights, &layers);
    assert_int_equal(noh_pick_scratch_size(&mesh), 0);
    for (uint32_t i = 0; i < mesh.header->index_count; i += 3) {
        float centre[3] = { 0, 0, 0 }, o[3], d[3] = { 0.01f, 0.02f, -1.0f };
        noh_pick_hit hit;
        for (uint32_t c = 0; c < 3; c++) {
            float p[3];
            noh_morph_position(&mesh, &layers, noh_mesh_index(&mesh, i + c), p);
            for (int k = 0; k < 3; k++) {
                centre[k] += (2.0f * p[k] + 5.0f + (float)k) / 3.0f;
            }
        }
        for (int k = 0; k < 3; k++) {
            o[k] = centre[k] - 20.0f * d[k];
        }
        assert_int_equal(noh_pick(&surface, o, d, 100.0f, NULL, 0, &hit, NULL), NOH_OK);
        assert_int_equal(hit.triangle, i / 3);
        assert_true(fabsf(hit.distance - 20.0f) < 1e-3f && hit.joint == NOH_NONE);
        assert_int_equal(noh_pick(&surface, o, d, 19.0f, NULL, 0, &hit, NULL), NOH_ERR_NOT_FOUND);
    }
    free(layers.position);
    free(bytes);
}

/* The source looks at meshes with skin alone: where there is none, it says that nothing is hit. */
static void rigid_meshes_are_hit_at_their_nodes(void **state)
{
    const test_model_desc desc = { 1, 6, 2, 0, 3 };
    const float d[3] = { 0, 0, -1 };
    size_t count;
    uint32_t literal = 0, ours = 0;
    uint8_t *bytes = test_pack(&desc, &count);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    const noh_pick_surface surface = { &mesh, NULL, NULL, NULL, NULL, NULL, NULL };
    (void)state;
    for (uint32_t i = 0; i < mesh.header->index_count; i += 3) {
        float o[3] = { 0, 0, 20 };
        noh_pick_hit hit;
        for (uint32_t c = 0; c < 3; c++) {
            noh_vertex v;
            noh_mesh_vertex(&mesh, noh_mesh_index(&mesh, i + c), &v);
            for (int k = 0; k < 3; k++) o[k] += v.position[k] / 3.0f;
        }
        const int is_hit = noh_pick(&surface, o, d, 100.0f, NULL, 0, &hit, NULL) == NOH_OK;
        ours += is_hit ? 1u : 0u;
        literal += is_hit && mesh.header->skin != NOH_NONE ? 1u : 0u;
    }
    assert_int_equal(literal, 0);
    assert_int_equal(ours, mesh.header->index_count / 3u);
    free(bytes);
}

static void bad_picks_say_why(void **state)
{
    const skin_cylinder c = { 8, 9, 4, 2, 0, 0, 2.0f, 0.5f };
    model *m = skin_cylinder_model(&c);
    size_t count;
    uint8_t *bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    float matrices[48], *scratch = test_zeros(49 * sizeof(float));
    const float o[3] = { 5, 1.03f, 0.01f }, d[3] = { -1, 0, 0 }, none[3] = { 0, 0, 0 };
    noh_pick_surface surface = { &mesh, NULL, matrices, NULL, NULL, NULL, NULL };
    noh_error error;
    noh_pick_hit hit;
    (void)state;
    for (int i = 0; i < 48; i++) {
        matrices[i] = i % 12 % 5 == 0 ? 1.0f : 0.0f;
    }
    scratch[48] = 12345.0f;
    assert_int_equal(noh_pick_scratch_size(&mesh), 4 * 48);
    assert_int_equal(noh_pick(&surface, o, d, 100.0f, scratch, 4 * 48 - 1, &hit, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, 4 * 48);
    assert_int_equal(noh_pick(&surface, o, none, 100.0f, scratch, 4 * 48, &hit, &error), NOH_ERR_ARG);
    assert_int_equal(noh_pick(&surface, o, d, 100.0f, scratch, 4 * 48, &hit, &error), NOH_OK);
    assert_true(scratch[48] == 12345.0f);
    assert_true(fabsf(hit.distance - 4.5f) < 0.05f);
    assert_true(hit.joint == 1 || hit.joint == 2); /* half way up, a little nearer to the second */
    memset(&error, 0, sizeof error);
    assert_int_equal(noh_pick(&surface, o, d, 1.0f, scratch, 4 * 48, &hit, &error), NOH_ERR_NOT_FOUND);
    assert_int_equal(error.result, NOH_ERR_NOT_FOUND);
    assert_non_null(error.what);
    for (size_t shift = 1; shift < NOH_MEMORY_ALIGN; shift++) {
        assert_int_equal(noh_pick(&surface, o, d, 100.0f, (uint8_t *)scratch + shift, 4 * 48, &hit, &error),
                         NOH_ERR_ARG);
    }
    assert_int_equal(noh_pick(&surface, o, d, 100.0f, NULL, 4 * 48, &hit, &error), NOH_ERR_ARG);
    assert_int_equal(error.need, 4 * 48);
    surface.matrices = NULL;
    assert_int_equal(noh_pick(&surface, o, d, 100.0f, scratch, 4 * 48, &hit, &error), NOH_ERR_ARG);
    free(scratch);
    free(bytes);
    model_free(m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(boxes_of_body),
    cmocka_unit_test(boxes_of_body_quantized),
    cmocka_unit_test(boxes_of_body_with_eight_influences),
    cmocka_unit_test(boxes_of_fox),
    cmocka_unit_test(boxes_of_robot),
    cmocka_unit_test(boxes_of_simple_skin),
    cmocka_unit_test(boxes_by_dual_quaternions),
    cmocka_unit_test(boxes_hold_the_arcs_of_dual_quaternions),
    cmocka_unit_test(boxes_do_not_depend_on_the_order_of_joints),
    cmocka_unit_test(boxes_of_rigid_meshes),
    cmocka_unit_test(rays_at_body),
    cmocka_unit_test(rays_at_body_with_eight_influences),
    cmocka_unit_test(rays_at_fox),
    cmocka_unit_test(rays_at_robot),
    cmocka_unit_test(rays_by_dual_quaternions),
    cmocka_unit_test(rays_at_a_rigid_mesh),
    cmocka_unit_test(rigid_meshes_are_hit_at_their_nodes),
    cmocka_unit_test(bad_picks_say_why),
};

TEST_MAIN(tests, NULL, close_assets)
