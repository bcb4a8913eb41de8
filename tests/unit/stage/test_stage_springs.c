/* Springs on a stage: the sleeves of puppets swing, stay out of what they collide with, have the same bits for any
 * number of jobs, and are saved and put back. */
#include <math.h>

#include "support/stage_fixture.h"
#include "stage/modules/springs_internal.h"
#include "noh/base.h"
#include "noh/modules.h"

#define SLEEVES 2u
#define CAST 6u
#define BONE 0.15f

static noh_error said;
static const char *const sleeve_names[SLEEVES] = { "sleeve.L", "sleeve.R" };

typedef struct sleeves {
    noh_spring_row rows[SLEEVES];
    noh_spring_chain chains[SLEEVES];
    noh_spring_capsule capsules[SLEEVES];
    noh_springs_desc desc;
    noh_springs *springs;
    noh_modifier part;
} sleeves;

static uint32_t joint_of(const noh_pack *pack, const char *name)
{
    noh_skeleton skeleton;
    assert_int_equal(noh_pack_skeleton_at(pack, 0, &skeleton, NULL, NULL), NOH_OK);
    for (uint32_t j = 0; j < skeleton.joint_count; j++) {
        const char *own = noh_pack_joint_name(pack, 0, j);
        if (own && strcmp(own, name) == 0) return j;
    }
    fail_msg("the puppet has no joint %s", name);
    return 0;
}

/* Sleeves that hang 15 cm down in the bind pose, each with a sphere about the parent of its joint. */
static void sleeves_describe(sleeves *s, const noh_pack *pack, uint32_t colliders)
{
    static float model_space[12u * NOH_JOINTS_MAX];
    noh_skeleton *k = &s->desc.skeleton;
    memset(s, 0, sizeof *s);
    assert_int_equal(noh_pack_skeleton_at(pack, 0, k, NULL, NULL), NOH_OK);
    noh_local_to_model(k, k->bind_pose, k->joint_count, model_space);
    for (uint32_t i = 0; i < SLEEVES; i++) {
        const uint32_t joint = joint_of(pack, sleeve_names[i]);
        const float *m = model_space + 12u * joint;
        s->rows[i] = (noh_spring_row){ joint, 0.5f, 0.2f, 0.01f, { 0.0f, -1.0f, 0.0f } };
        s->chains[i].first_row = i, s->chains[i].row_count = 1, s->chains[i].collides = colliders ? 1u << i : 0u;
        for (int a = 0; a < 3; a++) s->chains[i].end[a] = -BONE * m[4 + a];
        s->capsules[i].joint = k->parents[joint];
        s->capsules[i].radius = 0.22f;
    }
    s->desc.metres = 1.0f;
    s->desc.rows = s->rows, s->desc.row_count = SLEEVES;
    s->desc.chains = s->chains, s->desc.chain_count = SLEEVES;
    s->desc.colliders = s->capsules, s->desc.collider_count = colliders;
}

static void sleeves_make(sleeves *s)
{
    const size_t bytes = noh_springs_size(&s->desc);
    void *memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_springs_init(memory, bytes - 1u, &s->desc, &s->springs, NULL), NOH_ERR_MEMORY);
    if (noh_springs_init(memory, bytes, &s->desc, &s->springs, &said) != NOH_OK) fail_msg("%s", said.what);
    s->part = noh_springs_modifier(s->springs);
}

static void open_dancers(cast *c, sleeves *s, uint32_t actors, uint32_t jobs, uint32_t colliders)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    sleeves_describe(s, &c->packs[0], colliders);
    sleeves_make(s);
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].modifiers = &s->part;
    c->kinds[0].modifier_count = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
    for (uint32_t i = 0; i < actors; i++) {
        const noh_place place = { { 1.1f * (float)i, 0.0f, -0.7f * (float)i }, { 0, 0, 0, 0 }, 0.0f };
        noh_actor actor;
        assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c->stage, actor, 0, i % 2u ? "walk" : "dance", NULL, NULL), NOH_OK);
    }
}

