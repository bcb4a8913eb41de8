/* Tests of tools/convert/skin/eye_split.c: eyeballs are found, and turned about their joints they look where they
 * should. */
#include "convert/skin/eye_split.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "convert/model/islands.h"
#include "convert/model/model_build.h"
#include "support/support.h"
#include "noh/face.h"

#define DEGREES (180.0 / 3.14159265358979)
#define RINGS 9u
#define SIDES 16u
#define BALL (RINGS * SIDES)

typedef struct ball {
    double centre[3], radius, bulge; /* bulge: of the cornea, a share of the radius */
} ball;

static const ball left = { { 0.032, 0.06, 0.09 }, 0.0121, 0.08 }, right = { { -0.032, 0.06, 0.09 }, 0.0121, 0.08 };

/* A ball of rings about z; the first is the pupil. */
static void add_ball(model_mesh *mesh, const ball *b)
{
    const uint32_t first = mesh->vertex_count;
    for (uint32_t r = 0; r < RINGS; r++) {
        const double turn = 3.14159265 * (r + 0.02) / RINGS;
        for (uint32_t i = 0; i < SIDES; i++) {
            const double side = 6.2831853 * i / SIDES, z = cos(turn);
            const double size = b->radius * (1.0 + (z > 0.8 ? b->bulge * (z - 0.8) / 0.2 : 0.0));
            float *p = mesh->position + 3 * (size_t)mesh->vertex_count++;
            p[0] = (float)(b->centre[0] + size * sin(turn) * cos(side));
            p[1] = (float)(b->centre[1] + size * sin(turn) * sin(side));
            p[2] = (float)(b->centre[2] + size * z);
        }
    }
    for (uint32_t r = 0; r + 1 < RINGS; r++) {
        for (uint32_t i = 0; i < SIDES; i++) {
            const uint32_t a = first + r * SIDES + i, b0 = first + r * SIDES + (i + 1) % SIDES;
            const uint32_t quad[6] = { a, a + SIDES, b0, b0, a + SIDES, b0 + SIDES };
            memcpy(mesh->indices + mesh->index_count, quad, sizeof quad);
            mesh->index_count += 6;
        }
    }
}

/* Balls, and a face that is no ball: a bent sheet. */
static model *face_with(const ball *const *balls, uint32_t count)
{
    const uint32_t most = (count + 1u) * 400u;
    model *m = model_new();
    model_mesh *mesh;
    m->meshes = test_zeros(sizeof *m->meshes);
    m->nodes = test_zeros(sizeof *m->nodes);
    m->mesh_count = m->node_count = 1;
    mesh = m->meshes;
    mesh->name = test_zeros(8);
    memcpy(mesh->name, "face", 5);
    m->nodes[0].name = test_zeros(8);
    memcpy(m->nodes[0].name, "node", 5);
    m->nodes[0].parent = m->nodes[0].skin = MODEL_NONE;
    m->nodes[0].rotation[3] = m->nodes[0].scale[0] = m->nodes[0].scale[1] = m->nodes[0].scale[2] = 1.0f;
    for (int i = 0; i < 16; i += 5) m->nodes[0].world[i] = 1.0;
    mesh->position = test_zeros(most * 12u);
    mesh->indices = test_zeros(most * 6u * sizeof *mesh->indices);
    for (uint32_t v = 0; v < 100; v++) {
        const float x = (float)(v % 10) / 9.0f - 0.5f, y = (float)(v / 10) / 9.0f - 0.3f;
        const float p[3] = { 0.2f * x, 0.3f * y, 0.05f - 0.1f * x * x };
        memcpy(mesh->position + 3 * (size_t)v, p, sizeof p);
        if (v % 10 < 9 && v < 90) {
            const uint32_t quad[6] = { v, v + 1, v + 10, v + 1, v + 11, v + 10 };
            memcpy(mesh->indices + mesh->index_count, quad, sizeof quad);
            mesh->index_count += 6;
        }
    }
    mesh->vertex_count = 100;
    for (uint32_t i = 0; i < count; i++) add_ball(mesh, balls[i]);
    return m;
}

static const model_node *named(const model *m, const char *name)
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (strcmp(m->nodes[n].name, name) == 0) return &m->nodes[n];
    }
    fail_msg("no node %s", name);
    return NULL;
}

static void a_ball_is_fitted(void **state)
{
    const ball *const balls[] = { &left };
    model *m = face_with(balls, 1);
    uint32_t vertices[BALL];
    eye_sphere s;
    (void)state;
    for (uint32_t i = 0; i < BALL; i++) vertices[i] = 100 + i;
    assert_int_equal(eye_sphere_fit(m->meshes[0].position, vertices, BALL, &s), 0);
    for (int c = 0; c < 3; c++) assert_true(fabs(s.centre[c] - left.centre[c]) < 0.0004);
    assert_true(fabs(s.radius - left.radius) < 0.0004 && s.residual < 0.05);
    for (uint32_t i = 0; i < BALL; i++) vertices[i] = 0; /* one point */
    assert_int_equal(eye_sphere_fit(m->meshes[0].position, vertices, BALL, &s), 1);
    model_free(m);
}

