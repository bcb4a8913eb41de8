/* Gazes and hands on a stage: a walking puppet looks at a point of the world and holds on to another; its state is the
 * stage's; where there is a face, head and eyes are the face's. */
#include "support/stage_fixture.h"
#include "life/physics/ragdoll_rig_internal.h"

#include <math.h>
#include "noh/low_core.h"
#include "noh/modules.h"

typedef struct scene {
    cast cast;
    noh_gaze_rig gaze;
    noh_reach_rig reach;
    noh_kind_face face;
    noh_modifier parts[2];
    float middle[3], shoulder[3], arm; /* at rest */
} scene;

static void measure_rest(scene *s, const noh_skeleton *joints)
{
    const noh_reach_arm *arm = &s->reach.arms[0];
    float elbow[3], hand[3], rotation[4];
    noh_ragdoll_bind(joints, s->gaze.joints[s->gaze.joint_count - 1u], s->middle, rotation);
    noh_quat_rotate(rotation, s->gaze.middle, elbow);
    for (int i = 0; i < 3; i++) s->middle[i] += elbow[i];
    noh_ragdoll_bind(joints, arm->upper, s->shoulder, rotation);
    noh_ragdoll_bind(joints, arm->fore, elbow, rotation);
    noh_ragdoll_bind(joints, arm->hand, hand, rotation);
    s->arm = hypotf(hypotf(elbow[0] - s->shoulder[0], elbow[1] - s->shoulder[1]), elbow[2] - s->shoulder[2]) +
             hypotf(hypotf(elbow[0] - hand[0], elbow[1] - hand[1]), elbow[2] - hand[2]);
}

static void open_scene(scene *s)
{
    noh_ragdoll_source source;
    noh_error said;
    memset(s, 0, sizeof *s);
    cast_map(&s->cast, PUPPETS, "demo/puppet_levels.noh");
    memset(&source, 0, sizeof source);
    source.pack = &s->cast.packs[0];
    source.metres = 1.0f;
    assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    if (noh_gaze_rig_make(source.pack, 0, &s->gaze, &said) != NOH_OK) fail_msg("gaze: %s", said.what);
    if (noh_reach_rig_make(&source, &s->reach, &said) != NOH_OK) fail_msg("hands: %s", said.what);
    measure_rest(s, &source.joints);
    s->parts[0] = noh_gaze_modifier(&s->gaze);
    s->parts[1] = noh_reach_modifier(&s->reach);
}

static void make_scene(scene *s, uint32_t actors, uint32_t jobs)
{
    cast *c = &s->cast;
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].modifiers = s->parts;
    c->kinds[0].modifier_count = 2;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
    for (uint32_t i = 0; i < actors; i++) {
        const float half = 0.6f * (float)i;
        const noh_place place = { { 1.5f * (float)i, 0.1f, 0.0f }, { 0, sinf(half), 0, cosf(half) }, 1.0f };
        noh_actor actor;
        assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c->stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    }
}

static void close_scene(scene *s)
{
    cast_close_stage(&s->cast);
    noh_file_unmap(&s->cast.files[0]);
}

/* A point in an actor's space, in the world. */
static void world_of(const scene *s, noh_actor actor, const float at[3], float out[3])
{
    noh_place place;
    assert_int_equal(noh_actor_place(s->cast.stage, actor, &place, NULL), NOH_OK);
    noh_quat_rotate(place.rotation, at, out);
    for (int i = 0; i < 3; i++) out[i] += place.position[i];
}

