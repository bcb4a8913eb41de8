/* Tests of motion.c and shape.c: closed forms, oracles in double, and the errors of the source's chapter.
 */
#include "life/physics/shape_internal.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include <math.h>
#include <string.h>

#include "support/support.h"

static uint32_t seed = 1;

/* -1..1 */
static float random_float(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)((double)(seed >> 8) / 8388608.0 - 1.0);
}

static void random_vector(float v[3], float size)
{
    for (int i = 0; i < 3; i++) v[i] = random_float() * size;
}

static void random_rotation(float q[4])
{
    for (int i = 0; i < 4; i++) q[i] = random_float();
    q[3] += 0.01f;
    noh_quat_normalize(q);
}

/* ---- motion ---- */

/* A mass on a spring of 1 Hz, for 100 s at 60 Hz: its largest energy over the first one. */
static double oscillator(int explicit_euler)
{
    const float k = 39.478418f, h = 1.0f / 60.0f;
    float x[3] = { 1.0f, 0.0f, 0.0f }, v[3] = { 0.0f, 0.0f, 0.0f };
    double most = 0.0;
    for (int i = 0; i < 6000; i++) {
        const float a[3] = { -k * x[0], 0.0f, 0.0f };
        if (explicit_euler) { /* the source: p = p + v h with the old v */
            x[0] += v[0] * h;
            v[0] += a[0] * h;
        } else {
            noh_point_move(x, v, a, h);
        }
        const double energy = (0.5 * v[0] * v[0] + 0.5 * k * x[0] * x[0]) / (0.5 * k);
        most = energy > most ? energy : most;
    }
    return most;
}

static void orbits_gain_no_energy(void **state)
{
    (void)state;
    assert_true(oscillator(1) > 1000.0);
    assert_true(oscillator(0) < 1.2);
}

/* The source's text, p = 2 p - o + a h, falls 60 times as far at 60 Hz; its code and ours as g t^2 / 2. */
static void gravity_goes_by_the_square_of_the_step(void **state)
{
    const float g[3] = { 0.0f, -NOH_GRAVITY, 0.0f }, h = 1.0f / 60.0f;
    float p[3] = { 0.0f, 0.0f, 0.0f }, before[3] = { 0.0f, 0.0f, 0.0f };
    float text = 0.0f, old = 0.0f;
    (void)state;
    for (int i = 0; i < 60; i++) {
        const float next = 2.0f * text - old + g[1] * h;
        old = text;
        text = next;
        noh_verlet_move(p, before, g, h, h, 1.0f);
    }
    assert_true(fabs((double)p[1] + 4.91) < 0.1);
    assert_true(text < -250.0f);
}

/* Steps of changing length: within 1 % of the parabola, where p + (p - o) + a h^2 is not. */
static void verlet_takes_steps_of_any_length(void **state)
{
    const float none[3] = { 0.0f, 0.0f, 0.0f };
    float p[3] = { 0.0f, 0.0f, 0.0f }, before[3] = { -0.01f, 0.0f, 0.0f }; /* 1 m/s, steps of 10 ms so far */
    float seconds_before = 0.01f, time = 0.0f, literal = 0.0f, old = -0.01f;
    (void)state;
    for (int i = 0; i < 100; i++) {
        const float h = i % 2 ? 0.005f : 0.02f, next = literal + (literal - old);
        noh_verlet_move(p, before, none, h, seconds_before, 1.0f);
        old = literal;
        literal = next;
        seconds_before = h;
        time += h;
    }
    assert_true(fabsf(p[0] - time) < 1e-3f);
    assert_true(fabsf(literal - time) > 0.1f);
}

/* Two points in one place: the source divides by their distance. */
static void no_distance_stays_finite(void **state)
{
    float a[3] = { 1.0f, 2.0f, 3.0f }, b[3] = { 1.0f, 2.0f, 3.0f };
    volatile float distance = 0.0f;
    const float literal = (distance - 0.5f) / distance;
    (void)state;
    assert_true(literal - literal != 0.0f);
    noh_distance_keep(a, 1.0f, b, 1.0f, 0.5f, 0.0f, 0.01f, NULL);
    assert_true(a[0] == 1.0f && b[0] == 1.0f && a[2] == 3.0f);
}

