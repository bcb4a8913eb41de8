/* Garments on a stage: joints of the wearer's names have its matrices, bit by bit, at any rate of updates, between steps
 * and for any number of jobs; the others swing; they are put on, swapped, taken off, saved and forked; meshes of an
 * actor are off and on. */
#include "support/stage_fixture.h"

#include "support/pack_walk.h"

#include "stage/cast/stage_internal.h"

#include <math.h>

enum { BODIES, COATS, KINDS };
#define ACTORS 4u

static noh_error said;

static void wardrobe_open(cast *c, uint32_t jobs)
{
    memset(c, 0, sizeof *c);
    cast_map(c, BODIES, "demo/puppet_levels.noh");
    cast_map(c, COATS, "demo/coat.noh");
    for (uint32_t i = 0; i < KINDS; i++) {
        c->kinds[i].mesh = &c->packs[i];
        c->kinds[i].actor_count = ACTORS;
    }
    c->kinds[BODIES].root_axes = NOH_ROOT_GROUND;
    c->kinds[COATS].worn_by = 1u << BODIES;
    c->kinds[COATS].springs = noh_springs_module(NULL);
    c->desc.kinds = c->kinds;
    c->desc.kind_count = KINDS;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
}

static void wardrobe_close(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
    noh_file_unmap(&c->files[1]);
}

/* Puppets that dance, the odd ones in coats. */
static void enter(cast *c, noh_actor bodies[ACTORS], noh_actor coats[ACTORS])
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { { 1.2f * (float)i - 2.0f, 0.0f, -1.5f * (float)i }, { 0, 0, 0, 0 }, 1.0f };
        assert_int_equal(noh_stage_spawn(c->stage, BODIES, &place, &bodies[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c->stage, bodies[i], 0, i % 2u ? "walk" : "dance", NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_spawn(c->stage, COATS, NULL, &coats[i], NULL), NOH_OK);
    }
}

static void wear(const cast *c, noh_actor coat, noh_actor body)
{
    if (noh_actor_wear(c->stage, coat, body, &said) != NOH_OK) fail_msg("%s", said.what);
}

/* The joints of a coat that its wearer has, too: all of them as the wearer has them. Returns how many. */
static uint32_t expect_worn(const cast *c, noh_actor coat, noh_actor body)
{
    uint32_t count = 0;
    const char *name;
    for (uint32_t j = 0; (name = noh_stage_name(c->stage, COATS, NOH_NAME_JOINT, j)) != NULL; j++) {
        const uint32_t on = noh_stage_find(c->stage, BODIES, NOH_NAME_JOINT, name);
        float own[12], of_body[12];
        if (on == NOH_NONE) continue;
        assert_int_equal(noh_actor_joint(c->stage, coat, j, own, &said), NOH_OK);
        assert_int_equal(noh_actor_joint(c->stage, body, on, of_body, &said), NOH_OK);
        assert_memory_equal(own, of_body, sizeof own);
        count++;
    }
    return count;
}

