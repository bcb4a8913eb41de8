/* Tests of gaze.c on a figure made in code whose head has eyes: the head turns part of the way, and both eyes meet the
 * point, whatever their own axes and other joints named after eyes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/gaze_internal.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "support/skin_asset.h"
#include "support/support.h"

#define FRAME (1.0f / 60.0f)
#define DEGREES 57.29577951f

enum { HIPS, SPINE, NECK, HEAD, LID, LEFT, PUPIL, RIGHT, JOINTS };

typedef struct figure {
    model *m;
    uint8_t *bytes;
    noh_pack pack;
    noh_skeleton joints;
    noh_gaze_rig rig;
    noh_transform pose[JOINTS];
} figure;

/* A joint of the chain is moved, named and, if it is `back`, turned by half a turn about +y. */
static void place(model *m, uint32_t j, const char *name, uint32_t parent, const float at[3], int back)
{
    model_node *n = &m->nodes[j];
    float *inverse = m->skins[0].inverse_bind + 16u * j;
    const float sign = back ? -1.0f : 1.0f;
    free(n->name);
    n->name = model_string(name);
    n->parent = parent;
    n->rotation[1] = back ? 1.0f : 0.0f;
    n->rotation[3] = back ? 0.0f : 1.0f;
    for (int i = 0; i < 3; i++) {
        const double from = parent == MODEL_NONE ? 0.0 : m->nodes[parent].world[12 + i];
        const float turn = i == 1 ? 1.0f : sign;
        n->translation[i] = (float)((double)at[i] - from);
        n->world[12 + i] = (double)at[i];
        n->world[5 * i] = (double)turn;
        inverse[5 * i] = turn;
        inverse[12 + i] = -turn * at[i];
    }
}

static void open_figure(figure *f)
{
    static const skin_cylinder c = {
        .around = 6, .rings = 9, .joints = JOINTS, .influences = 1, .length = 1.7f, .radius = 0.1f
    };
    static const char *const names[JOINTS] = { "hips",     "spine", "neck",        "head",
                                               "eyelid.L", "eye.L", "eye.L.pupil", "eye.R" };
    static const uint32_t parents[JOINTS] = { MODEL_NONE, HIPS, SPINE, NECK, HEAD, HEAD, LEFT, HEAD };
    static const float places[JOINTS][3] = { { 0, 0.9f, 0 },          { 0, 1.1f, 0 },          { 0, 1.45f, 0 },
                                             { 0, 1.55f, 0 },         { 0.03f, 1.66f, 0.09f }, { 0.03f, 1.65f, 0.08f },
                                             { 0.03f, 1.65f, 0.09f }, { -0.03f, 1.65f, 0.08f } };
    const skin_options options = { 0 };
    size_t count;
    f->m = skin_cylinder_model(&c);
    for (uint32_t j = 0; j < JOINTS; j++) place(f->m, j, names[j], parents[j], places[j], j == RIGHT);
    f->bytes = skin_pack_of(f->m, &options, 1.0f, &count, NULL);
    f->pack = test_open(f->bytes, count);
    assert_int_equal(noh_pack_skeleton_at(&f->pack, 0, &f->joints, NULL, NULL), NOH_OK);
    assert_int_equal(f->joints.joint_count, JOINTS);
    assert_int_equal(noh_gaze_rig_make(&f->pack, 0, &f->rig, NULL), NOH_OK);
}

static void close_figure(figure *f)
{
    free(f->bytes);
    model_free(f->m);
}

static void step(figure *f, noh_gaze *g, const float *target, int cut)
{
    memcpy(f->pose, f->joints.bind_pose, sizeof f->pose);
    noh_gaze_step(g, &f->rig, &f->joints, f->pose, target, FRAME, cut);
}

static const char *name_of(const figure *f, uint32_t joint)
{
    return noh_pack_joint_name(&f->pack, 0, joint);
}

