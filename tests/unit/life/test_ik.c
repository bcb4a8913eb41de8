/* Tests of runtime/sim/ik*.c in closed form: ends on their targets, poles, limits, and a million cases at random.
 * cross: slow, a million cases */
#include "life/reach/rig_internal.h"
#include "life/reach/gaze_internal.h"
#include "noh/body.h"
#include "noh/low_core.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define LIMB_M 0.58 /* an upper arm of 300 mm, a forearm of 280 mm */
#define DEGREE (3.14159265358979 / 180.0)

typedef struct reached {
    float middle[3], end[3];
} reached;

/* What the rotations do to the limb. */
static reached apply(const noh_ik_limb *limb, const noh_ik_bend *bend)
{
    reached r;
    float upper[3], lower[3];
    for (int i = 0; i < 3; i++) {
        upper[i] = limb->middle[i] - limb->start[i];
        lower[i] = limb->end[i] - limb->middle[i];
    }
    noh_quat_rotate(bend->start, upper, upper);
    noh_quat_rotate(bend->start, lower, lower);
    noh_quat_rotate(bend->middle, lower, lower);
    for (int i = 0; i < 3; i++) {
        r.middle[i] = limb->start[i] + upper[i];
        r.end[i] = r.middle[i] + lower[i];
    }
    return r;
}

static double apart(const float a[3], const float b[3])
{
    const double x = (double)a[0] - (double)b[0], y = (double)a[1] - (double)b[1], z = (double)a[2] - (double)b[2];
    return sqrt(x * x + y * y + z * z);
}

static void random_direction(test_random *random, float length, float v[3])
{
    double square = 0.0;
    do {
        square = 0.0;
        for (int i = 0; i < 3; i++) {
            v[i] = test_random_float(random, -1.0f, 1.0f);
            square += (double)v[i] * (double)v[i];
        }
    } while (square > 1.0 || square < 1e-4);
    for (int i = 0; i < 3; i++) v[i] = (float)((double)v[i] / sqrt(square) * (double)length);
}

static noh_ik_limb random_limb(test_random *random, float upper, float lower)
{
    noh_ik_limb limb;
    float u[3], v[3];
    memset(&limb, 0, sizeof limb);
    random_direction(random, upper, u);
    random_direction(random, lower, v);
    for (int i = 0; i < 3; i++) {
        limb.start[i] = test_random_float(random, -1.0f, 1.0f);
        limb.middle[i] = limb.start[i] + u[i];
        limb.end[i] = limb.middle[i] + v[i];
    }
    return limb;
}

static void is_unit(const float q[4])
{
    const double square = (double)q[0] * (double)q[0] + (double)q[1] * (double)q[1] + (double)q[2] * (double)q[2] +
                          (double)q[3] * (double)q[3];
    assert_true(fabs(square - 1.0) < 1e-5);
}

static void an_end_meets_its_target(void **state)
{
    test_random random = test_random_from(1);
    double worst = 0.0;
    (void)state;
    for (int n = 0; n < 200000; n++) {
        noh_ik_limb limb = random_limb(&random, 0.3f, 0.28f);
        float to[3], target[3], pole[3];
        noh_ik_bend bend;
        reached r;
        random_direction(&random, test_random_float(&random, 0.021f, 0.5799f), to);
        random_direction(&random, 1.0f, pole);
        for (int i = 0; i < 3; i++) target[i] = limb.start[i] + to[i];
        noh_ik_two_bone(&limb, target, n & 1 ? pole : NULL, 1.0f, &bend);
        r = apply(&limb, &bend);
        is_unit(bend.start);
        is_unit(bend.middle);
        worst = apart(r.end, target) > worst ? apart(r.end, target) : worst;
        assert_true(fabs(apart(r.end, target) - (double)bend.missed) < 2e-5 * LIMB_M);
    }
    print_message("# off by at most %.2f um of 580 mm\n", 1e6 * worst);
    assert_true(worst <= 10e-6);
}

/* How far the middle joint is off the line to a target, by the law of cosines. */
static double bend_height(const float to[3])
{
    const double square = (double)to[0] * (double)to[0] + (double)to[1] * (double)to[1] + (double)to[2] * (double)to[2];
    const double x = (0.3 * 0.3 - 0.28 * 0.28 + square) / (2.0 * sqrt(square));
    return sqrt(0.3 * 0.3 - x * x);
}

