/* Tests of hair.c: a wig of forty hairs on a head of four spheres. Errata tests have the source's formulas
 * beside ours. */
#include "life/hair/hair_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define HAIRS 40u
#define POINTS 12u
#define ALL (HAIRS * POINTS)
#define SECOND 48000u
#define SEGMENT 0.03f
#define CRC_OF_1 0x7f6d3b19u
#define CRC_OF_13 0x1319b79cu
#define CRC_OF_40 0x2e62fbe0u

static float rest[3u * ALL];
static const noh_hair_sphere head[4] = { { { 0.0f, 0.08f, -0.01f }, 0.09f },
                                         { { 0.0f, 0.05f, 0.03f }, 0.085f },
                                         { { 0.03f, 0.02f, 0.0f }, 0.08f },
                                         { { -0.03f, 0.02f, 0.0f }, 0.08f } };
static const noh_hair_carrier still = { { 0.0f, 1.5f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, { 0.0f, 0.0f, 0.0f } };

/* Roots on a ring about the top, from where hair goes out a little and then down. */
static noh_hair_desc wig(void)
{
    noh_hair_desc d;
    memset(&d, 0, sizeof d);
    for (uint32_t h = 0; h < HAIRS; h++) {
        const float a = 6.2831853f * (float)h / (float)HAIRS, x = (float)sin((double)a), z = (float)cos((double)a);
        float *p = rest + 3u * POINTS * h;
        p[0] = 0.115f * x, p[1] = 0.12f, p[2] = 0.125f * z;
        for (uint32_t i = 1; i < POINTS; i++) {
            const float out = i < 3u ? 0.6f : 0.02f, down = sqrtf(1.0f - out * out);
            p[3u * i] = p[3u * i - 3u] + SEGMENT * out * x;
            p[3u * i + 1u] = p[3u * i - 2u] - SEGMENT * down;
            p[3u * i + 2u] = p[3u * i - 1u] + SEGMENT * out * z;
        }
    }
    d.rest = rest, d.hair_count = HAIRS, d.point_count = POINTS;
    d.spheres = head, d.sphere_count = 4;
    d.seed = 7, d.pull = 0.02f, d.pull_at_tip = 0.005f, d.damping = 3.0f;
    return d;
}

static noh_hair *made(const noh_hair_desc *d)
{
    const size_t bytes = noh_hair_size(d);
    noh_hair *hair;
    void *memory = malloc(bytes);
    assert_int_equal(noh_hair_init(memory, bytes, d, &still, &hair, NULL), NOH_OK);
    return hair;
}

static double apart(const float a[3], const float b[3])
{
    double sum = 0.0;
    for (int i = 0; i < 3; i++) sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sqrt(sum);
}

typedef struct worst {
    double stretch, entered, moved; /* share, metres, metres from rest */
} worst;

static void look(const noh_hair *hair, const noh_hair_desc *d, worst *w)
{
    static float points[3u * ALL];
    noh_hair_points(hair, d, points);
    for (uint32_t i = 0; i < ALL; i++) {
        const float *p = points + 3u * i;
        for (int c = 0; c < 3; c++) assert_true(isfinite(p[c]));
        w->moved = fmax(w->moved, apart(p, rest + 3u * i));
        for (uint32_t s = 0; s < d->sphere_count; s++) {
            w->entered = fmax(w->entered, (double)head[s].radius - apart(p, head[s].centre));
        }
        if (i % POINTS)
            w->stretch = fmax(w->stretch, fabs(apart(p, p - 3) / apart(rest + 3u * i, rest + 3u * i - 3) - 1));
    }
}

/* A head that shakes, nods and walks. */
static noh_hair_carrier shaken(double seconds, double hard)
{
    const float by[3] = { (float)(0.4 * hard * sin(7.0 * seconds)), (float)(0.9 * hard * sin(9.0 * seconds)),
                          (float)(0.2 * hard * sin(5.0 * seconds)) };
    noh_hair_carrier c = still;
    noh_quat_from_rotation(by, c.rotation);
    c.position[0] = (float)(0.1 * hard * sin(11.0 * seconds));
    c.position[2] = (float)seconds;
    return c;
}

static void lengths_and_spheres_hold(void **state)
{
    const noh_hair_desc d = wig();
    noh_hair *hair = made(&d);
    worst w = { 0.0, 0.0, 0.0 };
    (void)state;
    for (uint32_t f = 1; f <= 900; f++) {
        const noh_hair_carrier at = shaken(f / 90.0, 1.0);
        assert_int_equal(noh_hair_step(hair, &d, &at, SECOND / 90u), 0);
        look(hair, &d, &w);
    }
    print_message("# shaken for 10 s: stretched by %.2g, %.3f mm in spheres, %.0f mm off rest\n", w.stretch,
                  1e3 * w.entered, 1e3 * w.moved);
    assert_true(w.stretch <= 1e-3 && w.entered <= 1e-3 && w.moved > 0.05);
    free(hair);
}

/* Two turns of the head in two seconds; then all of it is where it was. */
static void two_turns_of_the_head_leave_none_behind(void **state)
{
    const noh_hair_desc d = wig();
    noh_hair *hair = made(&d);
    worst in = { 0.0, 0.0, 0.0 }, after = { 0.0, 0.0, 0.0 };
    (void)state;
    for (uint32_t f = 1; f <= 600; f++) {
        const double turned = fmin(f / 120.0, 1.0) * 2.0;
        noh_hair_carrier at = still;
        at.rotation[1] = (float)sin(3.14159265358979 * turned);
        at.rotation[3] = (float)cos(3.14159265358979 * turned);
        (void)noh_hair_step(hair, &d, &at, SECOND / 60u);
        look(hair, &d, f < 480u ? &in : &after);
    }
    print_message("# 720 degrees: %.0f mm off rest, %.2f mm six seconds later, %.3f mm in spheres\n", 1e3 * in.moved,
                  1e3 * after.moved, 1e3 * in.entered);
    assert_true(in.moved > 0.02 && after.moved < 0.01 && in.entered <= 1e-3 && in.stretch <= 1e-3);
    free(hair);
}

static void shakes_and_leaps_stay_finite(void **state)
{
    const noh_hair_desc d = wig();
    noh_hair *hair = made(&d);
    noh_hair_carrier at = still;
    worst w = { 0.0, 0.0, 0.0 }, after = { 0.0, 0.0, 0.0 };
    (void)state;
    for (uint32_t f = 1; f <= 300; f++) {
        at = shaken(f / 60.0, 4.0);
        if (f % 50u == 0) at.position[1] += 1e6f;
        (void)noh_hair_step(hair, &d, &at, SECOND / 60u);
        look(hair, &d, &w);
    }
    noh_hair_reset(hair, &d, &still);
    look(hair, &d, &after);
    assert_true(w.stretch <= 1e-3 && w.entered <= 1e-3);
    assert_true(after.moved < 0.02);
    assert_int_equal(noh_hair_step(hair, &d, &still, 10u * SECOND), 10u * SECOND - NOH_HAIR_STEPS_MAX * 800u);
    free(hair);
}

/* How far the tips are off after the head was carried aside, a second later. */
static void every_rate_moves_alike(void **state)
{
    static const uint32_t rates[] = { 15, 30, 60, 120, 240 };
    const noh_hair_desc d = wig();
    double at_60 = 0.0, off[5];
    (void)state;
    for (size_t r = 0; r < TEST_COUNT(rates); r++) {
        float points[3u * ALL];
        noh_hair *hair = made(&d);
        noh_hair_carrier at = still;
        for (uint32_t f = 1; f <= rates[r] / 3u; f++) {
            at.position[0] = 0.4f * (float)fmin((double)f / rates[r] * 5.0, 1.0);
            (void)noh_hair_step(hair, &d, &at, SECOND / rates[r]);
        }
        noh_hair_points(hair, &d, points);
        off[r] = 0.0;
        for (uint32_t h = 0; h < HAIRS; h++) {
            off[r] += apart(points + 3u * (POINTS * h + POINTS - 1u), rest + 3u * (POINTS * h + POINTS - 1u)) / HAIRS;
        }
        if (rates[r] == 60u) at_60 = off[r];
        free(hair);
    }
    for (size_t r = 0; r < TEST_COUNT(rates); r++) print_message("# %u Hz: %.2f mm off\n", rates[r], 1e3 * off[r]);
    for (size_t r = 0; r < TEST_COUNT(rates); r++) assert_true(fabs(off[r] - at_60) <= 0.03 * at_60);
}

/* Between a segment and the one before it, or for the first the one at rest; b: the points at rest. */
static double cosine_between(const float *a, const float *b)
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += ((double)a[3 + c] - (double)a[c]) * ((double)b[3 + c] - (double)b[c]);
    return sum / (apart(a + 3, a) * apart(b + 3, b));
}