static void eyes_get_joints_at_their_centres(void **state)
{
    const ball *const balls[] = { &right, &left };
    model *m = face_with(balls, 2);
    model_error error;
    const model_mesh *mesh = m->meshes;
    (void)state;
    if (eyes_split(m, NULL, &error)) fail_msg("%s", error.what);
    assert_int_equal(m->skin_count, 1);
    assert_int_equal(m->skins[0].joint_count, 3);
    for (int c = 0; c < 3; c++) {
        assert_true(fabs((double)named(m, "LeftEye")->translation[c] - left.centre[c]) < 0.0004);
        assert_true(fabs((double)named(m, "RightEye")->translation[c] - right.centre[c]) < 0.0004);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t place = v < 100 ? 0 : v < 100 + BALL ? 2 : 1;
        assert_int_equal(mesh->joints[(size_t)v * MODEL_INFLUENCES_MAX], place);
        assert_true(mesh->joint_weights[(size_t)v * MODEL_INFLUENCES_MAX] == 1.0f);
    }
    model_free(m);
}

static void what_has_no_two_eyes_is_refused(void **state)
{
    const ball above = { { 0.032, 0.12, 0.09 }, 0.0121, 0.0 }, above_right = { { -0.032, 0.12, 0.09 }, 0.0121, 0.0 };
    const ball small = { { -0.032, 0.06, 0.09 }, 0.008, 0.0 };
    const ball *const none[] = { &left }, *const unequal[] = { &left, &small },
                      *const four[] = { &left, &right, &above, &above_right };
    const struct {
        const ball *const *balls;
        uint32_t count;
        const char *says;
    } cases[] = { { none, 0, "no mesh has two spheres" },
                  { none, 1, "no mesh has two spheres" },
                  { unequal, 2, "no mesh has two spheres" },
                  { four, 4, "more than two spheres" } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        model *m = face_with(cases[i].balls, cases[i].count);
        model_error error;
        assert_int_equal(eyes_split(m, NULL, &error), 1);
        assert_non_null(strstr(error.what, cases[i].says));
        assert_int_equal(m->skin_count, 0);
        model_free(m);
    }
}

/* A vertex of an eye, turned about its joint as a stage turns it: yaw, then pitch in the turned eye. */
static void turned(const float *at, const float joint[3], const float eye[2], double out[3])
{
    const double p[3] = { (double)at[0] - (double)joint[0], (double)at[1] - (double)joint[1],
                          (double)at[2] - (double)joint[2] };
    const double cy = cos((double)eye[0]), sy = sin((double)eye[0]), cp = cos((double)eye[1]), sp = sin((double)eye[1]);
    const double y = cp * p[1] + sp * p[2], z = cp * p[2] - sp * p[1];
    out[0] = cy * p[0] + sy * z + (double)joint[0];
    out[1] = y + (double)joint[1];
    out[2] = cy * z - sy * p[0] + (double)joint[2];
}

/* The angle between where a point of the pupil looks from the true centre, and the target. */
static double off(const double pupil[3], const double centre[3], const float target[3])
{
    double a[3], b[3], dot = 0.0, square_a = 0.0, square_b = 0.0;
    for (int c = 0; c < 3; c++) {
        a[c] = pupil[c] - centre[c];
        b[c] = (double)target[c] - centre[c];
        dot += a[c] * b[c];
        square_a += a[c] * a[c];
        square_b += b[c] * b[c];
    }
    return acos(fmin(1.0, dot / sqrt(square_a * square_b))) * DEGREES;
}

/* The largest error of the aim from 0.3 to 10 m, within what eyes do alone. pupil: the mean of these vertices. */
static double worst_aim(const model *m, const double centres[2][3], const uint32_t *pupils[2], uint32_t count)
{
    const float *joints[2] = { named(m, "LeftEye")->translation, named(m, "RightEye")->translation };
    double worst = 0.0;
    noh_face_desc desc;
    memset(&desc, 0, sizeof desc);
    for (int e = 0; e < 2; e++) memcpy(desc.eyes[e], joints[e], sizeof desc.eyes[e]);
    for (int i = 0; i < 60; i++) {
        const double away = 0.3 * pow(10.0 / 0.3, i / 59.0), yaw = 0.24 * sin(i * 1.7), pitch = 0.15 * sin(i * 2.3);
        const float target[3] = { (float)(away * sin(yaw)), (float)(centres[0][1] + away * sin(pitch)),
                                  (float)(centres[0][2] + away * cos(yaw)) };
        noh_face_pose pose;
        noh_face face;
        assert_int_equal(noh_face_init(&face, &desc, 5, NOH_FACE_CALM, NULL), NOH_OK);
        assert_int_equal(noh_face_look_at(&face, &desc, target, NULL), NOH_OK);
        noh_face_step(&face, &desc, 4 * NOH_TICKS_PER_SECOND);
        noh_face_pose_of(&face, &desc, &pose);
        for (int e = 0; e < 2; e++) {
            double pupil[3] = { 0 };
            for (uint32_t k = 0; k < count; k++) {
                double p[3];
                turned(m->meshes[0].position + 3 * (size_t)pupils[e][k], joints[e], pose.eyes[e], p);
                for (int c = 0; c < 3; c++) pupil[c] += p[c] / count;
            }
            worst = fmax(worst, off(pupil, centres[e], target));
        }
    }
    return worst;
}

