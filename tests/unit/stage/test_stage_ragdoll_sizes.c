/* Ragdolls of actors of any scale: they move as a ragdoll that was built at that size does, in the same world and under
 * the same gravity. */
#include "support/game_physics.h"
#include "support/stage_fixture.h"

#include <math.h>
#include <string.h>

#include "life/physics/ragdoll_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/modules/stage_ragdoll_internal.h"

#define SIZES 3u

static const float sizes[SIZES] = { 0.5f, 1.0f, 2.5f };
static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };

static float distance(const float a[3], const float b[3])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* ---- sets ---- */

static noh_ragdoll_rig rig_of(const noh_pack *pack, float metres)
{
    noh_ragdoll_source source = { .pack = pack, .metres = metres };
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_rig rig;
    uint32_t count;
    assert_int_equal(noh_pack_skeleton_at(pack, 0, &source.joints, NULL, NULL), NOH_OK);
    assert_int_equal(noh_ragdoll_find_rows(&source, rows, &count, NULL), NOH_OK);
    assert_int_equal(noh_ragdoll_rig_make(&source, rows, count, &rig, NULL), NOH_OK);
    return rig;
}

/* Two dolls that fly against obstacles: of a rig of full size, or of another one and that size. */
static noh_ragdolls *made(const noh_ragdoll_rig *rig, const noh_ragdoll_rig *full, float size, float high)
{
    const noh_ragdolls_desc desc = { rig, 2, 10, 1 };
    const float x = 4.5f - 2.0f * full->bodies[0].position[1];
    const float origin[3] = { x, high, -2.0f }, hit[3] = { x, high + 2.5f, -2.0f };
    float impulse[3] = { 30.0f, 0.0f, 20.0f };
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdolls *set;
    void *memory = malloc(noh_ragdolls_size(&desc));
    assert_int_equal(noh_ragdolls_init(memory, noh_ragdolls_size(&desc), &desc, &set, NULL), NOH_OK);
    memset(motions, 0, sizeof motions);
    for (uint32_t d = 0; d < 2; d++) {
        for (uint32_t i = 0; i < full->body_count; i++) {
            memcpy(poses[i].position, full->bodies[i].position, sizeof poses[i].position);
            memcpy(poses[i].rotation, full->bodies[i].rotation, sizeof poses[i].rotation);
            poses[i].position[1] += 1.0f + 0.25f * (float)d;
            motions[i].velocity[0] = 2.0f;
            motions[i].velocity[1] = 0.5f * (float)d;
        }
        assert_int_equal(noh_ragdoll_place_about(set, d, origin, size, poses, motions, NULL), NOH_OK);
    }
    const float mass = full->bodies[0].mass / 10.0f;
    for (int k = 0; k < 3; k++) impulse[k] *= mass;
    noh_ragdoll_push(set, 1, hit, impulse);
    return set;
}

/* From a height that floats hold, as precise as near 0. */
static void bodies_above(const noh_ragdolls *set, uint32_t doll, float high, noh_ragdoll_pose *bodies)
{
    float origin[3];
    noh_ragdoll_bodies_local(set, doll, origin, bodies);
    origin[1] -= high;
    for (uint32_t i = 0; i < set->shape.body_count; i++) {
        for (int k = 0; k < 3; k++) bodies[i].position[k] += origin[k];
    }
}

/* A doll of a size against one whose rig was made for a skeleton of that size: the same bodies in metres, through first
 * contacts with shapes of all kinds and with a game's floor, near and far away. Powers of two round alike. */