/* Wind along a hair, from its tip to its root, and a head that turns at once bow it: no two segments fold up, no hair
 * makes a loop, and the root stays combed. */
static void wind_folds_no_hair(void **state)
{
    static const float winds[][3] = { { 0.0f, 12.0f, 0.0f }, { -12.0f, 0.0f, 0.0f }, { 7.0f, 7.0f, -7.0f }, { 0 } };
    noh_hair_desc d = wig();
    double folded = 0.0, combed = 1.0, moved = 0.0;
    (void)state;
    d.sphere_count = 0;
    for (size_t w = 0; w < TEST_COUNT(winds); w++) {
        noh_hair *hair = made(&d);
        noh_hair_carrier at = still;
        memcpy(at.wind, winds[w], sizeof at.wind);
        for (uint32_t f = 0; f < 240; f++) {
            static float points[3u * ALL];
            const float turn[3] = { 0.0f, w == TEST_COUNT(winds) - 1u ? 0.117f * (float)f : 0.0f, 0.0f };
            noh_quat_from_rotation(turn, at.rotation); /* 400 degrees a second */
            (void)noh_hair_step(hair, &d, &at, SECOND / 60u);
            noh_hair_points(hair, &d, points);
            for (uint32_t i = 0; i + 1u < ALL; i++) {
                const float *p = points + 3u * i, *r = rest + 3u * i;
                if (i % POINTS == 0) combed = fmin(combed, cosine_between(p, r));
                if (i % POINTS == 0 || i % POINTS == POINTS - 1u) continue;
                folded = fmax(folded, cosine_between(r, r - 3) - cosine_between(p, p - 3));
                moved = fmax(moved, apart(p, r));
            }
        }
        free(hair);
    }
    print_message("# bent by %.3f of a cosine, roots within %.3f, %.0f mm off rest\n", folded, combed, 1e3 * moved);
    assert_true(folded < 0.5 * pow(2.6 / (POINTS - 1.0), 2.0) + 2e-3 && combed > 0.89);
    assert_true(moved > 0.15);
}

