/* Tests of runtime/motion/pose/{blend,skeleton,local_to_model}.c, mask.c and blend_space.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/clip_set_fixture.h"
#include "motion/pose/blend_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "motion/graph/graph_weights_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

typedef struct sums {
    noh_blend blend;
    noh_transform sum[JOINTS];
    float weights[JOINTS], float_sum[FLOATS], float_weights[FLOATS];
} sums;

static void sums_open(sums *s)
{
    s->blend.joint_count = JOINTS;
    s->blend.float_count = FLOATS;
    s->blend.full = 0.0f;
    s->blend.sum = s->sum;
    s->blend.weights = s->weights;
    s->blend.float_sum = s->float_sum;
    s->blend.float_weights = s->float_weights;
    noh_blend_begin(&s->blend);
}

static const noh_mask_view everywhere = { NULL, NULL };

/* ---- blending by weight ---- */

/* pose = sum w * pose / sum w, joint by joint, against the same in double. */
static void the_weighted_sum_follows_its_definition(void **state)
{
    scene s;
    sums b;
    noh_transform poses[3][JOINTS], got[JOINTS];
    float floats[3][FLOATS], got_floats[FLOATS];
    static const float w[3] = { 0.3f, 1.7f, 0.02f };
    (void)state;
    scene_open(&s);
    sums_open(&b);
    for (uint32_t m = 0; m < 3; m++) {
        scene_pose(&s, m, 4000, poses[m], floats[m]);
        if (m == 1) {
            for (uint32_t j = 0; j < JOINTS; j++) { /* the other hemisphere: nothing may change */
                for (int k = 0; k < 4; k++) poses[m][j].rotation[k] = -poses[m][j].rotation[k];
            }
        }
        noh_blend_add(&b.blend, poses[m], floats[m], w[m], everywhere);
    }
    noh_blend_finish(&b.blend, s.bind, s.defaults, got, got_floats);
    for (uint32_t j = 0; j < JOINTS; j++) {
        double q[4] = { 0, 0, 0, 0 }, length = 0.0;
        for (uint32_t m = 0; m < 3; m++) {
            double sign = noh_quat_dot(poses[0][j].rotation, poses[m][j].rotation) < 0.0f ? -1.0 : 1.0;
            for (int k = 0; k < 4; k++) q[k] += sign * (double)w[m] * poses[m][j].rotation[k];
        }
        for (int k = 0; k < 4; k++) length += q[k] * q[k];
        for (int k = 0; k < 4; k++) assert_true(fabs(got[j].rotation[k] - q[k] / sqrt(length)) < 1e-6);
        for (int k = 0; k < 3; k++) {
            double t = 0.0, c = 0.0;
            for (uint32_t m = 0; m < 3; m++) {
                t += (double)w[m] * poses[m][j].translation[k];
                c += (double)w[m] * poses[m][j].scale[k];
            }
            assert_true(fabs(got[j].translation[k] - t / 2.02) < 1e-6 && fabs(got[j].scale[k] - c / 2.02) < 1e-6);
        }
    }
}

/* The source's weight, (rand() % 1000) / 1000, never reaches 1, so the first clip alone is never seen. Here the ends of
 * a mix, and a sum of one, show one clip alone, translations and floats to the bit. */
static void a_weight_of_one_shows_its_clip_alone(void **state)
{
    scene s;
    sums b;
    noh_transform a[JOINTS], c[JOINTS], got[JOINTS];
    float fa[FLOATS], fc[FLOATS], out[FLOATS];
    (void)state;
    scene_open(&s);
    scene_pose(&s, WALK, 9000, a, fa);
    scene_pose(&s, RUN, 5000, c, fc);
    assert_true(pose_apart(a, c, JOINTS) > 0.1);
    for (int end = 0; end < 3; end++) {
        const noh_transform *want = end == 1 ? c : a;
        if (end < 2) {
            noh_pose_mix(JOINTS, a, c, (float)end, NULL, got);
            noh_floats_mix(FLOATS, fa, fc, (float)end, NULL, out);
        } else {
            sums_open(&b);
            noh_blend_add(&b.blend, a, fa, 1.0f, everywhere);
            noh_blend_finish(&b.blend, s.bind, s.defaults, got, out);
        }
        assert_true(pose_apart(got, want, JOINTS) < 1e-6);
        for (uint32_t j = 0; j < JOINTS; j++) {
            assert_memory_equal(got[j].translation, want[j].translation, sizeof got[j].translation);
        }
        assert_memory_equal(out, end == 1 ? fc : fa, sizeof out);
    }
}

