/* Springs on a stage: the sleeves of puppets swing, stay out of what they collide with, have the same bits for any
 * number of jobs, and are saved and put back. */
#include <math.h>

#include "support/stage_fixture.h"

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
    noh_stage_part part;
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
        s->rows[i] = (noh_spring_row){ joint, 0.5f, 0.2f, 0.01f, 1.0f };
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
    s->part = noh_springs_part(s->springs);
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
    c->kinds[0].root_up = 1;
    c->kinds[0].parts = &s->part;
    c->kinds[0].part_count = 1;
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
    const uint8_t *live = noh_actor_part(c->stage, noh_stage_actor_at(c->stage, 1), 0);
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

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sleeves_swing_in_a_dance),
        cmocka_unit_test(sleeves_stay_out_of_colliders),
        cmocka_unit_test(swinging_states_are_put_back),
        cmocka_unit_test(bad_descs_are_refused),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