/* Overlapping spheres hand a hair that the wind presses on them to each other; it stays on them, and does not stand up
 * against the wind. */
static void pressed_hair_stays_on_the_head(void **state)
{
    const noh_hair_desc d = wig();
    noh_hair *hair = made(&d);
    noh_hair_carrier at = still;
    float points[3u * ALL], least = 0.0f;
    (void)state;
    at.wind[0] = 12.0f;
    for (uint32_t f = 0; f < 120; f++) {
        assert_int_equal(noh_hair_step(hair, &d, &at, SECOND / 60u), 0);
        noh_hair_points(hair, &d, points);
        for (uint32_t i = 0; i < ALL; i++) least = fminf(least, points[3u * i]);
    }
    print_message("# against the wind: %.1f mm\n", -1e3 * (double)least);
    assert_true(least >= -0.175f); /* at rest 0.16 */
    free(hair);
}

/* A copy moves exactly like the hair; broken bytes are reported. */
static void a_copy_goes_on(void **state)
{
    const noh_hair_desc d = wig();
    const size_t bytes = noh_hair_size(&d);
    noh_hair *hair = made(&d), *copy;
    const float huge = 1e30f;
    uint8_t *raw;
    (void)state;
    for (uint32_t f = 1; f <= 60; f++) {
        const noh_hair_carrier at = shaken(f / 60.0, 1.0);
        (void)noh_hair_step(hair, &d, &at, 700);
    }
    copy = malloc(bytes);
    memcpy(copy, hair, bytes);
    assert_null(noh_hair_check(copy, &d));
    for (uint32_t f = 61; f <= 120; f++) {
        const noh_hair_carrier at = shaken(f / 60.0, 1.0);
        (void)noh_hair_step(hair, &d, &at, 700);
        (void)noh_hair_step(copy, &d, &at, 700);
    }
    assert_memory_equal(hair, copy, bytes);
    raw = (uint8_t *)copy;
    memcpy(raw + 112 + 40, &huge, sizeof huge);
    assert_non_null(noh_hair_check(copy, &d));
    memset(copy, 0, bytes);
    assert_non_null(noh_hair_check(copy, &d));
    free(copy);
    free(hair);
}

