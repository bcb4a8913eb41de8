/* Ragdolls of actors: a puppet that walks, is hit, falls, lies and gets up; parts that fall, joints with strength; how
 * many may fall, dead actors; states saved, put back and tampered with; the same bits for any number of jobs. */
#include "support/stage_fixture.h"

#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"
#include "stage/modules/stage_ragdoll_internal.h"
#include "support/pack_walk.h"

#include <math.h>
#include <string.h>

static noh_error said;

static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };

static void open_cast(cast *c, uint32_t actors, const noh_kind_ragdoll *ragdoll, uint32_t jobs)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_falls.noh");
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].ragdoll = noh_ragdoll_module(ragdoll);
    c->kinds[0].inertia = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
}

static void close_cast(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
}

static noh_actor enter(const cast *c, float x)
{
    const noh_appearance posed = { .posed = 1 };
    const noh_place place = { { x, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c->stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &posed, NULL), NOH_OK);
    return actor;
}

static void run(const cast *c, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++) {
        assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    }
}

static void joint_at(const cast *c, noh_actor actor, const char *name, float out[3])
{
    float matrix[12];
    const uint32_t joint = noh_stage_find(c->stage, 0, NOH_NAME_JOINT, name);
    assert_true(joint != NOH_NONE);
    assert_int_equal(noh_actor_joint(c->stage, actor, joint, matrix, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) out[i] = matrix[4 * i + 3];
}

static float distance(const float a[3], const float b[3])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* 240 steps of 1/60 s, in frames of one to four: the same fall to the bit, and legs are braked in it. */
static void a_fall_has_the_same_bits_at_any_frame_rate(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    float hands[4][3], feet[4][3];
    (void)state;
    for (uint32_t n = 1; n <= 4; n++) {
        noh_actor actor;
        cast c;
        open_cast(&c, 1, &ragdoll, 1);
        cast_make(&c, NULL);
        actor = enter(&c, 0.0f);
        run(&c, 40);
        assert_int_equal(noh_actor_fall(c.stage, actor, NULL), NOH_OK);
        for (uint32_t f = 0; f < 240u; f += n) {
            assert_int_equal(noh_stage_frame(c.stage, n * CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        }
        joint_at(&c, actor, "hand.L", hands[n - 1u]);
        joint_at(&c, actor, "foot.L", feet[n - 1u]);
        assert_memory_equal(hands[0], hands[n - 1u], sizeof hands[0]);
        assert_memory_equal(feet[0], feet[n - 1u], sizeof feet[0]);
        close_cast(&c);
    }
}

/* From step to step no joint leaps, and none changes its speed but by what gravity and the ground do; it lies within
 * eight seconds, on the ground and not under it, and its place is where it lies. */
static void who_walks_falls_and_lies(void **state)
{
    static const char *const names[] = { "head", "hand.L", "hand.R", "foot.L", "foot.R", "hips" };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    float before[TEST_COUNT(names)][3], now[3];
    uint32_t frames = 0;
    noh_place place;
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    cast_make(&c, NULL);
    actor = enter(&c, 0.0f);
    run(&c, 40);
    assert_int_equal(noh_actor_body(c.stage, actor), 0);
    assert_int_equal(noh_actor_fall(c.stage, actor, &said), NOH_OK);
    assert_int_equal(noh_actor_body(c.stage, actor), 1);
    for (size_t i = 0; i < TEST_COUNT(names); i++) joint_at(&c, actor, names[i], before[i]);
    for (; frames < 480 && noh_actor_body(c.stage, actor) == 1; frames++) {
        run(&c, 1);
        for (size_t i = 0; i < TEST_COUNT(names); i++) {
            joint_at(&c, actor, names[i], now);
            assert_true(distance(before[i], now) < 0.2f); /* 12 m/s */
            assert_true(now[1] > -0.03f);
            memcpy(before[i], now, sizeof now);
        }
    }
    assert_int_equal(noh_actor_body(c.stage, actor), 2);
    assert_true(before[0][1] < 0.5f && before[5][1] < 0.5f);
    assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
    assert_true(hypotf(place.position[0] - before[5][0], place.position[2] - before[5][2]) < 0.3f);
    print_message("lies after %.2f s, its head at %.0f mm\n", (double)frames / 60.0, 1000.0 * (double)before[0][1]);
    close_cast(&c);
}

/* The first frame of the fall continues the walk: velocities come from the last two poses. Without a floor: that
 * would brake the feet. */
static void speeds_are_handed_over(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1 };
    float at[3][3];
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    cast_make(&c, NULL);
    actor = enter(&c, 0.0f);
    run(&c, 40);
    joint_at(&c, actor, "hips", at[0]);
    run(&c, 1);
    joint_at(&c, actor, "hips", at[1]);
    assert_int_equal(noh_actor_fall(c.stage, actor, NULL), NOH_OK);
    run(&c, 1);
    joint_at(&c, actor, "hips", at[2]);
    assert_true(distance(at[0], at[1]) > 0.005f); /* it walks */
    for (int i = 0; i < 3; i++) assert_true(fabsf(at[2][i] - 2.0f * at[1][i] + at[0][i]) < 0.006f);
    close_cast(&c);
}

/* One that stood there falls at 100 km as at the origin, to the step that floats have there, and gets up. */
static void it_falls_far_away(void **state)
{
    static const float bases[4][3] = {
        { 0.0f, 0.0f, 0.0f }, { 0.0f, 512.0f, 0.0f }, { 10000.0f, 1000.0f, -10000.0f }, { -100000.0f, 0.0f, 100000.0f }
    };
    static const char *const names[] = { "head", "hand.L", "foot.R", "hips" };
    static float shown[120][TEST_COUNT(names)][3];
    (void)state;
    for (int at = 0; at < 4; at++) {
        const float *base = bases[at], step = at < 3 ? 0.0015f : 0.012f;
        const noh_plane plane = { { 0.0f, 1.0f, 0.0f }, base[1] };
        const noh_world world = { .planes = &plane, .plane_count = 1, .friction = 0.6f };
        const noh_kind_ragdoll ragdoll = { .count = 1, .substeps = 20, .world = &world };
        const noh_appearance posed = { .posed = 1 };
        const noh_place place = { { base[0], base[1], base[2] }, { 0, 0, 0, 0 }, 0.0f };
        noh_actor actor;
        cast c;
        open_cast(&c, 1, &ragdoll, 1);
        c.kinds[0].root_axes = 0;
        cast_make(&c, NULL);
        assert_int_equal(noh_stage_spawn(c.stage, 0, &place, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c.stage, actor, 0, "idle", NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c.stage, actor, &posed, NULL), NOH_OK);
        run(&c, 20);
        assert_int_equal(noh_actor_fall(c.stage, actor, &said), NOH_OK);
        for (uint32_t f = 0; f < 120; f++) {
            run(&c, 1);
            for (size_t i = 0; i < TEST_COUNT(names); i++) {
                float now[3];
                joint_at(&c, actor, names[i], now);
                for (int k = 0; k < 3; k++) now[k] -= base[k];
                if (!at) memcpy(shown[f][i], now, sizeof now);
                assert_true(distance(now, shown[f][i]) < step);
            }
        }
        assert_int_equal(noh_actor_get_up(c.stage, actor, NULL, NULL, &said), NOH_OK);
        run(&c, 300);
        float head[3];
        joint_at(&c, actor, "head", head);
        assert_true(head[1] - base[1] > 1.2f);
        close_cast(&c);
    }
}

/* The game moves its world while actors stand, fall and lie: all of them move as they would have. */
static void a_world_is_shifted(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 2 };
    const float way[3] = { 5000.5f, -100.25f, 12345.75f };
    float at[2][3], stayed[2][3];
    noh_actor actors[2];
    cast c;
    (void)state;
    for (int shifts = 0; shifts < 2; shifts++) {
        open_cast(&c, 2, &ragdoll, 1);
        cast_make(&c, NULL);
        actors[0] = enter(&c, 0.0f);
        actors[1] = enter(&c, 2.0f);
        run(&c, 20);
        assert_int_equal(noh_actor_fall(c.stage, actors[0], NULL), NOH_OK);
        run(&c, 10);
        if (shifts) {
            const float back[3] = { -way[0], -way[1], -way[2] };
            assert_int_equal(noh_stage_shift_origin(c.stage, back, NULL), NOH_OK);
        }
        assert_int_equal(noh_actor_fall(c.stage, actors[1], NULL), NOH_OK); /* at its earlier speed */
        run(&c, 20);
        for (uint32_t i = 0; i < 2; i++) {
            joint_at(&c, actors[i], "hips", at[i]);
            for (int k = 0; k < 3; k++) at[i][k] -= shifts ? way[k] : 0.0f;
            if (!shifts) memcpy(stayed[i], at[i], sizeof at[i]);
            assert_true(distance(at[i], stayed[i]) < 0.003f);
        }
        close_cast(&c);
    }
}

static void a_hit_pushes(void **state)
{
    static const float impulse[3] = { 60.0f, 0.0f, 0.0f };
    const noh_kind_ragdoll ragdoll = { .count = 2, .world = &ground };
    float point[3], pushed[3], left[3];
    noh_actor actors[2];
    cast c;
    (void)state;
    open_cast(&c, 2, &ragdoll, 1);
    cast_make(&c, NULL);
    actors[0] = enter(&c, 0.0f);
    actors[1] = enter(&c, 0.0f);
    run(&c, 20);
    joint_at(&c, actors[0], "chest", point);
    for (int i = 0; i < 2; i++) assert_int_equal(noh_actor_fall(c.stage, actors[i], NULL), NOH_OK);
    assert_int_equal(noh_actor_hit(c.stage, actors[0], point, impulse, NULL), NOH_OK);
    run(&c, 30);
    joint_at(&c, actors[0], "chest", pushed);
    joint_at(&c, actors[1], "chest", left);
    assert_true(pushed[0] > left[0] + 0.15f);
    close_cast(&c);
}

static void what_cannot_fall_is_told(void **state)
{
    static const float zero[3] = { 0.0f, 0.0f, 0.0f }, bad[2][3] = { { 0.0f, NAN, 0.0f }, { 0.0f, 0.0f, 1e13f } };
    noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    noh_actor actors[2], gone = { 0 };
    cast c;
    (void)state;
    open_cast(&c, 2, &ragdoll, 1);
    cast_make(&c, NULL);
    actors[0] = enter(&c, 0.0f);
    actors[1] = enter(&c, 2.0f);
    assert_int_equal(noh_actor_fall(c.stage, gone, NULL), NOH_ERR_NOT_FOUND);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(noh_actor_hit(c.stage, actors[0], bad[i], zero, NULL), NOH_ERR_ARG);
        assert_int_equal(noh_actor_hit(c.stage, actors[0], zero, bad[i], NULL), NOH_ERR_ARG);
    }
    assert_int_equal(noh_actor_body(c.stage, actors[0]), 0);
    assert_int_equal(noh_actor_fall(c.stage, actors[0], NULL), NOH_OK); /* out of the bind pose: not shown yet */
    assert_int_equal(noh_actor_fall(c.stage, actors[1], &said), NOH_ERR_LIMIT);
    assert_int_equal(said.need, 2);
    assert_int_equal(noh_stage_despawn(c.stage, actors[0], NULL), NOH_OK); /* its doll is free again */
    assert_int_equal(noh_actor_fall(c.stage, actors[1], &said), NOH_OK);
    cast_close_stage(&c);
    c.kinds[0].ragdoll = noh_ragdoll_module(NULL);
    cast_make(&c, NULL);
    actors[0] = enter(&c, 0.0f);
    assert_int_equal(noh_actor_fall(c.stage, actors[0], &said), NOH_ERR_ARG);
    cast_close_stage(&c);
    ragdoll.count = 0;
    c.kinds[0].ragdoll = noh_ragdoll_module(&ragdoll);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_ARG);
    close_cast(&c);
}

