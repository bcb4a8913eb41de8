/* Tests of triangles.c and triangles_touch.c: rays and touches against all triangles in double; bodies on them.
 * cross: long, rays against all triangles in double */
#include "life/physics/ragdoll_internal.h"
#include "life/physics/world_ask_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define SIDE 24u /* cells of the terrain */
#define CELL 0.35f
#define LUMPS 40u
#define POSITIONS ((SIDE + 1u) * (SIDE + 1u) + 4u * LUMPS)
#define TRIANGLES (2u * SIDE * SIDE + 4u * LUMPS)

static float positions[POSITIONS][3];
static uint32_t indices[TRIANGLES][3];
static uint32_t seed;

static float random_in(float low, float high)
{
    seed = seed * 1664525u + 1013904223u;
    return low + (high - low) * (float)(seed >> 8) / 16777216.0f;
}

/* Terrain with its fronts up, about a place. rough: metres */
static noh_triangles_desc lay_terrain(float rough, float x, float y)
{
    const noh_triangles_desc desc = { positions[0], POSITIONS, indices[0], 2u * SIDE * SIDE };
    seed = 5;
    for (uint32_t i = 0; i < (SIDE + 1u) * (SIDE + 1u); i++) {
        positions[i][0] = x + CELL * ((float)(i % (SIDE + 1u)) - 0.5f * (float)SIDE);
        positions[i][1] = y + random_in(0.0f, rough);
        positions[i][2] = CELL * ((float)(i / (SIDE + 1u)) - 0.5f * (float)SIDE);
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint32_t a = i / SIDE * (SIDE + 1u) + i % SIDE, b = a + SIDE + 1u;
        const uint32_t both[2][3] = { { a, b, a + 1u }, { a + 1u, b, b + 1u } };
        memcpy(indices[2u * i], both, sizeof both);
    }
    return desc;
}

/* Tetrahedra in the air above it, fronts out. */
static noh_triangles_desc lay_lumps(void)
{
    static const float corner[4][3] = { { 1, 1, 1 }, { -1, -1, 1 }, { -1, 1, -1 }, { 1, -1, -1 } };
    static const uint32_t faces[4][3] = { { 0, 1, 3 }, { 0, 2, 1 }, { 0, 3, 2 }, { 1, 2, 3 } };
    noh_triangles_desc desc = lay_terrain(0.3f, 0.0f, 0.0f);
    const uint32_t first = (SIDE + 1u) * (SIDE + 1u);
    for (uint32_t i = 0; i < LUMPS; i++) {
        const float size = random_in(0.1f, 0.4f);
        float at[3];
        for (int k = 0; k < 3; k++) at[k] = random_in(-3.0f, 3.0f) + (k == 1 ? 4.0f : 0.0f);
        for (uint32_t c = 0; c < 4; c++) {
            for (int k = 0; k < 3; k++) positions[first + 4u * i + c][k] = at[k] + size * corner[c][k];
            for (int k = 0; k < 3; k++) indices[2u * SIDE * SIDE + 4u * i + c][k] = first + 4u * i + faces[c][k];
        }
    }
    desc.triangle_count = TRIANGLES;
    return desc;
}