/* A pinned point and a heavy one: the source moves both by half. */
static void masses_share_a_correction(void **state)
{
    float a[3] = { 0.0f, 0.0f, 0.0f }, b[3] = { 2.0f, 0.0f, 0.0f }, c[3] = { 5.0f, 0.0f, 0.0f };
    (void)state;
    assert_true(noh_distance_keep(a, 0.0f, b, 1.0f, 1.0f, 0.0f, 0.01f, NULL) == 1.0f);
    assert_true(a[0] == 0.0f && fabsf(b[0] - 1.0f) < 1e-6f);
    noh_distance_keep(b, 1.0f, c, 0.25f, 2.0f, 0.0f, 0.01f, NULL);
    assert_true(fabsf(b[0] - 2.6f) < 1e-5f && fabsf(c[0] - 4.6f) < 1e-5f); /* 2 m too long: 4 to 1 */
    noh_distance_keep(a, 0.0f, a, 0.0f, 1.0f, 0.0f, 0.01f, NULL);
    assert_true(a[0] == 0.0f);
}

/* A weight on a spring stretches it by m g / k, which a rod does not. */
static void a_spring_has_a_stiffness(void **state)
{
    const float g[3] = { 0.0f, -NOH_GRAVITY, 0.0f }, h = 1.0f / 600.0f, compliance = 1.0f / 100.0f;
    float pin[3] = { 0.0f, 0.0f, 0.0f }, p[3] = { 0.0f, -1.0f, 0.0f }, v[3] = { 0.0f, 0.0f, 0.0f };
    (void)state;
    for (int i = 0; i < 60000; i++) {
        float old[3], lambda = 0.0f;
        memcpy(old, p, sizeof old);
        noh_point_move(p, v, g, h);
        noh_distance_keep(pin, 0.0f, p, 1.0f, 1.0f, compliance, h, &lambda);
        for (int k = 0; k < 3; k++) v[k] = (p[k] - old[k]) / h * 0.999f;
    }
    assert_true(fabs((double)p[1] + 1.0 + 9.82 / 100.0) < 1e-3);
}

static void dropped_time_is_counted(void **state)
{
    noh_steps s = { 0, 0 };
    (void)state;
    assert_int_equal(noh_steps_take(&s, 1000, 800, 4), 1);
    assert_int_equal(s.left, 200);
    assert_int_equal(noh_steps_take(&s, 600, 800, 4), 1);
    assert_int_equal(s.left, 0);
    assert_int_equal(noh_steps_take(&s, 48000, 800, 4), 4);
    assert_int_equal(s.dropped, 56 * 800);
    assert_int_equal(noh_steps_take(&s, UINT32_MAX, 800, 4), 4);
    assert_int_equal(noh_steps_take(&s, UINT32_MAX, 800, 4), 4);
    assert_int_equal(s.dropped, UINT32_MAX);
}

/* ---- shapes ---- */

/* Whether two boxes meet, in double, by all 15 axes, each made unit; those without length are skipped. By how much they
 * are apart at most is `gap`. */
static double gap_of(const noh_obb *a, const noh_obb *b)
{
    double axes[15][3], most = -1e9, c[3];
    const noh_obb *boxes[2] = { a, b };
    for (int k = 0; k < 6; k++) {
        float unit[3] = { 0.0f, 0.0f, 0.0f }, axis[3];
        unit[k % 3] = 1.0f;
        noh_quat_rotate(boxes[k / 3]->rotation, unit, axis);
        for (int i = 0; i < 3; i++) axes[k][i] = axis[i];
    }
    for (int k = 0; k < 9; k++) {
        const double *u = axes[k / 3], *v = axes[3 + k % 3];
        for (int i = 0; i < 3; i++) axes[6 + k][i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
    }
    for (int i = 0; i < 3; i++) c[i] = (double)b->centre[i] - a->centre[i];
    for (int k = 0; k < 15; k++) {
        const double *n = axes[k], size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        double reach = 0.0;
        if (size < 1e-5) continue;
        for (int m = 0; m < 6; m++) {
            const double *axis = axes[m];
            reach += boxes[m / 3]->half[m % 3] * fabs(n[0] * axis[0] + n[1] * axis[1] + n[2] * axis[2]) / size;
        }
        const double gap = fabs(n[0] * c[0] + n[1] * c[1] + n[2] * c[2]) / size - reach;
        most = gap > most ? gap : most;
    }
    return most;
}

static void boxes_meet_as_in_double(void **state)
{
    int met = 0, apart = 0;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        noh_obb a, b;
        random_vector(a.centre, 1.0f);
        random_vector(b.centre, 1.5f);
        for (int k = 0; k < 3; k++) {
            a.half[k] = 0.1f + 0.5f * fabsf(random_float());
            b.half[k] = 0.1f + 0.5f * fabsf(random_float());
        }
        random_rotation(a.rotation);
        random_rotation(b.rotation);
        const double gap = gap_of(&a, &b);
        if (gap > 1e-4) assert_false(noh_obb_overlap(&a, &b));
        if (gap < -1e-4) assert_true(noh_obb_overlap(&a, &b));
        met += gap < -1e-4;
        apart += gap > 1e-4;
    }
    assert_true(met > 1000 && apart > 1000);
}

