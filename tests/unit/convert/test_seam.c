/* Tests of tools/convert/skin/seam.c and tools/convert/model/model_attach.c: a head on a body. */
#include "convert/skin/seam.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_attach.h"
#include "convert/model/model_build.h"
#include "support/support.h"

#define SIDES 24u
#define RINGS 5u
#define RADIUS 0.06

/* A part of a neck: rings of a tube about y, from below upwards, open at both ends. */
typedef struct shape {
    const char *name, *target; /* target NULL: none */
    double low, high;          /* of its rings */
    double aside;              /* moved along x */
    double flare;              /* wider at the upper end; normals stay as they are */
    double head_weight;        /* of the joint 'head' at the lower end; it grows by 0.1 a ring */
    double target_moves;       /* all vertices along z */
    uint32_t sides;            /* 0: SIDES */
} shape;

static char *text_of(const char *text)
{
    char *copy = model_string(text);
    assert_non_null(copy);
    return copy;
}

static void set_node(model_node *node, const char *name, uint32_t parent, double y, double world_y)
{
    node->name = text_of(name);
    node->parent = parent;
    node->mesh = node->skin = MODEL_NONE;
    node->translation[1] = (float)y;
    node->rotation[3] = node->scale[0] = node->scale[1] = node->scale[2] = 1.0f;
    for (int i = 0; i < 16; i += 5) node->world[i] = 1.0;
    node->world[13] = world_y;
}

static void set_vertex(model_mesh *mesh, const shape *s, uint32_t ring, uint32_t side, uint32_t sides)
{
    const size_t v = ring * sides + side;
    const double up = (double)ring / (RINGS - 1u), turn = 6.283185307179586 * side / sides;
    const double radius = RADIUS + s->flare * up, head = s->head_weight + 0.1 * ring;
    const float p[3] = { (float)(radius * cos(turn) + s->aside), (float)(s->low + (s->high - s->low) * up),
                         (float)(radius * sin(turn)) };
    const float n[3] = { (float)cos(turn), 0.0f, (float)sin(turn) };
    memcpy(mesh->position + 3 * v, p, sizeof p);
    memcpy(mesh->normal + 3 * v, n, sizeof n);
    mesh->joints[v * MODEL_INFLUENCES_MAX] = head > 0.5 ? 1 : 0;
    mesh->joints[v * MODEL_INFLUENCES_MAX + 1] = head > 0.5 ? 0 : 1;
    mesh->joint_weights[v * MODEL_INFLUENCES_MAX] = (float)(head > 0.5 ? head : 1.0 - head);
    mesh->joint_weights[v * MODEL_INFLUENCES_MAX + 1] = (float)(head > 0.5 ? 1.0 - head : head);
    if (s->target) mesh->targets[0].position[3 * v + 2] = (float)s->target_moves;
}

static void set_mesh(model_mesh *mesh, const shape *s)
{
    const uint32_t sides = s->sides ? s->sides : SIDES, count = sides * RINGS;
    mesh->name = text_of(s->name);
    mesh->vertex_count = count;
    mesh->index_count = sides * (RINGS - 1u) * 6u;
    mesh->position = test_zeros(count * 12u);
    mesh->normal = test_zeros(count * 12u);
    mesh->joints = test_zeros(count * MODEL_INFLUENCES_MAX * sizeof *mesh->joints);
    mesh->joint_weights = test_zeros(count * MODEL_INFLUENCES_MAX * sizeof *mesh->joint_weights);
    mesh->indices = test_zeros(mesh->index_count * sizeof *mesh->indices);
    mesh->influence_max = mesh->joint_limit = 2;
    mesh->target_count = s->target ? 1 : 0;
    mesh->targets = test_zeros(sizeof *mesh->targets);
    if (s->target) {
        mesh->targets[0].name = text_of(s->target);
        mesh->targets[0].position = test_zeros(count * 12u);
        mesh->targets[0].normal = test_zeros(count * 12u);
    }
    for (uint32_t r = 0; r < RINGS; r++) {
        for (uint32_t i = 0; i < sides; i++) set_vertex(mesh, s, r, i, sides);
    }
    for (uint32_t r = 0, at = 0; r + 1 < RINGS; r++) {
        for (uint32_t i = 0; i < sides; i++, at += 6) {
            const uint32_t a = r * sides + i, b = r * sides + (i + 1) % sides;
            const uint32_t quad[6] = { a, a + sides, b, b, a + sides, b + sides };
            memcpy(mesh->indices + at, quad, sizeof quad);
        }
    }
}