static void a_size_is_a_rig_of_that_size(void **state)
{
    static uint16_t heights[9] = { 0, 2, 1, 3, 0, 1, 2, 4, 0 };
    static const float tested[3] = { 0.5f, 2.0f, 1.7f };
    const noh_field field = { heights, 3, 3, { -20.0f, 0.0f, -20.0f }, 20.0f, 0.1f };
    const noh_obb box = { { 5.5f, 0.3f, -2.0f }, { 0.8f, 0.3f, 3.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_capsule pole = { { 5.0f, 0.0f, -4.0f }, { 5.0f, 6.0f, -1.0f }, 0.2f };
    const noh_world shapes = { .boxes = &box,
                               .capsules = &pole,
                               .box_count = 1,
                               .capsule_count = 1,
                               .field = &field,
                               .friction = 0.5f,
                               .restitution = 0.3f };
    game_physics game, far;
    const noh_plane high_plane = { { 0.0f, 1.0f, 0.0f }, 262144.0f };
    const noh_world high = { .planes = &high_plane, .plane_count = 1, .friction = 0.6f };
    const noh_world asking = game_world(&game, &ground), far_away = game_world(&far, &high);
    const noh_world *worlds[3] = { &shapes, &asking, &far_away };
    cast c;
    (void)state;
    memset(&c, 0, sizeof c);
    cast_map(&c, PUPPETS, "demo/puppet_falls.noh");
    const noh_ragdoll_rig one = rig_of(&c.packs[0], 1.0f);
    for (uint32_t n = 0; n < 9; n++) {
        const float size = tested[n % 3u];
        const noh_ragdoll_rig full = rig_of(&c.packs[0], size);
        const float up = n < 6 ? 0.0f : high_plane.distance;
        noh_ragdolls *sized = made(&one, &full, size, up), *built = made(&full, &full, 1.0f, up);
        float worst = 0.0f, moved = 0.0f;
        for (uint32_t f = 0; f < 35; f++) {
            noh_ragdoll_pose a[NOH_RAGDOLL_BODIES_MAX], b[NOH_RAGDOLL_BODIES_MAX];
            noh_ragdolls_step(sized, worlds[n / 3u], NOH_RAGDOLL_STEP_TICKS);
            noh_ragdolls_step(built, worlds[n / 3u], NOH_RAGDOLL_STEP_TICKS);
            for (uint32_t d = 0; d < 2; d++) {
                float centres[2][3] = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f } };
                bodies_above(sized, d, up, a);
                bodies_above(built, d, up, b);
                for (uint32_t i = 0; i < one.body_count; i++) {
                    for (int k = 0; k < 3; k++) {
                        centres[0][k] += a[i].position[k] / (float)one.body_count;
                        centres[1][k] += b[i].position[k] / (float)one.body_count;
                    }
                    moved = fmaxf(moved, distance(a[i].position, full.bodies[i].position));
                }
                worst = fmaxf(worst, distance(centres[0], centres[1]));
            }
        }
        print_message("# size %.1f, world %u: centres off by %.3f mm after ways of %.1f m\n", (double)size, n / 3u,
                      1e3 * (double)worst, (double)moved);
        assert_true(moved > 1.0f && worst < 0.004f * size);
        free(sized);
        free(built);
    }
    noh_file_unmap(&c.files[0]);
}

/* The smallest dolls take any finite push, up to their greatest speed. */
static void a_hard_push_moves_the_smallest(void **state)
{
    static const float origin[3] = { 0.0f, 0.0f, 0.0f };
    cast c;
    (void)state;
    memset(&c, 0, sizeof c);
    cast_map(&c, PUPPETS, "demo/puppet_falls.noh");
    const noh_ragdoll_rig one = rig_of(&c.packs[0], 1.0f), full = rig_of(&c.packs[0], 0.01f);
    const noh_ragdolls_desc desc = { &one, 1, 10, 0 };
    const size_t bytes = noh_ragdolls_size(&desc);
    noh_ragdolls *set = NULL;
    void *memory = malloc(bytes);
    assert_int_equal(noh_ragdolls_init(memory, bytes, &desc, &set, NULL), NOH_OK);
    for (uint32_t n = 0; n < 3; n++) {
        static const float impulses[3] = { 0.01f, 2e4f, 1e12f };
        const float impulse[3] = { 0.0f, 0.0f, impulses[n] };
        noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
        for (uint32_t i = 0; i < one.body_count; i++) {
            memcpy(poses[i].position, full.bodies[i].position, sizeof poses[i].position);
            memcpy(poses[i].rotation, full.bodies[i].rotation, sizeof poses[i].rotation);
        }
        assert_int_equal(noh_ragdoll_place_about(set, 0, origin, 0.01f, poses, NULL, NULL), NOH_OK);
        noh_ragdoll_push(set, 0, full.bodies[0].position, impulse);
        noh_ragdolls_step(set, NULL, NOH_RAGDOLL_STEP_TICKS);
        noh_ragdoll_bodies(set, 0, poses);
        const float way = poses[0].position[2] - full.bodies[0].position[2];
        print_message("# %.2g Ns: %.2g m\n", (double)impulse[2], (double)way);
        assert_true(way > 0.001f && way < 0.01f);
    }
    free(memory);
    noh_file_unmap(&c.files[0]);
}

