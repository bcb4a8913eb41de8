/* Heads without joints: they turn as a whole, with eyes that keep their aim, within their reach, and under rays; in
 * what is attached; in any number of jobs. */
#include "support/stage_fixture.h"
#include "stage/modules/stage_face_internal.h"
#include "stage/cast/stage_internal.h"

#include "core/base/math_internal.h"

#include <math.h>

#define DEGREE 0.0174532925f

static noh_error said;

/* Masks, and puppets that carry them. */
static void open_heads(cast *c, noh_kind_face *face, uint32_t jobs)
{
    static __attribute__((aligned(16))) uint8_t scratch[65536];
    noh_kind_desc mask;
    memset(c, 0, sizeof *c);
    memset(&mask, 0, sizeof mask);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    cast_map(c, MASKS, "mask_levels.noh");
    mask.mesh = &c->packs[MASKS];
    mask.actor_count = 6;
    assert_int_equal(noh_kind_find_eyes(&mask, scratch, sizeof scratch, face->face.eyes, &said), NOH_OK);
    mask.face = noh_face_module(face);
    c->kinds[0] = mask;
    c->kinds[1].mesh = &c->packs[PUPPETS];
    c->kinds[1].actor_count = 2;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 2;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
}

static void close_heads(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
    noh_file_unmap(&c->files[1]);
}

static noh_actor enter(const cast *c, uint32_t kind, const noh_place *place)
{
    static const noh_appearance posed = { .posed = 1 };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, kind, place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &posed, NULL), NOH_OK);
    return actor;
}

static void run(const cast *c, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++)
        assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
}

static void world_of(const cast *c, noh_actor actor, float world[12])
{
    noh_actor_mesh mesh;
    assert_int_equal(noh_actor_mesh_at(c->stage, actor, 0, &mesh, NULL, &said), NOH_OK);
    memcpy(world, mesh.world, sizeof mesh.world);
}

static void to_world(const float m[12], const float p[3], float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
}

static float apart(const float a[3], const float b[3])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* Ten seconds of idle: no two frames alike; no motion that leaps. Calm, or with "" for its head, it does not move. */
static void a_head_moves_in_every_frame(void **state)
{
    (void)state;
    for (int still = 0; still < 3; still++) {
        const float nose[3] = { 0.0f, 0.0f, 0.1f };
        noh_kind_face face = { .flags = still == 1 ? NOH_FACE_CALM : 0, .head = still == 2 ? "" : NULL };
        float before[12], world[12], from[3], to[3], farthest = 0.0f, fastest = 0.0f, first[3];
        uint32_t alike = 0;
        noh_actor actor;
        cast c;
        open_heads(&c, &face, 1);
        actor = enter(&c, 0, NULL);
        run(&c, 1);
        world_of(&c, actor, before);
        to_world(before, nose, first);
        for (uint32_t f = 0; f < 600; f++) {
            run(&c, 1);
            world_of(&c, actor, world);
            alike += memcmp(world, before, sizeof world) == 0;
            to_world(before, nose, from);
            to_world(world, nose, to);
            fastest = fmaxf(fastest, apart(from, to));
            farthest = fmaxf(farthest, apart(first, to));
            memcpy(before, world, sizeof world);
        }
        print_message("%u of 600 pairs alike; the nose goes %.1f mm far, %.2f mm a frame\n", alike,
                      (double)farthest * 1000.0, (double)fastest * 1000.0);
        if (still) {
            assert_int_equal(alike, 600);
        } else {
            assert_int_equal(alike, 0);
            assert_true(farthest > 0.002f && farthest < 0.03f && fastest < 0.001f);
        }
        close_heads(&c);
    }
}

/* Without a clip, too, each frame has the pose of its own time: a blink is not blended from a few. */
static void a_blink_is_posed_in_every_frame(void **state)
{
    noh_kind_face face = { .flags = NOH_FACE_NO_BLINK };
    float most = 0.0f;
    noh_actor actor;
    uint32_t lid;
    cast c;
    (void)state;
    open_heads(&c, &face, 1);
    actor = enter(&c, 0, NULL);
    lid = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "eyeBlinkLeft");
    run(&c, 30);
    assert_int_equal(noh_actor_blink(c.stage, actor, NULL), NOH_OK);
    for (uint32_t f = 0; f < 20; f++) {
        const float *floats;
        noh_face_pose pose;
        run(&c, 1);
        floats = noh_actor_floats(c.stage, actor);
        assert_int_equal(noh_actor_face(c.stage, actor, &pose, NULL), NOH_OK);
        assert_true(fabsf(floats[lid] - pose.blink) < 1e-5f);
        most = fmaxf(most, floats[lid]);
    }
    assert_true(most > 0.95f);
    close_heads(&c);
}