/* ---- getting up ---- */

static const char *const rises[] = { "get_up_back", "get_up_front" };
static const noh_get_up rise = { .clips = rises, .clip_count = 2 };
static const noh_get_up blend = { .clips = rises }; /* no clip */
static const char *const tracked[] = { "head", "hand.L", "hand.R", "foot.L", "foot.R", "hips", "index_tip.L" };

static void track(const cast *c, noh_actor actor, float at[TEST_COUNT(tracked)][3])
{
    for (size_t i = 0; i < TEST_COUNT(tracked); i++) joint_at(c, actor, tracked[i], at[i]);
}

/* The largest change of a joint's speed, metres a frame, from before a call to after it. */
static float jolt(float at[3][TEST_COUNT(tracked)][3])
{
    float most = 0.0f;
    for (size_t i = 0; i < TEST_COUNT(tracked); i++) {
        float d[3];
        for (int k = 0; k < 3; k++) d[k] = at[2][i][k] - 2.0f * at[1][i][k] + at[0][i][k];
        most = fmaxf(most, sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
    }
    return most;
}

static void fall_with(const cast *c, noh_actor actor, float push)
{
    const float impulse[3] = { 0.0f, 0.0f, push };
    float chest[3];
    joint_at(c, actor, "chest", chest);
    assert_int_equal(noh_actor_fall(c->stage, actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_hit(c->stage, actor, chest, impulse, NULL), NOH_OK);
}

/* The only actor of a stage, which falls by a push. */
static noh_actor one_that_falls(cast *c, const noh_kind_ragdoll *ragdoll, float push)
{
    noh_actor actor;
    open_cast(c, 1, ragdoll, 1);
    cast_make(c, NULL);
    actor = enter(c, 0.0f);
    run(c, 40);
    fall_with(c, actor, push);
    return actor;
}

static void run_until_it_lies(cast *c, noh_actor actor)
{
    for (int f = 0; f < 480 && noh_actor_body(c->stage, actor) != NOH_BODY_LIES; f++) run(c, 1);
}

/* Pushed from the front it lies on its back, and from behind on its front. It gets up by the clip for that, stands
 * where it lay, on the ground, and from frame to frame nothing leaps. */
static void who_lies_gets_up(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    (void)state;
    for (uint32_t front = 0; front < 2; front++) {
        float at[3][TEST_COUNT(tracked)][3], lay[3];
        uint32_t ticks = 7;
        noh_place place;
        noh_actor actor;
        cast c;
        actor = one_that_falls(&c, &ragdoll, front ? 60.0f : -90.0f);
        run_until_it_lies(&c, actor);
        track(&c, actor, at[0]);
        run(&c, 1);
        track(&c, actor, at[1]);
        memcpy(lay, at[1][5], sizeof lay);
        assert_int_equal(noh_actor_get_up(c.stage, actor, front ? NULL : &rise, &ticks, &said), NOH_OK);
        assert_string_equal(noh_stage_name(c.stage, 0, NOH_NAME_CLIP, noh_actor_track(c.stage, actor, 0)->clip),
                            rises[front]);
        assert_true(ticks > NOH_TICKS_PER_SECOND);
        assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_GETS_UP);
        for (int f = 0; f < 240; f++) {
            run(&c, 1);
            track(&c, actor, at[2]);
            if (f == 0) print_message("first frame of getting up: %.2f mm\n", 1e3 * (double)jolt(at));
            assert_true(jolt(at) < (f == 0 ? 1e-3f : 0.025f));
            memmove(at[0], at[1], 2 * sizeof at[0]);
        }
        assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_STANDS);
        assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
        assert_true(fabsf(place.position[1]) < 1e-4f);
        assert_true(at[1][5][1] > 0.8f && at[1][3][1] < 0.12f && at[1][3][1] > 0.03f);
        assert_true(hypotf(at[1][5][0] - lay[0], at[1][5][2] - lay[2]) < 0.7f);
        close_cast(&c);
    }
}