/* A head whose place, turn or wind is no number, as from a matrix without scale: hair stays with the last good one. */
static void bad_carriers_are_not_followed(void **state)
{
    const noh_hair_desc d = wig();
    noh_hair_carrier bad[3] = { still, still, still };
    noh_hair *hair, *same;
    void *memory = malloc(noh_hair_size(&d)), *other = malloc(noh_hair_size(&d));
    noh_error error;
    (void)state;
    bad[0].position[1] = NAN;
    memset(bad[1].rotation, 0, sizeof bad[1].rotation);
    bad[2].wind[0] = INFINITY;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(noh_hair_init(memory, noh_hair_size(&d), &d, &bad[i], &hair, &error), NOH_ERR_ARG);
        assert_non_null(strstr(error.what, "carrier"));
        assert_int_equal(noh_hair_init(memory, noh_hair_size(&d), &d, &still, &hair, NULL), NOH_OK);
        assert_int_equal(noh_hair_init(other, noh_hair_size(&d), &d, &still, &same, NULL), NOH_OK);
        (void)noh_hair_step(hair, &d, &bad[i], 4800u);
        (void)noh_hair_step(same, &d, &still, 4800u);
        assert_memory_equal(memory, other, noh_hair_size(&d));
        noh_hair_reset(hair, &d, &bad[i]);
        assert_null(noh_hair_check(hair, &d));
    }
    free(memory);
    free(other);
}

