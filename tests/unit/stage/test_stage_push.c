/* Pushes of 10 to 400 newton seconds from eight sides on twenty standing puppets each: a table of who sways, steps,
 * falls and braces; feet stay below hips, and no head lands first. Feet that stand do not slide; steps up and down; the
 * same bits for any number of jobs, and from a saved state. */
#include "support/stage_fixture.h"

#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "life/physics/world_internal.h"
#include "stage/modules/stage_ragdoll_internal.h"

#include <math.h>
#include <string.h>

#define SEEDS 20u
#define SIDES 8u
#define FRAMES 360u
#define TOUCH 0.02f

static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };

static void open_cast(cast *c, uint32_t actors, const noh_kind_ragdoll *ragdoll, uint32_t jobs)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_falls.noh");
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].ragdoll = noh_ragdoll_module(ragdoll);
    c->kinds[0].inertia = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
}

static void close_cast(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
}

static noh_actor enter(const cast *c, float x, float z, uint32_t start)
{
    const noh_appearance posed = { .posed = 1 };
    const noh_place place = { { x, 0.0f, z }, { 0, 0, 0, 0 }, 0.0f };
    const noh_play play = { .start_ticks = (int64_t)start };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c->stage, actor, 0, "idle", &play, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &posed, NULL), NOH_OK);
    return actor;
}

static void run(const cast *c, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++) {
        assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    }
}

static const noh_stage_body *body_of(const cast *c, uint32_t i)
{
    return noh_stage_body_of(&c->stage->kinds[0], i);
}

static float lowest(const cast *c, uint32_t actor, uint32_t body)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(&c->stage->kinds[0]);
    const noh_stage_body *b = body_of(c, actor);
    const float *q = b->bodies[0][body].rotation;
    const float along = fabsf(2.0f * (q[1] * q[2] - q[0] * q[3]));
    return b->origin[1] + b->bodies[0][body].position[1] - along * shared->rig.bodies[body].half -
           shared->rig.bodies[body].radius;
}

typedef struct seen {
    uint32_t was_stepping, steps, falls, landed, braces, head_first, stands;
    float foot_over_hip, foot_over_hip_lying;
} seen;

static void watch_fall(const cast *c, uint32_t i, noh_body_state state, seen *s)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(&c->stage->kinds[0]);
    const noh_stage_parts *p = &shared->parts;
    const noh_stage_body *b = body_of(c, i);
    for (uint32_t f = 0; f < 2; f++) {
        const float over = b->bodies[0][p->feet[f]].position[1] - b->bodies[0][0].position[1];
        s->foot_over_hip = fmaxf(s->foot_over_hip, over);
        if (state == NOH_BODY_LIES) s->foot_over_hip_lying = fmaxf(s->foot_over_hip_lying, over);
    }
    if (s->landed) return;
    for (uint32_t n = 1; n < shared->rig.body_count; n++) {
        int leg = 0;
        for (uint32_t f = 0; f < 2; f++) leg |= n == p->feet[f] || n == p->shins[f] || n == p->thighs[f];
        if (leg || n == p->head || lowest(c, i, n) > TOUCH) continue;
        s->landed = 1;
        for (uint32_t f = 0; f < 2; f++) {
            s->braces |= n == p->forearms[f] || shared->rig.bodies[n].parent == p->forearms[f];
        }
    }
    if (lowest(c, i, 0) < TOUCH) s->landed = 1;
    if (p->head != NOH_NONE && lowest(c, i, p->head) < TOUCH && !s->landed) s->head_first = s->landed = 1;
}

/* Returns 0: it stands or lies. */
static uint32_t watch(const cast *c, uint32_t i, noh_actor actor, seen *s)
{
    const noh_body_state state = noh_actor_body(c->stage, actor);
    const uint32_t steps = state == NOH_BODY_STAGGERS && body_of(c, i)->of.stagger.foot;
    s->steps += steps && !s->was_stepping;
    s->was_stepping = steps;
    s->falls |= state == NOH_BODY_FALLS;
    s->stands = state == NOH_BODY_STANDS;
    if (state == NOH_BODY_FALLS || state == NOH_BODY_LIES) watch_fall(c, i, state, s);
    return state != NOH_BODY_STANDS && state != NOH_BODY_LIES;
}

static float random_of(uint32_t seed, uint32_t which) /* -1..1 */
{
    uint32_t x = seed * 747796405u + which * 2891336453u + 1u;
    x = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
    return (float)((x >> 22) ^ x) / 2147483648.0f - 1.0f;
}

typedef struct row {
    uint32_t sways, steps, steppers, falls, landed, braces, head_first, down;
    float foot_over_hip, foot_over_hip_lying;
} row;

