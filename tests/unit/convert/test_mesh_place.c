/* Where joints put meshes in the rest pose, whatever tilts a head and turns its eyes. */
#include "convert/model/mesh_place.h"

#include <math.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/model_build.h"
#include "support/support.h"

enum { HEAD, LEFT, RIGHT, NODES = 5 }; /* and a node for each of two meshes */

static const double head_at[3] = { 0.1, 1.5, 0.2 }, eye_of_head[3] = { 0.031, 0.1, 0.08 };

static void turn_about_z(double degrees, double out[16])
{
    const double angle = degrees * 3.14159265358979 / 180.0;
    affine_identity(out);
    out[0] = out[5] = cos(angle);
    out[1] = sin(angle);
    out[4] = -out[1];
}

static void bind_at(float bind[16], const double at[3])
{
    for (int i = 0; i < 16; i++) bind[i] = i % 5 == 0 ? 1.0f : 0.0f;
    for (int c = 0; c < 3; c++) bind[12 + c] = (float)-at[c];
}

/* A vertex of either eye, off its joint by `off`. is_own: each mesh has the origin of its eye; else all share one. */
static model *eyes_of(double head_tilt, const double turns[2], int is_own, const float off[3])
{
    model *m = model_new();
    static const double none[3] = { 0 };
    double head[16], eye[16], local[16];
    m->nodes = test_zeros(NODES * sizeof *m->nodes);
    m->meshes = test_zeros(2 * sizeof *m->meshes);
    m->skins = test_zeros(3 * sizeof *m->skins);
    m->node_count = NODES;
    m->mesh_count = 2;
    m->skin_count = 3; /* head and eyes; a skin for each joint, as in .fbx files */
    turn_about_z(head_tilt, head);
    memcpy(head + 12, head_at, sizeof head_at);
    for (uint32_t n = 0; n < 3; n++) {
        const double way[3] = { (n == LEFT ? 1 : -1) * eye_of_head[0], eye_of_head[1], eye_of_head[2] };
        double rest[3];
        model_skin *skin = &m->skins[n];
        for (int c = 0; c < 3; c++) rest[c] = head_at[c] + (n == HEAD ? 0.0 : way[c]);
        turn_about_z(n == HEAD ? 0.0 : turns[n - LEFT], eye);
        affine_multiply(head, eye, local);
        if (n != HEAD) affine_point(head, way, local + 12);
        memcpy(m->nodes[n].world, local, sizeof local);
        m->nodes[n].parent = n == HEAD ? MODEL_NONE : (uint32_t)HEAD;
        m->nodes[n].mesh = m->nodes[n].skin = MODEL_NONE;
        skin->joint_count = 1;
        skin->joints = test_zeros(sizeof *skin->joints);
        skin->inverse_bind = test_zeros(16 * sizeof *skin->inverse_bind);
        skin->joints[0] = n;
        bind_at(skin->inverse_bind, is_own ? none : rest);
        if (n == HEAD) continue;
        model_mesh *mesh = &m->meshes[n - LEFT];
        m->nodes[n + 2].parent = MODEL_NONE;
        m->nodes[n + 2].mesh = n - LEFT;
        m->nodes[n + 2].skin = n;
        mesh->name = model_string("eye");
        mesh->vertex_count = 1;
        mesh->position = test_zeros(3 * sizeof *mesh->position);
        mesh->joints = test_zeros(MODEL_INFLUENCES_MAX * sizeof *mesh->joints);
        for (int c = 0; c < 3; c++) mesh->position[c] = off[c] + (is_own ? 0.0f : (float)rest[c]);
    }
    return m;
}

static void eyes_stay_side_by_side(void **state)
{
    static const double tilts[][3] = { { 0, 0, 0 },  { 0, 0.5, 0.5 },  { 0, 2, 2 },     { 0, 2, 0 },
                                       { 17, 0, 0 }, { -17, 3, -0.3 }, { 0.5, 0.2, 9 }, { 40, -20, 0 } };
    static const float off[3] = { 0.01f, -0.002f, 0.012f };
    (void)state;
    for (size_t i = 0; i < 2u * TEST_COUNT(tilts); i++) {
        const double *tilt = tilts[i / 2u];
        model *m = eyes_of(tilt[0], tilt + 1, i % 2u == 1u, off);
        for (uint32_t e = 0; e < 2; e++) {
            double places[MESH_PLACES_MAX][16], at[3];
            const float *p = m->meshes[e].position;
            const double position[3] = { (double)p[0], (double)p[1], (double)p[2] };
            assert_int_equal(mesh_places(m, e, 0, places), 1);
            affine_point(places[0], position, at);
            for (int c = 0; c < 3; c++) {
                const double of_head = (c == 0 && e ? -1.0 : 1.0) * eye_of_head[c];
                assert_true(fabs(at[c] - head_at[c] - of_head - (double)off[c]) < 1e-6);
            }
        }
        model_free(m);
    }
}

/* All skins of a figure turn as their topmost joint, however a limb is bent. */
static void limbs_turn_no_mesh(void **state)
{
    static const double z_up[16] = { 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1 };
    static const double turns[][2] = { { -50, 40 }, { -90, 60 }, { 170, 0 } };
    static const float off[3] = { 0.01f, -0.002f, 0.012f };
    (void)state;
    for (size_t i = 0; i < 4u * TEST_COUNT(turns); i++) {
        const int is_z_up = i % 2u == 1u, is_lean = i / 2u % 2u == 1u;
        model *m = eyes_of(is_lean ? 10.0 : 0.0, turns[i / 4u], 1, off);
        for (uint32_t n = 0; is_z_up && n < 3; n++) {
            double before[16];
            memcpy(before, m->nodes[n].world, sizeof before);
            affine_multiply(z_up, before, m->nodes[n].world);
        }
        assert_int_equal(meshes_upright(m), 0);
        for (uint32_t e = 0; e < 2; e++) {
            const float *p = m->meshes[e].position;
            assert_true(p[0] == off[0] && p[1] == (is_z_up ? off[2] : off[1]) && p[2] == (is_z_up ? -off[1] : off[2]));
        }
        model_free(m);
    }
}

/* A root that lies between the axes does not tell them. */
static void a_leaning_root_turns_no_mesh(void **state)
{
    static const double turns[2] = { 0, 0 };
    static const float off[3] = { 0.01f, -0.002f, 0.012f };
    (void)state;
    model *m = eyes_of(-50.0, turns, 1, off);
    assert_int_equal(meshes_upright(m), 0);
    assert_memory_equal(m->meshes[0].position, off, sizeof off);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eyes_stay_side_by_side),
        cmocka_unit_test(limbs_turn_no_mesh),
        cmocka_unit_test(a_leaning_root_turns_no_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
