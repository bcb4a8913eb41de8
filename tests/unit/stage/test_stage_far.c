/* test_stage_far.c: a stage far from the origin: places keep what floats lose, and what a frame makes of them is relative
 * to its camera, so that all is as it is at the origin. */
#include "support/support.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "motion/anim/root_internal.h"
#include "stage/cast/stage_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "support/stage_fixture.h"

static const float places[] = { 100000.0f, -100000.0f, 1000000.0f };

static double exactly(const noh_stage *s, noh_actor actor, int axis)
{
    const noh_stage_actor *a = noh_stage_actor_of(s, actor, NULL);
    return (double)a->place.position[axis] + (double)a->rest[axis];
}

static noh_actor walker_at(cast *c, float x, float z)
{
    const noh_place place = { .position = { x, 0.0f, z }, .rotation = { 0.0f, 0.6f, 0.0f, 0.8f } };
    const noh_play play = { .fade_ticks = 1 };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, PUPPETS, &place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c->stage, actor, 0, "walk", &play, NULL), NOH_OK);
    return actor;
}

/* Ten seconds at any rate lead as far as at the origin. */
static void root_motion_goes_all_the_way(void **state)
{
    static const uint32_t rates[] = { 30, 60, 144, 240 };
    (void)state;
    for (size_t r = 0; r < TEST_COUNT(rates); r++) {
        for (size_t p = 0; p < TEST_COUNT(places); p++) {
            const float x = places[p];
            noh_actor here, there;
            double way;
            cast c;
            cast_open(&c);
            cast_make(&c, NULL);
            here = walker_at(&c, 0.0f, 0.0f);
            there = walker_at(&c, x, x);
            for (uint32_t i = 0; i < 10u * rates[r]; i++) {
                assert_int_equal(noh_stage_step(c.stage, 48000u / rates[r], NULL, NULL, NULL), NOH_OK);
            }
            way = hypot(exactly(c.stage, here, 0), exactly(c.stage, here, 2));
            assert_true(way > 4.9);
            assert_true(fabs(exactly(c.stage, there, 0) - (double)x - exactly(c.stage, here, 0)) < 1e-6);
            assert_true(fabs(exactly(c.stage, there, 2) - (double)x - exactly(c.stage, here, 2)) < 1e-6);
            cast_close(&c);
        }
    }
}

/* A quarter turn a second, for a day: what turns add up to is as exact as they are, and the way closes. */
static void a_day_of_turns_adds_nothing(void **state)
{
    const noh_root_pose quarter = { { 0.25, 0.0, 0.5 }, 0x40000000u, 0 }, sixth = { { 0.1, 0.0, 0.0 }, 0x2aaaaaabu, 0 };
    double position[3] = { 1e6, 0.0, -1e6 }, rotation[4] = { 0.0, 0.6, 0.0, 0.8 };
    (void)state;
    for (uint32_t i = 0; i < 86400u * 60u; i++) {
        noh_root_drive(1, i < 86400u ? &quarter : &sixth, 2.0, position, rotation);
    }
    /* the sixths are 2^-32 turns too long: their sum, in that unit */
    assert_true(fabs(2.0 * atan2(rotation[1], rotation[3]) -
                     remainder(2.0 * atan2(0.6, 0.8) + 6.283185307179586 * (86400.0 * 59.0) / 3.0 / 4294967296.0,
                               6.283185307179586)) < 1e-5);
    assert_true(fabs(rotation[1] * rotation[1] + rotation[3] * rotation[3] - 1.0) < 1e-12);
    assert_true(fabs(position[0] - 1e6) < 1e-3 && fabs(position[2] + 1e6) < 1e-3);
}

/* ---- frames ---- */

typedef struct shot {
    float joints[24][12]; /* less the middle of the picture */
    float sphere[3], held[12];
    noh_actor_detail detail;
    noh_stage_hit hit;
    float direction[3];
    uint32_t joint_count;
} shot;

