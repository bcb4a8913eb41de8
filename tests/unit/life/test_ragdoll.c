/* Tests of ragdoll.c and ragdoll_lanes.c: closed forms, energy, torture, and the same bits at every width.
 * cross: slow, minutes of falls */
#include "life/physics/world_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/ragdoll_kernels.h"
#include "support/support.h"

#define PI 3.14159265358979
#define FRAME NOH_RAGDOLL_STEP_TICKS

static const float upright[4] = { -0.70710678f, 0.0f, 0.0f, 0.70710678f }; /* z of the capsule is +y */
static const float unturned[4] = { 0.0f, 0.0f, 0.0f, 1.0f };

static noh_plane ground = { { 0.0f, 1.0f, 0.0f }, 0.0f };

static noh_world ground_world(float friction)
{
    const noh_world w = { .planes = &ground, .plane_count = 1, .friction = friction };
    return w;
}

/* ---- rigs ---- */

static noh_ragdoll_body rod(uint32_t parent, float half, float radius, float mass)
{
    noh_ragdoll_body b = { .parent = parent, .half = half, .radius = radius, .mass = mass };
    const float length = 2.0f * (half + radius);
    b.inertia_across = mass * (length * length / 12.0f + radius * radius * 0.25f);
    b.inertia_along = mass * radius * radius * 0.5f;
    memcpy(b.rotation, upright, sizeof upright);
    return b;
}

/* Bodies that hang below each other, 200 mm each, from one at 2 m. */
static noh_ragdoll_rig chain(uint32_t count, uint32_t flags)
{
    noh_ragdoll_rig rig;
    memset(&rig, 0, sizeof rig);
    rig.body_count = count;
    for (uint32_t i = 0; i < count; i++) {
        rig.bodies[i] = rod(i ? i - 1u : NOH_NONE, 0.06f, 0.04f, 2.0f);
        rig.bodies[i].position[1] = 2.0f - 0.2f * (float)i;
        rig.joints[i].flags = flags;
        rig.joints[i].anchor[1] = 2.1f - 0.2f * (float)i;
        memcpy(rig.joints[i].frame, flags & NOH_RAGDOLL_HINGE ? unturned : upright, sizeof upright);
        for (int k = 0; k < 2; k++) {
            rig.joints[i].swing_min[k] = -0.6f;
            rig.joints[i].swing_max[k] = 0.6f;
        }
        rig.joints[i].twist_min = -0.3f;
        rig.joints[i].twist_max = 0.5f;
    }
    return rig;
}

/* Trunk, two arms of three bodies, two legs of three: 14. */
static noh_ragdoll_rig figure_rig(void)
{
    noh_ragdoll_rig rig;
    memset(&rig, 0, sizeof rig);
    rig.body_count = 14;
    for (uint32_t i = 0; i < 14; i++) {
        const uint32_t limb = i < 2 ? 0 : (i - 2) / 3, part = i < 2 ? 0 : (i - 2) % 3;
        const uint32_t parent = i == 0 ? NOH_NONE : i == 1 ? 0 : part ? i - 1 : limb < 2 ? 1 : 0;
        noh_ragdoll_joint *j = &rig.joints[i];
        rig.bodies[i] = rod(parent, i < 2 ? 0.06f : 0.08f, i < 2 ? 0.11f : 0.05f, i < 2 ? 18.0f : 6.0f - (float)part);
        rig.bodies[i].position[0] = i < 2 ? 0.0f : (limb % 2 ? -1.0f : 1.0f) * (limb < 2 ? 0.2f : 0.1f);
        rig.bodies[i].position[1] = i < 2 ? 1.0f + 0.3f * (float)i : (limb < 2 ? 1.25f : 0.75f) - 0.25f * (float)part;
        memcpy(j->anchor, rig.bodies[i].position, sizeof j->anchor);
        j->anchor[1] += i == 1 ? -0.15f : 0.125f;
        j->flags = part == 1 ? NOH_RAGDOLL_HINGE : 0;
        memcpy(j->frame, part == 1 ? unturned : upright, sizeof upright);
        if (part == 1) { /* z of the hinge is x of the world */
            const float across[4] = { 0.0f, 0.70710678f, 0.0f, 0.70710678f };
            memcpy(j->frame, across, sizeof across);
        }
        for (int k = 0; k < 2; k++) {
            j->swing_min[k] = -0.5f;
            j->swing_max[k] = k ? 0.9f : 0.7f;
        }
        j->twist_min = part == 1 ? -2.0f : -0.4f;
        j->twist_max = part == 1 ? 0.1f : 0.4f;
        j->friction = 2.0f;
    }
    rig.pair_count = 2;
    rig.pairs[0][0] = 9;
    rig.pairs[0][1] = 12;
    rig.pairs[1][0] = 3;
    rig.pairs[1][1] = 8;
    noh_ragdoll_stabilize(&rig);
    return rig;
}

static noh_ragdolls *made(const noh_ragdoll_rig *rig, uint32_t count, uint32_t substeps)
{
    const noh_ragdolls_desc desc = { rig, count, substeps, 0 };
    noh_ragdolls *set;
    void *memory = malloc(noh_ragdolls_size(&desc));
    assert_int_equal(noh_ragdolls_init(memory, noh_ragdolls_size(&desc), &desc, &set, NULL), NOH_OK);
    return set;
}

static void rest_poses(const noh_ragdoll_rig *rig, noh_ragdoll_pose *poses)
{
    for (uint32_t i = 0; i < rig->body_count; i++) {
        memcpy(poses[i].position, rig->bodies[i].position, sizeof poses[i].position);
        memcpy(poses[i].rotation, rig->bodies[i].rotation, sizeof poses[i].rotation);
    }
}

static uint32_t seed = 1;

static float random_float(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)((double)(seed >> 8) / 8388608.0 - 1.0);
}

/* Turned at random, thrown sideways from 1 m higher. */
static void thrown(const noh_ragdoll_rig *rig, noh_ragdoll_pose *poses, noh_ragdoll_motion *motions)
{
    float q[4], speed[3] = { 3.0f, 0.0f, 3.0f };
    for (int i = 0; i < 4; i++) q[i] = random_float();
    q[3] += 0.01f;
    noh_quat_normalize(q);
    speed[0] *= random_float();
    speed[2] *= random_float();
    rest_poses(rig, poses);
    for (uint32_t i = 0; i < rig->body_count; i++) {
        poses[i].position[1] -= 1.0f;
        noh_quat_rotate(q, poses[i].position, poses[i].position);
        noh_quat_mul(q, poses[i].rotation, poses[i].rotation);
        poses[i].position[1] += 1.6f;
        memcpy(motions[i].velocity, speed, sizeof speed);
        memset(motions[i].spin, 0, sizeof motions[i].spin);
    }
}

