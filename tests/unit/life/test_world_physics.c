/* Tests of world_ask.c: a game's physics that knows the same shapes gives the same bits as the shapes of a world. */
#include "life/physics/world_ask_internal.h"
#include "life/physics/world_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/game_physics.h"
#include "support/ragdoll_kernels.h"
#include "support/support.h"

#define DOLLS 5u
#define BODIES 6u

/* A floor that slopes, and two walls. */
static const noh_plane planes[3] = { { { 0.0f, 0.96f, 0.28f }, -0.1f },
                                     { { 0.6f, 0.0f, 0.8f }, -0.5f },
                                     { { -1.0f, 0.0f, 0.0f }, -0.4f } };
static const noh_world corner = { .planes = planes, .plane_count = 3, .friction = 0.5f, .restitution = 0.2f };

static uint32_t seed;

static float random_in(float low, float high)
{
    seed = seed * 1664525u + 1013904223u;
    return low + (high - low) * (float)(seed >> 8) / 16777216.0f;
}

static noh_ragdoll_rig chain(void)
{
    noh_ragdoll_rig rig;
    memset(&rig, 0, sizeof rig);
    rig.body_count = BODIES;
    for (uint32_t i = 0; i < BODIES; i++) {
        noh_ragdoll_body *b = &rig.bodies[i];
        *b = (noh_ragdoll_body){ .parent = i ? i - 1u : NOH_NONE, .half = i == 2 ? 0.01f : 0.06f, .radius = 0.04f };
        b->mass = 2.0f;
        b->inertia_across = 0.01f;
        b->inertia_along = 0.004f;
        b->position[1] = 2.0f - 0.2f * (float)i;
        b->rotation[0] = -0.70710678f;
        b->rotation[3] = 0.70710678f;
        rig.joints[i].flags = NOH_RAGDOLL_LOOSE;
        rig.joints[i].anchor[1] = 2.1f - 0.2f * (float)i;
        rig.joints[i].frame[3] = 1.0f;
        rig.joints[i].friction = 0.1f;
    }
    return rig;
}

static noh_ragdolls *made(const noh_ragdoll_rig *rig, uint32_t asks)
{
    const noh_ragdolls_desc desc = { rig, DOLLS, 10, asks };
    noh_ragdoll_pose poses[BODIES];
    noh_ragdoll_motion motions[BODIES];
    noh_ragdolls *set;
    void *memory = malloc(noh_ragdolls_size(&desc));
    assert_int_equal(noh_ragdolls_init(memory, noh_ragdolls_size(&desc), &desc, &set, NULL), NOH_OK);
    seed = 9;
    for (uint32_t d = 0; d < DOLLS; d++) {
        noh_ragdoll_bodies(set, d, poses);
        for (uint32_t i = 0; i < BODIES; i++) {
            poses[i].position[0] += 0.02f * (float)d;
            for (int k = 0; k < 3; k++) {
                motions[i].velocity[k] = random_in(-3.0f, 2.0f);
                motions[i].spin[k] = random_in(-4.0f, 4.0f);
            }
        }
        assert_int_equal(noh_ragdoll_place(set, d, poses, motions, NULL), NOH_OK);
    }
    return set;
}

static void expect_equal(noh_ragdolls *a, noh_ragdolls *b, int frame)
{
    if (memcmp(noh_ragdoll_dolls(a), noh_ragdoll_dolls(b), DOLLS * sizeof(noh_ragdoll_doll)) != 0) {
        fail_msg("dolls differ after frame %d", frame);
    }
}

/* Ragdolls that fall into a corner of three planes, and lie: with the game's planes, and with its worst answers. */
static void ragdolls_fall_alike(void **state)
{
    const noh_ragdoll_rig rig = chain();
    (void)state;
    for (int spoils = 0; spoils < 2; spoils++) {
        game_physics game;
        const noh_world world = game_world(&game, &corner);
        noh_ragdolls *own = made(&rig, 0), *asking = made(&rig, 1);
        game.spoils = spoils;
        assert_int_equal(noh_world_check(&world, NULL), NOH_OK);
        for (int f = 0; f < 240; f++) {
            noh_ragdolls_step(own, &corner, NOH_RAGDOLL_STEP_TICKS);
            noh_ragdolls_step(asking, &world, NOH_RAGDOLL_STEP_TICKS);
            if (!spoils) expect_equal(own, asking, f);
        }
        if (spoils) {
            noh_ragdoll_measures m;
            noh_ragdoll_measure(asking, 0, &corner, &m);
            assert_true(m.energy == m.energy);
        }
        assert_true(game.batches > 100 && game.touches == game.batches * BODIES); /* a doll at a time */
        free(own);
        free(asking);
    }
}