static void close_dancers(cast *c, sleeves *s)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
    free(s->springs);
}

static void frame(const cast *c, uint32_t number)
{
    const noh_stage_view view = cast_view(number, 5.0f);
    assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

/* Where a sleeve's bone begins and ends, in the world. */
static void bone_of(const cast *c, const sleeves *s, noh_actor actor, uint32_t side, float from[3], float to[3])
{
    float m[12];
    assert_int_equal(noh_actor_joint(c->stage, actor, s->rows[side].joint, m, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) {
        from[i] = m[4 * i + 3];
        to[i] = from[i];
        for (int a = 0; a < 3; a++) to[i] += m[4 * i + a] * s->chains[side].end[a];
    }
}

static double apart(const float a[3], const float b[3])
{
    double sum = 0.0;
    for (int i = 0; i < 3; i++) sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sqrt(sum);
}

/* In a dance a sleeve leaves the line straight down and comes back to it; its bone keeps its length. */
static void sleeves_swing_in_a_dance(void **state)
{
    double steepest = 0.0, least = 180.0, stretch = 0.0;
    sleeves s;
    cast c;
    (void)state;
    open_dancers(&c, &s, 1, 1, 0);
    for (uint32_t f = 0; f < 400; f++) {
        float from[3], to[3];
        frame(&c, f);
        bone_of(&c, &s, noh_stage_actor_at(c.stage, 0), 0, from, to);
        const double length = apart(from, to), cosine = ((double)from[1] - (double)to[1]) / length;
        const double off = acos(fmin(cosine, 1.0)) * 57.2957795;
        stretch = fmax(stretch, fabs(length / (double)BONE - 1.0));
        steepest = fmax(steepest, off);
        least = fmin(least, off);
    }
    print_message("# a sleeve hangs %.1f to %.1f degrees off straight down, stretched by %.2g\n", least, steepest,
                  stretch);
    assert_true(steepest - least > 10.0 && steepest < 170.0);
    assert_true(stretch < 1e-3);
    close_dancers(&c, &s);
}

/* With a sphere at the elbow the ends of sleeves are kept off that joint. */
static void sleeves_stay_out_of_colliders(void **state)
{
    double nearest[2] = { 1.0, 1.0 };
    (void)state;
    for (uint32_t with = 0; with < 2; with++) {
        sleeves s;
        cast c;
        open_dancers(&c, &s, 1, 1, with ? SLEEVES : 0);
        for (uint32_t f = 0; f < 200; f++) {
            float from[3], to[3], m[12], at[3];
            const noh_actor actor = noh_stage_actor_at(c.stage, 0);
            frame(&c, f);
            bone_of(&c, &s, actor, 1, from, to);
            assert_int_equal(noh_actor_joint(c.stage, actor, s.capsules[1].joint, m, NULL), NOH_OK);
            for (int i = 0; i < 3; i++) at[i] = m[4 * i + 3];
            nearest[with] = fmin(nearest[with], apart(at, to));
        }
        close_dancers(&c, &s);
    }
    print_message("# the end comes as near as %.0f mm without a collider, %.0f mm with\n", 1e3 * nearest[0],
                  1e3 * nearest[1]);
    assert_true(nearest[1] > nearest[0] + 0.01 && nearest[1] > 0.21);
}

static uint8_t *forged_part(const cast *c, uint8_t *saved)
{
    size_t bytes;
    const uint8_t *live = noh_actor_modifier(c->stage, noh_stage_actor_at(c->stage, 1), 0);
    return saved + (live - (const uint8_t *)noh_stage_state(c->stage, &bytes));
}

/* Jobs in any number give the same bits; a state put back is followed by the same; a broken one is refused. */
static void swinging_states_are_put_back(void **state)
{
    static const uint32_t jobs[] = { 1, 3 };
    uint64_t hashes[60];
    (void)state;
    for (uint32_t j = 0; j < 2; j++) {
        sleeves s;
        cast c;
        size_t bytes;
        open_dancers(&c, &s, CAST, jobs[j], SLEEVES);
        for (uint32_t f = 0; f < 40; f++) frame(&c, f);
        const void *now = noh_stage_state(c.stage, &bytes);
        uint8_t *saved = test_aligned(now, (size_t)c.plan.state_bytes);
        for (uint32_t again = 0; again < 2; again++) {
            for (uint32_t f = 0; f < 60; f++) {
                frame(&c, 40u + f);
                if (j + again == 0) hashes[f] = noh_stage_hash(c.stage);
                if (noh_stage_hash(c.stage) != hashes[f]) fail_msg("%u jobs: frame %u differs", jobs[j], f);
            }
            assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, NULL), NOH_OK);
        }
        uint8_t *part = forged_part(&c, saved);
        const uint32_t begun = 2u;
        const float huge = 1e30f;
        uint8_t kept[64];
        memcpy(kept, part, sizeof kept);
        memcpy(part, &begun, sizeof begun);
        assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, &said), NOH_ERR_DATA);
        assert_non_null(strstr(said.what, "springs"));
        memcpy(part, kept, sizeof kept);
        memcpy(part + 16 + 104, &huge, sizeof huge); /* behind the flags and the head of the spring: its first end */
        assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, &said), NOH_ERR_DATA);
        free(saved);
        close_dancers(&c, &s);
    }
}