static int all_finite(const noh_ragdolls *set, uint32_t doll, uint32_t count)
{
    noh_ragdoll_pose p[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_bodies(set, doll, p);
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            if (p[i].position[k] * 0.0f != 0.0f) return 0;
        }
        for (int k = 0; k < 4; k++) {
            if (p[i].rotation[k] * 0.0f != 0.0f) return 0;
        }
    }
    return 1;
}

/* ---- rest ---- */

/* At rest all angles are 0, whatever the bodies' own frames are, and without gravity to fall by nothing moves. The
 * source measures its limits from axes of the world: the same doll then starts beyond them and gains energy. */
static void the_bind_pose_is_zero(void **state)
{
    noh_ragdoll_rig rig = figure_rig();
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_measures m;
    (void)state;
    noh_ragdolls *set = made(&rig, 1, 10);
    noh_ragdoll_measure(set, 0, NULL, &m);
    assert_true(m.limit < 1e-6f && m.separation < 1e-6f);
    rest_poses(&rig, poses);
    assert_int_equal(noh_ragdoll_place(set, 0, poses, NULL, NULL), NOH_OK);
    for (int i = 0; i < 30; i++) noh_ragdolls_step(set, NULL, FRAME);
    noh_ragdoll_motions(set, 0, motions);
    noh_ragdoll_measure(set, 0, NULL, &m);
    float gained = 0.0f; /* joules beyond the fall's, which all bodies share */
    for (uint32_t i = 0; i < rig.body_count; i++) {
        const float *v = motions[i].velocity, *w = motions[i].spin, fall = v[1] + NOH_GRAVITY * 0.5f;
        gained += 0.5f * rig.bodies[i].mass * (v[0] * v[0] + fall * fall + v[2] * v[2]);
        gained += 0.5f * rig.bodies[i].inertia_across * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    }
    assert_true(gained < 0.1f);

    for (uint32_t i = 1; i < rig.body_count; i++) { /* the literal formula: parents' frames as if nothing were turned */
        set->shape.bodies[i].frame_parent[0] = set->shape.bodies[i].frame_parent[1] = 0.0f;
        set->shape.bodies[i].frame_parent[2] = 0.0f;
        set->shape.bodies[i].frame_parent[3] = 1.0f;
    }
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    noh_ragdoll_measure(set, 0, NULL, &m);
    assert_true(m.limit > 0.5f);
    free(set);
}

/* ---- closed forms ---- */

static void hold_first(noh_ragdolls *set, const noh_ragdoll_pose *poses)
{
    assert_int_equal(noh_ragdoll_follow(set, 0, poses, 1, NULL, NULL), NOH_OK);
}

/* A rod of 200 mm hung at its end, let go at 30 degrees: 2 pi sqrt(I / (m g l)) times the series of the amplitude. */
static void a_pendulum_keeps_its_period(void **state)
{
    const noh_ragdoll_rig rig = chain(2, NOH_RAGDOLL_LOOSE);
    noh_ragdoll_pose poses[2], now[2];
    const double start = PI / 6.0, half = sin(start / 2.0);
    const double inertia = (double)rig.bodies[1].inertia_across + (double)rig.bodies[1].mass * 0.01;
    const double period = 2.0 * PI * sqrt(inertia / ((double)rig.bodies[1].mass * 9.82 * 0.1)) *
                          (1.0 + half * half / 4.0 + 9.0 * half * half * half * half / 64.0);
    double first = 0.0, last = 0.0, before = 1.0;
    int crossings = 0;
    (void)state;
    noh_ragdolls *set = made(&rig, 1, 10);
    rest_poses(&rig, poses);
    const float turn[3] = { 0.0f, 0.0f, (float)start };
    float q[4];
    noh_quat_from_rotation(turn, q);
    poses[1].position[0] = 0.1f * (float)sin(start);
    poses[1].position[1] = 1.9f - 0.1f * (float)cos(start);
    noh_quat_mul(q, poses[1].rotation, poses[1].rotation);
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    hold_first(set, poses);
    for (int i = 1; i < 300; i++) {
        noh_ragdolls_step(set, NULL, FRAME);
        noh_ragdoll_bodies(set, 0, now);
        const double x = (double)now[1].position[0];
        if (before < 0.0 && x >= 0.0) {
            const double at = ((double)i - x / (x - before)) / 60.0;
            first = crossings ? first : at;
            last = at;
            crossings++;
        }
        before = x;
    }
    assert_true(crossings > 4);
    assert_true(fabs((last - first) / (crossings - 1) / period - 1.0) < 0.01);
    free(set);
}

/* v^2 / (2 mu g) */
static void a_body_slides_so_far(void **state)
{
    noh_ragdoll_rig rig = chain(1, 0);
    const noh_world world = ground_world(0.5f);
    noh_ragdoll_pose pose;
    noh_ragdoll_motion motion = { { 0.0f, 0.0f, 3.0f }, { 0.0f, 0.0f, 0.0f } };
    (void)state;
    rig.bodies[0].half = 0.3f;
    noh_ragdolls *set = made(&rig, 1, 10);
    memset(&pose, 0, sizeof pose);
    pose.position[1] = 0.04f;
    pose.rotation[3] = 1.0f; /* along z, as it slides */
    noh_ragdoll_place(set, 0, &pose, &motion, NULL);
    for (int i = 0; i < 120; i++) noh_ragdolls_step(set, &world, FRAME);
    noh_ragdoll_bodies(set, 0, &pose);
    assert_true(fabs((double)pose.position[2] / (9.0 / (2.0 * 0.5 * 9.82)) - 1.0) < 0.05);
    free(set);
}

/* I w, of a body turned so */
static void momentum_of(const noh_ragdoll_body *b, const noh_ragdoll_pose *p, const float w[3], double out[3])
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    float axis[3];
    noh_quat_rotate(p->rotation, z, axis);
    const double along = (double)axis[0] * w[0] + (double)axis[1] * w[1] + (double)axis[2] * w[2];
    for (int i = 0; i < 3; i++) {
        out[i] = (double)b->inertia_across * ((double)w[i] - along * axis[i]) +
                 (double)b->inertia_along * along * axis[i];
    }
}