/* Quaternions of both hemispheres cancel out when they are summed as they are; aligned, they do not. */
static void hemispheres_are_aligned(void **state)
{
    scene s;
    sums b;
    noh_transform a[JOINTS], c[JOINTS], got[JOINTS];
    float floats[FLOATS], out[FLOATS], naive = 0.0f;
    (void)state;
    scene_open(&s);
    scene_pose(&s, WALK, 0, a, floats);
    memcpy(c, a, sizeof c);
    for (int k = 0; k < 4; k++) c[5].rotation[k] = -a[5].rotation[k]; /* the same rotation */
    for (int k = 0; k < 4; k++) naive += fabsf(0.5f * a[5].rotation[k] + 0.5f * c[5].rotation[k]);
    assert_true(naive < 1e-6f);
    sums_open(&b);
    noh_blend_add(&b.blend, a, floats, 0.5f, everywhere);
    noh_blend_add(&b.blend, c, floats, 0.5f, everywhere);
    noh_blend_finish(&b.blend, s.bind, NULL, got, out);
    assert_true(pose_apart(got, a, JOINTS) < 1e-6);
}

/* Weights that do not sum to 1 must be divided by their sum; a sum of 0 gives the bind pose. */
static void weights_are_divided_by_their_sum(void **state)
{
    scene s;
    sums b;
    noh_transform a[JOINTS], got[JOINTS];
    float floats[FLOATS], out[FLOATS];
    (void)state;
    scene_open(&s);
    scene_pose(&s, WALK, 9000, a, floats);
    sums_open(&b);
    noh_blend_add(&b.blend, a, floats, 0.25f, everywhere);
    assert_true(fabsf(b.sum[7].translation[0] - a[7].translation[0]) > 0.3f); /* the plain sum shrinks the body */
    noh_blend_finish(&b.blend, s.bind, s.defaults, got, out);
    assert_true(pose_apart(got, a, JOINTS) < 1e-6 && floats_apart(out, floats, FLOATS) < 1e-6);
    sums_open(&b);
    noh_blend_finish(&b.blend, s.bind, s.defaults, got, out);
    assert_memory_equal(got, s.bind, sizeof got);
    assert_memory_equal(out, s.defaults, sizeof out);
    noh_blend_finish(&b.blend, s.bind, NULL, got, out);
    assert_true(out[3] == 0.0f);
}

/* A masked joint uses its own sum. Dividing by the sum of the tracks pulls it to zero. */
static void masked_joints_use_their_own_sum(void **state)
{
    scene s;
    sums b;
    noh_transform a[JOINTS], c[JOINTS], got[JOINTS];
    float fa[FLOATS], fc[FLOATS], out[FLOATS], naive;
    noh_mask_view upper;
    (void)state;
    scene_open(&s);
    upper = noh_clip_set_mask(&s.set, 1);
    scene_pose(&s, WALK, 9000, a, fa);
    scene_pose(&s, RUN, 5000, c, fc);
    sums_open(&b);
    noh_blend_add(&b.blend, a, fa, 1.0f, everywhere);
    noh_blend_add(&b.blend, c, fc, 1.0f, upper);
    noh_blend_finish(&b.blend, s.bind, s.defaults, got, out);
    assert_true(pose_apart(got, a, JOINTS / 2u) < 1e-6); /* masked: the walk alone */
    naive = b.sum[5].translation[1] / 2.0f;
    assert_true(fabsf(naive - a[5].translation[1]) > 0.1f);
    assert_true(fabsf(got[20].translation[1] - 0.5f * (a[20].translation[1] + c[20].translation[1])) < 1e-6f);
    assert_true(fabsf(out[0] - fa[0]) < 1e-6f && fabsf(out[4] - 0.5f * (fa[4] + fc[4])) < 1e-6f);
}

/* A sum laid over a lower pose covers it by its amount and its masked share of the group, and completely where the
 * lower pose has no weight. */