static void frame(const cast *c, uint32_t number, float distance, float alpha)
{
    noh_stage_view view = cast_view(number, distance);
    if (alpha >= 1.0f || number % 2u == 0)
        assert_int_equal(noh_stage_step(c->stage, alpha < 1.0f ? 2u * CAST_STEP : CAST_STEP, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_between(c->stage, &view, 1, number % 2u ? alpha : 0.5f * (alpha + 1.0f), &said),
                     NOH_OK);
    assert_int_equal(noh_stage_frame_end(c->stage, &said), NOH_OK);
}

static void a_coat_follows_its_wearer(void **state)
{
    static const float distances[] = { 4.0f, 12.0f, 60.0f, 250.0f };
    noh_actor bodies[ACTORS], coats[ACTORS];
    uint32_t rarely = 0;
    cast c;
    (void)state;
    for (uint32_t way = 0; way < 2; way++) {
        wardrobe_open(&c, 3);
        enter(&c, bodies, coats);
        for (uint32_t i = 0; i < ACTORS; i++) wear(&c, coats[i], bodies[i]);
        for (uint32_t f = 0; f < 240; f++) {
            frame(&c, f, distances[f / 60u], way ? 0.5f : 1.0f);
            rarely += noh_stage_stats_of(c.stage)->updated < noh_stage_stats_of(c.stage)->seen;
            for (uint32_t i = 0; i < ACTORS; i++) assert_true(expect_worn(&c, coats[i], bodies[i]) >= 10u);
            if (f % 50u == 20u) { /* they swap coats in a frame */
                const noh_actor first = coats[0];
                for (uint32_t i = 0; i < ACTORS; i++) coats[i] = i + 1u < ACTORS ? coats[i + 1u] : first;
                for (uint32_t i = 0; i < ACTORS; i++) wear(&c, coats[i], bodies[i]);
            }
        }
        wardrobe_close(&c);
    }
    assert_true(rarely > 20u);
}

/* The tail stays below the hips, however far the wearer goes, and does not follow them rigidly. */
static void its_own_joints_swing(void **state)
{
    noh_actor bodies[ACTORS], coats[ACTORS];
    float before[12] = { 0 }, most = 0.0f;
    uint32_t tail, hips;
    cast c;
    (void)state;
    wardrobe_open(&c, 1);
    enter(&c, bodies, coats);
    wear(&c, coats[0], bodies[0]);
    tail = noh_stage_find(c.stage, COATS, NOH_NAME_JOINT, "tail.2");
    hips = noh_stage_find(c.stage, COATS, NOH_NAME_JOINT, "hips");
    assert_int_not_equal(tail, NOH_NONE);
    for (uint32_t f = 0; f < 300; f++) {
        float at[12], on[12], local[3];
        frame(&c, f, 4.0f, 1.0f);
        assert_int_equal(noh_actor_joint(c.stage, coats[0], tail, at, NULL), NOH_OK);
        assert_int_equal(noh_actor_joint(c.stage, coats[0], hips, on, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) { /* in the space of the hips */
            local[i] = 0.0f;
            for (int k = 0; k < 3; k++) local[i] += on[4 * k + i] * (at[4 * k + 3] - on[4 * k + 3]);
            if (f > 10) most = fmaxf(most, fabsf(local[i] - before[i]));
            if (f <= 10) before[i] = local[i];
        }
        assert_true(hypotf(hypotf(local[0], local[1]), local[2]) < 0.4f);
        assert_true(at[7] < on[7]);
    }
    assert_true(most > 0.01f);
    wardrobe_close(&c);
}

/* The coat has a head without a neck: what is on it stays where it was modelled, on the wearer's head. */
static void joints_may_be_missing(void **state)
{
    noh_actor bodies[ACTORS], coats[ACTORS];
    noh_skeleton skeleton;
    uint32_t tassel, head;
    cast c;
    (void)state;
    wardrobe_open(&c, 1);
    enter(&c, bodies, coats);
    wear(&c, coats[0], bodies[0]);
    tassel = noh_stage_find(c.stage, COATS, NOH_NAME_JOINT, "tassel");
    head = noh_stage_find(c.stage, BODIES, NOH_NAME_JOINT, "head");
    assert_int_equal(noh_stage_find(c.stage, COATS, NOH_NAME_JOINT, "neck"), NOH_NONE);
    assert_int_equal(noh_pack_skeleton_at(&c.packs[COATS], 0, &skeleton, NULL, NULL), NOH_OK);
    for (uint32_t f = 0; f < 100; f++) {
        float at[12], on[12];
        frame(&c, f, 4.0f, 1.0f);
        assert_int_equal(noh_actor_joint(c.stage, coats[0], tassel, at, NULL), NOH_OK);
        assert_int_equal(noh_actor_joint(c.stage, bodies[0], head, on, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) {
            float want = on[4 * i + 3];
            for (int k = 0; k < 3; k++) want += on[4 * i + k] * skeleton.bind_pose[tassel].translation[k];
            assert_true(fabsf(at[4 * i + 3] - want) < 1e-4f);
        }
    }
    wardrobe_close(&c);
}

/* For any number of jobs; in a fork that begins in the middle; and a bad state is refused. */
static void bits_are_the_same(void **state)
{
    uint64_t hashes[3];
    (void)state;
    for (uint32_t run = 0; run < 3; run++) {
        noh_actor bodies[ACTORS], coats[ACTORS];
        uint8_t *copy = NULL;
        size_t bytes;
        cast c;
        wardrobe_open(&c, run == 1 ? 4 : 1);
        enter(&c, bodies, coats);
        wear(&c, coats[1], bodies[0]);
        wear(&c, coats[2], bodies[0]);
        for (uint32_t f = 0; f < 90; f++) {
            if (f == 40) wear(&c, coats[0], bodies[3]);
            if (f == 45 && run == 2) {
                copy = test_aligned(NULL, c.plan.state_bytes);
                memcpy(copy, noh_stage_state(c.stage, &bytes), c.plan.state_bytes);
            }
            frame(&c, f, 25.0f, 1.0f);
        }
        if (copy) {
            assert_int_equal(noh_stage_set_state(c.stage, copy, bytes, &said), NOH_OK);
            for (uint32_t f = 45; f < 90; f++) frame(&c, f, 25.0f, 1.0f);
            assert_int_equal(expect_worn(&c, coats[0], bodies[3]), expect_worn(&c, coats[1], bodies[0]));
        }
        hashes[run] = noh_stage_hash(c.stage);
        if (copy) { /* a body that is worn by a coat */
            noh_stage_actor *a = noh_stage_actor_of(c.stage, bodies[1], NULL);
            noh_stage_actor *in_copy = (void *)(copy + ((uint8_t *)a - c.stage->state));
            in_copy->parent = coats[0].id;
            in_copy->joint = NOH_STAGE_WORN;
            assert_int_equal(noh_stage_set_state(c.stage, copy, bytes, &said), NOH_ERR_DATA);
        }
        free(copy);
        wardrobe_close(&c);
    }
    assert_true(hashes[0] == hashes[1] && hashes[0] == hashes[2]);
}

static void it_is_taken_off(void **state)
{
    const noh_actor nobody = { 0 };
    const noh_appearance hidden = { .hidden = 1 }, plain = { 0 };
    noh_actor bodies[ACTORS], coats[ACTORS];
    float before[12], after[12];
    cast c;
    (void)state;
    wardrobe_open(&c, 1);
    enter(&c, bodies, coats);
    wear(&c, coats[0], bodies[1]);
    for (uint32_t f = 0; f < 60; f++) frame(&c, f, 6.0f, 1.0f);
    assert_int_equal(noh_actor_set_appearance(c.stage, bodies[1], &hidden, NULL), NOH_OK);
    frame(&c, 60, 6.0f, 1.0f);
    assert_null(noh_actor_floats(c.stage, coats[0])); /* a hidden wearer hides it */
    assert_int_equal(noh_actor_set_appearance(c.stage, bodies[1], &plain, NULL), NOH_OK);
    frame(&c, 61, 6.0f, 1.0f);
    (void)expect_worn(&c, coats[0], bodies[1]);
    assert_int_equal(noh_actor_joint(c.stage, coats[0], 0, before, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(c.stage, coats[0], nobody, 0, &said), NOH_OK);
    for (uint32_t f = 62; f < 90; f++) frame(&c, f, 6.0f, 1.0f);
    assert_int_equal(noh_actor_joint(c.stage, coats[0], 0, after, NULL), NOH_OK);
    assert_true(hypotf(after[3] - before[3], after[11] - before[11]) < 0.05f); /* it stays; the puppet walks on */
    wear(&c, coats[0], bodies[2]);
    frame(&c, 90, 6.0f, 1.0f);
    assert_int_equal(noh_stage_despawn(c.stage, bodies[2], NULL), NOH_OK);
    frame(&c, 91, 6.0f, 1.0f);
    assert_int_equal(noh_actor_joint(c.stage, coats[0], 0, after, NULL), NOH_OK);
    wardrobe_close(&c);
}

/* More are in view than may be drawn: coats are drawn on those that are. */
static void coats_of_left_out_wearers_are_left_out(void **state)
{
    (void)state;
    for (uint32_t worn = 0; worn < 2; worn++) { /* or held in a hand */
        noh_actor bodies[ACTORS], coats[ACTORS];
        uint32_t coats_seen = 0;
        cast c;
        wardrobe_open(&c, 1);
        cast_close_stage(&c);
        c.kinds[BODIES].visible_max = 2;
        cast_make(&c, NULL);
        enter(&c, bodies, coats);
        for (uint32_t i = 0; i < ACTORS; i++) {
            if (worn) wear(&c, coats[i], bodies[i]);
            if (!worn) assert_int_equal(noh_actor_attach(c.stage, coats[i], bodies[i], 0, &said), NOH_OK);
        }
        for (uint32_t f = 0; f < 60; f++) frame(&c, f, 8.0f, 1.0f);
        assert_int_equal(noh_stage_stats_of(c.stage)->left_out, ACTORS - 2u);
        for (uint32_t i = 0; i < ACTORS; i++) {
            const noh_stage_shown *shown = c.stage->shown;
            const uint32_t body = bodies[i].id & 0xffffu, coat = coats[i].id & 0xffffu;
            assert_int_equal(shown[coat].views, shown[body].views);
            coats_seen += shown[coat].views != 0;
        }
        assert_int_equal(coats_seen, 2);
        assert_int_equal(noh_stage_stats_of(c.stage)->seen, 4);
        wardrobe_close(&c);
    }
}

static void what_does_not_fit_is_refused(void **state)
{
    noh_actor bodies[ACTORS], coats[ACTORS];
    noh_stage_plan plan;
    cast c;
    (void)state;
    wardrobe_open(&c, 1);
    enter(&c, bodies, coats);
    assert_int_equal(noh_actor_wear(c.stage, bodies[0], coats[0], &said), NOH_ERR_ARG);
    assert_int_equal(noh_actor_wear(c.stage, coats[0], coats[1], &said), NOH_ERR_ARG);
    assert_int_equal(noh_actor_wear(c.stage, coats[0], (noh_actor){ 0 }, &said), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_stage_despawn(c.stage, bodies[3], NULL), NOH_OK);
    assert_int_equal(noh_actor_wear(c.stage, coats[0], bodies[3], &said), NOH_ERR_NOT_FOUND);
    c.kinds[COATS].worn_by = 1u << COATS; /* by its own kind */
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &plan, &said), NOH_ERR_ARG);
    c.kinds[COATS].worn_by = 1u << KINDS;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &plan, &said), NOH_ERR_ARG);
    wardrobe_close(&c);
}