static void free_spin_keeps_its_momentum(void **state)
{
    noh_ragdoll_rig rig = chain(1, 0);
    noh_ragdoll_pose pose;
    noh_ragdoll_motion motion = { { 0.0f, 0.0f, 0.0f }, { 1.0f, 6.0f, 2.0f } };
    double start[3], end[3];
    (void)state;
    noh_ragdolls *set = made(&rig, 1, 10);
    rest_poses(&rig, &pose);
    noh_ragdoll_place(set, 0, &pose, &motion, NULL);
    momentum_of(&rig.bodies[0], &pose, motion.spin, start);
    for (int i = 0; i < 120; i++) noh_ragdolls_step(set, NULL, FRAME);
    noh_ragdoll_bodies(set, 0, &pose);
    noh_ragdoll_motions(set, 0, &motion);
    momentum_of(&rig.bodies[0], &pose, motion.spin, end);
    const double a = sqrt(start[0] * start[0] + start[1] * start[1] + start[2] * start[2]);
    assert_true(fabs(sqrt(end[0] * end[0] + end[1] * end[1] + end[2] * end[2]) / a - 1.0) < 0.01);
    free(set);
}

/* A chain swings for 60 s: never more energy than it began with, by 1 % of what it can lose. */
static void energy_never_rises(void **state)
{
    const noh_ragdoll_rig rig = chain(5, NOH_RAGDOLL_LOOSE);
    noh_ragdoll_pose poses[5];
    noh_ragdoll_measures start, m;
    float most = -1e30f, least = 1e30f;
    (void)state;
    noh_ragdolls *set = made(&rig, 1, 10);
    rest_poses(&rig, poses);
    for (uint32_t i = 1; i < 5; i++) { /* all below the first stand out sideways */
        const float turn[3] = { 0.0f, 0.0f, 1.5707963f };
        float q[4];
        noh_quat_from_rotation(turn, q);
        poses[i].position[0] = 0.2f * (float)i - 0.1f;
        poses[i].position[1] = 1.9f;
        noh_quat_mul(q, poses[i].rotation, poses[i].rotation);
    }
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    hold_first(set, poses);
    noh_ragdoll_measure(set, 0, NULL, &start);
    assert_true(start.separation < 1e-5f);
    for (int i = 0; i < 3600; i++) {
        noh_ragdolls_step(set, NULL, FRAME);
        noh_ragdoll_measure(set, 0, NULL, &m);
        most = m.energy > most ? m.energy : most;
        least = m.energy < least ? m.energy : least;
    }
    assert_true(most - start.energy < 0.01f * (start.energy - least));
    free(set);
}

/* ---- torture ---- */

/* A middle body is dragged in circles of 1 m: at most so far from its neighbours, at three speeds. */
static void a_dragged_forearm_stays_on(void **state)
{
    static const float speeds[3] = { 5.0f, 10.0f, 20.0f }, bounds[3] = { 0.045f, 0.080f, 0.200f };
    const noh_ragdoll_rig rig = figure_rig();
    (void)state;
    for (int n = 0; n < 3; n++) {
        noh_ragdolls *set = made(&rig, 1, 10);
        noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX], goals[NOH_RAGDOLL_BODIES_MAX];
        noh_ragdoll_measures m;
        float worst = 0.0f;
        rest_poses(&rig, poses);
        memcpy(goals, poses, sizeof goals);
        noh_ragdoll_place(set, 0, poses, NULL, NULL);
        for (int i = 1; i <= 600; i++) {
            const float whole = speeds[n] / 60.0f * (float)i,
                        ramp = i < 60 ? whole * (float)i / 120.0f : whole - 0.5f * speeds[n];
            goals[3].position[0] = poses[3].position[0] + cosf(ramp) - 1.0f;
            goals[3].position[1] = poses[3].position[1] + 0.5f + sinf(ramp) - 0.5f;
            noh_ragdoll_follow(set, 0, goals, 1u << 3, NULL, NULL);
            noh_ragdolls_step(set, NULL, FRAME);
            noh_ragdoll_measure(set, 0, NULL, &m);
            worst = m.separation > worst ? m.separation : worst;
        }
        print_message("dragged at %.0f m/s: %.1f mm\n", (double)speeds[n], (double)worst * 1e3);
        assert_true(all_finite(set, 0, rig.body_count));
        assert_true(worst <= bounds[n]);
        free(set);
    }
}

static void a_teleport_stays_finite(void **state)
{
    const noh_ragdoll_rig rig = figure_rig();
    const noh_world world = ground_world(0.6f);
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX], goals[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_measures m;
    (void)state;
    noh_ragdolls *set = made(&rig, 1, 10);
    rest_poses(&rig, poses);
    memcpy(goals, poses, sizeof goals);
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    for (int i = 0; i < 240; i++) {
        if (i == 10) goals[4].position[0] += 1.0f; /* a hand, in one step */
        noh_ragdoll_follow(set, 0, goals, i < 60 ? 1u << 4 : 0, NULL, NULL);
        noh_ragdolls_step(set, &world, FRAME);
        assert_true(all_finite(set, 0, rig.body_count));
    }
    rest_poses(&rig, poses);
    poses[4].position[0] += 1.0f; /* and placed torn apart */
    noh_ragdoll_follow(set, 0, NULL, 0, NULL, NULL);
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    for (int i = 0; i < 240; i++) noh_ragdolls_step(set, &world, FRAME);
    noh_ragdoll_measure(set, 0, &world, &m);
    assert_true(all_finite(set, 0, rig.body_count) && m.separation < 0.01f);
    free(set);
}

/* A light body carries a hundred times its mass. */
static void heavy_on_light_holds(void **state)
{
    noh_ragdoll_rig rig = chain(3, NOH_RAGDOLL_LOOSE);
    noh_ragdoll_pose poses[3];
    noh_ragdoll_measures m;
    (void)state;
    rig.bodies[2].mass *= 100.0f;
    rig.bodies[2].inertia_across *= 100.0f;
    rig.bodies[2].inertia_along *= 100.0f;
    noh_ragdolls *set = made(&rig, 1, 10);
    rest_poses(&rig, poses);
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    hold_first(set, poses);
    for (int i = 0; i < 120; i++) noh_ragdolls_step(set, NULL, FRAME);
    noh_ragdoll_measure(set, 0, NULL, &m);
    assert_true(all_finite(set, 0, 3) && m.separation < 0.02f);
    free(set);
}

/* ---- what it collides with ---- */