/* Where a clip blinks, the face does not, then or for five seconds after. Without the clip it blinks in that time. */
static void lids_have_one_owner(void **state)
{
    uint32_t own[2] = { 0, 0 };
    (void)state;
    for (int plays = 0; plays < 2; plays++) {
        const noh_play loop = { .loop = NOH_LOOP_REPEAT };
        noh_kind_face face = { .flags = 0 };
        float lid_before = 0.0f;
        uint32_t blink, shut = 0;
        noh_actor actor;
        cast c;
        open_heads(&c, &face, 1);
        actor = enter(&c, 0, NULL);
        blink = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "blink");
        assert_true(blink != NOH_NONE);
        if (plays) assert_int_equal(noh_actor_play(c.stage, actor, 1, "blink", &loop, &said), NOH_OK);
        for (uint32_t f = 0; f < 1200; f++) {
            noh_face_pose pose;
            run(&c, 1);
            assert_int_equal(noh_actor_face(c.stage, actor, &pose, NULL), NOH_OK);
            own[plays] += pose.blink > 0.0f && !(lid_before > 0.0f);
            shut += noh_actor_floats(c.stage, actor)[blink] > 0.6f;
            lid_before = pose.blink;
        }
        assert_true(plays == (shut > 0));
        close_heads(&c);
    }
    print_message("blinks of its own in 20 s: %u, and %u with a clip that blinks\n", own[0], own[1]);
    assert_true(own[0] >= 4 && own[1] <= own[0] / 3u);
}

/* 60 faces that look from side to side, with blinks: half a second after a blink of a clip a face does not blink. */
static void blinks_of_two_owners_are_apart(void **state)
{
    noh_kind_face face = { .flags = 0 };
    uint32_t twice = 0, by_face = 0, by_clip = 0;
    cast c;
    (void)state;
    open_heads(&c, &face, 1);
    const uint32_t clips = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "blink");
    const uint32_t faces = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "eyeBlinkLeft");
    for (uint32_t head = 0; head < 60; head++) {
        const noh_actor actor = enter(&c, 0, NULL);
        uint32_t since = 1000, shut = 0;
        run(&c, 7 * head);
        assert_int_equal(noh_actor_play(c.stage, actor, 1, "blink", NULL, &said), NOH_OK);
        for (uint32_t f = 1; f <= 240; f++) {
            const float aside[3] = { f / 20u % 2u ? 1.0f : -1.0f, 0.0f, 1.0f };
            if (f % 20u == 0) assert_int_equal(noh_actor_look_at(c.stage, actor, aside, &said), NOH_OK);
            run(&c, 1);
            const float *floats = noh_actor_floats(c.stage, actor);
            const float lid = floats[clips] + floats[faces];
            const uint32_t shuts = !shut && lid > 0.5f && floats[faces] > floats[clips];
            shut = lid > (shut ? 0.3f : 0.5f);
            by_face += shuts;
            twice += shuts && since < 30;
            by_clip += floats[clips] > 0.8f && since > 30;
            since = floats[clips] > 0.8f ? 0 : since + 1;
        }
        assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_OK);
    }
    print_message("%u blinks of clips, %u of faces, %u too soon\n", by_clip, by_face, twice);
    assert_true(by_clip == 60 && by_face >= 60 && twice == 0);
    close_heads(&c);
}

/* A clip's floats raise the brows, nod the head and shut the lids: here one that smiles stands for one that speaks. */
static void a_clip_that_speaks_moves_the_face(void **state)
{
    noh_kind_face face = { .flags = NOH_FACE_CALM };
    float world[12], most = 0.0f, lid = 0.0f, down = 0.0f;
    uint32_t smile, brow, lids;
    noh_stage_face_kind *shared;
    noh_actor actor;
    cast c;
    (void)state;
    open_heads(&c, &face, 1);
    actor = enter(&c, 0, NULL);
    shared = c.stage->kinds[0].modules[NOH_SLOT_FACE].shared;
    smile = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "smile");
    brow = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "browOuterUpLeft");
    lids = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "eyeBlinkLeft");
    assert_int_equal(shared->speaks[0], NOH_NONE);
    for (int i = 0; i < 3; i++) shared->speaks[i] = smile;
    assert_int_equal(noh_actor_play(c.stage, actor, 1, "smile", NULL, &said), NOH_OK);
    for (uint32_t f = 0; f < 200; f++) {
        run(&c, 1);
        world_of(&c, actor, world);
        most = fmaxf(most, noh_actor_floats(c.stage, actor)[brow]);
        lid = fmaxf(lid, noh_actor_floats(c.stage, actor)[lids]);
        down = fmaxf(down, asinf(-world[6]) / DEGREE);
    }
    print_message("brows up by %.2f, nods of %.1f degrees, lids shut by %.2f\n", (double)most, (double)down,
                  (double)lid);
    assert_true(most > 0.4f && lid > 0.9f && down > 3.0f);
    close_heads(&c);
}