static void take(float x, uint32_t view_frame, float alpha, shot *out)
{
    const float middle[3] = { x, 0.9f, x };
    const noh_place grip = { .position = { 0.1f, 0.0f, 0.05f }, .scale = 0.1f };
    noh_actor actor, held;
    noh_stage_view view;
    float matrix[12], origin[3];
    cast c;
    cast_open(&c);
    cast_make(&c, NULL);
    memset(out, 0, sizeof *out);
    actor = walker_at(&c, x, x);
    assert_int_equal(noh_stage_spawn(c.stage, TUBES, &grip, &held, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(c.stage, held, actor, 5, NULL), NOH_OK);
    noh_view_orbit(&view, middle, 0.3f + 0.1f * (float)view_frame, 0.2f, 4.0f, 640, 480);
    for (int i = 0; i < 40; i++) {
        assert_int_equal(noh_stage_step(c.stage, CAST_STEP, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_between(c.stage, &view, 1, alpha, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_end(c.stage, NULL), NOH_OK);
    }
    noh_stage_origin(c.stage, origin);
    for (uint32_t j = 0; j < 24 && noh_stage_joint(c.stage, actor, j, out->joints[j], NULL) == NOH_OK; j++) {
        for (int i = 0; i < 3; i++) out->joints[j][4 * i + 3] -= i == 1 ? -origin[1] : x - origin[i];
        out->joint_count++;
        assert_int_equal(noh_actor_joint(c.stage, actor, j, matrix, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) { /* outside it is rounded to a float of the world */
            const float rounding = 1e-4f + fabsf(x) * 6e-8f;
            assert_true(fabsf(matrix[4 * i + 3] - (i == 1 ? 0.0f : x) - out->joints[j][4 * i + 3]) <= 2.0f * rounding);
        }
    }
    noh_stage_world(c.stage, held.id & 0xffffu, out->held);
    assert_int_equal(noh_stage_actor_sphere(c.stage, actor, matrix, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) {
        out->held[4 * i + 3] -= i == 1 ? -origin[1] : x - origin[i];
        out->sphere[i] = matrix[i] - (i == 1 ? -origin[1] : x - origin[i]);
    }
    assert_int_equal(noh_actor_detail_of(c.stage, actor, &out->detail, NULL), NOH_OK);
    assert_true(noh_view_ray(&view, 320.0f, 200.0f, 640, 480, origin, out->direction));
    (void)noh_stage_pick(c.stage, origin, out->direction, 100.0f, &out->hit, NULL);
    cast_close(&c);
}

static float farthest(const float *a, const float *b, uint32_t count)
{
    float worst = 0.0f;
    for (uint32_t i = 0; i < count; i++) worst = fmaxf(worst, fabsf(a[i] - b[i]));
    return worst;
}

/* Joints, actors attached to them, spheres and detail are the same to a tenth of a millimetre, between steps too. */
static void frames_are_the_same_anywhere(void **state)
{
    static const float alphas[] = { 1.0f, 0.37f };
    (void)state;
    for (size_t n = 0; n < TEST_COUNT(alphas); n++) {
        shot here, there;
        take(0.0f, 1, alphas[n], &here);
        assert_true(here.joint_count > 10);
        for (size_t p = 0; p < TEST_COUNT(places); p++) {
            take(places[p], 1, alphas[n], &there);
            assert_int_equal(there.joint_count, here.joint_count);
            assert_true(farthest(here.joints[0], there.joints[0], 12 * here.joint_count) < 1e-4f);
            assert_true(farthest(here.held, there.held, 12) < 1e-4f);
            assert_true(farthest(here.sphere, there.sphere, 3) < 1e-4f);
            assert_true(farthest(here.direction, there.direction, 3) < 1e-5f);
            assert_true(fabsf(here.detail.pixels_per_metre - there.detail.pixels_per_metre) <
                        1e-4f * here.detail.pixels_per_metre);
            assert_int_equal(here.detail.level, there.detail.level);
            assert_int_equal(here.detail.joint_count, there.detail.joint_count);
            /* the ray's origin is a float of the world: so far beside */
            assert_int_equal(here.hit.actor.id != 0, there.hit.actor.id != 0);
            assert_true(fabsf(here.hit.distance - there.hit.distance) < 1e-3f + fabsf(places[p]) * 5e-7f);
        }
    }
}

/* A camera of the game's own, whose floats have lost what they lose, still sees a figure that holds together: only as a
 * whole it is beside. And near the origin nothing is changed, not by a bit. */
static void cameras_without_rests_are_taken(void **state)
{
    const float middle[3] = { 100000.0f, 0.9f, 100000.0f }, zero[3] = { 0.0f, 0.9f, 0.0f };
    noh_stage_view view, less;
    float origin[3];
    (void)state;
    noh_view_orbit(&view, middle, 0.3f, 0.1f, 4.0f, 640, 480);
    memset(view.column_rest, 0, sizeof view.column_rest);
    memset(view.eye_rest, 0, sizeof view.eye_rest);
    noh_view_origin(&view, origin);
    assert_true(origin[0] == 100000.0f && origin[1] == 0.0f && origin[2] == 100000.0f);
    noh_view_less(&view, origin, &less);
    noh_view_orbit(&view, zero, 0.3f, 0.1f, 4.0f, 640, 480);
    assert_true(farthest(less.view_projection, view.view_projection, 12) < 1e-6f); /* all but the last column */
    assert_true(farthest(less.view_projection + 12, view.view_projection + 12, 4) < 0.05f);
    noh_view_origin(&view, origin);
    assert_true(origin[0] == 0.0f && origin[1] == 0.0f && origin[2] == 0.0f);
    noh_view_less(&view, origin, &less);
    assert_memory_equal(&less, &view, sizeof view);
    memset(view.eye, 0, sizeof view.eye); /* one that says not where its eye is */
    noh_view_orbit(&less, middle, 0.3f, 0.1f, 4.0f, 640, 480);
    memset(less.eye, 0, sizeof less.eye);
    noh_view_origin(&less, origin);
    assert_true(fabsf(origin[0] - middle[0]) < 64.0f && fabsf(origin[2] - middle[2]) < 64.0f);
}

/* ---- a world that moves ---- */

/* The plane of the ground, as it is seen from where the origin was moved to. */
static float ground_below(const void *user, const float from[3], float depth, float normal[3])
{
    const float *moved = user;
    const float distance = from[1] - (0.1f * sinf(2.0f * (from[0] + moved[0])) - moved[1]);
    normal[0] = normal[2] = 0.0f;
    normal[1] = 1.0f;
    return distance >= 0.0f && distance <= depth ? distance : -1.0f;
}

typedef struct world {
    float moved[3];
    noh_kind_feet feet;
    noh_gaze_rig gaze;
    noh_modifier parts[2];
    noh_kind_ragdoll ragdoll;
    noh_actor walks, falls, held;
    cast c;
} world;

static void world_open(world *w)
{
    const noh_place grip = { .position = { 0.1f, 0.0f, 0.05f }, .scale = 0.1f }, aside = { .position = { 2, 0, 1 } };
    noh_kind_desc *k;
    noh_ragdoll_source source;
    memset(w, 0, sizeof *w);
    cast_open(&w->c);
    k = &w->c.kinds[PUPPETS];
    memset(&source, 0, sizeof source);
    source.pack = k->mesh;
    assert_int_equal(noh_pack_skeleton_at(k->mesh, 0, &source.joints, NULL, NULL), NOH_OK);
    source.metres = 1.0f;
    assert_int_equal(noh_feet_rig_make(&source, &w->feet.rig, NULL), NOH_OK);
    assert_int_equal(noh_gaze_rig_make(k->mesh, 0, &w->gaze, NULL), NOH_OK);
    w->feet.ground.below = ground_below;
    w->feet.ground.user = w->moved;
    w->parts[0] = noh_gaze_modifier(&w->gaze);
    w->parts[1] = noh_feet_modifier(&w->feet);
    w->ragdoll.count = 1;
    k->modifiers = w->parts;
    k->modifier_count = 2;
    k->ragdoll = noh_ragdoll_module(&w->ragdoll);
    cast_make(&w->c, NULL);
    w->walks = walker_at(&w->c, 1.0f, 2.0f);
    assert_int_equal(noh_stage_spawn(w->c.stage, PUPPETS, &aside, &w->falls, NULL), NOH_OK);
    assert_int_equal(noh_stage_spawn(w->c.stage, TUBES, &grip, &w->held, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(w->c.stage, w->held, w->walks, 5, NULL), NOH_OK);
    noh_gaze *g = noh_actor_modifier(w->c.stage, w->walks, 0);
    g->point[0] = 3.0f, g->point[1] = 1.0f, g->point[2] = 7.0f, g->looks = 1;
}

/* What shows, in the world as it was at first. */
static void world_shows(world *w, int frame, int falls, float *joints)
{
    const float middle[3] = { 1.0f - w->moved[0], 1.0f - w->moved[1], 2.0f - w->moved[2] };
    const noh_actor actors[2] = { w->walks, w->falls };
    noh_stage_view view;
    float matrix[12], origin[3];
    noh_view_orbit(&view, middle, 0.1f, 0.2f, 6.0f, 640, 480);
    if (frame == 10 && falls) assert_int_equal(noh_actor_fall(w->c.stage, w->falls, NULL), NOH_OK);
    assert_int_equal(noh_stage_step(w->c.stage, CAST_STEP, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_between(w->c.stage, &view, 1, 0.5f, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_end(w->c.stage, NULL), NOH_OK);
    noh_stage_origin(w->c.stage, origin);
    for (uint32_t n = 0; n < 13; n++) {
        if (n < 12) {
            assert_int_equal(noh_stage_joint(w->c.stage, actors[n / 6u], 3u * (n % 6u), matrix, NULL), NOH_OK);
        } else {
            noh_stage_world(w->c.stage, w->held.id & 0xffffu, matrix);
        }
        for (int i = 0; i < 3; i++) joints[3u * n + (uint32_t)i] = matrix[4 * i + 3] + (origin[i] + w->moved[i]);
    }
}

/* The origin moves there and back again, time after time, under one of two worlds. Returns how far joints of walkers and
 * what they hold are apart, at most; *fallen: the same for an actor that falls. */
static float shifts(const float by[3], int falls, float *fallen)
{
    const noh_actor nobody = { 0 };
    float a[39], b[39], worst = 0.0f;
    world here, moves;
    world_open(&here);
    world_open(&moves);
    *fallen = 0.0f;
    for (int frame = 0; frame < 90; frame++) {
        if (frame % 20 == 15) {
            const float sign = frame % 40 == 15 ? 1.0f : -1.0f;
            const float way[3] = { sign * by[0], sign * by[1], sign * by[2] };
            assert_int_equal(noh_stage_shift_origin(moves.c.stage, way, NULL), NOH_OK);
            for (int i = 0; i < 3; i++) moves.moved[i] += way[i];
        }
        if (frame == 60) {
            assert_int_equal(noh_actor_attach(here.c.stage, here.held, nobody, 0, NULL), NOH_OK);
            assert_int_equal(noh_actor_attach(moves.c.stage, moves.held, nobody, 0, NULL), NOH_OK);
        }
        world_shows(&here, frame, falls, a);
        world_shows(&moves, frame, falls, b);
        worst = fmaxf(worst, fmaxf(farthest(a, b, 18), farthest(a + 36, b + 36, 3)));
        *fallen = fmaxf(*fallen, farthest(a + 18, b + 18, 18));
    }
    assert_int_equal(noh_stage_shift_origin(here.c.stage, (const float[3]){ NAN, 0.0f, 0.0f }, NULL), NOH_ERR_ARG);
    cast_close(&here.c);
    cast_close(&moves.c);
    return worst;
}

/* No actor shows that the origin moved: one that walks, looks, stands on uneven ground, falls, is held, or was attached
 * and then detached. Joints are compared as floats of the old world, which are within ten metres of its origin. */
static void a_shift_is_not_seen(void **state)
{
    static const float far_off[3] = { 100000.0f, 16.0f, -64000.0f }, near_by[3] = { 64.0f, 16.0f, -32.0f };
    float fallen, worst;
    (void)state;
    worst = shifts(far_off, 0, &fallen);
    print_message("100 km and back: %.3g m, standing %.3g m\n", (double)worst, (double)fallen);
    assert_true(worst < 1e-3f && fallen < 1e-3f); /* the ground is asked for by floats of the world: 4 mm beside */
    worst = shifts(near_by, 1, &fallen);          /* limbs that fall make much of what floats lose */
    print_message("64 m and back: %.3g m, falling %.3g m\n", (double)worst, (double)fallen);
    assert_true(worst < 1e-4f && fallen < 0.05f);
}

/* Views are numbers of the game: what is not finite, or so large that its square is not, is refused; with any others,
 * the largest too, a frame runs, and what it says of its actors are numbers. */
static void wild_views_are_refused(void **state)
{
    static const float wild[] = { NAN, INFINITY, -INFINITY, 3e18f, -FLT_MAX };
    test_random r = test_random_from(19);
    noh_actor actors[CAST_ACTORS];
    noh_stage_view view = cast_view(0, 8.0f), views[3] = { view, view, view };
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    cast_enter(&c, actors);
    for (uint32_t i = 0; i < 29u; i++) { /* of view_projection, eye, light, column_rest, eye_rest */
        float *at = i < 16   ? &view.view_projection[i]
                    : i < 19 ? &view.eye[i - 16]
                    : i < 22 ? &view.light[i - 19]
                    : i < 26 ? &view.column_rest[i - 22]
                             : &view.eye_rest[i - 26];
        const float kept = *at;
        for (uint32_t w = 0; w < sizeof wild / sizeof *wild; w++) {
            noh_error error;
            *at = wild[w];
            views[1] = view;
            assert_int_equal(noh_stage_frame_begin(c.stage, views, 3, &error), NOH_ERR_ARG);
            assert_non_null(strstr(error.what, "of a view: not finite, or too large"));
            assert_int_equal(error.where, 1);
        }
        *at = kept;
    }
    for (uint32_t round = 0; round < 60; round++) {
        static const float sizes[] = { 0.0f, 1e-30f, 1e-9f, 1.0f, 1e9f, 1e18f };
        for (uint32_t i = 0; i < 16; i++)
            view.view_projection[i] = test_random_float(&r, -1.0f, 1.0f) * sizes[test_random_below(&r, 6)];
        for (uint32_t i = 0; i < 3; i++)
            view.eye[i] = test_random_float(&r, -1.0f, 1.0f) * sizes[test_random_below(&r, 6)];
        view.height_px = round & 1 ? 1080 : 0xffffffffu;
        assert_int_equal(noh_stage_frame(c.stage, 800, &view, NULL, NULL, NULL), NOH_OK);
        for (uint32_t i = 0; i < CAST_ACTORS; i++) {
            noh_actor_detail detail;
            if (noh_actor_detail_of(c.stage, actors[i], &detail, NULL) != NOH_OK) continue;
            assert_true(detail.pixels_per_metre >= 0.0f && detail.error_m >= 0.0f);
        }
    }
    cast_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(root_motion_goes_all_the_way), cmocka_unit_test(a_day_of_turns_adds_nothing),
        cmocka_unit_test(frames_are_the_same_anywhere), cmocka_unit_test(cameras_without_rests_are_taken),
        cmocka_unit_test(a_shift_is_not_seen),          cmocka_unit_test(wild_views_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