/* On a ball, a capsule, a box and a field: it ends outside of them, asleep. */
static void obstacles_hold_it(void **state)
{
    static uint16_t heights[32 * 32];
    const noh_capsule pills[2] = { { { 0.3f, 0.3f, 0.0f }, { 0.3f, 0.3f, 0.0f }, 0.3f },
                                   { { -1.0f, 0.2f, 0.5f }, { 1.0f, 0.2f, 0.5f }, 0.15f } };
    const noh_obb box = { { -0.4f, 0.2f, -0.2f }, { 0.3f, 0.2f, 0.3f }, { 0.0f, 0.38268343f, 0.0f, 0.92387953f } };
    const noh_field field = { heights, 32, 32, { -8.0f, 0.0f, -8.0f }, 0.5f, 0.001f };
    const noh_world world = { .planes = &ground,
                              .capsules = pills,
                              .boxes = &box,
                              .plane_count = 1,
                              .capsule_count = 2,
                              .box_count = 1,
                              .field = &field,
                              .friction = 0.6f };
    const noh_ragdoll_rig rig = figure_rig();
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    (void)state;
    for (uint32_t i = 0; i < 32 * 32; i++) heights[i] = (uint16_t)(30 + 30 * ((i + i / 32) % 2)); /* 30 and 60 mm */
    assert_int_equal(noh_world_check(&world, NULL), NOH_OK);
    noh_ragdolls *set = made(&rig, 8, 10);
    seed = 3;
    for (uint32_t d = 0; d < 8; d++) {
        thrown(&rig, poses, motions);
        noh_ragdoll_place(set, d, poses, NULL, NULL);
    }
    for (int i = 0; i < 900; i++) noh_ragdolls_step(set, &world, FRAME);
    for (uint32_t d = 0; d < 8; d++) {
        noh_ragdoll_measures m;
        noh_ragdoll_measure(set, d, &world, &m);
        assert_true(noh_ragdoll_sleeps(set, d));
        assert_true(m.penetration < 0.01f);
    }
    free(set);
}

/* ---- strength ---- */

/* Joints with strength lift a limp arm to the goals' angle, against gravity; without it they do not. */
static void joints_with_strength_follow(void **state)
{
    const noh_ragdoll_rig rig = chain(3, NOH_RAGDOLL_LOOSE);
    noh_ragdoll_pose poses[3], goals[3], now[3];
    float hertz[3] = { 0.0f, 20.0f, 20.0f };
    const float turn[3] = { 0.0f, 0.0f, 1.2f };
    float q[4], off[2];
    (void)state;
    rest_poses(&rig, poses);
    memcpy(goals, poses, sizeof goals);
    noh_quat_from_rotation(turn, q);
    for (int i = 1; i < 3; i++) noh_quat_mul(q, poses[i].rotation, goals[i].rotation);
    for (int strong = 0; strong < 2; strong++) {
        noh_ragdolls *set = made(&rig, 1, 10);
        noh_ragdoll_place(set, 0, poses, NULL, NULL);
        noh_ragdoll_follow(set, 0, goals, 1, strong ? hertz : NULL, NULL);
        for (int i = 0; i < 240; i++) noh_ragdolls_step(set, NULL, FRAME);
        noh_ragdoll_bodies(set, 0, now);
        off[strong] = 1.0f - fabsf(noh_quat_dot(now[1].rotation, goals[1].rotation));
        free(set);
    }
    assert_true(off[1] < 0.002f && off[0] > 0.1f); /* 7 degrees: it sags as a spring does */
}

/* ---- bits, memory ---- */

static uint32_t hash_of(const noh_ragdolls *set, uint32_t dolls, uint32_t bodies)
{
    uint32_t hash = 2166136261u;
    for (uint32_t d = 0; d < dolls; d++) {
        noh_ragdoll_pose p[NOH_RAGDOLL_BODIES_MAX];
        const uint8_t *bytes = (const uint8_t *)p;
        noh_ragdoll_bodies(set, d, p);
        for (size_t i = 0; i < bodies * sizeof *p; i++) hash = (hash ^ bytes[i]) * 16777619u;
    }
    return hash;
}

static noh_ragdolls *thrown_set(const noh_ragdoll_rig *rig, uint32_t count)
{
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdolls *set = made(rig, count, 10);
    seed = 7;
    for (uint32_t d = 0; d < count; d++) {
        thrown(rig, poses, motions);
        noh_ragdoll_place(set, d, poses, motions, NULL);
    }
    return set;
}

/* After ten seconds, awake and asleep. The number is the same on every processor: change it only with the algorithm. */
#define BITS 0xd40e171eu
static void bits_are_those_of_every_processor(void **state)
{
    const noh_ragdoll_rig rig = figure_rig();
    const noh_world world = ground_world(0.6f);
    (void)state;
    noh_ragdolls *set = thrown_set(&rig, 11);
    for (int i = 0; i < 600; i++) noh_ragdolls_step(set, &world, FRAME);
    const uint32_t hash = hash_of(set, 11, rig.body_count);
    print_message("hash %08x\n", hash);
    assert_int_equal(hash, BITS);
    free(set);
}

#if defined(__x86_64__)
typedef void (*step_dolls)(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                           uint32_t count, float *scratch, float size);

/* On all kinds of obstacles, bouncing, some of it inside of them and each from an origin of its own. */
static uint32_t hash_by(step_dolls step, const noh_ragdoll_rig *rig)
{
    static uint16_t heights[16];
    const noh_capsule post = { { 0.2f, 0.0f, 0.1f }, { 0.2f, 1.5f, 0.1f }, 0.2f };
    const noh_obb box = { { -0.3f, 0.4f, 0.0f }, { 0.3f, 0.4f, 0.5f }, { 0.0f, 0.38268343f, 0.0f, 0.92387953f } };
    const noh_field field = { heights, 4, 4, { -6.0f, 0.1f, -6.0f }, 4.0f, 1.0f };
    const noh_world world = { &ground, &post, &box, 1, 1, 1, &field, 0.6f, 0.3f, NULL };
    noh_ragdolls *set = thrown_set(rig, 8);
    noh_ragdoll_doll *dolls[8];
    for (uint32_t d = 0; d < 8; d++) {
        dolls[d] = &noh_ragdoll_dolls(set)[d];
        dolls[d]->origin[0] += 0.125f * (float)d;
        dolls[d]->origin[1] -= 0.0625f * (float)d;
    }
    for (int i = 0; i < 600; i++) step(&set->shape, &world, dolls, 8, noh_ragdoll_scratch(set), 1.0f);
    const uint32_t hash = hash_of(set, 8, rig->body_count);
    free(set);
    return hash;
}
#endif

static void every_width_gives_the_same_bits(void **state)
{
    (void)state;
#if defined(__x86_64__)
    const noh_ragdoll_rig rig = figure_rig();
    const uint32_t hash = hash_by(noh_ragdoll_step_dolls_scalar, &rig);
    assert_int_equal(hash_by(noh_ragdoll_step_dolls_sse2, &rig), hash);
    if (__builtin_cpu_supports("avx2")) assert_int_equal(hash_by(noh_ragdoll_step_dolls_avx2, &rig), hash);
#else
    test_skip("the widths of x86-64 are compared there");
#endif
}

/* A copy moves exactly like the set, from any frame, cut into any pieces of time; and how many copies there are does
 * not matter. */