static void a_sum_covers_what_lies_below(void **state)
{
    scene s;
    sums b;
    noh_transform low[JOINTS], high[JOINTS], got[JOINTS], want[JOINTS];
    float fl[FLOATS], fh[FLOATS], floats[FLOATS], totals[JOINTS], float_totals[FLOATS];
    uint8_t odd[JOINTS + FLOATS];
    const noh_mask_view below = { odd, odd + JOINTS };
    (void)state;
    scene_open(&s);
    scene_pose(&s, WALK, 9000, low, fl);
    scene_pose(&s, RUN, 5000, high, fh);
    for (uint32_t j = 0; j < JOINTS; j++) odd[j] = j % 2u ? 255 : 0;
    for (uint32_t i = 0; i < FLOATS; i++) odd[JOINTS + i] = i % 2u ? 255 : 0;
    for (uint32_t mask = 0; mask <= 2; mask += 2) {
        const noh_mask_view view = mask ? noh_clip_set_mask(&s.set, mask) : everywhere;
        memcpy(got, low, sizeof got);
        memcpy(floats, fl, sizeof floats);
        sums_open(&b);
        b.blend.totals = totals;
        b.blend.float_totals = float_totals;
        noh_blend_add(&b.blend, low, fl, 2.0f, below);
        noh_blend_begin_over(&b.blend);
        noh_blend_add(&b.blend, high, fh, 4.0f, view);
        noh_blend_cover(&b.blend, 0.25f, got, floats);
        for (uint32_t j = 0; j < JOINTS; j++) {
            const float part = mask ? (float)s.masks[1][j] / 255.0f : 1.0f;
            noh_pose_mix(1, &low[j], &high[j], part > 0.0f ? (j % 2u ? 0.25f * part : 1.0f) : 0.0f, NULL, &want[j]);
        }
        assert_true(pose_apart(got, want, JOINTS) < 1e-6);
        for (uint32_t i = 0; i < FLOATS; i++) {
            const float part = mask ? 128.0f / 255.0f : 1.0f, t = i % 2u ? 0.25f * part : 1.0f;
            assert_true(fabsf(floats[i] - (fl[i] + (fh[i] - fl[i]) * t)) < 1e-6f);
        }
    }
}

/* Palette = model * inverse bind: points of the bind pose are moved into the joint's space first. Turned joints show
 * the order. */
static void palettes_take_the_bind_pose_away_first(void **state)
{
    scene s;
    noh_transform pose[JOINTS];
    float floats[FLOATS], model[JOINTS * 12], inverse[JOINTS * 12], palette[JOINTS * 12];
    (void)state;
    scene_open(&s);
    scene_pose(&s, WALK, 12345, pose, floats);
    noh_local_to_model(&s.skeleton, pose, JOINTS, model);
    for (uint32_t i = 0; i < JOINTS; i++) {
        noh_transform t = pose[(i + 5u) % JOINTS];
        noh_transform_matrix(&t, inverse + 12u * i);
    }
    s.skeleton.inverse_bind = inverse;
    noh_model_to_palette(&s.skeleton, model, JOINTS, palette);
    for (uint32_t i = 0; i < JOINTS; i++) {
        const float *m = model + 12u * i, *n = inverse + 12u * i, p[3] = { 0.3f, -0.2f, 0.1f };
        float local[3];
        for (int r = 0; r < 3; r++)
            local[r] = n[4 * r] * p[0] + n[4 * r + 1] * p[1] + n[4 * r + 2] * p[2] + n[4 * r + 3];
        for (int r = 0; r < 3; r++) {
            const float *q = palette + 12u * i + 4 * r;
            const float want = m[4 * r] * local[0] + m[4 * r + 1] * local[1] + m[4 * r + 2] * local[2] + m[4 * r + 3];
            assert_true(fabsf(q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] - want) < 1e-5f);
        }
    }
}

