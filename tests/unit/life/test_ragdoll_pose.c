/* Tests of ragdoll_pose.c: a real character's poses as bodies and back. */
#include "life/physics/ragdoll_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"
#include "support/skin_asset.h"

typedef struct hero {
    skin_asset a;
    noh_ragdoll_source source;
    noh_ragdoll_rig rig;
    noh_ragdoll_fit fit;
    noh_transform *bind, *pose;
} hero;

/* -1..1 */
static float random_float(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / 8388608.0f - 1.0f;
}

static void open_hero(hero *h)
{
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    const noh_skeleton_header *header;
    uint32_t count, seed = 7;
    size_t bytes;
    memset(h, 0, sizeof *h);
    skin_asset_open(&h->a, "hero/body.glb", NULL);
    h->source.pack = &h->a.pack;
    assert_int_equal(noh_pack_skeleton_at(&h->a.pack, 0, &h->source.joints, &header, NULL), NOH_OK);
    h->source.metres = header->unit_cm / 100.0f;
    assert_int_equal(noh_ragdoll_find_rows(&h->source, rows, &count, NULL), NOH_OK);
    assert_int_equal(noh_ragdoll_rig_make(&h->source, rows, count, &h->rig, NULL), NOH_OK);
    noh_ragdoll_fit_make(&h->rig, &h->source.joints, h->source.metres, &h->fit);
    bytes = h->source.joints.joint_count * sizeof *h->bind;
    h->bind = test_zeros(bytes);
    h->pose = test_zeros(bytes);
    memcpy(h->bind, h->source.joints.bind_pose, bytes);
    memcpy(h->pose, h->bind, bytes);
    for (uint32_t i = 0; i < h->source.joints.joint_count; i++) {
        float turn[4], angles[3];
        for (int k = 0; k < 3; k++) angles[k] = 0.6f * random_float(&seed);
        noh_quat_from_rotation(angles, turn);
        noh_quat_mul(h->pose[i].rotation, turn, h->pose[i].rotation);
    }
    h->pose[h->fit.joints[0]].translation[1] -= 0.2f / h->source.metres;
}

static void close_hero(hero *h)
{
    free(h->bind);
    free(h->pose);
    skin_asset_close(&h->a);
}

static noh_ragdoll_frame frame_at(const hero *h, float x, float y, float z, float turn)
{
    const noh_ragdoll_frame f = { { x, y, z }, { 0.0f, sinf(0.5f * turn), 0.0f, cosf(0.5f * turn) }, h->source.metres };
    return f;
}

static float apart(const noh_ragdoll_pose *a, const noh_ragdoll_pose *b, uint32_t count)
{
    float most = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) most = fmaxf(most, fabsf(a[i].position[k] - b[i].position[k]));
        most = fmaxf(most, 1.0f - fabsf(noh_quat_dot(a[i].rotation, b[i].rotation)));
    }
    return most;
}

static void the_bind_pose_is_the_rest_of_the_rig(void **state)
{
    noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX], rest[NOH_RAGDOLL_BODIES_MAX];
    hero h;
    (void)state;
    open_hero(&h);
    const noh_ragdoll_frame frame = frame_at(&h, 0.0f, 0.0f, 0.0f, 0.0f);
    noh_ragdoll_from_pose(&h.fit, &h.source.joints, h.bind, &frame, bodies);
    for (uint32_t i = 0; i < h.rig.body_count; i++) {
        memcpy(rest[i].position, h.rig.bodies[i].position, sizeof rest[i].position);
        memcpy(rest[i].rotation, h.rig.bodies[i].rotation, sizeof rest[i].rotation);
    }
    assert_true(apart(bodies, rest, h.rig.body_count) < 1e-5f);
    close_hero(&h);
}

/* The source sets a bone to where its body is: it is then as long as bodies are apart. Here a pose made bodies and made a
 * pose again agrees with the bodies, in any place, and bones keep their lengths though a body is torn out. */
static void bodies_and_pose_are_each_other(void **state)
{
    noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX], again[NOH_RAGDOLL_BODIES_MAX];
    hero h;
    (void)state;
    open_hero(&h);
    const noh_ragdoll_frame frame = frame_at(&h, 3.0f, 0.5f, -2.0f, 2.2f);
    noh_ragdoll_from_pose(&h.fit, &h.source.joints, h.pose, &frame, bodies);
    for (uint32_t i = 0; i < h.source.joints.joint_count; i++) { /* what no body moves is the pose's */
        int moved = 0;
        for (uint32_t b = 0; b < h.fit.body_count; b++) moved |= h.fit.joints[b] == i;
        if (!moved) h.bind[i] = h.pose[i];
    }
    noh_ragdoll_to_pose(&h.fit, &h.source.joints, &frame, bodies, NULL, h.bind);
    noh_ragdoll_from_pose(&h.fit, &h.source.joints, h.bind, &frame, again);
    assert_true(apart(bodies, again, h.fit.body_count) < 1e-4f);
    for (uint32_t i = 0; i < h.source.joints.joint_count; i++) {
        if (i == h.fit.joints[0]) continue;
        assert_memory_equal(h.bind[i].translation, h.pose[i].translation, sizeof h.bind[i].translation);
    }
    bodies[4].position[0] += 0.3f; /* torn out: no bone is longer for it */
    noh_ragdoll_to_pose(&h.fit, &h.source.joints, &frame, bodies, NULL, h.bind);
    noh_ragdoll_from_pose(&h.fit, &h.source.joints, h.bind, &frame, again);
    bodies[4].position[0] -= 0.3f;
    assert_true(apart(bodies, again, h.fit.body_count) < 1e-4f);
    close_hero(&h);
}

