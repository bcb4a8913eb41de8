/* A stage without a GPU: plans, actors, layers, events, frames, jobs, states. */
#include "support/clip_bank_fixture.h"
#include "support/stage_fixture.h"

#include <math.h>
#include "motion/anim/root_motion_internal.h"
#include "noh/low_motion.h"

static noh_error said;

static void step(noh_stage *s, uint32_t ticks)
{
    assert_int_equal(noh_stage_step(s, ticks, NULL, NULL, NULL), NOH_OK);
}

static void frame(noh_stage *s, uint32_t number, float distance)
{
    const noh_stage_view view = cast_view(number, distance);
    assert_int_equal(noh_stage_frame(s, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

/* ---- plans ---- */

static void the_parts_of_a_plan_sum_to_its_bytes(void **state)
{
    noh_stage_bytes parts[64];
    uint64_t cpu = 0, gpu = 0;
    uint32_t count;
    cast c;
    (void)state;
    cast_open(&c);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    count = noh_stage_plan_parts(&c.desc, NULL, &c.plan, parts, 64);
    assert_true(count > 8 && count < 64);
    for (uint32_t i = 0; i < count; i++) cpu += parts[i].cpu_bytes, gpu += parts[i].gpu_bytes;
    assert_true(cpu == c.plan.cpu_bytes && gpu == 0 && c.plan.gpu_bytes == 0);
    assert_int_equal(noh_stage_plan_parts(&c.desc, NULL, &c.plan, parts, 2), count);
    cast_close(&c);
}

static void plans_do_not_depend_on_when_they_are_made(void **state)
{
    static noh_stage_plan other;
    cast c;
    (void)state;
    cast_open(&c);
    memset(&other, 0x5a, sizeof other);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &other, NULL), NOH_OK);
    assert_memory_equal(&c.plan, &other, sizeof other);
    cast_close(&c);
}

/* The levels of an actor are of rising error and falling triangles, each mesh no finer than in the level before. */
static void actor_levels_rise_in_error(void **state)
{
    cast c;
    (void)state;
    cast_open(&c);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    for (uint32_t k = 0; k < CAST_KINDS; k++) {
        const noh_kind_plan *p = &c.plan.kinds[k];
        uint32_t slots = 0;
        assert_true(p->level_count >= 1 && p->level_count <= NOH_LOD_LEVELS_MAX);
        for (uint32_t l = 0; l < p->level_count; l++) {
            slots += p->levels[l].slot_count;
            if (!l) continue;
            assert_true(p->levels[l].error_m > p->levels[l - 1u].error_m);
            assert_true(p->levels[l].triangle_count < p->levels[l - 1u].triangle_count);
            for (uint32_t m = 0; m < p->mesh_count; m++) {
                assert_true(p->levels[l].mesh_levels[m] >= p->levels[l - 1u].mesh_levels[m]);
            }
        }
        assert_int_equal(slots, c.kinds[k].actor_count);
    }
    assert_true(c.plan.kinds[PUPPETS].level_count > 3); /* of two meshes with levels of their own */
    assert_true(c.plan.kinds[MASKS].level_count > 2 && c.plan.kinds[TUBES].level_count > 1);
    cast_close(&c);
}

/* Down to the smallest stage every bound is kept, and its cost is reported; below it is MEMORY, with the need. */
static void a_bound_is_kept_or_refused(void **state)
{
    uint64_t largest, least = 0;
    cast c;
    (void)state;
    cast_open(&c);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    largest = c.plan.cpu_bytes;
    assert_int_equal(c.plan.concession_count, 0);
    c.desc.cpu_bytes_max = 1;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_MEMORY);
    least = said.need;
    assert_true(least > 1 && least < largest);
    for (uint64_t bound = least; bound < largest; bound += (largest - least) / 7u + 1u) {
        c.desc.cpu_bytes_max = bound;
        assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_OK);
        assert_true(c.plan.cpu_bytes <= bound && c.plan.concession_count > 0);
        cast_close_stage(&c);
        cast_make(&c, NULL);
        frame(c.stage, 0, 6.0f);
    }
    c.desc.cpu_bytes_max = least - 1u;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_MEMORY);
    cast_close(&c);
}

/* Three kinds of the same clips have one bank: its cached segments are the same number in all of them. */
static void kinds_that_share_clips_tell_the_same_cached_segments(void **state)
{
    cast c;
    (void)state;
    cast_open(&c);
    c.kinds[1] = c.kinds[2] = c.kinds[PUPPETS];
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_OK);
    c.desc.cpu_bytes_max = c.plan.cpu_bytes - 1u;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_OK);
    assert_true(c.plan.kinds[0].cached_segment_count < c.plan.kinds[0].segment_count);
    assert_int_equal(c.plan.kinds[1].cached_segment_count, c.plan.kinds[0].cached_segment_count);
    assert_int_equal(c.plan.kinds[2].cached_segment_count, c.plan.kinds[0].cached_segment_count);
    cast_close(&c);
}

static void bad_plan(cast *c, noh_result result, const char *what)
{
    assert_int_equal(noh_stage_plan_make(&c->desc, NULL, &c->plan, &said), result);
    if (!strstr(said.what, what)) fail_msg("\"%s\" does not name %s", said.what, what);
}

static void desc_fields_broken_in_turn(void **state)
{
    noh_layer_desc layers[2] = { { .name = "body" }, { .name = "arm", .joints = "no_such_joint" } };
    noh_kind_desc fine[CAST_KINDS];
    noh_stage *made;
    cast c;
    (void)state;
    cast_open(&c);
    memcpy(fine, c.kinds, sizeof fine);
    c.desc.kind_count = 0, bad_plan(&c, NOH_ERR_ARG, "kind_count"), c.desc.kind_count = CAST_KINDS;
    c.desc.job_count = 65, bad_plan(&c, NOH_ERR_ARG, "job_count"), c.desc.job_count = 0;
    c.desc.lod.pixels = -1.0f, bad_plan(&c, NOH_ERR_ARG, "pixels"), c.desc.lod.pixels = 0.0f;
    c.kinds[1].mesh = NULL, bad_plan(&c, NOH_ERR_ARG, "mesh"), c.kinds[1] = fine[1];
    assert_int_equal(said.where, 1);
    c.kinds[1].mesh = &(noh_pack){ 0 }, bad_plan(&c, NOH_ERR_ARG, "noh_pack_open"), c.kinds[1] = fine[1];
    c.kinds[2].actor_count = 0, bad_plan(&c, NOH_ERR_ARG, "actor_count"), c.kinds[2] = fine[2];
    c.kinds[0].actor_count = 65535, bad_plan(&c, NOH_ERR_LIMIT, "actors"), c.kinds[0] = fine[0];
    c.kinds[0].skeleton = 7, bad_plan(&c, NOH_ERR_ARG, "skeleton"), c.kinds[0] = fine[0];
    c.kinds[0].root_axes = 64, bad_plan(&c, NOH_ERR_ARG, "root_axes"), c.kinds[0] = fine[0];
    c.kinds[0].face = noh_graph_module("*"), bad_plan(&c, NOH_ERR_ARG, "module of another field"), c.kinds[0] = fine[0];
    c.kinds[0].layer_count = 17, bad_plan(&c, NOH_ERR_ARG, "layer_count"), c.kinds[0] = fine[0];
    layers[0].name = NULL, c.kinds[0].layers = layers, c.kinds[0].layer_count = 2, bad_plan(&c, NOH_ERR_ARG, "name");
    layers[0].name = "body", layers[0].track_count = 9, bad_plan(&c, NOH_ERR_ARG, "track_count");
    layers[0].track_count = 0;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK); /* names are read at init */
    c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes, NULL, &c.desc, &c.plan, &made, &said),
                     NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "joints of a layer"));
    assert_true(said.where == (uint64_t)1 << 32 && said.need == 0); /* of kind 0 */
    cast_close(&c);
}

/* One byte less is MEMORY and touches nothing; misaligned memory is ARG (tests/memory/test_inits.c has the rest). */
static void a_byte_less_is_refused(void **state)
{
    noh_stage *made = NULL;
    uint8_t *memory;
    cast c;
    (void)state;
    cast_open(&c);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
    memset(memory, 0xa5, (size_t)c.plan.cpu_bytes);
    assert_int_equal(noh_stage_init(memory, (size_t)c.plan.cpu_bytes - 1u, NULL, &c.desc, &c.plan, &made, &said),
                     NOH_ERR_MEMORY);
    assert_int_equal(said.need, c.plan.cpu_bytes);
    for (size_t i = 0; i < c.plan.cpu_bytes; i++) assert_int_equal(memory[i], 0xa5);
    assert_null(made);
    free(memory);
    cast_close(&c);
}

