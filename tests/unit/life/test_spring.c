/* Tests of spring.c against the reference of VRMC_springBone, written here in double as its text has it. */
#include "life/physics/spring_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define JOINTS 5u
#define COLLIDERS 8u
#define BUNDLE_CRC 0x653c6a2du
#define MEETING_CRC 0x3501a4a2u /* with planes */
#define SECOND 48000u

static noh_spring_joint joints[JOINTS];

/* Five bones of 100 mm that hang down, the last ones softer. */
static noh_spring_desc hanging(float stiffness, float drag, float gravity)
{
    noh_spring_desc desc = { joints, JOINTS, 0, 0.0f };
    for (uint32_t i = 0; i < JOINTS; i++) {
        joints[i] = (noh_spring_joint){ { 0.0f, -0.1f, 0.0f },   { 0.0f, 0.0f, 0.0f, 1.0f }, stiffness, drag, 0.02f,
                                        { 0.0f, -gravity, 0.0f } };
    }
    return desc;
}

static noh_spring *made(const noh_spring_desc *desc, const noh_spring_carrier *carrier)
{
    const size_t bytes = noh_spring_size(desc);
    noh_spring *spring;
    void *memory = malloc(bytes);
    assert_int_equal(noh_spring_init(memory, bytes, desc, carrier, &spring, NULL), NOH_OK);
    return spring;
}

/* One chain, by itself. */
static uint32_t step_one(noh_spring *spring, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                         const noh_spring_collider *colliders, uint32_t ticks)
{
    static float scratch[NOH_SPRING_SCRATCH_FLOATS(COLLIDERS)];
    const noh_spring_move move = { spring, desc, carrier, colliders, NULL, NULL };
    return noh_spring_step(&move, 1, ticks, scratch);
}

static void rotations_of(noh_spring *spring, const noh_spring_desc *desc, float *rotations)
{
    const noh_spring_move move = { spring, desc, NULL, NULL, rotations, NULL };
    noh_spring_rotations(&move, 1);
}

static double apart(const float a[3], const double b[3])
{
    return sqrt(pow((double)a[0] - b[0], 2) + pow((double)a[1] - b[1], 2) + pow((double)a[2] - b[2], 2));
}

/* ---- the reference: one frame of dt seconds, tails in world space ---- */

static void rotate(const double q[4], const double v[3], double out[3])
{
    const double t[3] = { 2 * (q[1] * v[2] - q[2] * v[1]), 2 * (q[2] * v[0] - q[0] * v[2]),
                          2 * (q[0] * v[1] - q[1] * v[0]) };
    const double r[3] = { v[0] + q[3] * t[0] + q[1] * t[2] - q[2] * t[1],
                          v[1] + q[3] * t[1] + q[2] * t[0] - q[0] * t[2],
                          v[2] + q[3] * t[2] + q[0] * t[1] - q[1] * t[0] };
    memcpy(out, r, sizeof r);
}

static void multiply(const double a[4], const double b[4], double out[4])
{
    const double r[4] = { a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
                          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
                          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
                          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2] };
    memcpy(out, r, sizeof r);
}

static void between(const double a[3], const double b[3], double q[4])
{
    double length = 0.0;
    q[0] = a[1] * b[2] - a[2] * b[1];
    q[1] = a[2] * b[0] - a[0] * b[2];
    q[2] = a[0] * b[1] - a[1] * b[0];
    q[3] = sqrt((a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2])) + a[0] * b[0] +
           a[1] * b[1] + a[2] * b[2];
    for (int i = 0; i < 4; i++) length += q[i] * q[i];
    for (int i = 0; i < 4; i++) q[i] /= sqrt(length);
}

typedef struct reference {
    double now[JOINTS][3], before[JOINTS][3];
} reference;

/* Out of a capsule, then back to length: once for each collider. */
static void reference_push(const noh_spring_collider *c, double radius, const double head[3], double length,
                           double tail[3])
{
    double axis[3], away[3], square = 0.0, along = 0.0, distance = 0.0;
    for (int i = 0; i < 3; i++) {
        axis[i] = (double)c->to[i] - (double)c->from[i];
        square += axis[i] * axis[i];
        along += (tail[i] - (double)c->from[i]) * axis[i];
    }
    along = square > 0.0 ? fmin(fmax(along / square, 0.0), 1.0) : 0.0;
    for (int i = 0; i < 3; i++) {
        away[i] = tail[i] - (double)c->from[i] - along * axis[i];
        distance += away[i] * away[i];
    }
    distance = sqrt(distance);
    if (distance >= (double)c->radius + radius) return;
    square = 0.0;
    for (int i = 0; i < 3; i++) {
        tail[i] += away[i] / distance * ((double)c->radius + radius - distance);
        square += (tail[i] - head[i]) * (tail[i] - head[i]);
    }
    for (int i = 0; i < 3; i++) tail[i] = head[i] + (tail[i] - head[i]) * length / sqrt(square);
}