static void mixes_are_exact_at_the_ends_and_in_place(void **state)
{
    scene s;
    noh_transform a[JOINTS], b[JOINTS], got[JOINTS];
    float fa[FLOATS], fb[FLOATS];
    (void)state;
    scene_open(&s);
    scene_pose(&s, WALK, 0, a, fa);
    scene_pose(&s, RUN, 0, b, fb);
    noh_pose_mix(JOINTS, a, b, 0.0f, NULL, got);
    assert_true(pose_apart(got, a, JOINTS) < 1e-6);
    noh_pose_mix(JOINTS, a, b, 1.0f, NULL, got);
    assert_true(pose_apart(got, b, JOINTS) < 1e-6);
    noh_pose_mix(JOINTS, a, b, 0.3f, s.masks[1], got);
    noh_pose_mix(JOINTS, a, b, 0.3f, s.masks[1], a);
    assert_memory_equal(got, a, sizeof got);
    noh_floats_mix(FLOATS, fa, fb, 1.0f, NULL, fa);
    assert_memory_equal(fa, fb, sizeof fa);
}

/* The sum of unit quaternions that are far apart is short; a mix must still be a rotation, half way between them. */
static void a_mix_is_unit(void **state)
{
    static const float a[4] = { 0, 0, 0, 1 };
    (void)state;
    for (int i = 1; i < 18; i++) {
        const double angle = i * TWO_PI / 36.0;
        const float b[4] = { 0, (float)sin(0.5 * angle), 0, (float)cos(0.5 * angle) };
        for (int k = 0; k <= 8; k++) {
            float q[4], length;
            noh_quat_nlerp(a, b, (float)k / 8.0f, q);
            length = sqrtf(noh_quat_dot(q, q));
            assert_true(fabsf(length - 1.0f) < 1e-6f);
            if (k == 4) assert_true(fabs(q[1] - sin(0.25 * angle)) < 1e-6 && fabs(q[3] - cos(0.25 * angle)) < 1e-6);
        }
    }
}

/* A pose laid over another covers it by the mean mask of the tracks that animate the joint, and completely where the
 * pose below has no weight. */
static void poses_cover_by_their_masks(void **state)
{
    scene s;
    sums b;
    noh_transform poses[3][JOINTS], low[JOINTS], got[JOINTS], want[JOINTS];
    float floats[3][FLOATS], low_floats[FLOATS], got_floats[FLOATS], totals[JOINTS], float_totals[FLOATS];
    noh_mask_view half, tenths;
    (void)state;
    scene_open(&s);
    sums_open(&b);
    b.blend.totals = totals;
    b.blend.float_totals = float_totals;
    half = noh_clip_set_mask(&s.set, 1);
    tenths = noh_clip_set_mask(&s.set, 2);
    for (uint32_t m = 0; m < 3; m++) scene_pose(&s, m, 4000, poses[m], floats[m]);
    noh_blend_add(&b.blend, poses[WALK], NULL, 1.0f, half); /* below: the upper half, no floats */
    noh_blend_finish(&b.blend, s.bind, s.defaults, low, low_floats);
    memcpy(got, low, sizeof got);
    memcpy(got_floats, low_floats, sizeof got_floats);
    noh_blend_begin_over(&b.blend);
    noh_blend_add(&b.blend, poses[RUN], NULL, 0.5f, tenths);
    noh_blend_add(&b.blend, NULL, floats[WAVE], 4.0f, tenths);
    noh_blend_cover(&b.blend, 0.5f, got, got_floats);
    noh_pose_mix(JOINTS, low, poses[RUN], 0.5f, tenths.joints, want);
    assert_true(pose_apart(got + JOINTS / 2u, want + JOINTS / 2u, JOINTS / 2u) < 1e-6);
    assert_true(pose_apart(got + 1, poses[RUN] + 1, JOINTS / 2u - 1u) <
                1e-6); /* nothing below; joint 0 is masked out */
    assert_true(pose_apart(got, low, 1) < 1e-6);
    assert_true(floats_apart(got_floats, floats[WAVE], FLOATS) < 1e-6);
}

/* A difference added at full weight to its reference is the pose again. */
static void a_difference_added_to_its_reference_is_the_pose(void **state)
{
    scene s;
    noh_transform a[JOINTS], b[JOINTS], d[JOINTS];
    float floats[FLOATS];
    (void)state;
    scene_open(&s);
    scene_pose(&s, WALK, 100, a, floats);
    scene_pose(&s, LEAN, 7000, b, floats);
    noh_pose_difference(JOINTS, a, b, d);
    noh_pose_add(JOINTS, d, 0.0f, NULL, a);
    scene_pose(&s, WALK, 100, b, floats);
    assert_true(pose_apart(a, b, JOINTS) < 1e-6);
    scene_pose(&s, LEAN, 7000, b, floats);
    noh_pose_add(JOINTS, d, 1.0f, NULL, a);
    assert_true(pose_apart(a, b, JOINTS) < 2e-6);
    a[0].scale[1] = 0.0f; /* no ratio to nothing */
    noh_pose_difference(JOINTS, a, b, d);
    assert_true(d[0].scale[1] == 1.0f);
}