/* A model of one mesh on the joints 'neck' at 1.4 m and 'head' at 1.5 m. */
static model *model_of(const shape *s)
{
    model *m = model_new();
    assert_non_null(m);
    m->meshes = test_zeros(sizeof *m->meshes);
    m->nodes = test_zeros(3 * sizeof *m->nodes);
    m->skins = test_zeros(sizeof *m->skins);
    m->mesh_count = m->skin_count = 1;
    m->node_count = 3;
    set_node(&m->nodes[0], "neck", MODEL_NONE, 1.4, 1.4);
    set_node(&m->nodes[1], "head", 0, 0.1, 1.5);
    set_node(&m->nodes[2], s->name, MODEL_NONE, 0.0, 0.0);
    m->nodes[2].mesh = m->nodes[2].skin = 0;
    m->skins[0].joint_count = 2;
    m->skins[0].joints = test_zeros(2 * sizeof(uint32_t));
    m->skins[0].joints[1] = 1;
    m->skins[0].inverse_bind = test_zeros(32 * sizeof(float));
    for (int j = 0; j < 2; j++) {
        for (int i = 0; i < 16; i += 5) m->skins[0].inverse_bind[16 * j + i] = 1.0f;
        m->skins[0].inverse_bind[16 * j + 13] = (float)-m->nodes[j].world[13];
    }
    set_mesh(m->meshes, s);
    return m;
}

static const shape body = { .name = "body", .low = 1.3, .high = 1.45, .head_weight = 0.0 };
/* its lowest ring is the body's highest */
static const shape head = { .name = "head", .low = 1.45, .high = 1.6, .head_weight = 0.4 };

/* A body with a head attached. */
static model *joined(const shape *below, const shape *above)
{
    model *m = model_of(below), *other = model_of(above);
    model_error error = { "", "" };
    if (model_attach(m, other, NULL, "head.glb", &error)) fail_msg("%s", error.what);
    model_free(other);
    return m;
}

static seam_findings only_seam(const model *m)
{
    seam_findings *all, seam;
    uint32_t count;
    assert_int_equal(seams_measure(m, &all, &count), 0);
    assert_int_equal(count, 1);
    seam = all[0];
    free(all);
    return seam;
}

static void close_seam(model *m)
{
    model_error error;
    assert_int_equal(seams_close(m, SEAM_MEND, NULL, &error), 0);
}

static void expect_warning(model *m, const char *text)
{
    model_error error;
    assert_int_equal(seams_close(m, SEAM_CHECK, NULL, &error), 0);
    assert_int_equal(m->warning_count, 1);
    if (!strstr(m->warnings[0], text)) fail_msg("'%s' does not say '%s'", m->warnings[0], text);
}

static void a_closed_seam_is_silent(void **state)
{
    model *m = joined(&body, &head);
    seam_findings f = only_seam(m);
    model_error error;
    (void)state;
    assert_int_equal(f.pair_count, SIDES);
    assert_int_equal(f.lone_count, 0);
    assert_true(seam_is_closed(&f));
    assert_int_equal(seams_close(m, SEAM_CHECK, NULL, &error), 0);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
}

static void joints_of_one_name_become_one(void **state)
{
    model *m = joined(&body, &head);
    (void)state;
    assert_int_equal(m->mesh_count, 2);
    assert_int_equal(m->node_count, 4); /* neck, head, and a node for each mesh */
    assert_int_equal(m->skins[1].joints[0], 0);
    assert_int_equal(m->skins[1].joints[1], 1);
    assert_int_equal(m->nodes[3].mesh, 1);
    assert_int_equal(m->nodes[3].skin, 1);
    model_free(m);
}