static void reference_step(reference *r, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                           const noh_spring_collider *colliders, double dt)
{
    double head[3], rotation[4];
    for (int i = 0; i < 3; i++) head[i] = (double)carrier->position[i];
    for (int i = 0; i < 4; i++) rotation[i] = (double)carrier->rotation[i];
    for (uint32_t j = 0; j < JOINTS; j++) {
        const noh_spring_joint *joint = &desc->joints[j];
        double bone[3], rest[4], world[4], pull[3], tail[3], length = 0.0, size = 0.0, swing[4];
        for (int i = 0; i < 3; i++) bone[i] = (double)joint->bone[i], length += bone[i] * bone[i];
        length = sqrt(length);
        for (int i = 0; i < 4; i++) rest[i] = (double)joint->rest[i];
        multiply(rotation, rest, world);
        rotate(world, bone, pull);
        for (int i = 0; i < 3; i++) {
            tail[i] = r->now[j][i] + (r->now[j][i] - r->before[j][i]) * (1.0 - (double)joint->drag) +
                      dt * (double)joint->stiffness * pull[i] / length + dt * (double)joint->gravity[i];
            size += (tail[i] - head[i]) * (tail[i] - head[i]);
        }
        for (int i = 0; i < 3; i++) tail[i] = head[i] + (tail[i] - head[i]) * length / sqrt(size);
        for (uint32_t k = 0; k < desc->collider_count; k++) {
            reference_push(&colliders[k], (double)joint->radius, head, length, tail);
        }
        for (int i = 0; i < 3; i++) {
            r->before[j][i] = r->now[j][i];
            r->now[j][i] = tail[i];
            tail[i] -= head[i];
        }
        between(pull, tail, swing);
        multiply(swing, world, rotation);
        memcpy(head, r->now[j], sizeof head);
    }
}

static reference reference_of(const noh_spring_desc *desc, const noh_spring_carrier *carrier)
{
    reference r;
    for (uint32_t j = 0; j < JOINTS; j++) {
        for (int i = 0; i < 3; i++) {
            r.now[j][i] = (double)carrier->position[i] + (double)(j + 1) * (double)desc->joints[0].bone[i];
            r.before[j][i] = r.now[j][i];
        }
    }
    return r;
}

/* What carries the chain sways and turns. */
static noh_spring_carrier swaying(double seconds)
{
    const float by[3] = { 0.3f * (float)sin(3.0 * seconds), 0.8f * (float)sin(2.0 * seconds), 0.2f };
    noh_spring_carrier c = { { 0.2f * (float)sin(5.0 * seconds), 1.5f, 1.0f + 0.1f * (float)seconds }, { 0 } };
    noh_quat_from_rotation(by, c.rotation);
    return c;
}

/* The farthest from the reference in ten seconds at 60 Hz. What is shown is the step before, carried along: it is
 * compared with that step as the carrier stood then. */
