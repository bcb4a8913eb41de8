/* Parts: what changes a pose before it is shown. A gaze that turns a head, floats that a part sets, the time that parts
 * receive, their states saved and put back. */
#include "support/stage_fixture.h"

#include "support/look_part.h"

static noh_error said;

static void open_cast(cast *c, uint32_t actors, const noh_modifier *parts, uint32_t part_count)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    cast_map(c, MASKS, "mask_levels.noh");
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].modifiers = parts;
    c->kinds[0].modifier_count = part_count;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
}

static void close_cast(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
    noh_file_unmap(&c->files[1]);
}

static noh_modifier gaze_of(const look_joint *joint)
{
    const noh_modifier part = {
        .name = "gaze", .modify = look_modify, .check = look_check, .user = joint, .state_bytes = sizeof(look_state)
    };
    return part;
}

static noh_actor enter(const cast *c, const char *clip)
{
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c->stage, actor, 0, clip, NULL, NULL), NOH_OK);
    return actor;
}

static void look_at(const cast *c, noh_actor actor, float x, float y, float z)
{
    look_state *g = noh_actor_modifier(c->stage, actor, 0);
    assert_non_null(g);
    g->target[0] = x, g->target[1] = y, g->target[2] = z;
    g->wanted = 1.0f;
}