/* The bodies of the ragdoll, which breath must not touch. */
static void bodies_of(const cast *c, noh_actor actor, noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX])
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(c->stage, actor, &k);
    memcpy(bodies, noh_stage_body_of(k, noh_stage_index(k, a))->bodies[0], NOH_RAGDOLL_BODIES_MAX * sizeof *bodies);
}

/* On its back and on its front its chest rises and falls by millimetres, four seconds a breath, from the last step on
 * without a leap, also as it gets up; what lies on the ground stays where it lies, and the ragdoll sleeps on. The dead
 * do not breathe. */
static void who_lies_breathes(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    (void)state;
    for (uint32_t way = 0; way < 3; way++) {
        noh_ragdoll_pose lay[NOH_RAGDOLL_BODIES_MAX], lies[NOH_RAGDOLL_BODIES_MAX];
        float first[TEST_COUNT(tracked)][3], now[TEST_COUNT(tracked)][3], before[3], chest[3];
        float low = 1e9f, high = -1e9f, slides = 0.0f, leap = 0.0f;
        noh_actor actor;
        cast c;
        actor = one_that_falls(&c, &ragdoll, way == 1 ? 60.0f : -90.0f);
        assert_int_equal(noh_actor_stop(c.stage, actor, 0, 1, NULL), NOH_OK); /* shoulders have no bodies */
        if (way == 2) assert_int_equal(noh_actor_kill(c.stage, actor, NULL), NOH_OK);
        run_until_it_lies(&c, actor);
        bodies_of(&c, actor, lay);
        track(&c, actor, first);
        joint_at(&c, actor, "chest", before);
        for (int f = 0; f < 480; f++) {
            run(&c, 1);
            track(&c, actor, now);
            joint_at(&c, actor, "chest", chest);
            for (size_t i = 0; i < TEST_COUNT(tracked); i++) slides = fmaxf(slides, distance(first[i], now[i]));
            leap = fmaxf(leap, distance(before, chest));
            low = fminf(low, chest[1]);
            high = fmaxf(high, chest[1]);
            memcpy(before, chest, sizeof before);
        }
        assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_LIES);
        bodies_of(&c, actor, lies);
        assert_memory_equal(lay, lies, sizeof lay);
        print_message("way %u: the chest rises by %.2f mm, at most %.2f a frame; others slide by %.4f\n", way,
                      1e3 * (double)(high - low), 1e3 * (double)leap, 1e3 * (double)slides);
        assert_true(way == 2 ? high == low : high - low > 0.004f && high - low < 0.008f);
        assert_true(leap < 0.0003f && slides < 1e-6f);
        if (way < 2) {
            for (int f = 0; f < 240 && high - before[1] > 0.0005f; f++) { /* at the top of a breath */
                run(&c, 1);
                joint_at(&c, actor, "chest", before);
            }
            assert_int_equal(noh_actor_get_up(c.stage, actor, &blend, NULL, &said), NOH_OK);
            run(&c, 1);
            joint_at(&c, actor, "chest", chest);
            print_message("first frame of getting up: %.2f mm\n", 1e3 * (double)distance(before, chest));
            assert_true(distance(before, chest) < 0.002f);
        }
        close_cast(&c);
    }
}