/* ---- actors ---- */

typedef struct scene {
    cast cast;
    noh_kind_ragdoll ragdoll;
    noh_actor actors[SIZES];
} scene;

static void open_scene_with(scene *s, const noh_kind_ragdoll *ragdoll, uint32_t jobs)
{
    cast *c = &s->cast;
    memset(s, 0, sizeof *s);
    cast_map(c, PUPPETS, "demo/puppet_falls.noh");
    s->ragdoll = *ragdoll;
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = SIZES;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].ragdoll = noh_ragdoll_module(&s->ragdoll);
    c->kinds[0].inertia = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
    for (uint32_t i = 0; i < SIZES; i++) {
        const noh_appearance posed = { .posed = 1 };
        const noh_place place = { { 4.0f * (float)i, 0.0f, 0.0f }, { 0, 0, 0, 0 }, sizes[i] };
        assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &s->actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c->stage, s->actors[i], 0, "idle", NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c->stage, s->actors[i], &posed, NULL), NOH_OK);
    }
}

static void open_scene(scene *s, const noh_world *world, uint32_t jobs)
{
    open_scene_with(s, &(noh_kind_ragdoll){ .count = SIZES, .world = world }, jobs);
}

static float scale_of(const scene *s, uint32_t actor)
{
    noh_place place;
    assert_int_equal(noh_actor_place(s->cast.stage, s->actors[actor], &place, NULL), NOH_OK);
    return place.scale;
}

static void rescale(const scene *s, uint32_t actor, float scale)
{
    noh_place place;
    assert_int_equal(noh_actor_place(s->cast.stage, s->actors[actor], &place, NULL), NOH_OK);
    place.scale = scale;
    assert_int_equal(noh_actor_set_place(s->cast.stage, s->actors[actor], &place, NULL), NOH_OK);
}

static void close_scene(scene *s)
{
    cast_close_stage(&s->cast);
    noh_file_unmap(&s->cast.files[0]);
}