static void eyes_aim_at_what_they_look_at(void **state)
{
    const ball plain_left = { { 0.032, 0.06, 0.09 }, 0.0121, 0.0 },
               plain_right = { { -0.032, 0.06, 0.09 }, 0.0121, 0.0 };
    const ball *const plain[] = { &plain_left, &plain_right };
    uint32_t pupil[2][SIDES];
    const uint32_t *pupils[2] = { pupil[0], pupil[1] };
    double centres[2][3], worst;
    model *m = face_with(plain, 2);
    model_error error;
    (void)state;
    for (uint32_t e = 0; e < 2; e++) {
        memcpy(centres[e], plain[e]->centre, sizeof centres[e]);
        for (uint32_t i = 0; i < SIDES; i++) pupil[e][i] = 100 + e * BALL + i;
    }
    assert_int_equal(eyes_split(m, NULL, &error), 0);
    worst = worst_aim(m, (const double(*)[3])centres, pupils, SIDES);
    print_message("off by %.4f degrees at most\n", worst);
    assert_true(worst < 0.1);
    model_free(m);
}

/* Whether a vertex is an earlier one with another tangent or none: at a pole, and at mirrored texture coordinates. */
static int is_split(const model_mesh *m, size_t v)
{
    for (size_t u = 0; u < v; u++) {
        if (memcmp(m->position + 3 * u, m->position + 3 * v, 3 * sizeof(float)) == 0 &&
            memcmp(m->normal + 3 * u, m->normal + 3 * v, 3 * sizeof(float)) == 0 &&
            memcmp(m->uv + 2 * u, m->uv + 2 * v, 2 * sizeof(float)) == 0)
            return 1;
    }
    return 0;
}

static void eyes_of_a_head_are_found(void **state)
{
    const char *const files[] = { "hero/head.glb", "hero/body.glb", "hero/head_skin.glb" };
    static const uint32_t counts[] = { 80, 80, 72 };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(files); i++) {
        model_error error;
        model *m;
        uint32_t eyes[2] = { 0, 0 };
        const model_node *l, *r;
        assert_int_equal(model_read_gltf(test_asset(files[i]), &m, &error), 0);
        if (eyes_split(m, NULL, &error)) fail_msg("%s: %s", files[i], error.what);
        l = named(m, "LeftEye");
        r = named(m, "RightEye");
        assert_true(l->world[12] > 0.02 && l->world[12] < 0.04 && fabs(l->world[12] + r->world[12]) < 1e-4);
        assert_true(fabs(l->world[13] - r->world[13]) < 1e-4 && fabs(l->world[14] - r->world[14]) < 1e-4);
        for (size_t v = 0; v < m->meshes[0].vertex_count; v++) {
            const uint32_t place = m->meshes[0].joints[v * MODEL_INFLUENCES_MAX];
            if (place + 2 < m->skins[0].joint_count || is_split(&m->meshes[0], v)) continue;
            eyes[place + 1 >= m->skins[0].joint_count]++;
        }
        assert_int_equal(eyes[0], counts[i]);
        assert_int_equal(eyes[1], counts[i]);
        model_free(m);
    }
}

/* Islands whose vertices alternate are listed in order, up to the end of a part. */
static void islands_are_listed(void **state)
{
    static const uint32_t island[9] = { 0, 1, 0, 3, 1, 1, 0, 7, 1 };
    static const struct {
        uint32_t first, end, count, vertices[4];
    } cases[] = { { 0, 9, 3, { 0, 2, 6 } }, { 1, 9, 4, { 1, 4, 5, 8 } }, { 3, 9, 1, { 3 } },   { 7, 8, 1, { 7 } },
                  { 1, 5, 2, { 1, 4 } },    { 0, 6, 2, { 0, 2 } },       { 5, 9, 2, { 5, 8 } } };
    uint32_t next[9], out[9];
    (void)state;
    islands_chain(island, 9, next);
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        assert_int_equal(islands_list(next, cases[i].first, cases[i].end, out), cases[i].count);
        assert_memory_equal(out, cases[i].vertices, cases[i].count * sizeof *out);
    }
    islands_chain(island, 0, next);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_is_fitted),
        cmocka_unit_test(eyes_get_joints_at_their_centres),
        cmocka_unit_test(what_has_no_two_eyes_is_refused),
        cmocka_unit_test(eyes_aim_at_what_they_look_at),
        cmocka_unit_test(eyes_of_a_head_are_found),
        cmocka_unit_test(islands_are_listed),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