/* ---- masks ---- */

static void masks_are_made_by_subtree(void **state)
{
    scene s;
    uint8_t mask[JOINTS + FLOATS];
    (void)state;
    scene_open(&s);
    noh_mask_fill(mask, JOINTS + FLOATS, 7);
    noh_mask_subtree(mask, &s.skeleton, 2, 255); /* a binary tree: 2, 5, 6, 11..14, 23 */
    for (uint32_t j = 0; j < JOINTS; j++) {
        int below_two = j == 2 || j == 5 || j == 6 || (j >= 11 && j <= 14) || j == 23;
        assert_int_equal(mask[j], below_two ? 255 : 7);
    }
    noh_mask_fill(mask, 0, 1);
    assert_null(noh_clip_set_mask(&s.set, 0).joints);
    assert_ptr_equal(noh_clip_set_mask(&s.set, 2).joints, s.masks[1]);
    assert_ptr_equal(noh_clip_set_mask(&s.set, 2).floats, s.masks[1] + JOINTS);
}

/* ---- blend spaces ---- */

static void spaces_of_one_dimension_interpolate(void **state)
{
    static const float at[] = { -1.0f, 0.0f, 2.0f, 5.0f };
    float w[4];
    (void)state;
    for (int i = -40; i <= 120; i++) {
        float x = 0.05f * (float)i, sum = 0.0f, mean = 0.0f;
        noh_blend_space_1d_weights(4, at, x, w);
        for (int k = 0; k < 4; k++) sum += w[k], mean += w[k] * at[k];
        assert_true(fabsf(sum - 1.0f) < 1e-6f);
        assert_true(fabsf(mean - fminf(fmaxf(x, -1.0f), 5.0f)) < 1e-5f);
    }
    noh_blend_space_1d_weights(4, at, 2.0f, w);
    assert_true(w[2] == 1.0f);
    noh_blend_space_1d_weights(4, at, NAN, w);
    assert_true(w[0] == 1.0f);
    noh_blend_space_1d_weights(1, at, 3.0f, w);
    assert_true(w[0] == 1.0f);
}

static double area(const float *p, const uint8_t *t)
{
    const float *a = p + 2 * t[0], *b = p + 2 * t[1], *c = p + 2 * t[2];
    return 0.5 * (((double)b[0] - a[0]) * ((double)c[1] - a[1]) - ((double)b[1] - a[1]) * ((double)c[0] - a[0]));
}

/* Positive when d lies in the circle of the left-turning triangle; exact for coordinates in 1/4096. */
static double in_circle(const float *p, const uint8_t *t, uint32_t d)
{
    double x[3], y[3], s[3];
    for (int k = 0; k < 3; k++) {
        x[k] = 4096.0 * ((double)p[2 * t[k]] - p[2u * d]);
        y[k] = 4096.0 * ((double)p[2 * t[k] + 1] - p[2u * d + 1u]);
        s[k] = x[k] * x[k] + y[k] * y[k];
    }
    return s[0] * (x[1] * y[2] - y[1] * x[2]) - s[1] * (x[0] * y[2] - y[0] * x[2]) + s[2] * (x[0] * y[1] - y[0] * x[1]);
}