static void expect(const noh_springs_desc *desc, noh_result result)
{
    static uint8_t memory[1u << 14] __attribute__((aligned(16)));
    noh_springs *springs = NULL;
    assert_int_equal(noh_springs_init(memory, sizeof memory, desc, &springs, &said), result);
    assert_true(!springs == (result != NOH_OK));
}

/* One fault at a time, of any collider. */
static void bad_colliders_are_refused(void **state)
{
    static const float bad[3] = { NAN, INFINITY, -INFINITY };
    sleeves s;
    cast c;
    (void)state;
    memset(&c, 0, sizeof c);
    cast_map(&c, PUPPETS, "demo/puppet_levels.noh");
    sleeves_describe(&s, &c.packs[0], SLEEVES);
    for (uint32_t i = 0; i < SLEEVES; i++) {
        const noh_spring_capsule good = s.capsules[i];
        float *const numbers[7] = { s.capsules[i].from,   s.capsules[i].from + 1, s.capsules[i].from + 2,
                                    s.capsules[i].to,     s.capsules[i].to + 1,   s.capsules[i].to + 2,
                                    &s.capsules[i].radius };
        for (uint32_t n = 0; n < 21; n++) {
            *numbers[n / 3u] = bad[n % 3u];
            expect(&s.desc, NOH_ERR_ARG);
            s.capsules[i] = good;
        }
        s.capsules[i].radius = -0.01f;
        expect(&s.desc, NOH_ERR_ARG);
        s.capsules[i] = good;
        s.capsules[i].joint = s.desc.skeleton.joint_count;
        expect(&s.desc, NOH_ERR_ARG);
        s.capsules[i] = good;
        expect(&s.desc, NOH_OK);
    }
    noh_file_unmap(&c.files[0]);
}

static void bad_descs_are_refused(void **state)
{
    sleeves s;
    noh_springs_desc d;
    cast c;
    (void)state;
    memset(&c, 0, sizeof c);
    cast_map(&c, PUPPETS, "demo/puppet_levels.noh");
    sleeves_describe(&s, &c.packs[0], SLEEVES);
    expect(&s.desc, NOH_OK);
    d = s.desc, d.metres = 0.0f;
    expect(&d, NOH_ERR_ARG);
    d = s.desc, d.row_count = 0;
    expect(&d, NOH_ERR_LIMIT);
    d = s.desc, d.chain_count = 1; /* a row in no chain */
    expect(&d, NOH_ERR_ARG);
    s.chains[1].collides = 4u;
    expect(&s.desc, NOH_ERR_ARG);
    s.chains[1].collides = 0u, s.rows[1].joint = s.rows[0].joint;
    expect(&s.desc, NOH_ERR_ARG);
    s.rows[1].joint = 0; /* has no parent */
    expect(&s.desc, NOH_ERR_ARG);
    s.rows[1].joint = joint_of(&c.packs[0], sleeve_names[1]), s.rows[1].drag = 1.5f;
    expect(&s.desc, NOH_ERR_ARG);
    s.rows[1].drag = 0.5f, s.capsules[0].radius = NAN;
    expect(&s.desc, NOH_ERR_ARG);
    s.capsules[0].radius = 0.1f, memset(s.chains[0].end, 0, sizeof s.chains[0].end);
    expect(&s.desc, NOH_ERR_ARG);
    noh_file_unmap(&c.files[0]);
}