static void a_copy_goes_on(void **state)
{
    const noh_ragdoll_rig rig = figure_rig();
    const noh_ragdolls_desc desc = { &rig, 5, 10, 0 };
    const noh_world world = ground_world(0.6f);
    (void)state;
    noh_ragdolls *set = thrown_set(&rig, 5), *alone = thrown_set(&rig, 1);
    void *copy = malloc(noh_ragdolls_size(&desc));
    for (int i = 0; i < 50; i++) noh_ragdolls_step(set, &world, FRAME);
    memcpy(copy, set, noh_ragdolls_size(&desc));
    for (int i = 0; i < 250; i++) noh_ragdolls_step(set, &world, FRAME);
    for (int i = 0; i < 500; i++) noh_ragdolls_step(copy, &world, FRAME / 2);
    for (int i = 0; i < 300; i++) noh_ragdolls_step(alone, &world, FRAME);
    assert_int_equal(hash_of(copy, 5, rig.body_count), hash_of(set, 5, rig.body_count));
    assert_int_equal(hash_of(alone, 1, rig.body_count), hash_of(set, 1, rig.body_count));
    free(copy);
    free(alone);
    free(set);
}

static void a_push_wakes_it(void **state)
{
    const noh_ragdoll_rig rig = figure_rig();
    const noh_world world = ground_world(0.6f);
    const float impulse[3] = { 0.0f, 0.0f, 20.0f };
    noh_ragdoll_pose before[NOH_RAGDOLL_BODIES_MAX], after[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    (void)state;
    noh_ragdolls *set = thrown_set(&rig, 1);
    for (int i = 0; i < 600; i++) noh_ragdolls_step(set, &world, FRAME);
    assert_true(noh_ragdoll_sleeps(set, 0));
    noh_ragdoll_bodies(set, 0, before);
    noh_ragdolls_step(set, &world, 3 * FRAME);
    noh_ragdoll_bodies(set, 0, after);
    assert_memory_equal(before, after, rig.body_count * sizeof *before);
    noh_ragdoll_push(set, 0, before[1].position, impulse);
    assert_false(noh_ragdoll_sleeps(set, 0));
    noh_ragdoll_motions(set, 0, motions);
    assert_true(fabsf(motions[1].velocity[2] * rig.bodies[1].mass - 20.0f) < 0.01f);
    assert_int_equal(noh_ragdolls_step(set, &world, 10 * FRAME), 6 * FRAME);
    free(set);
}

/* ---- far from the origin, overlaps, pushes, bounces ---- */

/* A ground, a field, a post and a box at `base`, in steps that floats still have at 100 km. */
typedef struct room {
    noh_plane plane;
    noh_capsule post;
    noh_obb box;
    noh_field field;
    noh_world world;
    uint16_t heights[16 * 16];
} room;

static void room_at(room *r, const float base[3])
{
    const noh_plane plane = { { 0.0f, 1.0f, 0.0f }, base[1] - 0.25f };
    const noh_capsule post = { { base[0] + 0.5f, base[1], base[2] },
                               { base[0] + 0.5f, base[1] + 1.0f, base[2] },
                               0.2f };
    const noh_obb box = { { base[0], base[1] + 0.25f, base[2] - 0.5f },
                          { 0.3f, 0.3f, 0.3f },
                          { 0.0f, 0.0f, 0.0f, 1.0f } };
    memset(r, 0, sizeof *r);
    for (uint32_t i = 0; i < 16 * 16; i++) r->heights[i] = (uint16_t)(7u * i % 5u);
    r->plane = plane;
    r->post = post;
    r->box = box;
    r->field.heights = r->heights;
    r->field.width = r->field.depth = 16;
    for (int k = 0; k < 3; k++) r->field.origin[k] = base[k] - (k == 1 ? 0.125f : 6.0f);
    r->field.spacing = 0.75f;
    r->field.scale = 0.03125f;
    r->world.planes = &r->plane;
    r->world.capsules = &r->post;
    r->world.boxes = &r->box;
    r->world.plane_count = r->world.capsule_count = r->world.box_count = 1;
    r->world.field = &r->field;
    r->world.friction = 0.6f;
}

/* The bits of a fall at `base`, counted from there. */
static uint32_t fall_at(const float base[3], uint32_t substeps)
{
    static room r;
    const noh_ragdoll_rig rig = figure_rig();
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdolls *set = made(&rig, 1, substeps);
    uint32_t hash = 0;
    room_at(&r, base);
    seed = 11;
    thrown(&rig, poses, motions);
    noh_ragdoll_place_about(set, 0, base, 1.0f, poses, motions, NULL);
    for (int i = 0; i < 240; i++) {
        float origin[3];
        noh_ragdolls_step(set, &r.world, FRAME);
        noh_ragdoll_bodies_local(set, 0, origin, poses);
        for (uint32_t n = 0; n < rig.body_count; n++) {
            for (int k = 0; k < 3; k++) poses[n].position[k] += origin[k] - base[k];
        }
        const uint8_t *bytes = (const uint8_t *)poses;
        for (size_t n = 0; n < rig.body_count * sizeof *poses; n++) hash = (hash ^ bytes[n]) * 16777619u;
    }
    free(set);
    return hash;
}

static void it_falls_far_away_as_at_the_origin(void **state)
{
    static const float bases[][3] = { { 0.0f, 512.0f, 0.0f },
                                      { 10000.0f, -300.0f, 7.0f },
                                      { 0.0f, 100000.0f, 0.0f },
                                      { -100000.0f, 0.0f, 100000.0f },
                                      { 1e6f, 16384.0f, -1e6f } };
    static const float zero[3];
    (void)state;
    for (uint32_t substeps = 5; substeps <= 20; substeps += 5) {
        const uint32_t hash = fall_at(zero, substeps);
        for (size_t i = 0; i < sizeof bases / sizeof *bases; i++) assert_int_equal(fall_at(bases[i], substeps), hash);
    }
}

/* Through the public calls, whose floats have steps of 8 mm there. */
static void it_falls_by_half_g_t_squared(void **state)
{
    const noh_ragdoll_rig rig = figure_rig();
    const float bases[] = { 512.0f, 10000.0f, 100000.0f };
    (void)state;
    for (int i = 0; i < 3; i++) {
        noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
        noh_ragdolls *set = made(&rig, 1, 20);
        rest_poses(&rig, poses);
        for (uint32_t n = 0; n < rig.body_count; n++) poses[n].position[1] += bases[i];
        noh_ragdoll_place(set, 0, poses, NULL, NULL);
        for (int n = 0; n < 60; n++) noh_ragdolls_step(set, NULL, FRAME);
        noh_ragdoll_bodies(set, 0, poses);
        assert_true(fabsf(poses[0].position[1] - (bases[i] + 1.0f - 4.91f)) < 0.005f + bases[i] * 1.2e-7f);
        free(set);
    }
}

/* What a far float cannot represent of a shift is kept, also of the goals that bodies are held at. */
static void a_shift_far_away_takes_goals_along(void **state)
{
    const float far[3] = { 100000.0f, -70000.0f, 50000.0f }, back[3] = { -100000.0f, 70000.0f, -50000.0f };
    const float little[3] = { 0.3337f, -0.2112f, 0.4181f };
    const noh_ragdoll_rig rig = figure_rig();
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX], there[NOH_RAGDOLL_BODIES_MAX];
    (void)state;
    noh_ragdolls *set = made(&rig, 1, 10);
    rest_poses(&rig, poses);
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    assert_int_equal(noh_ragdoll_follow(set, 0, poses, 1, NULL, NULL), NOH_OK);
    noh_ragdolls_shift(set, far);
    noh_ragdolls_shift(set, little);
    for (int i = 0; i < 30; i++) noh_ragdolls_step(set, NULL, FRAME);
    noh_ragdolls_shift(set, back);
    noh_ragdoll_bodies(set, 0, there);
    for (int k = 0; k < 3; k++) {
        assert_true(fabsf(there[0].position[k] - (poses[0].position[k] + little[k])) < 0.0001f);
    }
    free(set);
}