/* Triangles turn left, cover the square once, and no point lies in a triangle's circle. */
static void triangulations_cover_the_square(void **state)
{
    uint32_t seed = 7;
    (void)state;
    for (int round = 0; round < 300; round++) {
        float p[NOH_BLEND_SPACE_POINTS_MAX * 2u], w[NOH_BLEND_SPACE_POINTS_MAX];
        uint8_t tri[NOH_BLEND_SPACE_TRIANGLES_MAX * 3u];
        uint32_t n = 4u + (uint32_t)round % 29u, count = 0;
        noh_blend_space_2d space = { n, 0, p, tri };
        double sum = 0.0;
        for (uint32_t i = 0; i < n; i++) {
            for (uint32_t k = 0; k < 2; k++) {
                seed = seed * 1664525u + 1013904223u;
                p[2u * i + k] = (float)(seed >> 20) / 4096.0f; /* on the grid of the tests: exact */
            }
            if (i < 4) p[2u * i] = (float)(i & 1u), p[2u * i + 1u] = (float)(i >> 1);
            /* every second round many points on lines and circles */
            else if (round % 2)
                p[2u * i] = (float)(i % 6u) * 800.0f / 4096.0f,
                       p[2u * i + 1u] = (float)(400u + i / 6u * 512u) / 4096.0f;
        }
        assert_int_equal(noh_blend_space_2d_triangulate(n, p, tri, &count, NULL), NOH_OK);
        space.triangle_count = count;
        for (uint32_t i = 0; i < count; i++) {
            assert_true(area(p, tri + 3u * i) > 0.0);
            sum += area(p, tri + 3u * i);
            for (uint32_t k = 0; k < n; k++) assert_true(in_circle(p, tri + 3u * i, k) <= 0.0);
        }
        assert_true(fabs(sum - 1.0) < 1e-6);
        for (uint32_t i = 0; i < n; i++) { /* a point's own clip alone */
            noh_blend_space_2d_weights(&space, p[2u * i], p[2u * i + 1u], w);
            assert_true(w[i] > 0.9999f);
        }
        for (int i = 0; i < 50; i++) { /* linear precision inside, and at most three */
            float x = (float)(i % 7) / 7.0f + 0.05f, y = (float)(i / 7) / 8.0f + 0.03f, mx = 0.0f, my = 0.0f,
                  total = 0.0f;
            int used = 0;
            noh_blend_space_2d_weights(&space, x, y, w);
            for (uint32_t k = 0; k < n; k++)
                mx += w[k] * p[2u * k], my += w[k] * p[2u * k + 1u], total += w[k], used += w[k] > 0.0f;
            assert_true(used <= 3 && fabsf(total - 1.0f) < 1e-5f && fabsf(mx - x) < 1e-4f && fabsf(my - y) < 1e-4f);
        }
    }
}

static void triangulations_are_delaunay(void **state)
{
    /* a thin kite: the short diagonal is the Delaunay one, whichever order the sweep finds */
    static const float p[8] = { 0, 0, 10, 0, 5, 1, 5, -1 };
    uint8_t tri[NOH_BLEND_SPACE_TRIANGLES_MAX * 3u];
    uint32_t count;
    (void)state;
    assert_int_equal(noh_blend_space_2d_triangulate(4, p, tri, &count, NULL), NOH_OK);
    assert_int_equal(count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        int has2 = 0, has3 = 0;
        for (int k = 0; k < 3; k++) has2 |= tri[3u * i + (uint32_t)k] == 2, has3 |= tri[3u * i + (uint32_t)k] == 3;
        assert_true(has2 && has3);
    }
}

