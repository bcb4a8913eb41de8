/* Faces of actors: eyes that meet what is looked at, whatever clips do to head and body; nothing that stands still but
 * what is calm; bytes, states and jobs. */
#include "support/stage_fixture.h"
#include "life/face/identity_internal.h"
#include "stage/modules/stage_face_internal.h"

#include <math.h>

#define DEGREE 0.0174532925f
#define CAST 6u

static noh_error said;

/* Of the puppet's mask: its head turns at 1.42 m. */
static noh_kind_face alive(void)
{
    noh_kind_face face;
    memset(&face, 0, sizeof face);
    for (int e = 0; e < 2; e++) {
        face.face.eyes[e][0] = e ? -0.035f : 0.035f;
        face.face.eyes[e][1] = 1.55f;
        face.face.eyes[e][2] = 0.11f;
    }
    return face;
}

static void open_cast(cast *c, uint32_t actors, const noh_kind_face *face, uint32_t jobs)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    cast_map(c, MASKS, "mask_levels.noh");
    c->kinds[0].mesh = &c->packs[PUPPETS];
    c->kinds[0].actor_count = actors;
    c->kinds[0].face = noh_face_module(face);
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
}

static void close_cast(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
    noh_file_unmap(&c->files[1]);
}

static noh_actor enter(const cast *c, const char *clip, const noh_place *place)
{
    static const noh_appearance posed = { .posed = 1 };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &posed, NULL), NOH_OK);
    if (clip) assert_int_equal(noh_actor_play(c->stage, actor, 0, clip, NULL, NULL), NOH_OK);
    return actor;
}

static void run(const cast *c, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++)
        assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
}

static float float_named(const cast *c, noh_actor actor, const char *name)
{
    const uint32_t at = noh_stage_find(c->stage, 0, NOH_NAME_FLOAT, name);
    assert_true(at != NOH_NONE);
    return noh_actor_floats(c->stage, actor)[at];
}

/* ---- looks ---- */

/* The angle between where an eye looks, by its targets and the head as it was drawn, and the point. */
static float miss(const cast *c, noh_actor actor, int eye, const float point[3])
{
    static const char *const names[2][4] = { { "eyeLookUpLeft", "eyeLookDownLeft", "eyeLookOutLeft", "eyeLookInLeft" },
                                             { "eyeLookUpRight", "eyeLookDownRight", "eyeLookInRight",
                                               "eyeLookOutRight" } };
    const noh_kind_face face = alive();
    const uint32_t joint = noh_stage_find(c->stage, 0, NOH_NAME_JOINT, "head");
    static float rest[12u * NOH_JOINTS_MAX];
    float m[12], v[4], local[3], yaw, pitch, to[3];
    noh_skeleton skeleton;
    (void)noh_pack_skeleton_at(&c->packs[0], 0, &skeleton, NULL, NULL);
    noh_local_to_model(&skeleton, skeleton.bind_pose, skeleton.joint_count, rest);
    assert_int_equal(noh_actor_joint(c->stage, actor, joint, m, NULL), NOH_OK);
    for (int i = 0; i < 4; i++) v[i] = float_named(c, actor, names[eye][i]);
    pitch = (v[0] * 25.0f - v[1] * 30.0f) * DEGREE;
    yaw = (v[2] - v[3]) * 35.0f * DEGREE;
    for (int i = 0; i < 3; i++) { /* the puppet's head has the model's axes at rest */
        local[i] = face.face.eyes[eye][i] - rest[12u * joint + 4u * (uint32_t)i + 3u];
    }
    for (int i = 0; i < 3; i++) {
        to[i] = point[i] - m[4 * i + 3];
        for (int k = 0; k < 3; k++) to[i] -= m[4 * i + k] * local[k];
    }
    {
        const float way[3] = { m[0] * to[0] + m[4] * to[1] + m[8] * to[2], m[1] * to[0] + m[5] * to[1] + m[9] * to[2],
                               m[2] * to[0] + m[6] * to[1] + m[10] * to[2] };
        const float wanted_yaw = atan2f(way[0], way[2]), wanted_pitch = atan2f(way[1], hypotf(way[0], way[2]));
        return hypotf((yaw - wanted_yaw) * cosf(pitch), pitch - wanted_pitch) / DEGREE;
    }
}