/* Answers that break the rules are as if they were not given, and leave no number that is not finite. */
static void bad_answers_do_not_count(void **state)
{
    const noh_world_body body = { { 3.0f, 1.0f, 2.0f }, { { 0.0f, 0.1f, 0.0f }, { 0.1f, 0.2f, 0.0f }, 0.1f }, 1.0f };
    const noh_world_ray ray = { { 0.0f, 0.0f, 0.0f }, { { 0.0f, 3.0f, 0.0f }, { 0.0f, -1.0f, 0.0f }, 9.0f } };
    game_physics game;
    const noh_world world = game_world(&game, &corner);
    noh_touches good[3], spoilt[3];
    noh_world_body bodies[3] = { body, body, body };
    noh_world_ray rays[2] = { ray, ray };
    noh_world_hit hits[2];
    float height;
    (void)state;
    noh_world_ask_rays(&world, rays, 2, hits);
    assert_true(hits[0].distance > 0.0f && hits[1].distance == hits[0].distance);
    assert_true(noh_world_ground_below(&world, ray.origin, ray.ray.from, 3.0f, &height));
    noh_world_ask_touches(&world, bodies, 3, good);
    game.spoils = 1;
    noh_world_ask_touches(&world, bodies, 3, spoilt);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(good[i].count, 6);
        assert_int_equal(spoilt[i].count, 6);
        for (uint32_t k = 0; k < 6; k++) {
            assert_memory_equal(&good[i].at[k].plane, &spoilt[i].at[k].plane, sizeof(noh_plane));
            assert_true(good[i].at[k].along == spoilt[i].at[k].along);
        }
    }
    for (int i = 0; i < 4; i++) {
        noh_world_ask_rays(&world, rays, 2, hits);
        assert_true(hits[0].distance < 0.0f && hits[1].distance < 0.0f);
        assert_false(noh_world_ground_below(&world, ray.origin, ray.ray.from, 3.0f, &height));
    }
}

/* A set without room for answers asks nothing; one with room is 20,480 bytes larger. */
static void room_is_planned(void **state)
{
    const noh_ragdoll_rig rig = chain();
    noh_ragdolls_desc desc = { &rig, DOLLS, 10, 0 };
    const size_t plain = noh_ragdolls_size(&desc);
    game_physics game;
    const noh_world world = game_world(&game, &corner);
    noh_ragdolls *set = made(&rig, 0);
    (void)state;
    desc.asks = 1;
    assert_int_equal(noh_ragdolls_size(&desc), plain + 20480u);
    for (int f = 0; f < 60; f++) noh_ragdolls_step(set, &world, NOH_RAGDOLL_STEP_TICKS);
    assert_int_equal(game.batches, 0);
    free(set);
}

/* Boxes, balls and point masses in the same corner. */
static void rigid_bodies_fall_alike(void **state)
{
    static const float sides[3][4] = { { 0.1f, 0.06f, 0.15f, 0.0f }, { 0, 0, 0, 0.1f }, { 0.05f, 0.0f, 0.2f, 0.03f } };
    (void)state;
    for (int i = 0; i < 3; i++) {
        game_physics game;
        const noh_world world = game_world(&game, &corner);
        const noh_rigid_desc desc = { .half = { sides[i][0], sides[i][1], sides[i][2] },
                                      .radius = sides[i][3],
                                      .mass = 3.0f,
                                      .position = { -0.1f, 1.0f, 0.1f } };
        const float speed[3] = { 2.0f, -1.0f, -2.0f }, spin[3] = { 3.0f, 5.0f, 1.0f };
        float p[2][3] = { { 0.0f, 1.0f, 0.0f }, { 0.0f, 1.0f, 0.0f } }, v[2][3] = { { 1, -3, -2 }, { 1, -3, -2 } };
        noh_rigid own, asking;
        assert_int_equal(noh_rigid_init(&own, &desc, NULL), NOH_OK);
        assert_int_equal(noh_rigid_set_motion(&own, speed, spin, NULL), NOH_OK);
        asking = own;
        for (int f = 0; f < 200; f++) {
            noh_rigid_step(&own, &corner, NULL, 333);
            noh_rigid_step(&asking, &world, NULL, 333);
            assert_memory_equal(&own, &asking, sizeof own);
            for (int k = 0; k < 2; k++) {
                static const float down[3] = { 0.0f, -9.82f, 0.0f };
                noh_point_move(p[k], v[k], down, 0.01f);
                noh_point_touch(k ? &world : &corner, 0.05f, p[k], v[k], 0.01f);
            }
            assert_memory_equal(p[0], p[1], sizeof p[0]);
        }
        assert_true(game.touches > 1000);
    }
}