static void bad_descs_are_refused(void **state)
{
    static uint8_t memory[ALL * 40u + 112u] __attribute__((aligned(16)));
    noh_hair_sphere bad = { { 0.0f, 0.0f, 0.0f }, -1.0f };
    noh_hair_desc d = wig();
    noh_hair *hair;
    noh_error error;
    (void)state;
    assert_int_equal(noh_hair_init(memory, sizeof memory - 1u, &d, &still, &hair, &error), NOH_ERR_MEMORY);
    assert_int_equal(noh_hair_init(memory, sizeof memory, &d, &still, &hair, &error), NOH_OK);
    d.hair_count = 0;
    assert_int_equal(noh_hair_init(memory, sizeof memory, &d, &still, &hair, &error), NOH_ERR_LIMIT);
    d = wig(), d.point_count = 1;
    assert_int_equal(noh_hair_init(memory, sizeof memory, &d, &still, &hair, &error), NOH_ERR_LIMIT);
    d = wig(), d.pull = NAN;
    assert_int_equal(noh_hair_init(memory, sizeof memory, &d, &still, &hair, &error), NOH_ERR_ARG);
    d = wig(), d.damping = -1.0f;
    assert_int_equal(noh_hair_init(memory, sizeof memory, &d, &still, &hair, &error), NOH_ERR_ARG);
    d = wig(), d.spheres = &bad, d.sphere_count = 1;
    assert_int_equal(noh_hair_init(memory, sizeof memory, &d, &still, &hair, &error), NOH_ERR_ARG);
    d = wig(), memcpy(rest + 3u * 5u, rest + 3u * 4u, 3 * sizeof *rest);
    assert_int_equal(noh_hair_init(memory, sizeof memory, &d, &still, &hair, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 5);
}

/* ---- the source's errors ---- */

/* At a corner of equal steps the curve goes beyond its points by an eighth of a step; with the source's tangents, which
 * are twice as long, by twice that. */
static void tangents_are_halved(void **state)
{
    static const float corner[4][3] = {
        { 0.0f, 0.0f, 0.0f }, { 1.0f, 0.0f, 0.0f }, { 1.0f, 1.0f, 0.0f }, { 0.0f, 1.0f, 0.0f }
    };
    double ours = 0.0, source = 0.0;
    (void)state;
    for (int n = 0; n <= 100; n++) {
        const float t = (float)n / 100.0f, u = t;
        float at[3];
        noh_hair_curve(corner[0], 4, (1.0f + t) / 3.0f, at);
        ours = fmax(ours, (double)at[0] - 1.0);
        /* P = (p3 - p2) - (p0 - p1), Q = (p0 - p1) - P, R = p2 - p0, S = p1, in x; tangents in full */
        const float m1 = corner[2][0] - corner[0][0], m2 = corner[3][0] - corner[1][0],
                    way = corner[2][0] - corner[1][0];
        const float x = corner[1][0] + u * (m1 + u * (3.0f * way - 2.0f * m1 - m2 + u * (m1 + m2 - 2.0f * way)));
        source = fmax(source, (double)x - 1.0);
    }
    print_message("# beyond the corner by %.3f of a step; by the source %.3f\n", ours, source);
    assert_true(ours <= 0.1251 && source > 1.9 * ours);
}

/* Rest points in the world stay where the head was: turned by half, springs of the source pull hair off its head. */
static void rest_turns_with_the_head(void **state)
{
    const noh_hair_desc d = wig();
    noh_hair *hair = made(&d);
    noh_hair_carrier at = still;
    worst w = { 0.0, 0.0, 0.0 };
    float world[3], tip[3], source[3], speed[3] = { 0.0f, 0.0f, 0.0f };
    (void)state;
    memcpy(tip, rest + 3u * (POINTS - 1u), sizeof tip);
    memcpy(source, tip, sizeof source);
    at.rotation[1] = 1.0f, at.rotation[3] = 0.0f;
    for (uint32_t f = 1; f <= 60; f++) {
        const double turned = f / 120.0;
        at.rotation[1] = (float)sin(3.14159265358979 * turned), at.rotation[3] = (float)cos(3.14159265358979 * turned);
        (void)noh_hair_step(hair, &d, &at, SECOND / 60u);
    }
    for (uint32_t f = 0; f < 480; f++) {
        (void)noh_hair_step(hair, &d, &at, SECOND / 60u);
        for (int c = 0; c < 3; c++) speed[c] += 10.0f * (tip[c] - source[c]) / 60.0f, source[c] += speed[c] / 60.0f;
    }
    look(hair, &d, &w);
    noh_quat_rotate(at.rotation, tip, world);
    assert_true(w.moved < 0.01);             /* in head space */
    assert_true(apart(source, world) > 0.2); /* the source's tip is where the face is now */
    free(hair);
}

/* Without damping the source swings for ever; ours is at rest in seconds. */
static void hair_comes_to_rest(void **state)
{
    noh_hair_desc d = wig();
    double source_late = 0.0, x = 0.1, v = 0.0;
    noh_hair *hair = made(&d);
    noh_hair_carrier at = still;
    worst early = { 0.0, 0.0, 0.0 }, late = { 0.0, 0.0, 0.0 };
    (void)state;
    for (uint32_t f = 0; f < 600; f++) {
        at.position[0] = f < 6 ? 0.05f * (float)f : 0.3f;
        (void)noh_hair_step(hair, &d, &at, SECOND / 60u);
        v += -10.0 * x / 60.0, x += v / 60.0;
        if (f > 540)
            source_late = fmax(source_late, fabs(x)), look(hair, &d, &late);
        else
            look(hair, &d, &early);
    }
    print_message("# %.0f mm off, then %.2f mm; the source still swings by %.0f of 100 mm\n", 1e3 * early.moved,
                  1e3 * late.moved, 1e3 * source_late);
    assert_true(early.moved > 0.03 && late.moved < 0.01 && source_late > 0.09);
    free(hair);
}

/* Wind blows in gusts that a seed and time give: the same again, others for another seed, and never still. */
static void wind_is_noise_of_time(void **state)
{
    float points[3][3u * ALL];
    worst w = { 0.0, 0.0, 0.0 };
    double least = 1.0, most = 0.0;
    (void)state;
    for (uint32_t k = 0; k < 3; k++) {
        noh_hair_desc d = wig();
        noh_hair_carrier at = still;
        noh_hair *hair;
        d.seed = k == 2u ? 8u : 7u;
        at.wind[0] = -6.0f;
        hair = made(&d);
        for (uint32_t f = 0; f < 600; f++) {
            (void)noh_hair_step(hair, &d, &at, SECOND / 60u);
            noh_hair_points(hair, &d, points[k]);
            const double off = apart(points[k] + 3u * (POINTS - 1u), rest + 3u * (POINTS - 1u));
            if (f > 120u) least = fmin(least, off), most = fmax(most, off);
        }
        look(hair, &d, &w);
        free(hair);
    }
    print_message("# a tip in wind is %.0f to %.0f mm off rest\n", 1e3 * least, 1e3 * most);
    assert_memory_equal(points[0], points[1], sizeof points[0]);
    assert_memory_not_equal(points[0], points[2], sizeof points[0]);
    assert_true(most - least > 0.005 && w.stretch <= 1e-3 && w.entered <= 1e-3);
}

/* A hair that points straight at a sphere's centre, and one whose root is that centre, have no way out to take; the
 * source divides by their length of 0. */
static void a_hit_at_the_centre_is_pushed_out(void **state)
{
    static const float straight[2][2][3] = { { { 0.0f, 0.2f, 0.0f }, { 0.0f, 0.0f, 0.0f } },
                                             { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.1f, 0.0f } } };
    const noh_hair_sphere sphere = { { 0.0f, 0.0f, 0.0f }, 0.1f };
    noh_hair_desc d = wig();
    float points[4][3];
    noh_hair *hair;
    (void)state;
    d.rest = straight[0][0], d.hair_count = 2, d.point_count = 2, d.spheres = &sphere, d.sphere_count = 1;
    hair = made(&d);
    for (uint32_t f = 0; f < 10; f++) (void)noh_hair_step(hair, &d, &still, SECOND / 60u);
    noh_hair_points(hair, &d, points[0]);
    for (int i = 0; i < 12; i++) assert_true(isfinite(points[i / 3][i % 3]));
    assert_true(apart(points[1], sphere.centre) > 0.0999);
    assert_true(fabs(apart(points[0], points[1]) - 0.2) < 1e-5 && fabs(apart(points[2], points[3]) - 0.1) < 1e-5);
    free(hair);
}