static void a_head_of_other_joints_is_refused(void **state)
{
    model *m = model_of(&body), *other = model_of(&head);
    model_error error = { "", "" };
    (void)state;
    for (uint32_t n = 0; n < 2; n++) other->nodes[n].name[0] = 'x';
    assert_int_equal(model_attach(m, other, NULL, "head.glb", &error), 1);
    assert_non_null(strstr(error.what, "none of its joints"));
    model_free(other);
    model_free(m);
}

/* What is open, how the warning tells it, and that mending closes it to the bit. */
static void expect_mended(const shape *above, const char *told)
{
    model *m = joined(&body, above);
    seam_findings f;
    const model_mesh *a, *b;
    expect_warning(m, told);
    close_seam(m);
    f = only_seam(m);
    assert_true(seam_is_closed(&f));
    assert_int_equal(m->warning_count, 1);
    a = &m->meshes[0], b = &m->meshes[1];
    for (uint32_t i = 0; i < SIDES; i++) {
        const size_t top = (size_t)(RINGS - 1u) * SIDES + i;
        const size_t wa = top * MODEL_INFLUENCES_MAX, wb = (size_t)i * MODEL_INFLUENCES_MAX;
        assert_memory_equal(a->position + 3 * top, b->position + 3 * (size_t)i, 12);
        assert_memory_equal(a->normal + 3 * top, b->normal + 3 * (size_t)i, 12);
        assert_memory_equal(a->joint_weights + wa, b->joint_weights + wb, MODEL_INFLUENCES_MAX * sizeof(float));
        for (uint32_t k = 0; k < 2; k++) {
            assert_int_equal(m->skins[0].joints[a->joints[wa + k]], m->skins[1].joints[b->joints[wb + k]]);
        }
        if (b->target_count) {
            for (int k = 0; k < 3; k++) assert_true(b->targets[0].position[3 * i + (uint32_t)k] == 0.0f);
        }
    }
    model_free(m);
}

static void an_open_seam_is_closed(void **state)
{
    shape above = head;
    (void)state;
    above.low += 0.004;
    expect_mended(&above, "positions are up to 4 mm apart");
}

static void a_shifted_head_is_closed(void **state)
{
    shape above = head;
    (void)state;
    above.aside = 0.009; /* more than half a vertex: still each has the partner that it was modelled with */
    expect_mended(&above, "positions are up to 9 mm apart");
}

static void equal_places_with_other_weights_are_closed(void **state)
{
    shape above = head;
    (void)state;
    above.head_weight = 0.9 - 0.1 * (RINGS - 1u); /* by a bone of its own, as a placeholder mesh gives it */
    expect_mended(&above, "weights differ by up to 0.10");
}

static void a_target_may_not_open_it(void **state)
{
    shape above = head;
    (void)state;
    above.target = "jawOpen";
    above.target_moves = 0.003;
    expect_mended(&above, "target 'jawOpen' moves one side by up to 3 mm");
}

static void normals_are_the_mean(void **state)
{
    model *m = joined(&body, &head);
    const float up[3] = { 0.0f, 1.0f, 0.0f };
    (void)state;
    memcpy(m->meshes[1].normal, up, sizeof up); /* the body's is +x there */
    expect_warning(m, "normals differ by up to 90 degrees");
    close_seam(m);
    for (int k = 0; k < 2; k++) assert_float_equal(m->meshes[1].normal[k], 0.70710678f, 1e-6f);
    model_free(m);
}

/* A target that both meshes have moves both sides by the mean, in the world. */
static void shared_targets_stay(void **state)
{
    shape below = body, above = head;
    model *m;
    seam_findings f;
    (void)state;
    below.target = above.target = "fat";
    below.target_moves = 0.002;
    above.target_moves = 0.004;
    m = joined(&below, &above);
    f = only_seam(m);
    assert_true(fabs(f.delta - 0.002) < 1e-6);
    close_seam(m);
    f = only_seam(m);
    assert_true(seam_is_closed(&f));
    assert_float_equal(m->meshes[1].targets[0].position[2], 0.003f, 1e-6f);
    model_free(m);
}