/* Bodies without weight stay as the pose has them: a limp arm on a body that a clip moves. */
static void weights_leave_the_pose(void **state)
{
    noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX];
    float weights[NOH_RAGDOLL_BODIES_MAX] = { 0.0f };
    hero h;
    (void)state;
    open_hero(&h);
    const noh_ragdoll_frame frame = frame_at(&h, 0.0f, 0.0f, 0.0f, 0.0f);
    const size_t bytes = h.source.joints.joint_count * sizeof *h.bind;
    noh_ragdoll_from_pose(&h.fit, &h.source.joints, h.pose, &frame, bodies);
    noh_ragdoll_to_pose(&h.fit, &h.source.joints, &frame, bodies, weights, h.bind);
    assert_memory_equal(h.bind, h.source.joints.bind_pose, bytes);
    weights[5] = 1.0f;
    noh_ragdoll_to_pose(&h.fit, &h.source.joints, &frame, bodies, weights, h.bind);
    for (uint32_t i = 0; i < h.source.joints.joint_count; i++) {
        const int same = memcmp(&h.bind[i], &h.source.joints.bind_pose[i], sizeof h.bind[i]) == 0;
        assert_int_equal(same, i != h.fit.joints[5]);
    }
    close_hero(&h);
}

/* A body that turns and moves at a known speed has it, whichever sign its rotations have. */
static void velocities_come_from_two_poses(void **state)
{
    const noh_ragdoll_pose before = { { 1.0f, 2.0f, 3.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    noh_ragdoll_pose now = { { 1.1f, 2.0f, 2.8f }, { 0.0f, 0.0f, sinf(0.05f), cosf(0.05f) } };
    noh_ragdoll_motion m;
    (void)state;
    for (int sign = 0; sign < 2; sign++) {
        noh_ragdoll_motions_of(&before, &now, 1, 0.05f, &m);
        assert_true(fabsf(m.velocity[0] - 2.0f) < 1e-4f && fabsf(m.velocity[1]) < 1e-4f);
        assert_true(fabsf(m.velocity[2] + 4.0f) < 1e-4f);
        assert_true(fabsf(m.spin[2] - 2.0f) < 1e-3f && fabsf(m.spin[0]) < 1e-4f && fabsf(m.spin[1]) < 1e-4f);
        for (int k = 0; k < 4; k++) now.rotation[k] = -now.rotation[k];
    }
}

static void place_under_finds_place_and_heading(void **state)
{
    noh_ragdoll_pose pose[NOH_RAGDOLL_BODIES_MAX], doll[NOH_RAGDOLL_BODIES_MAX];
    hero h;
    (void)state;
    open_hero(&h);
    for (int i = 0; i < 8; i++) { /* headings all round */
        const noh_ragdoll_frame there = frame_at(&h, 3.0f, 0.25f, -2.0f, 0.8f * (float)i);
        noh_ragdoll_frame frame = frame_at(&h, -1.0f, 0.25f, 7.0f, -1.1f);
        noh_ragdoll_from_pose(&h.fit, &h.source.joints, h.pose, &there, doll);
        noh_ragdoll_from_pose(&h.fit, &h.source.joints, h.pose, &frame, pose);
        noh_ragdoll_place_under(pose, doll, h.fit.body_count, &frame);
        noh_ragdoll_from_pose(&h.fit, &h.source.joints, h.pose, &frame, pose);
        assert_true(apart(pose, doll, h.fit.body_count) < 1e-4f);
        assert_true(frame.position[1] == 0.25f);
    }
    close_hero(&h);
}

/* On the back, on the front, on a side: whichever way the doll heads, each is most like itself. */
static void dolls_lie_alike_whichever_way_they_head(void **state)
{
    static const float turns[3][4] = { { -0.70710678f, 0.0f, 0.0f, 0.70710678f }, /* on the back */
                                       { 0.70710678f, 0.0f, 0.0f, 0.70710678f },
                                       { 0.0f, 0.0f, 0.70710678f, 0.70710678f } };
    (void)state;
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++) {
            const float turn[4] = { 0.0f, sinf(0.7f * (float)b), 0.0f, cosf(0.7f * (float)b) };
            noh_ragdoll_pose one = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } }, other = one;
            memcpy(one.rotation, turns[a], sizeof one.rotation);
            noh_quat_mul(turn, turns[b], other.rotation);
            const float like = noh_ragdoll_similarity(&one, &other), wanted = a == b ? 1.0f : a + b == 1 ? -1.0f : 0.0f;
            assert_true(fabsf(like - wanted) < 1e-5f);
        }
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_bind_pose_is_the_rest_of_the_rig),
    cmocka_unit_test(bodies_and_pose_are_each_other),
    cmocka_unit_test(weights_leave_the_pose),
    cmocka_unit_test(velocities_come_from_two_poses),
    cmocka_unit_test(place_under_finds_place_and_heading),
    cmocka_unit_test(dolls_lie_alike_whichever_way_they_head),
};

TEST_MAIN(tests, NULL, NULL)