static void eyes_meet_a_point_whatever_the_body_does(void **state)
{
    static const char *const clips[] = { "idle", "walk", "bow", "dance" };
    const noh_kind_face face = alive();
    const noh_place place = { { 3.0f, 0.2f, -1.0f }, { 0.0f, 0.3826834f, 0.0f, 0.9238795f }, 1.5f };
    (void)state;
    for (uint32_t t = 0; t < 4; t++) {
        static const float ways[4] = { 0.5f, 1.0f, 3.0f, 10.0f };
        float point[3], worst = 0.0f;
        uint32_t held = 0, met = 0;
        noh_actor actor;
        cast c;
        open_cast(&c, 1, &face, 1);
        cast_make(&c, NULL);
        actor = enter(&c, clips[t], &place);
        assert_int_equal(noh_actor_set_face_flags(c.stage, actor, NOH_FACE_NO_WANDER, NULL), NOH_OK);
        point[0] = 3.0f + 0.7071f * ways[t] * 1.5f, point[2] = -1.0f + 0.9f * ways[t] * 1.5f;
        point[1] = 0.2f + 1.5f * 1.5f;
        assert_int_equal(noh_actor_look_at(c.stage, actor, point, NULL), NOH_OK);
        run(&c, 90);
        for (uint32_t f = 0; f < 120; f++) {
            noh_face_pose pose;
            float off[2];
            run(&c, 1);
            assert_int_equal(noh_actor_face(c.stage, actor, &pose, NULL), NOH_OK);
            off[0] = miss(&c, actor, 0, point), off[1] = miss(&c, actor, 1, point);
            if (fabsf(pose.eyes[0][0]) > 34.0f * DEGREE || fabsf(pose.eyes[0][1]) > 24.0f * DEGREE) continue;
            held++; /* within the limits of the eyes */
            met += off[0] < 0.1f && off[1] < 0.1f;
            worst = fmaxf(worst, fmaxf(off[0], off[1]));
        }
        print_message("%s: both eyes within 0.1 degrees in %u of %u frames, at most %.3f off\n", clips[t], met, held,
                      (double)worst);
        assert_true(held > (t == 2 ? 20u : 100u) && met == held); /* a bow takes the eyes to their limits */
        close_cast(&c);
    }
}

static void two_actors_meet_each_others_eyes(void **state)
{
    const noh_kind_face face = alive();
    const noh_place a = { { 0.0f, 0.0f, 0.0f }, { 0, 0, 0, 1 }, 1.0f },
                    b = { { 0.2f, 0.3f, 1.2f }, { 0, 1, 0, 0 }, 1.0f };
    const float eyes_of_b[3] = { 0.2f, 1.85f, 1.09f };
    noh_actor first, second;
    noh_face_pose pose;
    cast c;
    (void)state;
    open_cast(&c, 2, &face, 1);
    cast_make(&c, NULL);
    first = enter(&c, "idle", &a);
    second = enter(&c, "idle", &b);
    assert_int_equal(noh_actor_set_face_flags(c.stage, first, NOH_FACE_NO_WANDER, NULL), NOH_OK);
    assert_int_equal(noh_actor_look_at_actor(c.stage, first, second, NULL), NOH_OK);
    run(&c, 120);
    assert_true(miss(&c, first, 0, eyes_of_b) < 0.1f && miss(&c, first, 1, eyes_of_b) < 0.1f);
    assert_int_equal(noh_stage_despawn(c.stage, second, NULL), NOH_OK);
    run(&c, 120);
    assert_int_equal(noh_actor_face(c.stage, first, &pose, NULL), NOH_OK);
    assert_true(miss(&c, first, 0, eyes_of_b) > 4.0f); /* ahead again */
    assert_int_equal(noh_actor_look_at_actor(c.stage, first, second, NULL), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_actor_look_at(c.stage, second, NULL, NULL), NOH_ERR_NOT_FOUND);
    close_cast(&c);
}

/* A tube with a face whose eyes are joints, the only kind of a cast that is opened.
 * rest: [12 * NOH_JOINTS_MAX], gets its joints at rest */
static void open_tube_with_eyes(cast *c, noh_kind_face *face, float *rest)
{
    noh_skeleton skeleton;
    cast_open(c);
    (void)noh_pack_skeleton_at(&c->packs[TUBES], 0, &skeleton, NULL, NULL);
    noh_local_to_model(&skeleton, skeleton.bind_pose, skeleton.joint_count, rest);
    for (uint32_t e = 0; e < 2; e++) {
        face->eyes[e] = noh_pack_joint_name(&c->packs[TUBES], 0, 2u - e);
        for (uint32_t i = 0; i < 3; i++) face->face.eyes[e][i] = rest[12u * (2u - e) + 4u * i + 3u];
    }
    face->face.eyes[0][0] += 0.06f; /* the joints are in line: separate the eyes; the lower eye keeps its place */
    c->kinds[0] = c->kinds[TUBES];
    c->desc.kind_count = 1;
}