/* All of the bend's height lies in the pole's direction. */
static void it_bends_towards_the_pole(void **state)
{
    test_random random = test_random_from(2);
    (void)state;
    for (int n = 0; n < 20000; n++) {
        noh_ik_limb limb = random_limb(&random, 0.3f, 0.28f);
        float to[3], target[3], pole[3], side[3];
        double along = 0.0, cross = 0.0, size = 0.0, height = 0.0, across[3];
        noh_ik_bend bend;
        reached r;
        random_direction(&random, test_random_float(&random, 0.1f, 0.5f), to);
        random_direction(&random, 1.0f, pole);
        for (int i = 0; i < 3; i++) target[i] = limb.start[i] + to[i];
        noh_ik_two_bone(&limb, target, pole, 1.0f, &bend);
        r = apply(&limb, &bend);
        for (int i = 0; i < 3; i++) {
            side[i] = r.middle[i] - limb.start[i];
            size += (double)to[i] * (double)to[i];
        }
        for (int i = 0; i < 3; i++) {
            along += (double)side[i] * (double)to[i] / size;
            cross += (double)pole[i] * (double)to[i] / size;
        }
        size = 0.0;
        for (int i = 0; i < 3; i++) {
            across[i] = (double)pole[i] - cross * (double)to[i];
            height += ((double)side[i] - along * (double)to[i]) * across[i];
            size += across[i] * across[i];
        }
        if (size < 1e-3) continue; /* in line with it */
        assert_true(height / sqrt(size) > 0.999 * bend_height(to));
    }
}

static double turned(const float a[4], const float b[4])
{
    double dot = 0.0;
    for (int i = 0; i < 4; i++) dot += (double)a[i] * (double)b[i];
    dot = fabs(dot) > 1.0 ? 1.0 : fabs(dot);
    return 2.0 * acos(dot) / DEGREE;
}

/* How far the middle joint's rotation is from another's, as the start joint sees it. */
static double bent(const noh_ik_bend *a, const noh_ik_bend *b)
{
    float back[4], one[4], other[4];
    noh_quat_conjugate(a->start, back);
    noh_quat_mul(back, a->middle, one);
    noh_quat_mul(one, a->start, one);
    noh_quat_conjugate(b->start, back);
    noh_quat_mul(back, b->middle, other);
    noh_quat_mul(other, b->start, other);
    return turned(one, other);
}

/* A target that moves by a millimetre turns no joint by more than two degrees, 15 degrees and more off the line of the
 * pole: on it the bend's side turns without bound, whatever the solver. */
static void it_is_continuous(void **state)
{
    test_random random = test_random_from(3);
    double worst = 0.0;
    (void)state;
    for (int n = 0; n < 200000; n++) {
        noh_ik_limb limb = random_limb(&random, 0.3f, 0.28f);
        const float pole[3] = { 0.0f, 0.0f, 1.0f };
        float to[3], target[3], moved[3], step[3];
        noh_ik_bend a, b;
        const float distance = test_random_float(&random, 0.1f, 0.8f);
        limb.soft = 0.97f;
        random_direction(&random, distance, to);
        if (fabs((double)to[2]) > cos(15.0 * DEGREE) * (double)distance) continue;
        random_direction(&random, 0.001f, step);
        for (int i = 0; i < 3; i++) {
            target[i] = limb.start[i] + to[i];
            moved[i] = target[i] + step[i];
        }
        noh_ik_two_bone(&limb, target, pole, 1.0f, &a);
        noh_ik_two_bone(&limb, moved, pole, 1.0f, &b);
        worst = fmax(worst, turned(a.start, b.start));
        worst = fmax(worst, bent(&a, &b));
    }
    print_message("# a millimetre turns a joint by at most %.2f degrees\n", worst);
    assert_true(worst > 0.1 && worst <= 2.0);
}