static void push_from(float newton_seconds, uint32_t side, row *r)
{
    const noh_kind_ragdoll ragdoll = { .count = SEEDS, .world = &ground };
    noh_actor actors[SEEDS];
    seen s[SEEDS];
    cast c;
    memset(s, 0, sizeof s);
    open_cast(&c, SEEDS, &ragdoll, 1);
    for (uint32_t i = 0; i < SEEDS; i++) actors[i] = enter(&c, 3.0f * (float)i, 0.0f, i * NOH_TICKS_PER_SECOND / 7u);
    run(&c, 3);
    for (uint32_t i = 0; i < SEEDS; i++) {
        const float angle = 0.78539816f * ((float)side + 0.3f * random_of(i, 0));
        const float impulse[3] = { newton_seconds * sinf(angle), 0.0f, newton_seconds * cosf(angle) };
        const float point[3] = { 3.0f * (float)i + 0.08f * random_of(i, 1), 1.2f + 0.15f * random_of(i, 2), 0.0f };
        assert_int_equal(noh_actor_hit(c.stage, actors[i], point, impulse, NULL), NOH_OK);
    }
    for (uint32_t f = 0, moves = 1; f < FRAMES && moves; f++) {
        run(&c, 1);
        moves = 0;
        for (uint32_t i = 0; i < SEEDS; i++) moves |= watch(&c, i, actors[i], &s[i]);
    }
    for (uint32_t i = 0; i < SEEDS; i++) {
        r->sways += !s[i].steps && !s[i].falls;
        r->steps += s[i].falls ? 0 : s[i].steps;
        r->steppers += s[i].steps && !s[i].falls;
        r->falls += s[i].falls;
        r->braces += s[i].braces;
        r->head_first += s[i].head_first;
        r->down += !s[i].stands && !s[i].falls;
        r->foot_over_hip = fmaxf(r->foot_over_hip, s[i].foot_over_hip);
        r->foot_over_hip_lying = fmaxf(r->foot_over_hip_lying, s[i].foot_over_hip_lying);
    }
    close_cast(&c);
}

/* No foot goes above the hips, and no head lands first. Without NOH_LONG every other push, so
 * that each assertion below still has one that it is about. */
static void a_table_of_pushes(void **state)
{
    static const float pushes[] = { 10.0f, 20.0f, 40.0f, 70.0f, 80.0f, 90.0f, 100.0f, 200.0f, 300.0f, 400.0f };
    (void)state;
    print_message("    N s   sway  step  steps  fall  brace  head first  foot over hip, falling and lying\n");
    for (size_t p = 0; p < TEST_COUNT(pushes); p += getenv("NOH_LONG") ? 1u : 2u) {
        row all = { 0 };
        for (uint32_t side = 0; side < SIDES; side++) {
            row r = { 0 };
            push_from(pushes[p], side, &r);
            all.sways += r.sways;
            all.steppers += r.steppers;
            all.steps += r.steps;
            all.falls += r.falls;
            all.braces += r.braces;
            all.head_first += r.head_first;
            all.down += r.down;
            all.foot_over_hip = fmaxf(all.foot_over_hip, r.foot_over_hip);
            all.foot_over_hip_lying = fmaxf(all.foot_over_hip_lying, r.foot_over_hip_lying);
        }
        print_message("    %3.0f   %4u  %4u  %5.2f  %4u  %5u  %10u  %.2f %.2f m\n", (double)pushes[p], all.sways,
                      all.steppers, all.steppers ? (double)all.steps / (double)all.steppers : 0.0, all.falls,
                      all.braces, all.head_first, (double)all.foot_over_hip, (double)all.foot_over_hip_lying);
        assert_int_equal(all.down, 0);
        assert_int_equal(all.head_first, 0);
        assert_true(50u * all.braces >= 49u * all.falls); /* a few land on the seat */
        assert_true(pushes[p] > 15.0f || all.sways == SIDES * SEEDS);
        assert_true(pushes[p] < 35.0f || pushes[p] > 75.0f || all.steppers == SIDES * SEEDS);
        assert_true(pushes[p] < 95.0f || all.falls == SIDES * SEEDS);
        assert_true(all.foot_over_hip < 0.08f); /* centres: an ankle that lies on a shin is higher than slim hips */
    }
}