/* An eye that is a joint turns to what is looked at, with a head that turns and without one. */
static void eyes_with_joints_turn(void **state)
{
    static float rest[12u * NOH_JOINTS_MAX];
    const float point[3] = { 0.9f, 0.6f, 2.5f };
    (void)state;
    for (int without_head = 0; without_head < 2; without_head++) {
        noh_kind_face face;
        noh_actor actor;
        float m[12], dot = 0.0f, length = 0.0f;
        cast c;
        memset(&face, 0, sizeof face);
        open_tube_with_eyes(&c, &face, rest);
        face.head = without_head ? "" : noh_pack_joint_name(&c.packs[TUBES], 0, 0);
        face.neck = face.chest = "";
        face.flags = NOH_FACE_NO_WANDER;
        c.kinds[0].face = noh_face_module(&face);
        cast_make(&c, NULL);
        actor = enter(&c, NULL, NULL);
        assert_int_equal(noh_actor_look_at(c.stage, actor, point, NULL), NOH_OK);
        run(&c, 120);
        assert_int_equal(noh_actor_joint(c.stage, actor, 1, m, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) {
            const float to = point[i] - m[4 * i + 3];
            float ahead = 0.0f; /* z at rest, now */
            for (int k = 0; k < 3; k++) ahead += m[4 * i + k] * rest[12u + 8u + (uint32_t)k];
            dot += ahead * to;
            length += to * to;
        }
        if (!(dot > 0.9999f * sqrtf(length))) fail_msg("%d: cosine %g", without_head, (double)(dot / sqrtf(length)));
        cast_close(&c);
    }
}

/* The float of a blink of one that looks down (or up) as far as it can, with the first rows of a recipe. */
static float blink_looking(const noh_face_row *rows, uint32_t row_count, float height, int joints)
{
    const noh_face_recipe recipe = { "lids", rows, row_count, NULL }, *const recipes[1] = { &recipe };
    const float point[3] = { 0.0f, height, 1.0f };
    static float rest[12u * NOH_JOINTS_MAX];
    noh_kind_face face = alive();
    noh_actor actor;
    float blink;
    cast c;
    face.flags = NOH_FACE_CALM;
    face.recipes = recipes;
    face.recipe_count = 1;
    open_cast(&c, 1, &face, 1);
    if (joints) {
        close_cast(&c);
        open_tube_with_eyes(&c, &face, rest);
        face.head = face.neck = face.chest = "";
        c.kinds[0].face = noh_face_module(&face);
    }
    cast_make(&c, NULL);
    actor = enter(&c, NULL, NULL);
    assert_int_equal(noh_actor_look_at(c.stage, actor, point, NULL), NOH_OK);
    run(&c, 120);
    blink = float_named(&c, actor, rows[0].target);
    if (joints) {
        cast_close(&c);
    } else {
        close_cast(&c);
    }
    return blink;
}

/* Lids go down with eyes that look down, but not up: by a blink in part where no target is for that; where looks have
 * targets, those move lids, unless joints turn the eyes in their place. */
static void lids_follow_eyes_that_look_down(void **state)
{
    static const noh_face_row rows[] = { { "eyeBlinkLeft", NOH_CHANNEL_BLINK_LEFT, 1.0f },
                                         { "eyeLookDownLeft", NOH_CHANNEL_EYES + 1, 1.0f } };
    static const noh_face_row lids[] = { { "eyeBlinkLeft", NOH_CHANNEL_BLINK_LEFT, 1.0f },
                                         { "eyeSquintLeft", NOH_CHANNEL_LIDS_DOWN, 1.0f } };
    static const noh_face_row tube[] = { { "bulge", NOH_CHANNEL_BLINK_LEFT, 1.0f },
                                         { "swell", NOH_CHANNEL_EYES + 1, 1.0f } };
    (void)state;
    print_message("by a blink of %.2f\n", (double)blink_looking(rows, 1, -9.0f, 0));
    assert_true(fabsf(blink_looking(rows, 1, -9.0f, 0) - 0.4f) < 0.05f);
    assert_true(blink_looking(rows, 1, 9.0f, 0) == 0.0f);
    assert_true(blink_looking(rows, 2, -9.0f, 0) == 0.0f);
    assert_true(blink_looking(lids, 2, -9.0f, 0) == 0.0f);
    assert_true(blink_looking(tube, 1, -9.0f, 1) > 0.3f && blink_looking(tube, 2, -9.0f, 1) > 0.3f);
}

/* Behind the lids, in a mask without joints and on a puppet's head; at joints, where there are some; nowhere in a tube
 * without lids. */
static void eyes_are_found_by_lids_and_by_joints(void **state)
{
    static __attribute__((aligned(16))) uint8_t scratch[65536];
    const float at_1m[3] = { 0.035f, 1.55f, 0.11f };
    float eyes[2][3], on_mask[2][3];
    noh_kind_face joints;
    cast c;
    (void)state;
    open_cast(&c, 1, NULL, 1);
    for (uint32_t k = 0; k < 2; k++) {
        noh_kind_desc kind = c.kinds[0];
        size_t bytes;
        kind.mesh = &c.packs[k ? MASKS : PUPPETS];
        bytes = noh_kind_find_eyes_size(&kind);
        assert_true(bytes > 0 && bytes <= sizeof scratch);
        assert_int_equal(noh_kind_find_eyes(&kind, scratch, bytes - 1u, eyes, &said), NOH_ERR_MEMORY);
        assert_int_equal(said.need, bytes);
        assert_int_equal(noh_kind_find_eyes(&kind, scratch, bytes, eyes, &said), NOH_OK);
        assert_true(fabsf(eyes[0][0] + eyes[1][0]) < 2e-3f && eyes[0][0] > 0.02f && eyes[0][0] < 0.05f);
        if (k) memcpy(on_mask, eyes, sizeof eyes);
        for (int i = 0; i < 3 && !k; i++) assert_true(fabsf(eyes[0][i] - at_1m[i]) < 0.04f);
    }
    assert_true(fabsf(on_mask[0][1] - on_mask[1][1]) < 2e-3f && fabsf(on_mask[0][2] - on_mask[1][2]) < 2e-3f);
    close_cast(&c);
    cast_open(&c);
    assert_int_equal(noh_kind_find_eyes(&c.kinds[TUBES], scratch, sizeof scratch, eyes, &said), NOH_ERR_NOT_FOUND);
    memset(&joints, 0, sizeof joints);
    joints.head = noh_pack_joint_name(&c.packs[TUBES], 0, 0);
    for (uint32_t e = 0; e < 2; e++) joints.eyes[e] = noh_pack_joint_name(&c.packs[TUBES], 0, 2u - e);
    c.kinds[TUBES].face = noh_face_module(&joints);
    assert_int_equal(noh_kind_find_eyes(&c.kinds[TUBES], scratch, sizeof scratch, eyes, &said), NOH_OK);
    assert_true(eyes[0][1] != eyes[1][1]); /* the tube's joints stand above each other */
    cast_close(&c);
}

/* ---- never still ---- */

/* What shows of an actor: floats, and where its head is. */
static void picture(const cast *c, noh_actor actor, float *out)
{
    const uint32_t head = noh_stage_find(c->stage, 0, NOH_NAME_JOINT, "head");
    const uint32_t floats = c->plan.kinds[0].float_count;
    memcpy(out, noh_actor_floats(c->stage, actor), floats * sizeof *out);
    assert_int_equal(noh_actor_joint(c->stage, actor, head, out + floats, NULL), NOH_OK);
}

/* No half second without motion in a face that is on, and none at all in one that is calm. Nothing else plays. A head on
 * joints rises on a breath. */
static void nothing_that_lives_stands_still(void **state)
{
    noh_kind_face face = alive();
    (void)state;
    for (int calm = 0; calm < 2; calm++) {
        float now[128], last[128];
        uint32_t still = 0, longest = 0;
        float low = 1e9f, high = -1e9f;
        noh_actor actor;
        cast c;
        face.flags = calm ? NOH_FACE_CALM : 0;
        open_cast(&c, 1, &face, 1);
        cast_make(&c, NULL);
        actor = enter(&c, NULL, NULL);
        run(&c, 1);
        assert_true(c.plan.kinds[0].float_count + 12u <= 128u);
        picture(&c, actor, last);
        for (uint32_t f = 0; f < 3600; f++) {
            run(&c, 1);
            picture(&c, actor, now);
            still = memcmp(now, last, (c.plan.kinds[0].float_count + 12u) * sizeof *now) ? 0 : still + 1u;
            longest = still > longest ? still : longest;
            low = fminf(low, now[c.plan.kinds[0].float_count + 7u]);
            high = fmaxf(high, now[c.plan.kinds[0].float_count + 7u]);
            memcpy(last, now, sizeof last);
        }
        print_message("the head rises by %.1f mm\n", 1e3 * (double)(high - low));
        if (calm) {
            assert_int_equal(longest, 3600);
        } else {
            assert_true(longest < 30 && high - low > 0.003f);
        }
        close_cast(&c);
    }
}

/* ---- its inputs ---- */

static void emotions_by_name_leave_the_mouth_to_speech(void **state)
{
    const noh_kind_face face = alive();
    float visemes[NOH_VISEME_COUNT] = { 0 };
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &face, 1);
    cast_make(&c, NULL);
    actor = enter(&c, NULL, NULL);
    assert_int_equal(noh_actor_set_emotion(c.stage, actor, "surprise", 1.0f, 4800, 0, 0, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_emotion(c.stage, actor, "hunger", 1.0f, 0, 0, 0, &said), NOH_ERR_ARG);
    run(&c, 60);
    assert_true(float_named(&c, actor, "jawOpen") > 0.2f && float_named(&c, actor, "browInnerUp") > 0.5f);
    visemes[NOH_VISEME_PP] = 1.0f;
    assert_int_equal(noh_actor_set_visemes(c.stage, actor, visemes, NULL), NOH_OK);
    run(&c, 1);
    assert_true(float_named(&c, actor, "jawOpen") == 0.0f && float_named(&c, actor, "browInnerUp") > 0.5f);
    visemes[3] = 2.0f;
    assert_int_equal(noh_actor_set_visemes(c.stage, actor, visemes, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_actor_set_visemes(c.stage, actor, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_activity(c.stage, actor, NOH_ACTIVITY_TALK, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_activity(c.stage, actor, (noh_activity)7, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_actor_set_face_flags(c.stage, actor, 99, NULL), NOH_ERR_ARG);
    close_cast(&c);
}

/* The puppet's pack with a recipe: its strings with some more behind them. */
static noh_pack with_recipe(const noh_pack *pack, noh_recipe_row rows[2], char **strings)
{
    static const char more[] = "joy-mouth\0+jawOpen\0jawOpen\0mouthFunnel";
    static const uint32_t channel_at[2] = { 0, 10 }, target_at[2] = { 19, 27 };
    noh_pack out = *pack;
    *strings = test_zeros(pack->string_bytes + sizeof more);
    memcpy(*strings, pack->strings, pack->string_bytes);
    memcpy(*strings + pack->string_bytes, more, sizeof more);
    memset(rows, 0, 2 * sizeof *rows);
    for (int i = 0; i < 2; i++) {
        rows[i].channel = pack->string_bytes + channel_at[i];
        rows[i].target = pack->string_bytes + target_at[i];
        rows[i].weight = 0.5f;
    }
    out.strings = *strings;
    out.string_bytes += (uint32_t)sizeof more;
    out.recipe_rows = rows;
    out.recipe_row_count = 2;
    return out;
}

static void a_pack_brings_its_own_recipe_and_correctives(void **state)
{
    const noh_kind_face face = alive();
    noh_recipe_row rows[2];
    noh_pack own;
    noh_actor actor;
    uint32_t funnel;
    char *strings;
    cast c;
    (void)state;
    open_cast(&c, 1, &face, 1);
    own = with_recipe(&c.packs[PUPPETS], rows, &strings);
    c.kinds[0].mesh = &own;
    c.kinds[0].held_float_count = 1;
    cast_make(&c, NULL);
    actor = enter(&c, NULL, NULL);
    assert_int_equal(noh_actor_set_emotion(c.stage, actor, "joy", 1.0f, 4800, 0, 0, NULL), NOH_OK);
    run(&c, 60);
    assert_true(fabsf(float_named(&c, actor, "jawOpen") - 0.5f) < 1e-3f);
    assert_true(float_named(&c, actor, "mouthSmileLeft") == 0.0f);            /* the built-in row gives way */
    assert_true(fabsf(float_named(&c, actor, "mouthFunnel") - 1.0f) < 2e-3f); /* an in-between at its peak */
    funnel = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "mouthFunnel");
    assert_int_equal(noh_actor_hold_float(c.stage, actor, funnel, 0.25f, 1.0f, NULL), NOH_OK);
    run(&c, 1);
    assert_true(float_named(&c, actor, "mouthFunnel") == 0.25f);
    close_cast(&c);
    free(strings);
}

/* A kind that asks for them keeps its pack's rules, whatever sets the weights; another one does not. */
static void rules_for_weights_hold_on_request(void **state)
{
    static const char more[] = "-jawOpen\0mouthFunnel";
    (void)state;
    for (int asked = 0; asked < 2; asked++) {
        noh_recipe_row row;
        noh_pack own;
        noh_actor actor;
        char *strings;
        cast c;
        open_cast(&c, 1, NULL, 1);
        own = c.packs[PUPPETS];
        strings = test_zeros(own.string_bytes + sizeof more);
        memcpy(strings, own.strings, own.string_bytes);
        memcpy(strings + own.string_bytes, more, sizeof more);
        memset(&row, 0, sizeof row);
        row.channel = own.string_bytes;
        row.target = own.string_bytes + 9u;
        row.weight = 1.0f;
        own.strings = strings;
        own.string_bytes += (uint32_t)sizeof more;
        own.recipe_rows = &row;
        own.recipe_row_count = 1;
        c.kinds[0].mesh = &own;
        c.kinds[0].weight_rules = asked;
        c.kinds[0].held_float_count = 2;
        cast_make(&c, NULL);
        actor = enter(&c, NULL, NULL);
        assert_int_equal(noh_actor_hold_float(c.stage, actor, noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "jawOpen"),
                                              0.25f, 1.0f, NULL),
                         NOH_OK);
        assert_int_equal(noh_actor_hold_float(c.stage, actor, noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "mouthFunnel"),
                                              0.75f, 1.0f, NULL),
                         NOH_OK);
        run(&c, 2);
        assert_true(float_named(&c, actor, "jawOpen") == (asked ? 0.0f : 0.25f));
        assert_true(float_named(&c, actor, "mouthFunnel") == (asked ? 0.5f : 0.75f));
        close_cast(&c);
        free(strings);
    }
}

/* An emotion's rule in the pack holds, unless the kind has rules of its own. */
static void a_packs_rules_between_expressions_hold(void **state)
{
    static const char more[] = "override-speech\0joy-upper\0binary";
    static const float left[] = { 0.0f, 0.4f, 0.8f, 0.0f }, weights[] = { 1.0f, 2.0f, 1.0f, 2.0f };
    (void)state;
    for (int i = 0; i < 4; i++) {
        noh_kind_face face = alive();
        float visemes[NOH_VISEME_COUNT] = { 0.0f };
        noh_recipe_row rows[2];
        noh_pack own;
        noh_actor actor;
        char *strings;
        cast c;
        if (i == 2) face.rules.speech[NOH_EMOTION_ANGER] = NOH_OVERRIDE_BLOCK;
        open_cast(&c, 1, &face, 1);
        own = c.packs[PUPPETS];
        strings = test_zeros(own.string_bytes + sizeof more);
        memcpy(strings, own.strings, own.string_bytes);
        memcpy(strings + own.string_bytes, more, sizeof more);
        memset(rows, 0, sizeof rows);
        rows[0].channel = own.string_bytes;
        rows[1].channel = own.string_bytes + 26u;
        rows[0].target = rows[1].target = own.string_bytes + 16u;
        rows[0].weight = weights[i];
        rows[1].weight = 1.0f;
        own.strings = strings;
        own.string_bytes += (uint32_t)sizeof more;
        own.recipe_rows = rows;
        own.recipe_row_count = i == 3 ? 2 : 1; /* 3: half of a blend is all of it */
        c.kinds[0].mesh = &own;
        cast_make(&c, NULL);
        actor = enter(&c, NULL, NULL);
        visemes[NOH_VISEME_AA] = 0.8f;
        assert_int_equal(noh_actor_set_visemes(c.stage, actor, visemes, NULL), NOH_OK);
        run(&c, 60);
        const float alone = float_named(&c, actor, "jawOpen");
        assert_true(alone > 0.2f);
        assert_int_equal(noh_actor_set_emotion(c.stage, actor, "joy", i == 3 ? 0.6f : 0.5f, 4800, 0, 0, NULL), NOH_OK);
        run(&c, 60);
        print_message("jawOpen %.3f of %.3f\n", (double)float_named(&c, actor, "jawOpen"), (double)alone);
        assert_true(fabsf(float_named(&c, actor, "jawOpen") / alone - left[i] / 0.8f) < 0.02f);
        close_cast(&c);
        free(strings);
    }
}

/* A game calls an expression by its name: it moves its targets, and its rules hold. The target mouthFunnel stands for
 * an empty one. */
static void expressions_are_called_by_name(void **state)
{
    static const char more[] = ":mouthFunnel\0mouthFunnel\0mouthSmileLeft\0override-speech\0binary";
    static const uint32_t channel_at[] = { 0, 40, 56 }, target_at[] = { 25, 13, 13 };
    static const float held[] = { 0.5f, 0.5f, 0.75f, 0.25f }, left[] = { 0.5f, 0.0f, 0.0f, 1.0f };
    static const float smiles[] = { 0.4f, 0.4f, 0.8f, 0.0f };
    (void)state;
    for (int i = 0; i < 4; i++) { /* blend, block, whole, whole but below one half */
        const noh_kind_face face = alive();
        float visemes[NOH_VISEME_COUNT] = { 0.0f };
        noh_recipe_row rows[3];
        noh_pack own;
        noh_actor actor;
        char *strings;
        cast c;
        open_cast(&c, 1, &face, 1);
        own = c.packs[PUPPETS];
        strings = test_zeros(own.string_bytes + sizeof more);
        memcpy(strings, own.strings, own.string_bytes);
        memcpy(strings + own.string_bytes, more, sizeof more);
        memset(rows, 0, sizeof rows);
        for (int k = 0; k < 3; k++) {
            rows[k].channel = own.string_bytes + channel_at[k];
            rows[k].target = own.string_bytes + target_at[k];
        }
        rows[0].weight = 0.8f;
        rows[1].weight = i == 0 ? 2.0f : 1.0f;
        rows[2].weight = 1.0f;
        own.strings = strings;
        own.string_bytes += (uint32_t)sizeof more;
        own.recipe_rows = rows;
        own.recipe_row_count = i >= 2 ? 3 : 2;
        c.kinds[0].mesh = &own;
        c.kinds[0].held_float_count = 1;
        cast_make(&c, NULL);
        actor = enter(&c, NULL, NULL);
        visemes[NOH_VISEME_AA] = 0.8f;
        assert_int_equal(noh_actor_set_visemes(c.stage, actor, visemes, NULL), NOH_OK);
        run(&c, 60);
        const float alone = float_named(&c, actor, "jawOpen");
        assert_true(alone > 0.2f && float_named(&c, actor, "mouthSmileLeft") == 0.0f);
        assert_int_equal(noh_actor_hold_float(c.stage, actor, noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "mouthFunnel"),
                                              held[i], 1.0f, NULL),
                         NOH_OK);
        run(&c, 2);
        assert_true(fabsf(float_named(&c, actor, "jawOpen") - alone * left[i]) < 1e-5f);
        assert_true(fabsf(float_named(&c, actor, "mouthSmileLeft") - smiles[i]) < 1e-6f);
        close_cast(&c);
        free(strings);
    }
}

/* ---- people ---- */

typedef struct person {
    noh_mesh mesh;
    noh_identity identity;
    void *memory;
    float weights[NOH_TARGETS_MAX];
    uint32_t held; /* weights that are not 0 */
} person;

/* The mask's cheeks, nose and brows as if they told people apart: they stretch what the lids are shut by. */
static void open_person(const cast *c, person *p, uint32_t seed)
{
    uint8_t marks[NOH_TARGETS_MAX] = { 0 };
    noh_identity_desc desc;
    void *scratch;
    size_t bytes, working;
    memset(p, 0, sizeof *p);
    memset(&desc, 0, sizeof desc);
    for (uint32_t i = 0; !p->mesh.header || !p->mesh.header->target_count; i++) {
        assert_int_equal(noh_pack_mesh_at(&c->packs[PUPPETS], i, &p->mesh, NULL), NOH_OK);
    }
    for (uint32_t t = 0; t < p->mesh.header->target_count; t++) {
        const char *name = noh_pack_string(p->mesh.pack, p->mesh.targets[t].name);
        marks[t] = strncmp(name, "cheek", 5) == 0 || strncmp(name, "nose", 4) == 0 ||
                   strncmp(name, "eyeSquint", 9) == 0;
    }
    desc.is_identity = marks;
    bytes = noh_identity_size(&p->mesh);
    working = noh_identity_scratch_size(&p->mesh);
    p->memory = test_zeros(bytes);
    scratch = test_zeros(working);
    assert_int_equal(noh_identity_init(p->memory, bytes, scratch, working, &p->mesh, &desc, &p->identity, NULL),
                     NOH_OK);
    free(scratch);
    for (; p->held < 2u; seed++) {
        noh_identity_random(&p->identity, seed, 1.0f, p->weights);
        p->held = 0;
        for (uint32_t t = 0; t < p->mesh.header->target_count; t++) p->held += p->weights[t] != 0.0f;
    }
    /* as a head has them whose lids are larger */
    p->identity.closing_count = 1;
    p->identity.closings[0] = (uint16_t)noh_mesh_find_target(&p->mesh, "eyeBlinkLeft");
    for (uint32_t t = 0; t < p->mesh.header->target_count; t++) {
        ((noh_identity_target *)p->memory)[t].closing[0] = marks[t] ? 0.4f : 0.0f;
    }
    assert_ptr_equal(p->identity.targets, p->memory);
}

/* Their floats are held at the person's weights, lids shut at theirs, and all of it is state. */
static void an_actor_is_a_person(void **state)
{
    const noh_kind_face face = alive();
    person p;
    noh_actor actor;
    float worst = 0.0f, shut = 0.0f;
    uint64_t hash;
    cast c;
    (void)state;
    open_cast(&c, 2, &face, 1);
    open_person(&c, &p, 5);
    c.kinds[0].held_float_count = p.held;
    cast_make(&c, NULL);
    actor = enter(&c, NULL, NULL);
    assert_int_equal(noh_actor_set_face_flags(c.stage, actor, NOH_FACE_CALM, NULL), NOH_OK);
    hash = noh_stage_hash(c.stage);
    assert_int_equal(noh_actor_set_identity(c.stage, actor, &p.identity, &p.mesh, p.weights, NULL), NOH_OK);
    assert_true(noh_stage_hash(c.stage) != hash);
    assert_int_equal(noh_actor_set_identity(c.stage, actor, &p.identity, &p.mesh, p.weights, NULL), NOH_OK); /* again */
    run(&c, 2);
    for (uint32_t t = 0; t < p.mesh.header->target_count; t++) {
        const char *name = noh_pack_string(p.mesh.pack, p.mesh.targets[t].name);
        if (p.identity.targets[t].used) worst = fmaxf(worst, fabsf(float_named(&c, actor, name) - p.weights[t]));
    }
    assert_true(worst == 0.0f);
    assert_int_equal(noh_actor_blink(c.stage, actor, NULL), NOH_OK);
    for (int i = 0; i < 30; i++) {
        run(&c, 1);
        shut = fmaxf(shut,
                     float_named(&c, actor, noh_pack_string(p.mesh.pack, p.mesh.targets[p.identity.closings[0]].name)));
    }
    print_message("lids are shut at %.3f\n", (double)shut);
    assert_true(shut > 1.01f && fabsf(shut - noh_identity_shut(&p.identity, p.weights, 0)) < 2e-3f);
    assert_int_equal(noh_actor_set_identity(c.stage, actor, &p.identity, &p.mesh, NULL, NULL), NOH_OK);
    run(&c, 1);
    for (uint32_t t = 0; t < p.mesh.header->target_count; t++) {
        if (p.weights[t] != 0.0f)
            assert_true(float_named(&c, actor, noh_pack_string(p.mesh.pack, p.mesh.targets[t].name)) == 0.0f);
    }
    close_cast(&c);
    free(p.memory);
}

static void a_person_that_does_not_fit_is_refused(void **state)
{
    const noh_kind_face face = alive();
    person p;
    noh_actor actor;
    noh_error error;
    cast c;
    (void)state;
    open_cast(&c, 1, &face, 1);
    open_person(&c, &p, 5);
    c.kinds[0].held_float_count = 1;
    cast_make(&c, NULL);
    actor = enter(&c, NULL, NULL);
    if (p.held > 1) {
        assert_int_equal(noh_actor_set_identity(c.stage, actor, &p.identity, &p.mesh, p.weights, &error),
                         NOH_ERR_LIMIT);
        assert_int_equal(error.need, p.held);
        run(&c, 1);
        for (uint32_t t = 0; t < p.mesh.header->target_count; t++) {
            if (p.weights[t] != 0.0f)
                assert_true(float_named(&c, actor, noh_pack_string(p.mesh.pack, p.mesh.targets[t].name)) == 0.0f);
        }
    }
    close_cast(&c);
    free(p.memory);
}

/* Out of view nothing is lived through; an hour later a face goes on at once. */
static void an_hour_unseen_is_skipped(void **state)
{
    static const noh_appearance unseen = { .posed = 0 }, posed = { .posed = 1 };
    const noh_kind_face face = alive();
    noh_face_pose pose;
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &face, 1);
    cast_make(&c, NULL);
    actor = enter(&c, "idle", NULL);
    assert_int_equal(noh_actor_set_emotion(c.stage, actor, "joy", 1.0f, 0, 480000, 0, NULL), NOH_OK);
    run(&c, 60);
    assert_int_equal(noh_actor_set_appearance(c.stage, actor, &unseen, NULL), NOH_OK);
    for (int i = 0; i < 60; i++)
        assert_int_equal(noh_stage_frame(c.stage, 60 * NOH_TICKS_PER_SECOND, NULL, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c.stage, actor, &posed, NULL), NOH_OK);
    run(&c, 2);
    assert_int_equal(noh_actor_face(c.stage, actor, &pose, NULL), NOH_OK);
    assert_true(pose.emotions[NOH_EMOTION_JOY] == 0.0f && pose.blink == 0.0f);
    close_cast(&c);
}

