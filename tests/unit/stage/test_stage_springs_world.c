/* Springs that meet a world: sleeves and skirts of puppets stay out of shapes, of a game's physics and of triangles,
 * with the same bits for any number of jobs. */
#include "support/game_physics.h"
#include "support/stage_fixture.h"

#include <math.h>
#include <string.h>

#include "noh/base.h"
#include "noh/body.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/modules/springs_internal.h"

#define ACTORS 4u
#define LEVEL 0.2f /* of floors: 10 cm above where hems end at rest */

typedef struct scene {
    cast cast;
    noh_springs_desc springs;
    noh_actor actors[ACTORS];
} scene;

static void open_scene(scene *s, const noh_world *world, uint32_t jobs, float scale, float east)
{
    cast *c = &s->cast;
    memset(s, 0, sizeof *s);
    cast_map(c, PUPPETS, "demo/puppet.noh");
    assert_true(noh_springs_of_pack(&c->packs[0], 0, &s->springs));
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = ACTORS;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].springs = noh_springs_module(world);
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_appearance posed = { .posed = 1 };
        const noh_place place = { { scale * 1.5f * (float)i + east, 0.0f, 0.0f }, { 0, 0, 0, 0 }, scale };
        assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &s->actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c->stage, s->actors[i], &posed, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c->stage, s->actors[i], 0, i % 2u ? "walk" : "dance", NULL, NULL), NOH_OK);
    }
}

static void close_scene(scene *s)
{
    cast_close_stage(&s->cast);
    noh_file_unmap(&s->cast.files[0]);
}

static void run(const scene *s, uint32_t frames, uint32_t ticks)
{
    for (uint32_t f = 0; f < frames; f++) {
        assert_int_equal(noh_stage_frame(s->cast.stage, ticks, NULL, NULL, NULL, NULL), NOH_OK);
    }
}