static void run(const scene *s, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++) {
        assert_int_equal(noh_stage_frame(s->cast.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    }
}

static void joint_at(const scene *s, uint32_t actor, const char *name, float out[3])
{
    float matrix[12];
    const uint32_t joint = noh_stage_find(s->cast.stage, 0, NOH_NAME_JOINT, name);
    assert_int_equal(noh_actor_joint(s->cast.stage, s->actors[actor], joint, matrix, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) out[i] = matrix[4 * i + 3];
}

/* The impulse that gives an actor of its size a speed. */
static void push(const scene *s, uint32_t actor, float speed)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(&s->cast.stage->kinds[0]);
    const float size = scale_of(s, actor), impulse[3] = { 0.0f, 0.0f, speed * shared->mass * size * size * size };
    float point[3];
    joint_at(s, actor, "hips", point);
    assert_int_equal(noh_actor_hit(s->cast.stage, s->actors[actor], point, impulse, NULL), NOH_OK);
}

/* They fall from where they stand, no joint leaps, the first tenths as far as gravity has it; they lie on the ground,
 * and get up where they lie. */
static void every_size_falls_lies_and_gets_up(void **state)
{
    static const char *const names[] = { "head", "hand.L", "hand.R", "foot.L", "foot.R", "hips" };
    float before[SIZES][TEST_COUNT(names)][3], now[3], begun[SIZES];
    scene s;
    (void)state;
    open_scene(&s, &ground, 1);
    run(&s, 10);
    for (uint32_t i = 0; i < SIZES; i++) {
        for (size_t n = 0; n < TEST_COUNT(names); n++) joint_at(&s, i, names[n], before[i][n]);
        assert_int_equal(noh_actor_fall(s.cast.stage, s.actors[i], NULL), NOH_OK);
    }
    for (uint32_t f = 0; f < 600; f++) {
        run(&s, 1);
        for (uint32_t i = 0; i < SIZES * TEST_COUNT(names); i++) {
            float *was = before[i / TEST_COUNT(names)][i % TEST_COUNT(names)];
            joint_at(&s, i / (uint32_t)TEST_COUNT(names), names[i % TEST_COUNT(names)], now);
            if (!(distance(was, now) < 0.2f * sizes[i / TEST_COUNT(names)]) || !(now[1] > -0.03f))
                fail_msg("frame %u: %s of size %.1f", f, names[i % TEST_COUNT(names)],
                         (double)sizes[i / TEST_COUNT(names)]);
            memcpy(was, now, sizeof now);
        }
    }
    for (uint32_t i = 0; i < SIZES; i++) {
        noh_place place;
        assert_int_equal(noh_actor_body(s.cast.stage, s.actors[i]), NOH_BODY_LIES);
        for (size_t n = 0; n < TEST_COUNT(names); n++) assert_true(before[i][n][1] < 0.45f * sizes[i]);
        assert_int_equal(noh_actor_get_up(s.cast.stage, s.actors[i], NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_place(s.cast.stage, s.actors[i], &place, NULL), NOH_OK);
        assert_true(place.scale == sizes[i] && fabsf(place.position[1]) < 0.001f);
        assert_true(hypotf(place.position[0] - before[i][5][0], place.position[2] - before[i][5][2]) < sizes[i]);
    }
    run(&s, 300);
    joint_at(&s, 1, "head", now);
    for (uint32_t i = 0; i < SIZES; i++) {
        joint_at(&s, i, "head", before[i][0]);
        begun[i] = before[i][0][1] / sizes[i];
        assert_int_equal(noh_actor_body(s.cast.stage, s.actors[i]), NOH_BODY_STANDS);
        assert_true(fabsf(begun[i] - now[1]) < 0.05f);
    }
    close_scene(&s);
}

/* Without a world all fall alike from rest, by half of g t squared, up to the greatest speed of their size. */
static void gravity_is_the_same_for_all(void **state)
{
    static const float all[2 * SIZES] = { 0.5f, 1.0f, 2.5f, 0.02f, 10.0f, 100.0f };
    (void)state;
    for (uint32_t round = 0; round < 2; round++) {
        float from[SIZES][3], to[3];
        scene s;
        open_scene(&s, NULL, 1);
        for (uint32_t i = 0; i < SIZES; i++) rescale(&s, i, all[SIZES * round + i]);
        for (uint32_t i = 0; i < SIZES; i++) assert_int_equal(noh_actor_fall(s.cast.stage, s.actors[i], NULL), NOH_OK);
        run(&s, 1);
        for (uint32_t i = 0; i < SIZES; i++) joint_at(&s, i, "hips", from[i]);
        for (uint32_t f = 2; f <= 80; f++) {
            const float expected = NOH_GRAVITY * (float)(f * f - 1u) / 7200.0f;
            run(&s, 1);
            for (uint32_t i = 0; i < SIZES; i++) {
                const float size = all[SIZES * round + i];
                joint_at(&s, i, "hips", to);
                if (NOH_GRAVITY * (float)f / 60.0f > 35.0f * size) continue;
                if (!(fabsf(from[i][1] - to[1] - expected) < 0.04f * expected + 0.001f))
                    fail_msg("frame %u, size %.2f: %.3f m", f, (double)size, (double)(from[i][1] - to[1]));
            }
        }
        close_scene(&s);
    }
}

/* A push that figures of a size take on their feet is, for another size, one that is faster by the square root. */
static void staggers_follow_the_size(void **state)
{
    float hips[SIZES][3], way[SIZES];
    scene s;
    (void)state;
    open_scene(&s, &ground, 1);
    run(&s, 10);
    for (uint32_t i = 0; i < SIZES; i++) {
        joint_at(&s, i, "hips", hips[i]);
        push(&s, i, 0.8f * sqrtf(sizes[i]));
        assert_int_equal(noh_actor_body(s.cast.stage, s.actors[i]), NOH_BODY_STAGGERS);
    }
    run(&s, 240);
    for (uint32_t i = 0; i < SIZES; i++) {
        float now[3];
        joint_at(&s, i, "hips", now);
        way[i] = (now[2] - hips[i][2]) / sizes[i];
        print_message("# size %.1f steps %.3f m for each m\n", (double)sizes[i], (double)way[i]);
        assert_int_equal(noh_actor_body(s.cast.stage, s.actors[i]), NOH_BODY_STANDS);
    }
    assert_true(way[1] > 0.1f && fabsf(way[0] - way[1]) < 0.03f && fabsf(way[2] - way[1]) < 0.03f);
    for (uint32_t i = 0; i < SIZES; i++) {
        push(&s, i, 3.0f * sqrtf(sizes[i]));
        assert_int_equal(noh_actor_body(s.cast.stage, s.actors[i]), NOH_BODY_FALLS);
    }
    close_scene(&s);
}

/* How long actors brace in a fall follows the square root of their size. */
static void braces_last_by_the_size(void **state)
{
    float lasts[SIZES] = { 0.0f, 0.0f, 0.0f };
    scene s;
    (void)state;
    open_scene(&s, &ground, 1);
    run(&s, 10);
    for (uint32_t i = 0; i < SIZES; i++) push(&s, i, 3.0f * sqrtf(sizes[i]));
    for (uint32_t f = 0; f < 180; f++) {
        run(&s, 1);
        for (uint32_t i = 0; i < SIZES; i++) {
            if (noh_stage_body_of(&s.cast.stage->kinds[0], i)->moves == NOH_MOVES_BRACING)
                lasts[i] = (float)(f + 1u) / sqrtf(sizes[i]);
        }
    }
    print_message("# frames for size 1: %.1f %.1f %.1f\n", (double)lasts[0], (double)lasts[1], (double)lasts[2]);
    for (uint32_t i = 0; i < SIZES; i++) assert_true(lasts[i] > 20.0f && fabsf(lasts[i] / lasts[1] - 1.0f) < 0.15f);
    close_scene(&s);
}

/* A fall that does not end is given up after a time that grows with the size of the actor. */
static void larger_actors_are_down_for_longer(void **state)
{
    noh_fall falls[SIZES];
    uint32_t frames[SIZES] = { 0, 0, 0 };
    scene s;
    (void)state;
    memset(falls, 0, sizeof falls);
    open_scene(&s, NULL, 1);
    for (uint32_t i = 0; i < SIZES; i++) assert_int_equal(noh_actor_fall(s.cast.stage, s.actors[i], NULL), NOH_OK);
    for (uint32_t f = 0; f < 400; f++) {
        for (uint32_t i = 0; i < SIZES; i++) {
            assert_int_equal(noh_fall_step(&falls[i], s.cast.stage, s.actors[i], 0, CAST_STEP, NULL), NOH_OK);
            frames[i] += noh_actor_body(s.cast.stage, s.actors[i]) == NOH_BODY_FALLS;
        }
        run(&s, 1);
    }
    print_message("# down for %u %u %u frames\n", frames[0], frames[1], frames[2]);
    assert_true(frames[0] == frames[1] && fabsf((float)frames[2] / (float)frames[1] - sqrtf(2.5f)) < 0.02f);
    close_scene(&s);
}

/* A push that hardly moves an actor leaves its feet where they stand. */
static void a_small_push_moves_no_foot(void **state)
{
    static const float tested[SIZES] = { 0.2f, 1.0f, 5.0f };
    static const char *const feet[2] = { "foot.L", "foot.R" };
    float before[SIZES][2][3], now[3];
    scene s;
    (void)state;
    open_scene(&s, &ground, 1);
    for (uint32_t i = 0; i < SIZES; i++) rescale(&s, i, tested[i]);
    run(&s, 10);
    for (uint32_t i = 0; i < SIZES; i++) {
        for (uint32_t n = 0; n < 2; n++) joint_at(&s, i, feet[n], before[i][n]);
        push(&s, i, 0.01f * sqrtf(tested[i]));
        assert_int_equal(noh_actor_body(s.cast.stage, s.actors[i]), NOH_BODY_STAGGERS);
    }
    run(&s, 2);
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(&s.cast.stage->kinds[0]);
    for (uint32_t i = 0; i < SIZES; i++) {
        for (uint32_t n = 0; n < 2; n++) {
            const float leg = shared->legs.length * shared->metres * tested[i];
            joint_at(&s, i, feet[n], now);
            print_message("# size %.1f: %s moves by %.4f of a leg\n", (double)tested[i], feet[n],
                          (double)(distance(before[i][n], now) / leg));
            assert_true(distance(before[i][n], now) < 0.01f * leg);
        }
    }
    close_scene(&s);
}

static void is_put_back(const scene *s)
{
    size_t bytes;
    void *saved = test_aligned(noh_stage_state(s->cast.stage, &bytes), (size_t)s->cast.plan.state_bytes);
    assert_int_equal(noh_stage_set_state(s->cast.stage, saved, bytes, NULL), NOH_OK);
    free(saved);
}

/* An actor that lies dead and is scaled has joints that fit when it is pushed. */
static void a_dead_actor_may_be_scaled(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, &ground, 1);
    run(&s, 10);
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(&s.cast.stage->kinds[0]);
    const noh_stage_body *body = noh_stage_body_of(&s.cast.stage->kinds[0], 1);
    assert_int_equal(noh_actor_kill(s.cast.stage, s.actors[1], NULL), NOH_OK);
    for (uint32_t f = 0; f < 600 && body->doll; f++) run(&s, 1);
    for (uint32_t n = 0; n < 2; n++) {
        noh_ragdoll_measures joints;
        rescale(&s, 1, n ? 0.25f : 2.0f);
        assert_int_equal(body->doll, 0);
        push(&s, 1, 0.1f);
        assert_true(body->doll != 0);
        noh_ragdoll_measure(shared->dolls, body->doll - 1u, NULL, &joints);
        print_message("# apart by %.4f\n", (double)joints.separation);
        assert_true(joints.separation < 0.01f);
        for (uint32_t f = 0; f < 600 && body->doll; f++) {
            run(&s, 1);
            if (f % 16u == 0) is_put_back(&s);
            if (!body->doll) continue;
            noh_ragdoll_measure(shared->dolls, body->doll - 1u, NULL, &joints);
            assert_true(joints.separation < 0.05f);
        }
    }
    close_scene(&s);
}

/* An actor that cannot fall takes no push on its feet; one that has begun to, and finds no ragdoll, stands again. */
static void who_cannot_fall_stands(void **state)
{
    const noh_kind_ragdoll one = { .count = 1, .world = &ground, .stagger_speed = 100.0f };
    const float point[3] = { 0.0f, 100.0f, 0.0f }, impulse[3] = { 0.0f, 0.0f, 5.6e9f };
    scene s;
    (void)state;
    open_scene_with(&s, &one, 1);
    rescale(&s, 0, 200.0f);
    run(&s, 10);
    assert_int_equal(noh_actor_hit(s.cast.stage, s.actors[0], point, impulse, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_actor_body(s.cast.stage, s.actors[0]), NOH_BODY_STANDS);
    assert_int_equal(noh_actor_fall(s.cast.stage, s.actors[1], NULL), NOH_OK);
    push(&s, 2, 20.0f);
    assert_int_equal(noh_actor_body(s.cast.stage, s.actors[2]), NOH_BODY_STAGGERS);
    for (uint32_t f = 0; f < 60; f++) {
        noh_place place;
        run(&s, 1);
        is_put_back(&s);
        assert_int_equal(noh_actor_place(s.cast.stage, s.actors[2], &place, NULL), NOH_OK);
        assert_true(fabsf(place.position[2]) < 2.0f);
    }
    assert_int_equal(noh_actor_body(s.cast.stage, s.actors[2]), NOH_BODY_STANDS);
    push(&s, 2, 0.01f);
    rescale(&s, 2, 0.0001f);
    run(&s, 1);
    is_put_back(&s);
    assert_int_equal(noh_actor_body(s.cast.stage, s.actors[2]), NOH_BODY_STANDS);
    close_scene(&s);
}

/* Any number of jobs and a game's physics; a state put back in the middle of falls, and one whose sizes are broken. */
static void falls_are_put_back(void **state)
{
    uint64_t hashes[3];
    (void)state;
    for (uint32_t way = 0; way < 3; way++) {
        game_physics game;
        const noh_world asking = game_world(&game, &ground);
        const float shift[3] = { -4096.0f, 0.0f, 128.0f };
        float at[3], shifted[3];
        size_t bytes;
        scene s;
        open_scene(&s, way == 1u ? &asking : &ground, way == 2u ? 3 : 1);
        run(&s, 10);
        for (uint32_t i = 0; i < SIZES; i++) push(&s, i, 3.0f);
        run(&s, 30);
        void *saved = test_aligned(noh_stage_state(s.cast.stage, &bytes), (size_t)s.cast.plan.state_bytes);
        for (uint32_t again = 0; again < 2; again++) {
            run(&s, 60);
            hashes[way] = noh_stage_hash(s.cast.stage);
            assert_true(hashes[way] == hashes[0]);
            assert_int_equal(noh_stage_set_state(s.cast.stage, saved, bytes, NULL), NOH_OK);
        }
        noh_ragdolls *dolls = noh_stage_ragdoll_kind_of(&s.cast.stage->kinds[0])->dolls;
        const uint8_t *base = noh_stage_state(s.cast.stage, &bytes);
        const size_t offset = (size_t)((const uint8_t *)&noh_ragdoll_dolls(dolls)[0].size_high - base);
        ((uint8_t *)saved)[offset] ^= 0x40u;
        ((uint8_t *)saved)[offset + 1u] ^= 0x40u;
        assert_int_equal(noh_stage_set_state(s.cast.stage, saved, bytes, NULL), NOH_ERR_DATA);
        ((uint8_t *)saved)[offset] ^= 0x40u;
        ((uint8_t *)saved)[offset + 1u] ^= 0x40u;
        run(&s, 1);
        joint_at(&s, 2, "head", at);
        assert_int_equal(noh_stage_set_state(s.cast.stage, saved, bytes, NULL), NOH_OK);
        free(saved);
        assert_int_equal(noh_stage_shift_origin(s.cast.stage, shift, NULL), NOH_OK);
        run(&s, 1);
        joint_at(&s, 2, "head", shifted);
        for (int k = 0; k < 3; k++) shifted[k] += shift[k];
        assert_true(distance(at, shifted) < 0.003f);
        close_scene(&s);
    }
}

/* A game that changes the scale of an actor that falls changes its look, and nothing leaps; bad scales are refused. */
static void a_scale_may_change_in_a_fall(void **state)
{
    float was[3], now[3];
    noh_place place;
    scene s;
    (void)state;
    open_scene(&s, &ground, 1);
    run(&s, 10);
    assert_int_equal(noh_actor_fall(s.cast.stage, s.actors[2], NULL), NOH_OK);
    run(&s, 20);
    joint_at(&s, 2, "hips", was);
    assert_int_equal(noh_actor_place(s.cast.stage, s.actors[2], &place, NULL), NOH_OK);
    place.scale = 2.0f;
    assert_int_equal(noh_actor_set_place(s.cast.stage, s.actors[2], &place, NULL), NOH_OK);
    run(&s, 1);
    joint_at(&s, 2, "hips", now);
    assert_true(distance(was, now) < 0.3f);
    place.scale = 1000.0f;
    assert_int_equal(noh_actor_set_place(s.cast.stage, s.actors[0], &place, NULL), NOH_OK);
    assert_int_equal(noh_actor_fall(s.cast.stage, s.actors[0], NULL), NOH_ERR_ARG);
    close_scene(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_size_is_a_rig_of_that_size),
    cmocka_unit_test(every_size_falls_lies_and_gets_up),
    cmocka_unit_test(gravity_is_the_same_for_all),
    cmocka_unit_test(staggers_follow_the_size),
    cmocka_unit_test(falls_are_put_back),
    cmocka_unit_test(a_scale_may_change_in_a_fall),
    cmocka_unit_test(a_hard_push_moves_the_smallest),
    cmocka_unit_test(a_small_push_moves_no_foot),
    cmocka_unit_test(braces_last_by_the_size),
    cmocka_unit_test(larger_actors_are_down_for_longer),
    cmocka_unit_test(who_cannot_fall_stands),
    cmocka_unit_test(a_dead_actor_may_be_scaled),
};

TEST_MAIN(tests, NULL, NULL)