/* ---- actors ---- */

static void a_stale_actor_is_an_error(void **state)
{
    noh_actor first, again;
    noh_place place;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    assert_int_equal(noh_stage_spawn(c.stage, MASKS, NULL, &first, NULL), NOH_OK);
    assert_int_equal(noh_stage_despawn(c.stage, first, NULL), NOH_OK);
    assert_int_equal(noh_stage_despawn(c.stage, first, &said), NOH_ERR_NOT_FOUND);
    for (uint32_t i = 0; i < 70000; i++) { /* past the end of a generation */
        assert_int_equal(noh_stage_spawn(c.stage, MASKS, NULL, &again, NULL), NOH_OK);
        assert_true(again.id != 0);
        if (i < 65535u * 7u - 1u) assert_true(again.id != first.id);
        assert_int_equal(noh_actor_place(c.stage, again, &place, NULL), NOH_OK);
        assert_int_equal(noh_stage_despawn(c.stage, again, NULL), NOH_OK);
    }
    assert_int_equal(noh_actor_play(c.stage, first, 0, "speak", NULL, &said), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_actor_set_place(c.stage, (noh_actor){ 0 }, &place, &said), NOH_ERR_NOT_FOUND);
    assert_null(noh_actor_floats(c.stage, first));
    cast_close(&c);
}

/* What an actor did leaves no byte in the state once it is despawned. */
static void a_despawned_actor_leaves_nothing(void **state)
{
    uint64_t hashes[2];
    (void)state;
    for (int plays = 0; plays < 2; plays++) {
        noh_actor actor;
        cast c;
        cast_open(&c);
        cast_make(&c, NULL);
        assert_int_equal(noh_stage_spawn(c.stage, MASKS, NULL, &actor, NULL), NOH_OK);
        if (plays) assert_int_equal(noh_actor_play(c.stage, actor, 0, "speak", NULL, NULL), NOH_OK);
        for (int i = 0; i < 10; i++) assert_int_equal(noh_stage_step(c.stage, CAST_STEP, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_OK);
        hashes[plays] = noh_stage_hash(c.stage);
        cast_close(&c);
    }
    assert_true(hashes[0] == hashes[1]);
}

static void a_full_kind_refuses_to_spawn(void **state)
{
    noh_actor actors[CAST_ACTORS], more;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    cast_enter(&c, actors);
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, NULL, &more, &said), NOH_ERR_LIMIT);
    assert_int_equal(said.need, 5);
    for (uint32_t i = 0; i < CAST_ACTORS; i++) assert_int_equal(noh_stage_actor_at(c.stage, i).id, actors[i].id);
    assert_int_equal(noh_stage_actor_at(c.stage, CAST_ACTORS).id, 0);
    cast_close(&c);
}

static void bad_places_are_refused(void **state)
{
    const noh_place bad[] = { { { NAN, 0, 0 }, { 0, 0, 0, 1 }, 1 },
                              { { 0, 0, 0 }, { 0, 0, INFINITY, 1 }, 1 },
                              { { 0, 0, 0 }, { 0, 1e-9f, 0, 0 }, 1 },
                              { { 0, 0, 0 }, { 0, 0, 0, 1 }, -1 } };
    noh_actor actor;
    noh_place was, is;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    assert_int_equal(noh_stage_spawn(c.stage, TUBES, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_place(c.stage, actor, &was, NULL), NOH_OK);
    for (uint32_t i = 0; i < TEST_COUNT(bad); i++) {
        assert_int_equal(noh_actor_set_place(c.stage, actor, &bad[i], &said), NOH_ERR_ARG);
    }
    assert_int_equal(noh_actor_place(c.stage, actor, &is, NULL), NOH_OK);
    assert_memory_equal(&was, &is, sizeof is);
    cast_close(&c);
}

/* ---- what shows ---- */

static void names_are_found(void **state)
{
    cast c;
    uint32_t smile;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    smile = noh_stage_find(c.stage, PUPPETS, NOH_NAME_FLOAT, "smile");
    assert_true(smile != NOH_NONE);
    assert_string_equal(noh_stage_name(c.stage, PUPPETS, NOH_NAME_FLOAT, smile), "smile");
    assert_int_equal(noh_stage_find(c.stage, PUPPETS, NOH_NAME_LAYER, "face"), 1);
    assert_true(noh_stage_find(c.stage, PUPPETS, NOH_NAME_CLIP, "walk") != NOH_NONE);
    assert_int_equal(noh_stage_find(c.stage, PUPPETS, NOH_NAME_CLIP, "wlak"), NOH_NONE);
    assert_int_equal(noh_stage_find(c.stage, MASKS, NOH_NAME_JOINT, "head"), NOH_NONE);
    for (uint32_t j = 0; j < c.plan.kinds[PUPPETS].joint_count; j++) {
        const char *name = noh_stage_name(c.stage, PUPPETS, NOH_NAME_JOINT, j);
        assert_int_equal(noh_stage_find(c.stage, PUPPETS, NOH_NAME_JOINT, name), j);
    }
    assert_null(noh_stage_name(c.stage, PUPPETS, NOH_NAME_JOINT, c.plan.kinds[PUPPETS].joint_count));
    cast_close(&c);
}

/* A layer without joints moves none, and fades its floats in and out; a held float shows whatever plays. */
static void a_face_is_played_over_a_body(void **state)
{
    noh_actor actor;
    noh_appearance look = { .posed = 1 };
    const noh_play at_once = { .fade_ticks = 1 };
    float before[12], after[12];
    uint32_t hand, smile;
    int moved = 0;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    hand = noh_stage_find(c.stage, PUPPETS, NOH_NAME_JOINT, noh_stage_name(c.stage, PUPPETS, NOH_NAME_JOINT, 20));
    smile = noh_stage_find(c.stage, PUPPETS, NOH_NAME_FLOAT, "smile");
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c.stage, actor, &look, NULL), NOH_OK);
    for (int i = 0; i < 2; i++) { /* it shows in each frame, though no time passes */
        assert_int_equal(noh_stage_frame(c.stage, 0, NULL, NULL, NULL, NULL), NOH_OK);
        assert_non_null(noh_actor_floats(c.stage, actor));
    }
    assert_int_equal(noh_actor_joint(c.stage, actor, hand, before, NULL), NOH_OK);
    for (uint32_t i = 0; noh_stage_name(c.stage, PUPPETS, NOH_NAME_CLIP, i); i++) { /* no clip moves it on the face */
        assert_int_equal(
            noh_actor_play(c.stage, actor, 1, noh_stage_name(c.stage, PUPPETS, NOH_NAME_CLIP, i), &at_once, NULL),
            NOH_OK);
        for (int f = 0; f < 30; f++) {
            const float *floats;
            assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
            floats = noh_actor_floats(c.stage, actor);
            for (uint32_t w = 0; w < c.plan.kinds[PUPPETS].float_count; w++) moved |= floats[w] > 0.05f;
        }
        assert_int_equal(noh_actor_joint(c.stage, actor, hand, after, NULL), NOH_OK);
        assert_memory_equal(before, after, sizeof after);
    }
    assert_true(moved);
    assert_int_equal(noh_actor_stop(c.stage, actor, 1, 4800, NULL), NOH_OK);
    for (int f = 0; f < 8; f++) assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    assert_null(noh_actor_track(c.stage, actor, 1));
    assert_true(fabsf(noh_actor_floats(c.stage, actor)[smile]) < 1e-6f);
    assert_int_equal(noh_actor_hold_float(c.stage, actor, smile, 0.75f, 1.0f, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    assert_true(fabsf(noh_actor_floats(c.stage, actor)[smile] - 0.75f) < 1e-6f);
    for (uint32_t i = 0; i < 7; i++) {
        assert_int_equal(noh_actor_hold_float(c.stage, actor, smile + 1u + i, 0.5f, 0.5f, NULL), NOH_OK);
    }
    assert_int_equal(noh_actor_hold_float(c.stage, actor, smile + 9u, 0.5f, 0.5f, &said), NOH_ERR_LIMIT);
    assert_int_equal(noh_actor_hold_float(c.stage, actor, smile, 0.0f, 0.0f, NULL), NOH_OK);
    assert_int_equal(noh_actor_hold_float(c.stage, actor, smile + 9u, 0.5f, 0.5f, NULL), NOH_OK);
    cast_close(&c);
}

/* The pose of a played clip equals the pose of a controller joined by hand, and root motion is where it takes the
 * actor. */
static void a_walk_takes_the_actor_along(void **state)
{
    noh_clip_bank_desc desc;
    noh_clip_bank *bank;
    noh_root_pose all = { { 0, 0, 0 }, 0, 0 }, moved;
    noh_actor actor;
    noh_place place;
    double end;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    memset(&desc, 0, sizeof desc);
    desc.clips = &c.packs[PUPPETS];
    desc.root_axes = NOH_ROOT_GROUND;
    desc.root_up = 1;
    bank = test_clip_bank(&desc);
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    for (int f = 0; f < 120; f++) {
        step(c.stage, CAST_STEP);
        assert_int_equal(noh_actor_root(c.stage, actor, &moved, NULL), NOH_OK);
        all = noh_root_compose(1, &all, &moved);
    }
    {
        const uint32_t walk = noh_clip_bank_find(bank, "walk");
        const noh_root_pose want = noh_root_between(&bank->clips, &bank->clips.roots[walk], walk, NOH_LOOP_REPEAT, 0,
                                                    noh_position_of(120 * CAST_STEP));
        assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
        end = want.translation[2];
        assert_true(end > 0.5); /* it has walked */
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(all.translation[i] - want.translation[i]) < 1e-9);
            assert_true(fabs((double)place.position[i] - want.translation[i]) < 1e-4);
        }
    }
    free(bank);
    cast_close(&c);
}