/* ---- bytes and states ---- */

static void a_face_is_planned_to_the_byte(void **state)
{
    noh_kind_face face = alive();
    noh_stage_bytes list[64];
    uint64_t plain, sum = 0, faces = 0;
    noh_stage *made = NULL;
    cast c;
    (void)state;
    open_cast(&c, 3, NULL, 1);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    plain = c.plan.state_bytes;
    c.kinds[0].face = noh_face_module(&face);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    assert_true(c.plan.state_bytes > plain && c.plan.state_bytes <= plain + 3u * (16u + NOH_ACTOR_FACE_BYTES));
    for (uint32_t i = noh_stage_plan_parts(&c.desc, NULL, &c.plan, list, 64); i-- > 0;) {
        sum += list[i].cpu_bytes;
        if (strcmp(list[i].what, "faces") == 0) faces += list[i].cpu_bytes;
    }
    assert_true(sum == c.plan.cpu_bytes && faces > 1000);
    c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes - 1u, NULL, &c.desc, &c.plan, &made, NULL),
                     NOH_ERR_MEMORY);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes, NULL, &c.desc, &c.plan, &made, NULL), NOH_OK);
    memset(face.face.eyes, 0, sizeof face.face.eyes); /* and the puppet has no joints for them */
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "eyes"));
    face = alive();
    face.head = "haed";
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "joint"));
    face = alive();
    face.rules.lids[3] = 9;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_ARG);
    close_cast(&c);
}