static void joint_at(const cast *c, noh_actor actor, const char *name, float out[3])
{
    float matrix[12];
    const uint32_t joint = noh_stage_find(c->stage, 0, NOH_NAME_JOINT, name);
    assert_int_equal(noh_actor_joint(c->stage, actor, joint, matrix, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) out[i] = matrix[4 * i + 3];
}

static void push_forward(const cast *c, noh_actor actor, float newton_seconds)
{
    const float point[3] = { 0.0f, 1.2f, 0.0f }, impulse[3] = { 0.0f, 0.0f, newton_seconds };
    assert_int_equal(noh_actor_hit(c->stage, actor, point, impulse, NULL), NOH_OK);
}

/* One that steps ends up in its stance in another place; feet that stand stay where they are, and no joint leaps. */
static void feet_step_and_do_not_slide(void **state)
{
    static const char *const names[] = { "foot.L", "foot.R", "hips", "head", "hand.L" };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    float before[5][3], stance[2][3], now[3], slid = 0.0f;
    noh_place place;
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    const noh_actor actor = enter(&c, 0.0f, 0.0f, 0);
    run(&c, 3);
    for (int i = 0; i < 5; i++) joint_at(&c, actor, names[i], before[i]);
    memcpy(stance, before, sizeof stance);
    push_forward(&c, actor, 60.0f);
    assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_STAGGERS);
    for (uint32_t f = 0; f < 300; f++) {
        const uint32_t foot = body_of(&c, 0)->of.stagger.foot; /* before this frame */
        run(&c, 1);
        const noh_stage_stagger *s = &body_of(&c, 0)->of.stagger;
        const int staggers = noh_actor_body(c.stage, actor) == NOH_BODY_STAGGERS && !s->ends;
        for (uint32_t i = 0; i < 5; i++) {
            joint_at(&c, actor, names[i], now);
            const float way = hypotf(now[0] - before[i][0], now[2] - before[i][2]);
            const float far = hypotf(way, now[1] - before[i][1]);
            if (i < 2 && staggers && foot != i + 1u && s->foot != i + 1u) slid = fmaxf(slid, way);
            assert_true(far < (i < 2 ? 0.12f : 0.06f));
            assert_true(i > 1 || now[1] > stance[i][1] - 0.01f);
            memcpy(before[i], now, sizeof now);
        }
    }
    assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_STANDS);
    assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
    print_message("it went %.0f mm; a foot that stands slides %.2f mm a frame at most\n",
                  1e3 * (double)place.position[2], 1e3 * (double)slid);
    assert_true(place.position[2] > 0.15f && place.position[2] < 1.0f && fabsf(place.position[0]) < 0.1f);
    assert_true(slid < 0.002f);
    close_cast(&c);
}