static void frame(const cast *c, uint32_t number, float distance)
{
    const noh_stage_view view = cast_view(number, distance);
    assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

/* The cosine of the angle between where the head faces and where the target is. */
static float aim(const cast *c, noh_actor actor, const look_joint *joint)
{
    const look_state *g = noh_actor_modifier(c->stage, actor, 0);
    float m[12], dot = 0.0f, length = 0.0f, scale = 0.0f;
    assert_int_equal(noh_actor_joint(c->stage, actor, joint->head, m, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) {
        const float forward = m[4 * i] * joint->forward[0] + m[4 * i + 1] * joint->forward[1] +
                              m[4 * i + 2] * joint->forward[2];
        const float to = g->target[i] - m[4 * i + 3];
        dot += forward * to;
        length += to * to;
        scale += forward * forward;
    }
    return dot / sqrtf(length * scale);
}

/* ---- poses ---- */

/* The head of a walking puppet turns to its target, with all that is attached to it; the feet stay. */
static void a_head_turns_to_a_target(void **state)
{
    noh_modifier gaze;
    look_joint joint;
    noh_actor actor, other;
    noh_place place;
    float foot[12], same[12];
    cast c;
    (void)state;
    open_cast(&c, 2, &gaze, 1);
    joint = look_joint_of(&c.packs[0], "head");
    gaze = gaze_of(&joint);
    cast_make(&c, NULL);
    actor = enter(&c, "walk");
    other = enter(&c, "walk");
    for (uint32_t f = 0; f < 300; f++) {
        assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
        look_at(&c, actor, place.position[0] + 1.5f, 1.9f, place.position[2] + 1.0f);
        look_at(&c, other, place.position[0] + 1.5f, 1.9f, place.position[2] + 1.0f);
        ((look_state *)noh_actor_modifier(c.stage, other, 0))->wanted = 0.0f;
        if (f < 10) ((look_state *)noh_actor_modifier(c.stage, actor, 0))->wanted = 0.0f;
        frame(&c, f, 4.0f);
        if (f == 15) assert_true(aim(&c, actor, &joint) < 0.9f); /* it takes its time */
    }
    assert_true(aim(&c, actor, &joint) > 0.999f);
    assert_true(aim(&c, other, &joint) < 0.8f);
    assert_int_equal(noh_actor_joint(c.stage, actor, 1, foot, NULL), NOH_OK);
    assert_int_equal(noh_actor_joint(c.stage, other, 1, same, NULL), NOH_OK);
    assert_memory_equal(foot, same, sizeof foot);
    close_cast(&c);
}

/* ---- floats, and the order of parts ---- */

static void set_float(noh_modifier_work *w)
{
    const uint32_t *index = w->user;
    assert_true(noh_modifier_set_float(w, *index, 0.25f));
    assert_false(noh_modifier_set_float(w, 100000, 1.0f));
    assert_false(noh_modifier_set_float(w, *index, NAN));
}

static void double_float(noh_modifier_work *w)
{
    const uint32_t *index = w->user;
    float *notes = w->scratch;
    notes[3] = noh_modifier_float(w, *index);
    assert_true(noh_modifier_set_float(w, *index, 2.0f * notes[3]));
}

/* Parts run in the order of the desc, each over what the one before has left; what the game holds is over all. */
static void parts_set_floats_in_their_order(void **state)
{
    static const noh_appearance posed = { .posed = 1 };
    uint32_t index = 0;
    const noh_modifier parts[2] = { { .name = "set", .modify = set_float, .user = &index },
                                    { .name = "double", .modify = double_float, .user = &index, .scratch_bytes = 16 } };
    for (int without_clips = 0; without_clips < 2; without_clips++) {
        noh_pack no_clips;
        noh_actor actor;
        cast c;
        (void)state;
        open_cast(&c, 3, parts, 2);
        c.kinds[0].mesh = &c.packs[MASKS];
        c.kinds[0].root_axes = 0;
        if (without_clips) { /* clips of another skeleton */
            no_clips = c.packs[PUPPETS];
            c.kinds[0].clips = &no_clips;
        }
        cast_make(&c, NULL);
        index = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "jawOpen");
        assert_true(index != NOH_NONE);
        assert_int_equal(noh_stage_spawn(c.stage, 0, NULL, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c.stage, actor, &posed, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        assert_true(noh_actor_floats(c.stage, actor)[index] == 0.5f);
        assert_true(noh_actor_modifier(c.stage, actor, 0) && !noh_actor_modifier(c.stage, actor, 2));
        assert_int_equal(noh_actor_hold_float(c.stage, actor, index, 1.0f, 0.5f, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        assert_true(noh_actor_floats(c.stage, actor)[index] == 0.75f);
        close_cast(&c);
    }
}

/* ---- the order of a frame ---- */

/* What a part between the face and the ragdoll sees, and what it does on demand: turns a shoulder by a quarter. */
typedef struct witness {
    float head[4];
    uint32_t bends, reserved[3];
} witness;

typedef struct witness_joints {
    uint32_t head, arm;
} witness_joints;

static void stand_between(noh_modifier_work *w)
{
    const witness_joints *j = w->user;
    witness *seen = w->state;
    static const float quarter[4] = { 0.70710678f, 0.0f, 0.0f, 0.70710678f };
    memcpy(seen->head, w->local[j->head].rotation, sizeof seen->head);
    if (seen->bends) noh_quat_mul(w->local[j->arm].rotation, quarter, w->local[j->arm].rotation);
}

static float joint_moves(const cast *c, noh_actor actor, const char *name, float at[12])
{
    const uint32_t joint = noh_stage_find(c->stage, 0, NOH_NAME_JOINT, name);
    float now[12], worst = 0.0f;
    assert_int_equal(noh_actor_joint(c->stage, actor, joint, now, NULL), NOH_OK);
    for (int i = 0; i < 12; i++) worst = fmaxf(worst, fabsf(now[i] - at[i]));
    memcpy(at, now, sizeof now);
    return worst;
}

static void frames_of(const cast *c, uint32_t count)
{
    for (uint32_t f = 0; f < count; f++)
        assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
}

/* Each step of a frame works on what the one before has left: parts see where the face has turned the head; an actor
 * that lies, lies as the ragdoll does, whatever parts do to the limbs; and springs are attached to the limbs that lie
 * there, not to the limbs of the clip, which walks on. */
static void face_parts_ragdoll_and_springs_in_this_order(void **state)
{
    static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };
    static const noh_appearance posed = { .posed = 1 };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    const float aside[3] = { 6.0f, 1.5f, 3.0f };
    noh_kind_face face;
    witness_joints joints;
    const noh_modifier part = {
        .name = "witness", .modify = stand_between, .user = &joints, .state_bytes = sizeof(witness)
    };
    float hand[12] = { 0 }, sleeve[12] = { 0 }, apart = 0.0f;
    noh_actor lies, stands;
    cast c;
    (void)state;
    memset(&face, 0, sizeof face);
    for (int e = 0; e < 2; e++) {
        face.face.eyes[e][0] = e ? -0.035f : 0.035f;
        face.face.eyes[e][1] = 1.55f;
        face.face.eyes[e][2] = 0.11f;
    }
    memset(&c, 0, sizeof c);
    cast_map(&c, PUPPETS, "demo/puppet.noh");
    c.kinds[0] = (noh_kind_desc){
        .mesh = &c.packs[0],
        .actor_count = 2,
        .face = noh_face_module(&face),
        .ragdoll = noh_ragdoll_module(&ragdoll),
        .springs = noh_springs_module(NULL),
        .modifiers = &part,
        .modifier_count = 1,
    };
    c.desc.kinds = c.kinds;
    c.desc.kind_count = 1;
    cast_make(&c, NULL);
    joints.head = noh_stage_find(c.stage, 0, NOH_NAME_JOINT, "head");
    joints.arm = noh_stage_find(c.stage, 0, NOH_NAME_JOINT, "upper_arm.L");
    assert_true(joints.head != NOH_NONE && joints.arm != NOH_NONE);
    for (int i = 0; i < 2; i++) {
        noh_actor *actor = i ? &stands : &lies;
        assert_int_equal(noh_stage_spawn(c.stage, 0, NULL, actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c.stage, *actor, &posed, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c.stage, *actor, 0, "walk", NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_face_flags(c.stage, *actor, NOH_FACE_NO_WANDER, NULL), NOH_OK);
    }
    assert_int_equal(noh_actor_look_at(c.stage, lies, aside, NULL), NOH_OK);
    frames_of(&c, 90);
    for (int i = 0; i < 4; i++) {
        apart += fabsf(((witness *)noh_actor_modifier(c.stage, lies, 0))->head[i] -
                       ((witness *)noh_actor_modifier(c.stage, stands, 0))->head[i]);
    }
    assert_true(apart > 0.1f);
    assert_int_equal(noh_actor_kill(c.stage, lies, NULL), NOH_OK);
    for (int f = 0; f < 900 && noh_actor_body(c.stage, lies) != NOH_BODY_LIES; f++) frames_of(&c, 1);
    assert_int_equal(noh_actor_body(c.stage, lies), NOH_BODY_LIES);
    frames_of(&c, 300);
    (void)joint_moves(&c, lies, "forearm.L", hand);
    (void)joint_moves(&c, lies, "sleeve.L", sleeve);
    for (int f = 0; f < 60; f++) {
        frames_of(&c, 1);
        assert_true(joint_moves(&c, lies, "forearm.L", hand) < 1e-3f); /* it breathes */
        assert_true(joint_moves(&c, lies, "sleeve.L", sleeve) < 2e-3f);
    }
    ((witness *)noh_actor_modifier(c.stage, lies, 0))->bends = 1;
    frames_of(&c, 1);
    assert_true(joint_moves(&c, lies, "forearm.L", hand) < 1e-3f);
    (void)joint_moves(&c, stands, "forearm.L", hand);
    ((witness *)noh_actor_modifier(c.stage, stands, 0))->bends = 1;
    frames_of(&c, 1);
    assert_true(joint_moves(&c, stands, "forearm.L", hand) > 0.1f);
    cast_close_stage(&c);
    noh_file_unmap(&c.files[0]);
}

/* ---- time ---- */

typedef struct log_state {
    int64_t first, last;
    uint32_t calls, cuts, ticks, reserved;
} log_state;

static void log_time(noh_modifier_work *w)
{
    log_state *l = w->state;
    assert_true(((uintptr_t)w->state & 15u) == 0 && w->actor.id != 0);
    if (w->cut) l->first = w->clock, l->ticks = 0;
    l->cuts += w->cut;
    l->calls++;
    l->ticks += w->ticks;
    l->last = w->clock;
}

/* The ticks that a part receives add up to the clock, near and far, at any rate; out of view it is not called, and what
 * comes after that is a cut. */
static void parts_are_told_how_much_time_has_passed(void **state)
{
    const noh_modifier log = { .name = "log", .modify = log_time, .state_bytes = sizeof(log_state) };
    const log_state *l;
    uint32_t near_calls, far_calls;
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &log, 1);
    cast_make(&c, NULL);
    actor = enter(&c, "walk");
    l = noh_actor_modifier(c.stage, actor, 0);
    for (uint32_t f = 0; f < 60; f++) frame(&c, 0, 3.0f);
    near_calls = l->calls;
    assert_int_equal(near_calls, 60);
    assert_int_equal(l->ticks, l->last - l->first);
    for (uint32_t f = 0; f < 120; f++) frame(&c, 0, 900.0f);
    far_calls = l->calls - near_calls;
    assert_true(far_calls < 60 && far_calls > 3);
    assert_int_equal(l->ticks, l->last - l->first);
    assert_int_equal(l->cuts, 1);
    for (uint32_t f = 0; f < 60; f++)
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(l->calls, near_calls + far_calls); /* out of view */
    frame(&c, 0, 3.0f);
    assert_int_equal(l->cuts, 2);
    for (uint32_t f = 0; f < 10; f++) frame(&c, 0, 3.0f);
    assert_int_equal(noh_actor_cut(c.stage, actor, NULL), NOH_OK);
    frame(&c, 0, 3.0f);
    assert_int_equal(l->cuts, 3);
    close_cast(&c);
}

/* ---- bytes and states ---- */

static void every_byte_of_parts_is_planned(void **state)
{
    noh_modifier parts[NOH_MODIFIERS_MAX + 1u];
    noh_stage_bytes list[64];
    uint64_t plain, sum = 0;
    noh_stage *made = NULL;
    cast c;
    (void)state;
    memset(parts, 0, sizeof parts);
    open_cast(&c, 3, parts, 0);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    plain = c.plan.state_bytes;
    for (uint32_t i = 0; i <= NOH_MODIFIERS_MAX; i++) parts[i].modify = log_time, parts[i].state_bytes = 8u + i;
    c.kinds[0].modifier_count = 2; /* 8 and 9 bytes, each rounded up, and a head */
    c.desc.job_count = 3;
    parts[1].scratch_bytes = 1000;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    assert_true(c.plan.state_bytes == plain + 3u * (16u + 16u + 16u));
    for (uint32_t i = noh_stage_plan_parts(&c.desc, NULL, &c.plan, list, 64); i-- > 0;) sum += list[i].cpu_bytes;
    assert_true(sum == c.plan.cpu_bytes);
    c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes - 1u, NULL, &c.desc, &c.plan, &made, NULL),
                     NOH_ERR_MEMORY);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes, NULL, &c.desc, &c.plan, &made, NULL), NOH_OK);
    c.kinds[0].modifier_count = NOH_MODIFIERS_MAX + 1u;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_ARG);
    c.kinds[0].modifier_count = 1, parts[0].modify = NULL;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "modify"));
    close_cast(&c);
}

