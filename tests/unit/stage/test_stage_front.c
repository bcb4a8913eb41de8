/* Bodies that were modelled with another front: all that asks for it gets the same answer, and they stand, look ahead
 * and look at points as one that faces +z does, turned. */
#include "support/stage_fixture.h"

#include "draw/facing.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"

#include <math.h>

#define FRONTS 4u

static const float half[FRONTS][2] = {
    { 0.0f, 1.0f }, { 0.70710678f, 0.70710678f }, { 1.0f, 0.0f }, { 0.70710678f, -0.70710678f }
}; /* sine and cosine of half a turn about y */

/* A puppet that was modelled so. */
typedef struct turned {
    cast cast;
    uint8_t *bytes;
    float turn[4], back[4];
    noh_actor actor;
} turned;

static void open_turned(turned *t, uint32_t front)
{
    cast *c = &t->cast;
    noh_skeleton joints;
    noh_transform *root;
    memset(t, 0, sizeof *t);
    t->turn[1] = half[front][0], t->turn[3] = half[front][1];
    noh_quat_conjugate(t->turn, t->back);
    cast_map(c, PUPPETS, "demo/puppet_falls.noh");
    t->bytes = malloc(c->files[0].bytes);
    assert_non_null(t->bytes);
    memcpy(t->bytes, c->files[0].data, c->files[0].bytes);
    c->packs[0] = test_open(t->bytes, c->files[0].bytes);
    assert_int_equal(noh_pack_skeleton_at(&c->packs[0], 0, &joints, NULL, NULL), NOH_OK);
    root = (void *)(t->bytes + ((const uint8_t *)joints.bind_pose - t->bytes));
    noh_quat_rotate(t->turn, root->translation, root->translation);
    noh_quat_mul(t->turn, root->rotation, root->rotation);
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
}