static uint64_t bytes_of_puppets(cast *c, uint32_t first_enough, uint32_t second_enough)
{
    c->kinds[0].sample_rate_needed = first_enough;
    c->kinds[1].sample_rate_needed = second_enough;
    assert_int_equal(noh_stage_plan_make(&c->desc, NULL, &c->plan, &said), NOH_OK);
    return c->plan.cpu_bytes;
}

/* Two kinds of one pack's clips, which have 30 frames a second: where half of them are enough for both, less is cached;
 * for one of them alone, each kind has clips of its own. The walk leads to the same place, except for what it is off
 * between the frames that are left. */
static void half_of_the_frames_may_be_enough(void **state)
{
    noh_actor actors[2];
    noh_place places[2];
    uint64_t whole, halved, both;
    cast c;
    (void)state;
    cast_open(&c);
    c.kinds[1] = c.kinds[PUPPETS];
    c.kinds[0] = c.kinds[PUPPETS];
    c.desc.kind_count = 2;
    whole = bytes_of_puppets(&c, 0, 0);
    halved = bytes_of_puppets(&c, 15, 15);
    both = bytes_of_puppets(&c, 0, 15);
    assert_true(halved < whole && whole < both);
    cast_make(&c, NULL);
    for (uint32_t k = 0; k < 2u; k++) {
        assert_int_equal(noh_stage_spawn(c.stage, k, NULL, &actors[k], NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c.stage, actors[k], 0, "walk", NULL, NULL), NOH_OK);
    }
    for (int f = 0; f < 120; f++) step(c.stage, CAST_STEP);
    for (uint32_t k = 0; k < 2u; k++) {
        assert_int_equal(noh_actor_place(c.stage, actors[k], &places[k], NULL), NOH_OK);
        assert_true(places[k].position[2] > 0.5f);
    }
    for (int i = 0; i < 3; i++) assert_true(fabsf(places[0].position[i] - places[1].position[i]) < 0.01f);
    cast_close(&c);
}

/* Every joint of a puppet in the world: out[joint_count][12]. */
static void take_joints(const cast *c, noh_actor actor, float *out)
{
    for (uint32_t j = 0; j < c->plan.kinds[PUPPETS].joint_count; j++) {
        assert_int_equal(noh_actor_joint(c->stage, actor, j, out + 12u * j, NULL), NOH_OK);
    }
}

/* By inertia no joint leaps, while the new clip plays from the first tick; a cut leaps. */
static void inertia_takes_over_without_a_leap(void **state)
{
    const noh_play leap = { .fade_ticks = 12000, .flags = NOH_PLAY_INERTIA }, cut = { .fade_ticks = 1 };
    const noh_appearance look = { .posed = 1 };
    float before[64 * 12], after[64 * 12], steps[3] = { 0, 0, 0 };
    noh_actor actor;
    cast c;
    (void)state;
    cast_open(&c);
    c.kinds[PUPPETS].inertia = 1;
    cast_make(&c, NULL);
    for (int way = 0; way < 3; way++) { /* in between, by inertia, by a cut */
        assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, NULL, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c.stage, actor, &look, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c.stage, actor, 0, "dance", NULL, NULL), NOH_OK);
        for (int f = 0; f < 45; f++) {
            assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        }
        take_joints(&c, actor, before);
        if (way) assert_int_equal(noh_actor_play(c.stage, actor, 0, "bow", way == 1 ? &leap : &cut, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        take_joints(&c, actor, after);
        for (uint32_t j = 0; j < c.plan.kinds[PUPPETS].joint_count; j++) {
            float square = 0.0f;
            for (uint32_t i = 12u * j + 3u; i < 12u * j + 12u; i += 4u) {
                square += (after[i] - before[i]) * (after[i] - before[i]);
            }
            if (sqrtf(square) > steps[way]) steps[way] = sqrtf(square);
        }
    }
    if (!(steps[1] < 2.0f * steps[0] + 0.005f && steps[2] > 5.0f * steps[1])) {
        fail_msg("%g in between, %g by inertia, %g by a cut", (double)steps[0], (double)steps[1], (double)steps[2]);
    }
    assert_int_equal(noh_stage_spawn(c.stage, MASKS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, actor, 1, "speak", &leap, &said), NOH_ERR_ARG);
    cast_close(&c);
}