/* Degrees between where a joint looks, which is +z at rest, and the way to a point, or +z. */
static float off(const figure *f, uint32_t joint, const float *target)
{
    noh_skeleton posed = f->joints;
    float at[3], rest[4], rotation[4], way[3] = { 0.0f, 0.0f, 1.0f }, ahead[3] = { 0.0f, 0.0f, 1.0f };
    double dot = 0.0, lengths[2] = { 0.0, 0.0 };
    noh_ragdoll_bind(&posed, joint, at, rest);
    noh_quat_conjugate(rest, rest);
    posed.bind_pose = f->pose;
    noh_ragdoll_bind(&posed, joint, at, rotation);
    noh_quat_rotate(rest, ahead, ahead);
    noh_quat_rotate(rotation, ahead, ahead);
    for (int i = 0; i < 3; i++) {
        if (target) way[i] = target[i] - at[i];
        dot += (double)(way[i] * ahead[i]);
        lengths[0] += (double)(way[i] * way[i]), lengths[1] += (double)(ahead[i] * ahead[i]);
    }
    return DEGREES * (float)acos(fmin(1.0, dot / sqrt(lengths[0] * lengths[1])));
}

static void the_two_eyes_are_found(void **state)
{
    figure f;
    (void)state;
    open_figure(&f);
    assert_string_equal(name_of(&f, f.rig.eyes[0]), "eye.L");
    assert_string_equal(name_of(&f, f.rig.eyes[1]), "eye.R");
    assert_int_equal(f.rig.last, f.rig.eyes[1] > f.rig.eyes[0] ? f.rig.eyes[1] : f.rig.eyes[0]);
    close_figure(&f);
}

/* Near points as well, for which the eyes turn inwards; the head takes three quarters of a turn and of a nod. */
static void both_eyes_meet_a_point(void **state)
{
    static const float angles[][2] = { { 0, 0 }, { 40, 0 }, { -40, 10 }, { 0, 35 }, { 0, -35 }, { 25, -25 } };
    static const float distances[] = { 0.7f, 2.0f, 40.0f };
    figure f;
    (void)state;
    open_figure(&f);
    for (size_t i = 0; i < TEST_COUNT(angles) * TEST_COUNT(distances); i++) {
        const float *way = angles[i / TEST_COUNT(distances)], metres = distances[i % TEST_COUNT(distances)];
        const float yaw = way[0] / DEGREES, pitch = way[1] / DEGREES;
        const float target[3] = { metres * sinf(yaw) * cosf(pitch), 1.65f + metres * sinf(pitch),
                                  0.08f + metres * cosf(yaw) * cosf(pitch) };
        noh_gaze g = { 0 };
        float whole;
        step(&f, &g, target, 1);
        for (int e = 0; e < 2; e++) {
            const float missed = off(&f, f.rig.eyes[e], target);
            if (missed > 1.0f) fail_msg("eye %d: %g degrees past %g %g at %g m", e, missed, way[0], way[1], metres);
        }
        whole = DEGREES * acosf(cosf(yaw) * cosf(pitch));
        if (fabsf(off(&f, HEAD, NULL) - 0.75f * whole) > 1.0f) fail_msg("the head turns by %g", off(&f, HEAD, NULL));
    }
    close_figure(&f);
}

/* Eyes lead: they are at a new point before the head is. Without a point they come back to rest with it. */
static void eyes_lead_and_come_back(void **state)
{
    const float target[3] = { 0.8f, 1.65f, 1.0f };
    noh_gaze g = { 0 };
    uint32_t frames = 0;
    figure f;
    (void)state;
    open_figure(&f);
    step(&f, &g, NULL, 1);
    assert_true(off(&f, f.rig.eyes[0], NULL) < 0.05f && off(&f, f.rig.eyes[1], NULL) < 0.05f);
    do step(&f, &g, target, 0);
    while (++frames < 60 && off(&f, f.rig.eyes[0], target) > 2.0f);
    assert_in_range(frames, 2, 40);
    for (int i = 0; i < 240; i++) step(&f, &g, target, 0);
    assert_true(off(&f, f.rig.eyes[0], target) < 0.3f && off(&f, HEAD, NULL) > 25.0f);
    for (int i = 0; i < 240; i++) step(&f, &g, NULL, 0);
    for (int e = 0; e < 2; e++) assert_true(off(&f, f.rig.eyes[e], NULL) < 0.3f);
    assert_true(off(&f, HEAD, NULL) < 0.3f);
    assert_null(noh_gaze_check(&g));
    close_figure(&f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_two_eyes_are_found),
        cmocka_unit_test(both_eyes_meet_a_point),
        cmocka_unit_test(eyes_lead_and_come_back),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