/* A million cases, most of them degenerate: nothing but unit quaternions. */
static void nothing_makes_it_a_nan(void **state)
{
    static const float lengths[] = { 0.0f, 1e-20f, 1e-6f, 0.28f, 0.3f, 1000.0f };
    test_random random = test_random_from(4);
    (void)state;
    for (int n = 0; n < 1000000; n++) {
        const float a = lengths[test_random_below(&random, 6)], b = lengths[test_random_below(&random, 6)];
        noh_ik_limb limb = random_limb(&random, a, b);
        float target[3], pole[3];
        noh_ik_bend bend;
        const uint32_t at = test_random_below(&random, 6), towards = test_random_below(&random, 5);
        if (test_random_below(&random, 4) == 0) {
            for (int i = 0; i < 3; i++) limb.end[i] = limb.middle[i] + (limb.middle[i] - limb.start[i]);
        }
        random_direction(&random, at == 0 ? 1e-6f : at == 1 ? 1e6f : 0.4f, target);
        for (int i = 0; i < 3; i++) {
            target[i] = at == 2 ? limb.start[i] : at == 3 ? limb.end[i] : at == 4 ? limb.middle[i] : target[i];
            pole[i] = towards == 0   ? 0.0f
                      : towards == 1 ? target[i] - limb.start[i]
                      : towards == 2 ? limb.start[i] - target[i]
                                     : 1.0f;
        }
        limb.soft = n & 1 ? 0.97f : 0.0f;
        limb.bend_max = n & 2 ? 2.5f : 0.0f;
        noh_ik_two_bone(&limb, target, towards == 3 ? NULL : pole, n & 4 ? 1.0f : 0.5f, &bend);
        is_unit(bend.start);
        is_unit(bend.middle);
        assert_true(bend.missed >= 0.0f);
    }
}

static void limits_hold(void **state)
{
    test_random random = test_random_from(5);
    (void)state;
    for (int n = 0; n < 20000; n++) {
        noh_ik_limb limb = random_limb(&random, 0.3f, 0.28f);
        float to[3], target[3];
        noh_ik_bend bend;
        reached r;
        double cosine = 0.0;
        limb.bend_min = 0.1f;
        limb.bend_max = 2.0f;
        random_direction(&random, test_random_float(&random, 0.0f, 0.8f) + 1e-3f, to);
        for (int i = 0; i < 3; i++) target[i] = limb.start[i] + to[i];
        noh_ik_two_bone(&limb, target, NULL, 1.0f, &bend);
        r = apply(&limb, &bend);
        for (int i = 0; i < 3; i++) {
            cosine += (double)(r.middle[i] - limb.start[i]) * (double)(r.end[i] - r.middle[i]) / (0.3 * 0.28);
        }
        assert_true(cosine <= cos(0.1) + 1e-4 && cosine >= cos(2.0) - 1e-4);
    }
}

/* A limb that stretches slows down and never snaps straight. */
static void a_soft_limb_slows(void **state)
{
    noh_ik_limb limb = { { 0.0f, 0.0f, 0.0f }, { 0.3f, 0.0f, 0.0f }, { 0.3f, -0.28f, 0.0f }, 0.0f, 0.0f, 0.9f };
    double before = 0.0, step = 1.0;
    (void)state;
    for (int n = 0; n <= 100; n++) {
        const float target[3] = { 0.522f + 0.004f * (float)n, 0.0f, 0.0f };
        noh_ik_bend bend;
        reached r;
        noh_ik_two_bone(&limb, target, NULL, 1.0f, &bend);
        r = apply(&limb, &bend);
        if (n > 1) {
            assert_true((double)r.end[0] - before > 0.0 && (double)r.end[0] - before <= step + 1e-6);
            step = (double)r.end[0] - before;
        }
        before = (double)r.end[0];
    }
    assert_true(before < LIMB_M);
}

/* The book takes an arc cosine of (a^2 + b^2 - d^2) / 2 a b as it is: a target nearer than the bones' difference has a
 * cosine above 1. */
static void a_target_too_near_stays_finite(void **state)
{
    const float a = 0.5f, b = 0.3f, d = 0.1f;
    const noh_ik_limb limb = { { 0.0f, 0.0f, 0.0f }, { 0.5f, 0.0f, 0.0f }, { 0.5f, 0.3f, 0.0f }, 0.0f, 0.0f, 0.0f };
    const float target[3] = { 0.1f, 0.0f, 0.0f };
    noh_ik_bend bend;
    reached r;
    (void)state;
    assert_true(isnan(acosf((a * a + b * b - d * d) / (2.0f * a * b))));
    noh_ik_two_bone(&limb, target, NULL, 1.0f, &bend);
    r = apply(&limb, &bend);
    assert_true(fabs((double)r.end[0] - 0.2) < 1e-4 && fabs((double)bend.missed - 0.1) < 1e-4);
}

/* The book turns about the hinge's axis by the difference of angles, whichever side the forearm lies on: from a bend of
 * the other side that widens what should narrow. */
