/* A world that is a game's physics, and one of triangles, under whole actors: stand, step, fall, lie, get up. */
#include "support/game_physics.h"
#include "support/stage_fixture.h"

#include <math.h>
#include <string.h>

#include "life/physics/ragdoll_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/modules/stage_ragdoll_internal.h"

#define ACTORS 4u
#define SIDE 32u
#define CELL 0.5f

typedef struct scene {
    cast cast;
    noh_kind_feet feet;
    noh_modifier modifier;
    noh_kind_ragdoll ragdoll;
    noh_actor actors[ACTORS];
} scene;

static void open_scene(scene *s, const noh_world *world, uint32_t jobs)
{
    noh_ragdoll_source source;
    cast *c = &s->cast;
    memset(s, 0, sizeof *s);
    memset(&source, 0, sizeof source);
    cast_map(c, PUPPETS, "demo/puppet_falls.noh");
    source.pack = &c->packs[0];
    source.metres = 1.0f;
    assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    assert_int_equal(noh_feet_rig_make(&source, &s->feet.rig, NULL), NOH_OK);
    s->feet.ground.world = world;
    s->modifier = noh_feet_modifier(&s->feet);
    s->ragdoll.count = ACTORS;
    s->ragdoll.world = world;
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = ACTORS;
    c->kinds[0].ragdoll = noh_ragdoll_module(&s->ragdoll);
    c->kinds[0].modifiers = &s->modifier;
    c->kinds[0].modifier_count = 1;
    c->kinds[0].inertia = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
}

static void close_scene(scene *s)
{
    cast_close_stage(&s->cast);
    noh_file_unmap(&s->cast.files[0]);
}

static float ground_at(const scene *s, float x, float z)
{
    const float from[3] = { x, 5.0f, z };
    float normal[3];
    const float far = noh_ground_below(&s->feet.ground, from, 9.0f, normal);
    assert_true(far > 0.0f);
    return 5.0f - far;
}

static void enter_all(scene *s)
{
    const noh_appearance posed = { .posed = 1 };
    for (uint32_t i = 0; i < ACTORS; i++) {
        const float x = 2.0f * (float)i - 3.0f;
        const noh_place place = { { x, ground_at(s, x, 0.1f), 0.1f }, { 0, 0, 0, 0 }, 0.0f };
        assert_int_equal(noh_stage_spawn(s->cast.stage, 0, &place, &s->actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_play(s->cast.stage, s->actors[i], 0, "idle", NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(s->cast.stage, s->actors[i], &posed, NULL), NOH_OK);
    }
}

static void run(const scene *s, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++) {
        assert_int_equal(noh_stage_frame(s->cast.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    }
}

static void push_all(const scene *s, float least)
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        const float point[3] = { 2.0f * (float)i - 3.0f, 1.2f, 0.0f };
        const float impulse[3] = { 5.0f, 0.0f, least + 45.0f * (float)i };
        assert_int_equal(noh_actor_hit(s->cast.stage, s->actors[i], point, impulse, NULL), NOH_OK);
    }
}

static void joint_at(const scene *s, uint32_t actor, const char *name, float out[3])
{
    float matrix[12];
    const uint32_t joint = noh_stage_find(s->cast.stage, 0, NOH_NAME_JOINT, name);
    assert_int_equal(noh_actor_joint(s->cast.stage, s->actors[actor], joint, matrix, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) out[i] = matrix[4 * i + 3];
}

static void all_lie(const scene *s)
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        assert_int_equal(noh_actor_fall(s->cast.stage, s->actors[i], NULL), NOH_OK);
    }
    run(s, 540);
    for (uint32_t i = 0; i < ACTORS; i++) {
        assert_int_equal(noh_actor_body(s->cast.stage, s->actors[i]), NOH_BODY_LIES);
    }
}