/* Clips played together play on; their weights are the tracks' weights; a layer without a free track refuses. */
/* How far joints leap when a clip of another name begins. */
static float leap_at_a_change(const noh_play *play)
{
    const noh_appearance look = { .posed = 1 };
    float before[64 * 12], after[64 * 12], most = 0.0f;
    noh_actor actor;
    cast k;
    cast_open(&k);
    k.kinds[PUPPETS].root_axes = 0;
    cast_make(&k, NULL);
    assert_int_equal(noh_stage_spawn(k.stage, PUPPETS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(k.stage, actor, &look, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(k.stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(k.stage, 30 * CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    take_joints(&k, actor, before);
    assert_int_equal(noh_actor_play(k.stage, actor, 0, "bow", play, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(k.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    take_joints(&k, actor, after);
    for (uint32_t j = 0; j < k.plan.kinds[PUPPETS].joint_count; j++) {
        for (uint32_t r = 3; r < 12; r += 4) most = fmaxf(most, fabsf(after[12 * j + r] - before[12 * j + r]));
    }
    cast_close(&k);
    return most;
}

/* The source sets another clip on the track that plays: the pose leaps. Ours fades, if the game asks for nothing. */
static void another_clip_does_not_leap(void **state)
{
    const noh_play at_once = { .fade_ticks = 1 };
    (void)state;
    const float faded = leap_at_a_change(NULL), leapt = leap_at_a_change(&at_once);
    assert_true(leapt > 0.02f);
    assert_true(faded < 0.25f * leapt);
}

static void clips_play_beside_each_other(void **state)
{
    static const char *const clips[] = { "walk", "dance", "bow" };
    const noh_play beside = { .fade_ticks = 1, .flags = NOH_PLAY_BESIDE };
    const noh_play wrong = { .flags = NOH_PLAY_BESIDE | NOH_PLAY_INERTIA };
    const noh_appearance look = { .posed = 1 };
    float alone[64 * 12], mixed[64 * 12];
    const noh_clip_set *set;
    noh_actor actor;
    noh_controller *c;
    cast k;
    (void)state;
    cast_open(&k);
    k.kinds[PUPPETS].inertia = 1;
    k.kinds[PUPPETS].root_axes = 0; /* what is compared is the pose */
    cast_make(&k, NULL);
    assert_int_equal(noh_stage_spawn(k.stage, PUPPETS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(k.stage, actor, &look, NULL), NOH_OK);
    c = noh_actor_controller(k.stage, actor, &set);
    for (uint32_t i = 0; i < 2; i++) {
        const noh_track *track;
        assert_int_equal(noh_actor_play(k.stage, actor, 0, clips[i], &beside, NULL), NOH_OK);
        track = noh_actor_track(k.stage, actor, 0);
        assert_ptr_equal(track, noh_controller_track(c, i));
        assert_true(track->weight > 0.99f);
        assert_int_equal(noh_stage_frame(k.stage, 20 * CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        take_joints(&k, actor, i ? mixed : alone);
    }
    assert_int_equal(noh_controller_track(c, 0)->mode, NOH_TRACK_ON);
    assert_true(noh_controller_track(c, 0)->weight > 0.99f); /* not faded */
    assert_int_equal(noh_actor_play(k.stage, actor, 0, clips[2], &beside, &said), NOH_ERR_LIMIT);
    assert_int_equal(said.need, 3);
    assert_int_equal(noh_actor_play(k.stage, actor, 0, clips[2], &wrong, &said), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_weight(c, 1, 0.0f), NOH_OK);
    assert_int_equal(noh_controller_seek(c, set, 0, 19 * CAST_STEP, NOH_SEEK_SKIP, NULL), NOH_OK);
    assert_true(memcmp(alone, mixed, sizeof(float) * 12u * k.plan.kinds[PUPPETS].joint_count) != 0);
    assert_int_equal(noh_stage_frame(k.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    take_joints(&k, actor, mixed);
    for (uint32_t j = 0; j < k.plan.kinds[PUPPETS].joint_count; j++) { /* the walk alone again, as of then */
        for (uint32_t r = 0; r < 3; r++) {
            for (uint32_t i = 0; i < 3; i++) {
                assert_true(fabsf(alone[12 * j + 4 * r + i] - mixed[12 * j + 4 * r + i]) < 1e-4f);
            }
        }
    }
    cast_close(&k);
}

/* ---- callback keys ---- */

typedef struct heard {
    noh_actor other;
    uint32_t count;
    noh_result refused;
} heard;

static void on_key(void *user, noh_stage *stage, const noh_stage_event *event)
{
    heard *h = user;
    const noh_place far_away = { { 9, 9, 9 }, { 0, 0, 0, 0 }, 0 };
    h->count++;
    assert_true(event->name && event->name[0]);
    h->refused = noh_actor_set_place(stage, h->other, &far_away, NULL);
    assert_int_equal(noh_actor_set_place(stage, event->actor, &far_away, NULL), NOH_OK);
    assert_int_equal(noh_stage_step(stage, 1, NULL, NULL, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_stage_despawn(stage, event->actor, NULL), NOH_ERR_ARG);
}

static void keys_are_told_with_their_names(void **state)
{
    noh_actor actor;
    heard h = { { 0 }, 0, NOH_OK };
    uint32_t told = 0, most = 0;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, NULL, &h.other, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    for (int f = 0; f < 120; f++) {
        uint32_t count;
        const noh_stage_event *events;
        assert_int_equal(noh_stage_step(c.stage, CAST_STEP, on_key, &h, NULL), NOH_OK);
        events = noh_stage_events(c.stage, &count);
        for (uint32_t i = 0; i < count; i++) {
            assert_int_equal(events[i].actor.id, actor.id);
            assert_int_equal(events[i].layer, 0);
            assert_true(events[i].clock > f * (int64_t)CAST_STEP - 1 &&
                        events[i].clock <= (f + 1) * (int64_t)CAST_STEP);
        }
        told += count;
        if (count > most) most = count;
        assert_int_equal(noh_stage_stats_of(c.stage)->events_high, most);
    }
    assert_true(told > 2 && told == h.count);
    assert_int_equal(h.refused, NOH_ERR_ARG);
    cast_close(&c);
}

/* ---- frames ---- */

static void frames_and_steps_do_not_mix(void **state)
{
    const noh_stage_view view = cast_view(0, 8.0f);
    noh_actor actor;
    size_t bytes;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    assert_int_equal(noh_stage_spawn(c.stage, MASKS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_end(c.stage, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_stage_frame_begin(c.stage, &view, 1, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_begin(c.stage, &view, 1, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_stage_step(c.stage, 1, NULL, NULL, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_actor_play(c.stage, actor, 1, "speak", NULL, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_stage_set_state(c.stage, noh_stage_state(c.stage, &bytes), c.plan.state_bytes, NULL),
                     NOH_ERR_ARG);
    assert_int_equal(noh_stage_frame_end(c.stage, NULL), NOH_OK);
    assert_int_equal(noh_stage_jobs(c.stage), 0);
    cast_close(&c);
}

/* The largest counts of all frames, however few there are later. */
static void the_largest_counts_are_kept(void **state)
{
    noh_actor actors[CAST_ACTORS];
    const noh_stage_stats *stats;
    uint32_t coarser = 0;
    cast c;
    (void)state;
    cast_open(&c);
    c.kinds[PUPPETS].near_count = 1;
    cast_make(&c, NULL);
    stats = noh_stage_stats_of(c.stage);
    cast_enter(&c, actors);
    for (uint32_t f = 0; f < 20; f++) {
        const noh_stage_view view = cast_view(f, f < 10 ? 2.0f : 60.0f);
        if (f == 10) {
            for (uint32_t i = 0; i < CAST_ACTORS; i++)
                assert_int_equal(noh_stage_despawn(c.stage, actors[i], NULL), NOH_OK);
        }
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        if (stats->coarser > coarser) coarser = stats->coarser;
        assert_int_equal(stats->coarser_high, coarser);
        assert_int_equal(stats->actors_high, CAST_ACTORS);
    }
    assert_true(stats->actors == 0 && stats->coarser == 0 && coarser > 0);
    cast_close(&c);
}

static void who_is_behind_the_camera_is_not_posed(void **state)
{
    noh_actor actors[CAST_ACTORS];
    noh_stage_view view = cast_view(0, 8.0f);
    static const float away[3] = { 0.0f, 0.8f, 40.0f };
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    cast_enter(&c, actors);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_stats_of(c.stage)->seen, CAST_ACTORS);
    noh_view_orbit(&view, away, 3.14159f, 0.0f, 8.0f, 640, 360); /* in front of them, looking away */
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_stats_of(c.stage)->seen, 0);
    assert_int_equal(noh_stage_stats_of(c.stage)->updated, 0);
    assert_null(noh_actor_floats(c.stage, actors[0]));
    cast_close(&c);
}

/* Every vertex of a dancing puppet is within the sphere that it is culled by; by the CPU's skin. */
static void spheres_hold_every_vertex(void **state)
{
    noh_actor actor;
    const noh_appearance look = { .posed = 1 };
    float joints[64 * 12], matrices[64 * 12];
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    assert_true(c.plan.kinds[PUPPETS].joint_count <= 64);
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c.stage, actor, &look, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "dance", NULL, NULL), NOH_OK);
    for (int f = 0; f < 60; f++) {
        float sphere[4];
        assert_int_equal(noh_stage_frame(c.stage, 3u * CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_sphere(c.stage, actor, sphere, NULL), NOH_OK);
        for (uint32_t j = 0; j < c.plan.kinds[PUPPETS].joint_count; j++) {
            assert_int_equal(noh_actor_joint(c.stage, actor, j, joints + 12 * j, NULL), NOH_OK);
        }
        for (uint32_t m = 0; m < c.packs[PUPPETS].runs[NOH_CHUNK_MESH].count; m++) {
            const noh_mesh mesh = test_mesh(&c.packs[PUPPETS], m);
            noh_skin skin;
            assert_int_equal(noh_pack_skin_at(&c.packs[PUPPETS], mesh.header->skin, &skin, NULL), NOH_OK);
            noh_skin_matrices(&skin, joints, matrices);
            for (uint32_t v = 0; v < mesh.header->vertex_count; v += 7) {
                float at[3];
                double apart = 0.0;
                noh_skin_position(&mesh, matrices, NULL, v, at);
                for (int i = 0; i < 3; i++)
                    apart += ((double)at[i] - (double)sphere[i]) * ((double)at[i] - (double)sphere[i]);
                assert_true(sqrt(apart) <= (double)sphere[3] * 1.00001);
            }
        }
    }
    cast_close(&c);
}

/* The largest distance of a skinned vertex from the middle of a sphere, over its radius. */
static double farthest(const cast *c, const noh_pack *pack, noh_actor actor, const float sphere[4])
{
    static float joints[256 * 12], matrices[256 * 12];
    double worst = 0.0;
    for (uint32_t j = 0; j < c->plan.kinds[0].joint_count; j++) {
        assert_int_equal(noh_actor_joint(c->stage, actor, j, joints + 12u * j, NULL), NOH_OK);
    }
    for (uint32_t m = 0; m < pack->runs[NOH_CHUNK_MESH].count; m++) {
        const noh_mesh mesh = test_mesh(pack, m);
        noh_skin skin;
        if (noh_pack_skin_at(pack, mesh.header->skin, &skin, NULL) != NOH_OK) continue;
        noh_skin_matrices(&skin, joints, matrices);
        for (uint32_t v = 0; v < mesh.header->vertex_count; v += 11) {
            float at[3];
            double apart = 0.0;
            noh_skin_position(&mesh, matrices, NULL, v, at);
            for (int i = 0; i < 3; i++) apart += pow((double)at[i] - (double)sphere[i], 2.0);
            worst = fmax(worst, sqrt(apart) / (double)sphere[3]);
        }
    }
    return worst;
}

/* The sphere by which an actor is culled before it was ever posed holds it in all its clips, and is not far too large:
 * of figures whose joints have scales, roots that travel, and other units. */
static void whoever_was_never_posed_is_culled_by_where_clips_may_take_it(void **state)
{
    static const char *const names[] = { "khronos/RobotExpressive.glb", "khronos/Fox.glb", "hero/body.glb" };
    convert_options o;
    (void)state;
    memset(&o, 0, sizeof o);
    o.clip.clip.effort = 1; /* what clips take does not matter here */
    for (uint32_t n = 0; n < TEST_COUNT(names) - (test_is_sanitized() ? 1u : 0u); n++) { /* the body has most clips */
        const char *input = test_asset(names[n]);
        const noh_appearance look = { .posed = 1 };
        double worst = 0.0;
        uint8_t *bytes;
        size_t count;
        noh_actor actor;
        float reach[4];
        cast c;
        memset(&c, 0, sizeof c);
        bytes = clip_pack(&input, 1, &o, &count);
        c.packs[0] = test_open(bytes, count);
        c.kinds[0].mesh = &c.packs[0];
        c.kinds[0].actor_count = 1;
        c.desc.kinds = c.kinds;
        c.desc.kind_count = 1;
        cast_make(&c, NULL);
        assert_int_equal(noh_stage_spawn(c.stage, 0, NULL, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_sphere(c.stage, actor, reach, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c.stage, actor, &look, NULL), NOH_OK);
        for (uint32_t i = 0; noh_stage_name(c.stage, 0, NOH_NAME_CLIP, i); i++) {
            assert_int_equal(
                noh_actor_play(c.stage, actor, 0, noh_stage_name(c.stage, 0, NOH_NAME_CLIP, i), NULL, NULL), NOH_OK);
            for (int f = 0; f < 12; f++) {
                assert_int_equal(noh_stage_frame(c.stage, 5u * CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
                worst = fmax(worst, farthest(&c, &c.packs[0], actor, reach));
            }
        }
        if (!(worst <= 1.0 && worst > 0.2)) fail_msg("%s: up to %g of the sphere's radius", names[n], worst);
        cast_close_stage(&c);
        free(bytes);
    }
}

/* ---- jobs and states ---- */

/* A show of many frames with everything that changes; returns the hash after each. */
static void show(cast *c, uint64_t seed, uint32_t frames, int shuffled, uint64_t *hashes)
{
    static const char *const clips[CAST_KINDS][3] = { { "walk", "run", "dance" },
                                                      { "speak", "blink", "speak" },
                                                      { "none", "none", "none" } };
    test_random r = { seed };
    for (uint32_t f = 0; f < frames; f++) {
        const noh_stage_view view = cast_view(f, 4.0f + 20.0f * (float)(f % 90u) / 90.0f);
        const uint32_t which = test_random_below(&r, CAST_ACTORS), what = test_random_below(&r, 8);
        const noh_actor actor = noh_stage_actor_at(c->stage, which);
        uint32_t count, kind = which < 5 ? PUPPETS : which < 12 ? MASKS : TUBES;
        if (what == 0 && actor.id) assert_int_equal(noh_stage_despawn(c->stage, actor, NULL), NOH_OK);
        if (what == 1) {
            noh_actor made;
            (void)noh_stage_spawn(c->stage, kind, NULL, &made, NULL);
        }
        if (what == 2 && actor.id) {
            (void)noh_actor_play(c->stage, actor, test_random_below(&r, 3), clips[kind][test_random_below(&r, 3)], NULL,
                                 NULL);
        }
        if (what == 3 && actor.id)
            (void)noh_actor_hold_float(c->stage, actor, 0, test_random_float(&r, 0, 1), 1.0f, NULL);
        if (what == 4 && actor.id) (void)noh_actor_stop(c->stage, actor, 0, 0, NULL);
        if (what == 5 && actor.id) {
            const noh_place place = { { test_random_float(&r, -4, 4), 0, test_random_float(&r, -4, 4) }, { 0 }, 1.2f };
            assert_int_equal(noh_actor_set_place(c->stage, actor, &place, NULL), NOH_OK);
            if (f % 4u == 0) assert_int_equal(noh_actor_cut(c->stage, actor, NULL), NOH_OK);
        }
        if (f % 3u) step(c->stage, 400u + test_random_below(&r, 900));
        assert_int_equal(noh_stage_frame_between(c->stage, &view, 1, f % 5u ? 0.3f * (float)(f % 4u) : 1.0f, NULL),
                         NOH_OK);
        while ((count = noh_stage_jobs(c->stage)) > 0) {
            for (uint32_t i = 0; i < count; i++) noh_stage_job(c->stage, shuffled ? count - 1u - i : i);
        }
        assert_int_equal(noh_stage_frame_end(c->stage, NULL), NOH_OK);
        if (hashes) hashes[f] = noh_stage_hash(c->stage);
    }
}

#define SHOW 240u

static void the_bits_do_not_depend_on_the_jobs(void **state)
{
    static uint64_t hashes[3][SHOW];
    static const uint32_t jobs[3] = { 1, 4, 7 };
    noh_actor actors[CAST_ACTORS];
    (void)state;
    for (int i = 0; i < 3; i++) {
        cast c;
        cast_open(&c);
        c.desc.job_count = jobs[i];
        cast_make(&c, NULL);
        cast_enter(&c, actors);
        show(&c, 77, SHOW, i == 2, hashes[i]);
        cast_close(&c);
    }
    assert_memory_equal(hashes[0], hashes[1], sizeof hashes[0]);
    assert_memory_equal(hashes[0], hashes[2], sizeof hashes[0]);
}

/* What followed a state follows it again, in the same stage and in another one of the plan. */
static void a_state_is_put_back_to_the_bit(void **state)
{
    static uint64_t first[SHOW], again[SHOW];
    noh_actor actors[CAST_ACTORS];
    uint8_t *saved;
    size_t bytes;
    cast c, fork;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    cast_enter(&c, actors);
    show(&c, 5, 100, 0, NULL);
    saved = test_aligned(noh_stage_state(c.stage, &bytes), c.plan.state_bytes);
    assert_int_equal(bytes, c.plan.state_bytes);
    show(&c, 6, SHOW, 0, first);
    assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, NULL), NOH_OK);
    show(&c, 6, SHOW, 0, again);
    assert_memory_equal(first, again, sizeof first);
    cast_open(&fork);
    fork.desc.job_count = 3;
    cast_make(&fork, NULL);
    assert_int_equal(noh_stage_set_state(fork.stage, saved, bytes, NULL), NOH_OK);
    show(&fork, 6, SHOW, 0, again);
    assert_memory_equal(first, again, sizeof first);
    free(saved);
    cast_close(&fork);
    cast_close(&c);
}

/* A state with any byte changed is refused, or plays on without harm (under the sanitizers, too). */
static void a_damaged_state_does_no_harm(void **state)
{
    test_random r = test_random_from(9);
    noh_actor actors[CAST_ACTORS];
    uint8_t *good, *bad;
    uint32_t refused = 0, accepted = 0;
    size_t bytes;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    cast_enter(&c, actors);
    show(&c, 5, 40, 0, NULL);
    good = test_aligned(noh_stage_state(c.stage, &bytes), c.plan.state_bytes);
    bad = test_aligned(good, bytes);
    assert_int_equal(noh_stage_set_state(c.stage, good, bytes - 1u, &said), NOH_ERR_DATA);
    for (uint32_t i = 0; i < 3000; i++) {
        const uint32_t head = i % 2u ? 288u + 160u * CAST_ACTORS : (uint32_t)bytes; /* heads and actors more often */
        const uint32_t at = test_random_below(&r, head);
        bad[at] ^= (uint8_t)(1u << test_random_below(&r, 8));
        if (noh_stage_set_state(c.stage, bad, bytes, &said) == NOH_OK) {
            accepted++;
            if (accepted % 16u == 0) frame(c.stage, i, 9.0f);
        } else {
            refused++;
        }
        bad[at] = good[at];
    }
    assert_true(refused > 100 && accepted > 100);
    free(good);
    free(bad);
    cast_close(&c);
}

/* ---- links and rays ---- */

static void what_hangs_on_a_joint_goes_with_it(void **state)
{
    noh_actor puppet, mask;
    const noh_appearance look = { .posed = 1 };
    const noh_place up = { { 0.0f, 0.25f, 0.0f }, { 0, 0, 0, 0 }, 0.5f };
    float joint[12], sphere[4];
    noh_stage_view view = cast_view(0, 9.0f);
    noh_place place;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, NULL, &puppet, NULL), NOH_OK);
    assert_int_equal(noh_stage_spawn(c.stage, MASKS, &up, &mask, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c.stage, puppet, &look, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(c.stage, mask, puppet, 20, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(c.stage, puppet, mask, 0, &said), NOH_ERR_NOT_FOUND); /* a mask has no joints */
    assert_int_equal(noh_actor_attach(c.stage, mask, puppet, 4000, &said), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_actor_play(c.stage, puppet, 0, "dance", NULL, NULL), NOH_OK);
    for (int f = 0; f < 30; f++) assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_joint(c.stage, puppet, 20, joint, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(c.stage, mask, (noh_actor){ 0 }, 0, NULL), NOH_OK); /* it stays where it was */
    assert_int_equal(noh_actor_place(c.stage, mask, &place, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) {
        const float want = joint[4 * i + 1] * 0.25f + joint[4 * i + 3];
        assert_true(fabsf(place.position[i] - want) < 1e-5f);
    }
    assert_true(fabsf(place.scale - 0.5f) < 1e-4f);
    assert_int_equal(noh_actor_sphere(c.stage, mask, sphere, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(c.stage, mask, puppet, 20, NULL), NOH_OK);
    assert_int_equal(noh_stage_despawn(c.stage, puppet, NULL), NOH_OK); /* lets go */
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_sphere(c.stage, mask, sphere, NULL), NOH_OK);
    cast_close(&c);
}

static void attach(const cast *c, noh_actor actor, noh_actor parent)
{
    if (noh_actor_attach(c->stage, actor, parent, 20, &said) != NOH_OK) fail_msg("%s", said.what);
}

static void joint_of(const cast *c, noh_actor actor, float joint[12])
{
    assert_int_equal(noh_actor_joint(c->stage, actor, 20, joint, NULL), NOH_OK);
}

/* Each on a joint of the one before: circles and too many are refused, in any order of attaching; one that goes leaves
 * what was attached to it where it was, with all that is attached to that; a state with a circle is refused. */
static void attachments_on_attachments(void **state)
{
    const noh_place up = { { 0.0f, 0.25f, 0.1f }, { 0, 0, 0.6f, 0.8f }, 0.75f };
    const noh_appearance posed = { .posed = 1 };
    const uint32_t most = NOH_ATTACH_DEPTH_MAX + 1u;
    noh_actor a[NOH_ATTACH_DEPTH_MAX + 3u];
    float before[2][12], after[12], local[12], last[12];
    noh_stage_view view = cast_view(0, 9.0f);
    size_t bytes;
    cast c;
    (void)state;
    cast_open(&c);
    c.kinds[PUPPETS].actor_count = most + 2u;
    cast_make(&c, NULL);
    for (uint32_t i = 0; i < most + 2u; i++) {
        assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, i ? &up : NULL, &a[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c.stage, a[i], &posed, NULL), NOH_OK);
        if (!i) assert_int_equal(noh_actor_play(c.stage, a[i], 0, "dance", NULL, NULL), NOH_OK);
    }
    for (uint32_t i = most - 1u; i > 0; i--) attach(&c, a[i], a[i - 1u]); /* from the end on */
    assert_int_equal(noh_actor_attach(c.stage, a[most], a[most - 1u], 20, &said), NOH_ERR_LIMIT);
    assert_int_equal(said.need, most);
    assert_int_equal(noh_actor_attach(c.stage, a[0], a[most], 20, &said), NOH_ERR_LIMIT);
    assert_int_equal(noh_actor_attach(c.stage, a[0], a[0], 20, &said), NOH_ERR_ARG);
    assert_int_equal(noh_actor_attach(c.stage, a[0], a[5], 20, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "attached to itself"));
    for (int f = 0; f < 10; f++) assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    joint_of(&c, a[1], last); /* the matrices of one that rests: what one puts on the next */
    for (uint32_t i = 2; i < most; i++) {
        float want[12], parent[12], first[12];
        joint_of(&c, a[i - 1u], parent);
        joint_of(&c, a[i], after);
        if (i == 2) memcpy(first, parent, sizeof first);
        for (int r = 0; r < 3; r++) { /* where the place's origin is carried to */
            want[r] = parent[4 * r] * up.position[0] + parent[4 * r + 1] * up.position[1] +
                      parent[4 * r + 2] * up.position[2] + parent[4 * r + 3];
        }
        noh_place at;
        joint_of(&c, a[i], local);
        assert_int_equal(noh_actor_attach(c.stage, a[i], (noh_actor){ 0 }, 0, NULL), NOH_OK);
        assert_int_equal(noh_actor_place(c.stage, a[i], &at, NULL), NOH_OK);
        for (int r = 0; r < 3; r++) assert_true(fabsf(at.position[r] - want[r]) < 1e-4f);
        assert_true(fabsf(at.scale - powf(0.75f, (float)i)) < 1e-4f);
        assert_int_equal(noh_actor_set_place(c.stage, a[i], &up, NULL), NOH_OK);
        attach(&c, a[i], a[i - 1u]);
        joint_of(&c, a[i], after);
        for (int k = 0; k < 12; k++) assert_true(fabsf(after[k] - local[k]) < 1e-4f);
    }
    joint_of(&c, a[2], before[0]);
    joint_of(&c, a[5], before[1]);
    assert_int_equal(noh_stage_despawn(c.stage, a[1], NULL), NOH_OK);
    joint_of(&c, a[2], after);
    for (int k = 0; k < 12; k++) assert_true(fabsf(after[k] - before[0][k]) < 1e-4f);
    joint_of(&c, a[5], after);
    for (int k = 0; k < 12; k++) assert_true(fabsf(after[k] - before[1][k]) < 1e-4f);
    const void *kept = noh_stage_state(c.stage, &bytes);
    uint8_t *copy = malloc(bytes);
    memcpy(copy, kept, bytes);
    assert_int_equal(noh_stage_set_state(c.stage, copy, bytes, &said), NOH_OK);
    for (size_t i = 0; i + 4 <= bytes; i += 4) { /* the parent of the first of the chain: the last of it */
        uint32_t word;
        memcpy(&word, copy + i, 4);
        if (word != a[2].id) continue;
        memcpy(copy + i, &a[3].id, 4);
        break;
    }
    assert_int_equal(noh_stage_set_state(c.stage, copy, bytes, &said), NOH_ERR_DATA);
    free(copy);
    cast_close(&c);
}

/* What carries something that a view sees is posed, seen itself or not; hidden, it hides what it carries. */
static void a_carrier_out_of_view_is_posed(void **state)
{
    const noh_place far = { { 0.0f, 0.0f, 30.0f }, { 0, 0, 0, 0 }, 1.0f };
    const noh_appearance hidden = { .hidden = 1 }, plain = { 0 };
    float before[12], after[12], sphere[4];
    const noh_play bows = { .fade_ticks = 1, .start_ticks = 24000 };
    noh_actor actors[3];
    uint32_t head;
    noh_stage_view view;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    head = noh_stage_find(c.stage, PUPPETS, NOH_NAME_JOINT, "head");
    for (int i = 0; i < 3; i++)
        assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, i ? &far : NULL, &actors[i], NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, actors[0], 0, "bow", &bows, NULL), NOH_OK);
    attach(&c, actors[1], actors[0]);
    attach(&c, actors[2], actors[1]);
    for (int f = 0; f < 40; f++) { /* close to the last one, whichever way it is swung */
        assert_int_equal(noh_actor_sphere(c.stage, actors[2], sphere, NULL), NOH_OK);
        noh_view_orbit(&view, sphere, 1.5707963f, 0.0f, 5.0f, 640, 360);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_true(noh_stage_stats_of(c.stage)->seen < 3);
        if (f == 5) assert_int_equal(noh_actor_joint(c.stage, actors[0], head, before, NULL), NOH_OK);
    }
    assert_int_equal(noh_actor_joint(c.stage, actors[0], head, after, NULL), NOH_OK);
    assert_true(hypotf(hypotf(after[3] - before[3], after[7] - before[7]), after[11] - before[11]) > 0.01f);
    assert_int_equal(noh_actor_set_appearance(c.stage, actors[0], &hidden, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_stats_of(c.stage)->seen, 0);
    assert_int_equal(noh_actor_set_appearance(c.stage, actors[0], &plain, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    assert_true(noh_stage_stats_of(c.stage)->seen > 0);
    cast_close(&c);
}

static void a_ray_meets_the_nearest_actor(void **state)
{
    noh_actor actors[CAST_ACTORS];
    const noh_stage_view view = cast_view(0, 8.0f);
    float sphere[4], direction[3];
    noh_stage_hit hit;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    cast_enter(&c, actors);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    for (uint32_t i = 0; i < 5; i++) { /* the first row stands in front of the others */
        const float origin[3] = { 1.2f * (float)i - 4.0f, 0.9f, 30.0f };
        assert_int_equal(noh_actor_sphere(c.stage, actors[i], sphere, NULL), NOH_OK);
        direction[0] = 0.0f, direction[1] = 0.0f, direction[2] = -2.0f;
        assert_int_equal(noh_stage_pick(c.stage, origin, direction, 100.0f, &hit, NULL), NOH_OK);
        assert_int_equal(hit.actor.id, actors[i].id);
        assert_true(fabsf(hit.point[2] - (30.0f - 2.0f * hit.distance)) < 1e-4f && fabsf(hit.point[2]) < 1.0f);
        assert_true(hit.joint < c.plan.kinds[PUPPETS].joint_count);
    }
    { /* one that was cut has no pose until the next frame */
        const float origin[3] = { -4.0f, 0.9f, 30.0f };
        assert_int_equal(noh_actor_cut(c.stage, actors[0], &said), NOH_OK);
        if (noh_stage_pick(c.stage, origin, direction, 100.0f, &hit, &said) == NOH_OK)
            assert_int_not_equal(hit.actor.id, actors[0].id);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_pick(c.stage, origin, direction, 100.0f, &hit, NULL), NOH_OK);
        assert_int_equal(hit.actor.id, actors[0].id);
    }
    direction[2] = 2.0f;
    assert_int_equal(noh_stage_pick(c.stage, sphere, direction, 0.0f, &hit, &said), NOH_ERR_ARG);
    {
        const float origin[3] = { 0.0f, 50.0f, 0.0f };
        assert_int_equal(noh_stage_pick(c.stage, origin, direction, 10.0f, &hit, &said), NOH_ERR_NOT_FOUND);
    }
    cast_close(&c);
}

/* What noh_view_ray finds under a pixel is projected back to that pixel. */
static void a_ray_goes_through_its_pixel(void **state)
{
    const noh_stage_view view = cast_view(33, 8.0f);
    (void)state;
    for (int y = 0; y < 360; y += 59) {
        for (int x = 0; x < 640; x += 71) {
            float origin[3], direction[3], clip[4];
            assert_true(noh_view_ray(&view, (float)x, (float)y, 640, 360, origin, direction));
            for (int r = 0; r < 4; r++) {
                clip[r] = view.view_projection[12 + r];
                for (int k = 0; k < 3; k++)
                    clip[r] += view.view_projection[4 * k + r] * (origin[k] + 7.0f * direction[k]);
            }
            assert_true(fabsf((clip[0] / clip[3] + 1.0f) * 320.0f - ((float)x + 0.5f)) < 0.02f);
            assert_true(fabsf((1.0f - clip[1] / clip[3]) * 180.0f - ((float)y + 0.5f)) < 0.02f);
        }
    }
}

/* ---- what tools ask for ---- */

/* One puppet that is posed in each frame, of a kind that is changed by the caller first. */
static noh_actor one_puppet(cast *c, uint32_t level)
{
    const noh_appearance look = { .posed = 1, .level = level };
    noh_actor actor;
    cast_make(c, NULL);
    assert_int_equal(noh_stage_spawn(c->stage, PUPPETS, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &look, NULL), NOH_OK);
    return actor;
}

static void a_kind_draws_the_nodes_of_its_list(void **state)
{
    static const uint32_t nothing[1] = { 0 };
    uint32_t node = 0, none = 9999;
    noh_skeleton skeleton;
    float joint[12];
    noh_actor actor;
    cast c;
    (void)state;
    cast_open(&c);
    while (c.packs[PUPPETS].nodes[node].mesh == NOH_NONE) node++;
    c.kinds[PUPPETS].nodes = &none, c.kinds[PUPPETS].node_count = 1, bad_plan(&c, NOH_ERR_ARG, "nodes");
    c.kinds[PUPPETS].nodes = &node;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    assert_int_equal(c.plan.kinds[PUPPETS].mesh_count, 1);
    /* without a mesh it has its joints, where nothing is drawn */
    c.kinds[PUPPETS].nodes = nothing, c.kinds[PUPPETS].node_count = 0;
    actor = one_puppet(&c, 0);
    assert_int_equal(c.plan.kinds[PUPPETS].mesh_count, 0);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_pack_skeleton_at(&c.packs[PUPPETS], 0, &skeleton, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_joint(c.stage, actor, skeleton.joint_count - 1u, joint, NULL), NOH_OK);
    cast_close(&c);
}

static void a_kind_may_have_no_clips(void **state)
{
    uint64_t bytes;
    noh_actor actor;
    cast c;
    (void)state;
    cast_open(&c);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    bytes = c.plan.cpu_bytes;
    c.kinds[PUPPETS].clip_packs = &c.kinds[PUPPETS].mesh;
    actor = one_puppet(&c, 0);
    assert_true(c.plan.cpu_bytes < bytes && c.plan.kinds[PUPPETS].segment_count == 0);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "walk", NULL, &said), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "other skeletons"));
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    cast_close(&c);
}

/* Level k of an actor is level k of each mesh, and is shown where its look or its stage says so. */
static void levels_are_those_of_the_meshes(void **state)
{
    cast c;
    (void)state;
    for (int full = 0; full < 2; full++) {
        const noh_kind_plan *k = &c.plan.kinds[PUPPETS];
        noh_actor actor;
        cast_open(&c);
        c.kinds[PUPPETS].levels_by_number = 1;
        c.kinds[PUPPETS].finest_level = 1;
        c.desc.full_detail = full;
        actor = one_puppet(&c, full ? 0 : 3);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(k->finest_level, 1);
        for (uint32_t m = 0; m < k->mesh_count; m++) {
            noh_actor_mesh shown;
            noh_mesh mesh;
            assert_int_equal(noh_actor_mesh_at(c.stage, actor, m, &shown, NULL, NULL), NOH_OK);
            assert_int_equal(shown.level, full ? 1 : 2);
            assert_int_equal(c.packs[PUPPETS].nodes[shown.node].mesh, shown.mesh);
            mesh = test_mesh(&c.packs[PUPPETS], shown.mesh);
            for (uint32_t l = 0; l < k->level_count; l++) {
                const uint32_t last = mesh.header->level_count - 1u;
                assert_int_equal(k->levels[l].mesh_levels[m], l < last ? l : last);
                assert_true(!l || k->levels[l].error_m >= k->levels[l - 1u].error_m);
            }
        }
        cast_close(&c);
    }
}

/* A camera that goes away: one level fades into the next until the coarsest shows, and the error reported for
 * it is the stage's error. */
static void detail_is_told_as_it_is_shown(void **state)
{
    const noh_place middle = { .position = { 0.0f, 0.8f, -2.0f } };
    const noh_appearance look = { .level = 2 };
    noh_actor_detail d, before = { 0, 0, 1.0f, 0, 0, 0.0f, 0.0f };
    uint32_t fades = 0, first = 0;
    noh_stage_view view;
    noh_actor mask;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    assert_int_equal(noh_stage_spawn(c.stage, MASKS, &middle, &mask, NULL), NOH_OK);
    assert_int_equal(noh_actor_detail_of(c.stage, mask, &d, &said), NOH_ERR_NOT_FOUND); /* no frame yet */
    for (uint32_t f = 0; f < 600; f++) {
        view = cast_view(0, 1.0f + 0.1f * (float)f);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_detail_of(c.stage, mask, &d, NULL), NOH_OK);
        assert_int_equal(noh_stage_stats_of(c.stage)->at_level[d.level], 1);
        assert_true(d.fade >= 0.0f && (d.fade < 1.0f) == (d.level != d.level_before));
        assert_true(d.level >= before.level && (d.level == before.level || d.level_before == before.level || !f));
        if (d.level == before.level && before.fade < 1.0f) assert_true(d.fade > before.fade);
        assert_true(fabsf(d.error_m * d.pixels_per_metre - noh_stage_stats_of(c.stage)->error_pixels) < 1e-6f);
        assert_true(!f || d.pixels_per_metre < before.pixels_per_metre);
        fades += f && d.level != before.level;
        if (!f) first = d.level;
        before = d;
    }
    assert_int_equal(d.level, c.plan.kinds[MASKS].level_count - 1u);
    assert_true(fades == d.level - first && fades > 1);
    assert_true(d.joint_count == 0 && d.influence_count == 0);
    assert_int_equal(noh_actor_set_appearance(c.stage, mask, &look, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_detail_of(c.stage, mask, &d, NULL), NOH_OK);
    assert_true(d.level == 1 && d.level_before == 1 && d.fade >= 1.0f);
    assert_true(fabsf(d.error_m / c.plan.kinds[MASKS].levels[1].error_m - 1.0f) < 1e-6f);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_detail_of(c.stage, mask, &d, NULL), NOH_ERR_NOT_FOUND); /* no view */
    assert_int_equal(noh_stage_despawn(c.stage, mask, NULL), NOH_OK);
    assert_int_equal(noh_actor_detail_of(c.stage, mask, &d, NULL), NOH_ERR_NOT_FOUND);
    cast_close(&c);
}

/* What is posed for a server alone is seen by no view, and has all joints. */
static void detail_of_the_unseen_has_no_scale(void **state)
{
    noh_actor_detail d;
    noh_actor actor;
    cast c;
    (void)state;
    cast_open(&c);
    actor = one_puppet(&c, 0);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_detail_of(c.stage, actor, &d, NULL), NOH_OK);
    assert_true(d.pixels_per_metre <= 0.0f && d.level == 0 && d.fade >= 1.0f && d.influence_count > 0);
    assert_int_equal(d.joint_count, c.plan.kinds[PUPPETS].joint_count);
    cast_close(&c);
}

/* The palette is joint times inverse bind matrix, the weights are those that are held. */
static void meshes_are_told_as_they_are_shown(void **state)
{
    noh_actor actor;
    noh_actor_mesh shown;
    uint32_t smile, held = 0;
    cast c;
    (void)state;
    cast_open(&c);
    actor = one_puppet(&c, 1);
    smile = noh_stage_find(c.stage, PUPPETS, NOH_NAME_FLOAT, "smile");
    assert_int_equal(noh_actor_mesh_at(c.stage, actor, 0, &shown, NULL, NULL), NOH_ERR_NOT_FOUND); /* no frame yet */
    assert_int_equal(noh_actor_hold_float(c.stage, actor, smile, 0.375f, 1.0f, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(c.stage, 9000, NULL, NULL, NULL, NULL), NOH_OK);
    for (uint32_t m = 0; m < c.plan.kinds[PUPPETS].mesh_count; m++) {
        float *matrices;
        noh_mesh mesh;
        noh_skin skin;
        assert_int_equal(noh_actor_mesh_at(c.stage, actor, m, &shown, NULL, NULL), NOH_OK);
        mesh = test_mesh(&c.packs[PUPPETS], shown.mesh);
        for (uint32_t t = 0; t < mesh.header->target_count; t++) {
            const int is_smile = strcmp(noh_pack_string(mesh.pack, mesh.targets[t].name), "smile") == 0;
            held += is_smile && shown.weights[t] == 0.375f;
        }
        if (noh_pack_skin_at(mesh.pack, mesh.header->skin, &skin, NULL) != NOH_OK) continue;
        assert_int_equal(shown.joint_count, skin.header->joint_count);
        matrices = test_zeros(shown.joint_count * 12u * sizeof *matrices);
        assert_int_equal(noh_actor_mesh_at(c.stage, actor, m, &shown, matrices, NULL), NOH_OK);
        for (uint32_t j = 0; j < shown.joint_count; j++) {
            float joint[12], placed[12];
            assert_int_equal(noh_actor_joint(c.stage, actor, skin.joints[j], joint, NULL), NOH_OK);
            noh_matrix_multiply(joint, skin.inverse_bind + 12u * (size_t)j, joint);
            noh_matrix_multiply(shown.world, matrices + 12u * (size_t)j, placed);
            for (int i = 0; i < 12; i++) assert_true(fabsf(joint[i] - placed[i]) < 1e-5f);
        }
        free(matrices);
    }
    assert_true(held >= 1);
    assert_int_equal(noh_actor_mesh_at(c.stage, actor, c.plan.kinds[PUPPETS].mesh_count, &shown, NULL, &said),
                     NOH_ERR_NOT_FOUND);
    assert_int_equal(said.need, c.plan.kinds[PUPPETS].mesh_count);
    assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_mesh_at(c.stage, actor, 0, &shown, NULL, NULL), NOH_ERR_NOT_FOUND);
    cast_close(&c);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_parts_of_a_plan_sum_to_its_bytes),
        cmocka_unit_test(plans_do_not_depend_on_when_they_are_made),
        cmocka_unit_test(actor_levels_rise_in_error),
        cmocka_unit_test(a_bound_is_kept_or_refused),
        cmocka_unit_test(kinds_that_share_clips_tell_the_same_cached_segments),
        cmocka_unit_test(half_of_the_frames_may_be_enough),
        cmocka_unit_test(desc_fields_broken_in_turn),
        cmocka_unit_test(a_byte_less_is_refused),
        cmocka_unit_test(a_stale_actor_is_an_error),
        cmocka_unit_test(a_despawned_actor_leaves_nothing),
        cmocka_unit_test(a_full_kind_refuses_to_spawn),
        cmocka_unit_test(bad_places_are_refused),
        cmocka_unit_test(names_are_found),
        cmocka_unit_test(a_face_is_played_over_a_body),
        cmocka_unit_test(a_walk_takes_the_actor_along),
        cmocka_unit_test(inertia_takes_over_without_a_leap),
        cmocka_unit_test(another_clip_does_not_leap),
        cmocka_unit_test(clips_play_beside_each_other),
        cmocka_unit_test(keys_are_told_with_their_names),
        cmocka_unit_test(frames_and_steps_do_not_mix),
        cmocka_unit_test(the_largest_counts_are_kept),
        cmocka_unit_test(who_is_behind_the_camera_is_not_posed),
        cmocka_unit_test(spheres_hold_every_vertex),
        cmocka_unit_test(whoever_was_never_posed_is_culled_by_where_clips_may_take_it),
        cmocka_unit_test(the_bits_do_not_depend_on_the_jobs),
        cmocka_unit_test(a_state_is_put_back_to_the_bit),
        cmocka_unit_test(a_damaged_state_does_no_harm),
        cmocka_unit_test(what_hangs_on_a_joint_goes_with_it),
        cmocka_unit_test(attachments_on_attachments),
        cmocka_unit_test(a_carrier_out_of_view_is_posed),
        cmocka_unit_test(a_ray_meets_the_nearest_actor),
        cmocka_unit_test(a_ray_goes_through_its_pixel),
        cmocka_unit_test(a_kind_draws_the_nodes_of_its_list),
        cmocka_unit_test(a_kind_may_have_no_clips),
        cmocka_unit_test(levels_are_those_of_the_meshes),
        cmocka_unit_test(meshes_are_told_as_they_are_shown),
        cmocka_unit_test(detail_is_told_as_it_is_shown),
        cmocka_unit_test(detail_of_the_unseen_has_no_scale),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