/* Boxes side by side, turned by nearly nothing: the products of their parallel edges are rounding errors, which without
 * the margin part boxes that meet. */
static void parallel_edges_part_nothing(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; i++) {
        noh_obb a = { { 0.0f, 0.0f, 0.0f }, { 0.5f, 0.3f, 0.2f }, { 0.0f, 0.0f, 0.0f, 1.0f } }, b = a;
        const float turn[3] = { random_float() * 1e-7f, random_float() * 1e-7f, random_float() * 1e-7f };
        random_rotation(a.rotation);
        memcpy(b.rotation, a.rotation, sizeof b.rotation);
        for (int k = 0; k < 3; k++) b.rotation[k] += turn[k];
        noh_quat_rotate(a.rotation, (const float[3]){ 0.9999f, 0.5999f, 0.3999f }, b.centre); /* inside of a corner */
        assert_true(noh_obb_overlap(&a, &b));
        noh_quat_rotate(a.rotation, (const float[3]){ 1.0001f, 0.0f, 0.0f }, b.centre);
        assert_false(noh_obb_overlap(&a, &b));
    }
}

/* The source's size is half of a side, and its constructor takes the largest corner first. */
static void corners_and_halves_are_told_apart(void **state)
{
    const noh_aabb box = { { -1.0f, -2.0f, -3.0f }, { 1.0f, 2.0f, 3.0f } },
                   turned = { { 1.0f, 2.0f, 3.0f }, { -1.0f, -2.0f, -3.0f } };
    const noh_obb half = { { 0.0f, 0.0f, 0.0f }, { 1.0f, 2.0f, 3.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    const float inside[3] = { 0.9f, -1.9f, 2.9f }, outside[3] = { 0.0f, 0.0f, 3.1f };
    (void)state;
    assert_true(noh_aabb_contains(&box, inside) && noh_obb_contains(&half, inside));
    assert_false(noh_aabb_contains(&box, outside) || noh_obb_contains(&half, outside));
    assert_false(noh_aabb_contains(&turned, inside));
}

static void the_closest_point_is_no_farther_than_others(void **state)
{
    (void)state;
    for (int i = 0; i < 2000; i++) {
        noh_obb box = { { 0.1f, 0.2f, 0.3f }, { 0.5f, 0.3f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
        float p[3], q[3], d[3];
        random_rotation(box.rotation);
        random_vector(p, 2.0f);
        noh_obb_closest(&box, p, q);
        for (int k = 0; k < 3; k++) d[k] = p[k] - q[k];
        const float nearest = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int n = 0; n < 50; n++) {
            float other[3];
            random_vector(other, 1.0f);
            for (int k = 0; k < 3; k++) other[k] *= box.half[k];
            noh_quat_rotate(box.rotation, other, other);
            for (int k = 0; k < 3; k++) d[k] = p[k] - other[k] - box.centre[k];
            assert_true(sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) > nearest - 1e-5f);
        }
    }
}

/* The distance from a point to a segment, in double. */
static double distance_to_segment(const double p[3], const float from[3], const float to[3])
{
    double axis[3], d[3], length = 0.0, along = 0.0, sum = 0.0;
    for (int i = 0; i < 3; i++) {
        axis[i] = (double)to[i] - from[i];
        length += axis[i] * axis[i];
        along += axis[i] * (p[i] - from[i]);
    }
    along = length > 0.0 ? fmin(fmax(along / length, 0.0), 1.0) : 0.0;
    for (int i = 0; i < 3; i++) {
        d[i] = p[i] - from[i] - along * axis[i];
        sum += d[i] * d[i];
    }
    return sqrt(sum);
}

/* What a ray hits is at the surface, and nothing is before it. */
static void rays_meet_surfaces(void **state)
{
    int hits = 0;
    (void)state;
    for (int i = 0; i < 5000; i++) {
        float from[3], to[3];
        noh_ray ray = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f }, 4.0f };
        double closest = 1e9;
        random_vector(from, 0.6f);
        random_vector(to, i % 10 ? 0.6f : 0.0f);
        if (i % 10 == 0) memcpy(to, from, sizeof to);
        random_vector(ray.from, 2.0f);
        random_vector(ray.direction, 1.0f);
        for (int k = 0; k < 3; k++) ray.direction[k] -= ray.from[k]; /* more or less towards it */
        const float t = noh_ray_capsule(&ray, from, to, 0.3f), last = t < 0.0f ? 4.0f : t;
        for (int n = 0; n <= 200; n++) {
            double p[3];
            for (int k = 0; k < 3; k++) p[k] = ray.from[k] + (double)ray.direction[k] * last * n / 200.0;
            closest = fmin(closest, distance_to_segment(p, from, to));
        }
        if (t > 0.0f) assert_true(fabs(closest - 0.3) < 1e-4);
        if (t < 0.0f) assert_true(closest > 0.3 - 1e-4);
        hits += t > 0.0f;
    }
    assert_true(hits > 300);
}