/* Live shapes: vowels nod the head and raise the brows, a pause blinks once; without shapes nothing is left. */
static void live_speech_moves_the_face(void **state)
{
    noh_kind_face face = { .flags = NOH_FACE_CALM };
    float world[12], most = 0.0f, down = 0.0f, before = 0.0f;
    uint32_t brow, blinks = 0;
    noh_face_pose pose;
    noh_actor actor;
    cast c;
    (void)state;
    open_heads(&c, &face, 1);
    actor = enter(&c, 0, NULL);
    brow = noh_stage_find(c.stage, 0, NOH_NAME_FLOAT, "browOuterUpLeft");
    for (uint32_t f = 0; f < 240; f++) {
        float shapes[NOH_VISEME_COUNT] = { 0.0f };
        shapes[f < 180 && f % 40u < 12u ? NOH_VISEME_AA : f < 180 ? NOH_VISEME_DD : NOH_VISEME_SIL] = 1.0f;
        assert_int_equal(noh_actor_set_visemes(c.stage, actor, shapes, NULL), NOH_OK);
        run(&c, 1);
        world_of(&c, actor, world);
        assert_int_equal(noh_actor_face(c.stage, actor, &pose, NULL), NOH_OK);
        most = fmaxf(most, noh_actor_floats(c.stage, actor)[brow]);
        down = fmaxf(down, asinf(-world[6]) / DEGREE);
        blinks += pose.blink > 0.0f && !(before > 0.0f);
        before = pose.blink;
        assert_true(f < 180 || f > 190 || blinks == 0);
    }
    print_message("brows up by %.2f, nods of %.1f degrees, %u blinks\n", (double)most, (double)down, blinks);
    assert_true(most > 0.2f && down > 1.5f && (blinks == 1 || blinks == 2)); /* one may be a double blink */
    assert_int_equal(noh_actor_set_visemes(c.stage, actor, NULL, NULL), NOH_OK);
    run(&c, 60);
    world_of(&c, actor, world);
    assert_true(fabsf(noh_actor_floats(c.stage, actor)[brow]) < 1e-6f && fabsf(world[6]) < 1e-6f);
    close_heads(&c);
}

/* What an eye of the turned head misses the point by, in degrees, by its targets; *yaw: how far the head is turned. */
static float miss(const cast *c, const noh_kind_face *face, noh_actor actor, const float point[3], int eye, float *yaw)
{
    static const char *const names[2][4] = { { "eyeLookUpLeft", "eyeLookDownLeft", "eyeLookOutLeft", "eyeLookInLeft" },
                                             { "eyeLookUpRight", "eyeLookDownRight", "eyeLookInRight",
                                               "eyeLookOutRight" } };
    const float *floats = noh_actor_floats(c->stage, actor);
    float m[12], at[3], to[3], v[4], way[3], pitch, aside;
    noh_stage_world(c->stage, (uint32_t)(noh_stage_actor_of(c->stage, actor, NULL) - c->stage->actors), m);
    to_world(m, face->face.eyes[eye], at);
    *yaw = atan2f(m[2], m[10]) / DEGREE;
    for (int i = 0; i < 4; i++) v[i] = floats[noh_stage_find(c->stage, 0, NOH_NAME_FLOAT, names[eye][i])];
    pitch = (v[0] * 25.0f - v[1] * 30.0f) * DEGREE;
    aside = (v[2] - v[3]) * 35.0f * DEGREE;
    for (int i = 0; i < 3; i++) to[i] = point[i] - at[i];
    for (int i = 0; i < 3; i++) way[i] = m[i] * to[0] + m[4 + i] * to[1] + m[8 + i] * to[2];
    return hypotf((aside - atan2f(way[0], way[2])) * cosf(pitch), pitch - atan2f(way[1], hypotf(way[0], way[2]))) /
           DEGREE;
}

