/* Tests of rigid.c and contact.c: closed forms of flight, spin, impulses, bounces and friction; rest on
 * every kind of obstacle; overlaps; the same far away and in any pieces of time; point masses.
 * cross: slow, minutes of flight */
#include "life/physics/contact_internal.h"
#include "life/physics/rigid_internal.h"
#include "life/physics/shape_internal.h"
#include "life/physics/world_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include <math.h>
#include <string.h>

#include "support/support.h"

#define FRAME 800u
#define G 9.82

static const float zero[3];
static noh_plane ground = { { 0.0f, 1.0f, 0.0f }, 0.0f };

static noh_world ground_world(float friction, float restitution)
{
    const noh_world w = { .planes = &ground, .plane_count = 1, .friction = friction, .restitution = restitution };
    return w;
}

static noh_rigid made(float x, float y, float z, float radius, float height)
{
    const noh_rigid_desc desc = { .half = { x, y, z }, .radius = radius, .mass = 3.0f, .position = { 0, height, 0 } };
    noh_rigid body;
    assert_int_equal(noh_rigid_init(&body, &desc, NULL), NOH_OK);
    return body;
}

static void run(noh_rigid *body, const noh_world *world, uint32_t frames)
{
    for (uint32_t i = 0; i < frames; i++) noh_rigid_step(body, world, NULL, FRAME);
}

static float height_of(const noh_rigid *body)
{
    float p[3], q[4];
    noh_rigid_place(body, p, q);
    return p[1];
}

/* ---- flight ---- */

static void it_falls_by_half_g_t_squared(void **state)
{
    (void)state;
    for (float far = 0.0f; far < 2e5f; far = far * 10.0f + 1000.0f) {
        const float by[3] = { far, far, -far }, back[3] = { -far, -far, far }, along[3] = { 2.0f, 3.0f, 0.0f };
        float p[3], q[4];
        noh_rigid body = made(0.1f, 0.2f, 0.3f, 0.0f, 0.0f);
        noh_rigid_set_motion(&body, along, zero, NULL);
        noh_rigid_shift(&body, by);
        run(&body, NULL, 120);
        noh_rigid_shift(&body, back);
        noh_rigid_place(&body, p, q);
        assert_true(fabs((double)p[0] - 4.0) < 2e-4 && fabs((double)p[1] - (6.0 - 2.0 * G)) < 2e-4);
    }
}

static void a_torque_spins_it_up(void **state)
{
    const float torque[3] = { 0.0f, 0.6f, 0.0f }, none[3] = { 0.0f, 0.0f, 0.0f };
    float spin[3], p[3], q[4];
    (void)state;
    noh_rigid body = made(0.2f, 0.1f, 0.3f, 0.0f, 0.0f); /* I_y = 3 / 3 (0.04 + 0.09) = 0.13 */
    for (int i = 0; i < 30; i++) {
        noh_rigid_torque(&body, torque);
        noh_rigid_step(&body, NULL, none, FRAME);
    }
    noh_rigid_motion(&body, NULL, spin, NULL);
    noh_rigid_place(&body, p, q);
    assert_true(fabs((double)spin[1] - 0.6 / 0.13 * 0.5) < 1e-4);
    assert_true(fabs(2.0 * atan2((double)q[1], (double)q[3]) - 0.5 * 0.6 / 0.13 * 0.25) < 1e-4);
    run(&body, NULL, 1);
    noh_rigid_motion(&body, NULL, spin, NULL);
    assert_true(fabs((double)spin[1] - 0.6 / 0.13 * 0.5) < 1e-4); /* torques last for one step */
}