#define CAST 9u

static void open_crowd(cast *c, const noh_modifier *part, uint32_t jobs)
{
    open_cast(c, CAST, part, 1);
    c->desc.job_count = jobs;
    cast_make(c, NULL);
    for (uint32_t i = 0; i < CAST; i++) {
        const noh_place place = { { 1.1f * (float)i - 4.0f, 0.0f, -0.7f * (float)i }, { 0, 0, 0, 0 }, 0.0f };
        const noh_actor actor = enter(c, i % 2u ? "walk" : "idle");
        assert_int_equal(noh_actor_set_place(c->stage, actor, &place, NULL), NOH_OK);
    }
}

static void crowd_frame(const cast *c, uint32_t f)
{
    const noh_actor actor = noh_stage_actor_at(c->stage, f % CAST);
    if (f % 3u == 0) look_at(c, actor, 3.0f - 0.02f * (float)f, 1.5f, 2.0f);
    frame(c, f, 3.0f + 0.4f * (float)(f % 80u));
}

/* Jobs in any number give the same bits; a state put back, or into a fork, is followed by the same. A state that the
 * part refuses is refused. */
static void states_of_parts_are_put_back(void **state)
{
    static const uint32_t jobs[] = { 1, 4, 7 };
    uint64_t hashes[200];
    noh_modifier gaze;
    look_joint joint;
    cast c;
    (void)state;
    for (int j = 0; j < 3; j++) {
        uint8_t *saved;
        size_t bytes;
        look_state *forged;
        open_cast(&c, 1, NULL, 0);
        joint = look_joint_of(&c.packs[0], "head");
        close_cast(&c);
        gaze = gaze_of(&joint);
        open_crowd(&c, &gaze, jobs[j]);
        for (uint32_t f = 0; f < 100; f++) crowd_frame(&c, f);
        saved = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
        for (int again = 0; again < 2; again++) {
            for (uint32_t f = 0; f < 200; f++) {
                crowd_frame(&c, 100u + f);
                if (j + again == 0) hashes[f] = noh_stage_hash(c.stage);
                if (noh_stage_hash(c.stage) != hashes[f]) fail_msg("%u jobs: frame %u differs", jobs[j], (unsigned)f);
            }
            assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, NULL), NOH_OK);
        }
        forged = noh_actor_modifier(c.stage, noh_stage_actor_at(c.stage, 4), 0);
        forged = (look_state *)(void *)(saved +
                                        ((uint8_t *)forged - (const uint8_t *)noh_stage_state(c.stage, &bytes)));
        forged->turned = 2.0f;
        assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, &said), NOH_ERR_DATA);
        assert_non_null(strstr(said.what, "gaze"));
        free(saved);
        close_cast(&c);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_head_turns_to_a_target),
        cmocka_unit_test(parts_set_floats_in_their_order),
        cmocka_unit_test(face_parts_ragdoll_and_springs_in_this_order),
        cmocka_unit_test(parts_are_told_how_much_time_has_passed),
        cmocka_unit_test(every_byte_of_parts_is_planned),
        cmocka_unit_test(states_of_parts_are_put_back),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