/* In the middle of a fall, where bodies are fast: neither places nor speeds leap. */
static void who_falls_gets_up_at_speed(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1 };
    float at[3][TEST_COUNT(tracked)][3], fastest = 0.0f, before;
    noh_actor actor;
    cast c;
    (void)state;
    actor = one_that_falls(&c, &ragdoll, 90.0f);
    run(&c, 11);
    for (int i = 0; i < 3; i++) {
        run(&c, 1);
        track(&c, actor, at[i]);
    }
    before = jolt(at);
    memmove(at[0], at[1], 2 * sizeof at[0]);
    for (size_t i = 0; i < TEST_COUNT(tracked); i++) fastest = fmaxf(fastest, distance(at[0][i], at[1][i]));
    assert_int_equal(noh_actor_get_up(c.stage, actor, &rise, NULL, &said), NOH_OK);
    run(&c, 1);
    track(&c, actor, at[2]);
    print_message("at %.1f mm a frame speeds change by %.2f mm, and by %.2f in the fall\n", 1e3 * (double)fastest,
                  1e3 * (double)jolt(at), 1e3 * (double)before);
    assert_true(fastest > 0.03f);
    assert_true(jolt(at) < before + 0.05f * fastest); /* limbs that turn change their direction in the fall, too */
    close_cast(&c);
}