static void *made(const noh_triangles_desc *desc, noh_world_physics *physics)
{
    const size_t bytes = noh_triangles_size(desc->triangle_count);
    void *memory = malloc(bytes);
    noh_error error;
    assert_int_equal(noh_triangles_init(memory, bytes - 1u, desc, physics, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_triangles_init(memory, bytes, desc, physics, &error), NOH_OK);
    return memory;
}

/* ---- in double ---- */

typedef struct vec {
    double x, y, z;
} vec;

static vec sub(vec a, vec b)
{
    return (vec){ a.x - b.x, a.y - b.y, a.z - b.z };
}
static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static vec along(vec a, double s, vec b)
{
    return (vec){ a.x + s * b.x, a.y + s * b.y, a.z + s * b.z };
}
static vec cross(vec a, vec b)
{
    return (vec){ a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

static vec corner_of(uint32_t triangle, int k)
{
    const float *p = positions[indices[triangle][k]];
    return (vec){ (double)p[0], (double)p[1], (double)p[2] };
}

/* The first front that a ray enters, and how close to an edge it passes there; below 0: none. */
static double ray_brute(const noh_triangles_desc *desc, vec from, vec way, double *margin)
{
    double best = -1.0;
    *margin = 1.0;
    for (uint32_t t = 0; t < desc->triangle_count; t++) {
        const vec a = corner_of(t, 0), n = cross(sub(corner_of(t, 1), a), sub(corner_of(t, 2), a));
        const double facing = -dot(way, n), far = dot(sub(from, a), n) / facing;
        double least = 1e9;
        if (facing <= 0.0 || far < 0.0) continue;
        for (int k = 0; k < 3; k++) {
            const vec e = sub(corner_of(t, (k + 1) % 3), corner_of(t, k));
            const double in = dot(cross(n, e), sub(along(from, far, way), corner_of(t, k)));
            least = fmin(least, in / (sqrt(dot(n, n)) * dot(e, e)));
        }
        *margin = fmin(*margin, fabs(least));
        if (least >= 0.0 && (best < 0.0 || far < best)) best = far;
    }
    return best;
}

/* The distance of a point from a triangle. */
static double distance_to(uint32_t t, vec p)
{
    const vec a = corner_of(t, 0), n = cross(sub(corner_of(t, 1), a), sub(corner_of(t, 2), a));
    double best = 1e9;
    int inside = 1;
    for (int k = 0; k < 3; k++) {
        const vec c = corner_of(t, k), e = sub(corner_of(t, (k + 1) % 3), c);
        const double s = fmin(1.0, fmax(0.0, dot(sub(p, c), e) / dot(e, e)));
        const vec d = sub(p, along(c, s, e));
        inside &= dot(cross(n, e), sub(p, c)) >= 0.0;
        best = fmin(best, sqrt(dot(d, d)));
    }
    return inside ? fabs(dot(sub(p, a), n)) / sqrt(dot(n, n)) : best;
}

static void rays_enter_the_first_front(void **state)
{
    const noh_triangles_desc desc = lay_lumps();
    noh_world_physics physics;
    void *memory = made(&desc, &physics);
    const noh_world world = { .physics = &physics };
    uint32_t hits = 0;
    (void)state;
    for (int i = 0; i < 2500; i++) {
        noh_world_ray r = { { 1.0f, -2.0f, 3.0f }, { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f }, 30.0f } };
        noh_world_hit hit;
        double margin;
        for (int k = 0; k < 3; k++) {
            r.ray.from[k] = random_in(-4.0f, 4.0f) - r.origin[k] + (k == 1 ? 5.0f : 0.0f);
            r.ray.direction[k] = random_in(-1.0f, 1.0f);
        }
        if (i % 8 == 0) r.ray.direction[0] = r.ray.direction[2] = 0.0f;
        const vec from = { (double)(r.ray.from[0] + r.origin[0]), (double)(r.ray.from[1] + r.origin[1]),
                           (double)(r.ray.from[2] + r.origin[2]) };
        const vec way = { (double)r.ray.direction[0], (double)r.ray.direction[1], (double)r.ray.direction[2] };
        const double far = ray_brute(&desc, from, way, &margin);
        noh_world_ask_rays(&world, &r, 1, &hit);
        if (margin < 1e-4 || far > 29.9) continue; /* an edge may count for either side */
        if (fabs((double)hit.distance - far) > 1e-4 * (1.0 + far))
            fail_msg("ray %d: %g, not %g", i, (double)hit.distance, far);
        hits += far > 0.0;
    }
    assert_true(hits > 300);
    free(memory);
}

/* The nearest plane of a ball is as far as the nearest triangle, and none is nearer; far from all there is none. */
static void balls_touch_the_nearest(void **state)
{
    const noh_triangles_desc desc = lay_lumps();
    noh_world_physics physics;
    void *memory = made(&desc, &physics);
    const noh_world world = { .physics = &physics };
    uint32_t touched = 0, alone = 0;
    (void)state;
    for (int i = 0; i < 3500; i++) {
        noh_world_body body = { { 2.0f, 1.0f, -1.0f }, { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f }, 0.1f }, 0.15f };
        noh_touches t;
        float nearest = 1e9f;
        double brute = 1e9;
        const float at[3] = { random_in(-4.0f, 4.0f), random_in(0.3f, 7.0f), random_in(-4.0f, 4.0f) };
        uint32_t nearest_triangle = 0;
        for (int k = 0; k < 3; k++) body.capsule.from[k] = body.capsule.to[k] = at[k] - body.origin[k];
        for (uint32_t n = 0; n < desc.triangle_count; n++) {
            const double far = distance_to(n, (vec){ (double)at[0], (double)at[1], (double)at[2] });
            if (far < brute) brute = far, nearest_triangle = n;
        }
        const vec a = corner_of(nearest_triangle, 0);
        const vec n = cross(sub(corner_of(nearest_triangle, 1), a), sub(corner_of(nearest_triangle, 2), a));
        const int is_front = dot(sub((vec){ (double)at[0], (double)at[1], (double)at[2] }, a), n) > 0.0;
        noh_world_ask_touches(&world, &body, 1, &t);
        for (uint32_t k = 0; k < t.count; k++) {
            const noh_plane *p = &t.at[k].plane;
            const float over = p->normal[0] * body.capsule.from[0] + p->normal[1] * body.capsule.from[1] +
                               p->normal[2] * body.capsule.from[2] - p->distance;
            nearest = over < nearest ? over : nearest;
        }
        if (brute > 0.2501) assert_int_equal(t.count, 0), alone++;
        if (brute > 0.2499 || !is_front) continue;
        if (fabs((double)nearest - brute) > 2e-5) fail_msg("ball %d: %g, not %g", i, (double)nearest, brute);
        touched++;
    }
    assert_true(touched > 150 && alone > 150);
    free(memory);
}

/* Where two faces lie on one plane, or along a ridge between the ends. */
static void edges_count_where_they_stick_out(void **state)
{
    noh_triangles_desc desc = lay_terrain(0.0f, 0.0f, 0.0f);
    noh_world_physics physics;
    void *memory = made(&desc, &physics);
    const noh_world world = { .physics = &physics };
    noh_world_body body = { { 0.0f, 0.0f, 0.0f }, { { -0.4f, 0.1f, 0.02f }, { 0.4f, 0.1f, 0.02f }, 0.1f }, 0.2f };
    noh_touches t;
    (void)state;
    noh_world_ask_touches(&world, &body, 1, &t);
    assert_int_equal(t.count, 2); /* a plane for each end, and no edge */
    for (uint32_t i = 0; i < 2; i++) assert_true(t.at[i].plane.normal[1] > 0.9999f && fabsf(t.at[i].along) == 1.0f);
    free(memory);
    for (uint32_t i = 0; i < (SIDE + 1u) * (SIDE + 1u); i++) positions[i][1] = -0.3f * fabsf(positions[i][0]);
    memory = made(&desc, &physics);
    noh_world_ask_touches(&world, &body, 1, &t);
    assert_int_equal(t.count, 3);
    assert_true(t.at[2].along == 0.0f && t.at[2].plane.normal[1] > 0.9999f);
    free(memory);
}

static void who_is_behind_is_led_out(void **state)
{
    noh_triangles_desc desc = lay_terrain(0.0f, 0.0f, 0.0f);
    noh_world_physics physics;
    void *memory = made(&desc, &physics);
    const noh_world world = { .physics = &physics };
    const noh_world_body body = { { 0.0f, 0.0f, 0.0f },
                                  { { 0.1f, -0.1f, 0.02f }, { 0.1f, -0.1f, 0.02f }, 0.1f },
                                  0.1f };
    noh_touches t;
    (void)state;
    noh_world_ask_touches(&world, &body, 1, &t);
    assert_int_equal(t.count, 1);
    assert_true(t.at[0].plane.normal[1] > 0.9999f && fabsf(t.at[0].plane.distance) < 1e-6f);
    free(memory);
}

/* Boxes and capsules come to rest on rough triangles, here and 16 km away. */
static void bodies_rest_on_triangles(void **state)
{
    (void)state;
    for (int far = 0; far < 2; far++) {
        const float x = far ? 16000.0f : 0.0f;
        const noh_triangles_desc desc = lay_terrain(0.15f, x, 1.0f);
        noh_world_physics physics;
        void *memory = made(&desc, &physics);
        const noh_world world = { .physics = &physics, .friction = 0.8f };
        for (int i = 0; i < 6; i++) {
            const float thick = i % 2 ? 0.06f : 0.0f, half = i % 2 ? 0.02f : 0.1f;
            const noh_rigid_desc rigid = { .half = { half, 0.5f * half, 0.15f },
                                           .radius = thick,
                                           .mass = 2.0f,
                                           .position = { x + 0.3f * (float)i - 1.0f, 2.2f, 0.1f * (float)i } };
            const float none[3] = { 0.0f, 0.0f, 0.0f }, spin[3] = { 1.0f, 2.0f, 0.5f };
            float at[3], q[4];
            noh_rigid body;
            assert_int_equal(noh_rigid_init(&body, &rigid, NULL), NOH_OK);
            assert_int_equal(noh_rigid_set_motion(&body, none, spin, NULL), NOH_OK);
            for (int f = 0; f < 600; f++) noh_rigid_step(&body, &world, NULL, 800);
            noh_rigid_place(&body, at, q);
            assert_true(at[1] > 1.02f && at[1] < 1.4f && fabsf(body.velocity[1]) < 0.1f);
        }
        free(memory);
    }
}

/* Pairs of bodies thrown down at 5 to 30 m/s end on the terrain and in no lump. */
static void nothing_falls_through(void **state)
{
    static const float still[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    const noh_triangles_desc triangles = lay_lumps();
    noh_world_physics physics;
    void *tree = made(&triangles, &physics), *memory;
    const noh_world world = { .friction = 0.8f, .physics = &physics };
    noh_ragdoll_rig rig;
    const noh_ragdolls_desc desc = { &rig, 48, 10, 1 };
    noh_ragdolls *set;
    float deepest = 0.0f;
    (void)state;
    memset(&rig, 0, sizeof rig);
    rig.body_count = 2;
    for (uint32_t i = 0; i < 2; i++) {
        rig.bodies[i] = (noh_ragdoll_body){
            i ? 0 : NOH_NONE,          0, 0.15f, 0.06f, 5.0f, 0.06f, 0.01f, { 0.0f, 0.0f, 0.4f * (float)i },
            { 0.0f, 0.0f, 0.0f, 1.0f }
        };
        rig.joints[i].flags = NOH_RAGDOLL_LOOSE;
        rig.joints[i].anchor[2] = 0.2f;
        memcpy(rig.joints[i].frame, still, sizeof still);
    }
    memory = malloc(noh_ragdolls_size(&desc));
    assert_int_equal(noh_ragdolls_init(memory, noh_ragdolls_size(&desc), &desc, &set, NULL), NOH_OK);
    for (uint32_t d = 0; d < 48; d++) {
        noh_ragdoll_pose poses[2];
        noh_ragdoll_motion motions[2];
        memset(motions, 0, sizeof motions);
        noh_ragdoll_bodies(set, d, poses);
        for (uint32_t i = 0; i < 2; i++) {
            poses[i].position[0] += -2.0f + 0.5f * (float)(d % 8u);
            poses[i].position[1] += 9.0f;
            poses[i].position[2] += -2.0f + 0.7f * (float)(d / 8u);
            motions[i].velocity[1] = -5.0f * (float)(d % 6u + 1u);
            motions[i].spin[0] = (float)d * 0.1f;
        }
        assert_int_equal(noh_ragdoll_place(set, d, poses, motions, NULL), NOH_OK);
    }
    for (int f = 0; f < 200; f++) {
        noh_ragdolls_step(set, &world, NOH_RAGDOLL_STEP_TICKS);
        for (uint32_t d = 0; d < 48; d++) {
            noh_ragdoll_pose poses[2];
            noh_ragdoll_bodies(set, d, poses);
            for (int i = 0; i < 2; i++) { /* some go over its rim */
                const float *at = poses[i].position, rim = 0.5f * CELL * (float)SIDE - 0.6f;
                if (fabsf(at[0]) < rim && fabsf(at[2]) < rim && at[1] < 0.0f && at[1] > -1.0f)
                    fail_msg("%u, frame %d", d, f);
            }
        }
    }
    for (uint32_t d = 0; d < 48; d++) {
        noh_ragdoll_measures m;
        noh_ragdoll_measure(set, d, &world, &m);
        deepest = fmaxf(deepest, m.penetration);
    }
    print_message("the deepest body is %.1f mm inside\n", 1e3 * (double)deepest);
    assert_true(deepest < 0.01f);
    free(memory);
    free(tree);
}

static void bad_triangles_are_refused(void **state)
{
    noh_triangles_desc desc = lay_terrain(0.1f, 0.0f, 0.0f);
    const size_t bytes = noh_triangles_size(desc.triangle_count);
    void *memory = malloc(bytes);
    noh_world_physics physics;
    noh_error error;
    (void)state;
    assert_true(noh_triangles_size(0) == 0 && noh_triangles_size(NOH_TRIANGLES_MAX + 1u) == 0);
    indices[7][2] = POSITIONS;
    assert_int_equal(noh_triangles_init(memory, bytes, &desc, &physics, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 7);
    indices[7][2] = 3;
    positions[0][1] = NAN;
    assert_int_equal(noh_triangles_init(memory, bytes, &desc, &physics, &error), NOH_ERR_ARG);
    assert_int_equal(error.where, 0);
    free(memory);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rays_enter_the_first_front),
    cmocka_unit_test(balls_touch_the_nearest),
    cmocka_unit_test(edges_count_where_they_stick_out),
    cmocka_unit_test(who_is_behind_is_led_out),
    cmocka_unit_test(nothing_falls_through),
    cmocka_unit_test(bodies_rest_on_triangles),
    cmocka_unit_test(bad_triangles_are_refused),
};

TEST_MAIN(tests, NULL, NULL)