/* Moved by any offset, even one that floats at the new place cannot represent, it moves as it would have. */
static void a_shifted_space_goes_on(void **state)
{
    const float way[3] = { 100000.3f, -777.77f, 12345.678f }, back[3] = { -100000.3f, 777.77f, -12345.678f };
    const noh_ragdoll_rig rig = figure_rig();
    noh_ragdoll_pose moved[NOH_RAGDOLL_BODIES_MAX], stayed[NOH_RAGDOLL_BODIES_MAX];
    (void)state;
    noh_ragdolls *a = thrown_set(&rig, 2), *b = thrown_set(&rig, 2);
    noh_ragdolls_shift(b, way);
    for (int i = 0; i < 90; i++) {
        noh_ragdolls_step(a, NULL, FRAME);
        noh_ragdolls_step(b, NULL, FRAME);
    }
    noh_ragdolls_shift(b, back);
    for (uint32_t d = 0; d < 2; d++) {
        noh_ragdoll_bodies(a, d, stayed);
        noh_ragdoll_bodies(b, d, moved);
        for (uint32_t i = 0; i < rig.body_count; i++) {
            for (int k = 0; k < 3; k++) assert_true(fabsf(stayed[i].position[k] - moved[i].position[k]) < 0.001f);
        }
    }
    free(a);
    free(b);
}

/* Where a doll that starts so goes: its highest speed upwards, the farthest way of its first body, what is left. */
typedef struct outcome {
    float up, away, penetration;
} outcome;

static outcome start_in(const noh_world *world, float height)
{
    const noh_ragdoll_rig rig = figure_rig();
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_measures m;
    noh_ragdolls *set = made(&rig, 1, 10);
    outcome o = { 0.0f, 0.0f, 0.0f };
    float from[3];
    rest_poses(&rig, poses);
    for (uint32_t i = 0; i < rig.body_count; i++) poses[i].position[1] += height;
    memcpy(from, poses[0].position, sizeof from);
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    for (int i = 0; i < 480; i++) {
        noh_ragdolls_step(set, world, FRAME);
        noh_ragdoll_bodies(set, 0, poses);
        noh_ragdoll_motions(set, 0, motions);
        const float x = poses[0].position[0] - from[0], y = poses[0].position[1] - from[1];
        const float z = poses[0].position[2] - from[2], far = sqrtf(x * x + y * y + z * z);
        if (far > o.away) o.away = far;
        if (motions[0].velocity[1] > o.up) o.up = motions[0].velocity[1];
    }
    noh_ragdoll_measure(set, 0, world, &m);
    o.penetration = m.penetration;
    free(set);
    return o;
}

/* Inside a post, a box, a wall, the ground and a field: out of it at a walk's speed, not shot away. */
static void what_starts_inside_is_not_thrown(void **state)
{
    static uint16_t heights[16];
    static noh_field field = { heights, 4, 4, { -6.0f, 0.0f, -6.0f }, 4.0f, 1.0f };
    noh_world world = ground_world(0.6f);
    noh_capsule post = { { 0.0f, 0.2f, 0.0f }, { 0.0f, 1.6f, 0.0f }, 0.25f };
    noh_obb box = { { 0.0f, 0.5f, 0.0f }, { 0.4f, 0.5f, 0.4f }, { 0.0f, 0.38268343f, 0.0f, 0.92387953f } };
    (void)state;
    for (int i = 0; i < 8; i++) {
        const float at = 0.1f * (float)i, sunk = i < 7 ? -at : -3.0f;
        outcome o = start_in(&world, sunk);
        print_message("sunk %4.1f m: up %.2f m/s, away %.2f m, inside %.4f m\n", (double)-sunk, (double)o.up,
                      (double)o.away, (double)o.penetration);
        assert_true(o.up < 2.5f && o.away < 1.3f - sunk && o.penetration < 0.01f);
        world.plane_count = 0;
        world.field = &field;
        o = start_in(&world, sunk);
        assert_true(o.up < 2.5f && o.away < 1.3f - sunk && o.penetration < 0.01f);
        world.plane_count = 1;
        world.field = NULL;
        if (i == 7) break;
        post.from[0] = post.to[0] = at;
        world.capsules = &post;
        world.capsule_count = 1;
        o = start_in(&world, 0.0f);
        print_message("post at %.1f m: up %.2f m/s, away %.2f m, inside %.4f m\n", (double)at, (double)o.up,
                      (double)o.away, (double)o.penetration);
        assert_true(o.up < 2.5f && o.away < 2.0f && o.penetration < 0.01f);
        world.capsule_count = 0;
        box.centre[0] = at;
        world.boxes = &box;
        world.box_count = 1;
        o = start_in(&world, 0.0f);
        print_message("box at %.1f m: up %.2f m/s, away %.2f m, inside %.4f m\n", (double)at, (double)o.up,
                      (double)o.away, (double)o.penetration);
        assert_true(o.up < 2.5f && o.away < 2.0f && o.penetration < 0.01f);
        world.box_count = 0;
    }
}