/* Pushed away from an eye it falls away from it; having lain for a fifth of a second it gets up by a clip whose name
 * says so, and until that has ended it is not over. */
static void a_push_is_over_when_it_stands_again(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    const float eye[3] = { 0.0f, 3.0f, 4.0f }, above[3] = { 0.0f, 9.0f, 0.0f };
    float impulse[3], lay_z = 0.0f;
    uint32_t still = 0, rising = 0, frames = 0;
    noh_fall fall = { 0, 0, 0 };
    noh_place place;
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    cast_make(&c, NULL);
    actor = enter(&c, 0.0f);
    run(&c, 10);
    assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
    noh_push_away(above, (const float[3]){ 0.0f, 1.0f, 0.0f }, 90.0f, impulse);
    assert_true(impulse[0] == 0.0f && impulse[1] == 0.0f && impulse[2] == 0.0f);
    noh_push_away(eye, place.position, 180.0f, impulse);
    assert_true(impulse[1] == 0.0f && impulse[2] < -179.0f);
    assert_false(noh_fall_lasts(&fall, c.stage, actor));
    assert_int_equal(noh_actor_push(c.stage, actor, NULL, impulse, &said), NOH_OK);
    assert_true(noh_fall_lasts(&fall, c.stage, actor));
    for (; frames < 900 && noh_fall_lasts(&fall, c.stage, actor); frames++) {
        const noh_body_state body = noh_actor_body(c.stage, actor);
        float hips[3];
        still += body == NOH_BODY_LIES;
        rising += body != NOH_BODY_FALLS && body != NOH_BODY_LIES;
        joint_at(&c, actor, "hips", hips);
        if (body == NOH_BODY_LIES) lay_z = hips[2];
        assert_int_equal(noh_fall_step(&fall, c.stage, actor, 0, CAST_STEP, &said), NOH_OK);
        run(&c, 1);
    }
    print_message("lay for %u frames at %.2f m, got up in %u of %u\n", still, (double)lay_z, rising, frames);
    assert_true(lay_z < place.position[2] - 0.3f);
    assert_in_range(still, 12, 13);
    assert_in_range(rising, 60, 240); /* longer than what the ragdoll leaves takes to decay: the whole clip */
    assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_STANDS);
    assert_int_equal(strncmp(noh_stage_name(c.stage, 0, NOH_NAME_CLIP, noh_actor_track(c.stage, actor, 0)->clip),
                             NOH_GET_UP_CLIPS, strlen(NOH_GET_UP_CLIPS)),
                     0);
    close_cast(&c);
}

/* Where joints of a character whose unit is 25 cm are, some frames after a push or a hit at one of them as it falls. */
static void pushed_in_other_units(int is_hit, const char *at, float out[3][3])
{
    static const char *const names[3] = { "hips", "foot.L", "foot.R" };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    const float impulse[3] = { 30.0f, 0.0f, 60.0f };
    const noh_skeleton_header *header;
    noh_skeleton skeleton;
    float point[3];
    uint8_t *bytes;
    noh_actor actor;
    cast c;
    open_cast(&c, 1, &ragdoll, 1);
    bytes = test_aligned(c.files[PUPPETS].data, c.files[PUPPETS].bytes);
    assert_int_equal(noh_pack_skeleton_at(&c.packs[0], 0, &skeleton, &header, NULL), NOH_OK);
    const size_t offset = (size_t)((const uint8_t *)header - (const uint8_t *)c.packs[0].bytes);
    ((noh_skeleton_header *)(void *)(bytes + offset))->unit_cm = 25.0f;
    pack_repair(bytes, c.files[PUPPETS].bytes);
    c.packs[0] = test_open(bytes, c.files[PUPPETS].bytes);
    cast_make(&c, NULL);
    actor = enter(&c, 3.0f);
    run(&c, 40);
    assert_int_equal(noh_actor_fall(c.stage, actor, &said), NOH_OK);
    run(&c, 2);
    joint_at(&c, actor, at, point);
    if (is_hit) {
        for (int i = 0; i < 3; i++) point[i] *= 0.25f;
        assert_int_equal(noh_actor_hit(c.stage, actor, point, impulse, &said), NOH_OK);
    } else {
        assert_int_equal(noh_actor_push(c.stage, actor, point, impulse, &said), NOH_OK);
    }
    run(&c, 4);
    for (int i = 0; i < 3; i++) joint_at(&c, actor, names[i], out[i]);
    close_cast(&c);
    free(bytes);
}

/* A point in units is that point in metres. */
static void a_push_is_a_hit_in_metres(void **state)
{
    static const char *const at[] = { "foot.L", "foot.R", "head" };
    float last[3][3] = { { 0.0f } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(at); i++) {
        float pushed[3][3], hit[3][3];
        pushed_in_other_units(0, at[i], pushed);
        pushed_in_other_units(1, at[i], hit);
        assert_memory_equal(pushed, hit, sizeof hit);
        assert_memory_not_equal(pushed, last, sizeof last); /* the body that is hit makes a difference */
        memcpy(last, pushed, sizeof last);
    }
}