static void crowd_frame(const cast *c, uint32_t f)
{
    const noh_actor actor = noh_stage_actor_at(c->stage, f % CAST);
    const float point[3] = { 3.0f - 0.02f * (float)f, 1.5f, 2.0f };
    const noh_stage_view view = cast_view(f, 3.0f + 0.4f * (float)(f % 80u));
    if (f % 7u == 0) assert_int_equal(noh_actor_look_at(c->stage, actor, point, NULL), NOH_OK);
    if (f % 11u == 0) {
        assert_int_equal(noh_actor_look_at_actor(c->stage, actor, noh_stage_actor_at(c->stage, (f + 1) % CAST), NULL),
                         NOH_OK);
    }
    if (f % 13u == 0) assert_int_equal(noh_actor_set_emotion(c->stage, actor, "joy", 0.7f, 0, 9600, 0, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

/* Jobs in any number give the same bits; a state put back is followed by the same; a bad one is refused. */
static void states_of_faces_are_put_back(void **state)
{
    static const uint32_t jobs[] = { 1, 4 };
    const noh_kind_face face = alive();
    uint64_t hashes[120];
    (void)state;
    for (int j = 0; j < 2; j++) {
        uint8_t *saved;
        size_t bytes;
        cast c;
        open_cast(&c, CAST, &face, jobs[j]);
        cast_make(&c, NULL);
        for (uint32_t i = 0; i < CAST; i++) {
            const noh_place place = { { 1.1f * (float)i - 3.0f, 0.0f, -0.7f * (float)i }, { 0, 0, 0, 0 }, 0.0f };
            noh_actor actor;
            assert_int_equal(noh_stage_spawn(c.stage, 0, &place, &actor, NULL), NOH_OK);
            assert_int_equal(noh_actor_play(c.stage, actor, 0, i % 2u ? "walk" : "idle", NULL, NULL), NOH_OK);
        }
        for (uint32_t f = 0; f < 60; f++) crowd_frame(&c, f);
        saved = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
        for (int again = 0; again < 2; again++) {
            for (uint32_t f = 0; f < 120; f++) {
                crowd_frame(&c, 60u + f);
                if (j + again == 0) hashes[f] = noh_stage_hash(c.stage);
                if (noh_stage_hash(c.stage) != hashes[f]) fail_msg("%u jobs: frame %u differs", jobs[j], (unsigned)f);
            }
            assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, NULL), NOH_OK);
        }
        free(saved);
        close_cast(&c);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eyes_meet_a_point_whatever_the_body_does),
        cmocka_unit_test(two_actors_meet_each_others_eyes),
        cmocka_unit_test(eyes_with_joints_turn),
        cmocka_unit_test(lids_follow_eyes_that_look_down),
        cmocka_unit_test(eyes_are_found_by_lids_and_by_joints),
        cmocka_unit_test(nothing_that_lives_stands_still),
        cmocka_unit_test(emotions_by_name_leave_the_mouth_to_speech),
        cmocka_unit_test(a_pack_brings_its_own_recipe_and_correctives),
        cmocka_unit_test(rules_for_weights_hold_on_request),
        cmocka_unit_test(a_packs_rules_between_expressions_hold),
        cmocka_unit_test(expressions_are_called_by_name),
        cmocka_unit_test(an_actor_is_a_person),
        cmocka_unit_test(a_person_that_does_not_fit_is_refused),
        cmocka_unit_test(an_hour_unseen_is_skipped),
        cmocka_unit_test(a_face_is_planned_to_the_byte),
        cmocka_unit_test(states_of_faces_are_put_back),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