static void rays_meet_boxes(void **state)
{
    const noh_obb box = { { 1.0f, 0.0f, 0.0f }, { 0.5f, 1.0f, 2.0f }, { 0.0f, 0.38268343f, 0.0f, 0.92387953f } };
    const noh_ray ray = { { 1.0f, 5.0f, 0.0f }, { 0.0f, -2.0f, 0.0f }, 10.0f };
    noh_ray away = ray, inside = ray, shorter = ray;
    (void)state;
    away.direction[1] = 2.0f;
    inside.from[1] = 0.0f;
    shorter.distance_max = 1.9f;
    assert_true(fabsf(noh_ray_obb(&ray, &box) - 2.0f) < 1e-5f);
    assert_true(noh_ray_obb(&away, &box) < 0.0f && noh_ray_obb(&shorter, &box) < 0.0f);
    assert_true(noh_ray_obb(&inside, &box) == 0.0f);
}

static double apart(const float a[3], const float b[3])
{
    return sqrt(pow((double)a[0] - b[0], 2) + pow((double)a[1] - b[1], 2) + pow((double)a[2] - b[2], 2));
}

/* The nearest points are no farther from each other than any of a grid, parallel segments and points included. */
static void segments_are_closest_where_it_says(void **state)
{
    (void)state;
    for (int i = 0; i < 2000; i++) {
        float ends[4][3], p[3], q[3], along[2];
        for (int k = 0; k < 4; k++) random_vector(ends[k], 1.0f);
        if (i % 4 == 1) memcpy(ends[1], ends[0], sizeof ends[1]);
        if (i % 8 == 1) memcpy(ends[3], ends[2], sizeof ends[3]);
        if (i % 4 == 2) {
            for (int k = 0; k < 3; k++) ends[3][k] = ends[2][k] + (ends[1][k] - ends[0][k]) * 0.7f;
        }
        noh_segments_closest(ends[0], ends[1], ends[2], ends[3], along);
        for (int k = 0; k < 3; k++) {
            p[k] = ends[0][k] + (ends[1][k] - ends[0][k]) * along[0];
            q[k] = ends[2][k] + (ends[3][k] - ends[2][k]) * along[1];
        }
        const double nearest = apart(p, q);
        for (int n = 0; n < 121; n++) {
            for (int k = 0; k < 3; k++) {
                p[k] = ends[0][k] + (ends[1][k] - ends[0][k]) * (float)(n % 11) / 10.0f;
                q[k] = ends[2][k] + (ends[3][k] - ends[2][k]) * (float)(n / 11) / 10.0f;
            }
            assert_true(nearest < apart(p, q) + 1e-4);
        }
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(orbits_gain_no_energy),
    cmocka_unit_test(gravity_goes_by_the_square_of_the_step),
    cmocka_unit_test(verlet_takes_steps_of_any_length),
    cmocka_unit_test(no_distance_stays_finite),
    cmocka_unit_test(masses_share_a_correction),
    cmocka_unit_test(a_spring_has_a_stiffness),
    cmocka_unit_test(dropped_time_is_counted),
    cmocka_unit_test(boxes_meet_as_in_double),
    cmocka_unit_test(parallel_edges_part_nothing),
    cmocka_unit_test(corners_and_halves_are_told_apart),
    cmocka_unit_test(the_closest_point_is_no_farther_than_others),
    cmocka_unit_test(rays_meet_surfaces),
    cmocka_unit_test(rays_meet_boxes),
    cmocka_unit_test(segments_are_closest_where_it_says),
};

TEST_MAIN(tests, NULL, NULL)