static void spaces_clamp_outside_and_where_degenerate(void **state)
{
    static const float square[8] = { 0, 0, 1, 0, 0, 1, 1, 1 }, line[6] = { 2, 2, 0, 0, 1, 1 };
    static const float same[4] = { 1, 1, 1, 1 };
    float bad[4] = { 0, 0, NAN, 1 }, w[4];
    uint8_t tri[NOH_BLEND_SPACE_TRIANGLES_MAX * 3u];
    noh_blend_space_2d space = { 4, 0, square, tri };
    noh_error error;
    (void)state;
    assert_int_equal(noh_blend_space_2d_triangulate(4, square, tri, &space.triangle_count, NULL), NOH_OK);
    noh_blend_space_2d_weights(&space, 5.0f, 0.25f, w); /* the nearest point of the right edge */
    assert_true(fabsf(w[1] - 0.75f) < 1e-6f && fabsf(w[3] - 0.25f) < 1e-6f);
    noh_blend_space_2d_weights(&space, -3.0f, -9.0f, w);
    assert_true(w[0] == 1.0f);
    noh_blend_space_2d_weights(&space, NAN, 0.0f, w);
    assert_true(w[0] == 1.0f);
    space.point_count = 3, space.points = line;
    assert_int_equal(noh_blend_space_2d_triangulate(3, line, tri, &space.triangle_count, NULL), NOH_OK);
    assert_int_equal(space.triangle_count, 0);
    noh_blend_space_2d_weights(&space, 0.5f, 0.5f, w);
    assert_true(fabsf(w[1] - 0.5f) < 1e-6f && fabsf(w[2] - 0.5f) < 1e-6f);
    space.point_count = 1;
    noh_blend_space_2d_weights(&space, 0.5f, 0.5f, w);
    assert_true(w[0] == 1.0f);
    assert_int_equal(noh_blend_space_2d_triangulate(2, same, tri, &space.triangle_count, &error), NOH_ERR_DATA);
    assert_int_equal(noh_blend_space_2d_triangulate(2, bad, tri, &space.triangle_count, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, 1);
    assert_int_equal(noh_blend_space_2d_triangulate(0, square, tri, &space.triangle_count, &error), NOH_ERR_ARG);
    assert_int_equal(
        noh_blend_space_2d_triangulate(NOH_BLEND_SPACE_POINTS_MAX + 1u, square, tri, &space.triangle_count, &error),
        NOH_ERR_ARG);
}

/* The largest coordinates accepted have exact results; points beyond them are refused, and queries are clamped. */
static void spaces_take_huge_coordinates(void **state)
{
    static const float far_away[] = { 3e38f, -3e38f, 1.1e18f, INFINITY, -INFINITY, NAN };
    const float most = NOH_BLEND_SPACE_COORDINATE_MAX,
                ends[2] = { -NOH_BLEND_SPACE_COORDINATE_MAX, NOH_BLEND_SPACE_COORDINATE_MAX };
    const float square[8] = { -most, -most, most, -most, -most, most, most, most };
    uint8_t tri[NOH_BLEND_SPACE_TRIANGLES_MAX * 3u];
    float w[4];
    noh_blend_space_2d space = { 4, 0, square, tri };
    noh_error error;
    (void)state;
    for (uint32_t i = 0; i < 4; i++) {
        for (uint32_t k = 0; k < sizeof far_away / sizeof *far_away; k++) {
            float p[8] = { 0, 0, 1, 0, 0, 1, 1, 1 };
            p[2u * i + k % 2u] = far_away[k];
            assert_int_equal(noh_blend_space_2d_triangulate(4, p, tri, &space.triangle_count, &error), NOH_ERR_DATA);
            assert_int_equal(error.where, i);
        }
    }
    assert_int_equal(noh_blend_space_2d_triangulate(4, square, tri, &space.triangle_count, NULL), NOH_OK);
    assert_int_equal(space.triangle_count, 2);
    noh_blend_space_2d_weights(&space, 0.0f, 0.0f, w);
    assert_true(fabsf(w[0] + w[1] + w[2] + w[3] - 1.0f) < 1e-6f && fabsf(w[0] + w[1] - 0.5f) < 1e-6f);
    noh_blend_space_2d_weights(&space, 3e38f, 3e38f, w);
    assert_true(w[3] == 1.0f);
    noh_blend_space_2d_weights(&space, INFINITY, -INFINITY, w);
    assert_true(w[1] == 1.0f);
    noh_blend_space_1d_weights(2, ends, 5e17f, w);
    assert_true(fabsf(w[1] - 0.75f) < 1e-6f);
    noh_blend_space_1d_weights(2, ends, 3e38f, w);
    assert_true(w[1] == 1.0f);
}

/* ---- skeleton, local to model ---- */

/* A point of each joint, moved up the chain joint by joint in double precision. */
static void climb(const scene *s, const noh_transform *pose, uint32_t joint, double p[3])
{
    for (uint32_t j = joint; j != NOH_JOINT_ROOT; j = s->parents[j]) {
        double q[4], v[3], t[3];
        for (int k = 0; k < 4; k++) q[k] = pose[j].rotation[k];
        for (int k = 0; k < 3; k++) v[k] = p[k] * pose[j].scale[k];
        for (int k = 0; k < 3; k++) t[k] = 2.0 * (q[(k + 1) % 3] * v[(k + 2) % 3] - q[(k + 2) % 3] * v[(k + 1) % 3]);
        for (int k = 0; k < 3; k++)
            p[k] = v[k] + q[3] * t[k] + q[(k + 1) % 3] * t[(k + 2) % 3] - q[(k + 2) % 3] * t[(k + 1) % 3] +
                   pose[j].translation[k];
    }
}

/* One linear loop, parents first: model = parent * local with column vectors. The source's row
 * order taken over as it stands (local * parent) puts the joints elsewhere. */
static void model_is_parent_times_local(void **state)
{
    scene s;
    noh_transform pose[JOINTS];
    float floats[FLOATS], model[JOINTS * 12], palette[JOINTS * 12], swapped[12];
    double worst = 0.0;
    (void)state;
    scene_open(&s);
    scene_pose(&s, WALK, 12345, pose, floats);
    noh_local_to_model(&s.skeleton, pose, JOINTS, model);
    for (uint32_t j = 0; j < JOINTS; j++) {
        double p[3] = { 0.3, -0.2, 0.1 };
        const float *m = model + 12u * j;
        climb(&s, pose, j, p);
        for (int r = 0; r < 3; r++)
            worst = fmax(worst, fabs(p[r] - (0.3 * m[4 * r] - 0.2 * m[4 * r + 1] + 0.1 * m[4 * r + 2] + m[4 * r + 3])));
    }
    assert_true(worst < 3e-6);
    noh_transform_matrix(&pose[1], swapped);
    noh_matrix_multiply(swapped, model, swapped);
    assert_true(fabsf(swapped[3] - model[12 + 3]) > 0.01f);
    memset(palette, 0, sizeof palette);
    noh_local_to_model(&s.skeleton, pose, 5, palette); /* a LOD prefix */
    assert_memory_equal(palette, model, 5 * 12 * sizeof(float));
    assert_true(palette[60] == 0.0f);
}

static void the_palette_is_model_times_inverse_bind(void **state)
{
    scene s;
    float model[JOINTS * 12], inverse[JOINTS * 12], palette[JOINTS * 12];
    (void)state;
    scene_open(&s);
    noh_local_to_model(&s.skeleton, s.bind, JOINTS, model);
    for (uint32_t i = 0; i < JOINTS; i++) { /* the bind pose only translates */
        memcpy(inverse + 12u * i, model + 12u * i, 12 * sizeof(float));
        for (int r = 0; r < 3; r++) inverse[12u * i + 4u * (uint32_t)r + 3u] *= -1.0f;
    }
    noh_model_to_palette(&s.skeleton, model, JOINTS, palette);
    assert_memory_equal(palette, model, sizeof model); /* without inverse bind matrices */
    s.skeleton.inverse_bind = inverse;
    noh_model_to_palette(&s.skeleton, model, JOINTS, model); /* in place */
    for (uint32_t i = 0; i < JOINTS * 12u; i++)
        assert_true(fabsf(model[i] - (i % 12u % 5u == 0 ? 1.0f : 0.0f)) < 1e-6f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_weighted_sum_follows_its_definition),
        cmocka_unit_test(a_weight_of_one_shows_its_clip_alone),
        cmocka_unit_test(hemispheres_are_aligned),
        cmocka_unit_test(weights_are_divided_by_their_sum),
        cmocka_unit_test(masked_joints_use_their_own_sum),
        cmocka_unit_test(mixes_are_exact_at_the_ends_and_in_place),
        cmocka_unit_test(a_mix_is_unit),
        cmocka_unit_test(poses_cover_by_their_masks),
        cmocka_unit_test(a_difference_added_to_its_reference_is_the_pose),
        cmocka_unit_test(masks_are_made_by_subtree),
        cmocka_unit_test(spaces_of_one_dimension_interpolate),
        cmocka_unit_test(triangulations_cover_the_square),
        cmocka_unit_test(triangulations_are_delaunay),
        cmocka_unit_test(spaces_clamp_outside_and_where_degenerate),
        cmocka_unit_test(spaces_take_huge_coordinates),
        cmocka_unit_test(model_is_parent_times_local),
        cmocka_unit_test(the_palette_is_model_times_inverse_bind),
        cmocka_unit_test(a_sum_covers_what_lies_below),
        cmocka_unit_test(palettes_take_the_bind_pose_away_first),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