/* ---- side by side ---- */

/* hair_lanes.c built again (Makefile, KERNELS) */
typedef uint32_t step_fn(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, uint32_t ticks);
step_fn noh_hair_step_scalar, noh_hair_step_sse2, noh_hair_step_avx2;
typedef void points_fn(const noh_hair *hair, const noh_hair_desc *desc, float *points);
points_fn noh_hair_points_scalar, noh_hair_points_sse2, noh_hair_points_avx2;

/* Four seconds of a head that shakes and leaps in the wind; a hash of every byte and point. */
static uint32_t hash_by(step_fn *step, points_fn *show, uint32_t hairs)
{
    static float points[3u * ALL];
    noh_hair_desc d = wig();
    noh_hair *hair;
    uint32_t crc = 0;
    d.hair_count = hairs;
    d.gravity = 0.5f;
    hair = made(&d);
    for (uint32_t f = 1; f <= 240; f++) {
        noh_hair_carrier at = shaken(f / 60.0, f > 150u ? 3.0 : 1.0);
        at.wind[0] = -4.0f;
        (void)step(hair, &d, &at, f % 50u ? 700u + f : 9000u);
        show(hair, &d, points);
        crc = noh_crc32c(noh_crc32c(crc, hair, noh_hair_size(&d)), points, (size_t)hairs * POINTS * 12u);
    }
    assert_null(noh_hair_check(hair, &d));
    free(hair);
    return crc;
}

static void every_width_gives_the_same_bits(void **state)
{
    static const struct {
        uint32_t hairs, crc;
    } wigs[] = { { 1, CRC_OF_1 }, { 13, CRC_OF_13 }, { 40, CRC_OF_40 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(wigs); i++) {
        const uint32_t n = wigs[i].hairs, crc = hash_by(noh_hair_step, noh_hair_points, n);
#if defined(__x86_64__) /* elsewhere the tests are linked with the library's own width alone */
        assert_int_equal(hash_by(noh_hair_step_scalar, noh_hair_points_scalar, n), crc);
        assert_int_equal(hash_by(noh_hair_step_sse2, noh_hair_points_sse2, n), crc);
        if (__builtin_cpu_supports("avx2")) {
            assert_int_equal(hash_by(noh_hair_step_avx2, noh_hair_points_avx2, n), crc);
        }
#endif
        print_message("# %u hairs by every width: %08x\n", n, crc);
        assert_int_equal(crc, wigs[i].crc); /* and on every processor */
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_and_spheres_hold),
        cmocka_unit_test(two_turns_of_the_head_leave_none_behind),
        cmocka_unit_test(shakes_and_leaps_stay_finite),
        cmocka_unit_test(every_rate_moves_alike),
        cmocka_unit_test(wind_folds_no_hair),
        cmocka_unit_test(pressed_hair_stays_on_the_head),
        cmocka_unit_test(a_copy_goes_on),
        cmocka_unit_test(every_width_gives_the_same_bits),
        cmocka_unit_test(bad_descs_are_refused),
        cmocka_unit_test(bad_carriers_are_not_followed),
        cmocka_unit_test(tangents_are_halved),
        cmocka_unit_test(rest_turns_with_the_head),
        cmocka_unit_test(hair_comes_to_rest),
        cmocka_unit_test(wind_is_noise_of_time),
        cmocka_unit_test(a_hit_at_the_centre_is_pushed_out),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