/* Without a clip it goes back to what plays, where it lies. */
static void without_a_clip_it_goes_on(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    uint32_t ticks = 7;
    float hips[3];
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    cast_make(&c, NULL);
    actor = enter(&c, 0.0f);
    assert_int_equal(noh_actor_get_up(c.stage, actor, &blend, &ticks, NULL), NOH_OK); /* it stands */
    assert_int_equal(ticks, 0);
    run(&c, 10);
    assert_int_equal(noh_actor_fall(c.stage, actor, NULL), NOH_OK);
    run(&c, 60);
    assert_int_equal(noh_actor_get_up(c.stage, actor, &blend, &ticks, NULL), NOH_OK);
    assert_int_equal(ticks, NOH_TICKS_PER_SECOND * 2 / 5);
    run(&c, 40);
    joint_at(&c, actor, "hips", hips);
    assert_true(hips[1] > 0.8f);
    close_cast(&c);
}

/* ---- in part ---- */

static void hold(const cast *c, noh_actor actor, const char *joint, const noh_body_hold *how)
{
    const uint32_t index = noh_stage_find(c->stage, 0, NOH_NAME_JOINT, joint);
    assert_int_equal(noh_actor_hold_body(c->stage, actor, index, how, &said), NOH_OK);
}

/* An arm hangs from a walking actor: all else is as without the ragdoll, and the arm is not. */
static void an_arm_falls_alone(void **state)
{
    static const noh_body_hold held = { .held = 1 }, limp = { 0 };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    float walks[TEST_COUNT(tracked)][3], falls[TEST_COUNT(tracked)][3];
    noh_actor actors[2];
    cast c;
    (void)state;
    open_cast(&c, 2, &ragdoll, 1);
    cast_make(&c, NULL);
    for (int i = 0; i < 2; i++) actors[i] = enter(&c, 0.0f);
    run(&c, 20);
    hold(&c, actors[1], "hips", &held);
    hold(&c, actors[1], "upper_arm.L", &limp);
    assert_int_equal(noh_actor_fall(c.stage, actors[1], NULL), NOH_OK);
    run(&c, 120);
    assert_int_equal(noh_actor_body(c.stage, actors[1]), NOH_BODY_FALLS);
    track(&c, actors[0], walks);
    track(&c, actors[1], falls);
    for (size_t i = 0; i < TEST_COUNT(tracked); i++) {
        const float apart = distance(walks[i], falls[i]);
        if (i == 1 || i == 6) {
            assert_true(apart > 0.05f && apart < 0.8f);
        } else {
            assert_true(apart < 1e-4f);
        }
    }
    assert_int_equal(noh_actor_get_up(c.stage, actors[1], &blend, NULL, NULL), NOH_OK);
    run(&c, 60);
    track(&c, actors[0], walks);
    track(&c, actors[1], falls);
    for (size_t i = 0; i < TEST_COUNT(tracked); i++) assert_true(distance(walks[i], falls[i]) < 1e-4f);
    close_cast(&c);
}

/* Two actors that are hit alike in the air: joints with strength keep the pose of the clip, limp ones do not; and what
 * is shown as clips have it has no strength, but shows it. */