static void all_get_up(const scene *s)
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        noh_place place;
        assert_int_equal(noh_actor_get_up(s->cast.stage, s->actors[i], NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_place(s->cast.stage, s->actors[i], &place, NULL), NOH_OK);
        assert_true(fabsf(place.position[1] - ground_at(s, place.position[0], place.position[2])) < 0.12f);
    }
    run(s, 240);
    for (uint32_t i = 0; i < ACTORS; i++) {
        assert_int_equal(noh_actor_body(s->cast.stage, s->actors[i]), NOH_BODY_STANDS);
    }
}

/* ---- a game's physics ---- */

/* One that sways, two that step, one that falls; then all fall, lie, and get up: the state has the same bits. */
static void the_games_floor_is_a_floor(void **state)
{
    const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    const noh_world own = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };
    game_physics game;
    const noh_world asking = game_world(&game, &own);
    scene s[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        open_scene(&s[i], i ? &asking : &own, 1);
        enter_all(&s[i]);
        run(&s[i], 5);
        push_all(&s[i], 12.0f);
    }
    assert_true(s[1].cast.plan.cpu_bytes - s[0].cast.plan.cpu_bytes == 20480u);
    for (int f = 0; f < 200; f++) {
        for (int i = 0; i < 2; i++) run(&s[i], 1);
        if (noh_stage_hash(s[0].cast.stage) != noh_stage_hash(s[1].cast.stage)) fail_msg("frame %d", f);
    }
    assert_true(game.rays > 1000 && game.touches > 1000);
    for (int i = 0; i < 2; i++) {
        all_lie(&s[i]);
        all_get_up(&s[i]);
    }
    assert_true(noh_stage_hash(s[0].cast.stage) == noh_stage_hash(s[1].cast.stage));
    for (int i = 0; i < 2; i++) close_scene(&s[i]);
}

static void expect_refused(scene *s)
{
    noh_stage_plan plan;
    noh_stage *stage = NULL;
    noh_error said;
    assert_int_equal(noh_stage_plan_make(&s->cast.desc, NULL, &plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "one thread"));
    assert_int_equal(noh_stage_init(s->cast.memory, (size_t)s->cast.plan.cpu_bytes, NULL, &s->cast.desc, &s->cast.plan,
                                    &stage, &said),
                     NOH_ERR_ARG);
    assert_true(strstr(said.what, "one thread") && !stage);
    s->cast.desc.job_count = 1;
    assert_int_equal(noh_stage_plan_make(&s->cast.desc, NULL, &plan, NULL), NOH_OK);
}

/* Jobs of a frame ask it at once where it allows that. Where it does not, several jobs are refused; a world that is set
 * after init is never asked, and feet are as in the clip. */