/* What feet and steps ask: ground of every shape, and walls. */
static void rays_meet_the_same_ground(void **state)
{
    static uint16_t heights[16] = { 3, 9, 1, 0, 4, 7, 7, 2, 0, 1, 8, 8, 2, 2, 5, 1 };
    const noh_field field = { heights, 4, 4, { -3.0f, -0.5f, -3.0f }, 2.0f, 0.125f };
    const noh_capsule post = { { 0.5f, 0.0f, 0.5f }, { 1.5f, 0.5f, 0.5f }, 0.25f };
    const noh_obb step = { { -1.0f, 0.25f, 0.0f }, { 0.5f, 0.25f, 2.0f }, { 0.0f, 0.38268343f, 0.0f, 0.92387953f } };
    const noh_plane level = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    const noh_world shapes = { .planes = &level,
                               .capsules = &post,
                               .boxes = &step,
                               .plane_count = 1,
                               .capsule_count = 1,
                               .box_count = 1,
                               .field = &field };
    game_physics game;
    const noh_world world = game_world(&game, &shapes);
    const noh_ground own = { &shapes, NULL, NULL }, asking = { &world, NULL, NULL };
    uint32_t walls = 0;
    (void)state;
    seed = 4;
    for (int i = 0; i < 3000; i++) {
        const float at[3] = { random_in(-3.0f, 3.0f), random_in(0.6f, 2.0f), random_in(-3.0f, 3.0f) };
        const float turned = random_in(0.0f, 6.28f), none[3] = { 0.0f, 0.0f, 0.0f };
        const noh_ray ray = { { at[0], 0.25f, at[2] }, { cosf(turned), 0.0f, sinf(turned) }, 4.0f };
        float a[3], b[3];
        const float far = noh_world_wall_ahead(&shapes, none, &ray);
        assert_true(noh_ground_below(&own, at, 4.0f, a) == noh_ground_below(&asking, at, 4.0f, b));
        assert_memory_equal(a, b, sizeof a);
        assert_true(noh_world_wall_ahead(&world, none, &ray) == (far <= 4.0f ? far : 1e30f));
        walls += far <= 4.0f;
    }
    assert_true(walls > 500);
}

#if defined(__x86_64__)
typedef void (*step_dolls)(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                           uint32_t count, float *scratch, float size);

/* Of what is asked, and of the dolls after it. */
static void hash_by(step_dolls step, uint32_t hashes[2])
{
    const noh_ragdoll_rig rig = chain();
    game_physics game;
    const noh_world world = game_world(&game, &corner);
    noh_ragdolls *set = made(&rig, 1);
    noh_ragdoll_doll *dolls[DOLLS];
    const uint8_t *bytes = (const uint8_t *)noh_ragdoll_dolls(set);
    for (uint32_t d = 0; d < DOLLS; d++) dolls[d] = &noh_ragdoll_dolls(set)[d];
    for (int i = 0; i < 120; i++) step(&set->shape, &world, dolls, DOLLS, noh_ragdoll_scratch(set), 1.0f);
    hashes[0] = game.hash;
    hashes[1] = 2166136261u;
    for (size_t i = 0; i < DOLLS * sizeof **dolls; i++) hashes[1] = (hashes[1] ^ bytes[i]) * 16777619u;
    free(set);
}
#endif

/* The order of questions does not depend on how many dolls a processor moves at once. */
static void the_order_is_the_same_everywhere(void **state)
{
    (void)state;
#if defined(__x86_64__)
    uint32_t scalar[2], other[2];
    hash_by(noh_ragdoll_step_dolls_scalar, scalar);
    hash_by(noh_ragdoll_step_dolls_sse2, other);
    assert_memory_equal(other, scalar, sizeof other);
    if (__builtin_cpu_supports("avx2")) {
        hash_by(noh_ragdoll_step_dolls_avx2, other);
        assert_memory_equal(other, scalar, sizeof other);
    }
#else
    test_skip("the widths of x86-64 are compared there");
#endif
}

static void half_a_table_is_refused(void **state)
{
    game_physics game;
    const noh_world world = game_world(&game, &corner);
    (void)state;
    game.table.touches = NULL;
    assert_int_equal(noh_world_check(&world, NULL), NOH_ERR_ARG);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(ragdolls_fall_alike),       cmocka_unit_test(bad_answers_do_not_count),
    cmocka_unit_test(room_is_planned),           cmocka_unit_test(rigid_bodies_fall_alike),
    cmocka_unit_test(rays_meet_the_same_ground), cmocka_unit_test(the_order_is_the_same_everywhere),
    cmocka_unit_test(half_a_table_is_refused),
};

TEST_MAIN(tests, NULL, NULL)