static void joints_have_strength(void **state)
{
    static const noh_body_hold strong = { .hertz = 15.0f }, shown = { .animated = 1.0f };
    static const float impulse[3] = { 0.0f, 12.0f, 0.0f };
    const noh_kind_ragdoll ragdoll = { .count = 3 };
    float reach[4];
    noh_actor actors[4];
    cast c;
    (void)state;
    open_cast(&c, 4, &ragdoll, 1);
    cast_make(&c, NULL);
    for (int i = 0; i < 4; i++) actors[i] = enter(&c, 0.0f);
    run(&c, 20);
    hold(&c, actors[2], "hips", &strong);
    hold(&c, actors[3], "hips", &shown);
    for (int i = 1; i < 4; i++) {
        float hand[3];
        joint_at(&c, actors[i], "hand.L", hand);
        assert_int_equal(noh_actor_fall(c.stage, actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_hit(c.stage, actors[i], hand, impulse, NULL), NOH_OK);
    }
    run(&c, 20);
    for (int i = 0; i < 4; i++) {
        float hand[3], foot[3];
        joint_at(&c, actors[i], "hand.L", hand);
        joint_at(&c, actors[i], "foot.R", foot);
        reach[i] = distance(hand, foot);
    }
    print_message("hand to foot: %.0f walking, %.0f limp, %.0f with strength, %.0f shown as the clip has it, mm\n",
                  1e3 * (double)reach[0], 1e3 * (double)reach[1], 1e3 * (double)reach[2], 1e3 * (double)reach[3]);
    assert_true(fabsf(reach[1] - reach[0]) > 0.1f);
    assert_true(fabsf(reach[2] - reach[0]) < 0.35f * fabsf(reach[1] - reach[0]));
    assert_true(fabsf(reach[3] - reach[0]) < 1e-3f);
    close_cast(&c);
}

/* The dead do not get up, and give their ragdoll back once they lie; a hit takes one again. */
static void the_dead_lie(void **state)
{
    static const float impulse[3] = { 0.0f, 0.0f, 30.0f };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    float chest[2][3];
    noh_actor actors[2];
    cast c;
    (void)state;
    open_cast(&c, 2, &ragdoll, 1);
    cast_make(&c, NULL);
    for (int i = 0; i < 2; i++) actors[i] = enter(&c, 2.0f * (float)i);
    run(&c, 20);
    assert_int_equal(noh_actor_kill(c.stage, actors[0], NULL), NOH_OK);
    assert_int_equal(noh_actor_fall(c.stage, actors[1], NULL), NOH_ERR_LIMIT);
    for (int f = 0; f < 480 && noh_actor_body(c.stage, actors[0]) != NOH_BODY_LIES; f++) run(&c, 1);
    assert_int_equal(noh_actor_get_up(c.stage, actors[0], &rise, NULL, NULL), NOH_ERR_ARG);
    joint_at(&c, actors[0], "chest", chest[0]);
    assert_int_equal(noh_actor_fall(c.stage, actors[1], NULL), NOH_OK);
    run(&c, 60);
    joint_at(&c, actors[0], "chest", chest[1]);
    assert_true(distance(chest[0], chest[1]) < 1e-3f);
    assert_int_equal(noh_actor_hit(c.stage, actors[0], chest[1], impulse, NULL), NOH_ERR_LIMIT);
    assert_int_equal(noh_actor_get_up(c.stage, actors[1], &rise, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_hit(c.stage, actors[0], chest[1], impulse, NULL), NOH_OK);
    run(&c, 20);
    joint_at(&c, actors[0], "chest", chest[1]);
    assert_true(chest[1][2] > chest[0][2] + 0.02f);
    for (int f = 0; f < 480 && noh_actor_body(c.stage, actors[0]) != NOH_BODY_LIES; f++) run(&c, 1);
    assert_int_equal(noh_actor_revive(c.stage, actors[0], NULL), NOH_OK);
    assert_int_equal(noh_actor_get_up(c.stage, actors[0], &rise, NULL, NULL), NOH_OK);
    run(&c, 220);
    joint_at(&c, actors[0], "chest", chest[1]);
    assert_true(chest[1][1] > 0.9f);
    close_cast(&c);
}

/* With clips by need: by a clip that is there, though another is more like the ragdoll; one that is named fails. */
static void who_gets_up_takes_a_clip_that_is_there(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    const noh_pack_chunk *chunks;
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    c.kinds[0].clip_reserve = 1u << 18;
    cast_make(&c, NULL);
    chunks = c.packs[0].chunks + c.packs[0].runs[NOH_CHUNK_CLIP].first;
    for (uint32_t i = 0; noh_stage_name(c.stage, 0, NOH_NAME_CLIP, i); i++) {
        if (strcmp(noh_stage_name(c.stage, 0, NOH_NAME_CLIP, i), rises[0]) == 0) continue;
        assert_int_equal(noh_stage_load_clip(c.stage, 0, i, (const uint8_t *)c.files[0].data + chunks[i].offset, &said),
                         NOH_OK);
    }
    actor = enter(&c, 0.0f);
    run(&c, 40);
    fall_with(&c, actor, -90.0f); /* onto its back */
    run_until_it_lies(&c, actor);
    assert_int_equal(noh_actor_get_up(c.stage, actor, &rise, NULL, &said), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "not in memory"));
    assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_LIES);
    assert_int_equal(noh_stage_stats_of(c.stage)->wanted_count, 1);
    assert_int_equal(noh_actor_get_up(c.stage, actor, NULL, NULL, &said), NOH_OK);
    assert_string_equal(noh_stage_name(c.stage, 0, NOH_NAME_CLIP, noh_actor_track(c.stage, actor, 0)->clip), rises[1]);
    close_cast(&c);
}