/* A border with fewer vertices: the others lie on its edges, and no further apart than that. */
static void other_counts_are_closed_at_rest(void **state)
{
    shape above = head;
    model *m;
    seam_findings f;
    (void)state;
    above.sides = SIDES / 2u;
    m = joined(&body, &above);
    f = only_seam(m);
    assert_int_equal(f.pair_count, SIDES / 2u);
    assert_int_equal(f.lone_count, SIDES / 2u);
    assert_true(f.gap > 1e-4);
    close_seam(m);
    f = only_seam(m);
    assert_true(f.gap < 1e-6);
    model_free(m);
}

/* The surfaces end in the same direction: a collar around a neck, however near. */
static void a_collar_is_no_seam(void **state)
{
    shape collar = body;
    model *m;
    seam_findings *all;
    uint32_t count;
    (void)state;
    collar.name = "collar";
    collar.flare = 0.002;
    collar.low += 0.05;
    m = joined(&body, &collar);
    assert_int_equal(seams_measure(m, &all, &count), 0);
    assert_int_equal(count, 0);
    free(all);
    model_free(m);
}

/* A head whose joint the body's skin does not know, and that was bound elsewhere: it gets it. */
static void a_joint_that_a_skin_lacks_is_added(void **state)
{
    model *m = joined(&body, &head);
    seam_findings f;
    (void)state;
    m->skins[0].joint_count = 1; /* 'neck' alone */
    memset(m->meshes[0].joints, 0, m->meshes[0].vertex_count * MODEL_INFLUENCES_MAX * sizeof(uint16_t));
    for (size_t v = 0; v < m->meshes[0].vertex_count; v++) {
        m->meshes[0].joint_weights[v * MODEL_INFLUENCES_MAX] = 1.0f;
        m->meshes[0].joint_weights[v * MODEL_INFLUENCES_MAX + 1] = 0.0f;
    }
    close_seam(m);
    assert_int_equal(m->skins[0].joint_count, 2);
    assert_int_equal(m->skins[0].joints[1], 1);
    f = only_seam(m);
    assert_true(seam_is_closed(&f));
    assert_int_equal(m->warning_count, 0);
    model_free(m);
}

static void other_bind_poses_are_told(void **state)
{
    model *m = joined(&body, &head);
    (void)state;
    m->skins[1].inverse_bind[16 + 14] = 0.01f; /* 'head' alone: 10 mm along z */
    expect_warning(m, "'head' was bound in different poses");
    model_free(m);
}

/* A head that is wide at once: the surface is bent there, and both sides keep their normals. */
static void a_crease_keeps_its_normals(void **state)
{
    shape above = head;
    model *m;
    const float up[3] = { 0.0f, 1.0f, 0.0f };
    seam_findings f;
    (void)state;
    above.high = above.low + 0.02;
    above.flare = 0.045;
    m = joined(&body, &above);
    memcpy(m->meshes[1].normal, up, sizeof up);
    f = only_seam(m);
    assert_true(seam_is_closed(&f));
    close_seam(m);
    assert_float_equal(m->meshes[1].normal[1], 1.0f, 1e-6f);
    model_free(m);
}

static void what_is_no_seam_cannot_be_mended(void **state)
{
    shape above = head;
    model *m;
    (void)state;
    above.low += 0.1;
    above.high += 0.1;
    m = joined(&body, &above);
    close_seam(m);
    assert_int_equal(m->warning_count, 1);
    assert_non_null(strstr(m->warnings[0], "no seam was closed"));
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_seam_is_silent),
        cmocka_unit_test(joints_of_one_name_become_one),
        cmocka_unit_test(a_head_of_other_joints_is_refused),
        cmocka_unit_test(an_open_seam_is_closed),
        cmocka_unit_test(a_shifted_head_is_closed),
        cmocka_unit_test(equal_places_with_other_weights_are_closed),
        cmocka_unit_test(a_target_may_not_open_it),
        cmocka_unit_test(normals_are_the_mean),
        cmocka_unit_test(shared_targets_stay),
        cmocka_unit_test(other_counts_are_closed_at_rest),
        cmocka_unit_test(a_collar_is_no_seam),
        cmocka_unit_test(a_joint_that_a_skin_lacks_is_added),
        cmocka_unit_test(other_bind_poses_are_told),
        cmocka_unit_test(a_crease_keeps_its_normals),
        cmocka_unit_test(what_is_no_seam_cannot_be_mended),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