/* F / m, and (p - x) x F; an impulse likewise, at once. The source's bodies take forces at their middles alone. */
static void a_force_at_a_point_turns_it(void **state)
{
    const float force[3] = { 0.0f, 0.0f, 12.0f }, none[3] = { 0.0f, 0.0f, 0.0f };
    float v[3], w[3], l[3];
    (void)state;
    for (int impulse = 0; impulse < 2; impulse++) {
        noh_rigid body = made(0.2f, 0.1f, 0.3f, 0.0f, 5.0f);
        const float point[3] = { 0.2f, 5.1f, 0.0f };
        if (impulse) {
            noh_rigid_push(&body, point, force);
        } else {
            noh_rigid_force(&body, point, force);
            noh_rigid_step(&body, NULL, none, FRAME);
        }
        const double t = impulse ? 1.0 : 1.0 / 60.0;
        noh_rigid_motion(&body, v, w, l);
        assert_true(fabs((double)v[2] - 4.0 * t) < 1e-5 && v[0] == 0.0f && v[1] == 0.0f);
        assert_true(fabs((double)l[0] - 0.1 * 12.0 * t) < 1e-5 && fabs((double)l[1] + 0.2 * 12.0 * t) < 1e-5);
        if (!impulse) continue;
        assert_true(fabs((double)w[0] - 1.2 / 0.1) < 1e-3 && fabs((double)w[1] + 2.4 / 0.13) < 1e-3);
        assert_true(fabs((double)noh_rigid_energy(&body) - 0.5 * (3.0 * 16.0 + 1.44 / 0.1 + 5.76 / 0.13)) < 1e-2);
    }
}

/* About the middle axis of inertia it tumbles for ever; momentum and energy stay. */
static void a_free_body_tumbles_on(void **state)
{
    const float spin[3] = { 0.05f, 0.02f, 12.0f }, none[3] = { 0.0f, 0.0f, 0.0f };
    float began[3], now[3], w[3], p[3], q[4];
    double most = 0.0, least = 1e9, worst = 0.0;
    (void)state;
    noh_rigid body = made(0.1f, 0.3f, 0.2f, 0.0f, 0.0f);
    body.inertia[0] = 0.3f;
    body.inertia[1] = 0.1f;
    body.inertia[2] = 0.2f;
    noh_rigid_set_motion(&body, none, spin, NULL);
    noh_rigid_motion(&body, NULL, NULL, began);
    const double energy = (double)noh_rigid_energy(&body);
    for (int i = 0; i < 7200; i++) {
        noh_rigid_step(&body, NULL, none, FRAME);
        noh_rigid_motion(&body, NULL, w, now);
        noh_rigid_place(&body, p, q);
        noh_quat_conjugate(q, q);
        noh_quat_rotate(q, w, w); /* about its own axes */
        const double e = (double)noh_rigid_energy(&body) / energy;
        worst = fabs(e - 1.0) > worst ? fabs(e - 1.0) : worst;
        most = (double)w[2] > most ? (double)w[2] : most;
        least = (double)w[2] < least ? (double)w[2] : least;
    }
    assert_memory_equal(now, began, sizeof now);
    print_message("energy within %.5f, spin %.1f..%.1f\n", worst, least, most);
    assert_true(worst < 1e-3 && least < 11.0); /* it has turned over */
}

/* ---- contacts ---- */

static void it_bounces_to_e_squared(void **state)
{
    const float shapes[4][5] = { { 0.0f, 0.0f, 0.0f, 0.2f, 0.2f },
                                 { 0.2f, 0.1f, 0.3f, 0.0f, 0.1f },
                                 { 0.0f, 0.0f, 0.3f, 0.1f, 0.1f },
                                 { 0.2f, 0.1f, 0.2f, 0.05f, 0.15f } };
    (void)state;
    for (int s = 0; s < 4; s++) {
        for (int i = 0; i <= 4; i++) {
            const float e = 0.25f * (float)i, *shape = shapes[s];
            const noh_world world = ground_world(0.5f, e);
            noh_rigid body = made(shape[0], shape[1], shape[2], shape[3], shape[4] + 1.0f);
            float top = 0.0f;
            for (int n = 0; n < 60; n++) {
                run(&body, &world, 1);
                if (n > 29 && height_of(&body) > top) top = height_of(&body);
            }
            assert_true(fabsf(top - shape[4] - e * e) < 0.012f);
            run(&body, &world, i < 4 ? 1200 : 0);
            print_message("shape %d, restitution %.2f: %.4f m, at rest %.4f\n", s, (double)e, (double)(top - shape[4]),
                          (double)(height_of(&body) - shape[4]));
            assert_true(i == 4 || (noh_rigid_sleeps(&body) && fabsf(height_of(&body) - shape[4]) < 0.0005f));
        }
    }
}