static void frame(scene *s)
{
    const float middle[3] = { 2.0f, 1.0f, 0.0f };
    noh_stage_view view;
    noh_view_orbit(&view, middle, 0.5f, 0.2f, 9.0f, 640, 360);
    assert_int_equal(noh_stage_frame(s->cast.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

static void point_actor(scene *s, noh_actor actor, float time)
{
    noh_gaze *g = noh_actor_modifier(s->cast.stage, actor, 0);
    noh_reach *r = noh_actor_modifier(s->cast.stage, actor, 1);
    const float eyes[3] = { 1.2f * sinf(time), s->middle[1] + 0.3f * cosf(time), 2.0f };
    const float hand[3] = { s->shoulder[0] + 0.2f * s->arm * sinf(3.0f * time),
                            s->shoulder[1] - 0.2f * s->arm * cosf(3.0f * time), s->shoulder[2] + 0.6f * s->arm };
    world_of(s, actor, eyes, g->point);
    world_of(s, actor, hand, r->hands[0].point);
    g->looks = r->hands[0].wants = 1;
}

static void apply(const float m[12], const float v[3], float w, float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2] + w * m[4 * i + 3];
}

/* Degrees off its point, and metres. */
static void measure(const scene *s, noh_actor actor, float *turned, float *off)
{
    const noh_gaze *g = noh_actor_modifier(s->cast.stage, actor, 0);
    const noh_reach *r = noh_actor_modifier(s->cast.stage, actor, 1);
    const uint32_t head = s->gaze.joints[s->gaze.joint_count - 1u];
    float m[12], at[3], ahead[3], cosine = 0.0f, a = 0.0f, b = 0.0f;
    assert_int_equal(noh_actor_joint(s->cast.stage, actor, head, m, NULL), NOH_OK);
    apply(m, s->gaze.middle, 1.0f, at);
    apply(m, s->gaze.ahead, 0.0f, ahead);
    for (int i = 0; i < 3; i++) {
        const float way = g->point[i] - at[i];
        cosine += way * ahead[i], a += way * way, b += ahead[i] * ahead[i];
    }
    *turned = 57.29578f * acosf(fminf(1.0f, cosine / sqrtf(a * b)));
    assert_int_equal(noh_actor_joint(s->cast.stage, actor, s->reach.arms[0].hand, m, NULL), NOH_OK);
    *off = hypotf(hypotf(m[3] - r->hands[0].point[0], m[7] - r->hands[0].point[1]), m[11] - r->hands[0].point[2]);
}

static void puppets_look_and_reach(void **state)
{
    static scene s;
    float worst[2] = { 0.0f, 0.0f };
    (void)state;
    open_scene(&s);
    assert_int_equal(s.gaze.eyes[0], NOH_NONE);
    make_scene(&s, 3, 1);
    for (uint32_t f = 0; f < 240; f++) {
        for (uint32_t i = 0; i < 3; i++) point_actor(&s, noh_stage_actor_at(s.cast.stage, i), (float)f / 60.0f);
        frame(&s);
        for (uint32_t i = 0; f > 40 && i < 3; i++) {
            float turned, off;
            measure(&s, noh_stage_actor_at(s.cast.stage, i), &turned, &off);
            worst[0] = fmaxf(worst[0], turned);
            worst[1] = fmaxf(worst[1], off);
        }
    }
    printf("  looks by %.2f degrees past a moving point, the hand is off its own by %.2f mm\n", worst[0],
           1e3 * worst[1]);
    assert_true(worst[0] < 1.0f);
    assert_true(worst[1] < 0.001f);
    close_scene(&s);
}

/* Any number of jobs gives the same bits, as does a state that is put back; bytes that are not a state are refused. */
static void they_are_state_of_the_stage(void **state)
{
    static const uint32_t jobs[] = { 1, 3 };
    uint64_t hashes[40];
    static scene s;
    (void)state;
    for (int j = 0; j < 2; j++) {
        uint8_t *saved, *own;
        size_t bytes;
        noh_error said;
        open_scene(&s);
        make_scene(&s, 5, jobs[j]);
        for (uint32_t i = 0; i < 5; i++) point_actor(&s, noh_stage_actor_at(s.cast.stage, i), (float)i);
        for (uint32_t f = 0; f < 10; f++) frame(&s);
        own = (uint8_t *)noh_stage_state(s.cast.stage, &bytes);
        saved = test_aligned(own, (size_t)s.cast.plan.state_bytes);
        for (int again = 0; again < 2; again++) {
            for (uint32_t f = 0; f < 40; f++) {
                frame(&s);
                if (j + again == 0) hashes[f] = noh_stage_hash(s.cast.stage);
                if (noh_stage_hash(s.cast.stage) != hashes[f]) fail_msg("%u jobs: frame %u", jobs[j], (unsigned)f);
            }
            assert_int_equal(noh_stage_set_state(s.cast.stage, saved, bytes, NULL), NOH_OK);
        }
        for (uint32_t part = 0; part < 2; part++) {
            const uint8_t *at = noh_actor_modifier(s.cast.stage, noh_stage_actor_at(s.cast.stage, 3), part);
            float *forged = (float *)(void *)(saved + (at - own)), kept;
            if (part == 0) forged += 8; /* the gaze's point; a hand's comes first */
            kept = *forged;
            *forged = NAN;
            assert_int_equal(noh_stage_set_state(s.cast.stage, saved, bytes, &said), NOH_ERR_DATA);
            assert_non_null(strstr(said.what, part ? "reach" : "gaze"));
            *forged = kept;
        }
        free(saved);
        close_scene(&s);
    }
}

static void head_of(const scene *s, float m[12])
{
    const uint32_t head = s->gaze.joints[s->gaze.joint_count - 1u];
    assert_int_equal(noh_actor_joint(s->cast.stage, noh_stage_actor_at(s->cast.stage, 0), head, m, NULL), NOH_OK);
}

/* One owner: with a face the gaze part changes nothing. */
static void a_face_owns_head_and_eyes(void **state)
{
    static scene s;
    float heads[2][12];
    (void)state;
    for (int looks = 0; looks < 2; looks++) {
        open_scene(&s);
        s.face.face.eyes[0][0] = 0.04f, s.face.face.eyes[1][0] = -0.04f;
        for (int e = 0; e < 2; e++) s.face.face.eyes[e][1] = 1.6f, s.face.face.eyes[e][2] = 0.1f;
        s.cast.kinds[0].face = noh_face_module(&s.face);
        make_scene(&s, 1, 1);
        if (looks) {
            noh_gaze *g = noh_actor_modifier(s.cast.stage, noh_stage_actor_at(s.cast.stage, 0), 0);
            g->point[0] = 3.0f, g->point[1] = 1.0f, g->point[2] = 2.0f, g->looks = 1;
        }
        for (uint32_t f = 0; f < 60; f++) frame(&s);
        head_of(&s, heads[looks]);
        close_scene(&s);
    }
    assert_memory_equal(heads[0], heads[1], sizeof heads[0]);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(puppets_look_and_reach),
        cmocka_unit_test(they_are_state_of_the_stage),
        cmocka_unit_test(a_face_owns_head_and_eyes),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