static void a_head_turns_to_what_it_looks_at(void **state)
{
    const float points[3][3] = { { 1.0f, 0.2f, 1.0f }, { -1.0f, -0.4f, 1.0f }, { 0.3f, 0.8f, 1.2f } };
    (void)state;
    for (int p = 0; p < 3; p++) {
        noh_kind_face face = { .flags = NOH_FACE_NO_WANDER };
        float yaw, worst = 0.0f;
        noh_actor actor;
        cast c;
        open_heads(&c, &face, 1);
        actor = enter(&c, 0, NULL);
        assert_int_equal(noh_actor_look_at(c.stage, actor, points[p], NULL), NOH_OK);
        run(&c, 120);
        for (uint32_t f = 0; f < 240; f++) {
            run(&c, 1);
            for (int e = 0; e < 2; e++) worst = fmaxf(worst, miss(&c, &face, actor, points[p], e, &yaw));
        }
        print_message("head turned by %.1f degrees, eyes off by at most %.3f\n", (double)yaw, (double)worst);
        assert_true(worst < 0.1f);
        assert_true(p == 0 ? yaw > 15.0f : p == 1 ? yaw < -15.0f : fabsf(yaw) < 15.0f);
        close_heads(&c);
    }
}

/* The mesh stays within the sphere that culls it and the one that it reports, however it looks about. */
static void a_turned_head_is_within_its_spheres(void **state)
{
    static const noh_place place = { { 2.0f, 1.0f, -3.0f }, { 0.0f, 0.7071068f, 0.0f, 0.7071068f }, 2.0f };
    noh_kind_face face = { .flags = 0 };
    noh_actor actor;
    noh_mesh mesh;
    float reach[4];
    cast c;
    (void)state;
    open_heads(&c, &face, 1);
    actor = enter(&c, 0, &place);
    (void)noh_pack_mesh_at(&c.packs[MASKS], 0, &mesh, NULL);
    for (int i = 0; i < 3; i++) reach[i] = c.stage->kinds[0].reach[i] * place.scale;
    noh_quat_rotate(place.rotation, reach, reach);
    for (int i = 0; i < 3; i++) reach[i] += place.position[i];
    reach[3] = c.stage->kinds[0].reach[3] * place.scale;
    for (uint32_t f = 0; f < 40; f++) {
        const float point[3] = { 2.0f + 5.0f * cosf(0.9f * (float)f), 1.0f + 3.0f * sinf(1.7f * (float)f), -1.0f };
        float world[12], sphere[4], at[3];
        assert_int_equal(noh_actor_look_at(c.stage, actor, point, NULL), NOH_OK);
        run(&c, 40);
        world_of(&c, actor, world);
        assert_int_equal(noh_actor_sphere(c.stage, actor, sphere, NULL), NOH_OK);
        for (uint32_t v = 0; v < mesh.header->vertex_count; v += 7) {
            to_world(world, mesh.positions + 3u * (size_t)v, at);
            if (apart(at, reach) > reach[3] || apart(at, sphere) > sphere[3]) fail_msg("frame %u: vertex %u", f, v);
        }
    }
    close_heads(&c);
}

/* A ray meets the nose where it is shown, not where it is at rest. */
static void a_ray_meets_a_turned_head(void **state)
{
    const float aside[3] = { 2.0f, 0.0f, 1.0f }, back[3] = { 0.0f, 0.0f, -1.0f };
    noh_kind_face face = { .flags = NOH_FACE_NO_WANDER };
    uint32_t nose = 0;
    float world[12], at[3], origin[3];
    noh_stage_view view;
    noh_stage_hit hit;
    noh_actor actor;
    noh_mesh mesh;
    cast c;
    (void)state;
    open_heads(&c, &face, 1);
    actor = enter(&c, 0, NULL);
    assert_int_equal(noh_actor_look_at(c.stage, actor, aside, NULL), NOH_OK);
    run(&c, 120);
    noh_view_orbit(&view, face.face.eyes[0], 0.0f, 0.0f, 1.0f, 640, 360);
    assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    (void)noh_pack_mesh_at(&c.packs[MASKS], 0, &mesh, NULL);
    world_of(&c, actor, world);
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) { /* nearest to the eye of the ray */
        float now[3], most[3];
        to_world(world, mesh.positions + 3u * (size_t)v, now);
        to_world(world, mesh.positions + 3u * (size_t)nose, most);
        if (now[2] > most[2]) nose = v;
    }
    to_world(world, mesh.positions + 3u * (size_t)nose, at);
    memcpy(origin, at, sizeof origin);
    origin[2] += 1.0f;
    assert_int_equal(noh_stage_pick(c.stage, origin, back, 10.0f, &hit, &said), NOH_OK);
    assert_true(hit.actor.id == actor.id && apart(hit.point, at) < 2e-3f);
    assert_true(apart(at, mesh.positions + 3u * (size_t)nose) > 0.02f);
    close_heads(&c);
}