static void one_thread_is_enough(void **state)
{
    const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    const noh_obb box = { { 0.0f, 0.05f, 0.0f }, { 9.0f, 0.05f, 0.25f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_world own = { .planes = &floor_plane, .boxes = &box, .plane_count = 1, .box_count = 1 };
    uint64_t hashes[3];
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        game_physics game;
        const noh_world asking = game_world(&game, &own);
        scene s;
        game.table.threads = i == 1u;
        open_scene(&s, i == 1u ? &asking : &own, i ? 3 : 1);
        enter_all(&s);
        if (i == 2u) s.feet.ground.world = &asking;
        const uint32_t asked = game.rays;
        run(&s, 40);
        hashes[i] = noh_stage_hash(s.cast.stage);
        if (i == 2u) {
            assert_int_equal(game.rays, asked);
            expect_refused(&s);
        }
        close_scene(&s);
    }
    assert_true(hashes[1] == hashes[0] && hashes[2] != hashes[0]);
}

/* ---- triangles ---- */

static float positions[(SIDE + 1u) * (SIDE + 1u)][3];
static uint32_t indices[2u * SIDE * SIDE][3];

static void *lay_triangles(noh_world_physics *physics)
{
    const noh_triangles_desc desc = { positions[0], (SIDE + 1u) * (SIDE + 1u), indices[0], 2u * SIDE * SIDE };
    const size_t bytes = noh_triangles_size(desc.triangle_count);
    void *memory = malloc(bytes);
    uint32_t seed = 3;
    for (uint32_t i = 0; i < desc.position_count; i++) {
        seed = seed * 1664525u + 1013904223u;
        positions[i][0] = CELL * ((float)(i % (SIDE + 1u)) - 0.5f * (float)SIDE);
        positions[i][1] = 0.12f * (float)(seed >> 8) / 16777216.0f;
        positions[i][2] = CELL * ((float)(i / (SIDE + 1u)) - 0.5f * (float)SIDE);
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint32_t a = i / SIDE * (SIDE + 1u) + i % SIDE, b = a + SIDE + 1u;
        const uint32_t both[2][3] = { { a, b, a + 1u }, { a + 1u, b, b + 1u } };
        memcpy(indices[2u * i], both, sizeof both);
    }
    assert_int_equal(noh_triangles_init(memory, bytes, &desc, physics, NULL), NOH_OK);
    return memory;
}

static void expect_feet_on_ground(const scene *s)
{
    static const char *const feet[2] = { "foot.L", "foot.R" };
    for (uint32_t i = 0; i < 2u * ACTORS; i++) {
        float at[3];
        joint_at(s, i / 2u, feet[i % 2u], at);
        const float over = at[1] - ground_at(s, at[0], at[2]);
        if (!(over > 0.03f && over < 0.13f)) fail_msg("foot %u is %.0f mm over the ground", i, 1e3 * (double)over);
    }
}

static void expect_bodies_on_ground(const scene *s, float *deepest)
{
    noh_stage_kind *k = &s->cast.stage->kinds[0];
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_stage_body *b = noh_stage_body_of(k, i);
        noh_ragdoll_measures m;
        noh_ragdoll_measure(shared->dolls, b->doll - 1u, shared->world, &m);
        *deepest = fmaxf(*deepest, m.penetration);
        for (uint32_t n = 0; n < shared->rig.body_count; n++) {
            const float *at = b->bodies[0][n].position;
            const float over = b->origin[1] + at[1] - ground_at(s, b->origin[0] + at[0], b->origin[2] + at[2]);
            assert_true(over > 0.5f * shared->rig.bodies[n].radius && over < 0.6f);
        }
    }
}

/* Puppets stand on rough triangles, step or fall, lie on them and get up; a state that is put back goes on alike, with
 * any number of jobs. */
static void puppets_live_on_triangles(void **state)
{
    noh_world_physics physics;
    void *memory = lay_triangles(&physics);
    const noh_world world = { .friction = 0.7f, .physics = &physics };
    float deepest = 0.0f;
    uint64_t first = 0;
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        size_t bytes;
        scene s;
        open_scene(&s, &world, i ? 3 : 1);
        enter_all(&s);
        run(&s, 40);
        expect_feet_on_ground(&s);
        push_all(&s, 20.0f);
        run(&s, 25);
        void *saved = test_aligned(noh_stage_state(s.cast.stage, &bytes), (size_t)s.cast.plan.state_bytes);
        run(&s, 60);
        const uint64_t hash = noh_stage_hash(s.cast.stage);
        assert_int_equal(noh_stage_set_state(s.cast.stage, saved, bytes, NULL), NOH_OK);
        run(&s, 60);
        assert_true(noh_stage_hash(s.cast.stage) == hash);
        if (!i) first = hash;
        assert_true(hash == first);
        free(saved);
        if (!i) {
            all_lie(&s);
            expect_bodies_on_ground(&s, &deepest);
            all_get_up(&s);
            expect_feet_on_ground(&s);
        }
        close_scene(&s);
    }
    print_message("the deepest body is %.1f mm inside\n", 1e3 * (double)deepest);
    assert_true(deepest < 0.01f);
    free(memory);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_games_floor_is_a_floor),
    cmocka_unit_test(one_thread_is_enough),
    cmocka_unit_test(puppets_live_on_triangles),
};

TEST_MAIN(tests, NULL, NULL)