/* On a lower step it stands after its steps; where the ground ends, it falls. */
static void it_steps_down_and_falls_off(void **state)
{
    (void)state;
    for (int deep = 0; deep < 2; deep++) {
        const float low = deep ? -2.0f : -0.12f;
        const noh_plane below = { { 0.0f, 1.0f, 0.0f }, low };
        const noh_obb top = { { 0.0f, -1.5f, -4.9f }, { 5.0f, 1.5f, 5.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
        const noh_world world = { .planes = &below, .plane_count = 1, .boxes = &top, .box_count = 1, .friction = 0.6f };
        const noh_kind_ragdoll ragdoll = { .count = 1, .world = &world };
        uint32_t fell = 0;
        noh_place place;
        cast c;
        open_cast(&c, 1, &ragdoll, 1);
        const noh_actor actor = enter(&c, 0.0f, 0.0f, 0);
        run(&c, 3);
        push_forward(&c, actor, 60.0f);
        for (uint32_t f = 0; f < 300; f++) {
            run(&c, 1);
            fell |= noh_actor_body(c.stage, actor) == NOH_BODY_FALLS;
        }
        assert_int_equal(fell, deep);
        assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
        if (!deep) assert_true(fabsf(place.position[1] - low) < 0.01f);
        close_cast(&c);
    }
}

/* A wall is before it: it stays on this side of it, with its feet. A wall as low as a stair is stepped on. */
static void it_does_not_step_through_walls(void **state)
{
    (void)state;
    for (int low = 0; low < 2; low++) {
        const noh_obb wall = { { 0.0f, 0.0f, 0.8f }, { 4.0f, low ? 0.15f : 2.0f, 0.5f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
        const noh_world world = {
            .planes = &floor_plane, .plane_count = 1, .boxes = &wall, .box_count = 1, .friction = 0.6f
        };
        const noh_kind_ragdoll ragdoll = { .count = 1, .world = &world };
        float foot[3], farthest = 0.0f;
        noh_place place;
        cast c;
        open_cast(&c, 1, &ragdoll, 1);
        const noh_actor actor = enter(&c, 0.0f, 0.0f, 0);
        run(&c, 3);
        push_forward(&c, actor, 60.0f);
        for (uint32_t f = 0; f < 300; f++) {
            run(&c, 1);
            for (int i = 0; i < 2; i++) {
                joint_at(&c, actor, i ? "foot.L" : "foot.R", foot);
                farthest = fmaxf(farthest, foot[2]);
            }
        }
        assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_STANDS);
        assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
        assert_true(low ? place.position[2] > 0.3f : place.position[2] > 0.02f && place.position[2] < 0.2f);
        assert_true(low ? farthest > 0.3f : farthest < 0.3f);
        close_cast(&c);
    }
}

/* Clips whose hips travel in the pose, not in the place. */
static void travel(noh_modifier_work *w)
{
    const uint32_t hips = *(const uint32_t *)w->user;
    w->local[hips].translation[2] += 1.2f * (float)w->clock / (float)NOH_TICKS_PER_SECOND;
}

/* It steps where the hips were when the push came; they neither sink nor leap then or later. */
static void hips_that_travel_stay_over_their_feet(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    uint32_t hips = 0, staggers = 0;
    const noh_modifier modifier = { .name = "travel", .modify = travel, .user = &hips };
    float before[3], now[3], stood;
    cast c;
    (void)state;
    memset(&c, 0, sizeof c);
    cast_map(&c, PUPPETS, "demo/puppet_falls.noh");
    c.kinds[0].mesh = &c.packs[0];
    c.kinds[0].actor_count = 1;
    c.kinds[0].ragdoll = noh_ragdoll_module(&ragdoll);
    c.kinds[0].modifiers = &modifier;
    c.kinds[0].modifier_count = 1;
    c.desc.kinds = c.kinds;
    c.desc.kind_count = 1;
    c.desc.job_count = 1;
    cast_make(&c, NULL);
    hips = noh_stage_find(c.stage, 0, NOH_NAME_JOINT, "hips");
    const noh_actor actor = enter(&c, 0.0f, 0.0f, 0);
    run(&c, 3);
    joint_at(&c, actor, "hips", before);
    stood = before[1];
    push_forward(&c, actor, 40.0f);
    for (uint32_t f = 0; f < 300; f++) {
        run(&c, 1);
        joint_at(&c, actor, "hips", now);
        staggers += noh_actor_body(c.stage, actor) == NOH_BODY_STAGGERS;
        assert_true(now[1] > 0.85f * stood);
        assert_true(hypotf(now[0] - before[0], now[2] - before[2]) < 0.06f);
        memcpy(before, now, sizeof now);
    }
    assert_true(staggers > 30);
    assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_STANDS);
    close_cast(&c);
}

/* Ten at the head of a flight of stairs: they fall down it, arms first, and lie on it or at its foot, not in it. */
static void they_fall_down_stairs(void **state)
{
    enum { STEPS = 9, FIGURES = 10 };
    const noh_plane below = { { 0.0f, 1.0f, 0.0f }, -0.17f * STEPS };
    noh_obb steps[STEPS];
    const noh_world world = {
        .planes = &below, .plane_count = 1, .boxes = steps, .box_count = STEPS, .friction = 0.6f
    };
    const noh_kind_ragdoll ragdoll = { .count = FIGURES, .world = &world };
    noh_actor actors[FIGURES];
    seen s[FIGURES];
    float least = 0.0f, most = -10.0f, deepest = 0.0f;
    cast c;
    (void)state;
    memset(s, 0, sizeof s);
    for (int i = 0; i < STEPS; i++) {
        const noh_obb box = { { 0.0f, -0.17f * (float)i - 1.0f, i ? 0.28f * (float)i + 0.06f : -1.8f },
                              { 40.0f, 1.0f, i ? 0.14f : 2.0f },
                              { 0.0f, 0.0f, 0.0f, 1.0f } };
        steps[i] = box;
    }
    open_cast(&c, FIGURES, &ragdoll, 1);
    for (uint32_t i = 0; i < FIGURES; i++) actors[i] = enter(&c, 3.0f * (float)i - 15.0f, 0.0f, 3000u * i);
    run(&c, 3);
    for (uint32_t i = 0; i < FIGURES; i++) {
        const float impulse[3] = { 10.0f * random_of(i, 7), 0.0f, 100.0f + 10.0f * (float)i };
        const float point[3] = { 3.0f * (float)i - 15.0f, 1.2f, 0.0f };
        assert_int_equal(noh_actor_hit(c.stage, actors[i], point, impulse, NULL), NOH_OK);
    }
    for (uint32_t f = 0; f < 420; f++) {
        run(&c, 1);
        for (uint32_t i = 0; i < FIGURES; i++) (void)watch(&c, i, actors[i], &s[i]);
    }
    for (uint32_t i = 0; i < FIGURES; i++) {
        const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(&c.stage->kinds[0]);
        const noh_stage_body *b = body_of(&c, i);
        assert_true(s[i].falls && !s[i].head_first);
        for (uint32_t n = 0; n < shared->rig.body_count; n++) {
            const float at[3] = { b->bodies[0][n].position[0], b->bodies[0][n].position[1],
                                  b->bodies[0][n].position[2] };
            float floor;
            assert_true(noh_world_ground_below(&world, b->origin, at, 10.0f, &floor));
            deepest = fmaxf(deepest, floor - at[1]);
        }
        least = fminf(least, b->origin[1] + b->bodies[0][0].position[1]);
        most = fmaxf(most, b->origin[1] + b->bodies[0][0].position[1]);
    }
    print_message("hips end %.2f to %.2f m below the top step; a body's axis is %.0f mm inside at most\n",
                  -(double)most, -(double)least, 1e3 * (double)deepest);
    assert_true(most < -0.5f && deepest < 0.01f);
    close_cast(&c);
}

/* Five are pushed by different amounts; the state is saved in the middle of steps. */
static uint64_t five_are_pushed(uint32_t jobs, int restored)
{
    const noh_kind_ragdoll ragdoll = { .count = 5, .world = &ground };
    noh_actor actors[5];
    size_t bytes;
    cast c;
    open_cast(&c, 5, &ragdoll, jobs);
    for (uint32_t i = 0; i < 5; i++) actors[i] = enter(&c, 0.5f * (float)i, 0.0f, 1000u * i);
    run(&c, 5);
    for (uint32_t i = 0; i < 5; i++) push_forward(&c, actors[i], 15.0f + 30.0f * (float)i);
    run(&c, 14);
    assert_int_equal(noh_actor_body(c.stage, actors[2]), NOH_BODY_STAGGERS);
    assert_int_equal(noh_actor_body(c.stage, actors[4]), NOH_BODY_FALLS);
    if (restored) {
        void *copy = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
        run(&c, 50);
        assert_int_equal(noh_stage_set_state(c.stage, copy, (size_t)c.plan.state_bytes, NULL), NOH_OK);
        free(copy);
    }
    push_forward(&c, actors[1], 20.0f); /* and again while they step */
    run(&c, 90);
    const uint64_t hash = noh_stage_hash(c.stage);
    close_cast(&c);
    return hash;
}

static void bits_are_equal(void **state)
{
    const uint64_t hash = five_are_pushed(1, 0);
    (void)state;
    assert_true(five_are_pushed(3, 0) == hash);
    assert_true(five_are_pushed(2, 1) == hash);
}

static void no_steps_below_zero(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground, .stagger_speed = -1.0f };
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    const noh_actor actor = enter(&c, 0.0f, 0.0f, 0);
    run(&c, 3);
    push_forward(&c, actor, 5.0f);
    assert_int_equal(noh_actor_body(c.stage, actor), NOH_BODY_FALLS);
    close_cast(&c);
}

/* A state from outside that its code cannot have left is refused. */
static void damaged_states_are_refused(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    (void)state;
    for (int what = 0; what < 4; what++) {
        size_t bytes;
        cast c;
        open_cast(&c, 1, &ragdoll, 1);
        const noh_actor actor = enter(&c, 0.0f, 0.0f, 0);
        run(&c, 3);
        push_forward(&c, actor, what == 3 ? 200.0f : 50.0f);
        run(&c, 8);
        noh_stage_body *b = noh_stage_body_of(&c.stage->kinds[0], 0);
        if (what == 0) b->of.stagger.foot = 3;
        if (what == 1) b->of.stagger.speed[1] = NAN;
        if (what == 2) b->of.stagger.step_lasts = 0;
        if (what == 3) b->of.brace.strength = 2.0f;
        void *copy = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
        assert_int_equal(noh_stage_set_state(c.stage, copy, (size_t)c.plan.state_bytes, NULL), NOH_ERR_DATA);
        free(copy);
        close_cast(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_table_of_pushes),
        cmocka_unit_test(feet_step_and_do_not_slide),
        cmocka_unit_test(it_steps_down_and_falls_off),
        cmocka_unit_test(it_does_not_step_through_walls),
        cmocka_unit_test(hips_that_travel_stay_over_their_feet),
        cmocka_unit_test(they_fall_down_stairs),
        cmocka_unit_test(bits_are_equal),
        cmocka_unit_test(no_steps_below_zero),
        cmocka_unit_test(damaged_states_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