/* v^2 / (2 mu g), and down a slope that is steeper than its friction holds g (sin - mu cos). */
static void friction_stops_it(void **state)
{
    const noh_world world = ground_world(0.5f, 0.0f);
    const float along[3] = { 3.0f, 0.0f, 0.0f };
    float p[3], q[4];
    (void)state;
    noh_rigid body = made(0.3f, 0.1f, 0.2f, 0.0f, 0.1f);
    noh_rigid_set_motion(&body, along, zero, NULL);
    run(&body, &world, 120);
    noh_rigid_place(&body, p, q);
    print_message("slides %.4f m of %.4f\n", (double)p[0], 9.0 / (2.0 * 0.5 * G));
    assert_true(fabs((double)p[0] / (9.0 / (2.0 * 0.5 * G)) - 1.0) < 0.01 && fabsf(p[2]) < 0.01f);

    for (int i = 0; i < 2; i++) { /* 30 degrees: tan is 0.577 */
        const float mu = i ? 0.3f : 0.7f;
        noh_plane slope = { { 0.5f, 0.8660254f, 0.0f }, 0.0f };
        noh_rigid_desc desc = { .half = { 0.3f, 0.1f, 0.2f }, .mass = 3.0f };
        const noh_world hill = { .planes = &slope, .plane_count = 1, .friction = mu };
        const float turn[3] = { 0.0f, 0.0f, -0.52359878f };
        for (int k = 0; k < 3; k++) desc.position[k] = 0.1f * slope.normal[k];
        noh_quat_from_rotation(turn, desc.rotation);
        assert_int_equal(noh_rigid_init(&body, &desc, NULL), NOH_OK);
        run(&body, &hill, 60);
        noh_rigid_place(&body, p, q);
        const double way = (double)p[0] * 0.8660254 - (double)p[1] * 0.5;
        const double wanted = i ? 0.5 * G * (0.5 - 0.3 * 0.8660254) : 0.0;
        assert_true(fabs(way - wanted) < 0.01);
    }
}

/* A ball that slides begins to roll: it keeps 5/7 of its speed. */
static void a_ball_begins_to_roll(void **state)
{
    const noh_world world = ground_world(0.4f, 0.0f);
    const float along[3] = { 3.5f, 0.0f, 0.0f };
    float v[3], w[3];
    (void)state;
    noh_rigid body = made(0.0f, 0.0f, 0.0f, 0.25f, 0.25f);
    noh_rigid_set_motion(&body, along, zero, NULL);
    run(&body, &world, 60);
    noh_rigid_motion(&body, v, w, NULL);
    assert_true(fabsf(v[0] - 2.5f) < 0.03f && fabsf(w[2] + v[0] / 0.25f) < 0.15f);
}

/* How far the lowest point of it is off the highest of what it should lie on. */
static void rests_at(const noh_world *world, noh_rigid *body, float height)
{
    run(body, world, 600);
    print_message("rests at %.4f of %.4f, %s\n", (double)height_of(body), (double)height,
                  noh_rigid_sleeps(body) ? "asleep" : "awake");
    assert_true(fabsf(height_of(body) - height) < 0.002f && noh_rigid_sleeps(body));
}