static void a_hinge_bends_by_its_own_side(void **state)
{
    const noh_ik_limb limb = { { 0.0f, 0.0f, 0.0f }, { 0.3f, 0.0f, 0.0f }, { 0.3f, -0.28f, 0.0f }, 0.0f, 0.0f, 0.0f };
    const float hinge[3] = { 0.0f, 0.0f, -1.0f }, target[3] = { 0.2f, 0.1f, 0.0f };
    const double distance = sqrt(0.2 * 0.2 + 0.1 * 0.1);
    const double now = 90.0 * DEGREE,
                 wanted = acos((0.3 * 0.3 + 0.28 * 0.28 - distance * distance) / (2.0 * 0.3 * 0.28));
    float by[3], q[4], lower[3] = { 0.0f, -0.28f, 0.0f };
    noh_ik_bend bend;
    reached r;
    (void)state;
    for (int i = 0; i < 3; i++) by[i] = (float)(wanted - now) * hinge[i];
    noh_quat_from_rotation(by, q);
    noh_quat_rotate(q, lower, lower);
    assert_true(fabs(sqrt((0.3 + (double)lower[0]) * (0.3 + (double)lower[0]) + (double)lower[1] * (double)lower[1]) -
                     distance) > 0.05);
    noh_ik_two_bone(&limb, target, NULL, 1.0f, &bend);
    r = apply(&limb, &bend);
    assert_true(apart(r.end, target) < 10e-6);
}

/* A bone of no length leaves nothing to divide by. */
static void a_bone_of_no_length_stays_finite(void **state)
{
    const float lengths[2][2] = { { 0.0f, 0.3f }, { 0.3f, 0.0f } }, target[3] = { 0.0f, 0.3f, 0.0f };
    (void)state;
    for (int n = 0; n < 2; n++) {
        const float a = lengths[n][0], b = lengths[n][1], d = 0.3f;
        const noh_ik_limb limb = { { 0.0f, 0.0f, 0.0f }, { a, 0.0f, 0.0f }, { a + b, 0.0f, 0.0f }, 0.0f, 0.0f, 0.0f };
        noh_ik_bend bend;
        assert_true(isnan(acosf((a * a + b * b - d * d) / (2.0f * a * b))));
        noh_ik_two_bone(&limb, target, NULL, 1.0f, &bend);
        is_unit(bend.start);
        is_unit(bend.middle);
        const reached r = apply(&limb, &bend);
        assert_true(apart(r.end, target) < 1e-3);
    }
}

/* The book returns where the shoulder has no axis to turn about, after it has turned the elbow: the hand's matrix is
 * still the earlier one. Here the elbow alone brings the hand onto the line to the target. */
static void the_hand_follows_whatever_the_elbow_does(void **state)
{
    const double a = 0.3, b = 0.28, d = 0.4, inner = acos((a * a + d * d - b * b) / (2.0 * a * d));
    const float target[3] = { (float)d, 0.0f, 0.0f }, turn[3] = { 0.0f, 0.0f, 30.0f * (float)DEGREE };
    noh_ik_limb limb = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f }, 0.0f, 0.0f, 0.0f };
    float lower[3], q[4], solved[3];
    noh_ik_bend bend;
    (void)state;
    limb.middle[0] = (float)(a * cos(inner));
    limb.middle[1] = (float)(a * sin(inner));
    for (int i = 0; i < 3; i++) lower[i] = target[i] - limb.middle[i];
    noh_quat_from_rotation(turn, q);
    noh_quat_rotate(q, lower, solved); /* 30 degrees off: what the elbow has to turn by */
    for (int i = 0; i < 3; i++) limb.end[i] = limb.middle[i] + solved[i];
    const float axis_z = (limb.middle[0] + lower[0]) * target[1] - (limb.middle[1] + lower[1]) * target[0];
    assert_true(fabsf(axis_z) < 1e-7f);         /* the book returns here */
    assert_true(apart(limb.end, target) > 0.1); /* and this is where its hand is drawn */
    noh_ik_two_bone(&limb, target, NULL, 1.0f, &bend);
    const reached r = apply(&limb, &bend);
    assert_true(apart(r.end, target) < 10e-6);
}