/* Each mesh has a bit; what is off is not picked. */
static void meshes_are_off_and_on(void **state)
{
    const noh_stage_view view = cast_view(0, 6.0f);
    float sphere[4];
    noh_actor body;
    cast c;
    (void)state;
    wardrobe_open(&c, 1);
    assert_int_equal(noh_stage_spawn(c.stage, BODIES, NULL, &body, NULL), NOH_OK);
    assert_int_equal(noh_stage_find(c.stage, BODIES, NOH_NAME_MESH, "nothing"), NOH_NONE);
    assert_null(noh_stage_name(c.stage, BODIES, NOH_NAME_MESH, c.plan.kinds[BODIES].mesh_count));
    for (uint32_t hidden = 0; hidden < 3; hidden++) {
        const uint32_t mesh = noh_stage_find(c.stage, BODIES, NOH_NAME_MESH, "body");
        const noh_appearance look = { .hidden_meshes = hidden == 1 ? 1u << mesh : 0 };
        float origin[3], direction[3] = { 0.0f, 0.0f, -1.0f };
        noh_stage_hit hit;
        assert_true(mesh < c.plan.kinds[BODIES].mesh_count);
        assert_int_equal(noh_actor_set_appearance(c.stage, body, &look, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_sphere(c.stage, body, sphere, NULL), NOH_OK);
        origin[0] = 0.0f, origin[1] = 1.1f, origin[2] = 5.0f;
        assert_int_equal(noh_stage_pick(c.stage, origin, direction, 100.0f, &hit, NULL),
                         hidden == 1 ? NOH_ERR_NOT_FOUND : NOH_OK);
    }
    wardrobe_close(&c);
}

/* What the coat hides is known for the mesh that it was built over, and for no other; lies about it are refused. */
static void lies_about_what_it_hides_are_refused(void **state)
{
    static const char *const what[] = { "count of a cover", "count of a cover", "more or fewer bits",
                                        "name and its hash", "reserved field" };
    cast c;
    noh_mesh mesh;
    uint32_t found = 0;
    (void)state;
    memset(&c, 0, sizeof c);
    cast_map(&c, BODIES, "demo/puppet_levels.noh");
    cast_map(&c, COATS, "demo/coat.noh");
    for (uint32_t i = 0; noh_pack_mesh_at(&c.packs[BODIES], i, &mesh, NULL) == NOH_OK; i++) {
        noh_mesh other = mesh;
        if (!noh_stage_cover_of(&c.packs[COATS], &mesh)) continue;
        other.name = "other";
        assert_null(noh_stage_cover_of(&c.packs[COATS], &other));
        found++;
    }
    assert_int_equal(found, 1);
    for (uint32_t lie = 0; lie < TEST_COUNT(what); lie++) {
        uint8_t *bytes = test_aligned(c.files[COATS].data, c.files[COATS].bytes);
        const noh_pack_cover_header *own = noh_pack_chunk_at(&c.packs[COATS], NOH_CHUNK_COVER, 0);
        noh_pack_cover_header *h = (void *)(bytes + ((const uint8_t *)own - c.packs[COATS].bytes));
        noh_pack pack;
        if (lie == 0) h->triangle_count = 0;
        if (lie == 1) h->hidden_count = h->triangle_count + 1u;
        if (lie == 2) h->hidden_count++;
        if (lie == 3) h->mesh_hash++;
        if (lie == 4) h->reserved[1] = 1;
        pack_repair(bytes, c.files[COATS].bytes);
        assert_int_equal(noh_pack_open(bytes, c.files[COATS].bytes, &pack, &said), NOH_ERR_DATA);
        if (!strstr(said.what, what[lie])) fail_msg("lie %u: %s", lie, said.what);
        free(bytes);
    }
    noh_file_unmap(&c.files[0]);
    noh_file_unmap(&c.files[1]);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_coat_follows_its_wearer),
        cmocka_unit_test(its_own_joints_swing),
        cmocka_unit_test(joints_may_be_missing),
        cmocka_unit_test(bits_are_the_same),
        cmocka_unit_test(it_is_taken_off),
        cmocka_unit_test(what_does_not_fit_is_refused),
        cmocka_unit_test(coats_of_left_out_wearers_are_left_out),
        cmocka_unit_test(meshes_are_off_and_on),
        cmocka_unit_test(lies_about_what_it_hides_are_refused),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