static void what_cannot_get_up_is_told(void **state)
{
    static const char *const unknown[] = { "get_up_back", "no such clip" };
    static const noh_get_up bad = { .clips = unknown, .clip_count = 2 };
    noh_body_hold hold_by = { .hertz = -1.0f };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    uint32_t hips;
    noh_actor actor, gone = { 0 };
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    cast_make(&c, NULL);
    actor = enter(&c, 0.0f);
    hips = noh_stage_find(c.stage, 0, NOH_NAME_JOINT, "hips");
    assert_int_equal(noh_actor_get_up(c.stage, gone, &blend, NULL, NULL), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_actor_hold_body(c.stage, actor, hips, &hold_by, NULL), NOH_ERR_ARG);
    hold_by = (noh_body_hold){ .animated = 1.5f };
    assert_int_equal(noh_actor_hold_body(c.stage, actor, hips, &hold_by, NULL), NOH_ERR_ARG);
    hold_by.animated = 0.0f;
    assert_int_equal(noh_actor_hold_body(c.stage, actor, 4000, &hold_by, NULL), NOH_ERR_ARG);
    run(&c, 5);
    assert_int_equal(noh_actor_fall(c.stage, actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_get_up(c.stage, actor, &bad, NULL, &said), NOH_ERR_NOT_FOUND);
    assert_int_equal(said.where, 1);
    assert_int_equal(noh_actor_get_up(c.stage, actor, &(noh_get_up){ rises, 2, 9, 0 }, NULL, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_FALLS);
    close_cast(&c);
}

static void every_byte_is_planned(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 3, .world = &ground };
    noh_stage_bytes list[64];
    uint64_t sum = 0;
    noh_stage *made = NULL;
    cast c;
    (void)state;
    open_cast(&c, 5, &ragdoll, 2);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    for (uint32_t i = noh_stage_plan_parts(&c.desc, NULL, &c.plan, list, 64); i-- > 0;) sum += list[i].cpu_bytes;
    assert_true(sum == c.plan.cpu_bytes);
    c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes - 1u, NULL, &c.desc, &c.plan, &made, NULL),
                     NOH_ERR_MEMORY);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes, NULL, &c.desc, &c.plan, &c.stage, NULL),
                     NOH_OK);
    close_cast(&c);
}

/* Five fall one after another, and four get up. */
static uint64_t five_fall(uint32_t jobs, int restored)
{
    static const float impulse[3] = { 20.0f, 10.0f, -30.0f };
    const noh_kind_ragdoll ragdoll = { .count = 5, .world = &ground };
    noh_actor actors[5];
    uint64_t hash;
    size_t bytes;
    void *copy = NULL;
    cast c;
    open_cast(&c, 5, &ragdoll, jobs);
    cast_make(&c, NULL);
    for (uint32_t i = 0; i < 5; i++) actors[i] = enter(&c, 1.1f * (float)i);
    for (uint32_t i = 0; i < 5; i++) {
        const float point[3] = { 1.1f * (float)i, 1.0f, 0.1f };
        run(&c, 7);
        assert_int_equal(noh_actor_fall(c.stage, actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_hit(c.stage, actors[i], point, impulse, NULL), NOH_OK);
        if (i == 2 && restored) {
            copy = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
            run(&c, 90);
            assert_int_equal(noh_stage_set_state(c.stage, copy, (size_t)c.plan.state_bytes, NULL), NOH_OK);
        }
    }
    run(&c, 60);
    for (uint32_t i = 0; i < 4; i++) assert_int_equal(noh_actor_get_up(c.stage, actors[i], &rise, NULL, NULL), NOH_OK);
    run(&c, 10);
    if (copy) {
        free(copy);
        copy = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
        run(&c, 90);
        assert_int_equal(noh_stage_set_state(c.stage, copy, (size_t)c.plan.state_bytes, NULL), NOH_OK);
    }
    run(&c, 30);
    hash = noh_stage_hash(c.stage);
    if (copy) { /* any bit of the dolls may be wrong: refused, or finite */
        uint8_t *state = copy;
        for (size_t at = 0; at < (size_t)c.plan.state_bytes; at += 61) {
            state[at] ^= 0x80;
            (void)noh_stage_set_state(c.stage, state, (size_t)c.plan.state_bytes, NULL);
            state[at] ^= 0x80;
        }
        memset(state + c.plan.state_bytes / 2u, 0xff, c.plan.state_bytes / 2u);
        assert_int_equal(noh_stage_set_state(c.stage, state, (size_t)c.plan.state_bytes, NULL), NOH_ERR_DATA);
        free(copy);
    }
    close_cast(&c);
    return hash;
}

static void the_same_bits_for_any_jobs_and_after_a_restore(void **state)
{
    (void)state;
    const uint64_t one = five_fall(1, 0);
    assert_true(one == five_fall(3, 0));
    assert_true(one == five_fall(1, 1));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(who_walks_falls_and_lies),
    cmocka_unit_test(a_fall_has_the_same_bits_at_any_frame_rate),
    cmocka_unit_test(speeds_are_handed_over),
    cmocka_unit_test(it_falls_far_away),
    cmocka_unit_test(a_world_is_shifted),
    cmocka_unit_test(a_hit_pushes),
    cmocka_unit_test(what_cannot_fall_is_told),
    cmocka_unit_test(who_lies_gets_up),
    cmocka_unit_test(who_lies_breathes),
    cmocka_unit_test(a_push_is_a_hit_in_metres),
    cmocka_unit_test(a_push_is_over_when_it_stands_again),
    cmocka_unit_test(who_falls_gets_up_at_speed),
    cmocka_unit_test(without_a_clip_it_goes_on),
    cmocka_unit_test(an_arm_falls_alone),
    cmocka_unit_test(joints_have_strength),
    cmocka_unit_test(the_dead_lie),
    cmocka_unit_test(who_gets_up_takes_a_clip_that_is_there),
    cmocka_unit_test(what_cannot_get_up_is_told),
    cmocka_unit_test(every_byte_is_planned),
    cmocka_unit_test(the_same_bits_for_any_jobs_and_after_a_restore),
};

TEST_MAIN(tests, NULL, NULL)