static double off_reference(uint32_t collider_count, double *touched)
{
    const noh_spring_collider colliders[2] = { { { 0.1f, 1.15f, 0.9f }, { 0.1f, 1.15f, 0.9f }, 0.08f },
                                               { { -0.2f, 1.2f, 0.0f }, { -0.1f, 1.25f, 3.0f }, 0.06f } };
    noh_spring_desc desc = hanging(1.0f, 0.4f, 0.3f);
    noh_spring_carrier at = { { 0.0f, 1.5f, 1.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    reference r, before, free_of_all;
    noh_spring *spring;
    double worst = 0.0;
    desc.collider_count = collider_count;
    spring = made(&desc, &at);
    r = reference_of(&desc, &at);
    *touched = 0.0;
    for (int n = 1; n <= 600; n++) {
        float ends[3 * JOINTS];
        const noh_spring_carrier then = at;
        noh_spring_desc without = desc;
        without.collider_count = 0;
        at = swaying(n / 60.0);
        before = free_of_all = r;
        reference_step(&r, &desc, &at, colliders, 1.0 / 60.0);
        reference_step(&free_of_all, &without, &at, NULL, 1.0 / 60.0);
        *touched += fabs(free_of_all.now[JOINTS - 1u][0] - r.now[JOINTS - 1u][0]) > 1e-3 ? 1.0 : 0.0;
        assert_int_equal(step_one(spring, &desc, &at, collider_count ? colliders : NULL, SECOND / 60u), 0);
        noh_spring_ends(spring, &desc, ends);
        for (uint32_t j = 0; j < JOINTS; j++) {
            float back[4], seen[3];
            double there[3];
            for (int i = 0; i < 3; i++) seen[i] = ends[3 * j + (uint32_t)i] - at.position[i];
            noh_quat_conjugate(at.rotation, back);
            noh_quat_rotate(back, seen, seen);
            noh_quat_rotate(then.rotation, seen, seen);
            for (int i = 0; i < 3; i++) there[i] = before.now[j][i] - (double)then.position[i];
            worst = fmax(worst, apart(seen, there));
        }
    }
    free(spring);
    return worst;
}

static void sixty_hertz_is_the_reference(void **state)
{
    double touched, off = off_reference(0, &touched);
    (void)state;
    print_message("# off the reference by at most %.2g m in 10 s\n", off);
    assert_true(off < 1e-5);
    off = off_reference(2, &touched);
    print_message("# with colliders, which push in %.0f of 600 steps, by %.2g m\n", touched, off);
    assert_true(off < 1e-5 && touched > 30.0);
}

#define BEATS 45u /* fifteenths of a second, at which every rate has a frame */

typedef struct settling {
    double overshoot_mm;
    double seconds;         /* until the end is within 2 mm for good, between the two frames around that */
    double beats_mm[BEATS]; /* how far it is off then */
} settling;

/* After it was carried 100 mm aside within a fifteenth of a second. */
static settling settle(uint32_t hertz)
{
    const noh_spring_desc desc = hanging(1.0f, 0.4f, 0.0f);
    noh_spring_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    noh_spring *spring = made(&desc, &at);
    settling r = { 0.0, 0.0, { 0.0 } };
    double before = 0.0;
    for (uint32_t n = 1; n <= BEATS * hertz / 15u; n++) {
        const double seconds = (double)n / hertz, share = fmin(seconds * 15.0, 1.0);
        float ends[3 * JOINTS];
        double off;
        at.position[0] = (float)(0.1 * share);
        assert_int_equal(step_one(spring, &desc, &at, NULL, SECOND / hertz), 0);
        noh_spring_ends(spring, &desc, ends);
        off = 1000.0 * ((double)ends[3 * (JOINTS - 1u)] - (double)at.position[0]);
        r.overshoot_mm = fmax(r.overshoot_mm, off);
        if (fabs(before) > 2.0 && fabs(off) <= 2.0) {
            r.seconds = seconds - (2.0 - fabs(off)) / (fabs(before) - fabs(off)) / hertz;
        }
        if (n % (hertz / 15u) == 0) r.beats_mm[n * 15u / hertz - 1u] = off;
        before = off;
    }
    assert_true(fabs(before) <= 2.0);
    free(spring);
    return r;
}

/* Not only in the time that it takes: at the same moment the end is at the same place. */
static void every_rate_settles_alike(void **state)
{
    static const uint32_t rates[] = { 15, 30, 60, 120, 240 };
    const settling at_60 = settle(60);
    double least = 1e9, most = 0.0;
    (void)state;
    assert_true(at_60.seconds > 0.2 && at_60.overshoot_mm > 5.0);
    for (size_t i = 0; i < TEST_COUNT(rates); i++) {
        const settling r = settle(rates[i]);
        double off = 0.0;
        for (uint32_t k = 0; k < BEATS; k++) off = fmax(off, fabs(r.beats_mm[k] - at_60.beats_mm[k]));
        print_message("# %u Hz: overshoots by %.1f mm, settles in %.3f s, off 60 Hz by at most %.4f mm\n", rates[i],
                      r.overshoot_mm, r.seconds, off);
        least = fmin(least, r.seconds);
        most = fmax(most, r.seconds);
        assert_true(off < 0.01);
        assert_true(rates[i] < 60 || fabs(r.overshoot_mm - at_60.overshoot_mm) <= 0.03 * at_60.overshoot_mm);
    }
    assert_true(most <= 1.03 * least);
}

/* The reference, drag by the frame, settles in twice the time or more at 15 Hz than at 90. */
static void drag_does_not_depend_on_frames(void **state)
{
    const noh_spring_desc desc = hanging(1.0f, 0.4f, 0.0f);
    double settled[2] = { 0.0, 0.0 };
    (void)state;
    for (int k = 0; k < 2; k++) {
        const int hertz = k ? 90 : 15;
        noh_spring_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
        reference r = reference_of(&desc, &at);
        at.position[0] = 0.1f;
        for (int n = 1; n <= 3 * hertz; n++) {
            reference_step(&r, &desc, &at, NULL, 1.0 / hertz);
            if (fabs(r.now[JOINTS - 1u][0] - 0.1) > 0.002) settled[k] = (double)n / hertz;
        }
    }
    assert_true(settled[0] > 2.0 * settled[1]);
}

/* Carried straight on and turned, as it looks the same in frames of any length: down to one in a second all of the time
 * is run, and of longer ones the end. */
static void seldom_frames_are_run_whole(void **state)
{
    static const uint32_t frames[] = {
        SECOND / 60, SECOND / 9, SECOND / 5, SECOND / 3, SECOND / 2, SECOND, 2 * SECOND
    };
    const noh_spring_desc desc = hanging(1.0f, 0.1f, 0.5f);
    double at_60[3] = { 0.0, 0.0, 0.0 };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(frames); i++) {
        noh_spring_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
        noh_spring *spring = made(&desc, &at);
        float ends[3 * JOINTS];
        uint32_t dropped = 0, time = 0;
        for (int n = 0; n < 3; n++) { /* carried to and fro, 2 s each */
            for (uint32_t begun = time; time < begun + 2 * SECOND;) {
                const uint32_t left = begun + 2 * SECOND - time, ticks = frames[i] < left ? frames[i] : left;
                time += ticks;
                at.position[0] += (n == 1 ? -1.0f : 1.0f) * (float)ticks / (float)SECOND;
                dropped += step_one(spring, &desc, &at, NULL, ticks);
            }
        }
        noh_spring_ends(spring, &desc, ends);
        for (int k = 0; k < 3 && !i; k++) at_60[k] = (double)ends[3 * (JOINTS - 1u) + (uint32_t)k];
        const double off = apart(ends + 3 * (JOINTS - 1u), at_60);
        print_message("# frames of %u ms: off 60 Hz by %.3f mm, %u ticks dropped\n", (unsigned)(frames[i] / 48u),
                      1000.0 * off, (unsigned)dropped);
        assert_true(off < (frames[i] > SECOND ? 0.02 : 1e-5));
        assert_int_equal(dropped, frames[i] > SECOND ? 3 * SECOND : 0);
        free(spring);
    }
}

/* A bone that falls onto a ball comes back to e^2 of its height, and rests in the end; 0 is as VRM has it. */
static void ends_bounce_off_colliders(void **state)
{
    const noh_spring_joint bone = { { 1.0f, 0.0f, 0.0f },  { 0.0f, 0.0f, 0.0f, 1.0f }, 0.0f, 0.0f, 0.05f,
                                    { 0.0f, -0.02f, 0.0f } };
    const noh_spring_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const noh_spring_collider ball = { { 0.9f, -0.5f, 0.0f }, { 0.9f, -0.5f, 0.0f }, 0.2f };
    (void)state;
    for (int i = 0; i < 4; i++) {
        const noh_spring_desc desc = { &bone, 1, 1, 0.25f * (float)i };
        noh_spring *spring = made(&desc, &at);
        float end[3], bottom = 0.0f, top = -1.0f, last = 0.0f;
        int fallen = 0;
        for (int n = 0; n < 2400; n++) {
            (void)step_one(spring, &desc, &at, &ball, SECOND / 60);
            noh_spring_ends(spring, &desc, end);
            fallen |= end[1] > last && n > 10;
            bottom = end[1] < bottom ? end[1] : bottom;
            if (fallen && n < 140 && end[1] > top) top = end[1];
            last = end[1];
        }
        const float e2 = desc.restitution * desc.restitution;
        print_message("# restitution %.2f: from %.3f m up to %.3f m, rests at %.3f\n", (double)desc.restitution,
                      (double)bottom, (double)top, (double)end[1]);
        assert_true(i == 0 || fabsf((top - bottom) / -bottom - e2) < 0.1f);
        assert_true(fabsf(end[1] - bottom) < 0.01f);
        free(spring);
    }
    const noh_spring_desc bad = { &bone, 1, 1, 1.5f };
    assert_int_equal(noh_spring_check_desc(&bad, NULL), NOH_ERR_ARG);
}

static void time_may_be_cut_anywhere(void **state)
{
    const noh_spring_desc desc = hanging(2.0f, 0.2f, 0.5f);
    const noh_spring_carrier start = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    noh_spring *one = made(&desc, &start), *many = made(&desc, &start);
    float a[4 * JOINTS], b[4 * JOINTS];
    (void)state;
    for (int n = 1; n <= 100; n++) { /* 7,000 ticks at once, and as 1,000 at a time: a straight way in both */
        noh_spring_carrier at = start;
        const float from = n > 1 ? (float)(n - 1) * 0.1f : 0.0f;
        for (int k = 1; k <= 7; k++) {
            at.position[0] = from + 0.1f * (float)k / 7.0f;
            (void)step_one(many, &desc, &at, NULL, 1000);
        }
        (void)step_one(one, &desc, &at, NULL, 7000);
    }
    rotations_of(one, &desc, a);
    rotations_of(many, &desc, b);
    for (uint32_t i = 0; i < 4 * JOINTS; i++) assert_true(fabs((double)a[i] - (double)b[i]) < 1e-3);
    free(one);
    free(many);
}

/* Its rotations put its ends where it says they are, and bones keep their lengths. */
static void it_stays_whole(void **state)
{
    const noh_spring_desc desc = hanging(0.5f, 0.1f, 1.0f);
    noh_spring_carrier at = { { 0.0f, 1.5f, 1.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    noh_spring *spring = made(&desc, &at);
    double stretch = 0.0;
    (void)state;
    for (int n = 1; n <= 600; n++) {
        float ends[3 * JOINTS], rotations[4 * JOINTS], rotation[4], head[3];
        at = swaying(n / 60.0);
        (void)step_one(spring, &desc, &at, NULL, SECOND / 75u);
        noh_spring_ends(spring, &desc, ends);
        rotations_of(spring, &desc, rotations);
        memcpy(rotation, at.rotation, sizeof rotation);
        memcpy(head, at.position, sizeof head);
        for (uint32_t j = 0; j < JOINTS; j++) {
            float bone[3];
            double length = 0.0, there[3];
            noh_quat_mul(rotation, rotations + 4 * j, rotation);
            noh_quat_rotate(rotation, joints[j].bone, bone);
            for (int i = 0; i < 3; i++) {
                length += pow((double)ends[3 * j + (uint32_t)i] - (double)head[i], 2);
                there[i] = (double)head[i] + (double)bone[i];
            }
            assert_true(apart(ends + 3 * j, there) < 1e-5);
            stretch = fmax(stretch, fabs(sqrt(length) / 0.1 - 1.0));
            memcpy(head, ends + 3 * j, sizeof head);
        }
    }
    assert_true(stretch < 1e-4);
    free(spring);
}

static void leaps_and_long_times_stay_finite(void **state)
{
    const noh_spring_desc desc = hanging(4.0f, 0.0f, 2.0f);
    test_random random = test_random_from(5);
    noh_spring_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    noh_spring *spring = made(&desc, &at);
    float q[4 * JOINTS];
    (void)state;
    for (int n = 0; n < 3000; n++) {
        float by[3];
        for (int i = 0; i < 3; i++) {
            by[i] = test_random_float(&random, -3.0f, 3.0f);
            at.position[i] += test_random_float(&random, -50.0f, 50.0f);
        }
        noh_quat_from_rotation(by, at.rotation);
        (void)step_one(spring, &desc, &at, NULL, test_random_below(&random, 9000));
        rotations_of(spring, &desc, q);
        for (uint32_t i = 0; i < 4 * JOINTS; i++) assert_true(fabs((double)q[i]) <= 1.001);
    }
    /* a minute at once: a second is done, the rest told */
    assert_true(step_one(spring, &desc, &at, NULL, 60u * SECOND) >= 58u * SECOND);
    noh_spring_reset(spring, &desc, &at);
    rotations_of(spring, &desc, q);
    for (uint32_t j = 0; j < JOINTS; j++) assert_true(fabs((double)q[4 * j + 3]) > 0.99999);
    free(spring);
}

static void a_copy_goes_on(void **state)
{
    const noh_spring_desc desc = hanging(1.0f, 0.3f, 0.5f);
    noh_spring_carrier at = { { 0.0f, 1.5f, 1.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const size_t bytes = noh_spring_size(&desc);
    noh_spring *spring = made(&desc, &at), *copy = malloc(bytes);
    (void)state;
    for (int n = 1; n <= 200; n++) {
        if (n == 100) memcpy(copy, spring, bytes);
        at = swaying(n / 50.0);
        (void)step_one(spring, &desc, &at, NULL, 960);
        if (n >= 100) (void)step_one(copy, &desc, &at, NULL, 960);
    }
    assert_memory_equal(spring, copy, bytes);
    free(spring);
    free(copy);
}

/* ---- side by side ---- */

#define CHAINS 23u
#define CHAIN_JOINTS 9u

/* spring_lanes.c built again (Makefile, KERNELS) */
typedef uint32_t step_many(const noh_spring_move *moves, uint32_t count, uint32_t ticks, float *scratch);
typedef void rotate_many(const noh_spring_move *moves, uint32_t count);
step_many noh_spring_step_scalar, noh_spring_step_sse2, noh_spring_step_avx2;
rotate_many noh_spring_rotations_scalar, noh_spring_rotations_sse2, noh_spring_rotations_avx2;

/* Chains of one to nine joints with none to eight colliders, of two descs' worth of numbers. */
typedef struct bundle {
    noh_spring_joint joints[CHAINS][CHAIN_JOINTS];
    noh_spring_desc descs[CHAINS];
    noh_spring *springs[CHAINS];
    noh_spring_carrier carriers[CHAINS];
    noh_spring_collider colliders[COLLIDERS];
    float rotations[CHAINS][CHAIN_JOINTS][4], scratch[NOH_SPRING_SCRATCH_FLOATS(COLLIDERS)];
    noh_touches touches[CHAIN_JOINTS];
    noh_spring_move moves[CHAINS];
} bundle;

static void carry(bundle *b, uint32_t chain, double seconds)
{
    b->carriers[chain] = swaying(seconds + chain);
    b->carriers[chain].position[1] += 0.02f * (float)chain;
}

/* None to three planes for each joint, one of them right through the chains; two chains of three meet them. */
static void meet_planes(bundle *b)
{
    static const noh_plane planes[3] = { { { 0.0f, 1.0f, 0.0f }, -0.25f },
                                         { { 0.6f, 0.0f, 0.8f }, -0.1f },
                                         { { 0.0f, 0.0f, -1.0f }, -0.02f } };
    for (uint32_t j = 0; j < CHAIN_JOINTS; j++) {
        b->touches[j].count = (j + 1u) % 4u;
        for (uint32_t k = 0; k < 3; k++) b->touches[j].at[k].plane = planes[k];
    }
    for (uint32_t n = 0; n < CHAINS; n++) b->moves[n].touches = n % 3u ? b->touches : NULL;
}

static bundle *make_bundle(void)
{
    test_random random = test_random_from(11);
    bundle *b = test_zeros(sizeof *b);
    for (uint32_t k = 0; k < COLLIDERS; k++) {
        noh_spring_collider *c = &b->colliders[k];
        for (int i = 0; i < 3; i++) c->from[i] = c->to[i] = test_random_float(&random, -0.4f, 0.4f);
        c->from[1] += 1.4f, c->to[1] += 1.4f, c->from[2] += 1.0f, c->to[2] += 1.0f;
        if (k % 3u) c->to[k % 3u] += 0.3f;
        c->radius = 0.12f;
    }
    for (uint32_t n = 0; n < CHAINS; n++) {
        const uint32_t colliders = (5u * n) % (COLLIDERS + 1u);
        for (uint32_t j = 0; j < CHAIN_JOINTS; j++) {
            noh_spring_joint *to = &b->joints[n][j];
            const float by[3] = { test_random_float(&random, -0.5f, 0.5f), test_random_float(&random, -2.5f, 2.5f),
                                  0.2f };
            *to = (noh_spring_joint){ { 0.01f, -test_random_float(&random, 0.02f, 0.1f), 0.0f },
                                      { 0 },
                                      test_random_float(&random, 0.0f, 3.0f),
                                      test_random_float(&random, 0.0f, 0.6f),
                                      0.02f,
                                      { 0.0f, -0.4f, 0.1f } };
            noh_quat_from_rotation(by, to->rest);
        }
        b->descs[n] = (noh_spring_desc){ b->joints[n], 1u + n % CHAIN_JOINTS, colliders, 0.125f * (float)(n % 3u) };
        carry(b, n, 0.0);
        b->springs[n] = made(&b->descs[n], &b->carriers[n]);
        b->moves[n] = (noh_spring_move){ b->springs[n], &b->descs[n],       &b->carriers[n],
                                         b->colliders,  b->rotations[n][0], NULL };
    }
    return b;
}

static void free_bundle(bundle *b)
{
    for (uint32_t n = 0; n < CHAINS; n++) free(b->springs[n]);
    free(b);
}

/* Five seconds in frames of any length, in calls of `at_once` chains; a hash of every byte and rotation. */
static uint32_t hash_of_bundle(step_many *step, rotate_many *turn, uint32_t at_once, int meets)
{
    bundle *b = make_bundle();
    uint32_t crc = 0;
    if (meets) meet_planes(b);
    for (uint32_t f = 1; f <= 300; f++) {
        for (uint32_t n = 0; n < CHAINS; n++) carry(b, n, f / 60.0);
        for (uint32_t k = 0; k < COLLIDERS; k++) b->colliders[k].from[0] += k & 1u ? 1e-3f : -1e-3f;
        /* those that begin late are out of step with the others */
        for (uint32_t n = 0; n < CHAINS && f % 40u == 0; n += 3) {
            noh_spring_reset(b->springs[n], &b->descs[n], &b->carriers[n]);
        }
        for (uint32_t n = 0; n < CHAINS; n += at_once) {
            const uint32_t count = CHAINS - n < at_once ? CHAINS - n : at_once;
            step(b->moves + n, count, f % 50u ? 500u + f : 20000u, b->scratch);
            turn(b->moves + n, count);
        }
        for (uint32_t n = 0; n < CHAINS; n++) {
            crc = noh_crc32c(crc, b->springs[n], noh_spring_size(&b->descs[n]));
            crc = noh_crc32c(crc, b->rotations[n], b->descs[n].joint_count * 4u * sizeof(float));
        }
    }
    for (uint32_t n = 0; n < CHAINS; n++) assert_null(noh_spring_check(b->springs[n], &b->descs[n]));
    free_bundle(b);
    return crc;
}

static void every_width_and_company_gives_the_same_bits(void **state)
{
    static const uint32_t crcs[2] = { BUNDLE_CRC, MEETING_CRC }; /* on every processor */
    (void)state;
    for (int meets = 0; meets < 2; meets++) {
        const uint32_t crc = hash_of_bundle(noh_spring_step, noh_spring_rotations, CHAINS, meets);
        assert_int_equal(hash_of_bundle(noh_spring_step, noh_spring_rotations, 1, meets), crc);
        assert_int_equal(hash_of_bundle(noh_spring_step, noh_spring_rotations, 3, meets), crc);
#if defined(__x86_64__) /* elsewhere the tests are linked with the library's own width alone */
        assert_int_equal(hash_of_bundle(noh_spring_step_scalar, noh_spring_rotations_scalar, CHAINS, meets), crc);
        assert_int_equal(hash_of_bundle(noh_spring_step_sse2, noh_spring_rotations_sse2, 5, meets), crc);
        if (__builtin_cpu_supports("avx2")) {
            assert_int_equal(hash_of_bundle(noh_spring_step_avx2, noh_spring_rotations_avx2, CHAINS, meets), crc);
        }
#endif
        print_message("# %u chains by every width: %08x\n", CHAINS, crc);
        assert_int_equal(crc, crcs[meets]);
    }
}

/* A chain that hangs straight down is lowered onto a plane, which leaves it no direction to turn to; then the plane
 * leans. As shown, its ends are in front by their radius, and its bones have their lengths. */
static void ends_are_shown_in_front_of_planes(void **state)
{
    const noh_spring_desc desc = hanging(1.0f, 0.2f, 1.0f);
    noh_spring_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    noh_spring *spring = made(&desc, &at);
    noh_touches touches[JOINTS];
    float turned[JOINTS][4], deepest = 0.0f;
    (void)state;
    memset(touches, 0, sizeof touches);
    for (uint32_t f = 0; f < 240; f++) {
        const noh_spring_move move = { spring, &desc, &at, NULL, turned[0], touches };
        const float lean = f < 120 ? 0.0f : 0.005f * (float)(f - 120u), normal[3] = { sinf(lean), cosf(lean), 0.0f };
        const float floor_at = f < 100 ? -1.0f + 0.0095f * (float)f : -0.05f;
        float end[3] = { 0.0f, 0.0f, 0.0f }, rotation[4];
        at.position[0] = 0.2f * sinf(0.1f * (float)f);
        noh_quat_from_rotation((const float[3]){ 0.0f, 0.05f * (float)f, 0.0f }, at.rotation);
        for (uint32_t i = 0; i < JOINTS; i++) {
            touches[i].count = 1;
            memcpy(touches[i].at[0].plane.normal, normal, sizeof normal);
            touches[i].at[0].plane.distance = floor_at;
        }
        noh_spring_step(&move, 1, f % 3u ? 800 : 500, NULL);
        noh_spring_rotations(&move, 1);
        memcpy(rotation, at.rotation, sizeof rotation);
        for (uint32_t i = 0; i < JOINTS; i++) {
            float bone[3];
            noh_quat_mul(rotation, turned[i], rotation);
            noh_quat_rotate(rotation, desc.joints[i].bone, bone);
            for (int k = 0; k < 3; k++) end[k] += bone[k];
            const float over = normal[0] * end[0] + normal[1] * end[1] - floor_at - desc.joints[i].radius;
            deepest = fmaxf(deepest, -over);
            if (!(over > -1e-4f)) fail_msg("frame %u: end %u is %.2f mm deep", f, i, -1e3 * (double)over);
        }
    }
    print_message("# at most %.4f mm deep\n", 1e3 * (double)deepest);
    assert_null(noh_spring_check(spring, &desc));
    free(spring);
}

static void bad_values_are_refused(void **state)
{
    noh_spring_desc desc = hanging(1.0f, 0.3f, 0.5f);
    const noh_spring_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const size_t bytes = noh_spring_size(&desc);
    void *memory = malloc(bytes);
    noh_spring *spring = NULL;
    noh_error error;
    (void)state;
    assert_int_equal(bytes, (104 + 28 * JOINTS + 15) / 16 * 16);
    assert_int_equal(noh_spring_init(memory, bytes - 1, &desc, &at, &spring, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_spring_init(NULL, bytes, &desc, &at, &spring, &error), NOH_ERR_ARG);
    joints[2].bone[1] = 0.0f;
    assert_int_equal(noh_spring_init(memory, bytes, &desc, &at, &spring, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 2);
    desc = hanging(NAN, 0.3f, 0.5f);
    assert_int_equal(noh_spring_init(memory, bytes, &desc, &at, &spring, &error), NOH_ERR_ARG);
    desc = hanging(1.0f, 1.5f, 0.5f);
    assert_int_equal(noh_spring_init(memory, bytes, &desc, &at, &spring, &error), NOH_ERR_ARG);
    desc.joint_count = NOH_SPRING_JOINTS_MAX + 1u;
    assert_int_equal(noh_spring_size(&desc), 0);
    assert_int_equal(noh_spring_init(memory, bytes, &desc, &at, &spring, &error), NOH_ERR_LIMIT);
    assert_null(spring);
    free(memory);
}

/* The largest numbers that init takes swing to rotations; larger ones are refused, finite or not. */
static void the_largest_numbers_swing(void **state)
{
    static const float wild[] = { NAN, INFINITY, -FLT_MAX, 1e30f, 1e18f };
    noh_spring_desc desc = hanging(1.0f, 0.3f, 0.5f);
    noh_spring_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const size_t bytes = noh_spring_size(&desc);
    void *memory = malloc(bytes);
    noh_spring *spring = NULL;
    (void)state;
    for (size_t w = 0; w < sizeof wild / sizeof *wild; w++) {
        float *const numbers[] = { &joints[1].bone[2], &joints[1].stiffness, &joints[1].radius,
                                   &joints[1].gravity[0], &at.position[1],   &at.rotation[0] };
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
            const float kept = *numbers[i];
            *numbers[i] = wild[w];
            assert_int_equal(noh_spring_init(memory, bytes, &desc, &at, &spring, NULL), NOH_ERR_ARG);
            *numbers[i] = kept;
        }
    }
    for (int i = 0; i < 3; i++) joints[1].bone[i] = 1e9f, at.position[i] = NOH_NUMBER_MAX;
    joints[1].stiffness = joints[2].gravity[0] = NOH_NUMBER_MAX;
    assert_int_equal(noh_spring_init(memory, bytes, &desc, &at, &spring, NULL), NOH_OK);
    for (int step = 0; step < 30; step++) {
        float rotations[JOINTS][4];
        const noh_spring_move move = { spring, &desc, &at, NULL, rotations[0], NULL };
        at.position[0] = step & 1 ? -NOH_NUMBER_MAX : NOH_NUMBER_MAX;
        (void)noh_spring_step(&move, 1, 800u, NULL);
        noh_spring_rotations(&move, 1);
        for (uint32_t j = 0; j < JOINTS; j++) {
            float square = 0.0f;
            for (int i = 0; i < 4; i++) square += rotations[j][i] * rotations[j][i];
            assert_true(square > 0.9f && square < 1.1f);
        }
    }
    free(memory);
}

/* A carrier that init refuses moves nothing, by any number of steps: the chain hangs where it was, its state is taken,
 * and it goes on from there. */
static void a_wild_carrier_moves_nothing(void **state)
{
    static const float wild[] = { NAN, INFINITY, -1e30f };
    static const uint32_t ticks[] = { 400u, 800u, 5u * SECOND };
    const noh_spring_desc desc = hanging(1.0f, 0.3f, 0.5f);
    const noh_spring_carrier at = { { 1.0f, 2.0f, 3.0f }, { 0.0f, 0.6f, 0.0f, 0.8f } };
    const size_t bytes = noh_spring_size(&desc);
    (void)state;
    for (size_t i = 0; i < 2u * TEST_COUNT(wild) * TEST_COUNT(ticks); i++) {
        const float number = wild[i / 2u % TEST_COUNT(wild)];
        noh_spring_carrier bad = at;
        noh_spring *one = made(&desc, &at), *other = made(&desc, &at);
        *(i & 1u ? &bad.position[1] : &bad.rotation[3]) = number;
        (void)step_one(one, &desc, &at, NULL, ticks[i / 6u]);
        (void)step_one(one, &desc, &bad, NULL, ticks[i / 6u]);
        assert_null(noh_spring_check(one, &desc));
        (void)step_one(one, &desc, &at, NULL, SECOND / 4u);
        (void)step_one(other, &desc, &at, NULL, ticks[i / 6u]);
        (void)step_one(other, &desc, &at, NULL, ticks[i / 6u]);
        (void)step_one(other, &desc, &at, NULL, SECOND / 4u);
        assert_memory_equal(one, other, bytes);
        free(one);
        free(other);
    }
}

int main(int argument_count, char **arguments)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(sixty_hertz_is_the_reference),
        cmocka_unit_test(every_rate_settles_alike),
        cmocka_unit_test(drag_does_not_depend_on_frames),
        cmocka_unit_test(seldom_frames_are_run_whole),
        cmocka_unit_test(ends_bounce_off_colliders),
        cmocka_unit_test(time_may_be_cut_anywhere),
        cmocka_unit_test(it_stays_whole),
        cmocka_unit_test(leaps_and_long_times_stay_finite),
        cmocka_unit_test(a_copy_goes_on),
        cmocka_unit_test(ends_are_shown_in_front_of_planes),
        cmocka_unit_test(every_width_and_company_gives_the_same_bits),
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(the_largest_numbers_swing),
        cmocka_unit_test(a_wild_carrier_moves_nothing),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