/* The book takes its hinge through a matrix with scale and turns about what comes out, however long it is. */
static void a_scaled_hinge_turns_as_far_as_an_unscaled_one(void **state)
{
    const float scale = 2.0f, by = 0.5f, target[3] = { 0.7f, 0.3f, 0.1f };
    const float hinge[3] = { 0.0f, 0.0f, -by * scale };
    const noh_ik_limb limb = {
        { 0.0f, 0.0f, 0.0f }, { 0.3f * scale, 0.0f, 0.0f }, { 0.3f * scale, -0.28f * scale, 0.0f }, 0.0f, 0.0f, 0.0f
    };
    noh_ik_bend bend;
    float q[4];
    (void)state;
    noh_quat_from_rotation(hinge, q);
    assert_true(fabs(2.0 * acos((double)q[3]) - (double)by) > 0.4);
    noh_ik_two_bone(&limb, target, NULL, 1.0f, &bend);
    const reached r = apply(&limb, &bend);
    assert_true(apart(r.end, target) < 2.0 * 10e-6);
}

/* ---- looking ---- */

#define CONE (float)(60.0 * DEGREE)

static const float ahead[3] = { 0.0f, 0.0f, 1.0f };

/* Where a look ends that has all the time that it needs. */
static double look_angle(float degrees, noh_ik_look *look, float rotation[4])
{
    const float target[3] = { (float)sin((double)degrees * DEGREE), 0.0f, (float)cos((double)degrees * DEGREE) };
    float v[3];
    noh_ik_look_step(look, CONE, 4.0f, ahead, target, 10.0f, rotation);
    noh_quat_rotate(rotation, ahead, v);
    return atan2((double)v[0], (double)v[2]) / DEGREE;
}

static void a_look_stays_in_its_cone(void **state)
{
    noh_ik_look look;
    float q[4];
    (void)state;
    noh_ik_look_init(&look, ahead);
    assert_true(fabs(look_angle(35.0f, &look, q) - 35.0) < 1e-3);
    assert_true(fabs(look_angle(-59.0f, &look, q) + 59.0) < 1e-3);
    assert_true(fabs(look_angle(70.0f, &look, q) - 60.0) < 1e-3);
    assert_true(fabs(look_angle(100.0f, &look, q) - 60.0) < 1e-3);
    assert_true(fabs(look_angle(-159.0f, &look, q) + 60.0) < 1e-3);
    assert_true(fabs(look_angle(58.0f, &look, q) - 58.0) < 1e-3);
}

/* Round about: min(angle, 60 degrees), continuous where the target enters and leaves the cone; behind it stays over the
 * shoulder where it came from, and changes sides once, 20 degrees past straight behind. */
static void a_target_goes_round_a_look(void **state)
{
    for (int way = -1; way <= 1; way += 2) {
        noh_ik_look look;
        float q[4];
        noh_ik_look_init(&look, ahead);
        for (int d = 0; d < 360; d++) {
            const double angle = look_angle((float)(way * d), &look, q) * way;
            if (d == 200) continue; /* rounding has the choice */
            const double wanted = d < 200 ? fmin(d, 60.0) : fmax(d - 360.0, -60.0);
            if (fabs(angle - wanted) > 1e-2) fail_msg("%g at %d, not %g", angle, d, wanted);
        }
    }
    (void)state;
}

/* A target that is behind and moves from side to side swings the book's head about, from one limit to the other. */
static void a_target_behind_does_not_swing_the_head(void **state)
{
    noh_ik_look look;
    double least = 360.0, most = -360.0;
    float q[4];
    (void)state;
    double book[2];
    for (int n = 0; n < 2; n++) { /* about f x t, by no more than its 60 degrees */
        const double at = (n ? 179.0 : -179.0) * DEGREE, axis_y = sin(at);
        book[n] = fmin(acos(cos(at)), 60.0 * DEGREE) * axis_y / fabs(axis_y) / DEGREE;
    }
    assert_true(book[1] - book[0] > 119.0);
    noh_ik_look_init(&look, ahead);
    (void)look_angle(50.0f, &look, q);
    for (int n = 0; n < 100; n++) {
        const double angle = look_angle(n & 1 ? 179.0f : -179.0f, &look, q);
        least = fmin(least, angle);
        most = fmax(most, angle);
    }
    assert_true(most - least < 1e-3);
}

static void a_look_turns_no_faster_than_it_can(void **state)
{
    test_random random = test_random_from(6);
    noh_ik_look look;
    (void)state;
    noh_ik_look_init(&look, ahead);
    for (int n = 0; n < 10000; n++) {
        float target[3], q[4], before[3];
        double dot = 0.0, front = 0.0;
        memcpy(before, look.direction, sizeof before);
        random_direction(&random, 1.0f, target);
        noh_ik_look_step(&look, CONE, 2.0f, ahead, target, 0.01f, q);
        is_unit(q);
        for (int i = 0; i < 3; i++) {
            dot += (double)before[i] * (double)look.direction[i];
            front += (double)ahead[i] * (double)look.direction[i];
        }
        assert_true(acos(fmin(dot, 1.0)) <= 0.02 + 1e-3);
        assert_true(acos(fmin(front, 1.0)) <= 60.0 * DEGREE + 1e-3);
    }
}