static void end_of(const scene *s, uint32_t actor, uint32_t chain, float out[3])
{
    const noh_spring_chain *c = &s->springs.chains[chain];
    float m[12];
    const uint32_t joint = s->springs.rows[c->first_row + c->row_count - 1u].joint;
    assert_int_equal(noh_actor_joint(s->cast.stage, s->actors[actor], joint, m, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) {
        out[i] = m[4 * i + 3];
        for (int a = 0; a < 3; a++) out[i] += m[4 * i + a] * c->end[a];
    }
}

/* ---- shapes ---- */

static const noh_plane level = { { 0.0f, 1.0f, 0.0f }, LEVEL };
static const noh_obb box = { { 0.0f, LEVEL - 0.3f, 0.0f }, { 9.0f, 0.3f, 9.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
static const noh_capsule log_of_wood = { { -9.0f, LEVEL - 0.3f, 0.1f }, { 9.0f, LEVEL - 0.3f, 0.1f }, 0.3f };
static uint16_t heights[4] = { 200, 200, 200, 200 };
static const noh_field field = { heights, 2, 2, { -9.0f, 0.0f, -9.0f }, 18.0f, 0.001f };

static float over_level(const float at[3])
{
    return at[1] - LEVEL;
}

static float from_log(const float at[3])
{
    return hypotf(at[1] - log_of_wood.from[1], at[2] - log_of_wood.from[2]) - log_of_wood.radius;
}

/* How deep ends get into a shape that actors come down into. */
static float depth_in(const noh_world *world, float (*over)(const float at[3]))
{
    float deepest = -1.0f;
    scene s;
    open_scene(&s, world, 1, 1.0f, 0.0f);
    for (uint32_t f = 0; f < 200; f++) {
        for (uint32_t i = 0; i < ACTORS && f <= 30; i++) {
            noh_place place;
            assert_int_equal(noh_actor_place(s.cast.stage, s.actors[i], &place, NULL), NOH_OK);
            place.position[1] = 0.01f * (float)(30u - f);
            assert_int_equal(noh_actor_set_place(s.cast.stage, s.actors[i], &place, NULL), NOH_OK);
        }
        run(&s, 1, CAST_STEP);
        for (uint32_t i = 0; i < ACTORS * s.springs.chain_count; i++) {
            const uint32_t chain = i % s.springs.chain_count;
            float at[3];
            end_of(&s, i / s.springs.chain_count, chain, at);
            deepest = fmaxf(deepest, s.springs.rows[s.springs.chains[chain].first_row].radius - over(at));
        }
    }
    close_scene(&s);
    return deepest;
}

/* Each kind of shape, and triangles. */
static void ends_stay_out_of_every_shape(void **state)
{
    static const float corners[4][3] = { { -9, LEVEL, -9 }, { -9, LEVEL, 9 }, { 9, LEVEL, -9 }, { 9, LEVEL, 9 } };
    static const uint32_t indices[2][3] = { { 0, 1, 2 }, { 2, 1, 3 } };
    const noh_triangles_desc desc = { corners[0], 4, indices[0], 2 };
    noh_world_physics triangles;
    void *memory = malloc(noh_triangles_size(2));
    const noh_world worlds[] = { { .planes = &level, .plane_count = 1 },
                                 { .boxes = &box, .box_count = 1 },
                                 { .field = &field },
                                 { .physics = &triangles },
                                 { .capsules = &log_of_wood, .capsule_count = 1 } };
    (void)state;
    assert_int_equal(noh_triangles_init(memory, noh_triangles_size(2), &desc, &triangles, NULL), NOH_OK);
    for (size_t i = 0; i < TEST_COUNT(worlds); i++) {
        float (*over)(const float at[3]) = worlds[i].capsules ? from_log : over_level;
        const float without = depth_in(NULL, over), with = depth_in(&worlds[i], over);
        print_message("# shape %u: %.1f mm deep without it, %.3f mm with\n", (unsigned)i, 1e3 * (double)without,
                      1e3 * (double)with);
        assert_true(without > 0.05f && with < 5e-4f);
    }
    free(memory);
}

/* ---- bits ---- */

/* A floor through hems, and two walls through sleeves. */
static const noh_plane walls[3] = { { { 0.0f, 1.0f, 0.0f }, LEVEL },
                                    { { 0.96f, 0.28f, 0.0f }, -0.1f },
                                    { { 0.0f, 0.0f, -1.0f }, -0.5f } };
static const noh_world corner = { .planes = walls, .plane_count = 3 };

/* Planes of a world and of a game's physics, which answers with all of them at any distance; one job and three; steps
 * of any length; and a state that is put back, or taken over by another stage. */
static void every_way_gives_the_same_bits(void **state)
{
    static const uint32_t ticks[5] = { CAST_STEP, 333, 2000, CAST_STEP, 8000 };
    static uint64_t hashes[100];
    static float ends[100][3];
    (void)state;
    for (uint32_t way = 0; way < 4; way++) {
        game_physics game;
        const noh_world asking = game_world(&game, &corner);
        scene s, fork;
        size_t bytes;
        game.table.threads = way == 2u;
        open_scene(&s, way ? &asking : &corner, way == 2u ? 3 : 1, 1.0f, 0.0f);
        open_scene(&fork, way ? &asking : &corner, way == 2u ? 3 : 1, 1.0f, 0.0f);
        for (uint32_t f = 0; f < 100; f++) {
            if (f == 50 && way == 3u) {
                assert_int_equal(noh_stage_set_state(fork.cast.stage, noh_stage_state(s.cast.stage, &bytes),
                                                     (size_t)s.cast.plan.state_bytes, NULL),
                                 NOH_OK);
            }
            run(f >= 50 && way == 3u ? &fork : &s, 1, ticks[f % 5u]);
            const scene *on = f >= 50 && way == 3u ? &fork : &s;
            const uint64_t hash = noh_stage_hash(on->cast.stage);
            float end[3];
            end_of(on, f % 2u, f / 2u % s.springs.chain_count, end);
            if (!way) hashes[f] = hash, memcpy(ends[f], end, sizeof end);
            if (hash != hashes[f] || memcmp(end, ends[f], sizeof end) != 0)
                fail_msg("way %u differs in frame %u", (unsigned)way, (unsigned)f);
        }
        if (way == 1u) assert_int_equal(game.batches * s.springs.chain_count, game.touches); /* an actor at a time */
        assert_true(way == 0 || way == 2u || game.batches > 100u);
        close_scene(&s);
        close_scene(&fork);
    }
}

/* An actor of twice the size over a floor of twice the height, far away, moves as the small one does. */
static void scale_and_distance_change_nothing(void **state)
{
    const noh_plane twice = { { 0.0f, 1.0f, 0.0f }, 2.0f * LEVEL };
    const noh_world low = { .planes = &level, .plane_count = 1 }, high = { .planes = &twice, .plane_count = 1 };
    float worst = 0.0f;
    scene small, large;
    (void)state;
    open_scene(&small, &low, 1, 1.0f, 0.0f);
    open_scene(&large, &high, 1, 2.0f, 8192.0f);
    for (uint32_t f = 0; f < 100; f++) {
        run(&small, 1, CAST_STEP);
        run(&large, 1, CAST_STEP);
        for (uint32_t i = 0; i < small.springs.chain_count; i++) {
            float a[3], b[3];
            end_of(&small, 0, i, a);
            end_of(&large, 0, i, b);
            worst = fmaxf(worst, fabsf(0.5f * b[1] - a[1]));
        }
    }
    print_message("# off by %.3f mm\n", 1e3 * (double)worst);
    assert_true(worst < 1e-3f);
    close_scene(&small);
    close_scene(&large);
}

/* ---- plans ---- */

/* A world costs room for questions, in each job, and nothing else; one whose physics answers one thread is refused by
 * several jobs, and one that is set later is not asked. */
static void plans_know_the_world(void **state)
{
    const noh_plane bent = { { 0.0f, 2.0f, 0.0f }, 0.0f };
    const noh_world bad = { .planes = &bent, .plane_count = 1 };
    game_physics game;
    const noh_world asking = game_world(&game, &corner);
    noh_world later = corner;
    noh_stage_plan plan;
    noh_stage *stage = NULL;
    noh_error said;
    scene s, plain;
    (void)state;
    for (uint32_t jobs = 1; jobs <= 3; jobs += 2) {
        open_scene(&plain, NULL, jobs, 1.0f, 0.0f);
        open_scene(&s, &corner, jobs, 1.0f, 0.0f);
        assert_int_equal(s.cast.plan.cpu_bytes - plain.cast.plan.cpu_bytes, jobs * 1664u);
        assert_true(s.cast.plan.state_bytes == plain.cast.plan.state_bytes && s.cast.plan.hash == plain.cast.plan.hash);
        close_scene(&plain);
        if (jobs == 1) close_scene(&s);
    }
    s.cast.kinds[0].springs = noh_springs_module(&asking);
    assert_int_equal(noh_stage_plan_make(&s.cast.desc, NULL, &plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "one thread"));
    assert_int_equal(
        noh_stage_init(s.cast.memory, (size_t)s.cast.plan.cpu_bytes, NULL, &s.cast.desc, &s.cast.plan, &stage, &said),
        NOH_ERR_ARG);
    assert_true(strstr(said.what, "one thread") && !stage);
    s.cast.kinds[0].springs = noh_springs_module(&bad);
    assert_int_equal(noh_stage_plan_make(&s.cast.desc, NULL, &plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "noh_world_check"));
    close_scene(&s);
    open_scene(&s, &later, 3, 1.0f, 0.0f);
    later.physics = &game.table;
    run(&s, 20, CAST_STEP);
    assert_int_equal(game.batches, 0);
    close_scene(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(ends_stay_out_of_every_shape),
    cmocka_unit_test(every_way_gives_the_same_bits),
    cmocka_unit_test(scale_and_distance_change_nothing),
    cmocka_unit_test(plans_know_the_world),
};

TEST_MAIN(tests, NULL, NULL)