static void it_rests_on_everything(void **state)
{
    static uint16_t heights[16];
    const noh_field field = { heights, 4, 4, { -3.0f, 0.5f, -3.0f }, 2.0f, 1.0f };
    const noh_obb box = { { 0.0f, 0.25f, 0.0f }, { 1.0f, 0.25f, 1.0f }, { 0.0f, 0.38268343f, 0.0f, 0.92387953f } };
    const noh_obb beam = { { 0.0f, 0.4f, 0.0f }, { 0.1f, 0.1f, 2.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_capsule rails[2] = { { { -0.25f, 0.3f, -2.0f }, { -0.25f, 0.3f, 2.0f }, 0.2f },
                                   { { 0.25f, 0.3f, -2.0f }, { 0.25f, 0.3f, 2.0f }, 0.2f } };
    const noh_world worlds[4] = { { .field = &field, .friction = 0.6f },
                                  { .boxes = &box, .box_count = 1, .friction = 0.6f },
                                  { .boxes = &beam, .box_count = 1, .friction = 0.6f },
                                  { .capsules = rails, .capsule_count = 2, .friction = 0.6f } };
    (void)state;
    for (int i = 0; i < 4; i++) {
        noh_rigid plank = made(0.6f, 0.05f, 0.06f, 0.0f, 0.75f), block = made(0.3f, 0.2f, 0.3f, 0.0f, 0.9f);
        noh_rigid rod = made(0.0f, 0.0f, 0.5f, 0.08f, 0.8f);
        rests_at(&worlds[i], &plank, 0.55f);
        rests_at(&worlds[i], &block, 0.7f);
        if (i < 2) rests_at(&worlds[i], &rod, 0.58f);
    }
    noh_rigid_desc across = { .half = { 0.0f, 0.0f, 0.6f }, .radius = 0.08f, .mass = 3.0f, .position = { 0, 0.8f, 0 } };
    across.rotation[1] = across.rotation[3] = 0.70710678f; /* a rod over the beam, and over both rails */
    for (int i = 2; i < 4; i++) {
        noh_rigid rod;
        assert_int_equal(noh_rigid_init(&rod, &across, NULL), NOH_OK);
        rests_at(&worlds[i], &rod, 0.58f);
    }
}

/* Thrown about, it ends on the ground or on what lies there, at rest, and was never shot away. */
static void anything_comes_to_rest(void **state)
{
    const noh_obb box = { { -0.4f, 0.2f, -0.2f }, { 0.3f, 0.2f, 0.3f }, { 0.0f, 0.38268343f, 0.0f, 0.92387953f } };
    const noh_capsule pill = { { 0.2f, 0.1f, 0.5f }, { 1.0f, 0.3f, 0.5f }, 0.15f };
    const float shapes[4][4] = {
        { 0.2f, 0.1f, 0.3f, 0.0f }, { 0.0f, 0.0f, 0.2f, 0.1f }, { 0.0f, 0.0f, 0.0f, 0.2f }, { 0.3f, 0.02f, 0.3f, 0.01f }
    };
    noh_world world = ground_world(0.6f, 0.2f);
    uint32_t seed = 5, asleep = 0;
    (void)state;
    world.boxes = &box;
    world.capsules = &pill;
    world.box_count = world.capsule_count = 1;
    for (int i = 0; i < 64; i++) {
        const float *shape = shapes[i % 4];
        noh_rigid body = made(shape[0], shape[1], shape[2], shape[3], 1.0f);
        float r[10], p[3], q[4], top = 0.0f;
        for (int k = 0; k < 10; k++) {
            seed = seed * 1664525u + 1013904223u;
            r[k] = (float)((double)(seed >> 8) / 8388608.0 - 1.0);
        }
        noh_quat_from_rotation(r, body.rotation);
        body.position[0] = r[3] * 0.7f;
        body.position[1] = r[4] * 0.8f; /* many begin inside of something */
        body.position[2] = r[5] * 0.7f;
        noh_rigid_set_motion(&body, r + 3, r + 6, NULL);
        for (int n = 0; n < 900; n++) {
            run(&body, &world, 1);
            top = height_of(&body) > top ? height_of(&body) : top;
        }
        noh_rigid_place(&body, p, q);
        asleep += i % 4 == 1 || i % 4 == 2 ? 0 : (uint32_t)noh_rigid_sleeps(&body); /* balls and rods roll on */
        assert_true(p[1] > 0.005f && top < 2.2f && (i % 4 == 1 || i % 4 == 2 || fabsf(p[0]) + fabsf(p[2]) < 3.0f));
    }
    print_message("%u of 32 sleep\n", (unsigned)asleep);
    assert_true(asleep >= 31); /* a plate that begins across a corner may stay wedged there */
}

/* Begun inside, it comes out at the speed that body.h states, and not faster. */
static void it_leaves_what_it_begins_in(void **state)
{
    const noh_obb box = { { 0.0f, 0.0f, 0.0f }, { 0.5f, 0.5f, 0.5f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_capsule post = { { 0.1f, -1.0f, 0.0f }, { 0.1f, 1.0f, 0.0f }, 0.2f };
    const noh_world worlds[3] = { ground_world(0.5f, 0.5f),
                                  { .boxes = &box, .box_count = 1, .restitution = 0.5f },
                                  { .capsules = &post, .capsule_count = 1, .restitution = 0.5f } };
    const float none[3] = { 0.0f, 0.0f, 0.0f };
    (void)state;
    for (int i = 0; i < 3; i++) {
        noh_rigid body = made(0.2f, 0.1f, 0.3f, 0.0f, i ? 0.0f : -0.5f);
        float p[3], q[4], last[3], most = 0.0f;
        noh_rigid_place(&body, last, q);
        for (int n = 0; n < 120; n++) {
            noh_rigid_step(&body, &worlds[i], none, FRAME);
            noh_rigid_place(&body, p, q);
            const float x = p[0] - last[0], y = p[1] - last[1], z = p[2] - last[2], far = sqrtf(x * x + y * y + z * z);
            most = far > most ? far : most;
            memcpy(last, p, sizeof p);
        }
        print_message("world %d: up to %.2f m/s, at %.3f %.3f %.3f\n", i, 60.0 * (double)most, (double)p[0],
                      (double)p[1], (double)p[2]);
        assert_true(most * 60.0f < 1.1f * NOH_PUSH_OUT_SPEED);
        if (i == 0) assert_true(p[1] > 0.09f);
        noh_obb now = { { p[0], p[1], p[2] }, { 0.19f, 0.09f, 0.29f }, { q[0], q[1], q[2], q[3] } };
        const noh_obb core = { { 0.1f, 0.0f, 0.0f }, { 0.13f, 1.0f, 0.13f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
        if (i) assert_false(noh_obb_overlap(&now, i == 1 ? &box : &core));
    }
}

/* ---- time and place ---- */

static void pieces_and_places_do_not_matter(void **state)
{
    static const float bases[2][3] = { { 0.0f, 512.0f, 0.0f }, { 100000.0f, 10000.0f, -100000.0f } };
    const float spin[3] = { 3.0f, 5.0f, 2.0f }, along[3] = { 1.0f, 0.0f, 2.0f };
    const noh_world world = ground_world(0.5f, 0.4f);
    (void)state;
    noh_rigid whole = made(0.2f, 0.1f, 0.3f, 0.02f, 1.0f), cut = whole;
    noh_rigid_set_motion(&whole, along, spin, NULL);
    noh_rigid_set_motion(&cut, along, spin, NULL);
    noh_rigid begun = whole;
    run(&whole, &world, 100);
    for (uint32_t ticks = 0; ticks < 100 * FRAME; ticks += 100) noh_rigid_step(&cut, &world, NULL, 100);
    assert_memory_equal(&cut, &whole, sizeof cut);
    for (int i = 0; i < 2; i++) {
        noh_plane there = { { 0.0f, 1.0f, 0.0f }, bases[i][1] };
        const noh_world far = { .planes = &there, .plane_count = 1, .friction = 0.5f, .restitution = 0.4f };
        noh_rigid body = begun;
        noh_rigid_shift(&body, bases[i]);
        run(&body, &far, 100);
        for (int k = 0; k < 3; k++) body.origin[k] -= bases[i][k];
        assert_memory_equal(&body, &whole, sizeof body);
    }
    assert_int_equal(noh_rigid_step(&whole, &world, NULL, 48000), 36000);
}

static void bad_bodies_are_refused(void **state)
{
    const noh_rigid_desc good = { .half = { 0.1f, 0.1f, 0.1f }, .mass = 1.0f };
    const float nan3[3] = { NAN, 0.0f, 0.0f };
    noh_rigid body;
    noh_error error;
    (void)state;
    for (int i = 0; i < 9; i++) {
        noh_rigid_desc d = good;
        if (i == 0) d.half[1] = -0.1f;
        if (i == 1) d.half[0] = d.half[1] = d.half[2] = 0.0f;
        if (i == 2) d.radius = NAN;
        if (i == 3) d.mass = 0.0f;
        if (i == 4) d.mass = INFINITY;
        if (i == 5) d.inertia[1] = 1.0f;
        if (i == 6) d.position[2] = 2.0f * NOH_NUMBER_MAX;
        if (i == 7) d.rotation[0] = 2.0f;
        if (i == 8) d.half[0] = d.half[1] = 0.0f; /* a line without a radius */
        assert_int_equal(noh_rigid_init(&body, &d, &error), NOH_ERR_ARG);
    }
    assert_int_equal(noh_rigid_init(&body, &good, NULL), NOH_OK);
    const noh_rigid before = body;
    assert_int_equal(noh_rigid_set_motion(&body, nan3, zero, NULL), NOH_ERR_ARG);
    noh_rigid_push(&body, nan3, zero);
    noh_rigid_force(&body, zero, nan3);
    noh_rigid_torque(&body, nan3);
    assert_memory_equal(&body, &before, sizeof body);
}

/* A heavy body keeps the spin that it gets; what is cut is cut about the body's own axes. */
static void large_inertias_keep_their_spin(void **state)
{
    static const float half[4] = { 0.0f, 0.3826834f, 0.0f, 0.9238795f }, slow[3] = { 0.3f, 1.0f, -0.2f };
    static const float fast[3] = { 0.0f, 9e11f, 0.0f }, huge[3] = { 1e20f, 0.0f, 0.0f };
    noh_rigid_desc d = { .half = { 100.0f, 50.0f, 100.0f }, .mass = 1e9f };
    float spin[3];
    noh_rigid body;
    (void)state;
    memcpy(d.rotation, half, sizeof half);
    assert_int_equal(noh_rigid_init(&body, &d, NULL), NOH_OK);
    assert_int_equal(noh_rigid_set_motion(&body, zero, slow, NULL), NOH_OK);
    noh_rigid_motion(&body, NULL, spin, NULL);
    for (int k = 0; k < 3; k++) assert_true(fabsf(spin[k] - slow[k]) < 1e-5f);
    for (int i = 0; i < 2; i++) { /* of very different inertias, about the axis of the least */
        d = (noh_rigid_desc){ .half = { 0.1f, 0.1f, 0.1f }, .mass = 1.0f, .inertia = { 1e-4f, 1e-6f, 1e-4f } };
        assert_int_equal(noh_rigid_init(&body, &d, NULL), NOH_OK);
        assert_int_equal(noh_rigid_set_motion(&body, zero, i ? fast : slow, NULL), NOH_OK);
        noh_rigid_motion(&body, NULL, spin, NULL);
        for (int k = 0; k < 3; k++) {
            const float meant = i ? fast[k] : slow[k];
            assert_true(fabsf(spin[k] - meant) <= 1e-5f * fabsf(meant));
        }
    }
    noh_rigid_torque(&body, huge);
    noh_rigid_step(&body, NULL, NULL, 4800);
    noh_rigid_motion(&body, NULL, spin, NULL);
    for (int k = 0; k < 3; k++) assert_true(fabsf(spin[k]) <= 2.0f * NOH_NUMBER_MAX);
}

static void extreme_pushes_keep_numbers(void **state)
{
    static const float sizes[] = { 1.0f, 1e12f, 1e20f, 3e38f };
    const noh_rigid_desc desc = { .half = { 0.5f, 0.2f, 0.3f }, .mass = 1.0f, .position = { 0.0f, 0.5f, 0.0f } };
    const noh_world world = ground_world(0.5f, 0.2f);
    (void)state;
    for (int i = 0; i < 48; i++) {
        const float point[3] = { sizes[i % 4], 0.0f, 1.0f }, by[3] = { 1.0f, sizes[i / 4 % 4], -2.0f };
        float place[3], rotation[4], velocity[3], spin[3], sum = 0.0f;
        noh_rigid body;
        assert_int_equal(noh_rigid_init(&body, &desc, NULL), NOH_OK);
        if (i < 16) noh_rigid_push(&body, point, by);
        if (i >= 16 && i < 32) noh_rigid_force(&body, point, by);
        if (i >= 32) noh_rigid_torque(&body, by);
        run(&body, &world, 30);
        noh_rigid_place(&body, place, rotation);
        noh_rigid_motion(&body, velocity, spin, NULL);
        for (int k = 0; k < 3; k++) sum += 0.0f * (place[k] + rotation[k] + velocity[k] + spin[k]);
        assert_true(sum == 0.0f);
    }
    noh_rigid body;
    assert_int_equal(noh_rigid_init(&body, &desc, NULL), NOH_OK);
    assert_int_equal(noh_rigid_set_motion(&body, (const float[3]){ 0.0f, 1e13f, 0.0f }, zero, NULL), NOH_ERR_ARG);
}

/* ---- point masses ---- */

static void points_bounce_and_slide(void **state)
{
    static const float gravity[3] = { 0.0f, -9.82f, 0.0f };
    const float h = 1.0f / 600.0f;
    (void)state;
    for (int i = 0; i <= 4; i++) {
        const noh_world world = ground_world(0.0f, 0.25f * (float)i);
        float p[3] = { 0.0f, 1.05f, 0.0f }, v[3] = { 0.0f, 0.0f, 0.0f }, top = 0.0f;
        for (int n = 0; n < 600; n++) {
            noh_point_move(p, v, gravity, h);
            noh_point_touch(&world, 0.05f, p, v, h);
            top = n > 300 && p[1] > top ? p[1] : top;
        }
        assert_true(fabsf(top - 0.05f - world.restitution * world.restitution) < 0.012f);
    }
    const noh_world world = ground_world(0.5f, 0.0f);
    float p[3] = { 0.0f, 0.05f, 0.0f }, v[3] = { 3.0f, 0.0f, 0.0f };
    for (int n = 0; n < 900; n++) {
        noh_point_move(p, v, gravity, h);
        noh_point_touch(&world, 0.05f, p, v, h);
    }
    assert_true(fabs((double)p[0] / (9.0 / (2.0 * 0.5 * G)) - 1.0) < 0.01);
}

/* Two points on a rod, by Verlet: the one that meets the ground comes back with a share of its speed. */
static void ends_of_rods_bounce(void **state)
{
    static const float gravity[3] = { 0.0f, -9.82f, 0.0f };
    const float h = 1.0f / 600.0f;
    (void)state;
    for (int i = 0; i < 2; i++) {
        const noh_world world = ground_world(0.0f, i ? 0.6f : 0.0f);
        float at[2][3] = { { 0.0f, 1.0f, 0.0f }, { 0.5f, 1.0f, 0.0f } }, before[2][3], top = 0.0f;
        memcpy(before, at, sizeof at);
        for (int n = 0; n < 480; n++) {
            for (int k = 0; k < 2; k++) noh_verlet_move(at[k], before[k], gravity, h, h, 1.0f);
            noh_distance_keep(at[0], 1.0f, at[1], 1.0f, 0.5f, 0.0f, h, NULL);
            for (int k = 0; k < 2; k++) {
                float v[3];
                for (int m = 0; m < 3; m++) v[m] = (at[k][m] - before[k][m]) / h;
                if (!noh_point_touch(&world, 0.0f, at[k], v, h)) continue;
                for (int m = 0; m < 3; m++) before[k][m] = at[k][m] - h * v[m];
            }
            if (n > 290 && at[0][1] > top) top = at[0][1];
        }
        assert_true(fabsf(top - (i ? 0.36f : 0.0f)) < 0.02f);
    }
}

/* What gravity brings within four steps does not bounce, so that a point comes to rest; what comes faster does. */
static void points_at_rest_do_not_bounce(void **state)
{
    static const float steps_a_second[3] = { 60.0f, 600.0f, 4800.0f };
    const noh_world world = ground_world(0.0f, 0.5f);
    (void)state;
    for (int s = 0; s < 3; s++) {
        const float h = 1.0f / steps_a_second[s], brought = 9.82f * h;
        for (int n = 1; n < 10; n++) {
            const float speed = brought * ((float)n + 0.5f);
            float p[3] = { 0.0f, 0.0499f, 0.0f }, v[3] = { 0.0f, -speed, 0.0f };
            assert_int_equal(noh_point_touch(&world, 0.05f, p, v, h), 1);
            assert_true(fabsf(v[1] - (n < 4 ? 0.0f : 0.5f * speed)) <= 1e-6f * speed);
        }
    }
}

static void points_leave_what_they_begin_in(void **state)
{
    const noh_obb box = { { 100000.0f, 0.0f, 0.0f }, { 1.0f, 1.0f, 1.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_world world = { .boxes = &box, .box_count = 1 };
    float p[3] = { 100000.5f, 0.0f, 0.0f }, v[3] = { 0.0f, 0.0f, 0.0f };
    (void)state;
    for (int i = 0; i < 12; i++) assert_int_equal(noh_point_touch(&world, 0.1f, p, v, 1.0f / 60.0f), 1);
    assert_true(p[0] > 100000.6f && p[0] < 100000.75f && v[0] == 0.0f);
}

/* A cube that stands on a corner, whichever way it is turned, touches the middle of a plate with that corner alone. */
static void a_corner_touches_a_side(void **state)
{
    test_random r = test_random_from(14);
    const noh_obb plate = { { 0.0f, -1.0f, 0.0f }, { 3.0f, 1.0f, 3.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_world on_plate = { .boxes = &plate, .box_count = 1 };
    const float origin[3] = { 0.0f, 0.0f, 0.0f };
    (void)state;
    for (int round = 0; round < 200; round++) {
        noh_round_box cube = { { { 0.0f, 0.0f, 0.0f }, { 0.5f, 0.5f, 0.5f }, { 0.0f, 0.0f, 0.0f, 1.0f } }, 0.0f };
        float lowest[3] = { 0.0f, 1.0f, 0.0f }, next = 1.0f;
        noh_contacts contacts;
        for (int i = 0; i < 4; i++) cube.box.rotation[i] = test_random_float(&r, -1.0f, 1.0f);
        noh_quat_normalize(cube.box.rotation);
        for (uint32_t i = 0; i < 8; i++) {
            float corner[3];
            for (uint32_t k = 0; k < 3; k++) corner[k] = i >> k & 1u ? 0.5f : -0.5f;
            noh_quat_rotate(cube.box.rotation, corner, corner);
            next = fminf(next, fmaxf(corner[1], lowest[1]));
            if (corner[1] < lowest[1]) memcpy(lowest, corner, sizeof lowest);
        }
        if (next - lowest[1] < 0.1f) continue; /* it stands on an edge, nearly */
        cube.box.centre[1] = -lowest[1] - 0.01f;
        noh_contacts_find(&on_plate, origin, &cube, &contacts);
        assert_int_equal(contacts.count, 1);
        assert_float_equal(contacts.at[0].gap, -0.01f, 1e-5f);
        assert_true(contacts.at[0].normal[1] > 0.99999f);
        assert_float_equal(contacts.at[0].point[0], lowest[0], 1e-5f);
        assert_float_equal(contacts.at[0].point[2], lowest[2], 1e-5f);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(it_falls_by_half_g_t_squared),
    cmocka_unit_test(a_torque_spins_it_up),
    cmocka_unit_test(a_force_at_a_point_turns_it),
    cmocka_unit_test(a_free_body_tumbles_on),
    cmocka_unit_test(it_bounces_to_e_squared),
    cmocka_unit_test(friction_stops_it),
    cmocka_unit_test(a_ball_begins_to_roll),
    cmocka_unit_test(it_rests_on_everything),
    cmocka_unit_test(anything_comes_to_rest),
    cmocka_unit_test(it_leaves_what_it_begins_in),
    cmocka_unit_test(pieces_and_places_do_not_matter),
    cmocka_unit_test(bad_bodies_are_refused),
    cmocka_unit_test(a_corner_touches_a_side),
    cmocka_unit_test(large_inertias_keep_their_spin),
        cmocka_unit_test(extreme_pushes_keep_numbers),
    cmocka_unit_test(points_bounce_and_slide),
    cmocka_unit_test(ends_of_rods_bounce),
    cmocka_unit_test(points_at_rest_do_not_bounce),
    cmocka_unit_test(points_leave_what_they_begin_in),
};

TEST_MAIN(tests, NULL, NULL)