/* One step of a second and a hundred of a hundredth end at the same place. */
static void a_look_does_not_depend_on_steps(void **state)
{
    const float target[3] = { 0.6f, 0.3f, 0.7f };
    noh_ik_look one, many;
    float q[4];
    (void)state;
    noh_ik_look_init(&one, ahead);
    noh_ik_look_init(&many, ahead);
    noh_ik_look_step(&one, CONE, 0.5f, ahead, target, 1.0f, q);
    for (int n = 0; n < 100; n++) noh_ik_look_step(&many, CONE, 0.5f, ahead, target, 0.01f, q);
    assert_true(apart(one.direction, many.direction) < 1e-4);
}

/* Vectors that are parallel have no product: the book makes its length 1. */
static void opposite_vectors_get_an_axis(void **state)
{
    const float behind[3] = { 0.0f, 0.0f, -1.0f }, axis[3] = { 0.0f, 0.0f, 0.0f }; /* ahead x behind */
    noh_ik_look look;
    (void)state;
    assert_true(isnan(axis[0] / sqrtf(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2])));
    for (int n = 0; n < 2; n++) {
        float q[4], v[3];
        noh_ik_look_init(&look, ahead);
        noh_ik_look_step(&look, 3.14159265f, 1.0f, ahead, n ? behind : ahead, 10.0f, q);
        is_unit(q);
        noh_quat_rotate(q, ahead, v);
        assert_true(n ? v[2] < -0.99f : v[2] > 0.9999f);
    }
}

/* The book takes acos(f . t) of float vectors of length 1: where both are the same vector the dot product is often
 * above 1, and then there is no angle. */
static void aligned_vectors_turn_nothing(void **state)
{
    test_random random = test_random_from(7);
    int bad = 0;
    (void)state;
    for (int n = 0; n < 10000; n++) {
        noh_ik_look look;
        float v[3], q[4], length;
        random_direction(&random, 2.0f, v);
        length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int i = 0; i < 3; i++) v[i] /= length;
        bad += isnan(acosf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])) != 0;
        noh_ik_look_init(&look, v);
        noh_ik_look_step(&look, CONE, 4.0f, v, v, 1.0f, q);
        is_unit(q);
        assert_true(fabs((double)q[3]) > 0.999999);
    }
    assert_true(bad > 500);
}

static void shares_add_up(void **state)
{
    const float by[3] = { 0.3f, -0.8f, 0.2f };
    static const float shares[] = { 0.1f, 0.2f, 0.3f, 0.4f };
    float q[4], sum[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    (void)state;
    noh_quat_from_rotation(by, q);
    for (int i = 0; i < 4; i++) {
        float part[4];
        noh_ik_share(q, shares[i], part);
        noh_quat_mul(part, sum, sum);
    }
    assert_true(turned(q, sum) < 0.05);
}

int main(int argument_count, char **arguments)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_end_meets_its_target),
        cmocka_unit_test(it_bends_towards_the_pole),
        cmocka_unit_test(it_is_continuous),
        cmocka_unit_test(nothing_makes_it_a_nan),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(a_soft_limb_slows),
        cmocka_unit_test(a_target_too_near_stays_finite),
        cmocka_unit_test(a_hinge_bends_by_its_own_side),
        cmocka_unit_test(a_bone_of_no_length_stays_finite),
        cmocka_unit_test(the_hand_follows_whatever_the_elbow_does),
        cmocka_unit_test(a_scaled_hinge_turns_as_far_as_an_unscaled_one),
        cmocka_unit_test(opposite_vectors_get_an_axis),
        cmocka_unit_test(a_look_stays_in_its_cone),
        cmocka_unit_test(a_target_goes_round_a_look),
        cmocka_unit_test(a_target_behind_does_not_swing_the_head),
        cmocka_unit_test(a_look_turns_no_faster_than_it_can),
        cmocka_unit_test(a_look_does_not_depend_on_steps),
        cmocka_unit_test(aligned_vectors_turn_nothing),
        cmocka_unit_test(shares_add_up),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