/* A wall that stands on the ground and holds a doll or its middle: all of it leaves by one side, and not down. */
static void what_starts_in_a_wall_leaves_by_one_side(void **state)
{
    static const float thick[] = { 0.2f, 0.5f, 1.0f };
    noh_world world = ground_world(0.6f);
    noh_obb wall = { { 0.0f, 1.5f, 0.0f }, { 4.0f, 1.5f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    (void)state;
    world.boxes = &wall;
    world.box_count = 1;
    for (uint32_t i = 0; i < sizeof thick / sizeof *thick; i++) {
        for (int to = -4; to <= 4; to++) {
            outcome o;
            wall.half[2] = thick[i];
            wall.centre[2] = 0.02f * (float)to * thick[i];
            o = start_in(&world, 0.0f);
            print_message("wall of %.1f m, its middle %5.2f m away: up %.2f m/s, away %.2f m, inside %.4f m\n",
                          2.0 * (double)thick[i], (double)wall.centre[2], (double)o.up, (double)o.away,
                          (double)o.penetration);
            assert_true(o.up < 2.5f && o.away < 2.0f + thick[i] && o.penetration < 0.01f);
        }
    }
}

/* A pose whose joints are past their limits, or a hinge off its axis, is brought back without a blow. */
static void what_starts_bent_is_not_thrown(void **state)
{
    const float turns[3][3] = { { 1.9f, 0.0f, 0.0f }, { 0.0f, 1.9f, 0.0f }, { 0.0f, 0.0f, 1.2f } };
    (void)state;
    for (int n = 0; n < 6; n++) {
        const noh_ragdoll_rig rig = chain(4, n % 2 ? NOH_RAGDOLL_HINGE : 0);
        noh_ragdoll_pose poses[4];
        noh_ragdoll_motion motions[4];
        noh_ragdoll_measures m;
        noh_ragdolls *set = made(&rig, 1, 10);
        float q[4], most = 0.0f;
        rest_poses(&rig, poses);
        noh_quat_from_rotation(turns[n / 2], q);
        for (int i = 1; i < 4; i++) { /* all below the first joint */
            for (int k = 0; k < 3; k++) poses[i].position[k] -= rig.joints[1].anchor[k];
            noh_quat_rotate(q, poses[i].position, poses[i].position);
            for (int k = 0; k < 3; k++) poses[i].position[k] += rig.joints[1].anchor[k];
            noh_quat_mul(q, poses[i].rotation, poses[i].rotation);
        }
        noh_ragdoll_place(set, 0, poses, NULL, NULL);
        for (int f = 1; f <= 90; f++) {
            noh_ragdolls_step(set, NULL, FRAME);
            noh_ragdoll_motions(set, 0, motions);
            for (int i = 0; i < 4; i++) {
                const float *v = motions[i].velocity, fall = v[1] + 9.82f * (float)f / 60.0f;
                const float speed = sqrtf(v[0] * v[0] + fall * fall + v[2] * v[2]);
                most = speed > most ? speed : most;
            }
        }
        noh_ragdoll_measure(set, 0, NULL, &m);
        print_message("turn %d, %s: up to %.2f m/s, %.3f rad are left\n", n / 2, n % 2 ? "hinge" : "cone", (double)most,
                      (double)m.limit);
        assert_true(most < 1.5f && m.limit < 0.05f);
        free(set);
    }
}

/* Bodies of a doll that start in each other come apart slowly, too. */
static void what_starts_in_itself_is_not_thrown(void **state)
{
    noh_ragdoll_rig rig = chain(2, NOH_RAGDOLL_LOOSE);
    noh_ragdoll_pose poses[2];
    noh_ragdoll_motion motions[2];
    float most = 0.0f;
    (void)state;
    rig.joints[1].flags |= NOH_RAGDOLL_SLIDES;
    for (int k = 0; k < 3; k++) {
        rig.joints[1].linear_min[k] = -1.0f;
        rig.joints[1].linear_max[k] = 1.0f;
    }
    rig.bodies[1].position[0] = 0.3f; /* at rest they are apart */
    rig.pair_count = 1;
    rig.pairs[0][1] = 1;
    noh_ragdolls *set = made(&rig, 1, 10);
    rest_poses(&rig, poses);
    poses[1].position[0] = 0.01f;
    poses[1].position[1] = poses[0].position[1];
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    for (int i = 0; i < 30; i++) {
        noh_ragdolls_step(set, NULL, FRAME);
        noh_ragdoll_motions(set, 0, motions);
        most = fabsf(motions[1].velocity[0]) > most ? fabsf(motions[1].velocity[0]) : most;
    }
    noh_ragdoll_bodies(set, 0, poses);
    assert_true(most < 1.5f * NOH_PUSH_OUT_SPEED && poses[1].position[0] - poses[0].position[0] > 0.079f);
    free(set);
}

/* Up to the limit that the header states, the whole doll takes all of a push, however strong it is. */
static void a_push_is_spread(void **state)
{
    const noh_ragdoll_rig rig = figure_rig();
    float mass = 0.0f;
    (void)state;
    for (uint32_t i = 0; i < rig.body_count; i++) mass += rig.bodies[i].mass;
    for (float push = 50.0f; push < 3200.0f; push *= 2.0f) {
        const float impulse[3] = { 0.0f, 0.0f, push };
        noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
        noh_ragdolls *set = made(&rig, 1, 10);
        float centre = 0.0f;
        rest_poses(&rig, poses);
        poses[1].position[2] -= 0.1f;
        noh_ragdoll_push(set, 0, poses[1].position, impulse);
        for (int i = 0; i < 60; i++) noh_ragdolls_step(set, NULL, FRAME);
        noh_ragdoll_bodies(set, 0, poses);
        for (uint32_t i = 0; i < rig.body_count; i++) centre += rig.bodies[i].mass / mass * poses[i].position[2];
        print_message("%4.0f Ns: %.3f m of %.3f\n", (double)push, (double)centre, (double)(push / mass));
        assert_true(fabsf(centre / (push / mass) - 1.0f) < 0.03f);
        free(set);
    }
}

/* A ball comes back to e^2 of the height that it fell; one that bounces at all comes to rest. */
static void a_ball_bounces(void **state)
{
    noh_ragdoll_rig rig = chain(1, 0);
    noh_world world = ground_world(0.0f);
    (void)state;
    rig.bodies[0].half = 0.0f;
    rig.bodies[0].radius = 0.5f;
    rig.bodies[0].inertia_across = rig.bodies[0].inertia_along;
    rig.bodies[0].position[1] = 1.5f;
    for (int i = 0; i <= 4; i++) {
        noh_ragdolls *set = made(&rig, 1, 20);
        noh_ragdoll_pose pose;
        float least = 9.0f, top = 0.0f;
        world.restitution = 0.25f * (float)i;
        assert_int_equal(noh_world_check(&world, NULL), NOH_OK);
        rest_poses(&rig, &pose);
        noh_ragdoll_place(set, 0, &pose, NULL, NULL);
        for (int n = 0; n < 60 * (i < 4 ? 20 : 1); n++) {
            noh_ragdolls_step(set, &world, FRAME);
            noh_ragdoll_bodies(set, 0, &pose);
            least = pose.position[1] < least ? pose.position[1] : least;
            if (n >= 29 && n < 60 && pose.position[1] > top) top = pose.position[1];
        }
        const float e = world.restitution;
        print_message("restitution %.2f: up to %.4f m\n", (double)e, (double)top - 0.5);
        assert_true(fabsf(top - 0.5f - e * e) < 0.015f && least > 0.498f);
        if (i < 4) assert_true(fabsf(pose.position[1] - 0.5f) < 0.001f);
        free(set);
    }
    world.restitution = 1.5f;
    assert_int_equal(noh_world_check(&world, NULL), NOH_ERR_ARG);
}

static void bad_rigs_are_refused(void **state)
{
    noh_ragdoll_rig rig = figure_rig();
    noh_ragdolls_desc desc = { &rig, 1, 10, 0 };
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    noh_error error;
    (void)state;
    noh_ragdolls *set = made(&rig, 1, 0);
    rest_poses(&rig, poses);
    poses[3].position[1] = NAN;
    assert_int_equal(noh_ragdoll_place(set, 0, poses, NULL, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 3);
    assert_int_equal(noh_ragdoll_follow(set, 0, poses, 1, NULL, &error), NOH_ERR_ARG);
    free(set);
    desc.substeps = 4;
    assert_true(noh_ragdolls_size(&desc) == 0);
    desc.substeps = 10;
    desc.count = NOH_RAGDOLLS_MAX + 1u;
    assert_true(noh_ragdolls_size(&desc) == 0);
    rig.bodies[5].parent = 7;
    assert_int_equal(noh_ragdoll_rig_check(&rig, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 5);
    rig = figure_rig();
    rig.pairs[0][0] = 14;
    assert_int_equal(noh_ragdoll_rig_check(&rig, &error), NOH_ERR_ARG);
    rig = figure_rig();
    rig.bodies[2].mass = 1e30f; /* its square is infinite */
    assert_int_equal(noh_ragdoll_rig_check(&rig, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 2);
}

/* The source's hinge takes the upper limit first, where its engine takes the lower: a knee that bends the other way.
 * Limits here have names, and those in the wrong order are refused. */
static void limits_are_in_order(void **state)
{
    noh_ragdoll_rig rig = figure_rig();
    (void)state;
    const float low = rig.joints[3].twist_min;
    rig.joints[3].twist_min = rig.joints[3].twist_max;
    rig.joints[3].twist_max = low;
    assert_int_equal(noh_ragdoll_rig_check(&rig, NULL), NOH_ERR_ARG);
}

/* One record for four types: what each lets move, pulled at by gravity, moves; the rest does not. */
static void four_types_in_one_record(void **state)
{
    noh_ragdoll_rig rig = chain(2, NOH_RAGDOLL_SLIDES);
    noh_ragdoll_pose poses[2], now[2];
    noh_ragdoll_measures m;
    (void)state;
    rig.joints[1].linear_min[2] = -0.15f; /* z of the frame is up */
    noh_ragdolls *set = made(&rig, 1, 10);
    rest_poses(&rig, poses);
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    hold_first(set, poses);
    for (int i = 0; i < 120; i++) noh_ragdolls_step(set, NULL, FRAME);
    noh_ragdoll_bodies(set, 0, now);
    noh_ragdoll_measure(set, 0, NULL, &m);
    assert_true(fabsf(now[1].position[1] - poses[1].position[1] + 0.15f) < 0.002f);
    assert_true(fabsf(now[1].position[0]) < 1e-3f && m.separation < 0.002f);
    free(set);

    rig = chain(2, 0); /* a twist cone: pushed aside, it stops at 0.6 rad */
    set = made(&rig, 1, 10);
    const float impulse[3] = { 5.0f, 0.0f, 0.0f };
    float most = 0.0f;
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    hold_first(set, poses);
    noh_ragdoll_push(set, 0, poses[1].position, impulse);
    for (int i = 0; i < 60; i++) {
        noh_ragdolls_step(set, NULL, FRAME);
        noh_ragdoll_bodies(set, 0, now);
        const float angle = atan2f(now[1].position[0], 1.9f - now[1].position[1]);
        most = angle > most ? angle : most;
    }
    assert_true(most > 0.55f && most < 0.65f);
    free(set);

    rig = chain(2, NOH_RAGDOLL_HINGE); /* about z of the world: -0.3..0.5, and never out of its plane */
    set = made(&rig, 1, 10);
    const float aside[3] = { 5.0f, 0.0f, 3.0f };
    noh_ragdoll_place(set, 0, poses, NULL, NULL);
    hold_first(set, poses);
    noh_ragdoll_push(set, 0, poses[1].position, aside);
    most = 0.0f;
    for (int i = 0; i < 60; i++) {
        noh_ragdolls_step(set, NULL, FRAME);
        noh_ragdoll_bodies(set, 0, now);
        const float angle = atan2f(now[1].position[0], 1.9f - now[1].position[1]);
        most = angle > most ? angle : most;
        assert_true(fabsf(now[1].position[2]) < 0.01f);
    }
    assert_true(most > 0.45f && most < 0.55f);
    free(set);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_bind_pose_is_zero),
    cmocka_unit_test(limits_are_in_order),
    cmocka_unit_test(four_types_in_one_record),
    cmocka_unit_test(a_pendulum_keeps_its_period),
    cmocka_unit_test(a_body_slides_so_far),
    cmocka_unit_test(free_spin_keeps_its_momentum),
    cmocka_unit_test(energy_never_rises),
    cmocka_unit_test(a_dragged_forearm_stays_on),
    cmocka_unit_test(a_teleport_stays_finite),
    cmocka_unit_test(heavy_on_light_holds),
    cmocka_unit_test(obstacles_hold_it),
    cmocka_unit_test(joints_with_strength_follow),
    cmocka_unit_test(bits_are_those_of_every_processor),
    cmocka_unit_test(every_width_gives_the_same_bits),
    cmocka_unit_test(a_copy_goes_on),
    cmocka_unit_test(a_push_wakes_it),
    cmocka_unit_test(it_falls_far_away_as_at_the_origin),
    cmocka_unit_test(it_falls_by_half_g_t_squared),
    cmocka_unit_test(a_shifted_space_goes_on),
    cmocka_unit_test(a_shift_far_away_takes_goals_along),
    cmocka_unit_test(what_starts_inside_is_not_thrown),
    cmocka_unit_test(what_starts_in_a_wall_leaves_by_one_side),
    cmocka_unit_test(what_starts_in_itself_is_not_thrown),
    cmocka_unit_test(what_starts_bent_is_not_thrown),
    cmocka_unit_test(a_push_is_spread),
    cmocka_unit_test(a_ball_bounces),
    cmocka_unit_test(bad_rigs_are_refused),
};

TEST_MAIN(tests, NULL, NULL)