/* ---- springs of the pack ---- */

static void open_swingers(cast *c, uint32_t actors, int without)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet.noh");
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    if (!without) c->kinds[0].springs = noh_springs_module(NULL);
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    cast_make(c, NULL);
}

static noh_actor enter(const cast *c, const noh_place *place, const char *clip)
{
    const noh_appearance look = { .pixels = 0.02f }; /* posed in every frame, however far */
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &look, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c->stage, actor, 0, clip, NULL, NULL), NOH_OK);
    return actor;
}

static void close_swingers(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
}

/* A joint's axes in the axes of the actor's root: [9]. */
static void axes_of(const cast *c, noh_actor actor, uint32_t joint, double out[9])
{
    float m[12], root[12];
    double length = 0.0;
    assert_int_equal(noh_actor_joint(c->stage, actor, joint, m, NULL), NOH_OK);
    assert_int_equal(noh_actor_joint(c->stage, actor, 0, root, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) length += (double)root[4 * i] * (double)root[4 * i];
    for (int k = 0; k < 9; k++) {
        out[k] = 0.0;
        for (int i = 0; i < 3; i++) out[k] += (double)root[4 * i + k / 3] * (double)m[4 * i + k % 3] / length;
    }
}

static double axes_apart(const double a[9], const double b[9])
{
    double worst = 0.0;
    for (int k = 0; k < 9; k++) worst = fmax(worst, fabs(a[k] - b[k]));
    return worst;
}

static void look_from(const cast *c, uint32_t ticks, float distance)
{
    noh_stage_view view = cast_view(0, distance);
    assert_int_equal(noh_stage_frame(c->stage, ticks, &view, NULL, NULL, NULL), NOH_OK);
}

/* Nothing but the pack says what swings. Without it the joint is where the clip has it. */
static void a_kind_swings_by_itself(void **state)
{
    static const noh_place origin = { { 0.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
    static const char *const names[] = { "sleeve.L", "sleeve.R", "skirt.L", "skirt.R" };
    double most[4] = { 0.0, 0.0, 0.0, 0.0 };
    noh_actor actors[2];
    cast c[2];
    (void)state;
    for (int without = 0; without < 2; without++) {
        open_swingers(&c[without], 1, without);
        actors[without] = enter(&c[without], &origin, "dance");
    }
    assert_true(c[0].plan.state_bytes > c[1].plan.state_bytes);
    assert_true(c[0].plan.hash != c[1].plan.hash);
    for (uint32_t f = 0; f < 300; f++) {
        for (int k = 0; k < 2; k++) look_from(&c[k], CAST_STEP, 5.0f);
        for (uint32_t n = 0; n < 4; n++) {
            const uint32_t joint = joint_of(&c[0].packs[0], names[n]);
            double with[9], plain[9];
            axes_of(&c[0], actors[0], joint, with);
            axes_of(&c[1], actors[1], joint, plain);
            most[n] = fmax(most[n], axes_apart(with, plain));
        }
    }
    print_message("# off the clip by at most %.2f, %.2f (sleeves), %.2f, %.2f (skirt) of a unit axis\n", most[0],
                  most[1], most[2], most[3]);
    for (uint32_t n = 0; n < 4; n++) assert_true(most[n] > 0.05 && most[n] < 1.5);
    for (int k = 0; k < 2; k++) close_swingers(&c[k]);
}

/* From 3 to 90 m and back: in no frame a sleeve turns by much more than for an observer that stays near; far away
 * nothing swings. */
static void far_away_they_fade_without_a_pop(void **state)
{
    static const noh_place origin = { { 0.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
    double most[2] = { 0.0, 0.0 }, far_off = 0.0;
    uint32_t joint;
    (void)state;
    for (int goes = 0; goes < 2; goes++) {
        double before[9], now[9];
        noh_actor actor;
        cast c, plain;
        noh_actor twin;
        open_swingers(&c, 1, 0);
        open_swingers(&plain, 1, 1);
        actor = enter(&c, &origin, "walk");
        twin = enter(&plain, &origin, "walk");
        joint = joint_of(&c.packs[0], "skirt.L");
        for (uint32_t f = 0; f < 480; f++) {
            const float way = f < 240 ? (float)f / 240.0f : (float)(480 - f) / 240.0f;
            look_from(&c, CAST_STEP, goes ? 3.0f + 177.0f * way * way : 3.0f);
            axes_of(&c, actor, joint, now);
            if (f > 30) most[goes] = fmax(most[goes], axes_apart(now, before));
            memcpy(before, now, sizeof before);
            look_from(&plain, CAST_STEP, 3.0f);
            if (goes && f > 236 && f < 244) { /* at rest below the knee, as the clip has it */
                double rest[9];
                axes_of(&plain, twin, joint, rest);
                far_off = fmax(far_off, axes_apart(now, rest));
            }
        }
        close_swingers(&c);
        close_swingers(&plain);
    }
    print_message("# in a frame a hem turns by at most %.3f near by, %.3f as it goes away and comes back\n", most[0],
                  most[1]);
    assert_true(most[1] < 1.25 * most[0] && most[0] > 0.01);
    assert_true(far_off < 1e-3);
}

/* When time stands still nothing moves, to the bit; and the size of an actor changes nothing but its size. */
static void time_stops_and_sizes_differ(void **state)
{
    static const noh_place small = { { 0.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 1.0f },
                           large = { { 4.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 3.0f };
    noh_actor a, b;
    double worst = 0.0;
    uint32_t joint;
    cast c;
    (void)state;
    open_swingers(&c, 2, 0);
    a = enter(&c, &small, "bow");
    b = enter(&c, &large, "bow");
    joint = joint_of(&c.packs[0], "sleeve.L");
    for (uint32_t f = 0; f < 200; f++) {
        double own[9], other[9];
        look_from(&c, CAST_STEP, 5.0f);
        axes_of(&c, a, joint, own);
        axes_of(&c, b, joint, other);
        worst = fmax(worst, axes_apart(own, other));
    }
    print_message("# three times the size: off by %.2g of a unit axis\n", worst);
    assert_true(worst < 2e-3);
    for (uint32_t f = 0; f < 5; f++) {
        double before[9], now[9];
        axes_of(&c, a, joint, before);
        look_from(&c, 0, 5.0f);
        axes_of(&c, a, joint, now);
        assert_memory_equal(before, now, sizeof now);
    }
    close_swingers(&c);
}

/* A leap that the stage is informed of leaves the springs at rest, turned with their parents; any other, finite. */
static void leaps_are_told_or_survived(void **state)
{
    static const noh_place origin = { { 0.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f },
                           far_off = { { -3.0f, 0.0f, -3.0f }, { 0, 0, 0, 0 }, 1.0f };
    (void)state;
    for (int told = 0; told < 2; told++) {
        double own[9], parent[9];
        noh_skeleton skeleton;
        noh_actor actor;
        cast c;
        open_swingers(&c, 1, 0);
        actor = enter(&c, &origin, "walk");
        const uint32_t joint = joint_of(&c.packs[0], "sleeve.L");
        assert_int_equal(noh_pack_skeleton_at(&c.packs[0], 0, &skeleton, NULL, NULL), NOH_OK);
        for (uint32_t f = 0; f < 60; f++) look_from(&c, CAST_STEP, 5.0f);
        assert_int_equal(noh_actor_set_place(c.stage, actor, &far_off, NULL), NOH_OK);
        if (told) assert_int_equal(noh_actor_cut(c.stage, actor, NULL), NOH_OK);
        look_from(&c, CAST_STEP, 5.0f);
        axes_of(&c, actor, joint, own);
        axes_of(&c, actor, skeleton.parents[joint], parent);
        for (int k = 0; k < 9; k++) assert_true(fabs(own[k]) <= 1.001);
        assert_true(told == (axes_apart(own, parent) < 1e-4));
        close_swingers(&c);
    }
}

/* A state that another stage takes over goes on with the same bits. */
static void a_fork_goes_on(void **state)
{
    static const noh_place origin = { { 0.0f, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
    size_t bytes;
    cast c[2];
    (void)state;
    for (int k = 0; k < 2; k++) open_swingers(&c[k], 2, 0);
    (void)enter(&c[0], &origin, "dance");
    (void)enter(&c[0], &origin, "walk");
    for (uint32_t f = 0; f < 50; f++) look_from(&c[0], CAST_STEP, 5.0f);
    const void *now = noh_stage_state(c[0].stage, &bytes);
    assert_int_equal(noh_stage_set_state(c[1].stage, now, bytes, NULL), NOH_OK);
    for (uint32_t f = 0; f < 50; f++) {
        for (int k = 0; k < 2; k++) look_from(&c[k], CAST_STEP, 5.0f);
        assert_true(noh_stage_hash(c[0].stage) == noh_stage_hash(c[1].stage));
    }
    for (int k = 0; k < 2; k++) close_swingers(&c[k]);
}

/* At any rate of frames sleeves are where they are at 60 Hz, except for the arms' way between two poses. Frames longer
 * than an eighth of a second once restarted all of them. */
static void seldom_frames_swing_alike(void **state)
{
    static const uint32_t rates[] = { 60, 12, 7, 5, 3, 2 };
    static float at_60[6][3];
    (void)state;
    for (size_t r = 0; r < TEST_COUNT(rates); r++) {
        float from[3], to[3], worst = 0.0f;
        sleeves s;
        cast c;
        open_dancers(&c, &s, 1, 1, 0);
        const noh_actor actor = noh_stage_actor_at(c.stage, 0);
        for (uint32_t f = 1; f <= 6 * rates[r]; f++) {
            const noh_stage_view view = cast_view(0, 5.0f);
            const uint32_t ticks = (uint32_t)(NOH_TICKS_PER_SECOND * f / rates[r]) -
                                   (uint32_t)(NOH_TICKS_PER_SECOND * (f - 1u) / rates[r]);
            assert_int_equal(noh_stage_frame(c.stage, ticks, &view, NULL, NULL, NULL), NOH_OK);
            if (f % rates[r]) continue;
            float *was = at_60[f / rates[r] - 1u], square = 0.0f;
            bone_of(&c, &s, actor, 0, from, to);
            for (int k = 0; k < 3; k++) {
                const float along = to[k] - from[k];
                if (!r) was[k] = along;
                square += (along - was[k]) * (along - was[k]);
            }
            worst = square > worst ? square : worst;
        }
        print_message("%u Hz: off 60 Hz by %.1f mm\n", (unsigned)rates[r], 1000.0 * sqrt((double)worst));
        assert_true(worst < 0.01f * 0.01f);
        close_dancers(&c, &s);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sleeves_swing_in_a_dance),
        cmocka_unit_test(seldom_frames_swing_alike),
        cmocka_unit_test(sleeves_stay_out_of_colliders),
        cmocka_unit_test(swinging_states_are_put_back),
        cmocka_unit_test(bad_descs_are_refused),
        cmocka_unit_test(bad_colliders_are_refused),
        cmocka_unit_test(a_kind_swings_by_itself),
        cmocka_unit_test(far_away_they_fade_without_a_pop),
        cmocka_unit_test(time_stops_and_sizes_differ),
        cmocka_unit_test(leaps_are_told_or_survived),
        cmocka_unit_test(a_fork_goes_on),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