/* On a body's joint it turns there; it stays where it was shown when the body is gone. */
static void an_attached_head_turns_on_its_joint(void **state)
{
    noh_kind_face face = { .flags = NOH_FACE_NO_WANDER };
    static const noh_place over = { { 0.0f, 0.1f, 0.0f }, { 0, 0, 0, 1 }, 1.0f };
    float joint[12], before[12], world[12], at[3], to[3], nose[3] = { 0.0f, 0.0f, 0.1f };
    uint32_t alike = 0;
    noh_actor body, head;
    cast c;
    (void)state;
    open_heads(&c, &face, 1);
    body = enter(&c, 1, NULL);
    head = enter(&c, 0, &over);
    assert_int_equal(noh_actor_attach(c.stage, head, body, noh_stage_find(c.stage, 1, NOH_NAME_JOINT, "head"), &said),
                     NOH_OK);
    run(&c, 10);
    world_of(&c, head, before);
    for (uint32_t f = 0; f < 60; f++) {
        run(&c, 1);
        world_of(&c, head, world);
        alike += memcmp(world, before, sizeof world) == 0;
        memcpy(before, world, sizeof world);
    }
    assert_int_equal(alike, 0);
    assert_int_equal(noh_actor_joint(c.stage, body, noh_stage_find(c.stage, 1, NOH_NAME_JOINT, "head"), joint, NULL),
                     NOH_OK);
    to_world(joint, over.position, at);
    to_world(world, (const float[3]){ 0.0f, 0.0f, 0.0f }, to);
    assert_true(apart(at, to) < 0.02f);
    to_world(world, nose, at);
    assert_int_equal(noh_stage_despawn(c.stage, body, NULL), NOH_OK);
    run(&c, 1);
    world_of(&c, head, world);
    to_world(world, nose, to);
    if (!(apart(at, to) < 1e-3f)) fail_msg("it leaps by %g", (double)apart(at, to));
    close_heads(&c);
}

/* Jobs in any number give the same bits, in view and out of it; a state put back is followed by the same frames. */
static void heads_are_put_back(void **state)
{
    float worlds[60][6][12];
    uint64_t hashes[60];
    (void)state;
    for (uint32_t jobs = 1; jobs <= 4; jobs += 3) {
        noh_kind_face face = { .flags = 0 };
        noh_actor actors[6];
        uint8_t *saved = NULL;
        size_t bytes;
        cast c;
        open_heads(&c, &face, jobs);
        for (uint32_t i = 0; i < 6; i++) {
            const noh_place place = { { 0.5f * (float)i - 1.0f, 1.0f, -0.3f * (float)i }, { 0, 0, 0, 0 }, 0.0f };
            assert_int_equal(noh_stage_spawn(c.stage, 0, &place, &actors[i], NULL), NOH_OK);
        }
        for (int again = 0; again < 2; again++) {
            for (uint32_t f = 0; f < 60; f++) {
                const noh_stage_view view = cast_view(f, 4.0f);
                assert_int_equal(noh_actor_look_at_actor(c.stage, actors[f % 6u], actors[(f + 2u) % 6u], NULL), NOH_OK);
                if (!saved) saved = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
                assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
                for (uint32_t i = 0; i < 6; i++) {
                    float world[12];
                    noh_stage_world(c.stage, (uint32_t)(noh_stage_actor_of(c.stage, actors[i], NULL) - c.stage->actors),
                                    world);
                    if (jobs == 1 && !again) memcpy(worlds[f][i], world, sizeof world);
                    assert_memory_equal(worlds[f][i], world, sizeof world);
                }
                if (jobs == 1 && !again) hashes[f] = noh_stage_hash(c.stage);
                assert_true(hashes[f] == noh_stage_hash(c.stage));
            }
            assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, NULL), NOH_OK);
        }
        free(saved);
        close_heads(&c);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_head_moves_in_every_frame),
        cmocka_unit_test(a_blink_is_posed_in_every_frame),
        cmocka_unit_test(lids_have_one_owner),
        cmocka_unit_test(blinks_of_two_owners_are_apart),
        cmocka_unit_test(a_clip_that_speaks_moves_the_face),
        cmocka_unit_test(live_speech_moves_the_face),
        cmocka_unit_test(a_head_turns_to_what_it_looks_at),
        cmocka_unit_test(a_turned_head_is_within_its_spheres),
        cmocka_unit_test(a_ray_meets_a_turned_head),
        cmocka_unit_test(an_attached_head_turns_on_its_joint),
        cmocka_unit_test(heads_are_put_back),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