static void make_turned(turned *t)
{
    const noh_appearance posed = { .posed = 1 };
    cast_make(&t->cast, NULL);
    assert_int_equal(noh_stage_spawn(t->cast.stage, 0, NULL, &t->actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(t->cast.stage, t->actor, &posed, NULL), NOH_OK);
}

static void run(const turned *t, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++)
        assert_int_equal(noh_stage_frame(t->cast.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
}

static void close_turned(turned *t)
{
    cast_close_stage(&t->cast);
    noh_file_unmap(&t->cast.files[0]);
    free(t->bytes);
}

/* A vector of a joint in the body's own axes, as if it faced +z. v NULL: its place. */
static void own_of(const turned *t, uint32_t joint, const float *v, float out[3])
{
    float m[12];
    assert_int_equal(noh_actor_joint(t->cast.stage, t->actor, joint, m, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) out[i] = v ? m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2] : m[4 * i + 3];
    noh_quat_rotate(t->back, out, out);
}

static void is_near(const float a[3], const float b[3], float most)
{
    for (int i = 0; i < 3; i++) assert_float_equal(a[i], b[i], most);
}

static void it_stands_whatever_its_front(void **state)
{
    float straight[3];
    (void)state;
    for (uint32_t front = 0; front < FRONTS; front++) {
        float hand[3], elbow[3];
        noh_kind_stand stand;
        noh_modifier part;
        turned t;
        open_turned(&t, front);
        assert_int_equal(noh_kind_stand_make(&t.cast.kinds[0], &stand, NULL), NOH_OK);
        part = noh_stand_modifier(&stand);
        t.cast.kinds[0].modifiers = &part;
        t.cast.kinds[0].modifier_count = 1;
        make_turned(&t);
        run(&t, 1);
        own_of(&t, stand.arms.arms[0].fore, NULL, elbow);
        own_of(&t, stand.arms.arms[0].hand, NULL, hand);
        for (int i = 0; i < 3; i++) hand[i] -= elbow[i];
        if (!front) memcpy(straight, hand, sizeof hand);
        is_near(hand, straight, 1e-3f);
        close_turned(&t);
    }
    assert_true(straight[2] > 0.02f);
}

static void all_agree_on_the_front(void **state)
{
    static const double degrees[FRONTS] = { 0.0, 90.0, 180.0, -90.0 };
    (void)state;
    for (uint32_t front = 0; front < FRONTS; front++) {
        static const float z[3] = { 0.0f, 0.0f, 1.0f };
        noh_kind_stand stand;
        noh_gaze_rig gaze;
        float ahead[3];
        turned t;
        open_turned(&t, front);
        assert_int_equal(noh_kind_stand_make(&t.cast.kinds[0], &stand, NULL), NOH_OK);
        assert_int_equal(stand.front, front);
        assert_true(pack_facing(&t.cast.packs[0]) == degrees[front]);
        assert_int_equal(noh_gaze_rig_make(&t.cast.packs[0], 0, &gaze, NULL), NOH_OK);
        assert_memory_equal(&gaze, &stand.trunk, sizeof gaze);
        make_turned(&t);
        run(&t, 1);
        own_of(&t, gaze.joints[gaze.joint_count - 1u], gaze.ahead, ahead);
        is_near(ahead, z, 1e-4f);
        close_turned(&t);
    }
}

/* Limbs without names are left and right of the body, not of x. */
static void limbs_without_names_have_their_sides(void **state)
{
    (void)state;
    for (uint32_t front = 0; front < FRONTS; front++) {
        noh_retarget_rig named, unnamed;
        noh_ragdoll_source source;
        turned t;
        open_turned(&t, front);
        memset(&source, 0, sizeof source);
        source.pack = &t.cast.packs[0];
        source.metres = 1.0f;
        assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
        assert_int_equal(noh_retarget_rig_make(&source, &named, NULL), NOH_OK);
        for (uint32_t j = 0; j < source.joints.joint_count; j++) {
            const char *name = noh_pack_joint_name(source.pack, 0, j);
            const char *side = strrchr(name, '.'); /* "thigh.L" */
            if (side) t.bytes[(const uint8_t *)side + 1 - t.bytes] = 'q';
        }
        assert_int_equal(noh_retarget_rig_make(&source, &unnamed, NULL), NOH_OK);
        for (uint32_t side = 0; side < 2u; side++) {
            const uint32_t leg = NOH_BONE_UPPER_LEG + side * NOH_BONE_RIGHT;
            const uint32_t arm = NOH_BONE_UPPER_ARM + side * NOH_BONE_RIGHT;
            assert_int_equal(unnamed.bones[leg], named.bones[leg]);
            assert_int_equal(unnamed.bones[arm], named.bones[arm]);
        }
        close_turned(&t);
    }
}

/* A gaze at a point of the body's left, and one at nothing. */
static void a_gaze_is_of_its_own_front(void **state)
{
    (void)state;
    for (uint32_t front = 0; front < FRONTS; front++) {
        const float own[3] = { 1.0f, 1.4f, 2.0f };
        float ahead[3], place[3];
        noh_gaze_rig rig;
        noh_modifier part;
        noh_gaze *gaze;
        turned t;
        open_turned(&t, front);
        assert_int_equal(noh_gaze_rig_make(&t.cast.packs[0], 0, &rig, NULL), NOH_OK);
        part = noh_gaze_modifier(&rig);
        t.cast.kinds[0].modifiers = &part;
        t.cast.kinds[0].modifier_count = 1;
        make_turned(&t);
        const uint32_t head = rig.joints[rig.joint_count - 1u];
        run(&t, 60);
        own_of(&t, head, rig.ahead, ahead);
        assert_true(ahead[2] > 0.999f);
        gaze = noh_actor_modifier(t.cast.stage, t.actor, 0);
        noh_quat_rotate(t.turn, own, gaze->point);
        gaze->looks = 1;
        run(&t, 60);
        own_of(&t, head, rig.ahead, ahead);
        own_of(&t, head, NULL, place);
        assert_float_equal(atan2f(ahead[0], ahead[2]), atan2f(own[0] - place[0], own[2] - place[2]), 0.05f);
        close_turned(&t);
    }
}

/* Pushed from behind, it braces with knees that bend as they do. */
static void a_push_fells_it_whatever_its_front(void **state)
{
    static const char *const names[] = { "shin.L", "foot.L", "hand.R", "head" };
    static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    static const noh_world world = { .planes = &floor_plane, .plane_count = 1, .friction = 0.7f };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &world, .stagger_speed = -1.0f };
    float straight[TEST_COUNT(names)][3];
    (void)state;
    for (uint32_t front = 0; front < FRONTS; front++) {
        const float chest[3] = { 0.0f, 1.2f, -0.2f }, push[3] = { 0.0f, 0.0f, 90.0f };
        float point[3], impulse[3];
        noh_ragdoll_rig rig;
        noh_error error;
        turned t;
        open_turned(&t, front);
        assert_int_equal(noh_kind_can_fall(&t.cast.kinds[0], &rig, &error), NOH_OK);
        t.cast.kinds[0].ragdoll = noh_ragdoll_module(&ragdoll);
        make_turned(&t);
        run(&t, 2);
        noh_quat_rotate(t.turn, chest, point);
        noh_quat_rotate(t.turn, push, impulse);
        assert_int_equal(noh_actor_hit(t.cast.stage, t.actor, point, impulse, NULL), NOH_OK);
        run(&t, 24);
        for (uint32_t i = 0; i < TEST_COUNT(names); i++) {
            float at[3];
            own_of(&t, noh_stage_find(t.cast.stage, 0, NOH_NAME_JOINT, names[i]), NULL, at);
            if (!front) memcpy(straight[i], at, sizeof at);
            is_near(at, straight[i], 0.01f);
        }
        close_turned(&t);
    }
}

/* Eyes that are given at any front, and eyes that are found behind lids, which works along z alone. */
static void a_face_is_of_its_own_front(void **state)
{
    static const float own[2][3] = { { 0.035f, 1.55f, 0.11f }, { -0.035f, 1.55f, 0.11f } },
                       point[3] = { 0.7f, 1.4f, 2.0f };
    noh_face_pose straight;
    (void)state;
    for (uint32_t i = 0; i < FRONTS + 2u; i++) {
        const uint32_t front = i < FRONTS ? i : 2u * (i - FRONTS);
        static uint8_t scratch[1 << 20];
        noh_kind_face face = { .flags = NOH_FACE_CALM };
        noh_face_pose pose;
        float at[3];
        turned t;
        open_turned(&t, front);
        if (i < FRONTS) {
            for (int e = 0; e < 2; e++) noh_quat_rotate(t.turn, own[e], face.face.eyes[e]);
        } else {
            float found[2][3];
            assert_int_equal(noh_kind_find_eyes(&t.cast.kinds[0], scratch, sizeof scratch, face.face.eyes, NULL),
                             NOH_OK);
            for (int e = 0; e < 2; e++) noh_quat_rotate(t.back, face.face.eyes[e], found[e]);
            is_near(found[0], own[0], 0.05f);
            is_near(found[1], own[1], 0.05f);
        }
        t.cast.kinds[0].face = noh_face_module(&face);
        make_turned(&t);
        run(&t, 60);
        assert_int_equal(noh_actor_face(t.cast.stage, t.actor, &pose, NULL), NOH_OK);
        assert_float_equal(pose.eyes[0][0] + pose.eyes[1][0], 0.0f, 0.01f);
        noh_quat_rotate(t.turn, point, at);
        assert_int_equal(noh_actor_look_at(t.cast.stage, t.actor, at, NULL), NOH_OK);
        run(&t, 120);
        assert_int_equal(noh_actor_face(t.cast.stage, t.actor, &pose, NULL), NOH_OK);
        if (!i) straight = pose;
        for (int e = 0; e < 2; e++) {
            assert_float_equal(pose.eyes[e][0], straight.eyes[e][0], i < FRONTS ? 1e-3f : 0.05f);
            assert_float_equal(pose.eyes[e][1], straight.eyes[e][1], i < FRONTS ? 1e-3f : 0.05f);
            assert_float_equal(pose.head[e], straight.head[e], i < FRONTS ? 1e-3f : 0.05f);
        }
        close_turned(&t);
    }
    assert_true(straight.eyes[0][0] + 2.0f * atan2f(straight.head[1], straight.head[3]) > 0.25f); /* to its left */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_stands_whatever_its_front), cmocka_unit_test(all_agree_on_the_front),
        cmocka_unit_test(a_gaze_is_of_its_own_front),   cmocka_unit_test(a_push_fells_it_whatever_its_front),
        cmocka_unit_test(a_face_is_of_its_own_front),   cmocka_unit_test(limbs_without_names_have_their_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
